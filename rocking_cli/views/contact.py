"""Contact demands of a time history, as sentences and as data."""

from __future__ import annotations

from dataclasses import asdict
from math import isnan
from typing import Any

from rocking_cli.core import Mechanism
from rocking_cli.core.contacts import MASONRY_FRICTION
from rocking_cli.studies.contact import NEAR_PEAK, ContactDemand, SupportDemand
from rocking_cli.views.column import Column, data_of, of, rounded
from rocking_cli.views.view import ABSENT, force_unit, number

NOT_VALID_BEYOND = ": the result is not valid beyond that time"


SUPPORTS: tuple[Column[SupportDemand], ...] = (
    Column("support", of("support")),
    Column("way", lambda each: [each.way.real, each.way.imag]),
    Column("most", of("most")),
    Column("least", of("least")),
)


def contact_data(found: ContactDemand, mechanism: Mechanism) -> dict[str, Any]:
    """Return the demands as plain data; missing values are null."""
    return {
        **data_of(contact_columns(mechanism), found),
        **({} if found.opens is None else {"opens": found.opens, "opens_joint": found.opens_joint or None}),
        "sums": _sums(found, mechanism),
        "per_unit_mass": not mechanism.has_mass,
    }


def contact_columns(mechanism: Mechanism) -> list[Column[ContactDemand]]:
    """Return the columns of the demands on a structure; forces are per unit mass if it has no masses."""
    per, unit = force_unit(mechanism)

    def force(value: float) -> str:
        return ABSENT if isnan(value) else f"{number(value / per, 4)} {unit}"

    return [
        Column("friction_needed", of("friction_needed"), head="friction required", form=rounded(3)),
        Column("joint", lambda found: found.joint or None, head="at joint", text=True),
        Column("time", of("time"), head="at [s]", form=rounded(3)),
        Column("duration", of("duration"), head="for [s]", form=rounded(3)),
        Column("impact_friction", of("impact_friction"), head="at impacts", form=rounded(3)),
        Column("base_shear", of("base_shear"), head="base shear, without impacts", form=force),
        Column("least_normal", of("least_normal"), head="least normal force", form=force, text=True),
        Column("lost", of("lost"), head="contact lost", form=_lost, text=True),
        Column("lost_joint", lambda found: found.lost_joint or None),
        Column("friction", of("friction")),
        Column("slides", of("slides")),
        Column("slides_joint", lambda found: found.slides_joint or None),
        Column("strength", lambda found: None if found.crushing is None else asdict(found.crushing)),
        Column("supports", lambda found: [data_of(SUPPORTS, each) for each in found.supports]),
    ]


def _lost(time: float) -> str:
    return "never" if isnan(time) else f"at {number(time, 4)} s"


def contact_words(found: ContactDemand, mechanism: Mechanism) -> str:
    """Return the demands as sentences; empty for a structure that does not rock.

    If the joints are checked, the outcome states whether a joint opens or slides so far that the result ends.
    """
    if isnan(found.friction_needed):
        return ""
    beyond = "" if found.followed else NOT_VALID_BEYOND
    sentences = [_friction(found, beyond)]
    if found.impact_friction > max(found.friction_needed, found.friction or 0.0):
        sentences.append(
            f"Impacts require a coefficient of friction of {number(found.impact_friction, 3)}, and much more with a "
            f"lower restitution{_at_impacts(found, mechanism)}."
        )
    if not isnan(found.lost):
        sentences.append(f"Contact is lost at {_where(found.lost_joint)} at {number(found.lost, 4)} s{beyond}.")
    if found.opens is not None and not isnan(found.opens):
        sentences.append(
            f"At {number(found.opens, 4)} s another joint would open, that between {found.opens_joint}{beyond}."
        )
    if found.crushing is not None:
        at = f"{_where(found.crushing.joint)} at {number(found.crushing.time, 4)} s"
        if found.crushing.used > 1:
            sentences.append(
                f"The contacts would crush: they carry up to {number(found.crushing.used, 3)} times their strength, "
                f"at {at}. The result is not valid once the strength is exceeded."
            )
        else:
            sentences.append(
                f"The contacts use at most {number(100 * found.crushing.used, 3)} % of their strength, at {at}."
            )
    sentences += [_support(each, mechanism) for each in found.supports]
    sums = _sums(found, mechanism)
    if sums == "whole" and all(mechanism.contacts(direction) for direction in mechanism.directions):
        sentences.append(
            "Statics alone does not determine the force at each joint: the forces are sums over the whole structure, "
            "on level ground, and a single joint may require more friction."
        )
    elif sums == "whole":
        sentences.append(
            "The positions of its joints are not known: the forces are sums over the whole structure, on level ground."
        )
    elif sums == "shared":
        sentences.append(
            "Statics alone does not determine the force at each joint, as there are more joints than needed: the "
            "friction required is a least-squares estimate, and the normal force is the sum over the whole structure."
        )
    elif sums is not None:
        sentences.append(f"Forces are sums over all {sums}.")
    return " ".join(sentences)


