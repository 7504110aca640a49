"""A calculation sheet as a document for word processors, made with python-docx."""

from __future__ import annotations

import base64
from collections.abc import Sequence
from io import BytesIO
from itertools import count
from typing import TYPE_CHECKING, Any

from rocking_cli.documents.sheet_page import ORIGIN_MARKS, SIGNATURE_FIELDS, figure_of, runs
from rocking_cli.errors import InputError, Problem
from rocking_cli.plotting import style
from rocking_cli.text import printable
from rocking_cli.verification.results import Working
from rocking_cli.views.sheet.document import Drawing, Item, Listing, Sheet, SheetPart, Steps
from rocking_cli.views.view import Table

if TYPE_CHECKING:
    from docx.document import Document
    from docx.text.paragraph import Paragraph

TEXT_WIDTH = 17.0  # cm of an A4 page, between margins of 2 cm
TABLE_FONT_SIZE = 8.5  # pt
LOGO_HEIGHT = 1.6  # cm
SIGNATURE_LINES = 5  # empty lines of the place for a signature or a stamp
PICTURE_PREFIXES = ("data:image/png;", "data:image/jpeg;")
"""Beginnings of the data addresses of pictures that a document can contain."""


def check_package() -> None:
    """Raise `InputError` if python-docx is not installed."""
    try:
        import docx  # noqa: F401
    except ImportError:
        hint = "pip install 'rocking-cli[docx]', or give a name that ends in .html"
        raise InputError(Problem("a .docx file needs the package python-docx", hint=hint)) from None


def render(sheet: Sheet) -> bytes:
    """Return the document of a calculation sheet.

    Parameters
    ----------
    sheet : Sheet
        The sheet.

    Raises
    ------
    InputError
        If the package python-docx is not installed, or the logo is a picture that a document cannot hold.
    """
    check_package()
    from docx import Document

    writer = _Writer(Document(), sheet)
    writer.write()
    stream = BytesIO()
    writer.document.save(stream)
    return stream.getvalue()


