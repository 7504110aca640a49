"""`respond_each`: frames, labelled arrays and rotations against single responses, which share no code of the grid."""

import importlib.util
from math import atan, hypot, inf, nan, sin

import numpy as np
import pytest

import rocking_cli as rk
from rocking_cli.dynamics.outcome import OUTCOME_FIELDS
from rocking_cli.questions.respond import each
from tests.conftest import EXAMPLES

ACCEL = str(EXAMPLES / "accel.csv")
SCALES, POLARITIES, RESTITUTIONS = [0.5, 1.0, 4.0], [1, -1], [nan, 0.8]


def block(**fields):
    return rk.Block(**{"name": "tall", "width": 0.7, "height": 2.8} | fields)


@pytest.fixture(scope="module")
def answer():
    return rk.respond_each(
        [block(), block(name="low", height=2.0, friction=0.36)],
        [ACCEL, "sine:0.6g:0.8s"],
        model=["nonlinear", "linear1"],
        scale=SCALES,
        polarity=POLARITIES,
        restitution=RESTITUTIONS,
        histories=True,
    )


def test_each_row_is_the_response_that_it_names(answer):
    frame = answer.to_frame()
    assert len(frame) == 2 * 2 * 2 * 3 * 2 * 2
    assert list(frame["outcome"].cat.categories) == list(each.OUTCOMES) and len(set(frame["outcome"])) >= 3
    for row in frame.iloc[::7].itertuples():
        given = {} if row.Index % 2 == 0 else {"restitution": 0.8}
        body = block(**given) if row.structure == "tall" else block(name="low", height=2.0, friction=0.36, **given)
        motion = ACCEL if row.motion == "accel.csv" else row.motion
        one = rk.respond(body, motion, scale=row.scale, polarity=row.polarity, model=row.model, engine="exact")
        run = one[row.model]
        assert (row.outcome, row.impact_count) == (run.words, run.impact_count)
        assert row.restitution == pytest.approx(
            given.get("restitution", 1 - 1.5 * sin(atan(0.7 / body.height)) ** 2), rel=1e-12
        )
        known = np.nan if run.overturned is None else float(run.overturned)
        np.testing.assert_equal(
            [row.overturned, row.peak_ratio, row.uplift_time, row.known_to, row.peak_lower_bound],
            [known, np.inf if run.fell else run.peak_ratio, run.uplift_time, run.known_to, run.lower_bound],
        )
        shaken = rk.read_record(ACCEL) if row.motion == "accel.csv" else rk.parse_pulse(row.motion).sampled()
        assert row.pga_g == pytest.approx(row.scale * shaken.pga_g, rel=1e-12)
        assert row.pgv == pytest.approx(row.scale * abs(shaken.velocity).max(), rel=1e-3)
        if not run.fell:
            assert row.peak_rotation == max(run.peak_positive, run.peak_negative)
            alpha, R = atan(0.7 / body.height), hypot(0.35, body.height / 2)
            if row.peak_rotation < 1:  # the centroid of a block turns about its corner
                moved = R * (sin(alpha) - sin(alpha - row.peak_rotation))
                assert row.peak_displacement == pytest.approx(moved, rel=1e-12, abs=1e-15)
        else:
            assert row.peak_rotation == row.peak_displacement == np.inf
    assert {"rad", "rad/s", "m", "m/s", "s", "g"} == set(frame.attrs["units"].values())


def test_what_is_said_is_counted(answer):
    frame = answer.to_frame().query("model == 'nonlinear'")
    fell, unknown = ((frame["outcome"] == each).sum() for each in ("overturns", "unknown"))
    assert 0 < fell < unknown < len(frame) == 48
    said = [f"By the nonlinear model {fell} of 48 runs overturn, and the outcome of {unknown} is unknown."]
    said.append(f"Their rotations are kept at {answer.rotation['nonlinear'].shape[-1]:,} times, until 22 s.")
    assert answer.sentences == said and answer.time[-1] == pytest.approx(22.0, abs=0.02)
    legend = [text.get_text() for text in answer.plot().legends[0].get_texts()]
    assert legend == ["tall", "low", "above the line: overturns", "open: unknown, value until known_to"]
    assert answer.plot().axes[0].get_title("left") == "48 runs, nonlinear model"
    assert answer.share() == (fell / 48, (fell + unknown) / 48)


def test_joints_that_are_not_checked_are_said_of_each_structure():
    structures = [EXAMPLES / "curve.yaml", EXAMPLES / "block.yaml"]
    said = rk.respond_each(structures, EXAMPLES / "accel.csv", model="nonlinear").sentences
    assert [each.split(":")[1] for each in said if "are not checked" in each] == [" pushed facade"]


