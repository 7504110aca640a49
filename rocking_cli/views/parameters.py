"""The parameters of an equivalent block, in one table for all outputs."""

from __future__ import annotations

from dataclasses import dataclass

from rocking_cli.core import EquivalentBlock
from rocking_cli.views.column import Column, of


@dataclass(frozen=True)
class Parameter(Column[EquivalentBlock]):
    """A parameter of the equivalent block of one direction; its words are for readers of the paper.

    Parameters
    ----------
    symbol : str
        Symbol in print; an underscore starts a subscript.
    meaning : str
        Description for a reader who does not know the parameter.
    """

    key: str
    symbol: str = ""
    meaning: str = ""

    @property
    def printed_unit(self) -> str:
        """The unit in print; 1 for a dimensionless parameter."""
        return self.unit.replace("m2", "m²") or "1"

    @property
    def of_mass(self) -> bool:
        """Whether the parameter is proportional to mass, and so per unit mass for a structure without masses."""
        return self.unit.startswith("kg ")

    def unit_of(self, *, mass: bool) -> str:
        """Return the unit for a structure with or without masses."""
        return self.unit if mass else self.unit.removeprefix("kg ")


def _parameter(key: str, unit: str, symbol: str, words: str, meaning: str) -> Parameter:
    attribute = key if key != "lambda" else "lambda_"
    return Parameter(key, of(attribute), unit, words=words, symbol=symbol, meaning=meaning)


PARAMETERS = (
    _parameter("p", "rad/s", "p", "frequency parameter: small for large structures",
               "Frequency parameter. Near φ_cr the rotation grows as exp(p t) with time t. Large structures have a "
               "small p."),
    _parameter("phi_cr", "rad", "φ_cr", "critical rotation: unstable equilibrium",
               "Critical rotation. The structure is in unstable equilibrium there; beyond it, its weight overturns "
               "it."),
    _parameter("lambda", "g", "λ", "ground acceleration at uplift",
               "Uplift acceleration. A steady ground acceleration above λ times the structure's gravity g causes "
               "uplift."),
    _parameter("lambda_lin", "g", "λ_lin", "uplift acceleration of the linearised mechanism",
               "Uplift acceleration of the linearised mechanism. If it differs much from λ, the structure is not "
               "slender."),
    _parameter("kappa1", "", "κ₁", "phi/theta that keeps lambda_lin",
               "Scaling φ = κ₁ θ from the rotation θ of the equivalent block to φ of the structure, chosen to keep "
               "λ_lin."),
    _parameter("kappa2", "", "κ₂", "phi/theta that keeps lambda",
               "Scaling φ = κ₂ θ from the rotation θ of the equivalent block to φ, chosen to keep λ, the true uplift "
               "acceleration."),
    _parameter("theta_cr1", "rad", "θ_cr,1", "critical rotation of the block, kappa1",
               "Critical rotation of the equivalent block with κ₁: φ_cr/κ₁."),
    _parameter("theta_cr2", "rad", "θ_cr,2", "critical rotation of the block, kappa2",
               "Critical rotation of the equivalent block with κ₂: φ_cr/κ₂."),
    _parameter("eta", "", "η", "restitution when motion in this direction ends",
               "Coefficient of restitution: rate of rotation just after an impact that ends motion in this "
               "direction, over the rate just before."),
    _parameter("v_imp", "m/s", "v_imp", "ground velocity step that just overturns it",
               "Velocity step of the ground that just overturns the structure from rest, without linearisation."),
    _parameter("I_eq", "kg m2", "I_eq", "linearised inertia",
               "Moment of inertia of the mechanism at φ_cr."),
    _parameter("G_eq", "kg m", "G_eq", "linearised restoring moment over g",
               "Rate at which the restoring moment over g decreases with rotation at φ_cr."),
    _parameter("B_eq", "kg m", "B_eq", "linearised drive of the ground",
               "Moment by which the ground drives the mechanism at φ_cr, over its acceleration."),
)  # fmt: skip
