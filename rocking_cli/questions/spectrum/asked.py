"""What `rocking spectrum` and `rk.spectrum` are asked."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from rocking_cli.ask.asked import Idle, Kind, option
from rocking_cli.ask.groups import (
    ModelName,
    Motion,
    Motions,
    OfJoints,
    OfRestitution,
    StructureLike,
    UnderMotions,
    WithTable,
    plot_file,
    table_file,
)
from rocking_cli.ask.kinds import LOCAL_FILE, WHOLE, angle, quantity, several, share, span

SIZE = quantity("period", "s", "PERIOD", "1s", 1e-3, 1e4)  # blocks of 0.2 um to 19,000 km


def _fractile(value: Any) -> float:
    if not 0 < (given := share(value)) < 1:
        raise ValueError(f"{given:g} is not a fractile between 0 and 1")
    return given


def _local(given: Mapping[str, Any], *, as_json: bool) -> tuple[Path, ...] | None:
    """Return the structure that a command was not given, unless it is about blocks alone."""
    return None if "slenderness" in given else (LOCAL_FILE,)


class SpectrumAsked(UnderMotions, OfRestitution, OfJoints, WithTable):
    """Compute the rocking spectrum: peak rotation and overturning against size, under one or more ground motions.

    The spectrum has one curve per structure, with all its lengths multiplied by a scale, and one per slenderness of
    rectangular block. Size is expressed as 2 pi/p, which increases with the square root of the scale. The structure as
    given is marked. With several motions, the spectrum gives the median, the fractiles and the share that overturn. Of
    two polarities, the worse governs.

    Without FILE and slenderness, the command uses rocking.yaml of this folder, or else a block of 0.7 m x 2.8 m. A
    motion or a FILE that cannot be used is reported and skipped, and the exit code is 5.

    \b
    Example:
      rocking spectrum --record accel.csv --plot spectrum.png
      rocking spectrum block.yaml --record "records/*.AT2" --slenderness 0.1,0.2 --plot spectrum.png
      rocking spectrum --slenderness 0.1,0.2,0.3 --pulse sine:0.5g:0.8s --sizes 1:10 --count 30
      rocking spectrum frame.yaml --record "records/*.AT2" --target-pga 0.4 --polarity both --out spectrum.csv

    Source: Makris and Konstantinidis (2003).
    """

    structures: StructureLike | Sequence[StructureLike] = option(
        "One structure or several, or their YAML files.", where="input", default=(), on_terminal=_local
    )
    motions: Motion | Sequence[Motion] | Motions = option(
        "One motion or several, their files, or pulses as text; at least one.", where="input", default=()
    )
    slenderness: Sequence[float] = option(
        "Slendernesses of rectangular blocks to compute as well: alpha = atan(b/h) in rad, such as 0.1,0.2, or 10deg.",
        several(Kind(partial(angle, unit="rad"), unit="rad"), "A,B,..."), default=(),
    )  # fmt: skip
    sizes: tuple[float, float] | None = option(
        "Smallest and largest size, as 2 pi/p.", span(SIZE, "1s:10s"),
        usual="the structures scaled by 0.1 to 10; 1:10 for blocks alone",
    )  # fmt: skip
    count: int = option("Number of sizes, at equal ratios.", WHOLE, default=60, ge=1, le=2000)
    model: ModelName = option(
        "Model: nonlinear (the mechanism itself), or its equivalent block (linear1, linear2).", default="nonlinear"
    )
    fractiles: Sequence[float] = option(
        "Fractiles to show in addition to the median, with several motions.",
        several(Kind(_fractile), "Q,Q"), default=(0.16, 0.84),
    )  # fmt: skip
    jobs: int | None = option("Number of processor cores to use.", WHOLE, ge=1, le=1024, usual="all")
    out: Path | None = table_file("Write the curves, including those of each motion")
    plot: Path | None = plot_file("Plot the curves")
    idle = (Idle("on linear blocks, which have no joints", lambda asked: asked.model != "nonlinear", ("opening",)),)
