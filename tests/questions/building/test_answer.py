"""What is said of a building, and what is written: verdicts, conditions, structures, sheets, ties, tables of walls."""

import csv
import json
import re
from hashlib import sha256

import pytest
import yaml

import rocking_cli as rk
from rocking_cli.core.hung.ties import BAR_DIAMETERS
from rocking_cli.errors import DoubtWarning, InputError
from rocking_cli.questions.building.view import words
from rocking_cli.studies.conclusion import Concluded
from tests.cli.test_cli import run
from tests.conftest import EXAMPLES

SITE = EXAMPLES / "verify" / "site.yaml"
HOUSE = {
    "name": "house",
    "levels": [0.0, 3.0, 6.0],
    "masonry": {"density": 1800.0, "compression": 1.5e6, "shear": 5e4, "gamma": 1.0, "source": "a test"},
    "walls": [
        {"name": "long", "length": 6.0, "thickness": 0.5},
        {"name": "short", "length": 4.0, "thickness": 0.4, "storeys": [1, 1]},
    ],
    "floors": [{"name": "floor", "level": 1, "load": 400.0, "span": 4.0, "walls": ["long", "short"], "seat": 0.2}],
    "parapets": [{"wall": "short", "height": 1.0, "thickness": 0.3}],
    "rebound": 0.3,
}
TIES = {
    "ties": [{
        "level": 2, "below": 0.2, "walls": ["long"], "length": 5.0, "bars": 1, "diameter": 0.012,
        "steel": "S235", "gamma": 1.0,
        "plate": {"width": 0.3, "height": 0.3, "thickness": 0.03, "gamma": 1.0},
    }]
}  # fmt: skip


@pytest.fixture(scope="module")
def answer():
    return rk.building(HOUSE, site=SITE)


def test_the_worst_comes_first_and_concludes(answer):
    ratios = [row.ratio for row in answer.rows if row.conclusion.concluded is Concluded.NOT_SATISFIED]
    assert ratios == sorted(ratios) and answer.governs is answer.rows[0]
    assert answer.conclusion.concluded is Concluded.NOT_SATISFIED
    assert f"zeta_E = {answer.governs.ratio:.3g}" in answer.sentences[0]
    counted = [
        int(count) for count in re.findall(r"(\d+) (?:not )?satisfied", answer.sentences[0].split("Mechanisms:")[1])
    ]
    assert sum(counted) == len(answer.rows)


def test_each_condition_of_a_mechanism_is_said_once(answer):
    keys = {limit.key for row in answer.rows for limit in row.conclusion.limits if limit.effect != "replaces"}
    assert len([each for each in answer.sentences if each.startswith("Condition: ")]) == len(keys) > 0


def test_what_cannot_be_verified_and_may_govern_leaves_the_building_unchecked():
    stout = {"levels": [0.0, 3.0, 6.0], "masonry": {"density": 1800.0},
             "walls": [{"name": "stout", "length": 6.0, "thickness": [2.0, 1.8]}],
             "roof": {"load": 100.0, "span": 2.0, "walls": ["stout"], "seat": 0.5}}  # fmt: skip
    answer = rk.building(stout, site=SITE)
    assert all(row.conclusion.concluded in (Concluded.SATISFIED, Concluded.SATISFIED_IF) for row in answer.rows)
    (left,) = [each for each in answer.left_out if each.open]
    assert (
        words("en")(left.title) == "stout: bends between 0 and 6 m"
        and answer.conclusion.concluded is Concluded.NOT_CHECKED
    )
    assert "not complete" in answer.sentences[0] and any(
        "may govern: stout: bends" in each for each in answer.sentences
    )
    assert next(each for each in answer.to_dict()["left_out"] if each["open"])["why"].startswith(
        "its thickness changes"
    )


def test_the_period_of_the_building_is_said_with_its_numbers(answer):
    (said,) = [each for each in answer.sentences if "T1 = " in each]
    period = 0.05 * 6.0**0.75
    assert f"T1 = {1.75 * period:.3g} s" in said and answer.period == pytest.approx(period)
    floor = answer.rows[0].verification.deciding  # shaken above the ground
    assert floor and "as given" in " ".join(rk.building(HOUSE | {"T1": 0.2}, site=SITE).sentences)


