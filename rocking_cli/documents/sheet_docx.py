"""A calculation sheet as a document for word processors, made with python-docx."""

from __future__ import annotations

import base64
from collections.abc import Sequence
from io import BytesIO
from itertools import count
from typing import TYPE_CHECKING, Any

from rocking_cli.core import Mechanism
from rocking_cli.documents.sheet_page import MARKS, figure_of, runs
from rocking_cli.errors import InputError, Problem
from rocking_cli.plotting import style
from rocking_cli.studies.verification.working import Working
from rocking_cli.text import printable
from rocking_cli.views.sheet.document import Drawing, Item, Listing, Sentence, Sheet, SheetPart, Steps
from rocking_cli.views.view import Table

if TYPE_CHECKING:
    from docx.document import Document
    from docx.text.paragraph import Paragraph

WIDTH = 17.0  # cm of an A4 page, between margins of 2 cm
SMALL = 8.5  # pt, in tables
LOGO = 1.6  # cm high
PICTURES = ("data:image/png;", "data:image/jpeg;")
"""How the addresses begin of pictures that a document takes."""


def check_package() -> None:
    """Raise `InputError` if python-docx is not installed."""
    try:
        import docx  # noqa: F401
    except ImportError:
        hint = "pip install 'rocking-cli[docx]', or give a name that ends in .html"
        raise InputError(Problem("a .docx file needs the package python-docx", hint=hint)) from None


def render(sheet: Sheet, mechanism: Mechanism) -> bytes:
    """Return the document of a calculation sheet.

    Parameters
    ----------
    sheet : Sheet
        The sheet.
    mechanism : Mechanism
        The mechanism to draw.

    Raises
    ------
    InputError
        If the package python-docx is not installed, or the logo is a picture that a document cannot hold.
    """
    check_package()
    from docx import Document

    made = _Writer(Document(), sheet, mechanism)
    made.write()
    stream = BytesIO()
    made.document.save(stream)
    return stream.getvalue()


