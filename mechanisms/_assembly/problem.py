"""An assembly as a linear programme: the forces of its joints, and the loads on its blocks."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from mechanisms._assembly.blocks import AssemblyBlock, AssemblyContact, NothingMoves
from mechanisms._assembly.programme import beside, least, unit_columns
from mechanisms._assembly.rays import Bearings, Frame, Rays, moving, scaled
from rocking_cli.core import Direction, Guide, Reals

STRONGEST = 1e4  # largest multiplier: beyond, nothing moves
NOTHING = 1e-9  # forces, over the weight, and multipliers that count as zero


@dataclass(frozen=True, eq=False)
class AssemblyProblem:
    """An assembly and its loads without units: moments over the size, forces over the weight.

    The live forces are divided by the sum of their sizes, `strength`, so that their unit does not matter. `inertia` is
    that of the blocks alone, as forces and moments per unit of their accelerations over gravity.
    """

    frame: Frame
    bearings: Bearings
    dead: Reals
    live: Reals
    weight: float
    strength: float
    inertia: Reals

    @classmethod
    def of(
        cls,
        blocks: Sequence[AssemblyBlock],
        contacts: Sequence[AssemblyContact],
        guides: Sequence[Guide] = (),
        direction: Direction = Direction.POSITIVE,
        *,
        dead: Reals | None = None,
        live: Reals | None = None,
        gravity: float = 9.80665,
    ) -> AssemblyProblem:
        """Return the linear programme of an assembly; arguments are those of `collapse`."""
        weights = np.array([block.mass for block in blocks]) * gravity
        nothing = np.zeros_like(weights)
        frame = Frame.of(blocks)
        dead = np.column_stack([nothing, -weights, nothing]) if dead is None else dead
        live = np.column_stack([int(direction) * weights, nothing, nothing]) if live is None else live
        weight = float(np.abs(dead[:, :2]).sum())
        if weight == 0:
            raise NothingMoves("the blocks have no weight", frame.names)
        pull = scaled(live, frame, weight)
        strength = float(np.abs(pull).sum())
        if strength == 0:
            raise NothingMoves("nothing acts on the blocks but what is always there", frame.names)
        bearings = Bearings.of(frame, contacts, guides)
        turns = np.array([block.inertia for block in blocks]) * gravity / frame.size
        inertia = scaled(np.column_stack([weights, weights, turns]), frame, weight)
        return cls(frame, bearings, scaled(dead, frame, weight), pull / strength, weight, strength, inertia)

    def greatest(self, rays: Rays, *, exact: bool = False) -> tuple[float, Reals, Reals]:
        """Return the greatest multiplier of `live`, the forces of the rays that carry it, and the velocities."""
        found = least(
            np.append(np.zeros(rays.count), -1.0),
            beside([rays.rates.T, self.live]),
            -self.dead,
            np.append(rays.low, 0.0),
            np.append(np.full(rays.count, np.inf), STRONGEST),
            exact=exact,
        )
        if found is None:
            return -np.inf, np.zeros(rays.count), np.zeros(len(self.dead))
        return -found.value, found.x[:-1], -found.prices

    def why_not(self, rays: Rays) -> tuple[str, ...]:
        """Return the names of the blocks that no forces hold at rest; empty if the assembly stands."""
        unbounded = np.full(rays.count, np.inf)
        if least(np.zeros(rays.count), rays.rates.T.tocsc(), -self.dead, rays.low, unbounded) is not None:
            return ()
        missing, names = self.unheld(rays)
        return names if missing > NOTHING else ()

    def unheld(self, rays: Rays) -> tuple[float, tuple[str, ...]]:
        """Return the least additional forces that hold all blocks at rest, and the blocks that need them."""
        n = len(self.dead)
        extra = unit_columns(np.arange(n), n)
        found = least(
            np.append(np.zeros(rays.count), np.ones(2 * n)),
            beside([rays.rates.T, extra, -extra]),
            -self.dead,
            np.append(rays.low, np.zeros(2 * n)),
            np.full(rays.count + 2 * n, np.inf),
        )
        assert found is not None  # the extra forces balance anything
        return found.value, moving(self.frame.names, found.prices, 1e-6)

    def by_contact(self, values: Reals) -> tuple[Reals, Reals, Reals]:
        """Split values of all forces into those of the two ends of each joint, of its shear, and of the guides."""
        n = len(self.bearings.contact)
        joints = values[: 3 * n].reshape(n, 3)
        return joints[:, :2], joints[:, 2], values[3 * n :]
