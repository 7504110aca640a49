"""The runs of a study as a table, in blocks, so that a long study need not fit in memory."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from math import isnan

import numpy as np

from rocking_cli import names
from rocking_cli.studies.fragility.intensity import ALWAYS, label
from rocking_cli.studies.fragility.plan import Plan
from rocking_cli.studies.fragility.store import FAILED, SLIDE, STANDS, UNKNOWN, RunRows, Store

ROWS = 100_000  # runs of a block
HEADINGS = {
    "known_to": "known to [s]", "lower_bound": "phi/phi_cr at least", "opening": "opening/D_cr", SLIDE: "sliding [s]",
}  # fmt: skip
"""Headings of the columns that not every store has."""


def blocks(store: Store, plan: Plan, measures: Sequence[str] = ()) -> Iterator[Mapping[str, Sequence[object]]]:
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
    end, asked = int(np.prod(plan.shape)), tuple(dict.fromkeys([*ALWAYS, *measures]))
    for first in range(0, end, ROWS):
        rows = store.runs(first, min(first + ROWS, end))
        if len(rows) or first == 0:
            yield _columns(plan, rows, asked)


def _columns(plan: Plan, rows: RunRows, measures: Sequence[str]) -> dict[str, Sequence[object]]:
    sample, record, _, level, polarity = plan.places(rows.id)
    trials, records = [plan.trials[k] for k in sample], [plan.records[k] for k in record]
    return {
        "run": rows.id.tolist(),
        "structure": [each.structure for each in trials],
        "sample": [each.number for each in trials],
        "record": [each.name for each in records],
        "level": np.array(plan.levels)[level].tolist(),
        "polarity": np.array(plan.polarities)[polarity].tolist(),
        "eta": rows.eta.tolist(),
        "scale": rows.scale.tolist(),
        **{label(name): plan.intensities(name, sample, record, level, rows.scale).tolist() for name in measures},
        "outcome": [_outcome(*each) for each in zip(rows.outcome.tolist(), rows.uplift_time.tolist(), strict=True)],
        "fell_to": np.where(np.abs(rows.outcome) == 1, rows.outcome, 0).tolist(),
        "phi/phi_cr": rows.peak_ratio.tolist(),
        "phi positive [rad]": rows.peak_positive.tolist(),
        "phi negative [rad]": rows.peak_negative.tolist(),
        "uplift [s]": rows.uplift_time.tolist(),
        "overturning [s]": rows.overturning_time.tolist(),
        **{HEADINGS[name]: getattr(rows, name).tolist() for name in rows.columns if name in HEADINGS},
    }


def _outcome(code: int, uplift_time: float | None) -> str:
    if code == FAILED:
        return "failed"
    lifts = uplift_time is not None and not isnan(uplift_time)
    return names.outcome(uplifts=lifts, overturned=code != STANDS, unknown=code == UNKNOWN)
