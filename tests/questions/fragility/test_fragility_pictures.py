"""Pictures of fragility show the data, the curves, and what could not be fitted."""

import io
from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection
from scipy.stats import binomtest

from rocking_cli.questions.fragility.assess import Bivariate
from rocking_cli.questions.fragility.curves import fit_curve, fit_surface
from rocking_cli.questions.fragility.observed import Observations
from rocking_cli.questions.fragility.picture import LabelledCurve, draw_curves, draw_ida, draw_surface

LEVELS = np.array([0.2, 0.4, 0.6, 0.8])


def stripes(counts, runs=20):
    exceeded = np.concatenate([np.arange(runs) < count for count in counts])
    return Observations.of(np.repeat(LEVELS, runs), exceeded, np.arange(exceeded.size))


def bivariate(x1, x2, exceeded):
    surface = fit_surface(x1, x2, exceeded, np.arange(x1.size))
    return Bivariate("a", "uplift", ("PGA", "PGV"), x1, x2, np.ones(x1.size, int), exceeded.astype(int), surface)


def drawn(name, seen):
    return LabelledCurve(name, fit_curve(seen), seen)


def marks(axes):
    """Where the observed parts are, a row a mark, and the ends of the bars of the first that is drawn."""
    (points, *_) = [line for line in axes.get_lines() if line.get_linestyle() == "None"]
    bars = next(each for each in axes.collections if isinstance(each, LineCollection))
    return points.get_xydata(), np.array([segment[:, 1] for segment in bars.get_segments()])


def words(figure):
    (legend,) = figure.legends
    return [" ".join(text.get_text().replace("\u00a0", " ").split()) for text in legend.get_texts()]


def rendered(figure):
    figure.savefig(io.BytesIO(), format="png", dpi=30)
    return figure


def test_stripes_are_marked_with_counts_and_wilsons_intervals_under_the_curve():
    each = drawn("overturning", stripes([1, 5, 12, 19]))
    figure = rendered(draw_curves([each], "PGA [g]", "a block"))
    (axes,) = figure.axes
    assert axes.get_xlabel() == "PGA [g]" and axes.get_title(loc="left") == "a block"
    assert [text.get_text() for text in axes.texts] == ["1/20", "5/20", "12/20", "19/20"]
    points, ends = marks(axes)
    np.testing.assert_allclose(points.T, [LEVELS, np.array([1, 5, 12, 19]) / 20])
    expected = [binomtest(k, 20).proportion_ci(0.95, method="wilson") for k in (1, 5, 12, 19)]
    np.testing.assert_allclose(ends, [[ci.low, ci.high] for ci in expected])
    (line,) = [line for line in axes.get_lines() if len(line.get_xdata()) > 10]
    np.testing.assert_array_equal(line.get_ydata(), each.curve.probability(line.get_xdata()))
    low, high = each.curve.band(line.get_xdata())
    band = next(each for each in axes.collections if each.get_alpha() == 0.14).get_paths()[0].vertices[:, 1]
    assert {round(value, 12) for value in band} == {round(value, 12) for value in np.concatenate([low, high])}
    assert f"median {each.curve.median.value:.3g}" in words(figure)[0] and "95 %" in words(figure)[1]


def test_bars_and_bands_count_records():
    # Sixty runs of each of eight records at each level: eight records, whatever the number of runs.
    random = np.random.default_rng(3)
    capacity = 0.5 * np.exp(0.5 * random.normal(size=8))
    x = np.tile(np.repeat(LEVELS, 60), 8)
    record = np.repeat(np.arange(8), 240)
    seen = Observations.of(x, x > capacity[record] * np.exp(0.02 * random.normal(size=x.size)), record)
    figure = rendered(draw_curves([drawn("overturning", seen)], "PGA [g]", "a block"))
    (axes,) = figure.axes
    _, ends = marks(axes)
    parts = seen.parts(0.95)
    np.testing.assert_allclose(ends, np.column_stack([parts.low, parts.high]))
    assert (np.diff(ends, axis=1) > 0.35).all()
    said = words(figure)
    assert "bars and shades: 95 % confidence, by record" in said[1]
    assert said[2].startswith("only 8 distinct records")


