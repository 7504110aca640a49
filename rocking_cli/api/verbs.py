"""Functions of the Python interface: structures and motions, as objects or files, to answers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rocking_cli.api.answer import Answer, MappingAnswer
from rocking_cli.core import CollapseMechanism, Direction, Equivalence, Mechanism
from rocking_cli.dynamics.batch import Runs, respond_many
from rocking_cli.dynamics.history import RTOL, TAIL, History
from rocking_cli.dynamics.model import MODELS, ModelName
from rocking_cli.dynamics.outcome import OUTCOME, Outcomes
from rocking_cli.engines import default_models
from rocking_cli.engines import respond as histories
from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.base import STANDARD_GRAVITY, GroundMotion
from rocking_cli.excitation.measures import Measures
from rocking_cli.excitation.pulses import Pulse, PulseShapes, parse_pulse
from rocking_cli.excitation.records import read_record
from rocking_cli.excitation.scaled import Scaled
from rocking_cli.io.json_text import json_text
from rocking_cli.structure import Structure
from rocking_cli.structure_file import load_structure
from rocking_cli.studies.release import Release
from rocking_cli.views.view import View, heading

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rocking_cli.io.tables import Columns
    from rocking_cli.processing.oscillator import ResponseSpectrum
    from rocking_cli.studies.contact import ContactDemand
    from rocking_cli.studies.equivalent_pulses import EquivalentResponses
    from rocking_cli.studies.fragility.assess import Fragility
    from rocking_cli.studies.linearisation import Linearisation
    from rocking_cli.studies.margin import Margin
    from rocking_cli.studies.overturning import Comparison, OverturningMap
    from rocking_cli.studies.picture import Picture
    from rocking_cli.studies.spectrum import Spectrum

StructureLike = Mechanism | str | Path
"""Mechanism, or its YAML file."""
Motion = GroundMotion | Pulse | str | Path
"""Ground motion or pulse, file of a record, or pulse as text such as `sine:0.6g:0.8s`."""


def _known(outcome: Outcomes) -> NDArray[np.float64]:
    """Whether motions overturn a structure, 1 or 0; NaN where the outcome is unknown."""
    return np.where(outcome.unknown, np.nan, outcome.overturned)


def _with_gaps(values: NDArray[np.bool_], missing: NDArray[np.bool_]) -> Any:
    """Return values as nested lists, with None where they are missing."""
    found = values.astype(object)
    found[missing] = None
    return found.tolist()


def _structure(given: StructureLike) -> Structure:
    if isinstance(given, Mechanism):
        return Structure(given if given.name else given.model_copy(update={"name": given.mechanism}))
    if not isinstance(given, str | Path):
        hint = "make one, such as rk.Block(width=0.7, height=2.8)"
        raise InputError(
            Problem(f"must be a mechanism or a YAML file, got {_kind(given)}", field="structure", hint=hint)
        )
    return Structure(load_structure(given), str(given))


def _motion(given: Motion) -> GroundMotion:
    given = _read(given)
    return given.sampled() if isinstance(given, Pulse) else given


def _read(given: Motion) -> GroundMotion | Pulse:
    """Read a motion from its file, or a pulse from its text; a file of the same name has priority."""
    if isinstance(given, GroundMotion | Pulse):
        return given
    if isinstance(given, str) and given.partition(":")[0] in PulseShapes() and not Path(given).exists():
        return parse_pulse(given)
    if not isinstance(given, str | Path):
        hint = "make one with rk.GroundMotion(name, dt, acceleration), the acceleration in m/s2"
        what = f"must be a ground motion, a pulse or a file, got {_kind(given)}"
        raise InputError(Problem(what, field="motion", hint=hint))
    return read_record(given)


def _kind(given: object) -> str:
    """Return the type of a value, for messages: `a dict`."""
    name = type(given).__name__
    return f"{'an' if name[0].lower() in 'aeiou' else 'a'} {name}"


def _check_count(name: str, count: int, least: int = 1) -> None:
    """Refuse a number of values of which there are too few. Raises `InputError`."""
    if not isinstance(count, int) or count < least:
        raise InputError(Problem(f"must be a whole number of at least {least}, got {count!r}", field=name))


def _each(given: Any) -> list[Any]:
    return list(given) if isinstance(given, list | tuple) else [given]


def _models(given: str | Sequence[str] | None) -> tuple[ModelName, ...]:
    chosen = MODELS if given is None else (given,) if isinstance(given, str) else tuple(given)
    if unknown := [name for name in chosen if name not in MODELS]:
        raise InputError(f"models must be of {', '.join(MODELS)}, got {', '.join(unknown)}")
    return chosen  # type: ignore[return-value]


def equiv(structure: StructureLike) -> Answer[Equivalence | None]:
    """Compute the equivalent single rocking block of a structure, in both directions.

    Parameters
    ----------
    structure : Mechanism, str or Path
        The structure, or its YAML file.

    Returns
    -------
    Answer of Equivalence or None
        `positive` and `negative` are the blocks; see `equivalent_block`. None if no single block is equivalent; its
        sentences and `to_dict` give the reason.

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
    from rocking_cli.views import equivalent_block as views

    ready = _structure(structure)
    found = ready.equivalence if ready.why_no_block is None else None
    columns, figure = partial(views.table, [ready]), partial(_structure_figure, ready.mechanism)
    return Answer("equivalent block", found, views.view(ready), columns, figure)


