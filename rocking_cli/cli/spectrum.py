"""`rocking spectrum`: compute the rocking spectrum: peak rotation against size."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import pi
from typing import TYPE_CHECKING, Any, cast

import click

from rocking_cli.cli import motion_files, options, terminal
from rocking_cli.cli.groups import GroundMotions, Output
from rocking_cli.cli.help import Command
from rocking_cli.cli.quantities import Finite, Share, SizeRange
from rocking_cli.errors import INCOMPLETE, InputError

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rocking_cli.dynamics.model import ModelName
    from rocking_cli.studies.spectrum import SpectrumShape
    from rocking_cli.studies.under_pulses import Reals
    from rocking_cli.views.spectrum import ShownSpectra

MODELS = ("nonlinear", "linear1", "linear2")
SIZES, MOST = 60, 2000  # of a curve: by default, and at most
RIGHT = "not an angle in rad between 0 and pi/2: give alpha = atan(b/h) of a block 2b wide and 2h high"


def _slenderness(ctx: click.Context, param: click.Parameter, value: str | None) -> tuple[float, ...]:
    """Return the different angles between 0 and a right angle, in rad unless they have a unit."""
    from rocking_cli.units import UnitError, read, split

    found = []
    for word in value.split(",") if value is not None else []:
        try:
            parts = split(word)
            angle = float(word) if parts is not None and not parts[1] else read(word, "rad")
        except UnitError as error:
            raise click.BadParameter(f"{error}.", ctx, param) from None
        if not 0 < angle < pi / 2:
            raise click.BadParameter(f"{word.strip()} is {RIGHT}.", ctx, param)
        found.append(angle)
    return tuple(dict.fromkeys(found))


def _numbers(low: float, high: float, what: str) -> Any:
    """Make a callback of click for a list of different numbers between two bounds."""

    def read(ctx: click.Context, param: click.Parameter, value: str | None) -> tuple[float, ...]:
        number = Share()
        words = value.split(",") if value is not None else []
        found = tuple(dict.fromkeys(number.convert(word, param, ctx) for word in words))
        for each in found:
            if not low < each < high:
                raise click.BadParameter(f"{each:g} is {what}.", ctx, param)
        return found

    return read


@dataclass(frozen=True)
class Sizing:
    """Rectangular blocks, sizes, model and restitution of a rocking spectrum."""

    slenderness: tuple[float, ...]
    sizes: tuple[float, float, int] | None
    model: str
    eta: float | None


@click.command(cls=Command, short_help="Compute the rocking spectrum: peak rotation against size.")
@click.argument("files", metavar="[FILE]...", nargs=-1, type=click.Path())
@options.ground_motions
@click.option(
    "--slenderness",
    metavar="A,B,...",
    callback=_slenderness,
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
    callback=options.restitution,
    help=f"{options.HELP['eta']}  [default: that of the structure or block]",
)
@options.reading
@options.scaling("1", "-1", "both")
@click.option(
    "--fractiles",
    default="0.16,0.84",
    show_default=True,
    metavar="Q,Q",
    callback=_numbers(0, 1, "not a fractile between 0 and 1"),
    help="Fractiles to show in addition to the median, with several motions.",
)
@click.option("--jobs", type=click.IntRange(1, 1024), metavar="N", help=options.HELP["jobs"])
@options.opening
@options.out(".csv", what="Write the curves, including those of each motion.")
@options.plot("Plot the curves")
@options.as_json
@click.pass_context
@options.grouped(asked=GroundMotions, sizing=Sizing, output=Output)
def command(
    ctx: click.Context,
    files: tuple[str, ...],
    asked: GroundMotions,
    sizing: Sizing,
    fractiles: tuple[float, ...],
    jobs: int | None,
    output: Output,
) -> None:
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
    from rocking_cli.cli import waiting
    from rocking_cli.io.files import keep_apart
    from rocking_cli.studies import spectrum as study
    from rocking_cli.views.spectrum import ShownSpectra, lost

    paths, missing = motion_files.find(asked.records)
    keep_apart([("--out", output.out), ("--plot", output.plot)], [*files, *(str(each.path) for each in paths)])
    shapes, bad = _shapes(files, sizing.slenderness, cast("ModelName", sizing.model), sizing.eta)
    periods = _sizes(shapes, sizing.sizes)
    smallest = min([float(periods[0]), *(each.period for each in shapes if each.slenderness is None)])
    chosen, refused = motion_files.gather(paths, asked.pulses, asked.reading, asked.scaling, 2 * pi / smallest)
    if not chosen:
        ctx.exit(InputError.exit_code)
    scaled = [each.motion.scaled(each.factor) for each in chosen]
    with waiting.histories(study.count_histories(shapes, periods, len(chosen), asked.signs)) as progress:
        found = study.spectra(shapes, periods, scaled, polarities=asked.signs, threads=jobs, progress=progress)
    results = ShownSpectra(found, chosen, tuple(sorted({*fractiles, 0.5})), asked.polarity)
    if unfollowed := lost(results):
        terminal.error(unfollowed)
    _give(results, output)
    if missing or refused or unfollowed or bad:
        ctx.exit(INCOMPLETE)


def _give(results: ShownSpectra, output: Output) -> None:
    """Write the requested files, and show the result."""
    from rocking_cli.views.spectrum import table, title, view

    def draw() -> Figure:
        from rocking_cli.plotting.spectrum import draw_spectra

        return draw_spectra(results.spectra, results.fractiles, title(results))

    output.write_made(lambda: [table(results)], draw)
    terminal.show(view(results), as_json=output.as_json)


def _shapes(
    files: tuple[str, ...], slenderness: tuple[float, ...], model: ModelName, eta: float | None
) -> tuple[list[SpectrumShape], int]:
    """Return the shape of each curve, structures first, then blocks; and the number of unusable files."""
    from rocking_cli.cli import structures
    from rocking_cli.studies.spectrum import blocks_of, shape_of

    mechanisms, good, bad = structures.load_each(files) if files or not slenderness else ([], [], 0)
    if files:
        mechanisms = structures.told_apart(mechanisms, good)
    places: Sequence[str | None] = good or [structures.place(None)] * len(mechanisms)
    found = [shape_of(each, model, eta, file) for each, file in zip(mechanisms, places, strict=True)]
    return found + [blocks_of(alpha, model, eta) for alpha in slenderness], bad


def _sizes(shapes: list[SpectrumShape], asked: tuple[float, float, int] | None) -> Reals:
    """Return 2 pi/p of the sizes, at equal ratios [s]."""
    import numpy as np

    from rocking_cli.studies.spectrum import usual_sizes

    return np.geomspace(*(asked or (*usual_sizes(shapes), SIZES)))
