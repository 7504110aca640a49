"""Every command is run once, and all is checked that is so of every outcome.

Its text fits terminals of every width and loses nothing there; names, keys and lines harm neither terminal nor page;
the keys of its JSON are those of `json_keys.txt`; and a structure whose outcome is unknown does not pass.
"""

import html
import json
import os
import re
import shlex
import shutil
import sys
import xml.etree.ElementTree as ElementTree
from contextlib import redirect_stderr
from importlib import import_module
from io import StringIO
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from rocking_cli.cli import terminal
from rocking_cli.cli.main import main
from rocking_cli.plugins.rooms import commands
from rocking_cli.questions.report import study as assessment
from rocking_cli.questions.selfcheck import study as selfcheck
from rocking_cli.text import printable
from tests.cli.test_hostile_text import HARMFUL
from tests.cli.test_widths import fits, words
from tests.conftest import EXAMPLES, PROJECT

with pytest.MonkeyPatch.context() as patch:
    patch.syspath_prepend(PROJECT / "scripts")
    outputs = import_module("outputs")

WIDTHS = (40, 60, 80, 100)

# --- a command, run once


class Screens:
    """What a command shows on standard output and standard error, in a pipe (width 0) and on terminals."""

    def __init__(self, patch):
        self.out, self.err, self.short = ({width: StringIO() for width in (0, *WIDTHS)} for _ in range(3))
        self.inside, self.files = False, []
        for name in ("show", "sentence", "_say"):
            patch.setattr(terminal, name, self.everywhere(getattr(terminal, name)))

    def everywhere(self, shown):
        """Show as asked, and then as text at every width, also in full; of what is shown within another, no more."""

        def also(*what, **how):
            if self.inside:
                shown(*what, **how)
                return
            self.inside = True
            shown(*what, **how)
            for width, out in self.out.items():
                with pytest.MonkeyPatch.context() as patch, redirect_stderr(self.err[width]):
                    patch.setenv("COLUMNS", str(width))
                    for place, verbose in ((self.short[width], False), (out, True)):
                        patch.setattr(terminal, "_results", place)
                        patch.setattr(terminal, "asked", lambda switch, verbose=verbose: verbose)
                        shown(*what, **dict.fromkeys(how, False))  # as_json, if anything
            self.inside = False

        return also

    def text(self, width=0):
        """Return what is on standard output."""
        return self.out[width].getvalue()

    def check(self):
        """All fits and nothing is lost; names harm nothing."""
        assert all(fits(stream.getvalue(), width) for width, stream in self.short.items() if width)
        for streams in (self.out, self.err):
            whole, *narrow = (stream.getvalue() for stream in streams.values())
            assert not HARMFUL.search(whole)
            for width, text in zip(WIDTHS, narrow, strict=True):
                assert fits(text, width), text
                assert set(words(whole) - words(text)) <= EMPTY, f"lost at {width} columns:\n{text}"
                assert set(words(text)) - set(words(whole)) <= {"value"}, f"a piece of a word at {width}:\n{text}"


EMPTY = {"symbol"}
"""The heading of a column that of some mechanisms has no cell: below each other, cells alone have headings."""
PLAIN = {"completion", "new", "record"}
"""Commands whose JSON is no view: the first two print files as they are, the others are walked as text, too."""


def unwritten(line):
    """Return a line without pictures and sheets, which change nothing of what is shown."""
    return re.sub(r" --(plot|sheet) \S+", "", line)


def walked(line, **files):
    """Run a command and check what all have in common; return what it printed, and its text at all widths."""

    def run(line, **given):
        return CliRunner().invoke(main, [files.get(word, word) for word in shlex.split(line)], **given)

    before = set(Path().rglob("*"))
    with pytest.MonkeyPatch.context() as patch:
        screens = Screens(patch)
        done = run(line)
    command = line.split()[0]
    assert done.exit_code == 0 or isinstance(done.exception, SystemExit), done.exception
    assert not HARMFUL.search(done.stdout + done.stderr)
    assert screens.text() or command in PLAIN or "-o -" in line or done.exit_code
    screens.check()
    made = sorted(set(Path().rglob("*")) - before)
    pictures = [file for file in made if file.suffix == ".svg"]
    assert len(pictures) == ("svg" in line)
    for picture in pictures:
        ElementTree.parse(picture)
    for file in made:
        text = file.read_text(encoding="utf-8") if file.suffix in (".csv", ".html", ".json") else ""
        screens.files.append(text)
        assert not HARMFUL.search(text)
        assert "<b>" not in text or file.suffix in (".csv", ".json")
    return done, screens


# --- files that nobody can spell, and a structure whose outcome is unknown

