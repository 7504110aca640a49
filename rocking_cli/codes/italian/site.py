"""The site file of the Italian code: ground motion, floor of the structure, and confidence factor."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from math import sqrt
from typing import Annotated, Any, Literal

from pydantic import Field

from rocking_cli.codes.italian.rules import FIRST_STATE, FURTHER_STATES
from rocking_cli.core import Mechanism
from rocking_cli.core.fields import quantity
from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.io.yaml_file import Place
from rocking_cli.processing.floor import Floor
from rocking_cli.studies.file_part import Part, Sound
from rocking_cli.verification.code import Site

GROUND_PARAMETERS = ("ag", "F0", "TC", "S")
MAX_TABLE_ROWS = 10_000
MIN_PERIOD = 0.001  # s
Period = Annotated[float, Field(gt=0, le=100)]
Ordinate = Annotated[list[Annotated[float, Field(ge=0, le=1000)]], Field(min_length=2, max_length=2)]
Row = Annotated[list[Annotated[float, Field(gt=0, le=1e6)]], Field(min_length=4, max_length=4)]


def _ordinates(**more: Any) -> Any:
    return quantity(
        "elastic spectrum at 5 % damping: [period in s, acceleration in g], starting at T = 0, linearly interpolated",
        default=None, min_length=2, max_length=MAX_TABLE_ROWS, **more,
    )  # fmt: skip


class StateGround(Part):
    """The ground of one limit state: by its parameters, or as ordinates of a spectrum."""

    ag: float | None = quantity("ground acceleration on rock", unit="g", symbol="a_g", default=None, gt=0, le=10)
    F0: float | None = quantity("maximum spectral amplification", default=None, ge=1, le=10)
    TC: float | None = quantity("end of its level part", unit="s", symbol="T_C", default=None, ge=MIN_PERIOD, le=10)
    S: float | None = quantity("factor of soil and topography", default=None, ge=0.5, le=5)
    spectrum: list[Ordinate] | None = _ordinates()

    @classmethod
    def between(cls, given: dict[str, Any], sound: Sound) -> Iterator[tuple[Place, str]]:
        """Check that the ground is given in one way, completely, and that a spectrum has one ordinate per period."""
        there = [name for name in GROUND_PARAMETERS if given.get(name) is not None]
        if given.get("spectrum") is not None and there:
            yield ("spectrum",), f"cannot be combined with {there[0]}: give either the parameters or the ordinates"
        elif given.get("spectrum") is None and cls._needs_sizes(given):
            for name in GROUND_PARAMETERS:
                if name not in there:
                    yield (name,), f"is missing: {cls.model_fields[name].description}"
        known = all(given.get(name) is not None and sound(name) for name in ("ag", "TC"))
        if known and given["TC"] > (TD := 4.0 * given["ag"] + 1.6):
            yield ("TC",), f"is above T_D = 4 a_g/g + 1.6 = {TD:.4g} s: got {given['TC']:g} s"
        yield from _no_function(given, sound)

    @classmethod
    def _needs_sizes(cls, given: dict[str, Any]) -> bool:
        """Return whether the parameters are required if there is no spectrum."""
        return True


def _no_function(given: dict[str, Any], sound: Sound) -> Iterator[tuple[Place, str]]:
    points: Any = given.get("spectrum")
    if not points or not sound("spectrum"):
        return
    if points[0][0] != 0:
        yield (
            ("spectrum", 0),
            f"starts at {points[0][0]:g} s: the first ordinate must be at T = 0, the peak ground acceleration",
        )
    for k, (T, acceleration) in enumerate(points):
        if acceleration <= 0:
            yield ("spectrum", k), f"has no positive acceleration at {T:g} s: every ordinate must be more than 0"
            return
    for k, ((before, _), (after, _)) in enumerate(pairwise(points), 1):
        if after == before:
            yield ("spectrum", k), f"has two ordinates at {after:g} s: give one ordinate per period"
            return
        if after < before:
            yield ("spectrum", k), f"steps back from {before:g} s to {after:g} s: periods must increase"
            return


class Mode(Part):
    """The first mode of a building at a limit state."""

    T1: Period = quantity("first period of the building", unit="s")
    xi1: float = quantity("damping ratio of the building: 0.05 for 5 %", gt=0, le=0.5)


class SiteFloor(Mode):
    """The floor of a building on which the structure stands; its own T1 and xi1 are those of SLV."""

    z: float = quantity("height of the floor above the foundation", unit="m", gt=0, le=1000)
    H: float = quantity("height of the building", unit="m", gt=0, le=1000)
    n: int = quantity("number of storeys", ge=1, le=200)
    SLD: Mode | None = Field(None, description="first period and damping ratio of the building at damage")
    SLC: Mode | None = Field(None, description="first period and damping ratio of the building at collapse")

    def mode(self, state: str) -> Mode:
        """Return the first mode at a limit state: that of SLV if no other is given."""
        return self if state == FIRST_STATE else getattr(self, state) or self

    @classmethod
    def between(cls, given: dict[str, Any], sound: Sound) -> Iterator[tuple[Place, str]]:
        """Check that the floor is not above the roof."""
        z, H = given.get("z"), given.get("H")
        if z is not None and H is not None and sound("z") and sound("H") and z > H:
            yield ("z",), f"is above the roof: got {z:g} m, but the building is {H:g} m high"


KAPPA = {"cantilever": 6.2, "spanning": 2.2}


class VibratingElement(Part):
    """An element that is free to vibrate before it rocks, of which the code estimates the period [C8.7.1.7]."""

    kind: Literal["cantilever", "spanning"] = Field(description="whether it is held at its foot or at both ends")
    L: float | None = quantity(
        "its length; if omitted, the height of the structure", unit="m", default=None, gt=0, le=1000
    )
    t: float | None = quantity(
        "its thickness; if omitted, the thickness or width of the structure", unit="m", default=None, gt=0, le=1000
    )
    w: float = quantity("its weight for a volume", unit="N/m3", gt=0, le=1e6)
    E: float = quantity("its modulus of elasticity", unit="Pa", gt=0, le=1e12)

    @property
    def kappa(self) -> float:
        """Factor of the support condition."""
        return KAPPA[self.kind]

    @property
    def size(self) -> tuple[float, float]:
        """L and t [m]; both must be known."""
        assert self.L is not None and self.t is not None
        return self.L, self.t

    @property
    def period(self) -> float:
        """T0 [s]; the size must be known."""
        L, t = self.size
        return self.kappa * (L / t) * L * sqrt(self.w / (self.E * STANDARD_GRAVITY))

    def sized(self, mechanism: Mechanism) -> VibratingElement:
        """Return the element with missing dimensions taken from a structure. Raises `InputError` if it has none."""
        sizes = {
            "L": (self.L, getattr(mechanism, "height", None)),
            "t": (self.t, getattr(mechanism, "thickness", getattr(mechanism, "width", None))),
        }
        completed = {key: stated if stated is not None else taken for key, (stated, taken) in sizes.items()}
        for key, value in completed.items():
            if not isinstance(value, float):
                what = f"is missing: a {mechanism.mechanism} has no height and thickness from which to take it"
                raise InputError(Problem(what, field=f"element.{key}"))
        return self.model_copy(update=completed)


class ItalianSite(StateGround, Site):
    """What a site file holds: the ground of one limit state (SLV), and of others; or the hazard of all of them."""

    FC: float = quantity("confidence factor, by which accelerations are divided", ge=1, le=2)
    q: float = quantity("behaviour factor of the linear method", default=2.0, ge=1, le=10)
    SLC: StateGround | None = Field(None, description="the ground at collapse")
    SLD: StateGround | None = Field(None, description="the ground at damage")
    soil: Literal["A", "B", "C", "D", "E"] | None = Field(None, description="category of the soil")
    topography: Literal["T1", "T2", "T3", "T4"] = Field("T1", description="category of the topography")
    hazard: Annotated[list[Row], Field(min_length=2, max_length=MAX_TABLE_ROWS)] | None = Field(
        None, description="rows of [return period in years, ag in g, F0, TC* in s], with VN, CU and soil"
    )
    VN: float | None = quantity("nominal life", unit="years", default=None, gt=0, le=1000)
    CU: float | None = quantity("coefficient of use", default=None, gt=0, le=10)
    floor: SiteFloor | None = Field(None, description="the floor on which the structure stands; if omitted, the ground")
    T0: Period | None = quantity(
        "period of an element that vibrates freely before it rocks, such as a parapet", unit="s", default=None
    )

    element: VibratingElement | None = Field(None, description="instead of T0: the element, from which T0 follows")

    @property
    def own_period(self) -> float | None:
        """T0 [s], as given or from the element; None without both."""
        return self.T0 if self.element is None else self.element.period

    def shaking(self, state: str) -> StateGround | None:
        """Return the ground at a limit state; the fields of the site itself are those of SLV."""
        ground: StateGround | None = self if state == FIRST_STATE else getattr(self, state)
        return ground

    @classmethod
    def between(cls, given: dict[str, Any], sound: Sound) -> Iterator[tuple[Place, str]]:
        """Check that the ground is given in one way, and that a hazard has the fields it needs."""
        yield from super().between(given, sound)
        if given.get("element") is not None and given.get("T0") is not None:
            yield ("element",), "cannot be combined with T0, which is computed from it: give one of the two"
        if given.get("hazard") is None:
            for name in ("VN", "CU"):
                if given.get(name) is not None:
                    yield (name,), "requires `hazard`, the table of return periods"
            return
        for name in (*GROUND_PARAMETERS, "spectrum", *FURTHER_STATES):
            if given.get(name) is not None:
                yield (name,), "cannot be combined with hazard, from which it is computed: give one of the two"
        for name in ("VN", "CU", "soil"):
            if given.get(name) is None:
                yield (name,), f"is missing: a hazard needs the {cls.model_fields[name].description}"
        if sound("hazard"):
            for k, row in enumerate(given["hazard"]):
                if row[-1] < MIN_PERIOD:
                    yield ("hazard", k), f"has T_C* = {row[-1]:g} s: a period must be at least {MIN_PERIOD:g} s"
            for k, (before, after) in enumerate(pairwise(given["hazard"]), 1):
                if after[0] <= before[0]:
                    yield ("hazard", k), f"return periods must increase, got {after[0]:g} after {before[0]:g} years"

    @classmethod
    def _needs_sizes(cls, given: dict[str, Any]) -> bool:
        return given.get("hazard") is None


def floor_at(site: ItalianSite, state: str) -> Floor | None:
    """Return the floor on which the structure stands, with its mode at a limit state; None on the ground."""
    floor = site.floor
    if floor is None:
        return None
    mode = floor.mode(state)
    return Floor(mode.T1, mode.xi1, floor.z / floor.H, 3 * floor.n / (2 * floor.n + 1))


def of_structure(site: ItalianSite, mechanism: Mechanism) -> ItalianSite:
    """Return the site with the dimensions of its element, from the structure if needed. Raises `InputError`."""
    return site if site.element is None else site.model_copy(update={"element": site.element.sized(mechanism)})


def of_each(site: ItalianSite) -> ItalianSite:
    """Return the site of many structures, in which the element takes its dimensions from each structure."""
    if site.element is None:
        return site
    return site.model_copy(update={"element": site.element.model_copy(update={"L": None, "t": None})})
