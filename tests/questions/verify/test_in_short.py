"""The short view of a verification on the terminal: its length, and that nothing is lost that bears on the verdict."""

from __future__ import annotations

import re
from itertools import cycle
from math import asin, atan2, cos, hypot, isclose, pi, sin, sqrt

import pytest
import yaml

import rocking_cli as rk
from rocking_cli.cli import terminal
from rocking_cli.codes.italian.remarks import differences
from rocking_cli.codes.italian.sheet.steps import TERMINAL
from rocking_cli.codes.italian.view import IN_SHORT, STATE_OUTCOMES
from rocking_cli.studies.conclusion import Concluded
from rocking_cli.views.cautions import cautions_of
from rocking_cli.views.sheet.language import texts_of
from rocking_cli.views.verification import view
from tests.cli.test_cli import run
from tests.conftest import EXAMPLES

MAX_LINES = 84  # of the short view, in 60 columns
SITES = [EXAMPLES / "verify" / f"{name}.yaml" for name in ("site", "ground")]
STRUCTURES = [
    *(each for each in sorted((EXAMPLES / "verify").glob("*.yaml")) if "\nmechanism:" in each.read_text("utf-8")),
    *sorted((EXAMPLES / "walls").glob("*.yaml")),
    *(EXAMPLES / f"{name}.yaml" for name in ("arch", "block", "assembly")),
    EXAMPLES / "masonry" / "wall_of_three.yaml",  # two directions that differ
]
ACCEL, TRANSVERSE = (EXAMPLES / f"{name}.csv" for name in ("accel", "accel_transverse"))
SETS = {"sets": {"SLV": ACCEL, "SLC": TRANSVERSE}}
RECORDS = {"motions": [ACCEL, TRANSVERSE], "polarity": "both"}
WITHOUT_HISTORIES = "tied_facade"  # its file has no `rebound`


def cases():
    for structure in STRUCTURES:
        for site in SITES:
            yield pytest.param(structure, site, {}, id=f"{structure.stem}-{site.stem}")
        if structure.stem != WITHOUT_HISTORIES:
            yield pytest.param(structure, SITES[0], RECORDS, id=f"{structure.stem}-records")
            yield pytest.param(structure, SITES[0], SETS, id=f"{structure.stem}-sets")


def on_a_line(text):
    return " ".join(text.split())


@pytest.mark.every(12)
@pytest.mark.parametrize(("structure", "site", "more"), [*cases()])
def test_it_is_short_and_has_what_decides(structure, site, more, monkeypatch, capsys):
    """Each number of the verdict stands in it, and no line is wider than the terminal."""
    monkeypatch.setenv("COLUMNS", "60")
    answer = _answer(structure, site, **more)
    terminal.show(answer.view, as_json=False)
    lines, data = capsys.readouterr().out.splitlines(), answer.to_dict()
    assert len(lines) <= MAX_LINES and max(map(len, lines)) <= 60
    words = {tuple(each.split()) for each in lines}
    named = {"damage": "Onset of rocking", "linear": "Linear method", "nonlinear": "Nonlinear method"}
    for side in data["directions"].values():
        for key, name in named.items():
            a_g, zeta = (f"{side[part][key]:.4g}" for part in ("a_g", "zeta"))
            assert any(row[:2] == (*name.split(),)[:2] and row[-3::2] == (a_g, zeta) for row in words)
        for state, at in side["states"].items():
            if at["concluded"] is None:
                continue
            end = STATE_OUTCOMES[Concluded(at["concluded"])]
            assert any(f" {state} {end} " in " ".join(row) for row in words)
            if at["governs"].startswith("nonlinear"):
                assert any(row[:4] == (state, *(f"{at[key]:.4g}" for key in ("d", "demand", "ratio"))) for row in words)
            for name, tie in side.get("ties", {}).items():
                numbers = [f"{tie[f'force_{state}'] / 1e3:.6g}", f"{tie[f'elongation_{state}']:.6g}"]
                assert any(row[:-1] == (*name.split(), f"d_{state}", *numbers) for row in words)
        for state, at in side["dynamic"].items():
            numbers = [at["capacity"], *(at["with_FC"][key] for key in ("mean", "largest_known"))]
            cells = ("-" if each is None else f"{each:.4g}" for each in numbers)
            assert (state, str(len(at["records"])), *cells, "too", "few") in words
    text = on_a_line("\n".join(lines))
    assert "have them checked before you rely on a verdict" in text
    where = yaml.safe_load(site.read_text(encoding="utf-8")).get("name")
    whole = " ".join(each for each in view(answer.result, where).parts if isinstance(each, str))
    assert text.split(": a_g")[0].rsplit(" ", 2)[0] in whole  # the conclusion is the same