def draw(structure: StructureLike, *, at: float | None = None) -> Answer[Picture]:
    """Draw a structure at rest with its dimensions, and displaced in both directions.

    Parameters
    ----------
    structure : Mechanism, str or Path
        The structure, or its YAML file.
    at : float, optional
        Rotation to draw, as a multiple of phi_cr, or of the kinematic limit if there is no phi_cr; at most the
        kinematic limit. By default 1, or a rotation that is easy to see.

    Returns
    -------
    Answer of Picture
        Parts of the structure, its dimensions, and the positions of the parts at any rotation.

    Raises
    ------
    InputError
        If a value is out of range, or a file cannot be used.
    MechanismError
        If the structure has no critical rotation or no uplift acceleration.

    Notes
    -----
    Rotations and phi_cr as in DeJong and Dimitrakopoulos (2014), Section 3.
    """
    from rocking_cli.studies.picture import picture
    from rocking_cli.views.draw import view

    mechanism = _structure(structure).mechanism
    found = picture(mechanism)

    def figure() -> Figure:
        from rocking_cli.plotting.structure import draw_structure

        return draw_structure(found, heading(mechanism), None if at is None else min(at, found.furthest))

    def columns() -> Columns:
        said = [each.text for each in found.sketch.lengths]
        return {"length": said}

    return Answer("drawing", found, view(found), columns, figure)


def collapse(structure: StructureLike) -> MappingAnswer[Direction, CollapseMechanism]:
    """Find the weakest mechanism of an assembly of rigid blocks in each direction, by limit analysis.

    Parameters
    ----------
    structure : Mechanism, str or Path
        Assembly, or its YAML file.

    Returns
    -------
    MappingAnswer of Direction to CollapseMechanism
        lambda, hinges, groups of blocks that move as one, a line of thrust, friction required, and rotation up to which
        the mechanism is valid.

    Raises
    ------
    InputError
        If the structure is not an assembly, or its file cannot be used.
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
    from rocking_cli.studies.collapse import collapses
    from rocking_cli.views.collapse import table, view

    mechanism = _structure(structure).mechanism
    found = collapses(mechanism)

    columns, figure = partial(table, found), partial(_structure_figure, mechanism, found)
    return MappingAnswer("weakest mechanism", found, view(mechanism, found), columns, figure)


def record(motion: Motion, *, scale: float = 1.0) -> Answer[Measures]:
    """Measure the strength of a ground motion, and check it for defects.

    Parameters
    ----------
    motion : GroundMotion, Pulse, str or Path
        The motion, its file, or a pulse as text.
    scale : float
        Scale factor on the motion.

    Returns
    -------
    Answer of Measures
        Peaks, Arias intensity, durations and mean period.

    Raises
    ------
    InputError
        If a value is out of range, or a file cannot be used.

    Notes
    -----
    The measures are exact for straight lines between the samples; the intensity is that of Arias (1970), pi/(2 g) times
    the integral of the squared acceleration.
    """
    from rocking_cli.excitation.doubts import doubts
    from rocking_cli.excitation.measures import measure
    from rocking_cli.views.record import Examined, data, parts

    read = _motion(motion)
    scaled = read.scaled(scale)
    found = measure(scaled)
    seen = Examined(read.name, read.name, read, scale, found, doubts(read, measure(read)), None, [])

    def columns() -> Columns:
        time = np.arange(scaled.npts) * scaled.dt
        return {"t [s]": time, "a_g [g]": scaled.acceleration / STANDARD_GRAVITY}

    def figure() -> Figure:
        from rocking_cli.plotting.record import draw_record

        return draw_record(scaled, found)

    said = f"{read.name}: PGA {found.pga:.3g} g, PGV {found.pgv:.3g} m/s."
    return Answer("record", found, View(lambda: data(seen), [*parts([seen], 100), said]), columns, figure)


def response_spectrum(
    motion: Motion, periods: ArrayLike | None = None, *, damping: float = 0.05, scale: float = 1.0
) -> Answer[ResponseSpectrum]:
    """Compute the response spectrum of a ground motion: the peak responses of linear oscillators.

    Parameters
    ----------
    motion : GroundMotion, Pulse, str or Path
        The motion, its file, or a pulse as text.
    periods : array_like, shape (n,), optional
        Undamped periods of the oscillators [s]; by default 200 from 0.02 to 10 s at equal ratios.
    damping : float
        Damping ratio of the oscillators, from 0 to below 1.
    scale : float
        Scale factor on the motion.

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
    from rocking_cli.processing.oscillator import response_spectrum as respond_linearly
    from rocking_cli.views import response_spectrum as views

    scaled = _motion(motion).scaled(scale)
    found = respond_linearly(scaled, periods, damping)

    def figure() -> Figure:
        from rocking_cli.plotting.response_spectrum import draw_response_spectra

        return draw_response_spectra({scaled.name: found})

    said = views.view(scaled.name, found)
    return Answer("response spectrum", found, said, lambda: views.table({scaled.name: found}), figure)


