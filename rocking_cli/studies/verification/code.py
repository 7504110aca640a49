"""What a code of practice is to this package: a module of `codes` that has one of these, called `CODE`."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from rocking_cli.core import Mechanism
from rocking_cli.studies.verification.chain import Control
from rocking_cli.studies.verification.results import Verification
from rocking_cli.studies.verification.site_file import Site


@dataclass(frozen=True)
class Code:
    """A code of practice.

    Parameters
    ----------
    key : str
        What site files call it.
    name, edition : str
        What it is, and the edition that is followed.
    site : type of Site
        The fields of a site file for it.
    starter : str
        A commented site file that works as it is.
    records : int
        How many records it wants for histories.
    verify : callable
        Verifies a mechanism at a site, with a control point or None for its own choice.
    """

    key: str
    name: str
    edition: str
    site: type[Site]
    starter: str
    records: int
    verify: Callable[[Mechanism, Any, Control | None], Verification]
