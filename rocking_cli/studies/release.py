"""The tilt from which a free motion starts: a fraction of the critical rotation, or an angle."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi
from typing import Self

from rocking_cli.core import Direction
from rocking_cli.errors import InputError, Problem
from rocking_cli.structure import Structure
from rocking_cli.units import UnitError, read, split

TILT_EXAMPLE = "give a fraction of phi_cr such as 0.5, or an angle such as 0.05rad"


@dataclass(frozen=True)
class Release:
    """A tilt at rest; negative tilts are anticlockwise.

    Parameters
    ----------
    text : str
        The tilt as it was written.
    size : float
        Fraction of the critical rotation, or angle [rad].
    is_angle : bool
        Whether `size` is an angle.
    """

    text: str
    size: float
    is_angle: bool

    def __str__(self) -> str:
        return self.text

    @classmethod
    def of(cls, tilt: float | str) -> Self:
        """Read a fraction between -1 and 1, or a text such as `0.5`, `0.05rad` or `3 deg`. Raises `InputError`."""
        text = tilt.strip() if isinstance(tilt, str) else f"{tilt:g}"
        parts = split(tilt) if isinstance(tilt, str) else (repr(float(tilt)), "")
        if parts is None:
            raise InputError(Problem(f"{text!r} is not a valid tilt: {TILT_EXAMPLE}", field="release"))
        if not parts[1]:
            fraction = float(parts[0])
            if not 0 < abs(fraction) < 1:
                message = f"must be a fraction of phi_cr between 0 and 1 (or 0 and -1), got {text}"
                raise InputError(Problem(message, field="release"))
            return cls(text, fraction, is_angle=False)
        try:
            angle = read(text, "rad")
        except UnitError as error:
            raise InputError(Problem(error.message, field="release", hint=TILT_EXAMPLE)) from None
        if not 0 < abs(angle) < pi:
            raise InputError(Problem(f"{text!r} is not an angle between 0 and half a turn", field="release"))
        return cls(text, angle, is_angle=True)

    def ratio(self, structure: Structure) -> float:
        """Return the tilt as a fraction of phi_cr of a structure, or of the kinematic limit if there is no phi_cr.

        Raises
        ------
        InputError
            If the structure does not rock in this direction, the tilt exceeds this rotation, or a fraction has no
            reference.
        """
        direction = Direction.NEGATIVE if self.size < 0 else Direction.POSITIVE
        if direction not in structure.mechanism.directions:
            side = structure.mechanism.one_sided
            raise InputError(Problem(f"it rocks in the {side} direction only, got {self.text}", field="release"))
        statics = structure.statics[0 if direction > 0 else 1]
        if not self.is_angle:
            if statics.phi_cr is None:
                why = "a fraction needs a critical rotation, and this direction has none"
                raise InputError(Problem(f"{self.text}: {why}", field="release", hint="give an angle, such as 0.05rad"))
            return self.size
        if not abs(self.size) < statics.reference:
            end = "its kinematic limit" if statics.phi_cr is None else "its critical rotation"
            raise InputError(Problem(f"{self.text} is beyond {end}, {statics.reference:.4g} rad", field="release"))
        return self.size / statics.reference
