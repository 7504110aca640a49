"""The checks of an installation: results against formulas, literal values of other programs, and a general solver.

Only `threads` and `kernels` compare two results of the same code; all others share no code with what they check.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import partial
from importlib.util import find_spec
from itertools import pairwise
from math import asin, atan, cos, erf, exp, hypot, inf, isclose, log, nan, pi, sin, sqrt, tan
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rocking_cli.arrays import Bools, Reals
from rocking_cli.ask.read import read_record
from rocking_cli.core.registry import Registry
from rocking_cli.dynamics import batch, exact_batch, ways
from rocking_cli.dynamics.batch import Runs, respond_many
from rocking_cli.dynamics.exact_batch import exact_many
from rocking_cli.dynamics.history import follow
from rocking_cli.dynamics.model import ModelName
from rocking_cli.dynamics.outcome import OUTCOME_FIELDS, Outcomes
from rocking_cli.errors import BrokenKernels, RockingError
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.excitation.pulses.shapes import Sine
from rocking_cli.processing.steps import parse_step, process
from rocking_cli.questions.selfcheck.study import NotRun
from rocking_cli.structure import Structure
from rocking_cli.studies import neighbours as near
from rocking_cli.studies.neighbours import Conditions
from rocking_cli.units import KINDS, read

GRAVITY = 9.80665  # m/s2, repeated here as are all expected values
MOTIONS = tuple(
    GroundMotion(f"motion {k}", dt, np.array(samples, dtype=np.float64), unit="m/s2")
    for k, (dt, samples) in enumerate(
        (
            (0.1, (0, 2, 4, 3, -1, -4, -3, 0)),
            (0.2, (0, 3, 5, 0, -5, -4, 0, 2, 0)),  # overturns
            (0.15, (0, -4, 0, 4, -1, -4, 3, 0)),
            (0.07, (0, 4, -4, 1, 5, 2, -4, -5, -1, 3, 2, 0)),
        )
    )
)
"""Ground motions of a few samples [m/s2], straight in between, so that the solver meets few corners."""


def made(mechanism: str, **fields: Any) -> Structure:
    """Return a structure of an installed mechanism."""
    return Structure(Registry()[mechanism].from_fields(fields))


def largest_difference(found: ArrayLike, expected: ArrayLike) -> float:
    """Return the largest difference between two rows of numbers; infinity if any is missing or not a number."""
    one, other = np.asarray(found, dtype=np.float64), np.asarray(expected, dtype=np.float64)
    if one.shape != other.shape or not np.isfinite([one, other]).all():
        return inf
    return float(np.abs(one - other).max(initial=0.0))


def different_values(one: NDArray[Any], other: NDArray[Any]) -> int:
    """Return how many values of two arrays of one shape and type differ in any bit; NaN has one value."""
    first, second = (np.ascontiguousarray(each).view(np.uint8).reshape(each.size, -1) for each in (one, other))
    neither = np.isnan(one).ravel() & np.isnan(other).ravel()
    return int(((first != second).any(axis=1) & ~neither).sum())


# --- released structures ---------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Rocker:
    """A structure whose free motion is phi'^2 = 4 p^2 sin(alpha - (phi + phi0)/2) sin((phi0 - phi)/2)/m from phi0.

    With m = 1 + 3 n sin^2(alpha - phi): n is 0 for a free-standing block [Housner, 1963], and 1 for the wall of two
    blocks, whose kinetic energy varies with its rotation.

    Parameters
    ----------
    structure : Structure
        The structure.
    alpha, p, eta : float
        Critical rotation [rad], frequency parameter [rad/s] and coefficient of restitution.
    n : int
        0 or 1.
    """

    structure: Structure
    alpha: float
    p: float
    eta: float
    n: int = 0

    def impact_times(self, tilt: float) -> list[float]:
        """Return the times of the first impacts after a release from a fraction of the critical rotation [s]."""
        times: list[float] = []
        phi = self.alpha * tilt
        time = -self.fall(phi)  # the release is in the middle of an excursion
        for _ in range(RELEASE_IMPACTS):
            time += 2 * self.fall(phi)
            times.append(time)
            # Share of the energy that is left.
            energy = cos(self.alpha) + self.eta**2 * (cos(self.alpha - phi) - cos(self.alpha))
            phi = self.alpha - atan(sqrt(1 - energy**2) / energy)
        return times

    def fall(self, top: float, to: float = 0.0) -> float:
        """Return the time from rest at a rotation to a smaller one [s], by phi = top (1 - x^2) without singularity."""
        from scipy.integrate import quad

        def slope(x: float) -> float:
            phi, m = top * (1 - x * x), 1 + 3 * self.n * sin(self.alpha - top * (1 - x * x)) ** 2
            return top * x * sqrt(m / (sin(self.alpha - (phi + top) / 2) * sin((top - phi) / 2))) if x else 0.0

        return float(quad(slope, 0.0, sqrt(1 - to / top), epsabs=0.0, epsrel=1e-13)[0]) / self.p


def block(width: float, height: float) -> Rocker:
    """Return a free-standing block: p^2 = 3 g/(4 R) with half the diagonal R, eta by the angular momentum."""
    alpha = atan(width / height)
    p = sqrt(1.5 * GRAVITY / hypot(width, height))
    return Rocker(made("block", width=width, height=height), alpha, p, 1 - 1.5 * sin(alpha) ** 2)


def wall(thickness: float, height: float) -> Rocker:
    """Return a wall of two blocks with an eta of its own: p^2 = 3 g/(2 R) with half the diagonal R of one."""
    alpha, p = atan(2 * thickness / height), sqrt(3 * GRAVITY / hypot(thickness, height / 2))
    return Rocker(made("wall", thickness=thickness, height=height, restitution=0.9), alpha, p, 0.9, 1)


RELEASE_IMPACTS = 8
TILTS = (0.5, 0.05, -0.9, 0.99)
"""Releases, as fractions of the critical rotation."""


def release(quick: bool) -> float:
    """Return the largest difference between times of impacts [s]."""
    rockers = (block(0.7, 2.8), wall(0.3, 3.0), block(0.05, 0.3), block(2.0, 5.0), block(1.0, 8.0), wall(0.2, 6.0))
    return max(
        largest_difference(
            follow(each.structure.model("nonlinear"), None, release=tilt).impacts[:RELEASE_IMPACTS, 0],
            each.impact_times(abs(tilt)),
        )
        for each in (rockers[:2] if quick else rockers)
        for tilt in (TILTS[:1] if quick else TILTS)
    )


# --- pulses ----------------------------------------------------------------------------------------------------------

ETAS = (0.9, 0.7, 0.8)
OMEGAS = (5.0, 2.5, 8.0, 1.5, 1.9, 3.2, 4.0, 6.3, 10.0, 20.0)
"""Frequencies omega_g/p of the pulses; up to some 6 blocks also overturn after an impact, in ranges of amplitudes."""
AMPLITUDES = np.geomspace(1.01, 100.0, 250)
"""Amplitudes a_g/(g lambda), two of which enclose each threshold."""
HALVINGS = 50  # halvings of an interval, to below the last bit


def pulses(quick: bool) -> float:
    """Return the largest relative difference between amplitudes at which overturning begins or ends."""
    return max(_pulses(eta, OMEGAS[:2] if quick else OMEGAS) for eta in (ETAS[:1] if quick else ETAS))


def _pulses(eta: float, omegas: tuple[float, ...]) -> float:
    brackets = np.array([bracket for omega in omegas for bracket in _brackets(omega, eta)])
    omega, low, high, begins = brackets.T
    of = block(0.7, 2.8)
    equivalence = of.structure.under(restitution=eta).equivalence
    unit, periods = GRAVITY * tan(of.alpha), 2 * pi / (of.p * omega)

    def computed(a: Reals) -> Bools:
        return exact_many(equivalence, Sine(1.0, 1.0), a * unit, periods, kappa=2, gravity=GRAVITY, threads=1).fell

    def in_closed_form(a: Reals) -> Bools:
        return np.array([overturns(*each, eta) is True for each in zip(a.tolist(), omega.tolist(), strict=True)])

    expected = _threshold(in_closed_form, low, high, begins)
    return largest_difference(_threshold(computed, low, high, begins) / expected, np.ones_like(expected))


def overturns(a: float, omega: float, eta: float) -> bool | None:
    """Return whether a sine pulse overturns a linear block, after one impact or none; None if it hits during the pulse.

    From the motion x'' = x + a sin(omega t + asin(1/a)) from x = -1 at rest, and the free motion after the pulse.
    """
    s, after = sqrt(a * a - 1), (2 * pi - asin(1 / a)) / omega
    grows, decays = (s - omega) * exp(after), (s + omega) * exp(-after)
    if grows >= a:
        return True
    if grows - decays + 2 * (1 + omega**2) / omega < 0:
        return None
    energy = (omega / (1 + omega**2)) ** 2 * (grows - a) * (a - decays)  # x^2 - x'^2 after the pulse
    return eta**2 * (1 - energy) >= 1


def _brackets(omega: float, eta: float) -> list[tuple[float, float, float, bool]]:
    """Return each threshold: omega, two amplitudes that enclose it, and whether overturning begins there."""
    fates = [overturns(a, omega, eta) for a in AMPLITUDES.tolist()]
    return [
        (omega, AMPLITUDES[k], AMPLITUDES[k + 1], bool(after))
        for k, (before, after) in enumerate(pairwise(fates))
        if None not in (before, after) and before != after
    ]


def _threshold(overturns: Callable[[Reals], Bools], low: Reals, high: Reals, begins: Reals) -> Reals:
    """Bisect amplitudes between a low and a high one, of which the high one overturns where overturning begins."""
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        beyond = overturns(middle) == (begins == 1)
        low, high = np.where(beyond, low, middle), np.where(beyond, middle, high)
    return (low + high) / 2


# --- time histories --------------------------------------------------------------------------------------------------

MAX_COMPARED_IMPACTS = 6  # the times of later impacts depend on rounding
FREE_DURATION = 10.0  # s after the motion within which each excursion ends
MODELS: tuple[ModelName, ...] = ("nonlinear", "linear2", "linear1")


def histories(quick: bool) -> float:
    """Return the largest difference between times of uplift, impacts and overturning [s]."""
    blocks = (block(0.7, 2.8), block(0.3, 1.5), block(1.0, 3.0))
    of, motions, models = (blocks[:1], MOTIONS[:2], MODELS[:2]) if quick else (blocks, MOTIONS, MODELS)
    return max(_history(*case) for case in ((each, m, name) for each in of for m in motions for name in models))


def _history(of: Rocker, motion: GroundMotion, name: ModelName) -> float:
    history = follow(of.structure.model(name), motion)
    times = [history.uplift_time, *history.impacts[:MAX_COMPARED_IMPACTS, 0]]
    if history.fell:
        times.append(history.overturning_time)
    return largest_difference(times, event_times(of, motion, name))


def event_times(of: Rocker, motion: GroundMotion, name: ModelName) -> list[float]:
    """Return the times of uplift, of the first impacts, and of overturning if a block overturns before these [s]."""
    from scipy.integrate import solve_ivp

    alpha, p, time, ground = of.alpha, of.p, motion.time, motion.acceleration / GRAVITY
    kappa = 1.0 if name == "linear1" else alpha / tan(alpha)
    k, t = _uplift(time, np.abs(ground), alpha if name == "linear1" else tan(alpha))
    s, y, impacts, crossed = (-1 if ground[k + 1] > 0 else 1), [0.0, 0.0], [t], nan

    def slopes(t: float, y: Any) -> tuple[float, float]:
        push = s * (ground[k] + (ground[k + 1] - ground[k]) * (t - time[k]) / motion.dt) if k + 1 < time.size else 0.0
        if name != "nonlinear":
            return y[1], p**2 * (y[0] - alpha - kappa * push)
        return y[1], -(p**2) * (sin(alpha - y[0]) + push * cos(alpha - y[0]))

    while len(impacts) <= MAX_COMPARED_IMPACTS:
        stop = time[k + 1] if k + 1 < time.size else t + FREE_DURATION
        run = solve_ivp(
            slopes, (t, stop), y, "DOP853", events=_events(alpha), rtol=1e-12, atol=1e-14, max_step=0.02
        )  # fmt: skip
        impact, passed, far = run.t_events
        crossed = passed[-1] if passed.size else crossed
        t, y = float(run.t[-1]), run.y[:, -1]
        if far.size:
            return [*impacts, float(crossed)]
        if impact.size:
            impacts.append(t)
            s, y = -s, [0.0, -of.eta * y[1]]
        else:
            k += 1
    return impacts


def _uplift(time: Any, ground: Any, threshold: float) -> tuple[int, float]:
    """Return when the ground acceleration over g first exceeds the threshold: the sample before, and the time [s]."""
    k = int((ground > threshold).argmax()) - 1
    return k, float(time[k] + (time[k + 1] - time[k]) * (threshold - ground[k]) / (ground[k + 1] - ground[k]))


def _events(alpha: float) -> list[Any]:
    """Return functions for the solver that vanish at an impact, at the critical rotation, and far beyond it."""

    def impact(t: float, y: Any) -> float:
        return float(y[0])

    def critical(t: float, y: Any) -> float:
        return float(y[0] - alpha)

    def far(t: float, y: Any) -> float:
        return float(y[0] - 2 * alpha)

    events: list[Any] = [impact, critical, far]
    for event, terminal, direction in zip(events, (True, False, True), (-1, 1, 1), strict=True):
        event.terminal, event.direction = terminal, direction
    return events


# --- equivalent blocks -----------------------------------------------------------------------------------------------

OPPENHEIM = {"lambda_": 0.370009738022, "phi_cr": 0.069064693539, "kappa1": 0.280404501561, "p": 1.841795997344}
"""Oppenheim's arch, r = 10 m, by programs that share no code with this one: lambda by the static theorem (linear
programme of the line of thrust), the others by Eq. 39 and a four-bar linkage that Newton's method follows."""


