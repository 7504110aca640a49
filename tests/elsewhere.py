"""Run the tests of fits, studies and linkages as other machines would: `python -m tests.elsewhere kernels versions`.

Other processors round the last bits of linear algebra otherwise, and other versions of Python bring other libraries.
What this machine cannot run is said and left out.
"""

import os
import platform
import subprocess
import sys
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from time import monotonic

from tests.conftest import PROJECT

KERNELS = ("Haswell", "SkylakeX", "Prescott")  # of OpenBLAS, which numpy and scipy use on these processors
VERSIONS = ("3.11", "3.12", "3.13", "3.14")
ROUNDED = [
    f"tests/{folder}/test_{name}.py"
    for folder, names in {
        "io": ("json_text",),
        "mechanisms": ("assembly", "assembly_limit", "linkage"),
        "questions/equivalent_pulses": ("equivalent_pulses",),
        "questions/fragility": (
            "distributions", "fragility_curves", "fragility_pictures", "hazard", "observed", "study_file", "study_runs",
        ),
        "questions/spectrum": ("spectrum",),
    }.items()
    for name in names
]  # fmt: skip
# They take long, and rest on random numbers or on processes rather than on rounding: once is enough.
ONCE = "TestCoverage or killed or interrupted or cluster or while_it_runs or hold_at_their_rate"
FIRST = "not (rest or again)"  # what other libraries do otherwise, one case of each test shows; rounding needs them all
NEEDED = ["hypothesis", "pytest", "statsmodels"]  # besides the package


def tests(*python: str, only: str = "", **environment: str) -> subprocess.CompletedProcess[str]:
    """The tests of fits, studies and linkages by a Python: those `only` of these markers."""
    command = [*python, "-m", "pytest", "-q", "-p", "no:cacheprovider", "-k", f"not ({ONCE})", "-m", only, *ROUNDED]
    return subprocess.run(
        command, cwd=PROJECT, env={**os.environ, **environment}, check=False, encoding="utf-8", errors="replace",
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
    )  # fmt: skip


def under_kernel(name: str) -> tuple[str, int, str]:
    """Run the tests with a kernel: what was run, an exit code, and what there is to say."""
    what = f"kernel {name}"
    if platform.machine().lower() not in ("x86_64", "amd64"):
        return what, 0, f"left out: it is none of {platform.machine()}"
    trial = "import numpy; numpy.linalg.inv(numpy.eye(64) + 1)"
    environment = {**os.environ, "OPENBLAS_CORETYPE": name}
    if subprocess.run([sys.executable, "-c", trial], env=environment, capture_output=True).returncode:
        return what, 0, "left out: this processor does not have its instructions"
    done = tests(sys.executable, OPENBLAS_CORETYPE=name)
    return what, done.returncode, done.stdout


def under_version(version: str) -> tuple[str, int, str]:
    """Run the tests with a version of Python, in an environment of its own that uv keeps; as `under_kernel`."""
    what = f"Python {version}"
    if version == platform.python_version().rpartition(".")[0]:
        return what, 0, "left out: it is the one that runs all tests"
    uv = [sys.executable, "-m", "uv"]
    pyenv = Path(os.environ.get("PYENV_ROOT", Path.home() / ".pyenv"))  # whose shims hide its versions from uv
    python = str(next(pyenv.glob(f"versions/{version}.*/bin/python"), version))
    find = [*uv, "python", "find", "--system", "--no-python-downloads", python]
    if subprocess.run(find, capture_output=True).returncode:
        return what, 0, "left out: it is not installed here"
    packages = [f"--with-editable={PROJECT}[cluster,parquet]", *(f"--with={each}" for each in NEEDED)]
    held = str(PROJECT / "constraints.txt")
    done = tests(
        *uv,
        "run",
        "--no-project",
        "--isolated",
        "--python",
        python,
        *packages,
        "python",
        only=FIRST,
        UV_CONSTRAINT=held,
    )
    return what, done.returncode, done.stdout


def main(suites: list[str]) -> int:
    """Run the requested suites, as many at a time as there are processors; return 1 if any of them fails."""
    known: dict[str, list[Callable[[], tuple[str, int, str]]]] = {
        "kernels": [lambda name=name: under_kernel(name) for name in KERNELS],
        "versions": [lambda version=version: under_version(version) for version in VERSIONS],
    }
    if not suites or not set(suites) <= set(known):
        print(f"give {' or '.join(known)}", file=sys.stderr)
        return 2
    began, failed = monotonic(), False
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        for what, code, said in pool.map(lambda job: job(), [job for each in suites for job in known[each]]):
            failed |= code != 0
            last = said.strip().splitlines()[-1:]
            print(f"{what}: {said if code else ''.join(last)}", flush=True)
    print(f"{monotonic() - began:.0f} s")
    return int(failed)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
