"""`rocking respond`: time histories."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, cast

import click

from rocking_cli.cli import motions, options, shaking, terminal
from rocking_cli.cli.pictures import write_picture

if TYPE_CHECKING:
    from rocking_cli.cli.responses import Runs
    from rocking_cli.dynamics.history import History
    from rocking_cli.dynamics.model import ModelName
    from rocking_cli.excitation.base import GroundMotion
    from rocking_cli.excitation.pulse_fit import PulseFit

# The names of the models and of the pulses that are fitted stand here again so that `--help` needs no numpy.
NAMES = ("nonlinear", "linear1", "linear2")
FITTED = ("sine", "ricker", "mavroeidis")
BEST = "best"


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


def _rtol(ctx: click.Context, param: click.Parameter, value: float) -> float:
    if not value < 1:
        raise click.BadParameter(f"{value:g} is not a number between 0 and 1.", ctx, param)
    return value


@click.command(short_help="Response to a ground motion: nonlinear and linear histories.")
@click.argument("file", required=False, type=click.Path())
@options.shaking
@options.reading
@click.option("--vertical", type=click.Path(), metavar="FILE", help="Its vertical component: g becomes g + v_g''.")
@click.option(
    "--vertical-dt", type=options.Finite(positive=True), metavar="SECONDS", help="Its interval, if it has one column."
)
@click.option("--vertical-channel", metavar="CHANNEL", help="Which of several it is in its file.")
@options.scaling("1", "-1", "both")
@click.option(
    "--with-pulse",
    type=click.Choice((BEST, *FITTED)),
    is_flag=False,
    flag_value=BEST,
    help="Also the response to the pulse in the record alone, of this shape or (with no value) the best.",
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
@click.option(
    "--rtol",
    type=options.Finite(positive=True),
    default=1e-9,
    show_default=True,
    metavar="TOLERANCE",
    callback=_rtol,
    help="Relative local error of a step of the nonlinear history.",
)
@click.option("--impacts", is_flag=True, help="List the impacts: times, and rates before and after.")
@click.option(
    "--out",
    callback=options.output_path(".csv", ".parquet"),
    metavar="FILE.csv",
    help="Write the histories (.csv or .parquet).",
)
@options.plot("Draw them")
@options.as_json
def command(
    file: str | None,
    record: str | None,
    pulse: str | None,
    units: str | None,
    dt: float | None,
    channel: str | None,
    vertical: str | None,
    vertical_dt: float | None,
    vertical_channel: str | None,
    scale: float | None,
    target_pga: float | None,
    target_pgv: float | None,
    polarity: str,
    with_pulse: str | None,
    release: float | None,
    models: tuple[str, ...],
    tail: float,
    rtol: float,
    impacts: bool,
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
      rocking respond --record accel.txt --dt 0.01 --units g --target-pga 0.4 --polarity both
      rocking respond arch.yaml --release 0.5
      rocking respond frame.yaml --pulse ricker:0.4g:1.2s --polarity both
      rocking respond frame.yaml --record accel.csv --with-pulse --plot response.png
    """
    if record is not None and pulse is not None:
        raise click.UsageError("--record and --pulse exclude each other.")
    shaken = record is not None or pulse is not None
    if not shaken and release is None:
        raise click.UsageError(
            "Nothing to respond to: give --record FILE or --pulse PULSE, or --release RATIO, or both."
        )
    if not shaken and vertical is not None:
        raise click.UsageError("--vertical goes with a horizontal component: give --record FILE or --pulse PULSE.")
    if record is None and vertical is None and (units is not None or dt is not None):
        raise click.UsageError("--units and --dt describe a record: give --record FILE.")
    if record is None and channel is not None:
        raise click.UsageError("--channel is one of a record: give --record FILE.")
    if vertical is None and (vertical_dt is not None or vertical_channel is not None):
        raise click.UsageError("--vertical-dt and --vertical-channel describe one: give --vertical FILE.")
    motions.check_scaling(scale, target_pga, target_pgv)
    scaled = any(value is not None for value in (scale, target_pga, target_pgv))
    if not shaken and (scaled or polarity != "1"):
        raise click.UsageError(
            "--scale, --target-pga, --target-pgv and --polarity change a record: give --record FILE or --pulse PULSE."
        )
    if with_pulse is not None and record is None:
        raise click.UsageError("--with-pulse finds the pulse in a record: give --record FILE.")
    if with_pulse is not None and polarity == "both":
        raise click.UsageError("--with-pulse and --polarity both exclude each other: ask for one after the other.")
    from rocking_cli.cli import responses, structures
    from rocking_cli.dynamics.vertical import vertical_notes
    from rocking_cli.files import keep_apart

    keep_apart([("--out", out), ("--plot", plot)], [file, record, vertical])
    if out is not None and out.suffix.lower() == ".parquet":
        from rocking_cli.history_parquet import check_parquet

        check_parquet(out)
    mechanism = structures.load([file] if file else [])[0]
    equivalence = shaking.equivalence(mechanism)
    as_read, factor, shape = None, 1.0, None
    if record is not None:
        as_read = shaking.read("record", record, dt, units, channel)
    elif pulse is not None:
        shape, as_read = shaking.make(pulse)
    if as_read is not None:
        if vertical is not None:
            up = shaking.read_vertical(vertical, dt, vertical_dt, units, vertical_channel)
            as_read = replace(as_read, vertical=up)
        factor = shaking.judge(as_read, equivalence, scale, target_pga, target_pgv)
    signs = (1, -1) if polarity == "both" else (int(polarity),)
    under = {sign: as_read.scaled(sign * factor) if as_read is not None else None for sign in signs}
    first = under[signs[0]]
    fit, alone = None, None
    if with_pulse is not None and first is not None:
        fit = _find(first, with_pulse)
        alone = fit.alone(first)
    chosen = cast("tuple[ModelName, ...]", models)
    runs = {sign: shaking.respond(mechanism, motion, chosen, release, tail, rtol) for sign, motion in under.items()}
    pulse_run = shaking.respond(mechanism, alone, chosen, release, tail, rtol) if alone is not None else None
    if out is not None:
        _write(out, runs, pulse_run, first)
    title = structures.label(mechanism)
    if plot is not None:
        _draw(plot, runs, first, title, (fit, pulse_run) if fit is not None and pulse_run is not None else None)
    etas = equivalence if impacts else None
    notes = vertical_notes(first, mechanism.gravity) if first is not None else []
    if as_json:
        found = {
            "structure": {"mechanism": mechanism.mechanism, "name": mechanism.name},
            "record": responses.record_json(as_read, factor, polarity, shape) if as_read is not None else None,
            "release": release,
            "restitution": responses.restitution_json(mechanism, equivalence),
            **responses.runs_json(runs, etas),
        }
        if fit is not None and pulse_run is not None:
            from rocking_cli.cli.pulse_fits import fit_json

            found |= {"pulse": fit_json(fit), "pulse_responses": responses.histories_json(pulse_run, etas)}
        terminal.print_json({**found, "notes": [*structures.doubts(mechanism), *notes]})
        return
    if pulse_run is None:
        responses.print_tables(title, runs, etas)
    else:
        responses.print_tables(f"{title}, under the record", runs, etas)
        terminal.result()
        responses.print_tables(f"{title}, under its pulse alone", {1: pulse_run}, etas)
        terminal.result(responses.share_of_pulse(runs[signs[0]], pulse_run))
    terminal.result(responses.restitution_used(mechanism, equivalence))
    for note in notes:
        terminal.result(note)


