"""Write the kernels that are shipped, rocking_cli/dynamics/ready: `make kernels`.

    python scripts/make_kernels.py [FOLDER]

Numba writes each set of functions in the language of LLVM. Clang, as Zig has it, makes code of it for each kind of
system, that of lanes once a level of its processors, and Zig, which knows the libraries of all systems, links it. The
versions are pinned, so that the same sources give the same bytes, by one version of Python: Numba reads its bytecode.
"""

from __future__ import annotations

import hashlib
import importlib
import json
import os
import platform
import re
import subprocess
import sys
import tempfile
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from importlib.metadata import version
from multiprocessing import get_context
from pathlib import Path
from typing import Any

PROJECT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(PROJECT))
# Before numba is imported: nothing of this machine may be in what is shipped, and vectors are Clang's to make.
for _name in [each for each in os.environ if each.startswith("NUMBA_")]:
    del os.environ[_name]
os.environ |= {"NUMBA_CPU_NAME": "generic", "NUMBA_CPU_FEATURES": "", "NUMBA_OPT": "1", "NUMBA_LOOP_VECTORIZE": "0"}

import llvmlite.binding as llvm  # noqa: E402
from by_numba import OPTIONS, compiled  # noqa: E402
from llvmlite import ir  # noqa: E402
from numba import njit, types  # noqa: E402
from numba.extending import intrinsic  # noqa: E402
from numba.np.arrayobj import populate_array  # noqa: E402

from rocking_cli.dynamics import shipped  # noqa: E402
from rocking_cli.dynamics.calling import FUNCTIONS, LANES, SETS, STEPS, KernelSet, Layout, symbol  # noqa: E402

# Without numba's runtime: what would allocate memory or count references does not compile.
AHEAD = {"_nrt": False, "no_cpython_wrapper": True, "no_cfunc_wrapper": True}
SYSTEMS = {
    "linux-x86_64.so": "x86_64-linux-musl",
    "linux-aarch64.so": "aarch64-linux-musl",
    "darwin-x86_64.dylib": "x86_64-macos.11.0",
    "darwin-aarch64.dylib": "aarch64-macos.11.0",
    "win32-x86_64.dll": "x86_64-windows-gnu",
    "win32-aarch64.dll": "aarch64-windows-gnu",
    "wasm.wasm": "wasm32-freestanding",
}
"""The libraries, and what Zig calls the systems. Those of Linux need no library of C, so any will do."""
LINKING = {
    ".so": ["-shared", "-Wl,-z,defs"],
    ".dylib": ["-shared", "-Wl,-dead_strip"],
    ".dll": ["-shared", "-Wl,-Brepro"],
    ".wasm": ["-Wl,--no-entry,--export-dynamic,--export-memory,--import-symbols"],
}
"""What the linker needs to be told: that nothing may be missing, which others see to, to keep no time, to import."""
LEVELS = {
    "x86_64": {
        "v1": ("", r"mulpd\s.*%xmm"),
        "v3": ('"target-cpu"="x86-64-v3" "target-features"="" "prefer-vector-width"="256" ', r"mulpd\s.*%ymm"),
        "v4": ('"target-cpu"="x86-64-v4" "target-features"="" "prefer-vector-width"="512" ', r"mulpd\s.*%zmm"),
    },
    "aarch64": {"v1": ("", r"fmul(\.|\s+v\d+\.)2d")},
    "wasm32": {},  # a call by address would need a table of functions: one history at a time
}
"""Levels of each kind of processor, the attributes of functions for them, and the instruction that shows vectors."""
EXACT = ("fabs", "sqrt")  # of IEEE 754: every processor here has instructions for them
FUSED = re.compile(r"^\s+(?:v?fn?m(?:add|sub|la|ls)|\w+\.relaxed)\w*", re.MULTILINE)
"""Instructions that round a product and a sum once."""

