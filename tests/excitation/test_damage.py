"""Damaged record files are refused or doubted, files that an editor has saved are not, and hostile ones do no harm."""

import os
import re
import tracemalloc
import warnings
from pathlib import Path

import numpy as np
import pytest

from rocking_cli.ask.read import read_record
from rocking_cli.errors import InputError
from rocking_cli.excitation.base import STANDARD_GRAVITY as G
from rocking_cli.excitation.base import Doubt, GroundMotion
from rocking_cli.excitation.doubts import doubts
from rocking_cli.excitation.measures import measure
from rocking_cli.excitation.records import usc as usc_v1
from rocking_cli.excitation.records.record_units import Asked
from tests.damage import CHANGES, MOST_SILENT, REAL, Kind, Read, read, survey
from tests.excitation.test_record_formats import (
    MADE,
    VALUES,
    columns,
    cosmos,
    csmip,
    esm,
    geonet,
    knet,
    problem,
    simcenter,
    smc,
    usc,
)

TIMES = int(os.environ.get("DAMAGE", "25"))
HUGE = "9" * 5000

t = np.arange(240)
SMOOTH = np.round(9 * np.sin(t / 7) * np.exp(-(((t - 120) / 60) ** 2)) + 2 * np.sin(t / 3 + 1), 3)


def at2(values=SMOOTH) -> str:
    head = f"PEER DATABASE\nMade up\nACCELERATION IN UNITS OF G\nNPTS= {len(values)}, DT= .01 SEC\n"
    return head + columns(values / 100, "15.6E", 5)


def table(values=SMOOTH, form="{:8.3f}{:12.6f}") -> str:
    return "t  accel_g\n" + "".join(form.format(0.1 * k, value) + "\n" for k, value in enumerate(values))


def printed_json(values=SMOOTH, count: int | None = None) -> str:
    numbers = ",\n".join(f"{value:.6E}" for value in values)
    count = len(values) if count is None else count
    return f'{{"info": "UNITS OF G", "numPoints": {count}, "dT": 0.01,\n"accel_data": [\n{numbers}\n]}}\n'


MADE_UP = {
    **{name: make for name, (make, *_) in MADE.items() if name not in ("simcenter", "knet", "cosmos")},
    "knet": lambda values: knet(values, duration=len(values)),
    "cosmos": lambda values: cosmos(values, length=2),
    "simcenter": printed_json,
    "peer_at2": at2,
    "text in columns": table,
    "text": lambda values: table(values, "{:.3f},{:.7E}"),
}
BY_MADE = pytest.mark.parametrize("name", MADE_UP)
BY_REAL = pytest.mark.parametrize("path", REAL, ids=lambda path: path.name)


# --- one character lost ---------------------------------------------------------------------------------------------


