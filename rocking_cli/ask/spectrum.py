"""`rk.spectrum`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from rocking_cli.ask.answer import Answer
from rocking_cli.ask.given import Motion, StructureLike, each_of, motion_of, structure_of
from rocking_cli.dynamics.model import ModelName
from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.scaled import Scaled

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rocking_cli.studies.spectrum import Spectrum


def spectrum(
    structures: StructureLike | Sequence[StructureLike] = (),
    motions: Motion | Sequence[Motion] = (),
    *,
    slenderness: Sequence[float] = (),
    sizes: tuple[float, float] | None = None,
    count: int = 60,
    model: ModelName = "nonlinear",
    eta: float | None = None,
    polarities: Sequence[int] = (1,),
    fractiles: Sequence[float] = (0.16, 0.84),
) -> Answer[list[Spectrum]]:
    """Compute peak rotation and overturning against size, for structures and for blocks of given slenderness.

    Parameters
    ----------
    structures, motions
        One or several, as for `respond`.
    slenderness : sequence of float
        alpha of rectangular blocks [rad].
    sizes : (float, float), optional
        Smallest and largest size, as 2 pi/p [s].
    count : int
        Number of sizes between them, at equal ratios.
    model : {"nonlinear", "linear1", "linear2"}
        The equation of motion.
    eta : float, optional
        Coefficient of restitution; by default that of the structures.
    polarities : sequence of int
        Polarities, of 1 and -1; with both, the worse governs.
    fractiles : sequence of float
        Fractiles in addition to the median, with several motions.

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
    """
    from rocking_cli.studies import spectrum as study
    from rocking_cli.views import spectrum as views

    _check_count("count", count)
    shapes = [study.shape_of(structure_of(each).mechanism, model, eta) for each in each_of(structures)]
    shapes += [study.blocks_of(alpha, model, eta) for alpha in slenderness]
    shaking = [motion_of(each) for each in each_of(motions)]
    if not shapes:
        raise InputError("no structure given: give structures, or slenderness for blocks")
    periods = np.geomspace(*(sizes or study.usual_sizes(shapes)), count)
    found = study.spectra(shapes, periods, shaking, polarities=polarities)
    polarity = "both" if len(polarities) > 1 else str(polarities[0])
    results = views.ShownSpectra(
        found, [Scaled(each, 1.0) for each in shaking], tuple(sorted({*fractiles, 0.5})), polarity
    )

    def figure() -> Figure:
        from rocking_cli.plotting.spectrum import draw_spectra

        return draw_spectra(found, results.fractiles, views.title(results))

    return Answer("spectrum", found, views.view(results), lambda: views.table(results), figure)


def _check_count(name: str, count: int, least: int = 1) -> None:
    """Raise `InputError` if a number of values is not a whole number, or too small."""
    if not isinstance(count, int) or count < least:
        raise InputError(Problem(f"must be a whole number of at least {least}, got {count!r}", field=name))
