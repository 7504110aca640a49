"""Corrections, directions and floors of ground motions, in Python."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any

from rocking_cli.ask.answer import Answer, Dimensions, drawn
from rocking_cli.ask.ground_motions import Motion, introduce, motion_of, warn_about
from rocking_cli.ask.groups import FromTilt
from rocking_cli.ask.inputs import doubts_of, structure_of
from rocking_cli.ask.verbs import verb
from rocking_cli.ask.watcher import Watcher
from rocking_cli.errors import InputError, Problem, named
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.excitation.measures import measure
from rocking_cli.processing.reading import Scaled
from rocking_cli.processing.steps import Step, parse_steps, process
from rocking_cli.questions.respond.asked import ByTolerance, OfModels, RespondAroundAsked, RespondAsked
from rocking_cli.structure import Structure
from rocking_cli.views.restitution import heading_of_run

if TYPE_CHECKING:
    from rocking_cli.processing.oscillator import Floor
    from rocking_cli.questions.respond.azimuths import AzimuthResponses


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
    from rocking_cli.processing.oscillator import Floor

    return (floor if isinstance(floor, Floor) else Floor.parse(floor)).of(motion_of(motion))


@verb(RespondAroundAsked)
def respond_around(asked: RespondAroundAsked, watch: Watcher) -> Answer[AzimuthResponses]:
    """Compute the response of a structure in every direction between two components.

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
    from rocking_cli.questions.respond.azimuths import all_around, columns, view

    ready = structure_of(asked.structure)
    pair, models = (motion_of(asked.one), motion_of(asked.other)), asked.models(ready.default_models)
    result = all_around(ready, models, pair, asked.scale, release=asked.ratio(ready), rtol=asked.rtol)

    free = [side.phi_cr is None for side in ready.statics]
    figure = drawn("questions.respond.each_picture.draw_azimuths", result, heading_of_run(ready), free)
    shown = view(ready, result, doubts_of(ready.mechanism))
    dims = [Dimensions(("azimuth",), ("pga_g",)), Dimensions(("model", "azimuth"))]
    return Answer("all directions", result, shown, partial(columns, result), figure, dims=dims)


def all_directions(structure: Structure, asked: RespondAsked, watch: Watcher) -> Answer[AzimuthResponses]:
    """Answer `respond` with `azimuth` "all": read a pair of components, and ask `respond_around`.

    Raises
    ------
    InputError
        If there is not one record, or its components cannot be combined.
    """
    motions = asked.ground_motions
    if motions.count != 1 or not motions.records:
        raise InputError(Problem("all takes a single pair of components: give one record", field=named("azimuth")))
    (record,) = motions.records
    one, other = record.reading(motions.reading).pair(record.path)
    for component in (one, other):
        introduce("component", Scaled(component, 1.0), watch)
        warn_about([component], watch, structure.growth)
    one = with_vertical(asked, Scaled(one, 1.0, record=record), watch).motion
    factor = motions.factor(one, measure(one.of_ground))
    if factor != 1:
        watch.note(f"scaled by {factor:.6g}: PGA = {abs(factor) * one.of_ground.pga_g:.4g} g at 0 degrees")
    given = {**asked.part(OfModels), **asked.part(FromTilt), **asked.part(ByTolerance)}
    return respond_around(structure, one, other, scale=factor, **given)


def with_vertical(asked: RespondAsked, motion: Scaled, watch: Watcher) -> Scaled:
    """Return a motion with its vertical component, if one is given. Raises as `Motions.vertical`."""
    vertical = asked.vertical
    if vertical is None:
        return motion
    if not isinstance(vertical, GroundMotion):
        dt, channel = asked.vertical_dt, asked.vertical_channel
        vertical = asked.ground_motions.vertical(motion, vertical, dt, channel, watch)
    return motion._replace(motion=replace(motion.motion, vertical=vertical))
