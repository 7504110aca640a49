"""The weakest mechanism that a structure of blocks has in each direction."""

from __future__ import annotations

from collections.abc import Mapping

from rocking_cli.core import CollapseMechanism, Direction, Mechanism
from rocking_cli.errors import InputError, MechanismError, Problem, of_structure


def collapses(mechanism: Mechanism) -> Mapping[Direction, CollapseMechanism]:
    """The weakest mechanism in each direction in which a structure can rock.

    Parameters
    ----------
    mechanism : Mechanism
        A structure that searches for its mechanism, such as an `assembly`.

    Raises
    ------
    InputError
        If its mechanism is given, so that there is none to find.
    MechanismError
        If it has none.
    """
    found: dict[Direction, CollapseMechanism] = {}
    for direction in mechanism.directions:
        try:
            each = mechanism.collapse(direction)
        except MechanismError as error:
            raise of_structure(error, mechanism.name or mechanism.mechanism) from error
        if each is None:
            hint = "`rocking new assembly` prints one; `rocking equiv` has the uplift of any structure"
            raise InputError(
                Problem(f"{mechanism.name} is not an assembly of blocks: its mechanism is given", hint=hint)
            )
        found[direction] = each
    return found
