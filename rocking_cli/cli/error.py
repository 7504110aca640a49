"""`rocking error`: compute the errors of the equivalent block of a structure."""

from __future__ import annotations

from pathlib import Path

import click

from rocking_cli.cli import options, terminal
from rocking_cli.cli.help import Command
from rocking_cli.cli.pictures import write_picture
from rocking_cli.cli.quantities import Finite
from rocking_cli.views.view import heading


def _checked(
    ctx: click.Context, param: click.Parameter, values: tuple[float, ...]
) -> tuple[float, ...]:  # fmt: skip
    from rocking_cli.studies.linearisation import why_no_acceleration, why_no_amplitude

    why_not = why_no_amplitude if param.name == "amplitudes" else why_no_acceleration
    for value in values:
        if why := why_not(value):
            raise click.BadParameter(f"{why}.", ctx, param)
    return values


@click.command(cls=Command, short_help="Compute the errors of the equivalent block.")
@click.argument("file", required=False, type=click.Path())
@click.option(
    "--at", "amplitudes", type=Finite(), multiple=True, default=(0.5,), show_default="0.5", metavar="RATIO",
    callback=_checked, help="Amplitude phi/phi_cr at which to evaluate the error. Repeatable.",
)  # fmt: skip
@click.option(
    "--a", "accelerations", type=Finite(), multiple=True, default=(2.0,), show_default="2",
    metavar="RATIO", callback=_checked,
    help="Constant acceleration, as a multiple of the uplift acceleration. Repeatable.",
)  # fmt: skip
@options.plot("Plot the errors against amplitude and acceleration")
@options.as_json
def command(
    file: str | None, amplitudes: tuple[float, ...], accelerations: tuple[float, ...], plot: Path | None, as_json: bool
) -> None:
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
    from rocking_cli.cli import structures
    from rocking_cli.errors import MechanismError, of_structure
    from rocking_cli.io.files import keep_apart
    from rocking_cli.studies.linearisation import compare
    from rocking_cli.views.error import view

    keep_apart([("--plot", plot)], [file])
    structure = structures.prepared([file] if file else [])
    try:
        curves, asked = compare(structure, amplitudes, accelerations)
    except MechanismError as error:
        raise of_structure(error, structure.name) from error
    if plot is not None:
        from rocking_cli.plotting.linearisation import draw_linearisation

        write_picture(plot, draw_linearisation(curves, asked, heading(structure.mechanism)))
    terminal.show(view(structure.mechanism, structure.equivalence, curves, asked), as_json=as_json)
