"""What a survey writes: tables for spreadsheets of any locale with the columns that came in, maps, and sheets."""

import csv
import hashlib
import json
import re
from itertools import combinations
from math import cos, radians
from pathlib import Path

import numpy as np
import pytest
from matplotlib.text import Text
from matplotlib.transforms import Bbox

import rocking_cli as rk
from rocking_cli.ask.inputs import site_of
from rocking_cli.errors import InputError
from rocking_cli.plotting import style
from rocking_cli.questions.survey import pages as survey_sheets
from rocking_cli.questions.survey.pages import LIST_FILE, MAX_STEM_LENGTH, file_names
from rocking_cli.questions.survey.picture import METRES_PER_DEGREE, draw_map, draw_survey, scale_length
from rocking_cli.questions.survey.structure_table import coordinates
from rocking_cli.structure import Structure
from rocking_cli.verification.check import verify
from rocking_cli.views.conclusion import limit_in_words
from tests.cli.test_cli import run, some
from tests.core.test_ties_of_steel import facade

SITE = {"FC": 1.35, "ag": 0.2, "F0": 2.5, "TC": 0.4, "S": 1.2}
ITALIAN = """mechanism;name;width [mm];height;# proprietario;# quota
block;Chiesa;250;1,10;Comune, ufficio;-12,5
block;=Torre;300;1,45;"=2+3";1.200
block;Casa;300;2 m;;
"""
COMMAS = "mechanism,name,width,height,#note\nblock,a,0.5,2,1.50\nblock,b,0.3,2,\n"


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("site.yaml").write_text("".join(f"{key}: {value}\n" for key, value in SITE.items()), encoding="utf-8")
    Path("t.csv").write_text(ITALIAN, encoding="utf-8")
    Path("c.csv").write_text(COMMAS, encoding="utf-8")


def verified(mechanism):
    return verify(Structure(mechanism), site_of(SITE))


def cells(file, separator=","):
    with Path(file).open(encoding="utf-8-sig", newline="") as stream:
        return list(csv.DictReader(stream, delimiter=separator))


