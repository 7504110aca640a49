"""Base class of all mechanism plugins: what follows from a mechanism, with the loads and ties attached to it.

The fields of a structure are checked against one another here; each check raises `RefusedFields` with the field at
fault.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import cached_property
from itertools import pairwise
from math import nan, sqrt
from typing import Any, Self, final

import numpy as np
from pydantic import ValidationError

from rocking_cli.core.bodies import Body
from rocking_cli.core.bounds import Bound, first_beyond, meeting
from rocking_cli.core.coefficients import (
    SCAN_POINTS,
    Coefficients,
    coefficients,
    first_fall,
    narrowed,
    uplift_acceleration,
)
from rocking_cli.core.hung.attached import Attached, Follow, PointMass, Spot
from rocking_cli.core.hung.attachments import (
    Carrier,
    Hung,
    Loc,
    RefusedFields,
    as_validation_error,
    attach,
    followed,
    interlocked,
)
from rocking_cli.core.hung.element import INTERLOCK_NAME as INTERLOCK
from rocking_cli.core.hung.element import Element, SteelBar, Stretched
from rocking_cli.core.kinematics import Direction, Reals, RigidMotion
from rocking_cli.core.mechanism_kinematics import Extra, Jointed, Kinematics
from rocking_cli.core.sketch import Outline
from rocking_cli.core.structure_fields import KINEMATIC, NEEDS_A_SIDE, DirectionalRestitution, Stop, Strength
from rocking_cli.errors import InputError, Problem
from rocking_cli.plugins.errors import failed, guard


class Mechanism(Jointed):
    """A rocking structure with one degree of freedom.

    A plugin subclasses it, declares its geometry as fields made with `quantity`, and gives the motion of its rigid
    bodies in `bodies`, `motion` and `limit`. Energies, uplift, critical rotation, equivalence and restitution follow
    here from these, with the loads and ties of the structure. What is final cannot be overridden; all else can, with
    effect whether or not anything is attached. `sketch` adds to the drawing, and `contacts` gives the joints.

    If a structure gives no masses, its total mass is 1 kg, so that inertias and moments are per kilogram.
    """

    def _hold_together(self) -> None:
        """Check the masses, loads and ties against the bodies; raise `ValidationError` of the fields."""
        try:
            check(self)
        except RefusedFields as error:
            raise as_validation_error([error], self.mechanism) from error

    @classmethod
    def __pydantic_init_subclass__(cls, **named: Any) -> None:
        """Refuse overrides of final members, and report any failure in other members as an error of the plugin."""
        super().__pydantic_init_subclass__(**named)
        for name in [name for name in vars(cls) if name[:2] != "__"]:  # a look at a schema builds it
            if any(_is_final(vars(base).get(name)) for base in cls.__mro__[1:]):
                hint = f": give a closed form as `{name}_alone`" if hasattr(cls, f"{name}_alone") else ""
                raise TypeError(f"{cls.__name__} cannot override {name}, which follows from bodies and motion{hint}")
        answers = [name for base in Mechanism.__mro__ if issubclass(base, Kinematics) for name in vars(base)]
        guard(cls, [name for name in answers if name[0] != "_"], failed("mechanism", "mechanism"), but=RefusedFields)

    def columns_alone(self) -> Sequence[Mechanism]:
        """Return the columns if three or more carry one beam, each as a structure, equal ones once; otherwise none."""
        return ()

    def weaker_side(self) -> Mechanism | None:
        """Return the structure as it rocks about the weaker side of its base, if it may; by default None."""
        return None

    def may_rock_about_depth(self) -> bool:
        """Return whether it may rock about its depth, if that is the weaker side of its base; by default not."""
        return False

    @final
    def cautions(self) -> Sequence[str]:
        """Return cautions on the results: the `caution` of the mechanism, and that of this structure."""
        return [text for text in (self.caution, self.own_caution()) if text]

    @final
    def borne(self, direction: Direction, *bodies: str) -> float:
        """Return the weight at rest of some bodies, or of all, with the loads and ties on them [N]."""
        on = bodies or tuple(body.name for body in self.bodies())
        weight = self.gravity * sum(body.mass for body in self.weighed() if body.name in on)
        return weight + self.hung.pressing(on, direction, self.followed(np.zeros(1), direction), self.gravity)

    @final
    def inwards(self, direction: Direction, joint: str) -> float:
        """Return the distance by which crushing moves a joint inwards [m], constant during the motion."""
        return self.moved_inwards[direction][joint] if self.crushing is not None else 0.0

    @cached_property
    @final
    def moved_inwards(self) -> Mapping[Direction, Mapping[str, float]]:
        """Distances u = N/(2 strength depth) by which joints of each direction move [m]; empty if none can move."""
        if self.crushing is None:
            return {}
        try:
            sound = self.model_copy(update={"crushing": None})
        except ValidationError as error:
            raise RefusedFields.first_of(error) from None
        per_metre = 2 * self.crushing.strength * (self.crushing.depth or self.depth or 1.0)
        moved = {direction: sound.bearing(direction) for direction in Direction}
        distances = {s: {joint: max(force, 0.0) / per_metre for joint, force in moved[s].items()} for s in Direction}
        return distances if all(distances.values()) else {}

    @final
    def found(self, direction: Direction) -> Sequence[Extra]:
        """Return all further results: `extras`, and the distances by which crushing moves the pivots."""
        what = "how far crushing moves the {} inwards"
        moved = self.moved_inwards.get(direction, {}).items()
        return [*self.extras(direction), *(Extra(f"inwards_{key}", u, "m", what.format(key)) for key, u in moved)]

    @cached_property
    @final
    def hung(self) -> Hung:
        """Loads, forces and ties of the structure, and what the mechanism's own fields attach (`carries`)."""
        attached: list[tuple[Loc, Attached]] = [((), attachment) for attachment in self.carries()]
        if self.is_laden:
            taken = [
                *(attachment.name for _, attachment in attached),
                *([INTERLOCK] if self.interlock is not None else []),
            ]
            attached += attach(self.carrier, self.loads or [], self.ties or [], taken)
        if self.interlock is not None:
            friction = interlocked(self.interlock, self.carrier, self.density, self.gravity)
            attached.append((("interlock",), friction))
        return Hung(attached)

    @property
    @final
    def carrier(self) -> Carrier:
        """The bodies to which loads and ties are attached, with their outlines if these are known."""
        bodies = self.bodies()
        outlines: dict[str, Sequence[Outline]] = {body.name: [body.outline] for body in bodies if body.outline}
        if len(outlines) < len(bodies) and (sketch := self.sketch()).uniform:
            outlines = {**sketch.outlines, **outlines}
        return Carrier({body.name: body for body in bodies}, outlines, self.alike(), self.piece, self.depth)

    @property
    @final
    def attached(self) -> Sequence[Attached]:
        """All that is attached to the mechanism, as terms of its equation of motion."""
        return self.hung.things

    @final
    def at_strength(self, *, on: bool = True) -> Self:
        """Return the structure with ties of steel as methods of codes count them, or, without `on`, as motions do.

        By methods of codes they act with their strength, as constant forces; in motions they are elastic and passive.
        It is the structure itself if it has none of steel.
        """
        if not any(tie.is_steel for tie in self.ties or []):
            return self
        return self.model_copy(update={"ties": [tie.at_strength(on=on) for tie in self.ties or []]})

    @final
    def slackness(self, phi: Reals, direction: Direction) -> Reals:
        """Return a value that is zero where a tie goes slack, for each one-sided tie, shape (ties, n)."""
        return self.hung.slackness(self.followed(np.asarray(phi, dtype=np.float64), direction), np.size(phi))

    @property
    def bends(self) -> bool:
        """Whether the restoring moment may have any shape, so that the linear models must be checked."""
        return bool(self.attached)

    @property
    def smooth(self) -> bool:
        """Whether the derivatives of the restoring moment have no corners, as where a tie goes slack."""
        return not self.hung.one_sided

    @property
    @final
    def is_bare(self) -> bool:
        """Whether the structure is the mechanism alone, without given masses, loads and ties."""
        return self.total_mass() is None and not self.hung.placed

    @final
    def followed(self, phi: Reals, direction: Direction) -> Follow:
        """Return a function that gives the path of a point over rotations, shape (n,) [rad]."""
        return followed(self.bodies(), self.motion(phi, direction), phi.shape)

    @final
    def coefficients(self, phi: Reals, direction: Direction) -> Coefficients:
        """Return the coefficients I, J, G, B of the equation of motion over `phi`, shape (n,) [paper, Eq. 8].

        They include loads and ties: see `rocking_cli.core.hung.attached`.
        """
        phi = _rotations(phi)
        bodies, motions = self.weighed(), self.motion(phi, direction)
        total = coefficients(phi, direction, bodies, motions)
        if self.hung.placed:
            self.hung.act(total, direction, followed(bodies, motions, phi.shape))
        total.B[:] *= self.driven
        total.dB[:] *= self.driven
        return total

    @final
    def kinetic_inertia(self, phi: Reals, direction: Direction) -> Reals:
        """Return I(phi) [kg m2], shape (n,): the kinetic energy is I phi.^2 / 2."""
        return self.coefficients(phi, direction).I

    @final
    def potential_energy(self, phi: Reals, direction: Direction) -> Reals:
        """Return V(phi) [J], shape (n,), zero at rest; it includes the energy stored in ties."""
        here = self.coefficients(phi, direction)
        return self.gravity * here.V + here.U

    @final
    def uplift(self, direction: Direction) -> float:
        """Return lambda, the ground acceleration that starts rocking, over g [paper, Eq. 10]."""
        return uplift_acceleration(self.coefficients(np.zeros(1), direction), self.gravity)

    @final
    def critical_rotation(self, direction: Direction) -> float:
        """Return phi_cr, the rotation of unstable equilibrium [rad; paper, Eq. 9].

        Raises `NoCriticalRotation` if there is none.
        """
        alone = self.critical_rotation_alone(direction) if self.is_bare else None
        return self.solved_critical_rotation(direction) if alone is None else alone

    @final
    def solved_critical_rotation(self, direction: Direction) -> float:
        """Return phi_cr from the coefficients, without regard to a closed form [rad]. Raises `NoCriticalRotation`."""
        limit = self.limit(direction)
        grid = np.linspace(0.0, limit, SCAN_POINTS)[:-1]
        low, high = first_fall(self.coefficients(grid, direction), limit, self.gravity)
        phi = (low + high) / 2
        for _ in range(100):
            here = self.coefficients(np.array([phi]), direction)
            low, high, guess = narrowed(here, low, high, self.gravity)
            if abs(guess - phi) <= 4 * np.finfo(float).eps * phi:
                break
            phi = guess
        return phi

    @cached_property
    @final
    def bounds(self) -> Mapping[Direction, Bound | None]:
        """The rotation of each direction beyond which something else than the mechanism decides; None without one."""
        return {direction: self._bound(direction) for direction in self.directions}

    def _bound(self, direction: Direction) -> Bound | None:
        """Return the first bound of a direction; what has fallen below its energy at rest has overturned before."""
        phi = np.linspace(0.0, SHARE_OF_LIMIT * self.limit(direction), SCANNED)
        fallen = np.flatnonzero(self.potential_energy(phi, direction) < 0)
        end = float(phi[fallen[0] if fallen.size else -1])
        ends = [self.yields(direction, end), *(self._stopped(stop, direction, end) for stop in self.stops or ())]
        bound = min(filter(None, ends), key=lambda each: each.phi, default=None)
        met = meeting(self, direction, end if bound is None else (1 - SAME_PLACE) * bound.phi)
        bound = bound if met is None else met
        if bound is None or bound.kind == "yields":
            return bound
        if self.coefficients(np.array([bound.phi]), direction).restoring(self.gravity)[0] > 0:
            return bound
        return bound._replace(kind="leans", restitution=None)

    def _stopped(self, stop: Stop, direction: Direction, end: float) -> Bound | None:
        """Return the bound at which a point of a body meets its stop up to a rotation, or None."""
        (body,) = [stop.body] if stop.body is not None else [each.name for each in self.bodies()]
        at = complex(*stop.point)

        def beyond(phi: Reals) -> Reals:
            moved = self.followed(phi, direction)(Spot(body, at)).z.real - at.real
            return np.asarray(np.sign(stop.gap) * moved - abs(stop.gap))

        first = _first(beyond, end)
        if first is None:
            return None
        return Bound(first, "meets", stop.name, body, at, stop.restitution, direction)

    @final
    def yields(self, direction: Direction, end: float) -> Bound | None:
        """Return the bound at which the first tie of steel reaches its strength up to a rotation, or None."""
        bounds = []
        for bar in self.hung.bars:

            def beyond(phi: Reals, bar: SteelBar = bar) -> Reals:
                return bar.elongation(self.followed(phi, direction))[0] - bar.yield_elongation

            if (first := _first(beyond, end)) is not None:
                bounds.append(Bound(first, "yields", bar.name, direction=direction))
        return min(bounds, key=lambda bound: bound.phi, default=None)

    @final
    def restitution_from_kinematics(self, direction: Direction) -> float:
        """Return eta of an impact that ends motion in `direction`, from the kinematics alone; it may be <= 0."""
        motions = self.motion(np.zeros(1), direction), self.motion(np.zeros(1), direction.opposite)
        return kinematic_restitution(self.weighed(), *motions, self.hung.masses)

    @final
    def greatest_restitution(self, direction: Direction) -> float:
        """Return the eta of an impact that ends motion in `direction` and keeps all energy.

        The inertia at rest is I(0) before the impact and I'(0), that of the other direction, after it. The ratio of the
        energies after and before the impact is eta^2 I'(0)/I(0), so the bound is sqrt(I(0)/I'(0)), which is 1 for a
        symmetric structure.
        """
        before, after = (float(self.kinetic_inertia(np.zeros(1), s)[0]) for s in (direction, direction.opposite))
        return sqrt(before / after)

    @final
    def eta(self, direction: Direction) -> float:
        """Return eta of an impact that ends motion in `direction`: as given, or else from the kinematics.

        If the structure rocks to one side only, this is the rebound: NaN if it is neither given nor known from the
        shape, as only time histories need it.
        """
        if not self.rocks_both_ways:
            rebound = self.rebound if self.rebound is not None else self.rebound_from_impacts()
            return nan if rebound is None else rebound
        if isinstance(self.restitution, DirectionalRestitution):
            restitution = self.restitution
            return restitution.positive_to_negative if direction > 0 else restitution.negative_to_positive
        return self.restitution if self.restitution is not None else self.restitution_from_kinematics(direction)


