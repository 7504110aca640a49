"""What decides the verdict on time histories: how well equivalent blocks agree, until when results are valid.

No words: `rocking_cli.views.verdict` has them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import inf

import numpy as np

from rocking_cli import names
from rocking_cli.core.equivalence import Grade, grade
from rocking_cli.dynamics.history import History
from rocking_cli.dynamics.model import ModelName

NEAR_OVERTURNING = 0.8  # phi/phi_cr from which a motion is close to overturning
# Rms of the difference from the nonlinear motion over the rms of that motion, up to which another model agrees, and is
# good for a first estimate. Two unrelated motions of equal size have a ratio of 1.4.
AGREEING_RMS, ESTIMATING_RMS = 0.25, 0.5
SAME_PEAK_DELAY = 1.0  # p times the largest delay of peaks, or overturnings, that count as the same
PEAK_SHARE = 0.999  # a sample above this share of the largest one is the peak, as rounding may put the largest later


@dataclass(frozen=True)
class Agreement:
    """Agreement of the motion of an equivalent block with that of the nonlinear model.

    Parameters
    ----------
    grade : Grade
        Grade of the block under this motion, by the largest of the errors below. The block is also to be disregarded if
        its uplift acceleration is far in error, or if only one of the two models overturns, or uplifts.
    uplift_error : float
        Relative error of the uplift acceleration in the worse direction; it does not depend on the motion.
    same_fate : bool
        Whether both models overturn, both rock, or neither uplifts.
    peak_error : float or None
        Relative error of the largest phi/phi_cr; None unless both rock.
    peak_delay : float or None
        Time by which the peak, or overturning, of the block is later [s]; None unless both overturn, or both rock
        within their samples.
    difference : float or None
        The rms of the difference of phi/phi_cr over that of the nonlinear motion, until both are at rest or the samples
        end; None unless both rock, and do so within their samples.
    """

    grade: Grade
    uplift_error: float
    same_fate: bool
    peak_error: float | None = None
    peak_delay: float | None = None
    difference: float | None = None

    @property
    def unfit(self) -> bool:
        """Whether the error of the uplift acceleration alone is so large that the block is to be disregarded."""
        return grade(self.uplift_error) is Grade.DISREGARD


def agreements(histories: Mapping[ModelName, History]) -> dict[ModelName, Agreement]:
    """Compare the motion of each equivalent block with that of the nonlinear model.

    It is empty without the latter, and where this is unknown or only slides, which no equivalent block does.

    Parameters
    ----------
    histories : mapping of str to History
        Histories of models of one structure under one motion, on the same samples.
    """
    best = histories.get("nonlinear")
    if best is None or best.unknown or best.slip:
        return {}
    return {name: _compare(run, best) for name, run in histories.items() if name != "nonlinear"}


def _compare(run: History, best: History) -> Agreement:
    same = _fate(run) == _fate(best)
    peak = delay = apart = None
    if not same:
        worst = Grade.DISREGARD
    elif best.fell:
        delay = run.overturning_time - best.overturning_time
        alike = run.fell_to == best.fell_to and abs(delay) * best.p <= SAME_PEAK_DELAY
        worst = Grade.AGREES if alike else Grade.ESTIMATE
    elif not best.peak_ratio:
        worst = Grade.AGREES
    else:
        peak = run.peak_ratio / best.peak_ratio - 1
        worst = grade(peak)
        if run.ratio.any() and best.ratio.any():  # a motion may start and end between two samples
            delay, apart = peak_time(run) - peak_time(best), _difference(run, best)
            late = Grade.ESTIMATE if abs(delay) * best.p > SAME_PEAK_DELAY else Grade.AGREES
            worst = max(worst, grade(apart, AGREEING_RMS, ESTIMATING_RMS), late)
    if grade(run.uplift_error) is Grade.DISREGARD:
        worst = Grade.DISREGARD
    return Agreement(worst, run.uplift_error, same, peak, delay, apart)


def _fate(run: History) -> str:
    return names.OVERTURNS if run.fell else names.ROCKS if run.peak_ratio else names.NO_UPLIFT


def peak_time(run: History) -> float:
    """Return the time of the peak rotation of a history that is known to its end and does not overturn [s]."""
    size = np.abs(run.ratio)
    return float(run.time[int((size >= PEAK_SHARE * size.max()).argmax())])


def _difference(run: History, best: History) -> float:
    shared = min(run.ratio.size, best.ratio.size)  # a history ends when its structure is at rest
    beyond = float(np.sum(run.ratio[shared:] ** 2) + np.sum(best.ratio[shared:] ** 2))
    apart = float(np.sum((run.ratio[:shared] - best.ratio[:shared]) ** 2))
    return float(np.sqrt((apart + beyond) / np.sum(best.ratio**2)))


def disagree(histories: Mapping[ModelName, History]) -> bool:
    """Return whether the models that are fit for the structure differ in whether it overturns; none is if it slides."""
    if any(run.slip for run in histories.values()):
        return False
    fit = [run for run in histories.values() if grade(run.uplift_error) is not Grade.DISREGARD and not run.unknown]
    return len({run.fell for run in fit}) > 1


def remedy(history: History) -> str:
    """Return what to do about an unknown outcome: a value of `NextStep`."""
    check = history.check
    if history.unmeasured:
        return "give_restitution"
    if history.bound is not None and history.bound.kind == "yields":
        return "stronger_bar"
    if check is not None and not history.apart and history.bound is None:
        if check.reason == "slides":
            return "hold_joint"
        if check.reason == "opens" and not check.alone:
            return "hinge_at_joint"
    return "assume_overturning"


def known_until(histories: Mapping[ModelName, History]) -> float:
    """Return the time until which the histories of one structure are valid [s]; infinite if the outcome is known.

    After that time the histories of the equivalent blocks are not valid either, as these have no joints.
    """
    if "blocks" in histories:  # which go on where one degree of freedom ends
        return inf
    return min((run.known_to for run in histories.values() if run.unknown), default=inf)
