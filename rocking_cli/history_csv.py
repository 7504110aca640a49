"""Histories as comma-separated text."""

from __future__ import annotations

from collections.abc import Mapping
from typing import BinaryIO

import numpy as np

from rocking_cli import history_columns
from rocking_cli.dynamics.history import History
from rocking_cli.excitation.base import GroundMotion

ROWS = 10_000  # written at a time


def write_history_csv(stream: BinaryIO, histories: Mapping[str, History], motion: GroundMotion | None) -> None:
    """Write the histories, a line a sample, under a header that carries the units.

    Parameters
    ----------
    stream : binary file
        Where to.
    histories : mapping of str to History
        At least one; all on the same samples.
    motion : GroundMotion, optional
        The ground motion they respond to.

    Notes
    -----
    Nine digits; fields are empty after overturning.
    """
    header = history_columns.names(histories, motion)
    stream.write((",".join(header) + "\n").encode())
    line = ",".join(["%.9g"] * len(header)) + "\n"
    for columns in history_columns.blocks(histories, motion, ROWS):
        values = np.column_stack(columns) + 0.0  # no -0
        text = line * len(values) % tuple(values.ravel().tolist())
        stream.write(text.replace("nan", "").encode())
