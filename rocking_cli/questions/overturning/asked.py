"""What `rocking overturning`, `rk.overturning_map` and `rk.overturning_curves` are asked."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any, ClassVar

from rocking_cli.ask.asked import AskedModel, Idle, Kind, option
from rocking_cli.ask.groups import (
    BothWays,
    ByEngine,
    ModelName,
    OfJoints,
    OfRestitution,
    StructureLike,
    WithTable,
    plot_file,
    table_file,
)
from rocking_cli.ask.kinds import PERIOD, PULSE_AMPLITUDE, RATIO, SHAPE, WHOLE, each, span

Range = tuple[float, float]
MAP_POINTS, CURVE_POINTS = 256, 60  # along each side of a map, and of a curve
FEW_POINTS = 12  # along each side of a map with free blocks
MAX_POINTS = 1000
AROUND = "around overturning"


def axis(text: str, kind: Kind, example: str, usual: str = AROUND) -> Any:
    """Declare the range of an axis."""
    return option(text, span(kind, example, "LOW:HIGH"), usual=usual)


class OfPulses(OfRestitution, BothWays, OfJoints):
    """A question about pulses of all periods; of both polarities, the worse governs."""

    heading: ClassVar[str] = "Options"
    shape: str = option(
        "Shape of the pulses: sine, cosine, half_sine, rectangular, ricker, ..., then its parameters if it has any.",
        SHAPE, default="sine",
    )  # fmt: skip
    period: Range | None = axis("Smallest and largest period, such as 0.2s:4s.", PERIOD, "0.2s:4s")


class OnAxes(AskedModel):
    """The axes of a map."""

    ag: Range | None = axis(
        "Smallest and largest amplitude; a text needs its unit: 0.1g:2g.", PULSE_AMPLITUDE, "0.1g:2g",
        "0.7 to 10 times uplift",
    )  # fmt: skip
    omega: Range | None = axis("Smallest and largest dimensionless frequency omega = omega_g/p.", RATIO, "0.5:10")
    a: Range | None = axis(
        "Smallest and largest dimensionless amplitude a = a_g/(g lambda).", RATIO, "0.5:10", "0.5:10"
    )
    dimensionless: bool = option("Use the dimensionless axes omega and a, also with a structure.", default=False)


class OverturningAsked(OfPulses, OnAxes, ByEngine, WithTable):
    """Map the pulses that overturn a structure, by their periods and amplitudes.

    Each point of the map is a simulated motion that ends in no uplift, rocking, overturning after one or more impacts,
    overturning without impact, or in an unknown outcome, if a joint opens or slides too far. The default ranges show
    where overturning starts. Without FILE, the map is that of the linear block, with the axes omega = omega_g/p and
    a = a_g/(g lambda). Of two polarities, the worse governs.

    To compare, the smallest amplitude that overturns each FILE is computed as a function of the period, and which
    structure overturns first. A FILE that cannot be used is reported and skipped, and the exit code is 5.

    \b
    Example:
      rocking overturning --plot map.png
      rocking overturning block.yaml --model nonlinear --ag 0.1g:2g --plot map.png
      rocking overturning --compare block.yaml frame.yaml wall.yaml --period 0.2:4 --plot curves.png

    Source: DeJong and Dimitrakopoulos (2014), Section 6; Zhang and Makris (2001).
    """

    structures: StructureLike | Sequence[StructureLike] = option(
        "One structure for a map, several to compare; without any, the dimensionless linear block.",
        Kind(each), where="input", default=(),
    )  # fmt: skip
    compare: bool = option(
        "Compare the smallest overturning amplitudes of several structures instead of a map.", default=False
    )
    model: ModelName | None = option(
        "Model: nonlinear (the mechanism itself), or its equivalent block (linear1, linear2).",
        usual="linear2; nonlinear to compare, and with free blocks",
    )
    points: int | None = option(
        "Number of points along each side of a map, or of periods to compare.", WHOLE, ge=2, le=MAX_POINTS,
        usual="256; 60 to compare; 12 with free blocks",
    )  # fmt: skip
    out: Path | None = table_file("Write the map, one point per line, or the curves")
    plot: Path | None = plot_file("Plot the map, or the curves")
    idle = (
        Idle("with {compare}, as free blocks take too long", lambda asked: asked.compare, ("engine",)),
        Idle("with {compare}, whose axis is the period in s", lambda asked: asked.compare, ("dimensionless", "omega")),
        Idle("with {compare}: give {ag}", lambda asked: asked.compare, ("a",)),
        Idle(
            "on the linear block: give a structure", lambda asked: not asked.structures, ("engine", "model", "opening")
        ),
    )


class OverturningMapAsked(OfPulses, OnAxes, ByEngine):
    """Map the effect of pulses on a structure, or on the dimensionless linear block."""

    structure: StructureLike | None = option(
        "The structure, or its YAML file; without it, the linear block, with the axes omega and a.", where="input"
    )
    model: ModelName = option("Model of the structure.", default="linear2")
    points: int = option("Number of points along each side.", WHOLE, default=MAP_POINTS, ge=2, le=MAX_POINTS)
    idle = (
        Idle(
            "on a linear block, which has no joints",
            lambda asked: asked.model != "nonlinear" or asked.structure is None,
            ("opening",),
        ),
        Idle("with free blocks", lambda asked: asked.engine == "blocks", ("restitution",)),
        Idle("without a structure: give {omega} and {a}", lambda asked: asked.structure is None, ("period", "ag")),
        Idle("with {dimensionless}: give {omega} and {a}", lambda asked: asked.dimensionless, ("period", "ag")),
        Idle(
            "with a structure: give {period} and {ag}, or {dimensionless}",
            lambda asked: asked.structure is not None and not asked.dimensionless,
            ("omega", "a"),
        ),
    )


class OverturningCurvesAsked(OfPulses):
    """Compute the smallest amplitude that overturns each of several structures, against the period of a pulse."""

    structures: StructureLike | Sequence[StructureLike] = option(
        "The structures to compare.", Kind(each), where="input", default=...
    )
    model: ModelName = option("Model of the structures.", default="nonlinear")
    top: float | None = option("Largest amplitude to try.", PULSE_AMPLITUDE, usual="10 times uplift")
    points: int = option("Number of periods, at equal ratios.", WHOLE, default=CURVE_POINTS, ge=2, le=MAX_POINTS)
    idle = (Idle("on linear blocks, which have no joints", lambda asked: asked.model != "nonlinear", ("opening",)),)
