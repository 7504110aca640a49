"""Choice of the engine for a structure, and engines of other packages, by the entry points `rocking.engines`."""

from __future__ import annotations

from collections.abc import Iterator, Sequence, Set
from functools import cache
from importlib.metadata import EntryPoint
from typing import get_args

from rocking_cli.dynamics.history import RTOL, TAIL, History
from rocking_cli.dynamics.model import MODELS, ModelName
from rocking_cli.engines.base import Engine, Knowledge
from rocking_cli.engines.exact import Exact
from rocking_cli.errors import InputError, MechanismError, Problem
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.plugins.errors import blame
from rocking_cli.plugins.registry import Plugins, origin
from rocking_cli.structure import Structure
from rocking_cli.text import did_you_mean

EXACT = Exact()


class Engines(Plugins[Engine]):
    """Engines of other packages by name. Listing names loads nothing; looking one up loads it.

    Raises
    ------
    InputError
        On looking up an unknown name.
    MechanismError
        On looking up a plugin that cannot be loaded, is no engine, or has a name that two packages claim.
    """

    group = "rocking.engines"
    kind = "engine"

    @staticmethod
    def accept(loaded: object, point: EntryPoint) -> Engine:
        """Return the loaded object if it is a complete engine with the name of its entry point."""
        if not (isinstance(loaded, type) and issubclass(loaded, Engine)):
            raise MechanismError(f"{origin(point)} is not an engine: it must be a class derived from Engine")
        faults = [f"method {method} is missing" for method in sorted(loaded.__abstractmethods__)]
        if getattr(loaded, "name", None) != point.name:
            faults.append(f"its class must have name = {point.name!r}")
        if point.name == EXACT.name:
            faults.append(f"the name {EXACT.name} is that of the engine of rocking-cli")
        if not (isinstance(loaded.knows, Set) and loaded.knows <= set(get_args(Knowledge))):
            faults.append(f"knows must be a set of {', '.join(map(repr, get_args(Knowledge)))}")
        if faults:
            raise MechanismError(f"{origin(point)} is not an engine: " + "; ".join(faults))
        with blame(f"{origin(point)} cannot be made", loaded.__module__):
            return loaded()


@cache
def engines() -> Engines:
    """Return the engines of other packages."""
    return Engines()


def engine(name: str) -> Engine:
    """Return the engine of a name, `"exact"` or one that is installed. Raises `InputError` if it does not exist."""
    if name != EXACT.name and name not in engines():
        raise InputError(f"unknown engine: {name} ({did_you_mean(name, [EXACT.name, *engines()])})")
    return EXACT if name == EXACT.name else engines()[name]


def engine_of(structure: Structure) -> Engine:
    """Return the engine that simulates a structure: the exact one, or else the first installed one that can.

    Raises
    ------
    InputError
        If all engines refuse the structure; the message has their reasons.
    """
    reasons = []
    for each in _in_order():
        why = each.refuses(structure)
        if why is None:
            return each
        reasons.append(f"{each.name}: {why}")
    raise InputError(Problem(f"no engine can simulate {structure.name} ({'; '.join(reasons)})", file=structure.file))


def _in_order() -> Iterator[Engine]:
    yield EXACT  # others are looked for only after it has refused
    for name in engines():
        yield engines()[name]


def default_models(structure: Structure) -> tuple[ModelName, ...]:
    """Return the models to simulate by default: the linear ones only if the engine has them and they do not mislead."""
    return structure.default_models if "linear models" in engine_of(structure).knows else ("nonlinear",)


def respond(
    structure: Structure,
    motion: GroundMotion | None = None,
    *,
    models: Sequence[ModelName] = MODELS,
    release: float | None = None,
    tail: float = TAIL,
    rtol: float = RTOL,
) -> dict[ModelName, History]:
    """Simulate models of a structure by its engine; other parameters and errors are those of `Engine.follow`.

    Parameters
    ----------
    models : sequence of {"nonlinear", "linear1", "linear2"}
        At least one model.

    Returns
    -------
    dict of str to History
        History of each model, in the order of `models`.
    """
    unknown = [name for name in models if name not in MODELS]
    if unknown or not models:
        raise InputError(f"models must be of {', '.join(MODELS)}, got {', '.join(unknown) or 'none'}")
    its = engine_of(structure)
    return {name: its.follow(structure, motion, model=name, release=release, tail=tail, rtol=rtol) for name in models}
