"""`rk.collapse`: find the weakest mechanisms of an assembly of blocks."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from pathlib import Path

from rocking_cli.ask.answer import MappingAnswer
from rocking_cli.ask.inputs import structure_figure, structure_of
from rocking_cli.ask.verbs import verb
from rocking_cli.ask.watcher import Watcher
from rocking_cli.core import CollapseMechanism, Direction, Mechanism
from rocking_cli.errors import InputError, MechanismError, Problem, RockingError, of_structure
from rocking_cli.questions.collapse.asked import CollapseAsked


@verb(CollapseAsked)
def collapse(asked: CollapseAsked, watch: Watcher) -> MappingAnswer[Direction, CollapseMechanism]:
    """Find the weakest mechanism of an assembly of rigid blocks in each direction, by limit analysis.

    Returns
    -------
    MappingAnswer of Direction to CollapseMechanism
        lambda, hinges, groups of blocks that move as one, a line of thrust, friction required, and rotation up to which
        the mechanism is valid.

    Raises
    ------
    InputError
        If the structure is not an assembly, or its file cannot be used; if `out` cannot be written, also because one of
        the mechanisms has no rocking model.
    MechanismError
        If the assembly has no mechanism.

    Examples
    --------
    A block of 1 m x 4 m on the ground:

    >>> import rocking_cli as rk
    >>> block = {"polygon": [[0.0, 0.0], [1.0, 0.0], [1.0, 4.0], [0.0, 4.0]]}
    >>> ground = {"polygon": [[-1.0, -1.0], [2.0, -1.0], [2.0, 0.0], [-1.0, 0.0]]}
    >>> answer = rk.collapse(rk.Assembly(blocks={"block": block}, ground={"ground": ground}))
    >>> round(answer[rk.Direction.POSITIVE].lambda_, 12)
    0.25
    """
    from rocking_cli.questions.collapse.view import table, view

    mechanism = structure_of(asked.structure, watch).mechanism
    mechanisms = collapses(mechanism)
    if asked.out is not None:
        try:
            _write(mechanism, asked.out)
            watch.note(f"wrote {asked.out}")
        except RockingError as error:
            watch.unwritten(error)

    columns, figure = partial(table, mechanisms), partial(structure_figure, mechanism, mechanisms)
    return MappingAnswer("weakest mechanism", mechanisms, view(mechanism, mechanisms), columns, figure)


def collapses(mechanism: Mechanism) -> Mapping[Direction, CollapseMechanism]:
    """Return the weakest mechanism of a structure in each direction in which it can rock.

    Parameters
    ----------
    mechanism : Mechanism
        A structure that searches for its mechanism, such as an `assembly`.

    Raises
    ------
    InputError
        If the mechanism of the structure is given, so that none is searched for.
    MechanismError
        If the structure has no mechanism in any direction.
    """
    mechanisms: dict[Direction, CollapseMechanism] = {}
    for direction in mechanism.directions:
        try:
            weakest = mechanism.collapse(direction)
        except MechanismError as error:
            raise of_structure(error, mechanism.name or mechanism.mechanism) from error
        if weakest is None:
            hint = "`rocking new assembly` prints one; `rocking equiv` has the uplift of any structure"
            raise InputError(
                Problem(f"{mechanism.name} is not an assembly of blocks: its mechanism is given", hint=hint)
            )
        mechanisms[direction] = weakest
    return mechanisms


def _write(mechanism: Mechanism, out: Path) -> None:
    """Write the weakest mechanism as a linkage. Raises `RockingError` if it is not one, or cannot be written."""
    from rocking_cli.core.structure_file import structure_text
    from rocking_cli.io.files import write_whole

    try:
        linkage = mechanism.as_linkage()
    except RockingError as error:
        raise InputError(Problem(f"cannot be written: {error}", str(out))) from error
    if linkage is None:
        raise InputError(Problem(f"cannot be written: {mechanism.mechanism} does not give its linkage", str(out)))
    name = mechanism.name or mechanism.mechanism
    comment = f"Weakest mechanism of {name}, by `rocking collapse`. Bodies that are `fixed` stay in contact."
    text = structure_text(linkage, comment)
    write_whole(out, lambda file: file.write(text.encode("utf-8")))
