"""Attachments of a structure as they are drawn: loads, ties as pieces between points, and side walls."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np

from rocking_cli.arrays import Bools, Points, Reals
from rocking_cli.core import Direction, Mechanism, three_digits
from rocking_cli.core.hung.attached import PointMass
from rocking_cli.core.hung.element import COINCIDENT_DISTANCE, ConstantForce, Element, SpringBed, Stretched
from rocking_cli.excitation.base import STANDARD_GRAVITY

Copies = Mapping[str, Sequence[tuple[int, complex]]]
"""The parts as which each body is drawn: index of the part, and its offset from the body [m]."""
SPRINGS_PER_BED = 8  # The parts drawn for each body: index of the part, and its offset from the body [m].
TONNE = 1000.0  # kg; masses from here on are given in t


class End(NamedTuple):
    """An end of a piece of a tie: a point of a part, or of the ground (part None), at rest [m].

    `lead` is the distance from the point to the start of a symbol, in lengths of the symbol; it turns with the part.
    """

    part: int | None
    point: complex
    lead: complex = 0j


class TiePiece(NamedTuple):
    """A piece of a tie: a plain line for a bar or a tendon, a line with a spring in it, or a spring symbol alone."""

    start: End
    end: End
    kind: Literal["line", "spring", "symbol"]

    @property
    def together(self) -> bool:
        """Whether its ends coincide at rest, so that they are drawn apart."""
        return bool(self.start.lead or self.end.lead)


@dataclass(frozen=True)
class Carried:
    """A load as it is drawn.

    Parameters
    ----------
    name, text : str
        Name of the load, and its size in words.
    part : int
        Index of the part that carries the load.
    point : complex
        The point at which it acts, at rest [m].
    mass : float or None
        Mass [kg]; None for a force.
    force : complex or None
        Force [N], x to the right, y up, as it acts in the first direction of rocking; None for a mass.
    friction : bool
        Whether the force opposes the motion in both directions.
    """

    name: str
    text: str
    part: int
    point: complex
    mass: float | None = None
    force: complex | None = None
    friction: bool = False

    def acting(self, *, first: bool) -> complex:
        """Return the force while the structure rocks in its first direction or in the other [N]; 0 for a mass."""
        force = self.force or 0j
        return force if first or not self.friction else complex(-force.real, force.imag)


@dataclass(frozen=True)
class Strand:
    """A tie as it is drawn.

    Parameters
    ----------
    name : str
        Name of the tie.
    pieces : tuple of TiePiece
        The pieces from end to end; for a bed of springs, some of the springs.
    thing : Element
        The element with its force.
    """

    name: str
    pieces: tuple[TiePiece, ...]
    thing: Element

    @property
    def is_bed(self) -> bool:
        """Whether the tie is a row of springs along a face."""
        return isinstance(self.thing, SpringBed)

    @property
    def only(self) -> str | None:
        """The one sense in which the tie can act, tension or compression; None if it acts in both."""
        return self.thing.only if isinstance(self.thing, Stretched) else None

    @property
    def ground(self) -> list[End]:
        """The ends of the tie that are on the ground."""
        return [end for piece in self.pieces for end in (piece.start, piece.end) if end.part is None]

    def slack(self, mechanism: Mechanism, phi: Reals, direction: Direction) -> Bools:
        """Mask of the rotations at which the tie is slack, shape (n,)."""
        if not isinstance(self.thing, Stretched) or self.only is None:
            return np.zeros(phi.shape, bool)
        return self.slack_at(self.thing.elongation(mechanism.followed(phi, direction))[0])

    def slack_at(self, e: Reals) -> Bools:
        """Mask of the elongations at which the tie is slack, shape (n,) [m]."""
        if not isinstance(self.thing, Stretched) or self.only is None:
            return np.zeros(e.shape, bool)
        taut = self.thing.slack_at(e) * (1.0 if self.only == "tension" else -1.0)
        force, stiffness = self.thing.at_rest
        return np.asarray(taut < -1e-9 * (abs(force) + stiffness * float(np.abs(e).max(initial=0.0))))


def carried(mechanism: Mechanism, copies: Copies) -> Iterator[Carried]:
    """Yield the loads of a structure; a load that each of several equal bodies has, once for each body."""
    each, per_metre = _each(mechanism), {load.name: load.mass_per_metre for load in mechanism.loads or []}
    for load in mechanism.attached:
        if not isinstance(load, PointMass | ConstantForce):
            continue
        count = mechanism.alike().get(load.spot.body or "", 1) if each.get(load.name) else 1
        for k, (part, shift) in enumerate(_copies(load.spot.body, copies, every=each.get(load.name, False))):
            point, name = load.spot.at + shift, load.name if k == 0 else ""
            if isinstance(load, PointMass):
                mass = load.mass / count
                given = per_metre.get(load.name)
                text = _as_given(mechanism, mass) if given is None else _as_given(mechanism, given, "/m")
                yield Carried(name, text, part, point, mass=mass)
            else:
                force = load.in_direction(mechanism.directions[0]) / count
                text = f"{three_digits(abs(force) / 1000)} kN" if force else "0"
                yield Carried(name, text, part, point, force=force, friction=load.friction)


def _as_given(mechanism: Mechanism, mass: float, per: str = "") -> str:
    """Return a mass [kg], or one `per` metre, in words: as a weight if it was given as one."""
    if any(f": {mass:.6g} kg{per} (" in each for each in mechanism.remarks):
        return f"{three_digits(mass * STANDARD_GRAVITY / 1000)} kN{per}"
    return f"{mass / TONNE:.3g} t{per}" if mass >= TONNE else f"{mass:.3g} kg{per}"


def strands(mechanism: Mechanism, copies: Copies, centroids: Sequence[complex]) -> Iterator[Strand]:
    """Yield the ties of a structure; a tie that each of several equal bodies has, once for each body."""
    each = _each(mechanism)
    springs = {tie.name for tie in mechanism.ties or [] if tie.stiffness}  # others have a section, or a law
    for tie in mechanism.hung.ties:
        first = next(spot.body for part in tie.stretched for spot in part.spots if spot.body is not None)
        for k, (part, shift) in enumerate(_copies(first, copies, every=each.get(tie.name, False))):
            name = tie.name if k == 0 else ""
            if isinstance(tie, SpringBed):
                yield Strand(name, tuple(_bed(tie, part, shift, centroids[part])), tie)
            elif isinstance(tie, Stretched):
                of_body = {body: those[min(k, len(those) - 1)][0] for body, those in copies.items()}
                yield Strand(name, tuple(_pieces(tie, of_body, shift, spring=tie.name in springs)), tie)


def walls(mechanism: Mechanism, low: complex, high: complex) -> tuple[Points, ...]:
    """Return the side wall of a structure that rocks to one side only, between two corners of its box [m].

    The wall is on the right of someone who walks along the line. Empty if the structure rocks to both sides.
    """
    if mechanism.rocks_both_ways:
        return ()
    if mechanism.directions[0] is Direction.POSITIVE:  # the structure leans on a wall to its left
        return (np.array([complex(low.real, high.imag), low]),)
    return (np.array([complex(high.real, low.imag), high]),)


def _each(mechanism: Mechanism) -> Mapping[str, bool]:
    loads = {load.name: load.each for load in mechanism.loads or []}
    return loads | {tie.name: tie.each for tie in mechanism.ties or []}


def _copies(body: str | None, copies: Copies, *, every: bool) -> Sequence[tuple[int, complex]]:
    parts = copies[body or ""]
    return parts if every else parts[:1]


def _pieces(tie: Stretched, of_body: Mapping[str, int], shift: complex, *, spring: bool) -> Iterator[TiePiece]:
    for one, other in zip(tie.spots, tie.spots[1:], strict=False):
        parts = [None if spot.body is None else of_body[spot.body] for spot in (one, other)]
        kind: Literal["line", "spring", "symbol"] = "line"
        start, end = End(parts[0], one.at + shift), End(parts[1], other.at + shift)
        if abs(other.at - one.at) <= COINCIDENT_DISTANCE * (1 + abs(one.at)):
            # The ends of this tie coincide at rest: they are drawn apart, the fixed end below the moving one.
            up = -1j if parts[1] is None else 1j
            start, end = start._replace(lead=-up), end._replace(lead=up)
            kind = "symbol" if spring else "line"
        elif spring and (None in parts or len(tie.spots) == 2):
            kind = "spring"
        yield TiePiece(start, end, kind)


def _bed(bed: SpringBed, part: int, shift: complex, centroid: complex) -> Iterator[TiePiece]:
    along = (bed.end.at - bed.start.at) / abs(bed.end.at - bed.start.at)
    middle = (bed.start.at + bed.end.at) / 2 + shift
    out = 1j * along if ((middle - centroid) * (1j * along).conjugate()).real > 0 else -1j * along
    for share in (np.arange(SPRINGS_PER_BED) + 0.5) / SPRINGS_PER_BED:
        at = bed.start.at + complex(share) * (bed.end.at - bed.start.at) + shift
        yield TiePiece(End(None, at, 1.5 * out), End(part, at), "symbol")
