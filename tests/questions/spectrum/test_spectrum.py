"""Rocking spectra against exact responses, really enlarged structures and dimensional analysis."""

from dataclasses import replace
from math import atan, cos, inf, nan, pi, sin, tan

import numpy as np
import pytest

from mechanisms.asymmetric_frame import AsymmetricFrame
from mechanisms.block import Block
from mechanisms.rigid_body import RigidBody
from rocking_cli.core import equivalent_block
from rocking_cli.dynamics.exact import exact_response
from rocking_cli.errors import InputError
from rocking_cli.excitation.base import STANDARD_GRAVITY, GroundMotion
from rocking_cli.excitation.pulses import parse_pulse
from rocking_cli.questions.spectrum.picture import draw_spectra
from rocking_cli.questions.spectrum.study import (
    Spectrum,
    SpectrumShape,
    blocks_of,
    count_histories,
    fractile,
    shape_of,
    spectra,
)
from rocking_cli.structure import Structure
from tests.following import respond

PULSE = parse_pulse("sine:0.45g:0.8s")
FRAME = {
    "column_width": 1.6, "left_height": 7.0, "right_height": 10.0, "spacing": 10.0, "beam_depth": 1.5, "depth": 2.0,
}  # fmt: skip
STONE = [[0.0, 0.0], [1.0, 0.0], [0.9, 3.2], [0.2, 3.0]]
BLOCK = {"width": 0.7, "height": 2.8}


def a_record(seed=3, pga=0.6, npts=600, dt=0.01):
    """Noise that swells and fades, with periods from 0.4 s up, so that nothing depends on single samples."""
    rng = np.random.default_rng(seed)
    t = dt * np.arange(npts)
    waves = sum(rng.normal() * np.sin(2 * pi * t / period + rng.uniform(0, 6)) for period in (0.4, 0.7, 1.1, 1.9))
    a = waves * np.sin(pi * t / t[-1])
    return GroundMotion(f"noise {seed}", dt, a * pga * STANDARD_GRAVITY / np.abs(a).max(), unit="m/s2")


def enlarged(sizes, s):
    return {key: s * value for key, value in sizes.items()}


def worst(mechanism, motion, model="nonlinear"):
    """Peak by the single history; inf if it overturns."""
    history = respond(mechanism, motion, models=(model,))[model]
    return inf if history.overturned else history.peak_ratio


