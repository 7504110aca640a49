"""Whether the joints of a structure hold in a time history, and until when its result is valid, in words."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import inf, isfinite, isnan

from rocking_cli.core.contacts import MASONRY
from rocking_cli.dynamics.history import History
from rocking_cli.dynamics.joints import JointCheck
from rocking_cli.dynamics.model import ModelName
from rocking_cli.names import percent

ASSUMED = (
    "The friction required, {:.3g}, is more than the {:g} usual for masonry: the result assumes that nothing slides."
)
NO_JOINTS = "The equivalent blocks have no joints, so their results are not those of the structure."
INSTANT = 1e-6  # of D_cr: less of an opening is said to be none
# By comparison with free blocks: a peak below this share of phi_cr is off by some 20 % if a joint opens by more than
# that share of D_cr.
SMALL_PEAK, SMALL_PEAK_OPENING, SMALL_PEAK_ERROR = 0.02, 0.001, 0.2
NEXT = "Next: `rocking margin` shows up to which scale factor the outcome is known. Under this motion, {}."
OVERTURNS = "assume that it overturns"
REMEDIES = {
    "hinge_at_joint": f"describe the structure as a linkage that hinges at the joint that opens, or {OVERTURNS}",
    "hold_joint": f"anchor the joint that slides or justify a higher friction, or {OVERTURNS}",
    "assume_overturning": OVERTURNS,
}


def unchecked(name: str = "", why: str = "it does not say which of them stay closed") -> str:
    """Return the caution that the joints of a structure are not checked.

    Parameters
    ----------
    name : str
        The name of the structure, if it is one of several.
    why : str
        The reason, or what to give, see `Mechanism.unchecked`.
    """
    of = f"{name}: " if name else ""
    return f"Caution: {of}the joints of this mechanism are not checked: {why}."


def joints_in_words(history: History, assumed_friction: float | None = None) -> str:
    """Return whether the joints hold in a nonlinear history, in words; empty if none could open, or none is checked.

    Parameters
    ----------
    history : History
        History of the nonlinear model.
    assumed_friction : float, optional
        Friction that the joints require, if the structure gives none and it is more than masonry usually has. The
        result is then not called valid.

    Returns
    -------
    str
        A few sentences: all joints hold; or one opens by so little that the result is valid; or until when the result
        is valid, why, and what to do next.
    """
    check = history.check
    slides = [] if assumed_friction is None else [ASSUMED.format(assumed_friction, MASONRY)]
    if history.unknown:
        return " ".join([_until(history), *slides, NEXT.format(REMEDIES[remedy(history)])])
    if check is None:
        return " ".join(slides)
    if isnan(check.warned) and check.alone:
        return " ".join(slides)
    taken = [f"Not checked, but assumed to hold: {', '.join(check.asserted)}."] if check.asserted else []
    if check.largest >= INSTANT * check.reach and not isnan(check.warned):
        return " ".join([*_opens(history, check, valid=not slides), *slides, *taken])
    which = f" ({'; '.join(check.checked)})" if check.checked else ""
    but = f", except the joint between {check.warned_joint} for an instant at {check.warned:.4g} s"
    when = "throughout the motion" if check.at_rest else "while the structure rocks"
    bear = f"All checked joints bear {when}{which}{'' if isnan(check.warned) else but}."
    return " ".join([bear, *slides, *taken])


def remedy(history: History) -> str:
    """Return what to do about an unknown outcome: a key of `REMEDIES`."""
    check = history.check
    if check is not None and not history.apart:
        if check.reason == "slides":
            return "hold_joint"
        if check.reason == "opens" and not check.alone:
            return "hinge_at_joint"
    return "assume_overturning"


def _opens(history: History, check: JointCheck, *, valid: bool) -> Iterator[str]:
    """Yield by how much a joint opens, less than the limit, and what this means for outcome and peak."""
    uncertain = 0 < history.peak_ratio < SMALL_PEAK and check.largest > SMALL_PEAK_OPENING * check.reach
    kept = "outcome remains" if uncertain else "outcome and the peak remain"
    yield (
        f"The joint between {check.largest_joint} opens or slides by up to {_small(check.largest, 'm')} "
        f"({percent(check.largest / check.reach)} of D_cr; the limit is {percent(check.limit)}), for at most "
        f"{_small(check.longest, 's')} at a time: less than the limit{f', so the {kept} valid' if valid else ''}."
    )
    if uncertain:
        yield (
            f"The peak is uncertain by some {percent(SMALL_PEAK_ERROR)}, as it is below {SMALL_PEAK:g} of the "
            f"{history.reference} and the opening is above {percent(SMALL_PEAK_OPENING)} of D_cr."
        )


def known_until(histories: Mapping[ModelName, History]) -> float:
    """Return the time until which the histories of one structure are valid [s]; infinite if the outcome is known.

    After that time the histories of the equivalent blocks are not valid either, as these have no joints.
    """
    return min((run.known_to for run in histories.values() if run.unknown), default=inf)


def why_unknown(history: History) -> str | None:
    """Return why a history is not valid beyond its `known_to`, in words; None if all of it is valid."""
    check = history.check
    if not history.unknown:
        return None
    if history.apart:
        return (
            "three or more columns may fall out of step at an impact, and one that carries nothing, rocking alone, "
            "ends otherwise"
        )
    if check is None or check.reason in (None, "weightless"):
        return "nothing holds the structure down, as v_g'' comes down to -g"
    if check.reason == "crushes":
        return f"the joint between {check.joint} crushes: its normal force exceeds its strength"
    does = "has slid by" if check.reason == "slides" else "has opened by"
    limit = f"{percent(check.limit)} of D_cr = {check.reach:.3g} m, by which the farthest block moves up to phi_cr"
    return f"the joint between {check.joint} {does} {_small(check.limit * check.reach, 'm')} ({limit})"


def unknown_after(history: History) -> str:
    """Return the sentence that an outcome is unknown: until when it is known, and why not beyond."""
    return f"The outcome is unknown after {history.known_to:.4g} s: then {why_unknown(history)}."


def _until(history: History) -> str:
    """Return until when a history is valid and why not beyond, in words, with the lower bound of the peak."""
    said = f"{unknown_after(history)} The structure may overturn."
    over = "its kinematic limit" if any(history.ends_at_limit) else "its critical rotation"
    if not history.peak_ratio:
        return f"{said} Until then it does not uplift."
    if isfinite(history.warned) and history.lower_bound < history.peak_ratio:
        return (
            f"{said} Until then the model, which keeps the joints closed, has a peak of {history.peak_ratio:.4g} of "
            f"{over}. A lower bound of the peak is {history.lower_bound:.4g}, that before any joint opens or slides."
        )
    return f"{said} A lower bound of the peak is {history.lower_bound:.4g} of {over}, that until then."


def _small(value: float, unit: str) -> str:
    return f"{value:.3g} {unit}" if value >= 0.5 else f"{1000 * value:.3g} m{unit}"
