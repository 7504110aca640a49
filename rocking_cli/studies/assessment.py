"""One structure under any number of ground motions: all that a report says of it, computed."""

from __future__ import annotations

import platform
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from hashlib import sha256
from importlib.metadata import version
from math import nan, pi

import numpy as np

from rocking_cli.core import Mechanism
from rocking_cli.core.registry import Registry
from rocking_cli.dynamics import ways
from rocking_cli.dynamics.history import History
from rocking_cli.dynamics.model import ModelName
from rocking_cli.dynamics.verdict import CLOSE, disagree, governs
from rocking_cli.engines import default_models, engine_of, respond
from rocking_cli.errors import InputError, SolverError
from rocking_cli.excitation.base import STANDARD_GRAVITY, Doubt, GroundMotion
from rocking_cli.excitation.doubts import coarse_for, doubts
from rocking_cli.excitation.measures import Measures, measure
from rocking_cli.excitation.pulse_fit import PulseFit, fit_pulses
from rocking_cli.excitation.pulses import Pulse
from rocking_cli.excitation.records.opening import name_of, original
from rocking_cli.excitation.scaled import Scaled
from rocking_cli.structure import Structure
from rocking_cli.studies.contact import ContactDemand, Contacts
from rocking_cli.studies.linearisation import Linearisation, compare
from rocking_cli.studies.margin import LEVELS, Margin, margin
from rocking_cli.studies.neighbours import Neighbourhood, Neighbours, neighbours
from rocking_cli.studies.overturning import OverturningMap, Region, overturning_map
from rocking_cli.studies.picture import Picture, picture
from rocking_cli.studies.trust import trust
from rocking_cli.studies.under_pulses import PulsedModel, outcomes, parse_shape, pulsed_model

AMPLITUDES, ACCELERATIONS = (0.25, 0.5, 0.75), (1.5, 2.0, 4.0)  # at which the error of the block is said
FITTED = ("sine", "ricker")  # the pulses with an amplitude and a period and nothing else: a map has these two axes
LARGE = 2.0  # a factor on a record that asks for a word of caution
NEAR = 1.25  # a factor on the motion within which the opposite outcome of some neighbours makes a result a close one
POINTS = 80  # of each side of a map
OMEGAS, TALLEST = (1.0, 10.0), 10.0  # omega_g/p of a map, and a_g/(g lambda) up to which it goes at least
BEYOND = 1.15  # times a mark, that a map goes further
PACKAGES = ("numpy", "scipy", "matplotlib")


@dataclass(frozen=True)
class File:
    """An input as the user gave it: its name, what is in it, and the name by which its content can be checked."""

    name: str
    content: bytes

    @property
    def checksum(self) -> str:
        """SHA-256, in hexadecimal."""
        return sha256(self.content).hexdigest()

    @property
    def text(self) -> str:
        """The content as text."""
        return self.content.decode("utf-8", errors="replace")


@dataclass(frozen=True)
class TitleBlock:
    """What stands beside the answer: for whom, by whom and how it was made.

    Parameters
    ----------
    command, date : str
        What wrote it, and when.
    project, place, author : str, optional
        As the reader knows them.
    logo : str, optional
        The address of a picture to show at the head.
    """

    command: str
    date: str
    project: str | None = None
    place: str | None = None
    author: str | None = None
    logo: str | None = None

    @property
    def known(self) -> dict[str, str]:
        """What was given of project, place and author."""
        given = {"project": self.project, "place": self.place, "author": self.author}
        return {name: text for name, text in given.items() if text}