class TestAgainstOtherCode:
    @pytest.mark.parametrize("kappa", [1, 2])
    def test_linear_blocks_are_those_of_the_exact_response(self, kappa):
        periods = np.geomspace(1.0, 8.0, 15)
        (found,) = spectra([blocks_of(0.25, f"linear{kappa}")], periods, [PULSE.sampled()])
        assert np.isinf(found.peak_ratio).any() and np.isfinite(found.peak_ratio).any()
        for R, peak in zip(3 * STANDARD_GRAVITY / 4 * (periods / (2 * pi)) ** 2, found.peak_ratio[0], strict=True):
            block = Block(width=2 * R * sin(0.25), height=2 * R * cos(0.25))
            exact = exact_response(equivalent_block(block), PULSE, kappa=kappa, gravity=block.gravity)
            assert exact.overturned == np.isinf(peak)
            if not exact.overturned:
                assert peak == pytest.approx(exact.peak_ratio, rel=1e-3)

    @pytest.mark.parametrize("model", ["nonlinear", "linear1"])
    def test_every_size_is_a_really_enlarged_structure(self, model):
        motion = a_record()
        makes = [
            lambda s: AsymmetricFrame(**enlarged(FRAME, s), density=2500.0),
            lambda s: Block(**enlarged(BLOCK, s)),
            lambda s: RigidBody(polygon=[[s * x, s * y] for x, y in STONE]),
        ]
        shapes = [shape_of(Structure(make(1.0)), model) for make in makes]
        kinds = set()
        for make, found in zip(makes, spectra(shapes, np.array([1.2, 2.5, 6.0]), [motion]), strict=True):
            assert found.scales.size == 4
            for scale, period, peak in zip(found.scales, found.periods, found.peak_ratio[0], strict=True):
                own = equivalent_block(make(scale))
                assert period == pytest.approx(2 * pi / min(own.positive, own.negative, key=lambda b: b.lambda_).p)
                assert peak == pytest.approx(worst(make(scale), motion, model), rel=1e-5)
                kinds.add((peak == 0, np.isinf(peak)))
        assert (False, False) in kinds and (False, True) in kinds

    def test_sizes_and_pulses_that_are_alike_in_dimensionless_terms(self):
        periods, longer = np.geomspace(1.5, 6.0, 6), 1.7
        slow = replace(PULSE, period=longer * PULSE.period).sampled()
        shape = blocks_of(0.25, "nonlinear")
        (found,) = spectra([shape], periods, [PULSE.sampled()])
        (other,) = spectra([shape], longer * periods, [slow])
        assert np.isinf(found.peak_ratio).any() and np.isfinite(found.peak_ratio).sum() >= 3
        assert other.peak_ratio == pytest.approx(found.peak_ratio, rel=1e-6)
        assert np.isfinite(spectra([shape], periods, [slow])[0].peak_ratio).sum() < np.isfinite(found.peak_ratio).sum()

    def test_blocks_of_a_slenderness_are_blocks(self):
        alpha = atan(BLOCK["width"] / BLOCK["height"])
        own, blocks = shape_of(Structure(Block(**BLOCK)), "nonlinear"), blocks_of(alpha, "nonlinear")
        here = np.array([own.period])
        assert blocks.scales(here)[0] == pytest.approx(np.hypot(0.35, 1.4))  # R in m
        found, other = spectra([own, blocks], here, [a_record(pga=0.3)])
        assert found.given == 0 and other.given is None
        assert 0 < other.peak_ratio[0, 0] < 1
        assert other.peak_ratio[0, 0] == pytest.approx(found.peak_ratio[0, 0], rel=1e-6)

    def test_what_does_not_lift_it_rocks_no_size(self):
        periods = np.geomspace(0.5, 20, 7)
        shapes = [blocks_of(0.25, "nonlinear"), blocks_of(0.25, "linear2")]
        for weak in spectra(shapes, periods, [a_record(pga=0.999 * tan(0.25))]):
            assert (weak.peak_ratio == 0).all()
        for strong in spectra(shapes, periods, [a_record(pga=1.001 * tan(0.25))]):
            assert (strong.peak_ratio > 0).all()


class TestTheStructureItself:
    def test_it_is_run_at_scale_one_whatever_the_sizes(self):
        motion, frame = a_record(), AsymmetricFrame(**FRAME, density=2500.0)
        shape = shape_of(Structure(frame), "nonlinear")
        for periods in (np.array([1.0, 2.0]), np.array([3.0, 9.0]), shape.period * np.array([0.5, 1 + 1e-12, 2])):
            (found,) = spectra([shape], periods, [motion])
            assert found.scales.size == 3 and (np.diff(found.scales) > 0).all()
            assert found.scales[found.given] == 1.0 and found.periods[found.given] == pytest.approx(shape.period)
            assert found.peak_ratio[0, found.given] == worst(frame, motion)

    def test_of_both_polarities_the_worse_counts(self):
        stone, motions = RigidBody(polygon=STONE), [a_record(k) for k in range(3)]
        shape, done = shape_of(Structure(stone), "nonlinear"), []
        periods = np.array([shape.period])
        (found,) = spectra([shape], periods, motions, polarities=(1, -1), progress=done.append)
        each = [[worst(stone, motion.scaled(sign)) for motion in motions] for sign in (1, -1)]
        assert found.peak_ratio[:, 0].tolist() == np.max(each, axis=0).tolist()
        assert np.argmax(each, axis=0).tolist() not in ([0, 0, 0], [1, 1, 1])
        assert sum(done) == count_histories([shape], periods, 3, (1, -1)) == 6

    def test_a_symmetric_structure_needs_one_polarity(self):
        shape, periods, motion = blocks_of(0.25, "nonlinear"), np.geomspace(1, 8, 5), a_record()
        one, other = (spectra([shape], periods, [motion], polarities=[sign])[0] for sign in (1, -1))
        assert one.peak_ratio == pytest.approx(other.peak_ratio, rel=1e-9)
        assert count_histories([shape], periods, 1, (1, -1)) == 5

    def test_a_restitution_given_is_that_of_every_impact(self):
        shape = shape_of(Structure(Block(**BLOCK), restitution=0.8), "nonlinear")
        (found,) = spectra([shape], np.array([shape.period]), [a_record(pga=0.4)])
        assert shape.structure.eta == 0.8
        assert found.peak_ratio[0, 0] == worst(Block(**BLOCK, restitution=0.8), a_record(pga=0.4))
        assert found.peak_ratio[0, 0] != worst(Block(**BLOCK), a_record(pga=0.4))


