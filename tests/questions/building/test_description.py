"""What a file of a building may say: every fault is named with its file, line, field, and what would do."""

import copy
import re
from pathlib import Path

import numpy as np
import pytest
import yaml

from rocking_cli.ask.inputs import site_of
from rocking_cli.errors import InputError, RockingError
from rocking_cli.io.yaml_file import parse
from rocking_cli.questions.building.description import building_of, read_building
from rocking_cli.questions.building.study import NoMechanism, assess
from tests.conftest import EXAMPLES

SITE = EXAMPLES / "verify" / "site.yaml"
HOUSE = """\
name: house
levels: [0, 3.4, 6.6]
masonry: {density: 1800, compression: 1.5e6, shear: 5e4}
interlock: {course: 0.2, overlap: 0.15}
walls:
  - name: front
    length: 10
    thickness: [0.6, 0.5]
    sides: [side]
    connection: interlock
    openings:
      - {storey: 1, x: 1, z: 0, width: 1.2, height: 2.2}
  - {name: side, length: 8, thickness: 0.5, sides: [front]}
floors:
  - {name: deck, level: 1, load: 450, span: 5, walls: [front]}
roof: {load: 250, span: 5, walls: [front]}
ties:
  - {level: 2, walls: [front], length: 8, bars: 2, diameter: 20 mm, steel: S235}
gables:
  - {wall: side, height: 2.5}
corners:
  - {walls: [front, side]}
"""


def refused(text, name="house.yaml"):
    """The problems of a file, as they are printed."""
    with pytest.raises(InputError) as error:
        building_of(parse(text, name, "building", "a hint"))
    return [str(each) for each in error.value.problems]


