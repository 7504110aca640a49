"""The picture of an import: names whole and apart, what was left out in grey."""

from itertools import combinations

import numpy as np
import pytest

import rocking_cli as rk
from rocking_cli.plotting import style
from rocking_cli.studies.picture import picture
from tests.conftest import EXAMPLES

NAMES = {
    "Contrafforte della navata": (0.4, 3.0), "Muro perimetrale di facciata": (0.5, 0.5),
    "Arco trionfale": (0.6, 1.2), "Pilastro": (0.35, 2.5), "Rinfianco destro molto lungo": (0.3, 0.25),
    "Cuneo della stessa altezza": (0.1, 0.25), "Z": (1.9, 0.3),
}  # fmt: skip


@pytest.fixture(scope="module")
def imported(tmp_path_factory):
    ezdxf = pytest.importorskip("ezdxf")
    document, x = ezdxf.new(units=6), 0.0
    space = document.modelspace()
    for name, (width, height) in NAMES.items():
        corners = [(x, 0), (x + width, 0), (x + width, height), (x, height)]
        space.add_lwpolyline(corners, close=True, dxfattribs={"layer": "BLOCCHI"})
        at = (x + 0.02, 0.4 * height)
        space.add_text(name, height=0.02, dxfattribs={"layer": "BLOCCHI"}).set_placement(at)
        x += width
    space.add_linear_dim(base=(0, 3.15), p1=(0, 3), p2=(x, 0.3), dxfattribs={"layer": "QUOTE"}).render()
    space.add_line((1, -1), (1, 4), dxfattribs={"layer": "ASSI"})
    file = tmp_path_factory.mktemp("drawn") / "long.dxf"
    document.saveas(file)
    return rk.import_drawing(file, density=1800.0, depth=1.0)


def test_names_are_whole_and_apart(imported):
    figure = imported.plot()
    figure.canvas.draw()
    (axes,) = figure.axes
    texts = list(axes.texts)
    named = {" ".join(each.get_text().split()) for each in texts}
    assert named == NAMES.keys() - {"Cuneo della stessa altezza"}  # has no room beside its larger neighbour
    for one, other in combinations([each.get_window_extent() for each in texts], 2):
        assert not one.overlaps(other)
    assert {each.get_rotation() for each in texts} == {0, 90}


def test_what_is_left_out_is_grey(imported):
    (axes,) = imported.plot().axes
    lines = [each for each in axes.lines if each.get_color() == style.FAINT and each.get_xdata().size]
    grey = [each.get_xydata() for each in lines]
    assert any(np.allclose(each, [[1, -1], [1, 4]]) for each in grey)  # the axis
    ends = np.concatenate([each for each in grey if np.allclose(each[:, 1], 3.15)])  # a dimension, between its arrows
    assert 3.5 < np.ptp(ends[:, 0]) <= 4.15
    bodies = min(each.get_zorder() for each in axes.patches if each.get_facecolor()[3])
    assert min(each.get_zorder() for each in lines) > bodies


def test_a_structure_without_lengths_shows_its_size():
    storeys = rk.load_structure(EXAMPLES / "linkages" / "two_storeys.yaml")
    z = np.concatenate([corners for body in storeys.sketch().outlines.values() for corners in body])
    lengths = picture(storeys).sketch.lengths
    assert [each.symbol for each in lengths] == ["width", "height"]
    assert [each.value for each in lengths] == [np.ptp(z.real), np.ptp(z.imag)]
