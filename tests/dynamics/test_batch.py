"""Many histories in one call are what each would be alone, in any order, and cost no memory to speak of."""

import tracemalloc
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from threadpoolctl import threadpool_info, threadpool_limits

import rocking_cli as rk
from mechanisms.arch import Arch
from mechanisms.asymmetric_frame import AsymmetricFrame
from mechanisms.block import Block
from rocking_cli import structure
from rocking_cli.core import Direction
from rocking_cli.core.structure_fields import DirectionalRestitution
from rocking_cli.dynamics import batch
from rocking_cli.dynamics.batch import Runs, respond_many
from rocking_cli.dynamics.deck import never_lifts, run_deck, run_lanes
from rocking_cli.dynamics.model import MODELS
from rocking_cli.dynamics.outcome import OUTCOME_FIELDS, ROTATIONS
from rocking_cli.errors import InputError
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.structure import build_models
from tests.conftest import PROJECT
from tests.following import respond
from tests.unchecked import UncheckedFrame

FRAME = {"spacing": 8.0, "left_height": 6.0, "right_height": 7.5, "column_width": 1.0, "beam_depth": 1.0, "depth": 1.0}
MECHANISMS = {
    "block": lambda k=1.0: Block(width=0.7 * k, height=2.8 * k),
    "frame": lambda k=1.0: AsymmetricFrame(density=2400.0, **{name: k * length for name, length in FRAME.items()}),
    "arch": lambda k=1.0: Arch(radius=10.0 * k, thickness=1.5 * k, inclusion_angle_deg=157.5),
}
FREE = {"free frame": lambda k=1.0: UncheckedFrame(**MECHANISMS["frame"](k).model_dump())}
COLUMNS = OUTCOME_FIELDS


@pytest.mark.parametrize("friction", [0.25, 0.8])
def test_columns_are_out_of_step_where_one_alone_is_unknown(friction):
    """On a friction by which a column that carries nothing slides, and does not overturn, three are not known."""
    frame = {"column_width": 0.5, "column_height": 2.5, "mass_ratio": 2.0, "friction": friction}
    motion = rk.parse_pulse("sine:0.5g:0.3s").sampled()
    two = respond(rk.SymmetricFrame(**frame, columns=2), motion, models=("nonlinear",))["nonlinear"]
    alone = respond(Block(width=0.5, height=2.5, friction=friction), motion, models=("nonlinear",))["nonlinear"]
    assert not (two.unknown or two.fell or alone.fell) and two.impact_count > 0
    assert alone.unknown == (friction == 0.25)
    made = rk.SymmetricFrame(**frame, columns=3)
    three = respond(made, motion, models=("nonlinear",))["nonlinear"]
    many = respond_many(build_models(made, ("nonlinear",)), [motion], Runs.of(0, 0, scale=[1.0, 1.0]))
    assert three.unknown == alone.unknown and many.unknown.tolist() == [alone.unknown] * 2
    if alone.unknown:
        assert three.apart and three.known_to == two.first_impact == many.known_to[0]


@cache
def models(name, k=1.0):
    return build_models((MECHANISMS | FREE)[name](k))


def test_models_are_built_by_one_thread_of_the_library_of_matrices(monkeypatch):
    during, build = [], structure.build

    def watched(*given, **named):
        during.extend(threadpool_info())
        return build(*given, **named)

    monkeypatch.setattr(structure, "build", watched)
    with threadpool_limits(2, "blas"):
        before = threadpool_info()
        build_models(MECHANISMS["block"](), ("nonlinear",))
        assert threadpool_info() == before
    assert {each["num_threads"] for each in during if each["user_api"] == "blas"} == {1}


@cache
def motions():
    """Records of several lengths and intervals, level and not."""
    rng = np.random.default_rng(5)
    envelope = np.hanning(120)
    shaking = [3.0 * envelope * rng.normal(size=120), 3.0 * np.sin(np.arange(61) * 0.2)]
    up = [GroundMotion("up", dt, 4.0 * rng.normal(size=n), unit="m/s2") for dt, n in ((0.02, 100), (0.0137, 300))]
    return [
        GroundMotion("level", 0.02, shaking[0], unit="m/s2"),
        GroundMotion("wave", 0.05, shaking[1], unit="m/s2"),
        GroundMotion("both", 0.02, shaking[0], vertical=up[0], unit="m/s2"),
        GroundMotion("both, at two intervals", 0.05, shaking[1], vertical=up[1], unit="m/s2"),
        GroundMotion("short", 0.01, np.array([0.0, 9.0, 0.0]), unit="m/s2"),
    ]


