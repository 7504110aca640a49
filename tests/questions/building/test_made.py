"""Every kind of mechanism of a building against the same one typed by hand, and against sums and integrals."""

import re
from contextlib import contextmanager
from math import cos, isclose, pi, radians, sqrt, tan
from typing import ClassVar

import numpy as np
import pytest
import yaml

import rocking_cli as rk
from rocking_cli.ask.inputs import site_of
from rocking_cli.core import Direction
from rocking_cli.errors import InputError
from rocking_cli.io.json_text import json_text
from rocking_cli.io.yaml_file import parse
from rocking_cli.questions.building.description import building_of
from rocking_cli.questions.building.made import (
    NotMade,
    arch,
    bending,
    corner,
    held_levels,
    overturning,
    standing,
    strips,
    with_bars,
)
from rocking_cli.questions.building.study import MechanismSearch, assess, first_period, floor_of
from rocking_cli.questions.building.view import words
from rocking_cli.structure import Structure
from rocking_cli.verification.check import verify
from tests.conftest import EXAMPLES

G = 9.80665
SITE = EXAMPLES / "verify" / "site.yaml"
MASONRY = {"density": 1800.0, "compression": 1.5e6, "shear": 5e4, "gamma": 2.0, "source": "a test"}


@contextmanager
def not_made(match):
    """Expect that a mechanism is not made, for a reason in English."""
    with pytest.raises(NotMade) as raised:
        yield
    assert re.search(match, words("en")(raised.value.why))


def building(walls, **fields):
    """A building of two storeys of 3 m, unless given."""
    whole = {"levels": [0.0, 3.0, 6.0], "masonry": MASONRY, "walls": walls, **fields}
    return building_of(parse(json_text(whole), "house.yaml", "building", "a hint"))


def site_at(z, H=6.0, n=2):
    """The site as its file would have it for a height in the building, in numbers of the Italian code."""
    fields = yaml.safe_load(SITE.read_text())
    if z > 0:
        T1 = 0.05 * H**0.75
        late = {"T1": 1.75 * T1, "xi1": 0.10}
        fields["floor"] = {"z": z, "H": H, "n": n, **late, "SLD": {"T1": T1, "xi1": 0.05}, "SLC": late}
    return site_of(fields)


def numbers(structure, place):
    """Every number that is compared, by its name."""
    mechanism, out = structure.mechanism, {"zeta": verify(structure, place).ratio}
    for side in mechanism.directions:
        curve = mechanism.coefficients(np.linspace(0.0, 0.1, 5), side)
        out |= {f"{key} {side.label}": getattr(curve, key).tolist() for key in ("I", "B", "G", "Q")}
        out[f"lambda {side.label}"] = [mechanism.uplift(side)]
        if structure.why_no_block is None:
            block = structure.equivalence[side]
            out[f"block {side.label}"] = [block.p, block.phi_cr, block.kappa1]
    return {key: np.ravel(each) for key, each in (out | {"mass": mechanism.total_mass()}).items()}


def same(house, made, typed, z, H=6.0, n=2):
    """Assert that a mechanism is the one typed by hand, at a height that is typed too."""
    assert made.z == z
    one = numbers(Structure(made.structure()), floor_of(house, site_of(SITE), made.z))
    other = numbers(Structure(typed), site_at(z, H, n))
    assert one.keys() == other.keys()
    for key, values in other.items():
        np.testing.assert_allclose(one[key], values, rtol=1e-12, atol=1e-12 * np.abs(values).max(), err_msg=key)


def plate(x0, x1, y0, y1, depth, **own):
    return {"polygon": [[x0, y0], [x1, y0], [x1, y1], [x0, y1]], "depth": depth, **own}


class TestWalls:
    PLAIN: ClassVar = {"name": "back", "length": 5.0, "thickness": 0.5}

    @pytest.mark.parametrize(("z", "height"), [(0.0, 6.0), (3.0, 3.0), (4.4, 1.6)])
    def test_a_plain_wall(self, z, height):
        house = building([self.PLAIN])
        typed = rk.Block(width=0.5, height=height, depth=5.0, density=1800.0, one_sided="positive")
        same(house, overturning(house, house.walls[0], z), typed, z)

    STEPPED: ClassVar = {
        "name": "front", "length": 8.0, "thickness": [0.6, 0.4],
        "openings": [
            {"storey": 1, "x": 1.0, "z": 0.0, "width": 1.0, "height": 2.0},
            {"storey": 2, "x": 1.0, "z": 1.0, "width": 1.5, "height": 1.2},
            {"storey": 2, "x": 4.0, "z": 1.0, "width": 0.5, "height": 1.2},
        ],
    }  # fmt: skip

    @pytest.mark.parametrize(
        ("z", "parts"),
        [
            (0.0, [plate(-0.3, 0.3, 0, 2, 7.0), plate(-0.3, 0.3, 2, 3, 8.0), plate(-0.1, 0.3, 3, 4, 8.0),
                   plate(-0.1, 0.3, 4, 5.2, 6.0), plate(-0.1, 0.3, 5.2, 6, 8.0)]),
            (1.2, [plate(-0.3, 0.3, 0, 0.8, 7.0), plate(-0.3, 0.3, 0.8, 1.8, 8.0), plate(-0.1, 0.3, 1.8, 2.8, 8.0),
                   plate(-0.1, 0.3, 2.8, 4, 6.0), plate(-0.1, 0.3, 4, 4.8, 8.0)]),
            (3.0, [plate(-0.2, 0.2, 0, 1, 8.0), plate(-0.2, 0.2, 1, 2.2, 6.0), plate(-0.2, 0.2, 2.2, 3, 8.0)]),
            (4.6, [plate(-0.2, 0.2, 0, 0.6, 6.0), plate(-0.2, 0.2, 0.6, 1.4, 8.0)]),
        ],
    )  # fmt: skip
    def test_thicknesses_and_openings(self, z, parts):
        house = building([self.STEPPED])
        typed = rk.RigidBody(parts=parts, density=1800.0, depth=8.0, one_sided="positive")
        same(house, overturning(house, house.walls[0], z), typed, z)

    @pytest.mark.parametrize(("z", "depth"), [(0.0, 7.0), (1.2, 7.0), (4.6, 6.0), (2.5, 8.0)])
    def test_a_hinge_crushes_beside_openings(self, z, depth):
        """The hinge has the length of what stands on it: u = N/(2 strength length)."""
        house = building([self.STEPPED], masonry=MASONRY | {"crushing": 2e6})
        wall = overturning(house, house.walls[0], z).structure()
        weight = wall.total_mass() * G
        assert wall.inwards(Direction.POSITIVE, "foot") == pytest.approx(weight / (2 * 2e6 * depth), rel=1e-9)

    def test_a_wall_that_begins_above_the_ground(self):
        wall = {"name": "w", "length": 5.0, "thickness": [0.3], "storeys": [2, 2], "on": "beam", "density": 1200.0}
        house = building([wall, self.PLAIN])
        typed = rk.Block(width=0.3, height=3.0, depth=5.0, density=1200.0, one_sided="positive")
        same(house, overturning(house, house.walls[0], 3.0), typed, 3.0)
        first = next(MechanismSearch(house, site_of(SITE))._overturning(house.walls[0], 1, is_last=True))
        assert first.made.z == 3.0

    def test_the_top_of_a_wall_has_its_last_thickness(self):
        """A search of a wall with a gable ends there; that interlocks looks for the thickness of side walls too."""
        walls = [{"name": "w", "length": 6.0, "thickness": [0.6, 0.5], "sides": ["v"], "connection": "interlock"},
                 {**self.PLAIN, "name": "v"}]  # fmt: skip
        house = building(walls, interlock={"course": 0.2, "overlap": 0.2}, gables=[{"wall": "w", "height": 1.2}])
        alone, whole = standing(house, house.gables[0]), overturning(house, house.walls[0], 6.0)
        assert whole.structure().uplift(Direction.POSITIVE) == alone.structure().uplift(Direction.POSITIVE)