@pytest.mark.rest
def test_each_structure_is_a_file_that_is_verified_alike(answer, tmp_path):
    rk.building(HOUSE, site=SITE, structures=tmp_path / "all")
    rows = [*csv.DictReader((tmp_path / "all" / "mechanisms.csv").read_text("utf-8").splitlines())]
    assert len(rows) == len(answer.rows)
    for row, each in zip(rows, answer.rows, strict=True):
        alone = rk.verify(tmp_path / "all" / row["file"], tmp_path / "all" / row["site"])
        assert alone.conclusion.ratio == pytest.approx(each.ratio, rel=1e-12)
    surveyed = rk.survey(tmp_path / "all" / "mechanisms.csv")
    assert not surveyed.bad
    assert sorted(row.ratio for row in surveyed.rows) == pytest.approx(
        sorted(row.ratio for row in answer.rows), rel=1e-9
    )


@pytest.mark.rest
def test_the_least_bars_are_the_first_that_suffice():
    weak = HOUSE | TIES | {"roof": {"load": 300.0, "span": 5.0, "walls": ["long"], "seat": 0.2, "thrust": 1500.0}}
    answer = rk.building(weak, site=SITE, design=2)
    (table,) = [answer.to_dict()["designed"]]
    assert [each["diameter"] for each in table["tried"]] == [*BAR_DIAMETERS[: len(table["tried"])]]
    assert [each["satisfied"] for each in table["tried"]] == [False] * (len(table["tried"]) - 1) + [True]
    assert len(table["tried"]) > 1
    for each in table["tried"][-2:]:
        ties = [{**TIES["ties"][0], "diameter": each["diameter"]}]
        rows = [row for row in rk.building(weak | {"ties": ties}, site=SITE).rows if "ties" in row.made.fields]
        assert min(row.ratio for row in rows) == pytest.approx(each["ratio"], rel=1e-9)
    with pytest.raises(InputError, match="level 1 has no ties"):
        rk.building(weak, site=SITE, design=1)


def test_a_strengthened_building_stands_beside_the_existing_one(answer):
    answer = rk.building(HOUSE, site=SITE, strengthened=HOUSE | TIES)
    before = min(row.ratio for row in answer.rows if (row.made.wall, row.made.kind) == ("long", "overturning"))
    after = min(
        row.ratio for row in answer.strengthened.rows if (row.made.wall, row.made.kind) == ("long", "overturning")
    )
    assert after > before
    (table,) = [part for part in answer.view.parts if not isinstance(part, str) and part.title.startswith("Least")]
    (cells,) = [row for row in table.rows if row[:2] == ["long", "overturning"]]
    assert [float(cell) for cell in cells[2:]] == pytest.approx([before, after], rel=1e-3)


def test_an_improvement_is_judged_by_the_worst_mechanism_before():
    site = yaml.safe_load(SITE.read_text("utf-8")) | {"intervention": "improvement", "class": "II"}
    site.pop("CU")
    answer = rk.building(HOUSE, site=site, strengthened=HOUSE | TIES)
    required = [row.conclusion.required for row in answer.strengthened.rows]
    assert required == pytest.approx([answer.governs.ratio + 0.1] * len(required))


def test_the_worst_are_followed_under_records():
    record = EXAMPLES / "accel.csv"
    answer = rk.building(HOUSE, record, site=SITE, worst=2)
    assert len(answer.shaken) == 2 and any("By time histories" in each for each in answer.sentences)
    free = {key: value for key, value in HOUSE.items() if key != "rebound"}
    leaning = free | {"walls": [HOUSE["walls"][0] | {"thickness": [0.5, 0.4]}], "floors": [], "parapets": []}
    with pytest.raises(InputError, match="give `rebound` in the building"):
        rk.building(leaning, record, site=SITE)


@pytest.mark.rest
def test_outcomes_of_records_that_count_are_said():
    """Of the worse direction, as the requirement of the mechanism has it; one record is too few, and has none."""
    answer = rk.building(HOUSE, site=SITE, worst=1, sets={"SLV": EXAMPLES / "verify" / "slv.yaml"})
    (row,) = [each for each in answer.rows if each.made.name in answer.shaken]
    least = min(
        (each for side in row.verification.directions.values() for each in side.checks if each.motions),
        key=lambda each: each.ratio,
    )
    ratio = f"SLV with {len(least.motions)} records has the ratio {least.ratio:.3g}, satisfied"
    assert least.concluded == "satisfied" and any(ratio in each for each in answer.sentences)


