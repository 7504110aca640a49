"""How a fragility study is shown: what would be run, and what was found."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rocking_cli.cli import terminal
from rocking_cli.errors import INCOMPLETE as INCOMPLETE
from rocking_cli.errors import InputError, Problem
from rocking_cli.views.view import ABSENT, number

if TYPE_CHECKING:
    from rocking_cli.studies.fragility.assess import Bivariate, Fragility
    from rocking_cli.studies.fragility.curves import Curve, Estimate, Surface
    from rocking_cli.studies.fragility.definition import Definition, Limit
    from rocking_cli.studies.fragility.hazard import HazardCurve, Rate
    from rocking_cli.studies.fragility.plan import Plan
    from rocking_cli.studies.fragility.store import Store
    from rocking_cli.studies.fragility.study import Study

NAMED = 10  # bad records or samples named one by one


def print_check(study: Study, *, as_json: bool) -> bool:
    """Examine the records and structures of a study, and say what it would run.

    Returns
    -------
    bool
        Whether all of them can be used.
    """
    from rocking_cli.studies.fragility.campaign import survey

    with terminal.progress(len(study.sources) + len(study.samples), "records and structures") as examined:
        plan, _ = survey(study, examined)
    report_useless(plan)
    samples, records, etas, levels, polarities = plan.shape
    counts = {
        "structures": len(study.structures),
        "samples": samples,
        "records": records,
        "eta": etas,
        "levels": levels,
        "polarities": polarities,
    }
    bad = _useless(plan)
    if as_json:
        terminal.print_json({"study": study.name, **counts, "runs": plan.total, "left_out": bad})
    else:
        rows = [[name, f"{count}"] for name, count in counts.items()]
        terminal.table(study.name, ["", "number"], [*rows, ["runs", f"{plan.total:,}"]], numbers=(1,))
    return not bad


def give(store: Store, out: Path | None, pictures: Path | None, *, as_json: bool) -> bool:
    """Show what a store holds, write its runs and draw its curves.

    Returns
    -------
    bool
        Whether all records, samples and runs could be used, and all are there.
    """
    import numpy as np
    from pydantic import ValidationError

    from rocking_cli.studies.fragility.definition import Definition
    from rocking_cli.studies.fragility.hazard import HazardCurve

    plan = store.plan()
    try:
        definition = Definition.model_validate(store.fact("definition"))
    except ValidationError:
        hint = "`rocking fragility STUDY.yaml` says what, and keeps the runs"
        raise InputError(Problem("its study asks for what is refused today", str(store.path), hint=hint)) from None
    points = store.fact("hazard")
    finished, failed = store.count()
    curves, surfaces = _fitted(store, plan, definition, HazardCurve(*np.array(points)) if points is not None else None)
    if out is not None:
        _write(out, store, plan)
    if pictures is not None:
        from rocking_cli.cli.fragility_pictures import draw_all

        draw_all(pictures, store, definition, curves, surfaces)
    if as_json:
        terminal.print_json(_as_json(store, plan, finished, failed, curves, surfaces))
    else:
        _print(store.fact("name"), definition, plan, finished, failed, curves, surfaces)
    if failed:
        terminal.error(f"{failed} runs could not be followed, and are left out of the curves")
    return finished == plan.total and not failed and not _useless(plan)


def _fitted(
    store: Store, plan: Plan, definition: Definition, hazard: HazardCurve | None
) -> tuple[list[Fragility], list[Bivariate]]:
    """Count the runs of a store, and fit what its study asks for."""
    from rocking_cli.studies.fragility import assess, tally

    curves: list[Fragility] = []
    surfaces: list[Bivariate] = []
    structures = assess.structures(plan)
    each = len(definition.limit_states) * (len(definition.fitted_measures) + len(definition.bivariate))
    ladders = definition.method == "ida"
    measures = [*definition.fitted_measures, *(one for pair in definition.bivariate for one in pair)]
    with terminal.progress(plan.size, "runs counted") as counted:
        found = {
            name: tally.count(store, plan, name, definition.limit_states, measures, ladders=ladders, counted=counted)
            for name in structures
        }
    with terminal.progress(each * len(structures), "fits") as advance:
        for structure, runs in found.items():
            if not runs.runs.any():
                continue
            for curve in assess.curves(runs, structure, definition, hazard):
                curves.append(curve)
                advance(1)
            for surface in assess.surfaces(runs, structure, definition):
                surfaces.append(surface)
                advance(1)
    return curves, surfaces


def report_useless(plan: Plan) -> None:
    """Name the records and the samples that cannot be run."""
    bad = _useless(plan)
    for each in bad[:NAMED]:
        terminal.error(each)
    if len(bad) > NAMED:
        terminal.error(f"and {len(bad) - NAMED} more: `rocking results STORE --json` names all")


def _useless(plan: Plan) -> list[str]:
    records = [f"the record {each.name} is left out: {each.reason}" for each in plan.records if each.reason is not None]
    return records + [
        f"sample {each.number} of {each.structure} is left out: {each.reason}"
        for each in plan.trials
        if each.reason is not None
    ]


def _write(out: Path, store: Store, plan: Plan) -> None:
    from rocking_cli.io.tables import write_table
    from rocking_cli.studies.fragility.table import blocks

    write_table(out, blocks(store, plan))
    terminal.note(f"wrote {out}")


def _print(
    name: str,
    definition: Definition,
    plan: Plan,
    finished: int,
    failed: int,
    curves: Sequence[Fragility],
    surfaces: Sequence[Bivariate],
) -> None:
    bad = sum(each.reason is not None for each in plan.records)
    good = len(plan.records) - bad
    records = f"{good} record{'s' * (good != 1)}" + (f" ({bad} more cannot be used)" if bad else "")
    so_far = "" if finished == plan.total else f" of {plan.total:,}, so far"
    terminal.result(f"{name}: {definition.method}, {records}, {finished:,} runs{so_far}, seed {definition.seed}")
    for structure, measure in dict.fromkeys((each.structure, each.measure) for each in curves):
        these = [each for each in curves if (each.structure, each.measure) == (structure, measure)]
        _print_curves(structure, measure, these, definition.confidence)
    for structure, measures in dict.fromkeys((each.structure, each.measures) for each in surfaces):
        those = [each for each in surfaces if (each.structure, each.measures) == (structure, measures)]
        _print_surfaces(structure, measures, those, definition.confidence)


def _print_curves(structure: str, measure: str, curves: Sequence[Fragility], confidence: float) -> None:
    from rocking_cli.studies.fragility.intensity import label

    interval = f"{100 * confidence:g} %"
    columns = ["limit state", "curve", f"median\n{interval}", f"spread\n{interval}", "fit p"]
    rated = any(each.rate is not None for each in curves)
    rows = [
        [
            limit_name(each.limit),
            each.curve.kind,
            _estimate(each.curve.median),
            _estimate(spread(each.curve)),
            number(None if each.curve.goodness is None else each.curve.goodness.p_value, 2),
            *([number(None if each.rate is None else each.rate.rate, 3)] if rated else []),
        ]
        for each in curves
    ]
    terminal.result()
    headings = [*columns, "a year"] if rated else columns
    terminal.table(f"{structure}, over {label(measure)}", headings, rows, numbers=range(2, len(headings)))
    for each in curves:
        terminal.result(f"{limit_name(each.limit)}: {each.curve.why}.{_in_years(each.rate)}")
    _print_warnings([each.curve for each in curves])


def _print_warnings(fitted: Sequence[Curve | Surface]) -> None:
    """What to be careful about in some fits, each thing once; with the result, as it belongs to the numbers."""
    for warning in dict.fromkeys(each.warning for each in fitted if each.warning):
        terminal.result(f"Warning: {warning}.")


def _in_years(rate: Rate | None) -> str:
    if rate is None or rate.rate == 0:
        return ""
    return (
        f" Once in {rate.return_period:,.0f} years ({rate.low:.3g} to {rate.high:.3g} a year), "
        f"{100 * rate.in_50_years:.2g} % in 50 years."
    )


def _print_surfaces(
    structure: str, measures: tuple[str, str], surfaces: Sequence[Bivariate], confidence: float
) -> None:  # fmt: skip
    one, other = measures
    interval = f"{100 * confidence:g} %"
    rows = [
        [limit_name(each.limit), *(_estimate(c) for c in each.surface.coefficients or (None, None, None))]
        for each in surfaces
    ]
    terminal.result()
    terminal.table(
        f"{structure}: P = Phi(c0 + c1 ln({one}) + c2 ln({other}))",
        ["limit state", *(f"{name}\n{interval}" for name in ("c0", "c1", "c2"))],
        rows,
        numbers=(1, 2, 3),
    )
    for each in surfaces:
        terminal.result(f"{limit_name(each.limit)}: {each.surface.why}.")
    _print_warnings([each.surface for each in surfaces])


def limit_name(limit: Limit) -> str:
    """A limit state as people read it."""
    return limit if isinstance(limit, str) else f"> {limit:g} phi_cr"


def spread(curve: Curve) -> Estimate | None:
    """The dispersion of a lognormal curve, or the scale of a logistic one."""
    return curve.dispersion or curve.scale


def _estimate(estimate: Estimate | None) -> str:
    """A number above its interval."""
    return ABSENT if estimate is None else f"{estimate.value:.4g}\n{estimate.low:.3g} - {estimate.high:.3g}"


def _as_json(
    store: Store,
    plan: Plan,
    finished: int,
    failed: int,
    curves: Sequence[Fragility],
    surfaces: Sequence[Bivariate],
) -> dict[str, Any]:
    return {
        "study": store.fact("name"),
        "store": str(store.path),
        "hash": store.fact("hash"),
        "versions": store.fact("versions"),
        "libraries": store.fact("libraries"),
        "seed": store.fact("description")["seed"],
        "runs": plan.total,
        "finished": finished,
        "failed": failed,
        "left_out": _useless(plan),
        "records": [asdict(each) for each in plan.records],
        "curves": [_curve_json(each) for each in curves],
        "surfaces": [
            {
                "structure": each.structure,
                "limit_state": each.limit,
                "measures": list(each.measures),
                "kind": each.surface.kind,
                "why": each.surface.why,
                "coefficients": [asdict(c) for c in each.surface.coefficients or []],
                "aic": each.surface.aic,
                "p_values": each.surface.p_values,
                "runs": each.surface.runs,
                "exceedances": each.surface.exceedances,
                "distinct_records": each.surface.records,
                "warning": each.surface.warning or None,
            }
            for each in surfaces
        ],
    }


def _curve_json(found: Fragility) -> dict[str, Any]:
    curve = found.curve
    return {
        "structure": found.structure,
        "limit_state": found.limit,
        "measure": found.measure,
        "kind": curve.kind,
        "why": curve.why,
        **{
            name: None if each is None else asdict(each)
            for name, each in (("median", curve.median), ("dispersion", curve.dispersion), ("scale", curve.scale))
        },
        "confidence": curve.confidence,
        "goodness": None if curve.goodness is None else asdict(curve.goodness),
        "aic": curve.aic,
        "runs": curve.runs,
        "exceedances": curve.exceedances,
        "distinct_records": curve.records,
        "warning": curve.warning or None,
        "annual_rate": None if found.rate is None else asdict(found.rate),
    }
