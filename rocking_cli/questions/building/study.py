"""All mechanisms of a building, verified: weakest hinges and cracks are searched, and the one that governs is named."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from itertools import pairwise, product
from math import ceil, inf, isclose, isnan, nan
from typing import Any, NamedTuple, get_args

import numpy as np

from rocking_cli.core.hung.ties import BAR_DIAMETERS
from rocking_cli.dynamics.parallel import in_processes
from rocking_cli.errors import InputError, MechanismError, Problem, SolverError, named
from rocking_cli.io.json_text import json_text
from rocking_cli.questions.building import made as making
from rocking_cli.questions.building.description import Building, BuildingWall
from rocking_cli.questions.building.made import FallsAtRest, MadeMechanism, NotMade
from rocking_cli.short_repr import short_repr
from rocking_cli.structure import Structure
from rocking_cli.studies.conclusion import Concluded, Conclusion, severity
from rocking_cli.studies.remark import Remark
from rocking_cli.verification.check import code_of, verify, with_histories
from rocking_cli.verification.code import SiteFile
from rocking_cli.verification.results import Histories, Verification

FIRST_CELLS = 4  # intervals of a search in which the least is looked for
REFINED = 8  # evaluations in the best of them
CRACKS = 12, 8  # of angles alone, and beside heights: ratios drop where the courses slip off before the end
CELL = 1.0  # m, of which storeys that are higher have more intervals
PERIOD_FACTOR = 0.05  # C1 of T1 = C1 H^(3/4), H in m
LENGTHENED, DAMPING, LATER_DAMPING = 1.75, 0.05, 0.10  # T1 at SLV over that at SLD, and damping ratios
LEAST_REST = 0.05  # share of the last storey above the highest hinge that is tried
LEAST_GABLE = 0.2  # the same of a gable
OF_WALLS = ("overturning", "bending", "arch")  # kinds of mechanisms of walls themselves
LEVEL_HEIGHT = 0.01  # m; a weakest hinge this near a level is that of the level
FAR_ABOVE = 10.0  # times the least ratio of a grid; a search has any larger one as this
HOLDS = Concluded.SATISFIED, Concluded.SATISFIED_IF
LOWER = 1e-3  # share by which a hinge between levels must be weaker to be listed beside them


@short_repr
@dataclass(frozen=True, eq=False)
class Found:
    """A mechanism of a building with its verification.

    Parameters
    ----------
    made : MadeMechanism
        How it was made.
    structure : Structure
        The structure.
    verification : Verification
        Its verification, at the height of its hinge.
    """

    made: MadeMechanism
    structure: Structure
    verification: Verification

    @property
    def conclusion(self) -> Conclusion:
        """The conclusion of its verification."""
        return self.verification.conclusion

    @property
    def ratio(self) -> float:
        """Capacity over demand; NaN if it is not known."""
        ratio = self.conclusion.ratio
        return nan if ratio is None else ratio


@short_repr
@dataclass(frozen=True)
class LeftOutMechanism:
    """A mechanism that was not verified.

    Parameters
    ----------
    title : Remark
        What it is.
    why : Remark or str
        Why it was not verified.
    open : bool
        Whether it exists and may govern.
    falls : bool
        Whether it does not stand under its loads without an earthquake.
    """

    title: Remark
    why: Remark | str
    open: bool = False
    falls: bool = False


@short_repr
@dataclass(frozen=True, eq=False)
class Assessed:
    """A building with all its mechanisms.

    Parameters
    ----------
    building : Building
        The building.
    site : SiteFile
        Its site, without a floor.
    rows : sequence of Found
        The mechanisms, the worst first.
    left_out : sequence of LeftOutMechanism
        Mechanisms that were not verified.
    period : float
        The first period of the undamaged building [s].
    period_given : bool
        Whether the file gives it.
    shaken : sequence of str
        Names of the mechanisms that were verified by histories too.
    strengthened : Assessed, optional
        The strengthened building, with which this one is compared.
    """

    building: Building
    site: SiteFile
    rows: Sequence[Found]
    left_out: Sequence[LeftOutMechanism]
    period: float
    period_given: bool
    shaken: Sequence[str] = ()
    strengthened: Assessed | None = None

    @property
    def governs(self) -> Found:
        """The mechanism that governs."""
        return self.rows[0]

    @property
    def conclusion(self) -> Conclusion:
        """The conclusion on the building: that of the worst mechanism, unless one that is left out decides.

        It is not satisfied if one does not stand without an earthquake, and not checked if one that may govern is open.
        """
        end = self.governs.conclusion
        if any(each.falls for each in self.left_out):
            return replace(end, concluded=Concluded.NOT_SATISFIED, ratio=0.0, method="", limit_state="", limits=[])
        is_open = end.concluded in HOLDS and any(each.open for each in self.left_out)
        return replace(end, concluded=Concluded.NOT_CHECKED, method="") if is_open else end  # the next step is not its


def floor_of(building: Building, site: SiteFile, z: float) -> SiteFile:
    """Return the site of what is shaken at a height above the foundation [m]: the ground, or the building's motion.

    What stands at the foot of the building, on a plinth or not, moves with the ground.

    A `floor` of the site is used with this height; otherwise T1 is that of the building, and longer at SLV and SLC.
    """
    if z <= max(0.0, building.levels[0]):
        return replace(site, site=site.site.model_copy(update={"floor": None}))
    fields, given = type(site.site).model_fields, getattr(site.site, "floor", None)
    if "floor" not in fields:
        raise InputError(Problem(f"{site.site.code} does not know floors of a building", site.document.file))
    if given is not None:
        floor = given.model_copy(update={"z": min(z, given.H)})
        return replace(site, site=site.site.model_copy(update={"floor": floor}))
    period = first_period(building)
    later = {"T1": LENGTHENED * period, "xi1": LATER_DAMPING}
    floor = {"z": float(z), "H": float(building.height), "n": building.count, **later,
             "SLD": {"T1": period, "xi1": DAMPING}, "SLC": later}  # fmt: skip
    (kind, _) = get_args(fields["floor"].annotation)
    return replace(site, site=site.site.model_copy(update={"floor": kind.model_validate(floor)}))


def first_period(building: Building) -> float:
    """Return T1 of the undamaged building [s]: as given, or 0.05 H^(3/4) of the height above its foundation."""
    return building.T1 or PERIOD_FACTOR * (building.height - building.levels[0]) ** 0.75


@dataclass(frozen=True)
class MechanismSearch:
    """The mechanisms of a building at a site."""

    building: Building
    site: SiteFile

    @cached_property
    def _ratios(self) -> dict[str, float]:
        """Ratios computed so far: walls that are alike, and hinges that a search comes back to, are verified once."""
        return {}

    def verified(self, made: MadeMechanism) -> Found:
        """Return a mechanism with its verification. Raises `InputError` or `MechanismError`."""
        structure = Structure(made.structure())
        verified = Found(made, structure, verify(structure, floor_of(self.building, self.site, made.z)))
        self._ratios[_key(made)] = inf if isnan(verified.ratio) else verified.ratio
        return verified

    def ratio(self, made: MadeMechanism) -> float:
        """Return capacity over demand of a mechanism: none if it falls at rest; infinite if it cannot be verified."""
        key = _key(made)
        if key not in self._ratios:
            self._ratios[key] = inf
            try:
                self.verified(made)
            except FallsAtRest:
                self._ratios[key] = 0.0
            except (InputError, MechanismError, SolverError):
                pass
        return self._ratios[key]

    def _at(self, make: Callable[..., MadeMechanism], *arguments: float) -> float:
        """Return the ratio of a mechanism made with arguments; infinite if it is not made."""
        try:
            return self.ratio(make(*arguments))
        except NotMade:
            return inf

    def weakest(
        self, make: Callable[[float], MadeMechanism], low: float, high: float, cells: int = FIRST_CELLS
    ) -> float:
        """Return the argument from `low` to `high` at which a mechanism has its least ratio: a grid, then a search.

        The search is in the cells around the least of the grid; what is lower by less than `LOWER` is not looked for.
        `cells` are the intervals of the grid.
        """
        from scipy.optimize import minimize_scalar

        places = np.linspace(low, high, cells + 1).tolist()
        values = [self._at(make, x) for x in places]
        least = min(values)
        k = _least(values)
        if least in (0.0, inf):
            return float(places[k])
        best, step = places[k], (high - low) / cells
        if k in (0, cells):  # a lower value beside an end shows at once
            beside = best + step / 8 if k == 0 else best - step / 8
            if not self._at(make, beside) < least * (1 - LOWER):
                return float(best)
        ends = max(low, best - step), min(high, best + step)
        stops = {"maxiter": REFINED, "xatol": 0.01 * step}

        def bounded(x: float) -> float:
            return min(self._at(make, x), FAR_ABOVE * least)  # an infinite value has no parabola

        ended = minimize_scalar(bounded, bounds=ends, method="bounded", options=stops)
        return float(ended.x) if float(ended.fun) < least * (1 - LOWER) else float(best)

    def weakest_joint(
        self, make: Callable[..., MadeMechanism], joints: Sequence[float], slopes: Sequence[float], cells: int
    ) -> tuple[float, float]:
        """Return the bed joint and the angle of the crack with which a wall that interlocks has its least ratio.

        A grid of some of the joints and of all the angles, then every joint and all the angles around its least.
        """
        step = -(-len(joints) // cells)
        places = [*product(joints[::-step], slopes)]
        z, angle = places[_least([self._at(make, *place) for place in places])]
        k = joints.index(z)
        around = joints[max(0, k - step + 1) : k + step]
        z = around[_least([self._at(make, each, angle) for each in around])]
        if len(slopes) == 1:
            return z, angle
        width = slopes[1] - slopes[0]
        ends = max(slopes[0], angle - width), min(slopes[-1], angle + width)
        return z, self.weakest(partial(make, z), *ends, cells=2)

    def of_wall(self, wall: BuildingWall) -> Iterator[Found | LeftOutMechanism]:
        """Yield the mechanisms of a wall."""
        building = self.building
        foot, top = wall.reaches(building.count)
        for level in range(foot, top):
            yield from self._overturning(wall, level, is_last=level + 1 == top)
        for low, high in pairwise(making.held_levels(building, wall)):
            title = Remark.of("bending", wall=wall.name, z=building.levels[low], top=building.levels[high])
            yield from self._one(partial(making.bending, building, wall, low, high), title)
        title = Remark.of("arch", wall=wall.name, z=building.levels[top - 1])
        yield from self._one(partial(making.arch, building, wall), title)

    def _overturning(self, wall: BuildingWall, level: int, *, is_last: bool) -> Iterator[Found | LeftOutMechanism]:
        """Yield a wall that overturns about a level, also without its gable, and about a weaker hinge above it."""
        building, courses = self.building, self.building.interlock
        low, high = building.levels[level : level + 2]
        has_gable = any(each.wall == wall.name for each in building.gables)
        is_searched = wall.connection == "interlock" and courses is not None and courses.angle == "weakest"
        steepest = courses.steepest if is_searched and courses is not None else 0.0
        about = partial(making.overturning, building, wall)
        levels = list[float]()
        for gable in (True, False) if has_gable else (True,):
            turned = partial(about, low, gable=gable)
            crack = [self.weakest(turned, 0.0, steepest, CRACKS[0])] if is_searched else []
            key = "overturning" if gable else "overturning_without"
            yield from self._one(partial(turned, *crack), Remark.of(key, wall=wall.name, z=low))
            levels.append(self._at(turned, *crack))
        end = high - (LEAST_REST * (high - low) if is_last else LEVEL_HEIGHT)  # below it the floor at its top acts
        cells = max(FIRST_CELLS, ceil((high - low) / CELL))
        joints = [z for z in making.joints(building, wall) if low + LEVEL_HEIGHT < z <= end]
        angle: list[float] = []
        if joints:
            slopes = (
                np.linspace(0.0, steepest, CRACKS[1] + 1).tolist() if is_searched else [making.given_angle(building)]
            )
            z, *angle = self.weakest_joint(about, joints, slopes, cells)
        else:
            z = round(self.weakest(about, low, end, cells), 3)
        others = levels[:1]
        if z > high - 2 * LEVEL_HEIGHT:
            others.append(self._at(about, high, *angle))
        if z > low + LEVEL_HEIGHT and self._at(about, z, *angle) < (1 - LOWER) * min(others):
            yield from self._one(partial(about, z, *angle))

    def of_others(self) -> Iterator[Found | LeftOutMechanism]:
        """Yield the mechanisms of what stands on walls, and of corners."""
        building = self.building
        for each in (*building.gables, *building.parapets, *building.bell_gables):
            about = partial(making.standing, building, each)
            at_foot = yield from self._one(about, Remark.of("standing", wall=each.wall))
            if each in building.gables and at_foot is not None:
                low, high = at_foot.made.hinge
                z = self.weakest(about, low, high - LEAST_GABLE * (high - low))
                if z > low + LEVEL_HEIGHT:
                    yield from self._one(partial(about, round(z, 3)))
        for k, given in enumerate(building.corners):
            courses = building.interlock
            assert courses is not None  # a corner without was refused
            walls = [building.wall[name].reaches(building.count) for name in given.walls]
            for level in range(max(foot for foot, _ in walls), min(top for _, top in walls)):
                turned = partial(making.corner, building, k, building.levels[level])
                is_searched = courses.angle == "weakest"
                angle = (
                    self.weakest(turned, 0.0, courses.steepest, CRACKS[0])
                    if is_searched
                    else making.given_angle(building)
                )
                yield from self._one(partial(turned, angle))

    def _one(self, make: Callable[[], MadeMechanism], title: Remark | None = None) -> Any:
        """Yield a mechanism with its verification, or why there is none; return it, or None."""
        try:
            made = make()
            title = made.title
            verified = self.verified(made)
        except NotMade as why:
            yield LeftOutMechanism(title or Remark.of("part_of_building"), why.why, why.exists)
        except (InputError, MechanismError, SolverError) as error:
            assert title is not None  # it was made
            yield LeftOutMechanism(title, _why(error), open=True, falls=isinstance(error, FallsAtRest))
        else:
            yield verified
            return verified


def _key(made: MadeMechanism) -> str:
    """Return what decides the verification of a mechanism."""
    return json_text([made.mechanism, made.z, made.fields])


def _least(values: Sequence[float]) -> int:
    """Return the index of the least value, of values that differ by their rounding the first."""
    return min(range(len(values)), key=lambda k: (float(f"{values[k]:.9g}"), k))


def _why(error: Exception) -> str:
    """Return the first problem of an error as a clause, without the line of a file, and how many more there are."""
    problems = error.problems if isinstance(error, InputError) else [Problem(str(error))]
    lines = str(replace(problems[0], excerpt=None)).splitlines()
    return "; ".join(map(str.strip, lines)) + f" (and {len(problems) - 1} more)" * (len(problems) > 1)


def mechanisms(search: MechanismSearch, first: int, stop: int) -> list[Found | LeftOutMechanism]:
    """Return the mechanisms of some walls; of those after the last wall, those of corners and what stands on walls."""
    walls = search.building.walls
    tasks = [search.of_wall(wall) for wall in walls[first:stop]] + [search.of_others()] * (stop > len(walls))
    return [each for task in tasks for each in task]


class NoMechanism(Exception):
    """No mechanism of a building can be verified; its argument has them with the reasons."""


def assess(
    building: Building, site: SiteFile, *, processes: int | None = None, progress: Callable[[int], object] = int
) -> Assessed:
    """Verify all mechanisms of a building.

    Parameters
    ----------
    building : Building
        The building.
    site : SiteFile
        Its site; a `floor` gives the period of the building, in place of that of the building.
    processes : int, optional
        Number of processes that share the walls; by default this one alone.
    progress : callable, optional
        Called with the number of walls done since the last call; corners and what stands on walls count as one.

    Raises
    ------
    NoMechanism
        If no mechanism can be verified.
    """
    search, count = MechanismSearch(building, site), len(building.walls) + 1
    parts: dict[int, list[Found | LeftOutMechanism]] = {}
    if processes is not None:
        for first, part in in_processes(partial(mechanisms, search), count, 1, processes):
            parts[first] = part
            progress(1)
    else:
        for k in range(count):
            parts[k] = mechanisms(search, k, k + 1)
            progress(1)
    every = [each for k in sorted(parts) for each in parts[k]]
    rows = [each for each in every if isinstance(each, Found)]
    left_out = [each for each in every if isinstance(each, LeftOutMechanism)]
    if not rows:
        raise NoMechanism(left_out)
    period = first_period(building)
    return Assessed(building, site, ranked(rows), left_out, period, period_given=building.T1 is not None)


def ranked(rows: Sequence[Found]) -> list[Found]:
    """Return mechanisms in the order of their conclusions, the worst first; alike ones as they are."""
    return sorted(rows, key=lambda each: [-float(f"{x:.9g}") for x in severity(each.conclusion)])


def known_last(ratio: float) -> tuple[bool, float]:
    """Return a key by which the least ratio is the first, after those that are not known."""
    return (False, 0.0) if isnan(ratio) else (True, ratio)


def shaken(found: Assessed, worst: int, sets: Mapping[str | None, Histories]) -> Assessed:
    """Return a building whose worst mechanisms are verified by time histories too.

    Parameters
    ----------
    found : Assessed
        The building.
    worst : int
        How many mechanisms.
    sets : mapping of str to Histories
        The records of each limit state.

    Raises
    ------
    InputError
        If a structure has no restitution, or the site lacks the limit state.
    SolverError
        If a motion cannot be simulated to its end.
    """
    rows = list(found.rows)
    if missing := [each.made.name for each in rows[:worst] if each.structure.restitution_source == "missing"]:
        hint = "give `rebound` in the building: a measured rate after an impact over that before, from 0 to below 1"
        raise InputError(Problem(f"is missing: {missing[0]} leans on the building", field="rebound", hint=hint))
    floor: Any = getattr(found.site.site, "floor", None)
    away = [each.made for each in rows[:worst] if floor is not None and not isclose(each.made.z, floor.z)]
    if away and any(each.on_floor for each in sets.values()):
        what = f"is of motions at {floor.z:g} m, and {away[0].name} is shaken at {away[0].z:g} m"
        hint = f"verify that mechanism by itself: {named('structures')} writes it"
        raise InputError(Problem(what, field=named("on_floor"), hint=hint))
    for k, each in enumerate(rows[:worst]):
        result, place = each.verification, floor_of(found.building, found.site, each.made.z)
        for histories in sets.values():
            result = with_histories(result, each.structure, place, histories)
        rows[k] = replace(each, verification=result)
    names = [each.made.name for each in rows[:worst]]
    return replace(found, rows=ranked(rows), shaken=names)


def compared(found: Assessed, other: Assessed) -> Assessed:
    """Return a building beside the strengthened one, judged by what the code requires after the intervention.

    What is required of each strengthened mechanism depends on the ratio of the worst one before, if on any.
    """
    code, site = code_of(found.site), found.site.site
    worst = found.governs.verification

    def judged(row: Found, *, after: bool) -> Found:
        both = code.strengthened(worst if after else row.verification, row.verification, site)
        return replace(row, verification=both.strengthened if after else replace(both, strengthened=None))

    later = replace(other, rows=ranked([judged(row, after=True) for row in other.rows]))
    return replace(found, rows=ranked([judged(row, after=False) for row in found.rows]), strengthened=later)


class BarsTried(NamedTuple):
    """Bars of the ties of a level that were tried.

    Parameters
    ----------
    diameter : float
        Diameter [m].
    ratio : float
        Ratio of the worst mechanism that the ties hold; NaN if it is not known.
    title : Remark
        This mechanism.
    satisfied : bool
        Whether all that they hold satisfies the code.
    concluded : Concluded
        The conclusion on the worst.
    """

    diameter: float
    ratio: float
    title: Remark
    satisfied: bool
    concluded: Concluded


@short_repr
@dataclass(frozen=True)
class BarsOfLevel:
    """Bars of the ties of a level, and what they do for all mechanisms that they hold.

    Parameters
    ----------
    level : int
        The level.
    tried : sequence of BarsTried
        Diameters in use, the least first, up to the first that suffices.
    whole : Conclusion
        The conclusion on the building with the last of them.
    governs : Remark
        The mechanism that governs it then.
    """

    level: int
    tried: Sequence[BarsTried]
    whole: Conclusion
    governs: Remark

    @property
    def diameter(self) -> float | None:
        """The least diameter with which all that the ties hold satisfies the code [m]; None if none does."""
        last = self.tried[-1]
        return last.diameter if last.satisfied else None


def bars_of_level(found: Assessed, level: int, progress: Callable[[int], object] = int) -> BarsOfLevel:
    """Find the least bars of the ties of a level with which all mechanisms that they hold satisfy the code.

    Hinges and cracks are searched anew for each diameter, as other bars may have other weakest ones.

    Parameters
    ----------
    found : Assessed
        The building.
    level : int
        The level.
    progress : callable, optional
        Called with 1 after each diameter.

    Raises
    ------
    InputError
        If the level has no ties.
    """
    building, tried = found.building, list[BarsTried]()
    ties = [each.name for each in building.ties if each.level == level]
    names = {*ties, *(f"{name} at level {level}" for name in ties)}
    held = [wall for wall in building.walls if any(wall.name in e.walls for e in building.ties if e.level == level)]
    if not held:
        levels = sorted({each.level for each in building.ties})
        hint = f"levels with ties: {', '.join(map(str, levels))}" if levels else "add ties to the building"
        raise InputError(Problem(f"level {level} has no ties", field=named("design"), hint=hint))
    for diameter in BAR_DIAMETERS:
        search = MechanismSearch(making.with_bars(building, level, diameter), found.site)
        every = [each for wall in held for each in search.of_wall(wall)]
        rows = [each for each in every if isinstance(each, Found)]
        tied = [row for row in rows if any(tie["name"] in names for tie in row.made.fields.get("ties", ()))]
        progress(1)
        if falling := [each for each in every if isinstance(each, LeftOutMechanism) and each.falls]:
            tried.append(BarsTried(diameter, 0.0, falling[0].title, False, Concluded.NOT_SATISFIED))
            continue
        if not tied:
            raise InputError(Problem(f"the ties of level {level} hold no mechanism that can be verified"))
        worst = ranked(tied)[0]
        end = worst.conclusion.concluded
        tried.append(BarsTried(diameter, worst.ratio, worst.made.title, end in HOLDS, end))
        if end in HOLDS:
            break
    again = {wall.name for wall in held}
    others = [row for row in found.rows if row.made.wall not in again or row.made.kind not in OF_WALLS]
    titles = [row.made.title for row in rows]
    left_out = [each for each in every if isinstance(each, LeftOutMechanism)]
    left_out += [each for each in found.left_out if each.title not in titles]
    whole = replace(found, rows=ranked([*rows, *others]), left_out=left_out)
    return BarsOfLevel(level, tried, whole.conclusion, whole.governs.made.title)
