"""Every structure under every motion with every factor, polarity and restitution: outcomes, and rotations in time."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from math import isclose, isnan, nan, prod
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rocking_cli import names
from rocking_cli.arrays import Reals
from rocking_cli.core import Direction, Mechanism
from rocking_cli.dynamics.batch import Runs, respond_many
from rocking_cli.dynamics.history import follow
from rocking_cli.dynamics.model import Model, ModelName
from rocking_cli.dynamics.outcome import Outcomes
from rocking_cli.dynamics.parallel import in_parts
from rocking_cli.errors import InputError, Problem, SolverError, named
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.excitation.measures import Measures, measure
from rocking_cli.io.tables import Columns, stacked
from rocking_cli.short_repr import short_repr
from rocking_cli.structure import Structure
from rocking_cli.studies.movements import centroid_moved, largest_on_the_way

FAILED = "failed"
OUTCOMES = (names.NO_UPLIFT, names.SLIDES, names.ROCKS, names.STILL_ROCKING, names.OVERTURNS, names.UNKNOWN, FAILED)
"""Categories of the column `outcome`."""
HISTORIES_PER_TASK = 16
MOST_VALUES = 200_000_000  # rotations in all histories: 1.6 GB
MAX_ETA_DIFFERENCE = 1e-9  # relative difference up to which the restitution of both directions is one


@short_repr
@dataclass(frozen=True, eq=False)
class RunGrid:
    """What is combined with what: the axes of the runs, in the order of the fields; a field that is None has no axis.

    Parameters
    ----------
    structures : sequence of Structure
        The structures.
    motions : sequence of GroundMotion
        The ground motions, before scaling.
    scales : ndarray
        Factors on the motions; negative ones reverse them. With `of_pga`, the PGA of each motion after scaling [g].
    polarities : ndarray of int, optional
        1 as given, -1 reversed.
    restitutions : ndarray, optional
        Ratios of the rotation rates after and before an impact; NaN for that of the structure.
    of_pga : bool
        Whether motions are scaled to peaks, not by factors.
    """

    structures: Sequence[Structure]
    motions: Sequence[GroundMotion]
    scales: Reals
    polarities: NDArray[np.int64] | None = None
    restitutions: Reals | None = None
    of_pga: bool = False

    @cached_property
    def axes(self) -> dict[str, NDArray[Any]]:
        """The values along each axis, by its name."""
        axes: dict[str, NDArray[Any] | None] = {
            "structure": np.array([each.name for each in self.structures], dtype=object),
            "motion": np.array([each.name for each in self.motions], dtype=object),
            "target_pga" if self.of_pga else "scale": self.scales,
            "polarity": self.polarities,
            "restitution": self.restitutions,
        }
        return {name: values for name, values in axes.items() if values is not None}

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of values along each axis."""
        return tuple(values.size for values in self.axes.values())

    @property
    def count(self) -> int:
        """Number of runs of each model."""
        return prod(self.shape)

    @cached_property
    def runs(self) -> Runs:
        """The runs of one model, in the order of the axes, the last one changing fastest."""
        runs = Runs.every(
            len(self.structures),
            len(self.motions),
            scales=self.scales.tolist(),
            polarities=(1,) if self.polarities is None else self.polarities.tolist(),
            etas=(nan,) if self.restitutions is None else self.restitutions.tolist(),
        )
        if not self.of_pga:
            return runs
        return replace(runs, scale=runs.scale / np.array([each.pga_g for each in self.measured])[runs.record])

    @cached_property
    def measured(self) -> list[Measures]:
        """Measures of the ground motions, before scaling."""
        return [measure(each.of_ground) for each in self.motions]

    @cached_property
    def places(self) -> dict[str, NDArray[np.int64]]:
        """The place of each run of one model along each axis, by the name of the axis, shape (n,)."""
        return dict(zip(self.axes, np.indices(self.shape).reshape(len(self.shape), -1), strict=True))

    @property
    def pga_g(self) -> Reals:
        """Peak ground acceleration of each run of one model [g], shape (n,)."""
        return self._scaled([each.pga_g for each in self.measured])

    @property
    def pgv(self) -> Reals:
        """Peak ground velocity of each run of one model [m/s], shape (n,)."""
        return self._scaled([each.pgv for each in self.measured])

    def _scaled(self, peaks: Sequence[float]) -> Reals:
        scaled: Reals = np.abs(self.runs.scale) * np.array(peaks)[self.runs.record]
        return scaled

    @cached_property
    def _other(self) -> dict[tuple[int, int], Structure]:
        """The structures with each restitution, by their places; raises `InputError` if one would add energy."""
        etas = enumerate(() if self.restitutions is None else self.restitutions.tolist())
        given = [(j, eta) for j, eta in etas if not isnan(eta)]
        return {(k, j): each.under(restitution=eta) for k, each in enumerate(self.structures) for j, eta in given}

    def prepared(self, name: ModelName) -> tuple[list[Model], Runs]:
        """Return the models of all structures and their runs.

        A structure on three or more columns has a model of its own for each restitution, which is that of its columns
        too. Raises as `respond_many`.
        """
        models = [each.model(name) for each in self.structures]
        of_run, eta = self.runs.model.copy(), self.runs.eta.copy()
        for (k, j), structure in self._other.items():
            if models[k].columns:
                mine = (self.places["structure"] == k) & (self.places["restitution"] == j)
                of_run[mine], eta[mine] = len(models), nan
                models.append(structure.model(name))
        return models, replace(self.runs, model=of_run, eta=eta)

    def outcomes(self, model: ModelName, threads: int | None, progress: Callable[[int], None]) -> Outcomes:
        """Return the outcomes of all runs of a model, as arrays of the shape of the grid. Raises as `respond_many`."""
        models, runs = self.prepared(model)
        many = respond_many(models, self.motions, runs, threads=threads, progress=progress)
        return many.by_field(lambda values: values.reshape(self.shape))

    @cached_property
    def time(self) -> Reals:
        """Times of the rotations [s]: at the smallest interval of the motions, to ten seconds after the longest."""
        dt = min(each.every * each.dt for each in self.motions)
        return np.arange(0.0, max(each.duration for each in self.motions) + names.TAIL_SECONDS, dt)

    def check_memory(self) -> None:
        """Raise `InputError` if all rotations would not fit in memory."""
        if self.count * self.time.size > MOST_VALUES:
            what = f"{self.count:,} histories of {self.time.size:,} samples are more than {MOST_VALUES:,} values"
            hint = f"run fewer at a time, or leave out {named('histories')}: outcomes and peaks do not need them"
            raise InputError(Problem(what, field=named("histories"), hint=hint))

    def rotations(self, model: ModelName, threads: int | None, progress: Callable[[int], None]) -> Reals:
        """Return the signed rotations of all runs of a model at `time` [rad], of the shape of the grid and the times.

        They are linear between the samples of each motion, zero after a structure has come to rest, and NaN after it
        overturns, after its motion becomes unknown, and where it could not be simulated.
        """
        models, runs = self.prepared(model)
        rotations = np.full((self.count, self.time.size), np.nan)

        def work(first: int, stop: int) -> None:
            for k in range(first, stop):
                motion = self.motions[runs.record[k]].scaled(float(runs.scale[k] * runs.polarity[k]))
                try:
                    run = follow(models[runs.model[k]], motion, eta=float(runs.eta[k]))
                except SolverError:
                    continue
                rotations[k] = np.interp(self.time, run.time, run.phi, right=0.0 if run.at_rest else nan)

        in_parts(work, self.count, HISTORIES_PER_TASK, threads, progress)
        return rotations.reshape(*self.shape, -1)


