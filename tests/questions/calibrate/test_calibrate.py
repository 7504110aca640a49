"""Restitution from traces: against traces integrated here, and as a user runs the command."""

import json
from math import atan, cos, degrees, hypot, sqrt

import numpy as np
import pytest
import yaml
from click.testing import CliRunner

import rocking_cli as rk
from rocking_cli.ask.inputs import structure_of
from rocking_cli.cli.main import main
from rocking_cli.core import Direction
from rocking_cli.errors import InputError
from rocking_cli.io.yaml_file import with_fields
from rocking_cli.questions.calibrate.free_rocking import MechanismSide, ScaledSide, free_rocking
from rocking_cli.questions.calibrate.study import Trace, fit_trace, pool, read_trace
from rocking_cli.questions.calibrate.view import trace_view
from rocking_cli.structure import Structure
from tests.cli.test_cli import run
from tests.conftest import EXAMPLES
from validation.traces import simulate  # by Runge and Kutta

BLOCK = rk.Block(width=0.1, height=0.5)
ALPHA, P = atan(0.2), sqrt(3 * 9.80665 / (2 * hypot(0.1, 0.5)))
ETA, RELEASE, DT = 0.9323, 0.7 * ALPHA, 0.01


@pytest.fixture(scope="module")
def clean():
    """Seven impacts of the block, and their times."""
    return simulate(ALPHA, P, [ETA] * 8, RELEASE, 8)


def trace(angles, *, noise=0.01, drift=0.0, offset=0.0, held=30, seed=1, start=0.0):
    random = np.random.default_rng(seed)
    read = np.concatenate([np.full(held, angles[0]), angles])
    times = DT * np.arange(read.size)
    read = read + drift * ALPHA * times + offset * ALPHA + random.normal(0, noise * abs(angles[0]), read.size)
    return Trace("trace.csv", times + start, read)


def sides_of(structure):
    return {
        each: MechanismSide(structure.mechanism, each, side.reference)
        for each, side in zip(Direction, structure.statics, strict=True)
        if each in structure.mechanism.directions
    }


def write(folder, given, unit="deg", name="trace.csv"):
    factor = {"deg": degrees(1), "rad": 1.0}[unit]
    pairs = zip(given.times, given.angles, strict=True)
    rows = [f"{t:.9g},{'' if np.isnan(a) else f'{a * factor:.9g}'}" for t, a in pairs]
    (folder / name).write_text("\n".join([f"time [s],angle [{unit}]", *rows]) + "\n", encoding="utf-8")
    return folder / name


class TestFreeRocking:
    def test_a_block_is_that_of_runge_and_kutta(self, clean):
        angles, impacts = clean
        for sides in (
            {each: MechanismSide(BLOCK, each, ALPHA) for each in Direction},
            {each: ScaledSide(MechanismSide(BLOCK, each, ALPHA)) for each in Direction},
        ):
            motion = free_rocking(sides, RELEASE, ETA)
            assert motion.at(DT * np.arange(angles.size)) == pytest.approx(angles, abs=1e-6 * ALPHA)
            assert motion.impacts[:7] == pytest.approx(impacts, abs=1e-8)
            assert motion.at(np.array([-1.0, 1e3])) == pytest.approx([RELEASE, 0])
        other = free_rocking(sides, -RELEASE, np.array([ETA, 0.5]), until=1.0)
        assert other.peaks[1] == pytest.approx(motion.peaks[1])
        assert P**2 * (cos(ALPHA - other.peaks[2]) - cos(ALPHA)) == pytest.approx(
            (ETA * 0.5) ** 2 * P**2 * (cos(ALPHA - RELEASE) - cos(ALPHA))
        )

    @pytest.mark.parametrize("name", ["rigid_body.yaml", "walls/facade.yaml"])
    def test_any_structure_rocks_as_its_history_does(self, name):
        structure = Structure(rk.load_structure(EXAMPLES / name)).under(restitution=0.7)
        sides = sides_of(structure)
        first = structure.mechanism.directions[0]
        release = min(0.3 * sides[first].end, 0.05)
        answer = rk.respond(structure, release=f"{int(first) * release}rad", model="nonlinear", tail=3.0)
        run = answer.runs[1]["nonlinear"]
        rebounds = not structure.mechanism.rocks_both_ways
        motion = free_rocking(sides, int(first) * release, 0.7, rebounds=rebounds)
        assert run.impacts.size > 3
        assert run.phi == pytest.approx(motion.at(run.time), abs=2e-5 * sides[first].end)


