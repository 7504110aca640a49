"""However a command is ended, it says so by its exit code and leaves nothing half-made behind."""

import os
import signal
import sys
import time

import pytest
from click.testing import CliRunner

from rocking_cli.__main__ import run
from rocking_cli.cli.main import Stopped, exit_code, in_order, main
from tests.conftest import EXAMPLES

SIGNALS = [getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)]


@pytest.mark.skipif(not hasattr(signal, "SIGHUP"), reason="Windows has none")
def test_who_ignores_a_signal_goes_on_ignoring_it():
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        with in_order():
            os.kill(os.getpid(), signal.SIGHUP)
            assert signal.getsignal(signal.SIGTERM) != signal.SIG_DFL  # else the next lines would end the tests
            with pytest.raises(Stopped):
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

    with pytest.raises(KeyboardInterrupt) as caught, in_order():
        assert signal.getsignal(number) != signal.SIG_DFL
        Deleted()
        time.sleep(60)
    assert exit_code(caught.value) == 128 + number


def test_an_interrupt_ends_any_command_with_130(monkeypatch):
    def interrupt(*arguments, **options):
        raise KeyboardInterrupt

    monkeypatch.setattr("rocking_cli.questions.equiv.verb.structure_of", interrupt)
    result = CliRunner().invoke(main, ["equiv", str(EXAMPLES / "block.yaml")])
    assert result.exit_code == 130 and result.stderr == "error: interrupted\n"


def test_an_interrupt_during_the_first_imports_ends_it_with_130(monkeypatch, capsys):
    class Interrupting:
        def find_spec(self, name, path=None, target=None):
            if name == "rocking_cli.cli.main":
                raise KeyboardInterrupt

    monkeypatch.delitem(sys.modules, "rocking_cli.cli.main")
    monkeypatch.setattr(sys, "meta_path", [Interrupting(), *sys.meta_path])
    with pytest.raises(SystemExit) as ended:
        run()
    assert ended.value.code == 130 and capsys.readouterr().err == "error: interrupted\n"


@pytest.mark.parametrize("given", ["x", "-1", "1.5", "9" * 12, "٣"])
def test_a_date_of_build_that_is_none_is_named(monkeypatch, given):
    monkeypatch.setenv("SOURCE_DATE_EPOCH", given)
    result = CliRunner().invoke(main, ["equiv", str(EXAMPLES / "block.yaml")])
    assert result.exit_code == 2
    assert result.stderr.startswith("error: SOURCE_DATE_EPOCH must be a whole number of at most 11 digits")
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    assert CliRunner().invoke(main, ["equiv", str(EXAMPLES / "block.yaml")]).exit_code == 0


@pytest.mark.rest
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
