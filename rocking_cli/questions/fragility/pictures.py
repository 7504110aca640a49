"""Draw all that the store of a fragility study holds: a picture of each curve, surface and ranking."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rocking_cli.ask.watcher import Watcher
from rocking_cli.text import numbered

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def draw_all(folder: Path, answer: Any, watch: Watcher) -> None:
    """Draw the curves of each structure, the comparison of structures, the data behind them, surfaces and rankings."""
    from rocking_cli.plotting.style import plain, write
    from rocking_cli.questions.fragility.picture import LabelledCurve, draw_curves, draw_surface, limit_in_picture
    from rocking_cli.questions.fragility.quantiles_picture import draw_quantiles
    from rocking_cli.questions.fragility.ranking_picture import draw_ranking
    from rocking_cli.questions.fragility.view import limit_name
    from rocking_cli.studies.fragility.quantities import label

    definition, curves = answer.definition, answer.result
    drawn: dict[str, Figure] = {}

    def add(name: str, figure: Figure) -> None:
        drawn[numbered(re.sub(r"[^\w>.]+", "-", name).strip("-").replace(">", "over"), ".png", drawn)] = figure

    structures = list(dict.fromkeys(each.structure for each in curves))
    for measure in definition.fitted_measures:
        these = [each for each in curves if each.measure == measure]
        for structure in structures:
            of_structure = [each for each in these if each.structure == structure]
            lines = [LabelledCurve.of(limit_in_picture(each.limit, math=True), each) for each in of_structure]
            add(f"{structure} {measure}", draw_curves(lines, label(measure), structure))
        for limit in definition.limit_states if len(structures) > 1 else []:
            lines = [LabelledCurve.of(plain(each.structure), each) for each in these if each.limit == limit]
            title = limit_in_picture(limit, math=False)
            add(f"{limit_name(limit)} {measure}", draw_curves(lines, label(measure), title))
    if definition.method == "ida":
        for structure in structures:
            add(f"{structure} ida", _increments(answer, structure))
    for quantiles in answer.quantiles:
        add(f"{quantiles.structure} {quantiles.measure} quantiles", draw_quantiles(quantiles, label(quantiles.measure)))
    for surface in answer.surfaces:
        one, other = surface.measures
        title = f"{surface.structure}, {limit_in_picture(surface.limit, math=False)}"
        name = f"{surface.structure}, {limit_name(surface.limit)} {one} {other}"
        add(name, draw_surface(surface, (label(one), label(other)), title))
    for ranking in answer.rankings:
        if ranking.measures:
            add(f"{ranking.structure} which measure serves", draw_ranking(ranking))
    with watch.progress(len(drawn), "pictures") as advance:
        for file, figure in drawn.items():
            write(folder / file, figure)
            advance(1)
    watch.note(f"wrote {len(drawn)} plots to {folder}")


def _increments(answer: Any, structure: str) -> Figure:
    import numpy as np

    from rocking_cli.questions.fragility.definition import SCALE
    from rocking_cli.questions.fragility.picture import draw_ida
    from rocking_cli.questions.fragility.store import Store
    from rocking_cli.questions.fragility.tally import peaks, samples_of
    from rocking_cli.studies.fragility.quantities import label

    plan, measure = answer.plan, answer.definition.levels.measure
    across = "factor on the records" if measure == SCALE else label(measure)
    usable = [k for k, each in enumerate(plan.records) if each.reason is None]
    table = peaks(Store.reading(answer.store), plan, structure)
    records, ladders = np.unique(plan.of_sets.one[usable]).size, len(samples_of(plan, structure)) * plan.block
    named = [plan.records[k].name for k in usable] if ladders == len(plan.levels) else []
    return draw_ida(np.array(plan.levels), table, across, structure, records, named)
