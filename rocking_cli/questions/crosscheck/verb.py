"""`rk.crosscheck`: simulate the motion of a structure by both engines."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from math import ceil
from typing import TYPE_CHECKING

import numpy as np

from rocking_cli.ask.answer import Answer, Dimensions, drawn
from rocking_cli.ask.inputs import structure_of
from rocking_cli.ask.verbs import verb
from rocking_cli.ask.watcher import Advance, Watcher
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.names import TAIL_SECONDS
from rocking_cli.questions.crosscheck.asked import CrosscheckAsked
from rocking_cli.views.view import heading

if TYPE_CHECKING:
    from rocking_cli.arrays import Reals
    from rocking_cli.io.tables import Columns
    from rocking_cli.questions.crosscheck.study import Crosscheck


@verb(CrosscheckAsked)
def crosscheck(asked: CrosscheckAsked, watch: Watcher) -> Answer[Crosscheck]:
    """Simulate the motion of a structure by the exact engine and by free blocks, and compare them.

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
    from rocking_cli.questions.animate.verb import FRAMES_PER_SECOND, check_program, write_film
    from rocking_cli.questions.crosscheck import study
    from rocking_cli.questions.crosscheck.film import scene_of
    from rocking_cli.questions.crosscheck.view import view

    motions, (sign,) = asked.ground_motions, asked.signs
    check_program(asked.animate)
    ready = structure_of(asked.structure, watch, asked.opening)
    ready = ready if motions else ready.released()
    given = motions.gather(ready.growth, watch)[0] if motions else None
    scaled = given.motion.scaled(sign * given.factor) if given is not None else None
    ratio = asked.ratio(ready)
    lasts = ceil(scaled.duration if scaled is not None else TAIL_SECONDS)
    with watch.progress(lasts, "seconds of motion by free blocks") as advance:
        both = study.crosscheck(ready, scaled, release=ratio, progress=_in_seconds(advance))
    shown = view(ready, given, sign, ratio, both)
    title = heading(ready.mechanism)
    if asked.animate is not None and scaled is not None:
        write_film(asked.animate, scene_of(ready, both), title, scaled.name, None, FRAMES_PER_SECOND, watch)
    figure = drawn("questions.crosscheck.picture.draw_crosscheck", both, title)
    dims = [Dimensions(("t",), ("a_g",)), Dimensions(("engine", "t"))]
    return Answer("crosscheck", both, shown, partial(_columns, both), figure, dims=dims)


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
    from rocking_cli.io.tables import stacked

    exact, blocks = found.exact, found.of_blocks
    time = max(exact.time, blocks.time, key=len)
    ground = {}
    if found.motion is not None:
        kept = found.motion.kept
        ground = {"a_g [g]": np.interp(time, kept.time, kept.acceleration, right=0.0) / STANDARD_GRAVITY}
    each = {"exact": (found.extended(exact.phi), found.extended(exact.ratio)), "blocks": (blocks.phi, blocks.ratio)}
    return stacked(
        {"engine": engine, "t [s]": time, **ground}
        | {"phi [rad]": _padded(phi, time.size), "phi_ratio": _padded(ratio, time.size)}
        for engine, (phi, ratio) in each.items()
    )


def _padded(values: Reals, size: int) -> Reals:
    return np.append(values, np.full(size - values.size, np.nan))