def columns(grid: RunGrid, outcomes: Mapping[ModelName, Outcomes]) -> Columns:
    """Return a row for each run of each model: what was combined, how strong the motion was, and what came of it."""
    place = grid.places
    table: dict[str, Any] = {name: grid.axes[name][place[name]] for name in ("structure", "motion")}
    table["scale"] = grid.runs.scale
    table["polarity"] = grid.runs.polarity
    of_structure = np.array([_common(each.etas) for each in grid.structures])[place["structure"]]
    table["restitution"] = np.where(np.isnan(grid.runs.eta), of_structure, grid.runs.eta)
    table["pga_g [g]"], table["pgv [m/s]"] = grid.pga_g, grid.pgv
    first = {"structure": table.pop("structure")}
    return stacked(
        first | {"model": model} | table | _outcome_columns(grid, outcome) for model, outcome in outcomes.items()
    )


def labelled_columns(grid: RunGrid, outcomes: Mapping[ModelName, Outcomes]) -> Columns:
    """Return the rows with the values along each axis: a target of the PGA, and a restitution as given, among them."""
    along = {name: np.tile(values[grid.places[name]], len(outcomes)) for name, values in grid.axes.items()}
    return {**columns(grid, outcomes), **along}


def _outcome_columns(grid: RunGrid, outcome: Outcomes) -> dict[str, Any]:
    peaks = {
        "peak_ratio": outcome.peak_ratio,
        "peak_rotation [rad]": np.maximum(outcome.peak_positive, outcome.peak_negative),
        "peak_rate [rad/s]": outcome.peak_rate,
        "peak_displacement [m]": np.maximum(np.stack(list(_displacements(grid, outcome))), outcome.slip),
    }
    values: dict[str, Any] = {
        "outcome": _words(outcome),
        "overturned": outcome.overturned,
        "unknown": outcome.unknown,
        # Infinite, so that no comparison or quantile of peaks takes what overturns for safe.
        **{
            name: np.where(outcome.fell, np.inf, np.where(outcome.failed, np.nan, each)) for name, each in peaks.items()
        },
        "impact_count": outcome.impact_count,
        "uplift_time [s]": outcome.uplift_time,
        "overturning_time [s]": outcome.overturning_time,
        "end_time [s]": outcome.end_time,
        "known_to [s]": outcome.known_to,
        "peak_lower_bound": outcome.lower_bound,
        "opening": outcome.opening,
        "slip [m]": outcome.slip,
    }
    return {name: np.ravel(each) for name, each in values.items()}