def _first(beyond: Callable[[Reals], Reals], end: float) -> float | None:
    """Return the first rotation up to an end at which a continuous value, not positive at rest, is so; or None."""
    phi = np.linspace(0.0, end, PLACES_OF_POINTS)
    k = int((beyond(phi) > 0).argmax())
    return first_beyond(beyond, phi[k - 1], phi[k]) if k else None


def _rotations(phi: Any) -> Reals:
    """Return rotations as an array of reals. Raises `InputError` if they are not numbers in an array."""
    try:
        rotations = np.asarray(phi, dtype=np.float64)  # integers become reals, as sums are added in place
    except (TypeError, ValueError):
        rotations = np.zeros(())
    if rotations.ndim == 0:
        raise InputError(Problem(f"must be an array of rotations, got {phi!r}", field="phi", hint="write [0.1]"))
    return rotations


def _is_final(member: object) -> bool:
    """Return whether a method or a property of a class is marked as final."""
    return any(getattr(getattr(member, key, member), "__final__", False) for key in ("fget", "func", "__func__"))


PLACES_OF_POINTS = 1025  # rotations at which it is looked how far a point has moved, or a tie is stretched
SCANNED = 65  # rotations at which the potential energy is compared with that at rest
SAME_PLACE = 1e-6  # difference of the rotations at which a wall is met, and its stop, by rounding
SHARE_OF_LIMIT = 0.999  # of the kinematic limit, at which linkages have no derivatives
RESTITUTION_ROUNDING = 1e-9  # relative excess over the bound that is allowed, as equal sides reach the bound
STRETCH_CHECKS = 129  # rotations at which it is checked whether a tie stretches
MIN_MOMENT = 1e-9  # moment that counts, over the weight of the structure times its size
MIN_ELONGATION = 1e-9  # elongation that counts, over the length of the path of a tie, or over 1 m if it is shorter
NO_MASSES = "the structure has no masses: give density and depth, or its mass"


