"""Tables of a study as columns: its runs, and its curves with a row for each intensity."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from math import nan
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from rocking_cli import names
from rocking_cli.io.tables import stacked
from rocking_cli.processing.intensity import parse_measure
from rocking_cli.questions.fragility.assess import Fragility, UnknownRuns
from rocking_cli.questions.fragility.curves import FragilityCurve
from rocking_cli.questions.fragility.definition import SLIDING
from rocking_cli.questions.fragility.plan import Plan
from rocking_cli.questions.fragility.quantiles import QUANTILES, Quantiles
from rocking_cli.questions.fragility.ranking import Ranking
from rocking_cli.questions.fragility.store import FAILED, NO_RUNS, OFF_EDGE, STANDS, UNKNOWN, RunRows, Store
from rocking_cli.studies.fragility.quantities import USUAL_MEASURES, label

if TYPE_CHECKING:
    from rocking_cli.io.tables import Columns

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


def fit_rows(curves: Sequence[Fragility], rankings: Sequence[Ranking]) -> Columns:
    """Return a row for each curve: its numbers and their intervals, the test of its fit, and the rank of its measure.

    Values that do not exist are NaN; those of the rank exist if measures were ranked.
    """
    ranked = {(each.structure, measure.measure): measure for each in rankings for measure in each.measures}
    rows = []
    for each in curves:
        words = each.structure, f"{each.limit}", each.measure, each.curve.kind
        row: dict[str, object] = dict(zip(("structure", "limit_state", "measure", "kind"), words, strict=True))
        for name in ("median", "dispersion", "scale"):
            number = getattr(each.curve, name)
            row |= {f"{name}{end and '_'}{end}": getattr(number, end or "value", nan) for end in ("", "low", "high")}
        row |= {name: getattr(each.curve, name) for name in ("runs", "exceedances", "records")}
        row["unknown"] = nan if each.share is None else each.share
        row["annual_rate"] = getattr(each.rate, "rate", nan)
        tested, rank = each.curve.goodness, ranked.get((each.structure, each.measure))
        row |= {name: nan if (of := getattr(tested, name, None)) is None else of for name in ("statistic", "p_value")}
        row |= {name: getattr(rank, name, nan) for name in ("efficiency", "practicality", "proficiency")}
        rows.append(row)
    return {name: [row[name] for row in rows] for name in rows[0]} if rows else {}


def quantile_rows(found: Sequence[Quantiles], outcomes: Sequence[UnknownRuns]) -> Columns:
    """Return a row for each group of intensities, with the shares of its runs and the quantiles of their peaks."""
    checked = {each.structure for each in outcomes if each.unknown is not None}
    rows = [
        {
            "structure": each.structure, "measure": each.measure, "x": group.x, "from": group.low, "to": group.high,
            "runs": group.runs, "records": group.records, "no_uplift": group.no_uplift / group.runs,
            "overturned": group.overturned / group.runs,
            "unknown": group.unknown / group.runs if each.structure in checked else nan,
            **{f"rocking_{100 * share:g}": value for share, value in zip(QUANTILES, group.rocking, strict=True)},
            **{f"all_{100 * share:g}": value for share, value in zip(QUANTILES, group.every, strict=True)},
        }
        for each in found
        for group in each.groups
    ]  # fmt: skip
    return {name: [row[name] for row in rows] for name in rows[0]} if rows else {}


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
