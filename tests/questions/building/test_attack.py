"""Hostile buildings and tables: what is said of them is no more than what was computed."""

import copy
import json
from itertools import pairwise
from math import nan

import pytest

import rocking_cli as rk
from rocking_cli.errors import InputError
from rocking_cli.io.spreadsheet import read_sheet
from rocking_cli.questions.building.study import known_last
from rocking_cli.questions.building.view import words
from rocking_cli.questions.building.walls import building_in
from tests.conftest import EXAMPLES

SITE = {"FC": 1.35, "ag": 0.2, "F0": 2.5, "TC": 0.4, "S": 1.2}
WALL = {"name": "w", "length": 8.0, "thickness": 0.5}
HOUSE = {"site": SITE, "levels": [0.0, 3.2, 6.0], "masonry": {"density": 2000.0}, "walls": [WALL]}
TIE = {"level": 2, "walls": ["w"], "length": 6.0, "bars": 2, "diameter": 0.02, "steel": "S235", "gamma": 1.15}
FLOOR = {"name": "floor", "level": 1, "load": 400.0, "span": 4.0, "walls": ["w"]}


def house(**changed):
    return copy.deepcopy(HOUSE) | changed


def told(answer):
    return "\n".join(answer.sentences)


class TestDesignedTies:
    def test_ties_of_another_level_do_not_decide(self):
        weak = TIE | {"bars": 1, "diameter": 0.004}
        strong_site = SITE | {"ag": 0.22}
        answer = rk.building(house(site=strong_site, ties=[TIE | {"level": 1}, weak]), design=1)
        tried = answer.to_dict()["designed"]["tried"]
        assert tried[-1]["satisfied"] and tried[-1]["title"] == "w: overturns about 0 m"
        assert (
            answer.to_dict()["designed"]["conclusion"]["concluded"] == "not_satisfied"
        )  # the upper storey still falls

    @pytest.mark.rest
    def test_what_stands_on_a_held_wall_governs_too(self):
        answer = rk.building(house(ties=[TIE], parapets=[{"wall": "w", "height": 2.0, "thickness": 0.25}]), design=2)
        assert answer.to_dict()["designed"]["governs"] == "parapet of w: overturns about 6 m"
        assert "still not satisfied" in told(answer)

    @pytest.mark.rest
    def test_what_is_not_decided_does_not_fail(self):
        answer = rk.building(house(ties=[TIE], site=SITE | {"intervention": "local"}), design=2)
        assert "Whether bars suffice at level 2 is not decided" in told(answer)
        assert "No bars" not in told(answer)

    def test_conditions_and_what_is_open_are_said(self):
        walls = [WALL | {"thickness": [0.6, 0.5]}]
        answer = rk.building(house(ties=[TIE], walls=walls), design=2)
        assert "some only on conditions" in told(answer) and "still not checked" in told(answer)


class TestVerdicts:
    def test_conditions_of_the_strengthened_building_are_named(self):
        after = house(ties=[TIE], walls=[WALL | {"thickness": [0.6, 0.5]}])
        said = [
            each for each in rk.building(house(), strengthened=after).sentences if each.startswith("Strengthened: ")
        ]
        assert any("Condition: the anchorages" in each for each in said)
        assert any("though it may govern: w: bends between 0 and 6 m" in each for each in said)

    def test_records_that_do_not_count_are_named(self):
        answer = rk.building(house(rebound=0.3), motions=EXAMPLES / "accel.csv", worst=1)
        assert "Not counted at SLV" in told(answer)
        assert "verified too" not in told(answer)
        everything = rk.building(house(rebound=0.3), motions=EXAMPLES / "accel.csv", worst=9)
        assert "Of the other mechanisms" not in told(everything)

    def test_motions_of_a_floor_are_for_its_height(self):
        floor = {"z": 3.2, "H": 6.0, "T1": 0.3, "xi1": 0.05, "n": 2}
        given = house(rebound=0.3, site=SITE | {"floor": floor})
        with pytest.raises(InputError, match=r"`on_floor` is of motions at 3.2 m, and w: .* is shaken at 0 m"):
            rk.building(given, motions=EXAMPLES / "accel.csv", on_floor=True, worst=9)

    def test_what_is_open_needs_no_values_of_the_site(self):
        answer = rk.building(house(ties=[TIE], walls=[WALL | {"thickness": [0.6, 0.5]}]))
        assert answer.conclusion.concluded == "not_checked" and list(answer.conclusion.next) == []

    def test_each_mechanism_that_is_not_verified_has_a_name_and_one_reason(self):
        strips = [{"storey": 1, "x": x, "z": 1 + x / 8, "width": 4.0, "height": 1.0} for x in (0.0, 4.0)]
        answer = rk.building(house(walls=[WALL | {"openings": strips}]))
        assert [words("en")(each.title) for each in answer.left_out if each.open] == ["w: overturns about 0 m"]
        answer = rk.building(house(gables=[{"wall": "w", "height": 900.0}]))
        reasons = [each.why for each in answer.left_out if each.open]
        assert all("\n" not in each and "and 5 more" in each for each in reasons)

    def test_one_fault_of_the_site_is_said_once(self):
        site = {"FC": 1.35, "VN": 50, "CU": 1.0, "soil": "B", "hazard": [[101, 0.1, 2.4, 0.3], [200, 0.12, 2.4, 0.3]]}
        with pytest.raises(InputError) as error:
            rk.building(house(site=site))
        assert str(error.value).count("return periods") == 1

    def test_an_unknown_ratio_comes_first(self):
        assert min([1.0, nan, 0.5], key=known_last) != min([1.0, 0.5], key=known_last)
        assert sorted([1.0, nan, 0.5], key=known_last)[1:] == [0.5, 1.0]

    def test_json_is_english(self):
        english, italian = (rk.building(house(), language=each).to_dict() for each in ("en", "it"))
        assert json.dumps(english["mechanisms"]) == json.dumps(italian["mechanisms"])


