"""A list of records in a YAML file, as `rocking select` writes it: how to read each record, and its scale factor."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, Field, ValidationError, create_model

from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.records.opening import matching_files
from rocking_cli.io.field_problems import problems
from rocking_cli.io.yaml_file import parse, read_text
from rocking_cli.processing.reading import Listed, Reading, is_list, reading_of
from rocking_cli.processing.reading_options import READING
from rocking_cli.processing.steps import Factor, parse_steps

Positive = Annotated[float, Field(gt=0)]
SPELLED_ITEMS = ("units", "dt", "channel", "other_channel", "azimuth")
"""Options whose values are kept as their parser spells them; others as the file has them."""


def _parsed(parse: Callable[[Any], Any], *, spelled: bool = False) -> Callable[[Any], Any]:
    """Return a validator that checks a value by a parser raising `InputError`."""

    def check(value: Any) -> Any:
        try:
            parsed = None if value is None else parse(value)
        except InputError as error:
            (problem, *_) = error.problems
            raise ValueError("; ".join(part for part in (problem.message, problem.hint) if part)) from None
        return parsed if spelled else value

    return check


def _item(name: str) -> Any:
    """Return the field of an option, for a model of pydantic, with its default."""
    option = READING[name]
    checked = Annotated[Any, BeforeValidator(_parsed(option.parse, spelled=name in SPELLED_ITEMS))]
    return checked, Field(None, alias=option.key or None, description=option.help)


FloorItem = Annotated[Any, BeforeValidator(_parsed(READING["floor"].parse))]
Steps = Annotated[list[dict[str, Any] | str], AfterValidator(_parsed(parse_steps))]


class _Entry(BaseModel):
    """Fields of an entry that are no options of reading: its file, corrections, factor, weight, event and station."""

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True, allow_inf_nan=False)

    file: str | None = Field(None, description="a file, or a pattern of file names")
    processing: Steps | None = Field(None, description="corrections in their order, such as `- highpass: 0.1`")
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
        items = {name: getattr(self, name) for name in READING}
        if items["other"] is not None:
            items["other"] = folder / items["other"]
        factor = () if self.factor is None else (Factor(self.factor),)
        own_reading = reading_of(items)
        return Reading(own_reading.options, (*parse_steps(self.processing or []), *factor)).over(common).check()


if TYPE_CHECKING:

    class Entry(_Entry):
        """How a record is read and processed: the fields of `_Entry`, and the options of `ReadingArguments`."""

        def __getattr__(self, name: str) -> Any: ...
else:
    Entry = create_model("Entry", __base__=_Entry, __module__=__name__, **{name: _item(name) for name in READING})


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
    items = {
        option.key or name: value if isinstance(value, bool | float | str) else str(value)
        for name, option in READING.items()
        if (value := reading.options.get(name)) is not None
    }
    if reading.other is not None:
        items["with"] = relative(Path(reading.other), folder)
    return items | ({"processing": [str(step) for step in reading.steps]} if reading.steps else {})


def relative(file: Path, folder: Path) -> str:
    """Return the path of a file relative to a folder; on another drive of Windows, its absolute path."""
    try:
        return Path(os.path.relpath(file.resolve(), folder.resolve())).as_posix()
    except ValueError:
        return str(file.resolve())


SELECT_HINT = "write `records:`, and below it a line `- {file: a.csv}` for each; `rocking select` writes one"


class RecordList(BaseModel):
    """Content of a list of records."""

    model_config = ConfigDict(frozen=True, extra="ignore", strict=True, allow_inf_nan=False)

    records: list[Entry] = Field(min_length=1, description="the records")


def read_list(path: Path) -> list[Listed]:
    """Return the records of a list.

    Parameters
    ----------
    path : Path
        The YAML file; file names in it are relative to its folder.

    Raises
    ------
    InputError
        With every problem of the list.
    """
    document = parse(read_text(path, "list of records"), str(path), "list of records", SELECT_HINT)
    document.check()
    if "records" not in document.data and "mechanism" in document.data:
        what = "this is a structure, and no list of records"
        raise InputError(Problem(what, str(path), hint="a structure is given by its file alone, motions with `record`"))
    try:
        known = RecordList.model_validate(document.data)
    except ValidationError as error:
        errors: Any = error.errors(include_url=False)
        raise InputError(*problems(document, RecordList, errors, owner="the list", lister=SELECT_HINT)) from None
    listed: list[Listed] = []
    for k, entry in enumerate(known.records):
        if entry.file is None:
            document.problems.append(document.at(("records", k), "names no file"))
            continue
        try:
            files = matching_files(entry.file, path.parent)
            if any(is_list(file) for file in files):
                what = "is a list of records itself: name the records in it"
                document.problems.append(document.at(("records", k, "file"), what))
                continue
            listed += [Listed(file, entry, path.parent) for file in files]
        except InputError as error:
            place = ("records", k, "file")
            document.problems += [document.at(place, f"{one.file}: {one.message}", one.hint) for one in error.problems]
    document.check()
    return listed
