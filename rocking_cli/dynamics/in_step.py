"""Columns that may fall out of step: whether one of them, rocking alone, shares the outcome of the structure.

From the first impact of three or more columns under one beam, statics does not determine which of them carries it. The
least favourable distribution leaves one without any load, so that it rocks alone. Where its outcome differs from that
of the structure in step, the outcome is unknown from the first impact on.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import numpy as np
from numpy.typing import NDArray

from rocking_cli.dynamics import kernels
from rocking_cli.dynamics.deck import lay_out, read_marks, run_deck
from rocking_cli.dynamics.model import Model
from rocking_cli.dynamics.parallel import in_parts
from rocking_cli.excitation.base import GroundMotion

Reals = NDArray[np.float64]
Bools = NDArray[np.bool_]
UNIT = 256  # histories a thread takes at a time
LEAST_ETA = 1e-3  # of a column alone whose restitution is shifted with that of the structure


def out_of_step(
    models: Sequence[Model],
    motions: Sequence[GroundMotion | None],
    rows: Reals,
    marks: Reals,
    tilts: Reals,
    *,
    rtol: float,
    most_impacts: int,
    threads: int | None = None,
) -> Bools:
    """Return for each run whether a column alone ends otherwise than the structure after a first impact, shape (n,).

    Parameters
    ----------
    models : sequence of Model
        Models of the runs; only those with models of columns alone are simulated again.
    motions : sequence of GroundMotion or None
        The ground motions.
    rows, marks : ndarray, shape (n, ...)
        Runs of the kernel, and what it found.
    tilts : ndarray, shape (n,)
        Signed rotation from which each run starts, over phi_cr.
    rtol, most_impacts, threads
        As in `respond_many`.
    """
    differs = np.zeros(len(rows), bool)
    own = rows[:, kernels.STRUCTURE].astype(np.int64)
    for k, model in enumerate(models):
        mine = np.flatnonzero((own == k) & (marks[:, kernels.IMPACTS] > 0))
        for column in model.columns if mine.size else ():
            there, found = rows[mine].copy(), np.full((mine.size, kernels.MARKS), np.nan)
            there[:, kernels.STRUCTURE] = 0
            there[:, kernels.START] = [column.q(tilt) for tilt in tilts[mine].tolist()]
            for place, eta, of in zip((kernels.ETA_POSITIVE, kernels.ETA_NEGATIVE), column.eta, model.eta, strict=True):
                there[:, place] = np.clip(eta + there[:, place] - of, LEAST_ETA, 1.0)  # NaN stays
            deck = lay_out([column], motions)
            run = partial(run_deck, deck, there, found, rtol=rtol, most_impacts=most_impacts, brief=True)
            in_parts(run, len(there), UNIT, threads, None)
            alone, whole = (
                read_marks(each, np.array([of.phi_cr]), np.array([of.reach]))
                for each, of in ((found, column), (marks[mine], model))
            )
            differs[mine] |= alone.unknown | (alone.fell != whole.fell)
    return differs
