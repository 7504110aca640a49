"""Lines of SVG drawings: paths and basic shapes as lines, arcs and curves, and chains made of them.

Points are complex numbers. In the coordinates of SVG, y is down; the map that makes a chain of a track turns it up.
"""

from __future__ import annotations

import cmath
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import accumulate, pairwise
from math import asin, ceil, cos, pi, radians, sqrt, tan
from typing import NamedTuple

import numpy as np

from rocking_cli.io.drawings.contract import MAX_NUMBER
from rocking_cli.text import cut

FLATNESS = 1e-6  # distance of a curve from its straight sides, over the size of its path
ROUND = 1e-6  # ellipses of axes closer than this to each other are circles
ARC_OF_CUBIC = 5e-3  # distance of the control points of a cubic from those of an arc, over the rise of the arc
MAX_TURN_OF_CUBIC = 2.2  # rad; nobody draws more than a third of a circle as one cubic
MAX_SIDES_OF_CURVE = 2_000
MAX_CHARACTERS = 2_000_000  # of a path or a list of points
MAX_TRANSFORM_CHARACTERS = 1000

_COMMANDS = re.compile(r"([A-DF-Za-df-z])")  # an e is part of a number
_NUMBER = re.compile(r"(?>[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)", re.ASCII)
_ARC = re.compile(rf"({_NUMBER.pattern})[\s,]*" * 3 + r"([01])[\s,]*([01])[\s,]*" + rf"({_NUMBER.pattern})[\s,]*" * 2)
_STRAY = re.compile(r"[^-+.,\deE\s]|^\s*,|,\s*(?:,|$)", re.ASCII)  # not in a list of numbers
_TRANSFORM = re.compile(r"\s*(\w+)\s*\(([^()]*)\)\s*,?")
_ARGUMENTS = {"M": 2, "L": 2, "H": 1, "V": 1, "C": 6, "S": 4, "Q": 4, "T": 2, "Z": 0}


class Affine(NamedTuple):
    """The map z -> turn z + mirror conj(z) + shift of the plane."""

    turn: complex = 1 + 0j
    mirror: complex = 0j
    shift: complex = 0j

    def __call__(self, z: complex) -> complex:
        """Return the image of a point."""
        return self.turn * z + self.mirror * z.conjugate() + self.shift

    def after(self, first: Affine) -> Affine:
        """Return the map that applies `first` and then this one."""
        turn = self.turn * first.turn + self.mirror * first.mirror.conjugate()
        mirror = self.turn * first.mirror + self.mirror * first.turn.conjugate()
        return Affine(turn, mirror, self(first.shift))

    @property
    def is_flat(self) -> bool:
        """Whether the map leaves no area."""
        one, other = abs(self.turn), abs(self.mirror)
        return abs(one - other) <= 1e-12 * max(one, other)


def scaling(x: float, y: float) -> Affine:
    """Return the map that scales by x and y; -1 mirrors."""
    return Affine(complex(x + y) / 2, complex(x - y) / 2)


class Bezier(NamedTuple):
    """A quadratic or cubic curve."""

    controls: tuple[complex, ...]
    end: complex


class Arc(NamedTuple):
    """Part of an ellipse, centre + forward exp(i s) + backward exp(-i s), for s from `start` through `turn`."""

    centre: complex
    forward: complex
    backward: complex
    start: float
    turn: float
    end: complex

    def at(self, share: float) -> complex:
        """Return the point after a share of the turn."""
        step = cmath.rect(1.0, self.start + share * self.turn)
        return self.centre + self.forward * step + self.backward * step.conjugate()


Piece = complex | Bezier | Arc
"""Part of a track; of a straight side its end alone."""


@dataclass
class Track:
    """A subpath: its first point, its pieces, and whether it is closed."""

    start: complex
    pieces: list[Piece]
    closed: bool = False


class Bent(NamedTuple):
    """Corners and bulges of a track, with y up; see `DrawnLine`."""

    points: list[complex]
    bulges: list[float]
    closed: bool
    arcs_found: int
    is_straightened: bool


def numbers(text: str) -> list[float]:
    """Return the numbers in a list with commas or blanks or, where it is clear, nothing between them.

    Raises
    ------
    ValueError
        If there is anything else in the text, or a number beyond `MAX_NUMBER`.
    """
    if len(text) > MAX_CHARACTERS:
        raise ValueError(f"has a list of more than {MAX_CHARACTERS:,} characters")
    if _STRAY.search(text):
        raise ValueError(f"`{cut(text)}` is not a list of numbers")
    try:
        values = [float(each) for each in text.replace(",", " ").split()]
    except ValueError:
        if _NUMBER.sub(" ", text).replace(",", " ").strip():
            raise ValueError(f"`{cut(text)}` is not a list of numbers") from None
        values = [float(each) for each in _NUMBER.findall(text)]
    if values and not (-MAX_NUMBER < min(values) <= max(values) < MAX_NUMBER):
        raise ValueError(f"`{cut(text)}` has a number beyond {MAX_NUMBER:g}")
    return values


