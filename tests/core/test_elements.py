"""Elements: what each says of its force, its energy and itself, and a law of a tie from another package."""

import ast
import re
from importlib.metadata import EntryPoint
from textwrap import dedent

import numpy as np
import pytest
from pytest import approx
from scipy.integrate import quad, solve_ivp

import rocking_cli as rk
from rocking_cli.core import Direction, Spot, length
from rocking_cli.core.coefficients import Coefficients
from rocking_cli.core.hung.element import NO_ANSWER, ConstantForce, Element, Spring, SpringBed
from rocking_cli.core.hung.ties import Laws, Tie, laws
from rocking_cli.errors import MechanismError
from rocking_cli.plugins import registry
from rocking_cli.plugins.registry import load
from rocking_cli.testing import check_law
from tests.cli.test_cli import run, run_json
from tests.conftest import EXAMPLES, PROJECT
from tests.stiffening import Cubic, Stiffening

ACCEL = EXAMPLES / "accel.csv"
RING = Spot(None, 0j), Spot("block", 3j)
WALL = dedent("""\
    mechanism: block
    width: 1.0
    height: 5.0
    density: 2000
    depth: 1.0
    ties:
      - name: cable
        from: {ground: [-4.0, 3.0]}
        to: {at: [-0.5, 3.0]}
        stiffness: 2e5
        prestress: 5e3
    """)
STIFFENING = WALL + "    law: stiffening\n    cubic: 4e6\n"


@pytest.fixture
def law(monkeypatch):
    """The law `stiffening` is installed, as by another package."""
    find = registry.find
    point = EntryPoint("stiffening", "tests.stiffening:Stiffening", "rocking.laws")
    monkeypatch.setattr(registry, "find", lambda of: {"stiffening": [point]} if of == "rocking.laws" else find(of))
    laws.cache_clear()
    yield
    laws.cache_clear()


ELEMENTS = {
    "tie": Spring("tie", RING, 1e5, 2e3),
    "tension": Spring("tie", RING, 1e5, 2e3, only="tension"),
    "compression": Spring("tie", RING, 1e5, -2e3, only="compression"),
    "force": ConstantForce("thrust", RING[1], 3e3 - 4e3j),
    "friction": ConstantForce("friction", RING[1], -3e3 + 0j, friction=True),
    "bed": SpringBed("bed", Spot("block", 1j), Spot("block", 3j), 1e5),
    "cubic": Cubic("cable", RING, 1e5, 2e3, 4e6, count=3.0),
}


def in_one_line(text):
    return " ".join(text.split())


def refused(*arguments):
    """What is said of wrong input, of which nothing is printed as a result."""
    return in_one_line(run(*arguments, code=2).stderr)


@pytest.mark.parametrize("name", ELEMENTS)
def test_the_energy_of_an_element_is_the_integral_of_its_force_whose_derivative_is_its_slope(name):
    element, e = ELEMENTS[name], np.array([-0.07, -0.03, 0.011, 0.05])
    stored = [quad(lambda x: element.force(np.array([x]))[0], 0.0, end, points=[0.02, -0.02])[0] for end in e]
    assert element.energy(e) == approx(stored, rel=1e-9, abs=1e-9)
    step = 1e-6
    assert element.slope(e, np.ones(4)) == approx(
        (element.force(e + step) - element.force(e - step)) / (2 * step), rel=1e-6
    )


@pytest.mark.parametrize("name", [name for name in ELEMENTS if name != "bed"])  # its moment is that of two springs
@pytest.mark.parametrize("direction", Direction)
def test_the_moment_of_an_element_is_its_force_times_the_rate_of_its_elongation(name, direction):
    element: Element = ELEMENTS[name]
    phi = np.linspace(0.02, 0.3, 5)
    block = rk.Block(width=1.0, height=5.0)
    total = Coefficients(phi, *(np.zeros(5) for _ in range(7)))
    follow = block.followed(phi, direction)
    element.act(total, direction, follow)
    e, first, second = element.elongation(follow, direction)
    many = getattr(element, "count", 1.0)
    assert approx(many * element.force(e) * first, rel=1e-12) == total.Q
    assert total.dQ == approx(many * (element.slope(e, first) * first**2 + element.force(e) * second), rel=1e-9)
    assert approx(many * element.energy(e), rel=1e-12) == total.U


