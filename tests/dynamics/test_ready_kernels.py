"""The kernels that are shipped: what is in their libraries, and that all ways to run them give the same bits."""

import base64
import ctypes
import functools
import hashlib
import json
import os
import shutil
import struct
import subprocess
import sys
import threading
import warnings
from dataclasses import replace
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest

from rocking_cli import GroundMotion
from rocking_cli.core.structure_file import load_structure
from rocking_cli.dynamics import pulse_motion, shipped, ways
from rocking_cli.dynamics.batch import Runs, respond_many
from rocking_cli.dynamics.calling import FUNCTIONS, HISTORIES, LANES, LEVELS, PULSES, SETS, STEPS, TIED, symbol
from rocking_cli.dynamics.exact_batch import exact_many
from rocking_cli.dynamics.history import follow
from rocking_cli.errors import BrokenKernels, InputError, KernelWarning
from rocking_cli.excitation.pulses import parse_pulse
from rocking_cli.structure import Structure
from tests.conftest import EXAMPLES, PROJECT
from tests.dynamics import toy_lanes

RNG = np.random.default_rng(31)
SHAKING = GroundMotion("shaking", 0.01, 3.0 * RNG.standard_normal(150), unit="m/s2")
BOTH = replace(SHAKING, vertical=GroundMotion("vertical", 0.007, 2.0 * RNG.standard_normal(180), unit="m/s2"))


@pytest.fixture
def choose(monkeypatch):
    """Take a way, or none in particular."""

    def chosen(way=None):
        if way is None:
            monkeypatch.delenv(ways.KERNELS_VARIABLE, raising=False)
        else:
            monkeypatch.setenv(ways.KERNELS_VARIABLE, way)
        ways.forget()

    yield chosen
    monkeypatch.undo()
    ways.forget()


class TestWhatIsShipped:
    def test_it_is_of_these_sources(self):
        assert shipped.manifest()["source"] == shipped.source_hash(), "the kernels are stale: run `make kernels`"
        made = shipped.manifest()["made_by"]
        assert {name: made[name] for name in shipped.MADE_BY} == shipped.MADE_BY

    def test_the_hash_follows_the_sources_and_the_builder_and_no_line_ends(self, monkeypatch, tmp_path):
        for name in (*shipped.SOURCE_FILES, "shipped.py"):
            source = (PROJECT / "rocking_cli" / "dynamics" / name).read_bytes()
            (tmp_path / name).write_bytes(source.replace(b"\n", b"\r\n"))
        usual = shipped.source_hash()
        monkeypatch.setattr(shipped, "__file__", str(tmp_path / "shipped.py"))
        assert shipped.source_hash() == usual
        (tmp_path / "kernels.py").write_bytes((tmp_path / "kernels.py").read_bytes() + b"#")
        other = shipped.source_hash()
        monkeypatch.setattr(shipped, "MADE_BY", {**shipped.MADE_BY, "numba": "0.0"})
        assert len({usual, other, shipped.source_hash()}) == 3

    @pytest.mark.parametrize("name", shipped.manifest()["files"])
    def test_a_library_is_whole_and_needs_nothing_of_others(self, name):
        content = (shipped.READY_FOLDER / name).read_bytes()
        assert hashlib.sha256(content).hexdigest() == shipped.manifest()["files"][name]
        if name.endswith(".so"):  # of the others the linker sees to it
            assert missing(content) == []
        levels = LEVELS if "x86_64" in name else LEVELS[-1:]
        sets = [each for each in SETS.values() if name != "wasm.wasm" or each not in (LANES, STEPS)]
        entries = [symbol(each.name, level) for each in sets for level in (levels if each.lanes else [""])]
        if name != "wasm.wasm":  # that imports what it calls
            entries += ["rocking_level", *map(symbol, FUNCTIONS)]
        assert all(entry.encode() in content for entry in entries)
        assert not any(each in content for each in (b"NRT_", b"/home", b"/tmp", b"/root", str(PROJECT).encode()))

    def test_they_are_small_and_all_of_them(self):
        files = {each.name: each.stat().st_size for each in shipped.READY_FOLDER.iterdir()}
        assert files.keys() == {*shipped.manifest()["files"], shipped.MANIFEST_FILE}
        assert {*shipped.LIBRARIES} <= shipped.manifest()["files"].keys()
        assert max(files.values()) < 6e5 and sum(files.values()) < 3.1e6  # three levels of one processor

    @pytest.mark.parametrize("system, machine, name", [
        ("linux", "x86_64", "linux-x86_64.so"), ("linux", "aarch64", "linux-aarch64.so"),
        ("darwin", "arm64", "darwin-aarch64.dylib"), ("darwin", "x86_64", "darwin-x86_64.dylib"),
        ("win32", "AMD64", "win32-x86_64.dll"), ("win32", "ARM64", "win32-aarch64.dll"),
    ])  # fmt: skip
    def test_each_system_finds_its_own(self, monkeypatch, system, machine, name):
        monkeypatch.setattr(shipped.sys, "platform", system)
        monkeypatch.setattr(shipped.platform, "machine", lambda: machine)
        assert shipped.place().name == name and shipped.place().is_file()


