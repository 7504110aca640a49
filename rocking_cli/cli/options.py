"""Options and arguments that several commands share."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields
from functools import wraps
from pathlib import Path
from typing import Any

import click

from rocking_cli.cli import complete, terminal
from rocking_cli.cli.quantities import (
    AMPLITUDE,
    INTERVAL,
    PERIOD,
    PGA,
    PGV,
    Azimuth,
    Finite,
    Parsed,
    Quantity,
    Share,
    Unit,
)

STANDARD_OUTPUT = "-"
Decorator = Callable[[Callable[..., Any]], Callable[..., Any]]

as_json: Decorator = click.option("--json", "as_json", is_flag=True, help="Print one JSON object and nothing else.")


def restitution(ctx: click.Context, param: click.Parameter, value: float | None) -> float | None:
    """A callback for a coefficient of restitution."""
    if value is not None and not 0 < value <= 1:
        raise click.BadParameter(f"{value:g} is not a coefficient of restitution: it is above 0 and at most 1.")
    return value


def share(ctx: click.Context, param: click.Parameter, value: float | None) -> float | None:
    """A callback for a number from 0 to below 1."""
    if value is not None and not 0 <= value < 1:
        raise click.BadParameter(f"{value:g} is not a number from 0 to below 1.", ctx, param)
    return value


def output_path(*suffixes: str) -> Callable[[click.Context, click.Parameter, str | None], Path | None]:
    """A callback for an output file: its suffix must be one of these, and its folder must take a file.

    Of a table in text it may be - for standard output: `tables.write` knows.
    """

    def check(ctx: click.Context, param: click.Parameter, value: str | None) -> Path | None:
        from rocking_cli.io.files import check_writable

        if value is None:
            return None
        path = Path(value)
        if value == STANDARD_OUTPUT and ".csv" in suffixes:
            return path
        if path.suffix.lower() not in suffixes:
            raise click.BadParameter(f"{value!r} does not end in {' or '.join(suffixes)}.", ctx, param)
        check_writable(path)
        return path

    return check


def out(*suffixes: str, what: str, required: bool = False, metavar: str | None = None) -> Decorator:
    """Where to write what is made: `out`, of one of these suffixes; the help says what it is."""
    return click.option(
        "-o",
        "--out",
        required=required,
        callback=output_path(*suffixes),
        metavar=metavar or f"FILE{suffixes[0]}",
        shell_complete=complete.files,
        help=what + ("  - is standard output." if ".csv" in suffixes else ""),
    )


def plot(what: str, more: str = "") -> Decorator:
    """Where to draw a picture: `plot`; the help says what it shows, and what more there is to say."""
    return click.option(
        "--plot",
        callback=output_path(".png", ".svg", ".pdf"),
        metavar="FILE.png",
        shell_complete=complete.files,
        help=f"{what} (.png, .svg or .pdf).{'  ' * bool(more)}{more}",
    )


nrml: Decorator = click.option(
    "--nrml",
    callback=output_path(".xml"),
    metavar="FILE.xml",
    shell_complete=complete.files,
    help="Write the lognormal curves for OpenQuake (NRML 0.5).",
)
"""Where fragility curves go that OpenQuake reads: `nrml`."""


quantiles: Decorator = click.option(
    "--quantiles", is_flag=True, help="Show how far structures rock at each intensity: 16, 50 and 84 % of the runs."
)
"""Whether quantiles of the peak rotation are shown: `quantiles`."""


class Renamed(click.Command):
    """A command some of whose options had other names, which go on working with a word on the new one.

    Parameters
    ----------
    renamed : mapping of str to str
        The option of today by the old name, such as `{"--periods": "--period"}`.
    """

    def __init__(self, *args: Any, renamed: Mapping[str, str], **more: Any) -> None:
        super().__init__(*args, **more)
        self.renamed = renamed

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Read the command line as if it had been typed today."""
        end = args.index("--") if "--" in args else len(args)
        return super().parse_args(ctx, [*map(self._today, args[:end]), *args[end:]])

    def _today(self, argument: str) -> str:
        old, equals, value = argument.partition("=")
        if old not in self.renamed:
            return argument
        terminal.note(f"{old} is called {self.renamed[old]} now")
        return f"{self.renamed[old]}{equals}{value}"


