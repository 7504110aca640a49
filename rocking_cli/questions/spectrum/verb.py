"""`rk.spectrum`: compute peak rotation and overturning against size."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from math import pi
from typing import TYPE_CHECKING, Unpack

import numpy as np

from rocking_cli.ask.answer import Answer, drawn
from rocking_cli.ask.given import StructureLike, structures_of
from rocking_cli.ask.ground_motions import Motion, MotionArguments, Motions, each_of, signs_of
from rocking_cli.ask.numbers import refuse_idle, takes_numbers
from rocking_cli.ask.watcher import SILENT, Watcher
from rocking_cli.dynamics.model import ModelName
from rocking_cli.errors import InputError, Problem
from rocking_cli.names import OPENING

if TYPE_CHECKING:
    from rocking_cli.questions.spectrum.study import Spectrum


@takes_numbers
def spectrum(
    structures: StructureLike | Sequence[StructureLike] = (),
    motions: Motion | Sequence[Motion] | Motions = (),
    *,
    slenderness: Sequence[float] = (),
    sizes: tuple[float, float] | tuple[float, float, int] | None = None,
    count: int = 60,
    model: ModelName = "nonlinear",
    eta: float | None = None,
    polarity: str | int = "1",
    fractiles: Sequence[float] = (0.16, 0.84),
    jobs: int | None = None,
    opening: float = OPENING,
    watch: Watcher = SILENT,
    **options: Unpack[MotionArguments],
) -> Answer[list[Spectrum]]:
    """Compute peak rotation and overturning against size, for structures and for blocks of given slenderness.

    Parameters
    ----------
    structures, motions
        One or several, as for `respond`.
    slenderness : sequence of float
        alpha of rectangular blocks [rad].
    sizes : (float, float) or (float, float, int), optional
        Smallest and largest size, as 2 pi/p [s], and the number of sizes if it is not `count`.
    count : int
        Number of sizes between them, at equal ratios.
    model : {"nonlinear", "linear1", "linear2"}
        The equation of motion.
    eta : float, optional
        Coefficient of restitution; by default that of the structures.
    polarity : {"1", "-1", "both"}
        Polarity of the motions; with both, the worse governs.
    fractiles : sequence of float
        Fractiles in addition to the median, with several motions.
    jobs : int, optional
        Number of processor cores to use; all by default.
    opening : float
        Largest opening of a joint up to which a history is valid, over D_cr.
    watch : Watcher
        Shown the progress, and told what was read, what is doubtful about it, and what cannot be used.
    **options
        How the motions are read, corrected and scaled: see `rocking_cli.ask.ground_motions.MotionArguments`.

    Returns
    -------
    Answer of list of Spectrum
        One for each structure and slenderness; the peak of a motion that could not be simulated is NaN, that of an
        unknown outcome infinite, with its `lower_bound`.

    Raises
    ------
    InputError
        If a value is out of range, or a file cannot be used.
    MechanismError
        If the structure has no critical rotation or no uplift acceleration.

    Notes
    -----
    Rocking spectra of Makris and Konstantinidis (2003), with the models of DeJong and Dimitrakopoulos (2014).

    Examples
    --------
    >>> import rocking_cli as rk
    >>> answer = rk.spectrum(motions="sine:0.5g:0.8s", slenderness=[0.2], sizes=(1, 10, 5))
    >>> answer.result[0].overturned.tolist()
    [1, 1, 1, 0, 0]
    """
    from rocking_cli.questions.spectrum import study
    from rocking_cli.questions.spectrum import view as views

    if not isinstance(count, int) or count < 1:
        raise InputError(Problem(f"must be a whole number of at least 1, got {count!r}", field="count"))
    for fractile in fractiles:
        if not 0 < fractile < 1:
            raise InputError(Problem(f"{fractile:g} is not a fractile between 0 and 1", field="`fractiles`"))
    signs, requested = signs_of(polarity), Motions.of(motions, options)
    if not requested:
        raise InputError("no ground motion is given: give `motions`")
    if model != "nonlinear":
        refuse_idle("on linear blocks, which have no joints", opening=opening != OPENING)
    ready = structures_of(each_of(structures), watch, opening)
    shapes = [study.shape_of(each, model, eta) for each in ready]
    shapes += [study.blocks_of(alpha, model, eta) for alpha in dict.fromkeys(slenderness)]
    if not shapes:
        raise InputError("no structure given: give structures, or slenderness for blocks")
    low, high, number = (*(sizes or study.usual_sizes(shapes)), count)[:3]
    periods = np.geomspace(low, high, number)
    smallest = min([float(periods[0]), *(each.period for each in shapes if each.slenderness is None)])
    chosen = requested.gather(2 * pi / smallest, watch, "the smallest size")
    scaled = [each.motion.scaled(each.factor) for each in chosen]
    with watch.progress(study.count_histories(shapes, periods, len(chosen), signs), "histories") as progress:
        result = study.spectra(shapes, periods, scaled, polarities=signs, threads=jobs, progress=progress)
    results = views.ShownSpectra(result, chosen, tuple(sorted({*fractiles, 0.5})), str(polarity))
    if unfollowed := views.lost(results):
        watch.incomplete(unfollowed)
    figure = drawn("questions.spectrum.picture.draw_spectra", result, results.fractiles, views.title(results))
    return Answer("spectrum", result, views.view(results), partial(views.table, results), figure)
