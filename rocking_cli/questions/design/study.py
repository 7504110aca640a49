"""Values of one field of a structure for which it meets a requirement: the least thickness, the largest load."""

from __future__ import annotations

import operator
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache
from math import inf, isfinite, isnan, nan
from typing import NamedTuple

import numpy as np

from rocking_cli.arrays import Bools, Reals
from rocking_cli.core import Mechanism
from rocking_cli.core.hung.element import Spring
from rocking_cli.core.hung.ties import BAR_DIAMETERS, STEELS, SteelName, TieStrength, circle, tie_strength
from rocking_cli.errors import InputError, MechanismError, Problem, SolverError
from rocking_cli.io.yaml_file import words
from rocking_cli.names import percent
from rocking_cli.questions.design.metrics import Excitation, Metric, metric, required
from rocking_cli.short_repr import short_repr
from rocking_cli.structure import Structure
from rocking_cli.studies.conclusion import Concluded, Conclusion, LeftOut, Limit
from rocking_cli.studies.neighbours import Neighbours
from rocking_cli.text import cut
from rocking_cli.units import UnitError, read, split
from rocking_cli.verification.check import verify
from rocking_cli.verification.code import SiteFile

OPERATORS: dict[str, Callable[[float, float], bool]] = {
    "<=": operator.le, ">=": operator.ge, "<": operator.lt, ">": operator.gt,
}  # fmt: skip
REQUIRED = "required"
"""The level of a requirement that is the ratio required by the code of the site."""
NO_EXCITATION = Excitation()
SCAN_POINTS = 41
EDGE_TOLERANCE = 1e-12  # share of the range to which an edge is found
EDGE_TOLERANCE_OF_SHARES = 1e-3  # shares of histories change in steps, so that more precision has no meaning
TREND_TOLERANCE = 1e-9  # relative size of steps against the trend that rounding may cause
_AIM = re.compile(r"\s*([A-Za-z]\w*)\s*(<=|>=|<|>)\s*(\S.*?)\s*")


@short_repr
@dataclass(frozen=True)
class Aim:
    """A requirement on a metric, such as `lambda >= 0.2`.

    Parameters
    ----------
    metric : Metric
        The quantity that the requirement limits.
    op : str
        One of `<`, `<=`, `>`, `>=`.
    level : float
        The limit, in the unit of the metric; NaN for what the code of the site requires of the structure as given.
    """

    metric: Metric
    op: str
    level: float

    @classmethod
    def parse(cls, text: str) -> Aim:
        """Read a requirement such as `lambda >= 0.2`. Raises `InputError` if the text is not one."""
        match = _AIM.fullmatch(text)
        if match is None:
            hint = "write METRIC OP NUMBER, such as `lambda >= 0.2`, with <, <=, > or >="
            raise InputError(Problem(f"{cut(repr(text))} is not a valid requirement", hint=hint))
        chosen, number = metric(match[1]), match[3]
        if number == REQUIRED and not chosen.sited:
            hint = "give a number, or a metric of a verification, such as `ratio`"
            raise InputError(Problem(f"no code requires a value of {chosen.name}", hint=hint))
        return cls(chosen, match[2], nan if number == REQUIRED else _number(number, chosen.unit))

    def __str__(self) -> str:
        level, unit = (self.level / 1e3, "kN") if self.metric.unit == "N" else (self.level, self.metric.unit)
        return f"{self.metric.name} {self.op} {level:.6g} {unit}".rstrip()

    @property
    def wants_more(self) -> bool:
        """Whether the metric must exceed the level."""
        return self.op[0] == ">"

    def holds(self, value: float) -> bool:
        """Return whether a value of the metric meets the requirement; NaN does not."""
        return OPERATORS[self.op](value, self.level)


