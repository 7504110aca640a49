"""Selection of records for a target spectrum, in Python."""

from __future__ import annotations

from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking_cli.ask.answer import Answer, Dimensions, drawn
from rocking_cli.ask.ground_motions import Motions
from rocking_cli.ask.inputs import site_of
from rocking_cli.ask.verbs import verb
from rocking_cli.ask.watcher import Watcher
from rocking_cli.errors import InputError
from rocking_cli.excitation.records.opening import STANDARD_INPUT
from rocking_cli.processing.reading import Listed
from rocking_cli.questions.select.asked import SelectAsked
from rocking_cli.questions.select.study import RecordSet

if TYPE_CHECKING:
    from rocking_cli.questions.select.target_spectrum import TargetSpectrum


@verb(SelectAsked)
def select(asked: SelectAsked, watch: Watcher) -> Answer[RecordSet]:
    """Select records whose mean response spectrum matches a target, with a scale factor for each.

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
    from rocking_cli.questions.select import study as record_set
    from rocking_cli.questions.select.set_folder import check_folder, write_set
    from rocking_cli.questions.select.view import ShownSet, table, title, view

    wanted = record_set.SetRequirements(
        asked.count, asked.band, asked.within, asked.damping, asked.factors, asked.one_per, asked.same_factor,
        asked.seed,
    )  # fmt: skip
    spectrum = _target(asked, watch)
    spectrum.check(wanted.band)
    motions = _without(asked.target, asked.ground_motions, watch)
    if asked.out is not None:
        target = [Path(asked.target)] if isinstance(asked.target, str | Path) else []
        check_folder(asked.out, [*target, *(each.path for each in motions.records)])
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

    figure = drawn("questions.select.view.draw_record_set", result, title(results))
    if asked.out is not None:
        used = [chosen[k] for k in result.chosen.tolist()]
        readings = [None if str(each.file) == STANDARD_INPUT else each.reading for each in used]
        watch.note(write_set(asked.out, results, readings))
    dims = [Dimensions(("period",), ("target_Sa", "mean_Sa")), Dimensions(("motion", "period"))]
    return Answer("record set", result, view(results), lambda: table(results), figure, dims=dims)


def _without(target: object, motions: Motions, watch: Watcher) -> Motions:
    """Return the motions without the target, which a pattern may also match."""
    if not isinstance(target, str | Path) or not Path(target).exists():
        return motions
    others = [
        source
        for source in motions.sources
        if not (isinstance(source, Listed) and source.path.exists() and source.path.samefile(Path(target)))
    ]
    kept = replace(motions, sources=tuple(others))
    if kept.count < motions.count:
        if not kept:
            raise InputError(f"no records to choose from: {target} is the target; add the files of records")
        watch.note(f"{target} is the target spectrum and is not used as a record")
    return kept


def _target(asked: SelectAsked, watch: Watcher) -> TargetSpectrum:
    from rocking_cli.questions.select.target_spectrum import TargetSpectrum, read_target, target_of_site

    given: Any = asked.target
    if asked.of_site:
        return target_of_site(site_of(given), asked.state, asked.damping)
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
