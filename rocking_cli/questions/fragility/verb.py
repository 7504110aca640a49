"""`rk.fragility`: run a fragility study, or continue it, and fit its curves."""

from __future__ import annotations

import re
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any
from weakref import finalize

from rocking_cli.ask.answer import Answer, no_plot
from rocking_cli.ask.inputs import note_remarks, warn_of
from rocking_cli.ask.verbs import verb
from rocking_cli.ask.watcher import Watcher
from rocking_cli.errors import InputError, Refused, named
from rocking_cli.io.files import folder, keep_apart
from rocking_cli.questions.fragility.asked import FragilityAsked, OfCurves
from rocking_cli.studies.engines import engine_of
from rocking_cli.views.engines import cost_in_words

if TYPE_CHECKING:
    from rocking_cli.questions.fragility.campaign import Left, Prepared
    from rocking_cli.questions.fragility.plan import Plan
    from rocking_cli.questions.fragility.study import Study

MAX_NAMED_PROBLEMS = 10  # bad records or samples that a message names


@verb(FragilityAsked)
def fragility(asked: FragilityAsked, watch: Watcher) -> Answer[Any]:
    """Run a fragility study, or continue it, and fit its curves.

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
    ...     rk.Block(name="pedestal", width=0.7, height=2.8),
    ...     pulses,
    ...     method="stripes",
    ...     levels={"measure": "PGA", "least": 0.1, "most": 1.5, "count": 8},
    ... )
    >>> round(answer.curves["overturning"].median.value, 2), len(answer.runs())
    (0.59, 64)
    """
    from rocking_cli.questions.fragility.results import results
    from rocking_cli.questions.fragility.store import CONTINUE_HINT
    from rocking_cli.questions.fragility.study import load_study
    from rocking_cli.questions.fragility.tally import held

    try:
        loaded = load_study(asked.study, asked.store.stem if asked.store is not None else "study")
    except InputError as error:
        if asked.motions is None:
            raise
        problems = (replace(each, field=re.sub("^records", "motions", each.field or "")) for each in error.problems)
        raise InputError(*problems) from None
    if asked.file is not None and asked.store is None:
        keep_apart([("the store beside the study", asked.place), (named("nrml"), asked.nrml)], [str(asked.file)])
    for mechanism in loaded.structures:
        note_remarks(mechanism, watch)
    # Varied properties may differ much from the file, so the first sample is checked.
    for mechanism in {sample.structure: sample.mechanism for sample in loaded.samples if sample.number == 0}.values():
        warn_of(mechanism, watch)
    for sentence in held(loaded):
        watch.warn(sentence)
    if asked.check:
        return _planned(loaded, watch)
    if asked.plot is not None:
        folder(str(asked.plot))
    with ExitStack() as stack:
        if (place := asked.place) is None:
            temporary = TemporaryDirectory(prefix="rocking-", ignore_cleanup_errors=True)
            place = Path(stack.enter_context(temporary)) / "study.runs"
        try:
            prepared = _bring_up_to_date(loaded, place, watch, asked)
        except (KeyboardInterrupt, Refused) as stopped:
            if asked.place is not None:
                stopped.add_note(CONTINUE_HINT)
            raise
        if asked.share is not None:
            return _share(prepared, asked.share)
        answer = results(place, **asked.part(OfCurves), watch=watch)
        if asked.place is None:
            answer = replace(answer, view=answer.view.plus(lambda: {"store": None}))
        finalize(answer.plan, stack.pop_all().close)  # a temporary store lasts as long as the answer and its copies
    return answer


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


def _bring_up_to_date(study: Study, place: Path, watch: Watcher, asked: FragilityAsked) -> Prepared:
    """Simulate the runs that the store lacks; on a restart simulate all, and keep the old store."""
    from rocking_cli.questions.fragility import campaign
    from rocking_cli.questions.fragility.store import Store
    from rocking_cli.questions.fragility.workers import cluster, processes, threads

    if asked.scheduler is not None:
        workers = cluster(asked.scheduler)
    else:
        workers = (threads if study.definition.engine == "exact" or asked.jobs == 1 else processes)(asked.jobs)

    def damaged(file: str) -> None:
        watch.warn(f"damaged, and computed again: {file}")

    share = asked.share or campaign.WHOLE
    with ExitStack() as stack:
        # The old store is replaced only when workers are available to run the study again.
        hands = stack.enter_context(workers) if asked.restart else None
        store = Store.writing(place, anew=asked.restart, say=watch.note)
        steps = len(study.samples) + 2 * len(study.sources)  # a record is examined, and then measured
        with watch.progress(steps, "records and structures") as advance:
            prepared = campaign.prepare(study, store, advance, rank_measures=asked.rank_measures)
        plan, engines = prepared.plan, campaign.SIMULATED_BY[study.definition.engine]
        _leave_out(plan, watch)
        if doubtful := [record.name for record in plan.records if record.doubts]:
            named = ", ".join(doubtful[:3]) + (" ..." if len(doubtful) > 3 else "")
            count = "1 record is" if len(doubtful) == 1 else f"{len(doubtful)} records are"
            watch.warn(f"{count} doubtful; run `rocking record FILE` to see why: {named}")
        for name in prepared.mended:
            watch.note(f"{name}: could not be used when the study was started; it is run now")
        for engine in engines:
            there = campaign.left(prepared, engine, share, damaged)
            if there.finished and engine == engines[0]:
                watch.note(f"{there.finished} of {there.total} runs are in the store already")
            if not there.chunks:
                continue
            hands = hands or stack.enter_context(workers)
            if engine == "blocks":
                for name, structure, motion, runs in campaign.left_of_each(prepared, there.chunks):
                    cost = cost_in_words(engine_of("blocks"), structure, motion, runs, hands.count())
                    watch.note(f"{name}: {cost}" if len(plan.structures) > 1 else cost)
            with watch.progress(there.total, "runs", done=there.finished, failed=there.failed) as advance:
                campaign.run(prepared, hands, engine, there.chunks, advance)
        return prepared


def _share(prepared: Prepared, share: tuple[int, int]) -> Answer[Left]:
    """Return how many runs of a part are in the store."""
    from rocking_cli.questions.fragility.campaign import SIMULATED_BY, left
    from rocking_cli.questions.fragility.view import shared

    done = left(prepared, SIMULATED_BY[prepared.study.definition.engine][-1], share)
    figure = no_plot("a part of the runs has no plot: plot the curves of all of them")
    shown = shared(prepared.store.path, share, done)
    return Answer("share", done, shown, lambda: {"finished": [done.finished]}, figure)


def _leave_out(plan: Plan, watch: Watcher) -> None:
    """Tell which records and samples cannot be run: the first by name."""
    from rocking_cli.questions.fragility.view import left_out

    bad = left_out(plan)
    more = len(bad) - MAX_NAMED_PROBLEMS
    others = [f"and {more} more: the JSON of `rocking results` names all"] if more > 0 else []
    for sentence in bad[:MAX_NAMED_PROBLEMS] + others:
        watch.leave_out(InputError(sentence))
