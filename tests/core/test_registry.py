"""The registry: third-party packages come in by the same door, and broken ones say what is wrong with them."""

import json
import os
import re
import subprocess
import sys
import warnings
from importlib.metadata import EntryPoint
from math import atan

import pytest
from click.testing import CliRunner

import rocking_cli as rk
from mechanisms.block import Block
from rocking_cli.cli.main import main
from rocking_cli.core import Direction, Mechanism, equivalent_block
from rocking_cli.core.registry import Registry, conformance
from rocking_cli.core.structure_file import parse_structure
from rocking_cli.errors import InputError, MechanismError, PluginWarning
from rocking_cli.plugins.registry import load
from rocking_cli.processing.intensity import all_measures
from rocking_cli.testing import CHECKS
from tests.cli.test_cli import run, run_json
from tests.conftest import EXAMPLES, rows_of


def shown(*arguments):
    """What a command prints and its exit code, whatever that is."""
    return CliRunner().invoke(main, [str(each) for each in arguments])


@pytest.fixture(scope="module")
def site_of_example(tmp_path_factory):
    """The example plugin, really built and installed, in a folder of its own."""
    site = tmp_path_factory.mktemp("site")
    command = [sys.executable, "-m", "uv", "pip", "install", "--quiet", "--offline", "--no-cache", "--no-deps"]
    where = ["--no-build-isolation", "--python", sys.executable, "--target", str(site)]
    subprocess.run([*command, *where, str(EXAMPLES / "plugin")], check=True, capture_output=True)
    return site


@pytest.fixture
def installed_plugin(site_of_example, monkeypatch):
    monkeypatch.syspath_prepend(site_of_example)


@pytest.mark.usefixtures("installed_plugin")
def test_an_installed_plugin_works_in_every_command(tmp_path):
    (tmp_path / "bust.yaml").write_text(run("new", "capped_block").stdout, encoding="utf-8")
    # Width 0.8, height 2.0, cap 0.5: centroid at (1 x 1.0 + 0.5 x 2.0)/1.5 = 4/3, so lambda = 0.4/(4/3).
    assert run_json("equiv", "bust.yaml")["directions"]["positive"]["lambda"] == pytest.approx(0.3, rel=1e-12)
    responses = run_json("respond", "bust.yaml", "--release", "0.5", "--neighbours", 0)["responses"]
    assert responses["nonlinear"]["peak_ratio"] == pytest.approx(0.5)
    packages = {row["name"]: row["package"] for row in run_json("mechanisms")["mechanisms"]}
    assert packages["capped_block"] == "rocking-capped-block 0.1.0" and packages["block"].startswith("rocking-cli ")


@pytest.mark.usefixtures("installed_plugin")
def test_an_installed_plugin_carries_loads_ties_and_side_walls():
    """Its author wrote no line for them: a mass in place of its cap does what the cap does."""
    text = "mechanism: capped_block\nwidth: 0.8\nheight: 2\nmass: 1000\n"
    more = {
        "load": "cap_mass: 0\nloads:\n  - {name: cap, body: block, mass: 500, at: [0, 2]}\n",
        "cap": "cap_mass: 0.5\n",
        "tie": "cap_mass: 0\nties:\n"
        "  - {name: t, from: {ground: [0, 0]}, to: {body: block, at: [0, 0]}, stiffness: 5e3}\n",
        "side": "cap_mass: 0.5\none_sided: negative\nrebound: 0.4\n",
    }
    structures = {name: parse_structure(text + lines, name, name) for name, lines in more.items()}
    blocks = {name: equivalent_block(each)[Direction.NEGATIVE] for name, each in structures.items()}
    for key in ("lambda_", "phi_cr", "p", "eta"):
        assert getattr(blocks["load"], key) == pytest.approx(getattr(blocks["cap"], key), rel=1e-9)
    velocity = {
        name: rk.respond(each, release=-0.0349, model="nonlinear", neighbours=0)["nonlinear"].impacts[0, 2]
        for name, each in structures.items()
    }
    assert velocity["cap"] == pytest.approx(velocity["load"], rel=1e-9) == velocity["side"]
    assert blocks["tie"].phi_cr > atan(0.4) and blocks["side"].eta == 0.4