@pytest.mark.rest
def test_an_outcome_that_is_unknown_is_no_pass():
    """Ties of steel yield under strong motions, and what comes then is not known."""
    tie = {"level": 1, "walls": ["w"], "length": 6.0, "bars": 2, "diameter": 0.014, "steel": "S235", "gamma": 1.15}
    tied = {"levels": [0.0, 6.0], "masonry": {"density": 1800.0}, "rebound": 0.3,
            "walls": [{"name": "w", "length": 8.0, "thickness": 0.5}], "ties": [tie]}  # fmt: skip
    answer = rk.building(tied, site=SITE, sets={"SLV": EXAMPLES / "verify" / "slv.yaml"}, scale=4, worst=1)
    assert answer.rows[0].conclusion.concluded == answer.conclusion.concluded == "unknown"
    told = " ".join(answer.sentences)
    assert "w: overturns about 0 m: SLV with 7 records is unknown" in told and "as an outcome is unknown" in told


def test_without_any_rocking_no_ratio_of_histories_is_said():
    answer = rk.building(HOUSE, site=SITE, worst=1, scale=0.01, sets={"SLV": EXAMPLES / "verify" / "slv.yaml"})
    (said,) = [each for each in answer.sentences if each.startswith("By time histories")]
    assert said.endswith("SLV with 7 records is satisfied.")


def test_the_period_of_a_floor_counts_before_that_of_the_building():
    site = yaml.safe_load(SITE.read_text("utf-8")) | {"floor": {"z": 3.0, "H": 6.0, "T1": 0.4, "xi1": 0.05, "n": 2}}
    with pytest.warns(DoubtWarning, match="T1 of the building is not used"):
        beside = rk.building(HOUSE | {"T1": 0.1}, site=site)
    alone = rk.building(HOUSE, site=site)
    assert [row.ratio for row in beside.rows] == [row.ratio for row in alone.rows]
    assert alone.to_dict()["T1"] is None and rk.building(HOUSE | {"T1": 0.1}, site=SITE).to_dict()["T1"] == 0.1


def test_a_drawing_has_the_language_of_its_building(tmp_path):
    file = tmp_path / "house.yaml"
    file.write_text(json.dumps(HOUSE | {"language": "it"}), "utf-8")
    titles = [text.get_text() for text in rk.draw(file).figure().findobj(lambda each: hasattr(each, "get_text"))]
    assert any("pareti dall'esterno" in each for each in titles)


def test_the_sheet_names_the_site_of_the_building(tmp_path):
    (tmp_path / "site.yaml").write_text(SITE.read_text("utf-8"), "utf-8")
    (tmp_path / "house.yaml").write_text(json.dumps(HOUSE | {"site": "site.yaml"}), "utf-8")
    rk.building(tmp_path / "house.yaml", sheet=tmp_path / "sheet.html")
    page = (tmp_path / "sheet.html").read_text("utf-8")
    assert all(sha256((tmp_path / name).read_bytes()).hexdigest() in page for name in ("site.yaml", "house.yaml"))


@pytest.mark.rest
@pytest.mark.parametrize("language", ["en", "it"])
def test_the_sheet_has_at_most_six_pages(language, tmp_path):
    typst = pytest.importorskip("typst", reason="a PDF without a browser needs typst")
    pages, compiled = [], typst.compile

    def counted(*given, **more):
        pages.append(len(compiled(*given, **{**more, "format": "png", "ppi": 10})))
        return compiled(*given, **more)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(typst, "compile", counted)
        rk.building(EXAMPLES / "building" / "tied_house.yaml", sheet=tmp_path / "house.pdf", language=language)
    assert pages[0] <= 6


def test_the_sheet_shows_the_worst_of_each_kind_and_workings_on_demand(answer, tmp_path):
    rk.building(HOUSE, site=SITE, sheet=tmp_path / "a.html", author="A. Rossi")
    rk.building(HOUSE, site=SITE, sheet=tmp_path / "b.html", appendix=True)
    page, longer = ((tmp_path / name).read_text("utf-8") for name in ("a.html", "b.html"))
    kinds = list(dict.fromkeys(row.made.kind for row in answer.rows))
    assert len({*re.findall('id="(mechanism-[0-9]+)"', page)}) == len(kinds[:4]) and "A. Rossi" in page
    assert "Appendix 1" not in page and "Appendix 1" in longer and len(longer) > len(page)


def test_texts_of_both_languages_have_the_same_keys_and_slots():
    english, italian = (words(key).own for key in ("en", "it"))
    for key, text in english.items():
        slots = [set(re.findall(r"{(\w+)", each)) for each in (text, italian[key])]
        assert slots[0] == slots[1], key
    assert {key for key in italian if not key.startswith("shown ")} == {*english} | {"the site"} & {*italian}


