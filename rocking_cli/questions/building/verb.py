"""`rk.building`: verify all out-of-plane mechanisms of a building."""

from __future__ import annotations

import os
from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rocking_cli.ask.answer import Answer, drawn
from rocking_cli.ask.inputs import language_of, site_of
from rocking_cli.ask.verbs import verb, write_files
from rocking_cli.ask.watcher import Watcher
from rocking_cli.errors import InputError, Problem, RockingError, named
from rocking_cli.questions.building.asked import BuildingAsked

if TYPE_CHECKING:
    from rocking_cli.questions.building.description import Building
    from rocking_cli.questions.building.study import Assessed
    from rocking_cli.verification.results import Histories

TABLES = (".csv", ".xlsx", ".xls", ".ods")
MIN_WALLS_FOR_PROCESSES = 4  # from which processes pay


@verb(BuildingAsked)
def building(asked: BuildingAsked, watch: Watcher) -> Answer[Assessed]:
    """Verify all out-of-plane mechanisms of a building by a code, and name the one that governs.

    Returns
    -------
    Answer of Assessed
        `rows` are the mechanisms with their verifications, the worst first; `left_out` those that were not verified.

    Raises
    ------
    InputError
        If the building, its site or a motion cannot be used, no mechanism can be verified, or a file cannot be written.
    SolverError
        If a motion cannot be simulated to its end.

    Notes
    -----
    The mechanisms are those of DeJong and Dimitrakopoulos (2014), Sections 2 to 4, under loads and ties.

    Examples
    --------
    >>> import rocking_cli as rk
    >>> site = {"FC": 1.35, "ag": 0.2, "F0": 2.5, "TC": 0.4, "S": 1.2}
    >>> walls = [{"name": "front", "length": 8.0, "thickness": 0.6}]
    >>> house = {"levels": [0.0, 4.0, 8.0], "masonry": {"density": 1800.0}, "walls": walls}
    >>> answer = rk.building(house, site=site)
    >>> answer.governs.made.name
    'front: overturning about 0 m'
    """
    from rocking_cli.core.hung.ties import BAR_DIAMETERS
    from rocking_cli.questions.building.description import one_sided_toothing
    from rocking_cli.questions.building.study import NoMechanism, assess, bars_of_level, compared, shaken
    from rocking_cli.questions.building.view import columns, reasons, view, words
    from rocking_cli.verification.check import refuse

    given, folder = _read(asked.building, watch)
    site = _site(asked, given, folder)
    language = language_of(asked.language or given.language, site, watch)
    for one, side in one_sided_toothing(given):
        watch.warn(
            f"{one} interlocks with {side}, but {side} has no `connection: interlock`: it overturns free of {one}"
        )
    if given.T1 is not None and getattr(site.site, "floor", None) is not None:
        watch.warn("T1 of the building is not used: the `floor` of the site has the period of the building")
    say, requested = words(language), asked.requested
    refuse(site, motions=bool(requested))
    if asked.sheet is not None:
        from rocking_cli.questions.verify import sheets

        sheets.check(asked.sheet, site, language)
    other = None if asked.strengthened is None else _read(asked.strengthened, watch)[0]
    count = len(given.walls) + 1
    processes = asked.jobs or min(os.cpu_count() or 1, count)
    alone = not asked.in_processes or processes < 2 or count <= MIN_WALLS_FOR_PROCESSES
    examined = partial(assess, site=site, processes=None if alone else processes)
    try:
        with watch.progress(count * (1 if other is None else 2), "walls") as advance:
            result = examined(given, progress=advance)
            after = None if other is None else examined(other, progress=advance)
    except NoMechanism as error:
        why = reasons(error.args[0], words("en")).items()
        raise InputError(*(Problem(f"{', '.join(names)}: {reason}") for reason, names in why)) from None
    if requested:
        with watch.progress(asked.worst * (1 if after is None else 2), "mechanisms under motions"):
            result = shaken(result, asked.worst, _histories(asked, result, watch))
            after = after and shaken(after, asked.worst, _histories(asked, after, watch))
    result = result if after is None else compared(result, after)
    designed = None
    if asked.design is not None:
        with watch.progress(len(BAR_DIAMETERS), "diameters") as advance:
            designed = bars_of_level(result, asked.design, advance)
    figure = drawn("questions.building.picture.draw_building", result, say)
    answer = Answer("building", result, view(result, designed, say), partial(columns, result, say), figure)
    write_files(answer, asked, watch)
    try:
        if asked.sheet is not None:
            from rocking_cli.questions.building.pages import write_sheet

            write_sheet(asked, result, designed, language, watch)
        if asked.structures is not None:  # last: a folder that is there is refused by the next run
            _write_structures(asked.structures, result, watch)
    except RockingError as error:
        watch.unwritten(error)
    return answer


