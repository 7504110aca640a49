"""`rk.import_drawing`: make a structure of a drawing."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from hashlib import sha256
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from rocking_cli.ask.answer import Answer, drawn
from rocking_cli.ask.drawings import density_of, length_of, read_drawing
from rocking_cli.ask.numbers import takes_numbers
from rocking_cli.ask.watcher import SILENT, Watcher
from rocking_cli.errors import InputError, Problem

MAX_GAP = 0.2  # of joints of mortar [m]

if TYPE_CHECKING:
    from rocking_cli.io.tables import Columns
    from rocking_cli.questions.import_drawing.study import Imported


@takes_numbers
def import_drawing(
    file: str | Path,
    *,
    units: str | None = None,
    scale: str | None = None,
    layers: Mapping[str, Sequence[str]] | None = None,
    density: float | str | Mapping[str, float | str] | None = None,
    depth: float | str | None = None,
    merge_gap: float | str = 0.0,
    close: float | str = "1 mm",
    nested: Literal["openings"] | None = None,
    kind: Literal["rigid_body", "assembly", "linkage"] | None = None,
    tolerance: float | str = "0.1 mm",
    plane: str | None = None,
    out: str | Path | None = None,
    command: str = "rk.import_drawing",
    watch: Watcher = SILENT,
) -> Answer[Imported]:
    """Make a structure of a drawing: DXF, SVG, GeoJSON, a table of vertices, a model of blocks.

    Parameters
    ----------
    file : str or Path
        The drawing.
    units : str, optional
        Its unit of length, such as "mm"; required if the file states none that can be believed.
    scale : str, optional
        Its scale, such as "1:50".
    layers : mapping of str to sequence of str, optional
        Layers by role: bodies, ground, openings, hinges, supports, loads, ties, nothing; by default their names say it.
    density : float or str, or mapping of str to these, optional
        Density [kg/m3], or that of each layer.
    depth : float or str, optional
        Depth of the structure [m].
    merge_gap : float or str
        Width of mortar joints to close [m]: both faces move to the middle.
    close : float or str
        Distance up to which ends of lines are one point, and depth up to which overlaps are mended [m].
    nested : {"openings"}, optional
        What outlines inside others are; by default they are refused.
    kind : {"rigid_body", "assembly", "linkage"}, optional
        Mechanism of the structure; by default the one that fits what is drawn.
    tolerance : float or str
        Largest distance of the sides of curved blocks from their arcs [m].
    plane : {"xz", "yz"}, optional
        Plane of a model of blocks; "xz" by default.
    out : str or Path, optional
        Structure file to write.
    command : str
        The command that the file names as its origin.
    watch : Watcher
        Told what was written.

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
    from rocking_cli.io.files import keep_apart, write_whole
    from rocking_cli.questions.import_drawing.study import ImportOptions, structure_from
    from rocking_cli.questions.import_drawing.view import sentences, view

    options = ImportOptions(
        units=units, scale=scale, layers=layers or {}, densities=_densities(density),
        depth=None if depth is None else length_of(depth, "depth", zero=False),
        merge_gap=length_of(merge_gap, "merge_gap", MAX_GAP),
        close=length_of(close, "close", zero=False), nested=nested, kind=kind,
        tolerance=length_of(tolerance, "tolerance", zero=False),
    )  # fmt: skip
    if find_spec("shapely") is None:
        raise InputError(Problem("a drawing needs the package shapely", hint="pip install 'rocking-cli[drawing]'"))
    if out is not None:
        keep_apart([("`out`", Path(out))], [str(file)])
    drawing, data = read_drawing(file, plane)
    if isinstance(drawing, MeshSurface):
        raise InputError(Problem("this is a mesh", str(file), hint="use rk.import_mesh"))
    name = default_name(file)
    made = structure_from(drawing, options, name, str(file))
    source = f"From {Path(file).name}, SHA-256 {sha256(data).hexdigest()}, by `{command}`"
    text = fields_text(made.kind, made.fields, [source, *sentences(made.notes)], made.comments)
    made = replace(made, text=text)
    if out is not None:
        write_whole(Path(out), lambda stream: stream.write(text.encode("utf-8")))
        watch.note(f"wrote {out}")
    figure = drawn("questions.import_drawing.picture.draw_import", made, f"{name}: {made.kind}", options.tolerance)
    shown = view(made, str(file), None if out is None else str(out))
    return Answer("import", made, shown, partial(_columns, made), figure)


def _columns(made: Imported) -> Columns:
    from rocking_cli.questions.import_drawing.view import BODIES
    from rocking_cli.views.column import frame_of

    return frame_of(BODIES, made.bodies)


def _densities(given: float | str | Mapping[str, float | str] | None) -> dict[str, float]:
    """Return the density of each layer, that of all others under ""."""
    if given is None:
        return {}
    by_layer = given if isinstance(given, Mapping) else {"": given}
    return {layer: density_of(value) for layer, value in by_layer.items()}
