"""`rocking equivalent`: find the pulses to which several structures are equally vulnerable."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, cast

import click

from rocking_cli.cli import options, terminal
from rocking_cli.cli.groups import Output, SizedPulse
from rocking_cli.cli.help import Command
from rocking_cli.errors import INCOMPLETE, InputError

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def _eta(ctx: click.Context, param: click.Parameter, value: str) -> float | str:
    if value in ("first", "own"):
        return value
    try:
        eta = float(value)
    except ValueError:
        eta = 0.0
    if not 0 < eta <= 1:
        raise click.BadParameter(f"{value!r} is not valid: give a number above 0 and at most 1, 'first' or 'own'.")
    return eta


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
@click.pass_context
@options.grouped(pulse=SizedPulse, output=Output)
def command(
    ctx: click.Context,
    files: tuple[str, ...],
    pulse: SizedPulse,
    kappa: str,
    eta: float | Literal["first", "own"],
    output: Output,
) -> None:
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
      rocking equivalent block.yaml frame.yaml wall.yaml --ag 0.6g --period 0.8 --plot equivalent.png

    Source: DeJong and Dimitrakopoulos (2014), Section 6.2 and Fig. 15.
    """
    if len(files) < 2:
        raise click.UsageError(
            "Give at least two FILEs: the pulse applies to the first, and equivalent pulses are computed for the "
            "others."
        )
    from rocking_cli.cli import structures, waiting
    from rocking_cli.io.files import keep_apart
    from rocking_cli.structure import Structure
    from rocking_cli.studies.equivalent_pulses import equivalent, judge
    from rocking_cli.views.equivalent_pulses import table, title, view

    keep_apart([("--out", output.out), ("--plot", output.plot)], files)
    given = pulse.pulse
    loaded, good, bad = structures.load_each(files)
    if files[0] not in good or len(good) < 2:
        raise InputError("the first FILE and one more are needed: the pulse is for the first")
    mechanisms = structures.told_apart(loaded, good)
    waiting.compile_first()
    found = equivalent(mechanisms, given, polarity=pulse.signs[0], kappa=cast(Literal[1, 2], int(kappa)), eta=eta)

    def draw() -> Figure:
        from rocking_cli.plotting.equivalent_pulses import draw_equivalent

        return draw_equivalent(found, title(found))

    for each, file in zip(mechanisms, good, strict=True):
        structures.warn_misleading(Structure(each, file), "linear")
    output.write_made(lambda: [table(found)], draw)
    verdict = terminal.as_typed(" ".join(judge(found)))
    terminal.show(view(found, verdict), as_json=output.as_json)
    if bad:
        ctx.exit(INCOMPLETE)
