"""The response of a structure to one ground motion: in both polarities, with neighbours, and to its pulse alone."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial

from rocking_cli.dynamics.history import History
from rocking_cli.dynamics.model import ModelName
from rocking_cli.dynamics.verdict import remedy
from rocking_cli.engines import respond
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.excitation.pulse_fit import FITTED, PulseFit, fit_pulses
from rocking_cli.processing.scaled import Scaled
from rocking_cli.structure import Structure
from rocking_cli.studies.conclusion import Concluded, Conclusion, NeighbourShare, NextStep, are_alike, worst
from rocking_cli.studies.contact import ContactDemand, Contacts
from rocking_cli.studies.neighbours import Neighbourhood, Neighbours, neighbours

Histories = Mapping[ModelName, History]
Runs = Mapping[int, Histories]
"""Histories under each requested polarity, 1 or -1."""

# The word for the pulse that fits best.
BEST = "best"


def concluded(runs: Runs, near: Mapping[int, Neighbours], motion: str = "") -> Conclusion:
    """Return the conclusion on a structure under one motion: that of the worse polarity, by the best model.

    Parameters
    ----------
    runs : mapping of int to mapping of str to History
        Histories under each polarity.
    near : mapping of int to Neighbours
        Outcomes of the neighbours of the motion, under each polarity; may be empty.
    motion : str
        Name of the motion; empty for a release.
    """
    best: ModelName = "nonlinear" if "nonlinear" in next(iter(runs.values())) else next(iter(next(iter(runs.values()))))
    each = [_of_run(run[best], near.get(sign), motion, sign) for sign, run in runs.items()]
    governs = worst(each)
    alike = len(each) > 1 and all(are_alike(one, governs) for one in each)
    return replace(governs, polarity=None if alike else governs.polarity, polarities=list(runs))


def _of_run(run: History, near: Neighbours | None, motion: str, sign: int) -> Conclusion:
    if run.unknown:
        what = Concluded.UNKNOWN
    elif run.fell:
        what = Concluded.OVERTURNS
    else:
        what = Concluded.ROCKS if run.lifted else Concluded.NO_UPLIFT
    return Conclusion(
        concluded=what,
        motion=motion,
        polarity=sign,
        peak_ratio=None if run.unknown or run.fell else run.peak_ratio,
        known_until=run.known_to if run.unknown else None,
        joint=run.check.joint if run.unknown and run.check is not None else "",
        share=NeighbourShare(near.overturned, near.at_most, near.around.count) if near is not None else None,
        motions=[motion] if motion else [],
        remedy=NextStep(remedy(run)) if run.unknown else None,
    )


@dataclass(frozen=True)
class Question:
    """Options of the response to ground motions.

    Parameters
    ----------
    signs : tuple of int
        The polarities: 1, -1 or both.
    release : float or None
        Fraction of phi_cr at which the structure starts at rest; None: phi = 0.
    tail : float
        Duration of the history after the end of the record [s].
    rtol : float
        Relative local error of a step.
    with_pulse : str or None
        Shape of the pulse under which the response is computed as well, or "best"; None for no pulse.
    around : Neighbourhood
        The neighbours of every motion; a count of 0 for none.
    release_is_angle : bool
        Whether the release was given as an angle.
    """

    signs: tuple[int, ...]
    release: float | None
    tail: float
    rtol: float
    with_pulse: str | None = None
    around: Neighbourhood = field(default_factory=Neighbourhood)
    release_is_angle: bool = False


@dataclass(frozen=True, eq=False)
class Response(Mapping[ModelName, History]):
    """Response of a structure to one ground motion: histories by model, those of the first polarity if there are two.

    Parameters
    ----------
    given : Scaled or None
        The motion as read; None for a free release.
    first : GroundMotion or None
        The scaled motion in the first requested polarity.
    runs : mapping of int to mapping of str to History
        The histories under each polarity.
    neighbours : mapping of int to Neighbours
        Outcomes of the neighbours of the motion, under each polarity; empty if none were requested.
    fit, to_pulse : PulseFit and mapping of str to History, optional
        The pulse fitted to the motion, and the histories under this pulse alone.
    contacts : mapping of int to ContactDemand
        Check of the contacts in the nonlinear history, under each polarity; empty without that history.
    to_pulse_contact : ContactDemand, optional
        Check of the contacts under the pulse alone.
    """

    given: Scaled | None
    first: GroundMotion | None
    runs: Runs
    neighbours: Mapping[int, Neighbours]
    fit: PulseFit | None = None
    to_pulse: Histories | None = None
    contacts: Mapping[int, ContactDemand] = field(default_factory=dict)
    to_pulse_contact: ContactDemand | None = None

    @property
    def conclusion(self) -> Conclusion:
        """What is concluded, and what governs."""
        return concluded(self.runs, self.neighbours, self.given.motion.name if self.given is not None else "")

    def __getitem__(self, model: ModelName) -> History:
        return next(iter(self.runs.values()))[model]

    def __iter__(self) -> Iterator[ModelName]:
        return iter(next(iter(self.runs.values())))

    def __len__(self) -> int:
        return len(next(iter(self.runs.values())))


def response_of(structure: Structure, names: Sequence[ModelName], given: Scaled | None, asked: Question) -> Response:
    """Simulate models of a structure under a motion, or freely from a release, and return all results."""
    contacts = Contacts(structure.mechanism)
    follow = partial(respond, structure, models=names, release=asked.release, tail=asked.tail, rtol=asked.rtol)
    under = {sign: given.motion.scaled(sign * given.factor) if given is not None else None for sign in asked.signs}
    first = under[asked.signs[0]]
    fit: PulseFit | None = None
    if first is not None and asked.with_pulse is not None:
        fits = fit_pulses(first, tuple(FITTED) if asked.with_pulse == BEST else (asked.with_pulse,), ("velocity",))
        fit = max(fits, key=lambda one: one.captured)
    runs = {sign: follow(motion) for sign, motion in under.items()}
    best: ModelName = "nonlinear" if "nonlinear" in names else names[0]
    near = {
        sign: neighbours(
            structure.model(best),
            motion,
            asked.around,
            release=asked.release,
            release_is_angle=asked.release_is_angle,
            rtol=asked.rtol,
        )
        for sign, motion in under.items()
        if asked.around.count
    }
    checked = {sign: contacts.check(run["nonlinear"], under[sign]) for sign, run in runs.items() if "nonlinear" in run}
    if fit is None or first is None:
        return Response(given, first, runs, near, contacts=checked)
    pulse = fit.alone(first)
    alone = follow(pulse)
    checked_alone = contacts.check(alone["nonlinear"], pulse) if "nonlinear" in alone else None
    return Response(given, first, runs, near, fit, alone, checked, checked_alone)
