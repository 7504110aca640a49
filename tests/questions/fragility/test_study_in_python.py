"""A study of Python without a file: its motions in memory, its runs kept with its answer, its curves by limit."""

import gc
import pickle
from pathlib import Path

import numpy as np
import pytest

import rocking_cli as rk
from tests.conftest import EXAMPLES

ACCEL = EXAMPLES / "accel.csv"
TIME = 0.01 * np.arange(300)
PULSES = [f"{shape}:1g:{period}s" for shape in ("sine", "ricker", "mavroeidis") for period in (0.6, 0.9, 1.3)]
LEVELS = {"measure": "PGA", "least": 0.2, "most": 1.6, "count": 6}


def shaken(name="mine", size=3.0, **more):
    return rk.GroundMotion(name, 0.01, size * np.sin(2 * np.pi * TIME / 0.8) * np.exp(-TIME), unit="m/s2", **more)


def block(name="pillar", width=0.6):
    return rk.Block(name=name, width=width, height=2.6, restitution=0.9)


def study(records, structures=None, **more):
    structures = block() if structures is None else structures
    return rk.fragility(structures, records, method="stripes", levels=LEVELS, **more)


@pytest.fixture(scope="module")
def answer():
    return study(PULSES, limit_states=["uplift", 0.5, "25 mm", "overturning"])


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """The folder of temporary files."""
    (tmp_path / "temporary").mkdir()
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "temporary"))
    return tmp_path / "temporary"


def test_a_structure_and_motions_need_no_names():
    asked = {"method": "stripes", "levels": LEVELS, "check": True}
    named = rk.fragility(structures=block(), motions=PULSES[:2], **asked).to_dict()
    assert rk.fragility(block(), PULSES[:2], **asked).to_dict() == named
    assert rk.fragility([block()], PULSES[:2], **asked).to_dict() == named
    with pytest.raises(TypeError, match="got structures twice"):
        rk.fragility(block(), PULSES[:2], structures=block(), **asked)


class TestTheRuns:
    def test_they_last_as_long_as_the_answer_and_leave_nothing_behind(self, folder):
        first, second = study(PULSES[:2]), study(PULSES[2:])
        assert first.store.parent.parent == folder and first.store != second.store
        assert (len(first.runs()), len(second.runs())) == (12, 42)
        assert [each.name for each in Path().iterdir()] == [folder.name]
        copy = pickle.loads(pickle.dumps(first))
        runs, points, data = first.runs(), first.to_frame(), first.to_dict()
        del first
        gc.collect()
        assert list(folder.iterdir()) == [second.store.parent]
        assert copy.runs().equals(runs) and copy.to_frame().equals(points) and copy.to_dict() == data
        assert len(copy.to_cloud()[0]) == 12 and len(next(copy.run_blocks())["run"]) == 12
        assert data["store"] is None and list(copy.curves) == ["uplift", "overturning"] and copy.plot()

    def test_a_study_that_fails_leaves_nothing_behind(self, folder, monkeypatch):
        monkeypatch.setattr("rocking_cli.questions.fragility.assess.counted", lambda *given: 1 / 0)
        with pytest.raises(ZeroDivisionError):
            study(PULSES[:2])
        assert not list(folder.iterdir())

    def test_a_store_keeps_them(self):
        first = study([shaken(), *PULSES[:1]], store="kept.runs")
        assert rk.results("kept.runs").runs().equals(first.runs()) and first.to_dict()["store"].endswith("kept.runs")
        assert study([shaken(), *PULSES[:1]], store="kept.runs", limit_states=[0.3]).result[0].limit == 0.3
        with pytest.raises(rk.InputError, match="the record mine has changed"):
            study([shaken(size=3.01), *PULSES[:1]], store="kept.runs")
        with pytest.raises(rk.InputError, match="the record mine has changed"):
            study([shaken(vertical=shaken("up")), *PULSES[:1]], store="kept.runs")

    @pytest.mark.parametrize(
        "how",
        [
            {"processing": ["lowpass 8"], "factor": 1.5, "weight": 2.0},
            pytest.param({}, marks=pytest.mark.rest),
            pytest.param({"floor": "T1=0.4,xi=0.05,z=6m,H=9m,n=3"}, marks=pytest.mark.rest),
        ],
    )
    def test_those_of_a_motion_are_those_of_its_file(self, how):
        of_file, of_motion = (
            study([{"file": each, **how}, *PULSES[:3]], processing=["lowpass 12"], measures=["PGA", "Sa(0.5)"])
            for each in (ACCEL, rk.read_record(ACCEL))
        )
        assert of_motion.runs().drop(columns="motion").equals(of_file.runs().drop(columns="motion"))
        assert of_motion.to_frame().equals(of_file.to_frame())

    @pytest.mark.parametrize("part", ["vertical", "ground"])
    def test_uplift_is_not_a_step_at_lambda_if_pga_does_not_decide(self, part):
        motion = shaken(**{part: shaken("other", 2.5)})
        assert study([shaken()]).curves["uplift"].curve.median.value == pytest.approx(block().width / 2.6)
        uplift = study([motion]).curves["uplift"].curve
        assert uplift.step is None or uplift.step.low < uplift.step.high