LOADED = {
    "walls": [{"name": "front", "length": 8.0, "thickness": [0.6, 0.4]}],
    "floors": [{"name": "deck", "level": 1, "load": 450.0, "span": 5.0, "walls": ["front"], "seat": 0.15}],
    "roof": {"load": 200.0, "span": 6.0, "walls": ["front"], "sliding": True, "thrust": 500.0},
    "ties": [{"level": 2, "below": 0.2, "walls": ["front"], "length": 6.0, "bars": 2, "diameter": 0.02, "steel": "S235",
              "plate": {"width": 0.25, "height": 0.3}}],
}  # fmt: skip


class TestLoads:
    TIE: ClassVar = {
        "name": "tie", "bars": 2, "diameter": 0.02, "steel": "S235", "plate": {"width": 0.25, "height": 0.3},
        "wall": {"thickness": 0.4, "compression": 1.5e6, "shear": 5e4, "gamma": 2.0, "source": "a test"},
    }  # fmt: skip

    def test_all_of_them_about_the_ground(self):
        """The deck bears 5 cm from the inner face of the lower storey, the roof in the middle of the upper one."""
        house = building(**LOADED)
        typed = rk.RigidBody(
            parts=[plate(-0.3, 0.3, 0, 3, 8.0), plate(-0.1, 0.3, 3, 6, 8.0)], density=1800.0, depth=8.0,
            one_sided="positive",
            loads=[
                {"name": "deck", "mass": 450.0 * 5 * 8, "at": [-0.25, 3.0], "floor": "borne", "seat": 0.15},
                {"name": "roof", "mass": 200.0 * 6 * 8, "at": [0.1, 6.0], "floor": "sliding"},
                {"name": "thrust", "force": [4000.0, 0.0], "at": [0.1, 6.0]},
            ],
            ties=[self.TIE | {"from": {"ground": [-6.1, 5.8]}, "to": {"at": [-0.1, 5.8]}}],
        )  # fmt: skip
        same(house, overturning(house, house.walls[0], 0.0), typed, 0.0)

    def test_a_floor_at_the_hinge_stays(self):
        house = building(**LOADED)
        typed = rk.Block(
            width=0.4, height=3.0, depth=8.0, density=1800.0, one_sided="positive",
            loads=[{"name": "roof", "mass": 200.0 * 6 * 8, "at": [0.0, 3.0], "floor": "sliding"},
                   {"name": "thrust", "force": [4000.0, 0.0], "at": [0.0, 3.0]}],
            ties=[self.TIE | {"from": {"ground": [-6.2, 2.8]}, "to": {"at": [-0.2, 2.8]}}],
        )  # fmt: skip
        same(house, overturning(house, house.walls[0], 3.0), typed, 3.0)

    def test_ties_below_the_hinge_hold_nothing(self):
        lower = {**LOADED["ties"][0], "level": 1, "name": "lower"}
        house = building(**{**LOADED, "ties": [lower, LOADED["ties"][0]]})
        names = [[tie["name"] for tie in overturning(house, house.walls[0], z).fields["ties"]] for z in (2.7, 2.8, 3.0)]
        assert names == [["lower", "tie"], ["tie"], ["tie"]]

    def test_openings_take_no_floor_away(self):
        """A wall with one opening over its whole height carries the floor of its whole length."""
        fields = {**LOADED, "walls": [{"name": "front", "length": 8.0, "thickness": 0.5, "openings": [
            {"storey": 1, "x": 1, "z": 0, "width": 2, "height": 3},
            {"storey": 2, "x": 1, "z": 0, "width": 2, "height": 3},
        ]}], "ties": [], "masonry": {"density": 1800.0}}  # fmt: skip
        house = building(**fields)
        typed = rk.Block(
            width=0.5, height=6.0, depth=6.0, density=1800.0, one_sided="positive",
            loads=[
                {"name": "deck", "mass": 450.0 * 5 * 8, "at": [-0.2, 3.0], "floor": "borne", "seat": 0.15},
                {"name": "roof", "mass": 200.0 * 6 * 8, "at": [0.0, 6.0], "floor": "sliding"},
                {"name": "thrust", "force": [4000.0, 0.0], "at": [0.0, 6.0]},
            ],
        )  # fmt: skip
        same(house, overturning(house, house.walls[0], 0.0), typed, 0.0)

    def test_other_bars_are_in_the_ties_of_their_level_only(self):
        ties = [{**LOADED["ties"][0], "level": level, "name": f"at {level}"} for level in (1, 2)]
        house = with_bars(building(**{**LOADED, "ties": ties}), 2, 0.03)
        assert [each.diameter for each in house.ties] == [0.02, 0.03]

    def test_its_multiplier_by_moments_about_the_hinge(self):
        """Sums of the page: weights of wall, half the floors, thrust, and the yield of the bars; no plate."""
        fields = {**LOADED, "ties": [{k: v for k, v in LOADED["ties"][0].items() if k != "plate"}]}
        house = building(**fields)
        w = 1800 * G * 8
        walls = [(0.6 * 3 * w, 0.3, 1.5), (0.4 * 3 * w, 0.2, 4.5)]  # weight, arm to the outer foot, height
        deck, roof = 450 * 5 * 8 * G, 200 * 6 * 8 * G
        stable = sum(weight * arm for weight, arm, _ in walls) + deck / 2 * 0.55 + roof / 2 * 0.2
        bars = 2 * pi * 0.02**2 / 4 * 235e6
        stable += bars * 5.8 - 500 * 8 * 6.0
        driving = sum(weight * height for weight, _, height in walls) + deck * 3 + roof / 2 * 6  # by the letter
        made = overturning(house, house.walls[0], 0.0).structure()
        answer = verify(Structure(made), site_at(0.0)).directions[Direction.POSITIVE]
        alpha = next(line.value for line in answer.workings if line.symbol == "alpha0")
        assert alpha == pytest.approx(stable / driving, rel=1e-6)


