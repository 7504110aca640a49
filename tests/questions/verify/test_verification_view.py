"""What a verification shows: the form of its JSON, its tables, and sentences checked against its numbers."""

import re
from dataclasses import replace

import pytest

import rocking_cli as rk
from rocking_cli.codes.italian.remarks import differences
from rocking_cli.codes.italian.sheet.steps import TERMINAL
from rocking_cli.codes.italian.sheet.summary import verdicts
from rocking_cli.core import Direction
from rocking_cli.verification.code import codes
from rocking_cli.verification.results import Working
from rocking_cli.views.verification import standing, view
from rocking_cli.views.view import Table
from tests.cli.test_cli import run, run_json
from tests.conftest import EXAMPLES
from tests.questions.verify.test_sheet import FACADE as FILE
from tests.questions.verify.test_sheet import SITE as OF_SHEET
from tests.questions.verify.test_sheet import items_of, steps_of
from tests.questions.verify.test_sheet import verified as of_files

SITE = {"FC": 1.35, "ag": 0.2, "F0": 2.5, "TC": 0.4, "S": 1.2}
FACADE = rk.Block(width=0.6, height=8.0, name="facade")
WALL = rk.Wall(thickness=0.3, height=3.0, name="wall")
PARAPET = rk.Block(width=0.25, height=1.2, name="parapet")


def verified(mechanism, **site):
    code = codes()["NTC2018"]
    return code.verify(mechanism, code.site.model_validate({**SITE, **site}), None)


def positive(mechanism, **site):
    return verified(mechanism, **site).directions[Direction.POSITIVE]


def said_of(mechanism, **site):
    found = verified(mechanism, **site)
    return list(verdicts(TERMINAL, "Here", found, found.directions[Direction.POSITIVE]))


@pytest.fixture
def files(tmp_path):
    (tmp_path / "site.yaml").write_text("".join(f"{key}: {value}\n" for key, value in SITE.items()), encoding="utf-8")
    (tmp_path / "b.yaml").write_text("mechanism: block\nname: b\nwidth: 0.6\nheight: 8\n", encoding="utf-8")


def test_json_has_the_numbers_of_both_states(files):
    data = run_json("verify", "b.yaml", "--site", "site.yaml")
    assert list(data["directions"]) == ["positive", "negative"]
    for side in data["directions"].values():
        assert [side["states"]["SLV"][key] for key in ("governs", "passes")] == ["nonlinear", False]
        assert [side["states"]["SLC"][key] for key in ("governs", "passes")] == [None, None]
        assert side["dynamic"] == {} and side["M_star"] is None  # without masses
        slv = side["states"]["SLV"]
        assert slv["ratio"] == pytest.approx(slv["d"] / slv["demand"])
        assert side["zeta"]["nonlinear"] == pytest.approx(side["a_g"]["nonlinear"] / 0.2)
    assert data["directions"]["positive"]["a_g"]["nonlinear"] == pytest.approx(0.193382, abs=6e-7)


def test_a_failed_verification_is_a_result_and_so_is_the_example():
    site = EXAMPLES / "verify" / "site.yaml"
    data = run_json("verify", EXAMPLES / "verify" / "facade.yaml", "--site", site)
    side = data["directions"]["positive"]
    assert side["states"]["SLC"]["demand"] > 0
    # One block has one barycentre of weights, so that M* = (P + Q)/g: the wall, and all of a roof that is borne.
    M_star = 0.6 * 8.0 * 5.0 * 1800.0 + 3000.0
    assert side["M_star"] == pytest.approx(M_star, rel=1e-9)
    assert side["return_period"]["nonlinear"]["years"] > 30


