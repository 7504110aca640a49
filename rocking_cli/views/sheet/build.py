"""Assembly of the calculation sheet of a verification: its heading, and the template of its code with its values."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib.resources import files
from typing import Any

from rocking_cli.errors import InputError, PluginError, Problem
from rocking_cli.names import LANGUAGES
from rocking_cli.plugins.errors import blame
from rocking_cli.studies.provenance import File, TitleBlock
from rocking_cli.verification.check import code_of
from rocking_cli.verification.code import SiteFile
from rocking_cli.verification.results import Verification
from rocking_cli.views.sheet import template
from rocking_cli.views.sheet.document import Sheet
from rocking_cli.views.sheet.language import SIGNIFICANT_DIGITS, Language, texts_of

MAX_LISTED_LINES = 200  # lines of a file that a sheet shows


@dataclass(frozen=True)
class SheetSources:
    """Sources of a calculation sheet.

    Parameters
    ----------
    structure, site : File
        The files of the structure and of the site.
    records : mapping of str to File or None
        File of each ground motion, by its path; None for a pulse, by its name.
    versions : mapping of str to str
    strengthened : File, optional
        The file of the strengthened structure, if two are compared.
    """

    structure: File
    site: File
    records: Mapping[str, File | None]
    versions: Mapping[str, str]
    strengthened: File | None = None

    @staticmethod
    def listed(file: File) -> tuple[str, int]:
        """Return the beginning of a file, and how many lines of it follow."""
        lines = file.text.splitlines()
        return "\n".join(lines[:MAX_LISTED_LINES]), max(0, len(lines) - MAX_LISTED_LINES)


@dataclass(frozen=True)
class SheetOfCode:
    """The templates and values that a code contributes to its calculation sheet.

    Parameters
    ----------
    package : str
        The package of the code. Its folder `texts` has, for each language, a template `LANGUAGE/sheet.md` and texts
        `LANGUAGE.toml` by their keys, among them `subtitle`.
    context : callable
        `context(language, verification, site)` returns the values that the template uses by name, besides
        `mechanism`, `digits`, `command`, `sources` and those of `template.parts`.
    """

    package: str
    context: Callable[[Language, Any, Any], Mapping[str, Any]]

    def language(self, key: str) -> Language:
        """Return a language with the texts of the code. Raises `InputError` if there are none."""
        folder = files(self.package) / "texts"
        known = [each for each in LANGUAGES if (folder / each / "sheet.md").is_file()]
        if key not in known:
            hint = f"known: {', '.join(known)}"
            raise InputError(Problem(f"there is no calculation sheet in {key!r}", field="`language`", hint=hint))
        return Language(key, texts_of(self.package, key))


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
    kind = say.mechanism(mechanism.mechanism, mechanism.title)
    about = {say("Structure"): f"{mechanism.name}: {kind}"}
    about |= {say(name.capitalize()): text for name, text in title.known.items()}
    if site.site.name:
        about[say("Site")] = site.site.name
    about[say("Date")] = title.date
    about[say("Program")] = f"rocking-cli {made.versions['rocking-cli']}"
    of_every_sheet = {
        "mechanism": mechanism, "digits": SIGNIFICANT_DIGITS, "command": title.command, "sources": made,
    }  # fmt: skip
    with blame(f"the code {site.site.code} failed in its sheet", chapters.context.__module__):
        context = {**of_every_sheet, **chapters.context(say, found, site.site)}
        parts = template.parts(say, chapters.package, "sheet", context)
    heading = say("Calculation sheet: {name}", name=mechanism.name)
    return Sheet(say, heading, say("subtitle", structure=kind), about, parts, title.logo)
