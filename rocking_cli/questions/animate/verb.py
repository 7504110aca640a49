"""`rk.animate`: write an animation of structures under a ground motion."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Concatenate, NamedTuple, ParamSpec, Protocol, TypeVar, Unpack, cast, overload

import numpy as np

from rocking_cli.ask.answer import Answer, drawn
from rocking_cli.ask.given import StructureLike, around_of, models_of, structure_of, structures_of
from rocking_cli.ask.ground_motions import Motion, MotionArguments, Motions, signs_of
from rocking_cli.ask.numbers import refuse_idle, takes_numbers
from rocking_cli.ask.several import Answers, answers, are_several, ask_each, places_of
from rocking_cli.ask.watcher import SILENT, Watcher
from rocking_cli.errors import InputError, MechanismError, Problem, RockingError, of_structure
from rocking_cli.names import OPENING
from rocking_cli.processing.listed import Scaled
from rocking_cli.short_repr import short_repr
from rocking_cli.structure import Structure
from rocking_cli.studies.film import Film, Scene
from rocking_cli.studies.neighbours import Neighbourhood, Neighbours
from rocking_cli.text import in_short
from rocking_cli.views.view import heading

if TYPE_CHECKING:
    from rocking_cli.io.tables import Columns

MAX_DEFAULT_DURATION = 20.0  # s of a GIF whose speed is not given
MAX_FRAMES = 3000
FRAMES_PER_SECOND = 20.0
MAX_STRUCTURES = 6  # as many as there are colours of curves
ENDINGS = (".gif", ".mp4", ".html")
T = TypeVar("T", bound=Answer[Any])
P = ParamSpec("P")


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


class Animates(Protocol[P, T]):
    """Type of a verb like `UnderMotions`, which takes several structures under one motion as well."""

    @overload
    def __call__(  # type: ignore[overload-overlap]
        self, structure: StructureLike, motion: Motion, *args: P.args, **options: P.kwargs
    ) -> T: ...
    @overload
    def __call__(
        self, structure: StructureLike, motion: list[Any] | tuple[Any, ...], *args: P.args, **options: P.kwargs
    ) -> Answers[T]: ...
    @overload
    def __call__(
        self, structure: list[Any] | tuple[Any, ...], motion: Motion | Motions, *args: P.args, **options: P.kwargs
    ) -> Answers[T]: ...
    @overload
    def __call__(
        self, structure: StructureLike, motion: Motions, *args: P.args, **options: P.kwargs
    ) -> T | Answers[T]: ...


def _animates(verb: Callable[Concatenate[Any, Any, P], T | Answers[T]]) -> Animates[P, T]:
    """Return a verb unchanged; type checkers then see the type `Animates`."""
    return cast("Animates[P, T]", verb)


@_animates
@takes_numbers
def animate(
    structure: StructureLike | Sequence[StructureLike],
    motion: Motion | Motions | Sequence[Motion],
    file: str | Path,
    *,
    model: str = "nonlinear",
    polarity: str | int = "1",
    speed: float | None = None,
    fps: float = FRAMES_PER_SECOND,
    neighbours: int = Neighbourhood.count,
    amplitude_deviation: float = Neighbourhood.amplitude,
    slenderness_deviation: float | None = None,
    restitution_deviation: float | None = None,
    opening: float = OPENING,
    watch: Watcher = SILENT,
    **options: Unpack[MotionArguments],
) -> Answer[Animation] | Answers[Answer[Animation]]:
    """Animate structures under ground motions, as a GIF, as a video or as a page with a slider.

    Parameters
    ----------
    structure : Mechanism, str or Path, or a sequence of these
        The structure, or its YAML file; or several, which are shown side by side under one motion.
    motion : GroundMotion, Pulse, str or Path, or a sequence of these
        The motion, its file, or a pulse as text; a pattern such as `records/*.AT2`, or a sequence, gives several.
    file : str or Path
        File to write: .gif, .mp4 for a video (which requires ffmpeg), or .html for a page. Of several motions each has
        its own, with its name in the file name.
    model : str
        Model "nonlinear", "linear1" or "linear2".
    polarity : {"1", "-1"}
        Polarity of the motion: as given, or reversed.
    speed : float, optional
        Seconds of motion per second; by default 1, and for a GIF so many that it lasts at most 20 s.
    fps : float
        Frames per second of a GIF or a video.
    neighbours : int
        Number of neighbouring motions to simulate as well; 0 for none.
    amplitude_deviation, slenderness_deviation, restitution_deviation : float, optional
        Standard deviations of the neighbours: of ln amplitude, of ln slenderness and of restitution; by default those
        of the structure.
    opening : float
        Largest opening of a joint up to which a history is valid, over D_cr.
    watch : Watcher
        Told what was read and written, how far the work is, and which of several motions cannot be used.
    **options
        How the motion is read, corrected and scaled: see `rocking_cli.ask.ground_motions.MotionArguments`.

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
    ...     answer = rk.animate(rk.Block(width=0.7, height=2.8), "sine:0.3g:0.9s", f"{folder}/block.html")
    >>> f"{answer.film.history.peak_ratio:.4g}"
    '0.1315'
    """
    from rocking_cli.studies.contact import Contacts
    from rocking_cli.studies.engines import follow
    from rocking_cli.studies.neighbours import neighbours as outcomes
    from rocking_cli.studies.picture import picture
    from rocking_cli.views import animation as views

    path, (name,), signs = Path(file), models_of(model), signs_of(polarity)
    check_film(path, signs, speed, fps)
    around = around_of(neighbours, amplitude_deviation, restitution_deviation, slenderness_deviation)
    if name != "nonlinear":
        refuse_idle("on a linear block, which has no joints", opening=opening != OPENING)
    if path.suffix.lower() == ".html":
        refuse_idle("on a page, which is drawn as fast as it is shown", fps=fps != FRAMES_PER_SECOND)
    motions = Motions.of(motion, options)

    def shot(ready: Structure, given: Scaled) -> Animation:
        scaled = given.motion.scaled(signs[0] * given.factor)
        history = follow(ready, scaled, model=name)
        assumed = Contacts(ready.mechanism).check(history, scaled).assumed_friction if name == "nonlinear" else None
        neighbourhood = outcomes(ready.model(name), scaled, around) if neighbours else None
        return Animation(Film(picture(ready.mechanism), history, scaled, assumed), neighbourhood)

    def of(ready: Structure, made: Animation, scene: Scene, file: _Written) -> Answer[Animation]:
        film, history = made.film, made.film.history
        shown = views.view(ready, film, scene, made.neighbours, file._asdict())
        figure = drawn(
            "questions.respond.picture.draw_history",
            {history.model: history},
            film.motion,
            heading(ready.mechanism),
            structure=ready,
        )
        return Answer("animation", made, shown, partial(_columns, film), figure)

    def beside(many: Sequence[StructureLike]) -> Answers[Answer[Animation]]:
        """Animate several structures in one file."""
        if not 0 < len(many) <= MAX_STRUCTURES:
            raise InputError(Problem(f"takes 1 to {MAX_STRUCTURES} structures, got {len(many)}", field="`structure`"))
        usable = structures_of(many, watch, opening)
        fastest = max(usable, key=lambda each: each.growth)
        given, *others = motions.gather(fastest.growth, watch, fastest.name)
        if others:
            what = f"several structures are animated under one motion, and {1 + len(others)} are given"
            raise InputError(Problem(what, field="`motion`", hint="give one, or call this once for each motion"))
        made, refused = dict[str, Animation](), list[RockingError]()
        for ready in usable:
            try:
                made[ready.name] = shot(ready, given)
            except RockingError as error:
                refused.append(of_structure(error, ready.name) if isinstance(error, MechanismError) else error)
                if len(refused) == len(usable):
                    raise
        for each in refused:
            watch.leave_out(each)
        scene = Scene(tuple(each.film for each in made.values()))
        under = scene.films[0].motion.name
        written = write_film(path, scene, in_short(list(made), most=MAX_STRUCTURES), under, speed, fps, watch)
        shown = [ready for ready in usable if ready.name in made]
        by_name = {ready.name: of(ready, made[ready.name], scene, written) for ready in shown}
        for answer in by_name.values():
            watch.take(answer)
        rows = [views.row(key, each.film, each.neighbours) for key, each in made.items()]
        notes = [f"{ready.name}: {note}" for ready in shown for note in views.notes(ready, made[ready.name].film)]
        table = views.several(f"under {under}", "structure", name, rows, [views.scale_in_words(scene), *notes])
        return answers("animations", "structure", by_name, table.parts)

    if isinstance(structure, list | tuple):
        return beside(structure)
    ready = structure_of(cast("StructureLike", structure), watch, opening)
    chosen = motions.gather(ready.growth, watch)

    def one(given: Scaled, place: Path) -> Answer[Animation]:
        made = shot(ready, given)
        scene, title = Scene((made.film,)), heading(ready.mechanism)
        return of(ready, made, scene, write_film(place, scene, title, made.film.motion.name, speed, fps, watch))

    if not are_several(motion, motions):
        return one(chosen[0], path)
    rows, last = list[views.FilmRow](), list[Film]()
    places = places_of("file", path, chosen, [ready.file, *(each.path for each in motions.records)])

    def row(given: Scaled, k: int) -> Answer[Animation]:
        answer = one(given, places[k] or path)
        rows.append(views.row(answer.film.motion.name, answer.film, answer.neighbours))
        last[:] = [answer.film]
        return answer

    responses, _ = ask_each(chosen, row, watch)
    table = views.several(heading(ready.mechanism), "under", name, rows, views.notes(ready, last[0]))
    return answers("animations", "motion", responses, table.parts)


def check_film(file: Path, signs: tuple[int, ...], speed: float | None, fps: float) -> None:
    """Raise `InputError` if an animation cannot be written, or be shown like this."""
    from rocking_cli.io.files import check_writable

    check_writable(file, *ENDINGS)
    if file.suffix.lower() == ".mp4":
        from rocking_cli.questions.animate.video import ffmpeg

        ffmpeg(file)
    if len(signs) > 1:
        raise InputError(Problem("must be 1 or -1: one motion is shown", field="`polarity`"))
    if speed is not None and not 1e-3 <= speed <= 1e3:
        what = f"{speed:g} is not between 0.001 and 1000 s of motion per second"
        raise InputError(Problem(what, field="`speed`"))
    if not 1 <= fps <= 50:
        raise InputError(Problem(f"{fps:g} is not between 1 and 50, the range of a GIF", field="`fps`"))


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
        raise InputError(Problem(problem, field="`speed`", hint="raise `speed`, lower `fps`, or write .html"))
    times = np.append(scene.start + step * np.arange(count), scene.end)
    if pace != 1:
        watch.note(f"shown at {pace:.3g} times its speed, from {scene.start:.4g} to {scene.end:.4g} s")
    with watch.progress(times.size, "frames") as advance:
        frames = picture.frames(scene, f"{title}, under {under}", times, advance)
        if ending == ".gif":
            write_whole(file, lambda stream: picture.write_gif(stream, frames, times.size, fps))
        else:
            from rocking_cli.questions.animate.video import ffmpeg, write_mp4

            program = ffmpeg(file)
            write_whole(file, lambda stream: write_mp4(stream, program, frames, fps))
    watch.note(f"wrote {file}")
    return _Written(pace, int(times.size), str(file))


def _columns(film: Film) -> Columns:
    return {"time": film.history.time, "phi": film.history.phi}
