"""View of a set of records selected to fit a spectrum, as text and as data."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rocking_cli.studies.record_set import RecordSet
from rocking_cli.studies.subsets import STARTS
from rocking_cli.studies.target_spectrum import TargetSpectrum
from rocking_cli.text import cut
from rocking_cli.views.view import ABSENT, Table, View, number

NAME = 40  # characters of an event or a station in the table
LISTED = 5  # records that are left out, in words
SPANS = 4  # of periods, in a sentence


@dataclass(frozen=True)
class ShownSet:
    """A selected set of records, its target, and the files of the candidates.

    Parameters
    ----------
    found : RecordSet
        The set.
    target : TargetSpectrum
        The target spectrum.
    files : sequence of (str or None)
        File of each candidate.
    unusable : sequence of str
        Files that could not be used; their errors have been reported.
    """

    found: RecordSet
    target: TargetSpectrum
    files: Sequence[str | None]
    unusable: Sequence[str] = ()


def view(results: ShownSet) -> View:
    """Show the records and their factors, the range of the mean over the target, and remarks."""
    parts: list[Table | str] = [_records(results), _range(results), verdict(results), search(results)]
    parts += [said for said in (_left_out(results), _silent(results)) if said]
    return View(lambda: data(results), parts)


def data(results: ShownSet) -> dict[str, Any]:
    """Return a set as plain data."""
    found, wanted = results.found, results.found.wanted
    ratio = found.ratio
    return {
        "target": results.target.name,
        "band": list(wanted.band),
        "within": list(wanted.within),
        "damping": wanted.damping,
        "seed": wanted.seed,
        "one_per": wanted.one_per,
        "silent": found.silent,
        "exact": found.exact,
        "fits": found.fits,
        "least": float(ratio.min()),
        "most": float(ratio.max()),
        "records": [
            {
                "file": results.files[k],
                "name": found.candidates.motions[k].name,
                **found.candidates.motions[k].origin._asdict(),
                "factor": factor,
                "pga": factor * found.candidates.motions[k].of_ground.pga_g,
            }
            for k, factor in _chosen(found)
        ],
        "spectrum": {
            "period": found.candidates.periods.tolist(),
            "target": found.candidates.target.tolist(),
            "mean": found.mean.tolist(),
        },
        "left_out": [
            *({"file": file, "name": None, "why": "it cannot be used"} for file in results.unusable),
            *(
                {"file": results.files[k], "name": found.candidates.motions[k].name, "why": why}
                for k, why in found.left_out.items()
            ),
        ],
        "verdict": verdict(results),
    }


def table(results: ShownSet) -> dict[str, Sequence[object]]:
    """Return the columns of the spectra: the target, the mean, and each scaled record."""
    found = results.found
    names = [found.candidates.motions[k].name for k, _ in _chosen(found)]
    return {
        "period [s]": found.candidates.periods.tolist(),
        "target Sa [g]": found.candidates.target.tolist(),
        "mean Sa [g]": found.mean.tolist(),
        **{f"Sa of {name} [g]": each.tolist() for name, each in zip(names, found.spectra, strict=True)},
    }


def title(results: ShownSet) -> str:
    """Return the number of records and the target, as a heading."""
    found = results.found
    return f"{_records_in_words(len(found.chosen))} for {results.target.name}"


def verdict(results: ShownSet) -> str:
    """Return sentences on whether the mean lies within the limits, its extremes, and the periods outside."""
    found, wanted = results.found, results.found.wanted
    periods, ratio = found.candidates.periods, found.ratio
    low, high = wanted.within
    least, most = int(ratio.argmin()), int(ratio.argmax())
    count = len(found.chosen)
    whose = "The spectrum" if count == 1 else f"The mean of the {count} spectra"
    where = f"at {periods.size} periods from {wanted.band[0]:g} to {wanted.band[1]:g} s"
    range_ = (
        f"between {ratio_in_words(float(ratio[least]), wanted.within)} times the target, at {periods[least]:.3g} s, "
        f"and {ratio_in_words(float(ratio[most]), wanted.within)} times, at {periods[most]:.3g} s"
    )
    if found.fits:
        return f"{whose} fits: {where} it lies {range_}, within the limits of {low:g} and {high:g}."
    missed = [
        f"{side} {limit:g} times the target {_spans(periods, mask)}"
        for side, limit, mask in (("below", low, found.too_low), ("above", high, found.too_high))
        if mask.any()
    ]
    best = "No set fits" if found.exact else "No set within the limits was found"
    nearest = "record" if count == 1 else "set"
    return (
        f"{best}. {whose} of the nearest {nearest} lies {range_}: that is {', and '.join(missed)}. More records to "
        "choose from, a larger set, a narrower band or wider limits on the factors may help."
    )


def search(results: ShownSet) -> str:
    """Return a sentence on how the set was found, and so how good it is."""
    found = results.found
    if found.exact:
        one = "the only possible set" if found.sets == 1 else f"the best of all {found.sets:,} sets"
        return f"This is {one}."
    return (
        f"This is the best set found by {STARTS} searches among {_large(found.sets)} sets, which are too many to try "
        "all; another seed may find a better one."
    )


def ratio_in_words(value: float, within: tuple[float, float]) -> str:
    """Format a ratio with three digits, or more if needed to show on which side of the limits it is."""
    for digits in range(3, 10):
        shown = f"{value:#.{digits}g}"
        if all((float(shown) < limit) == (value < limit * (1 - 1e-9)) for limit in within[:1]) and all(
            (float(shown) > limit) == (value > limit * (1 + 1e-9)) for limit in within[1:]
        ):
            break
    return shown


def _chosen(found: RecordSet) -> list[tuple[int, float]]:
    return list(zip(found.chosen.tolist(), found.factors.tolist(), strict=True))


def _records_in_words(count: int) -> str:
    return "1 record" if count == 1 else f"{count} records"


def _records(results: ShownSet) -> Table:
    """Return a table with a row for each record of the set."""
    found = results.found
    rows = []
    for k, factor in _chosen(found):
        motion = found.candidates.motions[k]
        event, station = (cut(each or ABSENT, NAME) for each in (motion.origin.event, motion.origin.station))
        rows.append([motion.name, event, station, f"{factor:.4g}", f"{factor * motion.of_ground.pga_g:.3g}"])
    heads = ["record", "earthquake", "station", "factor", "PGA as\nscaled [g]"]
    return Table(title(results), heads, rows, numbers=(3, 4))


def _range(results: ShownSet) -> Table:
    """Return a table of the smallest and the largest ratio of the mean to the target."""
    found = results.found
    ratio, periods = found.ratio, found.candidates.periods
    limits = results.found.wanted.within
    rows = [
        [what, ratio_in_words(float(ratio[k]), limits), number(float(periods[k]), 3), f"{limit:g}"]
        for what, k, limit in (
            ("least", int(ratio.argmin()), limits[0]),
            ("most", int(ratio.argmax()), limits[1]),
        )
    ]
    return Table("Mean over the target", ["", "ratio", "at [s]", "limit"], rows, numbers=(1, 2, 3))


def _spans(periods: NDArray[np.float64], where: NDArray[np.bool_]) -> str:
    """Return the ranges of flagged periods in words: "from 0.2 to 0.31 s and at 1.4 s"."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], where.astype(int), [0]]))).reshape(-1, 2)
    said = []
    for start, end in edges.tolist():
        first, last = f"{periods[start]:.3g}", f"{periods[end - 1]:.3g}"
        said.append(f"at {first} s" if first == last else f"from {first} to {last} s")
    if len(said) > SPANS:
        said = [*said[:SPANS], f"in {len(said) - SPANS} more ranges"]
    return said[0] if len(said) == 1 else f"{', '.join(said[:-1])} and {said[-1]}"


def _large(count: int) -> str:
    return f"{count:,}" if count < 1_000_000 else f"{count:.3g}".replace("e+0", "e").replace("e+", "e")


def _left_out(results: ShownSet) -> str:
    """Return a sentence on the records that could not be chosen; empty if there are none."""
    found = results.found
    said = [f"{found.candidates.motions[k].name}: {why}" for k, why in found.left_out.items()]
    if not said:
        return ""
    more = f"; and {len(said) - LISTED} more" if len(said) > LISTED else ""
    return f"Left out: {'; '.join(said[:LISTED])}{more}."


def _silent(results: ShownSet) -> str:
    """Return a sentence on the records whose file names no earthquake or station."""
    found = results.found
    if not found.silent:
        return ""
    what = {"event": "earthquake", "station": "station"}[found.wanted.one_per]
    count, those = len(found.candidates.motions), found.silent
    gives, each = ("gives", "it") if those == 1 else ("give", "each")
    whose = "The record" if count == 1 else f"{those} of {count} records"
    return f"{whose} {gives} no {what}; {each} counts as a separate {what}."
