from __future__ import annotations

import runpy
import time as clock
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.base import STANDARD_GRAVITY, GroundMotion
from rocking_cli.excitation.records import peer, read_record, text
from rocking_cli.excitation.records.units import canonical, header_units
from tests.conftest import NEEDS_RECORDS, record

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"
G = STANDARD_GRAVITY

UNTIMED = settings(deadline=None)  # they write files: a slow disk is no failure


@pytest.fixture
def write(tmp_path):
    """Write a file and return its path; text with exactly the newlines given."""

    def write(content: str | bytes, name: str = "record.txt") -> Path:
        path = tmp_path / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    return write


def problems(path: Path, **options) -> tuple[Problem, ...]:
    """What `read_record` finds wrong."""
    with pytest.raises(InputError) as caught:
        read_record(path, **options)
    return caught.value.problems


def problem(path: Path, **options) -> Problem:
    """The one thing `read_record` finds wrong, which must name the file as it was given."""
    (found,) = problems(path, **options)
    assert found.file == str(path)
    return found


def accelerations(motion: GroundMotion) -> list[float]:
    return motion.acceleration.tolist()


# --- delimited text: what is read -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "rows",
    [
        "0.00,0.1\n0.01,-0.2\n0.02,0.3\n",
        "0.00, 0.1\n0.01, -0.2\n0.02, 0.3\n",
        "0.00 , 0.1\n0.01 , -0.2\n0.02 , 0.3",
        "0.00;0.1\n0.01;-0.2\n0.02;0.3\n",
        "0.00\t0.1\n0.01\t-0.2\n0.02\t0.3\n",
        "0.00 \t 0.1\n0.01\t-0.2\n0.02\t0.3\n",
        "  0.00   0.1\n  0.01  -0.2\n  0.02   0.3\n",
        "0.00,0.1\r\n0.01,-0.2\r\n0.02,0.3\r\n",
        "0.00 0.1\r0.01 -0.2\r0.02 0.3\r",
        "\n0.00,0.1\n\n0.01,-0.2\n0.02,0.3\n\n  \n",
        "0.00,0.1,\n0.01,-0.2,\n0.02,0.3,\n,\n",
        "0.00,0.1\n# pause\n0.01,-0.2\n % more\n0.02,0.3\n",
        "0.00,1D-1\n0.01,-2.0d-01\n0.02,.3D+00\n",
        "0.0e+000 1.0e-001\n1.0e-002 -2.0e-001\n2.0e-002 3.0e-001\n",
        "-0.01,0.1\n0.00,-0.2\n0.01,0.3\n",
        "0.00,0.1\n0.01,-0.2\n0.02,0.3\n\x1a",
    ],
)
def test_two_columns(write, rows):
    motion = read_record(write(rows), units="m/s2")
    assert accelerations(motion) == [0.1, -0.2, 0.3]
    assert motion.dt == pytest.approx(0.01, rel=1e-12)
    assert (motion.name, motion.unit, motion.format) == ("record.txt", "m/s2", "text")


@pytest.mark.parametrize("rows", ["0.1\n-0.2\n0.3", "0.1,\n-0.2,\n0.3,\n", "  .1\n -.2\n\n  .3\n"])
def test_one_column_takes_the_interval_from_the_user(write, rows):
    motion = read_record(write(rows), dt=0.005, units="m/s2")
    assert accelerations(motion) == [0.1, -0.2, 0.3]
    assert motion.dt == 0.005


@pytest.mark.parametrize(
    ("unit", "factor"), [("g", 9.80665), ("m/s2", 1.0), ("cm/s2", 0.01), ("mm/s2", 0.001), ("gal", 0.01)]
)
def test_units_are_converted_to_si(write, unit, factor):
    motion = read_record(write("0,1\n0.01,-2\n"), units=unit)
    np.testing.assert_allclose(motion.acceleration, [factor, -2 * factor], rtol=1e-15)
    assert motion.unit == unit


def test_the_path_may_be_a_string_and_the_name_is_the_files(write):
    assert read_record(str(write("0,1\n0.01,2\n", "El Centro.NS.dat")), units="g").name == "El Centro.NS.dat"


@pytest.mark.parametrize("name", ["record.AT2", "record.json", "record", "record.png"])
def test_the_format_is_found_from_the_content_not_the_name(write, name):
    assert read_record(write("t,accel_g\n0,1\n0.01,2\n", name)).format == "text"
    assert read_record(write(at2([1, 2]), name)).format == "PEER AT2"


@pytest.mark.parametrize("bom", [b"", b"\xef\xbb\xbf"])
@pytest.mark.parametrize("encoding", ["utf-8", "latin-1"])
def test_encodings(write, bom, encoding):
    content = "station é\ntime [s];a [m/s²]\r\n0.0;1\r\n0.5;2\r\n".encode(encoding)
    motion = read_record(write((bom if encoding == "utf-8" else b"") + content))
    assert accelerations(motion) == [1, 2]
    assert motion.unit == "m/s2"


def test_bom_before_the_first_number(write):
    assert accelerations(read_record(write(b"\xef\xbb\xbf0,1\n0.1,2\n"), units="m/s2")) == [1, 2]


