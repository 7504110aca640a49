"""Histories as Parquet, for those who have pyarrow."""

from __future__ import annotations

from collections.abc import Mapping
from importlib.util import find_spec
from typing import BinaryIO

from rocking_cli import history_columns
from rocking_cli.dynamics.history import History
from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.base import GroundMotion

ROWS = 1_000_000  # to a row group


def check_parquet(path: object) -> None:
    """Refuse, before any work, to write a Parquet file without pyarrow: `InputError` says how to get it."""
    if find_spec("pyarrow") is None:
        hint = "pip install 'rocking-cli[parquet]', or give a name that ends in .csv"
        raise InputError(Problem("Parquet needs the package pyarrow, which is not installed", str(path), hint=hint))


def write_history_parquet(stream: BinaryIO, histories: Mapping[str, History], motion: GroundMotion | None) -> None:
    """Write the histories; columns and arguments are those of `history_csv.write_history_csv`, at full precision.

    Notes
    -----
    Values are null after overturning.
    """
    import pyarrow
    from pyarrow import parquet

    schema = pyarrow.schema([(name, pyarrow.float64()) for name in history_columns.names(histories, motion)])
    with parquet.ParquetWriter(stream, schema) as writer:
        for columns in history_columns.blocks(histories, motion, ROWS):
            arrays = [pyarrow.array(values, from_pandas=True) for values in columns]  # NaN becomes null
            writer.write_batch(pyarrow.record_batch(arrays, schema=schema))
