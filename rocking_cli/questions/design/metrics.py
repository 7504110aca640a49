"""Metrics: the quantities, by name, for which a structure can be designed."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from math import nan

import numpy as np

from rocking_cli.arrays import Reals
from rocking_cli.core import Direction, Mechanism
from rocking_cli.errors import InputError, MechanismError, Problem
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.plugins.errors import blame
from rocking_cli.plugins.registry import leave_out
from rocking_cli.short_repr import short_repr
from rocking_cli.structure import Structure
from rocking_cli.studies.movements import centroid_moved, drifts, largest_on_the_way, largest_tie_force
from rocking_cli.studies.neighbours import Conditions, Neighbourhood, Neighbours, neighbours
from rocking_cli.text import cut, did_you_mean
from rocking_cli.verification.check import code_of, verify
from rocking_cli.verification.code import Number, SiteFile, codes


@dataclass(frozen=True)
class Excitation:
    """The ground motions and the site for which metrics are computed.

    Parameters
    ----------
    motions : sequence of GroundMotion
        The scaled motions; the worst governs.
    polarities : sequence of int
        The polarities, 1, -1 or both; the worse governs.
    around : Neighbourhood
        How the neighbours of each motion are drawn.
    site : SiteFile, optional
        The site of the structure, for metrics of a code.
    """

    motions: Sequence[GroundMotion] = ()
    polarities: Sequence[int] = (1,)
    around: Neighbourhood = field(default_factory=Neighbourhood)
    site: SiteFile | None = None

    def each(self, structure: Structure) -> list[Neighbours]:
        """Return the neighbours of every motion, in both polarities if requested and if their effects differ."""
        conditions = Conditions(structure, ["nonlinear"], around=self.around)
        signs = self.polarities[:1] if conditions.model.symmetric else self.polarities
        return [neighbours(conditions, motion.scaled(sign)) for motion in self.motions for sign in signs]


@short_repr
@dataclass(frozen=True)
class Metric:
    """A quantity of a structure that can be limited.

    Parameters
    ----------
    name : str
        Name of the metric, as users write it.
    unit : str
        Its unit; empty for a pure number.
    meaning : str
        Meaning of the metric, in a few words.
    of_structure : callable, optional
        Function of a structure and an `Excitation` that returns the metric: NaN if it does not exist, infinity if it
        is unlimited. Raises `InputError` or `MechanismError` if the structure has none.
    of_neighbours : callable, optional
        Returns the metric of the neighbours of a motion, and of the structure, instead: a share of histories, or a
        fractile, which are step functions. An unknown outcome counts as overturning.
    lacks : callable, optional
        Returns why a structure cannot have the metric, and what to use instead; None if it can.
    sited : bool
        Whether the metric needs a site.
    codes : sequence of str
        The codes of practice that have this metric; empty if it needs none.
    """

    name: str
    unit: str
    meaning: str
    of_structure: Callable[[Structure, Excitation], float] | None = None
    of_neighbours: Callable[[Neighbours, Structure], float] | None = None
    lacks: Callable[[Structure], str | None] | None = None
    sited: bool = False
    codes: Sequence[str] = ()

    def __reduce__(self) -> tuple[Callable[[str], Metric], tuple[str]]:
        return metric, (self.name,)

    @property
    def shaken(self) -> bool:
        """Whether the metric needs ground motions."""
        return self.of_neighbours is not None

    @property
    def of_code(self) -> bool:
        """Whether the metric is of a code of practice, for which ties of steel act with their strength."""
        return self.sited or bool(self.codes)

    def at(self, structure: Structure, excitation: Excitation) -> tuple[float, Neighbours | None]:
        """Return the metric of a structure, and the neighbours of the motion that governs if it needs motions."""
        measure = self.of_neighbours
        if self.lacks is not None and (why := self.lacks(structure)) is not None:
            raise InputError(f"{self.name} {why}")
        if self.of_structure is not None:
            return self.of_structure(structure, excitation), None
        assert measure is not None
        numbers = [(measure(neighbours, structure), neighbours) for neighbours in excitation.each(structure)]
        return max(numbers, key=lambda each: (each[0], each[1].at_most, each[1].overturned))


def _phi_cr(structure: Structure, excitation: Excitation) -> float:
    critical = [nan if side.phi_cr is None else side.phi_cr for side in structure.statics]
    return float(np.min(critical))


def _ratio(structure: Structure, excitation: Excitation) -> float:
    assert excitation.site is not None
    end = verify(structure, excitation.site).conclusion
    if any(each.what == "mechanism" for each in end.left_out):
        raise MechanismError("another mechanism starts first, which the verification does not cover")
    return nan if end.ratio is None else end.ratio


def _median_of(
    measure: Callable[[Mechanism, Reals, Direction], Reals], *, slides: bool = False
) -> Callable[[Neighbours, Structure], float]:
    """Return a metric: the median over neighbours of the largest value of a function of rotation up to their peaks.

    If `slides`, the value of a body that only slides is its slip.
    """

    def median(near: Neighbours, structure: Structure) -> float:
        mechanism = structure.mechanism
        sides = []
        for side in mechanism.directions:
            reached, most = near.rotations[:, 0 if side > 0 else 1], np.nextafter(mechanism.limit(side), 0.0)
            reached = np.where(np.isfinite(reached), np.minimum(reached, most), reached)
            sides.append(largest_on_the_way(partial(measure, mechanism), reached, side))
        # A value of the sample, as interpolation with infinity has no meaning.
        values = np.max([*sides, near.slips] if slides else sides, axis=0)
        return float(np.quantile(values, 0.5, method="inverted_cdf"))

    return median


def _lacks_critical_rotation(structure: Structure) -> str | None:
    if all(side.phi_cr is not None for side in structure.statics):
        return None
    return "requires a critical rotation, which this structure has not: use peak_displacement, drift or tie_force"


def _lacks_ties(structure: Structure) -> str | None:
    return None if structure.mechanism.hung.ties else "requires a tie, and the structure has none: add it to `ties`"


def required(structure: Structure, site: SiteFile) -> tuple[float, float | None]:
    """Return the one ratio that a code requires after a change of a structure, and that before if it depends on it.

    Raises `InputError` if there is no such ratio.
    """
    existing = verify(structure, site)
    after = code_of(site).strengthened(existing, existing, site.site).strengthened
    levels = {check.state: check.required or 0.0 for side in after.directions.values() for check in side.checks}
    if min(levels.values()) == 0 or len({*levels.values()}) > 1:
        each = ", ".join(f"{state} {level:.4g}" for state, level in levels.items())
        raise InputError(Problem(f"there is no one ratio that the code requires ({each}): give a number"))
    alone = [check.required for side in existing.directions.values() for check in side.checks]
    return next(iter(levels.values())), existing.ratio if None in alone else None


METRICS: Mapping[str, Metric] = {
    each.name: each
    for each in (
        Metric("lambda", "", "ground acceleration at uplift over g, in the weaker direction",
               lambda structure, _: min(side.lambda_ for side in structure.statics)),
        Metric("phi_cr", "rad", "critical rotation, the smaller of both directions", _phi_cr),
        Metric("p", "rad/s", "frequency parameter of the equivalent block, the larger of both directions",
               lambda structure, _: structure.p if structure.why_no_block is None else nan),
        Metric("peak_ratio", "", "median of the neighbours' peak rotation over phi_cr",
               of_neighbours=lambda near, _: near.peak_ratio[1], lacks=_lacks_critical_rotation),
        Metric("peak_displacement", "m", "peak displacement of the control point, the centroid of all that moves, that "
               "half of the neighbours do not exceed", of_neighbours=_median_of(centroid_moved, slides=True)),
        Metric("drift", "", "peak displacement of the top over its height that half of the neighbours do not exceed",
               of_neighbours=_median_of(drifts)),
        Metric("tie_force", "N", "largest force of a tie that half of the neighbours do not exceed",
               of_neighbours=_median_of(largest_tie_force), lacks=_lacks_ties),
        Metric("overturned", "", "share of the neighbours that overturn, or are of unknown outcome",
               of_neighbours=lambda near, _: near.at_most),
        Metric("ratio", "", "capacity over demand by the code of the site, by what governs in `verify`", _ratio,
               sited=True),
    )
}  # fmt: skip
"""Metrics by name, except those of codes of practice."""


def _numbers() -> dict[str, Mapping[str, Number]]:
    """Return the numbers that each installed code of practice declares."""
    numbers: dict[str, Mapping[str, Number]] = {}
    for key in codes():
        try:
            numbers[key] = codes()[key].numbers
        except MechanismError as error:
            leave_out(error)
    return numbers


def _of_codes(name: str) -> Metric | None:
    """Return the metric that codes of practice declare under this name among their `numbers`; None if none does."""
    numbers = {key: declared[name] for key, declared in _numbers().items() if name in declared}
    if not numbers:
        return None

    def value(structure: Structure, excitation: Excitation) -> float:
        if one.of_structure is not None:
            structure.statics  # noqa: B018 - what does not stand is refused with its name
            with blame(f"the code {first} failed in its number {name}", type(codes()[first]).__module__):
                mechanism = structure.mechanism.at_strength()
                return min(one.of_structure(mechanism, direction) for direction in mechanism.directions)
        assert excitation.site is not None
        key = excitation.site.site.code
        of = numbers[key].of
        assert of is not None  # a number without `of` is a metric of the structure alone
        verified = verify(structure, excitation.site).directions.values()
        with blame(f"the code {key} failed in its number {name}", type(codes()[key]).__module__):
            return min((value for direction in verified if (value := of(direction)) is not None), default=nan)

    first, one = next(iter(numbers.items()))
    return Metric(name, one.unit, one.meaning, value, sited=one.of_structure is None, codes=tuple(numbers))


def metric(name: str) -> Metric:
    """Return the metric of a name. Raises `InputError` if there is none."""
    metric = METRICS.get(name) or _of_codes(name)
    if metric is None:
        known = dict.fromkeys([*METRICS, *(number for declared in _numbers().values() for number in declared)])
        hint = did_you_mean(name, list(known))
        raise InputError(Problem(f"{cut(repr(name))} is not a metric", hint=hint))
    return metric
