"""A survey of many structures: the equivalent block of each, its response to ground motions, and their ranking."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from math import exp, inf, isnan, nan
from statistics import fmean
from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np

from rocking_cli.arrays import Integers
from rocking_cli.core import Mechanism
from rocking_cli.core.plausible import doubts
from rocking_cli.dynamics.batch import Runs, respond_many
from rocking_cli.dynamics.model import Model, scatter_of
from rocking_cli.dynamics.outcome import Outcomes
from rocking_cli.dynamics.parallel import in_parts, in_processes
from rocking_cli.dynamics.sliding import sliding_of
from rocking_cli.errors import InputError, Problem, RockingError, SolverError
from rocking_cli.excitation.base import STANDARD_GRAVITY, GroundMotion
from rocking_cli.io.spreadsheet import Spreadsheet
from rocking_cli.names import OPENING
from rocking_cli.questions.margin.study import FACTORS, Limits, limited, margin
from rocking_cli.questions.survey.inventory import Inventory, ListedObject
from rocking_cli.questions.survey.remedies import SAFE_SHARE, Remedy, clearance, remedies
from rocking_cli.short_repr import short_repr
from rocking_cli.structure import Structure, check_opening
from rocking_cli.studies.conclusion import Concluded, Conclusion, NeighbourShare
from rocking_cli.studies.neighbours import Conditions, Neighbourhood, neighbours
from rocking_cli.verification.check import code_of, of_each, questioned, row_numbers, verify
from rocking_cli.verification.code import SiteFile, codes

if TYPE_CHECKING:
    from rocking_cli.questions.survey.in_space import SpaceOutcome

STRUCTURES_PER_CHUNK = 8  # in the memory of a thread at a time: the tables of each are one megabyte, at most ten

MAX_SAMPLES = 400_000_000  # of motions times structures, polarities and neighbours: under a minute on two processors
NO_NEIGHBOURS = Neighbourhood(0)
LEVELS = (SAFE_SHARE, 0.5)
"""Shares of neighbours that overturn, for which objects of a list get the peaks of a motion."""
FEWEST_NEIGHBOURS = 59  # of which none overturns with a probability of 5 % if one in twenty does
WEAK_FACTORS = FACTORS[FACTORS < 2.0] / 10  # tried where a motion topples an object at the least of all others
MAX_DEVIATIONS = 5.0  # standard deviations beyond which no neighbour is drawn


class SurveyEntry(Protocol):
    """A structure that is still to be built."""

    @property
    def name(self) -> str:
        """Name of the structure, whether or not it can be used."""

    @property
    def line(self) -> int | None:
        """Line of the structure in a file; None without one."""

    def make(self) -> Mechanism:
        """Build the structure. Raises `InputError` or `MechanismError` if it cannot be used."""

    def site(self, usual: SiteFile | None) -> SiteFile | None:
        """Return its site, `usual` unless it has another. Raises `InputError` if that cannot be used."""


@dataclass(frozen=True)
class SurveyResponse:
    """Response of a structure to ground motions, by the nonlinear model.

    Parameters
    ----------
    overturned : float
        The share of the motions that overturn the structure; of two polarities of a motion, the worse governs.
    peak_ratio : float
        The largest peak rotation over the critical one, of the motions that are known not to overturn the structure;
        NaN if there are none.
    worst : str
        A motion that overturns the structure, else one of unknown outcome, else that of the largest peak.
    over : str
        Reference of the peak: "phi_cr", or "limit" if a direction has no critical rotation.
    unknown : float or None
        The share of the motions that have an unknown outcome; None if the joints are not known, so that nothing was
        checked.
    share : NeighbourShare, optional
        The share of the neighbours that overturn the structure, the mean over the motions, or of an object of a list
        that of the worst motion; of two polarities, the worse governs. None without neighbours.
    slip : float
        The largest slip under the motions that are known not to overturn the structure [m]; 0 if it does not only
        slide.
    """

    overturned: float
    peak_ratio: float
    worst: str
    over: str = "phi_cr"
    unknown: float | None = 0.0
    share: NeighbourShare | None = None
    slip: float = 0.0

    @property
    def concluded(self) -> Concluded:
        """Conclusion over all motions, from the worst of them."""
        if self.overturned:
            return Concluded.OVERTURNS
        if self.unknown:
            return Concluded.UNKNOWN
        return Concluded.ROCKS if self.peak_ratio else Concluded.SLIDES if self.slip else Concluded.NO_UPLIFT

    @property
    def at_most(self) -> float:
        """The share that overturns the structure if all of unknown outcome do: of neighbours, or else of motions."""
        return self.share.highest if self.share is not None else self.overturned + (self.unknown or 0.0)


class Topples(NamedTuple):
    """How strong a ground motion topples a structure, by its margin.

    Parameters
    ----------
    motion : str
        Name of the motion.
    pga, pgv : float
        Its peaks [standard gravity, m/s], those of the ground.
    factors : mapping of float to float or None
        The least factor on it at which a share of the neighbours of 0.05 and 0.5 overturn or have an unknown outcome;
        None if that is at none of those tried.
    tried : tuple of float
        The least and the largest factor tried.
    share : NeighbourShare
        The share at a factor of 1.
    base_pga : float
        Peak acceleration of what it stands on [standard gravity]: of the ground, a floor, or an isolator.
    """

    motion: str
    pga: float
    pgv: float
    factors: Mapping[float, float | None]
    tried: tuple[float, float]
    share: NeighbourShare
    base_pga: float


@short_repr
@dataclass(frozen=True)
class Surveyed:
    """A structure of a survey, with its results in the direction in which it uplifts first.

    Parameters
    ----------
    row : int
        Number of the row among those requested, from 1.
    line : int or None
        Line of the structure in its file.
    name, mechanism : str
        Names of the structure and of its mechanism.
    side : str or None
        "depth" if the structure rocks about its depth, as the weaker side of its base; None if as given.
    direction : str
        "positive", or "negative" if the structure uplifts first in this direction.
    lambda_ : float
        Uplift acceleration over the gravitational acceleration of the structure.
    uplift : float
        Uplift acceleration [standard gravity].
    p, phi_cr, kappa1, kappa2, eta : float
        Parameters of the equivalent block, see `rocking_cli.core.EquivalentBlock`; NaN if undefined.
    no_block : str or None
        Why there is no equivalent block; None if there is one.
    doubt : str or None
        A doubt about the size of the structure, if any.
    cautions : sequence of str
        Cautions on the results of the structure.
    under : SurveyResponse, optional
        Response to ground motions, if there are any.
    ratio : float, optional
        Capacity over demand by the code of the site, in the direction where it is smaller; 1 or more passes. NaN if the
        site file lacks values that the code needs; None without a site.
    verified : Conclusion, optional
        The conclusion of the verification by the code of the site.
    unprinted : bool
        Whether a formula of that verification was not checked against the printed code.
    remarks : sequence of str
        Sentences on how fields of the structure were read, such as weights as masses.
    numbers : mapping of str to float or None
        Further numbers of that verification, those of `Survey.units`.
    width_alone : bool
        Whether it may rock about its depth, which is not given.
    any_friction : bool
        Whether it is a single body without a given friction, which never slides.
    site : str, optional
        File of its site; None without one.
    code : str, optional
        Code of its site.
    z : float, optional
        Height of its base above the foundation [m], 0 on the ground; None if its code has no floors.
    topples : sequence of Topples
        How strong each of the motions must be to topple it, of objects of a list.
    remedies : sequence of Remedy
        What to do, of objects of a list that may fall: the first that suffices, or all, if requested.
    space : sequence of SpaceOutcome
        What it does in three dimensions under each motion, if that was requested.
    not_in_space : str or None
        Why it was not simulated there.
    clearance : float
        The slip that one in twenty of its neighbours exceeds under the worst motion [m], of objects of a list.
    """

    row: int
    line: int | None
    name: str
    mechanism: str
    direction: str
    lambda_: float
    uplift: float
    p: float
    phi_cr: float
    kappa1: float
    kappa2: float
    eta: float
    no_block: str | None = None
    doubt: str | None = None
    cautions: Sequence[str] = ()
    under: SurveyResponse | None = None
    ratio: float | None = None
    verified: Conclusion | None = None
    unprinted: bool = False
    remarks: Sequence[str] = ()
    numbers: Mapping[str, float | None] = field(default_factory=dict)
    side: str | None = None
    width_alone: bool = False
    any_friction: bool = False
    site: str | None = None
    code: str | None = None
    z: float | None = None
    topples: Sequence[Topples] = ()
    remedies: Sequence[Remedy] = ()
    space: Sequence[SpaceOutcome] = ()
    not_in_space: str | None = None
    clearance: float = 0.0

    @property
    def caution(self) -> str | None:
        """The cautions as one text; None without any."""
        return " ".join(self.cautions) or None

    @property
    def danger(self) -> str | None:
        """Whether an object of a list "falls", "may fall" or "stands", by its neighbours; None if they are too few.

        It falls if half or more of the neighbours of the worst motion overturn or have an unknown outcome, and stands
        if at most 5 % do.
        """
        if not self.topples or self.topples[0].share.of < FEWEST_NEIGHBOURS:
            return None
        worst = max(each.share.highest for each in self.topples)
        return "stands" if worst <= LEVELS[0] else "may fall" if worst < LEVELS[1] else "falls"

    def toppled_from(self, level: float) -> tuple[float | None, float | None]:
        """Return the least PGA [g] and PGV [m/s] of the motions at which a share topples it; None where none does."""
        reached = [(each, factor) for each in self.topples if (factor := each.factors[level]) is not None]
        pga, pgv = ([getattr(each, key) * factor for each, factor in reached] for key in ("pga", "pgv"))
        return min(pga, default=None), min(pgv, default=None)


@dataclass(frozen=True)
class FailedEntry:
    """A structure that could not be used.

    Parameters
    ----------
    row : int
        Number of the row among those requested, from 1.
    line : int or None
        Line of the structure in its file.
    name : str
        Name of the structure.
    error : RockingError
        The reason, with the place in the file.
    """

    row: int
    line: int | None
    name: str
    error: RockingError

    @property
    def reason(self) -> str:
        """The reason in one line, without the place in the file."""
        if not isinstance(self.error, InputError):
            return str(self.error)
        return "; ".join(str(Problem(each.message, field=each.field)) for each in self.error.problems)


Order = Callable[[Surveyed], tuple[float, ...]]


def _rounded(*values: float) -> tuple[float, ...]:
    """Round numbers to nine digits, so that equal structures keep their order on every processor; NaN is the last."""
    return tuple(inf if isnan(value) else float(f"{value:.9g}") for value in values)


def _by_lambda(found: Surveyed) -> tuple[float, ...]:
    return _rounded(found.uplift)


def _by_response(found: Surveyed) -> tuple[float, ...]:
    assert found.under is not None
    peak, slip = _rounded(found.under.peak_ratio, found.under.slip)
    return (-found.under.at_most, -peak, -slip, *_rounded(found.uplift))


def _by_ratio(found: Surveyed) -> tuple[float, ...]:
    assert found.ratio is not None
    return _rounded(found.ratio, found.uplift)


ORDERS: Mapping[str, Order] = {"lambda": _by_lambda, "response": _by_response, "ratio": _by_ratio}
"""Sort keys of rankings: the structure with the smaller key is the more vulnerable."""


@short_repr
@dataclass(frozen=True)
class Survey:
    """The structures of a survey, the most vulnerable first.

    Parameters
    ----------
    rows : sequence of Surveyed
        The structures in the order of their rank.
    bad : sequence of FailedEntry
        The structures that could not be used, in their order.
    motions : sequence of str
        The names of the ground motions.
    around : Neighbourhood
        The neighbours of each motion; a count of 0 for none.
    polarities : sequence of int
        The polarities of the motions; of both, the worse governs.
    pga, floor_pga : sequence of float
        Peak accelerations of ground and floor [standard gravity]; the second is empty without a floor.
    reduced : bool
        Whether there are fewer neighbours than usual, so that the survey takes no more than about a minute.
    by : str
        The quantity by which they are ranked, a key of `ORDERS`.
    units : mapping of str to str
        The unit of each number that the code of the site has for a row, by its name.
    sheet : Spreadsheet, optional
        The table from which the structures were read.
    items : sequence of ListedObject
        The objects of a list, by row; empty if the structures are not those of a list.
    """

    rows: Sequence[Surveyed]
    bad: Sequence[FailedEntry] = ()
    motions: Sequence[str] = ()
    by: str = "lambda"
    units: Mapping[str, str] = field(default_factory=dict)
    sheet: Spreadsheet | None = None
    around: Neighbourhood = NO_NEIGHBOURS
    reduced: bool = False
    polarities: Sequence[int] = ()
    pga: Sequence[float] = ()
    floor_pga: Sequence[float] = ()
    items: Sequence[ListedObject] = ()

    def cells(self, found: Surveyed) -> Sequence[str]:
        """Return the cells of a structure in its table; none without a table."""
        return self.sheet.rows[found.row - 1].cells if self.sheet is not None else ()


def survey(
    entries: Sequence[SurveyEntry],
    motions: Sequence[GroundMotion] = (),
    polarities: Sequence[int] = (1,),
    *,
    site: SiteFile | None = None,
    around: Neighbourhood = NO_NEIGHBOURS,
    bounded: bool = False,
    opening: float = OPENING,
    cautions: Callable[[Mechanism], Sequence[str]] = Mechanism.cautions,
    every_remedy: bool = False,
    in_space: bool = False,
    transverse: Sequence[GroundMotion] = (),
    threads: int | None = None,
    processes: int | None = None,
    progress: Callable[[int], None] | None = None,
) -> Survey:
    """Derive the equivalent blocks of structures, simulate them under ground motions, and rank them.

    Parameters
    ----------
    entries : sequence of SurveyEntry
        The structures. They are built and dropped a few at a time, so that any number fits in memory.
    motions : sequence of GroundMotion
        The scaled ground motions.
    polarities : sequence of int
        The polarities, 1, -1 or both; of both, the worse governs.
    site : SiteFile, optional
        The site of structures that have no other: each is verified by the code of its site.
    around : Neighbourhood
        The neighbours of each motion; a count of 0 for none.
    bounded : bool
        Whether to simulate fewer neighbours if all would take more than about a minute. The number of samples decides,
        so that a table has the same ranks on every machine.
    opening : float
        Largest opening of a joint, over D_cr, up to which a history is known.
    cautions : callable
        Returns the cautions on a structure.
    every_remedy : bool
        Whether to try every remedy of an object, and not only up to the first that suffices.
    in_space : bool
        Whether to simulate objects of a list in three dimensions too.
    transverse : sequence of GroundMotion
        The component across each of the motions there; none without any.
    threads : int, optional
        Number of threads; by default one for each processor.
    processes : int, optional
        Number of processes to use instead of threads, for thousands of structures: each takes a second or two to start,
        and is sent all entries and motions.
    progress : callable, optional
        Called with the number of structures done since the last call.

    Returns
    -------
    Survey
        Ranked by uplift acceleration; with motions by the share of their neighbours (without any, of the motions) that
        overturn or have an unknown outcome, then by the largest peak, slip and uplift acceleration; with a site by the
        ratio of its code. Structures that rank equal keep their order.
    """
    check_opening(opening)
    results: list[Surveyed | FailedEntry | None] = [None] * len(entries)
    by_code = site is not None or bool(getattr(entries, "sites", ()))
    samples = len(entries) * len(polarities) * sum(motion.npts for motion in motions)
    if reduced := bounded and samples * around.count > MAX_SAMPLES:
        around = replace(around, count=MAX_SAMPLES // samples)
    part = partial(
        _part,
        entries,
        Setting(motions, polarities, around, by_code, site, opening, cautions, every_remedy, in_space, transverse),
    )

    per_chunk = 1 if isinstance(entries, Inventory) else STRUCTURES_PER_CHUNK  # an object takes seconds

    def work(first: int, stop: int) -> None:
        results[first:stop] = part(first, stop)

    if processes is None:
        in_parts(work, len(entries), per_chunk, threads, progress)
    else:
        for first, done in in_processes(part, len(entries), per_chunk, processes):
            results[first : first + len(done)] = done
            if progress is not None:
                progress(len(done))
    if isinstance(entries, Inventory):
        _no_better_than_below(entries, results)
    by = "ratio" if by_code else "response" if motions else "lambda"
    good = sorted((result for result in results if isinstance(result, Surveyed)), key=ORDERS[by])
    bad, names = [each for each in results if isinstance(each, FailedEntry)], [each.name for each in motions]
    used = dict.fromkeys(each.code for each in good if each.code is not None)
    units = {name: number.unit for code in used for name, number in codes()[code].row_numbers.items()}
    peaks = [each.of_ground.pga_g for each in motions], [each.pga_g for each in motions if each.ground is not None]
    sheet = getattr(entries, "sheet", None)
    items = entries.items if isinstance(entries, Inventory) else ()
    return Survey(good, bad, names, by, units, sheet, around, reduced, polarities, *peaks, items)


def _no_better_than_below(entries: Inventory, results: list[Surveyed | FailedEntry | None]) -> None:
    """Let what stands on an object that may fall be unknown where that falls, motion by motion."""
    places = {id(item): k for k, item in enumerate(entries.items)}
    upward = [k for k, item in enumerate(entries.items) if item.on and isinstance(results[k], Surveyed)]
    for k in sorted(upward, key=lambda place: len(entries.items[place].chain)):
        one, below = results[k], results[places[id(entries.items[k].chain[-2])]]
        if not isinstance(below, Surveyed) or not isinstance(one, Surveyed) or not one.topples or one.under is None:
            continue
        topples = [
            each._replace(
                share=each.share._replace(highest=max(each.share.highest, under.share.highest)),
                factors={level: min(filter(None, (factor, under.factors[level])), default=None)
                         for level, factor in each.factors.items()},
            )
            for each, under in zip(one.topples, below.topples, strict=True)
        ]  # fmt: skip
        worst = max((each.share for each in topples), key=lambda each: (each.highest, each.lowest))
        results[k] = replace(one, topples=topples, under=replace(one.under, share=worst))


class Setting(NamedTuple):
    """What structures have in common, such as whether codes verify them, and the site of those without another."""

    motions: Sequence[GroundMotion]
    polarities: Sequence[int]
    around: Neighbourhood
    by_code: bool
    site: SiteFile | None
    opening: float
    cautions: Callable[[Mechanism], Sequence[str]]
    every_remedy: bool = False
    in_space: bool = False
    transverse: Sequence[GroundMotion] = ()


def _part(
    entries: Sequence[SurveyEntry], setting: Setting, first: int, stop: int
) -> list[Surveyed | FailedEntry | None]:
    """Return the results of the structures from index `first` to before `stop`, in any process."""
    ready: dict[int, Structure] = {}
    moving: dict[int, Structure] = {}
    rows: list[Surveyed | FailedEntry | None] = [None] * (stop - first)
    for k, place in enumerate(range(first, stop)):
        entry = entries[place]
        try:
            made = entry.make()
            weaker = made.weaker_side()
            ready[k] = Structure(weaker or made, opening=setting.opening)
            site = entry.site(setting.site) if setting.by_code else None
            asked = questioned(Structure(made), site) if site is not None else []
            odd = [*getattr(entry, "questions", ()), *doubts(made), *(f"{each.name} {each.words}" for each in asked)]
            alone = replace(_alone(place, entry, ready[k], setting, site), doubt="; ".join(odd) or None)
            rows[k] = replace(
                alone, side="depth" if weaker is not None or getattr(entry, "about_depth", False) else None,
                remarks=(*made.remarks, *getattr(entry, "remarks", ())),
                width_alone=made.depth is None and made.may_rock_about_depth(),
            )  # fmt: skip
            if isinstance(entry, ListedObject):
                ready[k].model("nonlinear")
            elif _may_move(ready[k], setting):
                ready[k].model("nonlinear")
                moving[k] = ready[k]
        except RockingError as error:
            ready.pop(k, None)
            placed: RockingError = error
            if isinstance(error, InputError):  # a problem of the mechanics of a structure has no line
                problems, line = error.problems, entry.line
                placed = InputError(*(replace(each, line=line) if each.line is None else each for each in problems))
            rows[k] = FailedEntry(place + 1, entry.line, entry.name, placed)
    if motions := setting.motions:
        under = _under(list(moving.values()), setting)
        answers = dict(zip(moving, under, strict=True))
        objects = dict[int, _OfObject]()
        for k, structure in ready.items():
            entry = entries[first + k]
            if isinstance(entry, ListedObject):
                objects[k] = _of_object(entry, structure, setting)
                answers[k] = objects[k].under
        count = setting.around.count
        none = NeighbourShare(0.0, 0.0, count) if count else None
        for k, structure in ready.items():
            one = rows[k]
            assert isinstance(one, Surveyed)
            over = "phi_cr" if all(side.phi_cr is not None for side in structure.statics) else "limit"
            answer = answers.get(k, SurveyResponse(0.0, 0.0, motions[0].name, over, share=none))
            if isinstance(answer, SolverError):
                rows[k] = FailedEntry(one.row, entries[first + k].line, one.name, answer)
            else:
                more = objects[k]._asdict() if k in objects else {}
                rows[k] = replace(one, **{**more, "under": answer})
    return rows


class _OfObject(NamedTuple):
    """What a row of `Surveyed` has more of an object of a list."""

    under: SurveyResponse | SolverError
    topples: Sequence[Topples] = ()
    remedies: Sequence[Remedy] = ()
    space: Sequence[SpaceOutcome] = ()
    not_in_space: str | None = None
    clearance: float = 0.0


def _of_object(item: ListedObject, structure: Structure, setting: Setting) -> _OfObject:
    """Return what an object does under the motions of what it stands on; without neighbours only its response."""
    around = setting.around
    on_base = setting._replace(motions=item.under(setting.motions), around=replace(around, count=0))
    limits = [item.limits(each) for each in on_base.motions]
    space: Sequence[SpaceOutcome] = ()
    why = None
    if setting.in_space:
        sign = setting.polarities[0]
        along, across = ([each.scaled(sign) for each in some]
                         for some in (on_base.motions, item.under(setting.transverse)))  # fmt: skip
        from rocking_cli.questions.survey.in_space import outcomes_in_space

        try:
            space = outcomes_in_space(item, structure, along, across)
        except RockingError as error:
            why = error.problems[0].message if isinstance(error, InputError) else str(error)
    try:
        (answer,) = _under([structure], on_base, limits)
        if not around.count or isinstance(answer, SolverError):
            return _OfObject(answer, space=space, not_in_space=why)
        conditions = Conditions(structure, ["nonlinear"], setting.polarities, around=around)
        topples = [_topples(conditions, each, limit) for each, limit in zip(on_base.motions, limits, strict=True)]
        advice = _remedies(item, topples, setting)
        room = clearance(conditions, on_base.motions) if conditions.model.sliding is not None else 0.0
    except SolverError as error:
        return _OfObject(error)
    worst = max((each.share for each in topples), key=lambda each: (each.highest, each.lowest))
    return _OfObject(replace(answer, share=worst), topples, advice, space, why, room)


def _remedies(item: ListedObject, topples: Sequence[Topples], setting: Setting) -> list[Remedy]:
    """Return what to do about an object that may fall: up to the first remedy that suffices, or all."""
    advice = list[Remedy]()
    if max(each.share.highest for each in topples) <= SAFE_SHARE:
        return advice
    worst_first = sorted(range(len(topples)), key=lambda k: -topples[k].share.highest)
    motions = [setting.motions[k] for k in worst_first]
    for each in remedies(item, motions, setting.polarities, setting.around):
        advice.append(each)
        if each.suffices and not each.against and not setting.every_remedy:
            break
    return advice


def _topples(conditions: Conditions, motion: GroundMotion, limits: Limits) -> Topples:
    """Return how strong a motion must be; a body that only slides, and may slide as far as it will, never falls."""
    ground, model = motion.of_ground, conditions.model
    pgv, tried = float(np.abs(ground.velocity).max()), (float(FACTORS[0]), float(FACTORS[-1]))
    if limits == Limits() and motion.vertical is None and (foot := model.sliding) is not None:
        slender = conditions.around.drawn(model).slender
        free = all(each.distance == inf for each in foot.clear)
        if free and foot.holds(slender, *np.zeros((2, 1))).all():
            never = NeighbourShare(0.0, 0.0, conditions.around.count)
            return Topples(motion.name, ground.pga_g, pgv, dict.fromkeys(LEVELS), tried, never, motion.pga_g)
    first: dict[float, float | None] = dict.fromkeys(LEVELS)
    share: NeighbourShare | None = None
    for part in (FACTORS[FACTORS <= 1], *np.array_split(FACTORS[FACTORS > 1], 3)):
        shares = margin(conditions, motion, factors=part, limits=limits, threads=1)
        share = share or shares.share
        first |= {level: shares.first(level, unknown=True) for level in LEVELS if first[level] is None}
        if first[LEVELS[-1]] is not None:
            break  # larger factors decide nothing
    assert share is not None
    if first[LEVELS[0]] == FACTORS[0]:
        shares = margin(conditions, motion, factors=WEAK_FACTORS, limits=limits, threads=1)
        lower = {level: shares.first(level, unknown=True) for level in LEVELS}
        first |= {level: factor for level, factor in lower.items() if factor is not None and factor < 1}
        tried = float(WEAK_FACTORS[0]), tried[1]
    return Topples(motion.name, ground.pga_g, pgv, first, tried, share, motion.pga_g)


def _alone(
    place: int, entry: SurveyEntry, structure: Structure, setting: Setting, site: SiteFile | None
) -> Surveyed:  # fmt: skip
    """Return the results of a structure without ground motions."""
    mechanism, sides = structure.mechanism, structure.statics
    floor = getattr(site.site, "floor", None) if site is not None else None
    k = int(sides[1].lambda_ < sides[0].lambda_ * (1 - 1e-9))
    direction, side = mechanism.sides[k], sides[k]
    why = structure.why_no_block
    block = structure.equivalence[direction] if why is None else None
    verification = verify(structure, of_each(site)) if site is not None else None
    return Surveyed(
        place + 1,
        entry.line,
        structure.name,
        mechanism.mechanism,
        direction.label,
        side.lambda_,
        side.lambda_ * mechanism.gravity / STANDARD_GRAVITY,
        block.p if block is not None else nan,
        side.phi_cr if side.phi_cr is not None else nan,
        block.kappa1 if block is not None else nan,
        block.kappa2 if block is not None else nan,
        structure.etas[k],
        why.removeprefix(f"{structure.name}: ") if why is not None else None,
        cautions=setting.cautions(mechanism),
        any_friction=mechanism.friction is None and len(mechanism.bodies()) == 1 and not mechanism.attached,
        ratio=verification.ratio if verification is not None else None,
        verified=verification.conclusion if verification is not None else None,
        unprinted=verification is not None and verification.unprinted,
        numbers=row_numbers(verification, code_of(site)) if verification is not None and site is not None else {},
        site=site.document.file if site is not None else None,
        code=site.site.code if site is not None else None,
        z=floor.z if floor is not None else 0.0 if hasattr(site and site.site, "floor") else None,
    )


def _may_move(structure: Structure, setting: Setting) -> bool:
    """Return whether a motion or a neighbour of one may move a structure; if none can, it needs no model."""
    if setting.motions and sliding_of(structure.mechanism) is not None:
        return True
    least, around = min(structure.uplift) * (1 - 1e-9), setting.around
    if around.count:
        slenderness = scatter_of(structure.mechanism).slenderness if around.slenderness is None else around.slenderness
        least *= exp(-MAX_DEVIATIONS * (around.amplitude + slenderness))
    return any(each.vertical is not None or each.pga_g >= least for each in setting.motions)


def _under(
    structures: Sequence[Structure], setting: Setting, limits: Sequence[Limits] = ()
) -> list[SurveyResponse | SolverError]:
    """Return the response of each of some structures to ground motions; an error if a motion cannot be simulated.

    `limits` are those of each motion, of a single structure.
    """
    if not structures:
        return []
    models = [structure.model("nonlinear") for structure in structures]
    motions, polarities = setting.motions, setting.polarities
    places = [
        (i, j, sign)
        for i, model in enumerate(models)
        for j in range(len(motions))
        for sign in (polarities[:1] if len(polarities) > 1 and model.symmetric else polarities)
    ]
    which = np.array(places)
    runs = Runs.of(which[:, 0], which[:, 1], polarity=which[:, 2])
    outcomes = respond_many(models, motions, runs, threads=1, only_peaks=True)
    if limits:
        held, ends = (np.array([getattr(each, key) for each in limits])[which[:, 1]] for key in Limits._fields[1:])
        outcomes = limited(outcomes, Limits(limits[0].clearance, held, ends), np.ones(len(which)))
    each = [_of_one(model, which[:, 0] == i, which[:, 1], outcomes, motions) for i, model in enumerate(models)]
    for i, (structure, one) in enumerate(zip(structures, each, strict=True)):
        if setting.around.count and isinstance(one, SurveyResponse):
            try:
                each[i] = replace(one, share=_share(structure, np.unique(which[which[:, 0] == i, 2]), setting))
            except SolverError as error:
                each[i] = error
    return each


def _share(structure: Structure, signs: Integers, setting: Setting) -> NeighbourShare:
    """Return the share of the neighbours that overturn a structure: of the worse polarity, the mean over motions."""
    conditions = Conditions(structure, ["nonlinear"], around=setting.around)
    low, high = [], []
    for motion in setting.motions:
        by_sign = [neighbours(conditions, motion.scaled(int(sign)), threads=1) for sign in signs]
        low.append(max(each.overturned for each in by_sign))
        high.append(max(each.at_most for each in by_sign))
    return NeighbourShare(fmean(low), fmean(high), setting.around.count)


def _of_one(
    model: Model, own: np.ndarray, record: np.ndarray, outcomes: Outcomes, motions: Sequence[GroundMotion]
) -> SurveyResponse | SolverError:
    """Return the response of one structure to ground motions; the mask `own` selects its runs."""
    if (outcomes.failed & own).any():
        name = motions[int(record[int((outcomes.failed & own).argmax())])].name
        return SolverError(f"{model.structure}: its motion under {name} could not be simulated")
    fell = np.unique(record[own & outcomes.fell])
    doubtful = np.setdiff1d(record[own & outcomes.unknown], fell)
    stays = own & ~np.isin(record, fell) & ~np.isin(record, doubtful)
    peaks = np.where(stays, outcomes.peak_ratio, -1.0)
    strongest = int(np.lexsort((-np.arange(own.size), outcomes.slip, peaks))[-1])  # the first of equal ones
    worst = motions[int([*fell, *doubtful, record[strongest]][0])].name
    over = "limit" if any(model.ends_at_limit) else "phi_cr"
    unknown = doubtful.size / len(motions) if doubtful.size or model.joints is not None else None
    peak, slip = float(peaks[strongest]) if stays.any() else nan, float((outcomes.slip * stays).max())
    return SurveyResponse(fell.size / len(motions), peak, worst, over, unknown, slip=slip)


@dataclass(frozen=True)
class MadeStructure:
    """A structure that is already built.

    Parameters
    ----------
    mechanism : Mechanism
        The structure.
    """

    mechanism: Mechanism
    line: int | None = None

    @property
    def name(self) -> str:
        """Name of the structure, or of its mechanism."""
        return self.mechanism.name or self.mechanism.mechanism

    def make(self) -> Mechanism:
        """Return the structure."""
        return self.mechanism

    def site(self, usual: SiteFile | None) -> SiteFile | None:
        """Return the site of all structures."""
        return usual
