"""`rk.read_record`: a record, as a ground motion."""

from __future__ import annotations

from rocking_cli.ask.groups import ReadRecordAsked
from rocking_cli.ask.verbs import verb
from rocking_cli.ask.watcher import Watcher
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.processing.reading import reading_of
from rocking_cli.processing.reading_options import PREPARING


@verb(ReadRecordAsked)
def read_record(asked: ReadRecordAsked, watch: Watcher) -> GroundMotion:
    """Read a recorded ground motion, and correct it; the format is found from the content, not from the file's name.

    Corrections are made in the order in which they are given.

    Returns
    -------
    GroundMotion
        Accelerations [m/s2] at a constant interval [s], named after the file. Its `processing` has the steps applied.

    Raises
    ------
    InputError
        If the file cannot be read or corrected, or anything in it is missing, contradictory or not a number.
    """
    return reading_of(asked.in_order_given(PREPARING)).check().read(asked.path)
