"""Response of the linear rocking block to one full sine pulse: Eqs. 41-42 with their conditions, and exactly.

Everything is dimensionless [paper, Eq. 40]: rotations x = phi/phi_cr, times tau = p t counted from uplift, pulse
amplitude a = a_g/(g lambda) and frequency omega = omega_g/p. The pulse lifts the block where a sin = 1.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from math import asin, cosh, exp, inf, log, pi, sin, sinh, sqrt

from rocking_cli.errors import InputError, SolverError

EXCURSIONS = 20_000  # inside the pulse; to come to rest a restitution of 0.99 needs 2000
FAINT = 1e-10  # rate of an impact below which the block rests: it would rock to 5e-21
LARGEST = 1e6  # a or omega, and 1/omega
LONG = 690.0  # exp of more, with a factor of omega^2, overflows


@dataclass(frozen=True)
class ClosedForm:
    """Eqs. 41-42 as printed, and whether they may be used.

    Parameters
    ----------
    D0 : float or None
        Energy of the free motion after the pulse [Eq. 42]; None where it does not exist or overflows.
    max_ratio : float or None
        phi_max/phi_cr of Eq. 41, the peak of the first rebound; None if it overturns or D0 does not exist.
    overturns : bool
        Whether eta^2 (1 - D0) >= 1: overturning after one impact.
    conditions : dict of str to bool or None
        `uplift` (a > 1), `first_impact_after_pulse`, `no_overturning_without_impact`; None where there is no motion.
    """

    D0: float | None
    max_ratio: float | None
    overturns: bool
    conditions: dict[str, bool | None]

    @property
    def valid(self) -> bool:
        """Whether every condition of the closed form holds."""
        return all(self.conditions.values())


@dataclass(frozen=True)
class ExactPulse:
    """The exact answer of the linear equation.

    Parameters
    ----------
    max_ratio : float or None
        Largest phi/phi_cr of the whole motion; None if it overturns.
    first_excursion, first_rebound : float or None
        Peaks before and after the first impact; None for one that overturns or never comes.
    overturns : bool
        Whether the block overturns.
    impacts_before_overturning : int or None
        Number of impacts before; None if it does not overturn.
    first_impact : float or None
        tau of the first impact, from uplift; None if there is none.
    impact_during_pulse : bool
        Whether the first impact comes before the end of the pulse.
    uplift : float or None
        tau from the start of the pulse to uplift; None if the block does not lift.
    pulse_end : float or None
        tau from uplift to the end of the pulse.
    """

    max_ratio: float | None
    first_excursion: float | None
    first_rebound: float | None
    overturns: bool
    impacts_before_overturning: int | None
    first_impact: float | None
    impact_during_pulse: bool
    uplift: float | None
    pulse_end: float | None


def check_pulse(a: float, omega: float, eta: float) -> None:
    """Refuse what is no pulse: `InputError` names the parameter."""
    if not 0 < a <= LARGEST:
        raise InputError(f"a must be a positive number up to {LARGEST:g} (a_g over the uplift acceleration), got {a:g}")
    if not 1 / LARGEST <= omega <= LARGEST:
        raise InputError(f"omega must be a number from {1 / LARGEST:g} to {LARGEST:g} (omega_g/p), got {omega:g}")
    if not 0 < eta <= 1:
        raise InputError(f"eta must be in (0, 1], got {eta:g}")


def closed_form(a: float, omega: float, eta: float) -> ClosedForm:
    """Maximum response to a full sine pulse by Eqs. 41-42, with the conditions under which they hold.

    Parameters
    ----------
    a, omega, eta : float
        Dimensionless amplitude and frequency, and coefficient of restitution.

    Returns
    -------
    ClosedForm

    Raises
    ------
    InputError
        If a or omega is not positive or eta is outside (0, 1].

    Notes
    -----
    The paper states none of the conditions: (i) the block lifts, (ii) its first impact comes after the pulse,
    (iii) it does not overturn before.
    """
    check_pulse(a, omega, eta)
    if a <= 1:
        return ClosedForm(None, None, False, _conditions(False, None, None))
    root = sqrt(a * a - 1)
    end = (2 * pi - asin(1 / a)) / omega  # tau from uplift to the end of the pulse
    if end + log(a) > LONG:
        # The growing term decides all: D0 is beyond numbers, with the sign of root - omega.
        return ClosedForm(None, None, root < omega, _conditions(True, root >= omega, root <= omega))
    grow, decay = exp(end), exp(-end)
    D0 = (omega / (omega**2 + 1)) ** 2 * (
        omega**2 - 2 * a**2 + 1 + (root + omega) * a * decay + (root - omega) * a * grow
    )  # Eq. 42
    lifted = (root - omega) * grow - (root + omega) * decay + 2 * (1 + omega**2) / omega >= 0
    left = eta**2 * (1 - D0)
    overturns = left >= 1
    return ClosedForm(
        D0=D0,
        max_ratio=None if overturns else 1 - sqrt(1 - left),  # Eq. 41
        overturns=overturns,
        conditions=_conditions(True, lifted, (root - omega) * grow < a),
    )


def _conditions(uplift: bool, impact_after: bool | None, stays: bool | None) -> dict[str, bool | None]:
    return {"uplift": uplift, "first_impact_after_pulse": impact_after, "no_overturning_without_impact": stays}


@dataclass(frozen=True)
class _Flight:
    """Motion on one side from tau = start: x'' = x - 1 + side a sin(omega tau + phase)."""

    side: int
    start: float
    x: float
    v: float
    amplitude: float
    omega: float
    phase: float

    def at(self, tau: float) -> tuple[float, float, float]:
        """x, x' and x'' in closed form."""
        k = self.side * self.amplitude / (1 + self.omega**2)
        angle, angle0 = self.omega * tau + self.phase, self.omega * self.start + self.phase
        A = self.x - 1 + k * sin(angle0)
        B = self.v + k * self.omega * sin(angle0 + pi / 2)
        s = tau - self.start
        c, sh = cosh(s), sinh(s)
        x = 1 - k * sin(angle) + A * c + B * sh
        return (
            x,
            -k * self.omega * sin(angle + pi / 2) + A * sh + B * c,
            x - 1 + self.side * self.amplitude * sin(angle),
        )


