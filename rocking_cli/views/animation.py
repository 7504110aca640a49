"""An animated motion, as people and programs read it."""

from __future__ import annotations

from collections.abc import Mapping

from rocking_cli.dynamics.prepared import Prepared
from rocking_cli.studies.film import Film
from rocking_cli.studies.neighbours import Neighbours
from rocking_cli.views.response import ending, neighbours_data
from rocking_cli.views.restitution import restitution_data, restitution_used
from rocking_cli.views.view import View


def view(
    structure: Prepared,
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
        "restitution": restitution_data(structure),
        "neighbours": neighbours_data(near) if near is not None else None,
        "verdict": film.verdict,
        "start": film.start,
        "end": film.end,
        **file,
    }
    said = [film.verdict, *([str(near)] if near is not None else []), restitution_used(structure)]
    return View(data, said)
