"""The same block by a rigid-body engine with contacts, PyBullet: an independent idea of what happens, and its price."""

from __future__ import annotations

from math import asin, isfinite

import pybullet

from rocking_cli import GroundMotion

STEPS = 10  # of the engine to a sample


def by_pybullet(width: float, height: float, motion: GroundMotion) -> float:
    """Largest rotation over the slenderness of a block on a rough floor, shaken by the forces of inertia."""
    client = pybullet.connect(pybullet.DIRECT)
    try:
        pybullet.setTimeStep(motion.dt / STEPS)
        pybullet.setGravity(0, 0, -9.80665)
        floor = pybullet.createMultiBody(0, pybullet.createCollisionShape(pybullet.GEOM_PLANE))
        half = [width / 2, width, height / 2]  # as deep as twice the width: it rocks in one plane
        shape = pybullet.createCollisionShape(pybullet.GEOM_BOX, halfExtents=half)
        body = pybullet.createMultiBody(1000.0, shape, basePosition=[0, 0, height / 2])
        for each in (floor, body):
            pybullet.changeDynamics(each, -1, lateralFriction=2.0, restitution=0.0, linearDamping=0, angularDamping=0)
        worst = 0.0
        for a in motion.acceleration.tolist():
            for _ in range(STEPS):
                place, turn = pybullet.getBasePositionAndOrientation(body)
                pybullet.applyExternalForce(body, -1, [-1000.0 * a, 0, 0], place, pybullet.WORLD_FRAME)
                pybullet.stepSimulation()
                worst = max(worst, abs(2 * asin(min(1.0, abs(turn[1])))))
        return worst if isfinite(worst) else float("nan")
    finally:
        pybullet.disconnect(client)