def test_a_cloud_of_many_runs_is_a_few_marks():
    x = np.outer(np.geomspace(0.1, 0.9, 12), np.geomspace(0.5, 4, 10)).ravel().repeat(60)
    record = np.repeat(np.arange(12), 600)
    seen = Observations.of(x, x > np.exp(0.3 * np.random.default_rng(4).normal(size=x.size)), record)
    (axes,) = rendered(draw_curves([drawn("overturning", seen)], "PGA [g]", "a cloud")).axes
    assert len(marks(axes)[0]) == 10


@pytest.mark.parametrize(("levels", "every"), [(25, 1), (26, 2), (50, 2)])
def test_of_many_intensities_some_are_marked_as_they_are(levels, every):
    x = np.tile(np.linspace(0.1, 2, levels), 20)
    exceeded = x > np.exp(0.4 * np.random.default_rng(5).normal(size=x.size))
    seen = Observations.of(x, exceeded, np.repeat(np.arange(20), levels))
    figure = rendered(draw_curves([drawn("overturning", seen)], "PGA [g]", "a block"))
    np.testing.assert_allclose(marks(figure.axes[0])[0][:, 1], seen.parts(0.95).part[::every])
    assert (f"one of every {every} intensities is marked" in words(figure)[1]) == (every > 1)


def test_a_surface_of_few_records_carries_the_warning():
    random = np.random.default_rng(6)
    x1, x2 = np.exp(random.normal(size=(2, 90)))
    exceeded = np.log(x1) + np.log(x2) > random.normal(size=90)
    found = replace(bivariate(x1, x2, exceeded), surface=fit_surface(x1, x2, exceeded, np.arange(90) % 9))
    said = words(rendered(draw_surface(found, ("a", "b"), "a frame")))[-1]
    assert said == found.surface.warning != ""


def test_a_step_a_curve_and_nothing_share_a_picture():
    entries = [
        drawn("uplift $1", stripes([0, 20, 20, 20])),
        drawn("phi/phi_cr > 0.5", stripes([1, 5, 12, 19])),
        drawn("overturning", stripes([0, 0, 0, 0])),
    ]
    figure = rendered(draw_curves(entries, "PGA [g]", "$ of a block"))
    (axes,) = figure.axes
    said = words(figure)
    assert "step, between 0.2 and 0.4" in said[0] and "lognormal" in said[1]
    assert "no curve: none of the 80 runs exceed" in said[2]
    assert said[4].startswith(r"shade of a step: the interval between two levels, not a confidence band: uplift \$1")
    curves = [line for line in axes.get_lines() if len(line.get_xdata()) > 10 and line.get_linewidth() > 1]
    assert len(curves) == 2
    assert not axes.texts
    step = curves[0]
    jump = step.get_xdata()[np.flatnonzero(np.diff(step.get_ydata()))]
    np.testing.assert_allclose(jump, entries[0].curve.step.value)


def test_a_wide_cloud_is_drawn_in_tenths_over_logarithms():
    random = np.random.default_rng(1)
    x = np.exp(1.2 * random.normal(size=200))
    figure = rendered(draw_curves([drawn("a", Observations.of(x, x > np.exp(random.normal(size=200)), np.arange(200)))],
                                  "PGV [m/s]", "a cloud"))  # fmt: skip
    (axes,) = figure.axes
    assert axes.get_xscale() == "log"
    np.testing.assert_allclose(marks(axes)[0][:, 0], np.sort(x).reshape(10, 20).mean(axis=1))


