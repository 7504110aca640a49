"""Quantities with units: `800 mm`, `2.1 t/m3`, `10 deg`. One table for files, options and Python.

`read` refuses a weight, such as `19 kN/m3`, as a mass; fields of structures take it by `mass_of_weight`.

The module imports neither numpy nor pydantic, so that the command line can use it before it needs them.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Mapping
from decimal import Context, Decimal
from math import inf, isfinite

from rocking_cli.text import cut, printable, regex

PI = "3.14159265358979323846264338327950288419716939937510"


def _table(units: str) -> dict[str, str]:
    return dict(unit.split() for unit in units.split(", "))


# Units of every quantity, each with its size in the first, the SI unit. As text, so that 800 mm is exactly 0.8 m.
# Accelerations come before masses, as a field in g is an acceleration and masses are in kg.
KINDS: Mapping[str, Mapping[str, str]] = {
    "length": _table("m 1, mm 0.001, cm 0.01, dm 0.1, km 1000, in 0.0254, ft 0.3048"),
    "acceleration": _table(
        "m/s2 1, cm/s2 0.01, mm/s2 0.001, gal 0.01, g 9.80665, mg 0.00980665, %g 0.0980665, ft/s2 0.3048, in/s2 0.0254"
    ),
    "mass": _table("kg 1, g 0.001, t 1000, Mg 1000, lb 0.45359237"),
    "force": _table("N 1, daN 10, kN 1000, MN 1000000, kgf 9.80665, lbf 4.4482216152605, kip 4448.2216152605"),
    "stiffness": _table("N/m 1, daN/m 10, kN/m 1000, MN/m 1000000, N/mm 1000, kN/mm 1000000, kgf/m 9.80665"),
    "area": _table("m2 1, cm2 0.0001, mm2 0.000001"),
    "pressure": _table(
        "Pa 1, kPa 1000, MPa 1000000, GPa 1000000000, N/mm2 1000000, daN/m2 10, kN/m2 1000, daN/cm2 100000, "
        "kg/cm2 98066.5, kgf/cm2 98066.5, bar 100000, psi 4.4482216152605/0.00064516, ksi 4448.2216152605/0.00064516"
    ),
    "density": _table("kg/m3 1, t/m3 1000, g/cm3 1000, kg/dm3 1000, lb/ft3 0.45359237/0.028316846592"),
    "mass per length": _table("kg/m 1, t/m 1000"),
    "mass per area": _table("kg/m2 1, t/m2 1000"),
    "weight density": _table("N/m3 1, daN/m3 10, kN/m3 1000, kgf/m3 9.80665, lbf/ft3 4.4482216152605/0.028316846592"),
    "time": _table("s 1, ms 0.001, min 60"),
    "velocity": _table("m/s 1, cm/s 0.01, mm/s 0.001, in/s 0.0254, ft/s 0.3048"),
    "angle": _table(f"rad 1, deg {PI}/180, ° {PI}/180, mrad 0.001"),
}
UNITS = {unit: float(size) for unit, size in sorted(KINDS["acceleration"].items(), key=lambda each: each[0] != "g")}
"""Size of each unit of acceleration [m/s2], g first."""
CHOICES = ", ".join(UNITS)
STANDARD_GRAVITY = Decimal("9.80665")  # m/s2
WEIGHT_OF = {"mass": "force", "density": "weight density", "mass per length": "stiffness", "mass per area": "pressure"}
"""Kinds of mass, and the kind of their weight; the weight of a length has the unit of a stiffness."""

QUANTITY = regex(r"([-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?)\s*([^\s\d.,+-].*)?", re.DOTALL)
"""A number, and its unit as it is written, if there is one."""
_COMMA = regex(r"[-+]?[0-9]+(,[0-9]+)+\s*\D*", re.ASCII)
_RAISED = str.maketrans({"²": "2", "³": "3", "º": "°", "^": "", "·": "", "*": ""})
_PRINTED = str.maketrans({"\N{MINUS SIGN}": "-", '"': "", "_": ""})
_ITALIAN_POWER = regex(r"\b([cdm]?m)([qc])(?![a-z])")
_GALS = regex(r"gals?", re.IGNORECASE)
_PREFIX = regex(r"(da|[hdcmkMGTuµn])(?!\1)(.+)")
# As headers spell units of acceleration and velocity, in lower case: cm/sec/sec, cm.s-2, cmps2; cm/sec.
_PER_SECOND_2 = regex(r"(?:/s(?:ec)?(?:2|/s(?:ec)?)|(?<=m)(?:\.?s(?:ec)?-2|p?s2))$")
_PER_SECOND = regex(r"(?:/sec(?:onds?)?|\.?s-1)$")
_OF_G = {"millig": "mg", "milli-g": "mg", "percentg": "%g", "pctg": "%g"}
_EXACT = Context(prec=60, Emax=10**6, Emin=-(10**6), traps=[])


class UnitError(ValueError):
    """Error of a text that is not the required quantity.

    Parameters
    ----------
    message : str
        Problem, such as "12 kg is a mass, not a length".
    hint : str, optional
        Remedy.
    """

    def __init__(self, message: str, hint: str | None = None) -> None:
        self.message, self.hint = message, hint
        super().__init__(f"{message} ({hint})" if hint else message)


def kind_of(unit: str) -> str | None:
    """Return the quantity that a unit measures, such as "length" for `mm`; None for an unknown or empty unit."""
    return next((kind for kind, units in KINDS.items() if unit in units), None)


def units_of(unit: str) -> tuple[str, ...]:
    """Return the units in which a field of this unit may be given: those of its quantity, or this one only."""
    kind = kind_of(unit)
    return tuple(KINDS[kind]) if kind is not None else (unit,) if unit else ()


def split(text: str) -> tuple[str, str] | None:
    """Split a text such as `800 mm` into number and unit, which may be empty; None if it is not a number."""
    match = QUANTITY.fullmatch(text.strip())
    return (match[1], _plain(match[2] or "")) if match else None


def _plain(unit: str) -> str:
    """Return a unit as the table spells it: `kg / m³` and the Italian `kg/mc` are `kg/m3`."""
    unit = "".join(unit.translate(_RAISED).split())
    return "gal" if _GALS.fullmatch(unit) else _ITALIAN_POWER.sub(lambda power: power[1] + "23"[power[2] == "c"], unit)


def header_unit(spelling: str, kind: str = "acceleration") -> str | None:
    """Return the unit of a kind that a header means, in any case: `m/s2` for `M/SEC**2`; None if it is none of it."""
    word = _plain(unicodedata.normalize("NFKD", spelling.lower()).translate(_PRINTED).replace("'s", ""))
    word = _PER_SECOND.sub("/s", _PER_SECOND_2.sub("/s2", word))
    word = _OF_G.get(word, word)
    return word if word in KINDS[kind] else None


def read(text: str, unit: str) -> float:
    """Read the number of a text with a unit.

    Parameters
    ----------
    text : str
        Text such as `800 mm`; its unit may be any of the same kind as `unit`.
    unit : str
        Unit of the returned number, such as `m`.

    Returns
    -------
    float
        Number nearest to the value of the text.

    Raises
    ------
    UnitError
        If the text is not a number with a unit, or the unit is unknown or of another kind.

    Examples
    --------
    >>> read("800 mm", "m")
    0.8
    >>> read("0.5 rad", "deg")
    28.64788975654116
    """
    quoted, parts = cut(printable(text.strip())), split(text)
    if parts is None:
        hint = "write a decimal point, and no separator between thousands" if _COMMA.match(text.strip()) else None
        raise UnitError(f"{quoted!r} is not a number with a unit", hint)
    (number, stated), kind, known = parts, kind_of(unit), units_of(unit)
    if not stated:
        raise UnitError(f"{quoted!r} is a text without a unit")
    if stated == "%" and not unit:
        return float(_EXACT.create_decimal(number).scaleb(-2, _EXACT))
    if not known:
        raise UnitError(f"{quoted!r} has a unit", "give a number without one")
    if stated == _plain(unit):
        return float(number)
    if kind == "acceleration" and kind_of(stated) is None:
        stated = header_unit(stated, kind) or stated
    if kind and stated in known:
        ratio = _EXACT.divide(_factor(kind, stated), _factor(kind, unit))
        return float(_EXACT.multiply(_EXACT.create_decimal(number), ratio))
    other = kind_of(stated)
    if other is None:
        raise UnitError(f"{cut(printable(stated))!r} is not a unit of {kind or unit}", _guess(stated, kind, known))
    if (mass := mass_of_weight(text, unit)) is not None:
        raise UnitError(
            f"{quoted} is a weight, not a {kind}", f"divided by {STANDARD_GRAVITY} m/s2 it is {mass:.6g} {unit}"
        )
    if (other, kind) in (("stiffness", "force"), ("stiffness", "mass")):
        raise UnitError(f"{quoted} is a load per metre, not a {kind}", "multiply it by the length that carries it")
    raise UnitError(f"{quoted} is {_a(other)}, not {_a(kind) if kind else f'in {unit}'}", f"units: {', '.join(known)}")


def mass_of_weight(text: str, unit: str) -> float | None:
    """Return the mass, in `unit`, whose weight under standard gravity a text is; None if the text is not a weight.

    Examples
    --------
    >>> round(mass_of_weight("19 kN/m3", "kg/m3"), 2), mass_of_weight("1800 kg/m3", "kg/m3")
    (1937.46, None)
    """
    parts, kind = split(text), kind_of(unit)
    if parts is None or kind not in WEIGHT_OF or kind_of(parts[1]) != WEIGHT_OF[kind]:
        return None
    weight = _EXACT.multiply(_EXACT.create_decimal(parts[0]), _factor(WEIGHT_OF[kind], parts[1]))
    return float(_EXACT.divide(_EXACT.divide(weight, STANDARD_GRAVITY), _factor(kind, unit)))


def number_of(value: object, unit: str) -> float:
    """Return a finite number that is given as such, in `unit`, or as a text with its unit or without.

    Fractions are in the unit `%`: 0.05, or 5 %. Raises `UnitError`.
    """
    if isinstance(value, bool) or not isinstance(value, str | int | float):
        raise UnitError(f"{value!r} is not a number")
    quoted = repr(cut(printable(value))) if isinstance(value, str) else value
    parts = split(value) if isinstance(value, str) else (value, "")
    if parts is None:
        raise UnitError(f"{quoted} is not a number{', with or without a unit' if unit else ''}")
    if parts[1].lower() not in ("", unit.lower()):
        # In g as the amplitude of a motion in m/s2 is, divided by the same number.
        return read(str(value), "m/s2") / UNITS["g"] if unit == "g" else read(str(value), unit)
    try:
        number = float(parts[0]) / (100 if parts[1] == "%" else 1)
    except OverflowError:  # an int may be larger than any float
        number = inf
    if not isfinite(number):
        raise UnitError(f"{cut(str(quoted))} is not a finite number")
    return number


def _guess(spelling: str, kind: str | None, known: tuple[str, ...]) -> str:
    """Return a hint on the unit that a misspelling means, of masses also on weights; else the known units."""
    kinds = [*WEIGHT_OF, *WEIGHT_OF.values()] if kind in WEIGHT_OF else []
    units = dict.fromkeys([*known, *(unit for each in kinds for unit in KINDS[each])])
    prefixed, word = _PREFIX.fullmatch(spelling), spelling.lower()
    if prefixed is None or prefixed[2] not in units:  # otherwise it is another multiple of a known unit, such as mN
        # One letter too many is a slip, while other similar units, such as kp and kip, are not alike in size.
        words = (word, word[:-1], word[1:]) if word.isalpha() else (word,)
        meant = next((unit for each in words for unit in units if unit.lower() == each), None)
        if meant is not None:
            return f"did you mean {meant}?"
    return f"known: {', '.join(known)}"


def _a(kind: str) -> str:
    return f"{'an' if kind[0] in 'aeiou' else 'a'} {kind}"


def _factor(kind: str, unit: str) -> Decimal:
    """Return the factor from a unit of a quantity to its SI unit."""
    above, _, below = KINDS[kind][unit].partition("/")
    return _EXACT.divide(Decimal(above), Decimal(below or "1"))
