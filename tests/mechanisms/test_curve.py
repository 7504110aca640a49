"""A structure by its capacity curve: the block from its own, the shape in between, and files that are wrong."""

from math import radians, tan

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.interpolate import PchipInterpolator

from mechanisms.block import Block
from mechanisms.curve import Curve, MonotoneCubic
from rocking_cli.core import Direction, NoEquivalentBlock, equivalent_block
from rocking_cli.core.structure_file import load_structure, parse_structure
from rocking_cli.errors import InputError, StructureError
from rocking_cli.structure import Structure
from rocking_cli.testing import contract

POSITIVE, NEGATIVE = Direction
STRAIGHT = {"control_height": 2.0, "centroid_height": 1.4, "mass": 1000.0, "inertia": 2780.0}
FALLING = [[0.0, 0.2], [0.1, 0.15], [0.3, 0.1], [0.5, 0.0], [0.8, -0.1]]
REGISTRY = {"curve": Curve}


def of_a_block(count=200):
    """A block by the curve of its top."""
    block = Block(width=0.7, height=2.8, mass=1000.0)
    alpha = block.critical_rotation(POSITIVE)
    phi = np.append(np.linspace(0.0, alpha, count), alpha * np.linspace(1.01, 2.0, count))
    points = [[2.8 * float(x), tan(alpha - x)] for x in phi]
    inertia = float(block.kinetic_inertia(np.zeros(1), POSITIVE)[0])
    return block, Curve(points=points, control_height=2.8, centroid_height=1.4, mass=1000.0, inertia=inertia)


def test_a_block_is_what_its_own_curve_makes():
    block, found = of_a_block()
    one, other = (equivalent_block(each).negative.as_dict() for each in (found, block))
    assert one["lambda"] == pytest.approx(0.25, rel=1e-12)
    assert one["eta"] == pytest.approx(other["eta"], rel=1e-12)
    assert one == pytest.approx(other, rel=1e-5)
    phi = np.linspace(0.0, 0.48, 50)
    for name in ("I", "J", "G", "B", "V"):
        got, known = (getattr(each.coefficients(phi, POSITIVE), name) for each in (found, block))
        np.testing.assert_allclose(got, known, rtol=1e-6, atol=1e-3, err_msg=name)


def test_the_ratio_is_the_curve_and_the_energy_its_integral():
    found = Curve(points=FALLING, negative_points=[[0.0, 0.3], [0.4, 0.0]], **STRAIGHT)
    cubic = PchipInterpolator(*np.array(FALLING).T)
    phi = np.linspace(0.0, 0.24, 25)
    at = found.coefficients(phi, POSITIVE)
    assert [found.uplift(direction) for direction in Direction] == pytest.approx([0.2, 0.3])
    assert found.critical_rotation(POSITIVE) == pytest.approx(0.25)
    assert found.critical_rotation(NEGATIVE) == pytest.approx(0.2)
    np.testing.assert_allclose((at.G / at.B)[5:15], cubic(2.0 * phi)[5:15], rtol=1e-12)  # ends have other slopes
    np.testing.assert_allclose(at.G / at.B, cubic(2.0 * phi), atol=2e-3)
    np.testing.assert_allclose(at.I, 2780.0, rtol=1e-12)
    assert not at.J.any() or np.abs(at.J).max() < 1e-9
    arm = 1000.0 * 1.4 * np.hypot(1, 0.2)

    def moment(x):
        r = MonotoneCubic(np.array(FALLING)[:, 0] / 2, np.array(FALLING)[:, 1])(np.array(x))[0]
        return arm * float(r) / np.hypot(1, float(r))

    stored = quad(moment, 0.0, 0.24, points=[0.05, 0.15], epsabs=1e-12)[0]
    assert at.V[-1] == pytest.approx(stored, rel=1e-11)


def test_two_points_are_a_straight_line():
    found = Curve(points=[[0.0, 0.2], [0.5, 0.0]], **STRAIGHT)
    phi = np.array([0.0, 0.1, 0.25, 0.4])
    at = found.coefficients(phi, NEGATIVE)
    np.testing.assert_allclose(at.G / at.B, 0.2 * (1 - phi / 0.25), atol=1e-15)


