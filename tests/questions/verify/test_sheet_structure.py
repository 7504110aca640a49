"""What the sheet says of a structure: its sizes and masses, and the centres of rotation of its blocks."""

import re
from dataclasses import replace
from functools import cache
from importlib.resources import files
from math import cos, floor, log10, pi, radians, sin

import numpy as np
import pytest

from mechanisms.arch import Arch
from mechanisms.block import Block
from mechanisms.cone import Cone
from mechanisms.rigid_body import RigidBody
from mechanisms.symmetric_frame import SymmetricFrame
from rocking_cli.codes.italian import formulas
from rocking_cli.codes.italian.capacity import DisplacedChain, ExactCurve
from rocking_cli.codes.italian.chain import Chain
from rocking_cli.codes.italian.sheet import build
from rocking_cli.codes.italian.sheet.chain import ChainCentres
from rocking_cli.codes.italian.sheet.geometry import SIZE_UNITS, Composition, ranges
from rocking_cli.core import Direction
from rocking_cli.core.coefficients import NoCriticalRotation
from rocking_cli.core.registry import Registry
from rocking_cli.core.structure_fields import StructureFields
from rocking_cli.core.structure_file import load_structure, parse_structure
from rocking_cli.verification.results import Formula
from rocking_cli.views.sheet.document import sections
from rocking_cli.views.view import Table
from tests.conftest import EXAMPLES
from tests.questions.verify.test_sheet import CASES, arithmetic, number

