"""`rocking overturning`: what pulses of every amplitude and period do, and which of several structures goes first."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, cast

import click

from rocking_cli.cli import options, terminal
from rocking_cli.cli.groups import Output, polarities
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
    """The pulses, and the equation of motion that they act on."""

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
    """Over what a map or a curve is drawn, and how finely."""

    dimensionless: bool
    period: tuple[float, float] | None
    ag: tuple[float, float] | None
    omega: tuple[float, float] | None
    a: tuple[float, float] | None
    points: int | None


@click.command(
    cls=options.Renamed,
    renamed={"--pulse": "--shape", "--periods": "--period", "--accelerations": "--ag"},
    short_help="Which pulses overturn a structure; which of several goes first.",
)
@click.argument("files", metavar="[FILE]...", nargs=-1, type=click.Path())
@click.option("--compare", is_flag=True, help="The least overturning amplitude of several FILEs, in one picture.")
@options.shape
@click.option("--model", type=click.Choice(MODELS), help="[default: linear2; nonlinear with --compare]")
@click.option(
    "--eta",
    type=Finite(),
    callback=options.restitution,
    help="Restitution.  [default: the structure's; 0.9 without FILE]",
)
@click.option(
    "--polarity",
    type=click.Choice(["1", "-1", "both"]),
    default="1",
    show_default=True,
    help="-1 reverses the pulse. both: the worse of the two.",
)
@click.option("--dimensionless", is_flag=True, help="Over omega and a, also with FILE.")
@click.option("--period", type=Range(PERIOD), metavar="LOW:HIGH", help="Periods in s, such as 0.2:4.")
@click.option("--ag", type=Range(AMPLITUDE), metavar="LOW:HIGH", help="Amplitudes with units, such as 0.1g:2g.")
@click.option("--omega", type=Range(NUMBER), metavar="LOW:HIGH", help="Dimensionless frequencies.  [default: 0.5:10]")
@click.option("--a", type=Range(NUMBER), metavar="LOW:HIGH", help="Dimensionless amplitudes.  [default: 0.5:10]")
@click.option(
    "--points",
    type=click.IntRange(2, 1000),
    metavar="N",
    help=f"Points of each side of the map, or periods compared.  [default: {PLANE}, {CURVE}]",
)
@options.out(".csv", what="Write the map, a line a point, or the curves.")
@options.plot("Draw it")
@options.as_json
@click.pass_context
@options.grouped(pulses=Pulses, plane=Plane, output=Output)
def command(
    ctx: click.Context, files: tuple[str, ...], compare: bool, pulses: Pulses, plane: Plane, output: Output
) -> None:
    """Which pulses overturn a structure: a map over their periods and amplitudes.

    Each point of the map is a motion followed until it is decided: no uplift, rocking, or overturning after some
    impacts or without any. Without FILE it is that of the linear block over omega = omega_g/p and a = a_g/(g lambda).

    With --compare, the least amplitude that overturns each FILE, over the period: which of them goes first. A FILE that
    cannot be used is reported, the others are compared, and the exit code is 5.

    \b
    Example:
      rocking overturning --plot map.png
      rocking overturning block.yaml --model nonlinear --ag 0.1g:2g --plot map.png
      rocking overturning --compare block.yaml frame.yaml wall.yaml --period 0.2:4 --plot curves.png

    Source: DeJong and Dimitrakopoulos (2014), Section 6; Zhang and Makris (2001).
    """
    _check(files, compare, pulses.model, plane)
    from rocking_cli.cli import structures
    from rocking_cli.dynamics.prepared import Prepared
    from rocking_cli.io.files import keep_apart
    from rocking_cli.studies.under_pulses import linear_block, parse_shape, pulsed_model

    keep_apart([("--out", output.out), ("--plot", output.plot)], files)
    shape = parse_shape(pulses.shape)
    model = pulses.model or ("nonlinear" if compare else "linear2")
    loaded, good, bad = structures.load_each(files) if files else ([], [], 0)
    if compare and len(loaded) < 2:
        raise InputError("only one of the FILEs can be used: --compare needs two or more")
    mechanisms = structures.told_apart(loaded, good)
    ready = [Prepared(each, file) for each, file in zip(mechanisms, good, strict=True)]
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
    """Find the least amplitudes that overturn several structures, and show them."""
    from rocking_cli.cli import waiting
    from rocking_cli.studies import overturning as study
    from rocking_cli.views import overturning as views

    spread, top = _curves(subjects, plane)
    with waiting.histories(
        study.count_histories(subjects, spread.size * study.SCAN * study.PASSES, signs), exact=exact
    ) as progress:
        found = study.compare(subjects, shape, spread, top, polarities=signs, progress=progress)

    def draw() -> Figure:
        from rocking_cli.plotting.overturning import draw_comparison

        return draw_comparison(found, views.comparison_title(found))

    output.write(lambda: [views.comparison_table(found)], draw)
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
    """Follow a plane of pulses on one structure, or on the linear block, and show the map."""
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

    output.write(lambda: [views.map_table(found, mechanism)], draw)
    terminal.show(views.map_view(found, mechanism, dimensionless=dimensionless), as_json=output.as_json)


def _check(files: tuple[str, ...], compare: bool, model: str | None, plane: Plane) -> None:
    """Refuse options that do not go together, before anything is read."""
    if compare and len(files) < 2:
        raise click.UsageError("--compare needs two structures or more: give their FILEs.")
    if not compare and len(files) > 1:
        raise click.UsageError("A map is of one structure: give one FILE, or --compare for the curves of several.")
    if not files and model not in (None, "linear2"):
        raise click.UsageError(
            f"--model {model} is of a structure: give FILE. Without it the map is of a linear block."
        )
    if compare and plane.dimensionless:
        raise click.UsageError("--compare is over the period in s: leave --dimensionless out.")
    scaled = plane.dimensionless or not files
    wrong, right = (("period", "ag"), ("omega", "a"))[:: 1 if scaled else -1]
    for option in wrong:
        if getattr(plane, option) is not None:
            instead = f"--{right[wrong.index(option)]}"
            why = "without FILE" if not files else "with --dimensionless" if scaled else "with FILE"
            more = "" if scaled or compare else ", or add --dimensionless"
            raise click.UsageError(f"--{option} has no meaning {why}: give {instead}{more}.")


def _plane(subject: PulsedModel, plane: Plane, *, dimensionless: bool) -> tuple[Reals, Reals]:
    """omega and a of the columns and rows, even over what the map is drawn over."""
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
    """Periods [s], and the largest amplitude to try [g]."""
    import numpy as np

    from rocking_cli.studies import overturning as study

    _, top = plane.ag or study.usual_amplitudes(subjects)
    return np.geomspace(*(plane.period or study.usual_periods(subjects)), plane.points or CURVE), top
