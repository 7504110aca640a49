"""What a code of practice is to this package: a module of `codes` that has one of these, called `CODE`."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from rocking_cli.core import Mechanism
from rocking_cli.processing.floor import Floor
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
    floor : callable, optional
        Gives the floor of a site on which the structure stands, at a limit state; None if it stands on the ground.
    of_each : callable, optional
        Gives the site of a survey: what it says of the structure itself is left to each row.
    """

    key: str
    name: str
    edition: str
    site: type[Site]
    starter: str
    records: int
    verify: Callable[[Mechanism, Any, Control | None], Verification]
    floor: Callable[[Any, str], Floor | None] = lambda site, state: None
    of_each: Callable[[Any], Any] = lambda site: site
