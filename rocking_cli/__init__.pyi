"""Written by `make pages`: do not edit."""

from collections.abc import Mapping as Mapping
from collections.abc import Sequence as Sequence
from distributed import Client as Client
from mechanisms.arch import Arch as Arch
from mechanisms.assembly import Assembly as Assembly
from mechanisms.asymmetric_frame import AsymmetricFrame as AsymmetricFrame
from mechanisms.block import Block as Block
from mechanisms.cone import Cone as Cone
from mechanisms.curve import Curve as Curve
from mechanisms.linkage import Linkage as Linkage
from mechanisms.point_mass import PointMass as PointMass
from mechanisms.rigid_body import RigidBody as RigidBody
from mechanisms.spanning_wall import SpanningWall as SpanningWall
from mechanisms.symmetric_frame import SymmetricFrame as SymmetricFrame
from mechanisms.wall import Wall as Wall
from numpy.typing import ArrayLike as ArrayLike
from pathlib import Path as Path
from rocking_cli.ask.answer import Answer as Answer
from rocking_cli.ask.answer import Answers as Answers
from rocking_cli.ask.answer import MappingAnswer as MappingAnswer
from rocking_cli.ask.ground_motions import Motion as Motion
from rocking_cli.ask.ground_motions import Motions as Motions
from rocking_cli.ask.groups import ModelName as ModelName
from rocking_cli.ask.inputs import SiteLike as SiteLike
from rocking_cli.ask.inputs import StructureLike as StructureLike
from rocking_cli.ask.watcher import Watcher as Watcher
from rocking_cli.core import Body as Body
from rocking_cli.core import CollapseMechanism as CollapseMechanism
from rocking_cli.core import Direction as Direction
from rocking_cli.core import Equivalence as Equivalence
from rocking_cli.core import EquivalentBlock as EquivalentBlock
from rocking_cli.core import Mechanism as Mechanism
from rocking_cli.core import RigidMotion as RigidMotion
from rocking_cli.core.equivalence import NoEquivalentBlock as NoEquivalentBlock
from rocking_cli.core.registry import Registry as Registry
from rocking_cli.core.structure_file import load_structure as load_structure
from rocking_cli.dynamics.exact import ExactResponse as ExactResponse
from rocking_cli.dynamics.exact import closed_form as closed_form
from rocking_cli.dynamics.history import History as History
from rocking_cli.dynamics.outcome import Outcome as Outcome
from rocking_cli.errors import DoubtWarning as DoubtWarning
from rocking_cli.errors import InputError as InputError
from rocking_cli.errors import MechanismError as MechanismError
from rocking_cli.errors import Problem as Problem
from rocking_cli.errors import RockingError as RockingError
from rocking_cli.errors import SolverError as SolverError
from rocking_cli.excitation.base import GroundMotion as GroundMotion
from rocking_cli.excitation.measures import Measures as Measures
from rocking_cli.excitation.measures import measure as measure
from rocking_cli.excitation.pulse_fit import PulseFit as PulseFit
from rocking_cli.excitation.pulse_fit import fit_pulse as fit_pulse
from rocking_cli.excitation.pulses import Pulse as Pulse
from rocking_cli.excitation.pulses import parse_pulse as parse_pulse
from rocking_cli.excitation.records.record_units import Gain as Gain
from rocking_cli.processing.intensity import Measure as Measure
from rocking_cli.processing.intensity import MotionMeasure as MotionMeasure
from rocking_cli.processing.intensity import RelativeMeasure as RelativeMeasure
from rocking_cli.processing.intensity import RunMeasure as RunMeasure
from rocking_cli.processing.intensity import parse_measure as parse_measure
from rocking_cli.processing.oscillator import Floor as Floor
from rocking_cli.processing.oscillator import ResponseSpectrum as ResponseSpectrum
from rocking_cli.processing.reading import turned as turned
from rocking_cli.processing.steps import Step as Step
from rocking_cli.questions.animate.verb import Animation as Animation
from rocking_cli.questions.building.study import Assessed as Assessed
from rocking_cli.questions.calibrate.study import Trace as Trace
from rocking_cli.questions.calibrate.study import TraceFit as TraceFit
from rocking_cli.questions.demand.view import SpectraOfSite as SpectraOfSite
from rocking_cli.questions.design.study import Aim as Aim
from rocking_cli.questions.design.study import Design as Design
from rocking_cli.questions.design.study import Span as Span
from rocking_cli.questions.equivalent_pulses.verb import EquivalentResponses as EquivalentResponses
from rocking_cli.questions.error.study import Linearisation as Linearisation
from rocking_cli.questions.explore.study import Exploration as Exploration
from rocking_cli.questions.fragility.asked import Shaken as Shaken
from rocking_cli.questions.fragility.asked import Shaking as Shaking
from rocking_cli.questions.fragility.own_data import FittedFragility as FittedFragility
from rocking_cli.questions.fragility.results import StudyAnswer as StudyAnswer
from rocking_cli.questions.import_drawing.study import Imported as Imported
from rocking_cli.questions.import_mesh.study import ImportedMesh as ImportedMesh
from rocking_cli.questions.margin.study import Margin as Margin
from rocking_cli.questions.margin.verb import OutcomeShares as OutcomeShares
from rocking_cli.questions.overturning.asked import Range as Range
from rocking_cli.questions.overturning.study import Comparison as Comparison
from rocking_cli.questions.overturning.study import OverturningMap as OverturningMap
from rocking_cli.questions.record.verb import RecordAnswer as RecordAnswer
from rocking_cli.questions.report.study import Assessment as Assessment
from rocking_cli.questions.respond.azimuths import AzimuthResponses as AzimuthResponses
from rocking_cli.questions.respond.each_verb import EachAnswer as EachAnswer
from rocking_cli.questions.respond.motion_verbs import correct as correct
from rocking_cli.questions.respond.motion_verbs import on_floor as on_floor
from rocking_cli.questions.respond.verb import ResponseAnswer as ResponseAnswer
from rocking_cli.questions.select.study import RecordSet as RecordSet
from rocking_cli.questions.select.target_spectrum import TargetSpectrum as TargetSpectrum
from rocking_cli.questions.selfcheck import study as study
from rocking_cli.questions.spectrum.study import Spectrum as Spectrum
from rocking_cli.questions.survey.structure_table import StructureTable as StructureTable
from rocking_cli.questions.survey.study import Survey as Survey
from rocking_cli.studies.neighbours import Release as Release
from rocking_cli.verification.results import Verification as Verification
from typing import Any as Any
from typing import Literal as Literal
from typing import overload as overload

def read_record(
    path: str | Path,
    *,
    units: str | None = ...,
    dt: float | str | None = ...,
    channel: str | int | None = ...,
    quantity: Literal["acceleration", "velocity", "displacement"] | None = ...,
    gain: Gain | str | None = ...,
    run_on: bool | None = ...,
    despite_header: bool | None = ...,
    other: str | Path | None = ...,
    other_channel: str | int | None = ...,
    azimuth: float | str | None = ...,
    floor: Floor | str | Mapping[str, Any] | None = ...,
    baseline: Step | str | None = ...,
    highpass: Step | str | float | None = ...,
    lowpass: Step | str | float | None = ...,
    taper: Step | str | float | None = ...,
    trim: Step | str | None = ...,
    resample: Step | str | float | None = ...,
    watch: Watcher = ...,
) -> GroundMotion:
    """Read a recorded ground motion, and correct it; the format is found from the content, not from the file's name.

    Corrections are made in the order in which they are given.

    Parameters
    ----------
    path : str | Path
        A file in the format of a data centre, of any reader of the entry points `rocking.records`, or delimited text: a
        column of accelerations, or several, with or without the time. It may be compressed (gzip), or a file in a zip
        archive. `-` is standard input, which can be read once.
    units : str | None, optional
        Unit of the record, if the file does not state it.
    dt : float | str | None, optional
        Sampling interval in s, if the file has no times.
    channel : str | int | None, optional
        Channel or column to read: its number, from 1, or its name.
    quantity : Literal["acceleration", "velocity", "displacement"] | None, optional
        Quantity in the record; velocities and displacements are differentiated.
    gain : Gain | str | None, optional
        Instrument sensitivity: the value of one unit of the record, such as 0.05m/V or 4.7e-6m/s2/count.
    run_on : bool | None, optional
        Read a text without times as one series that runs on over its rows.
    despite_header : bool | None, optional
        Accept a text with other numbers of points or peaks than its header states, as it was cut on purpose.
    other : str | Path | None, optional
        Second horizontal component, perpendicular to the record; the two are rotated into the plane of the structure.
    other_channel : str | int | None, optional
        Channel of the second component in its file.
    azimuth : float | str | None, optional
        Azimuth of the structure's plane, in degrees: 0 is the record, 90 the second. `respond` also accepts all.
    floor : Floor | str | Mapping[str, Any] | None, optional
        Floor of a building on which the structure stands: T1=0.4,xi=0.05,z=6m,H=9m,n=3 (or z/H=0.67, gamma=1.29).
    baseline : Step | str | None, optional
        Baseline correction: the best-fitting constant, line or parabola is subtracted.
    highpass : Step | str | float | None, optional
        High-pass corner frequency in Hz (Butterworth, zero phase).
    lowpass : Step | str | float | None, optional
        Low-pass corner frequency in Hz (Butterworth, zero phase).
    taper : Step | str | float | None, optional
        Fraction of the duration over which each end is tapered to zero.
    trim : Step | str | None, optional
        Start and end of the part to keep, in s.
    resample : Step | str | float | None, optional
        Resample to this interval, in s; uneven times are put on a regular grid.
    watch : Watcher
        Told what is read and written, what is doubtful, and how far the work is.

    Returns
    -------
    GroundMotion
        Accelerations [m/s2] at a constant interval [s], named after the file. Its `processing` has the steps applied.

    Raises
    ------
    InputError
        If the file cannot be read or corrected, or anything in it is missing, contradictory or not a number.
    """

@overload
def animate(  # type: ignore[overload-overlap]
    structures: StructureLike,
    motions: Motion,
    *,
    out: str | Path,
    model: Literal['nonlinear', 'linear1', 'linear2'] = ...,
    speed: float | str | None = ...,
    fps: float | str = ...,
    units: str | None = ...,
    dt: float | str | None = ...,
    channel: str | int | None = ...,
    quantity: Literal["acceleration", "velocity", "displacement"] | None = ...,
    gain: Gain | str | None = ...,
    run_on: bool | None = ...,
    despite_header: bool | None = ...,
    other: str | Path | None = ...,
    other_channel: str | int | None = ...,
    azimuth: float | str | None = ...,
    floor: Floor | str | Mapping[str, Any] | None = ...,
    scale: float | str | None = ...,
    target_pga: float | str | None = ...,
    target_pgv: float | str | None = ...,
    polarity: Literal['1', '-1', 1, -1] = ...,
    opening: float | str = ...,
    neighbours: int | None = ...,
    amplitude_deviation: float | str = ...,
    slenderness_deviation: float | str | None = ...,
    restitution_deviation: float | str | None = ...,
    watch: Watcher = ...,
) -> Answer[Animation]:
    """Animate structures under ground motions, as a GIF, as a video or as a page with a slider.

    Parameters
    ----------
    structures : StructureLike | Sequence[StructureLike]
        One structure or several, or their YAML files.
    motions : Motion | Sequence[Motion] | Motions
        One motion or several, their files, or pulses as text; a pattern such as `records/*.AT2` gives several.
    out : str | Path
        Output file: an animated GIF (.gif), a video (.mp4, requires ffmpeg), or a self-contained page with a slider
        (.html). Of several motions each has its own, with its name in the file name.
    model : {"nonlinear", "linear1", "linear2"}, optional
        Model: nonlinear (the mechanism itself), or its equivalent block (linear1, linear2). By default nonlinear.
    speed : float | None, optional
        Playback speed: seconds of motion per second. By default 1; a GIF is sped up to last at most 20 s.
    fps : float, optional
        Frames per second of a GIF or a video. By default 20.0.
    units : str | None, optional
        Unit of the record, if the file does not state it.
    dt : float | str | None, optional
        Sampling interval in s, if the file has no times.
    channel : str | int | None, optional
        Channel or column to read: its number, from 1, or its name.
    quantity : Literal["acceleration", "velocity", "displacement"] | None, optional
        Quantity in the record; velocities and displacements are differentiated.
    gain : Gain | str | None, optional
        Instrument sensitivity: the value of one unit of the record, such as 0.05m/V or 4.7e-6m/s2/count.
    run_on : bool | None, optional
        Read a text without times as one series that runs on over its rows.
    despite_header : bool | None, optional
        Accept a text with other numbers of points or peaks than its header states, as it was cut on purpose.
    other : str | Path | None, optional
        Second horizontal component, perpendicular to the record; the two are rotated into the plane of the structure.
    other_channel : str | int | None, optional
        Channel of the second component in its file.
    azimuth : float | str | None, optional
        Azimuth of the structure's plane, in degrees: 0 is the record, 90 the second. `respond` also accepts all.
    floor : Floor | str | Mapping[str, Any] | None, optional
        Floor of a building on which the structure stands: T1=0.4,xi=0.05,z=6m,H=9m,n=3 (or z/H=0.67, gamma=1.29).
    scale : float | str | None, optional
        Scale factor on the motion.
    target_pga : float | str | None, optional
        Peak ground acceleration to scale the motion to, in g.
    target_pgv : float | str | None, optional
        Peak ground velocity to scale the motion to, in m/s.
    polarity : {"1", "-1"}, optional
        Polarity of the motion: 1 as given, -1 reversed. By default 1.
    opening : float, optional
        Largest opening of a joint up to which a history holds, over D_cr. By default 0.005.
    neighbours : int | None, optional
        Number of neighbouring motions to simulate as well; 0 for none. By default 200.
    amplitude_deviation : float, optional
        Standard deviation of ln amplitude of the neighbours. By default 0.04.
    slenderness_deviation : float | None, optional
        Standard deviation of ln slenderness. By default that of the file, or 10 %.
    restitution_deviation : float | None, optional
        Standard deviation of restitution. By default that of the file, 0.03 of a given value, or 0.05.
    watch : Watcher
        Told what is read and written, what is doubtful, and how far the work is.

    Returns
    -------
    Answer of Animation
        `film` has the time history, and when it starts and ends; `neighbours` are the outcomes of the neighbours. For
        several motions or structures, `Answers` with one for each, by its name.

    Raises
    ------
    InputError
        If a value is out of range, a file cannot be read or written, ffmpeg is missing, or there would be too many
        frames.
    MechanismError
        If the structure has no critical rotation or no uplift acceleration.
    SolverError
        If the motion cannot be simulated to its end.

    Notes
    -----
    The models are those of `respond`. Displacements are enlarged by a round factor if no rotation reaches 2 degrees;
    `to_dict` has the factor.

    Examples
    --------
    >>> import rocking_cli as rk
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     answer = rk.animate(rk.Block(width=0.7, height=2.8), "sine:0.3g:0.9s", out=f"{folder}/block.html")
    >>> f"{answer.film.history.peak_ratio:.4g}"
    '0.1315'
    """

@overload
def animate(
    structures: list[Any] | tuple[Any, ...],
    motions: Motion | Sequence[Motion] | Motions,
    *,
    out: str | Path,
    model: Literal['nonlinear', 'linear1', 'linear2'] = ...,
    speed: float | str | None = ...,
    fps: float | str = ...,
    units: str | None = ...,
    dt: float | str | None = ...,
    channel: str | int | None = ...,
    quantity: Literal["acceleration", "velocity", "displacement"] | None = ...,
    gain: Gain | str | None = ...,
    run_on: bool | None = ...,
    despite_header: bool | None = ...,
    other: str | Path | None = ...,
    other_channel: str | int | None = ...,
    azimuth: float | str | None = ...,
    floor: Floor | str | Mapping[str, Any] | None = ...,
    scale: float | str | None = ...,
    target_pga: float | str | None = ...,
    target_pgv: float | str | None = ...,
    polarity: Literal['1', '-1', 1, -1] = ...,
    opening: float | str = ...,
    neighbours: int | None = ...,
    amplitude_deviation: float | str = ...,
    slenderness_deviation: float | str | None = ...,
    restitution_deviation: float | str | None = ...,
    watch: Watcher = ...,
) -> Answers[Answer[Animation]]:
    ...

@overload
def animate(
    structures: StructureLike | Sequence[StructureLike],
    motions: list[Any] | tuple[Any, ...],
    *,
    out: str | Path,
    model: Literal['nonlinear', 'linear1', 'linear2'] = ...,
    speed: float | str | None = ...,
    fps: float | str = ...,
    units: str | None = ...,
    dt: float | str | None = ...,
    channel: str | int | None = ...,
    quantity: Literal["acceleration", "velocity", "displacement"] | None = ...,
    gain: Gain | str | None = ...,
    run_on: bool | None = ...,
    despite_header: bool | None = ...,
    other: str | Path | None = ...,
    other_channel: str | int | None = ...,
    azimuth: float | str | None = ...,
    floor: Floor | str | Mapping[str, Any] | None = ...,
    scale: float | str | None = ...,
    target_pga: float | str | None = ...,
    target_pgv: float | str | None = ...,
    polarity: Literal['1', '-1', 1, -1] = ...,
    opening: float | str = ...,
    neighbours: int | None = ...,
    amplitude_deviation: float | str = ...,
    slenderness_deviation: float | str | None = ...,
    restitution_deviation: float | str | None = ...,
    watch: Watcher = ...,
) -> Answers[Answer[Animation]]:
    ...

@overload
def animate(
    structures: StructureLike | Sequence[StructureLike],
    motions: Motion | Sequence[Motion] | Motions,
    *,
    out: str | Path,
    model: Literal['nonlinear', 'linear1', 'linear2'] = ...,
    speed: float | str | None = ...,
    fps: float | str = ...,
    units: str | None = ...,
    dt: float | str | None = ...,
    channel: str | int | None = ...,
    quantity: Literal["acceleration", "velocity", "displacement"] | None = ...,
    gain: Gain | str | None = ...,
    run_on: bool | None = ...,
    despite_header: bool | None = ...,
    other: str | Path | None = ...,
    other_channel: str | int | None = ...,
    azimuth: float | str | None = ...,
    floor: Floor | str | Mapping[str, Any] | None = ...,
    scale: float | str | None = ...,
    target_pga: float | str | None = ...,
    target_pgv: float | str | None = ...,
    polarity: Literal['1', '-1', 1, -1] = ...,
    opening: float | str = ...,
    neighbours: int | None = ...,
    amplitude_deviation: float | str = ...,
    slenderness_deviation: float | str | None = ...,
    restitution_deviation: float | str | None = ...,
    watch: Watcher = ...,
) -> Answer[Animation] | Answers[Answer[Animation]]:
    ...