def same(one, other, rows=slice(None)):
    for name in COLUMNS:
        np.testing.assert_array_equal(getattr(one, name)[rows], getattr(other, name), err_msg=name)


def mixed(count=600, seed=1):
    """Any runs of six models and all records."""
    rng = np.random.default_rng(seed)
    return [*models("block"), *models("frame")], Runs.of(
        rng.integers(6, size=count),
        rng.integers(len(motions()), size=count),
        scale=rng.uniform(0.2, 2.5, size=count),
        polarity=rng.choice([1, -1], size=count),
        eta=rng.choice([np.nan, 0.6, 0.85, 0.95], size=count),
        size=rng.choice([1.0, 0.3, 2.0], size=count),
        slender=rng.choice([1.0, 0.9, 1.2], size=count),
    )


# --- one by one


@pytest.mark.every(3)
@pytest.mark.parametrize("eta", [np.nan, 0.8])
@pytest.mark.parametrize("name", MECHANISMS)
def test_every_run_is_the_history_that_respond_gives_to_the_last_bit(name, eta):
    mechanism = MECHANISMS[name]()
    scales, polarities = (0.6, 1.0, 2.3), (1, -1)
    runs = Runs.every(3, len(motions()), scales=scales, polarities=polarities, etas=(eta,))
    got = respond_many(models(name), motions(), runs)
    own = mechanism if np.isnan(eta) else mechanism.model_copy(update={"restitution": eta})
    fallen, unknown = 0, []
    for r, motion in enumerate(motions()):
        for scale in scales:
            for polarity in polarities:
                histories = respond(own, motion.scaled(scale * polarity), tail=0.0)
                for m, history in enumerate(histories.values()):
                    (k,) = np.flatnonzero(
                        (runs.model == m) & (runs.record == r) & (runs.scale == scale) & (runs.polarity == polarity)
                    )
                    fallen += history.fell
                    assert not got.failed[k]
                    for column in COLUMNS:
                        if column != "opening" or not history.unknown:
                            np.testing.assert_array_equal(getattr(got, column)[k], getattr(history, column), column)
                    if history.unknown:  # it is left where nothing is known any longer: it may open further
                        unknown.append(history.check.reason if history.check is not None else "weightless")
                        assert not got.opening[k] > history.opening
                        assert got.opening[k] > 0.005 or unknown[-1] == "weightless"
    assert 0 < fallen < len(runs)  # there is something to compare
    assert ("opens" in unknown) == (name == "arch") and "weightless" in unknown


@pytest.mark.every(3)
@pytest.mark.parametrize("k", [0.3, 4.0])
@pytest.mark.parametrize("name", MECHANISMS)
def test_a_size_is_the_structure_with_every_length_so_much_larger(name, k):
    runs = Runs.every(3, len(motions()), scales=(0.8, 1.6), sizes=(k,))
    got = respond_many(models(name), motions(), runs)
    expected = respond_many(models(name, k), motions(), Runs.every(3, len(motions()), scales=(0.8, 1.6)))
    np.testing.assert_array_equal(got.fell, expected.fell)
    np.testing.assert_array_equal(got.fell_to, expected.fell_to)
    assert not (got.failed | expected.failed).any()
    np.testing.assert_array_equal(got.unknown, expected.unknown)
    for column in (*ROTATIONS, "peak_ratio", "overturning_time", "uplift_time"):
        # The end of one that becomes unknown is that of a step, and the peak that on the way there.
        for these, within in ((~got.unknown, 1e-10), (got.unknown, 1e-6)):
            one, other = getattr(got, column)[these], getattr(expected, column)[these]
            np.testing.assert_allclose(one, other, rtol=within, err_msg=column)
    for column in ("known_to", "warned", "lower_bound"):
        np.testing.assert_allclose(getattr(got, column), getattr(expected, column), rtol=1e-6, err_msg=column)
    np.testing.assert_allclose(got.opening, expected.opening, rtol=1e-6, atol=1e-12)
    assert got.unknown.any() and not got.unknown.all()
    # The end is that of a chatter, whose last impact may count or not.
    np.testing.assert_allclose(got.end_time, expected.end_time, rtol=1e-6)
    assert abs(got.impact_count - expected.impact_count).max() <= 1
    changed = respond_many(models(name), motions(), Runs.every(3, len(motions()), scales=(0.8, 1.6)))
    rocked = (changed.peak_ratio > 0) & (got.peak_ratio > 0)
    assert np.count_nonzero(rocked) >= 3
    assert (abs(changed.peak_ratio[rocked] / got.peak_ratio[rocked] - 1) > 1e-3).all()