def blocks(quick: bool) -> float:
    """Return the largest relative deviation of a parameter of an equivalent block; quick or not, all are computed."""
    deviations = []
    for structure, expected in _blocks():
        for side in (structure.equivalence.positive, structure.equivalence.negative):
            deviations += [getattr(side, name) / value for name, value in expected.items()]
    return largest_difference(deviations, np.ones(len(deviations)))


def _blocks() -> Iterator[tuple[Structure, dict[str, float]]]:
    """Yield structures and the parameters of their equivalent blocks: Table I of the paper, the wall, and an arch."""
    alpha, p = atan(0.25), sqrt(0.75 * GRAVITY / hypot(0.35, 1.4))
    common = {"lambda_": 0.25, "phi_cr": alpha, "kappa1": 1.0, "kappa2": alpha / 0.25}
    yield made("block", width=0.7, height=2.8), common | {"p": p, "eta": 1 - 1.5 * sin(alpha) ** 2}
    gamma = 0.5  # mass of the beam over that of the columns
    frame = {"p": p * sqrt((1 + 2 * gamma) / (1 + 3 * gamma))}
    frame["eta"] = (1 - 1.5 * sin(alpha) ** 2 + 3 * gamma * cos(2 * alpha)) / (1 + 3 * gamma)
    fields = {"columns": 2, "column_width": 0.7, "column_height": 2.8, "mass_ratio": gamma}
    yield made("symmetric_frame", **fields), common | frame
    h, r = 2.0, 0.2  # height and radius of a solid cone
    alpha = atan(4 * r / h)
    p = sqrt(5 * GRAVITY * hypot(h, 4 * r) / (2 * h**2 + 23 * r**2))
    cone = {"lambda_": 4 * r / h, "phi_cr": alpha, "kappa1": 1.0, "p": p}
    cone["eta"] = (2 * h**2 - 17 * r**2) / (2 * h**2 + 23 * r**2)
    yield made("cone", base_radius=r, height=h, kind="solid"), cone
    of = wall(0.3, 3.0)
    kappas = {"kappa1": 0.5, "kappa2": of.alpha / (2 * tan(of.alpha)), "lambda_lin": 2 * of.alpha}
    yield of.structure, kappas | {"lambda_": 2 * tan(of.alpha), "phi_cr": of.alpha, "p": of.p}
    yield made("arch", radius=10.0, thickness=1.5, inclusion_angle_deg=157.5, voussoirs=7), OPPENHEIM


