"""Options and arguments that several commands share."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import fields
from functools import wraps
from pathlib import Path
from typing import Any

import click
from click.core import ParameterSource

from rocking_cli.cli import complete
from rocking_cli.cli.defaults import from_default
from rocking_cli.cli.help import RecordOption
from rocking_cli.cli.quantities import FRACTION, PERIOD, PULSE_AMPLITUDE, SHARE, TILT, Parsed, quantity_of
from rocking_cli.names import OPENING
from rocking_cli.processing.reading_options import CORRECTIONS, READING, SCALING, Option

STANDARD_OUTPUT = "-"
# The names of the models are repeated here so that `--help` does not import numpy.
MODELS = ("nonlinear", "linear1", "linear2")
ENGINES = ("exact", "blocks", "auto")
Decorator = Callable[[Callable[..., Any]], Callable[..., Any]]

HELP = {
    "a": "Dimensionless amplitude a = a_g/(g lambda).",
    "ag": "Amplitude of the pulse with its unit, such as 0.6g or 5.9m/s2.",
    "damping": "Damping ratio of the response spectrum.",
    "eta": "Coefficient of restitution.",
    "jobs": "Number of processor cores to use.  [default: all]",
    "model": "Model: nonlinear (the mechanism itself), or its equivalent block (linear1, linear2).",
    "omega": "Dimensionless frequency omega = omega_g/p.",
    "period": "Period of the pulse, in s.",
    "points": "Number of values to compute along each axis.",
    "site": "Site file: ground motion, confidence factor, floor. `rocking new site` prints a template.",
}
"""Texts of options that several commands declare, each with a type or a default of its own."""

as_json: Decorator = click.option(
    "--json", "as_json", is_flag=True, help="Print the result as one JSON object, and nothing else."
)


def output_path(*suffixes: str) -> Callable[[click.Context, click.Parameter, str | None], Path | None]:
    """Make a callback of click that checks an output file: it needs one of these suffixes, and a writable folder.

    A table in text may be written to - for standard output, as `written.write_table` does.
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
    """Declare the output file `out`, which needs one of the given suffixes; `what` is its help."""
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
    """Declare the file of a plot, `plot`; its help names what it shows, and then `more`."""
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
"""The file of fragility curves that OpenQuake reads: `nrml`."""


quantiles: Decorator = click.option(
    "--quantiles",
    is_flag=True,
    help="Show quantiles of the peak rotation at each intensity: 16, 50 and 84 % of the runs.",
)
"""Whether quantiles of the peak rotation are shown: `quantiles`."""


rank_measures: Decorator = click.option(
    "--rank-measures",
    is_flag=True,
    help="Rank the intensity measures as well, by how well they predict the outcome.",
)
"""Whether intensity measures are ranked: `rank_measures`."""


curve_plots: Decorator = click.option(
    "--plot", metavar="FOLDER", help="Plot every curve into this folder, created if missing."
)
"""The folder of the plots of a fragility study: `plot`."""


def grouped(**groups: type) -> Decorator:
    """Hand options to a command as objects: `asked=GroundMotions` makes one from the options that are its fields.

    The options themselves are declared by other decorators, above this one.
    """

    def decorate(command: Callable[..., Any]) -> Callable[..., Any]:
        @wraps(command)
        def with_groups(*args: Any, **given: Any) -> Any:
            made = {
                name: group(**{field.name: given.pop(field.name) for field in fields(group) if field.name in given})
                for name, group in groups.items()
            }
            return command(*args, **made, **given)

        return with_groups

    return decorate


def in_order(*decorators: Decorator) -> Decorator:
    """Join several options into one decorator; the help lists them in this order."""

    def decorate(command: Callable[..., Any]) -> Callable[..., Any]:
        for decorator in reversed(decorators):
            command = decorator(command)
        return command

    return decorate


def _sign(ctx: click.Context, param: click.Parameter, value: str | None) -> str | None:
    return "\t" if value == "tab" else value


