"""Selection of records for a target spectrum, in Python."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Unpack

import numpy as np
from numpy.typing import ArrayLike

from rocking_cli.ask.answer import Answer, drawn
from rocking_cli.ask.given import SiteLike, site_of
from rocking_cli.ask.ground_motions import Motion, Motions, ReadingArguments, Source
from rocking_cli.ask.numbers import refuse_idle, takes_numbers
from rocking_cli.ask.watcher import SILENT, Watcher
from rocking_cli.errors import InputError
from rocking_cli.excitation.records.opening import STANDARD_INPUT
from rocking_cli.processing.listed import Listed
from rocking_cli.questions.select.study import RecordSet

if TYPE_CHECKING:
    from rocking_cli.processing.reading import Reading
    from rocking_cli.questions.select.target_spectrum import TargetSpectrum
    from rocking_cli.questions.select.view import ShownSet


SITE_SUFFIXES = (".yaml", ".yml")


@dataclass(frozen=True, eq=False, repr=False)
class SetAnswer(Answer[RecordSet]):
    """Set of records, with what is needed to write it.

    Parameters
    ----------
    shown : ShownSet
        The set, its target and the files of all candidates.
    readings : tuple of (Reading or None)
        How each chosen file is read; None for what is not a file.
    """

    shown: ShownSet = field(kw_only=True)
    readings: tuple[Reading | None, ...] = field(kw_only=True)


@takes_numbers
def select(
    records: Motions | Motion | Sequence[Motion],
    target: TargetSpectrum | SiteLike | tuple[ArrayLike, ArrayLike],
    *,
    band: tuple[float, float],
    count: int,
    state: str | None = None,
    within: tuple[float, float] = (0.9, 1.3),
    damping: float = 0.05,
    factors: tuple[float, float] = (0.2, 5.0),
    one_per: str = "event",
    same_factor: bool = False,
    seed: int = 0,
    watch: Watcher = SILENT,
    **options: Unpack[ReadingArguments],
) -> SetAnswer:
    """Select records whose mean response spectrum matches a target, with a scale factor for each.

    Parameters
    ----------
    records : GroundMotion, Pulse, str or Path, or a sequence of these
        Records to select from; a text may be a pattern of files, such as `records/*.AT2`.
    target : str or Path, mapping, or (array_like, array_like)
        The file of the spectrum, or its periods [s] and pseudo-accelerations [standard gravity]; or a site file (.yaml)
        or its fields, of which the code gives the elastic spectrum of the ground.
    band : (float, float)
        Period range over which the mean must match [s].
    count : int
        Number of records to select.
    state : str, optional
        Limit state of the site whose spectrum is the target, such as `"SLC"`; by default that which decides, SLV.
    within : (float, float)
        Lower and upper limit on the ratio of mean to target.
    damping : float
        Damping ratio of the target.
    factors : (float, float)
        Lower and upper limit on the scale factor of each record.
    one_per : {"event", "station", "none"}
        Source from which at most one record is taken, if the files name it.
    same_factor : bool
        Whether all records have the same scale factor.
    seed : int
        Seed of the random searches, if there are too many sets to try all.
    watch : Watcher
        Told what was read, what is doubtful about it, and how far the search is.
    **options
        How the records are read and corrected: see `rocking_cli.ask.ground_motions.ReadingArguments`.

    Returns
    -------
    SetAnswer
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
    from rocking_cli.questions.select import study as record_set
    from rocking_cli.questions.select.view import ShownSet, table, title, view

    wanted = record_set.SetRequirements(count, band, within, damping, factors, one_per, same_factor, seed)
    spectrum = _target(target, state, damping, watch)
    spectrum.check(wanted.band)
    motions = _without(target, Motions.of(records, options), watch)
    chosen = motions.gather(0.0, watch)
    candidates = [each.motion for each in chosen]
    with watch.progress(len(candidates), "spectra") as advance:
        spectra = record_set.candidates(candidates, spectrum, wanted, advance)
    if coarse := record_set.coarse(spectra):
        worst = max(motion.dt for motion in coarse)
        watch.warn(
            f"the band begins at {wanted.band[0]:g} s, which is less than "
            f"{record_set.MIN_SAMPLES_PER_PERIOD} intervals of "
            f"{len(coarse)} of {len(candidates)} records (dt up to {worst:g} s): at such periods their spectra lack "
            "the motion between samples"
        )
    with ExitStack() as bars:
        result = record_set.choose(spectra, wanted, lambda total: bars.enter_context(watch.progress(total, "sets")))
    files = [str(each.file) if each.file else None for each in chosen]
    unusable = [str(each.path) for each in motions.records if all(each is not one.record for one in chosen)]
    results = ShownSet(result, spectrum, files, unusable)

    figure = drawn("questions.select.picture.draw_record_set", result, title(results))
    readings = tuple(
        None if str(chosen[k].file) == STANDARD_INPUT else chosen[k].reading for k in result.chosen.tolist()
    )
    return SetAnswer(
        "record set", result, view(results), lambda: table(results), figure, shown=results, readings=readings
    )


def _without(target: object, motions: Motions, watch: Watcher) -> Motions:
    """Return the motions without the target, which a pattern may also match."""
    if not isinstance(target, str | Path) or not Path(target).exists():
        return motions
    kept = replace(motions, sources=tuple(each for each in motions.sources if not _is_of(each, Path(target))))
    if kept.count < motions.count:
        if not kept:
            raise InputError(f"no records to choose from: {target} is the target; add the files of records")
        watch.note(f"{target} is the target spectrum and is not used as a record")
    return kept


def _is_of(source: Source, file: Path) -> bool:
    return isinstance(source, Listed) and source.path.exists() and source.path.samefile(file)


def _target(given: Any, state: str | None, damping: float, watch: Watcher) -> TargetSpectrum:
    from rocking_cli.questions.select.target_spectrum import TargetSpectrum, read_target, target_of_site

    if isinstance(given, Mapping) or (isinstance(given, str | Path) and Path(given).suffix.lower() in SITE_SUFFIXES):
        return target_of_site(site_of(given), state, damping)
    refuse_idle("for a target without limit states: give a site file as `target`", state=state)
    if isinstance(given, TargetSpectrum):
        return given
    if isinstance(given, str | Path):
        spectrum = read_target(Path(given))
        if spectrum.unit is None:
            watch.note(f"{given} does not name a unit: its ordinates are assumed to be in g")
        if (highest := spectrum.highest_if_odd) is not None:
            heading = "name its unit in a heading, such as period [s],Sa [m/s2]"
            watch.warn(f"{spectrum.name} reaches {highest:.4g} g: {heading}")
        return spectrum
    periods, sa = (np.atleast_1d(np.asarray(each, dtype=np.float64)) for each in given)
    return TargetSpectrum("target", periods, sa)
