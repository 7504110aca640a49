"""Check of batches: outcomes in several threads against those in one thread."""

from __future__ import annotations

from functools import partial

import numpy as np

from rocking_cli.core.registry import Registry
from rocking_cli.dynamics import batch, exact_batch
from rocking_cli.dynamics.batch import Runs, respond_many
from rocking_cli.dynamics.exact_batch import exact_many
from rocking_cli.dynamics.outcome import OUTCOME, Outcomes
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.excitation.pulses.shapes import Sine
from rocking_cli.structure import Structure
from rocking_cli.studies.selfcheck.comparing import different_values
from rocking_cli.studies.selfcheck.free_block import FreeBlock
from rocking_cli.studies.selfcheck.motions import MOTIONS

THREADS = 4


def deviation(quick: bool) -> float:
    """Return how many values of the outcomes differ in any bit."""
    parts = 2 if quick else THREADS
    return _of_histories(parts) + _of_pulses(parts)


def _of_histories(parts: int) -> int:
    """Compare histories in so many parts, each of which is done by one thread."""
    wall = Structure(Registry()["wall"].from_fields({"thickness": 0.3, "height": 3.0}))  # with a joint that is checked
    models = [wall.model("nonlinear"), *FreeBlock(0.7, 2.8).structure().models(("nonlinear", "linear2"))]
    scales = np.linspace(0.5, 2.0, parts * batch.UNIT // (len(models) * len(MOTIONS)))
    runs = Runs.every(len(models), len(MOTIONS), scales=scales.tolist())
    return _different(*(respond_many(models, MOTIONS, runs, threads=n, only_peaks=True) for n in (1, THREADS)))


def _of_pulses(parts: int) -> int:
    """Compare pulses in so many parts."""
    count, block = parts * exact_batch.UNIT, FreeBlock(0.7, 2.8).structure()
    amplitudes, periods = np.geomspace(2.0, 20.0, count), np.geomspace(3.0, 0.3, count)
    follow = partial(
        exact_many, block.equivalence, Sine(1.0, 1.0), amplitudes, periods, kappa=2, gravity=STANDARD_GRAVITY
    )
    return _different(*(follow(threads=n) for n in (1, THREADS)))


def _different(one: Outcomes, other: Outcomes) -> int:
    return sum(different_values(getattr(one, name), getattr(other, name)) for name in OUTCOME)