@pytest.mark.every(12)
@BY_REAL
def test_a_character_lost_from_a_real_record_is_seldom_silent(path, tmp_path):
    if not path.is_file():
        pytest.skip(f"no real records in {path.parent} (ROCKING_RECORDS): {path.name}")
    content = path.read_bytes().decode("latin-1")
    found, silent = survey(content, REAL[path], tmp_path, TIMES if len(content) < 300_000 else max(TIMES // 4, 10))
    assert found["silent"] <= MOST_SILENT * found.total(), (found, silent)
    assert found["refused"] + found["doubted"] > found.total() / 2


@pytest.mark.every(6)
@BY_MADE
def test_a_character_lost_from_a_made_file_is_seldom_silent(name, tmp_path):
    content = MADE_UP[name](SMOOTH)
    last = content.count("\n") - (2 if name == "simcenter" else 1)
    while content.split("\n")[last - 1].startswith("/&"):
        last -= 1
    kind = Kind({"channel": "1"}, _accelerations(name, content), last)
    found, silent = survey(content, kind, tmp_path, TIMES)
    assert found["silent"] <= MOST_SILENT * found.total(), (found, silent)


def _accelerations(name: str, content: str) -> int:
    """Line number of the first accelerations."""
    start = {"peer_at2": "NPTS", "text": "accel", "text in columns": "accel", "simcenter": "accel_data", "knet": "Memo"}
    start |= {"esm": "USER5", "csmip_v2": "POINTS OF ACCEL", "cosmos": "pts,"}
    start |= {"smc": "| 1"}
    lines = content.split("\n")
    if name in start:
        return max(k for k, line in enumerate(lines, 2) if start[name] in line)
    first = {"geonet_v2a": columns(SMOOTH[:10], "8.2f", 10), "usc_v1": columns([0.0, SMOOTH[0]], "7.3f", 10, " ")}
    return next(k for k, line in enumerate(lines, 1) if line.startswith(first[name].rstrip("\n")))


@pytest.mark.parametrize("change", [name for name in CHANGES if "line" in name])
@pytest.mark.parametrize("name", [name for name in MADE_UP if name != "simcenter"])
def test_a_line_too_few_or_too_many_is_refused(name, change, tmp_path):
    content = MADE_UP[name](SMOOTH)
    first = _accelerations(name, content)
    # The first row of a text is but the start of the record.
    found, _ = survey(content, Kind({"channel": "1"}, first + 1, first + 7), tmp_path, 6, CHANGES[change])
    assert found["refused"] == 6


# --- columns --------------------------------------------------------------------------------------------------------


def refused(content: str, tmp_path: Path, **options):
    return motion_of(content, tmp_path, how=problem, **options)


def motion_of(content: str, tmp_path: Path, how=read_record, **options):
    path = tmp_path / "record.txt"
    path.write_text(content, encoding="utf-8")
    return how(path, **options)


@pytest.mark.parametrize(
    ("content", "width"),
    [
        (csmip(SMOOTH, names=("UP",)), 10),  # nothing around the numbers
        (usc(SMOOTH), 7),  # a margin
        (knet(SMOOTH, duration=240), 9),  # blanks after them
    ],
    ids=["csmip", "usc", "knet"],
)
def test_a_row_that_leaves_its_columns_is_named(content, width, tmp_path):
    lines = content.split("\n")
    row = max(k for k, line in enumerate(lines) if re.fullmatch(r"[\s\dE.+-]{30,}", line)) - 5
    for place in (0, len(lines[row]) // 2, len(lines[row].rstrip()) - 1):
        changed = [*lines[:row], lines[row][:place] + lines[row][place + 1 :], *lines[row + 1 :]]
        found = refused("\n".join(changed), tmp_path, channel="1")
        assert f"do not end at their columns of {width} characters" in found.message
        assert found.line == row + 1 and found.excerpt and "lost" in found.hint


def test_a_row_of_at2_that_leaves_the_columns_of_the_others_is_named(tmp_path):
    lines = at2().split("\n")
    lines[20] = lines[20].replace("-", "", 1)
    found = refused("\n".join(lines), tmp_path)
    assert found.line == 21
    assert "columns of the other rows" in found.message


def test_at2_without_columns_is_read_as_ever(tmp_path):
    free = at2().split("\n")
    free[4:] = [" ".join(line.split()) for line in free[4:]]
    assert motion_of("\n".join(free), tmp_path).remarks == ()
    rows = [line.split() for line in at2().split("\n")[4:-1]]
    rows[5:5] = [[number] for number in rows.pop(5)]  # one row in five
    assert motion_of("\n".join([*at2().split("\n")[:4], *map(" ".join, rows)]), tmp_path).npts == 240


def unexpanded(text: str, every: int) -> str:
    """Tabs in place of blanks, as editors and `unexpand` save them."""
    lines = []
    for line in text.split("\n"):
        cells = [line[k : k + every] for k in range(0, len(line), every)]
        lines.append("".join(re.sub(" {2,}$", "\t", cell) if len(cell) == every else cell for cell in cells))
    return "\n".join(lines)


def each_line(change):
    return lambda text: "\n".join(change(line) for line in text.split("\n"))


EDITORS = {
    "blanks after rows": each_line(str.rstrip),
    "blanks before rows": each_line(lambda line: line.lstrip(" ")),
    "CRLF": lambda text: text.replace("\n", "\r\n"),
    "CR": lambda text: text.replace("\n", "\r"),
    "no newline at the end": lambda text: text.rstrip("\n"),
    "tabs of 8": lambda text: unexpanded(text, 8),
    "a tab for blanks": lambda text: re.sub(" {2,}", "\t", text),
    "tabs, and blanks around rows": lambda text: re.sub(" {2,}", "\t", each_line(str.strip)(text)),
}
BY_EDITOR = pytest.mark.parametrize("editor", EDITORS)


@pytest.mark.every(5)
@BY_EDITOR
@BY_MADE
def test_a_made_file_that_an_editor_has_saved_is_read(name, editor, tmp_path):
    _same_after_saving(MADE_UP[name](SMOOTH), Kind({"channel": "1"}, 1), editor, tmp_path)


@pytest.mark.every(10)
@BY_EDITOR
@BY_REAL
def test_a_real_record_that_an_editor_has_saved_is_read(path, editor, tmp_path):
    if not path.is_file():
        pytest.skip(f"no real records in {path.parent} (ROCKING_RECORDS): {path.name}")
    content = path.read_bytes().decode("latin-1").replace("\r\n", "\n")
    _same_after_saving(content, REAL[path], editor, tmp_path)


WHOLE: dict[object, object] = {}  # as they were before an editor saved them


def _same_after_saving(content: str, kind: Kind, editor: str, tmp_path: Path) -> None:
    key = (content, *kind.options.items())
    if key not in WHOLE:
        WHOLE[key] = read(content, tmp_path, kind.options)
    whole = WHOLE[key]
    found = read(EDITORS[editor](content), tmp_path, kind.options)
    assert isinstance(whole, Read), whole
    assert isinstance(found, Read), found
    np.testing.assert_array_equal(found.acceleration, whole.acceleration)
    assert found.dt == whole.dt
    assert found.kinds - whole.kinds <= {"columns"}


def test_that_columns_are_gone_is_said_with_the_number_of_rows(tmp_path):
    motion = motion_of(EDITORS["blanks before rows"](csmip(SMOOTH, names=("UP",))), tmp_path)
    (doubt,) = motion.remarks
    assert (doubt.kind, doubt.value) == ("columns", 30) and "30 of its 30 rows" in doubt.text
    assert doubt in doubts(motion, measure(motion))
    assert motion.scaled(2).remarks == motion.remarks


def test_numbers_that_touch_need_their_columns(tmp_path):
    content = csmip(np.abs(SMOOTH) + 1e5, names=("UP",))
    saved = EDITORS["blanks before rows"](content)
    assert motion_of(content, tmp_path).npts == 240
    lines = saved.split("\n")
    first = next(k for k, line in enumerate(lines) if "POINTS OF ACCEL" in line) + 1
    lines[first : first + 30] = [line[1:] for line in lines[first : first + 30]]
    found = refused("\n".join(lines), tmp_path)
    assert found.line == first + 1
    assert "numbers that touch cannot be told apart" in found.hint


# --- digits ---------------------------------------------------------------------------------------------------------


def kinds(motion: GroundMotion) -> set[str]:
    return {each.kind for each in motion.remarks}


def of_numbers(numbers, tmp_path):
    return motion_of("accel_g\n" + "\n".join(numbers) + "\n", tmp_path, dt=0.01)


def test_a_number_with_a_digit_less_is_doubted_with_its_line(tmp_path):
    numbers = [f"{value:.4f}" for value in SMOOTH]
    numbers[100] = numbers[100][:-1]
    numbers[200] = numbers[200][:-2]
    (doubt,) = of_numbers(numbers, tmp_path).remarks
    assert (doubt.kind, doubt.value) == ("digits", 102)
    assert f"'{numbers[100]}' in line 102, and 1 more, is printed with other digits" in doubt.text


@pytest.mark.parametrize("damage", ["1234567", ".234567E-2", "1.23456E-2", "1.234567E2", "1.234567E-"])
def test_numbers_with_exponents_have_a_form_too(damage, tmp_path):
    numbers = [f"{value:.6E}" for value in SMOOTH]
    numbers[100] = damage
    try:
        assert kinds(of_numbers(numbers, tmp_path)) == {"digits"}
    except InputError as error:
        assert damage == "1.234567E-", error


@pytest.mark.parametrize(
    "numbers",
    [
        [repr(float(value) / 7) for value in SMOOTH],
        [f"{value:.6g}" for value in SMOOTH],
        [f"{value:#.6g}" for value in SMOOTH * 3],  # as many digits of each, wherever the point is
        [f"{value:#.6g}" for value in [*np.linspace(0.1, 0.9, 200), 1.5, 2.5, 3.5]],  # few of them beyond one
        [f"{value:.3f}".rstrip("0") for value in SMOOTH],
        [f"{value:.3f}" for value in np.arange(100, 400) / 1000 if f"{value:.3f}"[-1] != "0"] + ["0.25", "0.5"],
        ["0", "0.0", *(f"{value:.6f}" for value in SMOOTH)],
        [f"{value:.6E}".replace("0.", ".") for value in SMOOTH],
    ],
)
def test_other_ways_to_print_numbers_raise_no_doubt(numbers, tmp_path):
    assert of_numbers(numbers, tmp_path).remarks == ()


def test_a_row_of_text_that_leaves_its_columns_is_doubted(tmp_path):
    lines = table().split("\n")
    negative = next(k for k, line in enumerate(lines) if k > 100 and "-" in line)
    lines[negative] = lines[negative].replace("-", "")
    (doubt,) = motion_of("\n".join(lines), tmp_path).remarks
    assert (doubt.kind, doubt.value) == ("columns", negative + 1)


def test_text_parted_by_single_blanks_has_no_columns(tmp_path):
    assert motion_of(table(SMOOTH, "{:.3f} {:.6f}"), tmp_path).remarks == ()
    assert motion_of(table(np.abs(SMOOTH) - 0.01, "{:8.3f} {:.6f}"), tmp_path).remarks == ()  # a few are negative
    lines = table(np.tile(SMOOTH, 5)[:1010], "{:.2f}{:12.6f}").split("\n")
    text = "\n".join([" made up", lines[0], *lines[101:]])  # from 10 s on, a few from 100 s
    assert motion_of(text, tmp_path).remarks == ()


# --- what headers say -----------------------------------------------------------------------------------------------


def with_peak(stated: str) -> str:
    """A CSMIP V2 file that states a peak."""
    return csmip(names=("UP",)).replace(
        " 11 POINTS OF ACCEL", f"PEAK ACCELERATION =  {stated} SEC.\n 11 POINTS OF ACCEL"
    )


@pytest.mark.parametrize(
    ("content", "kind", "value"),
    [
        (esm().replace("PGA_CM/S^2: 10.0", "PGA_CM/S^2: 10.1"), "header_peak", 10),
        (esm().replace("STREAM", "TIME_PGA_S: 0.20\nSTREAM"), "header_time", 0.09),
        (esm().replace("STREAM", "DURATION_S: 0.25\nSTREAM"), "header_length", 0.11),
        (geonet(names=("Up",)).replace("peak    10.00", "peak   -10.05"), "header_peak", 10),
        (geonet(names=("Up",)).replace("Duration 0.10", "Duration 0.20"), "header_length", 0.10),
        (knet().replace("Max. Acc. (gal)   9.6", "Max. Acc. (gal)   9.5"), "header_peak", 9.613636),
        (usc().replace("0.100 SEC", "0.150 SEC"), "header_length", 0.10),
        (with_peak("-9.950    CM/SEC/SEC  AT  .090"), "header_peak", 10),
        (with_peak("-10.000    CM/SEC/SEC  AT  .900"), "header_time", 0.09),
    ],
)  # fmt: skip
def test_a_header_that_contradicts_its_values_is_doubted(content, kind, value, tmp_path):
    (doubt,) = motion_of(content, tmp_path).remarks
    assert doubt.kind == kind
    assert doubt.value == pytest.approx(value, rel=1e-5)
    assert re.search(r"line \d+ of its header states", doubt.text)


def test_the_headers_of_cosmos_and_smc_state_their_peaks(tmp_path):
    content = cosmos()
    for reals, expected in (({63: 10.0, 64: 0.09}, set()), ({63: -9.9, 64: 0.09}, {"header_peak"})):
        assert kinds(motion_of(_cosmos_reals(content, reals), tmp_path)) == expected
    assert kinds(motion_of(_cosmos_reals(content, {63: 10.0, 64: 0.5}), tmp_path)) == {"header_time"}
    for reals, expected in (
        ({28: 0.09, 29: 10.0, 30: 0.1, 31: -7.0}, set()),
        ({28: 0.09, 29: 5.0, 30: 0.1, 31: -7.0}, {"header_peak"}),
        ({28: 0.9, 29: 10.0}, {"header_time"}),
    ):
        assert kinds(motion_of(_smc_reals(reals), tmp_path)) == expected


def _cosmos_reals(content: str, changed: dict[int, float]) -> str:
    reals = [-999.0] * 100
    reals[33], reals[61] = 0.5, 10.0
    old = columns(reals, "13.6f", 6)
    for place, value in changed.items():
        reals[place] = value
    assert old in content
    return content.replace(old, columns(reals, "13.6f", 6))


def _smc_reals(changed: dict[int, float]) -> str:
    reals = [1.7e38] * 50
    reals[1] = 100.0
    old = columns(reals, "15.7E", 5)
    for place, value in changed.items():
        reals[place] = value
    return smc().replace(old, columns(reals, "15.7E", 5))


def test_a_peak_is_compared_to_the_digits_of_its_header(tmp_path):
    values = VALUES * 1.04999  # 10.4999
    for printed, expected in (("10.5", set()), ("10.4", set()), ("10.7", {"header_peak"}), ("-10.50", set())):
        content = re.sub(r"PGA_CM/S\^2: \S+", f"PGA_CM/S^2: {printed}", esm(values))
        assert kinds(motion_of(content, tmp_path)) == expected
    assert kinds(motion_of(re.sub(r"PGA_CM/S\^2: \S+", "PGA_CM/S^2: ", esm(values)), tmp_path)) == set()


def test_the_unit_and_its_code_must_agree_in_cosmos(tmp_path):
    found = refused(cosmos(unit="m/sec2(04)"), tmp_path)
    assert "the unit is m/s2, but its code (04) stands for cm/s2" in found.message
    assert motion_of(cosmos(unit="g(02)"), tmp_path).source_unit == "g"


def test_the_histories_of_a_channel_have_one_interval(tmp_path):
    content = csmip(names=("UP",)).replace("AT  .010 SEC", "AT  .10 SEC", 1)
    found = refused(content, tmp_path)
    assert "the interval is 0.01 s, but that of its accelerations 0.1 s" in found.message
    assert "VELOC" in found.excerpt


class TestSimCenter:
    def test_a_value_less_than_it_says_is_doubted(self, tmp_path):
        (doubt,) = motion_of(printed_json(count=241), tmp_path).remarks
        assert (doubt.kind, doubt.value) == ("count", 241)
        assert motion_of(printed_json(), tmp_path).remarks == ()
        for count in (239, 242):
            assert f"numPoints = {count}" in refused(printed_json(count=count), tmp_path).message

    @pytest.mark.parametrize("points", ['"240"', "null", "true", HUGE])
    def test_a_number_of_points_that_is_none(self, points, tmp_path):
        content = printed_json().replace('"numPoints": 240', f'"numPoints": {points}')
        assert "numPoints = " in refused(content, tmp_path).message

    def test_what_no_program_writes(self, tmp_path):
        found = refused(simcenter([0, 1]).replace(" 0,", f" {HUGE},"), tmp_path)
        assert "value 1 is not a finite number: Infinity" in found.message
        half = '{"accel_data": [0.1, "\\ud800"], "dT": 0.01, "info": "UNITS OF G \\ud800"}'
        assert r'not a finite number: "\ud800"' in refused(half, tmp_path).message
        assert "positive, this is Infinity" in refused(simcenter().replace("0.01", HUGE), tmp_path).message
        assert motion_of(half.replace('"\\ud800"]', "0.2]"), tmp_path).npts == 2


# --- samples --------------------------------------------------------------------------------------------------------


def found_in(values: np.ndarray) -> list[Doubt]:
    motion = GroundMotion("made", 0.01, values, unit="m/s2")
    return [each for each in doubts(motion, measure(motion)) if each.kind in ("spike", "dropout")]


class TestSamples:
    def test_a_lost_sign_stands_alone(self):
        values = SMOOTH.copy()
        values[115] *= -1
        (doubt,) = found_in(values * G)
        assert (doubt.kind, doubt.value) == ("spike", pytest.approx(1.15))
        assert f"sample 116, at 1.15 s, stands alone: {values[115]:.3g} g" in doubt.text
        stated = float(re.search(r"make (\S+) g", doubt.text)[1])
        assert stated == pytest.approx(SMOOTH[115], abs=0.2)

    def test_several_are_counted_and_the_worst_is_named(self):
        values = SMOOTH.copy()
        values[60] += 1
        values[115] += 3
        (doubt,) = found_in(values)
        assert "sample 116" in doubt.text and "and 1 more like it" in doubt.text

    @pytest.mark.parametrize(
        "values",
        [
            SMOOTH,
            np.random.default_rng(3).normal(size=3000),
            np.repeat([0.0, 1.0, -1.0, 0.0], 60),  # steps
            np.interp(np.arange(240), [0, 60, 120, 180, 239], [0, 1, -1, 0, 0]),  # corners
            np.concatenate([np.zeros(100), np.sin(np.arange(63) / 10), np.zeros(100)]),
            np.concatenate([np.arange(400) % 7 / 1000, np.full(6, 0.02), np.arange(400) % 7 / 1000, SMOOTH]),  # quiet
            np.zeros(100),
        ],
    )
    def test_what_is_sound_raises_no_doubt(self, values):
        assert found_in(values) == []

    def test_values_that_were_lost(self):
        values = SMOOTH.copy()
        values[97:103] = 0
        (doubt,) = [each for each in found_in(values) if each.kind == "dropout"]
        assert doubt.value == pytest.approx(0.97)
        assert "6 samples from 0.97 s on are all 0 g" in doubt.text


# --- hostile files --------------------------------------------------------------------------------------------------


HOSTILE = {
    "number of points, AT2": at2().replace("NPTS= 240", f"NPTS= {HUGE}"),
    "number of points, CSMIP V2": csmip(names=("UP",)).replace(" 11 POINTS", f" {HUGE} POINTS"),
    "counts, GeoNet": geonet(names=("Up",)).replace("      11      11", f" 11 {HUGE}"),
    "number of points, ESM": esm().replace("NDATA: 11", f"NDATA: {HUGE}"),
    "number of points, COSMOS": cosmos().replace("   11  acc", f"   {HUGE}  acc"),
    "header values, COSMOS": cosmos().replace(" 100 Int", f" {HUGE} Int"),
    "width, COSMOS": cosmos().replace("(10I8)", f"(10I{HUGE})"),
    "width 0, COSMOS": cosmos().replace("(8F10.5)", "(8F0.5)"),
    "width, CSMIP V2": csmip(names=("UP",), unit=f"(UNITS: CM/SEC/SEC) (8F{HUGE}.3)"),
    "duration, K-NET": knet(duration="1E29"),
    "scale, K-NET": knet(scale=f"2000(gal)/0.{'0' * 300}1"),
    "far times": usc(times=[*0.01 * np.arange(10), 99999.0]),
    "times beyond numbers": usc().replace("  0.100 -7.000", "   1e29 -7.000"),
    "interval, AT2": at2().replace("DT= .01", "DT= 1e-300"),
    "rate, SMC": smc(rate=1e-20),
    "a long line": at2() + "x" * 1_200_000,
}


@pytest.mark.parametrize("name", HOSTILE)
def test_hostile_headers_are_refused_in_a_few_words(name, tmp_path):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = refused(HOSTILE[name], tmp_path)
    assert found.file
    assert len(str(found)) < 800
    # A film's points are said by number, among the lines that they are on.
    assert found.line is not None or "among lines" in found.hint


def test_a_small_film_makes_no_large_motion():
    content = usc(times=[*0.01 * np.arange(10), 999.0]).replace("  0.090 10.000", "  0.091 10.000")
    tracemalloc.start()
    try:
        assert usc_v1.read(content, "film", Asked()).npts == 999_001
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert peak < 60_000_000


def test_what_a_message_quotes_is_cut(tmp_path):
    found = refused("t,accel_g\n0,1\n0.01,2" + "x" * 100_000 + "\n", tmp_path)
    assert len(found.message) < 600 and len(found.excerpt) < 120


# --- the commands ---------------------------------------------------------------------------------------------------
