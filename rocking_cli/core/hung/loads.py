"""Loads of a structure, as users give them: masses and constant forces."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from rocking_cli.core.fields import Described, Name, Vertex, geometry_error, point, quantity
from rocking_cli.core.hung.attached import PointMass, Spot
from rocking_cli.core.hung.elements import ConstantForce

Share = Annotated[float, Field(ge=0, le=1)]
Newtons = Annotated[float, Field(ge=-1e12, le=1e12)]
FLOORS: dict[str, dict[str, float]] = {
    "borne": {"vertical": 1 / 3, "weight": 1 / 2},
    "sliding": {"horizontal": 0.0, "vertical": 1 / 3, "weight": 1 / 2},
    "dragged": {"horizontal": 1.0, "vertical": 1 / 3, "weight": 1 / 2},
}
"""Shares of a floor that is borne at its far end too: it turns about that end, and slides here or is dragged along."""


class Load(Described):
    """A mass or a constant force at a point of a body.

    A mass counts by three shares, each 1 by default: in the horizontal inertia, in the vertical inertia and as weight.
    A force has no inertia.
    """

    name: Name = Field(description="what to call it")
    mass: float | None = quantity("its mass", unit="kg", example=1000.0, default=None, gt=0, le=1e12)
    force: Annotated[list[Newtons], Field(min_length=2, max_length=2)] | None = quantity(
        "a constant force [Fx, Fy], to the right and up", unit="N", example=[0.0, -1000.0], default=None
    )
    at: Vertex = point("where it acts")
    body: Name | None = Field(
        None, description="the body it acts on, by its name in the picture; optional for a single body"
    )
    horizontal: Share | None = Field(None, description="share of the mass that moves sideways with the body")
    vertical: Share | None = Field(None, description="share that moves up with it")
    weight: Share | None = Field(None, description="share of the weight that the body carries")
    floor: Literal["borne", "sliding", "dragged"] | None = Field(
        None,
        description="sets the shares for a floor that is also supported at its far end; `mass` is then that of the "
        "whole floor",
    )
    seat: float | None = quantity(
        "bearing length of the supported member, such as a beam; its support is lost when it is displaced sideways by "
        "this length", unit="m",
        default=None, gt=0, le=100,
    )  # fmt: skip
    each: bool = Field(False, description="whether each of several bodies that move alike has one")

    @model_validator(mode="after")
    def _one_kind(self) -> Self:
        if (self.mass is None) == (self.force is None):
            raise geometry_error("mass", "give either `mass` or `force`")
        shares = [key for key in ("horizontal", "vertical", "weight") if getattr(self, key) is not None]
        if self.force is not None and (shares or self.floor is not None):
            raise geometry_error(shares[0] if shares else "floor", "a force has no mass to share")
        if self.force is not None and self.seat is not None:
            raise geometry_error("seat", "a force has no seat: it is of a mass")
        if self.floor is not None:
            for key in shares:
                if key in FLOORS[self.floor]:
                    raise geometry_error(key, f"is already set by floor: {self.floor}; give one of the two")
        return self

    def attached(self, body: str, count: float) -> PointMass | ConstantForce:
        """Return `count` such loads as one term of the equation of motion."""
        spot = Spot(body, complex(*self.at))
        if self.force is not None:
            return ConstantForce(self.name, spot, count * complex(*self.force))
        assert self.mass is not None
        shares = {"horizontal": self.horizontal, "vertical": self.vertical, "weight": self.weight}
        given = {key: value for key, value in shares.items() if value is not None}
        return PointMass(self.name, spot, count * self.mass, **{**FLOORS.get(self.floor or "", {}), **given})
