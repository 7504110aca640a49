"""`rk.respond` of a single free body in three dimensions: its motion, and what is shown of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking_cli.ask.answer import Answer
from rocking_cli.ask.ground_motions import introduce, pulse_in
from rocking_cli.ask.verbs import write_files
from rocking_cli.ask.watcher import Watcher
from rocking_cli.dynamics.history import History
from rocking_cli.errors import InputError, Problem, RockingError, named, renamed
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.names import OVERTURNS, ROCKS, STILL_ROCKING, UNKNOWN
from rocking_cli.processing.reading import OF_PAIRS, Scaled
from rocking_cli.questions.respond.asked import RespondAsked
from rocking_cli.questions.respond.motion_verbs import with_vertical
from rocking_cli.structure import Structure
from rocking_cli.studies.engines import follow
from rocking_cli.studies.engines.solid_body import SolidBody, common_fields, solid_of
from rocking_cli.studies.engines.space import follow_twice
from rocking_cli.studies.engines.space_history import CheckedHistory, SpaceHistory
from rocking_cli.views.column import Column, data_of, of, rounded, table_across
from rocking_cli.views.view import Aside, View, heading, number

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rocking_cli.io.tables import Columns

NOISE = 1e-6  # m and rad, below which a motion is shown as 0


@dataclass(frozen=True, eq=False)
class SpaceResponse:
    """The motion of a body in three dimensions, and that of one degree of freedom about its weaker side.

    Parameters
    ----------
    motions : sequence of GroundMotion or None
        Components of the ground motion along x, y and z.
    checked : CheckedHistory
        The motion in three dimensions.
    plane : History or None
        The motion under x alone by one degree of freedom; None if it has none.
    """

    motions: Sequence[GroundMotion | None]
    checked: CheckedHistory
    plane: History | None


def in_space(structure: Structure, asked: RespondAsked, watch: Watcher) -> Answer[SpaceResponse]:
    """Answer `respond` in three dimensions.

    Raises
    ------
    InputError
        If the structure is not a free body whose shape is known, or a file cannot be used.
    """
    solid = solid_of(structure.mechanism) if asked.mesh is None else _of_mesh(structure, asked)
    motions, of_both = asked.ground_motions, asked.vertical is not None or asked.transverse is not None
    (chosen,) = motions.gather(structure.growth, watch, with_vertical=of_both)
    chosen = with_vertical(asked, chosen, watch)
    factor = chosen.factor * asked.signs[0]
    x, y = chosen.motion.scaled(factor), _transverse(asked, chosen, watch)
    components = (replace(x, vertical=None), None if y is None else y.scaled(factor), x.vertical)
    answer = SpaceResponse(components, follow_twice(solid, *components), _in_the_plane(structure, components[0]))
    shown, figure = _view(structure, answer), partial(_figure, answer, heading(structure.mechanism))
    answered = Answer("response in three dimensions", answer, shown, partial(_columns, answer), figure)
    write_files(answered, asked, watch)
    return answered


def _of_mesh(structure: Structure, asked: RespondAsked) -> SolidBody:
    """Return the body of a mesh, with friction and gravity of the structure that was made of it."""
    from rocking_cli.ask.read import read_drawing
    from rocking_cli.io.drawings.contract import MeshSurface
    from rocking_cli.questions.import_mesh.options import MeshOptions
    from rocking_cli.questions.import_mesh.solid import hull_of
    from rocking_cli.questions.import_mesh.study import imported

    common, file = common_fields(structure.mechanism), str(asked.mesh)
    surface, _ = read_drawing(file)
    if not isinstance(surface, MeshSurface):
        raise InputError(Problem("is a drawing, not a mesh", file, field=named("mesh")))
    with renamed({"units": "mesh_units"}):
        body = imported(surface, file, MeshOptions(units=asked.mesh_units))
    points = body.points[np.unique(hull_of(body.points, file)[1])]
    points[points[:, 2] <= body.options.level, 2] = 0.0  # its foot, as `rocking import` has it
    inertia = body.whole.inertia / body.whole.volume
    return SolidBody(points=points, level=body.height, inertia=inertia, **common).checked()


def _transverse(asked: RespondAsked, chosen: Scaled, watch: Watcher) -> GroundMotion | None:
    """Return the transverse component, read and corrected as the other."""
    given, motions = asked.transverse, asked.ground_motions
    if given is None or isinstance(given, GroundMotion):
        return given
    if (pulse := pulse_in(given)) is not None:
        return motions.reading.on_floor(pulse.sampled())
    reading = motions.reading if chosen.record is None else chosen.record.reading(motions.reading)
    reading = reading.without("channel", *OF_PAIRS)
    if asked.transverse_channel is not None:
        reading = replace(reading, options={**reading.options, "channel": asked.transverse_channel})
    with renamed({"channel": "transverse_channel"}):
        component = reading.read(given)
    introduce("transverse", Scaled(component, 1.0), watch)
    return component


def _in_the_plane(structure: Structure, motion: GroundMotion) -> History | None:
    """Return the motion about the weaker side by one degree of freedom; None if it has none that is known."""
    try:
        return follow(structure.of(structure.mechanism.weaker_side() or structure.mechanism), motion)
    except RockingError:  # as of a stocky body, whose restitution is not known
        return None


def _in_words(each: SpaceHistory | History, word: str, over: str) -> str:
    """Return what a body does, a predicate."""
    if word == OVERTURNS:
        return f"{word} at {each.overturning_time:.4g} s"
    return f"{word} to {each.peak_ratio:.4g} of {over}" if word == ROCKS else word


def _resolved(value: float) -> str:
    """Format a length [m] or an angle [rad]; what is below a micrometre is noise."""
    return number(value * (abs(value) > NOISE), 3)


ROWS: tuple[Column[SpaceHistory], ...] = (
    Column("outcome", of("outcome"), head="outcome", text=True),
    Column("peak_ratio", of("peak_ratio"), "", "largest tilt over alpha", rounded(4)),
    Column("peak_tilt", lambda row: float(row.tilt.max()), "rad", "largest tilt", rounded(4)),
    Column("overturning_time", of("overturning_time"), "s", "overturning time", rounded(4)),
    Column("largest_twist", lambda row: float(np.abs(row.twist).max()), "rad", "largest turn", _resolved),
    Column("residual_twist", lambda row: float(row.twist[-1]), "rad", "residual turn", _resolved),
    Column("rolled", of("rolled"), "m", "length on which its rim rolls", _resolved),
    Column("largest_path", lambda row: float(row.path.max()), "m", "largest displacement of its base", _resolved),
    Column("residual_path", lambda row: float(row.path[-1]), "m", "residual displacement of its base", _resolved),
)  # fmt: skip


def _view(structure: Structure, response: SpaceResponse) -> View:
    """Show the motion of a body in three dimensions."""
    checked, plane, solid = response.checked, response.plane, response.checked.history.solid
    doing = _in_words(checked.history, checked.outcome, "alpha")
    doing = {STILL_ROCKING: "is still rocking", UNKNOWN: f"has an unknown outcome: {checked.doubt}"}.get(doing, doing)
    sentences = [f"In three dimensions (experimental) the body {doing}."]
    if plane is not None:
        side = "" if structure.mechanism.weaker_side() is None else ", about its depth, the weaker side"
        alone = _in_words(plane, plane.words, "phi_cr")
        sentences.append(f"In the plane{side}, under the component along x alone, by one degree of freedom: {alone}.")
    if loose := checked.unsettled:
        sentences.append(f"Do not rely on {loose}: half of step and softness makes a difference of more than 10 %.")
    if solid.assumes_friction:
        sentences.append(f"Its friction is assumed to be {solid.friction:g}, as the file gives none.")
    terms = (
        f"Alpha, {solid.alpha:.4g} rad, is the tilt about the weaker side of its foot at which its centroid is above. "
        "A turn is a rotation about its axis; displacements are those of the point of its base below the centroid. "
        f"The body has overturned when its axis has tilted by {solid.fallen:.4g} rad."
    )
    histories = [checked.history, checked.halved]
    table = table_across("", ROWS, ["step by the rule", "half of step and softness"], histories)
    return View(partial(_data, structure, response), [heading(structure.mechanism), *sentences, table, Aside(terms)])


def _data(structure: Structure, response: SpaceResponse) -> dict[str, Any]:
    checked, plane, solid = response.checked, response.plane, response.checked.history.solid
    return {
        "structure": {"mechanism": structure.mechanism.mechanism, "name": structure.mechanism.name},
        "experimental": True,
        "components": [None if each is None else each.name for each in response.motions],
        "alpha": solid.alpha,
        "friction": solid.friction,
        "outcome": checked.outcome,
        "doubt": checked.doubt or None,
        "history": data_of(ROWS, checked.history),
        "halved": data_of(ROWS, checked.halved),
        "plane": plane and {"outcome": plane.words, "peak_ratio": plane.peak_ratio},
    }


def _columns(response: SpaceResponse) -> Columns:
    history = response.checked.history
    x, y, _ = history.moved.T
    return {
        "t [s]": history.time, "tilt [rad]": history.tilt, "azimuth [rad]": history.azimuth,
        "twist [rad]": history.twist, "x [m]": x, "y [m]": y,
    }  # fmt: skip


def _figure(response: SpaceResponse, title: str) -> Figure:
    """Plot the tilt over time, and the path of the base."""
    from rocking_cli.plotting import style

    history = response.checked.history
    figure, ((above,), (below,)) = style.panels(6.4, 2)
    style.heading(above, f"{title}, in three dimensions (experimental): {response.checked.outcome}")
    above.plot(history.time, history.tilt / history.solid.alpha, **style.family(0))
    above.set_xlabel("t [s]")
    above.set_ylabel(r"tilt/$\alpha$")
    below.plot(*history.moved[:, :2].T, **style.family(0))
    below.set_xlabel("x of the base [m]")
    below.set_ylabel("y of the base [m]")
    below.set_aspect("equal", adjustable="datalim")
    return figure
