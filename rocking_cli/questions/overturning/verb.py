"""`rk.overturning`, and its two questions: which pulses overturn a structure, and which of several overturns first."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from rocking_cli.ask.answer import Answer, drawn
from rocking_cli.ask.given import StructureLike, structure_of, structures_of, warn_misleading
from rocking_cli.ask.ground_motions import each_of, signs_of
from rocking_cli.ask.numbers import refuse_idle, takes_numbers
from rocking_cli.ask.watcher import SILENT, Watcher
from rocking_cli.dynamics.model import ModelName
from rocking_cli.errors import InputError
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.names import OPENING

if TYPE_CHECKING:
    from rocking_cli.questions.overturning.study import Comparison, OverturningMap
    from rocking_cli.structure import Structure

MAP_POINTS, CURVE_POINTS = 256, 60  # along each side of a map, and of a curve
FEW_POINTS = 12  # along each side of a map with free blocks
ETA = 0.9  # restitution of the linear block
Range = tuple[float, float]


@takes_numbers
def overturning(
    structures: StructureLike | Sequence[StructureLike] = (),
    *,
    compare: bool = False,
    shape: str = "sine",
    model: ModelName | None = None,
    eta: float | None = None,
    polarity: str | int = "1",
    dimensionless: bool = False,
    period: Range | None = None,
    ag: Range | None = None,
    omega: Range | None = None,
    a: Range | None = None,
    points: int | None = None,
    opening: float = OPENING,
    engine: str = "exact",
    watch: Watcher = SILENT,
) -> Answer[OverturningMap] | Answer[Comparison]:
    """Map the pulses that overturn a structure, or compare several structures.

    This is `overturning_map` of one structure or of the linear block, or `overturning_curves` with `compare`.

    Parameters
    ----------
    structures : Mechanism, str or Path, or a sequence of these
        One structure for a map, several to compare; without any, the dimensionless linear block.
    compare : bool
        Whether to compute the smallest overturning amplitudes of several structures instead of a map.
    shape : str
        Shape of the pulses.
    model : {"linear2", "linear1", "nonlinear"}, optional
        Model of the structure; by default "linear2", or "nonlinear" to compare.
    eta : float, optional
        Coefficient of restitution; by default that of the structure, or 0.9 without one.
    polarity : {"1", "-1", "both"}
        Polarity of the pulses; with both, the worse governs.
    dimensionless : bool
        Whether the map of a structure has the axes omega and a.
    period, ag : (float, float), optional
        Smallest and largest period [s] and amplitude [standard gravity].
    omega, a : (float, float), optional
        Smallest and largest dimensionless frequency and amplitude, on dimensionless axes.
    points : int, optional
        Number of points along each side of a map, 256 by default, or 12 with free blocks; or of periods, 60 by default.
    opening : float
        Largest opening of a joint up to which a history is valid, over D_cr.
    engine : {"exact", "blocks", "auto"}
        Who simulates the pulses of a map: one degree of freedom, free blocks, or free blocks where one degree of
        freedom does not tell the outcome. With free blocks the model is the nonlinear one.
    watch : Watcher
        Shown the progress, and told which structures cannot be used, and for which the linear models mislead.

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
    ready = structures_of(each_of(structures), watch, opening)
    axes = {"period": period, "ag": ag, "omega": omega, "a": a}
    ranges = [name for name, ends in axes.items() if ends is not None]
    _check(ready, ranges, compare=compare, dimensionless=dimensionless, model=model)
    if engine != "exact" and compare:
        raise InputError("`engine` cannot be combined with `compare`: free blocks take too long")
    if engine != "exact" and not ready:
        raise InputError("`engine` requires a structure: give one")
    model = model or ("nonlinear" if compare or engine != "exact" else "linear2")
    if model != "nonlinear":
        warn_misleading(ready, watch)
    if compare:
        return overturning_curves(
            ready, shape=shape, model=model, eta=eta, period=period, top=ag[1] if ag is not None else None,
            polarity=polarity, points=points or CURVE_POINTS, opening=opening, watch=watch,
        )  # fmt: skip
    usual = MAP_POINTS if engine == "exact" else FEW_POINTS
    return overturning_map(
        ready[0] if ready else None, shape=shape, model=model, eta=eta, period=period, ag=ag, omega=omega, a=a,
        dimensionless=dimensionless, polarity=polarity, points=points or usual, opening=opening, engine=engine,
        watch=watch,
    )  # fmt: skip


def _check(
    structures: Sequence[Structure], given: Sequence[str], *, compare: bool, dimensionless: bool, model: str | None
) -> None:
    """Raise `InputError` if arguments cannot be combined."""
    if compare and len(structures) < 2:
        raise InputError("`compare` needs at least two structures that can be used")
    if not compare and len(structures) > 1:
        raise InputError("a map shows one structure: give one, or `compare` for the curves of several")
    if not structures and model not in (None, "linear2"):
        raise InputError(f"`model` {model} requires a structure: without one, the map is that of the linear block")
    if compare and dimensionless:
        raise InputError("`compare` uses the period in s as its axis: leave out `dimensionless`")
    for name, right in (("omega", "period"), ("a", "ag")):
        if compare and name in given:
            raise InputError(f"`{name}` has no effect with `compare`: give `{right}`")


