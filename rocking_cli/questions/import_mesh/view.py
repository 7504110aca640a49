"""View of the body of a mesh: its foot, its edges, and how it starts to rock in each direction."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import degrees
from typing import Any

import numpy as np

from rocking_cli.errors import named
from rocking_cli.questions.import_mesh.solid import AzimuthRow, FootEdge, LevelRow
from rocking_cli.questions.import_mesh.study import ImportedMesh
from rocking_cli.text import one_line
from rocking_cli.views.column import Column, data_of, frame_of, of, only_shown, rounded, table_of
from rocking_cli.views.view import Table, View, number

MAX_LISTED_EDGES = 12  # edges of a foot that are listed; of a round foot the weakest

EDGES: tuple[Column[FootEdge], ...] = (
    Column("edge", of("number"), head="edge"),
    Column("azimuth", of("azimuth"), "deg", "azimuth [deg]", rounded(5)),
    Column("length", of("along"), "m", "length [m]", rounded(4)),
    Column("c", of("c"), "m", "c [m]", rounded(5)),
    Column("lambda", of("lambda_"), "", "lambda", rounded(5), words="ground acceleration over g that starts rocking"),
    Column("phi_cr", of("phi_cr"), "rad", "phi_cr [rad]", rounded(5)),
    only_shown("[deg]", lambda edge: degrees(edge.phi_cr), rounded(4)),
    Column("p", of("p"), "rad/s", "p [rad/s]", rounded(5)),
    Column("inertia", of("inertia"), "m2", name=None),
    Column("start", lambda edge: _pair(edge.start), name=None),
    Column("end", lambda edge: _pair(edge.end), name=None),
)
AZIMUTHS: tuple[Column[AzimuthRow], ...] = (
    Column("azimuth", of("azimuth"), "deg", "azimuth [deg]", rounded(5)),
    Column("lambda", of("lambda_"), "", "lambda", rounded(5)),
    Column("edge", of("edge.number"), "", "edge"),
    Column("phi_cr", of("edge.phi_cr"), "rad", "phi_cr [rad]", rounded(5)),
    Column("p", of("edge.p"), "rad/s", "p [rad/s]", rounded(5)),
    Column("drive", of("drive"), "", "drive", rounded(5)),
)
LEVELS: tuple[Column[LevelRow], ...] = (
    Column("level", of("level"), "m"),
    only_shown("level [mm]", lambda row: 1000 * row.level, rounded(3)),
    Column("corners", of("corners"), "", "corners"),
    Column("lambda", of("lambda_"), "", "least lambda", rounded(4)),
    Column("azimuth", of("azimuth"), "deg", "towards [deg]", rounded(4)),
)
NOT_MODELLED = (
    "Not modelled: rolling from one edge to the next, twisting about the vertical, and wobbling on a corner. The body "
    "rocks about one edge of its foot, driven by the share of the motion that is normal to it."
)


def view(found: ImportedMesh, written: Sequence[str] = ()) -> View:
    """Show the body, its edges, its feet by level and its azimuths.

    Parameters
    ----------
    found : ImportedMesh
        The body.
    written : sequence of str
        The files that were written.
    """
    title = f"{one_line(found.file)}: {found.format} mesh"
    shown = sorted(found.edges, key=lambda each: each.c)[:MAX_LISTED_EDGES] if found.is_round else found.edges
    parts: list[Table | str] = [title, table_of("Edges of the foot", EDGES, shown)]
    if found.azimuths:
        parts.append(table_of("Directions of motion", AZIMUTHS, found.azimuths))
    parts.append(table_of("Feet by level: height above the ground up to which points bear", LEVELS, found.levels))
    return View(lambda: data(found, written), [*parts, *sentences(found)])


def sentences(found: ImportedMesh) -> list[str]:
    """Return what is known of the body, what was done to the mesh, and what is not modelled."""
    size, options, weak = np.ptp(found.points, axis=0), found.options, found.weakest
    weighs = "" if found.mass is None else f", {number(found.mass, 5)} kg at {options.density:g} kg/m3"
    lines = [
        f"Units: {options.units}. The body is {' x '.join(f'{each:.4g}' for each in size)} m large (x, y, z) and has "
        f"{number(found.whole.volume, 5)} m3{weighs}. Its centre of mass is {number(found.height, 5)} m above the "
        "ground.",
        f"The weakest edge is {weak.number}, towards {number(weak.azimuth, 4)} degrees: lambda = "
        f"{number(weak.lambda_, 4)}. Azimuths are anticlockwise from the x axis of the mesh.",
    ]
    if (by_level := _by_level(found)) is not None:
        lines.append(by_level)
    lines += [f"{note.words[0].upper()}{note.words[1:]}." for note in found.notes]
    if found.is_round:
        lines.append(f"The foot has {len(found.edges)} sides: a body on a round foot rolls, which is not modelled.")
    return [*lines, NOT_MODELLED]


def _by_level(found: ImportedMesh) -> str | None:
    """Return a sentence on how much the level matters; None if it does not."""
    by_lambda = sorted((row.lambda_, row.level) for row in found.levels if row.lambda_ is not None)
    if not by_lambda or by_lambda[-1][0] - by_lambda[0][0] <= 1e-3 * found.weakest.lambda_:
        return None
    least, most = (f"{number(each, 3)} at {1000 * level:g} mm" for each, level in (by_lambda[0], by_lambda[-1]))
    return (
        f"lambda depends on {named('level')}, here {1000 * found.options.level:g} mm: it is {least} "
        f"and {most}. Choose the "
        "level by how the body bears, not by its mesh."
    )


def data(found: ImportedMesh, written: Sequence[str] = ()) -> Mapping[str, Any]:
    """Return the body as plain data."""
    options = found.options
    return {
        "file": found.file,
        "format": found.format,
        "kind": "rigid_body",
        "units": options.units,
        "up": options.up,
        "shift": list(found.shift),
        "size": np.ptp(found.points, axis=0).tolist(),
        "volume": found.whole.volume,
        "mass": found.mass,
        "density": options.density,
        "height": found.height,
        "inertia": (found.whole.inertia / found.whole.volume).tolist(),
        "level": options.level,
        "settled": found.turned if options.settle else None,
        "hull": options.hull,
        "foot": [_pair(each) for each in found.foot],
        "edges": [data_of(EDGES, each) for each in found.edges],
        "weakest": found.weakest.number,
        "azimuths": [data_of(AZIMUTHS, each) for each in found.azimuths],
        "levels": [data_of(LEVELS, each) for each in found.levels],
        "notes": [
            {"kind": note.kind, "count": note.count, "words": note.words, "at": [list(each) for each in note.at]}
            for note in found.notes
        ],
        "written": list(written),
    }


def columns(found: ImportedMesh) -> dict[str, list[Any]]:
    """Return the azimuths as a table, or the edges if none is given."""
    return frame_of(AZIMUTHS, found.azimuths) if found.azimuths else frame_of(EDGES, found.edges)


def _pair(point: complex) -> list[float]:
    return [point.real, point.imag]
