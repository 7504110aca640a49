"""`rocking overturning`: map the pulses that overturn a structure, or compare several structures."""

from __future__ import annotations

from typing import Any

import click

from rocking_cli.cli import options
from rocking_cli.cli.groups import Output
from rocking_cli.cli.help import Command
from rocking_cli.cli.quantities import NUMBER, PERIOD, PULSE_AMPLITUDE, RATIO, range_of

AROUND = "around overturning"
MODELS = ("linear2", "linear1", "nonlinear")


@click.command(cls=Command, short_help="Map the pulses that overturn a structure.")
@click.argument("files", metavar="[FILE]...", nargs=-1, type=click.Path())
@click.option(
    "--compare", is_flag=True, help="Compare the smallest overturning amplitudes of several FILEs instead of a map."
)
@options.shape
@click.option(
    "--model",
    type=click.Choice(MODELS),
    help=f"{options.HELP['model']}  [default: linear2; nonlinear with --compare]",
)
@click.option(
    "--eta",
    type=NUMBER,
    help=f"{options.HELP['eta']}  [default: the structure's; 0.9 without FILE]",
)
@options.polarity("1", "-1", "both")
@click.option("--dimensionless", is_flag=True, help="Use the dimensionless axes omega and a, also with FILE.")
@click.option(
    "--period", type=range_of(PERIOD), metavar="LOW:HIGH", help=f"{options.HELP['period']}  [default: {AROUND}]"
)
@click.option(
    "--ag",
    type=range_of(PULSE_AMPLITUDE),
    metavar="LOW:HIGH",
    help=f"{options.HELP['ag']}  [default: 0.7 to 10 times uplift]",
)
@click.option("--omega", type=range_of(RATIO), metavar="LOW:HIGH", help=f"{options.HELP['omega']}  [default: {AROUND}]")
@click.option("--a", type=range_of(RATIO), metavar="LOW:HIGH", help=f"{options.HELP['a']}  [default: 0.5:10]")
@click.option(
    "--points",
    type=click.IntRange(2, 1000),
    metavar="N",
    help=f"{options.HELP['points']}  [default: 256; 60 with --compare]",
)
@options.opening
@options.engine
@options.out(".csv", what="Write the map, one point per line, or the curves.")
@options.plot("Plot the map, or the curves")
@options.as_json
@options.grouped(output=Output)
def command(files: tuple[str, ...], output: Output, **question: Any) -> None:
    """Map the pulses that overturn a structure, by their periods and amplitudes.

    Each point of the map is a simulated motion that ends in no uplift, rocking, overturning after one or more impacts,
    overturning without impact, or in an unknown outcome, if a joint opens or slides beyond --opening. --period and --ag
    are ranges, such as 0.2:4 and 0.1g:2g; the default ranges show where overturning starts. Without FILE, the map is
    that of the linear block, with the axes omega = omega_g/p and a = a_g/(g lambda). With --polarity both, the worse of
    the two polarities governs.

    With --compare, the command computes the smallest amplitude that overturns each FILE as a function of the period,
    and which structure overturns first. A FILE that cannot be used is reported and skipped, and the exit code is 5.

    \b
    Example:
      rocking overturning --plot map.png
      rocking overturning block.yaml --model nonlinear --ag 0.1g:2g --plot map.png
      rocking overturning --compare block.yaml frame.yaml wall.yaml --period 0.2:4 --plot curves.png

    Source: DeJong and Dimitrakopoulos (2014), Section 6; Zhang and Makris (2001).
    """
    from rocking_cli.questions.overturning.verb import overturning

    output.keep_apart(*files)
    output.show(overturning(files, watch=output.watch, **question))
