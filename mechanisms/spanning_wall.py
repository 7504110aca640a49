"""A wall that spans between floors, with a load on top and a hinge whose height is found."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from math import sqrt
from typing import ClassVar, Literal, Self

from pydantic import model_validator

from mechanisms.wall import slider_crank, slider_crank_limit
from rocking_cli.core import (
    Attached,
    Body,
    Contact,
    Direction,
    Extra,
    Joint,
    Length,
    Mechanism,
    PointMass,
    Reals,
    RigidMotion,
    Sketch,
    Spot,
    box,
    geometry_error,
    length,
    of_joints,
    quantity,
)
from rocking_cli.core.contacts import MASONRY_FRICTION
from rocking_cli.core.fields import along_wall
from rocking_cli.core.reactions import at_uplift

WEAK_HINGE_DECREASE = 0.01  # relative decrease of lambda by the weakest hinge from which there is a caution
TOP_DISTANCE = 1e-9  # distance of a hinge that counts as at the top, over the height; zero loads, over the weight


class SpanningWall(Mechanism):
    """A one-way spanning wall that carries a floor, hinged at its foot and above, with its top held sideways."""

    mechanism: ClassVar[str] = "spanning_wall"
    title: ClassVar[str] = "wall spanning between floors, with a load on top"
    suits: ClassVar[str] = "wall between two floors, with the storeys above on top"
    source: ClassVar[str] = "DeJong and Dimitrakopoulos (2014), Section 4, for any hinge and a load on top"
    verified: ClassVar[str] = "lambda in closed form; Lagrange's equation in symbols; the wall without a load"

    starter: ClassVar[tuple[str, ...]] = ("overburden", "density", "depth")

    thickness: float = length("thickness", symbol="t", example=0.3)
    height: float = length("height between foot and top support", symbol="h", example=3.0)
    hinge: float | Literal["weakest"] = quantity(
        "height of the hinge over that of the wall, in (0, 1), or weakest: where lambda is least",
        symbol="xi",
        example="weakest",
    )
    overburden: float = quantity(
        "vertical load on top, such as a floor", unit="N", symbol="P", example=20_000.0, default=0.0, ge=0, le=1e12
    )
    overburden_eccentricity: float = quantity(
        "where it acts: distance from the axis of the wall, to the right", unit="m", symbol="x_P", example=0.0,
        default=0.0, ge=-1e6, le=1e6,
    )  # fmt: skip
    support: float | Literal["load", "pivot"] = quantity(
        "where the top is held sideways: at the load, above the face it pivots on (pivot), or a distance from the axis",
        unit="m",
        symbol="x_C",
        example="load",
        default="load",
    )
    overburden_inertia: float = quantity(
        "share of the mass P/g that moves up and down with the top", example=1.0, default=1.0, ge=0, le=1
    )
    depth: float | None = along_wall("length along the wall, `length` too; an overburden needs it")
    density: float | None = quantity(
        "density of the wall; an overburden needs it", unit="kg/m3", example=1800.0, default=None, gt=0, le=1e6
    )

    @model_validator(mode="after")
    def _fits(self) -> Self:
        if isinstance(self.hinge, float) and not 0 < self.hinge < 1:
            raise geometry_error("hinge", f"is a share of the height: between 0 and 1, or weakest; got {self.hinge:g}")
        if isinstance(self.support, float) and abs(self.support) > self.thickness / 2:
            raise geometry_error(
                "support",
                f"is outside the top of the wall: give at most {self.thickness / 2:g} m to either side of the axis",
            )
        if self.overburden > 0 and not self.has_mass:
            raise geometry_error("density", "is missing: with an overburden the wall needs density and depth, or mass")
        if self.hinge == "weakest" and self.crushing is not None:
            xi = self._hinges[self.directions[0]]
            raise geometry_error("hinge", f"weakest is that of pivots on the faces: with crushing give it, as {xi:.4g}")
        if self.hinge == "weakest" and self.is_laden:
            raise geometry_error("hinge", "weakest knows of the overburden only: with loads or ties give its height")
        for direction in self.directions:
            self._check_stands_alone(direction)
        return self

    def _check_stands_alone(self, direction: Direction) -> None:
        load, lever = self._load_ratio, self._lever(direction)
        if self.hinge == "weakest" and (load * lever <= 0 or 1 - self._hinges[direction] < TOP_DISTANCE):
            why = "without a load on top" if load < TOP_DISTANCE else "with its load on the hinge's face or beyond"
            raise geometry_error(
                "hinge",
                f"{why} the weakest hinge of the {direction.label} direction runs to the top: the whole wall turns "
                "about its foot, and spans no more. Give the height at which it hinges",
            )
        xi = self._hinges[direction]
        if 1 + load * (1 + lever * xi / (1 - xi)) <= 0:
            raise geometry_error(
                "overburden_eccentricity",
                f"the wall cannot stand: so far off its face the load opens the hinge of the {direction.label} "
                "direction by itself",
            )

    @property
    def _load_ratio(self) -> float:
        """rho, the load over the weight of the wall."""
        return self.overburden / (self.gravity * (self.total_mass() or 1.0)) if self.overburden else 0.0

    def _lever(self, direction: Direction) -> float:
        """Return k, the distance from the face of the hinge to the load, over the thickness."""
        return 0.5 + direction * self.overburden_eccentricity / self.thickness

    @cached_property
    def _hinges(self) -> dict[Direction, float]:
        """xi, the height of the hinge over that of the wall, for each direction."""
        if isinstance(self.hinge, float):
            return dict.fromkeys(Direction, self.hinge)
        return {direction: self._weakest(side) for direction, side in zip(Direction, self.sides, strict=True)}

    def _weakest(self, direction: Direction) -> float:
        """Return the xi of least lambda of a wall that carries its overburden alone; 1 if that is its top."""
        rho = self._load_ratio
        return 1 / (1 + sqrt(max(rho * self._lever(direction), 0.0) / (1 + rho)))

    def own_caution(self) -> str:
        return " ".join(filter(None, [self._of_the_top(), self._of_the_hinge()]))

    @property
    def _top_rubs(self) -> bool:
        """Whether only friction under the load holds the top."""
        return self.overburden > 0 and self.support == "load"

    def _of_the_top(self) -> str:
        """Return a caution if the file gives no friction and the top needs more than masonry usually has."""
        if self.friction is not None or not self._top_rubs:
            return ""
        needed = max(abs(at_uplift(self, each).force[-1, 0]) for each in self.directions) / self.overburden
        if needed <= MASONRY_FRICTION:
            return ""
        return (
            f"To rock, it needs a coefficient of friction of {needed:.3g} between the load and its top, more than the "
            f"{MASONRY_FRICTION:g} usual for masonry. Give `friction`, or where the top is anchored as `support`."
        )

    def _of_the_hinge(self) -> str:
        """Return a caution if lambda with the weakest hinge is lower by more than 1 % than with the given hinge."""
        if self.hinge == "weakest":
            return ""
        if self.is_laden or self.crushing is not None:
            return (
                "The weakest hinge is not searched with loads, ties, crossing walls or crushing: compute lambda with "
                "the hinge higher and lower as well."
            )
        inside: list[tuple[str, Direction]] = []
        above: list[tuple[str, Direction]] = []
        for direction in self.directions:
            rho, lever = self._load_ratio, self._lever(direction)
            xi, lambda_ = self._weakest(direction), self.uplift(direction)
            at_top = 1 - xi < TOP_DISTANCE
            opens = 0.0 if at_top else lever * xi / (1 - xi)
            least = (
                0.0
                if rho * lever < -TOP_DISTANCE
                else 2 * self.thickness / (xi * self.height) * (1 + rho * (1 + opens))
            )
            if least < (1 - WEAK_HINGE_DECREASE) * lambda_:
                lowers = f"lambda is {least:.4g} g instead of {lambda_:.4g} g"
                place = above if at_top else inside
                place.append((lowers if at_top else f"at {xi:.3g} of the height {lowers}", direction))
        sentences = [f"The hinge is not the weakest: {_by_direction(inside)}."] if inside else []
        if inside and all(1 - self._weakest(direction) >= TOP_DISTANCE for direction in self.directions):
            sentences.append("Give `hinge: weakest`, unless something fixes its height.")
        if above:
            sentences.append(
                f"The higher the hinge, the lower lambda: with the hinge near the top {_by_direction(above)}. Check at "
                "which height the wall hinges."
            )
        return " ".join(sentences)

    @cached_property
    def _cuts(self) -> list[float]:
        """Heights at which the wall is cut, from the foot to the top [m]."""
        return [0.0, *sorted({xi * self.height for xi in self._hinges.values()}), self.height]

    def hinges(self, direction: Direction) -> tuple[complex, complex, complex]:
        """Return the positions of the foot pivot A, the hinge B and the top support C at rest [m]."""
        face = direction * self.thickness / 2
        held = {"load": self.overburden_eccentricity, "pivot": face}
        x = self.support if isinstance(self.support, float) else held[self.support]
        a, b = (face - direction * self.inwards(direction, joint) for joint in ("foot", "hinge"))
        return a + 0j, complex(-b, self._hinges[direction] * self.height), complex(x, self.height)

    def bearing(self, direction: Direction) -> Mapping[str, float]:
        at = self._cuts.index(self.hinges(direction)[1].imag)
        above = [body.name for body in self.bodies()[at:]]
        return {"foot": self.borne(direction), "hinge": self.borne(direction, *above)}

    def volume(self) -> float:
        """Return the volume of the wall [m3], without its cuts, which may depend on its weight."""
        return self.thickness * self.height * self.given_depth

    def bodies(self) -> Sequence[Body]:
        cuts = self._cuts
        names = ["lower block", "middle block", "upper block"] if len(cuts) > 3 else ["lower block", "upper block"]
        return [
            box(name, (high - low) / self.height, self.thickness, high - low, 0.5j * (low + high))
            for name, low, high in zip(names, cuts, cuts[1:], strict=False)
        ]

    def motion(self, phi: Reals, direction: Direction) -> Sequence[RigidMotion]:
        a, b, c = self.hinges(direction)
        lower, upper = slider_crank(phi, direction, a, b, c)
        return [lower if high <= b.imag else upper for high in self._cuts[1:]]

    def limit(self, direction: Direction) -> float:
        return slider_crank_limit(direction, *self.hinges(direction))

    def carries(self) -> Sequence[Attached]:
        # The support that holds the top sideways also holds the floor, whose mass only moves vertically.
        if self.overburden == 0:
            return ()
        spot = Spot("upper block", complex(self.overburden_eccentricity, self.height))
        mass = self.overburden / self.gravity
        return (PointMass("overburden", spot, mass, horizontal=0.0, vertical=self.overburden_inertia),)

    def extras(self, direction: Direction) -> Sequence[Extra]:
        hinge = Extra("hinge", self._hinges[direction], "", "height of the hinge over that of the wall")
        if not self.has_mass:
            return (hinge,)
        force = abs(float(at_uplift(self, direction).force[-1, 0].real))  # of the last joint, C at the top
        return hinge, Extra("top_force", force, "N", "horizontal force at which its top is held as rocking starts")

    def joints(self, direction: Direction) -> Sequence[Joint]:
        a, b, c = self.hinges(direction)
        names, at = [body.name for body in self.bodies()], self._cuts.index(b.imag)
        return (
            Joint("A" + direction.prime, a, (names[0],)),
            Joint("B" + direction.prime, b, (names[at - 1], names[at]), face=names[at - 1]),
            Joint("C" + direction.prime, c, (names[-1],), slide=1j),
        )

    def contacts(self, direction: Direction) -> Sequence[Contact]:
        names, hinge = [body.name for body in self.bodies()], self.hinges(direction)[1].imag
        # The crack of the other direction stays closed.
        whole = [
            Contact((low, up), (1j * y,), held="fixed")
            for y, low, up in zip(self._cuts[1:], names, names[1:], strict=False)
            if y != hinge
        ]
        foot, crack, top = of_joints(self.joints(direction), self.friction)
        if self._top_rubs:
            name = "the load and the top of the wall"
            top = replace(top, pressed_by="overburden", friction=self.friction, name=name)
        return [foot, crack, top, *whole]

    def sketch(self) -> Sketch:
        t, top = self.thickness, 1j * self.height
        # A support beside the top of the wall, as that of a load beside it, is not drawn.
        hinges = {
            direction: [joint for joint in self.joints(direction) if abs(joint.point.real) <= t / 2]
            for direction in Direction
        }
        load = f"{self.overburden:g} N on top at x = {self.overburden_eccentricity:g} m"
        return Sketch(
            uniform=True,
            hinges=hinges,
            lengths=[Length("t", complex(-t / 2), complex(t / 2)), Length("h", complex(-t / 2), -t / 2 + top)],
            notes=[load] if self.overburden else [],
        )


def _by_direction(texts_of: Sequence[tuple[str, Direction]]) -> str:
    """Return texts with their directions; a text that both directions share is given once, without direction."""
    texts = {text for text, _ in texts_of}
    if len(texts) < len(texts_of):
        return texts_of[0][0]
    return " and ".join(f"{text} in the {direction.label} direction" for text, direction in texts_of)
