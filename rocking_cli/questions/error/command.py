"""`rocking error`: compute the errors of the equivalent block of a structure."""

from __future__ import annotations

from pathlib import Path

import click

from rocking_cli.cli import options
from rocking_cli.cli.groups import Output
from rocking_cli.cli.help import Command
from rocking_cli.cli.quantities import NUMBER


@click.command(cls=Command, short_help="Compute the errors of the equivalent block.")
@options.structure
@click.option(
    "--at", type=NUMBER, multiple=True, default=(0.5,), show_default="0.5", metavar="RATIO",
    help="Amplitude phi/phi_cr at which to evaluate the error. Repeatable.",
)  # fmt: skip
@click.option(
    "--a", type=NUMBER, multiple=True, default=(2.0,), show_default="2",
    metavar="RATIO",
    help="Constant acceleration, as a multiple of the uplift acceleration. Repeatable.",
)  # fmt: skip
@options.plot("Plot the errors against amplitude and acceleration")
@options.as_json
@options.grouped(output=Output)
def command(file: str | Path, at: tuple[float, ...], a: tuple[float, ...], output: Output) -> None:
    """Compute the errors of the equivalent block of a structure, in each direction.

    The errors are those of its free rocking period, of its uplift acceleration, and of its overturning time under a
    constant acceleration, with kappa1 and kappa2. They are relative to the mechanism itself and come from exact energy
    integrals, without time stepping. A positive error means that the block's value is too large.

    Without FILE, the command uses rocking.yaml of this folder, or else a block of 0.7 m x 2.8 m.

    \b
    Example:
      rocking error arch.yaml --at 0.3 --at 0.7 --a 1.5 --plot error.png

    Source: DeJong and Dimitrakopoulos (2014), Eqs. 24-25.
    """
    from rocking_cli.questions.error.verb import error

    output.keep_apart(file)
    output.show(error(file, at=at, a=a, watch=output.watch))
