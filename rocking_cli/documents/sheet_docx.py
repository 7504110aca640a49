"""A document for word processors, made with python-docx."""

from __future__ import annotations

import base64
from collections.abc import Sequence
from io import BytesIO
from itertools import count
from operator import itemgetter
from typing import TYPE_CHECKING, Any
from zipfile import ZIP_DEFLATED, ZipFile, ZipInfo

from rocking_cli.documents.mathematics import Node, Unreadable, formulas_of, pieces
from rocking_cli.documents.sheet_page import ORIGIN_MARKS, TEXT_WIDTH, figure_of, printed_width, runs
from rocking_cli.errors import InputError, Problem
from rocking_cli.plotting import style
from rocking_cli.studies.remark import MARK
from rocking_cli.text import printable
from rocking_cli.verification.results import Working
from rocking_cli.views.sheet.document import Drawing, Item, Listing, Sheet, SheetPart, Steps
from rocking_cli.views.view import Table

if TYPE_CHECKING:
    from docx.document import Document
    from docx.text.paragraph import Paragraph

CELL, FORMULA = "Cell", "Formula"
MONOSPACED = "Courier New"
FONT_SIZES = {CELL: 8, FORMULA: 10}  # pt of the styles of paragraphs in tables
COUNT_WIDTH = 1.1  # cm of the column with the numbers of steps
CELL_MARGIN = 3  # characters that are as wide as the margins of a cell
MAX_COLUMN_LENGTH = 18  # characters of the text of a cell that its column is made wide for; a word is not broken
LOGO_HEIGHT = 1.6  # cm
BLANK = "_" * 40  # what is filled in by hand in the heading
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
    """Return a document as the content of a .docx file.

    Parameters
    ----------
    sheet : Sheet
        The document.

    Raises
    ------
    InputError
        If the package python-docx is not installed, or the logo is a picture that a document cannot hold.
    """
    check_package()
    from docx import Document

    writer = _Writer(Document(), sheet)
    writer.write()
    writer.document.save(saved := BytesIO())
    stream = BytesIO()
    with ZipFile(saved) as parts, ZipFile(stream, "w", ZIP_DEFLATED) as dateless:  # the same file each time
        for name in parts.namelist():
            dateless.writestr(ZipInfo(name), parts.read(name), ZIP_DEFLATED)
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
        self._table([(name, text or BLANK) for name, text in sheet.about.items()])
        for k, each in enumerate(sheet.parts):
            self._part(each, 1)
            if k == 0:
                self._sign_and_list()

    def _sign_and_list(self) -> None:
        """Write the place for the signature, and the table of contents, which a word processor fills on request."""
        say = self.sheet.language
        if self.sheet.signature:
            self._table([[say(name) + "\n" * SIGNATURE_LINES for name in self.sheet.signature]])
        title = self.document.add_paragraph()
        title.paragraph_format.page_break_before = title.paragraph_format.keep_with_next = True
        self._text(title, say("Contents"), bold=True, size=14)
        self._field(
            self.document.add_paragraph(), r'TOC \o "1-2" \h \z', "\n".join(each.heading for each in self.sheet.parts)
        )

    def _field(self, paragraph: Paragraph, code: str, until_filled: str) -> None:
        """Write a field, such as the number of the page, with the text that stands until a word processor fills it."""
        from docx.oxml import OxmlElement
        from docx.oxml.ns import qn

        field = OxmlElement("w:fldSimple")
        field.set(qn("w:instr"), code)
        field.set(qn("w:dirty"), "true")
        run = paragraph.add_run("\n".join(map(printable, until_filled.split("\n"))))
        field.append(run._r)
        paragraph._p.append(field)

    def _page(self) -> None:
        """Set the page to A4, and the language of the text."""
        from docx.enum.style import WD_STYLE_TYPE
        from docx.oxml.ns import qn
        from docx.shared import Cm, Pt

        section = self.document.sections[0]
        section.page_width, section.page_height = Cm(21.0), Cm(29.7)
        section.left_margin = section.right_margin = section.top_margin = section.bottom_margin = Cm(2.0)
        self._field(section.footer.paragraphs[0], "PAGE", "1")
        section.different_first_page_header_footer = True
        self._field(section.first_page_footer.paragraphs[0], "PAGE", "1")
        self._text(section.header.paragraphs[0], self.sheet.running)
        normal = self.document.styles["Normal"]
        normal.font.size = Pt(10)
        for name, size in FONT_SIZES.items():
            style: Any = self.document.styles.add_style(name, WD_STYLE_TYPE.PARAGRAPH)
            style.font.size, style.paragraph_format.space_after = Pt(size), Pt(0)
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
        heading = self.document.add_heading(level=min(level, 9))
        heading.paragraph_format.page_break_before = part.key in self.sheet.own_pages or None
        self._text(heading, part.heading)
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
            self._table([item.columns, *item.rows], heads=True)
        elif isinstance(item, Steps):
            self._steps(item.rows)
        elif isinstance(item, Drawing):
            stream = BytesIO()
            figure = figure_of(item, self.sheet.language)
            width = printed_width(figure, item.height)  # before it is drawn
            style.save(figure, stream, format="png")
            stream.seek(0)
            shape = self.document.add_picture(stream, width=Cm(width))
            shape._inline.docPr.set("descr", printable("".join(piece for piece, _ in runs(item.label))))
            self.document.paragraphs[-1].paragraph_format.keep_with_next = True
            self._text(self.document.add_paragraph(), item.label)
        elif isinstance(item, Listing):
            for line in item.text.split("\n"):
                paragraph = self.document.add_paragraph()
                paragraph.paragraph_format.space_after = Pt(0)
                run = paragraph.add_run(printable(line))
                run.font.name, run.font.size = MONOSPACED, Pt(8)
        else:
            self._text(self.document.add_paragraph(), item.text, bold=item.answers, marked=item.is_open)

    def _steps(self, rows: Sequence[Working]) -> None:
        """Write steps as on a page: the meaning with its clause, and below it the formulas with their result."""
        table = self._table([["", ""] for _ in rows], widths=(COUNT_WIDTH, TEXT_WIDTH - COUNT_WIDTH))
        for row, cells in zip(rows, (each.cells for each in table.rows), strict=True):
            self._text(cells[0].paragraphs[0], str(next(self.steps)))
            what = cells[1].paragraphs[0]
            what.paragraph_format.keep_with_next = True
            self._text(what, f"{row.meaning} {row.clause}{ORIGIN_MARKS[row.standing]}".rstrip())
            work, (formulas, gives) = cells[1].add_paragraph(style=FORMULA), formulas_of(row)
            for sign, text in formulas:
                self._text(work, f"{sign} ".lstrip())
                self._formula(work, text)
            self._text(work, f"{gives} ")
            self._text(work, self.sheet.language.number(row.value, row.digits), bold=True)
            self._text(work, f" {row.unit}" if row.unit else "")

    def _table(self, rows: Sequence[Sequence[str]], *, heads: bool = False, widths: Sequence[float] = ()) -> Any:
        """Write a table; rows are not broken across pages, and the headings are bold and repeated on each page."""
        from docx.oxml import OxmlElement
        from docx.shared import Cm

        widths = widths or _widths(rows)
        table: Any = self.document.add_table(rows=0, cols=len(widths), style="Table Grid")
        table.autofit = False
        for column, width in zip(table.columns, widths, strict=True):
            column.width = Cm(width)
        for k, row in enumerate(rows):
            new, is_head = table.add_row(), heads and k == 0
            for name in ("cantSplit", "tblHeader") if is_head else ("cantSplit",):
                new._tr.get_or_add_trPr().append(OxmlElement(f"w:{name}"))
            for cell, text, width in zip(new.cells, row, widths, strict=True):
                cell.width, paragraph = Cm(width), cell.paragraphs[0]
                paragraph.style = CELL
                paragraph.paragraph_format.keep_with_next = is_head or None
                self._text(paragraph, text, bold=is_head)
        self.document.add_paragraph(style=CELL)
        return table

    def _formula(self, paragraph: Paragraph, text: str) -> None:
        """Write a formula as mathematics of the word processor, or what is no formula as text."""
        try:
            rows = pieces(printable(text))
        except Unreadable:
            self._text(paragraph, text)
        else:
            for row in rows:  # a line may be broken between two; a sign at the end of mathematics lacks what follows it
                parts, end = (row.parts[:-1], row.parts[-1].text) if row.parts[-1].kind == "sign" else (row.parts, "")
                paragraph._p.append(_math("oMath", *(each for part in parts for each in _elements(part))))
                self._text(paragraph, f" {end} " if end else " ")

    def _text(
        self, paragraph: Paragraph, text: str, *, bold: bool = False, size: float | None = None, marked: bool = False
    ) -> None:
        """Write a text with its sub- and superscripts; characters that XML cannot hold are spelled out."""
        from docx.enum.text import WD_COLOR_INDEX
        from docx.shared import Pt

        for piece, place in filter(itemgetter(0), runs(text)):
            run = paragraph.add_run("\n".join(map(printable, piece.split("\n"))))
            run.bold = bold or None
            run.font.highlight_color = WD_COLOR_INDEX.YELLOW if marked else None
            if place == "code":
                run.font.name = MONOSPACED
            elif place:
                setattr(run.font, {"sub": "subscript", "sup": "superscript"}[place], True)
            if size is not None:
                run.font.size = Pt(size)


