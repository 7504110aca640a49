"""Maps, curves, spectra, pulses, films and plots of histories whose outcome is unknown from some moment on."""

import json
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from matplotlib.colors import to_hex
from matplotlib.patches import Rectangle

import rocking_cli as rk
from mechanisms.block import Block
from rocking_cli.ask.read import read_record
from rocking_cli.core.structure_file import load_structure
from rocking_cli.excitation.base import STANDARD_GRAVITY, GroundMotion
from rocking_cli.excitation.pulses import COARSE_POINTS_PER_PERIOD, parse_pulse
from rocking_cli.plotting import style
from rocking_cli.processing.reading import Scaled
from rocking_cli.questions.animate.picture import animation_page
from rocking_cli.questions.equivalent_pulses.verb import draw as draw_equivalent
from rocking_cli.questions.equivalent_pulses.verb import judge, under_equivalent_pulses
from rocking_cli.questions.overturning.picture import draw_comparison, draw_map
from rocking_cli.questions.overturning.study import FALLS, Comparison, Region, compare, overturning_map
from rocking_cli.questions.overturning.view import NO_JOINTS, comparison_view, map_table, map_view
from rocking_cli.questions.pulse.on_structure import MIN_SAMPLES_PER_PERIOD, _alike, sampled_history
from rocking_cli.questions.respond.picture import draw_history
from rocking_cli.questions.spectrum import view as spectrum_views
from rocking_cli.questions.spectrum.picture import draw_spectra
from rocking_cli.questions.spectrum.study import Spectrum, _worst, blocks_of, shape_of, spectra
from rocking_cli.structure import Structure
from rocking_cli.studies import under_pulses
from rocking_cli.studies.film import Film
from rocking_cli.studies.picture import picture
from rocking_cli.studies.under_pulses import outcomes, parse_shape, pulsed_model
from rocking_cli.views.animation import why_it_ends
from tests.cli.test_cli import run
from tests.conftest import EXAMPLES
from tests.dynamics.test_outcomes import made
from tests.following import respond

SINE = parse_shape("sine")
FILE = EXAMPLES / "masonry" / "portal.yaml"
PORTAL = load_structure(FILE)
ACCEL = EXAMPLES / "accel.csv"
RECORD = read_record(ACCEL).scaled(2.0)  # under which the outcome of the portal is unknown
SHAKEN = pulsed_model(Structure(PORTAL), "nonlinear", SINE)


def nonlinear(mechanism, motion):
    return respond(mechanism, motion, models=("nonlinear",))["nonlinear"]


def test_arrays_frames_and_json_agree():
    answer = rk.respond_each(FILE, ACCEL, model="nonlinear", scale=[0.1, 2.0])
    assert answer["nonlinear"].share() == (0.0, 0.5)
    np.testing.assert_array_equal(answer["nonlinear"].overturned.ravel(), [0.0, np.nan])
    np.testing.assert_array_equal(answer.to_frame()["overturned"], [0.0, np.nan])
    assert np.ravel(answer.to_dict()["nonlinear"]["overturned"]).tolist() == [False, None]


@pytest.fixture(scope="module")
def plane():
    return overturning_map(SHAKEN, SINE, SHAKEN.period(np.linspace(0.4, 3.0, 14)), np.linspace(0.5, 10, 15))


@pytest.fixture(scope="module")
def curves():
    both = [SHAKEN, pulsed_model(Structure(Block(width=0.7, height=2.8, name="block")), "nonlinear", SINE)]
    return compare(both, SINE, np.array([0.3, 0.7, 2.0]), 2.6)


@pytest.fixture(scope="module")
def histories():
    return respond(PORTAL, RECORD)


@pytest.fixture(scope="module")
def shape():
    return shape_of(Structure(PORTAL), "nonlinear")


ROUND = np.floor, np.ceil