def check(mechanism: Mechanism) -> None:
    """Refuse a structure whose fields do not fit together."""
    if mechanism.mass is not None and mechanism.density is not None:
        raise RefusedFields((), "mass", "give mass, or density and depth: one of them")
    check_crushed(mechanism)
    check_one_sided(mechanism)
    mechanism.total_mass()  # refuses a density without a volume
    check_strength(mechanism)
    check_stops(mechanism)
    if mechanism.is_laden and not mechanism.has_mass:
        key = "loads" if mechanism.loads else "ties" if mechanism.ties else "interlock"
        raise RefusedFields((), key, NO_MASSES)
    check_restitution(mechanism)
    if mechanism.is_laden:
        check_stretched(mechanism)
        check_stands(mechanism)


def check_crushed(mechanism: Mechanism) -> None:
    """Refuse `crushing` if it moves no joint, or moves joints so far that nothing stands."""
    if mechanism.crushing is None:
        return
    moved = mechanism.moved_inwards
    if not moved:
        reason = "its pivots cannot be moved in this version, only those of single bodies and of walls: leave it out"
        raise RefusedFields((), "crushing", reason)
    for direction in mechanism.directions:
        if not mechanism.coefficients(np.zeros(1), direction).restoring(mechanism.gravity)[0] > 0:
            far = max(moved[direction].values())
            reason = f"the structure cannot stand on what is left: a pivot moves inwards by {far:.4g} m"
            raise RefusedFields((), "crushing", reason)


