"""What `rocking equiv` and `rk.equiv` are asked."""

from __future__ import annotations

from pathlib import Path

from rocking_cli.ask.groups import OfStructures, WithTable, table_file


class EquivAsked(OfStructures, WithTable):
    """Compute the parameters of the equivalent single rocking block of each structure.

    The table has one column if both directions agree and two if they differ; positive is clockwise. As JSON, each
    file gives one object on a line of its own. A file that cannot be used is reported and skipped, and the exit code
    is 5.

    Without FILE, the command uses rocking.yaml of this folder, or else a block of 0.7 m x 2.8 m.

    \b
    Example:
      rocking equiv frame.yaml
      rocking equiv wall.yaml arch.yaml --out parameters.csv

    Source: DeJong and Dimitrakopoulos (2014), Eqs. 9-20.
    """

    out: Path | None = table_file("Write the parameters, a row for each direction of each structure")
