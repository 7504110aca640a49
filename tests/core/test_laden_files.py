"""Files in which loads, ties and supports are wrong: each gets one message, with its line and its field."""

import re

import pytest

from rocking_cli import Registry, load_structure
from rocking_cli.core import Direction
from rocking_cli.core.plausible import doubts
from rocking_cli.core.structure_file import parse_structure
from rocking_cli.errors import InputError
from tests.cli.test_cli import run
from tests.conftest import EXAMPLES

BARE = "mechanism: block\nwidth: 1\nheight: 5\n"  # line 3
HEAVY = BARE + "density: 2000\ndepth: 1\n"  # line 5
FRAME = "mechanism: symmetric_frame\ncolumn_width: 1\ncolumn_height: 6\nmass_ratio: 1.5\nmass: 6e4\n"
UNEQUAL = (EXAMPLES / "frame.yaml").read_text(encoding="utf-8")
BAR = "from: {ground: [-3, 1]}, to: {at: [-0.5, 4]}"


def load(fields, of=HEAVY):
    return f"{of}loads:\n  - {{name: a, {fields}}}\n"  # line 7


def tie(fields, of=HEAVY):
    return f"{of}ties:\n  - {{name: t, {fields}}}\n"  # line 7


CASES = [
    # places
    (load("mass: 5, at: [0.1, 1], body: colums", FRAME), 7, "loads[1].body", "no body 'colums': did you mean columns"),
    (load("mass: 5, at: [0.1, 1]", FRAME), 7, "loads[1].body", "is missing: say which body, of columns, beam"),
    (tie("from: {ground: [-3, 1]}, to: {at: [0, 9]}, stiffness: 1"), 7, "ties[1].to.at",
     r"\[0, 9\] lies outside block, whose corners are from x"),
    (tie("path: [{ground: [0, 0]}, {at: [0, 9]}], stiffness: 1"), 7, "ties[1].path[2].at", "lies outside block"),
    (tie("bed: {from: [-0.5, 0], to: [0.7, 0]}, modulus: 1"), 7, "ties[1].bed.to", "lies outside block"),
    # what nothing stretches
    (tie("from: {at: [0, 1]}, to: {at: [0, 4]}, stiffness: 1"), 7, "ties[1].name", "nothing stretches 't'"),
    (tie("from: {ground: [0, 1]}, to: {ground: [0, 4]}, stiffness: 1"), 7, "ties[1].from", "both ends are on the gr"),
    (tie("from: {ground: [0.5, 0]}, to: {at: [0.5, 0]}, stiffness: 1", HEAVY + "one_sided: positive\n"), 8,
     "ties[1].name", "no motion of the structure changes its length"),
    (tie(f"{BAR}, stiffness: 1, only: tension", HEAVY + "one_sided: negative\n"), 8, "ties[1].name",
     "nothing stretches 't' in tension"),
    # masses
    (load("mass: 5, at: [0, 1]", BARE), 5, "loads", "the structure has no masses: give density and depth, or its mass"),
    (BARE + "density: 5\n", 1, "depth", "is missing: density needs the size out of plane"),
    (load("at: [0, 1]"), 7, "loads[1].mass", "give one of `mass` and `force`"),
    # what cannot stand
    (load("force: [1e6, 0], at: [0, 1]"), 7, "loads", "in the positive direction with 9.51e.05 N m more"),
    (tie(f"{BAR}, stiffness: 1, prestress: 1e6"), 7, "ties", "cannot stand under them: .* in the negative direction"),
    # shares, rebound, restitution
    (load("force: [1, 1], at: [0, 1], weight: 0.5"), 7, "loads[1].weight", "a force has no mass to share"),
    (load("mass: 5, at: [0, 1], weight: 1, floor: borne"), 7, "loads[1].weight", "is already set by floor: borne"),
    (BARE + "one_sided: positive\nrebound: 1\n", 5, "rebound", "must be less than 1, got 1"),
    (BARE + "rebound: 0.1\n", 4, "rebound", "requires one_sided"),
    (BARE + "one_sided: positive\nrestitution: 0.9\n", 5, "restitution", "give `rebound` instead"),
    (UNEQUAL + "restitution: 1\n", 1 + UNEQUAL.count("\n"), "restitution",
     "at most 0.99.*: .* would add energy at an impact"),
    (UNEQUAL + "restitution: {positive_to_negative: 1.2, negative_to_positive: 0.5}\n", 1 + UNEQUAL.count("\n"),
     "restitution.positive_to_negative", "would add energy at an impact"),
    # what is to come
    (tie(f"{BAR}, stiffness: 1, break: 5"), 7, "ties[1].break", "an elongation at which it breaks"),
    (tie(f"{BAR}, stiffness: 1, damper: 5"), 7, "ties[1].damper", "a damper .* is not supported in this version"),
    (HEAVY + "dampers:\n  - {name: t}\n", 7, "dampers", "a damper is not in this version"),
    # names
    (load("mass: 5, at: [0, 1]") + "  - {name: a, mass: 5, at: [0, 1]}\n", 8, "loads[2].name", "'a' is already used"),
    (load("mass: 5, at: [0, 1]") + f"ties:\n  - {{name: a, {BAR}, stiffness: 1}}\n", 9, "ties[1].name",
     "'a' is already used"),
    (HEAVY + 'loads:\n  - {name: "a\\x1b[31mred", mass: 5, at: [0, 1]}\n', 7, "loads[1].name", "printable characters"),
    # stiffness and path
    (tie(f"{BAR}, stiffness: 1, area: 1, modulus: 1"), 7, "ties[1].stiffness", "give stiffness, or area and modulus"),
    (tie(f"{BAR}, stiffness: 1, length: 1"), 7, "ties[1].length", "cannot be combined with `stiffness`"),
    (tie("from: {ground: [0, 0]}, to: {at: [0, 0]}, area: 1, modulus: 1"), 7, "ties[1].length", "together at rest"),
    (tie("path: [{ground: [0, 0]}], stiffness: 1"), 7, "ties[1].path", "must have at least 2 entries, has 1"),
    (tie(f"path: [{{ground: [0, 0]}}, {{at: [0, 0]}}], {BAR}, stiffness: 1"), 7, "ties[1].from",
     "give one of: `from` and `to`, `path`, or `bed`"),
    (tie(f"{BAR}, stiffness: 1, only: tension, prestress: -5"), 7, "ties[1].prestress", "acts in tension only"),
    (tie("bed: {from: [-0.5, 0], to: [0.5, 0]}, stiffness: 5"), 7, "ties[1].stiffness", "a bed has a modulus"),
    (tie("bed: {from: [0.5, 0], to: [0.5, 0]}, modulus: 1"), 7, "ties[1].bed", "its face has no length"),
    # numbers that are none, or far too large
    (load("force: [1e308, 0], at: [0, 1]"), 7, "loads[1].force[1]", "at most 1e.12, got 1e.308"),
    (tie("from: {ground: [.inf, 1]}, to: {at: [0, 4]}, stiffness: 1"), 7, "ties[1].from.ground[1]", "finite"),
    (HEAVY + "loads:\n" + "".join(f"  - {{name: a{k}, mass: 5, at: [0, 1]}}\n" for k in range(1100)), 7, "loads",
     "must have at most 1000 entries, has 1100"),
    (HEAVY + "loads: 5\n", 6, "loads", "must be a list, got 5"),
]  # fmt: skip


