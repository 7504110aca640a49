"""Plots in axes and figures of the user: what is drawn is that of a figure of its own, and nothing else changes."""

import re
from concurrent.futures import ThreadPoolExecutor
from functools import cache, partial

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.legend import Legend
from matplotlib.text import Text

import rocking_cli as rk
from rocking_cli.ask.answer import Answer
from rocking_cli.plotting import style
from rocking_cli.views.view import View
from tests.cli.test_every_option import BLOCK, OTHER, PULSE, RECORD, STRONG, WEAK, here  # noqa: F401
from tests.house.test_api import QUESTIONS

ASKED = {verb: (verb, given) for verb, given in QUESTIONS.items()} | {
    "release": ("respond", {"structure": OTHER, "release": 0.3, "model": "nonlinear"}),
    "motion": ("record", {"motions": RECORD}),
    "fitted": ("record", {"motions": RECORD, "fit_pulse": True}),
    "one spectrum": ("spectrum", {"structures": BLOCK, "motions": PULSE, "count": 4}),
    "margins": ("margin", {"structure": WEAK, "motions": [STRONG, PULSE], "neighbours": 4}),
    "one side": (
        "verify",
        {"structure": rk.Wall(thickness=0.3, height=3.0, one_sided="positive"), "site": QUESTIONS["verify"]["site"]},
    ),
}
WITHOUT = {"respond_each", "shares", "selfcheck", "results"}
"""Verbs whose answers have no plot, and `results`, whose plot is that of `fragility`."""
FAST = {"margins"}


@cache
def asked(name):
    verb, given = ASKED[name]
    return getattr(rk, verb)(**given)


@pytest.fixture
def answer(request):
    return asked(request.param)


def pytest_generate_tests(metafunc):
    if "answer" in metafunc.fixturenames:
        names = [each for each in ASKED if each not in WITHOUT]
        marked = [pytest.param(each, marks=[pytest.mark.rest] * (each not in FAST)) for each in names]
        metafunc.parametrize("answer", marked, indirect=True)


def grid(answer, layout="constrained"):
    """Return a figure of the user with four axes, three of which hold something, and the fourth, for a plot."""
    figure = Figure((9, 7), dpi=90, layout=layout)
    polar = getattr(answer.plot().axes[0], "name", "") == "polar"
    *others, last = (figure.add_subplot(2, 2, k, projection="polar" if polar and k == 4 else None) for k in range(1, 5))
    for k, axes in enumerate(others):
        axes.plot([0, k], [1, 2], label="mine")
        axes.set(xlabel="mine", title=f"mine {k}", xlim=(-1, 4))
        axes.legend()
    return figure, others, last


def state(axes):
    """What belongs to axes of the user."""
    words = [each.get_text() for each in (*texts(axes), *axes.get_legend().get_texts())]
    numbers = axes.xaxis.get_major_formatter(), axes.yaxis.get_major_formatter()
    of_axes = axes.get_xlim(), axes.get_ylim(), axes.get_xscale(), axes.get_yscale(), axes.get_aspect()
    return len(axes.get_children()), words, numbers, of_axes


def texts(axes):
    every = axes.title, axes._left_title, axes._right_title, axes.xaxis.label, axes.yaxis.label, *axes.texts
    return [each for each in every if each.get_text()]


def lines(axes):
    return [(*each.get_xydata().ravel().tolist(), each.get_color()) for each in axes.get_lines()]


def shapes(axes):
    return [each for each in axes.get_children() if not isinstance(each, Text)]


def panels(figure):
    return [axes for axes in figure.axes if axes.get_label() != "<colorbar>"]


def drawn(figure):
    FigureCanvasAgg(figure).draw()
    return figure