class TestFractiles:
    def test_overturning_is_larger_than_any_peak(self):
        peaks = np.array([[0.1, 0.1, 0.2, inf, 0.0], [0.5, 0.3, inf, inf, 0.0], [0.2, inf, inf, inf, 0.4]])
        assert fractile(peaks, 0.5).tolist() == [0.2, 0.3, inf, inf, 0.0]
        assert fractile(peaks, 0.0).tolist() == [0.1, 0.1, 0.2, inf, 0.0]
        assert fractile(peaks, 1.0).tolist() == [0.5, inf, inf, inf, 0.4]
        assert fractile(peaks, 0.25) == pytest.approx([0.15, 0.2, inf, inf, 0.0])  # half-way to the second
        assert fractile(peaks, 0.75) == pytest.approx([0.35, inf, inf, inf, 0.2])

    def test_what_could_not_be_followed_is_left_out(self):
        peaks = np.array([[nan, nan, 0.3], [0.5, nan, inf], [0.1, nan, nan], [0.3, nan, 0.1]])
        assert fractile(peaks, 0.5) == pytest.approx([0.3, nan, 0.3], nan_ok=True)
        found = Spectrum(blocks_of(0.2, "linear2"), np.array([1.0, 2.0, 3.0]), peaks, peaks)
        assert found.followed.tolist() == [3, 0, 3] and found.overturned.tolist() == [0, 0, 1]
        assert found.share == pytest.approx([0, nan, 1 / 3], nan_ok=True)

    def test_without_overturning_they_are_numpys(self):
        peaks = np.random.default_rng(1).random((17, 40))
        for q in (0.05, 0.16, 0.3, 0.5, 0.84):
            assert fractile(peaks, q) == pytest.approx(np.quantile(peaks, q, axis=0), rel=1e-12)

    def test_a_run_that_fails_is_no_overturning_and_no_peak(self):
        motions = [a_record(), replace(a_record(), acceleration=np.full(3, 1e308))]
        (found,) = spectra([blocks_of(0.2, "nonlinear")], np.array([2.0]), motions)
        assert np.isnan(found.peak_ratio).tolist() == [[False], [True]]
        assert found.followed.tolist() == [1]


class TestWrongInput:
    def test_no_motion(self):
        with pytest.raises(InputError, match="no ground motion"):
            spectra([blocks_of(0.2, "linear2")], np.array([1.0]), [])

    @pytest.mark.parametrize("alpha", [0.0, -0.1, pi / 2, 5.0, nan])
    def test_what_is_no_slenderness(self, alpha):
        with pytest.raises(InputError, match=r"alpha = atan\(b/h\)"):
            blocks_of(alpha, "linear2")

    def test_too_stocky_without_a_restitution(self):
        with pytest.raises(InputError, match="too stocky"):
            blocks_of(1.2, "nonlinear")
        assert blocks_of(1.2, "nonlinear", 0.5).structure.eta == 0.5