# --- neighbours, openings and filters --------------------------------------------------------------------------------


def normal(x: float) -> float:
    """Return the share of a standard normal distribution below x."""
    return (1 + erf(x / sqrt(2))) / 2


def neighbours(quick: bool) -> float:
    """Return the largest deviation of a share; quick or not, all are computed.

    An acceleration held at x lambda g overturns every neighbour that it uplifts, whatever the restitution: a share of
    Phi(ln x/s) if amplitude or slenderness alone scatters, by .04 and .10. Restitutions scatter by .05 up to 1.
    """
    of = block(0.7, 2.8)
    model = of.structure.model("nonlinear")
    computed, expected = [], []
    for x, deviation, around in (
        (1.02, 0.04, near.Neighbourhood(slenderness=0.0)),
        (1.06, 0.1, near.Neighbourhood(amplitude=0.0)),
    ):
        held = GroundMotion("held", 0.5, np.full(20, x * tan(of.alpha) * GRAVITY), unit="m/s2")
        computed.append(near.neighbours(Conditions(of.structure, around=around), held).overturned)
        expected.append(normal(log(x) / deviation))
    for eta in (0.85, 0.9, 0.95):
        computed.append(float((near.Neighbourhood().drawn(model).eta[:, 0] < eta).mean()))
        expected.append(normal((eta - of.eta) / 0.05) / normal((1 - of.eta) / 0.05))
    return largest_difference(computed, expected)


