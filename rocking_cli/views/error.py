"""View of the errors of the equivalent block of a structure, as text and as data."""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite, isnan
from typing import Any

import numpy as np

from rocking_cli.core import Equivalence, Mechanism
from rocking_cli.core.advice import SMALL, Grade
from rocking_cli.names import percent
from rocking_cli.studies.linearisation import Errors, Linearisation, errors, preferred, velocity_ratios
from rocking_cli.views.verdict import uplift_in_words
from rocking_cli.views.view import ABSENT, Table, View, heading

NEVER = "infinite (it never uplifts)"
KEPT = 1e-9  # an error of the uplift acceleration that is none
PREFERRED = {None: None, 0: "either", 1: "kappa1", 2: "kappa2"}


def view(
    mechanism: Mechanism, equivalence: Equivalence, curves: Sequence[Linearisation], asked: Sequence[Linearisation]
) -> View:
    """Show the errors at the given values, and a verdict that also uses the curves."""
    verdict = trust(list(curves), list(asked))
    data = {
        "mechanism": mechanism.mechanism,
        "name": mechanism.name,
        "symmetric": equivalence.symmetric,
        "directions": {each.direction.label: _data(each, mechanism.gravity) for each in asked},
        "prefer": PREFERRED[preferred(list(asked))],
        "grades": {f"kappa{kappa}": errors(list(asked), kappa).grade.key for kappa in (1, 2)},
        "verdict": verdict,
    }
    title = heading(mechanism)
    tables = [
        Table(
            title if len(asked) == 1 else f"{title}, {each.direction.label} direction",
            ["error of", "at", "kappa1", "kappa2"],
            _rows(each, mechanism.gravity),
            numbers=(2, 3),
        )
        for each in asked
    ]
    return View(data, [*tables, verdict])


def _rows(each: Linearisation, gravity: float) -> list[list[str]]:
    rows = [["uplift acceleration", "", _percent(each.uplift_ratio1), _percent(each.uplift_ratio2)]]
    steps = [_percent(ratio) for ratio in velocity_ratios(each.block, gravity)]
    rows.append(["overturning velocity", f"v_imp = {each.block.v_imp:.4g} m/s", *steps])
    rows += [
        ["free period", f"phi/phi_cr = {r:g}", _percent(ratio), _percent(ratio)]
        for r, ratio in zip(each.amplitude.tolist(), each.period_ratio.tolist(), strict=True)
    ]
    rows += [
        ["overturning time", f"a/lambda = {a:g}", _percent(one), _percent(two)]
        for a, one, two in zip(
            each.acceleration.tolist(), each.overturning_ratio1.tolist(), each.overturning_ratio2.tolist(), strict=True
        )
    ]
    return rows


def _percent(ratio: float) -> str:
    if isnan(ratio):
        return ABSENT
    if ratio == float("inf"):
        return "no uplift"
    error = 100 * (ratio - 1)
    return f"{error:+.0f} %" if abs(error) >= 99.95 else f"{error:+.3g} %"


def _data(each: Linearisation, gravity: float) -> dict[str, Any]:
    one, other = velocity_ratios(each.block, gravity)

    def finite(value: float) -> float | None:
        return value if value < float("inf") else None

    return {
        "uplift_ratio": {"kappa1": each.uplift_ratio1, "kappa2": each.uplift_ratio2},
        "v_imp": each.block.v_imp,
        "v_imp_ratio": {"kappa1": finite(one), "kappa2": finite(other)},
        "free_period": [
            {"amplitude": r, "period": T, "ratio": ratio}
            for r, T, ratio in zip(
                each.amplitude.tolist(), each.period.tolist(), each.period_ratio.tolist(), strict=True
            )
        ],
        "overturning_time": [
            {"acceleration": a, "time": t, "ratio": {"kappa1": finite(one), "kappa2": two}}
            for a, t, one, two in zip(
                each.acceleration.tolist(),
                each.overturning.tolist(),
                each.overturning_ratio1.tolist(),
                each.overturning_ratio2.tolist(),
                strict=True,
            )
        ],
    }


def trust(curves: Sequence[Linearisation], asked: Sequence[Linearisation]) -> str:
    """Say which kappa to use, what error to expect, and when to use the nonlinear history instead.

    Parameters
    ----------
    curves : sequence of Linearisation
        The ratios over their ranges, increasing, one for each direction that differs.
    asked : sequence of Linearisation
        The same directions at the amplitudes and accelerations of interest.

    Returns
    -------
    str
        Some sentences; of two directions the larger error counts.
    """
    prefer = preferred(asked)
    order = (1, 2) if prefer == 1 else (2, 1)
    one, two = (_on(kappa, errors(asked, kappa)) for kappa in order)
    amplitudes = ", ".join(f"{r:g}" for r in asked[0].amplitude.tolist())
    accelerations = ", ".join(f"{a:g}" for a in asked[0].acceleration.tolist())
    worse = ", in the worse of the two directions" if len(asked) > 1 else ""
    where = f"At phi/phi_cr = {amplitudes} and {accelerations} times the uplift acceleration{worse}"
    said = [f"{where}: {one}; {two}."]
    if prefer is None:
        said.append("Rely on neither at these amplitudes: use the nonlinear time history of `rocking respond`.")
    elif prefer == 0:
        said.append("Either kappa is adequate at these amplitudes.")
    else:
        said.append(f"Prefer kappa{prefer} at these amplitudes.")
    if prefer is not None and min(errors(asked, kappa).grade for kappa in (1, 2)) is Grade.ESTIMATE:
        said.append("Base decisions on the nonlinear time history of `rocking respond`.")
    return " ".join([*said, *_ranges(curves, order[0])])


def _on(kappa: int, found: Errors) -> str:
    """Describe what the block with a kappa is good for, with its errors."""
    uplift = "kept" if abs(found.uplift) < KEPT else uplift_in_words(found.uplift)
    overturning = f"off by {percent(found.overturning)}" if isfinite(found.overturning) else NEVER
    numbers = (
        f"uplift acceleration {uplift}, free period off by {percent(found.period)}, overturning time {overturning}"
    )
    good = {
        Grade.AGREES: f"kappa{kappa} agrees",
        Grade.ESTIMATE: f"kappa{kappa} is good for a first estimate",
        Grade.DISREGARD: f"disregard kappa{kappa}",
    }[found.grade]
    return f"{good} ({numbers})"


def _ranges(curves: Sequence[Linearisation], kappa: int) -> list[str]:
    """Return sentences on the ranges in which errors are no longer small."""
    said = []
    far = [each.amplitude[np.abs(each.period_ratio - 1) > SMALL] for each in curves]
    wide = [values for values in far if values.size]
    if wide:
        low, high = min(values.min() for values in wide), max(values.max() for values in wide)
        where = (
            "at every amplitude"
            if any(values.size == each.amplitude.size for values, each in zip(far, curves, strict=True))
            else f"for phi/phi_cr from {low:.2g} to {high:.2g}"
        )
        said.append(f"The free period is off by more than {percent(SMALL)} {where}.")
    slow = [each.acceleration[np.abs(getattr(each, f"overturning_ratio{kappa}") - 1) > SMALL] for each in curves]
    late = [values.max() for values in slow if values.size]
    if late:
        everywhere = any(values.size == each.acceleration.size for values, each in zip(slow, curves, strict=True))
        where = "at every acceleration" if everywhere else f"for accelerations below {max(late):.3g} times uplift"
        said.append(f"The overturning time with kappa{kappa} is off by more than {percent(SMALL)} {where}.")
    return said
