"""The weakest mechanism of a building, against all of them: every height of a hinge, every angle of a crack."""

from functools import partial
from itertools import pairwise, product
from math import inf, isnan

import numpy as np
import pytest

from rocking_cli.ask.inputs import site_of
from rocking_cli.errors import InputError, MechanismError, Problem, SolverError
from rocking_cli.io.json_text import json_text
from rocking_cli.io.yaml_file import parse
from rocking_cli.questions.building import study
from rocking_cli.questions.building.description import building_of
from rocking_cli.questions.building.made import NotMade, bending, corner, held_levels, joints, overturning, standing
from rocking_cli.questions.building.study import CRACKS, LOWER, MechanismSearch, assess
from tests.conftest import EXAMPLES

TOLERANCE = LOWER + 1e-3  # of the search, and of heights that it rounds to millimetres
SITE = EXAMPLES / "verify" / "site.yaml"


def building(fields):
    return building_of(parse(json_text(fields), "house.yaml", "building", "a hint"))


def zeta(search, make):
    """Capacity over demand, as one mechanism made and verified has it; infinite where there is none."""
    try:
        ratio = search.verified(make()).ratio
    except (NotMade, InputError, MechanismError, SolverError):
        return inf
    return inf if isnan(ratio) else ratio


def everything(search, heights, angles):
    """Yield every mechanism of a building that could be meant, without any search: what it is, and its ratio.

    Hinges are at each level and at `heights` places within each storey, or in every bed joint of a wall that
    interlocks, cracks at `angles` slopes.
    """
    house = search.building
    courses = house.interlock
    slopes = np.linspace(0.0, courses.steepest, angles).tolist() if courses is not None else [0.0]

    def hinges(low, high):
        return [low, *np.linspace(low, high, heights + 1, endpoint=False)[1:].tolist()]

    for wall in house.walls:
        foot, top = wall.reaches(house.count)
        gables = (True, False) if any(each.wall == wall.name for each in house.gables) else (True,)
        cracks = slopes if wall.connection == "interlock" else [0.0]
        beds = joints(house, wall)
        for level in range(foot, top):
            low, high = house.levels[level : level + 2]
            if level + 1 == top and len(gables) == 1:
                high -= 0.05 * (high - low)
            places = [low, *(z for z in beds if low + 0.01 < z <= high)] if beds else hinges(low, high)
            for z, angle, gable in product(places, cracks, gables):
                yield (wall.name, round(z, 3), angle, gable), partial(overturning, house, wall, z, angle, gable=gable)
        levels = held_levels(house, wall)
        for low, high in pairwise(levels):
            yield (wall.name, "bending", low, high), partial(bending, house, wall, low, high)
    for each in (*house.gables, *house.parapets):
        foot = house.levels[house.wall[each.wall].reaches(house.count)[1]]
        tall = 0.8 * each.height if each in house.gables else 0.0
        for z in [foot, *np.linspace(foot, foot + tall, heights + 1)[1:].tolist()] if tall else [foot]:
            yield (f"on {each.wall}", round(z, 3)), partial(standing, house, each, z if z > foot else None)
    for k, each in enumerate(house.corners):
        feet = [house.wall[name].reaches(house.count) for name in each.walls]
        for level in range(max(foot for foot, _ in feet), min(top for _, top in feet)):
            for angle in slopes:
                yield (f"corner {k}", level, angle), partial(corner, house, k, house.levels[level], angle)


def least_of_all(search, heights, angles):
    """Return the least ratio of all mechanisms, and the mechanism that has it."""
    return min((zeta(search, make), str(what)) for what, make in everything(search, heights, angles))


