"""The one encoder of JSON: whatever is written can be read, by anything that reads JSON."""

import json
from types import MappingProxyType

import numpy as np
import pytest

from rocking_cli.cli import terminal
from rocking_cli.io.json_text import json_text
from rocking_cli.plotting.moving import as_script
from tests.conftest import PROJECT

ODD = {
    "nan": float("nan"),
    "inf": [float("inf"), -np.inf, (np.nan, 1.5)],
    "numpy": {"real": np.float64(0.1), "short": np.float32(np.inf), "whole": np.int64(3), "truth": np.bool_(True)},
    "array": np.array([[1.0, np.nan], [np.inf, 2.0]]),
    "view": MappingProxyType({"x": np.arange(2)}),
    "plain": [None, True, "é", 7],
}
PLAIN = {
    "nan": None,
    "inf": [None, None, [None, 1.5]],
    "numpy": {"real": 0.1, "short": None, "whole": 3, "truth": True},
    "array": [[1.0, None], [None, 2.0]],
    "view": {"x": [0, 1]},
    "plain": [None, True, "é", 7],
}


def strictly(text):
    """Parsed as the standard has it, which knows neither NaN nor Infinity."""

    def refuse(word):
        raise ValueError(word)

    return json.loads(text, parse_constant=refuse)


def test_what_is_no_number_is_null_and_numpy_is_plain():
    assert strictly(json_text(ODD)) == PLAIN


def test_terminal_and_pages_use_it(capsys):
    terminal.print_json(ODD)
    assert strictly(capsys.readouterr().out) == PLAIN
    assert strictly(as_script(ODD)) == PLAIN


def test_finite_data_are_written_as_json_does():
    data = {"b": [1, 2.5, 0.0, 1e300], "a": {"c": None, "ü": "x"}}
    assert json_text(data) == json_text(data | {"b": [1, 2.5, -0.0, 1e300]}) == json.dumps(data)
    assert json_text(data, sort_keys=True, compact=True) == json.dumps(data, sort_keys=True, separators=(",", ":"))


def test_what_is_not_plain_is_refused():
    with pytest.raises(TypeError):
        json_text({"x": object()})


def test_nothing_else_in_the_package_writes_json():
    wrong = [
        str(path)
        for path in (PROJECT / "rocking_cli").rglob("*.py")
        # What is compared or searched for within the program is not written: a checksum, the spelling of a key.
        if "json.dump" in path.read_text(encoding="utf-8") and path.name not in ("json_text.py", "simcenter.py")
    ]
    assert not wrong
