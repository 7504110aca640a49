"""Pictures of fragility show the data, the curves, and what could not be fitted."""

from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection, PolyCollection
from scipy.stats import binomtest

from rocking_cli.plotting import style
from rocking_cli.questions.fragility.assess import Bivariate, Fragility
from rocking_cli.questions.fragility.curves import exact_step, fit_curve, fit_surface
from rocking_cli.questions.fragility.observed import Observations
from rocking_cli.questions.fragility.picture import draw_curves, draw_ida, draw_surface

LEVELS = np.array([0.2, 0.4, 0.6, 0.8])


def stripes(counts, runs=20):
    exceeded = np.concatenate([np.arange(runs) < count for count in counts])
    return Observations.of(np.repeat(LEVELS, runs), exceeded, np.arange(exceeded.size))


def bivariate(x1, x2, exceeded):
    surface = fit_surface(x1, x2, exceeded, np.arange(x1.size))
    return Bivariate("a", "uplift", ("PGA", "PGV"), x1, x2, np.ones(x1.size, int), exceeded.astype(int), surface)


def fitted(seen, curve=None):
    return Fragility("a", "uplift", "PGA", seen, curve or fit_curve(seen), None)


def marks(axes):
    """Where the observed parts are, a row a mark, and the ends of the bars of the first that is drawn."""
    (points, *_) = observed(axes)
    bars = [each.get_segments() for each in axes.collections if isinstance(each, LineCollection)]
    bars = next(each for each in bars if len(each[0]) == 2)
    return points.get_xydata(), np.array([segment[:, 1] for segment in bars])


def observed(axes):
    return [line for line in axes.get_lines() if line.get_linestyle() == "None"]


def bands(axes):
    """The heights of the edges of each band."""
    filled = [each for each in axes.collections if isinstance(each, PolyCollection)]
    return [{round(y, 12) for y in each.get_paths()[0].vertices[:, 1]} for each in filled]


def band_of(curve, axes):
    (line, *_) = [line for line in axes.get_lines() if len(line.get_xdata()) > 10]
    return {round(y, 12) for y in np.concatenate(curve.band(line.get_xdata()))}


def words(figure):
    (legend,) = figure.legends
    return [" ".join(text.get_text().replace("\u00a0", " ").split()) for text in legend.get_texts()]


def rendered(figure):
    figure.draw_without_rendering()
    return figure


def test_stripes_are_marked_with_counts_and_wilsons_intervals_under_the_curve():
    each = fitted(stripes([1, 5, 12, 19]))
    figure = rendered(draw_curves({"overturning": each}, "PGA [g]", "a block"))
    (axes,) = figure.axes
    assert axes.get_xlabel() == "PGA [g]" and axes.get_title(loc="left") == "a block"
    assert [text.get_text() for text in axes.texts] == ["1/20", "5/20", "12/20", "19/20"]
    points, ends = marks(axes)
    np.testing.assert_allclose(points.T, [LEVELS, np.array([1, 5, 12, 19]) / 20])
    expected = [binomtest(k, 20).proportion_ci(0.95, method="wilson") for k in (1, 5, 12, 19)]
    np.testing.assert_allclose(ends, [[ci.low, ci.high] for ci in expected])
    (line,) = [line for line in axes.get_lines() if len(line.get_xdata()) > 10]
    np.testing.assert_array_equal(line.get_ydata(), each.curve.probability(line.get_xdata()))
    assert bands(axes) == [band_of(each.curve, axes)]
    assert words(figure)[0].startswith(f"overturning: median {each.curve.median.value:.3g} g (")
    assert words(figure)[1:] == ["bands and bars: 95 % confidence; marks: observed shares"]


def test_the_legend_has_the_numbers_of_the_table_beyond_the_data_too():
    each = fitted(stripes([1, 2, 2, 3]))
    median = each.curve.median
    assert median.value > LEVELS[-1]
    said = words(draw_curves({"overturning": each}, "PGA [g]", "a block"))[0]
    assert f"median {median.value:.3g} g ({median.low:.3g} to {median.high:.3g})" in said