def random_house(seed):
    """Return the fields of a house of one or two storeys whose numbers are drawn, with all that changes a search."""
    r = np.random.default_rng(seed)

    def some(*values):
        return values[int(r.integers(len(values)))]

    def between(low, high):
        return round(float(r.uniform(low, high)), 2)

    storeys = some(1, 2, 2)
    levels = [0.0, *np.cumsum([between(2.8, 4.0) for _ in range(storeys)]).round(2).tolist()]
    thick = [between(0.3, 0.7) for _ in range(storeys)]
    first = {"name": "front", "length": between(4, 9), "thickness": sorted(thick, reverse=True), "sides": ["left"]}
    if r.random() < 0.6:
        first["connection"] = "interlock"
    if r.random() < 0.5:
        high = between(1.0, 2.2)
        first["openings"] = [{"storey": 1, "x": 1.0, "z": between(0, 0.5), "width": between(0.8, 2), "height": high}]
    walls = [first, {"name": "left", "length": between(3, 8), "thickness": between(0.3, 0.6), "sides": ["front"]}]
    if r.random() < 0.4:
        walls[1]["connection"] = "interlock"
    fields = {
        "levels": levels, "masonry": {"density": 1800.0, "compression": 1.5e6, "shear": 5e4},
        "interlock": {"course": between(0.12, 0.3), "overlap": between(0.08, 0.3)}, "walls": walls,
    }  # fmt: skip
    if r.random() < 0.3:
        fields["interlock"]["reach"] = between(0.5, 2.5)
    if r.random() < 0.7:
        fields["roof"] = {"load": between(100, 300), "span": between(3, 6), "walls": ["front"]}
        fields["roof"] |= {"sliding": some(True, False), "thrust": some(0.0, 800.0)}
        if r.random() < 0.6:
            fields["roof"]["seat"] = between(0.1, 0.25)
    if storeys == 2 and r.random() < 0.7:
        floor = {"name": "floor", "level": 1, "load": between(300, 500), "span": between(3, 6), "walls": ["front"]}
        fields["floors"] = [floor | {"sliding": some(True, False), "seat": 0.15}]
    if r.random() < 0.5:
        fields["gables"] = [{"wall": some("front", "left"), "height": between(1.0, 2.5)}]
    if r.random() < 0.4:
        fields["ties"] = [{"level": storeys, "walls": ["front"], "length": 5.0, "bars": some(1, 2),
                           "diameter": some(0.014, 0.02), "steel": "S235", "below": some(0.0, 0.3)}]  # fmt: skip
    if r.random() < 0.5:
        fields["corners"] = [{"walls": ["front", "left"]}]
    if r.random() < 0.4:
        fields["masonry"]["crushing"] = 1.5e6
    return fields


def check(fields, heights, angles):
    """Assert that no mechanism is weaker than the weakest that is named; return all that was found."""
    house = building(fields)
    search = MechanismSearch(house, site_of(SITE))
    answer = assess(house, search.site)
    least, what = least_of_all(search, heights, angles)
    weakest = min(answer.rows, key=lambda each: each.ratio)
    assert weakest.ratio <= least * (1 + TOLERANCE), f"{weakest.made.name} at {weakest.ratio}, but {what} at {least}"
    return answer, what


MASONRY = {"density": 1800.0}
PLAIN = {
    "levels": [0.0, 3.2], "masonry": MASONRY,
    "walls": [{"name": "front", "length": 7.0, "thickness": 0.4, "openings": [
        {"storey": 1, "x": 1.0, "z": 1.0, "width": 5.0, "height": 1.5}]}],
    "roof": {"load": 200.0, "span": 5.0, "walls": ["front"], "sliding": True, "thrust": 700.0},
}  # fmt: skip
TIED = {
    "levels": [0.0, 3.2, 6.4], "masonry": MASONRY, "walls": [{"name": "front", "length": 7.0, "thickness": 0.4}],
    "roof": {"load": 200.0, "span": 5.0, "walls": ["front"], "sliding": True},
    "ties": [{"level": 2, "walls": ["front"], "length": 6.0, "bars": 1, "diameter": 0.014, "steel": "S235"}],
}  # fmt: skip
CROSSED = {
    "levels": [0.0, 3.0, 6.0], "masonry": MASONRY, "interlock": {"course": 0.2, "overlap": 0.1},
    "walls": [
        {"name": "front", "length": 7.0, "thickness": 0.5, "sides": ["left", "right"], "connection": "interlock"},
        {"name": "left", "length": 6.0, "thickness": 0.4, "sides": ["front"]},
        {"name": "right", "length": 6.0, "thickness": [0.5, 0.4], "sides": ["front"], "connection": "interlock"},
    ],
    "floors": [{"name": "deck", "level": 1, "load": 400.0, "span": 4.0, "walls": ["left", "right"], "seat": 0.15}],
    "roof": {"load": 200.0, "span": 5.0, "walls": ["front"], "sliding": True, "thrust": 600.0},
    "gables": [{"wall": "left", "height": 1.5}, {"wall": "right", "height": 1.5}],
    "corners": [{"walls": ["front", "left"]}],
}  # fmt: skip


