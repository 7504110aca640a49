"""Folder of a set of records: each scaled, as a clean file, and a list that names their origins."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rocking_cli.errors import InputError, Problem, named
from rocking_cli.processing.reading import LIST_FILE
from rocking_cli.text import numbered, one_line

if TYPE_CHECKING:
    from rocking_cli.excitation.base import GroundMotion
    from rocking_cli.processing.reading import Reading
    from rocking_cli.questions.select.view import ShownSet

OVERWRITE_HINT = "move it, or name another folder"
LIST_HEADER = "# A set of records, chosen by rocking select."


def write_set(folder_: Path, results: ShownSet, readings: Sequence[Reading | None]) -> str:
    """Write the scaled records and their list; records of an earlier set in that folder are removed.

    Parameters
    ----------
    folder_ : Path
        Folder, created if missing.
    results : ShownSet
        The set.
    readings : sequence of (Reading or None)
        How each record of the set was read; None if it cannot be read again: the list then names its scaled file.

    Returns
    -------
    str
        What was written and removed, in words.

    Notes
    -----
    The existing files have passed `check_folder`.
    """
    from rocking_cli.excitation.records.prepared import write_record_csv
    from rocking_cli.io.files import folder, write_files
    from rocking_cli.processing.steps import multiplied

    selection = results.found
    place = folder(str(folder_))
    paths = _paths(place, [selection.candidates.motions[k] for k in selection.chosen.tolist()])
    stale = [each for each in place.glob("*.csv") if each.name in _earlier(place / LIST_FILE) and each not in paths]

    def files() -> Iterator[tuple[str, bytes]]:
        for path, k, factor in zip(paths, selection.chosen.tolist(), selection.factors.tolist(), strict=True):
            write_record_csv(stream := BytesIO(), multiplied(selection.candidates.motions[k], factor))
            yield path.name, stream.getvalue()
        for each in stale:
            each.unlink()
        yield LIST_FILE, _list(place, results, readings, paths).encode("utf-8", "surrogateescape")

    write_files(place, files())
    gone = f"; {len(stale)} of an earlier set removed" if stale else ""
    return f"wrote {len(paths)} record{'s' * (len(paths) > 1)} and {LIST_FILE} to {place.resolve()}{gone}"


def _paths(place: Path, motions: list[GroundMotion]) -> list[Path]:
    """Return a file for each motion, after its name; if two names are equal, the second gets a number."""
    taken: list[str] = []
    for motion in motions:
        name, _, channel = motion.name.partition(" channel ")
        words = [Path(name).stem, *([channel] if channel else [])]
        stem = "-".join(re.sub(r"[^\w.+-]+", "-", word).strip("-") for word in words) or "record"
        taken.append(numbered(stem, ".csv", taken))
    return [place / each for each in taken]


def check_folder(folder_: Path, inputs: Sequence[Path]) -> None:
    """Check, before any work, that a set can be written into a folder, which is created if missing.

    Raises
    ------
    InputError
        If the folder holds input files, or records not written by this command.
    """
    from rocking_cli.excitation.records.prepared import is_record_csv
    from rocking_cli.io.files import check_writable, discard, folder

    place = folder(str(folder_))
    discard(place)
    for each in inputs:
        if each.exists() and each.resolve().parent == place.resolve():
            hint = "name a separate folder for the set"
            raise InputError(Problem(f"{named('out')} is the folder of an input file", str(each), hint=hint))
    check_writable(place / LIST_FILE)
    earlier = _earlier(place / LIST_FILE)
    for each in sorted(place.glob("*.csv")):
        if not (each.name in earlier and is_record_csv(each)):
            message = (
                "this file is in the folder of the set, and would be overwritten or mistaken for one of its records"
            )
            raise InputError(Problem(message, str(each), hint=OVERWRITE_HINT))


def _earlier(path: Path) -> set[str]:
    """Return the names of the files of an earlier set."""
    if not path.exists():
        return set()
    lines = path.read_text(encoding="utf-8", errors="replace").splitlines() if path.is_file() else []
    if lines[:1] != [LIST_HEADER]:
        raise InputError(
            Problem(f"{named('out')} would overwrite a file that rocking did not write", str(path), hint=OVERWRITE_HINT)
        )
    return {line.removeprefix("#   ") for line in lines if line.startswith("#   ")}


def _list(place: Path, results: ShownSet, readings: Sequence[Reading | None], paths: Sequence[Path]) -> str:
    """Return the list as YAML: the path of each record, its factor, and how it was read."""
    import yaml

    from rocking_cli.questions.select.view import verdict

    selection = results.found
    entries = [
        _entry(place, results.files[k], selection.candidates.motions[k], factor, reading)
        if reading is not None
        else {"file": path.name}
        for k, factor, reading, path in zip(
            selection.chosen.tolist(), selection.factors.tolist(), readings, paths, strict=True
        )
    ]
    lines = [
        LIST_HEADER,
        f"# Target: {results.target.name}",
        f"# {verdict(results)}",
        "# The same records, scaled already:",
    ]
    head = "".join(f"{one_line(line)}\n" for line in lines) + "".join(f"#   {path.name}\n" for path in paths)
    body = yaml.safe_dump({"records": entries}, sort_keys=False, allow_unicode=True, width=1000)
    return f"{head}{body}"


def _entry(place: Path, file: str | None, motion: GroundMotion, factor: float, reading: Reading) -> dict[str, Any]:
    """Return one record of the list."""
    from rocking_cli.processing.record_list import of_reading, relative

    assert file is not None
    named = {"event": motion.origin.event, "station": motion.origin.station}
    fields = {key: value for key, value in named.items() if value is not None}
    return {"file": relative(Path(file), place), **of_reading(reading, place), "factor": factor, **fields}