ODD = """
import sys
from math import atan, pi
from rocking_cli.core import Body, Mechanism, box, length, rotation

print("printed on import")

class Odd(Mechanism):
    mechanism, title, source = "odd", "an odd block", "a test"
    width: float = length("width of the base", example=1.0)

    def bodies(self):
        return [box("block", 1.0, self.width, 4 * self.width, 2j * self.width)]

    def motion(self, phi, direction):
        print("printed at work")
        return [rotation(phi, complex(direction * self.width / 2), -direction)]

    def limit(self, direction):
        return pi / 2

class Divides(Odd):
    mechanism = "divides"

    def bodies(self):
        return [box("block", 1 / 0, 1, 1, 0j)]

class Leaves(Odd):
    mechanism = "leaves"

    def bodies(self):
        sys.exit(0)

class Negative(Odd):
    mechanism = "negative"

    def bodies(self):
        return [Body("cap", -0.5, 0.0, 1j)]

class NoExample(Odd):
    mechanism = "no_example"
    load: float = length("a load that no file can be without")

class Doubled(Odd):
    mechanism = "doubled"

    def critical_rotation_alone(self, direction):
        return 1.0001 * atan(1 / 4)
"""
READER = """
TITLE, SIGN = "an odd format", "ODD on its first line"
print("printed on import of a reader")

def sniff(content):
    print("printed by sniff")
    return content.startswith("ODD")

def read(content, file, **options):
    return {}["lost"]
"""
MEASURES = """
from dataclasses import dataclass, field
from rocking_cli.processing.intensity import MotionMeasure

@dataclass(frozen=True)
class Squared(MotionMeasure):
    times: float = field(default=1.0)
    name, title, unit, power = "PGA squared", "a test", "g2", 2.0

    def of(self, motion):
        return self.times * motion.pga_g**2

class Divides(MotionMeasure):
    name, title, power = "Divides", "a test", 1.0

    def of(self, motion):
        return 1 / 0

class NoPower(MotionMeasure):
    name, title = "NoPower", "a test"

    def of(self, motion):
        return 1.0
"""
MODULES = {
    "odd.py": ODD,
    "odd_leaves.py": "import sys\nsys.exit(0)\n",
    "odd_breaks.py": "broken = 1 / 0\n",
    "odd_reader.py": READER,
    "odd_sniffer.py": READER.replace('return content.startswith("ODD")', "return 1 / 0"),
    "odd-1.0.dist-info/METADATA": "Metadata-Version: 2.1\nName: odd\nVersion: 1.0\n",
    "odd-1.0.dist-info/entry_points.txt": """
[rocking.mechanisms]
odd = odd:Odd
divides = odd:Divides
leaves = odd:Leaves
negative = odd:Negative
no_example = odd:NoExample
doubled = odd:Doubled
leaver = odd_leaves:Leaver
breaker = odd_breaks:Breaker

[rocking.records]
breaking_format = odd_breaks
leaving_format = odd_leaves
odd_format = odd_reader
sniffing_format = odd_sniffer

[rocking.pulses]
leaving_pulse = odd_leaves:Leaver

[rocking.measures]
PGA squared = odd_measures:Squared
Divides = odd_measures:Divides
Leaves = odd_leaves:Leaver
NoPower = odd_measures:NoPower
""",
    "odd_measures.py": MEASURES,
}


@pytest.fixture(scope="module")
def odd_site(tmp_path_factory):
    """A package whose plugins go wrong in every way, in a folder of its own."""
    site = tmp_path_factory.mktemp("odd")
    for name, text in MODULES.items():
        (site / name).parent.mkdir(exist_ok=True)
        (site / name).write_text(text, encoding="utf-8")
    return site


@pytest.fixture
def odd_plugin(odd_site, monkeypatch):
    """The package beside this environment, not yet imported and not yet spoken of."""
    monkeypatch.syspath_prepend(odd_site)
    monkeypatch.setattr("rocking_cli.plugins.registry._LEFT_OUT", set())
    for name in [name for name in sys.modules if name.startswith("odd")]:
        monkeypatch.delitem(sys.modules, name)