def test_it_rises_and_falls_only_where_its_points_do():
    rng = np.random.default_rng(1)
    for _ in range(50):
        x, y = np.cumsum(rng.uniform(0.1, 1.0, 6)), rng.normal(size=6)
        cubic = MonotoneCubic(x, y)
        for k in range(5):
            values, slopes = cubic(np.linspace(x[k], x[k + 1] - 1e-9, 200))
            assert (np.diff(values) * np.sign(y[k + 1] - y[k]) >= -1e-12).all()
            assert np.sign(slopes[100]) in (0, np.sign(y[k + 1] - y[k]))


def test_a_curve_that_rises_has_no_equivalent_block():
    found = Curve(points=[[0.0, 0.1], [0.1, 0.15], [0.5, 0.0]], **STRAIGHT)
    with pytest.raises(NoEquivalentBlock, match=r"does not fall all the way from rest$"):
        equivalent_block(found)
    assert Structure(found).statics[0].phi_cr == pytest.approx(0.25)


def test_linear_models_mislead_where_it_is_far_from_straight():
    steep = Curve(points=[[0.0, 0.3], [0.02, 0.1], [0.5, 0.0]], **STRAIGHT)
    assert "the linear models mislead" in Structure(steep).misleading


@pytest.mark.parametrize(
    "structure",
    [
        Curve(points=FALLING, **STRAIGHT),
        Curve(points=[[0.0, 0.2], [0.5, 0.0]], negative_points=[[0.0, 0.3], [0.4, 0.05], [0.6, -0.2]], **STRAIGHT),
        of_a_block(5)[1],
    ],
)
def test_it_keeps_the_contract(structure):
    assert [each.why for each in contract(structure) if not each.passed] == []


TEXT = "mechanism: curve\nfile: c.csv\ncontrol_height: 2\ncentroid_height: 1.4\nmass: 1000\ninertia: 2780\n"


@pytest.mark.parametrize("sign", [",", ";", "\t", "  "])
def test_a_file_is_read_from_the_folder_of_the_structure(sign, tmp_path):
    (tmp_path / "sub").mkdir()
    rows = "# of an analysis\nd [m]" + sign + "ratio\n\n" + "".join(f"{d}{sign}{r}\n" for d, r in FALLING)
    (tmp_path / "sub" / "c.csv").write_text(rows, encoding="utf-8-sig")
    (tmp_path / "sub" / "s.yaml").write_text(TEXT, encoding="utf-8")
    found = load_structure(tmp_path / "sub" / "s.yaml", REGISTRY)
    assert found.points == FALLING and found.file is None
    (tmp_path / "sub" / "c.csv").unlink()
    assert found.model_copy(update={"mass": 900.0}).points == FALLING  # whole without its file
    for direction in Direction:
        assert found.enlarged(2.0).critical_rotation(direction) == pytest.approx(found.critical_rotation(direction))
    p = [equivalent_block(each).positive.p for each in (found, found.enlarged(4.0))]
    assert p[0] == pytest.approx(2 * p[1])


