"""How a record is read and scaled: the options, declared once for the command line, Python, files and documentation.

Options of the command line, fields of study files and of lists of records, and keyword arguments in Python are made of
these declarations. The module imports nothing heavy, so that the help of a command stays fast.
"""

import re
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Annotated, Any, Literal, NamedTuple, TypedDict

from rocking_cli.errors import InputError, Problem
from rocking_cli.units import UnitError, number_of

if TYPE_CHECKING:
    from pathlib import Path

    from rocking_cli.excitation.records.record_units import Gain
    from rocking_cli.processing.floor import Floor
    from rocking_cli.processing.steps import Step

ALL_AZIMUTHS = "all"
"""The azimuth that stands for every direction."""
QUANTITIES = ("acceleration", "velocity", "displacement")
UNITS = ("g", "m/s2", "cm/s2", "mm/s2", "gal", "mg", "%g", "ft/s2", "in/s2")
"""Units of acceleration, repeated here so that the help needs no numpy; a test compares both lists."""


class Option(NamedTuple):
    """An option of reading or scaling a record.

    Parameters
    ----------
    help : str
        Description of the option, for all pages.
    parse : callable
        Returns the value of what the user gives, as text or in another form. Raises `InputError`.
    metavar : str
        Placeholder of its value in the help; empty for a flag.
    key : str
        Its name in files, and with dashes on the command line; empty if it is that of the argument.
    """

    help: str
    parse: Callable[[Any], Any]
    metavar: str
    key: str = ""


def _refused(name: str, message: str, hint: str) -> InputError:
    return InputError(Problem(message, field=f"`{name}`", hint=hint))


def _in(unit: str, name: str, example: str, *, positive: bool = True) -> Callable[[Any], float]:
    """Return the parser of a quantity, given as a number in its unit or as text, with its unit or without."""

    def parse(value: Any) -> float:
        try:
            number = _acceleration(value) if unit == "g" else number_of(value, unit)
        except UnitError as error:
            before = f"{error.hint}; " if error.hint else ""
            raise _refused(name, error.message, f"{before}give a value such as {example}") from None
        if positive and number <= 0:
            raise _refused(name, f"{value!r} is not positive", f"give a value such as {example}")
        return number

    return parse


def _acceleration(value: Any) -> float:
    from rocking_cli.excitation.records.record_units import in_g

    return in_g(value)


def _unit(value: Any) -> str:
    """Return the name of a unit of acceleration, velocity or length in any spelling that headers have."""
    from rocking_cli.excitation.records.record_units import canonical, quantity_of

    name = canonical(str(value))
    if name is None and quantity_of(str(value)) is None:
        raise _refused("units", f"{value!r} is not a known unit", f"give one of {', '.join(UNITS)}")
    return name or "".join(str(value).split())


def _quantity(value: Any) -> str:
    if value not in QUANTITIES:
        raise _refused("from", f"must be one of {', '.join(QUANTITIES)}, got {value!r}", "by default acceleration")
    return str(value)


def _gain(value: Any) -> Any:
    from rocking_cli.excitation.records.record_units import Gain

    return value if isinstance(value, Gain) else Gain.parse(str(value))


def _flag(name: str) -> Callable[[Any], bool]:
    def parse(value: Any) -> bool:
        if not isinstance(value, bool):
            raise _refused(name, f"must be true or false, got {value!r}", "leave it out for false")
        return value

    return parse


def _channel(value: Any) -> str:
    if isinstance(value, bool) or not isinstance(value, str | int):
        raise _refused("channel", f"must be a number, from 1, or a name, got {value!r}", "messages list the channels")
    return str(value)


def _file(value: Any) -> Any:
    if isinstance(value, str) or hasattr(value, "__fspath__"):
        return value
    raise _refused("with", f"must be the file of the second component, got {value!r}", "give its path")


def _azimuth(value: Any) -> float | str:
    return ALL_AZIMUTHS if value == ALL_AZIMUTHS else _in("deg", "azimuth", "30", positive=False)(value)


def _floor(value: Any) -> Any:
    from rocking_cli.processing.floor import Floor

    return value if isinstance(value, Floor) else Floor.parse(value)


def _step(name: str) -> Callable[[Any], Any]:
    def parse(value: Any) -> Any:
        from rocking_cli.processing.steps import Step, parse_step

        return value if isinstance(value, Step) else parse_step(name, value)

    return parse


CORRECTIONS = ("baseline", "highpass", "lowpass", "taper", "trim", "resample")