class _Writer:
    """Writer of a document, part by part."""

    def __init__(self, document: Document, sheet: Sheet, mechanism: Mechanism) -> None:
        self.document = document
        self.sheet = sheet
        self.mechanism = mechanism
        self.steps = count(1)

    def write(self) -> None:
        """Write heading and all sections."""
        self._page()
        sheet = self.sheet
        if sheet.logo:
            self._logo(sheet.logo)
        self._text(self.document.add_heading(level=0), sheet.heading)
        self._text(self.document.add_paragraph(), sheet.subtitle)
        self._grid(["", ""], [[*each] for each in sheet.about.items()], heads=False)
        for each in sheet.parts:
            self._part(each, 1)

    def _page(self) -> None:
        """Set the page to A4, and the language of the text."""
        from docx.oxml.ns import qn
        from docx.shared import Cm, Pt

        section = self.document.sections[0]
        section.page_width, section.page_height = Cm(21.0), Cm(29.7)
        section.left_margin = section.right_margin = section.top_margin = section.bottom_margin = Cm(2.0)
        normal = self.document.styles["Normal"]
        normal.font.size = Pt(10)
        fonts = self.document.styles.element.find(f".//{qn('w:lang')}")
        if fonts is not None:
            fonts.set(qn("w:val"), {"en": "en-GB", "it": "it-IT"}[self.sheet.language.key])
        core = self.document.core_properties
        core.title, core.author, core.comments = printable(self.sheet.heading)[:255], "", ""

    def _logo(self, address: str) -> None:
        from docx.shared import Cm

        if not address.startswith(PICTURES):
            hint = "give a PNG or JPEG picture, or a sheet that ends in .html"
            raise InputError(Problem("a .docx file cannot hold an SVG logo", field="logo", hint=hint))
        data = base64.b64decode(address.partition(",")[2])
        try:
            self.document.add_picture(BytesIO(data), height=Cm(LOGO))
        except Exception as error:  # what python-docx raises of a damaged picture is of many kinds
            raise InputError(Problem(f"the logo cannot be put into a .docx file: {error!r}", field="logo")) from None

    def _part(self, part: SheetPart, level: int) -> None:
        self._text(self.document.add_heading(level=min(level, 9)), part.heading)
        for item in part.items:
            self._item(item)
        for each in part.parts:
            self._part(each, level + 1)

    def _item(self, item: Item) -> None:
        if isinstance(item, Table):
            caption = self.document.add_paragraph()
            caption.paragraph_format.keep_with_next = True
            self._text(caption, item.title)
            self._grid(item.columns, item.rows)
        elif isinstance(item, Steps):
            self._steps(item.rows)
        elif isinstance(item, Drawing):
            self._drawing()
        elif isinstance(item, Listing):
            self._listing(item.text)
        elif isinstance(item, Sentence):
            self._text(self.document.add_paragraph(), item.text, bold=item.answers)

    def _listing(self, text: str) -> None:
        from docx.shared import Pt

        for line in text.split("\n"):
            paragraph = self.document.add_paragraph()
            paragraph.paragraph_format.space_after = Pt(0)
            run = paragraph.add_run(printable(line))
            run.font.name, run.font.size = "Courier New", Pt(8)

    def _drawing(self) -> None:
        from docx.shared import Cm

        figure = figure_of(self.sheet, self.mechanism)
        stream = BytesIO()
        style.save(figure, stream, format="png")
        stream.seek(0)
        self.document.add_picture(stream, width=Cm(WIDTH))

    def _steps(self, rows: Sequence[Working]) -> None:
        """Write a row for each step: number, meaning, formula with numbers, result, clause."""
        from docx.shared import Cm

        say = self.sheet.language
        table: Any = self.document.add_table(rows=0, cols=4, style="Table Grid")
        table.autofit = False
        for row in rows:
            cells = table.add_row().cells
            self._keep_whole(table.rows[-1])
            self._small(cells[0].paragraphs[0], str(next(self.steps)))
            self._small(cells[1].paragraphs[0], row.meaning)
            written = row.formula if not row.numbers else f"{row.formula} = {row.numbers}"
            joined = ": " if row.formula and not row.numbers else " = "
            self._small(cells[1].add_paragraph(), f"{row.symbol}{joined}{written}" if written else row.symbol)
            self._small(cells[2].paragraphs[0], f"{say.number(row.value)} {row.unit}".strip(), bold=True)
            self._small(cells[3].paragraphs[0], f"{row.clause}{MARKS[row.standing]}")
            for cell, width in zip(cells, (1.1, 10.1, 3.2, 2.6), strict=True):
                cell.width = Cm(width)
        self.document.add_paragraph()

    def _grid(self, columns: Sequence[str], rows: Sequence[Sequence[str]], *, heads: bool = True) -> None:
        table: Any = self.document.add_table(rows=0, cols=len(columns), style="Table Grid")
        for k, row in enumerate([columns, *rows] if heads else rows):
            cells = table.add_row().cells
            self._keep_whole(table.rows[-1])
            for cell, text in zip(cells, row, strict=True):
                self._small(cell.paragraphs[0], text, bold=heads and k == 0)
        self.document.add_paragraph()

    @staticmethod
    def _keep_whole(row: Any) -> None:
        """Keep a row from breaking across pages."""
        from docx.oxml import OxmlElement

        row._tr.get_or_add_trPr().append(OxmlElement("w:cantSplit"))

    def _small(self, paragraph: Paragraph, text: str, *, bold: bool = False) -> None:
        from docx.shared import Pt

        paragraph.paragraph_format.space_after = Pt(0)
        self._text(paragraph, text, bold=bold, size=SMALL)

    def _text(self, paragraph: Paragraph, text: str, *, bold: bool = False, size: float | None = None) -> None:
        """Write a text with its sub- and superscripts; characters that XML cannot hold are spelled out."""
        from docx.shared import Pt

        for piece, place in runs(text):
            run = paragraph.add_run(printable(piece))
            run.bold = bold or None
            if place:
                setattr(run.font, {"sub": "subscript", "sup": "superscript"}[place], True)
            if size is not None:
                run.font.size = Pt(size)
