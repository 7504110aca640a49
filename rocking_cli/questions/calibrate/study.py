"""Restitution from a trace of free rocking: the whole trace is fitted at once.

The start of the fit comes from the times of the impacts, with the frequency parameter known: the time between two
impacts gives the peak between them, and this the energy. The fit itself uses every sample: rates before and after
impacts, and peaks, would be biased by noise and drift.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy.optimize import least_squares

from rocking_cli.arrays import Reals
from rocking_cli.ask.inputs import sheet_of
from rocking_cli.core import Direction
from rocking_cli.dynamics.model import MEASURED_SPREAD
from rocking_cli.errors import InputError, Problem
from rocking_cli.io.spreadsheet import DECIMAL_COMMA, Spreadsheet, unit_in
from rocking_cli.questions.calibrate.free_rocking import (
    FreeRocking,
    MechanismSide,
    RockingSide,
    ScaledSide,
    free_rocking,
    quarter_cycles,
)
from rocking_cli.short_repr import short_repr
from rocking_cli.structure import Structure
from rocking_cli.text import cut, one_line
from rocking_cli.units import UnitError, read, units_of

TIME_NAMES, ANGLE_NAMES = ("time", "t"), ("angle", "rotation", "theta", "phi", "tilt")
MAX_SHOWN_CELLS = 20  # unreadable cells that an error message names
MIN_IMPACTS = 3
MAX_FITTED_ETAS = 15  # later impacts are too small to determine their restitution
MIN_SAMPLES = 30
MIN_ALPHA = 0.07  # rad: for smaller slenderness, p and alpha cannot be told apart
MIN_ANGLE_SHARE = 1e-6  # angle over that of overturning: no instrument resolves less
MAX_TRACE_DURATION = 1e6  # s
MIN_PEAK_TO_NOISE = 3.0  # peak over noise, from which a half-cycle can be seen in the trace
MIN_LARGEST_TO_NOISE = 5.0  # largest angle of a usable trace over its noise
MAX_RELEASE_SHARE = 0.98  # release over the critical rotation
FITTED_QUARTER_SHARE = 0.9  # share of the quarter cycle before the first impact that is fitted
# Least share of the release by which a half-cycle exceeds the last on its side, if a new test starts there.
MIN_NEW_TEST_GROWTH = 0.2
MIN_GAP_RATIO = 3.0  # interval over the median interval, from which there is a gap in the trace
START_ETAS = (0.6, 0.75, 0.85, 0.9, 0.94, 0.97, 0.985)  # restitutions tried if the impact times do not lead to a fit
MAX_GOOD_RESIDUAL = 0.05  # share of the release; a missed impact gives more, and other starts are tried
WINDOWS = (3, 6, 12, 24, 48, 1_000_000)  # numbers of impacts up to which the trace is fitted, in turn
MIN_LEVEL_DISTANCE = 0.03  # share of the largest angle: closer levels of rest lead to the same fit
MAX_FURTHER_STARTS = 3  # starts that are tried if the residual of the first is large
MAX_RESIDUAL = 0.2  # share of the release: with more, the trace is not free rocking of this structure
MAX_RESIDUAL_OF_ETAS = 0.1  # share of the release, with an eta per impact: with more, the structure is another one
MIN_NOISE = 1e-5  # share of the release: the numerical error of the fit
MAX_PATTERN_RATIO = 2.0  # variance of means of residuals over that of white noise
GEOMETRY_STEP = 0.02  # share of the errors of the geometry, for finite differences
RELEASE, START, OFFSET, DRIFT, ETA = range(5)  # indices of the parameters; further etas and the geometry follow
PRIOR_IMPACTS = 1.0  # number of impacts that the scatter of other bodies counts for
INTERVAL_DROP = 1.6  # drop of the log-likelihood at the ends of an interval of 5 to 95 % (1.35 if impacts are many)
MAX_RESIDUAL_TO_NOISE = 1.2  # residual over the noise, above which the model does not explain the trace
SIDES, P, ALPHA = range(3)  # indices: ln of alpha of one side over the other, of p and of alpha over those of the file


@short_repr
@dataclass(frozen=True, eq=False)
class Trace:
    """Angle of a structure over time, as measured; cells without an angle are left out.

    Parameters
    ----------
    name : str
        Name of the file.
    times : ndarray, shape (n,)
        Times, which increase [s].
    angles : ndarray, shape (n,)
        Angles, of either sense [rad].
    """

    name: str
    times: Reals
    angles: Reals


def read_trace(path: Path) -> Trace:
    """Read a trace from a CSV file with the headings `time [s]` and `angle [deg]`, or other units.

    Raises
    ------
    InputError
        With every problem of the file, by line and column.
    """
    sheet = sheet_of(path)
    time, seconds = _column(sheet, TIME_NAMES, "s")
    angle, unit = _column(sheet, ANGLE_NAMES, "rad")
    problems: list[Problem] = []
    times: list[float] = []
    angles: list[float] = []
    for row in sheet.rows:
        if row.cells[angle].lower() in ("", "nan"):
            continue  # a gap in the trace
        values = []
        for place, unit_of_column, kind in ((time, seconds, "s"), (angle, unit, "rad")):
            cell = row.cells[place]
            if sheet.decimal_comma and DECIMAL_COMMA.fullmatch(cell):
                cell = cell.replace(",", ".", 1)
            try:
                values.append(read(f"{cell} {unit_of_column}", kind))
            except UnitError:
                what = f"{cut(one_line(cell))!r} is not a number"
                problems.append(Problem(what, sheet.file, row.line, field=one_line(sheet.headings[place])))
        if len(values) == 2:
            if times and values[0] <= times[-1]:
                what = f"must be later than the row before, {times[-1]:g} s, got {values[0]:g} s"
                problems.append(Problem(what, sheet.file, row.line, field=one_line(sheet.headings[time])))
            times.append(values[0])
            angles.append(values[1])
    if problems:
        raise InputError(*problems[:MAX_SHOWN_CELLS])
    return Trace(sheet.file, np.array(times), np.array(angles))


def _column(sheet: Spreadsheet, names: Sequence[str], kind: str) -> tuple[int, str]:
    """Return the place and the unit of a column, by its name or else by its unit. Raises `InputError`."""
    columns = []
    for k, heading in enumerate(sheet.headings):
        name, unit = unit_in(heading, units_of(kind))
        if name.strip().lower() in names or unit in units_of(kind):
            columns.append((k, unit))
    if len(columns) != 1:
        what = f"one column must be the {names[0]}, {len(columns) or 'none'} of {len(sheet.headings)} is"
        hint = f"head the columns time [s] and angle [deg]; units of the {names[0]}: {', '.join(units_of(kind))}"
        raise InputError(Problem(what, sheet.file, sheet.line, hint=hint))
    place, unit = columns[0]
    if not unit and kind == "s":
        unit = "s"
    if unit not in units_of(kind):
        what = f"its unit must be one of {', '.join(units_of(kind))}" + (f", got {cut(one_line(unit))}" if unit else "")
        hint = "head the column time [s]" if kind == "s" else "head the column angle [deg] or angle [rad]"
        raise InputError(Problem(what, sheet.file, sheet.line, field=cut(one_line(sheet.headings[place])), hint=hint))
    return place, unit


class Estimated(NamedTuple):
    """A fitted number and its standard deviation."""

    value: float
    deviation: float


@short_repr
class Pooled(NamedTuple):
    """Mean and scatter of the restitutions of impacts.

    Parameters
    ----------
    mean : float
        Weighted mean.
    weights : ndarray, shape (n,)
        Weights of the mean.
    scatter : float
        Standard deviation of the restitution from impact to impact, drawn towards that of other bodies; never 0.
    seen : float
        Scatter of these impacts alone, without the part that noise explains; 0 if noise explains all of it.
    interval : tuple of float
        Range of the scatter that agrees with these impacts, 5 to 95 %.
    """

    mean: float
    weights: Reals
    scatter: float
    seen: float
    interval: tuple[float, float]


@short_repr
@dataclass(frozen=True, eq=False)
class TraceFit:
    """Restitution of a structure, fitted to a trace of free rocking.

    Parameters
    ----------
    trace : Trace
        The trace.
    eta : Estimated
        Coefficient of restitution: the mean of the impacts. Its deviation is that of noise, of the scatter from impact
        to impact, and of the geometry of the structure.
    etas : sequence of Estimated
        Restitution of each impact that is seen, each fitted on its own; deviations are those of noise.
    pooled : Pooled
        Mean and scatter of the restitutions, without the error of the geometry.
    release : float
        Angle at which the structure was let go, in the sense of the trace [rad]; like all that follows but `fitted`, it
        is that of the fit with a restitution for each impact, which a scatter does not disturb.
    release_time : float
        Time at which it was let go [s].
    offset, drift : Estimated
        Angle of the trace at time zero with the structure at rest [rad], and its rate [rad/s].
    impacts : ndarray, shape (k,)
        Times of the impacts that are seen [s].
    fitted, own : ndarray, shape (n,)
        Angle at each sample [rad], with one restitution for all impacts and with one for each; NaN where the trace is
        not fitted: before the structure falls, and long after it has come to rest.
    noise : float
        Noise of the trace, from the differences of neighbouring residuals [rad].
    patterned : bool
        Whether means of some neighbouring residuals are larger than white noise leaves; deviations include that.
    sides : Estimated or None
        Slenderness in the positive sense of the trace over that in the negative one, as a multiple of this ratio in the
        structure; None if it rocks in one direction only.
    p, alpha : Estimated, optional
        Frequency parameter [rad/s] and slenderness [rad], if they were fitted.
    """

    trace: Trace
    eta: Estimated
    etas: Sequence[Estimated]
    pooled: Pooled
    release: float
    release_time: float
    offset: Estimated
    drift: Estimated
    impacts: Reals
    fitted: Reals
    own: Reals
    noise: float
    patterned: bool
    sides: Estimated | None
    p: Estimated | None = None
    alpha: Estimated | None = None

    @property
    def scatter(self) -> float:
        """Standard deviation of the restitution from impact to impact, drawn towards that of other bodies; never 0."""
        return self.pooled.scatter

    @property
    def part(self) -> tuple[float, float]:
        """Times between which the trace is fitted [s]."""
        times = self.trace.times[np.isfinite(self.own)]
        return float(times[0]), float(times[-1])

    @property
    def residual(self) -> float:
        """Root mean square of the residual with one restitution [rad]."""
        return _rms(self.trace.angles - self.fitted)

    @property
    def own_residual(self) -> float:
        """Root mean square of the residual with a restitution for each impact [rad]."""
        return _rms(self.trace.angles - self.own)


@dataclass(frozen=True, eq=False)
class _Problem:
    """The samples to fit, and the structure; angles are in units of the release, `scale`, times from `origin`."""

    times: Reals
    angles: Reals
    origin: float
    scale: float
    level: float  # angle at rest from which the fit starts
    contact: float  # approximate time of the first impact
    crossings: Sequence[tuple[float, bool]]  # times of the impacts, and whether they are in a gap
    sides: Mapping[Direction, RockingSide]
    first: Direction
    sense: float  # sign in the trace of a positive rotation of the structure
    free: Sequence[int] = ()  # indices of fitted geometry, the last parameters
    geometry: tuple[float, float, float] = (0.0, 0.0, 0.0)  # fixed part of the geometry

    def motion(self, x: Reals) -> FreeRocking:
        """Return the rotation of the structure from the release on, for the parameters `x` of a fit."""
        etas, geometry = x[ETA : x.size - len(self.free)], np.array(self.geometry)
        geometry[list(self.free)] += x[x.size - len(self.free) :]
        one, p, alpha = np.exp(geometry)
        sides = {each: ScaledSide(side, p, alpha * one ** (int(each) / 2)) for each, side in self.sides.items()}
        release = min(x[RELEASE] * self.scale, 0.9999 * sides[self.first].end)
        until = float(self.times[-1] - x[START])
        return free_rocking(sides, int(self.first) * release, etas, rebounds=len(sides) == 1, until=until)

    def model(self, x: Reals, times: Reals) -> Reals:
        """Return the angle of the trace at given times, for the parameters `x` of a fit."""
        rotation = self.sense * self.motion(x).at(times - x[START]) / self.scale
        return np.asarray(rotation + x[OFFSET] + x[DRIFT] * times / self.times[-1])

    def distance(self, x: Reals) -> float:
        """Return the root mean square of the residual, for the parameters `x` of a fit."""
        return _rms(self.model(x, self.times) - self.angles)

    def fit(self, x: Reals, until: float = np.inf) -> tuple[Reals, Reals, float]:
        """Return the fitted parameters, the Jacobian and the root mean square of the residual, up to a time."""
        inside = self.times <= until
        times, angles = self.times[inside], self.angles[inside]
        low, high = np.full(x.size, -np.inf), np.full(x.size, np.inf)
        etas, geometry = slice(ETA, x.size - len(self.free)), slice(x.size - len(self.free), None)
        low[RELEASE], low[etas], high[etas], low[geometry], high[geometry] = 1e-6, 0.02, 1.2, -1.0, 1.0
        solution = least_squares(
            lambda each: self.model(each, times) - angles, np.clip(x, low, high), bounds=(low, high),
            x_scale="jac", diff_step=1e-6, xtol=1e-8, ftol=1e-6, gtol=1e-10, max_nfev=20,
        )  # fmt: skip
        return solution.x, solution.jac, float(np.sqrt(2 * solution.cost / angles.size))


def fit_trace(structure: Structure, trace: Trace, *, free_geometry: bool = False) -> TraceFit:
    """Fit the restitution of a structure to a trace of free rocking.

    Parameters
    ----------
    structure : Structure
        The structure; its geometry is held.
    trace : Trace
        Angle over time, of either sense, with any sampling and gaps. Lifting and holding may come before the release,
        and rest, or another test, after the rocking: the largest release is fitted.
    free_geometry : bool
        Whether p and alpha are fitted as well; only of a free-standing block.

    Returns
    -------
    TraceFit
        The restitution, its scatter, and that of each impact.

    Raises
    ------
    InputError
        If the trace, or the structure, does not allow a fit; the reason is given.
    MechanismError
        If the structure has no critical rotation.
    """
    mechanism = structure.mechanism
    structure.ask("trace")
    if free_geometry:
        _check_free(structure)
    sides: dict[Direction, RockingSide] = {
        direction: MechanismSide(mechanism, direction, each.reference)
        for direction, each in zip(Direction, structure.statics, strict=True)
        if direction in mechanism.directions
    }
    noise = _noise(trace)
    symmetric = structure.model("nonlinear").symmetric
    problems, count = [], 0
    for level in _levels(trace, noise, max(side.end for side in sides.values())):
        for first in [Direction.POSITIVE] if symmetric else sides:
            problem = _problem(trace, level, noise, sides, first)
            if problem is not None:
                problems.append(problem)
                count = max(count, len(problem.crossings))
    if not problems or (mechanism.rocks_both_ways and count < MIN_IMPACTS):
        raise InputError(_too_few(trace, count))
    try:
        with np.errstate(all="ignore"):  # a poor trial has no finite residual, and is never the best fit
            problem, x = _common(problems)
            level = float(x[OFFSET] + x[DRIFT] * problem.contact / problem.times[-1]) * problem.scale
            again = _problem(trace, level, noise, sides, problem.first)  # excludes the lifting from the fit
            return _each(*_common([again or problem]), trace, structure, free_geometry)
    except (ArithmeticError, np.linalg.LinAlgError):
        what = "no motion of this structure fits: check its size, and the units of times and angles"
        raise InputError(f"{trace.name}: {what}") from None


def _check_free(structure: Structure) -> None:
    """Raise `InputError` unless p and alpha of a structure can be fitted."""
    mechanism = structure.mechanism
    if mechanism.mechanism != "block" or not mechanism.is_bare:
        raise InputError(
            f"{structure.name}: p and alpha can be fitted of a free-standing block (mechanism: block) only"
        )
    alpha = structure.equivalence.positive.phi_cr
    if alpha < MIN_ALPHA:
        raise InputError(
            f"{structure.name}: alpha is {alpha:.3g} rad. Below {MIN_ALPHA:g} rad, a trace does not tell p "
            "and alpha apart: hold the geometry"
        )


def _noise(trace: Trace) -> float:
    """Return the noise of a trace. Raises `InputError` if it is too short or too long, or is no numbers."""
    if not (np.isfinite(trace.angles).all() and np.isfinite(trace.times).all() and (np.diff(trace.times) > 0).all()):
        what = "times and angles must be finite numbers, and times increase: leave out samples without an angle"
        raise InputError(f"{trace.name}: {what}")
    if trace.times.size < MIN_SAMPLES:
        raise InputError(f"{trace.name}: a trace needs at least {MIN_SAMPLES} samples, got {trace.times.size}")
    length = float(trace.times[-1] - trace.times[0])
    if length > MAX_TRACE_DURATION:
        raise InputError(f"{trace.name}: the trace lasts {length:.3g} s: check the unit of the times")
    third = np.abs(np.diff(trace.angles, 3))  # its variance is 20 times that of the white noise
    return float(np.median(third) or np.mean(third)) / 0.6745 / float(np.sqrt(20))


def _rms(values: Reals) -> float:
    return float(np.sqrt(np.nanmean(values**2)))


def _too_few(trace: Trace, count: int) -> str:
    return (
        f"{trace.name}: {count or 'no'} impact{'s' * (count != 1)} can be seen above the noise, and a fit needs "
        f"{MIN_IMPACTS}: release the structure from a larger angle, or record longer"
    )


def _levels(trace: Trace, noise: float, most: float) -> list[float]:
    """Return what the angle at rest may be [rad]: zero, the end of the trace, the middle between its extremes.

    Raises `InputError` if no angle is large enough, or all are too large.
    """
    angles = trace.angles
    size = float(np.ptp(angles)) / 2
    if not size > 0:
        raise InputError(f"{trace.name}: the angle is the same in all samples: there is no motion to fit")
    if not size > MIN_LARGEST_TO_NOISE * noise:
        raise InputError(
            f"{trace.name}: the noise, {np.degrees(noise):.2g} deg, is not below a fifth of the largest angle, "
            f"{np.degrees(size):.2g} deg: there is no motion to fit"
        )
    if size > 2 * most:
        raise InputError(
            f"{trace.name}: the largest angle, {np.degrees(size):.3g} deg, is more than twice the rotation at which "
            f"the structure overturns, {np.degrees(most):.3g} deg: check the unit of the angles, and the structure"
        )
    if size < MIN_ANGLE_SHARE * most:
        raise InputError(
            f"{trace.name}: the largest angle, {np.degrees(size):.3g} deg, is below {MIN_ANGLE_SHARE:g} times the "
            f"rotation at which the structure overturns, {np.degrees(most):.3g} deg: check the unit of the angles"
        )
    levels: list[float] = []
    tail = angles[-max(angles.size // 10, 5) :]
    for level in (float(np.median(tail)), 0.0, float((angles.max() + angles.min()) / 2)):
        if all(abs(level - each) > MIN_LEVEL_DISTANCE * size for each in levels):
            levels.append(level)
    return levels


def _problem(
    trace: Trace, level: float, noise: float, sides: Mapping[Direction, RockingSide], first: Direction
) -> _Problem | None:
    """Find the rocking in a trace, and return what is to be fitted; None if nothing falls with this level of rest."""
    times, angles = trace.times, trace.angles - level
    top = int(np.argmax(np.abs(angles)))
    release, sign = abs(float(angles[top])), float(np.sign(angles[top]))
    sizes = np.linspace(0.002, MAX_RELEASE_SHARE, 80) * sides[first].end
    table = quarter_cycles(sides[first], sizes)
    if len(sides) == 1:  # angles keep their sign: the first impact follows soon after half of the fall
        falls = np.flatnonzero(sign * angles[top:] < release / 2)[:1]
        crossings = [(float(times[top + k]) + 0.25 * float(np.interp(release, sizes, table)), True) for k in falls]
    else:
        crossings = [each for each in _crossings(times, angles, max(4 * noise, 0.01 * release)) if each[0] > times[top]]
    if not crossings:
        return None
    contact = crossings[0][0]
    for _ in range(3):  # repeated without the larger angles before the release, while it is lifted
        falling = (times > contact - np.interp(release, sizes, table)) & (times < contact)
        highest = float(np.max(sign * angles[falling], initial=0.0))
        release = highest if highest > release / 2 else release  # otherwise it falls more slowly than this structure
    since = contact - FITTED_QUARTER_SHARE * float(np.interp(release, sizes, table))
    until = np.inf
    if len(sides) > 1:
        edges = [*(each[0] for each in crossings), np.inf]
        peaks = [np.max(np.abs(angles[(times >= a) & (times < b)]), initial=0.0) for a, b in pairwise(edges)]
        before = np.array([release, *peaks[:-2]])  # on the same side
        grows = np.flatnonzero(np.array(peaks[1:]) > before + MIN_NEW_TEST_GROWTH * release) + 1
        crossings = crossings[: grows[0] + 1] if grows.size else crossings
        until = crossings[-1][0] if grows.size else 2 * crossings[-1][0] - since
    inside = (times >= since) & (times <= until)
    if inside.sum() < MIN_SAMPLES:
        return None
    origin = float(times[inside][0])
    return _Problem(
        times[inside] - origin, trace.angles[inside] / release, origin, release, level / release, contact - origin,
        [(when - origin, hidden) for when, hidden in crossings], sides, first, sign * int(first),
    )  # fmt: skip


def _crossings(times: Reals, angles: Reals, hold: float) -> list[tuple[float, bool]]:
    """Return when the angle changes its sign by more than `hold` on both sides, and whether that is in a gap."""
    usual = float(np.median(np.diff(times)))
    crossings: list[tuple[float, bool]] = []
    far = np.flatnonzero(np.abs(angles) > hold)
    for k in np.flatnonzero(np.diff(np.sign(angles[far]))):
        one, other = far[k], far[k + 1]
        part = slice(one, other + 1)
        share = angles[one] / (angles[one] - angles[other])
        when = float(times[one] + share * (times[other] - times[one]))
        crossings.append((when, bool(np.diff(times[part]).max() > MIN_GAP_RATIO * usual)))
    return crossings


def _starts(problem: _Problem) -> list[Reals]:
    """Return where a fit may start, best first: the restitution by the times of impacts, then given ones."""
    side = problem.sides[problem.first]
    sizes = np.linspace(0.002, 0.98, 80) * side.end
    table = quarter_cycles(side, sizes)
    release = min(1.0, MAX_RELEASE_SHARE * side.end / problem.scale)
    start = problem.contact - float(np.interp(release * problem.scale, sizes, table))
    etas = list(START_ETAS)
    spans = [
        (k, (after - when) / 2)
        for k, ((when, hidden), (after, also)) in enumerate(pairwise(problem.crossings), 1)
        if not hidden and not also
    ]
    if len(spans) > 1:
        peaks = np.interp([each[1] for each in spans], table, sizes)
        heights = np.log(peaks * side.lift(peaks))
        slope = float(np.polyfit([each[0] for each in spans], heights, 1)[0])
        etas.insert(0, float(np.clip(np.exp(slope / 2), 0.3, 0.995)))
    return [np.array([release, start, problem.level, 0.0, eta]) for eta in etas]


def _common(problems: Sequence[_Problem]) -> tuple[_Problem, Reals]:
    """Fit one restitution for all impacts to each part of a trace that may be the rocking; return the best."""
    starts = [(each, x) for each in sorted(problems, key=lambda each: -each.times[-1]) for x in _starts(each)]
    # Starts from the times of impacts come first, then starts that are nearest to the trace.
    first = [each for each in starts if each[1][ETA] not in START_ETAS]
    rest = sorted((each for each in starts if each[1][ETA] in START_ETAS), key=lambda each: each[0].distance(each[1]))
    best, least = starts[0], np.inf
    for problem, x in [*first, *rest[:MAX_FURTHER_STARTS]]:
        for count in WINDOWS:  # longer and longer parts of the trace, so that no impact is missed or added
            impacts = problem.motion(x).impacts + x[START]
            until = impacts[count - 1] if count <= impacts.size else np.inf
            x, _, rms = problem.fit(x, until)
            if until >= problem.times[-1] or rms > MAX_RESIDUAL:
                break
        same = abs(rms - least) < 1e-3 * rms  # whether two starts lead to the same fit
        if rms < least:
            best, least = (problem, x), rms
        if least < MAX_GOOD_RESIDUAL or same:
            break
    return best


def _freed(problem: _Problem, x: Reals, free: Sequence[int]) -> tuple[_Problem, Reals, Reals]:
    """Fit some of the geometry, too; return the problem with this geometry, the parameters, and its covariance."""
    apart = replace(problem, free=free)
    x = np.append(x, np.zeros(len(free)))
    for _ in range(4):  # one fit may stop halfway along a valley
        x, jacobian, _ = apart.fit(x)
    geometry = np.array(problem.geometry)
    geometry[list(free)] += x[-len(free) :]
    misfit = apart.model(x, apart.times) - apart.angles
    noise = max(_noise_of(misfit), MIN_NOISE)
    factor = noise**2 * max(1.0, _pattern(misfit, noise, len(problem.crossings) * 6))
    covariance = factor * np.asarray(np.linalg.pinv(jacobian.T @ jacobian))[-len(free) :, -len(free) :]
    return replace(problem, geometry=tuple(geometry.tolist())), x[: -len(free)], covariance


def _each(problem: _Problem, x: Reals, trace: Trace, structure: Structure, free_geometry: bool) -> TraceFit:
    """Fit a restitution for each impact, and return it and the fit of a common one, in the units of the trace."""
    times, scale = problem.times, problem.scale
    one = problem.distance(x)
    if not one < MAX_RESIDUAL:
        raise InputError(_is_other(problem, x, one, trace, structure))
    # Errors of width and height in ln p and ln alpha, which move the mean.
    size = structure.model("nonlinear").scatter.slenderness / np.sqrt(2)
    errors = np.array([[0.0, size], [-size / 2, -size]])
    p = alpha = sides = None
    if free_geometry:
        problem, x, covariance = _freed(problem, x, [P, ALPHA])
        errors, block = np.linalg.cholesky(covariance).T, structure.equivalence.positive
        values = np.exp(problem.geometry[P:]) * (block.p, block.phi_cr)
        pairs = zip(values, np.sqrt(np.diag(covariance)), strict=True)
        p, alpha = (Estimated(float(v), float(v * d)) for v, d in pairs)
    parameters, count, solve, noise, pattern = _own(problem, x, trace)
    if len(problem.sides) > 1 and problem.distance(x) > MAX_RESIDUAL_TO_NOISE * noise:
        apart, other, covariance = _freed(problem, x, [SIDES])
        least = problem.distance(parameters) ** 2
        # Keep different sides if these explain most of the scatter.
        if apart.distance(other) ** 2 - least < 0.1 * (problem.distance(x) ** 2 - least):
            problem, x = apart, other
            ratio = float(np.exp(problem.sense * problem.geometry[SIDES]))
            sides = Estimated(ratio, ratio * float(np.sqrt(covariance[0, 0])))
            parameters, count, solve, noise, pattern = _own(problem, x, trace)
    if not problem.distance(parameters) < MAX_RESIDUAL_OF_ETAS:
        raise InputError(_is_other(problem, x, problem.distance(parameters), trace, structure))
    covariance = noise**2 * max(1.0, pattern) * solve @ solve.T
    deviation = np.sqrt(np.diag(covariance))
    last = ETA + count - 1  # the last eta is left out of the mean, as all later impacts share it
    pooled = pool(parameters[ETA:last], covariance[ETA:last, ETA:last], MEASURED_SPREAD)
    w = pooled.weights
    variance = w @ covariance[ETA:last, ETA:last] @ w + pooled.scatter**2 * (w @ w)
    for error in errors:
        geometry = np.array(problem.geometry) + GEOMETRY_STEP * np.append(0.0, error)
        changed = replace(problem, geometry=tuple(geometry))
        moved = solve @ (changed.model(parameters, times) - problem.model(parameters, times))
        variance += (w @ moved[ETA:last] / GEOMETRY_STEP) ** 2
    origin = problem.origin
    offset, drift = _baseline(problem, parameters, covariance)
    after = trace.times - origin
    fitted = (after >= 0) & (after <= times[-1])
    return TraceFit(
        trace,
        Estimated(pooled.mean, float(np.sqrt(variance))),
        [Estimated(float(parameters[k]), float(deviation[k])) for k in range(ETA, last + 1)],
        pooled,
        problem.sense * int(problem.first) * float(parameters[RELEASE]) * scale,
        float(parameters[START]) + origin,
        offset,
        drift,
        problem.motion(parameters).impacts[:count] + float(parameters[START]) + origin,
        np.where(fitted, problem.model(x, after) * scale, np.nan),
        np.where(fitted, problem.model(parameters, after) * scale, np.nan),
        noise * scale,
        pattern > MAX_PATTERN_RATIO,
        sides,
        p,
        alpha,
    )


def _baseline(problem: _Problem, x: Reals, covariance: Reals) -> tuple[Estimated, Estimated]:
    """Return the offset at time zero and the drift per second of a fitted trace, in the units of the trace."""
    total, part = float(problem.times[-1]), slice(OFFSET, DRIFT + 1)
    at_zero, rate = np.array([1.0, -problem.origin / total]), np.array([0.0, 1.0 / total])
    offset, drift = (
        Estimated(*(problem.scale * float(v) for v in (w @ x[part], np.sqrt(w @ covariance[part, part] @ w))))
        for w in (at_zero, rate)
    )
    return offset, drift


def _is_other(problem: _Problem, x: Reals, off: float, trace: Trace, structure: Structure) -> str:
    """Say that a trace is not of this structure, and which frequency parameter fits better, if one does."""
    sentence = (
        f"{trace.name}: the best fit is off by {100 * off:.2g} % of the release (root mean square): this is not free "
        "rocking of this structure. Check its size, and the units of angles and times"
    )
    other, y, _ = _freed(problem, x, [P])
    if other.distance(y) > off / 2:
        return sentence
    p = structure.p * np.exp(other.geometry[P])
    return f"{sentence}; p = {p:.3g} rad/s fits better than {structure.p:.3g} rad/s, its own"


def _own(problem: _Problem, x: Reals, trace: Trace) -> tuple[Reals, int, Reals, float, float]:
    """Fit a restitution for each impact that is seen, from one for all.

    Return the parameters, the number of impacts, the inverse of the Jacobian, the noise, and the pattern of residuals.
    """
    motion, noise = problem.motion(x), _noise_of(problem.model(x, problem.times) - problem.angles)
    inside = motion.impacts[:-1] + x[START] < problem.times[-1]
    count = int(np.count_nonzero(inside & (motion.peaks[1:] > MIN_PEAK_TO_NOISE * noise * problem.scale)))
    if count < MIN_IMPACTS:
        raise InputError(_too_few(trace, count))
    count = min(count, MAX_FITTED_ETAS)
    parameters, jacobian, _ = problem.fit(np.concatenate([x[:ETA], np.full(count, x[ETA])]))
    # At rest, a coarse resolution may hide the noise.
    rocking = problem.times < problem.motion(parameters).impacts[count - 1] + parameters[START]
    misfit = (problem.model(parameters, problem.times) - problem.angles)[rocking]
    noise = max(_noise_of(misfit), MIN_NOISE)
    return parameters, count, np.asarray(np.linalg.pinv(jacobian)), noise, _pattern(misfit, noise, 6 * count)


def _noise_of(misfit: Reals) -> float:
    """Return the noise from the differences of neighbouring residuals, which no slow misfit enters."""
    return _rms(np.diff(misfit)) / float(np.sqrt(2))


def _pattern(misfit: Reals, noise: float, parts: int) -> float:
    """Return the variance of means of parts of the residual, over that of white noise."""
    size = max(2, misfit.size // parts)
    means = misfit[: misfit.size // size * size].reshape(-1, size).mean(axis=1)
    return float(np.mean(means**2)) * size / noise**2


def pool(etas: Reals, covariance: Reals, usual: float) -> Pooled:
    """Return mean and scatter of restitutions with errors.

    Parameters
    ----------
    etas : ndarray, shape (n,)
        Restitutions of impacts.
    covariance : ndarray, shape (n, n)
        Covariance of their errors.
    usual : float
        Scatter of other bodies, towards which that of few impacts is drawn.
    """
    scatters = np.geomspace(1e-5, 0.5, 400)  # the first stands for 0
    inverse = np.linalg.inv(covariance + scatters[:, None, None] ** 2 * np.eye(etas.size))
    weights = inverse.sum(axis=2) / inverse.sum(axis=(1, 2))[:, None]
    off = etas - (weights @ etas)[:, None]
    chi = np.einsum("ki,kij,kj->k", off, inverse, off)
    likelihood = (np.linalg.slogdet(inverse)[1] - np.log(inverse.sum(axis=(1, 2))) - chi) / 2
    best = int(np.argmax(likelihood))
    inside = scatters[likelihood > likelihood[best] - INTERVAL_DROP]
    drawn = likelihood - PRIOR_IMPACTS * (np.log(scatters) + (usual / scatters) ** 2 / 2)
    each = np.exp(drawn - drawn.max())
    scatter = float(np.sqrt(each.sum() / (each @ scatters**-2)))
    seen, low, high = (0.0 if each == scatters[0] else float(each) for each in (scatters[best], inside[0], inside[-1]))
    return Pooled(float(weights[best] @ etas), weights[best], scatter, seen, (low, high))