@pytest.mark.parametrize("k", [0.5, 2.0])
@pytest.mark.parametrize("name", ["block", "free frame"])
def test_what_is_more_slender_feels_less_of_the_horizontal_acceleration_alone(name, k):
    """And its rotations are as much larger: over the critical one they are those under the weaker motion."""
    every = [replace(model, joints=None) for model in models(name)]  # joints bear the whole acceleration
    runs = Runs.every(3, len(motions()), scales=(0.6, 1.6), polarities=(1, -1))
    got = respond_many(every, motions(), replace(runs, slender=np.full(len(runs), k)))
    weaker = [replace(motion, acceleration=motion.acceleration / k) for motion in motions()]
    expected = respond_many(every, weaker, runs)
    for column in set(COLUMNS) - set(ROTATIONS):
        np.testing.assert_array_equal(getattr(got, column), getattr(expected, column), err_msg=column)
    for column in ROTATIONS:
        np.testing.assert_array_equal(getattr(got, column), k * getattr(expected, column), err_msg=column)
    assert 0 < got.fell.sum() < len(runs)
    plain = respond_many(every, motions(), runs)
    assert (plain.peak_ratio != got.peak_ratio).any()


def test_a_run_takes_the_tables_and_the_samples_of_its_own_structure_and_record():
    every, runs = mixed(120)
    whole = respond_many(every, motions(), runs)
    for k in range(0, 120, 7):
        one = Runs.of(
            0, 0, **{name: getattr(runs, name)[k] for name in ("scale", "polarity", "eta", "size", "slender")}
        )
        same(whole, respond_many([every[runs.model[k]]], [motions()[runs.record[k]]], one), slice(k, k + 1))


# --- order, threads, progress, memory


@pytest.mark.every(2)
@pytest.mark.parametrize(("threads", "unit"), [(1, 1), (1, 10**6), (2, 7), (5, 64), (None, 256)])
def test_results_depend_neither_on_threads_nor_on_how_runs_are_dealt_out(monkeypatch, threads, unit):
    every, runs = mixed()
    expected = respond_many(every, motions(), runs, threads=1)
    monkeypatch.setattr(batch, "HISTORIES_PER_TASK", unit)
    same(respond_many(every, motions(), runs, threads=threads), expected)


def test_results_do_not_depend_on_the_order_of_the_runs():
    every, runs = mixed()
    expected = respond_many(every, motions(), runs)
    order = np.random.default_rng(3).permutation(len(runs))
    shuffled = Runs(*(getattr(runs, name)[order] for name in Runs.__dataclass_fields__))
    got = respond_many(every, motions(), shuffled)
    for name in COLUMNS:
        np.testing.assert_array_equal(getattr(got, name), getattr(expected, name)[order], err_msg=name)


@pytest.mark.parametrize("count", [1, 255, 256, 257, 600])
def test_progress_counts_every_run_once(count):
    every, runs = mixed(count)
    seen = []
    assert respond_many(every, motions(), runs, progress=seen.append).fell.size == count
    assert sum(seen) == count
    assert all(0 < part <= batch.HISTORIES_PER_TASK for part in seen)


@pytest.mark.parametrize("error", [KeyboardInterrupt, RuntimeError])
def test_an_interruption_in_progress_stops_what_has_not_begun(monkeypatch, error):
    every, runs = mixed(400)
    begun = []

    def counted(run):
        return lambda *args, **options: begun.append(args[3]) or run(*args, **options)

    def interrupt(done):
        raise error

    monkeypatch.setattr(batch, "run_deck", counted(run_deck))
    monkeypatch.setattr(batch, "run_lanes", counted(run_lanes))
    monkeypatch.setattr(batch, "HISTORIES_PER_TASK", 1)
    with pytest.raises(error):  # of released structures, as those that never lift are done before any begins
        respond_many(every, motions(), runs, release=0.2, threads=1, progress=interrupt)
    assert 1 <= len(begun) < 200


def test_memory_grows_by_a_few_numbers_a_run_and_not_by_its_samples():
    long = GroundMotion("long", 0.001, np.zeros(20_000), unit="m/s2")
    many = [Runs.of(np.zeros(count), 0) for count in (1, 1000, 11_000)]
    peaks = []
    for runs in many:  # the first call loads what is loaded once
        tracemalloc.start()
        respond_many(models("block")[:1], [long], runs)
        peaks.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
    assert (peaks[2] - peaks[1]) / 10_000 < 500
    assert peaks[1] < 10 * long.acceleration.nbytes


