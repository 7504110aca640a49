"""`rk.draw`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rocking_cli.ask.answer import Answer
from rocking_cli.ask.given import StructureLike, structure_of
from rocking_cli.views.view import heading

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rocking_cli.io.tables import Columns
    from rocking_cli.studies.picture import Picture


def draw(structure: StructureLike, *, at: float | None = None) -> Answer[Picture]:
    """Draw a structure at rest with its dimensions, and displaced in both directions.

    Parameters
    ----------
    structure : Mechanism, str or Path
        The structure, or its YAML file.
    at : float, optional
        Rotation to draw, as a multiple of phi_cr, or of the kinematic limit if there is no phi_cr; at most the
        kinematic limit. By default 1, or a rotation that is easy to see.

    Returns
    -------
    Answer of Picture
        Parts of the structure, its dimensions, and the positions of the parts at any rotation.

    Raises
    ------
    InputError
        If a value is out of range, or a file cannot be used.
    MechanismError
        If the structure has no critical rotation or no uplift acceleration.

    Notes
    -----
    Rotations and phi_cr as in DeJong and Dimitrakopoulos (2014), Section 3.
    """
    from rocking_cli.studies.picture import picture
    from rocking_cli.views.draw import view

    mechanism = structure_of(structure).mechanism
    found = picture(mechanism)

    def figure() -> Figure:
        from rocking_cli.plotting.structure import draw_structure

        return draw_structure(found, heading(mechanism), None if at is None else min(at, found.furthest))

    def columns() -> Columns:
        said = [each.text for each in found.sketch.lengths]
        return {"length": said}

    return Answer("drawing", found, view(found), columns, figure)