def _displacements(grid: RunGrid, outcome: Outcomes) -> Iterator[Reals]:
    """Yield the peak displacements of each structure [m]: of the centroid of all that moves, horizontal."""
    for k, structure in enumerate(grid.structures):
        mechanism = structure.mechanism
        by_side = [
            _moved(mechanism, direction, (outcome.peak_positive if direction > 0 else outcome.peak_negative)[k])
            for direction in mechanism.directions
        ]
        yield np.max(by_side, axis=0)


def _moved(mechanism: Mechanism, direction: Direction, peaks: Reals) -> Reals:
    inside = np.where(peaks < mechanism.limit(direction), peaks, np.inf)  # a linear model may pass the limit
    moved = largest_on_the_way(partial(centroid_moved, mechanism), inside.ravel(), direction)
    return np.where(np.isfinite(moved), moved, np.nan).reshape(peaks.shape)


def _words(outcome: Outcomes) -> NDArray[Any]:
    """Return the outcomes in words, in the order of precedence of `names.outcome`."""
    reasons = [outcome.failed, outcome.unknown, outcome.fell, outcome.still_rocking, outcome.lifted, outcome.slip > 0]
    words = [FAILED, names.UNKNOWN, names.OVERTURNS, names.STILL_ROCKING, names.ROCKS, names.SLIDES]
    return np.select(reasons, [np.array(word, dtype=object) for word in words], np.array(names.NO_UPLIFT, dtype=object))


def _common(etas: tuple[float, float]) -> float:
    """Return the restitution of both directions; NaN if they differ."""
    return etas[0] if isclose(*etas, rel_tol=MAX_ETA_DIFFERENCE) else nan
