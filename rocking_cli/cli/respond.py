"""`rocking respond`: time histories."""

from __future__ import annotations

import os
from math import degrees
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

import click

from rocking_cli.cli import options, terminal
from rocking_cli.errors import InputError, Problem

if TYPE_CHECKING:
    from rocking_cli.core import Mechanism
    from rocking_cli.dynamics.history import History
    from rocking_cli.dynamics.model import ModelName
    from rocking_cli.excitation.base import GroundMotion

# The names of units and models stand here again so that `--help` needs no numpy; a test holds them together.
UNITS = ("g", "m/s2", "cm/s2", "mm/s2", "gal")
COARSE = 0.1  # s between samples; strong-motion records have 0.02 or less
PLAUSIBLE = (0.002, 4.0)  # g; the strongest ground motions on record have some 2.5
NAMES = ("nonlinear", "linear1", "linear2")


def _models(ctx: click.Context, param: click.Parameter, value: str) -> tuple[str, ...]:
    chosen = tuple(dict.fromkeys(word.strip() for word in value.split(",")))
    unknown = [word for word in chosen if word not in NAMES]
    if unknown:
        raise click.BadParameter(
            f"{', '.join(unknown) or 'nothing'} is not a model: choose from {', '.join(NAMES)}.", ctx, param
        )
    return chosen


def _release(ctx: click.Context, param: click.Parameter, value: float | None) -> float | None:
    if value is not None and not 0 < abs(value) < 1:
        raise click.BadParameter(f"{value:g} is not a fraction of phi_cr between 0 and 1 (or 0 and -1).", ctx, param)
    return value


def _tail(ctx: click.Context, param: click.Parameter, value: float) -> float:
    if not 0 <= value <= 3600:
        raise click.BadParameter(f"{value:g} is not a time between 0 and 3600 s.", ctx, param)
    return value


@click.command(short_help="Response to a ground motion: nonlinear and linear histories.")
@click.argument("file", required=False, type=click.Path())
@click.option("--record", type=click.Path(), metavar="FILE", help="Ground motion: text, or a data centre's format.")
@click.option("--units", type=click.Choice(UNITS), help="Unit of the record, where the file does not say.")
@click.option(
    "--dt", type=options.Finite(positive=True), metavar="SECONDS", help="Sample interval of a one-column record."
)
@click.option("--channel", metavar="CHANNEL", help="Which of several in the record: its place from 1, or its name.")
@click.option("--scale", type=options.Finite(), default=1.0, show_default=True, help="Factor on the record.")
@click.option(
    "--polarity", type=click.Choice(["1", "-1"]), default="1", show_default=True, help="-1 reverses the record."
)
@click.option(
    "--release",
    type=options.Finite(),
    metavar="RATIO",
    callback=_release,
    help="Start at rest from this fraction of phi_cr; negative: anticlockwise.",
)
@click.option(
    "--model", "models", default=",".join(NAMES), show_default=True, callback=_models, help="Which histories."
)
@click.option(
    "--tail",
    type=options.Finite(),
    default=10.0,
    show_default=True,
    metavar="SECONDS",
    callback=_tail,
    help="How long the history goes on after the record.",
)
@click.option("--out", callback=options.output_path(".csv"), metavar="FILE.csv", help="Write the histories.")
@click.option(
    "--plot",
    callback=options.output_path(".png", ".svg", ".pdf"),
    metavar="FILE.png",
    help="Draw them (.png, .svg or .pdf).",
)
@options.as_json
def command(
    file: str | None,
    record: str | None,
    units: str | None,
    dt: float | None,
    channel: str | None,
    scale: float,
    polarity: str,
    release: float | None,
    models: tuple[str, ...],
    tail: float,
    out: Path | None,
    plot: Path | None,
    as_json: bool,
) -> None:
    """Rocking response of a structure to a ground motion, a release from a tilt, or both.

    nonlinear is the mechanism itself; linear1 and linear2 are its equivalent block with kappa1 and kappa2. A
    positive rotation is clockwise, and a ground acceleration to the left starts it. Every motion is followed until
    the structure is at rest or certain to overturn, also after the end of the record.

    Without FILE it takes rocking.yaml of this folder, else a block of 0.7 m x 2.8 m.

    \b
    Example:
      rocking respond frame.yaml --record accel.csv --plot response.png
      rocking respond --record accel.txt --dt 0.01 --units g --scale 1.5
      rocking respond arch.yaml --release 0.5
    """
    if record is None and release is None:
        raise click.UsageError("Nothing to respond to: give --record FILE, or --release RATIO, or both.")
    if record is None and (units is not None or dt is not None):
        raise click.UsageError("--units and --dt describe a record: give --record FILE.")
    if record is None and channel is not None:
        raise click.UsageError("--channel is one of a record: give --record FILE.")
    if record is None and (scale != 1 or polarity != "1"):
        raise click.UsageError("--scale and --polarity change a record: give --record FILE.")
    _keep_apart(out, plot, file, record)
    from rocking_cli.cli import structures

    mechanism = structures.load([file] if file else [])[0]
    as_read = _read(record, dt, units, channel) if record is not None else None
    motion = as_read.scaled(scale * int(polarity)) if as_read is not None else None
    histories = _respond(mechanism, motion, cast("tuple[ModelName, ...]", models), release, tail)
    if out is not None:
        from rocking_cli.files import write_whole
        from rocking_cli.history_csv import history_csv

        write_whole(out, lambda stream: stream.write(history_csv(histories, motion).encode()))
        terminal.note(f"wrote {out}")
    if plot is not None:
        os.environ["MPLBACKEND"] = "agg"  # figures are written, never shown: no display is asked for
        from rocking_cli.files import write_whole
        from rocking_cli.plotting.history import draw_history

        figure = draw_history(histories, motion, structures.label(mechanism))
        write_whole(plot, lambda stream: figure.savefig(stream, format=plot.suffix[1:].lower()))
        terminal.note(f"wrote {plot}")
    if as_json:
        terminal.print_json(_as_json(mechanism, as_read, scale, polarity, release, histories))
    else:
        _print_table(mechanism, histories)


