"""`rk.import_mesh`: make a structure of the mesh of a body, such as the scan of a statue."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from hashlib import sha256
from pathlib import Path
from textwrap import wrap
from typing import TYPE_CHECKING

from rocking_cli.ask.answer import Answer, drawn
from rocking_cli.ask.drawings import density_of, length_of, read_drawing
from rocking_cli.ask.numbers import takes_numbers
from rocking_cli.ask.watcher import SILENT, Watcher
from rocking_cli.errors import InputError, Problem, RockingError
from rocking_cli.text import one_line

if TYPE_CHECKING:
    from rocking_cli.questions.import_mesh.foot import AzimuthRow
    from rocking_cli.questions.import_mesh.study import ImportedMesh

LEVEL = 0.001
MAX_AZIMUTHS = 720
COMMENT_WIDTH = 110
AZIMUTH_HINT = "give an angle in degrees such as 30, or FROM:TO:STEP such as 0:350:10"


@takes_numbers
def import_mesh(
    path: str | Path,
    *,
    units: str | None = None,
    density: float | str | None = None,
    azimuth: str | float | Sequence[float] | None = None,
    level: float | str = LEVEL,
    settle: bool = False,
    hull: bool = False,
    up: str = "z",
    north: float | None = None,
    out: str | Path | None = None,
    page: str | Path | None = None,
    command: str = "rk.import_mesh",
    watch: Watcher = SILENT,
) -> Answer[ImportedMesh]:
    """Make a structure of the mesh of a body, such as the scan of a statue: OBJ, PLY or STL.

    Parameters
    ----------
    path : str or Path
        The mesh, a closed surface.
    units : str
        Unit of its coordinates, such as "mm"; a mesh does not say it.
    density : float or str, optional
        Density [kg/m3]; needed for a structure, not for its uplift.
    azimuth : float, str or sequence of float, optional
        Direction of the motion, anticlockwise from the x axis of the mesh [deg]; several make a structure each, also
        as text "FROM:TO:STEP". By default the body rocks over its weakest edge, driven by the whole motion.
    level : float or str
        Height above the ground up to which points bear [m]: they make the foot.
    settle : bool
        Lay the body down on the facet of its convex hull below its centre of mass.
    hull : bool
        Take the convex hull of the mesh, which need not be closed then.
    up : {"z", "y"}
        Axis of the mesh that points upwards.
    north : float, optional
        Azimuth of the north, for the plot and the page [deg].
    out : str or Path, optional
        Write the structure to this YAML file; of several azimuths one each, such as `statue-030.yaml`.
    page : str or Path, optional
        Write a page of HTML on which the body can be turned.
    command : str
        The command that the files name as their origin.
    watch : Watcher
        Told what was read and written.

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
    from rocking_cli.questions.import_mesh.study import MeshOptions, imported
    from rocking_cli.questions.import_mesh.view import columns, sentences, view
    from rocking_cli.units import KINDS

    for field, value, known in (("units", units, tuple(KINDS["length"])), ("up", up, ("z", "y"))):
        if value is not None and value not in known:
            raise InputError(Problem(f"must be one of {', '.join(known)}, got {value!r}", field=f"`{field}`"))
    azimuths = azimuths_of(azimuth)
    options = MeshOptions(
        units, None if density is None else density_of(density), length_of(level, "level"), settle, hull, up
    )
    places = [] if out is None else places_of(Path(out), azimuths)
    outputs = [("`out`", place) for place in places]
    if page is not None:
        check_writable(Path(page), ".html")
        outputs.append(("`page`", Path(page)))
    keep_apart(outputs, [str(path)])
    for _, place in outputs:
        check_writable(place)
    surface, content = read_drawing(path)
    if not isinstance(surface, MeshSurface):
        raise InputError(Problem("this is a drawing, not a mesh", str(path), hint="use rk.import_drawing"))
    body, name = imported(surface, str(path), options, azimuths), one_line(Path(path).name)
    written = list[str]()
    rows: list[AzimuthRow | None] = [*body.azimuths] or [None]
    for place, structure, row in zip(places, body.structures if places else (), rows, strict=False):
        edge = body.weakest if row is None else row.edge
        where = "over its weakest edge" if row is None else f"towards {row.azimuth:g} degrees"
        at = ", ".join(f"{each:.7g}" for each in body.shift)
        head = [
            f"The body of {name}, rocking {where}, by: {command}",
            f"SHA-256 of the mesh: {sha256(content).hexdigest()}",
            f"It turns over edge {edge.number} of {len(body.edges)}, whose normal, here to the right, is at "
            f"{edge.azimuth:.6g} degrees. x = 0 is below its centre of mass, at ({at}) m in the mesh.",
            *sentences(body),
        ]
        lines = [line for each in head for line in wrap(one_line(each), COMMENT_WIDTH, break_on_hyphens=False)]
        written += _write(place, structure_text(structure, *lines), watch)
    if page is not None:
        from rocking_cli.questions.import_mesh.page import render

        written += _write(Path(page), render(body, f"{name} as a rocking body", [command], north), watch)
    title = f"{name}: foot from below the centre of mass, over its height"
    figure = drawn("questions.import_mesh.picture.draw_compass", body, title, north)
    return Answer("imported mesh", body, view(body, written), partial(columns, body), figure)


def azimuths_of(given: str | float | Sequence[float] | None) -> list[float]:
    """Return azimuths from a number, several, or text such as 0:350:10 [deg]. Raises `InputError`."""
    if given is None:
        return []
    if not isinstance(given, str):
        azimuths = [float(each) for each in (given if isinstance(given, Sequence) else [given])]
    else:
        try:
            start, *more = [float(each) for each in given.split(":")]
            end, step = more or (start, 1.0)
        except ValueError:
            raise InputError(Problem(f"is not a direction: {given!r}", field="`azimuth`", hint=AZIMUTH_HINT)) from None
        if not step > 0 or end < start:
            raise InputError(Problem(f"{given!r} is not increasing", field="`azimuth`", hint=AZIMUTH_HINT))
        if not (end - start) / step < MAX_AZIMUTHS:
            what = f"{given!r} has more than {MAX_AZIMUTHS} directions, or not finite ones"
            raise InputError(Problem(what, field="`azimuth`", hint=AZIMUTH_HINT))
        azimuths = [start + k * step for k in range(int((end - start) / step + 1e-9) + 1)]
    if not all(abs(each) <= 1e6 for each in azimuths) or len(azimuths) > MAX_AZIMUTHS:
        raise InputError(Problem("must be at most 720 finite angles", field="`azimuth`", hint=AZIMUTH_HINT))
    return azimuths


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
