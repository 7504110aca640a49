"""Figures of the dynamic method: a history of d with its limits, and the spectra of a set with the target."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure

from rocking_cli.codes.italian.demand import REFERENCE_DAMPING
from rocking_cli.codes.italian.dynamic import displacement_history
from rocking_cli.codes.italian.ground import SiteGround
from rocking_cli.codes.italian.results import Dynamic, ItalianVerified, RecordPeak
from rocking_cli.codes.italian.sheet.figures import in_language
from rocking_cli.codes.italian.site_demand import site_demand
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.plotting import style
from rocking_cli.processing.oscillator import response_spectrum
from rocking_cli.views.sheet.language import Language

SHORTEST_PERIOD, LONGEST_PERIOD, PERIOD_COUNT = 0.05, 4.0, 80  # s, s, and number: of the spectra of records
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
    periods = np.geomspace(SHORTEST_PERIOD, min(LONGEST_PERIOD, demand.last * (1 - 1e-9)), PERIOD_COUNT)
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
