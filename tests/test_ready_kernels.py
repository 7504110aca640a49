"""The kernels that are shipped: what is in them, where their machine code is, and that all ways give the same bits."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import threading
import warnings
from dataclasses import replace

import numpy as np
import pytest

from rocking_cli import GroundMotion, Runs, respond_many
from rocking_cli.dynamics import calling, compiled, kernels, pulse_motion, shipped, ways
from rocking_cli.dynamics.calling import HISTORIES, PULSES, SETS, TIED
from rocking_cli.dynamics.exact_batch import exact_many
from rocking_cli.dynamics.history import follow
from rocking_cli.errors import InputError, KernelWarning
from rocking_cli.excitation.pulses import parse_pulse
from rocking_cli.structure import Structure
from rocking_cli.structure_file import load_structure
from tests.conftest import EXAMPLES, PROJECT

llvm = pytest.importorskip("llvmlite.binding")

RNG = np.random.default_rng(31)
SHAKING = GroundMotion("shaking", 0.01, 3.0 * RNG.standard_normal(150))
BOTH = replace(SHAKING, vertical=GroundMotion("vertical", 0.007, 2.0 * RNG.standard_normal(180)))


@pytest.fixture
def choose(monkeypatch):
    """Take a way, or none in particular, in a cache of one's own if one is given."""

    def chosen(way=None, cache=None):
        if way is None:
            monkeypatch.delenv(ways.CHOSEN, raising=False)
        else:
            monkeypatch.setenv(ways.CHOSEN, way)
        if cache is not None:
            monkeypatch.setenv("NUMBA_CACHE_DIR", str(cache))
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
        for name in (*shipped.SOURCES, "shipped.py"):
            source = (PROJECT / "rocking_cli" / "dynamics" / name).read_bytes()
            (tmp_path / name).write_bytes(source.replace(b"\n", b"\r\n"))
        usual = shipped.source_hash()
        monkeypatch.setattr(shipped, "__file__", str(tmp_path / "shipped.py"))
        assert shipped.source_hash() == usual
        (tmp_path / "kernels.py").write_bytes((tmp_path / "kernels.py").read_bytes() + b"#")
        other = shipped.source_hash()
        monkeypatch.setattr(shipped, "MADE_BY", {**shipped.MADE_BY, "numba": "0.0"})
        assert len({usual, other, shipped.source_hash()}) == 3

    @pytest.mark.parametrize("name", SETS)
    def test_it_calls_functions_of_c_alone_and_names_no_place_of_the_builder(self, name):
        content = shipped.bitcode(name)
        shipped._llvm()
        module = llvm.parse_bitcode(content)
        assert set(shipped.needed(module, name)) <= {*shipped.LIBRARY, *shipped.INTRINSICS}
        assert "NRT" not in str(module) and "fast" not in str(module).replace("fastcc", "")
        assert str(PROJECT).encode() not in content and b"/home" not in content and b"/tmp" not in content

    def test_it_is_small(self):
        assert sum(each.stat().st_size for each in shipped.FOLDER.iterdir()) < 1.5e6

    @pytest.mark.parametrize(
        "other", ["NRT_MemInfo_call_dtor", "NRT_Allocate", "PyErr_Clear", "malloc", "llvm.fma.f64"]
    )
    def test_a_call_of_anything_else_is_refused(self, other):
        shipped._llvm()
        code = f'declare void @"{other}"()\ndefine i32 @rocking_x() {{ call void @"{other}"() ret i32 0 }}'
        with pytest.raises(shipped.Unusable, match=other):
            shipped.needed(llvm.parse_assembly(code), "x")

    def test_an_entry_too_many_is_refused(self):
        shipped._llvm()
        code = "define i32 @rocking_x() { ret i32 0 }\ndefine i32 @y() { ret i32 0 }"
        with pytest.raises(shipped.Unusable, match="other entries"):
            shipped.needed(llvm.parse_assembly(code), "x")


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


class TestSameBits:
    """Of histories and exact pulses: arithmetic is that of IEEE 754, in one order, and functions are those of one C."""

    def test_shipped_and_in_python(self, choose):
        choose("ready")
        histories, pulses = bits_of_histories(), bits_of_pulses()
        assert shipped._LOADED.keys() == SETS.keys()
        choose("python")
        assert {ways.way(each) for each in SETS.values()} == {"python"}
        assert bits_of_pulses() == pulses
        assert bits_of_histories() == histories

    def test_shipped_and_compiled_here(self, choose):
        pytest.importorskip("numba")
        choose("ready")
        histories, pulses = bits_of_histories(), bits_of_pulses()
        choose("jit")
        assert {ways.way(each) for each in SETS.values()} == {"jit"}
        assert bits_of_pulses() == pulses
        assert bits_of_histories() == histories