# --- what never lifts


NEVER = {
    **{name: lambda name=name: MECHANISMS[name]() for name in MECHANISMS},
    "block that slides before it lifts": lambda: Block(width=0.8, height=1.6, density=2000.0, depth=1.0, friction=0.3),
    "frame that slides": lambda: rk.SymmetricFrame(
        column_width=1.0, column_height=3.0, mass_ratio=1.5, density=2400.0, depth=1.0, friction=0.2
    ),
    **{file: lambda file=file: rk.load_structure(PROJECT / "examples" / file) for file in (
        "linkages/leaning_slab.yaml", "walls/facade.yaml", "masonry/cracked_facade.yaml", "verify/tied_facade.yaml"
    )},
}  # fmt: skip


@pytest.mark.every(3)
@pytest.mark.parametrize("name", NEVER)
def test_what_never_lifts_is_what_the_kernel_finds_to_the_last_bit(monkeypatch, name):
    """At, below and above each acceleration at which it lifts, or a joint fails at rest, by rounding and by far."""
    every = build_models(NEVER[name](), MODELS if name in MECHANISMS else ("nonlinear",))
    limits = {abs(limit) for model in every for limit in np.multiply(model.lambda_, model.gravity)}
    limits |= {abs(limit) for model in every if model.joints is not None for limit in model.joints.steady}
    limits = [limit for limit in limits if 0 < limit < 100]
    shares = np.array([0.5, *(1 + k * 2.0**-52 for k in range(-3, 4)), *(1 + k * 1e-12 for k in (-2, 1, 2)), 1.2])
    uneven = [one.scaled(sign / one.acceleration[k]) for one in motions()[:3] for k, sign in (
        (one.acceleration.argmax(), 1), (one.acceleration.argmin(), -1)
    )]  # fmt: skip
    scales, signs = np.outer(limits, shares).ravel(), (1, -1)
    runs = Runs.every(len(every), len(uneven), scales=scales, polarities=signs, sizes=(1.0, 0.7))
    runs = replace(runs, slender=np.where(np.arange(len(runs)) % 3 == 0, 1.1, 1.0))
    short = []
    monkeypatch.setattr(batch, "never_lifts", lambda *given: short.append(never_lifts(*given)) or short[0])
    got = respond_many(every, uneven, runs, only_peaks=True)
    monkeypatch.setattr(batch, "never_lifts", lambda _, rows: np.zeros(len(rows), bool))
    same(got, respond_many(every, uneven, runs, only_peaks=True))
    at_rest = np.isnan(got.uplift_time) & np.isnan(got.warned) & np.isin(runs.record, (0, 1, 2, 3))
    assert short[0].sum() >= at_rest[short[0]].sum() > 0.9 * at_rest.sum() > 0


# --- which runs


def test_every_combination_comes_in_the_order_of_the_arguments():
    runs = Runs.every(2, 2, scales=(0.5, 1.0, 1.5), polarities=(1, -1), etas=(0.8, 0.9), sizes=(1.0, 2.0, 3.0))
    assert len(runs) == 2 * 2 * 3 * 2 * 2 * 3
    rows = list(zip(runs.model, runs.record, runs.scale, -runs.polarity, runs.eta, runs.size, strict=True))
    assert rows == sorted(set(rows))


def test_numbers_hold_for_all_runs():
    runs = Runs.of([0, 1, 2], 1, scale=[1.0, 2.0, 3.0], eta=0.9)
    assert runs.record.tolist() == [1, 1, 1]
    assert runs.polarity.tolist() == [1, 1, 1]
    assert runs.size.tolist() == [1.0, 1.0, 1.0]
    assert runs.slender.tolist() == [1.0, 1.0, 1.0]
    assert (runs.eta == 0.9).all()
    assert len(Runs.of(0, 0)) == 1
    assert np.isnan(Runs.of(0, 0).eta).all()


def test_no_runs_are_no_responses():
    nothing = Runs.every(0, 0)
    assert respond_many(models("block"), motions(), nothing).fell.size == 0
    assert respond_many([], [], nothing, progress=lambda done: None).fell.size == 0


