"""`rk.overturning`, and its two questions: which pulses overturn a structure, and which of several overturns first."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from rocking_cli.ask.answer import Answer, Dimensions, drawn
from rocking_cli.ask.ground_motions import each_of
from rocking_cli.ask.groups import ByEngine
from rocking_cli.ask.inputs import structure_of, structures_of, warn_misleading
from rocking_cli.ask.verbs import verb
from rocking_cli.ask.watcher import Watcher
from rocking_cli.errors import InputError, named
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.questions.overturning.asked import (
    CURVE_POINTS,
    FEW_POINTS,
    MAP_POINTS,
    OfPulses,
    OnAxes,
    OverturningAsked,
    OverturningCurvesAsked,
    OverturningMapAsked,
)

if TYPE_CHECKING:
    from rocking_cli.questions.overturning.study import Comparison, OverturningMap

ETA = 0.9  # restitution of the linear block


@verb(OverturningAsked)
def overturning(asked: OverturningAsked, watch: Watcher) -> Answer[OverturningMap] | Answer[Comparison]:
    """Map the pulses that overturn a structure, or compare several structures.

    This is `overturning_map` of one structure or of the linear block, or `overturning_curves` with `compare`.

    Returns
    -------
    Answer of OverturningMap or Comparison
        As for `overturning_map` and `overturning_curves`.

    Raises
    ------
    InputError
        If a value is out of range, arguments cannot be combined, or a file cannot be used.
    MechanismError
        If the structure has no critical rotation or no uplift acceleration.
    SolverError
        If a motion cannot be simulated to its end.

    Notes
    -----
    DeJong and Dimitrakopoulos (2014), Section 6, with the dimensionless numbers of Eq. 40.

    Examples
    --------
    >>> import rocking_cli as rk
    >>> rk.overturning(points=24).outcome.overturned.shape
    (24, 24)
    """
    ready = structures_of(each_of(asked.structures), watch, asked.opening, asked.restitution)
    if asked.compare and len(ready) < 2:
        raise InputError(f"{named('compare')} needs at least two structures that can be used")
    if not asked.compare and len(ready) > 1:
        raise InputError(f"a map shows one structure: give one, or {named('compare')} for the curves of several")
    exact = asked.engine == "exact"
    model = asked.model or ("nonlinear" if asked.compare or not exact else "linear2")
    if model != "nonlinear":
        warn_misleading(ready, watch)
    given = asked.part(OfPulses) | {"model": model, "watch": watch}
    if asked.compare:
        top = {"top": asked.ag[1]} if asked.ag is not None else {}
        return overturning_curves(ready, points=asked.points or CURVE_POINTS, **top, **given)
    points = asked.points or (MAP_POINTS if exact else FEW_POINTS)
    axes = asked.part(OnAxes) | asked.part(ByEngine)
    return overturning_map(ready[0] if ready else None, points=points, **axes, **given)


@verb(OverturningMapAsked)
def overturning_map(asked: OverturningMapAsked, watch: Watcher) -> Answer[OverturningMap]:
    """Map the effect of pulses of all periods and amplitudes on a structure, or on the dimensionless linear block.

    Returns
    -------
    Answer of OverturningMap
        Outcome under every pulse; `regions` has the class of each, unknown outcomes among them.

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
    Dimensionless amplitude and frequency: DeJong and Dimitrakopoulos (2014), Eq. 40.

    Examples
    --------
    >>> import rocking_cli as rk
    >>> found = rk.overturning_map(points=24)
    >>> found.outcome.overturned.shape
    (24, 24)
    """
    from rocking_cli.questions.overturning import study
    from rocking_cli.questions.overturning import view as views
    from rocking_cli.studies.engines import engine_of
    from rocking_cli.studies.under_pulses import linear_block, parse_shape, pulsed_model
    from rocking_cli.views.engines import cost_in_words

    form, signs, engine = parse_shape(asked.shape), asked.signs, asked.engine
    if asked.structure is None:
        mechanism, subject = None, linear_block(ETA if asked.restitution is None else asked.restitution)
    else:
        ready = structure_of(asked.structure, watch, asked.opening, asked.restitution)
        mechanism, subject = ready.mechanism, pulsed_model(ready, asked.model, form, signs)
    bare, points = asked.dimensionless or mechanism is None, asked.points
    if bare:
        columns = np.linspace(*(asked.omega or study.usual_omegas(subject, form, signs)), points)
        rows = np.linspace(*(asked.a or study.LINEAR_AMPLITUDES), points)
    else:  # at equal ratios, as the axes are logarithmic
        columns = subject.period(np.geomspace(*(asked.period or study.usual_periods([subject], form, signs)), points))
        rows = np.geomspace(*(asked.ag or study.usual_amplitudes([subject])), points) * STANDARD_GRAVITY / subject.unit
    count = study.count_histories([subject], columns.size * rows.size, signs)
    if engine != "exact":
        if asked.model != "nonlinear":
            what = (
                f"{named('engine')} {engine} simulates the structure itself: leave out {named('model')} {asked.model}"
            )
            raise InputError(what)
        by = engine_of(engine, [ready.mechanism])
        longest = replace(form, period=float(subject.period(columns).max())).sampled()
        watch.note(cost_in_words(by, ready, longest, count))
        subject = replace(subject, engine=by)
    with watch.progress(count, "histories") as progress:
        result = study.overturning_map(subject, form, columns, rows, polarities=signs, progress=progress)
    shown = views.map_view(result, mechanism, dimensionless=bare)
    figure = drawn("questions.overturning.picture.draw_map", result, views.map_title(result), dimensionless=bare)
    table = partial(views.map_table, result, mechanism)
    dims = [Dimensions(("a", "omega"))]
    if not bare:
        dims = [Dimensions(("ag",), ("a",)), Dimensions(("period",), ("omega",)), Dimensions(("ag", "period"))]
    elif mechanism is not None:
        dims = [Dimensions(("a",), ("ag",)), Dimensions(("omega",), ("period",)), *dims]
    return Answer("overturning map", result, shown, table, figure, dims=dims)


@verb(OverturningCurvesAsked)
def overturning_curves(asked: OverturningCurvesAsked, watch: Watcher) -> Answer[Comparison]:
    """Compute the smallest amplitude that overturns each structure, against the period of a pulse.

    Returns
    -------
    Answer of Comparison
        Smallest amplitudes `least` known to overturn, and the structure that overturns first; overturning starts
        between `possible` and `least` if outcomes below are unknown.

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
    The models are those of `respond`: DeJong and Dimitrakopoulos (2014).

    Examples
    --------
    >>> import rocking_cli as rk
    >>> blocks = [rk.Block(width=0.7, height=2.8), rk.Block(width=1.4, height=5.6)]
    >>> rk.overturning_curves(blocks, model="linear2", points=3).least.shape
    (2, 3)
    """
    from rocking_cli.questions.overturning import study
    from rocking_cli.questions.overturning import view as views
    from rocking_cli.studies.under_pulses import parse_shape, pulsed_model

    form, signs = parse_shape(asked.shape), asked.signs
    ready = structures_of(each_of(asked.structures), watch, asked.opening, asked.restitution)
    subjects = [pulsed_model(each, asked.model, form, signs) for each in ready]
    periods = np.geomspace(*(asked.period or study.usual_periods(subjects, form, signs)), asked.points)
    highest = study.usual_amplitudes(subjects)[1] if asked.top is None else asked.top
    count = study.count_scans(subjects, periods.size, signs)
    with watch.progress(count, "histories") as progress:
        result = study.compare(subjects, form, periods, highest, polarities=signs, progress=progress)
    shown = views.comparison_view(result, [each.mechanism for each in ready])
    figure = drawn("questions.overturning.picture.draw_comparison", result, views.comparison_title(result))
    table = partial(views.comparison_table, result)
    return Answer("overturning curves", result, shown, table, figure, dims=[Dimensions(("structure", "period"))])
