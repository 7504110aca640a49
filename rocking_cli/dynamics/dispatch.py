"""Models of a structure, each with the kernel that simulates it; only this module chooses kernels."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import isnan
from typing import Any

from rocking_cli.core import Equivalence, Mechanism, both_statics
from rocking_cli.core.restitution import why_none
from rocking_cli.core.statics import Statics
from rocking_cli.dynamics.deck import lay_out, run_deck
from rocking_cli.dynamics.model import Model, ModelName, completed, linear_model, nonlinear_model, with_held
from rocking_cli.errors import InputError, Problem

NEEDS = {"has_memory": "its past deformation (memory)", "has_rate": "its rate of deformation"}
"""What the force of an element may depend on besides the rotation, by the attribute that states it."""


@dataclass(frozen=True)
class Kernel:
    """A way to simulate nonlinear models.

    Parameters
    ----------
    name : str
        Name of the kernel, by which models refer to it.
    meets : frozenset of str
        Keys of `NEEDS` that elements may have: the kernel simulates a structure if its elements have no other needs.
    model : callable
        Builds the nonlinear model of a structure, as `nonlinear_model` does.
    lay_out : callable
        Lays out models and ground motions, as `rocking_cli.dynamics.deck.lay_out` does.
    run : callable
        Runs histories of the laid-out models and motions, as `rocking_cli.dynamics.deck.run_deck` does, with the same
        columns of `runs` and `marks`.
    """

    name: str
    meets: frozenset[str]
    model: Callable[..., Model]
    lay_out: Callable[..., Any]
    run: Callable[..., None]


ELASTIC = Kernel("elastic", frozenset(), nonlinear_model, lay_out, run_deck)
KERNELS = {ELASTIC.name: ELASTIC}
"""The kernels by name, in the order in which they are tried."""


def register(kernel: Kernel) -> None:
    """Add a kernel, which is tried after the others."""
    KERNELS[kernel.name] = kernel


def kernel_for(mechanism: Mechanism) -> Kernel:
    """Return the first kernel that can simulate all elements of a structure.

    Raises `InputError`, with the names of the elements, if there is none.
    """
    needs = [(each, need) for each in mechanism.hung.elements for need in NEEDS if getattr(each, need)]
    for kernel in KERNELS.values():
        if kernel.meets.issuperset(need for _, need in needs):
            return kernel
    of, why = mechanism.name or mechanism.mechanism, "which no time-history kernel can simulate in this structure"
    raise InputError(*[
        Problem(f"{each.name} of {of}: its force depends on {NEEDS[need]}, {why}: use an elastic element instead")
        for each, need in needs
    ])  # fmt: skip


NO_REBOUND = Problem(
    "is missing: a time history of a one-sided structure needs it, and only for a plain rectangle does it follow from "
    "the shape",
    field="rebound",
    hint="give a measured value as rebound, a number in [0, 1)",
)


def build(
    mechanism: Mechanism, statics: tuple[Statics, Statics], equivalence: Equivalence | None, name: ModelName
) -> Model:
    """Build one model of a structure.

    Parameters
    ----------
    mechanism : Mechanism
        The structure.
    statics : tuple of Statics
        Statics of both directions.
    equivalence : Equivalence or None
        Equivalent blocks, which the linear models require.
    name : {"nonlinear", "linear1", "linear2"}
        Equation of motion.

    Raises
    ------
    InputError
        If the restitution from kinematics is not positive, or the rebound of a one-sided structure is not known, so
        that the motion after an impact is unknown; if no kernel simulates the elements of the structure, or one of them
        has no linear model.
    """
    etas = mechanism.eta(mechanism.sides[0]), mechanism.eta(mechanism.sides[1])
    if isnan(etas[0]):
        raise InputError(NO_REBOUND)
    for direction, eta in zip(mechanism.sides, etas, strict=True):
        if eta <= 0 and mechanism.rocks_both_ways:
            raise InputError(
                Problem(
                    f"{mechanism.name or 'structure'}: the kinematics give {eta:.4g} for an impact that ends "
                    f"motion in the {direction.label} direction: {why_none(eta)}",
                    field="restitution",
                    hint="give a measured value as restitution, a number in (0, 1]",
                )
            )
    if name == "nonlinear":
        kernel = kernel_for(mechanism)
        columns = [build(each, both_statics(each), None, name) for each in mechanism.columns_alone()]
        model = replace(kernel.model(mechanism, statics, etas), kernel=kernel.name, columns=tuple(columns))
    else:
        mechanism.hung.ask("linear models")
        assert equivalence is not None
        blocks = equivalence.positive, equivalence.negative
        model = linear_model(mechanism.name or mechanism.mechanism, name, blocks, mechanism.gravity)
        if mechanism.attached:
            model = with_held(model, mechanism, blocks)
    return completed(model, mechanism)