class TestTheArguments:
    def test_motions_of_one_name_are_told_apart(self):
        runs = study([shaken(), shaken(size=2.0), shaken("mine"), rk.parse_pulse("sine:1g:0.7s")]).runs()
        assert list(dict.fromkeys(runs["motion"])) == ["mine", "mine-2", "mine-3", "sine:1g:0.7s"]

    def test_entries_may_have_motions_with_sets_and_weights(self):
        motion = shaken()
        records = [{"file": motion, "level": 0.2}, {"file": motion, "level": 1.6, "weight": 3.0}, {"file": shaken("b")}]
        found = study(records)
        assert dict(found.runs()["motion"].value_counts()) == {"b": 6, "mine at 0.2": 1, "mine at 1.6": 1}
        assert len(set(found.plan.sets.one)) == 2  # both sets have the same record

    @pytest.mark.parametrize(
        ("given", "message"),
        [
            ({"structures": "x.yaml", "seed": 3, "name": "n"}, "`seed` and `name` have no effect beside a study"),
            ({"motions": PULSES[:1], "structures": block()}, "method is missing"),
            (
                {"structures": block(), "restart": True, "motions": PULSES[:1]},
                "`restart` has no effect without a store or a study file",
            ),
            ({"motions": [object()], "structures": 3}, "study: cannot hold an object"),
            (
                {"motions": ["gone.csv"], "structures": "no.yaml"},
                r"structures\[1\]: no.yaml: no such file(.|\n)*gone.csv",
            ),
            (
                {"structures": block(), "motions": [shaken("accel.csv"), "accel.csv"]},
                "motions: two of them are called accel.csv",
            ),
            (
                {"structures": block(), "motions": [{"file": shaken(), "units": "g"}]},
                r"motions\[1\]: units, dt, channel, .* this is a ground",
            ),
            ({"structures": block(), "samples": 3}, "`motions` is missing"),
        ],
        ids=lambda value: "" if isinstance(value, dict) else value[:30],
    )
    def test_what_is_wrong_is_named(self, given, message):
        Path("accel.csv").write_bytes(ACCEL.read_bytes())
        with pytest.raises(rk.InputError, match=message):
            rk.fragility(**given)


class TestTheCurves:
    def test_by_limit_state_for_one_structure_and_measure(self, answer):
        assert list(answer.curves) == ["uplift", 0.5, "25 mm", "overturning"]
        frame = answer.to_frame()
        for each in answer.result:
            rows = frame[frame.limit_state == f"{each.limit}"]
            assert rows.x.is_monotonic_increasing and (rows.x.min(), rows.x.max()) == pytest.approx((0.2, 1.6))
            np.testing.assert_array_equal(rows[["probability", "low", "high"]].T, each.curve.lines(rows.x))
            assert answer.curves[each.limit] is each and answer.curves["pillar", each.limit, "PGA"] is each
            assert answer.curves[each.limit].median == each.curve.median
            assert answer.curves[each.limit].dispersion == each.curve.dispersion
        assert "sliding" not in answer.curves and answer.curves.get(0.7) is None
        with pytest.raises(KeyError) as raised:
            answer.curves["overturn"]
        assert isinstance(raised.value, rk.InputError)
        assert str(raised.value) == (
            "'overturn' is not a curve of this study\n  the curves are 'uplift', 0.5, '25 mm', 'overturning'"
        )

    def test_by_all_three_for_several(self):
        found = study(PULSES[:3], [block("a"), block("b", 0.8)], limit_states=["overturning"], measures=["PGA", "PGV"])
        assert list(found.curves)[:2] == [("a", "overturning", "PGA"), ("a", "overturning", "PGV")]
        assert [found.curves[key] for key in found.curves] == found.result
        with pytest.raises(rk.InputError, match=r"'overturning' stands for 4 curves\n  the curves are \('a', 'overt"):
            found.curves["overturning"]


def test_frames_have_each_fit_and_each_quantile_once():
    answer = study(PULSES[:6], limit_states=["uplift", 0.3, "overturning"], rank_measures=True)
    fits, quantiles = answer.frames["fits"], answer.frames["quantiles"]
    assert fits["limit_state"].tolist() == ["uplift", "0.3", "overturning"]
    for row, curve in zip(fits.itertuples(), answer.result, strict=True):
        assert (row.kind, row.exceedances) == (curve.curve.kind, curve.curve.exceedances)
        assert row.median == curve.median.value
    rank = {each.measure: each for each in answer.rankings[0].measures}
    assert fits["efficiency"].tolist() == [rank["PGA"].efficiency] * 3
    groups = answer.quantiles[0].groups
    assert quantiles["all_50"].tolist() == pytest.approx([each.every[1] for each in groups], nan_ok=True)
    assert (quantiles["unknown"] == 0).all() and quantiles["x"].tolist() == [each.x for each in groups]