def openings(quick: bool) -> float:
    """Return the largest error of two times of slip [s], which steps of 1.3 ms limit; quick or not, both are computed.

    A cube on friction mu = .2 beside a wall under an acceleration of .21 g does not uplift: it slides by (a - mu g)
    t^2/2, and its motion is unknown once this exceeds .5 % of the displacement of its centroid at the critical
    rotation, 45 degrees.
    A released block first slides when the shear force at its corner exceeds mu N, both by Newton's law.
    """
    cube = made("block", width=2.0, height=2.0, friction=0.2, one_sided="positive", rebound=0.5)
    history = follow(cube.model("nonlinear"), GroundMotion("held", 0.01, np.full(60, -0.21 * GRAVITY), unit="m/s2"))
    slip = 0.005 * 2 * sqrt(2) * sin(pi / 8)
    of, mu, top = block(0.7, 2.8), 0.15, 0.95
    rough = made("block", width=0.7, height=2.8, friction=mu)
    released = follow(rough.model("nonlinear"), None, release=top)
    expected = [sqrt(2 * slip / (0.01 * GRAVITY)), of.fall(top * of.alpha, _sliding(of, hypot(0.35, 1.4), mu, top))]
    return largest_difference([history.known_to, released.warned], expected)


def joints(quick: bool) -> float:
    """Return the largest deviation of a force at the corner of a rocking block, per kg and m/s2; quick or not, of all.

    The tables have the factors of 1, u_g'', q.^2 and v_g'' in the forces, and the compliance of each alone. They are
    compared half-way between their nodes, where they are least right.
    """
    of, radius = block(0.7, 2.8), hypot(0.35, 1.4)
    model = of.structure.model("nonlinear")  # a mass of 1 kg
    assert model.joints is not None and model.tables is not None
    cells, inertia, worst = len(model.joints.rows), 4 / 3 * radius**2, 0.0
    up = of.alpha - (np.arange(cells) + 0.5) / cells * model.tables[0].end / sqrt(inertia)  # angle from the vertical
    sine, cosine = np.sin(up), np.cos(up)
    turn, push = -(of.p**2) * sine, -(of.p**2) * cosine / GRAVITY  # rotation acceleration, by gravity and by u_g''
    for side, sign in enumerate((1, -1)):
        place, _, across, _ = model.joints.contacts[0, side]
        computed = model.joints.rows[:, side].reshape(cells, -1, 5, 4) @ 0.5 ** np.arange(4)
        normal, shear = GRAVITY + radius * sine * turn, sign * radius * cosine * turn
        expected = (
            (
                normal,
                sign * radius * sine * push,
                -radius * cosine / inertia,
                normal / GRAVITY,
                4 / (1 + 3 * cosine**2),
            ),
            (shear, 1 + radius * cosine * push, sign * radius * sine / inertia, shear / GRAVITY, 4 / (1 + 3 * sine**2)),
        )
        worst = max(worst, largest_difference(computed[:, [place, across]], np.array(expected).transpose(2, 0, 1)))
    return worst


