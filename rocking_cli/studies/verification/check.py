"""Verification of a structure by the code that a site file names."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from rocking_cli.dynamics.prepared import Prepared
from rocking_cli.errors import InputError, PluginError, Problem
from rocking_cli.io.yaml_file import Document
from rocking_cli.studies.verification import site_file
from rocking_cli.studies.verification.code import Code
from rocking_cli.studies.verification.control import Control
from rocking_cli.studies.verification.installed import codes
from rocking_cli.studies.verification.motions import Histories
from rocking_cli.studies.verification.results import Verification
from rocking_cli.studies.verification.site_file import Site, SiteFile


def read_site(path: Path) -> SiteFile:
    """Read a site, for any code there is. Raises `InputError` with every problem of the file."""
    return site_file.read_site(path, codes(), _fields_of)


def site_in(document: Document) -> SiteFile:
    """The site in a parsed file. Raises `InputError` with every problem of it."""
    return site_file.site_of(document, codes(), _fields_of)


def _fields_of(code: str) -> type[Site]:
    return codes()[code].site


def code_of(site: SiteFile) -> Code:
    """The code by which a site verifies."""
    return codes()[site.site.code]


def of_each(site: SiteFile) -> SiteFile:
    """Return the site of a survey, in which what is said of the structure itself is left to each row."""
    return replace(site, site=code_of(site).of_each(site.site))


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
    code = code_of(site)
    if control is not None and not code.takes_control:
        raise InputError(Problem(f"{code.key} takes no control point", field="`control`", hint="leave it out"))
    try:
        return _held(code.verify(structure.mechanism, site.site, control), code)
    except InputError as error:
        own = type(structure.mechanism).model_fields
        placed = site.placed(error).problems
        raise InputError(
            *(
                replace(each, file=structure.file) if each.file is None and each.field in own else each
                for each in placed
            )
        ) from None


def _held(found: object, code: Code) -> Verification:
    """An answer of a code, if it is one; what else a plugin returns is an error of it."""
    directions = found.directions.values() if isinstance(found, Verification) else ()
    if not directions or not all(each.governs in each.methods for each in directions):
        raise PluginError(
            f"the code {code.key} failed in verify: it must return a Verification with at least one direction, each "
            "governed by one of its methods"
        )
    assert isinstance(found, Verification)  # it has directions
    return found


def with_histories(found: Verification, structure: Prepared, site: SiteFile, asked: Histories) -> Verification:
    """Return a verification with time histories under a set of records.

    Parameters
    ----------
    found : Verification
        The verification by the static methods.
    structure : Prepared
        The structure.
    site : SiteFile
        The site.
    asked : Histories
        The records, and to what they belong.

    Raises
    ------
    InputError
        If the code has no method with time histories, there is no motion, the site does not give the limit state, it
        has no floor on which the motions could be, or the restitution is none that a history can have.
    SolverError
        If a motion cannot be followed to its end.
    """
    return code_of(site).with_histories(found, structure, site.site, asked)
