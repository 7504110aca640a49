"""View of a survey of structures, ranked, as text and as data."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import isnan
from typing import Any

import numpy as np

from rocking_cli.io.tables import Columns
from rocking_cli.names import percent
from rocking_cli.studies.survey import Bad, Survey, Surveyed
from rocking_cli.text import cut, one_line
from rocking_cli.views.view import ABSENT, Table, View, number

TOP = 20
NAME = 30  # characters of a name in the table
CAUTIONED = 3  # structures whose cautions are printed
BLOCK = 10_000  # rows of a file written at a time
FORMULA = ("=", "+", "-", "@")
"""First characters of a text that a spreadsheet would read as a formula."""
RANKED = {
    "lambda": "by ground acceleration at uplift",
    "ratio": "by the ratio of capacity to demand under the code of the site; structures with ratios below 1 fail",
    "response": (
        "by the share of motions that overturn them, then by the largest peak under the others, then by uplift "
        "acceleration; an unknown outcome counts as overturning"
    ),
}


def view(found: Survey, top: int = TOP) -> View:
    """Show the most vulnerable structures, and how many of all overturn."""
    parts: list[Table | str] = []
    if found.rows:
        parts = [table(found, top), *sentences(found, top)]
    return View(lambda: data(found), parts)


def data(found: Survey) -> dict[str, Any]:
    """Return a survey as plain data."""
    return {
        "ranked_by": found.by,
        "motions": list(found.motions),
        "rows": [_row(rank, each) for rank, each in enumerate(found.rows, 1)],
        "bad": [
            {"row": each.row, "line": each.line, "name": one_line(each.name), "reason": each.reason}
            for each in found.bad
        ],
    }


def _row(rank: int, each: Surveyed) -> dict[str, Any]:
    shaken: dict[str, Any] = {}
    if each.under is not None:
        shaken = {
            "overturned": each.under.overturned,
            "unknown": each.under.unknown,
            "peak_ratio": each.under.peak_ratio,
            "peak_over": each.under.over,
            "worst": each.under.worst,
        }
    verified = {} if each.ratio is None else {"ratio": each.ratio}
    return {
        "rank": rank,
        "name": each.name,
        "mechanism": each.mechanism,
        "row": each.row,
        "line": each.line,
        **verified,
        **shaken,
        "lambda": each.lambda_,
        "uplift": each.uplift,
        "direction": each.direction,
        "p": each.p,
        "phi_cr": each.phi_cr,
        "kappa1": each.kappa1,
        "kappa2": each.kappa2,
        "eta": each.eta,
        "no_block": each.no_block,
        "doubt": each.doubt,
        "caution": each.caution,
    }


UNITS = {"uplift": "g", "p": "rad/s", "phi_cr": "rad"}


def blocks(found: Survey, *, for_spreadsheets: bool) -> Iterator[Columns]:
    """Yield all rows in blocks; texts that a spreadsheet would compute get an apostrophe in front."""
    for start in range(0, max(len(found.rows), 1), BLOCK):
        yield columns(found, start, start + BLOCK, for_spreadsheets=for_spreadsheets)


def columns(found: Survey, start: int = 0, stop: int | None = None, *, for_spreadsheets: bool = False) -> Columns:
    """Return some of the rows as columns of a table."""
    rows = [_row(rank, each) for rank, each in enumerate(found.rows, 1)][start:stop]
    if not rows:
        return {"rank": [], "name": [], "lambda": []}
    made: dict[str, Any] = {}
    for key, value in rows[0].items():
        head = f"{key} [{UNITS[key]}]" if key in UNITS else key
        cells = [row[key] for row in rows]
        if isinstance(value, float) or key == "unknown":
            made[head] = np.array(cells, dtype=np.float64)
        elif isinstance(value, int):
            made[head] = cells
        else:
            texts = [one_line(each) if each is not None else "" for each in cells]
            made[head] = [f"'{each}" if for_spreadsheets and each.startswith(FORMULA) else each for each in texts]
    return made


def has_unknown(found: Survey) -> bool:
    """Return whether the outcome of any structure is unknown under any motion."""
    return any(each.under is not None and each.under.unknown for each in found.rows)


def headings(found: Survey) -> list[str]:
    """Return the headings of the columns of `cells`."""
    shaken = ["overturn\nit", *(["unknown"] if has_unknown(found) else []), "largest\npeak"] if found.motions else []
    ratio = ["ratio"] if found.by == "ratio" else []
    return ["rank", "name", "mechanism", *ratio, *shaken, "lambda", "p\n[rad/s]", "phi_cr\n[rad]", "kappa2", "eta"]


def cells(rank: int, each: Surveyed, longest: int | None = NAME, *, unknown: bool = False) -> list[str]:
    """Return the cells of a structure, with the share of unknown outcomes if requested."""
    name = one_line(each.name)
    shaken = []
    if each.under is not None:
        doubtful = each.under.unknown
        shaken = [percent(each.under.overturned)]
        shaken += [ABSENT if doubtful is None else percent(doubtful)] if unknown else []
        shaken.append(_peak(each))
    numbers = (each.lambda_, each.p, each.phi_cr, each.kappa2, each.eta)
    return [
        str(rank),
        cut(name, longest) if longest is not None else name,
        each.mechanism,
        *([] if each.ratio is None else [number(each.ratio, 4)]),
        *shaken,
        *(number(value, 4) for value in numbers),
    ]


def _peak(each: Surveyed) -> str:
    assert each.under is not None
    peak = each.under.peak_ratio
    return ABSENT if isnan(peak) else "no uplift" if peak == 0 else f"{peak:.3g}"


def table(found: Survey, top: int) -> Table:
    """Return a table of the first rows."""
    heads = headings(found)
    unknown = has_unknown(found)
    rows = [cells(rank, each, unknown=unknown) for rank, each in enumerate(found.rows[:top], 1)]
    return Table(title(found), heads, rows, numbers=[0, *range(3, len(heads))])


def title(found: Survey) -> str:
    """Return the number of structures, as a heading."""
    count = len(found.rows)
    return f"{count:,} structure{'s' * (count != 1)}, the most vulnerable first"


def sentences(found: Survey, top: int | None = None) -> list[str]:
    """Return sentences on how to read the rows."""
    rows, many = found.rows, len(found.rows)
    said = [f"Ranked {RANKED[found.by]}."]
    if top is not None and many > top:
        said[0] = f"Showing {top} of {many:,}, ranked {RANKED[found.by]}."
    if found.motions:
        under = [each.under for each in rows if each.under is not None]
        falls = sum(each.overturned > 0 for each in under)
        lifts = sum(each.at_most > 0 or each.peak_ratio > 0 for each in under)
        motions = f"the {len(found.motions)} motions" if len(found.motions) > 1 else found.motions[0]
        said.append(
            f"Under {motions}, by the nonlinear model, {lifts:,} of {many:,} uplift and {falls:,} are known "
            "to overturn. The peak is the largest rotation over the critical rotation among the motions that do not "
            "overturn the structure. One time history is one sample: use `rocking respond` and "
            "`rocking margin` to see how close the result is."
        )
        said += _not_known(rows)
    cautioned = [each for each in rows if each.caution is not None]
    said += [f"Caution: {each.name}: {each.caution}" for each in cautioned[:CAUTIONED]]
    if len(cautioned) > CAUTIONED:
        said.append(f"{len(cautioned) - CAUTIONED:,} more structures have such a caution: JSON lists them all.")
    without = [each for each in rows if each.no_block is not None]
    if without:
        said.append(
            f"{_named(without)}: no equivalent single block, so only lambda is given and not p; `rocking equiv` gives "
            "the reason."
        )
    return said


def _not_known(rows: Sequence[Surveyed]) -> Iterator[str]:
    """Yield sentences on the structures with unknown outcomes, and on those with unchecked joints."""
    doubtful = [each for each in rows if each.under is not None and each.under.unknown]
    if doubtful:
        yield (
            f"{_named(doubtful)}: the outcome under at least one motion is unknown, as a joint opens or slides that "
            "the model keeps closed: it may overturn. The peak leaves such motions out. Next: `rocking respond` names "
            "the joint and the time."
        )
    unchecked = [each for each in rows if each.under is not None and each.under.unknown is None]
    if unchecked:
        yield f"Caution: the joints of {_named(unchecked)} are not checked: it is not known which of them stay closed."


def _named(rows: Sequence[Surveyed], most: int = 3) -> str:
    names = ", ".join(cut(one_line(each.name), NAME) for each in rows[:most])
    return names if len(rows) <= most else f"{len(rows):,} structures ({names}, ...)"


def bad_lines(found: Sequence[Bad], file: str, most: int) -> Iterator[str]:
    """Yield the errors of structures that could not be used: of the first ones in full, then the number of others."""
    for each in found[:most]:
        said = str(each.error)
        place = "" if said.startswith(f"{one_line(file)}:") else f"{one_line(file)}:{each.line}: "
        place = place.removesuffix(f"{each.line}: ") if said.startswith(f"{each.line}: ") else place
        yield f"{place}{said}"
    if len(found) > most:
        yield f"{len(found) - most:,} more structures cannot be used: `as_json` lists them all"
