"""Plot of many structures: the uplift acceleration of each against its frequency parameter, and its outcome."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from rocking_cli.plotting import style
from rocking_cli.plotting.labels import name_marks
from rocking_cli.questions.survey.study import Survey

MAX_RANKED_LABELS = 10  # structures whose rank stands beside their mark
MAX_VECTOR_MARKS = 2000  # more are drawn as one image
MARKS: dict[str, dict[str, Any]] = {
    "does not uplift": {"marker": "o", "color": style.PAPER, "markeredgecolor": style.SPARED},
    "rocks": {"marker": "o", "color": style.SPARED, "markeredgecolor": style.PAPER},
    "unknown under at least one motion": {"marker": "D", "color": style.PAPER, "markeredgecolor": style.FAINT},
    "overturns under at least one motion": {"marker": "^", "color": style.EXCEEDED, "markeredgecolor": style.PAPER},
    "structure": {"marker": "o", "color": style.SPARED, "markeredgecolor": style.PAPER},
}


def draw_survey(found: Survey, title: str) -> Figure:
    """Plot the structures that have an equivalent block, with the ranks of the most vulnerable.

    Parameters
    ----------
    found : Survey
        The survey to plot.
    title : str
        Heading.
    """
    figure, axes = style.one_panel(4.2, title)
    p = np.array([each.p for each in found.rows])
    uplift = np.array([each.uplift for each in found.rows])
    there = np.isfinite(p)
    for look, here in _groups(found).items():
        here = here & there
        if here.any():
            label = f"{look} ({here.sum():,})" if found.motions else None
            edge = 0.8 if MARKS[look]["color"] == style.PAPER else 0.3
            axes.plot(
                p[here], uplift[here], linestyle="none", markersize=5 if len(p) <= MAX_VECTOR_MARKS else 3, label=label,
                markeredgewidth=edge, rasterized=len(p) > MAX_VECTOR_MARKS, **MARKS[look],
            )  # fmt: skip
    first = np.flatnonzero(there)[:MAX_RANKED_LABELS]
    axes.plot(
        p[first],
        uplift[first],
        linestyle="none",
        marker="o",
        color="none",
        markeredgecolor=style.INK,
        markersize=7 if len(p) <= MAX_VECTOR_MARKS else 4.5,
    )
    axes.margins(0.08)
    axes.set_ylim(bottom=0.0)
    x = "frequency parameter p [rad/s]: large structures left, small ones right"
    style.tidy(axes, x, "ground acceleration at uplift [g]")
    if missing := int((~there).sum()):
        label = f"not drawn: {missing:,} without an equivalent block (no p)"
        axes.plot([], [], linestyle="none", label=label)
    if axes.get_legend_handles_labels()[1]:
        style.legend_below(figure)
    ranked = [(float(p[k]), float(uplift[k]), str(k + 1)) for k in first]
    name_marks(axes, ranked, np.column_stack([p[there], uplift[there]]))
    return figure


def _groups(found: Survey) -> dict[str, NDArray[np.bool_]]:
    """Return masks of the structures by outcome, the worst drawn last."""
    if not found.motions:
        return {"structure": np.ones(len(found.rows), dtype=bool)}
    falls = np.array([each.under is not None and each.under.overturned > 0 for each in found.rows])
    doubtful = np.array([each.under is not None and bool(each.under.unknown) for each in found.rows]) & ~falls
    lifts = np.array([each.under is not None and each.under.peak_ratio > 0 for each in found.rows])
    known = ~falls & ~doubtful
    return {
        "does not uplift": known & ~lifts,
        "rocks": known & lifts,
        "unknown under at least one motion": doubtful,
        "overturns under at least one motion": falls,
    }
