"""`rk.import_drawing`: make a structure of a drawing, and show it as text and as data."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from hashlib import sha256
from importlib.util import find_spec
from typing import Any

from rocking_cli.ask.answer import Answer, drawn
from rocking_cli.ask.read import read_drawing
from rocking_cli.ask.verbs import verb
from rocking_cli.ask.watcher import Watcher
from rocking_cli.errors import InputError, Problem
from rocking_cli.questions.import_drawing.legend import ImportNote
from rocking_cli.questions.import_drawing.options import ImportDrawing
from rocking_cli.questions.import_drawing.outlines import DrawnBody
from rocking_cli.questions.import_drawing.study import Imported, structure_from
from rocking_cli.text import in_short, seen
from rocking_cli.views.column import Column, data_of, frame_of, table_of
from rocking_cli.views.view import Table, View, number

MAX_ROWS = 24  # bodies that are listed
LEFT_OUT = "left out"


def _pair(z: complex) -> list[float]:
    return [z.real, z.imag]


BODIES: tuple[Column[DrawnBody], ...] = (
    Column("name", lambda body: body.name, head="body", text=True),
    Column("layer", lambda body: body.layer, head="layer", form=seen, text=True),
    Column("source_handles", lambda body: [each.handle for each in body.sources if each.handle], name=None),
    Column("area", lambda body: body.moments.area, "m2", "area\n[m2]", number),
    Column("centroid", lambda body: _pair(body.moments.centroid), name=None),
    Column(None, lambda body: body.moments.centroid.real, "m", "x\n[m]", number, "x"),
    Column(None, lambda body: body.moments.centroid.imag, "m", "y\n[m]", number, "y"),
    Column("density", lambda body: body.density, "kg/m3", "density\n[kg/m3]", number),
    Column("openings", lambda body: len(body.openings), head="openings"),
)


def sentences(notes: Sequence[ImportNote]) -> list[str]:
    """Return the notes as sentences; what is left out is one."""
    left = [note for note in notes if note.kind == LEFT_OUT]
    lines = [f"{note.words[0].upper()}{note.words[1:]}." for note in notes if note.kind != LEFT_OUT]
    if left:
        parts = in_short([note.words.removeprefix(f"{LEFT_OUT}: ") for note in left], "; ", most=12)
        lines.append(f"Left out: {parts}.")
    return lines


def view(found: Imported, file: str, out: str | None) -> View:
    """Show the bodies of a drawing and what was mended, assumed and left out."""
    shown = found.bodies[:MAX_ROWS]
    parts: list[Table | str] = [
        f"{found.kind}: {len(found.bodies):,} {'body' if len(found.bodies) == 1 else 'bodies'}, "
        f"{len(found.joints):,} joint{'' if len(found.joints) == 1 else 's'}.",
        table_of("", BODIES, shown),
    ]
    if more := len(found.bodies) - len(shown):
        parts.append(f"{more:,} more bodies are in the file and in the JSON output.")
    parts += sentences(found.notes)
    if out is not None:
        verb = "collapse" if found.kind == "assembly" else "equiv"
        parts.append(f"Next: check it by `rocking draw {out}`, then `rocking {verb} {out}`.")
    return View(lambda: data(found, file), parts)


def data(found: Imported, file: str) -> dict[str, Any]:
    """Return an import as plain data."""
    return {
        "file": file,
        "kind": found.kind,
        "units": {"words": found.units, "metres": found.per_unit},
        "shift": _pair(found.shift),
        "bodies": [data_of(BODIES, body) for body in found.bodies],
        "joints": [{"between": list(each.between), "ends": [_pair(end) for end in each.ends]} for each in found.joints],
        "notes": [
            {"kind": note.kind, "count": note.count, "words": note.words, "at": [_pair(z) for z in note.at]}
            for note in found.notes
        ],
        "dropped": sum(note.count for note in found.notes if note.kind == LEFT_OUT),
    }


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
    return Answer("import", made, shown, partial(frame_of, BODIES, made.bodies), figure)
