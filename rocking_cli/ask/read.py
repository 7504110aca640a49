"""Files by the reader that knows their content: records (`rk.read_record`), drawings and meshes."""

from __future__ import annotations

from contextlib import AbstractContextManager
from importlib.metadata import EntryPoint
from pathlib import Path
from typing import Any, cast

from rocking_cli.ask.groups import ReadRecordAsked
from rocking_cli.ask.verbs import verb
from rocking_cli.ask.watcher import Watcher
from rocking_cli.errors import InputError, MechanismError, Problem, named
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.io.drawings.contract import DrawingError, DrawingReader, LineDrawing, MeshSurface
from rocking_cli.io.files import read_bytes
from rocking_cli.plugins.errors import blame
from rocking_cli.plugins.registry import Plugins, leave_out, origin
from rocking_cli.processing.reading import reading_of
from rocking_cli.processing.reading_options import PREPARING

MAX_BYTES = 500_000_000
DWG = b"AC10"


@verb(ReadRecordAsked)
def read_record(asked: ReadRecordAsked, watch: Watcher) -> GroundMotion:
    """Read a recorded ground motion, and correct it; the format is found from the content, not from the file's name.

    Corrections are made in the order in which they are given.

    Returns
    -------
    GroundMotion
        Accelerations [m/s2] at a constant interval [s], named after the file. Its `processing` has the steps applied.

    Raises
    ------
    InputError
        If the file cannot be read or corrected, or anything in it is missing, contradictory or not a number.
    """
    return reading_of(asked.in_order_given(PREPARING)).check().read(asked.path)


class DrawingReaders(Plugins[DrawingReader]):
    """Readers of drawings and meshes by name."""

    group = "rocking.drawings"
    kind = "reader of drawings"

    @staticmethod
    def accept(loaded: object, point: EntryPoint) -> DrawingReader:
        """Return the loaded object if it is a reader."""
        missing = [word for word in ("sniff", "read") if not callable(getattr(loaded, word, None))]
        missing += [word for word in ("TITLE", "ENDINGS") if not hasattr(loaded, word)]
        if missing:
            raise MechanismError(f"{origin(point)} is not a reader of drawings: it has no {', '.join(missing)}")
        return cast("DrawingReader", loaded)


def reader_of(path: str | Path) -> tuple[DrawingReader, bytes]:
    """Return the reader that knows the content of a file, and the content. Raises as `read_drawing`."""
    data, file = read_bytes(path, "drawing", MAX_BYTES), str(path)
    if data[:4] == DWG:
        raise DrawingError("not_dxf", "this is a DWG file: save it as DXF", file)
    if not data:
        raise DrawingError("empty", "the file is empty", file)
    readers, titles = DrawingReaders(), []
    for name in readers:
        try:
            reader = readers[name]
        except MechanismError as error:
            leave_out(error)
            continue
        with _blamed(reader, file):
            if reader.sniff(data, Path(file).suffix.lower()):
                return reader, data
        titles.append(reader.TITLE)
    known = ", ".join(sorted(titles, key=str.lower))
    raise DrawingError("unknown", f"not a drawing or mesh that can be read; known formats: {known}", file)


def _blamed(reader: DrawingReader, file: str) -> AbstractContextManager[None]:
    return blame(f"the reader of {reader.TITLE} failed on {file}", getattr(reader, "__name__", type(reader).__module__))


def read_drawing(path: str | Path, plane: str | None = None) -> tuple[LineDrawing | MeshSurface, bytes]:
    """Read a drawing or a mesh by the reader that knows its content.

    Parameters
    ----------
    path : str or Path
        The file.
    plane : str, optional
        The plane in which a model in space is seen.

    Returns
    -------
    LineDrawing or MeshSurface
        What the reader makes of it.
    bytes
        The content of the file.

    Raises
    ------
    InputError
        If the file cannot be read, or has no such plane; a `DrawingError` if it is not of a known format.
    PluginError
        If a reader fails.
    """
    reader, data = reader_of(path)
    planes = getattr(reader, "PLANES", ())
    if plane is not None and plane not in planes:
        what = f"must be one of {', '.join(planes)}, got {plane!r}" if planes else f"{reader.TITLE} has no planes"
        raise InputError(Problem(what, field=named("plane")))
    more: dict[str, Any] = {} if plane is None else {"plane": plane}
    with _blamed(reader, str(path)):
        return reader.read(data, str(path), **more), data


def is_mesh(path: str | Path) -> bool:
    """Return whether a file is read as a mesh. Raises as `read_drawing`."""
    return bool(getattr(reader_of(path)[0], "MESH", False))
