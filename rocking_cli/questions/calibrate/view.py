"""A calibrated restitution as text, as data and as a plot."""

from __future__ import annotations

from collections.abc import Iterator
from math import degrees
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from rocking_cli.arrays import Reals
from rocking_cli.dynamics.model import MEASURED_SPREAD
from rocking_cli.names import percent
from rocking_cli.questions.calibrate.study import MAX_RESIDUAL_TO_NOISE, MIN_GAP_RATIO, Estimated, TraceFit
from rocking_cli.structure import Structure
from rocking_cli.views.column import Column, of, only_shown, rounded, table_of
from rocking_cli.views.view import Aside, Table, View, heading

if TYPE_CHECKING:
    from matplotlib.figure import Figure


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
    slenderness = structure.model("nonlinear").scatter.slenderness
    geometry = f"{percent(slenderness)} of slenderness (`uncertainty`)" if found.p is None else "that of p and alpha"
    pooled = found.pooled
    low, high = pooled.interval
    yield (
        f"Restitution eta = {found.eta.value:.4f}, the weighted mean of the impacts. Its standard deviation is "
        f"{found.eta.deviation:.2g}; neighbours should draw {pooled.scatter:.2g}."
    )
    yield (
        f"{Path(trace.name).name}: {trace.times.size} samples over {trace.times[-1] - trace.times[0]:.4g} s, fitted "
        f"from {found.part[0]:.4g} s, where the structure falls, to {found.part[1]:.4g} s. "
        f"{heading(structure.mechanism)}, let go at {degrees(found.release):.4g} deg at {found.release_time:.4g} s. "
        f"{count} impacts are seen above the noise of {degrees(found.noise):.2g} deg."
    )
    yield Aside(f"The deviation is that of noise, of the scatter over some {count} impacts, and of {geometry}.")
    yield Aside(
        f"From impact to impact eta scatters by {pooled.seen:.2g}, the last one left out; 5 to 95 %: {low:.2g} to "
        f"{high:.2g}. What neighbours should draw is drawn towards {MEASURED_SPREAD:g}, the scatter of bodies whose "
        "restitution was measured: few impacts do not show that there is none."
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
    pairs = zip(found.impacts, found.etas, strict=True)
    yield table_of("", IMPACTS, [ImpactRow(k, *pair) for k, pair in enumerate(pairs, 1)])
    rest = f"{_pair(found.offset)} deg at time zero and drifts by {_pair(found.drift)} deg/s"
    yield Aside(f"At rest, the trace reads {rest}.")
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
        **{name: getattr(found, name) for name in ("release", "release_time", "noise", "residual", "own_residual")},
        "patterned": found.patterned,
        "sides": None if found.sides is None else found.sides._asdict(),
        "geometry": block,
    }


def draw_trace(found: TraceFit, name: str) -> Figure:
    """Draw a trace of free rocking, its fit and impacts, and below the residuals of both fits.

    Parameters
    ----------
    found : TraceFit
        The fit.
    name : str
        Name of the structure.
    """
    from rocking_cli.plotting import style

    figure, ((axes,), (below,)) = style.panels(5.6, 2, sharex=True, height_ratios=(2.2, 1))
    style.heading(axes, f"{name}: free rocking, eta = {found.eta.value:.4f}, scatter {found.scatter:.2g}")
    times = found.trace.times
    start, end = found.part
    # Lifting and holding may take much longer than rocking.
    axes.set_xlim(start - 0.15 * (end - start), end + 0.02 * (end - start))
    dots = {"color": style.RECORD_COLOUR, "marker": ".", "markersize": 3, "linestyle": "none"}
    axes.plot(times, np.degrees(found.trace.angles), label="trace", **dots)
    fitted = _broken(times, np.degrees(found.fitted))
    axes.plot(*fitted, color=style.INK, linewidth=style.MEDIUM, label="fit with one eta")
    rest = np.degrees(found.offset.value + found.drift.value * times)
    axes.plot(times, rest, color=style.FAINT, linewidth=style.THIN, linestyle="--", label="at rest")
    at_impact = np.degrees(found.offset.value + found.drift.value * found.impacts)
    axes.plot(found.impacts, at_impact, label="impacts", linestyle="none", **{**style.MARKED, "markersize": 5})
    for values, look, label in (
        (found.fitted, {"color": style.INK, "linewidth": style.THIN}, "one eta"),
        (found.own, {"color": style.EXCEEDED, "linewidth": style.THIN, "linestyle": "--"}, "an eta for each impact"),
    ):
        below.plot(*_broken(times, np.degrees(found.trace.angles - values)), label=label, **look)
    noise = np.degrees(found.noise)
    below.axhspan(-2 * noise, 2 * noise, color=style.SHADE, zorder=0, label="twice the noise")
    style.tidy(axes, y="angle [deg]")
    style.tidy(below, "time [s]", "residual [deg]")
    style.legends_below(figure, [(each, each.get_legend_handles_labels()[0]) for each in (axes, below)], ncols=4)
    return figure


def _broken(times: Reals, values: Reals) -> tuple[Reals, Reals]:
    """Return a curve with breaks where the trace has gaps."""
    steps = np.diff(times)
    gaps = np.flatnonzero(steps > MIN_GAP_RATIO * np.median(steps)) + 1
    return np.insert(times, gaps, np.nan), np.insert(values, gaps, np.nan)