def transform(text: str) -> Affine:
    """Return the map of a list of transforms. Raises `ValueError` if it is not one."""
    if len(text) > MAX_TRANSFORM_CHARACTERS:
        raise ValueError(f"has a transform of more than {MAX_TRANSFORM_CHARACTERS} characters")
    whole, place = Affine(), 0
    while place < len(text.rstrip()):
        match = _TRANSFORM.match(text, place)
        step = match and _step(match[1], numbers(match[2]))
        if not match or not step:
            raise ValueError(f"`{cut(text)}` is not a list of transforms")
        whole, place = whole.after(step), match.end()
    return whole


def _step(name: str, given: Sequence[float]) -> Affine | None:
    """Return the map of one transform; None if there is none of this name and number of values."""
    match name, given:
        case "matrix", [a, b, c, d, e, f]:
            return Affine(complex(a + d, b - c) / 2, complex(a - d, b + c) / 2, complex(e, f))
        case "translate", [x, *y] if len(y) < 2:
            return Affine(shift=complex(x, *y))
        case "scale", [x, *y] if len(y) < 2:
            return scaling(x, *(y or [x]))
        case "rotate", [angle, *about] if len(about) in (0, 2):
            turn, centre = cmath.rect(1.0, radians(angle)), complex(*about)
            return Affine(turn, 0j, centre - turn * centre)
        case "skewX", [angle]:
            return Affine(complex(1, -tan(radians(angle)) / 2), complex(0, tan(radians(angle)) / 2))
        case "skewY", [angle]:
            return Affine(complex(1, tan(radians(angle)) / 2), complex(0, tan(radians(angle)) / 2))
    return None


def polygon(points: Sequence[complex], closed: bool) -> list[Track]:
    """Return the track of straight sides through some points."""
    return [Track(points[0], list(points[1:]), closed)] if points else []


def rectangle(corner: complex, width: float, height: float, rx: float, ry: float) -> list[Track]:
    """Return the track of a rectangle, from its corner with the least coordinates; rx and ry round its corners.

    An ellipse is a rectangle with radii of half its size.
    """
    across, up, x, y = width - 2 * rx, height - 2 * ry, complex(rx), complex(0, ry)
    if not (rx and ry):
        return polygon([corner, corner + width, corner + complex(width, height), corner + 1j * height], closed=True)
    text = f"M{corner.real + rx!r} {corner.imag!r}"
    for side, turn in ((f"h{across!r}", x + y), (f"v{up!r}", y - x), (f"h{-across!r}", -x - y), (f"v{-up!r}", x - y)):
        text += f"{side}a{rx!r} {ry!r} 0 0 1 {turn.real!r} {turn.imag!r}"
    return path(text + "z")


def path(text: str) -> list[Track]:
    """Return the subpaths of path data. Raises `ValueError` if it is not valid."""
    if len(text) > MAX_CHARACTERS:
        raise ValueError(f"has a path of more than {MAX_CHARACTERS:,} characters")
    before, *parts = _COMMANDS.split("" if text.strip() == "none" else text)
    if before.strip() or (parts and parts[0] not in "Mm"):
        raise ValueError(f"the path `{cut(text)}` does not start with M")
    tracks: list[Track] = []
    # The value of the last decimal that its numbers are written with.
    digits = 10.0 ** -max(map(len, re.findall(r"\.(\d+)", text)), default=0) if {"A", "a"} & set(parts) else 0.0
    start = here = 0j
    last = ""  # the command before, in capitals
    control = 0j  # the last control point of the curve before
    pieces: list[Piece] = []
    for command, rest in zip(parts[::2], parts[1::2], strict=True):
        capital, relative = command.upper(), command.islower()
        if capital == "A":
            for rx, ry, angle, large, sweep, end in _arcs(rest):
                end = end + here if relative else end
                pieces = pieces if last not in ("M", "Z") else _begun(tracks, here)
                pieces += _arc(here, rx, ry, angle, large, sweep, end, digits)
                here, last = end, capital
            continue
        count, given = _ARGUMENTS.get(capital), numbers(rest)
        if count is None or (given if not count else not given or len(given) % count):
            raise ValueError(f"the path has `{cut(command + rest)}`, which is not a valid command")
        if capital == "Z":
            if last not in ("Z", "M"):
                tracks[-1].closed = True
            here, last = start, capital
        if capital == "M":
            start = here = complex(*given[:2]) + (here if relative else 0)
            given, last = given[2:], capital
        if given and last in ("M", "Z"):
            pieces = _begun(tracks, here)
        if capital in "ML" and given:
            ends = list(map(complex, given[::2], given[1::2]))
            ends = list(accumulate(ends, initial=here))[1:] if relative else ends
            pieces += ends
            here, last = ends[-1], "L"
            continue
        for k in range(0, len(given), count or 1):
            if capital == "H":
                ends = [complex(given[k] + (here.real if relative else 0), here.imag)]
            elif capital == "V":
                ends = [complex(here.real, given[k] + (here.imag if relative else 0))]
            else:
                base = here if relative else 0j
                ends = [base + complex(given[j], given[j + 1]) for j in range(k, k + count, 2)]
            if capital in "CSQT":
                if capital in "ST":
                    smooth = last in ("CS" if capital == "S" else "QT")
                    ends.insert(0, 2 * here - control if smooth else here)
                control = ends[-2]
                pieces.append(Bezier(tuple(ends[:-1]), ends[-1]))
            else:
                pieces.append(ends[0])
            here, last = ends[-1], capital
    return tracks


