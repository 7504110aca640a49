"""Elements that the kernel does not simulate: wherever histories are needed, they are named."""

from pathlib import Path

import pytest

import rocking_cli as rk
from rocking_cli.core import Spot
from rocking_cli.core.hung.element import Spring
from tests.cli.test_cli import run, some
from tests.following import build_model

BLOCK = "mechanism: block\nname: {}\nwidth: {}\nheight: 2.8\ndensity: 1800\ndepth: 1\n"
TIES = "ties:\n  - {name: bar, from: {ground: [0.4, 2.0]}, to: {at: [0.1, 2.0]}, stiffness: 2.0e+3}\n"
STUDY = """\
name: two blocks
structures: [tied.yaml, bare.yaml]
records: [{pulse: sine:1g:0.4s}, {pulse: sine:1g:0.5s}]
method: stripes
levels: {measure: PGA, least: 0.5, most: 0.9, count: 2}
limit_states: [0.5, overturning]
"""
FILES = {
    "tied.yaml": BLOCK.format("tied", 0.8) + TIES,
    "bare.yaml": BLOCK.format("bare", 0.7),
    "site.yaml": "FC: 1.2\nag: 0.9\nF0: 2.5\nTC: 0.5\nS: 1.2\n",
    "table.csv": "file\ntied.yaml\nbare.yaml\n",
    "alone.csv": "file\ntied.yaml\n",
    "study.yaml": STUDY,
    "alone.yaml": STUDY.replace(", bare.yaml", ""),
}
PULSE = "--pulse", "sine:0.6g:0.6s"
PLANE = "--ag", "0.3g:2g", "--period", "0.4:0.8", "--points", 3
WHY = (
    "bar of tied: its force depends on its past deformation (memory), which no time-history kernel can simulate in "
    "this structure: use an elastic element instead"
)
ASKED = {
    "respond": ["tied.yaml", *PULSE, "--model", "nonlinear", "--neighbours", 3, "--out", "history.csv"],
    "verify": ["tied.yaml", "--site", "site.yaml", *PULSE, "--sheet", "sheet.html"],
    "survey": ["alone.csv", *PULSE, "--out", "survey.csv"],
    "overturning": ["tied.yaml", "--model", "nonlinear", *PLANE, "--out", "map.csv"],
    "fragility": ["alone.yaml", "--jobs", 2],
    "equivalent_pulses": ["tied.yaml", "bare.yaml", "--ag", "2g", "--period", 0.4],
}


@pytest.fixture(autouse=True)
def _files(tmp_path):
    for name, text in FILES.items():
        (tmp_path / name).write_text(text)


@pytest.fixture
def memory(monkeypatch):
    """Ties that say that they remember, and are asked all the same what such ties usually refuse."""
    monkeypatch.setattr(Spring, "has_memory", True)
    monkeypatch.setattr(Spring, "refuses", lambda self, question: None)


@pytest.mark.parametrize("command", ASKED)
def test_a_command_names_the_element(command, memory):
    before = {each.name for each in Path().iterdir()}
    said = run(command, *ASKED[command], code=2).stderr
    (line,) = [line for line in said.splitlines() if "error" in line]
    assert line.startswith("error: ") and line.endswith(f": {WHY}") and "bar" not in said.replace(line, "")
    assert {each.name for each in Path().iterdir()} == before


def test_of_several_structures_those_are_left_out_that_no_kernel_serves(memory):
    for words in (["survey", "table.csv", *PULSE], ["fragility", "study.yaml", "--jobs", 2]):
        found = some(*words)
        assert WHY in found.stderr and "bare" in found.stdout and "tied" not in found.stdout


def test_design_says_why_no_value_could_be_tried(memory):
    words = "--neighbours", 2, "--points", 2, "--vary", "width=0.7:0.8", "--until", "overturned<1"
    assert WHY in " ".join(run("design", "tied.yaml", *PULSE, *words).stdout.split())


@pytest.mark.parametrize("ask", [rk.respond, rk.margin])
def test_python_names_the_element(ask, memory):
    with pytest.raises(rk.InputError, match=r"^(tied.yaml: )?bar of tied: its force depends on its past .*\Z"):
        ask("tied.yaml", rk.parse_pulse("sine:0.6g:0.6s").sampled())


def test_all_elements_are_named_with_what_they_need():
    class Damper(Spring):
        has_rate = True

    class Yielding(Spring):
        has_memory = True

    class Both(type(rk.load_structure("bare.yaml"))):
        def carries(self):
            spots = Spot(None, 0.4 + 2j), Spot("block", 0.1 + 2j)
            return [Yielding("fuse", spots, 1e3), Damper("dashpot", spots, 1e3)]

    with pytest.raises(rk.InputError) as error:
        build_model(Both(name="b", width=0.8, height=2.8, density=1800, depth=1), "nonlinear")
    one, other = str(error.value).splitlines()
    assert one.startswith("fuse of b: its force depends on its past deformation (memory), which no")
    assert other.startswith("dashpot of b: its force depends on its rate of deformation, which no")
