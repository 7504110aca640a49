"""Tables of a study as columns: its runs, and its curves with a row for each intensity."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rocking_cli import names
from rocking_cli.io.tables import stacked
from rocking_cli.processing.intensity import parse_measure
from rocking_cli.questions.fragility.assess import Fragility
from rocking_cli.questions.fragility.curves import FragilityCurve
from rocking_cli.questions.fragility.definition import SLIDING
from rocking_cli.questions.fragility.plan import Plan
from rocking_cli.questions.fragility.store import FAILED, NO_RUNS, OFF_EDGE, STANDS, UNKNOWN, RunRows, Store
from rocking_cli.studies.fragility.quantities import USUAL_MEASURES, label

CURVE_POINTS = 101
MIN_LOG_RATIO = 30.0  # ratio of largest to least intensity, from which intensities are spaced by a factor
TEXT_COLUMNS = ("structure", "limit_state", "measure", "unit", "kind")
NUMBER_COLUMNS = ("median", "dispersion", "scale", "x", "probability", "low", "high")
LOWER_COLUMNS = tuple(f"lower_{name}" for name in ("median", "dispersion", "scale", "probability", "low", "high"))
"""Columns of the fit that counts runs of unknown outcome as not exceeding the limit state."""
COLUMNS = (*NUMBER_COLUMNS, "unknown", *LOWER_COLUMNS)


def curve_blocks(curves: Sequence[Fragility]) -> Iterator[Mapping[str, Sequence[object] | NDArray[Any]]]:
    """Yield the curves as tables, one after the other, from the least intensity of the data to the largest.

    Yields
    ------
    mapping of str to sequence
        The columns. `dispersion` belongs to lognormal curves, `scale` to logistic ones; each is NaN for the others.
        `unknown` is the share of undecided runs, NaN if nothing was checked: they count as exceeding in the curve
        itself, and as not exceeding in columns whose names begin with `lower_`.
    """
    drawn = [each for each in curves if any(fit.curve.kind != "none" for fit in (each, each.lower or each))]
    if not drawn:
        yield {**{name: np.array([], dtype=str) for name in TEXT_COLUMNS}, **{name: np.array([]) for name in COLUMNS}}
    for each in drawn:
        x = points(each)
        words = (each.structure, f"{each.limit}", each.measure, parse_measure(each.measure).unit, each.curve.kind)
        one, other = (_fit(fit.curve, x) for fit in (each, each.lower or each))
        values = [*words, *one[:3], x, *one[3:], np.nan if each.share is None else each.share, *other]
        yield stacked([dict(zip((*TEXT_COLUMNS, *COLUMNS), values, strict=True))])


def _fit(curve: FragilityCurve, x: NDArray[np.float64]) -> list[Any]:
    """Return median, dispersion, scale, and the lines at intensities; NaN where missing."""
    numbers = (curve.median, curve.dispersion, curve.scale)
    return [*(np.nan if each is None else each.value for each in numbers), *curve.lines(x)]


def points(found: Fragility) -> NDArray[np.float64]:
    """Return the intensities of the rows of a curve, with the ends of the interval of a step, and both sides of it."""
    least, most = float(found.seen.x.min()), float(found.seen.x.max())
    between = np.geomspace if most > MIN_LOG_RATIO * least else np.linspace
    x: NDArray[np.float64] = between(least, most, CURVE_POINTS)
    steps = [step for curve in (found.curve, (found.lower or found).curve) for step in curve.steps]
    return np.union1d(x, [end for step in steps for end in (step.low, step.value, step.high)])


def run_blocks(store: Store, plan: Plan, measures: Sequence[str] = ()) -> Iterator[Mapping[str, Sequence[object]]]:
    """Yield the finished runs as blocks of a table, in the order of their numbers.

    Parameters
    ----------
    store : Store
        Open to read.
    plan : Plan
        The plan of its runs.
    measures : sequence of str
        Measures with a column, in addition to those that every table has.

    Yields
    ------
    mapping of str to sequence
        The columns by heading, with units; the first block is yielded even if it is empty.
    """
    asked, study = tuple(dict.fromkeys([*USUAL_MEASURES, *measures])), store.fact("description")
    rows = None
    for rows in store.rows(0, plan.size):
        yield _of_runs(plan, rows, asked, study)
    if rows is None:
        yield _of_runs(plan, NO_RUNS, asked, study)


def _of_runs(plan: Plan, rows: RunRows, measures: Sequence[str], study: Mapping[str, Any]) -> dict[str, list[Any]]:
    sample, record, _, level, polarity = plan.places(rows.run)
    trials, records = [plan.trials[k] for k in sample], [plan.records[k] for k in record]
    fell_to = np.where(np.isin(rows.outcome, (FAILED, UNKNOWN)), 0, np.sign(rows.outcome))
    return {
        "run": rows.run.tolist(),
        "structure": [each.structure for each in trials],
        "sample": [each.number for each in trials],
        "motion": [each.name for each in records],
        "level": np.array(plan.levels)[level].tolist(),
        "polarity": np.array(plan.polarities)[polarity].tolist(),
        "restitution": rows.eta.tolist(),
        "scale": rows.scale.tolist(),
        **{label(name): plan.intensities(name, sample, record, level, rows.scale).tolist() for name in measures},
        "outcome": [
            "failed" if code == FAILED else "falls off an edge" if abs(code) == OFF_EDGE
            else names.outcome(uplifts=rise >= 0, overturned=code != STANDS, unknown=code == UNKNOWN, slides=slip > 0)
            for code, rise, slip in np.stack([rows.outcome, rows.uplift_time, rows.slip], axis=1).tolist()
        ],
        "fell_to": fell_to.tolist(),
        # Infinite, so that no comparison or quantile of peaks takes what overturns for safe.
        "peak_ratio": np.where(fell_to != 0, np.inf, rows.peak_ratio).tolist(),
        "peak_positive [rad]": rows.peak_positive.tolist(),
        "peak_negative [rad]": rows.peak_negative.tolist(),
        "uplift_time [s]": rows.uplift_time.tolist(),
        "overturning_time [s]": rows.overturning_time.tolist(),
        "known_to [s]": rows.known_to.tolist(),
        "peak_lower_bound": rows.lower_bound.tolist(),
        "opening": rows.opening.tolist(),
        "slip [m]": rows.slip.tolist(),
        **({"slide_time [s]": rows.slide_time.tolist()} if SLIDING in study else {}),
        **({"engine": np.where(rows.by_blocks, "blocks", "exact").tolist()} if "engine" in study else {}),
    }  # fmt: skip