class TestFit:
    @pytest.mark.rest
    def test_the_bars_of_accuracy_are_met(self, clean):
        """Bias below .0002 and deviation below .0003; validation/traces.py has 200 traces."""
        found = [fit_trace(Structure(BLOCK), trace(clean[0], drift=0.01, seed=k)).eta for k in range(4)]
        values = np.array([each.value for each in found])
        assert abs(values.mean() - ETA) < 0.0002 and values.std(ddof=1) < 0.0003

    def test_what_else_a_trace_shows(self, clean):
        found = fit_trace(Structure(BLOCK), trace(clean[0], drift=0.01, offset=0.03, start=5.0))
        said = trace_view(found, Structure(BLOCK)).parts
        assert f"eta = {found.eta.value:.4f}" in said[0] and "7 impacts are seen" in said[1]
        assert len(found.etas) == 7 and found.pooled.seen < 0.005 < found.scatter
        assert found.impacts == pytest.approx(np.array(clean[1]) + 5.3, abs=0.005)
        assert (found.release_time, found.release) == pytest.approx((5.3, RELEASE), abs=0.004)
        for fitted, true in ((found.drift, 0.01 * ALPHA), (found.offset, (0.03 - 0.05) * ALPHA)):  # at time zero
            assert fitted.deviation < 0.04 * ALPHA and fitted.value == pytest.approx(true, abs=3 * fitted.deviation)
        assert found.noise == pytest.approx(0.01 * RELEASE, rel=0.15)
        assert 0.8 < found.residual / found.noise < 1.3

    @pytest.mark.every(3)
    @pytest.mark.parametrize(("before", "lift", "held", "impacts"), [(1, 2, 0, 7), (3, 10, 20, 7), (1, 0.2, 0, 60)])
    def test_lifting_holding_and_rest_are_no_rocking(self, before, lift, held, impacts):
        """As laboratories record it; with 60 impacts, it comes to rest and stays so for 3 s."""
        angles, times = simulate(ALPHA, P, [ETA] * 61, RELEASE, impacts + 1)
        parts = [np.zeros(round(before / DT)), RELEASE * np.sin(np.linspace(0, np.pi / 2, round(lift / DT))) ** 2]
        parts += [np.full(round(held / DT), RELEASE), angles, np.zeros(300 if impacts == 60 else 0)]
        given = trace(np.concatenate(parts), held=0, noise=0, drift=0.01, offset=0.03)
        noise = np.random.default_rng(3).normal(0, 0.01 * RELEASE, given.times.size)
        found = fit_trace(Structure(BLOCK), Trace("t", given.times, given.angles + noise))
        assert found.eta.value == pytest.approx(ETA, abs=6e-4)
        assert abs(found.eta.value - ETA) < 2 * found.eta.deviation < 0.08
        assert (len(found.etas), found.patterned, found.sides) == (min(impacts, 15), False, None)
        let_go = before + lift + held
        assert found.part[0] == pytest.approx(let_go + 0.1 * times[0], abs=0.05)
        assert found.impacts[:3] == pytest.approx(let_go + np.array(times[:3]), abs=0.01)

    @pytest.mark.rest
    def test_of_two_tests_the_larger_is_fitted(self):
        angles, times = simulate(ALPHA, P, [ETA] * 61, RELEASE, 60)
        small, _ = simulate(ALPHA, P, [ETA] * 61, 0.5 * RELEASE, 60)
        given = trace(np.concatenate([small, np.full(100, 0.0), np.full(30, angles[0]), angles]), held=0)
        found = fit_trace(Structure(BLOCK), given)
        assert found.impacts[:3] == pytest.approx((small.size + 130) * DT + np.array(times[:3]), abs=0.01)

    @pytest.mark.rest
    def test_a_wrong_p_leaves_a_pattern_and_is_within_the_deviation(self, clean):
        size = 1.03**2
        near = rk.Block(width=0.1 * size, height=0.5 * size)
        found = fit_trace(Structure(near), trace(clean[0]))
        assert 0.002 < abs(found.eta.value - ETA) < 2 * found.eta.deviation and found.patterned
        assert "Caution: the residual leaves a pattern" in trace_view(found, Structure(near)).parts[-1]
        sure = rk.Block(width=0.1, height=0.5, uncertainty={"slenderness": 0.0})
        sharp, usual = (fit_trace(Structure(each), trace(clean[0])) for each in (sure, BLOCK))
        part = np.sqrt(usual.eta.deviation**2 - sharp.eta.deviation**2)  # of 10 % of slenderness, 3.5 % of p
        assert part == pytest.approx(0.0033 * 3.5 / 3, rel=0.8)

    @pytest.mark.rest
    def test_sides_that_differ_are_no_scatter(self):
        """One side of 5 % more alpha; the rates go on, as the inertia of both is the same."""
        motion = free_rocking(
            {each: ScaledSide(MechanismSide(BLOCK, each, ALPHA), alpha=1.025 ** int(each)) for each in Direction},
            RELEASE, ETA,
        )  # fmt: skip
        given = trace(motion.at(np.arange(0, motion.impacts[7], DT)))
        found = fit_trace(Structure(BLOCK), given)
        assert found.sides.value == pytest.approx(1.025**2, abs=4 * found.sides.deviation)
        assert found.pooled.seen < 0.003 and found.eta.value == pytest.approx(ETA, abs=5e-4)
        assert "The two sides differ" in trace_view(found, Structure(BLOCK)).parts[4]

    @pytest.mark.every(3)
    @pytest.mark.parametrize("way", ["reversed", "gaps", "late"])
    def test_any_sense_sampling_and_gaps(self, clean, way):
        given = trace(clean[0], noise=0.002)
        kept = np.random.default_rng(2).random(given.times.size) < 0.9  # uneven
        if way == "reversed":
            given = Trace("t", given.times, -given.angles)
        elif way == "gaps":
            kept = ~((np.abs(given.times - 1.2) < 0.12) | (np.abs(given.times - 2.2) < 0.2))
        else:  # it begins while the block rises to its second peak
            kept = given.times > clean[1][0] + 0.3 + 0.05
        found = fit_trace(Structure(BLOCK), Trace("t", given.times[kept], given.angles[kept]))
        assert found.eta.value == pytest.approx(ETA, abs=5e-4)
        assert len(found.etas) == 7 - (way == "late")

    def test_scatter_is_that_of_the_impacts(self):
        etas = [0.93, 0.96, 0.92, 0.95, 0.9, 0.94, 0.93, 0.9]
        found = fit_trace(Structure(BLOCK), trace(simulate(ALPHA, P, etas, RELEASE, 8)[0], noise=0.001))
        assert [each.value for each in found.etas[:6]] == pytest.approx(etas[:6], abs=0.004)
        assert found.pooled.seen == pytest.approx(np.std(etas[:6], ddof=1), rel=0.1)
        assert found.residual > 3 * found.own_residual
        assert "it differs from impact to impact" in trace_view(found, Structure(BLOCK)).parts[-1]

    def test_scatter_is_free_of_noise(self):
        """The variance beyond that of the errors: with equal errors, the difference of the two."""
        values = np.array([0.9, 0.94, 0.92, 0.95, 0.93])
        found = pool(values, 0.01**2 * np.eye(5), 0.03)
        assert found.seen**2 == pytest.approx(np.var(values, ddof=1) - 0.01**2, rel=0.05)  # to the grid
        assert found.mean == pytest.approx(values.mean()) and found.weights == pytest.approx(np.full(5, 0.2))
        assert pool(values, 0.05**2 * np.eye(5), 0.03).seen == 0

    def test_scatter_is_drawn_towards_that_of_other_bodies(self):
        """With exact etas, (.03^2 + sum of squares)/(1 + n - 1); without information, .03; never 0."""
        values = np.array([0.9, 0.94, 0.92, 0.95, 0.93])
        exact = pool(values, 1e-12 * np.eye(5), 0.03)
        assert exact.scatter == pytest.approx(np.sqrt((0.03**2 + 4 * np.var(values, ddof=1)) / 5), rel=1e-3)
        low, high = exact.interval  # by the likelihood; by chi square .0126 to .0459
        assert (low, high) == (pytest.approx(0.0126, rel=0.1), pytest.approx(0.0459, rel=0.15))
        assert pool(values, np.eye(5), 0.03).scatter == pytest.approx(0.03, rel=0.05)
        none = pool(np.full(7, 0.93), 1e-8 * np.eye(7), 0.03)
        assert none.scatter == pytest.approx(0.03 / np.sqrt(7), rel=0.02) and none.interval[0] == none.seen == 0

    @pytest.mark.rest
    def test_p_and_alpha_may_be_free(self, clean):
        near = rk.Block(width=0.103, height=0.49)  # what somebody measured
        found = [fit_trace(Structure(near), trace(clean[0], seed=k), free_geometry=True) for k in range(2)]
        assert np.mean([each.p.value for each in found]) == pytest.approx(P, rel=0.01)
        assert np.mean([each.alpha.value for each in found]) == pytest.approx(ALPHA, rel=0.01)
        assert abs(found[0].p.value / P - 1) < 4 * found[0].p.deviation / P

    @pytest.mark.rest
    def test_both_directions_of_a_leaning_stone(self):
        structure = Structure(rk.load_structure(EXAMPLES / "rigid_body.yaml"))
        sides = sides_of(structure)
        first = sides[Direction.NEGATIVE]
        motion = free_rocking(sides, -0.6 * first.end, 0.85)
        times = np.arange(0, motion.impacts[5], 0.02)
        noise = np.random.default_rng(4).normal(0, 0.003 * first.end, times.size)
        found = fit_trace(structure, Trace("t", times, noise - motion.at(times)))  # the trace has a sense of its own
        assert found.eta.value == pytest.approx(0.85, abs=0.002)


