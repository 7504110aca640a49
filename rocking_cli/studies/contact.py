"""Whether a history is valid: the friction that its contacts require, and whether they open or crush.

The equations of motion assume that no joint slides, opens or crushes. The forces at the joints show at which moments
this is true: at every sample while the structure rocks, at its first uplift and on both sides of every impact.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rocking_cli.arrays import Bools, Reals
from rocking_cli.core import Direction, Mechanism
from rocking_cli.core.contacts import MASONRY_FRICTION, Contact
from rocking_cli.core.reactions import Reactions, at_uplift, impulses, parts, reactions
from rocking_cli.core.released import Pieces, Undetermined, released
from rocking_cli.core.structure_fields import Strength
from rocking_cli.dynamics.history import History
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.short_repr import short_repr

Places = NDArray[np.intp]
MIN_BEARING_SHARE = 0.01  # share of N at uplift below which a joint needs no friction
IDLE_SHARE = 1e-9  # share of the largest force at uplift below which a joint, as in a massless beam, bears nothing
NEAR_PEAK = 0.9  # share of the largest demand; the duration of a demand is the time above it
STATES_PER_BLOCK = 25_000  # limits memory, as each state has a matrix
UNDEFINED = float("nan")
DEMAND, PULL, USED = range(3)


@dataclass(frozen=True)
class CrushingDemand:
    """The largest ratio of the normal force at a contact to the strength of the contact.

    Parameters
    ----------
    used : float
        Normal force over strength; above 1 the contact crushes.
    joint : str
        Name of the joint.
    time : float
        Time of this force [s].
    """

    used: float
    joint: str
    time: float


class SupportDemand(NamedTuple):
    """The forces that a guide must exert on a structure while it rocks.

    Parameters
    ----------
    support : str
        Name of the guide.
    way : complex
        Unit vector x + iy along which its force acts.
    most, least : float
        Largest and smallest force along `way`, in N, or in N/kg if the structure has no masses.
    """

    support: str
    way: complex
    most: float
    least: float


@short_repr
@dataclass(frozen=True, eq=False, kw_only=True)
class ContactDemand:
    """Forces and friction that a history requires of the contacts; NaN if undefined, as for a structure at rest.

    Parameters
    ----------
    friction_needed : float
        The largest `|T|/N` of any joint while the structure rocks, where N is above 1 % of its value as rocking starts.
    joint : str
        The joint that requires it; empty if the joints are not known, so that forces are sums over the whole structure.
    time : float
        Time of this requirement [s].
    duration : float
        The longest continuous time for which more than `friction` is required [s]; if `friction` is not given, the time
        around the peak for which more than 90 % of `friction_needed` is required.
    base_shear : float
        The largest horizontal force of the ground on the structure while it rocks, in either sense, in N, or in N/kg
        if the structure has no masses. Impacts are left out: the impulse at an impact is not part of it. Forces of
        guides that hold the structure sideways are left out too; bodies that do not move count as ground.
    least_normal : float
        The smallest normal force N of any joint while the structure rocks, in N, or in N/kg if it has no masses; of
        all joints together if `whole` or `shared`.
    impact_friction : float
        The largest ratio `|dP_x|/dP_y` of horizontal to vertical impulse of any impact; NaN if the impulses are not
        known, see `rocking_cli.core.reactions.impulses`.
    lost : float
        The first time at which a joint would have to pull, an impact would throw a joint apart, or no weight is left on
        the joints [s]; NaN: never.
    lost_joint : str
        The joint at which this happens.
    whole : bool
        Whether the joints are not known: forces are then sums over the whole structure, on level ground.
    shared : bool
        Whether statics alone does not determine the force on each joint: friction is then an estimate by least squares,
        and normal forces are sums over the whole structure.
    friction : float or None
        Coefficient of friction available; None if it is not given.
    slides : float
        The first time at which more friction is required than available [s]; NaN: never.
    slides_joint : str
        The joint at which this happens.
    crushing : CrushingDemand or None
        Use of the strength of the contacts; None if no strength is given.
    times : ndarray, shape (n,)
        Times [s], of which an impact has two that are equal.
    demand : ndarray, shape (n,)
        Coefficient of friction required then; 0 at rest.
    opens : float or None
        The first time at which a joint that the mechanism keeps closed would open [s]; NaN: at none of the times that
        were checked; None: not known, as for all structures that did not search for their mechanism.
    opens_joint : str
        The joint that would open.
    followed : bool
        Whether the history itself records how far joints open and slide, and until when its outcome is known.
    known_to : float
        The time until which the history is known [s]; NaN if all of it is known, or if this was not recorded.
    supports : sequence of SupportDemand
        The forces of guides, such as what holds the top of a wall; empty if statics does not determine them.
    """

    times: Reals
    demand: Reals
    friction_needed: float = UNDEFINED
    joint: str = ""
    time: float = UNDEFINED
    duration: float = UNDEFINED
    base_shear: float = UNDEFINED
    least_normal: float = UNDEFINED
    impact_friction: float = UNDEFINED
    lost: float = UNDEFINED
    lost_joint: str = ""
    whole: bool = False
    friction: float | None = None
    slides: float = UNDEFINED
    slides_joint: str = ""
    crushing: CrushingDemand | None = None
    opens: float | None = None
    opens_joint: str = ""
    shared: bool = False
    followed: bool = False
    known_to: float = UNDEFINED
    supports: Sequence[SupportDemand] = ()

    @property
    def beyond_masonry(self) -> bool:
        """Whether more friction is required than joints of masonry usually have."""
        return self.friction_needed > MASONRY_FRICTION

    @property
    def assumed_friction(self) -> float | None:
        """Friction required, if none is given and it is more than masonry usually has; None otherwise."""
        return self.friction_needed if self.friction is None and self.beyond_masonry else None

    @property
    def holds(self) -> bool:
        """Whether, as far as is known, no joint opens, slides or crushes during the history."""
        crushes = self.crushing is not None and self.crushing.used > 1
        stays = self.opens is None or bool(np.isnan(self.opens))
        return bool(np.isnan(self.lost) and np.isnan(self.slides)) and stays and not crushes

    @property
    def stands(self) -> bool:
        """Whether the whole history is valid: no joint opens or slides, or only by as much as is permitted."""
        return bool(np.isnan(self.known_to)) and (self.followed or self.holds)


@dataclass(frozen=True, eq=False)
class Contacts:
    """Check of the contacts in histories of a structure.

    Parameters
    ----------
    mechanism : Mechanism
        The structure.
    """

    mechanism: Mechanism

    def check(self, history: History, motion: GroundMotion | None) -> ContactDemand:
        """Check the forces of a history against what its contacts can transmit.

        Parameters
        ----------
        history : History
            A history of the nonlinear model.
        motion : GroundMotion or None
            The ground motion it is the response to.
        """
        states = _states(self.mechanism, history, motion)
        if self.mechanism.driven < 1:  # the ground motion along the edge, which is not simulated, shears the foot too
            return ContactDemand(times=states.time, demand=np.zeros(states.time.size))
        # For each state, the largest friction required, pull and use of strength of all joints, and the joint of each.
        largest = np.full((3, states.time.size), -np.inf)
        largest[DEMAND] = 0.0
        joint = np.zeros(largest.shape, np.int64)
        shear = 0.0
        for direction, part in self._parts(states):
            reactions = self._forces(direction, states, part)
            pressed = self._pressed(direction, states, part)
            largest[:, part], joint[:, part] = self._worst(direction, reactions, pressed)
            shear = max(shear, float(np.abs(_base(reactions, self._rest[direction])).max()))
        demand = replace(self._summed_up(history, states, largest, joint, shear), supports=self._supports(states))
        if history.check is None:
            return demand
        opens, where = history.check.parted, history.check.parted_joint
        followed, known_to = history.check.count > 0, history.known_to
        return replace(demand, opens=opens, opens_joint=where, followed=followed, known_to=known_to)

    def base_shear(self, history: History, motion: GroundMotion | None) -> Reals:
        """The horizontal force of the ground on the structure at each sample, to the right [N]; NaN at rest.

        Impacts are left out: their impulses are not part of it. NaN as well if only a share of the motion drives it.
        """
        shear = np.full(history.time.size, np.nan)
        if self.mechanism.driven < 1:
            return shear
        states = _samples(self.mechanism, history, motion)
        for direction, part in self._parts(states):
            shear[part] = _base(self._forces(direction, states, part), self._rest[direction])
        return shear

    def _parts(self, states: _States) -> Iterator[tuple[Direction, Places]]:
        """Yield the places of the states that rock in each direction, `STATES_PER_BLOCK` at a time."""
        for direction in self.mechanism.directions:
            mine = np.flatnonzero(states.rocks & (states.sign == direction))
            for start in range(0, mine.size, STATES_PER_BLOCK):
                yield direction, mine[start : start + STATES_PER_BLOCK]

    def _supports(self, states: _States) -> list[SupportDemand]:
        """Return the largest force of each guide in either sense; none if statics does not determine them."""
        by_support: dict[str, list[tuple[Contact, Reals]]] = {}
        for direction, part in self._parts(states):
            contacts = self.mechanism.contacts(direction) or ()
            ends = np.cumsum([contact.forces for contact in contacts])
            guides = [(int(end) - 1, each) for end, each in zip(ends, contacts, strict=True) if each.held == "slide"]
            if not guides:
                continue
            try:
                table = released(self.mechanism, direction, states.phi[part])
            except Undetermined:
                return []
            assert table is not None  # mechanisms with guides have such a table
            terms = _terms(states, part)
            for row, each in guides:
                by_support.setdefault(each.support, []).append(
                    (each, np.einsum("nk,nk->n", table.force[:, row], terms))
                )
        demands = []
        for support, parts_of in by_support.items():
            axis = parts_of[0][0].normal
            along = np.concatenate([force * (each.normal * axis.conjugate()).real for each, force in parts_of])
            axis, along = (axis, along) if axis.real + axis.imag > 0 else (-axis, -along)
            demands.append(SupportDemand(support, axis, float(along.max()), float(along.min())))
        return demands

    @cached_property
    def _rest(self) -> Mapping[Direction, Collection[str]]:
        """Names of the bodies that do not move in each direction."""
        return {
            direction: {name for name, number in parts(self.mechanism, direction).items() if not number}
            for direction in self.mechanism.directions
        }

    def _forces(self, direction: Direction, states: _States, part: Places) -> Reactions:
        return reactions(self.mechanism, direction, states.phi[part], states.rate[part], states.ground[part])

    def _pressed(self, direction: Direction, states: _States, part: Places) -> Mapping[complex, Reals]:
        """Return the forces of the loads that press on guides [N], by the points of the guides."""
        pressed = [each for each in self.mechanism.contacts(direction) or () if each.pressed_by]
        if not pressed:
            return {}
        pieces, terms = Pieces(self.mechanism, direction, states.phi[part]), _terms(states, part)
        return {each.points[0]: np.einsum("nk,nk->n", pieces.pressing(each), terms) for each in pressed}

    def _worst(
        self, direction: Direction, reactions: Reactions, pressed: Mapping[complex, Reals]
    ) -> tuple[Reals, Places]:
        """Return the largest friction required, pull and use of strength in each state, and the joints of these."""
        rest = self._at_uplift[direction]
        bears = np.maximum(MIN_BEARING_SHARE * rest.normal, 0.0)
        normal = np.where(np.abs(reactions.force) > IDLE_SHARE * np.abs(rest.force).max(), reactions.normal, np.nan)
        with np.errstate(divide="ignore", invalid="ignore"):
            needed = np.where(normal > bears, np.abs(reactions.shear) / normal, 0.0)
            for k, each in enumerate(reactions.joints):
                if each.is_guide and each.point in pressed:
                    load = pressed[each.point]
                    needed[k] = np.where(load > 0, np.abs(reactions.force[k]) / load, 0.0)
            pull = np.broadcast_to(-reactions.total.imag, normal.shape) if reactions.shared else -normal
            measures = np.stack([needed, pull, normal / self._capacity(reactions)])
        measures = np.where(np.isnan(measures), -np.inf, measures)
        joint = measures.argmax(axis=1)
        return np.take_along_axis(measures, joint[:, None], axis=1)[:, 0], joint

    def _summed_up(
        self, history: History, states: _States, largest: Reals, joint: Places, shear: float
    ) -> ContactDemand:
        friction, time = self.mechanism.friction, states.time
        if not states.rocks.any():
            return ContactDemand(times=time, demand=largest[DEMAND])
        thrown = [self._impulses[direction] for direction in _ended(history)]
        hits = [reactions for reactions in thrown if reactions is not None]
        lost, lost_joint = self._lost(history, states, largest[PULL], joint[PULL])
        largest[DEMAND, time > lost] = 0.0  # after a loss of contact, the computed motion is not valid
        peak = int(np.where(states.rocks, largest[DEMAND], -1.0).argmax())
        needed = float(largest[DEMAND, peak])
        starts, ends = _stretches(time, largest[DEMAND], NEAR_PEAK * needed if friction is None else friction)
        slides = None
        if friction is None:
            around = (starts <= time[peak]) & (time[peak] <= ends)
            starts, ends = starts[around], ends[around]
        elif starts.size:
            slides = int((largest[DEMAND] > friction).argmax())
        loaded = int(largest[USED].argmax())
        crushing = None
        if np.isfinite(largest[USED, loaded]):
            crushing = CrushingDemand(
                float(largest[USED, loaded]), self._letter(states, joint[USED], loaded), float(time[loaded])
            )
        return ContactDemand(
            times=time,
            demand=largest[DEMAND],
            friction_needed=needed,
            joint=self._letter(states, joint[DEMAND], peak),
            time=float(time[peak]),
            duration=float((ends - starts).max(initial=0.0)),
            base_shear=shear,
            least_normal=-float(largest[PULL].max()),
            impact_friction=max(map(_ratio, hits), default=UNDEFINED) if len(hits) == len(thrown) else UNDEFINED,
            lost=lost,
            lost_joint=lost_joint,
            whole=any(reactions.is_whole for reactions in self._at_uplift.values()),
            shared=any(reactions.shared for reactions in self._at_uplift.values()),
            friction=friction,
            slides=UNDEFINED if slides is None else float(starts[0]),
            slides_joint="" if slides is None else self._letter(states, joint[DEMAND], slides),
            crushing=crushing,
        )

    def _lost(self, history: History, states: _States, pull: Reals, joint: Places) -> tuple[float, str]:
        """Return the first time at which contact is lost [s], by a pull or an impact, and the joint that loses it."""
        moments: list[tuple[float, str]] = []
        pulls = np.flatnonzero(pull >= 0)
        if pulls.size:
            first = int(pulls[0])
            shared = self._at_uplift[Direction(int(states.sign[first]))].shared
            moments.append((float(states.time[first]), "" if shared else self._letter(states, joint, first)))
        if history.check is not None and history.check.reason == "weightless" and states.rocks.any():
            last = int(np.flatnonzero(states.rocks)[-1])
            moments.append((history.known_to, self._letter(states, joint, last)))
        for direction, hit in _ended(history).items():
            impulse = self._impulses[direction]
            if (
                impulse is not None
                and not impulse.shared
                and (thrown := impulse.normal[:, 0] < -IDLE_SHARE * np.abs(impulse.force).max()).any()
            ):
                moments.append((hit, impulse.joints[int(thrown.argmax())].letter))
        return min(moments, default=(UNDEFINED, ""))

    def _letter(self, states: _States, joint: Places, k: int) -> str:
        joints = self._at_uplift[Direction(int(states.sign[k]))].joints
        return joints[int(joint[k])].letter

    @cached_property
    def _at_uplift(self) -> Mapping[Direction, Reactions]:
        """Forces at each joint as rocking starts, by direction."""
        return {direction: at_uplift(self.mechanism, direction) for direction in self.mechanism.directions}

    @cached_property
    def _impulses(self) -> Mapping[Direction, Reactions | None]:
        return {direction: impulses(self.mechanism, direction) for direction in self.mechanism.directions}

    def _capacity(self, reactions: Reactions) -> Reals:
        """Return the strength of each joint [N], shape (k, 1); NaN if it is not given."""
        strength, depth = self.mechanism.strength, self.mechanism.depth
        if not isinstance(strength, Strength) or depth is None or reactions.is_whole or reactions.shared:
            return np.full((len(reactions.joints), 1), np.nan)
        alike = self.mechanism.alike()
        counts = [max(alike.get(name, 1) for name in joint.bodies) for joint in reactions.joints]
        return strength.force(depth) * np.array(counts, dtype=np.float64)[:, None]


class _States(NamedTuple):
    """Moments of a history in order of time, each field an ndarray of shape (n,)."""

    time: Reals
    sign: Reals  # sign of the direction
    phi: Reals  # rotation in this direction [rad]
    rate: Reals  # rate of this rotation [rad/s]
    ground: NDArray[np.complex128]  # u_g'' + i v_g'' [m/s2]
    rocks: Bools


def _terms(states: _States, part: Places) -> Reals:
    """Return what the columns of tables of forces are the factors of: 1, u_g'', phi.^2 and v_g'', shape (n, 4)."""
    ground = states.ground[part]
    return np.stack([np.ones(part.size), ground.real, states.rate[part] ** 2, ground.imag], axis=-1)


def _samples(mechanism: Mechanism, history: History, motion: GroundMotion | None) -> _States:
    """Return the samples of a history until it overturns."""
    end = history.overturning_time if history.fell else np.inf
    kept = np.isfinite(history.phi) & (history.time <= end)
    time, phi, rate = history.time[kept], history.phi[kept], history.rate[kept]
    sign = np.where(phi != 0, np.sign(phi), np.sign(rate))
    if not mechanism.rocks_both_ways:
        sign = np.full(sign.size, float(mechanism.directions[0]))
    rocks = ((phi != 0) | (rate != 0)) & (sign != 0)
    return _States(time, sign, np.abs(phi), sign * rate, _ground(time, motion), rocks)


def _states(mechanism: Mechanism, history: History, motion: GroundMotion | None) -> _States:
    """Return the samples of a history until it overturns, its first uplift, and both sides of its impacts."""
    end = history.overturning_time if history.fell else np.inf
    samples = _samples(mechanism, history, motion)
    impact = _known_impacts(history)
    impact = impact[impact[:, 0] <= end]
    after = -impact[:, 1] if mechanism.rocks_both_ways else impact[:, 1]
    eta = np.where(impact[:, 1] > 0, mechanism.eta(mechanism.sides[0]), mechanism.eta(mechanism.sides[1]))
    still = np.zeros(len(impact))
    rows = [
        np.stack([samples.time, samples.sign, samples.phi, samples.rate, samples.rocks]),
        # Every impact gives two rows with phi = 0: with the rate before it, then with the rate after it.
        np.stack([impact[:, 0], impact[:, 1], still, -impact[:, 2], still + 1]).repeat(2, axis=1),
    ]
    rows[1][1, 1::2], rows[1][3, 1::2] = after, eta * impact[:, 2]
    if np.isfinite(history.uplift_time):
        push = _ground(np.array([history.uplift_time]), motion).real[0]
        side = (-np.sign(push) or 1.0) if mechanism.rocks_both_ways else float(mechanism.directions[0])
        rest, lifts = [history.uplift_time, side, 0.0, 0.0, 0.0], [history.uplift_time, side, 0.0, 0.0, 1.0]
        rows.insert(0, np.array([rest, lifts]).T)
    table = np.concatenate(rows, axis=1)
    table = table[:, np.argsort(table[0], kind="stable")]
    rocks = (table[4] > 0) & (table[1] != 0)
    return _States(table[0], table[1], table[2], table[3], _ground(table[0], motion), rocks)


def _base(reactions: Reactions, rest: Collection[str] = ()) -> Reals:
    """Return the horizontal force of the ground and bodies at rest on the structure, without guides, shape (n,)."""
    total = np.zeros(reactions.force.shape[1])
    for joint, force in zip(reactions.joints, reactions.force.real, strict=True):
        moves = [name not in rest for name in joint.bodies]
        on_ground = moves == [True] and not joint.is_guide
        # Forces act on the last body of a joint, which is the only one if the other is the ground.
        if reactions.is_whole or on_ground or moves == [False, True]:
            total += force
        elif moves == [True, False]:
            total -= force
    return total


def _ground(time: Reals, motion: GroundMotion | None) -> NDArray[np.complex128]:
    """Return the ground acceleration u_g'' + i v_g'' at any times [m/s2]: linear between samples, zero after them."""
    if motion is None:
        return np.zeros(time.size, np.complex128)
    u = np.interp(time, motion.time, motion.acceleration, right=0.0)
    up = motion.vertical
    v = np.interp(time, up.time, up.acceleration, right=0.0) if up is not None else 0.0
    return np.asarray(u + 1j * v, dtype=np.complex128)


def _stretches(time: Reals, value: Reals, level: float) -> tuple[Reals, Reals]:
    """Return the times at which a value, linear between its samples, rises above a level, and falls below it."""
    above = value > level
    starts = np.flatnonzero(above & ~np.concatenate([[False], above[:-1]]))
    ends = np.flatnonzero(above & ~np.concatenate([above[1:], [False]]))

    def crossing(inside: Places, outside: Places) -> Reals:
        outside = np.clip(outside, 0, time.size - 1)
        with np.errstate(divide="ignore", invalid="ignore"):
            share = np.where(outside == inside, 0.0, (value[inside] - level) / (value[inside] - value[outside]))
        return np.asarray(time[inside] + share * (time[outside] - time[inside]))

    return crossing(starts, starts - 1), crossing(ends, ends + 1)


def _ended(history: History) -> dict[Direction, float]:
    """Return the time of the first impact that ends motion in each direction [s], for the directions that have one."""
    impacts = _known_impacts(history)
    signs = impacts[:, 1]
    return {each: float(impacts[signs == each, 0][0]) for each in Direction if (signs == each).any()}


def _known_impacts(history: History) -> Reals:
    """Return the impacts of a history after which its motion is known: none without a known restitution."""
    return history.impacts[:0] if history.unmeasured else history.impacts


def _ratio(reactions: Reactions) -> float:
    """Return the largest |T|/N of the joints that an impact presses together."""
    pressed = reactions.normal > IDLE_SHARE * np.abs(reactions.force).max()
    return float((np.abs(reactions.shear[pressed]) / reactions.normal[pressed]).max(initial=0.0))
