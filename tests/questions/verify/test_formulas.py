"""Each formula of the Italian code stands once: the terminal, the workings and the sheet are written from it."""

import ast
import importlib
import re
import shutil
import sys
from contextlib import contextmanager
from functools import cache, partial
from pathlib import Path
from typing import ClassVar
from unittest.mock import patch

import pytest
import yaml

from mechanisms.block import Block
from rocking_cli.codes import italian
from rocking_cli.codes.italian import formulas
from rocking_cli.codes.italian.rules import RULES
from rocking_cli.core import Direction
from rocking_cli.studies.remark import in_plain
from rocking_cli.verification.results import Formula, as_written, put
from rocking_cli.views.sheet.build import SheetOfCode
from rocking_cli.views.sheet.document import Sentence, Steps
from rocking_cli.views.verification import shown, view
from rocking_cli.views.view import Table
from tests.cli.test_cli import run
from tests.conftest import EXAMPLES
from tests.questions.verify.printed import items_in
from tests.questions.verify.test_sheet import CASES, FACADE, FLOOR, FULL, HAZARD, HEAVY, PARAPET, SITE, SLC, parts_of
from tests.questions.verify.test_sheet import verified as verified_of
from tests.questions.verify.test_sheet_structure import OF_STRUCTURE

EVERY = {
    name: each for name, each in vars(formulas).items() if isinstance(each, Formula) and name not in OF_STRUCTURE
} | {f"PERIOD {state}": each for state, each in formulas.PERIOD.items()}


class Grip:
    """Something attached that holds the structure back by more than its weight, and is moved with it."""

    name = "grip"

    def act(self, total, direction, follow):
        for each, factor in ((total.G, 1.1), (total.dG, 1.1), (total.B, 1.2), (total.dB, 1.2)):
            each *= factor

    def forces(self, direction, follow):
        return ()


class Springy(Block):
    """A block that a grip of its own holds."""

    mechanism: ClassVar[str] = "springy"

    def carries(self):
        return (Grip(),)


LARGE = "mechanism: block\nname: large\nwidth: 20\nheight: 160\n"
STEEL = """  - {name: bars, from: {ground: [-6, 7]}, to: {at: [-0.3, 7]}, spacing: 3, diameter: 0.012, steel: S235,
     plate: {width: 0.2, height: 0.15, thickness: 0.02}, wall: {thickness: 0.6, compression: 1e6, shear: 5e4}}
  - {name: thin, from: {ground: [-6, 5]}, to: {at: [-0.3, 5]}, spacing: 3, diameter: 0.012, steel: S235,
     plate: {width: 0.2, height: 0.15}, wall: {thickness: 0.6, compression: 1e6, shear: 5e4}}
  - {name: rod, from: {ground: [-6, 6]}, to: {at: [-0.3, 6]}, area: 1e-4, yield: 2e8}
"""
ENDS = "  - {name: rod, from: {ground: [-6, 7]}, to: {at: [-0.3, 7]}, area: 1e-3, yield: 2e8, elongation: 0.01}\n"
MORE = {
    "ties of steel": (HEAVY + "ties:\n" + STEEL, SITE, None),
    "a tie that ends": (HEAVY + "ties:\n" + ENDS, SITE, None),
    "soil A, a long life": (FACADE, HAZARD.replace("soil: B", "soil: A").replace("VN: 50", "VN: 300"), None),
    "beyond 10 s": (LARGE, SITE + "soil: A\n", None),
    "a point of a body": (FACADE, SITE, (0.1, 8.0, None)),
    "a level wall": ((EXAMPLES / "symmetric_frame.yaml").read_text(encoding="utf-8"), SITE, (5.0, 6.5, "beam")),
    "as its floor": (PARAPET, f"{SITE}{FLOOR}T0: 0.4\n", None),
    "of its own": (Springy(width=0.6, height=8.0), SITE, None),
    "short": (PARAPET, SITE + SLC + "T0: 0.02\n", None),
}
"""Structure, site and control point, beside the cases of the sheet, so that each formula is used."""


