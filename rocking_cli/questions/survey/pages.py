"""What a survey writes: an HTML page with a sortable table, and a folder with a calculation sheet of each structure."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from hashlib import sha256
from pathlib import Path
from unicodedata import normalize

from markupsafe import Markup, escape

from rocking_cli.ask.inputs import SiteLike, yaml_of
from rocking_cli.ask.watcher import Watcher
from rocking_cli.documents.figures import dark_figures, inline_svg, template
from rocking_cli.errors import InputError, Problem, Refused, RockingError
from rocking_cli.io.files import check_writable, discard, folder, write_files
from rocking_cli.plotting.moving import asset
from rocking_cli.plotting.style import in_language
from rocking_cli.questions.survey.asked import SurveyAsked
from rocking_cli.questions.survey.picture import draw_map, draw_survey
from rocking_cli.questions.survey.structure_table import coordinates
from rocking_cli.questions.survey.study import FailedEntry, Survey, Surveyed, SurveyEntry
from rocking_cli.questions.survey.view import counts, sentences, table
from rocking_cli.questions.verify import sheets
from rocking_cli.structure import Structure
from rocking_cli.studies.provenance import File
from rocking_cli.text import numbered, printable
from rocking_cli.verification.check import of_each, verify
from rocking_cli.verification.code import SiteFile
from rocking_cli.views.sheet.language import ENGLISH, Language, translated
from rocking_cli.views.view import Table, View

MAX_PAGE_ROWS = 10_000  # browsers need many seconds to lay out more
SUBSCRIPT = re.compile(r"([φθλωψ]|\b[A-Za-z])_([A-Za-z]+(?:,\d)?)")
SYMBOLS = {"zeta": "ζ", "lambda": "λ", "phi_cr": "φ_cr", "kappa2": "κ₂", "eta": "η"}


def render(
    found: Survey, source: str, about: Sequence[str], say: Language = ENGLISH, logo: str | None = None
) -> str:  # fmt: skip
    """Return the page of a survey.

    Parameters
    ----------
    found : Survey
        The survey; every text in it is escaped.
    source : str
        Source of the structures.
    about : sequence of str
        Further lines of the heading: project, date and command.
    say : Language
        The language.
    logo : str, optional
        The author's logo as a data URL.
    """
    parts: list[Table | str] = [
        table(found, MAX_PAGE_ROWS, longest=None, say=say),
        *counts(found),
        *sentences(found, say=say),
    ]
    rows, *lines = translated(say, View({}, parts)).parts
    assert isinstance(rows, Table)  # the first of them
    left_out = max(0, len(found.rows) - MAX_PAGE_ROWS)
    page = template("survey.html", symbols=symbols).render(
        source=source,
        about=about,
        logo=logo,
        say=say,
        title=rows.title,
        said=[str(each).replace("`", "") for each in lines],
        picture=inline_svg(in_language(say, partial(draw_survey, found, "")), "survey") if found.rows else None,
        map=_map(found, say),
        columns=[_symbolic(each) for each in rows.columns],
        words=[k for k in range(len(rows.columns)) if k not in rows.numbers],
        rows=rows.rows,
        left_out=left_out
        and say.recognised("shown", f"The table lists the first {MAX_PAGE_ROWS:,} of {len(found.rows):,} structures."),
        bad=[
            (each.line if each.line is not None else "", each.name, each.reason) for each in found.bad[:MAX_PAGE_ROWS]
        ],
        bad_count=len(found.bad),
        style=Markup(asset("motion.css")),
        dark_figures=dark_figures(),
    )
    return printable(page)  # a table may have characters that a page cannot hold


def symbols(text: str) -> Markup:
    """Return a text of this package as HTML, with an underscore after a symbol turned into a subscript."""
    return Markup(SUBSCRIPT.sub(r"\1<sub>\2</sub>", str(escape(text))))


def _map(found: Survey, say: Language) -> Markup | None:
    """Return the map of a survey; None if no structure has coordinates."""
    try:
        where = coordinates(found)
    except InputError:
        return None
    return inline_svg(in_language(say, partial(draw_map, found, where, "")), "map")


def _symbolic(heading: str) -> str:
    for word, symbol in SYMBOLS.items():
        heading = heading.replace(word, symbol)
    return heading.replace("\n", " ")


LIST_FILE = "sheets.txt"
LIST_HEADER = "# Calculation sheets, written by rocking survey: the SHA-256 of each, and its name."
MAX_STEM_LENGTH = 60  # characters of a file name, each of which may take four of the 255 bytes that systems allow
RESERVED = re.compile(r"(?i)(con|prn|aux|nul|com\d|lpt\d)(\..*)?")
"""Names of devices, which Windows does not give to files, whatever follows a dot in them."""


def file_names(names: Sequence[str], suffix: str) -> list[str]:
    r"""Return a file name for each name, of letters, digits, dots and hyphens, each once where case does not count.

    Examples
    --------
    >>> file_names(["../x", "a/b", "A b", "NUL.1", "..."], ".html")
    ['x.html', 'a-b.html', 'A-b-2.html', 'NUL.1_.html', 'structure.html']
    """
    taken: list[str] = []
    for name in names:
        stem = re.sub(r"[^\w.+-]+", "-", normalize("NFKC", name)).strip("-.")[:MAX_STEM_LENGTH].rstrip("-.")
        stem = f"{stem}_" if RESERVED.fullmatch(stem) else stem or "structure"
        taken.append(numbered(stem, suffix, taken))
    return taken


@dataclass(frozen=True)
class SheetFolder:
    """A folder for the calculation sheets of a survey.

    Parameters
    ----------
    path : Path
        The folder, created if missing.
    asked : SurveyAsked
        The survey: its site as it was given, format and heading of the sheets.
    site : SiteFile or None
        The site of structures that have no other.
    language : str
        Language of the sheets.
    """

    path: Path
    asked: SurveyAsked
    site: SiteFile | None
    language: str

    @property
    def suffix(self) -> str:
        """Suffix of the sheets."""
        return f".{self.asked.sheet_format}"

    def check(self, first: SiteFile | None) -> None:
        """Raise `InputError`, before any work, if sheets cannot be written, or the folder has files of others.

        `first` is the first site of the survey; None if none can be used.
        """
        place = folder(str(self.path))
        if first is not None:
            sheets.check(place / f"structure{self.suffix}", first, self.language)
        check_writable(place / LIST_FILE)
        discard(place)
        known = self._listed()
        for each in sorted(place.iterdir()):
            if each.name not in known and not each.name.startswith("."):
                what = "this file is in the folder of the sheets, and rocking did not write it, or not as it is now"
                raise InputError(Problem(what, str(each), hint="move it, or name another folder"))

    def write(self, found: Survey, entries: Sequence[SurveyEntry], watch: Watcher) -> None:
        """Write the sheet of each structure; sheets of an earlier survey that this one does not have are removed.

        A structure whose sheet cannot be made is reported, and the others are written.

        Raises
        ------
        InputError, Refused
            If what makes the sheets is not there, or a file cannot be written; the next survey then replaces them.
        """
        sheets.check_program(self.suffix)
        every: list[Surveyed | FailedEntry] = sorted([*found.rows, *found.bad], key=lambda each: each.row)
        files_of = file_names([each.name for each in every], self.suffix)
        names = {each.row: name for each, name in zip(every, files_of, strict=True)}
        stale, new = self._listed(), dict[str, str]()

        def files() -> Iterator[tuple[str, bytes]]:
            with watch.progress(len(found.rows), "calculation sheets") as advance:
                for each in sorted(found.rows, key=lambda each: each.row):
                    try:
                        data = self._sheet(found, entries[each.row - 1])
                    except Refused:
                        raise
                    except RockingError as error:
                        watch.incomplete(f"{each.name}: no calculation sheet: {error}")
                    else:
                        new[names[each.row]] = sha256(data).hexdigest()
                        yield names[each.row], data
                    advance(1)
            for name in stale - new.keys() - {LIST_FILE}:
                (self.path / name).unlink()
            lines = [LIST_HEADER, *(f"{checksum}  {name}" for name, checksum in sorted(new.items()))]
            yield LIST_FILE, "".join(f"{line}\n" for line in lines).encode()

        write_files(self.path, files())
        what = f"{len(new):,} calculation sheet{'s' * (len(new) != 1)}"
        watch.note(f"wrote {what} and {LIST_FILE} to {self.path.resolve()}")

    def _sheet(self, found: Survey, entry: SurveyEntry) -> bytes:
        site, made = entry.site(self.site), entry.make()
        assert site is not None
        given: SiteLike = site.document.data if site.changed else site.document.file
        if self.asked.site is not None and site is self.site:
            given = self.asked.site
        structure = Structure(made.weaker_side() or made)
        source = f"{Path(found.sheet.file).name}, line {entry.line}" if found.sheet is not None else structure.name
        if site.changed:  # as a file it has the fields of both
            site = replace(site, document=replace(site.document, file=f"{site.document.file} + {source}"))
        site = of_each(site)
        verification = verify(structure, site)
        call = self.asked.origin or "rocking_cli.survey(...)"
        origin = sheets.SheetOrigin(call, File(source, yaml_of(structure.mechanism).encode()))
        title = self.asked.title(call, self.language)
        content = sheets.sheet_for(verification, site, given, [], self.language, title, origin)
        return sheets.rendered(content, self.suffix)

    def _listed(self) -> set[str]:
        """Return the names of the files that an earlier survey wrote, and that are as it wrote them; with the list."""
        path = self.path / LIST_FILE
        lines = path.read_text(encoding="utf-8", errors="replace").splitlines() if path.is_file() else []
        if lines[:1] != [LIST_HEADER]:
            return set()
        sums = {each.name: sha256(each.read_bytes()).hexdigest() for each in self.path.iterdir() if each.is_file()}
        return {LIST_FILE, *(name for name, checksum in sums.items() if f"{checksum}  {name}" in lines)}
