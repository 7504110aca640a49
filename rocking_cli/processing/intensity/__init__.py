"""Installed measures of intensity by name, found by the entry points `rocking.measures`."""

from __future__ import annotations

import re
from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import MISSING, Field, dataclass, fields
from functools import cache
from importlib.metadata import EntryPoint
from math import nan
from typing import Any, ClassVar

from rocking_cli.arrays import Reals
from rocking_cli.errors import InputError, MechanismError, PluginError, Problem
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.plugins.errors import blame, failed, guard
from rocking_cli.plugins.registry import Plugins, leave_out, origin
from rocking_cli.text import cut, did_you_mean
from rocking_cli.units import UnitError, number_of


@dataclass(frozen=True, eq=False)
class Reference:
    """Properties of one structure (numbers), or of many (arrays of one shape), to which measures are relative.

    Parameters
    ----------
    p : float or ndarray
        Frequency parameter [rad/s]; NaN if the structure has none.
    lambda_ : float or ndarray
        Uplift acceleration over g.
    gravity : float or ndarray
        Gravitational acceleration [m/s2].
    v_imp : float or ndarray
        Velocity step of the ground that just overturns the structure [m/s]; NaN if not known.
    """

    p: float | Reals
    lambda_: float | Reals
    gravity: float | Reals
    v_imp: float | Reals = nan

    @property
    def uplift(self) -> float | Reals:
        """Uplift acceleration [m/s2]."""
        return self.gravity * self.lambda_


@dataclass(frozen=True)
class Measure(ABC):
    """A measure of the intensity of a ground motion, found by its entry point in `rocking.measures`.

    A measure derives from `MotionMeasure`, `RelativeMeasure` or `RunMeasure`. Its parameters are fields of a frozen
    dataclass, and are written in brackets after its name: `Sa(1.0, 2%)`. The metadata of a field may have its "unit",
    and "after": the character before the parameter, a comma or ":".
    """

    name: ClassVar[str]
    """Name of the measure, such as `PGA`."""
    title: ClassVar[str]
    """Title of the measure, in a few words."""
    unit: ClassVar[str] = ""
    """Unit of the values; empty if they are dimensionless."""
    usual: ClassVar[tuple[str, ...]] = ()
    """Spellings that are used if all measures are requested; by default the name, if every parameter has a default."""
    source: ClassVar[str] = ""
    """Publication that defines the measure."""
    needs: ClassVar[tuple[str, ...]] = ()
    """Fields of `Reference` that the measure needs, of those that not every structure has: `p` and `v_imp`."""

    def __init_subclass__(cls, **named: Any) -> None:
        """Wrap the methods of a measure, so that any failure in them is reported as an error of the plugin."""
        super().__init_subclass__(**named)
        guard(cls, ("__post_init__", "of", "relative"), failed("measure", "name"))

    @property
    @abstractmethod
    def power(self) -> float | None:
        """Power of the scale factor to which the measure is proportional; None if it is computed for every run."""

    @property
    def is_relative(self) -> bool:
        """Whether the measure depends on the structure."""
        return not isinstance(self, MotionMeasure)

    @property
    def base(self) -> MotionMeasure | None:
        """The measure of the motion alone from which this measure is computed; None for a `RunMeasure`."""
        return None

    def relative(self, value: Any, structure: Reference) -> Any:
        """Return the measure for a structure from a value of `base` for the scaled motion; arrays of one shape."""
        return value

    @property
    def label(self) -> str:
        """Name of the measure with its unit, for a heading."""
        return f"{self} [{self.unit}]" if self.unit else str(self)

    def __str__(self) -> str:
        """Return the text from which `parse_measure` makes this measure."""
        parameters = [(field, getattr(self, field.name)) for field in fields(self)]
        while parameters and parameters[-1][1] == parameters[-1][0].default:
            parameters.pop()
        words = ""
        for field, value in parameters:
            written = f"{100 * value:g}%" if field.metadata.get("unit") == "%" else repr(float(value))
            words += f"{field.metadata.get('after', ', ') if words else ''}{written}"
        return f"{self.name}({words})" if words else self.name

    @classmethod
    def read(cls, words: Sequence[str]) -> Measure:
        """Return the measure with these parameters, given as texts from between the brackets.

        Raises
        ------
        InputError
            If there are too few or too many parameters, or one cannot be read; the message has the expected form.
        """
        parameters = fields(cls)
        least = sum(field.default is MISSING for field in parameters)
        if not least <= len(words) <= len(parameters):
            such = f", such as {cls.usual[0]}" if cls.usual else ""
            expected = f"is given as {cls.form()}{such}" if parameters else "takes nothing in brackets"
            raise InputError(f"{cls.name} {expected}")
        return cls(*(_read(word, field, cls.form()) for word, field in zip(words, parameters, strict=False)))

    @classmethod
    def form(cls) -> str:
        """Return the form in which the measure is written: `Sa(PERIOD[, DAMPING])`."""
        words = ""
        for field in fields(cls):
            word = f"{field.metadata.get('after', ', ') if words else ''}{field.name.upper()}"
            words += word if field.default is MISSING else f"[{word}]"
        return f"{cls.name}({words})" if words else cls.name

    @classmethod
    def usually(cls) -> tuple[str, ...]:
        """Return the texts of this measure, with usual parameters, that `all` stands for."""
        return cls.usual or ((cls.name,) if all(field.default is not MISSING for field in fields(cls)) else ())