class _Writer:
    """Writer of a document, part by part."""

    def __init__(self, document: Document, sheet: Sheet) -> None:
        self.document = document
        self.sheet = sheet
        self.steps = count(1)

    def write(self) -> None:
        """Write heading and all sections."""
        self._page()
        sheet = self.sheet
        if sheet.logo:
            self._logo(sheet.logo)
        self._text(self.document.add_heading(level=0), sheet.heading)
        self._text(self.document.add_paragraph(), sheet.subtitle)
        self._table([[[name], [text]] for name, text in sheet.about.items()])
        for k, each in enumerate(sheet.parts):
            self._part(each, 1)
            if k == 0:
                self._sign_and_list()

    def _sign_and_list(self) -> None:
        """Write the place for the signature, and the table of contents, which a word processor fills on request."""
        say = self.sheet.language
        self._table([[[say(name), *[""] * SIGNATURE_LINES] for name in SIGNATURE_FIELDS]])
        title = self.document.add_paragraph()
        title.paragraph_format.page_break_before = title.paragraph_format.keep_with_next = True
        self._text(title, say("Contents"), bold=True, size=14)
        self._field(
            self.document.add_paragraph(), r'TOC \o "1-2" \h \z', "; ".join(each.heading for each in self.sheet.parts)
        )

    def _field(self, paragraph: Paragraph, code: str, until_filled: str) -> None:
        """Write a field, such as the number of the page, with the text that stands until a word processor fills it."""
        from docx.oxml import OxmlElement
        from docx.oxml.ns import qn

        field = OxmlElement("w:fldSimple")
        field.set(qn("w:instr"), code)
        field.set(qn("w:dirty"), "true")
        run = paragraph.add_run(printable(until_filled))
        field.append(run._r)
        paragraph._p.append(field)

    def _page(self) -> None:
        """Set the page to A4, and the language of the text."""
        from docx.oxml.ns import qn
        from docx.shared import Cm, Pt

        section = self.document.sections[0]
        section.page_width, section.page_height = Cm(21.0), Cm(29.7)
        section.left_margin = section.right_margin = section.top_margin = section.bottom_margin = Cm(2.0)
        self._field(section.footer.paragraphs[0], "PAGE", "1")
        normal = self.document.styles["Normal"]
        normal.font.size = Pt(10)
        fonts = self.document.styles.element.find(f".//{qn('w:lang')}")
        if fonts is not None:
            fonts.set(qn("w:val"), {"en": "en-GB", "it": "it-IT"}[self.sheet.language.key])
        core = self.document.core_properties
        core.title, core.author, core.comments = printable(self.sheet.heading)[:255], "", ""

    def _logo(self, address: str) -> None:
        from docx.shared import Cm

        if not address.startswith(PICTURE_PREFIXES):
            hint = "give a PNG or JPEG picture, or a sheet that ends in .html"
            raise InputError(Problem("a .docx file cannot hold an SVG logo", field="logo", hint=hint))
        data = base64.b64decode(address.partition(",")[2])
        try:
            self.document.add_picture(BytesIO(data), height=Cm(LOGO_HEIGHT))
        except Exception as error:  # python-docx raises errors of many kinds for a damaged picture
            raise InputError(Problem(f"the logo cannot be put into a .docx file: {error!r}", field="logo")) from None

    def _part(self, part: SheetPart, level: int) -> None:
        self._text(self.document.add_heading(level=min(level, 9)), part.heading)
        for item in part.items:
            self._item(item)
        for each in part.parts:
            self._part(each, level + 1)

    def _item(self, item: Item) -> None:
        from docx.shared import Cm, Pt

        if isinstance(item, Table):
            caption = self.document.add_paragraph()
            caption.paragraph_format.keep_with_next = True
            self._text(caption, item.title)
            self._table([[[each] for each in row] for row in (item.columns, *item.rows)], heads=True)
        elif isinstance(item, Steps):
            self._table([self._step(row) for row in item.rows], widths=(1.1, 10.1, 3.2, 2.6))
        elif isinstance(item, Drawing):
            stream = BytesIO()
            style.save(figure_of(item, self.sheet.language), stream, format="png")
            stream.seek(0)
            self.document.add_picture(stream, width=Cm(TEXT_WIDTH))
            self.document.paragraphs[-1].paragraph_format.keep_with_next = True
            self._text(self.document.add_paragraph(), item.label)
        elif isinstance(item, Listing):
            for line in item.text.split("\n"):
                paragraph = self.document.add_paragraph()
                paragraph.paragraph_format.space_after = Pt(0)
                run = paragraph.add_run(printable(line))
                run.font.name, run.font.size = "Courier New", Pt(8)
        else:
            self._text(self.document.add_paragraph(), item.text, bold=item.answers, marked=item.is_open)

    def _step(self, row: Working) -> list[list[str]]:
        """Return the cells of a step: number, meaning and formula with numbers, result, clause."""
        written = row.formula if not row.numbers else f"{row.formula} = {row.numbers}"
        joined = ": " if row.formula and not row.numbers else " = "
        work = f"{row.symbol}{joined}{written}" if written else row.symbol
        result = f"{self.sheet.language.number(row.value, row.digits)} {row.unit}".strip()
        return [[str(next(self.steps))], [row.meaning, work], [result], [f"{row.clause}{ORIGIN_MARKS[row.standing]}"]]

    def _table(
        self, rows: Sequence[Sequence[Sequence[str]]], *, heads: bool = False, widths: Sequence[float] = ()
    ) -> None:
        """Write a table of cells with paragraphs; rows are not broken across pages, and headings and results bold."""
        from docx.oxml import OxmlElement
        from docx.shared import Cm, Pt

        table: Any = self.document.add_table(rows=0, cols=len(rows[0]), style="Table Grid")
        table.autofit = not widths
        for column, width in zip(table.columns, widths, strict=False):
            column.width = Cm(width)
        for k, row in enumerate(rows):
            cells = table.add_row().cells
            table.rows[-1]._tr.get_or_add_trPr().append(OxmlElement("w:cantSplit"))
            for n, (cell, texts) in enumerate(zip(cells, row, strict=True)):
                for text in texts:
                    paragraph = cell.paragraphs[0] if text is texts[0] else cell.add_paragraph()
                    paragraph.paragraph_format.space_after = Pt(0)
                    self._text(
                        paragraph, text, bold=(heads and k == 0) or (bool(widths) and n == 2), size=TABLE_FONT_SIZE
                    )
                if widths:
                    cell.width = Cm(widths[n])
        self.document.add_paragraph()

    def _text(
        self, paragraph: Paragraph, text: str, *, bold: bool = False, size: float | None = None, marked: bool = False
    ) -> None:
        """Write a text with its sub- and superscripts; characters that XML cannot hold are spelled out."""
        from docx.enum.text import WD_COLOR_INDEX
        from docx.shared import Pt

        for piece, place in runs(text):
            run = paragraph.add_run(printable(piece))
            run.bold = bold or None
            run.font.highlight_color = WD_COLOR_INDEX.YELLOW if marked else None
            if place:
                setattr(run.font, {"sub": "subscript", "sup": "superscript"}[place], True)
            if size is not None:
                run.font.size = Pt(size)