class TestGables:
    WALLS = ({"name": "side", "length": 6.0, "thickness": 0.5},)
    GABLE = ({"wall": "side", "height": 1.2, "thickness": 0.3},)
    LENGTHS = 5.5, 4.5, 3.5, 2.5, 1.5, 0.5  # of six strips of 0.2 m

    @pytest.mark.parametrize(("z", "low"), [(0.0, 6.0), (3.0, 3.0)])
    def test_a_wall_with_its_gable(self, z, low):
        house = building(self.WALLS, gables=self.GABLE)
        parts = [plate(-0.25, 0.25, 0, low, 6.0)]
        parts += [plate(-0.05, 0.25, low + 0.2 * k, low + 0.2 * (k + 1), b) for k, b in enumerate(self.LENGTHS)]
        typed = rk.RigidBody(parts=parts, density=1800.0, depth=6.0, one_sided="positive")
        same(house, overturning(house, house.walls[0], z), typed, z)
        bare = rk.Block(width=0.5, height=low, depth=6.0, density=1800.0, one_sided="positive")
        same(house, overturning(house, house.walls[0], z, gable=False), bare, z)

    def test_a_gable_alone(self):
        house = building(self.WALLS, gables=self.GABLE)
        parts = [plate(-0.15, 0.15, 0.2 * k, 0.2 * (k + 1), b) for k, b in enumerate(self.LENGTHS)]
        typed = rk.RigidBody(parts=parts, density=1800.0, depth=5.5, one_sided="positive")
        same(house, standing(house, house.gables[0]), typed, 6.0)

    def test_a_gable_about_a_higher_hinge_shakes_with_the_top_of_the_walls(self):
        house = building(self.WALLS, gables=self.GABLE)
        lengths = 2.75, 2.25, 1.75, 1.25, 0.75, 0.25  # of six strips of 0.1 m
        parts = [plate(-0.15, 0.15, 0.1 * k, 0.1 * (k + 1), b) for k, b in enumerate(lengths)]
        typed = rk.RigidBody(parts=parts, density=1800.0, depth=2.75, one_sided="positive")
        same(house, standing(house, house.gables[0], 6.6), typed, 6.0)

    def test_strips_against_the_triangle(self):
        """The mass is exact; the centroid is 1/(2 n^2) of h/3 too high, 1.4 % with six."""
        house = building(self.WALLS, gables=self.GABLE)
        body = standing(house, house.gables[0]).structure()
        assert body.total_mass() == pytest.approx(1800 * 0.3 * 6 * 1.2 / 2, rel=1e-12)
        assert body.bodies()[0].centroid.imag == pytest.approx(0.4 * (1 + 1 / 72), rel=1e-9)


