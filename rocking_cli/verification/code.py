"""The interface of a code of practice: a site file, and a class derived from `Code`, found through an entry point."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cache
from importlib.metadata import EntryPoint
from pathlib import Path
from typing import Any, ClassVar, Literal

from pydantic import Field, PrivateAttr

from rocking_cli.core import Direction, Mechanism
from rocking_cli.core.fields import Name
from rocking_cli.errors import InputError, MechanismError
from rocking_cli.io.yaml_file import Document
from rocking_cli.plugins.errors import blame, failed, guard
from rocking_cli.plugins.registry import Plugins, origin
from rocking_cli.structure import Structure
from rocking_cli.studies.file_part import Part
from rocking_cli.verification.demand import SiteDemand
from rocking_cli.verification.results import Control, Histories, Verification, Verified

CODE_METHODS = ("verify", "with_histories", "strengthened", "of_each", "located", "demand", "showing", "sheet")
"""Methods that a code may define: any failure in them is reported as an error of the plugin."""


@dataclass(frozen=True)
class Number:
    """A quantity that a code computes, for which a structure can be designed; the smaller of both directions counts.

    Parameters
    ----------
    meaning : str
        Meaning of the number, in a few words.
    of : callable, optional
        `of(verified)` returns the number from the result of a direction, or None if the site lacks values for it.
    of_structure : callable, optional
        `of_structure(mechanism, direction)` returns the number of a structure without a site instead; ties of steel act
        with their strength, as for `Code.verify`.
    unit : str
        Unit of the number; empty if it is dimensionless.
    """

    meaning: str
    of: Callable[[Any], float | None] | None = None
    of_structure: Callable[[Mechanism, Direction], float] | None = None
    unit: str = ""


class Code(ABC):
    """A code of practice.

    Attributes
    ----------
    key : str
        Name of the code in site files, and of its entry point of `rocking.codes`.
    name, edition : str
        Name of the code for readers, and its edition.
    site : type of Site
        The fields of a site file for it.
    starter : str
        A commented site file that works as it is; if it is empty, it is made from the fields and their examples.
    numbers : mapping of str to Number
        Numbers of this code for which a structure can be designed, in addition to the `ratio` of every code.
    row_numbers : mapping of str to Number
        Numbers of the direction that governs, which a survey has for each structure in addition to the `ratio`.
    takes_control : bool
        Whether `verify` takes a control point.
    masonry : bool
        Whether it is for masonry, of which unusual numbers are questioned; its texts and its site then have `unusual`.
    """

    key: ClassVar[str]
    name: ClassVar[str]
    edition: ClassVar[str]
    site: ClassVar[type[Site]]
    starter: ClassVar[str] = ""
    numbers: ClassVar[Mapping[str, Number]] = {}
    row_numbers: ClassVar[Mapping[str, Number]] = {}
    takes_control: ClassVar[bool] = False
    masonry: ClassVar[bool] = False

    def __init_subclass__(cls, **named: Any) -> None:
        """Wrap the methods of a subclass, so that errors in them are reported as errors of the plugin."""
        super().__init_subclass__(**named)
        guard(cls, CODE_METHODS, failed("code", "key"))

    @abstractmethod
    def verify(self, mechanism: Mechanism, site: Any, control: Control | None = None) -> Verification:
        """Verify a structure at a site.

        Parameters
        ----------
        mechanism : Mechanism
            The structure; ties of steel act with their strength, as constant forces (`Mechanism.at_strength`).
        site : Site
            The site, an object of the class attribute `site`.
        control : Control, optional
            The control point, passed only to a code that takes one; None for its own choice.

        Raises
        ------
        InputError
            If the site lacks values that the structure needs; a `Problem` with a `field` of the site is reported with
            its line.
        """

    @property
    def takes_motions(self) -> bool:
        """Whether the code has a method with time histories."""
        return type(self).with_histories is not Code.with_histories

    def found(self, mechanism: Mechanism, directions: Mapping[Direction, Verified], **more: Any) -> Verification:
        """Return the answer of `verify` from what was found in each direction; `more` are fields of `Verification`."""
        return Verification(mechanism, self.key, self.name, self.edition, directions, **more)

    def with_histories(self, found: Any, structure: Structure, site: Any, asked: Histories) -> Verification:
        """Return a verification with time histories; only a code that overrides this method takes ground motions.

        Parameters are those of `rocking_cli.verification.check.with_histories`.
        """
        raise NotImplementedError

    def strengthened(self, found: Any, other: Any, site: Any) -> Any:
        """Return a verification beside that of the strengthened structure; a code may judge each by the other."""
        del site
        return replace(found, strengthened=other)

    @property
    def has_demand(self) -> bool:
        """Whether the code gives the response spectra of a site."""
        return type(self).demand is not Code.demand

    def demand(self, site: Any) -> SiteDemand:
        """Return the response spectra of a site by limit state; only a code that overrides this method has them."""
        raise NotImplementedError

    def located(self, site: Any, folder: Path) -> Any:
        """Return the site with the content of the files that it names, whose relative paths are of a folder.

        Raises
        ------
        InputError
            If a file cannot be used; a `Problem` with a `field` of the site is reported with its line.
        """
        del folder
        return site

    def of_each(self, site: Any) -> Any:
        """Return the site for a survey, without data of the structure itself, which are left to each row."""
        return site

    def showing(self) -> Any:
        """Return how its results are shown, a `rocking_cli.views.verification.Showing`; None for the usual way."""
        return None

    def sheet(self) -> Any:
        """Return its calculation sheet, a `rocking_cli.views.sheet.build.SheetOfCode`; None if it has none."""
        return None


SITE_HINT = "`rocking new site` prints one to start from"
DEFAULT_CODE = "NTC2018"
"""The code of a site file that names none."""


class Site(Part):
    """Fields of a site file for every code; a code adds its own."""

    code: str = Field(DEFAULT_CODE, description="the code to verify by")
    name: Name | None = Field(None, description="what to call the site")
    language: Literal["en", "it"] | None = Field(
        None, examples=["it"], description="language of all answers at this site, en or it"
    )
    _named: dict[str, Path] = PrivateAttr(default_factory=dict)

    @property
    def named(self) -> dict[str, Path]:
        """The files that fields name, by field, as `Code.located` found them."""
        return self._named


@dataclass(frozen=True)
class SiteFile:
    """A site, and the file with the lines on which its values stand.

    Parameters
    ----------
    site : Site
        The site.
    document : Document
        The file.
    changed : bool
        Whether fields of the site are not those of the file.
    """

    site: Site
    document: Document
    changed: bool = False

    def placed(self, error: InputError) -> InputError:
        """Return an error with its problems; those of fields of the site get their place in the file."""
        return InputError(*(self.document.located(each) if each.file is None else each for each in error.problems))


class Codes(Plugins[Code]):
    """Installed codes, by their names in site files. Listing names loads nothing; looking one up loads it.

    Raises
    ------
    InputError
        On looking up an unknown name.
    MechanismError
        On looking up a plugin that cannot be loaded, is not a code, or has a name that two packages claim.
    """

    group = "rocking.codes"
    kind = "code"

    @staticmethod
    def accept(loaded: object, point: EntryPoint) -> Code:
        """Return an instance of a loaded class if it is a complete code of its name. Raises `MechanismError` if not."""
        if not (isinstance(loaded, type) and issubclass(loaded, Code)) or loaded.__abstractmethods__:
            raise MechanismError(f"{origin(point)} is not a code: it must derive from Code and be complete")
        texts = [getattr(loaded, key, None) for key in ("name", "edition")]
        if getattr(loaded, "key", None) != point.name or not all(isinstance(each, str) for each in texts):
            raise MechanismError(f"{origin(point)} is not a code: it needs key = {point.name!r}, a name and an edition")
        fields = getattr(loaded, "site", None)
        if not (isinstance(fields, type) and issubclass(fields, Site)):
            raise MechanismError(f"{origin(point)} is not a code: its site must be a class derived from Site")
        numbers = getattr(loaded, "numbers", None)
        if not (isinstance(numbers, Mapping) and all(isinstance(each, Number) for each in numbers.values())):
            raise MechanismError(f"{origin(point)} is not a code: its numbers must be a mapping of str to Number")
        with blame(f"{origin(point)} cannot be made", loaded.__module__):
            return loaded()


@cache
def codes() -> Codes:
    """Return the installed codes."""
    return Codes()
