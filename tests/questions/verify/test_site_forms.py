"""The site as engineers write it: parameters on rock with the soil, rows by limit state, rounded rows, classes."""

from math import log

import pytest

import rocking_cli as rk
from rocking_cli.codes.italian.ground import SiteGround
from rocking_cli.codes.italian.site import ItalianSite
from rocking_cli.core import Direction
from rocking_cli.errors import InputError
from rocking_cli.verification.check import read_site
from tests.cli.test_cli import run, run_json
from tests.conftest import EXAMPLES

G = 9.80665
ROCK = {"FC": "LC1", "ag": 0.2, "F0": 2.5, "TC_star": 0.32, "soil": "C"}
PRINTED = {"SLO": [45, 0.066, 2.36, 0.28], "SLD": [75, 0.084, 2.35, 0.285], "SLV": [712, 0.21, 2.42, 0.31],
           "SLC": [1462, 0.265, 2.46, 0.32]}  # fmt: skip
STATES = {state: dict(zip(("ag", "F0", "TC_star"), row[1:], strict=True)) for state, row in PRINTED.items()}
ROUNDED = {"FC": 1.35, "VN": 50.0, "class": "III", "soil": "C", "hazard": list(PRINTED.values())}
BLOCK = rk.Block(width=0.6, height=8.0)
STEPS = {"SLD": 75.4336, "SLV": 711.842, "SLC": 1462.18}


def ground(fields):
    return SiteGround(ItalianSite.model_validate(fields))


def on_soil_c(ag, F0, TC_star):
    """S_S and T_C on soil C by the table of the code, 3.2.3."""
    return min(max(1.7 - 0.6 * F0 * ag, 1.0), 1.5), 1.05 * TC_star**-0.33 * TC_star


class TestOnRock:
    def test_s_and_t_c_follow_from_the_soil(self):
        S, TC = on_soil_c(0.2, 2.5, 0.32)
        assert pytest.approx(1.4) == S and pytest.approx(0.4893728, rel=1e-6) == TC
        found = ground(ROCK).on_ground("SLV")
        assert (found.ag, found.F0, found.soil) == (0.2, 2.5, "C")
        assert pytest.approx((S, TC), rel=1e-12) == (found.S, found.TC)
        assert pytest.approx(1.4 * S, rel=1e-12) == ground(ROCK | {"topography": "T4"}).on_ground("SLV").S

    def test_it_verifies_as_the_parameters_that_follow(self):
        S, TC = on_soil_c(0.2, 2.5, 0.32)
        plain = {"FC": 1.35, "ag": 0.2, "F0": 2.5, "TC": TC, "S": 1.2 * S, "soil": "C"}
        found = rk.verify(BLOCK, ROCK | {"topography": "T2"}).directions[rk.Direction.POSITIVE]
        wanted = rk.verify(BLOCK, plain).directions[rk.Direction.POSITIVE]
        for key in ("damage", "linear", "nonlinear"):
            assert found.methods[key].a_g == pytest.approx(wanted.methods[key].a_g, rel=1e-12)

    def test_without_a_state_they_are_those_of_slv_which_is_said(self):
        said = "The parameters without a limit state are those of SLV."
        assert said in rk.verify(BLOCK, ROCK).sentences and said in rk.demand(ROCK).sentences
        by_state = {key: value for key, value in ROCK.items() if key in ("FC", "soil")} | STATES
        assert said not in rk.verify(BLOCK, by_state).sentences

    def test_each_limit_state_has_its_own(self):
        found = ground({"FC": 1.35, "soil": "C", **STATES})
        for state, (_, *rock) in PRINTED.items():
            at, (S, TC) = found.on_ground(state), on_soil_c(*rock)
            assert (at.ag, at.S, at.TC) == pytest.approx((rock[0], S, TC), rel=1e-12)
            assert found.return_period(state) is None
        states = rk.verify(BLOCK, {"FC": 1.35, "soil": "C", **STATES}).directions[rk.Direction.POSITIVE].states
        assert all(each.demand is not None for each in states.values())

    def test_return_periods_are_known_with_the_life(self):
        found = ground({"FC": 1.35, "soil": "C", "VN": 50.0, "class": "IV", **STATES})
        assert found.return_period("SLV") == pytest.approx(-100 / log(0.9), rel=1e-12)
        assert ground(ROCK | {"VN": 50.0, "class": "II"}).return_period("SLO") == pytest.approx(30.107, abs=1e-3)


