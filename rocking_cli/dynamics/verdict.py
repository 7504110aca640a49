"""What the histories of a structure say together, in words."""

from __future__ import annotations

from collections.abc import Mapping
from math import isclose

from rocking_cli.core import Direction
from rocking_cli.dynamics.history import History, Outcome
from rocking_cli.dynamics.model import ModelName

CLOSE = 0.8  # phi/phi_cr from which a motion is close to overturning
ALIKE = 1e-6  # relative difference below which neither polarity governs
APART, NOTABLE = 0.2, 0.02  # relative and absolute difference of peak ratios from which models are far from each other
SENSE = {Direction.POSITIVE: "clockwise", Direction.NEGATIVE: "anticlockwise"}


def verdict(histories: Mapping[ModelName, History]) -> str:
    """Say whether a structure uplifts, how far it rocks, whether it overturns, and how far to trust that.

    Parameters
    ----------
    histories : mapping of str to History
        One or more models of the same structure and motion.

    Returns
    -------
    str
        A few sentences.
    """
    fallen = {name: run for name, run in histories.items() if run.overturned}
    said = []
    if len(fallen) == len(histories):
        said.append(_all_overturn(fallen))
    elif fallen:
        which = ", ".join(fallen)
        said.append(
            f"The models disagree: it overturns by {which} only. So close to overturning trust none alone; "
            "small changes of the motion decide."
        )
    else:
        said += _none_overturns(histories)
    still = [name for name, run in histories.items() if run.outcome is Outcome.STILL_ROCKING]
    if still:
        said.append(f"{', '.join(still)}: {Outcome.STILL_ROCKING.value}.")
    return " ".join(said)


def _all_overturn(fallen: Mapping[ModelName, History]) -> str:
    senses = {name: SENSE[run.fell_to] for name, run in fallen.items() if run.fell_to is not None}
    if len(set(senses.values())) == 1:
        return f"The structure overturns {next(iter(senses.values()))}."
    each = ", ".join(f"{name} {sense}" for name, sense in senses.items())
    return f"The structure overturns, but the models disagree which way ({each}): small changes of the motion decide."


def _none_overturns(histories: Mapping[ModelName, History]) -> list[str]:
    peaks = {name: run.peak_ratio or 0.0 for name, run in histories.items()}
    best: ModelName = "nonlinear" if "nonlinear" in peaks else next(iter(peaks))
    if peaks[best] == 0:
        said = ["The structure does not uplift."]
    elif peaks[best] > 1:
        said = [f"The structure passes its critical rotation, to {peaks[best]:.4g} of it, and is brought back."]
    else:
        said = [f"The structure rocks to {peaks[best]:.4g} of its critical rotation and does not overturn."]
    far = [name for name, peak in peaks.items() if abs(peak - peaks[best]) > max(APART * peaks[best], NOTABLE)]
    if far:
        each = ", ".join(f"{name} ({peaks[name]:.3g})" for name in far)
        said.append(f"Far from the {best} model: {each}.")
    if max(peaks.values()) > CLOSE:
        said.append("That is close to overturning: vary the motion before relying on it.")
    return said


def governs(runs: Mapping[int, Mapping[ModelName, History]]) -> tuple[int | None, str]:
    """Which polarity is the worse by the best model, if one is; and a sentence on it.

    Parameters
    ----------
    runs : mapping of int to mapping of str to History
        The histories under the motion as it is, 1, and reversed, -1.
    """
    model: ModelName = "nonlinear" if "nonlinear" in runs[1] else next(iter(runs[1]))
    by_model = f"by the {model} model"
    one, other = runs[1][model], runs[-1][model]
    if one.overturned != other.overturned:
        worse = 1 if one.overturned else -1
        return worse, f"Polarity {worse} governs {by_model}: it overturns, polarity {-worse} does not."
    sizes = {1: _size(one), -1: _size(other)}
    if isclose(sizes[1], sizes[-1], rel_tol=ALIKE):
        return None, f"Neither polarity governs {by_model}: they do alike."
    if one.overturned:
        worse = min(sizes, key=sizes.__getitem__)
        said = f"both overturn, this one at {sizes[worse]:.4g} s, the other at {sizes[-worse]:.4g} s"
    else:
        worse = max(sizes, key=sizes.__getitem__)
        said = f"it rocks to {sizes[worse]:.4g} of the critical rotation, the other to {sizes[-worse]:.4g}"
    return worse, f"Polarity {worse} governs {by_model}: {said}."


def _size(history: History) -> float:
    """What two polarities are compared by: the overturning time [s], else the peak ratio."""
    return (history.overturning_time if history.overturned else history.peak_ratio) or 0.0
