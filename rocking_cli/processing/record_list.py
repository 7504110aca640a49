"""A list of records in a YAML file, as `rocking select` writes it: how to read each record, and its scale factor."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.records.opening import matching_files
from rocking_cli.io.field_problems import problems
from rocking_cli.io.yaml_file import parse, read_text
from rocking_cli.processing.entry import Entry
from rocking_cli.processing.listed import Listed, is_list

SELECT_HINT = "`rocking select` writes one"


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