@UNTIMED
@given(
    values=st.lists(st.floats(-1e6, 1e6), min_size=2, max_size=40),
    dt=st.floats(1e-4, 10.0),
    first=st.sampled_from([0.0, 1.0, -0.5]),
    mark=st.sampled_from([",", ";", "\t", " ", " , ", "   "]),
    newline=st.sampled_from(["\n", "\r\n"]),
    header=st.sampled_from(["t{}a [m/s2]", "# t, a [m/s2]", "% made up\ntime{}acceleration_m/s2"]),
)
def test_round_trip_of_two_columns(tmp_path_factory, values, dt, first, mark, newline, header):
    rows = [header.format(mark), *(f"{first + i * dt!r}{mark}{value!r}" for i, value in enumerate(values))]
    path = tmp_path_factory.getbasetemp() / "round_trip.txt"
    path.write_bytes(newline.join(rows).encode())
    motion = read_record(path)
    assert accelerations(motion) == values
    assert motion.dt == pytest.approx(dt, rel=1e-9)


@UNTIMED
@given(values=st.lists(st.floats(-1e6, 1e6), min_size=2, max_size=40), form=st.sampled_from(["r", ".17e", "+.17E"]))
def test_round_trip_of_one_column(tmp_path_factory, values, form):
    path = tmp_path_factory.getbasetemp() / "round_trip_one.txt"
    path.write_text("\n".join(repr(v) if form == "r" else format(v, form) for v in values))
    assert accelerations(read_record(path, dt=0.02, units="m/s2")) == values


def test_a_long_record_is_read_quickly(write):
    # The ordinary reader takes about a second for a million lines; the line-by-line one several times as long.
    n = 200_000
    path = write("time_s,accel_g\n" + "".join(f"{i * 0.005:.3f},{i % 7}.25\n" for i in range(n)))
    begin = clock.perf_counter()
    motion = read_record(path)
    assert clock.perf_counter() - begin < 3
    assert (motion.npts, motion.acceleration[-1]) == (n, ((n - 1) % 7 + 0.25) * G)


# --- units in headers -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("spelling", "name"),
    [
        *[(s, "g") for s in ("g", "G", " g ")],
        *[(s, "m/s2") for s in ("m/s2", "m/s^2", "m/s**2", "m/s/s", "m s-2", "m/sec2", "M/SEC/SEC", "m/s²", "m s⁻²")],
        *[(s, "m/s2") for s in ("m·s-2", "m s^-2", "m / s^2", "m/s 2", "mps2", "m_s2", "ms-2")],
        *[(s, "cm/s2") for s in ("cm/s2", "cm/s^2", "CM/SEC/SEC", "cm/sec**2", "CM/S/S", "cm s-2")],
        *[(s, "mm/s2") for s in ("mm/s2", "mm/s^2", "mm/s/s")],
        *[(s, "gal") for s in ("gal", "Gal", "GAL")],
        *[
            (s, None)
            for s in ("m/s", "cm", "ft/s2", "in/s2", "mg", "%g", "", "s", "m/s3", "g/10", "km/s2", "gs2", "gall")
        ],
    ],
)
def test_spellings(spelling, name):
    assert canonical(spelling) == name


@pytest.mark.parametrize(
    ("header", "unit"),
    [
        ("time_s,accel_g", "g"),
        ("t,acceleration_g", "g"),
        ("t,acc_g", "g"),
        ('"time","ACCEL_G"', "g"),
        ("t;Acceleration in g", "g"),
        ("t,a_g[g]", "g"),
        ("t,a_g [m/s2]", "m/s2"),
        ("t,accel_g [m/s2]", "m/s2"),
        ("t [s],a [m/s2]", "m/s2"),
        ("t [s]  a [m/s^2]", "m/s2"),
        ("Time (sec)\tacc (cm/s^2)", "cm/s2"),
        ("Time (s), Acceleration (gal)", "gal"),
        ("t,a_g_m/s2", "m/s2"),
        ("t,accel_m_s2", "m/s2"),
        ("t,acc_mm/s2", "mm/s2"),
        ("t,a\ns,g", "g"),
        ("t,a\n(s),(m/s2)", "m/s2"),
        ("# Acceleration, m/s2", "m/s2"),
        ("% units: cm/s**2\n% processed in 2003", "cm/s2"),
        ("# unit = g\nt,a", "g"),
        ("#time_s accel_g", "g"),
        ("ACCELERATION TIME HISTORY IN UNITS OF G. FILTER POINTS: HP=0.1 Hz LP=23.0 Hz", "g"),
        ("# PGA: 3.4 (m/s2)\nt,accel_g", "g"),
        ("# Peak velocity (cm/s): 23, Vs30 = 360 m/s\nt,accel_g", "g"),
        ("Station 5\n\nNorth\nt [s],a [gal]", "gal"),
        ("# units: gal\nt,a [cm/s2]", "cm/s2"),
    ],
)
def test_unit_from_the_header(write, header, unit):
    motion = read_record(write(f"{header}\n0.0,1\n0.5,2\n"))
    assert motion.unit == unit
    assert motion.npts == 2


