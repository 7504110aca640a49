"""Make and write the calculation sheets of verifications."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from rocking_cli.cli import heads, terminal
from rocking_cli.excitation.records.opening import original
from rocking_cli.io.browser import as_pdf, browser
from rocking_cli.io.files import write_whole
from rocking_cli.report.verified import VerifiedReport
from rocking_cli.studies.assessment import File, TitleBlock, file_of_motion, versions
from rocking_cli.studies.verification.check import read_site, refuse, verify, with_histories
from rocking_cli.studies.verification.motions import Histories
from rocking_cli.views.sheet.build import SheetSources, sheet, sheet_of
from rocking_cli.views.sheet.language import Language

if TYPE_CHECKING:
    from rocking_cli.cli.heads import SheetAsked
    from rocking_cli.excitation.scaled import Scaled
    from rocking_cli.structure import Structure
    from rocking_cli.studies.verification.results import Verification
    from rocking_cli.studies.verification.site_file import SiteFile


def check(asked: SheetAsked, site: SiteFile) -> None:
    """Raise `InputError`, before any work, if a sheet cannot be written."""
    sheet_of(site).language(asked.spoken.key)
    if _is_docx(asked.sheet):
        from rocking_cli.report.sheet_docx import check_package

        check_package()
    if _is_pdf(asked.sheet):
        browser()


def _is_pdf(path: Path | None) -> bool:
    return path is not None and path.suffix.lower() == ".pdf"


def _is_docx(path: Path | None) -> bool:
    return path is not None and path.suffix.lower() == ".docx"


def made(structure: Structure, given: str | None, site: Path, motions: Sequence[Scaled]) -> SheetSources:
    """Return the inputs of a sheet: the structure, its file as given, the site, and the ground motions."""
    return SheetSources(
        heads.file_of(structure, given),
        File(str(site), original(site)),
        {each.motion.name: file_of_motion(each) for each in motions},
        versions(structure.mechanism),
    )


def write(asked: SheetAsked, found: Verification, site: SiteFile, title: TitleBlock, of: SheetSources) -> None:
    """Write the sheet, and report it."""
    assert asked.sheet is not None  # the caller has checked
    content = sheet(found, site, asked.spoken, title, of)
    if _is_docx(asked.sheet):
        from rocking_cli.report.sheet_docx import render as render_docx

        data = render_docx(content, found.mechanism)
    else:
        from rocking_cli.report.sheet_page import render

        data = render(content, found.mechanism).encode()
        if _is_pdf(asked.sheet):
            data = as_pdf(data)
    write_whole(asked.sheet, lambda stream: stream.write(data))
    terminal.note(f"wrote {asked.sheet} ({len(data) / 1e6:.2g} MB)")


def site_of_report(path: Path, *, motions: bool) -> SiteFile:
    """Return the site of a report. Raises `InputError`, before any work, if its code has no part in a report."""
    site = read_site(path)
    sheet_of(site)
    refuse(site, motions=motions)
    return site


def of_report(
    structure: Structure, site: SiteFile, given: str | None, motions: Sequence[Scaled], signs: Sequence[int],
    title: TitleBlock, *, state: str | None = None, on_floor: bool = False,
) -> VerifiedReport:  # fmt: skip
    """Return the verification in a report, with time histories under its ground motions."""
    found = verify(structure, site)
    if motions:
        scaled = [each.motion.scaled(each.factor) for each in motions]
        found = with_histories(found, structure, site, Histories(scaled, signs, state, on_floor))
    of = made(structure, given, Path(site.document.file), motions)
    return VerifiedReport(found, sheet(found, site, Language("en"), title, of))
