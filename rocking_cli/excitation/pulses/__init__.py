"""Installed pulse shapes, found by the entry points `rocking.pulses`, and the parser of pulse specifications."""

from __future__ import annotations

from dataclasses import fields
from importlib.metadata import EntryPoint

from rocking_cli.errors import InputError, MechanismError
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.excitation.pulses.base import COARSE_POINTS_PER_PERIOD, Pulse, Segment
from rocking_cli.plugins.registry import Plugins, origin
from rocking_cli.units import QUANTITY, UNITS

__all__ = ["COARSE_POINTS_PER_PERIOD", "Pulse", "PulseShapes", "Segment", "parse_pulse"]

_TIMES = {"": 1.0, "s": 1.0, "ms": 1e-3}


class PulseShapes(Plugins[type[Pulse]]):
    """Pulse shapes by name. Listing names loads nothing; looking one up loads it.

    Raises
    ------
    InputError
        On looking up an unknown name.
    MechanismError
        On looking up a plugin that cannot be loaded, is no pulse shape, or has a name that two packages claim.
    """

    group = "rocking.pulses"
    kind = "pulse"

    @staticmethod
    def accept(loaded: object, point: EntryPoint) -> type[Pulse]:
        """Return the loaded object if it is a complete pulse shape with the name of its entry point."""
        if not (isinstance(loaded, type) and issubclass(loaded, Pulse)) or loaded.__abstractmethods__:
            raise MechanismError(f"{origin(point)} is not a pulse shape: it must derive from Pulse and be complete")
        if getattr(loaded, "name", None) != point.name or not isinstance(getattr(loaded, "title", None), str):
            raise MechanismError(f"{origin(point)} is not a pulse shape: it needs name = {point.name!r} and a title")
        return loaded


def parse_pulse(text: str) -> Pulse:
    """Return the pulse of a specification such as `sine:0.6g:0.8s`.

    Parameters
    ----------
    text : str
        Name, amplitude with its unit (g, m/s2, cm/s2, mm/s2, gal, mg or %g), period in s or ms (or a frequency in Hz),
        and further parameters of the shape, as numbers or with their unit: for `mavroeidis` the phase in deg and the
        number of cycles.

    Raises
    ------
    InputError
        If the shape is unknown, a number or a unit is missing or out of range; the message has the expected form.
    """
    name, *words = (word.strip() for word in text.split(":"))
    shape = PulseShapes()[name]
    further = fields(shape)[2:]
    form = f"expected {name}:{shape.form}, such as {shape(0.6 * STANDARD_GRAVITY, 0.8)}"
    if not 2 <= len(words) <= 2 + len(further):
        raise InputError(f"malformed pulse '{text}': {form}")
    amplitude, unit = _quantity(text, words[0], "amplitude", form, tuple(UNITS))
    period, time = _quantity(text, words[1], "period", form, (*_TIMES, "Hz"))
    if time == "Hz" and period == 0:
        raise InputError(f"pulse '{text}': the frequency must not be zero")
    seconds = 1 / period if time == "Hz" else period * _TIMES[time]
    rest = {}
    for field, word in zip(further, words[2:], strict=False):
        rest[field.name], _ = _quantity(text, word, field.name, form, ("", field.metadata.get("unit", "")))
    return shape(amplitude * UNITS[unit], seconds, **rest)


def _quantity(text: str, word: str, what: str, form: str, units: tuple[str, ...]) -> tuple[float, str]:
    match = QUANTITY.fullmatch(word)
    if match is None:
        raise InputError(f"pulse '{text}': '{word}' is not a valid {what}: {form}")
    unit = next((each for each in units if each.lower() == (match[2] or "").strip().lower()), None)
    if unit is None:
        stated = f"unknown unit '{match[2].strip()}'" if match[2] else "no unit"
        known = ", ".join(filter(None, units))
        raise InputError(f"pulse '{text}': {stated} of {what}, {f'give {known}' if known else 'it takes none'}: {form}")
    return float(match[1]), unit
