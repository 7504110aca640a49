"""Write the kernels that are shipped, rocking_cli/dynamics/ready: `make kernels`.

    python scripts/make_kernels.py [FOLDER]

Numba compiles each set of functions for a processor without any extensions, LLVM makes machine code of them for each
kind of system, and the linker of Zig, which knows the libraries of all systems, makes a library of it. The versions are
pinned, so that the same sources give the same bytes.
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
from importlib.metadata import version
from pathlib import Path
from typing import Any

PROJECT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(PROJECT))
# Before numba is imported: nothing of this machine may be in what is shipped.
for _name in [each for each in os.environ if each.startswith("NUMBA_")]:
    del os.environ[_name]
os.environ["NUMBA_CPU_NAME"], os.environ["NUMBA_CPU_FEATURES"] = "generic", ""

import llvmlite.binding as llvm  # noqa: E402
from by_numba import OPTIONS, compiled  # noqa: E402
from llvmlite import ir  # noqa: E402
from numba import njit, types  # noqa: E402
from numba.extending import intrinsic  # noqa: E402
from numba.np.arrayobj import populate_array  # noqa: E402

from rocking_cli.dynamics import shipped  # noqa: E402
from rocking_cli.dynamics.calling import FUNCTIONS, SETS, KernelSet, Layout, symbol  # noqa: E402

# Without numba's runtime: what would allocate memory or count references does not compile.
AHEAD = {"_nrt": False, "no_cpython_wrapper": True, "no_cfunc_wrapper": True}
SYSTEMS = {
    "linux-x86_64.so": ("x86_64-unknown-linux-musl", "x86_64-linux-musl"),
    "linux-aarch64.so": ("aarch64-unknown-linux-musl", "aarch64-linux-musl"),
    "darwin-x86_64.dylib": ("x86_64-apple-macosx11.0.0", "x86_64-macos.11.0"),
    "darwin-aarch64.dylib": ("arm64-apple-macosx11.0.0", "aarch64-macos.11.0"),
    "win32-x86_64.dll": ("x86_64-pc-windows-gnu", "x86_64-windows-gnu"),
}
"""The libraries, and what LLVM and Zig call the systems. Those of Linux need no library of C, so any will do."""
LINKING = {".so": "-Wl,-z,defs", ".dylib": "-Wl,-dead_strip", ".dll": "-Wl,-Brepro"}
"""What the linker needs to be told: that nothing may be missing, which the others see to, and to keep no time."""
EXACT = ("fabs", "sqrt")  # of IEEE 754: every processor here has instructions for them
OWN = {
    ".so": "",
    # What LLVM calls instead of `memset` there.
    ".dylib": "".join(
        f"""define hidden void @{name}(i8* %0, i64 %1) {{
  %3 = call i8* @memset(i8* %0, i32 0, i64 %1)
  ret void
}}
"""
        for name in ("bzero", "__bzero")
    ),
    # What Windows calls when it loads a library; there is nothing to do.
    ".dll": "define i32 @DllMainCRTStartup(i8* %0, i32 %1, i8* %2) { ret i32 1 }",
}
"""What only libraries of one kind have."""

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
    writing = Writing()
    arguments = ", ".join(map(writing.argument, kernel.arguments))
    source = f"def entry(whole, real, places):\n    {kernel.function}({arguments})\n    return 0\n"
    space = {**namespace, "__at": element, "__array_of_R": array_of("R"), "__array_of_I": array_of("I")}
    exec(source, space)
    signature = types.int64(POINTERS["I"], POINTERS["R"], POINTERS["I"])
    return njit(signature, **OPTIONS, **AHEAD)(space["entry"]).overloads[signature.args]


def module_of(kernel: KernelSet) -> llvm.ModuleRef:
    """A set as a module of LLVM, whose only function to be called from outside has the name of the set."""
    compiled = entry_of(kernel)
    module = llvm.parse_assembly(compiled.library.get_llvm_str())
    inner = next(each for each in module.functions if each.name == compiled.fndesc.llvm_func_name)
    outer = ir.Module(name=kernel.name)
    outer.triple, outer.data_layout = module.triple, module.data_layout
    whole, real, status = ir.IntType(64), ir.DoubleType(), ir.IntType(32)
    raised = ir.LiteralStructType([ir.IntType(8).as_pointer(), status, ir.IntType(8).as_pointer(),
                                   ir.IntType(8).as_pointer(), status]).as_pointer()  # fmt: skip
    rows = [whole.as_pointer(), real.as_pointer(), whole.as_pointer()]
    numba_way = ir.FunctionType(status, [whole.as_pointer(), raised.as_pointer(), *rows])
    called = ir.Function(outer, numba_way, inner.name)
    function = ir.Function(outer, ir.FunctionType(status, rows), symbol(kernel.name))
    builder = ir.IRBuilder(function.append_basic_block())
    builder.ret(builder.call(called, [builder.alloca(whole), builder.alloca(raised), *function.args]))
    module.link_in(llvm.parse_assembly(str(outer)))
    for each in (*module.functions, *module.global_variables):
        if not each.is_declaration and each.name != symbol(kernel.name):
            each.linkage = "internal"
    passes = llvm.ModulePassManager()
    passes.add_global_dce_pass()
    passes.add_strip_dead_prototypes_pass()
    passes.run(module)
    for number, each in enumerate(module.global_variables):  # numba names them by addresses
        each.name = f"{kernel.name}.{number}"
    module.name = kernel.name
    module.verify()
    return module


def called_by_address(text: str) -> str:
    """A module, as text, whose calls of C go through addresses that are handed to the library.

    What LLVM itself puts a call for, `ceil`, `floor` and those of memory, has the name of C within the library; the
    others get one that LLVM does not know, so that it takes no two of them together.
    """
    if fast := re.search(r"= (?:tail )?(?:f\w+|call) (?:fast|reassoc|contract|arcp|afn|nnan|ninf|nsz)\b.*", text):
        sys.exit(f"arithmetic is not that of IEEE 754: {fast[0]}")
    for name in EXACT:
        text = text.replace(f"@{name}(", f"@llvm.{name}.f64(")
    for name, types_of in FUNCTIONS.items():
        result, *types_in = types_of.split()
        known = name in ("ceil", "floor", "memcpy", "memset")
        entry = name if known else f"call_{name}"
        if not known:
            text = re.sub(rf"^declare .*@(?:llvm\.{name}\.f64|{name})\(.*\n", "", text, flags=re.MULTILINE)
            text = re.sub(rf"@(?:llvm\.{name}\.f64|{name})\(", f"@{entry}(", text)
        signature, given = f"{result} ({', '.join(types_in)})", [f"{each} %{k}" for k, each in enumerate(types_in)]
        text += f"""
