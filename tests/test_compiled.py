"""How the compiled kernel is loaded, and what that leaves to other code of the process."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys

import pytest

from rocking_cli.cli import waiting
from rocking_cli.dynamics import compiled
from tests.conftest import EXAMPLES

RESPOND = (
    "from rocking_cli import GroundMotion, Registry, respond;"
    "respond(Registry()['block'](width=0.7, height=2.8), GroundMotion('x', 0.01, [0.0, 4.0, 0.0]))"
)


def run(code):
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.split()


@pytest.mark.kernels
def test_scipy_and_the_linear_algebra_of_numba_work_after_it():
    code = (
        f"{RESPOND}; import numpy as np, scipy.linalg; from numba import njit;"
        "print(scipy.linalg.det(np.eye(2)), njit(lambda a, b: np.dot(a, b))(np.eye(2), np.eye(2))[1, 1])"
    )
    assert run(code) == ["1.0", "1.0"]


TINY = """
from rocking_cli.dynamics.compiled import compile_kernel
kernel = compile_kernel(lambda x: x + 1)
print(kernel(2))
"""


def kept(folder):
    return sorted(each.suffix for each in folder.rglob("*.nb*"))


def tiny(folder, cache, **more):
    """A kernel of a module in a folder, compiled in a process of its own."""
    (folder / "tiny.py").write_text(TINY, encoding="utf-8")
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(cache), **more}
    return subprocess.run([sys.executable, folder / "tiny.py"], capture_output=True, text=True, env=environment)


@pytest.mark.kernels
class TestCache:
    def test_it_is_in_its_folder(self, tmp_path):
        (tmp_path / "source").mkdir()
        assert tiny(tmp_path / "source", tmp_path / "cache").stdout == "3\n"
        assert kept(tmp_path / "cache") == [".nbc", ".nbi"] and not kept(tmp_path / "source")

    def test_one_that_cannot_be_written_leaves_nothing_beside_the_source(self, tmp_path):
        (tmp_path / "cache").touch()  # no folder
        (tmp_path / "source").mkdir()
        assert tiny(tmp_path / "source", tmp_path / "cache").stdout == "3\n"
        assert not kept(tmp_path)

    def test_nor_does_one_within_which_a_folder_cannot_be_written(self, tmp_path):
        (tmp_path / "source").mkdir()
        tiny(tmp_path / "source", tmp_path / "cache")
        (own,) = (tmp_path / "cache").iterdir()
        shutil.rmtree(own)
        own.touch()
        assert tiny(tmp_path / "source", tmp_path / "cache").stdout == "3\n"
        assert not kept(tmp_path)

    def test_one_that_cannot_be_written_is_said_with_the_remedy(self, tmp_path, monkeypatch, capsys):
        (tmp_path / "cache").touch()
        monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "cache"))
        compiled.unwritable.cache_clear()
        monkeypatch.setattr(waiting, "_SAID", set())
        waiting.say_that_it_compiles(compiled.HISTORIES)
        said = capsys.readouterr().err
        waiting.say_that_it_compiles(compiled.PULSES)
        compiled.unwritable.cache_clear()
        assert "NUMBA_CACHE_DIR" not in capsys.readouterr().err  # the remedy is said once
        assert f"again in every process: {tmp_path / 'cache'} cannot be written to" in said
        assert "NUMBA_CACHE_DIR" in said and "once for this machine" not in said


def without_settings():
    """The environment without what it has for numba, which would be named too."""
    return {name: value for name, value in os.environ.items() if not name.startswith("NUMBA_")}


@pytest.mark.kernels
@pytest.mark.parametrize("setting", ["NUMBA_NUM_THREADS=0", "NUMBA_NUM_THREADS=many", "NUMBA_CPU_FEATURES=fast"])
def test_settings_with_which_numba_does_not_start_are_named(setting):
    name, value = setting.split("=")
    code = "from rocking_cli.cli.main import main; main()"
    arguments = ["respond", str(EXAMPLES / "block.yaml"), "--pulse", "sine:0.5g:1.2s"]
    ended = subprocess.run(
        [sys.executable, "-c", code, *arguments],
        capture_output=True,
        text=True,
        env={**without_settings(), "ROCKING_KERNELS": "jit", name: value},
    )
    assert ended.returncode == 2 and "Traceback" not in ended.stderr
    assert f"does not start with {setting}: " in ended.stderr and "unset these variables" in ended.stderr


def test_a_kernel_that_has_run_is_known_to_be_compiled(monkeypatch, tmp_path):
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
    compiled.unwritable.cache_clear()
    compiled.has_run.cache_clear()
    try:
        assert compiled.needs_compiling("kernels") and compiled.needs_compiling("pulse_motion")
        compiled.has_run("kernels")
        assert not compiled.needs_compiling("kernels") and compiled.needs_compiling("pulse_motion")
        with monkeypatch.context() as other:
            other.setattr(compiled, "version", lambda name: "another")
            assert compiled.needs_compiling("kernels")
    finally:
        compiled.unwritable.cache_clear()
        compiled.has_run.cache_clear()
