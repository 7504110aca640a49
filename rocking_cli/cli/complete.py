"""Shell completion of values on a command line; plugins are listed and never loaded."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import click
from click.shell_completion import CompletionItem

CODES, MECHANISMS, PULSES = "rocking.codes", "rocking.mechanisms", "rocking.pulses"
"""Entry-point groups, as in the modules of the plugins, which take long to import."""
Completer = Callable[[click.Context, click.Parameter, str], list[CompletionItem]]


def files(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[CompletionItem]:
    """Complete names of files, as the shell does."""
    return [CompletionItem(incomplete, type="file")]


def plugins(group: str, *more: str, ending: str = "") -> Completer:
    """Return a completer for the names of the plugins of a group and those in `more`, each with a suffix."""

    def complete(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[CompletionItem]:
        from rocking_cli.plugins.registry import find

        names = (name + ending for name in sorted({*find(group), *more}))
        return [CompletionItem(name) for name in names if name.startswith(incomplete)]

    return complete


def words(known: str) -> Completer:
    """Return a completer of a kind: "file", the entry-point group of plugins, or words; several of words and commas."""
    if known in ("file", "output"):
        return files
    if known.startswith("rocking."):
        return plugins(known)
    if "," in known:
        return listed(known.split(","))

    def complete(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[CompletionItem]:
        return [CompletionItem(each) for each in known.split() if each.startswith(incomplete)]

    return complete


codes = plugins(CODES)
"""Complete names of installed codes of practice."""


def listed(words: Sequence[str]) -> Completer:
    """Complete the last of several words separated by commas, with one not given before."""

    def complete(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[CompletionItem]:
        before, comma, begun = incomplete.rpartition(",")
        there = before.split(",")
        return [CompletionItem(before + comma + each) for each in words if each.startswith(begun) and each not in there]

    return complete
