"""Points at which the forces of a state pass through the joints: a line of thrust, if the blocks are a chain."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from mechanisms._assembly.blocks import AssemblyContact
from rocking_cli.core import Reals

NONE = 1e-9  # forces that count as zero, over the largest one


@dataclass(frozen=True)
class Passage:
    """The force in one joint.

    Parameters
    ----------
    contact : int
        The joint.
    point : complex
        Point at which the resultant passes through the joint [m].
    force : complex
        Force on body `b` of the joint [N].
    """

    contact: int
    point: complex
    force: complex


@dataclass(frozen=True, eq=False)
class Thrust:
    """Forces in all joints that carry a normal force.

    Parameters
    ----------
    passages : tuple of Passage
        Forces in the order of the chain, or else of the joints.
    chain : bool
        Whether they form one line, from joint to joint across the blocks.
    """

    passages: tuple[Passage, ...]
    chain: bool


def thrust(contacts: Sequence[AssemblyContact], blocks: Sequence[str], normal: Reals, shear: Reals) -> Thrust:
    """Return the points at which the forces of a state pass through the joints.

    Parameters
    ----------
    contacts : sequence of AssemblyContact
        The joints.
    blocks : sequence of str
        Names of the blocks that can move.
    normal, shear : ndarray, shape (contacts, 2) and (contacts,)
        Forces of the state, as in `Collapse`.

    Returns
    -------
    Thrust
        Forces and points; a line if each block has at most two joints and all form one chain. The line is that of this
        state; others exist if blocks stay at rest.
    """
    total = normal.sum(axis=1)
    least = NONE * max(float(np.abs(total).max(initial=0.0)), float(np.abs(shear).max(initial=0.0)))
    found = {}
    for k, contact in enumerate(contacts):
        if total[k] > least:
            point = (normal[k, 0] * contact.start + normal[k, 1] * contact.end) / total[k]
            found[k] = Passage(k, complex(point), complex(total[k] * contact.normal - 1j * contact.normal * shear[k]))
    order = _chain(contacts, blocks)
    if order is None:
        return Thrust(tuple(found.values()), False)
    return Thrust(tuple(found[k] for k in order if k in found), True)


def _chain(contacts: Sequence[AssemblyContact], blocks: Sequence[str]) -> list[int] | None:
    """Return the joints in order along a chain of blocks; None if the assembly is not a chain."""
    of: dict[str, list[int]] = {name: [] for name in blocks}
    for k, contact in enumerate(contacts):
        for name in (contact.a, contact.b):
            if name in of:
                of[name].append(k)
    if any(len(joints) > 2 for joints in of.values()):
        return None
    # A chain begins at a joint with one block that can move, or at the joint of a block that has no other.
    ends = [k for k, c in enumerate(contacts) if sum(len(of.get(name, ())) > 1 for name in (c.a, c.b)) < 2]
    if not ends:
        return None
    order = [ends[0]]
    while True:
        last = contacts[order[-1]]
        ways = [k for name in (last.a, last.b) for k in of.get(name, ()) if k not in order]
        if not ways:
            break
        order.append(ways[0])
    return order if len(order) == len(contacts) else None