def test_the_direction_with_the_smaller_ratio_governs():
    leaning = rk.RigidBody(polygon=[[0, 0], [1.0, 0], [0.9, 5.0], [0.3, 5.0]], name="leaning")
    found = verified(leaning)
    ratios = {direction: each.ratio for direction, each in found.directions.items()}
    assert found.governs is min(ratios, key=ratios.get) and ratios[Direction.POSITIVE] != ratios[Direction.NEGATIVE]
    said = [part for part in view(found).parts if isinstance(part, str)]
    assert any(
        f"The {found.governs.label} direction governs: its ratio of capacity to demand is "
        f"{min(ratios.values()):.3g}, against {max(ratios.values()):.3g} in the other direction." in each
        for each in said
    )
    assert not any("direction governs" in part for part in view(verified(FACADE)).parts if isinstance(part, str))


GROUND = {key: value for key, value in SITE.items() if key != "FC"}
FLOOR = {"z": 2.0, "H": 3.0, "T1": 0.4, "xi1": 0.1, "n": 3}
LOW = {**FLOOR, "z": 1.0}
DAMAGED = {**FLOOR, "T1": 0.6, "SLD": {"T1": 0.4, "xi1": 0.05}}


def remarks(found):
    """The values of each remark, by its key."""
    return {each.key: each.values for each in found}


class TestWords:
    @pytest.mark.parametrize("ag", [0.19, 0.24])
    @pytest.mark.parametrize("mechanism", [FACADE, WALL, PARAPET], ids=lambda each: each.name)
    def test_the_verdict_is_that_of_the_numbers(self, mechanism, ag):
        result = verified(mechanism, ag=ag)
        found = result.directions[Direction.POSITIVE]
        (said,) = verdicts(TERMINAL, "Here", result, found)
        damage, nonlinear = (found.methods[key].a_g for key in ("damage", "nonlinear"))
        capacity, slv = max(damage, nonlinear), found.states["SLV"]
        holds = "satisfied only if its conditions hold" if mechanism is WALL else "satisfied"
        assert said.startswith(f"Here, SLV: the verification is {holds if capacity >= ag else 'not satisfied'}. ")
        for number in (f"zeta_E = {capacity / ag:.4g}", f"a_g = {capacity:.4g} g", f"demand {ag:.4g} g"):
            assert number in said.replace("is ", "")
        assert ("the onset of rocking governs" in said) == (damage > nonlinear)
        assert (f"is {slv.d / slv.demand:.4g} times" in said) == (damage <= nonlinear)

    @pytest.mark.parametrize("mechanism", [FACADE, WALL, PARAPET], ids=lambda each: each.name)
    def test_why_the_linear_method_differs(self, mechanism):
        found = positive(mechanism)
        ratio = found.methods["linear"].a_g / found.counts.a_g
        said = next(differences(found, "SLV"))
        assert said.key == ("linear_more" if ratio > 1 else "linear_less")
        assert said.values["ratio"] == pytest.approx(ratio)
        assert ("It is unconservative here." in TERMINAL(said)) == (ratio > 1)

    def test_two_that_agree_say_so(self):
        found = positive(FACADE)
        same = replace(found.methods["linear"], capacity=found.counts.a_g * 1.001)
        (said, *_) = differences(replace(found, methods={**found.methods, "linear": same}), "SLV")
        assert said.key == "linear_same"

    def test_the_straight_line_is_said_where_it_changes_the_answer(self):
        assert "straight" not in remarks(differences(positive(FACADE), "SLV"))
        found = positive(rk.Arch(radius=10.0, thickness=1.5, inclusion_angle_deg=157.5, voussoirs=7))
        said = remarks(differences(found, "SLV"))["straight"]
        change = found.straight_methods["nonlinear"].a_g / found.methods["nonlinear"].a_g - 1
        assert said["change"] == pytest.approx(100 * abs(change))
        assert said["side"].key == ("more" if change > 0 else "less")

    @pytest.mark.parametrize(
        ("mechanism", "site", "wanted"),
        [
            (FACADE, {}, ["SLV not"]),
            (FACADE, {"SLC": GROUND, "SLD": {**GROUND, "ag": 0.03}}, ["SLV not", "SLC not decided", "SLD"]),
            (FACADE, {"SLC": {**GROUND, "ag": 0.59}, "SLD": GROUND}, ["SLV not", "SLC not decided", "SLD not"]),
            (WALL, {"SLC": {"ag": 0.24, "F0": 2.5, "TC": 0.55, "S": 1.2}}, ["SLV only if", "SLC only if"]),
        ],
    )
    def test_each_limit_state_is_said_that_the_site_gives(self, mechanism, site, wanted):
        asked = {"states": [each.split()[0] for each in wanted]}
        said = said_of(mechanism, **site, **asked)
        found = [
            re.match(r"Here, (\w+): the verification is( not)?(?: satisfied|( decided))( only if)?", each)
            for each in said
        ]
        assert ["".join(filter(None, each.groups())) for each in found] == wanted
        assert not any("SLC" in each for each in said_of(mechanism, **site))  # not required: in the tables

    @pytest.mark.parametrize(
        ("site", "key", "values"),
        [
            ({}, "no_soil", {}),
            ({}, "linear_SLV", {}),
            ({"floor": FLOOR}, "floor", {}),
            ({"floor": FLOOR}, "same_mode", {"T1": 0.4, "xi1": 0.1}),
            ({"floor": FLOOR}, "one_mode", {}),
            ({"floor": LOW}, "low_floor", {"floor": pytest.approx(0.2141, abs=5e-5)}),
            ({"floor": DAMAGED, "SLC": GROUND}, "same_mode_further", {"T1": 0.6, "xi1": 0.1, "states": ["SLC"]}),
            ({"SLC": GROUND, "states": ["SLC"]}, "long", {"T": pytest.approx(4.46, abs=5e-3), "most": 4.0}),
            ({"FC": 1.2}, "confidence", {"FC": 1.2, "least": 1.35}),
        ],
    )
    def test_what_to_know_of_the_site(self, site, key, values):
        said = remarks(verified(FACADE, **site).remarks)[key]
        assert {name: said[name] for name in values} == values
        other = verified(WALL, soil="B", SLD=GROUND) if "floor" not in site else verified(FACADE)
        assert key not in remarks(other.remarks)

    def test_a_floor_with_its_mode_at_damage_needs_no_caution(self):
        assert not {"same_mode", "same_mode_further"} & remarks(verified(FACADE, floor=DAMAGED).remarks).keys()


