"""Kernels that are shipped as LLVM bitcode: from the file in `ready` to a function of this processor.

`scripts/make_kernels.py` writes the files. The machine code made of one is kept in the user's cache folder, by
processor, versions and content; where it cannot be kept each process makes it again, in some tenths of a second.
Whatever is wrong, with the files, the cache or llvmlite, is a reason to use another way, never an end of the process.
"""

from __future__ import annotations

import ctypes
import functools
import hashlib
import json
import os
import platform
import struct
import sys
import tempfile
import threading
from contextlib import suppress
from pathlib import Path
from typing import Any

from rocking_cli.dynamics.calling import Entry, KernelSet
from rocking_cli.dynamics.compiled import cache_folder

FOLDER = Path(__file__).with_name("ready")
MANIFEST = "manifest.json"
SOURCES = ("calling.py", "kernels.py", "pulse_motion.py")
"""The files of this folder that the shipped kernels are made of."""
MADE_BY = {"numba": "0.61.2", "llvmlite": "0.44.0"}
"""The versions that make them; older ones of llvmlite could not read what newer ones write."""
FORMAT = 1  # of the files in the cache

LIBRARY = ("asin", "cos", "cosh", "expm1", "log", "log1p", "pow", "sin", "sinh", "sqrt")
"""Functions of C that kernels may call."""
INTRINSICS = ("ceil", "cos", "fabs", "floor", "log", "pow", "sin", "sqrt")
"""The functions that LLVM knows itself; of some of them it makes a call."""
NO_CALLS = (
    "llvm.lifetime.", "llvm.memcpy.", "llvm.memset.", "llvm.smax.", "llvm.smin.", "llvm.umax.", "llvm.umin.",
    "llvm.uadd.with.overflow.", "llvm.usub.with.overflow.", "llvm.abs.", "llvm.assume",
)  # fmt: skip
"""Beginnings of the names of what LLVM turns into instructions, or into calls of memory functions."""
MEMORY = ("memcpy", "memset")


class Unusable(Exception):
    """Why a shipped kernel cannot be used."""


def symbol(name: str) -> str:
    """The name of the function of a set in its file."""
    return f"rocking_{name}"


def source_hash() -> str:
    """What the sources of the shipped kernels are known by, whatever ends their lines."""
    digest = hashlib.sha256(repr(sorted(MADE_BY.items())).encode())
    for name in SOURCES:
        digest.update(b"\0" + Path(__file__).with_name(name).read_bytes().replace(b"\r\n", b"\n"))
    return digest.hexdigest()


def needed(module: Any, name: str) -> list[str]:
    """The functions of C that a module of LLVM calls.

    Raises
    ------
    Unusable
        If it declares anything else: a call of what is not there would end the process.
    """
    calls: set[str] = set()
    own = [each for each in module.functions if not each.is_declaration]
    others = [each.name for each in module.functions if each.is_declaration]
    others += [each.name for each in module.global_variables if each.is_declaration]
    for other in others:
        word = other.removeprefix("llvm.").removesuffix(".f64")
        if other in LIBRARY:
            calls.add(other)
        elif other == f"llvm.{word}.f64" and word in INTRINSICS:
            calls.add(word)
        elif not other.startswith(NO_CALLS):
            raise Unusable(f"the kernel {name} calls {other}, which it must not")
    if [each.name for each in own if each.linkage.name == "external"] != [symbol(name)]:
        raise Unusable(f"the kernel {name} has other entries than {symbol(name)}")
    return sorted(calls)


@functools.cache
def manifest() -> dict[str, Any]:
    """What is shipped: hashes of the sources and of the files, and the versions that made them."""
    try:
        found = json.loads((FOLDER / MANIFEST).read_text(encoding="utf-8"))
        return {"source": str(found["source"]), "made_by": dict(found["made_by"]), "files": dict(found["files"])}
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise Unusable(f"{FOLDER / MANIFEST} cannot be read: {error}") from error


def bitcode(name: str) -> bytes:
    """The file of a set. Raises `Unusable` if it is not the one that was shipped."""
    try:
        content = (FOLDER / f"{name}.bc").read_bytes()
    except OSError as error:
        raise Unusable(f"the kernel {name} is missing: {error}") from error
    if hashlib.sha256(content).hexdigest() != manifest()["files"].get(name):
        raise Unusable(f"the kernel {name} is damaged")
    return content


@functools.cache
def _llvm() -> Any:
    """Load llvmlite, once."""
    if struct.calcsize("P") != 8 or sys.byteorder != "little":
        raise Unusable("the shipped kernels are for 64-bit processors with the lowest byte first")
    try:
        import llvmlite.binding as llvm

        with suppress(RuntimeError):  # newer versions do it themselves, and refuse
            llvm.initialize()
        llvm.initialize_native_target()
        llvm.initialize_native_asmprinter()
    except Exception as error:  # whatever a library raises that does not fit this system
        raise Unusable(f"llvmlite cannot be loaded: {error}") from error
    return llvm


@functools.cache
def _processor() -> tuple[str, str]:
    """Name and features of this processor, as LLVM has them."""
    llvm = _llvm()
    try:
        features = llvm.get_host_cpu_features().flatten()
    except RuntimeError:  # LLVM does not know them on every system
        features = ""
    return llvm.get_host_cpu_name(), features


