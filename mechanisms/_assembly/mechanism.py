"""From velocities to a mechanism: groups of blocks that move as one, blocks at rest, hinges, and the line of thrust."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum

import numpy as np

from mechanisms._assembly.blocks import AssemblyBlock, AssemblyContact
from mechanisms._assembly.limit import Collapse
from mechanisms._assembly.problem import Frame
from rocking_cli.core import Direction, Guide, Reals

ZERO_VELOCITY = 1e-8  # velocity that counts as zero, over the fastest velocity
ZERO_NORMAL_FORCE = 1e-9  # normal force that counts as zero, over the largest normal force
SAME_PLACE = 1e-6  # distance of hinges that coincide, over the size of the assembly


class Opening(Enum):
    """State of a joint in a mechanism."""

    CLOSED = "stays closed"
    START = "hinges at its start"
    END = "hinges at its end"
    LIFTED = "opens at both ends, or slips off without pressing"
    SLIDES = "slides"


@dataclass(frozen=True)
class AssemblyHinge:
    """A point about which two groups, or a group and the blocks at rest, rotate relative to one another.

    Parameters
    ----------
    one, other : int or None
        Numbers of the two groups, the supporting one first; None for blocks at rest.
    point : complex
        Position at rest [m].
    contact : int
        The joint that opens about this point.
    """

    one: int | None
    other: int | None
    point: complex
    contact: int


@dataclass(frozen=True, eq=False)
class AssemblyLinkage:
    """A mechanism as a linkage of rigid groups.

    Parameters
    ----------
    groups : tuple of tuple of str
        Blocks that move as one.
    rest : tuple of str
        Blocks that do not move, and the ground bodies that joints name.
    velocity : ndarray, shape (groups, 3)
        Velocity of the point (0, 0) of each group [m/s], and its rotation, anticlockwise [rad/s].
    hinges : tuple of AssemblyHinge
        A point shared by k groups is k - 1 of them.
    guides : tuple of Guide
        Guides of groups that move.
    states : tuple of Opening
        State of each joint.
    """

    groups: tuple[tuple[str, ...], ...]
    rest: tuple[str, ...]
    velocity: Reals
    hinges: tuple[AssemblyHinge, ...]
    guides: tuple[Guide, ...]
    states: tuple[Opening, ...]

    @property
    def lifted(self) -> tuple[int, ...]:
        """Joints that open at both ends."""
        return tuple(k for k, state in enumerate(self.states) if state is Opening.LIFTED)

    @property
    def slides(self) -> tuple[int, ...]:
        """Joints that slide; with any of them, the mechanism has no rocking model."""
        return tuple(k for k, state in enumerate(self.states) if state is Opening.SLIDES)


def linkage(
    blocks: Sequence[AssemblyBlock],
    contacts: Sequence[AssemblyContact],
    guides: Sequence[Guide],
    collapsed: Collapse,
) -> AssemblyLinkage:
    """Return the groups, hinges and guides of a mechanism.

    Parameters
    ----------
    blocks, contacts, guides
        Blocks, joints and guides of the assembly.
    collapsed : Collapse
        Weakest mechanism; if it is not unique, the first one is used.

    Returns
    -------
    AssemblyLinkage
        The linkage, with its groups in the order of their first blocks.
    """
    size = Frame.of(blocks).size
    speed = np.abs(collapsed.velocity * np.array([1.0, 1.0, size])).max(axis=1)
    still = ZERO_VELOCITY * float(speed.max())
    states = tuple(
        _state(abs(o[0]), abs(o[1]), abs(s), c, still)
        for o, s, c in zip(collapsed.opening, collapsed.sliding, contacts, strict=True)
    )
    if collapsed.associated is not None:  # without dilation only the forces show whether a sliding joint presses
        normal = collapsed.normal.sum(axis=1)
        press = normal > ZERO_NORMAL_FORCE * normal.max(initial=0.0)
        states = tuple(
            (Opening.SLIDES if presses else Opening.LIFTED) if abs(slide) > still else state
            for state, slide, presses in zip(states, collapsed.sliding, press, strict=True)
        )
    moves = {block.name: bool(v > still) for block, v in zip(blocks, speed, strict=True)}
    parts = JoinedNames([name for name, does in moves.items() if does])
    for state, contact in zip(states, contacts, strict=True):
        if state is Opening.CLOSED and moves.get(contact.a) and moves.get(contact.b):
            parts.join(contact.a, contact.b)
    groups = parts.all()
    number = {name: k for k, group in enumerate(groups) for name in group}
    ground = dict.fromkeys(name for c in contacts for name in (c.a, c.b) if name not in moves)
    first = {group[0]: k for k, group in enumerate(groups)}
    velocity = np.zeros((len(groups), 3))
    for block, (vx, vy, omega) in zip(blocks, collapsed.velocity, strict=True):
        if block.name in first:
            origin = complex(vx, vy) - 1j * omega * block.centroid
            velocity[first[block.name]] = origin.real, origin.imag, omega
    hinges = _hinges(contacts, states, number, SAME_PLACE * size)
    held = tuple(guide for guide in guides if guide.bodies[0] in number)
    return AssemblyLinkage(
        tuple(groups),
        (*(name for name, does in moves.items() if not does), *ground),
        velocity,
        hinges,
        held,
        states,
    )


def _state(start: float, end: float, slide: float, contact: AssemblyContact, still: float) -> Opening:
    """Return the state of a joint from its rates of opening and slip; slip may open it by friction times slip."""
    dilates = (contact.friction or 0.0) * slide
    if slide > still and min(start, end) <= dilates + still:
        slips = contact.friction == 0 and max(start, end) > still
        return Opening.LIFTED if slips else Opening.SLIDES
    if max(start, end) <= still:
        return Opening.CLOSED
    if min(start, end) > still:
        return Opening.LIFTED
    return Opening.START if start <= still else Opening.END


def _hinges(
    contacts: Sequence[AssemblyContact], states: Sequence[Opening], number: dict[str, int], same_place: float
) -> tuple[AssemblyHinge, ...]:
    """Return a hinge for each joint that opens about an end, unless other hinges at that point imply it."""
    places: list[tuple[complex, JoinedNames]] = []
    hinges = []
    for k, (contact, state) in enumerate(zip(contacts, states, strict=True)):
        if state not in (Opening.START, Opening.END):
            continue
        point = contact.start if state is Opening.START else contact.end
        one, other = number.get(contact.a), number.get(contact.b)
        if not any(abs(point - place) <= same_place for place, _ in places):
            places.append((point, JoinedNames([None, *range(len(number))])))
        here = min(places, key=lambda place: abs(place[0] - point))[1]
        if here.join(one, other):
            hinges.append(AssemblyHinge(one, other, point, k))
    return tuple(hinges)


class JoinedNames:
    """Partition of names into groups, which grow as names are joined."""

    def __init__(self, names: Sequence[str | int | None]) -> None:
        self.of = {name: name for name in names}

    def root(self, name: str | int | None) -> str | int | None:
        """Return the name that represents the group to which a name belongs."""
        while self.of[name] != name:
            name = self.of[name]
        return name

    def join(self, one: str | int | None, other: str | int | None) -> bool:
        """Join the groups of two names; return whether they were separate."""
        one, other = self.root(one), self.root(other)
        self.of[other] = one
        return one != other

    def all(self) -> list[tuple[str, ...]]:
        """Return the groups, each in the order of their first names."""
        groups: dict[str | int | None, list[str]] = {}
        for name in self.of:
            groups.setdefault(self.root(name), []).append(str(name))
        return [tuple(group) for group in groups.values()]


def leading(mechanism: AssemblyLinkage, direction: Direction) -> int | None:
    """Return the group whose rotation measures a mechanism; None if no group rotates.

    Groups that hinge on blocks at rest are preferred, then those that turn clockwise in the positive direction, then
    the fastest one; of groups that turn equally fast, the first.
    """
    turns = -int(direction) * mechanism.velocity[:, 2]
    fastest_turn = float(np.abs(turns).max(initial=0.0))
    grounded = {g for h in mechanism.hinges if None in (h.one, h.other) for g in (h.one, h.other) if g is not None}
    able = [k for k in range(len(turns)) if abs(turns[k]) > ZERO_VELOCITY * fastest_turn]
    if not able:
        return None

    best = max((k in grounded, bool(turns[k] > 0)) for k in able)
    able = [k for k in able if (k in grounded, bool(turns[k] > 0)) == best]
    fastest = max(abs(turns[k]) for k in able)
    return next(k for k in able if abs(turns[k]) >= fastest * (1 - ZERO_VELOCITY))


ZERO_FORCE = 1e-9  # force that counts as zero, over the largest force


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
    least = ZERO_FORCE * max(float(np.abs(total).max(initial=0.0)), float(np.abs(shear).max(initial=0.0)))
    passages = {}
    for k, contact in enumerate(contacts):
        if total[k] > least:
            point = (normal[k, 0] * contact.start + normal[k, 1] * contact.end) / total[k]
            passages[k] = Passage(
                k, complex(point), complex(total[k] * contact.normal - 1j * contact.normal * shear[k])
            )
    order = _chain(contacts, blocks)
    if order is None:
        return Thrust(tuple(passages.values()), False)
    return Thrust(tuple(passages[k] for k in order if k in passages), True)


def _chain(contacts: Sequence[AssemblyContact], blocks: Sequence[str]) -> list[int] | None:
    """Return the joints in order along a chain of blocks; None if the assembly is not a chain."""
    of: dict[str, list[int]] = {name: [] for name in blocks}
    for k, contact in enumerate(contacts):
        for name in (contact.a, contact.b):
            if name in of:
                of[name].append(k)
    if any(len(joints) > 2 for joints in of.values()):
        return None
    # A chain begins at a joint of which at most one block has other joints.
    ends = [k for k, c in enumerate(contacts) if sum(len(of.get(name, ())) > 1 for name in (c.a, c.b)) < 2]
    if not ends:
        return None
    order = [ends[0]]
    while True:
        last = contacts[order[-1]]
        neighbours = [k for name in (last.a, last.b) for k in of.get(name, ()) if k not in order]
        if not neighbours:
            break
        order.append(neighbours[0])
    return order if len(order) == len(contacts) else None
