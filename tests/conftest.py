"""What several test files share."""

import csv
import gc
import os
import re
import signal
import sys
from collections import defaultdict
from importlib.util import find_spec
from itertools import count
from math import ceil
from pathlib import Path
from zlib import crc32

import hypothesis
import pytest

# How long an example takes says how busy the machine is, and nothing of what is tested. The suite tries the same
# examples everywhere, so that a failure says something of the change at hand; `make properties` looks for new ones.
PROPERTIES = int(os.environ.get("ROCKING_PROPERTIES", 0))
hypothesis.settings.register_profile("suite", deadline=None, max_examples=30, derandomize=True)
hypothesis.settings.register_profile("search", deadline=None, max_examples=max(PROPERTIES, 1))
hypothesis.settings.load_profile("search" if PROPERTIES else "suite")

PROJECT = Path(__file__).resolve().parents[1]
EXAMPLES = PROJECT / "examples"
YAML_FILES = [file for file in sorted(EXAMPLES.rglob("*.yaml")) if file.parent.name != "plugin"]  # it is not installed
SHARED = PROJECT.parent / "shared"
# Real strong motion is not part of the project. Tests of it are skipped, and counted, where it is absent.
RECORDS = Path(os.environ.get("ROCKING_RECORDS", SHARED / "records"))
FORMATS = RECORDS / "formats"
NEEDS_MUJOCO = pytest.mark.skipif(find_spec("mujoco") is None, reason="free blocks need mujoco")
NEEDS_RECORDS = pytest.mark.skipif(not FORMATS.is_dir(), reason=f"no real records in {RECORDS} (ROCKING_RECORDS)")


KEPT = ("ROCKING_RECORDS", "ROCKING_KERNELS")  # the second has all tests run with the kernels of that way

# Else each of hundreds of child processes compiles the package anew.
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
sys.dont_write_bytecode = False

# As many workers as processors run the tests; a library that starts threads of its own is in their way.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

gc.set_threshold(50_000)  # as the program does: what there is of garbage is small beside what stays

# What tests read is as in a pipe, where no line is broken; those of widths say how wide they are.
os.environ.pop("COLUMNS", None)

# Whoever runs the tests in the background, or under nohup, has these ignored, and their children with them.
for _name, _usual in (("SIGINT", signal.default_int_handler), ("SIGTERM", signal.SIG_DFL), ("SIGHUP", signal.SIG_DFL)):
    _number = getattr(signal, _name, None)
    if _number is not None and signal.getsignal(_number) == signal.SIG_IGN:
        signal.signal(_number, _usual)


_MADE = count()


@pytest.fixture
def tmp_path(request, tmp_path_factory):
    """A folder of its own; pytest's would list all that there are to number the next, the longer the more there are."""
    name = re.sub(r"\W", "_", request.node.name)[:30]
    return tmp_path_factory.mktemp(f"{name}{next(_MADE)}", numbered=False)


_EMPTY: list[Path] = []


@pytest.fixture(autouse=True)
def _in_an_empty_folder(request, tmp_path_factory, monkeypatch):
    """No test reads a `rocking.yaml` that happens to lie where pytest was started.

    Those that want no folder of their own share one for as long as it is empty: it takes longer to make and to remove
    ten thousand than they all compute.
    """
    if "tmp_path" in request.fixturenames:
        monkeypatch.chdir(request.getfixturevalue("tmp_path"))
        return
    if not _EMPTY or any(_EMPTY[-1].iterdir()):
        _EMPTY.append(tmp_path_factory.mktemp("empty"))
    monkeypatch.chdir(_EMPTY[-1])


@pytest.fixture(autouse=True)
def _no_variables_of_a_user(monkeypatch):
    """No test takes the environment of whoever runs it."""
    for name in [each for each in os.environ if each.startswith("ROCKING_") and each not in KEPT]:
        monkeypatch.delenv(name)


@pytest.fixture(autouse=True, scope="module")
def _no_histories_of_a_user(tmp_path_factory):
    """No test takes the histories of free blocks that whoever runs it has simulated, or leaves its own there."""
    file = tmp_path_factory.getbasetemp() / "user" / f"blocks{next(_MADE)}.sqlite"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("rocking_cli.studies.engines.free.place", lambda: file)
        yield


@pytest.fixture(autouse=True, scope="module")
def _pages_without_pictures(request):
    """Pages leave out their pictures, which take most of their time, except in modules that look at them: `drawn`."""
    with pytest.MonkeyPatch.context() as patch:
        if request.node.get_closest_marker("drawn") is None:
            patch.setattr("rocking_cli.documents.sheet_page.inline_svg", lambda draw, prefix: f"[{prefix}]")
        yield


@pytest.fixture
def drawn(monkeypatch):
    """Pages with their pictures in a test of a module whose others leave them out."""
    from rocking_cli.documents.figures import inline_svg

    monkeypatch.setattr("rocking_cli.documents.sheet_page.inline_svg", inline_svg)


@pytest.fixture
def small_maps(monkeypatch):
    """Maps of few points in the reports of a test of something else."""
    from rocking_cli.questions.report import study as assessment

    monkeypatch.setattr(assessment, "MAP_POINTS", 20)


@pytest.fixture(scope="session")
def frame_report(tmp_path_factory):
    """The report on the example of a frame, with its pictures: its file, and what was printed."""
    from rocking_cli.documents.figures import inline_svg
    from tests.cli.test_cli import run

    out = tmp_path_factory.mktemp("report") / "r.html"
    given = EXAMPLES / "frame.yaml", "--record", EXAMPLES / "accel.csv"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("rocking_cli.documents.sheet_page.inline_svg", inline_svg)
        result = run("report", "--neighbours", 20, *given, "-o", out)
    return out, result.stdout.strip()


def rows_of(place: str | Path) -> list[dict[str, str]]:
    """The rows of a table in a file, by its headings."""
    with Path(place).open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def record(name: str) -> Path:
    """A real record; the test is skipped where it is absent."""
    path = RECORDS / name
    if not path.is_file():
        pytest.skip(f"no real records in {RECORDS} (ROCKING_RECORDS): {name}")
    return path


@pytest.hookimpl(tryfirst=True)  # before those of other tiers are left out
def pytest_collection_modifyitems(items):
    """Leave a few cases to `make test` where a test has many: which, a checksum says, so that none is like the next.

    All cases of a test but one of `make test` are `again`: other versions of libraries need no more than that one.
    """
    cases = defaultdict(list)
    for item in items:
        cases[item.nodeid.partition("[")[0]].append(item)
    for same in cases.values():
        same.sort(key=lambda item: crc32(item.name.encode()))
        if (every := same[0].get_closest_marker("every")) is not None:
            for item in same[ceil(len(same) / every.args[0]) :]:
                item.add_marker("rest")
        now = [item for item in same if item.get_closest_marker("rest") is None]
        for item in now[1:]:
            item.add_marker("again")


def pytest_make_parametrize_id(val):
    """Bytes have no name of their own: what is packed holds the time at which it was, and each worker packs anew."""
    return "bytes" if isinstance(val, bytes) else None


def pytest_terminal_summary(terminalreporter):
    """Say how many tests were skipped for want of records: a green run without them has tested less."""
    skipped = terminalreporter.stats.get("skipped", [])
    wanting = [each for each in skipped if "no real records in" in str(each.longrepr)]
    if wanting:
        terminalreporter.write_line(
            f"{len(wanting)} tests were skipped for want of real records in {RECORDS}: "
            "set ROCKING_RECORDS to a folder that has them",
            yellow=True,
        )
