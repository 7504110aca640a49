"""A record as named in a study or a list of records, with its reading and its corrections."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, Field

from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.records.record_units import canonical
from rocking_cli.excitation.records.sensor import Gain, units_of
from rocking_cli.processing.floor import Floor
from rocking_cli.processing.reading import Reading
from rocking_cli.processing.steps import Factor, parse_steps

Positive = Annotated[float, Field(gt=0)]


def _parsed(parse: Callable[[Any], object]) -> AfterValidator:
    """Return a validator that checks a value by a parser raising `InputError`, and leaves the value unchanged."""

    def check(value: Any) -> Any:
        try:
            parse(value)
        except InputError as error:
            (problem, *_) = error.problems
            raise ValueError("; ".join(part for part in (problem.message, problem.hint) if part)) from None
        return value

    return AfterValidator(check)


def _unit(value: object) -> object:
    """Return a unit in its canonical spelling; raise `ValueError` for a text that is not a known unit.

    Units of velocity and displacement, and values that are not texts, are returned unchanged.
    """
    known = {name for quantity in ("acceleration", "velocity", "displacement") for name in units_of(quantity)}
    if value not in known and isinstance(value, str):
        found = canonical(value)
        if found is None:
            raise ValueError(f"must be one of {', '.join(sorted(known))}, got {value!r}")
        return found
    return value


def _numbered(value: object) -> object:
    """Return a channel given as a whole number as text: messages list channels by number."""
    return str(value) if isinstance(value, int) and not isinstance(value, bool) else value


Channel = Annotated[str, BeforeValidator(_numbered)]
Steps = Annotated[list[dict[str, Any] | str], _parsed(parse_steps)]
FloorText = Annotated[str | dict[str, Any], _parsed(Floor.parse)]


class Entry(BaseModel):
    """How a record is read and processed."""

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True, allow_inf_nan=False)

    file: str | None = Field(None, description="a file, or a pattern of file names")
    units: Annotated[str, BeforeValidator(_unit)] | None = Field(None, description="unit, where no file says")
    dt: Positive | None = Field(None, description="sample interval, where no file says")
    channel: Channel | None = Field(None, description="which of several channels")
    quantity: Literal["acceleration", "velocity", "displacement"] | None = Field(
        None, alias="from", description="what the file holds"
    )
    gain: Annotated[str, _parsed(Gain.parse)] | None = Field(
        None, description="what one unit of the file stands for, such as 0.05 m/V"
    )
    other: str | None = Field(None, alias="with", description="the file of the component at right angles")
    other_channel: Channel | None = Field(None, alias="with_channel", description="its channel")
    azimuth: float | None = Field(
        None, description="of the structure's plane, from the first component to the second [deg]"
    )
    processing: Steps | None = Field(None, description="corrections in their order, such as `- highpass: 0.1`")
    floor: FloorText | None = Field(None, description="the floor that the structure stands on, such as {T1: 0.4, ...}")
    factor: float | None = Field(None, description="factor on the record, as one of a set")
    event: str | None = Field(None, description="the earthquake, where its file does not say")
    station: str | None = Field(None, description="the station, where its file does not say")
    weight: Positive = Field(1.0, description="weight of the record relative to the others")

    def reading(self, folder: Path, common: Reading = Reading()) -> Reading:  # noqa: B008 - it does not change
        """Return how to read the record; missing items are taken from `common`, and its own corrections come first.

        Parameters
        ----------
        folder : Path
            Folder to which the entry's files are relative.
        common : Reading, optional
            Reading that all records share.

        Raises
        ------
        InputError
            If an azimuth has no second component, or a second component no azimuth.
        """
        if self.other is not None and self.azimuth is None and common.other is None:
            hint = "give 0 for the record, 90 for that of `with`, or what is between them"
            raise InputError(
                Problem("is missing: the file of a second component needs it", field="`azimuth`", hint=hint)
            )
        factor = () if self.factor is None else (Factor(self.factor),)
        gain = Gain.parse(self.gain) if self.gain is not None else common.gain
        return Reading(
            dt=_first(self.dt, common.dt),
            units=_first(self.units, common.units),
            channel=_first(self.channel, common.channel),
            quantity=_first(self.quantity, common.quantity),
            gain=gain,
            other=folder / self.other if self.other is not None else common.other,
            other_channel=_first(self.other_channel, common.other_channel),
            azimuth=_first(self.azimuth, common.azimuth),
            steps=(*parse_steps(self.processing or []), *factor, *common.steps),
            floor=Floor.parse(self.floor) if self.floor is not None else common.floor,
        )


def _first(own: Any, common: Any) -> Any:
    return common if own is None else own


def as_written(entry: Entry) -> Mapping[str, Any]:
    """Return the items of an entry, without its file, by the names under which they are written."""
    return entry.model_dump(exclude={"file"}, exclude_defaults=True, by_alias=True)


def of_reading(reading: Reading, folder: Path) -> dict[str, Any]:
    """Return the items of a study or list entry that describe a way of reading a record, by their names in files.

    Parameters
    ----------
    reading : Reading
        How the record is read.
    folder : Path
        Folder to which the entry's files are to be relative.
    """
    said = {
        "units": reading.units,
        "dt": reading.dt,
        "channel": reading.channel,
        "from": reading.quantity,
        "gain": str(reading.gain) if reading.gain is not None else None,
        "with": relative(Path(reading.other), folder) if reading.other is not None else None,
        "with_channel": reading.other_channel,
        "azimuth": reading.azimuth if reading.other is not None else None,
        "processing": [str(step) for step in reading.steps] or None,
        "floor": str(reading.floor) if reading.floor is not None else None,
    }
    return {key: value for key, value in said.items() if value is not None}


def relative(file: Path, folder: Path) -> str:
    """Return the path of a file relative to a folder; on another drive of Windows, its absolute path."""
    try:
        return Path(os.path.relpath(file.resolve(), folder.resolve())).as_posix()
    except ValueError:
        return str(file.resolve())
