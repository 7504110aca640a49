"""The loads and ties of a structure in a report, with their displacements and forces under each ground motion."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import isnan
from typing import NamedTuple

from rocking_cli.core.hung.attached import PointMass, Spot
from rocking_cli.core.hung.element import ConstantForce, Element, SpringBed, Stretched
from rocking_cli.questions.report.study import Assessment, MotionResult
from rocking_cli.studies.movements import Movements, Watched, largest

ABSENT = "-"
Rows = list[list[str]]


class HungTables(NamedTuple):
    """Tables and sentences on the loads and ties of a structure.

    Parameters
    ----------
    masses : list of rows
        Name, body, place [m], mass [kg], and its shares in sideways and vertical inertia and as weight.
    forces : list of rows
        Name, body, place [m], force to the right and up [kN].
    ties : list of rows
        Name, start and end, sense, stiffness [kN/m], prestress [kN].
    moved : list of rows
        Motion, point, horizontal and vertical displacement [mm].
    strained : list of rows
        Motion, tie, largest force [kN] and elongation [mm].
    said : list of str
        Sentences on the loads and ties.
    """

    masses: Rows
    forces: Rows
    ties: Rows
    moved: Rows
    strained: Rows
    said: list[str]


def hung_on(content: Assessment) -> HungTables | None:
    """Return the tables of loads and ties; None if the structure has neither."""
    mechanism = content.mechanism
    if not mechanism.attached:
        return None
    watched = Watched(mechanism)
    worst = {each.given.motion.name: _worse(watched, each) for each in content.results}
    shown = {name + _until(moved): moved for name, moved in worst.items()}
    hung = mechanism.hung
    return HungTables(
        masses=[_mass(each) for each in hung.masses],
        forces=[_force(each) for each in hung.elements if isinstance(each, ConstantForce)],
        ties=[_tie(each) for each in hung.ties],
        moved=[
            [name, point.name, _mm(point.horizontal), _mm(point.vertical)]
            for name, moved in shown.items()
            for point in moved.points
        ],
        strained=[
            [name, tie.name, _kilo(tie.force), _mm(tie.elongation)]
            for name, moved in shown.items()
            for tie in moved.ties
        ],
        said=list(_said(worst)),
    )


def _until(moved: Movements) -> str:
    """Return words to follow the name of a motion: until when its peaks are known; empty if all of it is known."""
    return "" if isnan(moved.known_to) else f", up to {moved.known_to:.4g} s"


def _worse(watched: Watched, result: MotionResult) -> Movements:
    """Return the peaks over the polarities that were simulated, by the nonlinear model."""
    return largest([watched.peaks(runs["nonlinear"]) for runs in result.runs.values()])


def _mass(load: PointMass) -> list[str]:
    shares = (load.horizontal, load.vertical, load.weight)
    return [load.name, *_place(load.spot), f"{load.mass:.4g}", *(f"{share:.3g}" for share in shares)]


def _force(load: ConstantForce) -> list[str]:
    name = f"{load.name} (friction, against the motion; clockwise)" if load.friction else load.name
    return [name, *_place(load.spot), _kilo(load.thrust.real), _kilo(load.thrust.imag)]


def _tie(tie: Element) -> list[str]:
    if isinstance(tie, SpringBed):
        where = f"along a face, {_spot(tie.start)} to {_spot(tie.end)}"
        return [tie.name, where, "tension and compression", _kilo(tie.count * tie.stiffness), _kilo(0.0)]
    assert isinstance(tie, Stretched)  # the only other kind of element
    prestress, stiffness = tie.at_rest
    sense = {"tension": "tension only", "compression": "compression only", None: "tension and compression"}[tie.only]
    sense = sense if stiffness else "a constant force"
    number = f", {tie.count:g} ties" if tie.count != 1 else ""
    where = ", ".join(_spot(spot) for spot in tie.spots) + number
    return [tie.name, where, sense, _kilo(stiffness), _kilo(prestress)]


def _place(spot: Spot) -> tuple[str, str]:
    return spot.body or "ground", f"{spot.at.real:.4g}, {spot.at.imag:.4g}"


def _spot(spot: Spot) -> str:
    body, place = _place(spot)
    return f"{body} ({place})"


def _kilo(value: float) -> str:
    return ABSENT if isnan(value) else f"{value / 1000 + 0.0:.4g}"


def _mm(value: float) -> str:
    return ABSENT if isnan(value) else f"{1000 * value + 0.0:.4g}"


def _said(found: Mapping[str, Movements]) -> Iterator[str]:
    """Yield sentences on the largest tie force, and on the motions that overturn the structure."""
    unknown = [name for name, moved in found.items() if not isnan(moved.known_to)]
    every = [(name, tie) for name, moved in found.items() for tie in moved.ties if not isnan(tie.force)]
    if every:
        name, tie = max(every, key=lambda each: abs(each[1].force))
        if tie.force:
            sense = "tension" if tie.force > 0 else "compression"
            yield f"{tie.name} has the largest force: {_kilo(abs(tie.force))} kN in {sense}, under {name}."
        else:
            yield f"No ground motion causes a force in any tie{', as far as outcomes are known' if unknown else ''}."
    if unknown:
        yield (
            f"Under {' and '.join(unknown)} the outcome is unknown from the given time on: displacements and tie "
            "forces are those until then, and larger ones may follow."
        )
    falls = [name for name, moved in found.items() if any(isnan(point.horizontal) for point in moved.points)]
    if falls:
        yield (
            f"Under {' and '.join(falls)} the structure overturns in at least one polarity: it has no largest "
            "displacement, and the tie forces are those before overturning."
        )
