"""A structure at other sizes: whether shape alone decides how it rocks, and the structure of each size if not."""

from __future__ import annotations

from dataclasses import replace
from math import exp, isclose, log, pi

from pydantic import ValidationError

from rocking_cli.core import (
    Direction,
    Equivalence,
    EquivalentBlock,
    Mechanism,
    equivalent_block,
)
from rocking_cli.core.given import Strength
from rocking_cli.dynamics.model import Model, ModelName
from rocking_cli.errors import InputError, MechanismError, Problem, of_structure
from rocking_cli.io.field_problems import of_arguments
from rocking_cli.names import OPENING
from rocking_cli.structure import Structure

ALIKE = 1e-7  # relative difference, of what shape alone decides where it does, that solvers and rounding may make
TRIED = ((0.1, 0.5, 0.9), (10.0, 2.0, 1.1))  # scales at which that is looked at: of each row the first that there is
CLOSE = 1e-10  # relative error of 2 pi/p where a size is sought
STEPS = 50  # of the search


class Sizes:
    """The versions of a structure with all lengths multiplied by a scale.

    Parameters
    ----------
    mechanism : Mechanism
        The structure at scale 1, with the restitution that is used.
    model : {"nonlinear", "linear1", "linear2"}
        The equation of motion.
    direction : Direction
        The direction whose frequency parameter p expresses the size: users give sizes as 2 pi/p.
    opening : float
        Largest opening of a joint up to which a history is valid, over D_cr.
    """

    def __init__(
        self, mechanism: Mechanism, model: ModelName, direction: Direction, opening: float = OPENING
    ) -> None:  # fmt: skip
        self.mechanism, self.model, self.direction, self.opening = mechanism, model, direction, opening
        self._known: dict[float, Equivalence] = {}

    def at(self, scale: float) -> Mechanism:
        """Return the structure with every length multiplied by a scale. Raises `InputError` if it cannot be built."""
        try:
            return self.mechanism.enlarged(scale)
        except ValidationError as error:
            first, *_ = of_arguments(type(self.mechanism), error.errors(include_url=False), self.mechanism.mechanism)
            message = f"{self._named(scale)} cannot be built: {replace(first, hint=None)}"
            raise InputError(Problem(message, hint="choose other sizes")) from None

    def equivalence(self, scale: float) -> Equivalence:
        """Return the equivalent blocks at a scale. Raises as `at`, or `MechanismError` if it does not stand."""
        if scale not in self._known:
            try:
                self._known[scale] = equivalent_block(self.at(scale))
            except MechanismError as error:
                raise of_structure(error, self._named(scale)) from error
        return self._known[scale]

    def block(self, scale: float) -> EquivalentBlock:
        """Return the equivalent block at a scale, in the direction that expresses sizes. Raises as `equivalence`."""
        return self.equivalence(scale)[self.direction]

    def build(self, scale: float) -> Model:
        """Return the model at a scale. Raises as `equivalence`, or if the restitution is not known."""
        mechanism = self.at(scale)
        named = mechanism.model_copy(update={"name": self._named(scale)})
        return Structure(named, opening=self.opening).model(self.model)

    def period(self, scale: float) -> float:
        """Return 2 pi/p at a scale [s]."""
        return 2 * pi / self.block(scale).p

    def scale(self, period: float) -> float:
        """Return the scale at which 2 pi/p has a value [s]. Raises as `equivalence`, or if there is none."""
        one, off = 0.0, log(period / self.period(1.0))  # in logarithms, where 2 pi/p grows about half as the scale
        two = 2 * off
        for _ in range(STEPS):
            missing = log(period / self.period(exp(two)))
            if abs(missing) < CLOSE:
                return exp(two)
            slope = (off - missing) / (two - one) if two != one else 0.5
            one, off, two = two, missing, two + missing / (slope if 0.1 < slope < 2 else 0.5)
        message = f"{self.mechanism.name}: no size of it was found with 2 pi/p = {period:.4g} s"
        if self.mechanism.ties:
            hint = "its ties do not scale with it, so 2 pi/p need not increase with its size: choose other sizes"
            raise InputError(Problem(message, hint=hint))
        raise InputError(message)

    def are_alike(self) -> bool:
        """Return whether all sizes rock alike, in different time only: no load or mass is given that does not scale.

        A strength against which joints are checked also excludes this: the weight increases faster than the strength.
        """
        if self.model == "nonlinear" and isinstance(self.mechanism.strength, Strength):
            return False
        own = _shape_of(self.equivalence(1.0), 1.0)
        for scales in TRIED:
            for scale in scales:
                try:
                    other = _shape_of(self.equivalence(scale), scale)
                except InputError:  # out of the bounds of its fields
                    continue
                except MechanismError:
                    return False
                if not all(isclose(a, b, rel_tol=ALIKE) for a, b in zip(own, other, strict=True)):
                    return False
                break
        return True

    def _named(self, scale: float) -> str:
        return f"{self.mechanism.name or self.mechanism.mechanism} at scale {scale:.4g}"


def _shape_of(equivalence: Equivalence, scale: float) -> list[float]:
    """Return parameters that do not change with size if shape alone decides how a structure rocks."""
    return [
        value
        for block in (equivalence[direction] for direction in Direction)
        for value in (block.lambda_, block.phi_cr, block.lambda_lin, block.eta, block.p * scale**0.5)
    ]
