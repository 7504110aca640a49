"""The site file of the Italian code: ground motion, floor of the structure, and confidence factor."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import pairwise
from math import sqrt
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal

from pydantic import BeforeValidator, Field, PrivateAttr

from rocking_cli.codes.italian.grid import Cell, read_grid
from rocking_cli.codes.italian.rules import FIRST_STATE, OF_STATE, STATES_OF_SITE
from rocking_cli.core import Mechanism
from rocking_cli.core.fields import Name, quantity
from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.io.yaml_file import Place
from rocking_cli.processing.oscillator import Floor
from rocking_cli.studies.file_part import Part, Sound
from rocking_cli.text import cut
from rocking_cli.verification.code import Site

GROUND_PARAMETERS = ("ag", "F0", "TC", "S")
ROCK_PARAMETERS = ("ag", "F0", "TC_star")
COORDINATES = ("longitude", "latitude", "grid")
INSTEAD_OF_GRID = "`hazard`, rows of return periods, or `ag, F0, TC_star`"
MAX_TABLE_ROWS = 10_000
MIN_PERIOD = 0.001  # s
MIN_REFERENCE_LIFE = 35.0  # years
COEFFICIENTS_OF_USE = {"I": 0.7, "II": 1.0, "III": 1.5, "IV": 2.0}
CONFIDENCE_FACTORS = {"LC1": 1.35, "LC2": 1.20, "LC3": 1.00}
LARGEST_FC = CONFIDENCE_FACTORS["LC1"]
Period = Annotated[float, Field(gt=0, le=100)]
Ordinate = Annotated[list[Annotated[float, Field(ge=0, le=1000)]], Field(min_length=2, max_length=2)]
Row = Annotated[list[Annotated[float, Field(gt=0, le=1e6)]], Field(min_length=4, max_length=4)]


def _confidence_factor(given: Any) -> Any:
    """Return the confidence factor of a knowledge level that is given by its name; any other value unchanged."""
    if isinstance(given, str) and given not in CONFIDENCE_FACTORS:
        raise ValueError(f"must be a number, or a knowledge level, LC1, LC2 or LC3: got {cut(repr(given))}")
    return CONFIDENCE_FACTORS.get(given, given) if isinstance(given, str) else given


def _ordinates(**more: Any) -> Any:
    return quantity(
        "elastic spectrum at 5 % damping: [period in s, acceleration in g], starting at T = 0, linearly interpolated",
        columns=("s", "g"), default=None, min_length=2, max_length=MAX_TABLE_ROWS, **more,
    )  # fmt: skip


class StateGround(Part):
    """The ground of one limit state: by its parameters, by those on rock, or as ordinates of a spectrum."""

    meanings: ClassVar[Mapping[str, str]] = {"fo": "F0"}

    ag: float | None = quantity("ground acceleration on rock", unit="g", symbol="a_g", default=None, gt=0, le=10)
    F0: float | None = quantity("maximum spectral amplification", default=None, ge=1, le=10)
    TC: float | None = quantity("end of its level part", unit="s", symbol="T_C", default=None, ge=MIN_PERIOD, le=10)
    S: float | None = quantity("factor of soil and topography", default=None, ge=0.5, le=5)
    TC_star: float | None = quantity(
        "end of its level part on rock, instead of TC and S, which follow with soil and topography",
        unit="s", symbol="T_C*", default=None, ge=MIN_PERIOD, le=10,
    )  # fmt: skip
    spectrum: list[Ordinate] | None = _ordinates()

    @classmethod
    def between(cls, given: dict[str, Any], sound: Sound) -> Iterator[tuple[Place, str]]:
        """Check that the ground is given in one way, completely, and that a spectrum has one ordinate per period."""
        there = [name for name in (*GROUND_PARAMETERS, "TC_star") if given.get(name) is not None]
        if given.get("spectrum") is not None and there:
            yield ("spectrum",), f"cannot be combined with {there[0]}: give either the parameters or the ordinates"
        elif given.get("spectrum") is None and cls._needs_sizes(given):
            for name in ROCK_PARAMETERS if "TC_star" in there else GROUND_PARAMETERS:
                if name not in there:
                    otherwise = "; or give TC_star and soil" if name == "TC" and "S" not in there else ""
                    yield (name,), f"is missing: {cls.model_fields[name].description}{otherwise}"
        for name in ("TC", "S"):
            if "TC_star" in there and name in there:
                yield (name,), "cannot be combined with TC_star, from which it follows with the soil: give one of them"
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
    xi1: float = quantity("damping ratio of the building: 0.05, or 5 %", gt=0, le=0.5)


class SiteFloor(Mode):
    """The floor of a building on which the structure stands; its own T1 and xi1 are those of SLV."""

    z: float = quantity("height of the floor above the foundation", unit="m", gt=0, le=1000)
    H: float = quantity("height of the building", unit="m", gt=0, le=1000)
    n: int = quantity("number of storeys", ge=1, le=200)
    SLD: Mode | None = Field(None, description="first period and damping ratio of the building at damage")
    SLC: Mode | None = Field(None, description="first period and damping ratio of the building at collapse")

    def mode(self, state: str) -> Mode:
        """Return the first mode at a limit state: at SLO that of SLD; that of SLV if no other is given."""
        state = "SLD" if state == "SLO" else state
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
        completed = {key: self._first(stated, taken) for key, (stated, taken) in sizes.items()}
        for key, value in completed.items():
            if not isinstance(value, float):
                what = f"is missing: a {mechanism.mechanism} has no height and thickness from which to take it"
                raise InputError(Problem(what, field=f"element.{key}"))
        return self.model_copy(update=completed)

    @staticmethod
    def _first(stated: float | None, taken: float | None) -> float | None:
        """Return a dimension: as stated, or else that of the structure."""
        return stated if stated is not None else taken


class ElementOfEach(VibratingElement):
    """The element of many structures: each has its own dimensions, and those stated hold where it has none."""

    @staticmethod
    def _first(stated: float | None, taken: float | None) -> float | None:
        return taken if isinstance(taken, float) else stated


class ItalianSite(StateGround, Site):
    """Content of a site file: the ground at each limit state (SLV if none is named), or the hazard of all of them."""

    meanings: ClassVar[Mapping[str, str]] = {
        **StateGround.meanings,
        **dict.fromkeys(("suolo", "sottosuolo", "categoria_suolo", "categoria_sottosuolo"), "soil"),
        **dict.fromkeys(("topografia", "categoria_topografica"), "topography"),
        **dict.fromkeys(("classe", "classe_uso", "classe_d_uso"), "class"),
        **dict.fromkeys(("lc", "livello_conoscenza", "livello_di_conoscenza"), "FC: LC1, FC: LC2 or FC: LC3"),
        "vita_nominale": "VN", "stati_limite": "states", "scuola": "school", "bene_culturale": "heritage",
        "intervento": "intervention: local (intervento locale), improvement (miglioramento) or upgrading (adeguamento)",
        "lon": "longitude", "longitudine": "longitude", "lat": "latitude", "latitudine": "latitude",
    }  # fmt: skip

    FC: Annotated[float, BeforeValidator(_confidence_factor)] = quantity(
        "confidence factor, by which accelerations are divided, or the knowledge level LC1, LC2 or LC3", ge=1, le=2
    )
    FC_without_strength: bool = Field(
        False, description="whether FC is used as given, although no compressive strength is taken into account"
    )
    q: float = quantity("behaviour factor of the linear method", default=2.0, ge=1, le=10)
    SLC: StateGround | None = Field(None, description="the ground at collapse")
    SLV: StateGround | None = Field(None, description="the ground of SLV, if it is not given without a limit state")
    SLD: StateGround | None = Field(None, description="the ground at damage")
    SLO: StateGround | None = Field(None, description="the ground of SLO, which is shown and not verified")
    states: Annotated[list[Literal["SLD", "SLV", "SLC"]], Field(min_length=1, max_length=3)] | None = Field(
        None, description="limit states to verify, SLV or SLC among them; if omitted, SLV, and SLD for class IV"
    )
    intervention: Literal["local", "improvement", "upgrading"] | None = Field(
        None, description="intervention of which the structure is the result; if omitted, zeta_E is compared with 1"
    )
    case: Literal["a", "b", "c", "d", "e"] | None = Field(None, description="case of an upgrading (§8.4.3), a to e")
    school: bool = Field(False, description="whether an improvement is of a school of class III")
    heritage: bool = Field(False, description="whether an improvement is of protected cultural heritage")
    soil: Literal["A", "B", "C", "D", "E"] | None = Field(None, description="category of the soil")
    topography: Literal["T1", "T2", "T3", "T4"] = Field("T1", description="category of the topography")
    hazard: Annotated[list[Row], Field(min_length=2, max_length=MAX_TABLE_ROWS)] | None = quantity(
        "rows of [return period in years, ag in g, F0, TC* in s], with VN, CU or class, and soil",
        columns=("years", "g", "", "s"), default=None,
    )  # fmt: skip
    longitude: float | None = quantity("longitude of the site", unit="deg", default=None, ge=-180, le=180)
    latitude: float | None = quantity("latitude of the site", unit="deg", default=None, ge=-90, le=90)
    grid: str | None = Field(
        None, description="file of the reference grid, relative to the site file, from which the hazard follows"
    )
    VN: float | None = quantity("nominal life", unit="years", default=None, gt=0, le=1000)
    CU: float | None = quantity("coefficient of use", default=None, gt=0, le=10)
    class_: Literal["I", "II", "III", "IV"] | None = Field(None, alias="class", description="class of use, for CU")
    floor: SiteFloor | None = Field(None, description="the floor on which the structure stands; if omitted, the ground")
    T0: Period | None = quantity(
        "period of an element that vibrates freely before it rocks, such as a parapet", unit="s", default=None
    )

    element: VibratingElement | None = Field(None, description="instead of T0: the element, from which T0 follows")
    unusual: list[Name] | None = Field(None, description="fields whose unusual values are meant")
    _cell: Cell | None = PrivateAttr(None)

    @property
    def cell(self) -> Cell | None:
        """Nodes of the reference grid from which the hazard follows; None if it is given otherwise."""
        return self._cell

    def located(self, folder: Path) -> ItalianSite:
        """Return the site with the hazard at its coordinates; a relative grid file is in `folder`.

        Raises `InputError` if the grid cannot be used, or does not cover the site.
        """
        if self.grid is None or self.longitude is None or self.latitude is None:
            return self
        path = folder / self.grid
        if not path.is_file():
            hint = f"give its path from the folder of the site file, or instead {INSTEAD_OF_GRID}"
            raise InputError(Problem(f"names no file: {path}", field="grid", hint=hint))
        cell = read_grid(path).cell(self.longitude, self.latitude)
        located = self.model_copy(update={"hazard": cell.rows})
        located._cell, located._named = cell, {"grid": path}
        return located

    @property
    def own_period(self) -> float | None:
        """T0 [s], as given or from the element; None without both."""
        return self.T0 if self.element is None else self.element.period

    @property
    def use(self) -> float | None:
        """Coefficient of use, as given or of the class of use; None without both."""
        return self.CU if self.class_ is None else COEFFICIENTS_OF_USE[self.class_]

    @property
    def life(self) -> float | None:
        """Reference life V_R [years]; None if the site file does not give it."""
        return None if self.VN is None or self.use is None else max(self.VN * self.use, MIN_REFERENCE_LIFE)

    @property
    def class_of_use(self) -> str | None:
        """Class of use, as given or of the coefficient of use; None without both."""
        return self.class_ or {CU: use for use, CU in COEFFICIENTS_OF_USE.items()}.get(self.CU or 0.0)

    @property
    def asked(self) -> Sequence[str]:
        """Limit states that are required, those of displacement first [§8.3]."""
        chosen: Sequence[str] = self.states or ([FIRST_STATE, "SLD"] if self.class_of_use == "IV" else [FIRST_STATE])
        return [state for state in (*OF_STATE, "SLD") if state in chosen]

    @property
    def rule(self) -> str:
        """Key of the threshold on zeta_E among `THRESHOLDS`."""
        if self.intervention != "improvement":
            return f"upgrading_{self.case}" if self.intervention == "upgrading" else self.intervention or ""
        use = f"_{self.class_of_use}" if self.class_of_use in ("I", "IV") else "_school" if self.school else ""
        return f"improvement{'_heritage' if self.heritage else use}"

    def shaking(self, state: str) -> StateGround | None:
        """Return the ground at a limit state; the fields of the site itself are those of SLV."""
        ground: StateGround | None = getattr(self, state)
        is_own = ground is None and state == FIRST_STATE and (self.ag is not None or self.spectrum is not None)
        return self if is_own else ground

    @classmethod
    def between(cls, given: dict[str, Any], sound: Sound) -> Iterator[tuple[Place, str]]:
        """Check that the ground is given in one way, and that this way has the fields it needs."""
        yield from super().between(given, sound)

        def there(*names: str) -> list[str]:
            return [name for name in names if given.get(name) is not None]

        if there("states") and sound("states") and not {*OF_STATE} & {*given["states"]}:
            yield ("states",), f"must include {' or '.join(OF_STATE)}, by which local mechanisms are verified"
        for name, kind in (("case", "upgrading"), ("school", "improvement"), ("heritage", "improvement")):
            if given.get(name) and given.get("intervention") != kind:
                yield (name,), f"requires `intervention: {kind}`"
        if given.get("intervention") == "upgrading" and not there("case"):
            yield ("case",), "is missing: an upgrading has the case that requires it, a to e of NTC 2018, §8.4.3"
        if given.get("intervention") == "improvement" and not (there("class", "CU") or given.get("heritage")):
            yield ("class",), "is missing: what an improvement must reach depends on the class of use"
        if there("element") and there("T0"):
            yield ("element",), "cannot be combined with T0, which is computed from it: give one of the two"
        if there("CU") and there("class"):
            yield ("CU",), "cannot be combined with class, from which it follows: give one of the two"
        if there("SLV") and (alone := there(*GROUND_PARAMETERS, "TC_star", "spectrum")):
            yield ("SLV",), f"cannot be combined with {alone[0]}, which without a limit state is that of SLV: give one"
        on_rock = cls._on_rock(given)
        source = "hazard" if there("hazard") else "grid" if there(*COORDINATES) else "TC_star" if on_rock else ""
        if source in ("hazard", "grid"):
            yield from cls._tabled(there, source)
        for name in there("VN", "CU") if not source else ():
            yield (name,), "requires `hazard`, the table of return periods, or TC_star"
        if there("topography") and not source:
            yield ("topography",), "requires `hazard` or TC_star: S, as given, includes it"
        what = "S and T_C need" if source == "TC_star" else "a hazard needs"
        if source and not there("soil"):
            yield ("soil",), f"is missing: {what} the category of the soil, A to E"
        if source in ("hazard", "grid") or (source and there("VN", "CU")):
            for name, needed in (("VN", "nominal life"), ("CU", "coefficient of use, or `class`, the class of use")):
                if not there(name) and not (name == "CU" and there("class")):
                    yield (name,), f"is missing: return periods need the {needed}"
        yield from _rows_that_do_not_grow(given, on_rock, sound)

    @classmethod
    def _tabled(cls, there: Callable[..., list[str]], source: str) -> Iterator[tuple[Place, str]]:
        """Yield given fields that exclude a table of return periods, and missing coordinates of a site on the grid."""
        others = [*GROUND_PARAMETERS, "TC_star", "spectrum", *STATES_OF_SITE, *COORDINATES * (source == "hazard")]
        for name in there(*others):
            yield (name,), f"cannot be combined with {source}, from which the ground is computed: give one of the two"
        for name in COORDINATES if source == "grid" else ():
            if not there(name):
                yield (name,), f"is missing: give {', '.join(COORDINATES)}; or instead {INSTEAD_OF_GRID}"

    @classmethod
    def _on_rock(cls, given: dict[str, Any]) -> dict[str, dict[str, Any]]:
        """Return the grounds that are given on rock, by limit state; that of SLV may be that of the site itself."""
        grounds = {FIRST_STATE: given, **{state: given[state] for state in STATES_OF_SITE if given.get(state)}}
        parts = {state: ground for state, ground in grounds.items() if isinstance(ground, dict)}
        return {state: parts[state] for state in STATES_OF_SITE if parts.get(state, {}).get("TC_star") is not None}

    @classmethod
    def _needs_sizes(cls, given: dict[str, Any]) -> bool:
        needed = FIRST_STATE if FIRST_STATE in str(given.get("states") or FIRST_STATE) else "SLC"
        return all(given.get(name) is None for name in ("hazard", *COORDINATES, needed))


def _rows_that_do_not_grow(
    given: dict[str, Any], on_rock: dict[str, dict[str, Any]], sound: Sound
) -> Iterator[tuple[Place, str]]:
    """Yield the rows of a hazard, and the limit states on rock, whose values do not grow with the return period."""
    if given.get("hazard") is not None and sound("hazard"):
        for k, row in enumerate(given["hazard"]):
            if row[-1] < MIN_PERIOD:
                yield ("hazard", k), f"has T_C* = {row[-1]:g} s: a period must be at least {MIN_PERIOD:g} s"
        for k, (before, after) in enumerate(pairwise(given["hazard"]), 1):
            if after[0] <= before[0]:
                yield ("hazard", k), f"return periods must increase, got {after[0]:g} after {before[0]:g} years"
            elif after[1] <= before[1]:
                yield ("hazard", k), f"ag must increase with the return period, got {after[1]:g} after {before[1]:g} g"
    known = {state: ground["ag"] for state, ground in on_rock.items() if ground.get("ag") is not None}
    known = {state: ag for state, ag in known.items() if sound(state, "ag") and sound("ag")}
    for (before, less), (after, ag) in pairwise(known.items()):
        if ag <= less:
            place = (after, "ag") if given.get(after) is not None else ("ag",)
            yield place, f"must be more than that of {before}, {less:g} g: got {ag:g} g at {after}"


def floor_at(site: ItalianSite, state: str) -> Floor | None:
    """Return the floor on which the structure stands, with its mode at a limit state; None on the ground."""
    floor = site.floor
    if floor is None:
        return None
    mode = floor.mode(state)
    return Floor(mode.T1, mode.xi1, floor.z / floor.H, 3 * floor.n / (2 * floor.n + 1))


def of_structure(site: ItalianSite, mechanism: Mechanism) -> ItalianSite:
    """Return the site as it counts for a structure.

    Its vibrating element takes missing sizes from the structure. Without `crushing` no strength is counted, and FC is
    at least that of LC1, unless the site says otherwise. Raises `InputError` if a size is missing.
    """
    update: dict[str, Any] = {} if site.element is None else {"element": site.element.sized(mechanism)}
    if mechanism.crushing is None and not site.FC_without_strength:
        update["FC"] = max(site.FC, LARGEST_FC)
    return site.model_copy(update=update)


def of_each(site: ItalianSite) -> ItalianSite:
    """Return the site of many structures, in which the element takes its dimensions from each structure."""
    if site.element is None:
        return site
    return site.model_copy(update={"element": ElementOfEach.model_construct(**dict(site.element))})
