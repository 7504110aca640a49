"""Installed measures of intensity by name, found by the entry points `rocking.measures`."""

from __future__ import annotations

import re
from functools import cache
from importlib.metadata import EntryPoint

from rocking_cli.errors import InputError, MechanismError, Problem
from rocking_cli.plugins.errors import blame
from rocking_cli.plugins.registry import Plugins, leave_out, origin
from rocking_cli.processing.intensity.base import Measure, MotionMeasure, Reference, RelativeMeasure, RunMeasure
from rocking_cli.text import cut, did_you_mean

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
