"""Crushing of pivots: a corner of finite strength bears on a strip, with the pivot in the middle of the strip."""

from __future__ import annotations

from rocking_cli.core.fields import Described, length, quantity


class Crushing(Described):
    """Every pivot moves inwards by u = N/(2 strength depth), with the normal force N that it carries at rest."""

    strength: float = quantity("compressive strength", unit="Pa", example=1e6, gt=0, le=1e12)
    depth: float | None = length("length of the pivot out of plane; if omitted, that of the structure", default=None)

    @property
    def words(self) -> str:
        """Sentence, without a full stop, that crushing moves the pivots."""
        return (
            f"pivots moved inwards by crushing at {self.strength / 1e6:g} MPa under the forces at rest, and kept there "
            "over the whole motion"
        )