@pytest.mark.usefixtures("odd_plugin")
class TestMeasuresOfOthers:
    def test_one_is_listed_printed_and_taken_by_a_study(self, tmp_path):
        listed = json.loads(shown("measures", "--json").stdout)["measures"]
        found = {each["name"]: each for each in listed}
        assert found["PGA squared"]["package"] == "odd 1.0" and found["PGA squared"]["power"] == 2
        assert found["Leaves"]["title"] is None and found["Sa"]["package"].startswith("rocking-cli ")
        done = shown("record", EXAMPLES / "accel.csv", "--measures", "pga SQUARED( 3 )", "--json")
        assert json.loads(done.stdout)["measures"] == {"PGA squared(3.0)": pytest.approx(3 * 0.55**2)}
        study = tmp_path / "study.yaml"
        study.write_text(
            f"structures: ['{EXAMPLES / 'block.yaml'}']\nrecords: ['{EXAMPLES / 'accel.csv'}']\nmethod: stripes\n"
            "levels: {measure: PGA squared, values: [0.3025, 1.21]}\n",
            encoding="utf-8",
        )
        done = shown("fragility", str(study), "--json")
        assert done.exit_code == 0 and json.loads(done.stdout)["curves"][0]["measure"] == "PGA squared"
        shown("results", tmp_path / "study.runs", "--out", tmp_path / "runs.csv")
        rows = rows_of(tmp_path / "runs.csv")
        assert [float(row["scale"]) for row in rows] == pytest.approx([1.0, 2.0])

    @pytest.mark.parametrize(
        ("name", "said"),
        [
            ("divides", r"the measure Divides failed in of: ZeroDivisionError: .* \(.*odd_measures\.py:\d+\)"),
            ("leaves", r"plugin Leaves of odd 1\.0 .* cannot be loaded: SystemExit"),
            ("nopower", r"plugin NoPower of odd 1\.0 .* is not a measure: it must derive"),
        ],
    )
    def test_what_goes_wrong_is_its_own(self, name, said):
        done = shown("record", EXAMPLES / "accel.csv", "--measures", name)
        assert done.exit_code == 3 and re.search(said, done.stderr) and "Traceback" not in done.stderr
        broken = json.loads(shown("info", "--json").stdout)["plugins"]["measures"]
        assert {each["name"] for each in broken if each["broken"]} == {"Leaves", "NoPower"}

    def test_one_that_cannot_be_loaded_leaves_all_others(self):
        with pytest.warns(PluginWarning, match="it is left out"):
            names = set(map(str, all_measures()))
        assert {"PGA", "PGA squared", "Divides"} <= names and "Leaves" not in names