@dataclass(frozen=True, eq=False)
class MotionResult:
    """A ground motion and what it does.

    Parameters
    ----------
    given : Scaled
        The motion as read, or the sampled pulse, and the factor on it.
    file : File or None
        Where it was read; None for a pulse.
    measured : Measures
        Of the motion as scaled, on the floor if there is one.
    doubts : tuple of Doubt
        About the motion as read.
    runs : mapping of int to mapping of str to History
        The histories of each model under each polarity looked at.
    polarity : int
        The one that governs.
    governs : str
        A sentence on that; empty if one polarity was looked at.
    neighbours : mapping of int to Neighbours
        What became of the neighbours of the motion under each polarity, by the nonlinear model.
    margin : Margin
        How far the motion is from lifting and overturning the structure.
    fits : tuple of PulseFit
        The pulses in it, the best first; of a pulse itself.
    alone : float or None
        What the best pulse alone does: the peak ratio, NaN if it overturns; None if there is no pulse.
    contacts : mapping of int to ContactDemand
        What the nonlinear history asks of the contacts, under each polarity.
    alone_unknown : bool
        Whether the outcome under that pulse is unknown: the ratio is then that up to where it is known.
    """

    given: Scaled
    file: File | None
    measured: Measures
    doubts: tuple[Doubt, ...]
    runs: Mapping[int, Mapping[ModelName, History]]
    polarity: int
    governs: str
    neighbours: Mapping[int, Neighbours]
    margin: Margin
    fits: tuple[PulseFit, ...]
    alone: float | None
    contacts: Mapping[int, ContactDemand]
    alone_unknown: bool = False

    @property
    def motion(self) -> GroundMotion:
        """The motion as it governs: scaled, and reversed if that is the worse."""
        return self.scaled(self.polarity)

    def scaled(self, polarity: int) -> GroundMotion:
        """The motion as scaled, under the name it was given."""
        return replace(self.given.motion.scaled(polarity * self.given.factor), name=self.given.motion.name)

    @property
    def pga_of_ground(self) -> float:
        """Peak acceleration of the ground as scaled [standard gravity], below the floor if there is one."""
        return abs(self.given.factor) * self.given.motion.of_ground.pga_g

    @property
    def scaled_much(self) -> bool:
        """Whether the motion was made larger than any like it has been recorded."""
        return abs(self.given.factor) > LARGE

    @property
    def close(self) -> bool:
        """Whether a small change of the motion or the model could give the other outcome, if this one is known."""
        best = self.histories["nonlinear"]
        if best.unknown:
            return False
        if disagree(self.histories) or self.neighbours[self.polarity].sensitive or best.peak_ratio > CLOSE:
            return True
        near = (self.margin.factors > 1 / NEAR) & (self.margin.factors < NEAR)
        falls, may_fall = self.margin.overturned[near], self.margin.at_most[near]
        return bool((falls < LEVELS[-1]).any() if best.overturned else (may_fall >= LEVELS[0]).any())

    @property
    def unknown(self) -> bool:
        """Whether the outcome is unknown under the polarity that governs, and overturns it under none."""
        return self.histories["nonlinear"].unknown

    @property
    def histories(self) -> Mapping[ModelName, History]:
        """The histories of the polarity that governs."""
        return self.runs[self.polarity]


@dataclass(frozen=True, eq=False)
class PulseMap:
    """What pulses of one shape do, with the places of the ground motions on it.

    Parameters
    ----------
    found : OverturningMap
        The map, by the nonlinear model, of the worse polarity.
    marks : tuple of (str, PulseFit)
        Name of each motion whose pulse has this shape, and the pulse.
    """

    found: OverturningMap
    marks: tuple[tuple[str, PulseFit], ...]


@dataclass(frozen=True, eq=False)
class Assessment:
    """Everything a report says.

    Parameters
    ----------
    structure : Structure
        The structure.
    file : File
        Where it was read.
    picture : Picture
        What it looks like.
    curves, asked : tuple of Linearisation
        The error of the equivalent block over its range, and at the amplitudes given in numbers; empty if it has none.
    trust : str
        What that means, or why there is none.
    results : tuple of MotionResult
        What each ground motion does.
    maps : tuple of PulseMap
        One for each shape of pulse; empty if no history can be computed, or no block is equivalent.
    title : TitleBlock
        For whom, by whom and how it was made.
    versions : mapping of str to str
        Of the software.
    """

    structure: Structure
    file: File
    picture: Picture
    curves: tuple[Linearisation, ...]
    asked: tuple[Linearisation, ...]
    trust: str
    results: tuple[MotionResult, ...]
    maps: tuple[PulseMap, ...]
    title: TitleBlock
    versions: Mapping[str, str]

    @property
    def mechanism(self) -> Mechanism:
        """The structure."""
        return self.structure.mechanism

    @property
    def has_block(self) -> bool:
        """Whether a single block is equivalent to it."""
        return self.structure.why_no_block is None

    @property
    def name(self) -> str:
        """What the structure is called."""
        return self.structure.name