class TestFaults:
    @pytest.mark.parametrize(
        ("was", "now", "said"),
        [
            ("[0.6, 0.5]", "0.5\n    storeys: [2, 2]",
             "9:14: walls[1].storeys begins at storey 2, with nothing below: name what carries it"),
            ("deck, level: 1", "deck, level: 3", "15:25: floors[1].level must be from 1 to 2, got 3"),
            ("span: 5, walls: [front]}\nroof", "span: 5, walls: [fronte]}\nroof",
             "15:56: floors[1].walls[1]: there is no wall called fronte: did you mean front?"),
            ("span: 5, walls: [front]}\nroof", "span: 5, walls: []}\nroof",
             "15:55: floors[1].walls must have at least 1 entry"),
            ("span: 5, walls: [front]}\nroof", "span: 5}\nroof", "floors[1].walls is missing: the walls that bear it"),
            ("5, walls: [front]}\nties", "5, walls: [nord]}\nties",
             "16:36: roof.walls[1]: there is no wall called nord: known: front, side"),
            ("width: 1.2", "width: 12", "12:9: walls[1].openings[1] ends 13 m from the left end of a wall 10 m long"),
            ("height: 2.2", "height: 4", "12:9: walls[1].openings[1] ends 4 m above the floor of a storey 3.4 m high"),
            ("storey: 1,", "storey: 3,", "12:18: walls[1].openings[1].storey is 3, but the wall has storeys 1 to 2"),
            ("height: 2.2}", "height: 2.2}\n      - {storey: 1, x: 2, z: 1, width: 1, height: 2}",
             "13:9: walls[1].openings[2]: overlaps another opening"),
            ("walls: [front], length", "length", "18:5: ties[1].walls is missing: the walls that they hold"),
            ("walls: [front], length", "walls: [rear], length",
             "18:24: ties[1].walls[1]: there is no wall called rear"),
            ("level: 2, walls", "level: 2, below: 5, walls",
             "18:23: ties[1].below is more than the height of the storey"),
            ("[0, 3.4, 6.6]", "[0, 3.4, 3.4]",
             "2:18: levels[3] is at 3.4 m, not above level 1 at 3.4 m: storeys overlap"),
            ("[0, 3.4, 6.6]", "[0, 340, 660]",
             "2:13: levels[2] makes storey 1 340 m high: did you mean 340 cm? if it is meant, add `unusual: [levels]`"),
            ("[0, 3.4, 6.6]", "[0]", "2:9: levels must have at least 2 entries, has 1"),
            ("  - {wall: side, height", "  - {height", "20:5: gables[1].wall is missing: the wall on which it stands"),
            ("  - {wall: side, height", "  - {wall: sud, height",
             "20:12: gables[1].wall: there is no wall below called sud"),
            ("name: side, length", "name: front, length",
             "walls has 2 walls called front: give each a name of its own"),
            ("[0.6, 0.5]", "[0.6, 0.5]\n    leaves: 2",
             "9:13: walls[1].leaves: a cavity wall is two walls that move apart"),
            ("[0.6, 0.5]", "60",
             "8:16: walls[1].thickness is 60 m: did you mean 60 cm? if it is meant, add `unusual: [thickness]`"),
            ("[0.6, 0.5]", "[0.6, 0.5, 0.4]",
             "8:16: walls[1].thickness has 3 values for 2 storeys: give one for each, or one for all"),
            ("[0.6, 0.5]", "[0.6]", "walls[1].thickness has 1 values for 2 storeys"),
            ("interlock: {course: 0.2, overlap: 0.15}\n", "",
             "walls[1].connection needs `interlock` of the building: height of courses"),
            ("sides: [side]\n    connection", "connection",
             "walls[1].connection: interlocks with no wall: name the walls at its ends in `sides`"),
            ("connection: interlock\n    openings", "connection: ties\n    openings", None),
            ("walls: [front], length: 8, bars", "walls: [side], length: 8, bars", None),
            ("sides: [front]}", "sides: [front], connection: ties}",
             "connection is by ties, but no tie of the file is on this wall: add it to the `walls` of a tie"),
            ("connection: interlock\n", "connection: interlok\n",
             "10:17: walls[1].connection must be none, interlock or ties"),
            ("sides: [side]", "sides: [side, side]",
             "9:19: walls[1].sides[2] is side again: name each wall that it meets once"),
            ("sides: [side]", "sides: [front]",
             "9:13: walls[1].sides[1]: there is no other wall called front: known: side"),
            ("walls: [front, side]", "walls: [front, front]",
             "22:21: corners[1].walls[2] is front again: a corner is of two walls"),
            ("course: 0.2", "course: 20",
             "4:21: interlock.course is 20 m, more than blocks of masonry have, 1 m: did you mean 20 cm?"),
            ("overlap: 0.15", "overlap: 0.15, angle: 60", "4:48: interlock.angle must be from 0 to 36.87 degrees"),
            ("steel: S235", "steel: S235, yield: 235 MPa", "give the steel, or its stress as `yield`: one of the two"),
            (", compression: 1.5e6, shear: 5e4}", "}\nrebound: 0.2", None),
            ("length: 10\n", "lenght: 10\n", "7:5: walls[1].lenght is not a field of walls[1]"),
            ("floors:", "floor:", "14:1: floor is not a field of the building"),
            ("levels: [", "storeys: [", "2:1: storeys is not a field of the building"),
            ("length: 10\n", "length: 10 kg\n", "7:13: walls[1].length: 10 kg is a mass, not a length"),
            ("sides: [front]}", "sides: [front", "not YAML"),
            ("name: house", "mechanism: block", "1:1: mechanism is of a structure, and this command takes a building"),
        ],
    )  # fmt: skip
    def test_it_is_said_with_its_place(self, was, now, said):
        assert was in HOUSE
        text = HOUSE.replace(was, now, 1)
        if said is None:  # what is allowed beside it
            building_of(parse(text, "house.yaml", "building", "a hint"))
            return
        problems = refused(text)
        assert any(each.startswith("house.yaml:") and said in each for each in problems), problems

    @pytest.mark.parametrize(
        ("was", "now", "hint"),
        [("length: 10\n", "lenght: 10\n", "did you mean length?"), ("floors:", "floor:", "did you mean floors?"),
         ("levels: [", "storeys: [", "did you mean levels?"), ("interlock\n", "interlok\n", "did you mean interlock?"),
         ("length: 10\n", "length: 10 kg\n", "units: m, mm, cm")],
    )  # fmt: skip
    def test_what_would_do_is_a_hint(self, was, now, hint):
        with pytest.raises(InputError) as error:
            building_of(parse(HOUSE.replace(was, now, 1), "house.yaml", "building", "a hint"))
        assert any(hint in (each.hint or "") for each in error.value.problems)

    def test_all_are_listed(self):
        text = HOUSE.replace("level: 1,", "level: 3,").replace("[0.6, 0.5]", "[0.6]").replace("wall: side", "wall: sud")
        text = text.replace("walls: [front, side]", "walls: [front, nord]").replace("width: 1.2", "width: 12")
        problems = refused(text)
        for said in ("level must be", "has 1 values", "called sud", "called nord"):
            assert any(said in each for each in problems), said
        lines = [int(re.match(r"house\.yaml:(\d+)", each)[1]) for each in problems]
        assert lines == sorted(lines)

    def test_plates_need_strengths(self):
        text = HOUSE.replace("steel: S235", "steel: S235, plate: {width: 0.3, height: 0.3}, below: 0.2")
        building_of(parse(text, "house.yaml", "building", "a hint"))
        (problem,) = refused(text.replace(", compression: 1.5e6", ""))
        assert "ties[1].plate: bears on masonry: give `compression` and `shear`" in problem

    @pytest.mark.parametrize(
        ("was", "now"),
        [("[0, 3.4, 6.6]", "[0, 14, 28]\nunusual: [levels]"), ("[0.6, 0.5]", "4"), ("[0, 3.4", "[0, 1.5")],
    )
    def test_unusual_numbers_may_be_meant(self, was, now):
        text = HOUSE.replace(was, now).replace("height: 2.2", "height: 1.2")
        if "unusual" not in now:
            problems = refused(text)
            (field,) = set(re.findall(r"add `unusual: \[(\w+)\]`", "".join(problems)))
            text += f"unusual: [{field}]\n"
        building_of(parse(text, "house.yaml", "building", "a hint"))


