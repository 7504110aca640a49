"""`rocking select`: select records whose mean response spectrum matches a target."""

from __future__ import annotations

from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import click

from rocking_cli.cli import complete, motion_files, options, terminal
from rocking_cli.cli.groups import Output, ReadingOptions
from rocking_cli.cli.help import Command
from rocking_cli.cli.quantities import PERIOD, QuantityKind, Range, Share
from rocking_cli.errors import INCOMPLETE, InputError

if TYPE_CHECKING:
    from rocking_cli.excitation.base import GroundMotion
    from rocking_cli.excitation.scaled import Scaled
    from rocking_cli.processing.listed import Listed
    from rocking_cli.studies.record_set import RecordSet, SetRequirements
    from rocking_cli.studies.target_spectrum import TargetSpectrum
    from rocking_cli.views.record_set import ShownSet

RATIO = QuantityKind("ratio", "", "0.9", "0.9:1.3", 1e-3, 1e3)
FACTOR = QuantityKind("factor", "", "0.5", "0.5:3", 1e-6, 1e6)
MOST = 1000  # records of a set


@dataclass(frozen=True)
class SetOptions:
    """Requirements on the set of records."""

    count: int
    band: tuple[float, float]
    within: tuple[float, float]
    damping: float
    factors: tuple[float, float]
    one_per: str
    same_factor: bool
    seed: int

    @property
    def wanted(self) -> SetRequirements:
        """Requirements, in the form that the study needs."""
        from rocking_cli.studies.record_set import SetRequirements

        return SetRequirements(**vars(self))


@click.command(cls=Command, short_help="Select records whose mean spectrum matches a target.")
@click.argument("records", metavar="RECORD...", nargs=-1, required=True, type=click.Path())
@click.option(
    "--target",
    required=True,
    type=click.Path(path_type=Path),
    metavar="SPECTRUM.csv",
    shell_complete=complete.files,
    help="Target spectrum: one column of periods in s, and one of ordinates in g or in the unit of its heading.",
)
@click.option(
    "--band",
    required=True,
    type=Range(PERIOD),
    metavar="FROM:TO",
    help="Period range over which the mean must match, in s.",
)
@click.option("--count", required=True, type=click.IntRange(1, MOST), metavar="N", help="Number of records to select.")
@click.option(
    "--within",
    type=Range(RATIO),
    default="0.9:1.3",
    show_default=True,
    metavar="LOW:HIGH",
    help="Lower and upper limit on the ratio of mean to target.",
)
@click.option(
    "--damping",
    type=Share(),
    default="5%",
    show_default=True,
    callback=options.share,
    metavar="SHARE",
    help=options.HELP["damping"],
)
@click.option(
    "--factors",
    type=Range(FACTOR),
    default="0.2:5",
    show_default=True,
    metavar="LOW:HIGH",
    help="Lower and upper limit on the scale factor of each record.",
)
@click.option(
    "--one-per",
    type=click.Choice(["event", "station", "none"]),
    default="event",
    show_default=True,
    help="Origin from which at most one record is taken, if the files name it.",
)
@click.option("--same-factor", is_flag=True, help="Scale all records by the same factor.")
@click.option(
    "--seed",
    type=click.IntRange(0),
    default=0,
    show_default=True,
    metavar="N",
    help="Seed of the random searches, if any.",
)
@options.reading
@click.option(
    "-o",
    "--out",
    type=click.Path(path_type=Path),
    metavar="FOLDER",
    help="Write the scaled records and a list of them, set.yaml, into this folder.",
)
@options.plot("Plot the spectra, their mean and the target")
@options.as_json
@click.pass_context
@options.grouped(asked=SetOptions, reading=ReadingOptions, output=Output)
def command(
    ctx: click.Context,
    records: tuple[str, ...],
    target: Path,
    asked: SetOptions,
    reading: ReadingOptions,
    output: Output,
) -> None:
    """Select records whose mean response spectrum matches a target, with a scale factor for each.

    Among the sets of --count records whose mean stays within the limits over the whole band, the command selects the
    one whose mean is closest to the target. Each record is first scaled to match the target on average over the band;
    then one common factor is applied to all. The default limits are those of NTC 2018; EN 1998-1 requires the lower
    limit of 0.9 only, from 0.2 to 2 times the period of the structure. The target has the damping ratio of --damping.

    RECORD is a file or a quoted pattern. A record that cannot be used is reported and skipped, and the exit code is 5.
    If no set stays within the limits, the closest one is shown, with the periods at which it exceeds them.

    \b
    Example:
      rocking select "records/*.AT2" --target ec8.csv --band 0.2:4 --count 7
      rocking select "records/*.AT2" --target ec8.csv --band 0.2:2 --count 7 --factors 0.5:3 -o set --plot set.png
      rocking respond block.yaml --record "set/*.csv"
    """
    from rocking_cli.cli.set_folder import check_folder
    from rocking_cli.io.files import keep_apart
    from rocking_cli.studies.target_spectrum import doubts, read_target

    wanted = asked.wanted
    listed, missing = motion_files.find(records)
    listed = _without(target, listed)
    paths = [target, *(each.path for each in listed)]
    keep_apart([("--plot", output.plot)], [str(path) for path in paths])
    if output.out is not None:
        check_folder(output.out, paths)
    spectrum = read_target(target)
    spectrum.check(wanted.band)
    if spectrum.unit is None:
        terminal.note(f"{target} does not name a unit: its ordinates are assumed to be in g")
    for doubt in doubts(spectrum):
        terminal.warning(doubt)
    chosen, refused = motion_files.gather(listed, (), reading.reading, (None, None, None), 0.0)
    if not chosen:
        ctx.exit(InputError.exit_code)
    results = _results(chosen, listed, spectrum, wanted)
    if output.out is not None:
        from rocking_cli.cli.set_folder import write_set

        sources = [listed[chosen[k].place] for k in results.found.chosen.tolist()]
        again = [None if str(each.path) == options.STANDARD_OUTPUT else each for each in sources]
        write_set(
            output.out,
            results,
            [motion_files.settled(each, reading.reading) if each is not None else None for each in again],
        )
    if output.plot is not None:
        from rocking_cli.cli.pictures import write_picture
        from rocking_cli.plotting.record_set import draw_record_set
        from rocking_cli.views.record_set import title

        write_picture(output.plot, draw_record_set(results.found, title(results)))
    from rocking_cli.views.record_set import view

    terminal.show(view(results), as_json=output.as_json)
    if missing or refused:
        ctx.exit(INCOMPLETE)


