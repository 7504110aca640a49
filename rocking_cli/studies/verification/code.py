"""The interface of a code of practice: a class derived from `Code`, found through an entry point."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

from rocking_cli.core import Direction, Mechanism
from rocking_cli.plugins.errors import failed, guard
from rocking_cli.structure import Structure
from rocking_cli.studies.verification.control import Control
from rocking_cli.studies.verification.motions import Histories
from rocking_cli.studies.verification.results import Verification, Verified
from rocking_cli.studies.verification.site_file import Site

ANSWERS = ("verify", "with_histories", "of_each", "showing", "sheet")
"""The methods in which a code answers: whatever fails there is an error of the plugin."""


@dataclass(frozen=True)
class Number:
    """A number of a code that a structure can be designed for; of two directions the smaller counts.

    Parameters
    ----------
    meaning : str
        Meaning of the number, in a few words.
    of : callable, optional
        `of(verified)` returns the number from the result of a direction, or None if the site lacks values for it.
    of_structure : callable, optional
        `of_structure(mechanism, direction)` returns the number of a structure without a site instead.
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
    takes_control : bool
        Whether `verify` takes a control point.
    """

    key: ClassVar[str]
    name: ClassVar[str]
    edition: ClassVar[str]
    site: ClassVar[type[Site]]
    starter: ClassVar[str] = ""
    numbers: ClassVar[Mapping[str, Number]] = {}
    takes_control: ClassVar[bool] = False

    def __init_subclass__(cls, **named: Any) -> None:
        """Wrap the methods of a subclass, so that errors in them are reported as errors of the plugin."""
        super().__init_subclass__(**named)
        guard(cls, ANSWERS, failed("code", "key"))

    @abstractmethod
    def verify(self, mechanism: Mechanism, site: Any, control: Control | None = None) -> Verification:
        """Verify a structure at a site.

        Parameters
        ----------
        mechanism : Mechanism
            The structure.
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

        Parameters are those of `rocking_cli.studies.verification.check.with_histories`.
        """
        raise NotImplementedError

    def of_each(self, site: Any) -> Any:
        """Return the site for a survey, without data of the structure itself, which are left to each row."""
        return site

    def showing(self) -> Any:
        """Return how its results are shown, a `rocking_cli.views.verification.Showing`; None for the usual way."""
        return None

    def sheet(self) -> Any:
        """Return its calculation sheet, a `rocking_cli.views.sheet.build.SheetOfCode`; None if it has none."""
        return None
