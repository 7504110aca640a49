"""Print an elevation of two storeys in running bond, an assembly of rigid blocks: `wall_with_openings.yaml` is made so.

    python make_wall.py > wall_with_openings.yaml

Sizes are counted in half blocks along the wall and in courses up it. Below the sills the wall is whole, but for the
door; between door and windows stand piers of one block's length; a ring beam crosses them and carries the upper storey.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

HALF, HIGH = 0.25, 0.25  # length of half a block, and height of a course [m]
PIERS, PIER, BAY = 5, 2, 4  # piers, and half blocks in a pier and in the opening after it
SILL, BEAM, TOP = 3, 12, 23  # courses below the sills, below the ring beam, and of the whole
UPPER = (15, 20)  # courses below the windows of the upper storey, and below their lintels
BEARING = 1  # half blocks on which a lintel bears at either end
DOOR = 1  # the opening that begins at the ground
WIDTH = PIERS * PIER + (PIERS - 1) * BAY
STONE, CONCRETE = 2600, 2500  # density of sills and lintels, and of the ring beam [kg/m3]
HEAD = """\
# An elevation of two storeys in running bond, printed by make_wall.py: a door and windows, lintels and a ring beam.
mechanism: assembly
name: wall with openings
density: 1800            # [kg/m3]
depth: 0.3               # out of plane [m]
friction: 0.6
restitution: 0.85        # per impact, assumed
blocks:"""


@dataclass(frozen=True)
class Piece:
    """What fills a course from one half block to before another: an opening has no name."""

    first: int
    end: int
    name: str = ""
    density: int = 0


def special(course: int) -> list[Piece]:
    """The openings and long pieces of a course, from the left."""
    bays = [PIER + k * (PIER + BAY) for k in range(PIERS - 1)]
    door = bays[DOOR]
    if course == BEAM:
        return [Piece(0, WIDTH, "ring beam", CONCRETE)]
    if course == SILL:
        return [
            Piece(0, door, "left sill", STONE),
            Piece(door, door + BAY),
            Piece(door + BAY, WIDTH, "right sill", STONE),
        ]
    if course < SILL:
        return [Piece(door, door + BAY)]
    low, high = UPPER
    if course < BEAM or low <= course < high:
        return [Piece(bay, bay + BAY) for bay in bays]
    if course == high:
        return [Piece(bay - BEARING, bay + BAY + BEARING, f"lintel {k + 1}", STONE) for k, bay in enumerate(bays)]
    return []


def bond(course: int, first: int, end: int) -> Iterator[Piece]:
    """Blocks between two places, their upright joints above the middles of the blocks below."""
    edges = [first, *(k for k in range(first + 1, end) if (k - course) % 2 == 0), end]
    yield from (Piece(*each) for each in pairwise(edges))


def pieces(course: int) -> Iterator[Piece]:
    """All blocks of a course, from the left: those between its openings and long pieces count from 1."""
    number, at = 0, 0
    for each in [*special(course), Piece(WIDTH, WIDTH)]:
        for block in bond(course, at, each.first) if at < each.first else ():
            number += 1
            yield Piece(block.first, block.end, f"{course + 1}.{number}")
        if each.name:
            yield each
        at = each.end


def box(left: float, right: float, low: float, high: float) -> str:
    """A rectangle as it stands in a file."""
    return f"[[{left:g}, {low:g}], [{right:g}, {low:g}], [{right:g}, {high:g}], [{left:g}, {high:g}]]"


if __name__ == "__main__":
    print(HEAD)
    for course in range(TOP):
        for each in pieces(course):
            polygon = box(HALF * each.first, HALF * each.end, HIGH * course, HIGH * (course + 1))
            own = f", density: {each.density}" if each.density else ""
            name = each.name if " " in each.name else f'"{each.name}"'  # a number would not be a name
            print(f"  {name}: {{polygon: {polygon}{own}}}")
    print(f"ground:\n  floor: {{polygon: {box(-1.0, HALF * WIDTH + 1, -0.5, 0.0)}}}")