class TestWays:
    def test_the_shipped_one_comes_first_and_numba_is_not_loaded(self):
        code = (
            "import sys; from rocking_cli import GroundMotion, Registry, respond;"
            "respond(Registry()['block'](width=0.7, height=2.8), GroundMotion('x', 0.01, [0.0, 4.0, 0.0]));"
            "print('numba' in sys.modules)"
        )
        environment = {name: value for name, value in os.environ.items() if name != ways.CHOSEN}
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=environment)
        assert (done.stdout, done.stderr) == ("False\n", "")

    def test_numba_comes_next(self, choose, monkeypatch):
        pytest.importorskip("numba")
        choose()
        monkeypatch.setattr(shipped, "FOLDER", PROJECT / "nowhere")
        shipped.manifest.cache_clear()
        taken = ways.way(PULSES)
        monkeypatch.undo()
        assert taken == "jit"

    def test_python_comes_last_and_says_so_once(self, choose, monkeypatch):
        choose()
        monkeypatch.setattr(shipped, "load", lambda of: refuse())
        monkeypatch.setitem(ways.MAKE, "jit", lambda of: refuse(ImportError))
        ways._say_slow.cache_clear()
        with pytest.warns(KernelWarning, match=r"a hundred times longer \(no llvmlite here\)") as said:
            assert [ways.way(each) for each in SETS.values()] == ["python"] * 3
        assert len(said) == 1
        ways._say_slow.cache_clear()

    def test_one_that_is_chosen_is_the_only_one(self, choose, monkeypatch):
        choose("ready")
        monkeypatch.setattr(shipped, "load", lambda of: refuse())
        with pytest.raises(InputError, match="ROCKING_KERNELS is 'ready', but no llvmlite here"):
            ways.kernel(HISTORIES)

    def test_a_wrong_choice_is_named(self, choose):
        choose("fast")
        with pytest.raises(InputError, match="ROCKING_KERNELS is 'fast': give one of ready, jit, python"):
            ways.kernel(HISTORIES)

    def test_python_chosen_says_nothing(self, choose):
        choose("python")
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            ways.kernel(PULSES)


def refuse(kind=shipped.Unusable):
    raise kind("no llvmlite here")


def pulse_bits():
    """What a kernel of pulses gives, fresh from the cache."""
    results = np.empty((3, pulse_motion.RESULTS))
    side = pulse_motion.Side(2.0, 3.0, 0.5, 0.9)
    segments = np.array([[0.0, 1.0, 1.0, 2 * np.pi, 0.0]])
    arguments = ((side, side), segments, np.array([2.0, 5.0, 9.0]), np.full(3, 1.3), 0, 3, results)
    calling.call(shipped.load(PULSES), PULSES, arguments)
    return results.tobytes()


class TestCache:
    def test_machine_code_is_kept_and_found_again(self, choose, tmp_path, monkeypatch):
        choose("ready", tmp_path)
        assert not shipped.is_kept("pulses") and not ways.is_ready(compiled.PULSES)
        first = pulse_bits()
        assert [each.name for each in tmp_path.iterdir()] == [shipped.place("pulses").name]
        assert shipped.is_kept("pulses") and ways.is_ready(compiled.PULSES)
        assert not ways.needs_compiling(compiled.PULSES)
        shipped.forget()
        monkeypatch.setattr(shipped, "machine_code", lambda *_: pytest.fail("it is made again"))
        assert pulse_bits() == first

    @pytest.mark.parametrize("spoil", [
        lambda code: b"", lambda code: code[:20], lambda code: code[:-100], lambda code: b"\0" * len(code),
        lambda code: code[:5000] + bytes([code[5000] ^ 1]) + code[5001:], lambda code: code + b"more",
    ])  # fmt: skip
    def test_damaged_code_is_made_again(self, choose, tmp_path, spoil):
        choose("ready", tmp_path)
        first, place = pulse_bits(), shipped.place("pulses")
        right = place.read_bytes()
        place.write_bytes(spoil(right))
        shipped.forget()
        assert pulse_bits() == first and place.read_bytes() == right

    def test_code_of_another_processor_or_version_is_not_taken(self, choose, tmp_path, monkeypatch):
        choose("ready", tmp_path)
        first, place = pulse_bits(), shipped.place("pulses")
        monkeypatch.setattr(shipped, "_processor", lambda: ("x86-64", ""))
        assert shipped.place("pulses") != place
        shipped.place("pulses").write_bytes(place.read_bytes())  # whoever renames it
        assert shipped._kept("pulses") is None
        monkeypatch.undo()
        assert pulse_bits() == first

    @pytest.mark.parametrize("hinder", ["a file in its place", "a folder in the place of the code", "a full disk"])
    def test_where_nothing_can_be_kept_there_is_an_answer(self, choose, tmp_path, monkeypatch, hinder):
        choose("ready", tmp_path / "cache")
        if hinder == "a file in its place":
            (tmp_path / "cache").touch()
        elif hinder == "a folder in the place of the code":
            shipped.place("pulses").mkdir(parents=True)
        else:
            monkeypatch.setattr(os, "fdopen", lambda handle, mode: FullDisk(handle))
        found = pulse_bits()
        monkeypatch.undo()
        choose("ready", tmp_path / "sound")
        assert pulse_bits() == found
        assert not list(tmp_path.glob("cache/*.machine.*"))

    def test_two_processes_and_two_threads_at_once(self, choose, tmp_path):
        code = (
            "from rocking_cli.dynamics import shipped; from rocking_cli.dynamics.calling import PULSES;"
            "shipped.load(PULSES); print(shipped.place('pulses').name)"
        )
        environment = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path)}
        both = [
            subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True, env=environment)
            for _ in range(2)
        ]
        said = {each.communicate()[0].strip() for each in both}
        assert said == {each.name for each in tmp_path.iterdir()} and len(said) == 1
        choose("ready", tmp_path)
        entries = []
        threads = [threading.Thread(target=lambda: entries.append(shipped.load(TIED))) for _ in range(4)]
        for each in threads:
            each.start()
        for each in threads:
            each.join()
        assert len(entries) == 4 and len({id(each) for each in entries}) == 1


