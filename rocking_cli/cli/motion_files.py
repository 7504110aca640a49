"""Ground motions of a command: found, read, scaled and reported."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from textwrap import shorten
from typing import TYPE_CHECKING

import click

from rocking_cli.cli import terminal
from rocking_cli.cli.defaults import from_default
from rocking_cli.cli.options import STANDARD_OUTPUT
from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.scaled import Scaled
from rocking_cli.views.view import FEW

if TYPE_CHECKING:
    from rocking_cli.excitation.base import Doubt, GroundMotion
    from rocking_cli.excitation.measures import Measures
    from rocking_cli.excitation.pulses import Pulse
    from rocking_cli.processing.listed import Listed
    from rocking_cli.processing.reading import Reading

MOST_PGA, MOST_PGV = 1e3, 1e4  # g and m/s: beyond any ground motion, and too long to simulate


def factor(
    motion: GroundMotion, measured: Measures, scale: float | None, target_pga: float | None, target_pgv: float | None
) -> float:
    """Return the factor on a motion as read, from the options for scaling; the polarity is not included.

    Parameters
    ----------
    motion, measured : GroundMotion, Measures
        The motion and its measures.
    scale : float, optional
        Scale factor.
    target_pga : float, optional
        PGA to reach [g].
    target_pgv : float, optional
        PGV to reach [m/s].

    Returns
    -------
    float
        Scale factor; 1 if none of the three is given.

    Raises
    ------
    InputError
        If the motion is zero, or the scaled motion is beyond any ground motion.
    """
    if target_pga is None and target_pgv is None:
        by = 1.0 if scale is None else scale
    else:
        wanted, own = (target_pga, measured.pga) if target_pga is not None else (target_pgv, measured.pgv)
        assert wanted is not None
        if own == 0:
            raise InputError(Problem("the record is zero throughout and cannot be scaled to a peak", motion.name))
        by = wanted / own
    pga, pgv = abs(by) * measured.pga, abs(by) * measured.pgv
    if not (pga <= MOST_PGA and pgv <= MOST_PGV):
        scaled = f" scaled by {by:.4g}" if by != 1 else ""
        problem = f"PGA = {pga:.4g} g and PGV = {pgv:.4g} m/s{scaled} are not plausible for a ground motion"
        hint = f"at most {MOST_PGA:g} g and {MOST_PGV:g} m/s: check unit, interval and factor"
        raise InputError(Problem(problem, motion.name, hint=hint))
    return by


def warn(motion: GroundMotion, found: Iterable[Doubt]) -> None:
    """Warn of doubts about a motion."""
    for doubt in found:
        terminal.warning(f"{motion.name}: {doubt.text}")


def read(record: Listed, reading: Reading) -> GroundMotion:
    """Read a record; a default of an option that was not typed applies only if the file does not state the value."""
    from rocking_cli.excitation.records.opening import allow_again

    given, typed = _given_and_typed(record, reading)
    if typed != given:
        with suppress(InputError):
            return record.as_said(typed.read(record.path))
        allow_again(record.path)
    return record.as_said(given.read(record.path))


def settled(record: Listed, reading: Reading) -> Reading:
    """Return how `read` read a file, not standard input: without the defaults, unless the file needs them."""
    given, typed = _given_and_typed(record, reading)
    if typed != given:
        with suppress(InputError):
            typed.read(record.path)
            return typed
    return given


def _given_and_typed(record: Listed, reading: Reading) -> tuple[Reading, Reading]:
    """Return how to read a record with the defaults of options, and without; values of a list are not defaults."""
    from rocking_cli.excitation.records.sensor import size_of

    given = record.reading(reading)
    if from_default("units") and reading.units is not None:
        of = given.quantity or "acceleration"
        if given.gain is not None or (given.units == reading.units and size_of(reading.units, of) is None):
            reading = replace(reading, units=None)  # it says nothing of such a record
            given = record.reading(reading)
    typed = replace(
        reading,
        dt=None if from_default("dt") else reading.dt,
        units=None if from_default("units") else reading.units,
        channel=None if from_default("channel") else reading.channel,
    )
    return given, record.reading(typed)


def check_strays(files: Sequence[str], records: Sequence[str]) -> None:
    """Raise if records stand in the place of a structure: the shell puts the files of a bare pattern there."""
    endings = {Path(place).suffix.lower() for place in records} - {"", ".yaml", ".yml"}
    strays = [file for file in files if Path(file).suffix.lower() in endings]
    if strays:
        raise click.UsageError(
            f"{strays[0]} is given where a structure is expected. If it is a record, put --record before each file, "
            f"or use a quoted pattern: --record '*{Path(strays[0]).suffix}'."
        )


def find(places: Sequence[str]) -> tuple[list[Listed], int]:
    """Find the files of names, patterns and lists, each once; report and count those that match no file."""
    found, bad = find_all(places)
    once: dict[object, Listed] = {}
    for one in found:
        once.setdefault((one.path, one.folder, repr(one.entry)), one)
    return list(once.values()), bad


def find_all(places: Sequence[str]) -> tuple[list[Listed], int]:
    """Find all files of names, patterns and lists, in the given order, also those named several times."""
    from rocking_cli.excitation.selection import select
    from rocking_cli.processing.listed import Listed, is_list

    found: list[Listed] = []
    bad = 0
    for place in places:
        try:
            for path in select(place):
                inside = _of_list(path) if is_list(path) else [Listed(path)]
                found += inside
        except InputError as error:
            terminal.error(str(error))
            bad += 1
    return found, bad


def _of_list(path: Path) -> list[Listed]:
    from rocking_cli.processing.record_list import read_list

    return read_list(path)


def gather(
    records: Sequence[Listed],
    pulses: Sequence[str],
    reading: Reading,
    asked: tuple[float | None, float | None, float | None],
    p: float,
    whom: str = "the smallest size",
) -> tuple[list[Scaled], int]:
    """Read records and make pulses; warn of doubts, and report those that cannot be used.

    Parameters
    ----------
    records : sequence of Listed
        The records.
    pulses : sequence of str
        Specifications such as `sine:0.6g:0.8s`.
    reading : Reading
        Options for reading records, and the floor for all motions.
    asked : tuple
        Arguments `scale`, `target_pga` and `target_pgv` of `factor`.
    p : float
        Frequency parameter of the smallest structure under these motions [rad/s].
    whom : str
        Name of that structure in messages.

    Returns
    -------
    list of Scaled
        Usable motions, each with a unique name.
    int
        Number of unusable motions.

    Raises
    ------
    InputError
        If a pulse is malformed.
    """
    from rocking_cli.excitation.doubts import coarse_for, doubts
    from rocking_cli.excitation.measures import measure
    from rocking_cli.excitation.pulses import parse_pulse

    sources: list[Listed | Pulse] = [*records, *dict.fromkeys(parse_pulse(text) for text in pulses)]
    found: list[Scaled] = []
    doubtful: list[tuple[GroundMotion, list[Doubt]]] = []
    for place, source in enumerate(sources):
        try:
            if isinstance(source, tuple):
                each = Scaled(read(source, reading), 1.0, file=source.path, place=place)
            else:
                each = Scaled(reading.on_floor(source.sampled()), 1.0, pulse=source, place=place)
            motion = each.motion
            measured = measure(motion.of_ground)
            each = each._replace(factor=factor(motion, measured, *asked))
        except InputError as error:
            terminal.error(str(error))
            terminal.debug_traceback(error)
            continue
        if isinstance(source, tuple):
            if any(motion.name == other.motion.name for other in found):
                each = each._replace(motion=replace(motion, name=f"{motion.name} ({source.path.parent})"))
            doubtful.append((each.motion, doubts(motion.of_ground, measured) + coarse_for(motion, p, whom)))
        found.append(each)
    _introduce(found)
    _warn_of([each for each in doubtful if each[1]])
    return found, len(sources) - len(found)


def done(motion: GroundMotion) -> str:
    """Return what was done to a motion, as the continuation of a sentence."""
    from rocking_cli.views.processing import in_words

    return f"; {said}" if (said := in_words(motion)) else ""


def _introduce(found: Sequence[Scaled]) -> None:
    """Report the ground motions."""
    if len(found) <= FEW:
        for motion, by, *_ in found:
            pga = motion.of_ground.pga_g
            scaled = f", scaled by {by:.6g}: PGA = {abs(by) * pga:.4g} g" if by != 1 else ""
            terminal.note(
                f"motion: {motion.name} ({motion.format}), {motion.npts} points, dt = {motion.dt:.6g} s, "
                f"PGA = {pga:.4g} g{scaled}{done(motion)}"
            )
        return
    peaks = [abs(each.factor) * each.motion.of_ground.pga_g for each in found]
    scaled = " as scaled" if any(each.factor != 1 for each in found) else ""
    terminal.note(f"motions: {len(found)}, PGA from {min(peaks):.3g} to {max(peaks):.3g} g{scaled}")


def _warn_of(doubtful: Sequence[tuple[GroundMotion, list[Doubt]]]) -> None:
    """Warn of doubts about motions; briefly if there are many."""
    if len(doubtful) <= FEW:
        for motion, found in doubtful:
            warn(motion, found)
        return
    kinds = Counter(doubt.kind for _, found in doubtful for doubt in found)
    said = ", ".join(f"{kind} ({count})" for kind, count in kinds.most_common())
    names = shorten(", ".join(motion.name for motion, _ in doubtful), 200, placeholder=" ...")
    terminal.warning(f"{len(doubtful)} records are doubtful: {said}; run `rocking record` to see why: {names}")


def separate(path: Path | None, chosen: Sequence[Scaled | None], *, several: bool) -> Sequence[Path | None]:
    """Return the output file of each motion; of several, `out-accel.csv` and so on for `out.csv`."""
    if path is None or not several:
        return [path] * len(chosen)
    if str(path) == STANDARD_OUTPUT:
        raise click.UsageError(
            "--out - works for a single motion only: for several, give a file name; each motion is written to its own "
            "file based on it."
        )
    taken: dict[str, Path] = {}
    for each in chosen:
        assert each is not None
        name = each.motion.name if each.file is None else each.motion.name.replace(each.file.name, each.file.stem, 1)
        word = "-".join(re.findall(r"[\w.+]+", name)) or "motion"
        count = 1
        while (place := f"{path.stem}-{word}{f'-{count}' if count > 1 else ''}{path.suffix}").casefold() in taken:
            count += 1
        taken[place.casefold()] = path.with_name(place)
    return list(taken.values())