ELEMENTS = {"R": types.float64, "I": types.int64}
POINTERS = {kind: types.CPointer(element) for kind, element in ELEMENTS.items()}


def array_of(kind: str) -> Any:
    """A function that makes an array of its address and shape; that of numba needs its runtime."""

    @intrinsic
    def array(context, address, shape):  # type: ignore[no-untyped-def]
        result = types.Array(ELEMENTS[kind], len(shape), "C")

        def make(context, builder, signature, given):  # type: ignore[no-untyped-def]
            made = context.make_array(result)(context, builder)
            size = context.get_constant(types.intp, 8)
            lengths = [builder.extract_value(given[1], k) for k in range(result.ndim)]
            strides = [size]
            for length in reversed(lengths[1:]):
                strides.insert(0, builder.mul(strides[0], length))
            data = builder.inttoptr(given[0], made.data.type)
            populate_array(made, data, lengths, strides, size, meminfo=None)
            return made._getvalue()

        return result(types.int64, shape), make

    return array


@intrinsic
def element(context, row, place):  # type: ignore[no-untyped-def]
    """A number of a row; the place is given in the source."""

    def make(context, builder, signature, given):  # type: ignore[no-untyped-def]
        return builder.load(builder.gep(given[0], [given[1]]))

    return row.dtype(row, place), make


@intrinsic
def call_at(context, address, whole, real, places):  # type: ignore[no-untyped-def]
    """Call the entry of another set, which is at an address, with the addresses of its rows."""

    def make(context, builder, signature, given):  # type: ignore[no-untyped-def]
        kind = ir.FunctionType(ir.IntType(32), [ir.IntType(64).as_pointer()] * 3)
        rows = [builder.inttoptr(each, kind.args[0]) for each in given[1:]]
        return builder.call(builder.inttoptr(given[0], kind.as_pointer()), rows)

    return types.int32(types.int64, types.int64, types.int64, types.int64), make


@njit(**OPTIONS, **AHEAD)
def evaluate(step, rows, pairs, rtol):  # type: ignore[no-untyped-def]
    """In place of `lanes.evaluate`."""
    call_at(step[0], step[1], step[2], step[3])


class Writing:
    """The source of an entry: what each argument of the kernel is, in terms of the three rows."""

    def __init__(self) -> None:
        self.whole = self.real = self.places = 0

    def _next(self) -> str:
        self.whole += 1
        return f"__at(whole, {self.whole - 1})"

    def argument(self, layout: Layout) -> str:
        """One argument."""
        if isinstance(layout, tuple):
            return f"{layout[0]}({', '.join(map(self.argument, layout[1]))})"
        if layout == "i":
            return self._next()
        if layout == "b":
            return f"{self._next()} != 0"
        if layout == "f":
            self.real += 1
            return f"__at(real, {self.real - 1})"
        shape = "".join(f"{self._next()}, " for _ in range(int(layout[1])))
        self.places += 1
        return f"__array_of_{layout[0]}(__at(places, {self.places - 1}), ({shape}))"


def entry_of(kernel: KernelSet) -> Any:
    """The compiled entry of a set, as numba has it."""
    namespace = compiled(importlib.import_module(kernel.module), **AHEAD)
    namespace["evaluate"] = evaluate
    writing = Writing()
    arguments = ", ".join(map(writing.argument, kernel.arguments))
    source = f"def entry(whole, real, places):\n    {kernel.function}({arguments})\n    return 0\n"
    space = {**namespace, "__at": element, "__array_of_R": array_of("R"), "__array_of_I": array_of("I")}
    exec(source, space)
    signature = types.int64(POINTERS["I"], POINTERS["R"], POINTERS["I"])
    return njit(signature, **OPTIONS, **AHEAD)(space["entry"]).overloads[signature.args]


