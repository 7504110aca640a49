"""A ground motion with its scale factor and its source."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from rocking_cli.excitation.base import GroundMotion
    from rocking_cli.excitation.pulses import Pulse


class Scaled(NamedTuple):
    """A ground motion as read, its scale factor, its pulse or file, and its place among the requested motions."""

    motion: GroundMotion
    factor: float
    pulse: Pulse | None = None
    file: Path | None = None
    place: int = 0