def check_one_sided(mechanism: Mechanism) -> None:
    """Check that `one_sided`, `rebound` and `restitution` fit together.

    A structure that rocks to both sides has no rebound, and one that rocks to one side only has a rebound and no
    restitution. The rebound may be `kinematic` only if it follows from the shape.
    """
    if mechanism.one_sided is None and mechanism.rebound is not None:
        raise RefusedFields((), "rebound", NEEDS_A_SIDE)
    if mechanism.one_sided is not None and mechanism.restitution is not None:
        raise RefusedFields((), "restitution", "cannot be combined with `one_sided`: give `rebound` instead")
    is_null = "rebound" in mechanism.model_fields_set and mechanism.rebound is None
    if mechanism.one_sided is not None and is_null and mechanism.rebound_from_impacts() is None:
        why = "only for a plain rectangle does it follow from the shape; give a number in [0, 1)"
        raise RefusedFields((), "rebound", f"cannot be {KINEMATIC}: {why}")


def check_stops(mechanism: Mechanism) -> None:
    """Refuse stops of bodies that do not exist, or without a distance."""
    names = [body.name for body in mechanism.bodies()] if mechanism.stops else []
    for k, stop in enumerate(mechanism.stops or ()):
        if stop.gap == 0:
            raise RefusedFields(("stops", k), "gap", "must not be 0: describe what leans on a wall by `one_sided`")
        if stop.body not in names and (stop.body is not None or len(names) > 1):
            raise RefusedFields(("stops", k), "body", f"must be one of {', '.join(names)}")


