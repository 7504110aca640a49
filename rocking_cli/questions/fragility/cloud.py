"""The runs of a study as the input of a censored cloud analysis, such as that of oq-vmtk."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from rocking_cli.arrays import Reals
from rocking_cli.errors import DoubtWarning, InputError, Problem, named, warn
from rocking_cli.io.tables import stacked
from rocking_cli.names import UNKNOWN
from rocking_cli.studies.fragility.quantities import label, standard_measure

if TYPE_CHECKING:
    from rocking_cli.questions.fragility.results import StudyAnswer

PEAK_RATIO = "peak_ratio"
OVERTURNED = 1.0  # peak rotation over the critical rotation
LOWER_SHARE = 0.1  # of the lowest threshold: below it runs say little of damage


class Cloud(NamedTuple):
    """The arguments of `do_cloud_analysis` of oq-vmtk, in its order; see `StudyAnswer.to_cloud`."""

    imls: Reals
    edps: Reals
    damage_thresholds: Reals
    lower_limit: float
    censored_limit: float


def cloud(answer: StudyAnswer, measure: str, edp: str, censored: float, structure: str | None) -> Cloud:
    """Return the runs of a structure as a cloud; see `StudyAnswer.to_cloud`."""
    runs, names, limits = stacked(answer.run_blocks()), answer.plan.structures, answer.definition.limit_states
    thresholds = np.array(sorted({*(limit for limit in limits if isinstance(limit, float)), OVERTURNED}))
    if (heading := label(standard_measure(measure))) not in runs:
        hint = "add it to `measures` of the study"
        raise InputError(Problem(f"the runs have no {measure}", field=named("measure"), hint=hint))
    if edp != PEAK_RATIO:
        raise InputError(Problem(f"{edp!r} is not kept of every run", field=named("edp"), hint=f"give {PEAK_RATIO}"))
    if not censored > thresholds[-1]:
        hint = f"give more than the highest threshold, {thresholds[-1]:g}"
        raise InputError(Problem(f"{censored:g} is too low", field=named("censored"), hint=hint))
    if structure not in names and (structure or len(names) > 1):
        what = "is missing" if structure is None else f"{structure!r} is not one of this study"
        raise InputError(Problem(what, field=named("structure"), hint=f"give one of {', '.join(names)}"))
    own = runs["structure"] == (structure or names[0])
    intensity, peak, outcome = (runs[name][own] for name in (heading, PEAK_RATIO, "outcome"))
    usable = ~np.isin(outcome, (UNKNOWN, "failed")) & (intensity > 0)
    if not usable.all():
        warn(DoubtWarning(
            f"{(~usable).sum()} of {usable.size} runs are left out: {(outcome == UNKNOWN).sum()} of unknown outcome, "
            f"{(outcome == 'failed').sum()} failed, the others without a positive {measure}"
        ))  # fmt: skip
    edps = np.where(np.isinf(peak), censored, peak)[usable]  # the peak of a run that overturns is infinite
    return Cloud(intensity[usable], edps, thresholds, LOWER_SHARE * float(thresholds[0]), censored)
