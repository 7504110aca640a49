"""Show, draw and write the contents of the store of a fragility study."""

from __future__ import annotations

import re
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from rocking_cli.cli import terminal
from rocking_cli.cli.written import save, write_table
from rocking_cli.text import numbered

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rocking_cli.ask.results import StudyAnswer
    from rocking_cli.studies.fragility.assess import Fragility
    from rocking_cli.studies.fragility.ranking import Ranking


@dataclass(frozen=True)
class CurveOutput:
    """Additional outputs of curves: plots, and a file for OpenQuake."""

    plot: str | None
    nrml: Path | None


@dataclass(frozen=True)
class Tables:
    """Files of the tables of runs and of curves."""

    out: Path | None = None
    curves: Path | None = None


def show_study(answer: StudyAnswer, shown: CurveOutput, tables: Tables = Tables(), *, as_json: bool) -> bool:
    """Show what a study found, write its runs and curves and draw them; return whether it is complete."""
    if tables.out is not None:
        assert answer.blocks is not None
        write_table(tables.out, answer.blocks())
    if tables.curves is not None:
        _write_curves(tables.curves, answer.result)
    if shown.plot is not None:
        draw_all(Path(shown.plot), answer)
        if answer.rankings:
            draw_rankings(Path(shown.plot), answer.rankings)
    terminal.show(answer.view, as_json=as_json)
    if shown.nrml is not None:  # last: curves that OpenQuake cannot read have been shown
        _write_nrml(shown.nrml, answer)
    if answer.failed:
        terminal.error(f"{answer.failed} runs could not be simulated and are left out of the curves")
    return answer.complete


def _write_curves(out: Path, curves: Sequence[Fragility]) -> None:
    from rocking_cli.views.fragility import edges
    from rocking_cli.views.fragility_table import blocks

    for each in curves:
        for name, fit in edges([each]):
            if fit.curve.kind == "none":
                terminal.warning(f"{each.structure}, {name} against {each.measure}: no curve: {fit.curve.why}")
    write_table(out, blocks(curves))


def _write_nrml(out: Path, answer: StudyAnswer) -> None:
    """Write the curves that OpenQuake can read, and name the others."""
    from rocking_cli.io.files import write_whole
    from rocking_cli.studies.fragility.openquake import chosen
    from rocking_cli.studies.fragility.store import Store
    from rocking_cli.views.nrml import nrml

    model = chosen(answer.result)
    for each in model.left_out:
        terminal.warning(f"not in {out}: {each}")
    for each in model.doubts:
        terminal.warning(each)
    with Store.reading(answer.store) as store:
        version, study, name = store.fact("versions")["rocking-cli"], store.fact("hash"), store.fact("name")
    document = nrml(model, name, f"{answer.sentences[0]}; rocking-cli {version}, study {study[:12]}")
    write_whole(out, lambda stream: stream.write(document))
    terminal.note(f"wrote {out}")


def draw_all(folder: Path, answer: StudyAnswer) -> None:
    """Draw the curves of each structure, the comparison of structures, the data behind them, and surfaces."""
    from rocking_cli.plotting import fragility as plotting
    from rocking_cli.plotting.quantiles import draw_quantiles
    from rocking_cli.studies.fragility.intensity import label
    from rocking_cli.views.fragility import limit_name

    definition, curves = answer.definition, answer.result
    drawn: dict[str, Figure] = {}

    def add(name: str, figure: Figure) -> None:
        drawn[_file(name, drawn)] = figure

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
    with terminal.progress(len(drawn), "pictures") as advance:
        for file, figure in drawn.items():
            save(folder / file, figure)
            advance(1)
    terminal.note(f"wrote {len(drawn)} plots to {folder}")


def _file(name: str, taken: Collection[str]) -> str:
    """Return the file of a plot, after its name."""
    return numbered(re.sub(r"[^\w>.]+", "-", name).strip("-").replace(">", "over"), ".png", taken)


def draw_rankings(folder: Path, rankings: Sequence[Ranking]) -> None:
    """Draw the ranking of measures, one plot for each structure."""
    from rocking_cli.plotting.ranking import draw_ranking

    drawn: dict[str, Ranking] = {}
    for each in rankings:
        if each.measures:
            drawn[_file(f"{each.structure} which measure serves", drawn)] = each
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