class TestLife:
    @pytest.mark.parametrize(("use", "CU"), [("I", 0.7), ("II", 1.0), ("III", 1.5), ("IV", 2.0)])
    def test_the_coefficient_of_use_of_a_class(self, use, CU):
        table = [[30, 0.06, 2.4, 0.27], [475, 0.2, 2.4, 0.3], [2475, 0.3, 2.5, 0.36]]
        site = {"FC": 1.35, "VN": 60.0, "soil": "B", "hazard": table}
        one, other = ground(site | {"class": use}), ground(site | {"CU": CU})
        assert one.return_period("SLV") == other.return_period("SLV") == pytest.approx(-60 * CU / log(0.9), rel=1e-12)

    def test_it_is_at_least_35_years_which_is_said(self):
        site = ROCK | {"VN": 10.0, "class": "II"}
        assert ground(site).return_period("SLV") == pytest.approx(-35 / log(0.9), rel=1e-12)
        said = "V_R = V_N C_U = 10 years is less than the 35 years of the Circolare (§C2.4.3), which are used."
        assert said in rk.verify(BLOCK, site).sentences
        assert not [each for each in rk.verify(BLOCK, site | {"VN": 50.0}).sentences if "less than the 35" in each]

    @pytest.mark.parametrize(("level", "FC"), [("LC1", 1.35), ("LC2", 1.2), ("LC3", 1.0)])
    def test_a_knowledge_level_is_a_confidence_factor(self, level, FC):
        assert ItalianSite.model_validate(ROCK | {"FC": level}).FC == FC
        a0 = rk.verify(BLOCK, ROCK | {"FC": level, "FC_without_strength": True}).directions[rk.Direction.POSITIVE].a0
        assert a0 == pytest.approx(0.6 / 8.0 * G / FC, rel=1e-12)


class TestRoundedRows:
    def test_each_is_that_of_its_limit_state(self):
        """VR is 75 years: 45.161, 75.434, 711.84 and 1462.18 years, the last beyond the row of 1462."""
        found = ground(ROUNDED)
        for state, row in PRINTED.items():
            assert found.return_period(state) == row[0]
            assert [*found.on_rock(state)] == pytest.approx(row[1:], rel=1e-12)
        (said,) = (each for each in rk.verify(BLOCK, ROUNDED).sentences if "rows of the hazard" in each)
        assert "45 years for SLO (45.1608 years), 75 years for SLD (75.4336 years)" in said
        assert "712 years for SLV (711.842 years) and 1462 years for SLC (1462.18 years)" in said
        assert said in rk.demand(ROUNDED).sentences

    def test_whole_years_are_rounded_ones_within_the_table_too(self):
        rows = [[30, *PRINTED["SLO"][1:]], [50, *PRINTED["SLD"][1:]], [475, *PRINTED["SLV"][1:]],
                [975, *PRINTED["SLC"][1:]]]  # fmt: skip
        found = ground(ROUNDED | {"class": "II", "hazard": rows})
        assert [*found.on_rock("SLV")] == pytest.approx(PRINTED["SLV"][1:], rel=1e-12)

    @pytest.mark.parametrize(
        "rows",
        [
            [[30, 0.05, 2.4, 0.27], *list(PRINTED.values())[1:3], [1463, 0.265, 2.46, 0.32]],  # 30 is of no state
            [[45, 0.066, 2.36, 0.28], [75, 0.084, 2.35, 0.285], [712, 0.21, 2.42, 0.31], [1463, 0.265, 2.46, 0.32]],
        ],
    )
    def test_other_rows_are_interpolated(self, rows):
        found = ground(ROUNDED | {"hazard": rows})
        share = log(-75 / log(0.9) / 75) / log(712 / 75)
        assert found.on_rock("SLV").ag == pytest.approx(0.084 ** (1 - share) * 0.21**share, rel=1e-12)
        assert not [each for each in rk.verify(BLOCK, ROUNDED | {"hazard": rows}).sentences if "rounded" in each]

    @pytest.mark.parametrize(("last", "is_taken"), [(1448, True), (1447, False)])
    def test_within_one_per_cent(self, last, is_taken):
        site = ROUNDED | {"hazard": [*ROUNDED["hazard"][:3], [last, 0.265, 2.46, 0.32]]}
        if is_taken:
            assert ground(site).on_rock("SLC").ag == pytest.approx(0.265, rel=1e-12)
            return
        with pytest.raises(InputError, match=r"that of SLC, 1462 years, is not between(.|\n)*within 1 % of their"):
            rk.verify(BLOCK, site | {"states": ["SLV", "SLC"]})

    def test_the_sheet_says_which_row_is_taken(self):
        lines = [each for each in rk.verify(BLOCK, ROUNDED).workings if each.state in STEPS and each.symbol == "T_R"]
        for state, exact in STEPS.items():
            computed, taken = (each for each in lines if each.state == state)
            assert computed.value == pytest.approx(exact, rel=1e-5) and computed.formula == "-V_R/ln(1 - P)"
            assert taken.value == PRINTED[state][0] and "the row of the site file" in taken.meaning
            assert taken.standing == "ours"