def respond(
    structure: StructureLike,
    motion: Motion | None = None,
    *,
    models: str | Sequence[str] | None = None,
    scale: float = 1.0,
    release: float | str | None = None,
    tail: float = TAIL,
    rtol: float = RTOL,
) -> MappingAnswer[ModelName, History]:
    """Compute the response of a structure to a ground motion, a release or both; `respond_each` is for many.

    Parameters
    ----------
    structure : Mechanism, str or Path
        The structure, or its YAML file.
    motion : GroundMotion, Pulse, str or Path, optional
        The motion, its file, or a pulse as text.
    models : str or sequence of str, optional
        Models "nonlinear", "linear1" or "linear2"; all by default.
    scale : float
        Scale factor on the motion; a negative one reverses it.
    release : float or str, optional
        Initial tilt of a release from rest: a fraction of phi_cr, between -1 and 1, or an angle such as "0.05rad";
        negative is anticlockwise.
    tail : float
        Length of output after the end of the record [s].
    rtol : float
        Relative error tolerance per step of the nonlinear integration.

    Returns
    -------
    MappingAnswer of str to History
        Time histories, by model.

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
    >>> answer = rk.respond(rk.Block(width=0.7, height=2.8), "sine:0.3g:0.8s", models="nonlinear")
    >>> answer["nonlinear"].words
    'rocks'
    """
    from rocking_cli.studies.contact import Contacts
    from rocking_cli.views.response import runs_view

    ready = _structure(structure)
    shaking = _motion(motion).scaled(scale) if motion is not None else None
    chosen = _models(models) if models is not None else default_models(ready)
    tilt = Release.of(release).ratio(ready) if release is not None else None
    found = histories(ready, shaking, models=chosen, release=tilt, tail=tail, rtol=rtol)
    title = heading(ready.mechanism) + (f", {shaking.name}" if shaking is not None else "")
    nonlinear = found.get("nonlinear")
    contacts = {1: Contacts(ready.mechanism).check(nonlinear, shaking)} if nonlinear is not None else {}

    columns = partial(_history_columns, found, shaking, ready.mechanism)
    figure = partial(_history_figure, found, shaking, ready, title, contacts)
    return MappingAnswer("response", found, runs_view(title, {1: found}, ready.mechanism, contacts), columns, figure)


def _structure_figure(mechanism: Mechanism, found: Mapping[Direction, CollapseMechanism] | None = None) -> Figure:
    from rocking_cli.plotting.structure import draw_structure
    from rocking_cli.studies.picture import picture

    return draw_structure(picture(mechanism, found), heading(mechanism))


def _history_columns(found: Mapping[ModelName, History], shaking: GroundMotion | None, mechanism: Mechanism) -> Columns:
    from rocking_cli.studies.movements import Watched
    from rocking_cli.views import history_table

    runs = {str(name): run for name, run in found.items()}
    blocks = list(history_table.blocks(runs, shaking, watched=Watched(mechanism)))
    return {name: np.concatenate([block[name] for block in blocks]) for name in blocks[0]}


