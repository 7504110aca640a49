"""Each limit state with its own set of records: against integrations of their own, and what is concluded."""

import json
from dataclasses import replace
from functools import cache
from math import cos, sin

import numpy as np
import pytest
import yaml
from scipy.signal import lsim

import rocking_cli as rk
from rocking_cli.ask.inputs import site_of
from rocking_cli.codes.italian import dynamic as method
from rocking_cli.codes.italian.chain import Chain
from rocking_cli.codes.italian.ground import SiteGround
from rocking_cli.codes.italian.results import Dynamic, RecordPeak
from rocking_cli.codes.italian.sheet import build, figures, summary
from rocking_cli.codes.italian.sheet.steps import TERMINAL
from rocking_cli.core import Direction
from rocking_cli.dynamics.history import follow
from rocking_cli.studies.conclusion import Concluded
from rocking_cli.views.sheet.document import Drawing
from rocking_cli.views.view import Table
from tests.cli.test_cli import run, run_json
from tests.conftest import EXAMPLES
from tests.questions.verify.test_sheet import parts_of
from tests.questions.verify.test_verification_histories import FACADE, WALL, B, H, first_excursion

G, FC, PERIOD, DT = 9.80665, 1.35, 0.8, 0.002
AMPLITUDES = [0.108, 0.109, 0.110, 0.111, 0.112, 0.113, 0.114]  # g, of half sines
GROUND = {"ag": 0.05, "F0": 2.5, "TC": 0.4, "S": 1.2}
SITE = {"FC": FC, **GROUND, "SLC": {**GROUND, "ag": 0.06}, "states": ["SLV", "SLC"]}
FACTORS = {"SLV": 0.9, "SLC": 1.1}


def write_record(path, ag, period=PERIOD):
    """Write a half sine to the left, which tips to the right, and rest after it."""
    t = np.arange(0, 3 * period, DT)
    a = np.where(t < period, -ag * np.sin(np.pi * t / period), 0.0)
    path.write_text("time [s],acceleration [g]\n" + "".join(f"{x:.4f},{y:.8f}\n" for x, y in zip(t, a, strict=True)))


def filled(place):
    """Records, and a list of them for each limit state as `rocking select` writes it, with factors of their own."""
    (place / "records").mkdir()
    for k, ag in enumerate(AMPLITUDES):
        write_record(place / "records" / f"r{k}.csv", ag)
    for state, factor in FACTORS.items():
        made_set(place / state, factor)
    (place / "site.yaml").write_text(yaml.safe_dump(SITE), encoding="utf-8")
    text = f"mechanism: block\nwidth: {2 * B}\nheight: {2 * H}\none_sided: positive\nrebound: 0.0\nname: facade\n"
    (place / "b.yaml").write_text(text, encoding="utf-8")
    return place


