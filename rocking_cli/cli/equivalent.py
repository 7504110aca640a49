"""`rocking equivalent`: the pulses to which different structures are equivalently vulnerable."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, cast

import click

from rocking_cli import names
from rocking_cli.cli import options, terminal
from rocking_cli.cli.pictures import write_picture
from rocking_cli.cli.quantities import Quantity
from rocking_cli.errors import INCOMPLETE, InputError

if TYPE_CHECKING:
    from rocking_cli.studies.equivalent import EquivalentResponses


def _eta(ctx: click.Context, param: click.Parameter, value: str) -> float | str:
    if value in ("first", "own"):
        return value
    try:
        eta = float(value)
    except ValueError:
        eta = 0.0
    if not 0 < eta <= 1:
        raise click.BadParameter(f"{value!r} is neither a number above 0 and at most 1 nor 'first' or 'own'.")
    return eta


@click.command(short_help="Pulses to which several structures are equally vulnerable.")
@click.argument("files", metavar="FILE FILE...", nargs=-1, type=click.Path())
@click.option("--ag", required=True, type=Quantity("acceleration"), metavar="AMPLITUDE", help="With unit: 0.6g.")
@click.option("--period", required=True, type=Quantity("period"), metavar="SECONDS", help="Period of the pulse.")
@click.option("--pulse", default="sine", show_default=True, metavar="SHAPE", help="Shape of the pulse.")
@click.option("--polarity", type=click.Choice(["1", "-1"]), default="1", show_default=True, help="-1 reverses it.")
@click.option("--kappa", type=click.Choice(["1", "2"]), default="2", show_default=True, help="Scaling of the pulses.")
@click.option(
    "--eta",
    default="first",
    show_default=True,
    metavar="ETA",
    callback=_eta,
    help="Restitution of all: a number, that of the first FILE, or each its own.",
)
@click.option("--out", callback=options.output_path(".csv"), metavar="FILE.csv", help="Write the responses over p t.")
@options.plot("Draw them")
@options.as_json
@click.pass_context
def command(
    ctx: click.Context,
    files: tuple[str, ...],
    ag: float,
    period: float,
    pulse: str,
    polarity: str,
    kappa: str,
    eta: float | Literal["first", "own"],
    out: Path | None,
    plot: Path | None,
    as_json: bool,
) -> None:
    """Pulses to which different structures are equivalently vulnerable.

    The pulse given is for the first FILE. Every other structure gets the pulse with the same a = a_g/(g lambda) and
    omega = omega_g/p, and the nonlinear responses are compared in phi/phi_cr over p t: how equal are they?

    Restitution must be the same for that; unless --eta says otherwise all get that of the first FILE. Of a structure
    with two different directions p and lambda are those of the direction that the pulse lifts first. A FILE that cannot
    be used is reported, the others are compared, and the exit code is 5.

    \b
    Example:
      rocking equivalent block.yaml frame.yaml wall.yaml --ag 0.6g --period 0.8 --plot equivalent.png

    Source: DeJong and Dimitrakopoulos (2014), Section 6.2 and Fig. 15.
    """
    if len(files) < 2:
        raise click.UsageError("Equivalent to what? Give two FILEs or more; the pulse is for the first.")
    from dataclasses import replace

    from rocking_cli.cli import structures, work
    from rocking_cli.excitation.base import STANDARD_GRAVITY
    from rocking_cli.io.files import keep_apart
    from rocking_cli.io.tables import write_table
    from rocking_cli.studies.equivalent import equivalent, judge
    from rocking_cli.studies.shaken import parse_shape

    keep_apart([("--out", out), ("--plot", plot)], files)
    given = replace(parse_shape(pulse), amplitude=ag * STANDARD_GRAVITY, period=period)
    loaded, good, bad = structures.load_each(files)
    if files[0] not in good or len(good) < 2:
        raise InputError("the first FILE and one more are needed: the pulse is for the first")
    mechanisms = structures.told_apart(loaded, good)
    work.say_if_compiling()
    found = equivalent(mechanisms, given, polarity=int(polarity), kappa=cast(Literal[1, 2], int(kappa)), eta=eta)
    if out is not None:
        write_table(out, [_columns(found)])
        terminal.note(f"wrote {out}")
    title = f"{given.title}, a = {found.a:.4g}, omega = {found.omega:.4g}"
    if plot is not None:
        from rocking_cli.plotting.equivalent import draw_equivalent

        write_picture(plot, draw_equivalent(found, title))
    said = [terminal.as_typed(each) for each in judge(found)]
    if as_json:
        terminal.print_json(_as_json(found, said))
    else:
        _print(found, title, said)
    if bad:
        ctx.exit(INCOMPLETE)


def _print(found: EquivalentResponses, title: str, verdict: list[str]) -> None:
    rows = [
        [
            each.name,
            f"{each.amplitude:.4g}",
            f"{each.pulse.period:.4g}",
            f"{each.eta:.4g}",
            _peak(each.history.peak_ratio),
        ]
        for each in found.members
    ]
    rows.append(["linear block", "", "", f"{found.members[0].eta:.4g}", _peak(found.linear_peak)])
    terminal.table(title, ["", "a_g [g]", "T [s]", "eta", "peak / phi_cr"], rows, numbers=(1, 2, 3, 4))
    terminal.result(" ".join(verdict))


def _peak(ratio: float | None) -> str:
    if ratio is None:
        return names.OVERTURNS
    return f"{ratio:.4g}" if ratio else names.NO_UPLIFT


def _columns(found: EquivalentResponses) -> dict[str, Sequence[object]]:
    """p t, and for each structure its own time and rotation; empty fields where it has come to its end."""

    def padded(values: list[float]) -> list[float]:
        return values + [float("nan")] * (found.tau.size - len(values))

    columns: dict[str, Sequence[object]] = {"p t": found.tau.tolist()}
    for each in found.members:
        columns[f"{each.name} t [s]"] = padded(each.history.time.tolist())
        columns[f"{each.name} phi/phi_cr"] = padded(each.history.ratio.tolist())
    columns["linear block phi/phi_cr"] = padded(found.linear.ratio.tolist())
    return columns


def _as_json(found: EquivalentResponses, verdict: list[str]) -> dict[str, Any]:
    return {
        "pulse": found.members[0].pulse.name,
        "polarity": found.polarity,
        "kappa": found.kappa,
        "a": found.a,
        "omega": found.omega,
        "direction": found.direction.label,
        "structures": [
            {
                "mechanism": each.mechanism,
                "name": each.name,
                "p": each.block.p,
                "lambda": each.block.lambda_,
                "lambda_lin": each.block.lambda_lin,
                "ag": each.amplitude,
                "period": each.pulse.period,
                "eta": each.eta,
                "own_eta": each.own_eta,
                "peak_ratio": each.history.peak_ratio,
                "overturned": each.history.overturned,
            }
            for each in found.members
        ],
        "linear_peak_ratio": found.linear_peak,
        "spread": found.spread,
        "relative_spread": found.relative_spread,
        "verdict": " ".join(verdict),
    }