SLOPES = """mechanism: linkage
name: on two slopes
bodies: {block: {mass: 10, centroid: [0.2, 1.0], inertia: 8}}
positive:
  lead: block
  joints:
    "foot [|]": {slide: block, at: [0.3, 0.0], along: [1.0, 1.0]}
    side: {slide: block, at: [0.0, 0.5], along: [0.7, 0.5]}
negative: none
one_sided: positive
rebound: 0.3
"""
SLOPING = """mechanism: linkage
name: sloping
density: 2000
depth: 0.5
bodies:
  low: {polygon: [[0, 0], [0.3, 0], [0.3, 1.5], [0, 1.5]], depth: 0.4}
  high: {polygon: [[0, 1.5], [0.3, 1.5], [0.25, 3.0], [0.05, 3.0]], density: 1500}
positive:
  lead: low
  joints:
    A: {pivot: low, at: [0.3, 0]}
    B: {hinge: [low, high], at: [0, 1.5]}
    C: {slide: high, at: [0.25, 3.0], along: [0.2, 1.0]}
negative: none
one_sided: positive
rebound: 0.3
"""
STOREYS = """mechanism: linkage
name: two portals
density: 2000
depth: 0.5
bodies:
  a: {polygon: [[0, 0], [0.6, 0], [0.6, 3], [0, 3]]}
  b: {polygon: [[3, 0.4], [3.6, 0.4], [3.6, 3], [3, 3]]}
  beam: {polygon: [[0, 3], [3.6, 3], [3.6, 3.4], [0, 3.4]]}
  c: {polygon: [[0, 3.4], [0.5, 3.4], [0.5, 6], [0, 6]]}
  d: {polygon: [[3.1, 3.4], [3.6, 3.4], [3.6, 5.5], [3.1, 5.5]]}
  top: {parts: [{polygon: [[0, 6], [3.1, 5.5], [3.6, 5.5], [3.6, 6.4], [0, 6.4]]},
                {polygon: [[2, 6], [2.4, 6], [2.4, 6.2], [2, 6.2]], opening: true}]}
positive:
  lead: a
  joints:
    A: {pivot: a, at: [0.6, 0]}
    B: {hinge: [a, beam], at: [0, 3]}
    C: {hinge: [beam, b], at: [3, 3]}
    D: {pivot: b, at: [3.6, 0.4]}
    E: {hinge: [beam, c], at: [0, 3.4]}
    F: {hinge: [c, top], at: [0.5, 6]}
    G: {hinge: [top, d], at: [3.6, 5.5]}
    H: {hinge: [d, beam], at: [3.1, 3.4]}
    stay: {slide: top, at: [1.8, 6.4], along: [1.0, 0.3]}
negative: none
one_sided: positive
rebound: 0.3
"""
DENSE = "density: 1900\ndepth: 0.7\n"
FOOT = "mechanism: rigid_body\npolygon: [[100, 50], [101, 50], [100.9, 53.2], [100.2, 53]]\ncorner_radius: 0.05\n"
MORE = {
    "on two slopes": SLOPES,
    "sloping": SLOPING,
    "two portals": STOREYS,
    "arch of density": f"mechanism: arch\nradius: 4\nthickness: 0.6\ninclusion_angle_deg: 150\n{DENSE}",
    "cone": f"mechanism: cone\nbase_radius: 1.5\nheight: 12\nkind: hollow\ninner_ratio: 0.9\n{DENSE}",
    "solid": f"mechanism: cone\nbase_radius: 1.5\nheight: 12\nkind: solid\n{DENSE}",
    "frame of density": f"mechanism: symmetric_frame\ncolumn_width: 1\ncolumn_height: 6\nmass_ratio: 2\n{DENSE}",
    "rounded": FOOT + DENSE,
    "disc": f"mechanism: linkage\nbodies: {{d: {{disc: {{centre: [0, 1], radius: 1}}}}}}\n{DENSE}"
    "positive: {lead: d, joints: {A: {pivot: d, at: [0.2, 0.0202]}}}\nnegative: mirror\n",
    "crushed wall": f"mechanism: wall\nthickness: 0.3\nheight: 3\n{DENSE}crushing: {{strength: 1e+6}}\n",
    "crossed": "mechanism: block\nwidth: 0.6\nheight: 8\ndensity: 1800\ndepth: 5\none_sided: positive\nrebound: 0.4\n"
    "friction: 0.6\nstrength: {stress: 3e+6, width: 0.05}\n"
    "interlock: {courses: 40, overlap: 0.2, thickness: 0.5, walls: 2, height: 8.0}\n"
    "ties: [{name: bed, bed: {from: [-0.3, 1], to: [-0.3, 2]}, modulus: 1e+5}, "
    "{name: rod, from: {ground: [-6, 6]}, to: {at: [-0.3, 6]}, area: 1e-4, yield: 2e+8}]\n",
    "given": "mechanism: wall\nthickness: 0.3\nheight: 3\nmass: 5000\nrestitution: 0.8\n",
}
"""Structures beside the examples, so that each formula is used."""
FOLDERS = ("", "linkages", "masonry", "walls", "verify")
FILES = sorted(
    path for folder in FOLDERS for path in (EXAMPLES / folder).glob("*.yaml")
    if "mechanism:" in path.read_text(encoding="utf-8")
)  # fmt: skip
NAMES = [*(path.relative_to(EXAMPLES).as_posix() for path in FILES), *MORE,
         *{text: name for name, (text, _) in CASES.items()}.values()]  # fmt: skip
SHARES = (0.0, 0.4, 1.0)  # rotations over the critical one
OF_STRUCTURE = {
    "RECTANGLE", "SEVERAL", "AREA", "AREA_OF_MANY", "PLATE", "SECTOR", "DISC", "CONE", "HOLLOW_CONE", "SUM_OF_PARTS",
    "SHARE_OF_MASS", "MASS_GIVEN", "MASS_OF_MECHANISM", "SHARE_LEVEL", "LEADS", "TURNS", "TURNS_ALIKE", "TRANSLATES",
    "X_TRANSLATES", "Y_TRANSLATES", "Y_TRANSLATES_BACK",
}  # fmt: skip
"""Names of the formulas of this part of the sheet."""


