"""Uncertainty of the data of a structure, by which its neighbours are drawn."""

from __future__ import annotations

from rocking_cli.core.fields import Described, quantity


class Uncertainty(Described):
    """Standard deviations of the measured data of a structure."""

    slenderness: float | None = quantity(
        "standard deviation of ln slenderness: usually 0.05 if measured on site, 0.03 if machined; 0.10 if omitted",
        example=0.05,
        default=None,
        ge=0,
        lt=1,
    )
    restitution: float | None = quantity(
        "standard deviation of the coefficient of restitution; by default 0.03 if restitution is given, else 0.05",
        example=0.02,
        default=None,
        ge=0,
        lt=1,
    )
