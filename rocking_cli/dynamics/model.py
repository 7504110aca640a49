"""Models of a structure: the numbers and tables of each direction that the kernel needs."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from math import inf, isnan, nan, sqrt
from typing import Literal, NamedTuple

import numpy as np

from rocking_cli.arrays import Integers, Reals
from rocking_cli.core import Direction, Equivalence, EquivalentBlock, Mechanism, both_statics
from rocking_cli.core.bounds import Bound
from rocking_cli.core.equivalence import Statics, uplift_error
from rocking_cli.core.mechanism import why_none
from rocking_cli.core.structure_fields import Uncertainty
from rocking_cli.dynamics.joints import JointTables, joints_of
from rocking_cli.dynamics.sliding import Sliding, sliding_of
from rocking_cli.dynamics.stepping import (  # fmt: skip
    BOUND_ETA,
    BOUNDED,
    BOW,
    COLUMNS,
    ETA,
    FASTEST,
    GRAVITY,
    HELD,
    KAPPA_G,
    LAMBDA,
    ONE_SIDED,
    PAIRS,
    PER_CELL,
    PER_REACH,
    Q_BOUND,
    Q_CR,
    Q_END,
    RATE,
    REST,
    P,
)
from rocking_cli.dynamics.tables import MOST_PAIRS, DirectionTable, polynomials, tabulate
from rocking_cli.errors import InputError, Problem
from rocking_cli.names import OPENING
from rocking_cli.short_repr import short_repr

ModelName = Literal["nonlinear", "linear1", "linear2", "blocks"]
MODELS: tuple[ModelName, ...] = ("nonlinear", "linear1", "linear2")

FALLEN_ROTATION = 1e6  # rad: no realistic acceleration turns a linear block back from there
EQUAL_TABLES = 1e-9  # difference of the tables of two directions by rounding, over the largest value
KINEMATIC_SPREAD, MEASURED_SPREAD = 0.05, 0.03  # standard deviation of a restitution from the shape, and of a given one
SLENDERNESS_SPREAD = 0.10  # standard deviation of ln slenderness
REACH = 1.3  # q up to which forces are polynomials, over q_cr: motions beyond nearly always overturn
REST_RATE = 1e-6  # post-impact rate over p phi_cr below which a structure is at rest: it would rock to 5e-13 phi_cr


class Scatter(NamedTuple):
    """Standard deviations of the restitution of a structure, and of the logarithm of its slenderness."""

    restitution: float
    slenderness: float


@short_repr
@dataclass(frozen=True, eq=False)
class Model:
    """One equation of motion of a structure, as arrays of the kernel, which takes any number of models at once.

    Parameters
    ----------
    name : str
        `"nonlinear"`, or `"linear1"` and `"linear2"` for the equivalent block with kappa1 and kappa2.
    structure : str
        Name of the structure.
    phi_cr : tuple of float
        Critical rotation in the positive and the negative direction [rad], or the kinematic limit if there is none.
    numbers, forces, angles, certain : ndarray
        See `rocking_cli.dynamics.kernels.Deck`.
    held : ndarray, shape (cells, 2, 5)
        The part of the first force that does not scale with g, see `DirectionTable`; without rows if there is none.
    ends_at_limit : tuple of bool
        Whether a direction has no critical rotation: `phi_cr` is then the kinematic limit, the only end of the motion.
    one_sided : Direction, optional
        The only direction of rocking, if any: the structure rebounds at an impact, and its restitution is the rebound.
    tables : tuple of DirectionTable, optional
        Tables from which the arrays are made, if nonlinear.
    uplift_error : float
        Relative error of the uplift acceleration of the model, in the worse direction.
    most_eta : tuple of float
        The restitution with which an impact that ends motion in the positive and in the negative direction keeps all
        energy; 1 for a symmetric structure.
    corners : ndarray
        See `rocking_cli.dynamics.kernels.Deck`; without rows if no tie goes slack or taut.
    joints : JointTables, optional
        Joints by which histories are checked; None if they are not known, and for a linear model.
    scatter : Scatter
        Uncertainty of restitution and slenderness of the structure.
    columns : tuple of Model
        Models of its columns, each alone, if three or more carry one beam.
    bounds : tuple of Bound or None
        The rotation of each direction beyond which something else than the mechanism decides; None without one.
    to_first_impact : bool
        Whether its restitution is not known, so that its motion is unknown from the first impact on.
    sliding : Sliding, optional
        The foot of a single body that may only slide; None for other structures, and for a linear model.
    smooth : ndarray
        See `rocking_cli.dynamics.kernels.Deck`; zeros where the forces are no such polynomials.
    """

    name: ModelName
    structure: str
    phi_cr: tuple[float, float]
    numbers: Reals
    forces: Reals
    angles: Reals
    certain: Reals
    tables: tuple[DirectionTable, DirectionTable] | None = None
    held: Reals = field(default_factory=lambda: np.zeros((0, 2, 5)))
    ends_at_limit: tuple[bool, bool] = (False, False)
    one_sided: Direction | None = None
    uplift_error: float = 0.0
    most_eta: tuple[float, float] = (1.0, 1.0)
    corners: Integers = field(default_factory=lambda: np.zeros((0, 2), np.int64))
    joints: JointTables | None = None
    scatter: Scatter = field(default_factory=lambda: Scatter(KINEMATIC_SPREAD, SLENDERNESS_SPREAD))
    columns: tuple[Model, ...] = ()
    bounds: tuple[Bound | None, Bound | None] = (None, None)
    to_first_impact: bool = False
    sliding: Sliding | None = None
    smooth: Reals = field(default_factory=lambda: np.zeros((2, 4 * MOST_PAIRS)))

    @property
    def p(self) -> float:
        """Frequency parameter [rad/s]; the larger one if the directions differ."""
        return float(self.numbers[:, P].max())

    @property
    def gravity(self) -> float:
        """Acceleration of gravity [m/s2]."""
        return float(self.numbers[0, GRAVITY])

    @property
    def lambda_(self) -> tuple[float, float]:
        """Uplift acceleration over g in the positive and the negative direction."""
        return float(self.numbers[0, LAMBDA]), float(self.numbers[1, LAMBDA])

    @property
    def eta(self) -> tuple[float, float]:
        """Restitution of impacts that end motion in the positive and in the negative direction."""
        return float(self.numbers[0, ETA]), float(self.numbers[1, ETA])

    @property
    def weight_share(self) -> float:
        """Share of lambda due to the weight, not to ties and forces, in the direction with the smaller lambda."""
        weaker = self.numbers[int(np.argmin(self.numbers[:, LAMBDA]))]
        return float(1 - weaker[HELD] / weaker[LAMBDA])

    @property
    def reach(self) -> float:
        """Displacement by which openings of joints are divided [m]; NaN if the joints are not known."""
        return self.joints.reach if self.joints is not None else nan

    @property
    def is_linear(self) -> bool:
        """Whether the model is that of an equivalent block."""
        return self.tables is None

    @cached_property
    def symmetric(self) -> bool:
        """Whether both directions are equal, so that reversing a motion has no effect but on the sign."""
        if self.one_sided is not None or (self.sliding is not None and not self.sliding.symmetric):
            return False
        pairs = ((of[:, 0], of[:, 1]) for of in (self.forces, self.certain, self.held) if len(of))
        same = all(np.allclose(one, other, rtol=0, atol=EQUAL_TABLES * np.abs(one).max()) for one, other in pairs)
        one, other = self.numbers  # the numbers have different units
        return same and np.allclose(one, other, rtol=EQUAL_TABLES, atol=EQUAL_TABLES**2, equal_nan=True)

    def protect(self) -> None:
        """Make the arrays read-only that kernels take a copy of: the model is shared by all who ask its structure."""
        for owner in (self, *(self.tables or ())):
            for name, part in vars(owner).items():
                if isinstance(part, np.ndarray) and (owner is not self or name in ("numbers", "held")):
                    part.flags.writeable = False

    def q(self, ratio: float) -> float:
        """Return the kernel's coordinate q at a signed rotation, given as a fraction of the phi_cr of its direction."""
        side = 1 if ratio < 0 else 0
        phi = abs(ratio) * self.phi_cr[side]
        return float(np.copysign(phi if self.tables is None else self.tables[side].q(phi), ratio))


