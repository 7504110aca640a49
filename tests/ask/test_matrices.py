"""Small matrices are worked on by one thread, in commands and in verbs of Python, and what was before is so again."""

import os
import subprocess
import sys

import numpy as np
import pytest
import scipy.linalg  # noqa: F401 - it brings a library of its own
from threadpoolctl import threadpool_info, threadpool_limits

import rocking_cli as rk
from rocking_cli.dynamics.parallel import in_processes
from tests.conftest import EXAMPLES

SOLVERS = ("eigvalsh", "inv", "lstsq", "pinv", "qr", "solve", "svd")
STUDY = {
    "structures": [str(EXAMPLES / "block.yaml")], "records": [{"pulse": f"sine:1g:{T}s"} for T in (0.5, 0.8, 1.1)],
    "method": "stripes", "levels": {"measure": "PGA", "least": 0.2, "most": 1.5, "count": 4},
    "limit_states": ["uplift", "overturning"],
}  # fmt: skip
VERBS = {
    "assembly": lambda: rk.collapse(EXAMPLES / "assembly.yaml"),
    "linkage": lambda: rk.equiv(EXAMPLES / "linkage.yaml"),
    "history of a linkage": lambda: rk.respond(EXAMPLES / "linkage.yaml", EXAMPLES / "accel.csv", neighbours=0),
    "arch": lambda: rk.verify(EXAMPLES / "arch.yaml", site=EXAMPLES / "verify" / "site.yaml"),
    "fits": lambda: rk.fragility(STUDY, store="here.runs", jobs=1),
}
COMMANDS = {
    "assembly": ["collapse", EXAMPLES / "assembly.yaml"],
    "linkage": ["equiv", EXAMPLES / "linkage.yaml"],
    "history of a linkage": ["respond", EXAMPLES / "linkage.yaml", "--record", EXAMPLES / "accel.csv"],
    "arch": ["verify", EXAMPLES / "arch.yaml", "--site", EXAMPLES / "verify" / "site.yaml"],
    "fits": ["fragility", EXAMPLES / "study" / "pedestal.yaml", "--store", "here.runs"],
}


def threads():
    """Of each library of matrices, how many threads it may use."""
    return {each["num_threads"] for each in threadpool_info() if each["user_api"] == "blas"}


@pytest.mark.every(5)
@pytest.mark.parametrize("name", VERBS)
def test_a_verb_solves_its_matrices_by_one_thread(name, monkeypatch):
    during = []
    for solver in SOLVERS:
        solve = getattr(np.linalg, solver)

        def watched(*arguments, solve=solve, **named):
            during.append(threads())
            return solve(*arguments, **named)

        monkeypatch.setattr(np.linalg, solver, watched)
    with threadpool_limits(2, "blas"):
        VERBS[name]()
        assert threads() == {2}
    assert len(during) > 3 and all(each == {1} for each in during)


@pytest.mark.every(5)
@pytest.mark.parametrize("name", COMMANDS)
def test_a_command_solves_its_matrices_by_one_thread(name):
    words = [str(each) for each in COMMANDS[name]]
    code = (
        "import atexit, sys; from threadpoolctl import threadpool_info; from rocking_cli.__main__ import run;"
        "atexit.register(lambda: print({each['num_threads'] for each in threadpool_info()}, file=sys.stderr));"
        f"sys.argv[1:] = {words!r}; run()"
    )
    usual = {key: value for key, value in os.environ.items() if key != "OPENBLAS_NUM_THREADS"}
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, encoding="utf-8", env=usual)
    assert done.returncode == 0 and done.stderr.splitlines()[-1] == "{1}"


def allowed(first, stop):
    """Work of a process: how many threads it may use."""
    return sorted(threads())


@pytest.mark.rest
def test_processes_of_a_survey_do_so_too(monkeypatch):
    monkeypatch.setenv("OPENBLAS_NUM_THREADS", "2")
    assert [each for _, each in in_processes(allowed, 2, 1, 2)] == [[1], [1]]
