"""Numbers that look like mistakes, of structures and of sites, by `data/plausible.toml`."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from importlib.resources import files
from math import isclose, nan
from typing import Any, NamedTuple

import numpy as np

from rocking_cli.core.fields import Described, units_of_field
from rocking_cli.core.mechanism import Mechanism
from rocking_cli.units import mass_of_weight, read

BETWEEN_FLOORS = ("wall", "spanning_wall")


class UsualRange(NamedTuple):
    """Numbers that are usual of masonry and possible of any structure, in a unit or over a measure of the structure."""

    unit: str
    least: float
    most: float
    least_possible: float
    most_possible: float
    over: str = ""


class OddNumber(NamedTuple):
    """A number that looks like a mistake: its name, why as a predicate, and whether it is not possible."""

    name: str
    words: str
    impossible: bool = False


@cache
def _table() -> Mapping[str, Any]:
    return tomllib.loads((files("rocking_cli") / "data" / "plausible.toml").read_text(encoding="utf-8"))


@cache
def _roles(key: str, unit: str) -> list[UsualRange]:
    """Return the roles of a field of a unit."""
    rows = _table()["roles"]
    named = [UsualRange(*row) for row in rows.get(key) or rows.get(f"*.{key.rpartition('.')[2]}", ())]
    return named if named and named[0].unit == unit else [UsualRange(*row) for row in rows.get(f"[{unit}]", ())]


def doubts(mechanism: Mechanism) -> list[str]:
    """Return what is not possible about the numbers of any structure and the places of its loads, as sentences."""
    odd = _odd(mechanism, mechanism, masonry=False)
    return [f"{each.name} {each.words}" for each in odd if each.name not in (mechanism.unusual or ())]


def questions(mechanism: Mechanism, site: Any) -> list[OddNumber]:
    """Return what is unusual or not possible of a structure of masonry and of its site, unless one says it is meant."""
    odd = [*_odd(mechanism, mechanism), *_odd(site, mechanism)]
    if mechanism.mechanism in BETWEEN_FLOORS and getattr(site, "floor", 0) is None:
        words = "is missing, but the wall spans between floors: above the ground, their motion is what shakes it"
        odd.append(OddNumber("floor", words))
    meant = {*(mechanism.unusual or ()), *(site.unusual or ())}
    return [each for each in odd if each.name not in meant]


def _odd(part: Any, mechanism: Mechanism, *, masonry: bool = True) -> Iterator[OddNumber]:
    """Yield the numbers of a structure or its site that look like mistakes."""
    measures = _measures(mechanism)
    for name, key, value, unit in _numbers(part):
        if why := _why(value, _roles(key, unit), measures, masonry):
            yield OddNumber(name, *why)
    for load in (part.loads or ()) if part is mechanism else ():
        at = complex(*load.at)
        body = mechanism.carrier.carrying(load.body, at, ())
        (role,) = _roles("loads.at" if load.floor is None and load.seat is None else "bearing.at", "")
        if (off := mechanism.carrier.off(body, at)) > (role.most if masonry else role.most_possible):
            where = f"is [{at.real:g}, {at.imag:g}] m, {off:.2g} times the size of {body} away from it"
            words = f"{where}: are its coordinates those of `rocking draw`?"
            yield OddNumber(f"loads.{load.name}.at", words, off > role.most_possible)
        if masonry and (up := (load.force or load.force_per_metre or (0, 0))[1]) > 0:
            yield OddNumber(f"loads.{load.name}.force", f"has {up:g} upwards: a weight has a negative second number")


def _numbers(part: Described, name: str = "", within: str = "") -> Iterator[tuple[str, str, float, str]]:
    """Yield the numbers that a part gives: name, role, size and unit; of a column of a table the largest."""
    for key, info in type(part).model_fields.items():
        value, units = getattr(part, key) if key in part.model_fields_set else None, units_of_field(info)
        named = f"{name}{info.alias or key}"
        parts = enumerate(value) if isinstance(value, list) else value.items() if isinstance(value, dict) else ()
        for k, each in [(None, value), *parts]:
            if isinstance(each, Described):
                entry = "" if k is None else f"{getattr(each, 'name', None) or k}."
                yield from _numbers(each, f"{named}.{entry}", f"{key}.")
        if isinstance(value, float) and units is not None:
            yield named, f"{within}{key}", abs(value), units
        elif key == "force" and value:
            yield named, f"{within}{key}", abs(complex(*value)), units
        elif units == "m" and isinstance(value, list) and isinstance(value[0], list):
            yield named, f"{within}{key}", float(np.ptp(value, axis=0).max()), units
        elif isinstance(units, list) and value:
            for unit, column in zip(units, zip(*value, strict=True), strict=True):
                yield named, f"{key}.{unit}", max(column), unit


def _measures(mechanism: Mechanism) -> Mapping[str, float]:
    """Return the measures of a structure with which its numbers are compared."""
    measures = {"": 1.0, "length": mechanism.depth or nan}
    try:
        corners = np.array([z for outlines in mechanism.carrier.outlines.values() for line in outlines for z in line])
        mass = sum(body.mass for body in mechanism.weighed()) if mechanism.has_mass else nan
    except Exception:  # a plugin may fail in any way; its next use reports it
        return measures
    if corners.size:
        measures |= {"thickness": float(np.ptp(corners.real)), "height": float(np.ptp(corners.imag))}
    return {**measures, "mass": mass, "weight": mass * mechanism.gravity}


def _why(
    value: float, roles: Sequence[UsualRange], measures: Mapping[str, float], masonry: bool
) -> tuple[str, bool] | None:
    """Return why a number is unusual, in words, and whether it is not possible; None if it is usual."""
    for impossible in (True, False)[: 1 + masonry]:
        for role in roles:
            of, unit = measures.get(role.over, nan), f" {role.unit}".rstrip()
            low, high = (role.least_possible, role.most_possible) if impossible else (role.least, role.most)
            if not (value < low * of or value > high * of):
                continue
            meant = " or ".join(_meant(value, roles, measures))
            hints = [f"did you mean {meant}"] * bool(meant)
            if not masonry:
                hints = hints or ["are the units right"] * (not role.over)
                return (f"is {value:.6g}{unit}: {hints[0]}?", True) if hints else None
            if role.over in ("height", "length") and roles[-1].least <= of <= roles[-1].most:
                hints.append("are the two exchanged")
            bound, side = (role.least, "less") if value < low * of else (role.most, "more")
            times = f"{bound:g} times ".removeprefix("1 times ")
            limit = f"{times}the {role.over} of {of:.6g}" if role.over else f"{bound:g}"
            unusual = f"is {value:.6g}{unit}, {side} than {limit}{unit}, which is unusual of masonry"
            return unusual + (f": {', or '.join(hints)}?" if hints else ""), impossible
    return None


def _meant(value: float, roles: Sequence[UsualRange], measures: Mapping[str, float]) -> Iterator[str]:
    """Yield the number in units in which it would be usual: those it was taken from, or that of the field."""
    ranges = [(role.over, role.least * of, role.most * of) for role in roles for of in [measures.get(role.over, nan)]]
    # A length that fits another one may be wrong by the same unit.
    binding = [(low, high) for over, low, high in ranges if not over or not low <= value <= high]
    for likely in _table()["likely"].get(unit := roles[0].unit, ()):
        size = mass_of_weight(f"1 {likely}", unit) or read(f"1 {likely}", unit)
        if not any(value * size < low or value * size > high for low, high in binding):
            yield f"{value:g} {likely}"
        elif isclose(given := value / size, float(f"{given:.4g}"), rel_tol=1e-9) and not any(
            given < low or given > high for low, high in binding
        ):
            yield f"{given:g} {unit}"
