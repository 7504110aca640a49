"""Time history of any model of a structure under a sampled pulse of any shape, with convergence of the sampling."""

from __future__ import annotations

from dataclasses import dataclass

from rocking_cli.dynamics.history import History
from rocking_cli.dynamics.model import ModelName
from rocking_cli.engines import follow
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.excitation.pulses import Pulse
from rocking_cli.structure import Structure

COARSEST, FINEST = 1000, 32_000  # samples to a period
WITHIN = 1e-6


@dataclass(frozen=True, eq=False)
class SampledHistory:
    """A history under a sampled pulse.

    Parameters
    ----------
    history : History
        The history under the finest sampling.
    motion : GroundMotion
        The pulse so sampled.
    per_period : int
        Number of samples in a period.
    converged : bool
        Whether half as many samples give the same outcome, and the same peak ratio within a relative 1e-6.
    """

    history: History
    motion: GroundMotion
    per_period: int
    converged: bool


def sampled_history(structure: Structure, model: ModelName, pulse: Pulse, polarity: int = 1) -> SampledHistory:
    """Simulate a model under a pulse, with the sampling refined until the result does not change.

    Parameters
    ----------
    structure : Structure
        The structure.
    model : {"nonlinear", "linear1", "linear2"}
        The equation of motion.
    pulse : Pulse
        Any pulse.
    polarity : {1, -1}
        -1 reverses the pulse.

    Returns
    -------
    SampledHistory

    Notes
    -----
    With n samples to a period, the error of the motion is of order n^-4 of its peak, n^-3 if it only just uplifts: the
    last halving of the interval changes the result at least seven times as much as the error that remains.
    """
    before, per_period = None, COARSEST
    while True:
        motion = pulse.sampled(per_period).scaled(polarity)
        history = follow(structure, motion, model=model, tail=0.0)
        converged = before is not None and _alike(before, history)
        if converged or per_period >= FINEST:
            return SampledHistory(history, motion, per_period, converged)
        before, per_period = history, 2 * per_period


def _alike(one: History, other: History) -> bool:
    if one.unknown or other.unknown:
        return one.unknown and other.unknown
    if one.fell or other.fell:
        return (one.fell_to, one.impact_count) == (other.fell_to, other.impact_count)
    return abs(one.peak_ratio - other.peak_ratio) <= WITHIN * other.peak_ratio
