"""The runs of a study as the input of a censored cloud analysis, such as that of oq-vmtk."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from rocking_cli.arrays import Reals
from rocking_cli.errors import DoubtWarning, InputError, Problem, named, warn
from rocking_cli.names import UNKNOWN
from rocking_cli.questions.fragility.definition import Limit
from rocking_cli.studies.fragility.quantities import label, standard_measure

PEAK = "peak_ratio"
OVERTURNED = 1.0  # peak rotation over the critical rotation
LOWER_SHARE = 0.1  # of the lowest threshold: below it runs say little of damage


def cloud(
    runs: Mapping[str, Any],
    names: Sequence[str],
    limits: Sequence[Limit],
    measure: str,
    edp: str,
    censored: float,
    structure: str | None,
) -> tuple[Reals, Reals, Reals, float, float]:
    """Return the runs of one of several structures as a cloud; see `StudyAnswer.to_cloud`."""
    thresholds = np.array(sorted({*(limit for limit in limits if isinstance(limit, float)), OVERTURNED}))
    heading, structure = label(standard_measure(measure)), structure or (names[0] if len(names) == 1 else None)
    for field, given, suits, hint in (
        ("measure", measure, heading in runs, "give one that the study names, or PGA or PGV"),
        ("edp", edp, edp == PEAK, f"give {PEAK}"),
        ("censored", censored, censored > thresholds[-1], f"give more than the highest threshold, {thresholds[-1]:g}"),
        ("structure", structure, structure in names, f"give one of {', '.join(names)}"),
    ):
        if not suits:
            raise InputError(Problem(f"does not suit this study: {given!r}", field=named(field), hint=hint))
    of_structure = runs["structure"] == structure
    intensity, peak, outcome = (runs[head][of_structure] for head in (heading, PEAK, "outcome"))
    usable = ~np.isin(outcome, (UNKNOWN, "failed")) & (intensity > 0)
    if not usable.all():
        of_unknown, failed = ((outcome == each).sum() for each in (UNKNOWN, "failed"))
        what = f"{of_unknown} of {UNKNOWN} outcome, {failed} failed, the others without a positive {measure}"
        warn(DoubtWarning(f"{(~usable).sum()} of {usable.size} runs are left out: {what}"))
    peaks = np.where(np.isinf(peak), censored, peak)[usable]  # that of a run that overturns is infinite
    return intensity[usable], peaks, thresholds, LOWER_SHARE * float(thresholds[0]), censored
