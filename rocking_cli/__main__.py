"""Entry point of the command `rocking` and of `python -m rocking_cli`; handles interrupts from the first import on."""

import gc
import os
import sys

GARBAGE_THRESHOLD = 100_000
"""Objects made between two searches for garbage; with Python's usual 700, searches take a fifth of a short command."""


def run() -> None:
    """Run the command line."""
    gc.set_threshold(GARBAGE_THRESHOLD)
    # Before numpy is imported: the matrices of a command are small, and on busy cores threads wait for each other.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    try:
        from rocking_cli.cli.main import main
    except KeyboardInterrupt:
        sys.stderr.write("error: interrupted\n")
        sys.exit(130)
    try:
        main(prog_name="rocking")
    finally:
        gc.freeze()  # the process ends soon, so that a search for garbage frees nothing


if __name__ == "__main__":
    run()