def missing(content):
    """What a library for Linux expects of others: names, or that there are some."""
    (sections,) = struct.unpack_from("<Q", content, 40)
    size, count = struct.unpack_from("<HH", content, 58)
    headers = [struct.unpack_from("<IIQQQQIIQQ", content, sections + k * size) for k in range(count)]
    found = []
    for _, kind, _, _, at, length, link, _, _, entry in headers:
        if kind == 11:  # the symbols that a linker sees
            for place in range(at + entry, at + length, entry):
                name, _, _, section = struct.unpack_from("<IBBH", content, place)
                start = headers[link][4] + name
                found += [content[start : content.index(b"\0", start)]] if section == 0 else []
        elif kind == 6:  # what the loader does
            tags = [struct.unpack_from("<Q", content, place)[0] for place in range(at, at + length, 16)]
            found += ["a library"] * tags.count(1)
    return found


def structures():
    """Structures that between them have all that a kernel knows: joints, a tie, one side, corners of the force."""
    for name in ("frame", "block", "wall", "assembly", "spanning_wall"):
        yield name, Structure(load_structure(EXAMPLES / f"{name}.yaml"))


def bits_of_histories():
    found = {}
    for name, structure in structures():
        models = [structure.model("nonlinear")]
        if structure.why_no_block is None:
            models.append(structure.model("linear2"))
        for motions in ([SHAKING], [SHAKING, BOTH]):
            runs = Runs.every(len(models), len(motions), scales=(0.6, 1.7), polarities=(1, -1))
            outcomes = respond_many(models, motions, runs, threads=2)
            found[name, len(motions)] = {
                field: np.asarray(getattr(outcomes, field)).tobytes() for field in outcomes.__dataclass_fields__
            }
        for release, motion in ((0.0, BOTH), (0.5, None)):
            history = follow(models[0], motion, release=release)
            found[name, release] = history.phi.tobytes(), history.rate.tobytes(), history.impacts.tobytes()
    return found


def bits_of_pulses():
    equivalence = Structure(load_structure(EXAMPLES / "frame.yaml")).equivalence
    amplitudes, periods = (each.ravel() for each in np.meshgrid(np.linspace(1, 12, 9), np.linspace(0.2, 4, 9)))
    found = {}
    for shape in ("sine", "cosine", "rectangular"):
        pulse = parse_pulse(f"{shape}:0.4g:1s")
        outcomes = exact_many(equivalence, pulse, amplitudes, periods, kappa=2, gravity=9.80665)
        found[shape] = {
            field: np.asarray(getattr(outcomes, field)).tobytes() for field in outcomes.__dataclass_fields__
        }
    return found


@functools.cache
def _bits(way):
    return bits_of_histories(), bits_of_pulses()


def bits_of_shipped(choose):
    choose("ready")
    found = _bits("ready")
    assert ways.way() in (*LEVELS, ways.SCALAR)
    return found


class TestSameBits:
    """Of histories and exact pulses: arithmetic is that of IEEE 754, in one order, and functions are those of one C."""

    @pytest.mark.kernels
    def test_shipped_and_in_python(self, choose):
        shipped_bits = bits_of_shipped(choose)
        choose("python")
        assert ways.way() == "python"
        assert (bits_of_histories(), bits_of_pulses()) == shipped_bits

    @pytest.mark.kernels
    def test_shipped_and_compiled_here(self, choose, monkeypatch):
        pytest.importorskip("numba")
        monkeypatch.syspath_prepend(PROJECT / "scripts")
        compiled = import_module("by_numba").compiled
        shipped_bits = bits_of_shipped(choose)
        made = {each.module: compiled(import_module(each.module)) for each in SETS.values()}
        by_name = {name: made[each.module][each.function] for name, each in SETS.items() if not each.lanes}
        monkeypatch.setattr(ways, "_chosen", lambda: ("numba", by_name))
        found = bits_of_histories(), bits_of_pulses()
        monkeypatch.undo()
        assert found == shipped_bits


