"""Objects show themselves in a line, without the values of their arrays."""

import pickle
from dataclasses import dataclass, field
from enum import Enum
from pathlib import Path
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
class Inner:
    """A part.

    Parameters
    ----------
    name : str
        Its name.
    ratio : float
        Ratio, see [Eq. 3].
    period : float
        Period [s].
    """

    name: str = "part"
    ratio: float = 0.25
    period: float = float("nan")


@short_repr
@dataclass(frozen=True)
class Outer(Inner):
    """A whole.

    Parameters
    ----------
    speed, angle : float
        Speed [m/s] and angle [rad].
    weight : ndarray, shape (n,)
        Weight [standard gravity].
    """

    speed: float = 12345.678
    angle: np.float64 = field(default_factory=lambda: np.float64(0.5))
    weight: object = None
    many: object = ()
    inner: object = None
    done: bool = False
    _hidden: int = field(default=3, repr=False)


NAN = float("nan")


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({}, "<Outer: name = 'part', ratio = 0.25, speed = 12346 m/s, angle = 0.5 rad, done = False>"),
        ({"name": "", "ratio": NAN, "speed": NAN, "angle": NAN, "done": True}, "done = True"),
        ({"name": "\x1b[31m\n"}, r"name = '\x1b[31m\n', "),
        ({"name": "x" * 90}, f"name = '{37 * 'x'}...', "),
        ({"weight": np.array([1.0, NAN, 3.0])}, "weight = 3 from 1 to 3 g, done"),
        ({"weight": np.array([[2.0, 2.0]])}, "weight = 1x2 of 2, done"),
        ({"weight": np.full(3, NAN)}, "angle = 0.5 rad, done"),
        ({"weight": np.zeros((0, 3))}, "angle = 0.5 rad, done"),
        ({"weight": np.array([True, False, True])}, "weight = 2 of 3 True, done"),
        ({"weight": np.array([1j])}, "weight = 1 complex128, done"),
        ({"weight": np.array([-np.inf, np.inf])}, "weight = 2 from -inf to inf g, done"),
        ({"many": (1, 0.123456, None)}, "many = (1, 0.12346, None), done"),
        ({"many": [float(k) for k in range(9)]}, "many = 9 from 0 to 8, done"),
        ({"many": (NAN, NAN)}, "angle = 0.5 rad, done"),
        ({"many": ["a", "b"]}, "many = ('a', 'b'), done"),
        ({"many": {"a": Inner(), "b": Inner()}}, "many = 2 Inner, done"),
        ({"many": [np.zeros(3), np.zeros(3)]}, "many = 2 ndarray, done"),
        ({"many": [1, "a"]}, "many = 2 entries, done"),
        ({"inner": Inner()}, "inner = <Inner: name = 'part', ratio = 0.25>, done"),
        ({"inner": Side.LEFT}, "inner = LEFT, ratio"),
        ({"inner": Path("a.csv")}, "inner = 'a.csv', ratio"),
        ({"inner": len}, "angle = 0.5 rad, done"),
        ({"inner": rk.Block(name="b", width=1.0, height=4.0)}, "inner = Block 'b', done"),
    ],
)
def test_fields_are_shown_by_their_kind(given, words):
    line = repr(Outer(**given))
    assert words in line and line.startswith("<Outer: ") and line.endswith(">")


def test_a_line_is_cut_between_its_fields():
    line = repr(Outer(inner=Outer(name="y" * 50, many=("a" * 30, "b")), name="x" * 50, many="z" * 99))
    assert len(line) <= 200 and line.endswith(", ...>") and line.count("<") == line.count(">")
    assert repr(rk.Problem("is wrong")).startswith("Problem(message='is wrong'")  # those of others are as they were


def test_a_table_has_all_fields_as_text():
    page = Outer(name="<b>", inner=Inner())._repr_html_()
    assert "<tr><th>name</th><td>&#x27;&lt;b&gt;&#x27;</td></tr>" in page and page.count("<tr>") == 6
    assert page.startswith("<table><caption>Outer</caption>") and "<th>speed</th><td>12346 m/s</td>" in page


def test_named_tuples_and_dictionaries_have_lines_too():
    @short_repr
    class Pair(NamedTuple):
        one: object
        other: object = None

    @short_repr
    class Several(dict):
        pass

    assert repr(Pair(np.arange(3.0))) == "<Pair: one = 3 from 0 to 2>"
    many = Several({f"motion {k}\n": Inner() for k in range(1000)})
    assert repr(many).startswith(r"<Several: motion 0\n = <Inner: name = 'part', ratio = 0.25>, ")
    assert len(repr(many)) <= 200


def test_a_structure_is_a_call_unless_it_is_long():
    block = rk.Block(width=0.7, height=2.8)
    assert repr(block) == str(block) == "Block(width=0.7, height=2.8)"
    curve = rk.load_structure(EXAMPLES / "curve.yaml")
    long = curve.replace(points=[[0.001 * k, 0.2 - 0.0002 * k] for k in range(2000)])
    line = (
        "<Curve: name = 'pushed facade', restitution = 0.85, mass = 24000 kg, control_height = 8 m, "
        "centroid_height = 4.1 m, inertia = 5.28e+05 kg m2, points = 2000 list>"
    )
    assert repr(long) == str(long) == line


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
    assert repr(both.positive).startswith("<EquivalentBlock: p = 2.2576 rad/s, phi_cr = 0.24498 rad, lambda_ = 0.25, ")
    assert both == equivalent_block(block)
