"""Attach a user's loads and ties to the bodies of a structure, after checking them against these bodies."""

from __future__ import annotations

from collections.abc import Callable, Collection, Container, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np
from pydantic import ValidationError
from pydantic_core import InitErrorDetails, PydanticCustomError

from rocking_cli.core.bodies import Body
from rocking_cli.core.coefficients import Coefficients
from rocking_cli.core.fields import geometry_error
from rocking_cli.core.hung.attached import Attached, Follow, Path, PointMass, Spot
from rocking_cli.core.hung.element import (
    NO_ANSWER,
    ConstantForce,
    Element,
    Interlock,
    Load,
    Question,
    SteelBar,
    Stretched,
)
from rocking_cli.core.hung.ties import Tie
from rocking_cli.core.kinematics import Direction, Points, Reals, RigidMotion, distance, inside
from rocking_cli.core.sketch import Outline
from rocking_cli.errors import InputError, Problem
from rocking_cli.short_repr import short_repr
from rocking_cli.text import did_you_mean

OUTSIDE_DISTANCE = 1e-6  # largest distance at which a point counts as on a body, over the size of the body
OWN_NAMES = ("top", "centroid")  # names of points of the structure itself in results

Loc = tuple[str | int, ...]


class RefusedFields(PydanticCustomError):
    """Error of fields that do not fit together: `field` within the place `loc`; see `as_validation_error`.

    A validator may raise it, as it may `geometry_error`; it does not count as an error of the plugin.
    """

    def __new__(cls, loc: Loc, field: str, reason: str) -> RefusedFields:
        """Make the error with braces in its message escaped, which pydantic would format."""
        return super().__new__(cls, "geometry", "{reason}", {"reason": reason, "field": (*loc, field)})

    def __init__(self, loc: Loc, field: str, reason: str) -> None:
        self.loc, self.field, self.reason = loc, field, reason

    @classmethod
    def first_of(cls, error: ValidationError) -> RefusedFields:
        """Return the first error of the validation of another structure with the same fields."""
        first = error.errors(include_url=False)[0]
        *loc, field = (*first["loc"], *first.get("ctx", {}).get("field", ())) or ("mechanism",)
        return cls(tuple(loc), str(field), first["msg"])


def as_validation_error(refused: Sequence[RefusedFields], title: str) -> ValidationError:
    """Return a pydantic `ValidationError` that has each refusal at its field."""
    return ValidationError.from_exception_data(
        title,
        [InitErrorDetails(type=geometry_error(one.field, one.reason), loc=one.loc, input=None) for one in refused],
    )


