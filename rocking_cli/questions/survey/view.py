"""View of a survey of structures, ranked, as text and as data."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import asdict, replace
from functools import partial
from math import isnan
from typing import Any, NamedTuple

from rocking_cli.core.registry import Registry
from rocking_cli.errors import named
from rocking_cli.io.spreadsheet import Spreadsheet
from rocking_cli.io.tables import Columns
from rocking_cli.names import UNKNOWN, digits_apart, percent
from rocking_cli.questions.survey.study import LEVELS, FailedEntry, Survey, Surveyed
from rocking_cli.questions.survey.wording import MIN_TOLD_SLIP, SurveyedObject, advice
from rocking_cli.studies.conclusion import Concluded, Conclusion
from rocking_cli.text import cut, one_line
from rocking_cli.views.cautions import in_language
from rocking_cli.views.column import Column, data_of, frame_of, of, only_shown, rounded, table_of
from rocking_cli.views.conclusion import concluded_in_words, limits_in_words, uncounted_ties
from rocking_cli.views.neighbours import deviations
from rocking_cli.views.sheet.language import ENGLISH, Language, texts_of, translated
from rocking_cli.views.view import Aside, Table, View, number

MAX_NAME_LENGTH = 30  # characters, in the table
MAX_CAUTIONED = 3  # structures whose cautions are printed
SATURATED = 0.99  # share of neighbours from which ranks hardly differ
PLAIN_FRICTION = 0.3  # coefficient of friction that many floors are taken to have
CODE = re.compile(r"[-+]?(0\d|\d{16})")
ROWS_PER_BLOCK = 10_000  # rows of a file that are written at once
RANKED = {
    "lambda": "by ground acceleration at uplift",
    "ratio": "by the ratio of capacity to demand under the code of the site; structures with ratios below 1 fail",
    "response": (
        "by the share of {} that overturn them, then by the largest peak or slip under motions that do not, then by "
        "uplift acceleration; an unknown outcome counts as overturning"
    ),
}


class RankedStructure(NamedTuple):
    """A row of a survey: the rank of a structure, from 1, its results, and its cells in the table."""

    rank: int
    found: Surveyed
    cells: Sequence[str] = ()


def _limit_state(row: RankedStructure) -> str | None:
    return (row.found.verified.limit_state or None) if row.found.verified is not None else None


def _not_counted(row: RankedStructure) -> str | None:
    verified = row.found.verified
    return ", ".join(each.name for each in verified.left_out) or None if verified is not None else None


def caution_of(row: RankedStructure, say: Language = ENGLISH) -> str | None:
    """Return the cautions on a structure, and what limits its verification, as one text; None without any."""
    limits = limits_in_words(row.found.verified, say) if row.found.verified is not None else []
    known, mechanism = " ".join(limits), row.found.mechanism
    of_all = Registry()[mechanism].caution if row.found.cautions and say.key != ENGLISH.key else ""
    cautions = [in_language(mechanism, of_all, each, say) for each in row.found.cautions]
    return " ".join([each for each in cautions if each not in known] + limits) or None


def _marked(row: RankedStructure, say: Language = ENGLISH) -> str | None:
    """Return what is doubtful of the size of a structure, and the cautions on it, as one text; None without any.

    In another language than English the fields are named; warnings have the doubts in words.
    """
    doubt = row.found.doubt
    if doubt is not None and say.key != ENGLISH.key:
        fields = [each.partition(" is ")[0].partition(" has ")[0] for each in doubt.split("; ")]
        doubt = say("Unusual or missing: {fields}.", fields=", ".join(fields))
    return " ".join(filter(None, [doubt, caution_of(row, say)])) or None


def _share(row: RankedStructure) -> str | None:
    """Return the share of neighbours that overturn a structure, as a range if outcomes are unknown."""
    if row.found.under is None or (share := row.found.under.share) is None:
        return None
    low, high = percent(share.lowest), percent(share.highest)
    return low if low == high else f"{low.removesuffix(' %')} to {high}"


def _from(level: float, k: int) -> Callable[[RankedStructure], float | None]:
    """Return the function of a row that gives the least peak of motions, PGA or PGV, at which a share topples it."""
    return lambda row: row.found.toppled_from(level)[k]


def _topples(row: RankedStructure) -> list[dict[str, Any]] | None:
    """Return how strong each motion must be, as plain data."""
    return [
        {
            "motion": each.motion, "pga": each.pga, "base_pga": each.base_pga, "pgv": each.pgv,
            "share_lowest": each.share.lowest, "share_highest": each.share.highest,
            "factor_5": each.factors[LEVELS[0]], "factor_50": each.factors[LEVELS[1]],
            "tried_from": each.tried[0], "tried_to": each.tried[1],
        }
        for each in row.found.topples
    ] or None  # fmt: skip


def _peak(peak: float) -> str:
    return "no uplift" if peak == 0 else number(peak, 3)


STRUCTURE: tuple[Column[RankedStructure], ...] = (
    Column("rank", of("rank"), head="rank"),
    Column("name", of("found.name"), head="name", form=one_line, text=True),
    Column("mechanism", of("found.mechanism"), head="mechanism", text=True, rank=4),
    Column("side", of("found.side"), head="side", text=True),
    Column("row", of("found.row")),
    Column("line", of("found.line")),
)
OF_SITE: tuple[Column[RankedStructure], ...] = (
    Column("ratio", of("found.ratio"), head="ratio"),
    Column("concluded", of("found.verified.concluded.value"), head="verified", form=concluded_in_words, text=True),
    Column("limit_state", _limit_state, head="governs", text=True, rank=2),
    Column("not_counted", _not_counted, head="not\ncounted", text=True),
)
OF_ROW_SITE: tuple[Column[RankedStructure], ...] = (
    Column("site", of("found.site"), head="site", text=True, rank=1),
    Column("z", of("found.z"), "m", "z [m]", rank=1),
)
OF_NEIGHBOURS: tuple[Column[RankedStructure], ...] = (
    only_shown("neighbours\noverturn", _share),
    Column("share_lowest", of("found.under.share.lowest")),
    Column("share_highest", of("found.under.share.highest")),
)
UNDER_MOTIONS: tuple[Column[RankedStructure], ...] = (
    Column("overturned", of("found.under.overturned"), head="overturn\nit", form=percent),
    Column("unknown", of("found.under.unknown"), head="unknown", form=percent),
    Column("peak_ratio", of("found.under.peak_ratio"), head="largest\npeak", form=_peak, rank=1),
    Column("slip", of("found.under.slip"), "m", "largest\nslip [m]", rounded(3), rank=1),
    Column("peak_over", of("found.under.over"), text=True),
    Column("outcome", of("found.under.concluded.value"), text=True),
    Column("worst", of("found.under.worst"), text=True),
)
OF_LIST: tuple[Column[RankedStructure], ...] = (
    Column("danger", of("found.danger"), head="in short", text=True),
    *(
        Column(
            f"{key}_{100 * level:.0f}",
            _from(level, k),
            unit,
            f"{percent(level)} from\n{key.upper()} [{unit}]",
            rounded(2),
            rank=rank,
        )
        for k, (key, unit, rank) in enumerate((("pga", "g", 0), ("pgv", "m/s", 3)))
        for level in LEVELS
    ),
    Column("clearance", of("found.clearance"), "m"),
    Column("topples", _topples),
    Column("remarks", lambda row: [*row.found.remarks] or None),
    Column("remedies", lambda row: [asdict(each) for each in row.found.remedies] or None),
    Column("in_space", lambda row: [each._asdict() | {"differs": each.differs} for each in row.found.space] or None),
    Column("not_in_space", of("found.not_in_space"), text=True),
)
PARAMETERS: tuple[Column[RankedStructure], ...] = (
    Column("lambda", of("found.lambda_"), head="lambda", rank=3),
    Column("uplift", of("found.uplift"), "g"),
    Column("direction", of("found.direction"), text=True),
    Column("p", of("found.p"), "rad/s", "p\n[rad/s]", rank=6),
    Column("phi_cr", of("found.phi_cr"), "rad", "phi_cr\n[rad]", rank=6),
    Column("kappa1", of("found.kappa1")),
    Column("kappa2", of("found.kappa2"), head="kappa2", rank=6),
    Column("eta", of("found.eta"), head="eta", rank=6),
    Column("no_block", of("found.no_block"), text=True),
    Column("doubt", of("found.doubt"), text=True),
    Column("caution", caution_of, text=True),
)


OF_MOTIONS = {"overturned", "unknown"}
"""Keys of the columns on the motions themselves, which tables do not show beside those of their neighbours."""
RARE = ("side", "slip", "unknown", "not_counted")
"""Keys of the columns that tables show only if any row has a value."""


def texts_in(key: str) -> Language:
    """Return a language with the texts of a survey."""
    return Language(key, texts_of("rocking_cli.questions.survey", key), is_plain=True)


def view(found: Survey, top: int, say: Language = ENGLISH) -> View:
    """Show the most vulnerable structures, and how many of all overturn."""
    parts: list[Table | str] = []
    if found.rows:
        parts = [*counts(found), table(found, top, say=say), *sentences(found, top, say)]
    return translated(say, View(lambda: data(found), parts))


def data(found: Survey) -> dict[str, Any]:
    """Return a survey as plain data."""
    applying, headings = _columns(found), found.sheet.columns if found.sheet is not None else {}

    def one(row: RankedStructure) -> dict[str, Any]:
        cells = {"cells": {heading: row.cells[k] for k, heading in headings.items()}}
        return data_of(applying, row) | (cells if headings else {})

    return {
        "ranked_by": found.by,
        "motions": list(found.motions),
        "neighbours": asdict(found.around) if found.around.count else None,
        "rows": [one(row) for row in _ranked(found)],
        "bad": [
            {"row": each.row, "line": each.line, "name": one_line(each.name), "reason": each.reason}
            for each in found.bad
        ],
    }


def _columns(found: Survey, say: Language = ENGLISH) -> list[Column[RankedStructure]]:
    """Return the columns that apply to a survey; what to do about objects is told in a language."""
    to_do = Column("what_to_do", partial(_advice, found, say), head="what to do", text=True, rank=1)
    return [
        *STRUCTURE,
        *(OF_SITE if found.by == "ratio" else ()),
        *(each for each in OF_ROW_SITE if len({getattr(row, each.key or "") for row in found.rows}) > 1),
        *(_number(name, unit) for name, unit in found.units.items()),
        *(OF_NEIGHBOURS if found.around.count else ()),
        *(UNDER_MOTIONS if found.motions else ()),
        *((*OF_LIST, to_do) if found.items else ()),
        *PARAMETERS,
    ]


def _number(name: str, unit: str) -> Column[RankedStructure]:
    """Return the column of a number that the code of the site has for a row."""
    return Column(name, lambda row: row.found.numbers[name], unit, f"{name}\n[{unit}]" if unit else name, rank=5)


def _kept(sheet: Spreadsheet | None, taken: Collection[str]) -> Iterator[Column[RankedStructure]]:
    """Yield the columns of the given table, without those that the survey has under the same name."""
    for place, heading in sheet.columns.items() if sheet is not None else ():
        if heading not in taken or heading not in ("name", "mechanism", "site"):
            name = f"given {heading}" if heading in taken else heading
            yield Column(None, partial(_cell, place), name=name, text=True)


def _cell(place: int, row: RankedStructure) -> str:
    return row.cells[place]


def _ranked(found: Survey, start: int = 0, stop: int | None = None) -> list[RankedStructure]:
    ranked = enumerate(found.rows[start:stop], start + 1)
    return [RankedStructure(rank, each, found.cells(each)) for rank, each in ranked]


def blocks(found: Survey, decimal: str | None) -> Iterator[Columns]:
    """Yield all rows in blocks; see `columns`."""
    for start in range(0, max(len(found.rows), 1), ROWS_PER_BLOCK):
        yield columns(found, start, start + ROWS_PER_BLOCK, decimal)


def columns(found: Survey, start: int = 0, stop: int | None = None, decimal: str | None = None) -> Columns:
    """Return some of the rows as columns of a table, followed by the unchanged columns of the given table.

    With the decimal sign of a spreadsheet, numbers in cells that came in have this sign; with an empty one they are
    numbers.
    """
    rows = _ranked(found, start, stop)
    if not rows:
        return {"rank": [], "name": [], "lambda": []}
    applying = _columns(found)
    frame = frame_of(applying, rows)
    kept = frame_of(_kept(found.sheet, frame), rows)
    for column in applying:
        if column.text:
            frame[column.heading] = list(map(one_line, frame[column.heading]))
    if found.sheet is not None and decimal is not None:
        for cells in kept.values():
            cells[:] = [(_with_decimal if decimal else _as_number)(found.sheet, cell, decimal) for cell in cells]
    return frame | kept


def _as_number(sheet: Spreadsheet, cell: str, _: str) -> float | str:
    """Return a cell that came in, as a number if it is one; a code, such as 0071 or of many digits, is none."""
    number = sheet.number(cell)
    return cell if number is None or CODE.match(number) else float(number)


def _with_decimal(sheet: Spreadsheet, cell: str, decimal: str) -> str:
    """Return a cell that came in, its number or list of numbers with a decimal sign."""
    numbers = [sheet.number(part.strip()) for part in cell.split(";")]
    known = [number.replace(".", decimal) for number in numbers if number is not None]
    return ";".join(known) if len(known) == len(numbers) else cell


def table(found: Survey, top: int, longest: int | None = MAX_NAME_LENGTH, say: Language = ENGLISH) -> Table:
    """Return a table of the first rows, with names of at most `longest` characters."""
    rows, hidden = _ranked(found), OF_MOTIONS if found.around.count else set[str]()
    shown = [
        column for column in _columns(found, say)
        if column.key not in hidden
        and (column.key not in {*RARE, *found.units} or any(column.of(row) not in (None, 0) for row in rows))
    ]  # fmt: skip
    if any(_marked(row) is not None for row in rows):
        mark = partial(_marked, say=say) if longest is None else lambda row: _marked(row) and "yes"
        shown.append(only_shown("caution", mark, text=True))
    whole = table_of(title(found), shown, rows[:top])
    if longest is None:
        return whole
    return replace(whole, rows=[[rank, cut(name, longest), *cells] for rank, name, *cells in whole.rows])


def _advice(found: Survey, say: Language, row: RankedStructure) -> str | None:
    """Return what to do about an object of a list, the first that suffices."""
    one = SurveyedObject(found.items[row.found.row - 1], row.found)
    return advice(one, say, 1) if row.found.topples else None


def title(found: Survey) -> str:
    """Return the number of structures, as a heading."""
    count = len(found.rows)
    return f"{count:,} structure{'s' * (count != 1)}, the most vulnerable first"


def counts(found: Survey) -> list[str]:
    """Return the first sentences: how many structures fail or overturn, what governs, and which is the worst."""
    rows = found.rows
    lines = []
    if loose := [each for each in rows if each.verified is not None and uncounted_ties(each.verified)]:
        lines.append(
            f"Not counted: elastic ties of {_named(loose)}, because they have no strength: give each its `steel` or "
            "`yield`, so that it counts."
        )
    if found.by == "ratio":
        lines.append(" ".join(_of_site(rows)))
    if found.motions:
        lines.append(_of_motions(found))
    if any(each.danger for each in rows):
        lines.append(_of_list(rows))
    if turned := [each for each in rows if each.side is not None]:
        lines.append(
            f"{_named(turned)}: ranked about the depth, the weaker side of the base. Exchange the two for "
            f"`rocking respond`, which takes the width. If a structure cannot rock about its depth, give its column "
            f"{named('plane')} the word width."
        )
    if found.by == "lambda" and len(rows) > 1:
        first, last = rows[0], rows[-1]
        lines.insert(
            0,
            f"Of {_structures(len(rows))}, {_named([first])} uplifts at the lowest ground acceleration, "
            f"{number(first.uplift, 3)} g, and {_named([last])} at the highest, {number(last.uplift, 3)} g.",
        )
    return lines


def _of_site(rows: Sequence[Surveyed]) -> Iterator[str]:
    """Yield how many structures do not satisfy the verification, which limit states govern them, and the worst."""
    ends = [each.verified for each in rows if each.verified is not None]
    fail = [end for end in ends if end.concluded in (Concluded.NOT_SATISFIED, Concluded.UNKNOWN)]
    passed, limited, undecided = (
        sum(end.concluded is each for end in ends)
        for each in (Concluded.SATISFIED, Concluded.SATISFIED_IF, Concluded.NOT_DECIDED)
    )
    if fail:
        does = "does" if len(fail) == 1 else "do"
        first = f"{len(fail):,} of {_structures(len(rows))} {does} not satisfy the verification{_governing(fail)}"
    elif passed == len(rows):
        first = f"{'All structures satisfy' if passed > 1 else 'The structure satisfies'} the verification"
    else:
        satisfy = "satisfies" if passed == 1 else "satisfy"
        first = f"{passed:,} of {_structures(len(rows))} {satisfy} the verification"
    first += f"; {limited:,} only on conditions" if limited else ""
    yield f"{first}; {undecided:,} not decided." if undecided else f"{first}."
    if without := [each for each, end in zip(rows, ends, strict=True) if end.concluded is Concluded.NOT_CHECKED]:
        yield f"Not verified: {_named(without)}; `rocking verify` gives the reason."
    least = rows[0].ratio
    if least is not None and not isnan(least):
        ratio = number(least, digits_apart(least, 1.0, 3))
        yield f"The smallest ratio of capacity to demand is {ratio}, that of {_named(rows[:1])}."


def _governing(fail: Sequence[Conclusion]) -> str:
    """Return which limit states govern the structures that fail, as a clause; empty if a code has none."""
    (first, count), *others = Counter(end.limit_state for end in fail).most_common()
    if not first:
        return ""
    if not others:
        return f"; {first} governs{' all of them' if count > 1 else ''}"
    return f"; {first} governs {count:,}{''.join(f', {state} {n:,}' for state, n in others)} of them"


def _of_motions(found: Survey) -> str:
    """Return how many structures overturn, have an unknown outcome, and uplift under any of the motions."""
    under = [each.under for each in found.rows if each.under is not None]
    falls = sum(each.overturned > 0 for each in under)
    doubtful = sum(bool(each.unknown) and each.overturned == 0 for each in under)
    slides = sum(each.concluded is Concluded.SLIDES for each in under)
    lifts = sum(each.at_most > 0 or each.peak_ratio > 0 for each in under)
    motions = f"at least one of {len(found.motions)} motions" if len(found.motions) > 1 else found.motions[0]
    unknown = f", {doubtful:,} may overturn (unknown outcome)" if doubtful else ""
    unknown += f", {slides:,} only {'slides' if slides == 1 else 'slide'}" if slides else ""
    verb = "overturns" if falls == 1 else "overturn"
    first = f" {_named(found.rows[:1])} ranks first." if found.by == "response" and len(under) > 1 else ""
    return (
        f"Under {motions}, {falls:,} of {_structures(len(under))} {verb}{unknown}, and {lifts:,} "
        f"{'uplifts' if lifts == 1 else 'uplift'}.{first}"
    )


def _of_list(rows: Sequence[Surveyed]) -> str:
    """Return how many objects of a list fall, may fall and stand, and what these words mean."""
    count = Counter(each.danger for each in rows)
    return (
        f"Objects that fall: {count['falls']:,}, that may fall: {count['may fall']:,}, and that stand: "
        f"{count['stands']:,}. Of the neighbours of the worst motion, half or more, more than {percent(LEVELS[0])}, or "
        "at most so many overturn them or have an unknown outcome."
    )


def _structures(count: int) -> str:
    return f"{count:,} structure{'s' * (count != 1)}"


def sentences(found: Survey, top: int | None = None, say: Language = ENGLISH) -> list[str]:
    """Return sentences on how to read the rows."""
    rows, many = found.rows, len(found.rows)
    ranked = RANKED[found.by].format("neighbouring motions" if found.around.count else "motions")
    lines = [f"Showing {top} of {many:,}."] if top is not None and many > top else []
    lines.append(Aside(f"Ranked {ranked}."))
    if found.pga:
        lines.append(" ".join(_of_peaks(found)))
    lines += _of_supports(found)
    if found.motions and any(row.z for row in rows):
        lines.append("The motions are the same at every height z: the floors of a site only concern its code.")
    if found.motions:
        lines.append(Aside(
            "Time histories are by the nonlinear model. The peak is the largest rotation over the critical rotation "
            "among the motions that do not overturn the structure."
        ))  # fmt: skip
        if any(each.under is not None and each.under.peak_ratio > 1 for each in rows):
            lines.append("A peak above 1 passed the critical rotation, and the motion brought the structure back.")
        lines += _of_neighbours(found)
        lines += _not_known(rows)
    cautions = [(each.name, caution_of(RankedStructure(0, each), say)) for each in rows]
    cautioned = [(name, caution) for name, caution in cautions if caution is not None]
    lines += [say("Caution: {text}", text=f"{name}: {caution}") for name, caution in cautioned[:MAX_CAUTIONED]]
    if len(cautioned) > MAX_CAUTIONED:
        lines.append(
            f"{len(cautioned) - MAX_CAUTIONED:,} more structures have such a caution: JSON and CSV list them all."
        )
    if unsized := [each for each in rows if each.width_alone]:
        lines.append(f"{_named(unsized)}: depth not given, so only the width was examined.")
    if held := [each for each in rows if each.any_friction and each.lambda_ > PLAIN_FRICTION]:
        lines.append(
            f"{_named(held)}: without {named('friction')} nothing slides, but to rock they need more than "
            f"{PLAIN_FRICTION:g}, up to {number(max(each.lambda_ for each in held), 3)}: on smoother floors they slide."
        )
    if any(each.unprinted for each in rows):
        lines.append(
            "Caution: formulas of the code have not been checked against the printed code yet: have them checked "
            "before you rely on a verdict. `rocking verify` names them."
        )
    if without := [each for each in rows if each.no_block is not None]:
        lines.append(Aside(
            f"{_named(without)}: no equivalent single block, so only lambda is given and not p; `rocking equiv` gives "
            "the reason."
        ))  # fmt: skip
    return lines


def _of_peaks(found: Survey) -> Iterator[str]:
    """Yield how strong the motions are, in which polarity they are, and that one record is one sample."""
    yield f"{_peaks('PGA of the ground', found.pga)}."
    if found.floor_pga:
        yield f"The structures stand on a floor: {_peaks('PGA of the floor', found.floor_pga)}."
    if len(found.polarities) == 1:
        way = "as given" if found.polarities[0] > 0 else "reversed"
        other = f"unless a structure is symmetric, the other may be worse. Give {named('polarity')} both."
        yield f"Motions {way} only: {other}"
    if len(found.motions) == 1 and found.around.count:
        yield "One record is one sample: use several."


def _of_supports(found: Survey) -> Iterator[str]:
    """Yield on what objects of a list stand that is not the ground, what differs in space, and which slide far."""
    if not (found.items and found.motions):
        return
    rows = [(each, found.items[each.row - 1]) for each in found.rows]
    if moved := [each for each, item in rows if item.base != (None, None)]:
        peaks = [peak.base_pga for each in moved for peak in each.topples]
        yield f"{_named(moved)}: on floors or isolators of their own" + (
            f", {_peaks('with a PGA', peaks)}." if peaks else "."
        )
    if high := [each for each, item in rows if item.storey and item.base[0] is None and not found.floor_pga]:
        yield (
            f"Caution: {_named(high)}: on an upper floor, which moves more than the ground, whose motion was used. "
            f"Give {named('floor')}, such as T1=0.3,z/H=0,n=3: then each stands on its own storey."
        )
    yield from _in_space(found.rows)
    if far := [each for each in found.rows if each.clearance >= MIN_TOLD_SLIP]:
        most = max(each.clearance for each in far)
        yield f"{_named(far)}: slides by up to {number(most, 2)} m: keep that clear on all sides."


def _in_space(rows: Sequence[Surveyed]) -> Iterator[str]:
    """Yield where objects do something else in three dimensions than in the plane, and which were not simulated."""
    if not any(each.space or each.not_in_space for each in rows):
        return
    worse = [each for each in rows if any(one.differs and one.topples_in_space for one in each.space)]
    better = [each for each in rows if any(one.differs and not one.topples_in_space for one in each.space)]
    unknown = [each for each in rows if any(one.outcome == UNKNOWN for one in each.space)]
    yield "In three dimensions (experimental), one history of each object as it is listed, without neighbours:"
    if worse:
        yield f"Overturn in space, and not in the plane: {_named(worse)}."
    if better:
        yield f"Overturn in the plane, and not in space: {_named(better)}."
    if unknown:
        yield f"Unknown in space, as half the time step gives another outcome: {_named(unknown)}."
    if not (worse or better or unknown):
        yield "The plane and space give the same outcomes."
    if left_out := [each for each in rows if each.not_in_space]:
        yield f"Not simulated in space: {_named(left_out)}; the JSON has the reasons."


def _peaks(what: str, peaks: Sequence[float]) -> str:
    low, high = number(min(peaks), 3), number(max(peaks), 3)
    return f"{what} {low} g" if low == high else f"{what} from {low} to {high} g"


def _of_neighbours(found: Survey) -> Iterator[str]:
    """Yield what the shares are shares of, and why there are fewer neighbours than usual, or none."""
    fewer = f"more would take over a minute for this table: give {named('neighbours')} to fix their number"
    if not found.around.count:
        why = f" There are no neighbours, as {fewer}." if found.reduced else ""
        yield f"One time history is one sample: `rocking margin` shows how close the result is.{why}"
        return
    of = f"{found.around.count} neighbours ({deviations(found.around)})"
    most = [each for each in found.rows if each.under and each.under.share and each.under.share.lowest >= SATURATED]
    if len(most) > 1:
        yield (
            f"{_structures(len(most))} overturn with {percent(SATURATED)} or more of their neighbours, which hardly "
            "ranks them: use a weaker motion."
        )
    of_all = "the largest of them" if found.items else "the mean over the motions"
    mean = f" of each motion, {of_all}" if len(found.motions) > 1 else ""
    share = f"The share is that of {of}{mean}"
    yield f"{share}; {fewer}." if found.reduced else Aside(f"{share}.")


def _not_known(rows: Sequence[Surveyed]) -> Iterator[str]:
    """Yield sentences on the structures with unknown outcomes, and on those with unchecked joints."""
    if doubtful := [each for each in rows if each.under is not None and each.under.unknown]:
        why = "a joint opens or slides that the model keeps closed"
        if any(each.topples for each in doubtful):
            why = f"it meets a neighbour, its isolator ends, or {why}"
        yield (
            f"{_named(doubtful)}: the outcome under at least one motion is unknown, as {why}: it may overturn. The "
            "peak leaves such motions out. Next: `rocking respond` names the joint and the time."
        )
    if unchecked := [each for each in rows if each.under is not None and each.under.unknown is None]:
        yield f"Caution: the joints of {_named(unchecked)} are not checked: it is not known which of them stay closed."


def _named(rows: Sequence[Surveyed], most: int = 3) -> str:
    names = ", ".join(cut(one_line(each.name), MAX_NAME_LENGTH) for each in rows[:most])
    return names if len(rows) <= most else f"{len(rows):,} structures ({names}, ...)"


def bad_lines(found: Sequence[FailedEntry], file: str, most: int) -> Iterator[str]:
    """Yield the errors of structures that could not be used: of the first ones in full, then the number of others."""
    for each in found[:most]:
        message = str(each.error)
        place = "" if message.startswith(f"{one_line(file)}:") else f"{one_line(file)}:{each.line}: "
        place = place.removesuffix(f"{each.line}: ") if message.startswith(f"{each.line}: ") else place
        yield f"{place}{message}"
    if len(found) > most:
        yield f"{len(found) - most:,} more structures cannot be used: JSON lists them all"
