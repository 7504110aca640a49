"""Histories and models of a mechanism, by its structure."""

from rocking_cli.names import OPENING
from rocking_cli.structure import Structure
from rocking_cli.studies.neighbours import Conditions
from rocking_cli.studies.response import histories, of_one_degree

_recent: list[tuple[object, Structure]] = []


def structure_of(mechanism, opening=OPENING):
    """Its structure, that of before if an equal one was asked for lately: its models are built once."""
    contacts = type(mechanism).contacts  # which some tests replace
    known = [each for given, each in _recent if given is contacts and each.mechanism == mechanism]
    for each in known:
        if each.opening == opening:
            return each
    # With another opening its bounds are the same, which the mechanism keeps.
    made = Structure(known[0].mechanism if known else mechanism, opening=opening)
    _recent.append((contacts, made))
    del _recent[:-40]
    return made


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
