"""What `rocking warm` compiled."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from rocking_cli.studies.compiling import CALLED, Compiled
from rocking_cli.views.view import View


def view(folder: Path, found: Sequence[Compiled]) -> View:
    """What is compiled now, and how long that took."""
    kernels = [
        {"kernel": CALLED[each.kernel], "compiled_before": each.before, "seconds": each.seconds} for each in found
    ]
    said = [
        f"{CALLED[each.kernel].replace('_', ' ')}: "
        + ("already compiled" if each.before else f"compiled in {each.seconds:.1f} s")
        for each in found
    ]
    return View({"cache": str(folder), "kernels": kernels}, [*said, f"The machine code is kept in {folder}."])