def building(
    building: str | Path | Mapping[str, Any],
    motions: Motion | Sequence[Motion] | Motions = ...,
    *,
    site: SiteLike | None = ...,
    strengthened: str | Path | Mapping[str, Any] | None = ...,
    worst: int = ...,
    design: int | None = ...,
    structures: str | Path | None = ...,
    sheet: str | Path | None = ...,
    appendix: bool = ...,
    jobs: int | None = ...,
    in_processes: bool = ...,
    plot: str | Path | None = ...,
    sets: Mapping[str, Any] | None = ...,
    units: str | None = ...,
    dt: float | str | None = ...,
    channel: str | int | None = ...,
    quantity: Literal["acceleration", "velocity", "displacement"] | None = ...,
    gain: Gain | str | None = ...,
    run_on: bool | None = ...,
    despite_header: bool | None = ...,
    other: str | Path | None = ...,
    other_channel: str | int | None = ...,
    azimuth: float | str | None = ...,
    floor: Floor | str | Mapping[str, Any] | None = ...,
    scale: float | str | None = ...,
    target_pga: float | str | None = ...,
    target_pgv: float | str | None = ...,
    polarity: Literal['1', '-1', 'both', 1, -1] = ...,
    state: str | None = ...,
    on_floor: bool = ...,
    language: Literal['en', 'it'] | None = ...,
    project: str | None = ...,
    place: str | None = ...,
    client: str | None = ...,
    author: str | None = ...,
    logo: str | Path | None = ...,
    origin: str | None = ...,
    out: str | Path | None = ...,
    separator: Literal[',', ';', 'tab'] | None = ...,
    decimal: Literal['.', ','] | None = ...,
    watch: Watcher = ...,
) -> Answer[Assessed]:
    """Verify all out-of-plane mechanisms of a building by a code, and name the one that governs.

    Parameters
    ----------
    building : str | Path | Mapping[str, Any]
        The file of a building, or of a table of its walls; in Python its fields too.
    motions : Motion | Sequence[Motion] | Motions, optional
        One motion or several, their files, or pulses as text; without any, no histories are followed.
    site : SiteLike | None, optional
        Site file, or its fields in Python; by default the `site` of the building. `rocking new site` prints a template.
    strengthened : str | Path | Mapping[str, Any] | None, optional
        The strengthened structure, to be verified too and compared with FILE.
    worst : int, optional
        Number of mechanisms to verify by time histories. By default 3.
    design : int | None, optional
        Level whose ties are designed: the least bars that satisfy the code.
    structures : str | Path | None, optional
        Write each mechanism into this folder as a structure file, with its site, and a table of all.
    sheet : str | Path | None, optional
        Write the calculation sheet (.html; .docx and .pdf need an extra package; a browser does for .pdf).
    appendix : bool, optional
        Add the workings of each mechanism that counts to the sheet.
    jobs : int | None, optional
        Number of processor cores to use. By default one for each processor.
    in_processes : bool, optional
        Share the walls among processes; a script then needs `if __name__ == "__main__"`.
    plot : str | Path | None, optional
        Draw the building with its mechanisms (.png, .svg or .pdf).
    sets : Mapping[str, Any] | None, optional
        Motions of a limit state of its own: a folder or list that `rocking select` wrote, a file, or a pattern.
        Repeatable. In Python a mapping with the motions of each state.
    units : str | None, optional
        Unit of the record, if the file does not state it.
    dt : float | str | None, optional
        Sampling interval in s, if the file has no times.
    channel : str | int | None, optional
        Channel or column to read: its number, from 1, or its name.
    quantity : Literal["acceleration", "velocity", "displacement"] | None, optional
        Quantity in the record; velocities and displacements are differentiated.
    gain : Gain | str | None, optional
        Instrument sensitivity: the value of one unit of the record, such as 0.05m/V or 4.7e-6m/s2/count.
    run_on : bool | None, optional
        Read a text without times as one series that runs on over its rows.
    despite_header : bool | None, optional
        Accept a text with other numbers of points or peaks than its header states, as it was cut on purpose.
    other : str | Path | None, optional
        Second horizontal component, perpendicular to the record; the two are rotated into the plane of the structure.
    other_channel : str | int | None, optional
        Channel of the second component in its file.
    azimuth : float | str | None, optional
        Azimuth of the structure's plane, in degrees: 0 is the record, 90 the second. `respond` also accepts all.
    floor : Floor | str | Mapping[str, Any] | None, optional
        Floor of a building on which the structure stands: T1=0.4,xi=0.05,z=6m,H=9m,n=3 (or z/H=0.67, gamma=1.29).
    scale : float | str | None, optional
        Scale factor on the motion.
    target_pga : float | str | None, optional
        Peak ground acceleration to scale the motion to, in g.
    target_pgv : float | str | None, optional
        Peak ground velocity to scale the motion to, in m/s.
    polarity : {"1", "-1", "both"}, optional
        Polarity of the motion: 1 as given, -1 reversed. By default 1.
    state : str | None, optional
        Limit state to which the records belong, such as SLC, if the site gives it. By default that of the verdict.
    on_floor : bool, optional
        The motions are those of the floor of the site, and not of the ground.
    language : {"en", "it"}, optional
        Language of the answer and of documents. By default that of the site, or en.
    project : str | None, optional
        Project name, for the heading of the document.
    place : str | None, optional
        Location of the structure, for the heading.
    client : str | None, optional
        Client who ordered the document, for the heading.
    author : str | None, optional
        Author of the document, for the heading.
    logo : str | Path | None, optional
        Author's logo (.png, .jpg or .svg), for the heading.
    origin : str | None, optional
        What the document says of how it was made. By default the command, or the call of Python.
    out : str | Path | None, optional
        Write all mechanisms, the worst first. (.csv or .xlsx).  - is standard output.
    separator : {",", ";", "tab"}, optional
        Separator of the CSV table. By default a comma.
    decimal : {".", ","}, optional
        Decimal sign of the CSV table. By default a point.
    watch : Watcher
        Told what is read and written, what is doubtful, and how far the work is.

    Returns
    -------
    Answer of Assessed
        `rows` are the mechanisms with their verifications, the worst first; `left_out` those that were not verified.

    Raises
    ------
    InputError
        If the building, its site or a motion cannot be used, no mechanism can be verified, or a file cannot be written.
    SolverError
        If a motion cannot be simulated to its end.

    Notes
    -----
    The mechanisms are those of DeJong and Dimitrakopoulos (2014), Sections 2 to 4, under loads and ties.

    Examples
    --------
    >>> import rocking_cli as rk
    >>> site = {"FC": 1.35, "ag": 0.2, "F0": 2.5, "TC": 0.4, "S": 1.2}
    >>> walls = [{"name": "front", "length": 8.0, "thickness": 0.6}]
    >>> house = {"levels": [0.0, 4.0, 8.0], "masonry": {"density": 1800.0}, "walls": walls}
    >>> answer = rk.building(house, site=site)
    >>> answer.governs.made.name
    'front: overturning about 0 m'
    """

def calibrate(
    structure: StructureLike,
    *,
    free: str | Path | Trace,
    free_geometry: bool = ...,
    out: str | Path | None = ...,
    plot: str | Path | None = ...,
    watch: Watcher = ...,
) -> Answer[TraceFit]:
    """Find the restitution of a structure from a trace of its free rocking.

    Parameters
    ----------
    structure : StructureLike
        The structure, or its YAML file.
    free : str | Path | Trace
        Trace of a free-rocking test, a CSV file with the columns time [s] and angle [deg] or [rad]; - is standard
        input.
    free_geometry : bool, optional
        Fit p and alpha to the trace too, of a free-standing block with alpha of 0.07 rad or more.
    out : str | Path | None, optional
        Write a copy of the structure's file with the fitted restitution and its scatter (`uncertainty`).
    plot : str | Path | None, optional
        Plot the trace with its fit and residuals (.png, .svg or .pdf).
    watch : Watcher
        Told what is read and written, what is doubtful, and how far the work is.

    Returns
    -------
    Answer of TraceFit
        `eta`, its `scatter` from impact to impact, `etas`, `release`, `offset`, `drift`.

    Raises
    ------
    InputError
        If a file is not valid, or if the trace does not determine the restitution, such as by fewer than three impacts
        above the noise.
    MechanismError
        If the structure has no critical rotation.
    """

def collapse(
    structure: StructureLike,
    *,
    out: str | Path | None = ...,
    plot: str | Path | None = ...,
    watch: Watcher = ...,
) -> MappingAnswer[Direction, CollapseMechanism]:
    """Find the weakest mechanism of an assembly of rigid blocks in each direction, by limit analysis.

    Parameters
    ----------
    structure : StructureLike
        The structure, or its YAML file.
    out : str | Path | None, optional
        Write the mechanism as a structure file: a linkage of the blocks, for all other questions.
    plot : str | Path | None, optional
        Plot the mechanism and a line of thrust (.png, .svg or .pdf).
    watch : Watcher
        Told what is read and written, what is doubtful, and how far the work is.

    Returns
    -------
    MappingAnswer of Direction to CollapseMechanism
        lambda, hinges, groups of blocks that move as one, a line of thrust, friction required, and rotation up to which
        the mechanism is valid.

    Raises
    ------
    InputError
        If the structure is not an assembly, or its file cannot be used; if `out` cannot be written, also because one of
        the mechanisms has no rocking model.
    MechanismError
        If the assembly has no mechanism.

    Examples
    --------
    A block of 1 m x 4 m on the ground:

    >>> import rocking_cli as rk
    >>> block = {"polygon": [[0.0, 0.0], [1.0, 0.0], [1.0, 4.0], [0.0, 4.0]]}
    >>> ground = {"polygon": [[-1.0, -1.0], [2.0, -1.0], [2.0, 0.0], [-1.0, 0.0]]}
    >>> answer = rk.collapse(rk.Assembly(blocks={"block": block}, ground={"ground": ground}))
    >>> round(answer[rk.Direction.POSITIVE].lambda_, 12)
    0.25
    """

def demand(
    site: SiteLike,
    *,
    damping: float | str = ...,
    plot: str | Path | None = ...,
    out: str | Path | None = ...,
    separator: Literal[',', ';', 'tab'] | None = ...,
    decimal: Literal['.', ','] | None = ...,
    watch: Watcher = ...,
) -> Answer[SpectraOfSite]:
    """Compute the elastic response spectra of a site by its code, at each limit state that the site gives.

    Parameters
    ----------
    site : SiteLike
        Fields of a site file, or the file.
    damping : float, optional
        Damping ratio of the spectrum. By default 0.05.
    plot : str | Path | None, optional
        Plot the spectra of acceleration and displacement (.png, .svg or .pdf).
    out : str | Path | None, optional
        Write the spectra over all periods (.csv, .parquet or .xlsx).  - is standard output.
    separator : {",", ";", "tab"}, optional
        Separator of the CSV table. By default a comma.
    decimal : {".", ","}, optional
        Decimal sign of the CSV table. By default a point.
    watch : Watcher
        Told what is read and written, what is doubtful, and how far the work is.

    Returns
    -------
    Answer of SpectraOfSite
        `states` holds, by limit state, `values` of the parameters and the arrays `acceleration` [standard gravity] and
        `displacement` [m] of the ground, and of the floor if there is one, over `periods` [s].

    Raises
    ------
    InputError
        If the site cannot be used, or its code has no spectra.

    Examples
    --------
    >>> import rocking_cli as rk
    >>> site = {"FC": "LC1", "ag": 0.2, "F0": 2.5, "TC_star": 0.32, "soil": "C"}
    >>> slv = rk.demand(site).states["SLV"]
    >>> round(slv.values["S"], 3), round(slv.values["pga"], 4), slv.acceleration.round(3).max().item()
    (1.4, 0.28, 0.7)
    """

def design(
    structure: StructureLike,
    vary: Span | str | tuple[str, float | str, float | str],
    until: Aim | str,
    motions: Motion | Sequence[Motion] | Motions = ...,
    *,
    points: int = ...,
    site: SiteLike | None = ...,
    plot: str | Path | None = ...,
    units: str | None = ...,
    dt: float | str | None = ...,
    channel: str | int | None = ...,
    quantity: Literal["acceleration", "velocity", "displacement"] | None = ...,
    gain: Gain | str | None = ...,
    run_on: bool | None = ...,
    despite_header: bool | None = ...,
    other: str | Path | None = ...,
    other_channel: str | int | None = ...,
    azimuth: float | str | None = ...,
    floor: Floor | str | Mapping[str, Any] | None = ...,
    scale: float | str | None = ...,
    target_pga: float | str | None = ...,
    target_pgv: float | str | None = ...,
    polarity: Literal['1', '-1', 'both', 1, -1] = ...,
    neighbours: int | None = ...,
    amplitude_deviation: float | str = ...,
    slenderness_deviation: float | str | None = ...,
    restitution_deviation: float | str | None = ...,
    opening: float | str = ...,
    out: str | Path | None = ...,
    separator: Literal[',', ';', 'tab'] | None = ...,
    decimal: Literal['.', ','] | None = ...,
    watch: Watcher = ...,
) -> Answer[Design]:
    """Find the values of one field for which a structure meets a requirement.

    Parameters
    ----------
    structure : StructureLike
        The structure, or its YAML file.
    vary : Span | str | tuple[str, float | str, float | str]
        Field to vary and its range, without a unit in that of the field: width=0.2m:0.8m, ties.bar.prestress=0:50kN,
        loads.0.mass=1t:9t.
    until : Aim | str
        Requirement: one of lambda, phi_cr, p, peak_ratio, peak_displacement, drift, tie_force, overturned, ratio, or a
        number of a code (alpha0, zeta_SLD, zeta_SLV, zeta_SLC, zeta_damage, zeta_linear or zeta_nonlinear); one of <,
        <=, > or >=; and a number, or the word required for what the code of the site requires of the structure after
        the change.
    motions : Motion | Sequence[Motion] | Motions, optional
        One motion or several, their files, or pulses as text; without any, no histories are followed.
    points : int, optional
        Number of values in the first scan. By default 41.
    site : SiteLike | None, optional
        Site file, or its fields in Python: ground motion, confidence factor, floor. `rocking new site` prints a
        template.
    plot : str | Path | None, optional
        Plot the metric against the field (.png, .svg or .pdf).
    units : str | None, optional
        Unit of the record, if the file does not state it.
    dt : float | str | None, optional
        Sampling interval in s, if the file has no times.
    channel : str | int | None, optional
        Channel or column to read: its number, from 1, or its name.
    quantity : Literal["acceleration", "velocity", "displacement"] | None, optional
        Quantity in the record; velocities and displacements are differentiated.
    gain : Gain | str | None, optional
        Instrument sensitivity: the value of one unit of the record, such as 0.05m/V or 4.7e-6m/s2/count.
    run_on : bool | None, optional
        Read a text without times as one series that runs on over its rows.
    despite_header : bool | None, optional
        Accept a text with other numbers of points or peaks than its header states, as it was cut on purpose.
    other : str | Path | None, optional
        Second horizontal component, perpendicular to the record; the two are rotated into the plane of the structure.
    other_channel : str | int | None, optional
        Channel of the second component in its file.
    azimuth : float | str | None, optional
        Azimuth of the structure's plane, in degrees: 0 is the record, 90 the second. `respond` also accepts all.
    floor : Floor | str | Mapping[str, Any] | None, optional
        Floor of a building on which the structure stands: T1=0.4,xi=0.05,z=6m,H=9m,n=3 (or z/H=0.67, gamma=1.29).
    scale : float | str | None, optional
        Scale factor on the motion.
    target_pga : float | str | None, optional
        Peak ground acceleration to scale the motion to, in g.
    target_pgv : float | str | None, optional
        Peak ground velocity to scale the motion to, in m/s.
    polarity : {"1", "-1", "both"}, optional
        Polarity of the motion: 1 as given, -1 reversed. By default 1.
    neighbours : int | None, optional
        Number of neighbours of each motion to simulate. By default 200.
    amplitude_deviation : float, optional
        Standard deviation of ln amplitude of the neighbours. By default 0.04.
    slenderness_deviation : float | None, optional
        Standard deviation of ln slenderness. By default that of the file, or 10 %.
    restitution_deviation : float | None, optional
        Standard deviation of restitution. By default that of the file, 0.03 of a given value, or 0.05.
    opening : float, optional
        Largest opening of a joint up to which a history holds, over D_cr. By default 0.005.
    out : str | Path | None, optional
        Write the scanned values and the metric at each (.csv, .parquet or .xlsx).  - is standard output.
    separator : {",", ";", "tab"}, optional
        Separator of the CSV table. By default a comma.
    decimal : {".", ","}, optional
        Decimal sign of the CSV table. By default a point.
    watch : Watcher
        Told what is read and written, what is doubtful, and how far the work is.

    Returns
    -------
    Answer of Design
        `value` is the least value from which the requirement holds, or the largest up to which it holds; `holds` are
        the ranges in which it holds, and `steel` the bars of a tie whose force varies.

    Raises
    ------
    InputError
        If the field or metric does not exist, or the metric requires ground motions or a site, or does not depend on
        those that are given.

    Examples
    --------
    >>> import rocking_cli as rk
    >>> round(rk.design(rk.Block(width=0.5, height=2.0), "width=0.2m:0.8m", "lambda >= 0.2").value, 9)
    0.4
    """

def draw(
    structure: StructureLike,
    *,
    at: float | str | None = ...,
    plot: str | Path | None = ...,
    dxf: str | Path | None = ...,
    watch: Watcher = ...,
) -> Answer[Any]:
    """Draw a structure at rest with its dimensions, and displaced in both directions.

    Parameters
    ----------
    structure : StructureLike
        The structure, or its YAML file.
    at : float | None, optional
        Rotation to draw, as a multiple of phi_cr, or of the kinematic limit if there is no phi_cr; at most the
        kinematic limit. By default 1, 0.1.
    plot : str | Path | None, optional
        Output file (.png, .svg or .pdf). By default FILE with .png, in this folder; none with JSON or DXF.
    dxf : str | Path | None, optional
        Write the drawing as DXF, in metres, which `rocking import` reads; needs ezdxf.
    watch : Watcher
        Told what is read and written, what is doubtful, and how far the work is.

    Returns
    -------
    Answer of Picture
        Parts of the structure, its dimensions, and the positions of the parts at any rotation; of a building its walls.

    Raises
    ------
    InputError
        If a value is out of range, or a file cannot be used.
    MechanismError
        If the structure has no critical rotation or no uplift acceleration.

    Notes
    -----
    Rotations and phi_cr as in DeJong and Dimitrakopoulos (2014), Section 3.

    Examples
    --------
    >>> import rocking_cli as rk
    >>> answer = rk.draw(rk.Block(width=0.7, height=2.8), at=0.5)
    >>> [length.text for length in answer.sketch.lengths]
    ['2b = 0.7 m', '2h = 2.8 m', 'R = 1.44 m']
    """

