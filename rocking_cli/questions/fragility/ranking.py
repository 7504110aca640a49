"""Ranking of intensity measures, in numbers, tables and data: how well each predicts the peak rotation.

Terms are those of Luco and Cornell (2007) and Padgett, Nielson and DesRoches (2008). Over the runs that rock without
overturning, ln(peak phi/phi_cr) = a + b ln(measure) is fitted by least squares.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import nan, sqrt
from textwrap import wrap

import numpy as np

from rocking_cli.arrays import Integers, Reals
from rocking_cli.errors import named
from rocking_cli.names import UNKNOWN, percent
from rocking_cli.processing.intensity import RunMeasure, all_measures, parse_measure
from rocking_cli.questions.fragility.assess import Fragility, counted, curves
from rocking_cli.questions.fragility.definition import Definition, Limit
from rocking_cli.questions.fragility.plan import ORIGIN, V_IMP, Plan
from rocking_cli.questions.fragility.store import STANDS, Store
from rocking_cli.questions.fragility.tally import samples_of
from rocking_cli.questions.fragility.view import limit_name
from rocking_cli.short_repr import short_repr
from rocking_cli.studies.fragility.quantities import PGA, PGV
from rocking_cli.text import in_short
from rocking_cli.views.column import Column, data_of, of, only_shown, rounded, table_of
from rocking_cli.views.view import Table, View

MIN_P_VALUE = 0.05  # least p-value of residuals without a trend
OF_MOTION = ("Tm", "D5-95")
"""Measures against which residuals are tested if not all records state magnitude and distance."""
LOGARITHMIC = ("magnitude",)  # quantities that are logarithms already
MIN_RUNS = 3  # least number of runs, and of records
RATIO_TOLERANCE = 1e-9  # variation of ln of a ratio: measures whose ratio varies less count as one
MAX_HEADING_WIDTH = 12  # characters
CONFIDENCE = 0.95  # with which the efficiencies of two measures differ


@short_repr
@dataclass(frozen=True)
class Ranked:
    """Quality of one measure as a predictor of the peak rotation of one structure.

    Parameters
    ----------
    measure : str
        Name of the measure.
    efficiency : float
        Standard deviation of ln(peak phi/phi_cr) about the line, with two degrees of freedom less than runs.
    practicality : float
        Slope of the line.
    runs, records : int
        Number of runs that rock without overturning, and of their records.
    trends : dict of str to float
        For each quantity against which the residuals, averaged for each record, are tested: the p-value of their slope;
        NaN if it cannot be computed.
    dispersions : dict of limit state to float
        Dispersion of the fragility curve of each limit state over the measure; NaN if it is not lognormal, or a band,
        or if levels scale the records and the measure does not grow with them.
    """

    measure: str
    efficiency: float
    practicality: float
    runs: int
    records: int
    trends: Mapping[str, float]
    dispersions: Mapping[Limit, float]

    @property
    def proficiency(self) -> float:
        """Efficiency over practicality; NaN if the rotation does not increase with the measure."""
        return self.efficiency / self.practicality if self.practicality > 0 else nan

    @property
    def sufficient(self) -> bool | None:
        """Whether the residuals show no trend; None if no trend could be tested."""
        known = [p for p in self.trends.values() if p == p]
        return min(known) >= MIN_P_VALUE if known else None


@short_repr
@dataclass(frozen=True)
class Ranking:
    """The ranked measures of one structure.

    Parameters
    ----------
    structure : str
        Name of the structure.
    measures : tuple of Ranked
        The measures, the most efficient first.
    against : tuple of str
        Names of the quantities against which residuals are tested.
    alike : dict of str to str
        Measures that are proportional to another one in every run, with the name of that one.
    left_out : dict of str to str
        Measures that cannot be ranked, and why.
    unknown : int or None
        Runs of unknown outcome, which are left out; None if the joints of the structure are not known.
    equal : tuple of str
        Measures whose efficiency cannot be told from that of the first, by leaving out each record in turn.
    lacking : tuple of str
        Installed measures that the store does not have.
    """

    structure: str
    measures: tuple[Ranked, ...]
    against: tuple[str, ...]
    alike: Mapping[str, str]
    left_out: Mapping[str, str]
    unknown: int | None = 0
    equal: tuple[str, ...] = ()
    lacking: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class FittedLine:
    """A straight line through points, by least squares: intercept, slope, and the deviation of the points from it.

    `p_value` is that of Student's test of no slope, with two degrees of freedom less than points.
    """

    intercept: float
    slope: float
    deviation: float
    p_value: float


def line(x: Reals, y: Reals) -> FittedLine | None:
    """Fit a straight line by least squares; return None for fewer than three points, or if all x are equal."""
    from scipy.special import stdtr

    free = x.size - 2
    spread = x - x.mean() if x.size else x
    squares = float(spread @ spread)
    if free < 1 or squares <= (RATIO_TOLERANCE * x.size) ** 2:
        return None
    slope = float(spread @ y) / squares
    rest = y - y.mean() - slope * spread
    deviation = sqrt(float(rest @ rest) / free)
    error = deviation / sqrt(squares)
    p_value = 2 * float(stdtr(free, -abs(slope) / error)) if error > 0 else 0.0
    return FittedLine(float(y.mean()) - slope * float(x.mean()), slope, deviation, p_value)


def deviations_without(x: Reals, y: Reals, record: Integers) -> Reals:
    """Return the deviations from a line with each record left out, shape (records,); record has numbers from 0."""
    x, y = x - x.mean(), y - y.mean()
    terms = (np.ones(x.size), x, y, x * x, x * y, y * y)
    sums = np.stack([np.bincount(record, weights=each) for each in terms])
    n, sx, sy, xx, xy, yy = sums.sum(axis=1, keepdims=True) - sums
    with np.errstate(divide="ignore", invalid="ignore"):
        cross, across, along = xy - sx * sy / n, xx - sx * sx / n, yy - sy * sy / n
        return np.asarray(np.sqrt(np.maximum(along - cross * cross / across, 0) / (n - 2)))


def is_clear(difference: float, without: Reals) -> bool:
    """Return whether a difference is not zero by a jackknife, at 95 %; `without` has it with each record left out."""
    from scipy.special import stdtrit

    free = without.size - 1
    error = sqrt(free / (free + 1) * float(np.sum((without - without.mean()) ** 2)))
    return free > 0 and bool(abs(difference) > stdtrit(free, 0.5 + CONFIDENCE / 2) * error)


def candidates(plan: Plan, definition: Definition) -> list[str]:
    """Return the measures that can be ranked: those of the study and all installed ones whose values are known."""
    names = [*definition.asked_measures, *(str(each) for each in all_measures())]

    def known(name: str) -> bool:
        measure, measured = parse_measure(name), plan.measured
        if isinstance(measure, RunMeasure):
            return name in measured.of_run
        if V_IMP in measure.needs and V_IMP not in measured.of_sample:
            return False
        return str(measure.base) in (PGA, PGV, *measured.of_record)

    return list(filter(known, dict.fromkeys(names)))


def covariates(plan: Plan) -> dict[str, Reals]:
    """Return, by name, the data of each record against which residuals are tested; empty if the data have gaps."""
    usable = np.array([record.reason is None for record in plan.records])
    for names in (ORIGIN, OF_MOTION):
        known = {name: plan.of_records(name) for name in names}
        if all(np.isfinite(values[usable]).all() and (values[usable] > 0).all() for values in known.values()):
            logs = {name: np.log(np.where(usable, values, 1.0)) for name, values in known.items()}
            return logs | {name: known[name] for name in LOGARITHMIC if name in known}
    return {}


def rank(
    store: Store, plan: Plan, definition: Definition, progress: Callable[[int], None] = lambda count: None
) -> list[Ranking]:
    """Rank the measures of each structure of a store that has runs.

    Parameters
    ----------
    store : Store
        Open to read.
    plan : Plan
        The plan of its runs.
    definition : Definition
        The definition of its study.
    progress : callable, optional
        Called with the number of runs read since the last call.
    """
    names, against = candidates(plan, definition), covariates(plan)
    fixed = definition.method != "cloud"  # levels scale the records
    lacking = tuple(str(each) for each in all_measures() if str(each) not in names)
    widened = definition.model_copy(update={"measures": names, "bivariate": [], "hazard": None})
    rankings = []
    for structure, tally in counted(store, plan, widened, progress).items():
        if not tally.runs.any():
            continue
        runs, y = rocking(store, plan, structure)
        sample, record, _, level, _ = plan.places(runs)
        factors, one = plan.factors(sample, record, level), plan.sets.one[record]  # one: the same record in any set
        dispersions: defaultdict[str, dict[Limit, float]] = defaultdict(dict)
        for curve in curves(tally, structure, widened, None):
            dispersions[curve.measure][curve.limit] = _dispersion(curve)
        ranked: list[Ranked] = []
        alike: dict[str, str] = {}
        left_out: dict[str, str] = {}
        logs: dict[str, Reals] = {}
        without: dict[str, Reals] = {}
        records, place = np.unique(one, return_inverse=True)
        for name in names:
            x = plan.intensities(name, sample, record, level, factors)
            there = x > 0
            if not there.any():
                left_out[name] = "not known of it, or nowhere above zero"
                continue
            log = np.log(np.where(there, x, 1.0))
            twins = [other for other, its in logs.items() if there.all() and np.ptp(log - its) <= RATIO_TOLERANCE]
            if twins:
                alike[name] = twins[0]
                continue
            served = serves(name, log[there], y[there], one[there], against)
            if served is None:
                left_out[name] = "the same in all runs that rock and stand, or these are fewer than three"
                continue
            if there.all():
                logs[name] = log
            if np.unique(place[there]).size == records.size:
                without[name] = deviations_without(log[there], y[there], place[there])
            power = parse_measure(name).power
            spread = dict.fromkeys(dispersions[name], nan) if power == 0 and fixed else dispersions[name]
            ranked.append(Ranked(name, *served, spread))
        ranked.sort(key=lambda each: each.efficiency)
        equal = [
            each.measure
            for each in ranked[1:]
            if records.size > 2
            and (best := ranked[0]).measure in without
            and each.measure in without
            and not is_clear(each.efficiency - best.efficiency, without[each.measure] - without[best.measure])
        ]
        unknown = tally.unknown_if_checked
        rankings.append(
            Ranking(structure, tuple(ranked), tuple(against), alike, left_out, unknown, tuple(equal), lacking)
        )
    return rankings


def serves(
    measure: str, x: Reals, y: Reals, record: Integers, against: Mapping[str, Reals]
) -> tuple[float, float, int, int, dict[str, float]] | None:
    """Return efficiency, practicality, numbers of runs and records, and trends of a measure; None if no line fits.

    Parameters
    ----------
    measure : str
        Name of the measure; its residuals are not tested against the measure itself.
    x, y : ndarray, shape (n,)
        Logarithms of the measure and of the peak rotation of runs.
    record : ndarray of int, shape (n,)
        The record of each run.
    against : mapping of str to ndarray, shape (records,)
        Quantities against which residuals are tested.
    """
    fit = line(x, y)
    if fit is None:
        return None
    residuals = y - fit.intercept - fit.slope * x
    records, place, count = np.unique(record, return_inverse=True, return_counts=True)
    # One mean per record, as runs of a record are not independent.
    means = np.bincount(place, weights=residuals) / count
    trends = {}
    for name, values in against.items():
        of = line(values[records], means) if name != measure else None
        trends[name] = nan if of is None else of.p_value
    return fit.deviation, fit.slope, int(x.size), int(records.size), trends


def rocking(store: Store, plan: Plan, structure: str) -> tuple[Integers, Reals]:
    """Return the numbers of a structure's runs that rock without overturning, and their ln(peak phi/phi_cr)."""
    samples = samples_of(plan, structure)
    each = len(plan.records) * plan.block
    ids, peaks = [np.zeros(0, dtype=np.int64)], [np.zeros(0)]
    for endings in store.rows(samples.start * each, samples.stop * each):
        rocks = endings.uplifts & (endings.outcome == STANDS) & (endings.peak_ratio > 0)
        ids.append(endings.run[rocks])
        peaks.append(np.log(endings.peak_ratio[rocks]))
    return np.concatenate(ids), np.concatenate(peaks)


