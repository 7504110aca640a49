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
from rocking_cli.studies.verification.results import Dynamic, Verification
from rocking_cli.studies.verification.site_file import Site, SiteFile


def read_site(path: Path) -> SiteFile:
    """Read a site, for any code there is. Raises `InputError` with every problem of the file."""
    return site_file.read_site(path, _models())


def site_in(document: Document) -> SiteFile:
    """The site in a parsed file. Raises `InputError` with every problem of it."""
    return site_file.site_of(document, _models())


def _models() -> dict[str, type[Site]]:
    return {key: code.site for key, code in codes().items()}


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
) -> Verification:
    """The same with histories under records, as scaled; `progress` is told of each record.

    Raises
    ------
    InputError
        If there is no motion, or the restitution is none that a history can have.
    SolverError
        If a motion cannot be followed to its end.
    """
    taken = structure if found.mechanism is structure.mechanism else Prepared(found.mechanism, structure.file)
    model = taken.model("nonlinear")
    curves = {direction: each.exact for direction, each in found.directions.items()}
    every = []
    for motion in motions:
        every.append(dynamic.peaks(model, curves, motion, signs))
        progress(1)
    enough = codes()[site.site.code].records
    directions = {
        direction: replace(
            each,
            dynamic=Dynamic(
                [peak[direction] for peak in every],
                each.d0,
                {state: at.d for state, at in each.states.items()},
                enough,
                checked=model.joints is not None,
            ),
        )
        for direction, each in found.directions.items()
    }
    return replace(found, directions=directions)
