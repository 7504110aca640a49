"""What an instrument wrote, if not an acceleration in a unit: displacements, velocities, volts and counts."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import isfinite
from typing import Literal, NamedTuple, get_args

import numpy as np
from numpy.typing import NDArray

from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.base import STANDARD_GRAVITY, Doubt, GroundMotion
from rocking_cli.excitation.doubts import of_samples
from rocking_cli.excitation.records.units import UNITS, canonical, header_units, resolve_unit
from rocking_cli.text import did_you_mean
from rocking_cli.units import KINDS

Quantity = Literal["acceleration", "velocity", "displacement"]
QUANTITIES: tuple[Quantity, ...] = get_args(Quantity)
OTHER_UNITS: dict[Quantity, tuple[str, ...]] = {
    "velocity": tuple(KINDS["velocity"]),
    "displacement": tuple(KINDS["length"]),
}
"""The units of what is differentiated; those of accelerations are in `units.UNITS`."""
EXAMPLE = "0.05 m/V"
COARSE = 0.05  # of the peak: what one step of the smallest digit may make of it

_IN_HEADER = re.compile(r"[\[(]\s*([^\])\s]+)\s*[\])]|\bin\s+([^\s,;]+)")
_FORM = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(.*?)\s*", re.ASCII)
_PER = re.compile(r"(.+?)\s*(?:/|\bper\b)\s*([^\W\d_%]{1,20}|%)")


class Wanted(NamedTuple):
    """What is asked of a reader besides accelerations at even times; one with `TAKES_WANTED = True` can be asked.

    Parameters
    ----------
    quantity : str
        What the values of the file are; the reader gives them in the place of accelerations, in SI units.
    raw : bool
        Whether they are the output of an instrument, without a unit that matters: they are given as they are.
    uneven : bool
        Whether times may be uneven: the values are then put on an even grid, and a `Doubt` says how uneven.
    """

    quantity: Quantity = "acceleration"
    raw: bool = False
    uneven: bool = False

    def unit(self, file: str, header: Sequence[tuple[int, str]], units: str | None) -> tuple[str, float]:
        """Name and size of the unit of the values; arguments and errors are those of `units.resolve_unit`."""
        if self.raw:
            self._refuse_stated(file, header)
            return "raw", 1.0
        if self.quantity == "acceleration":
            found = resolve_unit(file, header, units)
            return found, UNITS[found]
        return self._other_unit(file, header, units)

    @staticmethod
    def _refuse_stated(file: str, header: Sequence[tuple[int, str]]) -> None:
        for number, line in header:
            if stated := header_units(line):
                message = f"the header says that the values are in {', '.join(sorted(stated))} already"
                raise InputError(Problem(message, file, number, excerpt=line.strip()[:100], hint="leave `gain` out"))

    def _other_unit(self, file: str, header: Sequence[tuple[int, str]], units: str | None) -> tuple[str, float]:
        known = ", ".join(units_of(self.quantity))
        if units is not None:
            size = size_of(units, self.quantity)
            if size is None:
                message = f"'{units}' is no unit of a {self.quantity}"
                raise InputError(Problem(message, field="`units`", hint=f"choose one of: {known}"))
            return units, size
        for _, line in reversed(header):
            for one in (a or b for a, b in _IN_HEADER.findall(line)):
                if (size := size_of(one, self.quantity)) is not None:
                    return one, size
        message = f"the file does not say what unit its {self.quantity}s are in"
        hint = f"say which it is with `units`: {known}; or with `gain`, such as {EXAMPLE}"
        raise InputError(Problem(message.replace("ys are", "ies are"), file, hint=hint))


def units_of(quantity: Quantity) -> tuple[str, ...]:
    """The units that a quantity may be given in."""
    return tuple(UNITS) if quantity == "acceleration" else OTHER_UNITS[quantity]


def size_of(unit: str, quantity: Quantity) -> float | None:
    """Size of a unit of a quantity, in SI units; None if it is not one."""
    if quantity == "acceleration":
        name = canonical(unit)
        return None if name is None else UNITS[name]
    said = KINDS["velocity" if quantity == "velocity" else "length"].get("".join(unit.split()))
    return None if said is None else float(said)


def quantity_of(unit: str) -> Quantity | None:
    """What a unit is of; None if it is of none of the three."""
    return next((each for each in QUANTITIES if size_of(unit, each) is not None), None)


@dataclass(frozen=True)
class Gain:
    """What one unit of an instrument's output stands for.

    Parameters
    ----------
    size : float
        In m/s2, m/s or m, not zero; a negative one reverses the motion.
    quantity : str
        Of what it is.
    text : str
        As it is written: `0.05 m/V`.
    """

    size: float
    quantity: Quantity
    text: str

    def __str__(self) -> str:
        return self.text

    @classmethod
    def parse(cls, text: str) -> Gain:
        """Read a gain such as `0.05 m/V`, `1.5e-5 m/count` or `2 g/V`; what it is per may be left out.

        Raises
        ------
        InputError
            If it is no number, or has no unit of an acceleration, a velocity or a length.
        """
        match = _FORM.fullmatch(text)
        if match is None or not (isfinite(float(match[1])) and float(match[1])):
            raise _refused(f"{text!r} is not a number with a unit")
        number, unit = match[1], match[2]
        if not unit:
            raise _refused(f"{text!r} is a gain without a unit")
        of = unit if quantity_of(unit) else (per[1] if (per := _PER.fullmatch(unit)) else unit)
        quantity = quantity_of(of)
        if quantity is None:
            known = [name for each in QUANTITIES for name in units_of(each)]
            raise _refused(f"{of!r} is no unit of an acceleration, a velocity or a length", did_you_mean(of, known))
        size = size_of(of, quantity)
        assert size is not None
        return cls(float(number) * size, quantity, f"{float(number):g} {unit}")


def _refused(message: str, guess: str | None = None) -> InputError:
    hint = f"{guess}; " if guess else ""
    return InputError(Problem(message, field="`gain`", hint=f"{hint}say what one unit stands for, such as {EXAMPLE}"))


def as_acceleration(measured: GroundMotion, quantity: Quantity) -> GroundMotion:
    """The ground acceleration, of what was measured and stands in the place of it.

    Parameters
    ----------
    measured : GroundMotion
        Its "accelerations" are displacements [m] or velocities [m/s]; of accelerations it is given back.
    quantity : str
        What they are.

    Returns
    -------
    GroundMotion
        Central differences, zero at the first and the last sample. Of what is at a frequency f they leave sinc^2(f dt)
        of a displacement, sinc(2 f dt) of a velocity, sinc(x) = sin(pi x)/(pi x).
    """
    if quantity == "acceleration":
        return measured
    dt, values = measured.dt, measured.acceleration
    inner = np.diff(values, 2) / dt**2 if quantity == "displacement" else (values[2:] - values[:-2]) / (2 * dt)
    found = np.pad(inner, 1)
    if not np.isfinite(found).all():
        raise InputError(Problem("its differences are beyond the range of numbers", measured.name))
    remarks = (*measured.remarks, *of_samples(measured), *_resolution(values, found, dt, quantity))
    return replace(measured, acceleration=found, remarks=remarks, processing=(*measured.processing, said(quantity)))


def said(quantity: Quantity) -> str:
    """How a differentiated quantity is named among what was done to a motion."""
    return f"from {quantity}"


def in_words(quantity: Quantity, dt: float) -> str:
    """What differentiating does, for people: which filter central differences are."""
    twice, half = ("twice ", 0.44295 / dt) if quantity == "displacement" else ("", 0.30168 / dt)
    return f"differentiated {twice}by central differences, which leave half of what is at {half:.3g} Hz"


def _resolution(
    values: NDArray[np.float64], found: NDArray[np.float64], dt: float, quantity: Quantity
) -> tuple[Doubt, ...]:
    """What one step of the smallest digit becomes, where it is much of the whole."""
    steps = np.abs(np.diff(values))
    seen = steps[steps > 0]
    # Rounding of the numbers themselves is no step, and corrected values have none: most steps are the smallest, then.
    smallest = float(seen.min(initial=np.inf))
    power, unit = (2, "m") if quantity == "displacement" else (1, "m/s")
    noise = smallest / dt**power
    peak = float(np.abs(found).max())
    if not (isfinite(noise) and noise > COARSE * peak):
        return ()
    text = (
        f"its smallest step, {smallest:.3g} {unit}, is {noise / STANDARD_GRAVITY:.2g} g once differentiated, of a peak "
        f"of {peak / STANDARD_GRAVITY:.2g} g: noise, unless a `lowpass` takes it out"
    )
    return (Doubt("resolution", noise / STANDARD_GRAVITY, text),)
