"""Pulse shapes against their formulas by other routes, and what a specification says."""

from dataclasses import dataclass, fields
from importlib.metadata import EntryPoint

import numpy as np
import pytest
import sympy as sp
from hypothesis import example, given
from hypothesis import strategies as st

from rocking_cli.errors import InputError, MechanismError
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.excitation.pulses import Pulse, PulseShapes, parse_pulse
from rocking_cli.excitation.pulses.shapes import (
    AntisymmetricRicker,
    Cosine,
    HalfSine,
    MavroeidisPapageorgiou,
    Rectangular,
    Ricker,
    Sine,
)
from tests.cli.test_cli import run_json

A, T = 3.0, 0.8
ALL = [shape(A, T) for shape in (Sine, Cosine, HalfSine, Rectangular, Ricker, AntisymmetricRicker)] + [
    MavroeidisPapageorgiou(A, T, phase, cycles) for phase, cycles in [(0, 2), (90, 2), (37, 1.3), (-60, 3.5), (200, 8)]
]
IDS = [str(pulse) for pulse in ALL]
each = pytest.mark.parametrize("pulse", ALL, ids=IDS)
t, period, nu, gamma, s = sp.symbols("t T nu gamma s", positive=True)


def quadrature(pulse, parts=2000):
    """Composite Simpson over the pulse: nodes and weights [s]."""
    x = np.linspace(0.0, pulse.duration, 2 * parts + 1)
    w = np.full(x.size, 2.0)
    w[1::2], w[0], w[-1] = 4.0, 1.0, 1.0
    return x, w * (x[1] - x[0]) / 3


class TestFormulas:
    def wavelet(self, order):
        """Minus a derivative of a Gaussian whose spectrum, w^n exp(-(w s)^2/2), is largest at w = 2 pi/T."""
        w = sp.symbols("w", positive=True)
        (width,) = sp.solve(sp.diff(sp.log(w**order * sp.exp(-((w * s) ** 2) / 2)), w).subs(w, 2 * sp.pi / period), s)
        return -sp.diff(sp.exp(-((t / width) ** 2) / 2), t, order).subs(period, T)

    @pytest.mark.parametrize(("shape", "order"), [(Ricker, 2), (AntisymmetricRicker, 3)])
    def test_a_ricker_wavelet_is_minus_a_derivative_of_a_gaussian(self, shape, order):
        pulse = shape(A, T)
        here = np.linspace(0, pulse.duration, 2001)
        formula = sp.lambdify(t, self.wavelet(order), "numpy")
        fine = formula(np.linspace(-2 * T, 2 * T, 400_001))
        want = A * formula(here - pulse.duration / 2) / np.abs(fine).max()
        np.testing.assert_allclose(pulse.acceleration(here), want, rtol=0, atol=1e-9 * A)

    def test_the_antisymmetric_one_is_that_of_the_source_with_its_beta(self):
        x = np.linspace(-1.8, 1.8, 1001)  # in periods from the middle, Vassiliou and Makris (2011)
        z = 4 * np.pi**2 * x**2 / 3
        source = (z - 3) * (2 * np.pi * x / np.sqrt(3)) * np.exp(-z / 2) / 1.38
        np.testing.assert_allclose(AntisymmetricRicker(1.0, 1.0).shape(x + 1.8), source, atol=2e-3)

    @pytest.mark.parametrize("pulse", ALL[6:], ids=IDS[6:])
    def test_a_near_fault_pulse_is_the_derivative_of_its_velocity(self, pulse):
        f = 1 / period
        v = (1 + sp.cos(2 * sp.pi * f * t / gamma)) * sp.cos(2 * sp.pi * f * t + nu) / 2
        values = {period: T, nu: np.radians(pulse.phase), gamma: pulse.cycles}
        here = np.linspace(0, pulse.duration, 40_001)
        velocity, acceleration = (
            sp.lambdify(t, what.subs(values), "numpy")(here - pulse.duration / 2) for what in (v, sp.diff(v, t))
        )
        peak = np.abs(acceleration).max()
        np.testing.assert_allclose(pulse.acceleration(here), A * acceleration / peak, rtol=0, atol=1e-6 * A)
        np.testing.assert_allclose(pulse.velocity(here), A * velocity / peak, rtol=0, atol=1e-6 * A)
        assert pulse.velocity_amplitude == pytest.approx(A / peak, rel=1e-6)

    def test_sines(self):
        x = np.linspace(0, 1, 101)
        np.testing.assert_allclose(Sine(A, T).acceleration(x * T), A * np.cos(2 * np.pi * (x - 0.25)), atol=1e-14)
        np.testing.assert_allclose(Cosine(A, T).acceleration(x * T), A * np.sin(2 * np.pi * (x + 0.25)), atol=1e-14)
        np.testing.assert_allclose(HalfSine(A, T).acceleration(x * T / 2), A * np.sin(np.pi * x), atol=1e-14)
        np.testing.assert_array_equal(Rectangular(A, T).acceleration(x * T), np.full(101, A))


