"""What a contact bears: the strength of its material, over the width on which a corner crushes."""

from __future__ import annotations

from rocking_cli.core.fields import Described, length, quantity


class Strength(Described):
    """The strength of the contacts of a structure: stress times width times its depth."""

    stress: float = quantity("compressive strength of the material", unit="Pa", example=3e6, gt=0, le=1e12)
    width: float = length("width of the contact, in the plane", example=0.05)

    def force(self, depth: float) -> float:
        """The largest force normal to a contact [N], of a structure so deep [m]."""
        return self.stress * self.width * depth

    def enlarged(self, factor: float) -> Strength:
        """The same material on a structure of another size."""
        return self.model_copy(update={"width": factor * self.width})
