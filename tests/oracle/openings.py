"""How far the joints of an assembly open beside a history, by another road than the program's.

Every row stands for itself: velocities of points by the motion of their blocks, forces by least squares at each of
many rotations, no cubics over q and no bounds; the motion is that under a record with eight times as many samples. Only
where blocks are and how they move is taken from the program.
"""

from __future__ import annotations

import numpy as np

from mechanisms._assembly.mechanism import Opening
from rocking_cli import GroundMotion, respond
from rocking_cli.core import Direction

FINER = 8
NODES = 129
MARKS = (0.005, 0.01)


def openings(structure, motion, factor=1.0):
    """Return the largest opening over D_cr, and when shares of it are first passed [s], None: never."""
    time = np.arange(motion.npts) * motion.dt
    fine = np.arange((motion.npts - 1) * FINER + 1) * motion.dt / FINER
    push = factor * np.interp(fine, time, motion.acceleration)
    history = respond(structure, GroundMotion("fine", motion.dt / FINER, push), models=("nonlinear",))["nonlinear"]
    assert not history.unknown  # the caller sets `opening: 1`
    sides = {direction: _Side(structure, direction) for direction in structure.directions}
    reach = min(side.reach for side in sides.values())
    contacts = len(structure._contacts)
    state = {name: np.zeros((contacts, 2)) for name in ("gap", "gap rate", "slip", "slip rate")}
    largest, first, last = 0.0, dict.fromkeys(MARKS), None
    for now, sign, phi, rate, is_impact in _moments(history):
        if not sign:
            state["gap"][:] = state["gap rate"][:] = state["slip rate"][:] = 0.0
            last = None
            continue
        side = sides[Direction(sign)]
        u = float(np.interp(now, fine, push, right=0.0))
        accelerations = side.accelerations(phi, rate, u)
        if last is not None and last[1] == sign and now > last[0]:
            for kind, was, new in zip(("gap", "slip"), last[2], accelerations, strict=True):
                _advance(state, kind, was, new, now - last[0])
        last = now, sign, accelerations
        if is_impact:
            other = sides[Direction(sign).opposite]
            _strike(state, side, other, rate, structure.eta(Direction(sign)))
            rate *= structure.eta(Direction(sign))
            last = now, -sign, other.accelerations(0.0, rate, u)
        share = max(state["gap"].max(), state["slip"].sum(axis=1).max()) / reach
        largest = max(largest, share)
        for mark in MARKS:
            if share > mark and first[mark] is None:
                first[mark] = now
    return largest, first


def _moments(history):
    """Samples until it overturns and impacts, in order: time, sign, rotation, rate, whether it is an impact."""
    end = history.overturning_time if history.overturned else np.inf
    samples = [
        (time, int(np.sign(phi) or np.sign(rate)), abs(phi), abs(rate), False)
        for time, phi, rate in zip(history.time, history.phi, history.rate, strict=True)
        if np.isfinite(phi) and time <= end
    ]
    impacts = [(time, int(sign), 0.0, rate, True) for time, sign, rate in history.impacts if time <= end]
    return sorted(samples + impacts, key=lambda moment: moment[0])


def _advance(state, kind, was, new, h):
    x0, v0 = state[kind], state[f"{kind} rate"]
    x, v = x0.copy(), v0.copy()
    for place in np.ndindex(x0.shape):
        a0, a1 = was[place], new[place]
        if v0[place] > 0 or (kind == "gap" and x0[place] > 0):
            v[place] = v0[place] + h * (a0 + a1) / 2
            x[place] = x0[place] + h * v0[place] + h * h * (2 * a0 + a1) / 6
            if kind == "gap" and x[place] <= 0:
                x[place] = v[place] = 0.0
            elif kind == "slip" and v[place] <= 0:
                x[place] = x0[place] + h * v0[place] ** 2 / (v0[place] - v[place]) / 2
                v[place] = 0.0
        elif a1 > 0:
            left = h if a0 >= 0 else h * a1 / (a1 - a0)
            x[place] += left * left * (2 * max(a0, 0.0) + a1) / 6
            v[place] = left * (max(a0, 0.0) + a1) / 2
    state[kind][:], state[f"{kind} rate"][:] = x, v


def _strike(state, old, new, rate, eta):
    """Let joints fly open that the impulses do not press together."""
    jump = new.mass * (eta * new.along[0] + old.along[0]) * rate
    impulse = np.linalg.lstsq(new.rows[0].T, jump, rcond=None)[0]
    compliance = new.compliance[0]
    for k in range(len(state["gap"])):
        if old.ends.get(k) != new.ends.get(k):
            state["gap"][k] = state["gap rate"][k] = 0.0
    for k, normals, shear, friction in new.contacts:
        total = sum(impulse[row] for row in normals)
        for end, row in zip(new.ends[k], normals, strict=True):
            state["gap rate"][k, end] += compliance[row] * max(0.0, -impulse[row])
        if friction is not None:
            for sense, sign in enumerate((1, -1)):
                left = friction * max(total, 0.0) - sign * impulse[shear]
                state["slip rate"][k, sense] += compliance[shear] * max(0.0, -left)


