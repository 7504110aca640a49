"""View of an import, as text and as data."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from rocking_cli.questions.import_drawing.notes import ImportNote
from rocking_cli.questions.import_drawing.outlines import DrawnBody
from rocking_cli.questions.import_drawing.study import Imported
from rocking_cli.text import in_short, seen
from rocking_cli.views.column import Column, data_of, table_of
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