@overload
def equiv(
    structures: StructureLike,
    *,
    out: str | Path | None = ...,
    separator: Literal[',', ';', 'tab'] | None = ...,
    decimal: Literal['.', ','] | None = ...,
    watch: Watcher = ...,
) -> Answer[Equivalence | None]:
    """Compute the equivalent single rocking block of structures, in both directions.

    Parameters
    ----------
    structures : StructureLike | Sequence[StructureLike]
        One structure or several, or their YAML files.
    out : str | Path | None, optional
        Write the parameters, a row for each direction of each structure (.csv or .xlsx).  - is standard output.
    separator : {",", ";", "tab"}, optional
        Separator of the CSV table. By default a comma.
    decimal : {".", ","}, optional
        Decimal sign of the CSV table. By default a point.
    watch : Watcher
        Told what is read and written, what is doubtful, and how far the work is.

    Returns
    -------
    Answer of Equivalence or None
        `positive` and `negative` are the blocks, see `Equivalence`. None if no single block is equivalent; its
        sentences and `to_dict` give the reason. For a sequence of structures, `Answers` with one for each, by its name.

    Raises
    ------
    InputError
        If a value is out of range, or a file cannot be used.
    MechanismError
        If the structure has no critical rotation or no uplift acceleration.

    Notes
    -----
    DeJong and Dimitrakopoulos (2014), Section 3: Eq. 9 for phi_cr, Eq. 10 for lambda, Eq. 13 for I_eq, G_eq and B_eq,
    Eqs. 15 and 20 for kappa1 and kappa2, Eq. 17 for p and theta_cr; eta from kinematics, for a block Housner (1963),
    unless it is given.

    Examples
    --------
    >>> import rocking_cli as rk
    >>> answer = rk.equiv(rk.Block(width=1.0, height=4.0))
    >>> round(answer.positive.lambda_, 6)
    0.25
    """

@overload
def equiv(
    structures: list[Any] | tuple[Any, ...],
    *,
    out: str | Path | None = ...,
    separator: Literal[',', ';', 'tab'] | None = ...,
    decimal: Literal['.', ','] | None = ...,
    watch: Watcher = ...,
) -> Answers[Answer[Equivalence | None]]:
    ...

@overload
def equiv(
    structures: StructureLike | Sequence[StructureLike],
    *,
    out: str | Path | None = ...,
    separator: Literal[',', ';', 'tab'] | None = ...,
    decimal: Literal['.', ','] | None = ...,
    watch: Watcher = ...,
) -> Answer[Equivalence | None] | Answers[Answer[Equivalence | None]]:
    ...

def equivalent_pulses(
    structures: Sequence[StructureLike],
    *,
    pulse: Pulse | str | None = ...,
    polarity: Literal['1', '-1', 1, -1] = ...,
    kappa: Literal['1', '2'] = ...,
    restitution: float | str | Literal['first', 'own'] = ...,
    plot: str | Path | None = ...,
    ag: float | str | None = ...,
    period: float | str | None = ...,
    shape: str = ...,
    opening: float | str = ...,
    out: str | Path | None = ...,
    separator: Literal[',', ';', 'tab'] | None = ...,
    decimal: Literal['.', ','] | None = ...,
    watch: Watcher = ...,
) -> Answer[EquivalentResponses]:
    """Find the pulses to which structures are equally vulnerable; the given pulse is for the first.

    Parameters
    ----------
    structures : Sequence[StructureLike]
        At least two structures, or their YAML files; the pulse is for the first.
    pulse : Pulse | str | None, optional
        The pulse in one word, such as sine:0.6g:0.8s, instead of its amplitude, period and shape.
    polarity : {"1", "-1"}, optional
        Polarity of the motion: 1 as given, -1 reversed. By default 1.
    kappa : {"1", "2"}, optional
        Equivalent block by which the pulses are scaled: 1 for kappa1, 2 for kappa2. By default 2.
    restitution : float | Literal['first', 'own'], optional
        Coefficient of restitution: a number for all structures, that of the first, or each structure's own. By default
        first.
    plot : str | Path | None, optional
        Plot the responses (.png, .svg or .pdf).
    ag : float | None, optional
        Amplitude of the pulse; a text needs its unit: 0.6g, 5.9m/s2. [g]
    period : float | None, optional
        Period of the pulse, such as 0.8s. [s]
    shape : str, optional
        Shape of the pulse: sine, cosine, half_sine, rectangular, ricker, ..., then its parameters if it has any. By
        default sine.
    opening : float, optional
        Largest opening of a joint up to which a history holds, over D_cr. By default 0.005.
    out : str | Path | None, optional
        Write the responses against p t (.csv or .xlsx).  - is standard output.
    separator : {",", ";", "tab"}, optional
        Separator of the CSV table. By default a comma.
    decimal : {".", ","}, optional
        Decimal sign of the CSV table. By default a point.
    watch : Watcher
        Told what is read and written, what is doubtful, and how far the work is.

    Returns
    -------
    Answer of EquivalentResponses
        A pulse and a response for each structure, and for the linear block that they share.

    Raises
    ------
    InputError
        If a value is out of range, or a file cannot be used.
    MechanismError
        If the structure has no critical rotation or no uplift acceleration.
    SolverError
        If a motion cannot be simulated to its end.

    Notes
    -----
    DeJong and Dimitrakopoulos (2014): equal a and omega of Eq. 40, as in Fig. 15.

    Examples
    --------
    >>> import rocking_cli as rk
    >>> blocks = [rk.Block(width=0.7, height=2.8), rk.Block(width=1.0, height=4.0, restitution=0.9)]
    >>> round(rk.equivalent_pulses(blocks, ag=0.6, period=0.5).a, 3)
    2.4
    """

def error(
    structure: StructureLike,
    *,
    at: Sequence[float | str] | ArrayLike = ...,
    a: Sequence[float | str] | ArrayLike = ...,
    plot: str | Path | None = ...,
    watch: Watcher = ...,
) -> Answer[list[Linearisation]]:
    """Compute the errors of the equivalent block of a structure, in each direction.

    Parameters
    ----------
    structure : StructureLike
        The structure, or its YAML file.
    at : Sequence[float] | ArrayLike, optional
        Amplitude phi/phi_cr of the free motion at which to evaluate the error of its period. Repeatable. By default
        (0.5,).
    a : Sequence[float] | ArrayLike, optional
        Constant acceleration, as a multiple of the uplift acceleration. Repeatable. By default (2.0,).
    plot : str | Path | None, optional
        Plot the errors against amplitude and acceleration (.png, .svg or .pdf).
    watch : Watcher
        Told what is read and written, what is doubtful, and how far the work is.

    Returns
    -------
    Answer of list of Linearisation
        One for each distinct direction. `to_frame()` has a row for each direction, kappa and `quantity`: its `value` of
        the structure, and the `ratio` of the equivalent block's value to it, against `amplitude` (phi/phi_cr) or
        `acceleration` (a/lambda). The free period is the same with either kappa.

    Raises
    ------
    InputError
        If a value is out of range, or a file cannot be used.
    MechanismError
        If the structure has no critical rotation or no uplift acceleration.
    SolverError
        If an integral does not converge, or the structure does not overturn under an acceleration.

    Notes
    -----
    DeJong and Dimitrakopoulos (2014), Section 4: Eq. 24 for the free period, Eq. 25 for the overturning time.

    Examples
    --------
    >>> import rocking_cli as rk
    >>> answer = rk.error(rk.Wall(thickness=0.3, height=3.0), at=[0.3])
    >>> answer.result[0].period_ratio.round(3).tolist()
    [0.963]
    """

def explore(
    structures: StructureLike | Sequence[StructureLike],
    motions: Motion | Sequence[Motion] | Motions,
    *,
    vary: Any = ...,
    out: str | Path = ...,
    units: str | None = ...,
    dt: float | str | None = ...,
    channel: str | int | None = ...,
    quantity: Literal["acceleration", "velocity", "displacement"] | None = ...,
    gain: Gain | str | None = ...,
    run_on: bool | None = ...,
    despite_header: bool | None = ...,
    other: str | Path | None = ...,
    other_channel: str | int | None = ...,
    azimuth: float | str | None = ...,
    floor: Floor | str | Mapping[str, Any] | None = ...,
    scale: float | str | None = ...,
    target_pga: float | str | None = ...,
    target_pgv: float | str | None = ...,
    polarity: Literal['1', '-1', 1, -1] = ...,
    opening: float | str = ...,
    neighbours: int | None = ...,
    amplitude_deviation: float | str = ...,
    slenderness_deviation: float | str | None = ...,
    restitution_deviation: float | str | None = ...,
    watch: Watcher = ...,
) -> Answer[Exploration]:
    """Write a page on which structures and their ground motion can be changed, and which answers at once.

    Parameters
    ----------
    structures : StructureLike | Sequence[StructureLike]
        One structure or several, or their YAML files.
    motions : Motion | Sequence[Motion] | Motions
        One motion or several, their files, or pulses as text; a pattern such as `records/*.AT2` gives several.
    vary : Any, optional
        Field to vary and its range, without a unit in that of the field: width=0.2m:0.8m, ties.bar.prestress=0:50kN,
        loads.0.mass=1t:9t.
    out : str | Path, optional
        The page. By default explore.html.
    units : str | None, optional
        Unit of the record, if the file does not state it.
    dt : float | str | None, optional
        Sampling interval in s, if the file has no times.
    channel : str | int | None, optional
        Channel or column to read: its number, from 1, or its name.
    quantity : Literal["acceleration", "velocity", "displacement"] | None, optional
        Quantity in the record; velocities and displacements are differentiated.
    gain : Gain | str | None, optional
        Instrument sensitivity: the value of one unit of the record, such as 0.05m/V or 4.7e-6m/s2/count.
    run_on : bool | None, optional
        Read a text without times as one series that runs on over its rows.
    despite_header : bool | None, optional
        Accept a text with other numbers of points or peaks than its header states, as it was cut on purpose.
    other : str | Path | None, optional
        Second horizontal component, perpendicular to the record; the two are rotated into the plane of the structure.
    other_channel : str | int | None, optional
        Channel of the second component in its file.
    azimuth : float | str | None, optional
        Azimuth of the structure's plane, in degrees: 0 is the record, 90 the second. `respond` also accepts all.
    floor : Floor | str | Mapping[str, Any] | None, optional
        Floor of a building on which the structure stands: T1=0.4,xi=0.05,z=6m,H=9m,n=3 (or z/H=0.67, gamma=1.29).
    scale : float | str | None, optional
        Scale factor on the motion.
    target_pga : float | str | None, optional
        Peak ground acceleration to scale the motion to, in g.
    target_pgv : float | str | None, optional
        Peak ground velocity to scale the motion to, in m/s.
    polarity : {"1", "-1"}, optional
        Polarity of the motion: 1 as given, -1 reversed. By default 1.
    opening : float, optional
        Largest opening of a joint up to which a history holds, over D_cr. By default 0.005.
    neighbours : int | None, optional
        Number of neighbouring motions that the page simulates. By default 200.
    amplitude_deviation : float, optional
        Standard deviation of ln amplitude of the neighbours. By default 0.04.
    slenderness_deviation : float | None, optional
        Standard deviation of ln slenderness. By default that of the file, or 10 %.
    restitution_deviation : float | None, optional
        Standard deviation of restitution. By default that of the file, 0.03 of a given value, or 0.05.
    watch : Watcher
        Told what is read and written, what is doubtful, and how far the work is.

    Returns
    -------
    Answer of Exploration
        What the page offers; its attribute `file` is the page.

    Raises
    ------
    InputError
        If a value is out of range, a file cannot be read or written, or the page cannot follow a structure.
    MechanismError
        If a structure has no critical rotation or no uplift acceleration.
    SolverError
        If a motion cannot be simulated to its end.

    Notes
    -----
    The page runs the shipped kernels in the browser; its histories have the bits of those of `respond`.

    Examples
    --------
    >>> import rocking_cli as rk
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     answer = rk.explore(rk.Block(width=0.7, height=2.8), "sine:0.3g:0.9s", out=f"{folder}/block.html")
    >>> f"{answer.histories[0].peak_ratio:.4g}"
    '0.1315'
    """

def fragility(
    structures: Shaken | Sequence[Shaken],
    motions: Shaking | Sequence[Shaking] | None = ...,
    *,
    check: bool = ...,
    jobs: int | None = ...,
    scheduler: str | Client | None = ...,
    share: str | None = ...,
    store: str | Path | None = ...,
    restart: bool = ...,
    processing: Sequence[str | Mapping[str, Any]] = ...,
    floor: str | Mapping[str, Any] | None = ...,
    method: Literal['cloud', 'stripes', 'ida'] | None = ...,
    levels: Mapping[str, Any] | None = ...,
    polarity: Literal['1', '-1', 'both', 1, -1] = ...,
    restitution: Sequence[float] | None = ...,
    samples: int = ...,
    sampling: Literal['random', 'latin hypercube'] = ...,
    seed: int = ...,
    model: Literal['nonlinear', 'linear1', 'linear2'] = ...,
    engine: Literal['exact', 'blocks', 'auto'] = ...,
    opening: float | str = ...,
    limit_states: Sequence[str | float] = ...,
    measures: Sequence[str] | None = ...,
    bivariate: Sequence[Sequence[str]] = ...,
    confidence: float | str = ...,
    hazard: Mapping[str, Any] | None = ...,
    name: str | None = ...,
    quantiles: bool = ...,
    rank_measures: bool = ...,
    plot: str | Path | None = ...,
    nrml: str | Path | None = ...,
    watch: Watcher = ...,
) -> Answer[Any]:
    """Run a fragility study, or continue it, and fit its curves.

    Parameters
    ----------
    structures : Shaken | Sequence[Shaken]
        Structures or their files; or entries with a structure or a file as `file`, and `name` and `vary`, the
        distributions of uncertain fields. In Python also the file of a whole study, or its fields, without motions.
    motions : Shaking | Sequence[Shaking] | None, optional
        Ground motions: files of records, patterns such as `records/*.AT2`, lists of records, and pulses such as
        `ricker:1g:0.8s`; or entries with a motion or a file as `file` (and `units`, `dt`, `channel`, `vertical`,
        `from`, `gain`, `with`, `azimuth`, `processing`, `floor`) or a `pulse`. An entry may have a `weight`, and the
        `level` to whose set of records it belongs.
    check : bool, optional
        Show what would be run, without running it.
    jobs : int | None, optional
        Number of processor cores to use. By default one for each processor.
    scheduler : str | Client | None, optional
        Address of a dask.distributed scheduler, or in Python a client of it, to run there.
    share : str | None, optional
        Run only this part of the runs, such as 3/40, into the store that all parts share, and fit no curves.
    store : str | Path | None, optional
        Folder in which the runs are stored. Without one and a study file, the runs last as long as the answer. By
        default next to the study file, such as study.runs.
    restart : bool, optional
        Start from scratch; the existing store is kept under another name.
    processing : Sequence[str | Mapping[str, Any]], optional
        Corrections of every record, in their order, after its own.
    floor : str | Mapping[str, Any] | None, optional
        The floor of a building on which the structures stand.
    method : {"cloud", "stripes", "ida"}, optional
        How records and intensities are combined: each record as it is (cloud), every record at every level (stripes),
        or scaled up until the structure overturns (ida).
    levels : Mapping[str, Any] | None, optional
        Intensities to which every record is scaled: `measure`, and either `values` or `least`, `most`, `count` (and
        `spacing: log`). A cloud may leave them out.
    polarity : {"1", "-1", "both"}, optional
        Polarity of the records: 1 as given, -1 reversed, both for two runs of each. By default 1.
    restitution : Sequence[float] | None, optional
        Coefficients of restitution to run one after the other, in both directions. By default those of the structures.
    samples : int, optional
        How many structures are drawn from the distributions in `vary`. By default 1.
    sampling : {"random", "latin hypercube"}, optional
        How they are drawn: latin hypercube or random. By default latin hypercube.
    seed : int, optional
        Seed of the random numbers.
    model : {"nonlinear", "linear1", "linear2"}, optional
        Equation of motion: nonlinear, linear1 or linear2. By default nonlinear.
    engine : {"exact", "blocks", "auto"}, optional
        Who simulates the runs: one degree of freedom (exact), free blocks (blocks), or free blocks where one degree of
        freedom does not tell the outcome (auto). Free blocks run in processes unless `jobs` is 1: a script then needs
        `if __name__ == "__main__"`. By default exact.
    opening : float, optional
        Largest opening or slip of a joint up to which a run holds, over D_cr. By default 0.005.
    limit_states : Sequence[str | float], optional
        Any of uplift, sliding, overturning; numbers, that is values of phi/phi_cr (for a tied structure without a
        critical rotation: over its kinematic limit); and displacements of the top such as `25 mm`. By default
        ['uplift', 'overturning'].
    measures : Sequence[str] | None, optional
        Intensity measures over which curves are fitted. By default that of the levels and that of the hazard.
    bivariate : Sequence[Sequence[str]], optional
        Pairs of measures over which surfaces are fitted.
    confidence : float, optional
        Confidence level of intervals and bands. By default 0.95.
    hazard : Mapping[str, Any] | None, optional
        How often intensities are exceeded at the site, per year: `measure`, and `file` (CSV of intensity and annual
        rate, or hazard curve of OpenQuake) or `points`.
    name : str | None, optional
        Name of the study. By default that of its file.
    quantiles : bool, optional
        Show quantiles of the peak rotation at each intensity: 16, 50 and 84 % of the runs.
    rank_measures : bool, optional
        Rank the intensity measures as well, by how well they predict the outcome.
    plot : str | Path | None, optional
        Plot every curve into this folder, created if missing.
    nrml : str | Path | None, optional
        Write the lognormal curves for OpenQuake (NRML 0.5).
    watch : Watcher
        Told what is read and written, what is doubtful, and how far the work is.

    Returns
    -------
    StudyAnswer, or Answer of Plan
        One per curve: structure, limit state, measure and fit, as from `results`, with `curves`, `to_frame()` and
        `runs()`. If the outcome of some runs is unknown, as a joint opens that the model keeps closed, these exceed the
        limit in the fit and do not in its `lower`. With `check`, the plan of the study.

    Raises
    ------
    InputError
        If the study, a file or the store cannot be used; runs that fail are counted in the store, not raised.
    MechanismError
        If the structure has no critical rotation or no uplift acceleration.

    Notes
    -----
    The runs are those of `respond`, Eq. 8 or 16 of DeJong and Dimitrakopoulos (2014); docs/fragility.md explains how
    the curves are fitted.

    Examples
    --------
    >>> import rocking_cli as rk
    >>> pulses = [f"{shape}:1g:{period}s" for shape in ("sine", "ricker") for period in (0.6, 0.8, 1.0, 1.2)]
    >>> answer = rk.fragility(
    ...     rk.Block(name="pedestal", width=0.7, height=2.8),
    ...     pulses,
    ...     method="stripes",
    ...     levels={"measure": "PGA", "least": 0.1, "most": 1.5, "count": 8},
    ... )
    >>> round(answer.curves["overturning"].median.value, 2), len(answer.runs())
    (0.59, 64)
    """