def test_rotations_are_those_of_single_responses(answer):
    rotation = answer.rotation["nonlinear"]
    assert rotation.shape == (*answer["nonlinear"].peak_ratio.shape, answer.time.size)
    for place in ((0, 0, 1, 0, 0), (0, 0, 1, 1, 0), (0, 0, 2, 0, 0), (1, 0, 0, 0, 1)):
        k, _, scale, sign, eta = place
        body = block(**({"restitution": 0.8} if eta else {}))
        body = body if k == 0 else block(name="low", height=2.0, friction=0.36, restitution=0.8)
        run = rk.respond(body, ACCEL, scale=SCALES[scale], polarity=POLARITIES[sign])["nonlinear"]
        at = np.interp(run.time, answer.time, rotation[place])
        turned = np.isfinite(run.phi) & np.isfinite(at)
        assert turned.sum() > 300
        np.testing.assert_allclose(at[turned], run.phi[turned], atol=2e-3 * np.nanmax(abs(run.phi)))
    coarse = rk.respond_each(block(), ACCEL, model="nonlinear", histories=True)  # on the samples of the record itself
    alone = rk.respond(block(), ACCEL)["nonlinear"]
    np.testing.assert_array_equal(coarse.rotation["nonlinear"][0, 0, 0][: alone.time.size], alone.phi)
    assert not coarse.rotation["nonlinear"][0, 0, 0][alone.time.size :].any()


def test_what_exceeds_a_ratio_is_known_only_as_far_as_the_model_holds(answer):
    frame, counts = answer.to_frame(), {}
    for row, exceeds in zip(frame.itertuples(), answer.exceeds(0.3), strict=True):
        if row.outcome == "overturns":
            wanted = 1.0
        elif row.outcome == "unknown":
            wanted = 1.0 if row.peak_lower_bound > 0.3 else np.nan
        else:
            wanted = float(row.peak_ratio > 0.3)
        np.testing.assert_equal(exceeds, wanted)
        counts[row.outcome, str(wanted)] = 1
    assert {("overturns", "1.0"), ("unknown", "nan"), ("rocks", "0.0"), ("rocks", "1.0")} <= set(counts)


def test_motions_are_scaled_to_a_peak_each():
    motions = [ACCEL, "ricker:1g:0.8s"]
    runs = rk.respond_each(block(), motions, model="nonlinear", target_pga=[0.4, 0.8], polarity=[1, -1])
    frame = runs.to_frame()
    np.testing.assert_allclose(frame["pga_g"], [0.4, 0.4, 0.8, 0.8] * 2, rtol=1e-12)
    assert list(runs.grid.axes) == ["structure", "motion", "target_pga", "polarity"]
    if importlib.util.find_spec("xarray"):
        arrays = runs.to_xarray()
        assert arrays.pga_g.dims == ("motion", "target_pga") and arrays.sel(
            target_pga=0.8
        ).pga_g.values == pytest.approx(0.8)
    alone = rk.respond(block(), ACCEL, target_pga=0.4, polarity=-1, model="nonlinear")["nonlinear"]
    assert 0 < runs["nonlinear"].peak_ratio[0, 0, 0, 1] == pytest.approx(alone.peak_ratio, rel=1e-6)


def test_columns_under_a_beam_have_the_restitution_that_is_given():
    frame = rk.load_structure(EXAMPLES / "symmetric_frame.yaml")
    asked = {"model": "nonlinear", "histories": True}
    many = rk.respond_each(frame, "ricker:0.6g:1.2s", scale=[0.8], restitution=[nan, 0.85], **asked)
    for k, structure in enumerate((frame, frame.replace(restitution=0.85))):
        alone = rk.respond(structure, "ricker:0.6g:1.2s", scale=0.8, model="nonlinear", engine="exact")["nonlinear"]
        assert many["nonlinear"].peak_ratio[0, 0, 0, k] == alone.peak_ratio
        assert many["nonlinear"].unknown[0, 0, 0, k] == alone.unknown
        assert np.nanmax(abs(many.rotation["nonlinear"][0, 0, 0, k])) == pytest.approx(
            np.nanmax(abs(alone.phi)), rel=0.01
        )


def test_labelled_arrays_are_the_frame(answer):
    pytest.importorskip("xarray")
    arrays, frame = answer.to_xarray(), answer.to_frame()
    assert arrays["peak_ratio"].dims == ("model", "structure", "motion", "scale", "polarity", "restitution")
    assert arrays["pga_g"].dims == ("motion", "scale") and arrays["pgv"].attrs["units"] == "m/s"
    row = frame[
        (frame.model == "linear1") & (frame.structure == "low") & (frame.motion == "accel.csv")
        & (frame.scale == 1.0) & (frame.polarity == -1) & (frame.restitution == 0.8)
    ].iloc[0]  # fmt: skip
    at = arrays.sel(model="linear1", structure="low", motion="accel.csv", scale=1.0, polarity=-1, restitution=0.8)
    assert (at.peak_ratio, at.uplift_time, at.outcome, at.pga_g) == (
        row.peak_ratio, row.uplift_time, row.outcome, row.pga_g,
    )  # fmt: skip
    assert (
        at.rotation.dims == ("t",)
        and arrays.t.attrs["units"] == "s"
        and abs(at.rotation).max() == pytest.approx(row.peak_rotation, rel=1e-2)
    )


