"""An existing structure and a strengthened one, verified in the same way and shown side by side."""

import hashlib
import re
from pathlib import Path

import pytest
import yaml

import rocking_cli as rk
from rocking_cli.core.registry import Registry
from rocking_cli.core.structure_file import parse_structure
from tests.cli.test_cli import run, run_json
from tests.questions.verify.test_sheet import FACADE, HAZARD, HEAVY, SITE, SLC

ROD = "ties: [{name: rod, from: {ground: [-6, 7]}, to: {at: [-0.3, 7]}, area: 3e-4, yield: 2e8}]\n"
STRONG = HEAVY.replace("name: facade", "name: strong") + ROD


@pytest.fixture
def files(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name, text in (("old", HEAVY), ("new", STRONG), ("site", SITE + SLC)):
        (tmp_path / f"{name}.yaml").write_text(text, encoding="utf-8")
    return ("verify", "old.yaml", "--strengthened", "new.yaml", "--site", "site.yaml")


def alone(name):
    return run_json("verify", f"{name}.yaml", "--site", "site.yaml")


@pytest.mark.parametrize("more", [(), ("--pulse", "sine:0.1g:0.8s")])
def test_each_is_what_it_is_alone(files, more):
    both = run_json(*files, *more)
    strengthened = both.pop("strengthened")
    for name, found in (("old", both), ("new", strengthened)):
        wanted = run_json("verify", f"{name}.yaml", "--site", "site.yaml", *more)
        for key in ("conclusion", "directions", "governs"):
            assert found[key] == wanted[key], (name, key)
    assert both["conclusion"]["concluded"] == "not_satisfied" != strengthened["conclusion"]["concluded"]


def test_the_terminal_has_both_conclusions_and_a_table(files):
    lines = run(*files).stdout
    said = " ".join(lines.split())
    assert "Existing structure: facade:" in said and "Strengthened structure: strong:" in said
    assert said.index("not satisfied") < said.index("Strengthened structure") < said.index("is satisfied")
    cells = {row[0]: row[1:] for row in (re.split(r"\s{2,}", each.strip()) for each in lines.splitlines())}
    for k, name in enumerate(("old", "new")):
        side = alone(name)["directions"]["positive"]
        assert float(cells["alpha0"][k]) == pytest.approx(side["alpha0"], rel=5e-4)
        assert float(cells["d0* [m]"][k]) == pytest.approx(side["d0_star"], rel=5e-4)
        for state, of in side["states"].items():
            assert float(cells[f"{state}: capacity d [m]"][k]) == pytest.approx(of["d"], rel=5e-4)
            assert float(cells[f"{state}: demand d [m]"][k]) == pytest.approx(of["demand"], rel=5e-4)
            assert float(cells[f"{state}: zeta_E"][k]) == pytest.approx(side["zeta"][of["governs"]], rel=5e-4)
            wanted = (of["concluded"] or "not_required").replace("only_if", "on_conditions").replace("_", " ")
            assert cells[f"{state}: verification"][k] == wanted
        assert float(cells["SLD: zeta_E, onset of rocking"][k]) == pytest.approx(side["zeta"]["SLD"], rel=5e-4)
    full = run(*files, "--all").stdout
    assert full.count("capacity, on the exact curve") == 2 and "Positive direction, strengthened: " in full


@pytest.mark.parametrize("language", ["en", "it"])
def test_the_sheet_has_both_files_and_workings(files, language):
    run(*files, "--sheet", "s.html", "--language", language)
    page = Path("s.html").read_text(encoding="utf-8")
    for name, text in (("old", HEAVY), ("new", STRONG)):
        assert hashlib.sha256(text.encode()).hexdigest() in page and f"{name}.yaml" in page
    keys = re.findall(r'<section id="([^"]+)"', page)
    assert len({*keys}) == len(keys)
    found = run_json(*files)
    for of, data in (("existing", found), ("strengthened", found["strengthened"])):
        state = data["conclusion"]["limit_state"]  # that which decides, alone
        method = {"SLD": "SLD", "SLV": "nonlinear"}.get(state, f"nonlinear_{state}")
        for key in ("chain", "curve", method):
            assert f"{of}-positive-{key}" in keys
        states = {each for each in ("SLV", "SLC") if f"{of}-positive-{each}" in keys}
        assert states == {state} - {"SLD"}
        assert not [each for each in keys if each.startswith(of) and each.endswith(("-line", "-linear"))]
    wanted = {"en": ("Existing structure: facade", "Strengthened structure: strong", "not satisfied"),
              "it": ("Stato di fatto: facade", "Stato di progetto: strong", "non soddisfatta")}[language]  # fmt: skip
    assert all(each in page for each in wanted)


def test_the_name_stands_apart_from_its_state_in_italian(files):
    said = run(*files, "--language", "it").stdout
    assert "Stato di fatto: facade" in said and "Stato di progetto: strong" in said


def test_in_python_and_as_a_frame():
    old, new = (parse_structure(text, "s.yaml", "test", Registry()) for text in (FACADE, FACADE + "mass: 1000\n"))
    answer = rk.verify(old, yaml.safe_load(HAZARD), strengthened=new)
    assert answer.strengthened.mechanism.mass == 1000
    frame = answer.to_frame()
    assert list(frame["structure"]) == ["existing"] * (len(frame) // 2) + ["strengthened"] * (len(frame) // 2)
    assert rk.verify(old, yaml.safe_load(HAZARD)).strengthened is None
    assert answer.plot() is not None


def test_each_conclusion_stands_above_the_curve_that_decides_it(files):
    site = yaml.safe_load(SITE + SLC)
    alone, tied = (parse_structure(text, "s.yaml", "test", Registry()) for text in (HEAVY, STRONG))
    titles = [axes.get_title("left") for axes in rk.verify(alone, site, strengthened=tied).plot().axes]
    assert titles == [
        "facade, positive direction, existing, FC = 1.35 (SLV not satisfied)",
        "facade, positive direction, strengthened, FC = 1.35 (SLV satisfied only if ...)",
    ]
    leaning = FACADE + "density: 1800\ndepth: 5\nloads: [{name: roof, mass: 6 t, at: [0.2, 8]}]\n"
    titles = [
        axes.get_title("left")
        for axes in rk.verify(parse_structure(leaning, "s.yaml", "test", Registry()), site).plot().axes
    ]
    assert titles == [
        "facade: rectangular block, positive direction, FC = 1.35 (SLV not satisfied)",
        "facade: rectangular block, negative direction, FC = 1.35",
    ]


def test_a_file_that_is_not_there_is_named(files):
    said = run("verify", "old.yaml", "--strengthened", "none.yaml", "--site", "site.yaml", code=2).stderr
    assert "none.yaml" in said and "Traceback" not in said
