"""`rk.record`."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rocking_cli.ask.answer import Answer
from rocking_cli.ask.given import Motion, motion_of
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.excitation.measures import Measures
from rocking_cli.views.view import View

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rocking_cli.io.tables import Columns


def record(motion: Motion, *, scale: float = 1.0) -> Answer[Measures]:
    """Measure the strength of a ground motion, and check it for defects.

    Parameters
    ----------
    motion : GroundMotion, Pulse, str or Path
        The motion, its file, or a pulse as text.
    scale : float
        Scale factor on the motion.

    Returns
    -------
    Answer of Measures
        Peaks, Arias intensity, durations and mean period.

    Raises
    ------
    InputError
        If a value is out of range, or a file cannot be used.

    Notes
    -----
    The measures are exact for straight lines between the samples; the intensity is that of Arias (1970), pi/(2 g) times
    the integral of the squared acceleration.
    """
    from rocking_cli.excitation.doubts import doubts
    from rocking_cli.excitation.measures import measure
    from rocking_cli.views.record import Examined, data, parts

    read = motion_of(motion)
    scaled = read.scaled(scale)
    found = measure(scaled)
    seen = Examined(read.name, read.name, read, scale, found, doubts(read, measure(read)), None, [])

    def columns() -> Columns:
        time = np.arange(scaled.npts) * scaled.dt
        return {"t [s]": time, "a_g [g]": scaled.acceleration / STANDARD_GRAVITY}

    def figure() -> Figure:
        from rocking_cli.plotting.record import draw_record

        return draw_record(scaled, found)

    said = f"{read.name}: PGA {found.pga:.3g} g, PGV {found.pgv:.3g} m/s."
    return Answer("record", found, View(lambda: data(seen), [*parts([seen], 100), said]), columns, figure)
