"""Base class of engines, which simulate the time histories of structures."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Set
from math import isfinite, isnan
from typing import Any, ClassVar, Literal

import numpy as np

from rocking_cli.dynamics.history import RTOL, TAIL, History, check_rtol
from rocking_cli.dynamics.model import MODELS, ModelName
from rocking_cli.errors import InputError, PluginError, Problem
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.plugins.errors import blame, failed, guard
from rocking_cli.structure import Structure

Knowledge = Literal["linear models", "releases", "vertical components", "joints"]


_failed = failed("engine", "name")


class Engine(ABC):
    """An engine simulates the time history of one structure under one ground motion.

    Batches are not simulated by engines: `respond_many`, and so neighbours, margins, maps, spectra, surveys and
    fragility studies, use the models and the compiled kernel of the exact engine alone.

    Attributes
    ----------
    name : str
        Name of the engine, and of its entry point in `rocking.engines`.
    knows : set of str
        What the engine covers beside nonlinear histories under a horizontal motion: `"linear models"`, `"releases"`
        from a tilt, `"vertical components"` of motions, and whether `"joints"` are checked. Requests for anything else
        are refused; without `"joints"` the results carry the caution that the joints are not checked.
    """

    name: ClassVar[str]
    knows: ClassVar[Set[Knowledge]] = frozenset()

    def __init_subclass__(cls, **named: Any) -> None:
        """Wrap the methods of a subclass, so that its failures are reported as errors of its package."""
        super().__init_subclass__(**named)
        guard(cls, ("refuses", "history"), _failed)

    @abstractmethod
    def refuses(self, structure: Structure) -> str | None:
        """Return why the engine cannot simulate a structure, as a clause without a full stop; None if it can."""

    @abstractmethod
    def history(
        self,
        structure: Structure,
        motion: GroundMotion | None,
        *,
        model: ModelName,
        release: float,
        tail: float,
        rtol: float,
    ) -> History:
        """Return the history that `follow` is to return, from its checked arguments.

        `release` is 0 if there is none. Raise `SolverError` if the motion cannot be simulated to its end.
        """

    def follow(
        self,
        structure: Structure,
        motion: GroundMotion | None = None,
        *,
        model: ModelName = "nonlinear",
        release: float | None = None,
        tail: float = TAIL,
        rtol: float = RTOL,
    ) -> History:
        """Simulate the motion of a structure under a ground motion, after a release from a tilt, or both.

        Parameters
        ----------
        structure : Structure
            The structure.
        motion : GroundMotion, optional
            Ground acceleration, linear between its samples and zero after the last. With its vertical component, g
            becomes g + v_g''.
        model : {"nonlinear", "linear1", "linear2"}
            Equation of motion.
        release : float, optional
            Start at rest from this fraction of phi_cr, between -1 and 1; negative in the negative direction.
        tail : float
            Time after the record for which samples are kept [s]. The motion is always simulated to its end.
        rtol : float
            Relative local error of a step of the nonlinear motion.

        Returns
        -------
        History
            Outcome of the motion, with its peaks, impacts and samples.

        Raises
        ------
        InputError
            If there is neither a motion nor a release, a value is out of range, or the engine refuses the structure or
            does not cover the request.
        SolverError
            If the motion cannot be simulated to its end.
        PluginError
            If an engine of another package fails, or returns no valid history.
        """
        _check(structure, motion, model, release, tail, rtol)
        if (why := self.refuses(structure)) is not None:
            reason = f"the engine {self.name} cannot simulate {structure.name}: {why}"
            raise InputError(Problem(reason, file=structure.file))
        needed: dict[Knowledge, bool] = {
            "linear models": model != "nonlinear",
            "releases": release is not None,
            "vertical components": motion is not None and motion.vertical is not None,
        }
        if lacking := [what for what, is_needed in needed.items() if is_needed and what not in self.knows]:
            raise InputError(f"the engine {self.name} does not simulate {' or '.join(lacking)}")
        found = self.history(structure, motion, model=model, release=release or 0.0, tail=tail, rtol=rtol)
        with blame(_failed(type(self), "history"), type(self).__module__):
            if fault := _fault(found, model, checks_joints="joints" in self.knows):
                raise PluginError(f"{_failed(type(self), 'history')}: {fault}")
        return found


def _check(
    structure: object, motion: object, model: ModelName, release: float | None, tail: float, rtol: float
) -> None:  # fmt: skip
    """Raise `InputError` if an argument is of the wrong type or out of range."""
    if not isinstance(structure, Structure):
        raise InputError(f"structure must be a Structure of rocking_cli.engines, got {type(structure).__name__}")
    if not isinstance(motion, GroundMotion | None):
        raise InputError(f"motion must be a GroundMotion, got {type(motion).__name__}")
    if model not in MODELS:
        raise InputError(f"model must be one of {', '.join(MODELS)}, got {model!r}")
    if motion is None and release is None:
        raise InputError("nothing to respond to: give a ground motion, a release, or both")
    if release is not None and not 0 < abs(release) < 1:
        raise InputError(f"release must be a fraction of phi_cr between 0 and 1 (or 0 and -1), got {release:g}")
    if release is not None and not (way := structure.mechanism).rocks_both_ways and release * way.directions[0] < 0:
        supports = "release is against the supports that it leans on"
        raise InputError(f"{supports}: it rocks in the {way.one_sided} direction only")
    if not (isfinite(tail) and tail >= 0):
        raise InputError(f"tail must be a time in seconds, 0 or more, got {tail:g}")
    check_rtol(rtol)


def _fault(found: object, model: ModelName, *, checks_joints: bool) -> str:
    """Return why the result of an engine is not a valid history; empty if it is one."""
    if not isinstance(found, History):
        return f"it must return a History, got {type(found).__name__}"
    if found.model != model:
        return f"it must return a history of the model {model}, got {found.model}"
    if any(each.shape != found.time.shape for each in (found.phi, found.rate, found.ratio)):
        return "time, phi, rate and ratio of its history differ in length"
    if found.impacts.shape[1:] != (3,):
        return f"impacts must have the shape (k, 3), got {found.impacts.shape}"
    if not (np.diff(found.time) > 0).all():
        return "the times of its history do not increase"
    if found.fell_to not in (-1, 0, 1):
        return f"fell_to of its history must be 1, -1 or 0, got {found.fell_to}"
    for side, peak in ((1, found.peak_positive), (-1, found.peak_negative)):
        if not peak >= 0 and side != found.fell_to:
            return f"a peak of its history must be at least 0, got {peak:g}"
    if found.impact_count < len(found.impacts):
        return f"its history has {len(found.impacts)} impacts, but impact_count is {found.impact_count}"
    if not checks_joints and not isnan(found.opening):
        return "its history has an opening of joints, but `joints` is not in what it knows"
    return ""
