"""Selection of records for a target spectrum, in Python."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from rocking_cli.ask.answer import Answer
from rocking_cli.ask.given import Motion, each_of, motion_of
from rocking_cli.excitation.base import GroundMotion

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rocking_cli.studies.record_set import RecordSet
    from rocking_cli.studies.target_spectrum import TargetSpectrum


def select(
    records: Motion | Sequence[Motion],
    target: TargetSpectrum | str | Path | tuple[ArrayLike, ArrayLike],
    *,
    band: tuple[float, float],
    count: int,
    within: tuple[float, float] = (0.9, 1.3),
    damping: float = 0.05,
    factors: tuple[float, float] = (0.2, 5.0),
    one_per: str = "event",
    same_factor: bool = False,
    seed: int = 0,
) -> Answer[RecordSet]:
    """Select records whose mean response spectrum matches a target, with a scale factor for each.

    Parameters
    ----------
    records : GroundMotion, Pulse, str or Path, or a sequence of these
        Records to select from; a text may be a pattern of files, such as `records/*.AT2`.
    target : str or Path, or (array_like, array_like)
        The file of the spectrum, or its periods [s] and pseudo-accelerations [standard gravity].
    band : (float, float)
        Period range over which the mean must match [s].
    count : int
        Number of records to select.
    within : (float, float)
        Lower and upper limit on the ratio of mean to target.
    damping : float
        Damping ratio of the target.
    factors : (float, float)
        Lower and upper limit on the scale factor of each record.
    one_per : {"event", "station", "none"}
        Origin from which at most one record is taken, if the files name it.
    same_factor : bool
        Whether all records have the same scale factor.
    seed : int
        Seed of the random searches, if there are too many sets to try all.

    Returns
    -------
    Answer of RecordSet
        `fits` is whether the set stays within the limits, `motions` are the scaled records, and `factors` their scale
        factors; `mean`, and `periods`, `target` and `spectra` of `candidates`, are spectra.

    Raises
    ------
    InputError
        If a value is out of range, a file cannot be used, or there are too few records.

    Notes
    -----
    The limits are those of NTC 2018, 3.2.3.6; EN 1998-1:2004, 3.2.3.1.2(4), requires the lower one only, from 0.2 to 2
    times the fundamental period of a structure.
    """
    from rocking_cli.studies import record_set
    from rocking_cli.views.record_set import ShownSet, table, title, view

    motions, files = _candidates(records)
    wanted = record_set.SetRequirements(count, band, within, damping, factors, one_per, same_factor, seed)
    spectrum = _target(target)
    found = record_set.choose(record_set.candidates(motions, spectrum, wanted), wanted)
    results = ShownSet(found, spectrum, files)

    def figure() -> Figure:
        from rocking_cli.plotting.record_set import draw_record_set

        return draw_record_set(found, title(results))

    return Answer("record set", found, view(results), lambda: table(results), figure)


def _candidates(given: Any) -> tuple[list[GroundMotion], list[str | None]]:
    """Return motions with unique names, and the files of those read from one."""
    from dataclasses import replace

    from rocking_cli.excitation.selection import select as files_of

    motions: list[GroundMotion] = []
    files: list[str | None] = []
    for each in each_of(given):
        pattern = isinstance(each, str) and any(sign in each for sign in "*?[") and not Path(each).exists()
        for one in files_of(each) if pattern else [each]:
            motion = motion_of(one)
            if any(motion.name == other.name for other in motions):
                motion = replace(motion, name=f"{motion.name} ({len(motions) + 1})")
            motions.append(motion)
            files.append(str(one) if isinstance(one, Path | str) and Path(one).exists() else None)
    return motions, files


def _target(given: Any) -> TargetSpectrum:
    from rocking_cli.studies.target_spectrum import TargetSpectrum, read_target

    if isinstance(given, TargetSpectrum):
        return given
    if isinstance(given, str | Path):
        return read_target(Path(given))
    periods, sa = (np.atleast_1d(np.asarray(each, dtype=np.float64)) for each in given)
    return TargetSpectrum("target", periods, sa)
