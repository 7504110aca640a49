"""View of the responses of a structure to several ground motions: a row for each, and which governs."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import isinf

from rocking_cli import names
from rocking_cli.dynamics.history import History
from rocking_cli.dynamics.holding import unchecked, why_unknown
from rocking_cli.dynamics.model import ModelName
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.names import peaks_over, percent
from rocking_cli.structure import Structure
from rocking_cli.studies.contact import ContactDemand
from rocking_cli.studies.neighbours import Neighbourhood, Neighbours, Severity, governing, severity
from rocking_cli.studies.response import Histories, Response
from rocking_cli.views.contact import contact_words
from rocking_cli.views.response import model_heads, models_used
from rocking_cli.views.restitution import restitution_used
from rocking_cli.views.view import ABSENT, Table, heading


class Several:
    """Table of several motions; only the row of each motion is kept in memory.

    Parameters
    ----------
    structure : Structure
        The structure.
    models : tuple of str
        The models simulated.
    asked : int
        Number of motions that were given, with those that could not be used.
    """

    def __init__(self, structure: Structure, models: Sequence[ModelName], asked: int) -> None:
        self._title = heading(structure.mechanism)
        self._free = [side.phi_cr is None for side in structure.statics]
        self._restitution = restitution_used(structure)
        self._models = models
        self._best: ModelName = "nonlinear" if "nonlinear" in models else models[0]
        self._rows: list[list[str]] = []
        self._worst: dict[str, Severity] = {}
        self._fallen = self._unknown = 0
        self._asked = asked
        self._checked, self._doubtful = True, False
        self._until: dict[str, str] = {}
        self._around: Neighbourhood | None = None
        self._mechanism = structure.mechanism
        self._contacts: dict[str, ContactDemand] = {}

    def add(self, found: Response) -> None:
        """Add the response to one motion."""
        assert found.given is not None
        pga = f"{abs(found.given.factor) * found.given.motion.of_ground.pga_g:.4g}"
        severities = []
        for sign, histories in found.runs.items():
            reversed_ = ", reversed" if sign < 0 and len(found.runs) > 1 else ""
            near = found.neighbours.get(sign)
            name = f"{found.given.motion.name}{reversed_}"
            self._row(name, pga, histories, near)
            run = histories[self._best]
            self._doubtful |= near is not None and bool(near.unknown)
            if run.unknown:
                self._until[name] = f"the outcome is known until {run.known_to:.4g} s: then {why_unknown(run)}."
            severities.append(severity(run, near))
            self._checked &= run.model != "nonlinear" or run.check is not None
            self._around = near.around if near is not None else None
            if sign in found.contacts:
                self._contacts[name] = found.contacts[sign]
        if found.fit is not None and found.to_pulse is not None:
            own = found.fit.pulse
            self._row(f"  its {own.name} pulse alone", f"{own.amplitude / STANDARD_GRAVITY:.4g}", found.to_pulse, None)
        self._worst[found.given.motion.name] = max(severities)
        runs = [histories[self._best] for histories in found.runs.values()]
        fallen = any(run.fell for run in runs)
        self._fallen += fallen
        self._unknown += not fallen and any(run.unknown for run in runs)

    def _row(self, what: str, pga: str, histories: Histories, near: Neighbours | None) -> None:
        self._rows.append([what, pga, *(_fate(histories[name]) for name in self._models), *neighbours_cells(near)])

    def parts(self) -> Iterator[Table | str]:
        """Yield the table, how many motions overturn the structure, and which governs."""
        heads = [f"peak phi/{'limit' if any(self._free) else 'phi_cr'}\nunder", "PGA\n[g]"]
        heads += model_heads(self._models, unknown=bool(self._until))
        rows = self._rows
        if self._around is None:
            rows = [row[:-3] for row in rows]
        elif self._doubtful:
            heads += ["neighbours\noverturn", "are\nunknown", "their\nmedian"]
        else:
            heads += ["neighbours\noverturn", "their\nmedian"]
            rows = [[*row[:-2], row[-1]] for row in rows]
        yield Table(self._title, heads, rows, numbers=range(1, len(heads)))
        yield f"By the {self._best} model, {self._outcomes()}."
        if (lost := self._asked - len(self._worst)) > 0:
            yield f"Not counted: {lost} of {self._asked} motions, which could not be used."
        if self._around is not None:
            yield f"Neighbours: {self._around.count} neighbouring motions for each motion, {self._around.words}."
        yield governing(self._worst, peaks_over(self._free))
        yield from self._joints()
        yield from models_used(self._models)
        yield self._restitution
        if not self._checked:
            yield unchecked(why=self._mechanism.unchecked)

    def _outcomes(self) -> str:
        """Return a sentence on how many motions overturn the structure, and how many are unknown."""
        count = len(self._worst)
        if self._fallen:
            said = f"{self._fallen} of {count} motions overturn it"
            return f"{said}, and the outcome under {self._unknown} is {names.UNKNOWN}" if self._unknown else said
        if not self._unknown:
            return f"none of {count} motions overturns it"
        said = f"the outcome under {self._unknown} of {count} motions is {names.UNKNOWN}"
        return said if self._unknown == count else f"{said}, and none of the others overturns it"

    def _joints(self) -> Iterator[str]:
        """Yield until when motions are known, and the contact demands of motions under which the joints fail.

        If the joints hold under all motions, yield the demands of the most demanding one.
        """
        for name, until in self._until.items():
            yield f"{name}: {until}"
        fail = {name: found for name, found in self._contacts.items() if not found.stands}
        asks = {name: found for name, found in self._contacts.items() if found.friction_needed >= 0}
        if not fail and asks:
            most = max(asks, key=lambda name: asks[name].friction_needed)
            fail = {f"The joints hold under all motions, of which {most} demands most of them": asks[most]}
        for name, found in fail.items():
            yield f"{name}: {contact_words(found, self._mechanism).removeprefix('Contact: ')}"


def neighbours_cells(near: Neighbours | None) -> list[str]:
    """Return the shares of the neighbours of a motion that overturn and are of unknown outcome, and the median peak."""
    if near is None:
        return [ABSENT] * 3
    none = names.OVERTURNS if near.half_overturn else names.UNKNOWN
    peak = none if isinf(near.peak_ratio[1]) else f"{near.peak_ratio[1]:.3g}"
    return [percent(near.overturned), ABSENT if near.unknown is None else percent(near.unknown), peak]


def _fate(history: History) -> str:
    """Return a table cell: the peak, or that the structure overturns, does not uplift, or is of unknown outcome."""
    if history.unknown:
        return names.UNKNOWN
    if history.fell:
        return "overturns"
    return f"{history.peak_ratio:.4g}" if history.lifted else "no uplift"