class TestSideWalls:
    COURSES: ClassVar = {"course": 0.2, "overlap": 0.2, "angle": 20.0, "friction": 0.6}
    FRONT: ClassVar = {"name": "front", "length": 8.0, "thickness": 0.6, "sides": ["a", "b"], "connection": "interlock"}
    A: ClassVar = {"name": "a", "length": 7.0, "thickness": 0.5}
    B: ClassVar = {"name": "b", "length": 7.0, "thickness": 0.4, "density": 1500.0}
    T = tan(radians(20.0))

    def front(self, z=0.0, angle=None, *, a=A, b=B, front=FRONT, **courses):
        house = building([front, a, b], interlock=self.COURSES | courses)
        return house, overturning(house, house.walls[0], z, angle)

    def test_a_vertical_crack_leaves_friction_alone(self):
        b = {**self.B, "density": 1800.0}
        house, made = self.front(angle=0.0, b=b)
        typed = rk.Block(
            width=0.6, height=6.0, depth=8.0, density=1800.0, one_sided="positive",
            interlock={"courses": 30, "overlap": 0.2, "thickness": 0.45, "walls": 2, "friction": 0.6, "height": 6.0},
        )  # fmt: skip
        same(house, made, typed, 0.0)

    @pytest.mark.parametrize(("z", "rows", "top"), [(0.0, 30, 2.1838), (3.0, 15, 1.0919), (3.5, 12, 0.9099)])
    def test_wedges_and_what_is_left_of_overlaps(self, z, rows, top):
        house, made = self.front(z)
        density = (0.5 * 1800 + 0.4 * 1500) / 0.9
        high = 6.0 - z
        wedge = {"polygon": [[-0.3, 0], [-0.3, high], [-0.3 - top, high]], "depth": 0.9, "density": density}
        friction = {"courses": rows, "overlap": round(0.2 - 0.2 * self.T, 6), "thickness": (0.5 + 0.4 / 1.2) / 2}
        typed = rk.RigidBody(
            parts=[plate(-0.3, 0.3, 0, high, 8.0), wedge], density=1800.0, depth=8.0, one_sided="positive",
            interlock=friction | {"walls": 2, "friction": 0.6, "height": rows * 0.2, "density": 1800.0},
        )  # fmt: skip
        same(house, made, typed, z)

    def test_the_reach_of_side_walls_bounds_weight_and_friction(self):
        """Above 2.7475 m nothing of the side walls is left: in the lowest share b is 3 b^2 - 2 b^3 of the moment."""
        house, made = self.front(reach=1.0, b={**self.B, "density": 1800.0})
        wedge = {"polygon": [[-0.3, 0], [-0.3, 6], [-1.3, 6], [-1.3, 2.7475]], "depth": 0.9, "density": 1800.0}
        b = 1 / self.T / 6
        friction = {"courses": 30, "overlap": round(0.2 - 0.2 * self.T, 6), "walls": 2, "friction": 0.6, "height": 6.0}
        typed = rk.RigidBody(
            parts=[plate(-0.3, 0.3, 0, 6, 8.0), wedge], density=1800.0, depth=8.0, one_sided="positive",
            interlock=friction | {"thickness": 0.45 * (3 * b**2 - 2 * b**3)},
        )  # fmt: skip
        same(house, made, typed, 0.0)

    def test_friction_by_a_sum_over_courses(self):
        """The moment of what rubs, course by course, with any thickness, density, height, and reach of each wall."""
        course, mu = 0.01, 0.6
        _, made = self.front(reach=1.0, course=course, overlap=0.01, a={**self.A, "storeys": [1, 1]})
        left, total = 0.01 - 0.01 * self.T, 0.0
        for t, density, high in ((0.5, 1800, 3.0), (0.4, 1500, 6.0)):
            y = np.arange(course, high, course)
            y = y[y < min(high, 1 / self.T)]
            total += (0.8 * mu * density * G * t * left * (high - y) * y).sum()
        friction = next(each for each in made.structure().attached if getattr(each, "friction", False))
        assert abs(friction.thrust) * friction.spot.at.imag == pytest.approx(total, rel=0.02)

    def test_a_lower_side_wall_rubs_up_to_its_top(self):
        """A side wall of one storey of two has an eighth of the moment, not all of it."""
        lower = {"a": {**self.A, "storeys": [1, 1]}, "b": {**self.A, "name": "b", "storeys": [1, 1]}}
        _, low = self.front(angle=0.0, **lower)
        assert (low.fields["interlock"]["courses"], low.fields["interlock"]["height"]) == (15, 3.0)
        house = building([self.FRONT, lower["a"], {**self.A, "name": "b"}], interlock=self.COURSES)
        mixed = overturning(house, house.walls[0], 0.0, 0.0).fields["interlock"]
        assert mixed["thickness"] == pytest.approx((0.5 + 0.5 * 15**2 * 16 / (30**2 * 31)) / 2)
        assert overturning(house, house.walls[0], 3.0, 0.0).fields["interlock"]["walls"] == 1

    def test_a_lower_side_wall_has_a_lower_wedge(self):
        _, made = self.front(a={**self.A, "storeys": [1, 1]}, b={**self.B, "density": 1800.0})
        body = made.structure()
        wedges = 0.9 * 3 * 3 * self.T / 2 + 0.4 * 3 * (3 + 6) * self.T / 2
        assert body.total_mass() == pytest.approx(1800 * (0.6 * 6 * 8 + wedges), rel=1e-4)

    def test_a_side_wall_that_grows_thinner_has_a_thinner_wedge(self):
        _, made = self.front(a={**self.A, "thickness": [0.5, 0.3]}, b={**self.B, "density": 1800.0})
        wedges = 0.9 * 3 * 3 * self.T / 2 + 0.7 * 3 * (3 + 6) * self.T / 2
        assert made.structure().total_mass() == pytest.approx(1800 * (0.6 * 6 * 8 + wedges), rel=1e-4)
        assert made.fields["interlock"]["thickness"] == pytest.approx((0.3 + 0.4) / 2)

    def test_a_wedge_ends_with_its_wall(self):
        """A side wall of 1.6 m has 1 m behind a wall of 0.6 m."""
        _, made = self.front(a={**self.A, "length": 1.6})
        _, given = self.front(reach=1.0)
        assert made.fields == given.fields

    def test_wedges_behind_its_foot_lean_on_the_building(self):
        """At 45 degrees no friction is left: two wedges of 6 x 6 m, whose weight keeps the wall from standing alone."""
        _, made = self.front(angle=pi / 4, b={**self.A, "name": "b"})
        wall, wedges = 0.6 * 6 * 8, 2 * 0.5 * 6 * 6 / 2
        by_hand = (wall * 0.3 + wedges * (0.6 + 2)) / (wall * 3 + wedges * 4)
        structure = made.structure()
        assert structure.uplift(Direction.POSITIVE) == pytest.approx(by_hand, rel=1e-4)
        assert structure.total_mass() == pytest.approx(1800 * (wall + wedges), rel=1e-6)
        assert verify(Structure(structure), site_at(0.0)).ratio > 1

    def test_where_they_begin_to_lean_nothing_jumps(self):
        """Around the angle at which the weight is above the inner face, a body is by its parts, then by numbers."""
        angles = np.linspace(0.3, 0.5, 21)
        made = [self.front(angle=float(angle))[1] for angle in angles]
        ways = ["parts" in each.fields for each in made]
        k = ways.index(False)
        assert ways == [True] * k + [False] * (21 - k) and k > 1
        values = [each.structure().uplift(Direction.POSITIVE) for each in made[k - 2 : k + 2]]
        assert np.abs(np.diff(values, 2)).max() < 1e-4
        inertias = [each.structure().coefficients(np.zeros(1), Direction.POSITIVE).I[0] for each in made[k - 2 : k + 2]]
        assert np.abs(np.diff(inertias, 2)).max() < 1e-3 * inertias[0]

    def test_their_solid_by_quadrature(self):
        """Mass, centroid and inertia of wall and wedges by a fine grid of points of the solid."""
        _, made = self.front(b={**self.B, "density": 1800.0}, reach=1.5)
        n = 600
        y, slope = (np.arange(n) + 0.5) * 6 / n, self.T
        x = -0.3 - (np.arange(n) + 0.5) * 1.5 / n
        grid_x, grid_y = np.meshgrid(x, y)
        inside = -0.3 - grid_x < grid_y * slope
        cell = 0.9 * (6 / n) * (1.5 / n)
        masses = 1800 * cell * inside
        wall = 1800 * 0.6 * 6 * 8
        total = wall + masses.sum()
        cx, cy = (masses * grid_x).sum() / total, (wall * 3 + (masses * grid_y).sum()) / total
        inertia = wall * ((0.6**2 + 6**2) / 12 + cx**2 + (3 - cy) ** 2)
        inertia += (masses * ((grid_x - cx) ** 2 + (grid_y - cy) ** 2)).sum()
        structure = made.structure()
        (body,) = structure.bodies()
        assert structure.total_mass() == pytest.approx(total, rel=1e-3)
        assert (body.centroid.real, body.centroid.imag) == pytest.approx((cx, cy), rel=2e-3)
        assert body.inertia / body.mass == pytest.approx(inertia / total, rel=2e-3)