class TestTables:
    def test_a_table_of_another_locale_comes_back_as_it_went(self):
        run("survey", "t.csv", "--out", "o.csv", "--separator", ";", "--decimal", ",")
        first, second, third = cells("o.csv", ";")
        assert [row["name"] for row in (first, second, third)] == ["Casa", "'=Torre", "Chiesa"]
        assert first["lambda"] == "0,15" and first["height"] == "2 m"  # 0.3/2
        assert third["lambda"] == "0,227272727" and third["height"] == "1,10"  # 0.25/1.1
        assert third["# proprietario"] == "Comune, ufficio" and third["# quota"] == "-12,5"
        assert second["# proprietario"] == "'=2+3" and second["# quota"] == "1.200"  # perhaps 1200: as it stood
        assert (second["row"], second["line"], second["width [mm]"]) == ("2", "3", "300")

    def test_numbers_of_a_file_have_one_decimal_sign_whatever_that_of_the_input(self):
        run("survey", "t.csv", "--out", "o.csv")
        assert [(row["height"], row["# quota"]) for row in cells("o.csv")] == [
            ("2 m", ""), ("1.45", "1.200"), ("1.10", "-12.5")
        ]  # fmt: skip
        run("survey", "c.csv", "--out", "o.csv", "--separator", "tab", "--decimal", ",")
        assert [(row["width"], row["#note"]) for row in cells("o.csv", "\t")] == [("0,3", ""), ("0,5", "1,50")]
        printed = run("survey", "c.csv", "--out", "-", "--separator", "tab", "--decimal", ",").stdout
        assert "0,15\t0,15\tpositive" in printed

    def test_a_table_in_windows_1252_is_read_with_a_note_and_written_with_a_mark(self):
        text = "mechanism;name;width;height\nblock;Nicol\u00f2 \u00abA\u00bb;0,5;2\n"
        Path("w.csv").write_bytes(text.encode("cp1252"))
        shown = run("survey", "w.csv", "--out", "o.csv", "--separator", ";", "--decimal", ",")
        assert "w.csv is not in UTF-8: read as Windows-1252" in shown.stderr and "Nicol\u00f2" in shown.stdout
        assert Path("o.csv").read_bytes()[:3] == b"\xef\xbb\xbf"
        assert cells("o.csv", ";")[0]["name"] == "Nicol\u00f2 \u00abA\u00bb"
        run("survey", "w.csv", "--out", "p.csv")
        assert Path("p.csv").read_bytes()[:4] == b"rank"
        assert "1252" not in run("survey", "t.csv").stderr

    def test_a_kept_point_is_numbers_and_needs_quotes_among_semicolons(self):
        head = "mechanism;name;width;height;depth;density;loads.deck.mass;loads.deck.at;#more\n"
        Path("p.csv").write_text(f'{head}block;a;1;2;1;1800;100;"-0,5;1,5";-1+2\n', encoding="utf-8")
        run("survey", "p.csv", "--out", "o.csv", "--separator", ";", "--decimal", ",")
        (row,) = cells("o.csv", ";")
        assert (row["loads.deck.at"], row["#more"]) == ("-0,5;1,5", "'-1+2")
        assert rk.survey("p.csv").rows[0].lambda_ == rk.survey({
            "mechanism": ["block"], "width": [1], "height": [2], "depth": [1], "density": [1800],
            "loads.deck.mass": [100], "loads.deck.at": [[-0.5, 1.5]], "loads.deck.name": ["deck"],
        }).rows[0].lambda_  # fmt: skip
        run("survey", "p.csv", "--out", "o.csv")
        assert cells("o.csv")[0]["loads.deck.at"] == "-0.5;1.5"
        Path("q.csv").write_text(f"{head}block;a;1;2;1;1800;100;-0,5;1,5\n", encoding="utf-8")
        said = " ".join(run("survey", "q.csv", code=2).stderr.split())
        assert "must be a list, got -0.5" in said
        assert 'in a table with semicolons write the point in quotes: "-6,0;7,5"' in said

    @pytest.mark.parametrize(
        ("options", "said"),
        [
            (("--separator", ";"), "--separator writes a CSV table, and none is requested: give --out"),
            (("--decimal", ",", "--out", "o.csv"), "--decimal cannot be the separator too: give --separator ';'"),
            (("--separator", ";", "--out", "o.parquet"), "o.parquet is not one: give a name that ends in .csv"),
            (("--separator", "|", "--out", "o.csv"), "--separator must be ',', ';' or tab, got the text '|'"),
        ],
    )  # fmt: skip
    def test_signs_without_a_table_to_write_are_refused(self, options, said):
        assert said in " ".join(run("survey", "t.csv", *options, code=2).stderr.split())
        assert not Path("o.csv").exists()

    def test_every_column_is_kept_once_in_its_order_in_all_formats(self):
        parquet = pytest.importorskip("pyarrow.parquet")
        heads = ["width [mm]", "height", "# proprietario", "# quota"]
        run("survey", "t.csv", "--out", "o.csv")
        run("survey", "t.csv", "--out", "o.parquet")
        written = list(cells("o.csv")[0])
        assert written[written.index("caution") + 1 :] == heads
        stored = parquet.read_table("o.parquet").to_pydict()
        assert list(stored) == written == list(rk.survey("t.csv").columns())
        assert stored["height"] == ["2 m", "1,45", "1,10"] and stored["name"][1] == "=Torre"  # as they stood
        data = json.loads(run("survey", "t.csv", "--json").stdout)["rows"]
        assert data[2]["cells"] == {
            "mechanism": "block", "name": "Chiesa", "width [mm]": "250", "height": "1,10",
            "# proprietario": "Comune, ufficio", "# quota": "-12,5",
        }  # fmt: skip
        assert "cells" not in rk.survey([rk.Block(width=0.5, height=2.0)]).to_dict()["rows"][0]


