"""How a record is read and scaled: the options, declared once for the command line, Python, files and documentation.

Options of the command line, fields of study files and of lists of records, and keyword arguments in Python are made of
these declarations. The module imports nothing heavy, so that the help of a command stays fast.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

from rocking_cli.errors import InputError, Problem, how_to_correct, named
from rocking_cli.units import CHOICES, UNITS, UnitError, header_unit, number_of

ALL_AZIMUTHS = "all"
"""The azimuth that stands for every direction."""
QUANTITIES = ("acceleration", "velocity", "displacement")


class Option(NamedTuple):
    """An option of reading or scaling a record.

    Parameters
    ----------
    type : str
        Type of the value in Python.
    help : str
        Description of the option, for all pages.
    parse : callable
        Returns the value of what the user gives, as text or in another form. Raises `InputError`.
    metavar : str
        Placeholder of its value in the help; empty for a flag.
    key : str
        Its name in files, and with dashes on the command line; empty if it is that of the argument.
    """

    type: str
    help: str
    parse: Callable[[Any], Any]
    metavar: str
    key: str = ""


def _refused(name: str, message: str, hint: str) -> InputError:
    return InputError(Problem(message, field=named(name), hint=hint))


def _in(unit: str, name: str, example: str, *, positive: bool = True) -> Callable[[Any], float]:
    """Return the parser of a quantity, given as a number in its unit or as text, with its unit or without."""

    def parse(value: Any) -> float:
        try:
            number = number_of(value, unit)
        except UnitError as error:
            before = f"{error.hint}; " if error.hint else ""
            raise _refused(name, error.message, f"{before}give a value such as {example}") from None
        if positive and number <= 0:
            raise _refused(name, f"{value!r} is not positive", f"give a value such as {example}")
        return number

    return parse


def _unit(value: Any) -> str:
    """Return the name of a unit of acceleration, velocity or length in any spelling that headers have."""
    name = header_unit(str(value))
    if name is None and not any(header_unit(str(value), kind) for kind in ("velocity", "length")):
        raise _refused("units", f"{value!r} is not a known unit", f"give one of {CHOICES}")
    return name or "".join(str(value).split())


def _quantity(value: Any) -> str:
    if value not in QUANTITIES:
        raise _refused("quantity", f"must be one of {', '.join(QUANTITIES)}, got {value!r}", "by default acceleration")
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
    raise _refused("other", f"must be the file of the second component, got {value!r}", "give its path")


def _azimuth(value: Any) -> float | str:
    return ALL_AZIMUTHS if value == ALL_AZIMUTHS else _in("deg", "azimuth", "30", positive=False)(value)


def _floor(value: Any) -> Any:
    from rocking_cli.processing.oscillator import Floor

    return value if isinstance(value, Floor) else Floor.parse(value)


def _step(name: str) -> Callable[[Any], Any]:
    def parse(value: Any) -> Any:
        from rocking_cli.processing.steps import Step, parse_step

        return value if isinstance(value, Step) else parse_step(name, value)

    return parse


# Columns: type in Python, help, parser, metavar, and the name in files if it differs.
# fmt: off
READING: dict[str, Option] = {
    "units": Option("str | None", "Unit of the record, if the file does not state it.", _unit, f"[{'|'.join(UNITS)}]"),
    "dt": Option("float | str | None",
        "Sampling interval in s, if the file has no times.", _in("s", "dt", "0.01s"), "TIME"),
    "channel": Option("str | int | None",
        "Channel or column to read: its number, from 1, or its name.", _channel, "CHANNEL"),
    "quantity": Option('Literal["acceleration", "velocity", "displacement"] | None',
        "Quantity in the record; velocities and displacements are differentiated.",
        _quantity, f"[{'|'.join(QUANTITIES)}]", "from"),
    "gain": Option("Gain | str | None",
        "Instrument sensitivity: the value of one unit of the record, such as 0.05m/V or 4.7e-6m/s2/count.",
        _gain, "GAIN"),
    "run_on": Option("bool | None",
        "Read a text without times as one series that runs on over its rows.", _flag("run_on"), ""),
    "despite_header": Option("bool | None",
        "Accept a text with other numbers of points or peaks than its header states, as it was cut on purpose.",
        _flag("despite_header"), ""),
    "other": Option("str | Path | None",
        "Second horizontal component, perpendicular to the record; the two are rotated into the plane of the "
        "structure.", _file, "FILE", "with"),
    "other_channel": Option("str | int | None",
        "Channel of the second component in its file.", _channel, "CHANNEL", "with_channel"),
    "azimuth": Option("float | str | None",
        "Azimuth of the structure's plane, in degrees: 0 is the record, 90 the second. `respond` also accepts all.",
        _azimuth, "DEGREES"),
    "floor": Option("Floor | str | Mapping[str, Any] | None",
        "Floor of a building on which the structure stands: T1=0.4,xi=0.05,z=6m,H=9m,n=3 (or z/H=0.67, gamma=1.29).",
        _floor, "T1=..."),
}
"""The options of reading a record, in the order of the help."""
SCALING: dict[str, Option] = {
    "scale": Option("float | str | None",
        "Scale factor on the motion.", _in("", "scale", "1.5", positive=False), "FACTOR"),
    "target_pga": Option("float | str | None",
        "Peak ground acceleration to scale the motion to, in g.", _in("g", "target_pga", "0.35g"), "ACCELERATION"),
    "target_pgv": Option("float | str | None",
        "Peak ground velocity to scale the motion to, in m/s.", _in("m/s", "target_pgv", "0.4m/s"), "VELOCITY"),
}
"""The options of scaling a motion, of which one may be given."""
CORRECTIONS: dict[str, Option] = {
    "baseline": Option("Step | str | None",
        "Baseline correction: the best-fitting constant, line or parabola is subtracted.",
        _step("baseline"), "linear|quadratic"),
    "highpass": Option("Step | str | float | None",
        "High-pass corner frequency in Hz (Butterworth, zero phase).", _step("highpass"), "HZ"),
    "lowpass": Option("Step | str | float | None",
        "Low-pass corner frequency in Hz (Butterworth, zero phase).", _step("lowpass"), "HZ"),
    "taper": Option("Step | str | float | None",
        "Fraction of the duration over which each end is tapered to zero.", _step("taper"), "SHARE"),
    "trim": Option("Step | str | None", "Start and end of the part to keep, in s.", _step("trim"), "FROM:TO"),
    "resample": Option("Step | str | float | None",
        "Resample to this interval, in s; uneven times are put on a regular grid.", _step("resample"), "TIME"),
}
"""The options of correcting a record, in the order given."""
# fmt: on
PREPARING = READING | CORRECTIONS
"""The options of reading and correcting a record."""


def corrected_once(name: str) -> str:
    """Return the advice to correct a record where it is read, and not where its motion is used."""
    return f"records are corrected once, by {how_to_correct(name)}"
