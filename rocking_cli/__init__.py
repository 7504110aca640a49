"""rocking-cli: rocking structures under earthquakes.

The public Python API. Importing it loads nothing heavy: each name is fetched when it is first used.

Examples
--------
>>> from rocking_cli import Registry, equivalent_block
>>> block = Registry()["block"](width=1.0, height=4.0)
>>> round(equivalent_block(block).positive.lambda_, 6)
0.25
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rocking_cli.core import Body as Body
    from rocking_cli.core import Direction as Direction
    from rocking_cli.core import Equivalence as Equivalence
    from rocking_cli.core import EquivalentBlock as EquivalentBlock
    from rocking_cli.core import Mechanism as Mechanism
    from rocking_cli.core import RigidMotion as RigidMotion
    from rocking_cli.core import equivalent_block as equivalent_block
    from rocking_cli.core.registry import Registry as Registry
    from rocking_cli.dynamics.batch import Runs as Runs
    from rocking_cli.dynamics.batch import respond_many as respond_many
    from rocking_cli.dynamics.exact import ExactResponse as ExactResponse
    from rocking_cli.dynamics.exact import exact_response as exact_response
    from rocking_cli.dynamics.exact_batch import exact_many as exact_many
    from rocking_cli.dynamics.history import History as History
    from rocking_cli.dynamics.history import respond as respond
    from rocking_cli.dynamics.model import Model as Model
    from rocking_cli.dynamics.model import build_models as build_models
    from rocking_cli.dynamics.outcome import Outcome as Outcome
    from rocking_cli.dynamics.pulse_response import closed_form as closed_form
    from rocking_cli.dynamics.pulse_response import exact_pulse as exact_pulse
    from rocking_cli.errors import InputError as InputError
    from rocking_cli.errors import MechanismError as MechanismError
    from rocking_cli.errors import Problem as Problem
    from rocking_cli.errors import RockingError as RockingError
    from rocking_cli.errors import SolverError as SolverError
    from rocking_cli.excitation.base import GroundMotion as GroundMotion
    from rocking_cli.excitation.measures import Measures as Measures
    from rocking_cli.excitation.measures import measure as measure
    from rocking_cli.excitation.pulse_fit import PulseFit as PulseFit
    from rocking_cli.excitation.pulse_fit import fit_pulse as fit_pulse
    from rocking_cli.excitation.pulses import Pulse as Pulse
    from rocking_cli.excitation.pulses import parse_pulse as parse_pulse
    from rocking_cli.excitation.records import read_record as read_record
    from rocking_cli.structure import load_structure as load_structure

__version__ = "0.1.0"

_HOME = {
    "core": ["Body", "Direction", "Equivalence", "EquivalentBlock", "Mechanism", "RigidMotion", "equivalent_block"],
    "dynamics.batch": ["Runs", "respond_many"],
    "dynamics.exact": ["ExactResponse", "exact_response"],
    "dynamics.exact_batch": ["exact_many"],
    "dynamics.history": ["History", "respond"],
    "dynamics.model": ["Model", "build_models"],
    "dynamics.outcome": ["Outcome"],
    "dynamics.pulse_response": ["closed_form", "exact_pulse"],
    "errors": ["InputError", "MechanismError", "Problem", "RockingError", "SolverError"],
    "excitation.base": ["GroundMotion"],
    "excitation.measures": ["Measures", "measure"],
    "excitation.pulse_fit": ["PulseFit", "fit_pulse"],
    "excitation.pulses": ["Pulse", "parse_pulse"],
    "excitation.records": ["read_record"],
    "core.registry": ["Registry"],
    "structure": ["load_structure"],
}
_MODULES = {name: module for module, names in _HOME.items() for name in names}

__all__ = sorted(["__version__", *_MODULES])


def __getattr__(name: str) -> Any:
    if name not in _MODULES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_MODULES[name]}"), name)


def __dir__() -> list[str]:
    return __all__
