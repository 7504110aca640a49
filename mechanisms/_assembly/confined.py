"""Mechanisms without dilation of confined blocks, such as those between a floor and a ceiling or between two walls.

By associated flow a joint that slides also opens. Blocks that cannot move apart then never slide, however small their
friction. They are those that forces within the friction of the joints can compress without any load: such forces
balance one another. How large they are is not known, so that the least favourable ones count.

In a mechanism without dilation, each point of a joint has either no force or no opening, and each joint has either no
slip, or the shear that its friction allows, against the slip. A linear programme knows forces and velocities, but not
these alternatives: branch and bound decides them one after the other, each time the one that is violated most. The
number of programmes ends a search that is too long, and not the time, so that every computer solves the same ones.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mechanisms._assembly.blocks import NoAnswer
from mechanisms._assembly.problem import MAX_MULTIPLIER, AssemblyProblem, moving
from mechanisms._assembly.programme import Sparse, beside, from_blocks, from_entries, least, unit_columns
from rocking_cli.core import Reals
from rocking_cli.core.contacts import MASONRY_FRICTION

MIN_DECREASE = 0.01  # least relative decrease of the multiplier, below that by associated flow, that is searched
MAX_JOINT_PROGRAMMES, MAX_JOINTS = 10_000, 100  # limits of a search: joints times programmes solved, and joints
ZERO_PRODUCT = 1e-9  # forces over the weight, and rates of opening or slip over the unit velocity, that count as zero
SIMPLEST_INCREASE = 1e-9  # relative increase of the multiplier that is allowed for the simplest mechanism
LAST_JOINT_COST = 0.01  # additional cost of the last joint relative to the first, to choose among equal mechanisms
MOVING_SPEED = 1e-6  # speed from which a block moves, over the fastest one
MAX_GUIDE_FORCE = 1e3  # largest force of a guide, over the sum of all normal forces


@dataclass(frozen=True, eq=False)
class Undilated:
    """Mechanisms without dilation of a confined assembly.

    Parameters
    ----------
    multiplier : float or None
        The least multiplier; None if no mechanism was found that starts earlier by more than 1 % than by associated
        flow.
    field : ndarray
        Velocities of the blocks, without units.
    state : ndarray
        Forces in the joints over the weight, as rows of `Bearings.rates`.
    falls : tuple of str
        Blocks that move under the weight alone.
    complete : bool
        Whether the search was complete; if not, an even lower multiplier may exist.
    """

    multiplier: float | None
    field: Reals
    state: Reals
    falls: tuple[str, ...]
    complete: bool


def undilated(problem: AssemblyProblem, associated: float) -> Undilated | None:
    """Return what is known of mechanisms without dilation; None if no blocks are confined.

    Parameters
    ----------
    problem : AssemblyProblem
        The assembly.
    associated : float
        Its multiplier by associated flow.
    """
    if not is_confined(problem):
        return None
    nothing = np.zeros(0)
    if len(problem.bearings.contact) > MAX_JOINTS:
        return Undilated(None, nothing, nothing, (), False)
    weight = _Search(problem, problem.dead, np.zeros_like(problem.dead), problem.inertia)
    unknowns = weight.run(np.inf)
    if unknowns is not None:
        return Undilated(0.0, nothing, nothing, moving(problem.frame.names, weight.field(unknowns), MOVING_SPEED), True)
    below = (1 - MIN_DECREASE) * min(associated, MAX_MULTIPLIER)
    shaking = _Search(problem, problem.live, problem.dead, np.zeros_like(problem.dead), _least_normals(problem, below))
    unknowns = shaking.run(below)
    complete = weight.complete and shaking.complete
    if unknowns is None:
        return Undilated(None, nothing, nothing, (), complete)
    return Undilated(shaking.multiplier(unknowns), shaking.field(unknowns), shaking.state(unknowns), (), complete)


def is_confined(problem: AssemblyProblem) -> bool:
    """Return whether forces balance one another without a load, and press joints that could slide.

    Joints without given friction have the usual one here: what their glue alone confines has a caution of its own.
    """
    rays, mu = problem.bearings.rays(usual=MASONRY_FRICTION), problem.bearings.friction
    press = rays.one_sided & (np.append(mu, 0.0)[rays.contact] > 0)  # guides have contact -1, the last entry
    optimum = least(
        -np.append(press, 0.0),
        from_blocks([[rays.rates.T, None], [rays.one_sided[None, :], np.ones((1, 1))]]),
        np.append(np.zeros_like(problem.dead), 1.0),
        np.append(np.where(rays.one_sided, 0.0, -MAX_GUIDE_FORCE), 0.0),
        np.append(np.where(rays.one_sided, np.inf, MAX_GUIDE_FORCE), np.inf),
    )
    assert optimum is not None  # zero forces are a solution
    # Balanced forces can be scaled freely, so that the optimum uses all of the allowed compression, or none.
    return bool(optimum.value < -(ZERO_PRODUCT**0.5))


def _least_normals(problem: AssemblyProblem, multiplier: float) -> Reals:
    """Return the least normal force of each joint in all states that balance any multiplier up to the given one."""
    rays = problem.bearings.rays()
    normal = problem.by_contact(np.arange(rays.mix.shape[1]))[0].astype(np.intp)
    equal = beside([rays.rates.T, problem.live])
    low, high = np.append(rays.low, 0.0), np.append(np.full(rays.count, np.inf), multiplier)
    least_normals = np.zeros(len(normal))
    for k, ends in enumerate(normal):
        cost = rays.mix @ np.bincount(ends, minlength=rays.mix.shape[1])
        best = least(np.append(cost, 0.0), equal, -problem.dead, low, high)
        least_normals[k] = 0.0 if best is None else max(best.value - ZERO_PRODUCT, 0.0)
    return least_normals


class _Search:
    """Search for a mechanism on which `push` does the work 1, with the least multiplier of `push` that starts it.

    The unknowns are the forces, the multiplier, the margins of shear to friction, velocities, and rates. With an
    `inertia` the velocities are also accelerations that the forces cause. With the least normal force of each joint,
    the friction dissipates no less than these do, so that the work bounds the multiplier from below.
    """

    def __init__(
        self, problem: AssemblyProblem, push: Reals, rest: Reals, inertia: Reals, normals: Reals | None = None
    ) -> None:
        rates = problem.bearings.rates
        sign, limit = _alternatives(problem)
        forces, blocks, pairs = rates.shape[0], rates.shape[1], limit.shape[0]
        unit = unit_columns(np.arange(pairs), pairs)
        motion = from_entries(np.arange(blocks), np.arange(blocks), -inertia, (blocks, blocks))
        slack = -np.ones((1, 1))
        rows = [
            [rates.T, push[:, None], None, motion, None, None],
            [limit, None, -unit, None, None, None],
            [None, None, None, rates, -sign, None],
            [None, None, None, push[None, :], None, None],
            [None, None, None, None, None, slack],
        ]
        if normals is not None:
            lost = np.zeros((1, pairs))
            slides = ~np.isnan(problem.bearings.friction)
            dissipated = (problem.bearings.friction * normals)[slides]
            lost[0, -2 * len(dissipated) :] = np.tile(dissipated, 2)
            rows[-1] = [None, -slack, None, rest[None, :], -lost, slack]
        self._equal = from_blocks(rows)
        self._right = np.concatenate([-rest, np.zeros(pairs + forces), [1.0, 0.0]])
        starts = np.cumsum([forces, 1, pairs, blocks])
        self._forces, self._multiplier = slice(forces), int(starts[0])
        self._left, self._field, self._rates = (np.arange(starts[k], starts[k] + n) for k, n in
                                                ((1, pairs), (2, blocks), (3, pairs)))  # fmt: skip
        self._low = np.full(starts[-1] + pairs + 1, -np.inf)
        for part in (self._left, self._rates, self._multiplier, -1):
            self._low[part] = 0.0
        self._programmes = MAX_JOINT_PROGRAMMES // len(problem.bearings.contact)
        self.complete = True

    def multiplier(self, unknowns: Reals) -> float:
        """Return the multiplier of a mechanism."""
        return float(unknowns[self._multiplier])

    def field(self, unknowns: Reals) -> Reals:
        """Return the velocities of a mechanism."""
        return unknowns[self._field]

    def state(self, unknowns: Reals) -> Reals:
        """Return the forces in the joints at the start of a mechanism."""
        return unknowns[self._forces]

    def run(self, below: float) -> Reals | None:
        """Return the simplest mechanism of the least multiplier below a limit; None if none is found."""
        high, cost = np.full(len(self._low), np.inf), np.zeros(len(self._low))
        cost[self._multiplier] = np.isfinite(below)  # without a limit any mechanism is accepted
        unknowns, self.complete = self._least(cost, high, below)
        if unknowns is None:
            return None
        # Among mechanisms with the least multiplier, choose the one with the least motion and the least forces.
        high[self._multiplier] = self.multiplier(unknowns) * (1 + SIMPLEST_INCREASE) + SIMPLEST_INCREASE
        weights = np.linspace(1.0, 1.0 + LAST_JOINT_COST, len(self._left))
        cost = np.zeros(len(self._low))
        cost[self._left], cost[self._rates] = weights, weights
        simplest, _ = self._least(cost, high, np.inf)
        return unknowns if simplest is None else simplest

    def _least(self, cost: Reals, high: Reals, below: float) -> tuple[Reals | None, bool]:
        """Return the unknowns at the least cost below a limit, if any, and whether the search was complete."""
        unknowns, complete, undecided = None, True, [high]
        for _ in range(self._programmes):
            if not undecided:
                return unknowns, complete
            bounds = undecided.pop()
            try:
                best = least(cost, self._equal, self._right, self._low, bounds)
            except NoAnswer:
                complete = False
                continue
            if best is None or best.value >= below:
                continue
            force, rate = best.x[self._left], best.x[self._rates]
            both = np.minimum(force, rate) > ZERO_PRODUCT
            if not both.any():
                unknowns, below = self._exactly(cost, bounds, best.x), best.value * (1 - SIMPLEST_INCREASE)
                continue
            product = np.where(both, force * rate, 0.0)
            # Branch on the first of equal products, so that rounding does not decide.
            k = int(np.flatnonzero(product >= product.max() * (1 - MOVING_SPEED))[0])
            for part in (self._left, self._rates):
                without = bounds.copy()
                without[part[k]] = 0.0
                undecided.append(without)
        return unknowns, complete and not undecided

    def _exactly(self, cost: Reals, high: Reals, unknowns: Reals) -> Reals:
        """Return the unknowns with exactly zero for one of each excluding pair, which the solver leaves nearly zero."""
        high = high.copy()
        high[np.where(unknowns[self._left] < unknowns[self._rates], self._left, self._rates)] = 0.0
        try:
            best = least(cost, self._equal, self._right, self._low, high)
        except NoAnswer:
            best = None
        return unknowns if best is None else best.x


def _alternatives(problem: AssemblyProblem) -> tuple[Sparse, Sparse]:
    """Return matrices of velocities and forces of which one must be zero, a row for each point and each sense of slip.

    The first matrix gives the velocities on which the forces do work from openings and slips, which are at least zero.
    The second gives normal forces, and the margins of shear to the friction, from the forces.
    """
    bearings = problem.bearings
    forces, mu, shears = bearings.rates.shape[0], bearings.friction, bearings.shears
    joint = np.repeat(np.arange(len(mu)), bearings.count)
    normals = np.arange(len(joint)) + joint
    slides = np.flatnonzero(~np.isnan(mu))
    p, n = len(normals), len(slides)
    pairs = np.arange(p + 2 * n)
    sign = from_entries(
        np.concatenate([normals, shears[slides], shears[slides]]), pairs, np.repeat([1.0, 1.0, -1.0], [p, n, n]),
        (forces, len(pairs)),
    )  # fmt: skip
    place = np.full(len(mu), -1)
    place[slides] = np.arange(n)
    press = np.flatnonzero(place[joint] >= 0)
    row = p + place[joint[press]]
    friction = from_entries(
        np.concatenate([row, row + n]), np.tile(normals[press], 2), np.tile(mu[joint[press]], 2), (len(pairs), forces)
    )
    return sign, (sign.T + friction).tocsr()