class TestBending:
    def test_under_floors_and_walls(self):
        """The wall above is 0.1 m off the axis, as outer faces are flush; the deck bears 5 cm from the inner face."""
        fields = {**LOADED, "roof": {**LOADED["roof"], "sliding": False}, "ties": []}
        house = building(**fields)
        assert held_levels(house, house.walls[0]) == [0, 1, 2]
        above, deck, roof = 0.4 * 3 * 8 * 1800 * G, 450 * 5 * 8 * G / 2, 200 * 6 * 8 * G / 2
        load = above + deck + roof
        x = (above * 0.1 + deck * -0.25 + roof * 0.1) / load
        typed = rk.SpanningWall(thickness=0.6, height=3.0, hinge="weakest", overburden=round(load, 1),
                                overburden_eccentricity=round(x, 4), depth=8.0, density=1800.0)  # fmt: skip
        same(house, bending(house, house.walls[0], 0, 1), typed, 1.5)
        typed = rk.SpanningWall(thickness=0.4, height=3.0, hinge="weakest", overburden=round(roof, 1), depth=8.0,
                                density=1800.0)  # fmt: skip
        same(house, bending(house, house.walls[0], 1, 2), typed, 4.5)

    def test_openings_and_gables_weigh_as_they_are(self):
        wall = {"name": "w", "length": 6.0, "thickness": 0.5,
                "openings": [{"storey": 1, "x": 1, "z": 1, "width": 2, "height": 1.5}]}  # fmt: skip
        floor = {"name": "f", "level": 1, "load": 300.0, "span": 4.0, "walls": ["w"]}
        house = building([wall], floors=[floor], gables=[{"wall": "w", "height": 1.2, "thickness": 0.3}])
        upper, gable, floor = 0.5 * 3 * 6 * 1800 * G, 0.3 * 6 * 1.2 / 2 * 1800 * G, 300 * 4 * 6 * G / 2
        load, density = upper + gable + floor, 1800 * (1 - 2 * 1.5 / (6 * 3))
        typed = rk.SpanningWall(thickness=0.5, height=3.0, hinge="weakest", overburden=round(load, 1), depth=6.0,
                                overburden_eccentricity=round(gable * 0.1 / load, 4),
                                density=round(density, 4))  # fmt: skip
        same(house, bending(house, house.walls[0], 0, 1), typed, 1.5)

    def test_the_least_multiplier_by_the_closed_form(self):
        """Equal moments of two halves: alpha0 = 2 t/(xi h) [1 + rho (1 + k xi/(1 - xi))], least over xi."""
        fields = {**LOADED, "roof": {**LOADED["roof"], "sliding": False}, "ties": []}
        house = building(**fields)
        above, deck, roof = 0.4 * 3 * 8 * 1800 * G, 450 * 5 * 8 * G / 2, 200 * 6 * 8 * G / 2
        load = above + deck + roof
        rho, x = load / (0.6 * 3 * 8 * 1800 * G), (above * 0.1 + deck * -0.25 + roof * 0.1) / load
        xi = np.linspace(0.05, 0.95, 200_001)
        least = [(0.4 / xi * (1 + rho * (1 + (0.5 + s * x / 0.6) * xi / (1 - xi)))).min() for s in (1, -1)]
        wall = bending(house, house.walls[0], 0, 1).structure()
        assert [wall.uplift(side) for side in Direction] == pytest.approx(least, rel=1e-4)

    def test_crushing_has_the_hinge_of_the_weaker_side(self):
        fields = {**LOADED, "roof": {**LOADED["roof"], "sliding": False}, "ties": []}
        free = building(**fields)
        crushing = building(**fields, **{"masonry": MASONRY | {"crushing": 3e6}})
        hinged = bending(crushing, crushing.walls[0], 0, 1)
        sides = bending(free, free.walls[0], 0, 1).structure()
        weaker = min(Direction, key=sides.uplift)
        assert hinged.fields["hinge"] == pytest.approx(sides.hinges(weaker)[1].imag / 3.0, abs=1e-6)
        assert hinged.structure().uplift(weaker) < sides.uplift(weaker)

    def test_what_does_not_bend(self):
        house = building(**{**LOADED, "ties": []})
        wall = house.walls[0]
        assert held_levels(house, wall) == [0, 1]
        for levels, why in (((0, 2), "its thickness changes"),):
            with not_made(why):
                bending(house, wall, *levels)

    def test_a_wall_that_only_ties_hold_spans_to_them(self):
        """What is above the ties stands on it; ties at its top leave the hinge at the top, which is refused."""
        tie = {"level": 2, "walls": ["w"], "length": 5.0, "bars": 2, "diameter": 0.02, "steel": "S235"}
        wall = {"name": "w", "length": 5.0, "thickness": 0.5}
        tied = building([wall], ties=[{**tie, "below": 0.4}])
        typed = rk.SpanningWall(thickness=0.5, height=5.6, hinge="weakest", overburden=round(0.4 * 2.5 * 1800 * G, 1),
                                overburden_eccentricity=0.0, depth=5.0, density=1800.0)  # fmt: skip
        same(tied, bending(tied, tied.walls[0], 0, 2), typed, 2.8)
        at_top = building([wall], ties=[tie])
        with pytest.raises(InputError, match="without a load on top"):
            bending(at_top, at_top.walls[0], 0, 2).structure()
        floor = {"name": "deck", "level": 2, "load": 200.0, "span": 4.0, "walls": ["w"]}
        both = building([wall], ties=[{**tie, "below": 0.4}], floors=[floor])
        assert bending(both, both.walls[0], 0, 2).fields["height"] == 6.0