@pytest.fixture
def own_folder(tmp_path):
    """The folder of a test that changes what is in it."""
    return filled(tmp_path)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder with further sets, in which nothing is changed."""
    place = filled(tmp_path_factory.mktemp("sets"))
    made_set(place / "strong", 1.2)
    made_set(place / "few", 1.0, count=3)
    made_set(place / "weak", 0.1)
    return place


def made_set(place, factor, count=7):
    place.mkdir(exist_ok=True)
    entries = [{"file": f"../records/r{k}.csv", "factor": factor} for k in range(count)]
    (place / "set.yaml").write_text(yaml.safe_dump({"records": entries}), encoding="utf-8")
    return place


def of_pulse(ag, confidence):
    """d under a half sine, by an integration that shares no code."""
    phi = first_excursion(ag, PERIOD, confidence)
    return H * sin(phi) + B * (1 - cos(phi))


@cache
def verified(folder, **sets):
    return rk.verify(FACADE, SITE, sets={state: folder / place for state, place in sets.items()})


def side_of(answer):
    return answer.directions[Direction.POSITIVE]


class TestNumbers:
    def test_each_state_has_mean_and_largest_of_its_own_set(self, folder):
        sides = side_of(verified(folder, SLV="SLV", SLC="SLC")).dynamic
        assert list(sides) == ["SLV", "SLC"]
        for state, at in sides.items():
            assert [each.scale_factor for each in at.records] == [pytest.approx(FACTORS[state])] * 7
            for confident, confidence in ((True, FC), (False, 1.0)):
                d = [of_pulse(FACTORS[state] * ag, confidence) for ag in AMPLITUDES]
                assert at.peaks(confident=confident) == pytest.approx(d, rel=1e-3)
                assert at.mean(confident=confident) == pytest.approx(np.mean(d), rel=1e-3)
                assert at.largest(confident=confident) == pytest.approx(max(d), rel=1e-3)
        assert sides["SLV"].mean(confident=True) < 0.8 * sides["SLC"].mean(confident=True)

    def test_it_is_as_each_set_alone_and_as_the_command(self, folder, monkeypatch):
        both = verified(folder, SLV="SLV", SLC="SLC").to_dict()["directions"]["positive"]["dynamic"]
        for state in FACTORS:
            alone = rk.verify(FACADE, SITE, motions=folder / state / "set.yaml", state=state).to_dict()
            assert alone["directions"]["positive"]["dynamic"] == {state: both[state]}
        monkeypatch.chdir(folder / "SLC")  # sets of another folder, whose paths are their own
        sets = ("--set", "SLV=../SLV", "--set", "SLC=set.yaml")
        found = run_json("verify", "../b.yaml", "--site", "../site.yaml", *sets)
        assert found["directions"]["positive"]["dynamic"] == both

    def test_a_set_that_select_wrote(self, own_folder):
        run(
            "select", own_folder / "records" / "*.csv", "--target", own_folder / "site.yaml", "--state", "SLC",
            "--band", "0.5:2", "--count", "7", "--out", own_folder / "chosen",
        )  # fmt: skip
        at = side_of(verified(own_folder, SLC="chosen")).dynamic["SLC"]
        written = yaml.safe_load((own_folder / "chosen" / "set.yaml").read_text(encoding="utf-8"))["records"]
        assert [each.scale_factor for each in at.records] == [each["factor"] for each in written]
        scaled = rk.verify(FACADE, SITE, motions=str(own_folder / "chosen" / "*.csv"), state="SLC")
        again = side_of(scaled).dynamic["SLC"]
        assert again.peaks(confident=True) == pytest.approx(at.peaks(confident=True), rel=1e-6)

    def test_scale_options_apply_to_all_sets(self, folder):
        sets = {state: folder / state for state in FACTORS}
        found = side_of(rk.verify(FACADE, SITE, sets=sets, scale=0.5)).dynamic
        assert [found[state].records[0].scale_factor for state in FACTORS] == pytest.approx([0.45, 0.55])


class TestConclusions:
    def test_both_pass(self, folder):
        found = verified(folder, SLV="SLV", SLC="SLV")
        assert found.conclusion.concluded is Concluded.SATISFIED and found.conclusion.limit_states == ["SLV", "SLC"]

    @pytest.mark.parametrize("fails", ["SLV", "SLC"])
    def test_a_state_whose_set_fails_alone_decides(self, folder, fails):
        """Its mean exceeds its capacity, but no record d0*; the other state passes with the same records, weaker."""
        found = verified(folder, **{state: "strong" if state == fails else "SLV" for state in FACTORS})
        at, end = side_of(found).dynamic, found.conclusion
        assert {state: each.holds(confident=True) for state, each in at.items()} == {
            state: state != fails for state in FACTORS
        }
        assert at[fails].passed(confident=True) == []
        assert (end.concluded, end.limit_state, end.method) == (Concluded.NOT_SATISFIED, fails, "histories")
        assert end.ratio == pytest.approx(at[fails].allowed / at[fails].mean(confident=True))
        assert f"{fails} governs (time histories" in found.sentences[0]
        assert found.to_dict()["directions"]["positive"]["dynamic"][fails]["concluded"] == "not_satisfied"

    @pytest.mark.parametrize("state", FACTORS)
    def test_unknown_in_one_set_does_not_pass(self, folder, state):
        found = verified(folder, SLV="SLV", SLC="SLV").result
        side = side_of(found)
        records = list(side.dynamic[state].records)
        records[2] = RecordPeak("r2.csv", None, 0.01, 1.5)
        one = replace(side, dynamic={**side.dynamic, state: replace(side.dynamic[state], records=records)})
        end = replace(found, directions={Direction.POSITIVE: one}).conclusion
        assert (end.concluded, end.limit_state, end.motion) == (Concluded.UNKNOWN, state, "r2.csv")
        assert not one.dynamic[state].holds(confident=True)

    def test_a_set_of_too_few_records_does_not_count_and_is_named_with_its_state(self, folder):
        found = verified(folder, SLV="SLV", SLC="few")
        end = found.conclusion
        assert end.concluded is Concluded.NOT_DECIDED and end.limit_states == ["SLV", "SLC"]
        assert [each.key for each in end.limits] == ["long"] and side_of(found).states["SLC"].T > 4
        assert [(each.name, each.state) for each in end.left_out] == [(f"r{k}.csv", "SLC") for k in range(3)]
        assert "Not counted at SLC: time histories under r0.csv, r1.csv, r2.csv" in found.sentences[0]
        short = rk.verify(FACADE, SITE, in_full=False, sets={"SLV": folder / "SLV", "SLC": folder / "few"})
        (table,) = (each for each in short.view.parts if isinstance(each, Table) and "time histories" in each.title)
        assert [(row[0], row[-1]) for row in table.rows] == [("SLV", "passes"), ("SLC", "too few")]

    def test_a_record_that_cannot_be_read_is_named(self, own_folder):
        (own_folder / "records" / "r6.csv").write_text("no numbers\n", encoding="utf-8")
        asked = ("verify", own_folder / "b.yaml", "--site", own_folder / "site.yaml")
        sets = ("--set", f"SLV={own_folder / 'SLV'}", "--set", f"SLC={own_folder / 'records' / 'r[0-3].csv'}")
        at = json.loads(run(*asked, *sets, "--json", code=5).stdout)["directions"]["positive"]["dynamic"]
        assert (at["SLV"]["refused"], at["SLC"]["refused"]) == (["r6.csv"], [])
        assert at["SLV"]["concluded"] is at["SLC"]["concluded"] is None and len(at["SLV"]["records"]) == 6
        said = run(*asked, *sets, "--all", code=5).stdout
        assert "Records of SLV that could not be used, and do not count: r6.csv." in " ".join(said.split())


class TestWrongInput:
    @pytest.mark.parametrize(
        ("options", "said"),
        [
            ("--set SLV", "--set: 'SLV' is not a set of a limit state: give STATE=PLACE"),
            ("--set SLC=SLV --set SLC=SLC", "--set has SLC twice"),
            ("--set SLV=SLV --record records/r0.csv", "--record or --pulse cannot be combined with --set"),
            ("--set SLV=SLV --state SLV", "--state cannot be combined with --set"),
            ("--set SLV=SLV --set SLD=SLC", "'SLD' is not a limit state of displacement"),
            ("--set SLV=SLV --set ULS=SLC", "'ULS' is not a limit state of displacement"),
            ("--set SLV=records", "this is a folder"),
            ("--set SLV=empty", "records must have at least 1"),
            ("--set SLV=gone", "no such file"),
        ],
    )
    def test_the_command_says_what_is_wrong(self, own_folder, monkeypatch, options, said):
        monkeypatch.chdir(own_folder)
        (own_folder / "empty").mkdir()
        (own_folder / "empty" / "set.yaml").write_text("records: []\n", encoding="utf-8")
        error = run("verify", "b.yaml", "--site", "site.yaml", *options.split(), code=2).stderr
        assert said in " ".join(error.split())

    def test_a_state_that_the_site_does_not_give(self, folder):
        site = {key: value for key, value in SITE.items() if key != "SLC"}
        with pytest.raises(rk.InputError, match="SLC is not given by the site"):
            rk.verify(FACADE, site, sets={"SLV": folder / "SLV", "SLC": folder / "SLC"})

    def test_in_python(self, folder):
        with pytest.raises(rk.InputError, match="`sets` has no ground motion for SLC"):
            rk.verify(FACADE, SITE, sets={"SLV": folder / "SLV", "SLC": []})
        with pytest.raises(rk.InputError, match="`sets` has no ground motion for any state"):
            rk.verify(FACADE, SITE, sets={})


def drawn_in(answer):
    """The figures of the parts of a sheet on the dynamic method, by the keys of the parts."""
    workings = next(each for each in parts_of(answer.result, site_of(SITE).site) if each.key == "workings")
    parts = [*workings.parts, *(below for each in workings.parts for below in each.parts)]
    return {
        part.key: [each.figure() for each in part.items if isinstance(each, Drawing)]
        for part in parts if "dynamic" in part.key or part.key == "records"
    }  # fmt: skip


class TestSheet:
    @pytest.fixture
    def drawn(self, folder):
        """The pictures of the dynamic method, by their parts."""
        found = verified(folder, SLV="SLV", SLC="SLC")
        return found, drawn_in(found)

    def test_the_history_drawn_is_that_of_the_verification(self, drawn):
        found, figures = drawn
        for state, factor in FACTORS.items():
            (figure,) = figures[f"positive-dynamic-{state}"]
            curve, peak, capacity, limit = figure.axes[0].get_lines()
            at = side_of(found).dynamic[state]
            assert peak.get_ydata()[0] == max(each.with_confidence for each in at.records)
            assert peak.get_ydata()[0] == pytest.approx(of_pulse(factor * AMPLITUDES[-1], FC), rel=1e-3)
            assert (capacity.get_ydata()[0], limit.get_ydata()[0]) == (at.allowed, at.d0)
            motion = method.with_confidence(at.scaled[-1], FC)
            own = follow(WALL.model("nonlinear"), motion)
            wanted = H * np.sin(own.phi) + B * (1 - np.cos(own.phi))
            assert np.allclose(curve.get_ydata(), wanted, rtol=1e-12, atol=1e-15)
            assert curve.get_ydata().max() == pytest.approx(peak.get_ydata()[0], rel=1e-4)
            assert peak.get_xdata()[0] == curve.get_xdata()[curve.get_ydata().argmax()]
            assert curve.get_xdata()[-1] == pytest.approx(own.time[-1] * FC**0.5)

    @pytest.mark.parametrize("polarity", ["both", "1"])
    def test_of_two_polarities_the_worse_is_drawn(self, own_folder, polarity):
        """Records to the right alone press it against its wall, until their half sine ends."""
        for k, ag in enumerate(AMPLITUDES):
            write_record(own_folder / "records" / f"r{k}.csv", -ag)
        found = rk.verify(FACADE, SITE, sets={"SLV": own_folder / "SLV"}, polarity=polarity)
        at = side_of(found).dynamic["SLV"]
        if polarity == "1":
            assert at.largest(confident=True) == 0.0
            return
        (figure,) = drawn_in(found)["positive-dynamic-SLV"]
        curve, peak, *_ = figure.axes[0].get_lines()
        assert curve.get_ydata().max() == pytest.approx(peak.get_ydata()[0], rel=1e-4)
        assert peak.get_ydata()[0] == pytest.approx(of_pulse(0.9 * AMPLITUDES[-1], FC), rel=1e-3)

    def test_the_mean_spectrum_is_that_of_oscillators_and_the_target_is_of_the_site(self, drawn):
        _, figures = drawn
        for figure, (state, ag) in zip(figures["records"], {"SLV": 0.05, "SLC": 0.06}.items(), strict=True):
            *each, legend, mean, target = figure.axes[0].get_lines()
            assert len(each) == 7 and not len(legend.get_xdata())
            T = mean.get_xdata()[50]
            w, t = 2 * np.pi / T, np.arange(0, 3 * PERIOD + 2 * T, DT / 2)
            push = np.where(t < PERIOD, G * np.sin(np.pi * t / PERIOD), 0.0)
            _, u, _ = lsim(([1.0], [1.0, 2 * 0.05 * w, w * w]), push, t)
            unit = w * w * np.abs(u).max() / G
            assert mean.get_ydata()[50] == pytest.approx(unit * FACTORS[state] * np.mean(AMPLITUDES), rel=2e-3)
            periods, sa = target.get_data()
            level = (periods > 0.14) & (periods < 0.4)
            assert level.any() and sa[level] == pytest.approx(ag * 1.2 * 2.5, rel=1e-9)
            assert sa[periods > 0.4][0] == pytest.approx(ag * 1.2 * 2.5 * 0.4 / periods[periods > 0.4][0], rel=1e-9)

    @pytest.mark.every(2)
    @pytest.mark.parametrize(("language", "heads"), [
        ("en", ["Dynamic method at SLV", "Dynamic method at SLC", "Records of the dynamic method", "scale factor"]),
        ("it", ["Metodo dinamico allo SLV", "Metodo dinamico allo SLC", "Accelerogrammi del metodo dinamico",
                "fattore di scala"]),
    ])  # fmt: skip
    def test_it_has_both_states_and_all_files(self, own_folder, language, heads):
        """Also records of the same name in two folders."""
        (own_folder / "SLC" / "set.yaml").unlink()
        for k, ag in enumerate(AMPLITUDES):
            write_record(own_folder / "SLC" / f"r{k}.csv", 1.1 * ag)
        sets = {"SLV": own_folder / "SLV", "SLC": str(own_folder / "SLC" / "*.csv")}
        rk.verify(FACADE, SITE, sets=sets, sheet=own_folder / "s.html", language=language)
        page = (own_folder / "s.html").read_text(encoding="utf-8")
        assert all(each in page for each in heads)
        for k in range(7):
            assert f"records/r{k}.csv" in page.replace("\\", "/") and f"SLC/r{k}.csv" in page.replace("\\", "/")

    @pytest.mark.parametrize("place", ["strong", "SLV", "few", "weak"])
    def test_page_one_has_what_is_concluded_of_each_set(self, folder, place):
        found = verified(folder, SLV="SLV", SLC=place)
        page, remarks, *_ = parts_of(found.result, site_of(SITE).site)
        (table,) = (each for each in page.items if isinstance(each, Table))
        at = side_of(found).dynamic["SLC"]
        (row,) = (row for row in table.rows if row[0] == "SLC, time histories")
        mean = at.mean(confident=True)
        assert row[1:3] == [f"{at.allowed:.4g} m", f"{mean:.4g} m"]
        outcomes = {"strong": "not satisfied", "SLV": "satisfied", "few": "too few records", "weak": "satisfied"}
        assert row[5] == outcomes[place]
        assert row[4] == ("–" if place in ("few", "weak") else f"{at.allowed / mean:.4g}")
        # Above 4 s enough histories are in place of the static methods, which decide nothing there.
        end = {"few": ", static methods, SLC: the verification is not decided"}.get(
            place, f", SLC: the verification is {outcomes[place]}"
        )
        said = " ".join(each.text for each in remarks.items if hasattr(each, "text"))
        assert f"Positive direction (clockwise){end}. " in said

    def test_the_table_has_mean_largest_and_capacity(self):
        records = [RecordPeak("a", 0.02, 0.01, scale_factor=2.0), RecordPeak("b", 0.04, 0.03)]
        found = Dynamic("SLC", records, 0.3, 0.18, 7)
        (table,) = (each for each in summary.histories(TERMINAL, found, 1.35) if hasattr(each, "rows"))
        assert table.rows == [
            ["a", "2", "0.02", "0.01"], ["b", "1", "0.04", "0.03"], ["mean", "", "0.03", "0.02"],
            ["largest known", "", "0.04", "0.03"], ["capacity d_SLC", "", "0.18", "0.18"],
        ]  # fmt: skip

    def test_a_structure_that_stays_at_rest_has_no_history_to_draw(self, folder):
        found = verified(folder, SLV="weak")
        assert not drawn_in(found)["positive-dynamic-SLV"]
        assert side_of(found).dynamic["SLV"].requirement.ratio == np.inf


def test_rounding_makes_no_peak_negative():
    """Its blocks moved by -6.6e-18 m at rest."""
    answer = rk.verify(
        EXAMPLES / "masonry" / "wall_of_three.yaml", SITE, motions=EXAMPLES / "accel.csv", scale=0.2
    )  # fmt: skip
    for direction, side in answer.directions.items():
        assert side.dynamic["SLV"].peaks(confident=True) == side.dynamic["SLV"].peaks(confident=False) == [0.0]
        chain = Chain(answer.mechanism, direction)
        moved = chain.moved(np.array([0.0, 1e-10]), chain.barycentre)
        assert moved[0] == 0.0 and moved[1] > 0.0


def test_spectra_of_motions_of_the_floor_are_compared_with_its_spectrum(folder):
    floor = {"z": 6.0, "H": 9.0, "T1": 0.4, "xi1": 0.05, "n": 3}
    site, say = {**SITE, "soil": "B", "floor": floor}, build.SHEET.language("en")
    ground = SiteGround(site_of(site).site)
    for on_floor, named in ((True, "the floor"), (False, "the ground")):
        found = rk.verify(FACADE, site, sets={"SLV": folder / "SLV"}, on_floor=on_floor)
        at = side_of(found).dynamic["SLV"]
        lines = figures.draw_spectra(say, at, ground, "").axes[0].get_lines()
        assert lines[-1].get_label() == f"target: {named} at SLV"
        T, target = (each[40] for each in lines[-1].get_data())
        spectrum = ground.spectrum("SLV")
        wanted = (spectrum if on_floor else spectrum.ground).acceleration(T, 0.05) / G
        assert target == pytest.approx(wanted)
        assert lines[-2].get_ydata()[40] > 0.0
