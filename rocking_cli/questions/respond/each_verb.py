"""`rk.respond_each`: every structure under every motion with every factor, in arrays, frames and labelled grids."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from math import prod
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from rocking_cli.arrays import Reals
from rocking_cli.ask.answer import Dimensions, MappingAnswer, framed
from rocking_cli.ask.ground_motions import MAX_PGA, Motions, each_of
from rocking_cli.ask.groups import Reading
from rocking_cli.ask.inputs import structures_of
from rocking_cli.ask.verbs import verb
from rocking_cli.ask.watcher import Watcher
from rocking_cli.dynamics.model import MODELS, ModelName
from rocking_cli.dynamics.outcome import OUTCOME_FIELDS, Outcomes
from rocking_cli.errors import InputError, Problem, named
from rocking_cli.io.tables import stacked
from rocking_cli.questions.respond.asked import RespondEachAsked
from rocking_cli.questions.respond.each import FAILED, OUTCOMES, RunGrid, columns, labelled_columns
from rocking_cli.studies.fit import fractile
from rocking_cli.views.column import long_name
from rocking_cli.views.verdict import unchecked
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
        doubtful = np.where(rows["peak_lower_bound"] > ratio, 1.0, np.nan)
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
        """Return labelled arrays, see `Answer.to_xarray`, with `rotation` over `t` if there are `histories`.

        The dimensions are model, structure, motion, scale (or target_pga), and polarity and restitution if given;
        `pga_g` and `pgv` are over the third and the fourth.
        """
        arrays = super().to_xarray()
        if self.rotation:
            from pandas import factorize

            codes = (
                factorize(each, use_na_sentinel=False)[0] for each in (np.array(list(self)), *self.grid.axes.values())
            )
            firsts = np.ix_(*(np.unique(each, return_index=True)[1] for each in codes))  # a scale may be given twice
            turned = np.stack([self.rotation[model] for model in self])[firsts]
            arrays["t"] = "t", self.time, {"units": "s", "long_name": long_name("t")}
            arrays["rotation"] = [*self.dims[-1].names, "t"], turned, {"units": "rad", "long_name": long_name("phi")}
        return arrays

    def quantiles(self, *shares: float, over: str | Sequence[str] = "motion") -> pandas.DataFrame:
        """Return quantiles of the peak ratio over runs, in which runs that overturn rank above every finite peak.

        Parameters
        ----------
        *shares : float
            The quantiles, each from 0 to 1.
        over : str or sequence of str
            The axes whose runs are ranked together: "motion", or others of `grid.axes`, such as
            `["motion", "polarity"]`.

        Returns
        -------
        pandas.DataFrame
            A row for each quantile and each combination of the other axes. `peak_ratio` is infinite where the quantile
            is a run that overturns, or lies between one and a run that does not. Runs of unknown outcome count as
            overturning; in `peak_lower_bound` they count with the lower bound of their peak, so that the quantile lies
            between the two. Failed runs are left out: `runs` is the number that is ranked. Without any, quantiles are
            NaN.

        Raises
        ------
        InputError
            If a number is no quantile, there is no such axis, or pandas is not installed.

        Notes
        -----
        The k-th of n ordered peaks is the quantile (k - 1)/(n - 1), with linear interpolation, as in NumPy and xarray.
        These two give NaN for a quantile beside an infinite peak, as `to_xarray().peak_ratio.quantile(0.84, "motion")`
        does. xarray skips NaN, so that quantiles of arrays in which a peak that overturns is NaN, such as
        `answer["nonlinear"].peak_ratio`, are those of the runs that stand, and too low.

        Examples
        --------
        >>> import rocking_cli as rk
        >>> block = rk.Block(width=0.7, height=2.8)
        >>> runs = rk.respond_each(block, "sine:1g:0.8s", model="nonlinear", scale=[0.2, 0.3, 0.4, 0.5])
        >>> runs.quantiles(0.16, 0.5, over="scale").peak_ratio.round(2).tolist()
        [0.05, inf]
        """
        axes = self.grid.axes
        over = [over] if isinstance(over, str) else list(dict.fromkeys(over))
        if unknown := [each for each in over if each not in axes]:
            raise InputError(Problem(f"is not an axis of these runs: {', '.join(axes)}", field=f"{unknown[0]!r}"))
        if wrong := [each for each in shares if not 0 <= each <= 1]:
            raise InputError(Problem("is not a quantile from 0 to 1", field=f"{wrong[0]:g}"))
        kept = [name for name in axes if name not in over]
        order = [list(axes).index(name) for name in (*over, *kept)]
        labels = np.meshgrid(*(axes[name] for name in kept), indexing="ij")
        along = dict(zip(kept, map(np.ravel, labels), strict=True))

        def ranked(each: Outcomes, doubtful: float | Reals) -> Reals:
            """Return the peaks with a row for each run to rank, those of unknown outcome `doubtful`."""
            peaks = np.where(each.fell, np.inf, np.where(each.unknown, doubtful, each.peak_ratio))
            peaks = np.where(each.failed, np.nan, peaks).transpose(order)
            return peaks.reshape(prod(peaks.shape[: len(over)]), -1)

        def tables() -> Iterator[dict[str, Any]]:
            for model, each in self.items():
                highest, lowest = ranked(each, np.inf), ranked(each, each.lower_bound)
                count = np.count_nonzero(~np.isnan(highest), axis=0)
                for q in shares:
                    ends = {"peak_ratio": fractile(highest, q), "peak_lower_bound": fractile(lowest, q)}
                    yield {"model": model, **along, "quantile": q, **ends, "runs": count}

        return framed(lambda: stacked(tables()))


@verb(RespondEachAsked)
def respond_each(asked: RespondEachAsked, watch: Watcher) -> EachAnswer:
    """Compute the outcome of every structure under every motion with every scale factor, polarity and restitution.

    Returns
    -------
    EachAnswer
        Arrays by model, of shape (structures, motions, scales), and (..., polarities) and (..., restitutions) if those
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
    Time histories are those of `respond`, to the last bit, but end once they are unknown: `opening` is then the largest
    until there, in `respond` that of the whole history. Eqs. 8 and 16 of DeJong and Dimitrakopoulos (2014).

    Examples
    --------
    >>> import rocking_cli as rk
    >>> blocks = [rk.Block(width=0.7, height=2.8), rk.Block(width=0.5, height=2.8)]
    >>> answer = rk.respond_each(blocks, "sine:0.4g:0.8s", model="nonlinear", scale=[0.5, 1.0])
    >>> answer["nonlinear"].overturned.tolist()
    [[[0.0, 1.0]], [[0.0, 1.0]]]
    >>> answer["nonlinear"].share()
    (0.5, 0.5)
    """
    ready = structures_of(each_of(asked.structures), watch, asked.opening)
    whole = all(len(each.default_models) == len(MODELS) for each in ready)
    chosen = asked.models(MODELS if whole else ("nonlinear",))
    sources = Motions.of(asked.motions, asked.part(Reading))
    shaking = sources.gather(max(each.growth for each in ready), watch)
    of_pga = asked.target_pga is not None
    if of_pga and (still := [one.motion.name for one in shaking if one.motion.of_ground.pga_g == 0]):
        raise InputError(Problem("is zero throughout and cannot be scaled to a peak", still[0]))
    numbers: Any = asked  # arrays, as they were read
    grid = RunGrid(
        ready,
        [one.motion if one.factor == 1 else one.motion.scaled(one.factor) for one in shaking],
        numbers.target_pga if of_pga else np.ones(1) if asked.scale is None else numbers.scale,
        numbers.polarity,
        numbers.restitution,
        of_pga,
    )
    if (pga := float(grid.pga_g.max())) > MAX_PGA:
        scaled = named("target_pga" if of_pga else "scale")
        hint = f"give at most {MAX_PGA:g} g: check the units"
        raise InputError(Problem(f"up to {pga:.4g} g is not plausible for a ground motion", field=scaled, hint=hint))
    if asked.histories:
        grid.check_memory()
    with watch.progress(grid.count * len(chosen) * (1 + asked.histories), "runs") as advance:
        outcomes = {name: grid.outcomes(name, asked.jobs, advance) for name in chosen}
        rotation = {name: grid.rotations(name, asked.jobs, advance) for name in chosen if asked.histories}
    runs, table = ("model", *grid.axes), partial(labelled_columns, grid, outcomes)
    return EachAnswer(
        "responses",
        outcomes,
        View(partial(_data, outcomes), _sentences(grid, chosen[0], outcomes[chosen[0]], kept=asked.histories)),
        partial(columns, grid, outcomes),
        partial(_figure, grid, outcomes),
        dims=[Dimensions(runs[2:4], MEASURES, table), Dimensions(runs, table=table)],
        grid=grid,
        rotation=rotation,
    )


def _figure(
    grid: RunGrid, outcomes: Mapping[ModelName, Outcomes], *, x: str = "pga_g", y: str = "peak_ratio"
) -> Figure:
    from rocking_cli.questions.respond.each_picture import draw_each

    return draw_each(grid, outcomes, x, y)


def _sentences(grid: RunGrid, model: ModelName, found: Outcomes, *, kept: bool) -> list[str]:
    many = f"By the {model} model {int(found.fell.sum())} of {found.fell.size} runs overturn"
    doubt = f", and the outcome of {int(found.unknown.sum())} is unknown" if found.unknown.any() else ""
    times = f"Their rotations are kept at {grid.time.size:,} times, until {grid.time[-1]:.4g} s." if kept else ""
    missing = np.isnan(found.opening) & ~found.failed & (model == "nonlinear")
    several = [each for each, of_it in zip(grid.structures, missing, strict=True) if of_it.any()]
    return [f"{many}{doubt}.", times, *(unchecked(each.name, each.mechanism.unchecked) for each in several)]


def _data(outcomes: Mapping[ModelName, Outcomes]) -> dict[str, Any]:
    data: dict[str, Any] = {}
    for name, each in outcomes.items():
        data[name] = {"overturned": _with_gaps(each.fell, each.unknown | each.failed)}
        data[name] |= {column: getattr(each, column) for column in OUTCOME_FIELDS}
        data[name]["peak_lower_bound"] = data[name].pop("lower_bound")
        if name == "nonlinear" and np.isnan(each.opening).any():
            data[name]["unknown"] = _with_gaps(each.unknown, np.isnan(each.opening) & ~each.unknown)
    return data


def _with_gaps(values: NDArray[np.bool_], missing: NDArray[np.bool_]) -> Any:
    """Return values as nested lists, with None where they are missing."""
    objects = values.astype(object)
    objects[missing] = None
    return objects.tolist()
