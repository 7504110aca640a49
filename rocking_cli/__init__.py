"""rocking-cli: rocking response of structures in earthquakes.

Public Python interface. Importing it is fast: each name is imported when it is first used.

Examples
--------
>>> import rocking_cli as rk
>>> block = rk.Block(width=1.0, height=4.0)
>>> round(rk.equiv(block).positive.lambda_, 6)
0.25
>>> rk.respond(block, "sine:0.2g:0.8s")["nonlinear"].words
'does not uplift'
"""

from __future__ import annotations

import sys
from importlib import import_module
from typing import Any

__version__ = "0.2.0"

# Names that other modules define, by module; `rooms` finds those of the questions. The stub beside this file,
# `__init__.pyi`, is written from both by `make pages`.
_HOME = {
    "ask.answer": ["Answer", "Answers", "MappingAnswer"],
    "ask.read": ["read_record"],
    "core": ["Body", "Direction", "Equivalence", "EquivalentBlock", "Mechanism", "RigidMotion"],
    "core.registry": ["Registry"],
    "dynamics.exact": ["ExactResponse", "closed_form"],
    "dynamics.history": ["History"],
    "dynamics.outcome": ["Outcome"],
    "errors": ["DoubtWarning", "InputError", "MechanismError", "Problem", "RockingError", "SolverError"],
    "core.equivalence": ["NoEquivalentBlock"],
    "excitation.base": ["GroundMotion"],
    "excitation.measures": ["Measures", "measure"],
    "excitation.pulse_fit": ["PulseFit", "fit_pulse"],
    "excitation.pulses": ["Pulse", "parse_pulse"],
    "processing.reading": ["turned"],
    "processing.intensity": ["Measure", "MotionMeasure", "RelativeMeasure", "RunMeasure", "parse_measure"],
    "processing.oscillator": ["Floor", "ResponseSpectrum"],
    "core.structure_file": ["load_structure"],
}
_MODULES = {name: module for module, names in _HOME.items() for name in names}
_MOVED = {
    "Model": "rocking_cli.dynamics.model.Model",
    "Runs": "rk.respond_each, or rocking_cli.dynamics.batch.Runs",
    "crosscheck": 'rk.respond with engine="blocks"',
    "build_models": "rk.respond, or rocking_cli.structure.build_models",
    "equivalent": "rk.equivalent_pulses",
    "equivalent_block": "rk.equiv, or rocking_cli.core.equivalent_block",
    "exact_many": "rk.overturning_map, or rocking_cli.dynamics.exact_batch.exact_many",
    "exact_pulse": "rk.pulse, or rocking_cli.dynamics.exact.exact_pulse",
    "exact_response": "rk.pulse, or rocking_cli.dynamics.exact.exact_response",
    "respond_many": "rk.respond_each, or rocking_cli.dynamics.batch.respond_many",
    "score": "validation.score.score, in a checkout of the sources",
}
"""Names that are gone from here, each with what to use."""


def _own_mechanisms() -> dict[str, str]:
    """Return the mechanism classes that `rocking_cli` exports, each with the name of its mechanism.

    Mechanisms of other packages are in `mechanisms`, by name.
    """
    from rocking_cli.plugins.registry import entry_points

    points = [point for point in entry_points(group="rocking.mechanisms") if point.value.startswith("mechanisms.")]
    return {point.value.partition(":")[2]: point.name for point in points}


def __getattr__(name: str) -> Any:
    if name in _MODULES:
        return getattr(import_module(f"{__name__}.{_MODULES[name]}"), name)
    from rocking_cli.plugins.rooms import names  # imported here, as most uses do not need it

    if name == "__all__":
        return sorted(["__version__", "mechanisms", *_MODULES, *names()])
    if name in names():
        return getattr(import_module(names()[name]), name)
    if name == "mechanisms":
        from rocking_cli.core.registry import Registry

        return Registry()
    if name[:1].isupper() and name in (
        classes := _own_mechanisms()
    ):  # other names may be modules that are being imported
        return __getattr__("mechanisms")[classes[name]]
    if name in _MOVED:
        # `from rocking_cli import name` asks from this module first, and drops the words of an AttributeError.
        imported = sys._getframe(1).f_globals.get("__name__") == "importlib._bootstrap"
        raise (ImportError if imported else AttributeError)(f"{__name__} has no {name}: use {_MOVED[name]}")
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted([*__getattr__("__all__"), *_own_mechanisms()])
