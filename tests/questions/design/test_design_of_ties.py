"""Designs of ties: bars that give a force, and goals on displacements, drift and tie forces, by hand."""

from math import atan, cos, pi, sin

import numpy as np
import pytest

import rocking_cli as rk
from rocking_cli.ask.inputs import site_of
from rocking_cli.errors import InputError
from rocking_cli.structure import Structure
from rocking_cli.studies.neighbours import Neighbourhood, neighbours
from rocking_cli.verification.check import verify
from tests.core.test_ties_of_steel import MASS, PLATE, SITE, G, facade
from tests.following import conditions

FURTHER = {"SLD": {"ag": 0.08, "F0": 2.5, "TC": 0.4, "S": 1.2}}
CONSTANT = {"stiffness": 0, "prestress": 1e4}
PULSE = "sine:0.35g:0.6s"
AROUND = {"neighbours": 20, "slenderness_deviation": 0.0, "points": 2}


def verified(site, **tie):
    return verify(Structure(facade(stiffness=0, **tie)), site_of(site))


def lambda_of(force):
    """A block of 0.6 x 8 m with a force 7.5 m above its foot."""
    return 0.6 / 8 + force * 7.5 / (MASS * G * 4.0)


def by_yield(count, diameter, stress=235e6):
    return count * pi * diameter**2 / 4 * stress


@pytest.mark.parametrize(
    ("tie", "vary", "force", "bars"),
    [
        (CONSTANT, "prestress=1kN:300kN", 137e3, [(1, 0.028), (2, 0.020)]),
        (CONSTANT, "prestress=1kN:900kN", 750e3, [(4, 0.032)]),  # 189 kN each
        (CONSTANT, "prestress=1kN:300kN", 26e3, [(1, 0.012)]),  # two would not be thinner
        (CONSTANT, "prestress=1kN:900kN", 800e3, []),
        ({"area": 1e-4, "yield": 2e8}, "area=10mm2:2000mm2", 100e3, [(1, 0.026), (2, 0.018)]),  # 200 MPa
        ({"bars": 3, "diameter": 0.01, "steel": "S275"}, "diameter=6mm:40mm", 100e3, [(3, 0.014)]),
        ({"spacing": 2.0, "diameter": 0.01, "steel": "S235"}, "diameter=6mm:40mm", 100e3, [(2.5, 0.016)]),
        ({"spacing": 2.0, "diameter": 0.01, "steel": "S235"}, "spacing=0.5m:9m", 30e3, [(1, 0.014), (2, 0.012)]),
    ],
)  # fmt: skip
def test_the_answer_in_steel(tie, vary, force, bars):
    found = rk.design(facade(**tie), f"ties.bar.{vary}", f"alpha0 >= {lambda_of(force)!r}", points=7)
    assert found.steel.force == pytest.approx(force, rel=1e-9)
    assert [(each.number, each.diameter) for each in found.steel.proposals] == bars
    stress = found.steel.stress
    for count, diameter in bars:
        thinner = by_yield(count, diameter - 0.002, stress) * (diameter > 0.012)
        assert by_yield(count, diameter, stress) >= force > thinner
    said = found.sentences[0]
    if not bars:
        assert "The tie bar needs 800 kN, more than bars of up to 32 mm of S235, give." in said
        return
    shown = [f"{1000 * d:g} mm" for _, d in bars]
    assert f"The tie bar needs {force / 1e3:.4g} kN: " in said and all(each in said for each in shown)
    assert f"{bars[0][1] * 1000:g} mm" in said and f"({by_yield(*bars[0], stress) / 1e3:.4g} kN)" in said
    assert found.to_dict()["steel"]["bars"][0]["strength"] == {"yield": pytest.approx(by_yield(*bars[0], stress))}


