"""A prepared record says what was done to which file, wherever it is read; its numbers are those of the motion."""

import csv
import io
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import rocking_cli as rk
from rocking_cli.excitation.base import Doubt, Origin
from rocking_cli.excitation.records.prepared import ITEMS, write_record_csv
from rocking_cli.questions.report import study as assessment
from tests.cli.test_cli import run, run_json
from tests.conftest import EXAMPLES

ACCEL, ACROSS, BLOCK = EXAMPLES / "accel.csv", EXAMPLES / "accel_transverse.csv", EXAMPLES / "block.yaml"
STEPS = ["highpass 0.2", "baseline linear"]
ASKED = ("--highpass", "0.2", "--baseline", "linear")
SAID = "processed: highpass 0.2, baseline linear; prepared from accel.csv"


@pytest.fixture
def prepared(tmp_path):
    run("record", ACCEL, *ASKED, "--out", tmp_path / "y.csv")
    return tmp_path / "y.csv"


def written(motion):
    write_record_csv(stream := io.BytesIO(), motion)
    return stream.getvalue()


def same(one, other):
    assert (one.acceleration == other.acceleration).all() and abs(one.dt - other.dt) <= np.spacing(one.dt)
    for name in ("processing", "remarks", "origin"):
        assert getattr(one, name) == getattr(other, name)


def test_what_is_read_is_what_was_prepared(prepared):
    by_verb, again = rk.read_record(ACCEL, highpass=0.2, baseline="linear"), rk.read_record(prepared)
    same(again, by_verb)
    assert (by_verb.prepared_from, again.prepared_from) == ("", "accel.csv") and list(again.processing) == STEPS
    said = run_json("record", prepared)
    assert (said["processing"], said["prepared_from"], said["pga_g"]) == (STEPS, "accel.csv", again.pga_g)
    text = run("record", prepared).stdout
    assert "highpass 0.2" in text and "baseline linear" in text and "prepared from" in text


@pytest.mark.parametrize("command", ["respond", "margin", "spectrum"])
def test_who_uses_it_says_what_was_done(prepared, command):
    few = () if command == "spectrum" else ("--neighbours", 1)
    result = run(command, BLOCK, "--record", prepared, *few, "--json")
    assert SAID in result.stderr
    if command != "margin":
        assert f'"processing": {json.dumps(STEPS)}, "prepared_from": "accel.csv"' in result.stdout


@pytest.mark.every(2)
@pytest.mark.parametrize(("language", "words"), [("en", "was prepared from"), ("it", "è stato preparato da")])
def test_a_report_prints_it_in_both_languages(prepared, language, words, monkeypatch):
    monkeypatch.setattr(assessment, "MAP_POINTS", 3)
    run("report", BLOCK, "--record", prepared, "--neighbours", 1, "--language", language, "-o", "report.html")
    codes = [f"<code>{each}</code>" for each in ("accel.csv", *STEPS)]
    assert f"y.csv {words} {codes[0]}: {codes[1]}, {codes[2]}." in Path("report.html").read_text(encoding="utf-8")


def test_python_writes_the_same_file(prepared):
    rk.record(ACCEL, highpass=0.2, baseline="linear", out=prepared.with_name("z.csv"))
    rk.record(ACCEL, highpass=0.2, baseline="linear", out=(stream := io.BytesIO()))
    assert prepared.read_bytes() == prepared.with_name("z.csv").read_bytes() == stream.getvalue()


def test_the_scale_and_the_polarity_are_steps_too_and_the_first_file_stays_the_source(prepared):
    run("record", prepared, "--scale", "2", "--polarity", "-1", "--lowpass", "20", "--out", "again.csv")
    again = rk.read_record("again.csv")
    assert again.processing == (*STEPS, "lowpass 20", "factor -2") and again.prepared_from == "accel.csv"
    assert (again.acceleration == -2 * rk.read_record(prepared, lowpass=20).acceleration).all()


def test_two_components_and_a_vertical_one_each_say_theirs(prepared):
    for name, steps in (("east", ("--lowpass", "20")), ("up", ASKED)):
        run("record", ACROSS, *steps, "--out", f"{name}.csv")
    pair = ("--with", "east.csv", "--azimuth", "30", "--vertical", "up.csv")
    said = run("respond", BLOCK, "--record", prepared, *pair, "--neighbours", 0).stderr
    assert f"; processed: {', '.join(STEPS)}, with east.csv (lowpass 20), azimuth 30; prepared from accel.csv" in said
    assert f"; processed: {', '.join(STEPS)}; prepared from accel_transverse.csv" in said


