"""The paper's figures, as docs/make_figures.py computes them: their data say what the text says."""

from importlib import import_module
from itertools import pairwise

import numpy as np
import pytest
from click.testing import CliRunner

from tests.conftest import PROJECT, rows_of

pytestmark = pytest.mark.rest


@pytest.fixture(scope="module")
def made():
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(PROJECT / "docs")
        yield import_module("make_figures")


def curves(figure, row, column):
    return {curve.label: curve.y for curve in figure.panels[row][column].curves}


def test_figure_3_errors_grow_with_slenderness_and_vanish_towards_phi_cr(made):
    figure = made.FIGURES[3]()
    period = list(curves(figure, 0, 0).values())
    assert all((np.diff(each) > 0).all() and each[-1] < 1 for each in period)
    assert all((one > other).all() for one, other in pairwise(period))
    assert len(figure.panels) == 2 and len(figure.panels[0]) == 2


def test_figure_5_the_right_column_has_the_larger_error_of_the_linearised_uplift(made):
    figure = made.FIGURES[5]()
    worst = [max(np.abs(y - 1).max() for y in curves(figure, 3, column).values()) for column in (0, 1)]
    assert worst[1] > 2 * worst[0]
    for row in range(4):
        for column in (0, 1):
            one, other = curves(figure, row, column).values()
            assert one[0] == pytest.approx(other[0], rel=1e-9)  # symmetric at H1 = H
            assert np.abs(one - other)[-1] > np.abs(one - other)[1]


def test_figures_12_and_13_kappa2_is_the_better_for_arches(made):
    first, second = made.FIGURES[12](), made.FIGURES[13]()
    for row in range(2):
        for column in range(2):
            pairs = zip(curves(first, row, column).values(), curves(second, row, column).values(), strict=True)
            assert all(np.abs(two - 1).max() < np.abs(one - 1).max() for one, two in pairs)


def test_figure_11_errors_of_the_free_period_are_small_and_grow_for_less_slender_arches(made):
    """As the text has it: small in general, largest at the bottom right, where arches are the least slender."""
    worst = [
        max(np.abs(y - 1).max() for y in curves(figure, row, column).values())
        for figure in [made.FIGURES[11]()]
        for row in range(2)
        for column in range(2)
    ]
    assert worst == sorted(worst) and worst[0] < 0.21


@pytest.mark.parametrize("number", [7, 11, 12, 13])
def test_a_curve_is_whole_or_the_caption_says_where_it_is_cut(made, number):
    paper = made.FIGURES[number]()
    drawn = made.draw_paper_figure(paper)
    cut = False
    for axes, panel in zip(drawn.axes, [panel for row in paper.panels for panel in row], strict=True):
        low, high = axes.get_ylim()
        values = np.concatenate([curve.y for curve in panel.curves])
        assert values.min() > low
        cut |= bool(values.max() > high)
    assert cut == (number == 7) == ("cut off" in drawn.get_supxlabel())


def test_figure_14_the_linear_response_follows_the_nonlinear_one_through_the_pulse(made):
    figure = made.record_response()
    assert [len(row[0].curves) for row in figure.panels] == [2, 4]
    peaks = [np.abs(y).max() for y in curves(figure, 1, 0).values()]
    for nonlinear, linear in (peaks[:2], peaks[2:]):  # under the record, and under its pulse
        assert linear == pytest.approx(nonlinear, rel=0.15)
    assert [structure.mechanism for structure in figure.structures.values()] == ["asymmetric_frame"]
    assert "0.197 g positive" in figure.caption


def test_figure_15_block_and_symmetric_frame_do_the_same_and_the_others_nearly(made):
    figure = made.equivalent_vulnerability()
    peaks = {curve.label: np.abs(curve.y).max() for curve in figure.panels[1][0].curves}
    assert peaks["symmetric frame"] == pytest.approx(peaks["block"], rel=1e-6)
    assert peaks["wall"] == pytest.approx(peaks["block"], rel=0.3)
    assert peaks["arch"] == pytest.approx(peaks["block"], rel=0.5)
    assert len({round(float(curve.x[-1]), 6) for curve in figure.panels[0][0].curves}) == 4  # four different pulses
    drawn = made.draw_paper_figure(figure).subfigs[0].axes
    assert [axes.get_title() for axes in drawn] == list(figure.structures) == list(peaks)


def test_the_script_writes_a_picture_and_the_data(made, tmp_path):
    result = CliRunner().invoke(made.main, ["3", "--out", str(tmp_path), "--format", "svg"], catch_exceptions=False)
    assert result.exit_code == 0
    assert (tmp_path / "figure3.svg").read_text(encoding="utf-8").startswith("<?xml")
    rows = rows_of(tmp_path / "figure3.csv")
    expected = made.FIGURES[3]()
    assert len(rows) == sum(curve.x.size for row in expected.panels for panel in row for curve in panel.curves)
    assert float(rows[0]["y"]) == pytest.approx(expected.panels[0][0].curves[0].y[0], rel=1e-8)