@{symbol(name)} = global {signature}* null
define {"hidden" if known else "internal"} {result} @{entry}({", ".join(given)}) {{
  %address = load {signature}*, {signature}** @{symbol(name)}
  %result = tail call {result} %address({", ".join(given)})
  ret {result} %result
}}
"""
    return text


def library(text: str, name: str) -> bytes:
    """The library of a system. What calls anything that is not in it is refused by the linker."""
    triple, system = SYSTEMS[name]
    module = llvm.parse_assembly(text + OWN[Path(name).suffix])
    processor = "x86-64" if triple.startswith("x86_64") else "generic"
    target = llvm.Target.from_triple(triple)
    machine = target.create_target_machine(cpu=processor, opt=3, reloc="pic", codemodel="default")
    module.triple, module.data_layout = triple, str(machine.target_data)
    module.verify()
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "kernels.o").write_bytes(machine.emit_object(module))
        zig = [sys.executable, "-m", "ziglang", "cc", "-target", system, "-shared", "-nostdlib", "-s"]
        subprocess.run([*zig, LINKING[Path(name).suffix], "-o", name, "kernels.o"], cwd=folder, check=True)
        return Path(folder, name).read_bytes()


def main(folder: Path) -> None:
    """Write the libraries and the manifest."""
    given = {name: version(name) for name in shipped.MADE_BY}
    if given != shipped.MADE_BY:
        sys.exit(f"the kernels are made by {shipped.MADE_BY}, not by {given}: see `make kernels`")
    llvm.initialize()
    llvm.initialize_all_targets()
    llvm.initialize_all_asmprinters()
    first, *others = map(module_of, SETS.values())
    for each in others:
        first.link_in(each)
    text = called_by_address(str(first))
    folder.mkdir(parents=True, exist_ok=True)
    files = {}
    for name in SYSTEMS:
        content = library(text, name)
        (folder / name).write_bytes(content)
        files[name] = hashlib.sha256(content).hexdigest()
        print(f"{name}: {len(content) / 1024:.0f} KB")
    made = {"python": ".".join(platform.python_version_tuple()[:2]), **given}
    made["llvm"] = ".".join(map(str, llvm.llvm_version_info))
    manifest = {"source": shipped.source_hash(), "made_by": made, "files": files}
    (folder / shipped.MANIFEST_FILE).write_text(json.dumps(manifest, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else shipped.READY_FOLDER)
