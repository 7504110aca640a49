"""Result of a check of the contract of mechanisms."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Verdict:
    """Result of one check of a structure.

    Parameters
    ----------
    check : str
        Name of the check.
    meaning : str
        What the check requires of the structure, one sentence.
    why : str or None
        Why it fails; None if it passes.
    trace : str or None
        Traceback of the plugin's error, if the check failed by one.
    """

    check: str
    meaning: str
    why: str | None = None
    trace: str | None = None

    @property
    def passed(self) -> bool:
        """Whether the structure passes the check."""
        return self.why is None
