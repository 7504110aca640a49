"""Ties, and forces that represent them, in a verification; their strength is not known."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rocking_cli.codes.italian.capacity import ExactCurve
from rocking_cli.codes.italian.chain import Chain
from rocking_cli.codes.italian.displaced import DisplacedChain
from rocking_cli.core import Mechanism
from rocking_cli.core.hung.elements import ConstantForce, Spring
from rocking_cli.core.hung.ties import Tie

STRETCHED = 0.02
"""Elongation of a tie over its length from which the output warns: steel yields at a tenth of it."""
WIDE = 0.8
"""Displacement of the centroid of a block over half its thickness from which the output warns; it falls at 1."""


@dataclass(frozen=True)
class Pull:
    """A tie at a displacement, or a force against the motion that may represent a tie.

    Parameters
    ----------
    name : str
        Name of the tie or force.
    force : float
        Force at this displacement [N], tension positive.
    elongation : float
        Elongation since rest; for a force, displacement of its point against the force [m].
    strain : float or None
        The elongation over the length of the tie; None if the length is not known, as for a force.
    """

    name: str
    force: float
    elongation: float
    strain: float | None


def pulls(curve: ExactCurve, d: float) -> Sequence[Pull]:
    """Return the ties, and the forces against the motion, at a displacement; beds of springs are not among them."""
    chain, phi = curve.chain, curve.rotation(d)
    follow = chain.mechanism.followed(np.array([phi]), chain.direction)
    lengths = {tie.name: tie.length or tie.span for tie in chain.mechanism.ties or [] if tie.bed is None}
    loads = {load.name for load in chain.mechanism.loads or []}
    found = []
    for thing in chain.mechanism.hung.elements:
        if isinstance(thing, Spring):
            e, length = thing.elongation(follow)[0], lengths[thing.name]
            strain = float(e[0]) / length if length else None
            found.append(Pull(thing.name, float(thing.force(e)[0]), float(e[0]), strain))
        elif isinstance(thing, ConstantForce) and thing.name in loads:
            force = thing.in_direction(chain.direction)
            if chain.direction * force.real < 0:
                moved = complex(follow(thing.spot).z[0]) - thing.spot.at
                against = -(moved.conjugate() * force).real / abs(force)
                found.append(Pull(thing.name, abs(force), against, None))
    return found


def furthest(curve: ExactCurve, d: float) -> tuple[float, float]:
    """Return the sideways displacement of a block's centroid at a displacement, and the thickness of the block [m].

    The block is the one with the largest ratio of both; (0, 1) if no outline is known.
    """
    drawn = curve.chain.mechanism.sketch().outlines
    own = {body.name: [body.outline] for body in curve.chain.mechanism.bodies() if body.outline}
    found = [(0.0, 1.0)]
    for moved in DisplacedChain(curve, curve.rotation(d)).blocks:
        lines = [line for name in moved.block.bodies for line in own.get(name) or drawn.get(name, ())]
        x = [complex(corner).real for line in lines for corner in line]
        if x and max(x) > min(x):
            found.append((moved.gone, max(x) - min(x)))
    return max(found, key=lambda pair: pair[0] / pair[1])


def elastic(mechanism: Mechanism) -> Sequence[Tie]:
    """Return the ties and beds of springs whose force increases with the elongation."""
    return [tie for tie in mechanism.ties or [] if tie.is_elastic]


def carried(curve: ExactCurve, d: float) -> dict[str, float]:
    """Return the force of each elastic tie at a displacement [N], tension positive, by name; without beds."""
    chain, phi = curve.chain, curve.rotation(d)
    follow = chain.mechanism.followed(np.array([phi]), chain.direction)
    bars = [each for each in chain.mechanism.hung.elements if isinstance(each, Spring) and each.stiffness > 0]
    return {bar.name: float(bar.force(bar.elongation(follow)[0])[0]) for bar in bars}


def lasting(mechanism: Mechanism) -> Mechanism:
    """Return the structure, with constant forces in place of elastic ties that would hold it at any displacement.

    The capacity curve of the code ends at collapse. A tie whose force increases without limit has no such end, because
    the model does not know the strength of the tie. The constant force is the force of the tie at rest.
    """
    if not elastic(mechanism):
        return mechanism
    curves = [ExactCurve(chain, chain.barycentre, 1.0) for chain in (Chain(mechanism, s) for s in mechanism.directions)]
    return _as_at_rest(mechanism) if any(curve.is_endless for curve in curves) else mechanism


def _as_at_rest(mechanism: Mechanism) -> Mechanism:
    growing = {tie.name for tie in elastic(mechanism)}
    plain = {"stiffness": 0.0, "area": None, "modulus": None, "length": None}
    ties = [
        tie.model_copy(update=plain) if tie.name in growing else tie
        for tie in mechanism.ties or []
        if tie.name not in growing or tie.prestress
    ]
    return mechanism.model_copy(update={"ties": ties or None})
