"""`rocking results`: summarise and export the store of a study."""

from __future__ import annotations

import click

from rocking_cli.cli import complete, options
from rocking_cli.cli.help import Command
from rocking_cli.cli.watching import OnTerminal
from rocking_cli.questions.fragility.study_output import StudyOutput, show_study


@click.command(cls=Command, short_help="Summarise and export the store of a study.")
@click.argument("file", metavar="STORE.db", type=click.Path())
@options.out(".csv", ".parquet", what="Write all runs (.csv or .parquet).")
@click.option(
    "--curves",
    callback=options.output_path(".csv", ".parquet"),
    metavar="FILE.csv",
    shell_complete=complete.files,
    help="Write the curves, one line per intensity (.csv or .parquet).  - is standard output.",
)
@options.nrml
@options.quantiles
@options.curve_plots
@options.rank_measures
@options.as_json
@options.grouped(shown=StudyOutput)
def command(file: str, shown: StudyOutput, quantiles: bool, rank_measures: bool) -> None:
    """Summarise and export the fragility curves and runs of a study, from its store.

    The command needs no other file of the study, and can read the store while the study runs.

    \b
    Example:
      rocking results study.db
      rocking results study.db --out runs.parquet --plot pictures
      rocking results study.db --curves curves.csv --nrml fragility.xml
      rocking results study.db --rank-measures
    """
    from rocking_cli.io.files import folder, keep_apart
    from rocking_cli.io.tables import check_table
    from rocking_cli.questions.fragility.results import results

    keep_apart([("--out", shown.out), ("--curves", shown.curves), ("--nrml", shown.nrml)], [file])
    check_table(shown.out)
    check_table(shown.curves)
    if shown.plot is not None:
        folder(shown.plot)
    watch = OnTerminal()
    show_study(results(file, quantiles=quantiles, rank_measures=rank_measures, watch=watch), shown, watch)
    watch.end()
