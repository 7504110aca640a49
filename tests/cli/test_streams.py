"""Every command ends in order where its streams or its disk are closed, broken or full: its work is done, or its code
says why, and none counts what it could not write as skipped."""

import errno
import io
import os
import shlex
import shutil
import sys
from contextlib import nullcontext, suppress
from pathlib import Path

import pytest
from click.testing import CliRunner

from rocking_cli.cli.main import main
from rocking_cli.io import files
from tests.cli.test_every_command import needs_mujoco
from tests.conftest import EXAMPLES
from tests.crash.attacks import DRAWN, LINES, light, words_of

OTHERS = {
    "help": "--help",
    "refused": "equiv gone.yaml",
    "pulse": f"pulse {EXAMPLES / 'block.yaml'} --ag 0.3g --period 0.5",
    "fields": "mechanisms block",
    "measures": "measures",
    "template": "new block",
    "info": "info",
    "completion": "completion bash",
}
"""Commands that print alone."""
SLOW = {"calibrate", "select", "survey", "collection", "sheets"}


def cases(names):
    """The names of commands, those that take long for `make test-rest`."""
    return [pytest.param(name, marks=[pytest.mark.rest] * (name in SLOW)) for name in names]


ENDS = {
    "whole": (True, True), "broken": ("broken", True), "full": ("full", True), "no errors": (True, None),
    "no results": (None, True), "neither": (None, None), "broken errors": (True, "broken"),
    "full errors": (True, "full"),
}  # fmt: skip
"""Where standard output and standard error lead; None if they are closed."""
FEW = "whole", "full", "full errors", "neither"
"""Of the commands that write files, too: what they do about a stream is the same code for all."""


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
    shutil.rmtree("folder", ignore_errors=True)  # `new` writes no folder again
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


@pytest.fixture
def typed(request, tmp_path, monkeypatch):
    """The words of a command, whose outputs are written into the current folder."""
    needs_mujoco(request.param)
    (tmp_path / "folder").mkdir()
    monkeypatch.chdir(tmp_path / "folder")
    inputs = tmp_path / "inputs"
    with nullcontext() if request.param in DRAWN else light():
        yield shlex.split(OTHERS[request.param]) if request.param in OTHERS else words_of(request.param, inputs)


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="the system has no full device")
@pytest.mark.every(8)
@pytest.mark.parametrize("typed", cases([*LINES, *OTHERS]), indirect=True)
def test_streams_that_cannot_be_written(typed, request):
    ends = ENDS if request.node.callspec.params["typed"] in OTHERS else FEW
    codes = {name: ended(typed, *ENDS[name]) for name in ends}
    whole = codes.pop("whole")
    assert whole in (0, 2, 5)
    lost = whole or (1 if Path("1.txt").read_bytes() else 0)
    assert codes == {name: lost if name in ("broken", "full") else whole for name in codes}


@pytest.mark.every(7)
@pytest.mark.parametrize(
    "typed", cases([name for name in LINES if name not in ("restart", "free_blocks")]), indirect=True
)
def test_the_exit_code_is_that_of_the_disk_for_each_output(typed, monkeypatch):
    """The first file that is written is refused, then the second, until all are written."""
    outputs = []

    def refuses(file, data):
        outputs.extend([file] * (file not in outputs))
        if outputs[-1] is file and len(outputs) == nth:
            file.refused = OSError((errno.ENOSPC, errno.EIO, errno.EDQUOT)[nth % 3], "no room")
            raise file.refused
        return io.FileIO.write(file, data)

    monkeypatch.setattr(files._Output, "write", refuses)
    for nth in range(1, 30):
        outputs.clear()
        done = CliRunner().invoke(main, typed)
        if len(outputs) < nth:
            break
        assert done.exit_code == 1 and "cannot be written: no room" in done.stderr, (typed, done.output, done.exception)
    assert nth > 1 and done.exit_code == 0, done.output
