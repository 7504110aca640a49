"""Every command ends in order where its streams are closed, broken or full: its work is done, or its code says why."""

import io
import os
import shlex
import sys
from contextlib import suppress
from pathlib import Path

import pytest
import yaml

from rocking_cli.cli.main import main
from tests.cli.test_every_option import ACCEL, ACROSS, BLOCK_FILE, DRAWN_FILE, SITE, STUDY, TRACED
from tests.conftest import EXAMPLES

UNDER = f"{BLOCK_FILE} --record {ACCEL}"
LINES = {
    "draw": f"{BLOCK_FILE}",
    "equiv": "gone.yaml",
    "collapse": f"{BLOCK_FILE}",
    "import": f"{DRAWN_FILE} --scale 1:50 --depth 1 --density 2000",
    "error": f"{BLOCK_FILE}",
    "record": f"{ACCEL}",
    "select": f"{ACCEL} {ACROSS} --target {EXAMPLES / 'target.csv'} --band 0.2:2 --count 2",
    "verify": f"{BLOCK_FILE} --site {EXAMPLES / 'verify' / 'site.yaml'}",
    "demand": f"{SITE}",
    "survey": f"{EXAMPLES / 'survey' / 'parapets.csv'} --record {ACCEL} --neighbours 0",
    "design": f"{UNDER} --vary width=0.5:0.9 --until 'lambda>=0.2'",
    "calibrate": f"{TRACED} --free {EXAMPLES / 'calibrate' / 'trace.csv'}",
    "animate": f"{UNDER} --out film.html --neighbours 0",
    "pulse": f"{BLOCK_FILE} --ag 0.3g --period 0.5",
    "overturning": f"{BLOCK_FILE} --points 3",
    "equivalent_pulses": f"{BLOCK_FILE} {BLOCK_FILE} --ag 0.5g --period 0.6",
    "fragility": "study.yaml --store study.runs",
    "results": "study.runs",
    "mechanisms": "block",
    "measures": "",
    "new": "block",
    "info": "",
    "selfcheck": "--help",
    "completion": "bash",
    "respond": f"{BLOCK_FILE} --record {ACCEL} --neighbours 0",
    "margin": f"{BLOCK_FILE} --record {ACCEL} --neighbours 3",
    "report": f"{BLOCK_FILE} --out r.html",
    "": "--help",
    "crosscheck": f"{BLOCK_FILE} --record gone.csv",
    "spectrum": f"{UNDER}",
}
"""A command line of each command, those that take longest in short."""
ENDS = {
    "whole": (True, True), "broken": ("broken", True), "full": ("full", True), "no errors": (True, None),
    "no results": (None, True), "neither": (None, None), "broken errors": (True, "broken"),
    "full errors": (True, "full"),
}  # fmt: skip
"""Where standard output and standard error lead; None if they are closed."""


def _lead(number, where):
    """Lead one of the streams of this process somewhere, and return Python's stream to it."""
    if where is None:
        os.close(number)
        return None
    if where is True:
        target = os.open(f"{number}.txt", os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
    elif where == "full":
        target = os.open("/dev/full", os.O_WRONLY)
    else:
        reader, target = os.pipe()
        os.close(reader)
    os.dup2(target, number)
    return io.TextIOWrapper(io.BufferedWriter(io.FileIO(number, "w", closefd=False)), encoding="utf-8")


def ended(words, results, messages):
    """Return the exit code of a command in a process of its own, as Python ends it."""
    child = os.fork()
    if not child:
        code = 99  # of a traceback
        with suppress(Exception):
            sys.stdout, sys.stderr = _lead(1, results), _lead(2, messages)
            try:
                main(words, prog_name="rocking")
            except SystemExit as end:
                code = end.code or 0
            for stream in filter(None, (sys.stdout, sys.stderr)):
                stream.flush()
        os._exit(code)
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="the system has no full device")
@pytest.mark.every(16)
@pytest.mark.parametrize("command", LINES)
def test_streams_that_cannot_be_written(command, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("study.yaml").write_text(yaml.safe_dump(STUDY), encoding="utf-8")
    if command == "results":
        ended(["fragility", *shlex.split(LINES["fragility"])], True, True)
    words = [*filter(None, [command]), *shlex.split(LINES[command])]
    codes = {name: ended(words, *leads) for name, leads in ENDS.items()}
    whole = codes.pop("whole")
    assert whole in (0, 2, 5)
    lost = whole or (1 if Path("1.txt").read_bytes() else 0)
    assert codes == {name: lost if name in ("broken", "full") else whole for name in codes}