@short_repr
@dataclass(frozen=True)
class Carrier:
    """Bodies of a mechanism to which loads and ties may be attached.

    Parameters
    ----------
    bodies : mapping of str to Body
        The bodies by name.
    outlines : mapping of str to sequence of Outline
        Outlines of the bodies whose shape is known.
    alike : mapping of str to int
        Number of identical bodies that one body represents, for bodies that represent several.
    piece : callable
        Function that returns the piece of a cracked body on which a point lies.
    depth : float, optional
        Size of the structure out of plane [m].
    """

    bodies: Mapping[str, Body]
    outlines: Mapping[str, Sequence[Outline]]
    alike: Mapping[str, int]
    piece: Callable[[str, complex], str]
    depth: float | None = None

    def body(self, name: str | None, loc: Loc) -> str:
        """Return the body that a load or tie refers to. Raises `RefusedFields`."""
        known = ", ".join(self.bodies)
        if name is None:
            if len(self.bodies) > 1:
                raise RefusedFields(loc, "body", f"is missing: say which body, of {known}")
            return next(iter(self.bodies))
        if name not in self.bodies:
            guess = did_you_mean(name, list(self.bodies))
            raise RefusedFields(loc, "body", f"there is no body {name!r}: {guess or f'known: {known}'}")
        return name

    def spot(self, name: str | None, point: complex, loc: Loc, field: str) -> Spot:
        """Return a point of a body. Raises `RefusedFields` if the point lies outside the body."""
        body = self.carrying(name, point, loc)
        shapes = self.outlines.get(body, ())
        at = np.array([point])
        if shapes and not any(_holds(np.asarray(shape), at) for shape in shapes):
            corners = np.concatenate([np.asarray(shape) for shape in shapes])
            low, high = corners.real.min(), corners.real.max()
            bottom, top = corners.imag.min(), corners.imag.max()
            raise RefusedFields(
                loc,
                field,
                f"[{point.real:g}, {point.imag:g}] lies outside {body}, whose corners are from x = {low:.4g} to "
                f"{high:.4g} m and from y = {bottom:.4g} to {top:.4g} m: coordinates are those of `rocking draw`",
            )
        return Spot(body, point)

    def carrying(self, name: str | None, point: complex, loc: Loc) -> str:
        """Return the body, or the piece of it, that carries a point. Raises `RefusedFields`."""
        return self.body(name if name is None else self.piece(name, point), loc)

    def off(self, body: str, point: complex) -> float:
        """Return the distance of a point from a body, over the size of the body; 0 if its shape is not known."""
        shapes = [np.asarray(shape) for shape in self.outlines.get(body, ())]
        at = np.array([point])
        if not shapes or any(_holds(shape, at) for shape in shapes):
            return 0.0
        corners = np.concatenate(shapes)
        size = abs(complex(np.ptp(corners.real), np.ptp(corners.imag)))
        return min(float(distance(at, shape)[0]) for shape in shapes) / size

    def foot(self, name: str | None, loc: Loc) -> Spot:
        """Return the point below the centroid of a body, at the height of its lowest corner. Raises `RefusedFields`."""
        body = self.body(name, loc)
        centroid = self.bodies[body].centroid
        lowest = min((float(np.asarray(shape).imag.min()) for shape in self.outlines.get(body, ())), default=0.0)
        return Spot(body, complex(centroid.real, lowest))

    def count(self, body: str, *, each: bool) -> int:
        """Return how many identical items a load or tie on a body represents."""
        return self.alike.get(body, 1) if each else 1


def attach(
    carrier: Carrier, loads: Sequence[Load], ties: Sequence[Tie], taken: Collection[str] = ()
) -> Iterator[tuple[Loc, Attached]]:
    """Yield the terms of loads and ties in the equation of motion, each with its place among the fields.

    Raises `RefusedFields`, also if a name is used twice or is in `taken`.
    """
    reserved, names = {*OWN_NAMES, *taken}, set[str]()
    for k, load in enumerate(loads):
        loc: Loc = ("loads", k)
        _own_name(load.name, names, reserved, loc)
        body = carrier.carrying(load.body, complex(*load.at), loc)  # a load may lie outside its body
        if (whole := load.whole(carrier.depth)) is None:
            key = "force" if load.is_force else "mass"
            reason = f"is per metre of wall: give the `depth` of the structure over which it acts, or the whole {key}"
            raise RefusedFields(loc, key, reason)
        yield loc, load.attached(body, whole, carrier.count(body, each=load.each))
    for k, tie in enumerate(ties):
        loc = ("ties", k)
        _own_name(tie.name, names, reserved, loc)
        spots = list(_spots(carrier, tie, loc))
        bodies = [spot.body for spot in spots if spot.body is not None]
        if not bodies:
            raise RefusedFields(loc, "from", "both ends are on the ground, so no motion stretches it")
        if tie.diameter is None:
            yield loc, tie.element(spots, max(carrier.count(body, each=tie.each) for body in bodies))
            continue
        if tie.spacing is not None and carrier.depth is None:
            raise RefusedFields(loc, "spacing", "requires the `depth` of the structure: give it, or give `bars`")
        for spot in spots:
            _check_plate(carrier, tie, spot, loc)
        yield loc, tie.element(spots, tie.number_of_bars(carrier.depth))


