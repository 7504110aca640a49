"""Count the lines of code of each folder, and the files and functions of the package: `make budget`.

It prints them, and brings the numbers of `budget.toml` to them where they are better.
"""

import re
import tomllib
from collections import Counter
from pathlib import Path
from statistics import median

from tests.conftest import PROJECT

FILE = Path(__file__).with_name("budget.toml")
SPLIT = ("rocking_cli", "tests")  # their folders have numbers of their own, and those of a total
BESIDE = ("mechanisms", "benchmarks", "docs", "examples", "scripts", "validation")
PACKAGE = ("rocking_cli", "mechanisms")  # whose files and functions are counted
FILES, SHORT, MEDIAN = "files", "functions of at most 3 lines", "median lines of a function"
MAX_SHORT_LINES = 3
TOKENS = re.compile(
    r'"""(?:\\.|[^\\])*?"""|' r"\'\'\'(?:\\.|[^\\])*?\'\'\'|" r'"(?:\\.|[^"\\\n])*"|' r"\'(?:\\.|[^\'\\\n])*\'|#[^\n]*",
    re.DOTALL,
)
"""Texts and comments."""
INSIDE = " " * 99 + "s"
DOCUMENTATION = re.compile(rf"(?:\A|(?<=:\n)) *[rR]?s\n(?:{INSIDE}\n)*")
MOST_SHARE, LEAST_LINES = 0.03, 5  # below its number a folder stays, and is not asked for a lower one


def masked(token):
    """Leave nothing of a comment, and of each line of a text a letter, far to the right in all but the first."""
    return "" if token[0][0] == "#" else "s" + ("\n" + INSIDE) * token[0].count("\n")


def code(text):
    """Return the lines of a text without blank lines, comments and docstrings, and those of each function.

    A function ends where a line is no further to the right, unless it closes a bracket; a syntax tree takes five times
    as long to say the same.
    """
    plain = re.sub(r" +\n", "\n", TOKENS.sub(masked, f"{text}\n"))
    lines = DOCUMENTATION.sub("", "".join(re.findall(r"(?m)^ *[^ \n].*\n", plain)))
    functions = []
    for start in re.finditer(r"(?m)^( *)(?:async )?def ", lines):
        end = re.compile(rf"\n {{0,{len(start[1])}}}[^ )\]}}]").search(lines, start.end())
        functions.append(lines.count("\n", start.start(), end.start() + 1 if end else len(lines)))
    return lines.count("\n"), functions


def counts_for(file):
    """Return the names that a file counts for: a folder, and a total."""
    names = file.relative_to(PROJECT).parts
    if names[0] not in SPLIT:
        return {names[0]}
    depth = 3 if names[1] == "questions" and names[0] == "rocking_cli" else 2
    return {names[0], "/".join(names[:depth] if len(names) > depth else (*names[:-1], "*.py"))}


def counted():
    """Count the lines of code of each folder with their totals, and the files and functions of the package."""
    found, sizes = Counter(), []
    for file in (file for top in SPLIT + BESIDE for file in (PROJECT / top).rglob("*.py")):
        if "_generated" in file.parts:  # copies that the documentation makes
            continue
        lines, functions = code(file.read_text(encoding="utf-8"))
        found.update(dict.fromkeys(counts_for(file), lines))
        if file.relative_to(PROJECT).parts[0] in PACKAGE:
            found[FILES] += 1
            sizes += functions
    found[SHORT], found[MEDIAN] = sum(size <= MAX_SHORT_LINES for size in sizes), int(median(sizes))
    return found


def complaints(numbers, found):
    """Yield what is wrong with some numbers, for the lines that were counted."""
    numbers = Counter(numbers)
    for name in sorted({*numbers, *found}):
        room, what = numbers[name] - found[name], "" if name in (FILES, SHORT) else " lines of code"
        if name == MEDIAN:  # a number to reach, not one to stay below
            if room > 0:
                yield f"{name}: {found[name]}, {room} below its number; set short functions into their callers"
        elif room < 0:
            yield f"{name}: {found[name]}{what}, {-room} above its number; cut, or say in budget.toml who pays"
        elif room >= max(LEAST_LINES, MOST_SHARE * numbers[name]):
            yield f"{name}: {found[name]}{what}, {room} below its number; lower it by `make budget`"
    for top in SPLIT:
        over = sum(number for name, number in numbers.items() if name.startswith(f"{top}/")) - numbers[top]
        if over > 0:
            yield f"{top}: the numbers of its folders are {over} above its own; whoever raises one lowers another"


def lowered(text, found):
    """Return a budget whose numbers are what was counted, where that is better; without the folders that are gone."""

    def better(line):
        return f'"{line[1]}" = {(max if line[1] == MEDIAN else min)(int(line[2]), found[line[1]])}'

    new = re.sub(r'^"(.+)" = (\d+)', better, text, flags=re.MULTILINE)
    return re.sub(r'^".+" = 0\n', "", new, flags=re.MULTILINE)


if __name__ == "__main__":
    found, text = counted(), FILE.read_text(encoding="utf-8")
    before, new = tomllib.loads(text), lowered(text, found)
    print(f"{'':40}{'number':>8}{'counted':>8}")
    for name in sorted({*before, *found}):
        print(f"{name:40}{before.get(name, 0):8}{found[name]:8}")
    print(*complaints(tomllib.loads(new), found), sep="\n")
    FILE.write_text(new, encoding="utf-8")