def _without(target: Path, listed: list[Listed]) -> list[Listed]:
    """Return the records without the target, which a pattern may also match."""
    kept = [each for each in listed if not (each.path.exists() and target.exists() and each.path.samefile(target))]
    if len(kept) < len(listed):
        if not kept:
            raise click.UsageError(f"No records to choose from: {target} is the target. Add the record files.")
        terminal.note(f"{target} is the target spectrum and is not used as a record")
    return kept


def _results(chosen: list[Scaled], listed: list[Listed], target: TargetSpectrum, wanted: SetRequirements) -> ShownSet:
    """Select among the records that were read."""
    from rocking_cli.views.record_set import ShownSet

    read = {each.place for each in chosen}
    unusable = [str(each.path) for place, each in enumerate(listed) if place not in read]
    found = _found([each.motion for each in chosen], target, wanted)
    return ShownSet(found, target, [str(each.file) for each in chosen], unusable)


def _found(motions: list[GroundMotion], target: TargetSpectrum, wanted: SetRequirements) -> RecordSet:
    """Select the set, with progress bars for the spectra and the search."""
    from rocking_cli.studies import record_set

    with terminal.progress(len(motions), "spectra") as advance:
        candidates = record_set.candidates(motions, target, wanted, advance)
    if coarse := record_set.coarse(candidates):
        worst = max(motion.dt for motion in coarse)
        terminal.warning(
            f"the band begins at {wanted.band[0]:g} s, which is less than {record_set.FEWEST} intervals of "
            f"{len(coarse)} of {len(motions)} records (dt up to {worst:g} s): at such periods their spectra lack the "
            "motion between samples"
        )
    with ExitStack() as stack:

        def bar(total: int) -> terminal.Advance:
            return stack.enter_context(terminal.progress(total, "sets"))

        return record_set.choose(candidates, wanted, bar)