def test_ties_have_force_and_elongation_at_every_state(files, tmp_path):
    text = "mechanism: block\nname: b\nwidth: 0.6\nheight: 8\nmass: 1e4\nties:\n"
    text += "- {name: bar, from: {ground: [-9, 7.5]}, to: {at: [-0.3, 7.5]}, stiffness: 0, prestress: 500,"
    text += " elongation: 0.5}\n"
    (tmp_path / "t.yaml").write_text(text + "one_sided: positive\nrebound: 0.4\n", encoding="utf-8")
    command = ("verify", tmp_path / "t.yaml", "--site", "site.yaml")
    (bar,) = run_json(*command)["directions"]["positive"]["ties"].values()
    assert list(bar) == [f"{key}_{state}" for key in ("force", "elongation", "strain") for state in ("SLV", "SLC")]
    assert bar["force_SLV"] == 500 and bar["strain_SLC"] == pytest.approx(bar["elongation_SLC"] / 8.7)
    text = run(*command, "--all").stdout
    for state in ("SLV", "SLC"):
        row = next(line for line in text.splitlines() if "bar" in line and f"d_{state}" in line)
        assert f"{bar[f'elongation_{state}']:.6g}" in row and f"{100 * bar[f'strain_{state}']:.3g}" in row


def test_a_control_point_is_typed_and_its_influence_said(files):
    text = run("verify", "b.yaml", "--site", "site.yaml", "--control", "0.3,8").stdout
    assert "With this control point, d0* is" in text
    at = run_json("verify", "b.yaml", "--site", "site.yaml", "--control", "0.3,8,block")
    assert at["directions"]["positive"]["control"] == {"x": 0.3, "y": 8.0, "body": "block"}
    assert "'4' is not a valid point" in run("verify", "b.yaml", "--site", "site.yaml", "--control", "4", code=2).stderr
    wrong = run("verify", "b.yaml", "--site", "site.yaml", "--control", "0.3,0", code=2).stderr
    assert "--control does not move in the positive direction" in wrong
    assert "lies outside block" in run("verify", "b.yaml", "--site", "site.yaml", "--control", "9,0", code=2).stderr


