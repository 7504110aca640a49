"""A part of the site: long pages whose sections fold on a phone, and outputs whose sentences fit the screen."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

from docutils import nodes
from sphinx import addnodes
from sphinx.application import Sphinx

LONGEST = 12_000  # characters of a page that a phone shows whole
SHELL = re.compile(r"(rocking|pip|pipx|uv|make|python|cd) ")  # starts of command lines, which may be broken
CONTINUED = re.compile(rf"  (?!{SHELL.pattern})\S")  # a line that goes on with a sentence
MORE = "Arguments, results, members"  # of a public name
ALIGNED = re.compile(r"\S {2,}\S|─|^ +\S")  # what is in lines whose columns are aligned
BLOCK = re.compile(
    r'(?P<before><div class="highlight-(?P<language>text|none) notranslate"><div class="highlight"><pre>)'
    r"(?P<text>.*?)\n?(?P<after></pre>)",
    re.S,
)


def _fold(app: Sphinx, page: nodes.document, name: str) -> None:
    """Let sections of a long page fold, and fold all but the first paragraph on each public name."""
    (top,) = (each for each in page.children if isinstance(each, nodes.section))
    if len(page.astext()) > LONGEST:
        for section in top.children:
            if isinstance(section, nodes.section):
                title, *rest = section.children
                before = _html('<details class="part" open><summary>')
                section.children = [before, title, _html("</summary>"), *rest, _html("</details>")]
    for content in page.findall(addnodes.desc_content):
        first, rest = content.children[:1], content.children[1:]
        if rest and not isinstance(content.parent.parent, addnodes.desc_content):
            content.children = [*first, _html(f"<details><summary>{MORE}</summary>"), *rest, _html("</details>")]


def _html(text: str) -> nodes.raw:
    return nodes.raw("", text, format="html")


def _break_outputs(app: Sphinx, page: str, template: str, context: dict[str, Any], *_: Any) -> None:
    """Let sentences and command lines of blocks break; tables keep their columns, and scroll."""

    def broken(block: re.Match[str]) -> str:
        pieces = _of_output if block["language"] == "text" else _of_commands
        return (
            block["before"] + "".join(pieces(block["text"].removeprefix("<span></span>").split("\n"))) + block["after"]
        )

    if "body" in context:
        context["body"] = BLOCK.sub(broken, context["body"])


def _of_output(lines: list[str]) -> Iterator[str]:
    """Yield the pieces of an output: sentences, each with the lines that continue it, and tables."""
    table: list[str] = []
    while lines:
        line = lines.pop(0)
        if not line or ALIGNED.search(line):
            table.append(line)
            continue
        yield _table(table)
        table = []
        while lines and CONTINUED.match(lines[0]) and not ALIGNED.search(lines[0].strip()):
            line += " " + lines.pop(0).strip()
        yield f'<span class="sentence">{line}</span>'
    yield _table(table)


def _of_commands(lines: list[str]) -> Iterator[str]:
    """Yield the pieces of a block of commands, or of anything else that is typed."""
    table: list[str] = []
    for line in lines:
        if SHELL.match(line):
            yield _table(table)
            table = []
            options = re.sub(r"(?<= )-[\w-]+", r'<span class="option">\g<0></span>', line)
            yield f'<span class="sentence">{options}</span>'
        else:
            table.append(line)
    yield _table(table)


def _table(lines: list[str]) -> str:
    """Return lines that keep their columns; blank ones alone need no block."""
    text = "\n".join(lines)
    return f'<span class="table">{text}\n</span>' if text.strip() else "\n" * len(lines)


def setup(app: Sphinx) -> dict[str, bool]:
    """Called by Sphinx."""
    app.connect("doctree-resolved", _fold)
    app.connect("html-page-context", _break_outputs)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
