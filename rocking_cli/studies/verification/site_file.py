"""A site file: the fields of every code, and the place of a problem in the file."""

from __future__ import annotations

from dataclasses import dataclass

from pydantic import Field

from rocking_cli.core.fields import Name
from rocking_cli.errors import InputError, Problem
from rocking_cli.io.yaml_file import Document
from rocking_cli.studies.file_part import Part

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
