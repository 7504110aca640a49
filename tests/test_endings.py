"""However a command is ended, it says so by its exit code and leaves nothing half-made behind."""

from __future__ import annotations

import os
import signal
import sys
import time

import pytest
from click.testing import CliRunner

from rocking_cli.cli import endings
from rocking_cli.cli.main import main
from tests.conftest import EXAMPLES
from tests.test_study_runs import program

SIGNALS = [getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)]


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no signals to send to one process")
@pytest.mark.parametrize("number", SIGNALS)
def test_a_picture_on_its_way_is_taken_away(tmp_path, number):
    arguments = ["animate", EXAMPLES / "block.yaml", "--record", EXAMPLES / "accel.csv", "--out", tmp_path / "a.gif"]
    process = program(*arguments, "--speed", 0.3)
    deadline = time.monotonic() + 120
    while not list(tmp_path.iterdir()):
        assert process.poll() is None, process.communicate()
        assert time.monotonic() < deadline
        time.sleep(0.02)
    process.send_signal(number)
    out, said = process.communicate()
    assert process.returncode == 128 + number and not out
    assert said.endswith("error: interrupted\n") and "Traceback" not in said
    assert list(tmp_path.iterdir()) == []


@pytest.mark.skipif(not hasattr(signal, "SIGHUP"), reason="Windows has none")
def test_who_ignores_a_signal_goes_on_ignoring_it():
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        with endings.in_order():
            os.kill(os.getpid(), signal.SIGHUP)
            assert signal.getsignal(signal.SIGTERM) != signal.SIG_DFL  # else the next lines would end the tests
            with pytest.raises(endings.Stopped):
                os.kill(os.getpid(), signal.SIGTERM)
                time.sleep(1)
        assert signal.getsignal(signal.SIGHUP) == signal.SIG_IGN
        assert signal.getsignal(signal.SIGTERM) == signal.SIG_DFL
    finally:
        signal.signal(signal.SIGHUP, before)


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no signals to send to one process")
@pytest.mark.parametrize("number", SIGNALS)
def test_a_signal_that_comes_where_python_drops_exceptions_is_not_lost(number):
    class Deleted:
        def __del__(self):
            os.kill(os.getpid(), number)
            time.sleep(0.01)

    with pytest.raises(KeyboardInterrupt) as caught, endings.in_order():
        assert signal.getsignal(number) != signal.SIG_DFL
        Deleted()
        time.sleep(60)
    assert endings.exit_code(caught.value) == 128 + number


def test_an_interrupt_ends_any_command_with_130(monkeypatch):
    def interrupt(*arguments, **options):
        raise KeyboardInterrupt

    monkeypatch.setattr("rocking_cli.cli.structures.load", interrupt)
    result = CliRunner().invoke(main, ["equiv", str(EXAMPLES / "block.yaml")])
    assert result.exit_code == 130 and result.stderr == "error: interrupted\n"


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="Linux has it")  # noqa: PTH110
@pytest.mark.parametrize("arguments", [["--help"], ["equiv", "--json", EXAMPLES / "block.yaml"], ["mechanisms"]])
def test_results_on_a_full_disk(arguments):
    import subprocess

    code = "from rocking_cli.cli.main import main; main()"
    with open("/dev/full", "wb") as full:  # noqa: PTH123
        ended = subprocess.run(
            [sys.executable, "-c", code, *map(str, arguments)], stdout=full, stderr=subprocess.PIPE, text=True
        )
    assert (
        ended.returncode == 1
        and ended.stderr == "error: the operating system reported an error: No space left on device\n"
    )
