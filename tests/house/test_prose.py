"""Results carry what decides and the views say it: below the views there are no sentences but those of errors."""

import ast
import re
from textwrap import dedent

from tests.conftest import PROJECT

BELOW = ("core", "excitation", "processing", "dynamics", "engines", "verification", "studies", "questions")
ABOVE = re.compile(r"rocking_cli\.(views|plotting|documents|ask|cli)\b")  # imported by what speaks to users
FEWEST = 4  # words of a sentence, which ends with a full stop; the name of a source has its year
WORD, STOP, SOURCE = r"(?<![\w`'])[A-Za-z][a-z']+(?=[\s,.;:]|$)", r"[a-z0-9)]\.(\s|$)", r"\(\d{4}\)"
# calls with the text of an error or of a help page, or a pattern
ERROR = re.compile(r"(Error|Problem|Refused|Field|Option|compile|Doubt)$")
ALLOWED = {
    "excitation/records/layout.py": 1,
    "questions/calibrate/study.py": 1,
    "questions/select/set_folder.py": 1,  # the first line of a file
}
"""Sentences that are still below the views, by file: these numbers may only fall."""


def prose(source: str) -> list[int]:
    """Return the lines of all sentences that are neither documentation nor part of an error."""
    tree = ast.parse(source)
    out: set[ast.AST] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Raise) or (isinstance(node, ast.Call) and ERROR.search(ast.unparse(node.func))):
            out.update(ast.walk(node))
        elif isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
            out.add(node.value)
        elif isinstance(node, ast.JoinedStr):
            out.update(node.values)
        elif isinstance(node, ast.FunctionDef):  # what it raises under a name
            raised = {each.id for part in ast.walk(node) if isinstance(part, ast.Raise)
                      for each in ast.walk(part) if isinstance(each, ast.Name)}  # fmt: skip
            for part in ast.walk(node):
                if isinstance(part, ast.Assign) and {getattr(each, "id", "") for each in part.targets} & raised:
                    out.update(ast.walk(part))
    return sorted(node.lineno for node in ast.walk(tree) if node not in out and _is_sentence(_text(node)))


def _text(node: ast.AST) -> str:
    parts = node.values if isinstance(node, ast.JoinedStr) else [node]
    return "".join(
        each.value if isinstance(each, ast.Constant) and isinstance(each.value, str) else "1" for each in parts
    )


def _is_sentence(text: str) -> bool:
    return len(re.findall(WORD, text)) >= FEWEST and bool(re.search(STOP, text)) and not re.search(SOURCE, text)


def test_a_sentence_is_told_from_documentation_and_from_errors():
    source = '''
    """This module has something to say."""
    def f(x):
        """Return what there is to say."""
        what = "This is an error with a name."
        if x:
            raise ValueError(what)
        said = [f"The structure {x} is at rest."]
        raise InputError(Problem("This one is an error too."))
    def g(x):
        source = "Zhu et al. (1988), of the inverse"
        return "a quantity of a few words", "The structure rocks, "
            f"and overturns at {x} s in the end."
    '''.replace('rocks, "\n            f"', "rocks, ")
    assert prose(dedent(source)) == [8, 12]


def test_no_sentence_is_below_the_views():
    for file in sorted(file for name in BELOW for file in (PROJECT / "rocking_cli" / name).rglob("*.py")):
        place = file.relative_to(PROJECT / "rocking_cli").as_posix()
        source = file.read_text(encoding="utf-8")
        if (
            place == "questions/report/hung.py"
            or place.endswith("/__init__.py")
            or (place.startswith("questions/") and ABOVE.search(source))
        ):
            continue
        found = prose(source)
        assert len(found) <= ALLOWED.get(place, 0), f"rocking_cli/{place}, lines {found}: sentences belong to the views"
