"""What a check of the contract of mechanisms says."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Verdict:
    """Whether a structure passes one check.

    Parameters
    ----------
    check : str
        Name of the check.
    meaning : str
        What it holds the structure to, one sentence.
    why : str or None
        Why it fails; None if it passes.
    trace : str or None
        The traceback of an error that the plugin made, if it is one.
    """

    check: str
    meaning: str
    why: str | None = None
    trace: str | None = None

    @property
    def passed(self) -> bool:
        """Whether it passes."""
        return self.why is None
