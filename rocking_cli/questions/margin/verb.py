"""`rk.margin`: compute how close ground motions are to overturning a structure."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from rocking_cli.ask.answer import Answer, Dimensions, MappingAnswer, drawn, no_plot
from rocking_cli.ask.inputs import structure_of
from rocking_cli.ask.verbs import verb
from rocking_cli.ask.watcher import Watcher
from rocking_cli.errors import InputError
from rocking_cli.io.tables import stacked
from rocking_cli.names import percent
from rocking_cli.questions.margin.asked import MarginAsked, SharesAsked
from rocking_cli.studies.conclusion import Concluding, worst
from rocking_cli.studies.engines import FREE_NEIGHBOURS
from rocking_cli.studies.neighbours import Conditions, Neighbourhood
from rocking_cli.studies.neighbours import neighbours as neighbours_of
from rocking_cli.views.engines import cost_in_words
from rocking_cli.views.restitution import heading_of_run
from rocking_cli.views.view import View

if TYPE_CHECKING:
    from rocking_cli.io.tables import Columns
    from rocking_cli.questions.margin.study import Margin


@verb(MarginAsked)
def margin(asked: MarginAsked, watch: Watcher) -> MappingAnswer[str, Margin]:
    """Compute the scale factors on motions that uplift a structure, and that overturn it.

    Returns
    -------
    MappingAnswer of str to Margin
        Margins, by name of the motion.

    Raises
    ------
    InputError
        If a value is out of range, or a file cannot be used.
    MechanismError
        If the structure has no critical rotation or no uplift acceleration.
    SolverError
        If a motion cannot be simulated to its end.

    Notes
    -----
    The model is the nonlinear one, Eq. 8 of DeJong and Dimitrakopoulos (2014), under the neighbours of the motion at
    each of many scale factors.

    Examples
    --------
    >>> import rocking_cli as rk
    >>> answer = rk.margin(rk.Block(width=0.7, height=2.8), "sine:0.4g:0.8s", polarity="1", neighbours=10)
    >>> [round(each.uplift, 3) for each in answer.values()]
    [0.625]
    """
    from rocking_cli.questions.margin import study
    from rocking_cli.questions.margin.view import MarginRow, view

    conditions = Conditions(
        structure_of(asked.structure, watch, asked.opening, asked.restitution),
        ["nonlinear"],
        asked.signs,
        around=asked.neighbourhood(Neighbourhood.count if asked.engine == "exact" else FREE_NEIGHBOURS),
        engine=asked.engine,
    )
    ready, around = conditions.structure, conditions.around
    ready.models(conditions.models)
    factors = study.FACTORS if asked.engine == "exact" else study.FEW_FACTORS
    chosen = asked.ground_motions.gather(ready.growth, watch)
    rows = []
    count = (factors.size + 1) * around.count * len(conditions.signs) * len(chosen)
    if chosen and (cost := cost_in_words(conditions.by, ready, chosen[0].motion, count)):
        watch.note(cost)
    with watch.progress(count, "histories") as advance:
        for each in chosen:
            scaled = each.motion.scaled(each.factor)
            result = study.margin(conditions, scaled, factors=factors, progress=advance)
            end = study.conclusion(conditions, scaled, result)
            unknown = study.first_unknown(conditions, scaled, result)
            rows.append(MarginRow(each.motion.name, each.factor, result, end, unknown))
    end = replace(worst(row.conclusion for row in rows), motions=[row.name for row in rows])
    margins = Concluding({row.name: row.margin for row in rows}, end)
    figure = drawn("questions.margin.picture.draw_margins", margins, heading_of_run(ready))
    margin_view = view(conditions, rows, end)
    dims = [Dimensions(("motion",), ("uplift",)), Dimensions(("motion", "scale"))]
    return MappingAnswer("margin", margins, margin_view, partial(_columns, margins), figure, dims=dims)


def _columns(margins: dict[str, Margin]) -> Columns:
    return stacked(
        {
            "motion": name, "scale": each.factors, "pga_g [g]": each.factors * each.pga_g,
            "overturned": each.overturned,
            "unknown": each.unknown if each.checked else np.nan,
            "uplift": np.nan if each.uplift is None else each.uplift,
        }
        for name, each in margins.items()
    )  # fmt: skip


class OutcomeShares(NamedTuple):
    """Shares of the neighbours of a motion by outcome, each from 0 to 1; their sum is 1.

    Parameters
    ----------
    overturned, stands, unknown : float
        Share that overturns, share that is known not to overturn, and share of unknown outcome.
    checked : bool
        Whether the joints of the structure are known; if not, no outcome is unknown.
    """

    overturned: float
    stands: float
    unknown: float
    checked: bool


@verb(SharesAsked)
def shares(asked: SharesAsked, watch: Watcher) -> Answer[OutcomeShares]:
    """Compute the shares of the neighbours of a motion that overturn, that do not, and whose outcome is unknown.

    Returns
    -------
    Answer of OutcomeShares
        `overturned`, `stands` and `unknown`.

    Raises
    ------
    InputError
        If a value is out of range, or a file cannot be used.
    MechanismError
        If the structure has no critical rotation or no uplift acceleration.
    SolverError
        If a motion cannot be simulated to its end.

    Notes
    -----
    The shares are those that `score` compares with tests. The model is the nonlinear one, Eq. 8 of DeJong and
    Dimitrakopoulos (2014).

    Examples
    --------
    >>> import rocking_cli as rk
    >>> answer = rk.shares(rk.Block(width=0.7, height=2.8), "sine:0.39g:0.8s")
    >>> 0.3 < answer.overturned < 0.7
    True
    """
    ready = structure_of(asked.structure, watch, asked.opening)
    around, motions = asked.neighbourhood(Neighbourhood.count), asked.ground_motions
    if motions.count > 1:
        raise InputError(f"{motions.count} motions are given where one is expected: ask for one after the other")
    (given,) = motions.gather(ready.growth, watch)
    conditions = Conditions(ready, ["nonlinear"], asked.signs, around=around)
    by_sign = [neighbours_of(conditions, given.motion.scaled(sign * given.factor)) for sign in conditions.signs]
    overturned = sum(each.overturned for each in by_sign) / len(by_sign)
    unknown = sum(each.unknown or 0.0 for each in by_sign) / len(by_sign)
    result = OutcomeShares(overturned, 1 - overturned - unknown, unknown, conditions.model.joints is not None)
    sentence = f"Of {around.count} neighbours of {given.motion.name}, {percent(overturned)} overturn {ready.name}"
    sentence += f", and the outcome of {percent(unknown)} is unknown." if unknown else "."
    columns = {name: [value] for name, value in result._asdict().items()}
    figure = no_plot("shares have no plot of their own: plot the margin")
    return Answer("shares", result, View(result._asdict(), [sentence]), lambda: columns, figure)
