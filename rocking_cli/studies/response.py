"""The response of a structure to one ground motion: in both polarities, with neighbours, and to its pulse alone."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property, partial
from math import isnan

from rocking_cli.dynamics.history import History
from rocking_cli.dynamics.model import ModelName
from rocking_cli.dynamics.verdict import Agreement, agreements, remedy
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.excitation.pulse_fit import FITTED, PulseFit, fit_pulses
from rocking_cli.processing.reading import Scaled
from rocking_cli.short_repr import short_repr
from rocking_cli.studies.conclusion import Concluded, Conclusion, NeighbourShare, NextStep, are_alike, worst
from rocking_cli.studies.conditions import Conditions
from rocking_cli.studies.contact import ContactDemand, Contacts
from rocking_cli.studies.neighbours import Neighbours, neighbours

Histories = Mapping[ModelName, History]
ByPolarity = Mapping[int, Histories]
"""Histories under each requested polarity, 1 or -1."""

# Word that requests the best-fitting pulse.
BEST_PULSE = "best"


def concluded(runs: ByPolarity, neighbours: Mapping[int, Neighbours], motion: str = "") -> Conclusion:
    """Return the conclusion on a structure under one motion: that of the worse polarity, by the best model.

    Parameters
    ----------
    runs : mapping of int to mapping of str to History
        Histories under each polarity.
    neighbours : mapping of int to Neighbours
        Outcomes of the neighbours of the motion, under each polarity; may be empty.
    motion : str
        Name of the motion; empty for a release.
    """
    return _together(_of_each(runs, neighbours, motion))


def _of_each(runs: ByPolarity, neighbours: Mapping[int, Neighbours], motion: str) -> dict[int, Conclusion]:
    return {sign: _of_run(run[best_model(run)], neighbours.get(sign), motion, sign) for sign, run in runs.items()}


def best_model(models: Collection[ModelName]) -> ModelName:
    """Return the model by which is concluded: free blocks, then the structure itself, then the first of its blocks."""
    preferred: tuple[ModelName, ...] = ("blocks", "nonlinear")
    return next((name for name in preferred if name in models), next(iter(models)))


def _together(each: Mapping[int, Conclusion]) -> Conclusion:
    """Return the conclusion of the worse polarity; neither governs if both are alike."""
    governs = worst(each.values())
    alike = len(each) > 1 and all(are_alike(one, governs) for one in each.values())
    return replace(governs, polarity=None if alike else governs.polarity, polarities=list(each))


def _of_run(run: History, neighbours: Neighbours | None, motion: str, sign: int) -> Conclusion:
    if run.unknown:
        what = Concluded.UNKNOWN
    elif run.fell:
        what = Concluded.FALLS_OFF if run.off_edge else Concluded.OVERTURNS
    elif isnan(run.peak_ratio):
        what = Concluded.COMES_TO_REST
    else:
        what = Concluded.ROCKS if run.lifted else Concluded.SLIDES if run.slip else Concluded.NO_UPLIFT
    return Conclusion(
        concluded=what,
        motion=motion,
        polarity=sign,
        peak_ratio=None if run.unknown or isnan(run.peak_ratio) else run.peak_ratio,
        slip=run.slip if what is Concluded.SLIDES else None,
        known_until=run.known_to if run.unknown else None,
        joint=run.check.joint if run.unknown and run.check is not None else "",
        share=NeighbourShare(neighbours.overturned, neighbours.at_most, neighbours.around.count)
        if neighbours is not None
        else None,
        motions=[motion] if motion else [],
        remedy=NextStep(remedy(run)) if run.unknown else None,
        witness=run.witness,
    )


@short_repr
@dataclass(frozen=True, eq=False, kw_only=True)
class Response(Mapping[ModelName, History]):
    """Response of a structure to one ground motion: histories by model, those of the first polarity if there are two.

    Parameters
    ----------
    given : Scaled or None
        The motion as read; None for a free release, and for a pulse fitted to a motion.
    first : GroundMotion or None
        The scaled motion in the first requested polarity.
    runs : mapping of int to mapping of str to History
        The histories under each polarity.
    neighbours : mapping of int to Neighbours
        Outcomes of the neighbours of the motion, under each polarity; empty if none were requested.
    contacts : mapping of int to ContactDemand
        Check of the contacts in the nonlinear history, under each polarity; empty without that history.
    fit, to_pulse : PulseFit and Response, optional
        The pulse fitted to the motion, and the response to this pulse alone.
    """

    given: Scaled | None
    first: GroundMotion | None
    runs: ByPolarity
    neighbours: Mapping[int, Neighbours]
    contacts: Mapping[int, ContactDemand]
    fit: PulseFit | None = None
    to_pulse: Response | None = None

    @cached_property
    def conclusions(self) -> Mapping[int, Conclusion]:
        """The conclusion under each polarity."""
        return _of_each(self.runs, self.neighbours, self.given.motion.name if self.given is not None else "")

    @cached_property
    def conclusion(self) -> Conclusion:
        """The conclusion under the polarity that governs."""
        return _together(self.conclusions)

    @cached_property
    def agreement(self) -> Mapping[int, Mapping[ModelName, Agreement]]:
        """How well the equivalent blocks agree with the nonlinear model under each polarity."""
        return {sign: agreements(histories) for sign, histories in self.runs.items()}

    def assumed_friction(self, polarity: int) -> float | None:
        """Return the friction that the result assumes in a polarity, see `ContactDemand`."""
        return self.contacts[polarity].assumed_friction if polarity in self.contacts else None

    def __getitem__(self, model: ModelName) -> History:
        return next(iter(self.runs.values()))[model]

    def __iter__(self) -> Iterator[ModelName]:
        return iter(next(iter(self.runs.values())))

    def __len__(self) -> int:
        return len(next(iter(self.runs.values())))


def response_of(conditions: Conditions, scaled: Scaled | None) -> Response:
    """Simulate models of a structure under a motion, or freely from a release, and return all results."""
    contacts, follow = Contacts(conditions.structure.mechanism), partial(conditions.by.respond, conditions)
    under = {
        sign: scaled.motion.scaled(sign * scaled.factor) if scaled is not None else None for sign in conditions.signs
    }
    first = under[conditions.signs[0]]
    fit: PulseFit | None = None
    if first is not None and conditions.with_pulse is not None:
        shapes = tuple(FITTED) if conditions.with_pulse == BEST_PULSE else (conditions.with_pulse,)
        fit = max(fit_pulses(first, shapes, ("velocity",)), key=lambda one: one.captured)
    runs = {sign: follow(motion) for sign, motion in under.items()}
    neighbours_of = {sign: neighbours(conditions, motion) for sign, motion in under.items() if conditions.around.count}

    def checked(runs: ByPolarity, under: Mapping[int, GroundMotion | None]) -> dict[int, ContactDemand]:
        return {sign: contacts.check(run["nonlinear"], under[sign]) for sign, run in runs.items() if "nonlinear" in run}

    to_pulse = None
    if fit is not None and first is not None:
        pulse = fit.alone(first)
        alone = {1: follow(pulse)}
        to_pulse = Response(given=None, first=pulse, runs=alone, neighbours={}, contacts=checked(alone, {1: pulse}))
    return Response(
        given=scaled,
        first=first,
        runs=runs,
        neighbours=neighbours_of,
        contacts=checked(runs, under),
        fit=fit,
        to_pulse=to_pulse,
    )