@cache
def structure(name):
    if name in MORE or name in CASES:
        text = MORE[name] if name in MORE else CASES[name][0]
        return parse_structure(text, "s.yaml", "test", Registry())
    return load_structure(EXAMPLES / name)


@cache
def positions(name, direction):
    """The chain at rest and displaced, by shares of its critical rotation if it has one."""
    curve = ExactCurve(chain := Chain(structure(name), direction), chain.barycentre, 1.0)
    try:
        end = structure(name).critical_rotation(direction)
    except NoCriticalRotation:
        end = structure(name).limit(direction) / 4
    return [DisplacedChain(curve, share * end) for share in SHARES]


def written(line, language="en"):
    """A line as it is printed: its numbers, result and meaning."""
    say = build.SHEET.language(language)
    step = say.written(line)
    return step, say.number(step.value, step.digits)


def lines_of(name):
    chains = [each for direction in structure(name).directions for each in positions(name, direction)]
    return [*Composition(structure(name)).masses, *(line for each in chains for line in ChainCentres(each).lines)]


def off(numbers, result):
    """The difference of a result from what its printed numbers give, in units of its fifth digit."""
    value, printed = arithmetic(numbers, False)[0], number(result)
    terms = max((abs(float(each)) for each in re.findall(r"\d+\.?\d*", numbers)), default=1.0)
    unit = 10.0 ** (floor(log10(abs(printed))) - 4) if printed else 1e-5 * terms
    return abs(value - printed) / unit


@pytest.mark.every(3)
@pytest.mark.parametrize("name", NAMES)
def test_every_line_agrees_to_one_unit_of_the_fifth_digit(name):
    for line in lines_of(name):
        step, result = written(line)
        assert not step.numbers or off(step.numbers, result) <= 1.0, step


def test_a_return_period_just_above_that_of_a_row_has_its_digits():
    """Six digits of a return period of 50.29 years would leave four of its logarithm over 50."""
    line = formulas.BETWEEN.line(np.log(50.2890123 / 50) / np.log(101 / 50), T=50.2890123, a=50.0, b=101.0)
    assert written(line)[0].numbers == "ln(50.2890123/50)/ln(101/50)"
    assert formulas.LASTS.digits == formulas.RETURN_PERIOD.digits == 9


def masses_of(mechanism):
    """The mass of each body by its number, of lines that may be of several bodies."""
    masses = {}
    for line in Composition(mechanism).masses:
        numbers = str(line.names["k"]).split(", ")
        if line.formula.symbol.startswith("M") and "," not in "".join(numbers):
            for first, _, last in (each.partition("–") for each in numbers):
                masses |= dict.fromkeys(range(int(first), int(last or first) + 1), line.value)
    return masses


