"""A set of records selected to fit a spectrum as text, as data and as a plot."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rocking_cli.excitation.base import GroundMotion
from rocking_cli.io.tables import Columns, stacked
from rocking_cli.questions.select.study import RecordSet
from rocking_cli.questions.select.subsets import SEARCH_STARTS
from rocking_cli.questions.select.target_spectrum import TargetSpectrum
from rocking_cli.short_repr import short_repr
from rocking_cli.text import cut
from rocking_cli.views.column import Column, data_of, of, rounded, table_of
from rocking_cli.views.view import Table, View

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MAX_TICKED_RATIO = 8.0  # ratio of the ends of the band up to which its axis has more ticks
MAX_OPAQUE_LINES = 12  # with more records, their lines are transparent
MAX_NAME_LENGTH = 40  # characters of an event or a station in the table
MAX_LISTED_RECORDS = 5  # left-out records that a sentence names
MAX_LISTED_SPANS = 4  # ranges of periods that a sentence names


@short_repr
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


class _Chosen(NamedTuple):
    """A record of a set: its file, the motion as read, and its factor."""

    file: str | None
    motion: GroundMotion
    factor: float


def _shortened(name: str) -> str:
    return cut(name, MAX_NAME_LENGTH)


RECORDS: tuple[Column[_Chosen], ...] = (
    Column("file", of("file")),
    Column("name", of("motion.name"), head="record", text=True),
    Column("event", of("motion.origin.event"), head="earthquake", form=_shortened, text=True, rank=2),
    Column("station", of("motion.origin.station"), head="station", form=_shortened, text=True, rank=3),
    Column("magnitude", of("motion.origin.magnitude")),
    Column("distance", of("motion.origin.distance"), "km"),
    Column("factor", of("factor"), head="factor"),
    Column("pga_g", lambda row: row.factor * row.motion.of_ground.pga_g, "g", "PGA as\nscaled [g]", rounded(3), rank=1),
)


def view(results: ShownSet) -> View:
    """Show the range of the mean over the target, the records and their factors, and remarks."""
    parts: list[Table | str] = [
        verdict(results),
        table_of(title(results), RECORDS, _chosen(results)),
        search(results),
    ]
    parts += [sentence for sentence in (_left_out(results), _silent(results)) if sentence]
    return View(lambda: data(results), parts)


def data(results: ShownSet) -> dict[str, Any]:
    """Return a set as plain data."""
    selection, wanted = results.found, results.found.wanted
    ratio = selection.ratio
    return {
        "target": results.target.name,
        "band": list(wanted.band),
        "within": list(wanted.within),
        "damping": wanted.damping,
        "seed": wanted.seed,
        "one_per": wanted.one_per,
        "silent": selection.silent,
        "exact": selection.exact,
        "fits": selection.fits,
        "least": float(ratio.min()),
        "most": float(ratio.max()),
        "records": [data_of(RECORDS, each) for each in _chosen(results)],
        "spectrum": {
            "period": selection.candidates.periods.tolist(),
            "target": selection.candidates.target.tolist(),
            "mean": selection.mean.tolist(),
        },
        "left_out": [
            *({"file": file, "name": None, "why": "it cannot be used"} for file in results.unusable),
            *(
                {"file": results.files[k], "name": selection.candidates.motions[k].name, "why": _why(selection, needed)}
                for k, needed in selection.left_out.items()
            ),
        ],
        "verdict": verdict(results),
    }


def table(results: ShownSet) -> Columns:
    """Return the columns of the spectra, with a row for each scaled record and period, beside target and mean."""
    selection = results.found
    return stacked(
        {
            "motion": each.motion.name, "period [s]": selection.candidates.periods, "Sa [g]": spectrum,
            "target Sa [g]": selection.candidates.target, "mean Sa [g]": selection.mean,
        }
        for each, spectrum in zip(_chosen(results), selection.spectra, strict=True)
    )  # fmt: skip


def title(results: ShownSet) -> str:
    """Return the number of records and the target, as a heading."""
    count = len(results.found.chosen)
    return f"{count} record{'s' * (count > 1)} for {results.target.name}"


def verdict(results: ShownSet) -> str:
    """Return sentences on whether the mean lies within the limits, its extremes, and the periods outside."""
    selection, wanted = results.found, results.found.wanted
    periods, ratio = selection.candidates.periods, selection.ratio
    low, high = wanted.within
    least, most = int(ratio.argmin()), int(ratio.argmax())
    count = len(selection.chosen)
    whose = "The spectrum" if count == 1 else f"The mean of the {count} spectra"
    where = f"at {periods.size} periods from {wanted.band[0]:g} to {wanted.band[1]:g} s"
    range_ = (
        f"between {ratio_in_words(float(ratio[least]), wanted.within)} times the target, at {periods[least]:.3g} s, "
        f"and {ratio_in_words(float(ratio[most]), wanted.within)} times, at {periods[most]:.3g} s"
    )
    if selection.fits:
        return f"{whose} fits: {where} it lies {range_}, within the limits of {low:g} and {high:g}."
    missed = [
        f"{side} {limit:g} times the target {_spans(periods, mask)}"
        for side, limit, mask in (("below", low, selection.too_low), ("above", high, selection.too_high))
        if mask.any()
    ]
    best = "No set fits" if selection.exact else "No set within the limits was found"
    nearest = "record" if count == 1 else "set"
    return (
        f"{best}. {whose} of the nearest {nearest} lies {range_}: that is {', and '.join(missed)}. More records to "
        "choose from, a larger set, a narrower band or wider limits on the factors may help."
    )


def search(results: ShownSet) -> str:
    """Return a sentence on how the set was found, and so how good it is."""
    selection = results.found
    if selection.exact:
        one = "the only possible set" if selection.sets == 1 else f"the best of all {selection.sets:,} sets"
        return f"This is {one}."
    count = (
        f"{selection.sets:,}"
        if selection.sets < 1e6
        else f"{selection.sets:.3g}".replace("e+0", "e").replace("e+", "e")
    )
    return (
        f"This is the best set found by {SEARCH_STARTS} searches among {count} sets, which are too many to try all; "
        "another "
        "seed may find a better one."
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


def _chosen(results: ShownSet) -> list[_Chosen]:
    selection = results.found
    pairs = zip(selection.chosen.tolist(), selection.factors.tolist(), strict=True)
    return [_Chosen(results.files[k], selection.candidates.motions[k], factor) for k, factor in pairs]


def _spans(periods: NDArray[np.float64], where: NDArray[np.bool_]) -> str:
    """Return the ranges of flagged periods in words: "from 0.2 to 0.31 s and at 1.4 s"."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], where.astype(int), [0]]))).reshape(-1, 2)
    spans = []
    for start, end in edges.tolist():
        first, last = f"{periods[start]:.3g}", f"{periods[end - 1]:.3g}"
        spans.append(f"at {first} s" if first == last else f"from {first} to {last} s")
    if len(spans) > MAX_LISTED_SPANS:
        spans = [*spans[:MAX_LISTED_SPANS], f"in {len(spans) - MAX_LISTED_SPANS} more ranges"]
    return spans[0] if len(spans) == 1 else f"{', '.join(spans[:-1])} and {spans[-1]}"


