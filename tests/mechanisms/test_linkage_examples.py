"""The worked examples of linkages and assemblies: they are structures, and what their pages say of them is so."""

from functools import cache

import numpy as np
import pytest

import rocking_cli as rk
from rocking_cli.core import Direction, equivalent_block
from rocking_cli.dynamics.history import follow
from rocking_cli.studies.contact import Contacts
from rocking_cli.studies.movements import Watched, _landing
from rocking_cli.testing import contract
from tests.conftest import EXAMPLES
from tests.following import build_model

POSITIVE, NEGATIVE = Direction.POSITIVE, Direction.NEGATIVE
LINKAGES = sorted(path.stem for path in (EXAMPLES / "linkages").glob("*.yaml"))
MASONRY = ("buttressed_arch", "cracked_facade", "portal", "wall_of_three")


@cache
def structure(name):
    return rk.load_structure(EXAMPLES / f"{name}.yaml")


@pytest.mark.rest
@pytest.mark.parametrize("name", LINKAGES)
def test_a_linkage_of_the_gallery_is_equivalent_to_a_block_and_holds_the_contract(name):
    found = structure(f"linkages/{name}")
    blocks = equivalent_block(found)
    for direction in found.directions:
        block = blocks[direction]
        assert all(np.isfinite([block.p, block.phi_cr, block.lambda_, block.eta]))
        assert 0 < block.phi_cr < found.limit(direction)
    assert [each for each in contract(found) if not each.passed] == []
    page = (EXAMPLES.parent / "docs" / "mechanisms" / "linkage.md").read_text(encoding="utf-8")
    assert f"<!-- here: file examples/linkages/{name}.yaml -->" in page


@pytest.mark.every(2)
@pytest.mark.parametrize("name", MASONRY)
def test_a_worked_example_rocks(name):
    shaking = rk.GroundMotion("sine", 0.01, 8 * np.sin(2 * np.pi * np.arange(101) / 100), unit="m/s2")
    assert follow(build_model(structure(f"masonry/{name}"), "nonlinear"), shaking).lifted
    page = (EXAMPLES.parent / "docs" / "examples.md").read_text(encoding="utf-8")
    assert f"<!-- here: file examples/masonry/{name}.yaml -->" in page


def test_the_voussoirs_of_the_example_are_surveyed_ones():
    """Those of the field `voussoirs` to whole millimetres."""
    ring = {"span": 18.1441, "rise": 7.4454, "thickness": 1.5, "count": 7, "at": [0.0, 1.8046]}
    laid = rk.Assembly(density=2400, depth=1, voussoirs=ring)
    surveyed = structure("assembly")
    for name, shape in surveyed.blocks.items():
        assert np.abs(np.sort_complex(shape.corners) - np.sort_complex(laid.blocks[name].corners)).max() < 7.1e-4
    for s in Direction:
        assert laid.uplift(s) == pytest.approx(surveyed.uplift(s), rel=1e-3)


def test_the_arch_by_its_voussoirs_is_the_arch():
    """It weighs less by its straight sides: by a part of 600."""
    mine, arch = structure("assembly"), structure("arch")
    for s in Direction:
        assert mine.uplift(s) == pytest.approx(arch.uplift(s), rel=1e-3)
        assert mine.critical_rotation(s) == pytest.approx(arch.critical_rotation(s), rel=1e-3)
        assert mine.collapse(s).valid_to < 0.5 * mine.critical_rotation(s)


def test_the_facade_cracks_where_its_plinth_ends():
    """By hand about (0.6, 3.5): W 0.3 + P 0.4 + 20 4.7 - 4 5.5 over W 2.75, with the weight that the facade carries."""
    found = structure("masonry/cracked_facade")
    W, P = 1835 * 0.6 * 5.5 * 6.0 * 9.80665e-3, 3 * 9.80665  # kN; half of the 6 t
    expected = (W * 0.3 + P * 0.4 + 20 * 4.7 - 4 * 5.5) / (W * 2.75)
    assert found.uplift(POSITIVE) == pytest.approx(expected, rel=1e-6)
    assert found.extras(POSITIVE)[0].value == pytest.approx(3.5, abs=1e-5)


@pytest.mark.parametrize(("at", "crack"), [(8.2, 0.5), (6.0, 6.0)])
def test_a_stronger_tie_moves_the_crack_and_lower_down_gains_little(at, crack):
    """Three times as strong: near the top it nearly doubles lambda, at 6 m it gains next to nothing."""
    found = structure("masonry/cracked_facade")
    changed = {"at": [0.3, at], "force": [-60e3, 0.0]}
    loads = [load.model_copy(update=changed) if load.name == "tie" else load for load in found.loads]
    other = found.model_copy(update={"loads": loads})
    assert other.extras(POSITIVE)[0].value == pytest.approx(crack, abs=1e-3)
    gained = other.uplift(POSITIVE) / found.uplift(POSITIVE)
    assert 1.8 < gained < 2 if at > 8 else 1 < gained < 1.05


