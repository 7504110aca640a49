"""`rk.fragility`: run a fragility study, or continue it, and fit its curves."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import AbstractContextManager, ExitStack
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any, Literal
from weakref import finalize

from rocking_cli.ask.answer import Answer, no_plot
from rocking_cli.ask.given import note_remarks, warn_of
from rocking_cli.ask.ground_motions import each_of
from rocking_cli.ask.numbers import refuse_idle, takes_numbers
from rocking_cli.ask.watcher import SILENT, Watcher
from rocking_cli.errors import InputError, Problem
from rocking_cli.studies.engines import engine_of
from rocking_cli.views.engines import cost_in_words
from rocking_cli.views.view import View

if TYPE_CHECKING:
    from rocking_cli.core import Mechanism
    from rocking_cli.excitation.base import GroundMotion
    from rocking_cli.excitation.pulses import Pulse
    from rocking_cli.questions.fragility.plan import Plan
    from rocking_cli.questions.fragility.study import Study
    from rocking_cli.questions.fragility.workers import Workers
    from rocking_cli.studies.engines import EngineName

    Structures = Mechanism | str | Path | Mapping[str, Any] | Sequence[Mechanism | str | Path | Mapping[str, Any]]
    Shaking = GroundMotion | Pulse | str | Path | Mapping[str, Any]
    Records = Shaking | Sequence[Shaking]

MAX_NAMED_PROBLEMS = 10  # bad records or samples that a message names


@takes_numbers
def fragility(
    study: str | Path | Mapping[str, Any] | None = None,
    *,
    structures: Structures | None = None,
    records: Records | None = None,
    method: Literal["cloud", "stripes", "ida"] | None = None,
    levels: Mapping[str, Any] | None = None,
    polarities: Sequence[int] | None = None,
    eta: Sequence[float] | None = None,
    samples: int | None = None,
    sampling: Literal["random", "latin hypercube"] | None = None,
    seed: int | None = None,
    model: Literal["nonlinear", "linear1", "linear2"] | None = None,
    engine: Literal["exact", "blocks", "auto"] | None = None,
    opening: float | None = None,
    limit_states: Sequence[str | float] | None = None,
    measures: Sequence[str] | None = None,
    bivariate: Sequence[Sequence[str]] | None = None,
    confidence: float | None = None,
    hazard: Mapping[str, Any] | None = None,
    processing: Sequence[str | Mapping[str, Any]] | None = None,
    floor: str | Mapping[str, Any] | None = None,
    name: str | None = None,
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
    study : str, Path or mapping, optional
        YAML file of the study, or its fields in Python; docs/fragility.md lists them. Give this, or the fields
        themselves as the arguments that follow.
    structures : Mechanism, str, Path or mapping, or a list of these
        Structures or their files; or entries with a structure or a file as `file`, and `name` and `vary`.
    records : GroundMotion, Pulse, str, Path or mapping, or a list of these
        Ground motions, files of records or patterns of them, and pulses such as "sine:1g:0.8s"; or entries with a
        motion or a file as `file`, and its `weight`, `level`, `processing` and so on.
    method : {"cloud", "stripes", "ida"}
        How records and intensities are combined.
    levels : mapping
        Intensities to which every record is scaled: `measure`, and `values` or `least`, `most` and `count`.
    polarities : sequence of int
        [1], or [1, -1] to run reversed records as well.
    eta : sequence of float
        Coefficients of restitution, instead of those of the structures.
    samples, seed : int
        Number of structures to draw from the distributions in `vary`, and seed of the random numbers.
    sampling : {"latin hypercube", "random"}
        How they are drawn.
    model : {"nonlinear", "linear1", "linear2"}
        Equation of motion.
    engine : {"exact", "blocks", "auto"}
        Who simulates the runs: one degree of freedom, free blocks, or free blocks where one degree of freedom does not
        tell the outcome. Free blocks run in processes unless `jobs` is 1: a script then needs
        `if __name__ == "__main__"`.
    opening : float
        Largest opening of a joint over D_cr up to which a run holds.
    limit_states : sequence of str or float
        "uplift", "sliding", "overturning", ratios phi/phi_cr, and displacements of the top such as "25 mm".
    measures, bivariate : sequence of str, sequence of pairs of str
        Intensity measures of the curves, and of the surfaces.
    confidence : float
        Confidence level of intervals and bands.
    hazard : mapping
        `measure`, and `file` or `points` of intensity and annual rate.
    processing, floor : sequence, str or mapping
        Corrections of every record, and the floor on which the structures stand.
    name : str
        Name of the study.
    store : str or Path, optional
        File in which the runs are stored; by default next to the study file. Without a study file and a store, the
        runs last as long as the answer, and those of a study that is interrupted are lost.
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
        One per curve: structure, limit state, measure and fit, as from `results`, with `curves`, `to_frame()` and
        `runs()`. If the outcome of some runs is unknown, as a joint opens that the model keeps closed, these exceed the
        limit in the fit and do not in its `lower`. With `check`, the plan of the study.

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

    Examples
    --------
    >>> import rocking_cli as rk
    >>> pulses = [f"{shape}:1g:{period}s" for shape in ("sine", "ricker") for period in (0.6, 0.8, 1.0, 1.2)]
    >>> answer = rk.fragility(
    ...     structures=rk.Block(name="pedestal", width=0.7, height=2.8),
    ...     records=pulses,
    ...     method="stripes",
    ...     levels={"measure": "PGA", "least": 0.1, "most": 1.5, "count": 8},
    ... )
    >>> round(answer.curves["overturning"].median.value, 2), len(answer.runs())
    (0.59, 64)
    """
    from rocking_cli.questions.fragility.results import results
    from rocking_cli.questions.fragility.study import load_study
    from rocking_cli.questions.fragility.tally import held

    fields: dict[str, Any] = {
        "structures": structures, "records": records, "method": method, "levels": levels, "polarities": polarities,
        "eta": eta, "samples": samples, "sampling": sampling, "seed": seed, "model": model, "engine": engine,
        "opening": opening, "limit_states": limit_states, "measures": measures, "bivariate": bivariate,
        "confidence": confidence, "hazard": hazard, "processing": processing, "floor": floor, "name": name,
    }  # fmt: skip
    fields = {key: value for key, value in fields.items() if value is not None}
    fields |= {key: each_of(fields[key]) for key in ("structures", "records") if key in fields}
    if study is not None:
        refuse_idle("beside a study: put them into it", **dict.fromkeys(fields, True))
    elif not fields:
        raise InputError(Problem("is missing", field="`study`", hint="give a study, or `structures`, `records` ..."))
    given = fields if study is None else study
    if check:
        refuse_idle(
            "with `check`, which runs nothing", jobs=jobs is not None, scheduler=scheduler, restart=restart,
            rank_measures=rank_measures, quantiles=quantiles, nrml=nrml is not None,
        )  # fmt: skip
    file = None if isinstance(given, Mapping) else Path(given)
    if store is None and file is None:
        refuse_idle("without a store or a study file", restart=restart)
    loaded = load_study(given, Path(store or "study").stem)
    for mechanism in loaded.structures:
        note_remarks(mechanism, watch)
    # Varied properties may differ much from the file, so the first sample is checked.
    for mechanism in {sample.structure: sample.mechanism for sample in loaded.samples if sample.number == 0}.values():
        warn_of(mechanism, watch)
    for sentence in held(loaded):
        watch.warn(sentence)
    if check:
        return _planned(loaded, watch)
    with ExitStack() as stack:
        if store is not None:
            place = Path(store)
        elif file is not None:
            place = file.with_suffix(".db")
        else:
            folder = TemporaryDirectory(prefix="rocking-", ignore_cleanup_errors=True)
            place = Path(stack.enter_context(folder)) / "study.db"
        workers = workers_of(jobs, scheduler, loaded.definition.engine)
        _bring_up_to_date(loaded, place, workers, watch, restart=restart, rank_measures=rank_measures)
        answer = results(place, quantiles=quantiles, rank_measures=rank_measures, nrml=nrml, watch=watch)
        if store is None and file is None:
            answer = replace(answer, view=View(answer.to_dict() | {"store": None}, answer.view.parts))
        finalize(answer, stack.pop_all().close)  # a temporary store lasts as long as the answer
    return answer


def workers_of(
    jobs: int | None, scheduler: str | None, engine: EngineName = "exact"
) -> AbstractContextManager[Workers]:
    """Return the workers that simulate the runs: a cluster, or threads or processes of this machine."""
    from rocking_cli.questions.fragility import workers

    if scheduler is None:
        return workers.threads(jobs) if engine == "exact" or jobs == 1 else workers.processes(jobs)
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
    from rocking_cli.questions.fragility.campaign import SIMULATED_BY, count_steps, left_of_each, prepare, run
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
        for engine in SIMULATED_BY[study.definition.engine]:
            finished, failed = store.count()
            if finished == plan.total:
                return
            hands = hands or stack.enter_context(workers)
            if engine == "blocks":
                for name, structure, motion, left in left_of_each(prepared, store):
                    cost = cost_in_words(engine_of("blocks"), structure, motion, left, hands.count)
                    watch.note(f"{name}: {cost}" if len(plan.structures) > 1 else cost)
            with watch.progress(plan.total, "runs", done=finished, failed=failed) as advance:
                run(prepared, store, hands, advance, engine)


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
