"""A check of the installation, and its result."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import isfinite
from time import monotonic

from rocking_cli.errors import RockingError
from rocking_cli.text import seen


class NotRun(Exception):
    """Reason why a check cannot be run on this machine, though nothing is wrong: an extra that is not installed."""


@dataclass(frozen=True)
class Check:
    """A check of the installation.

    Parameters
    ----------
    name : str
        Name of the check.
    meaning : str
        What is compared with what.
    unit : str
        Unit of the deviation; empty if it is dimensionless.
    limit : float
        Largest deviation with which the check passes.
    deviation : callable
        Function of `quick`, whether to compute a few cases only, that returns the largest deviation. It may raise any
        error, with which the check fails, or `NotRun`.
    """

    name: str
    meaning: str
    unit: str
    limit: float
    deviation: Callable[[bool], float]

    def run(self, *, quick: bool) -> Checked:
        """Run the check; its errors become part of the result."""
        began = monotonic()
        found, error = None, None
        try:
            found = float(self.deviation(quick))
        except Exception as raised:  # whatever is wrong with the installation
            error = raised
        return Checked(self, found, error, monotonic() - began)


@dataclass(frozen=True, eq=False)
class Checked:
    """Result of a check of the installation.

    Parameters
    ----------
    check : Check
        The check.
    found : float or None
        The largest deviation, in the unit of the check; None if it was not computed.
    error : Exception or None
        The error that ended the check; None if there was none.
    seconds : float
        Time that the check took [s].
    """

    check: Check
    found: float | None
    error: Exception | None
    seconds: float

    @property
    def passed(self) -> bool | None:
        """Whether the check passed; None if it was not run."""
        if isinstance(self.error, NotRun):
            return None
        return self.found is not None and self.found <= self.check.limit

    @property
    def why(self) -> str | None:
        """Why the check failed or was not run, in one line; None if it passed."""
        if self.passed:
            return None
        if self.error is not None:
            said = seen(str(self.error))
            if isinstance(self.error, NotRun | RockingError):
                return said
            return f"{type(self.error).__name__}: {said}" if said else type(self.error).__name__
        if self.found is None or not isfinite(self.found):
            return "values are missing, or are not numbers"
        return "the deviation exceeds the limit"


@dataclass(frozen=True)
class SelfCheck:
    """Results of all checks of the installation.

    Parameters
    ----------
    checks : tuple of Checked
        The results, in the order of the checks.
    quick : bool
        Whether only a few cases of each check were computed.
    """

    checks: tuple[Checked, ...]
    quick: bool

    @property
    def failed(self) -> tuple[Checked, ...]:
        """The checks that failed."""
        return tuple(each for each in self.checks if each.passed is False)

    @property
    def not_run(self) -> tuple[Checked, ...]:
        """The checks that were not run."""
        return tuple(each for each in self.checks if each.passed is None)

    @property
    def passed(self) -> bool:
        """Whether no check failed."""
        return not self.failed

    @property
    def seconds(self) -> float:
        """Time that all checks took [s]."""
        return sum(each.seconds for each in self.checks)
