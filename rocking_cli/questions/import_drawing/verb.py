"""`rk.import_drawing`: make a structure of a drawing."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from hashlib import sha256
from importlib.util import find_spec
from typing import TYPE_CHECKING

from rocking_cli.ask.answer import Answer, drawn
from rocking_cli.ask.read import read_drawing
from rocking_cli.ask.verbs import verb
from rocking_cli.ask.watcher import Watcher
from rocking_cli.errors import InputError, Problem
from rocking_cli.questions.import_drawing.options import ImportDrawing

if TYPE_CHECKING:
    from rocking_cli.io.tables import Columns
    from rocking_cli.questions.import_drawing.study import Imported


@verb(ImportDrawing)
def import_drawing(asked: ImportDrawing, watch: Watcher) -> Answer[Imported]:
    """Make a structure of a drawing: DXF, SVG, GeoJSON, a table of vertices, a model of blocks.

    Returns
    -------
    Answer of Imported
        `structure` is the structure; all verbs take the answer in its place. `bodies`, `joints` and `notes` show what
        was read, mended, assumed and left out; `text` is the file.

    Raises
    ------
    InputError
        If an argument or the file cannot be used; a `DrawingError` has the class of the reason, and the places.

    Notes
    -----
    Areas, centroids and inertias of outlines with arcs are exact; a `rigid_body` gets 128 straight sides to a half turn
    that keep the area.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> import rocking_cli as rk
    >>> with TemporaryDirectory() as folder:
    ...     file = Path(folder) / "pillar.csv"
    ...     _ = file.write_text("0,0\\n600,0\\n600,2400\\n0,2400\\n")
    ...     answer = rk.import_drawing(file, units="mm")
    >>> answer.structure.uplift(rk.Direction.POSITIVE)
    0.25
    """
    from rocking_cli.core.structure_file import default_name, fields_text
    from rocking_cli.io.drawings.contract import MeshSurface
    from rocking_cli.io.files import write_whole
    from rocking_cli.questions.import_drawing.study import structure_from
    from rocking_cli.questions.import_drawing.view import sentences, view

    if find_spec("shapely") is None:
        raise InputError(Problem("a drawing needs the package shapely", hint="pip install 'rocking-cli[drawing]'"))
    file, out = str(asked.file), asked.out
    drawing, data = read_drawing(file, asked.plane)
    if isinstance(drawing, MeshSurface):
        raise InputError(Problem("this is a mesh", file, hint="use rk.import_mesh"))
    name = default_name(file)
    made = structure_from(drawing, asked, name, file)
    origin = asked.origin or "rk.import_drawing"
    source = f"From {asked.file.name}, SHA-256 {sha256(data).hexdigest()}, by `{origin}`"
    text = fields_text(made.kind, made.fields, [source, *sentences(made.notes)], made.comments)
    made = replace(made, text=text)
    if out is not None:
        write_whole(out, lambda stream: stream.write(text.encode("utf-8")))
        watch.note(f"wrote {out}")
    figure = drawn("questions.import_drawing.picture.draw_import", made, f"{name}: {made.kind}", asked.tolerance)
    shown = view(made, file, None if out is None else str(out))
    return Answer("import", made, shown, partial(_columns, made), figure)


def _columns(made: Imported) -> Columns:
    from rocking_cli.questions.import_drawing.view import BODIES
    from rocking_cli.views.column import frame_of

    return frame_of(BODIES, made.bodies)
