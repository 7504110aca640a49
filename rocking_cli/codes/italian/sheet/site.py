"""Steps to the ground motion at each limit state in the sheet: values of the site file, hazard, spectra, floor."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from math import log
from typing import Any

import numpy as np
from markupsafe import Markup

from rocking_cli.codes.italian import formulas as F
from rocking_cli.codes.italian.demand import (
    GROUND_PERIOD,
    LEVEL_FROM,
    LEVEL_TO,
    LONG_PERIOD_START,
    REFERENCE_DAMPING,
    DemandSpectrum,
    FloorSpectrum,
    GroundSpectrum,
    TableSpectrum,
    correction,
)
from rocking_cli.codes.italian.ground import (
    LONGEST_RETURN_PERIOD,
    PROBABILITY,
    SHORTEST_RETURN_PERIOD,
    SOILS,
    TOPOGRAPHY,
    Hazard,
    RockMotion,
    SiteGround,
    bounded,
    corner_factor,
    return_period,
    soil_factor,
)
from rocking_cli.codes.italian.rules import FIRST_STATE, FURTHER_STATES, RULES, STATES
from rocking_cli.codes.italian.sheet.chain import Rows
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.verification.results import Evaluated, Formula
from rocking_cli.views.sheet.language import Language

OF_GROUND = {
    "ag": ("a_[g]", "g", "ground acceleration on rock, {state}"),
    "F0": ("F_[0]", "", "amplification of the spectrum, {state}"),
    "TC": ("T_[C]", "s", "end of the constant-acceleration branch, {state}"),
    "S": ("S", "", "soil and topography factor, {state}"),
    "TC_star": ("T_[C]^[*]", "s", "end of the constant-acceleration branch on rock, {state}"),
}
OF_SITE = {
    "VN": ("V_[N]", "years", "nominal life"),
    "use": ("C_[U]", "", "coefficient of use"),
    "class_": ("", "", "class of use"),
    "longitude": ("", "deg", "longitude"),
    "latitude": ("", "deg", "latitude"),
    "grid": ("", "", "reference grid"),
    "T0": ("T_[0]", "s", "given_T0"),
    "states": ("", "", "limit states to verify"),
    "soil": ("", "", "soil class"),
}
OF_FLOOR = {
    "z": ("z", "m", "height of the floor above the foundation"),
    "H": ("H", "m", "height of the building"),
    "n": ("n", "", "number of storeys"),
}
"""Symbol, unit and meaning of fields of the site file."""


def states(ground: SiteGround) -> list[str]:
    """Return the limit states that the site gives."""
    return [each for each in STATES if ground.spectrum(each) is not None]


def given(ground: SiteGround) -> Iterator[Evaluated]:
    """Yield the values of the site file that belong to a clause of the code."""
    site = ground.site
    yield F.FC.line(site.FC)
    yield F.Q.line(site.q)
    for state in STATES:
        known = ground.spectrum(state) is not None or getattr(site.floor, state, None) is not None
        if site.floor is not None and known:
            mode = site.floor.mode(state)
            yield F.T1.line(mode.T1, {"state": state})
            yield F.XI1.line(mode.xi1, {"state": state})


def data(say: Language, ground: SiteGround, given_FC: float) -> Rows:
    """Return a row for each value of the site file, without its tables: symbol, meaning, value and unit.

    FC has a second row if another one than in the file counts.
    """
    site = ground.site
    lines = map(say.written, given(ground))
    FC, q, *modes = ([Markup(row.symbol), row.meaning, row.value, row.unit] for row in lines)
    replaced = [[FC[0], say("replaced_FC"), given_FC, ""]] if given_FC != site.FC else []
    rows = [*replaced, FC, q]
    for state in (FIRST_STATE, *FURTHER_STATES):
        at = site.shaking(state)
        if at is not None and at.spectrum is not None:
            meaning = say("ground acceleration, the ordinate of the table at T = 0, {state}", state=state)
            rows.append([Markup("a_[g]"), meaning, at.spectrum[0][1], "g"])
        rows += _values(say, at, OF_GROUND, state=state)
    rows += _values(say, site, OF_SITE)
    if ground.on_rock(FIRST_STATE) is not None:
        rows.append([Markup("`topography`"), say("topographic class"), site.topography, ""])
    return [*rows, *_values(say, site.floor, OF_FLOOR), *modes]


def _values(say: Language, part: object, fields: Mapping[str, tuple[str, str, str]], **names: str) -> list[list[Any]]:
    """Return the table rows of those fields that the site file gives."""
    values = {key: getattr(part, key, None) for key in fields}
    return [
        [Markup(symbol or f"`{key.rstrip('_')}`"), Markup(say(meaning, **names)), _shown(value), say(unit)]
        for key, (symbol, unit, meaning) in fields.items() if (value := values[key]) is not None
    ]  # fmt: skip


def _shown(value: Any) -> str | float:
    return ", ".join(value) if isinstance(value, list) else value if isinstance(value, str) else float(value)


def of_state(ground: SiteGround, state: str) -> list[Evaluated]:
    """Return the lines to the ground, or floor, at a limit state that the site gives."""
    spectrum = ground.spectrum(state)
    assert spectrum is not None  # only limit states with a spectrum are shown
    return [*_of_life(ground, state), *peaks(spectrum, state)]


def of_element(ground: SiteGround) -> list[Evaluated]:
    """Return the line to the own period of an element from its size; empty if the site does not give it."""
    one = ground.site.element
    if one is None:
        return []
    L, t = one.size
    sizes = {"kappa": one.kappa, "L": L, "t": t, "w": one.w, "E": one.E, "g": STANDARD_GRAVITY}
    return [F.OWN_PERIOD.line(one.period, **sizes)]


def at_own_period(ground: SiteGround, state: str) -> list[Evaluated]:
    """Return the lines to the demand on an element that is free to vibrate, at a limit state."""
    spectrum, T0 = ground.spectrum(state), ground.site.own_period
    assert spectrum is not None and T0 is not None
    return list(ordinate_at_own_period(spectrum, T0, REFERENCE_DAMPING))


def _of_life(ground: SiteGround, state: str) -> Iterator[Evaluated]:
    """Yield the steps to the return period of a limit state, and to the ground on the soil."""
    site, TR, hazard, rock = ground.site, ground.return_period(state), ground.hazard, ground.on_rock(state)
    if site.life is not None and TR is not None and site.VN is not None:
        bound = F.REFERENCE_LIFE if is_close(site.VN * (site.use or 0.0), site.life) else F.REFERENCE_LIFE_BOUND
        yield bound.line(site.life, VN=site.VN, CU=site.use)
        yield from _to_return_period(ground, state, site.life, TR)
    if rock is None:
        return
    if hazard is not None and TR is not None:
        yield from _on_rock(hazard, TR, is_row=state in hazard.rounded(site.life or 0.0))
    yield from _on_soil(site.soil or "A", site.topography, rock)


def _to_return_period(ground: SiteGround, state: str, life: float, TR: float) -> Iterator[Evaluated]:
    """Yield the steps to the return period of a limit state from the reference life [years]."""
    P, exact, hazard = PROBABILITY[state], return_period(life, state), ground.hazard
    is_row = hazard is not None and state in hazard.rounded(life)
    period = bounded(exact) if is_row else TR
    ends = [row[0] for row in hazard.table] if hazard is not None and not is_row else [0.0, LONGEST_RETURN_PERIOD]
    first, last = max(SHORTEST_RETURN_PERIOD, ends[0]), min(LONGEST_RETURN_PERIOD, ends[-1])
    formula = F.RETURN_PERIOD if is_close(exact, period) else F.RETURN_PERIOD_BOUND
    yield formula.line(period, {"state": state, "percent": 100 * P}, VR=life, P=P, first=first, last=last)
    if is_row:
        yield F.RETURN_PERIOD_OF_ROW.line(TR, {"state": state})


def is_close(one: float, other: float) -> bool:
    """Return whether two numbers are equal within rounding."""
    return abs(one - other) <= 1e-9 * abs(other)


def hazard_at(hazard: Hazard, TR: float) -> Iterator[Evaluated]:
    """Yield the steps to the ground at a return period, from the adjacent rows of the table."""
    yield from _on_rock(hazard, TR)
    yield from _on_soil(hazard.soil, hazard.topography, hazard.parameters(TR))


def _on_rock(hazard: Hazard, TR: float, *, is_row: bool = False) -> Iterator[Evaluated]:
    parameters = hazard.parameters(TR)
    if is_row:
        for formula, value in zip(F.ON_ROCK, parameters, strict=True):
            yield replace(formula, text="", numbers="").line(value)
        return
    last = len(hazard.table) - 2
    k = min(next((k for k, row in enumerate(hazard.table[1:]) if row[0] >= TR), last), last)
    low, high = hazard.table[k], hazard.table[k + 1]
    r = log(TR / low[0]) / log(high[0] / low[0])
    yield F.BETWEEN.line(r, T=TR, a=low[0], b=high[0])
    for j, (formula, value) in enumerate(zip(F.ON_ROCK, parameters, strict=True), 1):
        yield formula.line(value, a=low[j], b=high[j], r=r)


def _on_soil(soil: str, topography: str, rock: RockMotion) -> Iterator[Evaluated]:
    first, second, least, most, factor, power = SOILS[soil]
    S_S, S_T, C_C = soil_factor(soil, rock.F0, rock.ag), TOPOGRAPHY[topography], corner_factor(soil, rock.TC_star)
    sizes = {"least": least, "most": most, "first": first, "second": second}
    names = {key: f"{value:.2f}" if key in ("first", "second") else f"{value:.3g}" for key, value in sizes.items()}
    names |= {"soil": soil, "factor": f"{factor:.2f}", "power": f"{power:.2f}".replace("-", "−")}
    yield (F.SOIL if second else F.SOIL_A).line(S_S, names, F0=rock.F0, ag=rock.ag, **sizes)
    yield F.S.line(S_S * S_T, S_S=S_S, S_T=S_T)
    corner = F.CORNER if power else F.CORNER_A
    yield corner.line(C_C, names, factor=factor, T=rock.TC_star, power=names["power"])
    yield F.TC.line(rock.on_soil(soil, topography).TC, C=C_C, T=rock.TC_star)


def amplifications(ground: SiteGround) -> Iterator[Evaluated]:
    """Yield the step for the amplification A of a floor at each limit state that the site gives."""
    damping = {rule.state: rule.damping for rule in RULES}
    for state in STATES:
        spectrum = ground.spectrum(state)
        if isinstance(spectrum, FloorSpectrum):
            yield amplified(spectrum, damping.get(state, REFERENCE_DAMPING), state)


G = STANDARD_GRAVITY


@dataclass(frozen=True)
class At:
    """A period at which a spectrum is evaluated: its symbol, its value [s], and the damping ratio with its symbol."""

    name: str
    T: float
    damping: float
    xi: str = "ξ"


def corrected(at: At) -> Evaluated:
    """Return the step for the damping correction eta."""
    return F.ETA.line(correction(at.damping), {"xi": at.xi, "percent": 100 * at.damping}, xi=100 * at.damping)


def peaks(spectrum: DemandSpectrum, state: str) -> Iterator[Evaluated]:
    """Yield the steps for the corners of the ground spectrum, its peak, and the peak of the floor."""
    ground = spectrum.ground if isinstance(spectrum, FloorSpectrum) else spectrum
    if isinstance(ground, GroundSpectrum):
        yield F.TB.line(ground.TB, {"state": state}, T=ground.TC)
        yield F.TD.line(ground.TD, {"state": state}, ag=ground.ag)
        yield F.PEAK.line(ground.peak, ag=ground.ag, S=ground.S, g=G)
    elif isinstance(ground, TableSpectrum):
        yield F.PEAK_OF_TABLE.line(ground.peak, a=ground.ag, g=G)
    if isinstance(spectrum, FloorSpectrum):
        yield from _peak_of_floor(spectrum)


def _peak_of_floor(floor: FloorSpectrum) -> Iterator[Evaluated]:
    yield F.PSI.line(floor.psi, z=floor.z, H=floor.H)
    yield F.GAMMA.line(floor.gamma, n=float(floor.n))
    at = At("T_[1]", floor.T1, floor.xi1, "ξ_[1]")
    yield corrected(at)
    yield from acceleration(floor.ground, at)
    under = floor.ground.acceleration(floor.T1, floor.xi1)
    yield F.S_Z.line(floor.peak, S=under, gamma=floor.gamma, psi=floor.psi, xi=floor.xi1)


def acceleration(spectrum: GroundSpectrum | TableSpectrum, at: At) -> Iterator[Evaluated]:
    """Yield the step for S_e at a period; the step for its eta comes before."""
    if isinstance(spectrum, TableSpectrum):
        yield from _of_table(spectrum, at)
        return
    value = spectrum.acceleration(at.T, at.damping)
    yield _branch(spectrum, at.T).line(value, {"at": at.name}, T=at.T, **_of_ground_motion(spectrum, at))


def _branch(spectrum: GroundSpectrum, T: float) -> Formula:
    """Return the formula of the branch of the spectrum at a period."""
    if spectrum.TB > T:
        return F.S_E_RISING
    if spectrum.TC > T:
        return F.S_E_LEVEL
    return F.S_E_FALLING if spectrum.TD > T else F.S_E_LONG


def _of_ground_motion(ground: GroundSpectrum, at: At) -> dict[str, float]:
    """Return values for the slots of the formulas of the ground spectrum."""
    sizes = {"ag": ground.ag, "S": ground.S, "g": G, "F0": ground.F0, "eta": correction(at.damping)}
    return {**sizes, "TB": ground.TB, "TC": ground.TC, "TD": ground.TD}


def _of_table(spectrum: TableSpectrum, at: At) -> Iterator[Evaluated]:
    """Yield the steps to S_e between two ordinates, with the correction that increases from T = 0."""
    T, a = np.array(spectrum.points, dtype=np.float64).T
    k, name = int(np.clip(np.searchsorted(T, at.T, side="right") - 1, 0, len(T) - 2)), {"at": at.name}
    period = np.array([at.T])
    at5, by = float(spectrum.undamped(period)[0]) / G, float(spectrum.corrected(period, at.damping)[0])
    ends = {"a": float(a[k]), "b": float(a[k + 1]), "Ta": float(T[k]), "Tb": float(T[k + 1])}
    yield F.S_5.line(at5, name, k=spectrum.factor, T=at.T, **ends)
    if spectrum.ramp > at.T:
        yield F.ETA_T.line(by, name, eta=correction(at.damping), T=at.T, R=spectrum.ramp)
    yield F.S_E_TABLE.line(spectrum.acceleration(at.T, at.damping), name, a=at5, by=by, g=G)


def displacement(spectrum: DemandSpectrum, at: At) -> Iterator[Evaluated]:
    """Yield the steps to S_De at a period."""
    yield corrected(at)
    if isinstance(spectrum, FloorSpectrum):
        yield from _of_floor(spectrum, at)
    else:
        yield from _undisturbed(spectrum, at, f"S_[De]({at.name})")


def _undisturbed(spectrum: DemandSpectrum, at: At, symbol: str) -> Iterator[Evaluated]:
    """Yield the steps to the displacement spectrum of the ground at a period, under a symbol."""
    value, formula, by = spectrum.displacement(at.T, at.damping), F.S_DE, at
    if isinstance(spectrum, TableSpectrum):
        by, formula = At("t", spectrum.governing(at.T, at.damping), at.damping), F.S_DE_TABLE
        yield F.FURTHEST.line(by.T, {"at": at.name})
    else:
        assert isinstance(spectrum, GroundSpectrum)
        start = LONG_PERIOD_START[spectrum.soil] if spectrum.soil is not None else None
        if start is not None and start < at.T:
            formula = F.S_DE_GROUND if at.T > GROUND_PERIOD else F.S_DE_LONG
            values = {**_of_ground_motion(spectrum, at), "T": at.T, "TE": start, "TF": GROUND_PERIOD}
            yield formula.line(value, {"symbol": symbol}, **values)
            return
    yield from acceleration(spectrum, by)
    S_e = spectrum.acceleration(by.T, at.damping)
    yield formula.line(value, {"symbol": symbol, "at": by.name}, S=S_e, T=by.T)


def amplified(floor: FloorSpectrum, damping: float, state: str = "") -> Evaluated:
    """Return the step for the amplification A of a floor."""
    return F.AMPLIFIED.line(floor.amplification(damping), {"state": state}, eta=correction(damping), xi=floor.xi1)


def _alone(floor: FloorSpectrum, T: float, damping: float, symbol: str) -> Evaluated:
    """Return the step for S_eZ without the lower bound by the ground."""
    low, high = LEVEL_FROM * floor.T1, LEVEL_TO * floor.T1
    formula = F.S_EZ_BELOW if low > T else F.S_EZ_LEVEL if high >= T else F.S_EZ_ABOVE
    values = {"A": floor.amplification(damping), "S": floor.peak, "T": T, "T1": floor.T1}
    return formula.line(floor.alone(T, damping), {"symbol": symbol}, **values)


def _of_floor(floor: FloorSpectrum, at: At) -> Iterator[Evaluated]:
    yield amplified(floor, at.damping)
    yield _alone(floor, at.T, at.damping, f"S_[eZ]({at.name})")
    bounds, names = floor.bounds(at.T, at.damping), ["d_[Z]", "d_[g]", "d_[b]"]
    yield F.D_Z.line(bounds[0], {"at": at.name}, S=floor.alone(at.T, at.damping), T=at.T)
    if at.T > floor.T1:
        yield from _undisturbed(floor.ground, at, "d_[g]")
    if at.T > LEVEL_TO * floor.T1:
        yield F.D_B.line(bounds[2], A=floor.amplification(at.damping), S=floor.peak, T=floor.T1)
    value, listed = floor.displacement(at.T, at.damping), "; ".join(names[: len(bounds)])
    yield F.S_DE_FLOOR.line(value, {"at": at.name, "bounds": listed}, d=bounds)


def ordinate_at_own_period(spectrum: DemandSpectrum, T0: float, damping: float) -> Iterator[Evaluated]:
    """Yield the steps to S_e, or S_eZ, at the period of an element that is free to vibrate."""
    at = At("T_[0]", T0, damping)
    yield corrected(at)
    if not isinstance(spectrum, FloorSpectrum):
        assert isinstance(spectrum, GroundSpectrum | TableSpectrum)
        yield from acceleration(spectrum, at)
        return
    yield amplified(spectrum, damping)
    if spectrum.T1 >= T0:
        yield _alone(spectrum, T0, damping, "S_[eZ](T_[0])")
        return
    yield _alone(spectrum, T0, damping, "S_[eZ,1](T_[0])")
    yield from acceleration(spectrum.ground, at)
    of_floor, under = spectrum.alone(T0, damping), spectrum.ground.acceleration(T0, damping)
    yield F.S_EZ_BOUND.line(spectrum.acceleration(T0, damping), {"at": at.name}, own=of_floor, under=under)
