"""Elastic ties, of which nobody gave the strength, as verifications take them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from rocking_cli.core import Mechanism
from rocking_cli.core.attached import Spring
from rocking_cli.core.ties import Tie
from rocking_cli.studies.verification.capacity import ExactCurve
from rocking_cli.studies.verification.chain import Chain


def elastic(mechanism: Mechanism) -> Sequence[Tie]:
    """The ties, and beds of springs, whose force grows with what they stretch."""
    return [tie for tie in mechanism.ties or [] if tie.bed is not None or tie.k > 0]


def carried(curve: ExactCurve, d: float) -> dict[str, float]:
    """What each elastic tie carries at a displacement [N], tension positive, by its name; beds are not among them."""
    chain, phi = curve.chain, curve.rotation(d)
    follow = chain.mechanism.followed(np.array([phi]), chain.direction)
    bars = [each for each in chain.mechanism.attached if isinstance(each, Spring) and each.stiffness > 0]
    return {bar.name: float(bar.force(bar.elongation(follow)[0])[0]) for bar in bars}


def lasting(mechanism: Mechanism) -> Mechanism:
    """The structure; with its elastic ties as they pull at rest, if it could not come down with what they grow to.

    A code counts what is there up to collapse, and that a tie would hold for ever is a model beyond its strength.
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
