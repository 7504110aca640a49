"""A long table as Parquet, for those who have pyarrow."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import BinaryIO


def write_blocks_parquet(stream: BinaryIO, blocks: Iterable[Mapping[str, Sequence[object]]]) -> None:
    """Write a table block by block, a row group each.

    Parameters
    ----------
    stream : binary file
        Where to.
    blocks : iterable of mapping of str to sequence
        Each with the same columns: words, whole numbers, or other numbers, NaN and None as null.
    """
    import pyarrow
    from pyarrow import parquet

    writer = None
    for columns in blocks:
        arrays = [pyarrow.array(values, from_pandas=True) for values in columns.values()]
        batch = pyarrow.table(arrays, names=list(columns))
        if writer is None:
            writer = parquet.ParquetWriter(stream, batch.schema)
        writer.write_table(batch.cast(writer.schema))
    if writer is not None:
        writer.close()
