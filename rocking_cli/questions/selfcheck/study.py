"""Checks that this installation computes correctly: what a check is, all checks, and the run of them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from importlib import import_module
from math import isfinite
from time import monotonic
from typing import NamedTuple

from rocking_cli.errors import RockingError
from rocking_cli.short_repr import short_repr
from rocking_cli.text import seen

NO_KERNEL = ("blocks", "joints", "filters", "records", "records_by_obspy", "units", "kernels", "pages")
"""Checks that do not use the compiled kernels, or choose the engine themselves."""


class NotRun(Exception):
    """Reason why a check cannot be run on this machine, though nothing is wrong: an extra that is not installed."""


@short_repr
class Check(NamedTuple):
    """A check of the installation.

    Parameters
    ----------
    name : str
        Name of the check: that of a function of `checks`.
    meaning : str
        What is compared with what.
    unit : str
        Unit of the deviation; empty if it is dimensionless.
    limit : float
        Largest deviation with which the check passes.
    """

    name: str
    meaning: str
    unit: str
    limit: float

    def run(self, *, quick: bool) -> Checked:
        """Run the check; its errors become part of the result."""
        began = monotonic()
        largest, error = None, None
        try:
            largest = deviation(self.name, quick)
        except Exception as raised:  # any fault of the installation
            error = raised
        return Checked(self, largest, error, monotonic() - began)


def deviation(name: str, quick: bool) -> float:
    """Return the largest deviation of a check. Raises any error, or `NotRun`."""
    checks = import_module(f"{__package__}.checks")  # in the check: even this may fail
    if name not in NO_KERNEL and checks.another_way():
        raise NotRun("the machine code is broken, see `kernels`: Python would compute this instead")
    return float(getattr(checks, name)(quick))


@short_repr
class Checked(NamedTuple):
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
        if self.error is None:
            missing = self.found is None or not isfinite(self.found)
            return "values are missing, or are not numbers" if missing else "the deviation exceeds the limit"
        kind = "" if isinstance(self.error, NotRun | RockingError) else type(self.error).__name__
        return ": ".join(filter(None, (kind, seen(str(self.error)))))


@short_repr
class SelfCheck(NamedTuple):
    """Results of all checks of the installation.

    Parameters
    ----------
    checks : tuple of Checked
        The results, in the order of the checks.
    quick : bool
        Whether only a few cases of each check were computed.
    seconds : float
        Time from the beginning to the end, with all that had to be loaded or compiled [s].
    """

    checks: tuple[Checked, ...]
    quick: bool
    seconds: float

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


def _check(line: str) -> Check:
    """Return the check of a line: its name, its limit with a unit, and after a colon its meaning."""
    head, meaning = line.split(": ", 1)
    name, limit, *unit = head.split()
    return Check(name, meaning, "".join(unit), float(limit))


CHECKS = tuple(
    map(
        _check,
        """\
release 1e-9 s: Times of the first eight impacts of released blocks and walls, against quadrature of the first integral
pulses 1e-12: Amplitudes of sine pulses that overturn a linear block, against formulas of its motion
histories 1e-9 s: Times of uplift, impacts and overturning under ground motions, against the solver of SciPy
blocks 1e-9: Equivalent blocks of five structures, against formulas and values of other programs
neighbours 0.006: Shares of neighbours that overturn, and their restitution, against normal distributions
joints 1e-5 m/s2: Forces at the corner of a rocking block, as tabulated, against Newton's law
openings 1.4e-3 s: Times at which a block first slides, and from which its motion is unknown, by formulas
filters 1e-9: Amplitudes of filtered sines, against those of Butterworth filters in closed form
records 1e-12: Samples read from small files of each record format and unit, against those written
records_by_obspy 1e-12: Samples read from SAC and miniSEED files by obspy, against those written
units 1e-15: Sizes of all units of quantities, against those of their definitions
threads 0 values: Outcomes of batches in several threads and in one: equal bits, and none is missing
kernels 0 values: Shipped machine code and its source run by Python: equal bits
pages 0 files: The kernels that pages run in a browser, against the hash of the file as shipped
""".splitlines(),
    )
)


def run_checks(
    checks: Sequence[Check], *, quick: bool, progress: Callable[[int, int], None], began: float
) -> SelfCheck:
    """Run checks, whatever becomes of each.

    Parameters
    ----------
    checks : sequence of Check
        The checks to run.
    quick : bool
        Whether to compute a few cases of each check only.
    progress : callable
        Called after each check with 1, and with 1 if it failed or else 0.
    began : float
        Reading of `time.monotonic` at the beginning [s].
    """
    results = []
    for check in checks:
        results.append(check.run(quick=quick))
        progress(1, int(results[-1].passed is False))
    return SelfCheck(tuple(results), quick, monotonic() - began)
