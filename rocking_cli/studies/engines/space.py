"""One free body in three dimensions under a ground motion, simulated by MuJoCo: experimental.

A polygonal foot touches the ground at the corners of its hull. A round foot is MuJoCo's cylinder, whose lowest point is
exact: a mesh of 64 sides rocks from corner to corner, by which its peaks are 4 % off. Contacts hold the velocity of the
points that touch; where these change, as on a rim that rolls, MuJoCo leaves out a part of their acceleration, so that
the rim slips and a steady wobble is 1 % off after each round. `_correct_contacts` adds it: 0.1 % are left.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import asin, ceil, cos, hypot, nan, sin
from typing import Any

import numpy as np

from rocking_cli.arrays import Reals
from rocking_cli.core.polygons import hull_of
from rocking_cli.dynamics.deck import RELEASE_DT
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.studies.engines.blocks import (
    LONGEST_TAIL,
    SETTLING,
    SOFTNESS,
    STEPS,
    SUNK,
    held_over_steps,
    sinking,
    thickness_of,
)
from rocking_cli.studies.engines.scene import compiled, diverged, engine_version, mujoco_errors, softness
from rocking_cli.studies.engines.solid_body import SolidBody
from rocking_cli.studies.engines.space_history import ROLLING, CheckedHistory, SpaceHistory

HALVED = 2.0  # factor by which step and softness of the second simulation are smaller
ROUNDS = 10.0  # in sqrt(size/g), time after the motion from which what cannot overturn has reached its peak
UPRIGHT = (0.0, 0.0, -1.0)
DISC = 0.1  # height of the cylinder that is a round foot, over its radius; without effect


def follow_twice(
    solid: SolidBody, x: GroundMotion, y: GroundMotion | None = None, z: GroundMotion | None = None, **how: Any
) -> CheckedHistory:
    """Simulate a body in three dimensions, and again with half of step and softness; see `follow_in_space`."""
    return CheckedHistory(*(follow_in_space(solid, x, y, z, halved=halved, **how) for halved in (False, True)))


@mujoco_errors()
def follow_in_space(
    solid: SolidBody,
    x: GroundMotion | None,
    y: GroundMotion | None = None,
    z: GroundMotion | None = None,
    *,
    halved: bool = False,
    tail: float = 0.0,
    start_tilt: float = 0.0,
    azimuth: float = 0.0,
    spin: Sequence[float] = (0.0, 0.0, 0.0),
    only_outcome: bool = False,
) -> SpaceHistory:
    """Simulate a body in three dimensions until it is at rest after the motion, or has overturned.

    Parameters
    ----------
    solid : SolidBody
        The body.
    x, y, z : GroundMotion, optional
        Components of the ground acceleration along the axes of the body, z upwards: linear between samples and zero
        after the last; held over each step.
    halved : bool
        Whether step and softness are half of those by the rule.
    tail : float
        Time after the motion for which it is followed also at rest [s].
    start_tilt, azimuth : float
        Tilt in which it starts, and the direction to which it leans [rad].
    spin : sequence of float
        Angular velocity about its own axes with which it starts [rad/s]; the point that touches is at rest.
    only_outcome : bool
        Whether to end after the motion as soon as its energy lets it tilt no farther; later, lets it not overturn.

    Raises
    ------
    InputError
        If MuJoCo is not installed.
    SolverError
        If MuJoCo fails.
    """
    engine_version()
    motion = _Motion(solid, HALVED if halved else 1.0, x.dt * x.every if x is not None else RELEASE_DT)
    if start_tilt:
        motion.start(start_tilt, azimuth, spin)
    return motion.simulate((x, y, z), tail, only_outcome=only_outcome)


class _Motion:
    """A body as a model of MuJoCo, whose size, weight and gravitational acceleration are 1, and its state."""

    def __init__(self, solid: SolidBody, finer: float, sample: float) -> None:
        import mujoco

        self.solid, self.sample = solid, sample
        silhouettes = (solid.points[:, k] + 1j * solid.points[:, 2] for k in (0, 1))
        thickness = min(thickness_of(hull_of(each)) for each in silhouettes)
        constant = SOFTNESS * (thickness / solid.gravity) ** 0.5 / finer
        self.least = solid.gravity * sinking(constant, solid.unit_of_time, solid.friction)
        self.steps = ceil(sample * STEPS / constant)
        spec, size, kinds = mujoco.MjSpec(), solid.size, mujoco.mjtGeom
        touch = {"friction": [solid.friction, 0.0, 0.0], "condim": 3, **softness(constant / solid.unit_of_time)}
        spec.worldbody.add_geom(type=kinds.mjGEOM_PLANE, size=[0, 0, 1], **touch)
        xx, yy, zz, xy, xz, yz = (solid.inertia / size**2)[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]].tolist()
        body = spec.worldbody.add_body(
            pos=[0, 0, solid.level / size], ipos=[0, 0, 0], mass=1.0, fullinertia=[xx, yy, zz, xy, xz, yz],
            explicitinertial=True,
        )  # fmt: skip
        body.add_freejoint()
        if solid.radius:
            flat = DISC * solid.radius / 2
            at = [0.0, 0.0, (flat - solid.level) / size]
            disc = [solid.radius / size, flat / size, 0.0]
            body.add_geom(type=kinds.mjGEOM_CYLINDER, size=disc, pos=at, mass=0.0, **touch)
        else:
            away = (solid.points - [0.0, 0.0, solid.level]) / size
            spec.add_mesh(name="body", uservert=away.ravel().tolist())
            body.add_geom(type=kinds.mjGEOM_MESH, meshname="body", mass=0.0, **touch)
        self.model = compiled(spec)
        self.model.opt.timestep = sample / self.steps / solid.unit_of_time
        self.model.opt.gravity[:] = UPRIGHT
        self.data = mujoco.MjData(self.model)
        mujoco.mj_step(self.model, self.data, ceil(SETTLING / self.model.opt.timestep))
        self.data.qvel[:] = 0.0
        self.rest = self.data.qpos.copy()
        self.sunk = -float(self.data.contact.dist.min(initial=0.0))

    def start(self, tilt: float, azimuth: float, spin: Sequence[float]) -> None:
        """Lean the body towards an azimuth, over the point of its foot that is farthest there."""
        import mujoco

        position, turn, frame = self.data.qpos[:3], self.data.qpos[3:], np.zeros(9)
        turn[:] = [cos(tilt / 2), -sin(tilt / 2) * sin(azimuth), sin(tilt / 2) * cos(azimuth), 0.0]
        mujoco.mju_quat2Mat(frame, turn)
        axes = frame.reshape(3, 3)
        points = self.solid.points
        if self.solid.radius:
            points = self.solid.radius * np.array([[cos(azimuth), sin(azimuth), 0.0]])
        touching = points[(points @ axes[2]).argmin()]
        arm = axes @ (touching - [0.0, 0.0, self.solid.level]) / self.solid.size
        position[:] = touching / self.solid.size - arm + [0.0, 0.0, self.rest[2] - self.solid.level / self.solid.size]
        rates = np.array(spin) * self.solid.unit_of_time
        self.data.qvel[:3], self.data.qvel[3:] = np.cross(arm, axes @ rates), rates

    def simulate(self, components: Sequence[GroundMotion | None], tail: float, *, only_outcome: bool) -> SpaceHistory:
        import mujoco

        solid, sample, data = self.solid, self.sample, self.data
        ended = max((each.duration for each in components if each is not None), default=0.0)
        pushes = [held_over_steps(each, 1 / solid.gravity, sample, self.steps, ended) for each in components]
        pulls, last = UPRIGHT - np.array(pushes).T, ended + max(tail, LONGEST_TAIL)
        states, deepest, k = [np.concatenate([data.qpos, data.qvel])], 0.0, 0
        before = ceil(solid.unit_of_time / sample)  # samples in which what rests does not move
        tilts, overturned, failed, at_rest = [0.0], False, "", False
        while not failed and not overturned and k * sample < last and not (at_rest and k * sample >= ended + tail):
            for step in range(k * self.steps, (k + 1) * self.steps):
                if step <= len(pulls):
                    self.model.opt.gravity[:] = pulls[step] if step < len(pulls) else UPRIGHT
                mujoco.mj_step1(self.model, data)
                if data.ncon:
                    deepest = max(deepest, -float(data.contact.dist.min()))
                    self._correct_contacts()
                mujoco.mj_step2(self.model, data)
            k += 1
            states.append(np.concatenate([data.qpos, data.qvel]))
            if diverged(data):
                failed = "a step diverged"
            elif deepest > SUNK + self.sunk:
                failed = "it sinks into the ground by more than 1 per mille of its size"
            tilts.append(2 * asin(min(hypot(*data.qpos[4:6].tolist()), 1.0)))
            overturned = tilts[-1] > solid.fallen
            if k * sample >= ended and k >= before:
                waited = k * sample - ended > ROUNDS * solid.unit_of_time
                decided = only_outcome and not self._may_reach(solid.alpha if waited else max(tilts))
                at_rest = decided or self._rests(states[-1 - before :])
        places, turned, rates = np.split(np.array(states), [3, 7], axis=1)
        w, x, y, z = turned.T
        axis = np.stack([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x**2 + y**2)], axis=1)
        return SpaceHistory(
            solid=solid, time=sample * np.arange(k + 1.0), turned=turned,
            moved=solid.size * (places - self.rest[:3]) + solid.level * ([0.0, 0.0, 1.0] - axis),
            rates=rates * np.repeat([solid.size, 1.0], 3) / solid.unit_of_time,
            overturning_time=k * sample if overturned else nan, at_rest=at_rest, failed=failed,
        )  # fmt: skip

    def _correct_contacts(self) -> None:
        """Let contacts slide without opening, as `BlockModel` does, and roll without slipping.

        Taken from the acceleration that contacts hold is omega x dr/dt of the points that touch, r from the centroid. A
        corner turns with the body; the point of a rim that touches alone turns with the vertical plane in which the
        axis leans, at the rate of its azimuth.
        """
        data = self.data
        p, q, r = u, v, w = data.cvel[1, :3].tolist()  # of the body, and of the points
        a, b, c = data.xmat[1, 2::3].tolist()
        squared = a * a + b * b  # of the tilt
        if self.solid.radius and data.ncon == 1 and squared > (ROLLING * self.solid.alpha) ** 2:
            lean = (q * a - p * b) / squared
            u, v, w = -lean * b, lean * a, r - c * (p * a + q * b) / squared
        opening = self.solid.friction * float(data.efc_KBIP[0, 1])
        product, (x0, y0, z0), rows = p * u + q * v + r * w, data.xpos[1].tolist(), []
        for (x, y, z), (_, along, across) in zip(
            data.contact.pos.tolist(), data.efc_vel.reshape(-1, 3).tolist(), strict=True
        ):
            share = p * (x - x0) + q * (y - y0) + r * (z - z0)
            rows += [  # upwards, along y and against x, as contacts with level ground have it
                opening * hypot(along, across) + w * share - product * (z - z0),
                v * share - product * (y - y0),
                product * (x - x0) - u * share,
            ]
        data.efc_aref[:] -= rows

    def _may_reach(self, tilt: float) -> bool:
        """Return whether the energy is enough for a tilt; of all directions the weaker side needs least."""
        solid, (velocity, omega) = self.solid, np.split(self.data.qvel, 2)
        moving = velocity @ velocity + omega @ solid.inertia @ omega / solid.size**2
        level = solid.level * cos(max(solid.alpha - tilt, 0.0)) / cos(solid.alpha) / solid.size
        return float(self.data.qpos[2] + moving / 2) > level

    def _rests(self, states: Sequence[Reals]) -> bool:
        """Return whether no point of the body moves farther than contacts give way by themselves."""
        place, turn = np.split(np.ptp(np.array(states)[:, :7], axis=0), [3])
        return bool(self.solid.size * (np.linalg.norm(place) + 2 * np.linalg.norm(turn)) <= self.least)