class _Side:
    """One direction of an assembly, over rotations."""

    def __init__(self, structure, direction):
        critical = structure.critical_rotation(direction)
        self.phi = np.linspace(0.0, min(0.999 * structure.limit(direction), 1.5 * critical), NODES)
        bodies, motions = structure.weighed(), structure.motion(self.phi, direction)
        self.mass = np.array([m for body in bodies for m in (body.mass, body.mass, body.inertia)])
        self.column = {body.name: 3 * k for k, body in enumerate(bodies)}
        self.motions = {body.name: motion for body, motion in zip(bodies, motions, strict=True)}
        places = [motion.carry(body.centroid) for body, motion in zip(bodies, motions, strict=True)]
        self.centres = {body.name: place[0] for body, place in zip(bodies, places, strict=True)}
        self.along = self._columns([place[1] for place in places], [motion.dpsi for motion in motions])
        bend = self._columns([place[2] for place in places], [motion.ddpsi for motion in motions])
        self.contacts, self.ends, self.rows = self._joints(structure, direction)
        at, g = structure.coefficients(self.phi, direction), structure.gravity
        down, across = np.tile([0.0, 1.0, 0.0], len(bodies)), np.tile([1.0, 0.0, 0.0], len(bodies))
        turning = [-(g * at.G + at.Q) / at.I, -int(direction) * at.B / at.I, -at.J / at.I]
        more = [g * down, across, bend]
        needed = [self.mass * (self.along * turn[:, None] + extra) for turn, extra in zip(turning, more, strict=True)]
        self.forces = np.array([
            np.linalg.lstsq(rows.T, np.stack([each[k] for each in needed], axis=1), rcond=None)[0]
            for k, rows in enumerate(self.rows)
        ])  # fmt: skip
        self.compliance = np.array([1 / np.diag(np.linalg.inv(rows / self.mass @ rows.T)) for rows in self.rows])
        there = structure.motion(np.array([critical]), direction)
        self.reach = max(
            abs(motion.carry(body.centroid)[0][0] - body.centroid) for body, motion in zip(bodies, there, strict=True)
        )

    def _columns(self, points, turns):
        found = np.zeros((NODES, 3 * len(points)))
        for k, (point, turn) in enumerate(zip(points, turns, strict=True)):
            found[:, 3 * k], found[:, 3 * k + 1], found[:, 3 * k + 2] = point.real, point.imag, turn
        return found

    def _joints(self, structure, direction):
        contacts, ends, rows = [], {}, []
        states = structure._groups(direction).states
        for k, (contact, state) in enumerate(zip(structure._contacts, states, strict=True)):
            if state is Opening.LIFTED:
                continue
            where = {Opening.START: (0,), Opening.END: (1,)}.get(state, (0, 1))
            face = contact.face_at(where[0]) if len(where) == 1 else contact.a
            turn = np.exp(1j * self.motions[face].psi) if face in self.motions else np.ones(NODES)
            normal = contact.normal * turn
            first = len(rows)
            rows += [self._row(contact, contact.ends[end], normal) for end in where]
            rows.append(self._row(contact, sum(contact.ends[end] for end in where) / len(where), -1j * normal))
            contacts.append((k, list(range(first, len(rows) - 1)), len(rows) - 1, contact.friction))
            ends[k] = where
        return contacts, ends, np.stack(rows, axis=1)

    def _row(self, contact, point, way):
        found = np.zeros((NODES, len(self.mass)))
        at = self.motions[contact.a].carry(point)[0] if contact.a in self.motions else np.full(NODES, point)
        for name, sign in ((contact.b, 1), (contact.a, -1)):
            if name in self.column:
                k, arm = self.column[name], at - self.centres[name]
                found[:, k], found[:, k + 1] = sign * way.real, sign * way.imag
                found[:, k + 2] = sign * (arm.conjugate() * way).imag
        return found

    def accelerations(self, phi, rate, u):
        """How fast each end would open, and each joint slip in either sense; -inf where there is none."""
        place = min(phi, self.phi[-1] * (1 - 1e-12)) / self.phi[1]
        k, x = int(place), place - int(place)
        force = ((1 - x) * self.forces[k] + x * self.forces[k + 1]) @ np.array([1.0, u, rate * rate])
        compliance = (1 - x) * self.compliance[k] + x * self.compliance[k + 1]
        most = max(self.ends) + 1
        opens, slips = np.full((most, 2), -1.0), np.full((most, 2), -1.0)
        for joint, normals, shear, friction in self.contacts:
            for end, row in zip(self.ends[joint], normals, strict=True):
                opens[joint, end] = -compliance[row] * force[row]
            if friction is not None:
                total = max(sum(force[row] for row in normals), 0.0)
                for sense, sign in enumerate((1, -1)):
                    slips[joint, sense] = -compliance[shear] * (friction * total - sign * force[shear])
        return opens, slips
