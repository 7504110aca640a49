"""`rk.collapse`: find the weakest mechanisms of an assembly of blocks."""

from __future__ import annotations

from functools import partial

from rocking_cli.ask.answer import MappingAnswer
from rocking_cli.ask.given import StructureLike, structure_figure, structure_of
from rocking_cli.ask.numbers import takes_numbers
from rocking_cli.ask.watcher import SILENT, Watcher
from rocking_cli.core import CollapseMechanism, Direction


@takes_numbers
def collapse(structure: StructureLike, *, watch: Watcher = SILENT) -> MappingAnswer[Direction, CollapseMechanism]:
    """Find the weakest mechanism of an assembly of rigid blocks in each direction, by limit analysis.

    Parameters
    ----------
    structure : Mechanism, str or Path
        Assembly, or its YAML file.
    watch : Watcher
        Told what is doubtful about the structure.

    Returns
    -------
    MappingAnswer of Direction to CollapseMechanism
        lambda, hinges, groups of blocks that move as one, a line of thrust, friction required, and rotation up to which
        the mechanism is valid.

    Raises
    ------
    InputError
        If the structure is not an assembly, or its file cannot be used.
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
    from rocking_cli.questions.collapse.study import collapses
    from rocking_cli.questions.collapse.view import table, view

    mechanism = structure_of(structure, watch).mechanism
    mechanisms = collapses(mechanism)

    columns, figure = partial(table, mechanisms), partial(structure_figure, mechanism, mechanisms)
    return MappingAnswer("weakest mechanism", mechanisms, view(mechanism, mechanisms), columns, figure)
