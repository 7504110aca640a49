"""Shell completion of values on a command line; plugins are listed and never loaded."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import click
from click.shell_completion import CompletionItem

CODES = "rocking.codes"
"""Entry-point group of codes of practice, as in `studies.verification.installed`, which takes long to import."""
Completer = Callable[[click.Context, click.Parameter, str], list[CompletionItem]]


def files(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[CompletionItem]:
    """Complete names of files, as the shell does."""
    return [CompletionItem(incomplete, type="file")]


def mechanisms(*more: str) -> Completer:
    """Return a completer for the names of installed mechanisms, and the names in `more`."""
    return _plugins("rocking.mechanisms", more=more)


def shapes(ending: str = "") -> Completer:
    """Complete names of installed pulse shapes, each with a suffix."""
    return _plugins("rocking.pulses", ending=ending)


def codes(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[CompletionItem]:
    """Complete names of installed codes of practice."""
    return _plugins(CODES)(ctx, param, incomplete)


def listed(words: Sequence[str]) -> Completer:
    """Complete the last of several words separated by commas, with one not given before."""

    def complete(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[CompletionItem]:
        before, comma, begun = incomplete.rpartition(",")
        there = before.split(",")
        return [CompletionItem(before + comma + each) for each in words if each.startswith(begun) and each not in there]

    return complete


def _plugins(group: str, *, more: Sequence[str] = (), ending: str = "") -> Completer:
    def complete(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[CompletionItem]:
        from rocking_cli.plugins.registry import find

        names = (name + ending for name in sorted({*find(group), *more}))
        return [CompletionItem(name) for name in names if name.startswith(incomplete)]

    return complete