def fit_fragility(
    intensity: ArrayLike,
    exceeded: ArrayLike,
    clusters: ArrayLike | None = ...,
    *,
    curve: Literal['lognormal', 'logit'] = ...,
    confidence: float | str = ...,
    label: str = ...,
    watch: Watcher = ...,
) -> Answer[FittedFragility]:
    """Fit a fragility curve to your own data: runs of any program, tests, or observed damage.

    Parameters
    ----------
    intensity : ArrayLike
        Intensity of each run, in any unit. Runs whose intensity is not above zero, or NaN, have no logarithm and are
        left out.
    exceeded : ArrayLike
        Whether each run exceeds the limit state: 1 or True, 0 or False; NaN if that is unknown. Unknown runs are
        counted as exceeding in the fit, and as not exceeding in its `lower`: more than 2 % of them make a band.
    clusters : ArrayLike | None, optional
        What runs have in common, such as the names of their records or sites: runs of one cluster are not independent.
        By default each run is independent of the others.
    curve : {"lognormal", "logit"}, optional
        P = Phi(ln(x/median)/dispersion), or P = 1/(1 + (median/x)^b) with b = pi/(sqrt(3) dispersion), logistic in ln
        x. By default lognormal.
    confidence : float, optional
        Confidence level of intervals and bands. By default 0.95.
    label : str, optional
        Name of the intensity with its unit, such as `PGA [g]`, for the plot and the frame. By default intensity.
    watch : Watcher
        Told what is read and written, what is doubtful, and how far the work is.

    Returns
    -------
    Answer of FittedFragility
        Its `median` and `dispersion` (the standard deviation of the logarithm of the capacity) have a `value`, and
        `low` and `high`, the interval by the likelihood; None if there is no such number. `interval` and
        `robust_interval` have the intervals of both, by their names. `curve.probability(x)` and `curve.band(x)` are
        the curve and its band at any intensity, `robust.band(x)` the robust band, which the plot has. `curve.kind` is
        `step` if the outcomes are separated and `none` if no curve can be fitted: `sentences` say why, and what else
        there is to doubt. `to_frame()` has the points of the curve with both bands. `plot(name="wall",
        beside={"block": other})` draws several fits in one plot.

    Raises
    ------
    InputError
        If the arrays are not numbers of one length, or no run has an intensity above zero.

    Notes
    -----
    Maximum likelihood of a binomial outcome, as for the curves of a study; docs/fragility.md explains the fit, its
    intervals and its test.

    Examples
    --------
    >>> import rocking_cli as rk
    >>> pga = [0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.45, 0.5, 0.55, 0.6, 0.65]
    >>> fell = [0, 0, 0, 0, 1, 0, 0, 1, 1, 0, 1, 1]
    >>> fit = rk.fit_fragility(pga, fell)
    >>> round(fit.median.value, 3), round(fit.dispersion.value, 3)
    (0.406, 0.443)
    """

def results(
    store: str | Path,
    *,
    out: str | Path | None = ...,
    curves: str | Path | None = ...,
    pelicun: str | Path | None = ...,
    quantiles: bool = ...,
    rank_measures: bool = ...,
    plot: str | Path | None = ...,
    nrml: str | Path | None = ...,
    watch: Watcher = ...,
) -> StudyAnswer:
    """Summarise the fragility curves and runs of a study, from its store.

    Parameters
    ----------
    store : str | Path
        The store, which may be that of a study that is still running.
    out : str | Path | None, optional
        Write all runs (.csv, .parquet or .xlsx).  - is standard output.
    curves : str | Path | None, optional
        Write the curves, one line per intensity (.csv, .parquet or .xlsx).  - is standard output.
    pelicun : str | Path | None, optional
        Write the lognormal curves for pelicun, as fragility.csv in this folder.
    quantiles : bool, optional
        Show quantiles of the peak rotation at each intensity: 16, 50 and 84 % of the runs.
    rank_measures : bool, optional
        Rank the intensity measures as well, by how well they predict the outcome.
    plot : str | Path | None, optional
        Plot every curve into this folder, created if missing.
    nrml : str | Path | None, optional
        Write the lognormal curves for OpenQuake (NRML 0.5).
    watch : Watcher
        Told what is read and written, what is doubtful, and how far the work is.

    Returns
    -------
    StudyAnswer
        One curve per structure, limit state and measure. `curves` has them by limit state, such as
        `curves["overturning"].median`, or if there are several structures or measures by structure, limit state and
        measure. `to_frame()` has their points, `runs()` the runs, `frames["fits"]` a row for each curve, and
        `frames["quantiles"]` a row for each intensity. If the outcome of some runs is unknown, as a joint
        opens that the model keeps closed, these exceed the limit in the fit and do not in its `lower`.

    Raises
    ------
    InputError
        If the folder is not a store of this version, or is damaged.
    """

def import_drawing(
    file: str | Path,
    *,
    out: str | Path | None = ...,
    plot: str | Path | None = ...,
    origin: str | None = ...,
    scale: str | None = ...,
    layers: Mapping[str, Sequence[str]] = ...,
    depth: float | str | None = ...,
    merge_gap: float | str = ...,
    close: float | str = ...,
    nested: Literal['openings'] | None = ...,
    kind: Literal['rigid_body', 'assembly', 'linkage'] | None = ...,
    tolerance: float | str = ...,
    plane: Literal['xz', 'yz'] | None = ...,
    units: str | None = ...,
    density: Any = ...,
    watch: Watcher = ...,
) -> Answer[Imported]:
    """Make a structure of a drawing: DXF, SVG, GeoJSON, a table of vertices, a model of blocks.

    Parameters
    ----------
    file : str | Path
        The drawing or the mesh.
    out : str | Path | None, optional
        Structure file to write.
    plot : str | Path | None, optional
        Plot the bodies with their names, what was mended, and what was left out (.png, .svg or .pdf).
    origin : str | None, optional
        The command that the structure file names as its origin. By default the call of Python.
    scale : str | None, optional
        Scale of the drawing, such as 1:50.
    layers : Mapping[str, Sequence[str]], optional
        Layers of a role, such as bodies=CONCI,PILE. Roles: bodies, ground, openings, hinges, supports, loads, ties,
        nothing. Repeatable. By default by their names.
    depth : float | None, optional
        Depth of the structure, such as 1m. [m]
    merge_gap : float, optional
        Close mortar joints up to this width: 12mm. [m] By default none.
    close : float, optional
        Distance up to which ends of lines are one point, and depth up to which overlaps are mended. [m] By default 1mm.
    nested : {"openings"}, optional
        Take outlines inside others as openings.
    kind : {"rigid_body", "assembly", "linkage"}, optional
        Mechanism of the structure. By default rigid_body for one body, linkage with hinges, or else assembly.
    tolerance : float, optional
        Largest distance of the straight sides of curved blocks from their arcs. [m] By default 0.1mm.
    plane : {"xz", "yz"}, optional
        Of a model of blocks: its plane. By default xz.
    units : str | None, optional
        Unit of the drawing or mesh: mm, cm, dm, m, in or ft. By default as the file says.
    density : Any, optional
        Density, in kg/m3 without a unit; of one layer with its name: PIETRA=2600. Repeatable.
    watch : Watcher
        Told what is read and written, what is doubtful, and how far the work is.

    Returns
    -------
    Answer of Imported
        `structure` is the structure; all verbs take the answer in its place. `bodies`, `joints` and `notes` show what
        was read, mended, assumed and left out; `text` is the file.

    Raises
    ------
    InputError
        If an argument or the file cannot be used; a `DrawingError` has the class of the reason, and the places.

    Notes
    -----
    Areas, centroids and inertias of outlines with arcs are exact; a `rigid_body` gets 128 straight sides to a half turn
    that keep the area.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> import rocking_cli as rk
    >>> with TemporaryDirectory() as folder:
    ...     file = Path(folder) / "pillar.csv"
    ...     _ = file.write_text("0,0\\n600,0\\n600,2400\\n0,2400\\n")
    ...     answer = rk.import_drawing(file, units="mm")
    >>> answer.structure.uplift(rk.Direction.POSITIVE)
    0.25
    """

def import_mesh(
    file: str | Path,
    *,
    azimuth: list[float | str] = ...,
    north: float | str | None = ...,
    page: str | Path | None = ...,
    out: str | Path | None = ...,
    plot: str | Path | None = ...,
    origin: str | None = ...,
    level: float | str = ...,
    settle: bool = ...,
    hull: bool = ...,
    up: Literal['z', 'y'] = ...,
    units: str | None = ...,
    density: Any = ...,
    watch: Watcher = ...,
) -> Answer[ImportedMesh]:
    """Make a structure of the mesh of a body, such as the scan of a statue: OBJ, PLY or STL.

    By default the body rocks over its weakest edge, driven by the whole motion; of several azimuths each makes a
    structure, such as `statue-030.yaml`.

    Parameters
    ----------
    file : str | Path
        The drawing or the mesh.
    azimuth : list[float], optional
        Direction of the motion, anticlockwise from the x axis of the mesh: 30, or 0:350:10, which makes a structure
        each. [deg] By default over the weakest edge.
    north : float | None, optional
        Azimuth of the north, for the plot and the page.
    page : str | Path | None, optional
        Page on which the body can be turned.
    out : str | Path | None, optional
        Structure file to write.
    plot : str | Path | None, optional
        Plot the bodies with their names, what was mended, and what was left out (.png, .svg or .pdf).
    origin : str | None, optional
        The command that the structure file names as its origin. By default the call of Python.
    level : float, optional
        Height above the ground up to which points bear: they make the foot. [m] By default 1mm.
    settle : bool, optional
        Lay the body down on the facet of its convex hull below its centre of mass.
    hull : bool, optional
        Take the convex hull of the mesh, which need not be closed then.
    up : {"z", "y"}, optional
        Axis of the mesh that points upwards. By default z.
    units : str | None, optional
        Unit of the coordinates of a mesh, which does not say it.
    density : Any, optional
        Density; needed for a structure, not for its uplift. [kg/m3]
    watch : Watcher
        Told what is read and written, what is doubtful, and how far the work is.

    Returns
    -------
    Answer of ImportedMesh
        The foot, its edges, how the body starts to rock at each azimuth, what was done to the mesh, and `structures`.

    Raises
    ------
    InputError
        If a value is not valid, or a file cannot be read or written. A `DrawingError` has the reason in `refused`, such
        as "units", "open", "point" or "falls".

    Notes
    -----
    In a direction a, lambda is t(a)/h: the way from below the centre of mass to the rim of the foot, over the height of
    the centre of mass. The body rocks over the edge it meets there, with the critical rotation of this edge.

    Examples
    --------
    A tetrahedron on the ground, towards one of its sides and away from it:

    >>> import rocking_cli as rk
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> mesh = "v 0 0 0\\nv 1 0 0\\nv 0 1 0\\nv 0 0 4\\nf 1 3 2\\nf 1 2 4\\nf 2 3 4\\nf 1 4 3\\n"
    >>> with TemporaryDirectory() as folder:
    ...     path = Path(folder) / "spire.obj"
    ...     _ = path.write_text(mesh)
    ...     answer = rk.import_mesh(path, units="m", azimuth=[270, 90])
    >>> [round(row.lambda_, 12) for row in answer.azimuths]
    [0.25, 0.5]
    """

def margin(
    structure: StructureLike,
    motions: Motion | Sequence[Motion] | Motions,
    *,
    plot: str | Path | None = ...,
    units: str | None = ...,
    dt: float | str | None = ...,
    channel: str | int | None = ...,
    quantity: Literal["acceleration", "velocity", "displacement"] | None = ...,
    gain: Gain | str | None = ...,
    run_on: bool | None = ...,
    despite_header: bool | None = ...,
    other: str | Path | None = ...,
    other_channel: str | int | None = ...,
    azimuth: float | str | None = ...,
    floor: Floor | str | Mapping[str, Any] | None = ...,
    scale: float | str | None = ...,
    target_pga: float | str | None = ...,
    target_pgv: float | str | None = ...,
    polarity: Literal['1', '-1', 'both', 1, -1] = ...,
    restitution: float | str | None = ...,
    engine: Literal['exact', 'blocks', 'auto'] = ...,
    opening: float | str = ...,
    neighbours: int | None = ...,
    amplitude_deviation: float | str = ...,
    slenderness_deviation: float | str | None = ...,
    restitution_deviation: float | str | None = ...,
    out: str | Path | None = ...,
    separator: Literal[',', ';', 'tab'] | None = ...,
    decimal: Literal['.', ','] | None = ...,
    watch: Watcher = ...,
) -> MappingAnswer[str, Margin]:
    """Compute the scale factors on motions that uplift a structure, and that overturn it.

    Parameters
    ----------
    structure : StructureLike
        The structure, or its YAML file.
    motions : Motion | Sequence[Motion] | Motions
        One motion or several, their files, or pulses as text; a pattern such as `records/*.AT2` gives several.
    plot : str | Path | None, optional
        Plot the shares against the scale factor (.png, .svg or .pdf).
    units : str | None, optional
        Unit of the record, if the file does not state it.
    dt : float | str | None, optional
        Sampling interval in s, if the file has no times.
    channel : str | int | None, optional
        Channel or column to read: its number, from 1, or its name.
    quantity : Literal["acceleration", "velocity", "displacement"] | None, optional
        Quantity in the record; velocities and displacements are differentiated.
    gain : Gain | str | None, optional
        Instrument sensitivity: the value of one unit of the record, such as 0.05m/V or 4.7e-6m/s2/count.
    run_on : bool | None, optional
        Read a text without times as one series that runs on over its rows.
    despite_header : bool | None, optional
        Accept a text with other numbers of points or peaks than its header states, as it was cut on purpose.
    other : str | Path | None, optional
        Second horizontal component, perpendicular to the record; the two are rotated into the plane of the structure.
    other_channel : str | int | None, optional
        Channel of the second component in its file.
    azimuth : float | str | None, optional
        Azimuth of the structure's plane, in degrees: 0 is the record, 90 the second. `respond` also accepts all.
    floor : Floor | str | Mapping[str, Any] | None, optional
        Floor of a building on which the structure stands: T1=0.4,xi=0.05,z=6m,H=9m,n=3 (or z/H=0.67, gamma=1.29).
    scale : float | str | None, optional
        Scale factor on the motion.
    target_pga : float | str | None, optional
        Peak ground acceleration to scale the motion to, in g.
    target_pgv : float | str | None, optional
        Peak ground velocity to scale the motion to, in m/s.
    polarity : {"1", "-1", "both"}, optional
        Polarity of the motion: 1 as given, -1 reversed. By default both.
    restitution : float | None, optional
        Coefficient of restitution of all impacts; of a structure that rocks to one side, the rebound. By default that
        of the structure.
    engine : {"exact", "blocks", "auto"}, optional
        Engine: exact (one degree of freedom), blocks (free blocks), or auto (blocks if exact tells no outcome). By
        default exact.
    opening : float, optional
        Largest opening of a joint up to which a history holds, over D_cr. By default 0.005.
    neighbours : int | None, optional
        Number of neighbouring motions to simulate as well; 0 for none. By default 200, or 20 with free blocks.
    amplitude_deviation : float, optional
        Standard deviation of ln amplitude of the neighbours. By default 0.04.
    slenderness_deviation : float | None, optional
        Standard deviation of ln slenderness. By default that of the file, or 10 %.
    restitution_deviation : float | None, optional
        Standard deviation of restitution. By default that of the file, 0.03 of a given value, or 0.05.
    out : str | Path | None, optional
        Write the shares (.csv or .xlsx).  - is standard output.
    separator : {",", ";", "tab"}, optional
        Separator of the CSV table. By default a comma.
    decimal : {".", ","}, optional
        Decimal sign of the CSV table. By default a point.
    watch : Watcher
        Told what is read and written, what is doubtful, and how far the work is.

    Returns
    -------
    MappingAnswer of str to Margin
        Margins, by name of the motion.

    Raises
    ------
    InputError
        If a value is out of range, or a file cannot be used.
    MechanismError
        If the structure has no critical rotation or no uplift acceleration.
    SolverError
        If a motion cannot be simulated to its end.

    Notes
    -----
    The model is the nonlinear one, Eq. 8 of DeJong and Dimitrakopoulos (2014), under the neighbours of the motion at
    each of many scale factors.

    Examples
    --------
    >>> import rocking_cli as rk
    >>> answer = rk.margin(rk.Block(width=0.7, height=2.8), "sine:0.4g:0.8s", polarity="1", neighbours=10)
    >>> [round(each.uplift, 3) for each in answer.values()]
    [0.625]
    """

