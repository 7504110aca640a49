"""View of a design: the values at which a structure meets a requirement, as text and as data."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from math import inf
from typing import Any

import numpy as np

from rocking_cli import names
from rocking_cli.core.hung.ties import BAR_DIAMETERS
from rocking_cli.errors import named
from rocking_cli.names import percent
from rocking_cli.questions.design.metrics import Excitation
from rocking_cli.questions.design.study import TREND_TOLERANCE, Bars, Design, SteelAnswer
from rocking_cli.studies.conclusion import Concluded, NextStep
from rocking_cli.text import one_line
from rocking_cli.views.column import Column, frame_of, only_shown, table_of
from rocking_cli.views.conclusion import NEXT_STEPS, conclusion_data, not_counted, reasons_of, replaced_in_words
from rocking_cli.views.neighbours import deviations
from rocking_cli.views.sheet.language import ENGLISH
from rocking_cli.views.verdict import INVALID_REASON, unchecked
from rocking_cli.views.view import ABSENT, View

REQUIRED_AFTER = (
    "What is required, {:.4g}, is by the intervention of the site, with the file as given as before it ({:.4g})."
)
MAX_SCAN_ROWS = 11  # values of the scan that the table lists


def view(found: Design, excitation: Excitation) -> View:
    """Show the answer in a sentence, the scan, and remarks."""
    title = f"{found.structure}: {found.field} for {found.aim}"
    of = "" if found.before is None else REQUIRED_AFTER.format(found.aim.level, found.before)
    first = " ".join(filter(None, [f"{title}. {_verdict(found)}", of, *in_steel(found), *limited(found)]))
    count = len(found.values)
    some = np.unique(np.linspace(0, count - 1, min(MAX_SCAN_ROWS, count)).round().astype(int))
    scan = table_of("", _columns(found), some.tolist())
    return View(lambda: data(found), [first, scan, *doubts(found, excitation)])


def data(found: Design) -> dict[str, Any]:
    """Return a design as plain data."""
    shares = [None if each is None else each.unknown for each in found.behind]
    unknown = {"unknown": shares} if found.aim.metric.shaken else {}
    return {
        "structure": found.structure,
        "field": found.field,
        "unit": found.unit,
        "in_file": found.given,
        "value": found.value,
        "metric": found.aim.metric.name,
        "until": str(found.aim),
        "holds": [list(each) for each in found.holds],
        "steel": _steel_data(found.steel) if found.steel is not None else None,
        "everywhere": found.everywhere,
        "conclusion": conclusion_data(found.conclusion),
        "monotone": found.monotone,
        "scan": {"values": found.values.tolist(), "metric": found.metric.tolist(), **unknown},
        "not_built": [{"low": each.low, "high": each.high, "reason": each.reason} for each in found.not_built],
        "taken_otherwise": not_counted(found.taken_otherwise),
        "caution": found.caution or None,
        "depth_governs": [list(each) for each in found.depth_governs],
        "verdict": _verdict(found),
    }


def columns(found: Design) -> dict[str, list[Any]]:
    """Return the scan as columns of a table."""
    return frame_of(_columns(found), range(len(found.values)))


def _columns(found: Design) -> list[Column[int]]:
    """Return the columns of the scan, whose rows are the values tried."""
    metric = found.aim.metric
    return [
        Column(found.field, found.values.item, found.unit, _head(found.field, found.unit), _value),
        Column(metric.name, found.metric.item, metric.unit),
        only_shown(_head(metric.name, metric.unit), partial(_metric, found)),
        *([_unknown(found)] if metric.shaken else []),
        Column("holds", lambda k: "yes" if found.met[k] else "no", head="holds", text=True),
    ]


def _head(name: str, unit: str) -> str:
    return f"{name}\n[{unit}]" if unit else name


def _unknown(found: Design) -> Column[int]:
    """Return the column of the share of unknown outcome, which terminals have only if there is one."""
    shares = [None if each is None else each.unknown for each in found.behind]
    return Column("unknown", shares.__getitem__, head="unknown\noutcome" if any(shares) else None, form=percent)


def answer(found: Design) -> str:
    """Return the answer in a sentence or two."""
    aim, low, high = found.aim, _with_unit(found, found.values[0]), _with_unit(found, found.values[-1])
    if found.everywhere:
        return f"{aim} holds at every value of {found.field} tried, from {low} to {high}."
    if found.conclusion.concluded is Concluded.UNKNOWN:
        question = f"Whether {aim} holds at any value of {found.field} tried, from {low} to {high}, is unknown"
        return f"{question}: if unknown outcomes count as overturning, {_nearest(found)}"
    if not found.holds:
        return f"{aim} holds at no value of {found.field} tried, from {low} to {high}: {_nearest(found)}"
    if found.value is not None and len(found.holds) == 1 and (found.monotone or not aim.metric.shaken):
        which, end = ("smallest", high) if found.is_least else ("largest", low)
        answer = f"The {which} {found.field} for which {aim} holds is {_with_unit(found, found.value)}"
        return f"{answer}; from there it holds to the end of the range tried, {end}."
    ranges = [f"from {_with_unit(found, a)} to {_with_unit(found, b)}" for a, b in found.holds]
    listed = " and ".join([", ".join(ranges[:-1]), ranges[-1]] if len(ranges) > 1 else ranges)
    sentence = f"Judging by the {len(found.values)} values tried, {aim} holds for {found.field} {listed}"
    if found.value is None:
        return f"{sentence}, but at neither end of the range tried, {low} to {high}."
    if len(ranges) == 1:
        return f"{sentence}."
    trend = "upwards" if found.is_least else "downwards"
    return f"{sentence}: from {_with_unit(found, found.value)} {trend} without a gap."


def about_depth(found: Design) -> Iterator[str]:
    """Yield where the depth governs, as the weaker side of the base."""
    for low, high in found.depth_governs:
        first, last = low <= found.values[0], high >= found.values[-1]
        start, end = _with_unit(found, low), _with_unit(found, high)
        where = f"From {start} on" if last else f"Up to {end}" if first else f"From {start} to {end}"
        where = "At every value tried" if first and last else where
        yield f"{where}, the depth is the weaker side of the base and governs, unless the file gives `plane: width`."


def _verdict(found: Design) -> str:
    return " ".join([answer(found), *about_depth(found)])


COUNTS = {1: "one bar", 2: "two bars", 3: "three bars", 4: "four bars"}


def in_steel(found: Design) -> Iterator[str]:
    """Yield sentences on the force that a tie needs, and on bars that give it."""
    steel = found.steel
    if steel is None:
        return
    of = steel.steel or f"a yield stress of {steel.stress / 1e6:.4g} MPa"
    needs = f"The tie {steel.tie} needs {steel.force / 1e3:.4g} kN"
    if not steel.proposals:
        what = "the plates, or bars" if steel.anchored else "bars"
        yield f"{needs}, more than {what} of up to {1000 * BAR_DIAMETERS[-1]:g} mm of {of}, give."
        return
    bars = " or ".join(_bars(each, steel.spacing) for each in steel.proposals)
    yield f"{needs}: {bars}, of {of}."
    if not steel.anchored:
        yield "Anchor plates and the wall under them are not counted: give `plate` and `wall` of the tie."


def _bars(bars: Bars, spacing: float | None) -> str:
    """Return the number, the diameter and the strength of bars."""
    many = COUNTS.get(round(bars.number), f"{bars.number:g} bars") if spacing is None else "bars"
    every = "" if spacing is None else f" every {spacing:g} m"
    return f"{many} of {1000 * bars.diameter:g} mm{every} ({bars.strength.force / 1e3:.4g} kN)"


def _steel_data(steel: SteelAnswer) -> dict[str, Any]:
    """Return the bars of a tie as plain data."""
    return {
        "tie": steel.tie, "force": steel.force, "steel": steel.steel, "yield": steel.stress, "spacing": steel.spacing,
        "bars": [
            {"number": each.number, "diameter": each.diameter, "strength": each.strength.limits,
             "governs": each.strength.governs}
            for each in steel.proposals
        ],
    }  # fmt: skip


def limited(found: Design) -> Iterator[str]:
    """Yield sentences on what limits the verification at the answer, or at the value that is closest to one."""
    end = found.conclusion
    where = f"Caution, with {found.field} = {_with_unit(found, found.decisive)}: "
    if (reasons := reasons_of(end)).values:
        holds = "holds only if" if end.concluded is Concluded.SATISFIED_IF else "is not decided:"
        yield f"{where}this {holds} {ENGLISH(reasons)}."
    yield from (f"{where}{each}" for each in replaced_in_words(end))


def doubts(found: Design, excitation: Excitation) -> list[str]:
    """Return remarks on the answer."""
    sentences = [f"{each} Next: {NEXT_STEPS[NextStep.YIELD_FORCE]}." for each in not_counted(found.taken_otherwise)]
    count, there = len(found.values), found.metric[~np.isnan(found.metric)]
    same = there.size > 1 and np.allclose(there, there[0], rtol=TREND_TOLERANCE, atol=0.0)
    if same and (not found.aim.metric.shaken or (0 < there[0] < inf and there[0] != 1)):  # not where shares end
        what = f"{found.aim.metric.name} is the same at every value tried"
        sentences.append(f"{what}: {found.field} has no effect on it.")
    if not found.monotone and np.isfinite(found.metric).any():
        closer = "the edges given are values tried" if found.aim.metric.shaken else "the edges given lie between them"
        sentences.append(
            f"{found.aim.metric.name} is not monotonic over the range: {count} equally spaced values were tried, "
            f"{closer}, and intervals whose two ends agree were not searched."
        )
    for each in found.not_built:
        span = _with_unit(found, each.low)
        span = f"At {span}" if each.low == each.high else f"From {span} to {_with_unit(found, each.high)}"
        sentences.append(f"{span} {found.aim.metric.name} could not be computed: {one_line(each.reason)}.")
    if found.caution:
        sentences.append(f"Caution, of the structure as given: {found.caution}")
    if found.aim.metric.shaken:
        sentences.append(
            f"One time history is one sample: at each value, {excitation.around.count} neighbouring motions are "
            f"simulated, {deviations(excitation.around)}. The metric is based on a share of them, which changes in "
            f"steps of {percent(1 / excitation.around.count)}."
        )
        sentences += _not_known(found)
        if len(excitation.polarities) == 1:
            way = "as given" if excitation.polarities[0] > 0 else "reversed"
            other = f"unless the structure is symmetric, the other may be worse. Give {named('polarity')} both."
            sentences.append(f"Motions {way} only: {other}")
        if len(excitation.motions) > 1:
            sentences.append(f"At each value, the worst of {len(excitation.motions)} motions governs.")
    return sentences


def _not_known(found: Design) -> Iterator[str]:
    """Say at how many values outcomes are unknown, or that the joints are not checked."""
    shares = [neighbours.unknown for neighbours in found.behind if neighbours is not None]
    some = [share for share in shares if share]
    if some:
        count = "they count as overturning, though they may stand"
        count = "so the requirement is not met there" if found.aim.wants_more else count
        yield (
            f"At {len(some)} of the {len(found.values)} values, up to {percent(max(some))} of the neighbouring motions "
            f"have an unknown outcome, as {INVALID_REASON}: {count}."
        )
    if None in shares:
        yield unchecked()


def _nearest(found: Design) -> str:
    """Return the best value of the metric in the scan, as the end of a sentence."""
    there = np.flatnonzero(~np.isnan(found.metric))
    if not there.size:
        return f"{found.aim.metric.name} could not be computed at any of these values."
    which, best = ("largest", np.argmax) if found.aim.wants_more else ("smallest", np.argmin)
    k = int(there[best(found.metric[there])])
    place = _with_unit(found, found.values[k])
    return f"the {which} {found.aim.metric.name} is {_metric(found, k)}, at {place}."


def _value(value: float) -> str:
    return f"{value + 0.0:.6g}"


def _with_unit(found: Design, value: float) -> str:
    if found.unit == "N":
        return f"{_value(float(value) / 1e3)} kN"
    return f"{_value(float(value))}{f' {found.unit}' if found.unit else ''}"


def _metric(found: Design, k: int) -> str:
    """Format the metric at a value tried: a share in %, and what most neighbours do if there is no median peak."""
    value, neighbours = float(found.metric[k]), found.behind[k]
    if np.isnan(value):
        return ABSENT
    if found.aim.metric.name == "overturned":
        return percent(value)
    if np.isinf(value):
        return names.OVERTURNS if neighbours is None or neighbours.half_overturn else names.UNKNOWN
    return f"{value:.5g}"
