"""Run the tests of fits, studies and linkages as other machines would: `python -m tests.elsewhere kernels versions`.

Other processors round the last bits of linear algebra otherwise, and other versions of Python bring other libraries.
What this machine cannot run is said and left out.
"""

from __future__ import annotations

import os
import platform
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from time import monotonic

from tests.conftest import PROJECT

KERNELS = ("Haswell", "SkylakeX", "Prescott")  # of OpenBLAS, which numpy and scipy use on these processors
VERSIONS = ((3, 11), (3, 12), (3, 13), (3, 14))
ROUNDED = [
    f"tests/test_{name}.py"
    for name in (
        "assembly", "assembly_limit", "distributions", "equivalent", "fragility_curves", "fragility_pictures",
        "hazard", "json_text", "linkage", "observed", "spectrum", "study_file", "study_runs",
    )
]  # fmt: skip
# They take long, and rest on random numbers or on processes rather than on rounding: once is enough.
ONCE = "TestCoverage or killed or interrupted or cluster or while_it_runs or hold_at_their_rate"
NEEDED = ["hypothesis", "pytest", "statsmodels"]  # besides the package
HELD = ["--constraint", str(PROJECT / "constraints.txt")]  # not --build-constraint: the pip may be as old as the Python


def tests(python: Path, **environment: str) -> subprocess.CompletedProcess[str]:
    """The tests of fits, studies and linkages by a Python."""
    command = [str(python), "-m", "pytest", "-q", "-p", "no:cacheprovider", "-k", f"not ({ONCE})", *ROUNDED]
    return subprocess.run(
        command, cwd=PROJECT, env={**os.environ, **environment}, check=False, encoding="utf-8", errors="replace",
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
    )  # fmt: skip


def answer(command: list[str], **environment: str) -> str | None:
    """What a command prints; None if it fails or is not there."""
    try:
        done = subprocess.run(
            command, env={**os.environ, **environment}, check=True, capture_output=True, encoding="utf-8"
        )
    except (OSError, subprocess.CalledProcessError):
        return None
    return done.stdout.strip()


def under_kernel(name: str) -> tuple[str, int, str]:
    """Run the tests with a kernel: what was run, an exit code, and what there is to say."""
    what = f"kernel {name}"
    if platform.machine().lower() not in ("x86_64", "amd64"):
        return what, 0, f"left out: it is none of {platform.machine()}"
    trial = "import numpy; numpy.linalg.inv(numpy.eye(64) + 1)"
    if answer([sys.executable, "-c", trial], OPENBLAS_CORETYPE=name) is None:
        return what, 0, "left out: this processor does not have its instructions"
    done = tests(Path(sys.executable), OPENBLAS_CORETYPE=name)
    return what, done.returncode, done.stdout


def interpreters(version: tuple[int, int]) -> Iterator[list[str]]:
    """Where a version of Python may be."""
    name = "python" + ".".join(map(str, version))
    found = shutil.which(name)
    if found is not None:
        yield [found]
    if shutil.which("py") is not None:
        yield ["py", f"-{name.removeprefix('python')}"]
    root = Path(os.environ.get("PYENV_ROOT", Path.home() / ".pyenv"))
    yield from ([str(path)] for path in sorted(root.glob(f"versions/{name.removeprefix('python')}.*/bin/python")))


def under_version(version: tuple[int, int]) -> tuple[str, int, str]:
    """Run the tests with a version of Python, in an environment that is made if it is not there; as `under_kernel`."""
    what = f"Python {version[0]}.{version[1]}"
    if version == sys.version_info[:2]:
        return what, 0, "left out: it is the one that runs all tests"
    shown = "import sys; print(*sys.version_info[:2])"
    known = [each for each in interpreters(version) if answer([*each, "-c", shown]) == f"{version[0]} {version[1]}"]
    if not known:
        return what, 0, "left out: it is not installed here"
    folder = PROJECT / "out" / f"python{version[0]}.{version[1]}"
    python = folder / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
    wanted = ["--editable", f"{PROJECT}[cluster,parquet]", *NEEDED]
    install = [str(python), "-m", "pip", "install", "--quiet", *HELD, *wanted]
    for command in ([*known[0], "-m", "venv", str(folder)], install):
        done = subprocess.run(command, check=False, capture_output=True, encoding="utf-8", errors="replace")
        if done.returncode:
            return what, done.returncode, done.stdout + done.stderr
    done = tests(python)
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
