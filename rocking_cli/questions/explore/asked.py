"""What `rocking explore` and `rk.explore` are asked."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rocking_cli.ask.asked import option
from rocking_cli.ask.groups import (
    Around,
    OfJoints,
    OfRecords,
    OfStructures,
    OnePolarity,
    Reading,
    UnderMotions,
    polarity,
)
from rocking_cli.ask.kinds import WHOLE, output
from rocking_cli.excitation.records.opening import STANDARD_INPUT
from rocking_cli.names import MAX_NEIGHBOURS
from rocking_cli.processing.reading_options import READING
from rocking_cli.questions.design.asked import SPAN, VARY

if TYPE_CHECKING:
    from rocking_cli.processing.reading import Scaled


def options_of(asked: OfRecords, given: Scaled) -> str:
    """Return the options by which a command reads a ground motion; empty if it was given in memory."""
    if given.pulse is not None:
        return f"--pulse {given.pulse.specification}"
    if given.file is None or str(given.file) == STANDARD_INPUT:
        return ""
    words = ["--record", str(given.file)]
    for name, value in asked.part(Reading).items():
        words += [f"--{(READING[name].key or name).replace('_', '-')}"] + ([] if value is True else [str(value)])
    return shlex.join(words)


class ExploreAsked(OfStructures, UnderMotions, OfJoints, Around):
    """Write a page on which a structure and its ground motion can be changed, and which answers at once.

    The page is a single file without network or server. Its reader changes the strength, the polarity and the time
    scale of the motion or puts a pulse in its place, and changes the restitution, the size and the slenderness of the
    structure. The page computes the history, the share of its neighbours that overturn, the margin, and a map of pulses
    by the kernels of this program: the numbers are those of `rocking respond` with the engine `exact`, of which it
    shows the command. It begins with the scale and the polarity that are given here.

    With --vary, the page has tables of 21 values of a field, the given one among them, and is some megabytes large.

    Several FILEs are shown side by side under one motion, at most six. A FILE that the page cannot follow is reported
    and skipped, and the exit code is 5.

    Without FILE, the command uses rocking.yaml of this folder, or else a block of 0.7 m x 2.8 m.

    \b
    Example:
      rocking explore frame.yaml --record accel.csv
      rocking explore statue.yaml cabinet.yaml --record accel.csv -o room.html
      rocking explore wall.yaml --record accel.csv --vary width=0.3m:0.6m
      rocking explore --pulse ricker:0.4g:1.2s -o block.html
    """

    vary: Any = option(VARY, SPAN)
    out: Path = option("The page.", output(".html"), default=Path("explore.html"))
    polarity: OnePolarity = polarity(allowed="1 -1")
    neighbours: int = option(
        "Number of neighbouring motions that the page simulates.",
        WHOLE,
        default=200,
        ge=1,
        le=min(1000, MAX_NEIGHBOURS),
    )
