"""Texts of many shapes are read rightly, and are held to what their headers state."""

import gzip
import io
import os
import random
import re
import tarfile
from dataclasses import replace

import numpy as np
import pytest

from rocking_cli.ask.read import read_record
from rocking_cli.errors import InputError
from rocking_cli.excitation.records.record_units import component
from tests import header_files
from tests.conftest import RECORDS
from tests.excitation.test_record_formats import MADE
from tests.header_files import COMPONENTS, COUNT, DT, EAST, FILES, GAL, NORTH, TIME, TextFile

FINDINGS = RECORDS.parent / "findings" / "records"
BY_TEXT = pytest.mark.parametrize("name", [name for name in FILES if name not in header_files.OTHER_READERS])
BY_FILE = pytest.mark.parametrize("name", FILES)
SPOILT = int(os.environ.get("HEADERS", "1000"))


def options(file: TextFile, channel) -> dict:
    return {"channel": channel, "units": file.unit, "dt": file.dt}


@BY_FILE
def test_every_component_of_a_file_is_read(name, write):
    file = FILES[name]
    for channel, component_name in file.channels.items():
        motion = read_record(write(file.text), **options(file, channel))
        assert motion.dt == pytest.approx(DT, rel=1e-9)
        assert header_files.of_values(motion.acceleration, component_name), channel


@BY_FILE
def test_another_interval_than_the_file_states_is_refused_with_both(name, write):
    file = FILES[name]
    channel = next(iter(file.channels))
    if file.dt is None:
        with pytest.raises(InputError) as caught:
            read_record(write(file.text), **{**options(file, channel), "dt": 0.02})
        assert "0.02 s" in str(caught.value) and "0.01 s" in str(caught.value)


@BY_FILE
def test_another_unit_than_the_file_states_is_refused_with_both(name, write):
    file = FILES[name]
    if file.unit is None:
        with pytest.raises(InputError, match="`units` says mm/s2"):
            read_record(write(file.text), **{**options(file, next(iter(file.channels))), "units": "mm/s2"})


@BY_TEXT
def test_a_file_that_was_cut_is_refused_with_both_counts_unless_it_was_cut_on_purpose(name, write):
    file = FILES[name]
    if not file.states_count:
        return
    path = write("".join(file.text.splitlines(keepends=True)[:-10]))
    channel = next(iter(file.channels))
    with pytest.raises(InputError) as caught:
        read_record(path, **options(file, channel))
    assert re.search(r"\b(160|480)\b.*but the file has \d+ points", str(caught.value))
    motion = read_record(path, despite_header=True, **options(file, channel))
    assert motion.npts < COUNT and motion.processing == ("despite header",)
    assert any(each.kind == "count" for each in motion.remarks)
    right = GAL * COMPONENTS[file.channels[channel]][: motion.npts]
    np.testing.assert_allclose(motion.acceleration, right, rtol=0, atol=1.2e-5)


@BY_TEXT
def test_a_stated_peak_is_held_to(name, write):
    file = FILES[name]
    lines = file.text.split("\n")
    for k, line in enumerate(lines[:15]):
        if re.search(r"(?i)pga|max|massima|b.y.k", line):
            lines[k] = re.sub(r"\d+\.\d+", lambda number: f"{1.02 * float(number[0]):.4f}", line)
    changed = "\n".join(lines)
    for channel in file.channels if changed != file.text else ():
        with pytest.raises(InputError, match="the largest of its values is"):
            read_record(write(changed), **options(file, channel))
        motion = read_record(write(changed), despite_header=True, **options(file, channel))
        assert any(each.kind == "header_peak" for each in motion.remarks)


# --- advice ---------------------------------------------------------------------------------------------------------


