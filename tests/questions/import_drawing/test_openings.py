"""Openings that leave no body, or another one than is drawn."""

import re

import numpy as np
import pytest

from rocking_cli.io.drawings.contract import DrawingError
from tests.questions.import_drawing.sheets import box, imported, lambdas, line, outline

WEIGHED = {"density": {"": 2000.0}, "depth": 1.0}
STEP = box(2, 0, 1, 2)  # beside the wall of each case, so that it is a block
WINDOW = box(0.5, 1, 1, 1, "FORI")
CASES = {  # openings in a wall 2 x 4, what is said, and where
    "whole": ([box(0, 0, 2, 4, "FORI")], "leave nothing of the body", (1, 2)),
    "whole together": ([box(0, 0, 2, 2, "FORI"), box(0, 2, 2, 2, "FORI")], "leave nothing of the body", (1, 2)),
    "whole but for 0.9 mm": ([box(9e-4, 9e-4, 1.9982, 3.9982, "FORI")], "leave nothing of the body", (1, 2)),
    "overlapping": ([WINDOW, box(1, 1.5, 0.5, 1, "FORI")], "overlap by 0.25 m2 at (1.25, 1.75)", (1.25, 1.75)),
    "twice, 2 mm apart": ([WINDOW, box(0.502, 1, 1, 1, "FORI")], "overlap by 0.998 m2", (1.001, 1.5)),
    "one in another": ([WINDOW, box(0.75, 1.25, 0.5, 0.5, "FORI")], "overlap by 0.25 m2", (1, 1.5)),
    "across": ([box(0, 1, 2, 1, "FORI")], "cut a body into 2 pieces at (0, 1.5): draw each piece as a body", (0, 1.5)),
    "across together": ([box(0, 1, 1, 1, "FORI"), box(1, 1.9, 1, 1, "FORI")], "into 2 pieces", None),
}  # fmt: skip


@pytest.mark.parametrize("beside", [[], [STEP]], ids=["rigid_body", "assembly"])
@pytest.mark.parametrize("case", CASES)
def test_openings_that_leave_no_whole_body_are_refused(case, beside):
    openings, what, at = CASES[case]
    with pytest.raises(DrawingError, match=re.escape(what)) as caught:
        imported(box(0, 0, 2, 4), *beside, *openings, **WEIGHED)
    assert caught.value.refused == "opening"
    assert at is None or caught.value.at == [pytest.approx(at, abs=2e-3)]


@pytest.mark.parametrize("turn", [1, np.exp(0.3j)])
def test_an_opening_that_reaches_the_outline_of_a_block_is_refused(turn):
    def turned(chain):
        z = chain.points * turn
        return outline(np.stack([z.real, z.imag], axis=1), chain.layer)

    beside, door = [box(1, 1, width, 1.5, "FORI") for width in (1, 0.9995)], outline([(1, 0), (1.5, 0), (1, 1)], "FORI")
    for opening in (*beside, door):
        with pytest.raises(
            DrawingError, match=r"reaches the outline of b1 at .*: draw the outline with this"
        ) as caught:
            imported(*map(turned, (box(0, 0, 2, 4), STEP, opening)), kind="assembly", **WEIGHED)
        (at,) = caught.value.at
        place = complex(*at) / turn
        assert caught.value.refused == "opening"
        assert min(abs(place.real - 2), abs(place.imag)) < 2e-3 and 1 - 2e-3 <= max(place.real, place.imag) <= 2.502


def test_openings_inside_and_doors_of_a_rigid_body_are_cut_out():
    touching = outline([(2, 3), (1.5, 3.4), (1.5, 2.6)], "FORI")  # in one point
    inside = [WINDOW, box(0.5, 1.9995, 0.5, 0.5, "FORI"), box(1.2, 2.1, 0.798, 0.1, "FORI"), touching]
    wall, _ = imported(box(0, 0, 2, 4), STEP, *inside, **WEIGHED).bodies
    assert wall.moments.area == pytest.approx(8 - 1 - 0.25 - 0.0798 - 0.2)
    door = imported(box(0, 0, 2, 4), box(0.75, 0, 0.5, 2, "FORI"), **WEIGHED)
    assert door.kind == "rigid_body" and lambdas(door) == pytest.approx([7 / 15, 7 / 15])


@pytest.mark.parametrize("ground", [[], [line((-1, -0.2), (2, 0.4), "TERRENO")]], ids=["level", "slope"])
def test_a_density_without_depth_is_refused_as_such(ground):
    slope = np.exp(1j * np.arctan(0.2)) if ground else 1.0
    z = np.array([0, 1, 1 + 2j, 2j]) * slope
    stone = outline(np.stack([z.real, z.imag], axis=1))
    with pytest.raises(DrawingError, match="needs the depth of the structure: give `depth`") as caught:
        imported(stone, *ground, density={"": 2000.0})
    assert (caught.value.refused, caught.value.at) == ("density", [pytest.approx([z.mean().real, z.mean().imag])])
    assert imported(stone, *ground, depth=1.0).kind == ("assembly" if ground else "rigid_body")
