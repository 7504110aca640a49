"""`rk.import_mesh`: make a structure of the mesh of a body, such as the scan of a statue."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from hashlib import sha256
from pathlib import Path
from textwrap import wrap
from typing import TYPE_CHECKING

from rocking_cli.ask.answer import Answer, drawn
from rocking_cli.ask.read import read_drawing
from rocking_cli.ask.verbs import verb
from rocking_cli.ask.watcher import Watcher
from rocking_cli.errors import InputError, Problem, RockingError, named
from rocking_cli.questions.import_mesh.options import ImportMesh
from rocking_cli.text import one_line

if TYPE_CHECKING:
    from rocking_cli.questions.import_mesh.solid import AzimuthRow
    from rocking_cli.questions.import_mesh.study import ImportedMesh

COMMENT_WIDTH = 110


@verb(ImportMesh)
def import_mesh(asked: ImportMesh, watch: Watcher) -> Answer[ImportedMesh]:
    """Make a structure of the mesh of a body, such as the scan of a statue: OBJ, PLY or STL.

    By default the body rocks over its weakest edge, driven by the whole motion; of several azimuths each makes a
    structure, such as `statue-030.yaml`.

    Returns
    -------
    Answer of ImportedMesh
        The foot, its edges, how the body starts to rock at each azimuth, what was done to the mesh, and `structures`.

    Raises
    ------
    InputError
        If a value is not valid, or a file cannot be read or written. A `DrawingError` has the reason in `refused`, such
        as "units", "open", "point" or "falls".

    Notes
    -----
    In a direction a, lambda is t(a)/h: the way from below the centre of mass to the rim of the foot, over the height of
    the centre of mass. The body rocks over the edge it meets there, with the critical rotation of this edge.

    Examples
    --------
    A tetrahedron on the ground, towards one of its sides and away from it:

    >>> import rocking_cli as rk
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> mesh = "v 0 0 0\\nv 1 0 0\\nv 0 1 0\\nv 0 0 4\\nf 1 3 2\\nf 1 2 4\\nf 2 3 4\\nf 1 4 3\\n"
    >>> with TemporaryDirectory() as folder:
    ...     path = Path(folder) / "spire.obj"
    ...     _ = path.write_text(mesh)
    ...     answer = rk.import_mesh(path, units="m", azimuth=[270, 90])
    >>> [round(row.lambda_, 12) for row in answer.azimuths]
    [0.25, 0.5]
    """
    from rocking_cli.core.structure_file import structure_text
    from rocking_cli.io.drawings.contract import MeshSurface
    from rocking_cli.io.files import check_writable, keep_apart
    from rocking_cli.questions.import_mesh.study import imported
    from rocking_cli.questions.import_mesh.view import columns, sentences, view

    file, origin = str(asked.file), asked.origin or "rk.import_mesh"
    places = [] if asked.out is None else places_of(asked.out, asked.azimuth)
    keep_apart([(named("out"), place) for place in places], [file])
    for place in places:
        check_writable(place)
    surface, content = read_drawing(file)
    if not isinstance(surface, MeshSurface):
        raise InputError(Problem("this is a drawing, not a mesh", file, hint="use rk.import_drawing"))
    body, name = imported(surface, file, asked, asked.azimuth), one_line(asked.file.name)
    written = list[str]()
    rows: list[AzimuthRow | None] = [*body.azimuths] or [None]
    for place, structure, row in zip(places, body.structures if places else (), rows, strict=False):
        edge = body.weakest if row is None else row.edge
        where = "over its weakest edge" if row is None else f"towards {row.azimuth:g} degrees"
        at = ", ".join(f"{each:.7g}" for each in body.shift)
        head = [
            f"The body of {name}, rocking {where}, by: {origin}",
            f"SHA-256 of the mesh: {sha256(content).hexdigest()}",
            f"It turns over edge {edge.number} of {len(body.edges)}, whose normal, here to the right, is at "
            f"{edge.azimuth:.6g} degrees. x = 0 is below its centre of mass, at ({at}) m in the mesh.",
            *sentences(body),
        ]
        lines = [line for each in head for line in wrap(one_line(each), COMMENT_WIDTH, break_on_hyphens=False)]
        written += _write(place, structure_text(structure, *lines), watch)
    if asked.page is not None:
        from rocking_cli.questions.import_mesh.picture import render

        written += _write(asked.page, render(body, f"{name} as a rocking body", [origin], asked.north), watch)
    title = f"{name}: foot from below the centre of mass, over its height"
    figure = drawn("questions.import_mesh.picture.draw_compass", body, title, asked.north)
    return Answer("imported mesh", body, view(body, written), partial(columns, body), figure)


def places_of(out: Path, azimuths: Sequence[float]) -> list[Path]:
    """Return the files of the structures: one name, or several with the azimuths in them."""
    if len(azimuths) < 2:
        return [out]
    names = [f"{each % 360:07.3f}".rstrip("0").rstrip(".") for each in azimuths]
    return [out.with_name(f"{out.stem}-{name}{out.suffix}") for name in names]


def _write(place: Path, text: str, watch: Watcher) -> list[str]:
    """Write a file, and return its name; an error is told to the watcher."""
    from rocking_cli.io.files import write_whole

    try:
        write_whole(place, lambda stream: stream.write(text.encode("utf-8")))
    except RockingError as error:
        watch.unwritten(error)
        return []
    watch.note(f"wrote {place}")
    return [str(place)]
