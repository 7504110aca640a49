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
    """What a study knows of one sample of a structure.

    Parameters
    ----------
    structure : str
        The structure's name.
    number : int
        Which sample of it, from 0.
    drawn : dict of str to float
        The fields that were drawn.
    reason : str or None
        Why it cannot be run; None if it can.
    p : float
        Frequency parameter [rad/s], 0 if no block is equivalent; this and the rest are 0 if it cannot be run.
    lambda_ : float
        Uplift acceleration over g that the model keeps.
    gravity : float
        [m/s2].
    phi_cr_positive, phi_cr_negative : float
        Critical rotations [rad]; the kinematic limit where there is none.
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
    """p and lambda of the direction that uplifts first: what the dimensionless measures refer to."""
    block = weaker_block(equivalence, model)
    return block.p, uplift(block, model)


def weaker_block(equivalence: Equivalence, model: ModelName) -> EquivalentBlock:
    """The equivalent block of the direction that uplifts first."""
    return min((equivalence.positive, equivalence.negative), key=lambda each: uplift(each, model))


@dataclass(frozen=True, eq=False)
class Plan:
    """All combinations, numbered with the polarity changing fastest, then level, restitution, record and sample.

    Parameters
    ----------
    trials : sequence of Trial
        The samples of the structures.
    records : sequence of Record
        The ground motions.
    etas : sequence of float
        Restitutions; NaN for the structure's own.
    measure : str
        What the levels are of: a measure, or "scale".
    levels : sequence of float
        The levels.
    polarities : sequence of int
        Of 1 and -1.
    measured : Measured
        What was measured beyond the peaks of the records.
    sets : Sets, optional
        Which records are run at which levels, and how much they count; without it all at all, and alike.
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
        """Which records are run at which levels, and how much they count."""
        return self.sets if self.sets is not None else Sets.plain(len(self.records))

    @property
    def shape(self) -> tuple[int, int, int, int, int]:
        """How many samples, records, restitutions, levels and polarities there are."""
        return len(self.trials), len(self.records), len(self.etas), len(self.levels), len(self.polarities)

    @property
    def block(self) -> int:
        """Runs of one sample under one record: they stand together."""
        return prod(self.shape[2:])

    @property
    def total(self) -> int:
        """How many runs can be run: not those of samples and records that cannot be used."""
        _, _, etas, levels, polarities = self.shape
        usable = sum(each.reason is None for each in self.trials)
        places = [k for k, each in enumerate(self.records) if each.reason is None]
        rungs = sum(int(self.of_sets.there(k, levels).sum()) for k in places)
        return usable * rungs * etas * polarities

    @property
    def size(self) -> int:
        """How many numbers there are: of runs that can be run and of those that cannot."""
        return prod(self.shape)

    def name(self, run: int) -> str:
        """What a run is, in words."""
        if not 0 <= run < self.size:
            return f"run {run}, which the study does not have"
        sample, record, _, level, polarity = (int(place[0]) for place in self.places(np.array([run])))
        trial = self.trials[sample]
        return (
            f"run {run} ({trial.structure}, sample {trial.number}, {self.records[record].name}, "
            f"level {self.levels[level]:.6g}, polarity {self.polarities[polarity]:+d})"
        )

    def places(self, runs: Integers) -> tuple[Integers, Integers, Integers, Integers, Integers]:
        """The places of sample, record, restitution, level and polarity of runs."""
        sample, record, eta, level, polarity = np.unravel_index(runs, self.shape)
        return sample, record, eta, level, polarity

    def reference(self, sample: Integers) -> Reference:
        """What the dimensionless measures refer to, for samples by their places."""
        columns = np.array([(each.p, each.lambda_, each.gravity) for each in self.trials])[sample]
        p = np.where(columns[:, 0] > 0, columns[:, 0], np.nan)
        steps = self.measured.of_sample.get("v_imp", np.full(len(self.trials), nan))
        return Reference(p, columns[:, 1], columns[:, 2], steps[sample])

    def of_records(self, measure: str) -> Reals:
        """A measure of the motions as they are, shape (records,); NaN of those of which it is not known."""
        if measure in (PGA, PGV):
            return np.array([each.pga if measure == PGA else each.pgv for each in self.records])
        return self.measured.of_record.get(measure, np.full(len(self.records), nan))

    def intensities(
        self, measure: str, sample: Integers, record: Integers, level: Integers, factor: float | Reals
    ) -> Reals:
        """The intensity of runs, by their places and the factors on the records; NaN where it is not known."""
        asked = parse_measure(measure)
        if asked.base is None or asked.power is None:
            table = self.measured.of_run.get(str(asked), np.full((len(self.trials), len(self.records), 1), nan))
            return np.asarray(table[sample, record, np.minimum(level, table.shape[2] - 1)])
        value = self.of_records(str(asked.base))[record] * np.power(factor, asked.power)
        return np.asarray(asked.relative(value, self.reference(sample)), dtype=np.float64)

    def factors(self, sample: Integers, record: Integers, level: Integers) -> Reals:
        """Factors on the records that bring them to the levels, for places of one shape."""
        wanted = np.array(self.levels)[level]
        if self.sets is not None and not self.sets.scaled:
            return np.ones(wanted.shape)
        if self.measure == SCALE:
            return wanted
        power = parse_measure(self.measure).power
        assert power is not None
        ratio = wanted / self.intensities(self.measure, sample, record, level, 1.0)
        return np.asarray(ratio if power == 1 else ratio ** (1 / power))