def _history_figure(
    found: Mapping[ModelName, History],
    shaking: GroundMotion | None,
    ready: Structure,
    title: str,
    contacts: Mapping[int, ContactDemand],
) -> Figure:
    from rocking_cli.plotting.history import draw_history
    from rocking_cli.studies.movements import Watched

    checked = list(contacts.values()) if ready.mechanism.friction is not None else []
    watched = Watched(ready.mechanism)
    return draw_history(found, shaking, title, uplift=ready.uplift, contacts=checked, watched=watched)


def respond_each(
    structures: StructureLike | Sequence[StructureLike],
    motions: Motion | Sequence[Motion],
    *,
    models: str | Sequence[str] | None = None,
    scales: ArrayLike = 1.0,
    threads: int | None = None,
) -> MappingAnswer[ModelName, Outcomes]:
    """Compute the outcome of every structure under every motion with every scale factor.

    Parameters
    ----------
    structures, motions
        One or several, as for `respond`.
    models : str or sequence of str, optional
        Models "nonlinear", "linear1" or "linear2"; all by default.
    scales : array_like
        Scale factors on the motions; negative ones reverse them.
    threads : int, optional
        Number of time histories at a time; by default, one for each processor.

    Returns
    -------
    MappingAnswer of str to Outcome
        Arrays of shape (structures, motions, scales), by model; `failed` marks motions that could not be simulated, and
        `unknown` those whose outcome is unknown from `known_to` on.

    Raises
    ------
    InputError
        If a value is out of range, or a file cannot be used.
    MechanismError
        If the structure has no critical rotation or no uplift acceleration.

    Notes
    -----
    Every time history is identical, bit for bit, to that of `respond`: Eqs. 8 and 16 of DeJong and Dimitrakopoulos
    (2014).

    Examples
    --------
    >>> import rocking_cli as rk
    >>> blocks = [rk.Block(width=0.7, height=2.8), rk.Block(width=0.5, height=2.8)]
    >>> answer = rk.respond_each(blocks, "sine:0.4g:0.8s", models="nonlinear", scales=[0.5, 1.0, 2.0])
    >>> answer["nonlinear"].overturned.shape
    (2, 1, 3)
    """
    ready = [_structure(each) for each in _each(structures)]
    shaking = [_motion(each) for each in _each(motions)]
    factors = np.atleast_1d(np.asarray(scales, dtype=np.float64))
    if factors.ndim > 1:
        raise InputError(
            Problem(f"must be one factor or a list of them, got an array of shape {factors.shape}", field="scales")
        )
    shape = len(ready), len(shaking), factors.size
    chosen = _models(models)
    if models is None and any(len(each.default_models) < len(MODELS) for each in ready):
        chosen = ("nonlinear",)
    found: dict[ModelName, Outcomes] = {}
    for name in chosen:
        runs = Runs.every(len(ready), len(shaking), scales=factors.tolist())
        many = respond_many([each.model(name) for each in ready], shaking, runs, threads=threads)
        found[name] = many.by_field(lambda values: values.reshape(shape))

    def columns() -> Columns:
        places = [axis.ravel() for axis in np.indices(shape)]
        table: dict[str, Any] = {
            "structure": [ready[k].name for k in places[0]],
            "motion": [shaking[k].name for k in places[1]],
            "scale": factors[places[2]],
        }
        for name, outcome in found.items():
            for column in ("overturned", "peak_ratio", "uplift_time", "overturning_time", "impact_count"):
                table[f"{name} {column}"] = getattr(outcome, column).ravel()
            if outcome.unknown.any():
                table[f"{name} overturned"] = _known(outcome).ravel()
                table |= {f"{name} {column}": getattr(outcome, column).ravel() for column in ("unknown", "known_to")}
        return table

    def figure() -> Figure:
        raise InputError("many responses have no plot of their own: plot a spectrum, a map or a margin")

    first = found[chosen[0]]
    said = f"By the {chosen[0]} model {int(first.overturned.sum())} of {first.overturned.size} motions overturn"
    said += f", and the outcome of {int(first.unknown.sum())} is unknown." if first.unknown.any() else "."
    data: dict[str, Any] = {name: {column: getattr(each, column) for column in OUTCOME} for name, each in found.items()}
    for name, each in found.items():
        if each.unknown.any():
            data[name]["overturned"] = _with_gaps(each.overturned, each.unknown)
        if name == "nonlinear" and np.isnan(each.opening).any():
            data[name]["unknown"] = _with_gaps(each.unknown, np.isnan(each.opening) & ~each.unknown)
    return MappingAnswer("responses", found, View(data, [said]), columns, figure)


