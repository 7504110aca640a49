"""Show, draw and write the contents of the store of a fragility study."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from rocking_cli.cli import table_files, terminal

if TYPE_CHECKING:
    from rocking_cli.ask.results import StudyAnswer
    from rocking_cli.studies.fragility.assess import Fragility


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
        table_files.write(tables.out, answer.blocks())
    if tables.curves is not None:
        _write_curves(tables.curves, answer.result)
    if shown.plot is not None:
        from rocking_cli.cli.study_pictures import draw_all, draw_rankings

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
    table_files.write(out, blocks(curves))


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