def test_marks_of_several_curves_lie_beside_one_another_and_none_is_left_out():
    random = np.random.default_rng(5)
    x, record = np.tile(np.linspace(0.1, 2, 50), 20), np.repeat(np.arange(20), 50)
    seen = [Observations.of(x, x > k * np.exp(0.4 * random.normal(size=x.size)), record) for k in (0.8, 1, 1.2)]
    figure = rendered(draw_curves({f"{k}": fitted(each) for k, each in enumerate(seen)}, "PGA [g]", "a block"))
    (axes,) = figure.axes
    places = []
    for line, each in zip(observed(axes), seen, strict=True):
        np.testing.assert_allclose(line.get_ydata(), each.parts(0.95).part.reshape(25, 2).mean(axis=1))
        np.testing.assert_allclose(line.get_xdata(), each.parts(0.95).x.reshape(25, 2).mean(axis=1))
        places.append(line.get_transform().transform(line.get_xydata())[:, 0] * 72 / figure.dpi)
    np.testing.assert_allclose(np.diff(places, axis=0), 4.0)  # points
    assert np.diff(np.sort(np.concatenate(places))).min() > 3.9
    assert words(figure)[-1].endswith("marks: observed shares, side by side, of neighbouring intensities together")


def test_what_is_known_exactly_has_no_marks_and_bounds_the_others():
    seen = stripes([0, 5, 12, 19])
    step = exact_step(fit_curve(stripes([0, 20, 20, 20])), 0.25, "")
    cut = replace(fit_curve(seen), implied={"uplift": step})
    curves = {"uplift": fitted(seen, step), "overturning": fitted(seen, cut)}
    figure = rendered(draw_curves(curves, "PGA [g]", "a block"))
    (axes,) = figure.axes
    assert words(figure)[0] == "uplift: 0.25 g, exact" and len(observed(axes)) == 1
    points, ends = marks(axes)
    assert tuple(ends[0]) == (0, 0) and (ends[1:, 1] > points[1:, 1]).all()
    line = next(line for line in axes.get_lines() if line.get_label() == "uplift")
    assert line.get_xdata()[np.flatnonzero(np.diff(line.get_ydata()))] == pytest.approx(0.25)


def test_a_step_a_curve_and_nothing_share_a_picture():
    entries = {
        r"uplift \$1": fitted(stripes([0, 20, 20, 20])),
        "phi/phi_cr > 0.5": fitted(stripes([1, 5, 12, 19])),
        "overturning": fitted(stripes([0, 0, 0, 0])),
    }
    step, *_ = entries.values()
    figure = rendered(draw_curves(entries, "PGA [g]", "$ of a block"))
    (axes,) = figure.axes
    said = words(figure)
    assert said[0] == r"uplift \$1: step in the shade, 0.2 to 0.4 g" and "median" in said[1]
    assert said[2] == "overturning: no curve, none of the 80 runs exceed"
    assert bands(axes)[0] == {0, 1} and band_of(step.curve, axes) == {0, 1}
    curves = [line for line in axes.get_lines() if len(line.get_xdata()) > 10 and line.get_linewidth() > 1]
    assert len(curves) == 2
    assert [curve.get_label() for curve in curves] == [*entries][:2]
    jump = curves[0].get_xdata()[np.flatnonzero(np.diff(curves[0].get_ydata()))]
    np.testing.assert_allclose(jump, step.curve.step.value)


def test_the_records_of_an_ida_rise_into_the_band_of_overturning():
    nan = np.nan
    peaks = np.array([[0.1, 0.3, 0.7, nan], [0.1, 0.4, nan, nan], [0.0, 0.2, 0.4, 0.6], [0.2, 0.5, 1.1, nan]])
    every = {"16 % of runs below", "median", "84 % of runs below"}
    for few, drawn in ((5, set()), (17, {"median"})):
        (axes,) = draw_ida(LEVELS, peaks, "PGA [g]", "", few).axes
        assert {line.get_label() for line in axes.get_lines()} & every == drawn
        assert "records needed: 6 for the median, 18 for" in axes.get_xlabel()
    figure = rendered(draw_ida(LEVELS, peaks, "PGA [g]", "a wall", 18))
    (axes,) = figure.axes
    assert axes.get_xlabel() == "PGA [g]"
    lines = {line.get_label(): line.get_ydata() for line in axes.get_lines()}
    height = axes.get_yticks()[-1]
    assert axes.get_yticklabels()[-1].get_text() == "overturns" and height > 1.05 * 1.1
    np.testing.assert_allclose(lines["median"], [0.1, 0.3, 0.7, height])
    np.testing.assert_allclose(lines["16 % of runs below"], [0.0, 0.2, 0.4, 0.6])
    np.testing.assert_allclose(lines["84 % of runs below"], [0.2, 0.5, height])
    assert {tuple(line.get_xdata()) for line in axes.get_lines() if line.get_marker() == "^"} == {(0.6,), (0.8,)}
    counts = [(text.get_text(), text.xy[0]) for text in axes.texts if text.get_text().isdigit()]
    assert counts == [("1", 0.6), ("3", 0.8)]
    assert words(figure)[-1] == "numbers: those that overturn, of 4"
    assert words(draw_ida(LEVELS, peaks, "PGA [g]", "", 4, "abcd"))[:4] == [*"abcd"]
    for peak in (0.0, np.nan):  # one that rests, and one that always overturns
        draw_ida(np.array([0.01, 1.0]), np.full((3, 2), peak), "PGA [g]", "a wall")


