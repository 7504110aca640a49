"""Views of a calibrated restitution, as text and as data."""

from __future__ import annotations

from collections.abc import Iterator
from math import degrees
from pathlib import Path
from typing import Any, NamedTuple

from rocking_cli.dynamics.model import MEASURED_SPREAD
from rocking_cli.names import percent
from rocking_cli.questions.calibrate.region import REGION_PROBABILITY, JointRegion
from rocking_cli.questions.calibrate.study import MAX_RESIDUAL_TO_NOISE, Estimated, TraceFit
from rocking_cli.structure import Structure
from rocking_cli.views.column import Column, of, only_shown, rounded, table_of
from rocking_cli.views.view import Table, View, heading


class ImpactRow(NamedTuple):
    """An impact of a trace: its number, its time [s], and the restitution that was fitted to it."""

    number: int
    time: float
    eta: Estimated


IMPACTS: tuple[Column[ImpactRow], ...] = (
    only_shown("impact", of("number")),
    only_shown("time [s]", of("time"), rounded(5)),
    only_shown("eta", of("eta.value"), rounded(4)),
    only_shown("error of\nits fit", of("eta.deviation"), rounded(2)),
)


def trace_view(found: TraceFit, structure: Structure) -> View:
    """Show the restitution that was fitted to a trace."""
    return View(lambda: _trace_data(found, structure), [*_trace_parts(found, structure)])


def trace_columns(found: TraceFit) -> dict[str, list[float]]:
    """Return the trace and both fits as columns by name."""
    columns = {
        "time [s]": found.trace.times, "angle [rad]": found.trace.angles, "fitted [rad]": found.fitted,
        "fitted, eta of each impact [rad]": found.own,
    }  # fmt: skip
    return {name: values.tolist() for name, values in columns.items()}


def _trace_parts(found: TraceFit, structure: Structure) -> Iterator[Table | str]:
    trace, count = found.trace, len(found.etas)
    yield (
        f"{Path(trace.name).name}: {trace.times.size} samples over {trace.times[-1] - trace.times[0]:.4g} s, fitted "
        f"from {found.part[0]:.4g} s, where the structure falls, to {found.part[1]:.4g} s. "
        f"{heading(structure.mechanism)}, let go at {degrees(found.release):.4g} deg at {found.release_time:.4g} s. "
        f"{count} impacts are seen above the noise of {degrees(found.noise):.2g} deg."
    )
    slenderness = structure.model("nonlinear").scatter.slenderness
    geometry = f"{percent(slenderness)} of slenderness (`uncertainty`)" if found.p is None else "that of p and alpha"
    yield (
        f"Restitution eta = {found.eta.value:.4f}, the weighted mean of the impacts. Its standard deviation is "
        f"{found.eta.deviation:.2g}: that of noise, of the scatter over some {count} impacts, and of {geometry}."
    )
    pooled = found.pooled
    low, high = pooled.interval
    yield (
        f"From impact to impact eta scatters by {pooled.seen:.2g}, the last one left out; 5 to 95 %: {low:.2g} to "
        f"{high:.2g}. Neighbours should draw {pooled.scatter:.2g}, which is drawn towards {MEASURED_SPREAD:g}, the "
        "scatter of bodies whose restitution was measured: few impacts do not show that there is none."
    )
    if found.sides is not None:
        yield (
            "The two sides differ: by the trace, the slenderness towards positive angles over that towards negative "
            f"ones is {found.sides.value:.3f} +- {found.sides.deviation:.1g} times the ratio of the file. Eta is "
            "fitted with this; otherwise it would seem to scatter."
        )
    if found.p is not None and found.alpha is not None:
        block = structure.equivalence.positive
        yield (
            f"Fitted geometry: p = {found.p.value:.4g} rad/s +- {found.p.deviation:.2g} (the file: {block.p:.4g}), "
            f"alpha = {found.alpha.value:.4g} rad +- {found.alpha.deviation:.2g} (the file: {block.phi_cr:.4g})."
        )
    yield table_of(
        "", IMPACTS, [ImpactRow(k, *pair) for k, pair in enumerate(zip(found.impacts, found.etas, strict=True), 1)]
    )
    yield (f"At rest, the trace reads {_pair(found.offset)} deg at time zero and drifts by {_pair(found.drift)} deg/s.")
    yield _residuals(found)


def _pair(found: Estimated) -> str:
    """Return an angle and its deviation in degrees."""
    return f"{degrees(found.value):.3g} +- {degrees(found.deviation):.1g}"