def test_the_ring_alone_bears_little_more_than_on_its_buttresses():
    found = structure("masonry/buttressed_arch")
    ring = rk.Arch(radius=3.2, thickness=0.5, inclusion_angle_deg=180, voussoirs=11)
    assert 1.1 < ring.uplift(POSITIVE) / found.uplift(POSITIVE) < 1.15
    collapse = found.collapse(POSITIVE)
    moves = [name for group in collapse.groups for name in group]
    assert "left" in collapse.rest and "right" in moves and "left" not in moves
    assert collapse.valid_to < 0.25 * found.critical_rotation(POSITIVE)


def test_joints_too_many_leave_the_forces_to_sums_over_the_whole():
    assert structure("linkages/portico").joints(POSITIVE) == ()
    assert len(structure("linkages/two_storeys").joints(POSITIVE)) == 5


def test_no_velocity_of_impacts_is_given_where_the_other_foot_rests():
    shaking = rk.read_record(EXAMPLES / "accel.csv")
    assert len(follow(build_model(structure("masonry/buttressed_arch"), "nonlinear"), shaking).impacts) > 10
    assert np.isnan(_landing(structure("masonry/buttressed_arch"), POSITIVE))
    assert _landing(structure("masonry/portal"), POSITIVE) == pytest.approx(0.9, rel=1e-9)


def test_the_portal_turns_as_a_frame_and_the_wall_at_its_upper_joint():
    portal, wall = structure("masonry/portal"), structure("masonry/wall_of_three")
    found = portal.collapse(POSITIVE)
    assert sorted(map(sorted, found.groups)) == [["left high", "left low"], ["lintel"], ["right high", "right low"]]
    assert found.friction_needed < 0.3 and found.valid_to is None
    assert all(sorted(map(sorted, wall._groups(s).groups)) == [["base", "middle"], ["top"]] for s in Direction)
    assert wall.uplift(POSITIVE) > 1.1 * wall.uplift(NEGATIVE)


def test_what_bears_on_a_body_at_rest_bears_on_the_ground():
    """The shear of the facade through its crack: mass times acceleration of what turns, the thrust and the tie."""
    (joint,) = structure("masonry/cracked_facade").joints(POSITIVE)
    assert joint.bodies == ("facade 2",) and joint.normal == pytest.approx(1j)
    for s in Direction:
        (joint,) = structure("linkages/pinnacle_on_buttress").joints(s)
        assert joint.bodies == ("pinnacle",) and joint.normal == pytest.approx(1j)
    shaking = rk.GroundMotion("sine", 0.01, 8 * np.sin(2 * np.pi * np.arange(101) / 100), unit="m/s2")
    facade = structure("masonry/cracked_facade")
    history = follow(build_model(facade, "nonlinear"), shaking)
    assert Contacts(facade).check(history, shaking).base_shear > 1e3


def test_a_point_that_a_joint_holds_does_not_move_by_rounding():
    moves = Watched(structure("masonry/wall_of_three"))
    (held,) = [spot for name, spot in moves.points.items() if name == "floor"]
    found = moves._displacement(held, np.linspace(0, 0.1, 11), POSITIVE)
    assert (found.real == 0).all() and (found.imag[1:] > 0).all()


def test_a_load_on_what_rests_changes_nothing(tmp_path):
    """Below the crack the facade stands still: a mass and a force there neither move nor load a joint."""
    text = (EXAMPLES / "masonry" / "cracked_facade.yaml").read_text(encoding="utf-8")
    more = (
        "  - {name: altar, mass: 900, at: [0.2, 0.1], body: facade}\n"
        "  - {name: strut, force: [3 kN, 2 kN], at: [1.0, 0.2], body: facade}\n"
    )
    answers = []
    for k, content in enumerate((text, text + more)):
        file = tmp_path / f"{k}.yaml"
        file.write_text(content, encoding="utf-8")
        answers.append(rk.respond(file, "sine:0.4g:0.8s", model="nonlinear", neighbours=0)["nonlinear"])
    one, other = answers
    assert one.peak_ratio == pytest.approx(other.peak_ratio, rel=1e-9) and one.peak_ratio > 0.1
    assert one.opening == pytest.approx(other.opening, abs=1e-12)


def test_what_all_but_falls_by_itself_needs_no_velocity(tmp_path):
    """A corner pulled in so far that the centroid is over the crack's edge at the height where lambda is least."""
    text = (EXAMPLES / "masonry" / "cracked_facade.yaml").read_text(encoding="utf-8")
    file = tmp_path / "f.yaml"
    file.write_text(text.replace("[1.1, 1.5]", "[0.0001, 1.5]"), encoding="utf-8")
    found = rk.equiv(file)
    assert 0 < found.positive.lambda_ < 1e-6 and 0 <= found.positive.v_imp < 1e-6
