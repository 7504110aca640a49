"""Structure files: what they mean, and one clear message with its place for everything that is wrong."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mechanisms.asymmetric_frame import AsymmetricFrame
from mechanisms.block import Block
from rocking_cli.core import Direction
from rocking_cli.core.structure_fields import DirectionalRestitution
from rocking_cli.core.structure_file import load_structure, parse_structure
from rocking_cli.errors import InputError, MechanismError, StructureError, of_structure


def parse(text):
    return parse_structure(text, "file.yaml", "file")


def problems(text):
    with pytest.raises(InputError) as caught:
        parse(text)
    return caught.value.problems


BLOCK = "mechanism: block\nwidth: 1\nheight: 4\n"


def test_a_file_becomes_a_structure_named_after_it(tmp_path):
    path = tmp_path / "chimney.yaml"
    path.write_text("﻿" + BLOCK.replace("\n", "\r\n"), encoding="utf-8")
    assert load_structure(path) == Block(name="chimney", width=1.0, height=4.0)


def test_plain_scalars_are_those_of_yaml_1_2():
    assert parse("mechanism: block\nwidth: 1e0\nheight: 012\nname: on\n") == Block(name="on", width=1.0, height=12.0)
    assert parse("mechanism: block\nwidth: +.5\nheight: 1.E+1\n") == Block(name="file", width=0.5, height=10.0)


def test_restitution_is_a_number_or_one_for_each_impact():
    assert parse(BLOCK + "restitution: 0.8\n").restitution == 0.8
    both = parse(BLOCK + "restitution: {positive_to_negative: 0.9, negative_to_positive: 0.7}\n").restitution
    assert both == DirectionalRestitution(positive_to_negative=0.9, negative_to_positive=0.7)


# text, line, column, field, words of the message or hint
WRONG = {
    "unknown mechanism": ("mechanism: blok\nwidth: 1\n", 1, 12, "mechanism", "did you mean block?"),
    "mechanism missing": ("width: 1\n", 1, 1, "mechanism", "is missing"),
    "mechanism no word": ("mechanism: [block]\n", 1, 12, "mechanism", "unknown mechanism"),
    "unknown key": (BLOCK + "heigth: 2\n", 4, 1, "heigth", "did you mean height?"),
    "field missing": ("mechanism: block\nwidth: 1\n", 1, 1, "height", "is missing: height [m]"),
    "text for a number": ("mechanism: block\nwidth: wide\nheight: 4\n", 2, 8, "width", "must be a number in m, got the text 'wide'"),
    "decimal comma": ("mechanism: block\nwidth: 0,7\nheight: 4\n", 2, 8, "width", "write a decimal point"),
    "unknown unit": ("mechanism: block\nwidth: 700 mmm\nheight: 4\n", 2, 8, "width", "did you mean mm?"),
    "unit of another kind": ("mechanism: block\nwidth: 700 kg\nheight: 4\n", 2, 8, "width", "700 kg is a mass, not a length"),
    "unit of a pure number": (
        "mechanism: symmetric_frame\ncolumn_width: 1\ncolumn_height: 5\nmass_ratio: 1 kg\n", 4, 13, "mass_ratio",
        "must be a number, got the text '1 kg'",
    ),
    "pressure for a density": (
        "mechanism: asymmetric_frame\ncolumn_width: 1\nleft_height: 5\nright_height: 6\nspacing: 4\nbeam_depth: 1\n"
        "density: 18 kN/m2\ndepth: 1\n", 7, 10, "density", "18 kN/m2 is a pressure, not a density",
    ),
    "mapping for a number": ("mechanism: block\nwidth: {a: 1}\nheight: 4\n", 2, 8, "width", "got a mapping"),
    "whole but beyond all numbers": (
        f"mechanism: block\nwidth: {'9' * 400}\nheight: 4\n", 2, 8, "width", "outside the range of floating-point numbers",
    ),
    "merge key": (BLOCK + "<<: {name: x}\n", 4, 1, "<<", "write the fields out"),
    "list that is not closed in time": (BLOCK + "name: [1\ngravity: 9\n", 5, 8, None, "it begins in line 4"),
    "empty name": (BLOCK + "name: ' '\n", 4, 7, "name", "is empty"),
    "control character in a name": (BLOCK + 'name: "a\\e[31m"\n', 4, 7, "name", r"got 'a\x1b[31m'"),
    "feet at different heights": (
        "mechanism: rigid_body\npolygon: [[0, 0], [1, 0.001], [0.8, 3], [0, 3]]\n", 2, 10, "polygon",
        "the next is 0.001 m higher",
    ),
    "mechanism misspelt": ("mechansim: block\nwidth: 1\n", 1, 1, "mechanism", "did you mean mechanism instead of mechansim?"),
    "truth for a number": ("mechanism: block\nwidth: true\nheight: 4\n", 2, 8, "width", "got true"),
    "nothing for a number": ("mechanism: block\nwidth:\nheight: 4\n", 2, 7, "width", "got nothing"),
    "tiny width": ("mechanism: block\nwidth: 1e-300\nheight: 4\n", 2, 8, "width", "must be at least 1e-06 m, got 1e-300"),
    "zero": ("mechanism: block\nwidth: 0\nheight: 4\n", 2, 8, "width", "must be more than 0 m, got 0"),
    "infinite": ("mechanism: block\nwidth: .inf\nheight: 4\n", 2, 8, "width", "finite"),
    "not a number": ("mechanism: block\nwidth: .nan\nheight: 4\n", 2, 8, "width", "finite"),
    "beyond any structure": ("mechanism: block\nwidth: 1e9\nheight: 4\n", 2, 8, "width", "at most 1e+06 m"),
    "given twice": (BLOCK + "width: 2\n", 4, 1, "width", "given twice, first in line 2"),
    "not YAML": ("mechanism: [block\nwidth: 1\n", 2, 6, None, "not YAML"),
    "two documents": (BLOCK + "---\n" + BLOCK, 4, 1, None, "not YAML"),
    "a list": ("- 1\n", 1, 1, None, "field: value"),
    "foreign tag": ("mechanism: block\nwidth: !!python/object:os.abort 1\nheight: 4\n", 2, 8, None, "unknown tag"),
    "nested forever": ("&a [*a]\n", 1, 1, None, "nested too deep"),
    "eta above 1": (BLOCK + "restitution: 1.1\n", 4, 14, "restitution", "must be at most 1, got 1.1"),
    "half a restitution": (
        BLOCK + "restitution:\n  positive_to_negative: 0.9\n", 5, 3, "restitution.negative_to_positive", "is missing",
    ),
    "eta of one impact": (
        BLOCK + "restitution: {positive_to_negative: 0.9, negative_to_positive: 3}\n", 4, 64,
        "restitution.negative_to_positive", "at most 1",
    ),
    "deviation of everything": (
        BLOCK + "uncertainty:\n  restitution: 1\n", 5, 16, "uncertainty.restitution", "must be less than 1, got 1",
    ),
    "deviation of what": (
        BLOCK + "uncertainty: {slendernes: 0.05}\n", 4, 15, "uncertainty.slendernes", "did you mean slenderness?",
    ),
    "deviation alone": (BLOCK + "uncertainty: 0.05\n", 4, 14, "uncertainty", "got"),
    "an option of the analysis": (BLOCK + "opening: 0.005\n", 4, 10, "opening", "give `opening` to the analysis"),
    "number for a name": (BLOCK + "name: 12\n", 4, 7, "name", "must be text"),
    "kind of cone": ("mechanism: cone\nbase_radius: 1\nheight: 5\nkind: full\n", 4, 7, "kind", "shell, solid or hollow"),
    "hollow of what": ("mechanism: cone\nbase_radius: 1\nheight: 5\nkind: hollow\n", 1, 1, "inner_ratio", "needs inner_ratio"),
    "inner of a shell": (
        "mechanism: cone\nbase_radius: 1\nheight: 5\nkind: shell\ninner_ratio: 0.5\n", 5, 14, "inner_ratio", "kind: hollow",
    ),
    "thin arch": (
        "mechanism: arch\nradius: 10\nthickness: 0.5\ninclusion_angle_deg: 180\n", 3, 12, "thickness",
        "the arch needs at least 1.0747",
    ),
    "arch without intrados": (
        "mechanism: arch\nradius: 10\nthickness: 20\ninclusion_angle_deg: 180\n", 3, 12, "thickness", "no intrados",
    ),
    "arch too thick": (
        "mechanism: arch\nradius: 10\nthickness: 5\ninclusion_angle_deg: 10\n", 3, 12, "thickness", "too thick for a four-hinge mechanism",
    ),
    "columns overlap": (
        "mechanism: asymmetric_frame\ncolumn_width: 1\nleft_height: 5\nright_height: 6\nspacing: 1\nbeam_depth: 1\n"
        "density: 1\ndepth: 1\n", 5, 10, "spacing", "overlap",
    ),
    "half the masses": (
        "mechanism: asymmetric_frame\ncolumn_width: 1\nleft_height: 5\nright_height: 6\nspacing: 4\nbeam_depth: 1\n"
        "left_mass: 1\nbeam_mass: 1\n", 1, 1, "density", "left_mass, beam_mass and right_mass",
    ),
    "no description of a body": ("mechanism: rigid_body\nR: 1\nalpha_deg: 10\n", 1, 1, "inertia_ratio", "is missing"),
    "two descriptions": (
        "mechanism: rigid_body\nR: 1\npolygon: [[0, 0], [1, 0], [1, 3]]\n", 3, 10, "polygon", "describe the body in one of the two ways",
    ),
    "inverted polygon": ("mechanism: rigid_body\npolygon: [[0, 3], [1, 3], [0.5, 0]]\n", 2, 10, "polygon", "one corner"),
    "crossing polygon": (
        "mechanism: rigid_body\npolygon: [[0, 0], [1, 3], [1, 0], [0, 3]]\n", 2, 10, "polygon", "sides cross",
    ),
    "thin polygon": (
        "mechanism: rigid_body\npolygon: [[0, 0], [1, 0], [1, 1e-12], [0, 1e-12]]\n", 2, 10, "polygon", "same point",
    ),
    "corner of one number": ("mechanism: rigid_body\npolygon: [[0, 0], [1, 0], [1]]\n", 2, 27, "polygon[3]", "at least 2"),
    "lands on another side": (
        "mechanism: rigid_body\npolygon: [[0, 0], [1, 0], [9, 0.2], [9, 0.4], [0, 0.2], [-9, 0.4], [-9, 0.2]]\n", 2, 10,
        "polygon", "another corner meets the ground",
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", WRONG)
def test_a_wrong_file_gets_one_message_at_its_place(case):
    text, line, column, field, words = WRONG[case]
    found = problems(text)
    assert len(found) == 1, [str(problem) for problem in found]
    problem = found[0]
    assert (problem.file, problem.line, problem.column, problem.field) == ("file.yaml", line, column, field)
    assert words in str(problem)
    assert problem.excerpt == text.splitlines()[line - 1].replace("\t", " ")
    assert max(map(len, str(problem).splitlines())) < 200  # long lines and values are cut


def test_a_corner_that_would_land_on_the_side_to_which_nothing_turns_is_allowed():
    """A wedge behind a wall that leans on a building reaches further back than the wall is wide."""
    behind = "mechanism: rigid_body\npolygon: [[0, 0], [0.3, 0], [0.3, 0.2], [-0.1, 0.2], [-0.1, 0.1]]\n"
    (problem,) = problems(behind)
    assert "in the negative direction another corner meets the ground" in str(problem)
    assert parse(behind + "one_sided: positive\nrebound: 0.3\n").directions == [Direction.POSITIVE]
    assert problems(behind + "one_sided: negative\nrebound: 0.3\n")


def test_all_problems_are_listed_at_once_in_the_order_of_the_file():
    found = problems("mechanism: block\nwidht: 1\nheight: -2\nrestitution: 7\nheight: 3\n")
    assert [problem.line for problem in found] == [1, 2, 3, 4, 5]


@pytest.mark.parametrize("text", ["", "# only a comment\n", "---\n"])
def test_an_empty_file_says_how_to_start(text):
    (problem,) = problems(text)
    assert "empty" in problem.message or "field: value" in problem.message
    assert "rocking new" in problem.hint


def test_files_that_cannot_be_read_say_why(tmp_path):
    binary, latin = tmp_path / "binary.yaml", tmp_path / "latin.yaml"
    binary.write_bytes(b"\x7fELF\0\0\0")
    latin.write_bytes("mechanism: block\nname: Façade\n".encode("latin-1"))
    for path, words in (
        (tmp_path / "none.yaml", "no such file"), (tmp_path, "folder"), (binary, "binary"), (latin, "latin.yaml:2: not UTF-8"),
    ):  # fmt: skip
        with pytest.raises(InputError, match=words):
            load_structure(path)


def test_masses_or_density_describe_the_same_frame():
    common = {"column_width": 1.0, "left_height": 6.0, "right_height": 7.5, "spacing": 8.0, "beam_depth": 1.0}
    by_density = AsymmetricFrame(**common, density=2000.0, depth=0.5)
    by_mass = AsymmetricFrame(**common, left_mass=6000.0, beam_mass=9000.0, right_mass=7500.0)
    assert by_density.bodies() == by_mass.bodies()


@given(st.text(max_size=200))
def test_no_text_makes_more_than_an_input_error(text):
    try:
        parse(text)
    except InputError as error:
        assert error.problems


@given(st.dictionaries(
    st.sampled_from(["mechanism", "width", "height", "name", "gravity", "restitution", "polygon"]),
    st.one_of(
        st.sampled_from(["block", "rigid_body", "arch"]), st.floats(), st.none(), st.booleans(),
        st.lists(st.lists(st.floats(-5, 5), max_size=3), max_size=6),
    ),
))  # fmt: skip
def test_no_values_make_more_than_an_input_error(data):
    import yaml

    try:
        parse(yaml.safe_dump(data))
    except InputError as error:
        assert error.problems


@pytest.mark.parametrize("value", ["!!int abc", "!!float abc", "!!bool maybe", "9" * 5000])
def test_a_tag_that_does_not_fit_is_an_input_error(value):
    (problem,) = problems(f"mechanism: block\nwidth: {value}\nheight: 4\n")
    assert problem.line == 2


def test_a_file_of_an_older_windows_shell_is_read(tmp_path):
    path = tmp_path / "wide.yaml"
    path.write_bytes(BLOCK.encode("utf-16"))
    assert load_structure(path).width == 1.0


@pytest.mark.parametrize(("radius", "beta"), [(10.0, 180.0), (1000.0, 180.0), (10000.0, 180.0), (3.7, 120.0)])
def test_the_least_thickness_that_an_error_recommends_is_accepted(radius, beta):
    text = f"mechanism: arch\nradius: {radius}\ninclusion_angle_deg: {beta}\nthickness: "
    (problem,) = problems(f"{text}{0.001 * radius}\n")
    least = problem.message.split("at least ")[1].split(" m")[0]
    assert parse(f"{text}{least}\n").thickness == float(least)


def test_a_corner_visited_twice_is_refused_even_if_the_outline_closes():
    (problem,) = problems("mechanism: rigid_body\npolygon: [[0,0],[1,0],[.5,4],[.6,5],[.4,5],[.5,4]]\n")
    assert "same point" in problem.message


def test_a_changed_copy_is_a_new_structure():
    from mechanisms.arch import Arch
    from rocking_cli.core import Direction

    thin = Arch(radius=10.0, thickness=1.5, inclusion_angle_deg=157.5)
    assert thin.uplift(Direction.POSITIVE) > 0
    thick, fresh = (
        thin.model_copy(update={"thickness": 3.0}),
        Arch(radius=10.0, thickness=3.0, inclusion_angle_deg=157.5),
    )
    assert thick.uplift(Direction.POSITIVE) == fresh.uplift(Direction.POSITIVE)
    with pytest.raises(ValueError, match="too thin"):
        thin.model_copy(update={"thickness": 0.1})


ALIASES = "a: &a [1,1,1,1,1,1,1,1,1,1]\n" + "".join(
    f"{one}: &{one} [{','.join([f'*{other}'] * 10)}]\n" for other, one in zip("abcdefgh", "bcdefghi", strict=True)
)


def test_aliases_that_stand_for_billions_are_refused_where_they_do(monkeypatch):
    monkeypatch.setattr("rocking_cli.io.yaml_file.MAX_VALUES", 5000)
    (problem,) = problems(BLOCK + ALIASES)
    assert problem.field in "defghi" and problem.line == 4 + "abcdefghi".index(problem.field)
    assert "more than 5000 values" in problem.message and "aliases" in problem.hint


def test_an_alias_that_repeats_a_value_is_read():
    assert parse("mechanism: block\nwidth: &w 1\nheight: *w\n") == Block(name="file", width=1.0, height=1.0)


def test_a_control_character_in_the_file_itself_is_placed():
    (problem,) = problems(BLOCK + "name: a\x1b[31m\n")
    assert problem.line == 4 and r"\x1b" in problem.message


def test_a_file_that_no_terminal_can_spell_gives_a_name_that_it_can(tmp_path):
    path = tmp_path / "a\x1b[31m\u202e.yaml"
    try:
        path.write_text(BLOCK, encoding="utf-8")
    except OSError:
        pytest.skip("no such file name here")
    assert load_structure(path).name == r"a\x1b[31m\u202e"


def test_sizes_with_units_are_the_same_structure():
    assert parse("mechanism: block\nwidth: 700 mm\nheight: 12 ft\ngravity: 981 cm/s2\n") == Block(
        name="file", width=0.7, height=3.6576, gravity=9.81
    )
    assert Block(width="700 mm", height=2.0).model_dump() == Block(width=0.7, height=2.0).model_dump()
    corners = parse("mechanism: rigid_body\npolygon: [[0, 0 mm], [1 m, 0], [80 cm, 3], [0, 3]]\n").polygon
    assert corners == [[0.0, 0.0], [1.0, 0.0], [0.8, 3.0], [0.0, 3.0]]
    arch = "mechanism: arch\nradius: 10\nthickness: 1.5\ninclusion_angle_deg: "
    assert parse(arch + "157.5 deg\n") == parse(arch + "157.5\n")
    assert parse(arch + "2.7 rad\n").inclusion_angle_deg == pytest.approx(154.6986, abs=1e-4)


def test_what_is_not_given_of_how_well_it_is_known_is_left_to_the_usual():
    plain, half = parse(BLOCK), parse(f"{BLOCK}uncertainty: {{slenderness: 0.03}}\n")
    assert plain.uncertainty is None
    assert half.uncertainty.slenderness == 0.03 and half.uncertainty.restitution is None
    assert Block(width=1.0, height=4.0, uncertainty={"restitution": 0}).uncertainty.restitution == 0.0


def test_a_plugin_takes_units_without_a_line_of_its_own():
    from typing import ClassVar

    from rocking_cli.core import quantity

    class Sprung(Block):
        mechanism: ClassVar[str] = "sprung"
        strength: float = quantity("strength", unit="Pa", example=1e6)
        moment: float = quantity("moment", unit="N m", example=1.0, default=1.0)
        corner: tuple[float, float] = quantity("a corner", unit="m", default=(0.0, 0.0))

    made = Sprung(width="1 m", height=2.0, strength="2 MPa", moment="3 N m", corner=("1 cm", 2.0))
    assert (made.strength, made.moment, made.corner) == (2e6, 3.0, (0.01, 2.0))
    with pytest.raises(ValueError, match="3 kN is a force, not a pressure"):
        Sprung(width=1.0, height=2.0, strength="3 kN")


@pytest.mark.parametrize(("text", "line"), [("name: [1,\n  2,\n\n", 5), ("name: {", 4), ("name: 'x\n y\n", 4)])
def test_a_file_that_ends_too_early_has_a_line(text, line):
    (problem,) = problems(BLOCK + text)
    assert problem.line == line and "not YAML" in problem.message


def test_a_name_that_is_left_empty_is_that_of_the_file():
    assert parse_structure("mechanism: block\nname:\nwidth: 1\nheight: 4\n", "f.yaml", "f").name == "f"


def test_a_structure_without_an_answer_is_named_once_and_is_wrong_input():
    error = of_structure(of_structure(StructureError("it cannot stand"), "tower"), "tower")
    assert str(error) == "tower: it cannot stand" and error.exit_code == 2
    broken = of_structure(MechanismError("it jumps"), "tower")
    assert type(broken) is MechanismError and broken.exit_code == 3
