"""Histories and models of a mechanism, by its structure."""

from rocking_cli import engines
from rocking_cli.structure import Structure


def respond(mechanism, motion=None, **how):
    return engines.respond(Structure(mechanism), motion, **how)


def build_model(mechanism, name):
    return Structure(mechanism).model(name)
