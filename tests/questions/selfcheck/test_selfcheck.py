"""`rocking selfcheck`: every check fails if what it checks is wrong, and whatever is broken becomes a row."""

import json
import pickle
import re
import shutil
import sys
from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from click.testing import CliRunner

import rocking_cli as rk
from rocking_cli.cli.main import main
from rocking_cli.dynamics import shipped, stepping, ways
from rocking_cli.dynamics.calling import SETS
from rocking_cli.errors import KernelWarning
from rocking_cli.excitation.records.formats import Readers
from rocking_cli.questions.selfcheck import checks
from rocking_cli.questions.selfcheck import study as run
from rocking_cli.questions.selfcheck.checks import different_values, largest_difference
from rocking_cli.questions.selfcheck.study import Check, NotRun
from rocking_cli.units import KINDS, UNITS

CHECKS = {each.name: each for each in run.CHECKS}


def checked(name, *, quick=True):
    return CHECKS[name].run(quick=quick)


def asked(*arguments):
    return CliRunner().invoke(main, ["selfcheck", *arguments], env={"COLUMNS": "200"})


def changed(monkeypatch, name, how):
    """Replace values of other programs, or a part of them."""
    monkeypatch.setitem(checks.EXPECTED, name, how(checks.EXPECTED[name]))


def scaled(value, factor):
    """Values of which each number is larger by a factor."""
    return [each * factor for each in value]


def few(monkeypatch, **found):
    """Replace the checks by some whose deviation is a number, or an error to raise."""

    def deviation(name, quick):
        if isinstance(found[name], Exception):
            raise found[name]
        return found[name]

    monkeypatch.setattr(run, "CHECKS", tuple(Check(name, f"meaning of {name}", "s", 1e-9) for name in found))
    monkeypatch.setattr(run, "deviation", deviation)


def rougher(made):
    """Return a maker of structures whose friction, if they have any, is larger by 1 in 1000."""
    return lambda *name, **fields: made(*name, **{k: v * (1.001 if k == "friction" else 1) for k, v in fields.items()})


def heavier(made):
    """Return a maker of structures under another gravity."""
    return lambda *name, **fields: made(*name, **fields, gravity=9.80666)


COUNTED = ("neighbours", "openings")
"""Checks whose limits are not those of rounding: shares of 200 neighbours, and a time known to a step."""


