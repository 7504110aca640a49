"""`rk.respond_each`: every structure under every motion with every factor, in arrays, frames and labelled grids."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any, Unpack

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rocking_cli.arrays import Reals
from rocking_cli.ask.answer import MappingAnswer, parted
from rocking_cli.ask.given import StructureLike, models_of, structures_of
from rocking_cli.ask.ground_motions import MAX_PGA, Motion, Motions, each_of, type_in_words
from rocking_cli.ask.numbers import takes_numbers
from rocking_cli.ask.several import write_files
from rocking_cli.ask.watcher import SILENT, Watcher
from rocking_cli.dynamics.model import MODELS, ModelName
from rocking_cli.dynamics.outcome import OUTCOME_FIELDS, Outcomes
from rocking_cli.errors import InputError, Problem
from rocking_cli.names import OPENING
from rocking_cli.processing.reading_options import ReadingArguments
from rocking_cli.questions.respond.each import FAILED, OUTCOMES, RunGrid, columns
from rocking_cli.views.view import View

if TYPE_CHECKING:
    import pandas
    import xarray
    from matplotlib.figure import Figure

MEASURES = ("pga_g", "pgv")
"""Columns of a row that depend on motion and scale alone."""


@dataclass(frozen=True, eq=False, repr=False)
class EachAnswer(MappingAnswer[ModelName, Outcomes]):
    """Outcomes by model, as arrays over structures, motions, scales and the further axes that are given.

    `plot(x="pga_g", y="peak_ratio")` plots a column of the frame against another, for the first model.

    Parameters
    ----------
    grid : RunGrid
        What was combined; `grid.axes` has the values along each axis, by its name.
    rotation : mapping of str to ndarray
        Signed rotations in time [rad] by model, of the shape of the outcomes and the times; empty without `histories`.
    """

    grid: RunGrid = field(kw_only=True)
    rotation: Mapping[ModelName, Reals] = field(kw_only=True)

    def share(self) -> tuple[float, float]:
        """Return the lowest and the highest share of the runs of the first model that overturn, see `Outcome.share`."""
        return next(iter(self.values())).share()

    def exceeds(self, ratio: float) -> Reals:
        """Return for each row of the frame whether the peak rotation exceeds a share of the critical rotation.

        Returns
        -------
        ndarray, shape (n,)
            1, 0, or NaN where that is not known: a run of unknown outcome is known to exceed a ratio that it passed
            before any joint opened or slid. It is what `fit_fragility` takes.
        """
        rows: dict[str, Any] = dict(self.columns())
        exceeds = np.where(rows["peak_ratio"] > ratio, 1.0, 0.0)
        doubtful = np.where(rows["peak_ratio_at_least"] > ratio, 1.0, np.nan)
        exceeds = np.where(rows["unknown"], doubtful, exceeds)
        return np.where(rows["outcome"] == FAILED, np.nan, exceeds)

    @property
    def time(self) -> Reals:
        """Times of the rotations [s]."""
        return self.grid.time

    def to_frame(self) -> pandas.DataFrame:
        """Return a row for each structure, model, motion, scale, polarity and restitution.

        `frame.attrs["units"]` has the units. `outcome` is a category, `overturned` is 1, 0, or NaN where it is not
        known, which means of pandas leave out: see `share`. `pga_g` and `pgv` are those of the scaled ground motion;
        `peak_displacement` is that of the centroid of all that moves. Peaks are infinite if the structure overturns,
        and those until `known_to` if the outcome is unknown: `exceeds` counts both.

        Raises
        ------
        InputError
            If pandas is not installed.
        """
        from pandas import Categorical

        frame = super().to_frame()
        frame["outcome"] = Categorical(frame["outcome"], categories=list(OUTCOMES))
        return frame

    def to_xarray(self) -> xarray.Dataset:
        """Return the columns of the frame as labelled arrays, with `rotation` in time if there are `histories`.

        Returns
        -------
        xarray.Dataset
            The axes are model, structure, motion, scale (or `target_pga`), and polarity and restitution if given;
            `pga_g` and `pgv` are over the third and the fourth. Each variable has its units as an attribute.

        Raises
        ------
        InputError
            If xarray is not installed.
        """
        if find_spec("xarray") is None:
            hint = "pip install 'rocking-cli[xarray]'"
            raise InputError(Problem("labelled arrays require the package xarray", hint=hint))
        from xarray import Dataset, Variable

        values, units = parted(self.columns())
        axes: dict[str, NDArray[Any]] = {"model": np.array(list(self), dtype=object), **self.grid.axes}
        shape = [each.size for each in axes.values()]
        of_units = {name: {"units": unit} for name, unit in units.items()}
        labelled = {
            name: Variable(list(axes), np.reshape(each, shape), of_units.get(name, {}))
            for name, each in values.items()
            if name not in (*axes, *MEASURES)
        }
        for name in MEASURES:
            of_first = np.reshape(values[name], shape)[0, 0].reshape(*self.grid.shape[1:3], -1)
            labelled[name] = Variable(list(axes)[2:4], of_first[..., 0], of_units.get(name, {}))
        if self.rotation:
            stacked = np.stack([self.rotation[model] for model in self])
            labelled["rotation"] = Variable([*axes, "time"], stacked, {"units": "rad"})
            axes["time"] = self.time
        coordinates = {name: Variable([name], each) for name, each in axes.items()}
        return Dataset(labelled, coordinates)


@takes_numbers
def respond_each(
    structures: StructureLike | Sequence[StructureLike],
    motions: Motion | Sequence[Motion],
    *,
    models: str | Sequence[str] | None = None,
    scales: ArrayLike | None = None,
    target_pga: ArrayLike | None = None,
    polarities: Sequence[int] | None = None,
    restitutions: Sequence[float] | Reals | None = None,
    histories: bool = False,
    threads: int | None = None,
    opening: float = OPENING,
    out: str | Path | None = None,
    watch: Watcher = SILENT,
    **options: Unpack[ReadingArguments],
) -> EachAnswer:
    """Compute the outcome of every structure under every motion with every scale factor, polarity and restitution.

    Parameters
    ----------
    structures : Mechanism, str or Path, or a sequence of these
        The structures, or their YAML files.
    motions : GroundMotion, Pulse, str, Path or ndarray, or a sequence of these
        The motions, their files, patterns such as `"records/*.AT2"`, pulses as text; or samples in an array of shape
        (npts,), or (n, npts) for n motions, with `dt` [s] and `units`, both required.
    models : str or sequence of str, optional
        Models "nonlinear", "linear1" or "linear2"; by default all, or the nonlinear one alone if the others mislead.
    scales : array_like
        Scale factors on the motions, 1 by default; negative ones reverse them.
    target_pga : array_like, optional
        In place of `scales`: peak ground accelerations to which each motion is scaled [g], the third axis then.
    polarities : sequence of int, optional
        Polarities 1 and -1, as a further axis; by default, motions are as given.
    restitutions : array_like, optional
        Ratios of the rotation rates after and before an impact, as a further axis; NaN for that of the structure.
    histories : bool
        Whether to keep the rotations in time: `answer.rotation[model]` at `answer.time`.
    threads : int, optional
        Number of time histories at a time; by default, one for each processor.
    opening : float
        Largest opening of a joint up to which a history is valid, over D_cr.
    out : str or Path, optional
        File for the rows of `to_frame`, with units in the headings (.csv or .parquet).
    watch : Watcher
        Told what was read, what is doubtful about structures and motions, and how far the runs are.
    **options
        How files are read and corrected: see `rocking_cli.ask.ground_motions.ReadingArguments`.

    Returns
    -------
    EachAnswer
        Arrays by model, of shape (structures, motions, scales), and (..., polarities) and (..., restitutions) if these
        are given; `failed` marks motions that could not be simulated, and `unknown` those whose outcome is unknown
        from `known_to` on: their `overturned` is NaN, and `share()` gives the lowest and the highest share of the
        motions that overturn. `to_frame()` has a row for each run, `to_xarray()` labelled arrays.

    Raises
    ------
    InputError
        If a value is out of range, or a file cannot be used.
    MechanismError
        If the structure has no critical rotation or no uplift acceleration.

    Notes
    -----
    Every time history is identical, bit for bit, to that of `respond`: Eqs. 8 and 16 of DeJong and Dimitrakopoulos
    (2014).

    Examples
    --------
    >>> import rocking_cli as rk
    >>> blocks = [rk.Block(width=0.7, height=2.8), rk.Block(width=0.5, height=2.8)]
    >>> answer = rk.respond_each(blocks, "sine:0.4g:0.8s", models="nonlinear", scales=[0.5, 1.0])
    >>> answer["nonlinear"].overturned.tolist()
    [[[0.0, 1.0]], [[0.0, 1.0]]]
    >>> answer["nonlinear"].share()
    (0.5, 0.5)
    """
    from rocking_cli.io.tables import check_table

    if out is not None:
        check_table(Path(out))
    if scales is not None and target_pga is not None:
        raise InputError("`scales` and `target_pga` cannot be combined: give one of them")
    if not (given := each_of(structures)):
        raise InputError(Problem("is empty: give at least one structure", field="`structures`"))
    ready = structures_of(given, watch, opening)
    chosen = models_of(models)
    if models is None and any(len(each.default_models) < len(MODELS) for each in ready):
        chosen = ("nonlinear",)
    sources = Motions.of(motions, options)
    if sources.repeated:
        watch.warn(f"a motion that is given twice is used once: {sources.repeated} left out")
    shaking = sources.gather(max(each.growth for each in ready), watch)
    if target_pga is not None and (still := [one.motion.name for one in shaking if one.motion.of_ground.pga_g == 0]):
        raise InputError(Problem("is zero throughout and cannot be scaled to a peak", still[0]))
    grid = RunGrid(
        ready,
        [one.motion if one.factor == 1 else one.motion.scaled(one.factor) for one in shaking],
        _axis("scales", 1.0 if scales is None else scales) if target_pga is None else _axis("target_pga", target_pga),
        None if polarities is None else _signs(polarities),
        None if restitutions is None else _axis("restitutions", restitutions),
        target_pga is not None,
    )
    if (pga := float(grid.pga.max())) > MAX_PGA:
        what, scaled = (
            f"up to {pga:.4g} g is not plausible for a ground motion",
            "target_pga" if grid.of_pga else "scales",
        )
        raise InputError(Problem(what, field=f"`{scaled}`", hint=f"give at most {MAX_PGA:g} g: check the units"))
    if histories:
        grid.check_memory()
    with watch.progress(grid.count * len(chosen) * (1 + histories), "runs") as advance:
        outcomes = {name: grid.outcomes(name, threads, advance) for name in chosen}
        rotation = {name: grid.rotations(name, threads, advance) for name in chosen if histories}
    answer = EachAnswer(
        "responses",
        outcomes,
        View(partial(_data, outcomes), [_sentence(chosen[0], outcomes[chosen[0]]), _kept(grid) if histories else ""]),
        partial(columns, grid, outcomes),
        partial(_figure, grid, outcomes),
        grid=grid,
        rotation=rotation,
    )
    write_files(answer, out, None, watch)
    return answer


def _figure(
    grid: RunGrid, outcomes: Mapping[ModelName, Outcomes], *, x: str = "pga_g", y: str = "peak_ratio"
) -> Figure:
    from rocking_cli.questions.respond.each_picture import draw_each

    return draw_each(grid, outcomes, x, y)


def _axis(name: str, given: ArrayLike) -> Reals:
    try:
        values = np.atleast_1d(np.asarray(given, dtype=np.float64))
    except (TypeError, ValueError):
        raise InputError(Problem(f"must be numbers, got {type_in_words(given)}", field=f"`{name}`")) from None
    if values.ndim > 1 or not values.size:
        what = f"must be one number or a list of them, got an array of shape {values.shape}"
        raise InputError(Problem(what, field=f"`{name}`"))
    return values


def _signs(given: ArrayLike) -> NDArray[np.int64]:
    signs = _axis("polarities", given)
    if not (np.abs(signs) == 1).all():
        raise InputError(Problem(f"must be 1 or -1, got {signs[np.abs(signs) != 1][0]:g}", field="`polarities`"))
    return signs.astype(np.int64)


def _sentence(model: ModelName, found: Outcomes) -> str:
    many = f"By the {model} model {int(found.fell.sum())} of {found.fell.size} runs overturn"
    return many + (f", and the outcome of {int(found.unknown.sum())} is unknown." if found.unknown.any() else ".")


def _kept(grid: RunGrid) -> str:
    return f"Their rotations are kept at {grid.time.size:,} times, until {grid.time[-1]:.4g} s."


def _data(outcomes: Mapping[ModelName, Outcomes]) -> dict[str, Any]:
    data: dict[str, Any] = {}
    for name, each in outcomes.items():
        data[name] = {"overturned": _with_gaps(each.fell, each.unknown | each.failed)}
        data[name] |= {column: getattr(each, column) for column in OUTCOME_FIELDS}
        if name == "nonlinear" and np.isnan(each.opening).any():
            data[name]["unknown"] = _with_gaps(each.unknown, np.isnan(each.opening) & ~each.unknown)
    return data


def _with_gaps(values: NDArray[np.bool_], missing: NDArray[np.bool_]) -> Any:
    """Return values as nested lists, with None where they are missing."""
    objects = values.astype(object)
    objects[missing] = None
    return objects.tolist()
