"""What a page to explore offers: structures, a motion, and a field that varies."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rocking_cli.dynamics.history import History
from rocking_cli.dynamics.model import Model
from rocking_cli.dynamics.sliding import Sliding
from rocking_cli.errors import InputError, Problem
from rocking_cli.processing.reading import Scaled
from rocking_cli.questions.design.study import Span
from rocking_cli.short_repr import short_repr
from rocking_cli.structure import Structure
from rocking_cli.studies.neighbours import Neighbourhood

VALUES = 21  # of a field that varies
MOST_SLENDER = 1e3  # factor on the slenderness that no neighbour has


@dataclass(frozen=True)
class Varied:
    """A field of a structure that varies: its unit, its values in ascending order, and the one that is given."""

    field: str
    unit: str
    values: Sequence[float]
    given: float

    @classmethod
    def of(cls, structure: Structure, span: Span) -> Varied:
        """Return the values of a range, at most `VALUES`, among them the one that is given. Raises `InputError`."""
        unit, given = structure.unit_of(span.field), structure.value_of(span.field)
        low, high = span.in_unit(unit)
        if given is None or not low <= given <= high:
            what = (
                f"the range must have the value in it that the file gives, {'none' if given is None else f'{given:g}'}"
            )
            raise InputError(Problem(what, field=span.field, hint="give a range around it"))
        whole = np.round if structure.is_whole(span.field) else np.asarray
        values = {*whole(np.linspace(low, high, VALUES)).tolist(), given}
        if len(values) > VALUES:
            values = {*np.linspace(low, high, VALUES - 1).tolist(), given}
        return cls(span.field, unit, sorted(values), given)


@short_repr
@dataclass(frozen=True, eq=False)
class Exploration:
    """What a page offers.

    Parameters
    ----------
    structures : sequence of Structure
        The structures, side by side.
    given : Scaled
        The ground motion as read, and the factor on it.
    sign : int
        Its polarity, 1 or -1.
    around : Neighbourhood
        The neighbours of a motion.
    histories : sequence of History
        What each structure does under the motion as given.
    file : str
        The page.
    options : str
        The options of a command that read the motion; empty if no command does.
    varied : Varied or None
        The field of the structure that varies; None without one.
    """

    structures: Sequence[Structure]
    given: Scaled
    sign: int
    around: Neighbourhood
    histories: Sequence[History]
    file: str
    options: str
    varied: Varied | None = None


def slides(foot: Sliding, slender: float) -> bool:
    """Return whether a body that is so much more slender than its own only slides, whatever the ground does."""
    return bool(foot.holds(np.array([slender]), *np.zeros((2, 1)))[0])


def slides_from(foot: Sliding) -> float:
    """Return the least factor on the slenderness with which a body only slides; it holds for all larger ones."""
    low, high = 1.0, MOST_SLENDER
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (low, middle) if slides(foot, middle) else (middle, high)
    return high


def slides_at(foot: Sliding) -> float:
    """Return the least horizontal acceleration of the ground that overcomes friction [m/s2]."""
    still, push = foot.shear[:2]
    return float(min(abs((sense * foot.friction * foot.ends[:, 0].sum() - still) / push) for sense in (-1, 1)))


def check(structure: Structure) -> Model:
    """Return the model of a structure. Raises `InputError` if the page cannot follow it as `respond` does."""
    model = structure.model("nonlinear")
    if model.columns:
        why = "three or more of its columns may fall out of step at an impact, which the page does not follow"
        raise InputError(f"{structure.name}: {why}: use `rocking respond`")
    if model.sliding is not None and slides(model.sliding, 1.0):
        why = "it slides under horizontal motion and does not rock, which the page does not follow"
        raise InputError(f"{structure.name}: {why}: use `rocking respond`")
    if model.to_first_impact:
        raise InputError(f"{structure.name}: its restitution is not known: give `restitution` in the file")
    return model