def shares(
    structure: StructureLike,
    motions: Motion | Sequence[Motion] | Motions,
    *,
    units: str | None = ...,
    dt: float | str | None = ...,
    channel: str | int | None = ...,
    quantity: Literal["acceleration", "velocity", "displacement"] | None = ...,
    gain: Gain | str | None = ...,
    run_on: bool | None = ...,
    despite_header: bool | None = ...,
    other: str | Path | None = ...,
    other_channel: str | int | None = ...,
    azimuth: float | str | None = ...,
    floor: Floor | str | Mapping[str, Any] | None = ...,
    scale: float | str | None = ...,
    target_pga: float | str | None = ...,
    target_pgv: float | str | None = ...,
    polarity: Literal['1', '-1', 'both', 1, -1] = ...,
    opening: float | str = ...,
    neighbours: int | None = ...,
    amplitude_deviation: float | str = ...,
    slenderness_deviation: float | str | None = ...,
    restitution_deviation: float | str | None = ...,
    watch: Watcher = ...,
) -> Answer[OutcomeShares]:
    """Compute the shares of the neighbours of a motion that overturn, that do not, and whose outcome is unknown.

    Parameters
    ----------
    structure : StructureLike
        The structure, or its YAML file.
    motions : Motion | Sequence[Motion] | Motions
        One motion or several, their files, or pulses as text; a pattern such as `records/*.AT2` gives several.
    units : str | None, optional
        Unit of the record, if the file does not state it.
    dt : float | str | None, optional
        Sampling interval in s, if the file has no times.
    channel : str | int | None, optional
        Channel or column to read: its number, from 1, or its name.
    quantity : Literal["acceleration", "velocity", "displacement"] | None, optional
        Quantity in the record; velocities and displacements are differentiated.
    gain : Gain | str | None, optional
        Instrument sensitivity: the value of one unit of the record, such as 0.05m/V or 4.7e-6m/s2/count.
    run_on : bool | None, optional
        Read a text without times as one series that runs on over its rows.
    despite_header : bool | None, optional
        Accept a text with other numbers of points or peaks than its header states, as it was cut on purpose.
    other : str | Path | None, optional
        Second horizontal component, perpendicular to the record; the two are rotated into the plane of the structure.
    other_channel : str | int | None, optional
        Channel of the second component in its file.
    azimuth : float | str | None, optional
        Azimuth of the structure's plane, in degrees: 0 is the record, 90 the second. `respond` also accepts all.
    floor : Floor | str | Mapping[str, Any] | None, optional
        Floor of a building on which the structure stands: T1=0.4,xi=0.05,z=6m,H=9m,n=3 (or z/H=0.67, gamma=1.29).
    scale : float | str | None, optional
        Scale factor on the motion.
    target_pga : float | str | None, optional
        Peak ground acceleration to scale the motion to, in g.
    target_pgv : float | str | None, optional
        Peak ground velocity to scale the motion to, in m/s.
    polarity : {"1", "-1", "both"}, optional
        Polarity of the motion: 1 as given, -1 reversed. By default 1.
    opening : float, optional
        Largest opening of a joint up to which a history holds, over D_cr. By default 0.005.
    neighbours : int | None, optional
        Number of neighbouring motions to simulate as well; 0 for none. By default 200, or 20 with free blocks.
    amplitude_deviation : float, optional
        Standard deviation of ln amplitude of the neighbours. By default 0.04.
    slenderness_deviation : float | None, optional
        Standard deviation of ln slenderness. By default that of the file, or 10 %.
    restitution_deviation : float | None, optional
        Standard deviation of restitution. By default that of the file, 0.03 of a given value, or 0.05.
    watch : Watcher
        Told what is read and written, what is doubtful, and how far the work is.

    Returns
    -------
    Answer of OutcomeShares
        `overturned`, `stands` and `unknown`.

    Raises
    ------
    InputError
        If a value is out of range, or a file cannot be used.
    MechanismError
        If the structure has no critical rotation or no uplift acceleration.
    SolverError
        If a motion cannot be simulated to its end.

    Notes
    -----
    The shares are those that `score` compares with tests. The model is the nonlinear one, Eq. 8 of DeJong and
    Dimitrakopoulos (2014).

    Examples
    --------
    >>> import rocking_cli as rk
    >>> answer = rk.shares(rk.Block(width=0.7, height=2.8), "sine:0.39g:0.8s")
    >>> 0.3 < answer.overturned < 0.7
    True
    """

def overturning(
    structures: StructureLike | Sequence[StructureLike] = ...,
    *,
    compare: bool = ...,
    model: Literal['nonlinear', 'linear1', 'linear2'] | None = ...,
    points: int | None = ...,
    plot: str | Path | None = ...,
    shape: str = ...,
    period: Range | None = ...,
    restitution: float | str | None = ...,
    polarity: Literal['1', '-1', 'both', 1, -1] = ...,
    opening: float | str = ...,
    ag: Range | None = ...,
    omega: Range | None = ...,
    a: Range | None = ...,
    dimensionless: bool = ...,
    engine: Literal['exact', 'blocks', 'auto'] = ...,
    out: str | Path | None = ...,
    separator: Literal[',', ';', 'tab'] | None = ...,
    decimal: Literal['.', ','] | None = ...,
    watch: Watcher = ...,
) -> Answer[OverturningMap] | Answer[Comparison]:
    """Map the pulses that overturn a structure, or compare several structures.

    This is `overturning_map` of one structure or of the linear block, or `overturning_curves` with `compare`.

    Parameters
    ----------
    structures : StructureLike | Sequence[StructureLike], optional
        One structure for a map, several to compare; without any, the dimensionless linear block.
    compare : bool, optional
        Compare the smallest overturning amplitudes of several structures instead of a map.
    model : {"nonlinear", "linear1", "linear2"}, optional
        Model: nonlinear (the mechanism itself), or its equivalent block (linear1, linear2). By default linear2;
        nonlinear to compare, and with free blocks.
    points : int | None, optional
        Number of points along each side of a map, or of periods to compare. By default 256; 60 to compare; 12 with free
        blocks.
    plot : str | Path | None, optional
        Plot the map, or the curves (.png, .svg or .pdf).
    shape : str, optional
        Shape of the pulses: sine, cosine, half_sine, rectangular, ricker, ..., then its parameters if it has any. By
        default sine.
    period : Range | None, optional
        Smallest and largest period, such as 0.2s:4s. [s] By default around overturning.
    restitution : float | None, optional
        Coefficient of restitution of all impacts; of a structure that rocks to one side, the rebound. By default that
        of the structure.
    polarity : {"1", "-1", "both"}, optional
        Polarity of the motion: 1 as given, -1 reversed. By default 1.
    opening : float, optional
        Largest opening of a joint up to which a history holds, over D_cr. By default 0.005.
    ag : Range | None, optional
        Smallest and largest amplitude; a text needs its unit: 0.1g:2g. [g] By default 0.7 to 10 times uplift.
    omega : Range | None, optional
        Smallest and largest dimensionless frequency omega = omega_g/p. By default around overturning.
    a : Range | None, optional
        Smallest and largest dimensionless amplitude a = a_g/(g lambda). By default 0.5:10.
    dimensionless : bool, optional
        Use the dimensionless axes omega and a, also with a structure.
    engine : {"exact", "blocks", "auto"}, optional
        Engine: exact (one degree of freedom), blocks (free blocks), or auto (blocks if exact tells no outcome). By
        default exact.
    out : str | Path | None, optional
        Write the map, one point per line, or the curves (.csv or .xlsx).  - is standard output.
    separator : {",", ";", "tab"}, optional
        Separator of the CSV table. By default a comma.
    decimal : {".", ","}, optional
        Decimal sign of the CSV table. By default a point.
    watch : Watcher
        Told what is read and written, what is doubtful, and how far the work is.

    Returns
    -------
    Answer of OverturningMap or Comparison
        As for `overturning_map` and `overturning_curves`.

    Raises
    ------
    InputError
        If a value is out of range, arguments cannot be combined, or a file cannot be used.
    MechanismError
        If the structure has no critical rotation or no uplift acceleration.
    SolverError
        If a motion cannot be simulated to its end.

    Notes
    -----
    DeJong and Dimitrakopoulos (2014), Section 6, with the dimensionless numbers of Eq. 40.

    Examples
    --------
    >>> import rocking_cli as rk
    >>> rk.overturning(points=24).outcome.overturned.shape
    (24, 24)
    """

def overturning_curves(
    structures: StructureLike | Sequence[StructureLike],
    *,
    model: Literal['nonlinear', 'linear1', 'linear2'] = ...,
    top: float | str | None = ...,
    points: int = ...,
    shape: str = ...,
    period: Range | None = ...,
    restitution: float | str | None = ...,
    polarity: Literal['1', '-1', 'both', 1, -1] = ...,
    opening: float | str = ...,
    watch: Watcher = ...,
) -> Answer[Comparison]:
    """Compute the smallest amplitude that overturns each structure, against the period of a pulse.

    Parameters
    ----------
    structures : StructureLike | Sequence[StructureLike]
        The structures to compare.
    model : {"nonlinear", "linear1", "linear2"}, optional
        Model of the structures. By default nonlinear.
    top : float | None, optional
        Largest amplitude to try. [g] By default 10 times uplift.
    points : int, optional
        Number of periods, at equal ratios. By default 60.
    shape : str, optional
        Shape of the pulses: sine, cosine, half_sine, rectangular, ricker, ..., then its parameters if it has any. By
        default sine.
    period : Range | None, optional
        Smallest and largest period, such as 0.2s:4s. [s] By default around overturning.
    restitution : float | None, optional
        Coefficient of restitution of all impacts; of a structure that rocks to one side, the rebound. By default that
        of the structure.
    polarity : {"1", "-1", "both"}, optional
        Polarity of the motion: 1 as given, -1 reversed. By default 1.
    opening : float, optional
        Largest opening of a joint up to which a history holds, over D_cr. By default 0.005.
    watch : Watcher
        Told what is read and written, what is doubtful, and how far the work is.

    Returns
    -------
    Answer of Comparison
        Smallest amplitudes `least` known to overturn, and the structure that overturns first; overturning starts
        between `possible` and `least` if outcomes below are unknown.

    Raises
    ------
    InputError
        If a value is out of range, or a file cannot be used.
    MechanismError
        If the structure has no critical rotation or no uplift acceleration.
    SolverError
        If a motion cannot be simulated to its end.

    Notes
    -----
    The models are those of `respond`: DeJong and Dimitrakopoulos (2014).

    Examples
    --------
    >>> import rocking_cli as rk
    >>> blocks = [rk.Block(width=0.7, height=2.8), rk.Block(width=1.4, height=5.6)]
    >>> rk.overturning_curves(blocks, model="linear2", points=3).least.shape
    (2, 3)
    """

def overturning_map(
    structure: StructureLike | None = ...,
    *,
    model: Literal['nonlinear', 'linear1', 'linear2'] = ...,
    points: int = ...,
    shape: str = ...,
    period: Range | None = ...,
    restitution: float | str | None = ...,
    polarity: Literal['1', '-1', 'both', 1, -1] = ...,
    opening: float | str = ...,
    ag: Range | None = ...,
    omega: Range | None = ...,
    a: Range | None = ...,
    dimensionless: bool = ...,
    engine: Literal['exact', 'blocks', 'auto'] = ...,
    watch: Watcher = ...,
) -> Answer[OverturningMap]:
    """Map the effect of pulses of all periods and amplitudes on a structure, or on the dimensionless linear block.

    Parameters
    ----------
    structure : StructureLike | None, optional
        The structure, or its YAML file; without it, the linear block, with the axes omega and a.
    model : {"nonlinear", "linear1", "linear2"}, optional
        Model of the structure. By default linear2.
    points : int, optional
        Number of points along each side. By default 256.
    shape : str, optional
        Shape of the pulses: sine, cosine, half_sine, rectangular, ricker, ..., then its parameters if it has any. By
        default sine.
    period : Range | None, optional
        Smallest and largest period, such as 0.2s:4s. [s] By default around overturning.
    restitution : float | None, optional
        Coefficient of restitution of all impacts; of a structure that rocks to one side, the rebound. By default that
        of the structure.
    polarity : {"1", "-1", "both"}, optional
        Polarity of the motion: 1 as given, -1 reversed. By default 1.
    opening : float, optional
        Largest opening of a joint up to which a history holds, over D_cr. By default 0.005.
    ag : Range | None, optional
        Smallest and largest amplitude; a text needs its unit: 0.1g:2g. [g] By default 0.7 to 10 times uplift.
    omega : Range | None, optional
        Smallest and largest dimensionless frequency omega = omega_g/p. By default around overturning.
    a : Range | None, optional
        Smallest and largest dimensionless amplitude a = a_g/(g lambda). By default 0.5:10.
    dimensionless : bool, optional
        Use the dimensionless axes omega and a, also with a structure.
    engine : {"exact", "blocks", "auto"}, optional
        Engine: exact (one degree of freedom), blocks (free blocks), or auto (blocks if exact tells no outcome). By
        default exact.
    watch : Watcher
        Told what is read and written, what is doubtful, and how far the work is.

    Returns
    -------
    Answer of OverturningMap
        Outcome under every pulse; `regions` has the class of each, unknown outcomes among them.

    Raises
    ------
    InputError
        If a value is out of range, or a file cannot be used.
    MechanismError
        If the structure has no critical rotation or no uplift acceleration.
    SolverError
        If a motion cannot be simulated to its end.

    Notes
    -----
    Dimensionless amplitude and frequency: DeJong and Dimitrakopoulos (2014), Eq. 40.

    Examples
    --------
    >>> import rocking_cli as rk
    >>> found = rk.overturning_map(points=24)
    >>> found.outcome.overturned.shape
    (24, 24)
    """

def pulse(
    structure: StructureLike | None = ...,
    *,
    a: float | str | None = ...,
    omega: float | str | None = ...,
    restitution: float | str = ...,
    ag: float | str | None = ...,
    period: float | str | None = ...,
    shape: str = ...,
    polarity: Literal['1', '-1', 'both', 1, -1] = ...,
    opening: float | str = ...,
    watch: Watcher = ...,
) -> MappingAnswer[Any, Any]:
    """Compute the response to a pulse, of a structure or of the dimensionless linear block.

    Parameters
    ----------
    structure : StructureLike | None, optional
        The structure, or its YAML file; without it, the dimensionless linear block.
    a : float | None, optional
        Dimensionless amplitude a = a_g/(g lambda), of the linear block.
    omega : float | None, optional
        Dimensionless frequency omega = omega_g/p, of the linear block.
    restitution : float, optional
        Coefficient of restitution of the linear block. By default 0.9.
    ag : float | None, optional
        Amplitude of the pulse; a text needs its unit: 0.6g, 5.9m/s2. [g]
    period : float | None, optional
        Period of the pulse, such as 0.8s. [s]
    shape : str, optional
        Shape of the pulse: sine, cosine, half_sine, rectangular, ricker, ..., then its parameters if it has any. By
        default sine.
    polarity : {"1", "-1", "both"}, optional
        Polarity of the motion: 1 as given, -1 reversed. By default 1.
    opening : float, optional
        Largest opening of a joint up to which a history holds, over D_cr. By default 0.005.
    watch : Watcher
        Told what is read and written, what is doubtful, and how far the work is.

    Returns
    -------
    MappingAnswer of SampledHistory, ExactResponse or ClosedForm
        For a structure, by polarity, 1 or -1, the responses of the models "linear1", "linear2" and "nonlinear". For the
        linear block, the "exact" solution, and the "closed_form" if the shape is a sine.

    Raises
    ------
    InputError
        If a value is out of range, arguments for a structure and for the linear block are given, or a file cannot be
        used.
    MechanismError
        If the structure has no critical rotation or no uplift acceleration.
    SolverError
        If a motion cannot be simulated to its end.

    Notes
    -----
    The closed form is Eqs. 41-42 of DeJong and Dimitrakopoulos (2014), with the dimensionless numbers of Eq. 40.

    Examples
    --------
    >>> import rocking_cli as rk
    >>> rk.pulse(a=4, omega=6)["exact"].overturned
    False
    """

@overload
def record(  # type: ignore[overload-overlap]
    motions: Motion,
    *,
    structure: StructureLike | None = ...,
    fit_pulse: bool = ...,
    measures: str | Sequence[str] | None = ...,
    spectrum: str | Path | bool = ...,
    period: tuple[float | str, float] | None = ...,
    damping: float | str = ...,
    out: Any = ...,
    plot: str | Path | None = ...,
    units: str | None = ...,
    dt: float | str | None = ...,
    channel: str | int | None = ...,
    quantity: Literal["acceleration", "velocity", "displacement"] | None = ...,
    gain: Gain | str | None = ...,
    run_on: bool | None = ...,
    despite_header: bool | None = ...,
    other: str | Path | None = ...,
    other_channel: str | int | None = ...,
    azimuth: float | str | None = ...,
    floor: Floor | str | Mapping[str, Any] | None = ...,
    scale: float | str | None = ...,
    target_pga: float | str | None = ...,
    target_pgv: float | str | None = ...,
    polarity: Literal['1', '-1', 'both', 1, -1] = ...,
    baseline: Step | str | None = ...,
    highpass: Step | str | float | None = ...,
    lowpass: Step | str | float | None = ...,
    taper: Step | str | float | None = ...,
    trim: Step | str | None = ...,
    resample: Step | str | float | None = ...,
    watch: Watcher = ...,
) -> RecordAnswer:
    """Measure the strength of ground motions, and check them for defects.

    Parameters
    ----------
    motions : Motion | Sequence[Motion] | Motions
        One motion or several, their files, or pulses as text; a pattern such as `records/*.AT2` gives several.
    structure : StructureLike | None, optional
        Structure, or its file, to check the sampling interval and for relative measures.
    fit_pulse : bool, optional
        Fit a sine, a Ricker and a near-fault pulse to each record; the plot shows the best.
    measures : str | Sequence[str] | None, optional
        Intensity measures to compute as well, or all; `rocking measures` lists them.
    spectrum : str | Path | bool, optional
        Write the response spectrum of each record; the plot draws it and JSON includes it. In Python also True, for the
        frame of spectra alone.  - is standard output.
    period : tuple[float, float] | None, optional
        Shortest and longest period of the spectrum. [s] By default 0.02:10.
    damping : float, optional
        Damping ratio of the spectrum. By default 0.05.
    out : Any, optional
        Write each record as it is corrected and scaled, and what was done to it: FILE.csv, or a folder (created if
        missing) that receives NAME.csv.  - is standard output.
    plot : str | Path | None, optional
        Plot one record, or the spectra (.png, .svg or .pdf).
    units : str | None, optional
        Unit of the record, if the file does not state it.
    dt : float | str | None, optional
        Sampling interval in s, if the file has no times.
    channel : str | int | None, optional
        Channel or column to read: its number, from 1, or its name.
    quantity : Literal["acceleration", "velocity", "displacement"] | None, optional
        Quantity in the record; velocities and displacements are differentiated.
    gain : Gain | str | None, optional
        Instrument sensitivity: the value of one unit of the record, such as 0.05m/V or 4.7e-6m/s2/count.
    run_on : bool | None, optional
        Read a text without times as one series that runs on over its rows.
    despite_header : bool | None, optional
        Accept a text with other numbers of points or peaks than its header states, as it was cut on purpose.
    other : str | Path | None, optional
        Second horizontal component, perpendicular to the record; the two are rotated into the plane of the structure.
    other_channel : str | int | None, optional
        Channel of the second component in its file.
    azimuth : float | str | None, optional
        Azimuth of the structure's plane, in degrees: 0 is the record, 90 the second. `respond` also accepts all.
    floor : Floor | str | Mapping[str, Any] | None, optional
        Floor of a building on which the structure stands: T1=0.4,xi=0.05,z=6m,H=9m,n=3 (or z/H=0.67, gamma=1.29).
    scale : float | str | None, optional
        Scale factor on the motion.
    target_pga : float | str | None, optional
        Peak ground acceleration to scale the motion to, in g.
    target_pgv : float | str | None, optional
        Peak ground velocity to scale the motion to, in m/s.
    polarity : {"1", "-1", "both"}, optional
        Polarity of the motion: 1 as given, -1 reversed. By default 1.
    baseline : Step | str | None, optional
        Baseline correction: the best-fitting constant, line or parabola is subtracted.
    highpass : Step | str | float | None, optional
        High-pass corner frequency in Hz (Butterworth, zero phase).
    lowpass : Step | str | float | None, optional
        Low-pass corner frequency in Hz (Butterworth, zero phase).
    taper : Step | str | float | None, optional
        Fraction of the duration over which each end is tapered to zero.
    trim : Step | str | None, optional
        Start and end of the part to keep, in s.
    resample : Step | str | float | None, optional
        Resample to this interval, in s; uneven times are put on a regular grid.
    watch : Watcher
        Told what is read and written, what is doubtful, and how far the work is.

    Returns
    -------
    RecordAnswer
        Peaks, Arias intensity, durations and mean period; `examined` has all else. For several motions, `Answers` with
        one for each, by its name.

    Raises
    ------
    InputError
        If a value is out of range, or a file cannot be used.

    Notes
    -----
    The measures are exact for straight lines between the samples; the intensity is that of Arias (1970), pi/(2 g) times
    the integral of the squared acceleration.

    Examples
    --------
    >>> import rocking_cli as rk
    >>> round(rk.record("ricker:0.6g:0.5s").pga_g, 6)
    0.6
    >>> block = rk.Block(width=0.7, height=2.8)
    >>> round(rk.record("ricker:0.6g:0.5s", structure=block, measures="PGA/(g lambda)").measures["PGA/(g lambda)"], 6)
    2.4
    """

