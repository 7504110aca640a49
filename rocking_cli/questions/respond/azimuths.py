"""The response of a structure to a pair of horizontal components, in every direction of the structure's plane."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from rocking_cli.arrays import Bools, Reals
from rocking_cli.dynamics.batch import Runs, respond_many
from rocking_cli.dynamics.model import ModelName
from rocking_cli.dynamics.outcome import Outcomes
from rocking_cli.errors import SolverError
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.names import RTOL
from rocking_cli.processing.reading import turned
from rocking_cli.short_repr import short_repr
from rocking_cli.structure import Structure

AZIMUTH_STEP = 2  # degrees between two directions


@short_repr
@dataclass(frozen=True, eq=False)
class AzimuthResponses:
    """Responses of a structure to a pair of horizontal components, in all directions.

    Parameters
    ----------
    names : (str, str)
        Names of the components at 0 and at 90 degrees.
    scale : float
        Scale factor on both components.
    azimuths : ndarray, shape (n,)
        Directions of the structure's plane, counted from the first component towards the second [deg]; as they go all
        around, both polarities are among them.
    pga_g : ndarray, shape (n,)
        Peak ground acceleration in each direction, after scaling [standard gravity].
    outcomes : mapping of str to Outcome
        The outcomes under each model, as arrays over the azimuths.
    checked : bool
        Whether the joints of the structure are known; if not, no outcome of the nonlinear model is said to be unknown.
    """

    names: tuple[str, str]
    scale: float
    azimuths: Reals
    pga_g: Reals
    outcomes: Mapping[ModelName, Outcomes]
    checked: bool = True


def all_around(
    structure: Structure,
    models: Sequence[ModelName],
    pair: tuple[GroundMotion, GroundMotion],
    scale: float,
    *,
    release: float | None = None,
    rtol: float = RTOL,
) -> AzimuthResponses:
    """Turn a pair of components into all directions, and simulate a structure in each.

    Parameters
    ----------
    structure : Structure
        The structure.
    models : sequence of str
        Names of the models to simulate.
    pair : (GroundMotion, GroundMotion)
        The components at 0 and at 90 degrees, corrected alike.
    scale : float
        Scale factor on both components.
    release : float, optional
        Start at rest from this fraction of phi_cr.
    rtol : float
        Relative local error of a step.

    Raises
    ------
    InputError
        If the components differ in length or interval.
    SolverError
        If a motion cannot be followed.
    """
    azimuths = np.arange(0.0, 360.0, AZIMUTH_STEP)
    motions = [turned(*pair, azimuth).scaled(scale) for azimuth in azimuths.tolist()]
    followed = structure.models(models)
    responses = respond_many(
        followed, motions, Runs.every(len(followed), len(motions)), release=release, rtol=rtol, only_peaks=True
    )
    if responses.failed.any():
        k = int(responses.failed.argmax()) % azimuths.size
        raise SolverError(f"the motion at an azimuth of {azimuths[k]:g} degrees could not be simulated")
    parts = [slice(k * azimuths.size, (k + 1) * azimuths.size) for k in range(len(followed))]
    outcomes = {
        model.name: responses.by_field(lambda values, part=part: values[part])
        for model, part in zip(followed, parts, strict=True)
    }
    pga = np.array([motion.pga_g for motion in motions])
    checked = all(model.is_linear or model.joints is not None for model in followed)
    return AzimuthResponses((pair[0].name, pair[1].name), scale, azimuths, pga, outcomes, checked)


def sectors(azimuths: Reals, flags: Bools) -> list[tuple[float, float]]:
    """Return the first and the last azimuth [deg] of each run of consecutive flagged azimuths on the circle."""
    if flags.all():
        return [(float(azimuths[0]), float(azimuths[-1]))]
    begins = np.flatnonzero(flags & ~np.roll(flags, 1))
    ends = np.flatnonzero(flags & ~np.roll(flags, -1))
    if begins.size and ends[0] < begins[0]:
        ends = np.roll(ends, -1)
    return [(float(azimuths[a]), float(azimuths[b])) for a, b in zip(begins, ends, strict=True)]