BLOCK = (
    "import sys; from rocking_cli import GroundMotion, Registry, respond;"
    "respond(Registry()['block'](width=0.7, height=2.8), GroundMotion('x', 0.01, [0.0, 4.0, 0.0], unit='m/s2'));"
    "print('numba' in sys.modules)"
)
"""A program whose history needs no numba."""


class TestWays:
    def test_the_shipped_one_comes_first_and_numba_is_not_loaded(self):
        environment = {name: value for name, value in os.environ.items() if name != ways.KERNELS_VARIABLE}
        done = subprocess.run([sys.executable, "-c", BLOCK], capture_output=True, text=True, env=environment)
        assert done.stdout == "False\n" and "KernelWarning" not in done.stderr

    @pytest.mark.parametrize("why", ["no library here", "no ctypes"])
    def test_python_comes_next_and_says_so_once(self, choose, monkeypatch, why):
        choose()
        if why == "no ctypes":
            monkeypatch.setitem(sys.modules, "rocking_cli.dynamics.shipped", None)
            monkeypatch.delattr("rocking_cli.dynamics.shipped")
            why = "halted"
        else:
            monkeypatch.setattr(shipped, "load", refuse)
        with pytest.warns(KernelWarning, match=rf"some sixty times longer \(.*{why}") as said:
            assert ways.way() == "python" and all(ways.kernel(of) for of in SETS.values() if not of.lanes)
        assert len(said) == 1
        monkeypatch.undo()

    def test_one_that_is_chosen_is_the_only_one(self, choose, monkeypatch):
        choose("ready")
        monkeypatch.setattr(shipped, "load", refuse)
        with pytest.raises(InputError, match="ROCKING_KERNELS is 'ready', but no library here"):
            ways.kernel(HISTORIES)

    def test_a_wrong_choice_is_named(self, choose):
        choose("fast")
        with pytest.raises(InputError, match="is 'fast': give one of ready, v4, v3, v1, scalar, python"):
            ways.kernel(HISTORIES)

    def test_python_chosen_says_nothing(self, choose):
        choose("python")
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            ways.kernel(PULSES)

    @pytest.mark.parametrize("level", LEVELS)
    def test_a_level_is_taken_or_the_next_lower_one_which_is_said(self, choose, level):
        choose(level)
        if level in shipped.levels():
            assert ways.way() == level and ways.kernel(PULSES)
        else:
            with pytest.warns(
                ways.KernelWarning, match=f"is '{level}', which this processor has not: kernels run at v"
            ):
                ways.kernel(PULSES)
            assert ways.way() == shipped.levels()[0] < level

    def test_a_processor_without_extensions_takes_the_lowest(self, choose, monkeypatch):
        monkeypatch.setattr(shipped, "levels", lambda: ("v1",))
        choose()
        assert ways.way() == "v1" and ways.usable() == ("v1", "scalar", "python")
        choose("v3")
        with pytest.warns(ways.KernelWarning, match="'v3', which this processor has not: kernels run at v1"):
            assert ways.way() == "v1"

    def test_without_lanes_and_by_python_batches_are_scalar(self, choose, monkeypatch):
        monkeypatch.setitem(ways.SETS, "toy", toy_lanes.TOY)
        monkeypatch.setattr(shipped, "load", lambda of, level: None)
        for way in ("v1", "scalar", "python"):
            choose(way)
            assert (ways.lanes(toy_lanes.TOY) is None) == (way != "v1")


def refuse(*of):
    raise ImportError("no library here")


CPUINFO = Path("/proc/cpuinfo")
V3 = {"fma", "pni", "ssse3", "cx16", "sse4_1", "sse4_2", "movbe", "popcnt", "avx", "f16c", "lahf_lm", "abm", "bmi1",
      "avx2", "bmi2"}  # fmt: skip
V4 = {"avx512f", "avx512dq", "avx512cd", "avx512bw", "avx512vl"}


