"""A ground motion with its scale factor and its source."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from rocking_cli.excitation.base import GroundMotion
    from rocking_cli.excitation.pulses import Pulse
    from rocking_cli.processing.listed import Listed
    from rocking_cli.processing.reading import Reading


class Scaled(NamedTuple):
    """A ground motion as read, its scale factor, and its pulse, or its record and how that was read."""

    motion: GroundMotion
    factor: float
    pulse: Pulse | None = None
    record: Listed | None = None
    reading: Reading | None = None

    @property
    def file(self) -> Path | None:
        """The file of the record, if there is one."""
        return self.record.path if self.record is not None else None
