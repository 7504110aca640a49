"""Pictures look as they did: compared with baselines, with a tolerance for another version of matplotlib.

`make pictures` writes the baselines anew.
"""

import pytest
from matplotlib.collections import PolyCollection
from matplotlib.contour import QuadContourSet
from matplotlib.lines import Line2D
from matplotlib.patches import Polygon
from PIL import Image

from tests.render import FIGURES, FOLDER, difference, render

TOLERANCE = 4.0  # of 255, in the tile that differs most; matplotlib 3.9 and 3.11 differ by less than 2


def baseline(name):
    return Image.open(FOLDER / f"{name}.png").convert("L")


@pytest.mark.every(4)
@pytest.mark.parametrize("name", FIGURES)
def test_it_looks_as_it_did(name):
    found = render(FIGURES[name]())
    worst = difference(found, baseline(name))
    if worst > TOLERANCE:
        found.save(f"{name}.png")  # in the folder of this test, to be looked at
    assert worst <= TOLERANCE, f"{name}.png differs by {worst:.1f}; if that is meant: make pictures"


def test_the_baselines_are_small_and_all_are_used():
    assert {path.stem for path in FOLDER.glob("*.png")} == set(FIGURES)
    assert all(path.stat().st_size < 25_000 for path in FOLDER.glob("*.png"))


def drop(axes, kind, keep):
    """Remove the elements of a kind from a panel that `keep` does not want."""
    gone = [each for each in axes.get_children() if isinstance(each, kind) and not keep(each)]
    assert gone
    for each in gone:
        each.remove()


@pytest.mark.every(2)
@pytest.mark.parametrize(
    ("name", "panel", "kind", "keep"),
    [
        ("draw_frame", 0, Polygon, lambda each: not each.get_fill()),  # the bodies at rest
        ("draw_frame", 2, Line2D, lambda each: each.get_marker() != "o" or each.get_fillstyle() != "full"),  # hinges
        ("draw_block", 1, Line2D, lambda each: each.get_fillstyle() != "top"),  # a centroid
        ("draw_block", 1, Polygon, lambda each: each.get_linestyle() == "-"),  # the faint outline at rest
        ("draw_arch", 0, Line2D, lambda each: each.get_color() != "#b3541e"),  # the line of thrust
        ("draw_wall", 0, Line2D, lambda each: each.get_marker() != "|"),  # the scale
        ("history", 1, Line2D, lambda each: each.get_marker() != "|"),  # the impacts
        ("history", 1, Line2D, lambda each: each.get_linestyle() != "--"),  # one of three models
        ("map", 0, Line2D, lambda each: False),  # the contours of the peak
        ("margin", 0, Line2D, lambda each: each.get_marker() != "*"),  # the motions themselves
        ("margin", 0, Line2D, lambda each: each.get_marker() != "|"),  # from where they uplift
        ("fragility", 0, Line2D, lambda each: each.get_marker() != "o"),  # what was observed
        ("fragility_of_four", 0, PolyCollection, lambda each: False),  # bands
        ("surface", 0, QuadContourSet, lambda each: False),  # the probability
    ],
)
def test_a_missing_element_is_seen(name, panel, kind, keep):
    figure = FIGURES[name]()
    drop(figure.axes[panel], kind, keep)
    assert difference(render(figure), baseline(name)) > TOLERANCE