class FullDisk:
    def __init__(self, handle):
        os.close(handle)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        return None

    def write(self, _):
        raise OSError(28, "No space left on device")


class TestDamagedInstallation:
    @pytest.mark.parametrize("spoil", ["missing", "damaged", "no manifest", "another manifest"])
    def test_it_is_a_reason_for_another_way(self, choose, tmp_path, monkeypatch, spoil):
        folder = tmp_path / "ready"
        folder.mkdir()
        manifest = json.loads((shipped.FOLDER / "manifest.json").read_text(encoding="utf-8"))
        content = shipped.bitcode("pulses")
        if spoil == "another manifest":
            manifest = [manifest]
        if spoil != "no manifest":
            (folder / "manifest.json").write_text(json.dumps(manifest), encoding="utf-8")
        if spoil != "missing":
            (folder / "pulses.bc").write_bytes(content[:-8] if spoil == "damaged" else content)
        choose("ready", tmp_path / "cache")
        monkeypatch.setattr(shipped, "FOLDER", folder)
        shipped.manifest.cache_clear()
        with pytest.raises(shipped.Unusable):
            shipped.load(PULSES)
        monkeypatch.undo()
        shipped.manifest.cache_clear()

    def test_so_is_bitcode_that_llvm_cannot_read(self, choose, tmp_path, monkeypatch):
        choose("ready", tmp_path)
        monkeypatch.setattr(shipped, "bitcode", lambda name: b"no bitcode")
        with pytest.raises(shipped.Unusable, match="cannot be loaded"):
            shipped.load(PULSES)


class TestArguments:
    @pytest.mark.parametrize("wrong", [
        np.zeros((3, 5), np.float32), np.zeros(15), np.zeros((5, 3)).T, np.zeros((3, 5), int),
    ])  # fmt: skip
    def test_an_array_of_another_kind_is_refused(self, wrong):
        side = pulse_motion.Side(2.0, 3.0, 0.5, 0.9)
        arguments = ((side, side), wrong, np.ones(3), np.ones(3), 0, 3, np.empty((3, 6)))
        with pytest.raises(TypeError, match="an array for a kernel"):
            calling.call(shipped.load(PULSES), PULSES, arguments)

    def test_they_are_those_of_the_kernels(self):
        for each, fields in (("Deck", kernels.Deck), ("Joints", kernels.Joints), ("Samples", kernels.Samples),
                             ("Room", kernels.Room)):  # fmt: skip
            (found,) = [layout for layout in walked(HISTORIES.arguments) if layout[0] == each]
            assert len(found[1]) == len(fields._fields)
        assert len(HISTORIES.arguments) == kernels.run.__code__.co_argcount
        assert len(PULSES.arguments) == pulse_motion.many.__code__.co_argcount


def walked(layouts):
    for each in layouts:
        if isinstance(each, tuple):
            yield each
            yield from walked(each[1])


def test_a_status_other_than_0_is_an_error():
    arguments = (((0.0,) * 4,) * 2, np.zeros((1, 5)), np.zeros(1), np.zeros(1), 0, 0, np.zeros((1, 6)))
    with pytest.raises(RuntimeError, match="pulses ended with status 1"):
        calling.call(lambda *_: 1, PULSES, arguments)
