"""Kernels shipped as machine code, one library in the folder `ready` for each kind of system.

`scripts/make_kernels.py` writes the libraries. A library depends on no other one: when it is loaded, it is given the
addresses of the C functions that kernels call. These are the functions of this process, so that every way to run a
kernel uses the same ones. If a library cannot be used, the kernels are run in another way.
"""

from __future__ import annotations

import ctypes
import functools
import hashlib
import json
import platform
import struct
import sys
import threading
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from rocking_cli.dynamics.calling import ARRAYS, FUNCTIONS, SETS, KernelSet, Layout, symbol

FOLDER = Path(__file__).with_name("ready")
MANIFEST = "manifest.json"
SOURCES = ("calling.py", "kernels.py", "pulse_motion.py")
"""The files of this folder that the shipped kernels are made of."""
MADE_BY = {"numba": "0.61.2", "llvmlite": "0.44.0", "ziglang": "0.17.1"}
"""The versions that make them."""

ENDINGS = {"linux": "so", "darwin": "dylib", "win32": "dll"}
PROCESSORS = {"amd64": "x86_64", "arm64": "aarch64"}
"""Other names of processors."""
LIBRARIES = (
    "darwin-aarch64.dylib", "darwin-x86_64.dylib", "linux-aarch64.so", "linux-x86_64.so", "win32-x86_64.dll"
)  # fmt: skip
"""The libraries that belong to the package."""
_ROWS = (ctypes.POINTER(ctypes.c_int64), ctypes.POINTER(ctypes.c_double), ctypes.POINTER(ctypes.c_int64))
_LOADING = threading.Lock()


class Unusable(ImportError):
    """Error: a shipped kernel cannot be used, with the reason."""


class Broken(Unusable):
    """Error: the kernels for this system, which belong to the package, are damaged or missing, or do not load."""


def source_hash() -> str:
    """Return the hash of the sources of the shipped kernels, independent of their line endings."""
    digest = hashlib.sha256(repr(sorted(MADE_BY.items())).encode())
    for name in SOURCES:
        digest.update(b"\0" + Path(__file__).with_name(name).read_bytes().replace(b"\r\n", b"\n"))
    return digest.hexdigest()


def manifest() -> dict[str, Any]:
    """Return the manifest of the shipped kernels: hashes of sources and libraries, and versions of the build tools."""
    try:
        found = json.loads((FOLDER / MANIFEST).read_text(encoding="utf-8"))
        return {"source": str(found["source"]), "made_by": dict(found["made_by"]), "files": dict(found["files"])}
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise Broken(f"{FOLDER / MANIFEST} cannot be read, reinstall rocking-cli: {error}") from error


def place() -> Path:
    """Return the path of the library for this system, which may not exist."""
    machine = platform.machine().lower()
    ending = ENDINGS.get(sys.platform, "so")
    return FOLDER / f"{sys.platform}-{PROCESSORS.get(machine, machine)}.{ending}"


def is_there() -> bool:
    """Return whether the library for this system exists, damaged or not."""
    try:
        return place().is_file()
    except OSError:  # a folder that may not be read
        return False


def is_broken() -> bool:
    """Return whether the kernels for this system, which belong to the package, cannot be used."""
    try:
        for each in SETS.values():
            load(each)
    except ImportError as error:
        return isinstance(error, Broken)
    return False


@functools.cache
def load(kernel: KernelSet) -> Any:
    """Return the function of a kernel. Raises `Unusable` if its library cannot be used."""
    with _LOADING:
        try:
            return ctypes.CFUNCTYPE(ctypes.c_int32, *_ROWS)((symbol(kernel.name), _library()))
        except (AttributeError, OSError, ValueError) as error:  # whatever the system says of a library
            raise Broken(f"{place()} cannot be loaded, reinstall rocking-cli: {error}") from error


def forget() -> None:
    """Forget the loaded libraries, for tests."""
    load.cache_clear()
    _library.cache_clear()


@functools.cache
def _library() -> ctypes.CDLL:
    """Load the library for this system, and give it the C functions that it calls."""
    at = place()
    listed = manifest()["files"].get(at.name)
    if struct.calcsize("P") != 8 or at.name not in LIBRARIES:
        raise Unusable(f"no kernels are shipped for {at.stem}")
    if not is_there():
        raise Broken(f"{at} is missing, reinstall rocking-cli")
    # The system would load half a file as well, and end the process in the missing half.
    if hashlib.sha256(at.read_bytes()).hexdigest() != listed:
        raise Broken(f"{at} is damaged, reinstall rocking-cli")
    library = ctypes.CDLL(str(at))
    c = ctypes.CDLL("ucrtbase" if sys.platform == "win32" else None)
    for name in FUNCTIONS:
        address = ctypes.cast(getattr(c, name), ctypes.c_void_p).value
        ctypes.c_void_p.in_dll(library, symbol(name)).value = address
    return library


def call(entry: Any, kernel: KernelSet, arguments: Sequence[Any]) -> None:
    """Call a shipped kernel.

    Raises
    ------
    TypeError
        If an array does not have the type or the layout that the code requires, so that it would read other memory.
    RuntimeError
        If the code reports an error.
    """
    whole: list[int] = []
    real: list[float] = []
    places: list[int] = []
    _pack(kernel.arguments, arguments, whole, real, places)
    status = entry(
        (ctypes.c_int64 * len(whole))(*whole),
        (ctypes.c_double * len(real))(*real),
        (ctypes.c_int64 * len(places))(*places),
    )
    if status:
        raise RuntimeError(f"the kernel {kernel.name} ended with status {status}")


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
            # The quickest way to an address, of which there are forty in each call.
            places.append(ctypes.addressof(ctypes.c_char.from_buffer(value)) if value.size else 0)
            whole += value.shape
