"""How the compiled kernel is loaded, and what that leaves to other code of the process."""

from __future__ import annotations

import subprocess
import sys

import pytest

RESPOND = (
    "from rocking_cli import GroundMotion, Registry, respond;"
    "respond(Registry()['block'](width=0.7, height=2.8), GroundMotion('x', 0.01, [0.0, 4.0, 0.0]))"
)


def run(code):
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.split()


def test_a_history_does_without_the_linear_algebra_of_scipy():
    assert run(f"{RESPOND}; import sys; print('scipy.linalg' in sys.modules)") == ["False"]


def test_scipy_and_the_linear_algebra_of_numba_work_after_it():
    code = (
        f"{RESPOND}; import numpy as np, scipy.linalg; from numba import njit;"
        "print(scipy.linalg.det(np.eye(2)), njit(lambda a, b: np.dot(a, b))(np.eye(2), np.eye(2))[1, 1])"
    )
    assert run(code) == ["1.0", "1.0"]


@pytest.mark.parametrize("start", ["import scipy.linalg", "import threading; threading.Thread(target=wait).start()"])
def test_where_scipy_is_there_or_other_threads_run_it_is_left_alone(start):
    lines = ["import sys, time", "wait = lambda: time.sleep(2)", start, RESPOND, "print('scipy.linalg' in sys.modules)"]
    assert run("\n".join(lines)) == ["True"]
