"""The circular masonry arch as a four-hinge mechanism [paper, Section 5.2; Oppenheim 1992]."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from itertools import pairwise
from math import ceil, degrees, floor, log10, pi, radians
from typing import ClassVar, Self

import numpy as np
from pydantic import model_validator

from mechanisms._arch_collapse import ArchCannotStand, Ring, collapse_hinges, least_thickness, thrust
from rocking_cli.core import (
    Angle,
    Body,
    Contact,
    Direction,
    Joint,
    Length,
    Line,
    Mechanism,
    Outline,
    Piece,
    Reals,
    RigidMotion,
    Sketch,
    Solid,
    annular_sector,
    four_bar,
    four_bar_limit,
    geometry_error,
    length,
    quantity,
    rotation,
)
from rocking_cli.core.coefficients import coefficients
from rocking_cli.errors import MechanismError

MAX_STRAIGHT_ARC = radians(1.0)  # longest arc that is drawn straight
RING_CUTS = 40  # possible cuts of a ring without voussoirs, beside its hinges
MIN_CUT_ANGLE = 0.25  # least angle of a cut from a hinge, over the angle between two cuts
MAX_DRAWN_VOUSSOIRS = 200


class Arch(Mechanism):
    """A ring of constant thickness on fixed springings, with the hinges of the least ground acceleration."""

    mechanism: ClassVar[str] = "arch"
    title: ClassVar[str] = "circular masonry arch, four hinges"
    suits: ClassVar[str] = "masonry arch or vault strip on fixed springings"
    source: ClassVar[str] = "DeJong and Dimitrakopoulos (2014), Section 5.2; Oppenheim (1992)"
    verified: ClassVar[str] = "static theorem (linear programme of the line of thrust); Oppenheim's arch, lambda = 0.37"

    radius: float = length("radius of the centre line", symbol="r", example=10.0)
    thickness: float = length("thickness of the ring", symbol="t", example=1.5)
    inclusion_angle_deg: float = quantity(
        "angle between the springings", unit="deg", symbol="beta", example=157.5, gt=0, le=180
    )
    voussoirs: int | None = quantity(
        "number of equal voussoirs, whose joints may open; absent: hinges anywhere",
        symbol="n",
        example=7,
        default=None,
        ge=3,
        le=10_000,
    )

    @model_validator(mode="after")
    def _rocks(self) -> Self:
        if self.thickness >= 2 * self.radius:
            raise geometry_error(
                "thickness", f"the ring has no intrados: thickness must be less than {2 * self.radius:g} m"
            )
        try:
            self.hinge_angles  # noqa: B018 - found once, here, so that a structure that exists can rock
        except ArchCannotStand:
            least = least_thickness(self._beta, self.voussoirs) * self.radius
            raise geometry_error(
                "thickness",
                f"too thin to stand under its own weight (t/r = {self.thickness / self.radius:.4g}): "
                f"the arch needs at least {_round_up(least, 6):.6g} m (t/r = {_round_up(least / self.radius, 4):.4g})",
            ) from None
        except MechanismError as error:
            raise geometry_error("thickness", str(error)) from None
        return self

    @property
    def _beta(self) -> float:
        return radians(self.inclusion_angle_deg)

    @cached_property
    def hinge_angles(self) -> tuple[float, float, float, float]:
        """Angles of A, B, C and D from the left springing (positive direction) or the right one (negative) [rad]."""
        return collapse_hinges(Ring(self.thickness / self.radius, self._beta), self.voussoirs)

    def hinges(self, direction: Direction) -> tuple[complex, complex, complex, complex]:
        """Return the positions of A, B, C and D at rest [m]; the centre of the ring is the origin."""
        half = self.thickness / 2
        radii = (self.radius - half, self.radius + half) * 2  # intrados, extrados, intrados, extrados
        a, b, c, d = (
            complex(radius * np.exp(1j * (pi / 2 + direction * (self._beta / 2 - angle))))
            for radius, angle in zip(radii, self.hinge_angles, strict=True)
        )
        return a, b, c, d

    @cached_property
    def _cuts(self) -> tuple[float, ...]:
        # Bodies must be rigid in both directions: the ring is cut at the hinges of both.
        mirrored = [self._beta - angle for angle in self.hinge_angles]
        cuts = sorted({*self.hinge_angles, *mirrored})
        # A cut that is its own mirror image (up to rounding) is one cut, not a sliver between two.
        return tuple(cut for k, cut in enumerate(cuts) if k == 0 or cut - cuts[k - 1] > 1e-12)

    def bodies(self) -> Sequence[Body]:
        half = self.thickness / 2
        inner, outer = self.radius - half, self.radius + half
        density = 2 / (self._beta * (outer**2 - inner**2))  # 1 kg for the whole ring
        springing = pi / 2 + self._beta / 2
        return tuple(
            annular_sector(f"segment {k + 1}", density, inner, outer, springing - start, springing - end)
            for k, (start, end) in enumerate(pairwise(self._cuts))
        )

    def volume(self) -> float:
        """Return the volume between the outer hinges [m3], as the outlines are drawn with straight sides."""
        return (self._cuts[-1] - self._cuts[0]) * self.radius * self.thickness * self.given_depth

    def solids(self) -> Mapping[str, Sequence[Solid]]:
        if self.density is None or self.mass is not None:
            return {}
        inner, outer = self.radius - self.thickness / 2, self.radius + self.thickness / 2
        return {
            f"segment {k}": [Solid("sector", (inner, outer, end - start), self.density, self.given_depth)]
            for k, (start, end) in enumerate(pairwise(self._cuts), 1)
        }

    def motion(self, phi: Reals, direction: Direction) -> Sequence[RigidMotion]:
        hinges = self.hinges(direction)
        links = (rotation(phi, hinges[0], 0.0), *four_bar(phi, direction, *hinges), rotation(phi, hinges[3], 0.0))
        middles = (np.array(self._cuts[:-1]) + np.array(self._cuts[1:])) / 2
        along = middles if direction > 0 else self._beta - middles
        return tuple(links[k] for k in np.searchsorted(self.hinge_angles, along))

    def joints(self, direction: Direction) -> Sequence[Joint]:
        """Return the hinges with the segments on either side, or the ground, and the face of the lower segment."""
        cuts, joints = np.array(self._cuts), []
        for letter, point, angle in zip("ABCD", self.hinges(direction), self.hinge_angles, strict=True):
            cut = int(np.abs(cuts - (angle if direction > 0 else self._beta - angle)).argmin())
            sides = [f"segment {k}" for k in (cut, cut + 1) if 0 < k < len(cuts)]
            # The supporting segment comes first: the one nearer to the springing of its half of the ring.
            on_the_left = cuts[cut] <= self._beta / 2
            bodies = tuple(sides if on_the_left else sides[::-1])
            normal = point / abs(point) * (-1j if on_the_left else 1j)  # unit normal of the joint, along the ring
            joints.append(
                Joint(
                    letter + direction.prime, point, bodies, normal=normal, face=bodies[0] if len(bodies) > 1 else None
                )
            )
        return joints

    @cached_property
    def _joint_angles(self) -> Sequence[float]:
        """Angles of the joints from the left springing [rad]: those between voussoirs, or possible cuts."""
        even = np.linspace(0.0, self._beta, (self.voussoirs or RING_CUTS) + 1)
        hinges = np.array(self._cuts)
        apart = np.abs(even[:, None] - hinges).min(axis=1) > MIN_CUT_ANGLE * self._beta / (len(even) - 1)
        return sorted([*even[apart], *hinges])

    @property
    def _part(self) -> str:
        """Word for one piece of the arch."""
        return "voussoir" if self.voussoirs else "piece"

    def pieces(self, direction: Direction) -> Sequence[Piece]:
        """Return the voussoirs, or the pieces between cuts; those beyond the outer hinges are at rest."""
        half, springing = self.thickness / 2, pi / 2 + self._beta / 2
        bodies, pieces = self.weighed(), []
        density = bodies[0].mass / (self._cuts[1] - self._cuts[0])  # mass per angle of the ring
        inner, outer = self.radius - half, self.radius + half
        per_area = 2 * density / (outer**2 - inner**2)
        for k, (start, end) in enumerate(pairwise(self._joint_angles)):
            at = int(np.searchsorted(self._cuts, (start + end) / 2))
            of = bodies[at - 1].name if 0 < at < len(self._cuts) else None
            piece = annular_sector(f"{self._part} {k + 1}", per_area, inner, outer, springing - start, springing - end)
            pieces.append(Piece(replace(piece, outline=self._sector(start, end)), of))
        return pieces

    def piece_at(self, body: str, at: complex, direction: Direction) -> str:
        number = next(k for k, each in enumerate(self.bodies()) if each.name == body)
        start, end = self._cuts[number : number + 2]
        angle = float(np.clip(self._beta / 2 - np.angle(-1j * at), start + 1e-12, end - 1e-12))
        return f"{self._part} {int(np.searchsorted(self._joint_angles, angle))}"

    def contacts(self, direction: Direction) -> Sequence[Contact]:
        half, angles = self.thickness / 2, self._joint_angles
        names: list[str | None] = [None, *(f"{self._part} {k}" for k in range(1, len(angles))), None]
        hinges = zip(self.hinges(direction), self.hinge_angles, strict=True)
        hinged = {
            int(np.abs(np.array(angles) - (a if direction > 0 else self._beta - a)).argmin()): z for z, a in hinges
        }
        contacts = []
        for k, angle in enumerate(angles):
            out = complex(np.exp(1j * (pi / 2 + self._beta / 2 - angle)))
            ends = (hinged[k],) if k in hinged else ((self.radius - half) * out, (self.radius + half) * out)
            # The supporting piece comes first: the one nearer to the springing of its half of the ring.
            on_the_left = angle <= self._beta / 2
            pair = (names[k], names[k + 1]) if on_the_left else (names[k + 1], names[k])
            contacts.append(Contact(pair, ends, out * (-1j if on_the_left else 1j), pair[0], self.friction))
        return contacts

    def limit(self, direction: Direction) -> float:
        return four_bar_limit(direction, *self.hinges(direction))

    def sketch(self) -> Sketch:
        names = [body.name for body in self.bodies()]
        r, half = self.radius, self.thickness / 2
        springing = np.exp(1j * (pi + self._beta) / 2)  # left springing; the right one is its mirror image
        joints = np.linspace(0.0, self._beta, (self.voussoirs or MAX_DRAWN_VOUSSOIRS) + 1)
        parted = joints if self.voussoirs is not None and self.voussoirs <= MAX_DRAWN_VOUSSOIRS else joints[[0, -1]]
        outlines = {}
        for name, (start, end) in zip(names, pairwise(self._cuts), strict=True):
            edges = [start, *parted[(parted > start + 1e-9) & (parted < end - 1e-9)], end]
            outlines[name] = [self._sector(*each) for each in pairwise(edges)]
        inner, outer = complex((r - half) * springing), complex((r + half) * springing)
        beyond = outer + (outer - inner)
        links = self._links()
        _, b, c, _ = self.hinge_angles
        # Position of a label, between a centroid and a hinge.
        across = complex(np.exp(1j * ((pi + self._beta) / 2 - b - 0.78 * (c - b))))
        at = ", ".join(f"{round(degrees(angle), 1):g}°" for angle in self.hinge_angles)
        return Sketch(
            outlines=outlines,
            uniform=True,
            hinges={direction: self.joints(direction) for direction in Direction},
            lengths=[
                Length("r", 0j, complex(r * springing * np.exp(-0.3j * self._beta))),
                Length("t", (r - half) * across, (r + half) * across),
                *(
                    Length(f"r_{link}", hinge, centroid, Direction.POSITIVE, derived=True)
                    for link, hinge, _, centroid in links
                ),
            ],
            angles=[
                Angle("β", 0j, complex(r * springing), -complex(r * springing).conjugate()),
                Angle("φ₀", links[0][1], links[0][1] + r, links[0][2], Direction.POSITIVE),
                *(
                    Angle(f"ψ_{link}", hinge, other, centroid, Direction.POSITIVE)
                    for link, hinge, other, centroid in links
                ),
            ],
            lines=[self._thrust_line(direction) for direction in Direction],
            # The ground lies under the springings, which are walked along from left to right.
            ground=[(beyond, 2 * inner - outer), (-(2 * inner - outer).conjugate(), -beyond.conjugate())],
            notes=[
                f"A, B, C, D at {at} from the left springing, A', B', C', D' as far from the right one",
                *(
                    ["joints of the voussoirs: too many to be drawn"]
                    if len(parted) < len(joints) - 1 and self.voussoirs
                    else []
                ),
            ],
        )

    def _sector(self, start: float, end: float) -> Outline:
        """Return the outline of the ring between two angles from the left springing."""
        half = self.thickness / 2
        turns = np.exp(
            1j * ((pi + self._beta) / 2 - np.linspace(start, end, max(2, ceil((end - start) / MAX_STRAIGHT_ARC) + 1)))
        )
        return [*((self.radius + half) * turns).tolist(), *((self.radius - half) * turns[::-1]).tolist()]

    def _links(self) -> list[tuple[str, complex, complex, complex]]:
        """Return each link of the positive direction: name, reference hinge, hinge at its other end, centroid."""
        A, B, C, D = self.hinges(Direction.POSITIVE)
        half = self.thickness / 2
        springing = (pi + self._beta) / 2
        ends = zip(("AB", "BC", "CD"), (A, B, D), (B, C, C), pairwise(self.hinge_angles), strict=True)
        return [
            (
                name,
                hinge,
                other,
                annular_sector(
                    name, 1.0, self.radius - half, self.radius + half, springing - a, springing - b
                ).centroid,
            )
            for name, hinge, other, (a, b) in ends
        ]

    def _thrust_line(self, direction: Direction) -> Line:
        ring = Ring(self.thickness / self.radius, self._beta)
        # Evaluate the line at the joints of voussoirs, or along the whole ring if there are none.
        angles = np.linspace(0.0, self._beta, (self.voussoirs or MAX_DRAWN_VOUSSOIRS) + 1)
        angles = np.unique([*angles, *self.hinge_angles])
        points = ring.thrust_radius(angles, thrust(ring, self.hinge_angles)) * self.radius
        along = points * np.exp(1j * (pi / 2 + direction * (self._beta / 2 - angles)))
        rest = np.zeros(1)
        bare = coefficients(rest, direction, self.bodies(), self.motion(rest, direction))  # without loads and ties
        without = ", without loads and ties" if self.loads or self.ties else ""
        name = f"line of thrust at uplift, {bare.G[0] / bare.B[0]:.3g} g{without}"
        return Line(name, along.tolist(), direction)


def _round_up(value: float, digits: int) -> float:
    """Return a positive number rounded up to some digits, so that a value recommended by an error is accepted."""
    unit = 10.0 ** (floor(log10(value)) - digits + 1)
    return ceil(value / unit) * unit
