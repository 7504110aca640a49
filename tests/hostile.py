"""Strategies for what nobody should have to type: spoilt records, structures, studies and options.

A spoilt input is a good one with a few faults put in, as they get far: random bytes are refused at the door.
"""

import re
from functools import cache

import click
from hypothesis import strategies as st

from rocking_cli.cli.main import main
from rocking_cli.plugins.rooms import commands
from tests.conftest import EXAMPLES
from tests.excitation.test_record_formats import MADE

NUMBERS = [
    "0", "-0", "-1", "1e-300", "5e-324", "1e300", "1e309", "-1e30", "1e29", "1e15", "9" * 30, "9" * 5000,
    "0.1" + "0" * 400, "nan", "inf", "-inf", "NaN", ".inf", "1_000", "1,5", "1.5.2", "--1", "+", ".", "e", "1e",
    "0x10", "012", "1D3", "½", "٣",
]  # fmt: skip
WORDS = [
    "", " ", "\t", "\0", "\x1b[2J", "\u202e", "\ufeff", "é", "\ud7ff", "😀", "%s", "{}", "$x_1$", "<b>&", '"', "'",
    "\\", "../..", "-", "--", "null", "true", "on", "~", "*a", "&a", "!!python/object:os.system x", "!!int", "[", "{",
    "]", "}", ": ", "#", "|", ">", "?", "|\n", "g", "mm", "800 mm", "12 ft", "3 furlong", "10 deg", "1 kN", "kg",
    "m/s2",
]  # fmt: skip
JUNK = st.one_of(
    st.sampled_from(NUMBERS), st.sampled_from(WORDS), st.text(max_size=12), st.floats().map(str), st.integers().map(str)
)


@cache
def records() -> list[str]:
    """A small good record of each format, and delimited text."""
    time = [f"{0.01 * k:.2f}" for k in range(40)]
    values = [f"{0.3 * (-1) ** k * (k % 7):.4f}" for k in range(40)]
    rows = [f"{t},{a}" for t, a in zip(time, values, strict=True)]
    made = [make() for make, *_ in MADE.values()]
    peer = "PEER NGA STRONG MOTION DATABASE RECORD\nMade up\nACCELERATION TIME SERIES IN UNITS OF G\n"
    peer += "NPTS=  40, DT=   .0100 SEC\n" + "".join(f"{v:>12}" + "\n" * (k % 5 == 4) for k, v in enumerate(values))
    return [*made, peer, "time [s],acceleration [g]\n" + "\n".join(rows), "# unit: m/s2\n" + "\n".join(values)]


@cache
def structures() -> list[str]:
    """The structures of the examples."""
    return [path.read_text(encoding="utf-8") for path in sorted(EXAMPLES.glob("*.yaml"))]


@cache
def studies() -> list[str]:
    """The studies of the examples, over fewer motions."""
    return [path.read_text(encoding="utf-8") for path in sorted((EXAMPLES / "study").glob("*.yaml"))]


@st.composite
def spoilt(draw, good):
    """One of some good texts with a fault or two, seldom more."""
    text = draw(st.sampled_from(good))
    for _ in range(draw(st.sampled_from([1, 1, 1, 2, 2, 5]))):
        text = _spoil(draw, text)
    return text


def _spoil(draw, text: str) -> str:
    lines = text.split("\n")
    place = draw(st.integers(0, max(len(text) - 1, 0)))
    row = draw(st.integers(0, len(lines) - 1))
    match draw(st.integers(0, 9)):
        case 0:
            return text[:place] + text[place + 1 :]
        case 1:
            return text[:place] + draw(JUNK) + text[place:]
        case 2:
            return text[:place]
        case 3:
            return "\n".join(lines[:row] + lines[row + 1 :])
        case 4:
            return "\n".join(lines[:row] + [lines[row]] * draw(st.integers(2, 30)) + lines[row + 1 :])
        case 5:
            other = draw(st.integers(0, len(lines) - 1))
            lines[row], lines[other] = lines[other], lines[row]
            return "\n".join(lines)
        case 6:
            lines[row] = draw(JUNK)
            return "\n".join(lines)
        case _:  # a number becomes another, or a word: the fault that gets furthest
            numbers = list(re.finditer(r"[-+]?\d+\.?\d*(?:[eE][-+]?\d+)?|(?<=: )\S+", text))
            if not numbers:
                return text + draw(JUNK)
            found = draw(st.sampled_from(numbers))
            return text[: found.start()] + draw(JUNK) + text[found.end() :]


