"""`rocking select` as a user runs it: with records of known spectra, and with everything that can be wrong."""

import json
import re
from pathlib import Path

import numpy as np
import pytest
import yaml
from click.testing import CliRunner
from scipy.signal import lsim

import rocking_cli as rk
from rocking_cli.ask.read import read_record
from rocking_cli.cli.main import main
from rocking_cli.excitation.base import STANDARD_GRAVITY as G
from rocking_cli.processing.reading import Reading
from rocking_cli.processing.record_list import read_list
from tests.cli.test_cli import run, run_json, some
from tests.conftest import NEEDS_RECORDS, RECORDS

TARGET = "period [s],Sa [g]\n0,0.3\n0.15,0.75\n0.5,0.75\n1,0.375\n2,0.1875\n4,0.046875\n"
ASKED = ("--target", "code.csv", "--band", "0.2:2")


def peer(name: str, event: str, seed: int, size: float = 0.3) -> None:
    """Coloured noise under an envelope, in a file of PEER's."""
    rng = np.random.default_rng(seed)
    time = np.arange(512) * 0.02
    noise = np.fft.rfft(rng.standard_normal(time.size) * (time / 2) ** 2 * np.exp(-time / 2.5))
    f = np.fft.rfftfreq(time.size, 0.02)
    values = np.fft.irfft(noise * (f / 0.6) ** 2 / (1 + (f / 0.6) ** 2) / (1 + f / 4) ** 1.2, time.size)
    values *= size / np.abs(values).max()
    lines = ["PEER NGA STRONG MOTION DATABASE RECORD", f"{event}, 1/17/1994, Station {seed}, 228",
             "ACCELERATION TIME SERIES IN UNITS OF G", f"NPTS= {time.size}, DT= .0200 SEC"]  # fmt: skip
    rows = ["".join(f"{value:15.7E}" for value in row) for row in values.reshape(-1, 4)]
    Path(name).write_text("\n".join([*lines, *rows, ""]))


@pytest.fixture(autouse=True)
def files(_in_an_empty_folder, tmp_path):
    (tmp_path / "code.csv").write_text(TARGET)
    for k in range(7):
        peer(f"r{k}.AT2", f"Quake {k // 2}", seed=k)
    return tmp_path


def listed_in(file: str) -> list[dict]:
    return yaml.safe_load(Path(file).read_text())["records"]


def assert_same_motions(list_file: str, csv_files: list[str]) -> None:
    """A list names the motions that the clean files beside it hold."""
    named = [each.settled(Reading())[0] for each in read_list(Path(list_file))]
    for one, other in zip(named, map(read_record, csv_files), strict=True):
        np.testing.assert_allclose(one.acceleration, other.acceleration, rtol=1e-9, atol=1e-12)
        assert one.dt == pytest.approx(other.dt, rel=1e-12)


def sa(motion, period: float, damping: float = 0.05) -> float:
    """Pseudo-acceleration [g] by a solver of linear systems, at the samples and for a period after them."""
    w = 2 * np.pi / period
    ground = np.concatenate([motion.acceleration, np.zeros(int(period / motion.dt) + 2)])
    system = ([[0, 1], [-w * w, -2 * damping * w]], [[0], [-1]], [[1, 0]], [[0]])
    _, x, _ = lsim(system, ground, np.arange(ground.size) * motion.dt)
    return float(w * w * np.abs(x).max() / G)


def test_the_numbers_are_those_of_the_written_records():
    found = run_json("select", "r*.AT2", *ASKED, "--count", 3, "-o", "set")
    assert list(found) == [
        "target", "band", "within", "damping", "seed", "one_per", "silent", "exact", "fits", "least", "most", "records",
        "spectrum", "left_out", "verdict", "given",
    ]  # fmt: skip
    assert (found["target"], found["band"], found["within"]) == ("code.csv", [0.2, 2.0], [0.9, 1.3])
    assert (found["damping"], found["seed"], found["exact"], found["silent"]) == (0.05, 0, True, 0)
    events = [each["event"] for each in found["records"]]
    assert len(set(events)) == 3
    motions = [read_record(f"set/{each['name'].removesuffix('.AT2')}.csv") for each in found["records"]]
    for each, motion in zip(found["records"], motions, strict=True):
        own = read_record(each["file"])
        np.testing.assert_allclose(motion.acceleration, each["factor"] * own.acceleration, rtol=1e-12, atol=1e-15)
        assert each["pga_g"] == pytest.approx(motion.pga_g)
        assert each["station"] == own.origin.station
    spectrum = {key: np.array(values) for key, values in found["spectrum"].items()}
    points = np.loadtxt("code.csv", delimiter=",", skiprows=1).T
    np.testing.assert_allclose(spectrum["target"], np.interp(spectrum["period"], *points))
    for k in range(20, len(spectrum["period"]), 9):
        mean = np.mean([sa(motion, spectrum["period"][k]) for motion in motions])
        assert spectrum["mean"][k] == pytest.approx(mean, rel=0.01)  # which sees peaks at samples alone
    ratio = spectrum["mean"] / spectrum["target"]
    assert (found["least"], found["most"]) == pytest.approx((ratio.min(), ratio.max()))
    assert found["fits"] == (ratio.min() >= 0.9 and ratio.max() <= 1.3)