def _check_plate(carrier: Carrier, tie: Tie, spot: Spot, loc: Loc) -> None:
    """Refuse anchor plates that do not fit on the body, and a wall that is thicker, as far as sizes are known."""
    if tie.plate is None or tie.wall is None or spot.body is None:
        return
    body, count = spot.body, 1.0 if tie.bars is None else float(tie.bars)
    corners = np.concatenate([np.asarray(shape) for shape in carrier.outlines.get(body, ())] or [np.zeros(0, complex)])
    sizes = (float(np.ptp(corners.real)), float(np.ptp(corners.imag))) if corners.size else (None, None)
    beside = "the structure is deep" + (f", where {count:g} plates stand beside each other" if count > 1 else "")
    for place, field, size, most, what in (
        ("plate", "width", count * tie.plate.width, carrier.depth, beside),
        ("plate", "width", tie.plate.width, tie.spacing, "bars are apart"),
        ("plate", "height", tie.plate.height, sizes[1], f"{body} is high"),
        ("wall", "thickness", tie.wall.thickness, sizes[0], f"{body} is wide"),
    ):
        if most is not None and size > most * (1 + OUTSIDE_DISTANCE):
            reason = f"{size:g} m is more than the {most:.4g} m that {what}: reduce it"
            raise RefusedFields((*loc, place), field, reason)
    top, end = float(corners.imag.max(initial=-np.inf)), spot.at.imag + tie.plate.height / 2
    if sizes[1] is not None and end > top + OUTSIDE_DISTANCE * sizes[1]:
        reason = f"ends at y = {end:.4g} m, above the top of {body} at {top:.4g} m: lower the tie or reduce the plate"
        raise RefusedFields((*loc, "plate"), "height", reason)


def interlocked(interlock: Interlock, carrier: Carrier, density: float | None, gravity: float) -> Attached:
    """Return the friction of crossing walls as a term of the equation of motion. Raises `RefusedFields`."""
    loc, density = ("interlock",), interlock.density or density
    if density is None:
        raise RefusedFields(loc, "density", "is missing: the weight of the crossing walls is their friction")
    foot = carrier.foot(interlock.body, loc)
    carrier.spot(foot.body, foot.at + 1j * interlock.height, loc, "height")
    return interlock.attached(foot, density, gravity)


def _own_name(name: str, names: set[str], reserved: Collection[str], loc: Loc) -> None:
    if name in reserved:
        raise RefusedFields(loc, "name", f"{name!r} is a reserved name: choose another")
    if name in names:
        raise RefusedFields(loc, "name", f"{name!r} is already used: give each load and tie its own name")
    names.add(name)


def _spots(carrier: Carrier, tie: Tie, loc: Loc) -> Iterator[Spot]:
    if tie.bed is not None:
        for field, end in (("from", tie.bed.start), ("to", tie.bed.end)):
            yield carrier.spot(tie.bed.body, complex(*end), (*loc, "bed"), field)
        return
    for k, place in enumerate(tie.places):
        where: Loc = (*loc, "path", k) if tie.path is not None else (*loc, ("from", "to")[k])
        if place.ground is not None:
            yield Spot(None, place.point)
        else:
            yield carrier.spot(place.body, place.point, where, "at")


def followed(bodies: Sequence[Body], motions: Sequence[RigidMotion], shape: tuple[int, ...]) -> Follow:
    """Return a function that gives the path of a point of the bodies or the ground over the rotations of `motions`."""
    return partial(_follow, {body.name: motion for body, motion in zip(bodies, motions, strict=True)}, shape)


def _follow(by_name: Mapping[str, RigidMotion], shape: tuple[int, ...], spot: Spot) -> Path:
    if spot.body is None:
        still = np.zeros(shape, np.complex128)
        return Path(still + spot.at, still, still)
    return Path(*by_name[spot.body].carry(spot.at))


