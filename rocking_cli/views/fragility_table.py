"""Fragility curves as a table of numbers, a row for each intensity of each curve."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rocking_cli.processing.intensity import parse_measure
from rocking_cli.studies.fragility.assess import Fragility

POINTS = 101  # of a curve
WIDEST = 30.0  # ratio of the least and the largest intensity from which on steps are of equal ratio
WORDS = ("structure", "limit_state", "measure", "unit", "kind")
NUMBERS = ("median", "dispersion", "scale", "x", "probability", "low", "high")


def blocks(curves: Sequence[Fragility]) -> Iterator[Mapping[str, Sequence[object] | NDArray[Any]]]:
    """The curves there are, one after the other, from the least intensity of the data to the largest.

    Yields
    ------
    mapping of str to sequence
        The columns; `dispersion` is of lognormal curves, `scale` of logistic ones, each NaN for the others.
    """
    drawn = [each for each in curves if each.curve.kind != "none"]
    if not drawn:
        yield {**{name: np.array([], dtype=str) for name in WORDS}, **{name: np.array([]) for name in NUMBERS}}
    for each in drawn:
        curve = each.curve
        x = _intensities(each)
        low, high = curve.band(x)
        words = (each.structure, f"{each.limit}", each.measure, parse_measure(each.measure).unit, curve.kind)
        found = [curve.median, curve.dispersion, curve.scale]
        same = [np.full(x.size, np.nan if one is None else one.value) for one in found]
        columns = zip(NUMBERS, [*same, x, curve.probability(x), low, high], strict=True)
        yield {**{name: [word] * x.size for name, word in zip(WORDS, words, strict=True)}, **dict(columns)}


def _intensities(found: Fragility) -> NDArray[np.float64]:
    """Intensities at which a curve is given; of a step also the ends of its interval, and where it is drawn."""
    least, most = float(found.seen.x.min()), float(found.seen.x.max())
    between = np.geomspace if most > WIDEST * least else np.linspace
    x: NDArray[np.float64] = between(least, most, POINTS)
    step = found.curve.step
    return x if step is None else np.union1d(x, [step.low, step.value, step.high])
