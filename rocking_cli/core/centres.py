"""Instantaneous centres of a chain of links from its joints, by the theorem of Aronhold and Kennedy.

The centres of three links relative to one another, taken two by two, lie on one line. Each centre that is not a joint
is where two such lines cross; the normal of a guide at its point is such a line too. All lengths are in m.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

PARALLEL_SINE = 1e-10  # sine of the angle of two lines below which they do not cross
SAME_POINT = 1e-12  # distance of two points that count as one, over the size of the chain
GROUND = 0  # number of the ground among the links

Pair = tuple[int, int]


@dataclass(frozen=True)
class Locus:
    """A line on which a centre lies.

    Parameters
    ----------
    at, along : complex
        A point of the line [m], and its direction: from this point to the second one, or the normal of a guide. Both
        are zero for the line at infinity.
    through : tuple of str
        Symbols of its points: of two centres, or of one whose line has a given direction; empty at infinity.
    """

    at: complex
    along: complex
    through: tuple[str, ...] = ()

    @property
    def is_at_infinity(self) -> bool:
        """Whether the centre has no distance at all, as that of a link which does not turn."""
        return self.along == 0


@dataclass(frozen=True)
class Centre:
    """The centre of two links relative to one another.

    Parameters
    ----------
    symbol : str
        The letter of a joint, or O and the number of a link for a centre relative to the ground, or C and two numbers.
    at : complex
        Its position [m]; its direction if it is at infinity.
    is_at_infinity : bool
        Whether the two links do not turn relative to one another.
    by : tuple of Locus
        The two lines that cross there; empty for a joint.
    of : tuple of pairs of int
        The centres from which these lines come.
    """

    symbol: str
    at: complex
    is_at_infinity: bool = False
    by: tuple[Locus, ...] = ()
    of: tuple[Pair, ...] = ()


class Centres:
    """The centres of a chain in one position.

    Parameters
    ----------
    count : int
        Number of links, which are numbered from 1; the ground is 0.
    hinges : mapping of pairs of int to Centre
        Joints that two links share, by the numbers of the links in increasing order.
    lines : mapping of pairs of int to sequence of Locus
        Lines on which a guide puts the centre of two links.
    size : float
        Size of the chain [m].
    """

    def __init__(
        self, count: int, hinges: Mapping[Pair, Centre], lines: Mapping[Pair, Sequence[Locus]], size: float
    ) -> None:
        self._links, self._lines, self._size = range(count + 1), lines, size
        self.known = dict(hinges)
        while self._more():
            pass

    def _more(self) -> bool:
        """Add each centre in which two lines of known centres cross; return whether there were any."""
        pairs = [pair for pair in combinations(self._links, 2) if pair not in self.known]
        crossed = {pair: centre for pair in pairs if (centre := self._crossed(pair)) is not None}
        self.known |= crossed
        return bool(crossed)

    def _crossed(self, pair: Pair) -> Centre | None:
        i, j = pair
        loci: list[tuple[Locus, tuple[Pair, ...]]] = [(locus, ()) for locus in self._lines.get(pair, ())]
        for k in self._links:
            sides = _pair(i, k), _pair(k, j)
            if k not in pair and all(side in self.known for side in sides):
                locus = self._through(*(self.known[side] for side in sides))
                loci += [(locus, sides)] if locus is not None else []
        two = max(combinations(loci, 2), key=lambda two: _sine(two[0][0], two[1][0]), default=None)
        if two is None:
            return None
        (one, first), (other, second) = two
        symbol = f"O{j}" if i == GROUND else f"C{i}{j}" if j < 10 else f"C{i},{j}"
        by, of = (one, other), (*first, *second)
        if one.is_at_infinity or other.is_at_infinity:
            return Centre(symbol, one.along or other.along, True, by, of) if one.along or other.along else None
        if _sine(one, other) < PARALLEL_SINE:
            beside = abs(_cross(one.along, other.at - one.at)) > SAME_POINT * abs(one.along) * self._size
            return Centre(symbol, one.along, True, by, of) if beside else None  # one line has no single centre
        share = _cross(other.at - one.at, other.along) / _cross(one.along, other.along)
        return Centre(symbol, one.at + share * one.along, False, by, of)

    def _through(self, one: Centre, other: Centre) -> Locus | None:
        """Return the line through two centres; None if these are one point."""
        if one.is_at_infinity and other.is_at_infinity:
            return (
                Locus(0j, 0j) if abs(_cross(one.at, other.at)) > PARALLEL_SINE * abs(one.at) * abs(other.at) else None
            )
        if one.is_at_infinity:
            one, other = other, one
        if other.is_at_infinity:
            return Locus(one.at, other.at, (one.symbol,))
        if abs(other.at - one.at) <= SAME_POINT * self._size:
            return None
        return Locus(one.at, other.at - one.at, (one.symbol, other.symbol))

    def between(self, one: int, other: int) -> Centre | None:
        """Return the centre of two links; None if it does not follow from the joints by crossing lines."""
        return self.known.get(_pair(one, other))

    def traced(self, pairs: Sequence[Pair]) -> list[Centre]:
        """Return these centres and those from which they follow, in the order in which they follow."""
        order: dict[Pair, Centre] = {}

        def trace(pair: Pair) -> None:
            if pair not in order:
                for each in self.known[pair].of:
                    trace(each)
                order[pair] = self.known[pair]

        for one, other in pairs:
            trace(_pair(one, other))
        return list(order.values())


def _pair(one: int, other: int) -> Pair:
    return min(one, other), max(one, other)


def _cross(one: complex, other: complex) -> float:
    return (one.conjugate() * other).imag


def _sine(one: Locus, other: Locus) -> float:
    """Return the sine of the angle of two lines; 1 if one of them is at infinity, where all others meet it."""
    if one.is_at_infinity or other.is_at_infinity:
        return 0.0 if one.is_at_infinity and other.is_at_infinity else 1.0
    return abs(_cross(one.along, other.along)) / (abs(one.along) * abs(other.along))
