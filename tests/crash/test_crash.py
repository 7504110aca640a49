"""A sample of `make crash`, and whether it knows every output of every command."""

import re

import click
import pytest

from rocking_cli.cli.main import main
from rocking_cli.plugins.rooms import commands
from tests.crash.attacks import LINES, attack
from tests.crash.calls import Call, losses, why_not

READ = {"--with", "--structure", "--target", "--vertical", "--site", "--strengthened", "--logo", "--free"}
READ |= {"--record", "--set", "--verify", "--walls", "--transverse", "--mesh"}
"""Options that name files that are read."""


def test_every_output_of_every_command_is_tried():
    for name in commands():
        command = main.get_command(click.Context(main), name)
        places = {max(each.opts, key=len): each.opts for each in command.params if _is_place(each)}
        lines = [line.split() for line in LINES.values() if line.startswith(f"{name} ")]
        for option, ways in places.items():
            assert option in READ or any(way in line for way in ways for line in lines), f"{name} {option}"


def _is_place(option):
    return isinstance(option, click.Option) and re.search(r"FILE|FOLDER|PLACE|[A-Z]\.[a-z]", option.metavar or "")


def test_what_a_power_loss_leaves(tmp_path):
    """A file that is renamed before it is synchronized is empty; its name is sure when its folder is synchronized."""
    new, old = tmp_path / "new", tmp_path / "old"
    made = Call("openat", 1, (new,), b"", None, "O_WRONLY|O_CREAT", "3")
    write = Call("write", 1, (new,), b"text", 3, "", "4")
    sync = Call("fsync", 1, (new,), b"", 3, "", "0")
    rename = Call("rename", 1, (new, old), b"", None, "", "0")
    look = Call("openat", 2, (tmp_path,), b"", None, "O_RDONLY|O_DIRECTORY", "4")
    names = Call("fsync", 2, (tmp_path,), b"", 4, "", "0")
    name, before = old.relative_to(tmp_path), {old.relative_to(tmp_path): b"old"}
    for calls, last, sure in (
        ([made, write, rename], b"", b"old"),
        ([made, write, sync, rename], b"text", b"old"),
        ([made, sync, write, rename], b"", b"old"),
        ([made, write, sync, rename, look, names], b"text", b"text"),
    ):
        lost, kept = losses(calls, tmp_path, before)
        assert lost[-1] == {name: last} and kept[name] == sure


@pytest.mark.rest
@pytest.mark.skipif(why_not() is not None, reason=str(why_not()))
@pytest.mark.parametrize(("name", "one_in"), [("error", 16), ("new", 12), ("sheets", 40), ("restart", 60)])
def test_whatever_ends_a_command_its_outputs_are_whole(name, one_in, tmp_path):
    tries, faults = attack(name, tmp_path / name, one_in)
    assert tries["SIGKILL"] and tries["EIO"]
    assert not faults
