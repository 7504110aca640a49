"""What a shell can complete of a command line, besides commands and options; plugins are listed and never loaded."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import click
from click.shell_completion import CompletionItem

Completer = Callable[[click.Context, click.Parameter, str], list[CompletionItem]]


def files(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[CompletionItem]:
    """Names of files, which the shell knows."""
    return [CompletionItem(incomplete, type="file")]


def mechanisms(*more: str) -> Completer:
    """Names of installed mechanisms, and others that stand in their place."""
    return _plugins("rocking.mechanisms", more=more)


def shapes(ending: str = "") -> Completer:
    """Names of installed pulse shapes, with what follows them."""
    return _plugins("rocking.pulses", ending=ending)


def listed(words: Sequence[str]) -> Completer:
    """Words with commas between them, of which the last is completed with one that is not there yet."""

    def complete(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[CompletionItem]:
        before, comma, begun = incomplete.rpartition(",")
        there = before.split(",")
        return [CompletionItem(before + comma + each) for each in words if each.startswith(begun) and each not in there]

    return complete


def _plugins(group: str, *, more: Sequence[str] = (), ending: str = "") -> Completer:
    def complete(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[CompletionItem]:
        from rocking_cli.plugins.installed import find

        names = (name + ending for name in sorted({*find(group), *more}))
        return [CompletionItem(name) for name in names if name.startswith(incomplete)]

    return complete