@pytest.mark.parametrize("name", ELEMENTS)
def test_the_laws_of_all_elements_hold_together(name):
    check_law(ELEMENTS[name], -0.07, 0.05)


class Slope(Cubic):
    def slope(self, e, going):
        return self.stiffness + 2 * self.cubic * e**2


class Energy(Cubic):
    def energy(self, e):
        return self.prestress * e + self.stiffness * e**2 / 2


class Rest(Cubic):
    def energy(self, e):
        return super().energy(e) + 1.0


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        (Slope, "cable: its slope is not the derivative of its force, at e = -0.07 m"),
        (Energy, "cable: its energy is not the integral of its force, at e = -0.07 m"),
        (Rest, "cable: its energy is not 0 at rest"),
    ],
)
def test_a_law_that_does_not_hold_together_is_found(wrong, said):
    with pytest.raises(AssertionError, match=f"^{said}$"):
        check_law(wrong("cable", RING, 1e5, 2e3, 4e6), -0.07, 0.05)


def test_elements_say_what_may_be_asked_of_them():
    class Yielding(Cubic):
        has_memory, departs = True, "yields"

    class Damper(Spring):
        has_rate = True

    questions = tuple(NO_ANSWER)

    def unanswered(element):
        return {each for each in questions if element.refuses(each)}

    assert unanswered(ELEMENTS["tension"]) == set()
    assert unanswered(ELEMENTS["friction"]) == set()
    assert unanswered(ELEMENTS["cubic"]) == {"linear models", "verification"}
    assert unanswered(Yielding("bar", RING, 1.0, 0.0, 1.0)) == set(questions)
    assert unanswered(Damper("oil", RING, 1.0)) == set(questions) - {"equivalent block"}
    assert Yielding("bar", RING, 1.0, 0.0, 1.0).refuses("sizes") == "yields"


def test_a_law_from_another_package_is_followed(law, tmp_path):
    """The same motion by an integration of its energy equation that knows nothing of tables."""
    (tmp_path / "wall.yaml").write_text(STIFFENING)
    wall = rk.load_structure(tmp_path / "wall.yaml")
    m, R, alpha, g = 10_000.0, np.hypot(0.5, 2.5), np.arctan(0.2), wall.gravity
    inertia = 4 / 3 * m * R**2

    def moment(phi):  # in the positive direction it turns about (0.5, 0)
        at = 0.5 + (-1.0 + 3.0j) * np.exp(-1j * phi)
        span, rate = at + 4.0 - 3.0j, -1j * (at - 0.5)
        e = abs(span) - 3.5
        n = 5e3 + 2e5 * e + 4e6 * e**3
        return m * g * R * np.sin(alpha - phi) + n * (span.conjugate() * rate).real / abs(span)

    lifts = moment(0.0) / (m * g * 2.5)
    assert wall.uplift(Direction.POSITIVE) == approx(lifts, rel=1e-12)
    assert wall.potential_energy(np.array([0.15]), Direction.POSITIVE)[0] == approx(quad(moment, 0, 0.15)[0], rel=1e-9)
    tilt = 0.1

    def lands(t, y):
        return y[0]

    lands.terminal = True
    back = solve_ivp(
        lambda t, y: [y[1], -moment(y[0]) / inertia], (0, 9), [tilt, 0.0], events=lands, rtol=1e-12, atol=1e-14
    )
    (first,) = back.t_events[0]
    history = rk.respond(wall, release=f"{tilt}rad", model="nonlinear")["nonlinear"]
    assert history.first_impact == approx(first, rel=1e-8)