class TestNumbersOfTheCode:
    def test_zeta_of_the_onset_by_hand(self):
        """zeta_E = a0*/(a_g S g), with a0* = (b/h) g/FC of a block, whose participating mass is all of its mass."""
        sizes = {"a": (0.05, 0.3), "b": (0.2, 0.5)}
        blocks = [rk.Block(name=name, width=b, height=h) for name, (b, h) in sizes.items()]
        answer = rk.survey(blocks, site=SITE)
        for row, data in zip(answer.rows, answer.to_dict()["rows"], strict=True):
            b, h = sizes[row.name]
            assert row.verified.method == "damage"
            assert data["zeta_E"] == pytest.approx(b / h / (1.35 * 1.2 * 0.2), rel=1e-9) == data["ratio"]
            assert data["T0"] is None
        assert list(answer.columns()["zeta_E"]) == [data["zeta_E"] for data in answer.to_dict()["rows"]]

    def test_zeta_of_displacement_is_that_of_accelerations_and_not_the_ratio(self):
        """For 0.6 m x 8 m at this site, a_g = 0.193382 by the nonlinear method, against a demand of 0.2."""
        tall = rk.Block(name="tall", width=0.6, height=8.0)
        (row,) = rk.survey([tall], site=SITE).rows
        side = verified(tall).directions[rk.Direction.POSITIVE]
        assert row.verified.method == "nonlinear"
        assert row.numbers["zeta_E"] == pytest.approx(0.193382 / 0.2, rel=1e-5)
        assert row.ratio == row.numbers["zeta_E"] != pytest.approx(side.states["SLV"].ratio, rel=1e-3)

    def test_zeta_is_of_the_limit_state_and_the_direction_that_govern(self):
        low = {"ag": 0.19, "F0": 2.5, "TC": 0.36, "S": 1.6}  # SLD demands more than SLV
        (row,) = rk.survey([rk.Block(name="b", width=0.3, height=2.0)], site={**SITE, "SLD": low, "class": "IV"}).rows
        assert row.verified.limit_state == "SLD"
        assert row.numbers["zeta_E"] == pytest.approx(0.15 / (1.35 * 1.6 * 0.19), rel=1e-9)
        leaning = rk.Block(width=0.6, height=2.0, mass=900.0, loads=[{"name": "x", "mass": 300.0, "at": [-0.2, 2.0]}])
        (row,) = rk.survey([leaning], site=SITE).rows
        assert row.verified.direction == "negative"
        other, weaker = (verified(leaning).directions[each] for each in rk.Direction)
        assert row.numbers["zeta_E"] == weaker.methods[row.verified.method].zeta
        assert row.numbers["zeta_E"] < other.methods[row.verified.method].zeta

    def test_a_row_has_the_period_of_its_own_element_and_that_of_the_site_where_it_has_none(self):
        """T0 = 6.2 (L/t) L sqrt(w/(E g)): sqrt(18000/(1.2e9 9.80665)) = 1.236759e-3."""
        element = {"kind": "cantilever", "w": 18e3, "E": 1.2e9, "L": 1.0, "t": 0.4}
        structures = [
            rk.Block(name="thin", width=0.3, height=3.0),
            rk.Wall(name="wall", thickness=0.6, height=3.0),
            rk.PointMass(name="mass", base_width=2.4, height=9.0),
            rk.load_structure(Path(__file__).parents[3] / "examples" / "frame.yaml"),
        ]
        rows = {row.name: row for row in rk.survey(structures, site={**SITE, "element": element}).rows}
        periods = [rows[each.name].numbers["T0"] for each in structures]
        by_hand = [0.230037, 0.115019, 6.2 * 9.0**2 / 0.4 * 1.236759e-3, 6.2 / 0.4 * 1.236759e-3]
        assert periods == pytest.approx(by_hand, rel=1e-5)
        (row,) = rk.survey(structures[:1], site={**SITE, "T0": 0.4}).rows
        assert row.numbers["T0"] == 0.4

    def test_what_limits_a_verification_is_the_caution_of_its_row(self):
        """Ties of constant force hold two facades until they are long; without one a third fails."""
        tied = [
            facade(stiffness=0, prestress=1e3 * force, elongation=0.5).model_copy(update={"name": f"t{force}"})
            for force in (20, 40)
        ]
        loose = rk.Block(name="loose", width=0.3, height=8.0)
        answer = rk.survey([*tied, loose], site=SITE)
        rows = {row["name"]: row for row in answer.to_dict()["rows"]}
        assert rows["loose"]["caution"] is None and rows["loose"]["concluded"] == "not_satisfied"
        for each in tied:
            end = verified(each).conclusion
            assert end.limits and rows[each.name]["concluded"] == end.concluded
            caution = rows[each.name]["caution"]
            assert all(limit_in_words(limit) in caution for limit in end.limits)
            assert caution in answer.columns()["caution"]
            assert f"Caution: {each.name}: {caution}" in answer.sentences
        assert {rows[each.name]["concluded"] for each in tied} == {"satisfied_only_if"}
        assert answer.sentences[0].startswith(
            "1 of 3 structures does not satisfy the verification; SLV governs; 2 only on conditions."
        )
        table = next(part for part in answer.view.parts if hasattr(part, "columns"))
        marks = {row[1]: row[-1] for row in table.rows}
        assert table.columns[-1] == "caution"
        assert [marks[name] for name in ("t20", "t40", "loose")] == ["yes", "yes", "-"]