def obeyed(path, file: TextFile) -> dict:
    """The motions, by channel, that follow from obeying every piece of advice; the user knows unit and interval."""
    known = {"units": file.unit or "gal", "dt": file.dt or DT}
    given, motions = {}, {}
    for _ in range(10):
        try:
            return {None: read_record(path, **given)}
        except InputError as error:
            advice = " ".join(each.hint or "" for each in error.problems)
            places = re.findall(r"\n    (\d+): ([^,\n]*)", advice)
            if "give `run_on`" in advice and file.run_on:
                given["run_on"] = True
            elif "`channel`" in advice and places:
                for place, label in places:
                    inner = dict(given)
                    while True:
                        try:
                            motions[place, label] = read_record(path, channel=place, **inner)
                            break
                        except InputError as more:
                            wanting = [key for key in known if f"`{key}`" in str(more) and key not in inner]
                            assert wanting, str(more)
                            inner |= {key: known[key] for key in wanting}
                return motions
            elif "begin the line with #" in advice:
                lines = path.read_text(encoding="utf-8").split("\n")
                number = error.problems[0].line - 1
                lines[number] = f"# {lines[number]}"
                path.write_text("\n".join(lines), encoding="utf-8")
            elif wanting := [key for key in known if f"`{key}`" in advice and key not in given]:
                given |= {key: known[key] for key in wanting}
            else:
                raise
    raise AssertionError("advice without end")


@BY_FILE
def test_advice_that_is_followed_ends_in_the_right_reading(name, write):
    file = FILES[name]
    found = obeyed(write(file.text), file)
    assert len(found) == len(file.channels)
    order = list(file.channels.values())
    for key, motion in found.items():
        right = order[0] if key is None else order[int(key[0]) - 1]
        assert header_files.of_values(motion.acceleration, right), key
        assert motion.dt == pytest.approx(DT, rel=1e-9)


BARE = {name: file for name, file in FILES.items() if file.text.split("\n")[0].strip()[0].isalpha()}


@pytest.mark.parametrize("name", BARE)
def test_advice_on_a_title_that_begins_with_a_number_ends_in_the_right_reading(name, write):
    file = replace(FILES[name], text=f"5 km south of the town\n2020 January 01\n{FILES[name].text}")
    found = obeyed(write(file.text), file)
    assert len(found) == len(file.channels)
    for motion, right in zip(found.values(), file.channels.values(), strict=True):
        assert header_files.of_values(motion.acceleration, right)


# --- one by one -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "given", "said"),
    [
        ("dt = 0.01\nrate of sampling: 50 sps\nacc g\n", {}, "says 0.02 s.*but 0.01 s in line 1"),
        ("Sampling rate: 50 Hz\ntime,acc [g]\n", {}, "says 0.02 s.*but the times 0.01 s"),
        ("# order: EW NS time\ntime NS EW\n", {"units": "g", "channel": "NS"}, "lines 1 and 2 name the columns"),
        ("time,NS,EW\n", {"units": "g", "channel": "1", "run_on": True}, "`run_on`"),
    ],
)
def test_what_contradicts_itself_is_refused(text, given, said, write):
    columns = (TIME, NORTH, EAST) if "NS" in text else (TIME, NORTH) if "time" in text else (NORTH,)
    between = "," if "," in text else " "
    with pytest.raises(InputError, match=said):
        read_record(write(text + header_files.rows(*columns, between=between)), **given)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        *((f"{label};acc [g]\n", "the time column is in 'ms'") for label in ("tempo (ms)", "zaman [ms]", "t/ms")),
        *((f"{rate}\nacc g\n", "no sample interval") for rate in ("Sampling rate (kHz): 0.1", "Time step: 0.01 min")),
        ("tiempo;acc (g) x 10\n", "does not say what unit"),
        ("Period (s);Sa (g)\n", "as in a spectrum, and no time"),
        ("Frequenza [Hz];acc [g]\n", "as in a spectrum, and no time"),
    ],
)
def test_units_that_are_not_known_are_not_taken_for_others(text, said, write):
    columns = (TIME, NORTH) if ";" in text else (NORTH,)
    with pytest.raises(InputError, match=said):
        read_record(write(text + header_files.rows(*columns, between=";")))


def test_records_that_follow_each_other_are_listed_and_nothing_else_may_follow(write):
    first, second = FILES["ran"].text, FILES["turkish"].text
    path = write(first + second)
    with pytest.raises(InputError, match=r"2 records(?s:.*)1: line 1,(?s:.*)2: line 166,"):
        read_record(path)
    assert header_files.of_values(read_record(path, channel="1").acceleration, "N")
    motion = read_record(path, channel="2:D-B")
    assert motion.name == "record.txt channel 2:D-B" and header_files.of_values(motion.acceleration, "E")
    with pytest.raises(InputError, match="there is no channel 'X'"):
        read_record(path, channel="2:X")
    with pytest.raises(InputError, match="'end' is not a number"):
        read_record(write(first + "end of file\n"))


