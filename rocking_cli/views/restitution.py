"""The restitution that histories used, in words and as data."""

from __future__ import annotations

from collections.abc import Iterator
from math import isclose
from typing import Any

from rocking_cli.structure import Structure
from rocking_cli.views.verdict import SENSE
from rocking_cli.views.view import Aside, heading

ETA_TOLERANCE = 1e-9
MIN_DOUBTFUL_ETA = 0.97  # restitution from kinematics above which tests of slender bodies measured less
SOURCES = {
    "run": "given for this run",
    "given": "as given",
    "kinematics": "from rigid-body kinematics, not measured",
    "impacts": "computed from a sequence of impacts after Housner, not measured",
}


def heading_of_run(structure: Structure) -> str:
    """Return name and type of a structure, and the restitution if it was given for the run, for a heading."""
    name = "eta" if structure.mechanism.rocks_both_ways else "rebound"
    given = "" if structure.restitution is None else f", {name} = {structure.restitution:.4g}"
    return f"{heading(structure.mechanism)}{given}"


def restitution_data(structure: Structure) -> dict[str, Any]:
    """Return the restitution that the histories used, and its source, as plain data."""
    source = structure.restitution_source
    if not structure.mechanism.rocks_both_ways:
        return {"rebound": structure.etas[0], "direction": structure.mechanism.one_sided, "source": source}
    positive, negative = structure.etas
    return {"positive_to_negative": positive, "negative_to_positive": negative, "source": source}


def restitution_used(structure: Structure) -> str:
    """Return the sentences on the restitution that the histories used as one text."""
    return " ".join(restitution_sentences(structure))


def restitution_sentences(structure: Structure) -> Iterator[str]:
    """Yield sentences on the restitution that the histories used, and what tests found."""
    source = structure.restitution_source
    if not structure.mechanism.rocks_both_ways:
        only = f"{SENSE[structure.mechanism.directions[0]]} only, away from the supports that it leans on"
        yield f"The structure rocks {only}. " + (
            "Its rebound is not given: static results do not depend on it, time histories require it."
            if source == "missing"
            else f"After an impact on them, its angular velocity is {structure.etas[0]:.4g} of that before (the "
            f"rebound, {SOURCES[source]})."
        )
        return
    positive, negative = structure.etas
    values = f"{positive:.4g}"
    if not isclose(positive, negative, rel_tol=ETA_TOLERANCE):
        values += f" at impacts that end clockwise rotation and {negative:.4g} at the others"
    yield f"Coefficient of restitution eta = {values}, {SOURCES[source]}."
    if source == "kinematics" and 0 < min(structure.etas) <= max(structure.etas) < 1 + ETA_TOLERANCE:
        slender = max(structure.etas) > MIN_DOUBTFUL_ETA
        yield (str if slender else Aside)(
            "Tests found higher values for concrete and stone (Kalliontzis et al. 2016; Ther and Kollar 2017), and "
            "lower ones for soft or worn feet (ElGawady et al. 2011)"
            f"{' and for bodies as slender as this, about 0.95' if slender else ''}."
        )
