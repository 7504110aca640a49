"""Steps to the ground at each limit state: what the site file gives, hazard, spectra, floor."""

from __future__ import annotations

from collections.abc import Iterator
from math import log

from rocking_cli.codes.italian import clauses
from rocking_cli.codes.italian.demand import DAMPING, GroundSpectrum
from rocking_cli.codes.italian.ground import Ground
from rocking_cli.codes.italian.hazard import (
    LONGEST,
    PROBABILITY,
    SHORTEST,
    SOILS,
    TOPOGRAPHY,
    Hazard,
    corner_factor,
    return_period,
    soil_factor,
)
from rocking_cli.codes.italian.sheet import spectra
from rocking_cli.codes.italian.site import SIZES, Element, Shaking
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.studies.verification.working import Working
from rocking_cli.views.sheet.document import Grid, Item, Part, Sentence, Steps
from rocking_cli.views.sheet.language import Language

STATES = ("SLD", "SLV", "SLC")
ON_ROCK = (
    ("a_[g]", "ag", "g", "a_[g,#]"),
    ("F_[0]", "F0", "", "F_[0,#]"),
    ("T_[C]^[*]", "TC", "s", "T_[C,#]^[*]"),
)
"""What the rows of a hazard table hold: symbol, name, unit, and symbol in a row on either side."""
SYMBOLS = {"ag": ("a_[g]", "g"), "F0": ("F_[0]", ""), "TC": ("T_[C]", "s"), "S": ("S", "")}


def part(say: Language, ground: Ground) -> Part:
    """What the site does, a part for each limit state that it gives."""
    states = [each for each in STATES if ground.spectrum(each) is not None]
    return Part("site", say.say("site"), [_given(say, ground)], [_of_state(say, ground, each) for each in states])


def _given(say: Language, ground: Ground) -> Grid:
    """What the file says, beside tables."""
    site = ground.site
    rows = [["FC", say.say("given_FC"), say.number(site.FC), ""], ["q", say.say("given_q"), say.number(site.q), ""]]
    for state, given in (("SLV", site), ("SLC", site.SLC), ("SLD", site.SLD)):
        rows += _sizes(say, state, given)
    for key, symbol, unit in (("VN", "V_[N]", "years"), ("CU", "C_[U]", ""), ("T0", "T_[0]", "s")):
        value = getattr(site, key)
        if value is not None:
            rows.append(
                [symbol, say.say(f"given_{key}"), say.number(value), say.say(unit) if unit == "years" else unit]
            )
    if site.soil is not None:
        rows.append(["", say.say("given_soil"), site.soil, ""])
    if ground.hazard is not None:
        rows.append(["", say.say("given_topography"), site.topography, ""])
    if site.floor is not None:
        for key, symbol, unit in (("z", "z", "m"), ("H", "H", "m"), ("n", "n", "")):
            rows.append([symbol, say.say(f"given_{key}"), say.number(float(getattr(site.floor, key))), unit])
        for state in STATES:
            if ground.spectrum(state) is None and getattr(site.floor, state, None) is None:
                continue
            mode = site.floor.mode(state)
            rows.append(["T_[1]", say.say("given_T1", state=state), say.number(mode.T1), "s"])
            rows.append(["ξ_[1]", say.say("given_xi1", state=state), say.number(mode.xi1), ""])
    return Grid(say.say("given"), [say.say(key) for key in ("symbol", "quantity", "value", "unit")], rows, (2,))


def _sizes(say: Language, state: str, given: Shaking | None) -> Iterator[list[str]]:
    if given is not None and given.spectrum is not None:
        yield ["a_[g]", say.say("given_ordinate", state=state), say.number(given.spectrum[0][1]), "g"]
    if given is None or given.ag is None:
        return
    for key in SIZES:
        symbol, unit = SYMBOLS[key]
        yield [symbol, say.say(f"given_{key}", state=state), say.number(getattr(given, key)), unit]


def _of_state(say: Language, ground: Ground, state: str) -> Part:
    spectrum = ground.spectrum(state)
    assert spectrum is not None  # else it is not shown
    rows = [*_of_life(say, ground, state), *spectra.peaks(say, spectrum, state)]
    items: list[Item] = [Steps(rows)]
    T0 = ground.site.own_period
    if T0 is not None:
        items += [Steps([_own_period(say, site.element)])] if (site := ground.site).element is not None else []
        items += [Sentence(say.say("free")), Steps(list(spectra.at_own_period(say, spectrum, T0, DAMPING)))]
    return Part(f"site-{state}", say.say("ground_at", state=state), items)


