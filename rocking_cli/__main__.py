"""The command `rocking`, also as `python -m rocking_cli`: it ends in order from the first import on."""

import sys


def run() -> None:
    """Run the program."""
    try:
        from rocking_cli.cli.main import main
    except KeyboardInterrupt:
        sys.stderr.write("error: interrupted\n")
        sys.exit(130)
    main(prog_name="rocking")


if __name__ == "__main__":
    run()
