"""How the numbers of a verification by the Italian code came about, line by line."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import sqrt

from rocking_cli.codes.italian import clauses
from rocking_cli.codes.italian.capacity import ExactCurve
from rocking_cli.codes.italian.chain import Chain
from rocking_cli.codes.italian.demand import (
    FloorSpectrum,
    GroundSpectrum,
    Spectrum,
    correction,
)
from rocking_cli.codes.italian.ground import Ground
from rocking_cli.codes.italian.hazard import (
    PROBABILITY,
    TOPOGRAPHY,
    corner_factor,
    return_period,
    soil_factor,
)
from rocking_cli.codes.italian.results import Method, State
from rocking_cli.codes.italian.rules import RULES, Rule
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.studies.verification.working import Standing, Working

STATES = ("SLD", "SLV", "SLC")


def _n(value: float) -> str:
    return f"{value:.6g}"


def of_ground(ground: Ground) -> list[Working]:
    """Of the site: the ground at each limit state that is known, and the floor."""
    site = ground.site
    found = [
        Working(
            "FC", "confidence factor, by which accelerations are divided", "given", "", site.FC, "", clauses.A_STAR
        ),
        Working("q", "behaviour factor of the linear method", "given", "", site.q, "", clauses.LINEAR),
    ]
    if site.element is not None:
        one = site.element
        L, t = one.size
        put = f"{one.kappa} x {_n(L)}/{_n(t)} x {_n(L)}"
        put += f" x sqrt({_n(one.w)}/({_n(one.E)} x {STANDARD_GRAVITY}))"
        formula = "kappa (L/t) L sqrt(w/(E g))"
        found.append(Working("T0", "period of the element", formula, put, one.period, "s", clauses.OWN_PERIOD))
    for state in STATES:
        found += _of_hazard(ground, state)
        spectrum = ground.spectrum(state)
        if spectrum is not None:
            found += _of_spectrum(ground, state, spectrum)
    return found


def _of_hazard(ground: Ground, state: str) -> Iterator[Working]:
    hazard, site = ground.hazard, ground.site
    TR = ground.return_period(state)
    if hazard is None or TR is None or site.VN is None or site.CU is None:
        return
    life, P = site.VN * site.CU, PROBABILITY[state]
    put = f"-{_n(life)}/ln(1 - {P:g}) = {_n(return_period(life, state))}"
    yield Working(f"TR,{state}", "return period", "-VN CU/ln(1 - P)", put, TR, "years", clauses.RETURN_PERIOD)
    ag, F0, TC_star = hazard.parameters(TR)
    S_S, S_T, C_C = soil_factor(site.soil or "A", F0, ag), TOPOGRAPHY[site.topography], corner_factor(
        site.soil or "A", TC_star)  # fmt: skip
    table = "log-log interpolation"
    yield Working(f"a_g,{state}", "ground acceleration on rock", table, f"at TR = {_n(TR)}", ag, "g", clauses.HAZARD)
    yield Working(f"F0,{state}", "amplification", table, f"at TR = {_n(TR)}", F0, "", clauses.HAZARD)
    yield Working(f"TC*,{state}", "period on rock", table, f"at TR = {_n(TR)}", TC_star, "s", clauses.HAZARD)
    put = f"{_n(S_S)} x {_n(S_T)}"
    yield Working(f"S,{state}", "soil and topography", "S_S S_T", put, S_S * S_T, "", clauses.S)
    put = f"{_n(C_C)} x {_n(TC_star)}"
    yield Working(f"TC,{state}", "end of the level part", "C_C TC*", put, C_C * TC_star, "s", clauses.TC)


def _of_spectrum(ground: Ground, state: str, spectrum: Spectrum) -> Iterator[Working]:
    on_ground = spectrum.ground if isinstance(spectrum, FloorSpectrum) else spectrum
    if isinstance(on_ground, GroundSpectrum):
        put = f"{_n(on_ground.ag)} x {_n(on_ground.S)}"
        yield Working(
            f"a_g S,{state}",
            "peak of the ground",
            "a_g S",
            put,
            on_ground.peak / STANDARD_GRAVITY,
            "g",
            clauses.SPECTRUM,
        )
        put = f"4 x {_n(on_ground.ag)} + 1.6"
        yield Working(f"TD,{state}", "corner period", "4 a_g/g + 1.6", put, on_ground.TD, "s", clauses.TD)
    else:
        yield Working(
            f"a_g S,{state}", "peak of the ground", "ordinate at T = 0", "", on_ground.peak / STANDARD_GRAVITY, "g",
            clauses.NONLINEAR,
        )  # fmt: skip
    if isinstance(spectrum, FloorSpectrum):
        yield from _of_floor(state, spectrum)
    T0 = ground.site.own_period
    if T0 is not None:
        value = spectrum.acceleration(T0, 0.05) / STANDARD_GRAVITY
        name = "S_eZ" if isinstance(spectrum, FloorSpectrum) else "S_e"
        yield Working(
            f"{name}(T0),{state}", "what starts an element that vibrates", f"{name}(T0, 5 %)", f"T0 = {_n(T0)}",
            value, "g", clauses.DAMAGE_VIBRATING,
        )  # fmt: skip


def _of_floor(state: str, floor: FloorSpectrum) -> Iterator[Working]:
    yield Working(f"T1,{state}", "first period of the building", "given", "", floor.T1, "s", clauses.MODE, "plain")
    yield Working(f"xi1,{state}", "damping ratio of the building", "given", "", floor.xi1, "", clauses.MODE, "plain")
    yield Working("psi", "shape of the first mode", "z/H", f"{_n(floor.z)}/{_n(floor.H)}", floor.psi, "", clauses.PSI)
    put = f"3 x {floor.n}/(2 x {floor.n} + 1)"
    yield Working("gamma", "participation of the first mode", "3n/(2n + 1)", put, floor.gamma, "", clauses.GAMMA)
    start = floor.ground.acceleration(floor.T1, floor.xi1) / STANDARD_GRAVITY
    put = f"{_n(start)} x {_n(floor.gamma)} x {_n(floor.psi)} x {_n(sqrt(1 + 4 * floor.xi1**2))}"
    yield Working(
        f"S_Z,{state}", "peak of the floor", "S_e(T1, xi1) gamma psi sqrt(1 + 4 xi1^2)", put,
        floor.peak / STANDARD_GRAVITY, "g", clauses.FLOOR_PEAK,
    )  # fmt: skip
    damping = next((rule.damping for rule in RULES if rule.state == state), 0.05)
    put = f"1.1 x {_n(floor.xi1)}^-1/2 x {_n(correction(damping))}"
    yield Working(
        f"A,{state}", f"amplification at {100 * damping:g} %", "1.1 xi1^-1/2 eta(xi), xi1 as a ratio", put,
        floor.amplification(damping), "", clauses.AMPLIFICATION, "ours",
    )  # fmt: skip


def of_direction(
    curve: ExactCurve, states: Mapping[str, State], methods: Mapping[str, Method], ground: Ground
) -> list[Working]:
    """Of one direction: the chain, the curve, the limit states and what each method says."""
    return [
        *_of_chain(curve.chain),
        *_of_curve(curve),
        *_of_states(curve, states, ground),
        *_of_methods(methods, ground),
    ]


def _of_chain(chain: Chain) -> Iterator[Working]:
    letter: Standing = "code" if chain.is_by_the_letter else "ours"
    size, unit = (1e3, "kN") if chain.mechanism.has_mass else (1.0, "N per kg")
    for k, block in enumerate(chain.blocks, 1):
        whole, at = " and ".join(block.bodies), f"at [{_n(block.at.real)}, {_n(block.at.imag)}] m"
        yield Working(f"P{k}", f"weight carried by {whole}", "", "", block.P / size, unit, clauses.ALPHA0)
        yield Working(
            f"P{k} + Q{k}", f"weight moved sideways with {whole}", "", at, block.PQ / size, unit, clauses.ALPHA0, letter
        )
        yield Working(f"x{k}'", f"virtual displacement sideways of {whole}", "", "", block.dx, "m", clauses.ALPHA0)
        yield Working(f"y{k}'", f"virtual displacement upwards of {whole}", "", "", block.dy, "m", clauses.ALPHA0)
    for name, work in chain.works.items():
        yield Working(f"L({name})", f"work of {name} per unit rotation, at rest", "", "", work, "N m", clauses.ALPHA0)
    forces, ties = chain.held_by(ties=False), chain.held_by(ties=True)
    put = f"({_n(chain.lifted)} + {_n(forces)} + {_n(ties)})/{_n(chain.first)}"
    formula = "(sum P y' - sum F.r' + internal work)/sum (P+Q) x'"
    yield Working("alpha0", "activation multiplier", formula, put, chain.alpha0, "", clauses.ALPHA0)
    put = f"{_n(chain.first)}^2/({_n(chain.inertial)} x {_n(chain.second)})"
    formula = "[sum (P+Q) x']^2/{sum (P+Q) sum (P+Q) x'^2}"
    yield Working("e*", "participating mass ratio", formula, put, chain.e_star, "", clauses.E_STAR)
    if chain.mechanism.has_mass:
        mass, put = chain.e_star * chain.inertial / chain.mechanism.gravity, (
            f"{_n(chain.e_star)} x {_n(chain.inertial)}/{_n(chain.mechanism.gravity)}"
        )  # fmt: skip
        yield Working("M*", "participating mass", "e* sum (P+Q)/g", put, mass, "kg", clauses.OUTSIDE, "ours")


def _of_curve(curve: ExactCurve) -> Iterator[Working]:
    chain, g = curve.chain, curve.chain.mechanism.gravity
    put = f"{_n(chain.alpha0)} x {_n(g)}/({_n(chain.e_star)} x {_n(curve.confidence)})"
    yield Working(
        "a0*", "acceleration that activates the mechanism", "alpha0 g/(e* FC)", put, curve.a0, "m/s2", clauses.A_STAR
    )
    moved = chain.displacement_of_control(curve.end, curve.control)
    factor = chain.second / (chain.sideways(curve.control) * chain.first)
    put = f"{_n(moved)} x {_n(chain.second)}/({_n(chain.sideways(curve.control))} x {_n(chain.first)})"
    formula = "d_C sum (P+Q) x'^2/(x_C' sum (P+Q) x') where a* = 0"
    yield Working("d0*", "displacement at which a* vanishes", formula, put, moved * factor, "m", clauses.D)
    where = "barycentre of P + Q" if curve.control.body is None else f"a point of {curve.control.body}"
    at = f"[{_n(curve.control.at.real)}, {_n(curve.control.at.imag)}] m"
    yield Working(
        "x_C'", f"virtual displacement of the control point, {where}", "", at, chain.sideways(curve.control), "m",
        clauses.D, "ours" if curve.control.body is None else "code",
    )  # fmt: skip


def _of_states(curve: ExactCurve, states: Mapping[str, State], ground: Ground) -> Iterator[Working]:
    for rule in RULES:
        at, s = states[rule.state], rule.state
        broken = rule.at_breaks and curve.broken is not None and at.d == curve.broken
        off = curve.seat is not None and at.d == curve.seat.d
        formula = "displacement of a break" if broken else "loss of a seat" if off else f"{rule.share:g} d0*"
        put = "" if broken or off else f"{rule.share:g} x {_n(curve.d0)}"
        yield Working(f"d_{s}", f"displacement capacity at {s}", formula, put, at.d, "m", clauses.LIMITS)
        formula = f"alpha g/(e* FC) at d_{s}"
        yield Working(f"a*(d_{s})", "acceleration there", formula, "", at.a, "m/s2", clauses.A_STAR)
        put = f"{rule.factor:g} pi sqrt({_n(at.d)}/{_n(at.a)})"
        formula = f"{rule.factor:g} pi sqrt(d_{s}/a*(d_{s}))"
        yield Working(f"T_{s}", f"period at {s}", formula, put, at.T, "s", rule.clause)
        if at.demand is not None:
            yield _of_demand(rule, at, at.demand, ground)


def _of_demand(rule: Rule, at: State, demand: float, ground: Ground) -> Working:
    spectrum = ground.spectrum(rule.state)
    eta = f"eta = sqrt(10/(5 + {100 * rule.damping:g})) = {_n(correction(rule.damping))}"
    meaning = f"displacement demand at {rule.state}"
    symbol = f"S_De(T_{rule.state})"
    if isinstance(spectrum, FloorSpectrum):
        formula = "S_eZ T^2/4 pi^2, above b T1 not less than there, above T1 not less than the ground's"
        own = spectrum.alone(at.T, rule.damping) * (at.T / 6.283185307179586) ** 2
        put = f"{eta}, T = {_n(at.T)}: {_n(own)} of the floor alone"
        return Working(symbol, meaning, formula, put, demand, "m", clauses.FLOOR_DISPLACEMENT)
    if isinstance(spectrum, GroundSpectrum):
        put = f"{eta}, T = {_n(at.T)}"
        return Working(symbol, meaning, "S_e T^2/4 pi^2, above T_E less", put, demand, "m", clauses.DISPLACEMENTS)
    put = f"{eta}, T = {_n(at.T)}"
    return Working(symbol, meaning, "largest S_e t^2/4 pi^2 of T0 <= t <= T", put, demand, "m", clauses.NONLINEAR)


FORMULAS = {
    "damage": "demand of a_g equals a0*",
    "linear": "q times the a_g whose demand, by the ground of SLD, equals a0*",
    "damage_SLC": "demand of a_g equals a0*, by the ground of SLC",
    "nonlinear": "S_De(T_SLV) of a_g equals d_SLV",
    "nonlinear_SLC": "S_De(T_SLC) of a_g equals d_SLC",
    "SLD": "demand of a_g equals a0*, by F0, TC and S of SLD",
}


def _of_methods(methods: Mapping[str, Method], ground: Ground) -> Iterator[Working]:
    for key, method in methods.items():
        if method.a_g is None:
            continue
        put = f"{_n(ground.site.q)} x {_n(method.a_g / ground.site.q)}" if key == "linear" else ""
        ours: Standing = "ours" if key == "linear" and ground.state_of_activation != "SLD" else "code"
        yield Working(f"a_g,{key}", method.title, FORMULAS[key], put, method.a_g, "g", method.clause, ours)
        if method.zeta is not None and method.asked is not None:
            put = f"{_n(method.a_g)}/{_n(method.asked)}"
            yield Working(f"zeta_E,{key}", "capacity over demand", "a_g S of both", put, method.zeta, "", clauses.ZETA)
