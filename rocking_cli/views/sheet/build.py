"""Assembly of the calculation sheet of a verification: its heading, the parts of its code, and its sources."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from rocking_cli.errors import InputError, PluginError, Problem
from rocking_cli.plugins.errors import blame
from rocking_cli.studies.assessment import File, TitleBlock
from rocking_cli.studies.verification.check import code_of
from rocking_cli.studies.verification.results import Verification
from rocking_cli.studies.verification.site_file import SiteFile
from rocking_cli.views.sheet.document import Grid, Item, Listing, Sentence, Sheet, SheetPart
from rocking_cli.views.sheet.language import DIGITS, Language

MOST = 200  # lines of a file that are printed


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
        For each language, the texts by their keys, including `subtitle`, `reading_digits` and `reading_marks`.
    spelled : mapping of str to str
        Printed forms of the symbols in plain sentences.
    parts : callable
        `parts(language, verification, site)` returns the parts of the sheet, the summary first.
    """

    texts: Mapping[str, Mapping[str, str]]
    spelled: Mapping[str, str]
    parts: Callable[[Language, Any, Any], Iterable[SheetPart]]

    def language(self, key: str) -> Language:
        """Return a language with the texts of the code. Raises `InputError` if there are none."""
        if key not in self.texts:
            known = ", ".join(self.texts)
            raise InputError(
                Problem(f"there is no calculation sheet in {key!r}", field="`language`", hint=f"known: {known}")
            )
        return Language(key, self.texts[key], self.spelled)


def sheet_of(site: SiteFile) -> SheetOfCode:
    """Return the sheet of the code of a site. Raises `InputError` if it has none."""
    found = code_of(site).sheet()
    if found is None:
        hint = "`rocking verify` prints the result without one"
        raise InputError(Problem(f"{site.site.code} has no calculation sheet", site.document.file, hint=hint))
    if not isinstance(found, SheetOfCode):
        raise PluginError(f"the code {site.site.code} failed in sheet: it must return a SheetOfCode or None")
    return found


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
    own = sheet_of(site)
    say = own.language(language.key)
    about = {say.say(name): text for name, text in title.known.items()}
    if site.site.name:
        about[say.say("site_name")] = site.site.name
    about[say.say("date")] = title.date
    about[say.say("program")] = f"rocking-cli {made.versions['rocking-cli']}"
    with blame(f"the code {site.site.code} failed in its sheet", own.parts.__module__):
        first, *others = own.parts(say, found, site.site)
    parts = [first, _reading(say, found), *others, _inputs(say, found, title, made)]
    return Sheet(say, say.say("title", name=found.mechanism.name), _subtitle(say, found), about, parts, title.logo)


def _subtitle(say: Language, found: Verification) -> str:
    mechanism = found.mechanism
    return say.say("subtitle", structure=say.mechanism(mechanism.mechanism, mechanism.title))


def _reading(say: Language, found: Verification) -> SheetPart:
    has_mass = found.mechanism.has_mass
    said = [say.say("reading_digits", digits=DIGITS, force="kN" if has_mass else "N/kg")]
    said += [say.say("reading_marks"), *([] if has_mass else [say.say("per_kilogram")])]
    return SheetPart("reading", say.say("reading"), [*map(Sentence, said)])


def _inputs(say: Language, found: Verification, title: TitleBlock, made: SheetSources) -> SheetPart:
    files = [("structure_file", made.structure), ("site_file", made.site)]
    rows = [[say.say(kind), file.name, file.checksum] for kind, file in files]
    for name, file in made.records.items():
        seen = [name, say.say("pulse")] if file is None else [file.name, file.checksum]
        rows.append([say.say("record_file"), *seen])
    versions = [[*each] for each in made.versions.items()]
    items: list[Item] = [
        Sentence(say.say("inputs_are")),
        Listing(title.command),
        Grid(say.say("files"), ["", say.say("file"), "SHA-256"], rows),
        Grid(say.say("versions"), [say.say("package"), say.say("version")], versions),
        Sentence(say.say("source", source=found.mechanism.source)),
    ]
    texts = [SheetPart(kind, say.say(kind), list(_text(say, file))) for kind, file in
             (("structure_text", made.structure), ("site_text", made.site))]  # fmt: skip
    return SheetPart("inputs", say.say("inputs"), items, texts)


def _text(say: Language, file: File) -> Iterator[Item]:
    """Yield the content of a file, cut if it is too long for a printed page."""
    lines: Sequence[str] = file.text.splitlines()
    yield Listing("\n".join(lines[:MOST]))
    if len(lines) > MOST:
        yield Sentence(say.say("cut", more=len(lines) - MOST))