class TestReach:
    def side(self, **fields):
        """A building of a wall with one side wall, and the wall with its wedge about its foot."""
        walls = [{"name": "w", "length": 8.0, "thickness": 0.5, "sides": ["s"], "connection": "interlock"},
                 {"name": "s", "length": 7.0, "thickness": 0.4, "openings": fields.pop("openings", [])}]  # fmt: skip
        house = building(walls, interlock={"course": 0.2, "overlap": 0.15, **fields.pop("interlock", {})}, **fields)
        return house, overturning(house, house.walls[0], 0.0, 0.15)

    def back(self, made):
        return -0.25 - min(x for part in made.fields["parts"] for x, _ in part["polygon"])

    def test_only_what_is_before_an_opening_comes_along(self):
        """From the nearer end, as it is not known which meets the wall; but not an opening below the hinge."""
        opened = [{"storey": 1, "x": 1.2, "z": 0.0, "width": 1.0, "height": 2.0}]
        assert self.back(self.side()[1]) == pytest.approx(6 * tan(0.15), abs=1e-4)
        assert self.back(self.side(openings=opened)[1]) == pytest.approx(1.2 - 0.5)
        far = [{**opened[0], "x": 7.0 - 1.0 - 0.9}]
        house, made = self.side(openings=far)
        assert self.back(made) == pytest.approx(0.9 - 0.5)
        above = overturning(house, house.walls[0], 3.0, 0.15)
        assert self.back(above) == pytest.approx(3 * tan(0.15), abs=1e-4)
        assert self.back(self.side(openings=far, interlock={"reach": 0.6})[1]) == pytest.approx(0.6)

    @pytest.mark.parametrize("reach", [4e-5, 1e-4, 1e-3])
    def test_a_small_reach_is_nearly_none(self, reach):
        """With two parapets its body is by its numbers."""
        on = [{"wall": "w", "height": 0.8, "thickness": 0.3}, {"wall": "w", "height": 1.0, "thickness": 0.3}]
        house, made = self.side(interlock={"reach": reach}, parapets=on)
        _, none = self.side(interlock={"reach": 1e-6}, parapets=on)
        search = MechanismSearch(house, site_of(SITE))
        assert search.ratio(made) == pytest.approx(search.ratio(none), rel=5 * reach + 1e-3)

    def test_courses_that_stand_for_others_may_be_thin(self):
        """They rub as high as the crack has not run through the reach, with the moment of courses of less thickness."""
        house, _ = self.side(interlock={"reach": 0.3})
        made = overturning(house, house.walls[0], 0.0, 0.55)
        assert 0 < made.fields["interlock"]["thickness"] < 0.1
        assert MechanismSearch(house, site_of(SITE)).verified(made).ratio > 0

    def test_a_gable_and_a_parapet_on_one_wall_turn_with_it(self):
        """Beside each other along the wall: masses, centroid and inertia are those of all parts."""
        on = {"gables": [{"wall": "w", "height": 2.0, "thickness": 0.4}],
              "parapets": [{"wall": "w", "height": 1.0, "thickness": 0.3, "length": 3.0}]}  # fmt: skip
        house = building([{"name": "w", "length": 8.0, "thickness": 0.5}], **on)
        made = overturning(house, house.walls[0], 0.0)
        parts = strips(house, house.walls[0], 0.0, 6.0)
        masses = [1800 * 0.5 * 8 * 6, 1800 * 0.4 * 8 * 2 / 2, 1800 * 0.3 * 3 * 1]
        assert len(parts) == 1 and made.fields["mass"] == pytest.approx(sum(masses), rel=1e-9)
        x = sum(m * (0.25 - t / 2) for m, t in zip(masses, (0.5, 0.4, 0.3), strict=True)) / sum(masses)
        assert made.fields["centroid"][0] == pytest.approx(x, abs=1e-4)
        assert made.fields["left_foot"] == [-0.25, 0.0] and made.fields["right_foot"] == [0.25, 0.0]
        assert made.structure()


