"""Figures of a verification by the Italian code: forces on the chain, capacity with the demand, spectra, histories."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from math import pi
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from matplotlib.text import Text

from rocking_cli.codes.italian.capacity import SHARE, DisplacedChain, ExactCurve, ends
from rocking_cli.codes.italian.demand import REFERENCE_DAMPING
from rocking_cli.codes.italian.dynamic import displacement_history
from rocking_cli.codes.italian.ground import Hazard, SiteGround, site_demand
from rocking_cli.codes.italian.results import Dynamic, ItalianVerified, RecordPeak
from rocking_cli.codes.italian.rules import RULES, STATES
from rocking_cli.codes.italian.sheet.chain import Scale, named
from rocking_cli.codes.italian.sheet.site import states
from rocking_cli.core import Length
from rocking_cli.core.bodies import Solid
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.plotting import dimensions, hung, style
from rocking_cli.plotting.labels import MARK_COST, Labels
from rocking_cli.plotting.panels import PANEL_GAP, Page, Panel, lay_out
from rocking_cli.plotting.spectra import draw_spectra_of_site
from rocking_cli.plotting.structure import LINE_HEIGHT, draw_ground, draw_parts, labels_of, weight
from rocking_cli.processing.oscillator import response_spectrum
from rocking_cli.studies.picture import Picture, box_around, picture
from rocking_cli.verification.demand import SiteDemand, StateDemand, spectra_at_states
from rocking_cli.views.sheet.language import Language

MAX_WEIGHTS = 6  # of more masses, the blocks are drawn with the sums of their weights
ARROW_LENGTH = 0.45  # inches
FOOT_HEIGHT = 0.12  # inches below the drawing of a chain
CENTRE_SHARE = 1.0  # share of the size of a structure within which a centre of rotation is drawn
SHORTEST_PERIOD, PERIODS_PER_SPECTRUM = 0.02, 400  # s, and number
TALLEST_SHARE = 3.0  # of the largest acceleration of a capacity curve, above which a spectrum is cut off
FORCE_DIGITS = 4
FRONT_HEIGHT, FRONT_SHARE = 3.0, 0.75  # inches of a front view, and the share of them that its plates take
OF_HAZARD = ("a_g [g]", "F_0", "T_C* [s]")  # labels of the parameters on rock
LABEL_BACKGROUND = {**dimensions.TEXT_BACKGROUND, "alpha": 0.8}


class DrawnWeight(NamedTuple):
    """A weight as it is drawn: name, number of its block, point and centre of rotation [m], and P and P + Q [N]."""

    name: str
    block: int
    at: complex
    centre: complex | None
    P: float
    PQ: float


def in_language(say: Language, figure: Figure) -> Figure:
    """Return a figure whose numbers have the decimal marks of a language, and whose labels stay text in an SVG."""
    drawn = within if isinstance(within := style.given(), Axes) else figure
    for each in drawn.findobj(Text):
        assert isinstance(each, Text)  # as selected above
        each.set_text(say.formula(each.get_text()))
        if each.get_path_effects():  # a halo turns text into outlines: a background does without
            each.set_path_effects([])
            each.set_bbox(LABEL_BACKGROUND)
    panels = [drawn] if isinstance(drawn, Axes) else drawn.axes
    for axis in (axis for axes in panels for axis in (axes.xaxis, axes.yaxis)):
        axis.set_major_formatter(lambda value, _: say.formula(f"{value:g}"))
    return figure


def draw_chain(say: Language, side: ItalianVerified) -> Figure:
    """Draw the chain at rest in a direction: weights, forces and ties, and their arms and heights about the centres."""
    drawing, position = picture(side.chain.mechanism).grouped, DisplacedChain(side.exact, 0.0)
    weights = _weights(say, side, position)
    outlines = [each for part in drawing.parts for each in part.outlines]
    low, high = box_around([*outlines, np.array([*drawing.held(0.0), *(each.at for each in weights)])])
    reach = CENTRE_SHARE * abs(high - low)
    centres = {each.centre for each in weights if each.centre is not None and abs(each.centre - each.at) <= reach}
    low, high = box_around([np.array([low, high, *centres])])
    weights = [each if each.centre in centres else each._replace(centre=None) for each in weights]
    rows, _ = dimensions.in_rows(_arms(weights, low, high), low, high)
    around = np.maximum(dimensions.room(rows, low, high), hung.margins(drawing)).tolist()
    title = say("{name}: weights, forces and arms at rest, {way} direction", name=side.chain.mechanism.name,
                way=say(side.direction.label))  # fmt: skip
    held = _of_held(say, drawing, position, Scale.of(side.chain), len(weights) + 1)
    room = style.page_width() - 2 * PANEL_GAP
    every = (*_of_weights(say, weights, Scale.of(side.chain)), *held.values())
    below = "\n".join(style.folded(each, room, style.TICK, "  ") for each in every)
    beside = hung.NAME_MARGIN
    panel = Panel(low, high, (around[0] + beside, around[1] + beside, max(around[2], ARROW_LENGTH), around[3] + 0.1))
    title = style.in_lines(title, room)
    panel.head = LINE_HEIGHT * (1 + title.count("\n")) + 0.18
    panel.foot = FOOT_HEIGHT + LINE_HEIGHT * len(below.splitlines())
    height = lay_out([panel], panel)
    page = Page.new(height, 1)
    axes = panel.axes(page)
    draw_ground(axes, drawing, panel)
    labels = labels_of(axes, drawing, panel, 0.0)
    draw_parts(axes, drawing, 0.0, weight(drawing, panel.scale))
    hung.draw_hung(axes, drawing, 0.0, panel, labels)
    dimensions.draw_outside(axes, rows, panel, low, high, labels)
    _draw_weights(axes, weights, panel, labels)
    _number_held(drawing, [*held], len(weights) + 1, panel, labels)
    for text, y, size in ((title, height - 0.09, style.TITLE), (below, panel.foot, style.TICK)):
        plain_text = text.replace(r"\$", "$")
        page.text(complex(PANEL_GAP, y), plain_text, va="top", fontsize=size, color=style.INK, parse_math=False)
    return in_language(say, page.figure)


def _weights(say: Language, side: ItalianVerified, position: DisplacedChain) -> list[DrawnWeight]:
    """Return the weights that move; if there are many, the sums of each block at its barycentre."""
    key, chain = side.chain.mechanism.mechanism, side.chain
    if len(chain.weights) > MAX_WEIGHTS:
        return [
            DrawnWeight(say("block {k}", k=k), k, each.at, each.centre, each.block.P, each.block.PQ)
            for k, each in enumerate(position.blocks, 1)
        ]
    of = {name: (k, each.centre) for k, each in enumerate(position.blocks, 1) for name in each.block.bodies}
    blocks = [of[each.spot.body or ""] for each in chain.weights]
    return [
        DrawnWeight(say.body(key, each.name), k, each.spot.at, centre, each.carried, each.inertial)
        for each, (k, centre) in zip(chain.weights, blocks, strict=True)
    ]


def _arms(weights: Sequence[DrawnWeight], low: complex, high: complex) -> list[Length]:
    """Return the arms below the structure and the heights at its right, about the centres; equal ones once."""
    lengths: dict[tuple[complex, complex], list[int]] = {}
    for k, each in enumerate(weights, 1):
        if each.centre is None:
            continue
        ends = [(complex(z.real, low.imag), complex(high.real, z.imag)) for z in (each.centre, each.at)]
        for start, end in zip(*ends, strict=True):
            lengths.setdefault((start, end), []).append(k)
    least = 1e-6 * abs(high - low)
    return [
        Length(", ".join(f"{'b' if start.imag == end.imag else 'h'}{k}" for k in of), start, end)
        for (start, end), of in lengths.items() if abs(end - start) > least
    ]  # fmt: skip


def _of_weights(say: Language, weights: Sequence[DrawnWeight], scale: Scale) -> list[str]:
    """Return number, name and size of each weight, which stand below the drawing."""
    texts = []
    for k, each in enumerate(weights, 1):
        P, PQ = (say.number(scale.weight(value), FORCE_DIGITS) for value in (each.P, each.PQ))
        moved = "" if P == PQ else f", P + Q = {PQ} {scale.unit}"
        name = style.fitted(each.name, hung.MAX_NAME_WIDTH, style.TICK)
        texts.append(style.plain(f"{k} {name}: P = {P} {scale.unit}{moved}"))
    return texts


def _draw_weights(axes: Axes, weights: Sequence[DrawnWeight], panel: Panel, labels: Labels) -> None:
    """Draw an arrow for each weight, with its number, and the centres of rotation."""
    numbers = {each.centre: each.block for each in weights if each.centre is not None}
    for centre, number in numbers.items():
        symbol = f"O{number}" if len(numbers) > 1 else "O"
        axes.plot(centre.real, centre.imag, marker="o", color=style.CURSOR, markersize=4.5, zorder=7)
        labels.keep_off([centre], MARK_COST)
        around = labels.around(centre, -1 - 1j, 0.05, style.size_of(symbol, style.LABEL))
        labels.write(symbol, around, fontsize=style.LABEL, color=style.CURSOR, zorder=7)
    tips = [each.at - 1j * ARROW_LENGTH / panel.scale for each in weights]
    for each, tip in zip(weights, tips, strict=True):
        look = {"arrowstyle": "-|>,head_width=0.2,head_length=0.45", "color": style.INK, "linewidth": style.BOLD}
        axes.annotate("", (tip.real, tip.imag), (each.at.real, each.at.imag), annotation_clip=False, zorder=6,
                      arrowprops={**look, "shrinkA": 0, "shrinkB": 0})  # fmt: skip
        labels.keep_off([each.at, tip], MARK_COST)
    for k, tip in enumerate(tips, 1):
        spots = labels.around(tip, 1 + 0.2j, 0.06, style.size_of(str(k), style.LABEL), turning=0.6)
        labels.write(str(k), spots, fontsize=style.LABEL, color=style.INK, zorder=8)


def _of_held(
    say: Language, drawing: Picture, position: DisplacedChain, scale: Scale, first: int
) -> dict[str, str]:  # fmt: skip
    """Return number, name, force and arm of each tie and force, by its name; they stand below the drawing."""
    works = {each.name: each for each in position.held}
    texts: dict[str, str] = {}
    for name in [each.name for each in drawing.loads if each.force] + [each.name for each in drawing.ties]:
        of = [works[key] for key in (name, f"{name}, x", f"{name}, y") if key in works]
        sizes = [
            f"{say.number(scale.weight(each.force), FORCE_DIGITS)} {scale.unit} "
            f"({say('arm')} {say.number(scale.near(abs(each.rate)), 3)} m)"
            for each in of
        ]
        if sizes:
            shown = style.plain(style.fitted(named(say, name), hung.MAX_NAME_WIDTH, style.TICK))
            texts[name] = f"{first + len(texts)} {shown}: {style.plain('; '.join(sizes))}"
    return texts


def _number_held(drawing: Picture, names: Sequence[str], first: int, panel: Panel, labels: Labels) -> None:
    """Write a number beside each tie, and at the tail of the arrow of each force."""
    places, ties, _ = drawing.hung(0.0, hung.SYMBOL_OFFSET / panel.scale)
    pairs = [(each, place) for each, place in zip(drawing.loads, places.tolist(), strict=True) if each.force]
    at = {each.name: (hung.tail(each.acting(first=True), place, panel.scale),) * 2 for each, place in pairs}
    for tie, pieces in zip(drawing.ties, ties, strict=True):
        at[tie.name] = max(pieces, key=lambda ends: abs(ends[1] - ends[0]))
    for text, name in zip(map(str, range(first, first + len(names))), names, strict=True):
        size = style.size_of(text, style.TICK)
        start, end = at[name]
        spots = labels.around(start, 1j, 0.02, size, turning=0.6) if start == end else labels.along(start, end, size)
        labels.write(text, spots, fontsize=style.LABEL, color=style.TIE["color"], zorder=8)


def capacity_end(curve: ExactCurve) -> float:
    """Return the displacement at which the capacity ends at all limit states: d0*, a break or a lost seat [m]."""
    others = [[d for by, d in ends(curve, rule).items() if by != SHARE] for rule in RULES]
    return max(min(each, default=curve.d0) for each in others)


def _look(state: str) -> dict[str, Any]:
    """Return the look of a limit state, the same in all figures."""
    return style.distinct(1 + [*(rule.state for rule in RULES), *STATES].index(state))


def draw_capacity(
    say: Language, sides: Mapping[str, ItalianVerified], title: str, ends: Mapping[str, str] | None = None,
    demand: SiteDemand | None = None,
) -> Figure:  # fmt: skip
    """Draw the capacity curve of each direction, with capacity and demand at each limit state.

    Parameters
    ----------
    say : Language
        Language of titles, axes and legends.
    sides : mapping of str to ItalianVerified
        Each direction by its name.
    title : str
        Title of each panel, before its direction and FC.
    ends : mapping of str to str, optional
        Words at the end of each title, after FC, by the name of the direction.
    demand : SiteDemand, optional
        Spectra of the site to draw into the same axes, with the line of the period of the first limit state.
    """
    figure, panels = style.panels((3.4 if demand is None else 4.2) * len(sides), len(sides))
    panel_axes = panels[:, 0]
    for axes, (direction, side) in zip(panel_axes, sides.items(), strict=True):
        end, (d, a) = capacity_end(side.exact), side.exact.points()
        shown = np.append(d[d < end], end)
        axes.plot(shown, np.interp(shown, d, a), color=style.INK, linewidth=style.BOLD, label=say("exact curve"))
        line = {"color": style.MEASURE, "linestyle": "--", "linewidth": style.MEDIUM}
        axes.plot([0, end], [side.a0, side.a0 * (1 - end / side.d0)], label=say("straight line"), **line)
        axes.set_xlim(0, 1.03 * max([end, *(each.demand or 0.0 for each in side.states.values())]))
        tallest = max(side.exact.largest, side.a0)
        for rule in RULES:
            name, limit, look = rule.state, side.states[rule.state], _look(rule.state)
            color, dashes = look["color"], look["linestyle"]
            mark = {"marker": look["marker"], "color": color, "linestyle": "none", "zorder": 5}
            axes.plot(limit.d, limit.a, label=say("capacity d_{state}", state=name), **mark)
            if limit.demand is None:
                continue
            caption = say("demand at {state}", state=name)
            if demand is None:
                axes.axvline(limit.demand, color=color, linestyle=dashes, linewidth=style.MEDIUM, label=caption)
                continue
            spectrum = _acceleration_displacement(demand.states[name], rule.damping)
            label = say("spectrum of {state}, ξ = {xi:g} %", state=name, xi=100 * rule.damping)
            axes.plot(*spectrum, color=color, linestyle=dashes, linewidth=style.MEDIUM, label=label)
            slope = (2 * pi / limit.T) ** 2  # of the line of the period: a = omega^2 d
            axes.plot(limit.demand, slope * limit.demand, **{**mark, "fillstyle": "none"}, markersize=8, label=caption)
            tallest = max(tallest, min(TALLEST_SHARE * tallest, spectrum[1].max()), 1.1 * slope * limit.demand)
            if name == side.first:
                label = say("line of the period T_{state}", state=name)
                axes.axline((0, 0), slope=slope, color=style.FAINT, linewidth=style.MEDIUM, label=label)
                style.note(axes, f"T_{name} = {limit.T:.4g} s")
        axes.set_ylim(0, 1.08 * tallest)
        axes.set_ylabel(say("acceleration a* [m/s2]" if demand is None else "acceleration a*, S_e [m/s²]"),
                        fontsize=style.LABEL)  # fmt: skip
        title_end = (ends or {}).get(direction, "")
        style.heading(axes, f"{title}, {direction.lower()}, FC = {side.exact.confidence:g}{title_end}")
        style.tidy(axes)
        if demand is None:
            axes.legend(**style.LEGEND)
    label = "displacement d of the single-degree-of-freedom system [m]"
    style.tidy(panel_axes[-1], say(label if demand is None else "displacement d, S_De [m]"))
    if demand is not None:
        style.legend_below(figure, panel_axes[0].get_legend_handles_labels()[0], 3)
    return in_language(say, figure)


def draw_front(say: Language, name: str, plates: Sequence[Solid]) -> Figure:
    """Draw plates from the front: each with its length out of plane, about a common middle."""
    y = np.array([[f(corner.imag for corner in each.corners) for f in (min, max)] for each in plates])
    figure, axes = style.one_panel(FRONT_HEIGHT, say("{name}: from the front", name=name))
    room = FRONT_SHARE * FRONT_HEIGHT / (y.max() - y.min())  # inches per metre
    for each, (low, high) in zip(plates, y, strict=True):
        axes.add_patch(Rectangle((-each.depth / 2, low), each.depth, high - low, facecolor=style.SHADE,
                                 edgecolor=style.INK, linewidth=style.THIN))  # fmt: skip
        if (high - low) * room > style.size_of("L", style.LABEL).imag:
            axes.text(0.0, (low + high) / 2, f"{say.number(each.depth, FORCE_DIGITS)} m", ha="center", va="center",
                      fontsize=style.LABEL, color=style.INK)  # fmt: skip
    axes.set_aspect("equal")
    axes.autoscale_view()
    style.tidy(axes, say("length [m]"), "y [m]")
    return in_language(say, figure)


def draw_hazard(say: Language, ground: SiteGround, hazard: Hazard, title: str) -> Figure:
    """Draw the parameters of the ground on rock over the return period: rows of the hazard, and the limit states."""
    figure, every = style.panels(4.6, len(OF_HAZARD), sharex=True)
    panels = every[:, 0]
    TR = np.geomspace(hazard.first, hazard.last, PERIODS_PER_SPECTRUM)
    rows, curves = np.array(hazard.table).T, np.array([hazard.parameters(each) for each in TR.tolist()]).T
    for k, (axes, label) in enumerate(zip(panels, OF_HAZARD, strict=True)):
        axes.plot(TR, curves[k], color=style.FAINT, linewidth=style.MEDIUM)
        axes.plot(rows[0], rows[k + 1], "o", color=style.INK, markersize=3.5, label=say("rows of the hazard"))
        for state in states(ground):
            of_state, rock = ground.return_period(state), ground.on_rock(state)
            assert of_state is not None and rock is not None  # as the site gives a hazard
            look = {**_look(state), "linestyle": "none", "fillstyle": "none", "markersize": 8}
            axes.plot(of_state, rock[k], label=state, **look)
        style.tidy(axes, say("return period T_R [years]") if axes is panels[-1] else "", label)
    panels[-1].set_xscale("log")
    style.heading(panels[0], title)
    figure.align_ylabels()
    style.legend_below(figure, panels[0].get_legend_handles_labels()[0], 5)
    return in_language(say, figure)


def _acceleration_displacement(state: StateDemand, damping: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the displacement spectrum S_De [m], and 4 pi^2 S_De/T^2 over it [m/s2], at the support of a structure."""
    spectrum = state.floor or state.ground
    T = np.geomspace(SHORTEST_PERIOD, state.last * (1 - 1e-9), PERIODS_PER_SPECTRUM)
    d = np.array([spectrum.displacement(each, damping) for each in T.tolist()])
    return d, d * (2 * pi / T) ** 2