@pytest.mark.parametrize("width", ["80", "100"])
def test_wider_terminals_have_the_same_tables(width, monkeypatch):
    monkeypatch.setenv("COLUMNS", width)
    done = run("verify", EXAMPLES / "verify" / "facade.yaml", "--site", SITES[0])
    assert "Onset of rocking" in done.stdout and "not required" in done.stdout
    assert len(done.stdout.splitlines()) < MAX_LINES and "--all shows also" in on_a_line(done.stderr)


def _answer(structure, site=SITES[0], **how):
    return rk.verify(structure, site, in_full=False, **how)


@pytest.mark.every(8)
@pytest.mark.parametrize(("structure", "site"), [*zip(STRUCTURES, cycle(SITES))], ids=lambda each: each.stem)
def test_every_caution_and_remark_is_in_it(structure, site):
    """As a whole or in short; what is left out as empty is known by name."""
    answer = _answer(structure, site)
    found, said = answer.result, " ".join(answer.sentences)
    for side in found.distinct:
        for each in (*differences(side, found.first), *side.remarks):
            assert IN_SHORT(each) in said and (IN_SHORT(each) or each.key in LEFT_OUT)
    for each in found.remarks:
        assert IN_SHORT(each) in said and IN_SHORT(each)
    assert all(f"Caution: {each}" in said for each in cautions_of(found.mechanism))
    whole = [each for each in view(found).parts if isinstance(each, str) and each.startswith("Caution")]
    assert len(whole) <= said.count("Caution")


IN_TABLES = {"dynamic_is", "holds", "holds_not", "few", "one"}  # of the time histories
LEFT_OUT = {"line", "as_given", "stronger_without", "tie_limits", "ours_fails", *IN_TABLES}


def test_no_other_text_is_left_out_and_each_shortens_a_longer_one_that_exists():
    short, long = (texts_of("rocking_cli.codes.italian", key) for key in ("en_in_short", "en"))
    assert {key for key, text in short.items() if not text} == LEFT_OUT
    assert short.keys() <= long.keys() and all(
        len(short[key]) <= len(long[key]) or "{count}" in short[key] for key in short
    )
    for key in short:  # a caution stays one
        assert key in LEFT_OUT or short[key].startswith("Caution") == long[key].startswith("Caution")


