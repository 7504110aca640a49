"""Surveys in which rows have their own site, floor and headings in Italian."""

import csv
import json
from pathlib import Path

import pytest

import rocking_cli as rk
from rocking_cli.ask.inputs import site_of
from rocking_cli.errors import InputError
from rocking_cli.questions.survey.pages import SheetFolder
from rocking_cli.structure import Structure
from rocking_cli.verification.check import verify
from tests.cli.test_cli import run, some
from tests.conftest import PROJECT

ACCEL = PROJECT / "examples" / "accel.csv"
GROUND = {"FC": 1.35, "ag": 0.2, "F0": 2.5, "TC": 0.4, "S": 1.2}
FLOOR = {"z": 6, "H": 9, "T1": 0.4, "xi1": 0.05, "n": 3}
UPSTAIRS = {**GROUND, "floor": FLOOR}
HEAD = "mechanism,name,width,height"


def text_of(site):
    return "".join(f"{key}: {json.dumps(value)}\n" for key, value in site.items())


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("ground.yaml").write_text(text_of(GROUND), encoding="utf-8")
    Path("floor.yaml").write_text(text_of(UPSTAIRS), encoding="utf-8")


def table(headings, *rows, file="t.csv"):
    Path(file).write_text("\n".join([",".join([HEAD, *headings]), *rows]) + "\n", encoding="utf-8")
    return file


def alone(floor=None, width=0.3, height=2.0):
    """Capacity over demand of a block at a site that is written out."""
    site = GROUND if floor is None else {**GROUND, "floor": {**FLOOR, **floor}}
    return verify(Structure(rk.Block(width=width, height=height)), site_of(site)).ratio


def told(*arguments, code=2):
    return " ".join(run(*arguments, code=code).stderr.split())


class TestFloors:
    @pytest.mark.parametrize(
        ("headings", "cells", "floor"),
        [
            (["z"], ["8"], {"z": 8}),
            (["z [cm]"], ["800"], {"z": 8}),
            (["z"], ["800 cm"], {"z": 8}),
            (["z"], [""], {}),
            (["z"], ["0 m"], None),
            (["z [cm]"], ["0.0"], None),
            (["quota [m]"], ["8"], {"z": 8}),
            (["floor"], ["ground"], None),
            (["piano"], ["ground"], None),
            (["floor"], ['"{z: 8 m, H: 12 m, T1: 0.8 s}"'], {"z": 8, "H": 12, "T1": 0.8}),
            (["z", "floor"], ["8", '"{T1: 0.8}"'], {"z": 8, "T1": 0.8}),
            (["floor.T1", "piano.xi1", "floor.n"], ["0.8", "3 %", "5"], {"T1": 0.8, "xi1": 0.03, "n": 5}),
            (["floor.SLD.T1", "floor.SLD.xi1"], ["0.1", "0.05"], {"SLD": {"T1": 0.1, "xi1": 0.05}}),
        ],
    )
    def test_a_row_is_verified_on_its_own_floor(self, headings, cells, floor):
        (row,) = rk.survey(table(headings, f"block,a,0.3,2,{','.join(cells)}"), site=UPSTAIRS).rows
        assert row.ratio == alone(floor) and row.z == (0.0 if floor is None else floor.get("z", 6.0))

    def test_the_floors_of_these_tests_are_told_apart(self):
        ratios = [alone(floor) for floor in (None, {}, {"z": 8}, {"T1": 0.8}, {"z": 8, "T1": 0.8})]
        assert len(set(ratios)) == len(ratios)

    def test_a_site_without_a_floor_takes_one_of_the_row_and_needs_no_more_on_the_ground(self):
        whole = '"{z: 8 m, H: 9 m, T1: 0.4, xi1: 0.05, n: 3}"'
        file = table(["floor", "z"], f"block,a,0.3,2,{whole},", "block,b,0.3,2,,0", "block,c,0.3,2,,")
        rows = {row.name: row.ratio for row in rk.survey(file, site=GROUND).rows}
        assert rows == {"a": alone({"z": 8}), "b": alone(), "c": alone()}

    @pytest.mark.parametrize(
        ("headings", "cells", "words"),
        [
            (["z"], "33", "t.csv:2: z is above the roof: got 33 m, but the building is 9 m high"),
            (["z [m]"], "33", "t.csv:2: z [m] is above the roof: got 33 m, but the building is 9 m high"),
            (["z"], "-1", "t.csv:2: z must be more than 0 m, got -1"),
            (["z"], "up", "t.csv:2: z must be a number in m, got the text 'up'"),
            (["floor"], "1", "t.csv:2: floor must be ground or fields such as {z: 6 m}, got 1 or give the height in"),
            (["piano"], "primo", "t.csv:2: piano must be ground or fields such as {z: 6 m}, got 'primo'"),
            (["floor", "z"], "ground,2", "t.csv:2: z: floor is 'ground', and holds no z"),
            (["floor"], '"{q: 3}"', "t.csv:2: floor is not a field of floor"),
        ],
    )
    def test_a_wrong_floor_is_an_error_of_its_row(self, headings, cells, words):
        file = table(headings, f"block,a,0.3,2,{cells}", f"block,b,0.3,2,{',' * (len(headings) - 1)}")
        result = some("survey", file, "--site", "floor.yaml")
        assert words in " ".join(result.stderr.split()) and "1 of 1 structure" in result.stdout

    def test_a_height_without_the_building_names_what_to_add_once(self):
        file = table(["z"], "block,a,0.3,2,6", "block,b,0.3,2,")
        words = " ".join(some("survey", file, "--site", "ground.yaml").stderr.split())
        assert "t.csv:2: z needs the building, of which ground.yaml lacks T1, xi1, H, n add `floor: {T1: ...," in words
        assert words.count("ground.yaml") == 1

    def test_floors_without_a_site_are_refused(self):
        words = told("survey", table(["z"], "block,a,0.3,2,6"))
        assert "t.csv:1: z requires a site give --site, or a column site with a site file for each row" in words

    def test_that_motions_are_the_same_on_all_floors_is_stated(self):
        words = "The motions are the same at every height z"
        file = table(["z"], "block,a,0.3,2,6", "block,b,0.3,2,3")
        given = "survey", file, "--site", "floor.yaml", "--record", ACCEL, "--neighbours", 0
        assert words in " ".join(run(*given).stdout.split())
        assert "sono gli stessi a ogni quota z" in " ".join(run(*given, "--language", "it").stdout.split())
        assert words not in run("survey", file, "--site", "floor.yaml").stdout
        file = table([], "block,a,0.3,2")
        assert words not in run(*given[:3], "ground.yaml", *given[4:]).stdout


