"""Kinds of values: numbers, quantities, ranges of them, and files, by one grammar for the terminal, Python and files.

A quantity is a number in its unit, or a text with a unit; a text needs one where two units could be meant.
"""

from __future__ import annotations

from functools import partial
from math import inf, isfinite
from pathlib import Path
from typing import Any

from rocking_cli.ask.asked import Kind
from rocking_cli.errors import named
from rocking_cli.text import cut
from rocking_cli.units import CHOICES, UnitError, number_of, read, split

STANDARD_OUTPUT = "-"
LOCAL_FILE = Path("rocking.yaml")
"""Stands for the structure that a command was not given: the file of this name in the current folder, or the block."""


def as_given(value: Any) -> Any:
    """Return a value as it is: pydantic checks it."""
    return value


def each(value: Any) -> Any:
    """Return several values as they are, and one as a tuple of one."""
    return value if isinstance(value, list | tuple) else (value,)


def whole(value: Any) -> Any:
    """Return the whole number of a text; pydantic checks all else."""
    try:
        return int(value) if isinstance(value, str) else value
    except ValueError:
        return value


def number(value: Any) -> float:
    """Return a finite number."""
    try:
        number = float(value)
    except (TypeError, ValueError, OverflowError):
        raise ValueError(f"{cut(repr(value))} is not a number") from None
    if not isfinite(number):
        raise ValueError(f"{value} is not a finite number")
    return number


def positive(value: Any) -> float:
    """Return a finite number above zero."""
    if (given := number(value)) <= 0:
        raise ValueError(f"{value} is not a positive number")
    return given


def share(value: Any) -> float:
    """Return a fraction: a number, or a percentage with its sign."""
    if not isinstance(value, str):
        return number(value)
    plain = value.strip()
    try:
        fraction = float(plain.removesuffix("%")) / (100 if plain.endswith("%") else 1)
    except ValueError:
        raise ValueError(f"{value!r} is not a fraction: give a number such as 0.02 or 2%") from None
    return number(fraction)


def below_one(value: Any) -> float:
    """Return a fraction from 0 to below 1."""
    if not 0 <= (given := share(value)) < 1:
        raise ValueError(f"{given:g} is out of range: give a number from 0 up to, but not including, 1")
    return given


def angle(value: Any, unit: str) -> float:
    """Return an angle, in this unit if the text gives none. Raises `UnitError`."""
    parts = split(value) if isinstance(value, str) else None
    return number(value) if parts is None or not parts[1] else read(value, unit)


def _quantity(
    value: Any, what: str, unit: str, example: str, least: float, most: float, *, zero: bool, bare: bool
) -> float:
    """Return a quantity in its unit; a text without a unit is one in this unit, unless `bare` is false."""
    try:
        given = _in_unit(value, what, unit, bare=bare)
    except UnitError as error:
        hint = error.hint or ""
        remedy = f"{hint} Give a value" if hint.endswith("?") else f"{hint}," if hint else "give a value"
        raise ValueError(f"{error.message}: {remedy} such as {example}") from None
    if not (0 < given < inf or (zero and given == 0)):
        turn = f"; {named('polarity')} -1 reverses the pulse" if unit == "g" and given < 0 else ""
        raise ValueError(f"{value!r} is not positive: give a value such as {example}{turn}")
    if not least <= given <= most:
        raise ValueError(f"{value!r} is outside the supported range: {f'{least:g} to {most:g} {unit}'.strip()}")
    return given


def _in_unit(value: Any, what: str, unit: str, *, bare: bool) -> float:
    if not isinstance(value, str):
        return number(value)
    parts = split(value)
    if parts is None:
        raise UnitError(f"{value!r} is not a valid {what}")
    if not parts[1]:
        if not bare:  # a plain 6 may mean g or m/s2
            raise UnitError(f"{value!r} has no unit", f"give one of {CHOICES}")
        return float(parts[0])
    if what == "period" and parts[1].lower() == "hz":
        return 1 / float(parts[0]) if float(parts[0]) else 0.0
    return number_of(value, unit) if unit == "g" else read(value, unit)