@pytest.mark.usefixtures("odd_plugin")
class TestPluginsThatGoWrong:
    def test_what_they_print_does_not_spoil_the_results(self, odd_site, tmp_path):
        new = shown("new", "odd")
        assert new.stdout.startswith("# an odd block") and "printed on import" in new.stderr
        (tmp_path / "odd.yaml").write_text(new.stdout, encoding="utf-8")
        path = os.pathsep.join([str(odd_site), *filter(None, [os.environ.get("PYTHONPATH")])])
        command = [sys.executable, "-c", "from rocking_cli.cli.main import main; main()", "equiv", "odd.yaml", "--json"]
        done = subprocess.run(
            command, env={**os.environ, "PYTHONPATH": path}, capture_output=True, text=True, check=True
        )
        assert json.loads(done.stdout)["mechanism"] == "odd"
        assert "printed on import" in done.stderr and "printed at work" in done.stderr

    def test_broken_readers_leave_every_other_format_readable(self):
        files = [EXAMPLES / name for name in ("accel.csv", "accel_transverse.csv")]
        done = shown("record", *files, "--json")
        assert done.exit_code == 0
        assert [json.loads(line)["npts"] for line in done.stdout.splitlines()] == [1201, 1201]
        for name, why in {
            "breaking_format": r"cannot be loaded: ZeroDivisionError: .* \(.*odd_breaks\.py:1\)",
            "leaving_format": r"cannot be loaded: SystemExit: 0 \(.*odd_leaves\.py:2\)",
            "sniffing_format": r"failed to say whether .*: ZeroDivisionError: .* \(.*odd_sniffer\.py:\d+\)",
        }.items():
            told = re.findall(rf"warning: plugin {name} of odd 1\.0 \(.*\) {why}; it is left out", done.stderr)
            assert len(told) == 1, done.stderr
        assert "Traceback" not in done.stderr and not re.search("odd_format.*left out", done.stderr)
        assert (
            "warning: plugin odd_format of odd 1.0 (odd_reader) prints: printed on import of a reader\n" in done.stderr
        )

    def test_a_file_that_nobody_claims_mentions_them_again(self, tmp_path):
        (tmp_path / "none.txt").write_text("nothing of the kind\n", encoding="utf-8")
        done = shown("record", tmp_path / "none.txt")
        assert done.exit_code == 2
        tried = done.stderr.split("one of these formats:")[1]
        assert " an odd format, ASA, COSMOS, CSMIP V2," in tried.splitlines()[0] and "cannot be used," not in tried
        for name in ("breaking_format", "leaving_format", "sniffing_format"):
            assert f"{name} (cannot be used: plugin {name} of odd 1.0" in tried

    def test_a_reader_that_fails_on_its_file_costs_only_that_file(self, tmp_path, monkeypatch):
        (tmp_path / "odd.txt").write_text("ODD\n", encoding="utf-8")
        done = shown("record", tmp_path / "odd.txt", EXAMPLES / "accel.csv", "--json")
        assert done.exit_code == 5 and json.loads(done.stdout)["npts"] == 1201
        assert re.search(
            r"odd\.txt: plugin odd_format of odd 1\.0 .* KeyError: 'lost' \(.*odd_reader\.py:\d+\)", done.stderr
        )
        monkeypatch.setenv("ROCKING_DEBUG", "1")
        alone = shown("respond", "--record", tmp_path / "odd.txt")
        assert alone.exit_code == 3 and "Traceback" in alone.stderr and 'return {}["lost"]' in alone.stderr

    @pytest.mark.parametrize(
        ("name", "said"),
        [
            ("divides", r"the mechanism divides failed in bodies: ZeroDivisionError: .* \(.*odd\.py:\d+\)"),
            ("leaves", r"the mechanism leaves failed in bodies: SystemExit: 0 \(.*odd\.py:\d+\)"),
            ("negative", r"the mechanism negative failed in bodies: ValueError: the mass of body 'cap' is -0\.5 kg"),
        ],
    )
    def test_an_error_of_a_mechanism_is_its_own(self, name, said, tmp_path, monkeypatch):
        file = tmp_path / "odd.yaml"
        file.write_text(f"mechanism: {name}\nwidth: 1.0\n", encoding="utf-8")
        done = shown("equiv", file, "--json")
        assert (done.exit_code, done.stdout) == (3, "")
        assert re.search(said, done.stderr)
        assert "check the sizes" not in done.stderr and "Traceback" not in done.stderr
        monkeypatch.setenv("ROCKING_DEBUG", "1")
        debug = shown("equiv", file).stderr
        assert "Traceback" in debug and "odd.py" in debug and "plugin_errors.py" not in debug

    def test_a_pulse_that_leaves_does_not_end_the_program(self):
        done = shown("respond", "--pulse", "leaving_pulse:0.4g:1s")
        assert done.exit_code == 3
        assert re.search(r"plugin leaving_pulse of odd 1\.0 .* cannot be loaded: SystemExit", done.stderr)

    def test_info_names_what_is_broken_and_shows_the_rest(self):
        done = shown("info", "--json")
        assert done.exit_code == 0 and "Traceback" not in done.stderr
        plugins = json.loads(done.stdout)["plugins"]
        broken = {each["name"]: each["broken"] for kind in plugins.values() for each in kind}
        assert "cannot be loaded: SystemExit" in broken["leaving_pulse"] and broken["breaking_format"] is not None
        assert broken["arch"] is None and broken["odd"] is None and broken["peer_at2"] is None
        assert "odd 1.0" in {each["package"] for each in plugins["mechanisms"]}
        assert "broken: leaving_pulse" in shown("info").stdout

    def test_new_says_what_to_fill_in_where_there_is_no_example(self):
        done = shown("new", "no_example")
        assert "# Fill in load: the mechanism gives no example.\n" in done.stdout
        assert re.search(r"\nload: +# fill in: a load that no file can be without \[m\]", done.stdout)
        assert "this file does not work as it is" in done.stderr
        assert "Fill in" not in shown("new", "odd").stdout

    @pytest.mark.parametrize(
        ("name", "failing", "said"),
        [
            ("odd", set(), ""),
            (
                "doubled",
                {"stands_and_can_overturn", "closed_forms_agree_with_the_solvers", "may_lean_on_side_walls"},
                "critical_rotation_alone",
            ),
            ("no_example", {"makes_a_structure"}, "load must be a number in m, got nothing"),
            ("leaver", {"loads"}, "SystemExit: 0"),
            ("breaker", {"loads"}, "ZeroDivisionError"),
        ],
    )
    def test_check_says_what_passes_and_what_fails(self, name, failing, said):
        done = shown("mechanisms", "--check", name, "--json")
        found = json.loads(done.stdout)
        assert {each["check"] for each in found["checks"] if not each["passed"]} == failing
        assert (done.exit_code, found["passed"]) == ((3, False) if failing else (0, True))
        assert (found["mechanism"], found["package"], found["file"]) == (name, "odd 1.0", None)
        assert said in " ".join(each["why"] or "" for each in found["checks"])

    def test_check_shows_the_traceback_of_what_cannot_be_loaded_or_fails(self):
        done = shown("mechanisms", "--check", "breaker")
        assert done.exit_code == 3
        assert re.search(r"FAILS .*\nTraceback(.*\n)+ .*odd_breaks\.py.*(.*\n)+ZeroDivisionError", done.stdout)
        told = shown("mechanisms", "--check", "divides").stdout
        assert told.count("Traceback") == 1 and "1 / 0" in told and "Same error as above." in told
        checks = [line for line in told.splitlines() if line.startswith(("passes ", "FAILS "))]
        assert len(checks) == len(CHECKS) + 2