class TestMap:
    def test_unknown_is_a_region_of_its_own(self, plane):
        assert set(plane.regions.ravel().tolist()) == set(Region)
        np.testing.assert_array_equal(plane.regions == Region.UNKNOWN, plane.outcome.unknown)
        assert plane.shares[Region.UNKNOWN] == plane.outcome.unknown.mean() > 0.1
        assert sum(plane.shares.values()) == pytest.approx(1.0)

    def test_a_point_is_unknown_as_the_single_history_is(self, plane):
        for region in (Region.UNKNOWN, Region.ROCKS):
            row, column = np.argwhere(plane.regions == region)[2]
            ag, period = plane.ag[row] * STANDARD_GRAVITY, plane.periods[column]
            alone = nonlinear(
                PORTAL, replace(SINE, amplitude=float(ag), period=float(period)).sampled(COARSE_POINTS_PER_PERIOD)
            )
            assert alone.unknown is (region is Region.UNKNOWN)
            assert plane.outcome.known_to[row, column] == pytest.approx(alone.known_to, nan_ok=True)

    def test_what_is_known_does_not_depend_on_where_knowledge_ends(self, plane):
        looser = pulsed_model(Structure(PORTAL, opening=0.5), "nonlinear", SINE)
        other = overturning_map(looser, SINE, plane.omega, plane.a)
        known = ~plane.outcome.unknown
        assert other.outcome.unknown.sum() < plane.outcome.unknown.sum()
        np.testing.assert_array_equal(other.regions[known], plane.regions[known])

    def test_it_is_neither_safe_nor_overturning(self, plane):
        again = plane.safe_again
        rows = np.searchsorted(plane.a, again[np.isfinite(again)])
        columns = np.flatnonzero(np.isfinite(again))
        assert np.isin(plane.regions[rows, columns], (Region.NO_UPLIFT, Region.ROCKS)).all()
        as_before = replace(plane, outcome=replace(plane.outcome, unknown=np.zeros_like(plane.outcome.unknown)))
        assert np.isfinite(as_before.safe_again).sum() > columns.size
        possible, least = plane.least(*FALLS, Region.UNKNOWN), plane.least(*FALLS)
        assert (possible <= np.where(np.isnan(least), np.inf, least)).all() and (possible < least).any()

    def test_of_both_polarities_the_worse_is_told_and_its_bound_is_that_of_both(self, monkeypatch):
        one = made(
            unknown=[True, True, False, True], lower_bound=[0.1, 0.5, np.nan, 0.2], peak_ratio=[0.3, 0.6, 0.9, 0.3]
        )
        other = made(
            fell_to=[0, 1, 0, 0], unknown=[False, False, False, True],
            lower_bound=[np.nan, np.nan, np.nan, 0.3], peak_ratio=[0.8, np.nan, 0.2, 0.4],
        )  # fmt: skip
        answers = {1: one, -1: other}
        monkeypatch.setattr(under_pulses, "_by_histories", lambda *given: answers[given[4]])
        lopsided = SimpleNamespace(model=SHAKEN.model, symmetric=False)
        for signs in ((1, -1), (-1, 1)):
            found = outcomes(lopsided, SINE, np.ones(4), np.ones(4), polarities=signs)
            assert found.unknown.tolist() == [True, False, False, True]
            assert found.fell.tolist() == [False, True, False, False]
            assert found.lower_bound[[0, 3]].tolist() == [0.8, 0.3]
            assert found.peak_ratio[2] == 0.9

    def test_data_and_words(self, plane):
        view = map_view(plane, PORTAL, dimensionless=False)
        data = view.data
        assert data["shares"]["unknown"] == plane.shares[Region.UNKNOWN]
        least, either = data["least_a"]["overturning"], data["least_a"]["overturning_or_unknown"]
        assert either[0] is not None and least[0] is None
        table = next(part for part in view.parts if not isinstance(part, str))
        assert table.columns[-1] == "unknown\nfrom"
        assert any("may stand or overturn" in part for part in view.parts if isinstance(part, str))
        rows = map_table(plane, PORTAL)
        hidden = np.array(rows["outcome"]) == "unknown"
        assert np.isnan(np.array(rows["peak_ratio"])[hidden]).all()
        np.testing.assert_array_equal(np.isfinite(rows["known_to [s]"]), hidden)
        np.testing.assert_array_equal(np.isfinite(rows["peak_lower_bound"]), hidden)

    def test_what_is_not_checked_is_null_and_an_equivalent_block_has_no_joints(self):
        facade = load_structure(EXAMPLES / "curve.yaml")
        for mechanism, model, said, share in (
            (facade, "nonlinear", "joints of this mechanism are not checked", None),
            (PORTAL, "linear2", NO_JOINTS, 0.0),
        ):
            shaken = pulsed_model(Structure(mechanism), model, SINE)
            found = map_view(
                overturning_map(shaken, SINE, np.array([3.0]), np.array([1.5, 2])), mechanism, dimensionless=True
            )
            assert found.data["shares"]["unknown"] == share and any(said in str(part) for part in found.parts)
            assert (found.data["least_a"]["overturning_or_unknown"] is None) is (share is None)

    def test_the_picture_has_a_hatch_of_its_own_and_no_line_through_it(self, plane):
        figure = draw_map(plane, "", dimensionless=True)
        figure.draw_without_rendering()
        (axes,) = figure.axes
        (hatch,) = [each for each in axes.patches if each.get_hatch()]
        grey = [each for each in axes.patches if to_hex(each.get_facecolor()) == style.REGIONS["unknown"]]
        assert [each.get_path() for each in grey] == [hatch.get_path()]
        assert "unknown" in [text.get_text() for text in figure.legends[0].get_texts()]
        places = np.stack(np.meshgrid(plane.omega[1:-1], plane.a[1:-1]), axis=-1).reshape(-1, 2)
        inside = hatch.get_path().contains_points(places).reshape(plane.a.size - 2, -1)
        np.testing.assert_array_equal(inside, plane.outcome.unknown[1:-1, 1:-1])
        drawn = [line for line in axes.lines if line.get_color() == style.MEASURE]
        assert drawn and all(line.get_zorder() < grey[0].get_zorder() for line in drawn)
        u, v = (
            np.interp(np.concatenate([line.get_data()[k] for line in drawn]), of, np.arange(of.size))
            for k, of in enumerate((plane.omega[::-1], plane.a))
        )
        corners = [(r(v).astype(int), plane.omega.size - 1 - c(u).astype(int)) for r in ROUND for c in ROUND]
        assert not np.all([plane.outcome.unknown[each] for each in corners], axis=0).any()