@cache
def case(name):
    structure, site, *point = MORE[name] if name in MORE else CASES[name]
    return structure, site, point[0] if point else None


def steps(language, verified, site):
    """What a sheet says of formulas: its steps, and the grid of what the site gives."""

    parts = [part for part in parts_of(verified, site, language, FULL) if part.key != "inputs"]
    return [row for item in items_in(parts) if isinstance(item, Steps | Table) for row in item.rows]


def outputs(name):
    """What the terminal prints, the workings, and the sheet in either language, each computed anew."""
    verified, site = verified_of.__wrapped__(*case(name))
    tables = [each for each in view(verified, every_step=True).parts if isinstance(each, Table)]
    lines = [*verified.workings, *(line for each in shown(verified).values() for line in each.workings)]
    return tables, lines, steps("en", verified, site), steps("it", verified, site)


def _is(formula, other):
    """Whether one is the other, or a copy with a clause or a meaning of its own."""
    same = all(getattr(formula, key) == getattr(other, key) for key in ("symbol", "text", "numbers"))
    return same and formula.clause in ("", other.clause) and formula.meaning in ("", other.meaning)


@pytest.fixture(scope="module")
def used():
    """Of each formula the first case that uses it, and what is printed there."""
    where, printed = {}, {}
    step = Formula.working
    for name in [*CASES, *MORE]:
        seen = []

        def noted(self, *args, seen=seen, **named):
            seen.append(self)
            return step(self, *args, **named)

        with patch.object(Formula, "working", noted):
            printed[name] = outputs(name)
        for key, formula in EVERY.items():
            if any(_is(formula, each) for each in seen):
                where.setdefault(key, name)
    return where, printed


@contextmanager
def marked():
    """Every formula has a mark in place of its text, or of its symbol if it has no text; return the marks."""
    kept = {name: dict(vars(formula)) for name, formula in EVERY.items()}
    marks = {name: f"MARK{chr(65 + k // 26)}{chr(65 + k % 26)}" for k, name in enumerate(EVERY)}
    try:
        for name, formula in EVERY.items():
            object.__setattr__(formula, "text" if formula.text else "symbol", marks[name])
        yield marks
    finally:
        for name, formula in EVERY.items():
            vars(formula).update(kept[name])


@pytest.mark.rest
def test_a_formula_that_is_changed_is_changed_in_every_printout(used):
    where, _ = used
    assert where.keys() == EVERY.keys(), "no case uses the others"
    given = {name for name, formula in EVERY.items() if formula.text == "given"}
    with marked() as marks:
        printed = {case: [repr(each) for each in outputs(case)] for case in set(where.values())}
    missing = [
        f"{name} in the {which}, {case}"
        for name, case in where.items()
        for text, which in zip(printed[case], ("terminal", "workings", "English sheet", "Italian sheet"), strict=True)
        if marks[name] not in text and not (name in given and "sheet" in which)  # there, a table without formulas
    ]
    assert not missing, "\n".join(missing)


@pytest.mark.rest
def test_every_line_is_plain_in_the_terminal(used):
    count = 0
    for tables, lines, *_ in used[1].values():
        for line in lines:
            assert all(each.isascii() for each in (line.symbol, line.formula, line.numbers, line.unit))
            count += bool(line.numbers)
        rows = [row[:3] for table in tables for row in table.rows]
        assert all([line.symbol, line.formula, line.numbers] in rows for line in lines)
    assert count > 2000


def test_no_other_file_of_the_code_holds_a_formula():
    folder = Path(italian.__file__).parent
    for file in folder.rglob("*.py"):
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if (
                isinstance(node, ast.Call)
                and isinstance(node.func, ast.Name)
                and node.func.id in ("Formula", "Working")
            ):
                assert file.name == "formulas.py", (file, node.lineno)


