"""The pictures show what happened, in print and in grey, however long the record."""

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg

from mechanisms.block import Block
from rocking_cli.excitation.base import STANDARD_GRAVITY, GroundMotion
from rocking_cli.excitation.measures import measure
from rocking_cli.plotting import style
from rocking_cli.plotting.style import BINS_ACROSS, visible
from rocking_cli.questions.record.picture import draw_record
from rocking_cli.questions.respond.picture import MIN_IMPACT_RATE, draw_history
from rocking_cli.studies.contact import Contacts
from tests.following import respond

BLOCK = Block(width=0.7, height=2.8)
PULSE = GroundMotion("pulse", 0.01, -0.35 * STANDARD_GRAVITY * np.sin(np.linspace(0, 2 * np.pi, 81)))


def curves(axes):
    return {line.get_label(): line for line in axes.get_lines() if not line.get_label().startswith("_")}


def test_the_record_stands_above_and_the_responses_below_with_their_impacts():
    histories = respond(BLOCK, PULSE)
    figure = draw_history(histories, PULSE, "a block")
    above, below = figure.axes
    assert above.get_title(loc="left") == "a block"
    np.testing.assert_allclose(above.get_lines()[0].get_ydata(), PULSE.acceleration / STANDARD_GRAVITY)
    drawn = curves(below)
    assert len(drawn) == 3
    np.testing.assert_array_equal(drawn["nonlinear"].get_ydata(), histories["nonlinear"].ratio)
    marked = [line.get_xdata() for line in below.get_lines() if line.get_marker() == "|"]
    assert len(marked) == 3
    assert marked[0][0] == histories["nonlinear"].impacts[0, 0]
    assert [len(times) for times in marked] == [len(run.felt) for run in histories.values()]
    assert 0 < len(marked[0]) < histories["nonlinear"].impact_count
    assert "time [s]" in below.get_xlabel() and "phi" in below.get_ylabel()
    with_up = draw_history(histories, replace(PULSE, vertical=PULSE.scaled(0.5)), "a block").axes[0]
    drawn = [line.get_ydata() for line in with_up.get_lines()]
    assert any(np.array_equal(y, 0.5 * PULSE.acceleration / STANDARD_GRAVITY) for y in drawn)


def test_notes_are_on_no_peak_and_the_marks_say_which_impacts_they_are():
    """A motion whose peak is where its name stands: late, and to the right."""
    late = GroundMotion("late", 0.01, np.concatenate([np.zeros(400), -PULSE.acceleration[::-1]]))
    figure = draw_history(respond(BLOCK, late), late, "a block")
    FigureCanvasAgg(figure).draw()
    above, below = figure.axes
    (note,) = (text for text in above.texts if "PGA" in text.get_text())
    bottom = above.transData.inverted().transform(note.get_window_extent())[0, 1]
    assert above.get_lines()[0].get_ydata().max() < bottom
    (key,) = (text.get_text() for text in below.texts if "impacts" in text.get_text())
    assert f"{100 * MIN_IMPACT_RATE:g} %" in key
    for axes, name in zip(draw_record(late, measure(late)).axes, ("PGA", "PGV", "PGD"), strict=False):
        low, high = axes.get_ylim()
        assert any(name in text.get_text() for text in axes.texts)
        assert axes.get_lines()[0].get_ydata().max() < high - 0.15 * (high - low)


def test_a_title_is_as_long_as_there_is_room_for():
    wide, narrow = (f"{letter * 6} " * 20 for letter in "Wi")
    for text in (wide, narrow, "W" * 300, "a $ and _ and ^"):
        short = style.fitted(text)
        assert style.size_of(style.plain(short), style.TITLE).real <= style.PAGE_WIDTH - 0.3
    assert len(style.fitted(wide)) < len(style.fitted(narrow))
    assert style.fitted("a $ and _") == "a $ and _"
    assert style.fitted("\udcff\x1b a") == "\udcff\x1b a"  # it is spelled out when it is written


def test_overturning_is_named_and_the_fall_is_cut_off_with_a_cross_inside_the_panel():
    histories = respond(BLOCK, PULSE.scaled(5.0), models=("nonlinear",))
    figure = draw_history(histories, PULSE.scaled(5.0), "a block")
    below = figure.axes[1]
    assert list(curves(below)) == ["nonlinear, overturns"]
    (cross,) = [line for line in below.get_lines() if line.get_marker() == "x"]
    bottom, top = below.get_ylim()
    assert bottom < cross.get_ydata()[0] < 0.99 * top <= 1.6
    assert curves(below)["nonlinear, overturns"].get_xdata()[-1] == cross.get_xdata()[0]


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
    assert (one.get_legend().get_title().get_text(), two.get_legend().get_title().get_text()) == (
        "polarity 1", "polarity -1",
    )  # fmt: skip
    (drawn,) = curves(two).values()
    np.testing.assert_array_equal(drawn.get_ydata(), other["linear1"].ratio)
    assert one.get_ylim() == two.get_ylim()


