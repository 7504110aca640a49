"""Plots, as matplotlib figures; pyplot is never used, as it holds state."""

import sys

if "rocking_cli.cli.main" in sys.modules:
    # In a program nobody reads the docstrings that matplotlib writes of each of its classes, for a tenth of a second.
    import matplotlib.artist

    matplotlib.artist.kwdoc = lambda artist: ""
