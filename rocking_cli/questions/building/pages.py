"""The sheet of a building: the verdict with picture and table, and a section for each mechanism that counts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.excitation.records.opening import original
from rocking_cli.plotting.style import in_language
from rocking_cli.questions.building.made import tie_height
from rocking_cli.questions.building.picture import draw_building
from rocking_cli.questions.building.study import Assessed, BarsOfLevel, Found
from rocking_cli.questions.building.view import (
    PACKAGE,
    compared,
    conditions,
    designed_in_words,
    notes,
    ranked,
    verdict,
    words,
)
from rocking_cli.studies.conclusion import Concluded
from rocking_cli.studies.provenance import File, versions
from rocking_cli.verification.check import code_of
from rocking_cli.views.cautions import cautions_of
from rocking_cli.views.conclusion import limits_in_words
from rocking_cli.views.sheet.build import SIGNATURE_FIELDS, SheetSources, sheet
from rocking_cli.views.sheet.document import Sheet, SheetPart, guarded, sections
from rocking_cli.views.sheet.language import translated
from rocking_cli.views.verification import showing, shown
from rocking_cli.views.view import Table, View

if TYPE_CHECKING:
    from rocking_cli.ask.watcher import Watcher
    from rocking_cli.questions.building.asked import BuildingAsked

DETAILED = 4  # kinds of mechanisms whose worst has a section, so that the sheet has six pages at most
LISTED_FIRST, MAX_LISTED = 8, 40  # rows of the table on the first page, and of that of all


def write_sheet(
    asked: BuildingAsked, found: Assessed, designed: BarsOfLevel | None, language: str, watch: Watcher
) -> None:
    """Write the sheet of a building. Raises `InputError` if what makes its format is not there."""
    from rocking_cli.questions.verify import sheets

    assert asked.sheet is not None  # asked for it
    title = asked.title(asked.origin or "rocking_cli.building(...)", language)
    say = words(language, is_plain=False)
    rows = ranked(found, say)
    figure = in_language(say, partial(draw_building, found, words(language)))
    kinds = [row.made.kind for row in found.rows]
    counted = [row for k, row in enumerate(found.rows) if row.made.kind not in kinds[:k]][:DETAILED]
    other = found.strengthened
    context: dict[str, Any] = {
        "found": found, "ranked": rows, "listed": LISTED_FIRST, "most": MAX_LISTED,
        "designed": [] if designed is None else [*map(guarded, designed_in_words(designed, say))],
        "counted": [*map(partial(_section, say), counted)],
        "verdict": [*map(guarded, verdict(found, say))], "conditions": [*map(guarded, conditions(other or found, say))],
        "notes": [*map(guarded, notes(found, say))], "fails": found.conclusion.concluded is not Concluded.SATISFIED,
        "figure": figure, "command": title.command, "files": _files(asked, found), "walls": _walls(found, say),
        "floors": _floors(found, say), "ties": _ties(found),
        "after": [] if other is None else [*map(guarded, verdict(other, say))],
        "compared": None if other is None else translated(say, View({}, [compared(found, other, say)])).parts[0],
    }  # fmt: skip
    parts = sections(say, PACKAGE, "building", context)
    made = SheetSources(File("building", b""), None, {}, versions(found.governs.structure.mechanism))
    if asked.appendix:
        for rank, each in enumerate(counted, 1):
            of_code = sheet(each.verification, found.site, say, title, made)
            parts += [_appended(part, rank, each, say) for part in of_code.parts if part.key == "workings"]
    name, where = found.building.name or say("building"), found.site.site.name or ""
    about = {say("Structure"): name} | {say(key.capitalize()): text for key, text in title.fields.items()}
    about |= ({say("Site"): where} if where else {}) | {say("Date"): title.date}
    about |= {say("Program"): f"rocking-cli {made.versions['rocking-cli']}"}
    code = code_of(found.site)
    heading, subtitle = say("sheet", name=name), say("subtitle", code=code.edition)
    running = " · ".join(filter(None, [heading, title.project, title.place or where, title.client]))
    document = Sheet(say, heading, subtitle, about, parts, title.logo, SIGNATURE_FIELDS, (), title.author, running)
    sheets.write(asked.sheet, document, watch)


def _section(say: Any, row: Found) -> dict[str, Any]:
    """Return the values of the section of a mechanism."""
    spoken = showing(row.verification).in_language(say.key)
    sides = shown(row.verification, spoken.say)
    parts = [part for where, each in sides.items() for part in spoken.in_short(row.verification, each, where)]
    tables = [part for part in translated(spoken.say, View({}, parts)).parts if isinstance(part, Table)]
    cautions: Sequence[str] = cautions_of(row.structure.mechanism, say)
    limits = limits_in_words(row.conclusion, spoken.say)
    return {
        "title": say(row.made.title), "row": row, "tables": tables[:2],
        "texts": [guarded(each) for each in (*limits, *cautions)], "mechanism": row.structure.mechanism,
    }  # fmt: skip


def _appended(part: SheetPart, rank: int, row: Found, say: Any) -> SheetPart:
    """Return the workings of a mechanism with anchors of their own."""
    heading = f"{say('appendix')} {rank}: {say(row.made.title)}"
    within = [replace(each, key=f"m{rank}-{each.key}") for each in part.parts]
    return replace(part, key=f"workings-{rank}", heading=heading, parts=within)


def _files(asked: BuildingAsked, found: Assessed) -> list[File]:
    site = found.site.document.file if isinstance(found.building.site, str) else None
    given = (asked.building, asked.strengthened, asked.site or site)
    return [File(str(each), original(each)) for each in given if isinstance(each, str | Path)]


def _walls(found: Assessed, say: Any) -> list[list[Any]]:
    rows, levels = list[list[Any]](), found.building.levels
    for wall in found.building.walls:
        foot, top = wall.reaches(found.building.count)
        thick = dict.fromkeys(wall.thick(k) for k in range(foot + 1, top + 1))
        ends = levels[foot], levels[top], wall.length, "; ".join(say.number(t) for t in thick)
        rows.append([wall.name, *ends, say(f"connection_{wall.connection}")])
    return rows


def _floors(found: Assessed, say: Any) -> list[list[Any]]:
    weight = [(name, each, each.load * STANDARD_GRAVITY / 1e3) for name, _, each in found.building.bearing]
    how = [say("slides") if each.sliding else say("held") for _, each, _ in weight]
    return [
        [name, ", ".join(each.walls), load, each.span, each.thrust / 1e3, word]
        for (name, each, load), word in zip(weight, how, strict=True)
    ]


def _ties(found: Assessed) -> list[list[Any]]:
    building = found.building
    return [
        [each.name, ", ".join(each.walls), tie_height(building, each), f"{each.bars} x {1e3 * each.diameter:.0f} mm"]
        for each in building.ties
    ]