@takes_numbers
def overturning_map(
    structure: StructureLike | None = None,
    *,
    shape: str = "sine",
    model: ModelName = "linear2",
    eta: float | None = None,
    period: Range | None = None,
    ag: Range | None = None,
    omega: Range | None = None,
    a: Range | None = None,
    dimensionless: bool = False,
    polarity: str | int = "1",
    points: int = 128,
    opening: float = OPENING,
    engine: str = "exact",
    watch: Watcher = SILENT,
) -> Answer[OverturningMap]:
    """Map the effect of pulses of all periods and amplitudes on a structure, or on the dimensionless linear block.

    Parameters
    ----------
    structure : Mechanism, str or Path, optional
        Structure; without it, the linear block, with the axes omega = omega_g/p and a = a_g/(g lambda).
    shape : str
        Shape of the pulses.
    model : {"linear2", "linear1", "nonlinear"}
        Model of the structure.
    eta : float, optional
        Coefficient of restitution; by default that of the structure, or 0.9.
    period, ag : (float, float), optional
        Smallest and largest period [s] and amplitude [standard gravity], for a structure; the points between them are
        at equal ratios. The default ranges show where overturning starts.
    omega, a : (float, float), optional
        Smallest and largest dimensionless frequency and amplitude, for the linear block.
    dimensionless : bool
        Whether a structure has the axes omega and a as well.
    polarity : {"1", "-1", "both"}
        Polarity of the pulses; with both, the worse governs.
    points : int
        Number of points along each side.
    opening : float
        Largest opening of a joint up to which a history is valid, over D_cr.
    engine : {"exact", "blocks", "auto"}
        Who simulates the pulses, see `overturning`.
    watch : Watcher
        Shown the progress.

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

    form, signs = parse_shape(shape), signs_of(polarity)
    axes = {"period": period, "ag": ag, "omega": omega, "a": a}
    if structure is None:
        mechanism, subject = None, linear_block(ETA if eta is None else eta)
    else:
        ready = structure_of(structure, watch, opening)
        mechanism, subject = ready.mechanism, pulsed_model(ready, model, form, signs, eta)
    bare = dimensionless or mechanism is None
    if model != "nonlinear" or mechanism is None:
        refuse_idle("on a linear block, which has no joints", opening=opening != OPENING)
    right = dict(zip(*(("period", "ag"), ("omega", "a"))[:: 1 if bare else -1], strict=True))
    for name in [name for name, ends in axes.items() if ends is not None and name in right]:
        why = "without a structure" if mechanism is None else "with `dimensionless`" if bare else "with a structure"
        more = "" if bare else ", or add `dimensionless`"
        raise InputError(f"`{name}` has no effect {why}: give `{right[name]}`{more}")
    if bare:
        columns = np.linspace(*(omega or study.usual_omegas(subject, form, signs)), points)
        rows = np.linspace(*(a or study.LINEAR_AMPLITUDES), points)
    else:  # at equal ratios, as the axes are logarithmic
        columns = subject.period(np.geomspace(*(period or study.usual_periods([subject], form, signs)), points))
        rows = np.geomspace(*(ag or study.usual_amplitudes([subject])), points) * STANDARD_GRAVITY / subject.unit
    count = study.count_histories([subject], columns.size * rows.size, signs)
    if engine != "exact":
        if model != "nonlinear":
            raise InputError(f"`engine` {engine} simulates the structure itself: leave out `model` {model}")
        refuse_idle("with free blocks", eta=eta)
        by = engine_of(engine, [ready.mechanism])
        longest = replace(form, period=float(subject.period(columns).max())).sampled()
        watch.note(cost_in_words(by, ready, longest, count))
        subject = replace(subject, engine=by)
    with watch.progress(count, "histories") as progress:
        result = study.overturning_map(subject, form, columns, rows, polarities=signs, progress=progress)
    shown = views.map_view(result, mechanism, dimensionless=bare)
    figure = drawn("questions.overturning.picture.draw_map", result, views.map_title(result), dimensionless=bare)
    return Answer("overturning map", result, shown, partial(views.map_table, result, mechanism), figure)


@takes_numbers
def overturning_curves(
    structures: Sequence[StructureLike],
    *,
    shape: str = "sine",
    model: ModelName = "nonlinear",
    eta: float | None = None,
    period: Range | None = None,
    top: float | None = None,
    polarity: str | int = "1",
    points: int = 60,
    opening: float = OPENING,
    watch: Watcher = SILENT,
) -> Answer[Comparison]:
    """Compute the smallest amplitude that overturns each structure, against the period of a pulse.

    Parameters
    ----------
    structures : sequence of Mechanism, str or Path
        Structures to compare.
    shape, model, eta, polarity, opening
        As for `overturning_map`.
    period : (float, float), optional
        Smallest and largest period [s].
    top : float, optional
        Largest amplitude to try [standard gravity].
    points : int
        Number of periods between them, at equal ratios.
    watch : Watcher
        Shown the progress, and told which structures cannot be used.

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

    form, signs = parse_shape(shape), signs_of(polarity)
    if model != "nonlinear":
        refuse_idle("on linear blocks, which have no joints", opening=opening != OPENING)
    ready = structures_of(structures, watch, opening)
    subjects = [pulsed_model(each, model, form, signs, eta) for each in ready]
    periods = np.geomspace(*(period or study.usual_periods(subjects, form, signs)), points)
    highest = study.usual_amplitudes(subjects)[1] if top is None else top
    count = study.count_scans(subjects, periods.size, signs)
    with watch.progress(count, "histories") as progress:
        result = study.compare(subjects, form, periods, highest, polarities=signs, progress=progress)
    shown = views.comparison_view(result, [each.mechanism for each in ready])
    figure = drawn("questions.overturning.picture.draw_comparison", result, views.comparison_title(result))
    return Answer("overturning curves", result, shown, partial(views.comparison_table, result), figure)