@pytest.mark.parametrize(("text", "line", "field", "said"), CASES)
def test_a_wrong_file_gets_one_message_at_its_place(text, line, field, said, tmp_path):
    file = tmp_path / "s.yaml"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(InputError) as error:
        load_structure(file)
    (problem,) = error.value.problems
    assert (problem.line, problem.field) == (line, field) and problem.file == str(file)
    assert re.search(said, problem.message), problem.message
    assert "\x1b" not in str(error.value)


def test_the_command_line_says_the_same(tmp_path):
    file = tmp_path / "s.yaml"
    file.write_text(load("mass: 5, at: [0, 1], weight: 2"), encoding="utf-8")
    for command in (("equiv",), ("respond", "--release", "1deg"), ("draw",)):
        assert f"{file}:7:44: loads[1].weight" in run(*command, file, code=2).stderr.replace("\n", "")


@pytest.mark.parametrize("off", [0.0, 1e-15, -1e-15, 1e-12, -1e-12])
def test_neutral_equilibrium_is_said_as_such(off):
    """A push m g b/h at the top balances the weight exactly; the last digits of the sum decide nothing."""
    block, width, height, mass = Registry()["block"], 0.7, 2.9, 1234.5
    push = mass * 9.80665 * width / 2 / height

    def pushed(share):
        return block(
            width=width, height=height, mass=mass,
            loads=[{"name": "push", "force": [share * push, 0.0], "at": [0.0, height]}],
        )  # fmt: skip

    with pytest.raises(InputError, match="with as much as its weight holds, which is neutral equilibrium"):
        pushed(1 + off)
    with pytest.raises(InputError, match=f"with {0.01 * push * height:.4g} N m more than its weight holds"):
        pushed(1.01)
    assert pushed(0.99).uplift(Direction.POSITIVE) == pytest.approx(0.01 * width / height, rel=1e-9)