def grey(color):
    red, green, blue = (int(color[k : k + 2], 16) / 255 for k in (1, 3, 5))
    return 0.299 * red + 0.587 * green + 0.114 * blue


def test_the_lines_differ_in_grey_by_tone_dash_and_weight():
    looks = list(style.LINES.values())
    for key in ("linestyle", "linewidth"):
        assert len({look[key] for look in looks}) == len(looks)
    tones = sorted(grey(look["color"]) for look in looks)
    assert np.diff(tones).min() > 0.15 and tones[-1] < 0.7


def test_a_record_is_drawn_with_its_integrals_and_the_build_up():
    measures = measure(PULSE)
    figure = draw_record(PULSE, measures)
    labels = [axes.get_ylabel() for axes in figure.axes]
    assert labels == ["acceleration [g]", "velocity [m/s]", "displacement [m]", "Arias intensity [%]"]
    assert figure.axes[-1].get_xlabel() == "time [s]"
    np.testing.assert_allclose(figure.axes[1].get_lines()[0].get_ydata(), PULSE.velocity)
    built = figure.axes[3].get_lines()[0].get_ydata()
    assert built[0] == 0 and built[-1] == pytest.approx(100) and (np.diff(built) >= 0).all()
    marks = [(line.get_xdata()[0], line.get_ydata()[0]) for line in figure.axes[3].get_lines()[1:]]
    assert marks == [(measures.t_5, 5), (measures.t_95, 95)]
    words = " ".join(text.get_text() for axes in figure.axes for text in axes.texts)
    assert f"PGV {measures.pgv:.3g} m/s" in words and f"95 % at {measures.t_95:.4g} s" in words


def test_a_record_of_zeros_can_be_drawn():
    still = GroundMotion("still", 0.01, np.zeros(100))
    assert len(draw_record(still, measure(still)).axes) == 4


class TestThinning:
    @pytest.mark.parametrize("size", [1, 2, BINS_ACROSS, 3 * BINS_ACROSS - 1])
    def test_a_short_curve_is_drawn_whole(self, size):
        np.testing.assert_array_equal(visible(np.sin(np.arange(size))), np.arange(size))

    @pytest.mark.parametrize("size", [3 * BINS_ACROSS, 10 * BINS_ACROSS + 17, 1_000_003])
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
        long = GroundMotion("long", 0.01, np.concatenate([PULSE.scaled(5).acceleration, np.zeros(300_000)]))
        figure = draw_history(respond(BLOCK, long, models=("nonlinear",)), long, "falls at once")
        above, below = figure.axes
        end = below.get_xlim()[1]
        assert end < 10
        np.testing.assert_allclose(above.get_lines()[0].get_ydata()[:81], long.acceleration[:81] / STANDARD_GRAVITY)
        assert above.get_lines()[0].get_xdata()[-1] >= end


def test_where_nothing_lifts_the_picture_says_so_and_what_would():
    quiet = PULSE.scaled(1e-3)
    figure = draw_history(respond(BLOCK, quiet), quiet, "a block", uplift=(0.25, 0.2))
    ground, rotation = figure.axes
    assert [line.get_ydata()[0] for line in ground.lines[-2:]] == [-0.25, 0.2]
    assert "uplift at 0.2 g and -0.25 g" in " ".join(text.get_text() for text in ground.texts)
    assert "does not uplift" in [text.get_text() for text in rotation.texts]
    rocks = draw_history(respond(BLOCK, PULSE.scaled(3.0)), PULSE, "a block", uplift=(0.25, 0.25))
    assert "does not uplift" not in [text.get_text() for each in rocks.axes for text in each.texts]


def test_the_friction_needed_is_a_panel_below():
    block = BLOCK.model_copy(update={"friction": 0.3})
    motion = PULSE.scaled(2.0)
    both = [respond(block, each, models=("nonlinear",)) for each in (motion, motion.scaled(-1))]
    contacts = [
        Contacts(block).check(run["nonlinear"], each)
        for run, each in zip(both, (motion, motion.scaled(-1)), strict=True)
    ]
    plain, rubbed = (
        draw_history(both[0], motion, "a block"),
        draw_history(both[0], motion, "a block", contacts=contacts),
    )
    assert len(rubbed.axes) == len(plain.axes) + 1
    below = rubbed.axes[-1]
    curves = below.get_lines()
    assert [line.get_label() for line in curves] == ["polarity 1", "polarity -1", "available: 0.3"]
    assert max(curves[0].get_ydata()) == contacts[0].friction_needed < below.get_ylim()[1]
