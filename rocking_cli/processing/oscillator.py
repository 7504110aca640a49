"""Response of the linear oscillator to a ground motion, exact for linear interpolation between samples.

With x'' + 2 xi w x' + w^2 x = -u_g'' and the complex mu = -xi w + i w_d, w_d = w sqrt(1 - xi^2), the solution from rest
is x = -Im(z)/w_d and x' = -Im(mu z)/w_d with z' = mu z + u_g'', z(0) = 0. Over an interval on which u_g'' is linear

    z(t + dt) = e^m z(t) + dt [(phi_1 - phi_2) u_g''(t) + phi_2 u_g''(t + dt)],    m = mu dt

    phi_1 = (e^m - 1)/m,    phi_2 = (e^m - 1 - m)/m^2
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import ceil, inf, isclose, isfinite, pi, sqrt
from typing import Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rocking_cli.arrays import Reals
from rocking_cli.errors import InputError, Problem, named
from rocking_cli.excitation.base import STANDARD_GRAVITY, GroundMotion
from rocking_cli.short_repr import short_repr
from rocking_cli.text import did_you_mean, exact
from rocking_cli.units import UnitError, number_of

SAMPLES_PER_PERIOD = 24  # samples; cubics between them have an error below 1e-5 of the peak
MAX_PARTS = 64  # parts of a sampling interval; an oscillator this much faster than the record follows it
MAX_SAMPLES = 50_000_000  # a refined motion of this length takes some gigabytes
SAMPLES_PER_BLOCK = 64
MAX_SERIES_ARGUMENT = 0.5  # up to this |m|, series give phi_1 and phi_2 without cancellation
SERIES_TERMS = 18
DAMPING = 0.05
SHORTEST_PERIOD, LONGEST_PERIOD, PERIOD_COUNT = 0.02, 10.0, 200  # s, s, and number: default of a spectrum


@short_repr
@dataclass(frozen=True, eq=False)
class ResponseSpectrum:
    """Largest responses of linear oscillators to a ground motion.

    Parameters
    ----------
    periods : ndarray, shape (n,)
        Periods of the oscillators [s], positive.
    damping : float
        Damping ratio of the oscillators.
    sd : ndarray, shape (n,)
        Largest displacement relative to the ground [m].
    """

    periods: Reals
    damping: float
    sd: Reals

    @property
    def sv(self) -> Reals:
        """Pseudo-velocity, 2 pi/T times the displacement [m/s]."""
        return 2 * pi / self.periods * self.sd

    @property
    def sa(self) -> Reals:
        """Pseudo-acceleration, (2 pi/T)^2 times the displacement [standard gravity]."""
        return (2 * pi / self.periods) ** 2 * self.sd / STANDARD_GRAVITY


def relative_response(motion: GroundMotion, period: float, damping: float) -> tuple[Reals, Reals, int]:
    """Return displacement and velocity of an oscillator relative to the ground, starting at rest.

    Parameters
    ----------
    motion : GroundMotion
        Ground motion, linear between its samples.
    period : float
        Undamped period of the oscillator [s].
    damping : float
        Damping ratio, from 0 to below 1.

    Returns
    -------
    displacement, velocity : ndarray, shape (n (npts - 1) + 1,)
        Displacement [m] and velocity [m/s], with n equal parts of every sampling interval.
    parts : int
        n, more than 1 if the period is so short that the response must be sampled more finely than the motion.
    """
    check_oscillator(period, damping)
    parts = max(ceil(min(SAMPLES_PER_PERIOD * motion.dt / period, MAX_PARTS) - 1e-9), 1)
    if parts > 1 and parts * motion.npts > MAX_SAMPLES:
        message = (
            f"a period of {period:g} s needs {parts * motion.npts:.3g} samples of it; "
            f"at most {MAX_SAMPLES:.3g} are allowed"
        )
        raise InputError(Problem(message, motion.name, hint="a longer period or a shorter record takes fewer"))
    ground = finer(motion.acceleration, parts)
    dt = motion.dt / parts
    w = 2 * pi / period
    w_d = w * sqrt(1 - damping * damping)
    mu = complex(-damping * w, w_d)
    m = mu * dt
    phi_1, phi_2 = _phi(m)
    z = np.zeros(ground.size, dtype=np.complex128)
    forcing = np.asarray(dt * ((phi_1 - phi_2) * ground[:-1] + phi_2 * ground[1:]), dtype=np.complex128)
    z[1:] = _advance(complex(np.exp(m)), forcing)
    return -z.imag / w_d, -(mu * z).imag / w_d, parts


def response_spectrum(
    motion: GroundMotion, periods: ArrayLike | None = None, damping: float = DAMPING
) -> ResponseSpectrum:
    """Return the response spectrum of a ground motion, from the responses during the motion and after it.

    Parameters
    ----------
    motion : GroundMotion
        Ground motion, linear between its samples.
    periods : array_like, shape (n,), optional
        Undamped periods [s], positive; by default, 200 from 0.02 to 10 s at equal ratios.
    damping : float
        Damping ratio, from 0 to below 1.

    Returns
    -------
    ResponseSpectrum

    Raises
    ------
    InputError
        If a period is not positive, or the damping ratio is out of range.
    """
    if periods is None:
        periods = periods_between(SHORTEST_PERIOD, LONGEST_PERIOD)
    period_array = np.atleast_1d(np.asarray(periods, dtype=np.float64))
    return ResponseSpectrum(
        period_array, damping, np.array([peak_displacement(motion, float(period), damping) for period in period_array])
    )


def periods_between(low: float, high: float) -> Reals:
    """Return the periods of a spectrum from `low` to `high` [s], at equal ratios."""
    return np.geomspace(low, high, PERIOD_COUNT)


def check_oscillator(period: float, damping: float) -> None:
    """Raise `InputError` if a period or a damping ratio is not that of an oscillator."""
    if not 0 < period < inf:
        raise InputError(Problem(f"the period of an oscillator is a positive number of seconds, got {period:g}"))
    if not 0 <= damping < 1:
        raise InputError(Problem(f"a damping ratio is from 0 to below 1, got {damping:g}", hint="5 % is 0.05"))


def finer(values: Reals, parts: int) -> Reals:
    """Return linearly interpolated values, with each interval divided into `parts` parts."""
    if parts == 1:
        return values
    places = np.arange((values.size - 1) * parts + 1)
    return np.interp(places / parts, np.arange(values.size), values)


def _phi(m: complex) -> tuple[complex, complex]:
    """Return the functions phi_1 and phi_2 of m, see the module."""
    if abs(m) > MAX_SERIES_ARGUMENT:
        grown = np.exp(m)
        return complex((grown - 1) / m), complex((grown - 1 - m) / (m * m))
    term, phi_1, phi_2 = 1.0 + 0.0j, 0.0j, 0.0j
    for k in range(1, SERIES_TERMS):
        phi_1 += term / k  # m^(k-1)/k!
        phi_2 += term / (k * (k + 1))
        term *= m / k
    return phi_1, phi_2


def _advance(growth: complex, forcing: NDArray[np.complex128]) -> NDArray[np.complex128]:
    """Return z with z[k + 1] = growth z[k] + forcing[k] and z[0] = 0, computed in blocks.

    As |growth| is at most 1, no power of it is large.
    """
    blocks = -(-forcing.size // SAMPLES_PER_BLOCK)
    padded = np.zeros(blocks * SAMPLES_PER_BLOCK, dtype=np.complex128)
    padded[: forcing.size] = forcing
    powers = growth ** np.arange(SAMPLES_PER_BLOCK + 1)
    # All blocks advance together, without matrix products, whose threads are slow on a busy machine.
    rows = np.ascontiguousarray(padded.reshape(blocks, SAMPLES_PER_BLOCK).T)
    for k in range(1, SAMPLES_PER_BLOCK):
        rows[k] += growth * rows[k - 1]
    within = rows.T
    before = np.zeros(blocks, dtype=np.complex128)
    for k in range(1, blocks):
        before[k] = powers[SAMPLES_PER_BLOCK] * before[k - 1] + within[k - 1, -1]
    return np.asarray((within + before[:, None] * powers[1:]).ravel()[: forcing.size])


def peak_displacement(motion: GroundMotion, period: float, damping: float) -> float:
    """Return the peak displacement [m], with cubic interpolation between samples from values and slopes."""
    x, v, parts = relative_response(motion, period, damping)
    h = motion.dt / parts
    is_resolved = SAMPLES_PER_PERIOD * h <= period * (1 + 1e-9)  # cubics do not resolve faster motions
    k = np.flatnonzero(np.sign(v[:-1]) * np.sign(v[1:]) < 0) if is_resolved else np.zeros(0, dtype=np.intp)
    between = _turning_point(x[k], x[k + 1], h * v[k], h * v[k + 1])
    after = _free_peak(float(x[-1]), float(v[-1]), period, damping)
    peak = max(float(np.abs(x).max()), float(np.abs(between).max(initial=0.0)), after)
    if not isfinite(peak):
        raise InputError(f"{motion.name}: accelerations of {motion.pga_g:.3g} g are beyond the range of numbers")
    return peak


def _turning_point(x0: Reals, x1: Reals, v0: Reals, v1: Reals) -> Reals:
    """Return the extreme value in [0, 1] of Hermite cubics whose slopes at the ends have opposite signs."""
    # The slope is v0 + 2 b s + 3 c s^2.
    b, c = 3 * (x1 - x0) - 2 * v0 - v1, 2 * (x0 - x1) + v0 + v1
    root = np.sqrt(np.maximum(b * b - 3 * c * v0, 0.0))
    # The root between the ends, in a form without cancellation.
    s = np.clip(-v0 / (b - np.sign(v0) * root), 0.0, 1.0)
    return np.asarray(x0 + s * (v0 + s * (b + s * c)))


def _free_peak(x: float, v: float, period: float, damping: float) -> float:
    """Return the first, and so largest, peak displacement [m] of the free vibration after the motion."""
    w = 2 * pi / period
    w_d = w * sqrt(1 - damping * damping)
    mu = complex(-damping * w, w_d)
    # x(t) = Re(c e^(mu t)) with c = x - i (v + xi w x)/w_d; its rate vanishes where mu c e^(i w_d t) is imaginary.
    c = complex(x, -(v + damping * w * x) / w_d)
    if c == 0:
        return 0.0
    rate = mu * c
    turn = (pi / 2 - float(np.angle(rate))) % pi
    t = turn / w_d
    return float(abs((c * np.exp(mu * t)).real))


FLOOR_EXAMPLE = "T1=0.4,xi=0.05,z=6m,H=9m,n=3"
FLOOR_UNITS = {"T1": "s", "xi": "%", "z": "m", "H": "m", "z/H": "", "gamma": "", "n": ""}
"""Items of a floor, with the unit of a plain number; those of z, H and n are the items of a site's floor."""
PERIOD_RANGE = 1e-6, 1e6  # s; no building has periods beyond, and numbers overflow
MAX_GAMMA = 100.0  # a uniform building has 1.5; a larger value is a typing error
MAX_STOREYS = 1000