def test_the_list_of_fields_says_from_where_a_load_is_measured():
    said = " ".join(run("mechanisms", "loads").stdout.split())
    assert "of a block from the middle of its base" in said
    block = Registry()["block"](width=0.6, height=2.0)
    assert sum(block.feet()) == 0  # its origin is the middle of its base


def test_in_python_the_argument_is_named():
    bar = {"name": "t", "from": {"ground": [-3.0, 1.0]}, "to": {"at": [0.6, 1.0]}, "stiffness": 1.0}
    with pytest.raises(InputError, match=r"ties\[1\]\.to\.at: \[0\.6, 1\] lies outside block"):
        Registry()["block"](width=1.0, height=5.0, mass=1.0, restitution=0.9, ties=[bar])


def test_a_load_may_stand_above_its_block():
    """The centre of mass of a statue above its pedestal, against the sums of both by hand."""
    b, h, M, m, y = 0.5, 2.5, 9000.0, 700.0, 7.2
    laden = Registry()["block"](
        width=2 * b, height=2 * h, mass=M, restitution=0.9, loads=[{"name": "statue", "mass": m, "at": [0.0, y]}]
    )
    assert laden.uplift(Direction.POSITIVE) == pytest.approx((M + m) * b / (M * h + m * y), rel=1e-12)
    inertia = 4 / 3 * M * (b**2 + h**2) + m * (b**2 + y**2)
    assert laden.kinetic_inertia([0.0], Direction.POSITIVE)[0] == pytest.approx(inertia, rel=1e-12)
    assert not doubts(laden)


@pytest.mark.parametrize(
    ("at", "off"), [([0.0, 10.0], None), ([0.0, 10.2], "1"), ([-15.8, 2.0], "3"), ([5.59, 1], None)]
)
def test_a_load_far_from_its_block_is_doubted(tmp_path, at, off):
    """The block is 1 m x 5 m, hypot(1, 5) = 5.099 m large."""
    file = tmp_path / "s.yaml"
    file.write_text(load(f"mass: 5, at: {at}"), encoding="utf-8")
    said = " ".join(run("equiv", file).stderr.split())
    assert ("times the size of block away from it" in said) == (off is not None)
    if off is not None:
        assert f"loads.a.at is [{at[0]:g}, {at[1]:g}] m, {off} times the size of block away" in said


def test_none_of_them_is_bare():
    assert not Registry()["block"].from_fields({"width": 1.0, "height": 5.0, "loads": [], "ties": None}).attached


def test_hundreds_of_each_stand(tmp_path):
    loads = "".join(f"  - {{name: a{k}, mass: 5, at: [0, {1 + k / 300}]}}\n" for k in range(300))
    ties = "".join(f"  - {{name: t{k}, {BAR}, stiffness: 1, only: tension}}\n" for k in range(300))
    file = tmp_path / "s.yaml"
    file.write_text(f"{HEAVY}loads:\n{loads}ties:\n{ties}", encoding="utf-8")
    structure = load_structure(file)
    assert len(structure.attached) == 600


def test_a_kinematic_rebound_is_that_of_the_impacts_in_sequence():
    """Of a plain rectangle: (1 - 1.5 sin^2 alpha)^2 |1 - 1.5 cos^2 alpha| with tan alpha = b/h."""
    block = Registry()["block"]
    leaning = block(width=0.6, height=2.8, one_sided="positive", rebound="kinematic")
    square = 0.6**2 / (0.6**2 + 2.8**2)  # sin^2 alpha
    assert leaning.eta(Direction.POSITIVE) == pytest.approx((1 - 1.5 * square) ** 2 * abs(1 - 1.5 * (1 - square)))
    assert leaning.restitution_is_kinematic
    assert leaning.enlarged(2.0).eta(Direction.POSITIVE) == pytest.approx(leaning.eta(Direction.POSITIVE))


@pytest.mark.parametrize(
    ("fields", "said"),
    [
        ("rebound: kinematic", "requires one_sided"),
        ("one_sided: positive\nrebound: kinematic\nloads: [{name: a, mass: 5, at: [0, 1]}]",
         "cannot be kinematic: only for a plain rectangle does it follow from the shape; give a number"),
        ("one_sided: positive\nrebound: kinematics", "must be a number, got the text 'kinematics'"),
    ],
)  # fmt: skip
def test_a_rebound_that_does_not_follow_is_refused(fields, said):
    text = "mechanism: block\nwidth: 1\nheight: 5\ndensity: 2000\ndepth: 1\n" + fields + "\n"
    with pytest.raises(InputError) as error:
        parse_structure(text, "s.yaml", "s")
    (problem,) = error.value.problems
    assert problem.field == "rebound" and said in problem.message
