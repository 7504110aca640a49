"""Measures of intensity against their definitions, integrated by other means; their names, and their powers."""

from math import asin, pi

import numpy as np
import pytest
from scipy.integrate import simpson
from scipy.signal import lsim

from rocking_cli import load_structure
from rocking_cli.core import equivalent_block
from rocking_cli.errors import InputError, PluginError
from rocking_cli.excitation.base import STANDARD_GRAVITY as G
from rocking_cli.excitation.base import GroundMotion
from rocking_cli.processing.intensity import (
    IntensityMeasures,
    MotionMeasure,
    Reference,
    all_measures,
    parse_measure,
    parse_measures,
    power_of,
)
from rocking_cli.questions.record.verb import intensities, reference_of
from rocking_cli.structure import Structure
from tests.conftest import EXAMPLES

NOISE = GroundMotion("noise", 0.02, np.random.default_rng(5).normal(size=400), unit="m/s2")
A, T = 3.0, 0.9
SINE = GroundMotion("sine", T / 900, A * np.sin(2 * pi * np.linspace(0, 1, 901)), unit="m/s2")


DU = parse_measure("Du")


def value(name, motion=NOISE):
    return parse_measure(name).value(motion)


def fine(motion, parts=1000):
    """Times and accelerations of the same straight lines, far more densely."""
    t = np.linspace(0, motion.duration, (motion.npts - 1) * parts + 1)
    return t, np.interp(t, motion.time, motion.acceleration)


def displacement(motion, period, damping):
    """Largest displacement of an oscillator, by scipy on a fine grid, in the first swing after the motion too."""
    step = motion.dt / np.ceil(motion.dt / (period / 100))
    t = np.arange(0, motion.duration + 1.5 * period, step)
    ground = np.interp(t, motion.time, motion.acceleration, right=0.0)
    w = 2 * pi / period
    _, x, _ = lsim(([-1.0], [1.0, 2 * damping * w, w * w]), ground, t)
    return float(np.abs(x).max())


