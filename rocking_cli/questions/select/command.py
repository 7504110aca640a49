"""`rocking select`: select records whose mean response spectrum matches a target."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import click

from rocking_cli.cli import complete, options
from rocking_cli.cli.groups import Output, ReadingOptions
from rocking_cli.cli.help import Command
from rocking_cli.cli.quantities import FRACTION, PERIOD, QuantityKind, range_of

RATIO = QuantityKind("ratio", "", "0.9", "0.9:1.3", 1e-3, 1e3)
FACTOR = QuantityKind("factor", "", "0.5", "0.5:3", 1e-6, 1e6)
MAX_RECORDS = 1000  # records of a set


@click.command(cls=Command, short_help="Select records whose mean spectrum matches a target.")
@click.argument("records", metavar="RECORD...", nargs=-1, required=True, type=click.Path())
@click.option(
    "--target",
    required=True,
    type=click.Path(path_type=Path),
    metavar="SPECTRUM.csv",
    shell_complete=complete.files,
    help="Target spectrum: one column of periods in s, and one of ordinates in g or in the unit of its heading; or a "
    "site file (.yaml), of which the code gives the spectrum of the ground.",
)
@click.option(
    "--state", metavar="STATE", help="Limit state of the site file whose spectrum is the target.  [default: SLV]"
)
@click.option(
    "--band",
    required=True,
    type=range_of(PERIOD),
    metavar="FROM:TO",
    help="Period range over which the mean must match, in s.",
)
@click.option(
    "--count", required=True, type=click.IntRange(1, MAX_RECORDS), metavar="N", help="Number of records to select."
)
@click.option(
    "--within",
    type=range_of(RATIO),
    default="0.9:1.3",
    show_default=True,
    metavar="LOW:HIGH",
    help="Lower and upper limit on the ratio of mean to target.",
)
@click.option(
    "--damping",
    type=FRACTION,
    default="5%",
    show_default=True,
    metavar="SHARE",
    help=options.HELP["damping"],
)
@click.option(
    "--factors",
    type=range_of(FACTOR),
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
    help="Source from which at most one record is taken, if the files name it.",
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
@options.grouped(reading=ReadingOptions, output=Output)
def command(records: tuple[str, ...], target: Path, reading: ReadingOptions, output: Output, **wanted: Any) -> None:
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
      rocking select "records/*.AT2" --target site.yaml --state SLC --band 0.2:2 --count 7
      rocking respond block.yaml --record "set/*.csv"
    """
    from rocking_cli.cli.watching import OnTerminal
    from rocking_cli.io.files import keep_apart
    from rocking_cli.questions.select.set_folder import check_folder, write_set
    from rocking_cli.questions.select.verb import select

    motions, watch = reading.of(*map(Path, records)), OnTerminal()
    paths = [target, *(each.path for each in motions.records)]
    keep_apart([("--plot", output.plot)], [str(path) for path in paths])
    if output.out is not None:
        check_folder(output.out, paths)
    answer = select(motions, target, watch=watch, **wanted)
    if output.out is not None:
        write_set(output.out, answer.shown, answer.readings)
    replace(output, out=None).show(answer)
    watch.end()
