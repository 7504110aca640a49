"""Make what is released, and try it as a stranger would: `make release`.

Builds the source distribution into dist/, and from it a wheel for each kind of system, with its kernels alone, and one
for any other, without kernels; checks their metadata, and which one pip takes where. Installs that for this system in
an empty environment in a temporary folder, and runs there what README.md shows, on copies of examples/. That without
kernels has to give the same numbers, and to say that it is slow.
"""

from __future__ import annotations

import json
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

from rocking_cli.dynamics.shipped import FOR_ALL, FOR_PAGES, LIBRARIES

PROJECT = Path(__file__).resolve().parents[1]
DIST = PROJECT / "dist"
WRITTEN = {"--plot", "--out", "-o", ">"}  # what follows one of these is there afterwards
TOOL = [sys.executable, "-m", "wheel"]
PLATFORMS = {
    "darwin-aarch64.dylib": "macosx_11_0_arm64",
    "darwin-x86_64.dylib": "macosx_11_0_x86_64",
    "linux-aarch64.so": "manylinux_2_17_aarch64.musllinux_1_1_aarch64",  # it needs no library of C
    "linux-x86_64.so": "manylinux_2_17_x86_64.musllinux_1_1_x86_64",
    "win32-aarch64.dll": "win_arm64",
    "win32-x86_64.dll": "win_amd64",
}
"""The platforms of a wheel with one library."""
HISTORY = ["respond", "examples/block.yaml", "--record", "examples/accel.csv", "--neighbours", "0", "--json"]
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


def run(words: list[str | Path], folder: Path, into: Path | None = None, warned: str = "") -> str:
    """What a command prints, on a file if there is one; a command that fails, or does not warn of this, ends it all."""
    environment = {name: value for name, value in os.environ.items() if name not in FOREIGN}
    began = monotonic()
    done = subprocess.run(
        [str(word) for word in words], cwd=folder, env=environment, check=False, capture_output=True,
        encoding="utf-8", errors="replace",
    )  # fmt: skip
    if done.returncode:
        raise SystemExit(f"exit code {done.returncode} of {shlex.join(map(str, words))}\n{done.stdout}{done.stderr}")
    if warned not in done.stderr:
        raise SystemExit(f"{shlex.join(map(str, words))} does not say {warned!r}\n{done.stderr}")
    if into is not None:
        into.write_text(done.stdout, encoding="utf-8")
    print(f"{monotonic() - began:5.1f} s  {shlex.join([Path(words[0]).name, *map(str, words[1:])])}", flush=True)
    return done.stdout


def with_library(wheel: Path, library: str | None, to: Path) -> Path:
    """Make a wheel with one library of a system, or none, of that with all; its manifest lists what is in it."""
    with TemporaryDirectory() as folder:
        run([*TOOL, "unpack", "--dest", folder, wheel], PROJECT)
        (content,) = Path(folder).iterdir()
        manifest = content / "rocking_cli" / "dynamics" / "ready" / "manifest.json"
        listed = json.loads(manifest.read_text(encoding="utf-8"))
        for name in [each for each in listed["files"] if each not in (library, FOR_PAGES)]:
            manifest.with_name(name).unlink()
            del listed["files"][name]
        manifest.write_text(json.dumps(listed, indent=1) + "\n", encoding="utf-8")
        if library is not None:
            (metadata,) = content.glob("*.dist-info/WHEEL")
            lines = metadata.read_text(encoding="utf-8")
            metadata.write_text(lines.replace("Purelib: true", "Purelib: false"), encoding="utf-8", newline="\n")
        run([*TOOL, "pack", "--dest-dir", folder, content], PROJECT)
        if library is not None:
            run([*TOOL, "tags", "--remove", "--platform-tag", PLATFORMS[library], *Path(folder).glob("*.whl")], PROJECT)
        (made,) = Path(folder).glob("*.whl")
        return Path(shutil.copy(made, to))


def taken(platform: str | None, to: Path) -> str:
    """The name of the wheel of dist/ that pip takes for a platform, or here."""
    where = [] if platform is None else ["--platform", platform]
    shutil.rmtree(to, ignore_errors=True)
    run([sys.executable, "-m", "pip", "download", "--quiet", "--no-deps", "--no-index", "--only-binary", ":all:",
         "--find-links", DIST, "--dest", to, *where, "rocking-cli"], PROJECT)  # fmt: skip
    return next(to.iterdir()).name