def grouped(**groups: type) -> Decorator:
    """Hand options to a command as objects: `asked=GroundMotions` makes one of the options that are its fields.

    The options themselves are declared by other decorators, above this one.
    """

    def decorate(command: Callable[..., Any]) -> Callable[..., Any]:
        @wraps(command)
        def with_groups(*args: Any, **given: Any) -> Any:
            made = {
                name: group(**{field.name: given.pop(field.name) for field in fields(group)})
                for name, group in groups.items()
            }
            return command(*args, **made, **given)

        return with_groups

    return decorate


def in_order(*decorators: Decorator) -> Decorator:
    """Several options as one decorator; the help lists them in this order."""

    def decorate(command: Callable[..., Any]) -> Callable[..., Any]:
        for decorator in reversed(decorators):
            command = decorator(command)
        return command

    return decorate


ground_motions: Decorator = in_order(
    click.option(
        "--record", "records", multiple=True, metavar="PLACE", shell_complete=complete.files,
        help="A ground motion, - for standard input, or a pattern in quotes: 'records/*.AT2'. May be repeated.",
    ),
    click.option(
        "--pulse", "pulses", multiple=True, metavar="PULSE", shell_complete=complete.shapes(":"),
        help="A pulse for one, NAME:AMPLITUDE:PERIOD, such as sine:0.6g:0.8s. May be repeated.",
    ),
)  # fmt: skip
"""Ground motions, any number of them: `records` and `pulses`."""


@dataclass(frozen=True)
class Placed:
    """A correction that was asked for, and its place among them: they are made in the order of the command line."""

    place: int
    step: Any

    def __str__(self) -> str:
        return str(self.step.value)


def _placed(ctx: click.Context, param: click.Parameter, value: tuple[Any, ...]) -> Placed | None:
    """A callback that keeps the order of corrections: click calls callbacks in the order of what was typed."""
    if not value:
        return None
    if len(value) > 1:
        hint = "a `processing:` list of a study, or of a list of records, may repeat a step."
        raise click.BadParameter(f"is given twice: give it once; {hint}", ctx, param)
    place = ctx.meta[__name__] = ctx.meta.get(__name__, 0) + 1
    return Placed(place, value[0])


def _parser_of(name: str) -> Callable[[], Callable[[str], Any]]:
    def fetch() -> Callable[[str], Any]:
        from rocking_cli.processing.steps import STEPS

        return STEPS[name].parse

    return fetch


def _correction(name: str, metavar: str, what: str) -> Decorator:
    kind = Parsed(name, _parser_of(name))
    return click.option(f"--{name}", multiple=True, type=kind, metavar=metavar, callback=_placed, help=what)


def _gain() -> Callable[[str], Any]:
    from rocking_cli.excitation.records.sensor import Gain

    return Gain.parse


def _floor() -> Callable[[str], Any]:
    from rocking_cli.processing.floor import Floor

    return Floor.parse


CORRECTIONS = ("baseline", "highpass", "lowpass", "taper", "trim", "resample")
corrections: Decorator = in_order(
    _correction("baseline", "linear|quadratic", "Subtract the line, parabola or constant that fits the samples best."),
    _correction("highpass", "HZ", "Take out what is slower (Butterworth, both ways)."),
    _correction("lowpass", "HZ", "Take out what is faster."),
    _correction("taper", "SHARE", "Bring both ends to zero, over this share of the duration each."),
    _correction("trim", "FROM:TO", "Keep what is between two times, in s."),
    _correction("resample", "TIME", "Another interval, in s; uneven times are put on a grid."),
)
"""Corrections of a record, made in the order in which they are given."""

