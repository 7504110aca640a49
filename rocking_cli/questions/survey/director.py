"""What a survey of a list of objects hands over: a document by rooms for who decides, and cards for the stores."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from functools import partial
from math import nan
from pathlib import Path
from typing import Any, NamedTuple

from rocking_cli.ask.watcher import Watcher
from rocking_cli.errors import InputError, named
from rocking_cli.excitation.records.opening import original
from rocking_cli.io.files import write_whole
from rocking_cli.processing.reading import Scaled
from rocking_cli.questions.survey.asked import SurveyAsked
from rocking_cli.questions.survey.inventory import Inventory
from rocking_cli.questions.survey.portraits import DRAWN_TOGETHER, draw_room, scale_of, write_cards
from rocking_cli.questions.survey.study import FEWEST_NEIGHBOURS, LEVELS, Survey
from rocking_cli.questions.survey.view import RankedStructure, caution_of
from rocking_cli.questions.survey.wording import DANGERS, SurveyedObject, advice, objects, printed, reading
from rocking_cli.questions.verify import sheets
from rocking_cli.studies.provenance import File, TitleBlock, file_of_motion, versions
from rocking_cli.views.sheet.document import Drawing, Sheet, sections
from rocking_cli.views.sheet.language import ENGLISH, Language

PACKAGE = "rocking_cli.questions.survey"
MAX_URGENT = 12  # objects on the first page
HIGHEST = 8.0  # cm of a picture on paper


def check(asked: SurveyAsked, entries: Sequence[Any]) -> None:
    """Raise `InputError`, before any work, if the document or the cards of objects cannot be made."""
    of_page, shaken = asked.has_document, bool(asked.ground_motions)
    what = f"{named('page')} {asked.page}" if of_page else f"{named('labels')} {asked.labels}"
    if not isinstance(entries, Inventory):
        other = f", or {named('page')} a file that ends in .html" if of_page else ""
        raise InputError(f"{what} is for a list of objects, with headings such as `Height (cm)`: give one{other}")
    if not shaken or (asked.neighbours is not None and asked.neighbours < FEWEST_NEIGHBOURS):
        give = f"leave out {named('neighbours')}" if shaken else f"give ground motions, such as {named('motions')}"
        least = f"ground motions and {FEWEST_NEIGHBOURS} neighbours or more"
        raise InputError(f"{what} tells which objects fall, which requires {least}: {give}")
    if of_page and asked.page is not None:
        sheets.check_program(asked.page.suffix.lower())


def write(asked: SurveyAsked, found: Survey, motions: Sequence[Scaled], language: str, watch: Watcher) -> None:
    """Write the document and the cards that are requested.

    Raises
    ------
    InputError
        If there are no neighbours, as they would take too long, or what makes a format is not there.
    Refused
        If a file cannot be written.
    """
    if found.around.count < FEWEST_NEIGHBOURS:
        raise InputError(f"no classes: neighbours would take too long; give {named('neighbours')} their number")
    if asked.page is not None and asked.has_document:
        title = asked.title(asked.origin or "rocking_cli.survey(...)", language)
        source = [asked.structures] if isinstance(asked.structures, str | Path) else []
        files = [File(Path(each).name, original(each)) for each in source]
        files += [replace(file, name=Path(file.name).name) for file in map(file_of_motion, motions) if file is not None]
        sheets.write(asked.page, document(found, title, files, printed(language)), watch)
    if asked.labels is not None:
        every = sorted(objects(found), key=lambda each: each.item.line)
        write_whole(asked.labels, partial(write_cards, objects=every, say=printed(language)))
        watch.note(f"wrote {asked.labels}")


class RoomOfList(NamedTuple):
    """A room with its objects, the worst first."""

    name: str
    objects: Sequence[SurveyedObject]
    say: Language

    @property
    def counts(self) -> list[int]:
        """Number of the objects of each class."""
        return [sum(each.danger == danger for each in self.objects) for danger in DANGERS]

    @property
    def pictures(self) -> Iterator[Drawing]:
        """Pictures of a few objects each, to one scale."""
        parts = [self.objects[k : k + DRAWN_TOGETHER] for k in range(0, len(self.objects), DRAWN_TOGETHER)]
        scale = min(map(scale_of, parts))
        for part in parts:
            yield Drawing("", partial(draw_room, part, self.say, scale), HIGHEST)

    @property
    def table(self) -> list[list[str]]:
        """Rows of its table."""
        return [reading(each, self.say) for each in self.objects]


def document(found: Survey, title: TitleBlock, files: Sequence[File], say: Language) -> Sheet:
    """Return the document on a list of objects: the answer, the rooms, what the list leaves open, and an appendix.

    Parameters
    ----------
    found : Survey
        The survey, whose objects have classes.
    title : TitleBlock
        Project, place, client, author, date and command.
    files : sequence of File
        The list and the records.
    say : Language
        The language, with the texts of a survey.
    """
    every = objects(found)
    names = dict.fromkeys(each.room for each in found.items)
    rooms = [RoomOfList(name, [each for each in every if each.item.room == name], say) for name in names]
    urgent = [each for each in every if each.danger != "stands"]
    counts = Counter(each.danger for each in every)
    used = {name: text for name, text in versions(every[0].item.make()).items() if not name.startswith("mechanism")}
    source = "" if found.sheet is None else Path(found.sheet.file).name
    context: dict[str, Any] = {
        "found": found, "total": len(every), "counts": [counts[danger] for danger in DANGERS], "used": used,
        "rooms": sorted((each for each in rooms if each.objects), key=lambda room: not room.name),
        "urgent": [[each.number(say), each.item.title, each.item.room, say(each.danger), advice(each, say, 1)]
                   for each in urgent[:MAX_URGENT]],
        "of_urgent": len(urgent), "command": title.command, "files": files,
        "questions": [*_questions(found, say)],
        "bad": [[str(each.line), each.name, say.recognised("shown", each.reason)] for each in found.bad],
        "on_base": [peak.base_pga for each in every for peak in each.found.topples
                    if found.floor_pga or each.item.base != (None, None)],
        "unread": "; ".join(every[0].item.inventory.unread),
        "undecided": _numbers([each for each in every if _undecided(each)], say),
        "raised": _numbers([each for each in every if each.item.raised], say),
        "upstairs": _numbers([each for each in every if each.item.storey and each.item.base[0] is None
                              and not found.floor_pga], say),
        "in_space": _numbers([each for each in every if each.danger != "falls"
                              and any(one.differs and one.topples_in_space for one in each.found.space)], say),
        "loose": any("friction" not in each.item.sizes for each in every),
        "symbols": [*_symbols(found, say)],
        "remarks": _grouped(((each, say.recognised("shown", text)) for each in every for text in each.item.remarks),
                            say),
        "cautions": _grouped(((each, text) for each in every
                              if (text := caution_of(RankedStructure(0, each.found), say))), say),
    }  # fmt: skip
    heading = title.project or say("Objects in earthquakes: {source}", source=source)
    about = {say(key.capitalize()): text for key, text in title.known.items() if key != "project"}
    about |= {say("List"): source} if source and title.project else {}
    about |= {say("Date"): title.date, say("Program"): f"rocking-cli {used['rocking-cli']}"}
    parts = sections(say, PACKAGE, "director", context)
    subtitle = say("What falls, what stands, and what to do")
    return Sheet(
        say, heading, subtitle, about, parts, title.logo, own_pages=["appendix"], author=title.author, running=heading
    )


def _numbers(some: Sequence[SurveyedObject], say: Language) -> str:
    return ", ".join(each.number(say) for each in sorted(some, key=lambda each: each.item.line))


def _undecided(one: SurveyedObject) -> bool:
    """Return whether its class would be another if no case of unknown outcome fell."""
    lowest, worst = (max(getattr(each.share, key) for each in one.found.topples) for key in ("lowest", "highest"))
    few, half = LEVELS
    return bool(lowest <= few < worst or lowest < half <= worst)


def _questions(found: Survey, say: Language) -> Iterator[list[str]]:
    """Yield number, object and question of what looks like a mistake; other doubts in English, or their fields."""
    doubts = {each.row: each.doubt for each in found.rows if each.doubt is not None}
    for row, each in enumerate(found.items, 1):
        texts = [say.recognised("shown", question) for question in each.questions]
        if doubt := doubts.get(row, "").removeprefix("; ".join(each.questions)).removeprefix("; "):
            fields = ", ".join(one.partition(" is ")[0].partition(" has ")[0] for one in doubt.split("; "))
            texts += [doubt if say.key == ENGLISH.key else say("Unusual or missing: {fields}.", fields=fields)]
        yield from ([each.code or say("row {line}", line=each.line), each.title, text] for text in texts)


def _grouped(texts: Iterable[tuple[SurveyedObject, str]], say: Language) -> list[list[str]]:
    """Return each text once, with the numbers of the objects that have it."""
    having = defaultdict[str, list[SurveyedObject]](list)
    for each, text in texts:
        having[text].append(each)
    return [[text, _numbers(some, say)] for text, some in having.items()]


def _symbols(found: Survey, say: Language) -> Iterator[list[str]]:
    """Yield the row of each object in the table of symbols, by rank."""
    for rank, each in enumerate(found.rows, 1):
        one, under = SurveyedObject(found.items[each.row - 1], each), each.under
        peak = under.peak_ratio if under is not None else nan
        numbers = [say.number(value, 4) for value in (each.lambda_, each.p, each.phi_cr, each.eta)]
        yield [str(rank), one.number(say), each.mechanism, *numbers, say.number(round(peak, 3), 3)]