def _number(text: str, unit: str) -> float:
    """Read a number or a quantity in a unit; a number without a unit may be given in per cent."""
    plain = text.removesuffix("%").strip()
    try:
        if (parts := split(plain)) is not None and not parts[1] and (plain == text.strip() or not unit):
            value = float(plain) / (1 if plain == text.strip() else 100)
        else:
            value = read(text, unit)
    except UnitError as error:
        raise InputError(Problem(error.message, hint=error.hint)) from None
    if not isfinite(value):
        raise InputError(Problem(f"{cut(repr(text))} is not a finite number"))
    return value


@dataclass(frozen=True)
class Span:
    """A field and the range over which it varies, as the user wrote them.

    Parameters
    ----------
    field : str
        Name of the field, with dots for a field inside another one.
    low, high : str
        Both ends of the range: numbers or quantities with a unit.
    """

    field: str
    low: str
    high: str

    @classmethod
    def parse(cls, text: str) -> Span:
        """Read a text such as `width=0.2m:0.8m`. Raises `InputError` if it is not a range of a field."""
        name, equals, values = text.partition("=")
        ends = values.split(":")
        if not equals or not name.strip() or len(ends) != 2 or not all(each.strip() for each in ends):
            hint = "write FIELD=LOW:HIGH, such as width=0.2m:0.8m"
            raise InputError(Problem(f"{cut(repr(text))} is not a valid FIELD=LOW:HIGH", hint=hint))
        return cls(name.strip(), ends[0].strip(), ends[1].strip())

    def __str__(self) -> str:
        return f"{self.field}={self.low}:{self.high}"

    def in_unit(self, unit: str) -> tuple[float, float]:
        """Return both ends as numbers. Raises `InputError` if they are not numbers, or are not increasing."""
        low, high = _number(self.low, unit), _number(self.high, unit)
        if not low < high:
            hint = "give the smaller value first"
            raise InputError(Problem(f"{self.low}:{self.high} is not increasing", field=self.field, hint=hint))
        return low, high


@dataclass(frozen=True)
class NotBuilt:
    """A part of the range in which the metric does not exist.

    Parameters
    ----------
    low, high : float
        The first and the last of the values tried in this part.
    reason : str
        Why the metric does not exist at the first of them.
    """

    low: float
    high: float
    reason: str


@short_repr
@dataclass(frozen=True, eq=False)
class Design:
    """The values of a field at which a requirement is met.

    Parameters
    ----------
    structure : str
        Name of the structure.
    field, unit : str
        The field that varies, and its unit.
    aim : Aim
        The requirement.
    given : float or None
        Value of the field in the structure as given.
    values, metric : ndarray, shape (n,)
        The scan: values of the field at equal steps, and the metric there; NaN where it does not exist.
    holds : sequence of (float, float)
        The ranges in which the requirement is met, as far as the scan can tell.
    monotone : bool
        Whether the metric is monotonic over the scan, so that there is at most one range.
    value : float or None
        The edge of the range that reaches an end of the scan: the least value from which the requirement is met, or the
        largest up to which it is met. None if it is met nowhere, everywhere, or at neither end.
    not_built : sequence of NotBuilt
        The parts of the scan in which the metric does not exist.
    behind : sequence of (Neighbours or None)
        The neighbours of the motion that governs at each value; None of a metric that needs no motions.
    caution : str
        A caution about the lambda of the structure as given; empty if there is none.
    depth_governs : sequence of (float, float)
        The ranges in which the structure is judged as it rocks about its depth, the weaker side of its base.
    taken_otherwise : sequence of LeftOut
        What the code does not count of the structure, at either end of the scan.
    motions : sequence of str
        Names of the motions, of which the worst governs at each value.
    steel : SteelAnswer or None
        Bars of steel, if the field varies the force of a tie and the answer is the least that meets the requirement.
    limits : sequence of Limit
        What limits the verification at `decisive`, see `Verification`.
    before : float or None
        The ratio of the structure as given, if what is required after an intervention depends on it.
    """

    structure: str
    field: str
    unit: str
    aim: Aim
    given: float | None
    values: Reals
    metric: Reals
    holds: Sequence[tuple[float, float]]
    monotone: bool
    value: float | None
    not_built: Sequence[NotBuilt] = ()
    behind: Sequence[Neighbours | None] = ()
    caution: str = ""
    taken_otherwise: Sequence[LeftOut] = ()
    motions: Sequence[str] = ()
    steel: SteelAnswer | None = None
    limits: Sequence[Limit] = ()
    depth_governs: Sequence[tuple[float, float]] = ()
    before: float | None = None

    @property
    def decisive(self) -> float:
        """The answer; without one, the value tried at which the metric is closest to its limit, of these the first."""
        return _closest(self.values, self.metric, self.aim.level) if self.value is None else self.value

    @property
    def everywhere(self) -> bool:
        """Whether the requirement is met at every value of the scan."""
        return bool(self.met.all())

    @property
    def met(self) -> Bools:
        """Whether the requirement is met at each value of the scan."""
        return np.array([self.aim.holds(each) for each in self.metric.tolist()])

    @property
    def conclusion(self) -> Conclusion:
        """Whether the requirement is met at any value, and what limits it; unknown if outcomes are unknown."""
        if self.holds:
            what = Concluded.SATISFIED
        elif any(each is not None and each.unknown and not each.half_overturn for each in self.behind):
            what = Concluded.UNKNOWN
        else:
            what = Concluded.NOT_SATISFIED
        return Conclusion(concluded=what, motions=self.motions).limited(self.limits)

    @property
    def is_least(self) -> bool:
        """Whether `value` is the least that meets the requirement; otherwise it is the largest that does."""
        return bool(self.met[-1])


