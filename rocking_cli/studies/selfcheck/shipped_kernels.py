"""Check of the machine code: the shipped kernels against their source, run by Python."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from rocking_cli.core.registry import Registry
from rocking_cli.dynamics import kernels, pulse_motion, shipped, ways
from rocking_cli.dynamics.calling import PULSES, SETS, KernelSet
from rocking_cli.dynamics.deck import lay_out, run_deck
from rocking_cli.dynamics.exact import segments_of, sides_of
from rocking_cli.dynamics.model import Model
from rocking_cli.errors import RockingError
from rocking_cli.excitation.base import STANDARD_GRAVITY, GroundMotion
from rocking_cli.excitation.pulses.shapes import Sine
from rocking_cli.structure import Structure
from rocking_cli.studies.selfcheck.check import NotRun
from rocking_cli.studies.selfcheck.comparing import different_values
from rocking_cli.studies.selfcheck.free_block import FreeBlock
from rocking_cli.studies.selfcheck.motions import MOTIONS

Reals = NDArray[np.float64]
KernelOf = Callable[[KernelSet], ways.Kernel]
BLOCK = FreeBlock(0.7, 2.8)
TIE = {"name": "bar", "from": {"ground": [-3.0, 2.8]}, "to": {"at": [-0.35, 2.8]}, "area": 1e-5, "modulus": 2e11}
SAMPLES = 2000


def deviation(quick: bool) -> float:
    """Return how many of the computed values differ in any bit.

    Raises
    ------
    NotRun
        If there are no kernels for this system, or it does not load them.
    RockingError
        If the library for this system is damaged or missing.
    """
    try:
        for of in SETS.values():
            ways.MAKE[ways.READY](of)
    except shipped.Broken as error:
        raise RockingError(str(error)) from error
    except ImportError as error:
        raise NotRun(f"{error}; histories are computed by numba if it is installed, or by Python") from error
    arrays = (_computed(kernel_of, quick) for kernel_of in (ways.MAKE[ways.READY], ways.MAKE[ways.PYTHON]))
    return sum(different_values(*pair) for pair in zip(*arrays, strict=True))


def _computed(kernel_of: KernelOf, quick: bool) -> Iterator[Reals]:
    """Yield all arrays that the kernels fill."""
    yield _of_pulses(kernel_of)
    wall, tied = (
        Structure(Registry()[name].from_fields(fields))
        for name, fields in (
            ("wall", {"thickness": 0.3, "height": 3.0}),
            ("block", {"width": 0.7, "height": 2.8, "mass": 1000.0, "ties": [TIE]}),
        )
    )
    models = [*BLOCK.structure().models(("nonlinear", "linear2")), wall.model("nonlinear"), tied.model("nonlinear")]
    for motion in MOTIONS[:1] if quick else MOTIONS:
        both = replace(motion, vertical=GroundMotion("vertical", 0.07, motion.acceleration[::-1] / 2))
        for model in models:
            yield from _of_history(kernel_of, model, motion)
            yield from _of_history(kernel_of, model, both)


def _of_history(kernel_of: KernelOf, model: Model, motion: GroundMotion) -> tuple[Reals, ...]:
    """Return marks, rotations, rates and impacts of a history."""
    rows, marks = np.zeros((1, kernels.RUN_COLUMNS)), np.zeros((1, kernels.MARKS))
    rows[0, [kernels.FACTOR, kernels.V_FACTOR, kernels.SIZE, kernels.SLENDER]] = 1.0
    rows[0, [kernels.ETA_POSITIVE, kernels.ETA_NEGATIVE]] = 0.9
    phi, rate, impacts = np.zeros(SAMPLES), np.zeros(SAMPLES), np.zeros((20, 3))
    deck = lay_out([model], [motion])
    run_deck(
        deck, rows, marks, rtol=1e-9, most_impacts=20, phi=phi, rate=rate, impacts=impacts, kernel_of=kernel_of
    )  # fmt: skip
    return marks, phi, rate, impacts


def _of_pulses(kernel_of: KernelOf) -> Reals:
    """Return the results of pulses on a linear block."""
    sides = sides_of(BLOCK.structure().equivalence, kappa=2, gravity=STANDARD_GRAVITY)
    amplitudes, periods = np.geomspace(2.0, 20.0, 50), np.geomspace(3.0, 0.3, 50)
    results = np.zeros((50, pulse_motion.RESULTS))
    segments = np.array(segments_of(Sine(1.0, 1.0)), dtype=np.float64)
    kernel_of(PULSES)(sides, segments, amplitudes, periods, 0, len(results), results)
    return results