class TestDefinitions:
    def test_cumulative_absolute_velocity(self):
        t, a = fine(NOISE)
        assert value("CAV") == pytest.approx(np.trapezoid(np.abs(a), t), rel=1e-6)
        assert value("CAV", SINE) == pytest.approx(2 * A * T / pi, rel=1e-5)

    @pytest.mark.parametrize(("name", "share"), [("D5-75", 0.75), ("D5-95", 0.95)])
    def test_durations(self, name, share):
        t, a = fine(NOISE)
        built = np.cumsum(a * a)
        start, end = (t[np.searchsorted(built, part * built[-1])] for part in (0.05, share))
        assert value(name) == pytest.approx(end - start, abs=2e-4)

    def test_mean_period_by_sums_over_the_frequencies(self):
        points = 1024  # at least twice the record and 20 s
        f = np.arange(points) / (points * NOISE.dt)
        f = f[(f >= 0.25) & (f <= 20)]
        amplitudes = np.abs(np.exp(-2j * pi * np.outer(f, NOISE.time)) @ NOISE.acceleration) ** 2
        assert value("Tm") == pytest.approx((amplitudes / f).sum() / amplitudes.sum(), rel=1e-10)
        f = np.linspace(0.25, 20, 5_000)
        amplitudes = np.abs(np.exp(-2j * pi * np.outer(f, NOISE.time)) @ NOISE.acceleration) ** 2
        assert value("Tm") == pytest.approx((amplitudes / f).sum() / amplitudes.sum(), rel=0.01)

    def test_mean_period_of_many_cycles_is_that_of_one_whatever_zeros_follow(self):
        t = np.arange(0, 60, 0.01)
        cycles = 2 * np.sin(2 * pi * t / 0.8) * np.sin(pi * t / 60)
        assert value("Tm", GroundMotion("cycles", 0.01, cycles, unit="m/s2")) == pytest.approx(0.8, rel=2e-3)
        padded = GroundMotion("padded", NOISE.dt, np.concatenate([NOISE.acceleration, np.zeros(1000)]), unit="m/s2")
        assert value("Tm", padded) == pytest.approx(value("Tm"), rel=5e-3)

    def test_spectrum_intensity_by_another_integrator_and_rule(self):
        short = GroundMotion("short", 0.02, SINE.acceleration[::20], unit="m/s2")
        periods = np.linspace(0.1, 2.5, 41)
        sv = [2 * pi / period * displacement(short, period, 0.05) for period in periods]
        assert value("SI", short) == pytest.approx(simpson(sv, x=periods), rel=2e-3)

    def test_spectral_values_by_another_integrator(self):
        for period in (0.3, 1.0):
            sd = displacement(NOISE, period, 0.02)
            assert value(f"Sd({period}, 2%)") == pytest.approx(sd, rel=2e-3)
            assert value(f"Sa({period}, 2%)") == pytest.approx((2 * pi / period) ** 2 * sd / G, rel=2e-3)

    def test_an_average_spectral_acceleration(self):
        short = GroundMotion("short", 0.02, SINE.acceleration[::20], unit="m/s2")
        periods = 0.2 + 0.3 * np.arange(100) / 99
        sa = [(2 * pi / period) ** 2 * displacement(short, period, 0.05) / G for period in periods]
        assert value("Sa_avg(0.2:0.5)", short) == pytest.approx(np.exp(np.mean(np.log(sa))), rel=2e-3)
        assert value("Sa_avg(0.2:0.5)", short) != pytest.approx(np.mean(sa), rel=2e-3)

    def test_a_sine(self):
        assert value("PGA", SINE) == pytest.approx(A / G)
        assert value("PGV", SINE) == pytest.approx(A * T / pi, rel=1e-4)
        assert value("PGD", SINE) == pytest.approx(A * T**2 / (2 * pi), rel=1e-4)
        assert value("PGV/PGA", SINE) == pytest.approx(T / pi, rel=1e-4)
        assert value("Arias", SINE) == pytest.approx(pi / (2 * G) * A * A * T / 2, rel=1e-4)

    @pytest.mark.parametrize("share", [0.01, 0.4, 0.999, 1.001])
    def test_uniform_duration(self, share):
        closed = T * (1 - 2 / pi * asin(share)) if share < 1 else 0.0
        structure = Reference(1.0, share * A / 9.0, 9.0)
        assert DU.value(SINE, structure) == pytest.approx(closed, abs=1e-4)
        t, a = fine(NOISE)
        level = share * np.abs(NOISE.acceleration).max()
        counted = (np.abs(a) >= level).mean() * t[-1]
        assert DU.value(NOISE, Reference(1.0, level / 9.0, 9.0)) == pytest.approx(counted, abs=1e-4)

    def test_uniform_duration_of_level_stretches(self):
        steps = GroundMotion("steps", 1.0, np.array([0.0, 2.0, 2.0, -2.0, -2.0, 0.0]), unit="m/s2")
        found = [DU.value(steps, Reference(1.0, level, 1.0)) for level in (1.0, 2.0, 2.5)]
        assert found == [pytest.approx(0.5 + 1 + 0.5 + 1 + 0.5), pytest.approx(2.0), 0.0]

    def test_relative_ones(self):
        ready = Structure(load_structure(EXAMPLES / "frame.yaml").model_copy(update={"gravity": 3.7}))
        both = equivalent_block(ready.mechanism)
        block = min((both.positive, both.negative), key=lambda each: each.lambda_)
        names = ("PGA/(g lambda)", "p PGV/(g lambda)", "PGV/v_imp")
        found = list(intensities(SINE, [parse_measure(name) for name in names], reference_of(ready)).values())
        pgv = A * T / pi
        expected = [A / (3.7 * block.lambda_), block.p * pgv / (3.7 * block.lambda_), pgv / block.v_imp]
        assert found == pytest.approx(expected, rel=1e-4)

    def test_relative_ones_need_a_structure(self):
        with pytest.raises(InputError, match="relative to what is shaken"):
            intensities(SINE, [parse_measure("Du")])

    def test_a_motion_that_is_none_has_no_duration(self):
        nothing = GroundMotion("nothing", 0.01, np.zeros(50), unit="m/s2")
        for name in ("D5-75", "D5-95", "Tm", "PGV/PGA"):
            assert np.isnan(value(name, nothing))
        for name in ("PGA", "CAV", "Arias", "SI", "Sa_avg(0.2:2)"):
            assert value(name, nothing) == 0


