"""`rocking spectrum`: compute the rocking spectrum: peak rotation against size."""

from __future__ import annotations

from typing import Any

import click

from rocking_cli.cli import options
from rocking_cli.cli.groups import GroundMotions, Output
from rocking_cli.cli.help import Command
from rocking_cli.cli.quantities import NUMBER, Parsed, QuantityKind, angle, share, span

DEFAULT_SIZES, MAX_SIZES = 60, 2000  # sizes of a curve
SIZE = QuantityKind("period", "s", "0.8s", "1s:10s", 1e-3, 1e4)  # range of periods: blocks of 0.2 um to 19,000 km


def _slenderness(text: str) -> tuple[float, ...]:
    """Return angles [rad], separated by commas, in rad unless they have a unit."""
    return tuple(angle(word, "rad") for word in text.split(","))


def _shares(text: str) -> tuple[float, ...]:
    """Return fractions, separated by commas."""
    return tuple(map(share, text.split(",")))


def _sizes(text: str) -> tuple[float, float, int]:
    """Return two periods in s, the smaller first, and the number of sizes between them."""
    *ends, last = text.split(":")
    if len(ends) != 2:
        return *span(SIZE, text), DEFAULT_SIZES
    if not (last.strip().isdecimal() and 2 <= int(last) <= MAX_SIZES):
        raise ValueError(f"{last!r} is not a number of sizes from 2 to {MAX_SIZES}: give a range such as 1:10:60")
    return *span(SIZE, ":".join(ends)), int(last)


@click.command(cls=Command, short_help="Compute the rocking spectrum: peak rotation against size.")
@click.argument("files", metavar="[FILE]...", nargs=-1, type=click.Path())
@options.ground_motions
@click.option(
    "--slenderness",
    type=Parsed("angles", _slenderness),
    default=(),
    metavar="A,B,...",
    help="Slendernesses of rectangular blocks to compute as well: alpha = atan(b/h) in rad, such as 0.1,0.2, or 10deg.",
)
@click.option(
    "--sizes",
    type=Parsed("sizes", _sizes),
    metavar="FROM:TO[:COUNT]",
    help="Sizes, as 2 pi/p in s, such as 1:10:60.  [default: FILE scaled by 0.1 to 10; 1:10 for blocks alone]",
)
@options.model
@click.option(
    "--eta",
    type=NUMBER,
    help=f"{options.HELP['eta']}  [default: that of the structure or block]",
)
@options.reading
@options.scaling("1", "-1", "both")
@click.option(
    "--fractiles",
    type=Parsed("shares", _shares),
    default=(0.16, 0.84),
    show_default="0.16,0.84",
    metavar="Q,Q",
    help="Fractiles to show in addition to the median, with several motions.",
)
@click.option("--jobs", type=click.IntRange(1, 1024), metavar="N", help=options.HELP["jobs"])
@options.opening
@options.out(".csv", what="Write the curves, including those of each motion.")
@options.plot("Plot the curves")
@options.as_json
@options.grouped(asked=GroundMotions, output=Output)
def command(files: tuple[str, ...], asked: GroundMotions, output: Output, **question: Any) -> None:
    """Compute the rocking spectrum: peak rotation and overturning against size, under one or more ground motions.

    The spectrum has one curve per FILE, with all its lengths multiplied by a scale, and one per slenderness of
    rectangular block. Size is expressed as 2 pi/p, which increases with the square root of the scale. The structure as
    given is marked. With several motions, the spectrum gives the median, the fractiles and the share that overturn.
    With --polarity both, the worse of the two polarities governs.

    Without FILE and --slenderness, the command uses rocking.yaml of this folder, or else a block of 0.7 m x 2.8 m. A
    motion or a FILE that cannot be used is reported and skipped, and the exit code is 5.

    \b
    Example:
      rocking spectrum --record accel.csv --plot spectrum.png
      rocking spectrum block.yaml --record "records/*.AT2" --slenderness 0.1,0.2 --plot spectrum.png
      rocking spectrum --slenderness 0.1,0.2,0.3 --pulse sine:0.5g:0.8s --sizes 1:10
      rocking spectrum frame.yaml --record "records/*.AT2" --target-pga 0.4 --polarity both --out spectrum.csv

    Source: Makris and Konstantinidis (2003).
    """
    if not asked:
        raise click.UsageError("No ground motion given: add --record PLACE or --pulse PULSE, each repeatable.")
    asked.check()
    asked.check_strays(files)
    from rocking_cli.ask.given import LOCAL_FILE
    from rocking_cli.questions.spectrum.verb import spectrum

    output.keep_apart(*files, *asked.motions.records)
    structures = files or (() if question["slenderness"] else (LOCAL_FILE,))
    output.show(spectrum(structures, asked.motions, polarity=asked.polarity, watch=output.watch, **question))