def test_every_number_of_the_tables_has_its_clause():
    found = verified(
        rk.Arch(radius=10.0, thickness=1.5, inclusion_angle_deg=157.5, density=2000.0, depth=1.0, name="a")
    )
    tables = [part for part in view(found).parts if isinstance(part, Table)]
    for table in tables:
        where = list(table.columns).index("clause")
        for row in table.rows:
            if not row[0].startswith(("capacity/demand", "lambda")):
                assert row[where], row
    assert any(row[0] == "M*" and row[-1].endswith("ours") for table in tables for row in table.rows)
    said = " ".join(part for part in view(found).parts if isinstance(part, str))
    assert (
        "None of the formulas has been checked against the printed code yet" in said
        and "M* (participating mass), x_C' (" in said
    )


class TestInPython:
    def test_it_is_the_answer_of_the_command(self, files, tmp_path):
        answer = rk.verify("b.yaml", "site.yaml", control=(0.3, 8.0, "block"))
        assert answer.to_dict() == run_json("verify", "b.yaml", "--site", "site.yaml", "--control", "0.3,8,block")
        assert len(answer.to_frame()) == 12
        answer.plot(tmp_path / "a.png")
        assert (tmp_path / "a.png").read_bytes().startswith(b"\x89PNG")
        assert repr(answer).startswith("<verification: ")

    def test_a_site_may_be_a_mapping(self):
        with pytest.raises(rk.InputError, match=r"FC must be at least 1, got 0\.5"):
            rk.verify(FACADE, {**SITE, "FC": 0.5})
        with pytest.raises(rk.InputError, match="`polarity` must be one of 1, -1, both, got 2"):
            rk.verify(FACADE, SITE, polarity=2)
        answer = rk.verify(FACADE, SITE, motions=["sine:0.15g:0.6s"])
        assert list(answer.directions[Direction.POSITIVE].dynamic) == ["SLV"]


CLAUSES = {
    # symbol and limit state: place in the code, by a transcription of it
    "S_Z SLV": "[C7.2.7]", "gamma SLV": "[C7.2.10]", "A SLV": "[C7.2.6], [C7.2.9]", "T_R SLV": "[3.2.0]",
    "T_C SLV": "[3.2.5]", "T_D SLV": "[3.2.7]", "a0*": "[C8.7.1.3]", "T_SLV SLV": "[C8.7.1.10]",
    "d_SLV SLV": "§C8.7.1.2.1.6", "a_g,0 SLV": "[C8.7.1.8]", "a_g,q": "§C8.7.1.2.1.7",
    "a_g,nl SLV": "§C8.7.1.2.1.8", "a_g,0 SLD": "[C8.7.1.8]", "zeta_E SLV": "§8.3",
}  # fmt: skip
UNCHECKED = {"zeta_E SLV"}
"""What needs the print of the code."""


HAZARD = [[30, 0.055, 2.45, 0.27], [475, 0.175, 2.45, 0.32], [2475, 0.300, 2.55, 0.36]]
AT_HAZARD = {**dict.fromkeys(("ag", "F0", "TC", "S")), "hazard": HAZARD, "VN": 50.0, "CU": 1.0, "soil": "C"}


