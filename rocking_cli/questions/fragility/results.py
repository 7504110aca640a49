"""`rk.results`: read the curves and runs of a fragility study from its store, and its tables."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache, cached_property
from math import nan
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from pydantic import ValidationError

from rocking_cli.arrays import Reals
from rocking_cli.ask.answer import Answer, Dimensions, drawn
from rocking_cli.ask.verbs import verb, write_rows
from rocking_cli.ask.watcher import Watcher
from rocking_cli.errors import DoubtWarning, InputError, Problem, named, warn
from rocking_cli.io.files import folder, write_whole
from rocking_cli.io.tables import Columns, stacked
from rocking_cli.names import UNKNOWN as UNKNOWN_OUTCOME
from rocking_cli.names import outcome
from rocking_cli.processing.intensity import parse_measure
from rocking_cli.questions.fragility import assess
from rocking_cli.questions.fragility.assess import Bivariate, Fragility
from rocking_cli.questions.fragility.curves import FragilityCurve
from rocking_cli.questions.fragility.definition import SLIDING, Definition, Limit
from rocking_cli.questions.fragility.exports import chosen, components, doubts, nrml, table
from rocking_cli.questions.fragility.hazard_curve import HazardCurve
from rocking_cli.questions.fragility.plan import Plan
from rocking_cli.questions.fragility.quantiles import (
    Quantiles,
    all_quantiles,
    data_of_quantiles,
    quantile_rows,
    tables_of_quantiles,
)
from rocking_cli.questions.fragility.ranking import Ranking, rank, with_rankings
from rocking_cli.questions.fragility.results_asked import ResultsAsked
from rocking_cli.questions.fragility.store import FAILED, NO_RUNS, OFF_EDGE, STANDS, UNKNOWN, RunRows, Store
from rocking_cli.questions.fragility.view import edges, left_out, view
from rocking_cli.studies.fragility.quantities import USUAL_MEASURES, label, standard_measure

if TYPE_CHECKING:
    import pandas

PEAK = "peak_ratio"
OVERTURNED = 1.0  # peak rotation over the critical rotation
LOWER_SHARE = 0.1  # of the lowest threshold: below it runs say little of damage
TEXT_COLUMNS = ("structure", "limit_state", "measure", "unit", "kind")
FIT_COLUMNS = ("median", "dispersion", "scale")
LINE_COLUMNS = ("probability", "low", "high")
COLUMNS = (*FIT_COLUMNS, "x", *LINE_COLUMNS, "unknown", *(f"lower_{name}" for name in (*FIT_COLUMNS, *LINE_COLUMNS)))
"""Columns of curves: `lower_` begins those of the fit that counts runs of unknown outcome as not exceeding."""
CurveKey = tuple[str, Limit, str]
"""Structure, limit state and measure of a curve."""


@dataclass(frozen=True, eq=False, repr=False)
class StudyAnswer(Answer[list[Fragility]]):
    """Fragility curves of a study, and what else its store holds.

    `to_frame()` has the points of all curves, one below the other, `runs()` the runs, and `to_xarray()` the runs as
    labelled arrays over structure, sample, motion, and restitution, level and polarity if there are several.

    Parameters
    ----------
    store : Path
        The store; a temporary folder, which lasts as long as the answer, of a study without a file and a store.
    plan : Plan
        Structures, samples, records and levels.
    definition : Definition
        The study.
    surfaces : sequence of Bivariate
        Fits to two measures.
    rankings : sequence of Ranking
        Rankings of the intensity measures, if requested.
    failed : int
        Number of runs that could not be simulated.
    complete : bool
        Whether all runs are finished, and all records, samples and runs could be used.
    """

    store: Path = field(kw_only=True)
    plan: Plan = field(kw_only=True)
    definition: Definition = field(kw_only=True)
    surfaces: list[Bivariate] = field(kw_only=True)
    rankings: list[Ranking] = field(kw_only=True)
    failed: int = field(kw_only=True)
    complete: bool = field(kw_only=True)

    @cached_property
    def quantiles(self) -> list[Quantiles]:
        """Quantiles of the peak rotation at each intensity."""
        return list(all_quantiles(Store.reading(self.store), self.plan, self.definition))

    def __getstate__(self) -> dict[str, Any]:
        """Return what a pickle keeps."""
        return {**super().__getstate__(), "quantiles": self.quantiles}

    @property
    def curves(self) -> Curves:
        """The curves by limit state, or by structure, limit state and measure; see `Curves`."""
        return Curves(self.result)

    def runs(self) -> pandas.DataFrame:
        """Return the finished runs, a row for each, with the intensity measures of the study. Raises as `to_frame`.

        The peak of a run that overturns is infinite, so that no comparison or quantile takes it for safe.
        """
        return self.frames["runs"]

    def run_blocks(self) -> Iterator[Columns]:
        """Yield the runs as columns, read from the store in blocks of rows, as there may be very many."""
        if self.store.exists():  # the generator holds on to the answer, and with it to a temporary store
            yield from _blocks(self.store, self.plan)
        else:  # of a pickled answer
            yield self.tables["runs"]()

    def to_cloud(
        self, measure: str = "PGA", edp: str = "peak_ratio", censored: float = 1.5, structure: str | None = None
    ) -> tuple[Reals, Reals, Reals, float, float]:
        """Return what a censored cloud analysis takes, in the order of `do_cloud_analysis` of oq-vmtk.

        Runs of unknown outcome, those that failed, and those without a positive intensity are left out with a warning.
        Weights of records are not included.

        Parameters
        ----------
        measure : str
            Intensity measure: PGA, PGV, or one that the study names.
        edp : {"peak_ratio"}
            The demand parameter: the peak rotation over the critical rotation [-].
        censored : float
            Value of runs that overturn, above every damage threshold: they count as collapse [-].
        structure : str, optional
            Name of the structure; needed if the study has several.

        Returns
        -------
        imls : ndarray, shape (n,)
            Intensity of each run, in the unit of the measure.
        edps : ndarray, shape (n,)
            Peak of each run: 0 if it does not uplift, `censored` if it overturns [-].
        damage_thresholds : ndarray, shape (m,)
            The ratios among the limit states, and 1 for overturning, increasing [-].
        lower_limit : float
            A tenth of the lowest threshold: runs below it are left out of the regression [-].
        censored_limit : float
            `censored` [-].

        Raises
        ------
        InputError
            If the study does not have the measure, the structure or the parameter, or if `censored` is too low.

        Examples
        --------
        >>> import rocking_cli as rk
        >>> pulses = [f"ricker:1g:{period}s" for period in (0.4, 0.6, 0.9)]
        >>> answer = rk.fragility(rk.Block(width=0.7, height=2.8), pulses, method="cloud", limit_states=[0.5])
        >>> imls, edps, thresholds, lower, censored = answer.to_cloud("PGA")
        >>> edps.round(2).tolist(), thresholds.tolist(), lower
        ([0.32, 1.5, 1.5], [0.5, 1.0], 0.05)
        """
        runs, names = stacked(self.run_blocks()), self.plan.structures
        ratios = [limit for limit in self.definition.limit_states if isinstance(limit, float)]
        thresholds = np.array(sorted({*ratios, OVERTURNED}))
        heading, structure = label(standard_measure(measure)), structure or (names[0] if len(names) == 1 else None)
        for argument, value, suits, hint in (
            ("measure", measure, heading in runs, "give one that the study names, or PGA or PGV"),
            ("edp", edp, edp == PEAK, f"give {PEAK}"),
            ("censored", censored, censored > thresholds[-1],
             f"give more than the highest threshold, {thresholds[-1]:g}"),
            ("structure", structure, structure in names, f"give one of {', '.join(names)}"),
        ):  # fmt: skip
            if not suits:
                raise InputError(Problem(f"does not suit this study: {value!r}", field=named(argument), hint=hint))
        of_structure = runs["structure"] == structure
        intensity, peak, outcome = (runs[head][of_structure] for head in (heading, PEAK, "outcome"))
        usable = ~np.isin(outcome, (UNKNOWN_OUTCOME, "failed")) & (intensity > 0)
        if not usable.all():
            unknown, failed = ((outcome == each).sum() for each in (UNKNOWN_OUTCOME, "failed"))
            what = f"{unknown} of {UNKNOWN_OUTCOME} outcome, {failed} failed, the others without a positive {measure}"
            warn(DoubtWarning(f"{(~usable).sum()} of {usable.size} runs are left out: {what}"))
        peaks = np.where(np.isinf(peak), censored, peak)[usable]  # that of a run that overturns is infinite
        return intensity[usable], peaks, thresholds, LOWER_SHARE * float(thresholds[0]), censored


class UnknownCurve(InputError, KeyError):
    """A key of `Curves` that stands for none of them, or for several; also a `KeyError`."""

    __str__ = Exception.__str__  # that of `KeyError` would quote the message


class Curves(Mapping[Limit | CurveKey, Fragility]):
    """The curves of a study.

    Keys are limit states, such as "overturning", 0.5 or "25 mm", if all curves are of one structure and one measure.
    Otherwise they are tuples of structure, limit state and measure, such as ("pedestal", "overturning", "PGA"); a limit
    state alone may stand for a curve if there is one curve of it. A tuple stands for its curve in either case.

    Parameters
    ----------
    curves : iterable of Fragility
        The curves: `median` and `dispersion` are their numbers, `curve` the fit with its band, and `lower` the fit in
        which runs of unknown outcome do not exceed, None if there are none.
    """

    def __init__(self, curves: Iterable[Fragility]) -> None:
        self._curves = {(each.structure, each.limit, each.measure): each for each in curves}
        self._short = len({(structure, measure) for structure, _, measure in self._curves}) == 1

    def __getitem__(self, key: Limit | CurveKey) -> Fragility:
        """Return a curve. Raises `UnknownCurve`, an `InputError` that is also a `KeyError`."""
        meant = [each for known, each in self._curves.items() if key in (known, known[1])]
        if len(meant) == 1:
            return meant[0]
        what = f"stands for {len(meant)} curves" if meant else "is not a curve of this study"
        hint = f"the curves are {', '.join(map(repr, self))}" if self._curves else "it has no curves"
        raise UnknownCurve(Problem(what, field=f"{key!r}", hint=hint))

    def __iter__(self) -> Iterator[Limit | CurveKey]:
        return (limit if self._short else (structure, limit, measure) for structure, limit, measure in self._curves)

    def __len__(self) -> int:
        return len(self._curves)

    def __repr__(self) -> str:
        return f"<curves: {', '.join(map(repr, self))}>"


@verb(ResultsAsked)
def results(asked: ResultsAsked, watch: Watcher) -> StudyAnswer:
    """Summarise the fragility curves and runs of a study, from its store.

    Returns
    -------
    StudyAnswer
        One curve per structure, limit state and measure. `curves` has them by limit state, such as
        `curves["overturning"].median`, or if there are several structures or measures by structure, limit state and
        measure. `to_frame()` has their points, `runs()` the runs, `frames["fits"]` a row for each curve, and
        `frames["quantiles"]` a row for each intensity. If the outcome of some runs is unknown, as a joint
        opens that the model keeps closed, these exceed the limit in the fit and do not in its `lower`.

    Raises
    ------
    InputError
        If the folder is not a store of this version, or is damaged.
    """
    if asked.plot is not None:
        folder(str(asked.plot))
    place = Path(asked.store)
    kept = Store.reading(place)
    plan, definition, points = kept.plan, _definition(kept), kept.facts["hazard"]
    with watch.progress(plan.size, "runs counted") as advance:
        tallies = assess.counted(kept, plan, definition, advance)
    finished, failed = (sum(getattr(each, name) for each in tallies.values()) for name in ("finished", "failed"))
    hazard = HazardCurve(*np.array(points)) if points is not None else None
    count = len(definition.limit_states) * (len(definition.fitted_measures) + len(definition.bivariate))
    with watch.progress(count * len(tallies), "fits") as advance:
        fits, surfaces = assess.fitted(tallies, definition, hazard, advance)
    spread = cache(lambda: list(all_quantiles(kept, plan, definition)))
    shown = view(kept, plan, definition, tallies, fits, surfaces)
    tables = tables_of_quantiles(spread()) if asked.quantiles else []
    shown = shown.plus(lambda: {"quantiles": data_of_quantiles(spread(), tallies)}, tables)
    rankings: list[Ranking] = []
    if asked.rank_measures:
        with watch.progress(plan.size, "runs ranked") as advance:
            rankings = rank(kept, plan, definition, advance)
        shown = with_rankings(shown, rankings)
    lacking = [f"{failed} runs could not be simulated and are left out of the curves"] if failed else []
    lacking += [f"{finished:,} of {plan.total:,} runs are finished so far"] if finished < plan.total else []
    lacking += [f"{len(bad)} records or samples cannot be used"] if (bad := left_out(plan)) else []
    several = zip(("restitution", "level", "polarity"), plan.shape[2:], strict=True)
    along = ("structure", "sample", "motion", *(name for name, count in several if count > 1))

    def runs() -> Columns:
        return stacked(_blocks(place, plan))

    answer = StudyAnswer(
        "fragility",
        fits,
        shown,
        lambda: stacked(curve_blocks(fits)),
        drawn("questions.fragility.picture.draw_study", definition, fits),
        tables={
            "runs": runs,
            "fits": lambda: fit_rows(fits, rankings),
            "quantiles": lambda: quantile_rows(spread(), tallies),
        },
        dims=[Dimensions(along, table=runs)],
        store=place,
        plan=plan,
        definition=definition,
        surfaces=surfaces,
        rankings=rankings,
        failed=failed,
        complete=not lacking,
    )
    _write(answer, asked, watch)
    for sentence in lacking:
        watch.incomplete(sentence)
    return answer


def _write(answer: StudyAnswer, asked: ResultsAsked, watch: Watcher) -> None:
    """Write the files that are requested; curves that another program cannot read are no error of the others."""
    if asked.out is not None:
        write_rows(asked.out, answer.run_blocks(), watch)
    if asked.curves is not None:
        for name, each in edges(answer.result):
            if each.curve.kind == "none":
                watch.warn(f"{each.structure}, {name} against {each.measure}: no curve: {each.curve.why}")
        write_rows(asked.curves, curve_blocks(answer.result), watch)
    if asked.plot is not None:
        from rocking_cli.questions.fragility.picture import draw_all

        draw_all(asked.plot, answer, watch)
    for place, write in ((asked.nrml, write_nrml), (asked.pelicun, write_pelicun)):
        try:
            if place is not None:
                write(answer, place, watch)
        except InputError as error:
            watch.unwritten(error)


def write_nrml(answer: StudyAnswer, file: Path, watch: Watcher) -> None:
    """Write the curves that OpenQuake can read, and name the others. Raises `InputError` if there are none."""
    model = chosen(answer.result)
    for each in [*(f"not in {file}: {each}" for each in model.left_out), *model.doubts]:
        watch.warn(each)
    store = Store.reading(answer.store)
    version, study, name = store.facts["versions"]["rocking-cli"], store.facts["hash"], store.facts["name"]
    document = nrml(model, name, f"{answer.sentences[0]}; rocking-cli {version}, study {study[:12]}")
    write_whole(file, lambda stream: stream.write(document))
    watch.note(f"wrote {file}")


def write_pelicun(answer: StudyAnswer, place: Path, watch: Watcher) -> None:
    """Write the curves that pelicun can read, and name the others. Raises `InputError` if there are none."""
    rows, without = components(answer.result)
    file = folder(str(place)) / "fragility.csv"
    for each in without:
        watch.warn(f"not in {file}: {each}")
    for each in doubts(rows):
        watch.warn(each.replace("a share below zero", "and pelicun uses the graver"))
    write_rows(file, [table(rows)], watch)
    for row in rows:
        watch.note(f"{row.name}: {', '.join(f'LS{k} {curve.limit}' for k, curve in enumerate(row.curves, 1))}")


def _definition(store: Store) -> Definition:
    """Return the definition of the study of a store."""
    try:
        return Definition.model_validate(store.facts["definition"])
    except ValidationError:
        hint = "run `rocking fragility STUDY.yaml`: it names the problem and keeps the runs"
        what = "the definition of its study is not valid in this version"
        raise InputError(Problem(what, str(store.path), hint=hint)) from None


def _blocks(place: Path, plan: Plan) -> Iterator[Columns]:
    """Yield the runs of a store as columns, in blocks of rows."""
    store = Store.reading(place)
    if store.plan.records != plan.records:
        what, hint = "the study has been run again since these results were read", "read them again"
        raise InputError(Problem(what, str(place), hint=hint))
    yield from run_blocks(store, plan, _definition(store).asked_measures)


def curve_blocks(curves: Sequence[Fragility]) -> Iterator[Columns]:
    """Yield the curves as tables, one after the other, from the least intensity of the data to the largest.

    Yields
    ------
    mapping of str to sequence
        The columns. `dispersion` belongs to lognormal curves, `scale` to logistic ones; each is NaN for the others.
        `unknown` is the share of undecided runs, NaN if nothing was checked: they count as exceeding in the curve
        itself, and as not exceeding in columns whose names begin with `lower_`.
    """
    existing = [each for each in curves if any(fit.curve.kind != "none" for fit in (each, each.lower or each))]
    if not existing:
        yield {**{name: np.array([], dtype=str) for name in TEXT_COLUMNS}, **{name: np.array([]) for name in COLUMNS}}

    def numbers(curve: FragilityCurve) -> list[Any]:
        fit = (getattr(curve, name) for name in FIT_COLUMNS)
        return [nan if estimate is None else estimate.value for estimate in fit]

    for each in existing:
        x, curve, lower = each.points, each.curve, (each.lower or each).curve
        words = (each.structure, f"{each.limit}", each.measure, parse_measure(each.measure).unit, curve.kind)
        values = [*words, *numbers(curve), x, *curve.lines(x), nan if each.share is None else each.share]
        values += [*numbers(lower), *lower.lines(x)]
        yield stacked([dict(zip((*TEXT_COLUMNS, *COLUMNS), values, strict=True))])


def fit_rows(curves: Sequence[Fragility], rankings: Sequence[Ranking]) -> Columns:
    """Return a row for each curve: its numbers and their intervals, the test of its fit, and the rank of its measure.

    Values that do not exist are NaN; those of the rank exist if measures were ranked.
    """
    ranked = {(each.structure, measure.measure): measure for each in rankings for measure in each.measures}
    rows = []
    for each in curves:
        curve, measure = each.curve, ranked.get((each.structure, each.measure))
        row: dict[str, object] = {"structure": each.structure, "limit_state": f"{each.limit}"}
        row |= {"measure": each.measure, "kind": curve.kind}
        for name in FIT_COLUMNS:
            estimate = getattr(curve, name)
            row |= {name: getattr(estimate, "value", nan)}
            row |= {f"{name}_{end}": getattr(estimate, end, nan) for end in ("low", "high")}
        row |= {name: getattr(curve, name) for name in ("runs", "exceedances", "records")}
        numbers = {"unknown": each.share, "annual_rate": getattr(each.rate, "rate", None)}
        numbers |= {name: getattr(curve.goodness, name, None) for name in ("statistic", "p_value")}
        numbers |= {name: getattr(measure, name, None) for name in ("efficiency", "practicality", "proficiency")}
        rows.append(row | {name: nan if number is None else number for name, number in numbers.items()})
    return {name: [row[name] for row in rows] for name in rows[0]} if rows else {}


def run_blocks(store: Store, plan: Plan, measures: Sequence[str] = ()) -> Iterator[Columns]:
    """Yield the finished runs as blocks of a table, in the order of their numbers.

    Parameters
    ----------
    store : Store
        Open to read.
    plan : Plan
        The plan of its runs.
    measures : sequence of str
        Measures with a column, in addition to those that every table has.

    Yields
    ------
    mapping of str to sequence
        The columns by heading, with units; the first block is yielded even if it is empty.
    """
    asked, study = tuple(dict.fromkeys([*USUAL_MEASURES, *measures])), store.facts["description"]
    rows = None
    for rows in store.rows(0, plan.size):
        yield _of_runs(plan, rows, asked, study)
    if rows is None:
        yield _of_runs(plan, NO_RUNS, asked, study)


def _of_runs(plan: Plan, rows: RunRows, measures: Sequence[str], study: Mapping[str, Any]) -> dict[str, list[Any]]:
    sample, record, _, level, polarity = plan.places(rows.run)
    trials, records = [plan.trials[k] for k in sample], [plan.records[k] for k in record]
    fell_to = np.where(np.isin(rows.outcome, (FAILED, UNKNOWN)), 0, np.sign(rows.outcome))
    return {
        "run": rows.run.tolist(),
        "structure": [each.structure for each in trials],
        "sample": [each.number for each in trials],
        "motion": [each.name for each in records],
        "level": np.array(plan.levels)[level].tolist(),
        "polarity": np.array(plan.polarities)[polarity].tolist(),
        "restitution": rows.eta.tolist(),
        "scale": rows.scale.tolist(),
        **{label(name): plan.intensities(name, sample, record, level, rows.scale).tolist() for name in measures},
        "outcome": [
            "failed" if code == FAILED else "falls off an edge" if abs(code) == OFF_EDGE
            else outcome(uplifts=rise >= 0, overturned=code != STANDS, unknown=code == UNKNOWN, slides=slip > 0)
            for code, rise, slip in np.stack([rows.outcome, rows.uplift_time, rows.slip], axis=1).tolist()
        ],
        "fell_to": fell_to.tolist(),
        # Infinite, so that no comparison or quantile of peaks takes what overturns for safe.
        "peak_ratio": np.where(fell_to != 0, np.inf, rows.peak_ratio).tolist(),
        "peak_positive [rad]": rows.peak_positive.tolist(),
        "peak_negative [rad]": rows.peak_negative.tolist(),
        "peak_rate [rad/s]": np.where(fell_to != 0, np.inf, rows.peak_rate).tolist(),
        "uplift_time [s]": rows.uplift_time.tolist(),
        "overturning_time [s]": rows.overturning_time.tolist(),
        "known_to [s]": rows.known_to.tolist(),
        "peak_lower_bound": rows.lower_bound.tolist(),
        "opening": rows.opening.tolist(),
        "slip [m]": rows.slip.tolist(),
        **({"slide_time [s]": rows.slide_time.tolist()} if SLIDING in study else {}),
        **({"engine": np.where(rows.by_blocks, "blocks", "exact").tolist()} if "engine" in study else {}),
    }  # fmt: skip