def spectrum(
    structures: StructureLike | Sequence[StructureLike] = (),
    motions: Motion | Sequence[Motion] = (),
    *,
    slenderness: Sequence[float] = (),
    sizes: tuple[float, float] | None = None,
    count: int = 60,
    model: ModelName = "nonlinear",
    eta: float | None = None,
    polarities: Sequence[int] = (1,),
    fractiles: Sequence[float] = (0.16, 0.84),
) -> Answer[list[Spectrum]]:
    """Compute peak rotation and overturning against size, for structures and for blocks of given slenderness.

    Parameters
    ----------
    structures, motions
        One or several, as for `respond`.
    slenderness : sequence of float
        alpha of rectangular blocks [rad].
    sizes : (float, float), optional
        Smallest and largest size, as 2 pi/p [s].
    count : int
        Number of sizes between them, at equal ratios.
    model : {"nonlinear", "linear1", "linear2"}
        The equation of motion.
    eta : float, optional
        Coefficient of restitution; by default that of the structures.
    polarities : sequence of int
        Polarities, of 1 and -1; with both, the worse governs.
    fractiles : sequence of float
        Fractiles in addition to the median, with several motions.

    Returns
    -------
    Answer of list of Spectrum
        One for each structure and slenderness; the peak of a motion that could not be simulated is NaN, that of an
        unknown outcome infinite, with its `lower_bound`.

    Raises
    ------
    InputError
        If a value is out of range, or a file cannot be used.
    MechanismError
        If the structure has no critical rotation or no uplift acceleration.

    Notes
    -----
    Rocking spectra of Makris and Konstantinidis (2003), with the models of DeJong and Dimitrakopoulos (2014).
    """
    from rocking_cli.studies import spectrum as study
    from rocking_cli.views import spectrum as views

    _check_count("count", count)
    shapes = [study.shape_of(_structure(each).mechanism, model, eta) for each in _each(structures)]
    shapes += [study.blocks_of(alpha, model, eta) for alpha in slenderness]
    shaking = [_motion(each) for each in _each(motions)]
    if not shapes:
        raise InputError("no structure given: give structures, or slenderness for blocks")
    periods = np.geomspace(*(sizes or study.usual_sizes(shapes)), count)
    found = study.spectra(shapes, periods, shaking, polarities=polarities)
    polarity = "both" if len(polarities) > 1 else str(polarities[0])
    results = views.ShownSpectra(
        found, [Scaled(each, 1.0) for each in shaking], tuple(sorted({*fractiles, 0.5})), polarity
    )

    def figure() -> Figure:
        from rocking_cli.plotting.spectrum import draw_spectra

        return draw_spectra(found, results.fractiles, views.title(results))

    return Answer("spectrum", found, views.view(results), lambda: views.table(results), figure)