def _at_impacts(found: ContactDemand, mechanism: Mechanism) -> str:
    """Return what to do about the friction that impacts require, as a clause with its colon."""
    if found.friction is None and found.impact_friction <= MASONRY_FRICTION:
        return ""
    # The check uses impulses of the kinematic restitution; impulses of another restitution are not known by joint.
    if not found.followed or not mechanism.restitution_is_kinematic:
        return ": joints with less slide at impacts, which is not simulated; prevent this, for instance by dowels"
    if found.friction is None:
        return ": give `friction` in the file, and the check of the joints counts how far they slide at impacts"
    return ": the check of the joints counts how far they slide at impacts"


def _friction(found: ContactDemand, beyond: str) -> str:
    needed, at = number(found.friction_needed, 3), f"at {number(found.time, 4)} s"
    where = _where(found.joint) if found.joint else "the structure"
    if found.friction is None:
        lasts = f"it requires more than {100 * NEAR_PEAK:.0f} % of this value for {number(found.duration, 2)} s"
        usual = f"{'more' if found.beyond_masonry else 'no more'} than the {MASONRY_FRICTION:g} usual for masonry"
        return (
            f"Contact: {where} requires a coefficient of friction of up to {needed}, {at}, {usual}; around this time "
            f"{lasts}."
        )
    there = number(found.friction, 3)
    if isnan(found.slides):
        return f"Contact: {where} requires a coefficient of friction of up to {needed}, {at}; {there} is available."
    there_first = f" at {_where(found.slides_joint)}" if found.slides_joint else ""
    return (
        f"Sliding would start{there_first} at {number(found.slides, 4)} s{beyond}. It would last at most "
        f"{number(found.duration, 2)} s at a time. {where[0].upper()}{where[1:]} requires a coefficient of friction "
        f"of up to {needed}, {at}; {there} is available."
    )


def _support(found: SupportDemand, mechanism: Mechanism) -> str:
    per, unit = force_unit(mechanism)
    level = abs(found.way.real) > abs(found.way.imag)
    senses = ("to the right", "to the left") if level else ("upwards", "downwards")
    parts = [
        f"{number(force / per, 3)} {unit} {sense}"
        for force, sense in zip((found.most, -found.least), senses, strict=True) if force > 0
    ]  # fmt: skip
    return f"{found.support[0].upper()}{found.support[1:]} must provide up to {' and '.join(parts)}."


def _where(letter: str) -> str:
    return f"joint {letter}" if letter else "the ground"


def _sums(found: ContactDemand, mechanism: Mechanism) -> str | None:
    """Return the extent over which forces are summed: the whole structure, identical bodies, or none (None).

    `shared` is a least-squares estimate where statics alone does not determine the force at each joint.
    """
    if found.whole:
        return "whole"
    if found.shared:
        return "shared"
    joints = mechanism.joints(mechanism.directions[0])
    of_several = {name for joint in joints if joint.level for name in joint.bodies}
    return next((name for name in mechanism.alike() if name in of_several), None)