def _begun(tracks: list[Track], start: complex) -> list[Piece]:
    tracks.append(Track(start, []))
    return tracks[-1].pieces


def _arcs(text: str) -> Iterator[tuple[float, float, float, bool, bool, complex]]:
    """Yield the values of each arc of a command. Raises `ValueError`."""
    if _STRAY.search(text):
        raise ValueError(f"`{cut(text)}` is not a list of arcs")
    text, place = text.strip(), 0
    while place < len(text) or not text:
        match = _ARC.match(text, place)  # not a search, whose time grows with the square of the length
        if not match:
            raise ValueError(f"`{cut(text[place:])}` is not an arc of a path")
        rx, ry, angle, x, y = numbers(" ".join(match.group(1, 2, 3, 6, 7)))
        yield abs(rx), abs(ry), radians(angle), match[4] == "1", match[5] == "1", complex(x, y)
        place = match.end()


def _arc(
    here: complex, rx: float, ry: float, angle: float, large: bool, sweep: bool, end: complex, digits: float
) -> list[Piece]:
    """Return the arc between two points, by appendix F.6 of SVG 1.1; none between equal points."""
    if here == end:
        return []
    if min(rx, ry) < 1 / MAX_NUMBER:
        return [end]
    axis = cmath.rect(1.0, angle)
    w = (here - end) / 2 / axis
    u = complex(w.real / rx, w.imag / ry)  # half the chord, where the ellipse is the unit circle
    half = abs(u)
    # Ellipses that are too small grow. Half a turn whose ends are rounded would have its centre far off.
    if half > 1 or (1 - half) * rx <= min(digits, 1e-5 * rx):
        rx, ry, u, half = rx * half, ry * half, u / half, 1.0
    aside = sqrt(max(1 / half**2 - 1, 0.0)) * (1 if large != sweep else -1)
    offset = -1j * aside * u
    turn = 2 * asin(half)
    turn = (2 * pi - turn if large else turn) * (1 if sweep else -1)
    centre = (here + end) / 2 + axis * complex(offset.real * rx, offset.imag * ry)
    return [Arc(centre, axis * (rx + ry) / 2, axis * (rx - ry) / 2, cmath.phase(u - offset), turn, end)]


def bent(tracks: Sequence[Track], to: Affine) -> Iterator[Bent]:
    """Yield the corners and bulges of the tracks of one path, those of no length left out.

    Parameters
    ----------
    tracks : sequence of Track
        The tracks.
    to : Affine
        Map from their coordinates to those of the drawing.
    """
    moved = [Track(to(each.start), [_moved(piece, to) for piece in each.pieces], each.closed) for each in tracks]
    size = _size(moved)
    if not FLATNESS * size:
        return
    for track in moved:
        arcs_found, straightened, last = 0, False, track.start
        points, bulges = [last], list[float]()
        for piece in track.pieces:
            inner: list[complex] = []
            bulge = 0.0
            if isinstance(piece, complex):
                end = piece
            else:
                end = piece.end
                if isinstance(piece, Arc):
                    inner, bulge = _arc_corners(piece, size)
                    straightened |= not bulge
                elif not _is_straight(last, piece, size):
                    bulge = _bulge_of(last, piece)
                    arcs_found += bulge != 0
                    inner = [] if bulge else _curve_corners(last, piece, size)
                    straightened |= not bulge
            for z in (*inner, end) if inner else (end,):
                if abs(z - last) > 1e-12 * size:
                    points.append(z)
                    bulges.append(bulge)
                    last = z
        meets = abs(last - points[0]) <= 1e-9 * size
        closed = track.closed or (meets and len(points) > 2)
        if closed and meets:
            del points[-1]
        else:
            bulges.append(0.0)
        if len(points) > 1:
            yield Bent(points, bulges, closed, arcs_found, straightened)


