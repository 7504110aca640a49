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

import make_json
from make_reference import command_line, made, typed
from parts import HERE

project = "rocking-cli"
author = "The rocking-cli authors"
project_copyright = author
version = release = __version__

extensions = [
    "myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx_reredirects", "mathml", "phone", "folded"
]  # fmt: skip
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

# Pages of earlier versions, which messages and other sites name, and where their text is now.
MOVED = {
    "structures": ["mechanisms", "starters"],
    "mechanisms/linkage": ["linkages"],
    "examples": [
        "walls/column_with_tendon", "walls/facade", "walls/floor_wall", "walls/gable", "walls/statue",
        "masonry/buttressed_arch", "masonry/cracked_facade", "masonry/portal", "masonry/wall_of_three",
        "masonry/wall_with_openings",
    ],
    "motions": ["records", "selection"],
    "histories": ["commands"],
    "verification": ["sheet"],
    "fragility": ["fragility_programs", "measures"],
    "import": ["import_svg"],
    "tutorial": ["gallery", "before_and_after"],
    "architecture": ["extending", "names", "kernels"],
    "reference/commands": ["cli"],
}  # fmt: skip
redirects = {old: "../" * old.count("/") + f"{page}.html" for page, those in MOVED.items() for old in those}

# What is a folder or a file of the repository, and has a page here.
ELSEWHERE = {
    "](../examples/)": "](examples.md)",
    "](../examples/plugin)": "](plugins.md)",
    "](../README.md#set-up)": "](index.md#set-up)",
    "](../CONTRIBUTING.md)": "](contributing.md)",
    "one file that needs no network": "{download}`one file that needs no network <_generated/run/report.html>`",
}
WHOLE = {
    "changelog": "```{include} ../CHANGELOG.md\n```\n",
    "contributing": "```{include} ../CONTRIBUTING.md\n:relative-docs: docs/\n```\n",
    "scoring": "```{include} ../validation/README.md\n:relative-docs: ../docs/\n```\n",
}
DOCS = Path(__file__).resolve().parent
ENTRY = re.compile(r"^- \[(.+?)\]\((\S+)\.md\)", re.M)
INNER = re.compile(r"\[([^]]+)\]\((\S+?)\.md\)")
REFERENCE = {"commands": ("# Options of the commands\n", command_line), "json": ("", make_json.page)}
"""Pages that are made whole: their beginnings, and their contents."""


def _write_reference(app: Sphinx) -> None:
    (DOCS / "reference").mkdir(exist_ok=True)
    for name, (beginning, content) in REFERENCE.items():
        (DOCS / "reference" / f"{name}.md").write_text(f"{beginning}\n{content()}", encoding="utf-8")


def _on_the_site(app: Sphinx, page: str, source: list[str]) -> None:
    text = WHOLE.get(page, source[0])
    text = HERE.sub(lambda part: made(part["kind"], " ".join(part["what"].split())), text)
    for link, here in ELSEWHERE.items():
        text = text.replace(link, here)
    source[0] = text + _menus(page, text)


def _menus(page: str, text: str) -> str:
    """Return the menus of a page, by the contents on the first page: all there, elsewhere those below its entry."""
    if page == "index":
        _, *lists = text.partition("\n## Contents\n")[2].split("\n### ")
        return "".join(_menu(each.partition("\n")[0], ENTRY.findall(each)) for each in lists)
    contents = (DOCS / "index.md").read_text(encoding="utf-8")
    entry = re.search(rf"^- \[.+?\]\({page}\.md\)(?P<below>.*\n(?:  .*\n)*)", contents, re.M)
    below = INNER.findall(entry["below"]) if entry else []
    return _menu("", below) if below else ""


def _menu(caption: str, entries: list[tuple[str, str]]) -> str:
    lines = [":hidden:", f":caption: {caption}" * bool(caption), "", *(f"{name} </{page}>" for name, page in entries)]
    return "\n".join(["", "```{toctree}", *lines, "```", ""])


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
    app.connect("builder-inited", _write_reference)
    app.connect("source-read", _on_the_site)
    app.connect("autodoc-process-signature", _signature)
    app.connect("missing-reference", _to_its_text)