class TestEachCheck:
    @pytest.mark.every(4)
    @pytest.mark.parametrize("name", CHECKS)
    def test_it_passes_far_below_its_limit(self, name):
        found = checked(name, quick=False)
        if name != "records_by_obspy" or found.passed is not None:
            assert found.passed and found.why is None
            assert found.found <= CHECKS[name].limit / (1 if name in COUNTED else 4)

    @pytest.mark.parametrize("how", [{"eta": (1 - 1.5 / 17) * (1 + 1e-9)}, {"most_kept": 7}])
    def test_release_fails_if_the_histories_are_wrong_or_end_early(self, monkeypatch, how):
        monkeypatch.setattr(checks, "follow", partial(checks.follow, **how))
        found = checked("release")
        assert found.passed is False
        assert (found.why == "values are missing, or are not numbers") == ("most_kept" in how)

    def test_pulses_fail_if_the_motion_is_wrong(self, monkeypatch):
        exact = checks.exact_many
        monkeypatch.setattr(checks, "exact_many", lambda *a, **k: exact(*a, **{**k, "gravity": 9.80665000001}))
        assert checked("pulses").passed is False

    @pytest.mark.parametrize("model", ["nonlinear", "linear2", "linear1"])
    def test_histories_fail_if_they_are_wrong(self, monkeypatch, model):
        follow = checks.follow

        def stronger(of, motion):
            more = replace(motion, acceleration=motion.acceleration * (1 + 1e-8))
            return follow(of, more if of.name == model else motion)

        monkeypatch.setattr(checks, "follow", stronger)
        assert checked("histories", quick=model != "linear1").passed is False

    @pytest.mark.parametrize(
        ("check", "name", "how"),
        [
            ("blocks", "made", heavier),
            ("openings", "made", lambda made: lambda *name, **f: replace(made(*name, **f), opening=0.0052)),
            ("openings", "made", rougher),
            ("filters", "process", lambda process: lambda motion, steps: motion),
            ("filters", "parse_step", lambda parse: lambda kind, corner: parse(kind, f"{float(corner) * 1.00001}")),
        ],
    )
    def test_others_fail_if_what_they_check_is_a_little_wrong(self, monkeypatch, check, name, how):
        monkeypatch.setattr(checks, name, how(getattr(checks, name)))
        found = checked(check)
        assert found.passed is False and np.isfinite(found.found)

    @pytest.mark.parametrize(
        ("check", "how"),
        [
            ("pulses", lambda cases: [[eta, [scaled(row, 1 + 2e-12) for row in rows]] for eta, rows in cases]),
            ("blocks", lambda cases: [*cases[:-1], [*cases[-1][:2], cases[-1][2] | {"kappa1": 0.2804046}]]),
            ("neighbours", lambda shares: scaled(shares, 1.01)),
            ("openings", lambda times: [times[0], times[1] * 1.003]),
        ],
    )
    def test_a_little_is_seen_of_a_formula_too(self, monkeypatch, check, how):
        changed(monkeypatch, check, how)
        found = checked(check)
        assert found.passed is False and np.isfinite(found.found)

    @pytest.mark.parametrize(
        ("check", "place", "value"),
        [
            ("release", "rocking_cli.dynamics.tables.MAX_CELLS", 16),
            ("joints", "rocking_cli.dynamics.joints.MAX_CELLS", 16),
            ("filters", "rocking_cli.processing.steps.FILTER_ORDER", 3),
            ("neighbours", "rocking_cli.dynamics.model.SLENDERNESS_SPREAD", 0.11),
            ("neighbours", "rocking_cli.dynamics.model.KINEMATIC_SPREAD", 0.06),
        ],
    )
    def test_they_fail_if_a_constant_of_the_code_is_another(self, monkeypatch, check, place, value):
        monkeypatch.setattr(place, value)
        assert checked(check).passed is False

    def test_units_fail_if_one_is_wrong_or_unknown(self, monkeypatch):
        sizes = checks.EXPECTED["units"]
        for kind, known in sizes.items():
            (*_, unit) = known
            monkeypatch.setitem(sizes, kind, known | {unit: known[unit] * (1 + 1e-14)})
            assert 1e-15 < checked("units").found < 2e-14
            monkeypatch.setitem(sizes, kind, known | {"ell": 1.143})
            assert checked("units").passed is False
            monkeypatch.setitem(sizes, kind, known)

    def test_a_file_of_each_format_of_this_package(self):
        readers = Readers()
        own = {name for name in readers if readers.package_of(name).startswith("rocking-cli ")}
        assert {*checks.EXPECTED["records"], *checks.EXPECTED["records_by_obspy"]} == own
        assert sum(checks.SAMPLES) == 0
        assert set(checks.EXPECTED["units"]["acceleration"]) == set(UNITS)

    @pytest.mark.every(3)
    @pytest.mark.parametrize("unit", checks.EXPECTED["units"]["acceleration"])
    def test_records_fail_if_a_unit_is_wrong(self, monkeypatch, unit):
        monkeypatch.setitem(KINDS["acceleration"], unit, str(1.02 * UNITS[unit]))
        monkeypatch.setitem(UNITS, unit, UNITS[unit] * 1.02)
        assert checked("records").passed is False

    @pytest.mark.every(8)
    @pytest.mark.parametrize("name", checks.EXPECTED["records"])
    def test_records_fail_if_a_sample_of_one_format_is_wrong(self, monkeypatch, name):
        files = checks.EXPECTED["records"]
        title, unit, options = files[name]
        monkeypatch.setitem(files, name, [title, unit * (1 + 1e-11), options])
        found = checked("records")
        assert found.passed is False and 1e-12 < found.found < 2e-11

    def test_records_name_all_formats_that_are_not_read(self, monkeypatch, tmp_path):
        shutil.copytree(checks.FOLDER / "records", tmp_path / "records")
        (tmp_path / "records" / "esm").write_text("nothing")
        shutil.copy(tmp_path / "records" / "knet", tmp_path / "records" / "smc")
        monkeypatch.setattr(checks, "FOLDER", tmp_path)
        found = checked("records")
        assert found.passed is False
        assert re.match(r"esm: .*: not a record format that can be read: [^;]*; smc: ", found.why)
        assert "smc: read as K-NET/KiK-net with an interval of 0.01 s" in found.why

    def test_records_by_obspy_fail_and_are_not_run_without_it(self, monkeypatch):
        pytest.importorskip("obspy")
        with monkeypatch.context() as patch:
            patch.setitem(checks.EXPECTED["records_by_obspy"], "sac", ["SAC", 0.01, {"units": "g"}])
            assert checked("records_by_obspy").passed is False
        monkeypatch.setattr(checks, "find_spec", lambda name: None)
        found = checked("records_by_obspy")
        assert found.passed is None and found.found is None and "pip install" in found.why

    @pytest.mark.parametrize("name", ["respond_many", "exact_many"])
    def test_threads_fail_if_one_bit_differs(self, monkeypatch, name):
        compute = getattr(checks, name)

        def by_another(*arguments, **named):
            found = compute(*arguments, **named)
            if named["threads"] > 1:
                found.peak_positive[-1] = np.nextafter(found.peak_positive[-1], 9.0)
            return found

        monkeypatch.setattr(checks, name, by_another)
        found = checked("threads")
        assert found.passed is False and found.found == 1

    @pytest.mark.every(3)
    @pytest.mark.parametrize("name", SETS)
    def test_kernels_fail_if_one_value_of_a_set_differs(self, monkeypatch, name):
        python = ways.in_python

        def spoilt(of):
            run = python(of)

            def kernel(*arguments):
                run(*arguments)
                if of.name == name:
                    row = arguments[6][0, -1:] if name == "pulses" else arguments[8][0, stepping.PEAK :][:1]
                    row[:] = np.nextafter(row, 9.0)

            return kernel

        if name in ("lanes", "steps"):  # which Python has not
            shipped_way = ways.as_shipped

            def spoilt(of, level="v1"):
                run = shipped_way(of, level)

                def kernel(*arguments):
                    run(*arguments)
                    row = arguments[10][0, stepping.PEAK :][:1]
                    row[:] = np.nextafter(row, 9.0)

                def coarser(rows, pairs, rtol):
                    return run(rows, 1, rtol)

                return run if of.name != name else coarser if of.lanes else kernel

        monkeypatch.setattr(ways, "as_shipped" if name in ("lanes", "steps") else "in_python", spoilt)
        ways.forget()
        found = checked("kernels")
        ways.forget()
        assert found.passed is False and found.found >= 1

    @pytest.mark.parametrize(
        ("spoil", "passed", "why"),
        [
            (lambda: shipped.place().write_bytes(b"damaged"), False, "is damaged, reinstall rocking-cli"),
            (lambda: None, None, "no kernels are shipped for"),
        ],
    )
    def test_kernels_that_are_broken_fail_and_those_of_no_system_are_not_run(
        self, spoil, passed, why, monkeypatch, tmp_path
    ):
        folder = tmp_path / "ready"
        shutil.copytree(shipped.READY_FOLDER, folder)
        monkeypatch.setattr(shipped, "READY_FOLDER", folder)
        spoil()
        if passed is None:
            monkeypatch.setattr(shipped.platform, "machine", lambda: "abacus")
        ways.forget()
        found = checked("kernels")
        monkeypatch.undo()
        ways.forget()
        assert found.passed is passed and why in found.why

    def test_python_does_not_compute_instead_of_a_library_that_is_broken(self, monkeypatch, tmp_path):
        folder = tmp_path / "ready"
        shutil.copytree(shipped.READY_FOLDER, folder)
        monkeypatch.setattr(shipped, "READY_FOLDER", folder)
        shipped.place().unlink()
        ways.forget()
        done = asked("--quick", "--json")
        checks = json.loads(done.stdout)["checks"]
        monkeypatch.undo()
        ways.forget()
        assert done.exit_code == 4
        assert [each["check"] for each in checks if each["passed"] is False] == ["kernels"]
        assert {each["check"] for each in checks if each["passed"]} <= set(run.NO_KERNEL)
        left_out = [each for each in checks if each["passed"] is None and "obspy" not in each["check"]]
        assert len(left_out) == 6 and all("the machine code is broken" in each["why"] for each in left_out)


