"""Maps and curves of overturning, as people and programs read them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import Any

import numpy as np

from rocking_cli.core import Mechanism
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.names import OVERTURNS
from rocking_cli.studies.overturning import Comparison, OverturningMap, Region
from rocking_cli.studies.under_pulses import PulsedModel, Reals
from rocking_cli.views.view import ABSENT, Table, View

ROWS = 9  # of a table: the curves themselves are in --out and --json
FROM_KINEMATICS = " (from kinematics, not measured)"
FALLS = Region.AFTER_IMPACT, Region.WITHOUT_IMPACT


def map_view(found: OverturningMap, mechanism: Mechanism | None, *, dimensionless: bool) -> View:
    """A map of a structure, or of the linear block if there is none.

    Parameters
    ----------
    found : OverturningMap
        The map.
    mechanism : Mechanism, optional
        The structure.
    dimensionless : bool
        Whether people read it over omega and a; else over the period in s and the amplitude in g.
    """
    unit = 1.0 if dimensionless else found.accelerations[0] / found.a[0]
    across = found.omega if dimensionless else found.periods
    curves = [unit * curve for curve in (found.least(*FALLS), found.least(Region.WITHOUT_IMPACT), found.safe_again)]
    what, amplitude = ("omega", "a") if dimensionless else ("T [s]", "a_g [g]")
    rows = [[f"{across[k]:.3g}", *(_cell(curve[k]) for curve in curves)] for k in _some(across.size)]
    heads = [what, "overturns\nfrom", "without\nimpact from", "survives\nagain at"]
    source = "" if found.structure.eta_given else FROM_KINEMATICS
    shares = ", ".join(f"{region.label} {100 * share:.1f} %" for region, share in found.shares.items() if share)
    parts: list[Table | str] = [
        f"{map_title(found)}{source}: amplitudes {amplitude} against {what}",
        Table("", heads, rows, numbers=range(1, 4)),
        f"Shares of the pulses on the map: {shares}.",
    ]
    if not (found.outcome.peak_ratio != 0).any():
        parts.append(
            f"No pulse on the map causes uplift: the largest has a = {found.a.max():.4g}, and uplift requires a > 1."
        )
    step = unit * (found.a[1] - found.a[0])
    parts.append(f"Amplitudes are read from the map, whose step is {step:.2g}{'' if dimensionless else ' g'}.")
    if not np.isnan(found.safe_again).all():
        parts.append(
            "Stronger is not always worse: 'survives again at' is the largest amplitude that does not overturn the "
            "structure although a smaller one does."
        )
    return View(_map_data(found, mechanism, dimensionless=dimensionless), parts)


def map_title(found: OverturningMap) -> str:
    """What a map is of."""
    shaken = found.structure
    return f"{shaken.name}, {_pulse(found)}, {shaken.model.name}, eta = {shaken.eta:.4g}"


def _pulse(found: OverturningMap | Comparison) -> str:
    """Shape and polarity of the pulses, as a heading has them."""
    turned = {(1,): "", (-1,): " reversed", (1, -1): " of either polarity"}[found.polarities]
    return f"{found.shape.title}{turned}"


def _polarity(found: OverturningMap | Comparison) -> int | str:
    return found.polarities[0] if len(found.polarities) == 1 else "both"


def map_table(found: OverturningMap, mechanism: Mechanism | None) -> dict[str, Sequence[object]]:
    """The columns of a map, a row for each point; periods and accelerations are those of a structure."""
    rows, columns = np.indices(found.regions.shape)
    row, column = rows.ravel(), columns.ravel()
    result: dict[str, Sequence[object]] = {"omega": found.omega[column].tolist(), "a": found.a[row].tolist()}
    if mechanism is not None:
        result |= {
            "period [s]": found.periods[column].tolist(),
            "acceleration [g]": found.accelerations[row].tolist(),
        }
    outcome = found.outcome
    before = zip(outcome.overturned.ravel().tolist(), outcome.impact_count.ravel().tolist(), strict=True)
    return result | {
        "outcome": [Region(region).label for region in found.regions.ravel().tolist()],
        "peak phi/phi_cr": outcome.peak_ratio.ravel().tolist(),
        "impacts before overturning": [count if falls else "" for falls, count in before],
    }


def _map_data(found: OverturningMap, mechanism: Mechanism | None, *, dimensionless: bool) -> dict[str, Any]:
    shaken = found.structure
    here = mechanism is not None
    return {
        "structure": _structure(shaken, mechanism) if mechanism is not None else None,
        "pulse": found.shape.name,
        "model": shaken.model.name,
        "eta": shaken.eta,
        "polarity": _polarity(found),
        "dimensionless": dimensionless,
        "shares": {region.name.lower(): share for region, share in found.shares.items()},
        "omega": found.omega.tolist(),
        "period": found.periods.tolist() if here else None,
        "a": found.a.tolist(),
        "acceleration": found.accelerations.tolist() if here else None,
        "least_a": {
            "overturning": numbers(found.least(*FALLS)),
            "after_impact": numbers(found.least(Region.AFTER_IMPACT)),
            "without_impact": numbers(found.least(Region.WITHOUT_IMPACT)),
        },
        "largest_safe_a_above": numbers(found.safe_again),
    }


def _structure(shaken: PulsedModel, mechanism: Mechanism) -> dict[str, Any]:
    """A structure, and what its pulses are measured by."""
    return {
        "mechanism": mechanism.mechanism,
        "name": shaken.name,
        "direction": shaken.direction.label,
        "p": shaken.p,
        "lambda": shaken.lambda_,
    }


def numbers(values: Reals) -> list[float | None]:
    """Numbers for JSON: null for NaN."""
    return [None if value != value else value for value in values.tolist()]


def _some(count: int) -> list[int]:
    """Places of a few columns, the first and the last among them."""
    return sorted({round(place) for place in np.linspace(0, count - 1, min(ROWS, count)).tolist()})


def _cell(value: float) -> str:
    return ABSENT if value != value else f"{value:.3g}"


def comparison_view(found: Comparison, mechanisms: Sequence[Mechanism]) -> View:
    """The least amplitudes that overturn each of several structures, and which of them overturns first."""
    firsts = _firsts(found)
    rows = [
        [f"{found.periods[k]:.3g}", *(_cell(least[k]) for least in found.least), _goes_first(firsts[k])]
        for k in _some(found.periods.size)
    ]
    heads = [each.name.replace(" ", "\n") for each in found.structures]
    parts: list[Table | str] = [
        f"Least a_g [g] that overturns: {comparison_title(found)}",
        Table("", ["T [s]", *heads, "overturns first"], rows, numbers=range(1, len(heads) + 1)),
    ]
    counts = Counter(tuple(together) for together in firsts if together)
    if counts:
        said = ", ".join(
            f"{_together(tied)} at {100 * counts[tied] / len(firsts):.0f} %"
            for tied in sorted(counts, key=lambda tied: len(tied) > 1)
        )
        parts.append(f"Overturned by the smallest amplitude: {said} of the periods.")
    if np.isnan(found.least).any():
        parts.append(f"{ABSENT}: no amplitude up to {found.top:.4g} g {OVERTURNS} the structure.")
    low = [each.name for each in found.structures if found.top * STANDARD_GRAVITY <= each.unit]
    if low:
        parts.append(f"{found.top:.4g} g, the largest amplitude tried, does not uplift {', '.join(low)}.")
    return View(_comparison_data(found, mechanisms), parts)


def comparison_title(found: Comparison) -> str:
    """Return the pulses and the model of a comparison, as a heading."""
    return f"{_pulse(found)}, {found.structures[0].model.name}"


def _firsts(found: Comparison) -> list[list[str]]:
    """Return the names of the structures that overturn first at each period: none, one, or several that are equal."""
    return [
        [each.name for each, goes in zip(found.structures, column, strict=True) if goes]
        for column in found.firsts.T.tolist()
    ]


def comparison_table(found: Comparison) -> dict[str, Sequence[object]]:
    """The columns of the curves, a row for each period."""
    curves = {f"{each.name} [g]": least.tolist() for each, least in zip(found.structures, found.least, strict=True)}
    firsts = [f"tie: {', '.join(names)}" if len(names) > 1 else "".join(names) for names in _firsts(found)]
    return {"period [s]": found.periods.tolist(), **curves, "first": firsts}


def _comparison_data(found: Comparison, mechanisms: Sequence[Mechanism]) -> dict[str, Any]:
    each = zip(found.structures, mechanisms, found.least, strict=True)
    return {
        "pulse": found.shape.name,
        "model": found.structures[0].model.name,
        "polarity": _polarity(found),
        "largest_tried": found.top,
        "period": found.periods.tolist(),
        "structures": [
            {**_structure(shaken, mechanism), "eta": shaken.eta, "least": numbers(least)}
            for shaken, mechanism, least in each
        ],
        "first": [names[0] if len(names) == 1 else None for names in _firsts(found)],
        "tied": [names if len(names) > 1 else None for names in _firsts(found)],
    }


def _together(names: Sequence[str]) -> str:
    return names[0] if len(names) == 1 else f"{' and '.join(names)} together"


def _goes_first(names: Sequence[str]) -> str:
    return (names[0] if len(names) == 1 else "several equal") if names else ABSENT
