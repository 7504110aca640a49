"""Fragility curves as a table of pelicun's damage models: a row is a component, one structure over one measure.

pelicun takes the highest limit state of a row whose capacity the demand exceeds. The capacities of a row are perfectly
correlated, so the share in a damage state is the difference of two curves; where curves cross, the more severe one is
used.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from rocking_cli.errors import InputError
from rocking_cli.questions.fragility import nrml as openquake
from rocking_cli.questions.fragility.assess import Fragility
from rocking_cli.questions.fragility.definition import Limit
from rocking_cli.questions.fragility.hazard_curve import SPECTRAL_MEASURE, intensity_type

if TYPE_CHECKING:
    from rocking_cli.io.tables import Columns

DEMANDS = {"PGA": ("Peak Ground Acceleration", "g"), "PGV": ("Peak Ground Velocity", "mps")}
MAX_LIMITS = 9  # pelicun sorts limit states as text, LS10 before LS2
DIRECTIONAL = 1  # a demand that is not directional is multiplied, by 1.2 unless told otherwise


def demand(measure: str) -> tuple[str, str] | None:
    """Return the demand type and the unit of a measure in pelicun; None if it cannot be written.

    The PGD of pelicun is a permanent deformation of the ground, and its spectral displacement has no damping.
    """
    spectral = SPECTRAL_MEASURE.fullmatch(measure)
    return (f"Spectral Acceleration|{float(spectral[1])}", "g") if spectral else DEMANDS.get(measure)


def components(curves: Sequence[Fragility]) -> tuple[list[openquake.Function], list[str]]:
    """Return the components of a study with their curves in order of severity, and why other curves are left out.

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
    several = len({measure for _, measure in held}) > 1
    rows: list[openquake.Function] = []
    for (structure, measure), by_limit in held.items():
        kind, factor = intensity_type(measure) or (measure, 1.0)
        taken = [row.name.replace(".", "-") for row in rows]  # pelicun splits names at -
        name = f"{structure}_{kind}" if several else structure
        name = openquake.identifier(name.replace("-", "_"), taken).replace("-", ".")
        if len(by_limit) > MAX_LIMITS:
            left_out[f"{structure} over {measure}: pelicun sorts at most {MAX_LIMITS} limit states correctly"] = None
        else:
            ordered = [by_limit[limit] for limit in openquake.by_severity(by_limit, by_limit)]
            rows.append(openquake.Function(name, ordered, kind, factor))
    if not rows:
        raise InputError("pelicun accepts none of the curves: " + "; ".join(left_out or ["the study has no curves"]))
    return rows, list(left_out)


def _why_not(curve: Fragility) -> str:
    """Return the reason why pelicun cannot hold a curve; empty if it can."""
    if demand(curve.measure) is None:
        return f"all curves over {curve.measure}: curves for pelicun are over PGA, PGV or Sa of 5 % damping"
    return openquake.why_not(curve, "the table for pelicun")


def table(rows: Sequence[openquake.Function]) -> Columns:
    """Return the table of components by its headings."""
    most = max(len(row.curves) for row in rows)
    heads = ["ID", "Incomplete", "Demand-Type", "Demand-Unit", "Demand-Offset", "Demand-Directional"]
    of_state = "Family", "Theta_0", "Theta_1", "DamageStateWeights"
    heads += [f"LS{k}-{head}" for k in range(1, most + 1) for head in of_state]
    cells = []
    for row in rows:
        line = [row.name, 0, *(demand(row.curves[0].measure) or ()), 0, DIRECTIONAL]
        for curve in row.curves:
            line += ["lognormal", *openquake.median_and_spread(curve), ""]
        cells.append(line + [""] * (len(heads) - len(line)))
    return dict(zip(heads, zip(*cells, strict=True), strict=True))
