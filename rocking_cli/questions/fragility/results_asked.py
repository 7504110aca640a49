"""What `rocking results` and `rk.results` are asked."""

from __future__ import annotations

from pathlib import Path

from rocking_cli.ask.asked import option
from rocking_cli.ask.groups import table_file
from rocking_cli.ask.kinds import FILE, FOLDER
from rocking_cli.questions.fragility.asked import OfCurves


class ResultsAsked(OfCurves):
    """Summarise and export the fragility curves and runs of a study, from its store.

    The command needs no other file of the study, and can read the store while the study runs.

    \b
    Example:
      rocking results study.runs
      rocking results study.runs --out runs.parquet --plot pictures
      rocking results study.runs --curves curves.csv --nrml fragility.xml --pelicun components
      rocking results study.runs --rank-measures
    """

    store: str | Path = option(
        "The store, which may be that of a study that is still running.",
        FILE, where="input", default=..., typed="STORE",
    )  # fmt: skip
    out: Path | None = table_file("Write all runs", ".parquet")
    curves: Path | None = table_file("Write the curves, one line per intensity", ".parquet")
    pelicun: Path | None = option("Write the lognormal curves for pelicun, as fragility.csv in this folder.", FOLDER)
