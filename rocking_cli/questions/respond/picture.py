"""Plot of the response of a structure: the record above, the rotations below."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import inf, isfinite
from textwrap import shorten

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rocking_cli import names
from rocking_cli.core import Direction
from rocking_cli.dynamics.history import MIN_IMPACT_RATE, History
from rocking_cli.dynamics.model import ModelName
from rocking_cli.dynamics.verdict import known_until
from rocking_cli.excitation.base import STANDARD_GRAVITY, GroundMotion
from rocking_cli.excitation.pulse_fit import PulseFit
from rocking_cli.plotting import style
from rocking_cli.studies.contact import ContactDemand
from rocking_cli.studies.movements import Watched

MAX_SHOWN_RATIO = 1.6  # largest phi/phi_cr that is shown
CUT_RATIO = 1.5  # phi/phi_cr at which a curve that overturns is cut off, with a cross
MIN_TIME_AXIS = 0.1  # s; least length of the time axis
PULSE_POINTS = 1000
MAX_SHOWN_FRICTION = 2.0  # cut of the axis, as a joint with almost no normal force may require any friction
IMPACTS_LABEL = f"impacts of {100 * MIN_IMPACT_RATE:g} % of the strongest or more, in the order of the legend"
FORCE_SUFFIX = " force [N]"  # ending of the headings of forces
MAX_TIES, MAX_TIE_NAME = 6, 30  # ties in a panel, and characters of a name
MAX_LABELLED_SHARE = 0.7  # share of the time axis beyond which there is no room for a label on the right
LANE_HEIGHT = 0.025  # share of the panel's height for the impacts of each model


def draw_history(
    histories: Mapping[ModelName, History],
    motion: GroundMotion | None,
    title: str,
    reversed_histories: Mapping[ModelName, History] | None = None,
    pulse: tuple[PulseFit, Mapping[ModelName, History]] | None = None,
    uplift: tuple[float, float] | None = None,
    contacts: Sequence[ContactDemand] = (),
    watched: Watched | None = None,
) -> Figure:
    """Plot histories against time.

    After the time until which the outcome is known, panels are hatched and no curve is drawn, as no model is valid.

    Parameters
    ----------
    histories : mapping of str to History
        One curve each: signed rotation over the critical rotation of its direction, impacts marked.
    motion : GroundMotion, optional
        The ground motion, plotted above in g.
    title : str
        Heading.
    reversed_histories : mapping of str to History, optional
        The responses to the reversed motion, drawn in a panel of their own.
    pulse : PulseFit and mapping of str to History, optional
        The pulse in the motion, drawn bold over it, and the responses to it alone, in a panel of their own.
    uplift : (float, float), optional
        The ground accelerations that uplift the structure in the positive and in the negative direction [standard
        gravity], drawn over the motion if the structure does not uplift.
    contacts : sequence of ContactDemand
        Contact checks of the nonlinear history under the motion, and under the reversed one: the friction required is
        plotted in a panel below.
    watched : Watched, optional
        Points and ties: with it, the forces of ties are plotted below each response, and the side walls of one-sided
        structures are marked.

    Returns
    -------
    matplotlib.figure.Figure
    """
    responses = {"": histories}
    if reversed_histories is not None:
        responses = {"polarity 1": histories, "polarity -1": reversed_histories}
    if pulse is not None:
        responses = {"record": histories, "its pulse alone": pulse[1]}
    shaken, rubs = motion is not None, bool(contacts)
    tied = watched is not None and bool(watched.ties)
    each_has = [1.8, 1.0] if tied else [1.8]
    height = 1.4 * shaken + (3.4 + 1.9 * tied) * len(responses) + 1.7 * rubs
    ratios = [1.0] * shaken + each_has * len(responses) + [0.9] * rubs
    figure, every = style.panels(height, len(ratios), sharex=True, height_ratios=ratios)
    panels = list(every[:, 0])
    style.heading(panels[0], title)
    runs = [run for each in responses.values() for run in each.values()]
    end = max(MIN_TIME_AXIS, *(1.1 * run.end_time if run.fell else float(run.time[-1]) for run in runs))
    if motion is not None:
        _draw_motion(panels[0], motion, end, pulse[0] if pulse is not None else None)
        if uplift is not None and motion.vertical is None and not any(run.lifted for run in runs):
            _draw_uplift(panels[0], uplift)
    until = {what: known_until(each) for what, each in responses.items()}
    reach = max(
        float(np.nanmax(np.abs(run.ratio[run.time <= until[what]])))
        for what, each in responses.items()
        for run in each.values()
    )
    tall = min(max(1.1 * reach, 1e-3), MAX_SHOWN_RATIO)
    below = panels[shaken : shaken + len(each_has) * len(responses)]
    for axes, (what, each) in zip(below[:: len(each_has)], responses.items(), strict=True):
        _draw_responses(axes, each, what, tall, until[what])
        _hatch_unknown(axes, until[what], end)
        if watched is not None and not watched.mechanism.rocks_both_ways:
            _draw_wall(axes, watched.mechanism.directions[0], tall)
    if watched is not None and tied:
        for axes, (what, each) in zip(below[1::2], responses.items(), strict=True):
            _draw_forces(axes, each, watched)
            _hatch_unknown(axes, until[what], end)
    if rubs:
        _draw_contacts(panels[-1], contacts)
        _hatch_unknown(panels[-1], max(list(until.values())[: len(contacts)]), end)
    panels[-1].set_xlim(0.0, end)
    panels[-1].set_xlabel("time [s]", fontsize=style.LABEL)
    figure.align_ylabels(panels)  # not those of others in a figure of the user
    return figure


def _draw_uplift(axes: Axes, uplift: tuple[float, float]) -> None:
    """Mark the ground accelerations of uplift: ground motion to the left uplifts to the right (positive)."""
    positive, negative = uplift
    for level in (-positive, negative):
        axes.axhline(level, color=style.FAINT, linewidth=style.CURVE, linestyle=":")
    axes.set_ylim(-1.5 * positive, 1.5 * negative)  # room for the notes
    style.note(axes, f"dotted: uplift at {negative:.3g} g and {-positive:.3g} g", height=0.14)


def _hatch_unknown(axes: Axes, until: float, end: float) -> None:
    """Hatch the panel from the time until which the outcome is known [s] to its end."""
    if not isfinite(until):
        return
    axes.axvspan(until, end, zorder=0.5, **style.UNKNOWN)
    place, side = (end, "right") if until > MAX_LABELLED_SHARE * end else ((until + end) / 2, "center")
    axes.annotate(
        f"{names.UNKNOWN} after {until:.4g} s", (place, 0.55), xycoords=axes.get_xaxis_transform(), ha=side,
        va="center", fontsize=style.LABEL, bbox={"facecolor": "white", "edgecolor": "none", "pad": 2},
    )  # fmt: skip


def _draw_motion(axes: Axes, motion: GroundMotion, end: float, pulse: PulseFit | None) -> None:
    """Draw the record up to the end of the plot [s], and the pulse over it."""
    motion = motion.kept
    ground = motion.acceleration[: int(min(end, motion.duration) / motion.dt) + 2] / STANDARD_GRAVITY
    color = style.INK if pulse is None else style.RECORD_COLOUR
    style.draw_samples(axes, ground, motion.dt, color=color, linewidth=style.CURVE)
    if pulse is not None:
        t = pulse.start + np.linspace(0.0, pulse.pulse.duration, PULSE_POINTS)
        axes.plot(t, pulse.acceleration(t) / STANDARD_GRAVITY, **style.PULSES[0])
    what = "floor, peak" if motion.ground is not None else "PGA"
    named = f"{motion.name}, {what} {motion.pga_g:.3g} g"
    if pulse is not None:
        named += f"; bold: its {pulse.pulse.name} pulse, {pulse.pulse.amplitude / STANDARD_GRAVITY:.3g} g"
    if motion.vertical is not None:
        up = motion.vertical
        part = up.acceleration[: int(min(end, up.duration) / up.dt) + 2] / STANDARD_GRAVITY
        style.draw_samples(axes, part, up.dt, color=style.FAINT, linewidth=style.CURVE, zorder=1)
        named += f"; grey: {up.name}, vertical, {up.pga_g:.3g} g"
    style.make_room(axes)
    style.note(axes, named)
    style.tidy(axes, y="ground [g]")


def _draw_responses(
    axes: Axes, histories: Mapping[ModelName, History], what: str, tall: float, until: float = inf
) -> None:
    for lane, (name, run) in enumerate(histories.items()):
        _draw_run(axes, name, run, (len(histories) - lane) * LANE_HEIGHT, until)
    for level in (-1.0, 1.0):
        axes.axhline(level, color=style.FAINT, linewidth=style.CURVE, linestyle=":")
    axes.axhline(0.0, color=style.FAINT, linewidth=style.THIN)
    axes.set_ylim(-1.3 * tall, tall)  # room for the impacts below
    over = style.over(next(iter(histories.values())).ends_at_limit, math=True)
    place = (0.005, (len(histories) + 1.2) * LANE_HEIGHT)
    axes.annotate(
        IMPACTS_LABEL, place, xycoords="axes fraction", fontsize=style.SMALL, color=style.INK,
        bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 1},
    )  # fmt: skip
    if not any(run.lifted for run in histories.values()):
        axes.text(0.5, 0.6, names.NO_UPLIFT, transform=axes.transAxes, ha="center", fontsize=style.LABEL)
    # A curve that ends in positive overturning fills the upper right corner.
    falls_up = any(run.fell_to == Direction.POSITIVE for run in histories.values())
    axes.legend(
        loc="upper left" if falls_up else "upper right",
        title=what,
        title_fontsize=style.TICK,
        alignment="left",
        **style.LEGEND,
    )
    style.tidy(axes, y=f"rotation {over}, clockwise up")


def _draw_contacts(axes: Axes, contacts: Sequence[ContactDemand]) -> None:
    """Draw the friction required at the joints, and the friction available."""
    for k, contact in enumerate(contacts):
        shown = style.visible(contact.demand)
        polarity = f"polarity {1 - 2 * k}" if len(contacts) > 1 else "required"
        look = style.family(k) | {"linewidth": style.MEDIUM}
        axes.plot(contact.times[shown], contact.demand[shown], label=polarity, **look)
    there = contacts[0].friction
    if there is not None:
        axes.axhline(there, color=style.CURSOR, linewidth=style.MEDIUM, linestyle=":", label=f"available: {there:.3g}")
    highest = max(float(contact.demand.max(initial=0.0)) for contact in contacts)
    axes.set_ylim(0.0, 1.15 * min(max(highest, there or 0.0, 1e-3), MAX_SHOWN_FRICTION))
    axes.legend(loc="upper right", ncols=3, **style.LEGEND)
    style.tidy(axes, y="friction required")


def _draw_wall(axes: Axes, free: Direction, tall: float) -> None:
    """Hatch the side of a side wall, and leave little room there."""
    edge = -0.1 * free * tall
    axes.axhspan(min(0.0, edge), max(0.0, edge), facecolor="none", edgecolor=style.EARTH, hatch="////", linewidth=0)
    axes.axhline(0.0, color=style.EARTH, linewidth=style.BOLD)
    side = "right" if free > 0 else "left"  # away from the legend and the note on impacts
    axes.annotate(
        "supports", (0.995 if free > 0 else 0.005, edge), (0, -3 * free), xycoords=axes.get_yaxis_transform(),
        textcoords="offset points", ha=side, va="top" if free > 0 else "bottom", fontsize=style.SMALL, color=style.INK,
    )  # fmt: skip
    axes.set_ylim((-0.4 * tall, tall) if free > 0 else (-1.3 * tall, 0.45 * tall))


def _draw_forces(axes: Axes, histories: Mapping[ModelName, History], watched: Watched) -> None:
    """Draw the forces of the ties against time in one history, the nonlinear one if there is one."""
    model: ModelName = "nonlinear" if "nonlinear" in histories else next(iter(histories))
    run = histories[model]
    forces = {
        name.removesuffix(FORCE_SUFFIX): values / 1000
        for name, values in watched.columns(run.phi)
        if FORCE_SUFFIX in name
    }
    strongest = sorted(forces, key=lambda name: -float(np.nanmax(np.abs(forces[name]))))[:MAX_TIES]
    for k, name in enumerate(each for each in forces if each in strongest):
        known = forces[name][np.isfinite(forces[name])]
        shown = style.visible(known)
        look = {key: value for key, value in style.distinct(k).items() if "marker" not in key}
        axes.plot(
            run.time[shown], known[shown], label=style.plain(shorten(name, MAX_TIE_NAME, placeholder=" ...")), **look
        )
    axes.axhline(0.0, color=style.FAINT, linewidth=style.THIN)
    some = f", the {MAX_TIES} strongest of {len(forces)}" if len(forces) > MAX_TIES else ""
    style.make_room(axes, 0.3)
    axes.legend(
        loc="upper right", title=f"tension up, {model} model{some}", title_fontsize=style.TICK, alignment="left",
        ncols=min(3, len(strongest)), **style.LEGEND,
    )  # fmt: skip
    style.tidy(axes, y="tie force [kN]")


def _draw_run(axes: Axes, name: str, run: History, height: float, until: float) -> None:
    look = style.LINES[name]
    falls = run.fell and run.overturning_time <= until
    fate = f", {names.OVERTURNS}" if falls else f", {names.UNKNOWN} after {run.known_to:.4g} s" if run.unknown else ""
    followed = run.ratio[np.isfinite(run.ratio) & (run.time <= until)]  # the known part, up to overturning
    if falls:
        followed = followed[: np.flatnonzero(np.abs(followed) <= CUT_RATIO)[-1] + 1]
        axes.plot(run.time[followed.size - 1], followed[-1], marker="x", markersize=6, color=look["color"])
    shown = style.visible(followed)
    axes.plot(run.time[shown], followed[shown], label=style.LABELS[name] + fate, **look)  # type: ignore[arg-type]
    felt = run.felt[:, 0]
    felt = felt[felt <= until]
    if felt.size:
        axes.plot(
            felt,
            np.full(felt.size, height),
            transform=axes.get_xaxis_transform(),
            linestyle="none",
            marker="|",
            markersize=4,
            markeredgewidth=0.8,
            color=look["color"],
        )
