"""Keep what the commands print for the shipped examples, compare two such states, and write the keys of all JSON.

    python scripts/outputs.py keep FOLDER           # run all commands with the program that this Python imports
    python scripts/outputs.py compare BEFORE AFTER  # exit code 1 if anything but sentences differs
    python scripts/outputs.py keys FOLDER           # write tests/json_keys.txt from what was kept

To keep the outputs of another commit, check it out beside this one and put it first on PYTHONPATH. Compared are exit
codes, keys, numbers, truth values and nulls of the JSON, and the heads and numbers of written tables; sentences that
differ are listed, they do not count.
"""

from __future__ import annotations

import csv
import json
import os
import shlex
import shutil
import sys
from collections.abc import Iterator
from contextlib import chdir
from pathlib import Path
from typing import Any

import yaml
from click.testing import CliRunner

PROJECT = Path(__file__).resolve().parent.parent
STRUCTURES = sorted(
    file.relative_to(PROJECT).as_posix()
    for folder in ("", "linkages", "masonry", "walls")
    for file in (PROJECT / "examples" / folder).glob("*.yaml")
)
ACCEL = "--record examples/accel.csv"
SITE = "--site examples/verify/site.yaml"
SETS = "--set SLV=examples/accel.csv --set SLC=examples/accel_transverse.csv --target-pga 0.1"
OF_EACH = (
    "equiv {0} --json",
    "equiv {0}",
    "draw {0} --plot draw.png --json",
    "error {0} --at 0.5 --a 2 --json",
    f"respond {{0}} {ACCEL} --engine exact --json --out history.csv",
    f"respond {{0}} {ACCEL} --scale 2 --polarity both --engine exact",
    f"margin {{0}} {ACCEL} --json",
    f"verify {{0}} {SITE} --json --sheet sheet.html",
    f"verify {{0}} {SITE} {ACCEL} --json",
    "collapse {0} --json",
)
"""Commands run for every example of a structure."""

ONCE = (
    f"margin examples/frame.yaml {ACCEL}",
    f"verify examples/verify/facade.yaml {SITE}",
    f"verify examples/verify/facade.yaml {SITE} --json",
    f"verify examples/verify/facade.yaml {SITE} {ACCEL} --json",
    f"verify examples/verify/facade.yaml {SITE} {SETS} --json --sheet sets.html",
    f"survey examples/survey/parapets.csv {ACCEL} --json --out survey.csv",
    f"survey examples/survey/parapets.csv {SITE} --json",
    'design examples/block.yaml --vary width=0.3m:1m --until "lambda >= 0.3" --json',
    f'design examples/block.yaml --vary width=0.3m:1m {ACCEL} --until "peak_ratio < 0.3" --json',
    "demand examples/verify/site.yaml",
    "demand examples/verify/site.yaml --json --out demand.csv",
    "record examples/accel.csv --json",
    "record examples/accel.csv --trim 1:11 --highpass 0.3 --lowpass 15 --json --out corrected.csv",
    "record examples/accel.csv --fit-pulse --measures all --json",
    "respond examples/frame.yaml --pulse ricker:0.4g:1.2s --json",
    f"respond examples/frame.yaml {ACCEL} --with examples/accel_transverse.csv --azimuth all --json",
    f"respond examples/block.yaml {ACCEL} --floor T1=0.4,xi=0.05,z/H=0.67,gamma=1.29 --json",
    f"respond examples/block.yaml {ACCEL} --release 0.05 --json",
    "calibrate examples/calibrate/block.yaml --free examples/calibrate/trace.csv --json -o measured.yaml",
    "calibrate examples/calibrate/block.yaml --free examples/calibrate/trace.csv",
    "pulse --a 2 --omega 3 --json",
    "pulse --a 4 --omega 6",
    "overturning examples/block.yaml --json",
    "overturning examples/masonry/buttressed_arch.yaml --json",
    "overturning --compare examples/block.yaml examples/frame.yaml examples/wall.yaml --json",
    "equivalent_pulses examples/block.yaml examples/frame.yaml --ag 0.6g --period 0.5 --json",
    f"spectrum examples/block.yaml {ACCEL} --slenderness 0.2,0.3 --json",
    f"spectrum examples/masonry/portal.yaml {ACCEL} --json",
    "fragility examples/study/pedestal.yaml --restart --json",
    "results examples/study/pedestal.runs --json",
    f"report examples/frame.yaml {ACCEL} -o report.html --json",
    "mechanisms --json",
    "measures --json",
    "new site",
    "new study",
)