class TestEvery:
    def test_the_installed_shapes_are_all_tested(self):
        assert {pulse.name for pulse in ALL} == set(PulseShapes())
        for name, shape in PulseShapes().items():
            assert shape.name == name and shape.title and shape.source

    @each
    def test_its_amplitude_is_its_largest_acceleration(self, pulse):
        a = np.abs(pulse.acceleration(np.linspace(0, pulse.duration, 400_001)))
        assert a.max() == pytest.approx(A, rel=1e-8)

    @each
    def test_it_is_zero_outside_and_starts_at_zero(self, pulse):
        gap = 1e-9
        outside = np.array([-1.0, -gap, pulse.duration + gap, 1e3])
        assert (pulse.acceleration(outside) == 0).all()
        np.testing.assert_array_equal(pulse.velocity(np.array([-1.0, 0.0])), [0, 0])
        assert pulse.velocity(np.array([1e3])) == pulse.velocity(np.array([pulse.duration]))

    @each
    def test_its_velocity_is_the_integral_of_its_acceleration(self, pulse):
        for share in (0.13, 0.5, 0.77, 1.0):
            x, w = quadrature(pulse)
            whole = w * share @ pulse.acceleration(share * x)
            assert float(pulse.velocity(share * pulse.duration)) == pytest.approx(whole, abs=1e-9 * A * T)
            general = A * T * float(Pulse.velocity_shape(pulse, np.array(share * pulse.span)))
            assert general == pytest.approx(whole, abs=1e-9 * A * T)

    @each
    def test_the_ground_comes_to_rest_except_after_a_push_to_one_side(self, pulse):
        end = float(pulse.velocity(pulse.duration))
        left = {"half_sine": A * T / np.pi, "rectangular": A * T}.get(pulse.name, 0.0)
        assert end == pytest.approx(left, abs=3e-7 * A * T)

    @each
    def test_its_sign_is_that_of_the_source(self, pulse):
        a = pulse.acceleration(np.linspace(0, pulse.duration, 10_001))
        large = a[np.abs(a) > 0.9 * A]
        turned = pulse.name == "mavroeidis" and np.cos(np.radians(pulse.phase)) < 0.1
        assert (large[0] > 0) is not bool(turned and np.sin(np.radians(pulse.phase)) < 0)

    @each
    def test_segments_are_its_acceleration(self, pulse):
        segments = pulse.segments()
        assert bool(segments) is (pulse.name in ("sine", "cosine", "half_sine", "rectangular"))
        ends = [0.0]
        for part in segments:
            assert part.start == ends[-1] and part.stop > part.start
            ends.append(part.stop)
            here = np.linspace(part.start, part.stop, 101)
            sines = part.amplitude * np.sin(part.omega * (here - part.start) + part.phase)
            np.testing.assert_allclose(pulse.acceleration(here), sines, rtol=0, atol=1e-14 * A)
        assert not segments or ends[-1] == pulse.duration

    @each
    def test_samples_are_the_pulse_to_second_order(self, pulse):
        for count in (50, 100, 200):
            motion = pulse.sampled(count)
            assert motion.duration == pytest.approx(pulse.duration, rel=1e-14)
            assert motion.dt <= T / count * (1 + 1e-9)
            here = np.linspace(0, pulse.duration, 20_011)
            assert motion.acceleration[0] == pulse.acceleration(np.array(0.0))
            assert motion.acceleration[-1] == pulse.acceleration(np.array(pulse.duration))
            chords = np.interp(here, motion.dt * np.arange(motion.npts), motion.acceleration)
            off = np.abs(chords - pulse.acceleration(here)).max()
            bend = np.abs(np.diff(pulse.acceleration(motion.dt * np.arange(motion.npts)), 2)).max()
            # A chord is off by an eighth of it, samples by a twelfth, and by half of that more beside a peak.
            assert bend / 20 <= off <= bend / 6
        assert (motion.format, motion.name, motion.source_unit) == ("pulse", str(pulse), "g")

    @each
    def test_the_usual_samples_are_fine_enough(self, pulse):
        motion = pulse.sampled()
        here = np.linspace(0, pulse.duration, 20_011)
        chords = np.interp(here, motion.dt * np.arange(motion.npts), motion.acceleration)
        assert np.abs(chords - pulse.acceleration(here)).max() < 2e-4 * A

    @pytest.mark.parametrize("bad", [0.0, float("nan"), float("inf")])
    def test_wrong_numbers_are_refused(self, bad):
        for shape in (Sine, MavroeidisPapageorgiou):
            with pytest.raises(InputError, match="amplitude must be positive"):
                shape(bad, T)
            with pytest.raises(InputError, match="period must be positive"):
                shape(A, bad)


