"""`rocking record`: inspect records: their contents, strength and possible defects."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from rocking_cli.cli import options, terminal
from rocking_cli.cli.groups import Output, ReadingOptions
from rocking_cli.cli.help import Command
from rocking_cli.cli.quantities import FRACTION, PERIOD, range_of
from rocking_cli.cli.written import write_picture, write_table
from rocking_cli.errors import InputError, Problem
from rocking_cli.views.view import View

if TYPE_CHECKING:
    from rocking_cli.ask.ground_motions import Motions
    from rocking_cli.ask.record import RecordAnswer
    from rocking_cli.processing.oscillator import ResponseSpectrum
    from rocking_cli.views.record import Examined


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
@click.pass_context
@options.grouped(reading=ReadingOptions, output=Output)
def command(
    ctx: click.Context,
    files: tuple[str, ...],
    reading: ReadingOptions,
    output: Output,
    polarity: str,
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
    from rocking_cli.ask.ground_motions import signs_of
    from rocking_cli.ask.record import record
    from rocking_cli.cli.watching import OnTerminal
    from rocking_cli.io.files import keep_apart
    from rocking_cli.views.record import data, parts

    out, plot, kept, watch = output.out, output.plot, more["spectrum"], OnTerminal()
    first, *others = (reading.of(Path(file)) for file in files)
    motions = replace(first, sources=tuple(one for each in (first, *others) for one in each.sources))
    signs, alone = signs_of(polarity), motions.count == 1 and polarity != "both"
    if plot is not None and kept is None and not alone:
        raise click.UsageError("--plot draws a single record: give one FILE and one polarity.")
    clean = _clean_paths(out, motions, signs, alone=alone) if out is not None else {}
    outputs = [("--plot", plot), ("--spectrum", kept), *(("--out", path) for path in clean.values())]
    keep_apart(outputs, [*(str(each.path) for each in motions.records), more["structure"]])
    examined: list[Examined] = []
    for k, one in enumerate(motions.sources):
        try:
            answer = record(replace(motions, sources=(one,)), polarity=polarity, watch=watch, **more)
        except InputError as error:
            watch.leave_out(error)
            continue
        _write_clean(answer, [clean.get((k, sign)) for sign in signs])
        if plot is not None and kept is None:
            write_picture(plot, answer.figure())
        for seen in answer.examined if output.as_json else ():
            terminal.print_json(data(seen))
        examined += answer.examined
    if not examined:
        ctx.exit(InputError.exit_code)
    if kept is not None:
        _give_spectra(examined, kept, plot)
    if not output.as_json:
        terminal.show(View({}, list(parts(examined, terminal.width()))), as_json=False)
    watch.end()


def _clean_paths(out: Path, motions: Motions, signs: Sequence[int], *, alone: bool) -> dict[tuple[int, int], Path]:
    """Return the clean file of each record, by its place and polarity; in a folder, named after record and channel.

    All are checked: they can be written, and files that were not named and are not clean records are kept.
    """
    from rocking_cli.excitation.record_csv import is_record_csv
    from rocking_cli.excitation.records.opening import name_of
    from rocking_cli.io.files import check_writable, folder, keep_apart
    from rocking_cli.processing.listed import Listed

    if out.suffix.lower() == ".csv" and not out.is_dir():
        if not alone:
            raise click.UsageError("--out FILE.csv takes one record: give one FILE and one polarity, or a folder.")
        check_writable(out)
        return {(0, signs[0]): out}
    folder(str(out))
    paths: dict[tuple[int, int], Path] = {}
    for k, record in enumerate(motions.sources):
        if not isinstance(record, Listed):
            continue
        own = record.reading(motions.reading).channel
        suffix = "-" + re.sub(r"\W+", "-", own.strip()) if own is not None else ""
        for sign in signs:
            turned = "-reversed" if len(signs) > 1 and sign < 0 else ""
            path = out / f"{Path(name_of(record.path)).stem}{suffix}{turned}.csv"
            if path in paths.values():
                what = "two records would be written to the same file"
                raise InputError(Problem(what, str(path), hint="write them one by one"))
            keep_apart([("--out", path)], [str(each.path) for each in motions.records])
            if path.exists() and not is_record_csv(path):
                what = "--out would overwrite a file that rocking did not write"
                raise InputError(Problem(what, str(path), hint="move it, or name another folder"))
            check_writable(path)
            paths[k, sign] = path
    return paths


def _give_spectra(examined: Sequence[Examined], file: Path, plot: Path | None) -> None:
    """Write the spectra of all records into one file, and draw them in one plot."""
    from rocking_cli.views.response_spectrum import table

    spectra: dict[str, ResponseSpectrum] = {}
    for each in examined:
        assert each.spectrum is not None
        names = (
            each.label,
            f"{each.label} ({each.file})",
            *(f"{each.label} ({k})" for k in range(2, len(examined) + 2)),
        )
        spectra[next(name for name in names if name not in spectra)] = each.spectrum
    write_table(file, [table(spectra)])
    if plot is not None:
        from rocking_cli.plotting.response_spectrum import draw_response_spectra

        write_picture(plot, draw_response_spectra(spectra))


def _write_clean(answer: RecordAnswer, paths: Sequence[Path | None]) -> None:
    """Write the clean files of a record, one for each polarity."""
    from rocking_cli.excitation.record_csv import write_record_csv
    from rocking_cli.io.files import write_whole

    for motion, path in zip(answer.motions, paths, strict=True):
        if path is not None:
            write_whole(path, partial(write_record_csv, motion=motion))
            terminal.note(f"wrote {path.resolve()}")
