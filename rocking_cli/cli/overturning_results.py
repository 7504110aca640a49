"""Maps and curves of overturning as people and programs read them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from rocking_cli import names
from rocking_cli.cli import terminal
from rocking_cli.cli.pictures import write_picture
from rocking_cli.core import Mechanism
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.io.tables import write_table
from rocking_cli.studies.overturning import Comparison, OverturningMap, Region
from rocking_cli.studies.shaken import Reals, Shaken
from rocking_cli.views.view import ABSENT

ROWS = 9  # of a table: the curves themselves are in --out and --json
FROM_KINEMATICS = " (from kinematics, not measured)"
FALLS = Region.AFTER_IMPACT, Region.WITHOUT_IMPACT


def give_map(
    found: OverturningMap,
    mechanism: Mechanism | None,
    out: Path | None,
    plot: Path | None,
    *,
    dimensionless: bool,
    as_json: bool,
) -> None:
    """Write a map to the files asked for, and print it."""
    if out is not None:
        write_table(out, [_map_columns(found, mechanism)])
        terminal.note(f"wrote {out}")
    if plot is not None:
        from rocking_cli.plotting.overturning import draw_map

        write_picture(plot, draw_map(found, _heading(found), dimensionless=dimensionless))
    if as_json:
        terminal.print_json(_map_json(found, mechanism, dimensionless=dimensionless))
    else:
        _print_map(found, dimensionless=dimensionless)


def _heading(found: OverturningMap) -> str:
    shaken = found.structure
    return f"{shaken.name}, {_pulse(found)}, {shaken.model.name}, eta = {shaken.eta:.4g}"


def _pulse(found: OverturningMap | Comparison) -> str:
    """Shape and polarity of the pulses, as a heading has them."""
    turned = {(1,): "", (-1,): " reversed", (1, -1): " of either polarity"}[found.polarities]
    return f"{found.shape.title}{turned}"


def _polarity(found: OverturningMap | Comparison) -> int | str:
    return found.polarities[0] if len(found.polarities) == 1 else "both"


def _map_columns(found: OverturningMap, mechanism: Mechanism | None) -> dict[str, Sequence[object]]:
    rows, columns = np.indices(found.regions.shape)
    row, column = rows.ravel(), columns.ravel()
    result: dict[str, Sequence[object]] = {"omega": found.omega[column].tolist(), "a": found.a[row].tolist()}
    if mechanism is not None:
        result |= {
            "period [s]": found.periods[column].tolist(),
            "acceleration [g]": found.accelerations[row].tolist(),
        }
    impacts = found.impacts.ravel().tolist()
    return result | {
        "outcome": [Region(region).label for region in found.regions.ravel().tolist()],
        "peak phi/phi_cr": found.peak_ratio.ravel().tolist(),
        "impacts before overturning": [count if count >= 0 else "" for count in impacts],
    }


def _map_json(found: OverturningMap, mechanism: Mechanism | None, *, dimensionless: bool) -> dict[str, Any]:
    shaken = found.structure
    here = mechanism is not None
    return {
        "structure": structure_json(shaken, mechanism) if mechanism is not None else None,
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


def structure_json(shaken: Shaken, mechanism: Mechanism) -> dict[str, Any]:
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


def _print_map(found: OverturningMap, *, dimensionless: bool) -> None:
    unit = 1.0 if dimensionless else found.accelerations[0] / found.a[0]
    across = found.omega if dimensionless else found.periods
    least, direct, safe = (
        unit * curve for curve in (found.least(*FALLS), found.least(Region.WITHOUT_IMPACT), found.safe_again)
    )
    what, amplitude = ("omega", "a") if dimensionless else ("T [s]", "a_g [g]")
    shown = _some(across.size)
    rows = [[f"{across[k]:.3g}", *(_cell(curve[k]) for curve in (least, direct, safe))] for k in shown]
    heads = [what, "overturns\nfrom", "without\nimpact from", "yet not\nat"]
    source = "" if found.structure.eta_given else FROM_KINEMATICS
    terminal.result(f"{_heading(found)}{source}: {amplitude}")
    terminal.table("", heads, rows, numbers=range(1, 4))
    shares = ", ".join(f"{region.label} {100 * share:.1f} %" for region, share in found.shares.items() if share)
    terminal.result(f"Of the map: {shares}.")
    if not (found.peak_ratio != 0).any():
        terminal.result(f"No pulse of the map lifts it: the largest has a = {found.a.max():.4g}, uplift needs a > 1.")
    step = unit * (found.a[1] - found.a[0])
    terminal.result(f"Amplitudes to a step of the map, {step:.2g}{'' if dimensionless else ' g'}.")
    if not np.isnan(safe).all():
        terminal.result("'yet not at': the largest amplitude above the first that overturns which does not.")


def _some(count: int) -> list[int]:
    """Places of a few columns, the first and the last among them."""
    return sorted({round(place) for place in np.linspace(0, count - 1, min(ROWS, count)).tolist()})


def _cell(value: float) -> str:
    return ABSENT if value != value else f"{value:.3g}"


def give_comparison(
    found: Comparison, mechanisms: Sequence[Mechanism], out: Path | None, plot: Path | None, *, as_json: bool
) -> None:
    """Write curves to the files asked for, and print them."""
    if out is not None:
        write_table(out, [_comparison_columns(found)])
        terminal.note(f"wrote {out}")
    title = f"{_pulse(found)}, {found.structures[0].model.name}"
    if plot is not None:
        from rocking_cli.plotting.overturning import draw_comparison

        write_picture(plot, draw_comparison(found, title))
    if as_json:
        terminal.print_json(_comparison_json(found, mechanisms))
    else:
        _print_comparison(found, title)


def _firsts(found: Comparison) -> list[list[str]]:
    """The names of those that go first at each period: none, one, or several that are tied."""
    return [
        [each.name for each, goes in zip(found.structures, column, strict=True) if goes]
        for column in found.firsts.T.tolist()
    ]


def _comparison_columns(found: Comparison) -> dict[str, Sequence[object]]:
    curves = {f"{each.name} [g]": least.tolist() for each, least in zip(found.structures, found.least, strict=True)}
    firsts = [f"tie: {', '.join(names)}" if len(names) > 1 else "".join(names) for names in _firsts(found)]
    return {"period [s]": found.periods.tolist(), **curves, "first": firsts}


def _comparison_json(found: Comparison, mechanisms: Sequence[Mechanism]) -> dict[str, Any]:
    each = zip(found.structures, mechanisms, found.least, strict=True)
    return {
        "pulse": found.shape.name,
        "model": found.structures[0].model.name,
        "polarity": _polarity(found),
        "largest_tried": found.top,
        "period": found.periods.tolist(),
        "structures": [
            {**structure_json(shaken, mechanism), "eta": shaken.eta, "least": numbers(least)}
            for shaken, mechanism, least in each
        ],
        "first": [names[0] if len(names) == 1 else None for names in _firsts(found)],
        "tied": [names if len(names) > 1 else None for names in _firsts(found)],
    }


def _together(names: Sequence[str]) -> str:
    return names[0] if len(names) == 1 else f"{' and '.join(names)} together"


def _goes_first(names: Sequence[str]) -> str:
    return (names[0] if len(names) == 1 else "a tie") if names else ABSENT


def _print_comparison(found: Comparison, title: str) -> None:
    firsts = _firsts(found)
    rows = [
        [f"{found.periods[k]:.3g}", *(_cell(least[k]) for least in found.least), _goes_first(firsts[k])]
        for k in _some(found.periods.size)
    ]
    heads = [each.name.replace(" ", "\n") for each in found.structures]
    terminal.result(f"Least a_g [g] that overturns: {title}")
    terminal.table("", ["T [s]", *heads, "goes first"], rows, numbers=range(1, len(heads) + 1))
    counts = Counter(tuple(together) for together in firsts if together)
    if counts:
        said = ", ".join(
            f"{_together(tied)} at {100 * counts[tied] / len(firsts):.0f} %"
            for tied in sorted(counts, key=lambda tied: len(tied) > 1)
        )
        terminal.result(f"Goes first, of the periods: {said}.")
    if np.isnan(found.least).any():
        terminal.result(f"{ABSENT}: none up to {found.top:.4g} g {names.OVERTURNS} it.")
    low = [each.name for each in found.structures if found.top * STANDARD_GRAVITY <= each.unit]
    if low:
        terminal.result(f"Not even {found.top:.4g} g lifts {', '.join(low)}.")