def _key(name: str) -> str:
    """What machine code of a set is known by: whatever could make it another."""
    import llvmlite

    versions = (FORMAT, llvmlite.__version__, _llvm().llvm_version_info, platform.machine(), sys.platform)
    what = (name, manifest()["files"].get(name), versions, _processor())
    return hashlib.sha256(repr(what).encode()).hexdigest()


def place(name: str) -> Path:
    """Where the machine code of a set is kept."""
    return cache_folder() / f"{name}-{_key(name)[:16]}.machine"


def is_usable() -> bool:
    """Whether there are shipped kernels, and what turns them into machine code."""
    try:
        return bool(_llvm() and manifest())
    except Unusable:
        return False


def is_kept(name: str) -> bool:
    """Whether the machine code of a set is in the cache; damaged code counts."""
    try:
        return place(name).is_file()
    except (Unusable, OSError):
        return False


def _kept(name: str) -> bytes | None:
    """Machine code from the cache; None if there is none, or something else."""
    try:
        content = place(name).read_bytes()
    except OSError:
        return None
    digest, code = content[:32], content[32:]
    return code if digest == hashlib.sha256(_key(name).encode() + code).digest() else None


def _keep(name: str, code: bytes) -> None:
    """Put machine code into the cache at once or not at all; without a cache it is made again."""
    at = place(name)
    temporary = None
    try:
        at.parent.mkdir(parents=True, exist_ok=True)
        handle, temporary = tempfile.mkstemp(dir=at.parent, prefix=f"{at.name}.")
        with os.fdopen(handle, "wb") as file:
            file.write(hashlib.sha256(_key(name).encode() + code).digest() + code)
        Path(temporary).replace(at)
    except OSError:
        if temporary is not None:
            with suppress(OSError):
                Path(temporary).unlink()


def _target_machine(llvm: Any) -> Any:
    triple = llvm.get_process_triple()
    if sys.platform == "win32":
        triple += "-elf"  # the only format that LLVM loads without the run-time library of the compiler
    cpu, features = _processor()
    # The choices of numba, so that both make the same code.
    intel = platform.machine().lower() in ("x86_64", "amd64")
    return llvm.Target.from_triple(triple).create_target_machine(
        cpu=cpu, features=features, opt=3, reloc="static" if intel else "default", codemodel="jitdefault", jit=True
    )


def _supply(llvm: Any, name: str, functions: list[str]) -> None:
    """See that functions of C are found: LLVM would end the process where one is not."""
    library = ctypes.CDLL("ucrtbase") if sys.platform == "win32" else ctypes.CDLL(None)
    for function in functions:
        if llvm.address_of_symbol(function) is None:
            found = getattr(library, function, None)
            if found is None:
                raise Unusable(f"the kernel {name} needs {function}, which is not found")
            llvm.add_symbol(function, ctypes.cast(found, ctypes.c_void_p).value)


def machine_code(name: str, content: bytes) -> bytes:
    """Make machine code of a file."""
    llvm = _llvm()
    machine = _target_machine(llvm)
    module = llvm.parse_bitcode(content)
    # No pass of the optimiser: numba ran them all, and what they leave only has to be put into instructions.
    module.triple, module.data_layout = machine.triple, str(machine.target_data)
    module.verify()
    needed(module, name)
    return bytes(machine.emit_object(module))


def _linked(name: str, code: bytes) -> Entry:
    """The function of machine code; it and what it needs stay for the life of the process."""
    llvm = _llvm()
    machine = _target_machine(llvm)
    holder = llvm.parse_assembly("")
    holder.triple, holder.data_layout = machine.triple, str(machine.target_data)
    engine = llvm.create_mcjit_compiler(holder, machine)
    engine.add_object_file(llvm.ObjectFileRef.from_data(code))
    engine.finalize_object()
    address = engine.get_function_address(symbol(name))
    if not address:
        raise Unusable(f"the kernel {name} has no {symbol(name)}")
    _ENGINES.append(engine)
    rows = (ctypes.POINTER(ctypes.c_int64), ctypes.POINTER(ctypes.c_double), ctypes.POINTER(ctypes.c_int64))
    return ctypes.CFUNCTYPE(ctypes.c_int32, *rows)(address)


_ENGINES: list[Any] = []
_LOADED: dict[str, Entry | Unusable] = {}
_LOADING = threading.Lock()


def load(kernel: KernelSet) -> Entry:
    """The function of a set. Raises `Unusable` if it cannot be had."""
    found = _LOADED.get(kernel.name)
    if found is None:
        with _LOADING:
            found = _LOADED.get(kernel.name)
            if found is None:
                try:
                    found = _load(kernel.name)
                except Unusable as error:
                    found = error
                except Exception as error:  # of llvmlite, which raises errors of many kinds
                    found = Unusable(f"the kernel {kernel.name} cannot be loaded: {error}")
                _LOADED[kernel.name] = found
    if isinstance(found, Unusable):
        raise found
    return found


def forget() -> None:
    """Load anew what is asked for next, for tests."""
    _LOADED.clear()


def _load(name: str) -> Entry:
    _supply(_llvm(), name, [*LIBRARY, *MEMORY])
    code = _kept(name)
    if code is None:
        code = machine_code(name, bitcode(name))
        _keep(name, code)
    return _linked(name, code)
