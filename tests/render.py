"""Pictures reduced to what must not change between versions of matplotlib: small, grey and without text.

`python -m tests.render` (or `make pictures`) writes the baselines in tests/pictures/ anew. Look at them before
committing them.
"""

from __future__ import annotations

import io
from collections.abc import Callable
from functools import cache, partial
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from matplotlib.legend import Legend
from matplotlib.text import Text
from matplotlib.ticker import NullFormatter
from PIL import Image, ImageFilter

from rocking_cli.dynamics.history import History, respond
from rocking_cli.dynamics.model import ModelName
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.excitation.records import read_record
from rocking_cli.plotting.history import draw_history
from rocking_cli.plotting.overturning import draw_map
from rocking_cli.plotting.structure import draw_structure
from rocking_cli.structure import load_structure
from rocking_cli.studies.overturning import OverturningMap, overturning_map
from rocking_cli.studies.picture import picture
from rocking_cli.studies.shaken import linear_block, parse_shape
from tests.conftest import EXAMPLES

FOLDER = Path(__file__).parent / "pictures"
DPI = 60
TILE = 12  # pixels


def _structure(name: str) -> Figure:
    return draw_structure(picture(load_structure(EXAMPLES / f"{name}.yaml")), name, 0.8)


@cache
def _responses() -> tuple[GroundMotion, dict[ModelName, History]]:
    motion = read_record(EXAMPLES / "accel.csv")
    return motion, respond(load_structure(EXAMPLES / "frame.yaml"), motion)


def _history() -> Figure:
    motion, histories = _responses()
    return draw_history(histories, motion, "history")


@cache
def _plane() -> OverturningMap:
    plane = np.linspace(0.5, 10, 40)
    return overturning_map(linear_block(0.9), parse_shape("sine"), plane, plane)


def _map() -> Figure:
    return draw_map(_plane(), "map", dimensionless=True)


FIGURES: dict[str, Callable[[], Figure]] = {
    **{f"draw_{path.stem}": partial(_structure, path.stem) for path in sorted(EXAMPLES.glob("*.yaml"))},
    "history": _history,
    "map": _map,
}


def render(figure: Figure) -> Image.Image:
    """A figure without text and legends, small and in grey: fonts differ, and with them the room that text is given."""
    figure.set_layout_engine("none")
    for legend in figure.findobj(Legend):
        legend.remove()
    for axes in figure.axes:
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_formatter(NullFormatter())
            axis.set_minor_formatter(NullFormatter())
    for text in figure.findobj(Text):
        text.set_text("")
    stream = io.BytesIO()
    figure.savefig(stream, format="png", dpi=DPI)
    return Image.open(stream).convert("L")


def difference(one: Image.Image, other: Image.Image) -> float:
    """The root mean square of the difference in the tile where it is largest, of 255; infinite if the sizes differ.

    Blurred first: a line that is drawn a fraction of a pixel further on is the same line. A tile is small enough for
    a missing mark to count.
    """
    if one.size != other.size:
        return float("inf")
    soft = [np.asarray(each.filter(ImageFilter.GaussianBlur(1.2)), np.float64) for each in (one, other)]
    error = (soft[0] - soft[1]) ** 2
    rows, columns = (size // TILE for size in error.shape)
    tiles = error[: rows * TILE, : columns * TILE].reshape(rows, TILE, columns, TILE).mean(axis=(1, 3))
    return float(np.sqrt(tiles.max()))


def main() -> None:
    """Write the baselines."""
    FOLDER.mkdir(exist_ok=True)
    for name, draw in FIGURES.items():
        render(draw()).quantize(64).save(FOLDER / f"{name}.png", optimize=True)


if __name__ == "__main__":
    main()
