"""`rk.animate`: write an animation of structures under a ground motion."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from rocking_cli.ask.answer import Answer, Answers, drawn
from rocking_cli.ask.inputs import StructureLike, structure_of, structures_of
from rocking_cli.ask.verbs import answers, are_several, ask_each, places_of, verb
from rocking_cli.ask.watcher import Watcher
from rocking_cli.errors import InputError, MechanismError, Problem, RockingError, named, of_structure
from rocking_cli.processing.reading import Scaled
from rocking_cli.questions.animate.asked import AnimateAsked
from rocking_cli.short_repr import short_repr
from rocking_cli.structure import Structure
from rocking_cli.studies.film import Film, Scene
from rocking_cli.studies.neighbours import Neighbours
from rocking_cli.text import in_short
from rocking_cli.views import animation as views
from rocking_cli.views.view import heading

if TYPE_CHECKING:
    from rocking_cli.io.tables import Columns

MAX_DEFAULT_DURATION = 20.0  # s of a GIF whose speed is not given
MAX_FRAMES = 3000
FRAMES_PER_SECOND = 20.0
MAX_STRUCTURES = 6  # as many as there are colours of curves


@short_repr
@dataclass(frozen=True, eq=False)
class Animation:
    """A motion of a structure that was animated.

    Parameters
    ----------
    film : Film
        The motion as it is shown.
    neighbours : Neighbours or None
        Outcomes of the neighbours of the motion; None without any.
    """

    film: Film
    neighbours: Neighbours | None


@verb(AnimateAsked)
def animate(asked: AnimateAsked, watch: Watcher) -> Answer[Animation] | Answers[Answer[Animation]]:
    """Animate structures under ground motions, as a GIF, as a video or as a page with a slider.

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
    check_program(asked.out)
    structures: Any = asked.structures
    if isinstance(structures, list | tuple):
        return _side_by_side(asked, watch, structures)
    ready = structure_of(structures, watch, asked.opening)
    motions = asked.ground_motions
    chosen = motions.gather(ready.growth, watch)
    if not are_several(asked.motions, motions):
        return _alone(asked, watch, ready, chosen[0], asked.out)
    places = places_of("out", asked.out, chosen, [ready.file, *(record.path for record in motions.records)])
    rows, films = list[views.FilmRow](), list[Film]()

    def filmed(given: Scaled, k: int) -> Answer[Animation]:
        answer = _alone(asked, watch, ready, given, places[k] or asked.out)
        rows.append(views.row(answer.film.motion.name, answer.film, answer.neighbours))
        films.append(answer.film)
        return answer

    responses, _ = ask_each(chosen, filmed, watch)
    table = views.several(heading(ready.mechanism), "under", asked.model, rows, views.notes(ready, films[-1]))
    return answers("animations", "motion", responses, table.parts)


def _shot(asked: AnimateAsked, ready: Structure, given: Scaled) -> Animation:
    """Return the motion of a structure under a ground motion, and the outcomes of its neighbours."""
    from rocking_cli.studies.contact import Contacts
    from rocking_cli.studies.engines import follow
    from rocking_cli.studies.neighbours import Conditions, neighbours
    from rocking_cli.studies.picture import picture

    (sign,), around = asked.signs, asked.neighbourhood(asked.neighbours)
    scaled = given.motion.scaled(sign * given.factor)
    history = follow(ready, scaled, model=asked.model)
    nonlinear = asked.model == "nonlinear"
    assumed = Contacts(ready.mechanism).check(history, scaled).assumed_friction if nonlinear else None
    outcomes = neighbours(Conditions(ready, [asked.model], around=around), scaled) if around.count else None
    return Animation(Film(picture(ready.mechanism), history, scaled, assumed), outcomes)


def _answer(ready: Structure, made: Animation, scene: Scene, file: _Written) -> Answer[Animation]:
    film, history = made.film, made.film.history
    shown = views.view(ready, film, scene, made.neighbours, file._asdict())
    title, histories = heading(ready.mechanism), {history.model: history}
    figure = drawn("questions.respond.picture.draw_history", histories, film.motion, title, structure=ready)
    return Answer("animation", made, shown, partial(_columns, film), figure)


def _alone(asked: AnimateAsked, watch: Watcher, ready: Structure, given: Scaled, place: Path) -> Answer[Animation]:
    """Animate a structure under one motion."""
    made = _shot(asked, ready, given)
    scene, under = Scene((made.film,)), made.film.motion.name
    file = write_film(place, scene, heading(ready.mechanism), under, asked.speed, asked.fps, watch)
    return _answer(ready, made, scene, file)