LINUX = sys.platform == "linux"
BAD = b"\xff\x1b[31m$\\frac{1$<b>" if LINUX else "\u202e$\\frac{1$&'".encode()
A, R = (os.fsdecode(BAD + suffix) for suffix in (b".yaml", b".csv"))
MATHS = "$\\frac{1$<b>&'"  # neither a formula nor markup
BODY = "mechanism: rigid_body\npolygon: [[0, 0], [{0}, 0], [0.6, 2.8], [0, 2.8]]\nfriction: 0.3\n"
SITE = "FC: 1.2\nag: 0.9\nF0: 2.5\nTC: 0.5\nS: 1.2\n"  # so strong that the static methods fail too
STUDY = f"""\
structures: [{{file: n.yaml, name: {json.dumps(MATHS)}}}]
records: ['*frac*.csv', {{pulse: sine:1g:0.5s}}]
method: stripes
levels: {{measure: PGA, least: 1.9, most: 2.0, count: 2}}
limit_states: [0.5, overturning]
"""


@pytest.fixture
def hostile(tmp_path):
    """A stone, called after its file, whose history ends early; a sister of it; a pulse as a record; and more.

    Under the pulse the stone slides after .05 s, long before it could overturn.
    """
    time = np.arange(0, 0.5, 0.01)
    pulse = np.where(time <= 0.4, 2 * np.sin(2 * np.pi * time / 0.4), 0.0)
    record = "time [s],acceleration [g]\n" + "".join(f"{t:.2f},{a:.5f}\n" for t, a in zip(time, pulse, strict=True))
    files = {
        A: BODY.format(0.7),
        R: record,
        "r.csv": record,
        "n.yaml": BODY.format(0.72) + f"name: {json.dumps(MATHS)}\n",
        "site.yaml": SITE,
        "study.yaml": STUDY,
        "table.csv": "file\nn.yaml\n",
    }
    for name, text in files.items():
        (tmp_path / name).write_text(text, encoding="utf-8")


# What each command is asked, and what shows in its JSON that the outcome is unknown.
HISTORIES = {
    "respond A --record R --model nonlinear --neighbours 3 --plot p.svg --out h.csv": (
        lambda found: found["responses"]["nonlinear"]["outcome"] == "unknown" and found["neighbours"]["unknown"] == 1
    ),
    "margin A --record R --neighbours 2 --plot p.svg": (
        lambda found: found["motions"][0]["unknown"][-1] == 1 and found["motions"][0]["levels"]["50"]["first"] is None
    ),
    "respond A --record R --engine blocks --tail 1 --plot p.svg --out h.csv --animate film.html": lambda found: (
        found["responses"]["nonlinear"]["outcome"] == found["engines"]["finding"].removeprefix("exact_") == "unknown"
    ),
    "verify A --site site.yaml --record R --sheet sheet.html": lambda found: all(
        side["dynamic"]["SLV"][FC]["unknown"] == [R]
        for side in found["directions"].values()
        for FC in ("with_FC", "without_FC")
    ),
    "survey table.csv --record R --out out.csv": lambda found: found["rows"][0]["unknown"] == 1,
    "design A --record R --neighbours 2 --points 2 --vary friction=0.29:0.3 --until overturned<1": lambda found: (
        found["scan"]["unknown"] == [1, 1]
        and (found["holds"], found["value"], found["everywhere"]) == ([], None, False)
    ),
    "animate A --record R --neighbours 2 --out film.html": lambda found: found["outcome"] == "unknown",
    "explore A --record R --neighbours 2 --out page.html": lambda found: found["structures"][0]["outcome"] == "unknown",
    "pulse A --ag 2g --period 0.4": lambda found: found["responses"]["nonlinear"]["unknown"],
    "overturning A --model nonlinear --ag 1.9g:2g --period 0.4:0.41 --points 3 --plot p.svg": (
        lambda found: found["shares"]["unknown"] == 1
    ),
    "spectrum A N --record R --sizes 2.4:2.5 --count 2 --plot p.svg --out out.csv": (
        lambda found: [each["unknown"] for each in found["spectra"]] == [[1, 1, 1]] * 2
    ),
    "equivalent_pulses A N --ag 2g --period 0.4 --plot p.svg": (
        lambda found: [each["unknown"] for each in found["structures"]] == [True, True]
    ),
    "fragility study.yaml --jobs 1 --quantiles --plot pictures": lambda found: (
        found["outcomes"][0]["share"] == 1 and all(each["band"] for each in found["curves"])
    ),
    "results study.runs --quantiles --out runs.csv": lambda found: found["outcomes"][0]["share"] == 1,
    "report A --record R --neighbours 2 --out report.html": (
        lambda found: found["motions"][0]["unknown"] and found["motions"][0]["headline"].startswith("unknown after")
    ),
}
WITHOUT_HISTORY = (
    "draw A --plot p.svg", "draw N --plot p.svg", "error A --plot p.svg", "error N --plot p.svg", "equiv A N",
    "overturning --compare A N --ag 1.9g:2g --period 0.4:0.41 --points 3 --plot p.svg",
    "record R --plot p.svg",
)  # fmt: skip
AS_TEXT = ("record R --fit-pulse --plot p.svg", "equiv A N -o -")
# These follow no history; `selfcheck` follows those of its blocks. `calibrate` judges no structure. `building` verifies
# as `verify` does.
WITHOUT = {
    "building", "calibrate", "draw", "equiv", "collapse", "error", "record", "select", "demand", "mechanisms",
    "measures", "new", "info", "selfcheck", "completion", "import",
}  # fmt: skip
BARE = re.compile(r"\bkN\b|\[N\]|\bN m\b|\d N[ ,.;<]")
"""A force that is not per unit mass."""
LINEAR = {"linear1", "linear2", "closed_form", "blocks"}  # equivalent and free blocks: their outcomes are their own
KNOWN = {"at_rest", "rocks", "still_rocking", "does not uplift", "overturned"}
PASSED = re.compile(
    r"does not overturn(?! before its first impact)|overturns under none|overturns in no direction\.|"
    r"uplifts under none of \d+ motions\.|"
    r"^\s*outcome(?!.*unknown).*(?:rocks|at rest|still rocking)|structure rocks|(?<!not )\bsatisfied(?! if)|"
    r"\bpasses\b(?! if)",
    re.IGNORECASE | re.MULTILINE,
)