@overload
def record(
    motions: list[Any] | tuple[Any, ...],
    *,
    structure: StructureLike | None = ...,
    fit_pulse: bool = ...,
    measures: str | Sequence[str] | None = ...,
    spectrum: str | Path | bool = ...,
    period: tuple[float | str, float] | None = ...,
    damping: float | str = ...,
    out: Any = ...,
    plot: str | Path | None = ...,
    units: str | None = ...,
    dt: float | str | None = ...,
    channel: str | int | None = ...,
    quantity: Literal["acceleration", "velocity", "displacement"] | None = ...,
    gain: Gain | str | None = ...,
    run_on: bool | None = ...,
    despite_header: bool | None = ...,
    other: str | Path | None = ...,
    other_channel: str | int | None = ...,
    azimuth: float | str | None = ...,
    floor: Floor | str | Mapping[str, Any] | None = ...,
    scale: float | str | None = ...,
    target_pga: float | str | None = ...,
    target_pgv: float | str | None = ...,
    polarity: Literal['1', '-1', 'both', 1, -1] = ...,
    baseline: Step | str | None = ...,
    highpass: Step | str | float | None = ...,
    lowpass: Step | str | float | None = ...,
    taper: Step | str | float | None = ...,
    trim: Step | str | None = ...,
    resample: Step | str | float | None = ...,
    watch: Watcher = ...,
) -> Answers[RecordAnswer]:
    ...

@overload
def record(
    motions: Motion | Sequence[Motion] | Motions,
    *,
    structure: StructureLike | None = ...,
    fit_pulse: bool = ...,
    measures: str | Sequence[str] | None = ...,
    spectrum: str | Path | bool = ...,
    period: tuple[float | str, float] | None = ...,
    damping: float | str = ...,
    out: Any = ...,
    plot: str | Path | None = ...,
    units: str | None = ...,
    dt: float | str | None = ...,
    channel: str | int | None = ...,
    quantity: Literal["acceleration", "velocity", "displacement"] | None = ...,
    gain: Gain | str | None = ...,
    run_on: bool | None = ...,
    despite_header: bool | None = ...,
    other: str | Path | None = ...,
    other_channel: str | int | None = ...,
    azimuth: float | str | None = ...,
    floor: Floor | str | Mapping[str, Any] | None = ...,
    scale: float | str | None = ...,
    target_pga: float | str | None = ...,
    target_pgv: float | str | None = ...,
    polarity: Literal['1', '-1', 'both', 1, -1] = ...,
    baseline: Step | str | None = ...,
    highpass: Step | str | float | None = ...,
    lowpass: Step | str | float | None = ...,
    taper: Step | str | float | None = ...,
    trim: Step | str | None = ...,
    resample: Step | str | float | None = ...,
    watch: Watcher = ...,
) -> RecordAnswer | Answers[RecordAnswer]:
    ...

def response_spectrum(
    motions: Motion,
    periods: ArrayLike | None = ...,
    *,
    damping: float | str = ...,
    scale: float | str = ...,
    watch: Watcher = ...,
) -> Answer[ResponseSpectrum]:
    """Compute the response spectrum of a ground motion: the peak responses of linear oscillators.

    Parameters
    ----------
    motions : Motion
        The ground motion, its file, or a pulse as text.
    periods : ArrayLike | None, optional
        Undamped periods of the oscillators [s]. By default 200 from 0.02 to 10 s at equal ratios.
    damping : float, optional
        Damping ratio of the oscillators. By default 0.05.
    scale : float, optional
        Scale factor on the motion. By default 1.0.
    watch : Watcher
        Told what is read and written, what is doubtful, and how far the work is.

    Returns
    -------
    Answer of ResponseSpectrum
        `periods`, and at each of them the displacement `sd` [m], the pseudo-velocity `sv` [m/s] and the
        pseudo-acceleration `sa` [standard gravity].

    Raises
    ------
    InputError
        If a value is out of range, or a file cannot be used.

    Notes
    -----
    The spectrum is exact for straight lines between the samples, during the motion and after it.

    Examples
    --------
    >>> import rocking_cli as rk
    >>> rk.response_spectrum("sine:0.2g:0.8s", [0.8]).sa.round(2).tolist()
    [0.54]
    """

def report(
    structure: StructureLike,
    motions: Motion | Sequence[Motion] | Motions = ...,
    *,
    out: str | Path | None = ...,
    verify: SiteLike | None = ...,
    explore: bool = ...,
    units: str | None = ...,
    dt: float | str | None = ...,
    channel: str | int | None = ...,
    quantity: Literal["acceleration", "velocity", "displacement"] | None = ...,
    gain: Gain | str | None = ...,
    run_on: bool | None = ...,
    despite_header: bool | None = ...,
    other: str | Path | None = ...,
    other_channel: str | int | None = ...,
    azimuth: float | str | None = ...,
    floor: Floor | str | Mapping[str, Any] | None = ...,
    scale: float | str | None = ...,
    target_pga: float | str | None = ...,
    target_pgv: float | str | None = ...,
    polarity: Literal['1', '-1', 'both', 1, -1] = ...,
    state: str | None = ...,
    on_floor: bool = ...,
    restitution: float | str | None = ...,
    neighbours: int | None = ...,
    amplitude_deviation: float | str = ...,
    slenderness_deviation: float | str | None = ...,
    restitution_deviation: float | str | None = ...,
    opening: float | str = ...,
    language: Literal['en', 'it'] | None = ...,
    project: str | None = ...,
    place: str | None = ...,
    client: str | None = ...,
    author: str | None = ...,
    logo: str | Path | None = ...,
    origin: str | None = ...,
    watch: Watcher = ...,
) -> Answer[Assessment]:
    """Write a report: one HTML file that opens in any browser and can be printed, a PDF, or a .docx file.

    Parameters
    ----------
    structure : StructureLike
        The structure, or its YAML file.
    motions : Motion | Sequence[Motion] | Motions, optional
        One motion or several, their files, or pulses as text; without any, no histories are followed.
    out : str | Path | None, optional
        Output file; .pdf needs a browser or an extra package, .docx an extra package. By default the name of FILE with
        the ending .html, in this folder; none with JSON, or in Python.
    verify : SiteLike | None, optional
        Site file of a verification by code that becomes part of the report.
    explore : bool, optional
        Put the page of `rocking explore` in the place of the animation, in HTML.
    units : str | None, optional
        Unit of the record, if the file does not state it.
    dt : float | str | None, optional
        Sampling interval in s, if the file has no times.
    channel : str | int | None, optional
        Channel or column to read: its number, from 1, or its name.
    quantity : Literal["acceleration", "velocity", "displacement"] | None, optional
        Quantity in the record; velocities and displacements are differentiated.
    gain : Gain | str | None, optional
        Instrument sensitivity: the value of one unit of the record, such as 0.05m/V or 4.7e-6m/s2/count.
    run_on : bool | None, optional
        Read a text without times as one series that runs on over its rows.
    despite_header : bool | None, optional
        Accept a text with other numbers of points or peaks than its header states, as it was cut on purpose.
    other : str | Path | None, optional
        Second horizontal component, perpendicular to the record; the two are rotated into the plane of the structure.
    other_channel : str | int | None, optional
        Channel of the second component in its file.
    azimuth : float | str | None, optional
        Azimuth of the structure's plane, in degrees: 0 is the record, 90 the second. `respond` also accepts all.
    floor : Floor | str | Mapping[str, Any] | None, optional
        Floor of a building on which the structure stands: T1=0.4,xi=0.05,z=6m,H=9m,n=3 (or z/H=0.67, gamma=1.29).
    scale : float | str | None, optional
        Scale factor on the motion.
    target_pga : float | str | None, optional
        Peak ground acceleration to scale the motion to, in g.
    target_pgv : float | str | None, optional
        Peak ground velocity to scale the motion to, in m/s.
    polarity : {"1", "-1", "both"}, optional
        Polarity of the motion: 1 as given, -1 reversed. By default both.
    state : str | None, optional
        Limit state to which the records belong, such as SLC, if the site gives it. By default that of the verdict.
    on_floor : bool, optional
        The motions are those of the floor of the site, and not of the ground.
    restitution : float | None, optional
        Coefficient of restitution of all impacts; of a structure that rocks to one side, the rebound. By default that
        of the structure.
    neighbours : int | None, optional
        Number of neighbours of each motion to simulate, which show how close the result is. By default 200.
    amplitude_deviation : float, optional
        Standard deviation of ln amplitude of the neighbours. By default 0.04.
    slenderness_deviation : float | None, optional
        Standard deviation of ln slenderness. By default that of the file, or 10 %.
    restitution_deviation : float | None, optional
        Standard deviation of restitution. By default that of the file, 0.03 of a given value, or 0.05.
    opening : float, optional
        Largest opening of a joint up to which a history holds, over D_cr. By default 0.005.
    language : {"en", "it"}, optional
        Language of the answer and of documents. By default that of the site, or en.
    project : str | None, optional
        Project name, for the heading of the document.
    place : str | None, optional
        Location of the structure, for the heading.
    client : str | None, optional
        Client who ordered the document, for the heading.
    author : str | None, optional
        Author of the document, for the heading.
    logo : str | Path | None, optional
        Author's logo (.png, .jpg or .svg), for the heading.
    origin : str | None, optional
        What the document says of how it was made. By default the command, or the call of Python.
    watch : Watcher
        Told what is read and written, what is doubtful, and how far the work is.

    Returns
    -------
    Answer of Assessment
        Contents of the report.

    Raises
    ------
    InputError
        If a value is out of range, or a file cannot be read or written.
    MechanismError
        If the structure has no critical rotation or no uplift acceleration.
    SolverError
        If a motion cannot be simulated to its end.

    Notes
    -----
    The report contains the results of `equiv`, `respond`, `margin`, `overturning_map` and `linearisation`, and those
    of `verify` if a site is given.

    Examples
    --------
    >>> import rocking_cli as rk
    >>> answer = rk.report(rk.Block(width=0.7, height=2.8))
    >>> answer.has_block
    True
    """

@overload
def respond(  # type: ignore[overload-overlap]
    structure: StructureLike,
    motions: Motion = ...,
    *,
    engine: Literal['exact', 'blocks', 'auto'] | None = ...,
    tail: float | str = ...,
    plot: str | Path | None = ...,
    animate: str | Path | None = ...,
    units: str | None = ...,
    dt: float | str | None = ...,
    channel: str | int | None = ...,
    quantity: Literal["acceleration", "velocity", "displacement"] | None = ...,
    gain: Gain | str | None = ...,
    run_on: bool | None = ...,
    despite_header: bool | None = ...,
    other: str | Path | None = ...,
    other_channel: str | int | None = ...,
    azimuth: float | str | None = ...,
    floor: Floor | str | Mapping[str, Any] | None = ...,
    scale: float | str | None = ...,
    target_pga: float | str | None = ...,
    target_pgv: float | str | None = ...,
    polarity: Literal['1', '-1', 'both', 1, -1] = ...,
    release: Release | float | str | None = ...,
    vertical: GroundMotion | str | Path | None = ...,
    vertical_dt: float | str | None = ...,
    vertical_channel: str | None = ...,
    transverse: GroundMotion | str | Path | None = ...,
    transverse_channel: str | None = ...,
    with_pulse: Literal['best', 'sine', 'ricker', 'mavroeidis'] | None = ...,
    in_space: bool = ...,
    mesh: str | Path | None = ...,
    mesh_units: str | None = ...,
    model: ModelName | Sequence[ModelName] | None = ...,
    rtol: float | str = ...,
    restitution: float | str | None = ...,
    opening: float | str = ...,
    neighbours: int | None = ...,
    amplitude_deviation: float | str = ...,
    slenderness_deviation: float | str | None = ...,
    restitution_deviation: float | str | None = ...,
    impacts: bool = ...,
    contact: bool = ...,
    each_block: bool = ...,
    title: str | None = ...,
    out: str | Path | None = ...,
    separator: Literal[',', ';', 'tab'] | None = ...,
    decimal: Literal['.', ','] | None = ...,
    watch: Watcher = ...,
) -> ResponseAnswer:
    """Compute the response of a structure to ground motions, a release or both; `respond_each` is for outcomes alone.

    Parameters
    ----------
    structure : StructureLike
        The structure, or its YAML file.
    motions : Motion | Sequence[Motion] | Motions, optional
        One motion or several, their files, or pulses as text; a pattern such as `records/*.AT2` gives several.
    engine : {"exact", "blocks", "auto"}, optional
        Engine: exact (one degree of freedom), blocks (free blocks beside it), or auto (blocks beside it if exact tells
        no outcome). By default auto for a single motion, as far as free blocks are installed and take few steps;
        otherwise exact.
    tail : float, optional
        Length of output after the end of the record. [s] By default 10.0.
    plot : str | Path | None, optional
        Plot the time histories (.png, .svg or .pdf).
    animate : str | Path | None, optional
        Animate one degree of freedom, with free blocks beside it if they simulate the motion: .gif, .mp4 (requires
        ffmpeg), or .html, a self-contained page with a slider.
    units : str | None, optional
        Unit of the record, if the file does not state it.
    dt : float | str | None, optional
        Sampling interval in s, if the file has no times.
    channel : str | int | None, optional
        Channel or column to read: its number, from 1, or its name.
    quantity : Literal["acceleration", "velocity", "displacement"] | None, optional
        Quantity in the record; velocities and displacements are differentiated.
    gain : Gain | str | None, optional
        Instrument sensitivity: the value of one unit of the record, such as 0.05m/V or 4.7e-6m/s2/count.
    run_on : bool | None, optional
        Read a text without times as one series that runs on over its rows.
    despite_header : bool | None, optional
        Accept a text with other numbers of points or peaks than its header states, as it was cut on purpose.
    other : str | Path | None, optional
        Second horizontal component, perpendicular to the record; the two are rotated into the plane of the structure.
    other_channel : str | int | None, optional
        Channel of the second component in its file.
    azimuth : float | str | None, optional
        Azimuth of the structure's plane, in degrees: 0 is the record, 90 the second. `respond` also accepts all.
    floor : Floor | str | Mapping[str, Any] | None, optional
        Floor of a building on which the structure stands: T1=0.4,xi=0.05,z=6m,H=9m,n=3 (or z/H=0.67, gamma=1.29).
    scale : float | str | None, optional
        Scale factor on the motion.
    target_pga : float | str | None, optional
        Peak ground acceleration to scale the motion to, in g.
    target_pgv : float | str | None, optional
        Peak ground velocity to scale the motion to, in m/s.
    polarity : {"1", "-1", "both"}, optional
        Polarity of the motion: 1 as given, -1 reversed. By default 1.
    release : Release | float | str | None, optional
        Initial tilt of a release from rest: a fraction of phi_cr, or an angle such as 0.05rad; negative is
        anticlockwise.
    vertical : GroundMotion | str | Path | None, optional
        Vertical component of the motion, or its file: g becomes g + v_g''.
    vertical_dt : float | None, optional
        Sampling interval of the vertical component, if its file has no times. [s]
    vertical_channel : str | None, optional
        Channel of the vertical component in its file.
    transverse : GroundMotion | str | Path | None, optional
        Component of the motion along the depth of the body, in three dimensions: a file, or a pulse such as
        sine:0.2g:0.8s.
    transverse_channel : str | None, optional
        Channel of the transverse component in its file.
    with_pulse : {"best", "sine", "ricker", "mavroeidis"}, optional
        Shape of the pulse in the record whose response is computed as well; without a value, the best-fitting one.
    in_space : bool, optional
        Simulate a single free body in three dimensions (experimental), under the motion along its width.
    mesh : str | Path | None, optional
        Mesh of the body, its shape in three dimensions: OBJ, PLY or STL, z upwards, the motion along x.
    mesh_units : str | None, optional
        Unit of the coordinates of the mesh.
    model : ModelName | Sequence[ModelName] | None, optional
        One model or several: nonlinear (the mechanism itself), and its equivalent block (linear1, linear2). By default
        all, or nonlinear alone if the others mislead.
    rtol : float, optional
        Relative error tolerance per step of the nonlinear integration. By default 1e-09.
    restitution : float | None, optional
        Coefficient of restitution of all impacts; of a structure that rocks to one side, the rebound. By default that
        of the structure.
    opening : float, optional
        Largest opening of a joint up to which a history holds, over D_cr. By default 0.005.
    neighbours : int | None, optional
        Number of neighbouring motions to simulate as well; 0 for none. By default 200 on the terminal, 0 in Python and
        with free blocks.
    amplitude_deviation : float, optional
        Standard deviation of ln amplitude of the neighbours. By default 0.04.
    slenderness_deviation : float | None, optional
        Standard deviation of ln slenderness. By default that of the file, or 10 %.
    restitution_deviation : float | None, optional
        Standard deviation of restitution. By default that of the file, 0.03 of a given value, or 0.05.
    impacts : bool, optional
        List the impacts: time, and angular velocity before and after; in a table the first, without chatter.
    contact : bool, optional
        Plot the friction required as well; automatic if the file gives friction.
    each_block : bool, optional
        Make the table the motion of each block, by the nonlinear model: time, block, x, z of its centroid, rotation.
    title : str | None, optional
        Title of tables and plot. By default the name of the structure.
    out : str | Path | None, optional
        Write the time histories (.csv, .parquet or .xlsx).  - is standard output.
    separator : {",", ";", "tab"}, optional
        Separator of the CSV table. By default a comma.
    decimal : {".", ","}, optional
        Decimal sign of the CSV table. By default a point.
    watch : Watcher
        Told what is read and written, what is doubtful, and how far the work is.

    Returns
    -------
    ResponseAnswer
        Time histories, by model. `runs` has those of each polarity, `neighbours` the outcomes of the neighbours,
        `contacts` the contact demands, `fit` and `to_pulse` the pulse and the response to it. Its frame has a row for
        each sample of each history, with its `model`, `polarity` if there are two, and `pulse_alone` (1 under the pulse
        alone) beside a pulse; `phi_ratio` is over phi_cr, or the kinematic limit. Under one polarity all histories are
        as long as the longest: after rest they are zero, after overturning or `known_to` NaN. `to_xarray()` has NaN
        after the end of the shorter polarity. The written table has a row for each time, with the histories beside each
        other. `frames["impacts"]` has the impacts. For several motions, `Answers` with one for each, by its name,
        and `frames["peaks"]` with the peak displacement and tie forces under each; for all azimuths, the answer of
        `respond_around`. Where the outcome of a single motion is unknown, free blocks go on if they are installed and
        take few steps: their history has the model "blocks", and `engines` compares both by polarity (`finding`,
        `parted`, `joints`). Restitution is what their contacts give; what is concluded stays that of the other models.
        In three dimensions, an answer with `checked`, its history and a second one with half of step and softness,
        `motions`, the components, and `plane`, the history of one degree of freedom. It is experimental.

    Raises
    ------
    InputError
        If a value is out of range, a file cannot be used, or kinematics give no restitution for rocking to continue.
    MechanismError
        If the structure has no critical rotation or no uplift acceleration.
    SolverError
        If the motion cannot be simulated to its end.

    Notes
    -----
    DeJong and Dimitrakopoulos (2014): the nonlinear model is Eq. 8, the linear ones are Eq. 16 with kappa1 of Eq. 15
    and kappa2 of Eq. 20; an impact leaves eta of the rate of rotation, Eq. 6.

    Examples
    --------
    >>> import rocking_cli as rk
    >>> answer = rk.respond(rk.Block(width=0.7, height=2.8), "sine:0.3g:0.8s", model="nonlinear")
    >>> answer["nonlinear"].words
    'rocks'
    """

