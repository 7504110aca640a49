"""`rk.respond`: compute the response of a structure to a ground motion or a release."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import nullcontext
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Unpack

import numpy as np
from numpy.typing import NDArray

from rocking_cli.ask.answer import MappingAnswer
from rocking_cli.ask.given import StructureLike, around_of, doubts_of, models_of, structure_of
from rocking_cli.ask.ground_motions import Motion, MotionArguments, Motions, signs_of
from rocking_cli.ask.numbers import refuse_idle, takes_numbers
from rocking_cli.ask.several import Answers, answers, are_several, ask_each, places_of, under_motions, write_files
from rocking_cli.ask.watcher import SILENT, Watcher
from rocking_cli.dynamics.history import FINEST_RTOL, RTOL, TAIL_SECONDS, History
from rocking_cli.dynamics.model import MODELS, ModelName
from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.base import STANDARD_GRAVITY, GroundMotion
from rocking_cli.names import OPENING
from rocking_cli.processing.listed import Scaled
from rocking_cli.processing.reading_options import ALL_AZIMUTHS
from rocking_cli.questions.respond.motion_verbs import all_directions
from rocking_cli.structure import Structure
from rocking_cli.studies.neighbours import Neighbourhood
from rocking_cli.studies.release import Release
from rocking_cli.studies.response import Question, Response
from rocking_cli.views.view import Table, heading

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rocking_cli.io.tables import Columns


class ResponseAnswer(MappingAnswer[ModelName, History]):
    """Histories by model, of the first polarity if there are two; and all that `Response` has as attributes."""

    result: Response


@under_motions
@takes_numbers
def respond(
    structure: StructureLike,
    motion: Motion | Motions | Sequence[Motion] | None = None,
    *,
    models: str | Sequence[str] | None = None,
    polarity: str | int = "1",
    vertical: GroundMotion | str | Path | None = None,
    vertical_dt: float | None = None,
    vertical_channel: str | None = None,
    with_pulse: str | None = None,
    release: Release | float | str | None = None,
    tail: float = TAIL_SECONDS,
    rtol: float = RTOL,
    neighbours: int = 0,
    amplitude_deviation: float = Neighbourhood.amplitude,
    slenderness_deviation: float | None = None,
    restitution_deviation: float | None = None,
    opening: float = OPENING,
    engine: str = "exact",
    impacts: bool = False,
    contact: bool = False,
    each_block: bool = False,
    title: str | None = None,
    out: str | Path | None = None,
    plot: str | Path | None = None,
    watch: Watcher = SILENT,
    **options: Unpack[MotionArguments],
) -> ResponseAnswer | Answers[ResponseAnswer]:
    """Compute the response of a structure to ground motions, a release or both; `respond_each` is for outcomes alone.

    Parameters
    ----------
    structure : Mechanism, str or Path
        The structure, or its YAML file.
    motion : GroundMotion, Pulse, str or Path, or a sequence of these, optional
        The motion, its file, or a pulse as text; a pattern such as `records/*.AT2`, or a sequence, gives several.
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
    opening : float
        Largest opening of a joint up to which a history is valid, over D_cr.
    engine : {"exact", "blocks", "auto"}
        Who simulates the motion: one degree of freedom, free blocks, or free blocks as well if one degree of freedom
        does not tell the outcome. The history of free blocks has the model "blocks".
    impacts : bool
        Whether the answer lists the impacts: the first in a table, without chatter, all in the data.
    contact : bool
        Whether the plot shows the friction required; it does if the structure gives `friction`.
    each_block : bool
        Whether frame and table have the motion of each block, to play it back: time, name, place of its centroid and
        clockwise rotation, by the nonlinear model.
    title : str, optional
        Title of tables and plot; by default the name of the structure.
    out, plot : str or Path, optional
        Files to write: the time histories (.csv or .parquet) and the plot (.png, .svg or .pdf). Of several motions each
        has its own, with its name in that of the file.
    watch : Watcher
        Told what was read, and what is doubtful about it; of several motions, which cannot be used.
    **options
        How the motion is read, corrected and scaled: see `rocking_cli.ask.ground_motions.MotionArguments`. With
        `azimuth="all"`, the response is computed in every direction between the two components of one record.

    Returns
    -------
    ResponseAnswer
        Time histories, by model. `runs` has those of each polarity, `neighbours` the outcomes of the neighbours,
        `contacts` the contact demands, `fit` and `to_pulse` the pulse and the response to it. Its frame has the time
        histories, `frames["impacts"]` the impacts. For several motions, `Answers` with one for each, by its name,
        and `frames["peaks"]` with the peak displacement and tie forces under each; for all azimuths, the answer of
        `respond_around`.

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
    from rocking_cli.questions.respond.several import Several
    from rocking_cli.studies.engines import engine_of
    from rocking_cli.studies.response import response_of
    from rocking_cli.views.engines import cost_in_words
    from rocking_cli.views.response import view

    _check_rtol(rtol)
    ready = structure_of(structure, watch, opening)
    motions, signs = Motions.of(() if motion is None else motion, options), signs_of(polarity)
    tilt = release if release is None or isinstance(release, Release) else Release.of(release)
    several, third = are_several(motion, motions), (vertical, vertical_dt, vertical_channel)
    _check(motions, signs, third, with_pulse, several=several, released=tilt is not None)
    drawn_around = around_of(neighbours, amplitude_deviation, restitution_deviation, slenderness_deviation)
    if motions.reading.azimuth == ALL_AZIMUTHS:
        _refuse_with_all_azimuths(polarity=signs != (1,), with_pulse=with_pulse, impacts=impacts, contact=contact,
                                  each_block=each_block, tail=tail != TAIL_SECONDS, neighbours=neighbours,
                                  engine=engine != "exact")  # fmt: skip
        around = all_directions(ready, motions, third, models=models, release=tilt, rtol=rtol, watch=watch)
        write_files(around, out, plot, watch)
        return around  # type: ignore[no-any-return]
    rocks = engine == "exact" or ready.no_model is None
    engine = engine if rocks else "blocks"
    growth = ready.growth if rocks else 0.0
    chosen = motions.gather(growth, watch, with_vertical=vertical is not None) if motions else [None]
    if vertical is not None and chosen[0] is not None:
        if not isinstance(vertical, GroundMotion):
            vertical = motions.vertical(chosen[0], vertical, vertical_dt, vertical_channel, watch)
        chosen[0] = chosen[0]._replace(motion=replace(chosen[0].motion, vertical=vertical))
    if not motions:
        refuse_idle("without a ground motion", neighbours=neighbours)
        ready = ready.released()
    ratio = tilt.ratio(ready) if tilt is not None else None
    question = Question(signs, ratio, tail, rtol, with_pulse, drawn_around, tilt is not None and tilt.is_angle,
                        engine_of(engine).name)  # fmt: skip
    if engine != "exact":
        refuse_idle("with free blocks", models=models, with_pulse=with_pulse)
        models = "nonlinear"
    if engine == "blocks":
        idle = {"rtol": rtol != RTOL, "opening": opening != OPENING, "impacts": impacts, "contact": contact}
        refuse_idle("with free blocks", **idle, each_block=each_block, restitution_deviation=restitution_deviation)
    names = models_of(models) if models is not None else usual_models(ready, watch)
    if not rocks:
        refuse_idle(f"as {ready.no_model}", neighbours=neighbours, out=out, plot=plot)
    else:
        ready.models(names)
    if "nonlinear" not in names:
        refuse_idle("on linear blocks, which have no joints", opening=opening != OPENING, each_block=each_block)
    title, doubts = heading(ready.mechanism) if title is None else title, doubts_of(ready.mechanism)

    def one(given: Scaled | None, title: str, table: str | Path | None, picture: str | Path | None) -> ResponseAnswer:
        count = neighbours * len(signs)
        if count and given is not None and (cost := cost_in_words(engine_of(engine), ready, given.motion, count)):
            watch.note(cost)
        with watch.working("simulating free blocks") if engine != "exact" else nullcontext():
            response = response_of(ready, names, given, question)
        _note_pulse(response, watch)
        shown = view(response, ready, question, str(polarity), title, doubts, impacts=impacts)
        figure = partial(_figure, response, ready, title, contact=contact or ready.mechanism.friction is not None)
        blocks = partial(_of_each_block if each_block else _blocks, response, ready)
        columns = partial(_columns, blocks)
        more = {"impacts": partial(_impact_columns, response)}
        answer = ResponseAnswer("response", response, shown, columns, figure, blocks, more)
        write_files(answer, table, picture, watch)
        return answer

    if not several:
        return one(chosen[0], title, out, plot)
    table, details = Several(ready, names, motions.count, question.engine), list[Table | str]()
    scaled = [each for each in chosen if each is not None]
    read = [ready.file, *(each.path for each in motions.records)]
    outs, plots = places_of("out", out, scaled, read), places_of("plot", plot, scaled, read)

    def row(given: Scaled, k: int) -> ResponseAnswer:
        answer = one(given, f"{title}, under {given.motion.name}", outs[k], plots[k])
        table.add(answer.result)
        details.extend(["", *answer.view.parts] if impacts else [])
        return answer

    responses, left_out = ask_each(scaled, row, watch)
    unread = [each.path.name for each in motions.records if all(each is not one.record for one in scaled)]
    parts = [*table.parts([*unread, *left_out]), *details]
    return answers("responses", "motion", responses, parts, tables={"peaks": table.columns})