def text_of(kernel: KernelSet) -> str:
    """A set as a module of LLVM, whose only function to be called from outside has the name of the set."""
    compiled = entry_of(kernel)
    module = llvm.parse_assembly(compiled.library.get_llvm_str())
    outer = ir.Module(name=kernel.name)
    outer.triple, outer.data_layout = module.triple, module.data_layout
    whole, status, place = ir.IntType(64), ir.IntType(32), ir.PointerType()
    raised = ir.LiteralStructType([place, status, place, place, status]).as_pointer()
    rows = [place] * 3
    called = ir.Function(outer, ir.FunctionType(status, [place, place, *rows]), compiled.fndesc.llvm_func_name)
    function = ir.Function(outer, ir.FunctionType(status, rows), symbol(kernel.name))
    builder = ir.IRBuilder(function.append_basic_block())
    builder.ret(builder.call(called, [builder.alloca(whole), builder.alloca(raised), *function.args]))
    module.link_in(llvm.parse_assembly(str(outer)))
    for each in (*module.functions, *module.global_variables):
        if not each.is_declaration and each.name != symbol(kernel.name):
            each.linkage = "internal"
    # Clang knows better for which system it is.
    return re.sub(r"^(?:target|source_filename) .*\n", "", str(module), flags=re.MULTILINE)


def versions(kernel: KernelSet, text: str, processor: str) -> dict[str, str]:
    """The modules of a set for a kind of processor: one, or one a level."""
    if not kernel.lanes:
        return {kernel.name: text}
    name = f"@{symbol(kernel.name)}("
    return {
        level: re.sub(r"^(define .*\)[^)]*)\{$", rf"\1{attributes}{{", text, flags=re.MULTILINE).replace(
            name, f"@{symbol(kernel.name, level)}("
        )
        for level, (attributes, _) in LEVELS[processor].items()
    }


def called_by_address(text: str, imported: bool) -> str:
    """A module, as text, whose calls of C go through addresses that are handed to the library, or are imports.

    In memory, Numba has places of 64 bits for addresses. A browser, whose calls are imports, has shorter ones there.

    What LLVM itself puts a call for, `ceil`, `floor` and those of memory, has the name of C within the library; the
    others get one that LLVM does not know, so that it takes no two of them together.
    """
    if fast := re.search(r"= (?:tail )?(?:f\w+|call) (?:fast|reassoc|contract|arcp|afn|nnan|ninf|nsz)\b.*", text):
        sys.exit(f"arithmetic is not that of IEEE 754: {fast[0]}")
    for name in EXACT:
        text = text.replace(f"@{name}(", f"@llvm.{name}.f64(")
    if imported:
        text = re.sub(r"alloca \{.*\}", lambda room: room[0].replace("ptr", "i64"), text)
        text = re.sub(r"  store (\{.*\bptr\b.*\}) (%\S+), ptr (%\S+),.*\n", member_by_member, text)
    for name, types_of in FUNCTIONS.items():
        result, *types_in = types_of.split()
        known = name in ("ceil", "floor", "memcpy", "memset")
        entry = name if known else f"call_{name}"
        if not known:
            text = re.sub(rf"^declare .*@(?:llvm\.{name}\.f64|{name})\(.*\n", "", text, flags=re.MULTILINE)
            text = re.sub(rf"@(?:llvm\.{name}\.f64|{name})\(", f"@{entry}(", text)
        if imported:
            text += "" if known else f"declare {result} @{entry}({', '.join(types_in)})\n"
            continue
        given = [f"{each} %{k}" for k, each in enumerate(types_in)]
        text += f"""
@{symbol(name)} = global ptr null
define {"hidden" if known else "internal"} {result} @{entry}({", ".join(given)}) {{
  %address = load ptr, ptr @{symbol(name)}
  %result = tail call {result} %address({", ".join(given)})
  ret {result} %result
}}
"""
    return text