def draw_site(say: Language, demand: SiteDemand, title: str) -> Figure:
    """Draw the spectra of the site at each limit state and 5 % damping."""
    periods, states = spectra_at_states(demand, REFERENCE_DAMPING)
    return in_language(say, draw_spectra_of_site(periods, states, demand.first, title, partial(say)))


SHORTEST_OF_RECORDS, LONGEST_OF_RECORDS, PERIOD_COUNT = 0.05, 4.0, 80  # s, s, and number: of the spectra of records
SMALL_SHARE = 0.05  # share of the displacement capacity up to which a peak would not be seen beside it
MAX_OPAQUE_LINES = 12  # with more records, their lines are transparent


def draw_history(say: Language, side: ItalianVerified, dynamic: Dynamic, record: RecordPeak) -> Figure:
    """Draw the history with FC under a record in a direction, its peak, the displacement capacity and d0*."""
    assert record.history is not None and record.with_confidence is not None  # the record has a known peak
    t, d = displacement_history(side.exact, side.direction, record.history)
    figure, axes = style.one_panel(3.2, f"{dynamic.state}, FC = {side.exact.confidence:g}")
    style.draw_samples(axes, d, float(t[1]), color=style.INK, linewidth=style.MEDIUM, label="d")
    peak = say("peak {d} m", d=say.number(record.with_confidence, 4))
    axes.plot(t[d.argmax()], record.with_confidence, marker="o", linestyle="none", color=style.CURSOR, label=peak)
    limits = {"capacity d_{state}": dynamic.allowed, "limit d_0*": dynamic.d0}
    for k, (label, limit) in enumerate(limits.items(), 1):
        look = {key: value for key, value in style.distinct(k).items() if key in ("color", "linestyle", "linewidth")}
        axes.axhline(limit, label=f"{say(label, state=dynamic.state)} = {say.number(limit, 4)} m", **look)
    axes.set_xlim(0.0, float(t[-1]))
    highest = dynamic.d0 if record.with_confidence > SMALL_SHARE * dynamic.allowed else 0.0
    axes.set_ylim(0.0, 1.08 * max(highest, record.with_confidence) or None)
    style.tidy(axes, say("time t [s]"), "d [m]")
    style.legend_below(figure, axes.get_legend_handles_labels()[0], 4)
    return in_language(say, figure)


