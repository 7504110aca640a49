"""View of margins to overturning, as text and as data."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, replace
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rocking_cli.dynamics.history import History
from rocking_cli.names import peaks_over, percent
from rocking_cli.questions.margin.study import SHARE_LEVELS, Margin
from rocking_cli.studies.conclusion import LEAST_SHARE, Conclusion
from rocking_cli.studies.neighbours import Conditions
from rocking_cli.views.cautions import cautions_of
from rocking_cli.views.column import Column, of, only_shown, rounded, table_of
from rocking_cli.views.conclusion import conclusion_data, of_margin
from rocking_cli.views.engines import BLOCKS_FAILED, engines_in_words
from rocking_cli.views.neighbours import deviations
from rocking_cli.views.restitution import heading_of_run, restitution_data, restitution_used
from rocking_cli.views.verdict import unchecked, why_unknown
from rocking_cli.views.view import MAX_DETAILED_MOTIONS, Aside, Table, View, number

PGA_HEAD = "PGA\n[g]"
GOVERNING_ROW = "overturn or unknown"
LEVELS = (
    "'First at' is the smallest factor at which so many neighbours overturn the structure; 'always from' the smallest "
    "from which on no factor tried has fewer."
)


class MarginRow(NamedTuple):
    """A motion: name, scale factor on the record, margin, conclusion, and the first history of unknown outcome."""

    name: str
    factor: float
    margin: Margin
    conclusion: Conclusion
    unknown: History | None = None


class _Line(NamedTuple):
    """A line of the table of margins: a motion with unknown outcomes as overturning, or those known to overturn."""

    name: str
    pga: str
    uplift: str
    share: float
    margin: Margin
    unknown: bool


def _lines(rows: Sequence[MarginRow]) -> Iterator[_Line]:
    """Yield the line that governs for each motion; if outcomes are unknown, also a line of those known to overturn."""
    for name, _, margin, *_ in rows:
        doubt = bool(margin.unknown.any())
        governing = f"{name}: {GOVERNING_ROW}" if doubt else name
        yield _Line(
            governing, number(margin.pga_g, 3), number(margin.uplift, 3), margin.share.highest, margin, unknown=True
        )
        if doubt:
            yield _Line("  known to overturn", "", "", margin.share.lowest, margin, unknown=False)


def _at_level(find: Callable[..., float | None], level: float) -> Callable[[_Line], float | None]:
    return lambda line: find(line.margin, level, unknown=line.unknown)


COLUMNS: tuple[Column[_Line], ...] = (
    only_shown("motion", of("name"), text=True),
    only_shown(PGA_HEAD, of("pga"), rank=4),
    only_shown("uplift\nat", of("uplift"), rank=5),
    only_shown("overturn\nat 1", of("share"), percent),
    *(
        only_shown(f"{percent(level)}\n{words}", _at_level(find, level), rounded(3), rank=rank)
        for words, find, ranks in (("first\nat", Margin.first, (0, 1, 1)), ("always\nfrom", Margin.always, (2, 3, 3)))
        for level, rank in zip(SHARE_LEVELS, ranks, strict=True)
    ),
)


def view(conditions: Conditions, rows: Sequence[MarginRow], end: Conclusion) -> View:
    """Show the margins of a structure under some motions, the conclusion on all of them first."""
    structure, mechanism = conditions.structure, conditions.structure.mechanism
    over = peaks_over([side.phi_cr is None for side in structure.statics])
    around = conditions.around.of(conditions.model)  # includes the deviations of the structure
    either = {
        "1": "motions as given",
        "-1": "motions reversed",
        "both": "motions as given and reversed (the worse of the two counts)",
    }[conditions.polarity]
    low, high = rows[0].margin.factors[[0, -1]]
    head = "PGA of\nground [g]" if rows[0].margin.on_floor else PGA_HEAD
    parts: list[Table | str] = [
        f"{heading_of_run(structure)}. {of_margin(end, over, _where_known_ends(rows, end))}",
        f"Scale factors from {low:.2g} to {high:.2g} on {either}; at each, {around.count} neighbouring motions, "
        f"{deviations(around)}.",
        Aside(LEVELS),
        table_of("", [replace(each, head=head) if each.head == PGA_HEAD else each for each in COLUMNS], _lines(rows)),
    ]
    if any(row.margin.unknown.any() for row in rows):
        parts.append(
            f"The row '{GOVERNING_ROW}' governs; the row below it alone does not prove that the structure stands."
        )
    by_blocks, off_edge = (sum(getattr(row.margin, key) for row in rows) for key in ("by_blocks", "off_edge"))
    parts += [restitution_used(structure)] if structure.restitution is not None else []
    parts += engines_in_words(conditions.engine, by_blocks, mechanism, off_edge)
    for row in rows if len(rows) <= MAX_DETAILED_MOTIONS else []:
        reached, *others = sentences(row.margin, row.unknown)
        parts += [Aside(f"{row.name}: {reached}"), *[f"{row.name}: {' '.join(others)}"] * bool(others)]
    parts += [f"Caution: {text}" for text in cautions_of(mechanism)]
    if not all(row.margin.checked for row in rows):
        parts.append(unchecked(why=mechanism.unchecked))
    return View(_data(conditions, rows) | {"conclusion": conclusion_data(end)}, parts)


def _where_known_ends(rows: Sequence[MarginRow], end: Conclusion) -> str:
    """Return that the factor of a conclusion is where knowledge ends, and why; empty if so many do overturn there."""
    row = next(row for row in rows if row.name == end.motion)
    if row.margin.first(LEAST_SHARE) == row.margin.first(LEAST_SHARE, unknown=True):
        return ""
    known = row.margin.known_to
    up_to = "" if known is None else f"all outcomes are known up to a factor of {known:.3g}; "
    from_there = f"at {end.ratio:.3g}, {percent(LEAST_SHARE)} or more overturn or are unknown"
    return f"Not a margin to overturning: {up_to}{from_there}, as {_why(row.margin, row.unknown)}."


def _why(found: Margin, unknown: History | None) -> str:
    """Return why outcomes are unknown, a clause: what ends the first such history of the structure itself."""
    if found.engine != "exact":
        return BLOCKS_FAILED
    return (why_unknown(unknown) if unknown else None) or "the model no longer holds (see `rocking respond`)"


def _data(conditions: Conditions, rows: Sequence[MarginRow]) -> dict[str, Any]:
    mechanism = conditions.structure.mechanism
    return {
        "structure": {"mechanism": mechanism.mechanism, "name": mechanism.name},
        "model": "nonlinear",
        "engine": conditions.engine,
        "polarity": conditions.polarity,
        "restitution": restitution_data(conditions.structure),
        "neighbours": asdict(conditions.around.of(conditions.model)),
        "caution": " ".join(cautions_of(mechanism)) or None,
        "motions": [
            {
                "name": row.name,
                "scale": row.factor,
                "pga_g": row.margin.pga_g,
                "conclusion": conclusion_data(row.conclusion),
                **margin_data(row.margin),
                "verdict": " ".join(sentences(row.margin, row.unknown)),
            }
            for row in rows
        ],
    }


def margin_data(found: Margin) -> dict[str, Any]:
    """Return a margin as plain data: the shares, and the factors at which they pass each level."""
    return {
        "uplift": found.uplift,
        "overturned": found.share.lowest,
        "factors": found.factors.tolist(),
        "shares": found.overturned.tolist(),
        "unknown": found.unknown.tolist() if found.checked else None,
        "by_blocks": found.by_blocks,
        "off_edge": found.off_edge,
        "levels": {
            f"{100 * level:g}": {
                "first": found.first(level),
                "last_below": found.last_below(level),
                "first_or_unknown": found.first(level, unknown=True),
                "last_below_or_unknown": found.last_below(level, unknown=True),
                "islands": found.islands(level),
            }
            for level in SHARE_LEVELS
        },
    }


def in_words(found: Margin) -> str:
    """Describe a margin, with at least one factor, in a few sentences, as one text."""
    return " ".join(sentences(found))


def sentences(found: Margin, unknown: History | None = None) -> list[str]:
    """Return a few sentences on a margin; the first one, which has the factors of the table, governs.

    In it, unknown outcomes count as overturning; `unknown` is the first history of unknown outcome.
    """
    doubt = bool(found.unknown.any())
    at = partial(_at, found.pga_g)
    does = "overturn the structure, or have an unknown outcome," if doubt else "overturn the structure"
    reached = _reached(found, found.at_most, does)
    if not doubt:
        return reached
    first = float(found.factors[(found.unknown > 0).argmax()])
    reached.append(
        f"From a factor of {at(first)} on, some outcomes are unknown, as {_why(found, unknown)}: there, the structure "
        "may overturn."
    )
    known = [
        f"{percent(level)} from {at(least)}" for level in SHARE_LEVELS if (least := found.first(level)) is not None
    ]
    if known:
        return [*reached, f"Shares known to overturn it: {', '.join(known)}."]
    few = f"At no factor tried are {percent(SHARE_LEVELS[0])} or more known to overturn it"
    return [*reached, f"{few}; this does not prove that it stands."]


def _reached(found: Margin, shares: NDArray[np.float64], does: str) -> list[str]:
    """Return in words at which factors the shares of neighbours that do something first reach each level.

    A second sentence states that fewer do under a stronger motion, if this is so.
    """
    at = partial(_at, found.pga_g)
    low, high = found.factors[[0, -1]]
    reached = [
        (level, float(found.factors[(shares >= level).argmax()])) for level in SHARE_LEVELS if (shares >= level).any()
    ]
    if not reached:
        return [
            f"At no scale factor from {low:.2g} to {high:.2g} ({found.of_pga} from {low * found.pga_g:.3g} g to "
            f"{high * found.pga_g:.3g} g) do {percent(SHARE_LEVELS[0])} or more of the neighbouring motions "
            f"{does.removesuffix(',')}."
        ]
    (level, first), *others = reached
    parts = [f"{percent(level)} of the neighbouring motions first {does} at a factor of {at(first, found.of_pga)}"]
    parts += [f"{percent(level)} at {at(first)}" for level, first in others]
    parts += [f"{percent(level)} at none up to {high:.2g}" for level in SHARE_LEVELS[len(reached) :]]
    sentence = f"At least {', '.join(parts[:-1])} and {parts[-1]}"
    if found.factors.size > 2:
        sentence += (
            f"; the factors tried are {percent(float(np.median(found.factors[1:] / found.factors[:-1])) - 1)} apart"
        )
    levels = [f"{sentence}."]
    for level, first in reached:
        above = found.factors > first
        least = float(shares[above].min(initial=1.0))
        if least < level:
            factor = float(found.factors[above][shares[above].argmin()])
            again = f"only {percent(least)} {does.removesuffix(',')}" if least else "none does"
            return [*levels, f"A stronger motion is not always worse: at a factor of {at(factor)} {again}."]
    return levels


def _at(pga: float, factor: float, what: str = "") -> str:
    return f"{factor:.3g} ({f'{what} ' * bool(what)}{factor * pga:.3g} g)"
