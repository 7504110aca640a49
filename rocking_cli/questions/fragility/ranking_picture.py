"""Plot of a ranking of intensity measures: their efficiency, and the trends of their residuals."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from rocking_cli.plotting import style
from rocking_cli.questions.fragility.ranking import MIN_P_VALUE, Ranking

MIN_DRAWN_P_VALUE = 1e-4  # smaller p-values are drawn at this value


def draw_ranking(ranking: Ranking) -> Figure:
    """Draw the measures of a structure, the most efficient on top.

    Parameters
    ----------
    ranking : Ranking
        The ranking, with at least one measure.

    Returns
    -------
    matplotlib.figure.Figure
    """
    measures = ranking.measures
    figure, drawn = style.panels(1.0 + 0.26 * len(measures), 1, 1 + bool(ranking.against), sharey=True)
    panels = drawn.ravel()
    filled = " (filled: residuals show no trend)" if ranking.against else ""
    style.heading(panels[0], f"{ranking.structure}: which measure predicts best{filled}")
    places = np.arange(len(measures))
    for place, each in zip(places, measures, strict=True):
        face = style.INK if each.sufficient else style.PAPER
        panels[0].plot(each.efficiency, place, "o", color=style.INK, markerfacecolor=face, markersize=6)
    panels[0].set_xlim(left=0.0)
    panels[0].set_xlabel(r"efficiency: dispersion of $\ln(\phi/\phi_{cr})$", fontsize=style.LABEL)
    if ranking.against:
        for k, name in enumerate(ranking.against):
            values = np.array([each.trends[name] for each in measures])
            look = style.distinct(k) | {"linestyle": ""}
            panels[1].plot(np.maximum(values, MIN_DRAWN_P_VALUE), places, **look, label=name)
        panels[1].axvline(MIN_P_VALUE, color=style.INK, linewidth=style.MEDIUM, linestyle="--")
        panels[1].set_xlim(MIN_DRAWN_P_VALUE / 1.3, 1.3)
        panels[1].set_xlabel(f"p-value of no trend; trend if below {MIN_P_VALUE:g}", fontsize=style.LABEL)
        style.logarithmic(panels[1].xaxis, (1.0,))
        style.legend_below(figure, grows=True)
    for axes in panels:
        axes.set_yticks(places, [each.measure for each in measures], parse_math=False)
        axes.set_ylim(len(measures) - 0.4, -0.6)
        style.tidy(axes)
    return figure
