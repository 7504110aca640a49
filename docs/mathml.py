"""Sphinx extension that writes equations as MathML, which every current browser draws by itself.

Sphinx's own ways need a script from a server (MathJax) or LaTeX (imgmath), and sphinxcontrib-katex needs Node to do
without a script. docutils, which Sphinx is built on, turns LaTeX into MathML in Python: no script, no network and no
further package.
"""

from __future__ import annotations

import re
from typing import Any

from docutils import nodes
from docutils.utils.math import MathError
from docutils.utils.math.latex2mathml import tex2mathml
from sphinx.application import Sphinx
from sphinx.util import logging

LOG = logging.getLogger(__name__)

# Mathematics has a thin space between a factor, sin and its argument; docutils leaves it to browsers, which have none.
SPACE = '<mspace width="0.17em"/>'
NAME = r"<mi>(?:sin|cos|tan|sinh|cosh|ln|arcsin)</mi>"
POWER = rf"<msup>\s*{NAME}\s*<mn>\d</mn>\s*</msup>"
BEFORE = re.compile(rf"(</m(?!o>)\w+>\s*)({NAME}|{POWER})")
AFTER = re.compile(rf"(<mo>&ApplyFunction;</mo>|{POWER})(?!\s*<mo[^>]*>\(|\s*</)")


def visit_inline(writer: Any, node: nodes.math) -> None:
    """An equation in a line of text."""
    writer.body.append(rendered(node, as_block=False))
    raise nodes.SkipNode


def visit_block(writer: Any, node: nodes.math_block) -> None:
    """An equation on a line of its own; it scrolls where the page is narrower."""
    writer.body.append(f'<div class="math">{rendered(node, as_block=True)}</div>\n')
    raise nodes.SkipNode


def rendered(node: nodes.Element, *, as_block: bool) -> str:
    """MathML; an equation that docutils cannot read is a warning, and so an error of `make docs`."""
    try:
        return AFTER.sub(rf"\1{SPACE}", BEFORE.sub(rf"\1{SPACE}\2", tex2mathml(node.astext(), as_block=as_block)))
    except MathError as error:
        LOG.warning("equation %r: %s", node.astext(), error, location=node)
        return ""


def setup(app: Sphinx) -> dict[str, bool]:
    """Called by Sphinx."""
    app.add_html_math_renderer("mathml", (visit_inline, None), (visit_block, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
