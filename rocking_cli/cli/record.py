"""`rocking record`: what a ground motion is, how strong it is, and what is doubtful about it."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING

import click

from rocking_cli.cli import motions, options, terminal
from rocking_cli.cli.groups import Reading, Scaling
from rocking_cli.cli.pictures import write_picture
from rocking_cli.errors import INCOMPLETE, InputError, Problem

if TYPE_CHECKING:
    from rocking_cli.excitation.base import GroundMotion
    from rocking_cli.excitation.pulse_fit import PulseFit
    from rocking_cli.views.record import Shown

PATIENCE = 1.0  # s without a word


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
@options.grouped(reading=Reading, scaling=Scaling)
def command(
    ctx: click.Context,
    files: tuple[str, ...],
    reading: Reading,
    scaling: Scaling,
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
    if plot is not None and (len(files) > 1 or scaling.polarity == "both"):
        raise click.UsageError("--plot draws one record: give one FILE and one polarity.")
    from rocking_cli.excitation.records.opening import name_of
    from rocking_cli.io.files import keep_apart
    from rocking_cli.views.record import data, parts
    from rocking_cli.views.view import View

    signs = scaling.signs
    clean = _clean_paths(files, reading.channel, signs) if to else {}
    keep_apart([("--plot", plot), *((f"--to {to}", path) for path in clean.values())], [*files, structure])
    _spare_others(clean.values())
    p = _frequency(structure) if structure is not None else None

    shown: list[Shown] = []
    for file in files:
        found: list[Shown] = []
        try:
            from rocking_cli.excitation.records import read_record

            motion = read_record(file, dt=reading.dt, units=reading.units, channel=reading.channel)
            for sign in signs:
                one, scaled = _examine(name_of(file), motion, scaling.scaling, sign, p, pulse)
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
                terminal.print_json(data(one))
        motions.warn(motion, found[0].doubts)
    if shown and not as_json:
        terminal.show(View({}, list(parts(shown, terminal.width()))), as_json=False)
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
    from rocking_cli.views.record import Shown

    own = measure(motion)
    found = doubts(motion, own) + (coarse_for(motion, p) if p is not None else [])
    factor = polarity * motions.factor(motion, own, *asked)
    scaled = motion.scaled(factor)
    fits = _fit(scaled) if pulse else []
    p_dt = p * motion.dt if p is not None else None
    return Shown(file, motion.name, motion, factor, measure(scaled), found, p_dt, fits), scaled


def _fit(motion: GroundMotion) -> list[PulseFit]:
    """The best pulse of each shape by each criterion; says how far it is if that takes its time."""
    from rocking_cli.excitation.pulse_fit import CRITERIA, FITTED, fit_pulses

    fits: list[PulseFit] = []
    since = perf_counter()
    for fit in fit_pulses(motion):
        fits.append(fit)
        if perf_counter() - since > PATIENCE:
            terminal.note(f"{motion.name}: {len(fits)} of {len(CRITERIA) * len(FITTED)} pulses fitted")
            since = perf_counter()
    return fits


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
