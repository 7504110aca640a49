"""Pictures reduced to what must not change between versions of matplotlib: small, grey and without text.

`python -m tests.render` (or `make pictures`) writes the baselines in tests/pictures/ anew. Look at them before
committing them.
"""

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
from scipy.special import ndtr

from rocking_cli.ask.read import read_record
from rocking_cli.core.structure_file import load_structure
from rocking_cli.dynamics.history import History
from rocking_cli.dynamics.model import ModelName
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.plotting.structure import draw_structure
from rocking_cli.questions.fragility.assess import Bivariate, Fragility
from rocking_cli.questions.fragility.curves import fit_curve, fit_surface
from rocking_cli.questions.fragility.observed import Observations
from rocking_cli.questions.fragility.picture import draw_curves, draw_surface
from rocking_cli.questions.margin.picture import draw_margins
from rocking_cli.questions.margin.study import FACTORS, Margin
from rocking_cli.questions.overturning.picture import draw_map
from rocking_cli.questions.overturning.study import OverturningMap, overturning_map
from rocking_cli.questions.respond.picture import draw_history
from rocking_cli.studies.neighbours import Neighbourhood
from rocking_cli.studies.picture import picture
from rocking_cli.studies.under_pulses import linear_block, parse_shape
from tests.conftest import EXAMPLES
from tests.following import respond

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


def _margin() -> Figure:
    factors = np.union1d(FACTORS, 1.0)
    shares = np.clip(2 * np.log(factors), 0, 1) * np.where((factors > 2) & (factors < 2.6), 0.3, 1.0)  # and an island
    other = np.clip(np.log(factors / 0.6), 0, 0.95)
    none = np.zeros(factors.size)
    found = [
        Margin(Neighbourhood(), 0.4, factors, each, none, pga_g=0.3, polarities=(1, -1)) for each in (shares, other)
    ]
    return draw_margins({"one": found[0], "other": found[1]}, "margin")


def _seen(median: float, dispersion: float) -> Observations:
    """Stripes whose parts are those of a curve, of 40 records at 12 levels."""
    level, record = np.meshgrid(np.linspace(0.1, 1.2, 12), np.arange(40))
    part = (record * 17 % 40 + 0.5) / 40  # of each level the same parts, spread over the records
    exceeded = part < ndtr(np.log(level / median) / dispersion)
    return Observations.of(level.ravel(), exceeded.ravel(), record.ravel())


def _curves(*medians: float) -> Figure:
    seen = [_seen(each, 0.3 + 0.1 * k) for k, each in enumerate(medians)]
    curves = {f"{k}": Fragility("", "uplift", "PGA", each, fit_curve(each), None) for k, each in enumerate(seen)}
    return _of_one_height(draw_curves(curves, "PGA [g]", "curves"))


def _surface() -> Figure:
    random = np.random.default_rng(1)
    x1, x2 = np.exp(random.normal(size=(2, 60)))
    exceeding = (np.log(x1 * x2) > 0.5 * random.normal(size=60)).astype(int)
    surface = fit_surface(x1, x2, exceeding, np.arange(60))
    found = Bivariate("a", "uplift", ("PGA", "PGV"), x1, x2, np.ones(60, int), exceeding, surface)
    return _of_one_height(draw_surface(found, ("PGA [g]", "PGV [m/s]"), "surface"))


def _of_one_height(figure: Figure) -> Figure:
    """A figure that is not higher by its legend, whose height is that of a font."""
    figure.set_figheight(4.6)
    return figure


FIGURES: dict[str, Callable[[], Figure]] = {
    **{f"draw_{path.stem}": partial(_structure, path.stem) for path in sorted(EXAMPLES.glob("*.yaml"))},
    "history": _history,
    "map": _map,
    "margin": _margin,
    "fragility": partial(_curves, 0.5),
    "fragility_of_four": partial(_curves, 0.3, 0.5, 0.7, 0.9),
    "surface": _surface,
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
