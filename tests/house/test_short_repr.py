"""Objects show themselves in a line, without the values of their arrays."""

import pickle
from dataclasses import dataclass, field
from enum import Enum
from typing import NamedTuple

import numpy as np
import pytest

import rocking_cli as rk
from rocking_cli.core import equivalent_block
from rocking_cli.dynamics.batch import Runs
from rocking_cli.dynamics.exact import exact_response
from rocking_cli.short_repr import short_repr
from rocking_cli.structure import build_models
from tests.conftest import EXAMPLES


class Side(Enum):
    LEFT = -1


@short_repr
@dataclass(frozen=True)
class Outer:
    name: str = "whole"
    held: object = None
    done: bool = False
    _hidden: int = field(default=3, repr=False)


NAN = float("nan")


@pytest.mark.parametrize(
    ("held", "words"),
    [
        (None, "<Outer: name = 'whole', done = False>"),
        (NAN, "'whole', done"),
        (len, "'whole', done"),
        ((), "'whole', done"),
        (np.zeros((0, 3)), "'whole', done"),
        (12345.678, "held = 12346, done"),
        (np.float64(0.5), "held = 0.5, done"),
        (np.array([1.0, NAN, 3.0]), "held = 3 from 1 to 3, done"),
        (np.array([[2.0, 2.5]]), "held = 1x2 from 2 to 2.5, done"),
        (np.array([True, False]), "held = 2 bool, done"),
        ([1, 2, 3], "held = 3 int, done"),
        ({"a": Side.LEFT, "b": 1}, "held = 2 entries, done"),
        (Side.LEFT, "held = LEFT, done"),
        ("\x1b[31m" + "x" * 90, r"held = '\x1b[31m"),
        (rk.Block(name="b", width=1.0, height=4.0), "held = Block 'b', done"),
    ],
)
def test_fields_are_shown_by_their_kind(held, words):
    line = repr(Outer(held=held))
    assert words in line and line.startswith("<Outer: ") and line.endswith(">") and len(line) < 200


def test_named_tuples_dictionaries_and_long_objects_have_a_line_too():
    @short_repr
    class Pair(NamedTuple):
        one: object
        other: object = None

    @short_repr
    class Several(dict):
        pass

    assert repr(Pair(np.arange(3.0))) == "<Pair: one = 3 from 0 to 2>"
    many = repr(Several({f"motion {k}\n": Side.LEFT for k in range(1000)}))
    assert many.startswith(r"<Several: motion 0\n = LEFT, ") and len(many) <= 200 and many.endswith(", ...>")


def test_a_structure_is_a_call_unless_it_is_long():
    block = rk.Block(width=0.7, height=2.8)
    assert repr(block) == str(block) == "Block(width=0.7, height=2.8)"
    curve = rk.load_structure(EXAMPLES / "curve.yaml")
    long = curve.replace(points=[[0.001 * k, 0.2 - 0.0002 * k] for k in range(2000)])
    assert repr(long) == str(long) and len(repr(long)) <= 200
    assert repr(long).startswith("<Curve: name = 'pushed facade', ") and "points = 2000 list" in repr(long)


def test_what_python_users_hold_is_a_line():
    block, motion = rk.Block(width=0.7, height=2.8), rk.read_record(EXAMPLES / "accel.csv")
    phi, both, pulse = np.linspace(0.0, 0.2, 5), equivalent_block(block), rk.parse_pulse("sine:0.4g:0.8s")
    for each in (
        block, motion, pulse, both, both.positive, build_models(block)[0], rk.mechanisms, Runs.every(2, 3),
        block.bodies()[0], block.motion(phi, rk.Direction.POSITIVE)[0], block.coefficients(phi, rk.Direction.POSITIVE),
        block.sketch(), block.contacts(rk.Direction.POSITIVE), rk.measure(motion), rk.parse_measure("Sa(0.5s)"),
        rk.closed_form(3.0, 2.0, 0.9), exact_response(both, pulse, kappa=2, gravity=9.81),
    ):  # fmt: skip
        assert len(repr(each)) <= 200 and "array(" not in repr(each)
        assert repr(pickle.loads(pickle.dumps(each))) == repr(each)
    assert repr(both.positive).startswith("<EquivalentBlock: p = 2.2576, phi_cr = 0.24498, lambda_ = 0.25, ")