def _end(piece: Piece) -> complex:
    return piece if isinstance(piece, complex) else piece.end


def _moved(piece: Piece, to: Affine) -> Piece:
    if isinstance(piece, complex):
        return to(piece)
    if isinstance(piece, Bezier):
        return Bezier(tuple(to(z) for z in piece.controls), to(piece.end))
    a, b = piece.forward, piece.backward
    forward = to.turn * a + to.mirror * b.conjugate()
    backward = to.turn * b + to.mirror * a.conjugate()
    return Arc(to(piece.centre), forward, backward, piece.start, piece.turn, to(piece.end))


def _size(tracks: Sequence[Track]) -> float:
    """Return the larger side of the box around some tracks, with the control points of their curves."""
    whole = [track.start for track in tracks]
    for track in tracks:
        for piece in track.pieces:
            whole.append(_end(piece))
            if isinstance(piece, Bezier):
                whole += piece.controls
            elif isinstance(piece, Arc):
                whole.append(piece.at(0.5))
    x, y = [z.real for z in whole], [z.imag for z in whole]
    return max(max(x) - min(x), max(y) - min(y)) if whole else 0.0


def _arc_corners(arc: Arc, size: float) -> tuple[list[complex], float]:
    """Return the corners within an arc, and the bulge of its sides: 0 if it is no part of a circle."""
    one, other = abs(arc.forward), abs(arc.backward)
    if min(one, other) <= ROUND * max(one, other):
        turn = arc.turn if one > other else -arc.turn
        parts = 2 if abs(turn) > pi * (1 + 1e-9) else 1
        return [arc.at(0.5)] * (parts - 1), tan(turn / parts / 4)
    count = _sides(arc.turn**2 * (one + other), size)
    step = np.exp(1j * (arc.start + arc.turn * np.arange(1, count) / count))
    corners: list[complex] = (arc.centre + arc.forward * step + arc.backward * step.conj()).tolist()
    return corners, 0.0


def _sides(second: float, size: float) -> int:
    """Return the number of sides, equal in the parameter, of a curve with at most this second derivative."""
    return min(max(ceil(sqrt(second / (8 * FLATNESS * size))), 1), MAX_SIDES_OF_CURVE)


def _is_straight(start: complex, curve: Bezier, size: float) -> bool:
    """Return whether all control points of a curve lie on its chord, between its ends."""
    along = curve.end - start
    if not along:
        return all(abs(z - start) <= 1e-9 * size for z in curve.controls)
    shares = [(z - start) / along for z in curve.controls]
    return all(abs(s.imag * along) <= 1e-9 * size and abs(s.real - 0.5) <= 0.5 + 1e-9 for s in shares)


def _bulge_of(start: complex, curve: Bezier) -> float:
    """Return the bulge of the arc that a cubic curve stands for; 0 if it stands for none.

    The control points of an arc are 4/3 tan(turn/4) of its radius from its ends, on the tangents. At a quarter turn,
    the curve is then 2.7e-4 of the radius off.
    """
    chord = curve.end - start
    if len(curve.controls) != 2 or not chord:
        return 0.0
    one, other = (curve.controls[0] - start) / chord, (curve.end - curve.controls[1]) / chord
    if not (one and other):
        return 0.0
    turn = cmath.phase(other / one)
    bulge = tan(turn / 4)
    expected = cmath.rect(1 / (3 * cos(turn / 4) ** 2), -turn / 2)
    off = max(abs(one - expected), abs(other - expected.conjugate()))
    return bulge if off <= ARC_OF_CUBIC * abs(bulge) / 2 and abs(turn) <= MAX_TURN_OF_CUBIC else 0.0


def _curve_corners(start: complex, curve: Bezier, size: float) -> list[complex]:
    """Return points of a curve between its ends, near enough to each other."""
    knots = [start, *curve.controls, curve.end]
    degree = len(knots) - 1
    bends = [abs(a - 2 * b + c) for a, b, c in zip(knots, knots[1:], knots[2:], strict=False)]
    count = _sides(degree * (degree - 1) * max(bends), size)
    s = np.arange(1, count) / count
    level = [np.full(len(s), z) for z in knots]
    while len(level) > 1:
        level = [a + (b - a) * s for a, b in pairwise(level)]
    corners: list[complex] = level[0].tolist()
    return corners