class TestCommand:
    def test_all_pass(self, monkeypatch):
        few(monkeypatch, one=1e-12, two=1e-9)
        done = asked()
        assert done.exit_code == 0
        assert "All 2 checks passed in " in done.stdout and done.stdout.count("passed") == 3

    def test_one_that_fails_gives_exit_code_4_and_says_what_to_do(self, monkeypatch):
        few(monkeypatch, one=1e-12, two=2e-9, three=ValueError("no such thing"), four=float("nan"))
        done = asked()
        assert done.exit_code == 4
        assert "two failed: the deviation exceeds the limit." in done.stdout
        assert "three failed: ValueError: no such thing." in done.stdout
        assert "four failed: values are missing, or are not numbers." in done.stdout
        assert "3 of 4 checks failed: do not rely on" in done.stdout and "`rocking info`" in done.stdout
        assert "Traceback" not in done.output

    def test_one_that_is_not_run_is_no_failure_and_has_not_passed(self, monkeypatch):
        few(monkeypatch, one=1e-12, two=NotRun("there is none"))
        done = asked()
        assert done.exit_code == 0
        assert "two not run: there is none." in done.stdout
        assert "1 of 2 checks passed in" in done.stdout and "1 could not be run" in done.stdout

    def test_json_has_the_same(self, monkeypatch):
        few(monkeypatch, one=1e-12, two=NotRun("there is none"), three=MemoryError())
        done = asked("--quick", "--json")
        found = json.loads(done.stdout)
        assert done.exit_code == 4 and found["passed"] is False and found["quick"] is True
        first = found["checks"][0]
        assert first.pop("seconds") >= 0 and first == {
            "check": "one", "meaning": "meaning of one", "unit": "s", "found": 1e-12, "limit": 1e-9, "passed": True,
            "why": None,
        }  # fmt: skip
        assert [each["passed"] for each in found["checks"]] == [True, None, False]
        assert [each["why"] for each in found["checks"]] == [None, "there is none", "MemoryError"]

    @pytest.mark.rest
    def test_quick_runs_all_checks(self):
        done = asked("--quick", "--json")
        found = json.loads(done.stdout)
        assert done.exit_code == 0, done.stdout
        assert found["quick"] and [each["check"] for each in found["checks"]] == list(CHECKS)
        assert [each.name for each in pickle.loads(pickle.dumps(run.CHECKS))] == list(CHECKS)


