"""`rocking pulse`: a pulse on the dimensionless block, or on a structure; by the closed form and exactly."""

from __future__ import annotations

from dataclasses import dataclass

import click

from rocking_cli.cli import options, terminal
from rocking_cli.cli.groups import SizedPulse
from rocking_cli.cli.quantities import Finite

ETA = 0.9


@dataclass(frozen=True)
class Dimensionless:
    """A pulse on the dimensionless block, and its restitution."""

    a: float | None
    omega: float | None
    eta: float | None


@click.command(short_help="Response to a pulse: closed form, exact and nonlinear.")
@click.argument("file", required=False, type=click.Path())
@options.sized_pulse("1", "-1", "both")
@click.option("--a", type=Finite(positive=True), help="Without a structure: amplitude a = a_g/(g lambda).")
@click.option("--omega", type=Finite(positive=True), help="Frequency omega = omega_g/p.")
@click.option(
    "--eta", type=click.FloatRange(0, 1, min_open=True), help=f"Coefficient of restitution.  [default: {ETA}]"
)
@options.as_json
@options.grouped(real=SizedPulse, bare=Dimensionless)
def command(file: str | None, real: SizedPulse, bare: Dimensionless, as_json: bool) -> None:
    """Response of a structure, or of the dimensionless linear block, to a pulse.

    With --a and --omega: the linear block. The closed form (Eqs. 41-42) is for one full sine and holds only under
    three conditions. Each is tested, and the exact answer of the same equation stands beside it. Rotations are over the
    critical one; times are tau = p t, counted from uplift.

    With --ag and --period: the structure of FILE, by its equivalent blocks with kappa1 and kappa2, and by its
    nonlinear history. Without FILE it takes rocking.yaml of this folder, else a block of 0.7 m x 2.8 m.

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
        eta = "." if bare.eta is None else " (eta is the restitution in its file)."
        raise click.UsageError(
            f"{for_block[0]} is for the dimensionless block, {for_structure[0]} for a structure: give --a and --omega, "
            f"or FILE with --ag and --period{eta}"
        )
    if not for_structure:
        _on_block(bare, real.shape, as_json=as_json)
        return
    if real.ag is None or real.period is None:
        missing = "--ag, such as 0.6g" if real.ag is None else "--period in seconds"
        raise click.UsageError(f"A pulse on a structure needs {missing}.")
    from rocking_cli.cli import pulse_on_structure

    pulse_on_structure.run(file, real, as_json=as_json)


def _on_block(bare: Dimensionless, shape: str, *, as_json: bool) -> None:
    from rocking_cli.dynamics.pulse_response import SHAPES, closed_form, exact_pulse
    from rocking_cli.views.pulse import view

    a, omega, eta = bare.a, bare.omega, ETA if bare.eta is None else bare.eta
    if a is None or omega is None:
        missing = " and ".join(name for name, value in (("--a", a), ("--omega", omega)) if value is None)
        raise click.UsageError(
            f"Missing {missing}: give --a and --omega for the dimensionless block, or FILE with --ag and --period."
        )
    if shape not in SHAPES:
        raise click.UsageError(
            f"The dimensionless block takes the shapes {', '.join(SHAPES)}, not {shape!r}: "
            "for another one give FILE, --ag and --period."
        )
    closed = closed_form(a, omega, eta) if shape == "sine" else None
    terminal.show(view(shape, a, omega, eta, closed, exact_pulse(a, omega, eta, shape)), as_json=as_json)