def overturning_map(
    structure: StructureLike | None = None,
    *,
    shape: str = "sine",
    model: ModelName = "linear2",
    eta: float | None = None,
    period: tuple[float, float] | None = None,
    ag: tuple[float, float] | None = None,
    omega: tuple[float, float] | None = None,
    a: tuple[float, float] | None = None,
    polarities: Sequence[int] = (1,),
    points: int = 128,
) -> Answer[OverturningMap]:
    """Map the effect of pulses of all periods and amplitudes on a structure, or on the dimensionless linear block.

    Parameters
    ----------
    structure : Mechanism, str or Path, optional
        Structure; without it, the linear block, with the axes omega = omega_g/p and a = a_g/(g lambda).
    shape : str
        Shape of the pulses.
    model : {"linear2", "linear1", "nonlinear"}
        Model of the structure.
    eta : float, optional
        Coefficient of restitution; by default that of the structure, or 0.9.
    period, ag : (float, float), optional
        Smallest and largest period [s] and amplitude [standard gravity], for a structure.
    omega, a : (float, float), optional
        Smallest and largest dimensionless frequency and amplitude, for the linear block.
    polarities : sequence of int
        Polarities, of 1 and -1; with both, the worse governs.
    points : int
        Number of points along each side.

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
    from rocking_cli.studies import overturning as study
    from rocking_cli.studies.under_pulses import linear_block, parse_shape, pulsed_model
    from rocking_cli.views import overturning as views

    form = parse_shape(shape)
    mechanism = None
    if structure is None:
        subject = linear_block(0.9 if eta is None else eta)
        columns, rows = np.linspace(*(omega or study.OMEGAS), points), np.linspace(*(a or study.AMPLITUDES), points)
    else:
        ready = _structure(structure)
        mechanism, subject = ready.mechanism, pulsed_model(ready, model, form, polarities, eta)
        columns = subject.period(np.linspace(*(period or study.usual_periods([subject])), points))
        rows = np.linspace(*(ag or study.usual_amplitudes([subject])), points) * STANDARD_GRAVITY / subject.unit
    found = study.overturning_map(subject, form, columns, rows, polarities=polarities)
    bare = mechanism is None

    def figure() -> Figure:
        from rocking_cli.plotting.overturning import draw_map

        return draw_map(found, views.map_title(found), dimensionless=bare)

    view = views.map_view(found, mechanism, dimensionless=bare)
    return Answer("overturning map", found, view, lambda: views.map_table(found, mechanism), figure)


def overturning_curves(
    structures: Sequence[StructureLike],
    *,
    shape: str = "sine",
    model: ModelName = "nonlinear",
    period: tuple[float, float] | None = None,
    top: float | None = None,
    polarities: Sequence[int] = (1,),
    points: int = 60,
) -> Answer[Comparison]:
    """Compute the smallest amplitude that overturns each structure, against the period of a pulse.

    Parameters
    ----------
    structures : sequence of Mechanism, str or Path
        Structures to compare.
    shape, model, polarities
        As for `overturning_map`.
    period : (float, float), optional
        Smallest and largest period [s].
    top : float, optional
        Largest amplitude to try [standard gravity].
    points : int
        Number of periods between them, at equal ratios.

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
    """
    from rocking_cli.studies import overturning as study
    from rocking_cli.studies.under_pulses import parse_shape, pulsed_model
    from rocking_cli.views import overturning as views

    form, ready = parse_shape(shape), [_structure(each) for each in structures]
    subjects = [pulsed_model(each, model, form, polarities) for each in ready]
    periods = np.geomspace(*(period or study.usual_periods(subjects)), points)
    found = study.compare(subjects, form, periods, top or study.usual_amplitudes(subjects)[1], polarities=polarities)

    def figure() -> Figure:
        from rocking_cli.plotting.overturning import draw_comparison

        return draw_comparison(found, views.comparison_title(found))

    view = views.comparison_view(found, [each.mechanism for each in ready])
    return Answer("overturning curves", found, view, lambda: views.comparison_table(found), figure)


def margin(
    structure: StructureLike, motions: Motion | Sequence[Motion], *, polarities: Sequence[int] = (1, -1)
) -> MappingAnswer[str, Margin]:
    """Compute the scale factors on motions that uplift a structure, and that overturn it.

    Parameters
    ----------
    structure : Mechanism, str or Path
        The structure, or its YAML file.
    motions
        One or several, as for `respond`.
    polarities : sequence of int
        Polarities, of 1 and -1; with both, the worse governs.

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
    """
    from rocking_cli.studies import margin as study
    from rocking_cli.studies.neighbours import Neighbourhood
    from rocking_cli.views import margin as views

    ready, around = _structure(structure), Neighbourhood()
    shaking = [_motion(each) for each in _each(motions)]
    found = {each.name: study.margin(ready.model("nonlinear"), each, polarities, around=around) for each in shaking}
    rows = [views.MarginRow(each.name, 1.0, each.of_ground.pga_g, found[each.name]) for each in shaking]
    polarity = "both" if len(polarities) > 1 else str(polarities[0])

    def columns() -> Columns:
        return {
            "motion": [name for name, each in found.items() for _ in each.factors],
            "factor": np.concatenate([each.factors for each in found.values()]),
            "overturned": np.concatenate([each.overturned for each in found.values()]),
            "unknown": np.concatenate(
                [each.unknown if each.checked else each.unknown + np.nan for each in found.values()]
            ),
        }

    def figure() -> Figure:
        from rocking_cli.plotting.margin import draw_margins

        return draw_margins(found, heading(ready.mechanism))

    return MappingAnswer("margin", found, views.view(ready.mechanism, rows, polarity, around), columns, figure)


def linearisation(
    structure: StructureLike, *, at: Sequence[float] = (0.5,), a: Sequence[float] = (2.0,)
) -> Answer[list[Linearisation]]:
    """Compute the errors of the equivalent block of a structure; see `rocking error`.

    Parameters
    ----------
    structure : Mechanism, str or Path
        The structure, or its YAML file.
    at : sequence of float
        Amplitudes phi/phi_cr for the free period.
    a : sequence of float
        Constant accelerations for the overturning time, as multiples of the uplift acceleration.

    Returns
    -------
    Answer of list of Linearisation
        One for each distinct direction.

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
    """
    from rocking_cli.studies.linearisation import compare
    from rocking_cli.views import error as views

    ready = _structure(structure)
    curves, found = compare(ready, at, a)

    def columns() -> Columns:
        return {
            "direction": [each.direction.label for each in found for _ in at],
            "phi/phi_cr": [value for _ in found for value in at],
            "period [s]": np.concatenate([each.period for each in found]),
            "period_ratio": np.concatenate([each.period_ratio for each in found]),
        }

    def figure() -> Figure:
        from rocking_cli.plotting.linearisation import draw_linearisation

        return draw_linearisation(curves, found, heading(ready.mechanism))

    view = views.view(ready.mechanism, ready.equivalence, curves, found)
    return Answer("linearisation", list(found), view, columns, figure)


def equivalent(
    structures: Sequence[StructureLike], pulse: Pulse | str, *, polarity: int = 1
) -> Answer[EquivalentResponses]:
    """Find the pulses to which structures are equally vulnerable; the given pulse is for the first.

    Parameters
    ----------
    structures : sequence of Mechanism, str or Path
        At least two structures.
    pulse : Pulse or str
        Pulse such as `sine:0.6g:0.8s`.
    polarity : {1, -1}
        Polarity of the pulse; -1 reverses it.

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
    """
    from rocking_cli.studies import equivalent_pulses as study
    from rocking_cli.views import equivalent_pulses as views

    given = parse_pulse(pulse) if isinstance(pulse, str) else pulse
    found = study.equivalent([_structure(each).mechanism for each in structures], given, polarity=polarity)

    def figure() -> Figure:
        from rocking_cli.plotting.equivalent_pulses import draw_equivalent

        return draw_equivalent(found, views.title(found))

    view = views.view(found, " ".join(study.judge(found)))
    return Answer("equivalent pulses", found, view, lambda: views.table(found), figure)


def fragility(
    study: str | Path | Mapping[str, Any],
    *,
    store: str | Path | None = None,
    threads: int | None = None,
    rank_measures: bool = False,
) -> Answer[list[Fragility]]:
    """Run a fragility study, or continue it, and fit its curves.

    Parameters
    ----------
    study : str, Path or mapping
        YAML file of the study, or its fields in Python, in which structures may be mechanisms; docs/fragility.md lists
        the fields. A study given in Python is written to files next to the store, so that it can be run again.
    store : str or Path, optional
        File in which the runs are stored; by default next to the study file, or study.db in this folder.
    threads : int, optional
        Number of time histories at a time; by default, one for each processor.
    rank_measures : bool
        Whether to rank the intensity measures as well, by how well they predict the outcome.

    Returns
    -------
    Answer of list of Fragility
        One per curve: structure, limit state, measure and fit. If the outcome of some runs is unknown, as a joint opens
        that the model keeps closed, these exceed the limit in the fit and do not in its `lower`.

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
    """
    from rocking_cli.studies.fragility import assess, campaign, table, workers
    from rocking_cli.studies.fragility.definition import Definition
    from rocking_cli.studies.fragility.hazard import HazardCurve
    from rocking_cli.studies.fragility.intensity import label
    from rocking_cli.studies.fragility.quantiles import all_quantiles
    from rocking_cli.studies.fragility.store import Store
    from rocking_cli.studies.fragility.study import load_study
    from rocking_cli.views.fragility import limit_name, view
    from rocking_cli.views.quantiles import with_quantiles

    if isinstance(study, Mapping):
        place = Path(store or "study.db")
        study = _written(study, place)
    else:
        place = Path(store) if store is not None else Path(study).with_suffix(".db")
    asked = load_study(study)
    with Store.writing(place, anew=False, say=lambda text: None) as kept:
        prepared = campaign.prepare(asked, kept, rank_measures=rank_measures)
        with workers.threads(threads) as hands:
            campaign.run(prepared, kept, hands)
    with Store.reading(place) as kept:
        plan, definition = kept.plan(), Definition.model_validate(kept.fact("definition"))
        points = kept.fact("hazard")
        hazard = HazardCurve(*np.array(points)) if points is not None else None
        counted = assess.counted(kept, plan, definition, lambda count: None)
        curves, surfaces = assess.fitted(counted, definition, hazard, lambda count: None)
        shown = view(kept, plan, definition, *kept.count(), curves, surfaces, assess.outcomes(counted))
        shown = with_quantiles(shown, list(all_quantiles(kept, plan, definition)), in_words=False)
        if rank_measures:
            from rocking_cli.studies.fragility.ranking import rank
            from rocking_cli.views.ranking import added

            shown = added(shown, rank(kept, plan, definition))
        blocks = list(table.blocks(kept, plan, definition.asked_measures))

    def columns() -> Columns:
        return {name: [value for block in blocks for value in block[name]] for name in blocks[0]}

    def figure() -> Figure:
        from rocking_cli.plotting.fragility import LabelledCurve, draw_curves

        measure = definition.fitted_measures[0]
        lines = [
            LabelledCurve.of(f"{each.structure}, {limit_name(each.limit)}", each)
            for each in curves
            if each.measure == measure
        ]
        return draw_curves(lines, label(measure), "")

    return Answer("fragility", curves, shown, columns, figure)


def write_report(
    structure: StructureLike,
    motions: Motion | Sequence[Motion] = (),
    file: str | Path = "report.html",
    *,
    polarities: Sequence[int] = (1, -1),
    project: str | None = None,
    place: str | None = None,
    author: str | None = None,
) -> Answer[Any]:
    """Write a report: one HTML file that opens in any browser and can be printed.

    Parameters
    ----------
    structure : Mechanism, str or Path
        The structure, or its YAML file.
    motions
        None, one or several, as for `respond`.
    file : str or Path
        File to write.
    polarities : sequence of int
        Polarities, of 1 and -1.
    project, place, author : str, optional
        Entries for the heading of the report.

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
    The report contains the results of `equiv`, `respond`, `margin`, `overturning_map` and `linearisation`.
    """
    from datetime import UTC, datetime

    from rocking_cli.io.files import check_writable, write_whole
    from rocking_cli.report.page import render
    from rocking_cli.studies.assessment import File, TitleBlock, gather
    from rocking_cli.views.assessment import view

    check_writable(Path(file))
    ready = _structure(structure)
    text = Path(ready.file).read_bytes() if ready.file is not None else _yaml(ready.mechanism).encode()
    given = [_scaled(each) for each in _each(motions)]
    today = datetime.now(UTC).strftime("%d %B %Y").lstrip("0")
    found = gather(
        ready,
        File(ready.file or ready.name, text),
        given,
        polarities,
        title=TitleBlock("rocking_cli.write_report(...)", today, project, place, author),
    )
    page = render(found).encode()
    write_whole(Path(file), lambda stream: stream.write(page))

    def columns() -> Columns:
        runs = [(each.given.motion.name, each.histories["nonlinear"]) for each in found.results]
        return {
            "motion": [name for name, _ in runs],
            "peak_ratio": [run.peak_ratio for _, run in runs],
            "overturned": [None if run.unknown else run.overturned for _, run in runs],
            "unknown": [run.unknown for _, run in runs],
        }

    def figure() -> Figure:
        from rocking_cli.plotting.structure import draw_structure

        return draw_structure(found.picture, heading(ready.mechanism))

    return Answer("report", found, view(found), columns, figure)


def _scaled(given: Motion) -> Scaled:
    read = _read(given)
    if isinstance(read, Pulse):
        return Scaled(read.sampled(), 1.0, pulse=read)
    return Scaled(read, 1.0, file=None if isinstance(given, GroundMotion | Pulse) else Path(given))


def _yaml(mechanism: Mechanism) -> str:
    """Return the YAML file of a mechanism made in Python."""
    fields = {"mechanism": mechanism.mechanism, **mechanism.model_dump(exclude_unset=True)}
    return "".join(f"{key}: {json_text(value)}\n" for key, value in fields.items())


def _written(study: Mapping[str, Any], store: Path) -> Path:
    """Write a study given in Python and its mechanisms to files next to the store, named after it."""
    from rocking_cli.io.files import write_whole

    def write(path: Path, text: str) -> Path:
        write_whole(path, lambda stream: stream.write(text.encode()))
        return path

    structures: list[object] = []
    for k, each in enumerate(study.get("structures", []), start=1):
        if isinstance(each, Mechanism):
            file = write(store.with_name(f"{store.stem}-{k}.yaml"), _yaml(each))
            structures.append({"file": file.name, "name": each.name or each.mechanism})
        else:
            structures.append(str(each) if isinstance(each, Path) else each)
    records = [str(each) if isinstance(each, Path) else each for each in study.get("records", [])]
    text = json_text({**study, "structures": structures, "records": records})
    return write(store.with_suffix(".yaml"), text + "\n")