def gather(
    structure: Structure,
    file: File,
    given: Sequence[Scaled],
    polarities: Sequence[int],
    *,
    title: TitleBlock,
    around: Neighbourhood | None = None,
    progress: Callable[[int], None] | None = None,
) -> Assessment:
    """Compute everything a report says.

    Parameters
    ----------
    structure : Structure
        The structure.
    file : File
        Where it was read.
    given : sequence of Scaled
        The ground motions; may be empty.
    polarities : sequence of int
        Of 1 and -1: those of the motions to look at.
    title : TitleBlock
        For whom, by whom and how it is made.
    around : Neighbourhood, optional
        How to draw the neighbours of a motion, at least one.
    progress : callable, optional
        Called with the number of steps done since the last call, of `steps(given)`.

    Raises
    ------
    RockingError
        Whatever the studies raise.
    """
    done = progress or (lambda count: None)
    mechanism = structure.mechanism
    curves, asked, said = _error_of_block(structure)
    done(1)
    results = []
    for each in given:
        results.append(_result(structure, each, polarities, around or Neighbourhood()))
        done(1)
    maps = _maps(structure, results)
    done(1)
    return Assessment(
        structure=structure,
        file=file,
        picture=picture(mechanism),
        curves=tuple(curves),
        asked=tuple(asked),
        trust=said,
        results=tuple(results),
        maps=tuple(maps),
        title=title,
        versions=versions(mechanism),
    )


def _error_of_block(structure: Structure) -> tuple[Sequence[Linearisation], Sequence[Linearisation], str]:
    """The error of the equivalent block over its range and at some places, and what it means."""
    if structure.why_no_block is not None:
        why = structure.why_no_block.removeprefix(f"{structure.name}: ")
        return [], [], f"No equivalent block exists here, so there is no error to report: {why}."
    if (refused := structure.refuses("linear models")) is not None:
        return [], [], f"The error of the equivalent block is left out: {refused}."
    try:
        curves, asked = compare(structure, AMPLITUDES, ACCELERATIONS)
        return curves, asked, trust(curves, asked)
    except SolverError as error:  # the rest of the report stands without it
        return [], [], f"The error of the equivalent block is left out: {error}."


def versions(mechanism: Mechanism) -> dict[str, str]:
    """Of this package, of what a mechanism comes from, and of what it is computed with."""
    return {
        "rocking-cli": version("rocking-cli"),
        f"mechanism {mechanism.mechanism}": _plugin(mechanism),
        "Python": platform.python_version(),
        **{name: version(name) for name in PACKAGES},
        **ways.versions(),
    }


def steps(given: Sequence[Scaled]) -> int:
    """How many steps `gather` takes."""
    return len(given) + 2


def _plugin(mechanism: Mechanism) -> str:
    registry = Registry()
    return registry.package_of(mechanism.mechanism) if mechanism.mechanism in registry else "not installed as a plugin"


def _result(structure: Structure, given: Scaled, polarities: Sequence[int], around: Neighbourhood) -> MotionResult:
    ground = given.motion.of_ground
    found = [] if given.pulse is not None else doubts(ground, measure(ground))
    doubtful = [*found, *(coarse_for(given.motion, structure.p) if given.pulse is None else [])]
    under = {sign: given.motion.scaled(sign * given.factor) for sign in polarities}
    names, model = default_models(structure), structure.model("nonlinear")
    runs = {sign: respond(structure, motion, models=names) for sign, motion in under.items()}
    contacts = Contacts(structure.mechanism)
    worse, said = governs(runs) if len(runs) > 1 else (polarities[0], "")
    doubtful_signs = [sign for sign in polarities if runs[sign]["nonlinear"].unknown]
    scaled = given.motion.scaled(given.factor)
    fits = _fits(given, scaled)
    alone, alone_unknown = _alone(structure, fits[0], polarities) if fits else (None, False)
    return MotionResult(
        given=given,
        file=file_of_motion(given),
        measured=measure(scaled),
        doubts=tuple(doubtful),
        runs=runs,
        polarity=worse or [*doubtful_signs, *polarities][0],
        governs=said,
        neighbours={sign: neighbours(model, motion, around) for sign, motion in under.items()},
        margin=margin(model, scaled, polarities, around=around),
        fits=fits,
        alone=alone,
        contacts={sign: contacts.check(run["nonlinear"], under[sign]) for sign, run in runs.items()},
        alone_unknown=alone_unknown,
    )


