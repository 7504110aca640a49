"""Verification of a structure by the code that a site file names."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

from rocking_cli.core import Mechanism
from rocking_cli.core.attachments import Carrier, Refused
from rocking_cli.dynamics.prepared import Prepared
from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.io.yaml_file import Document
from rocking_cli.studies.verification import dynamic, site_file
from rocking_cli.studies.verification.chain import Control
from rocking_cli.studies.verification.codes import codes
from rocking_cli.studies.verification.results import Dynamic, Motions, Verification
from rocking_cli.studies.verification.site_file import Site, SiteFile
from rocking_cli.text import did_you_mean


def read_site(path: Path) -> SiteFile:
    """Read a site, for any code there is. Raises `InputError` with every problem of the file."""
    return site_file.read_site(path, _models())


def site_in(document: Document) -> SiteFile:
    """The site in a parsed file. Raises `InputError` with every problem of it."""
    return site_file.site_of(document, _models())


def _models() -> dict[str, type[Site]]:
    return {key: code.site for key, code in codes().items()}


def of_each(site: SiteFile) -> SiteFile:
    """Return the site of a survey, in which what is said of the structure itself is left to each row."""
    return replace(site, site=codes()[site.site.code].of_each(site.site))


def control_at(mechanism: Mechanism, x: float, y: float, body: str | None) -> Control:
    """A control point of a body, which may be left out where there is one. Raises `InputError` if it is not on it."""
    carrier = Carrier.of(mechanism.bodies(), mechanism.sketch(), mechanism.alike(), mechanism.piece)
    try:
        spot = carrier.spot(body, complex(x, y), (), "control")
    except Refused as error:
        raise InputError(Problem(f"`control`: {error.reason}")) from None
    return Control(spot.at, spot.body)


def verify(
    structure: Prepared,
    site: SiteFile,
    control: Control | None = None,
) -> Verification:
    """Verify a structure by the code of a site, by its static methods.

    Parameters
    ----------
    structure : Prepared
        The structure.
    site : SiteFile
        The site.
    control : Control, optional
        The control point; by default what the code takes.

    Raises
    ------
    InputError
        If the site does not give what the structure asks for, or the structure has no capacity curve.
    MechanismError
        If the structure does not stand.
    """
    structure.statics  # noqa: B018 - what does not stand, or jumps, is refused with its name
    try:
        return codes()[site.site.code].verify(structure.mechanism, site.site, control)
    except InputError as error:
        own = type(structure.mechanism).model_fields
        placed = site.placed(error).problems
        raise InputError(
            *(
                replace(each, file=structure.file) if each.file is None and each.field in own else each
                for each in placed
            )
        ) from None


def with_histories(
    found: Verification,
    structure: Prepared,
    site: SiteFile,
    motions: Sequence[GroundMotion],
    signs: Sequence[int],
    progress: Callable[[int], object] = int,
    *,
    state: str | None = None,
    on_floor: bool = False,
) -> Verification:
    """Return a verification with time histories under a set of records.

    Parameters
    ----------
    found : Verification
        The verification by the static methods.
    structure : Prepared
        The structure.
    site : SiteFile
        The site.
    motions : sequence of GroundMotion
        The records, as scaled. If the site has a floor, ground motions are carried to it.
    signs : sequence of int
        Polarities, of 1 and -1.
    progress : callable
        Called with 1 after each record.
    state : str, optional
        The limit state to which the records belong; by default the first one.
    on_floor : bool
        Whether the motions are those of the floor of the site, and not of the ground.

    Raises
    ------
    InputError
        If there is no motion, the site does not give the limit state, it has no floor on which the motions could be, or
        the restitution is none that a history can have.
    SolverError
        If a motion cannot be followed to its end.
    """
    taken = structure if found.mechanism is structure.mechanism else Prepared(found.mechanism, structure.file)
    model = taken.model("nonlinear")
    curves = {direction: each.exact for direction, each in found.directions.items()}
    state = _state_of_records(found, state)
    what, moved = _where_it_stands(site, motions, state, on_floor=on_floor)
    every = []
    for motion in moved:
        every.append(dynamic.peaks(model, curves, motion, signs))
        progress(1)
    enough = codes()[site.site.code].records
    directions = {
        direction: replace(
            each,
            dynamic=Dynamic(
                [peak[direction] for peak in every],
                each.d0,
                {state: each.states[state].d},
                enough,
                checked=model.joints is not None,
                motions=what,
            ),
        )
        for direction, each in found.directions.items()
    }
    return replace(found, directions=directions)


def _state_of_records(found: Verification, state: str | None) -> str:
    """Return the limit state of a set of records. Raises `InputError` if the site does not give it."""
    if state is None:
        return found.first
    states = next(iter(found.directions.values())).states
    if state not in states:
        hint = did_you_mean(state, list(states)) or f"give one of {', '.join(states)}"
        raise InputError(Problem(f"{state!r} is not a limit state of displacement", field="`state`", hint=hint))
    if states[state].demand is None:
        hint = f"give {state} in the site file: the records must match its spectrum"
        raise InputError(Problem(f"{state} is not given by the site", field="`state`", hint=hint))
    return state


def _where_it_stands(
    site: SiteFile, motions: Sequence[GroundMotion], state: str, *, on_floor: bool
) -> tuple[Motions, Sequence[GroundMotion]]:
    """Carry ground motions to the floor of a site. Raises `InputError` if they cannot be of the floor or are mixed."""
    floor = codes()[site.site.code].floor(site.site, state)
    carried = [motion.ground is not None for motion in motions]
    if on_floor and floor is None:
        hint = "give `floor` in the site file, or leave the option out"
        raise InputError(Problem("requires a site with a floor", field="`on_floor`", hint=hint))
    if any(carried) and on_floor:
        hint = "leave out one of the two: `floor` carries ground motions to a floor"
        raise InputError(Problem("cannot be combined with `floor`", field="`on_floor`", hint=hint))
    if any(carried) and not all(carried):
        raise InputError(Problem("some of the motions are of a floor, others of the ground: give motions of one kind"))
    if on_floor:
        return Motions("of_floor"), motions
    if carried and all(carried):
        return Motions("carried_by_option", motions[0].processing[-1].removeprefix("floor ")), motions
    if floor is None:
        return Motions(), motions
    return Motions("carried_to_floor", str(floor)), [floor.of(motion) for motion in motions]