def places(longitude, latitude, **more):
    count = len(longitude)
    columns = {"mechanism": ["block"] * count, "name": [f"b{k}" for k in range(count)], "height": [2.0] * count}
    return columns | {"width": [0.3 + 0.01 * k for k in range(count)], "lon": longitude, "#lat": latitude} | more


def drawn(columns):
    found = rk.survey(columns).result
    return draw_map(found, coordinates(found), "title")


def labels(axes):
    return [text.get_text() for text in axes.texts]


class TestMaps:
    def test_marks_stand_at_their_coordinates_in_the_order_of_ranks_the_first_on_top(self):
        axes = drawn(places([13.1, 13.2, 13.15], [42.1, 42.2, 42.3])).axes[0]
        marks = axes.collections[0]
        assert marks.get_offsets().tolist() == [
            pytest.approx(each) for each in ([13.15, 42.3], [13.2, 42.2], [13.1, 42.1])  # drawn last: rank 1
        ]  # fmt: skip
        assert marks.get_array().tolist() == [3, 2, 1]
        assert labels(axes)[1:] == ["1", "2", "3"]
        assert not any("not on the map" in line.get_label() for line in axes.lines)
        grey = [0.3 * r + 0.59 * g + 0.11 * b for r, g, b, _ in marks.cmap(np.linspace(0, 1, 9))]
        assert grey == sorted(grey) and grey[0] < 0.2 < 0.8 < grey[-1], "the order is visible in grey"

    def test_a_metre_is_as_long_in_both_directions(self):
        latitude = -60.0
        figure = drawn(places([10.0, 10.1], [latitude, latitude + 0.02]))
        figure.draw_without_rendering()
        axes = figure.axes[0]
        (x0, y0), (x1, y1) = axes.transData.transform([(10.0, latitude), (10.1, latitude + 0.02)])
        east, north = 6_371_008.8 * radians(0.1) * cos(radians(latitude + 0.01)), 6_371_008.8 * radians(0.02)
        assert (x1 - x0) / (y1 - y0) == pytest.approx(east / north, rel=1e-3)

    def test_the_scale_bar_is_as_long_as_it_says(self):
        """At 60 degrees north a degree of longitude is half as long as one of latitude, 111.195 km."""
        axes = drawn(places([10.0, 10.1], [59.99, 60.01])).axes[0]
        bar = next(line for line in axes.lines if line.get_linewidth() == 2.5)
        share = float(np.ptp(bar.get_xdata()))
        west, east = axes.get_xlim()
        (text,) = (each for each in labels(axes) if each.endswith("m"))
        assert text == "1 km"
        assert share * (east - west) * 0.5 * 111_195.0 == pytest.approx(1000.0, rel=1e-3)
        assert pytest.approx(111_195.08, rel=1e-6) == METRES_PER_DEGREE
        assert [scale_length(width) for width in (100, 1e3, 7e3, 20e3)] == [20, 200, 2000, 5000]

    def test_rows_without_coordinates_are_counted_and_wrong_ones_named(self):
        said = []
        columns = places(["13.1", "", "13.2", "13.3"], ["42.1", "42.2", "142", "north"])

        class Listening(rk.ask.watcher.Watcher):
            def warn(self, text):
                said.append(text)

        rk.survey(columns, map="m.svg", watch=Listening())
        assert "not on the map: 3 without coordinates" in [line.get_label() for line in drawn(columns).axes[0].lines]
        assert len(said) == 2 and "lat must be a number of degrees from -90 to 90, got '142'" in said[0]
        assert "got 'north'" in said[1] and Path("m.svg").stat().st_size > 1000

    def test_one_place_and_ranks_in_the_same_place(self):
        axes = drawn(places([13.1, 13.1, 13.1], [42.0, 42.0, 42.5])).axes[0]
        assert labels(axes)[1:] == ["1, 2", "3"]
        assert np.ptp(drawn(places([13.1], [42.0])).axes[0].get_ylim()) * 111_195 == pytest.approx(116.0, rel=1e-3)

    def test_ranks_of_a_crowd_are_apart_and_nothing_is_cut_on_a_phone(self):
        random = np.random.default_rng(3)
        longitude, latitude = random.normal([13.0, 42.0], 0.001, (40, 2)).T.tolist()
        found = rk.survey(places(longitude, latitude)).result
        with style.on_phone():
            drawn = [draw_map(found, coordinates(found), "a map " * 9), draw_survey(found, "a survey " * 9)]
        for figure in drawn:
            figure.draw_without_rendering()
            (ranks,) = ([each for each in axes.texts if each.get_text().isdigit()] for axes in figure.axes[:1])
            assert [each.get_text() for each in ranks] == [str(k + 1) for k in range(10)]
            boxes = [Text.get_window_extent(each) for each in ranks]
            assert not any(one.overlaps(other) for one, other in combinations(boxes, 2))
            assert figure.axes[0].get_position().width > 0.7, "the bar of ranks is below the map"
            tight = figure.get_tightbbox()  # inches
            assert min(tight.x0, tight.y0) > -0.01 and tight.x1 < figure.get_figwidth() + 0.01
            assert tight.y1 < figure.get_figheight() + 0.01
            for each, box in zip(ranks, boxes, strict=True):  # a rank that is not beside its mark has a line to it
                away = Bbox.from_extents(*box.extents).padded(0.1 * figure.dpi)
                beside = away.contains(*figure.axes[0].transData.transform(each.xy))
                assert beside or each.arrow_patch is not None

    def test_a_map_without_coordinates_is_refused_before_any_work(self):
        said = run("survey", "t.csv", "--map", "m.png", "--out", "o.csv", code=2).stderr
        assert "the structures have no longitude and latitude\n  --map needs columns longitude and latitude" in said
        assert not Path("o.csv").exists()
        for columns in (places([""], [""]), places([""], ["1"])):
            with pytest.raises(InputError, match="no structure has both coordinates"):
                rk.survey(columns, map="m.png")
        with pytest.raises(InputError, match="the structures have no latitude"):
            rk.survey({"mechanism": ["block"], "width": [1], "height": [2], "lon": [3]}, map="m.png")