def test_plates_of_the_tie_count():
    """Of each bar the plate bears 0.3 * 0.25 * 1.5 MPa = 112.5 kN and punches at 105 kN: 137 kN take two bars."""
    wall = {"thickness": 0.6, "compression": 1.5e6, "shear": 5e4}
    tied = facade(area=None, **{"steel": "S235", "bars": 2, "diameter": 0.01, "plate": PLATE, "wall": wall})
    found = rk.design(tied, "ties.bar.diameter=6mm:32mm", f"alpha0 >= {lambda_of(137e3)!r}", points=7)
    ((count, diameter, strength),) = found.steel.proposals
    assert (count, diameter) == (2, 0.020) and strength.limits["punching"] == pytest.approx(210e3)
    assert "not counted" not in found.sentences[0]
    assert rk.design(tied, "ties.bar.plate.width=0.1:0.5", f"alpha0 >= {lambda_of(20e3)!r}", points=7).steel is None
    at_rest = rk.design(tied, "ties.bar.diameter=6mm:32mm", "lambda >= 0.07", points=2)
    assert at_rest.everywhere and "ties.bar.diameter has no effect on it." in " ".join(at_rest.sentences)


@pytest.mark.parametrize(
    ("tie", "vary", "until"),
    [
        (CONSTANT, "ties.bar.prestress=1kN:300kN", "lambda <= 0.2"),  # the largest force
        ({"stiffness": 1e6}, "ties.bar.prestress=1kN:300kN", "lambda >= 0.2"),  # not constant
        (CONSTANT, "ties.bar.prestress=1kN:300kN", "lambda >= 9"),  # nowhere
        (CONSTANT, "ties.bar.to.at.1=2m:7.5m", "lambda >= 0.09"),  # the place of the tie
    ],
)
def test_no_answer_in_steel_where_no_least_force_is_found(tie, vary, until):
    found = rk.design(facade(**tie), vary, until, points=5)
    assert found.steel is None and found.to_dict()["steel"] is None and "needs" not in found.sentences[0]


@pytest.mark.parametrize("state", [pytest.param("SLD", marks=pytest.mark.rest), "SLV"])
def test_zeta_of_each_limit_state_is_that_of_verify(state):
    site = {**SITE, **FURTHER}
    level = {"SLD": 1.6, "SLV": 2.0}[state]
    until = f"zeta_{state} >= {level}"
    found = rk.design(facade(**CONSTANT), "ties.bar.prestress=1kN:200kN", until, site=site, points=2)
    just = verified(site, prestress=float(found.value)).directions[rk.Direction.POSITIVE]
    key = "SLD" if state == "SLD" else just.governing[state]
    assert just.methods[key].zeta == pytest.approx(level, rel=1e-6) and found.steel is not None


def test_a_state_that_the_site_does_not_give_is_said():
    missing = rk.design(facade(**CONSTANT), "width=0.6:0.7", "zeta_SLD > 0", site=SITE, points=2)
    assert "the site does not give what zeta_SLD requires" in " ".join(missing.sentences)


def of_wide(force):
    """How far the facade has moved at d_SLV with a tie that still holds then; d of one body is that of its centroid."""
    at = verified(SITE, prestress=float(force), elongation=0.5)
    moved = at.directions[rk.Direction.POSITIVE].states["SLV"].d
    return f"ties or forces still hold a block 0.6 m thick at SLV, when it has moved by {moved:.3g} m."


def test_an_answer_that_relies_on_a_long_tie_says_so():
    constant = {**CONSTANT, "elongation": 0.5}
    found = rk.design(facade(**constant), "ties.bar.prestress=1kN:200kN", "zeta_SLV >= 2", site=SITE, points=2)
    said = of_wide(found.value)
    assert said in " ".join(found.sentences)


@pytest.mark.parametrize(("level", "at"), [(0.1, 20.0), (100.0, 50.0)])
def test_an_answer_without_a_threshold_says_so_for_the_value_closest_to_the_requirement(level, at):
    """zeta grows with the force, so that the least force is closest to a low limit, and the largest to a high one."""
    vary = "ties.bar.prestress=20kN:50kN"
    found = rk.design(facade(**CONSTANT, elongation=0.5), vary, f"zeta_SLV >= {level}", site=SITE, points=3)
    assert found.value is None and found.decisive == pytest.approx(1e3 * at)
    start = f"Caution, with ties.bar.prestress = {at:g} kN: "
    said = " ".join(found.sentences)
    assert (start in said) == (of_wide(1e3 * at) in said) == (level < 1)  # what fails does not rely on it


