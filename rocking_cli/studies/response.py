"""The response of a structure to one ground motion: in both polarities, with neighbours, and to its pulse alone."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, field, replace
from functools import cached_property
from math import inf, isnan
from typing import TYPE_CHECKING

import numpy as np

from rocking_cli.dynamics.history import History
from rocking_cli.dynamics.model import MODELS, ModelName
from rocking_cli.dynamics.verdict import Agreement, agreements, remedy
from rocking_cli.errors import InputError, SolverError
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.processing.reading import Scaled
from rocking_cli.short_repr import short_repr
from rocking_cli.studies.conclusion import ByBlocks, Concluded, Conclusion, NeighbourShare, NextStep, are_alike, worst
from rocking_cli.studies.contact import ContactDemand, Contacts
from rocking_cli.studies.engines import follow
from rocking_cli.studies.neighbours import Conditions, Neighbours, neighbours

if TYPE_CHECKING:
    from rocking_cli.excitation.pulse_fit import PulseFit
    from rocking_cli.studies.both_engines import BothEngines

Histories = Mapping[ModelName, History]
Working = Callable[[str], AbstractContextManager[None]]
ByPolarity = Mapping[int, Histories]
"""Histories under each requested polarity, 1 or -1."""

# Word that requests the best-fitting pulse.
BEST_PULSE = "best"
MOST_UNASKED_STEPS = 650_000  # steps of free blocks, times their number, that each polarity takes without a request


def concluded(runs: ByPolarity, neighbours: Mapping[int, Neighbours], motion: str = "") -> Conclusion:
    """Return the conclusion on a structure under one motion: that of the worse polarity, by the best model.

    Of one degree of freedom and free blocks it is that of the former, with what the latter do beside it.

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
    return {sign: _of_runs(each, neighbours.get(sign), motion, sign) for sign, each in runs.items()}


def best_model(models: Collection[ModelName]) -> ModelName:
    """Return the model by which is concluded: the structure itself, then the first of its blocks."""
    return "nonlinear" if "nonlinear" in models else next(iter(models))


def _together(each: Mapping[int, Conclusion]) -> Conclusion:
    """Return the conclusion of the worse polarity; neither governs if both are alike."""
    governs = worst(each.values())
    alike = len(each) > 1 and all(are_alike(one, governs) for one in each.values())
    return replace(governs, polarity=None if alike else governs.polarity, polarities=list(each))


def _of_runs(runs: Histories, neighbours: Neighbours | None, motion: str, sign: int) -> Conclusion:
    run, blocks = runs[best_model(runs)], runs.get("blocks")
    what = _ending(run)
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
        blocks=None if blocks is None or run.by_blocks else _by_blocks(blocks),
    )


def _ending(run: History) -> Concluded:
    if run.unknown:
        return Concluded.UNKNOWN
    if run.fell:
        return Concluded.FALLS_OFF if run.off_edge else Concluded.OVERTURNS
    if run.by_blocks and run.still_rocking:  # one degree of freedom is certain not to overturn then
        return Concluded.STILL_MOVES
    if isnan(run.peak_ratio):
        return Concluded.COMES_TO_REST
    return Concluded.ROCKS if run.lifted else Concluded.SLIDES if run.slip else Concluded.NO_UPLIFT


