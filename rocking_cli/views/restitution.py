"""Which restitution a history used, as people and programs read it."""

from __future__ import annotations

from typing import Any

from rocking_cli.core import Mechanism
from rocking_cli.core.restitution import restitution_in_words
from rocking_cli.dynamics.prepared import Prepared


def restitution_source(mechanism: Mechanism) -> str:
    """Where the restitution of a structure comes from: given, of the kinematics, or of impacts in sequence."""
    given = mechanism.restitution if mechanism.rocks_both_ways else mechanism.rebound
    return "given" if given is not None else "kinematics" if mechanism.rocks_both_ways else "impacts"


def restitution_data(structure: Prepared) -> dict[str, Any]:
    """The restitution that the histories used, and where it comes from."""
    source = restitution_source(structure.mechanism)
    if not structure.mechanism.rocks_both_ways:
        return {"rebound": structure.etas[0], "direction": structure.mechanism.one_sided, "source": source}
    positive, negative = structure.etas
    return {"positive_to_negative": positive, "negative_to_positive": negative, "source": source}


def restitution_used(structure: Prepared) -> str:
    """A sentence on that."""
    source = restitution_source(structure.mechanism)
    if not structure.mechanism.rocks_both_ways:
        how = "as given" if source == "given" else "by Housner's impacts in sequence, not measured"
        return (
            f"It rocks in the {structure.mechanism.one_sided} direction only: an impact throws it back with "
            f"{structure.etas[0]:.4g} of its rate, {how}."
        )
    return restitution_in_words(structure.etas, given=source == "given")