def built() -> tuple[Path, Path, str]:
    """The wheel for this system, that for any, and their version, after metadata and names were found right."""
    shutil.rmtree(DIST, ignore_errors=True)
    with TemporaryDirectory() as folder:
        run([sys.executable, "-m", "build", "--outdir", folder, PROJECT], PROJECT)  # the wheel from the source
        (whole,) = Path(folder).glob("*.whl")
        DIST.mkdir()
        shutil.copy(next(Path(folder).glob("*.tar.gz")), DIST)
        wheels = {library: with_library(whole, library, DIST) for library in (*LIBRARIES, None)}
        run([sys.executable, "-m", "twine", "check", "--strict", *sorted(DIST.iterdir())], PROJECT)
        for library, wheel in wheels.items():
            for platform in PLATFORMS[library].split(".") if library else ["linux_riscv64"]:
                if (name := taken(platform, Path(folder) / "taken")) != wheel.name:
                    raise SystemExit(f"for {platform}, pip takes {name}")
        here = DIST / taken(None, Path(folder) / "taken")
    version = tomllib.loads((PROJECT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["version"]
    return here, wheels[None], version


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


def installed(wheel: Path, environment: Path) -> tuple[Path, Path]:
    """Install a wheel in an empty environment; its `python` and `rocking`."""
    run([sys.executable, "-m", "venv", environment], environment.parent)
    bin_, suffix = environment / ("Scripts" if os.name == "nt" else "bin"), ".exe" if os.name == "nt" else ""
    python = bin_ / f"python{suffix}"
    run([python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", wheel], environment.parent)
    run([python, "-m", "pip", "check"], environment.parent)
    return python, bin_ / f"rocking{suffix}"


def tried(wheel: Path, version: str, folder: Path) -> tuple[int, str]:
    """Install the wheel and run what the README shows; how many commands, and a history in JSON."""
    environment, place = folder / "environment", folder / "place"
    python, rocking = installed(wheel, environment)
    shutil.copytree(PROJECT / "examples", place / "examples", ignore=shutil.ignore_patterns("*.runs", "__pycache__"))
    (place / "records").mkdir()
    at2(place / "examples" / "accel.csv", place / "records" / "accel.AT2")
    where = run([python, "-c", "import rocking_cli; print(rocking_cli.__file__)"], place).strip()
    if environment.resolve() not in Path(where).resolve().parents:
        raise SystemExit(f"not what was installed is run, but {where}")
    if (stated := run([rocking, "--version"], place).split()[-1]) != version:
        raise SystemExit(f"it says version {stated}, and pyproject.toml {version}")
    asked = "from rocking_cli.dynamics import shipped; print(shipped.place(), *shipped.FUNCTIONS, sep=chr(10))"
    library, *functions = run([python, "-c", asked], place).splitlines()
    if under_musl(Path(library), functions, folder) is None:
        print(f"no musl-gcc here: {Path(library).name} was not tried under musl")
    readme = (PROJECT / "README.md").read_text(encoding="utf-8")
    lines = commands(readme)
    for words in lines:
        into = place / words[-1] if ">" in words else None
        run([rocking, *(words[1:-2] if into else words[1:])], place, into)
        missing = [name for name in written(words) if not (place / name).exists()]
        if missing:
            raise SystemExit(f"{shlex.join(words)} wrote no {', '.join(missing)}")
    (place / "many.py").write_text(script(readme), encoding="utf-8")
    run([python, "many.py"], place)
    return len(lines), run([rocking, *HISTORY], place)


def without_kernels(wheel: Path, history: str, folder: Path) -> None:
    """Install the wheel for any system: the same history, slowly, which it says."""
    _, rocking = installed(wheel, folder / "slow")
    if run([rocking, *HISTORY], folder / "place", warned=FOR_ALL) != history:
        raise SystemExit(f"{wheel.name} computes other numbers")
    if FOR_ALL not in json.loads(run([rocking, "info", "--json"], folder / "place"))["slow_kernels"]:
        raise SystemExit("`rocking info` does not say that there are no kernels")


def main() -> None:
    """Build, check, install and try."""
    wheel, slow, version = built()
    with TemporaryDirectory(ignore_cleanup_errors=True) as folder:  # Windows keeps what is loaded
        count, history = tried(wheel, version, Path(folder))
        without_kernels(slow, history, Path(folder))
    print(f"{count} commands of the README ran; in dist: {', '.join(each.name for each in sorted(DIST.iterdir()))}")


if __name__ == "__main__":
    main()