def offences(data, at=""):
    """Where JSON takes an outcome for known, or for a pass."""
    if isinstance(data, dict):
        for key, value in data.items():
            if key not in LINEAR:
                yield from offences(value, f"{at}.{key}")
    elif isinstance(data, list):
        for value in data:
            yield from offences(value, at)
    else:
        *_, key = at.rpartition(".")
        known = key in ("outcome", "headline") and data in KNOWN
        if known or (key == "overturned" and data is False) or (data is True and key in ("holds", "passes")):
            yield f"{at} = {data}"


def needs_mujoco(line):
    if "--engine blocks" in line:
        pytest.importorskip("mujoco", reason="free blocks need mujoco")


def names(lines):
    """Return the commands of some lines."""
    return {line.split()[0] for line in lines}


def test_every_command_is_walked_or_follows_no_history():
    assert names(HISTORIES) | WITHOUT == set(commands()) and not names(HISTORIES) & WITHOUT


@pytest.mark.every(6)
@pytest.mark.usefixtures("hostile")
@pytest.mark.parametrize("line", [*HISTORIES, *WITHOUT_HISTORY, *AS_TEXT])
def test_an_unknown_outcome_is_no_pass_and_names_harm_nothing(line, monkeypatch):
    monkeypatch.setattr(assessment, "MAP_POINTS", 3)  # of a map
    needs_mujoco(line)
    if line.startswith("results"):
        CliRunner().invoke(main, shlex.split("fragility study.yaml --jobs 1"))
    done, screens = walked(line if line in AS_TEXT else f"{line} --json", A=A, R=R, N="n.yaml")
    assert done.exit_code == 0, done.stderr
    found = json.loads(done.stdout.splitlines()[0]) if line not in AS_TEXT else None
    for text in (screens.text(), *screens.files):  # the stone has no mass
        assert not BARE.search(text), BARE.search(text)
    if line in HISTORIES:
        assert HISTORIES[line](found)
        assert not list(offences(found))
        assert "unknown" in screens.text() and not PASSED.findall(screens.text())
    if line.startswith("results"):
        assert printable(R) in Path("runs.csv").read_text(encoding="utf-8")
    if line.startswith("report"):
        check_page(Path("report.html"))


def check_page(place):
    """The summary says until when the outcome is known and why, and tables end there."""
    page = html.unescape(re.sub(r"\s+", " ", re.sub(r"<[^>]*>", " ", place.read_text(encoding="utf-8"))))
    assert f"{printable(A.removesuffix('.yaml'))}: under {printable(R)}, the outcome is unknown after " in page
    assert f"Under {printable(R)}, reversed: unknown" in page and "The structure may overturn." in page
    assert "opens or slides by less than 0.5 %" in page
    assert not re.search(r"does not overturn\b|agree closely|no, it rocks", page)
    assert re.search(r"known until 0\.0\d+", page)
    assert re.search(r"outcome known .* until 0\.0\d+ s", page)