def _sliding(of: Rocker, radius: float, mu: float, tilt: float) -> float:
    """Return the rotation at which a block that was released at a tilt first exceeds its friction [rad]."""
    low, top = 0.0, tilt * of.alpha
    high = top
    for _ in range(HALVINGS):
        phi = (low + high) / 2
        turn, up = -(of.p**2) * sin(of.alpha - phi), of.alpha - phi  # rotation acceleration, angle from the vertical
        square = 4 * of.p**2 * sin(of.alpha - (phi + top) / 2) * sin((top - phi) / 2)  # square of the rotation rate
        shear = radius * (turn * cos(up) + square * sin(up))
        force = GRAVITY + radius * (turn * sin(up) - square * cos(up))
        low, high = (phi, high) if abs(shear) > mu * force else (low, phi)
    return low


def filters(quick: bool) -> float:
    """Return the largest deviation of a filtered sine of amplitude 1, far from its ends; quick or not, in four cases.

    A Butterworth filter of order 4 that is applied forwards and backwards leaves 1/(1 + r^8), with the ratio r of the
    tangents of pi f dt of frequency and corner (or its inverse), and shifts nothing.
    """
    dt, count, middle = 0.01, 6001, slice(2500, 3500)
    worst = 0.0
    for kind, corner, f in (("highpass", 1.0, 0.8), ("highpass", 1.0, 2.0), ("lowpass", 4.0, 5.0), ("lowpass", 4.0, 2)):
        sine = np.sin(2 * pi * f * dt * np.arange(count))
        filtered = process(GroundMotion("sine", dt, sine, unit="m/s2"), [parse_step(kind, str(corner))]).acceleration
        r = (tan(pi * f * dt) / tan(pi * corner * dt)) ** (8 if kind == "lowpass" else -8)
        worst = max(worst, largest_difference(filtered[middle], sine[middle] / (1 + r)))
    return worst


