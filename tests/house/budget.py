"""Count the lines of code of each folder, print them, and lower the numbers of `budget.toml`: `make budget`."""

import re
import tokenize
import tomllib
from collections import Counter
from pathlib import Path

from tests.conftest import PROJECT

FILE = Path(__file__).with_name("budget.toml")
SPLIT = ("rocking_cli", "tests")  # their folders have numbers of their own, and those of a total
BESIDE = ("mechanisms", "benchmarks", "docs", "examples", "scripts")
LAYOUT = {tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT, tokenize.ENDMARKER}
MOST_SHARE, LEAST_LINES = 0.03, 5  # below its number a folder stays, and is not asked for a lower one


def code(file):
    """Count the lines of a file that are not blank, nor of comments and docstrings alone."""
    lines, begins = set(), True
    with tokenize.open(file) as text:
        for token in tokenize.generate_tokens(text.readline):
            if token.type in (tokenize.COMMENT, tokenize.NL):
                continue
            if token.type not in LAYOUT and not (begins and token.type == tokenize.STRING):
                lines.update(range(token.start[0], token.end[0] + 1))
            begins = token.type == tokenize.INDENT
    return len(lines)


def counts_for(file):
    """Return the names that a file counts for: a folder, and a total."""
    names = file.relative_to(PROJECT).parts
    if names[0] not in SPLIT:
        return {names[0]}
    depth = 3 if names[1] == "questions" and names[0] == "rocking_cli" else 2
    return {names[0], "/".join(names[:depth] if len(names) > depth else (*names[:-1], "*.py"))}


def counted():
    """Count the lines of code of each folder, and their totals."""
    found = Counter()
    for file in (file for top in SPLIT + BESIDE for file in (PROJECT / top).rglob("*.py")):
        if "_generated" in file.parts:  # copies that the documentation makes
            continue
        found.update(dict.fromkeys(counts_for(file), code(file)))
    return found


def complaints(numbers, found):
    """Yield what is wrong with some numbers, for the lines that were counted."""
    numbers = Counter(numbers)
    for name in sorted({*numbers, *found}):
        room = numbers[name] - found[name]
        if room < 0:
            yield f"{name}: {found[name]} lines of code, {-room} above its number; cut, or say in budget.toml who pays"
        elif room >= max(LEAST_LINES, MOST_SHARE * numbers[name]):
            yield f"{name}: {found[name]} lines of code, {room} below its number; lower it by `make budget`"
    for top in SPLIT:
        over = sum(number for name, number in numbers.items() if name.startswith(f"{top}/")) - numbers[top]
        if over > 0:
            yield f"{top}: the numbers of its folders are {over} above its own; whoever raises one lowers another"


def lowered(text, found):
    """Return a budget whose numbers are what was counted, where that is less; without the folders that are gone."""
    new = re.sub(
        r'^"(.+)" = (\d+)', lambda line: f'"{line[1]}" = {min(int(line[2]), found[line[1]])}', text, flags=re.MULTILINE
    )
    return re.sub(r'^".+" = 0\n', "", new, flags=re.MULTILINE)


if __name__ == "__main__":
    found, text = counted(), FILE.read_text(encoding="utf-8")
    before, new = tomllib.loads(text), lowered(text, found)
    print(f"{'':40}{'number':>8}{'counted':>8}")
    for name in sorted({*before, *found}):
        print(f"{name:40}{before.get(name, 0):8}{found[name]:8}")
    print(*complaints(tomllib.loads(new), found), sep="\n")
    FILE.write_text(new, encoding="utf-8")