def _read(given: Any, watch: Watcher) -> tuple[Building, Path]:
    """Return a building, and the folder of the files that it names."""
    from rocking_cli.io.json_text import json_text
    from rocking_cli.io.yaml_file import parse
    from rocking_cli.questions.building.description import HINT, building_of, read_building

    if isinstance(given, Mapping):
        document = parse(json_text(given), "building", "building", HINT)
        return building_of(document), Path()
    path = Path(given)
    if path.suffix.lower() not in TABLES:
        return read_building(path), path.parent
    from rocking_cli.io.spreadsheet import read_sheet
    from rocking_cli.questions.building.walls import USUAL_DENSITY, building_in

    fields = building_in(read_sheet(path))
    if fields["masonry"]["density"] == USUAL_DENSITY:
        watch.warn(f"{path} has no column density: {USUAL_DENSITY} is assumed of all walls")
    document = parse(json_text(fields), str(path), "building", HINT)
    return building_of(document), path.parent


def _site(asked: BuildingAsked, given: Building, folder: Path) -> Any:
    if asked.site is not None:
        return site_of(asked.site)
    if given.site is None:
        hint = f"give {named('site')}, or `site` in the building; `rocking new site` prints one"
        raise InputError(Problem("is missing: the mechanisms are verified at a site", field="site", hint=hint))
    return site_of(given.site if isinstance(given.site, dict) else folder / given.site)


def _histories(asked: BuildingAsked, found: Assessed, watch: Watcher) -> dict[str | None, Histories]:
    """Return the records of each limit state, read for the structure that rotates fastest."""
    from rocking_cli.verification.results import Histories

    growth = max(each.structure.growth for each in found.rows[: asked.worst])
    sets = {}
    for key, each in asked.requested.items():
        records = each.gather(growth, watch)
        sets[key] = Histories(records, asked.signs, key, asked.on_floor, refused=each.refused(records))
    return sets


def _write_structures(folder: Path, found: Assessed, watch: Watcher) -> None:
    """Write each mechanism as a structure file with the site at its height, and a table of all."""
    import io

    from rocking_cli.io.files import write_folder
    from rocking_cli.io.tables import write_csv
    from rocking_cli.questions.building.view import file_of, site_file

    texts, table = dict[str, bytes](), {"file": list[str](), "site": list[str]()}
    for rank, each in enumerate(found.rows, 1):
        word = "".join(sign if sign.isalnum() else "_" for sign in each.made.name).strip("_")
        file = f"{rank:03d}_{word[:60]}.yaml"
        site = f"site_{each.made.z:.3f}_m.yaml"
        texts[file] = file_of(each).encode()
        texts.setdefault(site, site_file(found, each.made.z).encode())
        table["file"].append(file)
        table["site"].append(site)
    write_csv(stream := io.BytesIO(), [table])
    texts["mechanisms.csv"] = stream.getvalue()
    write_folder(folder, texts)
    watch.note(f"wrote {len(found.rows)} structures into {folder}: `rocking survey {folder}/mechanisms.csv` reads them")