def _residuals(found: TraceFit) -> str:
    """Return a sentence on how far the fits are from the trace."""
    one, each = found.residual / found.noise, found.own_residual / found.noise
    if found.patterned:
        return (
            f"Caution: the residual leaves a pattern: it is {degrees(found.residual):.2g} deg, {one:.2g} times the "
            f"noise, and {each:.2g} times with a restitution for each impact. So much do an error of 3 % of p, a drift "
            "that is not steady, sliding or bouncing leave. The deviations include it as if it were noise; check the "
            "size of the structure."
        )
    sentence = f"The residual is {degrees(found.residual):.2g} deg, {one:.2g} times the noise"
    if one <= MAX_RESIDUAL_TO_NOISE:
        return f"{sentence}: free rocking with one restitution explains the trace."
    return f"{sentence}, and {each:.2g} times with a restitution for each impact: it differs from impact to impact."


def _trace_data(found: TraceFit, structure: Structure) -> dict[str, Any]:
    block = None
    if found.p is not None and found.alpha is not None:
        block = {"p": found.p._asdict(), "alpha": found.alpha._asdict()}
    return {
        "structure": structure.name,
        "restitution": {
            **found.eta._asdict(),
            "scatter": found.scatter,
            "scatter_seen": found.pooled.seen,
            "scatter_interval": list(found.pooled.interval),
        },
        "impacts": len(found.etas),
        "etas": [each.value for each in found.etas],
        "eta_deviations": [each.deviation for each in found.etas],
        "impact_times": found.impacts.tolist(),
        "part": list(found.part),
        "drift": found.drift.value,
        "drift_deviation": found.drift.deviation,
        "offset": found.offset.value,
        "offset_deviation": found.offset.deviation,
        "release": found.release,
        "release_time": found.release_time,
        "noise": found.noise,
        "residual": found.residual,
        "own_residual": found.own_residual,
        "patterned": found.patterned,
        "sides": None if found.sides is None else found.sides._asdict(),
        "geometry": block,
    }


def region_view(found: JointRegion, name: str, file: str, count: int) -> View:
    """Show the joint region of slenderness and restitution; `count` is the number of tests in the table."""
    return View(lambda: _region_data(found, name), [*_region_parts(found, name, file, count)])


def region_columns(found: JointRegion) -> dict[str, list[Any]]:
    """Return the points of the grid as columns by name."""
    points = [(i, k) for i in range(found.slenderness.size) for k in range(found.restitution.size)]
    return {
        "slenderness": [float(found.slenderness[i]) for i, _ in points],
        "restitution": [float(found.restitution[k]) for _, k in points],
        "log_likelihood": [float(found.likelihood[i, k]) for i, k in points],
        "inside": [bool(found.inside[i, k]) for i, k in points],
    }


def _region_parts(found: JointRegion, name: str, file: str, count: int) -> Iterator[Table | str]:
    yield (
        f"{file}: {found.tests} of {count} tests are of {name} and have an outcome, in {found.clusters} clusters. Grid "
        f"of {found.slenderness.size} x {found.restitution.size} points, {found.around.count} neighbours of each test "
        "at each."
    )
    slender, eta = found.best
    (low, high), (least, most) = found.ranges
    points = int(found.inside.sum())
    yield (
        f"Likeliest: slenderness times {slender:.3g}, restitution {eta:.3g}. Joint region of "
        f"{percent(REGION_PROBABILITY)}, "
        f"{points} of {found.inside.size} points: slenderness times {low:.3g} to {high:.3g}, restitution {least:.3g} "
        f"to {most:.3g}. Not every pair of values from these ranges is in it."
    )
    inside = found.inside
    if inside[[0, -1]].any() or inside[:, [0, -1]].any():
        yield "Caution: the region reaches the edge of the grid, and is wider than the grid shows."
    above = found.likelihood - found.likelihood.max()
    cells = [
        [f"{value:.1f}{'*' * bool(within)}" for value, within in zip(*row, strict=True)]
        for row in zip(above.T, inside.T, strict=True)
    ]
    grid = [
        only_shown("slenderness", lambda i: f"x {found.slenderness[i]:.3g}", text=True),
        *(only_shown(f"{eta:.3g}", column.__getitem__) for eta, column in zip(found.restitution, cells, strict=True)),
    ]
    title = "Log-likelihood less the largest, over restitution; * in the region"
    yield table_of(title, grid, range(found.slenderness.size))
    if found.unknown:
        yield (
            f"Caution: at the likeliest point, the outcome of {percent(found.unknown)} of the neighbours is unknown, "
            "and counted as not overturning."
        )


def _region_data(found: JointRegion, name: str) -> dict[str, Any]:
    slenderness, restitution = found.best
    ranges = dict(zip(("slenderness", "restitution"), map(list, found.ranges), strict=True))
    return {
        "structure": name,
        "tests": found.tests,
        "clusters": found.clusters,
        "neighbours": found.around.count,
        "best": {"slenderness": slenderness, "restitution": restitution},
        "region": {"probability": REGION_PROBABILITY, **ranges},
        "grid": {
            "slenderness": found.slenderness.tolist(),
            "restitution": found.restitution.tolist(),
            "log_likelihood": found.likelihood.tolist(),
            "inside": found.inside.tolist(),
        },
        "unknown": found.unknown,
    }