def test_a_law_from_another_package_answers_what_it_can(law, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "wall.yaml").write_text(STIFFENING)
    (hung,) = run_json("equiv", "wall.yaml")["hung"]
    assert hung == {**hung, "name": "cable", "kind": "tie", "stiffness": 2e5, "prestress": 5e3, "only": None}
    assert "cable: a tie of 200 kN/m that stiffens by 4000 kN/m3" in in_one_line(run("equiv", "wall.yaml").stdout)
    answer = run_json("respond", "wall.yaml", "--record", ACCEL, "--neighbours", 0)
    assert list(answer["responses"]) == ["nonlinear"]
    tie = answer["responses"]["nonlinear"]["ties"]["cable"]
    assert tie["peak_force"] == approx(5e3 + 2e5 * tie["peak_elongation"] + 4e6 * tie["peak_elongation"] ** 3, rel=1e-3)
    assert run_json("margin", "wall.yaml", "--record", ACCEL, "--neighbours", 10)["motions"]
    assert run("draw", "wall.yaml", "--plot", "wall.png").exit_code == 0
    assert "stiffens" not in run("equiv", "wall.yaml").stderr


SLACK = STIFFENING.replace("2e5", "2e3").replace("4e6", "4e3").replace("prestress: 5e3", "prestress: 0")
SAYS = "linear models do not hold: cable stiffens with the cube of its elongation"