class TestCurves:
    def test_overturning_starts_between_the_two(self, curves):
        portal, block = range(2)
        np.testing.assert_array_equal(curves.possible[block], curves.least[block])
        assert curves.doubtful.tolist() == [[True, True, False], [False] * 3]
        assert np.isnan(curves.least[portal, 0]) and curves.possible[portal, 1] < curves.least[portal, 1]
        for k in (0, 1):
            around = curves.possible[portal, k] * STANDARD_GRAVITY * np.array([0.9999, 1.0001])
            found = outcomes(SHAKEN, SINE, np.full(2, curves.periods[k]), around)
            assert not found.fell.any() and found.unknown.tolist() == [False, True]

    def test_who_overturns_first_is_said_only_where_it_is_known(self):
        least = np.array([[1.0, np.nan, 2.0, 1.0, np.nan], [2.0, 1.0, 1.0, 1.0, np.nan]])
        possible = np.array([[0.5, 1.5, 0.5, 1.0, 0.5], [2.0, 1.0, 1.0, 1.0, np.nan]])
        found = Comparison((), SINE, (1,), np.arange(5.0), least, possible, 3.0)
        assert found.firsts.T.tolist() == [[True, False], [False, True], [False, False], [True, True], [False, False]]
        assert found.undecided.tolist() == [False, False, True, False, True]

    def test_it_is_said_and_drawn(self, curves):
        view = comparison_view(curves, [PORTAL, Block(width=0.7, height=2.8)])
        cells = [row[1] for row in view.parts[1].rows]
        assert cells[0].startswith(">= ") and " to " in cells[1] and float(cells[2]) == pytest.approx(0.31, abs=0.01)
        portal, block = view.data["structures"]
        assert portal["least"][0] is None and portal["possible"][0] == curves.possible[0, 0]
        assert block["possible"] == block["least"]
        assert view.data["undecided"][0] and view.data["first"][0] is None
        (axes,) = draw_comparison(curves, "").axes
        bands = [each for each in axes.collections if each.get_hatch()]
        (legend,) = axes.figure.legends
        assert len(bands) == 1 and "unknown outcome" in legend.get_texts()[-1].get_text()


