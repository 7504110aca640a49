"""A target spectrum from a file: ordinates at periods, with linear interpolation between them."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from rocking_cli.arrays import Reals
from rocking_cli.errors import InputError, Problem, named
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.excitation.records.record_units import header_units
from rocking_cli.short_repr import short_repr
from rocking_cli.studies.file_part import read_points, separator_in
from rocking_cli.text import did_you_mean
from rocking_cli.units import CHOICES, UNITS, header_unit
from rocking_cli.verification.check import demand
from rocking_cli.verification.code import SiteFile

COLUMNS = "a line has two columns with a comma between: period [s], Sa [g]"
MAX_ORDINATE = 10.0  # g; no code requires more

_OTHER_PERIOD = re.compile(r"\b(?:m(?:illi)?s(?:ec)?|min(?:utes?)?|k?hz|freq\w*)\b", re.IGNORECASE)
_BRACKETS = re.compile(r"[\[(]\s*([^\])]*?)\s*[\])]")
_BARE_G = re.compile(r"(?:^|[\s_,/])g\s*$", re.IGNORECASE)


@short_repr
@dataclass(frozen=True, eq=False)
class TargetSpectrum:
    """Pseudo-accelerations as a function of period, linear between the points as in the tables of codes.

    Parameters
    ----------
    name : str
        Name of the spectrum.
    periods : ndarray, shape (n,)
        Periods, increasing and not negative [s].
    sa : ndarray, shape (n,)
        Ordinates, not negative [standard gravity].
    unit : str or None
        Unit in which the ordinates were given; None if the file does not state it.
    formula : callable, optional
        Returns the ordinate at a period [s; standard gravity], where it is known between the points too.

    Raises
    ------
    InputError
        If periods or ordinates violate these conditions, or there are fewer than two points.
    """

    name: str
    periods: Reals
    sa: Reals
    unit: str | None = "g"
    formula: Callable[[float], float] | None = None

    def __post_init__(self) -> None:
        if problems := wrong_points(self.periods, self.sa):
            raise InputError(*(f"{self.name}, point {k + 1}: {message}" for k, message in problems))

    def at(self, periods: Reals) -> Reals:
        """Return the ordinates at periods [s] within the range of the spectrum [standard gravity]."""
        if self.formula is not None:
            return np.array([self.formula(T) for T in periods.tolist()])
        return np.interp(periods, self.periods, self.sa)

    def check(self, band: tuple[float, float]) -> None:
        """Raise `InputError` if the spectrum does not cover a band of periods [s], or is zero inside it."""
        first, last = float(self.periods[0]), float(self.periods[-1])
        if not (first <= band[0] and band[1] <= last):
            message = f"the target goes from {first:g} to {last:g} s, and the band from {band[0]:g} to {band[1]:g} s"
            hint = (
                f"choose a {named('band')} within the target, or give a target that covers it: the target "
                "is not extrapolated"
            )
            raise InputError(Problem(message, self.name, hint=hint))
        inside = (self.periods > band[0]) & (self.periods < band[1])
        known = np.concatenate([[band[0]], self.periods[inside], [band[1]]])
        ordinates = self.at(known)
        if not (ordinates > 0).all():
            where = float(known[np.argmin(ordinates)])
            hint = f"records cannot be scaled to zero: choose a {named('band')} in which the target is positive"
            raise InputError(Problem(f"the target is zero at {where:g} s", self.name, hint=hint))


def wrong_points(periods: Reals, sa: Reals) -> list[tuple[int, str]]:
    """Return the invalid points of a spectrum, counted from 0, each with a message."""
    if periods.shape != sa.shape or periods.ndim != 1:
        return [(min(periods.size, sa.size), "a period without an ordinate, or an ordinate without a period")]
    problems = []
    for k, (period, value) in enumerate(zip(periods.tolist(), sa.tolist(), strict=True)):
        before = periods[k - 1] if k else -math.inf
        if not 0 <= period < math.inf:
            problems.append((k, f"the period is {period:g} s, it must not be negative"))
        elif period == before:
            problems.append((k, f"the period {period:g} s occurs twice: give one ordinate per period"))
        elif period < before:
            problems.append(
                (k, f"the period {period:g} s is less than the {before:g} s before it: periods must increase")
            )
        if not 0 <= value < math.inf:
            problems.append((k, f"the ordinate is {value:g}, it must not be negative"))
    return problems or ([(periods.size, "at least two are needed")] if periods.size < 2 else [])


def read_target(path: Path) -> TargetSpectrum:
    """Read a target spectrum from a file of two columns.

    Parameters
    ----------
    path : Path
        A file whose lines each have a period [s] and an ordinate, separated by a comma, a semicolon or blanks. A
        heading above the numbers may name the unit of the ordinates; without it they are in g. Blank lines, and lines
        that begin with #, are skipped.

    Returns
    -------
    TargetSpectrum

    Raises
    ------
    InputError
        With file and line.
    """
    periods, sa, unit = read_points(path, "target spectrum", COLUMNS, wrong_points, _remedy, _unit)
    return TargetSpectrum(str(path), periods, sa * UNITS[unit or "g"] / STANDARD_GRAVITY, unit)


def target_of_site(site: SiteFile, state: str | None, damping: float) -> TargetSpectrum:
    """Return the elastic spectrum of the ground of a site by its code, at a limit state.

    Parameters
    ----------
    site : SiteFile
        The site.
    state : str or None
        The limit state; None for that which decides.
    damping : float
        Damping ratio of the spectrum.

    Raises
    ------
    InputError
        If the code has no spectra, or the site does not give the limit state.
    """
    spectra = demand(site)
    state = spectra.first if state is None else state
    if state not in spectra.states:
        message, hint = f"the site gives no limit state {state!r}", did_you_mean(state, [*spectra.states])
        raise InputError(Problem(message, site.document.file, field=named("state"), hint=hint))
    ground, corners = spectra.states[state].ground, spectra.states[state].corners

    def ordinate(period: float) -> float:
        return ground.acceleration(period, damping) / STANDARD_GRAVITY

    periods = np.unique([*corners, spectra.states[state].last])
    sa = np.array([ordinate(T) for T in periods.tolist()])
    where = "" if spectra.states[state].floor is None else ", at the ground below its floor"
    return TargetSpectrum(f"{state} of {site.site.name or site.document.file}{where}", periods, sa, formula=ordinate)


def _remedy(message: str) -> str:
    if "negative" in message:
        return "correct or leave out this line"
    return "put the lines in the order of their periods, each once; a step needs two periods a little apart"


def _unit(file: str, number: int, line: str) -> str | None:
    """Return the unit of the ordinates that a heading names; None if it names none."""
    separator = separator_in(line)
    cells: Sequence[str] = line.split(separator) if separator else [line, line]
    if _OTHER_PERIOD.search(cells[0].replace("_", " ")):
        message = "the first column must hold periods in s"
        hint = "turn frequencies or other units into periods in s first, the shortest in the first line"
        raise InputError(Problem(message, file, number, excerpt=line.strip()[:100], hint=hint))
    heading = cells[1] if len(cells) > 1 else ""
    units = {header_unit(word) for word in _BRACKETS.findall(heading)} - {None} or set(header_units(heading))
    if not units and _BARE_G.search(heading):
        units = {"g"}
    if len(units) == 1:
        return units.pop()
    named = [word for word in _BRACKETS.findall(heading) if word.lower() not in ("", "-", "s", "sec")]
    if units or named:
        message = f"the heading gives '{(named or ['more than one unit'])[-1]}', no unit of acceleration known here"
        hint = f"ordinates are in one of: {CHOICES}; without a unit in g"
        raise InputError(Problem(message, file, number, excerpt=line.strip()[:100], hint=hint))
    return None
