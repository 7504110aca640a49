"""The motion of a floor of a building, by its first mode: u_z'' = u_g'' + psi gamma u_rel''."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import isclose, pi
from typing import Self

from rocking_cli.errors import InputError, Problem, named
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.processing.oscillator import DAMPING, check_oscillator, finer, relative_response
from rocking_cli.text import did_you_mean, exact
from rocking_cli.units import UnitError, number_of

FLOOR_EXAMPLE = "T1=0.4,xi=0.05,z=6m,H=9m,n=3"
UNITS = {"T1": "s", "xi": "%", "z": "m", "H": "m", "z/H": "", "gamma": "", "n": ""}
"""Items of a floor, with the unit of a plain number; those of z, H and n are the items of a site's floor."""
PERIOD_RANGE = 1e-6, 1e6  # s; no building has periods beyond, and numbers overflow
MAX_GAMMA = 100.0  # a uniform building has 1.5; a larger value is a typing error
MAX_STOREYS = 1000


@dataclass(frozen=True)
class Floor:
    """A floor of a building that responds in its first mode.

    Parameters
    ----------
    period : float
        T1, period of the mode [s].
    damping : float
        xi, damping ratio of the mode.
    height : float
        Ratio of the floor's height z to that of the building H, from 0 to 1; the mode shape is psi = z/H.
    participation : float
        gamma, participation factor of the mode; 3n/(2n + 1) for n equal storeys.
    """

    period: float
    damping: float
    height: float
    participation: float

    def __post_init__(self) -> None:
        check_oscillator(self.period, self.damping)
        if not 0 <= self.height <= 1:
            hint = "it is the height of the floor over that of the building"
            raise _refused(f"z/H must be from 0 to 1, got {self.height:g}", hint)
        if not PERIOD_RANGE[0] <= self.period <= PERIOD_RANGE[1]:
            raise _refused(f"T1 must be from {PERIOD_RANGE[0]:g} to {PERIOD_RANGE[1]:g} s, got {self.period:g} s")
        if not 0 < self.participation <= MAX_GAMMA:
            raise _refused(f"gamma must be a positive number, {MAX_GAMMA:g} at most, got {self.participation:g}")

    def __str__(self) -> str:
        items = {"T1": self.period, "xi": self.damping, "z/H": self.height}
        n = round(self.participation / (3 - 2 * self.participation)) if self.participation < 1.5 else 0
        if 1 <= n <= MAX_STOREYS and isclose(_of_storeys(n), self.participation, rel_tol=1e-12):
            items["n"] = float(n)  # n is exact, while gamma such as 9/7 has endless digits
        else:
            items["gamma"] = self.participation
        return ",".join(f"{key}={exact(value)}" for key, value in items.items())

    @classmethod
    def parse(cls, spec: str | Mapping[str, object]) -> Self:
        """Read a floor from `T1=0.4,xi=0.05,z=6m,H=9m,n=3`, or from a mapping.

        Instead of z and H [m] their ratio `z/H` may be given, and instead of n equal storeys `gamma`.

        Raises
        ------
        InputError
            If an item is missing, unknown, not a number or out of range.
        """
        pairs = dict(spec) if isinstance(spec, Mapping) else _pairs(str(spec))
        for key in pairs:
            if key not in UNITS:
                raise _refused(f"{key!r} is not one of {', '.join(UNITS)}", did_you_mean(str(key), list(UNITS)))
        _check_height(pairs)
        missing = [key for key, there in (("T1", "T1" in pairs), ("z with H", {"z", "z/H"} & set(pairs))) if not there]
        if ("gamma" in pairs) == ("n" in pairs):
            missing.append("gamma, or n for as many equal storeys (one of the two)")
        if missing:
            raise _refused(f"{' and '.join(missing)} must be given")
        values = {key: _value(key, value) for key, value in pairs.items()}
        if "n" in values:
            n = values["n"]
            if not (1 <= n <= MAX_STOREYS and n == round(n)):
                raise _refused(f"n is the number of storeys, got {n:g}")
            values["gamma"] = _of_storeys(n)
        if "H" in values:
            if not 0 <= values["z"] <= values["H"] or values["H"] == 0:
                raise _refused(f"z must be from 0 to H, got {values['z']:g} m of {values['H']:g} m")
            values["z/H"] = values["z"] / values["H"]
        return cls(values["T1"], values.get("xi", DAMPING), values["z/H"], values["gamma"])

    def of(self, ground: GroundMotion) -> GroundMotion:
        """Return the motion of the floor for a ground motion.

        Returns
        -------
        GroundMotion
            Motion of the floor, sampled finely enough for the mode. Its `ground` is the given motion, and its vertical
            component is that of the ground, as floors are assumed to be vertically rigid.
        """
        x, v, parts = relative_response(ground, self.period, self.damping)
        w = 2 * pi / self.period
        below = finer(ground.acceleration, parts)
        relative = -below - 2 * self.damping * w * v - w * w * x
        return replace(
            ground,
            dt=ground.dt / parts,
            acceleration=below + self.height * self.participation * relative,
            points=None,
            every=ground.every * parts,
            processing=(*ground.processing, f"floor {self}"),
            ground=ground,
        )


def _of_storeys(n: float) -> float:
    """Return the participation factor of n equal storeys."""
    return 3 * n / (2 * n + 1)


def _check_height(pairs: Mapping[str, object]) -> None:
    """Refuse a floor height without that of the building (it may be meant as their ratio), and heights with a ratio."""
    hint = "give heights in metres, such as z=6m,H=9m, or their ratio, such as z/H=0.67"
    if "z" in pairs and not {"H", "z/H"} & set(pairs):
        z = pairs["z"]
        raise _refused(f"z={z} has two meanings: the height of the floor needs that of the building, H", hint)
    if "z/H" in pairs and {"z", "H"} & set(pairs):
        raise _refused("z/H cannot be combined with z or H", hint)


def _pairs(text: str) -> dict[str, object]:
    pairs: dict[str, object] = {}
    for part in text.split(","):
        key, equals, value = (each.strip() for each in part.partition("="))
        if not equals or not value:
            raise _refused(f"{part.strip()!r} is not of the form T1=0.4")
        if key in pairs:
            raise _refused(f"{key} is given twice")
        pairs[key] = value
    return pairs


def _value(key: str, value: object) -> float:
    try:
        return number_of(value, UNITS[key])
    except UnitError as error:
        raise _refused(f"{key}: {error.message}", error.hint) from None


def _refused(message: str, hint: str | None = None) -> InputError:
    return InputError(Problem(message, field=named("floor"), hint=hint or f"such as {FLOOR_EXAMPLE}"))
