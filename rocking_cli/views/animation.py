"""View of an animated motion, as text and as data."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from rocking_cli.names import UNKNOWN
from rocking_cli.structure import Structure
from rocking_cli.studies.film import Film
from rocking_cli.studies.neighbours import Neighbours
from rocking_cli.views.column import Column, of, only_shown, table_of
from rocking_cli.views.neighbours import neighbour_columns, neighbours_data, neighbours_in_words
from rocking_cli.views.response import ending, known_data, not_checked
from rocking_cli.views.restitution import restitution_data, restitution_used
from rocking_cli.views.verdict import verdict, why_unknown
from rocking_cli.views.view import View, heading


def view(
    structure: Structure,
    film: Film,
    near: Neighbours | None,
    file: Mapping[str, float | int | str | None],
) -> View:
    """Show an animated history: its verdict, its neighbouring motions and the file written."""
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
        "start": film.start,
        "end": film.end,
        **file,
    }
    neighbours = neighbours_in_words(near) if near is not None else ""
    sentences = [verdict_of(film), why_it_ends(film), neighbours, restitution_used(structure)]
    return View(data, [*filter(None, sentences), *not_checked(structure.mechanism, [history])])


class FilmRow(NamedTuple):
    """The row of one of several motions: its name, the outcome in words, and its neighbours."""

    name: str
    fate: str
    near: Neighbours | None


def row(film: Film, near: Neighbours | None) -> FilmRow:
    """Return the row of one of several motions."""
    run = film.history
    fate = f"{UNKNOWN} after {run.known_to:.4g} s, as {why_unknown(run)}" if run.unknown else verdict_of(film)
    return FilmRow(film.motion.name, fate, near)


def several(structure: Structure, film: Film, rows: Sequence[FilmRow]) -> View:
    """Show the outcomes of several motions by their rows; `film` is one of them."""
    columns: list[Column[FilmRow]] = [
        only_shown("under", of("name"), text=True),
        only_shown(film.history.model, of("fate"), text=True),
        *neighbour_columns(of("near"), doubtful=any(row.near is not None and row.near.unknown for row in rows))[:2],
    ]
    table = table_of(heading(structure.mechanism), columns, rows)
    return View({}, [table, restitution_used(structure), *not_checked(structure.mechanism, [film.history])])


def verdict_of(film: Film) -> str:
    """Return the outcome of an animated history in words."""
    return verdict({film.history.model: film.history}, {}, film.assumed_friction)


def why_it_ends(film: Film) -> str:
    """Return a note on why an animation ends before the ground motion does; empty if the outcome is known."""
    if not film.history.unknown:
        return ""
    return f"The film ends at {film.history.known_to:.4g} s, up to which the outcome is known."
