"""`rocking spectrum`: compute the rocking spectrum: peak rotation against size."""

from __future__ import annotations

from typing import Any

import click

from rocking_cli.cli import motion_files, options
from rocking_cli.cli.groups import GroundMotions, Output
from rocking_cli.cli.help import Command
from rocking_cli.cli.quantities import Finite, Share, SizeRange

MODELS = ("nonlinear", "linear1", "linear2")
SIZES, MOST = 60, 2000  # of a curve: by default, and at most


class Slenderness(click.ParamType):  # type: ignore[type-arg,unused-ignore]  # generic in newer click only
    """Angles, separated by commas, in rad unless they have a unit."""

    name = "angles"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> tuple[float, ...]:
        """Return the angles of a text [rad], or fail naming the option."""
        if isinstance(value, tuple):
            return value
        from rocking_cli.units import UnitError, read, split

        try:
            parts = [(word, split(word)) for word in value.split(",")]
            return tuple(float(word) if of is not None and not of[1] else read(word, "rad") for word, of in parts)
        except UnitError as error:
            self.fail(f"{error}.", param, ctx)


class Shares(Share):
    """Fractions, separated by commas."""

    name = "shares"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Return the numbers of a text, or fail naming the option."""
        if isinstance(value, tuple):
            return value
        return tuple(super(Shares, self).convert(word, param, ctx) for word in value.split(","))


@click.command(cls=Command, short_help="Compute the rocking spectrum: peak rotation against size.")
@click.argument("files", metavar="[FILE]...", nargs=-1, type=click.Path())
@options.ground_motions
@click.option(
    "--slenderness",
    type=Slenderness(),
    default=(),
    metavar="A,B,...",
    help="Slendernesses of rectangular blocks to compute as well: alpha = atan(b/h) in rad, such as 0.1,0.2, or 10deg.",
)
@click.option(
    "--sizes",
    type=SizeRange(SIZES, MOST),
    metavar="FROM:TO[:COUNT]",
    help="Sizes, as 2 pi/p in s, such as 1:10:60.  [default: FILE scaled by 0.1 to 10; 1:10 for blocks alone]",
)
@click.option("--model", type=click.Choice(MODELS), default="nonlinear", show_default=True, help=options.HELP["model"])
@click.option(
    "--eta",
    type=Finite(),
    help=f"{options.HELP['eta']}  [default: that of the structure or block]",
)
@options.reading
@options.scaling("1", "-1", "both")
@click.option(
    "--fractiles",
    type=Shares(),
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
    motion_files.check_strays(files, asked.records)
    from rocking_cli.ask.spectrum import spectrum
    from rocking_cli.cli import structures
    from rocking_cli.cli.watching import OnTerminal

    motions, watch = asked.motions, OnTerminal()
    output.keep_apart(*files, *motions.records)
    ready = structures.several(files, watch)
    if not files and not question["slenderness"]:
        ready = [structures.prepared(files)]
    output.show(spectrum(ready, motions, polarity=asked.polarity, watch=watch, **question))
    watch.end()
