"""Options of commands: `--json` of those that are no question, and shell completion, which never loads a plugin."""

from __future__ import annotations

from collections.abc import Callable

import click
from click.shell_completion import CompletionItem

from rocking_cli.cli.help import OUTPUT_HEADING, HeadedOption

JSON_HELP = "Print the result as one JSON object, and nothing else."
as_json = click.option("--json", "as_json", cls=HeadedOption, heading=OUTPUT_HEADING, is_flag=True, help=JSON_HELP)
CODES, MECHANISMS, PULSES = "rocking.codes", "rocking.mechanisms", "rocking.pulses"
"""Entry-point groups, as in the modules of the plugins, which take long to import."""
Completer = Callable[[click.Context, click.Parameter, str], list[CompletionItem]]


def completer(known: str, *more: str, ending: str = "") -> Completer:
    """Return what completes the value of an option.

    Parameters
    ----------
    known : str
        "file" for names of files, the entry-point group of plugins, or words: separated by spaces, or by commas if the
        option takes several of them.
    *more : str
        Further words beside the names of plugins.
    ending : str
        Suffix of each word.
    """

    def complete(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[CompletionItem]:
        if known in ("file", "output"):
            return [CompletionItem(incomplete, type="file")]  # the shell completes it
        before, comma, begun = incomplete.rpartition(",") if "," in known else ("", "", incomplete)
        words = known.replace(",", " ").split()
        if known.startswith("rocking."):
            from rocking_cli.plugins.registry import find

            words = sorted({*find(known), *more})
        typed = before.split(",") if comma else []
        return [
            CompletionItem(f"{before}{comma}{word}{ending}")
            for word in words
            if (word + ending).startswith(begun) and word not in typed
        ]

    return complete