@pytest.mark.parametrize(
    ("wrong", "what"),
    [
        ({"model": -1}, "run 0: model must be a place"),
        ({"model": 0.5}, "every model of a run must be a whole number"),
        ({"record": np.nan}, "every record of a run must be a whole number"),
        ({"polarity": 1.5}, "every polarity of a run must be a whole number"),
        ({"polarity": 0}, "run 0: polarity must be 1 or -1, got 0"),
        ({"scale": [1.0, np.nan]}, "run 1: scale must be finite"),
        ({"eta": 0.0}, "run 0: eta must be positive, got 0"),
        ({"eta": [[0.5, 0.5], [np.nan, -0.1]]}, r"run 1: eta must be positive, got -0\.1"),
        ({"eta": np.inf}, "eta must be positive"),
        ({"eta": [[0.5, 0.5, 0.5]], "scale": [1.0, 2.0]}, "differ in length"),
        ({"size": 0.0}, "run 0: size must be positive"),
        ({"size": np.inf}, "size must be positive"),
        ({"slender": 0.0}, "run 0: slender must be positive"),
        ({"slender": np.nan}, "slender must be positive"),
        ({"model": [0, 1], "slender": [1.0, 2.0, 3.0]}, "differ in length"),
    ],
)
def test_wrong_runs_are_refused(wrong, what):
    with pytest.raises(InputError, match=what):
        Runs.of(**{"model": 0, "record": 0, **wrong})


def test_restitution_is_at_most_one_or_what_keeps_all_energy():
    """Which for the frame is above 1 on one side: the square root of the ratio of its inertias at rest."""
    with pytest.raises(InputError, match=r"run 2: eta must be in \(0, 1\], got 1.01"):
        respond_many(models("block"), motions(), Runs.of(0, 0, eta=[0.5, np.nan, 1.01]))
    frame = MECHANISMS["frame"]()
    inertia = {side: frame.kinetic_inertia(np.zeros(1), side)[0] for side in Direction}
    most = {side: max(1.0, np.sqrt(inertia[side] / inertia[side.opposite])) for side in Direction}
    assert max(most.values()) > 1.001  # else this says little
    for column, side in enumerate(Direction):
        etas = np.full((2, 2), 0.5)
        etas[:, column] = most[side] * np.array([1 - 1e-6, 1 + 1e-6])
        respond_many(models("frame"), motions(), Runs.of(0, 0, eta=etas[:1]))
        with pytest.raises(InputError, match="run 1: eta must be in"):
            respond_many(models("frame"), motions(), Runs.of(0, 0, eta=etas))


@pytest.mark.parametrize("name", ["block", "frame"])
def test_each_direction_may_have_its_own_restitution(name):
    given = {"positive_to_negative": 0.9, "negative_to_positive": 0.6}
    alone = MECHANISMS[name]().model_copy(update={"restitution": DirectionalRestitution(**given)})
    found = respond_many(models(name)[:1], motions(), Runs.of(0, range(5), eta=np.tile([0.9, 0.6], (5, 1))))
    same(found, respond_many(build_models(alone)[:1], motions(), Runs.every(1, 5)))


@pytest.mark.parametrize("release", [0.4, -0.7])
def test_a_release_is_that_of_respond(release):
    for motion in (None, motions()[0]):
        alone = respond(MECHANISMS["frame"](), motion, release=release)
        found = respond_many(models("frame"), [motion], Runs.every(3, 1), release=release)
        for k, name in enumerate(MODELS):
            assert found.impact_count[k] == alone[name].impact_count
            assert found.fell[k] == alone[name].fell
            assert alone[name].fell or found.peak_ratio[k] == alone[name].peak_ratio


def test_a_model_or_a_record_that_is_not_there_is_refused():
    with pytest.raises(InputError, match="run 1: there is no model 3, only 3"):
        respond_many(models("block"), motions(), Runs.of([0, 3], 0))
    with pytest.raises(InputError, match="run 2: there is no record 5, only 5"):
        respond_many(models("block"), motions(), Runs.of(0, [0, 4, 5]))


@pytest.mark.parametrize(
    "wrong", [{"threads": 0}, {"threads": -1}, *({"rtol": each} for each in (0.0, 9e-15, 1.0, np.nan))]
)
def test_no_threads_and_a_tolerance_outside_its_range_are_refused(wrong):
    with pytest.raises(InputError, match=f"{next(iter(wrong))} must be"):
        respond_many(models("block"), motions(), Runs.of(0, 0), **wrong)


def test_a_run_that_cannot_be_followed_is_said_to_have_failed_and_stops_no_other():
    runs = Runs.of(0, 2, scale=[1.0, 1e308, 1.0])
    got = respond_many(models("block"), motions(), runs)
    assert got.failed.tolist() == [False, True, False]
    assert not got.fell[1]
    assert got.peak_ratio[0] == got.peak_ratio[2]
