"""What makes a command start fast, and must not change what it says."""

import re
import subprocess
import sys

from rocking_cli.text import regex


def test_a_regular_expression_is_compiled_when_it_is_used(monkeypatch):
    tried = []
    monkeypatch.setattr(re, "compile", lambda *given, real=re.compile: tried.append(given) or real(*given))
    word = regex("A+", re.IGNORECASE)
    assert tried == []
    assert word.match("aab")[0] == "aa" and word.search("b") is None and word.match("Ab")[0] == "A"
    assert tried == [("A+", re.IGNORECASE)] * 2  # once for each of its methods


def test_whoever_imports_the_package_keeps_the_documentation_of_matplotlib():
    code = (
        "import rocking_cli.plotting.style, matplotlib.patches as p; "
        "assert 'facecolor' in p.Patch.set.__doc__; assert 'facecolor' in p.Rectangle.__init__.__doc__"
    )
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True).stderr == ""
