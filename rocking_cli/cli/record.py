"""`rocking record`: inspect records: their contents, strength and possible defects."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING

import click

from rocking_cli.cli import motion_files, options, terminal
from rocking_cli.cli.groups import Output, ReadingOptions, Scaling
from rocking_cli.cli.help import Command
from rocking_cli.cli.pictures import write_picture
from rocking_cli.cli.quantities import PERIOD, Range, Share
from rocking_cli.errors import INCOMPLETE, InputError, Problem

if TYPE_CHECKING:
    from rocking_cli.excitation.base import GroundMotion
    from rocking_cli.excitation.pulse_fit import PulseFit
    from rocking_cli.processing.intensity import Measure
    from rocking_cli.processing.listed import Listed
    from rocking_cli.processing.oscillator import ResponseSpectrum
    from rocking_cli.structure import Structure
    from rocking_cli.views.record import Examined

PATIENCE = 1.0  # s without a word


@dataclass(frozen=True)
class More:
    """Additional results of `rocking record`."""

    structure: str | None
    fit_pulse: bool
    measures: str | None
    spectrum: Path | None
    period: tuple[float, float] | None
    damping: float | None

    def __post_init__(self) -> None:
        if self.spectrum is None and (self.period is not None or self.damping is not None):
            raise click.UsageError("--period and --damping require a response spectrum: give --spectrum FILE.csv.")
        if self.measures is not None:  # before any record is read
            from rocking_cli.processing.intensity import parse_measures

            parse_measures(self.measures)

    @property
    def prepared(self) -> Structure | None:
        """Structure of --structure, prepared."""
        if self.structure is None:
            return None
        from rocking_cli.cli import structures

        return structures.prepared([self.structure])


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
    "--period", type=Range(PERIOD), metavar="LOW:HIGH", help="Periods of the spectrum, in s.  [default: 0.02:10]"
)
@click.option("--damping", type=Share(), callback=options.share, help=f"{options.HELP['damping']}  [default: 5%]")
@options.plot("Plot one record, or the spectra")
@options.as_json
@click.pass_context
@options.grouped(reading=ReadingOptions, scaling=Scaling, more=More, output=Output)
def command(
    ctx: click.Context,
    files: tuple[str, ...],
    reading: ReadingOptions,
    scaling: Scaling,
    more: More,
    output: Output,
) -> None:
    """Inspect records: what was read, and how strong it is (peaks, Arias intensity, durations).

    The measures are those of the scaled record, exact for straight lines between its samples. Drifts, offsets, clipped
    peaks, coarse sampling and implausible units are reported as warnings, with the number that reveals them. With
    several files, or --polarity both, the results follow one another; with --json, each is one object on a line of its
    own. A file that cannot be used is reported and skipped, and the exit code is 5.

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
    out, plot = output.out, output.plot
    records, bad = motion_files.find_all(files)
    alone = len(records) + bad == 1 and scaling.polarity != "both"
    if plot is not None and more.spectrum is None and not alone:
        raise click.UsageError("--plot draws a single record: give one FILE and one polarity.")
    from rocking_cli.io.files import keep_apart
    from rocking_cli.views.record import data, parts
    from rocking_cli.views.view import View

    clean = _clean_paths(out, records, reading.channel, scaling.signs, alone=alone) if out is not None else {}
    kept = [("--plot", plot), ("--spectrum", more.spectrum), *(("--out", path) for path in clean.values())]
    keep_apart(kept, [*(str(each.path) for each in records), more.structure])
    _make_room(out, clean.values())
    asked = _Asked(reading, scaling, more, more.prepared, plot if more.spectrum is None else None)
    examined: list[Examined] = []
    for k, record in enumerate(records):
        try:
            found = asked.of(record, [clean.get((k, sign)) for sign in scaling.signs])
        except InputError as error:
            terminal.error(str(error))
            terminal.debug_traceback(error)
            continue
        examined += found
        if output.as_json:
            for one in found:
                terminal.print_json(data(one))
        motion_files.warn(found[0].motion, found[0].doubts)
    if examined and more.spectrum is not None:
        _give_spectra(examined, more.spectrum, plot)
    if examined and not output.as_json:
        terminal.show(View({}, list(parts(examined, terminal.width()))), as_json=False)
    if len(examined) < (len(records) + bad) * len(scaling.signs):
        ctx.exit(INCOMPLETE if examined else InputError.exit_code)