@given(st.floats(-720, 720), st.floats(1.001, 20))
@example(1.0, 9.0)  # two peaks that differ less than a coarse grid can tell
def test_the_amplitude_of_a_near_fault_pulse_is_its_peak_for_any_phase(phase, cycles):
    pulse = MavroeidisPapageorgiou(1.0, 1.0, phase, cycles)
    a = np.abs(pulse.shape(np.linspace(0, cycles, round(2000 * cycles))))
    assert a.max() == pytest.approx(1, abs=1e-5) and a.max() < 1 + 1e-8  # a parabola over 1e-3 period


@pytest.mark.parametrize(
    ("phase", "cycles"), [(float("nan"), 2), (float("inf"), 2), (0, 1), (0, 21), (0, float("nan"))]
)
def test_wrong_phases_and_cycles_are_refused(phase, cycles):
    with pytest.raises(InputError, match=r"phase|cycles"):
        MavroeidisPapageorgiou(A, T, phase, cycles)


class TestSpecifications:
    @pytest.mark.parametrize(
        ("text", "want"),
        [
            ("sine:0.6g:0.8s", Sine(0.6 * STANDARD_GRAVITY, 0.8)),
            ("sine: 6 m/s2 :800ms", Sine(6.0, 0.8)),
            ("ricker:60cm/s2:1.25hz", Ricker(0.6, 0.8)),
            ("half_sine:600 MM/S2:.8 s", HalfSine(0.6, 0.8)),
            ("rectangular:1e2gal:1s", Rectangular(1.0, 1.0)),
            ("mavroeidis:1m/s2:1s", MavroeidisPapageorgiou(1.0, 1.0, 0.0, 2.0)),
            ("mavroeidis:1m/s2:1s:-30deg", MavroeidisPapageorgiou(1.0, 1.0, -30.0, 2.0)),
            ("mavroeidis:1m/s2:1s:90:1.5", MavroeidisPapageorgiou(1.0, 1.0, 90.0, 1.5)),
        ],
    )
    def test_what_they_say(self, text, want):
        found = parse_pulse(text)
        assert type(found) is type(want)
        for field in fields(want):
            assert getattr(found, field.name) == pytest.approx(getattr(want, field.name), rel=1e-14)

    @pytest.mark.parametrize(
        ("text", "words"),
        [
            ("sin:0.6g:0.8s", "unknown pulse: sin (did you mean sine?)"),
            ("sine:0.6g", "malformed pulse"),
            ("sine:0.6:0.8s", "no unit of amplitude, give g, m/s2, cm/s2, mm/s2, gal"),
            ("sine:0.6g:0.8kg", "unknown unit 'kg' of period, give s, ms, Hz"),
            ("sine:x:0.8s", "'x' is not a valid amplitude"),
            ("sine:0.6g:0Hz", "the frequency must not be zero"),
            ("sine:-0.6g:1s", "amplitude must be positive"),
            ("mavroeidis:1g:1s:1rad", "unknown unit 'rad' of phase, give deg"),
            ("mavroeidis:1g:1s:1:2deg", "unknown unit 'deg' of cycles, it takes none"),
            ("mavroeidis:1g:1s:1:0.5", "above 1 and at most 20"),
        ],
    )
    def test_what_is_wrong_is_said(self, text, words):
        with pytest.raises(InputError) as caught:
            parse_pulse(text)
        assert words in str(caught.value)

    @pytest.mark.parametrize("name", list(PulseShapes()))
    def test_the_expected_form_is_shown_with_an_example_that_works(self, name):
        with pytest.raises(InputError) as caught:
            parse_pulse(f"{name}:1")
        said = str(caught.value)
        assert f"expected {name}:{PulseShapes()[name].form}, such as " in said
        assert parse_pulse(said.rpartition("such as ")[2]).amplitude == pytest.approx(0.6 * STANDARD_GRAVITY)


