"""`rk.respond`: compute the response of a structure to a ground motion or a release."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Unpack

import numpy as np
from numpy.typing import NDArray

from rocking_cli.ask.answer import MappingAnswer
from rocking_cli.ask.given import StructureLike, doubts_of, models_of, structure_of
from rocking_cli.ask.ground_motions import Motion, MotionArguments, Motions, signs_of
from rocking_cli.ask.numbers import takes_numbers
from rocking_cli.ask.watcher import SILENT, Watcher
from rocking_cli.dynamics.history import FINEST_RTOL, RTOL, TAIL, History
from rocking_cli.dynamics.model import MODELS, ModelName
from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.base import STANDARD_GRAVITY, GroundMotion
from rocking_cli.processing.reading_options import ALL
from rocking_cli.structure import Structure
from rocking_cli.studies.neighbours import Neighbourhood
from rocking_cli.studies.release import Release
from rocking_cli.studies.response import Question, Response
from rocking_cli.views.view import heading

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rocking_cli.io.tables import Columns


class ResponseAnswer(MappingAnswer[ModelName, History]):
    """Histories by model, of the first polarity if there are two; and all that `Response` has as attributes."""

    result: Response


@takes_numbers
def respond(
    structure: StructureLike,
    motion: Motion | Motions | None = None,
    *,
    models: str | Sequence[str] | None = None,
    polarity: str | int = "1",
    vertical: GroundMotion | str | Path | None = None,
    vertical_dt: float | None = None,
    vertical_channel: str | None = None,
    with_pulse: str | None = None,
    release: Release | float | str | None = None,
    tail: float = TAIL,
    rtol: float = RTOL,
    neighbours: int = 0,
    amplitude_deviation: float = Neighbourhood.amplitude,
    slenderness_deviation: float | None = None,
    restitution_deviation: float | None = None,
    opening: float | None = None,
    impacts: bool = False,
    contact: bool = False,
    title: str | None = None,
    watch: Watcher = SILENT,
    **options: Unpack[MotionArguments],
) -> ResponseAnswer:
    """Compute the response of a structure to a ground motion, a release or both; `respond_each` is for many.

    Parameters
    ----------
    structure : Mechanism, str or Path
        The structure, or its YAML file.
    motion : GroundMotion, Pulse, str or Path, optional
        The motion, its file, or a pulse as text.
    models : str or sequence of str, optional
        Models "nonlinear", "linear1" or "linear2"; by default all, or the nonlinear one alone if the others mislead.
    polarity : {"1", "-1", "both"}
        Polarity of the motion: as given, reversed, or one after the other.
    vertical, vertical_dt, vertical_channel : path, float, str, optional
        File of the vertical component of the motion, its sampling interval [s] and its channel.
    with_pulse : str, optional
        Shape of the pulse in the record under which the response is computed as well, or "best".
    release : float or str, optional
        Initial tilt of a release from rest: a fraction of phi_cr, between -1 and 1, or an angle such as "0.05rad";
        negative is anticlockwise.
    tail : float
        Length of output after the end of the record [s].
    rtol : float
        Relative error tolerance per step of the nonlinear integration.
    neighbours : int
        Number of neighbouring motions to simulate as well; 0 for none.
    amplitude_deviation, slenderness_deviation, restitution_deviation : float, optional
        Standard deviations of the neighbours: of ln amplitude, of ln slenderness and of restitution; by default those
        of the structure.
    opening : float, optional
        Largest opening of a joint up to which a history is valid, over D_cr; by default that of the structure.
    impacts : bool
        Whether the answer lists the impacts: the first in a table, without chatter, all in the data.
    contact : bool
        Whether the plot shows the friction required; it does if the structure gives `friction`.
    title : str, optional
        Title of tables and plot; by default the name of the structure.
    watch : Watcher
        Told what was read, and what is doubtful about it.
    **options
        How the motion is read, corrected and scaled: see `rocking_cli.ask.ground_motions.MotionArguments`.

    Returns
    -------
    ResponseAnswer
        Time histories, by model. `runs` has those of each polarity, `neighbours` the outcomes of the neighbours,
        `contacts` the contact demands, `fit` and `to_pulse` the pulse and the response to it. With `azimuth` "all",
        instead, what `respond_around` returns.

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
    from rocking_cli.studies.response import response_of
    from rocking_cli.views.response import view

    if not FINEST_RTOL <= rtol < 1:
        what = f"{rtol:g} is not a number from {FINEST_RTOL:g} to below 1: smaller errors are below rounding"
        raise InputError(Problem(what, field="`rtol`"))
    ready = structure_of(structure, opening)
    motions, signs = Motions.of(() if motion is None else motion, options), signs_of(polarity)
    _check(motions, signs, vertical, (vertical_dt, vertical_channel), with_pulse)
    if motions.reading.azimuth == ALL:
        from rocking_cli.ask.motions import all_directions

        idle = {
            "polarity": str(polarity) != "1", "with_pulse": with_pulse is not None, "impacts": impacts,
            "contact": contact, "tail": tail != TAIL, "neighbours": neighbours != 0,
        }  # fmt: skip
        if said := [f"`{name}`" for name, given in idle.items() if given]:
            raise InputError(f"{', '.join(said)} cannot be combined with `azimuth` all: give one angle")
        of_vertical = (vertical, vertical_dt, vertical_channel)
        answer: ResponseAnswer
        answer = all_directions(ready, motions, of_vertical, models=models, release=release, rtol=rtol, watch=watch)
        return answer
    given = motions.one(ready.growth, watch, with_vertical=vertical is not None) if motions else None
    if given is None and release is None:
        raise InputError("no excitation is given: give a motion or a `release`")
    if vertical is not None and given is not None:
        if not isinstance(vertical, GroundMotion):
            vertical = motions.vertical(given, vertical, vertical_dt, vertical_channel, watch)
        given = given._replace(motion=replace(given.motion, vertical=vertical))
    tilt = release if release is None or isinstance(release, Release) else Release.of(release)
    question = Question(
        signs,
        tilt.ratio(ready) if tilt is not None else None,
        tail,
        rtol,
        with_pulse,
        Neighbourhood(neighbours, amplitude_deviation, restitution_deviation, slenderness_deviation),
        tilt is not None and tilt.is_angle,
    )
    chosen = models_of(models) if models is not None else usual_models(ready, watch)
    ready.models(chosen)
    response = response_of(ready, chosen, given, question)
    if (fit := response.fit) is not None:
        watch.note(
            f"pulse: {fit.pulse.title}, a_p = {fit.pulse.amplitude / STANDARD_GRAVITY:.4g} g, "
            f"T_p = {fit.pulse.period:.4g} s, from {fit.start:.4g} s, sign {fit.sign:+d}: "
            f"{100 * fit.captured:.0f} % of the energy of the velocity"
        )
    title = heading(ready.mechanism) if title is None else title
    shown = view(response, ready, question, str(polarity), title, doubts_of(ready.mechanism), impacts=impacts)
    figure = partial(_figure, response, ready, title, contact=contact or ready.mechanism.friction is not None)
    blocks = partial(_blocks, response, ready)
    return ResponseAnswer("response", response, shown, partial(_columns, response, ready), figure, blocks)