class TestPicture:
    @pytest.fixture
    def shapes(self):
        return [shape_of(Structure(Block(**BLOCK, name="a $1 stone")), "linear2"), blocks_of(0.1, "linear2")]

    def test_of_several_motions_it_has_the_share_below_and_marks_the_structure(self, shapes):
        found = spectra(shapes, np.geomspace(1, 10, 12), [a_record(k) for k in range(4)])
        figure = draw_spectra(found, (0.16, 0.5, 0.84), "title")
        figure.draw_without_rendering()
        above, rates, below = figure.axes
        assert below.get_xlabel().endswith("R [m]") and above.child_axes[0].get_xlabel().startswith(r"$2\pi/p$")
        stars = [[line for line in axes.lines if line.get_marker() == "*"] for axes in (above, rates, below)]
        place = found[0].given
        one = found[0]
        values = one.fractile(0.5)[place], one.fractile(0.5, one.rate_over_p)[place], one.share[place]
        for (star,), value in zip(stars, values, strict=True):
            assert star.get_xdata()[0] == pytest.approx(np.hypot(0.35, 1.4))
            if np.isfinite(value):
                assert star.get_ydata()[0] == pytest.approx(value)
        words = [text.get_text() for text in (*above.texts, *figure.legends[0].get_texts())]
        assert any("0.1 rad = 5.73°" in each for each in words)
        assert "overturns" in [label.get_text() for label in above.get_yticklabels()]

    def test_of_one_motion_it_has_two_panels(self, shapes):
        (found,) = spectra(shapes[1:], np.geomspace(1, 10, 12), [a_record(pga=0.12)])
        figure = draw_spectra([found], (0.5,), "title")
        figure.draw_without_rendering()
        assert figure.axes[-1].get_xlabel() == "half of the diagonal, R [m]"
        rates = found.peak_rate[0] / (2 * pi / found.periods)
        for axes, values in zip(figure.axes, (found.peak_ratio[0], rates), strict=True):
            np.testing.assert_allclose(axes.lines[0].get_xdata(), found.scales)
            line, finite = axes.lines[0].get_ydata(), np.isfinite(values)
            assert finite.any() and (np.isfinite(line) == finite).all()
            np.testing.assert_allclose(line[finite], values[finite], rtol=1e-12)

    def test_every_size_has_one_mark_and_few_of_those_that_overturn_for_certain_are_shown(self):
        (found,) = spectra([shape_of(Structure(Block(**BLOCK)), "linear2")], np.geomspace(0.9, 9, 40), [a_record()])
        axes, _ = draw_spectra([found], (0.5,), "title").axes
        heights = np.sort(np.concatenate([
            line.get_xdata()[np.isfinite(line.get_ydata())] for line in axes.lines if line.get_marker() == "o"
        ]))  # fmt: skip
        assert all(line.get_markevery() is None for line in axes.lines)
        np.testing.assert_allclose(heights, 2.8 * found.scales)
        falls = np.isinf(found.peak_ratio[0])
        shown = 2.8 * found.scales >= axes.get_xlim()[0]
        first = int(np.argmin(falls[shown]))  # of those shown that does not overturn
        assert falls[~shown].all() and falls[~shown].size > 3 and 1 <= first <= 6 and shown[-1]

    def test_nothing_but_overturning_and_nothing_at_all_can_be_drawn(self):
        shape = SpectrumShape(blocks_of(0.1, "linear2").structure)
        for peaks in (inf, nan):
            found = Spectrum(shape, np.array([0.5, 1.0]), np.full((2, 2), peaks), np.full((2, 2), peaks))
            draw_spectra([found], (0.5,), "title").draw_without_rendering()
