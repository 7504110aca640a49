"""`rocking equivalent_pulses`: find the pulses to which several structures are equally vulnerable."""

from __future__ import annotations

from typing import Any

import click

from rocking_cli.cli import options
from rocking_cli.cli.groups import Output
from rocking_cli.cli.help import Command


def _eta(ctx: click.Context, param: click.Parameter, value: str) -> float | str:
    try:
        return float(value)
    except ValueError:
        return value


@click.command(cls=Command, short_help="Find the equivalent pulses of several structures.")
@click.argument("files", metavar="FILE FILE...", nargs=-1, type=click.Path())
@options.sized_pulse("1", "-1", required=True)
@click.option(
    "--kappa",
    type=click.Choice(["1", "2"]),
    default="2",
    show_default=True,
    help="Equivalent block by which the pulses are scaled: 1 for kappa1, 2 for kappa2.",
)
@click.option(
    "--eta",
    default="first",
    show_default=True,
    metavar="ETA|first|own",
    callback=_eta,
    help=options.HELP["eta"],
)
@options.opening
@options.out(".csv", what="Write the responses against p t.")
@options.plot("Plot the responses")
@options.as_json
@options.grouped(output=Output)
def command(files: tuple[str, ...], output: Output, **question: Any) -> None:
    """Find the pulses to which several structures are equally vulnerable.

    The given pulse is for the first FILE. Every other structure gets the pulse with the same a = a_g/(g lambda) and
    omega = omega_g/p, and the nonlinear responses are compared as phi/phi_cr against p t: the output shows how closely
    they agree.

    The comparison requires the same coefficient of restitution. --eta is a number for all structures, `first` for that
    of the first FILE, or `own` for each structure's own. If the directions of a structure differ, p and lambda are
    those of the direction that the pulse uplifts first. A FILE that cannot be used is reported and skipped, and the
    exit code is 5.

    \b
    Example:
      rocking equivalent_pulses block.yaml frame.yaml wall.yaml --ag 0.6g --period 0.8 --plot equivalent.png

    Source: DeJong and Dimitrakopoulos (2014), Section 6.2 and Fig. 15.
    """
    from rocking_cli.questions.equivalent_pulses.verb import equivalent_pulses

    output.keep_apart(*files)
    output.show(equivalent_pulses(files, watch=output.watch, **question))
