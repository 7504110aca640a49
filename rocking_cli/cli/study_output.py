"""What the store of a fragility study holds: shown, drawn, and written to a file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from rocking_cli.cli import terminal
from rocking_cli.errors import InputError, Problem

if TYPE_CHECKING:
    from rocking_cli.studies.fragility.assess import Bivariate, Fragility
    from rocking_cli.studies.fragility.definition import Definition
    from rocking_cli.studies.fragility.plan import Plan
    from rocking_cli.studies.fragility.store import Store
    from rocking_cli.views.view import View


def show_study(
    store: Store, out: Path | None, pictures: Path | None, *, as_json: bool, rank_measures: bool = False
) -> bool:  # fmt: skip
    """Show what a store holds, write its runs and draw its curves.

    Returns
    -------
    bool
        Whether all records, samples and runs could be used, and all are there.
    """
    from pydantic import ValidationError

    from rocking_cli.studies.fragility.definition import Definition
    from rocking_cli.views.fragility import left_out, view

    plan = store.plan()
    try:
        definition = Definition.model_validate(store.fact("definition"))
    except ValidationError:
        hint = "`rocking fragility STUDY.yaml` says what, and keeps the runs"
        raise InputError(Problem("its study asks for what is refused today", str(store.path), hint=hint)) from None
    finished, failed = store.count()
    curves, surfaces = _fitted(store, plan, definition)
    if out is not None:
        _write(out, store, plan, definition)
    if pictures is not None:
        from rocking_cli.cli.study_pictures import draw_all

        draw_all(pictures, store, definition, curves, surfaces)
    shown = view(store, plan, definition, finished, failed, curves, surfaces)
    if rank_measures:
        shown = _with_ranking(shown, store, plan, definition, pictures)
    terminal.show(shown, as_json=as_json)
    if failed:
        terminal.error(f"{failed} runs could not be followed, and are left out of the curves")
    return finished == plan.total and not failed and not left_out(plan)


def _with_ranking(shown: View, store: Store, plan: Plan, definition: Definition, pictures: Path | None) -> View:
    """What is shown, and which measures serve; drawn too if there are to be pictures."""
    from rocking_cli.studies.fragility.ranking import rank
    from rocking_cli.views.ranking import added

    with terminal.progress(plan.size, "runs ranked") as counted:
        rankings = rank(store, plan, definition, counted)
    if pictures is not None:
        from rocking_cli.cli.study_pictures import draw_rankings

        draw_rankings(pictures, rankings)
    return added(shown, rankings)


def _fitted(store: Store, plan: Plan, definition: Definition) -> tuple[list[Fragility], list[Bivariate]]:
    """Count the runs of a store, and fit what its study asks for."""
    import numpy as np

    from rocking_cli.studies.fragility import assess
    from rocking_cli.studies.fragility.hazard import HazardCurve

    points = store.fact("hazard")
    hazard = HazardCurve(*np.array(points)) if points is not None else None
    with terminal.progress(plan.size, "runs counted") as counted:
        found = assess.counted(store, plan, definition, counted)
    each = len(definition.limit_states) * (len(definition.fitted_measures) + len(definition.bivariate))
    with terminal.progress(each * len(found), "fits") as advance:
        return assess.fitted(found, definition, hazard, advance)


def _write(out: Path, store: Store, plan: Plan, definition: Definition) -> None:
    from rocking_cli.cli import table_files
    from rocking_cli.studies.fragility.table import blocks

    table_files.write(out, blocks(store, plan, definition.asked_measures))