class TestMasses:
    @pytest.mark.every(3)
    @pytest.mark.parametrize("name", NAMES)
    def test_lines_give_the_masses_of_all_bodies(self, name):
        assert not any(line.formula is formulas.MASS_OF_MECHANISM for line in Composition(structure(name)).masses)
        bodies = enumerate(structure(name).weighed(), 1)
        assert masses_of(structure(name)) == {k: pytest.approx(body.mass, rel=1e-9) for k, body in bodies}

    @pytest.mark.parametrize(
        ("mechanism", "mass"),
        [
            (Block(width=0.6, height=8.0, density=1800.0, depth=5.0), 1800 * 0.6 * 8 * 5),
            (Cone(base_radius=1.5, height=12.0, kind="solid", density=2000.0), 2000 * pi * 1.5**2 * 12 / 3),
            (
                Cone(base_radius=1.5, height=12.0, kind="hollow", inner_ratio=0.5, density=2000.0),
                2000 * pi * 1.5**2 * 12 / 3 * 7 / 8,
            ),
            (
                # Its hinges are at the springings, so that all of the ring moves.
                Arch(radius=10.0, thickness=1.5, inclusion_angle_deg=157.5, voussoirs=7, density=1900.0, depth=0.7),
                1900 * 0.7 * radians(157.5) * 10 * 1.5,
            ),
            (
                SymmetricFrame(
                    column_width=1.0, column_height=6.0, columns=3, mass_ratio=2.0, density=2000.0, depth=0.5
                ),
                3 * 2000 * 6 * 0.5 * 3,
            ),
            (RigidBody(polygon=[[0, 0], [1, 0], [1, 3], [0, 2]], density=2000.0, depth=0.5), 2500.0),
            (
                RigidBody(
                    parts=[
                        {"polygon": [[0, 0], [2, 0], [2, 3], [0, 3]], "density": 1000.0},
                        {"polygon": [[0.5, 1], [1, 1], [1, 2], [0.5, 2]], "opening": True},
                    ],
                    depth=0.5,
                ),
                2750.0,
            ),
            (
                # Each rounded corner of a right angle takes away a square of its radius, less a quarter of a circle.
                RigidBody(
                    polygon=[[0, 0], [1, 0], [1, 3], [0, 3]], corner_radius=0.1, density=1000.0, depth=1.0
                ),
                1000 * (3 - 2 * 0.01 * (1 - pi / 4)),
            ),
        ],
    )  # fmt: skip
    def test_by_hand(self, mechanism, mass):
        assert sum(masses_of(mechanism).values()) == pytest.approx(mass, rel=1e-12)
        assert sum(body.mass for body in mechanism.weighed()) == pytest.approx(mass, rel=1e-12)
        assert all(line.formula.text for line in Composition(mechanism).masses)

    def test_a_mass_that_is_a_number_is_said_to_be_one(self):
        (line,) = Composition(Block(width=0.6, height=8.0, mass=5000.0)).masses
        assert written(line)[0].meaning == "mass of body 1, a number in the structure file"
        assert [written(line)[1] for line in Composition(structure("given")).masses] == ["2500", "2500"]

    def test_a_volume_of_its_own_that_the_parts_do_not_give_is_said(self):
        class Holed(Block):
            mechanism = "holed"

            def volume(self):
                return 0.9 * super().volume()

        (line,) = Composition(Holed(width=0.6, height=8.0, density=1800.0, depth=5.0)).masses
        assert line.formula is formulas.MASS_OF_MECHANISM and line.value == pytest.approx(0.9 * 43200)

    def test_equal_bodies_share_a_line(self):
        heights = {"a": (0, 1), "b": (1, 2), "c": (2, 2.5), "d": (2.5, 3.5)}
        drums = ", ".join(
            f"{name}: {{polygon: [[0, {low}], [1, {low}], [1, {high}], [0, {high}]]}}"
            for name, (low, high) in heights.items()
        )
        floor = "ground: {floor: {polygon: [[-2, -1], [3, -1], [3, 0], [-2, 0]]}}"
        text = f"mechanism: assembly\nname: s\ndensity: 2000\ndepth: 1\nblocks: {{{drums}}}\n{floor}\n"
        lines = Composition(parse_structure(text, "s.yaml", "test", Registry())).masses
        assert [str(line.names["k"]) for line in lines] == ["1–2, 4", "3"]
        assert ranges([1, 2, 4, 6, 7, 8]) == "1–2, 4, 6–8"