class TestArches:
    WALL: ClassVar = {"name": "w", "length": 6.0, "thickness": 0.4, "confined": {"resistance": 4e5}}

    def test_the_curve(self):
        """Thrust 1.5 f/gamma t/10 per metre of height with the arm t/1.2, on half of the wall each."""
        house = building([self.WALL])
        thrust, mass = 1.5 * 1.5e6 / 2 * 0.04 * 3, 1800 * 0.4 * 6 * 3
        ratio = 8 * thrust * (0.4 / 1.2) / (mass * G * 6)
        typed = rk.Curve(points=[[0.0, round(ratio, 6)], [0.3333, 0.0]], control_height=3.0, centroid_height=1.5,
                         mass=mass, inertia=mass * 36 / 12)  # fmt: skip
        same(house, arch(house, house.walls[0]), typed, 4.5)

    def test_the_code_within_its_rounding(self):
        """q = f t^2/(gamma L^2) of EN 1996-1-1, 6.3.2, by its thrust of 1.5 f on a tenth of the thickness."""
        house = building([{**self.WALL, "length": 8.0}])
        q = 1.5e6 / 2 * (0.4 / 8) ** 2
        ratio = arch(house, house.walls[0]).structure().uplift(Direction.POSITIVE)
        assert ratio * 1800 * G * 0.4 == pytest.approx(q, rel=1e-5)

    @pytest.mark.parametrize(
        ("wall", "why"),
        [
            ({"confined": {"resistance": 1e5}}, "its ends resist 100 kN"), ({"length": 9.0}, "no arch is counted"),
            ({"confined": None}, "nothing is named"),
            ({"openings": [{"storey": 2, "x": 1, "z": 1, "width": 1, "height": 1}]}, "openings interrupt"),
        ],
    )  # fmt: skip
    def test_what_is_no_arch(self, wall, why):
        given = {key: value for key, value in (self.WALL | wall).items() if value is not None}
        house = building([given])
        with not_made(why):
            arch(house, house.walls[0])


class TestOnTop:
    def test_a_parapet(self):
        walls = [{"name": "w", "length": 5.0, "thickness": 0.5, "density": 1600.0}]
        house = building(walls, parapets=[{"wall": "w", "height": 1.1, "thickness": 0.25}])
        typed = rk.Block(width=0.25, height=1.1, depth=5.0, density=1600.0, plane="width")
        same(house, standing(house, house.parapets[0]), typed, 6.0)

    def test_a_bell_gable(self):
        walls = [{"name": "w", "length": 5.0, "thickness": 0.5, "storeys": [1, 1]}, {**TestWalls.PLAIN}]
        bells = {"wall": "w", "height": 3.0, "length": 3.0, "bells": 400.0, "bells_height": 1.5,
                 "openings": [{"x": 0.5, "z": 1.0, "width": 0.8, "height": 1.2},
                              {"x": 1.6, "z": 1.0, "width": 0.8, "height": 0.8}]}  # fmt: skip
        house = building(walls, bell_gables=[bells])
        typed = rk.RigidBody(
            parts=[plate(-0.25, 0.25, 0, 1, 3.0), plate(-0.25, 0.25, 1, 1.8, 1.4), plate(-0.25, 0.25, 1.8, 2.2, 2.2),
                   plate(-0.25, 0.25, 2.2, 3, 3.0)],
            density=1800.0, depth=3.0, loads=[{"name": "bells", "mass": 400.0, "at": [0.0, 1.5]}],
        )  # fmt: skip
        same(house, standing(house, house.bell_gables[0]), typed, 3.0)


