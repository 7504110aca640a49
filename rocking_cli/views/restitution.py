"""The restitution that histories used, in words and as data."""

from __future__ import annotations

from math import isclose
from typing import Any

from rocking_cli.core import Mechanism
from rocking_cli.structure import Structure
from rocking_cli.views.verdict import SENSE

ETA_TOLERANCE = 1e-9
MIN_DOUBTFUL_ETA = 0.97  # restitution from kinematics above which tests of slender bodies measured less


def restitution_source(mechanism: Mechanism) -> str:
    """Return the source of a structure's restitution: given, kinematics, impacts in sequence, or missing."""
    fields = mechanism.restitution if mechanism.rocks_both_ways else mechanism.rebound
    if fields is not None:
        return "given"
    if mechanism.rocks_both_ways:
        return "kinematics"
    return "missing" if mechanism.rebound_from_impacts() is None else "impacts"


def restitution_data(structure: Structure) -> dict[str, Any]:
    """Return the restitution that the histories used, and its source, as plain data."""
    source = restitution_source(structure.mechanism)
    if not structure.mechanism.rocks_both_ways:
        return {"rebound": structure.etas[0], "direction": structure.mechanism.one_sided, "source": source}
    positive, negative = structure.etas
    return {"positive_to_negative": positive, "negative_to_positive": negative, "source": source}


def restitution_used(structure: Structure) -> str:
    """Return a sentence on the restitution that the histories used."""
    source = restitution_source(structure.mechanism)
    if not structure.mechanism.rocks_both_ways:
        only = f"{SENSE[structure.mechanism.directions[0]]} only, away from the supports that it leans on"
        if source == "missing":
            return (
                f"The structure rocks {only}. Its rebound is not given: static results do not depend on it, time "
                "histories require it."
            )
        how = "as given" if source == "given" else "computed from a sequence of impacts after Housner, not measured"
        return (
            f"The structure rocks {only}. After an impact on them, its angular velocity is "
            f"{structure.etas[0]:.4g} of that before (the rebound, {how})."
        )
    positive, negative = structure.etas
    values, how = f"{positive:.4g}", "as given" if source == "given" else "from rigid-body kinematics, not measured"
    if not isclose(positive, negative, rel_tol=ETA_TOLERANCE):
        values += f" at impacts that end clockwise rotation and {negative:.4g} at the others"
    sentence = f"Coefficient of restitution eta = {values}, {how}."
    if source != "kinematics" or not 0 < min(structure.etas) <= max(structure.etas) < 1 + ETA_TOLERANCE:
        return sentence
    slender = " and for bodies as slender as this, about 0.95" if max(structure.etas) > MIN_DOUBTFUL_ETA else ""
    return (
        f"{sentence} Tests found higher values for concrete and stone (Kalliontzis et al. 2016; Ther and Kollar "
        f"2017), and lower ones for soft or worn feet (ElGawady et al. 2011){slender}."
    )
