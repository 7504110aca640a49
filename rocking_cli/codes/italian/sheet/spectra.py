"""Steps to the demand on the ground or on a floor at a period: spectra of acceleration and displacement."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from rocking_cli.codes.italian import formulas as F
from rocking_cli.codes.italian.demand import (
    GROUND_PERIOD,
    LEVEL_FROM,
    LEVEL_TO,
    LONG_PERIOD_START,
    DemandSpectrum,
    FloorSpectrum,
    GroundSpectrum,
    TableSpectrum,
    correction,
)
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.verification.results import Evaluated, Formula

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


def at_own_period(spectrum: DemandSpectrum, T0: float, damping: float) -> Iterator[Evaluated]:
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
