"""The pictures show what happened, in print and in grey, however long the record."""

from contextlib import nullcontext
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.text import Text

from mechanisms.block import Block
from rocking_cli.dynamics.model import MODELS
from rocking_cli.excitation.base import STANDARD_GRAVITY, GroundMotion
from rocking_cli.excitation.measures import measure
from rocking_cli.excitation.pulses import parse_pulse
from rocking_cli.plotting import style
from rocking_cli.plotting.style import BINS_ACROSS, visible
from rocking_cli.questions.record.picture import draw_record
from rocking_cli.questions.respond.picture import MIN_IMPACT_RATE, draw_history
from rocking_cli.structure import Structure
from rocking_cli.studies.contact import Contacts
from rocking_cli.studies.movements import Watched
from tests.following import respond

BLOCK = Block(width=0.7, height=2.8)
PULSE = GroundMotion("pulse", 0.01, -0.35 * STANDARD_GRAVITY * np.sin(np.linspace(0, 2 * np.pi, 81)), unit="m/s2")


def words(axes):
    """All words in and below a panel."""
    figure, legend = axes.get_figure(), axes.get_legend()
    keys = [*figure.legends, *([legend] if legend is not None else [])]
    return [text.get_text() for text in (*axes.texts, *(text for key in keys for text in key.get_texts()))]


def test_the_record_stands_above_and_the_responses_below_with_their_impacts():
    histories = respond(BLOCK, PULSE)
    motion = replace(PULSE, vertical=PULSE.scaled(0.5))
    above, below = draw_history(histories, motion, "a block", structure=Structure(BLOCK)).axes
    assert above.get_title(loc="left") == "a block"
    np.testing.assert_allclose(above.get_lines()[0].get_ydata(), PULSE.acceleration / STANDARD_GRAVITY)
    assert "pulse, PGA 0.35 g" in words(above)
    nonlinear, *others = below.get_lines()[1:4]
    run = histories["nonlinear"]
    np.testing.assert_array_equal(nonlinear.get_ydata(), run.ratio)
    assert nonlinear.get_label() == "nonlinear"
    for line, other in zip(others, (histories["linear1"], histories["linear2"]), strict=True):
        at = other.time[np.abs(other.ratio).argmax()]
        assert line.get_label().endswith(f": peak {other.peak_ratio:.3g} $\\phi_{{cr}}$ at {at:.4g} s")
    (marked,) = (line for line in below.get_lines() if line.get_marker() == "|")
    assert marked.get_label() == f"impacts, nonlinear, {100 * MIN_IMPACT_RATE:g} % of the strongest or more"
    np.testing.assert_array_equal(marked.get_xdata(), run.felt[:, 0])
    assert 0 < len(run.felt) < run.impact_count
    assert "time [s]" in below.get_xlabel() and "phi" in below.get_ylabel()
    np.testing.assert_allclose(above.get_lines()[1].get_ydata(), 0.5 * PULSE.acceleration / STANDARD_GRAVITY)
    assert "uplift at ±0.25 g without the vertical motion" in words(above) and "does not uplift" not in words(below)


def test_what_happens_is_marked_on_the_curve_and_named_below():
    structure = Structure(BLOCK)
    run = respond(BLOCK, PULSE, models=("nonlinear",))["nonlinear"]
    axes = draw_history({"nonlinear": run}, PULSE, "a block", structure=structure).axes[1]
    moved = Watched(BLOCK).peaks(run).points[0].horizontal
    k = int(np.abs(run.ratio).argmax())
    uplift, peak = (line for line in axes.lines if line.get_label().startswith(("uplift", "peak")))
    assert (uplift.get_xdata()[0], peak.get_xdata()[0]) == pytest.approx((run.uplift_time, run.time[k]))
    assert peak.get_ydata()[0] == run.ratio[k]
    named = f"peak {run.peak_ratio:.3g} $\\phi_{{cr}}$ at {run.time[k]:.4g} s, top {1000 * moved:.3g} mm"
    assert {named, f"uplift at {run.uplift_time:.4g} s"} <= set(words(axes))


