"""The help of every command speaks one language: section 6 of the style guide, checked command by command."""

import re

import click
from click.testing import CliRunner

from rocking_cli.cli.help import CORRECTIONS_HEADING, HEADINGS, RECORDS_HEADING, heading_of
from rocking_cli.cli.main import main
from rocking_cli.plugins.rooms import commands
from rocking_cli.processing.reading_options import CORRECTIONS

WIDEST = 60
NO_VERBS = ("The", "A", "An", "Its", "What", "Which", "Who", "How", "Where", "Whether")
QUESTIONS = ("Which", "How many", "How much", "What", "Who", "Where", "Whether")
DIFFERENT = {
    "--a": "of `error` it is a constant acceleration, of the others the amplitude of a pulse",
    "--at": "`draw` draws one rotation, `error` evaluates several",
    "--count": "of `select` records, of `spectrum` sizes",
    "--check": "`fragility` shows a plan, `mechanisms` checks a mechanism",
    "--language": "of `verify` that of the sheet, of `new` that of the comments of a template",
    "--points": "of `design` the values of a scan, of `overturning` the points of an axis",
    "--neighbours": "of a motion, of each structure of a table, or of each value that is tried",
    "--pulse": "of `equivalent_pulses` it is sized, of the others a motion",
    "--site": "of `survey` each structure is verified and ranked there",
    "--out": "the text names what is written",
    "--period": "of `record` it is that of a spectrum, of the others that of a pulse",
    "--plot": "the text names what is plotted",
    "--azimuth": "of `import` it is that of a mesh, of the others that of the structure between two components",
    "--model": "`respond` takes several",
    "--omega": "of `overturning` a range",
    "--ag": "of `overturning` a range",
    "--shape": "of `overturning` that of all pulses",
    "--page": "of `import` it shows a mesh, of `survey` a table",
    "--restitution": "of `pulse` that of the linear block, of `equivalent_pulses` whose it is",
    "--scale": "of `import` it is that of a drawing, of the others a factor on motions",
    "--units": "of `import` it is that of a drawing or mesh, of the others that of a record",
    "--state": "of `select` it is that of the target, of the others that of the records",
}
"""Options whose meaning differs between commands, and why one text would be false."""
ONCE = {f"--{name}" for name in CORRECTIONS}
"""Options that are declared as multiple only to refuse a second one by themselves."""

COMMANDS_BY_NAME = {name: main.get_command(click.Context(main), name) for name in commands()}
EVERY_OPTION = [
    (name, max(each.opts, key=len), each)
    for name, command in COMMANDS_BY_NAME.items()
    for each in command.params
    if isinstance(each, click.Option) and not each.hidden
]


def words(option):
    """Return the help text of an option without its default, which may differ between commands."""
    return re.sub(r"  \[default: .*\]$", "", option.help or "")


def test_the_short_help_of_a_command_is_a_verb_and_its_object():
    wrong = []
    for name, command in COMMANDS_BY_NAME.items():
        said = command.get_short_help_str(1000)
        if len(said) > WIDEST:
            wrong.append(f"{name}: {len(said)} characters: {said}")
        if not said.endswith("."):
            wrong.append(f"{name}: no full stop: {said}")
        for text in (said, command.help):
            first = text.split()[0]
            if not re.fullmatch(r"[A-Z][a-z]+,?", first) or first in NO_VERBS:
                wrong.append(f"{name}: {first} is not a verb: {text}")
    assert not wrong, "\n".join(wrong)


def test_options_of_one_name_have_one_text():
    texts = {}
    for name, option, each in EVERY_OPTION:
        texts.setdefault(option, {}).setdefault(words(each), []).append(name)
    for option, found in texts.items():
        assert (len(found) > 1) == (option in DIFFERENT), f"{option}: {found}"


def test_an_option_says_what_its_value_is():
    wrong = []
    for name, option, each in EVERY_OPTION:
        said = words(each)
        if not said[:1].isupper() or not said.rstrip().endswith((".", "standard output.")):
            wrong.append(f"{name} {option} is no sentence: {said!r}")
        if begun := re.match(rf"({'|'.join(QUESTIONS)})\b", said):
            wrong.append(f"{name} {option} begins with {begun[0]}: {said}")
        several = each.multiple and option not in ONCE and (name, option) not in ONCE
        if several and "Repeatable." not in said:
            wrong.append(f"{name} {option} may be given several times and does not say Repeatable.: {said}")
    assert not wrong, "\n".join(wrong)


def test_every_option_stands_under_its_heading():
    wrong = []
    for name in commands():
        result = CliRunner().invoke(main, [name, "--help"], env={"COLUMNS": "100"})
        heads = "|".join(HEADINGS)
        parts = dict(zip(*[iter(re.split(rf"^({heads}):\n", result.output, flags=re.MULTILINE)[1:])] * 2, strict=True))
        for _, option, each in (found for found in EVERY_OPTION if found[0] == name):
            listed = re.compile(rf"^  (-\w, )?{option}\b(?!-)", re.MULTILINE)
            where = [head for head, rows in parts.items() if listed.search(rows)]
            wrong += [] if where == [heading_of(each)] else [f"{name} {option} is listed under {where}"]
    assert not wrong, "\n".join(wrong)


def test_every_command_that_reads_records_has_the_same_options_for_that_and_one_corrects_them():
    listed = {RECORDS_HEADING: {}, CORRECTIONS_HEADING: {}}
    for name, option, each in EVERY_OPTION:
        if heading_of(each) in listed and not option.startswith("--vertical"):
            listed[heading_of(each)].setdefault(name, []).append(option)
    reading = listed[RECORDS_HEADING]
    assert len(reading) > 10 and len({tuple(each) for each in reading.values()}) == 1, reading
    assert set(listed[CORRECTIONS_HEADING]) == {"record"}
