"""`rk.spectrum`: compute peak rotation and overturning against size."""

from __future__ import annotations

from functools import partial
from math import pi
from typing import TYPE_CHECKING

import numpy as np

from rocking_cli.ask.answer import Answer, Dimensions, drawn
from rocking_cli.ask.ground_motions import each_of
from rocking_cli.ask.inputs import structures_of
from rocking_cli.ask.verbs import verb
from rocking_cli.ask.watcher import Watcher
from rocking_cli.errors import InputError, Problem, named
from rocking_cli.questions.spectrum.asked import SpectrumAsked

if TYPE_CHECKING:
    from rocking_cli.questions.spectrum.study import Spectrum


@verb(SpectrumAsked)
def spectrum(asked: SpectrumAsked, watch: Watcher) -> Answer[list[Spectrum]]:
    """Compute peak rotation and overturning against size, for structures and for blocks of given slenderness.

    Returns
    -------
    Answer of list of Spectrum
        One for each structure and slenderness; the peak of a motion that could not be simulated is NaN, that of an
        unknown outcome infinite, with its `lower_bound`. `to_frame()` has a row for each shape, motion and size, and
        with several motions `frames["fractiles"]` one for each shape, fractile and size.

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
    >>> answer = rk.spectrum(motions="sine:0.5g:0.8s", slenderness=[0.2], sizes=(1, 10), count=5)
    >>> answer.result[0].overturned.tolist()
    [1, 1, 1, 0, 0]
    """
    from rocking_cli.questions.spectrum import study
    from rocking_cli.questions.spectrum import view as views

    signs, requested, model = asked.signs, asked.ground_motions, asked.model
    if not requested:
        raise InputError(Problem("is missing: give a ground motion", field=named("motions")))
    ready = structures_of(each_of(asked.structures), watch, asked.opening, asked.restitution)
    shapes = [study.shape_of(each, model) for each in ready]
    shapes += [study.blocks_of(alpha, model, asked.restitution) for alpha in dict.fromkeys(asked.slenderness)]
    if not shapes:
        hint = f"give one, or {named('slenderness')} for blocks"
        raise InputError(Problem("is missing", field=named("structures"), hint=hint))
    as_given = [each.period for each in shapes if each.slenderness is None]
    widest = study.MAX_SCALE**0.5
    usual = (min(as_given) / widest, max(as_given) * widest) if as_given else study.BLOCK_PERIODS
    low, high = asked.sizes or usual
    periods = np.geomspace(low, high, asked.count)
    smallest = min([float(periods[0]), *as_given])
    chosen = requested.gather(2 * pi / smallest, watch, "the smallest size")
    scaled = [each.motion.scaled(each.factor) for each in chosen]
    with watch.progress(study.count_histories(shapes, periods, len(chosen), signs), "histories") as progress:
        result = study.spectra(shapes, periods, scaled, polarities=signs, threads=asked.jobs, progress=progress)
    results = views.ShownSpectra(result, chosen, tuple(sorted({*asked.fractiles, 0.5})), str(asked.polarity))
    if unfollowed := views.lost(results):
        watch.incomplete(unfollowed)
    figure = drawn("questions.spectrum.picture.draw_spectra", result, results.fractiles, views.title(results))
    dims = [Dimensions(("structure", "size"), ("scale", "R", "lambda")), Dimensions(("structure", "motion", "size"))]
    tables = {} if results.one else {"fractiles": partial(views.fractile_table, results)}
    return Answer("spectrum", result, views.view(results), partial(views.table, results), figure, None, tables, dims)