def _check(
    motions: Motions, signs: Sequence[int], vertical: object, of_vertical: Sequence[object], with_pulse: str | None
) -> None:
    """Raise `InputError` if arguments have no effect or cannot be combined."""
    if not motions and vertical is not None:
        raise InputError("`vertical` requires a horizontal component: give `motion`")
    if vertical is None and any(value is not None for value in of_vertical):
        raise InputError("`vertical_dt` and `vertical_channel` require a vertical component: give `vertical`")
    if not motions and tuple(signs) != (1,):
        raise InputError("`polarity` reverses a ground motion: give `motion`")
    if with_pulse is not None and not motions.has_records:
        raise InputError("`with_pulse` requires a record: give the file of one")
    if with_pulse is not None and len(signs) > 1:
        raise InputError("`with_pulse` cannot be combined with `polarity` both: ask for one polarity at a time")


def usual_models(structure: Structure, watch: Watcher = SILENT) -> tuple[ModelName, ...]:
    """Return the models that do not mislead for a structure, with a note on the others."""
    if len(structure.default_models) < len(MODELS):
        watch.note(f"nonlinear history only: {structure.why_no_block or structure.misleading}")
    return structure.default_models


def _blocks(response: Response, structure: Structure) -> Iterator[dict[str, NDArray[np.float64]]]:
    """Yield the histories of the first polarity, then those of the second, or those under the pulse alone."""
    from rocking_cli.studies.contact import Contacts
    from rocking_cli.studies.movements import Watched
    from rocking_cli.views import history_table

    first, *others = response.runs.values()
    runs: dict[str, History] = dict(first.items())
    runs |= {f"reversed {name}": run for other in others for name, run in other.items()}
    runs |= {f"pulse {name}": run for name, run in (response.to_pulse or {}).items()}
    contacts = Contacts(structure.mechanism)
    shear = {"nonlinear": contacts.base_shear(first["nonlinear"], response.first)} if "nonlinear" in first else {}
    yield from history_table.blocks(runs, response.first, watched=Watched(structure.mechanism), base_shear=shear)


def _columns(response: Response, structure: Structure) -> Columns:
    blocks = list(_blocks(response, structure))
    return {name: np.concatenate([block[name] for block in blocks]) for name in blocks[0]}


def _figure(response: Response, structure: Structure, title: str, *, contact: bool) -> Figure:
    from rocking_cli.plotting.history import draw_history
    from rocking_cli.studies.movements import Watched
    from rocking_cli.views.conclusion import headline

    first, *others = response.runs.values()
    fit, alone = response.fit, response.to_pulse
    pulse = (fit, alone) if fit is not None and alone is not None else None
    checked = list(response.contacts.values()) if contact else []
    title = f"{title} ({headline(response.conclusion)})"
    return draw_history(
        first, response.first, title, others[0] if others else None, pulse, structure.uplift, checked,
        Watched(structure.mechanism),
    )  # fmt: skip
