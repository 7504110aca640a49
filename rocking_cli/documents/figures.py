"""Pictures within a page: its templates, matplotlib figures as SVG, and a logo at its head."""

from __future__ import annotations

import base64
import io
import re
from collections.abc import Callable
from io import StringIO
from pathlib import Path

from jinja2 import Environment, PackageLoader, StrictUndefined, Template
from markupsafe import Markup
from matplotlib import rc_context
from matplotlib.figure import Figure
from matplotlib.text import Text

from rocking_cli.errors import InputError, Problem
from rocking_cli.io.files import read_bytes
from rocking_cli.plotting import style
from rocking_cli.text import cut, printable

FONT_FAMILY = "system-ui, 'Segoe UI', Helvetica, Arial, 'DejaVu Sans', sans-serif"

HALO = "over-lines-"  # prefix of the identifier of words over lines
SVG_STYLE = f"font-family: {FONT_FAMILY}; stroke-linejoin: round; stroke-linecap: butt"
SVG_ATTRIBUTES = f'aria-hidden="true" focusable="false" style="{SVG_STYLE}"'


def template(name: str, **filters: Callable[..., object]) -> Template:
    """Return the template of a page, with filters of its own; whatever it is given is escaped."""
    environment = Environment(
        loader=PackageLoader("rocking_cli", "documents/templates"), autoescape=True, undefined=StrictUndefined,
        trim_blocks=True, lstrip_blocks=True,
    )  # fmt: skip
    environment.filters.update(filters)
    return environment.get_template(name)


def svg(figure: Figure, salt: str, *, text_as: str = "none") -> str:
    """Return a figure as the content of an SVG file, the same each time, with its text as text or as "path"."""
    stream = StringIO()
    over_lines = [each for each in figure.findobj(Text) if each.get_path_effects()] if text_as == "none" else []
    for k, each in enumerate(over_lines):  # otherwise they would be written as shapes, in another font
        each.set(path_effects=[], gid=f"{HALO}{k}")
    with rc_context({"svg.fonttype": text_as, "svg.hashsalt": salt}):
        unnamed = {"Date": None, "Creator": None, "Format": None, "Type": None}
        style.save(figure, stream, format="svg", metadata=unnamed)
    halo = f"paint-order: stroke; stroke: {style.PAPER}; stroke-width: {style.HALO_WEIGHT}; stroke-linejoin: round"
    return re.sub(rf'<g id="{HALO}\d+"', rf'\g<0> style="{halo}"', stream.getvalue())


def dark_figures(scope: str = "figure ") -> Markup:
    """Return the style sheet of the figures on a page, for readers who have chosen dark pages."""
    return Markup(f"@media screen and (prefers-color-scheme: dark) {{\n{style.dark_rules(scope)}\n}}")


def inline_svg(draw: Callable[[], Figure], prefix: str) -> Markup:
    """Return a figure as two svg elements to put inside an HTML page, one of which is shown.

    Parameters
    ----------
    draw : callable
        Draws the figure: once for a wide screen and for print (class `wide`), and once for a phone (`narrow`).
    prefix : str
        Prefix of every identifier, so that those of several figures on a page differ.
    """
    wide = svg_element(draw(), prefix)
    with style.on_phone():
        narrow = svg_element(draw(), f"{prefix}-narrow")
    return Markup(f'<div class="wide">{wide}</div><div class="narrow">{narrow}</div>')


def svg_element(figure: Figure, prefix: str) -> str:
    """Return a figure as one svg element, with a prefix of every identifier."""
    text = svg(figure, prefix)
    text = text[text.index("<svg") :]
    # A style sheet would apply to the whole page, and the comments repeat every text.
    text = re.sub(r"<(metadata|style)\b.*?</\1>|\s*<!--.*?-->", "", text, flags=re.DOTALL)
    # Rules of a page do not reach copies of marks, which take the colours of the element that places them.
    text = re.sub(r'(<defs>\s*<path [^>]*style=")(?:fill: #\w+; )?stroke: #\w+(?:; )?', r"\1", text)
    # Text from users is left unchanged.
    return re.sub(r"<[^>]*>", lambda tag: _tag(tag[0], prefix), text)


def _tag(tag: str, prefix: str) -> str:
    tag = re.sub(r'\bid="', f'id="{prefix}-', tag)
    tag = re.sub(r'(href="|url\()#', rf"\1#{prefix}-", tag)
    # A hundredth of a point is not seen, and a line break of each point of a path is as long as a number.
    tag = re.sub(r"(\.\d\d)\d+", r"\1", re.sub(r"\s+", " ", tag)) if tag.startswith("<path") else tag
    # Rules of the page do not reach the shape of a mark, whose style its uses repeat, nor the attribute of a rectangle.
    tag = re.sub(r'(<path id="[^"]*" d="[^"]*") style="[^"]*"', r"\1", tag)
    tag = re.sub(r'(<rect [^>]*)\bfill="(#\w+)"', r'\1style="fill: \2"', tag)
    tag = re.sub(r"font-family: '?DejaVu Sans'?[^;\"]*(; )?", "", tag)  # that of the whole figure
    # Screen readers take the description beside the picture.
    return tag.replace("<svg ", f"<svg {SVG_ATTRIBUTES} ", 1)


MAX_LOGO_SIZE = 1_000_000  # bytes, as the page is sent by mail
# The first bytes of files, by media type.
SIGNATURES = {"image/png": b"\x89PNG\r\n\x1a\n", "image/jpeg": b"\xff\xd8\xff"}


def _check_whole(data: bytes, kind: str, path: Path) -> None:
    """Raise `InputError` if a picture is damaged, so that no browser can show it."""
    from xml.etree.ElementTree import fromstring

    from PIL import Image, UnidentifiedImageError

    try:
        if kind in SIGNATURES:
            Image.open(io.BytesIO(data)).verify()  # checks the checksums; the object cannot be used afterwards
            Image.open(io.BytesIO(data)).load()
        else:
            fromstring(data)
    except Exception as error:  # Pillow raises errors of many kinds, without a common base
        unread = isinstance(error, UnidentifiedImageError)  # the text of this error names a Python object
        reason = "no picture can be read from it" if unread else " ".join(str(error).split()) or type(error).__name__
        what = f"the logo is damaged: {printable(cut(reason))}"
        raise InputError(Problem(what, str(path), hint="save the picture again")) from None


def embedded(path: Path) -> str:
    """Return a picture as a data URL.

    Parameters
    ----------
    path : Path
        A PNG, JPEG or SVG file; the type is recognised from the content.

    Raises
    ------
    InputError
        If the file cannot be read, is too large, or is of another type.
    """
    data = read_bytes(path, "logo", MAX_LOGO_SIZE)
    kind = next((kind for kind, begin in SIGNATURES.items() if data.startswith(begin)), None)
    if kind is None and b"<svg" in data[:4096]:
        kind = "image/svg+xml"
    if kind is None:
        raise InputError(
            Problem("the file is not a PNG, JPEG or SVG picture", str(path), hint="convert the logo to one of them")
        )
    _check_whole(data, kind, path)
    return f"data:{kind};base64,{base64.b64encode(data).decode()}"
