"""`rocking pulse`: a full sine pulse, by the closed form and exactly."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from rocking_cli.cli import options, terminal

if TYPE_CHECKING:
    from rocking_cli.dynamics.pulse_response import ClosedForm, ExactPulse

CONDITIONS = {
    "uplift": "the pulse lifts the block (a > 1)",
    "first_impact_after_pulse": "the first impact comes after the pulse",
    "no_overturning_without_impact": "the block does not overturn before its first impact",
}


@click.command(short_help="Response to a full sine pulse: closed form and exact.")
@click.option("--a", required=True, type=options.Finite(positive=True), help="Amplitude a = a_g/(g lambda).")
@click.option("--omega", required=True, type=options.Finite(positive=True), help="Frequency omega = omega_g/p.")
@click.option(
    "--eta",
    default=0.9,
    show_default=True,
    type=click.FloatRange(0, 1, min_open=True),
    help="Coefficient of restitution.",
)
@options.as_json
def command(a: float, omega: float, eta: float, as_json: bool) -> None:
    """Maximum response of the linear rocking block to one full sine pulse.

    The closed form (Eqs. 41-42) holds only under three conditions. Each is tested, and the exact answer of the same
    equation stands beside it. Rotations are over the critical one; times are tau = p t, counted from uplift.

    \b
    Example:
      rocking pulse --a 4 --omega 6 --eta 0.9

    Source: DeJong and Dimitrakopoulos (2014), Eqs. 40-42.
    """
    from rocking_cli.dynamics.pulse_response import closed_form, exact_pulse

    closed, exact = closed_form(a, omega, eta), exact_pulse(a, omega, eta)
    if as_json:
        from dataclasses import asdict

        terminal.print_json(
            {
                "a": a,
                "omega": omega,
                "eta": eta,
                "closed_form": {**asdict(closed), "valid": closed.valid},
                "exact": asdict(exact),
            }
        )
        return
    terminal.table(
        f"Full sine pulse: a = {a:g}, omega = {omega:g}, eta = {eta:g}",
        ["", "value", "meaning"],
        _rows(closed, exact),
        numbers=[1],
    )
    terminal.result(_verdict(a, closed, exact))


def _rows(closed: ClosedForm, exact: ExactPulse) -> list[list[str]]:
    number, yes_no = terminal.number, {True: "yes", False: "no", None: terminal.ABSENT}
    rows = [
        ["closed form D0*", number(closed.D0), "energy of the free motion after the pulse (Eq. 42)"],
        ["  max ratio", number(closed.max_ratio), "peak of the first rebound over phi_cr (Eq. 41)"],
        ["  overturns", yes_no[closed.overturns], "eta^2 (1 - D0*) >= 1"],
    ]
    rows += [["  condition", yes_no[holds], CONDITIONS[name]] for name, holds in closed.conditions.items()]
    rows += [
        ["exact max ratio", number(exact.max_ratio), "largest rotation over phi_cr"],
        ["  first excursion", number(exact.first_excursion), "peak before the first impact"],
        ["  first rebound", number(exact.first_rebound), "peak after it"],
        ["  overturns", yes_no[exact.overturns], _impacts(exact)],
        ["  uplift", number(exact.uplift), "tau from the start of the pulse"],
        ["  end of pulse", number(exact.pulse_end), "tau from uplift"],
        ["  first impact", number(exact.first_impact), "tau from uplift"],
    ]
    return rows


def _impacts(exact: ExactPulse) -> str:
    count = exact.impacts_before_overturning
    return (
        "" if count is None else "without impact" if count == 0 else f"after {count} impact{'s' if count > 1 else ''}"
    )


def _verdict(a: float, closed: ClosedForm, exact: ExactPulse) -> str:
    if a <= 1:
        return "The pulse does not lift the block (a <= 1): it stays at rest."
    fate = (
        f"overturns {_impacts(exact)}"
        if exact.overturns
        else f"rocks to {exact.max_ratio:.4g} of its critical rotation"
    )
    if closed.valid:
        trust = "All conditions hold: the closed form can be used"
        if (
            exact.first_excursion is not None
            and exact.first_rebound is not None
            and exact.first_excursion > exact.first_rebound
        ):
            trust += ", but it gives the first rebound only, and the first excursion is larger"
        elif exact.first_excursion is not None and exact.first_excursion > 1 and exact.first_rebound is None:
            trust += "; the block passes its critical rotation before its first impact"
    else:
        failed = " and ".join(CONDITIONS[name] for name, holds in closed.conditions.items() if not holds)
        trust = f"Do not use the closed form: it is not true that {failed}"
    return f"The linear block {fate}. {trust}."
