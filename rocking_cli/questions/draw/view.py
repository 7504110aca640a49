"""View of the drawing of a structure, as text and as data."""

from __future__ import annotations

from rocking_cli.core import Angle, Length
from rocking_cli.studies.picture import Picture
from rocking_cli.views.view import View, heading


def view(picture: Picture) -> View:
    """Show the dimensions of a structure, and its drawing as plain data."""
    measured: list[Length | Angle] = [*picture.sketch.lengths, *picture.sketch.angles]
    sentences = [
        f"{each.text}{f' ({each.direction.label})' if each.direction is not None else ''}" for each in measured
    ]
    sentences += [f"load {each.name}, {each.text}" for each in picture.loads if each.name]
    sentences += [f"tie {each.name}" for each in picture.ties if each.name]
    sentences += [f"rocks in the {side} direction only" for side in [picture.mechanism.one_sided] if side]
    return View(
        picture.as_dict, [heading(picture.mechanism), *(f"  {each}" for each in [*sentences, *picture.sketch.notes])]
    )
