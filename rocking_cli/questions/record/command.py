"""`rocking record`: inspect records: their contents, strength and possible defects."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from rocking_cli.cli import options, terminal
from rocking_cli.cli.groups import Output, ReadingOptions, write_picture, write_table
from rocking_cli.cli.help import Command
from rocking_cli.cli.quantities import FRACTION, PERIOD, range_of
from rocking_cli.cli.watching import OnTerminal
from rocking_cli.views.view import View

if TYPE_CHECKING:
    from rocking_cli.ask.answer import Answer


@click.command(cls=Command, short_help="Inspect records: contents, strength and possible defects.")
@click.argument("files", metavar="FILE...", nargs=-1, required=True, type=click.Path())
@options.reading
@options.scaling("1", "-1", "both")
@click.option(
    "--structure",
    type=click.Path(),
    metavar="FILE.yaml",
    help="Structure file, to check the sampling interval and for relative measures.",
)
@click.option(
    "--fit-pulse",
    is_flag=True,
    help="Fit a sine, a Ricker and a near-fault pulse to each record; --plot draws the best.",
)
@click.option(
    "-o",
    "--out",
    type=click.Path(path_type=Path),
    metavar="PLACE",
    help="Write each record as a clean CSV file of time and acceleration: FILE.csv, or a folder (created if missing) "
    "that receives NAME.csv.",
)
@click.option(
    "--measures",
    metavar="M,M,...",
    help="Intensity measures to compute as well, or all; `rocking measures` lists them.",
)
@click.option(
    "--spectrum",
    callback=options.output_path(".csv"),
    metavar="FILE.csv",
    help="Write the response spectrum of each record; --plot draws it and --json includes it.  - is standard output.",
)
@click.option(
    "--period", type=range_of(PERIOD), metavar="LOW:HIGH", help="Periods of the spectrum, in s.  [default: 0.02:10]"
)
@click.option("--damping", type=FRACTION, help=f"{options.HELP['damping']}  [default: 5%]")
@options.plot("Plot one record, or the spectra")
@options.as_json
@options.grouped(reading=ReadingOptions, output=Output)
def command(
    files: tuple[str, ...],
    reading: ReadingOptions,
    output: Output,
    polarity: str,
    spectrum: Path | None,
    **more: Any,
) -> None:
    """Inspect records: what was read, and how strong it is (peaks, Arias intensity, durations).

    The measures are those of the scaled record, exact for straight lines between its samples. Drifts, offsets, clipped
    peaks, coarse sampling and implausible units are reported as warnings, with the number that reveals them. With
    several files, or --polarity both, each record is a column on a terminal and a row in a pipe; with --json, each is
    one object on a line of its own. A file that cannot be used is reported and skipped, and the exit code is 5.

    FILE may be delimited text or in the format of a data centre, also in a gzip file or zip archive; - is standard
    input. If there are several columns, channels or files in an archive, choose one with --channel; without it they are
    listed.

    \b
    Example:
      rocking record accel.csv --plot record.png
      rocking record north.AT2 east.AT2 --target-pga 0.4
      rocking record station.V2 --channel 2 --out clean.csv
      rocking record table.csv --channel "acc x" --units g
      rocking record accel.csv --fit-pulse --plot pulse.png
      rocking record "north.AT2" "east.AT2" --spectrum spectra.csv --plot spectra.png
      rocking record accel.csv --measures "Sa(1.0), CAV, PGV/v_imp" --structure frame.yaml
    """
    from rocking_cli.ask.several import Answers
    from rocking_cli.io.files import keep_apart
    from rocking_cli.questions.record.verb import record
    from rocking_cli.questions.record.view import parts

    first, *others = (reading.of(Path(file)) for file in files)
    motions = replace(first, sources=tuple(one for each in (first, *others) for one in each.sources))
    several = motions.count > 1 or polarity == "both"
    if output.plot is not None and spectrum is None and several:
        raise click.UsageError("--plot draws a single record: give one FILE and one polarity.")
    read = [*(str(each.path) for each in motions.records), more["structure"]]
    keep_apart([("--plot", output.plot), ("--spectrum", spectrum)], read)
    watch = _Printing(as_json=output.as_json)
    answer = record(motions, polarity=polarity, spectrum=spectrum is not None, out=output.out, watch=watch, **more)
    if spectrum is not None:
        write_table(spectrum, [answer.tables["spectrum"]()])
    if output.plot is not None:
        write_picture(output.plot, answer.figure())
    if not output.as_json:
        answers = answer.values() if isinstance(answer, Answers) else [answer]
        examined = [seen for each in answers for seen in each.examined]
        terminal.show(View({}, list(parts(examined, terminal.width()))), as_json=False)
    watch.end()


class _Printing(OnTerminal):
    """Watcher that prints the JSON of every record as soon as it is ready, a line for each polarity."""

    def take(self, answer: Answer[Any]) -> bool:
        """Print an answer as JSON, if requested; all are kept."""
        from rocking_cli.questions.record.view import data

        for seen in answer.examined if self._as_json else ():
            terminal.print_json(data(seen))
        return False
