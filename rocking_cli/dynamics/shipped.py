"""Kernels shipped as machine code, one library in the folder `ready` for each kind of system.

`scripts/make_kernels.py` writes the libraries. A library depends on no other one: when it is loaded, it is given the
addresses of the C functions that kernels call. These are the functions of this process, so that Python, which runs
the kernels if a library cannot be used, calls the same ones. A library for Linux loads under any library of C. Kernels
of lanes are in it once for each level of processors; the bits are the same.
"""

from __future__ import annotations

import ctypes
import functools
import hashlib
import json
import platform
import struct
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from rocking_cli.dynamics.calling import ARRAYS, FUNCTIONS, LEVELS, KernelSet, Layout, symbol
from rocking_cli.errors import BrokenKernels

READY_FOLDER = Path(__file__).with_name("ready")
MANIFEST_FILE = "manifest.json"
SOURCE_FILES = ("calling.py", "kernels.py", "lanes.py", "openings.py", "pulse_motion.py", "rates.py", "stepping.py")
"""Source files of the shipped kernels, in this folder."""
MADE_BY = {"numba": "0.68.1", "llvmlite": "0.50.0", "ziglang": "0.17.1"}
"""Versions of the tools that build the shipped kernels."""

LIBRARY_SUFFIXES = {"linux": "so", "darwin": "dylib", "win32": "dll"}
PROCESSOR_NAMES = {"amd64": "x86_64", "arm64": "aarch64"}
"""Other names of processors, as systems report them."""
LIBRARIES = (
    "darwin-aarch64.dylib", "darwin-x86_64.dylib", "linux-aarch64.so", "linux-x86_64.so", "win32-aarch64.dll",
    "win32-x86_64.dll",
)  # fmt: skip
"""The libraries that belong to the package."""
FOR_PAGES = "wasm.wasm"
"""The library that pages run in a browser, the same for all systems."""
FOR_ALL = "this rocking-cli was installed for any system, without kernels"
_ARGUMENT_TYPES = (ctypes.POINTER(ctypes.c_int64), ctypes.POINTER(ctypes.c_double), ctypes.POINTER(ctypes.c_int64))


def source_hash() -> str:
    """Return the hash of the sources of the shipped kernels, independent of their line endings."""
    digest = hashlib.sha256(repr(sorted(MADE_BY.items())).encode())
    for name in SOURCE_FILES:
        digest.update(b"\0" + Path(__file__).with_name(name).read_bytes().replace(b"\r\n", b"\n"))
    return digest.hexdigest()


def manifest() -> dict[str, Any]:
    """Return the manifest of the shipped kernels: hashes of sources and libraries, and versions of the build tools."""
    try:
        content = json.loads((READY_FOLDER / MANIFEST_FILE).read_text(encoding="utf-8"))
        return {"source": str(content["source"]), "made_by": dict(content["made_by"]), "files": dict(content["files"])}
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise BrokenKernels(f"{READY_FOLDER / MANIFEST_FILE} cannot be read, reinstall rocking-cli: {error}") from error


def place() -> Path:
    """Return the path of the library for this system, which may not exist."""
    machine = platform.machine().lower()
    ending = LIBRARY_SUFFIXES.get(sys.platform, "so")
    return READY_FOLDER / f"{sys.platform}-{PROCESSOR_NAMES.get(machine, machine)}.{ending}"


def for_pages() -> bytes:
    """Return the library that pages run in a browser. Raises `BrokenKernels` if it is missing or damaged."""
    at = READY_FOLDER / FOR_PAGES
    content = at.read_bytes() if at.is_file() else b""
    if hashlib.sha256(content).hexdigest() != manifest()["files"].get(at.name):
        raise BrokenKernels(f"{at} is {'damaged' if content else 'missing'}, reinstall rocking-cli")
    return content


def load(kernel: KernelSet, level: str = LEVELS[-1]) -> Any:
    """Return the function of a kernel, of lanes at a level. Raises `ImportError` if its library cannot be used."""
    name = symbol(kernel.name, level if kernel.lanes else "")
    try:
        return ctypes.CFUNCTYPE(ctypes.c_int32, *_ARGUMENT_TYPES)((name, loaded()))
    except AttributeError as error:
        raise BrokenKernels(f"{place()} is of another version, reinstall rocking-cli: {error}") from error