def test_a_surface_is_drawn_as_contours_between_the_runs():
    random = np.random.default_rng(2)
    x1, x2 = np.exp(random.normal(size=(2, 150)))
    exceeded = np.log(x1) + np.log(x2) > 0.4 * random.normal(size=150)
    found = bivariate(x1, x2, exceeded)
    figure = rendered(draw_surface(found, ("PGA/(g lambda)", "p PGV/(g lambda)"), "a frame"))
    (axes,) = figure.axes
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("PGA/(g lambda)", "p PGV/(g lambda)")
    below, above, contours = axes.collections
    np.testing.assert_allclose(above.get_offsets(), np.column_stack([x1, x2])[exceeded])
    np.testing.assert_allclose(below.get_offsets(), np.column_stack([x1, x2])[~exceeded])
    middle = contours.get_paths()[list(contours.levels).index(0.5)].vertices
    np.testing.assert_allclose(found.surface.probability(*middle.T), 0.5, atol=0.01)
    assert words(figure)[0] == f"does not exceed ({(~exceeded).sum()})"


@pytest.mark.parametrize("spread", [0.2, 1.5])
def test_names_of_contours_are_whole_and_apart(spread):
    random = np.random.default_rng(3)
    x1, x2 = np.exp(random.normal(size=(2, 150)))
    figure = draw_surface(
        bivariate(x1, x2, np.log(x1) + np.log(x2) > spread * random.normal(size=150)),
        ("PGA [g]", "PGV [m/s]"),
        "a frame",
    )
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    (axes,) = figure.axes
    names = [text for text in axes.texts if text.get_text()]
    assert {text.get_text() for text in names} == {"10 %", "25 %", "50 %", "75 %", "90 %"}
    areas = [text.get_window_extent(canvas.get_renderer()) for text in names]
    assert all(axes.bbox.x0 < each.x0 and each.x1 < axes.bbox.x1 for each in areas)
    assert all(axes.bbox.y0 < each.y0 and each.y1 < axes.bbox.y1 for each in areas)
    assert not any(one.overlaps(other) for one, other in combinations(areas, 2))


def test_runs_without_a_surface_are_drawn_with_the_reason():
    x = np.geomspace(0.1, 1, 20)
    figure = rendered(draw_surface(bivariate(x, x**2, x > 0.3), ("PGA [g]", "PGV [m/s]"), "a frame"))
    assert len(figure.axes[0].collections) == 2
    assert words(figure)[2] == f"no surface: {bivariate(x, x**2, x > 0.3).surface.why}"


def test_bands_of_several_are_shades_and_a_legend_takes_its_own_room():
    counts = ([1, 5, 12, 19], [0, 4, 10, 20], [2, 7, 13, 20], [0, 0, 0, 0])
    entries = {f"{'a long name of a structure ' * 3}{k}": fitted(stripes(each)) for k, each in enumerate(counts)}
    first = dict(list(entries.items())[:1])
    with style.on_phone():
        figure, other = (draw_curves(each, "PGA [g]", "overturning") for each in (entries, first))
    figure.draw_without_rendering()
    other.draw_without_rendering()
    (axes,), (few,) = figure.axes, other.axes
    assert bands(axes) == [band_of(each.curve, axes) for each in [*entries.values()][:3]]
    for said, name in zip(words(figure), entries, strict=False):
        assert said.startswith(f"{name}: ")
    texts = figure.legends[0].get_texts()
    assert not any(line.startswith("%") for text in texts for line in text.get_text().split("\n"))
    assert all(text.get_window_extent().x1 <= figure.bbox.width for text in texts)
    assert axes.bbox.height == pytest.approx(few.bbox.height, rel=0.05)
