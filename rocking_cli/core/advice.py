"""Which scaling kappa of the equivalent block to prefer, and why."""

from __future__ import annotations

from dataclasses import dataclass
from math import tan
from typing import Literal

from rocking_cli.core.equivalence import EquivalentBlock

# The paper finds small errors with either kappa for walls of alpha < 0.2: lambda_lin/lambda = 0.2/tan(0.2) there.
SLENDER = 0.2 / tan(0.2)


@dataclass(frozen=True)
class Advice:
    """A preferred scaling.

    Parameters
    ----------
    prefer : {"kappa2", "either"}
        The scaling to use.
    ratio : float
        lambda_lin/lambda, the paper's measure of effective slenderness: 1 for a slender structure.
    why : str
        The reason, in a sentence.
    """

    prefer: Literal["kappa2", "either"]
    ratio: float
    why: str


def preferred_kappa(block: EquivalentBlock) -> Advice:
    """Which kappa to use for a structure, judged by how well the linearised mechanism keeps its uplift."""
    ratio = block.lambda_lin / block.lambda_
    off = f"lambda_lin/lambda = {ratio:.4g}"
    if SLENDER <= ratio <= 1 / SLENDER:
        return Advice("either", ratio, f"{off}: effectively slender, kappa1 and kappa2 serve alike.")
    share = f"{abs(1 - ratio):.0%}" if abs(1 - ratio) >= 0.1 else f"{abs(1 - ratio):.1%}"
    way = "below" if ratio < 1 else "above"
    why = (
        f"prefer kappa2, which keeps the uplift; with kappa1 the block would uplift {share} {way} the true acceleration"
    )
    return Advice("kappa2", ratio, f"{off}: {why}.")
