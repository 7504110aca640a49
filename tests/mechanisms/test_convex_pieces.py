"""Polygons as convex pieces: nothing is lost, nothing added, nothing twice."""

from cmath import exp
from math import pi

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from rocking_cli.core.kinematics import area_of, inside
from rocking_cli.core.polygons import convex_pieces

L_SHAPE = [0, 2, 2 + 1j, 1 + 1j, 1 + 3j, 3j]
U_SHAPE = [0, 3, 3 + 2j, 2 + 2j, 2 + 1j, 1 + 1j, 1 + 2j, 2j]
CROSS = [1, 2, 2 + 1j, 3 + 1j, 3 + 2j, 2 + 2j, 2 + 3j, 1 + 3j, 1 + 2j, 2j, 1j, 1 + 1j]
COMB = [0, 5, 5 + 2j, 4 + 2j, 4 + 1j, 3 + 1j, 3 + 2j, 2 + 2j, 2 + 1j, 1 + 1j, 1 + 2j, 2j]
NOTCHED = [0, 2, 2 + 1j, 1 + 0.98j, 1j]  # a shallow hollow


def is_convex(z):
    sides = np.roll(z, -1) - z
    turns = (sides.conj() * np.roll(sides, -1)).imag
    return (turns > -1e-12 * np.abs(sides).max() ** 2).all() and turns.max() > 0


def check(corners, pieces):
    """Hold pieces against a polygon: convex, of the same area, and each of its points in one piece."""
    z = np.array(corners, np.complex128)
    assert all(is_convex(piece) for piece in pieces)
    assert sum(map(area_of, pieces)) == pytest.approx(abs(area_of(z)), rel=1e-9)
    low, high = min(z.real) + 1j * min(z.imag), max(z.real) + 1j * max(z.imag)
    steps = (np.arange(23) + 0.377) / 23
    points = (low.real + (high - low).real * steps[:, None] + 1j * (low.imag + (high - low).imag * steps)).ravel()
    within = np.array([inside(points, piece) for piece in pieces]).sum(axis=0)
    assert (within == inside(points, z)).all()


@pytest.mark.parametrize(("corners", "least"), [(L_SHAPE, 2), (U_SHAPE, 3), (CROSS, 3), (COMB, 4)])
@pytest.mark.parametrize("backwards", [False, True])
def test_hollows_are_cut(corners, least, backwards):
    pieces = convex_pieces(corners[::-1] if backwards else corners)
    check(corners, pieces)
    assert least <= len(pieces) <= least + 1


def test_a_shallow_hollow_is_filled_unless_something_reaches_into_it():
    beside = np.array([2 + 0j, 3, 2 + 1j])
    assert [area_of(piece) for piece in convex_pieces(NOTCHED, [beside])] == pytest.approx([2.0])
    for deepest in (0.98j, 0.985j):  # on the bottom of the hollow, or above it
        check(NOTCHED, convex_pieces(NOTCHED, [beside, np.array([0.9 + 1.1j, 1 + deepest, 1.1 + 1.1j])]))


@given(st.lists(st.tuples(st.floats(0.3, 1.0), st.floats(0.2, 1.0)), min_size=4, max_size=12), st.floats(0, 6))
def test_stars_are_cut_into_convex_pieces(rays, turned):
    """A polygon whose corners go round a point within it: it has hollows of every depth."""
    gaps = np.array([gap for _, gap in rays])
    assume(gaps.max() < 0.45 * gaps.sum())
    angles = 2 * pi * np.cumsum(gaps) / gaps.sum() + turned
    corners = [far * exp(1j * angle) for (far, _), angle in zip(rays, angles, strict=True)]
    pieces = convex_pieces(corners, [np.array(corners)])  # something touches it everywhere
    if len(pieces) == 1:
        assert abs(area_of(np.array(corners))) == pytest.approx(area_of(pieces[0]), rel=0.01)
    else:
        check(corners, pieces)