def test_the_axes_fit_what_happens_end_at_a_tick_and_say_what_is_left_out():
    """A motion of 40 s of which the structure rocks for a few, and hardly: .05 phi_cr fills the panel."""
    shaking = np.concatenate([np.zeros(1000), PULSE.scaled(0.8).acceleration, np.zeros(3000)])
    motion = GroundMotion("late", 0.01, shaking, unit="m/s2")
    run = respond(BLOCK, motion, models=("nonlinear",))["nonlinear"]
    assert 0.005 < run.peak_ratio < 0.05 and run.at_rest
    axes = draw_history({"nonlinear": run}, motion, "a block").axes[1]
    low, high = axes.get_ylim()
    assert np.ptp(run.ratio) > 0.6 * (high - low) and low < run.ratio.min() and run.ratio.max() < high
    start, end = axes.get_xlim()
    assert start < run.uplift_time < run.end_time < end < 25 and {start, end} <= set(axes.get_xticks())
    assert axes.get_xlabel() == f"time [s]; not shown: 0 to {start:g} s and {end:g} to {motion.duration:.4g} s, at rest"
    cut = GroundMotion("cut", 0.01, shaking[: int(run.uplift_time / 0.01) + 30], unit="m/s2")
    short = respond(BLOCK, cut, models=("nonlinear",), tail=0.0)["nonlinear"]
    label = draw_history({"nonlinear": short}, cut, "a block").axes[1].get_xlabel()
    assert short.end_time > short.time[-1] and label.endswith(f"to {short.end_time:.4g} s, still moving")


@pytest.mark.every(2)
@pytest.mark.parametrize("narrow", [True, False])
def test_nothing_is_cut_off_or_on_another_word(narrow):
    histories = respond(BLOCK, PULSE, models=("nonlinear",))
    motion = replace(PULSE, name="a ground motion with quite a long name, longer than a phone is wide")
    with style.on_phone() if narrow else nullcontext():
        figures = [
            draw_history(histories, motion, "a block with a long name " * 3, structure=Structure(BLOCK)),
            draw_record(motion, measure(motion)),
        ]
    for figure in figures:
        figure.draw_without_rendering()
        shown = [text for text in figure.findobj(Text) if text.get_text() and text.get_visible()]
        boxes = {text: text.get_window_extent() for text in shown}
        labels = [text for axes in figure.axes for axis in (axes.xaxis, axes.yaxis) for text in axis.get_ticklabels()]
        for text in (each for each in shown if each not in labels):
            assert figure.bbox.x0 <= boxes[text].x0 and boxes[text].x1 <= figure.bbox.x1
            assert not any(boxes[text].overlaps(boxes[each]) for each in shown if each is not text), text


def test_a_title_is_as_long_as_there_is_room_for():
    wide, narrow = (f"{letter * 6} " * 20 for letter in "Wi")
    for text in (wide, narrow, "W" * 300, "a $ and _ and ^"):
        short = style.fitted(text)
        assert style.size_of(style.plain(short), style.TITLE).real <= style.PAGE_WIDTH - 0.3
    assert len(style.fitted(wide)) < len(style.fitted(narrow))
    assert style.fitted("a $ and _") == "a $ and _"
    assert style.fitted("\udcff\x1b a") == "\udcff\x1b a"  # it is spelled out when it is written


def test_overturning_is_named_where_the_curve_passes_the_critical_rotation():
    motion = PULSE.scaled(5.0)
    run = respond(BLOCK, motion, models=("nonlinear",))["nonlinear"]
    axes = draw_history({"nonlinear": run}, motion, "a block").axes[1]
    (cross,) = [line for line in axes.lines if line.get_marker() == "x"]
    assert cross.get_xydata().tolist() == [[run.overturning_time, run.fell_to]]
    assert f"overturns at {run.overturning_time:.4g} s" in words(axes) and "critical rotation" in words(axes)
    assert np.interp(run.overturning_time, *axes.lines[1].get_data()) == pytest.approx(run.fell_to, abs=0.01)
    assert 1 < np.abs(axes.lines[1].get_ydata()).max() < 1.6


