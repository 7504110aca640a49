"""An unknown outcome does not pass: in shares, ranks, verdicts, sheets and reports.

That it passes for no command is in `test_every_command.py`.
"""

import re
from dataclasses import replace
from math import isclose, nan
from types import SimpleNamespace

import numpy as np
import pytest

import rocking_cli as rk
from rocking_cli.codes.italian import dynamic
from rocking_cli.codes.italian.results import Dynamic, RecordPeak
from rocking_cli.codes.italian.sheet import summary as sheets
from rocking_cli.codes.italian.sheet.build import SHEET
from rocking_cli.codes.italian.sheet.steps import ENGLISH
from rocking_cli.core import Direction
from rocking_cli.dynamics.outcome import Outcome
from rocking_cli.questions.design.metrics import METRICS, Excitation
from rocking_cli.questions.margin import view as margin_views
from rocking_cli.questions.margin.study import Margin
from rocking_cli.questions.respond import azimuths as azimuth_views
from rocking_cli.questions.respond.azimuths import AzimuthResponses
from rocking_cli.questions.respond.each_picture import draw_azimuths
from rocking_cli.questions.survey import view as survey_views
from rocking_cli.questions.survey.picture import draw_survey
from rocking_cli.questions.survey.study import ORDERS, Survey, Surveyed, SurveyResponse
from rocking_cli.structure import Structure
from rocking_cli.studies.conclusion import Concluded, Conclusion
from rocking_cli.studies.movements import Watched, largest
from rocking_cli.studies.neighbours import Conditions, Neighbourhood, Neighbours
from rocking_cli.views.conclusion import does
from tests.cli.test_cli import run, run_json
from tests.conftest import EXAMPLES
from tests.following import respond

