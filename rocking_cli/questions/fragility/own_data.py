"""`rk.fit_fragility`: fit a fragility curve to your own data."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking_cli.arrays import Integers, Reals
from rocking_cli.ask.answer import Answer, parted
from rocking_cli.ask.verbs import verb
from rocking_cli.ask.watcher import Watcher
from rocking_cli.errors import InputError, Problem, named
from rocking_cli.questions.fragility.asked import FitFragilityAsked
from rocking_cli.questions.fragility.own_fit import EXCEEDANCE, FittedFragility, fit_known
from rocking_cli.text import one_line

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from numpy.typing import ArrayLike

    from rocking_cli.io.tables import Columns

MISSING = ("NAType", "NaTType")  # of pandas, which has no truth value for its own comparison
COLUMNS = ("probability", "low", "high", "robust_low", "robust_high")
"""Columns of the frame, for the curve and, after `lower_`, for its lower edge."""


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
    fitted = fit_known(x[there], known[there], record[there], asked.curve, asked.confidence, label)
    return _answer(replace(fitted, left_out=int((~there).sum())), label)


def _check_index(*given: Any) -> None:
    """Raise `InputError` if columns of frames are not of the same rows in the same order: they are taken by place."""
    indices = [each.index for each in given if hasattr(each, "index") and hasattr(each.index, "equals")]
    if any(not each.equals(indices[0]) for each in indices[1:]):
        hint = "take all of them from one frame, or give arrays"
        what = (
            f"{named('intensity')}, {named('exceeded')} and {named('clusters')} have different rows, or "
            "rows in a different order"
        )
        raise InputError(Problem(what, hint=hint))


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
        problems.append(
            Problem(f"must not be {label!r}, the name of another column of the frame", field=named("label"))
        )
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


def _answer(found: FittedFragility, label: str) -> Answer[FittedFragility]:
    from rocking_cli.questions.fragility.own_view import view

    return Answer("fit_fragility", found, view(found), partial(_columns, found, label), partial(_figure, found))


def _figure(
    found: FittedFragility, *, name: str = EXCEEDANCE, beside: Mapping[str, Answer[FittedFragility]] | None = None
) -> Figure:
    from rocking_cli.questions.fragility.picture import draw_own

    return draw_own({name: found} | {name: each.result for name, each in (beside or {}).items()})


def _columns(found: FittedFragility, label: str) -> Columns:
    """Return the points of the curve, with both bands; columns of the lower edge are those of the curve without one."""
    from rocking_cli.questions.fragility.table import points

    x = points(found)
    columns: dict[str, Reals] = {}
    for prefix, each in (("", found), ("lower_", found.lower or found)):
        numbers = each.curve.probability(x), *each.curve.band(x), *each.robust.band(x)
        columns |= {f"{prefix}{name}": values for name, values in zip(COLUMNS, numbers, strict=True)}
    return {label: x, **columns}
