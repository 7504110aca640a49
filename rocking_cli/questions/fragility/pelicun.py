"""Fragility curves as a table of pelicun's damage models: a row is a component, one structure over one measure.

pelicun takes the highest limit state of a row whose capacity the demand exceeds. The capacities of a row are perfectly
correlated, so the share in a damage state is the difference of two curves; where curves cross, the more severe one is
used.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from rocking_cli.errors import InputError
from rocking_cli.questions.fragility.assess import Fragility
from rocking_cli.questions.fragility.definition import Limit
from rocking_cli.questions.fragility.nrml import (
    SPECTRAL_MEASURE,
    Function,
    by_severity,
    doubts,
    identifier,
    intensity_type,
    median_and_spread,
    why_not,
)

DEMANDS = {"PGA": ("Peak Ground Acceleration", "g"), "PGV": ("Peak Ground Velocity", "mps")}
MAX_LIMITS = 9  # pelicun sorts limit states as text, LS10 before LS2


class Components(NamedTuple):
    """The table for pelicun.

    Parameters
    ----------
    columns : mapping of str to sequence
        The columns by heading.
    states : sequence of str
        A sentence for each row on what its limit states are.
    left_out : sequence of str
        A sentence on each curve that is not written, with the reason.
    doubts : sequence of str
        Warnings about the curves that are written.
    """

    columns: Mapping[str, Sequence[object]]
    states: Sequence[str]
    left_out: Sequence[str]
    doubts: Sequence[str]


def demand(measure: str) -> tuple[str, str] | None:
    """Return the demand type and the unit of a measure in pelicun; None if it cannot be written.

    The PGD of pelicun is a permanent deformation of the ground, and its spectral displacement has no damping.
    """
    if spectral := SPECTRAL_MEASURE.fullmatch(measure):
        return f"Spectral Acceleration|{float(spectral[1])}", "g"
    return DEMANDS.get(measure)


def components(curves: Sequence[Fragility]) -> Components:
    """Make the table of the curves that pelicun can hold.

    Parameters
    ----------
    curves : sequence of Fragility
        All curves of a study.

    Raises
    ------
    InputError
        If no curve can be written; the message has the reasons.
    """
    held: dict[tuple[str, str], dict[Limit, Fragility]] = {}
    left_out: dict[str, None] = {}  # in order, each once
    for each in curves:
        if reason := _why_not(each):
            left_out[reason] = None
        else:
            held.setdefault((each.structure, each.measure), {})[each.limit] = each
    for structure, measure in [key for key, by_limit in held.items() if len(by_limit) > MAX_LIMITS]:
        left_out[f"{structure} over {measure}: pelicun sorts at most {MAX_LIMITS} limit states correctly"] = None
        del held[structure, measure]
    if not held:
        raise InputError("pelicun accepts none of the curves: " + "; ".join(left_out or ["the study has no curves"]))
    rows = _rows(held)
    demands = [demand(each.curves[0].measure) or ("", "") for each in rows]
    columns: dict[str, Sequence[object]] = {
        "ID": [each.name for each in rows],
        "Incomplete": [0] * len(rows),
        "Demand-Type": [kind for kind, _ in demands],
        "Demand-Unit": [unit for _, unit in demands],
        "Demand-Offset": [0] * len(rows),
        # pelicun multiplies a demand that is not directional, by 1.2 unless told otherwise.
        "Demand-Directional": [1] * len(rows),
    }
    for k in range(max(len(each.curves) for each in rows)):
        state = [each.curves[k] if k < len(each.curves) else None for each in rows]
        numbers = [median_and_spread(each) if each else ("", "") for each in state]
        columns[f"LS{k + 1}-Family"] = ["lognormal" if each else "" for each in state]
        columns[f"LS{k + 1}-Theta_0"] = [median for median, _ in numbers]
        columns[f"LS{k + 1}-Theta_1"] = [dispersion for _, dispersion in numbers]
        columns[f"LS{k + 1}-DamageStateWeights"] = [""] * len(rows)
    crossing = "a share below zero", "and pelicun uses the graver"
    return Components(
        columns,
        [f"{each.name}: {', '.join(f'LS{k} {one.limit}' for k, one in enumerate(each.curves, 1))}" for each in rows],
        list(left_out),
        [each.replace(*crossing) for each in doubts(rows)],
    )


def _why_not(found: Fragility) -> str:
    """Return the reason why pelicun cannot hold a curve; empty if it can."""
    if demand(found.measure) is None:
        return f"all curves over {found.measure}: curves for pelicun are over PGA, PGV or Sa of 5 % damping"
    reason = why_not(found).replace("OpenQuake accepts only", "the table for pelicun has only")
    return reason.replace("OpenQuake", "pelicun")


def _rows(held: Mapping[tuple[str, str], Mapping[Limit, Fragility]]) -> list[Function]:
    """Return the curves of each component in order of severity, with a unique name without the sign - ."""
    several = len({measure for _, measure in held}) > 1
    rows: list[Function] = []
    for (structure, measure), by_limit in held.items():
        there = intensity_type(measure)
        assert there is not None
        name = f"{structure}_{there[0]}" if several else structure
        taken = [each.name.replace(".", "-") for each in rows]
        name = identifier(name.replace("-", "_"), taken).replace("-", ".")
        rows.append(Function(name, [by_limit[limit] for limit in by_severity(by_limit, by_limit)], *there))
    return rows