def test_the_records_of_an_ida_rise_into_the_band_of_overturning():
    peaks = np.array(
        [[0.1, 0.3, 0.7, np.nan], [0.1, 0.4, np.nan, np.nan], [0.0, 0.2, 0.4, 0.6], [0.2, 0.5, 1.1, np.nan]]
    )
    for few, drawn in ((4, set()), (5, {"median"}), (20, {"16 %", "median", "84 %"})):
        named = {line.get_label() for line in draw_ida(LEVELS, peaks, "PGA [g]", "", few).axes[0].get_lines()}
        assert named & {"16 %", "median", "84 %"} == drawn
    figure = rendered(draw_ida(LEVELS, peaks, "PGA [g]", "a wall", 20))
    (axes,) = figure.axes
    lines = {line.get_label(): line.get_ydata() for line in axes.get_lines()}
    height = axes.get_yticks()[-1]
    assert axes.get_yticklabels()[-1].get_text() == "overturns" and height > 1.05 * 1.1
    np.testing.assert_allclose(lines["median"], [0.1, 0.3, 0.7, height])
    np.testing.assert_allclose(lines["16 %"], [0.0, 0.2, 0.4, 0.6])
    np.testing.assert_allclose(lines["84 %"], [0.2, 0.5, height, np.nan])
    assert [(text.get_text(), text.xy[0]) for text in axes.texts] == [("1", 0.6), ("3", 0.8)]
    assert any("records that overturn, of 4" in each for each in words(figure))


@pytest.mark.parametrize("peak", [0.0, np.nan])
def test_an_ida_at_rest_and_one_that_always_overturns(peak):
    rendered(draw_ida(np.array([0.01, 1.0]), np.full((3, 2), peak), "PGA [g]", "a wall"))


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


@pytest.mark.parametrize("spread", [0.2, 0.4, 1.5])
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


def test_of_very_many_runs_an_even_share_is_drawn():
    random = np.random.default_rng(3)
    x1, x2 = np.exp(random.normal(size=(2, 20_000)))
    figure = rendered(draw_surface(bivariate(x1, x2, x1 * x2 > 3 * random.random(20_000)), ("a", "b"), "a frame"))
    below, above, _ = figure.axes[0].collections
    assert 2500 < len(below.get_offsets()) + len(above.get_offsets()) <= 3001
    assert words(figure)[-1] == "one of every 7 runs is drawn"


def test_a_band_that_the_data_leave_open_is_not_painted_and_said():
    random = np.random.default_rng(23)
    x = np.exp(random.normal(size=40))
    seen = Observations.of(x, random.random(40) < 0.4 + 0.1 * (x > 1), np.arange(40))
    figure = rendered(draw_curves([drawn("uplift", seen)], "PGA [g]", "a block"))
    assert not [each for each in figure.axes[0].collections if each.get_alpha() == 0.14]
    assert words(figure)[-1] == "no confidence band, as the data do not bound it: uplift"


def test_bands_of_several_are_their_edges_and_labels_are_whole():
    counts = ([1, 5, 12, 19], [0, 4, 10, 20], [2, 7, 13, 20], [0, 0, 0, 0])
    entries = [drawn(f"{'a long name of a structure ' * 3}{k}", stripes(each)) for k, each in enumerate(counts)]
    figure = rendered(draw_curves(entries, "PGA [g]", "overturning"))
    (axes,) = figure.axes
    assert not [each for each in axes.collections if each.get_alpha() == 0.14]
    thin = [line for line in axes.get_lines() if len(line.get_xdata()) > 10 and line.get_linewidth() < 1]
    assert len(thin) == 6
    for line, each in zip(thin[::2], entries, strict=False):
        np.testing.assert_array_equal(line.get_ydata(), each.curve.band(line.get_xdata())[0])
    for said, each in zip(words(figure), entries, strict=False):
        assert said.startswith(f"{each.name}: ") and "..." not in said
    lines = [line for text in figure.legends[0].get_texts() for line in text.get_text().split("\n")]
    assert max(map(len, lines)) <= 96 and not any(" %" in line for line in lines)
    edge = figure.bbox.width
    assert all(text.get_window_extent().x1 <= edge for text in figure.legends[0].get_texts())