def _widths(rows: Sequence[Sequence[str]]) -> list[float]:
    """Return the widths of columns, in cm, by the lengths of their texts: a table is as wide as the page."""
    lengths = [
        max(max(min(len(MARK.sub(r"\2", text)), MAX_COLUMN_LENGTH), *map(len, text.split()), 4) for text in column)
        for column in zip(*rows, strict=True)
    ]
    return [TEXT_WIDTH * (each + CELL_MARGIN) / (sum(lengths) + CELL_MARGIN * len(lengths)) for each in lengths]


def _math(name: str, *children: Any, **values: str) -> Any:
    """Return an element of Office Math with a value and its children."""
    from docx.oxml import OxmlElement
    from docx.oxml.ns import qn

    element: Any = OxmlElement(f"m:{name}")
    for key, value in values.items():
        element.set(qn(f"m:{key}"), value)
    element.extend(children)
    return element


def _elements(node: Node) -> list[Any]:
    """Return the elements of Office Math of a piece of a formula."""
    inside = [_elements(each) for each in node.parts]
    if node.kind == "row":
        return [each for part in inside for each in part]
    if node.kind == "fraction":
        return [_math("f", _math("num", *inside[0]), _math("den", *inside[1]))]
    if node.kind == "root":
        return [_math("rad", _math("radPr", _math("degHide", val="1")), _math("deg"), _math("e", *inside[0]))]
    if node.kind == "fence":
        signs = _math("dPr", _math("begChr", val=node.text[0]), _math("endChr", val=node.text[1]))
        return [_math("d", signs, _math("e", *(each for part in inside for each in part)))]
    if node.kind == "script":
        names = [name for name, each in zip(("Sub", "Sup"), inside[1:], strict=True) if each]
        scripts = [_math(name.lower(), *each) for name, each in zip(("Sub", "Sup"), inside[1:], strict=True) if each]
        return [_math(f"s{''.join(names)}", _math("e", *inside[0]), *scripts)]
    text = _math("t")
    text.text = node.text
    # Normal text is upright, and nothing in it is read as an operator, such as the star of a symbol.
    is_normal = node.kind in ("word", "gap", "bracket")
    return [_math("r", *([_math("rPr", _math("nor"))] if is_normal else []), text)]