class ReadingArguments(TypedDict, total=False):
    """Keyword arguments of verbs that read records; the corrections are made in the order in which they are given."""

    # Columns: name, types, help, parser, metavar, and the name in files if it differs.
    # fmt: off
    units: Annotated[str | None, Option(
        "Unit of the record, if the file does not state it.", _unit, f"[{'|'.join(UNITS)}]")]
    dt: Annotated[float | str | None, Option(
        "Sampling interval in s, if the file has no times.", _in("s", "dt", "0.01s"), "TIME")]
    channel: Annotated[str | int | None, Option(
        "Channel or column to read: its number, from 1, or its name.", _channel, "CHANNEL")]
    quantity: Annotated[Literal["acceleration", "velocity", "displacement"] | None, Option(
        "Quantity in the record; velocities and displacements are differentiated.",
        _quantity, f"[{'|'.join(QUANTITIES)}]", "from")]
    gain: Annotated["Gain | str | None", Option(
        "Instrument sensitivity: the value of one unit of the record, such as 0.05m/V or 4.7e-6m/s2/count.",
        _gain, "GAIN")]
    run_on: Annotated[bool | None, Option(
        "Read a text without times as one series that runs on over its rows.", _flag("run_on"), "")]
    despite_header: Annotated[bool | None, Option(
        "Accept a text with other numbers of points or peaks than its header states, as it was cut on purpose.",
        _flag("despite_header"), "")]
    other: Annotated["str | Path | None", Option(
        "Second horizontal component, perpendicular to the record; the two are rotated into the plane of the "
        "structure.", _file, "FILE", "with")]
    other_channel: Annotated[str | int | None, Option(
        "Channel of the second component in its file.", _channel, "CHANNEL", "with_channel")]
    azimuth: Annotated[float | str | None, Option(
        "Azimuth of the structure's plane, in degrees: 0 is the record, 90 the second. `respond` also accepts all.",
        _azimuth, "DEGREES")]
    baseline: Annotated["Step | str | None", Option(
        "Baseline correction: the best-fitting constant, line or parabola is subtracted.",
        _step("baseline"), "linear|quadratic")]
    highpass: Annotated["Step | str | float | None", Option(
        "High-pass corner frequency in Hz (Butterworth, zero phase).", _step("highpass"), "HZ")]
    lowpass: Annotated["Step | str | float | None", Option(
        "Low-pass corner frequency in Hz (Butterworth, zero phase).", _step("lowpass"), "HZ")]
    taper: Annotated["Step | str | float | None", Option(
        "Fraction of the duration over which each end is tapered to zero.", _step("taper"), "SHARE")]
    trim: Annotated["Step | str | None", Option(
        "Start and end of the part to keep, in s.", _step("trim"), "FROM:TO")]
    resample: Annotated["Step | str | float | None", Option(
        "Resample to this interval, in s; uneven times are put on a regular grid.", _step("resample"), "TIME")]
    floor: Annotated["Floor | str | Mapping[str, Any] | None", Option(
        "Floor of a building on which the structure stands: T1=0.4,xi=0.05,z=6m,H=9m,n=3 (or z/H=0.67, gamma=1.29).",
        _floor, "T1=...")]
    # fmt: on


class MotionArguments(ReadingArguments, total=False):
    """Keyword arguments of verbs that read and scale ground motions: those of `ReadingArguments`, and one scale."""

    # fmt: off
    scale: Annotated[float | str | None, Option(
        "Scale factor on the motion.  [default: 1]", _in("", "scale", "1.5", positive=False), "FACTOR")]
    target_pga: Annotated[float | str | None, Option(
        "Peak ground acceleration to scale the motion to, in g.", _in("g", "target_pga", "0.35g"), "ACCELERATION")]
    target_pgv: Annotated[float | str | None, Option(
        "Peak ground velocity to scale the motion to, in m/s.", _in("m/s", "target_pgv", "0.4m/s"), "VELOCITY")]
    # fmt: on


def _declared(arguments: type) -> dict[str, Option]:
    """Return the options of a class by the names of its arguments, and list them in its docstring."""
    declared = {name: annotation.__metadata__[0] for name, annotation in arguments.__annotations__.items()}
    lines = "".join(
        f"    {name} : optional\n        {re.sub('  .*', '', each.help)}\n" for name, each in declared.items()
    )
    arguments.__doc__ = f"{arguments.__doc__}\n\n    Parameters\n    ----------\n{lines}"
    return declared


READING: dict[str, Option] = _declared(ReadingArguments)
"""The options of reading a record, in the order of the help."""
SCALING: dict[str, Option] = {
    name: each for name, each in _declared(MotionArguments).items() if name not in READING
}  # fmt: skip
"""The options of scaling a motion, of which one may be given."""
