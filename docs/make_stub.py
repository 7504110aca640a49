"""Writes rocking_cli/__init__.pyi, which tells type checkers the names that the package provides on first use.

    python docs/make_stub.py              # part of make pages

The package imports nothing until a name is used, and no mechanism by name; the stub says where each is.
"""

from __future__ import annotations

from importlib.metadata import distribution
from pathlib import Path

import rocking_cli
from rocking_cli.plugins.rooms import names

STUB = Path(rocking_cli.__file__).with_suffix(".pyi")


def stub() -> str:
    """Return the text of the stub."""
    lines = ['"""Written by `make pages`: do not edit."""', ""]
    own = distribution("rocking-cli").entry_points.select(group="rocking.mechanisms")
    found = [(point.module, point.attr) for point in own]
    found += [(f"rocking_cli.{home}", name) for home, names in rocking_cli._HOME.items() for name in names]
    found += [(module, name) for name, module in names().items()]
    lines += [f"from {module} import {name} as {name}" for module, name in sorted(found)]
    return "\n".join([*lines, "", "__version__: str", "mechanisms: Registry", ""])


def main() -> None:
    """Write it."""
    STUB.write_text(stub(), encoding="utf-8")


if __name__ == "__main__":
    main()