class TestFiles:
    def test_units(self):
        text = HOUSE.replace("[0, 3.4, 6.6]", "[0 m, 340 cm, 660 cm]").replace("load: 450", "load: 4.413 kN/m2")
        house = building_of(parse(text, "house.yaml", "building", "a hint"))
        assert house.levels == pytest.approx([0, 3.4, 6.6])
        assert house.floors[0].load == pytest.approx(450, rel=1e-4)

    def test_a_file_in_italian_is_the_same_building(self):
        italian = {
            "name": "nome", "levels": "livelli", "masonry": "muratura", "density": "densità", "compression":
            "compressione", "shear": "taglio", "interlock": "ammorsamento", "course": "corso", "overlap":
            "sovrapposizione", "walls": "pareti", "length": "lunghezza", "thickness": "spessori", "sides": "ai_lati",
            "connection": "collegamento", "openings": "aperture", "storey": "piano", "width": "larghezza", "height":
            "altezza", "floors": "solai", "level": "livello", "load": "carico", "span": "luce", "roof": "tetto",
            "ties": "catene", "bars": "barre", "diameter": "diametro", "steel": "acciaio", "gables": "timpani", "wall":
            "parete", "corners": "cantonali",
        }  # fmt: skip
        text = re.sub(r"\b(\w+):", lambda each: italian.get(each[1], each[1]) + ":", HOUSE)
        text = text.replace("collegamento: interlock", "collegamento: ammorsamento")
        assert not re.search(r"\b(walls|height|load):", text)
        read = building_of(parse(text, "casa.yaml", "building", "a hint"))
        assert read == building_of(parse(HOUSE, "house.yaml", "building", "a hint"))
        (problem, *_) = refused(text.replace("lunghezza: 10", "lunghezza: 0"), "casa.yaml")
        assert problem.startswith("casa.yaml:7:16: ")

    def test_a_field_is_given_once_in_both_languages(self):
        (problem,) = refused(HOUSE.replace("name: house", "quote: [0, 3, 6]"))
        assert "house.yaml:2:1: levels is levels, which is given too" in problem or "quote" in problem

    def test_names_are_not_translated(self):
        """A wall may be called as a field or a word is: in Italian `no` and `catene` have meanings."""
        text = HOUSE.replace("front", "catene").replace("side", "piano").replace("pianos:", "sides:")
        house = building_of(parse(text, "casa.yaml", "building", "a hint"))
        assert [each.name for each in house.walls] == ["catene", "piano"]
        assert house.walls[0].sides == ["piano"]
        assert house.corners[0].walls == ["catene", "piano"]

    def test_a_file_that_is_not_there(self):
        with pytest.raises(InputError, match=r"nowhere\.yaml"):
            read_building(Path("nowhere.yaml"))

    @pytest.mark.parametrize("text", ["", "[]", "3", "walls", "- a\n- b\n", "{}", "name: x\n", "\0", "a: &a [*a]"])
    def test_what_is_no_building(self, text):
        assert all("bad.yaml" in each for each in refused(text, "bad.yaml"))


