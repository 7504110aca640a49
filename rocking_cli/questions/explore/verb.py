"""`rk.explore`: write a page on which a structure and its motion can be changed."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

from rocking_cli.ask.answer import Answer, drawn
from rocking_cli.ask.inputs import structure_of, structures_of
from rocking_cli.ask.verbs import verb
from rocking_cli.ask.watcher import Watcher
from rocking_cli.errors import InputError, Problem, RockingError, named
from rocking_cli.questions.explore.asked import ExploreAsked, options_of
from rocking_cli.views.view import heading

if TYPE_CHECKING:
    from rocking_cli.io.tables import Columns
    from rocking_cli.questions.explore.study import Exploration

MAX_STRUCTURES = 6  # as many as there are colours of curves


@verb(ExploreAsked)
def explore(asked: ExploreAsked, watch: Watcher) -> Answer[Exploration]:
    """Write a page on which structures and their ground motion can be changed, and which answers at once.

    Returns
    -------
    Answer of Exploration
        What the page offers; its attribute `file` is the page.

    Raises
    ------
    InputError
        If a value is out of range, a file cannot be read or written, or the page cannot follow a structure.
    MechanismError
        If a structure has no critical rotation or no uplift acceleration.
    SolverError
        If a motion cannot be simulated to its end.

    Notes
    -----
    The page runs the shipped kernels in the browser; its histories have the bits of those of `respond`.

    Examples
    --------
    >>> import rocking_cli as rk
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     answer = rk.explore(rk.Block(width=0.7, height=2.8), "sine:0.3g:0.9s", out=f"{folder}/block.html")
    >>> f"{answer.histories[0].peak_ratio:.4g}"
    '0.1315'
    """
    from rocking_cli.io.files import write_whole
    from rocking_cli.questions.explore.page import page
    from rocking_cli.questions.explore.study import Exploration, Varied, check
    from rocking_cli.questions.explore.view import view
    from rocking_cli.studies.engines import follow
    from rocking_cli.studies.picture import picture

    many: Any = asked.structures
    several = isinstance(many, list | tuple)
    if several and not 0 < len(many) <= MAX_STRUCTURES:
        raise InputError(Problem(f"takes 1 to {MAX_STRUCTURES} structures, got {len(many)}", field=named("structures")))
    given = structures_of(many, watch, asked.opening) if several else [structure_of(many, watch, asked.opening)]
    usable, refused = [], list[RockingError]()
    for each in given:
        try:
            check(each)
            usable.append(each)
        except RockingError as error:
            refused.append(error)
    if not usable:
        raise refused[0]
    for problem in refused:
        watch.leave_out(problem)
    varied = None
    if asked.vary is not None:
        if len(usable) > 1:
            what = f"varies a field of one structure, and {len(usable)} are given"
            raise InputError(Problem(what, field=named("vary"), hint="give one structure"))
        varied = Varied.of(usable[0], asked.vary)
    fastest = max(usable, key=lambda ready: ready.growth)
    (motion, *others) = asked.ground_motions.gather(fastest.growth, watch, fastest.name)
    if others:
        what = f"a page is for one motion, and {1 + len(others)} are given"
        raise InputError(Problem(what, field=named("motions"), hint="give one, or ask once for each motion"))
    (sign,), around = asked.signs, asked.neighbourhood(asked.neighbours)
    scaled = motion.motion.scaled(sign * motion.factor)
    histories = [follow(each, scaled) for each in usable]
    offered = Exploration(usable, motion, sign, around, histories, str(asked.out), options_of(asked, motion), varied)
    shown = view(offered)
    text = page(offered).encode()
    write_whole(asked.out, lambda stream: stream.write(text))
    watch.note(f"wrote {asked.out} ({len(text) / 1e6:.1f} MB)")
    figure = drawn("plotting.structure.draw_structure", picture(usable[0].mechanism), heading(usable[0].mechanism))
    return Answer("exploration", offered, shown, partial(_columns, offered), figure)


def _columns(offered: Exploration) -> Columns:
    return {
        "structure": [each.name for each in offered.structures],
        "peak_ratio": [each.peak_ratio for each in offered.histories],
        "overturned": [each.overturned for each in offered.histories],
        "unknown": [each.unknown for each in offered.histories],
    }