@pytest.mark.skipif("linux-x86_64" not in shipped.place().name, reason="Linux lists what the processor has")
def test_the_level_is_that_of_the_processor(choose):
    choose("ready")
    flags = set(next(each for each in CPUINFO.read_text().splitlines() if each.startswith("flags")).split())
    has = {"v4": flags >= V3 | V4, "v3": flags >= V3, "v1": True}
    assert shipped.levels() == tuple(level for level in LEVELS if has[level])


TOOLS = PROJECT / "out" / "kernels" / ("Scripts" if os.name == "nt" else "bin") / "python"
"""What `make kernels` has made, with numba and Zig."""


def make_toy(of, folder, spoil=""):
    """Libraries of a small kernel of lanes."""
    code = f"""
import sys, make_kernels as make
from pathlib import Path
from tests.dynamics import toy_lanes
make.SETS = {{"toy": toy_lanes.{of}}}
del make.SYSTEMS["wasm.wasm"], make.LEVELS["wasm32"]  # which have no lanes
{spoil}
make.main(Path(sys.argv[1]))
"""
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(map(str, (PROJECT / "scripts", PROJECT)))}
    command = [TOOLS, "-c", code, folder]
    return subprocess.run(command, cwd=PROJECT, env=environment, capture_output=True, text=True)


@pytest.mark.kernels
@pytest.mark.skipif(not TOOLS.exists(), reason="needs the tools of `make kernels`")
class TestLanes:
    def test_levels_give_the_bits_of_python(self, choose, monkeypatch, tmp_path):
        done = make_toy("TOY", tmp_path)  # which sees to vectors in all levels, and to no sum fused with a product
        assert done.returncode == 0, done.stderr
        monkeypatch.setattr(shipped, "READY_FOLDER", tmp_path)
        choose()
        start = RNG.uniform(0.01, 1.0, 9 * toy_lanes.W)

        def bits(run):
            memory, moved = start.copy(), np.zeros(toy_lanes.W, int)
            run(memory, moved, 500)
            return memory.tobytes(), moved.tobytes()

        expected = bits(ways.in_python(toy_lanes.TOY))
        assert expected != bits(lambda *_: None)
        for level in shipped.levels():
            entry = shipped.load(toy_lanes.TOY, level)
            assert bits(lambda *given, entry=entry: shipped.call(entry, toy_lanes.TOY, given)) == expected

    def test_a_loop_without_vectors_is_refused(self, tmp_path):
        assert "would have no vectors at level v1" in make_toy("SERIAL", tmp_path).stderr

    def test_sums_fused_with_products_are_refused(self, tmp_path):
        contract = ".replace('fmul', 'fmul contract').replace('fadd', 'fadd contract')"
        fused = f"make.called_by_address = lambda text, imported: text{contract}"
        assert "would round a product and a sum once" in make_toy("TOY", tmp_path, fused).stderr

    def test_fast_arithmetic_is_refused(self, tmp_path):
        fast = "made = make.versions; make.versions = lambda *of: {"
        fast += "level: text.replace('fmul ', 'fmul nnan ') for level, text in made(*of).items()}"
        assert "arithmetic is not that of IEEE 754" in make_toy("TOY", tmp_path, fast).stderr


class Recorder:
    """The functions of C of a library, whose results are kept by the bits of their arguments."""

    def __init__(self, library):
        self.results, self.alive = {}, []
        c = ctypes.CDLL("ucrtbase" if sys.platform == "win32" else None)
        for name, types in FUNCTIONS.items():
            if "ptr" not in types:
                count = types.count("double") - 1
                function = ctypes.CFUNCTYPE(ctypes.c_double, *[ctypes.c_double] * count)
                self.alive.append(function(functools.partial(self.call, name, function((name, c)))))
                address = ctypes.cast(self.alive[-1], ctypes.c_void_p).value
                ctypes.c_void_p.in_dll(library, symbol(name)).value = address

    def call(self, name, function, *numbers):
        result = function(*numbers)
        key = struct.pack(f"<{len(numbers)}d", *numbers).hex()
        self.results.setdefault(name, {})[key] = struct.pack("<d", result).hex()
        return result


