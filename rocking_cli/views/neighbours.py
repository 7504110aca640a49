"""Outcomes of neighbours (histories next to that of a ground motion): as sentences, as data and as cells of a table."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict
from math import inf, isinf
from typing import Any, TypeVar

from rocking_cli import names
from rocking_cli.names import percent
from rocking_cli.studies.neighbours import FRACTILES, Neighbourhood, Neighbours
from rocking_cli.views.column import Column, data_of, of, only_shown

R = TypeVar("R")
MIN_NEIGHBOURS_OF_QUANTILES = 20  # with fewer, one or two neighbours decide the peaks of 16 and 84 %


def deviations(around: Neighbourhood) -> str:
    """Return the standard deviations of neighbours in words."""
    known = [f"{percent(around.amplitude)} of amplitude"]
    known += [f"{percent(around.slenderness)} of slenderness"] if around.slenderness is not None else []
    known += [f"{around.restitution:g} of restitution"] if around.restitution is not None else []
    fields = {"slenderness": around.slenderness, "restitution": around.restitution}
    undefined = " and ".join(name for name, value in fields.items() if value is None)
    rest = f", and those of the structure for its {undefined}" if undefined else ""
    return f"standard deviations {', '.join(known)}{rest}"


def neighbours_in_words(near: Neighbours) -> str:
    """Return how many neighbours overturn, or are of unknown outcome, and the peaks of the others in a sentence."""
    of = f"{near.around.count} neighbouring motions"
    how = f" ({deviations(near.around)})."
    if not near.lifted:
        return f"None of {of} uplifts the structure{how}"
    sentences = [f"Of {of}, {_shares(near)}"]
    low, median, high = near.peak_ratio
    if near.slides:
        sentences.append(f"{_number(near, near.slides)} only {'slides' if _count(near, near.slides) == 1 else 'slide'}")
        if 0 < near.slip[1] < inf:
            sentences.append(f"the median slip is {near.slip[1]:.2g} m")
        if near.slides + (near.unknown or 0.0) == 1:
            return "; ".join(sentences) + how
    if high == 0 and not near.slides:
        return f"{sentences[0]}; at most one in six uplifts it{how}"
    enough = near.around.count >= MIN_NEIGHBOURS_OF_QUANTILES
    if median == 0 or (low == 0 and enough):
        sentences.append(f"{'half' if median == 0 else '16 %'} do not uplift it")
    if 0 < median < inf:
        sentences.append(f"the median peak is {median:.2g} {near.over}")
    # The highest known fractile of the peaks of the neighbours.
    part, others, most = ("84 %", "16 %", high) if high < inf else ("16 %", "84 %", low if isinf(median) else 0.0)
    if enough and 0 < most <= 1:
        sentences.append(f"{part} stay below {most:.2g} {near.over}")
    elif enough and 1 < most < inf:
        ends = "overturn or are unknown" if near.unknown else "overturn"
        sentences.append(f"{others} pass the critical rotation ({most:.2g} {near.over}) or {ends}")
    return "; ".join(sentences) + how


def _count(near: Neighbours, share: float) -> int:
    return round(share * near.around.count)


def _number(near: Neighbours, share: float) -> str:
    return f"{_count(near, share)} ({percent(share)})"


def _shares(near: Neighbours) -> str:
    if near.overturned in (0, 1):
        none = "none is known to overturn the structure" if near.unknown else "none overturns the structure"
        sentence = "all overturn the structure" if near.overturned else none
    else:
        does = "overturns" if _count(near, near.overturned) == 1 else "overturn"
        sentence = f"{_number(near, near.overturned)} {does} the structure"
    if not near.unknown:
        return sentence
    return f"{sentence}, and the outcome under {'all' if near.unknown == 1 else _number(near, near.unknown)} is unknown"


def _quantiles(values: Sequence[float]) -> dict[str, float | None]:
    pairs = zip(FRACTILES, values, strict=True)
    return {f"{100 * share:.0f}": None if isinf(value) else value for share, value in pairs}


NEAR: tuple[Column[Neighbours], ...] = (
    Column("overturned", of("overturned"), words="Share known to overturn; at most this and `unknown` together do"),
    Column("unknown", of("unknown"), words="Share of unknown outcome; null if the joints are not checked"),
    Column("peak_ratio", lambda near: _quantiles(near.peak_ratio),
           words="Quantiles of the peak over phi_cr; null at a neighbour that overturns or is unknown"),
    Column("slides", of("slides"), words="Share that only slides"),
    Column("slip", lambda near: _quantiles(near.slip), words="Quantiles of the slip [m]; null likewise"),
    Column("sensitive", of("sensitive"),
           words="Whether under 90 % share the outcome of the motion; null if unknown outcomes leave that open"),
)  # fmt: skip


def neighbours_data(near: Neighbours) -> dict[str, Any]:
    """Return the outcomes of the neighbours of a motion as plain data."""
    return {**asdict(near.around), **data_of(NEAR, near)}


def neighbour_columns(of: Callable[[R], Neighbours | None], *, doubtful: bool) -> list[Column[R]]:
    """Return the shares of the neighbours of a motion that overturn and are of unknown outcome, and the median peak.

    Parameters
    ----------
    of : callable
        Returns the neighbours of a row, if it has any.
    doubtful : bool
        Whether any outcome is unknown, which the table then shows.
    """

    def cell(show: Callable[[Neighbours], str | None]) -> Callable[[R], str | None]:
        return lambda row: None if (neighbours := of(row)) is None else show(neighbours)

    return [
        only_shown("neighbours\noverturn", cell(lambda near: percent(near.overturned))),
        only_shown("are\nunknown" if doubtful else None, cell(_unknown)),
        only_shown("their\nmedian", cell(_median), rank=1),
    ]


def _unknown(near: Neighbours) -> str | None:
    return None if near.unknown is None else percent(near.unknown)


def _median(near: Neighbours) -> str:
    if isinf(near.peak_ratio[1]):
        return names.OVERTURNS if near.half_overturn else names.UNKNOWN
    return f"{near.peak_ratio[1]:.3g}"