class TestSites:
    def test_each_row_has_the_site_that_it_names(self):
        Path("data").mkdir()
        Path("data/low.yaml").write_text(text_of({**GROUND, "ag": 0.1}), encoding="utf-8")
        rows = "block,a,0.3,2,low.yaml", "block,b,0.3,2,../floor.yaml", "block,c,0.3,2,"
        file = table(["site"], *rows, file="data/t.csv")
        data = json.loads(run("survey", file, "--site", "ground.yaml", "--json").stdout)
        by_name = {row["name"]: row for row in data["rows"]}
        assert [row["name"] for row in data["rows"]] == ["b", "c", "a"] and data["ranked_by"] == "ratio"
        assert by_name["b"]["ratio"] == alone({}) and by_name["c"]["ratio"] == alone()
        assert by_name["a"]["ratio"] == pytest.approx(2 * alone(), rel=1e-9)
        where = {name: (Path(row["site"]).as_posix(), row["z"]) for name, row in by_name.items()}
        assert where == {"a": ("data/low.yaml", 0.0), "b": ("data/../floor.yaml", 6.0), "c": ("ground.yaml", 0.0)}

    def test_files_terminal_and_page_name_site_and_height_if_rows_differ(self):
        file = table(["site", "z [m]"], "block,a,0.3,2,floor.yaml,3", "block,b,0.3,2,ground.yaml,")
        shown = run("survey", file, "--out", "o.csv", "--page", "p.html", "--language", "it", "--all").stdout
        for each in (shown, Path("p.html").read_text(encoding="utf-8")):
            assert all(word in each for word in ("sito", "z [m]", "floor.yaml", "ground.yaml"))
        with Path("o.csv").open(encoding="utf-8", newline="") as stream:
            rows = {row["name"]: row for row in csv.DictReader(stream)}
        assert [(row["site"], row["z [m]"], row["given z [m]"]) for row in (rows["a"], rows["b"])] == [
            ("floor.yaml", "3", "3"), ("ground.yaml", "0", "")
        ]  # fmt: skip
        assert "given site" not in rows["a"]
        one = rk.survey(table(["site"], "block,a,0.3,2,floor.yaml", "block,b,0.4,2,floor.yaml"))
        assert not {"site", "z"} & one.to_dict()["rows"][0].keys() and "z [m]" not in one.columns()
        heights = rk.survey(table(["z"], "block,a,0.3,2,3", "block,b,0.4,2,4"), site=UPSTAIRS).to_dict()["rows"]
        assert [row["z"] for row in heights] == [3.0, 4.0] and "site" not in heights[0]

    def test_a_row_without_a_site_and_one_with_a_wrong_site_are_reported(self):
        Path("wrong.yaml").write_text("FC: 1.35\nag: 0.2\n", encoding="utf-8")
        sites = ("floor.yaml", "", "none.yaml", "wrong.yaml")
        file = table(["sito"], *(f"block,b{k},0.3,2,{site}" for k, site in enumerate(sites)))
        words = " ".join(some("survey", file).stderr.split())
        assert "t.csv:3: sito is empty fill it in, or give --site for the rows without one" in words
        assert "t.csv:4: sito: none.yaml: no such file" in words
        assert "t.csv:5: sito: wrong.yaml: 1: F0 is missing" in words
        assert [row.name for row in rk.survey(file).rows] == ["b0"]

    def test_answers_are_in_the_language_of_the_first_site(self):
        Path("it.yaml").write_text(text_of({**GROUND, "language": "it"}), encoding="utf-8")
        file = table(["site"], "block,a,0.3,2,none.yaml", "block,b,0.3,2,it.yaml")
        assert "rapporto" in some("survey", file).stdout
        assert "rapporto" not in some("survey", file, "--language", "en").stdout

    def test_a_grid_is_relative_to_the_site_on_every_floor(self):
        Path("data").mkdir()
        head = "ID,LON,LAT,ag_30,F0_30,TC_30,ag_475,F0_475,TC_475,ag_2475,F0_2475,TC_2475"
        nodes = [f"{k},{13 + k % 3 / 20},{42 + k // 3 / 20},0.6,2.4,0.3,1.6,2.4,0.3,3.1,2.4,0.3" for k in range(9)]
        Path("data/grid.csv").write_text("\n".join([head, *nodes]), encoding="utf-8")
        site = {"FC": 1.35, "soil": "A", "VN": 50, "class": "II", "longitude": 13.02, "latitude": 42.02}
        site |= {"grid": "grid.csv", "floor": FLOOR}
        Path("data/grid.yaml").write_text(text_of(site), encoding="utf-8")
        file = table(["site", "z"], "block,a,0.3,2,data/grid.yaml,8", "block,b,0.3,2,data/grid.yaml,")
        high, usual = rk.survey(file).rows
        assert (high.name, usual.name) == ("a", "b") and high.ratio < usual.ratio

    @pytest.mark.rest
    def test_processes_know_the_sites_of_rows(self):
        file = table(["site", "z"], *(f"block,b{k},0.3,2,floor.yaml,{k}" for k in range(12)))
        one = rk.survey(file, jobs=1).rows
        from rocking_cli.questions.survey.structure_table import table_of
        from rocking_cli.questions.survey.study import survey

        other = survey(table_of(file, None), processes=2).rows
        assert [(row.name, row.ratio, row.z) for row in other] == [(row.name, row.ratio, row.z) for row in one]