def _holds(corners: Points, at: Points) -> bool:
    """Return whether a point, given as an array of one, is in a polygon, or next to its edge."""
    close = OUTSIDE_DISTANCE * float(np.abs(corners - corners.mean()).max())
    return bool(distance(at, corners)[0] <= close or inside(at, corners)[0])


@short_repr
@dataclass(frozen=True, eq=False)
class Hung:
    """Loads, forces and ties of a structure, and the friction of its crossing walls.

    Parameters
    ----------
    placed : sequence of (tuple, Attached)
        Each attached thing with its place among the fields of the structure.
    """

    placed: Sequence[tuple[Loc, Attached]]

    @cached_property
    def things(self) -> Sequence[Attached]:
        """All attached things, as terms of the equation of motion."""
        return [attached for _, attached in self.placed]

    @cached_property
    def elements(self) -> Sequence[Element]:
        """The attached things whose force follows from an elongation."""
        return [attached for attached in self.things if isinstance(attached, Element)]

    @property
    def masses(self) -> Sequence[PointMass]:
        """Loads that have a mass."""
        return [attached for attached in self.things if isinstance(attached, PointMass)]

    @property
    def ties(self) -> Sequence[Element]:
        """Elements that are stretched: ties and beds of springs."""
        return [each for each in self.elements if each.stretched]

    @property
    def bars(self) -> Sequence[SteelBar]:
        """Passive ties of steel."""
        return [each for each in self.elements if isinstance(each, SteelBar)]

    @cached_property
    def one_sided(self) -> Sequence[Stretched]:
        """Ties that act in one sense only, tension or compression."""
        return [tie for each in self.elements for tie in each.stretched if tie.only is not None]

    def refuses(self, question: Question) -> str | None:
        """Return why a question has no answer, as a sentence; None if it has one."""
        fault = self.fault(question)
        return f"{NO_ANSWER[question]}: {fault}" if fault is not None else None

    def fault(self, question: Question) -> str | None:
        """Return the element that prevents an answer to a question, and why, in words; None if there is none."""
        refusals = ((each.name, each.refuses(question)) for each in self.elements)
        return next((f"{name} {why}" for name, why in refusals if why), None)

    def ask(self, question: Question) -> None:
        """Raise `InputError` if the elements prevent an answer to a question."""
        if why := self.refuses(question):
            raise InputError(Problem(why, field="ties"))

    def act(self, total: Coefficients, direction: Direction, follow: Follow) -> None:
        """Add the terms of all attached things to the coefficients `total`."""
        for attached in self.things:
            attached.act(total, direction, follow)

    def slackness(self, follow: Follow, count: int) -> Reals:
        """Return a value that is zero where a tie goes slack, for each one-sided tie, shape (ties, count)."""
        if not self.one_sided:
            return np.zeros((0, count))
        return np.array([each.slack_at(each.elongation(follow)[0]) for each in self.one_sided])

    def pressing(self, on: Container[str | None], direction: Direction, follow: Follow, gravity: float) -> float:
        """Return the downward force at rest of the loads and ties on some bodies [N].

        Parameters
        ----------
        on : container of str
            Names of the bodies.
        direction : Direction
            Direction of rocking, which gives a tie of zero length at rest its direction.
        follow : callable
            Function that gives the path of a point, evaluated at rest.
        gravity : float
            Gravitational acceleration [m/s2].
        """
        weights = (attached.mass * attached.weight for attached in self.masses if attached.spot.body in on)
        pushes = (
            push for attached in self.things for push in attached.forces(direction, follow) if push.spot.body in on
        )
        return gravity * sum(weights) - sum(float(push.force.imag[0]) for push in pushes)

    @property
    def carried(self) -> float:
        """Sum of the loads' masses that count as weight [kg]."""
        return sum(attached.mass * attached.weight for attached in self.masses)

    @property
    def lifting(self) -> float:
        """Sum of the upward components of constant forces [N]."""
        return sum(each.thrust.imag for each in self.elements if isinstance(each, ConstantForce))
