"""Corrections, directions and floors of ground motions, in Python."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rocking_cli.ask.answer import Answer, MappingAnswer, drawn, no_plot
from rocking_cli.ask.given import StructureLike, doubts_of, models_of, structure_of
from rocking_cli.ask.ground_motions import Motion, Motions, each_of, introduce, motion_of, warn_about
from rocking_cli.ask.numbers import takes_numbers
from rocking_cli.ask.watcher import SILENT, Watcher
from rocking_cli.dynamics.batch import Runs, respond_many
from rocking_cli.dynamics.history import RTOL
from rocking_cli.dynamics.model import MODELS, ModelName
from rocking_cli.dynamics.outcome import OUTCOME_FIELDS, Outcomes
from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.excitation.measures import measure
from rocking_cli.names import OPENING
from rocking_cli.processing.floor import Floor
from rocking_cli.processing.listed import Scaled
from rocking_cli.processing.steps import Step, parse_steps, process
from rocking_cli.questions.respond.azimuths import AzimuthResponses
from rocking_cli.structure import Structure
from rocking_cli.studies.release import Release
from rocking_cli.views.view import View, heading

if TYPE_CHECKING:
    from rocking_cli.io.tables import Columns


def correct(motion: Motion, *steps: Step | str | Mapping[str, Any]) -> GroundMotion:
    """Correct a ground motion, in the order in which the corrections are given.

    Parameters
    ----------
    motion : GroundMotion, Pulse, str or Path
        The motion, its file, or a pulse as text.
    *steps : str
        Corrections such as `"baseline linear"`, `"highpass 0.1"`, `"lowpass 25"`, `"taper 0.05"`, `"trim 2:20"`,
        `"resample 0.005"`: frequencies in Hz, times in s. Mappings such as `{"highpass": 0.1}` are accepted too.

    Returns
    -------
    GroundMotion
        Corrected motion; its `processing` lists the corrections.

    Raises
    ------
    InputError
        If a step does not exist, or cannot be applied to the motion.

    Examples
    --------
    >>> import rocking_cli as rk
    >>> rk.correct("sine:0.3g:0.8s", "lowpass 5").processing
    ('lowpass 5',)
    """
    steps_asked = [step for each in steps for step in ([each] if isinstance(each, Step) else parse_steps([each]))]
    return process(motion_of(motion), steps_asked)


def on_floor(motion: Motion, floor: Floor | str | Mapping[str, Any]) -> GroundMotion:
    """Compute the motion of a floor of a building, by its first mode, from a ground motion.

    Parameters
    ----------
    motion : GroundMotion, Pulse, str or Path
        Ground motion, its file, or a pulse as text.
    floor : Floor, str or mapping
        Floor such as `"T1=0.4,xi=0.05,z=6m,H=9m,n=3"`: period [s], damping ratio, heights of the floor and of the
        building [m], and number of equal storeys. `z/H` may replace both heights, and the participation factor `gamma`
        the storeys.

    Returns
    -------
    GroundMotion
        Motion of the floor; its `ground` is the ground motion.

    Raises
    ------
    InputError
        If the floor is not valid.
    """
    return (floor if isinstance(floor, Floor) else Floor.parse(floor)).of(motion_of(motion))


@takes_numbers
def respond_around(
    structure: StructureLike,
    one: Motion,
    other: Motion,
    *,
    models: str | Sequence[str] | None = None,
    scale: float = 1.0,
    release: Release | float | str | None = None,
    rtol: float = RTOL,
) -> Answer[AzimuthResponses]:
    """Compute the response of a structure in every direction between two components.

    Parameters
    ----------
    structure : Mechanism, str or Path
        The structure, or its YAML file.
    one, other : GroundMotion, Pulse, str or Path
        The components at 0 and at 90 degrees, of equal length and sampling interval.
    models : str or sequence of str, optional
        Models "nonlinear", "linear1" or "linear2"; all by default.
    scale : float
        Scale factor on both.
    release : float or str, optional
        Initial tilt of a release from rest: a fraction of phi_cr, or an angle such as "0.05rad".
    rtol : float
        Relative error tolerance per step of the nonlinear integration.

    Returns
    -------
    Answer of AzimuthResponses
        `azimuths` [deg], and `outcomes` of each model at them.

    Raises
    ------
    InputError
        If a value is out of range, or the components cannot be combined.
    SolverError
        If a motion cannot be simulated.
    """
    from rocking_cli.questions.respond.azimuths import all_around
    from rocking_cli.questions.respond.azimuths_view import columns, view

    ready = structure_of(structure)
    chosen = models_of(models) if models is not None else ready.default_models
    tilt = release if release is None or isinstance(release, Release) else Release.of(release)
    ratio = tilt.ratio(ready) if tilt is not None else None
    result = all_around(ready, chosen, (motion_of(one), motion_of(other)), scale, release=ratio, rtol=rtol)

    free = [side.phi_cr is None for side in ready.statics]
    figure = drawn("questions.respond.azimuths_picture.draw_azimuths", result, heading(ready.mechanism), free)
    shown = view(ready, result, doubts_of(ready.mechanism))
    return Answer("all directions", result, shown, partial(columns, result), figure)


def all_directions(
    structure: Structure, motions: Motions, vertical: tuple[Any, Any, Any], *, watch: Watcher = SILENT, **question: Any
) -> Any:
    """Answer `respond` with `azimuth` "all": read a pair of components, and ask `respond_around`.

    Parameters
    ----------
    structure : Structure
        The structure.
    motions : Motions
        One record with a second component.
    vertical : tuple
        The vertical component or its file, or None; its sampling interval and its channel.
    watch : Watcher
        Told what was read, and what is doubtful about it.
    **question
        Further arguments of `respond_around`.

    Returns
    -------
    Answer of AzimuthResponses

    Raises
    ------
    InputError
        If there is not one record, or its components cannot be combined.
    """
    if motions.count != 1 or not motions.records:
        raise InputError(Problem("all takes a single pair of components: give one record", field="`azimuth`"))
    (record,) = motions.records
    one, other = record.reading(motions.reading).pair(record.path)
    for component in (one, other):
        introduce("component", Scaled(component, 1.0), watch)
        warn_about([component], watch, structure.growth)
    given, dt, channel = vertical
    if given is not None:
        if not isinstance(given, GroundMotion):
            given = motions.vertical(Scaled(one, 1.0, record=record), given, dt, channel, watch)
        one = replace(one, vertical=given)
    factor = motions.factor(one, measure(one.of_ground))
    if factor != 1:
        watch.note(f"scaled by {factor:.6g}: PGA = {abs(factor) * one.of_ground.pga_g:.4g} g at 0 degrees")
    return respond_around(structure, one, other, scale=factor, **question)


@takes_numbers
def respond_each(
    structures: StructureLike | Sequence[StructureLike],
    motions: Motion | Sequence[Motion],
    *,
    models: str | Sequence[str] | None = None,
    scales: ArrayLike = 1.0,
    threads: int | None = None,
    opening: float = OPENING,
    watch: Watcher = SILENT,
) -> MappingAnswer[ModelName, Outcomes]:
    """Compute the outcome of every structure under every motion with every scale factor.

    Parameters
    ----------
    structures, motions
        One or several, as for `respond`.
    models : str or sequence of str, optional
        Models "nonlinear", "linear1" or "linear2"; all by default.
    scales : array_like
        Scale factors on the motions; negative ones reverse them.
    threads : int, optional
        Number of time histories at a time; by default, one for each processor.
    opening : float
        Largest opening of a joint up to which a history is valid, over D_cr.
    watch : Watcher
        Told what is doubtful about the structures.

    Returns
    -------
    MappingAnswer of str to Outcome
        Arrays of shape (structures, motions, scales), by model; `failed` marks motions that could not be simulated, and
        `unknown` those whose outcome is unknown from `known_to` on: their `overturned` is NaN, and `share()` gives the
        lowest and the highest share of the motions that overturn.

    Raises
    ------
    InputError
        If a value is out of range, or a file cannot be used.
    MechanismError
        If the structure has no critical rotation or no uplift acceleration.

    Notes
    -----
    Every time history is identical, bit for bit, to that of `respond`: Eqs. 8 and 16 of DeJong and Dimitrakopoulos
    (2014).

    Examples
    --------
    >>> import rocking_cli as rk
    >>> blocks = [rk.Block(width=0.7, height=2.8), rk.Block(width=0.5, height=2.8)]
    >>> answer = rk.respond_each(blocks, "sine:0.4g:0.8s", models="nonlinear", scales=[0.5, 1.0])
    >>> answer["nonlinear"].overturned.tolist()
    [[[0.0, 1.0]], [[0.0, 1.0]]]
    >>> answer["nonlinear"].share()
    (0.5, 0.5)
    """
    ready = [structure_of(each, watch, opening) for each in each_of(structures)]
    shaking = [motion_of(each) for each in each_of(motions)]
    factors = np.atleast_1d(np.asarray(scales, dtype=np.float64))
    if factors.ndim > 1:
        raise InputError(
            Problem(f"must be one factor or a list of them, got an array of shape {factors.shape}", field="scales")
        )
    shape = len(ready), len(shaking), factors.size
    chosen = models_of(models)
    if models is None and any(len(each.default_models) < len(MODELS) for each in ready):
        chosen = ("nonlinear",)
    outcomes: dict[ModelName, Outcomes] = {}
    for name in chosen:
        runs = Runs.every(len(ready), len(shaking), scales=factors.tolist())
        many = respond_many([each.model(name) for each in ready], shaking, runs, threads=threads)
        outcomes[name] = many.by_field(lambda values: values.reshape(shape))

    def columns() -> Columns:
        places = [axis.ravel() for axis in np.indices(shape)]
        table: dict[str, Any] = {
            "structure": [ready[k].name for k in places[0]],
            "motion": [shaking[k].name for k in places[1]],
            "scale": factors[places[2]],
        }
        for name, outcome in outcomes.items():
            for column in ("overturned", "peak_ratio", "uplift_time", "overturning_time", "impact_count"):
                table[f"{name} {column}"] = getattr(outcome, column).ravel()
            if outcome.unknown.any():
                table |= {f"{name} {column}": getattr(outcome, column).ravel() for column in ("unknown", "known_to")}
        return table

    first = outcomes[chosen[0]]
    sentence = f"By the {chosen[0]} model {int(first.fell.sum())} of {first.fell.size} motions overturn"
    sentence += f", and the outcome of {int(first.unknown.sum())} is unknown." if first.unknown.any() else "."
    data: dict[str, Any] = {}
    for name, each in outcomes.items():
        data[name] = {"overturned": _with_gaps(each.fell, each.unknown | each.failed)}
        data[name] |= {column: getattr(each, column) for column in OUTCOME_FIELDS}
        if name == "nonlinear" and np.isnan(each.opening).any():
            data[name]["unknown"] = _with_gaps(each.unknown, np.isnan(each.opening) & ~each.unknown)
    figure = no_plot("many responses have no plot of their own: plot a spectrum, a map or a margin")
    return MappingAnswer("responses", outcomes, View(data, [sentence]), columns, figure)


def _with_gaps(values: NDArray[np.bool_], missing: NDArray[np.bool_]) -> Any:
    """Return values as nested lists, with None where they are missing."""
    objects = values.astype(object)
    objects[missing] = None
    return objects.tolist()
