"""A ground motion as it is used: what was read, how it is scaled, and where it comes from."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from rocking_cli.excitation.base import GroundMotion
    from rocking_cli.excitation.pulses import Pulse


class Scaled(NamedTuple):
    """A ground motion as read, the factor on it, the pulse or file it comes from, and its place among those asked."""

    motion: GroundMotion
    factor: float
    pulse: Pulse | None = None
    file: Path | None = None
    place: int = 0