class TestRefusals:
    def refused(self, given, structure=BLOCK, **how):
        with pytest.raises(InputError) as caught:
            fit_trace(Structure(structure), given, **how)
        return str(caught.value)

    def test_fewer_than_three_impacts_and_noise_above_the_motion(self, clean):
        short = clean[0][: int((clean[1][2] - 0.02) / DT)]  # to before the third
        assert "2 impacts can be seen above the noise, and a fit needs 3" in self.refused(trace(short))
        assert "there is no motion to fit" in self.refused(trace(clean[0], noise=0.6))

    def test_numbers_that_no_instrument_writes(self, clean):
        times, angles = DT * np.arange(len(clean[0])), clean[0]
        assert "the angle is the same in all samples" in self.refused(Trace("t", times, np.full(times.size, 0.1)))
        assert "check the unit of the angles" in self.refused(Trace("t", times, 1e-300 * angles))
        assert "check the unit of the times" in self.refused(Trace("t", 1e200 * times, angles))
        some = np.where(times == 1.0, np.nan, angles)
        assert "must be finite numbers" in self.refused(Trace("t", times, some))
        assert "and times increase" in self.refused(Trace("t", times[::-1], angles))
        assert "at least 30 samples, got 10" in self.refused(Trace("t", times[:10], angles[:10]))

    @pytest.mark.rest
    def test_a_block_of_another_size(self, clean):
        first = clean[0][: int(clean[1][3] / DT)]  # three impacts
        said = self.refused(trace(first), rk.Block(width=0.2, height=1.0))
        assert "not free rocking of this structure" in said
        assert float(said.split("; p = ")[1].split()[0]) == pytest.approx(P, rel=0.1)

    def test_a_structure_that_is_lifted_and_lowered(self):
        angles = 0.5 * ALPHA * np.interp(DT * np.arange(900), [0, 1, 3, 6, 8], [0, 0, 1, 1, 0])
        assert "can be seen above the noise, and a fit needs 3" in self.refused(trace(angles, held=0))

    def test_angles_beyond_overturning(self, clean):
        given = trace(clean[0])
        said = self.refused(Trace("t", given.times, np.degrees(given.angles)))
        assert "more than twice the rotation at which the structure overturns" in said and "check the unit" in said

    def test_free_geometry_of_a_slender_block_and_of_no_block(self, clean):
        slender = rk.Block(width=0.03, height=0.5)
        assert "a trace does not tell p and alpha apart" in self.refused(trace(clean[0]), slender, free_geometry=True)
        frame = rk.load_structure(EXAMPLES / "frame.yaml")
        assert "of a free-standing block" in self.refused(trace(clean[0]), frame, free_geometry=True)

    @pytest.mark.parametrize(
        ("text", "said"),
        [
            ("time [s],angle\n0,1\n", "t.csv:1: angle: its unit must be one of rad, deg"),
            ("time [s],force [N]\n0,1\n", "one column must be the angle, none of 2 is"),
            ("time [s],angle [deg],rotation [deg]\n0,1,1\n", "one column must be the angle, 2 of 3 is"),
            ("time [s],angle [deg]\n0,1\n1,x\n1.5,y\n", "t.csv:4: angle [deg]: 'y' is not a number"),
            ("time [s],angle [deg]\n0,1\n1,2\n0.5,2\n", "t.csv:4: time [s] must be later than the row before, 1 s"),
        ],
    )
    def test_wrong_files(self, tmp_path, text, said):
        (tmp_path / "t.csv").write_text(text, encoding="utf-8")
        assert said in run("calibrate", EXAMPLES / "block.yaml", "--free", tmp_path / "t.csv", code=2).stderr


