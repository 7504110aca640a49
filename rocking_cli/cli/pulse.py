"""`rocking pulse`: a pulse on the dimensionless block, or on a structure; by the closed form and exactly."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from rocking_cli import names
from rocking_cli.cli import options, terminal
from rocking_cli.names import percent
from rocking_cli.views.view import ABSENT, number

if TYPE_CHECKING:
    from rocking_cli.dynamics.pulse_response import ClosedForm, ExactPulse

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

    if shape not in SHAPES:
        raise click.UsageError(
            f"The dimensionless block takes the shapes {', '.join(SHAPES)}, not {shape!r}: "
            "for another one give FILE, --ag and --period."
        )
    closed = closed_form(a, omega, eta) if shape == "sine" else None
    exact = exact_pulse(a, omega, eta, shape)
    if as_json:
        from dataclasses import asdict

        off = off_exact(closed, exact.first_rebound, exact.max_ratio) if closed is not None else {}
        terminal.print_json(
            {
                "shape": shape,
                "a": a,
                "omega": omega,
                "eta": eta,
                "closed_form": None if closed is None else {**closed_json(closed), **off},
                "exact": asdict(exact),
            }
        )
        return
    title = "Full sine" if shape == "sine" else shape.replace("_", " ").capitalize()
    terminal.table(
        f"{title} pulse: a = {a:g}, omega = {omega:g}, eta = {eta:g}",
        ["", "value", "meaning"],
        [*(_closed_rows(closed) if closed is not None else []), *_exact_rows(exact)],
        numbers=[1],
    )
    terminal.result(_verdict(a, closed, exact))


YES_NO = {True: "yes", False: "no", None: ABSENT}


def closed_json(closed: ClosedForm) -> dict[str, Any]:
    """The closed form, and why it cannot be used where it cannot."""
    from dataclasses import asdict

    return {**asdict(closed), "valid": closed.valid, "reason": closed.reason}


def off_exact(closed: ClosedForm, first_rebound: float | None, peak: float | None) -> dict[str, float | None]:
    """Eq. 41 as printed less the exact peak of the first rebound, and less the largest of all."""
    printed = closed.printed_ratio
    return {
        f"off_{name}": None if printed is None or exact is None else printed - exact
        for name, exact in (("first_rebound", first_rebound), ("peak_ratio", peak))
    }


def how_far_off(closed: ClosedForm, peak: float | None, *, overturns: bool) -> str:
    """What Eq. 41 says beside the exact answer, after what it may be used for; nothing where they agree."""
    printed = closed.printed_ratio
    if closed.valid and closed.overturns != overturns:
        return f": by Eq. 41 it {_fate(closed.overturns)}, exactly it {_fate(overturns)}"
    if overturns or peak is None:
        return "" if printed is None else f": Eq. 41 would give {printed:.4g}, and exactly it {_fate(overturns)}"
    if printed is None:
        return "" if closed.valid else f": Eq. 41 gives no rotation here, the exact one is {peak:.4g}"
    if abs(printed - peak) < 1e-9:
        return ""
    off = percent(abs(printed - peak) / peak) if peak > 0 else f"{printed:.4g}"
    first = ": it gives the first rebound only, and" if closed.valid else ":"
    what = f"{off} too {'high' if printed > peak else 'low'}"
    return f"{first} the largest rotation is {peak:.4g}, Eq. 41 says {printed:.4g}, {what}"


def _fate(overturns: bool | None) -> str:
    return names.outcome(uplifts=True, overturned=bool(overturns))


def _closed_rows(closed: ClosedForm) -> list[list[str]]:
    from rocking_cli.dynamics.pulse_response import CONDITIONS

    return [
        ["closed form D0*", number(closed.D0), "energy of the free motion after the pulse (Eq. 42)"],
        ["  max ratio", number(closed.max_ratio), "peak of the first rebound over phi_cr (Eq. 41)"],
        ["  overturns", YES_NO[closed.overturns], "eta^2 (1 - D0*) >= 1"],
        *(["  condition", YES_NO[holds], CONDITIONS[name]] for name, holds in closed.conditions.items()),
    ]


def _exact_rows(exact: ExactPulse) -> list[list[str]]:
    return [
        ["exact max ratio", number(exact.max_ratio), "largest rotation over phi_cr"],
        ["  first excursion", number(exact.first_excursion), "peak before the first impact"],
        ["  first rebound", number(exact.first_rebound), "peak after it"],
        ["  overturns", YES_NO[exact.overturns], impacts(exact.impacts_before_overturning)],
        ["  uplift", number(exact.uplift), "tau from the start of the pulse"],
        ["  end of pulse", number(exact.pulse_end), "tau from uplift"],
        ["  first impact", number(exact.first_impact), "tau from uplift"],
    ]


def impacts(count: int | None) -> str:
    """After how many it overturns, in words."""
    return (
        "" if count is None else "without impact" if count == 0 else f"after {count} impact{'s' if count > 1 else ''}"
    )


def _verdict(a: float, closed: ClosedForm | None, exact: ExactPulse) -> str:
    if a <= 1:
        return f"The linear block {names.NO_UPLIFT}: a <= 1."
    fate = (
        f"{names.OVERTURNS} {impacts(exact.impacts_before_overturning)}"
        if exact.overturns
        else f"{names.ROCKS} to {exact.max_ratio:.4g} of its critical rotation"
    )
    if closed is None:
        trust = "There is no closed form for this shape: Eqs. 41-42 are for a full sine"
    else:
        use = "All conditions hold, the closed form can be used"
        trust = use if closed.valid else f"Do not use the closed form, {closed.reason}"
        if closed.valid and (exact.first_excursion or 0) > 1 and exact.first_rebound is None:
            trust += "; the block passes its critical rotation before its first impact"
        else:
            trust += how_far_off(closed, exact.max_ratio, overturns=exact.overturns)
    return f"The linear block {fate}. {trust}."
