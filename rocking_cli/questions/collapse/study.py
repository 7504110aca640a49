"""The weakest mechanism that a structure of blocks has in each direction."""

from __future__ import annotations

from collections.abc import Mapping

from rocking_cli.core import CollapseMechanism, Direction, Mechanism
from rocking_cli.errors import InputError, MechanismError, Problem, of_structure


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
