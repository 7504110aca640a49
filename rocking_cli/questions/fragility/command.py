"""`rocking fragility`: run a study of many structures, records and intensities, and fit its curves."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from rocking_cli.cli import endings, options, terminal
from rocking_cli.cli.defaults import from_default
from rocking_cli.cli.help import Command
from rocking_cli.cli.watching import OnTerminal
from rocking_cli.questions.fragility.study_output import StudyOutput, show_study


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
@options.grouped(shown=StudyOutput)
def command(ctx: click.Context, file: str, shown: StudyOutput, **study: Any) -> None:
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
    from rocking_cli.ask.numbers import refuse_idle
    from rocking_cli.io.files import check_writable, folder, keep_apart
    from rocking_cli.questions.fragility.results import StudyAnswer
    from rocking_cli.questions.fragility.verb import fragility

    watch = OnTerminal()
    place = Path(file).resolve().with_suffix(".db") if study["store"] is None else Path(study["store"])
    named = "the store beside the study" if study["store"] is None else "--store"
    keep_apart([(named, place), ("--nrml", shown.nrml)], [file])
    if from_default("jobs") and (study["check"] or study["scheduler"] is not None):
        study["jobs"] = None
    if study["check"]:
        refuse_idle("with `check`, which runs nothing", plot=shown.plot, nrml=shown.nrml)
    else:
        check_writable(place)
        if shown.plot is not None:
            folder(shown.plot)
    try:
        answer = fragility(file, watch=watch, **study)
    except KeyboardInterrupt as stopped:
        terminal.error("interrupted: finished runs are kept; run the same command again to continue")
        ctx.exit(endings.exit_code(stopped))
    if isinstance(answer, StudyAnswer):
        show_study(answer, shown, watch)
    else:
        terminal.show(answer.view, as_json=shown.as_json)
    watch.end()
