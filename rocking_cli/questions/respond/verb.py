"""`rk.respond`: compute the response of a structure to a ground motion or a release."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from math import nan
from typing import TYPE_CHECKING

from rocking_cli.ask.answer import Answers, Dimensions, MappingAnswer
from rocking_cli.ask.inputs import doubts_of, structure_of
from rocking_cli.ask.kinds import STANDARD_OUTPUT
from rocking_cli.ask.verbs import answers, are_several, ask_each, places_of, verb, write_files
from rocking_cli.ask.watcher import Watcher
from rocking_cli.dynamics.history import History
from rocking_cli.dynamics.model import MODELS, ModelName
from rocking_cli.errors import InputError, Problem, named
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.processing.reading import Scaled
from rocking_cli.questions.respond.asked import NOT_OF_BLOCKS, WITH_BLOCKS, RespondAsked
from rocking_cli.questions.respond.history_table import GROUND
from rocking_cli.questions.respond.motion_verbs import all_directions, with_vertical
from rocking_cli.structure import Structure
from rocking_cli.studies.neighbours import Conditions, Neighbourhood
from rocking_cli.studies.response import Response, response_of
from rocking_cli.views.restitution import heading_of_run
from rocking_cli.views.view import Table

if TYPE_CHECKING:
    from matplotlib.figure import Figure


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
    structure = structure_of(asked.structure, watch, asked.opening, asked.restitution)
    if asked.all_around:
        around = all_directions(structure, asked, watch)
        write_files(around, asked, watch)
        return around  # type: ignore[return-value]
    if asked.animate is not None:
        from rocking_cli.questions.animate.verb import check_program

        check_program(asked.animate)
    if asked.in_space:
        from rocking_cli.questions.respond.in_space import in_space

        return in_space(structure, asked, watch)  # type: ignore[return-value]
    motions, chosen = asked.ground_motions, list[Scaled]()
    if asked.engine in WITH_BLOCKS and structure.no_model is not None:
        asked.refuse(f"as {structure.no_model}", NOT_OF_BLOCKS)
    if motions:
        growth = 0.0 if asked.engine in WITH_BLOCKS and structure.no_model is not None else structure.growth
        chosen = motions.gather(growth, watch, with_vertical=asked.vertical is not None)
        chosen = [with_vertical(asked, motion, watch) for motion in chosen]
    run = _prepared(structure if motions else structure.released(), asked, watch)
    if not are_several(asked.motions, motions):
        return run.answer(chosen[0] if chosen else None, run.title, asked)
    return _of_several(run, chosen)


def _prepared(structure: Structure, asked: RespondAsked, watch: Watcher) -> _Answering:
    """Return what all motions of a question share: the structure, its models and the conditions of the run."""
    engine, around, models = asked.engine or "exact", asked.neighbourhood(0), asked.models(("nonlinear",))
    if engine != "exact" and structure.no_model is not None:
        engine, around = "blocks", Neighbourhood(0)
    else:
        models = models if engine != "exact" or asked.model else usual_models(structure, watch)
        structure.models(models)
    conditions = Conditions(
        structure, models, asked.signs, asked.ratio(structure), getattr(asked.release, "is_angle", False), asked.tail,
        asked.rtol, asked.with_pulse, around, engine,
        goes_on=asked.engine is None and not are_several(asked.motions, asked.ground_motions),
    )  # fmt: skip
    return _Answering(asked, watch, conditions, heading_of_run(structure) if asked.title is None else asked.title)


@dataclass(frozen=True)
class _Answering:
    """A question about a structure, and the conditions under which each motion is simulated."""

    asked: RespondAsked
    watch: Watcher
    conditions: Conditions
    title: str

    def answer(self, given: Scaled | None, title: str, files: RespondAsked) -> ResponseAnswer:
        """Simulate one motion, or a release alone, and write the files of its answer."""
        from rocking_cli.questions.respond import history_table
        from rocking_cli.views.engines import cost_in_words
        from rocking_cli.views.response import view

        conditions, asked, watch = self.conditions, self.asked, self.watch
        structure = conditions.structure
        count = conditions.around.count * len(conditions.signs)
        if count and given is not None and (cost := cost_in_words(conditions.by, structure, given.motion, count)):
            watch.note(cost)
        response = response_of(conditions, given, watch.working)
        if (fit := response.fit) is not None:
            watch.note(
                f"pulse: {fit.pulse.title}, a_p = {fit.pulse.amplitude / STANDARD_GRAVITY:.4g} g, "
                f"T_p = {fit.pulse.period:.4g} s, from {fit.start:.4g} s, sign {fit.sign:+d}: "
                f"{100 * fit.captured:.0f} % of the energy of the velocity"
            )
        doubts, linear = doubts_of(structure.mechanism), asked.model is not None
        shown = view(response, conditions, title, doubts, impacts=asked.impacts, linear=linear)
        wide = history_table.of_each_block if asked.each_block else history_table.wide
        long = history_table.long_of_each_block if asked.each_block else history_table.long
        under = ("pulse_alone",) * (asked.with_pulse is not None) + ("polarity",) * (len(conditions.signs) > 1)
        answer = ResponseAnswer(
            "response", response, shown, partial(long, response, structure), partial(self._figure, response, title),
            partial(wide, response, structure), {"impacts": partial(history_table.impacts, response)},
            [
                Dimensions((*under, "t"), GROUND),
                Dimensions((*under, "block" if asked.each_block else "model", "t")),
            ],
        )  # fmt: skip
        write_files(answer, files, watch)
        if files.animate is not None and given is not None:
            from rocking_cli.questions.animate.verb import FRAMES_PER_SECOND, write_film
            from rocking_cli.questions.respond.film import scene_of

            if why := _no_blocks_in_words(response):
                watch.note(f"animate: one degree of freedom alone, as {why}")
            scene = scene_of(structure, response)
            write_film(files.animate, scene, title, given.motion.name, None, FRAMES_PER_SECOND, watch)
        return answer

    def _figure(self, response: Response, title: str) -> Figure:
        from rocking_cli.names import peaks_over
        from rocking_cli.questions.respond.picture import draw_history
        from rocking_cli.views.conclusion import headline

        structure = self.conditions.structure
        contact = self.asked.contact or structure.mechanism.friction is not None
        first, *others = response.runs.values()
        fit, alone = response.fit, response.to_pulse
        pulse = (fit, alone) if fit is not None and alone is not None else None
        checked = list(response.contacts.values()) if contact else []
        over = peaks_over(next(iter(first.values())).ends_at_limit).replace("phi_cr", "φcr")
        title = f"{title} ({headline(response.conclusion, over)})"
        parted = [response.engines[sign].parted if sign in response.engines else nan for sign in response.runs]
        reversed_ = others[0] if others else None
        return draw_history(first, response.first, title, reversed_, pulse, structure, checked, parted)


def _no_blocks_in_words(response: Response) -> str:
    """Return why an animation has no free blocks, as a clause; empty if it has them."""
    sign = next(iter(response.runs))
    if sign in response.engines:
        return ""
    if not response["nonlinear"].unknown:
        return f"it tells the outcome, and free blocks were not requested ({named('engine')} blocks)"
    why = response.no_blocks.get(sign) or "free blocks do not go on"
    return f"{why}: {named('engine')} auto simulates them, or says why not"


def _of_several(run: _Answering, chosen: list[Scaled]) -> Answers[ResponseAnswer]:
    """Answer a question about several motions."""
    from rocking_cli.questions.respond.several import Several

    asked, motions = run.asked, run.asked.ground_motions
    if str(asked.out) == STANDARD_OUTPUT:
        raise InputError(Problem("- takes the table of a single motion: for several, give a file", field=named("out")))
    table = Several(run.conditions, motions.count, linear=asked.model is not None)
    details = list[Table | str]()
    read = [run.conditions.structure.file, *(record.path for record in motions.records)]
    outs, plots = places_of("out", asked.out, chosen, read), places_of("plot", asked.plot, chosen, read)

    def row(given: Scaled, k: int) -> ResponseAnswer:
        files = asked.model_copy(update={"out": outs[k], "plot": plots[k]})
        answer = run.answer(given, f"{run.title}, under {given.motion.name}", files)
        table.add(answer.result)
        details.extend(["", *answer.view.parts] if asked.impacts else [])
        return answer

    responses, left_out = ask_each(chosen, row, run.watch)
    unread = [record.path.name for record in motions.records if all(record is not each.record for each in chosen)]
    parts = [*table.parts([*unread, *left_out]), *details]
    return answers("responses", "motion", responses, parts, tables={"peaks": table.columns})


def usual_models(structure: Structure, watch: Watcher) -> tuple[ModelName, ...]:
    """Return the models that do not mislead for a structure, with a note on the others."""
    if len(structure.default_models) < len(MODELS):
        why = structure.why_no_block or structure.misleading or "the restitution is not known"
        watch.note(f"nonlinear history only: {why}")
    return structure.default_models