@pytest.mark.usefixtures("hostile")
@pytest.mark.parametrize("command", ["respond", "verify"])
def test_the_walk_sees_a_pass(command):
    """With a weak motion, and a limit that no opening passes, the walk finds what it would else not see."""
    Path("site.yaml").write_text(SITE.replace("ag: 0.9", "ag: 0.01"), encoding="utf-8")
    line = next(line for line in HISTORIES if line.startswith(command))
    done, screens = walked(f"{unwritten(line)} --opening 1 --scale 0.25 --json", A=A, R=R)
    found = json.loads(done.stdout)
    assert not HISTORIES[line](found)
    assert list(offences(found)) and PASSED.findall(screens.text())


# --- the examples, and the keys of their JSON

HELD = outputs.held_keys()
OF_ALL = ("equiv", "draw", "collapse", "mechanisms")
"""Commands that are asked of all examples but the large ones; the others are asked of one."""
LARGE = ("cracked_facade", "buttressed_arch", "wall_of_three", "wall_with_openings", "examples/assembly")
LONG = (
    "--trim 1:11",
    "--slenderness",
    '--until "peak_ratio',
    "--compare examples/block.yaml examples/frame.yaml examples/wall.yaml --json",
    "overturning examples/block.yaml --json",
    "report examples/frame.yaml --record",
)
"""Commands that take long; others of the same name stand for them."""
OF_NEIGHBOURS = ("respond {0}", "margin {0}", "report")
"""Commands that are asked of few neighbours: no key and no width depends on how many."""
SHOWN = (
    "respond examples/frame.yaml --record examples/accel.csv --polarity both --impacts --neighbours 5 --json",
    "respond examples/frame.yaml --record records/*.csv --with-pulse sine --neighbours 5",
    "margin examples/block.yaml --record records/*.csv --neighbours 5 --json",
    "pulse examples/frame.yaml --ag 0.4g --period 0.8 --json",
    "spectrum examples/block.yaml --record records/*.csv --slenderness 0.2 --sizes 1:6 --count 3 --json",
    "mechanisms block --check --json",
)
"""What is asked for its tables alone."""


def asked() -> dict[str, list[str]]:
    """Return the examples of each command that are tried."""
    tried = {}
    for command, examples in outputs.questions().items():
        chosen = examples if command.split()[0] in OF_ALL else ["", "examples/block.yaml"]
        if not any(part in command for part in (*LARGE, *LONG)):
            tried[command] = [each for each in examples if each in chosen and not any(part in each for part in LARGE)]
    return tried


@pytest.fixture(scope="module")
def examples(tmp_path_factory):
    """The examples, and records with names of all lengths."""
    made = tmp_path_factory.mktemp("examples")
    shutil.copytree(EXAMPLES, made / "examples")
    (made / "records").mkdir()
    for name in ("a.csv", "RSN1111_KOBE_NIS000.csv", "a_record_with_quite_a_long_name.csv"):
        shutil.copy(EXAMPLES / "accel.csv", made / "records" / name)
    return made


@pytest.mark.every(4)
@pytest.mark.parametrize("command", asked())
def test_the_keys_are_those_held(command, examples, monkeypatch):
    monkeypatch.chdir(examples)
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "0")
    monkeypatch.setattr(assessment, "MAP_POINTS", 3)  # of a map
    monkeypatch.setattr(selfcheck, "CHECKS", [each for each in selfcheck.CHECKS if each.name == "units"])
    if command.startswith("results"):
        CliRunner().invoke(main, shlex.split("fragility examples/study/pedestal.yaml"))
    needs_mujoco(command)
    few = " --neighbours 5" if command.startswith(OF_NEIGHBOURS) and "--record" in command else ""
    for example in asked()[command]:
        done, _ = walked(unwritten(command.format(example)) + few)
        keys = outputs.keys_of(done.stdout) - ({("given", "neighbours")} if few else set())
        there = {path for path in HELD[command] if path[:-1] in keys or len(path) == 1}
        gone = sorted(path for path in there - keys if HELD[command][path] in ("", example))
        come = sorted(keys - {*HELD[command]})
        assert not gone and not come, f"`rocking {command.format(example)}`: gone {gone}, come {come}"


@pytest.mark.parametrize("line", SHOWN)
def test_tables_of_many_columns_fit(line, examples, monkeypatch):
    monkeypatch.chdir(examples)
    done, screens = walked(line)
    assert done.exit_code == 0 and screens.text()


def test_every_command_is_held():
    assert set(HELD) == set(outputs.questions())
    assert names(asked()) == names(HELD) == set(commands())


def test_commands_whose_json_is_no_view_are_shown_as_text():
    assert "record" in PLAIN and PLAIN - {"completion", "new"} <= names(SHOWN) | names(AS_TEXT)
