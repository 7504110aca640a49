"""View of the responses of a structure to several ground motions: a row for each, and which governs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from typing import NamedTuple

from rocking_cli import names
from rocking_cli.core.contacts import MASONRY_FRICTION
from rocking_cli.dynamics.history import History
from rocking_cli.dynamics.model import ModelName
from rocking_cli.dynamics.verdict import disagree
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.io.tables import Columns
from rocking_cli.names import digits_apart, peaks_over
from rocking_cli.studies.conclusion import Conclusion
from rocking_cli.studies.contact import ContactDemand
from rocking_cli.studies.movements import Movements, Watched
from rocking_cli.studies.neighbours import Conditions, Neighbourhood, Neighbours
from rocking_cli.studies.response import Histories, Response, best_model
from rocking_cli.text import in_short
from rocking_cli.views.cautions import cautions_of
from rocking_cli.views.column import Column, frame_of, of, only_shown, rounded, table_of
from rocking_cli.views.conclusion import MAX_NAMED_MOTIONS, counted
from rocking_cli.views.engines import engines_in_words
from rocking_cli.views.neighbours import deviations, neighbour_columns
from rocking_cli.views.response import LINEAR, apart, model_heads, models_used
from rocking_cli.views.restitution import heading_of_run, restitution_sentences
from rocking_cli.views.verdict import GO_ON, contact_parts, unchecked, unknown_after
from rocking_cli.views.view import ABSENT, ASIDE, Aside, Table, number


class MotionRow(NamedTuple):
    """A row of the table: name, PGA [g], outcome of each model, the neighbours, and the peaks of the best model.

    Peaks of an unknown outcome are None.
    """

    name: str
    pga: float
    fates: Mapping[ModelName, str]
    near: Neighbours | None
    moved: Movements | None


class Several:
    """Table of several motions; only the row of each motion is kept in memory.

    Parameters
    ----------
    conditions : Conditions
        The structure and the conditions of the runs.
    asked : int
        Number of motions that were given, with those that could not be used.
    linear : bool
        Whether equivalent blocks are shown on terminals in short too, as they are if the outcomes of models
        disagree.
    """

    def __init__(self, conditions: Conditions, asked: int, *, linear: bool) -> None:
        structure, models, engine = conditions.structure, conditions.models, conditions.engine
        self._title = heading_of_run(structure)
        rocks = structure.no_model is None
        self._free = [side.phi_cr is None for side in structure.statics] if rocks else [False]
        self._restitution = [*restitution_sentences(structure)] if rocks else []
        self._linear = linear
        with_blocks: Sequence[ModelName] = ["nonlinear", "blocks"] if rocks else ["blocks"]
        self._engine, self._by_blocks = engine, 0
        self._models = models if engine == "exact" else with_blocks
        self._rows: list[MotionRow] = []
        self._ends: list[Conclusion] = []
        self._asked = asked
        self._checked, self._doubtful, self._witness = True, False, True
        self._until: dict[str, str] = {}
        self._around: Neighbourhood | None = None
        self._mechanism = structure.mechanism
        self._cautions = cautions_of(structure.mechanism) if rocks else [f"{structure.no_model}."]
        if rocks and structure.misleading and any(name != "nonlinear" for name in models):
            self._cautions.append(f"{structure.misleading}.")
        self._watched, self._torn = Watched(structure.mechanism), dict[str, list[str]]()
        self._contacts: dict[str, ContactDemand] = {}

    def add(self, found: Response) -> None:
        """Add the response to one motion."""
        assert found.given is not None
        pga = abs(found.given.factor) * found.given.motion.of_ground.pga_g
        for sign, histories in found.runs.items():
            reversed_ = ", reversed" if sign < 0 and len(found.runs) > 1 else ""
            neighbours = found.neighbours.get(sign)
            name = f"{found.given.motion.name}{reversed_}"
            self._row(name, pga, histories, neighbours)
            run = histories[best_model(histories)]
            self._linear |= disagree(histories)
            self._by_blocks += "blocks" in histories
            self._doubtful |= neighbours is not None and bool(neighbours.unknown)
            if run.unknown:
                self._until[name] = unknown_after(run, histories.get("blocks")).replace("The", "the", 1)
                self._witness &= run.witness and "blocks" not in histories
            self._checked &= run.model != "nonlinear" or run.check is not None
            self._around = neighbours.around if neighbours is not None else None
            if sign in found.contacts:
                self._contacts[name] = found.contacts[sign]
        if found.fit is not None and found.to_pulse is not None:
            fitted = found.fit.pulse
            self._row(f"  its {fitted.name} pulse alone", fitted.amplitude / STANDARD_GRAVITY, found.to_pulse, None)
        self._ends.append(found.conclusion.told)
        for text in apart(self._watched, found.runs):
            self._torn.setdefault(text, []).append(found.given.motion.name)

    def _row(self, name: str, pga: float, histories: Histories, near: Neighbours | None) -> None:
        fates = {model: _fate(histories[model]) for model in self._models if model in histories}
        run = histories[best_model(histories)]
        moved = None if run.unknown or run.by_blocks else self._watched.peaks(run)
        self._rows.append(MotionRow(name, pga, fates, near, moved))

    def _columns(self) -> Iterator[Column[MotionRow]]:
        yield only_shown(f"peak phi/{'limit' if any(self._free) else 'phi_cr'}\nunder", of("name"), text=True)
        yield only_shown("PGA\n[g]", of("pga"), rank=2)
        for model, head in zip(self._models, model_heads(self._models, unknown=bool(self._until)), strict=True):
            yield only_shown(head, partial(_fate_of, model), rank=ASIDE * (model in LINEAR and not self._linear))
        if "nonlinear" in self._models or self._engine == "exact":  # free blocks do not move as the mechanism does
            yield from self._peaks()
        if self._around is not None:
            yield from neighbour_columns(of("near"), doubtful=self._doubtful)

    def _peaks(self) -> Iterator[Column[MotionRow]]:
        """Yield the columns of the peak displacement of the control point, and of the largest force of each tie."""
        at = [*self._watched.points].index(self._watched.control)
        how = rounded(4, 1e3), f"{self._watched.control}, horizontal displacement", "", False, 3
        yield Column(None, partial(_peak, "points", at, "horizontal"), "m", f"{self._watched.control}\n[mm]", *how)
        for k, tie in enumerate(self._watched.ties):
            how = rounded(4, 1e-3), f"{tie.name}, force", "", False, 3
            yield Column(None, partial(_peak, "ties", k, "force"), "N", f"{tie.name}\n[kN]", *how)

    def columns(self) -> Columns:
        """Return the peaks under each motion as columns: of the control point [m] and of ties [N]."""
        first = Column(None, of("name"), name="motion", text=True), Column(None, of("pga"), "g", name="pga_g")
        return frame_of([*first, *self._peaks()], self._rows)

    def parts(self, left_out: Sequence[str] = ()) -> Iterator[Table | str]:
        """Yield how many motions overturn the structure, which governs and which are left out, and the table."""
        best = best_model(self._models)
        by = "free blocks" if best == "blocks" else f"the {best} model"
        if self._engine != "exact" and best != "blocks":
            by = "the nonlinear model, and free blocks where it does not tell"
        yield f"By {by}, {counted(self._ends, peaks_over(self._free))}"
        if (lost := self._asked - len(self._ends)) > 0:
            named = f" ({in_short(left_out, most=MAX_NAMED_MOTIONS)})" if left_out else ""
            yield f"Not counted: {lost} of {self._asked} motions{named}, which could not be used."
        yield table_of(self._title, self._columns(), self._rows)
        if self._around is not None:
            yield f"Neighbours: {self._around.count} neighbouring motions for each motion, {deviations(self._around)}."
        yield from self._joints()
        yield from models_used(self._models)
        yield from self._restitution
        yield from engines_in_words(self._engine, self._by_blocks, self._mechanism)
        yield from (f"Caution: {text}" for text in self._cautions)
        yield from (
            f"Caution: under {in_short(each, most=MAX_NAMED_MOTIONS)}, {text}" for text, each in self._torn.items()
        )
        if not self._checked:
            yield unchecked(why=self._mechanism.unchecked)

    def _joints(self) -> Iterator[str]:
        """Yield until when motions are known, the friction that each requires, and the joints that fail.

        If the joints hold under all motions, yield the demands of the most demanding one, shown in full only.
        """
        for name, until in self._until.items():
            yield f"{name}: {until}"
        if self._until:
            yield f"Next: {GO_ON * self._witness}`rocking margin` shows up to which factor the outcomes are known."
        asks = {name: demand for name, demand in self._contacts.items() if demand.friction_needed >= 0}
        order = sorted(asks, key=lambda name: -asks[name].friction_needed)
        if order:
            yield f"Friction that the joints require: {self._friction(asks, order)}."
        fail = {name: demand for name, demand in self._contacts.items() if not demand.stands}
        impacts = {name: each.impact_friction for name, each in asks.items() if each.impact_friction > 0}
        worst = sorted(impacts, key=lambda name: -impacts[name])[:1]
        for name, demand in (fail or {each: asks[each] for each in dict.fromkeys([*order[:1], *worst])}).items():
            for k, words in enumerate(contact_parts(demand, self._mechanism)):  # none if the structure does not rock
                kind = Aside if k == 0 and not fail else type(words)  # the friction is in the sentence above
                yield kind(f"{name}: {words.removeprefix('Contact: ')}")

    def _friction(self, asks: Mapping[str, ContactDemand], order: Sequence[str]) -> str:
        """Return the friction that motions require, the largest first, and the motions that require too much."""
        friction = asks[order[0]].friction
        there, of = (MASONRY_FRICTION, "usual for masonry") if friction is None else (friction, "available")
        needs = {name: asks[name].friction_needed for name in order}
        shown = [f"{number(need, digits_apart(need, there, 3))} under {name}" for name, need in needs.items()]
        each = in_short(shown, most=MAX_NAMED_MOTIONS)
        more = [name for name, need in needs.items() if need > there]
        if not more:
            return f"{each}; the {there:g} {of} is enough under all"
        assumed = ": the results assume that nothing slides" if friction is None else ""
        return f"{each}; it is more than the {there:g} {of} under {in_short(more, most=MAX_NAMED_MOTIONS)}{assumed}"


def _fate_of(model: ModelName, row: MotionRow) -> str:
    return row.fates.get(model, ABSENT)


def _peak(kind: str, place: int, of: str, row: MotionRow) -> float | None:
    """Return a peak of a row, such as that of a tie; None if the outcome of the row is unknown."""
    return None if row.moved is None else getattr(getattr(row.moved, kind)[place], of)


def _fate(history: History) -> str:
    """Return a table cell: the peak, or that the structure overturns, slides, does not uplift, or is unknown."""
    if history.unknown:
        return names.UNKNOWN
    if history.fell:
        return "overturns"
    if history.slip:
        return "slides"
    return f"{history.peak_ratio:.4g}" if history.lifted else "no uplift"