@overload
def respond(
    structure: StructureLike,
    motions: list[Any] | tuple[Any, ...],
    *,
    engine: Literal['exact', 'blocks', 'auto'] | None = ...,
    tail: float | str = ...,
    plot: str | Path | None = ...,
    animate: str | Path | None = ...,
    units: str | None = ...,
    dt: float | str | None = ...,
    channel: str | int | None = ...,
    quantity: Literal["acceleration", "velocity", "displacement"] | None = ...,
    gain: Gain | str | None = ...,
    run_on: bool | None = ...,
    despite_header: bool | None = ...,
    other: str | Path | None = ...,
    other_channel: str | int | None = ...,
    azimuth: float | str | None = ...,
    floor: Floor | str | Mapping[str, Any] | None = ...,
    scale: float | str | None = ...,
    target_pga: float | str | None = ...,
    target_pgv: float | str | None = ...,
    polarity: Literal['1', '-1', 'both', 1, -1] = ...,
    release: Release | float | str | None = ...,
    vertical: GroundMotion | str | Path | None = ...,
    vertical_dt: float | str | None = ...,
    vertical_channel: str | None = ...,
    transverse: GroundMotion | str | Path | None = ...,
    transverse_channel: str | None = ...,
    with_pulse: Literal['best', 'sine', 'ricker', 'mavroeidis'] | None = ...,
    in_space: bool = ...,
    mesh: str | Path | None = ...,
    mesh_units: str | None = ...,
    model: ModelName | Sequence[ModelName] | None = ...,
    rtol: float | str = ...,
    restitution: float | str | None = ...,
    opening: float | str = ...,
    neighbours: int | None = ...,
    amplitude_deviation: float | str = ...,
    slenderness_deviation: float | str | None = ...,
    restitution_deviation: float | str | None = ...,
    impacts: bool = ...,
    contact: bool = ...,
    each_block: bool = ...,
    title: str | None = ...,
    out: str | Path | None = ...,
    separator: Literal[',', ';', 'tab'] | None = ...,
    decimal: Literal['.', ','] | None = ...,
    watch: Watcher = ...,
) -> Answers[ResponseAnswer]:
    ...

@overload
def respond(
    structure: StructureLike,
    motions: Motion | Sequence[Motion] | Motions = ...,
    *,
    engine: Literal['exact', 'blocks', 'auto'] | None = ...,
    tail: float | str = ...,
    plot: str | Path | None = ...,
    animate: str | Path | None = ...,
    units: str | None = ...,
    dt: float | str | None = ...,
    channel: str | int | None = ...,
    quantity: Literal["acceleration", "velocity", "displacement"] | None = ...,
    gain: Gain | str | None = ...,
    run_on: bool | None = ...,
    despite_header: bool | None = ...,
    other: str | Path | None = ...,
    other_channel: str | int | None = ...,
    azimuth: float | str | None = ...,
    floor: Floor | str | Mapping[str, Any] | None = ...,
    scale: float | str | None = ...,
    target_pga: float | str | None = ...,
    target_pgv: float | str | None = ...,
    polarity: Literal['1', '-1', 'both', 1, -1] = ...,
    release: Release | float | str | None = ...,
    vertical: GroundMotion | str | Path | None = ...,
    vertical_dt: float | str | None = ...,
    vertical_channel: str | None = ...,
    transverse: GroundMotion | str | Path | None = ...,
    transverse_channel: str | None = ...,
    with_pulse: Literal['best', 'sine', 'ricker', 'mavroeidis'] | None = ...,
    in_space: bool = ...,
    mesh: str | Path | None = ...,
    mesh_units: str | None = ...,
    model: ModelName | Sequence[ModelName] | None = ...,
    rtol: float | str = ...,
    restitution: float | str | None = ...,
    opening: float | str = ...,
    neighbours: int | None = ...,
    amplitude_deviation: float | str = ...,
    slenderness_deviation: float | str | None = ...,
    restitution_deviation: float | str | None = ...,
    impacts: bool = ...,
    contact: bool = ...,
    each_block: bool = ...,
    title: str | None = ...,
    out: str | Path | None = ...,
    separator: Literal[',', ';', 'tab'] | None = ...,
    decimal: Literal['.', ','] | None = ...,
    watch: Watcher = ...,
) -> ResponseAnswer | Answers[ResponseAnswer]:
    ...

def respond_each(
    structures: StructureLike | Sequence[StructureLike],
    motions: Motion | Sequence[Motion],
    *,
    scale: ArrayLike | None = ...,
    target_pga: ArrayLike | None = ...,
    polarity: ArrayLike | None = ...,
    restitution: ArrayLike | None = ...,
    histories: bool = ...,
    jobs: int | None = ...,
    units: str | None = ...,
    dt: float | str | None = ...,
    channel: str | int | None = ...,
    quantity: Literal["acceleration", "velocity", "displacement"] | None = ...,
    gain: Gain | str | None = ...,
    run_on: bool | None = ...,
    despite_header: bool | None = ...,
    other: str | Path | None = ...,
    other_channel: str | int | None = ...,
    azimuth: float | str | None = ...,
    floor: Floor | str | Mapping[str, Any] | None = ...,
    model: ModelName | Sequence[ModelName] | None = ...,
    opening: float | str = ...,
    out: str | Path | None = ...,
    separator: Literal[',', ';', 'tab'] | None = ...,
    decimal: Literal['.', ','] | None = ...,
    watch: Watcher = ...,
) -> EachAnswer:
    """Compute the outcome of every structure under every motion with every scale factor, polarity and restitution.

    Parameters
    ----------
    structures : StructureLike | Sequence[StructureLike]
        One structure or several, or their YAML files.
    motions : Motion | Sequence[Motion]
        One motion or several, their files, patterns such as `records/*.AT2`, or pulses as text; or samples in an array
        of shape (npts,), or (n, npts) for n motions, with `dt` [s] and `units`, both required.
    scale : ArrayLike | None, optional
        Scale factors on the motions; negative ones reverse them. By default 1.
    target_pga : ArrayLike | None, optional
        In place of `scale`: peak ground accelerations to which each motion is scaled [g], the third axis then.
    polarity : ArrayLike | None, optional
        Polarity of the motions, 1 or -1, or several or both, as a further axis. By default as given.
    restitution : ArrayLike | None, optional
        Ratios of the rotation rates after and before an impact, as a further axis; NaN for that of the structure.
    histories : bool, optional
        Keep the rotations in time: `answer.rotation[model]` at `answer.time`.
    jobs : int | None, optional
        Number of time histories at a time. By default one for each processor.
    units : str | None, optional
        Unit of the record, if the file does not state it.
    dt : float | str | None, optional
        Sampling interval in s, if the file has no times.
    channel : str | int | None, optional
        Channel or column to read: its number, from 1, or its name.
    quantity : Literal["acceleration", "velocity", "displacement"] | None, optional
        Quantity in the record; velocities and displacements are differentiated.
    gain : Gain | str | None, optional
        Instrument sensitivity: the value of one unit of the record, such as 0.05m/V or 4.7e-6m/s2/count.
    run_on : bool | None, optional
        Read a text without times as one series that runs on over its rows.
    despite_header : bool | None, optional
        Accept a text with other numbers of points or peaks than its header states, as it was cut on purpose.
    other : str | Path | None, optional
        Second horizontal component, perpendicular to the record; the two are rotated into the plane of the structure.
    other_channel : str | int | None, optional
        Channel of the second component in its file.
    azimuth : float | str | None, optional
        Azimuth of the structure's plane, in degrees: 0 is the record, 90 the second. `respond` also accepts all.
    floor : Floor | str | Mapping[str, Any] | None, optional
        Floor of a building on which the structure stands: T1=0.4,xi=0.05,z=6m,H=9m,n=3 (or z/H=0.67, gamma=1.29).
    model : ModelName | Sequence[ModelName] | None, optional
        One model or several: nonlinear (the mechanism itself), and its equivalent block (linear1, linear2). By default
        all, or nonlinear alone if the others mislead.
    opening : float, optional
        Largest opening of a joint up to which a history holds, over D_cr. By default 0.005.
    out : str | Path | None, optional
        Write the rows of `to_frame`, with units in the headings (.csv, .parquet or .xlsx).  - is standard output.
    separator : {",", ";", "tab"}, optional
        Separator of the CSV table. By default a comma.
    decimal : {".", ","}, optional
        Decimal sign of the CSV table. By default a point.
    watch : Watcher
        Told what is read and written, what is doubtful, and how far the work is.

    Returns
    -------
    EachAnswer
        Arrays by model, of shape (structures, motions, scales), and (..., polarities) and (..., restitutions) if those
        are given; `failed` marks motions that could not be simulated, and `unknown` those whose outcome is unknown
        from `known_to` on: their `overturned` is NaN, and `share()` gives the lowest and the highest share of the
        motions that overturn. `to_frame()` has a row for each run, `to_xarray()` labelled arrays.

    Raises
    ------
    InputError
        If a value is out of range, or a file cannot be used.
    MechanismError
        If the structure has no critical rotation or no uplift acceleration.

    Notes
    -----
    Time histories are those of `respond`, to the last bit, but end once they are unknown: `opening` is then the largest
    until there, in `respond` that of the whole history. Eqs. 8 and 16 of DeJong and Dimitrakopoulos (2014).

    Examples
    --------
    >>> import rocking_cli as rk
    >>> blocks = [rk.Block(width=0.7, height=2.8), rk.Block(width=0.5, height=2.8)]
    >>> answer = rk.respond_each(blocks, "sine:0.4g:0.8s", model="nonlinear", scale=[0.5, 1.0])
    >>> answer["nonlinear"].overturned.tolist()
    [[[0.0, 1.0]], [[0.0, 1.0]]]
    >>> answer["nonlinear"].share()
    (0.5, 0.5)
    """

def respond_around(
    structure: StructureLike,
    one: Motion,
    other: Motion,
    *,
    scale: float | str = ...,
    model: ModelName | Sequence[ModelName] | None = ...,
    release: Release | float | str | None = ...,
    rtol: float | str = ...,
    watch: Watcher = ...,
) -> Answer[AzimuthResponses]:
    """Compute the response of a structure in every direction between two components.

    Parameters
    ----------
    structure : StructureLike
        The structure, or its YAML file.
    one : Motion
        The component at 0 degrees: a motion, its file, or a pulse as text.
    other : Motion
        The component at 90 degrees, of equal length and sampling interval.
    scale : float, optional
        Scale factor on both. By default 1.0.
    model : ModelName | Sequence[ModelName] | None, optional
        One model or several: nonlinear (the mechanism itself), and its equivalent block (linear1, linear2). By default
        all, or nonlinear alone if the others mislead.
    release : Release | float | str | None, optional
        Initial tilt of a release from rest: a fraction of phi_cr, or an angle such as 0.05rad; negative is
        anticlockwise.
    rtol : float, optional
        Relative error tolerance per step of the nonlinear integration. By default 1e-09.
    watch : Watcher
        Told what is read and written, what is doubtful, and how far the work is.

    Returns
    -------
    Answer of AzimuthResponses
        `azimuths` [deg], and `outcomes` of each model at them.

    Raises
    ------
    InputError
        If a value is out of range, or the components cannot be combined.
    SolverError
        If a motion cannot be simulated.
    """

def select(
    motions: Motion | Sequence[Motion] | Motions,
    target: TargetSpectrum | SiteLike | tuple[ArrayLike, ArrayLike],
    *,
    band: tuple[float | str, float],
    count: int,
    state: str | None = ...,
    within: tuple[float | str, float] = ...,
    damping: float | str = ...,
    factors: tuple[float | str, float] = ...,
    one_per: Literal['event', 'station', 'none'] = ...,
    same_factor: bool = ...,
    seed: int = ...,
    out: str | Path | None = ...,
    plot: str | Path | None = ...,
    units: str | None = ...,
    dt: float | str | None = ...,
    channel: str | int | None = ...,
    quantity: Literal["acceleration", "velocity", "displacement"] | None = ...,
    gain: Gain | str | None = ...,
    run_on: bool | None = ...,
    despite_header: bool | None = ...,
    other: str | Path | None = ...,
    other_channel: str | int | None = ...,
    azimuth: float | str | None = ...,
    floor: Floor | str | Mapping[str, Any] | None = ...,
    watch: Watcher = ...,
) -> Answer[RecordSet]:
    """Select records whose mean response spectrum matches a target, with a scale factor for each.

    Parameters
    ----------
    motions : Motion | Sequence[Motion] | Motions
        Records to select from, their files, or patterns such as `records/*.AT2`.
    target : TargetSpectrum | SiteLike | tuple[ArrayLike, ArrayLike]
        Target spectrum, of the damping ratio given: one column of periods in s, and one of ordinates in g or in the
        unit of its heading; or a site file (.yaml), of which the code gives the spectrum of the ground.
    band : tuple[float, float]
        Period range over which the mean must match. [s]
    count : int
        Number of records to select.
    state : str | None, optional
        Limit state of the site file whose spectrum is the target. By default SLV.
    within : tuple[float, float], optional
        Lower and upper limit on the ratio of mean to target. By default 0.9:1.3.
    damping : float, optional
        Damping ratio of the spectrum. By default 0.05.
    factors : tuple[float, float], optional
        Lower and upper limit on the scale factor of each record. By default 0.2:5.
    one_per : {"event", "station", "none"}, optional
        Source from which at most one record is taken, if the files name it. By default event.
    same_factor : bool, optional
        Scale all records by the same factor.
    seed : int, optional
        Seed of the random searches, if there are too many sets to try all.
    out : str | Path | None, optional
        Write the scaled records and a list of them, set.yaml, into this folder.
    plot : str | Path | None, optional
        Plot the spectra, their mean and the target (.png, .svg or .pdf).
    units : str | None, optional
        Unit of the record, if the file does not state it.
    dt : float | str | None, optional
        Sampling interval in s, if the file has no times.
    channel : str | int | None, optional
        Channel or column to read: its number, from 1, or its name.
    quantity : Literal["acceleration", "velocity", "displacement"] | None, optional
        Quantity in the record; velocities and displacements are differentiated.
    gain : Gain | str | None, optional
        Instrument sensitivity: the value of one unit of the record, such as 0.05m/V or 4.7e-6m/s2/count.
    run_on : bool | None, optional
        Read a text without times as one series that runs on over its rows.
    despite_header : bool | None, optional
        Accept a text with other numbers of points or peaks than its header states, as it was cut on purpose.
    other : str | Path | None, optional
        Second horizontal component, perpendicular to the record; the two are rotated into the plane of the structure.
    other_channel : str | int | None, optional
        Channel of the second component in its file.
    azimuth : float | str | None, optional
        Azimuth of the structure's plane, in degrees: 0 is the record, 90 the second. `respond` also accepts all.
    floor : Floor | str | Mapping[str, Any] | None, optional
        Floor of a building on which the structure stands: T1=0.4,xi=0.05,z=6m,H=9m,n=3 (or z/H=0.67, gamma=1.29).
    watch : Watcher
        Told what is read and written, what is doubtful, and how far the work is.

    Returns
    -------
    Answer of RecordSet
        `fits` is whether the set stays within the limits, `motions` are the scaled records, and `factors` their scale
        factors; `mean`, and `periods`, `target` and `spectra` of `candidates`, are spectra.

    Raises
    ------
    InputError
        If a value is out of range, a file cannot be used, or there are too few records.

    Notes
    -----
    The limits are those of NTC 2018, 3.2.3.6; EN 1998-1:2004, 3.2.3.1.2(4), requires the lower one only, from 0.2 to 2
    times the fundamental period of a structure.
    """

def selfcheck(
    *,
    quick: bool = ...,
    watch: Watcher = ...,
) -> Answer[study.SelfCheck]:
    """Check that this installation computes correctly, against formulas, literal values and a general solver.

    Parameters
    ----------
    quick : bool, optional
        Compute a few cases of each check only.
    watch : Watcher
        Told what is read and written, what is doubtful, and how far the work is.

    Returns
    -------
    Answer of SelfCheck
        `passed` is whether no check failed; `checks` are the results, `failed` and `not_run` some of them. A check
        that ends by an error fails; this is not raised. `seconds` is the time it took.

    Examples
    --------
    >>> import rocking_cli as rk
    >>> rk.selfcheck(quick=True).passed
    True
    """