def test_an_italian_answer_is_italian(answer):
    spoken = rk.building(HOUSE, site=SITE, language="it")
    assert spoken.to_dict()["mechanisms"][0]["ratio"] == answer.rows[0].ratio
    text = " ".join(spoken.sentences)
    assert "la verifica non è soddisfatta" in text and "ribalta" in text and " overturns " not in text


def test_walls_of_a_table_are_a_building(tmp_path):
    (tmp_path / "w.csv").write_text(
        "nome;piano;spessore [cm];altezza;lunghezza;porta [kN/m2];luce\n"
        "nord;1;60;3,4;10;4,5;5\nnord;2;50;3,2;10;2,5;5\nest;1;50;3,4;8;;\n", "utf-8")  # fmt: skip
    made = yaml.safe_load(run("new", "building", "--walls", str(tmp_path / "w.csv")).stdout)
    assert made["levels"] == [0.0, 3.4, 6.6] and made["walls"][0]["thickness"] == pytest.approx([0.6, 0.5])
    assert made["walls"][1] == {"name": "est", "length": 8.0, "thickness": 0.5, "storeys": [1, 1]}
    assert [(each["level"], each["walls"]) for each in made["floors"]] == [(1, ["nord"]), (2, ["nord"])]
    assert made["floors"][0]["load"] == pytest.approx(4500 / 9.80665)
    direct = rk.building(tmp_path / "w.csv", site=SITE)
    assert direct.rows[0].ratio == rk.building(made, site=SITE).rows[0].ratio


@pytest.mark.parametrize(
    ("table", "why"),
    [
        ("name,storey,thickness,height,length\na,1,0.5,3,5\na,1,0.5,3,5\n", "a has storey 1 twice"),
        ("name,storey,thickness,height,length\na,1,0.5,3,5\na,3,0.5,3,5\n", "the building has no storey 2"),
        ("name,storey,thickness,height,length\na,1,0.5,3,5\na,2,0.5,3,6\n", "a has two lengths"),
        ("name,storey,thickness,height,length\na,1,0.5,3,5\nb,1,0.5,3.3,5\n", "is 3.3 m, but storey 1 is 3 m high"),
        ("name,storey,thickness,height,length\na,1.5,0.5,3,5\n", "must be a whole number"),
        ("name,storey,thickness,height,length\na,1,thick,3,5\n", "thickness"),
        ("name,storey,thickness,height,length\na,1,-0.5,3,5\n", "w.csv:2: thickness must be above 0, got -0.5"),
        ("name,storey,thickness,height,length,bears,span\na,1,0.5,3,5,0,4\n", "bears must be above 0, got 0"),
        ("name,storey,thickness,height\na,1,0.5,3\n", "has no column length"),
        ("name,storey,thickness,height,length,colour\na,1,0.5,3,5,red\n", "colour is not a column"),
        ("name,storey,thickness,height,length,bears\na,1,0.5,3,5,4 kN/m2\n", "span: is missing|span is missing"),
    ],
)
def test_a_table_of_walls_that_contradicts_itself_is_refused(table, why, tmp_path):
    (tmp_path / "w.csv").write_text(table, "utf-8")
    with pytest.raises(InputError, match=why):
        rk.building(tmp_path / "w.csv", site=SITE)


def test_a_building_is_drawn_and_no_structure(tmp_path):
    file = tmp_path / "house.yaml"
    file.write_text(json.dumps(HOUSE), "utf-8")
    drawn = rk.draw(file)
    assert len(drawn.figure().axes) == 4 and "  long: 6 m long" in drawn.sentences
    with pytest.raises(InputError, match="has no effect on a building"):
        rk.draw(file, at=0.5)
    with pytest.raises(InputError, match="`rocking building` takes it"):
        rk.equiv(file)
    with pytest.raises(InputError, match="this command takes a building"):
        rk.building(EXAMPLES / "block.yaml", site=SITE)
    with pytest.raises(InputError, match="verified at a site"):
        rk.building(file)


def test_processes_find_what_one_finds(answer):
    shared = rk.building(HOUSE | {"walls": [*HOUSE["walls"], {"name": "w3", "length": 3.0, "thickness": 0.3},
                                            {"name": "w4", "length": 3.0, "thickness": 0.3}]},
                         site=SITE, in_processes=True, jobs=2)  # fmt: skip
    alone = {row.made.name: row.ratio for row in shared.rows}
    assert all(alone[row.made.name] == row.ratio for row in answer.rows)
