"""Every option of a command that is made of a question reaches the question, as it was typed."""

import click
import pytest
from click.testing import CliRunner

from rocking_cli.cli.made import Made
from rocking_cli.cli.main import main
from rocking_cli.plugins.rooms import commands, names

OTHERS = {
    "mechanisms": "lists plugins: `rk.mechanisms`",
    "measures": "lists plugins",
    "new": "prints starters",
    "info": "describes the installation",
    "completion": "prints a script for a shell",
}
"""Commands that ask nothing about a structure or a motion."""


class Heard(Exception):
    """What a command asks."""


@pytest.fixture
def ask(monkeypatch):
    def hear(self, given, usual, watch):
        raise Heard(given, watch)

    def ask(name, *words):
        monkeypatch.setattr(type(command(name)), "ask", hear)
        result = CliRunner().invoke(main, [name, *words])
        if result.exit_code == 2 and " has no effect without --" in result.output:
            return None, None
        assert isinstance(result.exception, Heard), result.output
        return result.exception.args

    return ask


def command(name):
    return main.get_command(click.Context(main), name)


def needed(made, but=None):
    """The words without which a command does not run."""
    words = ["odd" for each in made.params if isinstance(each, click.Argument) and each.required]
    return words + [
        word for each in made.params if isinstance(each, click.Option) and each.required and each is not but
        for word in (each.opts[0], "odd")
    ]  # fmt: skip


@pytest.mark.parametrize("name", [name for name in commands() if name not in OTHERS])
def test_every_option_reaches_the_question(name, ask):
    made = command(name)
    assert isinstance(made, Made) and (name in names() or name == "import")
    given, _ = ask(name, *needed(made))
    for option in made.params:
        if not isinstance(option, click.Option) or option.name in ("as_json", "in_full", "pulses"):
            continue
        value = "odd.AT2" if option.name == "records" else "odd"
        words = [max(option.opts, key=len)] if option.is_flag else [max(option.opts, key=len), value]
        heard, _ = ask(name, *needed(made, option), *words)
        if heard is None:  # refused by its name, as it asks for what a file would show
            continue
        field = "motions" if option.name == "records" else option.name
        changed = {each: heard[each] for each in heard if each not in given or heard[each] != given[each]}
        assert field in changed or option.required, (option.name, heard)
        if field != "motions" and not option.is_flag:
            assert heard[field] == (("odd",) if option.multiple else "odd")


@pytest.mark.parametrize("name", [name for name in commands() if name not in OTHERS])
def test_pulses_are_motions_and_json_and_all_are_for_the_terminal(name, ask):
    made = command(name)
    assert {"as_json", "in_full"} <= {each.name for each in made.params}
    if "pulses" in {each.name for each in made.params}:
        given, _ = ask(name, *needed(made), "--pulse", "sine:0.4g:0.8s", "--pulse", "ricker:0.2g:1s")
        assert [each.period for each in given["motions"]] == [0.8, 1.0]