@pytest.mark.parametrize(
    ("said", "command"),
    [
        (SAYS, ("error",)),
        (SAYS, ("overturning",)),
        (SAYS, ("overturning", "--model", "linear1")),
        (SAYS, ("spectrum", "--model", "linear2", "--record", ACCEL)),
        (SAYS, ("pulse", "--ag", "0.4g", "--period", "0.8s")),
        ("no code of practice here covers it: cable stiffens", ("verify", "--site", EXAMPLES / "verify" / "site.yaml")),
    ],
    ids=lambda value: value[0] if isinstance(value, tuple) else "",
)
def test_a_law_from_another_package_says_why_it_does_not_answer(law, tmp_path, monkeypatch, said, command):
    """It has an equivalent block, whose linear models would be as wrong as its law is far from straight."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "wall.yaml").write_text(SLACK)
    verb, *options = command
    assert said in refused(verb, "wall.yaml", *options)
    equiv = run_json("equiv", "wall.yaml")
    assert equiv["misleading"] == f"the {SAYS}"
    assert equiv["directions"]["positive"]["p"] > 0


class Slack(Stiffening):
    slack: float = length("elongation before it acts", example=0.01)


def test_a_tie_of_a_larger_structure_has_larger_lengths_and_the_same_stiffness():
    bar = {"name": "bar", "from": {"ground": [-4.0, 3.0]}, "to": {"at": [-0.5, 3.0]}, "area": 1e-4, "modulus": 2e11}
    tie = Slack.model_validate({**bar, "length": 2.0, "cubic": 4e6, "slack": 0.01})
    larger = tie.enlarged(3.0)
    assert (larger.span, larger.slack) == approx((3 * tie.span, 0.03), rel=1e-12)
    assert (larger.k, larger.cubic) == (tie.k, tie.cubic) == (1e7, 4e6)


def test_the_fields_of_a_law_are_fields_of_its_tie(law, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "wall.yaml").write_text(STIFFENING.replace("cubic: 4e6", "cubic: 4 kN/m3"))
    structure = rk.structure.Structure(rk.load_structure("wall.yaml"))
    assert structure.value_of("ties.cable.cubic") == 4000.0
    assert structure.unit_of("ties.cable.cubic") == "N/m3"
    assert structure.varied("ties.cable.cubic", 1e6).mechanism.ties[0].cubic == 1e6
    assert structure.mechanism.enlarged(2.0).ties[0].cubic == 4000.0
    listed = run_json("mechanisms", "ties")["fields"]
    assert [field["field"] for field in listed["law: stiffening"]] == ["cubic"]
    for wrong, says in {
        "cubic: -1": "wall.yaml:13:12: ties[1].cubic must be more than 0 N/m3, got -1",
        "cubic: 1\n    elastic: 2": "ties[1].elastic is not a field of ties[1]",
        "": "ties[1].cubic is missing",
    }.items():
        (tmp_path / "wall.yaml").write_text(STIFFENING.replace("cubic: 4e6", wrong))
        assert says in refused("equiv", "wall.yaml")
    (tmp_path / "wall.yaml").write_text(STIFFENING.replace("law: stiffening", "law: stifening"))
    assert "ties[1].law: there is no law 'stifening': did you mean stiffening?" in refused("equiv", "wall.yaml")


def test_the_law_of_the_guide_is_this_one():
    section = (PROJECT / "docs" / "plugins.md").read_text(encoding="utf-8").partition("## Add a law of a tie\n")[2]
    lines = section.partition("\n- `Stretched`")[0].splitlines()
    code = "\n".join(line[4:] for line in lines if line.startswith("    ") or not line)
    own = ast.parse((PROJECT / "tests" / "stiffening.py").read_text(encoding="utf-8")).body[1:]
    assert ast.dump(ast.Module(own, [])) == ast.dump(ast.parse(code))


@pytest.mark.parametrize(
    ("command", "said"),
    [
        (("error",), "the linear models do not hold: cable yields"),
        (("overturning", "--model", "nonlinear"), "spectra and maps are not available: cable yields"),
        (("spectrum", "--record", ACCEL), "spectra and maps are not available: cable yields"),
        (
            ("calibrate", "--free", EXAMPLES / "calibrate" / "trace.csv"),
            "no trace of free rocking can be fitted: cable yields",
        ),
        (
            ("equivalent_pulses", EXAMPLES / "block.yaml", "--ag", "1g", "--period", "0.5"),
            "the linear models do not hold: cable yields",
        ),
    ],
    ids=lambda value: value[0] if isinstance(value, tuple) else "",
)
def test_a_tie_that_remembers_has_statics_and_no_block(monkeypatch, tmp_path, command, said):
    (tmp_path / "wall.yaml").write_text(WALL.replace("2e5", "2e3"))
    elastic = run_json("equiv", tmp_path / "wall.yaml")["directions"]
    monkeypatch.setattr(Spring, "has_memory", True)
    monkeypatch.setattr(Spring, "departs", "yields")
    found = run_json("equiv", tmp_path / "wall.yaml")["directions"]
    for side, values in found.items():
        assert (values["lambda"], values["phi_cr"]) == (elastic[side]["lambda"], elastic[side]["phi_cr"])
        assert (values["p"], values["no_block"]) == (None, "cable yields")
    assert said in refused(command[0], tmp_path / "wall.yaml", *command[1:])


class Divides(Cubic):
    def force(self, e):
        return e / 0 if e.size > 1 else [][0]


def test_an_error_of_a_law_is_its_own(law, tmp_path, monkeypatch):
    monkeypatch.setattr("tests.stiffening.Cubic", Divides)
    (tmp_path / "wall.yaml").write_text(STIFFENING)
    said = in_one_line(run("equiv", tmp_path / "wall.yaml", code=3).stderr)
    where = r" the element Divides failed in force: IndexError: list index out of range \(.*test_elements\.py:\d+\)$"
    assert re.search(where, said), said


def test_a_tie_with_a_law_is_no_bed(law, tmp_path):
    bed = "    bed: {from: [-0.5, 0.0], to: [-0.5, 3.0]}\n    modulus: 1e5\n"
    lines = [line for line in STIFFENING.splitlines() if not re.match(r"\s+(from|to|stiffness|prestress):", line)]
    (tmp_path / "wall.yaml").write_text("\n".join(lines) + "\n" + bed)
    said = "wall.yaml:10:10: ties[1].bed cannot be combined with `law`: a bed of springs is elastic"
    assert said in refused("equiv", tmp_path / "wall.yaml")


class Nameless(Tie):
    pass


@pytest.mark.parametrize(
    ("value", "said"),
    [
        ("tests.core.test_elements:Cubic", "is not a law: it must be a class derived from Tie"),
        ("tests.core.test_elements:Nameless", 'is not a law: it must have the field law: Literal["odd"] = "odd"'),
        ("tests.stiffening:Stiffening", 'is not a law: it must have the field law: Literal["odd"] = "odd"'),
    ],
)
def test_what_is_no_law_is_named_with_its_package(value, said):
    with pytest.raises(MechanismError, match=re.escape(said)):
        Laws.accept(load(EntryPoint("odd", value, "rocking.laws")), EntryPoint("odd", value, "rocking.laws"))


def test_without_such_a_package_a_law_is_no_field(tmp_path):
    (tmp_path / "wall.yaml").write_text(STIFFENING)
    assert "ties[1].law is not a field of ties[1]" in refused("equiv", tmp_path / "wall.yaml")
    assert Tie.kinds() == []
