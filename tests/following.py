"""Histories and models of a mechanism, by its structure."""

from rocking_cli import engines
from rocking_cli.structure import Structure

_recent: list[Structure] = []


def structure_of(mechanism):
    """Its structure, that of before if it was asked for lately: whoever follows it often builds its models once."""
    for each in _recent:
        if each.mechanism is mechanism:
            return each
    _recent.append(Structure(mechanism))
    del _recent[:-40]
    return _recent[-1]


def respond(mechanism, motion=None, **how):
    return engines.respond(structure_of(mechanism), motion, **how)


def build_model(mechanism, name):
    return structure_of(mechanism).model(name)
