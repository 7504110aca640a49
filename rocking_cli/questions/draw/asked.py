"""What `rocking draw` and `rk.draw` are asked."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from rocking_cli.ask.asked import option
from rocking_cli.ask.groups import OfStructure, plot_file
from rocking_cli.ask.kinds import LOCAL_FILE, NUMBER, STANDARD_OUTPUT, output


def _picture(given: Mapping[str, Any], *, as_json: bool) -> Path | None:
    """Return the picture that a command draws if no file is requested, as there is nothing else to see."""
    file = given.get("structure", STANDARD_OUTPUT)
    stem = LOCAL_FILE.stem if file == STANDARD_OUTPUT else Path(file).stem
    return None if as_json or "dxf" in given else Path(f"{stem}.png")


class DrawAsked(OfStructure):
    """Draw a structure at rest with its dimensions, and displaced in both directions, to scale.

    Check the drawing before you trust a number: is this the intended mechanism, and were the dimensions read correctly?
    It shows the bodies, the hinges with the letters of the paper, the centroids, and alpha or the angles of the
    linkage; for an arch, the voussoirs and the lines of thrust at uplift; the loads and the ties (dashed if slack) with
    their heights, and the walls behind a structure that rocks in one direction only.

    Without FILE, the command uses rocking.yaml of this folder, or else a block of 0.7 m x 2.8 m.

    \b
    Example:
      rocking draw frame.yaml
      rocking draw arch.yaml --at 0.5 --plot arch.svg
      rocking draw wall.yaml --dxf wall.dxf
    """

    at: float | None = option(
        "Rotation to draw, as a multiple of phi_cr, or of the kinematic limit if there is no phi_cr; at most the "
        "kinematic limit.",
        NUMBER, usual="1, 0.1", gt=0,
    )  # fmt: skip
    plot: Path | None = plot_file(
        "Output file", on_terminal=_picture, usual="FILE with .png, in this folder; none with JSON or DXF"
    )
    dxf: Path | None = option(
        "Write the drawing as DXF, in metres, which `rocking import` reads; needs ezdxf.",
        output(".dxf"),
    )
