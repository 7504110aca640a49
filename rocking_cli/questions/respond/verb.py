"""`rk.respond`: compute the response of a structure to a ground motion or a release."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import nullcontext
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from rocking_cli.ask.answer import Answers, Dimensions, MappingAnswer
from rocking_cli.ask.inputs import doubts_of, structure_of
from rocking_cli.ask.kinds import STANDARD_OUTPUT
from rocking_cli.ask.verbs import answers, are_several, ask_each, places_of, verb, write_files
from rocking_cli.ask.watcher import Watcher
from rocking_cli.dynamics.history import History
from rocking_cli.dynamics.model import MODELS, ModelName
from rocking_cli.errors import InputError, Problem, named
from rocking_cli.excitation.base import STANDARD_GRAVITY, GroundMotion
from rocking_cli.io.tables import stacked
from rocking_cli.processing.reading import Scaled
from rocking_cli.questions.respond.asked import NOT_BY_ENGINES, NOT_OF_BLOCKS, RespondAsked
from rocking_cli.questions.respond.motion_verbs import all_directions, with_vertical
from rocking_cli.structure import Structure
from rocking_cli.studies.neighbours import Neighbourhood
from rocking_cli.studies.response import Response
from rocking_cli.views.restitution import heading_of_run
from rocking_cli.views.view import Table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rocking_cli.io.tables import Columns

GROUND = ("a_g", "v_g")
"""Columns of a history that are those of the ground."""


class ResponseAnswer(MappingAnswer[ModelName, History]):
    """Histories by model, of the first polarity if there are two; and all that `Response` has as attributes."""

    result: Response


@verb(RespondAsked)
def respond(asked: RespondAsked, watch: Watcher) -> ResponseAnswer | Answers[ResponseAnswer]:
    """Compute the response of a structure to ground motions, a release or both; `respond_each` is for outcomes alone.

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
        `respond_around`. The history of free blocks has the model "blocks"; their impacts lose what contact takes.

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
    from rocking_cli.questions.respond.several import Several
    from rocking_cli.studies.conditions import Conditions
    from rocking_cli.studies.response import response_of
    from rocking_cli.views.engines import cost_in_words
    from rocking_cli.views.response import view

    ready = structure_of(asked.structure, watch, asked.opening, asked.restitution)
    motions, signs, engine = asked.ground_motions, asked.signs, asked.engine
    if asked.all_around:
        around = all_directions(ready, asked, watch)
        write_files(around, asked, watch)
        return around  # type: ignore[return-value]
    rocks = engine == "exact" or ready.no_model is None
    if not rocks:
        asked.refuse(f"as {ready.no_model}", (*NOT_BY_ENGINES, *NOT_OF_BLOCKS, "neighbours", "out", "plot"))
        engine = "blocks"
    chosen: list[Scaled] = []
    if motions:
        chosen = motions.gather(ready.growth if rocks else 0.0, watch, with_vertical=asked.vertical is not None)
        chosen = [with_vertical(asked, each, watch) for each in chosen]
    else:
        ready = ready.released()
    names = ("nonlinear",) if engine != "exact" else asked.models(()) or usual_models(ready, watch)
    if rocks:
        ready.models(names)
    conditions = Conditions(
        ready, names, signs, asked.ratio(ready), getattr(asked.release, "is_angle", False), asked.tail,
        asked.rtol, asked.with_pulse, asked.neighbourhood(0) if rocks else Neighbourhood(0), engine,
    )  # fmt: skip
    title, doubts = heading_of_run(ready) if asked.title is None else asked.title, doubts_of(ready.mechanism)
    contact = asked.contact or ready.mechanism.friction is not None
    under = ("pulse_alone",) * (asked.with_pulse is not None) + ("polarity",) * (len(signs) > 1)
    dims = [Dimensions((*under, "t"), GROUND), Dimensions((*under, "block" if asked.each_block else "model", "t"))]

    def one(given: Scaled | None, title: str, files: RespondAsked) -> ResponseAnswer:
        count = conditions.around.count * len(signs)
        if count and given is not None and (cost := cost_in_words(conditions.by, ready, given.motion, count)):
            watch.note(cost)
        with watch.working("simulating free blocks") if engine != "exact" else nullcontext():
            response = response_of(conditions, given)
        _note_pulse(response, watch)
        shown = view(response, conditions, title, doubts, impacts=asked.impacts)
        figure = partial(_figure, response, ready, title, contact=contact)
        blocks = partial(_of_each_block if asked.each_block else _blocks, response, ready)
        columns = partial(_columns, blocks) if asked.each_block else partial(_long_columns, response, ready)
        more = {"impacts": partial(_impact_columns, response)}
        answer = ResponseAnswer("response", response, shown, columns, figure, blocks, more, dims)
        write_files(answer, files, watch)
        return answer

    if not are_several(asked.motions, motions):
        return one(chosen[0] if chosen else None, title, asked)
    if str(asked.out) == STANDARD_OUTPUT:
        raise InputError(Problem("- takes the table of a single motion: for several, give a file", field=named("out")))
    table, details = Several(conditions, motions.count), list[Table | str]()
    read = [ready.file, *(each.path for each in motions.records)]
    outs, plots = places_of("out", asked.out, chosen, read), places_of("plot", asked.plot, chosen, read)

    def row(given: Scaled, k: int) -> ResponseAnswer:
        files = asked.model_copy(update={"out": outs[k], "plot": plots[k]})
        answer = one(given, f"{title}, under {given.motion.name}", files)
        table.add(answer.result)
        details.extend(["", *answer.view.parts] if asked.impacts else [])
        return answer

    responses, left_out = ask_each(chosen, row, watch)
    unread = [each.path.name for each in motions.records if all(each is not one.record for one in chosen)]
    parts = [*table.parts([*unread, *left_out]), *details]
    return answers("responses", "motion", responses, parts, tables={"peaks": table.columns})