class TestElsewhere:
    """Each form in what takes a site beside `verify`."""

    FORMS = (ROCK, {"FC": "LC2", "soil": "C", "topography": "T2", **STATES}, ROUNDED)

    @pytest.mark.every(3)
    @pytest.mark.parametrize("site", FORMS)
    def test_survey_design_and_both_sheets(self, site, tmp_path):
        (row,) = rk.survey([BLOCK], site=site).to_dict()["rows"]
        data = rk.verify(BLOCK, site).to_dict()
        assert row["ratio"] == pytest.approx(data["conclusion"]["ratio"], rel=1e-9)
        found = rk.design(BLOCK, vary="width=0.5m:3m", until="zeta_nonlinear >= 1", site=site, points=5)
        assert found.value is not None
        for language, said in (("en", "soil amplification factor"), ("it", "coefficiente di amplificazione")):
            rk.verify(BLOCK, site, sheet=tmp_path / "s.html", language=language)
            page = (tmp_path / "s.html").read_text(encoding="utf-8")
            assert said in page and "None" not in page.partition("<body")[2].partition("<script")[0]


OK = "FC: LC1\nag: 0.2\nF0: 2.5\nTC_star: 0.32\nsoil: C\n"
TABLE = "FC: 1.35\nVN: 50\nCU: 1\nsoil: B\nhazard: [[30, .06, 2.4, .27], [475, .2, 2.4, .3], [2475, .3, 2.5, .36]]\n"
WRONG = [
    (OK.replace("LC1", "LC4"), 1, "FC", "must be a number, or a knowledge level, LC1, LC2 or LC3: got 'LC4'", None),
    (OK.replace("soil: C\n", ""), 1, "soil", "is missing: S and T_C need the category of the soil", None),
    (OK.replace("soil: C", "soil: c"), 5, "soil", "must be A, B, C, D or E, got the text c", "did you mean C?"),
    (OK.replace("soil: C", "soil: S1"), 5, "soil", "must be A, B, C, D or E, got the text S1", None),
    (OK + "VN: 50\nclass: V\n", 7, "class", "must be I, II, III or IV, got the text V", "did you mean IV?"),
    (OK + "VN: 50\nclass: 3\n", 7, "class", "must be I, II, III or IV, got 3", None),
    (OK + "VN: 50\nclasse: III\n", 7, "classe", "is not a field of the site", "did you mean class?"),
    (OK + "VN: 50\nCU: 1.5\nclass: III\n", 7, "CU", "cannot be combined with class, from which it follows", None),
    (OK + "VN: 50\n", 1, "CU", "return periods need the coefficient of use, or `class`", None),
    (OK + "CU: 1.0\n", 1, "VN", "return periods need the nominal life", None),
    (OK + "TC: 0.4\n", 6, "TC", "cannot be combined with TC_star", None),
    (OK + "S: 1.2\n", 6, "S", "cannot be combined with TC_star", None),
    (OK.replace("TC_star", "TC*"), 4, "TC*", "is not a field of the site", "did you mean TC_star?"),
    (OK.replace("TC_star: 0.32\n", ""), 1, "TC", "or give TC_star and soil", None),
    (OK.replace("F0: 2.5\n", ""), 1, "F0", "is missing", None),
    (OK + "SLV: {ag: 0.2, F0: 2.5, TC_star: 0.3}\n", 6, "SLV", "cannot be combined with ag", None),
    (OK + "SLD: {ag: 0.3, F0: 2.5, TC_star: 0.3}\n", 2, "ag", "must be more than that of SLD, 0.3 g: got 0.2", None),
    (OK + "SLC: {ag: 0.2, F0: 2.5, TC_star: 0.3}\n", 6, "SLC.ag", "must be more than that of SLV, 0.2 g: got", None),
    (OK + "SLD: {ag: 0.1, F0: 2.5}\n", 6, "SLD.TC", "is missing", None),
    (OK.replace("TC_star: 0.32\nsoil: C", "TC: 0.4\nS: 1.2\ntopography: T2"), 6, "topography", "S, as given", None),
    (TABLE.replace("[475, .2", "[475, .06"), 5, "hazard[2]", "ag must increase with the return period, got 0.06", None),
    (TABLE.replace("VN: 50\n", ""), 1, "VN", "return periods need the nominal life", None),
    (TABLE + "SLV: {ag: 0.2, F0: 2.5, TC_star: 0.3}\n", 6, "SLV", "cannot be combined with hazard", None),
    (TABLE + "TC_star: 0.3\n", 6, "TC_star", "cannot be combined with hazard", None),
    (TABLE + "longitude: 13\n", 6, "longitude", "cannot be combined with hazard", None),
    ("FC: 1\nsoil: B\nVN: 50\nCU: 1\nlongitude: 13\ngrid: g.csv\n", 1, "latitude", "instead `hazard`", None),
    ("FC: 1\nsoil: B\nVN: 50\nCU: 1\nlongitude: 190\n", 5, "longitude", "must be at most 180 deg, got 190", None),
]  # fmt: skip