def exact_pulse(a: float, omega: float, eta: float) -> ExactPulse:
    """Exact response of the linear block to a full sine pulse, any number of impacts.

    Parameters
    ----------
    a, omega, eta : float
        Dimensionless amplitude and frequency, and coefficient of restitution.

    Returns
    -------
    ExactPulse

    Raises
    ------
    InputError
        If a or omega is not positive or eta is outside (0, 1].

    SolverError
        If the block bounces all through a slow pulse, with a restitution near 1.

    Notes
    -----
    Closed form between impacts; each impact by a root search that looks at every turning point of the motion.
    """
    check_pulse(a, omega, eta)
    if a <= 1:
        return ExactPulse(0.0, None, None, False, None, None, False, None, None)
    phase = asin(1 / a)
    end = (2 * pi - phase) / omega
    peaks: list[float] = []
    first_impact: float | None = None
    side, tau, x, v = 1, 0.0, 0.0, 0.0
    resting = False
    for _ in range(EXCURSIONS):
        if resting:  # chattered to rest inside the pulse: it lifts again where |a sin| passes 1, if it does
            lift = _next_lift(tau, omega, phase, end)
            if lift is None:
                break
            tau, side = lift
            v, resting = 0.0, False
        tau, x, v, peak = _to_impact(_Flight(side, tau, 0.0, v, a, omega, phase), end)
        if x > 0:  # in the air after the pulse (or certain to overturn): free motion
            if x - 1 + v >= 0:
                return _result(peaks, first_impact, end, phase / omega, overturned=True)
            energy = v**2 - (1 - x) ** 2  # twice that of the free motion, which is x = 1 - P e^s - Q e^-s
            peak = max(peak, 1 - sqrt(-energy)) if v > 0 else peak
            tau += log((1 + sqrt(1 + energy)) / (1 - x - v))
            v = -sqrt(1 + energy)
        peaks.append(peak)
        first_impact = tau if first_impact is None else first_impact
        v, side = -eta * v, -side  # Eq. 6
        if tau >= end:  # from here every excursion is free and lower than the one before
            if v >= 1:
                return _result(peaks, first_impact, end, phase / omega, overturned=True)
            peaks.append(1 - sqrt(1 - v * v))
            break
        resting = v <= FAINT
    else:
        raise SolverError(
            f"more than {EXCURSIONS} impacts within the pulse: so slow a pulse needs a restitution below 1"
        )
    return _result(peaks, first_impact, end, phase / omega, overturned=False)


