"""The runs of a study, numbered: which structure, record, restitution, level and polarity each number stands for."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import nan, prod

import numpy as np
from numpy.typing import NDArray

from rocking_cli.core import Equivalence, EquivalentBlock
from rocking_cli.dynamics.model import ModelName
from rocking_cli.processing.intensity import Reference, parse_measure
from rocking_cli.studies.fragility.intensity import PGA, PGV, SCALE
from rocking_cli.studies.fragility.measured import Measured
from rocking_cli.studies.fragility.sets import Sets
from rocking_cli.studies.fragility.sources import Record
from rocking_cli.studies.under_pulses import uplift

Reals = NDArray[np.float64]
Integers = NDArray[np.int64]


@dataclass(frozen=True)
class Trial:
    """One sample of a structure in a study, with its parameters.

    Parameters
    ----------
    structure : str
        The structure's name.
    number : int
        Number of the sample, from 0.
    drawn : dict of str to float
        The sampled fields, by name.
    reason : str or None
        Why the sample cannot be simulated; None if it can.
    p : float
        Frequency parameter [rad/s], 0 if there is no equivalent block. This and all further fields are 0 if the sample
        cannot be simulated.
    lambda_ : float
        Uplift acceleration of the model over g.
    gravity : float
        Gravitational acceleration [m/s2].
    phi_cr_positive, phi_cr_negative : float
        Critical rotations [rad]; the kinematic limit if there is no critical rotation.
    """

    structure: str
    number: int
    drawn: dict[str, float]
    reason: str | None = None
    p: float = 0.0
    lambda_: float = 0.0
    gravity: float = 0.0
    phi_cr_positive: float = 0.0
    phi_cr_negative: float = 0.0


def weaker(equivalence: Equivalence, model: ModelName) -> tuple[float, float]:
    """Return p and lambda of the direction that uplifts first, the reference of dimensionless measures."""
    block = weaker_block(equivalence, model)
    return block.p, uplift(block, model)


def weaker_block(equivalence: Equivalence, model: ModelName) -> EquivalentBlock:
    """Return the equivalent block of the direction that uplifts first."""
    return min((equivalence.positive, equivalence.negative), key=lambda each: uplift(each, model))


@dataclass(frozen=True, eq=False)
class Plan:
    """All runs of a study, numbered with the polarity changing fastest, then level, restitution, record and sample.

    Parameters
    ----------
    trials : sequence of Trial
        The samples of the structures.
    records : sequence of Record
        The ground motions.
    etas : sequence of float
        Coefficients of restitution; NaN for the one of the structure.
    measure : str
        Measure of the levels, or "scale" for factors on the records.
    levels : sequence of float
        The levels.
    polarities : sequence of int
        The polarities: 1, -1 or both.
    measured : Measured
        Values measured beyond the peaks of the records.
    sets : Sets, optional
        The levels and the weight of each record; without it every record is run at all levels, with equal weight.
    """

    trials: Sequence[Trial]
    records: Sequence[Record]
    etas: Sequence[float]
    measure: str
    levels: Sequence[float]
    polarities: Sequence[int]
    measured: Measured = field(default_factory=Measured)
    sets: Sets | None = None

    @property
    def of_sets(self) -> Sets:
        """The levels at which each record is run, and its weight."""
        return self.sets if self.sets is not None else Sets.plain(len(self.records))

    @property
    def structures(self) -> list[str]:
        """Names of the structures, in the order of the study."""
        return list(dict.fromkeys(trial.structure for trial in self.trials))

    @property
    def shape(self) -> tuple[int, int, int, int, int]:
        """Numbers of samples, records, restitutions, levels and polarities."""
        return len(self.trials), len(self.records), len(self.etas), len(self.levels), len(self.polarities)

    @property
    def block(self) -> int:
        """Number of runs of one sample under one record; their numbers are consecutive."""
        return prod(self.shape[2:])

    @property
    def total(self) -> int:
        """Number of runs that can be simulated: without samples and records that cannot be used."""
        _, _, etas, levels, polarities = self.shape
        usable = sum(each.reason is None for each in self.trials)
        places = [k for k, each in enumerate(self.records) if each.reason is None]
        rungs = sum(int(self.of_sets.there(k, levels).sum()) for k in places)
        return usable * rungs * etas * polarities

    @property
    def size(self) -> int:
        """Number of all combinations, whether or not they can be simulated."""
        return prod(self.shape)

    def name(self, run: int) -> str:
        """Describe a run in words."""
        if not 0 <= run < self.size:
            return f"run {run}, which the study does not have"
        sample, record, _, level, polarity = (int(place[0]) for place in self.places(np.array([run])))
        trial = self.trials[sample]
        return (
            f"run {run} ({trial.structure}, sample {trial.number}, {self.records[record].name}, "
            f"level {self.levels[level]:.6g}, polarity {self.polarities[polarity]:+d})"
        )

    def places(self, runs: Integers) -> tuple[Integers, Integers, Integers, Integers, Integers]:
        """Return the indices of sample, record, restitution, level and polarity of runs."""
        sample, record, eta, level, polarity = np.unravel_index(runs, self.shape)
        return sample, record, eta, level, polarity

    def reference(self, sample: Integers) -> Reference:
        """Return the reference values of dimensionless measures for samples given by their indices."""
        columns = np.array([(each.p, each.lambda_, each.gravity) for each in self.trials])[sample]
        p = np.where(columns[:, 0] > 0, columns[:, 0], np.nan)
        steps = self.measured.of_sample.get("v_imp", np.full(len(self.trials), nan))
        return Reference(p, columns[:, 1], columns[:, 2], steps[sample])

    def of_records(self, measure: str) -> Reals:
        """Return a measure of the unscaled motions, shape (records,); NaN where it is not known."""
        if measure in (PGA, PGV):
            return np.array([each.pga if measure == PGA else each.pgv for each in self.records])
        return self.measured.of_record.get(measure, np.full(len(self.records), nan))

    def intensities(
        self, measure: str, sample: Integers, record: Integers, level: Integers, factor: float | Reals
    ) -> Reals:
        """Return the intensity of runs, from their indices and the factors on the records; NaN if not known."""
        asked = parse_measure(measure)
        if asked.base is None or asked.power is None:
            table = self.measured.of_run.get(str(asked), np.full((len(self.trials), len(self.records), 1), nan))
            return np.asarray(table[sample, record, np.minimum(level, table.shape[2] - 1)])
        value = self.of_records(str(asked.base))[record] * np.power(factor, asked.power)
        return np.asarray(asked.relative(value, self.reference(sample)), dtype=np.float64)

    def factors(self, sample: Integers, record: Integers, level: Integers) -> Reals:
        """Return the factors that scale records to levels, for indices of one shape."""
        wanted = np.array(self.levels)[level]
        if self.sets is not None and not self.sets.scaled:
            return np.ones(wanted.shape)
        if self.measure == SCALE:
            return wanted
        power = parse_measure(self.measure).power
        assert power is not None
        ratio = wanted / self.intensities(self.measure, sample, record, level, 1.0)
        return np.asarray(ratio if power == 1 else ratio ** (1 / power))