@pytest.mark.parametrize("name", ["knet", "esm", "smc", "usc_v1", "geonet_v2a"])
def test_nothing_but_another_record_follows_one_of_a_format(name, write):
    make, *_ = MADE[name]
    text = make()
    with pytest.raises(InputError, match=r"only blanks or another record|must begin"):
        read_record(write(text + "\nsome text\n"), channel="1")
    assert read_record(write(text + "\n \n"), channel="1").npts > 2


def test_two_records_of_one_format_are_listed(write):
    make, *_ = MADE["knet"]
    path = write(make() + make().replace("E-W", "N-S"))
    with pytest.raises(InputError, match="holds 2 records"):
        read_record(path)
    assert read_record(path, channel="2").npts == read_record(path, channel="1").npts


@pytest.mark.parametrize("pack", [bytes, gzip.compress])
def test_a_tar_archive_is_named(pack, tmp_path):
    out = io.BytesIO()
    with tarfile.open(fileobj=out, mode="w") as archive:
        archive.addfile(tarfile.TarInfo("a.txt"), io.BytesIO())
    path = tmp_path / "records.tar"
    path.write_bytes(pack(out.getvalue()))
    with pytest.raises(InputError, match="archive"):
        read_record(path)


def test_a_series_without_its_last_values_and_a_table_are_told_apart(write):
    """Of components alike, and of noise, nothing is guessed."""
    noise = np.random.default_rng(5).normal(size=(6, 40))
    with pytest.raises(InputError, match="run on from line to line"):
        read_record(write(header_files.rows(*noise)), units="g", dt=DT)
    motion = read_record(write(header_files.rows(*noise)), units="m/s2", dt=DT, run_on=True)
    np.testing.assert_allclose(motion.acceleration, np.round(noise.T.ravel(), 5), atol=1e-9)
    (doubt,) = read_record(write(header_files.rows(*noise)), units="g", dt=DT, channel="2").remarks
    assert doubt.kind == "run_on" and "nothing tells" in doubt.text
    alike = [NORTH + 0.01 * k for k in range(8)]  # eight sensors on one floor
    assert read_record(write(header_files.rows(*alike)), units="g", dt=DT, channel="3").npts == COUNT


# --- the small files of others --------------------------------------------------------------------------------------

PEAKS = {"N": 0.02281, "E": 0.03032, "U": 0.01115}  # g
RIGHT = [
    ("jma_like.csv", {"channel": "NS"}, "N"),
    ("jma_like.csv", {"channel": "UD"}, "U"),
    ("jma_like.csv", {"channel": "NS", "dt": 0.02}, "`dt` says 0.02 s"),
    ("v1a_like.V1A", {}, "N"),
    ("afad_old_cut.txt", {"channel": "N-S", "units": "gal"}, "400.* 192"),
    ("cwa_like.dat", {"channel": "E:", "units": "gal"}, r"(?s)no channel 'E:'.* U\b.* N\b.* E\b"),
    ("cwa_like.dat", {"channel": "E"}, "E"),
    ("cwa_like.dat", {"channel": "E", "units": "g"}, "unit is gal, but `units` says g"),
    ("dt_in_header.txt", {}, "N"),
    ("dt_in_header.txt", {"dt": 0.02}, r"0\.01 s.*0\.02 s"),
    ("wrong_count_text.csv", {}, r"500.* 400 points"),
    ("knet_two_joined.EW", {}, "2 records"),
    ("run_on_5.g3", {"channel": "1", "units": "g", "dt": DT}, "N"),
    ("deepsoil_like.txt", {"units": "g"}, "N"),
    ("two_horizontals_bare.txt", {"channel": "2", "units": "m/s2", "dt": DT}, "E"),
    ("iso_times.csv", {}, "N"),
    ("slist.txt", {}, "N"),
]


@pytest.mark.parametrize(("name", "given", "right"), RIGHT)
def test_the_small_files_of_others(name, given, right):
    path = FINDINGS / name
    if not path.is_file():
        pytest.skip(f"no records in {FINDINGS}: {name}")
    if right in PEAKS:
        motion = read_record(path, **given)
        assert (motion.npts, motion.dt) == (400, pytest.approx(DT, rel=1e-9))
        assert motion.pga_g == pytest.approx(PEAKS[right], rel=1e-3)
    else:
        with pytest.raises(InputError, match=right):
            read_record(path, **given)