NO_REBOUND = Problem(
    "is missing: a time history of a one-sided structure needs it, and only for a plain rectangle does it follow from "
    "the shape",
    field="rebound",
    hint="give a measured value as rebound, a number in [0, 1)",
)


UNSUPPORTED_NEEDS = {"has_memory": "its past deformation (memory)", "has_rate": "its rate of deformation"}
"""Dependence of an element's force that the kernel does not support, by the attribute of the element."""


def check_elements(mechanism: Mechanism) -> None:
    """Raise `InputError`, with the names of the elements, if the kernel cannot simulate those of a structure."""
    of, why = mechanism.name or mechanism.mechanism, "which no time-history kernel can simulate in this structure"
    problems = [
        Problem(f"{each.name} of {of}: its force depends on {need}, {why}: use an elastic element instead")
        for each in mechanism.hung.elements
        for attribute, need in UNSUPPORTED_NEEDS.items()
        if getattr(each, attribute)
    ]
    if problems:
        raise InputError(*problems)


def build(
    mechanism: Mechanism,
    statics: tuple[Statics, Statics],
    equivalence: Equivalence | None,
    name: ModelName,
    opening: float = OPENING,
    *,
    to_first_impact: bool = False,
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
    opening : float
        Largest opening of a joint up to which a history is valid, over D_cr.
    to_first_impact : bool
        Whether the nonlinear model of a structure without a known restitution is valid up to its first impact, and not
        refused; that of a body which only slides always is.

    Raises
    ------
    InputError
        If the restitution is not known, see `no_restitution`; if the kernel cannot simulate an element of the
        structure, or one of them has no linear model.
    """
    etas, sliding = (mechanism.eta(mechanism.sides[0]), mechanism.eta(mechanism.sides[1])), sliding_of(mechanism)
    if (missing := no_restitution(mechanism)) is not None:
        slides = sliding is not None and sliding.friction < sliding.friction_to_rock
        if name != "nonlinear" or not (to_first_impact or slides):
            raise InputError(missing)
        etas = 1.0, 1.0  # of no effect, as nothing is known after an impact
    if name == "nonlinear":
        check_elements(mechanism)
        columns = [build(each, both_statics(each), None, name, opening) for each in mechanism.columns_alone()]
        model = replace(
            nonlinear_model(mechanism, statics, etas),
            columns=tuple(columns),
            to_first_impact=missing is not None,
            sliding=sliding,
        )
        if model.joints is not None:
            model = replace(model, joints=replace(model.joints, limit=opening))
    else:
        mechanism.hung.ask("linear models")
        assert equivalence is not None
        blocks = equivalence.positive, equivalence.negative
        model = linear_model(mechanism.name or mechanism.mechanism, name, blocks, mechanism.gravity)
        if mechanism.attached:
            model = with_held(model, mechanism, blocks)
    model = replace(_bounded(model, mechanism), scatter=scatter_of(mechanism))
    if not mechanism.rocks_both_ways:
        # A one-sided structure never uplifts in the other direction, and rebounds at an impact.
        direction, numbers = mechanism.directions[0], model.numbers.copy()
        numbers[0 if direction < 0 else 1, LAMBDA] = np.inf
        numbers[:, ONE_SIDED] = 1.0
        return replace(model, numbers=numbers, one_sided=direction, most_eta=(1.0, 1.0))
    most_eta = mechanism.greatest_restitution(Direction.POSITIVE), mechanism.greatest_restitution(Direction.NEGATIVE)
    return replace(model, most_eta=most_eta)


def _bounded(model: Model, mechanism: Mechanism) -> Model:
    """Return a model that ends at the first bound of each direction, if there is one within its table."""
    numbers = model.numbers.copy()
    bounds = [mechanism.bounds[direction] for direction in mechanism.sides]
    if model.joints is not None and model.joints.redundant:  # the impulses of a stop on them are not known
        bounds = [bound and bound._replace(restitution=None) for bound in bounds]
    for side, bound in enumerate(bounds):
        if bound is not None:
            numbers[side, Q_BOUND] = bound.phi
            numbers[side, BOUND_ETA] = np.nan if bound.restitution is None else bound.restitution
    return replace(model, numbers=numbers, bounds=(bounds[0], bounds[1]))


def no_restitution(mechanism: Mechanism) -> Problem | None:
    """Return the problem that the motion of a structure after an impact is not known; None if it is.

    The restitution from kinematics may be zero or less, and the rebound of a one-sided structure not known.
    """
    for direction in mechanism.directions:
        eta = mechanism.eta(direction)
        if isnan(eta):
            return NO_REBOUND
        if eta <= 0 and mechanism.rocks_both_ways:
            return Problem(
                f"{mechanism.name or 'structure'}: the kinematics give {eta:.4g} for an impact that ends "
                f"motion in the {direction.label} direction: {why_none(eta)}",
                field="restitution",
                hint="give a measured value as restitution, a number in (0, 1]",
            )
    return None


def scatter_of(mechanism: Mechanism) -> Scatter:
    """Return the scatter of a structure: as given, or else as usual from tests of such bodies."""
    uncertainty = mechanism.uncertainty or Uncertainty()
    usual = KINEMATIC_SPREAD if mechanism.restitution_is_kinematic else MEASURED_SPREAD
    return Scatter(
        usual if uncertainty.restitution is None else uncertainty.restitution,
        SLENDERNESS_SPREAD if uncertainty.slenderness is None else uncertainty.slenderness,
    )


def nonlinear_model(mechanism: Mechanism, statics: tuple[Statics, Statics], etas: tuple[float, float]) -> Model:
    """Build the nonlinear model of a structure whose forces depend on its rotation alone.

    Parameters
    ----------
    mechanism : Mechanism
        The structure.
    statics : tuple of Statics
        Statics of the positive and the negative direction.
    etas : tuple of float
        Restitution of impacts that end motion in the positive and in the negative direction.
    """
    label, tables = mechanism.name or mechanism.mechanism, tabulate(mechanism, statics)
    numbers = []
    for direction, side, table, eta in zip(mechanism.sides, statics, tables, etas, strict=True):
        p = _rate(mechanism, direction, side)
        row = np.zeros(COLUMNS)
        row[LAMBDA] = side.lambda_
        row[Q_CR] = table.q(side.reference) if side.phi_cr is not None else table.end
        row[ETA], row[RATE] = eta, table.rest_rate
        row[REST] = REST_RATE * p * side.reference / table.rest_rate
        row[Q_END], row[PER_CELL], row[P], row[GRAVITY] = table.end, 1 / table.cell, p, mechanism.gravity
        rest = mechanism.coefficients(np.zeros(1), direction)
        row[HELD] = rest.Q[0] / (mechanism.gravity * rest.B[0])  # part of lambda that does not scale with g
        row[Q_BOUND], row[BOUND_ETA] = np.inf, np.nan
        row[FASTEST], row[BOW], row[BOUNDED] = _rate_bounds(table, row[Q_CR])
        numbers.append(row)
    forces, angles, certain = (
        np.stack([getattr(table, part) for table in tables], axis=1) for part in ("forces", "angles", "certain")
    )
    held = np.zeros((0, 2, 5))
    if any(table.held.size for table in tables):
        none = np.zeros((len(forces), 5))
        held = np.stack([table.held if table.held.size else none for table in tables], axis=1)
    corners = np.stack([table.corners for table in tables], axis=1)
    smooth = np.zeros((2, 4 * MOST_PAIRS))
    if not (corners.any() or held.size):
        for d, (direction, table) in enumerate(zip(mechanism.sides, tables, strict=True)):
            reach = min(REACH * numbers[d][Q_CR], table.end)
            numbers[d][PAIRS], smooth[d] = polynomials(mechanism, direction, table, reach)
            numbers[d][PER_REACH] = 2 / reach
    phi_cr = statics[0].reference, statics[1].reference
    ends = statics[0].phi_cr is None, statics[1].phi_cr is None
    return Model(
        "nonlinear", label, phi_cr, np.array(numbers), forces, angles, certain, tables=tables, held=held,
        corners=corners if corners.any() else corners[:0], ends_at_limit=ends, smooth=smooth,
        joints=joints_of(mechanism, statics, tables, max(row[P] for row in numbers)),
    )  # fmt: skip


def _rate_bounds(table: DirectionTable, q_cr: float) -> tuple[float, float, float]:
    """Return the largest dphi/dq, the largest |d2phi/dq2| over it, and the q up to which they are that.

    Near a limit they may be far larger than up to phi_cr, where motions are.
    """
    slope = table.angles[:, 4]
    constant = float(np.ptp(slope)) <= EQUAL_TABLES * float(slope[0])
    cells = slice(None if constant else int(q_cr / table.cell) + 2)
    bend = np.abs(table.angles[cells, 5] / slope[cells]).max() / table.cell
    return float(slope[cells].max()), float(bend), inf if constant else q_cr


def _rate(mechanism: Mechanism, direction: Direction, statics: Statics) -> float:
    """Return the rate of the motion in a direction [rad/s]: p, or else a frequency from the moment at rest."""
    at = mechanism.coefficients(np.array([0.0, statics.reference]), direction)
    if statics.phi_cr is not None and (stiffness := -float(at.stiffness(mechanism.gravity)[1])) > 0:
        return sqrt(mechanism.gravity * stiffness / float(at.I[1]))  # Eq. 17
    return sqrt(mechanism.gravity * float(at.restoring(mechanism.gravity)[0]) / (float(at.I[0]) * statics.reference))


def with_held(model: Model, mechanism: Mechanism, blocks: tuple[EquivalentBlock, EquivalentBlock]) -> Model:
    """Return a linear model to which the moments of ties and forces near phi_cr are added as a separate part.

    Vertical motion changes the moments of weights but not those of ties and forces, so the kernel needs both parts:
    I_eq x.. = -(g G' + Q') x - v_g'' (G + G' x) - s B u_g'', x = phi - phi_cr.
    """
    held, numbers = np.zeros((1, 2, 5)), model.numbers.copy()
    for d, (direction, block) in enumerate(zip(mechanism.sides, blocks, strict=True)):
        at = mechanism.coefficients(np.array([block.phi_cr]), direction)
        slope = float(at.dQ[0]) / (mechanism.gravity * block.I_eq)
        held[0, d, 0] = float(at.Q[0]) / (mechanism.gravity * block.I_eq) - slope * block.phi_cr
        held[0, d, 1] = slope
        numbers[d, HELD] = held[0, d, 0] / model.forces[0, d, 4]
    return replace(model, held=held, numbers=numbers)


def linear_model(label: str, name: ModelName, blocks: tuple[EquivalentBlock, EquivalentBlock], gravity: float) -> Model:
    """Build a linear model, `linear1` or `linear2`, from the equivalent blocks.

    Parameters
    ----------
    label : str
        Name of the structure.
    name : {"linear1", "linear2"}
        Model, which gives the scaling: kappa1 or kappa2.
    blocks : tuple of EquivalentBlock
        Equivalent blocks of the positive and the negative direction.
    gravity : float
        Gravitational acceleration [m/s2].
    """
    # Here q = phi, and the forces are linear or constant, so that one cell is enough.
    numbers, forces = [], np.zeros((1, 2, 8))
    for d, block in enumerate(blocks):
        kappa = block.kappa1 if name == "linear1" else block.kappa2
        row = np.zeros(COLUMNS)
        row[LAMBDA], row[Q_CR], row[ETA], row[RATE] = block.phi_cr / kappa, block.phi_cr, block.eta, 1.0
        row[REST], row[Q_END], row[PER_CELL] = REST_RATE * block.p * block.phi_cr, FALLEN_ROTATION, 1.0
        row[P], row[KAPPA_G], row[GRAVITY] = block.p, kappa / gravity, gravity
        row[FASTEST], row[BOW], row[BOUNDED] = 1.0, 0.0, inf
        row[Q_BOUND], row[BOUND_ETA] = np.inf, np.nan
        numbers.append(row)
        stiffness = block.p**2 / gravity
        forces[0, d, [0, 1, 4]] = stiffness * block.phi_cr, -stiffness, stiffness * kappa  # Eq. 12
    angles = np.tile([0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0], (1, 2, 1))
    phi_cr = blocks[0].phi_cr, blocks[1].phi_cr
    error = uplift_error(Equivalence(*blocks)) if name == "linear1" else 0.0
    certain = np.zeros((1, 2))
    return Model(name, label, phi_cr, np.array(numbers), forces, angles, certain, uplift_error=error)
