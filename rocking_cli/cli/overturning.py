"""`rocking overturning`: map the pulses that overturn a structure, or compare several structures."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, cast

import click

from rocking_cli.cli import options, terminal
from rocking_cli.cli.groups import Output, polarities
from rocking_cli.cli.help import Command
from rocking_cli.cli.quantities import AMPLITUDE, NUMBER, PERIOD, Finite, Range
from rocking_cli.errors import INCOMPLETE, InputError

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rocking_cli.core import Mechanism
    from rocking_cli.dynamics.model import ModelName
    from rocking_cli.excitation.pulses import Pulse
    from rocking_cli.studies.under_pulses import PulsedModel, Reals

MODELS = ("linear2", "linear1", "nonlinear")
PLANE, CURVE = 256, 60  # points, of each side of a map and of a curve
ETA = 0.9


@dataclass(frozen=True)
class Pulses:
    """Shape and polarity of the pulses, and the model that they act on."""

    shape: str
    model: str | None
    eta: float | None
    polarity: str

    @property
    def signs(self) -> tuple[int, ...]:
        """The polarities, of 1 and -1."""
        return polarities(self.polarity)


@dataclass(frozen=True)
class Plane:
    """Axes of a map or a curve, and the number of points."""

    dimensionless: bool
    period: tuple[float, float] | None
    ag: tuple[float, float] | None
    omega: tuple[float, float] | None
    a: tuple[float, float] | None
    points: int | None


@click.command(cls=Command, short_help="Map the pulses that overturn a structure.")
@click.argument("files", metavar="[FILE]...", nargs=-1, type=click.Path())
@click.option(
    "--compare", is_flag=True, help="Compare the smallest overturning amplitudes of several FILEs instead of a map."
)
@options.shape
@click.option(
    "--model",
    type=click.Choice(MODELS),
    help=f"{options.HELP['model']}  [default: linear2; nonlinear with --compare]",
)
@click.option(
    "--eta",
    type=Finite(),
    callback=options.restitution,
    help=f"{options.HELP['eta']}  [default: the structure's; {ETA} without FILE]",
)
@options.polarity("1", "-1", "both")
@click.option("--dimensionless", is_flag=True, help="Use the dimensionless axes omega and a, also with FILE.")
@click.option("--period", type=Range(PERIOD), metavar="LOW:HIGH", help=options.HELP["period"])
@click.option("--ag", type=Range(AMPLITUDE), metavar="LOW:HIGH", help=options.HELP["ag"])
@click.option("--omega", type=Range(NUMBER), metavar="LOW:HIGH", help=f"{options.HELP['omega']}  [default: 0.5:10]")
@click.option("--a", type=Range(NUMBER), metavar="LOW:HIGH", help=f"{options.HELP['a']}  [default: 0.5:10]")
@click.option(
    "--points",
    type=click.IntRange(2, 1000),
    metavar="N",
    help=f"{options.HELP['points']}  [default: {PLANE}; {CURVE} with --compare]",
)
@options.opening
@options.out(".csv", what="Write the map, one point per line, or the curves.")
@options.plot("Plot the map, or the curves")
@options.as_json
@click.pass_context
@options.grouped(pulses=Pulses, plane=Plane, output=Output)
def command(
    ctx: click.Context, files: tuple[str, ...], compare: bool, pulses: Pulses, plane: Plane, output: Output
) -> None:
    """Map the pulses that overturn a structure, by their periods and amplitudes.

    Each point of the map is a simulated motion that ends in no uplift, rocking, overturning after one or more impacts,
    overturning without impact, or in an unknown outcome, if a joint opens or slides beyond --opening. --period and --ag
    are ranges, such as 0.2:4 and 0.1g:2g. Without FILE, the map is that of the linear block, with the axes omega =
    omega_g/p and a = a_g/(g lambda). With --polarity both, the worse of the two polarities governs.

    With --compare, the command computes the smallest amplitude that overturns each FILE as a function of the period,
    and which structure overturns first. A FILE that cannot be used is reported and skipped, and the exit code is 5.

    \b
    Example:
      rocking overturning --plot map.png
      rocking overturning block.yaml --model nonlinear --ag 0.1g:2g --plot map.png
      rocking overturning --compare block.yaml frame.yaml wall.yaml --period 0.2:4 --plot curves.png

    Source: DeJong and Dimitrakopoulos (2014), Section 6; Zhang and Makris (2001).
    """
    _check(files, compare, pulses.model, plane)
    from rocking_cli.cli import structures
    from rocking_cli.io.files import keep_apart
    from rocking_cli.structure import Structure
    from rocking_cli.studies.under_pulses import linear_block, parse_shape, pulsed_model

    keep_apart([("--out", output.out), ("--plot", output.plot)], files)
    shape = parse_shape(pulses.shape)
    model = pulses.model or ("nonlinear" if compare else "linear2")
    loaded, good, bad = structures.load_each(files) if files else ([], [], 0)
    if compare and len(loaded) < 2:
        raise InputError("only one of the FILEs can be used: --compare needs at least two")
    mechanisms = structures.told_apart(loaded, good)
    ready = [Structure(each, file) for each, file in zip(mechanisms, good, strict=True)]
    subjects = [pulsed_model(each, cast("ModelName", model), shape, pulses.signs, pulses.eta) for each in ready]
    for each in ready:
        structures.warn_misleading(each, model)
    exact = model != "nonlinear" and bool(shape.segments())
    if compare:
        _compare(subjects, mechanisms, shape, pulses.signs, plane, output, exact=exact)
    else:
        subject = subjects[0] if subjects else linear_block(ETA if pulses.eta is None else pulses.eta)
        _map(subject, mechanisms[0] if mechanisms else None, shape, pulses.signs, plane, output, exact=exact)
    if bad:
        ctx.exit(INCOMPLETE)


def _compare(
    subjects: list[PulsedModel],
    mechanisms: list[Mechanism],
    shape: Pulse,
    signs: tuple[int, ...],
    plane: Plane,
    output: Output,
    *,
    exact: bool,
) -> None:
    """Compute the smallest amplitudes that overturn several structures, and show them."""
    from rocking_cli.cli import waiting
    from rocking_cli.studies import overturning as study
    from rocking_cli.views import overturning as views

    spread, top = _curves(subjects, plane)
    with waiting.histories(study.count_scans(subjects, spread.size, signs), exact=exact) as progress:
        found = study.compare(subjects, shape, spread, top, polarities=signs, progress=progress)

    def draw() -> Figure:
        from rocking_cli.plotting.overturning import draw_comparison

        return draw_comparison(found, views.comparison_title(found))

    output.write_made(lambda: [views.comparison_table(found)], draw)
    terminal.show(views.comparison_view(found, mechanisms), as_json=output.as_json)


def _map(
    subject: PulsedModel,
    mechanism: Mechanism | None,
    shape: Pulse,
    signs: tuple[int, ...],
    plane: Plane,
    output: Output,
    *,
    exact: bool,
) -> None:
    """Simulate pulses on one structure, or on the linear block, and show the map."""
    from rocking_cli.cli import waiting
    from rocking_cli.studies import overturning as study
    from rocking_cli.views import overturning as views

    dimensionless = plane.dimensionless or mechanism is None
    omegas, amplitudes = _plane(subject, plane, dimensionless=dimensionless)
    with waiting.histories(
        study.count_histories([subject], omegas.size * amplitudes.size, signs), exact=exact
    ) as progress:
        found = study.overturning_map(subject, shape, omegas, amplitudes, polarities=signs, progress=progress)

    def draw() -> Figure:
        from rocking_cli.plotting.overturning import draw_map

        return draw_map(found, views.map_title(found), dimensionless=dimensionless)

    output.write_made(lambda: [views.map_table(found, mechanism)], draw)
    terminal.show(views.map_view(found, mechanism, dimensionless=dimensionless), as_json=output.as_json)


def _check(files: tuple[str, ...], compare: bool, model: str | None, plane: Plane) -> None:
    """Raise if options cannot be combined, before anything is read."""
    if compare and len(files) < 2:
        raise click.UsageError("--compare needs at least two structures: give their FILEs.")
    if not compare and len(files) > 1:
        raise click.UsageError("A map shows one structure: give one FILE, or --compare for the curves of several.")
    if not files and model not in (None, "linear2"):
        raise click.UsageError(
            f"--model {model} requires a structure: give FILE. Without FILE, the map is that of the linear block."
        )
    if compare and plane.dimensionless:
        raise click.UsageError("--compare uses the period in s as its axis: leave out --dimensionless.")
    scaled = plane.dimensionless or not files
    wrong, right = (("period", "ag"), ("omega", "a"))[:: 1 if scaled else -1]
    for option in wrong:
        if getattr(plane, option) is not None:
            instead = f"--{right[wrong.index(option)]}"
            why = "without FILE" if not files else "with --dimensionless" if scaled else "with FILE"
            more = "" if scaled or compare else ", or add --dimensionless"
            raise click.UsageError(f"--{option} has no effect {why}: give {instead}{more}.")


def _plane(subject: PulsedModel, plane: Plane, *, dimensionless: bool) -> tuple[Reals, Reals]:
    """Return omega and a of the columns and rows, equally spaced along the axes of the map."""
    import numpy as np

    from rocking_cli.excitation.base import STANDARD_GRAVITY
    from rocking_cli.studies import overturning as study

    points = plane.points or PLANE
    if dimensionless:
        return np.linspace(*(plane.omega or study.OMEGAS), points), np.linspace(*(plane.a or study.AMPLITUDES), points)
    spread = np.linspace(*(plane.period or study.usual_periods([subject])), points)
    amplitudes = np.linspace(*(plane.ag or study.usual_amplitudes([subject])), points)
    return subject.period(spread), amplitudes * STANDARD_GRAVITY / subject.unit


def _curves(subjects: list[PulsedModel], plane: Plane) -> tuple[Reals, float]:
    """Return the periods [s], and the largest amplitude to try [g]."""
    import numpy as np

    from rocking_cli.studies import overturning as study

    _, top = plane.ag or study.usual_amplitudes(subjects)
    return np.geomspace(*(plane.period or study.usual_periods(subjects)), plane.points or CURVE), top
