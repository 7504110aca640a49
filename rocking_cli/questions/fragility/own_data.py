"""`rk.fit_fragility`: fit a fragility curve to your own data, with an interval by the likelihood and a robust one."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from math import nan
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking_cli.arrays import Bools, Integers, Reals
from rocking_cli.ask.answer import Answer, parted
from rocking_cli.ask.verbs import verb
from rocking_cli.ask.watcher import Watcher
from rocking_cli.errors import InputError, Problem, named
from rocking_cli.names import UNKNOWN
from rocking_cli.questions.fragility.asked import FitFragilityAsked
from rocking_cli.questions.fragility.assess import Fragility
from rocking_cli.questions.fragility.curves import FragilityCurve, fit_curve
from rocking_cli.questions.fragility.observed import Observations
from rocking_cli.questions.fragility.view import (
    Named,
    fit_columns,
    senseless,
    undecided,
    warnings_of,
    without_logarithm,
)
from rocking_cli.short_repr import short_repr
from rocking_cli.text import one_line
from rocking_cli.views.column import data_of, only_shown, table_of
from rocking_cli.views.view import Table, View

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from numpy.typing import ArrayLike

    from rocking_cli.io.tables import Columns

MISSING = ("NAType", "NaTType")  # of pandas, which has no truth value for its own comparison
COLUMNS = ("probability", "low", "high", "robust_low", "robust_high")
"""Columns of the frame, for the curve and, after `lower_`, for its lower edge."""
EXCEEDANCE = "exceedance"  # name of the limit state, which only the data's owner knows
MIN_OUTCOMES = 10  # runs of the rarer outcome below which, in trials, medians are easily off by half
Ends = tuple[float, float]


@short_repr
@dataclass(frozen=True, eq=False)
class FittedFragility(Fragility):
    """A fragility curve of your own data; other fields as in `Fragility`.

    Its `curve` has the intervals of the likelihood, which are right if the curve is, and if runs are independent.

    Parameters
    ----------
    robust : FragilityCurve
        The same curve with intervals that require only independent clusters: each is left out in turn (the
        jackknife). Of kind `none`, with the reason, if there are too few clusters.
    lower : FittedFragility or None
        The fit in which unknown runs count as not exceeding; None if there are none.
    """

    robust: FragilityCurve = field(kw_only=True)
    lower: FittedFragility | None = None

    @property
    def interval(self) -> dict[str, Ends]:
        """Intervals of the `median` and the `dispersion` by the likelihood; NaN where there is no such number."""
        return _intervals(self.curve)

    @property
    def robust_interval(self) -> dict[str, Ends]:
        """Robust intervals of the `median` and the `dispersion`; NaN where there is no such number."""
        return _intervals(self.robust)

    @property
    def robustly(self) -> FittedFragility:
        """The fit and its lower edge with the robust interval, where there is one."""
        lower = None if self.lower is None else self.lower.robustly
        return replace(self, curve=self.curve if self.robust.fit is None else self.robust, lower=lower)


def _intervals(curve: FragilityCurve) -> dict[str, Ends]:
    both = {"median": curve.median, "dispersion": curve.dispersion}
    return {name: (nan, nan) if each is None else (each.low, each.high) for name, each in both.items()}


@verb(FitFragilityAsked)
def fit_fragility(asked: FitFragilityAsked, watch: Watcher) -> Answer[FittedFragility]:
    """Fit a fragility curve to your own data: runs of any program, tests, or observed damage.

    Returns
    -------
    Answer of FittedFragility
        Its `median` and `dispersion` (the standard deviation of the logarithm of the capacity) have a `value`, and
        `low` and `high`, the interval by the likelihood; None if there is no such number. `interval` and
        `robust_interval` have the intervals of both, by their names. `curve.probability(x)` and `curve.band(x)` are
        the curve and its band at any intensity, `robust.band(x)` the robust band, which the plot has. `curve.kind` is
        `step` if the outcomes are separated and `none` if no curve can be fitted: `sentences` say why, and what else
        there is to doubt. `to_frame()` has the points of the curve with both bands. `plot(name="wall",
        beside={"block": other})` draws several fits in one plot.

    Raises
    ------
    InputError
        If the arrays are not numbers of one length, or no run has an intensity above zero.

    Notes
    -----
    Maximum likelihood of a binomial outcome, as for the curves of a study; docs/fragility.md explains the fit, its
    intervals and its test.

    Examples
    --------
    >>> import rocking_cli as rk
    >>> pga = [0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.45, 0.5, 0.55, 0.6, 0.65]
    >>> fell = [0, 0, 0, 0, 1, 0, 0, 1, 1, 0, 1, 1]
    >>> fit = rk.fit_fragility(pga, fell)
    >>> round(fit.median.value, 3), round(fit.dispersion.value, 3)
    (0.406, 0.443)
    """
    clusters = asked.clusters
    _check_index(asked.intensity, asked.exceeded, clusters)
    x, known = _numbers("intensity", asked.intensity), _numbers("exceeded", asked.exceeded)
    label = one_line(asked.label)
    _check(x, known, label)
    record = np.arange(x.size) if clusters is None else _codes(clusters, x.size)
    there = x > 0
    if not there.any():
        raise InputError(Problem("has no value above zero, so that none has a logarithm", field=named("intensity")))
    left_out, x, known, record = int((~there).sum()), x[there], known[there], record[there]
    unknown = np.isnan(known)  # counted as exceeding, and in the lower edge as not exceeding
    fitted = replace(_fit_edge(x, (known == 1) | unknown, record, asked, label), left_out=left_out)
    if unknown.any():
        lower = _fit_edge(x, known == 1, record, asked, label)
        fitted = replace(fitted, unknown=int(unknown.sum()), lower=lower)
    return Answer("fit_fragility", fitted, _view(fitted), partial(_columns, fitted, label), partial(_figure, fitted))


def _check_index(*given: Any) -> None:
    """Raise `InputError` if columns of frames are not of the same rows in the same order: they are taken by place."""
    indices = [each.index for each in given if hasattr(each, "index") and hasattr(each.index, "equals")]
    if any(not each.equals(indices[0]) for each in indices[1:]):
        hint = "take all of them from one frame, or give arrays"
        names = f"{named('intensity')}, {named('exceeded')} and {named('clusters')}"
        raise InputError(Problem(f"{names} have different rows, or rows in a different order", hint=hint))


def _numbers(name: str, values: ArrayLike) -> Reals:
    """Return an argument as an array of numbers, shape (n,)."""
    try:
        numbers = np.asarray(np.ma.filled(np.ma.asarray(values, dtype=np.float64), np.nan))
    except (TypeError, ValueError):
        hint = "give true or false, 1 or 0, and NaN for unknown" if name == "exceeded" else None
        raise InputError(Problem("must be an array of numbers", field=named(name), hint=hint)) from None
    if numbers.ndim != 1:
        raise InputError(Problem(f"must have one dimension, has {numbers.ndim}", field=named(name)))
    return numbers


def _check(x: Reals, known: Reals, label: str) -> None:
    """Raise `InputError` with every problem of the arguments."""
    problems = []
    if x.size != known.size:
        what = f"must have one value for each intensity: there are {known.size} and {x.size}"
        problems.append(Problem(what, field=named("exceeded")))
    if np.isinf(x).any():
        problems.append(Problem("must be finite", field=f"`intensity[{int(np.isinf(x).argmax())}]`"))
    wrong = ~(np.isnan(known) | (known == 0) | (known == 1))
    if wrong.any():
        k = int(wrong.argmax())
        hint = "for a share of several runs, give one entry per run"
        problems.append(Problem(f"must be 1, 0 or NaN, got {known[k]:g}", field=f"`exceeded[{k}]`", hint=hint))
    (name,) = parted({label: x})[0]
    if name.removeprefix("lower_") in COLUMNS:
        what = f"must not be {label!r}, the name of another column of the frame"
        problems.append(Problem(what, field=named("label")))
    if problems:
        raise InputError(*problems)


def _codes(clusters: Any, count: int) -> Integers:
    """Return the number of the cluster of each run."""
    try:
        names = list(clusters)
        numbers = {name: k for k, name in enumerate(dict.fromkeys(names))}
    except TypeError:
        hint = "give a name or a number for each run"
        raise InputError(Problem("must be a sequence of names", field=named("clusters"), hint=hint)) from None
    if len(names) != count:
        what = f"must have one name for each intensity: there are {len(names)} and {count}"
        raise InputError(Problem(what, field=named("clusters")))
    missing = [k for k, name in enumerate(names) if name is None or type(name).__name__ in MISSING or name != name]
    if missing:
        hint = "give each independent run its own name"
        raise InputError(Problem("is missing", field=f"`clusters[{missing[0]}]`", hint=hint))
    return np.array([numbers[name] for name in names], dtype=np.int64)


def _fit_edge(x: Reals, exceeds: Bools, record: Integers, asked: FitFragilityAsked, label: str) -> FittedFragility:
    """Fit one curve with both of its intervals: as if all runs were independent, and leaving out each cluster.

    A study takes the second if records repeat, and the first otherwise. Its choice tests the curve here.
    """
    seen = Observations.of(x, exceeds, record)
    if seen.counts.repeated:
        other = Observations.of(x, exceeds, np.arange(x.size))
    else:  # equal weights change no estimate, but have each run left out
        other = Observations.of(x, exceeds, record, weight=np.ones(x.size))
    study, beside = (fit_curve(each, confidence=asked.confidence, only=asked.curve) for each in (seen, other))
    beside = replace(beside, records=seen.counts.records)
    if study.fit is not None and beside.fit is not None:
        beside = replace(beside, why=study.why, goodness=study.goodness)
    plain, robust = (beside, study) if seen.counts.repeated else (study, beside)
    return FittedFragility("", EXCEEDANCE, label, seen, plain, None, robust=robust)


def _figure(
    found: FittedFragility, *, name: str = EXCEEDANCE, beside: Mapping[str, Answer[FittedFragility]] | None = None
) -> Figure:
    from rocking_cli.plotting.style import plain
    from rocking_cli.questions.fragility.picture import draw_curves

    every = {name: found} | {other: each.result for other, each in (beside or {}).items()}
    robust = {plain(each): fitted.robustly for each, fitted in every.items()}
    return draw_curves(robust, plain(found.measure), "", of="clusters")


def _columns(found: FittedFragility, label: str) -> Columns:
    """Return the points of the curve, with both bands; columns of the lower edge are those of the curve without one."""
    x = found.points
    columns: dict[str, Reals] = {}
    for prefix, each in (("", found), ("lower_", found.lower or found)):
        numbers = each.curve.probability(x), *each.curve.band(x), *each.robust.band(x)
        columns |= {f"{prefix}{name}": values for name, values in zip(COLUMNS, numbers, strict=True)}
    return {label: x, **columns}


def _view(found: FittedFragility) -> View:
    """Show a fitted curve: its numbers with both intervals, and what there is to doubt."""
    percent = f"{100 * found.curve.confidence:g} %"
    fits = [("", found)] if found.lower is None or not found.is_band else [("upper", found), ("lower", found.lower)]
    rows: list[Named] = []
    for edge, each in fits:
        before = f"{edge}, " if edge else ""
        rows.append((f"{before}by the likelihood", each))
        rows += [(f"{before}robust", each.robustly)] if each.robust.fit is not None else []
    parts: list[Table | str] = [f"{_in_short(found)}."]
    if any(each.curve.kind != "none" for _, each in fits):
        columns = [only_shown("interval", lambda row: row[0], text=True), *fit_columns(percent, "dispersion")[1:]]
        parts.append(table_of(f"{EXCEEDANCE} against {found.measure}", columns, rows))
    for edge, each in fits:
        sentences = (f"{edge}: {sentence}" if edge else sentence for sentence in _doubts(each))
        parts += [sentence[0].upper() + sentence[1:] for sentence in sentences]
    parts += undecided([found], capacities=False)
    parts += without_logarithm(found.measure, found.left_out)
    parts += warnings_of([found.curve])
    # What a study has in common is a record; here it may be anything.
    return View(_data(found), [_of_clusters(each) for each in parts])


def _of_clusters(part: Table | str) -> Table | str:
    return type(part)(part.replace("record", "cluster")) if isinstance(part, str) else part


def _in_short(found: FittedFragility) -> str:
    """Return the curve in one line, with its robust interval if there is one."""
    best, unknown = found.robustly.curve, found.unknown or 0
    counts = f"{best.exceedances - unknown} of {best.runs} runs exceed"
    counts += f"; the outcome of {unknown} is {UNKNOWN}" if unknown else ""
    if best.fit is None or best.median is None:
        return f"no curve; {counts}" if best.kind == "none" else f"step at {_number(best, 'median')}; {counts}"
    spread = f", dispersion {_number(best, 'dispersion')}" if best.dispersion is not None else ""
    intervals = f"{100 * best.confidence:g} % {'likelihood' if found.robust.fit is None else 'robust'} intervals"
    return f"{best.kind}, median {_number(best, 'median')}{spread}, {intervals}; {counts}"


def _number(curve: FragilityCurve, name: str) -> str:
    each = getattr(curve, name)
    return f"{each.value:.3g} ({each.low:.3g} to {each.high:.3g})"


def _doubts(each: FittedFragility) -> Iterator[str]:
    """Yield sentences on how a curve was found, and why it may not be relied upon."""
    curve = each.curve
    yield f"{curve.why}.{senseless(curve)}"
    if curve.fit is not None and each.robust.fit is None:
        yield f"there is no robust interval: {each.robust.why}."
    rarer = min(curve.exceedances, curve.runs - curve.exceedances)
    if curve.fit is not None and rarer < MIN_OUTCOMES:
        counted = "count as exceeding" if each.unknown else "exceed"
        verb = counted if rarer == curve.exceedances else "do not exceed"
        yield (
            f"only {rarer} of {curve.runs} runs {verb}: with fewer than {MIN_OUTCOMES} the median may be wrong by "
            "half or more; use its interval."
        )


def _data(found: FittedFragility) -> dict[str, object]:
    """Return a fitted curve as plain data, with its lower edge."""
    columns = fit_columns()

    def one(each: FittedFragility) -> dict[str, object]:
        return {**data_of(columns, ("", each)), "robust": each.robust_interval}

    return {
        "measure": found.measure,
        **one(found),
        "left_out": found.left_out,
        "unknown": found.unknown,
        "unknown_share": found.share,
        "band": found.is_band,
        "lower": None if found.lower is None else one(found.lower),
    }
