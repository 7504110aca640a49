"""Histories and models of a mechanism, by its structure."""

from rocking_cli.names import OPENING
from rocking_cli.structure import Structure
from rocking_cli.studies.neighbours import Conditions
from rocking_cli.studies.response import histories, of_one_degree

_recent: list[Structure] = []


def structure_of(mechanism, opening=OPENING):
    """Its structure, that of before if an equal one was asked for lately: its models are built once."""
    for each in _recent:
        if each.mechanism == mechanism and each.opening == opening:
            return each
    # With another opening its bounds are the same, which the mechanism keeps.
    known = next((each.mechanism for each in _recent if each.mechanism == mechanism), mechanism)
    _recent.append(Structure(known, opening=opening))
    del _recent[:-40]
    return _recent[-1]


def respond(mechanism, motion=None, opening=OPENING, **how):
    return of_one_degree(Conditions(structure_of(mechanism, opening), **how), motion)


def free(structure, motion, engine="blocks"):
    """The history of a structure as free blocks."""
    return histories(Conditions(structure, ("nonlinear",), engine=engine), motion)[0]["blocks"]


def conditions(mechanism, around=None, opening=OPENING, model="nonlinear", **how):
    more = {} if around is None else {"around": around}
    return Conditions(structure_of(mechanism, opening), (model,), **more, **how)


def build_model(mechanism, name, opening=OPENING):
    return structure_of(mechanism, opening).model(name)
