"""View of the errors of the equivalent block of a structure, as text and as data."""

from __future__ import annotations

from collections.abc import Sequence
from math import isnan
from typing import Any

from rocking_cli.core import Equivalence, Mechanism
from rocking_cli.studies.linearisation import Linearisation, velocity_ratios
from rocking_cli.studies.trust import errors, preferred, trust
from rocking_cli.views.view import ABSENT, Table, View, heading

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
