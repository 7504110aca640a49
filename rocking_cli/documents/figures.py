"""Templates of pages, and matplotlib figures as SVG inside a page."""

from __future__ import annotations

import re
from collections.abc import Callable
from io import StringIO

from jinja2 import Environment, PackageLoader, StrictUndefined, Template
from markupsafe import Markup
from matplotlib import rc_context
from matplotlib.figure import Figure
from matplotlib.text import Text

from rocking_cli.plotting import style

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