SIZES = {
    "length": {"m": 1, "mm": 1e-3, "cm": 1e-2, "dm": 0.1, "km": 1e3, "in": 0.0254, "ft": 0.3048},
    "acceleration": {
        "m/s2": 1, "cm/s2": 1e-2, "mm/s2": 1e-3, "gal": 1e-2, "g": 9.80665, "mg": 9.80665e-3, "%g": 9.80665e-2,
        "ft/s2": 0.3048, "in/s2": 0.0254,
    },
    "mass": {"kg": 1, "g": 1e-3, "t": 1e3, "Mg": 1e3, "lb": 0.45359237},
    "force": {
        "N": 1, "daN": 10, "kN": 1e3, "MN": 1e6, "kgf": 9.80665, "lbf": 4.4482216152605, "kip": 4448.2216152605,
    },
    "stiffness": {
        "N/m": 1, "daN/m": 10, "kN/m": 1e3, "MN/m": 1e6, "N/mm": 1e3, "kN/mm": 1e6, "kgf/m": 9.80665,
    },
    "area": {"m2": 1, "cm2": 1e-4, "mm2": 1e-6},
    "pressure": {
        "Pa": 1, "kPa": 1e3, "MPa": 1e6, "GPa": 1e9, "N/mm2": 1e6, "daN/m2": 10, "kN/m2": 1e3,
        "daN/cm2": 10 / 0.01**2, "kg/cm2": 9.80665 / 0.01**2, "kgf/cm2": 9.80665 / 0.01**2, "bar": 1e5,
        "psi": 4.4482216152605 / 0.0254**2, "ksi": 4448.2216152605 / 0.0254**2,
    },
    "density": {"kg/m3": 1, "t/m3": 1e3, "g/cm3": 1e3, "kg/dm3": 1e3, "lb/ft3": 0.45359237 / 0.3048**3},
    "mass per length": {"kg/m": 1, "t/m": 1e3},
    "mass per area": {"kg/m2": 1, "t/m2": 1e3},
    "weight density": {
        "N/m3": 1, "daN/m3": 10, "kN/m3": 1e3, "kgf/m3": 9.80665, "lbf/ft3": 4.4482216152605 / 0.3048**3,
    },
    "time": {"s": 1, "ms": 1e-3, "min": 60},
    "velocity": {"m/s": 1, "cm/s": 1e-2, "mm/s": 1e-3, "in/s": 0.0254, "ft/s": 0.3048},
    "angle": {"rad": 1, "deg": pi / 180, "°": pi / 180, "mrad": 1e-3},
}  # fmt: skip
"""Sizes of units by their definitions, in the first one of each kind."""


def units(quick: bool) -> float:
    """Return the largest relative deviation of the size of a unit; quick or not, all are read."""
    if {kind: set(known) for kind, known in KINDS.items()} != {kind: set(known) for kind, known in SIZES.items()}:
        return inf
    ratios = [read(f"1 {unit}", next(iter(sizes))) / size for sizes in SIZES.values() for unit, size in sizes.items()]
    return largest_difference(ratios, np.ones(len(ratios)))


# --- two results of the same code ------------------------------------------------------------------------------------