def levels() -> tuple[str, ...]:
    """Return the levels that this processor and its system have, the highest first. Raises as `load`."""
    highest = loaded().rocking_level()
    return tuple(each for each in LEVELS if int(each[1:]) <= highest)


@functools.cache
def loaded() -> ctypes.CDLL:
    """Load the library for this system, and give it the C functions that it calls. Raises as `load`."""
    at = place()
    listed = manifest()["files"].get(at.name)
    if struct.calcsize("P") != 8 or at.name not in LIBRARIES:
        raise ImportError(f"no kernels are shipped for {at.stem}")
    if listed is None:  # the wheel for all systems lists none
        raise ImportError(f"{FOR_ALL}: the wheel for {at.stem} has them")
    if not at.is_file():
        raise BrokenKernels(f"{at} is missing, reinstall rocking-cli")
    try:
        # The system also loads incomplete files, and then ends the process when it reaches the missing part.
        if hashlib.sha256(at.read_bytes()).hexdigest() != listed:
            raise BrokenKernels(f"{at} is damaged, reinstall rocking-cli")
        library = ctypes.CDLL(str(at))
        c = ctypes.CDLL("ucrtbase" if sys.platform == "win32" else None)
        library.rocking_level.restype = ctypes.c_int32
        for name in FUNCTIONS:
            address = ctypes.cast(getattr(c, name), ctypes.c_void_p).value
            ctypes.c_void_p.in_dll(library, symbol(name)).value = address
    except (AttributeError, OSError, ValueError) as error:  # errors of the system's loader
        raise BrokenKernels(f"{at} cannot be loaded, reinstall rocking-cli: {error}") from error
    return library


def rows_of(kernel: KernelSet, arguments: Sequence[Any]) -> tuple[Any, Any, Any]:
    """Return arguments as the three rows that the code of a kernel reads.

    Raises
    ------
    TypeError
        If an array does not have the type or the layout that the code requires, so that it would read other memory.
    """
    whole: list[int] = []
    real: list[float] = []
    places: list[int] = []
    _pack(kernel.arguments, arguments, whole, real, places)
    return (
        (ctypes.c_int64 * len(whole))(*whole),
        (ctypes.c_double * len(real))(*real),
        (ctypes.c_int64 * len(places))(*places),
    )


def call(entry: Any, kernel: KernelSet, arguments: Sequence[Any]) -> None:
    """Call a shipped kernel. Raises as `rows_of`; `RuntimeError` if the code reports an error."""
    status = entry(*rows_of(kernel, arguments))
    if status:
        raise RuntimeError(f"the kernel {kernel.name} ended with status {status}")


def prepared(entry: Any, kernel: KernelSet, *arguments: Any) -> tuple[Any, Any]:
    """Return the addresses of a kernel and of its rows, for a kernel that calls it, and what keeps them alive."""
    rows = rows_of(kernel, arguments)
    places = [ctypes.cast(entry, ctypes.c_void_p).value, *map(ctypes.addressof, rows)]
    return np.array(places, dtype=np.int64), rows


def _pack(
    layouts: Sequence[Layout], values: Sequence[Any], whole: list[int], real: list[float], places: list[int]
) -> None:
    """Append the addresses, numbers and sizes of arguments to the three lists that the machine code reads."""
    for layout, value in zip(layouts, values, strict=True):
        if isinstance(layout, tuple):
            _pack(layout[1], value, whole, real, places)
        elif layout == "f":
            real.append(value)
        elif layout in ("i", "b"):
            whole.append(value)
        else:
            dtype, axes = ARRAYS[layout]
            if value.dtype != dtype or value.ndim != axes or not value.flags.carray:
                raise TypeError(f"an array for a kernel is {value.dtype} {value.shape}, not a writable {layout}")
            # The fastest expression for an address; each call has forty of them.
            places.append(ctypes.addressof(ctypes.c_char.from_buffer(value)) if value.size else 0)
            whole += value.shape