def test_unit_from_the_header_of_one_column(write):
    assert read_record(write("accel_g\n1\n2\n"), dt=0.1).unit == "g"
    assert read_record(write("m/s2\n1\n2\n"), dt=0.1).unit == "m/s2"


@pytest.mark.parametrize(
    "header",
    [
        "",
        "t,a\n",
        "t,a_g\n",
        "t,ag\n",
        "time,Ag\n",
        "t,acc\n",
        "t [s],acceleration\n",
        "t,g\n",
        "# PGA = 0.3 g\n",
        "# Peak acceleration (g): 0.34\n",
        "# 1 g = 9.81 m/s2\n",
        "# gravity acceleration g = 9.81 m/s2\nt,a_g\n",
        "# recorded in g-building 4\n",
        "# Scale Factor 3920(gal)/6182761\n",
        "# acceleration, g = 9.81 m/s2\nt,a_g\n",
        "t,acceleration [g/10]\n",
        "t,acceleration (g)/10\n",
    ],
)
def test_the_unit_is_never_guessed(write, header):
    path = write(f"{header}0.0,1\n0.5,2\n")
    found = problem(path)
    assert "does not say what unit" in found.message
    assert "--units" in found.hint
    assert "g, m/s2, cm/s2, mm/s2, gal" in found.hint
    assert read_record(path, units="cm/s2").acceleration[0] == 0.01


def test_unknown_unit_of_the_user(write):
    (found,) = problems(write("0,1\n0.5,2\n"), units="ft/s2")
    assert "unknown unit 'ft/s2'" in found.message
    assert found.field == "--units"
    assert "g, m/s2, cm/s2, mm/s2, gal" in found.hint


def test_a_unit_of_the_user_may_be_spelled_otherwise(write):
    assert read_record(write("0,1\n0.5,2\n"), units="M/SEC^2").unit == "m/s2"


@pytest.mark.parametrize(("header", "units"), [("accel_g", "m/s2"), ("a [m/s2]", "g"), ("a [cm/s2]", "mm/s2")])
def test_header_and_user_may_not_differ(write, header, units):
    found = problem(write(f"# made up\nt,{header}\n0,1\n0.5,2\n"), units=units)
    assert f"but --units says {units}" in found.message
    assert found.line == 2


def test_header_and_user_may_agree(write):
    assert read_record(write("t,accel_g\n0,1\n0.5,2\n"), units="g").unit == "g"
    assert read_record(write("t,a [cm/s2]\n0,1\n0.5,2\n"), units="gal").unit == "cm/s2"


def test_two_units_in_a_header_are_not_guessed_between(write):
    path = write("# units: m/s2\nt,accel_g\n0,1\n0.5,2\n")
    found = problem(path)
    assert "more than one unit" in found.message
    assert "m/s2" in found.message
    assert found.line == 2
    assert "--units" in found.hint
    assert read_record(path, units="g").unit == "g"
    assert "--units says cm/s2" in problem(path, units="cm/s2").message


@pytest.mark.parametrize(
    ("header", "line", "fragment"),
    [
        ("t,velocity", 1, "velocity or displacement"),
        ("t [s],v [m/s]", 1, "'m/s'"),
        ("# one\nt [s];u (cm)", 2, "'cm'"),
        ("t,vel_cm/s", 1, "velocity or displacement"),
        ("t,Displacement (mm)", 1, "'mm'"),
        ("t,disp", 1, "velocity or displacement"),
        ("t,acceleration [cm/s]", 1, "'cm/s'"),
        ("# VELOCITY TIME SERIES IN UNITS OF CM/S\nt,x", 1, "'cm/s'"),
        ("# accelerations\nt,vel", 2, "velocity or displacement"),
        ("t,accel [ft/s2]", 1, "'ft/s2' cannot be read"),
        ("t,accel_mg", 1, "'mg' cannot be read"),
        ("t,accel [%g]", 1, "'%g' cannot be read"),
    ],
)
@pytest.mark.parametrize("units", [None, "g"])
def test_other_quantities_are_refused(write, header, line, fragment, units):
    found = problem(write(f"{header}\n0,1\n0.5,2\n"), units=units)
    assert fragment in found.message
    assert found.line == line
    assert "acceleration" in found.hint


def test_times_in_another_unit_are_refused(write):
    found = problem(write("time_ms,accel_g\n0,1\n5,2\n"))
    assert "'ms'" in found.message
    assert "seconds" in found.hint
    assert found.line == 1


def test_a_unit_in_brackets_outweighs_a_name():
    assert header_units("accel_g [cm/s2]") == {"cm/s2"}
    assert header_units("a_g [g]") == {"g"}
    assert header_units("a_g") == set()


# --- the sample interval --------------------------------------------------------------------------------------------


def test_one_column_needs_an_interval(write):
    found = problem(write("accel_g\n1\n2\n"))
    assert "no sample interval" in found.message
    assert "--dt" in found.hint


def test_everything_missing_is_said_at_once(write):
    unit, interval = problems(write("1\n2\n"))
    assert "--units" in unit.hint
    assert "--dt" in interval.hint


