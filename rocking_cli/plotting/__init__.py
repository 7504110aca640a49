"""Plots, as matplotlib figures; pyplot is never used, as it holds state."""

import sys

if "rocking_cli.cli.main" in sys.modules:
    # Matplotlib takes a tenth of a second to write docstrings for its classes, which this program does not need.
    import matplotlib.artist

    matplotlib.artist.kwdoc = lambda artist: ""