def file_of_motion(given: Scaled) -> File | None:
    """Where a ground motion was read; None of a pulse."""
    return None if given.file is None else File(name_of(str(given.file)), original(str(given.file)))


def _fits(given: Scaled, scaled: GroundMotion) -> tuple[PulseFit, ...]:
    """The pulses in a motion as scaled, the best first: none in one too short or too quiet for any."""
    if given.pulse is not None:
        pulse = replace(given.pulse, amplitude=given.pulse.amplitude * abs(given.factor))
        return (PulseFit(pulse, 0.0, 1 if given.factor > 0 else -1, "acceleration", 1.0),)
    try:
        fits = list(fit_pulses(scaled, FITTED, ("velocity",)))
    except InputError:
        return ()
    return tuple(sorted(fits, key=lambda fit: -fit.captured))


def _alone(structure: Structure, fit: PulseFit, polarities: Sequence[int]) -> tuple[float, bool]:
    """The largest peak ratio under a pulse, NaN if it overturns, and whether the outcome is unknown."""
    if structure.why_no_block or structure.refuses("sizes"):  # nothing measures a pulse here
        alone, engine = fit.pulse.sampled(), engine_of(structure)
        runs = [engine.follow(structure, alone.scaled(polarity * fit.sign)) for polarity in polarities]
        if any(run.overturned for run in runs):
            return nan, False
        return max(run.peak_ratio for run in runs), any(run.unknown for run in runs)
    shape = _shape(fit.pulse)
    under = pulsed_model(structure, "nonlinear", shape, (1, -1))
    signs = [polarity * fit.sign for polarity in polarities]
    period, amplitude = np.array([fit.pulse.period]), np.array([fit.pulse.amplitude])
    found = outcomes(under, shape, period, amplitude, polarities=signs)
    return float(found.peak_ratio[0]), bool(found.unknown[0])


def _shape(pulse: Pulse) -> Pulse:
    return replace(pulse, amplitude=1.0, period=1.0)


def _maps(structure: Structure, results: Sequence[MotionResult]) -> list[PulseMap]:
    """A map for each shape among the best pulses; of the sine if there is none."""
    if structure.why_no_block or structure.refuses("sizes") or min(structure.etas) <= 0:
        return []  # nothing measures a pulse here, or no history can be computed
    marks: dict[Pulse, list[tuple[str, PulseFit]]] = {}
    for result in results:
        if result.fits:
            best = result.fits[0]
            marks.setdefault(_shape(best.pulse), []).append((result.given.motion.name, best))
    marks = marks or {parse_shape("sine"): []}
    return [PulseMap(_map(structure, shape, each), tuple(each)) for shape, each in marks.items()]


def _map(structure: Structure, shape: Pulse, marks: Sequence[tuple[str, PulseFit]]) -> OverturningMap:
    under = pulsed_model(structure, "nonlinear", shape, (1, -1))
    periods, tops = _axes(under, [fit.pulse for _, fit in marks])
    omega = under.period(np.linspace(*periods, POINTS))
    a = np.linspace(tops / POINTS, tops, POINTS)
    return overturning_map(under, shape, omega, a, polarities=(1, -1))


def _axes(structure: PulsedModel, pulses: Sequence[Pulse]) -> tuple[tuple[float, float], float]:
    """Periods [s] and the largest a, so that all pulses are on the map."""
    usual = [2 * pi / (omega * structure.p) for omega in OMEGAS]
    periods = [*usual, *(each.period / BEYOND for each in pulses), *(each.period * BEYOND for each in pulses)]
    strongest = max([TALLEST, *(BEYOND * each.amplitude / structure.unit for each in pulses)])
    return (min(periods), max(periods)), strongest


def amplitude_in_g(fit: PulseFit) -> float:
    """a_p of a fitted pulse [standard gravity]."""
    return fit.pulse.amplitude / STANDARD_GRAVITY


def share(found: OverturningMap) -> float:
    """The part of a map that overturns."""
    return sum(found.shares[region] for region in (Region.AFTER_IMPACT, Region.WITHOUT_IMPACT))