def design(
    structure: Structure,
    field: str,
    span: tuple[float, float],
    aim: Aim,
    excitation: Excitation = NO_EXCITATION,
    *,
    points: int = SCAN_POINTS,
    progress: Callable[[int], None] | None = None,
) -> Design:
    """Find the values of a field at which a structure meets a requirement.

    Parameters
    ----------
    structure : Structure
        The structure.
    field : str
        Path of the numeric field that varies, see `Structure.unit_of`.
    span : (float, float)
        Smallest and largest value to try, in the unit of the field.
    aim : Aim
        The requirement.
    excitation : Excitation
        Ground motions and site, for metrics that need them.
    points : int
        Number of values of the scan, at equal steps over the span.
    progress : callable, optional
        Called with the number of values of the scan computed since the last call.

    Raises
    ------
    InputError
        If the structure lacks what the metric requires, or the site is for another code than that of the metric.

    Notes
    -----
    If one of two consecutive values of the scan meets the requirement and the other does not, the edge between them is
    found by Brent's method, or by bisection if the metric is a step function. If both or neither meet it, the interval
    is not searched: a metric that is not monotonic there may hide a range. If a metric of time histories is not
    monotonic over the scan, edges are values of the scan, because a root would be one of many.

    A structure that may rock about its depth is judged about the weaker side of its base, as in `survey`.

    An unknown outcome meets no requirement: it counts as overturning if the metric must be small, and the metric does
    not exist if it must be large.
    """
    site, before = excitation.site if aim.metric.sited else None, None
    if site is not None:
        if aim.metric.codes and site.site.code not in aim.metric.codes:
            codes = " and ".join(aim.metric.codes)
            message = f"{aim.metric.name} is a number of {codes}, but the site is for {site.site.code}"
            raise InputError(Problem(message, hint="every code has a `ratio`"))
        if isnan(aim.level):
            level, before = required(_by_weaker_side(structure), site)
            aim = replace(aim, level=level)
    _check_has_metric(structure, field, span, aim.metric)

    @cache  # edges are searched from values of the scan
    def tried(value: float) -> tuple[float, Neighbours | None, str | None]:
        return _at(structure, field, value, aim, excitation)

    def metric(value: float) -> float:
        return tried(value)[0]

    values, whole = np.linspace(*span, points), structure.is_whole(field)
    values = np.unique(values.round()) if whole else values
    numbers, reasons, behind = np.full(len(values), nan), dict[int, str](), list[Neighbours | None]()
    for k, value in enumerate(values.tolist()):
        numbers[k], neighbours, reason = tried(value)
        behind.append(neighbours)
        if reason is not None:
            reasons[k] = reason
        if progress is not None:
            progress(1)
    monotone = _is_monotone(numbers)

    def edge(inside: int, outside: int) -> float:
        ends = float(values[inside]), float(values[outside])
        if aim.metric.shaken and (not monotone or isnan(numbers[outside])):
            return ends[0]
        if whole:
            return float(round(_last_that_holds(lambda x: metric(round(x)), aim, *ends, 0.25)))  # less than one apart
        if aim.metric.shaken or isnan(numbers[outside]):
            closest = (EDGE_TOLERANCE_OF_SHARES if aim.metric.shaken else EDGE_TOLERANCE) * abs(ends[1] - ends[0])
            return _last_that_holds(metric, aim, *ends, closest)
        return _edge(metric, aim, *ends)

    def turned(value: float) -> bool:
        try:
            return structure.varied(field, value).mechanism.weaker_side() is not None
        except (InputError, MechanismError):  # the reason is listed in `not_built`
            return False

    def turns(inside: int, outside: int) -> float:
        ends, closest = (float(values[inside]), float(values[outside])), EDGE_TOLERANCE * float(np.ptp(values))
        return ends[0] if whole else _last(turned, *ends, closest)

    met = [aim.holds(number) for number in numbers.tolist()]
    holds = _ranges(values, met, edge)
    value = None if all(met) or not holds else holds[-1][0] if met[-1] else holds[0][1] if met[0] else None
    return Design(
        structure.name, field, structure.unit_of(field), aim, structure.value_of(field), values, numbers, holds,
        monotone, value, _not_built(values, reasons), behind,
        structure.mechanism.own_caution() if structure.mechanism.weaker_side() is None else "",
        _taken_otherwise(structure, field, span, site), [each.name for each in excitation.motions],
        None if value is None else steel_answer(
            structure, field, value, float(values[-1] if met[-1] else values[0]), of_code=aim.metric.of_code
        ),
        _limits(structure, field, _closest(values, numbers, aim.level) if value is None else value, site),
        _ranges(values, [*map(turned, values.tolist())], turns),
        before,
    )  # fmt: skip