def own_quantile(peaks, q):
    """The quantile of peaks by sorting, with interpolation between neighbours of which none is infinite."""
    order, place = sorted(peaks), q * (len(peaks) - 1)
    k, part = int(place), place - int(place)
    if part < 1e-9:
        return order[k]
    return order[k] if order[k] == order[k + 1] else (1 - part) * order[k] + part * order[k + 1]


def test_quantiles_rank_what_overturns_above_every_peak():
    pulses = [f"{shape}:0.5g:{period}s" for shape in ("sine", "ricker") for period in (0.5, 0.7, 0.9, 1.1, 1.3)]
    runs = rk.respond_each(
        [block(), block(name="low", height=2.0, friction=0.36)], pulses, model="nonlinear", scale=[0.6, 1.0, 1.6]
    )
    frame, shares = runs.to_frame(), (0.16, 0.5, 5 / 9, 0.84, 1.0)
    found = runs.quantiles(*shares, over="motion")
    assert len(found) == 2 * 3 * len(shares) and set(found.runs) == {10}
    kinds = set()
    for row in found.itertuples():
        own = frame[(frame.structure == row.structure) & (frame.scale == row.scale)]
        highest = [inf if unknown else peak for peak, unknown in zip(own.peak_ratio, own.unknown, strict=True)]
        lowest = [bound if unknown else peak for peak, unknown, bound in
                  zip(own.peak_ratio, own.unknown, own.peak_lower_bound, strict=True)]  # fmt: skip
        wanted = own_quantile(highest, row.quantile), own_quantile(lowest, row.quantile)
        assert (row.peak_ratio, row.peak_lower_bound) == pytest.approx(wanted, rel=1e-12)
        kinds.add((row.peak_ratio == inf, row.peak_lower_bound == inf))
    assert kinds == {(False, False), (True, False), (True, True)}
    both = runs.quantiles(0.5, over=["motion", "structure"])
    assert list(both) == ["model", "scale", "quantile", "peak_ratio", "peak_lower_bound", "runs"]
    assert both.runs.tolist() == [20] * 3
    with pytest.raises(rk.InputError, match=r"'record' is not an axis of these runs: structure, motion, scale"):
        runs.quantiles(0.5, over="record")
    with pytest.raises(rk.InputError, match=r"16 is not a quantile from 0 to 1"):
        runs.quantiles(16)


