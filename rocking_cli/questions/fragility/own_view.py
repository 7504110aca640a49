"""View of a fragility curve of data of one's own, as text and as data."""

from __future__ import annotations

from collections.abc import Iterator

from rocking_cli.names import UNKNOWN
from rocking_cli.questions.fragility.curves import FragilityCurve
from rocking_cli.questions.fragility.own_fit import EXCEEDANCE, FittedFragility
from rocking_cli.questions.fragility.view import (
    Named,
    fit_columns,
    senseless,
    undecided,
    warnings_of,
    without_logarithm,
)
from rocking_cli.views.column import data_of, only_shown, table_of
from rocking_cli.views.view import Table, View

MIN_OUTCOMES = 10  # runs of the rarer outcome below which, in trials, medians are easily off by half


def view(found: FittedFragility) -> View:
    """Show a fitted curve: its numbers with both intervals, and what there is to doubt."""
    percent = f"{100 * found.curve.confidence:g} %"
    fits = [("", found)] if found.lower is None or not found.is_band else [("upper", found), ("lower", found.lower)]
    rows = [row for edge, each in fits for row in _rows(edge, each)]
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
    return View(_data(found), [each.replace("record", "cluster") if isinstance(each, str) else each for each in parts])


def _rows(edge: str, each: FittedFragility) -> Iterator[Named]:
    """Yield the rows of a curve, or an edge of a band: with the interval by the likelihood, and with the robust one."""
    before = f"{edge}, " if edge else ""
    yield f"{before}by the likelihood", each
    if each.robust.fit is not None:
        yield f"{before}robust", each.robustly


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
