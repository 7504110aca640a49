"""View of scores of stated shares, as text and as data."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict
from math import isnan
from typing import Any

from rocking_cli.errors import InputError, Problem
from rocking_cli.names import percent
from rocking_cli.text import one_line
from rocking_cli.views.column import Column, data_of, frame_of, of, only_shown, rounded, table_of
from rocking_cli.views.neighbours import deviations
from rocking_cli.views.view import ABSENT, Table, View
from validation.rules import (
    BASE_RATE,
    DRAWS,
    FITTED_PGV,
    TOOL,
    VELOCITY,
    WEST,
    WITH_UNKNOWN,
    CalibrationBin,
    Scored,
    ScoreEstimate,
    Stated,
)

FEW_CLUSTERS = 10
INTEGRATED = "In 300 shake-table tests, such a PGV was 1.3 times the measured one (0.76 to 6.3 times in 90 % of them)"
NAMES = {
    TOOL: "the tool",
    WITH_UNKNOWN: "the tool, unknown as overturned",
    BASE_RATE: "base rate of other tests",
    WEST: "West: PGA > lambda g",
    VELOCITY: "PGV > v_imp",
    FITTED_PGV: "fitted PGV",
}
ROWS: tuple[Column[Stated], ...] = (
    Column("line", of("test.line")),
    Column("structure", of("test.structure"), text=True),
    Column("record", of("test.record"), text=True),
    Column("cluster", of("test.cluster"), text=True),
    Column("share", of("share")),
    Column("unknown", of("unknown_share")),
    Column("overturned", of("test.overturned"), text=True),
    Column("doubtful", of("doubtful"), text=True),
    Column("pgv", lambda each: _number(each.pgv)),
)
BINS: tuple[Column[CalibrationBin], ...] = (
    only_shown("stated share", lambda each: f"{each.low:g} to {each.high:g}", text=True),
    Column("low", of("low")),
    Column("high", of("high")),
    Column("tests", of("tests"), head="tests"),
    Column("clusters", of("clusters"), head="clusters"),
    Column("stated", lambda each: _number(each.stated), head="mean\nstated", form=rounded(3)),
    Column("observed", lambda each: _number(each.observed.value), head="observed", form=rounded(3)),
    Column("interval", lambda each: _list(each.observed)[1:], head="5 to 95 %", form=lambda ends: _range(*ends)),
    Column("outside", of("outside"), text=True),
)


def view(found: Scored, file: str) -> View:
    """Show the scores of a table of tests; `file` is its name."""
    return View(lambda: _data(found), [*_parts(found, file)])


def columns(found: Scored) -> dict[str, list[Any]]:
    """Return the predictions for each test as columns by name."""
    return {**frame_of(ROWS, found.tests), "error": [reason(each) or "" for each in found.tests]}


def reason(each: Stated) -> str | None:
    """Return why a test could not be simulated, in one line; None if it could."""
    if not isinstance(each.error, InputError):
        return None if each.error is None else one_line(str(each.error))
    return "; ".join(str(Problem(one.message, one.file, one.line, field=one.field)) for one in each.error.problems)


def _parts(found: Scored, file: str) -> Iterator[Table | str]:
    kept, tests = found.observed, found.tests
    structures, records = ({getattr(each.test, name) for each in tests} for name in ("structure", "record"))
    drawn = found.drawn or {found.around: []}
    sentence = " and ".join(
        f"{deviations(around)} ({', '.join(each)})" if len(drawn) > 1 else deviations(around)
        for around, each in drawn.items()
    )
    yield (
        f"{file}: {_count(len(tests), 'test')} of {_count(len(structures), 'structure')} under "
        f"{_count(len(records), 'motion')}. {found.around.count} neighbouring motions are simulated for each, "
        f"{sentence}; the stated share is that of the neighbours that overturn."
    )
    if commanded := sum(each.test.commanded for each in tests):
        yield (
            f"Caution: the motions of {_count(commanded, 'test')} are those commanded, not those recorded: what the "
            "table did may differ by far more than the neighbours do."
        )
    if integrated := sum(each.test.pgv is None for each in kept):
        yield (
            f"Caution: the PGV of {_count(integrated, 'scored test')} is integrated from the record. {INTEGRATED}: "
            "give what was measured in the column `pgv`."
        )
    if doubtful := [str(each.test.line) for each in tests if each.doubtful]:
        yield (
            f"Caution: {_count(len(doubtful), 'test')} did not overturn, but the peak lies beyond the critical "
            f"rotation (line {', '.join(doubtful)}): check its unit, and the outcome."
        )
    if kept:
        yield from _scores(found, len(kept))
    if found.ranks:
        yield _peaks(found)
    if silent := sum(each.test.overturned is None and each.test.peak is None for each in tests):
        yield f"The outcome of {_count(silent, 'test')} is not given: shares are stated, and no score includes them."
    if found.failed:
        yield f"{_count(len(found.failed), 'test')} could not be simulated, and no score includes what they showed."


def _scores(found: Scored, count: int) -> Iterator[Table | str]:
    unknown = any(each.unknown for each in found.observed)
    shown = {name: each for name, each in found.scores.items() if name != WITH_UNKNOWN or unknown}
    overturned = sum(bool(each.test.overturned) for each in found.observed)
    rules: tuple[Column[str], ...] = (
        only_shown("rule", lambda name: NAMES.get(name, name), text=True),
        only_shown("tests", lambda name: shown[name].tests),
        _estimate("Brier", lambda name: shown[name].brier),
        _estimate("tool less\nrule", found.differences.get),
        _estimate("log loss", lambda name: shown[name].log_loss),
        _estimate("right", lambda name: shown[name].right),
        _estimate("area", lambda name: shown[name].auc),
    )
    yield table_of(f"Scores of {_count(count, 'test')} in {_count(found.clusters, 'cluster')}", rules, shown)
    yield (
        f"{overturned} of these tests overturned. 'Brier' is the mean squared difference of stated share and outcome: "
        "smaller is better. 'Tool less rule' is the Brier score of the tool less that of the rule: negative if the "
        "tool is better. 'Right' is the share of tests in which the more likely outcome was observed, 'area' the "
        "probability that a test that overturned has a larger share than one that did not. Brackets hold 5 to 95 % of "
        f"{DRAWS} draws of clusters."
    )
    if found.clusters < FEW_CLUSTERS:
        yield (
            f"Caution: with {_count(found.clusters, 'cluster')} of tests only, "
            f"{'the true intervals are wider' if found.clusters > 1 else 'there are no intervals'}: "
            "no rule can be called better than another."
        )
    else:
        yield " ".join(
            _compared(NAMES.get(name, name), each) for name, each in found.differences.items() if name in shown
        )
    yield table_of("Stated and observed shares of overturning", BINS, found.bins)
    if wrong := [each for each in found.bins if each.outside]:
        yield f"The interval of the observed share excludes the stated one in {_listed(wrong)}."
    yield _calibrated(found)


def _listed(bins: Sequence[CalibrationBin]) -> str:
    """Return the bins of stated shares in words, each with the observed share."""
    each_said = (
        f"the bin {each.low:g} to {each.high:g} (stated {each.stated:.3f}, observed {each.observed.value:.3f} "
        f"{_range(*each.observed[1:])})"
        for each in bins
    )
    return ", ".join(each_said)


def _compared(name: str, each: ScoreEstimate) -> str:
    """Return a sentence on whether the tool is better than a rule: only if the whole interval says so."""
    if isnan(each.value):
        return f"There is no test on which {name} can be compared."
    how = "better than" if each.high < 0 else "worse than" if each.low > 0 else "not distinguishable from"
    if isnan(each.low):
        return f"The tool and '{name}' are compared in one cluster only: there is no interval."
    interval = _range(each.low, each.high)
    return f"The tool is {how} '{name}': its Brier score differs by {each.value:+.3f} {interval}."


def _calibrated(found: Scored) -> str:
    """Return a sentence on how far the stated shares of overturning are from those observed in the tests."""
    points = 100 * found.bias.value
    more = "more" if points > 0 else "less"
    low, high = (100 * each for each in found.bias[1:])
    apart = "includes" if low <= 0 <= high else "excludes"
    interval = "" if isnan(low) else f" [{low:.2g} {high:.2g}]; the interval {apart} 0"
    return (
        f"On average, the tool states {abs(points):.2g} percentage points {more} than was observed{interval}. "
        f"The mean gap of the bins is {100 * found.mean_gap:.2g} points."
    )


def _peaks(found: Scored) -> str:
    """Return sentences on the ranks of observed peaks."""
    certain = sorted(each.rank for each in found.ranks if not each.censored)
    censored = len(found.ranks) - len(certain)
    sentence = f"Peak rotations were observed in {_count(len(found.ranks), 'test')}"
    sentence += f", {censored} of them as a lower bound only" if censored else ""
    if not certain:
        return f"{sentence}."
    inside = sum(0.05 <= each <= 0.95 for each in certain) / len(certain)
    return (
        f"{sentence}. Of the others, {percent(inside)} lie between 5 and 95 % of their neighbours, where 90 % should; "
        f"the distribution of their ranks departs from a uniform one by {found.distance:.2g}."
    )


def _data(found: Scored) -> dict[str, Any]:
    tests = []
    for each in found.tests:
        error = reason(each)
        tests.append(data_of(ROWS, each) | ({"error": error} if error is not None else {}))
    return {
        "neighbours": _neighbours(found),
        "tests": tests,
        "scores": {
            rule: {"tests": each.tests}
            | {name: _list(getattr(each, name)) for name in ("brier", "log_loss", "right", "auc")}
            for rule, each in found.scores.items()
        },
        "differences": {name: _list(each) for name, each in found.differences.items()},
        "calibration": [data_of(BINS, each) for each in found.bins],
        "mean_gap": _number(found.mean_gap),
        "bias": _list(found.bias),
        "clusters": found.clusters,
        "peaks": {
            "tests": len(found.ranks),
            "censored": sum(each.censored for each in found.ranks),
            "uniformity": _number(found.distance),
            "ranks": [each._asdict() for each in found.ranks],
        }
        if found.ranks
        else None,
    }


def _neighbours(found: Scored) -> dict[str, Any]:
    """Return the deviations of the neighbours: for all structures (None if they differ), and for each."""
    each = [asdict(around) | {"structures": structures} for around, structures in found.drawn.items()]
    same = {
        name: value if all(one[name] == value for one in each) else None
        for name, value in (each[0] if each else asdict(found.around)).items()
        if name != "structures"
    }
    return same | {"drawn": each}


def _list(each: ScoreEstimate) -> list[float | None]:
    return [_number(value) for value in each]


def _number(value: float) -> float | None:
    return None if isnan(value) else value


def _estimate(head: str, of_rule: Callable[[str], ScoreEstimate | None]) -> Column[str]:
    """Return the column of an estimate for each rule, in two lines: the value, and its interval."""

    def form(each: ScoreEstimate) -> str:
        return ABSENT if isnan(each.value) else f"{each.value:.3f}\n{_range(each.low, each.high)}"

    return only_shown(head, of_rule, form)


def _range(low: float | None, high: float | None) -> str:
    return ABSENT if low is None or high is None or isnan(low) else f"[{low:.3f} {high:.3f}]"


def _count(number: int, what: str) -> str:
    return f"{number} {what}{'s' * (number != 1)}"