reading: Decorator = in_order(
    click.option("--units", type=Unit(), help="Unit of the record, where the file does not say."),
    click.option("--dt", type=Quantity(INTERVAL), metavar="TIME", help="Interval of a record without times, in s."),
    click.option("--channel", metavar="CHANNEL", help="Which of several in the record: its place from 1, or its name."),
    click.option(
        "--from", "quantity", type=click.Choice(("acceleration", "velocity", "displacement")),
        help="What the record holds; others than accelerations are differentiated.",
    ),
    click.option(
        "--gain", type=Parsed("gain", _gain), metavar="GAIN",
        help="What one unit of the record stands for, such as 0.05m/V or 4.7e-6m/s2/count.",
    ),
    click.option(
        "--with", "other", type=click.Path(), metavar="FILE", shell_complete=complete.files,
        help="The component at right angles, turned with the record into the plane of the structure.",
    ),
    click.option("--with-channel", "other_channel", metavar="CHANNEL", help="Which of several that is in its file."),
    click.option(
        "--azimuth", type=Azimuth(), metavar="DEGREES",
        help="Of the structure's plane, from the record (0) towards --with (90); `respond` takes all.",
    ),
    corrections,
    click.option(
        "--floor", type=Parsed("floor", _floor), metavar="T1=...",
        help="Stand on a floor of a building: T1=0.4,xi=0.05,z=0.67,gamma=1.29 (or n=3 storeys).",
    ),
)  # fmt: skip
"""How to read a record and what to make of it: the fields of `groups.Reading`."""


def scaling(*polarities: str, both: str = "one after the other", default: str = "1") -> Decorator:
    """How to change a record: `scale`, `target_pga`, `target_pgv` and `polarity`, which is one of these.

    `both` says what becomes of both polarities, where they are one of them; `default` is what holds unless asked.
    `motions.factor` turns the first three, of which a user may give one, into a number.
    """
    return in_order(
        click.option("--scale", type=Finite(), metavar="FACTOR", help="Factor on the record.  [default: 1]"),
        click.option(
            "--target-pga",
            type=Quantity(PGA),
            metavar="ACCELERATION",
            help="Scale the record to this peak, in g.",
        ),
        click.option(
            "--target-pgv",
            type=Quantity(PGV),
            metavar="VELOCITY",
            help="Scale it to this peak velocity, in m/s.",
        ),
        click.option(
            "--polarity",
            type=click.Choice(polarities),
            default=default,
            show_default=True,
            help="-1 reverses the record." + (f" both: {both}." if "both" in polarities else ""),
        ),
    )


site: Decorator = click.option(
    "--site", type=click.Path(), metavar="SITE.yaml", help="Where it stands, as for `rocking verify`."
)

shape: Decorator = click.option(
    "--shape",
    default="sine",
    show_default=True,
    metavar="SHAPE",
    shell_complete=complete.shapes(),
    help="Of the pulse: sine, cosine, half_sine, rectangular, ricker, ... with what it takes besides.",
)


def sized_pulse(*polarities: str, required: bool = False) -> Decorator:
    """One pulse: `shape`, `ag`, `period` and `polarity`, which is one of these."""
    return in_order(
        click.option(
            "--ag",
            required=required,
            type=Quantity(AMPLITUDE),
            metavar="AMPLITUDE",
            help="Amplitude of the pulse with its unit, such as 0.6g or 5.9m/s2.",
        ),
        click.option(
            "--period", required=required, type=Quantity(PERIOD), metavar="PERIOD", help="Period of the pulse, in s."
        ),
        shape,
        click.option(
            "--polarity",
            type=click.Choice(polarities),
            default="1",
            show_default=True,
            help="-1 reverses the pulse." + (" both: one after the other." if "both" in polarities else ""),
        ),
    )


around: Decorator = in_order(
    click.option(
        "--neighbours",
        type=click.IntRange(0, 1_000_000),
        default=200,
        show_default=True,
        metavar="N",
        help="Motions next to the one asked for that are followed too; 0 for none.",
    ),
    click.option(
        "--within-amplitude",
        type=Share(),
        default=0.02,
        show_default=True,
        metavar="SHARE",
        callback=share,
        help="How far the factors on these are from 1, at most.",
    ),
    click.option(
        "--within-restitution",
        type=Finite(),
        default=0.02,
        show_default=True,
        metavar="ETA",
        callback=share,
        help="How far their restitution is from the structure's, at most.",
    ),
)
"""The neighbours of a motion: `neighbours`, `within_amplitude` and `within_restitution`."""
