"""What a structure can be designed for: numbers by name, in one table."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass, field
from math import nan

from rocking_cli.errors import InputError, MechanismError, Problem
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.plugins.errors import blame
from rocking_cli.plugins.installed import leave_out
from rocking_cli.structure import Structure
from rocking_cli.studies.neighbours import Neighbourhood, Neighbours, neighbours
from rocking_cli.studies.verification.check import verify
from rocking_cli.studies.verification.code import Number
from rocking_cli.studies.verification.installed import codes
from rocking_cli.studies.verification.site_file import SiteFile
from rocking_cli.text import cut, did_you_mean


@dataclass(frozen=True)
class Excitation:
    """What shakes a structure.

    Parameters
    ----------
    motions : sequence of GroundMotion
        As scaled; the worst counts.
    polarities : sequence of int
        Of 1 and -1; the worse counts.
    around : Neighbourhood
        How the neighbours of each motion are drawn.
    site : SiteFile, optional
        Where it stands, for what a code asks.
    """

    motions: Sequence[GroundMotion]
    polarities: Sequence[int] = (1,)
    around: Neighbourhood = field(default_factory=Neighbourhood)
    site: SiteFile | None = None

    def each(self, structure: Structure) -> list[Neighbours]:
        """The neighbours of every motion, both ways where a structure and the polarities differ."""
        model = structure.model("nonlinear")
        signs = self.polarities[:1] if model.symmetric else self.polarities
        return [neighbours(model, motion.scaled(sign), self.around) for motion in self.motions for sign in signs]


@dataclass(frozen=True)
class Metric:
    """A number of a structure.

    Parameters
    ----------
    name : str
        As users write it.
    unit : str
        Its unit; empty for a pure number.
    meaning : str
        What it is, in a few words.
    of_structure : callable, optional
        Gives it for a structure and what shakes it; NaN where there is none, and infinity beyond all numbers. Raises
        `InputError` or `MechanismError` where the structure has none.
    of_neighbours : callable, optional
        Gives it for the neighbours of a motion instead: a share of histories, or a fractile, which moves by steps. An
        unknown outcome counts as overturning in it.
    sited : bool
        Whether it needs a site.
    codes : sequence of str
        The codes of practice that have it; empty where it needs none.
    """

    name: str
    unit: str
    meaning: str
    of_structure: Callable[[Structure, Excitation | None], float] | None = None
    of_neighbours: Callable[[Neighbours], float] | None = None
    sited: bool = False
    codes: Sequence[str] = ()

    @property
    def shaken(self) -> bool:
        """Whether it needs ground motions."""
        return self.of_neighbours is not None

    def value(self, structure: Structure, excitation: Excitation | None) -> float:
        """Return the metric of a structure."""
        return self.at(structure, excitation)[0]

    def at(self, structure: Structure, excitation: Excitation | None) -> tuple[float, Neighbours | None]:
        """Return the metric of a structure, and the neighbours of the motion that governs if it needs motions."""
        of = self.of_neighbours
        if of is None:
            assert self.of_structure is not None
            return self.of_structure(structure, excitation), None
        assert excitation is not None
        worst = max(excitation.each(structure), key=lambda near: (of(near), near.at_most, near.overturned))
        return of(worst), worst


def _lambda(structure: Structure, excitation: Excitation | None) -> float:
    return min(side.lambda_ for side in structure.statics)


def _phi_cr(structure: Structure, excitation: Excitation | None) -> float:
    found = [side.phi_cr for side in structure.statics]
    return min((each for each in found if each is not None), default=nan) if None not in found else nan


def _p(structure: Structure, excitation: Excitation | None) -> float:
    return structure.p if structure.why_no_block is None else nan


def _ratio(structure: Structure, excitation: Excitation | None) -> float:
    assert excitation is not None and excitation.site is not None
    return verify(structure, excitation.site).ratio


def taken_otherwise(structure: Structure, site: SiteFile) -> Sequence[str]:
    """Return what a verification takes otherwise than the structure gives it, such as ties by their force at rest."""
    return verify(structure, site).taken_otherwise


METRICS: Mapping[str, Metric] = {
    each.name: each
    for each in (
        Metric("lambda", "", "ground acceleration at uplift over g, in the weaker direction", _lambda),
        Metric("phi_cr", "rad", "critical rotation, the smaller of both directions", _phi_cr),
        Metric("p", "rad/s", "frequency parameter of the equivalent block, the larger of both directions", _p),
        Metric("peak_ratio", "", "peak rotation over the critical one that half of the neighbours do not exceed",
               of_neighbours=lambda near: near.peak_ratio[1]),
        Metric("overturned", "", "share of the neighbours that overturn, or are of unknown outcome",
               of_neighbours=lambda near: near.at_most),
        Metric("ratio", "", "capacity over demand by the code of the site, by what governs in `verify`", _ratio,
               sited=True),
    )
}  # fmt: skip
"""Every metric but those of codes; one more is one more line here."""


def _of_codes(name: str) -> Metric | None:
    """A metric that codes of practice have among their `numbers`; None if none has it."""
    own: dict[str, Number] = {}
    for key in codes():
        try:
            if (found := codes()[key].numbers.get(name)) is not None:
                own[key] = found
        except MechanismError as error:
            leave_out(error)
    if not own:
        return None

    def value(structure: Structure, excitation: Excitation | None) -> float:
        if one.of_structure is not None:
            structure.statics  # noqa: B018 - what does not stand is refused with its name
            with _blamed(first, name):
                return min(one.of_structure(structure.mechanism, each) for each in structure.mechanism.directions)
        assert excitation is not None and excitation.site is not None
        key = excitation.site.site.code
        of = own[key].of
        assert of is not None  # else it is of the structure
        found = verify(structure, excitation.site).directions.values()
        with _blamed(key, name):
            return min((value for each in found if (value := of(each)) is not None), default=nan)

    first, one = next(iter(own.items()))
    return Metric(name, one.unit, one.meaning, value, sited=one.of_structure is None, codes=tuple(own))


def _blamed(code: str, name: str) -> AbstractContextManager[None]:
    """Turn errors of a number of a code into those of its plugin."""
    return blame(f"the code {code} failed in its number {name}", type(codes()[code]).__module__)


def known_metrics() -> list[str]:
    """The names of all metrics, those of the installed codes after the others."""
    found = dict.fromkeys(METRICS)
    for key in codes():
        try:
            found |= dict.fromkeys(codes()[key].numbers)
        except MechanismError as error:
            leave_out(error)
    return list(found)


def metric(name: str) -> Metric:
    """A metric by its name. Raises `InputError` if there is none."""
    found = METRICS.get(name) or _of_codes(name)
    if found is None:
        hint = did_you_mean(name, known_metrics())
        raise InputError(Problem(f"{cut(repr(name))} is not a metric", hint=hint))
    return found