def _own_period(say: Language, one: Element) -> Working:
    """The period of an element that is free to vibrate."""
    put = "{k} · {L}/{t} · {L} · √({w}/({E} · {g}))"
    L, t = one.size
    put = say.put(put, k=one.kappa, L=L, t=t, w=one.w, E=one.E, g=STANDARD_GRAVITY)
    return Working("T_[0]", say.say("given_T0"), "κ (L/t) L √(w/(E g))", put, one.period, "s", clauses.OWN_PERIOD)


def _of_life(say: Language, ground: Ground, state: str) -> Iterator[Working]:
    """The return period of a limit state, and the ground at it."""
    site, TR = ground.site, ground.return_period(state)
    if ground.hazard is None or TR is None or site.VN is None or site.CU is None:
        return
    life, P = site.VN * site.CU, PROBABILITY[state]
    put = say.put("{VN} · {CU}", VN=site.VN, CU=site.CU)
    yield Working("V_[R]", say.say("VR"), "V_[N] C_[U]", put, life, say.say("years"), clauses.REFERENCE_LIFE)
    bounds = {"least": max(SHORTEST, ground.hazard.table[0][0]), "most": min(LONGEST, ground.hazard.table[-1][0])}
    put, formula = "−{VR}/ln(1 − {P})", "−V_[R]/ln(1 − P)"
    if not is_close(return_period(life, state), TR):
        put = f"max({{least}}; min({{most}}; {put}))"
    put = say.put(put, VR=life, P=P, **bounds)
    yield Working(
        "T_[R]", say.say("TR", state=state, percent=100 * P), formula, put, TR, say.say("years"), clauses.RETURN_PERIOD
    )
    yield from hazard_at(say, ground.hazard, TR)


def is_close(one: float, other: float) -> bool:
    """Whether two numbers are one but for rounding."""
    return abs(one - other) <= 1e-9 * abs(other)


def hazard_at(say: Language, hazard: Hazard, TR: float) -> Iterator[Working]:
    """The ground at a return period, from the rows of the table on either side."""
    last = len(hazard.table) - 2
    k = min(next((k for k, row in enumerate(hazard.table[1:]) if row[0] >= TR), last), last)
    low, high = hazard.table[k], hazard.table[k + 1]
    r = log(TR / low[0]) / log(high[0] / low[0])
    put = say.put("ln({T}/{a})/ln({b}/{a})", T=TR, a=low[0], b=high[0])
    formula = "ln(T_[R]/T_[R,a])/ln(T_[R,b]/T_[R,a])"
    yield Working("r", say.say("r"), formula, put, r, "", clauses.HAZARD)
    found = hazard.parameters(TR)
    for j, (symbol, key, unit, row) in enumerate(ON_ROCK, 1):
        put = say.put("{a} · ({b}/{a})^[{r}]", a=low[j], b=high[j], r=r)
        low_row, high_row = (row.replace("#", which) for which in "ab")
        formula = f"{low_row} ({high_row}/{low_row})^[r]"
        yield Working(symbol, say.say(f"rock_{key}"), formula, put, found[j - 1], unit, clauses.HAZARD)
    yield from _on_soil(say, hazard, hazard.spectrum(TR), found[2])


def _on_soil(say: Language, hazard: Hazard, spectrum: GroundSpectrum, TC_star: float) -> Iterator[Working]:
    first, second, least, most, factor, power = SOILS[hazard.soil]
    S_S, S_T = soil_factor(hazard.soil, spectrum.F0, spectrum.ag), TOPOGRAPHY[hazard.topography]
    C_C = corner_factor(hazard.soil, TC_star)
    if second:
        put = say.put(
            "max({least}; min({most}; {first} − {second} · {F0} · {ag}))",
            first=first, second=second, least=least, most=most, F0=spectrum.F0, ag=spectrum.ag,
        )  # fmt: skip
        formula = say.formula(f"{least:.3g} ≤ {first:.2f} − {second:.2f} F_[0] a_[g]/g ≤ {most:.3g}")
    else:
        formula, put = "1", "1"
    yield Working("S_[S]", say.say("S_S", soil=hazard.soil), formula, put, S_S, "", clauses.SOIL)
    put = say.put("{S_S} · {S_T}", S_S=S_S, S_T=S_T)
    yield Working("S", say.say("S"), "S_[S] S_[T]", put, S_S * S_T, "", clauses.S)
    formula, put = ("1", "1")
    if power:
        exponent = say.formula(f"{power:.2f}".replace("-", "−"))
        formula = say.formula(f"{factor:.2f} (T_[C]^[*])") + f"^[{exponent}]"
        put = say.put("{factor} · {T}", factor=factor, T=TC_star) + f"^[{exponent}]"
    yield Working("C_[C]", say.say("C_C", soil=hazard.soil), formula, put, C_C, "", clauses.SOIL)
    put = say.put("{C} · {T}", C=C_C, T=TC_star)
    yield Working("T_[C]", say.say("TC"), "C_[C] T_[C]^[*]", put, spectrum.TC, "s", clauses.TC)
