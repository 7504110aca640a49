"""Histories as comma-separated text."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from rocking_cli.dynamics.history import History
from rocking_cli.dynamics.model import ModelName
from rocking_cli.excitation.base import STANDARD_GRAVITY, GroundMotion


def history_csv(histories: Mapping[ModelName, History], motion: GroundMotion | None) -> str:
    """The histories, a line a sample: time, ground acceleration, and for each model rotation, rate and ratio.

    Parameters
    ----------
    histories : mapping of str to History
        At least one; all on the same samples.
    motion : GroundMotion, optional
        The ground motion they respond to.

    Returns
    -------
    str
        With a header that carries the units; fields are empty after overturning.
    """
    longest = max(histories.values(), key=lambda run: run.time.size)
    size = longest.time.size
    ground = np.zeros(size)
    if motion is not None:
        ground[: motion.npts] = motion.acceleration / STANDARD_GRAVITY
    header, columns = ["t [s]", "a_g [g]"], [longest.time, ground]
    for name, run in histories.items():
        header += [f"{name} phi [rad]", f"{name} phi_dot [rad/s]", f"{name} phi/phi_cr"]
        # A motion that has come to rest before the longest one stays there.
        missing = np.full(size - run.time.size, np.nan if run.overturned else 0.0)
        columns += [np.concatenate([values, missing]) for values in (run.phi, run.rate, run.ratio)]
    lines = [",".join(header)]
    for row in zip(*columns, strict=True):
        lines.append(",".join("" if np.isnan(value) else f"{value:.9g}" for value in row))
    return "\n".join(lines) + "\n"
