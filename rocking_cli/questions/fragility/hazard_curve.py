"""The annual rate at which a limit state is exceeded, from a fragility curve and a hazard curve."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np

from rocking_cli.arrays import Reals
from rocking_cli.errors import DoubtWarning, InputError, Problem, warn
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.excitation.records.text import numbers_in
from rocking_cli.io.files import read_bytes
from rocking_cli.questions.fragility.curves import FragilityCurve
from rocking_cli.questions.fragility.observed import INTENSITY_TOLERANCE
from rocking_cli.short_repr import short_repr
from rocking_cli.studies.file_part import MAX_BYTES, read_points

NODES_PER_PIECE = 16  # nodes of Gauss's rule in a piece
PIECE_WIDTH = 0.05  # width of a piece in ln x: a curve of dispersion 0.02 is still smooth within it
REFERENCE_LIFE = 50.0  # years
WHAT = "hazard curve"
OF_OPENQUAKE = "poe-"  # begins each heading of a probability of exceedance, before the intensity
# Intensity measure types of OpenQuake, and their units in one unit of here: PGV is in m/s here, there in cm/s.
TYPES: Mapping[str, tuple[str, float]] = {
    "PGA": ("PGA", 1.0),
    "PGV": ("PGV", 100.0),
    "PGD": ("PGD", 100.0),
    "Arias": ("IA", 1.0),
    "CAV": ("CAV", 1 / STANDARD_GRAVITY),
}
SPECTRAL_MEASURE = re.compile(r"SA\(\s*([0-9.]+)\s*s?\s*\)", re.IGNORECASE)  # values in g, here as in OpenQuake


def intensity_type(measure: str) -> tuple[str, float] | None:
    """Return the name of a measure in OpenQuake, and the factor to its unit; None if OpenQuake lacks the measure."""
    if spectral := SPECTRAL_MEASURE.fullmatch(measure):
        return f"SA({float(spectral[1]):g})", 1.0
    return TYPES.get(measure)


@short_repr
@dataclass(frozen=True, eq=False)
class HazardCurve:
    """Annual rate at which an intensity is exceeded at a site: straight lines in log-log between points.

    Parameters
    ----------
    intensity : ndarray, shape (n,)
        Intensities, positive and increasing, in the measure and the unit of the fragility curve.
    annual_rate : ndarray, shape (n,)
        Rates of exceedance at these intensities, positive and never increasing [1/year].
    """

    intensity: Reals
    annual_rate: Reals

    @property
    def first_slope(self) -> float:
        """The exponent k of the power law between the first two points."""
        (x0, x1), (rate0, rate1) = self.intensity[:2], self.annual_rate[:2]
        return float(np.log(rate0 / rate1) / np.log(x1 / x0))

    def rate(self, x: Reals) -> Reals:
        """Return the annual rate of exceeding the intensity x [1/year]; NaN outside the points."""
        logs = np.log(self.intensity), np.log(self.annual_rate)
        return np.exp(np.interp(np.log(x), *logs, left=np.nan, right=np.nan))


def wrong_points(intensity: Reals, rate: Reals) -> list[tuple[int, str]]:
    """Return the invalid points of a hazard curve, counted from 0, each with a message."""
    problems = []
    for k, (x, value) in enumerate(zip(intensity, rate, strict=True)):
        if not 0 < x < math.inf:
            problems.append((k, f"the intensity is {x:g}, it must be positive"))
        elif not 0 < value < math.inf:
            problems.append((k, f"the annual rate is {value:g}, it must be positive"))
        elif k and x <= intensity[k - 1]:
            problems.append((k, f"the intensity {x:g} does not exceed the {intensity[k - 1]:g} before it"))
        elif k and value > rate[k - 1]:
            problems.append((k, f"the annual rate {value:g} is above the {rate[k - 1]:g} at the lower intensity"))
    return problems or ([(intensity.size, "at least two are needed")] if intensity.size < 2 else [])


def read_hazard(path: Path, measure: str) -> HazardCurve:
    """Read a hazard curve from a file of two columns, or from an export of OpenQuake.

    Parameters
    ----------
    path : Path
        A file whose lines each have an intensity and an annual rate, separated by a comma. One heading, blank lines,
        and lines that begin with # are skipped. Or the hazard curve of one site as OpenQuake exports it: a comment, a
        heading with the intensities, and a line with the probabilities of exceedance in the investigation time.
    measure : str
        Measure of the intensities; that of OpenQuake must be the same, and is converted to the unit of this one.

    Returns
    -------
    HazardCurve

    Raises
    ------
    InputError
        With file and line.
    """
    lines = read_bytes(path, WHAT, MAX_BYTES).decode("utf-8-sig", "replace").splitlines()
    rows = [(k, line) for k, line in enumerate(lines, 1) if line.strip() and not line.startswith("#")]
    if rows and OF_OPENQUAKE in rows[0][1]:
        return _of_openquake(str(path), lines[0], rows, measure)
    columns = "two are needed with a comma between: intensity, annual rate"
    intensity, rate, _ = read_points(path, WHAT, columns, wrong_points)
    return HazardCurve(intensity, rate)


def _of_openquake(file: str, comment: str, rows: Sequence[tuple[int, str]], measure: str) -> HazardCurve:
    """Return the annual rates of the probabilities of exceedance that OpenQuake exports for a site."""
    years, there = (re.search(rf"{key}=['\"]*([^'\",]+)", comment) for key in ("investigation_time", "imt"))
    if years is None or there is None or not float(years[1]) > 0:
        hint = "keep the line that OpenQuake writes above the heading"
        raise InputError(Problem("investigation_time or imt is missing, or is not positive", file, 1, hint=hint))
    name, factor = intensity_type(measure) or (measure, 1.0)
    if (intensity_type(there[1]) or (there[1],))[0] != name:  # SA(1.0) is SA(1) as well
        hint = f"export the curve of {name}, or set the measure of the hazard"
        raise InputError(Problem(f"the intensities are {there[1]}, but the hazard is in {measure}", file, 1, hint=hint))
    if len(rows) != 2:
        hint = "keep the two lines above the sites, and the line of yours"
        raise InputError(Problem(f"{len(rows) - 1} sites, one is needed", file, hint=hint))
    (above, line), (number, site) = rows
    heads, cells = csv.reader([line, site])
    if len(cells) != len(heads):
        raise InputError(Problem(f"{len(cells)} columns, but the heading has {len(heads)}", file, number))
    levels = {k: head.removeprefix(OF_OPENQUAKE) for k, head in enumerate(heads) if head.startswith(OF_OPENQUAKE)}
    x = np.array(numbers_in(file, above, line, list(levels.values())))
    poe = np.array(numbers_in(file, number, site, [cells[k] for k in levels]))
    finite = (poe != 0) & (poe != 1)
    if not finite.all():
        cut = ", ".join(f"{each:g}" for each in x[~finite])
        warn(DoubtWarning(f"{file}: probabilities of 0 or 1 have no annual rate: left out at {there[1]} = {cut}"))
    with np.errstate(invalid="ignore"):
        curve = HazardCurve(x[finite] / factor, -np.log1p(-poe[finite]) / float(years[1]))
    if wrong := wrong_points(curve.intensity, curve.annual_rate):
        raise InputError(*(Problem(message, file, number) for _, message in wrong))
    return curve


@dataclass(frozen=True)
class Rate:
    """Annual rate at which a limit state is exceeded.

    Parameters
    ----------
    rate : float
        The integral of `P(x) |d rate(x)|` over the hazard curve; beyond its last point, P keeps its value there
        [1/year].
    low, high : float
        The rates with the confidence limits of the curve in place of the curve: at least as wide as the confidence
        level asks, because all points reach their limit at once. The hazard curve counts as exact [1/year].
    above : float
        Upper bound of the additional rate from intensities beyond the last point, if P is one there [1/year].
    below : float
        Additional rate from intensities below the first point, if the first slope of the hazard curve continues;
        infinite for a curve that does not vanish at zero intensity [1/year].
    """

    rate: float
    low: float
    high: float
    above: float
    below: float

    @property
    def return_period(self) -> float:
        """Return period of the exceedance [years]; infinite at a rate of zero."""
        return 1 / self.rate if self.rate > 0 else math.inf

    @property
    def in_50_years(self) -> float:
        """Probability of at least one exceedance in 50 years, as events of a Poisson process."""
        return -math.expm1(-REFERENCE_LIFE * self.rate)


def annual_rate(curve: FragilityCurve, hazard: HazardCurve) -> Rate:
    """Compute the annual rate of exceedance from a fragility curve and a hazard curve.

    Parameters
    ----------
    curve : FragilityCurve
        A curve over the measure of the hazard curve, in the same unit, and not of kind `none`.
    hazard : HazardCurve
        The hazard curve of the site.

    Notes
    -----
    The integral is by Gauss's rule in pieces of ln x. For a lognormal curve and one power law, rate = k0 x^-k, it is
    rate(median) exp(k^2 dispersion^2/2) [Cornell et al. 2002, J. Struct. Eng. 128, 526-533].
    """
    last = float(hazard.annual_rate[-1])
    if curve.step is not None and not curve.implied:
        first, end = hazard.intensity[[0, -1]]  # the rate is constant below the first point, and zero beyond the last
        at, low, high = (
            0.0 if x > end * (1 + INTENSITY_TOLERANCE) else float(hazard.rate(np.clip([x], first, end))[0])
            for x in (curve.step.value, curve.step.high, curve.step.low)
        )
        above = last if curve.step.value > hazard.intensity[-1] * (1 + INTENSITY_TOLERANCE) else 0.0
        return Rate(at, low, high, above, _beyond(hazard, curve.step.value))
    jumps = [x for step in curve.steps for x in (step.low, step.value, step.high)]
    at_end = [float(p) for p in curve.lines(hazard.intensity[-1])]
    within = _integrals(hazard, curve.lines, jumps)
    rate, low, high = (integral + p * last for integral, p in zip(within, at_end, strict=True))
    below = min(_below(each, hazard) for each in (curve.own, *curve.implied.values()))
    return Rate(rate, low, high, (1 - at_end[0]) * last, below)


def _integrals(hazard: HazardCurve, lines: Callable[[Reals], Reals], jumps: Sequence[float]) -> list[float]:
    """Return the integral of P |d rate| between the ends of the hazard curve, for each of several P [1/year]."""
    nodes, weights = np.polynomial.legendre.leggauss(NODES_PER_PIECE)
    logs = np.log(hazard.intensity)
    pieces = [
        np.linspace(start, stop, max(1, math.ceil((stop - start) / PIECE_WIDTH)), endpoint=False)
        for start, stop in pairwise(logs)
    ]
    ends = np.concatenate([*pieces, logs[-1:]])
    ends = np.union1d(ends, [x for x in np.log(jumps) if logs[0] < x < logs[-1]])  # P is smooth between these ends
    half, middle = np.diff(ends)[:, None] / 2, (ends[:-1, None] + ends[1:, None]) / 2
    at = middle + half * nodes
    slope = -np.diff(np.log(hazard.annual_rate)) / np.diff(logs)  # k of each power law
    k = slope[np.searchsorted(logs, middle, side="right") - 1]
    x = np.exp(at)
    return [float((half * weights * p * k * hazard.rate(x)).sum()) for p in lines(x)]


def _beyond(hazard: HazardCurve, at: float) -> float:
    """Return the rate that a step below the first point adds, if the first power law continues [1/year]."""
    if at >= hazard.intensity[0]:
        return 0.0
    first = float(hazard.annual_rate[0])
    return first * float((hazard.intensity[0] / at) ** hazard.first_slope) - first


def _below(curve: FragilityCurve, hazard: HazardCurve) -> float:
    """Return the rate that intensities below the first point add to a curve without its cuts [1/year].

    The first power law continues there.
    """
    if curve.step is not None:
        return _beyond(hazard, curve.step.value)
    from scipy.special import log_ndtr, ndtr

    k = hazard.first_slope
    if k == 0:
        return 0.0
    if curve.dispersion is None or curve.median is None:
        return math.inf  # a logistic curve is positive at zero intensity, where the rate of the power law is infinite
    beta = curve.dispersion.value
    z = math.log(hazard.intensity[0] / curve.median.value) / beta
    # The integral of Phi(z) k rate d ln x from zero to the first point, by parts and by completing the square.
    with np.errstate(over="ignore"):
        whole = np.exp(k * beta * z + (k * beta) ** 2 / 2 + log_ndtr(z + k * beta))
    return float(hazard.annual_rate[0] * max(whole - ndtr(z), 0.0))
