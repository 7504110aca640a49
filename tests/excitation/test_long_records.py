"""Records of hundreds of thousands of lines: read in a memory of the size of the file, and wrong in one line only."""

import tracemalloc
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rocking_cli.ask.read import read_record
from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.records import lines as module
from rocking_cli.excitation.records.lines import Lines

COUNT = 300_000
VALUES = np.round(np.sin(np.arange(COUNT)), 6)


def one_column() -> list[str]:
    return ["accel_g", *(f"{value:.6f}" for value in VALUES)]


def two_columns() -> list[str]:
    return ["time_s,accel_g", *(f"{index * 0.005:.3f},{value:.6f}" for index, value in enumerate(VALUES))]


def at2() -> list[str]:
    rows = ["".join(f"{value:15.6E}" for value in row) for row in VALUES.reshape(-1, 5)]
    return ["PEER NGA DATABASE", "Made up", "ACCELERATION IN UNITS OF G", f"NPTS= {COUNT}, DT= .005 SEC", *rows]


def esm() -> list[str]:
    header = ["SAMPLING_INTERVAL_S: 0.005", f"NDATA: {COUNT}", "UNITS: cm/s^2", "DATA_TYPE: ACCELERATION"]
    return [*header, *(f"{value:.6f}" for value in VALUES)]


BY_FORM = pytest.mark.parametrize("make", [one_column, two_columns, at2, esm])


@pytest.fixture(scope="module")
def made(tmp_path_factory) -> Callable:
    """Make a file once, or with one line in place of another."""
    rows = {}

    def made(make: Callable[[], list[str]], line: int | None = None, content: str = "") -> Path:
        if make not in rows:
            rows[make] = make()
        path = tmp_path_factory.getbasetemp() / "long.txt"
        changed = list(rows[make])
        if line is not None:
            changed[line - 1] = content
        path.write_text("\n".join(changed) + "\n")
        return path

    return made


def read(path: Path):
    return read_record(path, dt=0.005)


@pytest.mark.rest
@BY_FORM
def test_memory_is_a_small_multiple_of_the_file(made, make):
    path = made(make)
    read(path)  # the readers are imported by now
    tracemalloc.start()
    try:
        motion = read(path)
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    np.testing.assert_allclose(motion.acceleration, VALUES * (0.01 if make is esm else 9.80665), rtol=1e-6, atol=1e-12)
    # As objects, the lines and numbers took eight to fourteen times the file. Two columns are three arrays in turn.
    arrays = (3 if make is two_columns else 1) * VALUES.nbytes
    assert peak < 3 * path.stat().st_size + arrays


@pytest.mark.rest
@BY_FORM
@pytest.mark.parametrize("content", ["oops"])
def test_one_bad_value_near_the_end_is_placed(made, make, content):
    line = 59_000 if make is at2 else 299_000
    content = f"{(line - 2) * 0.005:.3f},{content}" if make is two_columns else content
    found = problem(made(make, line, content))
    assert found.excerpt == content
    # A word ends a run of fixed columns, and the message says how far it goes.
    assert found.line == line or f"up to line {line - 1}" in found.message


@pytest.mark.rest
@pytest.mark.parametrize(
    ("content", "fragment"),
    [
        (",0.1", "a value is missing"),
        ("1494.992,0.1", "time is uneven"),
        ("# a sample taken out", "time is uneven"),
    ],
)
def test_one_bad_row_near_the_end_is_placed(made, content, fragment):
    found = problem(made(two_columns, 299_000, content))
    assert fragment in found.message
    assert found.line == (299_000 if content[:1] not in ("", "#") else 299_001)  # a gap is seen after it


@pytest.mark.rest
@pytest.mark.parametrize("make", [one_column, two_columns])
def test_pages_of_comments_and_blank_lines_are_passed_over(made, make):
    filling = ["# " + 100 * "x", *[""] * module.PAGE_CHARACTERS, "% x"] * 3  # one page of them is all blank
    path = made(make)
    rows = path.read_text().split("\n")
    path.write_text("\n".join([*rows[:200_000], *filling, *rows[200_000:]]))
    np.testing.assert_array_equal(read(path).acceleration, VALUES * 9.80665)
    rows[250_000] += "x"
    path.write_text("\n".join([*rows[:200_000], *filling, *rows[200_000:]]))
    assert problem(path).line == 250_001 + len(filling)


def test_numbers_only_fortran_prints_are_read_among_others(made):
    changed = made(one_column, 200_000, "1.5D-01")
    assert read(changed).acceleration[199_998] == 0.15 * 9.80665


def test_a_long_record_of_another_length_than_it_says_is_refused(made):
    changed = made(at2, 4, f"NPTS= {COUNT - 5}, DT= .005 SEC")
    assert f"but the file has {COUNT} values" in problem(changed).message


def problem(path: Path) -> Problem:
    with pytest.raises(InputError) as caught:
        read(path)
    (found,) = caught.value.problems
    return found


# --- lines, a page at a time ----------------------------------------------------------------------------------------


@given(st.text(alphabet="ab\n", max_size=60), st.integers(1, 9), st.integers(0, 70))
def test_lines_are_those_of_split(text, page, start):
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(module, "PAGE_CHARACTERS", page)
        lines, expected = Lines(text), text.split("\n")
        assert len(lines) == len(expected)
        assert list(lines) == [lines[index] for index in range(len(lines))] == expected
        assert lines[-1] == expected[-1]
        assert lines[start : start + 7] == expected[start : start + 7]
        assert list(lines.since(start)) == expected[start:]
        assert all(part == expected[first : first + len(part)] for first, part in lines.pages(start))
        with pytest.raises(IndexError):
            lines[len(lines)]
