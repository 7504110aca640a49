"""Verdict on the time histories of a structure in words, and how well its equivalent blocks agree with them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from rocking_cli import names
from rocking_cli.core import Direction
from rocking_cli.core.advice import Grade, grade, uplift_in_words
from rocking_cli.dynamics.history import History
from rocking_cli.dynamics.holding import NO_JOINTS, joints_in_words
from rocking_cli.dynamics.model import ModelName
from rocking_cli.names import percent

CLOSE = 0.8  # phi/phi_cr from which a motion is close to overturning
# Of two motions, the rms of the difference over that of the nonlinear one, up to which the other agrees with it, and
# serves a first estimate. Two motions of one size that have nothing to do with each other differ by 1.4 of it.
FOLLOWS, STRAYS = 0.25, 0.5
TOGETHER = 1e-2  # s within which two motions are at one time
ANOTHER = 1.0  # p times the time between two peaks, or overturnings, beyond which they are not the same one
PEAK = 0.999  # of its largest sample: when a motion first comes so far it has its peak, rounding apart
SENSE = {Direction.POSITIVE: "clockwise", Direction.NEGATIVE: "anticlockwise"}


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
    """Compare the motion of each equivalent block with that of the nonlinear model; empty without the latter.

    Parameters
    ----------
    histories : mapping of str to History
        Histories of models of one structure under one motion, on the same samples.
    """
    if "nonlinear" not in histories or histories["nonlinear"].unknown:
        return {}
    best = histories["nonlinear"]
    return {name: _compare(run, best) for name, run in histories.items() if name != "nonlinear"}


def _compare(run: History, best: History) -> Agreement:
    same = _fate(run) == _fate(best)
    peak = delay = apart = None
    if not same:
        found = Grade.DISREGARD
    elif best.fell:
        delay = run.overturning_time - best.overturning_time
        alike = run.fell_to == best.fell_to and abs(delay) * best.p <= ANOTHER
        found = Grade.AGREES if alike else Grade.ESTIMATE
    elif not best.peak_ratio:
        found = Grade.AGREES
    else:
        peak = run.peak_ratio / best.peak_ratio - 1
        found = grade(peak)
        if run.ratio.any() and best.ratio.any():  # else one has come and gone between two samples
            delay, apart = _peak_time(run) - _peak_time(best), _difference(run, best)
            late = Grade.ESTIMATE if abs(delay) * best.p > ANOTHER else Grade.AGREES
            found = max(found, grade(apart, FOLLOWS, STRAYS), late)
    if grade(run.uplift_error) is Grade.DISREGARD:
        found = Grade.DISREGARD
    return Agreement(found, run.uplift_error, same, peak, delay, apart)


def _fate(run: History) -> str:
    return names.OVERTURNS if run.fell else names.ROCKS if run.peak_ratio else names.NO_UPLIFT


def _peak_time(run: History) -> float:
    size = np.abs(run.ratio)
    return float(run.time[int((size >= PEAK * size.max()).argmax())])


def _difference(run: History, best: History) -> float:
    shared = min(run.ratio.size, best.ratio.size)  # a longer one has gone on while the other is at rest
    beyond = float(np.sum(run.ratio[shared:] ** 2) + np.sum(best.ratio[shared:] ** 2))
    apart = float(np.sum((run.ratio[:shared] - best.ratio[:shared]) ** 2))
    return float(np.sqrt((apart + beyond) / np.sum(best.ratio**2)))


def disagree(histories: Mapping[ModelName, History]) -> bool:
    """Return whether the models that are fit for the structure differ in whether it overturns."""
    fit = [run for run in histories.values() if grade(run.uplift_error) is not Grade.DISREGARD and not run.unknown]
    return len({run.fell for run in fit}) > 1


def verdict(histories: Mapping[ModelName, History], assumed_friction: float | None = None) -> str:
    """Return whether a structure uplifts, how far it rocks, whether it overturns, and which model to trust, in words.

    Parameters
    ----------
    histories : mapping of str to History
        Histories of one or more models of the same structure and motion.
    assumed_friction : float, optional
        Friction that the result assumes, see `joints_in_words`.

    Returns
    -------
    str
        A few sentences.
    """
    best: ModelName = "nonlinear" if "nonlinear" in histories else next(iter(histories))
    run = histories[best]
    by = "" if best == "nonlinear" or len(histories) == 1 else f"By {best} the"
    said = [] if run.unknown else [f"{by or 'The'} structure {_ends(run)}."]
    if run.unknown or (best == "nonlinear" and run.check is not None):
        said += filter(None, [joints_in_words(run, assumed_friction)])
    if run.unknown and len(histories) > 1:
        said.append(NO_JOINTS)
    else:
        said += bearing(histories, {name: name for name in histories})
    if not run.unknown and disagree(histories):
        said.append("Do not trust any of them alone: run weaker and stronger motions as well.")
    elif not run.fell and not run.unknown and run.peak_ratio > CLOSE and not any(run.ends_at_limit):
        said.append("This is close to overturning: run weaker and stronger motions before relying on it.")
    still = [name for name, each in histories.items() if each.still_rocking]
    if still:
        said.append(
            f"{', '.join(still)}: {names.STILL_ROCKING} long after the end of the record, and certain not to overturn."
        )
    return " ".join(said)


def _ends(run: History) -> str:
    """Return the outcome of the structure in words, which follow "it" or its name."""
    if run.unknown:
        return f"has an {names.UNKNOWN} outcome"
    if run.fell:
        return f"{names.OVERTURNS} {SENSE[Direction(run.fell_to)]}"
    if not run.peak_ratio:
        return names.NO_UPLIFT
    if run.peak_ratio > 1:
        return (
            f"{names.ROCKS}: it exceeds its critical rotation, reaching {run.peak_ratio:.4g} times it, and is brought "
            "back"
        )
    if any(run.ends_at_limit):
        return f"{names.ROCKS} to {run.furthest:.4g} rad, {run.peak_ratio:.4g} of its {run.reference}"
    return f"{names.ROCKS} to {run.peak_ratio:.4g} of its critical rotation phi_cr"


def bearing(histories: Mapping[ModelName, History], called: Mapping[ModelName, str]) -> list[str]:
    """Return a sentence on each equivalent block: its grade under this motion, and the numbers behind this.

    Parameters
    ----------
    histories : mapping of str to History
        Histories of one or more models of the same structure and motion.
    called : mapping of str to str
        Names of the models in the sentences.
    """
    agreed = agreements(histories)
    if not agreed:
        return _without_the_structure(histories, called)
    best = histories["nonlinear"]
    said = [_bears(called[name], agreement, histories[name], best) for name, agreement in agreed.items()]
    if any(
        agreement.peak_error is not None and agreement.grade is not Grade.DISREGARD for agreement in agreed.values()
    ):
        said.append(
            "This holds for this ground motion only; under another one the equivalent block may be more or less "
            "accurate."
        )
    return said


def _bears(name: str, found: Agreement, run: History, best: History) -> str:
    beside = _beside(found, run, best)
    if found.unfit:
        return f"Disregard {name}: its uplift acceleration is {uplift_in_words(found.uplift_error)}; here {beside}."
    if found.same_fate and found.grade is Grade.DISREGARD:
        return f"Disregard {name} here: {beside}."
    if not found.same_fate:
        return f"{name} disagrees: {beside}."
    return f"{name} {'agrees' if found.grade is Grade.AGREES else 'is good for a first estimate'}: {beside}."


def _beside(found: Agreement, run: History, best: History) -> str:
    """Return in words how the motion of a block differs from that of the nonlinear model."""
    if not found.same_fate:
        return f"it {_ends(run)}"
    if best.fell:
        way = " too" if run.fell_to == best.fell_to else " the other way"
        return f"it {names.OVERTURNS}{way}, {_later(found.peak_delay or 0.0)}"
    if found.peak_error is None:
        return f"it {names.NO_UPLIFT} either"
    size = percent(abs(found.peak_error))
    size = "the same" if size == percent(0) else f"{size} {'higher' if found.peak_error > 0 else 'lower'}"
    if found.difference is None or found.peak_delay is None:
        return f"its peak is {size}"
    late = f" and {_later(found.peak_delay)}" if abs(found.peak_delay) * best.p > ANOTHER else ""
    return f"its peak is {size}{late}, and its rotation history differs by {percent(found.difference)} (rms)"


def _later(delay: float) -> str:
    if abs(delay) < TOGETHER:
        return "at the same time"
    return f"{abs(delay):.3g} s {'later' if delay >= 0 else 'earlier'}"


def _without_the_structure(histories: Mapping[ModelName, History], called: Mapping[ModelName, str]) -> list[str]:
    """Return sentences on blocks without a nonlinear history: the outcomes after the first, and which are unfit."""
    _, *others = histories
    said = [f"By {called[name]} it {_ends(histories[name])}." for name in others]
    said += [
        f"Disregard {called[name]}: its uplift acceleration is {uplift_in_words(run.uplift_error)}."
        for name, run in histories.items()
        if grade(run.uplift_error) is Grade.DISREGARD
    ]
    return said