@pytest.mark.parametrize("dt", [0.0, -0.01, float("nan"), float("inf")])
@pytest.mark.parametrize("content", ["accel_g\n1\n2\n", "t,accel_g\n0,1\n0.01,2\n"])
def test_the_interval_must_be_positive_and_finite(write, content, dt):
    (found,) = problems(write(content), dt=dt)
    assert "positive" in found.message
    assert found.field == "--dt"


def test_an_interval_that_is_given_must_agree_with_the_times(write):
    path = write("t,accel_g\n0,1\n0.01,2\n0.02,3\n")
    assert read_record(path, dt=0.01).dt == pytest.approx(0.01)
    found = problem(path, dt=0.02)
    assert "0.01 s" in found.message
    assert "--dt says 0.02 s" in found.message


def times(write, *printed: str) -> Path:
    return write("t,accel_g\n# comment\n\n" + "".join(f"{t},1\n" for t in printed))


@pytest.mark.parametrize(
    ("printed", "line", "fragment"),
    [
        (("0", "0.01", "0.02", "0.04", "0.05"), 7, "uneven"),
        (("0", "0.01", "0.02", "0.021", "0.03", "0.04"), 7, "uneven"),
        (("0", "0.01", "0.021", "0.03"), 6, "uneven"),
        (("0", "0.01", "0.02", "0.0202"), 7, "uneven"),
        (("0", "0.01", "0.01", "0.02"), 6, "does not increase: 0.01 s is repeated"),
        (("0.00", "0.01", "0.01", "0.02", "0.02"), 6, "does not increase"),
        (("0", "0.01", "0.02", "0.015", "0.03"), 7, "does not increase: 0.015 s comes after 0.02 s"),
        (("0.03", "0.02", "0.01"), 5, "does not increase"),
        (("0", "0", "0"), 5, "is repeated"),
    ],
)
def test_uneven_times_are_refused(write, printed, line, fragment):
    found = problem(times(write, *printed))
    assert fragment in found.message
    assert found.line == line
    assert found.excerpt.startswith(printed[line - 4])


def test_comments_and_blank_lines_between_rows_are_counted_as_lines(write):
    assert problem(write("t,accel_g\n0,1\n# c\n\n0.01,1\n,\n0.02,1\n% c\n0.04,1\n0.05,1\n")).line == 9


def test_times_too_close_to_be_times_are_refused(write):
    assert "sample interval of" in problem(write("t,accel_g\n0,1\n5e-324,2\n")).message


def test_a_missing_sample_is_found_where_it_is(write):
    printed = [f"{i * 0.005:.3f}" for i in range(3000) if i != 1234]
    found = problem(times(write, *printed))
    assert found.excerpt == "6.175,1"
    assert found.line == 1234 + 4


def test_steps_that_grow_bit_by_bit_are_refused(write):
    # Steps differ by half a percent at most, but half way the samples are a quarter of a second off.
    steps = np.where(np.arange(20000) < 10000, 0.01, 0.01005)
    found = problem(times(write, *(f"{t:.6f}" for t in np.cumsum(steps))))
    assert "a constant interval would give" in found.message


@pytest.mark.parametrize(
    ("dt", "decimals"), [(1 / 128, 4), (1 / 256, 4), (1 / 256, 5), (1 / 150, 4), (0.005, 3), (0.02, 2), (1 / 3, 2)]
)
@pytest.mark.parametrize("n", [2, 3, 10, 1000, 20000])
def test_rounded_times_are_accepted(write, dt, decimals, n):
    motion = read_record(times(write, *(f"{i * dt:.{decimals}f}" for i in range(n))))
    assert motion.dt == pytest.approx(dt, abs=1.01 * 10**-decimals / (n - 1))


@pytest.mark.parametrize(("dt", "decimals"), [(0.005, 2), (1 / 150, 3), (1 / 256, 3), (1 / 3, 1)])
def test_times_rounded_too_much_are_refused(write, dt, decimals):
    found = problem(times(write, *(f"{i * dt:.{decimals}f}" for i in range(1000))))
    assert "time" in found.message
    assert found.line is not None


@UNTIMED
@given(
    n=st.integers(6, 60),
    where=st.floats(0, 1),
    shift=st.floats(0.05, 0.9) | st.floats(-0.9, -0.05),
    dt=st.sampled_from([0.001, 0.005, 0.01, 1.0]),
)
def test_one_time_out_of_step_is_always_noticed(tmp_path_factory, n, where, shift, dt):
    moved = 1 + int(where * (n - 3))
    printed = [f"{(i + (shift if i == moved else 0)) * dt:.9f}" for i in range(n)]
    path = tmp_path_factory.getbasetemp() / "uneven.txt"
    path.write_text("".join(f"{t},1\n" for t in printed))
    assert problem(path, units="g").line == moved + 1


