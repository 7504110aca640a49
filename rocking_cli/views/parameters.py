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


PARAMETERS = (
    Parameter(
        "p",
        of("p"),
        "rad/s",
        words="frequency parameter: small for large structures",
        symbol="p",
        meaning="Frequency parameter. Near φ_cr the rotation grows as exp(p t) with time t. Large structures have a "
        "small p.",
    ),
    Parameter(
        "phi_cr",
        of("phi_cr"),
        "rad",
        words="critical rotation: unstable equilibrium",
        symbol="φ_cr",
        meaning="Critical rotation. The structure is in unstable equilibrium there; beyond it, its weight overturns "
        "it.",
    ),
    Parameter(
        "lambda",
        of("lambda_"),
        "g",
        words="ground acceleration at uplift",
        symbol="λ",
        meaning="Uplift acceleration. A steady ground acceleration above λ times the structure's gravity g causes "
        "uplift.",
    ),
    Parameter(
        "lambda_lin",
        of("lambda_lin"),
        "g",
        words="uplift acceleration of the linearised mechanism",
        symbol="λ_lin",
        meaning="Uplift acceleration of the linearised mechanism. If it differs much from λ, the structure is not "
        "slender.",
    ),
    Parameter(
        "kappa1",
        of("kappa1"),
        "",
        words="phi/theta that keeps lambda_lin",
        symbol="κ₁",
        meaning="Scaling φ = κ₁ θ from the rotation θ of the equivalent block to φ of the structure, chosen to keep "
        "λ_lin.",
    ),
    Parameter(
        "kappa2",
        of("kappa2"),
        "",
        words="phi/theta that keeps lambda",
        symbol="κ₂",
        meaning="Scaling φ = κ₂ θ from the rotation θ of the equivalent block to φ, chosen to keep λ, the true uplift "
        "acceleration.",
    ),
    Parameter(
        "theta_cr1",
        of("theta_cr1"),
        "rad",
        words="critical rotation of the block, kappa1",
        symbol="θ_cr,1",
        meaning="Critical rotation of the equivalent block with κ₁: φ_cr/κ₁.",
    ),
    Parameter(
        "theta_cr2",
        of("theta_cr2"),
        "rad",
        words="critical rotation of the block, kappa2",
        symbol="θ_cr,2",
        meaning="Critical rotation of the equivalent block with κ₂: φ_cr/κ₂.",
    ),
    Parameter(
        "eta",
        of("eta"),
        "",
        words="restitution when motion in this direction ends",
        symbol="η",
        meaning="Coefficient of restitution: rate of rotation just after an impact that ends motion in this "
        "direction, over "
        "the rate just before.",
    ),
    Parameter(
        "v_imp",
        of("v_imp"),
        "m/s",
        words="ground velocity step that just overturns it",
        symbol="v_imp",
        meaning="Velocity step of the ground that just overturns the structure from rest, without linearisation.",
    ),
    Parameter(
        "I_eq",
        of("I_eq"),
        "kg m2",
        words="linearised inertia",
        symbol="I_eq",
        meaning="Moment of inertia of the mechanism at φ_cr.",
    ),
    Parameter(
        "G_eq",
        of("G_eq"),
        "kg m",
        words="linearised restoring moment over g",
        symbol="G_eq",
        meaning="Rate at which the restoring moment over g decreases with rotation at φ_cr.",
    ),
    Parameter(
        "B_eq",
        of("B_eq"),
        "kg m",
        words="linearised drive of the ground",
        symbol="B_eq",
        meaning="Moment by which the ground drives the mechanism at φ_cr, over its acceleration.",
    ),
)
