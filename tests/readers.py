"""Spoilt record files of every format, each given to a process of its own.

The tests try a few, `make soak` thousands.
"""

import gzip
import io
import os
import random
import re
import subprocess
import sys
import tempfile
import warnings
import zipfile
from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np

from tests import hostile
from tests.excitation import networks
from tests.excitation.test_record_formats import MADE

MEMORY = 10**9  # bytes of address space of a process, where the system can limit it
PATIENCE = 120.0  # s
JUNK = [each.encode() for each in (*hostile.NUMBERS, *hostile.WORDS)]
COUNTS = 1, 1, 1, 2, 2, 5  # faults in a file
REPEATED = 1, 1, 2, 30, 1000


class Sample(NamedTuple):
    """A good file, and the options it is read with."""

    content: bytes
    options: tuple[str, ...] = ()


@cache
def samples() -> dict[str, Sample]:
    """A small good file for each record reader, and two packed ones; those of obspy only if it is installed."""
    texts = dict(zip([*MADE, "peer_at2", "text", "column"], hostile.records(), strict=True))
    found = {name: Sample(text.encode()) for name, text in texts.items()}
    found["column"] = found["column"]._replace(options=("--dt", "0.01"))
    for name, make in networks.MADE.items():
        found[name] = Sample(make().encode(), ("--channel", "1"))
    found["geonet_v1a"] = Sample(networks.geonet_v1a(names=("N10E",)).encode())
    for name, content in _seismic().items():
        found[name] = Sample(content, ("--units", "g"))
    found["gzip"] = Sample(gzip.compress(found["peer_at2"].content, mtime=0))
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for name in ("peer_at2", "text"):
            archive.writestr(zipfile.ZipInfo(name), found[name].content)
    found["zip"] = Sample(packed.getvalue(), ("--channel", "1"))
    return found


def _seismic() -> dict[str, bytes]:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # obspy's own deprecations
        try:
            import obspy
        except ImportError:
            return {}
        values = np.array([0.0, 0.5, -0.25, 0.75, -1.0, 0.125] * 40, dtype=np.float32)
        found = {}
        forms = {"sac": "SAC", "miniseed": "MSEED", "slist": "SLIST", "gse": "GSE2", "obspy": "AH"}
        for name, form in forms.items():
            samples = (8 * values).astype("i4") if form == "GSE2" else values
            trace = obspy.Trace(samples, {"delta": 0.005, "network": "XX", "station": "STA", "channel": "HNE"})
            path = Path(tempfile.gettempdir()) / f"{os.getpid()}.{name}"  # not all of obspy writes to a buffer
            obspy.Stream([trace]).write(str(path), format=form)
            found[name] = path.read_bytes()
            path.unlink()
    return found


def spoil(content: bytes, rng: random.Random) -> bytes:
    """Put one to five faults into a file."""
    for _ in range(rng.choice(COUNTS)):
        content = rng.choice(FAULTS)(content, rng)
    return content


def _span(content: bytes, rng: random.Random) -> tuple[int, int]:
    """Part of a file, more often short than long."""
    start = rng.randrange(len(content) + 1)
    return start, min(start + int(rng.choice([1, 4, 80, 4000]) * rng.random()) + 1, len(content))


def flip(content: bytes, rng: random.Random) -> bytes:
    changed = bytearray(content)
    for _ in range(rng.choice([1, 1, 4, 32]) if content else 0):
        changed[rng.randrange(len(changed))] ^= 1 << rng.randrange(8)
    return bytes(changed)


def overwrite(content: bytes, rng: random.Random) -> bytes:
    start, end = _span(content, rng)
    return content[:start] + rng.choice([bytes(end - start), rng.randbytes(end - start)]) + content[end:]


def insert(content: bytes, rng: random.Random) -> bytes:
    start, _ = _span(content, rng)
    return content[:start] + rng.choice([*JUNK, rng.randbytes(9)]) + content[start:]


def lose(content: bytes, rng: random.Random) -> bytes:
    start, end = _span(content, rng)
    return content[:start] + content[end:]


def truncate(content: bytes, rng: random.Random) -> bytes:
    return content[: rng.randrange(len(content) + 1)]


def repeat(content: bytes, rng: random.Random) -> bytes:
    start, end = _span(content, rng)
    return content[:end] + content[start:end] * rng.choice(REPEATED) + content[end:]


def lines(content: bytes, rng: random.Random) -> bytes:
    """A line is lost, repeated, exchanged with another, or junk."""
    rows = content.split(b"\n")
    one, other = rng.randrange(len(rows)), rng.randrange(len(rows))
    match rng.randrange(4):
        case 0:
            del rows[one]
        case 1:
            rows[one:one] = [rows[one]] * rng.choice(REPEATED)
        case 2:
            rows[one], rows[other] = rows[other], rows[one]
        case _:
            rows[one] = rng.choice(JUNK)
    return b"\n".join(rows)


def number(content: bytes, rng: random.Random) -> bytes:
    """A number becomes another, or a word: the fault that gets furthest."""
    found = list(re.finditer(rb"[-+]?\d+\.?\d*(?:[eE][-+]?\d+)?", content))
    if not found:
        return insert(content, rng)
    at = rng.choice(found)
    return content[: at.start()] + rng.choice(JUNK) + content[at.end() :]


FAULTS = flip, overwrite, insert, lose, truncate, repeat, lines, number, number, number


def examine(place: Path, *options: str) -> tuple[int, str]:
    """Run `rocking record` on a file in a process with little memory.

    Returns
    -------
    tuple of int and str
        Exit code, and what was printed on standard error.

    Raises
    ------
    AssertionError
        If it hangs, ends with another exit code than 0 or 2 or with a traceback, lets a library warn, prints results
        of a file that it refuses, or does not name that file.
    """
    command = [sys.executable, "-m", "rocking_cli", "record", str(place), *options]
    environment = {**os.environ, "PYTHONWARNINGS": "default", "PYTHONIOENCODING": "utf-8", "OPENBLAS_NUM_THREADS": "1"}
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=environment)
    _limit(process.pid)
    try:
        out, err = process.communicate(timeout=PATIENCE)
    except subprocess.TimeoutExpired:
        process.kill()
        process.communicate()
        raise AssertionError("it hangs") from None
    said = err.decode(errors="replace")
    assert process.returncode in (0, 2), (process.returncode, said)
    assert not re.search(r"Traceback|unexpected error|\w+Warning\b", said), said
    if process.returncode == 2:
        assert not out and place.name in said, said
    else:
        assert out, said
    return process.returncode, said


def _limit(pid: int) -> None:
    """Limit the memory of a process; only Linux can."""
    if sys.platform == "linux":
        import resource

        resource.prlimit(pid, resource.RLIMIT_AS, (MEMORY, MEMORY))


def attack(folder: Path, seed: int) -> str:
    """Spoil a sample in one way and have it read; say which it was, and what became of it.

    Raises
    ------
    AssertionError
        As `examine`, with the seed and the sample.
    """
    name = list(samples())[seed % len(samples())]
    place = folder / f"{name}-{seed}.dat"
    place.write_bytes(spoil(samples()[name].content, random.Random(seed)))
    try:
        code, _ = examine(place, *samples()[name].options)
    except AssertionError as error:
        raise AssertionError(f"{seed}: {name}: {error}") from error
    place.unlink()
    return "read" if code == 0 else "refused"
