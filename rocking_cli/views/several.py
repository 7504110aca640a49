"""What several ground motions do to a structure: a row each, and which governs."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import isinf

from rocking_cli import names
from rocking_cli.dynamics.history import History
from rocking_cli.dynamics.model import ModelName
from rocking_cli.dynamics.prepared import Prepared
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.names import percent
from rocking_cli.studies.contact import Contact
from rocking_cli.studies.neighbours import Around, Neighbours, Severity, governing, severity
from rocking_cli.studies.response import Answer, Histories
from rocking_cli.views.contact import contact_words
from rocking_cli.views.response import models_used
from rocking_cli.views.restitution import restitution_used
from rocking_cli.views.view import ABSENT, Table, heading


class Several:
    """The table of several motions, a row each; of a motion no more than its row is kept.

    Parameters
    ----------
    structure : Prepared
        What is shaken.
    models : tuple of str
        The models simulated.
    """

    def __init__(self, structure: Prepared, models: Sequence[ModelName]) -> None:
        self._title = heading(structure.mechanism)
        self._over = "phi_cr" if not any(side.phi_cr is None for side in structure.statics) else "limit"
        self._restitution = restitution_used(structure)
        self._models = models
        self._best: ModelName = "nonlinear" if "nonlinear" in models else models[0]
        self._rows: list[list[str]] = []
        self._worst: dict[str, Severity] = {}
        self._fallen = 0
        self._around: Around | None = None
        self._mechanism = structure.mechanism
        self._contacts: dict[str, Contact] = {}

    def add(self, found: Answer) -> None:
        """Add the response to one motion."""
        assert found.given is not None
        pga = f"{abs(found.given.factor) * found.given.motion.of_ground.pga:.4g}"
        severities = []
        for sign, histories in found.runs.items():
            reversed_ = ", reversed" if sign < 0 and len(found.runs) > 1 else ""
            near = found.neighbours.get(sign)
            self._row(f"{found.given.motion.name}{reversed_}", pga, histories, near)
            severities.append(severity(histories[self._best], near))
            self._around = near.around if near is not None else None
            if sign in found.contacts:
                self._contacts[f"{found.given.motion.name}{reversed_}"] = found.contacts[sign]
        if found.fit is not None and found.to_pulse is not None:
            own = found.fit.pulse
            self._row(f"  its {own.name} pulse alone", f"{own.amplitude / STANDARD_GRAVITY:.4g}", found.to_pulse, None)
        self._worst[found.given.motion.name] = max(severities)
        self._fallen += any(histories[self._best].overturned for histories in found.runs.values())

    def _row(self, what: str, pga: str, histories: Histories, near: Neighbours | None) -> None:
        around = [percent(near.overturned), _peak(near.peak_ratio[1])] if near is not None else [ABSENT] * 2
        self._rows.append([what, pga, *(_fate(histories[name]) for name in self._models), *around])

    def parts(self) -> Iterator[Table | str]:
        """The table, how many motions overturn it, and which governs."""
        heads = [f"peak phi/{self._over}\nunder", "PGA\n[g]", *self._models]
        rows = self._rows
        if self._around is not None:
            heads += ["neighbours\noverturn", "their\nmedian"]
        else:
            rows = [row[:-2] for row in rows]
        yield Table(self._title, heads, rows, numbers=range(1, len(heads)))
        fallen = f"{self._fallen} of {len(self._worst)} motions overturn it" if self._fallen else ""
        yield f"By the {self._best} model, {fallen or f'none of {len(self._worst)} motions overturns it'}."
        if self._around is not None:
            yield f"Neighbours: {self._around.count} neighbouring motions for each motion, {self._around.words}."
        yield governing(self._worst)
        yield from self._joints()
        yield from models_used(self._models)
        yield self._restitution

    def _joints(self) -> Iterator[str]:
        """Yield the contact demands under which the joints do not hold, else those of the most demanding motion."""
        fail = {name: found for name, found in self._contacts.items() if not found.holds}
        asks = {name: found for name, found in self._contacts.items() if found.friction_needed >= 0}
        if not fail and asks:
            most = max(asks, key=lambda name: asks[name].friction_needed)
            fail = {most: asks[most]}
        for name, found in fail.items():
            yield f"{name}: {contact_words(found, self._mechanism).removeprefix('Contact: ')}"


def _peak(ratio: float) -> str:
    return names.OVERTURNS if isinf(ratio) else f"{ratio:.3g}"


def _fate(history: History) -> str:
    """A cell: the peak, or that it overturns or does not uplift."""
    if history.overturned:
        return "overturns"
    return f"{history.peak_ratio:.4g}" if history.lifted else "no uplift"
