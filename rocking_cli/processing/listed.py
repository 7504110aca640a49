"""A record file named by the user, alone or in a list of records; and a motion with its scale factor and source."""

from __future__ import annotations

from dataclasses import replace
from math import prod
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from rocking_cli.errors import InputError
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.excitation.records.origins import name
from rocking_cli.processing.reading import Reading
from rocking_cli.processing.steps import Factor
from rocking_cli.short_repr import short_repr

if TYPE_CHECKING:  # pydantic is slow to import, and only lists need it
    from rocking_cli.excitation.pulses import Pulse
    from rocking_cli.processing.entry import Entry


LIST_SUFFIXES = (".yaml", ".yml")
LIST_FILE = "set.yaml"
"""The list in a folder of records that `rocking select` writes."""


class Listed(NamedTuple):
    """A record file, with its entry in a list of records; the entry is None if the user named the file itself."""

    path: Path
    entry: Entry | None = None
    folder: Path = Path()

    def reading(self, common: Reading) -> Reading:
        """Return how to read the record, with the items of `common` for all records.

        Raises `InputError` if its items contradict one another.
        """
        if self.entry is None:
            return common
        try:
            return self.entry.reading(self.folder, common)
        except InputError as error:
            raise InputError(*(replace(each, file=str(self.path)) for each in error.problems)) from None

    def settled(self, common: Reading) -> tuple[GroundMotion, Reading]:
        """Return the motion of the record, and how it was read. Raises `InputError` if it cannot be read.

        Earthquake and station of the list take the place of those of the file.
        """
        reading = self.reading(common)
        motion = reading.read(self.path)
        if self.entry is not None:
            file_origin = motion.origin
            event, station = (
                name(self.entry.event) or file_origin.event,
                name(self.entry.station) or file_origin.station,
            )
            motion = replace(motion, origin=file_origin._replace(event=event, station=station))
        return motion, reading


def is_list(path: Path) -> bool:
    """Return whether a file is a list of records, by its name."""
    return path.suffix.lower() in LIST_SUFFIXES


@short_repr
class Scaled(NamedTuple):
    """A ground motion as read, its scale factor, and its pulse, or its record and how that was read."""

    motion: GroundMotion
    factor: float
    pulse: Pulse | None = None
    record: Listed | None = None
    reading: Reading | None = None

    @property
    def scale_factor(self) -> float:
        """The factor on the accelerations of the record, with those of its list."""
        steps = self.reading.steps if self.reading is not None else ()
        return self.factor * prod(step.by for step in steps if isinstance(step, Factor))

    @property
    def file(self) -> Path | None:
        """The file of the record, if there is one."""
        return self.record.path if self.record is not None else None