@dataclass(frozen=True)
class Floor:
    """A floor of a building that responds in its first mode.

    Parameters
    ----------
    period : float
        T1, period of the mode [s].
    damping : float
        xi, damping ratio of the mode.
    height : float
        Ratio of the floor's height z to that of the building H, from 0 to 1; the mode shape is psi = z/H.
    participation : float
        gamma, participation factor of the mode; 3n/(2n + 1) for n equal storeys.
    """

    period: float
    damping: float
    height: float
    participation: float

    def __post_init__(self) -> None:
        check_oscillator(self.period, self.damping)
        if not 0 <= self.height <= 1:
            hint = "it is the height of the floor over that of the building"
            raise _refused(f"z/H must be from 0 to 1, got {self.height:g}", hint)
        if not PERIOD_RANGE[0] <= self.period <= PERIOD_RANGE[1]:
            raise _refused(f"T1 must be from {PERIOD_RANGE[0]:g} to {PERIOD_RANGE[1]:g} s, got {self.period:g} s")
        if not 0 < self.participation <= MAX_GAMMA:
            raise _refused(f"gamma must be a positive number, {MAX_GAMMA:g} at most, got {self.participation:g}")

    def __str__(self) -> str:
        items = {"T1": self.period, "xi": self.damping, "z/H": self.height}
        n = round(self.participation / (3 - 2 * self.participation)) if self.participation < 1.5 else 0
        if 1 <= n <= MAX_STOREYS and isclose(_of_storeys(n), self.participation, rel_tol=1e-12):
            items["n"] = float(n)  # n is exact, while gamma such as 9/7 has endless digits
        else:
            items["gamma"] = self.participation
        return ",".join(f"{key}={exact(value)}" for key, value in items.items())

    @classmethod
    def parse(cls, spec: str | Mapping[str, object]) -> Self:
        """Read a floor from `T1=0.4,xi=0.05,z=6m,H=9m,n=3`, or from a mapping.

        Instead of z and H [m] their ratio `z/H` may be given, and instead of n equal storeys `gamma`.

        Raises
        ------
        InputError
            If an item is missing, unknown, not a number or out of range.
        """
        pairs = dict(spec) if isinstance(spec, Mapping) else _pairs(str(spec))
        for key in pairs:
            if key not in FLOOR_UNITS:
                raise _refused(
                    f"{key!r} is not one of {', '.join(FLOOR_UNITS)}", did_you_mean(str(key), list(FLOOR_UNITS))
                )
        _check_height(pairs)
        missing = [key for key, there in (("T1", "T1" in pairs), ("z with H", {"z", "z/H"} & set(pairs))) if not there]
        if ("gamma" in pairs) == ("n" in pairs):
            missing.append("gamma, or n for as many equal storeys (one of the two)")
        if missing:
            raise _refused(f"{' and '.join(missing)} must be given")
        values = {key: _value(key, value) for key, value in pairs.items()}
        if "n" in values:
            n = values["n"]
            if not (1 <= n <= MAX_STOREYS and n == round(n)):
                raise _refused(f"n is the number of storeys, got {n:g}")
            values["gamma"] = _of_storeys(n)
        if "H" in values:
            if not 0 <= values["z"] <= values["H"] or values["H"] == 0:
                raise _refused(f"z must be from 0 to H, got {values['z']:g} m of {values['H']:g} m")
            values["z/H"] = values["z"] / values["H"]
        return cls(values["T1"], values.get("xi", DAMPING), values["z/H"], values["gamma"])

    def of(self, ground: GroundMotion) -> GroundMotion:
        """Return the motion of the floor for a ground motion.

        Returns
        -------
        GroundMotion
            Motion of the floor, sampled finely enough for the mode. Its `ground` is the given motion, and its vertical
            component is that of the ground, as floors are assumed to be vertically rigid.
        """
        x, v, parts = relative_response(ground, self.period, self.damping)
        w = 2 * pi / self.period
        below = finer(ground.acceleration, parts)
        relative = -below - 2 * self.damping * w * v - w * w * x
        return replace(
            ground,
            dt=ground.dt / parts,
            acceleration=below + self.height * self.participation * relative,
            points=None,
            every=ground.every * parts,
            processing=(*ground.processing, f"floor {self}"),
            ground=ground,
        )