def places(data, at=()):
    """Yield the place of every entry of a file."""
    for key, value in data.items() if isinstance(data, dict) else enumerate(data):
        yield (*at, key)
        if isinstance(value, dict | list):
            yield from places(value, (*at, key))


MORE = """\
parapets:
  - {wall: front, height: 1.0, thickness: 0.25}
bell_gables:
  - {wall: side, height: 3, length: 2, bells: 300, bells_height: 1.5, openings: [{x: 0.5, z: 1, width: 1, height: 1}]}
unusual: [levels]
rebound: 0.3
"""
REMOVED = object()
BAD = (
    REMOVED, None, "", 0, -1, 1e9, float("nan"), float("inf"), "x", [], {}, [[]], [{}], [None], {"a": 1}, True, "3 kN",
    10**400, "front", ["front"], ["front", "front"], 2, 1.5, [1, 2, 3], {1: 2}, [[1]], "\u00e9\x07", 1e-300,
    ["x"] * 600,
)  # fmt: skip


def spoilt(place, value):
    data = copy.deepcopy(yaml.safe_load(HOUSE + MORE))
    inner = data
    for key in place[:-1]:
        inner = inner[key]
    if value is REMOVED:
        del inner[place[-1]]
    else:
        inner[place[-1]] = value
    return yaml.safe_dump(data, allow_unicode=True)


class TestHostile:
    """Every entry removed or replaced: a building, or an error that says where; never a traceback."""

    def tried(self, text):
        try:
            return building_of(parse(text, "house.yaml", "building", "a hint"))
        except InputError as error:
            assert error.problems
            assert all("house.yaml" in str(each) for each in error.problems)
            return None

    def test_some_entries(self):
        every = [(place, value) for place in places(yaml.safe_load(HOUSE + MORE)) for value in BAD]
        for k in np.random.default_rng(0).permutation(len(every))[:60]:
            self.tried(spoilt(*every[k]))

    @pytest.mark.parametrize("value", [None, "x", [], 5, True])
    def test_a_bell_gable(self, value):
        for field in ("height", "openings", "bells"):
            self.tried(spoilt(("bell_gables", 0, field), value))

    @pytest.mark.rest
    def test_many_entries(self):
        every = [(place, value) for place in places(yaml.safe_load(HOUSE + MORE)) for value in BAD]
        for each in every[::7]:
            self.tried(spoilt(*each))

    @pytest.mark.rest
    def test_what_is_read_is_assessed_or_refused(self):
        """Of files that are read in spite of a strange value, every fourth, without what takes a search of angles."""
        strange = (REMOVED, 0, 1, 2, 1e9, 1e-300, [])
        every = [(place, value) for place in places(yaml.safe_load(HOUSE)) for value in strange]
        read = [house for place, value in every if (house := self.tried(spoilt(place, value))) is not None][::4]
        assert len(read) > 3
        for house in read:
            try:
                walls = [each.model_copy(update={"connection": "none"}) for each in house.walls]
                assess(house.model_copy(update={"walls": walls, "corners": []}), site_of(SITE))
            except (RockingError, NoMechanism) as error:
                assert str(error)
