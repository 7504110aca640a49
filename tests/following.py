"""Histories of a mechanism, by the engine of its structure."""

from rocking_cli import engines
from rocking_cli.structure import Structure


def respond(mechanism, motion=None, **how):
    return engines.respond(Structure(mechanism), motion, **how)
