"""The motions of both engines as films: that of free blocks has a picture that places its parts by time."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from rocking_cli.arrays import Bools, Points, Reals
from rocking_cli.core import Direction
from rocking_cli.short_repr import short_repr
from rocking_cli.structure import Structure
from rocking_cli.studies.both_engines import BothEngines
from rocking_cli.studies.engines.free import MOVED
from rocking_cli.studies.engines.free_blocks import FreeBlocks
from rocking_cli.studies.film import Film, Scene
from rocking_cli.studies.hung import End, TiePiece
from rocking_cli.studies.picture import DrawnPart, Picture, box_around, picture
from rocking_cli.studies.response import Response

NODE_INTERVAL = 0.02  # s between the positions of a page


@short_repr
@dataclass(frozen=True, kw_only=True)
class BlockPicture(Picture):
    """A drawing of free blocks, which are placed by time instead of rotation.

    Parameters
    ----------
    time : ndarray, shape (n,)
        Times of the samples [s].
    moved : ndarray, shape (n, parts, 3)
        Displacement of the centroid of each part [m], and its rotation, anticlockwise [rad].
    tones : mapping of Direction to tuple of int or None
        Shade of each part, that of the link with which it moves in the mechanism; None for a part at rest.
    """

    time: Reals
    moved: Reals
    tones: Mapping[Direction, tuple[int | None, ...]]

    def at(self, rotation: Reals) -> tuple[Points, Reals]:
        """Return the positions of the parts at some times, as `Picture.at` does at rotations."""
        k = np.clip(np.searchsorted(self.time, rotation) - 1, 0, self.time.size - 2)
        share = np.clip((rotation - self.time[k]) / (self.time[k + 1] - self.time[k]), 0.0, 1.0)[:, None, None]
        x, y, psi = np.moveaxis((1 - share) * self.moved[k] + share * self.moved[k + 1], (0, 1, 2), (2, 1, 0))
        return np.array([[part.centroid] for part in self.parts]) + x + 1j * y, psi

    @property
    def nodes(self) -> Reals:
        """The times at which a table has the positions of the parts, shape (n,) [s]."""
        every = max(1, round(NODE_INTERVAL / (self.time[1] - self.time[0])))
        return np.append(self.time[:-1:every], self.time[-1])

    @cached_property
    def grouped(self) -> Picture:
        """The drawing itself, as free blocks do not move together."""
        return self

    @cached_property
    def shades(self) -> Mapping[Direction, tuple[int | None, ...]]:
        """For each direction, the shade of each part."""
        return self.tones

    @cached_property
    def covered(self) -> tuple[complex, complex]:
        """Lower left and upper right corner of the area that the blocks cover on the ground [m]."""
        centroids, psi = self.at(self.time)
        outlines = [
            (middle + np.exp(1j * turn) * (each[:, None] - part.centroid)).ravel()
            for part, middle, turn in zip(self.parts, centroids, psi, strict=True)
            for each in part.outlines
        ]
        return box_around([np.array(self.reach), *outlines])

    def _slack(self, rotation: Reals) -> list[Bools]:
        """Return for each tie a mask of the times at which it is slack, by its elongation from rest."""
        centroids, psi = self.at(rotation)

        def place(end: End) -> Points | complex:
            if end.part is None:
                return end.point
            return np.asarray(
                centroids[end.part] + np.exp(1j * psi[end.part]) * (end.point - self.parts[end.part].centroid)
            )

        def elongation(piece: TiePiece) -> Reals:
            return np.asarray(np.abs(place(piece.end) - place(piece.start)) - abs(piece.end.point - piece.start.point))

        return [tie.slack_at(np.sum([elongation(piece) for piece in tie.pieces], axis=0)) for tie in self.ties]


@short_repr
@dataclass(frozen=True)
class BlockFilm(Film):
    """Motion of free blocks under a ground motion, for an animation to scale."""

    @property
    def enlargement(self) -> float:
        """The factor by which displacements are enlarged: 1, as those of free blocks are not those of one rotation."""
        return 1.0

    def rotation(self, time: Reals) -> Reals:
        """Return the signed rotation at some times, shape (n,) [rad]; 0 as long as soft contacts alone turn."""
        turned = super().rotation(time)
        return np.where(np.abs(self.ratio(turned)) < MOVED, 0.0, turned)

    def place(self, time: Reals) -> Reals:
        """Return the times at which the picture places its parts, shape (n,): those given."""
        return time

    def box(self, enlargement: float = 1.0) -> tuple[complex, complex]:
        """Return the corners of the area that the blocks cover on the ground [m]."""
        assert isinstance(self.picture, BlockPicture)
        return self.picture.covered


def scene_of(structure: Structure, response: Response) -> Scene:
    """Return the films of the first polarity, by one degree of freedom and by free blocks as far as there are both."""
    sign, motion, drawn = next(iter(response.runs)), response.first, picture(structure.mechanism)
    assert motion is not None
    exact = Film(drawn, response["nonlinear"], motion, response.assumed_friction(sign), "exact engine")
    if (both := response.engines.get(sign)) is None:
        return Scene((exact,))
    return Scene((exact, BlockFilm(_of_blocks(drawn, both), both.of_blocks, motion, called="free blocks")))


def _of_blocks(drawn: Picture, found: BothEngines) -> BlockPicture:
    """Return the drawing of a structure with its free blocks in place of the bodies of the mechanism."""
    free, mechanism = found.free, drawn.mechanism
    parts = tuple(
        DrawnPart(body.name, k, body.centroid, tuple(free.outlines[body.name]), assumed=False)
        for k, body in enumerate(free.bodies)
    )
    shade_of = {
        direction: {part.name: shade for part, shade in zip(drawn.parts, shades, strict=True)}
        for direction, shades in drawn.shades.items()
    }

    def moved(end: End) -> End:
        return end if end.part is None else end._replace(part=_block_at(drawn, drawn.parts[end.part], end.point, free))

    def with_blocks(piece: TiePiece) -> TiePiece:
        return piece._replace(start=moved(piece.start), end=moved(piece.end))

    loads = [(load, _block_at(drawn, drawn.parts[load.part], load.point, free)) for load in drawn.loads]
    return BlockPicture(
        mechanism, parts, (), drawn.phi_cr, drawn.limit, drawn.ground, drawn.sketch,
        tuple(replace(load, part=part) for load, part in loads if part is not None),
        tuple(replace(tie, pieces=tuple(map(with_blocks, tie.pieces))) for tie in drawn.ties),
        time=found.moved.time, moved=found.moved.moved,
        tones={
            direction: tuple(of.get(free.moves_with[part.name][0] or "") for part in parts)
            for direction, of in shade_of.items()
        },
    )  # fmt: skip


def _block_at(drawn: Picture, part: DrawnPart, point: complex, free: FreeBlocks) -> int | None:
    """Return the number of the block that carries a point of a part of the mechanism; None if it does not move."""
    names = [body.name for body in free.bodies]
    alike = [k for k, name in enumerate(names) if free.moves_with[name] == (part.name, part.shift)]
    if len(alike) == 1:
        return alike[0]
    piece = drawn.mechanism.piece_at(part.name, point - part.shift, drawn.mechanism.directions[0])
    return names.index(free.block_of[piece]) if piece in free.block_of else None
