"""What `rk.import_drawing` is asked."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Literal

from rocking_cli.ask.asked import Kind, option
from rocking_cli.questions.import_mesh.options import LENGTH, FromFile, Sized, density_of

MAX_GAP = 0.2  # of joints of mortar [m]


def _densities(value: Any) -> dict[str, float]:
    """Return the density of each layer, that of all others under ""."""
    if isinstance(value, Mapping):
        return {layer: density_of(each) for layer, each in value.items()}
    densities: dict[str, float] = {}
    for each in value if isinstance(value, list | tuple) else [value]:
        layer, _, density = each.rpartition("=") if isinstance(each, str) else ("", "", each)
        if layer in densities:
            raise ValueError(f"is given twice for {layer or 'all layers'}")
        densities[layer] = density_of(density)
    return densities


def _layers(value: Any) -> Mapping[str, Sequence[str]]:
    from rocking_cli.questions.import_drawing.legend import parse_layers

    return value if isinstance(value, Mapping) else parse_layers([value] if isinstance(value, str) else value)


class ImportOptions(Sized):
    """How a drawing is read."""

    scale: str | None = option("Scale of the drawing, such as 1:50.", Kind(str, "1:N"))
    layers: Mapping[str, Sequence[str]] = option(
        "Layers of a role, such as bodies=CONCI,PILE. Roles: bodies, ground, openings, hinges, supports, loads, ties, "
        "nothing. Repeatable.",
        Kind(_layers, "ROLE=NAMES"), default={}, repeat=True, usual="by their names",
    )  # fmt: skip
    density: Mapping[str, float] = option(
        "Density, in kg/m3 without a unit; of one layer with its name: PIETRA=2600. Repeatable.",
        Kind(_densities, "[LAYER=]DENSITY"), default={}, repeat=True,
    )  # fmt: skip
    depth: float | None = option("Depth of the structure, such as 1m.", LENGTH("1m"))
    merge_gap: float = option(
        "Close mortar joints up to this width: 12mm.", LENGTH("12mm", most=MAX_GAP, zero=True), default=0.0,
        usual="none",
    )  # fmt: skip
    close: float = option(
        "Distance up to which ends of lines are one point, and depth up to which overlaps are mended.", LENGTH("1mm"),
        default=1e-3, usual="1mm",
    )  # fmt: skip
    nested: Literal["openings"] | None = option("Take outlines inside others as openings.")
    kind: Literal["rigid_body", "assembly", "linkage"] | None = option(
        "Mechanism of the structure.",
        typed="as",
        usual="rigid_body for one body, linkage with hinges, or else assembly",
    )
    tolerance: float = option(
        "Largest distance of the straight sides of curved blocks from their arcs.", LENGTH("0.1mm"), default=1e-4,
        usual="0.1mm",
    )  # fmt: skip
    plane: Literal["xz", "yz"] | None = option("Of a model of blocks: its plane.", usual="xz")


class ImportDrawing(FromFile, ImportOptions):
    """Make a structure of a drawing."""