table_signs: Decorator = in_order(
    click.option(
        "--separator", type=click.Choice((",", ";", "tab")), callback=_sign,
        help="Separator of the CSV table.  [default: ,]",
    ),
    click.option(
        "--decimal", type=click.Choice((".", ",")), help="Decimal sign of the CSV table.  [default: .]"
    ),
)  # fmt: skip
"""The signs of a table in text: `separator` and `decimal`, as spreadsheets of another locale expect them."""


def record_option(*names: str, **more: Any) -> Decorator:
    """Declare an option that reads or processes records, so that the help lists it under their heading."""
    return click.option(*names, cls=RecordOption, **more)


ground_motions: Decorator = in_order(
    click.option(
        "--record", "records", multiple=True, metavar="PLACE", shell_complete=complete.files,
        help="Ground motion file, - for standard input, or a quoted pattern such as 'records/*.AT2'. Repeatable.",
    ),
    click.option(
        "--pulse", "pulses", multiple=True, metavar="PULSE",
        shell_complete=complete.plugins(complete.PULSES, ending=":"),
        help="Pulse instead of a record, NAME:AMPLITUDE:PERIOD, such as sine:0.6g:0.8s. Repeatable.",
    ),
)  # fmt: skip
"""Ground motions, any number of them: `records` and `pulses`."""


def _once(ctx: click.Context, param: click.Parameter, value: tuple[Any, ...]) -> Any:
    """Return the value of a correction, and refuse one that is given twice; a callback of click."""
    if len(value) > 1:
        hint = "a `processing:` list of a study, or of a list of records, may repeat a step."
        raise click.BadParameter(f"is given twice: give it once; {hint}", ctx, param)
    return value[0] if value else None


def _choices(option: Option) -> Callable[..., list[str]] | None:
    """Return the completion of an option whose metavar lists its values."""
    if not option.metavar.startswith("["):
        return None
    return lambda ctx, param, typed: [each for each in option.metavar[1:-1].split("|") if each.startswith(typed)]


def _kind(name: str, option: Option) -> dict[str, Any]:
    """Return the arguments of click that make an option a flag, or take and complete its value."""
    if not option.metavar:
        return {"is_flag": True, "default": None}
    completed = complete.files if option.metavar == "FILE" else _choices(option)
    return {"type": Parsed(name, option.parse), "metavar": option.metavar, "shell_complete": completed}


def _declared(options: Mapping[str, Option]) -> Decorator:
    """Declare the options for reading records, from the table of their declarations."""
    return in_order(
        *(
            record_option(
                f"--{(option.key or name).replace('_', '-')}",
                name,
                help=option.help,
                **_kind(name, option),
                **({"multiple": True, "callback": _once} if name in CORRECTIONS else {}),
            )
            for name, option in options.items()
        )
    )


def _packed(command: Callable[..., Any]) -> Callable[..., Any]:
    """Hand the options of records to a command: typed ones as `options`, in their order, users' defaults as `usual`."""

    @wraps(command)
    def with_options(*args: Any, **given: Any) -> Any:
        options = {name: given.pop(name) for name in [*given] if name in READING or name in SCALING}
        options = {name: value for name, value in options.items() if value is not None}
        usual = {name: options.pop(name) for name in [*options] if from_default(name)}
        return command(*args, options=options, usual=usual, **given)

    return with_options


reading: Decorator = in_order(_declared(READING), _packed)
"""The options for reading and processing records; corrections are made in the order in which they are given."""


model: Decorator = click.option(
    "--model", type=click.Choice(MODELS), default="nonlinear", show_default=True, help=HELP["model"]
)


def polarity(*choices: str, default: str = "1") -> Decorator:
    """Declare the option `polarity` of a motion, with the given choices; the help of a command explains `both`."""
    return click.option(
        "--polarity",
        type=click.Choice(choices),
        default=default,
        show_default=True,
        help="Polarity of the motion: 1 as given, -1 reversed.",
    )


def scaling(*polarities: str, default: str = "1") -> Decorator:
    """Declare the options that scale a motion (`scale`, `target_pga`, `target_pgv`), and those for `polarity`."""
    return in_order(_declared(SCALING), polarity(*polarities, default=default))