class TestClauses:
    def lines(self, **site):
        found = verified(FACADE, **AT_HAZARD, floor=FLOOR, **site)
        lines = [*found.workings, *found.directions[Direction.POSITIVE].workings]
        return {f"{line.symbol} {line.state}".strip(): line for line in lines}

    def test_formulas_are_in_brackets_and_sections_have_their_sign(self):
        lines = self.lines()
        assert {symbol: lines[symbol].clause for symbol in CLAUSES} == CLAUSES
        for line in lines.values():
            assert re.fullmatch(r"(\[C?[\d.-]+\](, )?)+|§C?[\d.]+(, DM .+)?|not in this edition", line.clause) or (
                line.standing == "plain"
            ), line

    def test_what_vibrates_has_its_own(self):
        lines = self.lines(T0=0.1)
        assert lines["a_g,0 SLV"].clause == "[C8.7.1.9]"
        element = {"kind": "cantilever", "L": 1.2, "t": 0.3, "w": 18e3, "E": 1.2e9}
        assert self.lines(element=element)["T0 SLV"].clause == "[C8.7.1.7]"

    def test_what_agrees_with_a_transcription_says_so_and_what_needs_the_print_too(self):
        lines = self.lines()
        for symbol in CLAUSES:
            expected = "code" if symbol in UNCHECKED else "ours" if symbol.startswith("A") else "transcription"
            assert lines[symbol].standing == expected, symbol
        said = standing(list(lines.values()), ": [formula] or §section")
        assert "each formula in the code: [formula] or §section. None" in said
        assert "They agree with a transcription of its text, except for V_R, r, a_g, F0, T_C*, S_S, S, C_C, " in said
        assert "psi, a*_SLV,lin, a*_SLC,lin, zeta_E, zeta_E,lin." in said
        assert "None of the formulas has been checked against the printed code yet" in said


@pytest.mark.parametrize(("damage", "linear"), [("", "‡"), ("SLD: {ag: 0.08, F0: 2.5, TC: 0.36, S: 1.2}\n", "*")])
def test_the_sheet_cites_the_code_alike(damage, linear):
    """The linear method by the ground of SLV is ours, on the sheet as in the terminal."""
    found, given = of_files(FILE, f"{OF_SHEET}floor: {{z: 6, H: 9, T1: 0.4, xi1: 0.1, n: 3}}\n{damage}")
    cited = {each.mark for each in steps_of(items_of(found, given))}
    assert {"[3.2.6]*", "[3.2.7]*", "[C7.2.6]*", "[C7.2.7]*", "[C7.2.10]*", "[C8.7.1.8]*", "§8.3†", "§C7.2.3†"} <= cited
    assert {f"§C8.7.1.2.1.7{linear}", "§C8.7.1.2.1.8*", "[C7.2.6], [C7.2.9]‡"} <= cited
    said = " ".join(part for part in view(found).parts if isinstance(part, str))
    assert ("a_g,q (capacity as a ground acceleration on rock)" in said) == (linear == "‡")


class TestStanding:
    """How far formulas were checked, of a code that has any of the kinds."""

    def lines(self, *standings):
        kinds = ("print", "transcription", "code", "ours", "plain")
        return [Working(each[0], each, "", "", 1.0, "", "1", each) for each in kinds if each in standings]

    @pytest.mark.parametrize(
        ("standings", "wanted", "not_said"),
        [
            (("print",), "Every formula has been checked against the printed code.", "have"),
            (
                ("print", "code"),
                "Only p of the formulas has been checked against the printed code: have the others",
                "yet",
            ),
            (
                ("print", "transcription", "code"),
                "The others agree with a transcription of its text, except for c.",
                "None",
            ),
            (("code",), "None of the formulas has been checked against the printed code yet: have them", "agree"),
            (
                ("ours",),
                "Our own choices ('ours'), where the code is silent or we depart from its wording: o (ours).",
                "clauses",
            ),
        ],
    )
    def test_each_is_said(self, standings, wanted, not_said):
        said = standing(self.lines(*standings), ": §section")
        assert wanted in said and not_said not in said.replace("have the others", "").replace(wanted, "")
        assert ("in the code: §section." in said) == (standings != ("ours",))

    def test_of_plain_mechanics_nothing_is_said(self):
        assert standing(self.lines("plain")) == standing([]) == ""
