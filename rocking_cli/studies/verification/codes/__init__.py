"""The codes of practice: each a module, or a package, of this folder that has a `CODE`; nothing else names them."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from importlib import import_module
from pkgutil import iter_modules
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rocking_cli.studies.verification.code import Code


@cache
def codes() -> Mapping[str, Code]:
    """The codes there are, by what site files call them."""
    found = [import_module(f"{__name__}.{each.name}").CODE for each in iter_modules(__path__)]
    return {code.key: code for code in found}
