"""`rk.margin`: compute how close ground motions are to overturning a structure."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, NamedTuple, Unpack

import numpy as np

from rocking_cli.ask.answer import Answer, MappingAnswer, drawn, no_plot
from rocking_cli.ask.given import StructureLike, structure_of
from rocking_cli.ask.ground_motions import Motion, MotionArguments, Motions, signs_of
from rocking_cli.ask.numbers import refuse_idle, takes_numbers
from rocking_cli.ask.watcher import SILENT, Watcher
from rocking_cli.errors import InputError
from rocking_cli.names import OPENING, percent
from rocking_cli.studies.conclusion import Concluding, worst
from rocking_cli.studies.engines import FREE_NEIGHBOURS, engine_of
from rocking_cli.studies.neighbours import Neighbourhood
from rocking_cli.studies.neighbours import neighbours as neighbours_of
from rocking_cli.views.engines import cost_in_words
from rocking_cli.views.view import View, heading

if TYPE_CHECKING:
    from rocking_cli.io.tables import Columns
    from rocking_cli.questions.margin.study import Margin


@takes_numbers
def margin(
    structure: StructureLike,
    motions: Motion | Motions | Sequence[Motion],
    *,
    polarity: str | int = "both",
    neighbours: int | None = None,
    amplitude_deviation: float = Neighbourhood.amplitude,
    slenderness_deviation: float | None = None,
    restitution_deviation: float | None = None,
    opening: float = OPENING,
    engine: str = "exact",
    watch: Watcher = SILENT,
    **options: Unpack[MotionArguments],
) -> MappingAnswer[str, Margin]:
    """Compute the scale factors on motions that uplift a structure, and that overturn it.

    Parameters
    ----------
    structure : Mechanism, str or Path
        The structure, or its YAML file.
    motions : GroundMotion, Pulse, str or Path, or a sequence of these
        Ground motions, their files, or pulses as text.
    polarity : {"both", "1", "-1"}
        Polarity of the motions: as given, reversed, or both, of which the worse governs.
    neighbours : int, optional
        Number of neighbouring motions to simulate at each scale factor, at least 1; by default 200, or 20 with free
        blocks.
    amplitude_deviation, slenderness_deviation, restitution_deviation : float, optional
        Standard deviations of the neighbours: of ln amplitude, of ln slenderness and of restitution; by default those
        of the structure.
    opening : float
        Largest opening of a joint up to which a history is valid, over D_cr.
    engine : {"exact", "blocks", "auto"}
        Who simulates the motions: one degree of freedom, free blocks, or free blocks where one degree of freedom does
        not tell the outcome. With free blocks there are fewer scale factors, and restitution is what contact gives.
    watch : Watcher
        Told what was read, how far the work is, and which of several motions cannot be used.
    **options
        How the motions are read, corrected and scaled: see `rocking_cli.ask.ground_motions.MotionArguments`.

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
    >>> [round(found.uplift, 3) for found in answer.values()]
    [0.625]
    """
    from rocking_cli.questions.margin import study
    from rocking_cli.questions.margin.view import MarginRow, view

    signs = signs_of(polarity)
    usual = Neighbourhood.count if engine == "exact" else FREE_NEIGHBOURS
    neighbours = usual if neighbours is None else neighbours
    if engine == "blocks":
        refuse_idle("with free blocks", restitution_deviation=restitution_deviation, opening=opening != OPENING)
    around = Neighbourhood(neighbours, amplitude_deviation, restitution_deviation, slenderness_deviation)
    ready = structure_of(structure, watch, opening)
    model, by = ready.model("nonlinear"), engine_of(engine, [ready.mechanism])
    factors = study.FACTORS if engine == "exact" else study.FEW_FACTORS
    chosen = Motions.of(motions, options).gather(ready.growth, watch)
    rows = []
    count = (factors.size + 1) * neighbours * len(signs) * len(chosen)
    if chosen and (cost := cost_in_words(by, ready, chosen[0].motion, count)):
        watch.note(cost)
    with watch.progress(count, "histories") as advance:
        for each in chosen:
            scaled = each.motion.scaled(each.factor)
            result = study.margin(model, scaled, signs, around=around, factors=factors, progress=advance, engine=by)
            end = study.conclusion(ready, scaled, signs, result, by)
            rows.append(MarginRow(each.motion.name, each.factor, result, end))
    end = replace(worst(row.conclusion for row in rows), motions=[row.name for row in rows])
    margins = Concluding({row.name: row.margin for row in rows}, end)
    figure = drawn("questions.margin.picture.draw_margins", margins, heading(ready.mechanism))
    margin_view = view(ready, rows, str(polarity), around, end)
    return MappingAnswer("margin", margins, margin_view, partial(_columns, margins), figure)


def _columns(margins: dict[str, Margin]) -> Columns:
    return {
        "motion": [name for name, each in margins.items() for _ in each.factors],
        "factor": np.concatenate([each.factors for each in margins.values()]),
        "overturned": np.concatenate([each.overturned for each in margins.values()]),
        "unknown": np.concatenate(
            [each.unknown if each.checked else each.unknown + np.nan for each in margins.values()]
        ),
    }


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


@takes_numbers
def shares(
    structure: StructureLike,
    motion: Motion,
    *,
    neighbours: int = Neighbourhood.count,
    polarity: str | int = "1",
    amplitude_deviation: float = Neighbourhood.amplitude,
    slenderness_deviation: float | None = None,
    restitution_deviation: float | None = None,
    opening: float = OPENING,
    watch: Watcher = SILENT,
    **options: Unpack[MotionArguments],
) -> Answer[OutcomeShares]:
    """Compute the shares of the neighbours of a motion that overturn, that do not, and whose outcome is unknown.

    Parameters
    ----------
    structure : Mechanism, str or Path
        The structure, or its YAML file.
    motion : GroundMotion, Pulse, str or Path
        The ground motion, its file, or a pulse as text.
    neighbours : int
        Number of neighbouring motions to simulate under each polarity, at least 1.
    polarity : {"1", "-1", "both"}
        Polarity of the motion: as given, reversed, or the mean of both.
    amplitude_deviation, slenderness_deviation, restitution_deviation : float, optional
        Standard deviations of the neighbours: of ln amplitude, of ln slenderness and of restitution; by default those
        of the structure.
    opening : float
        Largest opening of a joint up to which a history is valid, over D_cr.
    engine : {"exact", "blocks", "auto"}
        Who simulates the motions: one degree of freedom, free blocks, or free blocks where one degree of freedom does
        not tell the outcome. With free blocks there are fewer scale factors, and restitution is what contact gives.
    watch : Watcher
        Told what was read, and what is doubtful about it.
    **options
        How the motion is read, corrected and scaled: see `rocking_cli.ask.ground_motions.MotionArguments`.

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
    ready = structure_of(structure, watch, opening)
    around = Neighbourhood(neighbours, amplitude_deviation, restitution_deviation, slenderness_deviation)
    motions = Motions.of(motion, options)
    if motions.count > 1:
        raise InputError(f"{motions.count} motions are given where one is expected: ask for one after the other")
    (given,) = motions.gather(ready.growth, watch)
    model = ready.model("nonlinear")
    by_sign = [neighbours_of(model, given.motion.scaled(sign * given.factor), around) for sign in signs_of(polarity)]
    overturned = sum(each.overturned for each in by_sign) / len(by_sign)
    unknown = sum(each.unknown or 0.0 for each in by_sign) / len(by_sign)
    result = OutcomeShares(overturned, 1 - overturned - unknown, unknown, model.joints is not None)
    sentence = f"Of {around.count} neighbours of {given.motion.name}, {percent(overturned)} overturn {ready.name}"
    sentence += f", and the outcome of {percent(unknown)} is unknown." if unknown else "."
    columns = {name: [value] for name, value in result._asdict().items()}
    figure = no_plot("shares have no plot of their own: plot the margin")
    return Answer("shares", result, View(result._asdict(), [sentence]), lambda: columns, figure)
