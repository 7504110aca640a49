"""What the history kernel needs to know of a structure: numbers and tables for each direction."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from rocking_cli.core import (
    Direction,
    Equivalence,
    EquivalentBlock,
    Mechanism,
    equivalent_block,
    greatest_restitution,
)
from rocking_cli.core.advice import uplift_error
from rocking_cli.core.restitution import why_none
from rocking_cli.dynamics.tables import Table, tabulate
from rocking_cli.errors import InputError, Problem

Reals = NDArray[np.float64]
ModelName = Literal["nonlinear", "linear1", "linear2"]
MODELS: tuple[ModelName, ...] = ("nonlinear", "linear1", "linear2")

FALLEN = 1e6  # rad: no acceleration turns a linear block back from there; without weight one might, beyond all meaning
ALIKE = 1e-9  # of the largest: tables of two directions that differ by rounding alone
REST_RATE = 1e-6  # post-impact rate over p phi_cr below which a structure is at rest: it would rock to 5e-13 phi_cr


@dataclass(frozen=True, eq=False)
class Model:
    """One equation of motion of a structure, ready for the kernel, which takes any number of them at once.

    Parameters
    ----------
    name : str
        `"nonlinear"`, or `"linear1"` and `"linear2"` for the equivalent block with kappa1 and kappa2.
    structure : str
        What to call the structure.
    phi_cr : tuple of float
        Critical rotation in the positive and the negative direction [rad].
    numbers, forces, angles, certain : ndarray
        See `rocking_cli.dynamics.kernels.run`.
    tables : tuple of Table, optional
        What the arrays are made of, if nonlinear.
    uplift_error : float
        By how much its uplift acceleration is off that of the structure, relative, in the worse direction.
    most_eta : tuple of float
        The restitution with which an impact that ends motion in the positive and in the negative direction keeps all
        energy; 1 for a symmetric structure.
    """

    name: ModelName
    structure: str
    phi_cr: tuple[float, float]
    numbers: Reals
    forces: Reals
    angles: Reals
    certain: Reals
    tables: tuple[Table, Table] | None = None
    uplift_error: float = 0.0
    most_eta: tuple[float, float] = (1.0, 1.0)

    @property
    def p(self) -> float:
        """Frequency parameter [rad/s], of two different directions the larger."""
        return float(self.numbers[:, 7].max())

    @property
    def gravity(self) -> float:
        """Acceleration of gravity [m/s2]."""
        return float(self.numbers[0, -1])

    @property
    def lambda_(self) -> tuple[float, float]:
        """Uplift acceleration over g in the positive and the negative direction."""
        return float(self.numbers[0, 0]), float(self.numbers[1, 0])

    @property
    def eta(self) -> tuple[float, float]:
        """Restitution of impacts that end motion in the positive and in the negative direction."""
        return float(self.numbers[0, 2]), float(self.numbers[1, 2])

    @property
    def is_linear(self) -> bool:
        """Whether this is an equivalent block."""
        return self.tables is None

    @cached_property
    def symmetric(self) -> bool:
        """Whether both directions are alike, so that a reversed motion does the same."""
        pairs = ((self.numbers[0], self.numbers[1]), *((of[:, 0], of[:, 1]) for of in (self.forces, self.certain)))
        return all(np.allclose(one, other, rtol=0, atol=ALIKE * np.abs(one).max()) for one, other in pairs)

    def q(self, ratio: float) -> float:
        """The kernel's coordinate at a signed rotation given as a fraction of its direction's phi_cr."""
        side = 1 if ratio < 0 else 0
        phi = abs(ratio) * self.phi_cr[side]
        return float(np.copysign(phi if self.tables is None else self.tables[side].q(phi), ratio))


def build_model(mechanism: Mechanism, name: ModelName) -> Model:
    """Prepare one model of a structure.

    Parameters
    ----------
    mechanism : Mechanism
        The structure.
    name : {"nonlinear", "linear1", "linear2"}
        Which equation of motion.

    Raises
    ------
    InputError
        If the restitution from kinematics is not positive, so that the motion after an impact is unknown.
    """
    return build_models(mechanism, (name,))[0]


def build_models(mechanism: Mechanism, names: tuple[ModelName, ...] = MODELS) -> list[Model]:
    """Prepare several models of a structure; see `build_model`."""
    equivalence = equivalent_block(mechanism)
    return [build(mechanism, equivalence, name) for name in names]


def build(mechanism: Mechanism, equivalence: Equivalence, name: ModelName) -> Model:
    """Prepare one model of a structure whose equivalent blocks are known; see `build_model`."""
    label = mechanism.name or mechanism.mechanism
    blocks = (equivalence.positive, equivalence.negative)
    for direction, block in zip(Direction, blocks, strict=True):
        if block.eta <= 0:
            raise InputError(
                Problem(
                    f"{mechanism.name or 'structure'}: the kinematics give {block.eta:.4g} for an impact that ends "
                    f"motion in the {direction.label} direction: {why_none(block.eta)}",
                    field="restitution",
                    hint="give a measured value as restitution, a number in (0, 1]",
                )
            )
    if name == "nonlinear":
        model = _nonlinear(label, mechanism, blocks)
    else:
        model = linear_model(label, name, blocks, mechanism.gravity)
    most_eta = greatest_restitution(mechanism, Direction.POSITIVE), greatest_restitution(mechanism, Direction.NEGATIVE)
    return replace(model, most_eta=most_eta)


def _nonlinear(label: str, mechanism: Mechanism, blocks: tuple[EquivalentBlock, EquivalentBlock]) -> Model:
    tables = tabulate(mechanism)
    numbers = [
        [
            block.lambda_,
            table.q(block.phi_cr),
            block.eta,
            table.rest_rate,
            REST_RATE * block.p * block.phi_cr / table.rest_rate,
            table.end,
            1 / table.cell,
            block.p,
            0.0,  # linear models only
            mechanism.gravity,
        ]
        for block, table in zip(blocks, tables, strict=True)
    ]
    forces, angles, certain = (
        np.stack([getattr(table, part) for table in tables], axis=1) for part in ("forces", "angles", "certain")
    )
    phi_cr = blocks[0].phi_cr, blocks[1].phi_cr
    return Model("nonlinear", label, phi_cr, np.array(numbers), forces, angles, certain, tables=tables)


def linear_model(label: str, name: ModelName, blocks: tuple[EquivalentBlock, EquivalentBlock], gravity: float) -> Model:
    """Prepare equivalent blocks.

    Parameters
    ----------
    label : str
        What to call the structure.
    name : {"linear1", "linear2"}
        Which kappa.
    blocks : tuple of EquivalentBlock
        Of the positive and the negative direction.
    gravity : float
        [m/s2].
    """
    # q = phi here; one cell holds the straight line and the constant that are all of its forces.
    numbers, forces = [], np.zeros((1, 2, 8))
    for d, block in enumerate(blocks):
        kappa = block.kappa1 if name == "linear1" else block.kappa2
        numbers.append(
            [
                block.phi_cr / kappa,
                block.phi_cr,
                block.eta,
                1.0,
                REST_RATE * block.p * block.phi_cr,
                FALLEN,
                1.0,
                block.p,
                kappa / gravity,
                gravity,
            ]
        )
        stiffness = block.p**2 / gravity
        forces[0, d, [0, 1, 4]] = stiffness * block.phi_cr, -stiffness, stiffness * kappa  # Eq. 12
    angles = np.tile([0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0], (1, 2, 1))
    phi_cr = blocks[0].phi_cr, blocks[1].phi_cr
    error = uplift_error(Equivalence(*blocks)) if name == "linear1" else 0.0
    return Model(name, label, phi_cr, np.array(numbers), forces, angles, np.zeros((1, 2)), uplift_error=error)