@pytest.mark.parametrize(
    ("part", "fields"),
    [
        ("strength", {"stress": None, "width": None}),
        ("uncertainty", {"slenderness": ">= 0, < 1", "restitution": ">= 0, < 1"}),
    ],
)
def test_the_fields_of_what_may_be_added_to_any_mechanism_are_listed(part, fields):
    found = run_json("mechanisms", part)
    rows = {row["field"]: row for row in found["fields"][part]}
    assert found["part"] == part and set(rows) == set(fields)
    assert all(bounds in (None, rows[name]["bounds"]) for name, bounds in fields.items())
    assert all(row["description"] and row["example"] is not None for row in rows.values())
    text = run("mechanisms", part).stdout
    assert all(name in text for name in fields) and f"`{part}` of any mechanism" in text
    assert f"`{part}`" in run("mechanisms").stdout


def test_check_takes_a_file(tmp_path):
    file = tmp_path / "wall.yaml"
    file.write_text("mechanism: wall\nthickness: 0.3\nheight: 3\n", encoding="utf-8")
    found = run_json("mechanisms", "--check", "wall", file)
    assert found["passed"] and found["file"] == str(file) and len(found["checks"]) == len(CHECKS) + 1
    assert (
        "is a structure of the mechanism wall, not of block"
        in run("mechanisms", "--check", "block", file, code=2).stderr
    )
    assert "did you mean wall?" in run("mechanisms", "--check", "wal", code=2).stderr
    assert "needs the NAME" in run("mechanisms", "--check", code=2).stderr
    assert "FILE requires --check" in run("mechanisms", "wall", file, code=2).stderr