def _of_storeys(n: float) -> float:
    """Return the participation factor of n equal storeys."""
    return 3 * n / (2 * n + 1)


def _check_height(pairs: Mapping[str, object]) -> None:
    """Refuse a floor height without that of the building (it may be meant as their ratio), and heights with a ratio."""
    hint = "give heights in metres, such as z=6m,H=9m, or their ratio, such as z/H=0.67"
    if "z" in pairs and not {"H", "z/H"} & set(pairs):
        z = pairs["z"]
        raise _refused(f"z={z} has two meanings: the height of the floor needs that of the building, H", hint)
    if "z/H" in pairs and {"z", "H"} & set(pairs):
        raise _refused("z/H cannot be combined with z or H", hint)


def _pairs(text: str) -> dict[str, object]:
    pairs: dict[str, object] = {}
    for part in text.split(","):
        key, equals, value = (each.strip() for each in part.partition("="))
        if not equals or not value:
            raise _refused(f"{part.strip()!r} is not of the form T1=0.4")
        if key in pairs:
            raise _refused(f"{key} is given twice")
        pairs[key] = value
    return pairs


def _value(key: str, value: object) -> float:
    try:
        return number_of(value, FLOOR_UNITS[key])
    except UnitError as error:
        raise _refused(f"{key}: {error.message}", error.hint) from None


def _refused(message: str, hint: str | None = None) -> InputError:
    return InputError(Problem(message, field=named("floor"), hint=hint or f"such as {FLOOR_EXAMPLE}"))