def test_in_axes_of_the_user(answer, tmp_path):
    own = panels(answer.plot())
    figure, others, mine = grid(answer)
    before = [state(each) for each in others]
    if len(own) > 1:
        with pytest.raises(rk.InputError, match="give `figure`") as refused:
            answer.plot(ax=mine)
        assert f"`ax` is for plots of one panel, and this plot has {len(own)}\n" in str(refused.value)
        assert not mine.lines and not mine.get_title(loc="left")
    else:
        assert answer.plot(tmp_path / "all.png", ax=mine) is figure
        np.testing.assert_equal(lines(mine), lines(own[0]))
        assert len(shapes(mine)) >= len(shapes(own[0]))  # names beside curves and in regions are in the legend here
        assert (tmp_path / "all.png").stat().st_size > 5000
        drawn(figure)
        wide = figure.bbox.width
        assert mine.bbox.width > 0.25 * wide
        for each in (*texts(mine), *filter(None, [mine.get_legend()])):
            box = each.get_window_extent()
            assert 0.43 * wide < box.x0 and box.x1 < wide, each  # in its part of the figure
            assert not any(box.overlaps(other.bbox) for other in others), each
    assert [state(each) for each in others] == before
    assert not any(figure._align_label_groups["y"].joined(mine, each) for each in others)
    assert (*figure.get_size_inches(), figure.dpi) == (9, 7, 90) and not figure.legends and figure.get_suptitle() == ""
    assert len(panels(figure)) == 4 and type(figure.get_layout_engine()).__name__ == "ConstrainedLayoutEngine"


def test_in_a_part_of_a_figure_of_the_user(answer):
    own = panels(answer.plot())
    figure = Figure((11, 6), dpi=90, layout="constrained")
    left, right = figure.subfigures(1, 2)
    axes = left.subplots()
    axes.plot([1, 2], label="mine")
    axes.legend()
    before = state(axes)
    assert answer.plot(figure=right) is figure
    there = [each for each in right.axes if each.get_label() != "<colorbar>"]
    np.testing.assert_equal([lines(each) for each in there], [lines(each) for each in own])
    assert state(axes) == before and (*figure.get_size_inches(), figure.dpi) == (11, 6, 90)
    assert not figure.legends and figure.get_suptitle() == "" and not figure.texts
    drawn(figure)
    words = [each for panel in there for each in texts(panel)]
    for each in [*words, *right.texts, *right.findobj(Legend)]:
        assert not each.get_window_extent().overlaps(axes.bbox), each


@pytest.mark.every(3)
@pytest.mark.parametrize("layout", [None, "tight", "constrained"])
def test_in_a_figure_of_the_user(layout):
    """Without a layout, it is laid out once, so that no label and no legend is cut off; that it has none stays."""
    answer = asked("margins")
    figure = Figure((6, 5), dpi=90, layout=layout)
    engine = type(figure.get_layout_engine())
    assert answer.plot(figure=figure) is figure
    assert type(figure.get_layout_engine()) is engine and tuple(figure.get_size_inches()) == (6, 5)
    drawn(figure)
    (axes,) = figure.axes
    (key,) = [*figure.legends, *filter(None, [axes.get_legend()])]
    for each in (axes.title, axes.xaxis.label, axes.yaxis.label, key):
        box = each.get_window_extent()
        assert min(box.x0, box.y0) >= 0 and box.x1 <= figure.bbox.x1 and box.y1 <= figure.bbox.y1, each
    assert key.get_window_extent().y1 < axes.xaxis.label.get_window_extent().y0 + 3


def test_a_drawing_is_made_smaller_as_a_whole():
    """Half as wide: letters, lines and panels are half as large, and the middle of the drawing stays in the middle."""
    answer = rk.draw(BLOCK)
    own = answer.plot()
    width, height = own.get_size_inches()
    figure = Figure((width / 2, height), layout="constrained")
    answer.plot(figure=figure)
    for one, other in zip(own.axes, figure.axes, strict=True):
        a, b = one.get_position(original=True), other.get_position(original=True)
        expected = a.x0, a.width, (a.y0 - 0.5) / 2, a.height / 2
        np.testing.assert_allclose([b.x0, b.width, b.y0 - 0.5, b.height], expected)
        letters = [[text.get_fontsize() for text in each.texts] for each in (one, other)]
        np.testing.assert_allclose(letters[1], np.divide(letters[0], 2))
        weights = [[part.get_linewidth() for part in (*each.lines, *each.patches)] for each in (one, other)]
        np.testing.assert_allclose(weights[1], np.divide(weights[0], 2))


