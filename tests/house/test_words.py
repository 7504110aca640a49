"""Words of names, texts and helps, by lists: what says nothing, what is not English, what each option has to say."""

import re
from collections import defaultdict

import click

from rocking_cli.cli.help import CORRECTIONS_HEADING, HEADINGS, RECORDS_HEADING, heading_of
from rocking_cli.cli.main import main
from rocking_cli.errors import Problem
from rocking_cli.plugins.rooms import commands
from rocking_cli.processing.reading_options import CORRECTIONS
from tests.conftest import PROJECT

VAGUE = (
    "MOST|LEAST|FEW|MANY|MUCH|ENOUGH|ALL|EVERY|SOME|FIRST|LAST|SMALL|LARGE|BIG|TINY|HUGE|CLOSE|NEAR|FAR|LONG|LONGEST|"
    "LARGEST|SHORT|SLOW|FAST|HIGH|LOW|THIN|WIDE|STRONG|WEAK|FAINT|OFTEN|SAME|SIMILAR|GOOD|BAD|FINE|COARSE|BEHIND|BEFORE|"
    "AFTER|ABOVE|BELOW|BEYOND|APART|STILL|IDLE|LATE|EARLY|SOON|THING|STUFF|TMP"
)
"""Constants that have neither what is limited nor its kind: `MAX_NAMED_MOTIONS` has both, `MANY` none."""
EMPTY = r"found|said|near|own|thing|stuff|foo|te?mp|(?:data|item|list|obj|res|result|text|tmp|val|value)\d+"
"""Locals that do not say what they hold."""
VAGUE_CONSTANTS = {
    "rocking_cli/dynamics/kernels.py": {"FAINT", "IDLE", "LONG", "SLOW"},
    "rocking_cli/dynamics/openings.py": {"APART", "LARGEST", "LONGEST"},
    "rocking_cli/dynamics/stepping.py": {"BEHIND"},
    "rocking_cli/dynamics/pulse_motion.py": {"FAINT", "STILL"},
    "rocking_cli/plotting/style.py": {"FAINT", "SMALL", "THIN", "TINY"},  # steps of a scale, read as `style.SMALL`
}
"""Constants that keep a vague name: that of the kernels cannot change without building the shipped libraries anew."""
PHRASES = (
    "asked for|held against|can take|on the safe side|goes not with|goes with|it is said|that is said|hangs on|"
    "as often as you like|takes for granted|do alike|is no unit|are warned of|what there is none of"
)
KINDS = {".py", ".md", ".yaml", ".html", ".j2"}
MAX_PHRASES = 14  # that may stay, where they are English
QUESTION = re.compile(r"(Which|How|What|Who|Where|Whether|The|A|An|Its)\b")
MAX_SHORT_HELP = 60  # characters
DIFFERENT = {
    "--3d", "--a", "--ag", "--at", "--azimuth", "--check", "--count", "--engine", "--language", "--model",
    "--neighbours", "--omega", "--out", "--page", "--period", "--plot", "--points", "--pulse", "--restitution",
    "--scale", "--shape", "--site", "--slenderness", "--state", "--transverse", "--units",
}  # fmt: skip
"""Options whose meaning differs between commands, so that one text would be false."""
COMMANDS = {name: main.get_command(click.Context(main), name) for name in commands()}
OPTIONS = [
    (name, max(each.opts, key=len), each)
    for name, command in COMMANDS.items()
    for each in command.params
    if isinstance(each, click.Option)
]


def texts(*folders):
    """Yield the files of some folders that their authors wrote, and their texts."""
    for file in [*(file for folder in folders for file in (PROJECT / folder).rglob("*.*")), *PROJECT.glob("*.md")]:
        if file.suffix in KINDS and file.name not in ("words.md", "CHANGELOG.md") and "_generated" not in file.parts:
            yield file.relative_to(PROJECT).as_posix(), file.read_text(encoding="utf-8")


def assigned(text, words):
    """Return which of some words a file assigns as variables, in lines, loops and contexts."""
    among = rf"(?:[\w*]+, )*({words})(?:, [\w*]+)*"
    stores = re.finditer(rf"(?m)^(?:_| *){among} = |\bfor {among} in | as ({words}):|\(({words}) := ", text)
    return {next(filter(None, store.groups())) for store in stores}


def test_no_name_says_nothing():
    for place, text in texts("rocking_cli", "mechanisms"):
        if place.endswith(".py"):
            constants = assigned("\n".join(re.findall(r"(?m)^[A-Z_].* = ", text)), VAGUE)
            assert constants <= VAGUE_CONSTANTS.get(place, set()), f"{place}: name these constants by what they limit"
            assert not assigned(text, EMPTY), f"{place}: name these locals after what they hold"


def test_names_that_say_nothing_are_found():
    text = "_FEW = 3\nMIN_FEW = 4\nSMALL, other = 1, 2\n    def f(said):\n        own, x = said\n"
    text += "        return [near.found for x, near in own if (thing := near.item)]\n"
    assert assigned(text, VAGUE) == {"FEW", "SMALL"} and assigned(text, EMPTY) >= {"own", "near", "thing"}


def test_phrases_that_are_not_english_are_gone():
    places = [
        f"{place}: {phrase[0]}"
        for place, text in texts("rocking_cli", "mechanisms", "docs")
        for phrase in re.finditer(PHRASES, re.sub(r"(?:\s|#|\"\s*\n\s*f?\")+", " ", text).lower())
    ]
    assert len(places) <= MAX_PHRASES, "\n".join(places)


def test_a_predicate_follows_its_field_without_a_colon():
    assert str(Problem("is missing", field="FC", file="a.yaml", line=3)) == "a.yaml:3: FC is missing"
    assert str(Problem("give a number", field="FC")) == "FC: give a number"


def test_a_command_and_an_option_say_what_they_are():
    for name, command in COMMANDS.items():
        short = command.get_short_help_str(1000)
        assert len(short) <= MAX_SHORT_HELP and short.endswith("."), f"{name}: {short}"
        assert not QUESTION.match(short) and not QUESTION.match(command.help), f"{name}: begin with a verb: {short}"
    texts = defaultdict(lambda: defaultdict(list))
    for name, option, each in OPTIONS:
        text = re.sub(r"  \[default: .*\]$", "", each.help or "")
        assert (
            text[:1].isupper() and text.endswith(".") and not re.match(r"(Which|How|What|Who|Where|Whether)\b", text)
        ), text
        assert "Repeatable." in text or not each.multiple or option[2:] in CORRECTIONS, f"{name} {option}: {text}"
        texts[option][text].append(name)
    assert {option for option, different in texts.items() if len(different) > 1} <= DIFFERENT


def test_every_option_stands_under_its_heading_and_records_are_read_and_corrected_alike():
    listed = {RECORDS_HEADING: defaultdict(list), CORRECTIONS_HEADING: defaultdict(list)}
    for name, option, each in OPTIONS:
        assert heading_of(each) in HEADINGS, f"{name} {option}"
        if heading_of(each) in listed and not option.startswith("--vertical"):
            listed[heading_of(each)][name].append(option)
    reading = listed[RECORDS_HEADING]
    assert len(reading) > 8 and len({tuple(each) for each in reading.values()}) == 1, reading
    assert set(listed[CORRECTIONS_HEADING]) == {"record"}