def _find(motion: GroundMotion, shape: str) -> PulseFit:
    """The pulse of a shape, or of the best, that captures most energy of the velocity of a motion."""
    from rocking_cli.excitation.base import STANDARD_GRAVITY
    from rocking_cli.excitation.pulse_fit import fit_pulses

    fits = fit_pulses(motion, FITTED if shape == BEST else (shape,), ("velocity",))
    fit = max(fits, key=lambda each: each.captured)
    terminal.note(
        f"pulse: {fit.pulse.title}, a_p = {fit.pulse.amplitude / STANDARD_GRAVITY:.4g} g, "
        f"T_p = {fit.pulse.period:.4g} s, from {fit.start:.4g} s, sign {fit.sign:+d}: "
        f"{100 * fit.captured:.0f} % of the energy of the velocity"
    )
    return fit


def _write(path: Path, runs: Runs, pulse_run: dict[ModelName, History] | None, motion: GroundMotion | None) -> None:
    """Write the histories; those of the second polarity, or to the pulse alone, stand last, under names that say so."""
    from rocking_cli.files import write_whole
    from rocking_cli.history_csv import write_history_csv
    from rocking_cli.history_parquet import write_history_parquet

    first, *others = runs.values()
    columns: dict[str, History] = dict(first.items())
    columns |= {f"reversed {name}": run for other in others for name, run in other.items()}
    columns |= {f"pulse {name}": run for name, run in (pulse_run or {}).items()}
    write = write_history_parquet if path.suffix.lower() == ".parquet" else write_history_csv
    write_whole(path, lambda stream: write(stream, columns, motion))
    terminal.note(f"wrote {path}")


def _draw(
    path: Path,
    runs: Runs,
    motion: GroundMotion | None,
    title: str,
    pulse: tuple[PulseFit, dict[ModelName, History]] | None,
) -> None:
    from rocking_cli.plotting.history import draw_history

    write_picture(path, draw_history(runs[next(iter(runs))], motion, title, runs[-1] if len(runs) > 1 else None, pulse))