def spectrum(
    structures: StructureLike | Sequence[StructureLike] = ...,
    motions: Motion | Sequence[Motion] | Motions = ...,
    *,
    slenderness: Sequence[float | str] = ...,
    sizes: tuple[float | str, float] | None = ...,
    count: int = ...,
    model: Literal['nonlinear', 'linear1', 'linear2'] = ...,
    fractiles: Sequence[float | str] = ...,
    jobs: int | None = ...,
    plot: str | Path | None = ...,
    units: str | None = ...,
    dt: float | str | None = ...,
    channel: str | int | None = ...,
    quantity: Literal["acceleration", "velocity", "displacement"] | None = ...,
    gain: Gain | str | None = ...,
    run_on: bool | None = ...,
    despite_header: bool | None = ...,
    other: str | Path | None = ...,
    other_channel: str | int | None = ...,
    azimuth: float | str | None = ...,
    floor: Floor | str | Mapping[str, Any] | None = ...,
    scale: float | str | None = ...,
    target_pga: float | str | None = ...,
    target_pgv: float | str | None = ...,
    polarity: Literal['1', '-1', 'both', 1, -1] = ...,
    restitution: float | str | None = ...,
    opening: float | str = ...,
    out: str | Path | None = ...,
    separator: Literal[',', ';', 'tab'] | None = ...,
    decimal: Literal['.', ','] | None = ...,
    watch: Watcher = ...,
) -> Answer[list[Spectrum]]:
    """Compute peak rotation and overturning against size, for structures and for blocks of given slenderness.

    Parameters
    ----------
    structures : StructureLike | Sequence[StructureLike], optional
        One structure or several, or their YAML files.
    motions : Motion | Sequence[Motion] | Motions, optional
        One motion or several, their files, or pulses as text; at least one.
    slenderness : Sequence[float], optional
        Slendernesses of rectangular blocks to compute as well: alpha = atan(b/h) in rad, such as 0.1,0.2, or 10deg.
        [rad]
    sizes : tuple[float, float] | None, optional
        Smallest and largest size, as 2 pi/p. [s] By default the structures scaled by 0.1 to 10; 1:10 for blocks alone.
    count : int, optional
        Number of sizes, at equal ratios. By default 60.
    model : {"nonlinear", "linear1", "linear2"}, optional
        Model: nonlinear (the mechanism itself), or its equivalent block (linear1, linear2). By default nonlinear.
    fractiles : Sequence[float], optional
        Fractiles to show in addition to the median, with several motions. By default (0.16, 0.84).
    jobs : int | None, optional
        Number of processor cores to use. By default all.
    plot : str | Path | None, optional
        Plot the curves (.png, .svg or .pdf).
    units : str | None, optional
        Unit of the record, if the file does not state it.
    dt : float | str | None, optional
        Sampling interval in s, if the file has no times.
    channel : str | int | None, optional
        Channel or column to read: its number, from 1, or its name.
    quantity : Literal["acceleration", "velocity", "displacement"] | None, optional
        Quantity in the record; velocities and displacements are differentiated.
    gain : Gain | str | None, optional
        Instrument sensitivity: the value of one unit of the record, such as 0.05m/V or 4.7e-6m/s2/count.
    run_on : bool | None, optional
        Read a text without times as one series that runs on over its rows.
    despite_header : bool | None, optional
        Accept a text with other numbers of points or peaks than its header states, as it was cut on purpose.
    other : str | Path | None, optional
        Second horizontal component, perpendicular to the record; the two are rotated into the plane of the structure.
    other_channel : str | int | None, optional
        Channel of the second component in its file.
    azimuth : float | str | None, optional
        Azimuth of the structure's plane, in degrees: 0 is the record, 90 the second. `respond` also accepts all.
    floor : Floor | str | Mapping[str, Any] | None, optional
        Floor of a building on which the structure stands: T1=0.4,xi=0.05,z=6m,H=9m,n=3 (or z/H=0.67, gamma=1.29).
    scale : float | str | None, optional
        Scale factor on the motion.
    target_pga : float | str | None, optional
        Peak ground acceleration to scale the motion to, in g.
    target_pgv : float | str | None, optional
        Peak ground velocity to scale the motion to, in m/s.
    polarity : {"1", "-1", "both"}, optional
        Polarity of the motion: 1 as given, -1 reversed. By default 1.
    restitution : float | None, optional
        Coefficient of restitution of all impacts; of a structure that rocks to one side, the rebound. By default that
        of the structure.
    opening : float, optional
        Largest opening of a joint up to which a history holds, over D_cr. By default 0.005.
    out : str | Path | None, optional
        Write the curves, including those of each motion (.csv or .xlsx).  - is standard output.
    separator : {",", ";", "tab"}, optional
        Separator of the CSV table. By default a comma.
    decimal : {".", ","}, optional
        Decimal sign of the CSV table. By default a point.
    watch : Watcher
        Told what is read and written, what is doubtful, and how far the work is.

    Returns
    -------
    Answer of list of Spectrum
        One for each structure and slenderness; the peak of a motion that could not be simulated is NaN, that of an
        unknown outcome infinite, with its `lower_bound`. `to_frame()` has a row for each shape, motion and size, and
        with several motions `frames["fractiles"]` one for each shape, fractile and size.

    Raises
    ------
    InputError
        If a value is out of range, or a file cannot be used.
    MechanismError
        If the structure has no critical rotation or no uplift acceleration.

    Notes
    -----
    Rocking spectra of Makris and Konstantinidis (2003), with the models of DeJong and Dimitrakopoulos (2014).

    Examples
    --------
    >>> import rocking_cli as rk
    >>> answer = rk.spectrum(motions="sine:0.5g:0.8s", slenderness=[0.2], sizes=(1, 10), count=5)
    >>> answer.result[0].overturned.tolist()
    [1, 1, 1, 0, 0]
    """

def survey(
    structures: str | Path | Mapping[str, Sequence[Any]] | StructureTable | Sequence[StructureLike],
    motions: Motion | Sequence[Motion] | Motions = ...,
    *,
    site: SiteLike | None = ...,
    remedies: Literal['first', 'all'] = ...,
    in_space: bool = ...,
    transverse: Motion | Sequence[Motion] | None = ...,
    top: int = ...,
    jobs: int | None = ...,
    in_processes: bool = ...,
    page: str | Path | None = ...,
    labels: str | Path | None = ...,
    map: str | Path | None = ...,
    sheets: str | Path | None = ...,
    sheet_format: Literal['html', 'docx', 'pdf'] = ...,
    plot: str | Path | None = ...,
    units: str | None = ...,
    dt: float | str | None = ...,
    channel: str | int | None = ...,
    quantity: Literal["acceleration", "velocity", "displacement"] | None = ...,
    gain: Gain | str | None = ...,
    run_on: bool | None = ...,
    despite_header: bool | None = ...,
    other: str | Path | None = ...,
    other_channel: str | int | None = ...,
    azimuth: float | str | None = ...,
    floor: Floor | str | Mapping[str, Any] | None = ...,
    scale: float | str | None = ...,
    target_pga: float | str | None = ...,
    target_pgv: float | str | None = ...,
    polarity: Literal['1', '-1', 'both', 1, -1] = ...,
    opening: float | str = ...,
    neighbours: int | None = ...,
    amplitude_deviation: float | str = ...,
    slenderness_deviation: float | str | None = ...,
    restitution_deviation: float | str | None = ...,
    language: Literal['en', 'it'] | None = ...,
    project: str | None = ...,
    place: str | None = ...,
    client: str | None = ...,
    author: str | None = ...,
    logo: str | Path | None = ...,
    origin: str | None = ...,
    out: str | Path | None = ...,
    separator: Literal[',', ';', 'tab'] | None = ...,
    decimal: Literal['.', ','] | None = ...,
    watch: Watcher = ...,
) -> Answer[Survey]:
    """Rank many structures by vulnerability.

    Parameters
    ----------
    structures : str | Path | Mapping[str, Sequence[Any]] | StructureTable | Sequence[StructureLike]
        A table of structures, or a list of objects, as CSV, .xlsx, .xls or .ods, or its columns by their headings (a
        frame of pandas is one); or structures, or their YAML files.
    motions : Motion | Sequence[Motion] | Motions, optional
        One motion or several, their files, or pulses as text; without any, no histories are followed.
    site : SiteLike | None, optional
        Site file, or its fields in Python: each structure is verified by its code and ranked by the ratio of capacity
        to demand. A column site replaces it for a row. `rocking new site` prints a template.
    remedies : {"first", "all"}, optional
        Remedies of objects of a list that may fall: the first that suffices, or all. By default first.
    in_space : bool, optional
        Simulate objects of a list in three dimensions too (experimental), with motions along the weaker side.
    transverse : Motion | Sequence[Motion] | None, optional
        Component of each motion across it, in three dimensions: a file or a pulse for each, in their order. Repeatable.
    top : int, optional
        Number of structures to show. By default 20.
    jobs : int | None, optional
        Number of processor cores to use. By default one for each processor.
    in_processes : bool, optional
        Share the work of thousands of structures among processes; a script then needs `if __name__ == "__main__"`.
    page : str | Path | None, optional
        Write a page with a plot, a map and all rows in a sortable table (.html), or of a list of objects a document by
        rooms, with pictures and remedies (.pdf and .docx need an extra package; a browser does for .pdf).
    labels : str | Path | None, optional
        Write a card for each object of a list, to be cut out (.pdf).
    map : str | Path | None, optional
        Draw a map of the structures, by the columns longitude and latitude (.png, .svg or .pdf).
    sheets : str | Path | None, optional
        Write the calculation sheet of each structure into this folder; it needs a site.
    sheet_format : {"html", "docx", "pdf"}, optional
        Format of the sheets (docx and pdf need an extra package; a browser does for pdf). By default html.
    plot : str | Path | None, optional
        Plot the uplift acceleration against the frequency parameter, or draw the first objects of a list to scale
        (.png, .svg or .pdf).
    units : str | None, optional
        Unit of the record, if the file does not state it.
    dt : float | str | None, optional
        Sampling interval in s, if the file has no times.
    channel : str | int | None, optional
        Channel or column to read: its number, from 1, or its name.
    quantity : Literal["acceleration", "velocity", "displacement"] | None, optional
        Quantity in the record; velocities and displacements are differentiated.
    gain : Gain | str | None, optional
        Instrument sensitivity: the value of one unit of the record, such as 0.05m/V or 4.7e-6m/s2/count.
    run_on : bool | None, optional
        Read a text without times as one series that runs on over its rows.
    despite_header : bool | None, optional
        Accept a text with other numbers of points or peaks than its header states, as it was cut on purpose.
    other : str | Path | None, optional
        Second horizontal component, perpendicular to the record; the two are rotated into the plane of the structure.
    other_channel : str | int | None, optional
        Channel of the second component in its file.
    azimuth : float | str | None, optional
        Azimuth of the structure's plane, in degrees: 0 is the record, 90 the second. `respond` also accepts all.
    floor : Floor | str | Mapping[str, Any] | None, optional
        Floor of a building on which the structure stands: T1=0.4,xi=0.05,z=6m,H=9m,n=3 (or z/H=0.67, gamma=1.29).
    scale : float | str | None, optional
        Scale factor on the motion.
    target_pga : float | str | None, optional
        Peak ground acceleration to scale the motion to, in g.
    target_pgv : float | str | None, optional
        Peak ground velocity to scale the motion to, in m/s.
    polarity : {"1", "-1", "both"}, optional
        Polarity of the motion: 1 as given, -1 reversed. By default 1.
    opening : float, optional
        Largest opening of a joint up to which a history holds, over D_cr. By default 0.005.
    neighbours : int | None, optional
        Number of neighbouring motions to simulate as well, 0 for none. By default 200, or as many as take about a
        minute.
    amplitude_deviation : float, optional
        Standard deviation of ln amplitude of the neighbours. By default 0.04.
    slenderness_deviation : float | None, optional
        Standard deviation of ln slenderness. By default that of the file, or 10 %.
    restitution_deviation : float | None, optional
        Standard deviation of restitution. By default that of the file, 0.03 of a given value, or 0.05.
    language : {"en", "it"}, optional
        Language of the answer and of documents. By default that of the site, or en.
    project : str | None, optional
        Project name, for the heading of the document.
    place : str | None, optional
        Location of the structure, for the heading.
    client : str | None, optional
        Client who ordered the document, for the heading.
    author : str | None, optional
        Author of the document, for the heading.
    logo : str | Path | None, optional
        Author's logo (.png, .jpg or .svg), for the heading.
    origin : str | None, optional
        What the document says of how it was made. By default the command, or the call of Python.
    out : str | Path | None, optional
        Write all rows in ranked order (.csv, .parquet or .xlsx).  - is standard output.
    separator : {",", ";", "tab"}, optional
        Separator of the CSV table. By default a comma.
    decimal : {".", ","}, optional
        Decimal sign of the CSV table. By default a point.
    watch : Watcher
        Told what is read and written, what is doubtful, and how far the work is.

    Returns
    -------
    Answer of Survey
        `rows` are the ranked structures, `bad` the unusable ones with their reasons.

    Raises
    ------
    InputError
        If the table or a motion cannot be used, or a file cannot be written.

    Notes
    -----
    The blocks are those of DeJong and Dimitrakopoulos (2014), Section 3; see `equiv`.

    Examples
    --------
    >>> import rocking_cli as rk
    >>> table = {"mechanism": ["block", "block"], "name": ["a", "b"], "width [mm]": [500, 300], "height": [2, 2]}
    >>> [row.name for row in rk.survey(table).rows]
    ['b', 'a']
    """

def verify(
    structure: StructureLike,
    site: SiteLike,
    motions: Motion | Sequence[Motion] | Motions = ...,
    *,
    strengthened: StructureLike | None = ...,
    control: tuple[float, float] | tuple[float, float, str | None] | None = ...,
    in_full: bool = ...,
    sheet: str | Path | None = ...,
    plot: str | Path | None = ...,
    sets: Mapping[str, Any] | None = ...,
    units: str | None = ...,
    dt: float | str | None = ...,
    channel: str | int | None = ...,
    quantity: Literal["acceleration", "velocity", "displacement"] | None = ...,
    gain: Gain | str | None = ...,
    run_on: bool | None = ...,
    despite_header: bool | None = ...,
    other: str | Path | None = ...,
    other_channel: str | int | None = ...,
    azimuth: float | str | None = ...,
    floor: Floor | str | Mapping[str, Any] | None = ...,
    scale: float | str | None = ...,
    target_pga: float | str | None = ...,
    target_pgv: float | str | None = ...,
    polarity: Literal['1', '-1', 'both', 1, -1] = ...,
    state: str | None = ...,
    on_floor: bool = ...,
    opening: float | str = ...,
    language: Literal['en', 'it'] | None = ...,
    project: str | None = ...,
    place: str | None = ...,
    client: str | None = ...,
    author: str | None = ...,
    logo: str | Path | None = ...,
    origin: str | None = ...,
    watch: Watcher = ...,
) -> Answer[Verification]:
    """Verify a rocking mechanism of masonry by a code, such as the Italian: NTC 2018 and Circolare 7/2019.

    Parameters
    ----------
    structure : StructureLike
        The structure, or its YAML file.
    site : SiteLike
        Site file, or its fields in Python: ground motion, confidence factor, floor. `rocking new site` prints a
        template.
    motions : Motion | Sequence[Motion] | Motions, optional
        One motion or several, their files, or pulses as text; without any, no histories are followed.
    strengthened : StructureLike | None, optional
        The strengthened structure, to be verified too and compared with FILE.
    control : tuple[float, float] | tuple[float, float, str | None] | None, optional
        Control point, in m, and the body it is on. By default centroid of the moving weights.
    in_full : bool, optional
        Show also the ground, both curves, every clause and the remarks in full. By default True.
    sheet : str | Path | None, optional
        Write the calculation sheet (.html; .docx and .pdf need an extra package; a browser does for .pdf).
    plot : str | Path | None, optional
        Plot the capacity curves (.png, .svg or .pdf).
    sets : Mapping[str, Any] | None, optional
        Motions of a limit state of its own: a folder or list that `rocking select` wrote, a file, or a pattern.
        Repeatable. In Python a mapping with the motions of each state.
    units : str | None, optional
        Unit of the record, if the file does not state it.
    dt : float | str | None, optional
        Sampling interval in s, if the file has no times.
    channel : str | int | None, optional
        Channel or column to read: its number, from 1, or its name.
    quantity : Literal["acceleration", "velocity", "displacement"] | None, optional
        Quantity in the record; velocities and displacements are differentiated.
    gain : Gain | str | None, optional
        Instrument sensitivity: the value of one unit of the record, such as 0.05m/V or 4.7e-6m/s2/count.
    run_on : bool | None, optional
        Read a text without times as one series that runs on over its rows.
    despite_header : bool | None, optional
        Accept a text with other numbers of points or peaks than its header states, as it was cut on purpose.
    other : str | Path | None, optional
        Second horizontal component, perpendicular to the record; the two are rotated into the plane of the structure.
    other_channel : str | int | None, optional
        Channel of the second component in its file.
    azimuth : float | str | None, optional
        Azimuth of the structure's plane, in degrees: 0 is the record, 90 the second. `respond` also accepts all.
    floor : Floor | str | Mapping[str, Any] | None, optional
        Floor of a building on which the structure stands: T1=0.4,xi=0.05,z=6m,H=9m,n=3 (or z/H=0.67, gamma=1.29).
    scale : float | str | None, optional
        Scale factor on the motion.
    target_pga : float | str | None, optional
        Peak ground acceleration to scale the motion to, in g.
    target_pgv : float | str | None, optional
        Peak ground velocity to scale the motion to, in m/s.
    polarity : {"1", "-1", "both"}, optional
        Polarity of the motion: 1 as given, -1 reversed. By default 1.
    state : str | None, optional
        Limit state to which the records belong, such as SLC, if the site gives it. By default that of the verdict.
    on_floor : bool, optional
        The motions are those of the floor of the site, and not of the ground.
    opening : float, optional
        Largest opening of a joint up to which a history holds, over D_cr. By default 0.005.
    language : {"en", "it"}, optional
        Language of the answer and of documents. By default that of the site, or en.
    project : str | None, optional
        Project name, for the heading of the document.
    place : str | None, optional
        Location of the structure, for the heading.
    client : str | None, optional
        Client who ordered the document, for the heading.
    author : str | None, optional
        Author of the document, for the heading.
    logo : str | Path | None, optional
        Author's logo (.png, .jpg or .svg), for the heading.
    origin : str | None, optional
        What the document says of how it was made. By default the command, or the call of Python.
    watch : Watcher
        Told what is read and written, what is doubtful, and how far the work is.

    Returns
    -------
    Answer of Verification
        `directions` holds the results of each direction, with `methods`, `states` and `workings`.

    Raises
    ------
    InputError
        If the site, the control point or a file cannot be used, or the structure has no capacity curve.
    MechanismError
        If the structure is not stable at rest.
    SolverError
        If a motion cannot be simulated to its end.

    Examples
    --------
    >>> import rocking_cli as rk
    >>> site = {"FC": 1.35, "ag": 0.2, "F0": 2.5, "TC": 0.4, "S": 1.2}
    >>> answer = rk.verify(rk.Block(width=0.6, height=8.0), site)
    >>> round(answer.directions[rk.Direction.POSITIVE].counts.a_g, 6)
    0.193382
    """

__version__: str
mechanisms: Registry