def member_by_member(store: re.Match[str]) -> str:
    """A store of a structure with addresses in it, as text: its members each at the place that it has for Numba."""
    kind, value, to = store.groups()
    lines, path, at = [], list[int](), 0
    for token in re.findall(r"[{}]|\[\d+ x i64\]|\w+", kind):
        if token == "{":
            path.append(0)
            continue
        if token == "}":
            path.pop()
        else:
            at += 0 if token == "i8" else -at % 8
            member, place = f"{value}.{at}", f"{to}.{at}"
            lines += [
                f"  {member} = extractvalue {kind} {value}, {', '.join(map(str, path))}",
                f"  {place} = getelementptr i8, ptr {to}, i64 {at}",
                f"  store {token} {member}, ptr {place}",
            ]
            at += 1 if token == "i8" else 8 * int(token[1:].partition(" ")[0]) if token[0] == "[" else 8
        path[-1:] = [each + 1 for each in path[-1:]]
    return "\n".join(lines) + "\n"


def library(text: str, name: str) -> bytes:
    """The library of a system. What calls anything that is not in it is refused by the linker."""
    with tempfile.TemporaryDirectory() as folder:
        kind = "-mcpu=generic" if name == "wasm.wasm" else "-fPIC"

        def zig(*arguments: str) -> None:
            command = [sys.executable, "-m", "ziglang", "cc", "-w", "-O3", kind, "-target", SYSTEMS[name]]
            subprocess.run([*command, *arguments], cwd=folder, check=True)

        Path(folder, "kernels.ll").write_text(text, encoding="utf-8")
        zig("-S", "kernels.ll", "-o", "kernels.s")
        code = Path(folder, "kernels.s").read_text(encoding="utf-8")
        if fused := FUSED.search(code):
            sys.exit(f"{name} would round a product and a sum once: {fused[0]}")
        for level, (_, vectors) in LEVELS[SYSTEMS[name].partition("-")[0]].items():
            if not re.search(vectors, code):
                sys.exit(f"{name} would have no vectors at level {level}")
        linked = ("-nostdlib", "-fno-builtin", "-s", *LINKING[Path(name).suffix])
        zig(*linked, "-o", name, "kernels.s", str(PROJECT / "scripts" / "system.c"))
        return Path(folder, name).read_bytes()


def main(folder: Path) -> None:
    """Write the libraries and the manifest."""
    given = {name: version(name) for name in shipped.MADE_BY}
    if given != shipped.MADE_BY:
        sys.exit(f"the kernels are made by {shipped.MADE_BY}, not by {given}: see `make kernels`")
    # Numba counts what it compiles in names: a process for each set.
    with ProcessPoolExecutor(mp_context=get_context("spawn"), max_tasks_per_child=1) as pool:
        texts = dict(zip(SETS, pool.map(text_of, SETS.values()), strict=True))
    for_processor = {}
    for processor in LEVELS:
        modules = [
            llvm.parse_assembly(each)
            for name, kernel in SETS.items()
            if LEVELS[processor] or kernel not in (LANES, STEPS)
            for each in versions(kernel, texts[name], processor).values()
        ]
        for each in modules[1:]:
            modules[0].link_in(each)
        for_processor[processor] = called_by_address(str(modules[0]), imported=processor == "wasm32")
    with ThreadPoolExecutor(os.cpu_count()) as threads:
        contents = threads.map(lambda name: library(for_processor[SYSTEMS[name].partition("-")[0]], name), SYSTEMS)
    folder.mkdir(parents=True, exist_ok=True)
    files = {}
    for name, content in zip(SYSTEMS, contents, strict=True):
        (folder / name).write_bytes(content)
        files[name] = hashlib.sha256(content).hexdigest()
        print(f"{name}: {len(content) / 1024:.0f} KB")
    made = {
        "python": ".".join(platform.python_version_tuple()[:2]),
        **given,
        "llvm": ".".join(map(str, llvm.llvm_version_info)),
    }
    manifest = {"source": shipped.source_hash(), "made_by": made, "files": files}
    (folder / shipped.MANIFEST_FILE).write_text(json.dumps(manifest, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else shipped.READY_FOLDER)
