"""The parameters of the equivalent block for a reader who has never met them: symbol, unit, and what each is."""

from __future__ import annotations

from typing import NamedTuple


class Definition(NamedTuple):
    """A parameter: its key in `EquivalentBlock.as_dict`, symbol, unit and meaning; an underscore begins a subscript."""

    key: str
    symbol: str
    unit: str
    meaning: str


PARAMETERS = (
    Definition(
        "phi_cr",
        "φ_cr",
        "rad",
        "Critical rotation. Tilted so far, the structure is in balance; tilted further, its weight overturns it.",
    ),
    Definition(
        "lambda",
        "λ",
        "g",
        "Uplift acceleration. A steady ground acceleration above λ times the structure's gravity g lifts it.",
    ),
    Definition(
        "p",
        "p",
        "rad/s",
        "Frequency parameter. Near φ_cr a tilt grows as exp(p t) with time t. Large structures have a small p.",
    ),
    Definition(
        "eta",
        "η",
        "1",
        "Restitution. Rate of rotation just after an impact ending motion in this direction, over that just before.",
    ),
    Definition(
        "lambda_lin",
        "λ_lin",
        "g",
        "Uplift acceleration of the linearised mechanism. Where it differs much from λ the structure is not slender.",
    ),
    Definition(
        "kappa1",
        "κ₁",
        "1",
        "Scaling φ = κ₁ θ from the rotation θ of the equivalent block to φ of the structure, chosen to keep λ_lin.",
    ),
    Definition("kappa2", "κ₂", "1", "The same scaling, φ = κ₂ θ, chosen to keep λ, the true uplift acceleration."),
    Definition("theta_cr1", "θ_cr,1", "rad", "Critical rotation of the equivalent block with κ₁: φ_cr/κ₁."),
    Definition("theta_cr2", "θ_cr,2", "rad", "Critical rotation of the equivalent block with κ₂: φ_cr/κ₂."),
    Definition("I_eq", "I_eq", "kg m²", "Moment of inertia of the mechanism at φ_cr."),
    Definition("G_eq", "G_eq", "kg m", "How fast the restoring moment over g falls with rotation at φ_cr."),
    Definition(
        "B_eq", "B_eq", "kg m", "Moment by which the ground drives the mechanism at φ_cr, over its acceleration."
    ),
)
