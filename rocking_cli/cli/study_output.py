"""Show, draw and write the contents of the store of a fragility study."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from rocking_cli.cli import terminal
from rocking_cli.errors import InputError, Problem

if TYPE_CHECKING:
    from rocking_cli.studies.fragility.assess import Bivariate, Fragility, UnknownRuns
    from rocking_cli.studies.fragility.definition import Definition
    from rocking_cli.studies.fragility.plan import Plan
    from rocking_cli.studies.fragility.store import Store
    from rocking_cli.views.view import View


@dataclass(frozen=True)
class CurveOutput:
    """Additional outputs of curves: plots, a file for OpenQuake, quantiles and a ranking of measures."""

    plot: str | None
    nrml: Path | None
    quantiles: bool
    rank_measures: bool


@dataclass(frozen=True)
class Tables:
    """Files of the tables of runs and of curves."""

    out: Path | None = None
    curves: Path | None = None


def show_study(store: Store, shown: CurveOutput, tables: Tables = Tables(), *, as_json: bool) -> bool:
    """Show what a store holds, write its runs and curves and draw them.

    Returns
    -------
    bool
        Whether the store is complete, and all records, samples and runs could be used.
    """
    from rocking_cli.studies.fragility.quantiles import all_quantiles
    from rocking_cli.views.fragility import left_out, view
    from rocking_cli.views.quantiles import with_quantiles

    plan, definition = store.plan(), _definition(store)
    finished, failed = store.count()
    curves, surfaces, outcomes = _fitted(store, plan, definition)
    if tables.out is not None:
        _write(tables.out, store, plan, definition)
    if tables.curves is not None:
        _write_curves(tables.curves, curves)
    asked = shown.quantiles or as_json or shown.plot is not None
    spread = list(all_quantiles(store, plan, definition)) if asked else []
    if shown.plot is not None:
        from rocking_cli.cli.study_pictures import draw_all

        draw_all(Path(shown.plot), store, definition, curves, surfaces, spread)
    result = view(store, plan, definition, finished, failed, curves, surfaces, outcomes)
    result = with_quantiles(result, spread, in_words=shown.quantiles)
    if shown.rank_measures:
        result = _with_ranking(result, store, plan, definition, shown)
    terminal.show(result, as_json=as_json)
    if shown.nrml is not None:  # last: curves that OpenQuake cannot read have been shown
        _write_nrml(shown.nrml, store, str(result.parts[0]), curves)
    if failed:
        terminal.error(f"{failed} runs could not be simulated and are left out of the curves")
    return finished == plan.total and not failed and not left_out(plan)


def _definition(store: Store) -> Definition:
    """Return the definition of the study of a store."""
    from pydantic import ValidationError

    from rocking_cli.studies.fragility.definition import Definition

    try:
        return Definition.model_validate(store.fact("definition"))
    except ValidationError:
        hint = "run `rocking fragility STUDY.yaml`: it names the problem and keeps the runs"
        raise InputError(
            Problem("the definition of its study is not valid in this version", str(store.path), hint=hint)
        ) from None


def _with_ranking(result: View, store: Store, plan: Plan, definition: Definition, shown: CurveOutput) -> View:
    """Add the ranking of measures to a view; draw it too if plots are requested."""
    from rocking_cli.studies.fragility.ranking import rank
    from rocking_cli.views.ranking import added

    with terminal.progress(plan.size, "runs ranked") as counted:
        rankings = rank(store, plan, definition, counted)
    if shown.plot is not None:
        from rocking_cli.cli.study_pictures import draw_rankings

        draw_rankings(Path(shown.plot), rankings)
    return added(result, rankings)


def _fitted(
    store: Store, plan: Plan, definition: Definition
) -> tuple[list[Fragility], list[Bivariate], list[UnknownRuns]]:
    """Count the runs of a store, and fit the curves of its study."""
    import numpy as np

    from rocking_cli.studies.fragility import assess
    from rocking_cli.studies.fragility.hazard_curve import HazardCurve

    points = store.fact("hazard")
    hazard = HazardCurve(*np.array(points)) if points is not None else None
    with terminal.progress(plan.size, "runs counted") as counted:
        found = assess.counted(store, plan, definition, counted)
    each = len(definition.limit_states) * (len(definition.fitted_measures) + len(definition.bivariate))
    with terminal.progress(each * len(found), "fits") as advance:
        return *assess.fitted(found, definition, hazard, advance), assess.outcomes(found)


def _write(out: Path, store: Store, plan: Plan, definition: Definition) -> None:
    from rocking_cli.cli import table_files
    from rocking_cli.studies.fragility.table import blocks

    table_files.write(out, blocks(store, plan, definition.asked_measures))


def _write_curves(out: Path, curves: Sequence[Fragility]) -> None:
    from rocking_cli.cli import table_files
    from rocking_cli.views.fragility import edges
    from rocking_cli.views.fragility_table import blocks

    for each in curves:
        for name, fit in edges([each]):
            if fit.curve.kind == "none":
                terminal.warning(f"{each.structure}, {name} against {each.measure}: no curve: {fit.curve.why}")
    table_files.write(out, blocks(curves))


def _write_nrml(out: Path, store: Store, said: str, curves: Sequence[Fragility]) -> None:
    """Write the curves that OpenQuake can read, and name the others."""
    from rocking_cli.io.files import write_whole
    from rocking_cli.studies.fragility.openquake import chosen
    from rocking_cli.views.nrml import nrml

    model = chosen(curves)
    for each in model.left_out:
        terminal.warning(f"not in {out}: {each}")
    for each in model.doubts:
        terminal.warning(each)
    about = f"{said}; rocking-cli {store.fact('versions')['rocking-cli']}, study {store.fact('hash')[:12]}"
    document = nrml(model, store.fact("name"), about)
    write_whole(out, lambda stream: stream.write(document))
    terminal.note(f"wrote {out}")
