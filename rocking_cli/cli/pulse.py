"""`rocking pulse`: a pulse on the dimensionless block, or on a structure; by the closed form and exactly."""

from __future__ import annotations

import click

from rocking_cli.cli import options, terminal

ETA = 0.9


@click.command(short_help="Response to a pulse: closed form, exact and nonlinear.")
@click.argument("file", required=False, type=click.Path())
@click.option("--ag", metavar="AMPLITUDE", help="Amplitude with its unit, such as 0.6g or 5.9m/s2.")
@click.option("--period", type=options.Finite(positive=True), metavar="SECONDS", help="Period of the pulse.")
@click.option(
    "--polarity",
    type=click.Choice(("1", "-1", "both")),
    default="1",
    show_default=True,
    help="-1 reverses the pulse. both: one after the other.",
)
@click.option("--a", type=options.Finite(positive=True), help="Without a structure: amplitude a = a_g/(g lambda).")
@click.option("--omega", type=options.Finite(positive=True), help="Frequency omega = omega_g/p.")
@click.option(
    "--eta", type=click.FloatRange(0, 1, min_open=True), help=f"Coefficient of restitution.  [default: {ETA}]"
)
@click.option(
    "--shape",
    default="sine",
    show_default=True,
    help="Of the pulse: sine, cosine, half_sine or rectangular; for a structure any that is installed.",
)
@options.as_json
def command(
    file: str | None,
    ag: str | None,
    period: float | None,
    polarity: str,
    a: float | None,
    omega: float | None,
    eta: float | None,
    shape: str,
    as_json: bool,
) -> None:
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
    bare = {"--a": a, "--omega": omega, "--eta": eta}
    real = {"FILE": file, "--ag": ag, "--period": period, "--polarity": None if polarity == "1" else polarity}
    given = [[name for name, value in each.items() if value is not None] for each in (bare, real)]
    if given[0] and given[1]:
        raise click.UsageError(
            f"{given[0][0]} is for the dimensionless block, {given[1][0]} for a structure: give --a and --omega, or "
            "FILE with --ag and --period" + (" (eta is the restitution in its file)." if eta is not None else ".")
        )
    if given[1]:
        from rocking_cli.cli import pulse_on_structure

        if ag is None or period is None:
            missing = "--ag, such as 0.6g" if ag is None else "--period in seconds"
            raise click.UsageError(f"A pulse on a structure needs {missing}.")
        pulse_on_structure.run(file, shape, ag, period, polarity, as_json)
        return
    if a is None or omega is None:
        missing = " and ".join(name for name in ("--a", "--omega") if bare[name] is None)
        raise click.UsageError(
            f"Missing {missing}: give --a and --omega for the dimensionless block, or FILE with --ag and --period."
        )
    _on_block(a, omega, ETA if eta is None else eta, shape, as_json)


def _on_block(a: float, omega: float, eta: float, shape: str, as_json: bool) -> None:
    from rocking_cli.dynamics.pulse_response import SHAPES, closed_form, exact_pulse
    from rocking_cli.views.pulse import view

    if shape not in SHAPES:
        raise click.UsageError(
            f"The dimensionless block takes the shapes {', '.join(SHAPES)}, not {shape!r}: "
            "for another one give FILE, --ag and --period."
        )
    closed = closed_form(a, omega, eta) if shape == "sine" else None
    terminal.show(view(shape, a, omega, eta, closed, exact_pulse(a, omega, eta, shape)), as_json=as_json)
