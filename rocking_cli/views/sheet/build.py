"""Assembly of the calculation sheet of a verification: its heading, the parts of its code, and its sources."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from rocking_cli.errors import InputError, PluginError, Problem
from rocking_cli.plugins.errors import blame
from rocking_cli.studies.provenance import File, TitleBlock
from rocking_cli.verification.check import code_of
from rocking_cli.verification.code import SiteFile
from rocking_cli.verification.results import Verification
from rocking_cli.views.column import table_of, text_columns
from rocking_cli.views.sheet.document import Item, Listing, Sentence, Sheet, SheetPart
from rocking_cli.views.sheet.language import SIGNIFICANT_DIGITS, Language

MAX_LISTED_LINES = 200  # lines of a file that a sheet shows


@dataclass(frozen=True)
class SheetSources:
    """Sources of a calculation sheet.

    Parameters
    ----------
    structure, site : File
        The files of the structure and of the site.
    records : mapping of str to File or None
        File of each ground motion; None for a pulse.
    versions : mapping of str to str
    """

    structure: File
    site: File
    records: Mapping[str, File | None]
    versions: Mapping[str, str]


@dataclass(frozen=True)
class SheetOfCode:
    """The texts and parts that a code contributes to its calculation sheet.

    Parameters
    ----------
    texts : mapping of str to mapping
        For each language, the texts by their keys or their English form, including `subtitle`,
        `reading_digits` and `reading_marks`.
    parts : callable
        `parts(language, verification, site)` returns the parts of the sheet, the summary first.
    """

    texts: Mapping[str, Mapping[str, str]]
    parts: Callable[[Language, Any, Any], Iterable[SheetPart]]

    def language(self, key: str) -> Language:
        """Return a language with the texts of the code. Raises `InputError` if there are none."""
        if key not in self.texts:
            known = ", ".join(self.texts)
            raise InputError(
                Problem(f"there is no calculation sheet in {key!r}", field="`language`", hint=f"known: {known}")
            )
        return Language(key, self.texts[key])


def sheet_of(site: SiteFile) -> SheetOfCode:
    """Return the sheet of the code of a site. Raises `InputError` if it has none."""
    builder = code_of(site).sheet()
    if builder is None:
        hint = "`rocking verify` prints the result without one"
        raise InputError(Problem(f"{site.site.code} has no calculation sheet", site.document.file, hint=hint))
    if not isinstance(builder, SheetOfCode):
        raise PluginError(f"the code {site.site.code} failed in sheet: it must return a SheetOfCode or None")
    return builder


def sheet(found: Verification, site: SiteFile, language: Language, title: TitleBlock, made: SheetSources) -> Sheet:
    """Build the calculation sheet of a verification, in a language.

    Parameters
    ----------
    found : Verification
        The verification.
    site : SiteFile
        The site.
    language : Language
        Language of the sheet.
    title : TitleBlock
        Heading: project, author, date and command.
    made : SheetSources
        Source files and versions.

    Raises
    ------
    InputError
        If the code of the site has no sheet.
    """
    chapters = sheet_of(site)
    say, mechanism = chapters.language(language.key), found.mechanism
    about = {say("Structure"): f"{mechanism.name}: {say.mechanism(mechanism.mechanism, mechanism.title)}"}
    about |= {say(name.capitalize()): text for name, text in title.known.items()}
    if site.site.name:
        about[say("Site")] = site.site.name
    about[say("Date")] = title.date
    about[say("Program")] = f"rocking-cli {made.versions['rocking-cli']}"
    with blame(f"the code {site.site.code} failed in its sheet", chapters.parts.__module__):
        first, *others = chapters.parts(say, found, site.site)
    reading = [
        say("reading_digits", digits=SIGNIFICANT_DIGITS, force="kN" if mechanism.has_mass else "N/kg"),
        say("reading_marks"),
    ]
    if not mechanism.has_mass:
        reading.append(say("The file gives no masses: weights are per kilogram of the whole structure, in N/kg."))
    how = SheetPart("reading", say("How to read it"), [*map(Sentence, reading)])
    workings = SheetPart(
        "workings", say("Appendix A: workings"), [], [how, *(each for each in others if each.appended)]
    )
    subtitle = say("subtitle", structure=say.mechanism(mechanism.mechanism, mechanism.title))
    front = [each for each in others if not each.appended]
    parts = [first, *front, workings, _inputs(say, found, title, made)]
    return Sheet(say, say("Calculation sheet: {name}", name=mechanism.name), subtitle, about, parts, title.logo)


def _inputs(say: Language, found: Verification, title: TitleBlock, made: SheetSources) -> SheetPart:
    files = {"structure": made.structure, "site": made.site}
    rows = [[say(kind), file.name, file.checksum] for kind, file in files.items()]
    for name, file in made.records.items():
        seen = [name, say("pulse, computed from its formula")] if file is None else [file.name, file.checksum]
        rows.append([say("record"), *seen])
    items: list[Item] = [
        Sentence(say("Run this command with these files and versions to reproduce the sheet.")),
        Listing(title.command),
        table_of(say("Files"), text_columns("", say("file"), "SHA-256"), rows),
        table_of(say("Versions"), text_columns(say("package"), say("version")), list(made.versions.items())),
        Sentence(say("Mechanism: {source}.", source=found.mechanism.source)),
    ]
    texts = []
    for kind, file in files.items():
        lines = file.text.splitlines()
        text: list[Item] = [Listing("\n".join(lines[:MAX_LISTED_LINES]))]
        if len(lines) > MAX_LISTED_LINES:  # long files are cut
            more = len(lines) - MAX_LISTED_LINES
            text.append(Sentence(say("(the file continues: {more} more lines are not printed)", more=more)))
        texts.append(SheetPart(f"{kind}_text", say(f"{kind.capitalize()} file"), text))
    return SheetPart("inputs", say("Appendix B: files and versions"), items, texts)