class TestSpectrum:
    def test_the_structure_is_that_of_respond(self, shape, histories):
        (found,) = spectra([shape], np.array([1.0, 10.0]), [RECORD])
        alone = histories["nonlinear"]
        assert found.unknown[0, found.given] and found.lower_bound[0, found.given] == alone.lower_bound
        assert np.isinf(found.peak_ratio[0, found.given]) and found.overturned[found.given] == 0
        assert not found.unknown[0, 0] and found.overturned[0] == 1

    def test_of_both_polarities_the_worse_counts(self):
        pairs = {  # of the two polarities: overturned, unknown, failed, peak, bound
            "unknown": ((False, True, False, 0.3, 0.1), (False, False, False, 0.5, np.nan)),
            "overturns": ((False, True, False, 0.3, 0.1), (True, False, False, np.nan, np.nan)),
            "failed": ((False, True, False, 0.3, 0.1), (False, False, True, 0.5, np.nan)),
            "rocks": ((False, False, False, 0.3, np.nan), (False, False, False, 0.5, 2.0)),  # a bound of what is known
        }
        columns = [np.array(each) for each in zip(*[side for pair in pairs.values() for side in pair], strict=True)]
        fields = dict(zip(("fell_to", "unknown", "failed", "peak_ratio", "lower_bound"), columns, strict=True))
        fields |= {"peak_rate_positive": 2 * columns[3], "peak_rate_negative": columns[3]}
        peak, rate, bound = _worst(made(**fields).by_field(lambda each: each.reshape(4, 2, 1)))
        np.testing.assert_array_equal(rate, 2 * peak)
        np.testing.assert_array_equal(peak[:, 0], [np.inf, np.inf, np.nan, 0.5])
        np.testing.assert_array_equal(bound[:, 0], [0.5, np.nan, np.nan, np.nan])

    def test_a_fractile_overturns_only_if_it_does_whatever_is_unknown(self):
        peaks = np.array([[0.1, 0.1], [np.inf, np.inf], [np.inf, np.inf]])
        bounds = np.array([[np.nan, np.nan], [0.2, np.nan], [np.nan, np.nan]])
        found = Spectrum(blocks_of(0.2, "linear2"), np.array([1.0, 2.0]), peaks, peaks, bounds)
        assert found.overturned.tolist() == [1, 2] and found.doubtful.tolist() == [1, 0]
        assert np.isinf(found.fractile(0.5)).all() and found.fractile_overturns(0.5).tolist() == [False, True]
        assert found.share[0] == pytest.approx(1 / 3) and found.share_at_most[0] == pytest.approx(2 / 3)
        peaks = np.c_[peaks, [0.1, 0.1, 0.3]]
        found = replace(found, scales=np.arange(1.0, 4.0), peak_ratio=peaks, peak_rate=peaks,
                        lower_bound=np.c_[bounds, 3 * [np.nan]])  # fmt: skip
        shown = spectrum_views.ShownSpectra([found], 3 * [Scaled(RECORD, 1.0)], (0.5,), "1")
        median = next(each for each in spectrum_views._columns(shown, found) if each.head == "median")
        assert [median.cell(k) for k in range(3)] == ["unknown", "overturns", "0.1"]

    def test_data_words_and_picture(self, shape):
        motions = [RECORD, RECORD.scaled(0.5), parse_pulse("sine:1g:0.5s").sampled()]
        found = spectra([shape], np.geomspace(1, 10, 6), motions)
        results = spectrum_views.ShownSpectra(found, [Scaled(each, 1.0) for each in motions], (0.16, 0.5, 0.84), "1")
        view = spectrum_views.view(results)
        (data,) = view.data()["spectra"]
        place = data["given"]
        assert data["unknown"][place] == 2 and data["overturned"][place] == 0
        assert data["every_unknown"][0][place] and data["every_overturned"][0][place] is None
        assert data["every_peak_ratio"][0][place] is None and data["every_peak_lower_bound"][0][place] > 0
        assert data["every_overturned"][1][place] is False and data["every_peak_lower_bound"][1][place] is None
        assert "none of 3 motions is known to overturn it, the outcome of 2 is unknown" in data["verdict"]
        table = next(part for part in view.parts if not isinstance(part, str))
        assert "unknown" in table.columns and any("unknown" in row[2:5] for row in table.rows)
        above, _, below = draw_spectra(found, results.fractiles, "").axes
        assert "unknown" in [label.get_text() for label in above.get_yticklabels()]
        opened = [
            line for line in above.lines if line.get_markerfacecolor() == style.PAPER and line.get_marker() == "o"
        ]
        seen = np.isfinite(opened[0].get_ydata())
        np.testing.assert_array_equal(seen, np.isinf(found[0].fractile(0.5)) & ~found[0].fractile_overturns(0.5))
        assert seen.any() and any(each.get_hatch() for each in below.collections)

    def test_a_strength_makes_every_size_a_structure_of_its_own(self):
        stone = {"width": 0.7, "height": 2.8, "density": 2000, "depth": 1}
        weak = Block(**stone, strength={"stress": 1e6, "width": 0.05}, name="weak")
        assert shape_of(Structure(Block(**stone, name="stone")), "nonlinear").own is None
        shape = shape_of(Structure(weak), "nonlinear")
        (found,) = spectra([shape], shape.periods(np.array([0.5, 4.0])), [parse_pulse("sine:0.3g:0.8s").sampled()])
        assert found.unknown[0].tolist() == [False, False, True]  # its weight grows faster than its strength


