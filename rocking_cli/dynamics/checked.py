"""Short names of the joints that are checked, for the sentence that says so."""

from __future__ import annotations

from collections.abc import Sequence

from rocking_cli.core import Mechanism
from rocking_cli.text import in_short

LISTED = 4  # names of a kind: the hinges of a frame or an arch in both directions
KINDS = (("foot", "feet"), ("hinge", "hinges"), ("closed joint", "closed joints"))


def checked_joints(mechanism: Mechanism) -> Sequence[str]:
    """Return the joints that are checked, by kind, such as "feet A, A'" and "closed joint low and high".

    Feet and hinges have the letters of drawings; joints that stay closed in both directions are named as in other
    messages, and so is a hinge without a letter.

    Parameters
    ----------
    mechanism : Mechanism
        The structure.
    """
    letters: dict[str, set[str]] = {}  # of each joint; none if it stays closed in both directions
    feet = set()
    for direction in mechanism.directions:
        drawn = {joint.point: joint.letter for joint in mechanism.joints(direction) if not joint.is_guide}
        for contact in mechanism.contacts(direction) or ():
            if contact.held is not None and not contact.pressed_by:
                continue
            known = letters.setdefault(contact.label, set())
            if len(contact.points) == 1 and contact.held is None:
                known.add(contact.letter or drawn.get(contact.points[0]) or contact.label)
            if None in contact.pieces:
                feet.add(contact.label)
    names: tuple[set[str], set[str], set[str]] = (set(), set(), set())
    for label, known in letters.items():
        names[2 if not known else 0 if label in feet else 1].update(known or {label})
    return [f"{KINDS[k][len(each) > 1]} {in_short(sorted(each), most=LISTED)}" for k, each in enumerate(names) if each]
