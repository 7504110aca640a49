"""The registry: third-party packages come in by the same door, and broken ones say what is wrong with them."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from importlib.metadata import EntryPoint

import pytest

from mechanisms.block import Block
from rocking_cli.core import Mechanism
from rocking_cli.errors import InputError, MechanismError
from rocking_cli.registry import GROUP, Registry, conformance, load
from tests.conftest import EXAMPLES


@pytest.fixture(scope="module")
def installed_plugin(tmp_path_factory):
    """The example plugin, really built and installed beside this environment."""
    site = tmp_path_factory.mktemp("site")
    command = [sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", "--no-build-isolation"]
    subprocess.run([*command, "--target", str(site), str(EXAMPLES / "plugin")], check=True, capture_output=True)
    return {**os.environ, "PYTHONPATH": str(site)}


def rocking(environment, *arguments):
    command = [sys.executable, "-c", "from rocking_cli.cli.main import main; main()", *arguments]
    return subprocess.run(command, env=environment, capture_output=True, text=True, encoding="utf-8", check=False)


def test_an_installed_plugin_is_listed_with_its_package(installed_plugin):
    listed = json.loads(rocking(installed_plugin, "mechanisms", "--json").stdout)["mechanisms"]
    found = {row["name"]: row["package"] for row in listed}
    assert found["capped_block"] == "rocking-capped-block 0.1.0"
    assert found["block"].startswith("rocking-cli ")


def test_an_installed_plugin_works_in_every_command(installed_plugin, tmp_path):
    file = tmp_path / "bust.yaml"
    file.write_text(rocking(installed_plugin, "new", "capped_block").stdout, encoding="utf-8")
    equiv = json.loads(rocking(installed_plugin, "equiv", str(file), "--json").stdout)
    # Width 0.8, height 2.0, cap 0.5: centroid at (1 x 1.0 + 0.5 x 2.0)/1.5 = 4/3, so lambda = 0.4/(4/3).
    assert equiv["directions"]["positive"]["lambda"] == pytest.approx(0.3, rel=1e-12)
    respond = json.loads(rocking(installed_plugin, "respond", str(file), "--release", "0.5", "--json").stdout)
    assert respond["responses"]["nonlinear"]["peak_ratio"] == pytest.approx(0.5)


def test_the_installed_plugin_keeps_the_contract(installed_plugin):
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "-k", "capped_block"]
    run = subprocess.run(
        [*command, str(EXAMPLES.parent / "tests" / "test_contract.py")],
        env=installed_plugin,
        cwd=EXAMPLES.parent,
        capture_output=True,
        text=True,
        check=False,
    )
    assert run.returncode == 0, run.stdout
    assert "passed" in run.stdout


def entry(value, name="odd"):
    return EntryPoint(name=name, value=value, group=GROUP)


def test_a_plugin_that_cannot_be_imported_says_whose_it_is():
    with pytest.raises(MechanismError, match=r"plugin odd of .* cannot be loaded: ModuleNotFoundError"):
        load(entry("no_such_package.module:Thing"))


def test_a_plugin_that_is_no_mechanism_says_so():
    with pytest.raises(MechanismError, match="must be a class derived from"):
        load(entry("json:dumps"))


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
    with pytest.raises(MechanismError, match="the mechanism odd failed on these sizes: KeyError: 'lost'"):
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
    monkeypatch.setattr("rocking_cli.plugins.entry_points", lambda group: points)
    with pytest.raises(MechanismError, match=r"mechanisms\.block:Block.*elsewhere:Block"):
        Registry()["block"]


def test_the_same_entry_listed_twice_is_one(monkeypatch):
    monkeypatch.setattr(
        "rocking_cli.plugins.entry_points", lambda group: [entry("mechanisms.block:Block", "block")] * 2
    )
    assert Registry()["block"] is Block


def test_an_unknown_name_is_no_key():
    assert Registry().get("nope") is None


def test_an_unknown_name_comes_with_a_guess():
    with pytest.raises(InputError, match="did you mean symmetric_frame"):
        Registry()["symetric_frame"]
