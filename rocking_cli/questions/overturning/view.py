"""Views of overturning maps, and of the least pulses that overturn, as text and as data."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np

from rocking_cli.arrays import Reals
from rocking_cli.core import Mechanism
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.io.tables import Columns, stacked
from rocking_cli.names import OVERTURNS, UNKNOWN, percent
from rocking_cli.questions.overturning.study import FALLS, Comparison, OverturningMap, Region
from rocking_cli.studies.under_pulses import PulsedModel
from rocking_cli.views.column import only_shown, rounded, table_of
from rocking_cli.views.engines import BLOCKS_FAILED, engines_in_words
from rocking_cli.views.verdict import INVALID_REASON, unchecked
from rocking_cli.views.view import ABSENT, Aside, Table, View, number

MAX_TABLE_ROWS = 9  # rows of a table; --out and --json have the whole curves
SOURCES = {"run": " (given for this run)", "given": ""}
FROM_KINEMATICS = " (from kinematics, not measured)"
NO_JOINTS = (
    "The equivalent block has no joints, so whether those of the structure stay closed is not checked here: the real "
    "outcome may differ. Next: choose the nonlinear model, which checks them."
)


def map_view(found: OverturningMap, mechanism: Mechanism | None, *, dimensionless: bool) -> View:
    """Show an overturning map of a structure, or of the linear block if there is none.

    Parameters
    ----------
    found : OverturningMap
        The map.
    mechanism : Mechanism, optional
        The structure.
    dimensionless : bool
        Whether to show the map against omega and a; otherwise against the period in s and the amplitude in g.
    """
    unit = 1.0 if dimensionless else found.ag[0] / found.a[0]
    what, amplitude = ("omega", "a") if dimensionless else ("T [s]", "a_g [g]")
    curves = {
        "overturns\nfrom": found.least(*FALLS),
        "without\nimpact from": found.least(Region.WITHOUT_IMPACT),
        "survives\nagain at": found.safe_again,
    }
    doubtful = found.least(Region.UNKNOWN)
    if some_unknown := not np.isnan(doubtful).all():
        curves["unknown\nfrom"] = doubtful
    across = (found.omega if dimensionless else found.periods).tolist()
    columns = [
        only_shown(what, across.__getitem__, rounded(3), text=True),
        *(only_shown(head, (unit * curve).item, rounded(3)) for head, curve in curves.items()),
    ]
    shares = ", ".join(f"{region.label} {100 * share:.1f} %" for region, share in found.shares.items() if share)
    parts: list[Table | str] = [
        _smallest(found, unit, dimensionless=dimensionless),
        f"{map_title(found)}{source_of(found.structure)}: amplitudes {amplitude} against {what}",
        table_of("", columns, spaced(len(across))),
        Aside(f"Shares of the points of the map, which depend on the ranges of its axes: {shares}."),
    ]
    if some_unknown:
        why = INVALID_REASON if found.structure.engine.name == "exact" else BLOCKS_FAILED
        parts.append(
            f"The outcome is unknown where {why}; the structure may stand or overturn there. Next: `rocking respond` "
            "with such a pulse says why, and when."
        )
    if not (found.outcome.peak_ratio != 0).any():
        parts.append(
            "No pulse on the map causes uplift: the amplitude of the strongest is "
            f"{found.a.max():.4g} times the uplift acceleration."
        )
    if not np.isnan(found.safe_again).all():
        parts.append(
            "Stronger is not always worse: 'survives again at' is the largest amplitude that does not overturn the "
            "structure although a smaller one does."
        )
    if mechanism is not None:
        by_blocks, off_edge = int(found.outcome.by_blocks.sum()), int(found.outcome.off_edge.sum())
        parts += engines_in_words(found.structure.engine.name, by_blocks, mechanism, off_edge)
        parts += _joints([found.structure], [mechanism])
    return View(_map_data(found, mechanism, dimensionless=dimensionless), parts)


def _smallest(found: OverturningMap, unit: float, *, dimensionless: bool) -> str:
    """Say which amplitude on a map is the smallest that overturns, or may, and if a smaller one may be beyond it."""
    name, sign, end, of, across = found.structure.name, "a_g", " g", "T", found.periods
    if dimensionless:
        name, sign, end, of, across = f"the {name}", "a", "", "omega", found.omega
    least, doubtful = found.least(*FALLS), found.least(Region.UNKNOWN)

    def at(k: int) -> str:
        return f"{of} = {across[k]:.3g}{'' if dimensionless else ' s'}"

    def smallest(curve: Reals) -> str:
        last, places = curve.size - 1, np.flatnonzero(curve == np.nanmin(curve)).tolist()
        k = next((k for k in places if k in (0, last)), places[0])
        edge = k in (0, last) or curve[k] == found.a[0]
        below = found.a[found.a < curve[k]]
        step = f" (next smaller tried: {unit * below[-1]:.3g}{end})" if below.size else ""
        value = f"{unit * curve[k]:.3g}{end}{step}, at {at(k)}"
        return f"{value}, the edge of the map: beyond it, less may do." if edge else f"{value}."

    known, may = (not np.isnan(curve).all() for curve in (least, doubtful))
    sentences = [f"The smallest {sign} on the map that overturns {name} is {smallest(least)}"] if known else [
        f"No pulse on the map {'is known to overturn' if may else 'overturns'} {name}, up to "
        f"{unit * found.a[-1]:.3g}{end}, from {at(0)} to {at(-1)}."
    ]  # fmt: skip
    if may and not (known and np.nanmin(least) <= np.nanmin(doubtful)):
        sentences.append(f"The smallest {sign} whose outcome is unknown is {smallest(doubtful)}")
    return " ".join(sentences)


def map_title(found: OverturningMap) -> str:
    """Return the structure, the pulse and the model of a map, as a heading."""
    shaken = found.structure
    return f"{shaken.name}, {_pulse(found)}, {shaken.model.name}, eta = {shaken.eta:.4g}"


def source_of(shaken: PulsedModel) -> str:
    """Return the source of the restitution, to be added to its value; empty if the file gives it."""
    return SOURCES.get(shaken.restitution_source, FROM_KINEMATICS)


def _pulse(found: OverturningMap | Comparison) -> str:
    """Return shape and polarity of the pulses, for a heading."""
    turned = {(1,): "", (-1,): " reversed", (1, -1): " of either polarity"}[found.polarities]
    return f"{found.shape.title}{turned}"


def _polarity(found: OverturningMap | Comparison) -> int | str:
    return found.polarities[0] if len(found.polarities) == 1 else "both"


def map_table(found: OverturningMap, mechanism: Mechanism | None) -> Columns:
    """Return the columns of a map, with a row for each point; with periods and accelerations for a structure."""
    rows, columns = np.indices(found.regions.shape)
    row, column = rows.ravel(), columns.ravel()
    result: dict[str, Any] = {"omega": found.omega[column].tolist(), "a": found.a[row].tolist()}
    if mechanism is not None:
        result |= {
            "period [s]": found.periods[column].tolist(),
            "ag [g]": found.ag[row].tolist(),
        }
    outcome = found.outcome.by_field(np.ravel)
    return result | {
        "outcome": [Region(region).label for region in found.regions.ravel().tolist()],
        "overturned": outcome.overturned,
        "unknown": outcome.unknown if found.structure.checked else np.full(row.size, np.nan),
        "peak_ratio": np.where(outcome.fell, np.inf, np.where(outcome.unknown, np.nan, outcome.peak_ratio)),
        "impact_count": outcome.impact_count,
        "known_to [s]": outcome.known_to,
        "peak_lower_bound": np.where(outcome.unknown, outcome.lower_bound, np.nan),
    }


def _map_data(found: OverturningMap, mechanism: Mechanism | None, *, dimensionless: bool) -> dict[str, Any]:
    shaken = found.structure
    here = mechanism is not None
    return {
        "structure": _structure(shaken, mechanism) if mechanism is not None else None,
        "pulse": found.shape.name,
        "model": shaken.model.name,
        "engine": shaken.engine.name,
        "by_blocks": int(found.outcome.by_blocks.sum()),
        "off_edge": int(found.outcome.off_edge.sum()),
        "eta": shaken.eta,
        "restitution": shaken.restitution_source,
        "polarity": _polarity(found),
        "dimensionless": dimensionless,
        "shares": {
            region.name.lower(): share if shaken.checked or region is not Region.UNKNOWN else None
            for region, share in found.shares.items()
        },
        "omega": found.omega.tolist(),
        "period": found.periods.tolist() if here else None,
        "a": found.a.tolist(),
        "ag": found.ag.tolist() if here else None,
        "least_a": {
            "overturning": numbers(found.least(*FALLS)),
            "after_impact": numbers(found.least(Region.AFTER_IMPACT)),
            "without_impact": numbers(found.least(Region.WITHOUT_IMPACT)),
            "overturning_or_unknown": numbers(found.least(*FALLS, Region.UNKNOWN)) if shaken.checked else None,
        },
        "largest_safe_a_above": numbers(found.safe_again),
    }


def _structure(shaken: PulsedModel, mechanism: Mechanism) -> dict[str, Any]:
    """Return a structure as plain data, with the quantities that make its pulses dimensionless."""
    return {
        "mechanism": mechanism.mechanism,
        "name": shaken.name,
        "direction": shaken.direction.label,
        "p": shaken.p,
        "lambda": shaken.lambda_,
        "caution": mechanism.own_caution() or None,
    }


def numbers(values: Reals) -> list[float | None]:
    """Return values for JSON, with null for NaN."""
    return [None if value != value else value for value in values.tolist()]


def spaced(count: int, most: int = MAX_TABLE_ROWS) -> list[int]:
    """Return the indices of a few columns, including the first and the last."""
    return sorted({round(place) for place in np.linspace(0, count - 1, min(most, count)).tolist()})


def comparison_view(found: Comparison, mechanisms: Sequence[Mechanism]) -> View:
    """Show the least amplitudes that overturn each of several structures, and which overturns first."""
    firsts, shown = _firsts(found), spaced(found.periods.size)

    def first(k: int) -> str | None:
        if found.undecided[k]:
            return UNKNOWN
        return "several equal" if len(firsts[k]) > 1 else firsts[k][0] if firsts[k] else None

    columns = [
        only_shown("T [s]", found.periods.item, rounded(3), text=True),
        *(
            only_shown(each.name.replace(" ", "\n"), partial(_span, *ends))
            for each, *ends in zip(found.structures, found.possible, found.least, strict=True)
        ),
        only_shown("overturns first", first, text=True),
    ]
    parts: list[Table | str] = [table_of(f"Least a_g [g] that overturns: {comparison_title(found)}", columns, shown)]
    counts = Counter(tuple(together) for together in firsts if together)
    shares = [
        f"{' and '.join(tied)}{' together' * (len(tied) > 1)} at {percent(counts[tied] / len(firsts))}"
        for tied in sorted(counts, key=lambda tied: len(tied) > 1)
    ]
    if found.undecided.any():
        shares.append(f"{UNKNOWN} at {percent(float(found.undecided.mean()))}")
    if shares:
        parts.insert(0, f"Overturned by the smallest amplitude: {', '.join(shares)} of the periods.")
    if found.doubtful.any():
        parts.append(
            "Two numbers: the smallest amplitude whose outcome is unknown, as a joint opens or slides so far that the "
            "model no longer holds, and the smallest that is known to overturn the structure. Overturning starts "
            "between the two; after >=, it starts at no smaller amplitude, if at all."
        )
    if np.isnan(found.possible).any():
        parts.append(f"{ABSENT}: no amplitude up to {found.top:.4g} g {OVERTURNS} the structure.")
    low = [each.name for each in found.structures if found.top * STANDARD_GRAVITY <= each.unit]
    if low:
        parts.append(f"{found.top:.4g} g, the largest amplitude tried, does not uplift {', '.join(low)}.")
    parts += _joints(found.structures, mechanisms)
    return View(_comparison_data(found, mechanisms), parts)


def comparison_title(found: Comparison) -> str:
    """Return the pulses and the model of a comparison, as a heading."""
    first = found.structures[0]
    eta = f", eta = {first.eta:.4g}" if first.restitution_source == "run" else ""
    return f"{_pulse(found)}, {first.model.name}{eta}"


def _firsts(found: Comparison) -> list[list[str]]:
    """Return the names of the structures that overturn first at each period: none, one, or several that are equal."""
    return [
        [each.name for each, goes in zip(found.structures, column, strict=True) if goes]
        for column in found.firsts.T.tolist()
    ]


def comparison_table(found: Comparison) -> Columns:
    """Return the columns of the curves, with a row for each structure and period."""
    return stacked(
        {
            "structure": each.name, "period [s]": found.periods, "least [g]": least, "possible [g]": possible,
            "first": np.where(found.undecided, np.nan, first),
        }
        for each, least, possible, first in zip(
            found.structures, found.least, found.possible, found.firsts, strict=True
        )
    )  # fmt: skip


def _comparison_data(found: Comparison, mechanisms: Sequence[Mechanism]) -> dict[str, Any]:
    each = zip(found.structures, mechanisms, found.least, found.possible, strict=True)
    return {
        "pulse": found.shape.name,
        "model": found.structures[0].model.name,
        "polarity": _polarity(found),
        "largest_tried": found.top,
        "period": found.periods.tolist(),
        "structures": [
            {
                **_structure(shaken, mechanism),
                "eta": shaken.eta,
                "restitution": shaken.restitution_source,
                "least": numbers(least),
                "possible": numbers(possible) if shaken.checked else None,
            }
            for shaken, mechanism, least, possible in each
        ],
        "first": [names[0] if len(names) == 1 else None for names in _firsts(found)],
        "tied": [names if len(names) > 1 else None for names in _firsts(found)],
        "undecided": found.undecided.tolist(),
    }


def _joints(structures: Sequence[PulsedModel], mechanisms: Sequence[Mechanism]) -> list[str]:
    """Return sentences on joints of structures that are not checked; empty if all are."""
    linear, several = structures[0].model.is_linear, len(structures) > 1
    left_out = linear and any(len(each.bodies()) > 1 for each in mechanisms)
    return [
        *([NO_JOINTS] if left_out else []),
        *(
            unchecked(each.name if several else "", mechanism.unchecked)
            for each, mechanism in zip(structures, mechanisms, strict=True)
            if not each.checked
        ),
        *(f"Caution: {each.name}: {text}" for each in mechanisms if (text := each.own_caution())),
    ]


def _span(possible: Reals, least: Reals, k: int) -> str:
    """Format the least amplitude that overturns: a number, the range in which it lies, or a lower bound."""
    low, high = possible[k], least[k]
    if np.isnan(low) or low >= high:
        return number(high, 3)
    return f">= {low:.3g}" if np.isnan(high) else f"{low:.3g} to {high:.3g}"