class TestSheets:
    def test_a_sheet_is_of_the_site_of_its_row(self):
        rows = "block,a,0.3,2,,8", "block,b,0.3,2,ground.yaml,", "block,c,0.3,2,,"
        run("survey", table(["site", "z"], *rows), "--site", "floor.yaml", "--sheets", "sh")
        Path("b.yaml").write_text("mechanism: block\nname: a\nwidth: 0.3\nheight: 2\n", encoding="utf-8")
        Path("eight.yaml").write_text(text_of({**UPSTAIRS, "floor": {**FLOOR, "z": 8}}), encoding="utf-8")
        run("verify", "b.yaml", "--site", "eight.yaml", "--sheet", "v.html")
        parts = [Path(each).read_text("utf-8").split('id="inputs"') for each in ("sh/a.html", "v.html")]
        assert parts[0][0] == parts[1][0]
        listed = {name: Path(f"sh/{name}.html").read_text("utf-8").split('id="inputs"')[1] for name in "abc"}
        assert "&#34;z&#34;: 8" in listed["a"] and "floor.yaml + t.csv, line 2" in listed["a"]
        files = {name: text.replace("--site floor.yaml", "") for name, text in listed.items()}
        assert ["floor.yaml" in files[name] for name in "abc"] == [True, False, True] and "ground.yaml" in files["b"]

    def test_sheets_need_a_site_of_some_row(self):
        file = table(["site"], "block,a,0.3,2,ground.yaml")
        run("survey", file, "--sheets", "sh")
        assert Path("sh/a.html").is_file()
        assert "--sheets requires a site to verify at: give --site" in told(
            "survey", table([], "block,a,0.3,2"), "--sheets", "sh"
        )

    @pytest.mark.parametrize("failure", [KeyboardInterrupt, InputError("no sheet")])
    def test_the_table_is_written_before_the_sheets(self, monkeypatch, failure):
        def fail(*given):
            raise failure

        monkeypatch.setattr(SheetFolder, "write", fail)
        with pytest.raises((KeyboardInterrupt, InputError)):
            rk.survey(table([], "block,a,0.3,2"), site=GROUND, out="o.csv", plot="p.png", page="p.html", sheets="sh")
        assert "block" in Path("o.csv").read_text(encoding="utf-8")
        assert Path("p.png").is_file() and Path("p.html").is_file()