def by_hand(N):
    """Capacity over demand at SLV of the tied facade at `ground.yaml`, if its tie pulls with N [kN].

    The wall turns about its right-hand corner. Half of roof and floor is carried; they move sideways as a whole.
    """
    wall, roof, floor = (18 * 0.6 * 8 * 5, 0.3, 4), (24 * 5, 0.3, 8), (18 * 5, 0.45, 4)  # kN, m from the corner
    lever, height = (wall[0] * wall[k] + (roof[0] * roof[k] + floor[0] * floor[k]) / 2 for k in (1, 2))
    x, y = (sum(each[0] * each[k] for each in (wall, roof, floor)) for k in (1, 2))
    total = wall[0] + roof[0] + floor[0]

    def moved(phi):
        return (y * sin(phi) + x * (1 - cos(phi))) / total

    d = 0.4 * moved(atan2(lever, height))  # d0 is without the tie, which is not known to hold so far
    phi = atan2(x, y) + asin((d - x / total) / hypot(x, y) * total)
    assert isclose(moved(phi), d, rel_tol=1e-9)
    at = complex(7.5 * sin(phi) - 0.6 * cos(phi), 7.5 * cos(phi) + 0.6 * sin(phi))
    along = at - complex(-5.3, 7.5)
    longer = (along.real * at.imag - along.imag * at.real) / abs(along)  # per unit rotation
    alpha = (lever * cos(phi) - height * sin(phi) + N * longer) / (y * cos(phi) + x * sin(phi))
    T = 1.68 * pi * sqrt(d / (alpha * 9.80665 / 1.35))
    ag, F0 = 0.21, 2.42
    S, TC = 1.7 - 0.6 * F0 * ag, 1.05 * 0.31**-0.33 * 0.31  # soil C
    assert TC < T < 6  # T_E of soil C
    Se = ag * 9.80665 * S * sqrt(10 / 13) * F0 * TC / T * min(1, (4 * ag + 1.6) / T)
    return d / (Se * (T / (2 * pi)) ** 2)


def test_a_tie_and_what_is_known_of_it(tmp_path):
    """To an elongation of 10 % it holds up to d_SLV; without, the wall stands alone from 2 % on."""
    text = (EXAMPLES / "verify" / "tied_facade.yaml").read_text(encoding="utf-8")
    bare = tmp_path / "bare.yaml"
    bare.write_text(re.sub(r" *elongation: .*\n", "", text), encoding="utf-8")
    bar = pi / 4 * 0.014**2 * 235e3
    for file, ratio, ends in (
        (EXAMPLES / "verify" / "tied_facade.yaml", by_hand(bar), False),
        (bare, by_hand(0), True),
    ):
        answer = _answer(file, SITES[1])
        (side,) = answer.result.distinct
        said = " ".join(answer.sentences)
        assert isclose(side.states["SLV"].ratio, ratio, rel_tol=1e-6) and "Caution" not in answer.sentences[0]
        assert ("stronger_without" in {each.key for each in side.remarks}) == ends
        assert "SLD in class IV only (here not given)" in said


def test_rocking_before_SLV_is_no_failure_and_a_structure_that_stays_at_rest_has_none():
    """The role beside a method: at SLV of the facade displacement decides, for the wall the onset."""
    rows = {row[0]: row for row in _table(_answer(EXAMPLES / "verify" / "facade.yaml"))[:3]}
    assert float(rows["Onset of rocking"][4]) < 1 and rows["Onset of rocking"][1] == "not required"
    assert rows["Linear method"][1] == "comparison" and rows["Nonlinear method"][1] == "SLV only if"
    at_rest = _answer(rk.Wall(thickness=0.9, height=3.0))
    assert _table(at_rest)[0][0] == "Onset of rocking" and _table(at_rest)[0][1] == "SLV only if"
    assert not any("displacement d" in each.title for each in _tables(at_rest))


def _tables(answer):
    return [each for each in answer.view.parts if not isinstance(each, str)]


def _table(answer):
    return next(each.rows for each in _tables(answer) if "by each method" in each.title)


def test_python_shows_all_unless_asked_and_data_are_the_same():
    whole = rk.verify(EXAMPLES / "verify" / "facade.yaml", SITES[0])
    short = _answer(EXAMPLES / "verify" / "facade.yaml")
    data = [{key: value for key, value in each.to_dict().items() if key != "given"} for each in (whole, short)]
    assert data[0] == data[1] and len(whole.view.parts) > len(short.view.parts)
    assert any(TERMINAL(each) in whole.sentences for each in whole.result.remarks)


def test_weights_are_named_by_their_body_once():
    wall = rk.SpanningWall(thickness=0.3, height=3.0, hinge=0.5, overburden=2e4, density=1800.0, depth=1.0)
    said = " ".join(rk.verify(wall, SITES[1]).sentences)
    assert "sideways with block" in said and "block block" not in said