class TestCentres:
    @pytest.mark.every(3)
    @pytest.mark.parametrize("name", NAMES)
    def test_are_those_of_the_motion(self, name):
        """Centres and rotations; a block that translates moves as its lines say."""
        for direction in structure(name).directions:
            for position in positions(name, direction):
                centres = ChainCentres(position)
                assert centres.is_known == bool(centres.joints) == (structure(name).mechanism != "curve")
                turns = {each.block: each.turns for each in centres.rotations}
                for k, moved in enumerate(position.blocks if centres.is_known else (), 1):
                    assert turns[k] == pytest.approx(moved.turns, rel=1e-9, abs=1e-9)
                    if moved.centre is None:
                        assert centres.centre(k) is None
                    else:
                        assert centres.centre(k) == pytest.approx(moved.centre, rel=1e-9, abs=1e-9)
                ways = {
                    (line.formula.symbol[0], line.names["k"]): line.value for line in centres.lines
                    if line.formula.symbol in ("x_[{k}]′", "y_[{k}]′")
                }  # fmt: skip
                for k in {k for _, k in ways}:
                    moved = position.blocks[k - 1]
                    assert [ways["x", k], ways["y", k]] == pytest.approx([moved.dx, moved.dy], rel=1e-9, abs=1e-9)

    def test_of_a_wall_by_hand(self):
        """At rest the line from A to B meets the level of C twice as far; displaced, A is the foot of an isosceles."""
        rest, displaced, _ = (ChainCentres(each) for each in positions("wall.yaml", Direction.POSITIVE))
        t, h = structure("wall.yaml").thickness, structure("wall.yaml").height
        assert rest.centre(1) == pytest.approx(t / 2) and rest.centre(2) == pytest.approx(complex(-1.5 * t, h))
        phi = displaced.position.phi
        b = t / 2 + (-t + 0.5j * h) * complex(cos(phi), -sin(phi))
        assert displaced.centre(2) == pytest.approx(2 * b - t / 2)
        assert [each.turns for each in displaced.rotations] == pytest.approx([1, -1])
        assert [(row.symbol, row.kind, row.blocks) for row in rest.joints] == [
            ("A", "hinge", (0, 1)), ("B", "hinge", (1, 2)), ("C", "guide", (0, 2)),
        ]  # fmt: skip
        assert written(rest.lines[0])[0].numbers == "(3 − 0)/(1.5 − 0)"

    def test_of_a_block_on_two_slopes_is_where_the_normals_cross(self):
        rest = ChainCentres(positions("on two slopes", Direction.POSITIVE)[0])
        assert rest.centre(1) == pytest.approx(complex(0.5, -0.2))
        assert written(rest.lines[0])[0].formula.startswith("((x_[side] − x_[foot (/)]) v_[y]")

    def test_a_rounded_foot_turns_about_its_contact(self):
        _, displaced, _ = (ChainCentres(each) for each in positions("rounded", Direction.POSITIVE))
        (row,) = displaced.joints
        rolled = 0.05 * displaced.position.phi
        assert row.kind == "rolls" and row.at.imag == pytest.approx(50.0)
        assert row.at.real == pytest.approx(structure("rounded").pivot(Direction.POSITIVE).real + rolled)

    @pytest.mark.parametrize("beside", [0.01, None])
    def test_a_motion_that_is_not_that_of_the_joints_has_none(self, beside):
        class Elsewhere(Block):
            mechanism = "elsewhere"

            def guiding_joints(self, direction):
                (joint,) = super().guiding_joints(direction)
                return [] if beside is None else [replace(joint, point=joint.point + beside)]

        chain = Chain(Elsewhere(width=0.6, height=8.0), Direction.POSITIVE)
        centres = ChainCentres(DisplacedChain(ExactCurve(chain, chain.barycentre, 1.0), 0.0))
        assert not centres.is_known and centres.lines == []


def test_every_formula_of_this_part_is_used():
    # Walls of many stones need no further one, and take most of the time.
    used = [line.formula for name in NAMES if not name.startswith("masonry/") for line in lines_of(name)]
    known = {name: each for name, each in vars(formulas).items() if isinstance(each, Formula)}
    keys = {(each.symbol, each.text, each.meaning) for each in used}
    missing = {name for name in OF_STRUCTURE if (known[name].symbol, known[name].text, known[name].meaning) not in keys}
    assert missing <= {"MASS_OF_MECHANISM"}
    for group in (formulas.PARALLEL, formulas.SHARE, formulas.CENTRE):
        assert {each.meaning for each in group.values()} & {each.meaning for each in used}