SLOW = {"report", "animate", "fragility", "results"}  # a process of seconds, even on good input
GOOD = {
    "ag": "0.6g", "period": "0.8", "omega": "0.5:10", "a": "2", "eta": "0.9", "shape": "sine", "sizes": "1:10:6",
    "slenderness": "0.2,0.3", "fractiles": "0.16,0.84", "model": "nonlinear",
    "at": "0.5", "release": "0.5", "points": "8", "jobs": "1", "channel": "1", "dt": "0.01", "units": "g",
    "speed": "2", "fps": "5", "rtol": "1e-6", "tail": "2", "scale": "1.5", "target_pga": "0.5",
}  # fmt: skip
PULSES = [
    "sine:0.6g:0.8s", "ricker:0.4g:1.2s", "mavroeidis:1g:1s:90:2", "constant:0.5g:1s", "sine:1e300g:1s",
    "sine:1g:1e-300s",
]  # fmt: skip


@st.composite
def command_lines(draw, structures, motions, outputs):
    """Arguments of any command, its options as the command declares them.

    Parameters
    ----------
    structures, motions : list of str
        Files, and names of some that are not there.
    outputs : str
        A folder to write to.
    """
    name = draw(st.sampled_from([each for each in commands() if each not in SLOW or draw(st.integers(0, 9)) == 0]))
    command = main.get_command(click.Context(main), name)
    assert command is not None
    words = [name]
    options = [each for each in command.params if isinstance(each, click.Option)]
    needed = [each for each in options if each.required]
    if any(each.name == "record" for each in options) and name != "overturning":
        needed += [each for each in options if each.name == draw(st.sampled_from(["record", "record", "pulse"]))]
    for argument in (each for each in command.params if isinstance(each, click.Argument)):
        count = draw(st.integers(1, 2)) if argument.nargs == -1 else 1
        files = motions if name == "record" else structures
        words += [_value(draw, argument, files, motions, outputs) for _ in range(count)]
    for option in needed + draw(st.lists(st.sampled_from(options), max_size=3)):
        words.append(draw(st.sampled_from(option.opts)))
        if not option.is_flag:
            words.append(_value(draw, option, structures, motions, outputs))
    return [word.replace("\0", "") for word in words]  # no process can be given one


def _value(draw, parameter: click.Parameter, files: list[str], motions: list[str], outputs: str) -> str:
    if draw(st.integers(0, 7)) == 0:
        return draw(JUNK)
    if isinstance(parameter.type, click.Choice):
        return str(draw(st.sampled_from([str(choice) for choice in parameter.type.choices])))
    if parameter.name in ("out", "plot", "store", "folder", "pictures"):
        names = ["a.csv", "a.png", "a.svg", "a.html", "a.gif", "a.parquet", "a.runs", "no/a.csv", "", "."]
        return f"{outputs}/{draw(st.sampled_from(names))}"
    if parameter.name in ("record", "records", "vertical"):
        return draw(st.sampled_from(motions))
    if parameter.name == "pulse":
        return draw(st.sampled_from(PULSES))
    if isinstance(parameter.type, click.Path) or parameter.name in ("file", "files", "structure"):
        return draw(st.sampled_from(files))
    if parameter.name in GOOD and draw(st.booleans()):
        return GOOD[parameter.name]
    return draw(st.one_of(st.sampled_from(NUMBERS), st.floats(-10, 10).map(str), st.integers(-3, 40).map(str)))