class MotionMeasure(Measure):
    """A measure of a motion alone.

    A subclass gives `power`, as a class attribute, and `of`.
    """

    @property
    def base(self) -> MotionMeasure:
        """The measure itself."""
        return self

    @abstractmethod
    def of(self, motion: GroundMotion) -> float | None:
        """Return the non-negative value of the measure; None if it is undefined for the motion."""

    def value(self, motion: GroundMotion) -> float:
        """Return the value of the measure; NaN if the motion has none.

        Raises `PluginError` if `of` returns something other than a non-negative number.
        """
        return _sound(self, self.of(motion))


class RelativeMeasure(Measure):
    """A measure of a motion, multiplied by a factor that depends on the structure.

    A subclass gives `to`, the name of the measure of the motion, and `relative`, proportional to its value.
    """

    to: ClassVar[str]
    """Name of the `MotionMeasure` on which this one is based, with its parameters."""

    @property
    def base(self) -> MotionMeasure:
        """The measure of the motion on which this one is based."""
        measure = parse_measure(self.to)
        if not isinstance(measure, MotionMeasure):
            raise PluginError(
                f"the measure {self.name} is relative to {self.to}, which is not a measure of a motion alone"
            )
        return measure

    @property
    def power(self) -> float:
        """Power of the scale factor to which the measure of the motion is proportional."""
        return float(self.base.power or 0.0)

    @abstractmethod
    def relative(self, value: Any, structure: Reference) -> Any:
        """Return the measure for a structure from a value of `base` for the scaled motion; arrays of one shape."""


class RunMeasure(Measure):
    """A measure of a motion and a structure that is not proportional to a power of the scale factor.

    It is computed for every run. A subclass gives `of`.
    """

    power = None

    @abstractmethod
    def of(self, motion: GroundMotion, structure: Reference) -> float | None:
        """Return the value for a scaled motion, not reversed, and one structure; None if it is undefined."""

    def value(self, motion: GroundMotion, structure: Reference) -> float:
        """Return the value of the measure; NaN if it is undefined.

        Raises `PluginError` if `of` returns something other than a non-negative number.
        """
        return _sound(self, self.of(motion, structure))


def _sound(measure: Measure, answer: object) -> float:
    """Return a value if it is a non-negative number. Raises `PluginError` otherwise."""
    if answer is None:
        return nan
    with blame(f"the measure {measure} gave {answer!r}", type(measure).__module__):
        value = float(answer)  # type: ignore[arg-type]
    if value < 0 or value in (float("inf"),):
        raise PluginError(f"the measure {measure} gave {value:g}: a measure is a number, and not negative")
    return value


def _read(word: str, field: Field[Any], form: str) -> float:
    """Return a parameter from a text, a number with or without a unit."""
    try:
        return number_of(word.strip(), field.metadata.get("unit", ""))
    except UnitError as error:
        raise InputError(Problem(f"{field.name}: {error.message}: {form}", hint=error.hint)) from None


__all__ = [
    "IntensityMeasures",
    "Measure",
    "MotionMeasure",
    "Reference",
    "RelativeMeasure",
    "RunMeasure",
    "all_measures",
    "parse_measure",
    "parse_measures",
    "power_of",
]

