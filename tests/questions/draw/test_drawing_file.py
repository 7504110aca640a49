"""The drawing of a structure as DXF, read back by ezdxf and by the reader of `rocking import`."""

from warnings import catch_warnings, simplefilter

import ezdxf
import numpy as np
import pytest

import rocking_cli as rk
from rocking_cli.ask.watcher import Watcher
from rocking_cli.core import Direction
from rocking_cli.io.drawings import dxf
from rocking_cli.studies.picture import picture
from tests.cli.test_cli import run
from tests.conftest import EXAMPLES


def drawn(structure, tmp_path, **given):
    file = tmp_path / "drawn.dxf"
    rk.draw(structure, dxf=file, **given)
    drawing = dxf.read(file.read_bytes(), "drawn.dxf")
    assert drawing.unit == "m" and drawing.left_out == []
    return drawing


def on(drawing, layer):
    return [each.points for each in drawing.chains if each.layer == layer]


def texts(drawing, layer):
    return [each.text for each in drawing.labels if each.layer == layer]


def test_a_block_in_metres(tmp_path):
    drawing = drawn(rk.Block(width=1.0, height=4.0), tmp_path, at=0.5)
    document = ezdxf.readfile(tmp_path / "drawn.dxf")
    assert (document.dxfversion, document.units, document.header["$MEASUREMENT"]) == ("AC1015", 6, 1)
    assert not document.audit().errors
    (block,), (ground,) = on(drawing, "BLOCKS"), on(drawing, "GROUND")
    np.testing.assert_allclose(block, [-0.5, 0.5, 0.5 + 4j, -0.5 + 4j])
    assert not ground.imag.any() and ground.real.min() < -0.5 < 0.5 < ground.real.max()
    assert texts(drawing, "NAMES") == ["block"]
    (turned,), pivot = on(drawing, "DISPLACED_POSITIVE"), 0.5
    np.testing.assert_allclose(turned, pivot + (block - pivot) * np.exp(-0.5j * np.arctan(0.25)), atol=1e-9)
    assert len(on(drawing, "DISPLACED_NEGATIVE")) == 1
    assert not [each for each in drawing.spots if each.layer.startswith("HINGES")]  # its feet tell where it turns


def test_a_wall_with_a_window_keeps_its_mechanics(tmp_path):
    wall = [[0, 0], [2, 0], [2, 4], [0, 4]]
    window = [[1, 1.8], [1.8, 1.8], [1.8, 3], [1, 3]]
    given = rk.RigidBody(parts=[{"polygon": wall}, {"polygon": window, "opening": True}])
    drawing = drawn(given, tmp_path)
    (edge,), (opening,) = on(drawing, "BLOCKS"), on(drawing, "OPENINGS")
    corners = [[{"polygon": [[z.real, z.imag] for z in each]}] for each in (edge, opening)]
    again = rk.RigidBody(parts=[*corners[0], corners[1][0] | {"opening": True}])
    for side, expected in zip(Direction, (0.54205607, 0.48598131), strict=True):
        assert again.uplift(side) == pytest.approx(expected, abs=1e-8)
        assert again.critical_rotation(side) == pytest.approx(given.critical_rotation(side), rel=1e-9)
    (name,) = [each for each in drawing.labels if each.layer == "NAMES"]
    assert name.text == "body" and name.at.real == pytest.approx(0.5)  # beside the window


def test_hinges_and_supports_of_each_direction(tmp_path):
    drawing = drawn(rk.Wall(thickness=0.4, height=4.0), tmp_path)
    layers = "HINGES_POSITIVE", "HINGES_NEGATIVE"
    positive, negative = ([each.at for each in drawing.spots if each.layer == layer] for layer in layers)
    np.testing.assert_allclose(positive, [0.2, -0.2 + 2j])
    np.testing.assert_allclose(negative, [-0.2, 0.2 + 2j])
    (right,), (left,) = on(drawing, "SUPPORTS_POSITIVE"), on(drawing, "SUPPORTS_NEGATIVE")
    assert right[0] == pytest.approx(0.2 + 4j) and left[0] == pytest.approx(-0.2 + 4j)
    assert right[1].imag == pytest.approx(4.0)  # along a floor


def test_copies_have_names_of_their_own(tmp_path):
    loads = [{"name": "statue", "mass": 300.0, "at": [0.0, 3.0], "body": "columns", "each": True}]
    frame = rk.SymmetricFrame(column_width=1.0, column_height=6.0, columns=3, mass_ratio=1.0, mass=6e4, loads=loads)
    names = [each.partition("\n")[0] for each in texts(drawn(frame, tmp_path), "NAMES")]
    assert names == ["columns", "columns 2", "columns 3", "beam"]
    again = rk.import_drawing(tmp_path / "drawn.dxf", depth=1.0).structure
    assert [load.body for load in again.loads] == names[:3]
    for side in Direction:
        assert again.uplift(side) == pytest.approx(frame.uplift(side), rel=1e-8)


