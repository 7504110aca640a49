"""Stores under attack: damaged in every way, and written by several processes at once.

The tests try some of it, `make soak` hundreds.
"""

import json
import random
import shutil
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
from click.testing import CliRunner

from rocking_cli.cli.main import main
from rocking_cli.questions.fragility.store import COLUMNS, NO_RUNS, RunRows, Store
from tests.conftest import EXAMPLES

STUDY = f"""\
structures:
  - {EXAMPLES / "frame.yaml"}
  - file: {EXAMPLES / "block.yaml"}
    name: uncertain
    vary:
      width: {{normal: {{mean: 0.7, deviation: 0.05}}}}
records:
  - pulse: sine:0.6g:0.8s
  - pulse: ricker:0.6g:1.2s
levels: {{measure: PGA, least: 0.1, most: 1.2, count: LEVELS}}
polarity: both
samples: 4
method: stripes
limit_states: [uplift, overturning]
hazard: {{points: [[0.1, 0.01], [1, 0.0001]]}}
seed: SEED
"""
RUNS = 240  # of the study with 12 levels, in four files


def write(folder: Path, seed: int = 0, name: str = "study", levels: int = 12) -> Path:
    """A study in a file."""
    path = folder / f"{name}.yaml"
    path.write_text(STUDY.replace("SEED", str(seed)).replace("LEVELS", str(levels)), encoding="utf-8")
    return path


def command(*arguments: object, code: int | None = None) -> Any:
    """The outcome of a command in this process, which must have this exit code if one is given."""
    result = CliRunner().invoke(main, [str(each) for each in arguments])
    assert code in (None, result.exit_code), result.output
    if result.exception is not None and not isinstance(result.exception, SystemExit):
        raise AssertionError(f"{arguments}: {result.exception!r}") from result.exception
    return result


def shown(text: str) -> dict[str, Any]:
    """What `--json` prints, but where the store is."""
    return {key: value for key, value in json.loads(text).items() if key not in ("store", "given")}


def every_run(place: Path) -> RunRows:
    """All runs of a store."""
    store = Store.reading(place)
    return RunRows.joined([NO_RUNS, *store.rows(0, store.plan.size)])


def contents(folder: Path) -> dict[str, bytes]:
    """The files of a store by name, but what writers that were killed have left."""
    return {each.name: each.read_bytes() for each in folder.iterdir() if not each.name.startswith(".")}


class Sound:
    """A study, its store, and the store of another study of the same shape."""

    def __init__(self, folder: Path) -> None:
        self.study, self.other = write(folder), write(folder, seed=1, name="other")
        for each in (self.study, self.other):
            command("fragility", each, code=0)
        self.store = self.study.with_suffix(".runs")
        self.shown = shown(command("results", self.store, "--json").stdout)


def flips(content: bytearray, rng: random.Random) -> None:
    for _ in range(rng.choice([1, 1, 1, 2, 8, 64])):
        content[rng.randrange(len(content))] ^= 1 << rng.randrange(8)


def ends(content: bytearray, rng: random.Random) -> None:
    """Of the directory at the end of a zip file, where a byte says most."""
    content[-1 - rng.randrange(min(1000, len(content)))] = rng.randrange(256)


def zeros(content: bytearray, rng: random.Random) -> None:
    start = rng.randrange(len(content))
    content[start : start + 512] = bytes(len(content[start : start + 512]))


def cut(content: bytearray, rng: random.Random) -> None:
    del content[rng.randrange(len(content)) :]


def junk(content: bytearray, rng: random.Random) -> None:
    content[:] = rng.choice([b"", b"PK\3\4", b"{}", b"[]", rng.randbytes(5000), b'{"layout": 3}'])


def renamed(place: Path, file: Path, rng: random.Random, sound: Sound) -> None:
    shutil.copyfile(file, rng.choice([each for each in place.iterdir() if each != file]))


def of_another(place: Path, file: Path, rng: random.Random, sound: Sound) -> None:
    shutil.copyfile(sound.other.with_suffix(".runs") / file.name, file)


def deleted(place: Path, file: Path, rng: random.Random, sound: Sound) -> None:
    file.unlink()


BYTES = (flips, flips, ends, zeros, cut, junk)
DAMAGES = (*BYTES, renamed, of_another, deleted)


