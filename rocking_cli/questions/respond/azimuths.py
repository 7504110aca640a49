"""The response of a structure to a pair of horizontal components, in every direction of the structure's plane."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rocking_cli import names
from rocking_cli.arrays import Bools, Reals
from rocking_cli.dynamics.batch import Runs, respond_many
from rocking_cli.dynamics.model import ModelName
from rocking_cli.dynamics.outcome import Outcomes
from rocking_cli.errors import SolverError
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.io.tables import Columns, stacked
from rocking_cli.names import RTOL, percent
from rocking_cli.processing.reading import turned
from rocking_cli.short_repr import short_repr
from rocking_cli.structure import Structure
from rocking_cli.views.column import Column, of, only_shown, table_of
from rocking_cli.views.restitution import heading_of_run, restitution_data, restitution_used
from rocking_cli.views.verdict import unchecked
from rocking_cli.views.view import Table, View

AZIMUTH_STEP = 2  # degrees between two directions
Flags = NDArray[np.bool_]


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


class _Model(NamedTuple):
    """The outcomes under one model."""

    name: str
    azimuths: NDArray[np.float64]
    each: Outcomes

    @property
    def highest(self) -> tuple[float, float] | None:
        """Largest peak of the directions that neither overturn nor are unknown, and its direction [deg]."""
        standing = np.where(self.each.fell | self.each.unknown, -1.0, self.each.peak_ratio)
        k = int(standing.argmax())
        return (float(standing[k]), float(self.azimuths[k])) if standing[k] > 0 else None


UNKNOWN_HEADING = "are\nunknown"
MODELS: tuple[Column[_Model], ...] = (
    only_shown("model", of("name"), text=True),
    only_shown("directions\noverturn", lambda row: percent(float(row.each.fell.mean()))),
    only_shown(UNKNOWN_HEADING, lambda row: percent(float(row.each.unknown.mean()))),
    only_shown("do not\nuplift", lambda row: percent(float((~row.each.lifted).mean()))),
    only_shown("largest peak\nof the others", lambda row: row.highest and row.highest[0]),
    only_shown("at\n[deg]", lambda row: row.highest and row.highest[1]),
)


def view(structure: Structure, found: AzimuthResponses, doubts: Iterable[str] = ()) -> View:
    """Show the responses of a structure to a pair of components in all directions."""
    one, other = found.names
    unknown = any(each.unknown.any() for each in found.outcomes.values())
    models = [column for column in MODELS if unknown or column.head != UNKNOWN_HEADING]
    rows = [_Model(name, found.azimuths, each) for name, each in found.outcomes.items()]
    sentence = (
        f"0 degrees is {one}, 90 degrees {other}; {found.azimuths.size} directions of the structure's plane, one every "
        f"{found.azimuths[1] - found.azimuths[0]:g} degrees. PGA {found.pga_g.min():.3g} to {found.pga_g.max():.3g} g, "
        f"the largest at {found.azimuths[found.pga_g.argmax()]:g} degrees."
    )
    parts: list[Table | str] = [heading_of_run(structure), sentence, table_of("", models, rows)]
    parts += [f"{name}: {in_words(found, each)}" for name, each in found.outcomes.items()]
    parts += [restitution_used(structure)] if structure.restitution is not None else []
    parts += [] if found.checked else [unchecked(why=structure.mechanism.unchecked)]
    return View(_data(structure, found), [*parts, *doubts])


def in_words(found: AzimuthResponses, outcomes: Outcomes) -> str:
    """Return in a sentence or two the directions in which the structure overturns or has an unknown outcome."""
    falls, unknown = outcomes.fell, outcomes.unknown
    if not unknown.any():
        return f"it overturns in {_where(found, falls)}."
    doubt = f"its outcome is {names.UNKNOWN} in {_where(found, unknown)}, as joints open or slide there"
    return f"it overturns in {_where(found, falls)}; {doubt}." if falls.any() else f"{doubt}."


def _where(found: AzimuthResponses, flags: Flags) -> str:
    """Return in words how many directions are flagged, and which."""
    if not flags.any():
        return "no direction"
    if flags.all():
        return "every direction"
    ranges = [f"{a:g}" if a == b else f"{a:g} to {b:g}" for a, b in sectors(found.azimuths, flags)]
    return f"{int(flags.sum())} of {flags.size} directions, at {', '.join(ranges)} degrees"


def columns(found: AzimuthResponses) -> Columns:
    """Return a table with a row for each model and direction; of an unknown outcome, the peak is that so far."""
    return stacked(
        {
            "model": name, "azimuth [deg]": found.azimuths, "pga_g [g]": found.pga_g,
            "peak_ratio": np.where(each.fell, np.inf, each.peak_ratio), "overturned": each.overturned,
            "unknown": each.unknown, "known_to [s]": each.known_to,
        }
        for name, each in found.outcomes.items()
    )  # fmt: skip


def _data(structure: Structure, found: AzimuthResponses) -> dict[str, Any]:
    mechanism = structure.mechanism
    return {
        "structure": {"mechanism": mechanism.mechanism, "name": mechanism.name},
        "components": list(found.names),
        "scale": found.scale,
        "restitution": restitution_data(structure),
        "azimuths": found.azimuths.tolist(),
        "pga_g": found.pga_g.tolist(),
        "responses": {
            name: {
                "peak_ratio": [None if np.isnan(peak) else peak for peak in each.peak_ratio.tolist()],
                "overturned": [
                    None if unknown else fell
                    for unknown, fell in zip(each.unknown.tolist(), each.fell.tolist(), strict=True)
                ],
                "unknown": each.unknown.tolist() if found.checked or name != "nonlinear" else None,
                "known_to": each.known_to.tolist(),
                "peak_lower_bound": np.where(each.unknown, each.lower_bound, np.nan).tolist(),
                "uplifts": each.lifted.tolist(),
                "sectors_that_overturn": [list(pair) for pair in sectors(found.azimuths, each.fell)],
                "sectors_unknown": [list(pair) for pair in sectors(found.azimuths, each.unknown)],
                "said": in_words(found, each),
            }
            for name, each in found.outcomes.items()
        },
    }
