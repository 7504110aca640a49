"""The weakest mechanism of a building, against all of them: every height of a hinge, every angle of a crack."""

from functools import partial
from itertools import product
from math import inf, isnan

import numpy as np
import pytest

from rocking_cli.ask.inputs import site_of
from rocking_cli.errors import InputError, MechanismError, SolverError
from rocking_cli.io.json_text import json_text
from rocking_cli.io.yaml_file import parse
from rocking_cli.questions.building.description import building_of
from rocking_cli.questions.building.made import NotMade, bending, corner, held_levels, overturning, standing
from rocking_cli.questions.building.study import LOWER, Search, assess
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

    Hinges are at each level and at `heights` places within each storey, cracks at `angles` slopes.
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
        for level in range(foot, top):
            low, high = house.levels[level : level + 2]
            if level + 1 == top and len(gables) == 1:
                high -= 0.05 * (high - low)
            for z, angle, gable in product(hinges(low, high), cracks, gables):
                yield (wall.name, round(z, 3), angle, gable), partial(overturning, house, wall, z, angle, gable=gable)
        levels = held_levels(house, wall)
        for low, high in zip(levels, levels[1:], strict=False):
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
