"""Calculation sheets of verifications, and the headings and sources of documents."""

from __future__ import annotations

from collections.abc import Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import NamedTuple

from rocking_cli.ask.inputs import SiteLike, yaml_of
from rocking_cli.ask.watcher import Watcher
from rocking_cli.core import Mechanism
from rocking_cli.excitation.records.opening import STANDARD_INPUT, name_of, original
from rocking_cli.io.browser import as_pdf, browser, has_browser
from rocking_cli.io.files import check_writable, write_whole
from rocking_cli.io.json_text import json_text
from rocking_cli.processing.reading import Scaled
from rocking_cli.structure import Structure
from rocking_cli.studies.provenance import File, TitleBlock, file_of_motion, versions
from rocking_cli.verification.code import SiteFile
from rocking_cli.verification.results import Verification
from rocking_cli.views.sheet.build import SheetSources, sheet, sheet_of
from rocking_cli.views.sheet.document import Sheet
from rocking_cli.views.sheet.language import Language


class SheetOrigin(NamedTuple):
    """Origin of a document: the command that wrote it, and the files of its structures as they were given."""

    command: str
    structure: File
    strengthened: File | None = None

    @classmethod
    def of(cls, call: str, structure: Structure, strengthened: Structure | None = None) -> SheetOrigin:
        """Return the origin of a document that a command, or a call of Python, writes."""
        return cls(call, _file_of(structure), None if strengthened is None else _file_of(strengthened))


def _file_of(structure: Structure) -> File:
    file = structure.file
    if file is None:
        return File(structure.name, yaml_of(structure.mechanism).encode())
    return File(file, original(STANDARD_INPUT if file == name_of(STANDARD_INPUT) else file))


def check(file: Path, site: SiteFile, language: str) -> None:
    """Raise `InputError`, before any work, if a sheet cannot be written."""
    check_writable(file, ".html", ".docx", ".pdf")
    sheet_of(site).language(language)


def check_program(suffix: str) -> None:
    """Raise `InputError` if what makes sheets of a suffix is not there: a package, or for a PDF also a browser."""
    if suffix == ".docx":
        from rocking_cli.documents.sheet_docx import check_package

        check_package()
    elif suffix == ".pdf" and find_spec("typst") is None:
        browser()


def sheet_for(
    found: Verification, site: SiteFile, given: SiteLike, motions: Sequence[Scaled], language: str,
    title: TitleBlock, origin: SheetOrigin,
) -> Sheet:  # fmt: skip
    """Return the sheet of a verification, with the checksums of the files that were given."""
    return sheet(found, site, Language(language), title, sources(found.mechanism, given, motions, origin, site))


def sources(
    mechanism: Mechanism, site: SiteLike | None, motions: Sequence[Scaled], origin: SheetOrigin,
    read: SiteFile | None,
) -> SheetSources:  # fmt: skip
    """Return the files that were given, and those that the site as it was read names, with the versions."""
    of_site = None
    if isinstance(site, str | Path):
        of_site = File(str(site), original(site))
    elif site is not None:
        of_site = File(read.document.file if read is not None else "site", json_text(site).encode())
    records = {str(each.file or each.motion.name): file_of_motion(each) for each in motions}
    named = {} if read is None else {key: File(str(file), original(file)) for key, file in read.site.named.items()}
    return SheetSources(origin.structure, of_site, records, versions(mechanism), origin.strengthened, named)


def rendered(content: Sheet, suffix: str, *, by_browser: bool = False) -> bytes:
    """Return a document as the content of a file with a suffix; a PDF by typst, or `by_browser` where there is one."""
    if suffix == ".docx":
        from rocking_cli.documents.sheet_docx import render as render_docx

        return render_docx(content)
    if suffix == ".pdf" and find_spec("typst") is not None and not (by_browser and has_browser()):
        from rocking_cli.documents.sheet_typst import render as render_typst

        return render_typst(content)
    from rocking_cli.documents.sheet_page import render

    page = render(content, still=suffix == ".pdf").encode()
    return as_pdf(page) if suffix == ".pdf" else page


def write(file: Path, content: Sheet, watch: Watcher, *, by_browser: bool = False) -> None:
    """Write a document completely or not at all, and tell that it was written; arguments as of `rendered`."""
    made = rendered(content, file.suffix.lower(), by_browser=by_browser)
    write_whole(file, lambda stream: stream.write(made))
    watch.note(f"wrote {file} ({len(made) / 1e6:.2g} MB)")