def _dispersion(found: Fragility) -> float:
    spread = None if found.is_band else found.curve.dispersion
    return spread.value if spread is not None else nan


COLUMNS: tuple[Column[Ranked], ...] = (
    Column("measure", of("measure"), head="measure", text=True),
    Column("efficiency", of("efficiency"), head="efficiency", form=rounded(3)),
    Column("practicality", of("practicality"), head="practicality", form=rounded(3)),
    Column("proficiency", of("proficiency"), head="proficiency", form=rounded(3)),
    Column("sufficient", of("sufficient")),
    Column("p_values", lambda each: dict(each.trends)),
    Column("dispersions", lambda each: [{"limit_state": k, "dispersion": x} for k, x in each.dispersions.items()]),
    Column("runs", of("runs")),
    Column("records", of("records")),
)


def with_rankings(shown: View, rankings: Sequence[Ranking]) -> View:
    """Add the rankings of the measures to the view of a study."""
    data = [
        {
            "structure": each.structure,
            "against": list(each.against),
            "measures": [data_of(COLUMNS, measure) for measure in each.measures],
            "alike": dict(each.alike),
            "left_out": dict(each.left_out),
            "unknown": each.unknown,
            "equal": list(each.equal),
            "lacking": list(each.lacking),
            "verdict": judge(each),
        }
        for each in rankings
    ]
    return shown.plus(lambda: {"ranking": data}, [part for each in rankings for part in _parts(each)])


