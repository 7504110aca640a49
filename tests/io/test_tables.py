"""Tables as text: what a spreadsheet would compute is guarded, in the one module that writes them."""

import io

import pytest

from rocking_cli.io.tables import write_csv
from tests.cli.test_cli import run
from tests.conftest import PROJECT


def written(columns):
    write_csv(stream := io.BytesIO(), [columns])
    return stream.getvalue().decode().splitlines()


@pytest.mark.parametrize("text", ["=1+1", "+a", "-a", "@SUM(A1)", " =1", "-1+2", "-12 kN", "=cmd|' /C calc'!A0"])
def test_no_name_and_no_heading_is_a_formula(text):
    assert written({text: [text, "a"], "b": [-1.5, 2]}) == [f"'{text},b", f"'{text},-1.5", "a,2"]


@pytest.mark.parametrize("text", ["-1", "+1.5", "-1e-5", "-12.5;-3", "-0.5;1.5", "-", "a=1", "'=1", "1-2", ""])
def test_numbers_stay_numbers_and_words_words(text):
    assert written({"b": [1], text: [text]})[1] == f"1,{text}"


def test_an_option_leaves_texts_as_they_are(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "b.yaml").write_text("mechanism: block\nname: =1+1\nwidth: 0.5\nheight: 2\n", encoding="utf-8")
    names = [
        run(*words, "equiv", "b.yaml", "-o", "-").stdout.splitlines()[1][:6] for words in ((), ("--formulas",), ())
    ]
    assert names == ["'=1+1,", "=1+1,b", "'=1+1,"]


def test_one_module_writes_tables():
    writers = [each.name for each in (PROJECT / "rocking_cli").rglob("*.py") if "csv.writer" in each.read_text("utf-8")]
    assert writers == ["tables.py"]
