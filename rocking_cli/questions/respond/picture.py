"""Plot of the response of a structure: the ground motion above, the rotations below."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from math import inf, isfinite, isnan
from textwrap import shorten
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from rocking_cli import names
from rocking_cli.arrays import Reals
from rocking_cli.core import Direction
from rocking_cli.dynamics.history import MIN_IMPACT_RATE, History
from rocking_cli.dynamics.model import ModelName
from rocking_cli.dynamics.verdict import known_until, peak_time
from rocking_cli.excitation.base import STANDARD_GRAVITY, GroundMotion
from rocking_cli.excitation.pulse_fit import PulseFit
from rocking_cli.plotting import style
from rocking_cli.structure import Structure
from rocking_cli.studies.contact import ContactDemand
from rocking_cli.studies.film import SECONDS_AFTER, SECONDS_BEFORE
from rocking_cli.studies.movements import Watched
from rocking_cli.studies.response import best_model

MAX_SHOWN_RATIO = 1.6  # largest phi/phi_cr that is shown
CUT_RATIO = 1.15  # phi/phi_cr at which a curve that overturns is cut off
ROOM = 0.22  # height of the panel above and below the curves, over that of the curves
UNKNOWN_SHARE = 0.25  # share of the time axis that is kept for what is unknown
PULSE_POINTS = 1000
MAX_SHOWN_FRICTION = 2.0  # cut of the axis, as a joint with almost no normal force may require any friction
FORCE_SUFFIX = " force [N]"  # ending of the headings of forces
MAX_TIES, MAX_TIE_NAME = 6, 30  # ties in a panel, and characters of a name
LANES = 1.4  # room below the curves, where impacts are marked, over that above
LANE = 0.03  # share of the panel's height at which impacts are marked
SIDES = {Direction.POSITIVE: "clockwise", Direction.NEGATIVE: "anticlockwise"}

Runs = Mapping[ModelName, History]


def draw_history(
    histories: Runs,
    motion: GroundMotion | None,
    title: str,
    reversed_histories: Runs | None = None,
    pulse: tuple[PulseFit, Runs] | None = None,
    structure: Structure | None = None,
    contacts: Sequence[ContactDemand] = (),
    parted: Sequence[float] = (),
) -> Figure:
    """Plot histories against time, as long as something moves.

    After the time until which the outcome is known, panels are hatched and no curve is drawn, as no model is valid.

    Parameters
    ----------
    histories : mapping of str to History
        One curve each: signed rotation over the critical rotation of its direction; the first uplift, the peak and the
        outcome of the nonlinear model, or else of the first, are marked on its curve; the legend has the numbers.
    motion : GroundMotion, optional
        The ground motion, plotted above in g.
    title : str
        Heading.
    reversed_histories : mapping of str to History, optional
        The responses to the reversed motion, drawn in a panel of their own.
    pulse : PulseFit and mapping of str to History, optional
        The pulse in the motion, drawn bold over it, and the responses to it alone, in a panel of their own.
    structure : Structure, optional
        The structure: with it, uplift accelerations are drawn over the motion, displacements are named, forces of ties
        are plotted below each response, and the side walls of one-sided structures are marked.
    contacts : sequence of ContactDemand
        Contact checks of the nonlinear history under the motion, and under the reversed one: the friction required is
        plotted in a panel below.
    parted : sequence of float
        Time at which the motions by both engines part, under the motion and under the reversed one [s]; NaN if never.

    Returns
    -------
    matplotlib.figure.Figure
    """
    histories = _valid(histories)
    reversed_histories = _valid(reversed_histories) if reversed_histories is not None else None
    slides = [run for each in (histories, reversed_histories or {}) for run in each.values() if run.slid is not None]
    responses = {"": histories}
    if reversed_histories is not None:
        responses = {"polarity 1": histories, "polarity -1": reversed_histories}
    if pulse is not None:
        responses = {"record": histories, "its pulse alone": pulse[1]}
    watched = Watched(structure.mechanism) if structure is not None else None
    tied = watched is not None and bool(watched.ties) and any(not run.by_blocks for run in histories.values())
    each_has = [1.8, 1.0] if tied else [1.8]
    shaken, rubs = motion is not None, bool(contacts or slides)
    height = 1.5 * shaken + (3.2 + 1.8 * tied) * len(responses) + 1.7 * rubs
    ratios = [1.0] * shaken + each_has * len(responses) + [0.9] * rubs
    figure, every = style.panels(height, len(ratios), sharex=True, height_ratios=ratios)
    panels = list(every[:, 0])
    style.heading(panels[0], title)
    until = {what: known_until(each) for what, each in responses.items()}
    start, end = _draw_time(panels[-1], responses, until, motion, pulse[0] if pulse is not None else None)
    keys: list[tuple[Axes, list[Line2D]]] = []
    if motion is not None:
        keys.append((panels[0], _draw_motion(panels[0], motion, end, pulse[0] if pulse is not None else None)))
        if structure is not None:
            keys[0][1].extend(_draw_uplift(panels[0], structure, motion))
    scale = _scale_of(responses, until)
    below = panels[shaken : shaken + len(each_has) * len(responses)]
    for axes, (what, each) in zip(below[:: len(each_has)], responses.items(), strict=True):
        if what:
            axes.set_title(what, loc="left", fontsize=style.LABEL, color=style.INK)
        _hatch_unknown(axes, until[what], (start, end))
        keys.append((axes, _draw_responses(axes, each, scale, until[what], watched)))
    for (axes, curves), time in zip(keys[shaken:], parted, strict=False):
        if start < time < end:
            label, dots = f"both engines part at {time:.4g} s", (0, (1, 1.5))
            curves.append(axes.axvline(time, label=label, color=style.CURSOR, linewidth=style.MEDIUM, linestyle=dots))
    if watched is not None and tied:
        for axes, (what, each) in zip(below[1::2], responses.items(), strict=True):
            _hatch_unknown(axes, until[what], (start, end))
            keys.append((axes, _draw_forces(axes, each, watched)))
    if rubs:
        keys.append((panels[-1], _draw_slips(panels[-1], slides) if slides else _draw_contacts(panels[-1], contacts)))
        _hatch_unknown(panels[-1], max(list(until.values())[: len(contacts)]), (start, end))
    figure.align_ylabels(panels)  # not those of others in a figure of the user
    style.legends_below(figure, keys)
    return figure


def _valid(histories: Runs) -> Runs:
    """Return the histories of a structure that slides without those of its blocks, which rock; or all of them."""
    slides = any(run.slid is not None for run in histories.values())
    return {name: run for name, run in histories.items() if not slides or run.slid is not None or run.by_blocks}


def _draw_slips(axes: Axes, slides: Sequence[History]) -> list[Line2D]:
    """Draw the slip of one history, or of those of both polarities; return the curves."""
    curves = []
    for k, run in enumerate(slides):
        assert run.slid is not None
        label = f"slip, polarity {1 - 2 * k}" if len(slides) > 1 else "slip of the foot"
        look = {**style.family(k), "linewidth": style.MEDIUM, "label": label}
        curves += axes.plot(run.time, run.slid.displacement, **look)
    style.tidy(axes, y="slip [m],\nto the right")
    return curves


def _last(run: History) -> float:
    """Return the time of the last sample with a rotation [s]."""
    return float(run.time[np.isfinite(run.ratio)][-1])


def _leaves(run: History) -> bool:
    """Return whether a history overturns within its samples."""
    return bool(run.fell and run.overturning_time <= _last(run))


def _shown(run: History, until: float) -> int:
    """Return the number of samples to draw: up to the time until which all is known, and to overturning."""
    known = np.isfinite(run.ratio) & (run.time <= until)
    if _leaves(run):
        known &= np.arange(run.ratio.size) <= np.flatnonzero(np.abs(run.ratio) <= CUT_RATIO)[-1] + 1
    return int(known.sum())


def _draw_time(
    axes: Axes,
    responses: Mapping[str, Runs],
    until: Mapping[str, float],
    motion: GroundMotion | None,
    pulse: PulseFit | None,
) -> tuple[float, float]:
    """Let the time axis begin shortly before the first uplift and end when nothing moves; say what is left out.

    It begins and ends at a tick. `until` has the time until which the histories of each response are valid [s],
    infinite if their outcome is known. Returns its ends [s].
    """
    runs = [(run, until[what]) for what, histories in responses.items() for run in histories.values()]
    moving = [(run, known) for run, known in runs if run.lifted] or runs
    starts = [0.0 if run.ratio[0] or isnan(run.uplift_time) else run.uplift_time - SECONDS_BEFORE for run, _ in moving]
    starts += [] if pulse is None else [pulse.start]
    first = max(0.0, min(starts))
    last = max(_end(run, known, first) for run, known in moving)
    start, end = style.time_axis(axes, first, last)
    ends = [run.overturning_time if run.fell else run.end_time for run, known in moving if not isfinite(known)]
    latest = max([*ends, motion.duration if motion is not None else 0.0])  # what is not shown ends
    left_out = [f"0 to {start:g} s, at rest"] if start > 0 else []
    if latest > end:
        why = " or ".join(dict.fromkeys(_state(run, known, end) for run, known in moving))
        left_out.append(f"{end:g} to {latest:.4g} s, {why}")
    label = f"time [s]; not shown: {'; '.join(left_out)}" if left_out else "time [s]"
    label = label.replace(", at rest; ", " and ") if label.endswith(", at rest") else label
    style.tidy(axes, label)
    return start, end


def _end(run: History, known: float, first: float) -> float:
    """Return the time at which a history may leave the picture [s]: at rest, overturned, unknown or not sampled."""
    last = _last(run)
    if isfinite(known):
        return known + max(SECONDS_AFTER, UNKNOWN_SHARE * (known - first))
    if _leaves(run):
        return float(run.time[_shown(run, known) - 1])
    return min(last, run.end_time + SECONDS_AFTER) if run.lifted and run.at_rest else last


def _state(run: History, known: float, end: float) -> str:
    """Return what a history does after the end of the picture [s]."""
    if isfinite(known):
        return names.UNKNOWN
    if _leaves(run):
        return "overturned"
    return "at rest" if run.at_rest and run.end_time <= end else "still moving"


def _draw_motion(axes: Axes, motion: GroundMotion, end: float, pulse: PulseFit | None) -> list[Line2D]:
    """Draw the record up to the end of the plot [s], and the pulse over it; return the curves."""
    motion = motion.kept
    what = "floor, peak" if motion.ground is not None else "PGA"
    parts: list[tuple[GroundMotion, str, dict[str, Any]]] = [
        (motion, what, {"color": style.INK if pulse is None else style.RECORD_COLOUR})
    ]
    if motion.vertical is not None:
        parts.append((motion.vertical, "vertical, PGA", {"color": style.FAINT, "zorder": 1}))
    for each, peak, look in parts:
        values = each.acceleration[: int(min(end, each.duration) / each.dt) + 2] / STANDARD_GRAVITY
        label = style.plain(f"{each.name}, {peak} {each.pga_g:.3g} g")
        style.draw_samples(axes, values, each.dt, linewidth=style.CURVE, label=label, **look)
    if pulse is not None:
        t = pulse.start + np.linspace(0.0, pulse.pulse.duration, PULSE_POINTS)
        label = f"its {pulse.pulse.name} pulse, {pulse.pulse.amplitude / STANDARD_GRAVITY:.3g} g"
        axes.plot(t, pulse.acceleration(t) / STANDARD_GRAVITY, label=label, **style.PULSES[0])
    style.tidy(axes, y="ground [g]")
    return list(axes.lines)


def _draw_uplift(axes: Axes, structure: Structure, motion: GroundMotion) -> list[Line2D]:
    """Mark the ground accelerations of uplift: one to the left uplifts clockwise, which is positive."""
    ways = structure.mechanism.directions
    levels = [-way * structure.uplift[way < 0] for way in ways]
    for level in levels:
        line = axes.axhline(level, color=style.CURSOR, linewidth=style.MEDIUM, linestyle=(0, (1, 1.5)))
    parts = [f"{level:.3g} g ({SIDES[way]})".replace("-", "\u2212") for level, way in zip(levels, ways, strict=True)]
    if len(levels) == 2 and f"{levels[0]:.3g}" == f"{-levels[1]:.3g}":
        parts = [f"\u00b1{levels[1]:.3g} g"]
    without = " without the vertical motion" if motion.vertical is not None else ""
    line.set_label(f"uplift at {' and '.join(parts)}{without}")
    return [line]


def _hatch_unknown(axes: Axes, until: float, shown: tuple[float, float]) -> None:
    """Hatch the panel from the time until which the outcome is known [s] to its end."""
    start, end = shown
    if not isfinite(until):
        return
    axes.axvspan(until, end, zorder=0.5, **style.UNKNOWN)
    room = style.inches(axes).real * (end - until) / (end - start)
    words = style.folded(f"{names.UNKNOWN} after {until:.4g} s", 0.9 * room, style.LABEL)
    axes.annotate(
        words, ((until + end) / 2, 0.55), xycoords=axes.get_xaxis_transform(), ha="center", va="center",
        fontsize=style.LABEL, bbox={"facecolor": style.PAPER, "edgecolor": "none", "pad": 2},
    )  # fmt: skip


class _Scale(NamedTuple):
    """How rotations are drawn: over the critical rotation, or times a factor if there is none, and the axis."""

    factor: float | None
    unit: str
    low: float
    high: float

    def of(self, run: History) -> Reals:
        return run.ratio if self.factor is None else self.factor * run.phi

    def limit(self, run: History, side: Direction) -> float:
        """Return the critical rotation or kinematic limit of a side as drawn; infinite if it never turned that way."""
        turned = np.nonzero(side * run.ratio > 0)[0]
        if self.factor is None:
            return float(side)
        return float((self.of(run)[turned] / np.abs(run.ratio[turned]))[-1]) if turned.size else side * inf


def _scale_of(responses: Mapping[str, Runs], until: Mapping[str, float]) -> _Scale:
    """Return the scale of rotations, the same for all panels, so that the axis fits all that is drawn."""
    every = [(run, until[what]) for what, each in responses.items() for run in each.values()]
    reach = max(float(np.abs(run.phi[: _shown(run, known)]).max()) for run, known in every)
    free = any(any(run.ends_at_limit) for run, _ in every)
    scale = _Scale(*style.angle_unit(reach), 0.0, 0.0) if free else _Scale(None, r" $\phi_{cr}$", 0.0, 0.0)
    low = high = 0.0
    for run, known in every:
        drawn = np.where(np.abs(run.ratio) > MAX_SHOWN_RATIO, np.nan, scale.of(run))[: _shown(run, known)]
        low, high = min(low, float(np.nanmin(drawn))), max(high, float(np.nanmax(drawn)))
    if low == high:
        low, high = -1.0, 1.0
    room = ROOM * (high - low)
    return scale._replace(low=low - LANES * room, high=high + room)


def _draw_responses(axes: Axes, histories: Runs, scale: _Scale, until: float, watched: Watched | None) -> list[Line2D]:
    """Draw the rotations of the models, with marks on the best one; return the curves and the marks."""
    best: ModelName = "blocks" if "blocks" in histories else best_model(histories)
    free = histories[best].ends_at_limit
    axes.axhline(0.0, color=style.FAINT, linewidth=style.THIN)
    axes.set_ylim(scale.low, scale.high)
    if watched is not None and not watched.mechanism.rocks_both_ways:
        _draw_wall(axes, watched.mechanism.directions[0], scale)
    moves = any(run.lifted for run in histories.values()) and not histories[best].slip
    known = known_until({name: run for name, run in histories.items() if name != "blocks"})  # of the equivalent blocks
    ends = {name: until if run.by_blocks or run.unknown else min(until, known) for name, run in histories.items()}
    curves = [_draw_run(axes, run, scale, ends[name], told=name != best and moves) for name, run in histories.items()]
    moved = watched if best != "blocks" else None  # free blocks do not move as the mechanism does
    points, limits = list(_points(axes, histories[best], scale, until, moved)), list[Line2D]()
    for k, side in enumerate(Direction):
        level = scale.limit(histories[best], side)
        if scale.low < level < scale.high:
            line = axes.axhline(level, color=style.INK, linewidth=style.CURVE, linestyle=":")
            line.set_label("kinematic limit" if free[k] else "critical rotation")
            limits.append(line)
    if not moves:
        axes.text(0.5, 0.6, histories[best].words, transform=axes.transAxes, ha="center", fontsize=style.LABEL)
    over = style.over(free, math=True) if scale.factor is None else f"[{scale.unit.strip()}]"
    style.tidy(axes, y=f"rotation {over}, clockwise up")
    curves += _draw_impacts(axes, histories[best], until, len(histories))
    return [*curves, *points, *limits[:1]]


def _draw_run(axes: Axes, run: History, scale: _Scale, until: float, *, told: bool) -> Line2D:
    """Draw a history; its label has its outcome in words, if `told` and if no mark can state it."""
    values = scale.of(run)[: _shown(run, until)]
    shown = style.visible(values)
    label = style.LABELS[run.model]
    if run.unknown and not isfinite(until):
        label += f", known until {run.known_to:.4g} s"
    elif not isfinite(until) and (told or (run.fell and not _leaves(run))):
        label += f": {_fate(run, scale)}"
    (curve,) = axes.plot(run.time[shown], values[shown], label=label, **style.LINES[run.model])  # type: ignore[arg-type]
    return curve


def _peak(run: History) -> int:
    """Return the index of the sample at the peak; of equal peaks the first, whatever rounding does."""
    size, k = np.abs(run.ratio), int(np.searchsorted(run.time, peak_time(run)))
    return k + int((np.diff(size[k:], append=-inf) <= 0).argmax())


def _fate(run: History, scale: _Scale) -> str:
    """Return the outcome of a history that is known to its end, with its peak or its time."""
    if run.fell:
        does = "collapse" if run.by_blocks else names.OVERTURNS
        return f"{does} at {run.overturning_time:.4g} s{'' if _leaves(run) else ', after the last sample'}"
    if not run.lifted:
        return run.words
    peak = run.peak_ratio if scale.factor is None else scale.factor * run.furthest
    # A motion may start and end between two samples.
    at = float(run.time[_peak(run)]) if run.ratio.any() else run.uplift_time
    return f"peak {peak:.3g}{scale.unit} at {at:.4g} s"


def _points(axes: Axes, run: History, scale: _Scale, until: float, watched: Watched | None) -> Iterator[Line2D]:
    """Mark the first uplift and the peak or the outcome of a history, with labels."""

    def mark(time: float, value: float, words: str, shape: str) -> Line2D:
        look = {"marker": shape, "markersize": 4.5, "linestyle": "none", "color": style.INK, "zorder": 6}
        whose = f"{style.LABELS[run.model]}: " * run.by_blocks
        return axes.plot([time], [value], label=whose + words, **look)[0]  # type: ignore[arg-type]

    if run.uplift_time <= until:
        yield mark(run.uplift_time, 0.0, f"uplift at {run.uplift_time:.4g} s", "^")
    if isfinite(until) or not run.lifted:
        return
    if run.fell:
        if _leaves(run):
            end = scale.limit(run, Direction(run.fell_to))
            time, words = run.overturning_time, _fate(run, scale)
            if run.by_blocks:  # a collapse is no rotation: its mark is at the end of the curve
                k = _shown(run, until) - 1
                words += ", outside the panel" if run.time[k] < time else ""
                time, end = float(run.time[k]), float(scale.of(run)[k])
            yield mark(time, end, words, "x")
        return
    words = _fate(run, scale)
    if watched is not None:
        point = next(each for each in watched.peaks(run).points if each.name == watched.control)
        moved, unit = (point.horizontal, "m") if point.horizontal > 1 else (1000 * point.horizontal, "mm")
        words += "" if isnan(moved) else f", {point.name} {moved:.3g} {unit}"
    k = _peak(run)
    yield mark(float(run.time[k]), float(scale.of(run)[k]), words, "o")
    if not run.at_rest:
        yield mark(_last(run), float(scale.of(run)[np.isfinite(run.ratio)][-1]), names.STILL_ROCKING, ">")


def _draw_impacts(axes: Axes, run: History, until: float, models: int) -> list[Line2D]:
    """Mark the impacts of a history at the lower edge; return the marks, with a label that says which impacts."""
    felt = run.felt[run.felt[:, 0] <= until, 0]
    if not felt.size:
        return []
    whose = f", {run.model}" if models > 1 else ""
    strong = f", {100 * MIN_IMPACT_RATE:g} % of the strongest or more" if felt.size < run.impact_count else ""
    look = {"marker": "|", "markersize": 5, "markeredgewidth": 0.8, "linestyle": "none", "color": style.INK}
    heights = np.full(felt.size, LANE)
    return axes.plot(felt, heights, transform=axes.get_xaxis_transform(), label=f"impacts{whose}{strong}", **look)  # type: ignore[arg-type]


def _draw_contacts(axes: Axes, contacts: Sequence[ContactDemand]) -> list[Line2D]:
    """Draw the friction required at the joints, and the friction available; return the curves."""
    there = contacts[0].friction
    highest = [float(contact.demand.max(initial=0.0)) for contact in contacts]
    top = min(max(*highest, there or 0.0, 1e-3), MAX_SHOWN_FRICTION)
    for k, contact in enumerate(contacts):
        shown = style.visible(contact.demand)
        label = f"required, polarity {1 - 2 * k}" if len(contacts) > 1 else "required"
        label += f", up to {highest[k]:.3g}" if highest[k] > top else ""
        axes.plot(contact.times[shown], contact.demand[shown], label=label, **style.family(k), linewidth=style.MEDIUM)
    if there is not None:
        axes.axhline(there, color=style.CURSOR, linewidth=style.MEDIUM, linestyle=":", label=f"available: {there:.3g}")
    axes.set_ylim(0.0, 1.15 * top)
    style.tidy(axes, y="friction")
    return list(axes.lines)


def _draw_wall(axes: Axes, free: Direction, scale: _Scale) -> None:
    """Hatch the side of a side wall, down to the edge of the panel."""
    edge = scale.low if free > 0 else scale.high
    axes.axhspan(min(0.0, edge), max(0.0, edge), facecolor="none", edgecolor=style.EARTH, hatch="////", linewidth=0)
    axes.axhline(0.0, color=style.EARTH, linewidth=style.BOLD)
    axes.annotate(
        "supports", (0.99, edge / 2), xycoords=axes.get_yaxis_transform(), ha="right", va="center",
        fontsize=style.SMALL, color=style.INK, bbox={"facecolor": style.PAPER, "edgecolor": "none", "pad": 1},
    )  # fmt: skip


def _draw_forces(axes: Axes, histories: Runs, watched: Watched) -> list[Line2D]:
    """Draw the forces of the ties against time in one history, the nonlinear one if there is one; return the curves."""
    model: ModelName = "nonlinear" if "nonlinear" in histories else next(iter(histories))
    run = histories[model]
    forces = {
        name.removesuffix(FORCE_SUFFIX): values / 1000
        for name, values in watched.columns(run.phi, run.slid.displacement if run.slid is not None else 0.0)
        if FORCE_SUFFIX in name
    }
    strongest = sorted(forces, key=lambda name: -float(np.nanmax(np.abs(forces[name]))))[:MAX_TIES]
    of = f", {model} model" if len(histories) > 1 else ""
    curves = []
    for k, name in enumerate(each for each in forces if each in strongest):
        known = forces[name][np.isfinite(forces[name])]
        shown = style.visible(known)
        look = {key: value for key, value in style.distinct(k).items() if "marker" not in key}
        label = style.plain(shorten(name, MAX_TIE_NAME, placeholder=" ...")) + of
        curves += axes.plot(run.time[shown], known[shown], label=label, **look)
    if len(forces) > MAX_TIES:
        curves += axes.plot([], [], linestyle="none", label=f"the {MAX_TIES} strongest of {len(forces)} ties")
    axes.axhline(0.0, color=style.FAINT, linewidth=style.THIN)
    style.tidy(axes, y="tie force [kN],\ntension up")
    return curves