def test_overturning_after_the_last_sample_is_in_the_legend():
    block, motion = Block(width=2.0, height=20.0), parse_pulse("sine:0.12g:4s").sampled()
    run = respond(block, motion, models=("nonlinear",), tail=1.0)["nonlinear"]
    assert run.fell and run.overturning_time > run.time[-1]
    axes = draw_history({"nonlinear": run}, motion, "a block").axes[1]
    assert f"nonlinear: overturns at {run.overturning_time:.4g} s, after the last sample" in words(axes)
    assert not any(line.get_marker() == "x" for line in axes.lines)
    assert axes.get_xlabel() == f"time [s]; not shown: 5 to {run.overturning_time:.4g} s, still moving"


@pytest.mark.parametrize("motion", [None, PULSE.scaled(0.01)])
def test_a_free_motion_and_a_structure_at_rest_can_be_drawn(motion):
    histories = respond(BLOCK, motion, release=0.3 if motion is None else None)
    figure = draw_history(histories, motion, "quiet")
    assert len(figure.axes) == (1 if motion is None else 2)


def test_a_reversed_record_has_a_panel_of_its_own():
    histories = respond(BLOCK, PULSE)
    other = respond(BLOCK, PULSE.scaled(-1), models=("linear1",))
    figure = draw_history(histories, PULSE, "a block", other)
    _, one, two = figure.axes
    assert (one.get_title(loc="left"), two.get_title(loc="left")) == ("polarity 1", "polarity -1")
    np.testing.assert_array_equal(two.get_lines()[1].get_ydata(), other["linear1"].ratio)
    assert one.get_ylim() == two.get_ylim()


def grey(color):
    red, green, blue = (int(color[k : k + 2], 16) / 255 for k in (1, 3, 5))
    return 0.299 * red + 0.587 * green + 0.114 * blue


def test_the_lines_differ_in_grey_by_tone_dash_and_weight():
    looks = [style.LINES[name] for name in MODELS]  # free blocks are drawn beside the nonlinear model alone
    for key in ("linestyle", "linewidth"):
        assert len({look[key] for look in looks}) == len(looks)
    tones = sorted(grey(look["color"]) for look in looks)
    assert np.diff(tones).min() > 0.15 and tones[-1] < 0.7
    assert abs(grey(style.LINES["blocks"]["color"]) - grey(style.LINES["nonlinear"]["color"])) > 0.15


def test_a_record_is_drawn_with_its_integrals_and_the_build_up():
    measures = measure(PULSE)
    figure = draw_record(PULSE, measures)
    labels = [axes.get_ylabel() for axes in figure.axes]
    arias = f"Arias intensity\n[% of {measures.arias:.3g} m/s]"
    assert labels == ["acceleration [g]", "velocity [m/s]", "displacement [m]", arias]
    assert figure.axes[-1].get_xlabel() == "time [s]"
    np.testing.assert_allclose(figure.axes[1].get_lines()[0].get_ydata(), PULSE.velocity)
    built = figure.axes[3].get_lines()[0].get_ydata()
    assert built[0] == 0 and built[-1] == pytest.approx(100) and (np.diff(built) >= 0).all()
    marks = [(line.get_xdata()[0], line.get_ydata()[0]) for line in figure.axes[3].get_lines()[1:]]
    assert marks == [(measures.t_5, 5), (measures.t_95, 95)]
    peak = figure.axes[1].get_lines()[-1]
    assert abs(peak.get_ydata()[0]) == pytest.approx(measures.pgv) and peak.get_label() in words(figure.axes[1])
    assert peak.get_label() == f"PGV {measures.pgv:.3g} m/s"
    assert f"95 % at {measures.t_95:.4g} s" in words(figure.axes[3])


