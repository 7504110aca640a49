"""Responses to one ground motion or several, as people and programs read them, and the files they are written to."""

from __future__ import annotations

from collections.abc import Sequence
from math import isinf
from pathlib import Path
from typing import Any

from rocking_cli import names
from rocking_cli.cli import responses, structures, terminal
from rocking_cli.cli.answers import Answer, Question
from rocking_cli.cli.pictures import write_picture
from rocking_cli.core import Equivalence, Mechanism
from rocking_cli.dynamics.history import History
from rocking_cli.dynamics.model import ModelName
from rocking_cli.dynamics.vertical import vertical_notes
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.names import percent
from rocking_cli.studies.neighbours import Around, Neighbours, Severity, governing, severity
from rocking_cli.views.view import ABSENT, heading


def write(found: Answer, out: Path | None, plot: Path | None, title: str) -> None:
    """Write the histories and their picture to the files asked for.

    In a table those of the second polarity, or to the pulse alone, stand last, under names that say so.
    """
    first, *others = found.runs.values()
    if out is not None:
        from rocking_cli.io.tables import write_table
        from rocking_cli.views import history_table

        columns: dict[str, History] = dict(first.items())
        columns |= {f"reversed {name}": run for other in others for name, run in other.items()}
        columns |= {f"pulse {name}": run for name, run in (found.to_pulse or {}).items()}
        write_table(out, history_table.blocks(columns, found.first))
        terminal.note(f"wrote {out}")
    if plot is not None:
        from rocking_cli.plotting.history import draw_history

        pulse = (found.fit, found.to_pulse) if found.fit is not None and found.to_pulse is not None else None
        write_picture(plot, draw_history(first, found.first, title, others[0] if others else None, pulse))


def as_json(
    found: Answer, mechanism: Mechanism, blocks: Equivalence, asked: Question, polarity: str, *, impacts: bool
) -> dict[str, Any]:
    """The object of one motion, with every impact if that is asked for."""
    given, etas = found.given, blocks if impacts else None
    said: dict[str, Any] = {
        "structure": {"mechanism": mechanism.mechanism, "name": mechanism.name},
        "record": responses.record_json(given.motion, given.factor, polarity, given.pulse) if given else None,
        "release": asked.release,
        "restitution": responses.restitution_json(mechanism, blocks),
        **responses.runs_json(found.runs, found.neighbours, etas),
    }
    if found.fit is not None and found.to_pulse is not None:
        from rocking_cli.cli.pulse_fits import fit_json

        said |= {"pulse": fit_json(found.fit), "pulse_responses": responses.histories_json(found.to_pulse, etas)}
    return {**said, "notes": [*structures.doubts(mechanism), *_notes(found, mechanism)]}


def _notes(found: Answer, mechanism: Mechanism) -> list[str]:
    return vertical_notes(found.first, mechanism.gravity) if found.first is not None else []


def print_one(found: Answer, mechanism: Mechanism, blocks: Equivalence, title: str, *, impacts: bool) -> None:
    """Tables and sentences on one motion, with the first impacts if they are asked for."""
    etas = blocks if impacts else None
    if found.to_pulse is None:
        responses.print_tables(title, found.runs, found.neighbours, etas)
    else:
        responses.print_tables(f"{title}, under the record", found.runs, found.neighbours, etas)
        terminal.result()
        responses.print_tables(f"{title}, under its pulse alone", {1: found.to_pulse}, {}, etas)
        terminal.result(responses.share_of_pulse(next(iter(found.runs.values())), found.to_pulse))
    terminal.result(responses.restitution_used(mechanism, blocks))
    for note in _notes(found, mechanism):
        terminal.result(note)


class Several:
    """The table of several motions, a row each; of a motion no more than its row is kept.

    Parameters
    ----------
    mechanism, blocks : Mechanism, Equivalence
        What is shaken, and its equivalent blocks.
    models : tuple of str
        The models followed.
    """

    def __init__(self, mechanism: Mechanism, blocks: Equivalence, models: Sequence[ModelName]) -> None:
        self._title = heading(mechanism)
        self._restitution = responses.restitution_used(mechanism, blocks)
        self._models = models
        self._best: ModelName = "nonlinear" if "nonlinear" in models else models[0]
        self._rows: list[list[str]] = []
        self._worst: dict[str, Severity] = {}
        self._fallen = 0
        self._around: Around | None = None

    def add(self, found: Answer) -> None:
        """Take up what became of it under one motion."""
        assert found.given is not None
        pga = f"{abs(found.given.factor) * found.given.motion.pga:.4g}"
        severities = []
        for sign, histories in found.runs.items():
            reversed_ = ", reversed" if sign < 0 and len(found.runs) > 1 else ""
            near = found.neighbours.get(sign)
            self._row(f"{found.given.motion.name}{reversed_}", pga, histories, near)
            severities.append(severity(histories[self._best], near))
            self._around = near.around if near is not None else None
        if found.fit is not None and found.to_pulse is not None:
            own = found.fit.pulse
            self._row(f"  its {own.name} pulse alone", f"{own.amplitude / STANDARD_GRAVITY:.4g}", found.to_pulse, None)
        self._worst[found.given.motion.name] = max(severities)
        self._fallen += any(histories[self._best].overturned for histories in found.runs.values())

    def _row(self, what: str, pga: str, histories: responses.Histories, near: Neighbours | None) -> None:
        around = [percent(near.overturned), _peak(near.peak_ratio[1])] if near is not None else [ABSENT] * 2
        self._rows.append([what, pga, *(_fate(histories[name]) for name in self._models), *around])

    def print(self) -> None:
        """The table, how many motions overturn it, and which governs."""
        heads = ["peak phi/phi_cr\nunder", "PGA\n[g]", *self._models]
        rows = self._rows
        if self._around is not None:
            heads += ["neighbours\noverturn", "their\nmedian"]
        else:
            rows = [row[:-2] for row in rows]
        terminal.table(self._title, heads, rows, numbers=range(1, len(heads)))
        fallen = f"{self._fallen} of {len(self._worst)} motions overturn it" if self._fallen else ""
        terminal.result(f"By the {self._best} model {fallen or f'none of {len(self._worst)} motions overturns it'}.")
        if self._around is not None:
            near, eta = percent(self._around.amplitude), self._around.restitution
            terminal.result(
                f"Neighbours: {self._around.count} motions within {near} of each, restitution within {eta:g}."
            )
        terminal.result(governing(self._worst))
        terminal.result(self._restitution)


def _peak(ratio: float) -> str:
    return names.OVERTURNS if isinf(ratio) else f"{ratio:.3g}"


def _fate(history: History) -> str:
    """A cell: the peak, or that it overturns or does not uplift."""
    if history.overturned:
        return "overturns"
    return "no uplift" if history.uplift_time is None and not history.peak_ratio else f"{history.peak_ratio:.4g}"
