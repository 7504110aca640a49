"""Compute how often intervals of fragility curves cover the true value, in seeded trials.

The result is the table of docs/fragility.md.

    python docs/make_coverage.py [TRIALS]

Each trial draws capacities of known median and dispersion, runs them at some levels, fits, and looks. It takes minutes.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from rocking_cli.questions.fragility.curves import FragilityCurve, Observations, fit_capacities, fit_curve

MEDIAN, DISPERSION = 0.4, 0.5
RECORDS = (5, 10, 20, 50)
TRIALS = 2000


def _capacities(random: np.random.Generator, records: int, each: int, shared: float) -> np.ndarray:
    """Capacities, a row a record, of whose variance so much is from record to record."""
    scatter = np.sqrt(shared) * random.normal(size=(records, 1))
    scatter = scatter + np.sqrt(1 - shared) * random.normal(size=(records, each))
    return np.asarray(MEDIAN * np.exp(DISPERSION * scatter))


def _stripes(random: np.random.Generator, records: int, levels: int, samples: int, shared: float) -> FragilityCurve:
    x = np.tile(np.repeat(np.geomspace(0.15, 1.1, levels), samples), (records, 1))
    exceeded = x > _capacities(random, records, levels * samples, shared)
    return fit_curve(Observations.of(x.ravel(), exceeded.ravel(), np.repeat(np.arange(records), levels * samples)))


def _ladders(random: np.random.Generator, records: int, each: int, shared: float) -> FragilityCurve:
    ends = np.concatenate([[0.0], np.geomspace(0.1, 2.0, 12), [np.inf]])
    place = np.searchsorted(ends, _capacities(random, records, each, shared).ravel())
    return fit_capacities(ends[place - 1], ends[place], np.repeat(np.arange(records), each))


@dataclass(frozen=True)
class Case:
    """Kind of study: its description, and how to draw one with a number of records."""

    words: str
    draw: Callable[[np.random.Generator, int], FragilityCurve]


CASES = (
    Case("stripes of 6 levels, runs of a record alike by chance", lambda random, n: _stripes(random, n, 6, 1, 0.0)),
    Case("half of the variance from record to record", lambda random, n: _stripes(random, n, 6, 1, 0.5)),
    Case("all of it", lambda random, n: _stripes(random, n, 6, 1, 1.0)),
    Case("all of it, 12 levels", lambda random, n: _stripes(random, n, 12, 1, 1.0)),
    Case("half of it, 10 samples at a level", lambda random, n: _stripes(random, n, 6, 10, 0.5)),
    Case("ida of 12 levels, one capacity a record", lambda random, n: _ladders(random, n, 1, 0.0)),
    Case("four capacities, half of the variance", lambda random, n: _ladders(random, n, 4, 0.5)),
)


def held(case: Case, records: int, trials: int, seed: int) -> tuple[int, int, int]:
    """Count trials with a lognormal fit, and those whose intervals of median and of dispersion cover the true value."""
    random = np.random.default_rng([seed, records, *case.words.encode()])
    fitted = median = dispersion = 0
    for _ in range(trials):
        curve = case.draw(random, records)
        if curve.kind == "lognormal" and curve.median is not None and curve.dispersion is not None:
            fitted += 1
            median += curve.median.low <= MEDIAN <= curve.median.high
            dispersion += curve.dispersion.low <= DISPERSION <= curve.dispersion.high
    return fitted, median, dispersion


def main(trials: int) -> None:
    """Print the table."""
    print("| records | " + " | ".join(str(n) for n in RECORDS) + " |")
    print("| --- |" + " --- |" * len(RECORDS))
    for case in CASES:
        cells = []
        for n in RECORDS:
            fitted, median, dispersion = held(case, n, trials, seed=1)
            cells.append(f"{100 * median / fitted:.0f}, {100 * dispersion / fitted:.0f}")
        print(f"| {case.words} | " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else TRIALS)
