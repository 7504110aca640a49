"""The drawing of a structure as DXF, read back by ezdxf and by the reader of `rocking import`."""

import re

import ezdxf
import numpy as np
import pytest

import rocking_cli as rk
from rocking_cli.core import Direction
from rocking_cli.io.drawings import dxf
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


@pytest.mark.rest
def test_an_assembly_keeps_blocks_names_and_ground(tmp_path):
    given = rk.load_structure(EXAMPLES / "masonry" / "portal.yaml")
    with pytest.warns(rk.DoubtWarning, match="does not tell `friction`: add it"):
        drawing = drawn(given, tmp_path)
    names = {label.text: label.at for label in drawing.labels if not re.search("kg", label.text)}
    assert list(names) == [body.name for body in given.bodies()]
    blocks = on(drawing, "BLOCKS")
    within = {}
    for name, at in names.items():
        (within[name],) = [
            z for z in blocks if z.real.min() < at.real < z.real.max() and z.imag.min() < at.imag < z.imag.max()
        ]
    shapes = {name: {"polygon": [[z.real, z.imag] for z in each]} for name, each in within.items()}
    (floor,) = [each for each in drawing.chains if each.layer == "GROUND"]
    low = [[x, -1.0] for x in (floor.points.real.max(), floor.points.real.min())]
    top = sorted([z.real, z.imag] for z in floor.points if z.imag == floor.points.imag.max())
    ground = {"floor": {"polygon": [*top, *low]}}
    again = rk.Assembly(blocks=shapes, ground=ground, friction=given.friction)
    for side in Direction:
        assert again.uplift(side) == pytest.approx(given.uplift(side), rel=1e-9)
    assert [text for text in texts(drawing, "NAMES") if "kg" in text] == ["2500.0 kg/m3"] * len(names)
    assert on(drawing, "THRUST") and {spot.layer for spot in drawing.spots} == {"THRUST"}  # found, not given


def test_hinges_and_supports_of_each_direction(tmp_path):
    drawing = drawn(rk.Wall(thickness=0.4, height=4.0), tmp_path)
    hinges = {
        side: [each.at for each in drawing.spots if each.layer == f"HINGES_{side}"] for side in ("POSITIVE", "NEGATIVE")
    }
    np.testing.assert_allclose(hinges["POSITIVE"], [0.2, -0.2 + 2j])
    np.testing.assert_allclose(hinges["NEGATIVE"], [-0.2, 0.2 + 2j])
    (right,), (left,) = on(drawing, "SUPPORTS_POSITIVE"), on(drawing, "SUPPORTS_NEGATIVE")
    assert right[0] == pytest.approx(0.2 + 4j) and left[0] == pytest.approx(-0.2 + 4j)
    assert right[1].imag == pytest.approx(4.0)  # along a floor


def test_copies_have_names_of_their_own(tmp_path):
    frame = rk.SymmetricFrame(column_width=1.0, column_height=6.0, columns=3, mass_ratio=1.0)
    names = [each for each in texts(drawn(frame, tmp_path), "NAMES") if "kg" not in each]
    assert names == ["columns", "columns 2", "columns 3", "beam"]


def test_densities_are_those_of_unequal_bodies(tmp_path):
    def stone(y, density):
        return {"polygon": [[0, y], [1, y], [1, y + 1], [0, y + 1]], "density": density}

    ground = {"floor": {"polygon": [[-1, -1], [2, -1], [2, 0], [-1, 0]]}}
    given = rk.Assembly(blocks={"low": stone(0, 1000), "high": stone(1, 2000)}, ground=ground, depth=0.5)
    assert texts(drawn(given, tmp_path), "NAMES") == ["low", "1000.0 kg/m3", "high", "2000.0 kg/m3"]


def test_loads_and_ties_have_their_sizes(tmp_path):
    loads = [
        {"name": "roof", "mass": 3000.0, "at": [0.2, 4.0]},
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
    with pytest.warns(rk.DoubtWarning, match="does not tell the tie `tendon`, how `bar` acts"):
        drawing = drawn(given, tmp_path)
    assert [(each.at, each.kind) for each in drawing.spots if each.layer == "LOADS"] == [(0.2 + 4j, "POINT")]
    (arrow,) = on(drawing, "LOADS")
    assert arrow[1] == pytest.approx(0.5 + 2j) and arrow[0].real > 0.5 and arrow[0].imag == pytest.approx(2.0)
    assert texts(drawing, "LOADS") == ["roof 3000.0 kg", "vault 12000.0 N"]
    first, second = on(drawing, "TIES")
    np.testing.assert_allclose(first, [-3 + 3j, -0.5 + 3j])
    np.testing.assert_allclose(second, [-3, -0.5 + 3.5j])
    words = ["chain: area 0.000452 m2, modulus 210000000000.0 Pa, prestress 5000.0 N", "bar: stiffness 1000000.0 N/m"]
    assert texts(drawing, "TIES") == words
    anchors = [each for each in drawing.chains if each.layer == "GROUND" and each.closed]
    assert len(anchors) == 2 and -3 + 3j in anchors[0].points.round(9) and anchors[0].points.real.max() == -3
    assert "2000.0 kg/m3" in texts(drawing, "NAMES")


def test_what_is_no_uniform_plate_is_told(tmp_path):
    with pytest.warns(rk.DoubtWarning, match="does not tell the mass of `cone`"):
        drawn(rk.Cone(base_radius=0.5, height=2.0), tmp_path)
    hollow = {"polygon": [[0, 0], [1, 0], [1, 2], [0, 2]], "mass": 1e3, "centroid": [0.5, 1], "inertia": 900}
    ground = {"floor": {"polygon": [[-1, -1], [2, -1], [2, 0], [-1, 0]]}}
    with pytest.warns(rk.DoubtWarning, match="does not tell the mass of `hollow`"):
        drawn(rk.Assembly(blocks={"hollow": hollow}, ground=ground), tmp_path)
    with pytest.warns(rk.DoubtWarning, match="does not tell the mass of `body`"):
        drawing = drawn(rk.RigidBody(R=1.5, alpha_deg=14, inertia_ratio=1.4), tmp_path)
    assert on(drawing, "ASSUMED") and not on(drawing, "BLOCKS")


def test_dxf_alone_writes_nothing_else(tmp_path):
    (tmp_path / "b.yaml").write_text("mechanism: block\nwidth: 1\nheight: 4\n")
    result = run("draw", "b.yaml", "--dxf", "b.dxf")
    assert result.exit_code == 0 and "wrote b.dxf" in result.stderr
    assert sorted(each.name for each in tmp_path.iterdir()) == ["b.dxf", "b.yaml"]
    assert run("draw", "b.yaml", "--dxf", "b.dxf", "--plot", "b.png").exit_code == 0 and (tmp_path / "b.png").exists()
    wrong = run("draw", "b.yaml", "--dxf", "b.png", code=2)
    assert "does not end in .dxf" in wrong.stderr


def test_another_ending_and_a_missing_folder_are_refused(tmp_path):
    for name, words in (("b.dwg", "ends in .dxf"), ("none/b.dxf", "does not exist")):
        with pytest.raises(rk.InputError, match=words):
            rk.draw(rk.Block(width=1.0, height=4.0), dxf=tmp_path / name)
    assert not list(tmp_path.iterdir())