BLOCK = "mechanism: block\nwidth: 1\nheight: 5\nfriction: 0.3\n"
SITE = "FC: 1.2\nag: 0.9\nF0: 2.5\nTC: 0.5\nS: 1.2\n"  # so strong that the static methods fail too
PULSE = "--pulse", "sine:2g:0.4s"  # the block slides, long before it could overturn


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A block whose history ends early, and the files that commands need beside it."""
    made = tmp_path_factory.mktemp("unknown")
    files = {
        "block.yaml": BLOCK,
        "site.yaml": SITE,
        "table.csv": "file\nblock.yaml\n",
    }
    for name, text in files.items():
        (made / name).write_text(text)
    return made


class TestMargin:
    FOUND = Margin(
        Neighbourhood(20, 0.04, 0.05, 0.1), 0.3, np.array([0.5, 1.0, 2.0, 4.0]), np.array([0.0, 0.05, 0.2, 0.6]),
        np.array([0.0, 0.1, 0.4, 0.4]), pga_g=0.5, polarities=(1,),
    )  # fmt: skip

    END = Conclusion(concluded=Concluded.ROCKS, peak_ratio=0.2, motion="a", ratio=1.0, share=FOUND.share)

    def test_what_is_not_checked_is_null_and_warned_of(self):
        found = replace(self.FOUND, unknown=np.zeros(4), checked=False)
        assert margin_views.margin_data(found)["unknown"] is None
        structure, end = Structure(rk.load_structure(EXAMPLES / "curve.yaml")), self.END
        row = margin_views.MarginRow("a", 1.0, found, end)
        parts = margin_views.view(Conditions(structure, around=found.around), [row], end).parts
        assert str(parts[-1]).startswith("Caution: the joints of this mechanism are not checked")


class TestSeveral:
    def test_motions_of_unknown_outcome_are_counted_apart(self, folder):
        weak, strong = ("--pulse", "sine:0.1g:0.3s"), PULSE
        said = run("respond", folder / "block.yaml", *weak, *strong, "--neighbours", 3, "--model", "nonlinear").stdout
        counted = "has an unknown outcome under 1 of 2 motions (sine:2g:0.4s) and does not uplift under 1."
        assert f"By the nonlinear model, the structure {counted} sine:2g:0.4s governs: " in said
        assert re.search(r"0\.4s: the outcome is unknown after 0\.\d+ s: then the joint between the ground and", said)
        (row,) = (line.split() for line in said.splitlines() if line.startswith(" sine:2g"))
        assert row == ["sine:2g:0.4s", "2", "unknown", "-", "0", "%", "100", "%", "unknown"]

    def test_a_motion_that_only_slides_has_no_empty_line(self, tmp_path):
        text = "mechanism: block\nwidth: 0.8\nheight: 1.6\ndensity: 2000\ndepth: 1\nfriction: 0.3\n"
        text += "ties: [{name: hair, from: {ground: [-9, 0.8]}, to: {at: [0, 0.8]}, stiffness: 1e-6}]\n"
        (tmp_path / "squat.yaml").write_text(text, encoding="utf-8")
        motions = ("--pulse", "sine:0.45g:0.8s", "--pulse", "sine:0.05g:1s", "--neighbours", 3)
        said = run("respond", tmp_path / "squat.yaml", *motions).stdout
        assert "sine:0.45g:0.8s: the outcome is unknown after" in said and not re.search(r": *$", said, re.MULTILINE)


class TestSurvey:
    def row(self, name, **under):
        given = {"overturned": 0.0, "peak_ratio": 0.3, "worst": "a", **under}
        return Surveyed(
            1, 2, name, "arch", "positive", 0.2, 0.2, 2.0, 0.1, 1.0, 1.0, 0.9, under=SurveyResponse(**given)
        )

    def test_unknown_ranks_as_overturning_does(self):
        rows = [
            self.row("rocks far", peak_ratio=0.99),
            self.row("half falls", overturned=0.5),
            self.row("unknown", unknown=1.0, peak_ratio=nan),
            self.row("falls or may", overturned=0.25, unknown=0.5),
        ]
        ranked = sorted(rows, key=ORDERS["response"])
        assert [each.name for each in ranked] == ["unknown", "falls or may", "half falls", "rocks far"]

    def test_it_is_told_and_drawn_apart(self):
        rows = [self.row("one", unknown=1.0, peak_ratio=nan), self.row("two"), self.row("three", unknown=None)]
        found = Survey(rows, motions=["a"], by="response")
        assert [row["unknown"] for row in survey_views.data(found)["rows"]] == [1.0, 0.0, None]
        assert list(survey_views.columns(found)["unknown"][:2]) == [1.0, 0.0]
        counted = "Under a, 0 of 3 structures overturn, 1 may overturn (unknown outcome), and 3 uplift."
        assert survey_views.counts(found) == [f"{counted} one ranks first."]
        said = " ".join(survey_views.sentences(found))
        assert "one: the outcome under at least one motion is unknown" in said
        assert "the joints of three are not checked" in said
        labels = draw_survey(found, "").axes[0].get_legend_handles_labels()[1]
        assert labels == ["rocks (2)", "unknown under at least one motion (1)"]

    def test_the_limit_of_the_opening_holds_for_every_row(self, folder):
        given = "survey", folder / "table.csv", *PULSE, "--scale", 0.4  # opens a joint by less than D_cr
        rows = [run_json(*given, *more)["rows"][0] for more in ((), ("--opening", 1))]
        assert [row["unknown"] for row in rows] == [1, 0]
        assert rows[0]["peak_ratio"] is None and rows[1]["peak_ratio"] > 0


def near(overturned, unknown, median=0.3):
    return Neighbours(Neighbourhood(20), "nonlinear", overturned, (0.1, median, 0.5), 1.0, unknown=unknown)


class TestDesign:
    def test_the_share_is_the_largest_that_may_overturn(self, monkeypatch):
        monkeypatch.setattr(Excitation, "each", lambda self, structure: [near(0.3, 0.0), near(0.1, 0.5)])
        value, behind = METRICS["overturned"].at(None, Excitation([]))
        assert isclose(value, 0.6) and behind.unknown == 0.5

    @pytest.mark.every(2)
    @pytest.mark.parametrize("op", ["<", ">"])
    def test_unknown_meets_no_requirement(self, folder, op):
        found = rk.design(
            folder / "block.yaml", "width=0.99:1", f"overturned {op} 0.5", PULSE[1], neighbours=2, points=2
        )
        assert found.holds == [] and [each.unknown for each in found.behind] == [1, 1]
        assert np.isnan(found.metric).all() == (op == ">")
        assert found.to_dict()["scan"]["unknown"] == [1, 1]

    def test_a_median_that_is_unknown_is_not_said_to_overturn(self, folder):
        found = rk.design(folder / "block.yaml", "width=0.99:1", "peak_ratio < 0.5", PULSE[1], neighbours=2, points=2)
        assert np.isinf(found.metric).all() and not found.met.any()
        assert [row[1] for row in found.view.parts[1].rows] == ["unknown", "unknown"]
        labels = [line.get_label() for line in found.figure().axes[0].lines]
        assert "at least half overturn or are unknown" in labels
        assert "at least half of the neighbours overturn" not in labels


class TestAzimuths:
    def found(self):
        azimuths, no, none = np.arange(0.0, 360.0, 60.0), np.zeros(6, dtype=bool), np.full(6, nan)
        many = Outcome(
            still_rocking=no, failed=no, fell_to=np.eye(6)[0], peak_positive=none, peak_negative=none, opening=none,
            peak_rate_positive=none, peak_rate_negative=none, overturning_time=none, impact_count=np.zeros(6),
            end_time=none, warned=none, by_blocks=no, off_edge=no,
            unknown=np.array([0, 1, 1, 0, 0, 0], dtype=bool),
            peak_ratio=np.array([nan, 0.9, 0.1, 0.4, 0.3, 0.2]), known_to=np.array([nan, 1.0, 2.0, nan, nan, nan]),
            lower_bound=np.array([nan, 0.5, 0.1, nan, 0.2, nan]), uplift_time=np.ones(6), slip=np.zeros(6),
        )  # fmt: skip
        return AzimuthResponses(("x", "y"), 1.0, azimuths, np.full(6, 0.5), {"nonlinear": many})

    def test_they_are_told_apart(self):
        found = self.found()
        structure = Structure(rk.Block(width=0.5, height=2.0, name="b"))
        view = azimuth_views.view(structure, found)
        data = view.data if isinstance(view.data, dict) else view.data()
        mine = data["responses"]["nonlinear"]
        assert mine["overturned"] == [True, None, None, False, False, False]
        assert mine["sectors_unknown"] == [[60.0, 120.0]] and mine["sectors_that_overturn"] == [[0.0, 0.0]]
        bounds = mine["peak_lower_bound"]
        assert bounds[1:3] == [0.5, 0.1] and np.isnan([bounds[0], *bounds[3:]]).all()
        # The largest peak is one of a direction whose outcome is known.
        assert view.parts[2].rows == [["nonlinear", "17 %", "33 %", "0 %", "0.4", "180"]]
        assert "it overturns in 1 of 6 directions, at 0 degrees; its outcome is unknown in 2 of 6" in view.parts[3]
        assert np.isnan(azimuth_views.columns(found)["overturned"][1:3]).all()

    def test_no_curve_is_drawn_there(self):
        axes = draw_azimuths(self.found(), "", (False, False)).axes[0]
        curve, falls, _, unknown = axes.lines[:4]
        assert np.isnan(curve.get_ydata()).tolist() == [True, True, True, False, False, False, True]
        step = np.radians([[-1, -0.5, 0, 0.5, 1, nan]])
        np.testing.assert_allclose(falls.get_xdata(), step[0])
        np.testing.assert_allclose(unknown.get_xdata(), (np.radians([[60], [120]]) + step).ravel())
        words = [text.get_text() for text in axes.get_figure().legends[0].get_texts()]
        assert words == ["nonlinear", "overturns", "unknown", "critical rotation"]

    @pytest.mark.parametrize("size", [0.003, 0.3])
    def test_without_a_critical_rotation_peaks_are_in_mrad_or_degrees(self, size):
        found, of = self.found(), np.full(6, size)
        many = replace(found.outcomes["nonlinear"], peak_positive=of, peak_negative=of / 2)
        axes = draw_azimuths(replace(found, outcomes={"nonlinear": many}), "", (True, True)).axes[0]
        values, unit = (1000 * size, "mrad") if size < 0.01 else (np.degrees(size), "°")
        assert axes.lines[0].get_ydata()[3] == pytest.approx(values) and f"peak rotation [{unit}]" in axes.get_xlabel()


class TestVerification:
    """Of two variants, with FC and without, each fails for itself if a record of it is unknown."""

    def made(self, with_FC=None, without=None, d=0.01, checked=True, state="SLV"):
        known = None if with_FC is not None else d, None if without is not None else d
        records = [RecordPeak("one", d, d), RecordPeak("two", *known, with_FC, without)]
        unchecked = None if checked else "give spacing and beam_depth"
        return Dynamic(state, records, 0.25, {"SLV": 0.1, "SLC": 0.15}[state], 7, unchecked=unchecked)

    @pytest.mark.parametrize("state", ["SLV", "SLC"])
    @pytest.mark.parametrize("confident", [True, False])
    def test_unknown_does_not_pass_however_small_the_peaks_are(self, confident, state):
        found = self.made(**{"with_FC" if confident else "without": 3.0}, state=state)
        for variant in (True, False):
            passes = variant is not confident
            assert found.mean(confident=variant) == (0.01 if passes else None)
            assert found.holds(confident=variant) == passes
            assert found.passed(confident=variant) == []  # nor is it known to pass d0*
            assert found.unknown(confident=variant) == ([] if passes else ["two"])
        _, _, _, one, other, changes, _ = sheets.histories(ENGLISH, found, 1.2)
        assert f"{state}: not satisfied. The outcome under two is unknown" in (one if confident else other).text
        assert f"{state}: satisfied." in (other if confident else one).text
        assert changes.text == f"The confidence factor FC changes the verdict at {state}."

    def test_what_is_not_checked_passes_with_a_caution(self):
        found = self.made(checked=False)
        assert found.holds(confident=True)
        assert any("the joints of this mechanism are not checked" in getattr(item, "text", "")
                   for item in sheets.histories(ENGLISH, found, 1.2))  # fmt: skip

    @pytest.mark.parametrize(
        ("language", "cell", "verdict"),
        [("en", "unknown after 3.5 s", "not satisfied. The outcome under two is unknown"),
         ("it", "non noto dopo 3,5 s", "verifica non soddisfatta. L'esito sotto two non è noto")],
    )  # fmt: skip
    @pytest.mark.parametrize("state", ["SLV", "SLC"])
    def test_the_sheet_says_so_for_each_state(self, language, cell, verdict, state):
        found = self.made(with_FC=3.5, checked=False, state=state)
        _, _, grid, *said = sheets.histories(SHEET.language(language), found, 1.2)
        assert grid.rows[1][2:] == [cell, "0,01" if language == "it" else "0.01"]
        failed = [item.text for item in said if verdict in item.text]
        assert len(failed) == 1 and state in failed[0]

    def test_a_direction_that_a_polarity_overturns_is_known(self):
        falls = SimpleNamespace(fell=True, fell_to=1, unknown=False, peak_positive=nan, peak_negative=0.01)
        open_ = SimpleNamespace(fell=False, fell_to=0, unknown=True, known_to=2.0, peak_positive=0.0, peak_negative=0.1)
        chain = SimpleNamespace(displacement=lambda phi, control: 2 * phi)
        curve = SimpleNamespace(chain=chain, control=None, end=1.0, d0=1.5)
        assert dynamic._largest(curve, Direction.POSITIVE, [falls, open_]) == (None, None, None)
        assert dynamic._largest(curve, Direction.NEGATIVE, [falls, open_]) == (None, 2.0, open_)
        assert dynamic._largest(curve, Direction.NEGATIVE, [falls]) == (0.02, None, falls)

    def test_times_with_FC_are_those_of_the_record(self, folder):
        """With FC the motion is simulated 1.1 times as quick: the moment is given as one of the record."""
        found = run_json("verify", folder / "block.yaml", "--site", folder / "site.yaml", *PULSE)
        (record,) = found["directions"]["positive"]["dynamic"]["SLV"]["records"]
        assert record["d_with_FC"] is record["d_without_FC"] is None
        assert (
            0.9 < record["known_to_with_FC"] / record["known_to_without_FC"] < 1
        )  # a stronger motion opens it earlier


class TestReport:
    def test_a_pulse_alone_may_be_unknown_too(self):
        for end, said in (
            (Conclusion(concluded=Concluded.UNKNOWN, known_until=0.8), "the outcome is unknown after 0.8 s"),
            (Conclusion(concluded=Concluded.ROCKS, peak_ratio=0.2), "the structure rocks to 0.2 phi_cr"),
        ):
            assert said in does(end, "phi_cr")

    def test_movements_say_until_when_they_are_the_largest(self):
        mechanism = rk.load_structure(EXAMPLES / "masonry" / "portal.yaml")
        motion = rk.parse_pulse("sine:1g:0.5s").sampled()
        history = respond(mechanism, motion, opening=0.0, models=("nonlinear",))["nonlinear"]
        assert history.unknown
        moved = Watched(mechanism).peaks(history)
        assert moved.known_to == history.known_to and moved.points[0].horizontal > 0
        later = replace(moved, known_to=nan), replace(moved, known_to=9.0)
        assert largest([moved, *later]).known_to == history.known_to and np.isnan(largest(later[:1]).known_to)


def test_many_histories_in_python_have_no_outcome_where_it_is_unknown(folder):
    found = rk.respond_each([folder / "block.yaml", EXAMPLES / "curve.yaml"], PULSE[1], model="nonlinear")
    data = found.to_dict()["nonlinear"]
    assert np.ravel(data["overturned"]).tolist()[0] is None and np.ravel(data["unknown"]).tolist() == [True, None]
    assert "and the outcome of 1 is unknown." in found.sentences[0]