def test_the_list_gives_the_same_motions_as_the_folder():
    run("select", "r*.AT2", *ASKED, "--count", 3, "-o", "out/set")
    listed = listed_in("out/set/set.yaml")
    assert all(each["file"].startswith("../../r") for each in listed)
    assert {"file", "factor", "event", "station"} == set(listed[0])
    assert_same_motions("out/set/set.yaml", [f"out/set/{Path(each['file']).stem}.csv" for each in listed])
    again = run_json("select", "out/set/set.yaml", *ASKED, "--count", 3)  # a list is as good as files
    assert [each["event"] for each in again["records"]] == [each["event"] for each in listed]
    assert [each["factor"] for each in again["records"]] == pytest.approx([1.0] * 3)


def test_how_records_were_read_is_in_the_list(files):
    times = np.arange(512) * 0.02
    for k in range(2):
        values = 100 * np.sin(times * (4 + 3 * k)) * np.exp(-times / 5)
        table = np.column_stack([times, values, -values])
        np.savetxt(f"c{k}.txt", table, fmt="%.6f", delimiter=",", header="t,x,y", comments="")
    words = ("--dt", "0.02", "--units", "cm/s2", "--channel", "2")
    run("select", "c*.txt", *ASKED, "--count", 2, "-o", "set", "--factors", "0.01:100", *words)
    listed = listed_in("set/set.yaml")
    assert [each["file"] for each in listed] == ["../c0.txt", "../c1.txt"]
    for each in listed:
        assert (each["dt"], each["units"], each["channel"]) == (0.02, "cm/s2", "2")
    assert_same_motions("set/set.yaml", ["set/c0-y.csv", "set/c1-y.csv"])

    assert read_record("set/c0-y.csv").prepared_from == "c0.txt channel y"


def test_a_list_says_of_which_earthquake_a_record_is():
    records = [{"file": f"r{k}.AT2", "event": "The same", "station": "Elsewhere"} for k in (1, 3)]
    Path("list.yaml").write_text(yaml.safe_dump({"records": [*records, {"file": "r5.AT2"}]}))
    found = run_json("select", "list.yaml", *ASKED, "--count", 2)
    assert [each["event"] for each in found["records"]][1] == "Quake 2"
    assert found["records"][0]["event"] == "The same"
    assert "one per event leaves 2" in run("select", "list.yaml", *ASKED, "--count", 3, code=2).stderr


def test_another_set_takes_the_place_of_the_one_before(files):
    run("select", "r*.AT2", *ASKED, "--count", 4, "-o", "set")
    assert len(list(files.glob("set/*.csv"))) == 4
    told = run("select", "r*.AT2", *ASKED, "--count", 2, "-o", "set").stderr
    assert len(list(files.glob("set/*.csv"))) == 2
    assert "of an earlier set removed" in told
    before = {path.name: path.read_bytes() for path in files.glob("set/*")}
    (files / "set/mine.csv").write_text("t [s],a [m/s2]\n0,0\n1,1\n")
    assert "mine.csv" in run("select", "r*.AT2", *ASKED, "--count", 3, "-o", "set", code=2).stderr
    (files / "set/mine.csv").unlink()
    assert {path.name: path.read_bytes() for path in files.glob("set/*")} == before  # nothing was touched


@pytest.mark.parametrize(
    ("prepare", "message"),
    [
        (lambda place: (place / "set.yaml").write_text("records: []\n"), "did not write"),
        (lambda place: (place / "r1.csv").write_text("1\n2\n"), "r1.csv"),
        (lambda place: (place / "set.yaml").mkdir(), "this is a folder"),
    ],
)
def test_what_it_did_not_write_is_not_replaced(files, prepare, message):
    (files / "set").mkdir()
    prepare(files / "set")
    before = sorted(path.name for path in files.glob("set/*"))
    assert message in run("select", "r*.AT2", *ASKED, "--count", 3, "-o", "set", code=2).stderr
    assert sorted(path.name for path in files.glob("set/*")) == before