class TestItalian:
    def test_headings_are_those_of_structure_files(self):
        Path("t.csv").write_text(
            "Meccanismo;Nome;Spessore [cm];Altezza;Profondità;Densità;attrito;longitudine;latitudine\n"
            "block;a;30;2,0;1;1800;0,5;13,1;42,1\nwall;b;40;4;1;1800;;;\n",
            encoding="utf-8",
        )
        rows = {row.name: row for row in rk.survey("t.csv", map="m.svg").rows}
        block = rk.survey([rk.Block(width=0.3, height=2.0, depth=1.0, density=1800.0, friction=0.5)]).rows[0]
        wall = rk.survey([rk.Wall(thickness=0.4, height=4.0, depth=1.0, density=1800.0)]).rows[0]
        assert (rows["a"].lambda_, rows["a"].any_friction) == (block.lambda_, False)
        assert rows["b"].lambda_ == wall.lambda_ and Path("m.svg").is_file()

    def test_the_first_word_alone_is_translated(self):
        """A load may be named as a field is."""
        head = "meccanismo,larghezza,altezza,profondita,densita,carichi.piano.mass,carichi.piano.at\n"
        Path("t.csv").write_text(f"{head}block,1,2,1,1800,100,0.5;2\n", encoding="utf-8")
        load = {"name": "piano", "mass": 100.0, "at": [0.5, 2.0]}
        wanted = rk.survey([rk.Block(width=1.0, height=2.0, depth=1.0, density=1800.0, loads=[load])]).rows[0]
        assert rk.survey("t.csv").rows[0].lambda_ == wanted.lambda_

    @pytest.mark.parametrize(
        ("headings", "words"),
        [
            ("mechanism,nome,name,width,height", "t.csv:1: name is the same field as nome take one of them away"),
            ("mechanism,quota,floor.z,width,height", "t.csv:1: floor.z is the same field as quota"),
            ("mechanism,name,larghezza,Width,height", "t.csv:1: Width is not a field of block"),
            ("mechanism,name,larghezza,width,height", "t.csv:1: width is the same field as larghezza"),
            ("mechanism,name,peso,width,height", "t.csv:1: peso is not a field of block its weight is given by mass"),
        ],
    )
    def test_columns_of_one_field_are_refused_with_both_names(self, headings, words):
        Path("t.csv").write_text(f"{headings}\nblock,1,1,1,1\n", encoding="utf-8")
        assert words in told("survey", "t.csv")

    def test_two_cells_for_the_thickness_of_a_row_are_refused(self):
        rows = "block,a,0.3,2,0.4", "block,b,0.3,2,", "rigid_body,c,,,1", "block,d,,2,0.3"
        words = " ".join(some("survey", table(["spessore"], *rows)).stderr.split())
        assert "t.csv:2: spessore is the same field as width leave one of the two cells empty" in words
        assert "t.csv:4: spessore is not a field of rigid_body" in words and "t.csv:5" not in words
