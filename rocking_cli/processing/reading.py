"""How a record is read and processed, in one object: from a file to the motion that excites a structure."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.excitation.records import read_measured
from rocking_cli.excitation.records.sensor import Gain, Quantity, as_acceleration, smallest_step
from rocking_cli.processing.components import turned
from rocking_cli.processing.floor import Floor
from rocking_cli.processing.steps import Factor, Lowpass, Resample, Step, of_vertical, process


@dataclass(frozen=True)
class Reading:
    """How a record is read and processed; the steps take place in the order of the parameters.

    Parameters
    ----------
    dt, units, channel : float, str, str, optional
        Sampling interval [s], unit and channel, as for `rocking_cli.excitation.records.read_record`.
    quantity : str, optional
        Quantity in the file; by default acceleration, or the quantity of the gain.
    gain : Gain, optional
        Value of one unit of the file.
    other : str or Path, optional
        File of the component at right angles, read in the same way.
    other_channel : str, optional
        Channel of the second component; by default that of the first.
    azimuth : float
        Angle of the structure's plane, from the first component towards the second [deg].
    steps : tuple of Step
        Corrections in their order, applied to the recorded values, before differentiation.
    floor : Floor, optional
        The floor that the structure stands on.
    """

    dt: float | None = None
    units: str | None = None
    channel: str | None = None
    quantity: Quantity | None = None
    gain: Gain | None = None
    other: str | Path | None = None
    other_channel: str | None = None
    azimuth: float = 0.0
    steps: tuple[Step, ...] = ()
    floor: Floor | None = None

    def __post_init__(self) -> None:
        alone = (
            ("azimuth", self.azimuth, "an azimuth is between"),
            ("with_channel", self.other_channel, "applies to one of"),
        )
        for name, given, what in alone if self.other is None else ():
            if given:
                hint = "give the file of the second with `with`"
                raise InputError(Problem(f"{what} two components", field=f"`{name}`", hint=hint))

    def read(self, file: str | Path) -> GroundMotion:
        """Return the motion that excites a structure.

        Raises
        ------
        InputError
            If a file cannot be read, a correction cannot be made, or two components do not fit together.
        """
        measured, quantity = self._measured(file, self.channel)
        step = smallest_step(measured)
        if self.other is not None:
            second, _ = self._measured(self.other, self._channel_of_other(file))
            step = max(step, smallest_step(second))
            measured = turned(measured, second, self.azimuth)
        corrected = process(measured, self.steps, accelerations=quantity == "acceleration")
        for each in self.steps:  # what they make of a step of the last digit
            step *= 0.0 if isinstance(each, Lowpass) else abs(each.by) if isinstance(each, Factor) else 1.0
        return self.on_floor(as_acceleration(corrected, quantity, step))

    def pair(self, file: str | Path) -> tuple[GroundMotion, GroundMotion]:
        """Return the two components, each processed by itself before their rotation, which is linear.

        Raises
        ------
        InputError
            As `read`.
        """
        assert self.other is not None
        alone = replace(self, other=None, other_channel=None, azimuth=0.0)
        return alone.read(file), replace(alone, channel=self._channel_of_other(file)).read(self.other)

    def _channel_of_other(self, file: str | Path) -> str | None:
        assert self.other is not None
        if self.other_channel is None and _same(self.other, file):
            hint = "give the channel of the second with `with_channel`"
            raise InputError(Problem("is the first component too", str(file), field="`with`", hint=hint))
        return self.channel if self.other_channel is None else self.other_channel

    def on_floor(self, motion: GroundMotion) -> GroundMotion:
        """Return the motion of the floor for a ground motion; without a floor, the ground motion."""
        return motion if self.floor is None else self.floor.of(motion)

    def vertical(self, file: str | Path, dt: float | None = None, channel: str | None = None) -> GroundMotion:
        """Return the vertical component from a file of its own, read in the same way and with the same corrections.

        Raises
        ------
        InputError
            As `read`.
        """
        own = replace(
            self, dt=dt if dt is not None else self.dt, channel=channel, other=None, other_channel=None, azimuth=0.0,
            steps=of_vertical(self.steps), floor=None,
        )  # fmt: skip
        return own.read(file)

    def _measured(self, file: str | Path, channel: str | None) -> tuple[GroundMotion, Quantity]:
        uneven = any(isinstance(step, Resample) for step in self.steps)
        return read_measured(
            file, dt=self.dt, units=self.units, channel=channel, quantity=self.quantity, gain=self.gain, uneven=uneven
        )


def _same(one: str | Path, other: str | Path) -> bool:
    """Return whether two paths are those of one file, however they are written."""
    try:
        return Path(one) == Path(other) or Path(one).samefile(other)
    except OSError:  # one is not there, which is said where it is read
        return False