def _clean_paths(
    out: Path, records: Sequence[Listed], channel: str | None, signs: Sequence[int], *, alone: bool
) -> dict[tuple[int, int], Path]:
    """Return the clean file of each record, by its place and polarity; in a folder, named after record and channel."""
    from rocking_cli.excitation.records.opening import name_of

    if _is_file(out):
        if not alone:
            raise click.UsageError("--out FILE.csv takes one record: give one FILE and one polarity, or a folder.")
        return {(0, signs[0]): out}
    paths: dict[tuple[int, int], Path] = {}
    for k, record in enumerate(records):
        own = record.entry.channel if record.entry is not None and record.entry.channel is not None else channel
        suffix = "-" + re.sub(r"\W+", "-", own.strip()) if own is not None else ""
        for sign in signs:
            turned = "-reversed" if len(signs) > 1 and sign < 0 else ""
            path = out / f"{Path(name_of(record.path)).stem}{suffix}{turned}.csv"
            if path in paths.values():
                raise InputError(
                    Problem("two records would be written to the same file", str(path), hint="write them one by one")
                )
            paths[k, sign] = path
    return paths


def _is_file(out: Path) -> bool:
    return out.suffix.lower() == ".csv" and not out.is_dir()


def _make_room(out: Path | None, paths: Iterable[Path]) -> None:
    """Check that the files can be written; files that were not named and are not clean records are kept."""
    from rocking_cli.excitation.record_csv import is_record_csv
    from rocking_cli.io.files import check_writable, folder

    if out is None:
        return
    if not _is_file(out):
        folder(str(out))
    for path in paths:
        if not _is_file(out) and path.exists() and not is_record_csv(path):
            hint = "move it, or name another folder"
            raise InputError(Problem("--out would overwrite a file that rocking did not write", str(path), hint=hint))
        check_writable(path)


def _give_spectra(examined: Sequence[Examined], file: Path, plot: Path | None) -> None:
    """Write the spectra of all records into one file, and draw them in one plot."""
    from rocking_cli.cli import table_files
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
    table_files.write(file, [table(spectra)])
    if plot is not None:
        from rocking_cli.plotting.response_spectrum import draw_response_spectra

        write_picture(plot, draw_response_spectra(spectra))