release: Decorator = click.option(
    "--release",
    type=TILT,
    metavar="TILT",
    help="Initial tilt of a release from rest: a fraction of phi_cr, or an angle such as 0.05rad; negative is "
    "anticlockwise.",
)
"""The tilt from which a free motion starts: `release`."""


site: Decorator = click.option("--site", type=click.Path(), metavar="SITE.yaml", help=HELP["site"])

on_floor: Decorator = click.option(
    "--on-floor", is_flag=True, help="The motions are those of the floor of the site, and not of the ground."
)

shape: Decorator = click.option(
    "--shape",
    default="sine",
    show_default=True,
    metavar="SHAPE",
    shell_complete=complete.plugins(complete.PULSES),
    help="Pulse shape: sine, cosine, half_sine, rectangular, ricker, ..., followed by its parameters if it has any.",
)


def sized_pulse(*polarities: str, required: bool = False) -> Decorator:
    """Declare one pulse: `shape`, `ag`, `period`, and `polarity` with the given choices."""
    return in_order(
        click.option(
            "--ag",
            required=required,
            type=quantity_of(PULSE_AMPLITUDE),
            metavar="AMPLITUDE",
            help=HELP["ag"],
        ),
        click.option("--period", required=required, type=quantity_of(PERIOD), metavar="PERIOD", help=HELP["period"]),
        shape,
        polarity(*polarities),
    )


def around(usual: int | None = 200, shown: str | bool = True) -> Decorator:
    """Declare the neighbours of a motion, `neighbours` with its default and how it is shown, and their deviations."""
    return in_order(
        click.option(
            "--neighbours",
            type=click.IntRange(0, 1_000_000),
            default=usual,
            show_default=shown,
            metavar="N",
            help="Number of neighbouring motions to simulate as well; `respond`, `animate` and `survey` accept 0 for "
            "none.",
        ),
        click.option(
            "--amplitude-deviation",
            type=FRACTION,
            default=0.04,
            show_default=True,
            metavar="SHARE",
            help="Standard deviation of ln amplitude of the neighbours.",
        ),
        click.option(
            "--slenderness-deviation",
            type=FRACTION,
            metavar="SHARE",
            help="Standard deviation of ln slenderness; by default that of the file, or 10 %.",
        ),
        click.option(
            "--restitution-deviation",
            type=FRACTION,
            metavar="ETA",
            help="Standard deviation of restitution; by default that of the file, 0.03 of a given value, or 0.05.",
        ),
    )


engine: Decorator = click.option(
    "--engine",
    type=click.Choice(ENGINES),
    default="exact",
    show_default=True,
    help="Engine: exact (one degree of freedom), blocks (free blocks), or auto (blocks if exact tells no outcome).",
)
"""Who simulates the motions."""


def few_neighbours(given: dict[str, Any], few: int | None) -> None:
    """Replace the default number of neighbours by another with free blocks, which take long."""
    typed = click.get_current_context().get_parameter_source("neighbours") is ParameterSource.COMMANDLINE
    if given["engine"] != "exact" and not typed:
        given["neighbours"] = few


opening: Decorator = click.option(
    "--opening",
    type=SHARE,
    default=OPENING,
    show_default=True,
    metavar="SHARE",
    help="Largest opening of a joint up to which a history holds, over D_cr.",
)
"""The limit of the opening of joints."""


def _or_here(ctx: click.Context, parameter: click.Parameter, given: Any) -> Any:
    if given:
        return given
    from rocking_cli.ask.given import LOCAL_FILE

    return (LOCAL_FILE,) if parameter.nargs == -1 else LOCAL_FILE


structure: Decorator = click.argument("file", required=False, type=click.Path(), callback=_or_here)
"""One structure, by default that of the current folder or the default block."""
structures: Decorator = click.argument("files", metavar="[FILE]...", nargs=-1, type=click.Path(), callback=_or_here)
"""Structures, by default one as for `structure`."""


def stem(structure: str | Path) -> str:
    """Return the default name of files made from a structure, without suffix."""
    return "rocking" if structure == STANDARD_OUTPUT else Path(structure).stem