@dataclass(frozen=True)
class Triangle(Pulse):
    """A shape of somebody else, with a parameter of its own."""

    top: float = 0.5
    name = "triangle"
    title = "up and down"
    form = "AMPLITUDE:PERIOD[:TOP]"
    span = 1.0

    def shape(self, x):
        return np.interp(x, [0, self.top, 1], [0, 1, 0])


class Nameless(Pulse):
    span = 1.0

    def shape(self, x):
        return x


class Incomplete(Pulse):
    name, title = "incomplete", "without a shape"


def install(monkeypatch, *points):
    entries = [EntryPoint(name=name, value=value, group=PulseShapes.group) for name, value in points]
    monkeypatch.setattr("rocking_cli.plugins.registry.entry_points", lambda group: entries)


class TestPlugins:
    def test_a_shape_of_somebody_else_is_found(self, monkeypatch):
        install(monkeypatch, ("triangle", f"{__name__}:Triangle"))
        assert list(PulseShapes()) == ["triangle"] and len(PulseShapes()) == 1 and "triangle" in PulseShapes()
        assert parse_pulse("triangle:2m/s2:1s:0.25") == Triangle(2.0, 1.0, 0.25)
        assert parse_pulse("triangle:2m/s2:1s").acceleration(np.array([0.25, 2])) == pytest.approx([1, 0])
        with pytest.raises(InputError, match="TOP"):
            parse_pulse("triangle:2m/s2")

    @pytest.mark.parametrize(
        ("name", "target", "words"),
        [
            ("incomplete", f"{__name__}:Incomplete", "is not a pulse shape: it must derive from Pulse"),
            ("other", f"{__name__}:install", "is not a pulse shape: it must derive from Pulse"),
            ("nameless", f"{__name__}:Nameless", "it needs name = 'nameless' and a title"),
            ("rectangle", f"{__name__}:Triangle", "it needs name = 'rectangle'"),
            ("gone", "nowhere_at_all:Gone", "cannot be loaded"),
        ],
    )
    def test_what_is_no_shape_is_refused(self, name, target, words, monkeypatch):
        install(monkeypatch, (name, target))
        with pytest.raises(MechanismError, match=words):
            parse_pulse(f"{name}:1g:1s")


class TestSpecification:
    """What is echoed makes the same pulse again, to the last bit."""

    def test_round_trip_of_any_number(self):
        rng = np.random.default_rng(5)
        for amplitude, period, phase in 10 ** rng.uniform(-6, 3, (100, 3)):
            pulse = MavroeidisPapageorgiou(float(amplitude), float(period), float(-phase), 1.5 + float(phase) % 1)
            assert parse_pulse(pulse.specification) == pulse

    def test_the_commands_echo_it_and_give_amplitudes_in_g(self):
        given = "sine:2.7265m/s2:1.536s"
        respond = run_json("respond", "--pulse", given, "--neighbours", 0)["record"]
        assert respond["pulse"]["specification"] == given and respond["unit"] == "g"
        pulse = run_json("pulse", "--ag", "2.7265m/s2", "--period", "1.536")["pulse"]
        for key in ("shape", "specification", "amplitude", "period", "duration"):
            assert pulse[key] == respond["pulse"][key]
        assert pulse["amplitude"] == pytest.approx(2.7265 / 9.80665)
