"""How Sphinx builds the documentation: `make docs`. Nothing is fetched, when it is built or when it is read."""

from __future__ import annotations

import re
import sys
from pathlib import Path

from sphinx.application import Sphinx

from rocking_cli import __version__

sys.path.insert(0, str(Path(__file__).resolve().parent))  # mathml.py

from make_reference import docstrings

project = "rocking-cli"
author = "The rocking-cli authors"
project_copyright = author
version = release = __version__

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "mathml"]
# All but the first are parts of other pages.
exclude_patterns = ["_generated", "corrections.md", "validation_*.md", "trust/*.md"]
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
html_copy_source = False
html_show_sourcelink = False
pygments_style = "tango"
highlight_language = "none"

# The docstrings say what their arguments are, with units and shapes, in words.
autodoc_typehints = "none"
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
WHOLE = {
    "changelog": "```{include} ../CHANGELOG.md\n```\n",
    "contributing": "```{include} ../CONTRIBUTING.md\n:relative-docs: docs/\n```\n",
}


def _on_the_site(app: Sphinx, page: str, source: list[str]) -> None:
    text = WHOLE.get(page, source[0])
    for link, here in ELSEWHERE.items():
        text = text.replace(link, here)
    text = NAMES.sub(lambda part: f"{part[0]}\n{docstrings(part['names'])}", text)
    source[0] = text + _menus(text) if page == "index" else text


def _menus(text: str) -> str:
    """Return the menus of the site, from the lists of contents of the first page."""
    _, *lists = re.split(r"^##+ (?=Contents|Worked|Mechanisms|Background|Reference)", text, flags=re.M)
    menus = []
    for each in lists:
        caption = each.split("\n")[0]
        entries = "\n".join(f"{name} <{link}>" for name, link in re.findall(r"^- \[(.+?)\]\((\S+)\.md\)", each, re.M))
        menus.append(f"```{{toctree}}\n:hidden:\n:caption: {caption}\n\n{entries}\n```\n")
    return "\n" + "\n".join(menus)


def setup(app: Sphinx) -> None:
    """Called by Sphinx."""
    app.connect("source-read", _on_the_site)