def quantity(
    what: str,
    unit: str,
    metavar: str,
    example: str,
    least: float = 0.0,
    most: float = inf,
    *,
    zero: bool = False,
    bare: bool = True,
) -> Kind:
    """Return the kind of a quantity above zero.

    Parameters
    ----------
    what : str
        Name in messages.
    unit : str
        Unit of a plain number, and of the value; empty for a pure number.
    metavar, example : str
        Placeholder in the help, and a value as typed.
    least, most : float
        Bounds of what can be simulated: beyond them a simulation would take hours, or is impossible.
    zero : bool
        Whether it may be zero.
    bare : bool
        Whether a text may leave out the unit.
    """
    reader = partial(_quantity, what=what, unit=unit, example=example, least=least, most=most, zero=zero, bare=bare)
    return Kind(reader, metavar, unit)


def span(kind: Kind, example: str, metavar: str = "FROM:TO") -> Kind:
    """Return the kind of a range of quantities, the smaller first: `0.2s:4s`, or two values."""

    def ends(value: Any) -> tuple[float, float]:
        words = value.split(":") if isinstance(value, str) else list(value)
        if len(words) != 2:
            raise ValueError(f"{value!r} is not a range: give the smallest and the largest value, such as {example}")
        low, high = map(kind.read, words)
        if not low < high:
            raise ValueError(f"{value!r} is not increasing: give the smaller value first, such as {example}")
        return low, high

    return Kind(ends, metavar, kind.unit)


def several(kind: Kind, metavar: str) -> Kind:
    """Return the kind of several values: separated by commas, or a sequence; one stands for itself."""

    def all_of(value: Any) -> tuple[Any, ...]:
        words = value.split(",") if isinstance(value, str) else each(value)
        return tuple(kind.read(word.strip() if isinstance(word, str) else word) for word in words)

    return Kind(all_of, metavar, kind.unit, kind.words.replace(" ", ","))


def word(*known: str, what: str = "word") -> Kind:
    """Return the kind of one of several words."""

    def of(value: Any) -> str:
        if str(value) not in known:
            raise ValueError(f"must be one of {', '.join(known)}, got {value!r}")
        return str(value)

    return Kind(of, what.upper(), words=" ".join(known))


def _tilt(value: Any) -> Any:
    from rocking_cli.studies.neighbours import Release

    return value if isinstance(value, Release) else Release.of(value if isinstance(value, str) else number(value))


def _output(value: Any, suffixes: tuple[str, ...]) -> Path:
    from rocking_cli.io.files import check_writable

    path = _path(value)
    if str(value) == STANDARD_OUTPUT and ".csv" in suffixes:
        return path
    if path.suffix.lower() not in suffixes:
        raise ValueError(f"{str(value)!r} does not end in {' or '.join(suffixes)}")
    check_writable(path)
    return path


def output(*suffixes: str, metavar: str = "") -> Kind:
    """Return the kind of a file that is written, with one of these suffixes; a table in text may go to - ."""
    return Kind(partial(_output, suffixes=suffixes), metavar or f"FILE{suffixes[0]}", words="output")


def _written(value: Any, *, folder: bool = False) -> Path:
    path = _path(value)
    if not folder:
        from rocking_cli.io.files import check_writable

        check_writable(path)
    return path


def _path(value: Any) -> Path:
    if not isinstance(value, str | Path):
        raise ValueError(f"must be a path, got {value!r}")
    return Path(value)


def written(metavar: str) -> Kind:
    """Return the kind of a file that is written, with any suffix."""
    return Kind(_written, metavar, words="output")


FOLDER = Kind(partial(_written, folder=True), "FOLDER", words="output")
WHOLE, FILE = Kind(whole, "N"), Kind(as_given, "FILE", words="file")
SITE = Kind(as_given, "SITE.yaml", words="file")
SHAPE = Kind(str, "SHAPE", words="rocking.pulses")
NUMBER, POSITIVE, SHARE = Kind(number, "NUMBER"), Kind(positive, "NUMBER"), Kind(share, "SHARE")
BELOW_ONE = Kind(below_one, "SHARE")
TILT = Kind(_tilt, "TILT")
PULSE_AMPLITUDE = quantity("acceleration", "g", "AMPLITUDE", "0.6g", 1e-9, 1e6, bare=False)
PERIOD = quantity("period", "s", "PERIOD", "0.8s", 1e-6, 1e6)
RATIO = quantity("number", "", "NUMBER", "4", 1e-6, 1e6)
INTERVAL = quantity("time", "s", "TIME", "0.01s")
TAIL = quantity("time", "s", "TIME", "10s", most=3600, zero=True)
