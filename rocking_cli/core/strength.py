"""Strength of a contact, from the strength of its material and the width over which a corner crushes."""

from __future__ import annotations

from rocking_cli.core.fields import Described, length, quantity


class Strength(Described):
    """Strength of the contacts of a structure: stress times width times depth of the structure."""

    stress: float = quantity("compressive strength of the material", unit="Pa", example=3e6, gt=0, le=1e12)
    width: float = length("width of the contact, in the plane", example=0.05)

    def force(self, depth: float) -> float:
        """Return the largest normal force of a contact [N], of a structure with depth `depth` [m]."""
        return self.stress * self.width * depth
