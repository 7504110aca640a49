"""`rk.draw`: draw a structure at rest and displaced."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from rocking_cli.ask.answer import Answer, drawn
from rocking_cli.ask.inputs import structure_of
from rocking_cli.ask.verbs import verb
from rocking_cli.ask.watcher import Watcher
from rocking_cli.errors import InputError, Problem, named
from rocking_cli.questions.draw.asked import DrawAsked
from rocking_cli.views.view import View, heading

if TYPE_CHECKING:
    from rocking_cli.core import Angle, Length
    from rocking_cli.studies.picture import Picture


@verb(DrawAsked)
def draw(asked: DrawAsked, watch: Watcher) -> Answer[Any]:
    """Draw a structure at rest with its dimensions, and displaced in both directions.

    Returns
    -------
    Answer of Picture
        Parts of the structure, its dimensions, and the positions of the parts at any rotation; of a building its walls.

    Raises
    ------
    InputError
        If a value is out of range, or a file cannot be used.
    MechanismError
        If the structure has no critical rotation or no uplift acceleration.

    Notes
    -----
    Rotations and phi_cr as in DeJong and Dimitrakopoulos (2014), Section 3.

    Examples
    --------
    >>> import rocking_cli as rk
    >>> answer = rk.draw(rk.Block(width=0.7, height=2.8), at=0.5)
    >>> [length.text for length in answer.sketch.lengths]
    ['2b = 0.7 m', '2h = 2.8 m', 'R = 1.44 m']
    """
    from rocking_cli.questions.building.description import is_building
    from rocking_cli.studies.picture import picture

    if is_building(asked.structure):
        return _of_building(Path(str(asked.structure)), asked)
    at, ready = asked.at, structure_of(asked.structure, watch)
    with ready.named():
        drawing = picture(ready.mechanism)
    if at is not None and at > drawing.furthest:
        of = "the limit" if None in drawing.phi_cr.values() else "phi_cr"
        what = f"{at:g} times {of} is beyond the kinematic limit of the mechanism"
        raise InputError(Problem(what, field=named("at"), hint=f"at most {drawing.furthest:.4g} times {of}"))
    if asked.dxf is not None:
        _write(asked.dxf, drawing, at, watch)
    figure = drawn("plotting.structure.draw_structure", drawing, heading(ready.mechanism), at)
    lengths = {"length": [each.text for each in drawing.sketch.lengths]}
    return Answer("drawing", drawing, _view(drawing), lambda: lengths, figure)


def _of_building(file: Path, asked: DrawAsked) -> Answer[Any]:
    """Return the walls of a building, from outside and in section."""
    from rocking_cli.questions.building.description import read_building
    from rocking_cli.questions.building.view import words

    for name in ("at", "dxf"):
        if asked.has(name):
            raise InputError(Problem("has no effect on a building", field=named(name), hint="leave it out"))
    house = read_building(file)
    say = words(house.language or "en")
    figure = drawn("questions.building.picture.draw_description", house, say)
    sizes = [f"{each.name}: {each.length:g} m long" for each in house.walls]
    shown = View(
        house.model_dump(exclude_unset=True), [house.name or say("building"), *(f"  {each}" for each in sizes)]
    )
    return Answer("drawing", house, shown, lambda: {"wall": [each.name for each in house.walls]}, figure)


def _write(file: Path, drawing: Picture, at: float | None, watch: Watcher) -> None:
    """Write a drawing as a DXF file, and tell before what it cannot hold."""
    from rocking_cli.io.files import write_whole
    from rocking_cli.questions.draw.drawing_file import drawn_file

    content, options, untold = drawn_file(drawing, at)
    if untold:
        watch.warn(f"{file} does not tell {untold}: add it to the structure that you import")
    write_whole(file, lambda stream: stream.write(content))
    watch.note(f"wrote {file}" + (f": import it with {options}" if options else ""))


def _view(picture: Picture) -> View:
    """Show the dimensions of a structure, and its drawing as plain data."""
    measured: list[Length | Angle] = [*picture.sketch.lengths, *picture.sketch.angles]
    sides = (f" ({each.direction.label})" if each.direction is not None else "" for each in measured)
    sentences = [f"{each.text}{side}" for each, side in zip(measured, sides, strict=True)]
    sentences += [f"load {each.name}, {each.text}" for each in picture.loads if each.name]
    sentences += [f"tie {each.name}" for each in picture.ties if each.name]
    sentences += [f"rocks in the {side} direction only" for side in [picture.mechanism.one_sided] if side]
    sentences += picture.sketch.notes
    return View(picture.as_dict, [heading(picture.mechanism), *(f"  {each}" for each in sentences)])
