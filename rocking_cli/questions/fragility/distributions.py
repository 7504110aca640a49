"""Probability distributions of uncertain numbers, samples of them, and their values with units."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cache, partial
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field

from rocking_cli.arrays import Reals
from rocking_cli.core import Mechanism
from rocking_cli.errors import Problem, RockingError
from rocking_cli.io.yaml_file import Document, Place
from rocking_cli.studies.file_part import Part, Sound
from rocking_cli.studies.fragility.quantities import is_quantity
from rocking_cli.units import UnitError, read

Positive = Annotated[float, Field(gt=0)]
MIN_RANDOM = 2.0**-54  # a random number may be zero, where a normal distribution has no quantile


class _Ordered(Part):
    @classmethod
    def between(cls, given: dict[str, Any], sound: Sound) -> Iterator[tuple[Place, str]]:
        """Check that the ends are in order."""
        low, high = given.get("low"), given.get("high")
        if low is not None and high is not None and sound("low") and sound("high") and low >= high:
            yield ("high",), f"must be more than low ({low:g}), got {high:g}"


class _Bounded(_Ordered):
    low: float | None = Field(None, description="smallest value: what lies below is not drawn")
    high: float | None = Field(None, description="largest value: what lies above is not drawn")

    @property
    def ends(self) -> Reals:
        """The two bounds; infinite where there is none."""
        return np.array([-np.inf if self.low is None else self.low, np.inf if self.high is None else self.high])


class Normal(_Bounded):
    """A normal distribution, truncated where `low` or `high` is given."""

    mean: float = Field(description="mean, before truncation")
    deviation: Positive = Field(description="standard deviation, before truncation")


class Lognormal(_Bounded):
    """A lognormal distribution, truncated where `low` or `high` is given."""

    median: Positive = Field(description="median, before truncation")
    dispersion: Positive = Field(description="standard deviation of the logarithm, before truncation")


class Uniform(_Ordered):
    """A uniform distribution."""

    low: float = Field(description="smallest value")
    high: float = Field(description="largest value")


class Triangular(Part):
    """A triangular distribution."""

    low: float = Field(description="smallest value")
    mode: float = Field(description="most likely value")
    high: float = Field(description="largest value")

    @classmethod
    def between(cls, given: dict[str, Any], sound: Sound) -> Iterator[tuple[Place, str]]:
        """Check that the mode lies between the ends."""
        if all(sound(name) for name in ("low", "mode", "high")):
            low, mode, high = given["low"], given["mode"], given["high"]
            if not low <= mode <= high or low == high:
                yield ("mode",), f"must lie between low ({low:g}) and high ({high:g})"


class Distribution(Part):
    """One of several distributions: a mapping with its name as the only key."""

    normal: Normal | None = None
    lognormal: Lognormal | None = None
    uniform: Uniform | None = None
    triangular: Triangular | None = None
    values: list[float] | None = Field(None, min_length=1, description="values that are equally likely")

    @classmethod
    def between(cls, given: dict[str, Any], sound: Sound) -> Iterator[tuple[Place, str]]:
        """Check that there is exactly one distribution."""
        if sum(each is not None for each in given.values()) != 1:
            yield (), f"give one distribution, of {', '.join(cls.model_fields)}"

    def quantile(self, probability: Reals) -> Reals:
        """Return the values that are not exceeded with some probabilities, each in (0, 1)."""
        if self.normal is not None:
            return _truncated_normal(probability, self.normal.mean, self.normal.deviation, self.normal.ends)
        if self.lognormal is not None:
            with np.errstate(divide="ignore"):
                ends = np.log(np.maximum(self.lognormal.ends, 0.0))
            mean = float(np.log(self.lognormal.median))
            return np.exp(_truncated_normal(probability, mean, self.lognormal.dispersion, ends))
        if self.uniform is not None:
            width = self.uniform.high - self.uniform.low
            return np.asarray(self.uniform.low + width * probability)
        if self.triangular is not None:
            low, mode, high = self.triangular.low, self.triangular.mode, self.triangular.high
            rising = low + np.sqrt(probability * (high - low) * (mode - low))
            falling = high - np.sqrt((1 - probability) * (high - low) * (high - mode))
            return np.asarray(np.where(probability < (mode - low) / (high - low), rising, falling))
        assert self.values is not None
        place = np.minimum(probability * len(self.values), len(self.values) - 1).astype(int)
        return np.asarray(np.array(self.values)[place])


def _truncated_normal(probability: Reals, mean: float, deviation: float, ends: Reals) -> Reals:
    low, high = ((ends - mean) / deviation).tolist()
    return np.asarray(mean + deviation * _standard_normal(probability, low, high))


def _standard_normal(probability: Reals, low: float, high: float) -> Reals:
    """Return quantiles of the standard normal distribution between two bounds, without underflow in its tails."""
    from scipy.special import log_ndtr, ndtri_exp

    if low > 0:  # by symmetry, as the lower tail has more digits
        upper: Reals = -_standard_normal(1 - probability, -high, -low)
        return upper
    below, above = log_ndtr(low), log_ndtr(high)
    between = above + np.log(-np.expm1(below - above))
    return np.asarray(np.clip(ndtri_exp(np.logaddexp(below, np.log(probability) + between)), low, high))


def draw(
    distribution: Distribution,
    count: int,
    *,
    seed: int,
    stream: str,
    method: Literal["random", "latin hypercube"],
) -> Reals:
    """Draw samples of a distribution.

    Parameters
    ----------
    distribution : Distribution
        The distribution.
    count : int
        Number of samples.
    seed : int
        Seed of the study.
    stream : str
        Name of the quantity that is drawn. Each name has its own stream of random numbers, so that adding another
        quantity does not change the samples of this one.
    method : {"random", "latin hypercube"}
        Independent draws, or one in each of `count` equally likely ranges, in random order.
    """
    rng = np.random.default_rng([seed, *stream.encode()])
    uniform = rng.random(count)
    if method == "latin hypercube":
        uniform = (rng.permutation(count) + uniform) / count
    with np.errstate(over="ignore"):  # overflow gives infinity, from which no structure can be built
        return distribution.quantile(np.clip(uniform, MIN_RANDOM, 1 - 2 * MIN_RANDOM))


DIMENSIONLESS = ("dispersion",)  # parameters of a distribution without a unit


def in_units_of_fields(document: Document, load: Callable[[str], Mechanism]) -> list[Problem]:
    """Convert texts with units in the distributions of a study to numbers; return the problems with them.

    Parameters
    ----------
    document : Document
        The study; its data are changed. Values that are not texts with a unit stay as they are.
    load : callable
        Returns the structure of a file that the study names.
    """
    entries = document.data.get("structures")
    problems: list[Problem] = []
    of_file = cache(load)
    for k, entry in enumerate(entries if isinstance(entries, list) else []):
        varied = entry.get("vary") if isinstance(entry, dict) else None
        if not isinstance(varied, dict) or not isinstance(entry.get("file"), str):
            continue
        for name, distribution in varied.items():
            unit = partial(_unit, name, of_file, entry["file"])
            try:
                varied[name] = _numbers(document, distribution, unit, ("structures", k, "vary", name), problems)
            except RockingError:  # the problem is reported when the study itself is read
                break
    return problems


def _unit(name: str, load: Callable[[str], Mechanism], file: str) -> str:
    """Return the unit of a field of the structure of a file; empty if it has none."""
    info = type(load(file)).model_fields.get(name)
    extra = info.json_schema_extra if info is not None else None
    return str(extra.get("unit", "")) if isinstance(extra, dict) else ""


def _numbers(document: Document, value: Any, unit: Callable[[], str], place: Place, problems: list[Problem]) -> Any:
    if isinstance(value, dict):
        return {key: _numbers(document, each, unit, (*place, key), problems) for key, each in value.items()}
    if isinstance(value, list):
        return [_numbers(document, each, unit, (*place, k), problems) for k, each in enumerate(value)]
    if not is_quantity(value):
        return value
    wanted = unit()
    try:
        return read(value, "" if place[-1] in DIMENSIONLESS else wanted)
    except UnitError as error:
        problems.append(document.at(place, error.message, error.hint))
        return value