class TestCorners:
    COURSES: ClassVar = {"course": 0.2, "overlap": 0.15, "friction": 0.6}
    WALLS = (
        {"name": "front", "length": 8.0, "thickness": 0.5},
        {"name": "side", "length": 6.0, "thickness": 0.4},
    )

    def made(self, z, angle, walls=WALLS, **fields):
        house = building(walls, corners=[{"walls": ["front", "side"], "thrust": 3000.0}], **{
            "interlock": self.COURSES, **fields
        })  # fmt: skip
        return house, corner(house, 0, z, angle)

    def test_its_column_alone(self):
        house, made = self.made(3.0, 0.0)
        m, s = 1800 * 0.5 * 0.4 * 3, sqrt(2)
        typed = rk.RigidBody(
            mass=m, inertia=round(m * ((0.5**2 + 0.4**2) / 24 + 9 / 12), 3), centroid=[round(-0.45 / s, 4), 1.5],
            left_foot=[round(-0.9 / s, 4), 0.0], right_foot=[0.0, 0.0], one_sided="positive",
            polygon=[[round(-0.9 / s, 4), 0.0], [0.0, 0.0], [0.0, 3.0], [round(-0.9 / s, 4), 3.0]],
            loads=[{"name": "hip rafter", "force": [3000.0, 0.0], "at": [round(-0.45 / s, 4), 3.0]}],
            interlock={"courses": 15, "overlap": 0.15, "thickness": 0.45, "walls": 2, "friction": 0.6, "height": 3.0,
                       "density": 1800.0},
        )  # fmt: skip
        same(house, made, typed, 3.0)

    @pytest.mark.parametrize(
        ("walls", "reach"),
        [(WALLS, None), (WALLS, 0.3),
         (({**WALLS[0], "thickness": [0.6, 0.45]}, {**WALLS[1], "thickness": [0.4, 0.3]}), 0.4)],
    )  # fmt: skip
    def test_its_solid_by_quadrature(self, walls, reach):
        """Points of two walls along X and Y, cracked at an angle behind the column where they meet."""
        slope, courses = tan(0.1), {"reach": reach} if reach else {}
        _, made = self.made(0.0, 0.1, walls, interlock=self.COURSES | courses)

        def thick(k, y):
            t = walls[k]["thickness"]
            return t if isinstance(t, float) else t[int(y > 3)]

        total, moments = 0.0, np.zeros(3)
        n, far = 240, 3.4
        u = (np.arange(n) + 0.5) * far / n
        X, Y = np.meshgrid(u, u, indexing="ij")
        for y in (np.arange(60) + 0.5) * 0.1:
            a, b = thick(0, y), thick(1, y)  # the front is along X, the side along Y
            a0, b0 = thick(0, 0), thick(1, 0)
            wedge = min(y * slope, reach or 1e9)
            # Share of each cell within the solid: that in the front, in the side, less that in both.
            shares = []
            for bounds in (((0, max(b0 + wedge, b)), (0, a)), ((0, b), (0, max(a0 + wedge, a))), ((0, b), (0, a))):
                both = [
                    np.clip((np.minimum(at + far / n / 2, hi) - np.maximum(at - far / n / 2, lo)) * n / far, 0, 1)
                    for at, (lo, hi) in zip((u, u), bounds, strict=True)
                ]
                shares.append(np.outer(*both))
            m = 1800 * 0.1 * (far / n) ** 2 * (shares[0] + shares[1] - shares[2])
            x = -(X + Y) / sqrt(2)
            total += m.sum()
            moments += [(m * x).sum(), (m * y).sum(), (m * (x**2 + y**2)).sum() + m.sum() * 0.01 / 12]
        body = made.fields
        assert body["mass"] == pytest.approx(total, rel=2e-3)
        assert body["centroid"] == pytest.approx((moments[0] / total, moments[1] / total), rel=2e-3)
        about = moments[2] - (moments[0] ** 2 + moments[1] ** 2) / total
        assert body["inertia"] == pytest.approx(about, rel=1e-3)
        b = min(1.0, (reach or 1e9) / (6 * slope))
        thin = sum(thick(k, 6) for k in (0, 1))
        rubs = 0.4 * 30 * 31 * 0.2 * 0.6 * (0.15 - 0.2 * slope) * thin * 1800 * G * 2.0 * (3 * b**2 - 2 * b**3)
        by_hand = (-moments[0] * G + rubs - 3000 * 6) / (moments[1] * G)
        assert made.structure().uplift(Direction.POSITIVE) == pytest.approx(by_hand, rel=5e-3)

    def test_a_corner_whose_wedges_are_behind_its_foot(self):
        """Both wedges end 0.9 m behind the column; the corner leans on the building."""
        _, made = self.made(0.0, 0.6)
        slope, total, moment, high = tan(0.6), 0.0, 0.0, 0.0
        for y in (np.arange(3000) + 0.5) * 0.002:
            u = y * slope
            for area, x in ((0.2, 0.45), (0.5 * u, 0.4 + u / 2 + 0.25), (0.4 * u, 0.5 + u / 2 + 0.2)):
                weight = area * 0.002 * 1800 * G
                total, moment, high = total + weight, moment + weight * x / sqrt(2), high + weight * y
        rubs = 0.4 * 30 * 31 * 0.2 * 0.6 * (0.15 - 0.2 * slope) * 0.9 * 1800 * G * 2.0
        assert made.fields["mass"] * G == pytest.approx(total, rel=1e-5)
        lean = made.structure().uplift(Direction.POSITIVE)
        assert lean == pytest.approx((moment + rubs - 3000 * 6) / high, rel=1e-4)

    def test_floors_bear_on_the_inner_faces(self):
        """Of a floor on 0.4 m of the column and y tan(angle) of the wall, 5 cm from the inner face of the front."""
        floor = {"name": "deck", "level": 1, "load": 450.0, "span": 5.0, "walls": ["front"], "seat": 0.15}
        _, made = self.made(0.0, 0.3, floors=[floor | {"thrust": 700.0}])
        along = 0.4 + 3 * tan(0.3)
        deck, thrust, rafter = made.fields["loads"]
        x = -(along / 2 + 0.45) / sqrt(2)
        assert deck["mass"] == pytest.approx(450 * 5 * along, rel=1e-6)
        assert deck["at"] == pytest.approx([x, 3.0], abs=1e-4)
        assert thrust["force"] == pytest.approx([700 * along * cos(pi / 4), 0.0], rel=1e-6)
        assert rafter["force"] == [3000.0, 0.0]


class TestHeights:
    HOUSE = building([TestWalls.PLAIN])

    @pytest.mark.parametrize("z", [0.01, 3.0, 6.0])
    def test_the_floor_of_a_height(self, z):
        assert floor_of(self.HOUSE, site_of(SITE), z).site.floor == site_at(z).site.floor

    def test_the_foot_is_on_the_ground(self):
        given = site_of(
            {**yaml.safe_load(SITE.read_text()), "floor": {"z": 2.0, "H": 5.0, "n": 2, "T1": 0.3, "xi1": 0.1}}
        )
        assert floor_of(self.HOUSE, given, 0.0).site.floor is None
        assert floor_of(self.HOUSE, given, 9.0).site.floor.z == 5.0

    def test_the_period_is_that_of_the_height_unless_given(self):
        assert isclose(first_period(self.HOUSE), 0.05 * 6**0.75)
        assert first_period(building([TestWalls.PLAIN], T1=0.3)) == 0.3

    def test_a_wall_that_falls_at_rest_is_no_strong_one(self):
        """Above a window of 5 m in 6 m the roof pushes the wall over, though about its foot it stands."""
        wall = {"name": "w", "length": 6.0, "thickness": 0.5,
                "openings": [{"storey": 1, "x": 0.5, "z": 1.0, "width": 5.0, "height": 1.8}]}  # fmt: skip
        roof = {"load": 200.0, "span": 5.0, "walls": ["w"], "sliding": True, "thrust": 1300.0}
        house = building([wall], roof=roof, levels=[0.0, 3.0])
        with pytest.raises(InputError, match="cannot stand under them"):
            MechanismSearch(house, site_of(SITE)).verified(overturning(house, house.walls[0], 1.0))
        answer = assess(house, site_of(SITE))
        assert any(each.open and "cannot stand under them" in each.why for each in answer.left_out)

    def test_openings_leave_nothing(self):
        wall = {"name": "w", "length": 5.0, "thickness": 0.5,
                "openings": [{"storey": 1, "x": 0, "z": 1, "width": 5, "height": 1}]}  # fmt: skip
        house = building([wall])
        with not_made(r"openings leave nothing of it at 1\.5 m"):
            strips(house, house.walls[0], 0.0, 6.0)
        assert len(strips(house, house.walls[0], 2.0, 6.0)) == 1