def _check_has_metric(structure: Structure, field: str, span: tuple[float, float], metric: Metric) -> None:
    """Raise `InputError` if the structure lacks what a metric requires at both ends of the range."""
    if metric.lacks is None:
        return
    reasons = []
    for value in span:
        try:
            reasons.append(metric.lacks(structure.varied(field, value)))
        except (InputError, MechanismError):  # the scan lists the values that cannot be built
            return
    if all(reasons):
        raise InputError(f"{metric.name} {reasons[0]}")


def _taken_otherwise(
    structure: Structure, field: str, span: tuple[float, float], site: SiteFile | None
) -> Sequence[LeftOut]:
    """Return the ties of the structure that the code does not count in full, at either end of the range, each once."""
    reasons: dict[LeftOut, None] = {}
    for value in span:
        try:
            left_out = [] if site is None else verify(structure.varied(field, value), site).left_out
            reasons |= dict.fromkeys(each for each in left_out if each.what == "tie")
        except (InputError, MechanismError):  # the reason is listed in `not_built`
            continue
    return list(reasons)


def _closest(values: Reals, metric: Reals, level: float) -> float:
    """Return the value at which a metric is closest to a level; the first one if it exists at none."""
    return float(values[np.nan_to_num(np.abs(metric - level), nan=inf).argmin()])


def _limits(structure: Structure, field: str, value: float, site: SiteFile | None) -> Sequence[Limit]:
    """Return what limits the verification at a value; nothing without a site, or where it cannot be made."""
    try:
        return () if site is None else verify(_by_weaker_side(structure.varied(field, value)), site).limits
    except (InputError, MechanismError):  # the reason is listed in `not_built`
        return ()