def test_each_limit_state_has_its_formula_of_the_period():
    assert [*formulas.PERIOD] == [rule.state for rule in RULES]
    assert formulas.PERIOD["SLV"].text == "1.68 π √(d_[{state}]/{a})"


@pytest.fixture
def with_one_more(tmp_path, monkeypatch):
    """A copy of the code with SLN, by the rule of SLC, and the fields that a site file and its floor have for it."""
    folder, added = shutil.copytree(Path(italian.__file__).parent, tmp_path / "one_more"), []
    for file in folder.rglob("*.py"):
        text = file.read_text(encoding="utf-8").replace("rocking_cli.codes.italian", "one_more")
        if file.name in ("rules.py", "site.py") and file.parent == folder:
            for line in re.findall(r'^    (?:Rule\(")?SLC[":].*\n', text, re.MULTILINE):
                added.append(line.replace("SLC", "SLN", 1))
                text = text.replace(line, added[-1] + line)
        file.write_text(text, encoding="utf-8")
    assert len(added) == 3
    monkeypatch.syspath_prepend(tmp_path)
    yield importlib.import_module("one_more")
    for name in [each for each in sys.modules if each.partition(".")[0] == "one_more"]:
        del sys.modules[name]


def by_key(sections):
    """The items of every part of a sheet."""
    return {key: each for one in sections for key, each in [(one.key, one.items), *by_key(one.parts).items()]}


GROUND = "{ag: 0.26, F0: 2.5, TC: 0.42, S: 1.2}"
BOTH = f"{SITE}SLN: {GROUND}\nSLC: {GROUND}\n"
MODES = "floor: {z: 6, H: 9, T1: 0.6, xi1: 0.12, n: 3, SLD: {T1: 0.3, xi1: 0.05}"
SITES = {
    "parameters": f"{BOTH}T0: 0.02\n",
    "not given": SITE,
    "a long life": HAZARD.replace("VN: 50", "VN: 300"),
    "its own mode": f"{BOTH}{MODES}, SLN: {{T1: 0.7, xi1: 0.15}}, SLC: {{T1: 0.7, xi1: 0.15}}}}\n",
    "the mode of SLV": f"{BOTH}{MODES}}}\n",
}


@pytest.mark.every(3)
@pytest.mark.parametrize("site", SITES)
def test_a_new_limit_state_is_a_rule_and_its_fields(with_one_more, site):
    """What is said of SLC is said of SLN, which is the same but in name, in the terminal, in JSON and in the sheet."""
    code, build = with_one_more.Italian(), importlib.import_module("one_more.sheet.build")
    given = code.site.model_validate(yaml.safe_load(SITES[site]))
    roof = {"name": "roof", "mass": 500.0, "at": (0.1, 4.0)}
    block = Block(width=0.3, height=4.0, density=1800.0, depth=1.0, loads=[roof])
    verified = code.verify(block, given)
    side = verified.directions[Direction.POSITIVE]
    assert "SLN" in side.states
    full = SheetOfCode(importlib.import_module("one_more.sheet.steps").PACKAGE, partial(build.context, in_full=True))
    parts = by_key(parts_of(verified, given, "en", full))
    own = {key: items for key, items in parts.items() if "SLC" in key}
    assert "positive-SLC-line" in own and ("positive-nonlinear_SLC-line" in own) == (site != "not given")
    assert {key for key in parts if "SLN" in key} == {key.replace("SLC", "SLN") for key in own}
    for key, items in own.items():
        assert repr(parts[key.replace("SLC", "SLN")]).replace("SLN", "SLC") == repr(items), key
    terminal = [*code.showing().of_direction(verified, side, "Positive direction"), *verified.remarks]
    summary = [each for each in parts["summary"] if not isinstance(each, Sentence)]  # these name what governs
    for said in (summary, parts["remarks"], parts["site"], terminal, [*verified.workings], [*side.workings],
                 code.showing().data(verified, side)):  # fmt: skip
        assert repr(said).count("SLN") == repr(said).count("SLC"), said
    assert "SLN" in repr([*side.workings]) and "d_[SLN]" in repr(parts["remarks"])