def _side_by_side(asked: AnimateAsked, watch: Watcher, many: Sequence[StructureLike]) -> Answers[Answer[Animation]]:
    """Animate several structures in one file."""
    if not 0 < len(many) <= MAX_STRUCTURES:
        raise InputError(Problem(f"takes 1 to {MAX_STRUCTURES} structures, got {len(many)}", field=named("structures")))
    usable = structures_of(many, watch, asked.opening)
    fastest = max(usable, key=lambda ready: ready.growth)
    given, *others = asked.ground_motions.gather(fastest.growth, watch, fastest.name)
    if others:
        what = f"several structures are animated under one motion, and {1 + len(others)} are given"
        raise InputError(Problem(what, field=named("motions"), hint="give one, or ask once for each motion"))
    made, refused = dict[str, Animation](), list[RockingError]()
    for ready in usable:
        try:
            made[ready.name] = _shot(asked, ready, given)
        except RockingError as error:
            refused.append(of_structure(error, ready.name) if isinstance(error, MechanismError) else error)
            if len(refused) == len(usable):
                raise
    for problem in refused:
        watch.leave_out(problem)
    scene = Scene(tuple(shot.film for shot in made.values()))
    under, title = scene.films[0].motion.name, in_short(list(made), most=MAX_STRUCTURES)
    written = write_film(asked.out, scene, title, under, asked.speed, asked.fps, watch)
    shown = [ready for ready in usable if ready.name in made]
    by_name = {ready.name: _answer(ready, made[ready.name], scene, written) for ready in shown}
    for answer in by_name.values():
        watch.take(answer)
    rows = [views.row(name, shot.film, shot.neighbours) for name, shot in made.items()]
    notes = [f"{ready.name}: {note}" for ready in shown for note in views.notes(ready, made[ready.name].film)]
    table = views.several(f"under {under}", "structure", asked.model, rows, [views.scale_in_words(scene), *notes])
    return answers("animations", "structure", by_name, table.parts)


def check_program(file: Path | None) -> None:
    """Raise `InputError` if a video is requested and the program that makes it is missing."""
    if file is not None and file.suffix.lower() == ".mp4":
        from rocking_cli.questions.animate.picture import ffmpeg

        ffmpeg(file)


class _Written(NamedTuple):
    """A file that was written: its speed, and its number of frames; None for a page."""

    speed: float
    frames: int | None
    file: str


def write_film(
    file: Path, scene: Scene, title: str, under: str, speed: float | None, fps: float, watch: Watcher
) -> _Written:  # fmt: skip
    """Write films as an animation; a speed of None is 1, or for a GIF so fast that it lasts `MAX_DEFAULT_DURATION`."""
    from rocking_cli.io.files import write_whole
    from rocking_cli.questions.animate import picture

    ending = file.suffix.lower()
    if ending == ".html":
        page = picture.animation_page(scene.films, title, speed or 1.0).encode()
        write_whole(file, lambda stream: stream.write(page))
        watch.note(f"wrote {file}")
        return _Written(speed or 1.0, None, str(file))
    fastest = (scene.end - scene.start) / MAX_DEFAULT_DURATION if ending == ".gif" else 1.0
    pace = speed or max(1.0, fastest)
    step = pace * (picture.frame_time(fps) if ending == ".gif" else 1 / fps)
    count = int((scene.end - scene.start) / step) + 1
    if count > MAX_FRAMES:
        problem = f"an animation of {count:,} frames is too long (at most {MAX_FRAMES:,})"
        raise InputError(
            Problem(problem, field=named("speed"), hint=f"raise {named('speed')}, lower {named('fps')}, or write .html")
        )
    times = np.append(scene.start + step * np.arange(count), scene.end)
    if pace != 1:
        watch.note(f"shown at {pace:.3g} times its speed, from {scene.start:.4g} to {scene.end:.4g} s")
    with watch.progress(times.size, "frames") as advance:
        frames = picture.frames(scene, f"{title}, under {under}", times, advance)
        if ending == ".gif":
            write_whole(file, lambda stream: picture.write_gif(stream, frames, times.size, fps))
        else:
            program = picture.ffmpeg(file)
            write_whole(file, lambda stream: picture.write_mp4(stream, program, frames, fps))
    watch.note(f"wrote {file}")
    return _Written(pace, int(times.size), str(file))


def _columns(film: Film) -> Columns:
    return {"t [s]": film.history.time, "phi [rad]": film.history.phi}