@pytest.mark.skipif(shutil.which("node") is None, reason="no node here")
def test_a_browser_computes_the_same_bits(choose, monkeypatch, tmp_path):
    choose("ready")
    recorder, calls, base = Recorder(shipped.loaded()), [], 2**24

    def call(entry, kernel, arguments):
        """Also by wasm, where addresses are those of an image of the arrays."""
        whole, real, places = [], [], []
        shipped._pack(kernel.arguments, arguments, whole, real, places)
        arrays = [each for each in leaves(arguments) if isinstance(each, np.ndarray)]
        at = np.cumsum([base, *(each.nbytes for each in arrays)])
        image = b"".join(each.tobytes() for each in arrays)
        rows = [np.array(whole, np.int64), np.array(real), at[:-1].astype(np.int64)]
        starts = [int(at[-1]) + sum(each.nbytes for each in rows[:k]) for k in range(3)]
        image = base64.b64encode(image + b"".join(each.tobytes() for each in rows)).decode()
        usual(entry, kernel, arguments)
        given = {
            "entry": symbol(kernel.name),
            "rows": starts,
            "base": base,
            "image": image,
            "results": recorder.results,
        }
        (tmp_path / "call.json").write_text(json.dumps(given), encoding="utf-8")
        words = [
            "node",
            Path(__file__).with_name("run_wasm.mjs"),
            shipped.READY_FOLDER / "wasm.wasm",
            "call.json",
        ]
        done = subprocess.run(words, cwd=tmp_path, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        after = b"".join(each.tobytes() for each in arrays)
        assert base64.b64decode(done.stdout)[: len(after)] == after
        calls.append(kernel.name)

    usual = shipped.call
    monkeypatch.setattr(shipped, "call", call)
    structure = Structure(load_structure(EXAMPLES / "frame.yaml"))
    follow(structure.model("nonlinear"), SHAKING)
    follow(structure.model("linear2"), BOTH)
    exact_many(
        structure.equivalence, parse_pulse("sine:0.4g:1s"), np.array([3.0]), np.array([1.0]), kappa=2, gravity=9.8
    )
    assert calls == ["histories", "histories", "pulses"] and recorder.results.keys() >= {"sin", "expm1"}


def leaves(values):
    """What tuples within tuples hold."""
    for each in values:
        if isinstance(each, tuple):
            yield from leaves(each)
        else:
            yield each


class TestLibrary:
    """Whatever is wrong with the library, another way answers."""

    @pytest.fixture
    def folder(self, choose, tmp_path, monkeypatch):
        """A folder with what is shipped, in the place of the one that is installed."""
        folder = tmp_path / "ready"
        shutil.copytree(shipped.READY_FOLDER, folder)
        monkeypatch.setattr(shipped, "READY_FOLDER", folder)
        choose()
        return folder

    @pytest.mark.parametrize("spoil", [
        lambda code: b"", lambda code: code[:20], lambda code: code[:-100], lambda code: b"\0" * len(code),
        lambda code: code[:90000] + bytes([code[90000] ^ 1]) + code[90001:], lambda code: code + b"more",
    ])  # fmt: skip
    def test_a_damaged_one(self, folder, spoil):
        shipped.place().write_bytes(spoil(shipped.place().read_bytes()))
        with pytest.raises(BrokenKernels, match="damaged"):
            shipped.load(PULSES)

    def test_one_that_is_not_there(self, folder):
        shipped.place().unlink()
        with pytest.raises(BrokenKernels, match=f"{shipped.place().name} is missing, reinstall"):
            shipped.load(PULSES)

    def test_none_in_the_wheel_for_any_system(self, folder):
        manifest = {**shipped.manifest(), "files": {}}
        (folder / shipped.MANIFEST_FILE).write_text(json.dumps(manifest), encoding="utf-8")
        with pytest.warns(KernelWarning, match=rf"{shipped.FOR_ALL}: the wheel for {shipped.place().stem} has them"):
            assert ways.way() == "python"
        assert not isinstance(ways.fault_of_shipped(), BrokenKernels)

    def test_one_that_may_not_be_read(self, folder, monkeypatch):
        def refused(file):
            raise PermissionError(13, "Permission denied", str(file))

        monkeypatch.setattr(Path, "read_bytes", refused)
        with pytest.raises(BrokenKernels, match=r"cannot be loaded, reinstall rocking-cli: .*Permission denied"):
            shipped.load(PULSES)

    @pytest.mark.parametrize("manifest", [None, "", "{", "[1]", "{}", '{"source": 1, "made_by": 2, "files": 3}'])
    def test_a_manifest_that_is_none(self, folder, manifest):
        if manifest is None:
            (folder / shipped.MANIFEST_FILE).unlink()
        else:
            (folder / shipped.MANIFEST_FILE).write_text(manifest, encoding="utf-8")
        with pytest.raises(BrokenKernels, match="cannot be read"):
            shipped.load(PULSES)

    @pytest.mark.parametrize("spoil", [lambda file: file.write_bytes(b"other"), lambda file: file.unlink()])
    def test_the_one_of_pages(self, folder, spoil):
        assert shipped.for_pages()[:4] == b"\0asm"
        spoil(folder / shipped.FOR_PAGES)
        with pytest.raises(BrokenKernels, match=f"{shipped.FOR_PAGES} is (damaged|missing), reinstall"):
            shipped.for_pages()

    @pytest.mark.parametrize("symbol", [b"rocking_level", b"rocking_steps_v1"])
    def test_one_of_another_version(self, folder, symbol):
        """As an update that did not come to its end leaves it."""
        other, manifest = shipped.place().read_bytes().replace(symbol, symbol[:-1] + b"x"), shipped.manifest()
        shipped.place().write_bytes(other)
        manifest["files"][shipped.place().name] = hashlib.sha256(other).hexdigest()
        (folder / shipped.MANIFEST_FILE).write_text(json.dumps(manifest), encoding="utf-8")
        with pytest.raises(BrokenKernels, match="reinstall rocking-cli"):
            shipped.load(STEPS)

    @pytest.mark.parametrize("other", [b"no library", "another system"])
    def test_one_that_the_system_does_not_load(self, folder, other):
        manifest = shipped.manifest()
        if other == "another system":
            foreign = next(each for each in manifest["files"] if not each.startswith(sys.platform))
            other = (folder / foreign).read_bytes()
        shipped.place().write_bytes(other)
        manifest["files"][shipped.place().name] = hashlib.sha256(other).hexdigest()
        (folder / shipped.MANIFEST_FILE).write_text(json.dumps(manifest), encoding="utf-8")
        with pytest.raises(BrokenKernels, match="cannot be loaded"):
            shipped.load(PULSES)

    def test_a_function_of_c_that_is_missing(self, folder, monkeypatch):
        monkeypatch.setattr(shipped, "FUNCTIONS", (*FUNCTIONS, "no_function_of_c"))
        with pytest.raises(BrokenKernels, match="no_function_of_c"):
            shipped.load(PULSES)

    def test_threads_load_one(self, choose):
        choose("ready")
        entries = []
        threads = [threading.Thread(target=lambda: entries.append(ways.kernel(TIED))) for _ in range(4)]
        for each in threads:
            each.start()
        for each in threads:
            each.join()
        assert len(entries) == 4 and len({id(each) for each in entries}) == 1


@pytest.mark.skipif(shutil.which("musl-gcc") is None or not sys.platform.startswith("linux"), reason="no musl here")
def test_the_library_of_this_linux_loads_under_musl_too(monkeypatch, tmp_path):
    monkeypatch.syspath_prepend(PROJECT / "scripts")
    found = import_module("release").under_musl(shipped.place(), list(FUNCTIONS), tmp_path)
    side, results = pulse_motion.Side(2.0, 1.0, 0.5, 0.9), np.empty((2, 6))
    segments = np.array([[0.0, 1.0, -1.0, 2 * np.pi, 0.0]])
    ways.as_shipped(PULSES)((side, side), segments, np.array([1.2, 3.0]), np.array([1.0, 2.0]), 0, 2, results)
    assert found == pytest.approx(results.ravel(), rel=1e-12)


class TestArguments:
    @pytest.mark.parametrize("wrong", [
        np.zeros((3, 5), np.float32), np.zeros(15), np.zeros((5, 3)).T, np.zeros((3, 5), int),
    ])  # fmt: skip
    def test_an_array_of_another_kind_is_refused(self, wrong):
        side = pulse_motion.Side(2.0, 3.0, 0.5, 0.9)
        arguments = ((side, side), wrong, np.ones(3), np.ones(3), 0, 3, np.empty((3, 6)))
        with pytest.raises(TypeError, match="an array for a kernel"):
            shipped.call(shipped.load(PULSES), PULSES, arguments)


def test_a_status_other_than_0_is_an_error():
    arguments = (((0.0,) * 4,) * 2, np.zeros((1, 5)), np.zeros(1), np.zeros(1), 0, 0, np.zeros((1, 6)))
    with pytest.raises(RuntimeError, match="pulses ended with status 1"):
        shipped.call(lambda *_: 1, PULSES, arguments)