class TestDescription:
    @pytest.mark.parametrize(
        ("changed", "said"),
        [
            ({"floors": [FLOOR, FLOOR | {"level": 2}]}, "floors[2].name is that of another on w"),
            ({"floors": [FLOOR | {"name": "roof"}], "roof": {"load": 200.0, "span": 4.0, "walls": ["w"]}},
             "floors[1].name is that of another on w"),
            ({"ties": [TIE, TIE | {"below": 1.0}]}, "ties[2].name is that of another on w"),
            ({"ties": [TIE | {"level": -500}]}, "level must be"),
            ({"floors": [FLOOR | {"seat": 2.0}]}, "seat is more than the thickness of w below it, 0.5 m"),
            ({"bell_gables": [{"wall": "w", "height": 2.0, "length": 2.0,
                               "openings": [{"x": 5.0, "z": 0.5, "width": 1.0, "height": 1.0}]}]},
             "ends 6 m from the left end of a gable 2 m long"),
            ({"bell_gables": [{"wall": "w", "height": 2.0, "length": 2.0,
                               "openings": [{"x": 0.0, "z": 0.5, "width": 1.5, "height": 1.0}] * 2}]},
             "overlaps another opening of the gable"),
            ({"interlock": {"course": 0.2, "overlap": 0.15}, "corners": [{"walls": ["w", "u"]}],
              "walls": [WALL | {"storeys": [1, 1]}, WALL | {"name": "u", "storeys": [2, 2], "on": "beam"}]},
             "has no storey in common with w"),
        ],
    )  # fmt: skip
    def test_what_cannot_be_is_refused(self, changed, said):
        with pytest.raises(InputError, match=said.replace("[", r"\[")):
            rk.building(house(**changed))

    def test_ties_of_one_name_on_other_walls_are_fine(self):
        walls = [WALL, WALL | {"name": "v"}]
        assert rk.building(house(walls=walls, ties=[TIE, TIE | {"walls": ["v"]}, TIE | {"level": 1}])).left_out

    def test_italian_names_may_be_meant(self):
        given = house(walls=[WALL | {"thickness": 3.5}]) | {"unusual": ["spessore", "width"]}
        assert len(rk.building(given).rows) == 2


HEADS = "name,storey,thickness,height,length,density\n"


@pytest.mark.parametrize(
    ("rows", "said"),
    [
        ("a,1,.6,3,9,1800\na,2,.6,3,9,2400\n", "walls.csv:3: a has two densities"),
        ("a,1,.6,3,9,\nb,1,.6,3,9,2400\n", "walls.csv:2: density is missing"),
        ("a,100000000,.6,3,9,1800\n", "storey must be a whole number from 1 to 199"),
    ],
)
def test_tables_of_walls_lose_nothing(tmp_path, rows, said):
    (tmp_path / "walls.csv").write_text(HEADS + rows)
    with pytest.raises(InputError, match=said):
        building_in(read_sheet(tmp_path / "walls.csv"))


def test_no_line_of_a_picture_looks_like_a_sign():
    """The ground is as long as its wall: beyond, it would cross the numbers beside it."""
    axes = rk.building(house()).plot().axes[0]
    assert max(max(line.get_xdata()) for line in axes.lines) <= WALL["length"]
    places = sorted(text.get_position()[1] for text in axes.texts if text.get_position()[0] > WALL["length"])
    assert all(b - a > 0.04 * WALL["length"] - 1e-9 for a, b in pairwise(places))


def test_a_sheet_of_fields_has_no_table_of_files(tmp_path):
    """A table without rows cannot be laid out as PDF."""
    rk.building(house(), sheet=tmp_path / "sheet.html")
    assert "SHA-256" not in (tmp_path / "sheet.html").read_text()
