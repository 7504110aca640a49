"""`rocking warm`: compile the time-history kernels in advance."""

from __future__ import annotations

import click

from rocking_cli.cli import options, terminal


@click.command(short_help="Compile the time-history kernels in advance.")
@options.as_json
def command(as_json: bool) -> None:
    """Compile the kernels of time histories and of exact pulse responses, so that no later command has to wait.

    The kernels are shipped compiled, so that there is nothing to do. If numba compiles them (ROCKING_KERNELS=jit), this
    takes some ten seconds, once for each machine and version; later calls report that all is compiled. The machine code
    is kept in the cache folder of the user, or in the folder named by NUMBA_CACHE_DIR in the environment.

    \b
    Example:
      rocking warm
    """
    from rocking_cli.dynamics import ways
    from rocking_cli.dynamics.calling import SETS
    from rocking_cli.dynamics.compiled import cache_folder, unwritable
    from rocking_cli.errors import Refused
    from rocking_cli.studies.compiling import CALLED, compile_kernel
    from rocking_cli.views.warm import view

    keeps = any(ways.way(each) == ways.JIT for each in SETS.values())
    if keeps and (why := unwritable()) is not None:
        hint = "name another folder in NUMBA_CACHE_DIR"
        raise Refused(f"{cache_folder()}: cannot be written to ({why}): the compiled code would be lost\n  {hint}")
    found = []
    for kernel, name in CALLED.items():
        with terminal.working(f"compiling {name.replace('_', ' ')}"):
            found.append(compile_kernel(kernel))
    terminal.show(view(cache_folder() if keeps else None, found), as_json=as_json)
