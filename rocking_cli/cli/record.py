"""`rocking record`: what a ground motion is, how strong it is, and what is doubtful about it."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import click

from rocking_cli.cli import motions, options, terminal
from rocking_cli.cli.pictures import write_picture
from rocking_cli.errors import INCOMPLETE, InputError, Problem
from rocking_cli.views.view import ABSENT, number

if TYPE_CHECKING:
    from rocking_cli.excitation.base import GroundMotion
    from rocking_cli.excitation.doubts import Doubt
    from rocking_cli.excitation.measures import Measures
    from rocking_cli.excitation.pulse_fit import PulseFit

HEADING = 14  # characters of a record's name in a line above its column
LEFT = 26  # characters that labels and units take of a table
BESIDE = 3  # blanks between columns
POLARITIES = {"1": (1,), "-1": (-1,), "both": (1, -1)}


class Shown(NamedTuple):
    """A record as read, the factor on it, and of the scaled one measures, doubts, p dt of a structure and pulses.

    `label` is what to call it: of both polarities the reversed one says so.
    """

    file: str
    label: str
    motion: GroundMotion
    factor: float
    measures: Measures
    doubts: list[Doubt]
    p_dt: float | None
    pulses: list[PulseFit]


@click.command(short_help="What records are, how strong, and what is doubtful about them.")
@click.argument("files", metavar="FILE...", nargs=-1, required=True, type=click.Path())
@options.reading
@options.scaling("1", "-1", "both", both="each after the other")
@click.option(
    "--structure", type=click.Path(), metavar="FILE.yaml", help="Check the sample interval against this structure."
)
@click.option(
    "--pulse", is_flag=True, help="Fit a sine, a Ricker and a near-fault pulse to each; --plot draws the best."
)
@click.option(
    "--to", type=click.Choice(["csv"]), help="Write each as a clean file of t and a, NAME.csv in this folder."
)
@options.plot("Draw one record")
@options.as_json
@click.pass_context
def command(
    ctx: click.Context,
    files: tuple[str, ...],
    units: str | None,
    dt: float | None,
    channel: str | None,
    scale: float | None,
    target_pga: float | None,
    target_pgv: float | None,
    polarity: str,
    structure: str | None,
    pulse: bool,
    to: str | None,
    plot: Path | None,
    as_json: bool,
) -> None:
    """What was read of records, and how strong they are: peaks, Arias intensity, durations.

    The measures are those of the scaled record, exact for straight lines between its samples. A drift, an offset,
    clipped peaks, a coarse interval and an odd unit are warned of, with the number that shows it. With --json,
    several files give one object a line, as do both polarities. A file that cannot be used is reported, the others
    are shown, and the exit code is 5.

    FILE may be delimited text or a data centre's format, in a gzip file or zip archive too; - is standard input. Of
    several columns, channels or files of an archive --channel chooses one; without it they are listed.

    \b
    Example:
      rocking record accel.csv --plot record.png
      rocking record north.AT2 east.AT2 --target-pga 0.4
      rocking record station.V2 --channel 2 --to csv
      rocking record table.csv --channel "acc x" --units g
      rocking record accel.csv --pulse --plot pulse.png
    """
    motions.check_scaling(scale, target_pga, target_pgv)
    if plot is not None and (len(files) > 1 or polarity == "both"):
        raise click.UsageError("--plot draws one record: give one FILE and one polarity.")
    from rocking_cli.excitation.records.opening import name_of
    from rocking_cli.io.files import keep_apart

    signs = POLARITIES[polarity]
    clean = _clean_paths(files, channel, signs) if to else {}
    keep_apart([("--plot", plot), *((f"--to {to}", path) for path in clean.values())], [*files, structure])
    _spare_others(clean.values())
    p = _frequency(structure) if structure is not None else None

    shown: list[Shown] = []
    for file in files:
        found: list[Shown] = []
        try:
            from rocking_cli.excitation.records import read_record

            motion = read_record(file, dt=dt, units=units, channel=channel)
            for sign in signs:
                one, scaled = _examine(name_of(file), motion, (scale, target_pga, target_pgv), sign, p, pulse)
                if len(signs) > 1 and sign < 0:
                    one = one._replace(label=f"{one.label}, reversed")
                if to:
                    _write(clean[file, sign], scaled)
                if plot is not None:
                    _draw(plot, scaled, one)
                found.append(one)
        except InputError as error:
            terminal.error(str(error))
            terminal.plugin_traceback(error)
            continue
        shown += found
        if as_json:
            for one in found:
                terminal.print_json(_as_json(one))
        motions.warn(motion, found[0].doubts)
    if shown and not as_json:
        _print_tables(shown)
    if len(shown) < len(files) * len(signs):
        ctx.exit(INCOMPLETE if shown else InputError.exit_code)


def _clean_paths(files: Sequence[str], channel: str | None, signs: Sequence[int]) -> dict[tuple[str, int], Path]:
    """Where the clean file of each record goes: into this folder, named after the record and the channel asked for."""
    from rocking_cli.excitation.records.opening import name_of

    suffix = "-" + re.sub(r"\W+", "-", channel.strip()) if channel is not None else ""
    paths: dict[tuple[str, int], Path] = {}
    for file in files:
        for sign in signs:
            turned = "-reversed" if len(signs) > 1 and sign < 0 else ""
            path = Path(f"{Path(name_of(file)).stem}{suffix}{turned}.csv")
            if path in paths.values():
                raise InputError(Problem("two records would be written there", str(path), hint="write them one by one"))
            paths[file, sign] = path
    return paths


def _spare_others(paths: Iterable[Path]) -> None:
    """Refuse to replace a file that is no clean record: its name was not given, so nobody meant it."""
    from rocking_cli.excitation.record_csv import is_record_csv

    for path in paths:
        if path.exists() and not is_record_csv(path):
            hint = "move it away, or work in another folder"
            raise InputError(Problem("--to csv would replace a file that it did not write", str(path), hint=hint))


def _frequency(structure: str) -> float:
    """The larger frequency parameter of a structure [rad/s]."""
    from rocking_cli.cli import structures

    return structures.prepared([structure]).p


def _examine(
    file: str,
    motion: GroundMotion,
    asked: tuple[float | None, float | None, float | None],
    polarity: int,
    p: float | None,
    pulse: bool,
) -> tuple[Shown, GroundMotion]:
    """The record and its scaled motion; what is doubtful is looked for in the record as read."""
    from rocking_cli.excitation.doubts import coarse_for, doubts
    from rocking_cli.excitation.measures import measure

    own = measure(motion)
    found = doubts(motion, own) + (coarse_for(motion, p) if p is not None else [])
    factor = polarity * motions.factor(motion, own, *asked)
    scaled = motion.scaled(factor)
    fits: list[PulseFit] = []
    if pulse:
        from rocking_cli.cli import pulse_fits

        fits = pulse_fits.find(scaled)
    p_dt = p * motion.dt if p is not None else None
    return Shown(file, motion.name, motion, factor, measure(scaled), found, p_dt, fits), scaled


def _write(path: Path, motion: GroundMotion) -> None:
    from rocking_cli.excitation.record_csv import write_record_csv
    from rocking_cli.io.files import write_whole

    write_whole(path, lambda stream: write_record_csv(stream, motion))
    terminal.note(f"wrote {path.resolve()}")


def _draw(path: Path, motion: GroundMotion, shown: Shown) -> None:
    from rocking_cli.plotting.pulse_fit import draw_pulses
    from rocking_cli.plotting.record import draw_record

    if shown.pulses:
        end = shown.measures.t_95 or motion.duration
        write_picture(path, draw_pulses(motion, _best(shown.pulses), end))
    else:
        write_picture(path, draw_record(motion, shown.measures))


def _best(fits: Sequence[PulseFit]) -> list[PulseFit]:
    """Of the pulses fitted by each criterion the one that captures most, velocity first."""
    by_criterion = {fit.criterion: fit for fit in sorted(fits, key=lambda fit: fit.captured)}
    return [by_criterion["velocity"], by_criterion["acceleration"]]


def _channel(record: Shown) -> str | None:
    """The channel, of a file with several: readers put it into the name of the motion."""
    return record.motion.name.partition(f"{Path(record.file).name} channel ")[2] or None


def _as_json(record: Shown) -> dict[str, Any]:
    motion, measures = record.motion, record.measures
    found: dict[str, Any] = {
        "file": record.file,
        "name": motion.name,
        "format": motion.format,
        "channel": _channel(record),
        "unit": motion.unit,
        "npts": motion.npts,
        "dt": motion.dt,
        "duration": motion.duration,
        "factor": record.factor,
        "pga": measures.pga,
        "pgv": measures.pgv,
        "pgd": measures.pgd,
        "arias_intensity": measures.arias,
        "significant_duration": measures.significant_duration,
        "t_5": measures.t_5,
        "t_95": measures.t_95,
        "mean_acceleration": measures.mean,
        "final_velocity": measures.final_velocity,
        "final_displacement": measures.final_displacement,
        "p_dt": record.p_dt,
        "warnings": [doubt._asdict() for doubt in record.doubts],
    }
    if record.pulses:
        from rocking_cli.cli.pulse_fits import fits_json

        found["pulses"] = fits_json(record.pulses)
    return found


def _rows(records: Sequence[Shown]) -> list[list[str]]:
    """The rows of the table: a label, a cell for each record, a unit."""
    rows = [
        ("format", [_folded(r.motion.format) for r in records], ""),
        ("channel", [_channel(r) or ABSENT for r in records], ""),
        ("unit in the file", [r.motion.unit for r in records], ""),
        ("points", [str(r.motion.npts) for r in records], ""),
        ("dt", [number(r.motion.dt) for r in records], "s"),
        ("duration", [number(r.motion.duration) for r in records], "s"),
        ("scaled by", [number(r.factor) for r in records], ""),
        ("PGA", [number(r.measures.pga, 4) for r in records], "g"),
        ("PGV", [number(r.measures.pgv, 4) for r in records], "m/s"),
        ("PGD", [number(r.measures.pgd, 4) for r in records], "m"),
        ("Arias intensity", [number(r.measures.arias, 4) for r in records], "m/s"),
        ("5-95 % duration", [number(r.measures.significant_duration, 4) for r in records], "s"),
        ("from", [number(r.measures.t_5, 4) for r in records], "s"),
        ("to", [number(r.measures.t_95, 4) for r in records], "s"),
        ("mean acceleration", [number(r.measures.mean, 2) for r in records], "g"),
        ("p dt", [number(r.p_dt, 2) for r in records], ""),
    ]
    silent = {"channel": ABSENT, "scaled by": "1", "p dt": ABSENT}  # says nothing if all are this
    return [
        [label, *cells, unit]
        for label, cells, unit in rows
        if label not in silent or any(cell != silent[label] for cell in cells)
    ]


def _print_tables(records: Sequence[Shown]) -> None:
    """A column for each record, in as many tables below one another as the terminal needs."""
    names = [record.label if len(records) == 1 else _folded(record.label) for record in records]
    rows = _rows(records)
    fitting = max((terminal.width() - LEFT) // (HEADING + BESIDE), 1)
    for start in range(0, len(records), fitting):
        part = slice(start, start + fitting)
        cells = [[row[0], *row[1:-1][part], row[-1]] for row in rows]
        title, headings = (names[0], ["value"]) if len(records) == 1 else ("", names[part])
        terminal.table(title, ["", *headings, "unit"], cells, numbers=range(1, len(headings) + 1))
    for record in records:
        if record.pulses:
            from rocking_cli.cli import pulse_fits

            pulse_fits.print_tables(record.label, record.pulses)


def _folded(name: str) -> str:
    """A name broken into lines of a column's width, at blanks where there are some."""
    from textwrap import wrap

    return "\n".join(wrap(name, HEADING))
