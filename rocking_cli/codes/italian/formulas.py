"""The formulas of a verification by the Italian code: symbol, text, slots for its numbers, unit and clause.

The calculation sheet, `workings` and the terminal all use these formulas. The `meaning` of a formula is a key of the
texts of the sheet; a copy has another one where uses differ.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import product

from rocking_cli.codes.italian import clauses
from rocking_cli.codes.italian.rules import RULES
from rocking_cli.verification.results import Formula

# Values of the site file
FC = Formula("FC", "given", clause=clauses.A_STAR, meaning="given_FC")
Q = Formula("q", "given", clause=clauses.LINEAR, meaning="given_q")
T1 = Formula("T_[1]", "given", unit="s", clause=clauses.MODE, meaning="given_T1", standing="plain")
XI1 = Formula("ξ_[1]", "given", clause=clauses.MODE, meaning="given_xi1", standing="plain")
OWN_PERIOD = Formula(
    "T_[0]", "κ (L/t) L √(w/(E g))", "{kappa} · {L}/{t} · {L} · √({w}/({E} · {g}))", "s", clauses.OWN_PERIOD,
    meaning="given_T0",
)  # fmt: skip

# Hazard and ground
REFERENCE_LIFE = Formula("V_[R]", "V_[N] C_[U]", "{VN} · {CU}", "years", clauses.REFERENCE_LIFE, meaning="VR")
REFERENCE_LIFE_BOUND = replace(
    REFERENCE_LIFE, text="max(V_[N] C_[U]; 35)", numbers="max({VN} · {CU}; 35)", clause=clauses.MIN_REFERENCE_LIFE
)
RETURN_PERIOD = Formula(
    "T_[R]", "−V_[R]/ln(1 − P)", "−{VR}/ln(1 − {P})", "years", clauses.RETURN_PERIOD, meaning="TR", digits=9
)
RETURN_PERIOD_BOUND = replace(RETURN_PERIOD, numbers="max({first}; min({last}; −{VR}/ln(1 − {P})))")
RETURN_PERIOD_OF_ROW = Formula("T_[R]", unit="years", clause=clauses.HAZARD, meaning="TR_of_row", standing="ours")
BETWEEN = Formula(
    "r", "ln(T_[R]/T_[R,a])/ln(T_[R,b]/T_[R,a])", "ln({T:9}/{a})/ln({b}/{a})", clause=clauses.HAZARD, meaning="r"
)
AG = Formula("a_[g]", "a_[g,a] (a_[g,b]/a_[g,a])^[r]", "{a} · ({b}/{a})^[{r}]", "g", clauses.HAZARD, meaning="rock_ag")
F0 = Formula("F_[0]", "F_[0,a] (F_[0,b]/F_[0,a])^[r]", "{a} · ({b}/{a})^[{r}]", "", clauses.HAZARD, meaning="rock_F0")
TC_STAR = Formula(
    "T_[C]^[*]", "T_[C,a]^[*] (T_[C,b]^[*]/T_[C,a]^[*])^[r]", "{a} · ({b}/{a})^[{r}]", "s", clauses.HAZARD,
    meaning="rock_TC",
)  # fmt: skip
ON_ROCK = (AG, F0, TC_STAR)
SOIL = Formula(
    "S_[S]", "max({least}; min({most}; {first} − {second} F_[0] a_[g]/g))",
    "max({least}; min({most}; {first} − {second} · {F0} · {ag}))", clause=clauses.SOIL, meaning="S_S",
)  # fmt: skip
SOIL_A = Formula("S_[S]", "1", "1", clause=clauses.SOIL, meaning="S_S")
S = Formula("S", "S_[S] S_[T]", "{S_S} · {S_T}", clause=clauses.S, meaning="S")
CORNER = Formula(
    "C_[C]", "{factor} (T_[C]^[*])^[{power}]", "{factor} · {T}^[{power}]", clause=clauses.SOIL, meaning="C_C"
)
CORNER_A = Formula("C_[C]", "1", "1", clause=clauses.SOIL, meaning="C_C")
TC = Formula("T_[C]", "C_[C] T_[C]^[*]", "{C} · {T}", "s", clauses.TC, meaning="TC")
TB = Formula("T_[B]", "T_[C]/3", "{T}/3", "s", clauses.TB, meaning="TB")
TD = Formula("T_[D]", "4 a_[g]/g + 1.6", "4 · {ag} + 1.6", "s", clauses.TD, meaning="TD")
PEAK = Formula("a_[g] S", "a_[g] S g", "{ag} · {S} · {g}", "m/s²", clauses.SPECTRUM, meaning="peak")
PEAK_OF_TABLE = Formula("a_[g] S", "S_[e](0) g", "{a} · {g}", "m/s²", clauses.NONLINEAR, meaning="peak_of_table")

# Spectra of acceleration
ETA = Formula("η({xi})", "max(√(10/(5 + ξ)); 0.55)", "max(√(10/(5 + {xi})); 0.55)", "", clauses.DAMPING, meaning="eta")
S_E_RISING = Formula(
    "S_[e]({at})", "a_[g] S g η F_[0] (T/T_[B] + (1 − T/T_[B])/(η F_[0]))",
    "{ag} · {S} · {g} · {eta} · {F0} · ({T}/{TB} + (1 − {T}/{TB})/({eta} · {F0}))", "m/s²", clauses.SPECTRUM,
    meaning="S_e_rising",
)  # fmt: skip
S_E_LEVEL = Formula(
    "S_[e]({at})", "a_[g] S g η F_[0]", "{ag} · {S} · {g} · {eta} · {F0}", "m/s²", clauses.SPECTRUM, meaning="S_e_level"
)
S_E_FALLING = Formula(
    "S_[e]({at})", "a_[g] S g η F_[0] T_[C]/T", "{ag} · {S} · {g} · {eta} · {F0} · {TC}/{T}", "m/s²",
    clauses.SPECTRUM, meaning="S_e_falling",
)  # fmt: skip
S_E_LONG = Formula(
    "S_[e]({at})", "a_[g] S g η F_[0] T_[C] T_[D]/T^[2]",
    "{ag} · {S} · {g} · {eta} · {F0} · {TC} · {TD}/{T}^[2]", "m/s²", clauses.SPECTRUM, meaning="S_e_long",
)  # fmt: skip
S_5 = Formula(
    "S_[5]({at})", "k (S_[a] + (S_[b] − S_[a]) (T − T_[a])/(T_[b] − T_[a]))",
    "{k} · ({a} + ({b} − {a}) · ({T:9} − {Ta})/({Tb} − {Ta}))", "g", clauses.NONLINEAR, meaning="S_5",
)  # fmt: skip
ETA_T = Formula(
    "η({at})", "1 − (1 − η) T/T_[max]", "1 − (1 − {eta}) · {T}/{R}", "", clauses.NONLINEAR, meaning="eta_T",
    standing="ours",
)  # fmt: skip
S_E_TABLE = Formula("S_[e]({at})", "S_[5]({at}) η g", "{a} · {by} · {g}", "m/s²", clauses.NONLINEAR, meaning="S_e")

# Spectra of a floor
PSI = Formula("ψ", "z/H", "{z}/{H}", "", clauses.PSI, meaning="psi")
GAMMA = Formula("γ", "3n/(2n + 1)", "3 · {n}/(2 · {n} + 1)", "", clauses.GAMMA, meaning="gamma")
S_Z = Formula(
    "S_[Z]", "S_[e](T_[1]) γ ψ √(1 + 4 ξ_[1]^[2])", "{S} · {gamma} · {psi} · √(1 + 4 · {xi}^[2])", "m/s²",
    clauses.FLOOR_PEAK, meaning="S_Z",
)  # fmt: skip
AMPLIFIED = Formula(
    "A", "1.1 ξ_[1]^[−1/2] η(ξ)", "1.1 · {eta}/√({xi})", "", clauses.AMPLIFICATION, meaning="A", standing="ours"
)
S_EZ_BELOW = Formula(
    "{symbol}", "A S_[Z]/(1 + (A − 1) (1 − T/(a T_[1]))^[1.6])",
    "{A} · {S}/(1 + ({A} − 1) · (1 − {T}/(0.8 · {T1}))^[1.6])", "m/s²", clauses.FLOOR_SPECTRUM, meaning="S_eZ",
)  # fmt: skip
S_EZ_LEVEL = Formula("{symbol}", "A S_[Z]", "{A} · {S}", "m/s²", clauses.FLOOR_SPECTRUM, meaning="S_eZ")
S_EZ_ABOVE = Formula(
    "{symbol}", "A S_[Z]/(1 + (A − 1) (T/(b T_[1]) − 1)^[1.2])",
    "{A} · {S}/(1 + ({A} − 1) · ({T}/(1.1 · {T1}) − 1)^[1.2])", "m/s²", clauses.FLOOR_SPECTRUM, meaning="S_eZ",
)  # fmt: skip
S_EZ_BOUND = Formula(
    "S_[eZ]({at})", "max(S_[eZ,1]({at}); S_[e]({at}))", "max({own}; {under})", "m/s²", clauses.FLOOR_BOUND,
    meaning="S_eZ_bound",
)  # fmt: skip

# Spectra of displacement
S_DE = Formula(
    "{symbol}", "S_[e]({at}) {at}^[2]/(4 π^[2])", "{S} · {T}^[2]/(4 · π^[2])", "m", clauses.DISPLACEMENT,
    meaning="S_De",
)  # fmt: skip
S_DE_LONG = Formula(
    "{symbol}", "0.025 a_[g] S g T_[C] T_[D] (F_[0] η + (1 − F_[0] η) (T − T_[E])/(T_[F] − T_[E]))",
    "0.025 · {ag} · {S} · {g} · {TC} · {TD} · ({F0} · {eta} + (1 − {F0} · {eta}) · ({T} − {TE})/({TF} − {TE}))", "m",
    clauses.DISPLACEMENT_LONG, meaning="S_De_long",
)  # fmt: skip
S_DE_GROUND = Formula(
    "{symbol}", "0.025 a_[g] S g T_[C] T_[D]", "0.025 · {ag} · {S} · {g} · {TC} · {TD}", "m",
    clauses.DISPLACEMENT_GROUND, meaning="S_De_ground",
)  # fmt: skip
FURTHEST = Formula("t", "T_[0] ≤ t ≤ {at}: max S_[e](t) t^[2]", "", "s", clauses.NONLINEAR, meaning="t")
S_DE_TABLE = replace(S_DE, clause=clauses.NONLINEAR)
D_Z = Formula(
    "d_[Z]", "S_[eZ]({at}) {at}^[2]/(4 π^[2])", "{S} · {T}^[2]/(4 · π^[2])", "m", clauses.FLOOR_DISPLACEMENT,
    meaning="d_Z",
)  # fmt: skip
D_B = Formula(
    "d_[b]", "S_[eZ](T_[1]) (b T_[1])^[2]/(4 π^[2])", "{A} · {S} · (1.1 · {T})^[2]/(4 · π^[2])", "m",
    clauses.FLOOR_DISPLACEMENT, meaning="d_b",
)  # fmt: skip
S_DE_FLOOR = Formula(
    "S_[De]({at})", "max({bounds})", "max({d}; …)", "m", clauses.FLOOR_DISPLACEMENT, meaning="S_De_floor"
)

# Strength of ties of steel: formulas in common use, not checked against a printed source
TIE_NUMBER = Formula("n", "D/i", "{depth}/{spacing}", meaning="tie_number", standing="plain")
TIE_YIELD = Formula(
    "N_[y]", "n π d^[2]/4 f_[y]/γ", "{n} · π · {d}^[2]/4 · {f}/{gamma}", "kN", clauses.ANCHORED, meaning="tie_yield"
)
TIE_YIELD_OF_AREA = replace(TIE_YIELD, text="A f_[y]/γ", numbers="{A} · {f}/{gamma}")
TIE_PUNCHING = Formula(
    "N_[p]", "n 2 t (b + h + 2 t) f_[v]/γ", "{n} · 2 · {t} · ({b} + {h} + 2 · {t}) · {f}/{gamma}", "kN",
    clauses.ANCHORED, meaning="tie_punching",
)  # fmt: skip
TIE_BEARING = Formula(
    "N_[b]", "n b h f_[c]/γ", "{n} · {b} · {h} · {f}/{gamma}", "kN", clauses.ANCHORED, meaning="tie_bearing"
)
TIE_BENDING = Formula(
    "N_[s]", "n 2 s^[2] f_[y]/γ min(b/h; h/b)", "{n} · 2 · {s}^[2] · {f}/{gamma} · min({b}/{h}; {h}/{b})", "kN",
    clauses.ANCHORED, meaning="tie_bending",
)  # fmt: skip
TIE_THICKNESS = Formula(
    "s", "√(N γ/(2 n f_[y] min(b/h; h/b)))", "√({N} · {gamma}/(2 · {n} · {f} · min({b}/{h}; {h}/{b})))", "m",
    clauses.ANCHORED, meaning="tie_thickness",
)  # fmt: skip
TIE_KNOWN = Formula("ΔL_[t]", "ε L", "{strain} · {L}", "m", meaning="tie_known", standing="plain")
TIE = Formula("N", "min(N_[y]; N_[p]; N_[b]{bends})", "min({N}; …)", "kN", meaning="tie_strength", standing="plain")

# Kinematic chain
P = Formula("P_[{k}]", "{P}", "{P} + …", "{unit}", clauses.ALPHA0, meaning="of_block_P")
PQ = Formula("PQ_[{k}]", "{P+Q}", "{P} + …", "{unit}", clauses.ALPHA0, meaning="of_block_PQ")
G = Formula("{axis}_[G{k}]", "Σ (P+Q) {axis}/Σ (P+Q)", "({P} · {x} + …)/({P} + …)", "m", meaning="G", standing="plain")
GP = Formula("{axis}_[P{k}]", "Σ P {axis}/Σ P", "({P} · {x} + …)/({P} + …)", "m", meaning="GP", standing="plain")
PY = Formula("ΣPy′{at}", "Σ P y′", "{P} · {y} + …", "{unit} m", clauses.ALPHA0, meaning="Py", digits=9)
HELD = Formula("L{at}", "−Σ F r′ + Σ N L′", "{N:9} · {r:9} + …", "{unit} m", clauses.ALPHA0, meaning="L", digits=9)
V_M = Formula("V_[m]{at}", unit="{unit} m", meaning="V_m", standing="plain", digits=9)
PQX = Formula("Σ(P+Q)x′{at}", "Σ (P+Q) x′", "{P} · {x} + …", "{unit} m", clauses.ALPHA0, meaning="PQx", digits=9)
B_M = Formula("B_[m]{at}", unit="{unit} m", meaning="B_m", standing="plain", digits=9)
ALPHA = Formula("{symbol}", "({over})/({under})", "({V:9} + …)/({B:9} + …)", "", clauses.ALPHA0, meaning="alpha")
ALPHA_0 = replace(ALPHA, meaning="alpha_0")
SUM_PQ = Formula("Σ(P+Q)", "Σ (P+Q)", "{P} + …", "{unit}", clauses.ALPHA0, meaning="PQ")
PQXX = Formula("Σ(P+Q)x′^[2]", "Σ (P+Q) x′^[2]", "{P} · {x}^[2] + …", "{unit} m²", clauses.E_STAR, meaning="PQxx")
E_STAR = Formula(
    "e^[*]", "[Σ (P+Q) x′]^[2]/(Σ (P+Q) · Σ (P+Q) x′^[2])", "{first}^[2]/({PQ} · {second})", "", clauses.E_STAR,
    meaning="e",
)  # fmt: skip
M_STAR = Formula(
    "M^[*]", "e^[*] Σ (P+Q)/g", "1000 · {e} · {PQ}/{g}", "kg", clauses.OUTSIDE, meaning="M", standing="ours"
)

# Masses by sizes
RECTANGLE = Formula("M_[{k}]", "ρ B H L", "{rho} · {b} · {h} · {L}", "kg", meaning="mass_rectangle", standing="plain")
SEVERAL = replace(RECTANGLE, text="n ρ B H L", numbers="{n} · {rho} · {b} · {h} · {L}", meaning="mass_several")
AREA = Formula(
    "A_[{k}]", "Σ (x_[i] y_[i+1] − x_[i+1] y_[i])/2", "({x:9} · {yn:9} − {xn:9} · {y:9} + …)/2", "m²",
    meaning="area_of_polygon", standing="plain",
)  # fmt: skip
AREA_OF_MANY = replace(AREA, numbers="")
PLATE = Formula("M_[{k}]", "ρ A L", "{rho} · {A} · {L}", "kg", meaning="mass_plate", standing="plain")
SECTOR = Formula(
    "M_[{k}]", "ρ (r_[e]^[2] − r_[i]^[2]) β/2 L", "{rho} · ({re:9}^[2] − {ri:9}^[2]) · {beta}/2 · {L}", "kg",
    meaning="mass_sector", standing="plain",
)  # fmt: skip
DISC = Formula("M_[{k}]", "ρ π r^[2] L", "{rho} · π · {r}^[2] · {L}", "kg", meaning="mass_disc", standing="plain")
CONE = Formula("M_[{k}]", "ρ π r^[2] h/3", "{rho} · π · {r}^[2] · {h}/3", "kg", meaning="mass_cone", standing="plain")
HOLLOW_CONE = Formula(
    "M_[{k}]", "ρ π r^[2] h/3 (1 − c^[3])", "{rho} · π · {r}^[2] · {h}/3 · (1 − {c:9}^[3])", "kg",
    meaning="mass_hollow_cone", standing="plain",
)  # fmt: skip
SUM_OF_PARTS = Formula("M_[{k}]", "Σ M_[{k},i]", "{M:9} + …", "kg", meaning="mass_of_parts", standing="plain")
SHARE_OF_MASS = Formula("M_[{k}]", "M s_[{k}]", "{M} · {share}", "kg", meaning="mass_share", standing="plain")
MASS_GIVEN = Formula("M_[{k}]", unit="kg", meaning="mass_given", standing="plain")
MASS_OF_MECHANISM = replace(MASS_GIVEN, meaning="mass_of_mechanism")

# Instantaneous centres of rotation and rotations of the blocks, by the theorem of Aronhold and Kennedy. Of two lines, u
# runs from a to b or from a in a given direction, v from c likewise; w is from a to c.
_ENDS = {"u": ("a", "b"), "v": ("c", "d"), "w": ("a", "c")}


def _of_lines(pattern: str, points: tuple[int, int]) -> tuple[str, str]:
    """Return a formula in components such as ux in symbols and with slots, of lines through one or two points."""
    symbols, numbers = pattern.replace("*", " "), pattern.replace("*", " · ")
    for (line, (start, end)), axis in product(_ENDS.items(), "xy"):
        symbol, slot = f"({axis}_[{{{end}}}] − {axis}_[{{{start}}}])", f"({{{end}{axis}:9}} − {{{start}{axis}:9}})"
        if {"u": points[0], "v": points[1]}.get(line) == 1:
            symbol, slot = f"{line}_[{axis}]", f"{{{line}{axis}:9}}"
        symbols, numbers = symbols.replace(line + axis, symbol), numbers.replace(line + axis, slot)
    return symbols, numbers


PARALLEL = {
    points: Formula("D", *_of_lines("ux*vy − uy*vx", points), meaning=meaning, standing="plain")
    for points, meaning in {
        (2, 2): "lines_parallel", (2, 1): "lines_parallel_along", (1, 1): "lines_parallel_both"
    }.items()
}  # fmt: skip
SHARE = {
    points: Formula(
        "t", *_of_lines("(wx*vy − wy*vx)/(ux*vy − uy*vx)", points), meaning=meaning, standing="plain", digits=9
    )
    for points, meaning in {(2, 2): "lines_cross", (2, 1): "lines_cross_along", (1, 1): "lines_cross_both"}.items()
}
SHARE_LEVEL = Formula(
    "t", "(y_[{c}] − y_[{a}])/(y_[{b}] − y_[{a}])", "({cy:9} − {ay:9})/({by:9} − {ay:9})", meaning="lines_cross_level",
    standing="plain", digits=9,
)  # fmt: skip
CENTRE = {
    2: Formula(
        "{axis}_[{O}]", "{axis}_[{a}] + t ({axis}_[{b}] − {axis}_[{a}])", "{a:9} + {t:9} · ({b:9} − {a:9})", "m",
        meaning="centre", standing="plain", digits=9,
    ),
    1: Formula(
        "{axis}_[{O}]", "{axis}_[{a}] + t u_[{axis}]", "{a:9} + {t:9} · {u:9}", "m", meaning="centre",
        standing="plain", digits=9,
    ),
}  # fmt: skip
LEADS = Formula("θ_[{k}]′", meaning="leads", standing="plain")
TURNS = Formula(
    "θ_[{k}]′", "θ_[{i}]′ ({axis}_[{C}] − {axis}_[{Oi}])/({axis}_[{C}] − {axis}_[{Ok}])",
    "{t:9} · ({C:9} − {Oi:9})/({C:9} − {Ok:9})", meaning="turns", standing="plain", digits=9,
)  # fmt: skip
TURNS_ALIKE = Formula("θ_[{k}]′", "θ_[{i}]′", "{t:9}", meaning="turns_alike", standing="plain", digits=9)
TRANSLATES = Formula("θ_[{k}]′", meaning="translates", standing="plain")
X_TRANSLATES = Formula(
    "x_[{k}]′", "θ_[{i}]′ (y_[{C}] − y_[{Oi}])", "{t:9} · ({C:9} − {O:9})", "m", meaning="x_translates",
    standing="plain",
)  # fmt: skip
Y_TRANSLATES = Formula(
    "y_[{k}]′", "θ_[{i}]′ (x_[{Oi}] − x_[{C}])", "{t:9} · ({O:9} − {C:9})", "m", meaning="y_translates",
    standing="plain",
)  # fmt: skip
Y_TRANSLATES_BACK = replace(Y_TRANSLATES, text="θ_[{i}]′ (x_[{C}] − x_[{Oi}])", numbers="{t:9} · ({C:9} − {O:9})")

# The capacity curve
A0 = Formula("a_[0]^[*]", "α_[0] g/(e^[*] FC)", "{alpha} · {g}/({e} · {FC})", "m/s²", clauses.A_STAR, meaning="a0")
X_C = Formula("x_[C]′", "Σ (P+Q) x′/Σ (P+Q)", "{first}/{PQ}", "m", clauses.D, meaning="control_barycentre",
              standing="ours")  # fmt: skip
X_C_TURNS = Formula(
    "x_[C]′", "θ′ (y_[C] − y_[O])", "{turns} · ({y:9} − {O:9})", "m", clauses.D, meaning="control_point"
)
X_C_STRAIGHT = Formula("x_[C]′", "x′", "{x}", "m", clauses.D, meaning="control_point")
PHI_0 = Formula("φ_[0]", "α(φ) = 0", "", "rad", clauses.D, meaning="phi_0")
PHI = Formula("φ_[{state}]", "d(φ) = d_[{state}]", "", "rad", clauses.D, meaning="phi")
D_C = Formula("d_[C]({at})", "Σ (P+Q) Δx/Σ (P+Q)", "({P} · {x} + …)/{PQ}", "m", clauses.D, meaning="d_C")
D_C_POINT = Formula("d_[C]({at})", "|x_[C](φ) − x_[C](0)|", "{one:9} − {other:9}", "m", clauses.D, meaning="d_C")
D = Formula(
    "{symbol}", "d_[C] Σ (P+Q) x′^[2]/(x_[C]′ Σ (P+Q) x′)", "{d} · {second}/({x} · {first})", "m", clauses.D,
)  # fmt: skip

# Limit states
BROKEN = Formula("d_[t]", "ΔL = {length} m", "", "m", meaning="d_t", standing="plain")
SEAT = Formula("d_[a]", "Δx_[{name}] = {length} m", "", "m", clauses.LIMITS, meaning="d_a")
SEAT_MOVED = Formula(
    "Δx_[{name}]", "|x(φ_[{state}]) − x(0)|", "{one:9} − {other:9}", "m", meaning="seat_moved", standing="plain"
)
ALLOWED = Formula("d_[{state}]", "{share} d_[0]^[*]", "{share} · {d0}", "m", clauses.LIMITS, meaning="d_state")
ALLOWED_LEAST = Formula(
    "d_[{state}]", "min({share} d_[0]^[*]; {ends})", "min({share} · {d0}; {d}; …)", "m", clauses.LIMITS,
    meaning="d_state",
)  # fmt: skip
A_THERE = Formula(
    "a^[*]_[{on}]", "α(φ_[{state}]) g/(e^[*] FC)", "{alpha} · {g}/({e} · {FC})", "m/s²", clauses.A_STAR,
    meaning="a_there",
)  # fmt: skip
A_LINE = Formula(
    "a^[*]_[{on}]", "a_[0]^[*] (1 − d_[{state}]/d_[0]^[*])", "{a0} · (1 − {d}/{d0})", "m/s²", clauses.LINE,
    meaning="a_line",
)  # fmt: skip
A_ELASTIC = Formula(
    "a_[{on}]", "min(a^[*]_[{on}]; 4 π^[2] d_[{state}]/T_[0]^[2])", "min({a}; 4 · π^[2] · {d}/{T0}^[2])", "m/s²",
    clauses.ELASTIC, meaning="a_elastic",
)  # fmt: skip
PERIOD = {
    rule.state: Formula(
        "T_[{on}]", f"{rule.factor:g} π √(d_[{{state}}]/{{a}})", f"{rule.factor:g} · π · √({{d}}/{{a}})", "s",
        rule.clause, meaning="T",
    )
    for rule in RULES
}  # fmt: skip
RHO = Formula("ρ_[{on}]", "d_[{state}]/S_[De](T_[{on}])", "{d}/{demand}", "", clauses.NONLINEAR, meaning="rho")

# Methods
CAPACITY = Formula("{symbol}", "a_[g] · {capacity}/{demand}", "{ag} · {c}/{d}", "g", meaning="a_g_method")
START = replace(CAPACITY, meaning="a_g_start")
CAPACITY_FOUND = Formula("{symbol}", "{demand}(a_[g]) = {capacity}", "", "g", standing="ours")
LINEAR = Formula("a_[g,q]", "q · a_[g,0]", "{q} · {a}", "g", clauses.LINEAR, meaning="a_g_method")
ZETA = Formula("ζ_[E{more}]", "{symbol}/{asked}", "{a}/{b}", "", clauses.ZETA, meaning="zeta")
LASTS = Formula(
    "T_[R{more}]", "{demand}(T_[R]) = {capacity}", "", "years", meaning="TR_capacity", standing="plain", digits=9
)
