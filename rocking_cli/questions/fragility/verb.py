"""`rk.fragility`: run a fragility study, or continue it, and fit its curves."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import AbstractContextManager, ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rocking_cli.ask.answer import Answer, no_plot
from rocking_cli.ask.given import note_remarks, warn_of
from rocking_cli.ask.numbers import refuse_idle, takes_numbers
from rocking_cli.ask.watcher import SILENT, Watcher
from rocking_cli.errors import InputError

if TYPE_CHECKING:
    from rocking_cli.questions.fragility.plan import Plan
    from rocking_cli.questions.fragility.study import Study
    from rocking_cli.questions.fragility.workers import Workers

MAX_NAMED_PROBLEMS = 10  # bad records or samples that a message names


@takes_numbers
def fragility(
    study: str | Path | Mapping[str, Any],
    *,
    store: str | Path | None = None,
    check: bool = False,
    jobs: int | None = None,
    scheduler: str | None = None,
    restart: bool = False,
    rank_measures: bool = False,
    quantiles: bool = False,
    nrml: str | Path | None = None,
    watch: Watcher = SILENT,
) -> Answer[Any]:
    """Run a fragility study, or continue it, and fit its curves.

    Parameters
    ----------
    study : str, Path or mapping
        YAML file of the study, or its fields in Python, in which a mechanism may stand for the file of a structure;
        docs/fragility.md lists the fields.
    store : str or Path, optional
        File in which the runs are stored; by default next to the study file, or study.db in this folder.
    check : bool
        Whether only to show what would be run; arguments on the runs and their curves are then refused.
    jobs : int, optional
        Number of time histories at a time; by default, one for each processor.
    scheduler : str, optional
        Address of a dask.distributed scheduler, such as "tcp://10.0.0.1:8786", to run there instead.
    restart : bool
        Whether to start from scratch; the existing store is kept under another name.
    rank_measures : bool
        Whether to rank the intensity measures as well, by how well they predict the outcome.
    quantiles : bool
        Whether the quantiles of the peak rotation are shown in words too.
    nrml : str or Path, optional
        File for the curves that OpenQuake can read (.xml).
    watch : Watcher
        Told what is doubtful, which records and samples cannot be run, and how far the runs are.

    Returns
    -------
    StudyAnswer, or Answer of Plan
        One per curve: structure, limit state, measure and fit, as from `results`. If the outcome of some runs is
        unknown, as a joint opens that the model keeps closed, these exceed the limit in the fit and do not in its
        `lower`. With `check`, the plan of the study.

    Raises
    ------
    InputError
        If the study, a file or the store cannot be used; runs that fail are counted in the store, not raised.
    MechanismError
        If the structure has no critical rotation or no uplift acceleration.

    Notes
    -----
    The runs are those of `respond`, Eq. 8 or 16 of DeJong and Dimitrakopoulos (2014); docs/fragility.md explains how
    the curves are fitted.
    """
    from rocking_cli.questions.fragility.results import results
    from rocking_cli.questions.fragility.study import load_study
    from rocking_cli.questions.fragility.tally import held

    if check:
        refuse_idle(
            "with `check`, which runs nothing", jobs=jobs is not None, scheduler=scheduler, restart=restart,
            rank_measures=rank_measures, quantiles=quantiles, nrml=nrml is not None,
        )  # fmt: skip
    file = Path("study") if isinstance(study, Mapping) else Path(study)
    loaded = load_study(study, Path(store or file).stem)
    place = Path(store) if store is not None else file.with_suffix(".db")
    for mechanism in loaded.structures:
        note_remarks(mechanism, watch)
    # Varied properties may differ much from the file, so the first sample is checked.
    for mechanism in {sample.structure: sample.mechanism for sample in loaded.samples if sample.number == 0}.values():
        warn_of(mechanism, watch)
    for sentence in held(loaded):
        watch.warn(sentence)
    if check:
        return _planned(loaded, watch)
    _bring_up_to_date(loaded, place, workers_of(jobs, scheduler), watch, restart=restart, rank_measures=rank_measures)
    return results(place, quantiles=quantiles, rank_measures=rank_measures, nrml=nrml, watch=watch)


def workers_of(jobs: int | None, scheduler: str | None) -> AbstractContextManager[Workers]:
    """Return the workers that simulate the runs: a cluster, or threads of this machine."""
    from rocking_cli.questions.fragility import workers

    if scheduler is None:
        return workers.threads(jobs)
    if jobs is not None:
        raise InputError("`jobs` cannot be combined with `scheduler`: a cluster has its own number of workers")
    return workers.cluster(scheduler)


def _planned(study: Study, watch: Watcher) -> Answer[Plan]:
    """Return the plan of the runs of a study, without simulating them."""
    from rocking_cli.questions.fragility.campaign import examine_study
    from rocking_cli.questions.fragility.view import planned

    with watch.progress(len(study.sources) + len(study.samples), "records and structures") as advance:
        plan, _ = examine_study(study, advance)
    _leave_out(plan, watch)

    columns = {"record": [record.name for record in plan.records]}
    figure = no_plot("the plan of a study has no plot: run the study, and plot its curves")
    return Answer("plan", plan, planned(study, plan), lambda: columns, figure)


def _bring_up_to_date(
    study: Study,
    place: Path,
    workers: AbstractContextManager[Workers],
    watch: Watcher,
    *,
    restart: bool,
    rank_measures: bool,
) -> None:
    """Simulate the runs that the store lacks; on a restart simulate all, and keep the old store."""
    from rocking_cli.questions.fragility.campaign import count_steps, prepare, run
    from rocking_cli.questions.fragility.store import Store

    with ExitStack() as stack:
        # The old store is replaced only when workers are available to run the study again.
        hands = stack.enter_context(workers) if restart else None
        store = stack.enter_context(Store.writing(place, anew=restart, say=watch.note))
        with watch.progress(count_steps(study, rank_measures=rank_measures), "records and structures") as advance:
            prepared = prepare(study, store, advance, rank_measures=rank_measures)
        plan = prepared.plan
        _leave_out(plan, watch)
        doubtful = [record.name for record in plan.records if record.doubts]
        if doubtful:
            named = ", ".join(doubtful[:3]) + (" ..." if len(doubtful) > 3 else "")
            count = "1 record is" if len(doubtful) == 1 else f"{len(doubtful)} records are"
            watch.warn(f"{count} doubtful; run `rocking record FILE` to see why: {named}")
        for name in prepared.mended:
            watch.note(f"{name}: could not be used when the study was started; it is run now")
        if prepared.finished:
            watch.note(f"{prepared.finished} of {plan.total} runs are in the store already")
        if prepared.finished == plan.total:
            return
        hands = hands or stack.enter_context(workers)
        with watch.progress(plan.total, "runs", done=prepared.finished, failed=prepared.failed) as advance:
            run(prepared, store, hands, advance)


def _leave_out(plan: Plan, watch: Watcher) -> None:
    """Tell which records and samples cannot be run: the first by name."""
    from rocking_cli.questions.fragility.view import left_out

    bad = left_out(plan)
    for sentence in bad[:MAX_NAMED_PROBLEMS]:
        watch.leave_out(InputError(sentence))
    if len(bad) > MAX_NAMED_PROBLEMS:
        watch.leave_out(
            InputError(f"and {len(bad) - MAX_NAMED_PROBLEMS} more: the JSON of `rocking results` names all")
        )
