"""`rocking pulse`: compute the response to a pulse, of the dimensionless block or of a structure."""

from __future__ import annotations

from dataclasses import dataclass

import click

from rocking_cli.cli import options, terminal
from rocking_cli.cli.groups import SizedPulse
from rocking_cli.cli.quantities import Finite

ETA = 0.9


@dataclass(frozen=True)
class Dimensionless:
    """Pulse on the dimensionless block, and its coefficient of restitution."""

    a: float | None
    omega: float | None
    eta: float | None


@click.command(short_help="Compute the response to a pulse.")
@click.argument("file", required=False, type=click.Path())
@options.sized_pulse("1", "-1", "both")
@click.option("--a", type=Finite(positive=True), help=options.HELP["a"])
@click.option("--omega", type=Finite(positive=True), help=options.HELP["omega"])
@click.option("--eta", type=click.FloatRange(0, 1, min_open=True), help=f"{options.HELP['eta']}  [default: {ETA}]")
@options.opening
@options.as_json
@options.grouped(real=SizedPulse, bare=Dimensionless)
def command(file: str | None, real: SizedPulse, bare: Dimensionless, as_json: bool) -> None:
    """Compute the response of a structure, or of the dimensionless linear block, to a pulse.

    With --a and --omega, the command computes the response of the linear block. The closed form (Eqs. 41-42) is for one
    full sine and is valid only under three conditions. Each condition is checked, and the exact solution of the same
    equation is given for comparison. Rotations are divided by the critical rotation; times are tau = p t from uplift.

    With --ag and --period, the command computes the response of the structure in FILE, by its equivalent blocks with
    kappa1 and kappa2 and by its nonlinear time history; --polarity both gives one polarity after the other.
    Without FILE, the command uses rocking.yaml of this folder, or else a block of 0.7 m x 2.8 m.

    \b
    Example:
      rocking pulse --a 4 --omega 6 --eta 0.9
      rocking pulse frame.yaml --ag 0.4g --period 0.8 --polarity both

    Source: DeJong and Dimitrakopoulos (2014), Eqs. 40-42.
    """
    polarity = None if real.polarity == "1" else real.polarity
    for_block, for_structure = (
        [name for name, value in each.items() if value is not None]
        for each in (
            {"--a": bare.a, "--omega": bare.omega, "--eta": bare.eta},
            {"FILE": file, "--ag": real.ag, "--period": real.period, "--polarity": polarity},
        )
    )
    if for_block and for_structure:
        eta = "." if bare.eta is None else " (eta is `restitution` in its file)."
        raise click.UsageError(
            f"{for_block[0]} is for the dimensionless block, {for_structure[0]} for a structure: give --a and --omega, "
            f"or FILE with --ag and --period{eta}"
        )
    if not for_structure:
        _on_block(bare, real.shape, as_json=as_json)
        return
    if real.ag is None or real.period is None:
        missing = "--ag, such as 0.6g" if real.ag is None else "--period in seconds"
        raise click.UsageError(f"A pulse on a structure requires {missing}.")
    from rocking_cli.cli import pulse_on_structure

    pulse_on_structure.run(file, real, as_json=as_json)


def _on_block(bare: Dimensionless, shape: str, *, as_json: bool) -> None:
    from rocking_cli.dynamics.pulse_response import SHAPES, closed_form, exact_pulse
    from rocking_cli.views.pulse import view

    a, omega, eta = bare.a, bare.omega, ETA if bare.eta is None else bare.eta
    if a is None or omega is None:
        missing = (
            "--a is" if a is None and omega is not None else "--omega is" if a is not None else "--a and --omega are"
        )
        raise click.UsageError(
            f"{missing} missing: give --a and --omega for the dimensionless block, or FILE with --ag and --period."
        )
    if shape not in SHAPES:
        raise click.UsageError(
            f"The dimensionless block accepts the shapes {', '.join(SHAPES)}, not {shape!r}: "
            "for other shapes, give FILE, --ag and --period."
        )
    closed = closed_form(a, omega, eta) if shape == "sine" else None
    terminal.show(view(shape, a, omega, eta, closed, exact_pulse(a, omega, eta, shape)), as_json=as_json)
