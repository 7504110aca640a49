"""How far the joints of an assembly open beside a motion that takes no notice of it, to the end of a record.

A joint that would pull, or slip, is released alone and followed until it is shut again.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from math import nan
from pathlib import Path
from typing import NamedTuple

import numpy as np
import yaml

from .assemblies import Assembly, series, summed
from .history import Ground, History, simulate
from .series import Reals
from .structures import SIDES

NODES = 12  # in each sample of the record
MARK = 0.005
KNOWN = {"mechanism", "name", "density", "depth", "blocks", "ground", "friction"}
SHEAR = 2  # of a contact, after its two ends


class Opened(NamedTuple):
    """The largest opening over D_cr, when `MARK` is first passed [s], and D_cr [m]."""

    assembly: Assembly
    motion: History
    largest: float
    passed: float
    reach: float

    def turned(self, block: str, s: int) -> float:
        """How far a block turns at most in a direction [rad]."""
        phi = max(peak.phi for peak in self.motion.peaks if peak.side == s)
        return float(abs(self.assembly.body(self.assembly.place(s, phi), block).psi))


def openings(file: Path, record: Path, factor: float) -> Opened:
    """Follow an assembly under a record of two columns, times and shares of g."""
    assembly = Assembly(file=yaml.safe_load(file.read_text(encoding="utf-8")))
    assert assembly.file.keys() <= KNOWN
    times, shares = np.loadtxt(record, delimiter=",", skiprows=1).T
    push = factor * assembly.gravity * shares
    motion = simulate(assembly, Ground(times, push), until=times[-1])
    sides, joints = {s: _Side(assembly, s) for s in SIDES}, _Joints(len(assembly.contacts))
    reach = min(_reach(assembly, s) for s in SIDES)
    struck = {impact.time: impact for impact in motion.impacts}
    largest, passed = 0.0, nan
    for start, end, s, solution in motion.flights:
        if start in motion.uplifts:
            joints.rest()
        nodes = np.linspace(start, end, 1 + int(np.ceil((end - start) * NODES / times[1])))
        phi, rate = solution(nodes)[:2]
        accelerations = sides[s].accelerations(phi, rate, np.interp(nodes, times, push))
        for (before, now), those in zip(pairwise(nodes), pairwise(accelerations), strict=True):
            joints.go_on(now - before, *those)
            share = joints.opening / reach
            if largest <= MARK < share:
                passed = float(now)
            largest = max(largest, share)
        if end in struck:
            joints.strike(sides[s], sides[-s], struck[end].before)
    return Opened(assembly, motion, largest, passed, reach)


def _reach(assembly: Assembly, s: int) -> float:
    """The farthest that a centroid is at phi_cr from where it rests."""
    phi = assembly.critical(s)
    assert phi is not None, "no phi_cr"
    bodies = zip(assembly.place(s, phi), assembly.pieces(), strict=True)
    return max(float(abs(body.x + 1j * body.y - piece.centre)) for body, piece in bodies)


class _Side:
    """What contacts bear in one direction: at each of its ends and as shear, and 0 where it does not bear."""

    def __init__(self, assembly: Assembly, s: int) -> None:
        self.assembly, self.path, self.rows = assembly, assembly.paths[s], assembly.weakest[s][0]
        self.friction = assembly.file.get("friction")
        self.ends = self._by_contact(np.ones(len(self.rows)))[:, :SHEAR]
        self.forces = series(lambda phi: [self._forces(each) for each in phi])
        self.compliances = series(lambda phi: [self._compliances(each) for each in phi])

    def _by_contact(self, values: Reals) -> Reals:
        found = np.zeros((len(self.assembly.contacts), 3, *values.shape[1:]))
        for row, value in zip(self.rows, values, strict=True):
            found[row.contact, SHEAR if row.end is None else row.end] = value
        return found

    def _borne(self, phi: float, changes: Sequence[Reals]) -> Reals:
        """What contacts bear where velocities change by each of these, and by as much of the motion as is free."""
        moved, speed, _ = summed(self.path, phi)
        _, slopes = self.assembly.parted(self.rows, moved)
        along, *momenta = self.assembly.mass * np.array([speed, *changes])
        solved = np.linalg.solve(np.column_stack([slopes.T, -along]), np.transpose(momenta))
        return self._by_contact(solved[:-1])

    def _forces(self, phi: float) -> Reals:
        """The factors of 1, u and phi.^2."""
        fall, shift = self.assembly.gravity * self.assembly.all_along(0.0, 1.0), self.assembly.all_along(1.0, 0.0)
        return self._borne(phi, [fall, shift, summed(self.path, phi)[2]])

    def _compliances(self, phi: float) -> Reals:
        """The accelerations of ends and slips let go alone, over what they bore; without a friction nothing slips."""
        _, slopes = self.assembly.parted(self.rows, summed(self.path, phi)[0])
        found = self._by_contact(1 / np.diag(np.linalg.inv(slopes / self.assembly.mass @ slopes.T)))
        return found * [1.0, 1.0, self.friction is not None]

    def _released(self, borne: Reals, compliances: Reals) -> Reals:
        """How fast each end opens, and each contact slips either way, if let go."""
        ends, shear = borne[..., :SHEAR], borne[..., SHEAR:]
        grip = (self.friction or 0.0) * np.maximum(ends.sum(axis=-1, keepdims=True), 0.0)
        return -compliances[..., [0, 1, SHEAR, SHEAR]] * np.concatenate([ends, grip - shear, grip + shear], axis=-1)

    def accelerations(self, phi: Reals, rate: Reals, u: Reals) -> Reals:
        """At many instants."""
        factors = np.stack([np.ones(len(u)), u, rate**2], axis=-1)
        borne = np.einsum("ncrk,nk->ncr", summed(self.forces, phi), factors)
        return self._released(borne, summed(self.compliances, phi))

    def thrown(self, other: _Side, rate: float) -> Reals:
        """At what rates joints fly open where this direction begins, and the other ended at `rate`."""
        impulses = self._borne(0.0, [rate * summed(other.path, 0.0)[1]])[..., 0]
        return np.maximum(self._released(impulses, summed(self.compliances, 0.0)), 0.0)


class _Joints:
    """How far both ends of each contact are open, and how far it has slipped either way."""

    def __init__(self, count: int) -> None:
        self.far, self.rate = np.zeros((2, count, 4))

    @property
    def opening(self) -> float:
        """The largest; slips either way are counted together."""
        return float(max(self.far[:, :2].max(), self.far[:, 2:].sum(axis=1).max()))

    def rest(self) -> None:
        """All shut; what has slipped stays where it is."""
        self.far[:, :2] = self.rate[:] = 0.0

    def go_on(self, h: float, first: Reals, last: Reals) -> None:
        """By a short step: what is shut stays so unless it is thrown open, and nothing rebounds or slips back."""
        rate = self.rate + h * (first + last) / 2
        rate[:, 2:] = np.maximum(rate[:, 2:], 0.0)
        far = self.far + h * (self.rate + rate) / 2
        shut = far[:, :2] <= 0
        far[:, :2][shut] = rate[:, :2][shut] = 0.0
        self.far, self.rate = far, rate

    def strike(self, old: _Side, new: _Side, rate: float) -> None:
        """Joints that bear at other ends than before start anew, and what the impulses do not press flies open."""
        anew = (old.ends != new.ends).any(axis=1)
        self.far[anew, :2] = self.rate[anew, :2] = 0.0
        self.rate += new.thrown(old, rate)