def _note_pulse(response: Response, watch: Watcher) -> None:
    if (fit := response.fit) is not None:
        watch.note(
            f"pulse: {fit.pulse.title}, a_p = {fit.pulse.amplitude / STANDARD_GRAVITY:.4g} g, "
            f"T_p = {fit.pulse.period:.4g} s, from {fit.start:.4g} s, sign {fit.sign:+d}: "
            f"{100 * fit.captured:.0f} % of the energy of the velocity"
        )


def usual_models(structure: Structure, watch: Watcher) -> tuple[ModelName, ...]:
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


def _long_columns(response: Response, structure: Structure) -> Columns:
    """Return the histories with a row for each sample of each, and what it is of."""
    from rocking_cli.questions.respond import history_table
    from rocking_cli.studies.contact import Contacts
    from rocking_cli.studies.movements import Watched

    first, fit, contacts = response.first, response.fit, Contacts(structure.mechanism)
    under: list[tuple[dict[str, int], GroundMotion | None, Mapping[ModelName, History]]] = [({}, first, response)]
    if first is not None and len(response.runs) > 1:
        motions = (first, first.scaled(-1))
        under = [
            ({"polarity": sign}, motion, runs)
            for (sign, runs), motion in zip(response.runs.items(), motions, strict=True)
        ]
    elif first is not None and fit is not None and response.to_pulse is not None:
        under = [({"pulse_alone": 0}, first, response), ({"pulse_alone": 1}, fit.alone(first), response.to_pulse)]

    def tables() -> Iterator[dict[str, object]]:
        for of, motion, runs in under:
            shear = {"nonlinear": contacts.base_shear(runs["nonlinear"], motion)} if "nonlinear" in runs else {}
            watched = Watched(structure.mechanism)
            wide = stacked(history_table.blocks(runs, motion, watched=watched, base_shear=shear))
            common = {head: values for head, values in wide.items() if head.partition(" ")[0] in ("t", *GROUND)}
            for model in runs:
                start = f"{model} "
                moved = {head.removeprefix(start): each for head, each in wide.items() if head.startswith(start)}
                yield {**of, "model": model, **common, **moved}

    return stacked(tables())


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
    return stacked(blocks())


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