ALL_MEASURES = "all"
_FORM = re.compile(r"([^()]+)(?:\((.*)\))?", re.DOTALL)


class IntensityMeasures(Plugins[type[Measure]]):
    """Measures of intensity by name. Listing names loads nothing; looking one up loads it.

    Raises
    ------
    InputError
        On looking up an unknown name.
    MechanismError
        On looking up a plugin that cannot be loaded, is no measure, or has a name that two packages claim.
    """

    group = "rocking.measures"
    kind = "measure"

    @staticmethod
    def accept(loaded: object, point: EntryPoint) -> type[Measure]:
        """Return the loaded object if it is a complete measure with the name of its entry point."""
        kinds = (MotionMeasure, RelativeMeasure, RunMeasure)
        if not (isinstance(loaded, type) and issubclass(loaded, kinds)) or loaded.__abstractmethods__:
            what = "it must derive from MotionMeasure, RelativeMeasure or RunMeasure and be complete"
            raise MechanismError(f"{origin(point)} is not a measure: {what}")
        if getattr(loaded, "name", None) != point.name or not isinstance(getattr(loaded, "title", None), str):
            raise MechanismError(f"{origin(point)} is not a measure: it needs name = {point.name!r} and a title")
        if issubclass(loaded, MotionMeasure) and not isinstance(loaded.power, int | float):
            raise MechanismError(f"{origin(point)} is not a measure: it needs a power, of the factor on the motion")
        return loaded


@cache
def parse_measure(text: str) -> Measure:
    """Return the measure of a text such as `PGA`, `Sa(1.0)` or `Sa(1 s, 2%)`.

    Parameters
    ----------
    text : str
        The name in any case and spacing, and its parameters in brackets, as numbers or with their unit.

    Raises
    ------
    InputError
        If there is no such measure, or a parameter is missing or out of range; the message has the expected form.
    MechanismError
        If the plugin of the measure cannot be used.

    Examples
    --------
    >>> str(parse_measure("sa ( 1 )"))
    'Sa(1.0)'
    """
    known = IntensityMeasures()
    plain = {_plain(name): name for name in known}
    if _plain(text) in plain:
        return known[plain[_plain(text)]].read(())
    match = _FORM.fullmatch(text.strip())
    name = plain.get(_plain(match[1])) if match is not None else None
    if match is None or name is None:
        name_given = match[1] if match is not None else text
        by_case = {known_name.lower(): known_name for known_name in known}
        hint = did_you_mean(name_given.strip(), list(by_case)) or ""
        for low, known_name in by_case.items():
            hint = hint.replace(f"did you mean {low}?", f"did you mean {known_name}?")
        if not hint.startswith("did"):
            hint = f"known: {', '.join(known)}"
        raise InputError(Problem(f"unknown measure: {cut(text.strip())}", hint=hint))
    cls = known[name]
    words = re.split("[,:]", match[2]) if (match[2] or "").strip() else []
    with blame(f"the measure {name} failed to be made", cls.__module__):
        return cls.read(words)


def parse_measures(text: str) -> list[Measure]:
    """Return several measures, separated by commas outside of brackets; `all` stands for all measures.

    Raises `InputError` and `MechanismError` as `parse_measure`, and `InputError` if there is no measure in the text.
    """
    words = [word.strip() for word in re.split(r",(?![^(]*\))", text)]
    measures = [
        each for word in words for each in (all_measures() if word.lower() == ALL_MEASURES else [parse_measure(word)])
    ]
    return list(dict.fromkeys(measures))


def all_measures() -> list[Measure]:
    """Return all installed measures, those of a motion alone first; of those with parameters, the usual ones.

    A measure that cannot be loaded is left out with a warning.
    """
    known = IntensityMeasures()
    measures: list[Measure] = []
    for name in known:
        try:
            measures += [parse_measure(spec) for spec in known[name].usually()]
        except MechanismError as error:
            leave_out(error)
    return sorted(measures, key=lambda each: (each.is_relative, each.power is None))


def power_of(cls: type[Measure]) -> float | None:
    """Return the power of the scale factor to which measures of a class are proportional; None for a `RunMeasure`."""
    if issubclass(cls, RelativeMeasure):
        return parse_measure(cls.to).power
    return cls.power if isinstance(cls.power, int | float) else None


def _plain(name: str) -> str:
    """Return a name in lower case without blanks."""
    return "".join(name.lower().split())