def _note_pulse(response: Response, watch: Watcher) -> None:
    if (fit := response.fit) is not None:
        watch.note(
            f"pulse: {fit.pulse.title}, a_p = {fit.pulse.amplitude / STANDARD_GRAVITY:.4g} g, "
            f"T_p = {fit.pulse.period:.4g} s, from {fit.start:.4g} s, sign {fit.sign:+d}: "
            f"{100 * fit.captured:.0f} % of the energy of the velocity"
        )


def _check_rtol(rtol: float) -> None:
    if not FINEST_RTOL <= rtol < 1:
        what = f"{rtol:g} is not a number from {FINEST_RTOL:g} to below 1: smaller errors are below rounding"
        raise InputError(Problem(what, field="`rtol`"))


def _refuse_with_all_azimuths(**arguments: object) -> None:
    if names := [f"`{name}`" for name, value in arguments.items() if value]:
        raise InputError(f"{', '.join(names)} cannot be combined with `azimuth` all: give one angle")


def _check(
    motions: Motions,
    signs: Sequence[int],
    third: Sequence[object],
    with_pulse: str | None,
    *,
    several: bool,
    released: bool,
) -> None:
    """Raise `InputError` if arguments have no effect or cannot be combined; `third` has those of the vertical."""
    vertical, *of_vertical = third
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
    if vertical is not None and several:
        raise InputError("`vertical` applies to a single motion: give one")
    if not motions and not released:
        raise InputError("no excitation is given: give a motion or a `release`")