POLAR = Figure().add_subplot(projection="polar")
FLAT = Figure().subplots()


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"ax": FLAT, "figure": Figure()}, "`ax` cannot be combined with `figure`"),
        ({"ax": np.array([FLAT, FLAT])}, "`ax` must be an Axes of matplotlib, got ndarray"),
        ({"ax": Figure()}, "`ax` must be an Axes of matplotlib, got Figure"),
        ({"figure": FLAT}, "`figure` must be a Figure or SubFigure of matplotlib, got Axes"),
        ({"figure": FLAT.figure}, "`figure` has axes already\n  give `ax` to draw in one of them"),
        ({"ax": POLAR}, "`ax` must have the projection rectilinear, not polar"),
        ({"ax": FLAT, "width": 3}, "width is not an argument of this plot\n  it takes file, ax, figure"),
        ({"ax": FLAT, "file": "a.jpeg"}, r"give a file name that ends in \.png, \.svg or \.pdf"),
        ({"ax": FLAT, "file": "none/a.png"}, "the folder .*none does not exist"),
    ],
)
def test_what_cannot_be_is_refused_before_anything_is_drawn(given, said):
    with pytest.raises(rk.InputError, match=said):
        asked("margin").plot(**given)
    assert not FLAT.lines and not POLAR.lines and style.given() is None


def test_a_plot_of_all_directions_needs_polar_axes():
    with pytest.raises(rk.InputError, match=r"must have the projection polar, not rectilinear\n  `figure.add_subplot"):
        rk.respond_around(**QUESTIONS["respond_around"]).plot(ax=FLAT)


def answer_of(figure):
    return Answer("q", None, View({}, []), dict, figure)


def test_further_arguments_go_to_the_figure_of_the_answer():
    def figure(kept, *, title, x="pga", y="peak"):
        made, axes = style.one_panel(3.0, title)
        axes.set(xlabel=x, ylabel=y)
        return made

    answer = answer_of(partial(figure, 1, title="t"))
    assert answer.plot().axes[0].get_xlabel() == "pga"
    axes = Figure().subplots()
    answer.plot(ax=axes, x="pgv")
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("pgv", "peak")
    for name in ("title", "kept", "z"):  # given already, not by name, unknown
        with pytest.raises(
            rk.InputError, match=f"{name} is not an argument of this plot\n  it takes file, ax, figure, x, y"
        ):
            answer.plot(**{name: "odd"})


def test_a_plot_that_makes_its_own_figure_is_not_lost():
    """Those of other packages may."""
    with pytest.raises(rk.InputError, match="this plot makes a figure of its own"):
        answer_of(Figure).plot(ax=Figure().subplots())


def test_threads_draw_each_in_its_own():
    answer = asked("one spectrum")
    every = [Figure() for _ in range(6)]
    with ThreadPoolExecutor(3) as pool:
        alone = list(pool.map(lambda mine: answer.plot(figure=mine) if mine else answer.plot(), [*every, None]))[-1]
    for figure in every:
        for own, usual in zip(figure.axes, alone.axes, strict=True):
            np.testing.assert_equal(lines(own), lines(usual))


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("", ""),
        ("one two three", "one two\nthree"),
        ("one\ntwo three", "one two\nthree"),
        ("unbreakably-long-word a", "unbreakably-long-word\na"),
        (r"a $\phi \cdot x$ b", r"a $\phi \cdot x$ b"),
        (r"\$5 \$6 seven", r"\$5 \$6" + "\nseven"),
    ],
)
def test_words_are_broken_into_lines(text, expected):
    assert style.folded(text, style.size_of("one two", 10).real + 0.01, 10) == expected


def test_names_with_dollars_are_broken_as_they_are():
    figure = Figure((2.0, 4.0))
    name = "costs $5 and $6 " * 4
    rk.spectrum(rk.Block(width=0.7, height=2.8, name=name), PULSE, count=3).plot(figure=figure)
    drawn(figure)
    words = re.sub(r"\s+", " ", figure.legends[0].get_texts()[0].get_text())
    assert r"costs \$5 and \$6" in words