@dataclass(frozen=True, eq=False)
class _Asked:
    """Options that apply to every record.

    Parameters
    ----------
    reading, scaling : ReadingOptions, Scaling
        Options for reading and scaling.
    more : More
        Additional results.
    structure : Structure or None
        Structure for checking the sampling interval and for relative measures.
    plot : Path or None
        File of the plot.
    """

    reading: ReadingOptions
    scaling: Scaling
    more: More
    structure: Structure | None
    plot: Path | None

    def of(self, record: Listed, clean: Sequence[Path | None]) -> list[Examined]:
        """Read a record, examine it in each polarity, and write its clean files."""
        from rocking_cli.excitation.records.opening import name_of

        motion = motion_files.read(record, self.reading.reading)
        if any(each.startswith("from ") for each in motion.processing):
            terminal.note(f"{motion.name}{motion_files.done(motion)}")
        found = []
        for sign, path in zip(self.scaling.signs, clean, strict=True):
            one, scaled = self._examine(name_of(record.path), motion, sign)
            if len(self.scaling.signs) > 1 and sign < 0:
                one = one._replace(label=f"{one.label}, reversed")
            if path is not None:
                _write(path, scaled)
            if self.plot is not None:
                _draw(self.plot, scaled, one, self._before(record))
            found.append(one)
        return found

    def _before(self, record: Listed) -> GroundMotion | None:
        """Return the record without its corrections, for comparison; None if it has none."""
        from rocking_cli.excitation.records.opening import allow_again
        from rocking_cli.processing.listed import Listed
        from rocking_cli.processing.steps import Resample

        asked = record.reading(self.reading.reading)
        if not asked.steps:
            return None
        allow_again(record.path)
        grid = tuple(step for step in asked.steps if isinstance(step, Resample))  # uneven times cannot do without
        return motion_files.read(Listed(record.path), replace(asked, steps=grid, floor=None))

    def _examine(self, file: str, motion: GroundMotion, polarity: int) -> tuple[Examined, GroundMotion]:
        """Return the record and its scaled motion; the record as read is checked for doubts."""
        from rocking_cli.excitation.doubts import coarse_for, doubts
        from rocking_cli.excitation.measures import measure
        from rocking_cli.views.record import Examined

        own, p = measure(motion.of_ground), self.structure.p if self.structure is not None else None
        found = doubts(motion.of_ground, own) + (coarse_for(motion, p) if p is not None else [])
        factor = polarity * motion_files.factor(motion, own, *self.scaling.scaling)
        scaled = motion.scaled(factor)
        fits = _fit(scaled) if self.more.fit_pulse else []
        p_dt = p * motion.dt if p is not None else None
        seen = Examined(file, motion.name, motion, factor, measure(scaled), found, p_dt, fits)
        return seen._replace(asked=self._measured(scaled), spectrum=self._spectrum(scaled)), scaled

    def _measured(self, motion: GroundMotion) -> dict[Measure, float]:
        """Compute the measures given by name; `all` without a structure means those that need none."""
        if self.more.measures is None:
            return {}
        from rocking_cli.processing.intensity import ALL, parse_measures
        from rocking_cli.studies.motion_intensities import intensities, reference_of

        asked = parse_measures(self.more.measures)
        if self.structure is None and self.more.measures.strip().lower() == ALL:
            asked = [each for each in asked if not each.is_relative]
        return intensities(motion, asked, reference_of(self.structure) if self.structure is not None else None)

    def _spectrum(self, motion: GroundMotion) -> ResponseSpectrum | None:
        if self.more.spectrum is None:
            return None
        from rocking_cli.processing import oscillator

        low, high = self.more.period or (oscillator.SHORTEST, oscillator.LONGEST)
        damping = oscillator.DAMPING if self.more.damping is None else self.more.damping
        return oscillator.response_spectrum(motion, oscillator.periods_between(low, high), damping)


def _fit(motion: GroundMotion) -> list[PulseFit]:
    """Fit the best pulse of each shape by each criterion; report progress if that takes long."""
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


def _draw(path: Path, motion: GroundMotion, examined: Examined, before: GroundMotion | None) -> None:
    from rocking_cli.plotting.processing import draw_before_and_after
    from rocking_cli.plotting.pulse_fit import draw_pulses
    from rocking_cli.plotting.record import draw_record

    if examined.pulses:
        end = examined.measures.t_95 or motion.duration
        write_picture(path, draw_pulses(motion, _best(examined.pulses), end))
    elif before is not None:
        write_picture(path, draw_before_and_after(before.scaled(examined.factor), motion, _shift(motion)))
    else:
        write_picture(path, draw_record(motion, examined.measures))


def _shift(motion: GroundMotion) -> float:
    """Return the start of a motion, on the time axis of the record as read [s]."""
    from rocking_cli.processing.steps import Trim

    words = (each.split() for each in motion.processing)
    return sum(Trim.parse(given).start for name, *rest in words if name == Trim.name for given in rest)


def _best(fits: Sequence[PulseFit]) -> list[PulseFit]:
    """Return the fitted pulse that captures most, by each criterion, velocity first."""
    by_criterion = {fit.criterion: fit for fit in sorted(fits, key=lambda fit: fit.captured)}
    return [by_criterion["velocity"], by_criterion["acceleration"]]
