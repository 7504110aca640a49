"""Free blocks under a ground motion: rigid bodies with contact and friction, simulated by MuJoCo.

Contacts are soft: a body that presses against another sinks into it by a little, and recovers within the time constant
of the contact. This time, and the step, follow from the blocks; docs/free_blocks.md has the rule and its evidence.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from math import ceil, inf, nan, sqrt
from typing import TYPE_CHECKING

import numpy as np

from rocking_cli.arrays import Points, Reals
from rocking_cli.core.kinematics import area_of
from rocking_cli.dynamics.deck import RELEASE_DT
from rocking_cli.errors import SolverError
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.short_repr import short_repr
from rocking_cli.studies.engines.free_blocks import FALL, NEAR_SHARE, TURN, FreeBlocks
from rocking_cli.studies.engines.scene import IMPEDANCE, SLIP_STIFFNESS, diverged, mujoco_errors, scene
from rocking_cli.studies.picture import box_around

if TYPE_CHECKING:
    import mujoco

SOFTNESS = 0.01  # time constant of a contact, over sqrt(size/g) of the smallest block
STEPS = 8  # time steps in this time
HEAVY = 10.0  # weight straight above a block over its own, from which the contacts are stiffer
SUNK = 1e-3  # largest depth to which a body may sink into another, over its size; as far it may move at rest
SETTLING = 1.0  # over sqrt(size/g)
LIGHT = 0.1  # normal force over the weight of the lighter block, below which friction is not looked at
LONGEST_TAIL = 60.0  # s after the motion for which blocks that still move are followed
ROUNDING = 1e-6  # samples
BALANCED = 4.0  # distance from a start over that by which contacts give way, within which what is released has not left
READ_AS = 6  # number of the rule by which an outcome is read from a motion: outcomes by others are not those kept


@short_repr
@dataclass(frozen=True, eq=False, kw_only=True)
class BlockMotion:
    """The motion of free blocks.

    Parameters
    ----------
    time : ndarray, shape (n,)
        Times of the samples [s], those of the ground motion.
    moved : ndarray, shape (n, blocks, 3)
        Displacement of the centroid of each block to the right and upwards [m], and its rotation, anticlockwise [rad].
    rates : ndarray, shape (n, blocks, 3)
        Their rates [m/s, m/s, rad/s].
    collapsed : float
        Time at which a block first falls by 0.15 of the structure's height, or turns by 0.8 rad [s]; NaN if none does.
    block : str
        This block; empty if there is none.
    off : str
        On what it rested whose edge it has left then: another block, or a part of the ground; empty if on none.
    failed : str
        Why the simulation is no answer, a clause; empty if it is one.
    at_rest : bool
        Whether all blocks came to rest in the end.
    ended_early : bool
        Whether it was ended at the time after which blocks are not followed.
    friction : mapping of tuple of str to float
        Largest shear over normal force of each pair of blocks that touch, at the samples; "" is the ground. Empty if it
        was not looked at.
    least_turn, least : float
        Rotation [rad] and displacement [m] below which those of blocks are not resolved.
    """

    time: Reals
    moved: Reals
    rates: Reals
    collapsed: float = nan
    block: str = ""
    off: str = ""
    failed: str = ""
    at_rest: bool = False
    ended_early: bool = False
    friction: Mapping[tuple[str, str], float] = field(default_factory=dict)
    least_turn: float = 0.0
    least: float = 0.0


def time_constant(free: FreeBlocks) -> float:
    """Return the time in which a contact recovers, by size and weight of the blocks [s]."""
    each, floors = [], sum(load.mass for load in free.floors)
    boxes = {body.name: box_around(free.shapes[body.name]) for body in free.bodies}

    def overlap(one: str, other: str) -> float:
        (low, high), (lower, upper) = boxes[one], boxes[other]
        return min(high.real, upper.real) - max(low.real, lower.real)

    for body in free.bodies:
        least = NEAR_SHARE * overlap(body.name, body.name)
        above = floors + sum(
            other.mass
            for other in free.bodies
            if other.centroid.imag > body.centroid.imag and overlap(body.name, other.name) > least
        )
        size = max(thickness_of(z) for z in free.shapes[body.name])
        each.append(size * min(1.0, HEAVY * body.mass / (above or body.mass)))
    return SOFTNESS * sqrt(min(each) / free.gravity)


def thickness_of(z: Points) -> float:
    """Return the area of a convex polygon over its largest width [m]."""
    return area_of(z) / float(np.abs(z[:, None] - z).max())


class BlockModel:
    """Free blocks as a model of MuJoCo.

    Parameters
    ----------
    free : FreeBlocks
        The blocks.
    finer : float
        Factor by which contacts are stiffer, and steps shorter, than by the rule.

    Raises
    ------
    InputError
        If MuJoCo is not installed, or a load or a tie cannot be simulated.
    """

    def __init__(self, free: FreeBlocks, finer: float = 1.0) -> None:
        self.free = free
        self.names = [body.name for body in free.bodies]
        self.time_constant = time_constant(free) / finer
        self.scene = scene(free, self.time_constant)
        self._masses = np.array([body.mass for body in free.bodies]) / self.scene.mass
        corners = [np.concatenate([*free.shapes[body.name]]) - body.centroid for body in free.bodies]
        self._radii = np.array([np.abs(each).max() for each in corners])

    @property
    def step(self) -> float:
        """Longest time step [s]."""
        return self.time_constant / STEPS

    @cached_property
    def digest(self) -> str:
        """A digest of all on which motions of these blocks depend, besides the ground motion."""
        rules = READ_AS, STEPS, FALL, TURN, SUNK, SETTLING, BALANCED, LONGEST_TAIL
        return self.scene.digest() + repr((rules, self.free.height, self.time_constant))

    @mujoco_errors()
    def simulate(
        self,
        motion: GroundMotion | None,
        *,
        factor: float = 1.0,
        vertical_factor: float = 1.0,
        start: Reals | None = None,
        tail: float = 0.0,
        most: float = inf,
        friction: bool = False,
    ) -> BlockMotion:
        """Simulate the blocks until they are at rest after the motion, or one of them has fallen.

        Parameters
        ----------
        motion : GroundMotion or None
            Ground acceleration, linear between its samples and zero after the last; held over each step.
        factor, vertical_factor : float
            Factors on both components.
        start : ndarray, shape (blocks, 3), optional
            Displacements from which the blocks start at rest [m, m, rad].
        tail : float
            Time after the motion for which they are followed also at rest [s].
        most : float
            Time after which they are not followed [s].
        friction : bool
            Whether to look at the friction of all pairs that touch.

        Raises
        ------
        SolverError
            If the blocks do not stand by themselves, or MuJoCo fails.
        """
        import mujoco

        model, count = self.scene.model, 3 * len(self.names)
        data = mujoco.MjData(model)
        sample = motion.dt * motion.every if motion is not None else RELEASE_DT
        steps = ceil(sample / self.step)
        model.opt.timestep = sample / steps / self.scene.unit_of_time
        model.opt.gravity[:] = (0.0, 0.0, -1.0)
        self._settle(data)
        rest = data.qpos[:count].copy()
        sunk = self._deepest(data)
        if start is not None:
            data.qpos[:count] += self._normal(start)
            data.qpos[count:] += self._raised(start)
        ended = motion.duration if motion is not None else 0.0
        if motion is not None and motion.vertical is not None:
            ended = max(ended, motion.vertical.duration)
        last = min(ended + max(tail, LONGEST_TAIL), most)
        pushes, lifts = (
            held_over_steps(each, factor_of / self.free.gravity, sample, steps, ended)
            for each, factor_of in (
                (motion, factor),
                (motion.vertical if motion is not None else None, vertical_factor),
            )
        )
        scale = np.array([self.scene.size, self.scene.size, 1.0])
        rates = [np.zeros((len(self.names), 3))]
        moved, failed, fallen, at_rest = [np.zeros((len(self.names), 3))], "", None, False
        if start is not None:
            moved[0] = start
        frictions: dict[tuple[str, str], float] = {}
        k, before = 0, ceil(self.scene.unit_of_time / sample)  # samples, and those in which what rests does not move
        least = self.yielding * self._levels(data)
        balanced = start is not None and bool((self._extents([moved[0], 0 * moved[0]]) > BALANCED * least).any())
        while True:
            for step in range(k * steps, (k + 1) * steps):
                if step < len(pushes):
                    model.opt.gravity[0], model.opt.gravity[2] = -pushes[step], -1.0 - lifts[step]
                elif step == len(pushes):
                    model.opt.gravity[:] = (0.0, 0.0, -1.0)
                mujoco.mj_step1(model, data)
                self._let_slide(data)
                mujoco.mj_step2(model, data)
                if failed := self._fault(data, sunk):
                    break
            if failed:
                break
            k += 1
            now = (data.qpos[:count] - rest).reshape(-1, 3) * scale
            moved.append(now)
            rates.append(data.qvel[:count].reshape(-1, 3) * scale / self.scene.unit_of_time)
            if friction:
                self._note_friction(data, frictions)
            down = (now[:, 1] < -FALL * self.free.height) | (np.abs(now[:, 2]) > TURN)
            fallen = int(down.argmax()) if down.any() else None
            if fallen is not None:
                break
            time = k * sample
            at_rest = time >= ended and k >= before and self._rests(moved[-1 - before :], least)
            if at_rest and balanced:  # beside the critical rotation it leaves its start slowly
                at_rest = bool((self._extents([moved[0], now]) > BALANCED * least).any())
            if (at_rest and time >= ended + tail) or time >= last:
                break
        return BlockMotion(
            time=sample * np.arange(len(moved), dtype=np.float64), moved=np.array(moved), rates=np.array(rates),
            collapsed=k * sample if fallen is not None else nan, failed=failed, at_rest=at_rest, friction=frictions,
            ended_early=not failed and fallen is None and not at_rest and k * sample >= most,
            block=self.names[fallen] if fallen is not None else "",
            off=self.free.edge_passed(self.names[fallen], moved[-1]) if fallen is not None else "",
            least_turn=float((least / self._radii).max()), least=float(least.max()),
        )  # fmt: skip

    def _normal(self, moved: Reals) -> Reals:
        return (np.asarray(moved) / (self.scene.size, self.scene.size, 1.0)).ravel()

    def _raised(self, moved: Reals) -> Reals:
        """Return how far blocks raise the floors that lie on them, over the size of the structure."""
        spots = [(self.names.index(floor.spot.body or ""), floor.spot.at) for floor in self.free.floors]
        arms = np.array([at - self.free.bodies[k].centroid for k, at in spots])
        _, rise, turned = np.reshape([moved[k] for k, _ in spots], (-1, 3)).T
        raised: Reals = (rise + (arms * np.expm1(1j * turned)).imag) / self.scene.size
        return raised

    def _settle(self, data: mujoco.MjData) -> None:
        """Let the blocks sink into their contacts at rest."""
        import mujoco

        mujoco.mj_step(self.scene.model, data, ceil(SETTLING / self.scene.model.opt.timestep))
        moved = np.abs(data.qpos[: 3 * len(self.names)]).reshape(-1, 3).max(axis=1)
        if not moved.max() < SUNK:
            name = self.names[int(moved.argmax())]
            raise SolverError(f"as free blocks it does not stand by itself: {name} moves")
        data.qvel[:] = 0.0

    @staticmethod
    def _let_slide(data: mujoco.MjData) -> None:
        """Let contacts slide without opening.

        Contact forces minimise a convex function, by which a contact that slides also opens: its faces part at mu times
        the rate at which it is braked, so that what slides hops and tilts. What they part by is taken from the rate at
        which the faces are to part.
        """
        if contacts := data.ncon:
            at, velocity = data.contact.efc_address[data.contact.dim > 1], data.efc_vel
        if contacts and at.size:
            braked = data.efc_KBIP[at + 1, 1] * np.sqrt(velocity[at + 1] ** 2 + velocity[at + 2] ** 2)
            data.efc_aref[at] -= data.contact.friction[data.contact.dim > 1, 0] * braked

    @cached_property
    def _limits(self) -> Reals:
        return SUNK / self.scene.size * self.scene.sizes

    def _deepest(self, data: mujoco.MjData) -> Reals:
        """Return the depth of each geometry in another, over the size of the structure, shape (geometries,)."""
        deepest = np.zeros(len(self.scene.owners))
        depth = -data.contact.dist
        np.maximum.at(deepest, data.contact.geom.ravel(), np.repeat(depth, 2))
        return deepest

    def _fault(self, data: mujoco.MjData, sunk: Reals) -> str:
        """Return why a state is no answer, in words; empty if it is one."""
        if diverged(data):
            return "a step diverged"
        if not data.ncon or -data.contact.dist.min() <= self._limits.min():
            return ""
        limits = (self._limits + sunk)[data.contact.geom].min(axis=1)
        deep = -data.contact.dist > limits
        if deep.any():
            one, other = (self.scene.owners[k] or "the ground" for k in data.contact.geom[int(deep.argmax())])
            return f"{one} and {other} sink into each other by more than 1 per mille of their size"
        return ""

    @cached_property
    def yielding(self) -> float:
        """Distance by which a joint gives way to weight while nothing moves, in sqrt(size/g): it sinks and creeps [m].

        What moves by less is noise of contacts. A slender block turns by some 3e-4 of its critical rotation, then, less
        than what counts as uplift.
        """
        friction = max(self.free.friction, *self.free.frictions.values(), 0.0)
        return self.free.gravity * sinking(self.time_constant, self.scene.unit_of_time, friction)

    def _levels(self, data: mujoco.MjData) -> Reals:
        """Return how many joints there are at least between each block and the ground: creep adds up over them."""
        joints = [(self.scene.owners[one], self.scene.owners[other]) for one, other in data.contact.geom.tolist()]
        levels, level = {"": 0}, 0
        while above := {
            one for pair in joints for one, other in (pair, pair[::-1]) if other in levels and one not in levels
        }:
            level += 1
            levels |= dict.fromkeys(above, level)
        return np.array([levels.get(name, level + 1) for name in self.names], dtype=np.float64)

    def _extents(self, moved: Sequence[Reals]) -> Reals:
        """Return how far the corners of each block move at most [m], shape (blocks,)."""
        across, up, turned = np.ptp(np.array(moved), axis=0).T
        extents: Reals = np.hypot(across, up) + self._radii * turned
        return extents

    def _rests(self, moved: Sequence[Reals], least: Reals) -> bool:
        """Return whether no corner of a block moves farther than contacts give way by themselves.

        A bare rate would not tell: a block that turns back is slow, contacts chatter as it comes to rest, and the
        energy of a small block is none beside that of a building.
        """
        few = moved[:: len(moved) // 8 + 1]  # they tell of most motions, and are fast
        return all(bool((self._extents(each) <= least).all()) for each in (few, moved))

    def _note_friction(self, data: mujoco.MjData, most: dict[tuple[str, str], float]) -> None:
        """Raise the largest shear over normal force of the pairs that touch."""
        import mujoco

        sums: dict[tuple[str, str], Reals] = {}
        force = np.zeros(6)
        for k in range(data.ncon):
            mujoco.mj_contactForce(self.scene.model, data, k, force)
            one, other = sorted(self.scene.owners[geometry] for geometry in data.contact.geom[k])
            shear = data.contact.frame[k].reshape(3, 3)[1:].T @ force[1:3]
            sums[one, other] = sums.get((one, other), np.zeros(4)) + np.array([force[0], *shear])
        for pair, (normal, *shear) in sums.items():
            if normal > LIGHT * min(self._weights[name] for name in pair if name):
                most[pair] = max(most.get(pair, 0.0), float(np.linalg.norm(shear)) / normal)

    @cached_property
    def _weights(self) -> dict[str, float]:
        return dict(zip(self.names, self._masses.tolist(), strict=True))


def sinking(time_constant: float, unit_of_time: float, friction: float) -> float:
    """Return the distance by which a joint gives way in a unit of time, over the gravitational acceleration [s2]."""
    creep = friction * (1 / IMPEDANCE[0] - 1) / SLIP_STIFFNESS / 2  # a force over what resists it, and 2/T
    return time_constant * (time_constant + creep * unit_of_time)


def held_over_steps(motion: GroundMotion | None, factor: float, sample: float, steps: int, ended: float) -> list[float]:
    """Return the ground acceleration in the middle of each step, over g, until the motion ends."""
    count = ceil(ended / sample - ROUNDING) * steps
    if motion is None:
        return [0.0] * count
    middles = (np.arange(count) + 0.5) * (sample / steps)
    times = np.arange(motion.npts) * motion.dt
    held: list[float] = (factor * np.interp(middles, times, motion.acceleration, right=0.0)).tolist()
    return held
