"""`rocking equiv`: the equivalent single rocking block."""

from __future__ import annotations

from math import degrees
from typing import TYPE_CHECKING, Any

import click

from rocking_cli.cli import options, terminal

if TYPE_CHECKING:
    from rocking_cli.core import Equivalence, Mechanism

ROWS = (
    ("p", "rad/s", "frequency parameter: small for large structures"),
    ("phi_cr", "rad", "critical rotation: unstable equilibrium"),
    ("lambda", "g", "ground acceleration at uplift"),
    ("lambda_lin", "g", "the same for the linearised mechanism"),
    ("kappa1", "", "phi/theta that keeps lambda_lin"),
    ("kappa2", "", "phi/theta that keeps lambda"),
    ("theta_cr1", "rad", "critical rotation of the block, kappa1"),
    ("theta_cr2", "rad", "critical rotation of the block, kappa2"),
    ("eta", "", "restitution of an impact ending this direction"),
    ("I_eq", "kg m2", "linearised inertia"),
    ("G_eq", "kg m", "linearised restoring moment over g"),
    ("B_eq", "kg m", "linearised drive of the ground"),
)
PER_MASS = {"kg m2": "m2", "kg m": "m"}  # of a structure whose file gives no masses


@click.command(short_help="The equivalent single rocking block of structures.")
@click.argument("files", metavar="[FILE]...", nargs=-1, type=click.Path())
@options.as_json
@click.option("--csv", "as_csv", is_flag=True, help="Print comma-separated values, a line for each direction.")
@click.pass_context
def command(ctx: click.Context, files: tuple[str, ...], as_json: bool, as_csv: bool) -> None:
    """Parameters of the single rocking block that a structure is equivalent to.

    One column where the two directions agree, two where they differ; positive is clockwise. With --json, several
    files give one object a line. A file that cannot be used is reported, the others are shown, and the exit code is 5.
    Without FILE it takes rocking.yaml of this folder, else a block of 0.7 m x 2.8 m.

    \b
    Example:
      rocking equiv frame.yaml
      rocking equiv wall.yaml arch.yaml --csv > parameters.csv

    Source: DeJong and Dimitrakopoulos (2014), Eqs. 9-20.
    """
    if as_json and as_csv:
        raise click.UsageError("--json and --csv exclude each other.")
    from rocking_cli.cli import structures
    from rocking_cli.core import equivalent_block
    from rocking_cli.errors import INCOMPLETE, MechanismError

    mechanisms, _, bad = structures.load_each(files)
    found = []
    for mechanism in mechanisms:
        try:
            found.append((mechanism, equivalent_block(mechanism)))
        except MechanismError as error:
            named = MechanismError(f"{mechanism.name}: {error}")
            if len(mechanisms) == 1:
                raise named from error
            terminal.error(str(named))
            bad += 1
    if not found:
        ctx.exit(MechanismError.exit_code)
    if as_csv:
        _print_csv(found)
    for mechanism, equivalence in found:
        if as_json:
            terminal.print_json(_as_json(mechanism, equivalence))
        elif not as_csv:
            _print_table(mechanism, equivalence)
        _warn(mechanism, equivalence)
    if bad:
        ctx.exit(INCOMPLETE)


def _as_json(mechanism: Mechanism, equivalence: Equivalence) -> dict[str, Any]:
    from rocking_cli.core.advice import preferred_kappa

    advice = {label: preferred_kappa(block) for label, block in _blocks(equivalence)}
    return {
        "mechanism": mechanism.mechanism,
        "name": mechanism.name,
        "gravity": mechanism.gravity,
        "symmetric": equivalence.symmetric,
        "per_unit_mass": not mechanism.has_mass,
        "restitution": "given" if mechanism.restitution is not None else "kinematics",
        "caution": mechanism.caution or None,
        "directions": {
            label: {**block.as_dict(), "prefer": advice[label].prefer, "lambda_ratio": advice[label].ratio}
            for label, block in _blocks(equivalence)
        },
    }


def _blocks(equivalence: Equivalence) -> tuple[tuple[str, Any], tuple[str, Any]]:
    return ("positive", equivalence.positive), ("negative", equivalence.negative)


def _print_csv(found: list[tuple[Mechanism, Equivalence]]) -> None:
    import csv
    import io

    lines = io.StringIO()
    writer = csv.writer(lines, lineterminator="\n")
    units = [f"{key} [{unit}]" if unit else key for key, unit, _ in ROWS]
    writer.writerow(["name", "mechanism", "direction", *units, "per unit mass"])
    for mechanism, equivalence in found:
        for label, block in _blocks(equivalence):
            values = (block.as_dict()[key] for key, _, _ in ROWS)
            mass = "no" if mechanism.has_mass else "yes"
            writer.writerow([mechanism.name, mechanism.mechanism, label, *values, mass])
    terminal.result(lines.getvalue().rstrip("\n"))


def _print_table(mechanism: Mechanism, equivalence: Equivalence) -> None:
    from rocking_cli.cli.structures import label
    from rocking_cli.core.advice import preferred_kappa

    shown = [(name, block.as_dict(), preferred_kappa(block)) for name, block in _blocks(equivalence)]
    if equivalence.symmetric:
        shown = [("value", *shown[0][1:])]
    rows = [[key, *(terminal.number(block[key]) for _, block, _ in shown), unit, meaning]
            for key, unit, meaning in (ROWS if mechanism.has_mass else _per_mass())]  # fmt: skip
    columns = ["", *(name for name, _, _ in shown), "unit", "meaning"]
    terminal.table(label(mechanism), columns, rows, numbers=range(1, len(shown) + 1), explained=True)
    for name, block, advice in shown:
        where = "" if equivalence.symmetric else f"{name}: "
        terminal.result(f"{where}critical rotation {degrees(block['phi_cr']):.4g} deg. {advice.why}")
    terminal.result(
        "Either kappa keeps phi_cr. That is all without an amplitude: `rocking error` compares free periods and "
        "overturning times, `rocking respond` motions."
    )
    if mechanism.caution:
        terminal.result(f"Caution: {mechanism.caution}")


def _per_mass() -> list[tuple[str, str, str]]:
    return [
        (key, PER_MASS.get(unit, unit), f"{meaning}, per unit mass" if unit in PER_MASS else meaning)
        for key, unit, meaning in ROWS
    ]


def _warn(mechanism: Mechanism, equivalence: Equivalence) -> None:
    from rocking_cli.core.restitution import why_none
    from rocking_cli.excitation.base import STANDARD_GRAVITY

    for label, block in _blocks(equivalence)[: 1 if equivalence.symmetric else 2]:
        if block.eta <= 0:
            way = "" if equivalence.symmetric else f" ending {label} motion"
            terminal.warning(
                f"{mechanism.name}: the kinematics give eta = {block.eta:.4g}{way}: {why_none(block.eta)}; "
                "histories need a measured restitution in the file"
            )
    if mechanism.gravity != STANDARD_GRAVITY:
        terminal.note(
            f"{mechanism.name}: lambda is over its own gravity of {mechanism.gravity:g} m/s2; records and PGA are in "
            f"standard gravity, {STANDARD_GRAVITY} m/s2"
        )