def check_strength(mechanism: Mechanism) -> None:
    """Refuse a contact strength if the structure has no masses or no depth."""
    if not isinstance(mechanism.strength, Strength):  # a plugin may have its own field `strength`
        return
    if not mechanism.has_mass:
        raise RefusedFields((), "strength", NO_MASSES)
    if mechanism.depth is None:
        raise RefusedFields((), "depth", "is missing: the contacts are as long as the structure is deep")


def check_restitution(mechanism: Mechanism) -> None:
    """Refuse a restitution with which an impact would add energy."""
    restitution = mechanism.restitution
    for direction in Direction if restitution is not None else ():
        eta, bound = mechanism.eta(direction), mechanism.greatest_restitution(direction)
        if eta > bound * (1 + RESTITUTION_ROUNDING):
            reason = f"must be at most {bound:.6g}, got {eta:g}: a larger value would add energy at an impact"
            if isinstance(restitution, DirectionalRestitution):
                field = "positive_to_negative" if direction > 0 else "negative_to_positive"
                raise RefusedFields(("restitution",), field, reason)
            raise RefusedFields((), "restitution", reason)


def check_stretched(mechanism: Mechanism) -> None:
    """Refuse ties that no motion stretches, or whose motion never makes them act in their only sense."""
    for loc, tie in mechanism.hung.placed:
        parts = tie.stretched if isinstance(tie, Element) else ()
        if parts and not any(stretches(mechanism, part, side) for part in parts for side in mechanism.directions):
            sense = f" in {parts[0].only}" if parts[0].only else ""
            reason = f"nothing stretches {tie.name!r}{sense}: no motion of the structure changes its length"
            raise RefusedFields(loc, "name", f"{reason}: move an end, or leave it out")


def stretches(mechanism: Mechanism, tie: Stretched, direction: Direction) -> bool:
    """Return whether the motion in a direction stretches a tie, in the sense in which it can act."""
    grid = np.linspace(0.0, mechanism.limit(direction), STRETCH_CHECKS)[:-1]
    e, _, _ = tie.elongation(mechanism.followed(grid, direction))
    long = max(1.0, *(abs(b.at - a.at) for a, b in pairwise(tie.spots)))
    return bool(((np.abs(e) > MIN_ELONGATION * long) & (tie.only is None or tie.force(e) != 0)).any())


