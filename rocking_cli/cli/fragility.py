"""`rocking fragility`: run a study of many structures, records and intensities, and fit its curves."""

from __future__ import annotations

from contextlib import AbstractContextManager, ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import click

from rocking_cli.cli import endings, options, terminal
from rocking_cli.cli.defaults import from_default
from rocking_cli.cli.help import Command
from rocking_cli.cli.study_output import CurveOutput, show_study
from rocking_cli.errors import INCOMPLETE

if TYPE_CHECKING:
    from rocking_cli.studies.fragility.campaign import Prepared
    from rocking_cli.studies.fragility.plan import Plan
    from rocking_cli.studies.fragility.study import Study
    from rocking_cli.studies.fragility.workers import Workers

NAMED = 10  # bad records or samples named one by one


@dataclass(frozen=True)
class Running:
    """Options of the runs: processors or cluster, and the store."""

    jobs: int | None
    scheduler: str | None
    store: str | None
    restart: bool

    def __post_init__(self) -> None:
        if self.scheduler is not None and self.jobs is not None and not from_default("jobs"):
            raise click.UsageError(
                "--jobs applies to this machine only: on a cluster, the number of workers is set there."
            )

    def workers(self) -> AbstractContextManager[Workers]:
        """Return the workers that simulate the runs: a cluster, or threads of this machine."""
        from rocking_cli.studies.fragility import workers

        return workers.cluster(self.scheduler) if self.scheduler is not None else workers.threads(self.jobs)


@click.command(cls=Command, short_help="Run a fragility study and fit its curves.")
@click.argument("file", metavar="STUDY.yaml", type=click.Path())
@click.option("--check", is_flag=True, help="Show what would be run, without running it.")
@click.option("--jobs", type=click.IntRange(min=1), metavar="N", help=options.HELP["jobs"])
@click.option("--scheduler", metavar="tcp://HOST:PORT", help="Address of a dask.distributed scheduler, to run there.")
@click.option(
    "--store", metavar="FILE.db", help="File in which the runs are stored.  [default: next to the study file]"
)
@click.option("--restart", is_flag=True, help="Start from scratch; the existing store is kept under another name.")
@options.rank_measures
@options.curve_plots
@options.nrml
@options.quantiles
@options.as_json
@click.pass_context
@options.grouped(running=Running, shown=CurveOutput)
def command(
    ctx: click.Context,
    file: str,
    check: bool,
    running: Running,
    shown: CurveOutput,
    as_json: bool,
) -> None:
    """Run a fragility study and fit its curves.

    STUDY.yaml names structures, records, intensity levels and limit states; docs/fragility.md lists its fields. Every
    finished run is kept in a store, an SQLite file next to the study file. You may stop the command at any time: the
    same command continues with the missing runs, and the final store is the same. `rocking results` shows and exports
    it; `rocking measures` lists the intensity measures of --rank-measures.

    A record that cannot be used is reported and skipped, and the exit code is 5.

    \b
    Example:
      rocking fragility study.yaml --check
      rocking fragility study.yaml --plot pictures --rank-measures
      rocking fragility study.yaml --scheduler tcp://10.0.0.1:8786
      rocking results study.db --out runs.csv
    """
    from rocking_cli.cli import structures
    from rocking_cli.io.files import check_writable, folder, keep_apart
    from rocking_cli.studies.fragility.reached import held
    from rocking_cli.studies.fragility.store import Store
    from rocking_cli.studies.fragility.study import load_study

    try:
        study = load_study(file)
        # What varies may be far from the file: the first sample stands for all.
        first = {sample.structure: sample.mechanism for sample in study.samples if sample.number == 0}
        for each in first.values():
            structures.warn(each)
        for sentence in held(study):
            terminal.warning(sentence)
        place = Path(running.store) if running.store is not None else Path(file).with_suffix(".db")
        keep_apart(
            [("--store" if running.store is not None else "the store beside the study", place), ("--nrml", shown.nrml)],
            [file],
        )
        if check:
            complete = _check(study, as_json=as_json)
        else:
            check_writable(place)
            if shown.plot is not None:
                folder(shown.plot)
            _bring_up_to_date(study, place, running, rank_measures=shown.rank_measures)
            with Store.reading(place) as kept:
                complete = show_study(kept, shown, as_json=as_json)
    except KeyboardInterrupt as stopped:
        terminal.error("interrupted: finished runs are kept; run the same command again to continue")
        ctx.exit(endings.exit_code(stopped))
    if not complete:
        ctx.exit(INCOMPLETE)


def _check(study: Study, *, as_json: bool) -> bool:
    """Show what a study would run, and return whether all of its records and structures can be used."""
    from rocking_cli.studies.fragility.campaign import survey
    from rocking_cli.views.fragility import left_out, planned

    with terminal.progress(len(study.sources) + len(study.samples), "records and structures") as examined:
        plan, _ = survey(study, examined)
    _report_left_out(plan)
    terminal.show(planned(study, plan), as_json=as_json)
    return not left_out(plan)


def _bring_up_to_date(study: Study, place: Path, running: Running, *, rank_measures: bool) -> None:
    """Simulate the runs that the store lacks; on a restart simulate all, and keep the old store."""
    from rocking_cli.cli import waiting
    from rocking_cli.studies.fragility.campaign import prepare, run, steps
    from rocking_cli.studies.fragility.store import Store

    with ExitStack() as stack:
        # The old store gives way only when there is somebody to run the study anew.
        workers = stack.enter_context(running.workers()) if running.restart else None
        say = terminal.note if running.restart else terminal.warning
        store = stack.enter_context(Store.writing(place, anew=running.restart, say=say))
        with terminal.progress(steps(study, rank_measures=rank_measures), "records and structures") as examined:
            prepared = prepare(study, store, examined, rank_measures=rank_measures)
        _report(prepared)
        if prepared.finished == prepared.plan.total:
            return
        if running.scheduler is None:
            waiting.compile_first()
        workers = workers or stack.enter_context(running.workers())
        done, failed = prepared.finished, prepared.failed
        with terminal.progress(prepared.plan.total, "runs", done=done, failed=failed) as advance:
            run(prepared, store, workers, advance)


def _report(prepared: Prepared) -> None:
    """Report unusable and doubtful inputs, and how many runs are finished."""
    plan = prepared.plan
    _report_left_out(plan)
    doubtful = [each.name for each in plan.records if each.doubts]
    if doubtful:
        named = ", ".join(doubtful[:3]) + (" ..." if len(doubtful) > 3 else "")
        count = "1 record is" if len(doubtful) == 1 else f"{len(doubtful)} records are"
        terminal.warning(f"{count} doubtful; run `rocking record FILE` to see why: {named}")
    for name in prepared.mended:
        terminal.note(f"{name}: could not be used when the study was started; it is run now")
    if prepared.finished:
        terminal.note(f"{prepared.finished} of {plan.total} runs are in the store already")


def _report_left_out(plan: Plan) -> None:
    """Report the records and the samples that cannot be run."""
    from rocking_cli.views.fragility import left_out

    bad = left_out(plan)
    for each in bad[:NAMED]:
        terminal.error(each)
    if len(bad) > NAMED:
        terminal.error(f"and {len(bad) - NAMED} more: `rocking results STORE --json` names all")