class TestPulses:
    def test_equivalent_structures_of_which_one_is_unknown(self):
        others = [load_structure(EXAMPLES / f"{name}.yaml") for name in ("block", "frame")]
        pulse = parse_pulse("sine:0.75g:0.6s")
        found = under_equivalent_pulses([Structure(each) for each in (PORTAL, *others)], pulse)
        assert np.isnan(found.spread) and np.isnan(found.relative_spread)
        first, *rest = judge(found)
        assert "portal is unknown after 0.497 s" in first and "the other 2" in rest[0]
        known = replace(found, members=found.members[1:])
        assert rest[1:] == judge(known) and "equivalen" in rest[-1]
        assert judge(replace(found, members=found.members[:2]))[-1].endswith("is not known.")
        _, below = draw_equivalent(found).axes
        ends = [line for line in below.lines if line.get_marker() == "o" and line.get_markerfacecolor() == style.PAPER]
        assert [line.get_xdata()[0] for line in ends] == [pytest.approx(0.497 * PORTAL_P, rel=1e-2)]

    def test_json_of_a_pulse(self):
        data = json.loads(run("pulse", FILE, "--ag", "0.9g", "--period", 0.6, "--json").stdout)["responses"]
        best = data["nonlinear"]
        assert best["unknown"] is True and best["overturned"] is None and best["known_to"] == pytest.approx(0.468)
        assert best["peak_lower_bound"] <= best["peak_ratio"] and "has slid by" in best["known_to_reason"]
        assert data["linear2"]["over_nonlinear"] is None and data["linear2"]["unknown"] is False

    def test_sampling_is_not_refined_beyond_what_is_known(self):
        found = sampled_history(Structure(PORTAL), "nonlinear", parse_pulse("sine:0.9g:0.6s"))
        assert found.history.unknown and found.converged and found.per_period == 2 * MIN_SAMPLES_PER_PERIOD
        unknown = found.history
        assert _alike(unknown, replace(unknown, peak_ratio=0.5)) and not _alike(
            unknown, replace(unknown, unknown=False)
        )


PORTAL_P = SHAKEN.p


class TestFilm:
    def test_it_ends_where_knowledge_ends_and_says_so(self, histories):
        history = histories["nonlinear"]
        film = Film(picture(PORTAL), history, RECORD)
        assert history.known_to - 2 * RECORD.dt < film.end <= history.known_to < 4
        assert f"{history.known_to:.4g} s" in why_it_ends(film) and why_it_ends(film) in animation_page(film, "portal")
        known = Film(picture(PORTAL), histories["linear2"], RECORD)
        assert why_it_ends(known) == "" and known.end > 4


class TestHistory:
    def test_nothing_is_drawn_beyond_but_a_hatch(self, histories):
        until = histories["nonlinear"].known_to
        long = GroundMotion(
            "long", RECORD.dt, np.append(RECORD.acceleration, np.zeros(int(20 / RECORD.dt))), unit="m/s2"
        )
        _, below = draw_history(histories, long, "").axes
        curves = [line for line in below.lines if len(line.get_xdata()) > 2]
        assert len(curves) > 3 and all(max(line.get_xdata()) <= until for line in curves)
        (hatch,) = [each for each in below.patches if isinstance(each, Rectangle) and each.get_hatch()]
        assert hatch.get_x() == pytest.approx(until)
        assert hatch.get_x() + hatch.get_width() == pytest.approx(below.get_xlim()[1])
        words = f"unknown after {until:.4g} s"
        assert words in [text.get_text() for text in below.texts]
        labels = [text.get_text() for text in below.get_figure().legends[0].get_texts()]
        assert "nonlinear" in labels and not any("peak" in label or "overturns" in label for label in labels)
        assert until < below.get_xlim()[1] and below.get_xlabel().endswith(f"to {long.duration:.4g} s, unknown")

    def test_a_known_one_is_drawn_as_ever_and_so_is_a_linear_one_alone(self, histories):
        linear = {"linear2": histories["linear2"]}
        for runs in (linear, respond(PORTAL, RECORD.scaled(0.5))):
            _, below = draw_history(runs, RECORD, "").axes
            assert not any(each.get_hatch() for each in below.patches)
            assert all(
                line.get_xdata()[-1] == run.time[-1] for line, run in zip(below.lines[1:], runs.values(), strict=False)
            )
