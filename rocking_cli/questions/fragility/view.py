"""View of a fragility study: its planned runs and its results, as text and as data."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict
from math import isinf
from operator import itemgetter
from shlex import quote
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from rocking_cli.core.contacts import MASONRY_FRICTION
from rocking_cli.names import UNKNOWN, percent
from rocking_cli.questions.fragility.definition import OVERTURNING, UPLIFT_MEASURE
from rocking_cli.studies.fragility.quantities import kept, label, metres
from rocking_cli.views.column import Column, data_of, of, only_shown, table_of
from rocking_cli.views.engines import ALL_EXACT, BLOCKS_FAILED, blocks_in_words
from rocking_cli.views.view import Aside, Table, View, number

if TYPE_CHECKING:  # avoids importing scipy, which only fits need
    from pathlib import Path

    from rocking_cli.questions.fragility.assess import Bivariate, Fragility
    from rocking_cli.questions.fragility.campaign import Left
    from rocking_cli.questions.fragility.curves import Cut, FittedToRuns, FragilityCurve
    from rocking_cli.questions.fragility.definition import Definition, Limit
    from rocking_cli.questions.fragility.plan import Plan
    from rocking_cli.questions.fragility.store import Store
    from rocking_cli.questions.fragility.study import Study
    from rocking_cli.questions.fragility.tally import Tally
    from rocking_cli.studies.engines import EngineName

Fitted = TypeVar("Fitted", "Fragility", "Bivariate")
PLANNED: tuple[Column[tuple[str, str]], ...] = (
    only_shown("", itemgetter(0), text=True),
    only_shown("number", itemgetter(1)),
)
Named = tuple[str, Any]
"""A fit, and the name of its row."""
CUT_POINTS = 200  # intensities at which curves are checked for cuts


def planned(study: Study, plan: Plan) -> View:
    """Show the runs that a study would simulate."""
    _, _, etas, levels, polarities = plan.shape
    samples, records = ([each.reason is None for each in those] for those in (plan.trials, plan.records))
    counts = {
        "structures": len(study.structures),
        "samples": sum(samples),
        "records": sum(records),
        "restitution": etas,
        "levels": levels,
        "polarity": polarities,
    }
    rows: list[tuple[str, str]] = []
    lacking = {"records": records.count(False), "samples": samples.count(False)}
    for name, count in counts.items():
        rows.append((name, f"{count}"))
        rows += [(f"{name} left out", f"{lacking[name]}")] if lacking.get(name) else []
    table = table_of(study.name, PLANNED, [*rows, ("runs", f"{plan.total:,}")])
    return View({"study": study.name, **counts, "runs": plan.total, "left_out": left_out(plan)}, [table])


def shared(place: Path, share: tuple[int, int], done: Left) -> View:
    """Show how many runs of a part of a study are in its store."""
    part, counts = f"{share[0]}/{share[1]}", {"runs": done.total, "finished": done.finished, "failed": done.failed}
    failed = f", {done.failed:,} of them could not be simulated" if done.failed else ""
    sentence = f"Part {part}: {done.finished:,} of {done.total:,} runs are in {place}{failed}."
    later = f"When all parts are finished, `rocking results {quote(str(place))}` fits the curves."
    return View({"store": str(place), "share": part, **counts}, [sentence, later])


def left_out(plan: Plan) -> list[str]:
    """Return a sentence on each record and sample that cannot be used, with the reason."""
    records = [f"the record {each.name} is left out: {each.reason}" for each in plan.records if each.reason is not None]
    return records + [
        f"sample {each.number} of {each.structure} is left out: {each.reason}"
        for each in plan.trials
        if each.reason is not None
    ]


def without_block(plan: Plan, engine: EngineName) -> list[str]:
    """Return a sentence on each structure without an equivalent block, on the meaning of phi_cr there."""
    structures = dict.fromkeys(each.structure for each in plan.trials if each.reason is None and not each.p)
    counts = ", and reaching it counts as overturning" if engine != "blocks" else ""
    return [
        f"{structure}: no equivalent single block exists, and therefore no p. In a direction without a critical "
        f"rotation, phi_cr stands for the kinematic limit{counts}."
        for structure in structures
    ]


def out_of_reach(store: Store, plan: Plan, definition: Definition) -> list[str]:
    """Return a sentence on each structure whose top never reaches the displacement of a limit state."""
    outcomes: dict[tuple[str, str], list[bool]] = {}
    for limit, table in kept(store.facts, definition.limit_states).items():
        for trial, pair in zip(plan.trials, table.tolist(), strict=True):
            if trial.reason is None:
                outcomes.setdefault((trial.structure, limit), []).append(all(map(isinf, pair)))
    return [
        f"{structure}: its top never moves by {limit}"
        + ("" if all(never) else f" in {sum(never)} of {len(never)} samples")
        + ", whatever its rotation: this limit is then exceeded only by overturning or sliding."
        for (structure, limit), never in outcomes.items()
        if any(never)
    ]


def view(
    store: Store,
    plan: Plan,
    definition: Definition,
    tallies: Mapping[str, Tally],
    curves: Sequence[Fragility],
    surfaces: Sequence[Bivariate],
) -> View:
    """Show the results of a study: the curves and surfaces fitted to the runs of a store.

    Parameters
    ----------
    store : Store
        Open to read.
    plan : Plan
        The plan of its runs.
    definition : Definition
        The definition of its study.
    tallies : mapping of str to Tally
        The counts of the runs of each structure.
    curves, surfaces : sequence
        The curves and surfaces fitted to the runs.
    """
    finished, failed = (sum(getattr(each, count) for each in tallies.values()) for count in ("finished", "failed"))
    used = {structure: tally for structure, tally in tallies.items() if tally.runs.any()}
    name = store.facts["name"]
    bad = sum(each.reason is not None for each in plan.records)
    good = len(plan.records) - bad
    records = f"{good} record{'s' * (good != 1)}" + (f" ({bad} more cannot be used)" if bad else "")
    doubtful, by_blocks = (sum(getattr(each, count) for each in used.values()) for count in ("unknown", "by_blocks"))
    of_them = [f"{doubtful:,} of {UNKNOWN} outcome"] if doubtful else []
    of_them += [f"{by_blocks:,} with free blocks"] if by_blocks else []
    counts = f"{finished:,} runs" + (f" ({', '.join(of_them)})" if of_them else "")
    parts: list[Table | str] = [] if finished == plan.total else [f"Partial: {finished:,} of {plan.total:,} runs."]
    parts += [half(each) for each in curves if each.limit == OVERTURNING]
    parts.append(f"{name}: {definition.method}, {records}, {counts}, seed {definition.seed}")
    parts += sets_in_words(plan)
    interval = f"{100 * definition.confidence:g} %"
    for (structure, measure), these in _grouped(curves, "measure").items():
        over, capacities = f"{structure}, over {label(measure)}", definition.method == "ida"
        every = [each for _, each in edges(these)]
        width = "dispersion" if all(each.curve.scale is None for each in every) else "dispersion\nor scale"
        columns = fit_columns(interval, width, rated=any(each.rate is not None for each in every))
        parts += fits_in_words(over, columns, measure, these, capacities=capacities)
    for (structure, (one, other)), those in _grouped(surfaces, "measures").items():
        title = f"{structure}: P = Phi(c0 + c1 ln({one}) + c2 ln({other}))"
        parts += fits_in_words(title, plane_columns(interval), f"{one} or {other}", those)
    blockless = without_block(plan, definition.engine)
    parts += [*blockless, *(unreached := out_of_reach(store, plan, definition))]
    parts += (notes := list(_notes(used, definition.engine)))
    parts += (nowhere := _nowhere(plan, definition, curves) if finished else [])
    data = {
        "study": name,
        "store": str(store.path),
        **{key: store.facts[key] for key in ("hash", "versions", "libraries")},
        "seed": store.facts["description"]["seed"],
        "runs": plan.total,
        "finished": finished,
        "failed": failed,
        "engine": definition.engine,
        "by_blocks": by_blocks,
        "outcomes": [
            {
                "structure": structure,
                "runs": tally.usable,
                "unknown": tally.unknown_if_checked,
                "checked": tally.checked,
                "by_blocks": tally.by_blocks,
                "off_edge": tally.off_edge,
                "share": tally.unknown_share,
            }
            for structure, tally in used.items()
        ],
        "notes": notes,
        "left_out": left_out(plan),
        "without_block": blockless,
        "out_of_reach": unreached,
        "without_curve": nowhere,
        "records": _records(plan),
        "curves": [_data(each, fit_columns(), {"measure": each.measure}) for each in curves],
        "surfaces": [_data(each, plane_columns(), {"measures": list(each.measures)}) for each in surfaces],
    }
    return View(data, parts)


def half(found: Fragility) -> str:
    """Say at which intensity half of the motions overturn a structure, twice if runs have an unknown outcome."""
    measure, _, unit = label(found.measure).removesuffix("]").partition(" [")
    ends = [found, found.lower] if found.is_band and found.lower is not None else [found]

    def at(each: Fragility) -> str:
        median, curve = each.median, each.curve
        if median is None or senseless(curve):
            return f"at no known {measure}"
        end = f" {unit}" * bool(unit)
        most = f"{end} or more" if isinf(median.high) else f" to {median.high:.3g}{end}"
        interval = f"{100 * curve.confidence:g} %: {median.low:.3g}{most}" if median.low < median.high else "exact"
        within = each.seen.x.min() <= median.value <= each.seen.x.max()
        return f"at {measure} {median.value:.3g}{end} ({interval})" + (
            "" if within else ", outside the intensities of the runs"
        )

    first, *others = map(at, ends)
    if others:
        first = f"{first}, if runs of unknown outcome overturn, and {others[0]}, if they do not"
    return f"{found.structure}: 50 % overturn {first}."


def _grouped(fits: Sequence[Fitted], over: str) -> dict[tuple[str, Any], list[Fitted]]:
    """Return fits by their structure and their measures."""
    groups: dict[tuple[str, Any], list[Fitted]] = {}
    for each in fits:
        groups.setdefault((each.structure, getattr(each, over)), []).append(each)
    return groups


def sets_in_words(plan: Plan) -> list[str]:
    """Return sentences on sets of records for levels and on weights, if there are any."""
    sets, sentences = plan.sets, []
    usable = np.array([each.reason is None for each in plan.records])
    if (sets.level >= 0).any():
        counts = [int((usable & ((sets.level == k) | (sets.level < 0))).sum()) for k in range(len(plan.levels))]
        few, many = min(counts), max(counts)
        each = f"{few}" if few == many else f"{few} to {many}"
        used = "scaled to the level" if sets.scaled else "not scaled to the level"
        sentences.append(f"Each level has its own set of records: {each} per level, {used}.")
    if sets.weighted:
        low, high = float(sets.weight.min()), float(sets.weight.max())
        clusters = "Intervals, bands and tests treat each record as one cluster."
        sentences.append(f"Records have weights from {low:.3g} to {high:.3g}. {clusters}")
    return sentences


def _records(plan: Plan) -> list[dict[str, Any]]:
    """Return each record as plain data, with the level of its set, if any, and its weight."""
    sets = plan.sets
    return [
        {**{"pga_g" if key == "pga" else key: value for key, value in asdict(each).items()},
         "level": plan.levels[sets.level[k]] if sets.level[k] >= 0 else None, "weight": weight}
        for k, (each, weight) in enumerate(zip(plan.records, sets.weight.tolist(), strict=True))
    ]  # fmt: skip


def _nowhere(plan: Plan, definition: Definition, curves: Sequence[Fragility]) -> list[str]:
    """Return a sentence on each measure that is not positive in any run of a structure, so that no curve exists."""
    known = {(each.structure, each.measure) for each in curves}
    return [
        f"{structure}: no run has a {measure} above zero, so no curve can be fitted."
        for structure in dict.fromkeys(each.structure for each in plan.trials if each.reason is None)
        for measure in definition.fitted_measures
        if (structure, measure) not in known
    ]


def fits_in_words(
    title: str, columns: Sequence[Column[Named]], over: str, found: Sequence[Fitted], *, capacities: bool = False
) -> Iterator[Table | str]:
    """Yield the table of the fits of a structure over the same measures, and remarks on them."""
    shown = list(edges(found))
    yield ""
    yield table_of(title, columns, shown)
    for name, each in shown:
        yield (Aside if _is_sound(each) else str)(f"{name}: {each.fitted.why}.")
        yield from (type(remark)(f"{name}: {remark}") for remark in _remarks(each))
    yield from undecided(found, capacities=capacities)
    yield from without_logarithm(over, found[0].left_out)
    yield from warnings_of([each.fitted for _, each in shown])


def edges(found: Sequence[Fitted]) -> Iterator[tuple[str, Fitted]]:
    """Yield all fits with their names; for a band, both of its edges."""
    for each in found:
        name = limit_name(each.limit)
        if each.is_band and each.lower is not None:
            yield f"{name}, upper", each
            yield f"{name}, lower", each.lower
        else:
            yield name, each


def undecided(found: Sequence[Fragility | Bivariate], *, capacities: bool) -> Iterator[str]:
    """Yield sentences on how many runs or capacities may or may not exceed a limit state, and how they count."""
    for each in found:
        if not each.unknown:
            continue
        one, count = each.unknown == 1, f"{each.unknown:,} of {each.total:,}"
        share = f"({percent(each.share or 0.0)})"
        if capacities:
            sentence = f"{count} capacities {share} {'is' if one else 'are'} {UNKNOWN}"
        else:
            sentence = f"whether {count} runs {share} {'exceeds' if one else 'exceed'} the limit is {UNKNOWN}"
        counted = f"{'this one counts' if one else 'these count'} as exceeding"
        how = "the result is the band between the two curves, down to 0 without a lower one"
        yield f"{limit_name(each.limit)}: {sentence}; {how if each.is_band else counted}."
    if any(each.is_band for each in found):
        yield (
            f"An upper curve counts runs of {UNKNOWN} outcome as exceeding the limit, a lower one as not exceeding it. "
            f"A lower curve may be flat or missing just because more outcomes are {UNKNOWN} at higher intensities; "
            "this does not mean that stronger motions are safer."
        )


def _notes(tallies: Mapping[str, Tally], engine: EngineName) -> Iterator[str]:
    """Yield sentences on runs of unknown outcome, on joints that were not checked, and on runs with free blocks."""
    why, when = "a joint opens or slides that the model keeps closed", "the first joint opens or slides"
    if engine != "exact":  # free blocks have simulated all runs with such a joint
        why, when = BLOCKS_FAILED, "the failure"
    for structure, tally in tallies.items():
        if tally.unknown:
            yield (
                f"{structure}: {tally.unknown:,} of {tally.usable:,} runs ({percent(tally.unknown_share or 0.0)}) "
                f"{'are' if tally.unknown != 1 else 'is'} of {UNKNOWN} outcome, because {why}. They are known to "
                f"exceed a limit only if they exceed it before {when}; until more is known, use the upper curves."
            )
    if unchecked := [structure for structure, tally in tallies.items() if not tally.checked]:
        yield (
            f"Caution: the joints of {' and '.join(unchecked)} are not checked: the mechanism does not say which of "
            "them stay closed."
        )
    runs = [
        f"{tally.by_blocks:,} of {tally.usable:,} runs{f' of {structure}' if len(tallies) > 1 else ''}"
        for structure, tally in tallies.items()
        if tally.by_blocks
    ]
    if runs:
        friction = f"that of the structure's file, or {MASONRY_FRICTION:g}, as usual for masonry, if it gives none"
        off_edge = sum(tally.off_edge for tally in tallies.values())
        yield from blocks_in_words(engine, " and ".join(runs), friction, off_edge)
    elif engine == "auto":
        yield ALL_EXACT


def without_logarithm(measure: str, runs: int) -> Iterator[str]:
    """Yield a sentence on the number of runs that are left out of a fit over a measure."""
    if runs:
        yield (
            f"{runs:,} run{'s have' if runs > 1 else ' has'} no {measure} above zero and "
            f"{'are' if runs > 1 else 'is'} left out of this fit."
        )


def warnings_of(fitted: Sequence[FittedToRuns]) -> Iterator[str]:
    """Yield each warning of some fits once; they are shown with the numbers that they concern."""
    for warning in dict.fromkeys(each.warning for each in fitted if each.warning):
        yield f"Warning: {warning}."


def senseless(curve: FragilityCurve) -> str:
    """Say that a dispersion is not shown because it is too large; empty if it is not."""
    from rocking_cli.questions.fragility.curves import DEVIATIONS, MAX_DISPERSION

    if curve.kind not in DEVIATIONS or curve.dispersion is not None:
        return ""
    return f" Its dispersion is above {MAX_DISPERSION:g}: this limit state does not depend on the measure."


def cut_of(found: Fragility) -> Cut | None:
    """Return the largest cut of a curve by an implied limit state, at the intensities of its runs; None without one."""
    least, most = float(found.seen.x.min()), float(found.seen.x.max())
    return found.curve.cut(np.geomspace(least, most, CUT_POINTS))


def _is_sound(found: Fragility | Bivariate) -> bool:
    """Whether nothing speaks against a curve: it is exact, or it is bounded and no test rejects it."""
    curve = getattr(found, "curve", None)  # which surfaces lack
    return curve is not None and (
        curve.is_exact
        or (
            curve.fit is not None
            and curve.p_value is not None
            and not curve.rejected
            and curve.fit.intervals[1].low > 0
        )
    )


def _remarks(found: Fragility | Bivariate) -> Iterator[str]:
    """Say that a dispersion makes no sense, by which limit state a curve is cut, and how often it is exceeded."""
    from rocking_cli.questions.fragility.assess import Fragility

    if not isinstance(found, Fragility):
        return
    if words := senseless(found.curve):
        yield words.strip()
    if (cut := cut_of(found)) is not None:
        of = f"that of {limit_name(cut.by)}, which it implies"
        by = "lambda, up to which nothing uplifts" if cut.by == UPLIFT_MEASURE else of
        yield Aside(f"Curve and band are cut by {by}: by up to {cut.most:.2g} at {cut.at:.3g}.")
    if (rate := found.rate) is not None and rate.rate > 0:
        yield (
            f"Exceeded once in {rate.return_period:,.0f} years (annual rate {rate.low:.3g} to {rate.high:.3g}), "
            f"{100 * rate.in_50_years:.2g} % in 50 years."
        )


def limit_name(limit: Limit) -> str:
    """Return a limit state in words."""
    if isinstance(limit, float):
        return f"> {limit:g} phi_cr"
    return limit if metres(limit) is None else f"top > {limit}"


def _with_interval(estimate: Mapping[str, float]) -> str:
    """Format a number above its confidence interval."""
    value, low, high = estimate.values()
    return f"{value:.4g}\n{'exact' if low == high else f'{low:.3g} - {high:.3g}'}"


def _of(name: str) -> Callable[[Named], Any]:
    """Return a function that reads an attribute of a named fit."""
    read = of(name)
    return lambda row: read(row[1])


def _data_of(read: Callable[[Named], Any]) -> Callable[[Named], dict[str, Any] | None]:
    """Return a function that reads numbers of a named fit as plain data; None if there are none."""
    return lambda row: None if (value := read(row)) is None else asdict(value)


def fit_columns(interval: str = "", width: str = "", *, rated: bool = False) -> list[Column[Named]]:
    """Return the columns of named curves, with the headings of their intervals; and of the rate, if there is one.

    Some columns of a table stand for several of the data.
    """
    spread, scale = _data_of(_of("curve.dispersion")), _data_of(_of("curve.scale"))
    return [
        only_shown("limit state", lambda row: row[0], text=True),
        Column("kind", _of("curve.kind"), head="curve", text=True),
        Column("why", _of("curve.why")),
        Column("median", _data_of(_of("curve.median")), head=f"median\n{interval}", form=_with_interval),
        Column("dispersion", spread),
        Column("scale", scale),
        only_shown(f"{width}\n{interval}", lambda row: spread(row) or scale(row), _with_interval),
        Column("confidence", _of("curve.confidence")),
        Column("goodness", _data_of(_of("curve.goodness")), head="fit p", form=lambda test: number(test["p_value"], 2)),
        *_counts("curve.aic"),
        Column("cut", _data_of(lambda row: cut_of(row[1]))),
        Column("annual_rate", _data_of(_of("rate")), head="rate\n[1/year]" if rated else None,
               form=lambda rate: number(rate["rate"], 3)),
    ]  # fmt: skip


def plane_columns(interval: str = "") -> list[Column[Named]]:
    """Return the columns of named surfaces, with the headings of their intervals."""

    def coefficient(k: int) -> Callable[[Named], Any]:
        return _data_of(lambda row: (row[1].surface.coefficients or [None] * 3)[k])

    return [
        only_shown("limit state", lambda row: row[0], text=True),
        *(only_shown(f"c{k}\n{interval}", coefficient(k), _with_interval) for k in range(3)),
        Column("kind", _of("surface.kind")),
        Column("why", _of("surface.why")),
        Column("coefficients", lambda row: [asdict(each) for each in row[1].surface.coefficients or []]),
        *_counts("surface.aic", "surface.p_values"),
    ]


def _counts(*criteria: str) -> list[Column[Named]]:
    """Return the columns that all fits have, after those of their criteria."""
    return [
        *(Column(name.split(".")[1], _of(name)) for name in criteria),
        Column("runs", _of("fitted.runs")),
        Column("exceedances", _of("fitted.exceedances")),
        Column("distinct_records", _of("fitted.records")),
        Column("warning", lambda row: row[1].fitted.warning or None),
    ]


def _data(found: Fragility | Bivariate, columns: Sequence[Column[Named]], over: Mapping[str, Any]) -> dict[str, Any]:
    """Return a fit as plain data, with the measures that it is over, its undecided runs and its lower edge."""
    return {
        "structure": found.structure,
        "limit_state": found.limit,
        **over,
        **data_of(columns, ("", found)),
        "left_out": found.left_out,
        "unknown": found.unknown,
        "unknown_share": found.share,
        "band": found.is_band,
        "lower": None if found.lower is None else data_of(columns, ("", found.lower)),
    }