def usual_models(structure: Structure, watch: Watcher = SILENT) -> tuple[ModelName, ...]:
    """Return the models that do not mislead for a structure, with a note on the others."""
    if len(structure.default_models) < len(MODELS):
        why = structure.why_no_block or structure.misleading or "the restitution is not known"
        watch.note(f"nonlinear history only: {why}")
    return structure.default_models


def _blocks(response: Response, structure: Structure) -> Iterator[dict[str, NDArray[np.float64]]]:
    """Yield the histories of the first polarity, then those of the second, or those under the pulse alone."""
    from rocking_cli.questions.respond import history_table
    from rocking_cli.studies.contact import Contacts
    from rocking_cli.studies.movements import Watched

    first, *others = response.runs.values()
    runs: dict[str, History] = dict(first.items())
    runs |= {f"reversed {name}": run for other in others for name, run in other.items()}
    runs |= {f"pulse {name}": run for name, run in (response.to_pulse or {}).items()}
    contacts = Contacts(structure.mechanism)
    shear = {"nonlinear": contacts.base_shear(first["nonlinear"], response.first)} if "nonlinear" in first else {}
    yield from history_table.blocks(runs, response.first, watched=Watched(structure.mechanism), base_shear=shear)


def _of_each_block(response: Response, structure: Structure) -> Iterator[Columns]:
    """Yield the motion of each block, a row for each sample and block, of one polarity after the other."""
    from rocking_cli.studies.movements import Watched

    for sign, runs in response.runs.items():
        run = runs["nonlinear"]
        names, places, turns = zip(*Watched(structure.mechanism).bodies(run), strict=True)
        z = np.stack(places, axis=1).ravel()
        polarity = {"polarity": np.full(z.size, sign)} if len(response.runs) > 1 else {}
        yield {
            **polarity, "t [s]": np.repeat(run.time, len(names)), "block": np.tile(names, run.time.size),
            "x [m]": z.real, "z [m]": z.imag, "rotation [rad]": np.stack(turns, axis=1).ravel(),
        }  # fmt: skip


def _columns(blocks: Callable[[], Iterator[Columns]]) -> Columns:
    each = list(blocks())
    return {name: np.concatenate([block[name] for block in each]) for name in each[0]}


def _impact_columns(response: Response) -> Columns:
    rows = [
        (sign, name, *impact)
        for sign, runs in response.runs.items()
        for name, run in runs.items()
        for impact in run.impacts.tolist()
    ]
    heads = "polarity", "model", "t [s]", "direction", "phi_dot before [rad/s]"
    return {head: [row[k] for row in rows] for k, head in enumerate(heads)}


def _figure(response: Response, structure: Structure, title: str, *, contact: bool) -> Figure:
    from rocking_cli.names import peaks_over
    from rocking_cli.questions.respond.picture import draw_history
    from rocking_cli.views.conclusion import headline

    first, *others = response.runs.values()
    fit, alone = response.fit, response.to_pulse
    pulse = (fit, alone) if fit is not None and alone is not None else None
    checked = list(response.contacts.values()) if contact else []
    over = peaks_over(next(iter(first.values())).ends_at_limit).replace("phi_cr", "φcr")
    title = f"{title} ({headline(response.conclusion, over)})"
    return draw_history(first, response.first, title, others[0] if others else None, pulse, structure, checked)