def _parts(ranking: Ranking) -> Iterator[Table | str]:
    """Yield a table of the measures of a structure, and sentences on it."""
    yield ""
    yield " ".join(judge(ranking))
    if ranking.measures:
        columns = [*COLUMNS, *(_entry("trends", name, f"p\n{name}", 2) for name in ranking.against)]
        for limit in ranking.measures[0].dispersions:
            head = "\n".join(["dispersion", *wrap(limit_name(limit), MAX_HEADING_WIDTH)])
            columns.append(_entry("dispersions", limit, head, 3))
        yield table_of(f"{ranking.structure}: which measure predicts best", columns, ranking.measures)
    if ranking.alike:
        yield "; ".join(f"{name} ranks equal to {other}" for name, other in ranking.alike.items()) + "."
    for name, why in ranking.left_out.items():
        yield f"{name} is left out: {why}."


def _entry(field: str, key: Limit, head: str, digits: int) -> Column[Ranked]:
    """Return the column of one entry of a mapping of each measure."""
    return only_shown(head, lambda each: getattr(each, field)[key], rounded(digits))


def judge(ranking: Ranking) -> list[str]:
    """Return sentences on a ranking: the most efficient measure, the runs left out, and trends of the residuals."""
    count, best = ranking.unknown or 0, next(iter(ranking.measures), None)
    runs = f"{count:,} run{'s' * (count != 1)} of {UNKNOWN} outcome {'are' if count != 1 else 'is'} left out."
    left_out = [runs] if count else []
    if best is None:
        return [f"{ranking.structure}: no measure can be ranked: fewer than three runs rock and stand.", *left_out]
    over = f"{best.runs:,} runs of {best.records} record{'s' * (best.records != 1)} that rock and stand"
    first = (
        f"Of {len(ranking.measures)} measures {best.measure} is the most efficient over the {over}: "
        f"ln(phi/phi_cr) scatters by {best.efficiency:.2g} about its line."
    )
    sentences = [first]
    if ranking.equal:
        others = [
            f"{each.measure} ({each.efficiency:.2g})" for each in ranking.measures if each.measure in ranking.equal
        ]
        sentences.append(
            f"{in_short(others)} may be as efficient: leaving out each record in turn, {best.records} records do not "
            f"tell {'them' if len(others) > 1 else 'it'} apart from {best.measure} at {percent(CONFIDENCE)}."
        )
    if ranking.lacking:
        there = len(ranking.measures) + len(ranking.alike) + len(ranking.left_out)
        sentences.append(
            f"Only {there} of {there + len(ranking.lacking)} measures are in the store: `rocking fragility` with "
            f"{named('rank_measures')} computes all."
        )
    return [*sentences, *left_out, _of_trends(ranking), "Other records may give another order."]


def _of_trends(ranking: Ranking) -> str:
    """Return a sentence on the most efficient measure among those whose residuals have no trend."""
    over = " or ".join(ranking.against)
    if not over:
        return "What its residuals depend on is not tested: the store has no data to test them against."
    if all(each.sufficient is None for each in ranking.measures):
        return f"With fewer than {MIN_RUNS} records no trend with {' and '.join(ranking.against)} can be told."
    free = [each for each in ranking.measures if each.sufficient]
    if not free:
        return f"The residuals of each have a trend with {over}: none is sufficient."
    best = free[0]
    which = (
        "It" if best is ranking.measures[0] and not ranking.equal else f"{best.measure}, with {best.efficiency:.2g},"
    )
    return (
        f"{which} is the most efficient of the {len(free)} whose residuals show no trend with {over} "
        f"(p of {MIN_P_VALUE:g} or more); the absence of a detected trend does not prove that there is none."
    )
