"""`rk.select`: records for a target spectrum, and their folder: each scaled, and a list that names their origins."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from contextlib import ExitStack
from dataclasses import replace
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking_cli.ask.answer import Answer, Dimensions, drawn
from rocking_cli.ask.ground_motions import Motions
from rocking_cli.ask.inputs import site_of
from rocking_cli.ask.verbs import verb
from rocking_cli.ask.watcher import Watcher
from rocking_cli.errors import InputError, Problem, named
from rocking_cli.excitation.records.opening import STANDARD_INPUT
from rocking_cli.processing.reading import LIST_FILE, Listed
from rocking_cli.questions.select.asked import SelectAsked
from rocking_cli.questions.select.study import RecordSet
from rocking_cli.text import numbered, one_line

if TYPE_CHECKING:
    from rocking_cli.excitation.base import GroundMotion
    from rocking_cli.processing.reading import Reading
    from rocking_cli.questions.select.target_spectrum import TargetSpectrum
    from rocking_cli.questions.select.view import ShownSet

OVERWRITE_HINT = "move it, or name another folder"
LIST_HEADER = "# A set of records, chosen by rocking select."


@verb(SelectAsked)
def select(asked: SelectAsked, watch: Watcher) -> Answer[RecordSet]:
    """Select records whose mean response spectrum matches a target, with a scale factor for each.

    Returns
    -------
    Answer of RecordSet
        `fits` is whether the set stays within the limits, `motions` are the scaled records, and `factors` their scale
        factors; `mean`, and `periods`, `target` and `spectra` of `candidates`, are spectra.

    Raises
    ------
    InputError
        If a value is out of range, a file cannot be used, or there are too few records.

    Notes
    -----
    The limits are those of NTC 2018, 3.2.3.6; EN 1998-1:2004, 3.2.3.1.2(4), requires the lower one only, from 0.2 to 2
    times the fundamental period of a structure.
    """
    from rocking_cli.questions.select import study as record_set
    from rocking_cli.questions.select.view import ShownSet, table, title, view

    wanted = record_set.SetRequirements(
        asked.count, asked.band, asked.within, asked.damping, asked.factors, asked.one_per, asked.same_factor,
        asked.seed,
    )  # fmt: skip
    spectrum = _target(asked, watch)
    spectrum.check(wanted.band)
    motions = _without(asked.target, asked.ground_motions, watch)
    if asked.out is not None:
        target = [Path(asked.target)] if isinstance(asked.target, str | Path) else []
        check_folder(asked.out, [*target, *(each.path for each in motions.records)])
    chosen = motions.gather(0.0, watch)
    candidates = [each.motion for each in chosen]
    with watch.progress(len(candidates), "spectra") as advance:
        spectra = record_set.candidates(candidates, spectrum, wanted, advance)
    if coarse := record_set.coarse(spectra):
        worst = max(motion.dt for motion in coarse)
        watch.warn(
            f"the band begins at {wanted.band[0]:g} s, which is less than "
            f"{record_set.MIN_SAMPLES_PER_PERIOD} intervals of "
            f"{len(coarse)} of {len(candidates)} records (dt up to {worst:g} s): at such periods their spectra lack "
            "the motion between samples"
        )
    with ExitStack() as bars:
        result = record_set.choose(spectra, wanted, lambda total: bars.enter_context(watch.progress(total, "sets")))
    files = [str(each.file) if each.file else None for each in chosen]
    unusable = [str(each.path) for each in motions.records if all(each is not one.record for one in chosen)]
    results = ShownSet(result, spectrum, files, unusable)

    figure = drawn("questions.select.view.draw_record_set", result, title(results))
    if asked.out is not None:
        used = [chosen[k] for k in result.chosen.tolist()]
        readings = [None if str(each.file) == STANDARD_INPUT else each.reading for each in used]
        watch.note(write_set(asked.out, results, readings))
    dims = [Dimensions(("period",), ("target_Sa", "mean_Sa")), Dimensions(("motion", "period"))]
    return Answer("record set", result, view(results), lambda: table(results), figure, dims=dims)


def _without(target: object, motions: Motions, watch: Watcher) -> Motions:
    """Return the motions without the target, which a pattern may also match."""
    if not isinstance(target, str | Path) or not Path(target).exists():
        return motions
    others = [
        source
        for source in motions.sources
        if not (isinstance(source, Listed) and source.path.exists() and source.path.samefile(Path(target)))
    ]
    kept = replace(motions, sources=tuple(others))
    if kept.count < motions.count:
        if not kept:
            raise InputError(f"no records to choose from: {target} is the target; add the files of records")
        watch.note(f"{target} is the target spectrum and is not used as a record")
    return kept


def _target(asked: SelectAsked, watch: Watcher) -> TargetSpectrum:
    from rocking_cli.questions.select.target_spectrum import MAX_ORDINATE, TargetSpectrum, read_target, target_of_site

    given: Any = asked.target
    if asked.of_site:
        return target_of_site(site_of(given), asked.state, asked.damping)
    if isinstance(given, TargetSpectrum):
        return given
    if isinstance(given, str | Path):
        spectrum = read_target(Path(given))
        if spectrum.unit is None:
            watch.note(f"{given} does not name a unit: its ordinates are assumed to be in g")
        if (highest := float(spectrum.sa.max())) > MAX_ORDINATE:
            heading = "name its unit in a heading, such as period [s],Sa [m/s2]"
            watch.warn(f"{spectrum.name} reaches {highest:.4g} g: {heading}")
        return spectrum
    periods, sa = (np.atleast_1d(np.asarray(each, dtype=np.float64)) for each in given)
    return TargetSpectrum("target", periods, sa)


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
