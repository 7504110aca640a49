"""View of margins to overturning, as text and as data."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict
from typing import Any, NamedTuple

from rocking_cli.core import Mechanism
from rocking_cli.dynamics.holding import unchecked
from rocking_cli.names import percent
from rocking_cli.studies.margin import LEVELS, Margin, in_words
from rocking_cli.studies.neighbours import Neighbourhood
from rocking_cli.views.cautions import cautions_of
from rocking_cli.views.view import FEW, Table, View, heading, number


class MarginRow(NamedTuple):
    """A motion: its name, the scale factor on the record as read, its PGA with this factor [g], and its margin."""

    name: str
    factor: float
    pga: float
    margin: Margin


def view(mechanism: Mechanism, rows: Sequence[MarginRow], polarity: str, around: Neighbourhood) -> View:
    """Show the margins of a structure under some motions."""
    around = rows[0].margin.around if rows else around  # with the deviations of the structure
    heads = ["motion", "PGA\n[g]", "uplift\nat", "overturn\nat 1"]
    heads += [f"{percent(level)}\nfrom" for level in LEVELS] + [f"below\n{percent(level)} to" for level in LEVELS]
    cells = [cell for row in rows for cell in _cells(row)]
    either = {
        "1": "the motion as given",
        "-1": "the motion reversed",
        "both": "the motion as given and reversed (the worse of the two counts)",
    }[polarity]
    *lower, top = (f"{100 * level:g}" for level in LEVELS)
    levels = f"{', '.join(lower)} and {top}"
    parts: list[Table | str] = [
        heading(mechanism),
        f"Scale factors on {either}. At each factor, {around.count} neighbouring motions are simulated, "
        f"{around.words}. 'Uplift at' is the smallest factor that uplifts the structure, and 'overturn at 1' the share "
        f"of these motions that overturn it at a factor of 1. 'From' is the smallest factor at which at least {levels} "
        "% of them overturn it, and 'below ... to' the largest factor at which fewer do; a plus marks the largest "
        "factor tried.",
        Table("", heads, cells, numbers=range(1, len(heads))),
        *_doubtful(rows),
    ]
    parts += [f"{row.name}: {in_words(row.margin, row.pga)}" for row in rows] if len(rows) <= FEW else []
    parts += [f"Caution: {text}" for text in cautions_of(mechanism)]
    if not all(row.margin.checked for row in rows):
        parts.append(unchecked(why=mechanism.unchecked))
    return View(_data(mechanism, rows, polarity, around), parts)


def _cells(row: MarginRow) -> Iterator[list[str]]:
    """Yield the row of a motion and, if outcomes are unknown, a second one that counts them as overturning."""
    found = row.margin
    yield [
        row.name,
        f"{row.pga:.3g}",
        number(found.uplift, 3),
        percent(found.itself),
        *(number(found.first(level), 3) for level in LEVELS),
        *(_last(found, found.last_below(level)) for level in LEVELS),
    ]
    if found.unknown.any():
        yield [
            "  or unknown",
            "",
            "",
            percent(found.itself_at_most),
            *(number(found.possible(level), 3) for level in LEVELS),
            *(_last(found, found.last_possible_below(level)) for level in LEVELS),
        ]


def _last(found: Margin, factor: float | None) -> str:
    """Format the last factor at which fewer neighbours overturn; a plus marks the largest factor simulated."""
    return f"{number(factor, 3)}{'+' if factor == found.factors[-1] else ''}"


def _doubtful(rows: Sequence[MarginRow]) -> Iterator[str]:
    """Yield a note on how to read the rows of unknown outcomes, if there are any."""
    if any(row.margin.unknown.any() for row in rows):
        yield (
            "Rows 'or unknown' count neighbours of unknown outcome as overturning: each factor and share lies between "
            "the two rows. For a safe assessment, use the row 'or unknown'; the row above it alone is no proof that "
            "the structure stands."
        )


def _data(mechanism: Mechanism, rows: Sequence[MarginRow], polarity: str, around: Neighbourhood) -> dict[str, Any]:
    return {
        "structure": {"mechanism": mechanism.mechanism, "name": mechanism.name},
        "model": "nonlinear",
        "polarity": polarity,
        "neighbours": asdict(around),
        "motions": [
            {
                "name": row.name,
                "scale": row.factor,
                "pga": row.pga,
                **margin_data(row.margin),
                "verdict": in_words(row.margin, row.pga),
            }
            for row in rows
        ],
    }


def margin_data(found: Margin) -> dict[str, Any]:
    """Return a margin as plain data: the shares, and the factors at which they pass each level."""
    return {
        "uplift": found.uplift,
        "overturned": found.itself,
        "factors": found.factors.tolist(),
        "shares": found.overturned.tolist(),
        "unknown": found.unknown.tolist() if found.checked else None,
        "levels": {
            f"{100 * level:g}": {
                "first": found.first(level),
                "last_below": found.last_below(level),
                "first_or_unknown": found.possible(level),
                "last_below_or_unknown": found.last_possible_below(level),
                "islands": found.islands(level),
            }
            for level in LEVELS
        },
    }
