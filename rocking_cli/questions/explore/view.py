"""View of a page to explore, as text and as data."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rocking_cli.names import peaks_over
from rocking_cli.studies.response import concluded
from rocking_cli.views.conclusion import headline
from rocking_cli.views.response import ending
from rocking_cli.views.view import View

if TYPE_CHECKING:
    from rocking_cli.questions.explore.study import Exploration


def view(offered: Exploration) -> View:
    """Show what the page shows first."""
    motion = offered.given.motion
    data = {
        "record": motion.name,
        "structures": [
            {"name": each.name, "outcome": ending(run), "peak_ratio": run.peak_ratio}
            for each, run in zip(offered.structures, offered.histories, strict=True)
        ],
        "neighbours": offered.around.count,
        "file": offered.file,
    }
    return View(data, first_shown(offered))


def first_shown(offered: Exploration) -> list[str]:
    """Return what each structure does under the motion as given, in sentences."""
    return [
        f"{each.name}, under {offered.given.motion.name}: "
        f"{headline(concluded({1: {'nonlinear': run}}, {}), peaks_over(run.ends_at_limit))}."
        for each, run in zip(offered.structures, offered.histories, strict=True)
    ]
