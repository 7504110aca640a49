"""A body that only slides, as the commands say it: outcome, slip, neighbours, rows of a survey, files."""

from __future__ import annotations

import csv

import pytest

import rocking_cli as rk
from tests.cli.test_cli import run, run_json

G = 9.80665
CUBE = "mechanism: block\nwidth: 1\nheight: 1\nfriction: 0.2\n"
# Half a g for .4 s, then still: the slip of the closed form.
STEP = "t,a\n" + "".join(f"{0.01 * k:.2f},0.5\n" for k in range(41))
DISTANCE = 0.15 * G * 0.16 + (0.3 * G * 0.4) ** 2 / (0.4 * G)
MOTION = ("--record", "step.csv", "--dt", "0.01", "--units", "g")


@pytest.fixture(autouse=True)
def files(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "cube.yaml").write_text(CUBE, encoding="utf-8")
    (tmp_path / "step.csv").write_text(STEP, encoding="utf-8")
    return tmp_path


def test_the_slip_is_in_the_data_and_in_the_sentence():
    found = run_json("respond", "cube.yaml", *MOTION, "--neighbours", 30)
    history = found["responses"]["nonlinear"]
    assert history["slip"] == pytest.approx({"largest": -DISTANCE, "residual": -DISTANCE, "path": DISTANCE}, rel=1e-9)
    assert (history["outcome"], history["overturned"], history["unknown"]) == ("at_rest", False, False)
    assert (found["conclusion"]["concluded"], found["conclusion"]["slip"]) == ("slides", pytest.approx(DISTANCE))
    assert history["points"]["top"]["horizontal"] == pytest.approx(DISTANCE)
    assert (found["neighbours"]["slides"], found["neighbours"]["overturned"]) == (1.0, 0.0)
    assert found["neighbours"]["slip"]["50"] == pytest.approx(DISTANCE, rel=0.05)
    assert found["agreement"] == {"linear1": None, "linear2": None}
    said = run("respond", "cube.yaml", *MOTION, "--neighbours", 30).stdout
    assert "does not overturn, but slides by up to 0.588 m to the left; at the end it is 0.588 m to the left" in said
    assert "none overturns the structure; 30 (100 %) only slide" in said


def test_the_slip_over_time_is_in_the_file(files):
    run("respond", "cube.yaml", *MOTION, "--model", "nonlinear", "--neighbours", 0, "--out", "out.csv")
    rows = list(csv.DictReader((files / "out.csv").read_text(encoding="utf-8").splitlines()))
    slips = {float(row["t [s]"]): float(row["nonlinear slip [m]"]) for row in rows}
    assert slips[0.2] == pytest.approx(-0.15 * G * 0.04, rel=1e-9)
    assert float(rows[-1]["nonlinear slip [m]"]) == pytest.approx(-DISTANCE, rel=1e-9)
    assert all(row["nonlinear top u_x [m]"] == row["nonlinear slip [m]"] for row in rows)


def test_a_row_of_a_survey_gives_its_slip(files):
    block = "{b: {polygon: [[0, 0], [1, 0], [1, 2], [0, 2]]}}"
    floor = "{floor: {polygon: [[-2, -1], [3, -1], [3, 0], [-2, 0]]}}"
    text = f"mechanism: assembly\nfriction: 0.2\nblocks: {block}\nground: {floor}\n"
    (files / "drawn.yaml").write_text(text, encoding="utf-8")
    (files / "table.csv").write_text("name,file\ncube,cube.yaml\ndrawn,drawn.yaml\n", encoding="utf-8")
    found = run_json("survey", "table.csv", *MOTION)
    assert found["bad"] == []
    assert [row["outcome"] for row in found["rows"]] == ["slides", "slides"]
    assert [row["slip"] for row in found["rows"]] == pytest.approx([DISTANCE, DISTANCE], rel=1e-9)
    assert "0 of 2 structures overturn, 2 only slide" in run("survey", "table.csv", *MOTION).stdout


def test_several_motions_are_counted():
    said = run("respond", "cube.yaml", "--pulse", "sine:0.5g:1s", "--pulse", "sine:0.1g:1s", "--neighbours", 0).stdout
    assert "slides and does not overturn under 1 of 2 motions and does not uplift under 1" in said
    assert "sine:0.5g:1s governs: the structure does not overturn and slides by up to 0.233 m" in said


def test_margins_know_that_it_stands():
    found = run_json("margin", "cube.yaml", "--pulse", "sine:0.5g:1s", "--neighbours", 20)
    (motion,) = found["motions"]
    assert set(motion["shares"]) == {0.0} and set(motion["unknown"]) == {0.0}


def test_the_picture_of_a_body_that_slides_has_its_slip_and_no_block_that_rocks():
    plinth = rk.Block(width=0.4, height=0.9, friction=0.15)
    answer = rk.respond(plinth, "sine:0.9g:1s", neighbours=0)
    assert answer["linear2"].fell  # an equivalent block cannot slide
    *_, rotation, slip = answer.figure().axes
    assert slip.get_ylabel().startswith("slip")
    (curve,) = slip.get_lines()[:1]
    assert max(abs(curve.get_ydata())) == pytest.approx(abs(answer["nonlinear"].slid.largest), rel=0.01)
    assert not any("linear, " in str(line.get_label()) for line in rotation.get_lines())