BLOCK = {"name": "b", "width": 0.6, "height": 2.4, "mass": 2000.0, "restitution": 0.9}
ALPHA = atan(0.6 / 2.4)


def median(structure, ratio_of=lambda near: near.peak_ratio[1]):
    motion = rk.parse_pulse(PULSE).sampled()
    return ratio_of(neighbours(conditions(structure, Neighbourhood(20, slenderness=0.0)), motion))


@pytest.mark.parametrize(
    ("metric", "of"),
    [
        # the centroid (-0.3, 1.2) and the middle of the top (-0.3, 2.4) about the foot at (0, 0)
        ("peak_displacement", lambda phi: 0.3 * (1 - cos(phi)) + 1.2 * sin(phi)),
        ("drift", lambda phi: (0.3 * (1 - cos(phi)) + 2.4 * sin(phi)) / 2.4),
    ],
)
def test_displacements_of_a_block(metric, of):
    found = rk.design(rk.Block(**BLOCK), "gravity=9.80665:9.9", f"{metric} < 1", PULSE, **AROUND)
    phi = median(rk.Block(**BLOCK)) * ALPHA
    assert 0.01 < phi < ALPHA and found.metric[0] == pytest.approx(of(phi), rel=1e-9)
    assert found.aim.metric.unit == ("m" if metric == "peak_displacement" else "")


def test_the_drift_of_a_wall_that_is_held_at_its_top_is_that_of_its_hinge():
    """The hinge at mid-height of a wall of 0.3 x 3 m, whose lower half turns about the opposite edge of its foot."""
    wall = rk.Wall(thickness=0.3, height=3.0, restitution=0.9)
    found = rk.design(wall, "gravity=9.80665:9.9", "drift < 1", "sine:0.5g:0.3s", **AROUND)
    motion = rk.parse_pulse("sine:0.5g:0.3s").sampled()
    near = neighbours(conditions(wall, Neighbourhood(20, slenderness=0.0)), motion)
    phi = np.sort(near.rotations.max(axis=1))[9]
    assert phi > 1e-3 and found.metric[0] == pytest.approx((0.3 * (1 - cos(phi)) + 1.5 * sin(phi)) / 1.5, rel=1e-9)


def test_the_force_of_a_tie():
    """One of 1 MN/m that is 2 m long, from the ground to the left edge 2 m above the foot."""
    tie = {"name": "t", "from": {"ground": [-2.3, 2.0]}, "to": {"at": [-0.3, 2.0]}, "stiffness": 1e6, "only": "tension"}
    block = rk.Block(**{**BLOCK, "restitution": None}, one_sided="positive", rebound=0.5, ties=[tie])
    found = rk.design(block, "gravity=9.80665:9.9", "tie_force <= 90 kN", PULSE, **AROUND)
    motion = rk.parse_pulse(PULSE).sampled()
    near = neighbours(conditions(block, Neighbourhood(20, slenderness=0.0)), motion)
    phi = np.sort(near.rotations[:, 0])[9]  # the tenth of twenty
    end = 0.3 + (-0.6 + 2j) * np.exp(-1j * phi)
    force = 1e6 * (abs(end - (-2.3 + 2j)) - 2)
    assert force > 1e3 and found.metric[0] == pytest.approx(force, rel=1e-9)
    assert found.aim.level == 90e3 and "tie_force <= 90 kN" in found.sentences[0]


def test_what_a_structure_lacks_is_refused():
    stiff = facade(stiffness=1e6)
    for until, said in (
        ("peak_ratio < 0.1", "requires a critical rotation, .*: use peak_displacement, drift or tie_force"),
        ("tie_force < 1", "requires a tie, and the structure has none: add it to `ties`"),
    ):
        with pytest.raises(InputError, match=said):
            rk.design(stiff if "ratio" in until else rk.Block(**BLOCK), "height=7.9:8.1", until, PULSE, points=2)
    vary, pulse = "ties.bar.stiffness=0.001:1e6", "sine:0.2g:0.5s"
    part = rk.design(stiff, vary, "peak_ratio < 0.9", pulse, points=2, neighbours=5)
    assert np.isfinite(part.metric[0]) and np.isnan(part.metric[1]) and "critical rotation" in part.not_built[0].reason