def _keep_apart(out: Path | None, plot: Path | None, *inputs: str | None) -> None:
    """Refuse to write over an input, or both outputs to one file."""
    read = [Path(name) for name in inputs if name is not None and Path(name).exists()]
    for option, path in (("--out", out), ("--plot", plot)):
        if path is not None and path.exists() and any(path.samefile(each) for each in read):
            raise InputError(Problem(f"{option} would overwrite what is read", str(path), hint="give another name"))
    if out is not None and plot is not None and out.resolve() == plot.resolve():
        raise InputError(Problem("--out and --plot cannot be the same file", str(out)))


def _read(record: str, dt: float | None, units: str | None, channel: str | None) -> GroundMotion:
    from rocking_cli.excitation.records import read_record

    motion = read_record(record, dt=dt, units=units, channel=channel)
    terminal.note(
        f"record: {motion.name} ({motion.format}), {motion.npts} points, dt = {motion.dt:g} s, "
        f"in {motion.unit}, PGA = {motion.pga:.4g} g"
    )
    if motion.dt > COARSE:
        terminal.warning(
            f"dt = {motion.dt:g} s is coarse for a ground motion: is the first column really time in seconds?"
        )
    if not PLAUSIBLE[0] <= motion.pga <= PLAUSIBLE[1]:
        terminal.warning(
            f"a PGA of {motion.pga:.3g} g is unusual for a ground motion: is the unit really {motion.unit}?"
        )
    return motion


def _respond(
    mechanism: Mechanism, motion: GroundMotion | None, models: tuple[ModelName, ...], release: float | None, tail: float
) -> dict[ModelName, History]:
    from rocking_cli.dynamics.compiled import needs_compiling
    from rocking_cli.dynamics.history import respond
    from rocking_cli.errors import MechanismError

    if needs_compiling():
        terminal.note("compiling the history kernel, some ten seconds, once for this machine ...")
    try:
        return respond(mechanism, motion, models=models, release=release, tail=tail)
    except MechanismError as error:
        raise MechanismError(f"{mechanism.name}: {error}") from error


def _as_json(
    mechanism: Mechanism,
    motion: GroundMotion | None,
    scale: float,
    polarity: str,
    release: float | None,
    histories: dict[ModelName, History],
) -> dict[str, Any]:
    record = None
    if motion is not None:
        record = {
            "name": motion.name,
            "npts": motion.npts,
            "dt": motion.dt,
            "unit": motion.unit,
            "pga": motion.pga,
            "format": motion.format,
            "scale": scale,
            "polarity": int(polarity),
        }
    return {
        "structure": {"mechanism": mechanism.mechanism, "name": mechanism.name},
        "record": record,
        "release": release,
        "responses": {
            name: {
                "peak_positive": history.peak_positive,
                "peak_negative": history.peak_negative,
                "peak_ratio": history.peak_ratio,
                "overturned": history.overturned,
                "overturning_time": history.overturning_time,
                "overturning_direction": history.fell_to.label if history.fell_to else None,
                "uplift_time": history.uplift_time,
                "impacts": history.impact_count,
                "outcome": history.outcome.name.lower(),
            }
            for name, history in histories.items()
        },
    }


def _print_table(mechanism: Mechanism, histories: dict[ModelName, History]) -> None:
    from rocking_cli.cli.structures import label
    from rocking_cli.dynamics.verdict import verdict

    number = terminal.number
    runs = list(histories.values())

    def in_degrees(phi: float | None) -> str:
        return terminal.ABSENT if phi is None else number(degrees(phi), 5)

    rows = [
        ["outcome", *(run.outcome.name.lower().replace("_", " ") for run in runs), ""],
        ["peak / phi_cr", *(number(run.peak_ratio, 5) for run in runs), ""],
        ["peak, clockwise", *(in_degrees(run.peak_positive) for run in runs), "deg"],
        ["peak, anticlockwise", *(in_degrees(run.peak_negative) for run in runs), "deg"],
        ["first uplift", *(number(run.uplift_time, 5) for run in runs), "s"],
        ["overturning time", *(number(run.overturning_time, 5) for run in runs), "s"],
        ["impacts", *(str(run.impact_count) for run in runs), ""],
    ]
    columns = ["", *(run.model for run in runs), "unit"]
    terminal.table(label(mechanism), columns, rows, numbers=range(1, len(runs) + 1))
    terminal.result(verdict(histories))
