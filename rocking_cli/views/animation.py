"""View of an animated motion, as text and as data."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from rocking_cli.names import UNKNOWN, peaks_over
from rocking_cli.structure import Structure
from rocking_cli.studies.film import SLOWEST_GROUND, Film, Scene
from rocking_cli.studies.neighbours import Neighbours
from rocking_cli.studies.response import concluded
from rocking_cli.views.column import Column, of, only_shown, table_of
from rocking_cli.views.conclusion import headline
from rocking_cli.views.neighbours import neighbour_columns, neighbours_data, neighbours_in_words
from rocking_cli.views.response import ending, known_data, not_checked
from rocking_cli.views.restitution import restitution_data, restitution_used
from rocking_cli.views.verdict import verdict, why_unknown
from rocking_cli.views.view import View


def view(
    structure: Structure,
    film: Film,
    scene: Scene,
    near: Neighbours | None,
    file: Mapping[str, float | int | str | None],
) -> View:
    """Show an animated history: its verdict, its neighbouring motions, how it is drawn and the file written."""
    history, mechanism = film.history, structure.mechanism
    data = {
        "mechanism": mechanism.mechanism,
        "name": mechanism.name,
        "record": film.motion.name,
        "model": history.model,
        "outcome": ending(history),
        "peak_ratio": history.peak_ratio,
        **known_data(history),
        "restitution": restitution_data(structure),
        "neighbours": neighbours_data(near) if near is not None else None,
        "verdict": verdict_of(film),
        "start": scene.start,
        "end": scene.end,
        "enlargement": scene.enlargement,
        "ground_enlargement": scene.ground_enlargement,
        **file,
    }
    neighbours = neighbours_in_words(near) if near is not None else ""
    sentences = [verdict_of(film), why_it_ends(film), neighbours, *notes(structure, film), scale_in_words(scene)]
    return View(data, [*filter(None, sentences)])


def notes(structure: Structure, film: Film) -> list[str]:
    """Return sentences on what the history of a structure rests on: its restitution, and joints not checked."""
    return [restitution_used(structure), *not_checked(structure.mechanism, [film.history])]


class FilmRow(NamedTuple):
    """The row of one of several motions or structures: its name, the outcome in words, and its neighbours."""

    name: str
    fate: str
    near: Neighbours | None


def row(name: str, film: Film, near: Neighbours | None) -> FilmRow:
    """Return the row of one of several motions or structures."""
    run = film.history
    fate = f"{UNKNOWN} after {run.known_to:.4g} s, as {why_unknown(run)}" if run.unknown else verdict_of(film)
    return FilmRow(name, fate, near)


def several(title: str, first: str, model: str, rows: Sequence[FilmRow], below: Sequence[str]) -> View:
    """Show the outcomes of several motions or structures by their rows, and then some sentences.

    Parameters
    ----------
    title : str
        Heading: what is the same in all rows.
    first : str
        Heading of the names.
    model : str
        Heading of the outcomes.
    rows : sequence of FilmRow
        The rows.
    below : sequence of str
        Sentences below the table.
    """
    columns: list[Column[FilmRow]] = [
        only_shown(first, of("name"), text=True),
        only_shown(model, of("fate"), text=True),
        *neighbour_columns(of("near"), doubtful=any(row.near is not None and row.near.unknown for row in rows))[:2],
    ]
    return View({}, [table_of(title, columns, rows), *below])


def verdict_of(film: Film) -> str:
    """Return the outcome of an animated history in words."""
    return verdict({film.history.model: film.history}, {}, film.assumed_friction)


def why_it_ends(film: Film) -> str:
    """Return a note on why an animation ends before the ground motion does; empty if the outcome is known."""
    if not film.history.unknown:
        return ""
    return f"The film ends at {film.history.known_to:.4g} s, up to which the outcome is known."


def fate(film: Film) -> str:
    """Return the outcome in a few words, to be written beside a structure."""
    end = concluded({1: {film.history.model: film.history}}, {})
    return headline(end, peaks_over(film.history.ends_at_limit).replace("phi_cr", "φcr"))


def scale_in_words(scene: Scene) -> str:
    """Return how many times displacements are enlarged in a drawing that moves, those of the ground included."""
    times, ground = scene.enlargement, scene.ground_enlargement
    of_ground = "too" if times == ground else f"are {_scale(ground)}"
    return f"Displacements are {_scale(times)}, and those of the ground {of_ground}."


def _scale(times: float) -> str:
    if times == 1:
        return "to scale"
    return f"enlarged {times:g} times" if times > 1 else f"reduced {1 / times:g} times"


def drawing_in_words(scene: Scene) -> str:
    """Return what a drawing to another scale leaves as it is, and where the displacement of its ground comes from."""
    numbers = "" if scene.enlargement == 1 else "Numbers are not enlarged."
    drift = (
        "For this drawing alone, the displacement of the ground is its acceleration integrated twice, without periods "
        f"above {1 / SLOWEST_GROUND:g} s."
    )
    return " ".join(filter(None, [numbers, drift if scene.is_filtered else ""]))
