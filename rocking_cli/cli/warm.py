"""`rocking warm`: compile ahead what the first history would wait for."""

from __future__ import annotations

import click

from rocking_cli.cli import options, terminal


@click.command(short_help="Compile ahead what the first history waits for.")
@options.as_json
def command(as_json: bool) -> None:
    """Compile what follows histories and answers pulses exactly, so that no later command has to wait for it.

    It takes some fifteen seconds, once for this machine and every version; after that it says that all is compiled.
    The machine code is kept in the user's cache folder, or in the folder that NUMBA_CACHE_DIR in the environment names.

    \b
    Example:
      rocking warm
    """
    from rocking_cli.dynamics.compiled import cache_folder, unwritable
    from rocking_cli.errors import Refused
    from rocking_cli.studies.compiling import CALLED, compile_kernel
    from rocking_cli.views.warm import view

    if (why := unwritable()) is not None:
        hint = "name another folder in NUMBA_CACHE_DIR"
        raise Refused(f"{cache_folder()}: cannot be written to ({why}): nothing compiled would be kept\n  {hint}")
    found = []
    for kernel, name in CALLED.items():
        with terminal.working(f"compiling {name.replace('_', ' ')}"):
            found.append(compile_kernel(kernel))
    terminal.show(view(cache_folder(), found), as_json=as_json)