THREADS = 4
TIE = {"name": "bar", "from": {"ground": [-3.0, 2.8]}, "to": {"at": [-0.35, 2.8]}, "area": 1e-5, "modulus": 2e11}


def threads(quick: bool) -> float:
    """Return how many values of the outcomes are missing, or differ in any bit."""
    parts = 2 if quick else THREADS
    return _histories_in(parts) + _pulses_in(parts)


def _histories_in(parts: int) -> int:
    """Return how many values of histories differ between one thread and several; `parts` is the number of tasks."""
    models = [wall(0.3, 3.0).structure.model("nonlinear")]  # a wall with a joint that is checked for opening
    models += block(0.7, 2.8).structure.models(("nonlinear", "linear2"))
    scales = np.linspace(0.5, 2.0, parts * batch.HISTORIES_PER_TASK // (len(models) * len(MOTIONS)))
    runs = Runs.every(len(models), len(MOTIONS), scales=scales.tolist())
    return _wrong(*(respond_many(models, MOTIONS, runs, threads=n, only_peaks=True) for n in (1, THREADS)))


def _pulses_in(parts: int) -> int:
    """Return how many values under pulses differ between one thread and several; `parts` is the number of tasks."""
    count, equivalence = parts * exact_batch.PULSES_PER_TASK, block(0.7, 2.8).structure.equivalence
    amplitudes, periods = np.geomspace(2.0, 20.0, count), np.geomspace(3.0, 0.3, count)
    many = partial(exact_many, equivalence, Sine(1.0, 1.0), amplitudes, periods, kappa=2, gravity=GRAVITY)
    return _wrong(*(many(threads=n) for n in (1, THREADS)))


def _wrong(one: Outcomes, other: Outcomes) -> int:
    different = sum(different_values(getattr(one, name), getattr(other, name)) for name in OUTCOME_FIELDS)
    return different + int(one.failed.sum() + other.failed.sum())  # runs that were never computed count as failed


def another_way() -> bool:
    """Return whether Python runs the kernels because the shipped ones are broken, and not as the user chose it."""
    return isinstance(ways.fault_of_shipped(), BrokenKernels) and not os.environ.get(ways.KERNELS_VARIABLE)


def kernels(quick: bool) -> float:
    """Return how many of the computed values differ in any bit.

    Raises
    ------
    NotRun
        If there are no kernels for this system.
    RockingError
        If the library for this system is damaged or missing, or does not load.
    """
    fault = ways.fault_of_shipped()
    if isinstance(fault, BrokenKernels):
        raise RockingError(str(fault)) from fault
    if fault is not None:
        raise NotRun(f"{fault}; Python computes histories") from fault
    computed = []
    for engine in (ways.MACHINE_CODE, ways.PYTHON):
        with ways.forced(engine):
            computed.append(list(_computed(quick)))
    return sum(different_values(*pair) for pair in zip(*computed, strict=True))


def _computed(quick: bool) -> Iterator[NDArray[Any]]:
    """Yield all arrays that the kernels fill."""
    free, two = block(0.7, 2.8).structure, made("wall", thickness=0.3, height=3.0)
    tied = made("block", width=0.7, height=2.8, mass=1000.0, ties=[TIE])
    amplitudes, periods = np.geomspace(2.0, 20.0, 50), np.geomspace(3.0, 0.3, 50)
    responses = exact_many(free.equivalence, Sine(1.0, 1.0), amplitudes, periods, kappa=2, gravity=GRAVITY)
    yield from (getattr(responses, name) for name in OUTCOME_FIELDS)
    for motion in MOTIONS[:1] if quick else MOTIONS:
        both = replace(motion, vertical=GroundMotion("vertical", 0.07, motion.acceleration[::-1] / 2, unit="m/s2"))
        for model in (*free.models(("nonlinear", "linear2")), two.model("nonlinear"), tied.model("nonlinear")):
            for each in (motion, both):
                history = follow(model, each, eta=0.9, most_kept=20)
                yield from (history.phi, history.rate, history.impacts)
                yield np.array([getattr(history, name) for name in OUTCOME_FIELDS], dtype=np.float64)


# --- records ---------------------------------------------------------------------------------------------------------

SAMPLES = [sign * 0.25 * ((37 * k) % 79 - 39) for sign in (1, -1) for k in range(100)]
"""Samples that every format can hold exactly, at intervals of `DT`. Their mean is zero, as K-NET has its zero there."""
DT = 0.01


class RecordFile(NamedTuple):
    """A file of a record format with `SAMPLES`, written from the description of the format alone.

    Parameters
    ----------
    title : str
        Name of the format in messages and results.
    unit : float
        Unit of the samples in the file [m/s2].
    path : Path
        The file.
    options : dict
        Arguments with which the file is read, for what the format does not state.
    """

    title: str
    unit: float
    path: Path
    options: dict[str, Any] = {}  # noqa: RUF012 - it does not change


FOLDER = Path(__file__).with_name("records")
FILES = {
    name: RecordFile(title, unit, FOLDER / name, {"channel": "1"} if name in ("afad", "asa", "cwa", "jma") else {})
    for name, title, unit in (
        ("afad", "AFAD", 0.01),
        ("asa", "ASA", 0.01),
        ("cosmos", "COSMOS", 0.01),
        ("csmip_v2", "CSMIP V2", 0.01),
        ("cwa", "CWA", 0.01),
        ("esm", "ESM ASCII", 0.01),
        ("geonet_v1a", "GeoNet V1A", 0.001),
        ("geonet_v2a", "GeoNet V2A", 0.001),
        ("jma", "JMA", 0.01),
        ("knet", "K-NET/KiK-net", 0.01),
        ("peer_at2", "PEER AT2", GRAVITY),
        ("simcenter", "SimCenter JSON", GRAVITY),
        ("smc", "USGS SMC", 0.01),
        ("text", "text", 1.0),
        ("usc_v1", "USC V1", GRAVITY / 10),
    )
}
"""A file of each format that this package reads, by the name of its reader."""
OBSPY_FILES = {
    "gse": RecordFile("GSE2", 0.01, FOLDER / "gse", {"gain": "0.25 cm/s2"}),
    "miniseed": RecordFile("miniSEED", 0.01, FOLDER / "miniseed", {"units": "cm/s2"}),
    "obspy": RecordFile("AH", 0.01, FOLDER / "obspy", {"units": "cm/s2"}),
    "sac": RecordFile("SAC", 0.01, FOLDER / "sac", {"units": "cm/s2"}),
    "slist": RecordFile("SLIST", 0.01, FOLDER / "slist"),
}
"""Files of the formats that are read by obspy, by the name of their reader."""
UNIT_SPELLINGS = {
    "g": GRAVITY, "m/s2": 1.0, "cm/s2": 0.01, "mm/s2": 0.001, "gal": 0.01, "mg": GRAVITY / 1000, "%g": GRAVITY / 100,
    "ft/s2": 0.3048, "in/s2": 0.0254,
}  # fmt: skip
"""Units of the accelerations of text files, as their headings spell them, and their sizes [m/s2]."""


def records(quick: bool) -> float:
    """Return the largest deviation of a sample, over the largest sample; quick or not, all formats are read."""
    with TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        of_units = {}
        for k, (unit, size) in enumerate(UNIT_SPELLINGS.items()):
            path = Path(folder) / str(k)
            text = FILES["text"].path.read_text(encoding="utf-8")
            path.write_text(text.replace("[m/s2]", f"[{unit}]"), encoding="utf-8")
            of_units[f"text in {unit}"] = RecordFile("text", size, path)
        return _records(FILES | of_units)


def records_by_obspy(quick: bool) -> float:
    """Return the same as `records` for formats that obspy reads. Raises `NotRun` if it is not installed."""
    if find_spec("obspy") is None:
        raise NotRun("obspy, which reads SAC, miniSEED and more, is not installed: pip install 'rocking-cli[seismo]'")
    return _records(OBSPY_FILES)


def _records(files: Mapping[str, RecordFile]) -> float:
    """Return the largest deviation of a sample, over the largest one. Raises `RockingError` with files read wrongly."""
    largest, wrong = 0.0, []
    for name, file in files.items():
        try:
            motion = read_record(file.path, **file.options)
        except RockingError as error:
            wrong.append(f"{name}: {str(error).splitlines()[0]}")
            continue
        if motion.format != file.title or not isclose(motion.dt, DT, rel_tol=1e-6):
            wrong.append(f"{name}: read as {motion.format} with an interval of {motion.dt:g} s")
        largest = max(largest, largest_difference(motion.acceleration / file.unit, SAMPLES) / max(SAMPLES))
    if wrong:
        raise RockingError("; ".join(wrong))
    return largest
