"""Ground motions of the checks."""

from __future__ import annotations

import numpy as np

from rocking_cli.excitation.base import GroundMotion

MOTIONS = tuple(
    GroundMotion(f"motion {k}", dt, np.array(samples, dtype=np.float64))
    for k, (dt, samples) in enumerate(
        (
            (0.1, (0, 2, 4, 3, -1, -4, -3, 0)),
            (0.2, (0, 3, 5, 0, -5, -4, 0, 2, 0)),  # overturns
            (0.15, (0, -4, 0, 4, -1, -4, 3, 0)),
            (0.07, (0, 4, -4, 1, 5, 2, -4, -5, -1, 3, 2, 0)),
        )
    )
)
"""Ground motions of a few samples [m/s2], straight in between, so that the solver meets few corners."""