def check_stands(mechanism: Mechanism) -> None:
    """Refuse loads and ties under which the structure does not stand, if it stands without them."""
    bodies, g, rest = mechanism.bodies(), mechanism.gravity, np.zeros(1)
    weight = g * (sum(body.mass for body in mechanism.weighed()) + mechanism.hung.carried)
    if mechanism.hung.lifting >= weight:
        reason = f"forces lift it by {mechanism.hung.lifting:.4g} N, more than all of its weight, {weight:.4g} N"
        raise RefusedFields((), "loads", reason)
    for direction in mechanism.directions:
        bare = coefficients(rest, direction, bodies, mechanism.motion(rest, direction))
        moment = g * mechanism.coefficients(rest, direction).restoring(g)[0]
        tie = MIN_MOMENT * weight * extent(mechanism)
        if bare.G[0] > 0 and not moment > tie:
            how = f"with {-moment:.4g} N m more than its weight holds" if moment < -tie else (
                "with as much as its weight holds, which is neutral equilibrium"
            )  # fmt: skip
            raise RefusedFields(
                (),
                "loads" if mechanism.loads else "ties",
                f"the structure cannot stand under them: at rest they turn it in the {direction.label} direction {how}",
            )


def kinematic_restitution(
    bodies: Sequence[Body],
    before: Sequence[RigidMotion],
    after: Sequence[RigidMotion],
    loads: Sequence[PointMass] = (),
) -> float:
    """Return eta, the ratio of the rotation rates after and before an impact.

    The velocity before the impact is projected on the mechanism that follows, in the mass inner product: eta =
    -<t_before, t_after> / <t_after, t_after> with t the velocity fields at rest. For a block this is Housner's 1 -
    (3/2) sin^2(alpha). This is an idealisation: measured values lie on either side of it. A value of zero or less means
    that the new mechanism cannot start as assumed.

    Parameters
    ----------
    bodies : sequence of Body
        Bodies that are rigid in both mechanisms.
    before, after : sequence of RigidMotion
        Motions of the bodies in the two directions; the first entry of each is at rest (phi = 0).
    loads : sequence of PointMass
        Masses on these bodies, whose shares enter the inner product; a tie or a force is no part of it.

    Returns
    -------
    float
        eta; it does not depend on the scale of the masses.
    """
    products = squares = 0.0
    for body, old, new in zip(bodies, before, after, strict=True):
        u, v = old.carry(body.centroid)[1][0], new.carry(body.centroid)[1][0]
        products += body.mass * (u.conjugate() * v).real + body.inertia * old.dpsi[0] * new.dpsi[0]
        squares += body.mass * abs(v) ** 2 + body.inertia * new.dpsi[0] ** 2
    by_name = {body.name: pair for body, pair in zip(bodies, zip(before, after, strict=True), strict=True)}
    for load in loads:
        old, new = by_name[load.spot.body or ""]
        u, v = (complex(motion.carry(load.spot.at)[1][0]) for motion in (old, new))
        products += load.product(u, v)
        squares += load.product(v, v)
    return float(-products / squares)


def why_none(eta: float) -> str:
    """Return in words why the kinematics give no valid restitution, from the sign of the one that they give.

    Parameters
    ----------
    eta : float
        Restitution from kinematics, not positive.
    """
    product = "zero" if eta == 0 else "positive"
    return (
        f"the mass inner product of its motions before and after, <t+, t->, is {product}, so that no rocking the other "
        "way follows the impact"
    )


def extent(mechanism: Mechanism) -> float:
    """Return the largest length of a structure [m]: of the box around its bodies, or from a pivot to a centroid.

    Only the bodies and their motion are used, so that it works for any mechanism.
    """
    bodies = mechanism.bodies()
    z = np.array([point for body in bodies for point in (body.centroid, *body.outline)])
    moved = [motion.carry(body.centroid)[1][0] for body, motion in zip(
        bodies, mechanism.motion(np.zeros(1), Direction.POSITIVE), strict=True)]  # fmt: skip
    return float(max(abs(complex(np.ptp(z.real), np.ptp(z.imag))), *np.abs(moved)))