# --- what is wrong with a text file ---------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("content", "line", "fragment"),
    [
        ("t,accel_g\n0,1\n0.01,abc\n0.02,3\n", 3, "'abc' is not a number"),
        ("t,accel_g\n0,abc\n0.01,2\n", 2, "'abc' is not a number"),
        ("t,accel_g\nO.00,1\n0.01,2\n0.02,2\n", 2, "'O.00' is not a number"),
        ("t,accel_g\n0,1\n0.01,2\nend\n", 4, "'end' is not a number"),
        ("t,accel_g\n0,1_0\n0.01,2\n", 2, "'1_0' is not a number"),
        ("t,accel_g\n0,0x1\n0.01,2\n", 2, "'0x1' is not a number"),
        ("t,accel_g\n0,1\n0.01,1 2\n", 3, "'1 2' is not a number"),
        ("t,accel_g\n0,1\n0.01,NaN\n0.02,3\n", 3, "'NaN' is not a finite number"),
        ("t,accel_g\nnan,1\n0.01,2\n", 2, "'nan' is not a finite number"),
        ("t,accel_g\n0,1\n0.01,-inf\n", 3, "'-inf' is not a finite number"),
        ("t,accel_g\n0,1\n0.01,1e999\n", 3, "'1e999' is not a finite number"),
        ("t,accel_g\n0,1\n0.01,1e300\n", 3, "'1e300' is not a finite number of sensible size"),
        ("t,accel_g\n-1e308,1\n1e308,2\n", 2, "'-1e308' is not a finite number of sensible size"),
        ("t,accel_g\n\n0,1\n# c\n0.01\n0.02,3\n", 5, "has 1 column, the rows before it have 2"),
        ("t,accel_g\n0,1\n0.01,2,3\n", 3, "has 3 columns, the rows before it have 2"),
        ("t accel_g\n0 1\n0.01 2 3\n", 3, "has 3 columns, the rows before it have 2"),
        ("t,accel_g\n0,1\n0.01,,2\n", 3, "a value is missing"),
        ("t;accel_g\n0;1\n;2\n", 3, "a value is missing"),
        ("t,a,b\n0,1,2\n0.01,2,3\n", 2, "3 columns: only one (acceleration) or two (time, acceleration)"),
        ("accel_g\n1 2 3 4 5\n1 2 3 4 5\n", 2, "5 columns: only one"),
        ("t,accel_g\n0,1\n", 2, "at least two samples"),
        ("6 km south of the fault\naccel_g\n1\n2\n", 1, "'km' is not a number"),
    ],
)
def test_bad_rows(write, content, line, fragment):
    path = write(content)
    found = problem(path)
    assert fragment in found.message
    assert found.line == line
    assert f"{path}:{line}: " in str(found)
    assert "\n" not in (found.excerpt or "")


def test_one_number_is_not_a_record(write):
    found = problem(write("accel_g\n1\n"), dt=0.01)
    assert "at least two samples" in found.message
    assert found.line == 2


@pytest.mark.parametrize("rows", ["0,00;0,10\n0,01;0,20\n", "0,00\t0,10\n0,01\t0,20\n", "0,00 0,10\n0,01 0,20\n"])
def test_decimal_commas_are_explained(write, rows):
    found = problem(write("t a [g]\n" + rows))
    assert "point, not a comma" in found.hint
    assert found.line == 2


def test_a_comma_between_columns_is_not_taken_for_a_decimal_one(write):
    assert "correct it" in problem(write("t,accel_g\n0.0,1\n0.5,2x\n")).hint


def test_a_bad_value_late_in_a_long_file_is_placed(write):
    rows = [f"{i * 0.01:.2f},0.1" for i in range(5000)]
    rows[4321] = "43.21,oops"
    assert problem(write("\n".join(["t,accel_g", *rows]))).line == 4323


# --- what is wrong with any file ------------------------------------------------------------------------------------


def test_missing_file(tmp_path):
    found = problem(tmp_path / "nowhere.csv")
    assert "no such file" in found.message
    assert found.line is None