@pytest.mark.parametrize(("text", "line", "field", "said", "hint"), WRONG, ids=[each[3][:40] for each in WRONG])
def test_what_is_wrong_has_its_place_and_a_remedy(text, line, field, said, hint, tmp_path):
    file = tmp_path / "site.yaml"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(InputError) as caught:
        read_site(file)
    found = [each for each in caught.value.problems if each.field == field and said in each.message]
    assert found, caught.value.problems
    assert (found[0].line, found[0].hint) == (line, hint) and found[0].file == str(file)


def test_only_the_states_asked_for_are_verified():
    """SLV is as it was, and nothing of SLC and SLD decides."""
    whole, alone = (rk.verify(BLOCK, ROUNDED | {"states": each}) for each in (["SLV", "SLC", "SLD"], ["SLV"]))
    assert whole.conclusion.limit_state in ("SLC", "SLD") and alone.conclusion.limit_state == "SLV"
    of_whole, of_alone = (each.directions[Direction.POSITIVE].states for each in (whole, alone))
    assert of_alone == of_whole
    assert rk.demand(ROUNDED | {"states": ["SLV"]}).states.keys() == PRINTED.keys()
    with pytest.raises(InputError, match="must include SLV or SLC"):
        rk.verify(BLOCK, ROUNDED | {"states": ["SLD"]})


@pytest.mark.parametrize(
    ("line", "hint"),
    [
        ("suolo: B", "did you mean soil?"), ("Fo: 2.4", "did you mean F0?"), ("FO: 2.4", "did you mean F0?"),
        ("SLD: {ag: 0.1, Fo: 2.4, S: 1, TC: 0.3}", "did you mean F0?"), ("LC: LC1", "did you mean FC: LC1"),
        ("classe: II", "did you mean class?"), ("Tc*: 0.3", "did you mean TC_star?"), ("TC*: 0.3", "mean TC_star?"),
        ("vita_nominale: 50", "did you mean VN?"), ("Vn: 50", "did you mean VN?"),
        ("categoria_topografica: T1", "did you mean topography?"), ("topografia: T1", "did you mean topography?"),
        ("lon: 13", "did you mean longitude?"), ("lat: 42", "did you mean latitude?"),
        ("FC: 1,35", "write a decimal point"), ("q: 2,0", "write a decimal point"), ("S: 1,2", "write a decimal point"),
        ("SLD: {ag: 0.1, F0: 2.4, TC: 0.3, S: 1,2}", "write a decimal point"),
        ("hazard: [[30, 0.055, 2.45, 0.27], [475, 0,21, 2,42, 0,31]]", "write a decimal point"),
    ],
)  # fmt: skip
def test_a_word_that_engineers_use_names_the_field_and_a_comma_is_a_point(line, hint, tmp_path):
    (tmp_path / "s.yaml").write_text(f"{line}\n", encoding="utf-8")
    with pytest.raises(InputError) as caught:
        read_site(tmp_path / "s.yaml")
    assert any(hint in (problem.hint or "") and problem.line == 1 for problem in caught.value.problems)


def test_a_list_with_too_many_whole_numbers_has_no_decimal_commas(tmp_path):
    (tmp_path / "s.yaml").write_text("hazard:\n- [30, 1, 2, 3, 4]\n- [475,1,2,3,4]\n", encoding="utf-8")
    with pytest.raises(InputError) as caught:
        read_site(tmp_path / "s.yaml")
    long = [problem for problem in caught.value.problems if "at most 4 entries" in problem.message]
    assert [problem.hint for problem in long] == [None, None]


def test_the_command_verifies_each_form(tmp_path):
    (tmp_path / "site.yaml").write_text(OK, encoding="utf-8")
    data = run_json("verify", EXAMPLES / "verify" / "facade.yaml", "--site", "site.yaml")
    assert data["directions"]["positive"]["zeta"]["nonlinear"] > 0
    said = run("-v", "verify", "--site", "site.yaml").stdout
    assert "1.70 - 0.60 F0 a_g/g" in said and "1.05 (T_C*)^-0.33" in said