HOSTILE = {
    "../x": "x", "a/b": "a-b", "A B": "A-B-2", "..\\..\\c:": "c", "NUL": "NUL_", "com1.txt": "com1.txt_",
    "...": "structure", ".hidden": "hidden", "Santa Lucìa, n° 3": "Santa-Lucìa-n-3", "x" * 300: "x" * MAX_STEM_LENGTH,
    "a b-2": "a-b-2-2", "\x00\n": "structure-2", "ＮＵＬ": "NUL_-2", "a.": "a",
}  # fmt: skip


class TestSheets:
    def test_names_are_safe_on_every_system_and_each_once(self):
        names = file_names([*HOSTILE], ".html")
        assert names == [f"{each}.html" for each in HOSTILE.values()]
        assert len({each.casefold() for each in names}) == len(names)
        assert all(len(each.encode()) < 255 and not set(each) & set('<>:"/\\|?*') for each in names)

    def sheet(self, *more, code=0):
        call = "survey", "s.csv", "--site", "site.yaml", "--sheets", "sh", *more
        return some(*call) if code == 5 else run(*call, code=code)

    def table(self, *names, width="0.5"):
        lines = ["mechanism,name,width,height", *(f'block,"{name}",{width},2' for name in names)]
        Path("s.csv").write_text("\n".join(lines), encoding="utf-8")

    @pytest.mark.rest
    def test_each_row_has_the_sheet_of_verify(self):
        text = "mechanism,name,width,height\nblock,../thin,0.3,2\nblock,bad,-1,2\nblock,thick,0.5,2\n"
        Path("s.csv").write_text(text)
        told = "--language", "it", "--author", "Ing. Bianchi"
        result = self.sheet(*told, code=5)
        assert "scritte 2 relazioni di calcolo e sheets.txt in" in result.stderr
        assert sorted(each.name for each in Path("sh").iterdir()) == [LIST_FILE, "thick.html", "thin.html"]
        Path("b.yaml").write_text("mechanism: block\nname: thick\nwidth: 0.5\nheight: 2\n")
        run("verify", "b.yaml", "--site", "site.yaml", "--sheet", "v.html", *told)
        one, other = (Path(each).read_text("utf-8").split('id="inputs"')[0] for each in ("sh/thick.html", "v.html"))
        assert one == other and "Ing. Bianchi" in one
        inputs = Path("sh/thick.html").read_text("utf-8").split('id="inputs"')[1]
        assert "s.csv, line 4" in inputs and "rocking survey s.csv --site site.yaml" in inputs
        assert "width: 0.5" in inputs

    @pytest.mark.rest
    def test_sheets_of_an_earlier_survey_are_replaced_and_nothing_else(self):
        self.table("a", "b", "a")
        self.sheet()
        assert {each.name for each in Path("sh").iterdir()} == {"a.html", "b.html", "a-2.html", LIST_FILE}
        first = Path("sh/a.html").read_bytes()
        self.table("a", "c", width="0.6")
        self.sheet()
        assert {each.name for each in Path("sh").iterdir()} == {"a.html", "c.html", LIST_FILE}
        assert Path("sh/a.html").read_bytes() != first
        listed = dict(line.split("  ")[::-1] for line in Path("sh", LIST_FILE).read_text().splitlines()[1:])
        written = {name: Path("sh", name).read_bytes() for name in ("a.html", "c.html")}
        assert listed == {name: hashlib.sha256(content).hexdigest() for name, content in written.items()}

    def test_a_folder_with_files_of_others_is_refused_before_any_work(self):
        self.table("a")
        self.sheet()
        for name in ("mine.txt", "a.html"):
            Path("sh", name).write_text("edited by hand", encoding="utf-8")
            before = {each.name: each.read_bytes() for each in Path("sh").iterdir()}
            said = self.sheet("--out", "o.csv", code=2).stderr
            assert f"{name}: " in said and "rocking did not write it, or not as it is now" in said
            assert {each.name: each.read_bytes() for each in Path("sh").iterdir()} == before
            assert not Path("o.csv").exists()
            Path("sh", "mine.txt").unlink(missing_ok=True)

    def test_without_what_makes_sheets_the_survey_is_printed_and_it_is_said_once(self, monkeypatch):
        self.table("a", "b")
        monkeypatch.setattr(survey_sheets.sheets, "find_spec", lambda name: None)
        monkeypatch.setattr("rocking_cli.io.browser.USUAL_PATHS", ())
        monkeypatch.setenv("PATH", "")
        result = self.sheet("--sheet-format", "pdf", code=5)
        assert result.stderr.count("pip install 'rocking-cli[pdf]'") == 1
        assert re.search("a.* satisfied", result.stdout) and not [*Path("sh").iterdir()]
        with pytest.raises(InputError, match="none is found here"):
            rk.survey("s.csv", site=SITE, sheets="sh", sheet_format="pdf")

    def test_what_has_no_sheet_is_refused(self):
        self.table("a")
        said = run("survey", "s.csv", "--sheets", "sh", code=2).stderr
        assert "--sheets requires a site to verify at: give --site" in said
        with pytest.raises(InputError, match="`language` must be en or it, got the text fr"):
            rk.survey("s.csv", site=SITE, sheets="sh", language="fr")
        with pytest.raises(InputError, match="`sheet_format` must be html, docx or pdf"):
            rk.survey("s.csv", site=SITE, sheets="sh", sheet_format="txt")
