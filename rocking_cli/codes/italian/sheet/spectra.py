"""Steps to the demand of the ground, or of a floor, at a period: spectra of acceleration and displacement."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import pi

import numpy as np

from rocking_cli.codes.italian import clauses
from rocking_cli.codes.italian.demand import (
    ABOVE,
    BELOW,
    GROUND,
    LONG,
    FloorSpectrum,
    GroundSpectrum,
    Spectrum,
    TableSpectrum,
    correction,
)
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.studies.verification.working import Working
from rocking_cli.views.sheet.language import Language

G = STANDARD_GRAVITY
DISPLACED = clauses.NONLINEAR


@dataclass(frozen=True)
class At:
    """A period at which a spectrum is asked: what it is called [s], its value, and the damping, a ratio."""

    name: str
    T: float
    damping: float
    xi: str = "ξ"


def corrected(say: Language, at: At) -> Working:
    """eta."""
    per_cent = 100 * at.damping
    return Working(
        f"η({at.xi})", say.say("eta"), say.formula("√(10/(5 + ξ)) ≥ 0.55"),
        say.put("max(√(10/(5 + {xi})); 0.55)", xi=per_cent), correction(at.damping), "", clauses.DAMPING,
    )  # fmt: skip


def peaks(say: Language, spectrum: Spectrum, state: str) -> Iterator[Working]:
    """What the ground does at once: corners of its spectrum, its peak, and that of the floor."""
    ground = spectrum.ground if isinstance(spectrum, FloorSpectrum) else spectrum
    if isinstance(ground, GroundSpectrum):
        yield from _corners(say, ground, state)
        put = say.put("{ag} · {S} · {g}", ag=ground.ag, S=ground.S, g=G)
        yield Working("a_[g] S", say.say("peak"), "a_[g] S g", put, ground.peak, "m/s²", clauses.SPECTRUM)
    elif isinstance(ground, TableSpectrum):
        put = say.put("{a} · {g}", a=ground.ag, g=G)
        yield Working("a_[g] S", say.say("peak_of_table"), "S_[e](0) g", put, ground.peak, "m/s²", DISPLACED)
    if isinstance(spectrum, FloorSpectrum):
        yield from _peak_of_floor(say, spectrum)


def _corners(say: Language, ground: GroundSpectrum, state: str) -> Iterator[Working]:
    yield Working(
        "T_[B]", say.say("TB", state=state), "T_[C]/3", say.put("{T}/3", T=ground.TC), ground.TB, "s", clauses.TB
    )
    put = say.put("4 · {ag} + 1.6", ag=ground.ag)
    yield Working("T_[D]", say.say("TD", state=state), say.formula("4 a_[g]/g + 1.6"), put, ground.TD, "s", clauses.TD)


def _peak_of_floor(say: Language, floor: FloorSpectrum) -> Iterator[Working]:
    yield Working("ψ", say.say("psi"), "z/H", say.put("{z}/{H}", z=floor.z, H=floor.H), floor.psi, "", clauses.PSI)
    put = say.put("3 · {n}/(2 · {n} + 1)", n=float(floor.n))
    yield Working("γ", say.say("gamma"), "3n/(2n + 1)", put, floor.gamma, "", clauses.GAMMA)
    at = At("T_[1]", floor.T1, floor.xi1, "ξ_[1]")
    yield corrected(say, at)
    yield from acceleration(say, floor.ground, at)
    put = say.put(
        "{S} · {gamma} · {psi} · √(1 + 4 · {xi}^[2])",
        S=floor.ground.acceleration(floor.T1, floor.xi1), gamma=floor.gamma, psi=floor.psi, xi=floor.xi1,
    )  # fmt: skip
    formula = "S_[e](T_[1]) γ ψ √(1 + 4 ξ_[1]^[2])"
    yield Working("S_[Z]", say.say("S_Z"), formula, put, floor.peak, "m/s²", clauses.FLOOR_PEAK)


def acceleration(say: Language, spectrum: GroundSpectrum | TableSpectrum, at: At) -> Iterator[Working]:
    """S_e at a period, after its eta."""
    if isinstance(spectrum, TableSpectrum):
        yield from _of_table(say, spectrum, at)
        return
    formula, put = _branch(spectrum, at.T)
    numbers = {"ag": spectrum.ag, "S": spectrum.S, "g": G, "eta": correction(at.damping), "F0": spectrum.F0}
    numbers |= {"TB": spectrum.TB, "TC": spectrum.TC, "TD": spectrum.TD, "T": at.T}
    yield Working(
        f"S_[e]({at.name})", say.say("S_e"), formula, say.put(put, **numbers),
        spectrum.acceleration(at.T, at.damping), "m/s²", clauses.SPECTRUM,
    )  # fmt: skip


def _branch(spectrum: GroundSpectrum, T: float) -> tuple[str, str]:
    """The formula of the branch that a period is on, in symbols and with slots."""
    level, numbers = "a_[g] S g η F_[0]", "{ag} · {S} · {g} · {eta} · {F0}"
    if spectrum.TB > T:
        more = "({T}/{TB} + (1 − {T}/{TB})/({eta} · {F0}))"
        return f"{level} (T/T_[B] + (1 − T/T_[B])/(η F_[0]))", f"{numbers} · {more}"
    if spectrum.TC > T:
        return level, numbers
    if spectrum.TD > T:
        return f"{level} T_[C]/T", f"{numbers} · {{TC}}/{{T}}"
    return f"{level} T_[C] T_[D]/T^[2]", f"{numbers} · {{TC}} · {{TD}}/{{T}}^[2]"


def _of_table(say: Language, spectrum: TableSpectrum, at: At) -> Iterator[Working]:
    """Yield the steps to S_e between two ordinates, with the correction that increases from T = 0."""
    T, a = np.array(spectrum.points, dtype=np.float64).T
    k = int(np.clip(np.searchsorted(T, at.T, side="right") - 1, 0, len(T) - 2))
    numbers = {"k": spectrum.factor, "a": a[k], "b": a[k + 1], "T": at.T, "Ta": T[k], "Tb": T[k + 1]}
    at5 = float(np.interp(at.T, T, a)) * spectrum.factor
    formula = "k (S_[a] + (S_[b] − S_[a]) (T − T_[a])/(T_[b] − T_[a]))"
    put = "{k} · ({a} + ({b} − {a}) · ({T} − {Ta})/({Tb} − {Ta}))"
    plain = {name: float(value) for name, value in numbers.items()}
    yield Working(f"S_[5]({at.name})", say.say("S_5"), formula, say.put(put, **plain), at5, "g", DISPLACED)
    eta, share = correction(at.damping), min(at.T / spectrum.ramp, 1.0) if spectrum.ramp > 0 else 1.0
    by = 1 - (1 - eta) * share
    if share < 1:
        put = say.put("1 − (1 − {eta}) · {T}/{R}", eta=eta, T=at.T, R=spectrum.ramp)
        yield Working(f"η({at.name})", say.say("eta_T"), "1 − (1 − η) T/T_[max]", put, by, "", DISPLACED, "ours")
    put = say.put("{a} · {by} · {g}", a=at5, by=by, g=G)
    formula = f"S_[5]({at.name}) η g"
    value = spectrum.acceleration(at.T, at.damping)
    yield Working(f"S_[e]({at.name})", say.say("S_e"), formula, put, value, "m/s²", DISPLACED)


def displacement(say: Language, spectrum: Spectrum, at: At) -> Iterator[Working]:
    """S_De at a period, with all that leads there."""
    yield corrected(say, at)
    if isinstance(spectrum, GroundSpectrum):
        yield from _of_ground(say, spectrum, at, f"S_[De]({at.name})")
    elif isinstance(spectrum, TableSpectrum):
        yield from _largest(say, spectrum, at, f"S_[De]({at.name})")
    elif isinstance(spectrum, FloorSpectrum):
        yield from _of_floor(say, spectrum, at)


def _of_ground(say: Language, ground: GroundSpectrum, at: At, symbol: str) -> Iterator[Working]:
    start = LONG[ground.soil] if ground.soil is not None else None
    value = ground.displacement(at.T, at.damping)
    if start is None or start >= at.T:
        yield from acceleration(say, ground, at)
        yield _squared(say, symbol, at.name, at.T, ground.acceleration(at.T, at.damping), clauses.DISPLACEMENT)
        return
    level, numbers = say.formula("0.025 a_[g] S g T_[C] T_[D]"), "0.025 · {ag} · {S} · {g} · {TC} · {TD}"
    given = {"ag": ground.ag, "S": ground.S, "g": G, "TC": ground.TC, "TD": ground.TD, "T": at.T}
    given |= {"E": start, "F": GROUND, "F0": ground.F0, "eta": correction(at.damping)}
    if at.T > GROUND:
        yield Working(
            symbol, say.say("S_De_ground"), level, say.put(numbers, **given), value, "m", clauses.DISPLACEMENT_GROUND
        )
        return
    more = "({F0} · {eta} + (1 − {F0} · {eta}) · ({T} − {E})/({F} − {E}))"
    formula = f"{level} (F_[0] η + (1 − F_[0] η) (T − T_[E])/(T_[F] − T_[E]))"
    put = say.put(f"{numbers} · {more}", **given)
    yield Working(symbol, say.say("S_De_long"), formula, put, value, "m", clauses.DISPLACEMENT_LONG)


def _squared(say: Language, symbol: str, name: str, T: float, S_e: float, clause: str) -> Working:
    put = say.put("{S} · {T}^[2]/(4 · π^[2])", S=S_e, T=T)
    formula = f"S_[e]({name}) {name}^[2]/(4 π^[2])"
    return Working(symbol, say.say("S_De"), formula, put, S_e * (T / (2 * pi)) ** 2, "m", clause)


def _largest(say: Language, spectrum: TableSpectrum, at: At, symbol: str) -> Iterator[Working]:
    """The largest displacement up to a period, at a period of its own."""
    t = spectrum.governing(at.T, at.damping)
    formula = f"T_[0] ≤ t ≤ {at.name}: max S_[e](t) t^[2]"
    yield Working("t", say.say("t"), formula, "", t, "s", DISPLACED)
    where = At("t", t, at.damping)
    yield from acceleration(say, spectrum, where)
    yield _squared(say, symbol, "t", t, spectrum.acceleration(t, at.damping), DISPLACED)


def _of_floor(say: Language, floor: FloorSpectrum, at: At) -> Iterator[Working]:
    eta = correction(at.damping)
    A = floor.amplification(at.damping)
    put = say.put("1.1 · {eta}/√({xi})", eta=eta, xi=floor.xi1)
    yield Working("A", say.say("A"), say.formula("1.1 ξ_[1]^[−1/2] η(ξ)"), put, A, "", clauses.AMPLIFICATION, "ours")
    alone = floor.alone(at.T, at.damping)
    formula, put = _branch_of_floor(floor, at.T)
    numbers = {"A": A, "S": floor.peak, "T": at.T, "low": BELOW * floor.T1, "high": ABOVE * floor.T1}
    yield Working(
        f"S_[eZ]({at.name})",
        say.say("S_eZ"),
        say.formula(formula),
        say.put(put, **numbers),
        alone,
        "m/s²",
        clauses.FLOOR_SPECTRUM,
    )
    put = say.put("{S} · {T}^[2]/(4 · π^[2])", S=alone, T=at.T)
    own = alone * (at.T / (2 * pi)) ** 2
    bounds, names = [own], ["d_[Z]"]
    yield Working(
        "d_[Z]", say.say("d_Z"), f"S_[eZ]({at.name}) {at.name}^[2]/(4 π^[2])", put, own, "m", clauses.FLOOR_DISPLACEMENT
    )
    if at.T > floor.T1:
        bounds.append(floor.ground.displacement(at.T, at.damping))
        names.append("d_[g]")
        if isinstance(floor.ground, GroundSpectrum):
            yield from _of_ground(say, floor.ground, at, "d_[g]")
        else:
            yield from _largest(say, floor.ground, at, "d_[g]")
    if at.T > ABOVE * floor.T1:
        yield from _level(say, floor, A, bounds, names)
    shown = {f"d{k}": d for k, d in enumerate(bounds)}
    put = say.put(f"max({'; '.join('{' + name + '}' for name in shown)})", **shown)
    yield Working(
        f"S_[De]({at.name})", say.say("S_De_floor"), f"max({'; '.join(names)})", put,
        floor.displacement(at.T, at.damping), "m", clauses.FLOOR_DISPLACEMENT,
    )  # fmt: skip


def _level(say: Language, floor: FloorSpectrum, A: float, bounds: list[float], names: list[str]) -> Iterator[Working]:
    """The bound that displacements keep above the period of the floor; it is added to the others."""
    value = A * floor.peak * (ABOVE * floor.T1 / (2 * pi)) ** 2
    bounds.append(value)
    names.append("d_[b]")
    put = say.put("{A} · {S} · (1.1 · {T})^[2]/(4 · π^[2])", A=A, S=floor.peak, T=floor.T1)
    formula = "S_[eZ](T_[1]) (b T_[1])^[2]/(4 π^[2])"
    yield Working("d_[b]", say.say("d_b"), formula, put, value, "m", clauses.FLOOR_DISPLACEMENT)


def _branch_of_floor(floor: FloorSpectrum, T: float) -> tuple[str, str]:
    if BELOW * floor.T1 > T:
        return (
            "A S_[Z]/(1 + (A − 1) (1 − T/(a T_[1]))^[1.6])",
            "{A} · {S}/(1 + ({A} − 1) · (1 − {T}/{low})^[1.6])",
        )
    if ABOVE * floor.T1 >= T:
        return "A S_[Z]", "{A} · {S}"
    return (
        "A S_[Z]/(1 + (A − 1) (T/(b T_[1]) − 1)^[1.2])",
        "{A} · {S}/(1 + ({A} − 1) · ({T}/{high} − 1)^[1.2])",
    )


def at_own_period(say: Language, spectrum: Spectrum, T0: float, damping: float) -> Iterator[Working]:
    """S_e, or S_eZ, at the period of an element that vibrates freely."""
    at = At("T_[0]", T0, damping)
    yield corrected(say, at)
    if not isinstance(spectrum, FloorSpectrum):
        assert isinstance(spectrum, GroundSpectrum | TableSpectrum)
        yield from acceleration(say, spectrum, at)
        return
    A, eta = spectrum.amplification(damping), correction(damping)
    put = say.put("1.1 · {eta}/√({xi})", eta=eta, xi=spectrum.xi1)
    yield Working("A", say.say("A"), say.formula("1.1 ξ_[1]^[−1/2] η(ξ)"), put, A, "", clauses.AMPLIFICATION, "ours")
    alone = spectrum.alone(T0, damping)
    formula, put = _branch_of_floor(spectrum, T0)
    numbers = {"A": A, "S": spectrum.peak, "T": T0, "low": BELOW * spectrum.T1, "high": ABOVE * spectrum.T1}
    symbol = "S_[eZ](T_[0])"
    if spectrum.T1 >= T0:
        yield Working(
            symbol,
            say.say("S_eZ"),
            say.formula(formula),
            say.put(put, **numbers),
            alone,
            "m/s²",
            clauses.FLOOR_SPECTRUM,
        )
        return
    own = "S_[eZ,1](T_[0])"
    yield Working(
        own, say.say("S_eZ"), say.formula(formula), say.put(put, **numbers), alone, "m/s²", clauses.FLOOR_SPECTRUM
    )
    yield from acceleration(say, spectrum.ground, at)
    under = spectrum.ground.acceleration(T0, damping)
    put = say.put("max({own}; {under})", own=alone, under=under)
    yield Working(
        symbol, say.say("S_eZ_bound"), f"max({own}; S_[e](T_[0]))", put, max(alone, under), "m/s²", clauses.FLOOR_BOUND
    )
