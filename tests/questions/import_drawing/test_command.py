"""`rocking import`: what it prints and writes, and what it refuses, as JSON too."""

import hashlib

import pytest
import yaml
from click.testing import CliRunner

import rocking_cli as rk
from rocking_cli.cli.main import main
from tests.meshes import box, obj


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "pillar.csv").write_text("0,0\n600,0\n600,2400\n0,2400\n")
    (tmp_path / "cross.csv").write_text("0,0\n1000,1000\n1000,0\n0,1000\n")
    (tmp_path / "box.obj").write_bytes(obj(box((0.0, 0.0, 0.0), (0.6, 0.8, 2.4))))


def run(*words):
    return CliRunner().invoke(main, ["import", *words])


def test_the_file_names_its_source_and_is_the_one_printed(tmp_path):
    printed = run("pillar.csv", "--units", "mm")
    done = run("pillar.csv", "--units", "mm", "-o", "pillar.yaml")
    assert printed.exit_code == done.exit_code == 0
    text = (tmp_path / "pillar.yaml").read_text("utf-8")
    digest = hashlib.sha256((tmp_path / "pillar.csv").read_bytes()).hexdigest()
    assert f"# From pillar.csv, SHA-256 {digest}, by `rocking import pillar.csv --units mm`" in text
    assert "no ground is drawn" in text.lower() and "600" not in yaml.safe_dump(yaml.safe_load(text))
    assert printed.stdout == text
    assert rk.load_structure("pillar.yaml").uplift(rk.Direction.POSITIVE) == 0.25


def test_a_refusal_without_json_is_an_error_of_the_terminal():
    refused = run("cross.csv", "--units", "mm")
    assert refused.exit_code == 2 and not refused.stdout
    assert "crosses itself at (500, 500)" in " ".join(refused.stderr.split())


def test_a_plot_fills_its_page_without_warnings(tmp_path, caplog):
    assert run("pillar.csv", "--units", "mm", "-o", "out.yaml", "--plot", "out.png").exit_code == 0
    figure = rk.import_drawing("pillar.csv", units="mm").plot()
    figure.canvas.draw()
    (axes,) = figure.axes
    assert not caplog.records
    assert axes.get_ylim()[0] < 0 and axes.get_ylim()[1] > 2.4 and axes.get_aspect() == 1


def test_options_of_the_other_kind_are_refused():
    assert "--settle has no effect on a drawing" in run("pillar.csv", "--units", "mm", "--settle").stderr
    assert "--scale has no effect on a mesh" in run("box.obj", "--units", "m", "--scale", "1:50").stderr


def test_the_answers_of_imports_stand_for_structures():
    drawn, scanned = rk.import_drawing("pillar.csv", units="mm"), rk.import_mesh("box.obj", units="m", density=2000)
    for answer in (drawn, scanned):
        assert rk.equiv(answer).to_dict()["directions"]["positive"]["lambda"] == pytest.approx(0.25)