def test_the_file_is_named_as_the_user_named_it(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (found,) = problems("./nowhere.csv")
    assert found.file == "./nowhere.csv"


def test_directory(tmp_path):
    assert "this is a folder" in problem(tmp_path).message


def test_a_path_no_file_can_have():
    assert "cannot be read" in problem("a\0b").message


@pytest.mark.parametrize("content", [b"", b"\n \r\n", b"\xef\xbb\xbf", b"\x1a"])
def test_empty_file(write, content):
    assert "empty" in problem(write(content)).message


@pytest.mark.parametrize(
    "content",
    [b"\x89PNG\r\n\x1a\n\0\0\0", b"PK\x03\x04abc", b"\x1f\x8b\x08abc", "0,1\n0.1,2\n".encode("utf-16"), b"0,1\n0.1,\0"],
)
def test_binary_file(write, content):
    found = problem(write(content), units="g")
    assert "binary" in found.message
    assert "plain text" in found.hint


@pytest.mark.parametrize(
    "content", ["hello\nworld\n", "t,accel_g\n", "# only a comment\n", '{"a": [\n0.1,\n0.2]}', "<a>\n1\n2"]
)
def test_something_else_altogether(write, content):
    found = problem(write(content), dt=0.01, units="g")
    assert "not a record format" in found.message
    assert "PEER AT2" in found.hint


@UNTIMED
@given(st.text(alphabet="0123456789.,;-+eEdDnaif# \t\nNPTS=DTg[]", max_size=80), st.sampled_from([None, "g"]))
def test_rubbish_is_read_or_refused_never_a_traceback(tmp_path_factory, content, units):
    path = tmp_path_factory.getbasetemp() / "rubbish.txt"
    path.write_text(content)
    try:
        motion = read_record(path, dt=0.01, units=units)
    except InputError as error:
        assert error.problems
    else:
        assert np.isfinite(motion.acceleration).all()
        assert motion.dt > 0


@UNTIMED
@given(st.binary(max_size=200))
def test_any_bytes_are_read_or_refused(tmp_path_factory, content):
    path = tmp_path_factory.getbasetemp() / "bytes.txt"
    path.write_bytes(content)
    try:
        read_record(path, dt=0.01, units="g")
    except InputError as error:
        assert error.problems


# --- PEER AT2 -------------------------------------------------------------------------------------------------------

TITLE = "PEER NGA STRONG MOTION DATABASE RECORD\nSomewhere, 1/1/2000, Station (upper left), 228\n"
UNITS_OF_G = "ACCELERATION TIME SERIES IN UNITS OF G\n"


def at2(values, *, dt: str = ".0100", npts: int | None = None, units: str = UNITS_OF_G, per_line: int = 5) -> str:
    npts = len(values) if npts is None else npts
    rows = [values[i : i + per_line] for i in range(0, len(values), per_line)]
    body = "\n".join("".join(f"{value:16.7E}" for value in row) for row in rows)
    return f"{TITLE}{units}NPTS={npts:7d}, DT= {dt:>7} SEC,   0 POLE @    30.00000 HZ\n{body}\n"


VALUES = [0.001 * i * (-1) ** i for i in range(1, 14)]


@pytest.mark.parametrize("per_line", [1, 5, 8])
@pytest.mark.parametrize("newline", ["\n", "\r\n"])
def test_peer(write, per_line, newline):
    path = write(at2(VALUES, per_line=per_line).replace("\n", newline), "RSN1.AT2")
    motion = read_record(path)
    np.testing.assert_allclose(motion.acceleration, np.array(VALUES) * G, rtol=1e-12)
    assert (motion.dt, motion.name, motion.unit, motion.format) == (0.01, "RSN1.AT2", "g", "PEER AT2")


@pytest.mark.parametrize(
    "header",
    [
        f"{TITLE}{UNITS_OF_G}   3    0.0050    NPTS, DT\n",
        f"{TITLE}{UNITS_OF_G}   3    .0050 NPTS,DT\n",
        f"{TITLE}{UNITS_OF_G}NPTS=3,DT=5.0E-03\n",
        f"{TITLE}{UNITS_OF_G}NPTS=     3, DT=   .0050 SEC,\n",
        f"{TITLE}{UNITS_OF_G}npts = 3, dt = .5D-02 sec\n",
        f"{TITLE}{UNITS_OF_G}DT= .0050 SEC\nNPTS= 3\n",
        "Data, older version\n3 points at 0.005 sec in 8F10.5\nThe units are (g)\nNPTS=  3, DT= .00500 SEC\n",
        f"{TITLE}processed twice\nfiltered\n\n{UNITS_OF_G}NPTS= 3, DT= .005 SEC\n",
        f"{UNITS_OF_G}NPTS= 3, DT= .005 SEC\n",
        "NPTS= 3, DT= .005 SEC\nUNITS OF G\n\n",
    ],
)
def test_peer_headers(write, header):
    motion = read_record(write(header + "  .1000000E+00  -.2000000E+00   .3000000E+00\n"))
    np.testing.assert_allclose(motion.acceleration, [0.1 * G, -0.2 * G, 0.3 * G], rtol=1e-15)
    assert (motion.dt, motion.unit, motion.format) == (0.005, "g", "PEER AT2")


@pytest.mark.parametrize("header", ["{npts:6d}  {dt}    NPTS, DT\n", "NPTS= {npts:6d}, DT= {dt} SEC,\n"])
@pytest.mark.parametrize("per_line", [5, 8])
@pytest.mark.parametrize(
    ("printed", "dt"),
    [(".00390625", 1 / 256), ("0.0024", 0.0024), (".009756", 0.009756), ("9.765625E-03", 0.009765625)],
)
def test_odd_intervals_of_peer(write, header, per_line, printed, dt):
    body = at2(VALUES, per_line=per_line).split("\n", 4)[4]
    motion = read_record(write(TITLE + UNITS_OF_G + header.format(npts=len(VALUES), dt=printed) + body))
    np.testing.assert_allclose(motion.acceleration, np.array(VALUES) * G, rtol=1e-12)
    assert (motion.dt, motion.format) == (dt, "PEER AT2")


@pytest.mark.parametrize(
    "body",
    [
        ".998E-03 -.25D-02 .1",
        "  .998E-03\n\n  -.25d-02  1D-1\n",
        ".998E-03-.25D-02+.1E+00",
        "0.998E-03-0.25E-02 0.1",
        "9.98e-4,".rstrip(",") + "\t-2.5e-3\r\n.1\r\n\x1a",
        ".000998-.002500 .1",
    ],
)
def test_fortran_numbers(write, body):
    motion = read_record(write(at2([], npts=3) + body))
    np.testing.assert_allclose(motion.acceleration, np.array([0.998e-3, -0.25e-2, 0.1]) * G, rtol=1e-14)


@UNTIMED
@given(values=st.lists(st.floats(-9.9e9, -1e-9), min_size=2, max_size=40), per_line=st.sampled_from([1, 5, 8]))
def test_round_trip_of_values_run_together(tmp_path_factory, values, per_line):
    rows = ["".join(f"{v:.16E}" for v in values[i : i + per_line]) for i in range(0, len(values), per_line)]
    path = tmp_path_factory.getbasetemp() / "together.AT2"
    path.write_text(at2([], npts=len(values), units="UNITS OF M/S/S\n") + "\n".join(rows))
    assert accelerations(read_record(path)) == values


@pytest.mark.parametrize(
    ("line", "unit"),
    [
        ("ACCELERATION TIME SERIES IN UNITS OF G", "g"),
        ("ACCELERATION TIME HISTORY IN UNITS OF G. FILTER POINTS: HP=0.1 Hz LP=23.0 Hz", "g"),
        ("The units are (g)", "g"),
        ("ACCELERATION TIME SERIES IN UNITS OF CM/SEC/SEC", "cm/s2"),
        ("ACCELERATION (CM/SEC**2)", "cm/s2"),
        ("Units: m/s^2", "m/s2"),
        ("ACCELERATION IN GAL", "gal"),
    ],
)
def test_unit_of_peer(write, line, unit):
    assert read_record(write(at2(VALUES, units=line + "\n"))).unit == unit


def test_unit_missing_or_contradicted_in_peer(write):
    path = write(at2(VALUES, units="\n"))
    assert "--units" in problem(path).hint
    assert read_record(path, units="gal").unit == "gal"
    found = problem(write(at2(VALUES)), units="m/s2")
    assert "the unit is g, but --units says m/s2" in found.message
    assert found.line == 3


@pytest.mark.parametrize(
    "quantity", ["VELOCITY TIME SERIES IN UNITS OF CM/S", "DISPLACEMENT TIME SERIES IN UNITS OF CM"]
)
@pytest.mark.parametrize("units", [None, "g"])
def test_velocity_and_displacement_files_are_refused(write, quantity, units):
    found = problem(write(at2(VALUES, units=quantity + "\n")), units=units)
    assert "not an acceleration" in found.message
    assert found.line == 3


@pytest.mark.parametrize("npts", [12, 14, 0])
def test_number_of_points_must_match(write, npts):
    found = problem(write(at2(VALUES, npts=npts)))
    assert f"NPTS = {npts}" in found.message
    assert "13 values" in found.message
    assert found.line == 4


def test_exponents_without_a_letter_do_not_pass_unnoticed(write):
    # Fortran drops the E of a three-digit exponent; read as two numbers it would be a sample of -102 g.
    assert "has 4 values" in problem(write(at2([], npts=3) + ".1234-102 .2 .3")).message


@pytest.mark.parametrize("npts", [0, 1])
def test_too_few_points_in_peer(write, npts):
    found = problem(write(at2(VALUES[:npts])))
    assert "at least two samples" in found.message
    assert found.line == 4


@pytest.mark.parametrize("dt", ["0.0", "-.01", "1E999"])
def test_interval_of_peer_must_be_positive(write, dt):
    found = problem(write(at2(VALUES, dt=dt)))
    assert "positive" in found.message
    assert found.line == 4


def test_an_interval_that_is_given_must_agree_with_peer(write):
    path = write(at2(VALUES))
    assert read_record(path, dt=0.01).dt == 0.01
    found = problem(path, dt=0.005)
    assert "0.01 s, but --dt says 0.005 s" in found.message
    assert found.line == 4


@pytest.mark.parametrize(
    ("body", "line", "fragment"),
    [
        ("1 2 3\n4 oops 6\n", 6, "'oops' is not a number"),
        ("1 2 3\n\n4 NaN 6\n", 7, "'NaN' is not a finite number"),
        ("1 2 3\n4 ******** 6\n", 6, "'********' is not a number"),
        ("1 1E999 3\n", 5, "'1E999' is not a finite number"),
        ("1 -1e300 3\n", 5, "'-1e300' is not a finite number"),
        ("1 2 1_0\n", 5, "'1_0' is not a number"),
        ("1 2,5 3\n", 5, "'2,5' is not a number"),
    ],
)
def test_bad_values_in_peer(write, body, line, fragment):
    found = problem(write(at2([], npts=6).rstrip("\n") + "\n" + body))
    assert fragment in found.message
    assert found.line == line


@pytest.mark.parametrize(
    ("header", "missing", "line"),
    [("DT= .01 SEC\n", "NPTS", None), ("NPTS= 3\n", "DT", 4), ("\n", "NPTS", None)],
)
def test_peer_without_its_numbers(write, header, missing, line):
    found = problem(write(f"{TITLE}{UNITS_OF_G}{header}1 2 3\n"))
    assert f"({missing})" in found.message
    assert "NPTS=" in found.hint
    assert found.line == line


def test_comments_in_peer_are_passed_over(write):
    content = "# NPTS= 99, DT= 1.0\n" + at2([], npts=3).rstrip("\n") + "\n.1 .2\n# pause\n.3\n"
    motion = read_record(write(content))
    assert (motion.npts, motion.dt) == (3, 0.01)
    assert "oops" in problem(write(content + "# c\noops\n")).message


def test_text_with_a_peer_header_in_comments_is_text(write):
    content = "".join(f"# {line}\n" for line in at2([], npts=2).splitlines()) + "0,1\n0.01,2\n"
    motion = read_record(write(content))
    assert (motion.format, motion.npts, motion.unit) == ("text", 2, "g")


def test_readers_tell_the_formats_apart():
    assert peer.sniff(at2(VALUES))
    assert not peer.sniff("t,accel_g\n0,1\n0.01,2\n")
    assert text.sniff("t,accel_g\n0,1\n0.01,2\n")
    assert not text.sniff('{"accel": [\n1,\n2]}')
    assert not text.sniff("nothing here")
    with pytest.raises(InputError, match="no numbers found"):
        text.read("nothing here", "file.txt")


# --- real records, and the example ----------------------------------------------------------------------------------


@NEEDS_RECORDS
@pytest.mark.parametrize(
    ("name", "options", "npts", "dt", "pga", "form"),
    [
        ("Rinaldi228.AT2", {}, 1991, 0.01, 0.874, "PEER AT2"),
        ("Rinaldi318.AT2", {}, 1991, 0.01, 0.472, "PEER AT2"),
        ("RinaldiUP.AT2", {}, 1991, 0.01, 0.958, "PEER AT2"),
        ("RSN6_IMPVALL.I_I-ELC180.AT2", {}, 5372, 0.01, 0.281, "PEER AT2"),
        ("RSN77_SFERN_PUL164.AT2", {}, 4172, 0.01, 1.219, "PEER AT2"),
        ("elCentro.AT2", {}, 1559, 0.02, 0.319, "PEER AT2"),
        ("elcentro_NS_full_2col.dat", {"units": "g"}, 2688, 0.02, 0.349, "text"),
    ],
)
def test_real_records(name, options, npts, dt, pga, form):
    motion = read_record(record(name), **options)
    assert (motion.name, motion.npts, motion.format, motion.unit) == (name, npts, form, "g")
    assert motion.dt == pytest.approx(dt, rel=1e-9)
    assert motion.pga == pytest.approx(pga, abs=0.0005)


@NEEDS_RECORDS
def test_a_real_record_without_a_unit_is_refused():
    assert "--units" in problem(record("elcentro_NS_full_2col.dat")).hint


@pytest.fixture(scope="module")
def make_accel():
    return runpy.run_path(str(EXAMPLES / "make_accel.py"))


def test_the_example_is_what_its_script_makes(make_accel, tmp_path):
    make_accel["write"](tmp_path / "accel.csv")
    made, kept = read_record(tmp_path / "accel.csv"), read_record(EXAMPLES / "accel.csv")
    np.testing.assert_allclose(made.acceleration, kept.acceleration, rtol=0, atol=1e-9)
    time, acceleration = make_accel["accelerogram"]()
    np.testing.assert_allclose(kept.acceleration, acceleration * G, rtol=0, atol=1e-9)
    np.testing.assert_allclose(np.arange(kept.npts) * kept.dt, time, rtol=0, atol=1e-9)


def test_the_example_is_a_plausible_near_fault_motion(make_accel):
    motion = read_record(EXAMPLES / "accel.csv")
    assert (motion.npts, motion.unit, motion.format) == (1201, "g", "text")
    assert motion.dt == pytest.approx(0.01)
    assert 0.5 <= motion.pga <= 0.6
    assert motion.acceleration[0] == motion.acceleration[-1] == 0
    velocity = np.cumsum(motion.acceleration) * motion.dt
    assert 0.4 < np.abs(velocity).max() < 1.0  # m/s, from the pulse
    assert abs(velocity[-1]) < 1e-3
    pulse = make_accel["pulse"](np.arange(motion.npts) * motion.dt)
    assert np.abs(pulse).max() == 1
    assert abs(pulse.sum() * motion.dt) < 1e-3  # a pulse leaves no velocity behind


def test_the_example_has_unix_newlines():
    content = (EXAMPLES / "accel.csv").read_bytes()
    assert content.startswith(b"time_s,accel_g\n0.00,0.000000\n")
    assert b"\r" not in content
    assert b"-0.000000" not in content


@pytest.mark.parametrize("header", ["accel_g,time_s", "a [g];t [s]", '"acc (g)",Time'])
def test_columns_in_the_other_order_are_refused_even_if_the_accelerations_rise(tmp_path, header):
    path = tmp_path / "swapped.csv"
    mark = ";" if ";" in header else ","
    path.write_text(header + "\n" + "".join(f"{k * 0.01}{mark}{k * 0.01}\n" for k in range(5)), encoding="utf-8")
    with pytest.raises(InputError, match=r"swapped.csv:1: the time is in the second column"):
        read_record(path)


def test_a_bare_column_name_that_begins_with_t_is_no_time(tmp_path):
    path = tmp_path / "named.csv"
    path.write_text("time_s,transverse_g\n0,0\n0.01,1\n0.02,0\n", encoding="utf-8")
    assert read_record(path, units="g").npts == 3