KNOWN = {"run_on_5.g3": "g", "deepsoil_like.txt": "g", "two_horizontals_bare.txt": "m/s2", "v1a_like.V1A": "mm/s2"}


@pytest.mark.parametrize("name", sorted({name for name, *_ in RIGHT}))
def test_advice_on_the_small_files_of_others_ends_rightly(name, write, tmp_path):
    path = FINDINGS / name
    if not path.is_file():
        pytest.skip(f"no records in {FINDINGS}: {name}")
    copy = tmp_path / name
    copy.write_bytes(path.read_bytes())
    if name in ("afad_old_cut.txt", "wrong_count_text.csv"):  # nobody can know what is missing
        with pytest.raises(InputError, match=r"400.*192|500.*400"):
            obeyed(copy, TextFile("", unit="gal", dt=DT))
        return
    found = obeyed(copy, TextFile("", unit=KNOWN.get(name), dt=DT, run_on=name == "run_on_5.g3"))
    peaks = [*PEAKS.values(), 0.0119, 0.2495]  # the last two are those of the K-NET file
    for motion in found.values():
        assert (motion.npts, motion.dt) == (400, pytest.approx(DT, rel=1e-9))
        assert min(abs(motion.pga_g / peak - 1) for peak in peaks) < 2e-3


# --- spoilt headers -------------------------------------------------------------------------------------------------


def wrongs(path, seed: int) -> list[str]:
    """What of a file with a spoilt header is read otherwise than its intact lines state."""
    spoilt, rng = header_files.spoilt(seed), random.Random(-seed)
    path.write_text(spoilt.text, encoding="utf-8")
    channel = rng.choice((*spoilt.names, *spoilt.names, "1", "2", "3", None))
    dt, units = rng.choice((None, 0.01, 0.01, 0.02)), rng.choice((None, "gal", "gal", "g", "m/s2"))
    try:
        motion = read_record(path, dt=dt, units=units, channel=channel, run_on=rng.random() < 0.05)
    except InputError:
        return []
    wrong = []
    claims = spoilt.claims
    if "rate" in claims and abs(motion.dt - DT) > 1e-9:
        wrong.append(f"interval {motion.dt}")
    if "count" in claims and motion.npts != COUNT:
        wrong.append(f"count {motion.npts}")
    if "unit" in claims and motion.source_unit not in ("gal", "cm/s2"):
        with pytest.raises(InputError) as caught:  # where the header names two, the user chooses
            read_record(path, dt=dt, channel=channel)
        if "more than one unit" not in str(caught.value):
            wrong.append(f"unit {motion.source_unit}")
    if spoilt.shape == "running on" and motion.npts < 80 and not motion.remarks:
        wrong.append(f"rows of {motion.npts}")
    called = motion.name.partition(" channel ")[2] or channel
    if "labels" in claims and channel is not None:
        named = component(called) if component(called) in ("north", "east", "up") else None
        place = spoilt.order[int(channel) - 1] if channel.isdigit() else {"n": "N", "e": "E", "u": "U"}[named[0]]
        size = motion.acceleration / motion.acceleration.max() * COMPONENTS[place][: motion.npts].max()
        if not np.allclose(size, COMPONENTS[place][: motion.npts], atol=1e-3):
            wrong.append(f"component {called} for {channel}")
    if "peak" in claims and named_of(called):
        peak = header_files.peak(named_of(called))
        if abs(float(np.abs(motion.acceleration).max()) / GAL - peak) > 0.02 * peak:
            wrong.append(f"peak of {called}")
    return wrong


def named_of(label) -> str | None:
    return {"north": "N", "east": "E", "up": "U"}.get(component(label) if label else None)


@pytest.mark.every(20)
@pytest.mark.parametrize("block", range(4))
def test_no_spoilt_header_is_read_otherwise_than_its_intact_lines_state(block, tmp_path):
    seeds = range(block, SPOILT, 4)
    found = {seed: wrong for seed in seeds if (wrong := wrongs(tmp_path / "spoilt.txt", seed))}
    assert not found
