"""A verification as a part of a report."""

from __future__ import annotations

from dataclasses import dataclass, replace

from rocking_cli.studies.verification.results import Verification
from rocking_cli.views.sheet.document import Sheet, SheetPart

OWN = frozenset({"drawing", "structure_text"})
"""The parts of a sheet that a report has anyway."""


@dataclass(frozen=True, eq=False)
class VerifiedReport:
    """A verification and its calculation sheet, for a report."""

    found: Verification
    sheet: Sheet

    @property
    def within(self) -> Sheet:
        """The sheet without parts that the report has already, with anchors distinct from the report's."""
        return replace(self.sheet, parts=[_apart(each) for each in self.sheet.parts if each.key not in OWN])


def _apart(part: SheetPart) -> SheetPart:
    below = [_apart(each) for each in part.parts if each.key not in OWN]
    return replace(part, key=f"verification-{part.key}", parts=below)