class TestFormula:
    """What a code without a sheet uses."""

    RATIO = Formula("ρ_[{state}]", "C/D", "{C}/{D}", "g", "4.2", meaning="capacity over demand at {state}")

    def test_it_is_filled(self):
        line = self.RATIO.working(1.5, {"state": "ULS"}, C=0.3, D=0.2)
        assert (line.symbol, line.formula, line.numbers, line.value) == ("ρ_[ULS]", "C/D", "0.3/0.2", 1.5)
        assert (line.meaning, line.unit, line.clause) == ("capacity over demand at ULS", "g", "4.2")
        assert (line.state, line.standing) == ("ULS", "code")
        assert line.in_plain("Strength").symbol == "rho_ULS" and line.in_plain("Strength").section == "Strength"

    @pytest.mark.parametrize(
        ("numbers", "given", "wanted"),
        [
            ("{P} · {x} + …", {"P": [1.0, 2.0], "x": [3.0, -4.0]}, "1 · 3 + 2 · (-4)"),
            ("({P} · {x} + …)/({P} + …)", {"P": [1.0, 2.0], "x": [3.0, 4.0]}, "(1 · 3 + 2 · 4)/(1 + 2)"),
            ("min({a} · {b}; {d}; …)", {"a": 0.4, "b": 2.0, "d": [5.0, 6.0]}, "min(0.4 · 2; 5; 6)"),
            ("{a:9} + {a}; {x:3} + …", {"a": 2 / 3, "x": [1 / 3, -1e-7]}, "0.666666667 + 0.666667; 0.333 + (-1e-07)"),
            ("{a} · {b}^[{n}]", {"a": 1e-9, "b": -2.0, "n": "−0.20"}, "(1e-09) · (-2)^[−0.20]"),
        ],
    )
    def test_numbers_below_zero_and_sums(self, numbers, given, wanted):
        assert put(numbers, given, as_written) == wanted

    def test_a_sum_needs_as_many_of_each(self):
        with pytest.raises(ValueError, match="shorter"):
            put("{P} · {x} + …", {"P": [1.0, 2.0], "x": [3.0]}, as_written)

    @pytest.mark.parametrize(
        ("marked", "plain"),
        [
            ("α_[0] g/(e^[*] FC)", "alpha0 g/(e* FC)"), ("d_[SLV]", "d_SLV"), ("a^[*]_[SLV,lin]", "a*_SLV,lin"),
            ("Σ (P+Q) x′^[2]", "sum (P+Q) x'^2"), ("ξ_[1]^[−1/2] η(ξ)", "xi1^-1/2 eta(xi)"),
            ("√(10/5) ≥ 0.55", "sqrt(10/5) >= 0.55"),
            ("Δ_[m] = λ · Ω^[2]", "Delta_m = lambda * Omega^2"),
        ],
    )  # fmt: skip
    def test_plain_characters(self, marked, plain):
        assert in_plain(marked) == plain and plain.isascii()


def test_the_terminal_prints_every_step_at_its_most_verbose(tmp_path):
    (tmp_path / "s.yaml").write_text(FACADE, encoding="utf-8")
    (tmp_path / "site.yaml").write_text(SITE, encoding="utf-8")
    words = ("verify", tmp_path / "s.yaml", "--site", tmp_path / "site.yaml")
    brief, whole = run(*words, "--all").stdout, run("-v", *words).stdout
    assert "Both directions: Kinematic chain, at rest" in whole and "0.075 * 9.80665/(1 * 1.35)" in whole
    assert "Kinematic chain" not in brief and all(line in whole.splitlines() for line in brief.splitlines())
