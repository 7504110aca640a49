"""Assembly of the calculation sheet of a verification: its heading, and the template of its code with its values."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field
from functools import partial
from importlib.resources import files
from typing import Any

from rocking_cli.core import Mechanism
from rocking_cli.errors import InputError, PluginError, Problem, named
from rocking_cli.names import LANGUAGES
from rocking_cli.plugins.errors import blame
from rocking_cli.studies.provenance import File, TitleBlock
from rocking_cli.verification.check import code_of
from rocking_cli.verification.code import Code, SiteFile
from rocking_cli.verification.results import Verification
from rocking_cli.views.mechanisms import comments
from rocking_cli.views.sheet.document import Sheet, sections
from rocking_cli.views.sheet.language import SIGNIFICANT_DIGITS, Language, texts_of

MAX_LISTED_LINES = 200  # lines of a file that a sheet shows
SIGNATURE_FIELDS = ("Place and date", "Name", "Signature", "Stamp")
OWN_PAGES = ("workings", "inputs")


@dataclass(frozen=True)
class SheetSources:
    """Sources of a calculation sheet.

    Parameters
    ----------
    structure : File
        The file of the structure.
    site : File or None
        The file of the site, if there is one.
    records : mapping of str to File or None
        File of each ground motion, by its path; None for a pulse, by its name.
    versions : mapping of str to str
    strengthened : File, optional
        The file of the strengthened structure, if two are compared.
    named : mapping of str to File
        The files that the site file names, by its field.
    """

    structure: File
    site: File | None
    records: Mapping[str, File | None]
    versions: Mapping[str, str]
    strengthened: File | None = None
    named: Mapping[str, File] = field(default_factory=dict)


def listed(of_templates: Collection[str], file: File) -> tuple[str, int, int]:
    """Return the beginning of a file, how many lines follow, and how many comments of templates are left out."""
    lines = file.text.splitlines()
    kept = [each for each in lines if each not in of_templates]
    return "\n".join(kept[:MAX_LISTED_LINES]), max(0, len(kept) - MAX_LISTED_LINES), len(lines) - len(kept)


def of_files(mechanism: Mechanism, title: TitleBlock, made: SheetSources, code: Code | None = None) -> dict[str, Any]:
    """Return the values of the section on the files and versions of a document."""
    known = comments(type(mechanism), code)
    return {"mechanism": mechanism, "command": title.command, "sources": made, "listed": partial(listed, known)}


def about(
    say: Language, mechanism: Mechanism, fields: Mapping[str, str], title: TitleBlock, made: SheetSources,
    site: str = "",
) -> dict[str, str]:  # fmt: skip
    """Return the entries of the heading of a document, with `fields` of its title block; empty ones are blanks."""
    kind = say.mechanism(mechanism.mechanism, mechanism.title)
    entries = {say("Structure"): f"{mechanism.name}: {kind}"}
    entries |= {say(name.capitalize()): text for name, text in fields.items()}
    entries |= {say("Site"): site} if site else {}
    return entries | {say("Date"): title.date, say("Program"): f"rocking-cli {made.versions['rocking-cli']}"}


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
        `mechanism`, `digits`, `command`, `sources` and those of `sections`.
    """

    package: str
    context: Callable[[Language, Any, Any], Mapping[str, Any]]

    def language(self, key: str) -> Language:
        """Return a language with the texts of the code. Raises `InputError` if there are none."""
        folder = files(self.package) / "texts"
        known = [each for each in LANGUAGES if (folder / each / "sheet.md").is_file()]
        if key not in known:
            hint = f"known: {', '.join(known)}"
            raise InputError(Problem(f"there is no calculation sheet in {key!r}", field=named("language"), hint=hint))
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
    of_every_sheet = {"digits": SIGNIFICANT_DIGITS, **of_files(mechanism, title, made, code_of(site))}
    with blame(f"the code {site.site.code} failed in its sheet", chapters.context.__module__):
        context = {**of_every_sheet, **chapters.context(say, found, site.site)}
        parts = sections(say, chapters.package, "sheet", context)
    heading = say("Calculation sheet: {name}", name=mechanism.name)
    subtitle = say("subtitle", structure=say.mechanism(mechanism.mechanism, mechanism.title))
    where = site.site.name or ""
    head = about(say, mechanism, title.fields, title, made, where)
    running = [heading, title.project, title.place or where, title.client]
    return Sheet(
        say, heading, subtitle, head, parts, title.logo, SIGNATURE_FIELDS, OWN_PAGES, title.author,
        " · ".join(filter(None, running)),
    )  # fmt: skip
