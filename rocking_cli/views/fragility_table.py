"""Fragility curves as a table of numbers, with a row for each intensity of each curve."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rocking_cli.processing.intensity import parse_measure
from rocking_cli.studies.fragility.assess import Fragility
from rocking_cli.studies.fragility.curves import FragilityCurve

POINTS = 101  # of a curve
WIDEST = 30.0  # ratio of the least and the largest intensity from which on steps are of equal ratio
WORDS = ("structure", "limit_state", "measure", "unit", "kind")
NUMBERS = ("median", "dispersion", "scale", "x", "probability", "low", "high")
OTHER = tuple(f"lower_{name}" for name in ("median", "dispersion", "scale", "probability", "low", "high"))
"""Columns of the fit in which runs of unknown outcome do not exceed, beside those of that in which they do."""
COLUMNS = (*NUMBERS, "unknown", *OTHER)


def blocks(curves: Sequence[Fragility]) -> Iterator[Mapping[str, Sequence[object] | NDArray[Any]]]:
    """Yield the curves as tables, one after the other, from the least intensity of the data to the largest.

    Yields
    ------
    mapping of str to sequence
        The columns. `dispersion` belongs to lognormal curves, `scale` to logistic ones; each is NaN for the others.
        `unknown` is the share of undecided runs, NaN if nothing was checked: they count as exceeding in the curve
        itself, and as not exceeding in columns whose names begin with `lower_`.
    """
    drawn = [each for each in curves if _is_drawn(each)]
    if not drawn:
        yield {**{name: np.array([], dtype=str) for name in WORDS}, **{name: np.array([]) for name in COLUMNS}}
    for each in drawn:
        x, share = _intensities(each), each.share
        words = (each.structure, f"{each.limit}", each.measure, parse_measure(each.measure).unit, each.curve.kind)
        unknown = np.full(x.size, np.nan if share is None else share)
        one, other = (_fit(found.curve, x) for found in (each, each.lower or each))
        numbers = [*one[:3], x, *one[3:], unknown, *other]
        columns = zip(COLUMNS, numbers, strict=True)
        yield {**{name: [word] * x.size for name, word in zip(WORDS, words, strict=True)}, **dict(columns)}


def _is_drawn(found: Fragility) -> bool:
    return found.curve.kind != "none" or (found.lower is not None and found.lower.curve.kind != "none")


def _fit(curve: FragilityCurve, x: NDArray[np.float64]) -> list[NDArray[np.float64]]:
    """Return median, dispersion, scale, probability and confidence band at intensities; NaN where missing."""
    same = [np.nan if one is None else one.value for one in (curve.median, curve.dispersion, curve.scale)]
    return [*(np.full(x.size, value) for value in same), curve.probability(x), *curve.band(x)]


def _intensities(found: Fragility) -> NDArray[np.float64]:
    """Return the intensities of a curve's rows, with the ends of the interval of a step, and both sides of it."""
    least, most = float(found.seen.x.min()), float(found.seen.x.max())
    between = np.geomspace if most > WIDEST * least else np.linspace
    x: NDArray[np.float64] = between(least, most, POINTS)
    steps = [step for curve in (found.curve, (found.lower or found).curve) for step in curve.steps]
    return np.union1d(x, [end for step in steps for end in (step.low, step.value, step.high)])
