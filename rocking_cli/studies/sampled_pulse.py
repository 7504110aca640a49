"""The history of any model of a structure under a pulse of any shape, sampled finely enough."""

from __future__ import annotations

from dataclasses import dataclass

from rocking_cli.dynamics.history import History
from rocking_cli.dynamics.model import ModelName
from rocking_cli.engines import engine_of
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
        Under the finest sampling.
    per_period : int
        Its samples to a period.
    converged : bool
        Whether half as many give the same peak ratio to 1e-6 of it, overturn likewise, or are of unknown outcome, too.
    """

    history: History
    per_period: int
    converged: bool


def sampled_history(structure: Structure, model: ModelName, pulse: Pulse, polarity: int = 1) -> SampledHistory:
    """The history of a model under a pulse, its sampling refined until that changes nothing.

    Parameters
    ----------
    structure : Structure
        What the pulse shakes.
    model : {"nonlinear", "linear1", "linear2"}
        Which equation of motion.
    pulse : Pulse
        Any.
    polarity : {1, -1}
        -1 reverses the pulse.

    Returns
    -------
    SampledHistory

    Notes
    -----
    The motion under n samples to a period is off by order n^-4 of its peak, n^-3 where it only just uplifts: the last
    halving of the interval changes at least seven times as much as is left to change.
    """
    engine, before, per_period = engine_of(structure), None, COARSEST
    while True:
        motion = pulse.sampled(per_period).scaled(polarity)
        history = engine.follow(structure, motion, model=model, tail=0.0)
        converged = before is not None and _alike(before, history)
        if converged or per_period >= FINEST:
            return SampledHistory(history, per_period, converged)
        before, per_period = history, 2 * per_period


def _alike(one: History, other: History) -> bool:
    if one.unknown or other.unknown:
        return one.unknown and other.unknown
    if one.overturned or other.overturned:
        return (one.fell_to, one.impact_count) == (other.fell_to, other.impact_count)
    return abs(one.peak_ratio - other.peak_ratio) <= WITHIN * other.peak_ratio