def test_a_record_of_zeros_can_be_drawn():
    still = GroundMotion("still", 0.01, np.zeros(100), unit="m/s2")
    assert len(draw_record(still, measure(still)).axes) == 4


class TestThinning:
    @pytest.mark.parametrize("size", [1, 3 * BINS_ACROSS - 1])
    def test_a_short_curve_is_drawn_whole(self, size):
        np.testing.assert_array_equal(visible(np.sin(np.arange(size))), np.arange(size))

    @pytest.mark.parametrize("size", [3 * BINS_ACROSS, 10 * BINS_ACROSS + 17])
    def test_a_long_one_keeps_its_ends_extremes_and_outline(self, size):
        values = np.random.default_rng(2).normal(size=size)
        shown = visible(values)
        assert shown.size <= 3 * BINS_ACROSS + 2 and (np.diff(shown) > 0).all()
        assert {0, size - 1, int(values.argmax()), int(values.argmin())} <= set(shown.tolist())
        step = size // BINS_ACROSS
        for k in (0, 1, BINS_ACROSS // 2, BINS_ACROSS - 1):
            part = values[k * step : (k + 1) * step]
            drawn = values[shown[(shown >= k * step) & (shown < (k + 1) * step)]]
            assert (drawn.min(), drawn.max()) == (part.min(), part.max())

    def test_a_record_far_longer_than_the_response_shown_is_not_thinned_away(self):
        shaking = np.concatenate([PULSE.scaled(5).acceleration, np.zeros(300_000)])
        long = GroundMotion("long", 0.01, shaking, unit="m/s2")
        figure = draw_history(respond(BLOCK, long, models=("nonlinear",)), long, "falls at once")
        above, below = figure.axes
        end = below.get_xlim()[1]
        assert end < 10
        drawn = above.get_lines()[0].get_ydata()
        np.testing.assert_allclose(drawn, long.acceleration[: drawn.size] / STANDARD_GRAVITY)
        assert above.get_lines()[0].get_xdata()[-1] >= end


def test_accelerations_of_uplift_are_drawn_and_named_and_no_uplift_said():
    quiet, leaning = PULSE.scaled(1e-3), Block(width=0.7, height=2.8, one_sided="positive", rebound=0.4)
    for block, levels, named in ((BLOCK, [-0.25, 0.25], "±0.25 g"), (leaning, [-0.25], "−0.25 g (clockwise)")):
        histories = respond(block, quiet, models=("nonlinear",))
        ground, rotation = draw_history(histories, quiet, "a block", structure=Structure(block)).axes
        assert [line.get_ydata()[0] for line in ground.lines[1:]] == pytest.approx(levels)
        low, high = ground.get_ylim()
        assert all(low < level < high for level in levels)
        assert f"uplift at {named}" in words(ground) and "does not uplift" in words(rotation)


def test_the_friction_needed_is_a_panel_below():
    block = BLOCK.model_copy(update={"friction": 0.3})
    motion = PULSE.scaled(2.0)
    both = [respond(block, each, models=("nonlinear",)) for each in (motion, motion.scaled(-1))]
    contacts = [
        Contacts(block).check(run["nonlinear"], each)
        for run, each in zip(both, (motion, motion.scaled(-1)), strict=True)
    ]
    plain = draw_history(both[0], motion, "a block")
    rubbed = draw_history(both[0], motion, "a block", contacts=contacts)
    assert len(rubbed.axes) == len(plain.axes) + 1
    below = rubbed.axes[-1]
    curves = below.get_lines()
    assert "available: 0.3" in words(below)
    assert [line.get_label() for line in curves] == [
        "required, polarity 1", "required, polarity -1", "available: 0.3",
    ]  # fmt: skip
    assert max(curves[0].get_ydata()) == contacts[0].friction_needed < below.get_ylim()[1]