def _by_weaker_side(structure: Structure) -> Structure:
    """Return the structure as it rocks about the weaker side of its base."""
    weaker = structure.mechanism.weaker_side()
    return structure if weaker is None else structure.of(weaker)


def _at(
    structure: Structure, field: str, value: float, aim: Aim, excitation: Excitation
) -> tuple[float, Neighbours | None, str | None]:
    """Return the metric at a value of the field, and the neighbours it was counted from; or NaN and the reason."""
    try:
        varied = _by_weaker_side(structure.varied(field, value))
        number, neighbours = aim.metric.at(varied, excitation)
    except InputError as error:
        return nan, None, "; ".join(str(Problem(problem.message, field=problem.field)) for problem in error.problems)
    except (MechanismError, SolverError) as error:
        return nan, None, str(error)
    if isnan(number):
        if aim.metric.sited:
            return nan, None, f"the site does not give what {aim.metric.name} requires"
        return nan, None, varied.why_no_block or f"{aim.metric.name} does not exist"
    if neighbours is not None and neighbours.unknown and aim.wants_more:
        return nan, neighbours, f"{percent(neighbours.unknown)} of the neighbouring motions have an unknown outcome"
    return number, neighbours, None


def _is_monotone(metric: Reals) -> bool:
    """Return whether a metric is monotonic over the scan; a gap without values counts as not monotonic."""
    there = np.flatnonzero(~np.isnan(metric))
    if there.size and there[-1] - there[0] + 1 > there.size:
        return False
    metric = metric[there]
    with np.errstate(invalid="ignore"):
        # The difference of two infinities is NaN.
        steps = np.where(metric[1:] == metric[:-1], 0.0, metric[1:] - metric[:-1])
    finite = np.abs(metric[np.isfinite(metric)])
    small = TREND_TOLERANCE * float(finite.max(initial=0.0))
    return bool((steps >= -small).all() or (steps <= small).all())


def _ranges(values: Reals, met: Sequence[bool], edge: Callable[[int, int], float]) -> list[tuple[float, float]]:
    """Return the ranges of consecutive values at which the requirement is met, each extended to its edges."""
    ranges = []
    for k, here in enumerate(met):
        if not here or (k and met[k - 1]):
            continue
        last = next((j for j in range(k, len(met)) if not met[j]), len(met)) - 1
        low = edge(k, k - 1) if k else float(values[0])
        high = edge(last, last + 1) if last + 1 < len(met) else float(values[-1])
        ranges.append((low, high))
    return ranges


def _edge(at: Callable[[float], float], aim: Aim, inside: float, outside: float) -> float:
    """Return the edge between a value that meets a requirement and one that does not.

    The metric may be infinite at both values, but not NaN.
    """
    from scipy.optimize import brentq

    bound = 1 + abs(aim.level)

    def beyond(x: float) -> float:
        away = at(x) - aim.level
        return inf if isnan(away) else min(max(away, -bound), bound)

    for end in (inside, outside):  # if the metric equals the level here, the operator decides
        if beyond(end) == 0.0:
            return end
    closest = EDGE_TOLERANCE * abs(outside - inside)
    return float(brentq(beyond, inside, outside, xtol=closest, rtol=4 * np.finfo(float).eps, maxiter=200))


def _last_that_holds(at: Callable[[float], float], aim: Aim, inside: float, outside: float, closest: float) -> float:
    """Return by bisection the last value that meets a requirement, if the metric is a step function or NaN outside."""
    return _last(lambda value: aim.holds(at(value)), inside, outside, closest)


def _last(holds: Callable[[float], bool], inside: float, outside: float, closest: float) -> float:
    """Return by bisection the last value at which a condition holds."""
    while abs(outside - inside) > closest:
        middle = (inside + outside) / 2
        if middle in (inside, outside):
            break
        inside, outside = (middle, outside) if holds(middle) else (inside, middle)
    return inside


