"""Groups of options as objects that check themselves; `options.grouped` hands them to a command."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from rocking_cli.cli import options, terminal
from rocking_cli.cli.defaults import from_default
from rocking_cli.cli.options import Placed
from rocking_cli.cli.quantities import ALL
from rocking_cli.cli.written import write_picture, write_table

if TYPE_CHECKING:
    from rocking_cli.ask.answer import Answer
    from rocking_cli.ask.ground_motions import Motions
    from rocking_cli.excitation.records.sensor import Gain, Quantity
    from rocking_cli.processing.floor import Floor
    from rocking_cli.processing.listed import Listed
    from rocking_cli.processing.reading import Reading

SPELLED = {"quantity": "from", "other": "with"}  # options by the names of their parameters


@dataclass(frozen=True)
class ReadingOptions:
    """Options for reading and processing records."""

    units: str | None
    dt: float | None
    channel: str | None
    quantity: Quantity | None
    gain: Gain | None
    other: str | None
    other_channel: str | None
    azimuth: float | str | None
    baseline: Placed | None
    highpass: Placed | None
    lowpass: Placed | None
    taper: Placed | None
    trim: Placed | None
    resample: Placed | None
    floor: Floor | None

    def __post_init__(self) -> None:
        if self.other is None and (self.azimuth is not None or self.other_channel is not None):
            raise click.UsageError("--azimuth and --with-channel require a second component: give --with FILE.")
        if self.other is not None and self.azimuth is None:
            raise click.UsageError("--with FILE requires --azimuth: 0 is the direction of the record, 90 that of FILE.")

    @property
    def placed(self) -> list[Placed]:
        """Corrections, in the order of the command line."""
        given = (getattr(self, name) for name in options.CORRECTIONS)
        return sorted((each for each in given if each is not None), key=lambda each: each.place)

    @property
    def all_azimuths(self) -> bool:
        """Whether a pair of components is rotated into all directions."""
        return self.azimuth == ALL

    @property
    def reading(self) -> Reading:
        """Options for reading a record; not for a pair of components that is rotated into all directions."""
        if self.all_azimuths:
            raise click.UsageError("--azimuth all works with `rocking respond` only: give one angle here.")
        return self.towards(self.azimuth or 0.0)

    @property
    def readings(self) -> tuple[Reading, Reading | None]:
        """How to read files, and with the user's defaults those that do not state their unit, interval or channel."""
        usual = self.reading
        typed = replace(
            usual,
            dt=None if from_default("dt") else usual.dt,
            units=None if from_default("units") else usual.units,
            channel=None if from_default("channel") else usual.channel,
        )
        return typed, usual if usual != typed else None

    def towards(self, azimuth: float | str) -> Reading:
        """Return the options for reading a record, in the direction of an azimuth [deg]."""
        from rocking_cli.processing.reading import Reading

        return Reading(
            self.dt, self.units, self.channel, self.quantity, self.gain, self.other, self.other_channel,
            float(azimuth), tuple(each.step for each in self.placed), self.floor,
        )  # fmt: skip


@dataclass(frozen=True)
class Scaling:
    """Scale factor and polarity of ground motions."""

    scale: float | None
    target_pga: float | None
    target_pgv: float | None
    polarity: str

    def __post_init__(self) -> None:
        if sum(value is not None for value in self.scaling) > 1:
            raise click.UsageError("--scale, --target-pga and --target-pgv cannot be combined: give one of them.")
        if self.scale is not None and self.scale < 0:
            terminal.note(f"--scale {self.scale:g} is negative: it reverses the motion, as --polarity -1 does")

    @property
    def scaling(self) -> tuple[float | None, float | None, float | None]:
        """`scale`, `target_pga` and `target_pgv`."""
        return self.scale, self.target_pga, self.target_pgv

    @property
    def is_scaled(self) -> bool:
        """Whether a scale factor or a target is given."""
        return any(value is not None for value in self.scaling)

    @property
    def signs(self) -> tuple[int, ...]:
        """The polarities, of 1 and -1."""
        from rocking_cli.ask.ground_motions import signs_of

        return signs_of(self.polarity)


@dataclass(frozen=True)
class GroundMotions(Scaling, ReadingOptions):
    """Ground motions, with the options for reading and scaling them."""

    records: tuple[str, ...]
    pulses: tuple[str, ...]

    def __post_init__(self) -> None:
        ReadingOptions.__post_init__(self)
        Scaling.__post_init__(self)

    def __bool__(self) -> bool:
        """Return whether any ground motion is given."""
        return bool(self.records or self.pulses)

    @property
    def motions(self) -> Motions:
        """Motions, and how to read and scale them."""
        from rocking_cli.ask.ground_motions import Motions
        from rocking_cli.excitation.pulses import parse_pulse

        reading, usual = self.readings
        return Motions((*map(Path, self.records), *map(parse_pulse, self.pulses)), reading, usual, *self.scaling)

    def check(self, vertical: str | None = None) -> None:
        """Raise if an option has no effect; `units` and `dt` also apply to the vertical component beside a pulse."""
        reading = ("units", "dt", "channel") if vertical is None else ("channel",)
        if not self.records and any(getattr(self, name) is not None and not from_default(name) for name in reading):
            raise click.UsageError("--units, --dt and --channel describe a record: give --record FILE.")
        of_records = [name for name in ("quantity", "gain", "other", *options.CORRECTIONS) if getattr(self, name)]
        if not self.records and of_records:
            named = " and ".join(f"--{SPELLED.get(name, name)}" for name in of_records)
            raise click.UsageError(f"{named} change{'s' * (len(of_records) == 1)} a record: give --record FILE.")
        if not self and self.floor is not None:
            raise click.UsageError("--floor requires a ground motion: give --record FILE or --pulse PULSE.")
        if not self and self.is_scaled:
            raise click.UsageError(
                "--scale, --target-pga and --target-pgv change a ground motion: give --record FILE or --pulse PULSE."
            )


@dataclass(frozen=True)
class Output:
    """The files to write, and whether the result is one JSON object."""

    out: Path | None
    plot: Path | None
    as_json: bool

    def keep_apart(self, *read: str | Listed | None) -> None:
        """Raise `InputError` if an output would overwrite a file that is read, or a table cannot be written."""
        from rocking_cli.io.files import keep_apart
        from rocking_cli.io.tables import check_table

        files = [str(each.path) if isinstance(each, tuple) else each for each in read]
        keep_apart([("--out", self.out), ("--plot", self.plot)], files)
        check_table(self.out)

    def write(self, answer: Answer[Any]) -> None:
        """Write the requested table and plot of an answer, make each only if needed, and report them."""
        if self.out is not None:
            write_table(self.out, answer.blocks() if answer.blocks is not None else [answer.columns()])
        if self.plot is not None:
            write_picture(self.plot, answer.figure())

    def show(self, answer: Answer[Any]) -> None:
        """Write the requested files of an answer, and show it."""
        self.write(answer)
        terminal.show(answer.view, as_json=self.as_json)