def draw_spectra(say: Language, dynamic: Dynamic, ground: SiteGround, title: str) -> Figure:
    """Draw the spectra of the scaled records, their mean, and the target of the site, of the ground or of the floor."""
    demand, is_floor = site_demand(ground.site).states[dynamic.state], dynamic.motions.kind == "of_floor"
    target = demand.floor if is_floor and demand.floor is not None else demand.ground
    periods = np.geomspace(SHORTEST_OF_RECORDS, min(LONGEST_OF_RECORDS, demand.last * (1 - 1e-9)), PERIOD_COUNT)
    each = np.array([response_spectrum(one.of_ground, periods, REFERENCE_DAMPING).sa for one in dynamic.scaled])
    wanted = [target.acceleration(T, REFERENCE_DAMPING) / STANDARD_GRAVITY for T in periods.tolist()]
    figure, axes = style.one_panel(3.8, title)
    faint: dict[str, Any] = {
        "color": style.FAINT,
        "linewidth": style.CURVE,
        "alpha": max(min(MAX_OPAQUE_LINES / len(each), 1.0), 0.2),
    }
    axes.plot(periods, each.T, **faint)
    axes.plot([], [], label=say("each record, scaled"), **faint)
    axes.plot(periods, each.mean(axis=0), color=style.INK, linewidth=style.BOLD, label=say("mean of the records"))
    label = say("target: {support} at {state}", support=say("the floor" if is_floor else "the ground"),
                state=dynamic.state)  # fmt: skip
    axes.plot(periods, wanted, color=style.CURSOR, linestyle="--", linewidth=style.BOLD, label=label)
    axes.set_xlim(0.0, float(periods[-1]))
    axes.set_ylim(bottom=0.0)
    style.tidy(axes, say("period T [s]"), say("spectral acceleration [g]"))
    style.legend_below(figure, axes.get_legend_handles_labels()[0], 3)
    return in_language(say, figure)
