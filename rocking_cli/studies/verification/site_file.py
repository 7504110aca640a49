"""Reading of a site file by the fields of its code, with every problem placed at file:line:column."""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import dataclass
from pathlib import Path

from pydantic import Field, ValidationError

from rocking_cli.core.fields import Name
from rocking_cli.errors import InputError, Problem
from rocking_cli.io.yaml_file import Document, parse, read_text
from rocking_cli.studies.file_part import Part, problems_of
from rocking_cli.text import did_you_mean

HINT = "`rocking new site` prints one to start from"
USUAL = "NTC2018"
"""The code of a site file that names none."""


class Site(Part):
    """Fields of a site file for every code; a code adds its own."""

    code: str = Field(USUAL, description="the code to verify by")
    name: Name | None = Field(None, description="what to call the site")


@dataclass(frozen=True)
class SiteFile:
    """A site, and the file with the lines on which its values stand.

    Parameters
    ----------
    site : Site
        The site.
    document : Document
        The file.
    """

    site: Site
    document: Document

    def placed(self, error: InputError) -> InputError:
        """Return an error with its problems; those of fields of the site get their place in the file."""
        return InputError(*(self._placed(each) for each in error.problems))

    def _placed(self, problem: Problem) -> Problem:
        place = tuple((problem.field or "").split("."))
        if problem.file is not None or place not in self.document.values:
            return problem
        return self.document.at(place, problem.message, problem.hint)


def read_site(path: Path, codes: Collection[str], fields_of: Callable[[str], type[Site]]) -> SiteFile:
    """Read a site from its YAML file.

    Parameters
    ----------
    path : Path
        The file.
    codes : collection of str
        Keys of the installed codes.
    fields_of : callable
        Returns the class of a site for a key of a code.

    Raises
    ------
    InputError
        With every problem of the file: place, field, and valid values.
    """
    return site_of(parse(read_text(path, "site"), str(path), "site", HINT), codes, fields_of)


def site_of(document: Document, codes: Collection[str], fields_of: Callable[[str], type[Site]]) -> SiteFile:
    """Return the site in a parsed file. Raises as `read_site`."""
    code = document.data.get("code", USUAL)
    if isinstance(code, str) and code not in codes:
        problem = document.at(("code",), f"there is no code {code!r}", did_you_mean(code, list(codes)))
        raise InputError(*document.problems, problem)
    code = code if isinstance(code, str) else USUAL
    model, site = fields_of(code), None
    lister = HINT if code == USUAL else f"`rocking new site` prints one to start from, if given the code {code}"
    try:
        site = model.model_validate(document.data)
    except ValidationError as error:
        document.problems += problems_of(document, model, error, owner="the site", lister=lister)
    document.check()
    assert site is not None  # else there is a problem
    return SiteFile(site, document)
