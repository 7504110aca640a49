"""`python -m rocking_cli`: run `rocking` if its command is not on the path."""

from rocking_cli.cli.main import main

if __name__ == "__main__":
    main(prog_name="rocking")