def test_standard_output_has_the_file_and_nothing_else(prepared):
    for more in ((), ("--json",)):
        assert run("record", ACCEL, *ASKED, "--out", "-", *more).stdout == prepared.read_text(encoding="utf-8")
    assert "takes one record" in run("record", ACCEL, ACROSS, "--out", "-", code=2).stderr
    assert "ends in .csv" in run("record", ACCEL, "--out", "y.parquet", code=2).stderr


def test_doubts_and_origin_are_kept_and_names_may_be_any(tmp_path):
    path = tmp_path / "ï ☃, a;b\n.csv"
    motion = rk.GroundMotion(
        "città ☃, a;b", 0.005, np.sin(np.arange(50)), unit="m/s2", processing=("floor T1=0.4,xi=0.05,z/H=1,n=3",),
        remarks=(Doubt("clipped", 12.0, "12 in a row: clipped?"),), origin=Origin("Irpinia", "Sturno", 6.9, 32.0),
    )  # fmt: skip
    path.write_bytes(written(motion))
    same(rk.read_record(path), motion)
    assert rk.read_record(path).prepared_from == motion.name
    with pytest.raises(rk.InputError, match="a file holds one component"):
        written(replace(motion, vertical=motion))


def test_a_spreadsheet_may_save_it_with_other_signs(prepared):
    rows = list(csv.reader(prepared.read_text(encoding="utf-8").splitlines()))
    with prepared.with_name("sheet.csv").open("w", encoding="utf-8-sig", newline="") as file:
        writer = csv.writer(file, delimiter=";", lineterminator="\r\n")
        for row in rows:
            cells = [cell if cell[0] in "#ta" else cell.replace(".", ",") for cell in row]
            writer.writerow(cells + [""] * (2 - len(row)))
    same(rk.read_record(prepared.with_name("sheet.csv")), rk.read_record(prepared))


def edited(prepared, place, *lines, removed=0):
    text = prepared.read_text(encoding="utf-8").splitlines()
    text[place : place + removed] = lines
    (path := prepared.with_name("edited.csv")).write_text("\n".join(text), encoding="utf-8")
    return path


def test_what_is_cut_or_edited_is_a_record_still(prepared):
    whole = rk.read_record(prepared)
    cut = rk.read_record(edited(prepared, 605, removed=10_000))
    assert (cut.processing, cut.dt, cut.npts) == (whole.processing, whole.dt, 600)
    noted = rk.read_record(edited(prepared, 0, "# checked by the author, gain 3 m/V"))
    same(noted, whole)
    bare = rk.read_record(edited(prepared, 0, removed=4))
    assert (bare.acceleration == whole.acceleration).all() and (bare.processing, bare.prepared_from) == ((), "")


@pytest.mark.parametrize(
    ("place", "lines", "removed", "at"),
    [
        (2, ["# doen: lowpass 3"], 0, "3: this line is none of the header"),
        (2, ["# done:"], 0, "3: this line is none of the header"),
        (2, ["# from: other.csv"], 0, "1: the header of a prepared record does not name its file, or several"),
        (4, ["# magnitude: six"], 0, "5: this line is none of the header"),
        (4, ["# distance: inf"], 0, "5: this line is none of the header"),
        (4, ["# doubt: clipped many samples"], 0, "5: this line is none of the header"),
        (1, ["# highpass 0.2"], 1, "2: this line is none of the header"),
        (1, [], 1, "1: the header of a prepared record does not name its file"),
    ],
)
def test_a_header_that_is_spoilt_is_refused_at_its_line(prepared, place, lines, removed, at):
    said = run("respond", BLOCK, "--record", edited(prepared, place, *lines, removed=removed), code=2).stderr
    assert f"edited.csv:{at}" in said
    assert "none of" not in at or all(name in said for name in ITEMS)


def test_the_motion_of_a_floor_is_not_carried_to_a_floor_again():
    run("record", ACCEL, "--floor", "T1=0.45,xi=0.05,z/H=1,n=3", "--out", "floor.csv")
    asked = (EXAMPLES / "verify" / "parapet.yaml", "--site", EXAMPLES / "verify" / "roof.yaml", "--record", "floor.csv")
    assert "motions of a floor already\n  give --on-floor" in run("verify", *asked, code=2).stderr
    assert SAID.split(";")[1] in run("verify", *asked, "--on-floor").stderr