def test_the_folder_of_the_records_is_not_written_into(files):
    said = run("select", "r*.AT2", *ASKED, "--count", 2, "-o", ".", code=2).stderr
    assert "--out is the folder of an input file" in said
    assert not (files / "set.yaml").exists()


def test_a_bad_record_keeps_no_good_one_back(files):
    (files / "r9.AT2").write_text("nothing\n")
    result = some("select", "r*.AT2", "none.AT2", *ASKED, "--count", 2, "--json")
    found = json.loads(result.stdout)
    assert len(found["records"]) == 2
    assert {"file": "r9.AT2", "name": None, "why": "it cannot be used"} in found["left_out"]
    assert "none.AT2" in result.stderr
    assert "r9.AT2" in result.stderr


def test_the_target_is_no_record():
    assert "code.csv is the target" in run("select", "*.AT2", "code.csv", *ASKED, "--count", 2).stderr
    assert "no records to choose from" in run("select", "code.csv", *ASKED, "--count", 2, code=2).stderr


def test_standard_input_is_kept_as_what_it_gave(files):
    text = (files / "r1.AT2").read_text()
    words = ["select", "-", "r3.AT2", *ASKED, "--count", "2", "-o", "set"]
    result = CliRunner().invoke(main, words, input=text)
    assert result.exit_code == 0, result.output
    listed = listed_in("set/set.yaml")
    assert listed[0] == {"file": "standard-input.csv"}
    assert read_record("set/standard-input.csv").npts == 512


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("--count", "2", "--band", "0.2:9"), "the target goes from 0 to 4 s"),
        (("--count", "9",), "--count: a set of 9 was requested, but 7 records are available"),
        (("--count", "5",), "one per event leaves 4"),
        (("--count", "2", "--factors", "50:60"), "--factors"),
        (("--count", "2", "--target", "r1.AT2"), "column"),
    ],
)  # fmt: skip
def test_wrong_input_is_pointed_at(words, message):
    assert message in " ".join(run("select", "r*.AT2", *ASKED, *words, code=2).stderr.split())


def test_what_the_target_leaves_open_is_said(files):
    (files / "code.csv").write_text(TARGET.partition("\n")[2])
    told = run("select", "r*.AT2", *ASKED, "--count", 2).stderr
    assert "does not name a unit" in told and "reaches" not in told
    (files / "code.csv").write_text("T,Sa\n0.1,30\n3,20\n")
    assert "reaches 30 g" in run("select", "r*.AT2", *ASKED, "--count", 2, "--factors", "0.1:1000").stderr


def test_a_band_that_samples_do_not_reach_is_said():
    told = run("select", "r*.AT2", "--target", "code.csv", "--band", "0.05:2", "--count", 2).stderr
    assert re.search(r"less than 4 intervals of\s+7 of 7 records", told)
    assert "intervals" not in run("select", "r*.AT2", *ASKED, "--count", 2).stderr


def test_python_gives_the_same():
    found = run_json("select", "r*.AT2", *ASKED, "--count", 3)
    answer = rk.select("r*.AT2", "code.csv", band=(0.2, 2.0), count=3)
    assert answer.to_dict() == found
    assert answer.fits == found["fits"]
    assert [motion.pga_g for motion in answer.motions] == pytest.approx([each["pga_g"] for each in found["records"]])
    points = np.loadtxt("code.csv", delimiter=",", skiprows=1).T
    motions = [read_record(f"r{k}.AT2") for k in range(7)]
    same = rk.select(motions, tuple(points), band=(0.2, 2.0), count=3)
    assert same.factors.tolist() == pytest.approx(answer.factors.tolist())
    assert found["verdict"] == answer.sentences[0]
    frame = answer.to_frame()
    assert set(frame.motion) == {each["name"] for each in found["records"]}
    np.testing.assert_allclose(frame.groupby("period").Sa.mean(), frame.groupby("period").mean_Sa.first(), rtol=1e-12)
    assert len(answer.plot().axes) == 1
    with pytest.raises(rk.InputError, match="a period without an ordinate"):
        rk.select(motions, ([0.1, 1.0], [0.5]), band=(0.2, 0.5), count=1)


@NEEDS_RECORDS
def test_real_records_of_a_code_spectrum():
    words = ("--target", "code.csv", "--band", "0.2:2", "--count", 4, "--within", "0.75:1.5", "--json")
    result = some("select", f"{RECORDS}/*.AT2", f"{RECORDS}/formats/*", *words)  # some hold several channels
    found = json.loads(result.stdout)
    assert found["fits"]
    assert found["exact"]
    assert len({each["event"] for each in found["records"]}) == 4
    assert len(found["left_out"]) == 7  # two of several channels, five of distant or weak earthquakes
