"""Every field of every file that is handed out, spoilt: an answer or a message with its place, never a traceback.

A sample in the suite, always the same; `make fields` tries every field in every way, and `PAIRS=1000` as many pairs.
"""

import copy
import os
import random
import re
import shutil
import warnings
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

import pytest
import yaml
from click.testing import CliRunner

from rocking_cli.cli.main import main
from rocking_cli.core.registry import Registry
from rocking_cli.io.starters import STARTERS
from rocking_cli.io.yaml_file import parse
from tests.conftest import EXAMPLES, PROJECT, YAML_FILES

pytestmark = pytest.mark.rest

WHOLE = "ROCKING_FIELDS" in os.environ
PAIRS = int(os.environ.get("ROCKING_FIELDS") or 0) if WHOLE else 6
SINGLES = 20  # in the suite
SEED = 28
DROPPED = object()
CHANGES = {
    "dropped": DROPPED, "a word": "spoilt", "a list": [1.0, 2.0], "a mapping": {"spoilt": 1.0}, "true": True,
    "nothing": None, "zero": 0, "negative": -1.0, "tiny": 1e-300, "huge": 1e300,
}  # fmt: skip
Place = tuple[str | int, ...]
RECORD = EXAMPLES / "accel.csv"
SITE = EXAMPLES / "verify" / "site.yaml"
STRUCTURES = (
    ("equiv", "{}"),
    ("verify", "{}", "--site", str(SITE)),
    ("respond", "{}", "--pulse", "sine:0.4g:0.8s", "--neighbours", "0"),
    ("margin", "{}", "--pulse", "sine:0.4g:0.8s", "--neighbours", "2"),
    ("spectrum", "{}", "--pulse", "sine:0.4g:0.8s", "--sizes", "0.5:2", "--count", "3"),
    ("overturning", "{}", "--points", "3"),
    ("draw", "{}", "--plot", "drawn.svg"),
    ("error", "{}"),
)
SITES = (("verify", str(EXAMPLES / "verify" / "facade.yaml"), "--site", "{}"),)
STUDIES = (("fragility", "{}", "--check"),)


def _printed(name: str) -> str:
    return CliRunner().invoke(main, ["new", name]).stdout


@cache
def files() -> dict[str, tuple[str, tuple[tuple[str, ...], ...]]]:
    """What is handed out, by names: its text, and the commands that read it."""
    found: dict[str, tuple[str, tuple[tuple[str, ...], ...]]] = {}
    for path in YAML_FILES:
        kind = STUDIES if path.parent.name == "study" else SITES if path.stem == "site" else STRUCTURES
        found[str(path.relative_to(PROJECT))] = path.read_text(encoding="utf-8"), kind
    for name in (*Registry(), *STARTERS, "study", "site"):
        kind = {"study": STUDIES, "site": SITES}.get(name, STRUCTURES)
        found[f"rocking new {name}"] = _printed(name), kind
    return found


@cache
def _data(name: str) -> Any:
    return parse(files()[name][0], name, "file", "").data


def _places(data: Any, place: Place = ()) -> Iterator[Place]:
    """The places of all values: fields, entries of lists and what they hold."""
    inner = data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ()
    for key, value in inner:
        yield (*place, key)
        yield from _places(value, (*place, key))


def _changed(data: Any, place: Place, value: Any) -> None:
    """Change a place of plain data, unless an earlier change has taken it away."""
    *way, last = place
    try:
        for part in way:
            data = data[part]
        if value is DROPPED:
            del data[last]
        else:
            data[last] = copy.deepcopy(value)
    except (KeyError, IndexError, TypeError):
        pass


def _spoilt(name: str, changes: list[tuple[Place, str]]) -> str:
    data = copy.deepcopy(_data(name))
    for place, change in changes:
        _changed(data, place, CHANGES[change])
    return yaml.safe_dump(data, sort_keys=False)


def _beside(name: str, folder: Path) -> Path:
    """A file in the place of another, beside all that it names."""
    home = folder / "examples"
    if not home.exists():
        shutil.copytree(EXAMPLES, home)
    return (folder / name).with_name("spoilt.yaml") if name.startswith("examples") else home / "spoilt.yaml"