def _not_built(values: Reals, reasons: dict[int, str]) -> list[NotBuilt]:
    """Return the ranges of consecutive values that have no metric, each with the reason at its first value."""
    groups: list[NotBuilt] = []
    for k in sorted(reasons):
        if k - 1 in reasons and groups:
            groups[-1] = NotBuilt(groups[-1].low, float(values[k]), groups[-1].reason)
        else:
            groups.append(NotBuilt(float(values[k]), float(values[k]), reasons[k]))
    return groups


MAX_BARS = 4  # largest number of bars proposed for a tie that does not give it
MAX_PROPOSALS = 2  # the fewest bars that suffice, and more bars of a smaller diameter
DEFAULT_STEEL: SteelName = "S235"


class Bars(NamedTuple):
    """Bars of one tie: number (not whole if it follows from a spacing), diameter [m] and strength."""

    number: float
    diameter: float
    strength: TieStrength


@short_repr
@dataclass(frozen=True)
class SteelAnswer:
    """The force that a tie needs, and bars that give it.

    Parameters
    ----------
    tie : str
        Name of the tie.
    force : float
        The force that it needs [N].
    steel : str or None
        Name of the steel; None if the tie gives its yield stress.
    stress : float
        Yield stress of the steel [Pa].
    spacing : float or None
        Distance between the bars, if the tie gives it [m].
    anchored : bool
        Whether the plates of the tie, one for each bar, are counted.
    proposals : sequence of Bars
        Bars whose strength is at least the force, the fewest first; empty if no bars of the list suffice.
    """

    tie: str
    force: float
    steel: str | None
    stress: float
    spacing: float | None
    anchored: bool
    proposals: Sequence[Bars]


def steel_answer(
    structure: Structure, field: str, value: float, other: float, *, of_code: bool = False
) -> SteelAnswer | None:
    """Return the bars that give the least force of a tie that meets a requirement.

    Parameters
    ----------
    structure : Structure
        The structure.
    field : str
        The field that varies.
    value, other : float
        The value that is the answer, and the other end of the range in which the requirement is met.
    of_code : bool
        Whether the requirement is on a number of a code, for which ties of steel act with their strength.

    Returns
    -------
    SteelAnswer or None
        None unless the field varies the constant force of a tie, and the answer is the least.
    """
    path = words(field)
    if path[0] != "ties" or len(path) < 3 or path[2] in ("plate", "wall"):
        return None
    chosen, largest = (structure.varied(field, each).mechanism for each in (value, other))
    if of_code:
        chosen, largest = chosen.at_strength(), largest.at_strength()
    ties = {tie.name: tie for tie in chosen.ties or []}
    tie = ties[path[1]] if path[1] in ties else list(ties.values())[int(path[1])]
    force, more = (_constant_force(each, tie.name) for each in (chosen, largest))
    if force is None or more is None or not 0 < force < more:
        return None
    stress = tie.yield_of_steel if tie.is_steel else STEELS[DEFAULT_STEEL]
    steel = tie.steel if tie.is_steel else DEFAULT_STEEL
    spacing = tie.spacing if path[2] != "spacing" else None
    known = tie.bars is not None or spacing is not None
    counts = [tie.number_of_bars(chosen.depth)] if known else [float(count) for count in range(1, MAX_BARS + 1)]
    proposals: list[Bars] = []
    for count in counts:
        reduced = stress / (tie.gamma or 1)
        every = (Bars(count, d, tie_strength(circle(d), reduced, count, tie.plate, tie.wall)) for d in BAR_DIAMETERS)
        bars = next((bars for bars in every if bars.strength.force >= force), None)  # the thinnest
        if bars is not None and (not proposals or bars.diameter < proposals[-1].diameter):
            proposals.append(bars)
    return SteelAnswer(tie.name, force, steel, stress, spacing, tie.plate is not None, proposals[:MAX_PROPOSALS])


def _constant_force(mechanism: Mechanism, name: str) -> float | None:
    """Return the force of a tie that does not depend on its elongation [N]; None if it does."""
    element = next(each for each in mechanism.hung.ties if each.name == name)
    return element.prestress if isinstance(element, Spring) and element.stiffness == 0 else None