# Templates


def parts_of_template(name, language, page, **context):
    say = build.SHEET.language(language)
    context |= {"body": lambda each: say.body(structure(name).mechanism, each), "of": "", "ending": ""}
    return sections(say, build.SHEET.package, page, context)


@pytest.mark.parametrize(
    "name", [*MORE, "walls/floor_wall.yaml", "frame.yaml", "curve.yaml", "arch.yaml", "laden, on a hazard"]
)
def test_templates_have_whole_tables_and_the_same_numbers_in_both_languages(name):
    numbers = {}
    for language in ("en", "it"):
        composition, (rest, *_) = Composition(structure(name)), positions(name, structure(name).directions[0])
        parts = [
            *parts_of_template(name, language, "geometry", structure=composition),
            *parts_of_template(name, language, "masses", structure=composition),
            *parts_of_template(name, language, "centres", centres=ChainCentres(rest)),
        ]
        parts += [below for part in parts for below in part.parts]
        tables = [item for part in parts for item in part.items if isinstance(item, Table)]
        for each in tables:
            assert each.title and each.rows and {len(row) for row in each.rows} == {len(each.columns)}, each
        numbers[language] = re.findall(r"\d+\.\d+", repr([each.rows for each in tables]).replace(",", "."))
    assert numbers["en"] and numbers["it"] == numbers["en"]


def test_templates_name_every_size_of_a_mechanism_of_this_package():
    known = Registry()
    for key in known:
        if not known[key].__module__.startswith("mechanisms."):
            continue
        for name, info in known[key].model_fields.items():
            extra = info.json_schema_extra if isinstance(info.json_schema_extra, dict) else {}
            if (
                name in StructureFields.model_fields
                or "list" in str(info.annotation)
                or extra.get("unit") not in SIZE_UNITS
            ):
                continue
            for language in ("en", "it"):
                text = (files("rocking_cli.codes.italian") / "texts" / language / "geometry.md").read_text("utf-8")
                assert f'"{key} {name}": "' in text or name in ("file", "negative_file"), (language, key, name)


def test_rows_of_loads_and_ties():
    crossed = Composition(structure("crossed").at_strength())
    own, walls = crossed.loads
    assert own.weight == pytest.approx(43200 * 9.80665e-3) and own.per_metre == pytest.approx(own.weight / 5)
    assert walls.reverses and walls.body == "block" and walls.force.imag == 0 and walls.at == pytest.approx(8j / 3)
    bed, rod = crossed.ties
    assert (bed.is_bed, bed.stiffness, bed.length) == (True, pytest.approx(100.0), 1.0)
    assert (rod.force, rod.area, rod.length) == (pytest.approx(20.0), 1e-4, pytest.approx(5.7))
    assert [spot.body for spot in rod.spots] == [None, "block"]
    rows = {each.key: (each.of, each.value) for each in crossed.materials}
    assert rows["unit_weight"] == ("", pytest.approx(17.65197)) and rows["yield"] == ("rod", 200.0)
    assert {"density", "strength", "friction", "friction_of_courses", "rebound", "bed"} <= rows.keys()
    wall = Composition(structure("walls/floor_wall.yaml"))
    assert wall.loads[-1].sideways == 0 and wall.loads[-1].weight == pytest.approx(2.0)
    given = Composition(structure("given"))
    assert [each.value for each in given.materials] == [0.8, 0.8]
    assert {each.key: each.value for each in given.dimensions} == {"thickness": 0.3, "height": 3.0}
    assert {each.density for parts in structure("sloping").solids().values() for each in parts} == {2000.0, 1500.0}
    own = [each for each in Composition(structure("sloping")).materials if each.of == "high"]
    assert [each.value for each in own] == [1500.0, pytest.approx(14.709975)]