def _result(
    peaks: list[float], first_impact: float | None, end: float, uplift: float, *, overturned: bool
) -> ExactPulse:
    return ExactPulse(
        max_ratio=None if overturned else max(peaks),
        first_excursion=peaks[0] if peaks else None,
        first_rebound=peaks[1] if len(peaks) > 1 else None,
        overturns=overturned,
        impacts_before_overturning=len(peaks) if overturned else None,
        first_impact=first_impact,
        impact_during_pulse=first_impact is not None and first_impact < end,
        uplift=uplift,
        pulse_end=end,
    )


def _to_impact(flight: _Flight, end: float) -> tuple[float, float, float, float]:
    """Fly to the first impact or the end of the pulse: tau, x (0 at an impact), v, and the peak on the way.

    No turning point can be missed. With g = x'' - x', the growth of g e^tau is side a omega cos e^tau, whose zeros are
    known, and the growth of x' e^-tau is g e^-tau: g vanishes at most once between zeros of the cosine, and x' at
    most once between zeros of g.
    """
    bends = [(angle - flight.phase) / flight.omega for angle in (pi / 2, 3 * pi / 2)]
    _, v_lo, force = flight.at(flight.start)
    g_lo = force - v_lo
    if flight.v == 0:  # a lift: both grow from zero, whatever rounding says
        v_lo = g_lo = 1.0
    lo, peak = flight.start, 0.0
    while lo < end:
        hi = min([lo + 1.0, end, *(bend for bend in bends if bend > lo)])
        x_hi, v_hi, force = flight.at(hi)
        g_hi = force - v_hi
        cuts = [lo, hi]
        if g_lo * g_hi < 0:
            cuts.insert(1, _root(lambda tau: flight.at(tau)[2] - flight.at(tau)[1], lo, hi))
        for a, b in pairwise(cuts):
            v_b = flight.at(b)[1]
            turn = _root(lambda tau: flight.at(tau)[1], a, b) if v_lo * v_b < 0 else b
            for start, stop, v in ((a, turn, v_lo), (turn, b, v_b)):
                x = flight.at(stop)[0]
                peak = max(peak, x)
                if v < 0 and x <= 0:
                    hit = _root(lambda tau: flight.at(tau)[0], start, stop)
                    return hit, 0.0, min(flight.at(hit)[1], 0.0), peak
            v_lo = v_b
        if v_hi >= 0 and x_hi >= 1 + flight.amplitude:
            return hi, x_hi, v_hi, inf  # no later part of the pulse can bring it back
        lo, g_lo = hi, g_hi
    x, v, _ = flight.at(end)
    return end, x, v, peak


def _next_lift(tau: float, omega: float, phase: float, end: float) -> tuple[float, int] | None:
    """When |a sin| next passes 1 for a block at rest at tau, and to which side; None if not in the pulse."""
    for angle, side in ((phase, 1), (pi + phase, -1)):
        until = pi - phase if side > 0 else 2 * pi - phase
        lift = max((angle - phase) / omega, tau)
        if lift * omega + phase < until and lift < end:
            return lift, side
    return None


def _root(f: Callable[[float], float], low: float, high: float) -> float:
    """Bisection to the last bit between points where f differs in sign."""
    positive = f(high) > 0
    while True:
        middle = (low + high) / 2
        if not low < middle < high:
            return middle
        if (f(middle) > 0) == positive:
            high = middle
        else:
            low = middle