FOR_KEYS = (
    "info --json",
    "selfcheck --quick --json",
    "completion bash --json",
    "new block --json",
    "respond examples/masonry/portal.yaml --pulse sine:0.6g:0.2s --engine blocks --json",
    "respond examples/cone.yaml --pulse sine:0.3g:0.3s --engine blocks --3d --json",
    f"survey examples/survey/collection.csv {ACCEL} --json --remedies all --3d",
    "animate examples/block.yaml --pulse ricker:0.4g:1s --out moving.html --json",
    "select examples/accel.csv --target examples/target.csv --count 1 --band 0.2:2 --json",
    "overturning examples/block.yaml --points 5 --json",
    "overturning --compare examples/block.yaml examples/frame.yaml examples/wall.yaml --points 3 --json",
    "report examples/frame.yaml --json",
    "explore examples/block.yaml --pulse ricker:0.4g:1s --out page.html --json",
    "building examples/building/tied_house.yaml --strengthened examples/building/house.yaml --json",
    "building examples/building/tied_house.yaml --design 2 --json",
    "new building --json",
    "import examples/drawings/church.dxf --merge-gap 12mm --depth 1 --density 2000 --json",
)
"""Commands of which only the keys are held: their values depend on the machine, or others have the like."""

NAMES = ("answers", "cells", "levels", "libraries", "measures", "points", "polarities", "ties", "versions")
"""Keys of objects whose own keys are names."""
GIVEN = ("default", "environment", "example")
"""Keys of values that have the form of what is described, or of the machine."""
INDENT = "  "
KEYS = PROJECT / "tests" / "json_keys.txt"


def commands() -> list[str]:
    """Return all commands to run, those that fail on purpose among them."""
    starters = ("facade", "parapet", "gable", "pinnacle", "corner", "bell_cell", "column_with_tendon", "statue")
    names = mechanisms()
    return [
        *(command.format(file) for file in STRUCTURES for command in OF_EACH),
        *ONCE,
        *FOR_KEYS,
        *(f"new {name}" for name in (*starters, *names)),
        *(f"mechanisms {name} --json" for name in names),
    ]


def mechanisms() -> list[str]:
    """Return the names of the files of mechanisms."""
    return [file.stem for file in sorted((PROJECT / "mechanisms").glob("*.py")) if not file.stem.startswith("_")]


def questions() -> dict[str, list[str]]:
    """Return the commands that print JSON, and the examples that each is asked of, `""` if it names its own."""
    asked = {command: STRUCTURES for command in OF_EACH if "--json" in command}
    asked["mechanisms {0} --json"] = mechanisms()
    return asked | {command: [""] for command in (*ONCE, *FOR_KEYS) if "--json" in command}


def key_paths(data: dict[str, Any], parents: tuple[str, ...] = ()) -> Iterator[tuple[str, ...]]:
    """Yield each key below its parents, with `[]` if it has a list; `*` stands for names.

    >>> list(key_paths({"motions": [{"name": "a"}], "points": {"top": {"at": [1, 2]}}}))
    [('motions[]',), ('motions[]', 'name'), ('points',), ('points', '*'), ('points', '*', 'at[]')]
    """
    for key, value in data.items():
        name, values = "*" if parents[-1:] and parents[-1] in NAMES else key, [value]
        while any(isinstance(each, list) for each in values):
            name += "[]"
            values = [item for each in values if isinstance(each, list) for item in each]
        yield (*parents, name)
        for each in values:
            if isinstance(each, dict) and key not in GIVEN:
                yield from key_paths(each, (*parents, name))


def keys_of(out: str) -> set[tuple[str, ...]]:
    """Return all keys in the JSON that a command printed, an object a line."""
    return {path for line in out.splitlines() for path in key_paths(json.loads(line))}


def write_keys(folder: Path) -> None:
    """Write the keys of the JSON of all commands as trees, each with one example that has it if not all have."""
    kept = json.loads((folder / "outputs.json").read_text(encoding="utf-8"))
    lines = []
    for command, examples in questions().items():
        having: dict[tuple[str, ...], list[str]] = {}
        for example in examples:
            for path in keys_of(kept[command.format(example)]["out"]):
                having.setdefault(path, []).append(example)
        lines.append(command)
        for path in sorted(having):
            some = having[path]
            shown = "" if some == having.get(path[:-1], examples) else f"  {min(some, key=len)}"
            lines.append(f"{INDENT * len(path)}{path[-1]}{shown}")
    KEYS.write_text("\n".join(lines) + "\n", encoding="utf-8")


