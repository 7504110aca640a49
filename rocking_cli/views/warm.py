"""View of the kernels that `rocking warm` compiled."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from rocking_cli.studies.compiling import CALLED, Compiled
from rocking_cli.views.view import View


def view(folder: Path | None, found: Sequence[Compiled]) -> View:
    """Show the compiled kernels, the time this took, and the folder that keeps them; None if nothing is kept."""
    kernels = [
        {"kernel": CALLED[each.kernel], "compiled_before": each.before, "seconds": each.seconds} for each in found
    ]
    said = [
        f"{CALLED[each.kernel].replace('_', ' ')}: "
        + ("already compiled" if each.before else f"compiled in {each.seconds:.1f} s")
        for each in found
    ]
    where = "part of the installation" if folder is None else f"kept in {folder}"
    return View(
        {"cache": None if folder is None else str(folder), "kernels": kernels}, [*said, f"The machine code is {where}."]
    )