def _left_out(results: ShownSet) -> str:
    """Return a sentence on the records that could not be chosen; empty if there are none."""
    selection = results.found
    motions, left_out = selection.candidates.motions, selection.left_out
    reasons = [f"{motions[k].name}: {_why(selection, factor)}" for k, factor in left_out.items()]
    if not reasons:
        return ""
    more = f"; and {len(reasons) - MAX_LISTED_RECORDS} more" if len(reasons) > MAX_LISTED_RECORDS else ""
    return f"Left out: {'; '.join(reasons[:MAX_LISTED_RECORDS])}{more}."


def _why(found: RecordSet, needed: float | None) -> str:
    """Return why a record could not be chosen, by the factor that it needs."""
    low, high = found.wanted.factors
    if needed is None:
        return "it does not move in the band"
    return f"it needs a factor of {needed:.3g}, outside {low:g} to {high:g}"


def _silent(results: ShownSet) -> str:
    """Return a sentence on the records whose file names no earthquake or station."""
    selection = results.found
    if not selection.silent:
        return ""
    what = {"event": "earthquake", "station": "station"}[selection.wanted.one_per]
    count, those = len(selection.candidates.motions), selection.silent
    gives, each = ("gives", "it") if those == 1 else ("give", "each")
    whose = "The record" if count == 1 else f"{those} of {count} records"
    return f"{whose} {gives} no {what}; {each} counts as a separate {what}."


def draw_record_set(found: RecordSet, title: str) -> Figure:
    """Draw the spectra of a set over the band: each record thin, the mean bold, the target, and the limits shaded.

    Parameters
    ----------
    found : RecordSet
        The set of records to plot.
    title : str
        Heading.
    """
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    from rocking_cli.plotting import style

    periods, target, mean = found.candidates.periods, found.candidates.target, found.mean
    low, high = found.wanted.within
    figure, axes = style.one_panel(4.4, title)
    axes.fill_between(periods, low * target, high * target, color=style.SATISFIED, linewidth=0, zorder=0)
    faint = min(1.0, max(MAX_OPAQUE_LINES / len(found.chosen), 0.2))
    axes.plot(periods, found.spectra.T, color=style.FAINT, linewidth=style.CURVE, alpha=faint, zorder=1.5)
    axes.plot(periods, target, color=style.TARGET, linestyle="--", linewidth=style.BOLD, zorder=2.5)
    axes.plot(periods, mean, color=style.MEAN, linewidth=2.2, zorder=3)
    missed = found.too_low | found.too_high
    if missed.any():
        axes.plot(
            periods[missed], mean[missed], linestyle="none", marker="x", markersize=5, color=style.MISSED, zorder=4
        )
    short = periods[-1] / periods[0] <= MAX_TICKED_RATIO
    style.logarithmic(axes.xaxis, (1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0) if short else (1.0, 2.0, 5.0))
    axes.set_xlim(periods[0], periods[-1])
    axes.set_ylim(0.0, 1.05 * max(float(found.spectra.max()), float((high * target).max())))
    damping = f"{100 * found.wanted.damping:g} % damping"
    style.tidy(axes, "period [s]", f"pseudo-acceleration [g], {damping}")
    handles: list[Line2D | Patch] = [
        Line2D([], [], color=style.MEAN, linewidth=2.2, label="mean"),
        Line2D([], [], color=style.TARGET, linestyle="--", linewidth=style.BOLD, label="target"),
        Patch(color=style.SATISFIED, linewidth=0, label=f"{low:g} to {high:g} times the target"),
        Line2D([], [], color=style.FAINT, linewidth=style.CURVE, label="each record, scaled"),
    ]
    if missed.any():
        handles.append(Line2D([], [], linestyle="none", marker="x", color=style.MISSED, label="outside the limits"))
    style.legend_below(figure, handles, len(handles))
    return figure