def test_printing_from_other_threads_is_kept_out_of_the_results():
    # What a plugin's thread prints while a command runs, and while two commands run one in the other.
    code = (
        "import threading\n"
        "from rocking_cli.cli import terminal\n"
        "with terminal.results_only():\n"
        "    thread = threading.Thread(target=print, args=('noise',)); thread.start(); thread.join()\n"
        "    with terminal.results_only():\n"
        "        print('noise'); terminal.result('inner')\n"
        "    print('noise'); terminal.print_json({'a': 1}); terminal.sentence('t')\n"
        "print('after')\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stderr.split() == ["noise"] * 3
    assert done.stdout.startswith('inner\n{"a": 1}\nt') and done.stdout.endswith("after\n")


def entry(value, name="odd"):
    return EntryPoint(name=name, value=value, group=Registry.group)


def test_a_plugin_that_cannot_be_imported_says_whose_it_is():
    with pytest.raises(MechanismError, match=r"plugin odd of .* cannot be loaded: ModuleNotFoundError"):
        load(entry("no_such_package.module:Thing"))


def test_a_plugin_that_is_no_mechanism_says_so():
    with pytest.raises(MechanismError, match="must be a class derived from"):
        Registry.accept(load(entry("json:dumps")), entry("json:dumps"))


def test_a_plugin_that_fails_or_miscounts_is_called_by_its_name():
    from rocking_cli.core import box, equivalent_block, rotation

    class Odd(Mechanism):
        mechanism, title, source = "odd", "odd", "odd"
        fail: bool = False

        def bodies(self):
            return [box("a", 1.0, 1.0, 4.0, 2j)] * 2

        def motion(self, phi, direction):
            if self.fail:
                raise KeyError("lost")
            return [rotation(phi, 0.5 * direction, -direction)]

        def limit(self, direction):
            return 1.0

    with pytest.raises(MechanismError, match="1 motions for 2 bodies"):
        equivalent_block(Odd())
    with pytest.raises(
        MechanismError, match=r"the mechanism odd failed in motion: KeyError: 'lost' \(.*test_registry\.py:\d+\)"
    ):
        equivalent_block(Odd(fail=True))


def test_everything_missing_from_a_plugin_is_named():
    class Half(Mechanism):
        def limit(self, direction):
            return 1.0

    faults = " ".join(conformance(Half, "half"))
    assert all(word in faults for word in ("method bodies", "method motion", "mechanism", "title", "source"))
    assert "limit" not in faults


def test_a_name_that_differs_from_the_entry_point_is_a_fault():
    assert conformance(Block, "block") == []
    assert "'block'" in conformance(Block, "brick")[0] and "'brick'" in conformance(Block, "brick")[0]


def test_a_name_claimed_twice_is_an_error_that_names_both(monkeypatch):
    points = [entry("mechanisms.block:Block", "block"), entry("elsewhere:Block", "block")]
    monkeypatch.setattr("rocking_cli.plugins.registry.entry_points", lambda group: points)
    with pytest.raises(MechanismError, match=r"mechanisms\.block:Block.*elsewhere:Block"):
        Registry()["block"]


def test_the_same_entry_listed_twice_is_one(monkeypatch):
    monkeypatch.setattr(
        "rocking_cli.plugins.registry.entry_points", lambda group: [entry("mechanisms.block:Block", "block")] * 2
    )
    assert Registry()["block"] is Block


def test_packages_are_searched_again_only_when_one_may_have_come_or_gone(tmp_path, monkeypatch):
    monkeypatch.syspath_prepend(tmp_path)
    assert "late" not in Registry()
    with monkeypatch.context() as unread:
        unread.setattr("rocking_cli.plugins.registry.metadata.entry_points", lambda group: pytest.fail("searched"))
        assert "block" in Registry()
    os.utime(tmp_path, ns=(1, 1))  # whatever the clock of the file system
    _package(tmp_path, "late", b"[rocking.mechanisms]\nlate = elsewhere:Late\n")
    assert Registry().package_of("late") == "late 1.0"
    sys.path.remove(str(tmp_path))
    assert "late" not in Registry()


def _package(folder, name, entries):
    (info := folder / f"{name}-1.0.dist-info").mkdir()
    (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: 1.0\n", encoding="utf-8")
    (info / "entry_points.txt").write_bytes(entries)


@pytest.mark.parametrize("broken", [b"[console_scripts]\nno pair\n", b"[x]\n\xe9 = a:b\n"])
def test_a_package_whose_entry_points_are_broken_is_named_and_costs_no_other(broken, tmp_path, monkeypatch):
    monkeypatch.syspath_prepend(tmp_path)
    _package(tmp_path, f"broken{len(broken)}", broken)
    _package(tmp_path, "whole", b"[rocking.mechanisms]\nnew = elsewhere:New\n")
    said = run("mechanisms").stderr
    assert f"entry_points.txt of the package broken{len(broken)} in {tmp_path} cannot be read: " in "".join(
        said.split("\n")
    )
    assert {"block", "new"} <= set(Registry()) and Registry().package_of("new") == "whole 1.0"


def test_a_plugin_that_loads_slowly_or_prints_is_named_at_the_first_time(tmp_path, monkeypatch):
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setattr("rocking_cli.plugins.registry.SLOW_LOADING", 0.01)
    (tmp_path / "slow_odd.py").write_text("import time\nprint('so\\nslow')\ntime.sleep(0.5)\nA = 1\n", encoding="utf-8")
    with pytest.warns(PluginWarning) as told:
        assert load(entry("slow_odd:A")) == 1
    said = "plugin odd of unknown package (slow_odd:A) "
    assert [str(each.message) for each in told] == [f"{said}is still loading", f"{said}prints: so\\nslow"]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert load(entry("slow_odd:A")) == 1


def test_an_unknown_name_is_no_key():
    assert Registry().get("nope") is None


def test_an_unknown_name_comes_with_a_guess():
    with pytest.raises(InputError, match="did you mean symmetric_frame"):
        Registry()["symetric_frame"]
