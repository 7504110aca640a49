"""Damage to record files: one character lost, and worse; what is said of it. `make damage` prints the table."""

import os
import sys
import tempfile
from collections import Counter
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from rocking_cli.ask.read import read_record
from rocking_cli.errors import InputError
from rocking_cli.excitation.doubts import doubts
from rocking_cli.excitation.measures import measure
from tests.conftest import FORMATS, RECORDS

OUTCOMES = ("refused", "doubted", "same", "silent")
MOST_SILENT = 0.05


class Kind(NamedTuple):
    """A real file: how it is read, and the first and the last line of its accelerations."""

    options: Mapping[str, Any]
    first: int
    last: int | None = None


G_OF = {"units": "g"}
REAL = {
    RECORDS / "Rinaldi228.AT2": Kind({}, 5),
    RECORDS / "Rinaldi318.AT2": Kind({}, 5),
    RECORDS / "RinaldiUP.AT2": Kind({}, 5),
    RECORDS / "RSN6_IMPVALL.I_I-ELC180.AT2": Kind({}, 5),
    RECORDS / "RSN77_SFERN_PUL164.AT2": Kind({}, 5),
    RECORDS / "elCentro.AT2": Kind({}, 5),
    RECORDS / "elcentro_NS_full_2col.dat": Kind(G_OF, 1),
    RECORDS / "SimCenter_Rinaldi.json": Kind({}, 6, 1996),
    FORMATS / "0111a.smc": Kind({}, 36),
    FORMATS / "017m30lw.s0a": Kind({}, 28),
    FORMATS / "20180212_211557_WPWS_20.V2A": Kind({"channel": "1"}, 27, 606),
    FORMATS / "AOM0011801241951.EW": Kind({}, 18),
    FORMATS / "Cosmos12TimeSeriesTest.v1": Kind({}, 47, 921),
    FORMATS / "HL.DLFA..HNE.D.20190728.160908.C.ACC.ASC": Kind({}, 65),
    FORMATS / "NGNH311106302345.EW1": Kind({}, 18),
    FORMATS / "RSN763_LOMAP_GIL067.AT2": Kind({}, 5),
    FORMATS / "ce36456p_CE36456.V2": Kind({"channel": "1"}, 47, 453),
    FORMATS / "us1000hyfh_akbmrp_AKBMR--n.1000hyfh.BNZ.--.acc.V2c": Kind({}, 54, 42053),
}


class Read(NamedTuple):
    """What is read of a file: its accelerations, its interval, and the kinds of doubts about it."""

    acceleration: np.ndarray
    dt: float
    kinds: frozenset[str]


def read(content: str, folder: Path, options: Mapping[str, Any]) -> Read | InputError:
    """What is read of a file with this content, or why it is refused."""
    path = folder / "record.dat"
    path.write_bytes(content.encode("latin-1"))
    try:
        motion = read_record(path, **options)
        return Read(motion.acceleration, motion.dt, frozenset(each.kind for each in doubts(motion, measure(motion))))
    except InputError as error:
        return error


def outcome(whole: Read, found: Read | InputError) -> str:
    """What became of a damaged file: one of `OUTCOMES`. Doubts that the whole file raises, too, are none of damage."""
    if isinstance(found, InputError):
        return "refused"
    if found.dt == whole.dt and np.array_equal(found.acceleration, whole.acceleration):
        return "same"
    return "doubted" if found.kinds - whole.kinds else "silent"


Change = Callable[[str, int, np.random.Generator], str]
"""Damage the text of the accelerations near a place."""


def lose(text: str, place: int, rng: np.random.Generator) -> str:
    """One character is lost."""
    return text[:place] + text[place + 1 :]


def swap(text: str, place: int, rng: np.random.Generator) -> str:
    """Two characters change places."""
    return text[:place] + text[place : place + 2][::-1] + text[place + 2 :]


def replace(text: str, place: int, rng: np.random.Generator) -> str:
    """The next digit becomes another."""
    while place < len(text) and not text[place].isdecimal():
        place += 1
    return text[:place] + str(rng.integers(10)) + text[place + 1 :]


def lose_line(text: str, place: int, rng: np.random.Generator) -> str:
    """The line is lost."""
    return text[: text.rfind("\n", 0, place) + 1] + text[text.find("\n", place) + 1 :]


def double_line(text: str, place: int, rng: np.random.Generator) -> str:
    """The line is there twice."""
    end = text.find("\n", place) + 1
    return text[:end] + text[text.rfind("\n", 0, place) + 1 : end] + text[end:]


def blank_out(text: str, place: int, rng: np.random.Generator) -> str:
    """Thirty digits from there on become zero."""
    return "".join("0" if k >= place and c.isdecimal() and k < place + 60 else c for k, c in enumerate(text))


CHANGES: dict[str, Change] = {
    "lose": lose, "swap": swap, "replace": replace, "lose_line": lose_line, "double_line": double_line,
    "blank_out": blank_out,
}  # fmt: skip


def survey(
    content: str, kind: Kind, folder: Path, times: int, change: Change = lose, seed: int = 1
) -> tuple[Counter[str], list[str]]:
    """How often each outcome is there when the accelerations of a file are damaged, and the rows of the silent ones."""
    whole = read(content, folder, kind.options)
    assert isinstance(whole, Read), whole
    lines = content.splitlines(keepends=True)
    first, last = kind.first - 1, kind.last if kind.last is not None else len(lines)
    head, data, tail = "".join(lines[:first]), "".join(lines[first:last]), "".join(lines[last:])
    rng = np.random.default_rng(seed)
    found: Counter[str] = Counter()
    silent = []
    for place in rng.integers(len(data) - 1, size=times).tolist():
        damaged = change(data, place, rng)
        became = outcome(whole, read(head + damaged + tail, folder, kind.options))
        found[became] += 1
        if became == "silent":
            silent.append(f"{place}: {data[max(place - 20, 0) : place]!r} {data[place : place + 20]!r}")
    return found, silent


def main() -> None:
    """Print the table of all real files: DAMAGE=5000 is how often each is damaged, and by which change."""
    times = int(os.environ.get("DAMAGE", "1000"))
    asked = sys.argv[1:] or ["lose"]
    with tempfile.TemporaryDirectory() as folder:
        for name in asked:
            print(f"{name}, {times} times each:")
            for path, kind in REAL.items():
                if not path.is_file():
                    print(f"  {path.name[:28]:28} is not there (ROCKING_RECORDS)")
                    continue
                found, silent = survey(path.read_bytes().decode("latin-1"), kind, Path(folder), times, CHANGES[name])
                shares = "".join(f"{each} {100 * found[each] / times:5.1f} %  " for each in OUTCOMES)
                print(f"  {path.name[:28]:28} {shares}", flush=True)
                if "SHOW" in os.environ:
                    print("\n".join(f"      {each}" for each in silent[:8]))


if __name__ == "__main__":
    main()