class TestHostilePlaces:
    def test_with_a_module_that_cannot_be_imported(self, monkeypatch):
        monkeypatch.setitem(sys.modules, "rocking_cli.questions.selfcheck.checks", None)
        for name in CHECKS:
            found = checked(name)
            assert found.passed is False and found.why.startswith("ModuleNotFoundError: ")

    def test_without_ctypes(self, monkeypatch):
        ways.forget()
        monkeypatch.delattr("rocking_cli.dynamics.shipped")
        monkeypatch.setitem(sys.modules, "rocking_cli.dynamics.shipped", None)
        assert checked("kernels").passed is None
        with pytest.warns(KernelWarning):
            assert checked("openings").passed
        monkeypatch.undo()
        ways.forget()

    @pytest.mark.rest
    def test_with_a_kernel_that_is_none(self, monkeypatch):
        monkeypatch.setenv(ways.KERNELS_VARIABLE, "fast")
        ways.forget()
        found = rk.selfcheck(quick=True)
        monkeypatch.undo()
        ways.forget()
        assert {each.check.name for each in found.failed} >= {"release", "pulses", "histories", "threads"}
        assert all("ROCKING_KERNELS is 'fast'" in each.why for each in found.failed)


class TestAnswer:
    def test_it_is_the_json_of_the_command(self, monkeypatch):
        few(monkeypatch, one=1e-12, two=NotRun("there is none"))
        answer = rk.selfcheck()
        assert answer.passed and not answer.failed and [each.check.name for each in answer.not_run] == ["two"]
        assert [each["check"] for each in answer.to_dict()["checks"]] == ["one", "two"]
        assert answer.columns()["why"] == ["", "there is none"]
        assert pickle.loads(pickle.dumps(answer)).to_dict() == answer.to_dict()
        with pytest.raises(rk.InputError, match="have no plot"):
            answer.plot()

    def test_reasons_are_said_once(self, monkeypatch):
        few(monkeypatch, one=ZeroDivisionError("by zero"), two=ZeroDivisionError("by zero"))
        assert "one, two failed: ZeroDivisionError: by zero." in rk.selfcheck().view.parts


class TestComparing:
    @pytest.mark.parametrize(
        ("found", "expected", "largest"),
        [
            ([1.0, 2.0], [1.0, 2.5], 0.5),
            ([], [], 0.0),
            ([1.0], [1.0, 2.0], np.inf),
            ([np.nan], [1.0], np.inf),
            ([1.0], [np.nan], np.inf),
        ],
    )
    def test_the_largest_difference(self, found, expected, largest):
        assert largest_difference(found, expected) == largest

    def test_bits(self):
        one = np.array([0.0, 1.0, np.nan, 2.0])
        assert different_values(one, np.array([-0.0, 1.0, -np.nan, np.nan])) == 2
        assert different_values(np.array([True, False]), np.array([True, True])) == 1
        assert different_values(np.array([1, 2]), np.array([1, 3])) == 1
