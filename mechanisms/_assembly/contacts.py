"""Joints of an assembly: the common parts of the edges of its blocks.

A gap is measured relative to the smaller of the two blocks, so that the joints do not depend on the unit of the
drawing, and blocks of a large building are not joined across an open gap. The ground may have any size.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from mechanisms._assembly.blocks import AssemblyBlock, AssemblyContact, ContactFault, listed
from mechanisms._assembly.programme import components
from rocking_cli.core import Reals
from rocking_cli.core.kinematics import Points, distance, inside
from rocking_cli.core.polygons import nearby, overlap, size_of, thickness_of

MAX_GAP = 2e-3  # largest gap of a joint over width plus height of the smaller block: 2 mm for 0.5 m x 0.5 m
MAX_SINE = 0.05  # sine of the largest angle between two edges in contact
ZERO_UPWARD = 1e-6  # upward components of normals below this count as zero
SAME_DIRECTION = 1e-5  # angle between joints up to which they are parallel
SAME_PLACE = 1e-6  # distance of lines, and of points, that are the same, over the size of the assembly
ROUNDING = 1e-12  # distance that is no misfit, over the size of the assembly
PARALLEL = 1e-2  # share of the squares of two directions below which they are one

Gap = Callable[[str, str], float]
Piece = tuple[complex, complex]  # start and end; seen from the start, the second body is on the left


def contacts(
    blocks: Sequence[AssemblyBlock],
    ground: Sequence[AssemblyBlock],
    *,
    gap: float = MAX_GAP,
    within: float | None = None,
    friction: float | None = None,
    per_pair: Mapping[tuple[str, str], float | None] | None = None,
) -> list[AssemblyContact]:
    """Return all joints of an assembly.

    Parameters
    ----------
    blocks : sequence of AssemblyBlock
        Blocks that can move.
    ground : sequence of AssemblyBlock
        Parts of the ground, which do not move and may overlap each other.
    gap : float
        Largest distance of edges in contact, over the sum of width and height of the smaller block.
    within : float, optional
        Largest distance of edges in contact for all blocks [m], instead of `gap`.
    friction : float, optional
        Coefficient of friction of every joint; None if no joint slides.
    per_pair : mapping, optional
        Coefficient of friction of the joints of two bodies, named in either order.

    Returns
    -------
    list of AssemblyContact
        Joints in the order of the bodies, the ground last. Collinear parts between the same two bodies are one joint,
        from the first end to the last; a single corner on an edge is not a joint.

    Raises
    ------
    ContactFault
        If names are used twice, blocks overlap, touch nothing or are thinner than the gap, or `per_pair` names two that
        do not touch.
    """
    bodies = [*blocks, *ground]
    names = [body.name for body in bodies]
    twice = sorted(name for name, count in Counter(names).items() if count > 1)
    if twice:
        raise ContactFault(f"more than one body is called {listed(twice)}", twice)
    outlines = [body.outline for body in bodies]
    sizes = [size_of(z) if k < len(blocks) else np.inf for k, z in enumerate(outlines)]
    joints: list[AssemblyContact] = []
    reach = np.array(
        [0.0 if k >= len(blocks) else gap * size if within is None else within for k, size in enumerate(sizes)]
    )
    thick = {block.name: thickness_of(z) for block, z in zip(blocks, outlines, strict=False)}
    for block, tolerance in zip(blocks, reach.tolist(), strict=False):  # tolerance: largest gap of a joint
        if thick[block.name] <= tolerance:
            raise _thin(block.name, thick[block.name], tolerance)
    for i, j in _near(outlines, reach):
        if i >= len(blocks):
            continue  # parts of the ground have no joint with each other
        tolerance = gap * min(sizes[i], sizes[j]) if within is None else within
        if overlap(outlines[i], outlines[j], tolerance):
            raise ContactFault(f"{listed([names[i], names[j]])} overlap", (names[i], names[j]))
        for start, end in _merged(_pieces(outlines[i], outlines[j], tolerance), tolerance):
            normal = 1j * (end - start) / abs(end - start)
            joint = AssemblyContact(names[i], names[j], start, end, normal, friction)
            joint = replace(joint, faces=_faces(joint, outlines[i], outlines[j], tolerance))
            bears = j >= len(blocks) or normal.imag < -ZERO_UPWARD  # whether j supports i: it is ground, or below i
            joints.append(joint.turned() if bears else joint)
    _all_touch(blocks, joints)
    joints = _fitted(joints, within)
    size = dict(zip(names, sizes, strict=True))
    _none_bridged(
        joints,
        dict(zip(names, outlines, strict=True)),
        thick,
        lambda one, other: gap * min(size[one], size[other]) if within is None else within,
    )
    return _with_friction(joints, per_pair or {})


def _fitted(joints: list[AssemblyContact], within: float | None) -> list[AssemblyContact]:
    """Put joints that lie on one line exactly on it, and their ends that meet on one point, up to rounding or `within`.

    Joints that never slide would jam otherwise: those of one line open together only if they lie on it exactly.
    """
    drawn = np.array([joint.ends for joint in joints])
    lengths = np.abs(drawn[:, 1] - drawn[:, 0])
    along, size, ends = (drawn[:, 1] - drawn[:, 0]) / lengths, size_of(drawn.ravel()), drawn.copy()
    normal = 1j * along
    close, turn = (SAME_PLACE * size, SAME_DIRECTION) if within is None else (within, within / np.median(lengths))
    for parallel in _runs(np.angle(along**2 * np.exp(-0.5j)) / 2, turn):
        way = np.sqrt((along[parallel] ** 2).sum())
        way /= abs(way)
        for line in _runs((drawn[parallel].mean(axis=1) / way).imag, close):
            of = parallel[line]
            places = drawn[of] / way
            places = (places.real + 1j * places.imag.mean()) * way
            if np.abs(places - drawn[of]).max() <= close:
                ends[of], normal[of] = places, 1j * way * np.sign((along[of] / way).real)
    z, across, reach = ends.ravel(), np.repeat(normal, 2), close * (1 + 1j) / 2
    one, other = np.concatenate([np.zeros((2, 0), np.intp), *map(np.array, nearby(z - reach, z + reach))], axis=1)
    if max(np.abs(ends - drawn).max(), np.abs(z[one] - z[other]).max(initial=0.0)) <= ROUNDING * size:
        return joints
    at = components(one, other, len(z))
    middle = (np.bincount(at, z.real) + 1j * np.bincount(at, z.imag)) / np.bincount(at)
    # The point nearest to the middle that is on the lines of all ends which meet there.
    rows = np.stack([across.real, across.imag], axis=1)
    squares, away = np.zeros((len(middle), 2, 2)), np.zeros((len(middle), 2))
    np.add.at(squares, at, rows[:, :, None] * rows[:, None, :])
    np.add.at(away, at, rows * ((z - middle[at]).conj() * across).real[:, None])
    shift = np.einsum("kij,kj->ki", np.linalg.pinv(squares, PARALLEL, hermitian=True), away)
    ends = (middle + shift @ [1, 1j])[at].reshape(-1, 2)
    moved = np.abs(ends - drawn).max(axis=1) > ROUNDING * size
    return [
        replace(joint, start=complex(start), end=complex(end), normal=complex(to)) if moves else joint
        for joint, (start, end), to, moves in zip(joints, ends, normal, moved, strict=True)
    ]


def _runs(values: Reals, most: float) -> list[NDArray[np.intp]]:
    """Return the indices of values that differ from the next smaller one by `most` at the most, run by run."""
    order = np.argsort(values)
    return np.split(order, np.flatnonzero(np.diff(values[order]) > most) + 1)


def _none_bridged(
    joints: Sequence[AssemblyContact], bodies: Mapping[str, Points], thick: Mapping[str, float], gap: Gap
) -> None:
    """Raise `ContactFault` if two neighbours of a block are joined across the block."""
    touch: dict[str, set[str]] = {name: set() for name in bodies}
    for joint in joints:
        touch[joint.a].add(joint.b)
        touch[joint.b].add(joint.a)
    for joint in joints:
        tolerance = gap(joint.a, joint.b)
        for name in sorted(touch[joint.a] & touch[joint.b]):
            if thick.get(name, np.inf) <= tolerance:
                along = np.asarray(np.linspace(joint.start, joint.end, 11)[1:-1], np.complex128)
                if inside(along, bodies[name]).any():
                    raise _thin(name, thick[name], tolerance)


def _thin(name: str, thick: float, tolerance: float) -> ContactFault:
    why = f"{name!r} is {thick:.2g} m thick, no more than the gap across which faces touch, {tolerance:.2g} m"
    return ContactFault(f"{why}: give a smaller `gap`, or leave it out", (name,))


def _near(outlines: Sequence[Points], reach: Reals) -> list[tuple[int, int]]:
    """Return the pairs of outlines whose boxes, enlarged by the largest distance in contact, overlap."""
    around = reach * (1 + 1j)
    low = np.array([complex(z.real.min(), z.imag.min()) for z in outlines]) - around
    high = np.array([complex(z.real.max(), z.imag.max()) for z in outlines]) + around
    pairs: list[tuple[int, int]] = []
    for one, other in nearby(low, high):
        pairs += zip(np.minimum(one, other).tolist(), np.maximum(one, other).tolist(), strict=True)
    return sorted(pairs)


def _pieces(one: Points, other: Points, tolerance: float) -> list[Piece]:
    """Return the common parts of the edges of two outlines, halfway between the edges."""
    da, db = np.roll(one, -1) - one, np.roll(other, -1) - other
    ua, ub = da / np.abs(da), db / np.abs(db)
    product = ua.conj()[:, None] * ub
    i, j = np.nonzero((product.real < 0) & (np.abs(product.imag) <= MAX_SINE))
    if i.size == 0:
        return []
    a, b, da, db = one[i], other[j], da[i], db[j]
    t = (db - da) / np.abs(db - da)  # mean direction of both edges, weighted by length
    # An edge of one outline runs against t, one of the other with it.
    a0, a1 = (t.conj() * a).real, (t.conj() * (a + da)).real
    b0, b1 = (t.conj() * b).real, (t.conj() * (b + db)).real
    low, high = np.maximum(a1, b0), np.minimum(a0, b1)
    start_a, end_a = (a + (low - a0) / (a1 - a0) * da, a + (high - a0) / (a1 - a0) * da)
    start_b, end_b = (b + (low - b0) / (b1 - b0) * db, b + (high - b0) / (b1 - b0) * db)
    touch = (high - low > tolerance) & (np.abs(start_a - start_b) <= tolerance) & (np.abs(end_a - end_b) <= tolerance)
    starts, ends = (start_a + start_b) / 2, (end_a + end_b) / 2
    return [(complex(s), complex(e)) for s, e in zip(starts[touch], ends[touch], strict=True)]


def _merged(pieces: list[Piece], tolerance: float) -> list[Piece]:
    """Return the common parts of two outlines, with collinear ones merged into one.

    The merged part reaches from the first end to the last, because rigid bodies bear at both ends.
    """
    joined: dict[int, Piece] = {}
    # Start with the longest piece, which defines the line best; return the pieces in the order of the edges.
    for n, piece in sorted(enumerate(pieces), key=lambda p: -abs(p[1][1] - p[1][0])):
        for k, other in joined.items():
            along = (other[1] - other[0]) / abs(other[1] - other[0])
            ends = [*piece, *other]
            places = [(z - other[0]) * along.conjugate() for z in ends]
            same_way = ((piece[1] - piece[0]) * along.conjugate()).real > 0
            if same_way and max(abs(z.imag) for z in places) <= tolerance:
                order = np.argsort([z.real for z in places])
                joined[k] = ends[order[0]], ends[order[-1]]
                break
        else:
            joined[n] = piece
    return [joined[n] for n in sorted(joined)]


def _faces(joint: AssemblyContact, one: Points, other: Points, tolerance: float) -> tuple[str, str]:
    """Return for each end the body whose face continues beyond it; empty if both or neither do."""
    along = 3 * tolerance * (joint.end - joint.start) / joint.length
    beyond = np.array([joint.start - along, joint.end + along])
    on = [distance(beyond, z) <= tolerance for z in (one, other)]
    first, last = (("" if a == b else joint.a if a else joint.b) for a, b in zip(*on, strict=True))
    return first, last


def _all_touch(blocks: Sequence[AssemblyBlock], joints: Sequence[AssemblyContact]) -> None:
    touched = {name for joint in joints for name in (joint.a, joint.b)}
    loose = [block.name for block in blocks if block.name not in touched]
    if loose:
        verb = "touches" if len(loose) == 1 else "touch"
        raise ContactFault(
            f"{listed(loose)} {verb} nothing along an edge: a corner on an edge does not count as a joint", loose
        )


def _with_friction(
    joints: list[AssemblyContact], per_pair: Mapping[tuple[str, str], float | None]
) -> list[AssemblyContact]:
    friction_of = {frozenset(pair): value for pair, value in per_pair.items()}
    touch = {frozenset((c.a, c.b)) for c in joints}
    missing = [pair for pair in per_pair if frozenset(pair) not in touch]
    if missing:
        raise ContactFault(f"{listed(missing[0])} have no joint that could be given a friction", missing[0])
    return [replace(c, friction=friction_of.get(frozenset((c.a, c.b)), c.friction)) for c in joints]
