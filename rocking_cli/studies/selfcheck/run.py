"""The checks of an installation, and the run of all of them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from importlib import import_module

from rocking_cli.studies.selfcheck.check import Check, SelfCheck


def _of(module: str, name: str, quick: bool) -> float:
    """Call a function of a module, which is imported in the check: even this may fail."""
    found: float = getattr(import_module(f"{__package__}.{module}"), name)(quick)
    return found


CHECKS = (
    Check(
        "release",
        "Times of the first eight impacts of released blocks, against quadrature of the first integral",
        "s",
        1e-9,
        partial(_of, "released", "deviation"),
    ),
    Check(
        "pulses",
        "Amplitudes of sine pulses that overturn a linear block, against Eqs. 41-42",
        "",
        1e-12,
        partial(_of, "thresholds", "deviation"),
    ),
    Check(
        "histories",
        "Times of uplift, impacts and overturning under ground motions, against the solver of SciPy",
        "s",
        1e-9,
        partial(_of, "integrated", "deviation"),
    ),
    Check(
        "records",
        "Samples read from a small file of each record format, against those written",
        "",
        1e-12,
        partial(_of, "records", "deviation"),
    ),
    Check(
        "records_by_obspy",
        "Samples read from SAC and miniSEED files by obspy, against those written",
        "",
        1e-12,
        partial(_of, "records", "deviation_by_obspy"),
    ),
    Check(
        "threads",
        "Outcomes of batches in several threads, against those in one thread, bit for bit",
        "values",
        0.0,
        partial(_of, "threads", "deviation"),
    ),
    Check(
        "kernels",
        "Shipped machine code, against its source run by Python, bit for bit",
        "values",
        0.0,
        partial(_of, "shipped_kernels", "deviation"),
    ),
)


def run_checks(checks: Sequence[Check], *, quick: bool, progress: Callable[[int, int], None]) -> SelfCheck:
    """Run checks, whatever becomes of each.

    Parameters
    ----------
    checks : sequence of Check
        The checks to run.
    quick : bool
        Whether to compute a few cases of each check only.
    progress : callable
        Called after each check with 1, and with 1 if it failed or else 0.
    """
    found = []
    for check in checks:
        found.append(check.run(quick=quick))
        progress(1, int(found[-1].passed is False))
    return SelfCheck(tuple(found), quick)