def test_samples_files_and_patterns_are_motions(tmp_path):
    shaking = np.stack([0.5 * np.sin(np.arange(300) / 10), 0.3 * np.cos(np.arange(300) / 9)])
    many = rk.respond_each(block(), shaking, dt=0.01, units="g", model="nonlinear")
    assert many.share() == many["nonlinear"].share()
    made = [rk.GroundMotion(f"motion {k}", 0.01, row * 9.80665, unit="m/s2") for k, row in enumerate(shaking, 1)]
    same = rk.respond_each(block(), made, model="nonlinear")
    assert list(many.grid.axes["motion"]) == ["motion 1", "motion 2"]
    np.testing.assert_array_equal(many["nonlinear"].peak_ratio, same["nonlinear"].peak_ratio)
    assert (
        rk.respond(block(), shaking[0], dt="10 ms", units="g")["nonlinear"].peak_ratio
        == many["nonlinear"].peak_ratio[0, 0, 0]
    )
    for name in ("a.csv", "b.csv"):
        (tmp_path / name).write_bytes((EXAMPLES / "accel.csv").read_bytes())
    found = rk.respond_each([block(), block()], str(tmp_path / "*.csv"), model="nonlinear", out=tmp_path / "o.parquet")
    assert list(found.grid.axes["motion"]) == ["a.csv", "b.csv"]
    assert list(found.grid.axes["structure"]) == ["tall", "tall-2"]
    read = pytest.importorskip("pandas").read_parquet(tmp_path / "o.parquet")
    assert read["peak_ratio"].tolist() == found.to_frame()["peak_ratio"].tolist()


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"polarity": [0]}, "`polarity` must be 1 or -1, got 0"),
        ({"polarity": []}, "`polarity` must be one number or a list"),
        ({"restitution": [1.5]}, "`restitution`: tall: .* at most 1.*got 1.5"),
        (
            {"structures": str(EXAMPLES / "linkage.yaml"), "restitution": [0.7, 0.9]},
            "must be at most 0.775781, got 0.9",
        ),
        (
            {"structures": str(EXAMPLES / "verify" / "facade.yaml"), "restitution": [1.0]},
            "`restitution`: facade: rebound: ",
        ),
        ({"scale": [1e5]}, "up to 4e.04 g is not plausible"),
        (
            {"motions": np.ones(50), "dt": 0.01, "units": "g", "quantity": "velocity"},
            "`quantity` describes a file, and",
        ),
        (
            {"motions": rk.GroundMotion("m", 0.01, np.ones(50), unit="m/s2"), "dt": 0.02},
            "`dt` describes a file, and no file is given",
        ),
        ({"model": []}, "`model` must have at least 1 entry"),
        ({"scale": [nan]}, "scale must be finite"),
        ({"motions": np.ones(50)}, r"`dt` is missing(?s:.*)units='g'"),
        ({"motions": np.ones(50), "dt": 0.01}, "`units` is missing"),
        (
            {"motions": np.ones((2, 2, 2)), "dt": 0.01, "units": "g"},
            r"samples must have one dimension, got an array of shape \(2, 2\)",
        ),
        (
            {"motions": np.ones((1000, 2)), "dt": 0.01, "units": "g"},
            "would be 1,000 motions of 2 samples(?s:.*)samples.T",
        ),
        ({"motions": np.ones(50), "dt": 0.01, "units": "furlong"}, "'furlong' is not a known unit"),
        ({"motions": np.full(50, nan), "dt": 0.01, "units": "g"}, "sample 1 is not a number"),
        ({"structures": []}, "`structures` must have at least 1 entry"),
        ({"scale": (each for each in (1, 2))}, "`scale` must be numbers, got a generator"),
        ({"scale": 2.0, "target_pga": 0.5}, "`scale` and `target_pga` cannot be combined"),
        (
            {"motions": np.zeros(50), "dt": 0.01, "units": "g", "target_pga": 0.5},
            "zero throughout and cannot be scaled",
        ),
        ({"eta": 0.9}, "`eta` is not an argument\n  did you mean restitution"),
        (
            {"histories": True, "scale": np.linspace(1, 2, 200_000)},
            "200,000 histories of .* are more than 200,000,000 values",
        ),
        ({"out": "runs.txt", "scales": 2.0}, "`scales` is not an argument"),
    ],
)
def test_what_cannot_be_combined_is_said(given, said):
    with pytest.raises(rk.InputError, match=said):
        rk.respond_each(**{"structures": block(), "motions": "sine:0.4g:0.8s", "model": "nonlinear"} | given)


def test_a_motion_that_is_given_twice_is_used_once_and_said():
    quake, both = rk.read_record(ACCEL), str(EXAMPLES / "accel*.csv")
    for given, left_out, used in (
        ([quake, quake, "sine:0.3g:1s"], 1, 2),
        ([both, "sine:1g:1s", ACCEL, "sine:1g:1s"], 2, 3),
    ):
        with pytest.warns(rk.DoubtWarning, match=f"a motion that is given twice is used once: {left_out} left out"):
            assert rk.respond_each(block(), given, model="nonlinear")["nonlinear"].fell.shape == (1, used, 1)


def test_a_plot_is_of_any_two_columns(answer):
    def drawn(**asked):
        return answer.figure(**asked).axes[0]

    axes = drawn()
    frame = answer.to_frame().query("model == 'nonlinear'")
    marks = sum(len(each.get_offsets()) for each in axes.collections)
    assert marks == len(frame)  # the crosses of those that overturn, and open marks of those unknown, too
    fell = frame["outcome"] == "overturns"
    highest = frame["peak_ratio"][~fell].max()
    crosses = [y for each in axes.collections for _, y in each.get_offsets() if y > highest]
    assert len(crosses) == fell.sum() > 0
    assert drawn(x="pgv", y="peak_displacement").get_xlabel() == "PGV [m/s]"
    with pytest.raises(
        rk.InputError, match="`y` must be a column of numbers, got 'peak_ration'\n  did you mean peak_ratio"
    ):
        drawn(y="peak_ration")


def test_an_unknown_run_is_that_of_respond_but_ends_there():
    """All of it is, to the last bit, but the largest opening, which `respond` follows beyond."""
    given = EXAMPLES / "masonry" / "portal.yaml", ACCEL
    one = rk.respond(*given, scale=2.1, model="nonlinear")["nonlinear"]
    many = rk.respond_each(*given, scale=2.1, model="nonlinear")["nonlinear"]
    pairs = {name: (getattr(one, name), getattr(many, name).item()) for name in OUTCOME_FIELDS}
    different = [name for name, pair in pairs.items() if not np.array_equal(*pair, equal_nan=True)]
    assert one.unknown and different == ["opening"]
    assert 0.005 < pairs["opening"][1] < pairs["opening"][0]