@pytest.mark.parametrize("measure", [each for each in all_measures() if each.power is not None], ids=str)
@pytest.mark.parametrize("factor", [0.2, 7.0])
def test_each_goes_with_its_power_of_the_factor(measure, factor):
    structure = Reference(2.0, 0.3, 9.8, 1.7)
    one, other = (intensities(motion, [measure], structure)[measure] for motion in (NOISE, NOISE.scaled(factor)))
    assert other == pytest.approx(factor**measure.power * one, rel=1e-9) and one > 0
    assert intensities(NOISE.scaled(-1), [measure], structure)[measure] == pytest.approx(one, rel=1e-12)


class TestNames:
    @pytest.mark.parametrize(
        ("text", "name"),
        [
            ("pga", "PGA"), (" P pgv / (G Lambda) ", "p PGV/(g lambda)"), ("sa(1)", "Sa(1.0)"),
            ("SA( 500 ms )", "Sa(0.5)"),
            ("Sa(1, 5%)", "Sa(1.0)"), ("Sa(1 s, 0.02)", "Sa(1.0, 2%)"), ("sa_AVG(.2:2)", "Sa_avg(0.2:2.0)"),
            ("Sa_avg(0.2, 2, 2.5 %)", "Sa_avg(0.2:2.0, 2.5%)"), ("d5-75", "D5-75"),
        ],
    )  # fmt: skip
    def test_any_case_spacing_and_unit(self, text, name):
        assert str(parse_measure(text)) == name
        assert parse_measure(name) == parse_measure(text)

    def test_a_name_is_read_as_itself(self):
        for each in all_measures():
            assert parse_measure(str(each)) == each

    @pytest.mark.parametrize(
        ("text", "said"),
        [
            ("Saa(1)", "did you mean Sa"), ("nonsense", "known: Arias, CAV"), ("", "unknown measure"),
            ("Sa(1", "unknown"),
            ("Sa", r"given as Sa\(PERIOD\[, DAMPING\]\), such as Sa\(0.3\)"), ("Sa(1, 2, 3)", "given as"),
            ("Sa(x)", "'x' is not a number"), ("Sa(1 kg)", "is a mass"), ("Sa(0)", "number of seconds"),
            ("Sa(1, 5)", "5 % is 0.05"), ("Sa(1e999)", "a finite number"), ("Sa_avg(2:1)", "shorter to a longer"),
            ("PGA(1)", "takes nothing in brackets"),
        ],
    )  # fmt: skip
    def test_what_is_wrong_is_said(self, text, said):
        with pytest.raises(InputError, match=said):
            parse_measure(text)

    def test_several_in_a_line(self):
        assert [str(each) for each in parse_measures("Sa(1, 2%), CAV,D5-75, cav")] == ["Sa(1.0, 2%)", "CAV", "D5-75"]
        assert parse_measures("all") == all_measures()

    def test_the_list_of_all_holds_each_name(self):
        known = IntensityMeasures()
        assert {each.name for each in all_measures()} == set(known)
        powers = {name: power_of(known[name]) for name in known}
        assert {name for name, power in powers.items() if power is None} == {"Du"}
        assert {name for name, power in powers.items() if power == 0} == {"D5-75", "D5-95", "Tm", "PGV/PGA"}


class TestPlugins:
    class Odd(MotionMeasure):
        name, title, power = "Odd", "odd", 1.0

        def of(self, motion):
            return self.answer

    @pytest.mark.parametrize(
        ("answer", "said"), [("three", "gave 'three': ValueError"), (-1.0, "gave -1"), (np.inf, "gave inf")]
    )
    def test_what_is_no_measure_is_blamed_on_it(self, answer, said, monkeypatch):
        monkeypatch.setattr(self.Odd, "answer", answer, raising=False)
        with pytest.raises(PluginError, match=f"the measure Odd {said}"):
            self.Odd().value(NOISE)

    def test_an_error_of_its_own_is_its_own(self):
        with pytest.raises(PluginError, match="the measure Odd failed in of: AttributeError"):
            self.Odd().value(NOISE)
