"""How Sphinx builds the documentation: `make docs`. Nothing is fetched, when it is built or when it is read."""

from __future__ import annotations

import sys
from pathlib import Path

from sphinx.application import Sphinx

from rocking_cli import __version__

sys.path.insert(0, str(Path(__file__).resolve().parent))  # mathml.py

project = "rocking-cli"
author = "The rocking-cli authors"
project_copyright = author
version = release = __version__

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "mathml"]
exclude_patterns = ["_generated", "corrections.md", "validation_head.md"]  # parts of other pages
myst_enable_extensions = ["deflist", "dollarmath"]
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

# What is a folder or a page of the repository, and has a page here.
ELSEWHERE = {
    "](../examples/)": "](examples.md)",
    "](../examples/plugin)": "](examples.md#a-plugin)",
    "](../README.md#set-up)": "](index.md#set-up)",
}


def _on_the_site(app: Sphinx, page: str, source: list[str]) -> None:
    for link, here in ELSEWHERE.items():
        source[0] = source[0].replace(link, here)


def setup(app: Sphinx) -> None:
    """Called by Sphinx."""
    app.connect("source-read", _on_the_site)