def held_keys() -> dict[str, dict[tuple[str, ...], str]]:
    """Return the keys that the file holds of each command, with the example that is named for one; empty for all."""
    held: dict[str, dict[tuple[str, ...], str]] = {}
    path: tuple[str, ...] = ()
    for line in KEYS.read_text(encoding="utf-8").splitlines():
        name, _, example = line.strip().partition("  ")
        depth = (len(line) - len(line.lstrip())) // len(INDENT)
        if depth == 0:
            of_command = held.setdefault(line, {})
            continue
        path = (*path[: depth - 1], name)
        of_command[path] = example
    return held


def keep(folder: Path) -> None:
    """Run all commands in an empty folder, and write what each gave to `outputs.json` there."""
    from rocking_cli.cli.main import main  # of the program under trial, which PYTHONPATH names

    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(PROJECT / "examples", folder / "examples")
    kept = {}
    with chdir(folder):
        for command in commands():
            there = set(Path().rglob("*"))
            arguments = shlex.split(command)
            done = CliRunner().invoke(main, arguments, env={"COLUMNS": "100", "SOURCE_DATE_EPOCH": "0"})
            made = {
                file.name: file.read_text(encoding="utf-8")
                for file in sorted(set(Path().rglob("*")) - there)
                if file.suffix in (".csv", ".json")
            }
            kept[command] = {"exit": done.exit_code, "out": done.stdout, "err": done.stderr, "files": made}
            for name in ("history.csv", "sheet.html", "draw.png", "survey.csv", "corrected.csv", "report.html"):
                Path(name).unlink(missing_ok=True)
            print(done.exit_code, command, file=sys.stderr)
    (folder / "outputs.json").write_text(json.dumps(kept, indent=1), encoding="utf-8")


def compare(before: Path, after: Path) -> int:
    """Print what differs, sentences apart from the rest; return 1 if anything but a sentence does."""
    one, other = (json.loads((folder / "outputs.json").read_text(encoding="utf-8")) for folder in (before, after))
    wrong: list[str] = []
    sentences: dict[tuple[str, str], str] = {}
    for command in sorted({*one, *other}):
        if command in FOR_KEYS:
            continue
        if command not in one or command not in other:
            wrong.append(f"{command}: only {'before' if command in one else 'after'}")
            continue
        for place, a, b in differences(parsed(command, one[command]), parsed(command, other[command])):
            if isinstance(a, str) and isinstance(b, str):
                sentences.setdefault((a, b), f"{command} {place}")
            else:
                wrong.append(f"{command} {place}: {a!r} -> {b!r}")
    for (a, b), place in sentences.items():
        print(f"{place}\n  - {a.strip()}\n  + {b.strip()}")
    print(f"{len(one)} commands; {len(sentences)} sentences differ, {len(wrong)} other differences")
    print(*wrong, sep="\n")
    return 1 if wrong else 0


def parsed(command: str, done: dict[str, Any]) -> dict[str, Any]:
    """Return what a command gave as data: JSON and YAML read, tables as rows of numbers and words."""
    if "--json" in command:
        out: Any = [json.loads(line) for line in done["out"].splitlines()]
    elif command.startswith("new "):
        out = yaml.safe_load(done["out"])
    else:
        out = done["out"]
    files = {name: cells(text) if name.endswith(".csv") else json.loads(text) for name, text in done["files"].items()}
    return {"exit": done["exit"], "out": out, "err": done["err"], "files": files}


def cells(text: str) -> list[list[float | str]]:
    """Return the cells of a table; those of its head are keys, so each is a number or a list of one word."""
    return [[number_or_word(cell) for cell in row] for row in csv.reader(text.splitlines()) if row[:1] != ["#"]]


def number_or_word(cell: str) -> float | str:
    """Return a cell as a number if it is one."""
    try:
        return float(cell)
    except ValueError:
        return cell


def differences(one: Any, other: Any, place: str = "") -> Iterator[tuple[str, Any, Any]]:
    """Yield place and both values of whatever differs."""
    if isinstance(one, dict) and isinstance(other, dict):
        if one.keys() != other.keys():
            yield f"{place} keys", sorted(one.keys() - other.keys()), sorted(other.keys() - one.keys())
        for key in one.keys() & other.keys():
            yield from differences(one[key], other[key], f"{place}.{key}")
    elif isinstance(one, list) and isinstance(other, list):
        if len(one) != len(other):
            yield f"{place} length", one, other
        for k, (a, b) in enumerate(zip(one, other, strict=False)):
            yield from differences(a, b, f"{place}[{k}]")
    elif type(one) is not type(other) or (one != other and one == one):
        yield place, one, other


if __name__ == "__main__":
    os.environ.setdefault("MPLBACKEND", "Agg")
    what, *folders = sys.argv[1:]
    if what == "keep":
        keep(Path(folders[0]).resolve())
    elif what == "keys":
        write_keys(Path(folders[0]))
    else:
        sys.exit(compare(*map(Path, folders)))
