"""An animated motion, as people and programs read it."""

from __future__ import annotations

from collections.abc import Mapping

from rocking_cli.core import Equivalence, Mechanism
from rocking_cli.studies.film import Film
from rocking_cli.studies.neighbours import Neighbours
from rocking_cli.views.response import ending, neighbours_data, restitution_data, restitution_used
from rocking_cli.views.view import View


def view(
    mechanism: Mechanism,
    blocks: Equivalence,
    film: Film,
    near: Neighbours | None,
    file: Mapping[str, float | int | str | None],
) -> View:
    """What is shown, what became of the motions next to it, and of the file that shows it."""
    history = film.history
    data = {
        "mechanism": mechanism.mechanism,
        "name": mechanism.name,
        "record": film.motion.name,
        "model": history.model,
        "outcome": ending(history),
        "peak_ratio": history.peak_ratio,
        "restitution": restitution_data(mechanism, blocks),
        "neighbours": neighbours_data(near) if near is not None else None,
        "verdict": film.verdict,
        "start": film.start,
        "end": film.end,
        **file,
    }
    said = [film.verdict, *([str(near)] if near is not None else []), restitution_used(mechanism, blocks)]
    return View(data, said)