def _by_blocks(run: History) -> ByBlocks:
    ratio = None if isnan(run.peak_ratio) else run.peak_ratio
    time = run.overturning_time if run.fell else run.end_time if run.still_rocking else None
    return ByBlocks(_ending(run), ratio, run.slip or None, time)


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
    engines : mapping of int to BothEngines
        The comparison of both engines, under each polarity with free blocks beside one degree of freedom.
    no_blocks : mapping of int to str
        Why free blocks did not go on where the outcome is unknown, under each polarity where this is so.
    """

    given: Scaled | None
    first: GroundMotion | None
    runs: ByPolarity
    neighbours: Mapping[int, Neighbours]
    contacts: Mapping[int, ContactDemand]
    fit: PulseFit | None = None
    to_pulse: Response | None = None
    engines: Mapping[int, BothEngines] = field(default_factory=dict)
    no_blocks: Mapping[int, str] = field(default_factory=dict)

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
        return {
            sign: agreements({name: run for name, run in each.items() if name != "blocks"})
            for sign, each in self.runs.items()
        }

    def assumed_friction(self, polarity: int) -> float | None:
        """Return the friction that the result assumes in a polarity, see `ContactDemand`."""
        return self.contacts[polarity].assumed_friction if polarity in self.contacts else None

    def __getitem__(self, model: ModelName) -> History:
        return next(iter(self.runs.values()))[model]

    def __iter__(self) -> Iterator[ModelName]:
        return iter(next(iter(self.runs.values())))

    def __len__(self) -> int:
        return len(next(iter(self.runs.values())))


def of_one_degree(conditions: Conditions, motion: GroundMotion | None = None) -> dict[ModelName, History]:
    """Simulate the models of one degree of freedom under a motion, or freely from a release, each by `follow`."""
    unknown = [name for name in conditions.models if name not in MODELS]
    if unknown or not conditions.models:
        raise InputError(f"models must be of {', '.join(MODELS)}, got {', '.join(unknown) or 'none'}")
    of = conditions
    return {
        name: follow(of.structure, motion, model=name, release=of.release, tail=of.tail, rtol=of.rtol)
        for name in of.models
    }


def histories(
    conditions: Conditions, motion: GroundMotion | None = None, working: Working = lambda what: nullcontext()
) -> tuple[Histories, BothEngines | None, str]:
    """Simulate one motion by the engines that are requested, or needed.

    Parameters
    ----------
    conditions : Conditions
        The structure and the conditions of the run.
    motion : GroundMotion, optional
        The motion, scaled and reversed; None for a release alone.
    working : callable
        Returns the context in which free blocks are simulated.

    Returns
    -------
    mapping of str to History
        History of each model, in their order; that of free blocks has the model "blocks".
    BothEngines or None
        The comparison of both engines, if both simulated the motion.
    str
        Why free blocks did not go on where the outcome is unknown; empty if they did, or need not.
    """
    structure, engine = conditions.structure, conditions.engine
    exact = of_one_degree(conditions, motion) if engine == "exact" or structure.no_model is None else {}
    nonlinear = exact.get("nonlinear")
    unknown = nonlinear is not None and nonlinear.unknown
    if (engine == "exact" and not (unknown and conditions.goes_on)) or (engine == "auto" and exact and not unknown):
        return exact, None, ""
    if nonlinear is not None and nonlinear.crushes and engine != "blocks":
        return exact, None, "free blocks cannot crush"
    if engine == "exact" and structure.restitution_source == "missing":
        return exact, None, ""  # free blocks would assume the rebound, which is not known
    from rocking_cli.studies.both_engines import compare
    from rocking_cli.studies.engines.free import Blocks, TooLong

    unasked = engine == "exact"
    most, tail = MOST_UNASKED_STEPS if unasked else inf, conditions.tail
    if nonlinear is not None:  # they are followed until they are at rest, and as long as what is known of the other
        last = float(nonlinear.time[np.isfinite(nonlinear.phi)][-1])
        tail = max(0.0, last - (motion.duration if motion is not None else 0.0))
    try:
        with working("simulating free blocks"):
            blocks, moved, free = Blocks().follow(
                structure, motion, release=conditions.release, tail=tail, most_steps=most
            )
    except (InputError, SolverError) as error:
        if not unasked:
            raise
        if isinstance(error, TooLong):
            return exact, None, f"free blocks take more than {most:,.0f} steps times blocks"
        return exact, None, f"free blocks fail: {error}" if isinstance(error, SolverError) else ""
    both = compare(structure.mechanism, nonlinear, blocks, moved, free) if nonlinear is not None else None
    return {**exact, "blocks": blocks}, both, ""


def response_of(
    conditions: Conditions, scaled: Scaled | None, working: Working = lambda what: nullcontext()
) -> Response:
    """Simulate models of a structure under a motion, or freely from a release, and return all results.

    Parameters are those of `histories`.
    """
    contacts = Contacts(conditions.structure.mechanism)
    under = {
        sign: scaled.motion.scaled(sign * scaled.factor) if scaled is not None else None for sign in conditions.signs
    }
    first = under[conditions.signs[0]]
    simulated = {sign: histories(conditions, motion, working) for sign, motion in under.items()}
    runs = {sign: each for sign, (each, _, _) in simulated.items()}
    neighbours_of = {sign: neighbours(conditions, motion) for sign, motion in under.items() if conditions.around.count}

    def checked(runs: ByPolarity, under: Mapping[int, GroundMotion | None]) -> dict[int, ContactDemand]:
        return {sign: contacts.check(run["nonlinear"], under[sign]) for sign, run in runs.items() if "nonlinear" in run}

    fit = to_pulse = None
    if first is not None and conditions.with_pulse is not None:
        from rocking_cli.excitation.pulse_fit import FITTED, fit_pulses

        shapes = tuple(FITTED) if conditions.with_pulse == BEST_PULSE else (conditions.with_pulse,)
        fit = max(fit_pulses(first, shapes, ("velocity",)), key=lambda one: one.captured)
        pulse = fit.alone(first)
        alone = {1: of_one_degree(conditions, pulse)}
        to_pulse = Response(given=None, first=pulse, runs=alone, neighbours={}, contacts=checked(alone, {1: pulse}))
    return Response(
        given=scaled, first=first, runs=runs, neighbours=neighbours_of, contacts=checked(runs, under), fit=fit,
        to_pulse=to_pulse, engines={sign: both for sign, (_, both, _) in simulated.items() if both is not None},
        no_blocks={sign: why for sign, (_, _, why) in simulated.items() if why},
    )  # fmt: skip
