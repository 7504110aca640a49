"""Plots of a fragility study, one file each in a folder."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from itertools import count
from pathlib import Path
from typing import TYPE_CHECKING

from rocking_cli.cli import terminal

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rocking_cli.ask.results import StudyAnswer
    from rocking_cli.studies.fragility.ranking import Ranking


def draw_all(folder: Path, answer: StudyAnswer) -> None:
    """Draw the curves of each structure, the comparison of structures, the data behind them, and surfaces."""
    from rocking_cli.plotting import fragility as plotting
    from rocking_cli.plotting.quantiles import draw_quantiles
    from rocking_cli.studies.fragility.intensity import label
    from rocking_cli.views.fragility import limit_name

    definition, curves = answer.definition, answer.result
    drawn: dict[str, Figure] = {}

    def add(name: str, figure: Figure) -> None:
        plain = re.sub(r"[^\w>.]+", "-", name).strip("-").replace(">", "over")
        taken = {each.lower() for each in drawn}  # many file systems are blind to case
        numbered = (f"{plain}{'-' + str(k) if k > 1 else ''}.png" for k in count(1))
        drawn[next(each for each in numbered if each.lower() not in taken)] = figure

    structures = list(dict.fromkeys(each.structure for each in curves))
    for measure in definition.fitted_measures:
        these = [each for each in curves if each.measure == measure]
        for structure in structures:
            own = [each for each in these if each.structure == structure]
            lines = [plotting.LabelledCurve.of(limit_name(each.limit), each) for each in own]
            add(f"{structure} {measure}", plotting.draw_curves(lines, label(measure), structure))
        for limit in definition.limit_states if len(structures) > 1 else []:
            own = [each for each in these if each.limit == limit]
            lines = [plotting.LabelledCurve.of(each.structure, each) for each in own]
            add(f"{limit_name(limit)} {measure}", plotting.draw_curves(lines, label(measure), limit_name(limit)))
    if definition.method == "ida":
        for structure in structures:
            add(f"{structure} ida", _increments(answer, structure))
    for found in answer.quantiles:
        add(f"{found.structure} {found.measure} quantiles", draw_quantiles(found, label(found.measure)))
    for each in answer.surfaces:
        name = f"{each.structure}, {limit_name(each.limit)}"
        one, other = each.measures
        figure = plotting.draw_surface(each, (label(one), label(other)), name)
        add(f"{name} {one} {other}", figure)
    _save(folder, drawn)


def _save(folder: Path, drawn: Mapping[str, Figure]) -> None:
    """Write figures to a folder, by their file names."""
    from rocking_cli.cli.pictures import save

    with terminal.progress(len(drawn), "pictures") as advance:
        for file, figure in drawn.items():
            save(folder / file, figure)
            advance(1)
    terminal.note(f"wrote {len(drawn)} plots to {folder}")


def draw_rankings(folder: Path, rankings: Sequence[Ranking]) -> None:
    """Draw the ranking of measures, one plot for each structure."""
    from rocking_cli.cli.pictures import save
    from rocking_cli.plotting.ranking import draw_ranking

    drawn: dict[str, Ranking] = {}
    for each in rankings:
        if each.measures:
            plain = re.sub(r"[^\w>.]+", "-", f"{each.structure} which measure serves").strip("-")
            names = (f"{plain}{'-' + str(k) if k > 1 else ''}.png" for k in count(1))
            taken = {name.lower() for name in drawn}  # many file systems are blind to case
            drawn[next(name for name in names if name.lower() not in taken)] = each
    for file, ranking in drawn.items():
        save(folder / file, draw_ranking(ranking))
    terminal.note(f"wrote {len(drawn)} picture{'s' * (len(drawn) != 1)} of measures to {folder}")


def _increments(answer: StudyAnswer, structure: str) -> Figure:
    import numpy as np

    from rocking_cli.plotting.fragility import draw_ida
    from rocking_cli.studies.fragility.definition import SCALE
    from rocking_cli.studies.fragility.intensity import label
    from rocking_cli.studies.fragility.store import Store
    from rocking_cli.studies.fragility.tally import peaks

    measure = answer.definition.levels.measure
    across = "factor on the records" if measure == SCALE else label(measure)
    with Store.reading(answer.store) as store:
        plan = answer.plan
        usable = [k for k, each in enumerate(plan.records) if each.reason is None]
        records = np.unique(plan.of_sets.one[usable]).size
        return draw_ida(np.array(plan.levels), peaks(store, plan, structure), across, structure, records)
