"""`rk.fragility`."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking_cli.ask.answer import Answer
from rocking_cli.ask.given import yaml_of
from rocking_cli.core import Mechanism
from rocking_cli.io.json_text import json_text

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rocking_cli.io.tables import Columns
    from rocking_cli.studies.fragility.assess import Fragility


def fragility(
    study: str | Path | Mapping[str, Any],
    *,
    store: str | Path | None = None,
    threads: int | None = None,
    rank_measures: bool = False,
) -> Answer[list[Fragility]]:
    """Run a fragility study, or continue it, and fit its curves.

    Parameters
    ----------
    study : str, Path or mapping
        YAML file of the study, or its fields in Python, in which structures may be mechanisms; docs/fragility.md lists
        the fields. A study given in Python is written to files next to the store, so that it can be run again.
    store : str or Path, optional
        File in which the runs are stored; by default next to the study file, or study.db in this folder.
    threads : int, optional
        Number of time histories at a time; by default, one for each processor.
    rank_measures : bool
        Whether to rank the intensity measures as well, by how well they predict the outcome.

    Returns
    -------
    Answer of list of Fragility
        One per curve: structure, limit state, measure and fit. If the outcome of some runs is unknown, as a joint opens
        that the model keeps closed, these exceed the limit in the fit and do not in its `lower`.

    Raises
    ------
    InputError
        If the study, a file or the store cannot be used; runs that fail are counted in the store, not raised.
    MechanismError
        If the structure has no critical rotation or no uplift acceleration.

    Notes
    -----
    The runs are those of `respond`, Eq. 8 or 16 of DeJong and Dimitrakopoulos (2014); docs/fragility.md explains how
    the curves are fitted.
    """
    from rocking_cli.studies.fragility import assess, campaign, table, workers
    from rocking_cli.studies.fragility.definition import Definition
    from rocking_cli.studies.fragility.hazard_curve import HazardCurve
    from rocking_cli.studies.fragility.intensity import label
    from rocking_cli.studies.fragility.quantiles import all_quantiles
    from rocking_cli.studies.fragility.store import Store
    from rocking_cli.studies.fragility.study import load_study
    from rocking_cli.views.fragility import limit_name, view
    from rocking_cli.views.quantiles import with_quantiles

    if isinstance(study, Mapping):
        place = Path(store or "study.db")
        study = _written(study, place)
    else:
        place = Path(store) if store is not None else Path(study).with_suffix(".db")
    asked = load_study(study)
    with Store.writing(place, anew=False, say=lambda text: None) as kept:
        prepared = campaign.prepare(asked, kept, rank_measures=rank_measures)
        with workers.threads(threads) as hands:
            campaign.run(prepared, kept, hands)
    with Store.reading(place) as kept:
        plan, definition = kept.plan(), Definition.model_validate(kept.fact("definition"))
        points = kept.fact("hazard")
        hazard = HazardCurve(*np.array(points)) if points is not None else None
        counted = assess.counted(kept, plan, definition, lambda count: None)
        curves, surfaces = assess.fitted(counted, definition, hazard, lambda count: None)
        shown = view(kept, plan, definition, *kept.count(), curves, surfaces, assess.outcomes(counted))
        shown = with_quantiles(shown, list(all_quantiles(kept, plan, definition)), in_words=False)
        if rank_measures:
            from rocking_cli.studies.fragility.ranking import rank
            from rocking_cli.views.ranking import added

            shown = added(shown, rank(kept, plan, definition))
        blocks = list(table.blocks(kept, plan, definition.asked_measures))

    def columns() -> Columns:
        return {name: [value for block in blocks for value in block[name]] for name in blocks[0]}

    def figure() -> Figure:
        from rocking_cli.plotting.fragility import LabelledCurve, draw_curves

        measure = definition.fitted_measures[0]
        lines = [
            LabelledCurve.of(f"{each.structure}, {limit_name(each.limit)}", each)
            for each in curves
            if each.measure == measure
        ]
        return draw_curves(lines, label(measure), "")

    return Answer("fragility", curves, shown, columns, figure)


def _written(study: Mapping[str, Any], store: Path) -> Path:
    """Write a study given in Python and its mechanisms to files next to the store, named after it."""
    from rocking_cli.io.files import write_whole

    def write(path: Path, text: str) -> Path:
        write_whole(path, lambda stream: stream.write(text.encode()))
        return path

    structures: list[object] = []
    for k, each in enumerate(study.get("structures", []), start=1):
        if isinstance(each, Mechanism):
            file = write(store.with_name(f"{store.stem}-{k}.yaml"), yaml_of(each))
            structures.append({"file": file.name, "name": each.name or each.mechanism})
        else:
            structures.append(str(each) if isinstance(each, Path) else each)
    records = [str(each) if isinstance(each, Path) else each for each in study.get("records", [])]
    text = json_text({**study, "structures": structures, "records": records})
    return write(store.with_suffix(".yaml"), text + "\n")