def _check(name: str, changes: list[tuple[Place, str]], words: tuple[str, ...], folder: Path) -> None:
    """Run a command on a spoilt file."""
    path = _beside(name, folder)
    path.write_text(_spoilt(name, changes), encoding="utf-8")
    arguments = [str(path) if word == "{}" else word for word in words]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        result = CliRunner().invoke(main, arguments)
    told = f"{name}: {changes}: rocking {' '.join(arguments)}\n{result.output}"
    if result.exception is not None and not isinstance(result.exception, SystemExit):
        raise AssertionError(told) from result.exception
    # A stocky body of which no solver knows the period is told so, by the code of solvers.
    assert result.exit_code in (0, 2, 5) or (result.exit_code == 4 and words[0] == "error"), told
    assert "Traceback" not in result.output and "Warning:" not in result.output, told
    assert result.exit_code not in (2, 4) or _is_placed(name, result.stderr, changes), told


def _is_placed(name: str, said: str, changes: list[tuple[Place, str]]) -> bool:
    """Whether a message names a line, one of the fields, or the structure whose mechanics has no answer."""
    fields = [part for place, _ in changes for part in place if isinstance(part, str)]
    return re.search(r"spoilt\.yaml:\d+", said) is not None or any(
        f"{each}" in said for each in (*fields, _data(name).get("name", "spoilt"), "error: spoilt: ")
    )


def _singles() -> Iterator[tuple[str, list[tuple[Place, str]]]]:
    for name in files():
        for place in _places(_data(name)):
            for change in CHANGES:
                yield name, [(place, change)]


def _pairs(draw: random.Random, count: int) -> Iterator[tuple[str, list[tuple[Place, str]]]]:
    for _ in range(count):
        name = draw.choice(list(files()))
        places = list(_places(_data(name)))
        yield name, [(draw.choice(places), draw.choice(list(CHANGES))) for _ in range(2)]


def _drawn() -> list[tuple[str, list[tuple[Place, str]], tuple[str, ...]]]:
    """What is tried here: a sample by the first command of each file, or everything by all in turn."""
    draw = random.Random(SEED)
    cases = list(_singles()) if WHOLE else draw.sample(list(_singles()), SINGLES)
    return [
        (name, changes, draw.choice(files()[name][1]) if WHOLE else files()[name][1][0])
        for name, changes in [*cases, *_pairs(draw, PAIRS)]
    ]


def test_a_spoilt_field_is_answered_or_named(tmp_path):
    for name, changes, words in _drawn():
        _check(name, changes, words, tmp_path)


@pytest.mark.parametrize("name", ["examples/walls/facade.yaml", "rocking new spanning_wall", "rocking new bell_cell"])
def test_every_field_may_be_dropped(name, tmp_path):
    """Of files whose masses follow from several fields."""
    for place in _places(_data(name)):
        if len(place) == 1:
            _check(name, [(place, "dropped")], ("equiv", "{}"), tmp_path)


@pytest.mark.parametrize(
    ("name", "place", "value", "code"),
    [
        ("examples/masonry/cracked_facade.yaml", ("bodies", "facade", "polygon", 3, 0), 1e5, 0),
        ("rocking new curve", ("points", 1, 1), 5e-324, 2),
        ("rocking new curve", ("points", 1, 1), 1e300, 2),
        ("rocking new rigid_body", ("depth",), 1e-300, 2),
    ],
)
def test_extreme_values_give_no_warning(name, place, value, code, tmp_path):
    data = copy.deepcopy(_data(name))
    _changed(data, place, value)
    path = _beside(name, tmp_path)
    path.write_text(yaml.safe_dump(data, sort_keys=False), encoding="utf-8")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        result = CliRunner().invoke(main, ["equiv", str(path)])
    assert result.exit_code == code, result.output
    assert code == 0 or re.search(r"spoilt\.yaml:\d+:\d+: (points\[2\]|depth)", result.stderr)
