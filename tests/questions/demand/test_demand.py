"""The response spectra of a site: their parameters and ordinates by hand, and what is said of them."""

import csv
from importlib.metadata import EntryPoint
from math import pi, sqrt
from pathlib import Path

import numpy as np
import pytest

import rocking_cli as rk
from rocking_cli.verification.code import Code, Site, codes
from rocking_cli.verification.demand import SiteDemand, StateDemand
from tests.cli.test_cli import run, run_json
from tests.conftest import EXAMPLES
from tests.questions.verify.test_second_code import beside

G = 9.80665
SITE = {"FC": "LC1", "name": "school", "ag": 0.2, "F0": 2.5, "TC_star": 0.32, "soil": "C", "topography": "T2", "VN": 50,
        "class": "III", "SLD": {"ag": 0.08, "F0": 2.4, "TC_star": 0.28}}  # fmt: skip
S, TC, TD = 1.4 * 1.2, 1.05 * 0.32**0.67, 2.4  # S_S = 1.7 - .6 * 2.5 * .2
FLOOR = {"z": 6.0, "H": 9.0, "T1": 0.6, "xi1": 0.12, "n": 3, "SLD": {"T1": 0.35, "xi1": 0.05}}
PRINTED = [[45, 0.066, 2.36, 0.28], [75, 0.084, 2.35, 0.285], [712, 0.21, 2.42, 0.31], [1462, 0.265, 2.46, 0.32]]


def written(folder, site=SITE, name="site.yaml"):
    (folder / name).write_text("".join(f"{key}: {value}\n" for key, value in site.items()), encoding="utf-8")
    return folder / name


def elastic(T, eta=1.0, ag=0.2, F0=2.5):
    """S_e of the Italian code [g], 3.2.2."""
    level, TB = ag * S * eta * F0, TC / 3
    if T < TB:
        return level * (T / TB + (1 - T / TB) / (eta * F0))
    return level * (1 if TC > T else TC / T if TD > T else TC * TD / T**2)


class TestSpectra:
    def test_parameters_by_hand(self):
        values = rk.demand(SITE).states["SLV"].values
        wanted = {"T_R": 711.842, "ag": 0.2, "F0": 2.5, "TC_star": 0.32, "S_S": 1.4, "C_C": 1.05 * 0.32**-0.33,
                  "S_T": 1.2, "S": S, "pga": 0.2 * S, "T_B": TC / 3, "T_C": TC, "T_D": TD}  # fmt: skip
        assert {key: values[key] for key in wanted} == pytest.approx(wanted, rel=1e-6)
        assert values["T_1"] is None and values["pfa"] is None

    @pytest.mark.parametrize(("damping", "eta"), [(0.05, 1.0), (0.08, sqrt(10 / 13)), (0.5, 0.55)])
    def test_accelerations_and_displacements_by_hand(self, damping, eta):
        found = rk.demand(SITE, damping=damping)
        slv = found.states["SLV"]
        assert slv.acceleration == pytest.approx([elastic(T, eta) for T in found.periods], rel=1e-6)
        short = found.periods <= 6.0  # T_E on soil C
        wanted = [elastic(T, eta) * G * (T / 2 / pi) ** 2 for T in found.periods[short]]
        assert slv.displacement[short] == pytest.approx(wanted, rel=1e-6)
        assert slv.displacement[-1] == pytest.approx(0.025 * 0.2 * S * G * TC * TD, rel=1e-9)
        assert found.periods[0] == 0 and found.periods[-1] == 10
        for corner in (TC / 3, TC, TD, 6.0):
            assert np.abs(found.periods - corner).min() < 1e-8

    def test_a_floor_by_hand(self):
        found = rk.demand(SITE | {"floor": FLOOR})
        slv = found.states["SLV"]
        S_Z = elastic(0.6, sqrt(10 / 17)) * 9 / 7 * 2 / 3 * sqrt(1 + 4 * 0.12**2)
        assert (slv.values["pfa"], slv.values["T_1"]) == pytest.approx((S_Z, 0.6), rel=1e-9)
        A = 1.1 / sqrt(0.12)
        at = {T: float(np.interp(T, found.periods, slv.floor_acceleration)) for T in (0.0, 0.6, 1.0)}
        assert at[0.0] == pytest.approx(S_Z, rel=1e-9) and at[0.6] == pytest.approx(A * S_Z, rel=1e-6)
        above = A * S_Z / (1 + (A - 1) * (1.0 / 0.66 - 1) ** 1.2)
        assert at[1.0] == pytest.approx(max(above, elastic(1.0)), rel=1e-6)
        assert found.states["SLD"].values["T_1"] == 0.35
        assert np.interp(1.0, found.periods, slv.acceleration) == pytest.approx(elastic(1.0), rel=1e-6)

    def test_at_slo_the_building_is_that_of_sld(self):
        site = {"FC": 1.35, "VN": 50, "class": "III", "soil": "C", "hazard": PRINTED, "floor": FLOOR}
        states = rk.demand(site).states
        assert [*states] == ["SLO", "SLD", "SLV", "SLC"]
        assert [each.values["T_1"] for each in states.values()] == [0.35, 0.35, 0.6, 0.6]

    def test_ordinates_end_where_a_table_ends(self):
        site = {"FC": 1.35, "spectrum": [[0, 0.24], [0.4, 0.6], [3.0, 0.1]]} | {
            "SLD": {"spectrum": [[0, 0.1], [0.4, 0.25], [2, 0.05]]}
        }
        found = rk.demand(site)
        assert found.periods[-1] == 3.0 and found.states["SLV"].acceleration[-1] == pytest.approx(0.1)
        sld = found.states["SLD"].acceleration
        assert np.isnan(sld[found.periods > 2.001]).all() and not np.isnan(sld[found.periods <= 2]).any()
        assert found.to_dict()["states"]["SLD"]["acceleration"][-1] is None
        assert "ag" not in [each.key for each in found.demand.parameters]
        assert found.sentences[0] == "SLV: the peak ground acceleration is a_g S = 0.24 g."

    def test_slo_beyond_the_hazard_is_left_out_which_is_said(self):
        table = [[50, 0.07, 2.42, 0.28], [475, 0.175, 2.45, 0.32], [2475, 0.3, 2.55, 0.36]]
        found = rk.demand({"FC": 1.35, "VN": 50, "CU": 1, "soil": "B", "hazard": table})
        assert [*found.states] == ["SLD", "SLV", "SLC"]
        assert "SLO is left out: its return period is outside the rows of the hazard." in found.sentences