class TestLeast:
    def test_a_hinge_at_the_sill_of_a_wide_window(self):
        """Above the sill there is little weight against the thrust of the roof."""
        answer, what = check(PLAIN, 8, 1)
        assert "front" in what
        assert answer.governs.made.z == pytest.approx(1.0, abs=0.02)

    @pytest.mark.rest
    def test_a_hinge_below_a_tie(self):
        answer, _ = check(TIED, 16, 1)
        assert any(4.8 < each.made.z < 5.3 for each in answer.rows)

    @pytest.mark.parametrize("z", [0.0, 3.0])
    def test_a_crack_of_side_walls(self, z):
        """The weakest angle about a level, against ten of them."""
        house = building({**CROSSED, "gables": []})
        search, wall = MechanismSearch(house, site_of(SITE)), house.walls[2]
        steepest = house.interlock.steepest
        angle = search.weakest(partial(overturning, house, wall, z), 0.0, steepest, CRACKS[0])
        least = min(
            zeta(search, partial(overturning, house, wall, z, a)) for a in np.linspace(0, steepest, 10).tolist()
        )
        assert zeta(search, partial(overturning, house, wall, z, angle)) <= least * (1 + TOLERANCE)

    def test_the_angle_from_which_on_courses_slip_off(self):
        """Of this wall the ratio drops from 1.277 to 1.171 at 0.273 rad; a flat valley at 0.086 has 1.241."""
        walls = [
            {"name": "front", "length": 5.88, "thickness": 0.54, "sides": ["left"], "connection": "interlock",
             "openings": [{"storey": 1, "x": 1, "z": 0.27, "width": 1.88, "height": 2.05}]},
            {"name": "left", "length": 5.0, "thickness": 0.45},
        ]  # fmt: skip
        house = building({"levels": [0.0, 3.4], "masonry": MASONRY, "walls": walls,
                          "interlock": {"course": 0.3, "overlap": 0.16}})  # fmt: skip
        search = MechanismSearch(house, site_of(SITE))
        make = partial(overturning, house, house.walls[0], 0.0)
        angle = search.weakest(make, 0.0, house.interlock.steepest, CRACKS[0])
        least = min(zeta(search, partial(make, a)) for a in np.linspace(0, house.interlock.steepest, 49).tolist())
        assert zeta(search, partial(make, angle)) <= least * (1 + TOLERANCE)

    @pytest.mark.parametrize("valley", [1.234, 0.0, 3.0])
    def test_a_valley(self, valley, monkeypatch):
        """Of a made-up ratio with one least value within the bounds."""
        search = MechanismSearch(building(PLAIN), site_of(SITE))
        monkeypatch.setattr(MechanismSearch, "ratio", lambda self, x: 1 + ((x - valley) / 3) ** 2)
        assert ((search.weakest(lambda x: x, 0.0, 3.0) - valley) / 3) ** 2 < 2 * LOWER

    @pytest.mark.parametrize("valley", [(1.9, 0.31), (0.1, 0.5), (2.9, 0.0)])
    def test_a_valley_of_joints_and_angles(self, valley, monkeypatch):
        search, beds = MechanismSearch(building(PLAIN), site_of(SITE)), [k / 10 for k in range(1, 30)]
        monkeypatch.setattr(
            MechanismSearch, "ratio", lambda self, x: 1 + ((x[0] - valley[0]) / 3) ** 2 + (2 * (x[1] - valley[1])) ** 2
        )
        z, angle = search.weakest_joint(lambda *x: x, beds, [k / 16 for k in range(9)], 4)
        assert z == valley[0] and (2 * (angle - valley[1])) ** 2 < 2 * LOWER
        assert search.weakest_joint(lambda *x: x, beds, [0.0], 4) == (valley[0], 0.0)

    def test_hinges_of_walls_that_interlock_are_in_bed_joints(self):
        """Courses of 0.2 m below where the walls meet, at 6 m, and without another wall nowhere."""
        house = building(CROSSED)
        assert joints(house, house.walls[2]) == pytest.approx([k / 5 for k in range(30)])
        assert joints(house, house.walls[1]) == []

    def test_the_crack_of_a_wall_without_its_gable_is_its_own(self):
        """It is searched anew: the weakest with the gable may be another one."""
        house = building(CROSSED)
        search, wall = MechanismSearch(house, site_of(SITE)), house.walls[2]
        rows = [each for each in search.of_wall(wall) if isinstance(each, study.Found)]
        (row,) = [each for each in rows if each.made.without_gable and each.made.hinge[0] == 0.0]
        about = partial(overturning, house, wall, 0.0, gable=False)
        slopes = np.linspace(0, house.interlock.steepest, 25).tolist()
        least = min(zeta(search, partial(about, each)) for each in slopes)
        assert row.ratio <= least * (1 + TOLERANCE)

    def test_restraints_that_hold_at_any_displacement_are_no_fall(self, monkeypatch):
        """The code counts nothing of them: such a mechanism is named, and is not what falls at rest."""
        house = building(PLAIN)
        search = MechanismSearch(house, site_of(SITE))

        def endless(*_):
            raise InputError(Problem("a* does not vanish", field="ties"))

        monkeypatch.setattr(study, "verify", endless)
        assert search.ratio(overturning(house, house.walls[0], 0.0)) == inf
        assert not any(each.falls for each in search.of_wall(house.walls[0]))

    def test_a_storey_that_openings_take_away_has_a_reason(self):
        """Nothing is left of it at the height of the opening, so that no hinge below turns all of it."""
        wall = {**PLAIN["walls"][0], "openings": [{"storey": 1, "x": 0.0, "z": 2.9, "width": 7.0, "height": 0.3}]}
        house = building({**PLAIN, "walls": [wall]})
        search = MechanismSearch(house, site_of(SITE))
        (left,) = [each for each in search.of_wall(house.walls[0]) if each.open]
        assert left.why.key == "why_openings"

    def test_walls_that_are_alike_are_verified_once(self, monkeypatch):
        search = MechanismSearch(building({**PLAIN, "roof": None}), site_of(SITE))
        calls = []
        verified = MechanismSearch.verified
        monkeypatch.setattr(MechanismSearch, "verified", lambda self, made: calls.append(made) or verified(self, made))
        (wall,) = search.building.walls
        ratios = {
            search.ratio(overturning(search.building, one, 0.5))
            for one in (wall, wall.model_copy(update={"name": "b"}))
        }
        assert len(calls) == len(ratios) == 1
        search.ratio(overturning(search.building, wall, 0.6))
        assert len(calls) == 2

    @pytest.mark.rest
    def test_all_of_a_small_building(self):
        """Sixty heights a storey; twenty angles at six heights of walls that interlock."""
        check({**CROSSED, "walls": [{**each, "connection": "none"} for each in CROSSED["walls"]]}, 60, 20)
        check(CROSSED, 6, 20)

    @pytest.mark.rest
    @pytest.mark.parametrize("seed", range(6))
    def test_random_buildings(self, seed):
        check(random_house(seed), 8, 6)
