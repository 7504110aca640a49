"""Options and arguments that several commands share."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import click

Decorator = Callable[[Callable[..., Any]], Callable[..., Any]]

as_json: Decorator = click.option("--json", "as_json", is_flag=True, help="Print one JSON object and nothing else.")


class Finite(click.ParamType):  # type: ignore[type-arg,unused-ignore]  # generic in newer click only
    """A finite number; `positive` ones more than zero."""

    name = "number"

    def __init__(self, *, positive: bool = False) -> None:
        self.positive = positive

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float:
        """Turn a text into the number, or fail naming the option."""
        try:
            number = float(value)
        except ValueError:
            self.fail(f"{value!r} is not a number.", param, ctx)
        if not abs(number) < float("inf") or (self.positive and number <= 0):
            self.fail(f"{value} is not a {'positive' if self.positive else 'finite'} number.", param, ctx)
        return number


def output_path(*suffixes: str) -> Callable[[click.Context, click.Parameter, str | None], Path | None]:
    """A callback for an output file: its suffix must be one of these, and its folder must take a file."""

    def check(ctx: click.Context, param: click.Parameter, value: str | None) -> Path | None:
        from rocking_cli.files import check_writable

        if value is None:
            return None
        path = Path(value)
        if path.suffix.lower() not in suffixes:
            raise click.BadParameter(f"{value!r} does not end in {' or '.join(suffixes)}.", ctx, param)
        check_writable(path)
        return path

    return check
