"""Entry point of the command `rocking` and of `python -m rocking_cli`; handles interrupts from the first import on."""

import gc
import sys

RARELY = 100_000
"""Objects that are made before Python looks for those that are no longer needed; of 700, a fifth of a short command."""


def run() -> None:
    """Run the command line."""
    gc.set_threshold(RARELY)
    try:
        from rocking_cli.cli.main import main
    except KeyboardInterrupt:
        sys.stderr.write("error: interrupted\n")
        sys.exit(130)
    try:
        main(prog_name="rocking")
    finally:
        gc.freeze()  # all ends with the process: there is nothing to look for


if __name__ == "__main__":
    run()
