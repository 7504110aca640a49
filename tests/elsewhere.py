"""Run the tests that rest on the machine as others would: `python -m tests.elsewhere kernels versions`.

Other processors round the last bits of linear algebra otherwise: all cases of `ROUNDED` are run. Other versions of
Python and of libraries change what calls them: one case of each test of `OF_PYTHON` or of `LIBRARIES` is run. `files`
prints the latter for `make test-newest` and `test-oldest`. What this machine cannot run is said and left out.
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
ROUNDED = {
    "io": "json_text",
    "mechanisms": "assembly assembly_limit linkage",
    "questions/equivalent_pulses": "*",
    "questions/fragility": "distributions fragility_curves hazard observed study_runs",
    "questions/spectrum": "spectrum",
}
"""Tests whose numbers rest on linear algebra, by folder: names of files, or patterns of them."""
OF_PYTHON = ROUNDED | {
    "ask": "*",
    "cli": "made widths",
    "core": "registry structure",
    "io": "files json_text yaml_text",
}
"""Tests that annotations, entry points, texts or shells of other versions of Python may change, too."""
LIBRARIES = OF_PYTHON | {
    "cli": "cli made widths",  # click, rich
    "dynamics": "ready_kernels history_nonlinear contacts_of_free_blocks",  # numpy, scipy, mujoco
    "excitation": "seismo pulse_fit measures",  # obspy, scipy
    "house": "api own_figures pictures",  # pandas, xarray, matplotlib
    "io": "*",  # pyarrow, pillow, calamine, pyyaml
    "io/drawings": "dxf svg",  # ezdxf, shapely
    "mechanisms": "assembly assembly_limit assembly_sparse linkage",  # the linear programmes of scipy
    "processing": "oscillator processing",  # the filters of scipy
    "questions/import_mesh": "*",  # trimesh
    "questions/new": "new_plugin",  # pip, hatchling
    "questions/report": "pages",  # jinja2
    "questions/verify": "sheet_paper mathematics",  # python-docx, typst
    "studies": "free_engine",  # mujoco
}
"""Tests of what libraries do for this package, too."""
# They take long, and rest on random numbers or on processes rather than on rounding: once is enough.
ONCE = "TestCoverage or killed or interrupted or cluster or while_it_runs or hold_at_their_rate"
WHOLE, FIRST = "not (docs or types or kernels)", "not (rest or docs or types or kernels or again)"
NEEDED = ["hatchling", "hypothesis", "pytest", "statsmodels", "uv"]  # besides the package
Ran = tuple[str, int, str]
"""What was run, an exit code, and what there is to say."""


def files(chosen: dict[str, str]) -> list[str]:
    """The files of tests of a choice. Raises `FileNotFoundError` if there is none of a name."""
    places: list[str] = []
    for folder, names in chosen.items():
        for name in names.split():
            matching = sorted((PROJECT / "tests" / folder).glob(f"test_{name}.py"))
            if not matching:
                raise FileNotFoundError(f"tests/{folder}/test_{name}.py")
            places += [file.relative_to(PROJECT).as_posix() for file in matching]
    return places


def run(what: str, chosen: dict[str, str], only: str, *python: str, **environment: str) -> Ran:
    """Run a choice of tests by a Python: those `only` of these markers."""
    words = [*python, "-m", "pytest", "-q", "-p", "no:cacheprovider", "-k", f"not ({ONCE})", "-m", only]
    done = subprocess.run(
        [*words, *files(chosen)], cwd=PROJECT, env={**os.environ, **environment}, check=False, encoding="utf-8",
        errors="replace", stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
    )  # fmt: skip
    return what, done.returncode, done.stdout


def own_kernel() -> str:
    """The kernel of OpenBLAS that this processor uses, which runs all tests."""
    import numpy as np
    from threadpoolctl import threadpool_info

    np.linalg.inv(np.eye(2))
    return next((str(each["architecture"]) for each in threadpool_info() if "architecture" in each), "")


def under_kernel(name: str) -> Ran:
    """Run the tests with a kernel."""
    what = f"kernel {name}"
    if platform.machine().lower() not in ("x86_64", "amd64"):
        return what, 0, f"left out: it is none of {platform.machine()}"
    if name == own_kernel():
        return what, 0, "left out: it is the one that runs all tests"
    trial = "import numpy; numpy.linalg.inv(numpy.eye(64) + 1)"
    environment = {**os.environ, "OPENBLAS_CORETYPE": name}
    if subprocess.run([sys.executable, "-c", trial], env=environment, capture_output=True).returncode:
        return what, 0, "left out: this processor does not have its instructions"
    return run(what, ROUNDED, WHOLE, sys.executable, OPENBLAS_CORETYPE=name)


def under_version(version: str) -> Ran:
    """Run the tests with a version of Python, in an environment of its own that uv keeps."""
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
    words = [*uv, "run", "--no-project", "--isolated", "--python", python, *packages, "python"]
    return run(what, OF_PYTHON, FIRST, *words, UV_CONSTRAINT=str(PROJECT / "constraints.txt"))


def main(suites: list[str]) -> int:
    """Run the requested suites, as many at a time as there are processors; return 1 if any of them fails."""
    if suites == ["files"]:
        print(*files(LIBRARIES))
        return 0
    known: dict[str, list[Callable[[], Ran]]] = {
        "kernels": [lambda name=name: under_kernel(name) for name in KERNELS],
        # What those between the first and the last bring, one of these brings too.
        "versions": [lambda version=version: under_version(version) for version in (VERSIONS[0], VERSIONS[-1])],
    }
    if not suites or not set(suites) <= set(known):
        print(f"give {' or '.join(known)}, or files", file=sys.stderr)
        return 2
    began, failed = monotonic(), False
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        for what, code, output in pool.map(lambda job: job(), [job for each in suites for job in known[each]]):
            failed |= code != 0
            last = output.strip().splitlines()[-1:]
            print(f"{what}: {output if code else ''.join(last)}", flush=True)
    print(f"{monotonic() - began:.0f} s")
    return int(failed)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
