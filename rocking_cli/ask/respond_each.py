"""`rk.respond_each`: compute the outcomes of many structures under many motions."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rocking_cli.ask.answer import MappingAnswer, no_plot
from rocking_cli.ask.given import StructureLike, models_of, structure_of
from rocking_cli.ask.ground_motions import Motion, each_of, motion_of
from rocking_cli.ask.numbers import takes_numbers
from rocking_cli.ask.watcher import SILENT, Watcher
from rocking_cli.dynamics.batch import Runs, respond_many
from rocking_cli.dynamics.model import MODELS, ModelName
from rocking_cli.dynamics.outcome import OUTCOME, Outcomes
from rocking_cli.errors import InputError, Problem
from rocking_cli.names import OPENING
from rocking_cli.views.view import View

if TYPE_CHECKING:
    from rocking_cli.io.tables import Columns


@takes_numbers
def respond_each(
    structures: StructureLike | Sequence[StructureLike],
    motions: Motion | Sequence[Motion],
    *,
    models: str | Sequence[str] | None = None,
    scales: ArrayLike = 1.0,
    threads: int | None = None,
    opening: float = OPENING,
    watch: Watcher = SILENT,
) -> MappingAnswer[ModelName, Outcomes]:
    """Compute the outcome of every structure under every motion with every scale factor.

    Parameters
    ----------
    structures, motions
        One or several, as for `respond`.
    models : str or sequence of str, optional
        Models "nonlinear", "linear1" or "linear2"; all by default.
    scales : array_like
        Scale factors on the motions; negative ones reverse them.
    threads : int, optional
        Number of time histories at a time; by default, one for each processor.
    opening : float
        Largest opening of a joint up to which a history is valid, over D_cr.
    watch : Watcher
        Told what is doubtful about the structures.

    Returns
    -------
    MappingAnswer of str to Outcome
        Arrays of shape (structures, motions, scales), by model; `failed` marks motions that could not be simulated, and
        `unknown` those whose outcome is unknown from `known_to` on: their `overturned` is NaN, and `share()` gives the
        lowest and the highest share of the motions that overturn.

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
    ready = [structure_of(each, watch, opening) for each in each_of(structures)]
    shaking = [motion_of(each) for each in each_of(motions)]
    factors = np.atleast_1d(np.asarray(scales, dtype=np.float64))
    if factors.ndim > 1:
        raise InputError(
            Problem(f"must be one factor or a list of them, got an array of shape {factors.shape}", field="scales")
        )
    shape = len(ready), len(shaking), factors.size
    chosen = models_of(models)
    if models is None and any(len(each.default_models) < len(MODELS) for each in ready):
        chosen = ("nonlinear",)
    found: dict[ModelName, Outcomes] = {}
    for name in chosen:
        runs = Runs.every(len(ready), len(shaking), scales=factors.tolist())
        many = respond_many([each.model(name) for each in ready], shaking, runs, threads=threads)
        found[name] = many.by_field(lambda values: values.reshape(shape))

    def columns() -> Columns:
        places = [axis.ravel() for axis in np.indices(shape)]
        table: dict[str, Any] = {
            "structure": [ready[k].name for k in places[0]],
            "motion": [shaking[k].name for k in places[1]],
            "scale": factors[places[2]],
        }
        for name, outcome in found.items():
            for column in ("overturned", "peak_ratio", "uplift_time", "overturning_time", "impact_count"):
                table[f"{name} {column}"] = getattr(outcome, column).ravel()
            if outcome.unknown.any():
                table |= {f"{name} {column}": getattr(outcome, column).ravel() for column in ("unknown", "known_to")}
        return table

    first = found[chosen[0]]
    said = f"By the {chosen[0]} model {int(first.fell.sum())} of {first.fell.size} motions overturn"
    said += f", and the outcome of {int(first.unknown.sum())} is unknown." if first.unknown.any() else "."
    data: dict[str, Any] = {}
    for name, each in found.items():
        data[name] = {"overturned": _with_gaps(each.fell, each.unknown | each.failed)}
        data[name] |= {column: getattr(each, column) for column in OUTCOME}
        if name == "nonlinear" and np.isnan(each.opening).any():
            data[name]["unknown"] = _with_gaps(each.unknown, np.isnan(each.opening) & ~each.unknown)
    figure = no_plot("many responses have no plot of their own: plot a spectrum, a map or a margin")
    return MappingAnswer("responses", found, View(data, [said]), columns, figure)


def _with_gaps(values: NDArray[np.bool_], missing: NDArray[np.bool_]) -> Any:
    """Return values as nested lists, with None where they are missing."""
    found = values.astype(object)
    found[missing] = None
    return found.tolist()
