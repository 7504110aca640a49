"""rocking-cli: rocking response of structures in earthquakes.

Public Python interface. Importing it is fast: each name is imported when it is first used.

Examples
--------
>>> import rocking_cli as rk
>>> block = rk.Block(width=1.0, height=4.0)
>>> round(rk.equivalent_block(block).positive.lambda_, 6)
0.25
>>> rk.respond(block, "sine:0.2g:0.8s")["nonlinear"].words
'does not uplift'
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

__version__ = "0.1.0"

# What is in which module. The stub beside this file, `__init__.pyi`, is written from it by `make stub`.
_HOME = {
    "questions.animate.verb": ["animate"],
    "ask.answer": ["Answer", "MappingAnswer"],
    "questions.design.verb": ["design"],
    "questions.equivalent.verb": ["equivalent"],
    "questions.fragility.verb": ["fragility"],
    "questions.margin.verb": ["margin", "shares"],
    "questions.overturning.verb": ["overturning", "overturning_curves", "overturning_map"],
    "questions.pulse.verb": ["pulse"],
    "questions.record.verb": ["record", "response_spectrum"],
    "questions.report.verb": ["report"],
    "questions.respond.verb": ["respond"],
    "questions.fragility.results": ["results"],
    "questions.spectrum.verb": ["spectrum"],
    "questions.respond.motions": ["correct", "on_floor", "respond_around", "respond_each"],
    "ask.several": ["Answers"],
    "questions.select.verb": ["select"],
    "questions.selfcheck.verb": ["selfcheck"],
    "questions.calibrate.verb": ["calibrate"],
    "questions.collapse.verb": ["collapse"],
    "questions.draw.verb": ["draw"],
    "questions.equiv.verb": ["equiv"],
    "questions.error.verb": ["error"],
    "questions.score.verb": ["score"],
    "questions.survey.verb": ["survey"],
    "questions.verify.verb": ["verify"],
    "core": ["Body", "Direction", "Equivalence", "EquivalentBlock", "Mechanism", "RigidMotion", "equivalent_block"],
    "core.registry": ["Registry"],
    "dynamics.batch": ["Runs", "respond_many"],
    "dynamics.exact": ["ExactResponse", "closed_form", "exact_pulse", "exact_response"],
    "dynamics.exact_batch": ["exact_many"],
    "dynamics.history": ["History"],
    "dynamics.model": ["Model"],
    "dynamics.outcome": ["Outcome"],
    "errors": ["DoubtWarning", "InputError", "MechanismError", "Problem", "RockingError", "SolverError"],
    "core.equivalence": ["NoEquivalentBlock"],
    "excitation.base": ["GroundMotion"],
    "excitation.measures": ["Measures", "measure"],
    "excitation.pulse_fit": ["PulseFit", "fit_pulse"],
    "excitation.pulses": ["Pulse", "parse_pulse"],
    "excitation.records": ["read_record"],
    "processing.reading": ["turned"],
    "processing.floor": ["Floor"],
    "processing.intensity": ["Measure", "MotionMeasure", "RelativeMeasure", "RunMeasure", "parse_measure"],
    "processing.oscillator": ["ResponseSpectrum"],
    "structure": ["build_models"],
    "core.structure_file": ["load_structure"],
}
_MODULES = {name: module for module, names in _HOME.items() for name in names}


def _own_mechanisms() -> dict[str, str]:
    """Return the mechanism classes that `rocking_cli` exports, each with the name of its mechanism.

    Mechanisms of other packages are in `mechanisms`, by name.
    """
    from rocking_cli.plugins.registry import entry_points

    own = [point for point in entry_points(group="rocking.mechanisms") if point.value.startswith("mechanisms.")]
    return {point.value.partition(":")[2]: point.name for point in own}


__all__ = sorted(["__version__", "mechanisms", *_MODULES])


def __getattr__(name: str) -> Any:
    if name in _MODULES:
        return getattr(import_module(f"{__name__}.{_MODULES[name]}"), name)
    if name == "mechanisms":
        from rocking_cli.core.registry import Registry

        return Registry()
    if name[:1].isupper() and name in (own := _own_mechanisms()):  # other names may be modules that are being imported
        return __getattr__("mechanisms")[own[name]]
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted([*__all__, *_own_mechanisms()])
