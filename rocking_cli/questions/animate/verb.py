"""`rk.animate`: write an animation of a structure under a ground motion."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Unpack

import numpy as np

from rocking_cli.ask.answer import Answer, drawn
from rocking_cli.ask.given import StructureLike, around_of, models_of, structure_of
from rocking_cli.ask.ground_motions import Motion, MotionArguments, Motions, signs_of
from rocking_cli.ask.numbers import refuse_idle, takes_numbers
from rocking_cli.ask.several import Answers, answers, are_several, ask_each, places_of, under_motions
from rocking_cli.ask.watcher import SILENT, Watcher
from rocking_cli.errors import InputError, Problem
from rocking_cli.names import OPENING
from rocking_cli.processing.listed import Scaled
from rocking_cli.short_repr import short_repr
from rocking_cli.studies.film import Film
from rocking_cli.studies.neighbours import Neighbourhood, Neighbours
from rocking_cli.views.view import heading

if TYPE_CHECKING:
    from rocking_cli.io.tables import Columns

MAX_DEFAULT_DURATION = 20.0  # s of a GIF whose speed is not given
MAX_FRAMES = 3000
FRAMES_PER_SECOND = 20.0


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


@under_motions
@takes_numbers
def animate(
    structure: StructureLike,
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
    """Animate a structure under ground motions, as a GIF or as a page with a slider.

    Parameters
    ----------
    structure : Mechanism, str or Path
        The structure, or its YAML file.
    motion : GroundMotion, Pulse, str or Path, or a sequence of these
        The motion, its file, or a pulse as text; a pattern such as `records/*.AT2`, or a sequence, gives several.
    file : str or Path
        File to write: .gif, or .html for a page. Of several motions each has its own, with its name in the file name.
    model : str
        Model "nonlinear", "linear1" or "linear2".
    polarity : {"1", "-1"}
        Polarity of the motion: as given, or reversed.
    speed : float, optional
        Seconds of motion per second; by default 1, and for a GIF so many that it lasts at most 20 s.
    fps : float
        Frames per second of a GIF.
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
        several motions, `Answers` with one for each, by its name.

    Raises
    ------
    InputError
        If a value is out of range, a file cannot be read or written, or a GIF would be too long.
    MechanismError
        If the structure has no critical rotation or no uplift acceleration.
    SolverError
        If the motion cannot be simulated to its end.

    Notes
    -----
    The models are those of `respond`.

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
    _check(path, signs, speed, fps)
    around = around_of(neighbours, amplitude_deviation, restitution_deviation, slenderness_deviation)
    if name != "nonlinear":
        refuse_idle("on a linear block, which has no joints", opening=opening != OPENING)
    if path.suffix.lower() == ".html":
        refuse_idle("on a page, which is drawn as fast as it is shown", fps=fps != FRAMES_PER_SECOND)
    ready = structure_of(structure, watch, opening)
    model_of_structure = ready.model(name)
    motions = Motions.of(motion, options)
    chosen = motions.gather(ready.growth, watch)
    several = are_several(motion, motions)

    def one(given: Scaled, place: Path) -> Answer[Animation]:
        scaled = given.motion.scaled(signs[0] * given.factor)
        history = follow(ready, scaled, model=name)
        assumed = Contacts(ready.mechanism).check(history, scaled).assumed_friction if name == "nonlinear" else None
        film = Film(picture(ready.mechanism), history, scaled, assumed)
        if place.suffix.lower() == ".html":
            pace, frames = speed or 1.0, None
            _write_page(place, film, heading(ready.mechanism), pace)
        else:
            pace = speed or max(1.0, (film.end - film.start) / MAX_DEFAULT_DURATION)
            frames = _write_gif(place, film, f"{heading(ready.mechanism)}, under {scaled.name}", pace, fps, watch)
        watch.note(f"wrote {place}")
        neighbourhood = outcomes(model_of_structure, scaled, around) if neighbours else None
        shown = views.view(ready, film, neighbourhood, {"speed": pace, "frames": frames, "file": str(place)})
        figure = drawn(
            "questions.respond.picture.draw_history",
            {history.model: history},
            scaled,
            heading(ready.mechanism),
            structure=ready,
        )
        return Answer("animation", Animation(film, neighbourhood), shown, partial(_columns, film), figure)

    if not several:
        return one(chosen[0], path)
    rows, films = list[views.FilmRow](), list[Film]()
    places = places_of("file", path, chosen, [ready.file, *(each.path for each in motions.records)])

    def row(given: Scaled, k: int) -> Answer[Animation]:
        answer = one(given, places[k] or path)
        rows.append(views.row(answer.film, answer.neighbours))
        films[:] = [answer.film]
        return answer

    responses, _ = ask_each(chosen, row, watch)
    return answers("animations", "motion", responses, views.several(ready, films[0], rows).parts)


def _check(file: Path, signs: tuple[int, ...], speed: float | None, fps: float) -> None:
    """Raise `InputError` if an animation cannot be written, or be shown like this."""
    from rocking_cli.io.files import check_writable

    if file.suffix.lower() not in (".gif", ".html"):
        raise InputError(Problem("give a file name that ends in .gif or .html", str(file)))
    check_writable(file)
    if len(signs) > 1:
        raise InputError(Problem("must be 1 or -1: one motion is shown", field="`polarity`"))
    if speed is not None and not 1e-3 <= speed <= 1e3:
        what = f"{speed:g} is not between 0.001 and 1000 s of motion per second"
        raise InputError(Problem(what, field="`speed`"))
    if not 1 <= fps <= 50:
        raise InputError(Problem(f"{fps:g} is not between 1 and 50, the range of a GIF", field="`fps`"))


def _write_page(file: Path, film: Film, title: str, speed: float) -> None:
    from rocking_cli.io.files import write_whole
    from rocking_cli.questions.animate.picture import animation_page

    page = animation_page(film, title, speed).encode()
    write_whole(file, lambda stream: stream.write(page))


def _write_gif(file: Path, film: Film, title: str, speed: float, fps: float, watch: Watcher) -> int:
    """Write the GIF, and return its number of frames."""
    from rocking_cli.io.files import write_whole
    from rocking_cli.questions.animate.picture import frame_time, write_gif

    step = speed * frame_time(fps)
    count = int((film.end - film.start) / step) + 1
    if count > MAX_FRAMES:
        problem = f"a GIF of {count:,} frames is too long (at most {MAX_FRAMES:,})"
        raise InputError(Problem(problem, field="`speed`", hint="raise `speed`, lower `fps`, or write .html"))
    times = np.append(film.start + step * np.arange(count), film.end)
    if speed != 1:
        watch.note(f"shown at {speed:.3g} times its speed, from {film.start:.4g} to {film.end:.4g} s")
    with watch.progress(times.size, "frames") as advance:
        write_whole(file, lambda stream: write_gif(stream, film, title, times, fps, advance))
    return int(times.size)


def _columns(film: Film) -> Columns:
    return {"time": film.history.time, "phi": film.history.phi}