class TestOutput:
    def test_the_first_sentence_has_what_decides(self, tmp_path):
        lines = run("demand", written(tmp_path)).stdout.splitlines()
        assert lines[0] == (
            "SLV: the peak ground acceleration is a_g S = 0.336 g, with a_g = 0.2 g on rock and S = 1.68, for a return "
            "period of 711.8 years."
        )
        assert lines[1] == "school: elastic spectra at 5 % damping, Italian code (NTC 2018 and Circolare 7/2019)"
        text = "\n".join(lines)
        assert "T_C*" in text and "soil factor" in text and "The parameters without a limit state" in text

    def test_json_and_table_have_the_same_numbers(self, tmp_path):
        file = written(tmp_path, SITE | {"floor": FLOOR})
        data = run_json("demand", file, "--damping", "8%")
        assert (data["first"], data["damping"], data["code"], data["site"]) == ("SLV", 0.08, "NTC2018", "school")
        run("demand", file, "--damping", "8%", "--out", "o.csv")
        with Path("o.csv").open(encoding="utf-8", newline="") as stream:
            rows = list(csv.DictReader(stream))
        assert len(rows) == len(data["states"]) * len(data["periods"])
        names = {"acceleration": "Sa [g]", "displacement": "Sd [m]", "floor_acceleration": "floor Sa [g]",
                 "floor_displacement": "floor Sd [m]"}  # fmt: skip
        for state, values in data["states"].items():
            for key, name in names.items():
                written_there = [float(row[name]) for row in rows if row["state"] == state]
                assert written_there == pytest.approx(values[key], rel=1e-8, abs=1e-12)

    @pytest.mark.parametrize("site", [SITE, SITE | {"floor": FLOOR}])
    def test_the_plot_has_each_state_at_its_ordinates(self, site):
        found = rk.demand(site)
        figure = found.plot()
        panels = [each for each in figure.axes if each.get_lines()]
        assert len(panels) == (4 if "floor" in site else 2)
        (line,) = (each for each in panels[0].get_lines() if each.get_label() == "SLV")
        assert line.get_ydata() == pytest.approx(found.states["SLV"].acceleration)
        assert line.get_linewidth() > 2 and {each.get_label() for each in panels[0].get_lines()} == {"SLD", "SLV"}
        highest = max(each.get_ydata().max() for panel in panels[: len(panels) // 2] for each in panel.get_lines())
        assert panels[0].get_ylim()[0] == 0 and panels[0].get_ylim()[1] > highest

    def test_what_is_wrong_is_refused(self, tmp_path):
        assert "no such file" in run("demand", "gone.yaml", code=2).stderr
        with pytest.raises(rk.InputError, match="`damping`: 1 is out of range: give a number from 0"):
            rk.demand(SITE, damping=1.0)


class TestSelect:
    def test_a_site_is_a_target(self, tmp_path):
        words = ("select", EXAMPLES / "accel.csv", "--band", "0.2:2", "--count", 1, "--within", "0.01:99")
        data = run_json(*words, "--target", written(tmp_path))
        assert data["target"] == "SLV of school"
        periods, target = (data["spectrum"][key] for key in ("period", "target"))
        assert target == pytest.approx([elastic(T) for T in periods], rel=1e-12)
        damped = run_json(*words, "--target", "site.yaml", "--damping", "8%")["spectrum"]["target"]
        assert damped == pytest.approx([elastic(T, sqrt(10 / 13)) for T in periods], rel=1e-12)

    def test_the_ground_is_the_target_of_a_site_with_a_floor(self, tmp_path):
        words = ("select", EXAMPLES / "accel.csv", "--band", "0.2:2", "--count", 1, "--within", "0.01:99")
        data = run_json(*words, "--target", written(tmp_path, SITE | {"floor": FLOOR}))
        assert data["target"] == "SLV of school, at the ground below its floor"
        assert data["spectrum"]["target"] == pytest.approx([elastic(T) for T in data["spectrum"]["period"]], rel=1e-12)

    def test_of_another_state(self, tmp_path):
        call = {
            "motions": str(EXAMPLES / "accel.csv"),
            "band": (0.5, 1.5),
            "count": 1,
            "within": (0.01, 99.0),
            "factors": (0.01, 9.0),
        }
        found = rk.select(target=SITE, state="SLD", **call)
        at = rk.demand(SITE).states["SLD"]
        assert found.candidates.target[0] == pytest.approx(
            at.values["pga"] * at.values["F0"] * at.values["T_C"] / 0.5, rel=1e-9
        )

    def test_a_state_that_is_not_there_or_means_nothing_is_refused(self, tmp_path):
        words = ("select", EXAMPLES / "accel.csv", "--band", "0.2:2", "--count", 1)
        error = run(*words, "--target", written(tmp_path), "--state", "SLC", code=2).stderr
        assert "--state: the site gives no limit state 'SLC'" in error
        error = run(*words, "--target", EXAMPLES / "target.csv", "--state", "SLV", code=2).stderr
        assert "--state has no effect" in error and "--target" in error

    def test_a_band_beyond_a_table_is_refused(self, tmp_path):
        site = written(tmp_path, {"FC": 1.35, "spectrum": [[0, 0.24], [0.4, 0.6], [1.0, 0.1]]})
        words = ("select", EXAMPLES / "accel.csv", "--band", "0.2:2", "--count", 1, "--target", site)
        assert "the target goes from 0 to 1 s" in run(*words, code=2).stderr


class OwnSite(Site):
    rare: float


class Bare(Code):
    key, name, edition, site = "bare", "bare code", "2026", OwnSite

    def verify(self, mechanism, site, control=None):
        return self.found(mechanism, {})


class Flat:
    def acceleration(self, period, damping):
        return 2.0

    def displacement(self, period, damping):
        return 2.0 * (period / 2 / pi) ** 2


class Plain(Bare):
    key = "plain"

    def demand(self, site):
        states = {"ULS": StateDemand({}, Flat(), None, [0.0], 2.0)}
        return SiteDemand([], states, "ULS", "ULS: flat at 2 m/s2.", ["A demonstration."])


class Wrong(Bare):
    key = "wrong"

    def demand(self, site):
        return {"ULS": 1.0}


class TestOtherCodes:
    @pytest.fixture(autouse=True)
    def installed(self, monkeypatch):
        module = "tests.questions.demand.test_demand"
        beside(monkeypatch, *(EntryPoint(each.key, f"{module}:{each.__name__}", "rocking.codes")
                              for each in (Bare, Plain, Wrong)))  # fmt: skip
        yield
        codes.cache_clear()

    def test_one_that_has_spectra_shows_them_in_its_own_words(self, tmp_path):
        said = run("demand", written(tmp_path, {"code": "plain", "rare": 1})).stdout
        assert said.startswith("ULS: flat at 2 m/s2.\nElastic spectra at 5 % damping, bare code (2026)")
        assert "A demonstration." in said and not [word for word in ("SLV", "a_g", "NTC") if word in said]
        data = run_json("demand", "site.yaml")
        assert data["states"]["ULS"]["acceleration"] == pytest.approx([2 / G] * len(data["periods"]))

    def test_one_that_has_none_is_said(self, tmp_path):
        file = written(tmp_path, {"code": "bare", "rare": 1})
        assert "site.yaml: bare has no response spectra of a site" in run("demand", file, code=2).stderr
        words = ("select", EXAMPLES / "accel.csv", "--band", "0.2:2", "--count", 1, "--target", file)
        assert "bare has no response spectra" in run(*words, code=2).stderr

    def test_what_is_no_demand_is_an_error_of_the_plugin(self, tmp_path):
        file = written(tmp_path, {"code": "wrong", "rare": 1})
        assert "the code wrong failed in demand: it must return a SiteDemand" in run("demand", file, code=3).stderr
