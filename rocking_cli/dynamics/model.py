"""What the history kernel needs to know of a structure: numbers for each direction, and tables if nonlinear."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from rocking_cli.core import Direction, Equivalence, Mechanism
from rocking_cli.dynamics.tables import tabulate
from rocking_cli.errors import InputError, Problem

Reals = NDArray[np.float64]
ModelName = Literal["nonlinear", "linear1", "linear2"]
MODELS: tuple[ModelName, ...] = ("nonlinear", "linear1", "linear2")

REST_RATE = 1e-6  # post-impact rate over p phi_cr below which a structure is at rest: it would rock to 5e-13 phi_cr


@dataclass(frozen=True)
class Model:
    """One equation of motion of a structure, ready for the kernel.

    Parameters
    ----------
    name : str
        `"nonlinear"`, or `"linear1"` and `"linear2"` for the equivalent block with kappa1 and kappa2.
    phi_cr : tuple of float
        Critical rotation in the positive and the negative direction [rad].
    numbers, cells, certain : ndarray
        See `rocking_cli.dynamics.kernels.follow`.
    """

    name: ModelName
    phi_cr: tuple[float, float]
    numbers: Reals
    cells: Reals
    certain: Reals

    @property
    def kind(self) -> int:
        """0 for the nonlinear equation, 1 for a linear one."""
        return 0 if self.name == "nonlinear" else 1  # NONLINEAR and LINEAR of the kernels, without importing numba


def build_model(mechanism: Mechanism, equivalence: Equivalence, name: ModelName) -> Model:
    """Prepare one model of a structure.

    Parameters
    ----------
    mechanism : Mechanism
        The structure.
    equivalence : Equivalence
        Its equivalent blocks.
    name : {"nonlinear", "linear1", "linear2"}
        Which equation of motion.

    Raises
    ------
    InputError
        If the restitution from kinematics is not positive, so that the motion after an impact is unknown.
    """
    for direction in Direction:
        eta = equivalence[direction].eta
        if eta <= 0:
            raise InputError(
                Problem(
                    f"{mechanism.name or 'structure'}: the kinematics give {eta:.4g} for an impact that ends motion in "
                    f"the {direction.label} direction: it is too stocky to start rocking the other way",
                    field="restitution",
                    hint="give a measured value as restitution, a number in (0, 1]",
                )
            )
    if name == "nonlinear":
        return _nonlinear(mechanism, equivalence)
    return _linear(equivalence, name, mechanism.gravity)


def _nonlinear(mechanism: Mechanism, equivalence: Equivalence) -> Model:
    tables = tabulate(mechanism)
    numbers = np.array(
        [
            _row(
                equivalence,
                direction,
                uplift=equivalence[direction].lambda_ * mechanism.gravity,
                rate=table.rest_rate,
                end=table.end,
                cell=table.cell,
                kappa_g=0.0,
                gravity=mechanism.gravity,
            )
            for direction, table in zip(Direction, tables, strict=True)
        ]
    )
    cells, certain = np.stack([table.cells for table in tables]), np.stack([table.certain for table in tables])
    return Model("nonlinear", _phi_cr(equivalence), numbers, cells, certain)


def _linear(equivalence: Equivalence, name: ModelName, gravity: float) -> Model:
    rows = []
    for direction in Direction:
        block = equivalence[direction]
        kappa = block.kappa1 if name == "linear1" else block.kappa2
        rows.append(
            _row(
                equivalence,
                direction,
                uplift=block.phi_cr / kappa * gravity,
                rate=1.0,
                end=np.inf,
                cell=1.0,
                kappa_g=kappa / gravity,
                gravity=gravity,
            )
        )
    return Model(name, _phi_cr(equivalence), np.array(rows), np.zeros((2, 1, 12)), np.zeros((2, 1)))


def _phi_cr(equivalence: Equivalence) -> tuple[float, float]:
    return equivalence.positive.phi_cr, equivalence.negative.phi_cr


def _row(
    equivalence: Equivalence,
    direction: Direction,
    *,
    uplift: float,
    rate: float,
    end: float,
    cell: float,
    kappa_g: float,
    gravity: float,
) -> list[float]:
    """One row of the kernel's `numbers`, in the order of its columns."""
    block = equivalence[direction]
    at_rest = REST_RATE * block.p * block.phi_cr / rate
    return [uplift, block.phi_cr, block.eta, rate, at_rest, end, cell, block.p, kappa_g, gravity]