class TestCommand:
    @pytest.fixture
    def folder(self, tmp_path, clean):
        write(tmp_path, trace(clean[0], drift=0.01))
        (tmp_path / "block.yaml").write_text(
            "# of a museum\nmechanism: block\nwidth: 0.1  # m\nuncertainty: {slenderness: 0.03}\nheight: 0.5\n"
        )
        return tmp_path

    def test_of_a_trace_from_standard_input(self, folder):
        new, plot = folder / "new.yaml", folder / "fit.png"
        words = ["calibrate", folder / "block.yaml", "--free", "-", "-o", new, "--plot", plot, "--json"]
        text = (folder / "trace.csv").read_text(encoding="utf-8")
        data = json.loads(CliRunner().invoke(main, list(map(str, words)), input=text).stdout)
        eta = data["restitution"]
        assert eta["value"] == pytest.approx(ETA, abs=5e-4) and 2e-3 < eta["deviation"] < 0.01
        assert data["impacts"] == len(data["etas"]) == len(data["impact_times"]) == 7 and data["geometry"] is None
        assert plot.read_bytes().startswith(b"\x89PNG")
        written = new.read_text(encoding="utf-8")
        assert "# of a museum" in written and ", 7 impacts" in written
        fields = yaml.safe_load(written)
        assert fields["restitution"] == pytest.approx(eta["value"], abs=5e-5)
        assert fields["uncertainty"] == {"slenderness": 0.03, "restitution": pytest.approx(eta["scatter"], abs=5e-5)}
        assert fields["width"] == 0.1 and rk.load_structure(new).restitution == fields["restitution"]

    @pytest.mark.rest
    def test_a_fitted_geometry_is_written_with_its_eta(self, folder):
        near, new = folder / "near.yaml", folder / "new.yaml"
        near.write_text("mechanism: block\nwidth: 0.103\nheight: 0.49  # m\nfriction: 0.6\n", encoding="utf-8")
        found = rk.calibrate(near, free=folder / "trace.csv", free_geometry=True, out=new)
        block = Structure(rk.load_structure(new))
        assert block.mechanism.restitution == pytest.approx(found.eta.value, abs=5e-5)
        assert block.p == pytest.approx(found.p.value, rel=1e-4)
        assert block.equivalence.positive.phi_cr == pytest.approx(found.alpha.value, rel=1e-4)
        assert found.p.value == pytest.approx(P, rel=0.02) and block.mechanism.friction == 0.6
        assert found.eta.value == pytest.approx(ETA, abs=3 * found.eta.deviation)
        assert found.to_dict()["release"] == pytest.approx(RELEASE, rel=0.02)

    @pytest.mark.parametrize("headings", ["time,angle_deg", "t (s),theta (deg)", "Time [s];Rotation [deg]"])
    def test_headings_as_people_write_them(self, folder, clean, headings):
        lines = (folder / "trace.csv").read_text(encoding="utf-8").splitlines()[1:]
        lines = [line.replace(",", ";") if ";" in headings else line for line in lines]
        (folder / "other.csv").write_text("\n".join([headings, *lines]), encoding="utf-8")
        write(folder, trace(clean[0], drift=0.01), "rad", "rad.csv")
        one, *others = (read_trace(folder / name) for name in ("trace.csv", "other.csv", "rad.csv"))
        for other in others:
            assert one.angles == pytest.approx(other.angles) and one.times == pytest.approx(other.times)

    def test_a_file_is_never_overwritten_by_its_copy(self, folder):
        block = folder / "block.yaml"
        before = block.read_text(encoding="utf-8")
        for given in (block, structure_of(block)):
            with pytest.raises(InputError, match="would overwrite an input file"):
                rk.calibrate(given, free=folder / "trace.csv", out=block)
        assert block.read_text(encoding="utf-8") == before
        with pytest.raises(InputError, match="needs the file"):
            rk.calibrate(BLOCK, free=folder / "trace.csv", out=folder / "new.yaml")

    def test_a_restitution_above_its_bound_is_refused(self, folder):
        """With the trace of a larger angle scale, energy would grow."""
        angles, _ = simulate(ALPHA, P, [1.02] * 8, 0.3 * ALPHA, 6)
        grows = write(folder, trace(angles, noise=0.002), name="grows.csv")
        assert "restitution" in run("calibrate", folder / "block.yaml", "--free", grows, code=2).stderr


def test_a_copy_keeps_all_but_the_fields():
    old = "restitution:  # old\n  positive_to_negative: .9\n  negative_to_positive: .8  # x\n"
    text = f"a: 1 # one\n{old}# kept\nb: [1,\n 2]"
    assert with_fields(text, {"restitution": "0.7  # new", "c": "3", "b": "4"}, "f") == (
        "a: 1 # one\nrestitution: 0.7  # new\n# kept\nb: 4\nc: 3\n"
    )
    assert with_fields("a: 1\r\nb: 2\r\n", {"a": "3"}, "f") == "a: 3\r\nb: 2\r\n"
    with pytest.raises(InputError, match="in braces"):
        with_fields("{a: 1}", {"a": "2"}, "f")
