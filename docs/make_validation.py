"""Renew docs/validation.md: what is checked, against what, how close it is, and the tests that hold it.

    python -m docs.make_validation            # make validation
    python -m docs.make_validation --check    # fails when the page is stale

Differences above 1e-10 are given as the power of ten they stay below: the page is the same on every machine.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import acosh, asin, ceil, cos, exp, inf, log, log10, pi, sin, sqrt, tan
from typing import Any

import numpy as np

from mechanisms._arch_collapse import least_thickness
from rocking_cli import Direction, GroundMotion, Mechanism, Registry, closed_form, load_structure, measure, respond
from rocking_cli.core import equivalent_block
from rocking_cli.core.reactions import reactions
from rocking_cli.dynamics.exact import exact_pulse
from rocking_cli.questions.error.study import linearisation
from validation.pages import DOCS, renewed, table

PAGE = DOCS / "validation.md"
EXAMPLES = DOCS.parent / "examples"
FLOOR = -10  # what is below differs from machine to machine
G = 9.80665


@dataclass(frozen=True)
class Check:
    """Quantity with the source of its reference value, both values, and the test that checks it."""

    quantity: str
    reference: str
    expected: float
    ours: float
    test: str

    def row(self) -> tuple[str, str, str]:
        """Return a line of the table, with a power of ten above the relative difference if that is not negligible."""
        difference = abs(self.ours - self.expected) / (abs(self.expected) or 1.0)
        power = ceil(log10(difference)) if difference else FLOOR
        apart = f", off by less than 1e{power}" if power > FLOOR else ""
        return self.quantity, self.reference, f"{self.expected:.5g}{apart}"


def make(name: str, **values: Any) -> Mechanism:
    """Return a mechanism by name."""
    return Registry()[name](**values)


def one_body() -> Iterator[Check]:
    """Section 2 and Table I."""
    b, h = 0.35, 1.4
    R, alpha = sqrt(b * b + h * h), np.arctan2(b, h)
    block = equivalent_block(make("block", width=2 * b, height=2 * h)).positive
    test = "test_closed_forms.py"
    yield Check("block 0.7 m x 2.8 m: $p$ [rad/s]", r"Eq. 3: $\sqrt{3g/(4R)}$", sqrt(3 * G / (4 * R)), block.p, test)
    yield Check("its uplift over $g$", r"$\tan \alpha$", b / h, block.lambda_, test)
    yield Check("its critical rotation [rad]", r"$\alpha$", float(alpha), block.phi_cr, test)
    yield Check(
        "its restitution",
        r"Housner 1963: $1 - \frac{3}{2} \sin^2 \alpha$",
        1 - 1.5 * sin(alpha) ** 2,
        block.eta,
        "test_restitution.py",
    )
    strut = equivalent_block(make("point_mass", base_width=0.7, height=2.8)).positive
    R = sqrt(0.35**2 + 2.8**2)
    yield Check("point mass on a strut: $p$ [rad/s]", r"Table I: $\sqrt{g/R}$", sqrt(G / R), strut.p, test)
    yield Check(
        "its restitution", r"Table I: $\cos 2 \alpha$", cos(2 * np.arctan2(0.35, 2.8)), strut.eta, "test_restitution.py"
    )
    shell = equivalent_block(make("cone", base_radius=0.5, height=3.0)).positive
    R, a = sqrt(0.25 + 1.0), float(np.arctan2(0.5, 1.0))
    yield Check(
        "thin conical shell: $p$ [rad/s]",
        r"Table I: $\sqrt{4g/(R (5 + \cos^2 \alpha))}$",
        sqrt(4 * G / (R * (5 + cos(a) ** 2))),
        shell.p,
        test,
    )
    eta = 1 - 8 * sin(a) ** 2 / (5 + cos(a) ** 2)
    yield Check(
        "its restitution", r"Table I: $1 - 8 \sin^2 \alpha/(5 + \cos^2 \alpha)$", eta, shell.eta, "test_restitution.py"
    )
    cone = equivalent_block(make("cone", base_radius=0.5, height=3.0, kind="solid")).positive
    p2 = 5 * G * sqrt(9 + 16 * 0.25) / (2 * 9 + 23 * 0.25)
    yield Check(
        "solid cone: $p$ [rad/s]", r"Table I: $p^2 = 5g \sqrt{h^2 + 16 r^2}/(2 h^2 + 23 r^2)$", sqrt(p2), cone.p, test
    )
    yield Check("its uplift over $g$", "Table I: $4r/h$", 4 * 0.5 / 3.0, cone.lambda_, test)
    eta = (2 * 9 - 17 * 0.25) / (2 * 9 + 23 * 0.25)
    yield Check("its restitution", "Table I: $(2 h^2 - 17 r^2)/(2 h^2 + 23 r^2)$", eta, cone.eta, "test_restitution.py")
    gamma, b, h = 2.0, 0.4, 2.0
    R, alpha = sqrt(b * b + h * h), float(np.arctan2(b, h))
    frame = equivalent_block(
        make("symmetric_frame", column_width=2 * b, column_height=2 * h, mass_ratio=gamma)
    ).positive
    p = sqrt(3 * G / (4 * R) * (1 + 2 * gamma) / (1 + 3 * gamma))
    yield Check(
        "symmetric frame: $p$ [rad/s]",
        r"Table I: $p^2 = \frac{3g}{4R} \frac{1 + 2 \gamma}{1 + 3 \gamma}$",
        p,
        frame.p,
        test,
    )
    eta = (1 - 1.5 * sin(alpha) ** 2 + 3 * gamma * cos(2 * alpha)) / (1 + 3 * gamma)
    yield Check(
        "its restitution",
        r"Table I: $(1 - \frac{3}{2} \sin^2 \alpha + 3 \gamma \cos 2 \alpha)/(1 + 3 \gamma)$",
        eta,
        frame.eta,
        "test_restitution.py",
    )


def more_bodies() -> Iterator[Check]:
    """Sections 4 and 5."""
    alpha = 0.2
    wall = equivalent_block(make("wall", thickness=2 * sin(alpha), height=4 * cos(alpha))).positive
    yield Check(
        r"wall, $\alpha = 0.2$: uplift over $g$",
        r"Eq. 21: $2 \tan \alpha$",
        2 * tan(alpha),
        wall.lambda_,
        "test_closed_forms.py",
    )
    yield Check("its critical rotation [rad]", r"Section 4: $\alpha$", alpha, wall.phi_cr, "test_closed_forms.py")
    yield Check(r"its $\kappa_1$", r"Section 4: $\frac{1}{2}$", 0.5, wall.kappa1, "test_closed_forms.py")
    yield Check("its $p$ [rad/s]", r"Eq. 23: $\sqrt{3g/(2R)}$", sqrt(1.5 * G), wall.p, "test_closed_forms.py")
    b, H, H1, L, h = 0.8, 3.5, 5.0, 10.0, 0.75
    frame = equivalent_block(load_structure(EXAMPLES / "frame.yaml"))
    left, beam, right = (2500.0 * 2 * area for area in (2 * b * 2 * H, (L + 2 * b) * 2 * h, 2 * b * 2 * H1))
    for direction, s in ((Direction.POSITIVE, 1), (Direction.NEGATIVE, -1)):
        expected = (b / H) * (left + (1 + H / H1 - s * (2 * b / L) * (1 - H / H1)) * beam + (H / H1) * right)
        expected /= left + 2 * (1 + s * (b * h / (L * H)) * (1 - H / H1)) * beam + right
        yield Check(f"asymmetric frame, {direction.label}: uplift over $g$", "Eq. 33, corrected", expected,
                    frame[direction].lambda_, "test_asymmetric_frame.py")  # fmt: skip
    even = {"column_width": 1.6, "left_height": 7.0, "right_height": 7.0, "spacing": 10.0, "beam_depth": 1.5}
    masses = {"left_mass": 1.0, "right_mass": 1.0, "beam_mass": 4.0}
    one = equivalent_block(make("asymmetric_frame", **even, **masses)).negative
    other = equivalent_block(make("symmetric_frame", column_width=1.6, column_height=7.0, mass_ratio=2.0)).positive
    for name, symbol in (("p", "p"), ("lambda_", r"\lambda"), ("eta", r"\eta")):
        yield Check(f"with equal columns: ${symbol}$", "symmetric frame, Eq. 36",
                    getattr(other, name), getattr(one, name), "test_asymmetric_frame.py")  # fmt: skip
    yield Check("least $t/r$ of an arch of 180 deg that stands", "Milankovitch 1907: 0.1075", 0.1075,
                least_thickness(pi, None), "test_arch.py")  # fmt: skip
    arch = equivalent_block(load_structure(EXAMPLES / "arch.yaml")).positive
    yield Check("Oppenheim's arch: uplift over $g$", "Oppenheim 1992: 0.37", 0.37, arch.lambda_, "test_arch.py")


def errors() -> Iterator[Check]:
    """Section 4: Eqs. 24 and 25, and the integrals they are compared with."""
    test = "test_linearisation.py"
    for file in ("block", "wall", "frame", "arch"):
        mechanism = load_structure(EXAMPLES / f"{file}.yaml")
        found = linearisation(mechanism, Direction.POSITIVE, 0.5, 2.0)
        free = respond(mechanism, release=0.5, opening=1000.0, model=("nonlinear",))["nonlinear"]
        yield Check(rf"{file}: period from $\phi_{{cr}}/2$ [s]", "integrated motion",
                    4 * float(free.impacts[0, 0]), float(found.period[0]), test)  # fmt: skip
        push = GroundMotion("constant", 0.01, np.full(3000, -2 * found.block.lambda_ * mechanism.gravity), unit="m/s2")
        fall = respond(mechanism, push, opening=1000.0, model=("nonlinear",))["nonlinear"]
        yield Check(rf"{file}: time to overturn at $2 \lambda g$ [s]", "integrated motion",
                    fall.overturning_time or inf, float(found.overturning[0]), test)  # fmt: skip


def histories() -> Iterator[Check]:
    """Limit cases of the engine."""
    mechanism = make("block", width=0.7, height=2.8)
    block = equivalent_block(mechanism).positive
    free = respond(mechanism, release=0.4, model=("linear2",))["linear2"]
    yield Check("linear block let go: first impact [s]", r"$\operatorname{arcosh}(1/0.6)/p$",
                acosh(1 / 0.6) / block.p, float(free.impacts[0, 0]), "test_history_events.py")  # fmt: skip
    rate = block.p * block.phi_cr * sqrt(1 - 0.36)
    yield Check(
        "its rate there [rad/s]",
        r"energy: $p \phi_{cr} \sqrt{1 - 0.6^2}$",
        rate,
        float(free.impacts[0, 2]),
        "test_history_events.py",
    )
    t = 0.4
    above = GroundMotion("step", t, np.array([-2 * block.lambda_ * G] * 2), unit="m/s2")
    held = respond(mechanism, above, model=("linear2",))["linear2"]
    yield Check(r"linear block pushed at $2 \lambda g$ for 0.4 s: $\phi/\phi_{cr}$", r"$\cosh pt - 1$",
                cosh_minus_one(block.p * t), float(held.ratio[1]), "test_history_linear.py")  # fmt: skip

    heavy = respond(make("block", width=0.7, height=2.8, gravity=1.25 * G), release=0.4)["nonlinear"]
    still = GroundMotion(
        "still", 10.0, np.zeros(2), vertical=GroundMotion("up", 10.0, np.full(2, 0.25 * G), unit="m/s2"), unit="m/s2"
    )
    lifted = respond(mechanism, still, release=0.4)["nonlinear"]
    yield Check(r"block under a constant $\ddot{v}_g = g/4$: first impact [s]", "gravity of $1.25 g$",
                float(heavy.impacts[0, 0]), float(lifted.impacts[0, 0]), "test_history_vertical.py")  # fmt: skip


def records() -> Iterator[Check]:
    """Measures of a ground motion: a ramp of the acceleration to 3 m/s2 in 2 s."""
    found = measure(GroundMotion("ramp", 2.0, np.array([0.0, 3.0]), unit="m/s2"))
    test = "test_measures.py"
    yield Check("ramp to $a$ = 3 m/s2 in $t$ = 2 s: PGV [m/s]", "$a t/2$", 3.0, found.pgv, test)
    yield Check("its PGD [m]", "$a t^2/6$", 2.0, found.pgd, test)
    yield Check("its Arias intensity [m/s]", r"$\pi a^2 t/(6 g)$", pi * 9 * 2 / (6 * G), found.arias, test)


def cosh_minus_one(y: float) -> float:
    """Return the rise under twice the uplift acceleration, over phi_cr."""
    return (exp(y / 2) - exp(-y / 2)) ** 2 / 2


def pulses() -> Iterator[Check]:
    """Section 6.2."""
    a, omega, eta = 4.0, 6.0, 0.9
    exact, form = exact_pulse(a, omega, eta), closed_form(a, omega, eta)
    yield Check(r"full sine $a = 4$, $\omega = 6$: first rebound", "Eqs. 41-42", form.max_ratio or inf,
                exact.first_rebound or inf, "test_pulse.py")  # fmt: skip

    def without_impact(a: float, omega: float) -> float:
        """Condition (iii) of the closed form: zero where a full sine just overturns without impact."""
        s, te = sqrt(a * a - 1), (2 * pi - asin(1 / a)) / omega
        return (s - omega) * exp(te) - a

    low, high = 2.0, 20.0
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if without_impact(middle, 3.0) < 0 else (low, middle)

    def without_impact_falls(a: float) -> bool:
        exact = exact_pulse(a, 3.0, eta)
        return exact.fell and exact.impact_count == 0

    expected, low, up = high, 3.0, 5.0
    for _ in range(60):
        middle = (low + up) / 2
        low, up = (low, middle) if without_impact_falls(middle) else (middle, up)
    yield Check(r"full sine $\omega = 3$: least $a$ that overturns", r"$(w - \omega) e^{\tau_e} = a$",
                expected, up, "test_exact_pulse.py")  # fmt: skip
    low, high = 1e-3, 20.0
    for _ in range(60):  # the length of a rectangle that just overturns a block, as omega = 2 pi/(p T)
        middle = sqrt(low * high)
        low, high = (middle, high) if exact_pulse(2.0, middle, eta, shape="rectangular").fell else (low, middle)
    yield Check("rectangle $a = 2$: $p T$ that just overturns", r"$\ln(a/(a - 1))$, without impact", log(2.0),
                2 * pi / high, "test_exact_pulse.py")  # fmt: skip


def as_they_stand() -> Iterator[Check]:
    """Loads, ties, supports, and forces at joints."""
    test, weight = "test_loads_and_ties.py", 5000 * G  # of a block 1 m x 5 m

    def tied(prestress: float, stiffness: float) -> Mechanism:
        path = [{"ground": [0.0, 0.0]}, {"at": [0.0, 0.0]}]
        tendon = {"name": "tendon", "path": path, "stiffness": stiffness, "prestress": prestress}
        return make("block", width=1.0, height=5.0, density=1000.0, depth=1.0, ties=[tendon])

    found = equivalent_block(tied(0.2 * weight, 0.0)).positive
    expected = (0.5 * weight + 0.5 * 0.2 * weight) / (2.5 * weight)
    yield Check("block with prestressed tendon: uplift over $g$", "moments about the corner", expected, found.lambda_,
                test)  # fmt: skip
    found = equivalent_block(tied(0.0, 20 * weight / 5)).positive
    # 0.5 cos phi - 2.5 sin phi + (20/5) 0.5^2 sin phi vanishes
    yield Check("with an elastic one: critical rotation [rad]", "root of its moment", float(np.arctan(1 / 3)),
                found.phi_cr, test)  # fmt: skip
    interlock = {"courses": 40, "overlap": 0.2, "thickness": 0.5, "walls": 2, "height": 8.0}
    size = {"width": 0.6, "height": 8.0, "depth": 5.0, "density": 18000 / G}
    facade, crushed = make("block", **size, interlock=interlock), {"strength": 1e6, "depth": 5.0}
    friction = 2 * 0.4 * 40 * 41 * 0.577 * 0.2**2 * 0.5 * 18000  # of two walls, at a third of the height
    yield Check("facade with crossing walls: uplift over $g$", "Circolare C8.7.1.2",
                (432e3 * 0.3 + friction * 8 / 3) / (432e3 * 4), facade.uplift(Direction.POSITIVE), test)  # fmt: skip
    yield Check("facade that crushes its foot: uplift over $g$", r"pivot moved by $N/(2 \sigma d)$",
                (0.3 - 432e3 / (2 * 1e6 * 5)) / 4,
                make("block", **size, crushing=crushed).uplift(Direction.POSITIVE), "test_crushing.py")  # fmt: skip
    rho, xi = 1.0, 1 / (1 + sqrt(0.25))
    wall = make("spanning_wall", thickness=0.3, height=3.0, hinge="weakest", density=1800.0, depth=1.0,
                overburden=rho * 1800 * 0.9 * G)  # fmt: skip
    yield Check("wall between floors: uplift over $g$ at the weakest hinge",
                r"$\frac{2t}{\xi h} [1 + \rho (1 + \frac{k \xi}{1 - \xi})]$",
                0.2 / xi * (1 + rho * (1 + 0.5 * xi / (1 - xi))), wall.uplift(Direction.POSITIVE),
                "test_spanning_wall.py")  # fmt: skip
    b, h = 0.35, 1.4
    R, alpha = sqrt(b * b + h * h), float(np.arctan2(b, h))
    yield Check("block: velocity step that overturns it [m/s]",
                r"$\sqrt{8 g R (1 - \cos \alpha)/3}/\cos \alpha$", sqrt(8 * G * R * (1 - cos(alpha)) / 3) / cos(alpha),
                equivalent_block(make("block", width=0.7, height=2.8)).positive.v_imp, test)  # fmt: skip
    block = make("block", width=1.0, height=5.0)
    at = reactions(block, Direction.POSITIVE, np.array([0.05]), np.array([0.2]), np.array([-0.3 * G + 0j]))
    I, turned = 4 / 3 * (0.25 + 6.25), complex(-0.5, 2.5) * complex(cos(0.05), -sin(0.05))  # noqa: E741
    bend = (0.3 * G * turned.imag + G * turned.real) / I  # phi.. about the corner
    z = -1j * turned * bend - turned * 0.2**2 + complex(-0.3 * G, G)
    yield Check("block in motion: horizontal force over weight", "Newton, Euler", z.real / G,
                float(at.force[0, 0].real) / G, "test_reactions.py")  # fmt: skip
    yield Check("and its normal force", "likewise", z.imag / G, float(at.force[0, 0].imag) / G,
                "test_reactions.py")  # fmt: skip


SECTIONS = (one_body, more_bodies, as_they_stand, histories, records, errors, pulses)


def section(checks: Sequence[Check]) -> str:
    """Return the table of some checks, and their tests."""
    tests = ", ".join(sorted({f"`{check.test}`" for check in checks}))
    return f"{table(('quantity', 'reference', 'value'), (check.row() for check in checks))}\n\nHeld by {tests}."


def page(text: str) -> str:
    """Return the page with its parts as they are made now."""
    return renewed(text, {each.__name__: section(list(each())) for each in SECTIONS})


def main() -> int:
    """Renew the page, or say whether it is stale."""
    text = PAGE.read_text(encoding="utf-8")
    now = page(text)
    if "--check" in sys.argv[1:]:
        if text != now:
            print("docs/validation.md is stale: run make validation", file=sys.stderr)
        return int(text != now)
    PAGE.write_text(now, encoding="utf-8", newline="\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
