"""Make what is released, and try it as a stranger would: `make release`.

Builds the source distribution and from it the wheel into dist/, checks their metadata, installs the wheel in an empty
environment in a temporary folder, and runs there what README.md shows, on copies of examples/.
"""

from __future__ import annotations

import os
import re
import shlex
import shutil
import subprocess
import sys
import tomllib
from itertools import pairwise
from pathlib import Path
from tempfile import TemporaryDirectory
from time import monotonic

PROJECT = Path(__file__).resolve().parents[1]
DIST = PROJECT / "dist"
WRITTEN = {"--plot", "--out", "-o", ">"}  # what follows one of these is there afterwards
FOREIGN = {"PYTHONPATH", "PYTHONHOME", "VIRTUAL_ENV", "COLUMNS"}  # would let the checkout in, or another width


def commands(readme: str) -> list[list[str]]:
    """The words of the command lines that the README shows, without their comments."""
    return [shlex.split(line, comments=True) for line in re.findall(r"^    (rocking .+)$", readme, re.M)]


def script(readme: str) -> str:
    """The lines of Python that the README shows."""
    (found,) = re.findall(r"^    import rocking_cli .*\n(?:(?:    .*)?\n)*", readme, re.M)
    return re.sub(r"^    ", "", found, flags=re.M)


def written(words: list[str]) -> list[str]:
    """The files and folders that a command is asked to write."""
    return [name for option, name in pairwise(words) if option in WRITTEN]


def run(words: list[str | Path], folder: Path, into: Path | None = None) -> str:
    """What a command prints, on a file if there is one; a command that fails ends it all."""
    environment = {name: value for name, value in os.environ.items() if name not in FOREIGN}
    began = monotonic()
    done = subprocess.run(
        [str(word) for word in words], cwd=folder, env=environment, check=False, capture_output=True,
        encoding="utf-8", errors="replace",
    )  # fmt: skip
    if done.returncode:
        raise SystemExit(f"exit code {done.returncode} of {shlex.join(map(str, words))}\n{done.stdout}{done.stderr}")
    if into is not None:
        into.write_text(done.stdout, encoding="utf-8")
    print(f"{monotonic() - began:5.1f} s  {shlex.join([Path(words[0]).name, *map(str, words[1:])])}", flush=True)
    return done.stdout


def built() -> tuple[Path, str]:
    """The wheel, and its version, after the metadata were found right."""
    shutil.rmtree(DIST, ignore_errors=True)
    run([sys.executable, "-m", "build", "--outdir", DIST, PROJECT], PROJECT)  # the wheel from the source distribution
    found = sorted(DIST.iterdir())
    run([sys.executable, "-m", "twine", "check", "--strict", *found], PROJECT)
    (wheel,) = DIST.glob("*.whl")
    return wheel, tomllib.loads((PROJECT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["version"]


def at2(record: Path, to: Path) -> None:
    """A shipped ground motion of two columns, s and g, in the format of PEER: the README has records of a stranger."""
    rows = [line.split(",") for line in record.read_text(encoding="utf-8").splitlines()[1:]]
    step = (float(rows[-1][0]) - float(rows[0][0])) / (len(rows) - 1)
    head = f"PEER\n{to.stem}\nACCELERATION TIME SERIES IN UNITS OF G\nNPTS= {len(rows)}, DT= {step:.4f} SEC\n"
    to.write_text(head + "".join(f"{float(value):.7E}\n" for _, value in rows), encoding="utf-8")


def under_musl(library: Path, functions: list[str], folder: Path) -> list[float] | None:
    """What a shipped library computes under musl, another library of C; None if there is no `musl-gcc` here.

    The functions are those of C that it calls.
    """
    if shutil.which("musl-gcc") is None:
        return None
    run(["musl-gcc", "-O1", PROJECT / "scripts" / "under_musl.c", "-o", folder / "under_musl"], folder)
    return [float(each) for each in run([folder / "under_musl", library, *functions], folder).split()]


def tried(wheel: Path, version: str, folder: Path) -> int:
    """Install the wheel in an empty environment and run what the README shows; how many commands."""
    environment, place = folder / "environment", folder / "place"
    run([sys.executable, "-m", "venv", environment], folder)
    bin_ = environment / ("Scripts" if os.name == "nt" else "bin")
    python, suffix = bin_ / ("python.exe" if os.name == "nt" else "python"), ".exe" if os.name == "nt" else ""
    run([python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", wheel], folder)
    run([python, "-m", "pip", "check"], folder)
    shutil.copytree(PROJECT / "examples", place / "examples", ignore=shutil.ignore_patterns("*.runs", "__pycache__"))
    (place / "records").mkdir()
    at2(place / "examples" / "accel.csv", place / "records" / "accel.AT2")
    where = run([python, "-c", "import rocking_cli; print(rocking_cli.__file__)"], place).strip()
    if environment.resolve() not in Path(where).resolve().parents:
        raise SystemExit(f"not what was installed is run, but {where}")
    if (said := run([bin_ / f"rocking{suffix}", "--version"], place).split()[-1]) != version:
        raise SystemExit(f"it says version {said}, and pyproject.toml {version}")
    asked = "from rocking_cli.dynamics import shipped; print(shipped.place(), *shipped.FUNCTIONS, sep=chr(10))"
    library, *functions = run([python, "-c", asked], place).splitlines()
    if under_musl(Path(library), functions, folder) is None:
        print(f"no musl-gcc here: {Path(library).name} was not tried under musl")
    readme = (PROJECT / "README.md").read_text(encoding="utf-8")
    lines = commands(readme)
    for words in lines:
        into = place / words[-1] if ">" in words else None
        run([bin_ / f"rocking{suffix}", *(words[1:-2] if into else words[1:])], place, into)
        missing = [name for name in written(words) if not (place / name).exists()]
        if missing:
            raise SystemExit(f"{shlex.join(words)} wrote no {', '.join(missing)}")
    (place / "many.py").write_text(script(readme), encoding="utf-8")
    run([python, "many.py"], place)
    return len(lines)


def main() -> None:
    """Build, check, install and try."""
    wheel, version = built()
    with TemporaryDirectory(ignore_cleanup_errors=True) as folder:  # Windows keeps what is loaded
        count = tried(wheel, version, Path(folder))
    print(f"{count} commands of the README ran; in dist: {', '.join(each.name for each in sorted(DIST.iterdir()))}")


if __name__ == "__main__":
    main()
