"""Names that say nothing: constants that are a vague word alone, and locals that any value might have."""

import ast
import re

import pytest

from tests.house.test_layers import parsed

VAGUE = re.compile(
    "MOST|LEAST|FEW|FEWEST|MANY|MUCH|ENOUGH|ALL|EVERY|SOME|FIRST|LAST|SMALL|SMALLER|SMALLEST|LARGE|LARGER|LARGEST|BIG|"
    "BIGGEST|TINY|HUGE|CLOSE|NEAR|NEAREST|FAR|FARTHEST|FURTHEST|LONG|LONGEST|SHORT|SHORTEST|SLOW|SLOWEST|FAST|FASTEST|"
    "HIGH|HIGHEST|LOW|LOWEST|THICK|THIN|WIDE|NARROW|STRONG|WEAK|FAINT|RARE|RARELY|OFTEN|SELDOM|ALWAYS|NEVER|EQUAL|SAME|"
    "ALIKE|SIMILAR|GOOD|BAD|FINE|COARSE|ROUGH|BEHIND|AHEAD|BEFORE|AFTER|ABOVE|BELOW|BEYOND|APART|STILL|IDLE|LATE|EARLY|"
    "SOON|THING|STUFF|TMP"
)
EMPTY = re.compile(r"found|said|near|own|thing|stuff|foo|te?mp|(data|item|list|obj|res|result|text|tmp|val|value)\d+")
VAGUE_CONSTANTS = {
    "rocking_cli/codes/italian/formulas.py": {"FURTHEST"},  # the formula of the largest ordinate up to a period
    "rocking_cli/dynamics/kernels.py": {"FAINT", "IDLE", "LONG", "SLOW"},
    "rocking_cli/dynamics/openings.py": {"APART", "LARGEST", "LONGEST"},
    "rocking_cli/dynamics/pulse_motion.py": {"FAINT", "STILL"},
    "rocking_cli/dynamics/stepping.py": {"BEHIND"},
    "rocking_cli/plotting/style.py": {"FAINT", "SMALL", "THIN", "TINY"},  # steps of a scale, read as `style.SMALL`
}
"""Constants that keep a vague name: that of the kernels cannot change without building the shipped libraries anew."""


@pytest.fixture(scope="module")
def package():
    """The syntax of the package and of its mechanisms."""
    return parsed("rocking_cli/**/*.py", "mechanisms/**/*.py")


def vague(tree):
    """Return the vague names that a module assigns at its top level, without leading underscores."""
    targets = [
        target for node in tree.body if isinstance(node, ast.Assign | ast.AnnAssign)
        for target in (node.targets if isinstance(node, ast.Assign) else [node.target])
    ]  # fmt: skip
    names = {name.id.strip("_") for target in targets for name in ast.walk(target) if isinstance(name, ast.Name)}
    return {name for name in names if VAGUE.fullmatch(name)}


def assigned(tree):
    """Return all names that a file assigns, once for each assignment, but for the fields of classes."""
    fields = {
        id(name) for node in ast.walk(tree) if isinstance(node, ast.ClassDef)
        for statement in node.body if isinstance(statement, ast.Assign | ast.AnnAssign)
        for name in ast.walk(statement)
    }  # fmt: skip
    return [
        node.id
        for node in ast.walk(tree)
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store) and id(node) not in fields
    ]


def test_vague_names_are_told_from_others():
    tree = ast.parse(
        "_FEW = 3\nMIN_FEW = 4\nSMALL, other = 1, 2\nclass A:\n    found: int = 0\n    def f(self, said):\n"
        "        own, data2 = said\n        return [near.found for near in own if (thing := near) and phi_2]\n"
    )
    assert vague(tree) == {"FEW", "SMALL"}
    assert [name for name in assigned(tree) if EMPTY.fullmatch(name)] == ["own", "data2", "near", "thing"]


def test_no_constant_is_a_vague_word_alone(package):
    """A name has what is limited, and its kind: `MAX_NAMED_MOTIONS`, not `MANY`."""
    assert {place: vague(tree) for place, tree in package.items() if vague(tree)} == VAGUE_CONSTANTS


def test_no_local_has_a_name_that_says_nothing(package):
    empty = {place: names for place, tree in package.items() if (names := set(filter(EMPTY.fullmatch, assigned(tree))))}
    assert not empty, f"name these locals after what they hold: {empty}"
