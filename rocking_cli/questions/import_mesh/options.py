"""What `rk.import_mesh` is asked, and what `rk.import_drawing` is asked too."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any, ClassVar, Literal

from rocking_cli.ask.asked import AskedModel, Kind, option
from rocking_cli.ask.groups import plot_file
from rocking_cli.ask.kinds import FILE, NUMBER, output, quantity, word
from rocking_cli.units import KINDS

MAX_LENGTH = 1000.0  # of a structure [m]
LENGTH = partial(quantity, "length", "m", "LENGTH", most=MAX_LENGTH)
MAX_AZIMUTHS = 720
AZIMUTH_HINT = "give an angle in degrees such as 30, or FROM:TO:STEP such as 0:350:10"


def density_of(value: Any) -> float:
    """Return a density [kg/m3] from a number or a text with a unit. Raises `ValueError` or `UnitError`."""
    from rocking_cli.units import mass_of_weight, number_of

    weight = mass_of_weight(value, "kg/m3") if isinstance(value, str) else None
    density = weight if weight is not None else number_of(value, "kg/m3")
    if not 0 < density <= 1e6:
        raise ValueError(f"must be above 0 and at most 1e6 kg/m3, got {value}")
    return density


def azimuths_of(given: Any) -> list[float]:
    """Return azimuths from a number, several, or text such as 0:350:10 [deg]. Raises `ValueError`."""
    if not isinstance(given, str):
        azimuths = [float(each) for each in (given if isinstance(given, list | tuple) else [given])]
    else:
        try:
            start, *more = [float(each) for each in given.split(":")]
            end, step = more or (start, 1.0)
        except ValueError:
            raise ValueError(f"is not a direction: {given!r}: {AZIMUTH_HINT}") from None
        if not step > 0 or end < start:
            raise ValueError(f"{given!r} is not increasing: {AZIMUTH_HINT}")
        if not (end - start) / step < MAX_AZIMUTHS:
            raise ValueError(f"{given!r} has more than {MAX_AZIMUTHS} directions, or not finite ones: {AZIMUTH_HINT}")
        azimuths = [start + k * step for k in range(int((end - start) / step + 1e-9) + 1)]
    if not all(abs(each) <= 1e6 for each in azimuths) or len(azimuths) > MAX_AZIMUTHS:
        raise ValueError(f"must be at most {MAX_AZIMUTHS} finite angles: {AZIMUTH_HINT}")
    return azimuths


def _one_density(value: Any) -> float:
    if isinstance(value, list | tuple):
        if len(value) > 1 or "=" in str(value[0]):
            raise ValueError("is that of the whole body: give it once, without a layer")
        (value,) = value
    return density_of(value)


class FromFile(AskedModel):
    """A question about a drawing or a mesh, of which a structure file is made."""

    file: Path = option("The drawing or the mesh.", FILE, where="input", default=...)
    out: Path | None = option("Structure file to write.", output(".yaml", ".yml"))
    plot: Path | None = plot_file("Plot the bodies with their names, what was mended, and what was left out")
    origin: str | None = option(
        "The command that the structure file names as its origin.", where="Python", usual="the call of Python"
    )


class Sized(AskedModel):
    """Unit of length and density of what is in a file."""

    units: str | None = option(
        "Unit of the drawing or mesh: mm, cm, dm, m, in or ft.", Kind(str, "UNIT"), usual="as the file says"
    )
    density: Any = option("Density.")


class MeshOptions(Sized):
    """How a mesh becomes a structure."""

    heading: ClassVar[str] = "Meshes"
    units: str | None = option(
        "Unit of the coordinates of a mesh, which does not say it.", word(*KINDS["length"], what="unit")
    )
    density: float | None = option(
        "Density; needed for a structure, not for its uplift.", Kind(_one_density, "DENSITY", "kg/m3")
    )
    level: float = option(
        "Height above the ground up to which points bear: they make the foot.", LENGTH("2mm", zero=True), default=1e-3,
        usual="1mm",
    )  # fmt: skip
    settle: bool = option("Lay the body down on the facet of its convex hull below its centre of mass.", default=False)
    hull: bool = option("Take the convex hull of the mesh, which need not be closed then.", default=False)
    up: Literal["z", "y"] = option("Axis of the mesh that points upwards.", default="z")


class ImportMesh(FromFile, MeshOptions):
    """Make a structure of the mesh of a body."""

    heading: ClassVar[str] = "Meshes"
    azimuth: list[float] = option(
        "Direction of the motion, anticlockwise from the x axis of the mesh: 30, or 0:350:10, which makes a structure "
        "each.",
        Kind(azimuths_of, "DEG", "deg"), default=[], usual="over the weakest edge",
    )  # fmt: skip
    north: float | None = option("Azimuth of the north, for the plot and the page.", NUMBER._replace(metavar="DEG"))
    page: Path | None = option("Page on which the body can be turned.", output(".html"))