def attack(sound: Sound, folder: Path, number: int) -> str:
    """Damage one file of a copy of a store, and see what becomes of it.

    Returns "sound" if nothing that counts was hit, "mended" if the runs of the file were computed again, or "refused".

    Raises
    ------
    AssertionError
        If a command ends with a traceback, gives other results without a word, or loses the folder.
    """
    rng, damage = random.Random(number), DAMAGES[number % len(DAMAGES)]
    place = folder / "store.runs"
    shutil.copytree(sound.store, place)
    file = rng.choice(sorted(place.iterdir()))
    if damage in BYTES:
        content = bytearray(file.read_bytes())
        damage(content, rng)  # type: ignore[operator]
        file.write_bytes(content)
    else:
        damage(place, file, rng, sound)  # type: ignore[operator]
    told, found = f"{number}: {damage.__name__} of {file.name}", contents(place)

    looked = command("results", place, "--json")
    if looked.exit_code == 0:
        assert shown(looked.stdout) == sound.shown, f"{told}: other results without a word"
    elif looked.exit_code == 5:
        assert shown(looked.stdout)["finished"] < RUNS, told
    else:
        assert looked.exit_code == 2 and looked.stderr and not looked.stdout, told
    ran = command("fragility", sound.study, "--store", place, "--json")
    if ran.exit_code == 0:
        assert shown(ran.stdout) == sound.shown, f"{told}: other results after it was run again"
        assert contents(place) == contents(sound.store) or looked.exit_code == 0, told
        return "sound" if looked.exit_code == 0 else "mended"
    assert ran.exit_code == 2 and ran.stderr and contents(place) == found, told
    again = command("fragility", sound.study, "--store", place, "--restart", "--json", code=0)
    assert shown(again.stdout) == sound.shown and contents(folder / "store.before.runs") == found, told
    assert contents(place) == contents(sound.store), told
    return "refused"


WAITS = """
import sys, time
from pathlib import Path
import rocking_cli.cli.made, rocking_cli.questions.fragility.verb, rocking_cli.questions.fragility.results
import rocking_cli.questions.fragility.campaign
import rocking_cli.dynamics.kernels, rocking_cli.questions.fragility.view
from rocking_cli.cli.main import main
Path(sys.argv[1]).touch()
while not Path(sys.argv[2]).exists():
    time.sleep(0.001)
main(sys.argv[3:])
"""


def race(sound: Sound, folder: Path, *more: str) -> list[int]:
    """Three processes begin one study at the same moment; their exit codes.

    Raises
    ------
    AssertionError
        If no complete store is left, more than it is left, or a process gives other results.
    """
    folder.mkdir()
    place, go = folder / "store.runs", folder / "go"
    if more:
        shutil.copytree(sound.store, place)
    ready = [folder / f"ready{k}" for k in range(3)]
    processes = [
        subprocess.Popen(
            [sys.executable, "-c", WAITS, each, go, "fragility", sound.study, "--store", place, "--json", *more],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, encoding="utf-8",
        )
        for each in ready
    ]  # fmt: skip
    while not all(each.exists() for each in ready):
        assert all(each.poll() is None for each in processes), [each.communicate() for each in processes]
        time.sleep(0.01)
    go.touch()
    ended = [(*each.communicate(), each.returncode) for each in processes]
    for out, said, code in ended:
        assert "Traceback" not in said and code in ((0, 2, 5) if more else (0,)), (code, said)
        if code == 0:
            assert shown(out) == sound.shown, said
        else:  # another one has restarted the study, too
            assert any(
                each in said for each in ("another process", "moved or deleted", "still empty", "finished so far")
            ), said
    codes = sorted(code for *_, code in ended)
    assert codes[0] == 0, ended
    assert contents(place) == contents(sound.store)
    left = {each.name for each in folder.iterdir()} - {"go", "ready0", "ready1", "ready2", "store.runs"}
    assert all(name.startswith("store.before") and any(name in said for _, said, _ in ended) for name in left)
    return codes


def kills(folder: Path, times: int, levels: int = 4000) -> int:
    """Kill two writers of one study again and again; the number of times it took until all runs were there.

    Raises
    ------
    AssertionError
        If a run is lost or wrong.
    """
    folder.mkdir()
    study = write(folder, levels=levels)
    rng, place = random.Random(times), study.with_suffix(".runs")
    words = [sys.executable, "-c", "from rocking_cli.cli.main import main; main()", "fragility", study, "--jobs", "1"]
    for _ in range(times):
        both = [subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) for _ in range(2)]
        time.sleep(rng.uniform(0.5, 2.5))
        for each in both:
            each.kill()
            each.wait()
    command("fragility", study, code=0)
    command("fragility", study, "--store", folder / "whole.runs", code=0)
    one, other = every_run(place), every_run(folder / "whole.runs")
    for name in COLUMNS:
        assert np.array_equal(getattr(one, name), getattr(other, name), equal_nan=True), name
    return len(one)