def test_densities_are_those_of_unequal_bodies(tmp_path):
    def stone(y, density):
        return {"polygon": [[0, y], [1, y], [1, y + 1], [0, y + 1]], "density": density}

    ground = {"floor": {"polygon": [[-1, -1], [2, -1], [2, 0], [-1, 0]]}}
    given = rk.Assembly(blocks={"low": stone(0, 1000), "high": stone(1, 2000)}, ground=ground, depth=0.5)
    drawing = drawn(given, tmp_path)
    assert texts(drawing, "NAMES") == ["low\n1000 kg/m3", "high\n2000 kg/m3"]
    assert {spot.layer for spot in drawing.spots} == {"THRUST"}  # hinges that were found, not given


def test_loads_and_ties_have_their_sizes(tmp_path):
    loads = [
        {"name": "roof", "mass": 3000.0, "at": [0.2, 4.0], "horizontal": 0.5, "vertical": 0.25},
        {"name": "vault", "force": [-12e3, 0.0], "at": [0.5, 2.0]},
    ]
    spring = {"stiffness": 1e6}
    bar = {"area": 452e-6, "modulus": 2.1e11, "prestress": 5e3}
    ties = [
        {"name": "chain", "from": {"ground": [-3.0, 3.0]}, "to": {"at": [-0.5, 3.0]}, **bar},
        {"name": "bar", "from": {"ground": [-3.0, 0.0]}, "to": {"at": [-0.5, 3.5]}, **spring, "only": "tension"},
        {"name": "tendon", "from": {"ground": [0.0, 0.0]}, "to": {"at": [0.0, 0.0]}, **spring},
    ]
    given = rk.Block(width=1.0, height=4.0, density=2000, depth=2.0, loads=loads, ties=ties)
    with pytest.warns(rk.DoubtWarning, match="does not tell the tie `tendon`: add it"):
        drawing = drawn(given, tmp_path)
    assert [(each.at, each.kind) for each in drawing.spots if each.layer == "LOADS"] == [(0.2 + 4j, "POINT")]
    (arrow,) = on(drawing, "LOADS")
    assert arrow[1] == pytest.approx(0.5 + 2j) and arrow[0].real > 0.5 and arrow[0].imag == pytest.approx(2.0)
    assert texts(drawing, "LOADS") == ["roof 3000 kg, horizontal 0.5, vertical 0.25", "vault 12000 N"]
    first, second = on(drawing, "TIES")
    np.testing.assert_allclose(first, [-3 + 3j, -0.5 + 3j])
    np.testing.assert_allclose(second, [-3, -0.5 + 3.5j])
    words = ["chain: area 0.000452 m2, modulus 210000000000.0 Pa, prestress 5000.0 N",
             "bar: stiffness 1000000.0 N/m, only tension"]  # fmt: skip
    assert texts(drawing, "TIES") == words
    anchors = [each for each in drawing.chains if each.layer == "GROUND" and each.closed]
    assert len(anchors) == 2 and -3 + 3j in anchors[0].points.round(9) and anchors[0].points.real.max() == -3
    assert texts(drawing, "NAMES") == ["block\n2000 kg/m3"]


def test_what_is_no_uniform_plate_is_told(tmp_path):
    with pytest.warns(rk.DoubtWarning, match="does not tell the mass of `cone`"):
        drawn(rk.Cone(base_radius=0.5, height=2.0), tmp_path)
    hollow = {"polygon": [[0, 0], [1, 0], [1, 2], [0, 2]], "mass": 1e3, "centroid": [0.5, 1], "inertia": 900}
    ground = {"floor": {"polygon": [[-1, -1], [2, -1], [2, 0], [-1, 0]]}}
    with pytest.warns(rk.DoubtWarning, match="does not tell the mass of `hollow`"):
        drawn(rk.Assembly(blocks={"hollow": hollow}, ground=ground), tmp_path)
    with pytest.warns(rk.DoubtWarning, match="does not tell the outline of `body`"):
        drawing = drawn(rk.RigidBody(R=1.5, alpha_deg=14, inertia_ratio=1.4), tmp_path)
    assert on(drawing, "ASSUMED") and not on(drawing, "BLOCKS")


def test_friction_of_crossing_walls_is_no_load(tmp_path):
    courses = {"courses": 40, "overlap": 0.2, "thickness": 0.5, "walls": 1, "height": 8.0}
    wall = rk.Block(width=0.6, height=8.0, density=2400, depth=1.0, interlock=courses, friction=0.4)
    with pytest.warns(rk.DoubtWarning, match="does not tell `friction`, `interlock`"):
        assert not texts(drawn(wall, tmp_path), "LOADS")


def test_dxf_alone_writes_nothing_else(tmp_path):
    (tmp_path / "b.yaml").write_text("mechanism: block\nwidth: 1\nheight: 4\n")
    result = run("draw", "b.yaml", "--dxf", "b.dxf")
    assert result.exit_code == 0 and "wrote b.dxf" in result.stderr
    assert sorted(each.name for each in tmp_path.iterdir()) == ["b.dxf", "b.yaml"]
    assert run("draw", "b.yaml", "--dxf", "b.dxf", "--plot", "b.png").exit_code == 0 and (tmp_path / "b.png").exists()
    wrong = run("draw", "b.yaml", "--dxf", "b.png", code=2)
    assert "does not end in .dxf" in wrong.stderr


