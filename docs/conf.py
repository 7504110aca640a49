"""How Sphinx builds the documentation: `make docs`. Nothing is fetched, when it is built or when it is read."""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import Any, is_typeddict

from docutils.nodes import Element
from sphinx.application import Sphinx
from sphinx.environment import BuildEnvironment
from sphinx.util.nodes import make_refnode

from rocking_cli import __version__

sys.path.insert(0, str(Path(__file__).resolve().parent))  # mathml.py, phone.py, folded.py

from make_reference import docstrings, typed

project = "rocking-cli"
author = "The rocking-cli authors"
project_copyright = author
version = release = __version__

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "mathml", "phone", "folded"]
exclude_patterns = ["_generated"]
myst_enable_extensions = ["dollarmath"]
myst_fence_as_directive = ["math"]  # ```math is what code forges draw
myst_heading_anchors = 3
smartquotes = False  # -- begins an option, and '' is a second derivative
nitpicky = True
nitpick_ignore = [
    ("py:class", "rocking_cli.core.registry.UnknownMechanismError"),
    ("py:exc", "pydantic.ValidationError"),
    ("py:exc", "PluginError"),
]  # not documented here

html_theme = "furo"
html_title = "rocking-cli"
html_math_renderer = "mathml"
html_static_path = ["static"]
html_css_files = ["site.css"]
html_js_files = ["open.js"]
html_use_index = False
html_copy_source = False
html_show_sourcelink = False
pygments_style = "xcode"  # its colours are legible on the paper of a block
highlight_language = "none"

python_maximum_signature_line_length = 80  # a longer one has a line for each argument
ARRAYS = ("Bools", "Counts", "Flags", "Integers", "Numbers", "Outcomes", "Points", "Reals")
autodoc_type_aliases = {name: name for name in ARRAYS}
autodoc_member_order = "bysource"
autodoc_default_options = {"exclude-members": "model_config"}
napoleon_google_docstring = False
napoleon_use_param = False
napoleon_use_rtype = False
napoleon_use_ivar = True
default_role = "code"  # `name` in a docstring

# What is a folder or a file of the repository, and has a page here.
ELSEWHERE = {
    "](../examples/)": "](examples.md)",
    "](../examples/plugin)": "](examples.md#a-plugin)",
    "](../README.md#set-up)": "](index.md#set-up)",
    "one file that needs no network": "{download}`one file that needs no network <_generated/run/report.html>`",
}
NAMES = re.compile(r"^<!-- names: (?P<names>.+?) -->\n.*?^<!-- end -->\n", re.M | re.S)
NAME = re.compile(r"\[`(\w+)`\]\(api/\w+\.md#([\w.]+)\)")
WHOLE = {
    "changelog": "```{include} ../CHANGELOG.md\n```\n",
    "contributing": "```{include} ../CONTRIBUTING.md\n:relative-docs: docs/\n```\n",
}


def _on_the_site(app: Sphinx, page: str, source: list[str]) -> None:
    text = WHOLE.get(page, source[0])
    for link, here in ELSEWHERE.items():
        text = text.replace(link, here)
    text = NAMES.sub(lambda part: docstrings(part["names"]), text)
    if page == "api":
        pages = re.findall(r"^## \[.+?\]\((.+?)\.md\)", text, re.M)
        text = NAME.sub(r"{py:obj}`\1 <\2>`", text) + _menu("Names", pages)
    source[0] = text + _menus(text) if page == "index" else text


def _menus(text: str) -> str:
    """Return the menus of the site, from the lists of contents of the first page."""
    _, *lists = re.split(r"^##+ (?=Contents|Worked|Mechanisms|Background|Reference)", text, flags=re.M)
    menus = []
    for each in lists:
        links = re.findall(r"^- \[(.+?)\]\((\S+)\.md\)", each, re.M)
        menus.append(_menu(each.split("\n")[0], [f"{name} <{link}>" for name, link in links]))
    return "\n" + "\n".join(menus)


def _menu(caption: str, entries: list[str]) -> str:
    return "\n".join(["", "```{toctree}", ":hidden:", f":caption: {caption}", "", *entries, "```", ""])


def _signature(app: Sphinx, what: str, name: str, each: Any, *_: Any) -> tuple[str, str] | None:
    """Return the arguments and the result of what is documented, with the types as their author wrote them."""
    return typed(each) if what in ("class", "function", "method") and not is_typeddict(each) else None


def _to_its_text(app: Sphinx, env: BuildEnvironment, node: Element, text: Element) -> Element | None:
    """Link a class in a signature or a list of errors to its text, wherever that is; a type without one stays text."""
    name = "." + node["reftarget"].rpartition(".")[2]
    for place, found in env.domains.python_domain.objects.items():
        if found.objtype in ("class", "exception") and place.endswith(name):
            return make_refnode(app.builder, node["refdoc"], found.docname, found.node_id, text)
    return text if node.get("reftype") == "class" else None


def setup(app: Sphinx) -> None:
    """Called by Sphinx."""
    app.connect("source-read", _on_the_site)
    app.connect("autodoc-process-signature", _signature)
    app.connect("missing-reference", _to_its_text)
