"""`rocking respond`: compute the response to a ground motion or a release."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from rocking_cli.cli import complete, motion_files, options, terminal
from rocking_cli.cli.groups import GroundMotions, HistoryOptions, Near, Output, Vertical
from rocking_cli.cli.help import Command
from rocking_cli.cli.quantities import INTERVAL, TAIL, Finite, Quantity, Tilt
from rocking_cli.errors import INCOMPLETE, InputError, RockingError
from rocking_cli.excitation.scaled import Scaled
from rocking_cli.views.view import View, heading

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rocking_cli.dynamics.history import History
    from rocking_cli.dynamics.model import ModelName
    from rocking_cli.excitation.pulse_fit import PulseFit
    from rocking_cli.io.tables import Columns
    from rocking_cli.structure import Structure
    from rocking_cli.studies.response import Question, Response
    from rocking_cli.views.view import Table

# The models, the pulses that are fitted and the least tolerance stand here again so that `--help` needs no numpy.
NAMES = ("nonlinear", "linear1", "linear2")
FITTED = ("sine", "ricker", "mavroeidis")
BEST = "best"
FINEST_RTOL = 1e-14


def _models(ctx: click.Context, param: click.Parameter, value: str) -> tuple[str, ...]:
    chosen = tuple(dict.fromkeys(word.strip() for word in value.split(",")))
    unknown = [word for word in chosen if word not in NAMES]
    if unknown:
        raise click.BadParameter(
            f"{', '.join(unknown) or 'nothing'} is not a model: choose from {', '.join(NAMES)}.", ctx, param
        )
    return chosen


def _rtol(ctx: click.Context, param: click.Parameter, value: float) -> float:
    if not FINEST_RTOL <= value < 1:
        raise click.BadParameter(
            f"{value:g} is not a number from {FINEST_RTOL:g} to below 1: smaller errors are below rounding.", ctx, param
        )
    return value


@click.command(cls=Command, short_help="Compute the response to a ground motion or a release.")
@click.argument("files", metavar="[FILE]", nargs=-1, type=click.Path())
@options.ground_motions
@options.reading
@click.option(
    "--vertical", type=click.Path(), metavar="FILE", help="Vertical component of the motion: g becomes g + v_g''."
)
@options.record_option(
    "--vertical-dt",
    type=Quantity(INTERVAL),
    metavar="TIME",
    help="Sampling interval of the vertical component in s, if its file has no times.",
)
@options.record_option("--vertical-channel", metavar="CHANNEL", help="Channel of the vertical component in its file.")
@options.scaling("1", "-1", "both")
@click.option(
    "--with-pulse",
    type=click.Choice((BEST, *FITTED)),
    is_flag=False,
    flag_value=BEST,
    help="Shape of the pulse in the record whose response is computed as well; without a value, the best-fitting one.",
)
@click.option(
    "--release",
    type=Tilt(),
    metavar="TILT",
    help="Initial tilt of a release from rest: a fraction of phi_cr, or an angle such as 0.05rad; negative is "
    "anticlockwise.",
)
@click.option(
    "--model",
    "models",
    default=",".join(NAMES),
    show_default=True,
    metavar="MODEL,...",
    callback=_models,
    shell_complete=complete.listed(NAMES),
    help=options.HELP["model"],
)
@click.option(
    "--tail",
    type=Quantity(TAIL),
    default=10.0,
    show_default=True,
    metavar="TIME",
    help="Length of output after the end of the record, in s.",
)
@click.option(
    "--rtol",
    type=Finite(positive=True),
    default=1e-9,
    show_default=True,
    metavar="TOLERANCE",
    callback=_rtol,
    help="Relative error tolerance per step of the nonlinear integration.",
)
@options.around
@options.opening
@click.option("--impacts", is_flag=True, help="List the impacts: time, and angular velocity before and after.")
@options.out(".csv", ".parquet", what="Write the time histories (.csv or .parquet).")
@options.plot("Plot the time histories")
@click.option(
    "--contact", is_flag=True, help="Plot the friction required as well; automatic if the file gives friction."
)
@options.as_json
@click.pass_context
@options.grouped(asked=GroundMotions, vertical=Vertical, history=HistoryOptions, near=Near, output=Output)
def command(
    ctx: click.Context,
    files: tuple[str, ...],
    asked: GroundMotions,
    vertical: Vertical,
    history: HistoryOptions,
    near: Near,
    output: Output,
    impacts: bool,
    contact: bool,
) -> None:
    """Compute the rocking response of a structure to a ground motion, a release from a tilt, or both.

    The model nonlinear is the mechanism itself; linear1 and linear2 are its equivalent block with kappa1 and kappa2. A
    positive rotation is clockwise and is started by a ground acceleration to the left. Every motion is simulated,
    beyond the end of the record if necessary, until the structure is at rest or certain to overturn. With --polarity
    both, the responses to the two polarities are computed one after the other.

    With several motions, the output has one row per motion (with --json, one object per line), and --out and --plot
    write one file per motion, with its name in the file name. A motion that cannot be used is reported and skipped, and
    the exit code is 5.

    Without FILE, the command uses rocking.yaml of this folder, or else a block of 0.7 m x 2.8 m.

    \b
    Example:
      rocking respond frame.yaml --record accel.csv --plot response.png
      rocking respond frame.yaml --record "records/*.AT2" --target-pga 0.4
      rocking respond --record accel.txt --dt 0.01 --units g --target-pga 0.4 --polarity both
      rocking respond arch.yaml --release 0.5
      rocking respond column.yaml --release 0.05rad
      rocking respond frame.yaml --pulse ricker:0.4g:1.2s --polarity both
      rocking respond frame.yaml --record accel.csv --with-pulse --plot response.png
    """
    _hold_together(asked, vertical, history)
    if contact and (output.plot is None or "nonlinear" not in history.names):
        raise click.UsageError("--contact adds a panel to the plot of the nonlinear history: give --plot FILE.")
    paths, missing = motion_files.find(asked.records)
    several = len(paths) + missing + len(asked.pulses) > 1
    if several and vertical.vertical is not None:
        raise click.UsageError("--vertical applies to a single motion: give one --record FILE or one --pulse PULSE.")
    if asked and not paths and not asked.pulses:
        ctx.exit(InputError.exit_code)
    from rocking_cli.cli import inputs
    from rocking_cli.cli.waiting import compile_first
    from rocking_cli.io.files import keep_apart
    from rocking_cli.io.tables import check_table
    from rocking_cli.studies.response import Question

    read = [*files, *(str(each.path) for each in paths), vertical.vertical]
    keep_apart([("--out", output.out), ("--plot", output.plot)], read)
    check_table(output.out)
    structure = inputs.structure(files, asked.records)
    if asked.all_azimuths:
        from rocking_cli.cli import azimuths

        azimuths.check(asked, history, len(paths) + missing, impacts=impacts, contact=contact)
        compile_first()
        azimuths.respond(structure, _names(structure, history), paths[0], asked, vertical, history, output)
        return
    chosen: Sequence[Scaled | None] = [None]  # a free release
    refused = 0
    if asked:
        chosen, refused = inputs.gather(paths, asked, structure.growth, vertical, several=several)
        if not chosen:
            ctx.exit(InputError.exit_code)
    outs, plots = (motion_files.separate(path, chosen, several=several) for path in (output.out, output.plot))
    if several:
        keep_apart([*(("--out", each) for each in outs), *(("--plot", each) for each in plots)], read)
    compile_first()
    names = _names(structure, history)
    structure.models(names)
    release = history.release.ratio(structure) if history.release is not None else None
    question = Question(
        asked.signs,
        release,
        history.tail,
        history.rtol,
        history.with_pulse,
        near.around,
        history.release is not None and history.release.is_angle,
    )
    job = _Job(structure, names, question, asked.polarity, several, impacts, contact, output.as_json)
    with terminal.progress(len(outs), "motions") as advance:
        for each, out, plot in zip(chosen, outs, plots, strict=True):
            refused += not job.follow(each, out, plot)
            advance(1)
    job.end()
    if missing or refused:
        ctx.exit(INCOMPLETE)


def _hold_together(asked: GroundMotions, vertical: Vertical, history: HistoryOptions) -> None:
    """Raise if options have no effect or cannot be combined."""
    if asked.records and asked.pulses:
        raise click.UsageError("--record and --pulse cannot be combined: choose one.")
    if not asked and history.release is None:
        raise click.UsageError("No excitation given: add --record FILE, --pulse PULSE or --release TILT.")
    if not asked and vertical.vertical is not None:
        raise click.UsageError("--vertical requires a horizontal component: give --record FILE or --pulse PULSE.")
    asked.check(vertical.vertical)
    if not asked and asked.polarity != "1":
        raise click.UsageError("--polarity reverses a ground motion: give --record FILE or --pulse PULSE.")
    if history.with_pulse is not None and not asked.records:
        raise click.UsageError("--with-pulse requires a record: give --record FILE.")
    if history.with_pulse is not None and asked.polarity == "both":
        raise click.UsageError("--with-pulse cannot be combined with --polarity both: run one polarity at a time.")


def _names(structure: Structure, history: HistoryOptions) -> tuple[ModelName, ...]:
    """Return the models to run: those given, or else those that do not mislead, with a note on the others."""
    if not history.by_default:
        return history.names
    from rocking_cli.engines import default_models, engine_of

    names = default_models(structure)
    if len(names) < len(history.names):
        lacking = f"the engine {engine_of(structure).name} has no linear models"
        terminal.note(f"nonlinear history only: {structure.why_no_block or structure.misleading or lacking}")
    return names


class _Job:
    """Motions of a structure, simulated and shown one after the other; of several, a table at the end.

    Parameters
    ----------
    structure : Structure
        The structure.
    names : tuple of str
        Names of the models to run.
    asked : Question
        Options that apply to every motion.
    polarity : str
        Polarity, as given.
    several, impacts, contact, as_json : bool
        Whether there are several motions, and how each is shown.
    """

    def __init__(
        self,
        structure: Structure,
        names: tuple[ModelName, ...],
        asked: Question,
        polarity: str,
        several: bool,
        impacts: bool,
        contact: bool,
        as_json: bool,
    ) -> None:
        from rocking_cli.views.several import Several

        self._structure, self._names, self._asked, self._polarity = structure, names, asked, polarity
        self._several, self._impacts, self._as_json = several, impacts, as_json
        self._contact = contact or structure.mechanism.friction is not None
        self._table = Several(structure, names)
        self._details: list[Table | str] = []

    def follow(self, given: Scaled | None, out: Path | None, plot: Path | None) -> bool:
        """Simulate one motion, or a free release, and show it; return false for an unusable motion of several."""
        from rocking_cli.cli import structures
        from rocking_cli.studies.response import response_of
        from rocking_cli.views.response import view

        mechanism, title = self._structure.mechanism, heading(self._structure.mechanism)
        try:
            found = response_of(self._structure, self._names, given, self._asked)
        except RockingError as error:
            if not self._several or given is None:
                raise
            terminal.error(f"{given.motion.name}: {error}")
            return False
        if self._several and given is not None:
            title = f"{title}, under {given.motion.name}"
            self._table.add(found)
        _say_which_pulse(found.fit)
        _write(found, out, plot, title, self._structure, contact=self._contact)
        doubts = structures.doubts(mechanism)
        one = view(found, self._structure, self._asked, self._polarity, title, doubts, impacts=self._impacts)
        if self._as_json or not self._several:
            terminal.show(one, as_json=self._as_json)
        elif self._impacts:
            self._details += ["", *one.parts]
        return True

    def end(self) -> None:
        """Show the table of several motions."""
        if self._several and not self._as_json:
            terminal.show(View({}, [*self._table.parts(), *self._details]), as_json=False)


def _say_which_pulse(fit: PulseFit | None) -> None:
    from rocking_cli.excitation.base import STANDARD_GRAVITY

    if fit is not None:
        terminal.note(
            f"pulse: {fit.pulse.title}, a_p = {fit.pulse.amplitude / STANDARD_GRAVITY:.4g} g, "
            f"T_p = {fit.pulse.period:.4g} s, from {fit.start:.4g} s, sign {fit.sign:+d}: "
            f"{100 * fit.captured:.0f} % of the energy of the velocity"
        )


def _write(
    found: Response, out: Path | None, plot: Path | None, title: str, structure: Structure, *, contact: bool
) -> None:  # fmt: skip
    """Write the time histories and their plot to the requested files.

    In a table, those of the second polarity, or of the pulse alone, are the last columns, and their names say so.
    """
    from rocking_cli.studies.contact import Contacts
    from rocking_cli.studies.movements import Watched

    first, *others = found.runs.values()
    watched = Watched(structure.mechanism)

    def table() -> Iterable[Columns]:
        from rocking_cli.views import history_table

        columns: dict[str, History] = dict(first.items())
        columns |= {f"reversed {name}": run for other in others for name, run in other.items()}
        columns |= {f"pulse {name}": run for name, run in (found.to_pulse or {}).items()}
        contacts = Contacts(structure.mechanism)
        shear = {"nonlinear": contacts.base_shear(first["nonlinear"], found.first)} if "nonlinear" in first else {}
        return history_table.blocks(columns, found.first, watched=watched, base_shear=shear)

    def draw() -> Figure:
        from rocking_cli.plotting.history import draw_history

        pulse = (found.fit, found.to_pulse) if found.fit is not None and found.to_pulse is not None else None
        reversed_ = others[0] if others else None
        contacts = list(found.contacts.values()) if contact else []
        return draw_history(first, found.first, title, reversed_, pulse, structure.uplift, contacts, watched)

    Output(out, plot, as_json=False).write(table, draw)
