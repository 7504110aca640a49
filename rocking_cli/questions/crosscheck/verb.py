"""`rk.crosscheck`: simulate the motion of a structure by both engines."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from math import ceil
from pathlib import Path
from typing import TYPE_CHECKING, Unpack

import numpy as np

from rocking_cli.ask.answer import Answer, drawn
from rocking_cli.ask.given import StructureLike, structure_of
from rocking_cli.ask.ground_motions import Motion, MotionArguments, Motions, signs_of
from rocking_cli.ask.numbers import takes_numbers
from rocking_cli.ask.watcher import SILENT, Advance, Watcher
from rocking_cli.dynamics.history import TAIL_SECONDS
from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.names import OPENING
from rocking_cli.studies.release import Release
from rocking_cli.views.view import heading

if TYPE_CHECKING:
    from rocking_cli.arrays import Reals
    from rocking_cli.io.tables import Columns
    from rocking_cli.questions.crosscheck.study import Crosscheck


@takes_numbers
def crosscheck(
    structure: StructureLike,
    motion: Motion | Motions | None = None,
    *,
    polarity: str | int = "1",
    release: Release | float | str | None = None,
    opening: float = OPENING,
    animate: str | Path | None = None,
    watch: Watcher = SILENT,
    **options: Unpack[MotionArguments],
) -> Answer[Crosscheck]:
    """Simulate the motion of a structure by the exact engine and by free blocks, and compare them.

    Parameters
    ----------
    structure : Mechanism, str or Path
        The structure, or its YAML file.
    motion : GroundMotion, Pulse, str or Path, optional
        The ground motion, its file, or a pulse as text.
    polarity : {"1", "-1"}
        Polarity of the motion: as given, or reversed.
    release : float or str, optional
        Initial tilt of a release from rest: a fraction of phi_cr, between -1 and 1, or an angle such as "0.05rad";
        negative is anticlockwise.
    opening : float
        Largest opening of a joint up to which the exact history is valid, over D_cr.
    animate : str or Path, optional
        Animation of both, side by side, to write: .gif, .mp4 for a video (which requires ffmpeg), or .html for a page.
    watch : Watcher
        Told what was read, how far the work is, and what was written.
    **options
        How the motion is read, corrected and scaled: see `rocking_cli.ask.ground_motions.MotionArguments`.

    Returns
    -------
    Answer of Crosscheck
        `exact` and `of_blocks` are the time histories, `finding` states whether they agree, `parted` is the time from
        which they differ, and `joints` has the openings that free blocks find. Its frame has both rotations over time.

    Raises
    ------
    InputError
        If MuJoCo is not installed, the structure has something that free blocks cannot have, a value is out of range,
        or a file cannot be used.
    MechanismError
        If the structure has no critical rotation or no uplift acceleration.
    SolverError
        If a motion cannot be simulated to its end.

    Notes
    -----
    The exact engine is the nonlinear model of `respond`, whose joints are checked. Free blocks are the same bodies with
    contact and friction, simulated by MuJoCo: restitution is what their contacts give, and the restitution of the
    structure has no effect on them.

    Examples
    --------
    >>> import rocking_cli as rk
    >>> answer = rk.crosscheck(rk.Block(width=0.7, height=2.8), "sine:0.3g:0.9s")
    >>> answer.finding
    'agree'
    """
    from rocking_cli.questions.animate.verb import FRAMES_PER_SECOND, check_film, write_film
    from rocking_cli.questions.crosscheck import study
    from rocking_cli.questions.crosscheck.film import scene_of
    from rocking_cli.questions.crosscheck.view import view

    motions, signs = Motions.of(() if motion is None else motion, options), signs_of(polarity)
    _check(motions, signs, release, animate)
    if animate is not None:
        check_film(Path(animate), signs, None, FRAMES_PER_SECOND)
    ready = structure_of(structure, watch, opening)
    ready = ready if motions else ready.released()
    given = motions.gather(ready.growth, watch)[0] if motions else None
    scaled = given.motion.scaled(signs[0] * given.factor) if given is not None else None
    tilt = None if release is None else release if isinstance(release, Release) else Release.of(release)
    ratio = tilt.ratio(ready) if tilt is not None else None
    lasts = ceil(scaled.duration if scaled is not None else TAIL_SECONDS)
    with watch.progress(lasts, "seconds of motion by free blocks") as advance:
        both = study.crosscheck(ready, scaled, release=ratio, progress=_in_seconds(advance))
    shown = view(ready, given, signs[0], ratio, both)
    title = heading(ready.mechanism)
    if animate is not None and scaled is not None:
        write_film(Path(animate), scene_of(ready, both), title, scaled.name, None, FRAMES_PER_SECOND, watch)
    figure = drawn("questions.crosscheck.picture.draw_crosscheck", both, title)
    return Answer("crosscheck", both, shown, partial(_columns, both), figure)


def _check(motions: Motions, signs: tuple[int, ...], release: object, animate: object) -> None:
    """Raise `InputError` if there is nothing to simulate, or more than one motion."""
    if motions.count > 1:
        raise InputError(f"{motions.count} motions are given where one is expected: ask for one after the other")
    if len(signs) > 1:
        raise InputError(Problem("must be 1 or -1: one motion is simulated", field="`polarity`"))
    if not motions and release is None:
        raise InputError("no excitation is given: give a motion or a `release`")
    if not motions and signs != (1,):
        raise InputError("`polarity` reverses a ground motion: give `motion`")
    if not motions and animate is not None:
        raise InputError("`animate` shows a ground motion: give `motion`")


def _in_seconds(advance: Advance) -> Callable[[float], None]:
    """Return a function of the time that free blocks have reached, which counts whole seconds."""
    done = 0

    def progress(time: float) -> None:
        nonlocal done
        if time >= done + 1:  # not if the blocks start again, with stiffer contacts
            advance(int(time) - done)
            done = int(time)

    return progress


def _columns(found: Crosscheck) -> Columns:
    from rocking_cli.questions.crosscheck.view import divisor

    exact, blocks = found.exact, found.of_blocks
    time = max(exact.time, blocks.time, key=len)
    over = f"phi/{divisor(exact)}"
    ground = {}
    if found.motion is not None:
        kept = found.motion.kept
        ground = {"a_g [g]": np.interp(time, kept.time, kept.acceleration, right=0.0) / STANDARD_GRAVITY}
    series = {
        "exact phi [rad]": found.extended(exact.phi), f"exact {over}": found.extended(exact.ratio),
        "blocks phi [rad]": blocks.phi, f"blocks {over}": blocks.ratio,
    }  # fmt: skip
    return {"t [s]": time, **ground, **{name: _padded(each, time.size) for name, each in series.items()}}


def _padded(values: Reals, size: int) -> Reals:
    return np.append(values, np.full(size - values.size, np.nan))