def test_ties_of_steel_keep_their_data(tmp_path):
    bar = {"name": "bar", "from": {"ground": [-3.0, 3.0]}, "to": {"at": [-0.5, 3.0]}}
    steel = bar | {"bars": 2, "diameter": 0.006, "steel": "S235"}
    block = rk.Block(width=1.0, height=4.0, density=2000, depth=2.0)
    drawing = drawn(block.replace(ties=[steel]), tmp_path)
    assert texts(drawing, "TIES") == ["bar: bars 2, diameter 0.006 m, steel S235"]
    (again,) = rk.import_drawing(tmp_path / "drawn.dxf", depth=2.0).structure.ties
    assert (again.bars, again.diameter, again.steel) == (2, 0.006, "S235")
    yields = bar | {"area": 4e-5, "yield": 2.35e8}
    assert texts(drawn(block.replace(ties=[yields]), tmp_path), "TIES") == ["bar: area 4e-05 m2, yield 235000000.0 Pa"]


def test_each_of_several_loads_at_a_point_has_its_text(tmp_path):
    loads = [{"name": name, "mass": mass, "at": [0.0, 4.0]} for name, mass in (("roof", 3e3), ("snow", 1e3))]
    drawn(rk.Block(width=1.0, height=4.0, density=2000, depth=1.0, loads=loads), tmp_path)
    again = rk.import_drawing(tmp_path / "drawn.dxf", depth=1.0).structure
    assert {each.name: each.mass for each in again.loads} == {"roof": 3e3, "snow": 1e3}


def test_supports_of_bodies_at_rest_are_drawn(tmp_path):
    blocks = {
        "low": {"polygon": [[0, 0], [1, 0], [1, 1], [0, 1]]},
        "high": {"polygon": [[0.4, 1], [0.6, 1], [0.6, 2], [0.4, 2]]},
    }
    ground = {"floor": {"polygon": [[-1, -1], [2, -1], [2, 0], [-1, 0]]}}
    joints = {"S": {"slide": "low", "at": [0.0, 0.5], "along": [0.0, 1.0]}}
    drawing = drawn(rk.Assembly(blocks=blocks, ground=ground, joints=joints), tmp_path)
    ((at, across),) = on(drawing, "SUPPORTS")
    assert at == pytest.approx(0.5j) and across.imag == pytest.approx(0.5)


UNTOLD = {
    "linkages/beam_on_pier.yaml": "the body that guides `pier`",
    "verify/tied_facade.yaml": "`one_sided`, `rebound`; the further data of `bar`",
    "walls/gable.yaml": "`one_sided`, `rebound`",
}
SAME: dict[str, dict[str, object]] = {
    "linkages/portico.yaml": {"depth": 0.8}, "masonry/buttressed_arch.yaml": {"depth": 1.0},
    "spanning_wall.yaml": {"depth": 1.0}, "symmetric_frame.yaml": {},
    "walls/gable.yaml": {"depth": 1.0, "kind": "rigid_body"},
}  # fmt: skip
"""Options that the import of the drawing of an example needs to give the same structure."""
QUICK = {"walls/gable.yaml", "symmetric_frame.yaml"}


class Listener(Watcher):
    """Keeps notes."""

    def __init__(self):
        self.notes = []

    def note(self, text):
        self.notes.append(text)


@pytest.mark.parametrize("name", UNTOLD)
def test_what_the_drawing_lacks_is_told(name, tmp_path):
    with catch_warnings(record=True) as caught:
        simplefilter("always")
        rk.draw(rk.load_structure(EXAMPLES / name), dxf=tmp_path / "drawn.dxf")
    told = [str(each.message) for each in caught if "drawn.dxf" in str(each.message)]
    assert len(told) == 1 and f"does not tell {UNTOLD[name]}" in told[0]


@pytest.mark.filterwarnings("ignore::rocking_cli.DoubtWarning")
@pytest.mark.parametrize(
    "name", [name if name in QUICK else pytest.param(name, marks=pytest.mark.rest) for name in SAME]
)
def test_the_import_of_a_drawing_has_the_same_statics(name, tmp_path):
    given, file, listener = rk.load_structure(EXAMPLES / name), tmp_path / "drawn.dxf", Listener()
    rk.draw(given, dxf=file, watch=listener)
    assert all(f"`{key}` {value}" in listener.notes[-1] for key, value in SAME[name].items())
    again = rk.import_drawing(file, **SAME[name]).structure
    before, after = picture(given), picture(again)
    for side in given.directions:
        assert again.uplift(side) == pytest.approx(given.uplift(side), rel=1e-6)
        assert after.phi_cr[side] == pytest.approx(before.phi_cr[side], rel=1e-6)
