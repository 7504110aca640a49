"""The keys of all JSON are those of `json_keys.txt`: what programs read neither goes nor comes unseen."""

from __future__ import annotations

import re
import shlex
import shutil
from importlib import import_module

import pytest
from click.testing import CliRunner

from rocking_cli.cli.main import COMMANDS, main
from tests.conftest import EXAMPLES, PROJECT

with pytest.MonkeyPatch.context() as patch:
    patch.syspath_prepend(PROJECT / "scripts")
    outputs = import_module("outputs")

HELD = outputs.held_keys()
OF_ALL = ("equiv", "draw", "collapse", "mechanisms")
"""Commands that are asked of all examples but the large ones; the others are asked of one."""
LARGE = ("cracked_facade", "buttressed_arch", "wall_of_three", "wall_with_openings", "examples/assembly")
LONG = (
    "--trim",
    "--slenderness",
    '--until "peak_ratio',
    "--compare examples/block.yaml examples/frame.yaml examples/wall.yaml",
    "overturning examples/block.yaml --json",
    "report examples/frame.yaml --record",
)
"""Commands that take long; others of the same name stand for them."""


def asked() -> dict[str, list[str]]:
    """Return the examples of each command that are tried."""
    tried = {}
    for command, examples in outputs.questions().items():
        chosen = examples if command.split()[0] in OF_ALL else ["", "examples/block.yaml"]
        if not any(part in command for part in (*LARGE, *LONG)):
            tried[command] = [each for each in examples if each in chosen and not any(part in each for part in LARGE)]
    return tried


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    made = tmp_path_factory.mktemp("keys")
    shutil.copytree(EXAMPLES, made / "examples")
    return made


@pytest.mark.parametrize("command", asked())
def test_the_keys_are_those_held(command, folder, monkeypatch):
    monkeypatch.chdir(folder)
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "0")
    written = re.compile(r" --(plot|sheet) \S+")  # files change no key
    if command.startswith("results"):
        CliRunner().invoke(main, shlex.split("fragility examples/study/pedestal.yaml"))
    for example in asked()[command]:
        done = CliRunner().invoke(main, shlex.split(written.sub("", command.format(example))))
        keys = outputs.keys_of(done.stdout)
        held = HELD[command, example]
        gone, come = sorted(held - keys), sorted(keys - held)
        assert not gone and not come, f"`rocking {command.format(example)}`: gone {gone}, come {come}"


def test_every_command_is_held():
    assert {command for command, _ in HELD} == set(outputs.questions())
    assert {command.split()[0] for command in asked()} == {command.split()[0] for command, _ in HELD}
    assert {command.split()[0] for command, _ in HELD} == set(COMMANDS)
