"""Corrections, directions and floors of ground motions, in Python."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any

from rocking_cli.ask.answer import Answer, drawn
from rocking_cli.ask.given import StructureLike, doubts_of, models_of, structure_of
from rocking_cli.ask.ground_motions import Motion, Motions, introduce, motion_of, warn_about
from rocking_cli.ask.numbers import takes_numbers
from rocking_cli.ask.watcher import SILENT, Watcher
from rocking_cli.dynamics.history import RTOL
from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.excitation.measures import measure
from rocking_cli.processing.floor import Floor
from rocking_cli.processing.listed import Scaled
from rocking_cli.processing.steps import Step, parse_steps, process
from rocking_cli.questions.respond.azimuths import AzimuthResponses
from rocking_cli.structure import Structure
from rocking_cli.studies.release import Release
from rocking_cli.views.view import heading

if TYPE_CHECKING:
    pass


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
