"""The assessment of one structure under any number of ground motions: all results that a report shows."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from rocking_cli.core import Mechanism
from rocking_cli.dynamics.history import History
from rocking_cli.dynamics.model import ModelName
from rocking_cli.dynamics.verdict import NEAR_OVERTURNING, disagree
from rocking_cli.errors import InputError, SolverError
from rocking_cli.excitation.base import STANDARD_GRAVITY, Doubt, GroundMotion
from rocking_cli.excitation.doubts import coarse_for, doubts
from rocking_cli.excitation.measures import Measures, measure
from rocking_cli.excitation.pulse_fit import PulseFit, fit_pulses
from rocking_cli.processing.reading import Scaled
from rocking_cli.questions.error.study import Linearisation, compare
from rocking_cli.questions.margin.study import SHARE_LEVELS, Margin, margin
from rocking_cli.questions.overturning.study import OverturningMap, overturning_map, usual_amplitudes, usual_periods
from rocking_cli.short_repr import short_repr
from rocking_cli.structure import Structure
from rocking_cli.studies.conclusion import Conclusion, worst
from rocking_cli.studies.neighbours import Conditions
from rocking_cli.studies.picture import Picture, picture
from rocking_cli.studies.provenance import File, TitleBlock, file_of_motion, versions
from rocking_cli.studies.response import Response, of_one_degree, response_of
from rocking_cli.studies.under_pulses import parse_shape, pulsed_model

# Values of phi/phi_cr, and multiples of the uplift acceleration, at which errors of the block are stated.
ERROR_AMPLITUDES, ERROR_ACCELERATIONS = (0.25, 0.5, 0.75), (1.5, 2.0, 4.0)
FITTED_PULSES = ("sine", "ricker")  # those whose only parameters are the two axes of a map, amplitude and period
MIN_CAUTIONED_FACTOR = 2.0  # scale factor on a record, above which a report has a caution
MAX_CLOSE_FACTOR = 1.25  # factor on the motion: a result is close if neighbours within it have the opposite outcome
SURE_SHARE = 0.95  # share of neighbours of one outcome from which that outcome is not close to another
MAP_POINTS, MAP_SHAPE = 256, "sine"  # points along each side of the map, and the shape of its pulses


@short_repr
@dataclass(frozen=True, eq=False, kw_only=True)
class MotionResult(Response):
    """A ground motion and the response of the structure to it, and to its best pulse, with all that a report shows.

    Parameters
    ----------
    file : File or None
        File of the record; None for a pulse.
    measured : Measures
        Intensity measures of the scaled motion, on the floor if the structure stands on one.
    doubts : tuple of Doubt
        Doubtful properties of the motion as read.
    margin : Margin
        The scale factors at which the motion uplifts and overturns the structure.
    fits : tuple of PulseFit
        The pulses fitted to the motion, the best first; a motion that is a pulse has this pulse alone.
    """

    given: Scaled
    file: File | None
    measured: Measures
    doubts: tuple[Doubt, ...]
    margin: Margin
    fits: tuple[PulseFit, ...]

    @property
    def polarity(self) -> int:
        """The polarity that governs; the first one if none does."""
        return self.conclusion.polarity or next(iter(self.runs))

    @property
    def motion(self) -> GroundMotion:
        """The scaled motion in the polarity that governs."""
        return self.scaled(self.polarity)

    def scaled(self, polarity: int) -> GroundMotion:
        """Return the scaled motion in one polarity, under the name of the motion as given."""
        return replace(self.given.motion.scaled(polarity * self.given.factor), name=self.given.motion.name)

    @property
    def pga_of_ground(self) -> float:
        """Peak acceleration of the scaled ground motion, below the floor if there is one [standard gravity]."""
        return abs(self.given.factor) * self.given.motion.of_ground.pga_g

    @property
    def scaled_much(self) -> bool:
        """Whether the scale factor exceeds `MIN_CAUTIONED_FACTOR` in size, for which a report has a caution."""
        return abs(self.given.factor) > MIN_CAUTIONED_FACTOR

    @property
    def decisive(self) -> bool:
        """Whether nearly all neighbours have the same outcome."""
        around = self.neighbours[self.polarity]
        return around.overturned >= SURE_SHARE or around.at_most <= 1 - SURE_SHARE

    @property
    def close(self) -> bool:
        """Whether the outcome is known, and a small change of the motion or of the model could give another outcome."""
        best = self.histories["nonlinear"]
        if best.unknown or (best.fell and self.neighbours[self.polarity].overturned >= SURE_SHARE):
            return False
        alike = self.neighbours[self.polarity].sensitive is False
        if disagree(self.histories) or not alike or best.peak_ratio > NEAR_OVERTURNING:
            return True
        close = (self.margin.factors > 1 / MAX_CLOSE_FACTOR) & (self.margin.factors < MAX_CLOSE_FACTOR)
        falls, may_fall = self.margin.overturned[close], self.margin.at_most[close]
        return bool((falls < SHARE_LEVELS[-1]).any() if best.fell else (may_fall >= SHARE_LEVELS[0]).any())

    @property
    def unknown(self) -> bool:
        """Whether the outcome in the governing polarity is unknown; no polarity overturns the structure then."""
        return self.histories["nonlinear"].unknown

    @property
    def histories(self) -> Mapping[ModelName, History]:
        """The histories of the polarity that governs."""
        return self.runs[self.polarity]


@short_repr
@dataclass(frozen=True, eq=False)
class PulseMap:
    """Overturning map of sine pulses, with those in the ground motions marked on it.

    Parameters
    ----------
    found : OverturningMap
        The map, by the equivalent block with kappa2.
    marks : tuple of (str, PulseFit)
        Name of each motion whose sine pulse is on the map, and the pulse.
    outside : sequence of str
        Names of the motions whose sine pulse is not on the map.
    """

    found: OverturningMap
    marks: tuple[tuple[str, PulseFit], ...]
    outside: Sequence[str] = ()


@short_repr
@dataclass(frozen=True, eq=False)
class Assessment:
    """All results that a report shows.

    Parameters
    ----------
    conditions : Conditions
        The structure and the conditions of the runs.
    file : File
        The file of the structure.
    picture : Picture
        The drawing of the structure.
    curves, asked : tuple of Linearisation
        Error of the equivalent block over the whole range, and at the amplitudes of the table; empty if there is none.
    no_error : str
        Why there is no such error; empty if there is one.
    results : tuple of MotionResult
        The response to each ground motion.
    map : PulseMap or None
        The map of pulses; None if no history can be computed, or no equivalent block represents the structure.
    title : TitleBlock
        The heading of the report.
    versions : mapping of str to str
        Versions of the software, by package.
    """

    conditions: Conditions
    file: File
    picture: Picture
    curves: tuple[Linearisation, ...]
    asked: tuple[Linearisation, ...]
    no_error: str
    results: tuple[MotionResult, ...]
    map: PulseMap | None
    title: TitleBlock
    versions: Mapping[str, str]

    @property
    def conclusion(self) -> Conclusion | None:
        """The worst conclusion of all motions; None without a motion."""
        if not self.results:
            return None
        each = [result.conclusion for result in self.results]
        return replace(worst(each), motions=[one.motion for one in each])

    @property
    def structure(self) -> Structure:
        """The structure, as the runs have it."""
        return self.conditions.structure

    @property
    def mechanism(self) -> Mechanism:
        """The mechanism of the structure."""
        return self.structure.mechanism

    @property
    def has_block(self) -> bool:
        """Whether the structure has an equivalent block."""
        return self.structure.why_no_block is None

    @property
    def name(self) -> str:
        """Name of the structure."""
        return self.structure.name


def gather(
    conditions: Conditions,
    file: File,
    given: Sequence[Scaled],
    *,
    title: TitleBlock,
    progress: Callable[[int], None] | None = None,
) -> Assessment:
    """Compute all results that a report shows.

    Parameters
    ----------
    conditions : Conditions
        The structure, the polarities to simulate, and how to draw the neighbours of each motion, at least one.
    file : File
        The file of the structure.
    given : sequence of Scaled
        The ground motions; may be empty.
    title : TitleBlock
        The heading of the report.
    progress : callable, optional
        Called with the number of steps done since the last call; there are two more than motions.

    Raises
    ------
    RockingError
        Any error that the studies raise.
    """
    done = progress or (lambda count: None)
    structure, mechanism = conditions.structure, conditions.structure.mechanism
    curves, marks, why = _error_of_block(structure)
    done(1)
    results = []
    for each in given:
        results.append(_result(conditions, each))
        done(1)
    pulse_map = _map(structure, results)
    done(1)
    return Assessment(
        conditions=conditions,
        file=file,
        picture=picture(mechanism),
        curves=tuple(curves),
        asked=tuple(marks),
        no_error=why,
        results=tuple(results),
        map=pulse_map,
        title=title,
        versions=versions(mechanism),
    )


def _error_of_block(structure: Structure) -> tuple[Sequence[Linearisation], Sequence[Linearisation], str]:
    """Return the error of the equivalent block over its range and at some amplitudes, or why it does not exist."""
    if why := structure.why_no_block or structure.refuses("linear models"):
        return [], [], why.removeprefix(f"{structure.name}: ")
    try:
        return *compare(structure, ERROR_AMPLITUDES, ERROR_ACCELERATIONS), ""
    except SolverError as error:  # the rest of the report does not need it
        return [], [], str(error)


def _result(conditions: Conditions, given: Scaled) -> MotionResult:
    ground = given.motion.of_ground
    doubtful = [] if given.pulse is not None else doubts(ground, measure(ground))
    doubtful = [*doubtful, *(coarse_for(given.motion, conditions.structure.p) if given.pulse is None else [])]
    response, alike = response_of(conditions, given), replace(conditions, models=["nonlinear"])
    scaled = given.motion.scaled(given.factor)
    fits = _fits(given, scaled)
    if fits:
        alone = fits[0].alone(scaled)
        runs = {sign: of_one_degree(alike, alone.scaled(sign)) for sign in alike.signs}
        response = replace(response, to_pulse=Response(given=None, first=alone, runs=runs, neighbours={}, contacts={}))
    return MotionResult(
        **vars(response),
        file=file_of_motion(given),
        measured=measure(scaled),
        doubts=tuple(doubtful),
        margin=margin(alike, scaled),
        fits=fits,
    )


def _fits(given: Scaled, scaled: GroundMotion) -> tuple[PulseFit, ...]:
    """Return the pulses fitted to a scaled motion, the best first; none if it is too short or too weak to be fitted."""
    if given.pulse is not None:
        pulse = replace(given.pulse, amplitude=given.pulse.amplitude * abs(given.factor))
        return (PulseFit(pulse, 0.0, 1 if given.factor > 0 else -1, "acceleration", 1.0),)
    try:
        fits = list(fit_pulses(scaled, FITTED_PULSES, ("velocity",)))
    except InputError:
        return ()
    return tuple(sorted(fits, key=lambda fit: -fit.captured))


def _map(structure: Structure, results: Sequence[MotionResult]) -> PulseMap | None:
    """Return the map that `rocking overturning` draws by default; None without a block that represents the structure.

    The best-fitting sine pulses of the motions are marked, if they are on it.
    """
    if structure.why_no_block or structure.misleading or structure.refuses("sizes") or min(structure.etas) <= 0:
        return None
    shape = parse_shape(MAP_SHAPE)
    under = pulsed_model(structure, "linear2", shape)
    periods = np.geomspace(*usual_periods([under], shape), MAP_POINTS)
    amplitudes = np.geomspace(*usual_amplitudes([under]), MAP_POINTS) * STANDARD_GRAVITY / under.unit
    simulated = overturning_map(under, shape, under.period(periods), amplitudes)
    sines = [
        (each.given.motion.name, fit) for each in results for fit in each.fits if fit.pulse.name == MAP_SHAPE
    ]  # fmt: skip
    marks = [
        (name, fit) for name, fit in sines
        if periods[0] <= fit.pulse.period <= periods[-1]
        and amplitudes[0] <= fit.pulse.amplitude / under.unit <= amplitudes[-1]
    ]  # fmt: skip
    on_map = {name for name, _ in marks}
    return PulseMap(simulated, tuple(marks), [name for name, _ in sines if name not in on_map])


def amplitude_in_g(fit: PulseFit) -> float:
    """Return the amplitude a_p of a fitted pulse [standard gravity]."""
    return fit.pulse.amplitude / STANDARD_GRAVITY