@pytest.mark.parametrize(
    ("rows", "said"),
    [
        (None, "c.csv: no such file"),
        ("", "has fewer than two rows"),
        ("0, 0.2\n0.1, 0.1\n0.1, 0.05\n0.2, 0\n", "line 3: the curve has two ratios at 0.1 m"),
        (
            "d, r\n0, 0.2\n0.2, 0.1\n0.1, 0\n",
            "line 4: the curve goes back from 0.2 to 0.1 m: displacements must increase",
        ),
        ("0.1, 0.2\n0.2, 0\n", "line 1: the curve begins at 0.1 m"),
        ("0, 0\n0.1, 0.2\n0.3, 0\n", "line 1: the curve has the ratio 0 at zero displacement"),
        ("0, 0.2\n0.1, 0.1\n", "line 2: the curve ends at the ratio 0.1: continue to zero"),
        ("0, 0.2\n0.1, -0.1\n0.2, 0\n", "line 3: the curve does not decrease at its end"),
        ("0;0,2\n0,1;0\n", "line 1 has 3 numbers, not two: displacement and ratio; write a decimal point"),
        ("0, 0.2\n0.1, nan\n", "line 2: the curve must be finite numbers"),
    ],
)
def test_a_wrong_file_is_told_with_its_line(rows, said, tmp_path):
    if rows is not None:
        (tmp_path / "c.csv").write_text(rows, encoding="utf-8")
    (tmp_path / "s.yaml").write_text(TEXT, encoding="utf-8")
    with pytest.raises(InputError) as caught:
        load_structure(tmp_path / "s.yaml", REGISTRY)
    (problem,) = caught.value.problems
    assert (problem.line, problem.column, problem.field) == (2, 7, "file")
    assert said in str(problem)


NUMBERS = TEXT.replace("file: c.csv", "points: [[0, 0.2], [0.5, 0]]")


@pytest.mark.parametrize(
    ("text", "place", "field", "said"),
    [
        (TEXT.replace("file: c.csv\n", ""), (1, 1), "points", "is missing: give the points of the curve, or a file"),
        (NUMBERS + "file: c.csv\n", (7, 7), "file", "cannot be combined with points"),
        (NUMBERS.replace("[0.5, 0]", "[0.5, 0, 1]"), (2, 20), "points[2]", "must be two numbers"),
        (NUMBERS.replace("2780", "2000"), (6, 10), "inertia", "at least m h_c^2 (1 + r(0)^2) = 2038.4 kg m2"),
        (NUMBERS.replace("height: 2\n", "height: 0.3\n"), (3, 17), "control_height", "beyond a quarter turn"),
        (NUMBERS + "loads: [{name: a, mass: 1, at: [0, 1]}]\n", (7, 8), "loads", "all that acts on the structure is"),
    ],
)  # fmt: skip
def test_wrong_numbers_are_told(text, place, field, said):
    with pytest.raises(InputError) as caught:
        parse_structure(text, "c.yaml", "c", REGISTRY)
    (problem,) = caught.value.problems
    assert ((problem.line, problem.column), problem.field) == (place, field)
    assert said in str(problem)


def test_eta_is_that_of_any_rigid_body():
    found = Curve(points=[[0.0, tan(radians(20.0))], [0.7, 0.0]], **{**STRAIGHT, "inertia": 3000.0})
    m_r2 = 1000.0 * (1.4 / np.cos(radians(20.0))) ** 2
    assert found.eta(POSITIVE) == pytest.approx(1 - 2 * m_r2 * np.sin(radians(20.0)) ** 2 / 3000.0, rel=1e-12)


@pytest.mark.parametrize("swapped", [False, True])
def test_the_inertia_given_is_that_of_both_directions(swapped):
    """Whichever direction has the longer way of the centroid."""
    one, other = [[0.0, 0.2], [0.1, 0.15], [0.5, 0.0]], [[0.0, 0.1], [0.1, 0.08], [0.3, 0.0]]
    points, negative = (other, one) if swapped else (one, other)
    made = Curve(
        mass=10e3, points=points, negative_points=negative, control_height=4.0, centroid_height=2.0, inertia=50e3,
        restitution=0.9,
    )  # fmt: skip
    for direction in Direction:
        found = made.coefficients(np.array([0.0, 0.02, made.critical_rotation(direction)]), direction)
        assert pytest.approx(50e3, rel=1e-12) == found.I


def test_a_step_of_the_curve_is_the_file_s_and_not_the_plugin_s():
    points = [[0.0, 0.2], [0.1, 0.15], [0.1001, 0.05], [0.5, 0.0]]
    steep = Curve(points=points, mass=1e4, control_height=4.0, centroid_height=2.0, inertia=5e4, restitution=0.9)
    with pytest.raises(StructureError, match=r"jumps at phi = 0\.02\d* rad .* its capacity curve, .* is as steep"):
        _ = Structure(steep).statics
