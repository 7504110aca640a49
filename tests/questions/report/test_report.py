"""The report without a browser: what it says, against what the other commands say."""

import hashlib
import html
import json
import platform
import re
import shlex
import subprocess
import sys
import zipfile
from importlib.metadata import version
from types import SimpleNamespace

import numpy as np
import pytest

import rocking_cli as rk
from rocking_cli.ask.read import read_record
from rocking_cli.core.structure_file import load_structure
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.questions.survey.pages import symbols
from rocking_cli.studies.neighbours import Neighbourhood
from rocking_cli.views.neighbours import deviations
from tests.browser import launch
from tests.cli.test_cli import run, run_json
from tests.conftest import EXAMPLES, NEEDS_RECORDS, PROJECT, RECORDS
from tests.following import respond

FRAME, BLOCK, ARCH = (EXAMPLES / f"{name}.yaml" for name in ("frame", "block", "arch"))
ACCEL = EXAMPLES / "accel.csv"
FEW = ("--neighbours", "8")  # of a motion: what is tested here is not their number, and 200 take their time
LARGEST = 3e6  # bytes
LOOSE = ARCH, "--opening", 1000  # its joints may open as far as they do


def read(path):
    """The words of a page, and the data in it."""
    page = path.read_text(encoding="utf-8")
    data = re.findall(r'<script [^>]*type="application/json"[^>]*>(.*?)</script>', page, re.DOTALL)
    text = html.unescape(re.sub(r"<(script|style)\b.*?</\1>|<[^>]*>", "", page, flags=re.DOTALL))
    return SimpleNamespace(words=" ".join(text.split()), data=[json.loads(each) for each in data])


@pytest.mark.usefixtures("small_maps")
class TestContent:
    @pytest.mark.rest
    def test_no_comment_is_in_it(self, frame_report):
        page = frame_report[0].read_text(encoding="utf-8")
        assert not re.search(r"<!--|/\*|^ *//", page, re.MULTILINE)

    def test_its_map_is_that_of_overturning(self, monkeypatch):
        monkeypatch.setattr("rocking_cli.questions.report.study.MAP_POINTS", 8)
        found, (mark, *_) = (answer := rk.report(BLOCK, ACCEL, neighbours=5).map).found, answer.marks
        alone = rk.overturning_map(BLOCK, points=8)
        np.testing.assert_array_equal(found.regions, alone.regions)
        np.testing.assert_allclose((found.periods, found.ag), (alone.periods, alone.ag))
        assert mark[0] == "accel.csv" and mark[1].pulse.name == "sine" and not answer.outside

    def test_pulses_off_the_map_are_named(self, monkeypatch, tmp_path):
        monkeypatch.setattr("rocking_cli.questions.report.study.MAP_POINTS", 8)
        out = tmp_path / "r.html"
        time = np.arange(0, 2, 0.001)
        slow = rk.GroundMotion("off", 0.01, 0.3 * np.sin(2 * np.pi * time / 0.05), unit="g")
        found = rk.report(BLOCK, slow, out=out, neighbours=2).map
        assert not found.marks and list(found.outside) == ["off"]
        assert "Outside the map: those of off." in read(out).words

    def test_the_summary_has_the_numbers_of_respond_and_equiv(self, frame_report):
        out, printed = frame_report
        words = read(out).words
        responses = run_json("respond", FRAME, "--record", ACCEL, "--polarity", "both")
        assert responses["governs"] == 1
        best = responses["polarities"]["1"]["responses"]["nonlinear"]
        assert f"rocks to {best['peak_ratio']:.3g} phi_cr" in printed and printed.split(" phi_cr")[0] in words
        assert f"Yes, first at {best['uplift_time']:.3g} s" in words
        assert f"{np.degrees(best['peak_positive']):.3g}° clockwise" in words
        other = responses["polarities"]["-1"]["responses"]["nonlinear"]
        assert f"With the motion reversed, it rocks to {other['peak_ratio']:.4g} of its critical rotation" in words
        block = run_json("equiv", FRAME)["directions"]
        assert all(f"{block[side]['lambda']:.4g}" in words for side in ("positive", "negative"))
        for name, run_of in responses["polarities"]["1"]["responses"].items():
            assert f"{run_of['peak_ratio']:.3g}" in words, name
        assert "The base shear leaves out impacts: the impulse at an impact is not part of it." in words
        assert "base shear, without impacts" in words

    def test_an_overturning_is_said_with_its_direction_and_time(self):
        data = run_json("report", *FEW, BLOCK, "--pulse", "sine:1g:2s", "--polarity", "1")
        (motion,) = data["motions"]
        alone = run_json("respond", BLOCK, "--pulse", "sine:1g:2s")["responses"]["nonlinear"]
        said = motion["answers"]["Will it overturn?"]
        sense = {"positive": "clockwise", "negative": "anticlockwise"}[alone["overturning_direction"]]
        assert f"it overturns {sense} at {alone['overturning_time']:.3g} s" in said
        assert "Only this polarity of the motion was analysed" in said
        assert "under sine:1g:2s, the structure overturns" in data["answer"] and motion["headline"] == "overturns"
        assert motion["margin"]["levels"]["90"]["first"] < 1 and motion["neighbours"]["overturned"] > 0.9

    @pytest.mark.rest
    def test_the_worse_polarity_is_shown(self, tmp_path):
        out = tmp_path / "r.html"
        # 1 governs without the scale.
        data = run_json("report", *FEW, FRAME, "--record", ACCEL, "--scale", "-1", "-o", out)
        assert data["motions"][0]["polarity"] == -1
        page = read(out)
        assert "Under accel.csv, reversed: " in page.words
        ground, pulse = (np.array(each["y"]) for each in page.data[0]["charts"][1]["series"])
        record = read_record(ACCEL).acceleration / STANDARD_GRAVITY
        assert ground[np.abs(ground).argmax()] == pytest.approx(record[np.abs(record).argmax()], rel=1e-4)
        assert np.sign(pulse[np.abs(pulse).argmax()]) == np.sign(record[np.abs(record).argmax()])

    @pytest.mark.every(6)
    @pytest.mark.parametrize(
        ("structure", "pulse", "said"),
        [
            ((BLOCK,), "sine:0.1g:1s", "Any of them"),
            ((FRAME,), "sine:0.5g:0.5s", "Any of them"),
            (LOOSE, "sine:0.8g:0.8s", "The nonlinear model, "),
            (LOOSE, "sine:0.9g:1.2s", "No single one: the models disagree"),
            ((BLOCK,), "sine:1g:2s", "Any of them"),
            ((ARCH,), "sine:0.8g:0.8s", "The nonlinear model until 0.1878 s, and none beyond"),
        ],
    )
    def test_which_model_to_trust(self, structure, pulse, said):
        # By `respond`: no uplift, motions within 12 %, linear1 far off, linear2 alone rocks, all overturn, unknown.
        found = run_json("report", *FEW, *structure, "--pulse", pulse, "--polarity", "1")
        (motion,) = found["motions"]
        assert motion["answers"]["Which model to trust?"].startswith(said)
        ends = {each["overturned"] for each in motion["responses"].values()}
        assert ("the structure may overturn" in found["answer"]) == (None in ends)
        assert (None in ends) == (structure == (ARCH,))
        assert (ends == {False, True}) == said.startswith("No single one")

    def test_models_that_disagree_on_uplift_do_not_agree(self):
        # Between the uplift of the arch, 0.37 g, and that of its linearised block, 0.25 g.
        motion = run_json("report", *FEW, ARCH, "--pulse", "sine:0.3g:0.5s")["motions"][0]
        runs = motion["polarities"]["1"]["responses"]
        assert [name for name, each in runs.items() if each["uplift_time"] is not None] == ["linear1"]
        said = motion["answers"]["Which model to trust?"]
        assert said.startswith("The nonlinear model, ") and "its uplift acceleration is 33 % too low" in said

    def test_the_headline_counts_the_motions_that_move_it(self):
        pulses = ("sine:0.1g:1s", "sine:0.3g:0.5s", "sine:0.35g:0.5s")
        found = run_json("report", *FEW, BLOCK, *(word for each in pulses for word in ("--pulse", each)))
        assert "rocks under 2 of 3 motions and does not uplift under 1" in found["answer"]
        peaks = [max(run["responses"]["nonlinear"]["peak_ratio"] for run in each["polarities"].values())
                 for each in found["motions"]]  # fmt: skip
        assert peaks[0] == 0
        assert f"{pulses[int(np.argmax(peaks))]} governs: the structure rocks to {max(peaks):.3g}" in found["answer"]

    def test_how_close_it_is_is_told_by_the_shares(self):
        asked = (BLOCK, "--pulse", "sine:1g:2s", "--scale", "50", "--opening", "1000")
        (found,) = run_json("report", *FEW, *asked)["motions"]
        said = found["answers"]["How close is that?"]
        assert "a factor of 0.2 (PGA 10 g), 50 % at 0.2 (10 g) and 90 % at 0.2 (10 g)" in said
        around = Neighbourhood(8, slenderness=0.1, restitution=0.05)  # its restitution is not given
        assert f"Of 8 neighbouring motions, all overturn the structure ({deviations(around)})." in said
        assert any("scaled by large factors" in each for each in found["doubts"])

    @pytest.mark.rest
    def test_a_motion_beyond_the_critical_rotation_is_told_as_such(self):
        (motion,) = run_json("report", *FEW, *LOOSE, "--pulse", "sine:1.2g:1.2s", "--polarity", "1")["motions"]
        assert motion["responses"]["nonlinear"]["peak_ratio"] > 1
        assert "is brought back only by the subsequent ground motion" in motion["answers"]["How close is that?"]

    def test_a_close_result_and_models_that_disagree_are_doubted(self):
        levels = run_json("report", *FEW, BLOCK, "--pulse", "sine:0.5g:1s")["motions"][0]["margin"]["levels"]
        near = 0.5 * levels["10"]["first"] / 1.15
        (motion,) = run_json("report", *FEW, BLOCK, "--pulse", f"sine:{near:.6g}g:1s")["motions"]
        assert motion["headline"].endswith("(close)") and any("close" in doubt for doubt in motion["doubts"])
        far = run_json("report", *FEW, BLOCK, "--pulse", f"sine:{near / 1.5:.6g}g:1s")
        assert "(close)" not in far["motions"][0]["headline"] and "close" not in far["answer"]

    def test_a_decisive_share_of_overturning_is_not_called_close(self):
        levels = run_json("report", *FEW, BLOCK, "--pulse", "sine:0.5g:1s")["motions"][0]["margin"]["levels"]
        beyond = 0.5 * levels["90"]["last_below"] * 1.15
        found = run_json("report", *FEW, BLOCK, "--pulse", f"sine:{beyond:.6g}g:1s")
        assert found["motions"][0]["headline"].startswith("overturns") and found["conclusion"]["share"]["lowest"] == 1
        assert "close" not in found["motions"][0]["headline"] and "is close to" not in found["answer"]

    def test_peaks_of_ground_and_floor_are_named(self, tmp_path):
        floor = ("--record", ACCEL, "--floor", "T1=0.4,z/H=1,n=3", "--polarity", "1")
        run("report", *FEW, BLOCK, *floor, "--out", tmp_path / "r.html")
        words = read(tmp_path / "r.html").words
        assert "(PGA of the ground 0.55 g)" in words and "this motion, on the floor, reaches" in words
        assert "A floor acceleration of 0.25 g" in words and "| PGA" not in words
        assert "PGA of the ground" in run("margin", BLOCK, *FEW, *floor).stdout.replace("\n", " ") + words
        run("animate", BLOCK, *FEW, *floor, "--out", tmp_path / "a.html")
        page = (tmp_path / "a.html").read_text(encoding="utf-8")
        assert "PGA of the ground 0.55 g, of the floor" in page and '"floor acceleration [g]"' in page

    def test_doubts_of_a_record_and_of_the_structure_are_in_it(self, tmp_path):
        t = np.arange(200) * 0.02
        record = tmp_path / "odd.csv"
        lines = [f"{x:.2f},{0.3 * np.sin(6 * x) + 0.1:.6f}" for x in t]
        record.write_text("t,accel_g\n" + "\n".join(lines) + "\n", encoding="utf-8")
        out = tmp_path / "r.html"
        result = run("report", *FEW, BLOCK, "--record", record, "-o", out)
        doubts = re.findall(r"warning: odd\.csv: (.*)", result.stderr)
        words = read(out).words
        assert len(doubts) > 1
        assert all(doubt[1:40] in words for doubt in doubts)
        assert "was not measured" in words

    def test_a_stocky_structure_without_a_motion_says_what_is_left_out(self, tmp_path):
        stocky = tmp_path / "stocky.yaml"
        stocky.write_text("mechanism: block\nwidth: 3\nheight: 1\n", encoding="utf-8")
        out = tmp_path / "r.html"
        run("report", stocky, "-o", out)
        words = read(out).words
        assert "they need a measured restitution" in words and "No map is given" in words
        assert "restitution" in run("report", *FEW, stocky, "--record", ACCEL, "-o", out, code=2).stderr

    def test_comments_of_a_template_are_left_out_of_the_listing_and_counted(self, tmp_path):
        template = run("new", "block").stdout
        file = tmp_path / "block.yaml"
        file.write_text(f"# my own words\n{template}", encoding="utf-8")
        out = tmp_path / "r.html"
        run("report", file, "-o", out)
        words = read(out).words
        count = sum(line.startswith("#") for line in template.splitlines())
        assert count > 10 and f"({count} lines of comments of the template are left out)" in words
        assert "# my own words mechanism: block width: 0.7" in words

    def test_symbols_have_subscripts_and_nothing_else_does(self):
        assert symbols("φ_cr/κ₁ & a_p") == "φ<sub>cr</sub>/κ₁ &amp; a<sub>p</sub>"
        assert symbols("column_width <b> data_p") == "column_width &lt;b&gt; data_p"

    def test_curves_are_those_of_the_history(self, frame_report):
        (data,) = read(frame_report[0]).data
        rotation, ground = (chart["series"] for chart in data["charts"])
        runs = respond(load_structure(FRAME), read_record(ACCEL))
        assert [each["look"] for each in rotation] == list(runs)
        for each, run_of in zip(rotation, runs.values(), strict=True):
            x, y = np.array(each["x"]), np.array(each["y"])
            np.testing.assert_allclose(y, np.interp(x, run_of.time, run_of.ratio), rtol=1e-4, atol=1e-6)
            assert x[-1] == pytest.approx(run_of.time[-1])
        assert max(ground[0]["y"], key=abs) == pytest.approx(-0.55, rel=1e-3)
        best = runs["nonlinear"]
        assert data["moment"] == pytest.approx(best.time[np.abs(best.ratio).argmax()])


class TestReproduction:
    def test_files_are_quoted_with_their_checksums_and_the_command_is_repeated(self, frame_report):
        out = frame_report[0]
        words = read(out).words
        assert " ".join(FRAME.read_text(encoding="utf-8").split()) in words
        for file in (FRAME, ACCEL):
            assert hashlib.sha256(file.read_bytes()).hexdigest() in words
        assert shlex.join(["rocking", "report", str(FRAME), "--record", str(ACCEL), "-o", str(out)]) in words
        for name in ("rocking-cli", "numpy", "scipy", "matplotlib"):
            assert f"{name}{version(name)}" in words
        assert f"Python{platform.python_version()}" in words

    def test_the_command_has_every_option_given(self):
        given = ["--pulse", "sine:0.1g:1s", "--pulse", "ricker:0.1g:1s", "--target-pga", "0.05", "--polarity", "-1"]
        data = run_json("report", *FEW, BLOCK, *given)
        assert shlex.split(data["command"]) == ["rocking", "report", str(BLOCK), *given, *FEW, "--json"]

    @pytest.mark.rest
    @pytest.mark.usefixtures("drawn")
    def test_elsewhere_it_is_the_same_and_folders_stay_out_unless_given(self, frame_report, tmp_path, monkeypatch):
        monkeypatch.chdir(EXAMPLES)
        out = tmp_path / "r.html"
        run("report", "--neighbours", 20, "frame.yaml", "--record", "accel.csv", "-o", out)
        page = out.read_text(encoding="utf-8").replace(str(out), "")
        assert str(EXAMPLES) not in page and str(PROJECT) not in page
        first = frame_report[0].read_text(encoding="utf-8").replace(str(frame_report[0]), "")
        assert first.replace(str(FRAME), FRAME.name).replace(str(ACCEL), ACCEL.name) == page

    def test_nothing_is_fetched_and_no_identifier_stands_twice(self, frame_report):
        page = frame_report[0].read_text(encoding="utf-8")
        assert not re.search(r"<(link|iframe|object|embed|base)\b|@import|\bsrc=|\bfetch\(|XMLHttp", page)
        targets = re.findall(r'href="([^"]*)"', page)
        assert len(targets) > 10
        assert [each for each in targets if each[0] != "#" and not each.startswith("data:image/png;base64,")] == []
        identifiers = re.findall(r'\bid="([^"]*)"', page)
        assert len(set(identifiers)) == len(identifiers)
        assert {each[1:] for each in targets if each[0] == "#"} <= set(identifiers)

    def test_templates_and_scripts_are_in_the_wheel(self, tmp_path):
        build = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(tmp_path)]
        subprocess.run(build, cwd=PROJECT, check=True, capture_output=True)
        (wheel,) = tmp_path.glob("*.whl")
        names = set(zipfile.ZipFile(wheel).namelist())
        assert {
            "rocking_cli/documents/templates/document.html", "rocking_cli/questions/report/texts/it/report.md",
            "rocking_cli/data/motion.js", "rocking_cli/data/motion.css", "rocking_cli/data/animation.html",
            "rocking_cli/codes/italian/texts/it.toml", "rocking_cli/codes/italian/texts/en_in_short.toml",
            "rocking_cli/views/sheet/texts/en.toml",
        } <= names  # fmt: skip


@pytest.mark.usefixtures("small_maps")
class TestCommand:
    def test_the_page_is_named_after_the_structure_and_json_writes_none(self, tmp_path):
        run("report", BLOCK)
        assert (tmp_path / "block.html").exists()
        (tmp_path / "block.html").unlink()
        data = run_json("report", BLOCK)
        assert list(tmp_path.iterdir()) == []
        assert data["motions"] == [] and set(data["parameters"]) == {"positive", "negative"}

    def test_the_default_block_is_quoted(self, tmp_path):
        run("report")
        assert "default block, 0.7 m x 2.8 m" in read(tmp_path / "rocking.html").words

    @pytest.mark.parametrize(
        ("arguments", "said"),
        [
            (["--dt", "0.01"], "give --record"),
            (["--scale", "2"], "give --record or --pulse"),
            (["--pulse", "sine:1g:1s", "--scale", "2", "--target-pga", "1"], "cannot be combined"),
            (["--record", "none.csv"], "none.csv"),
            (["-o", "r.txt"], "does not end in .html or .pdf or .docx"),
            (["-o", "none/r.html"], "does not exist"),
        ],
    )
    def test_what_cannot_be_is_refused(self, arguments, said, tmp_path):
        assert said in run("report", *FEW, BLOCK, *arguments, code=2).stderr
        assert list(tmp_path.iterdir()) == []


@pytest.mark.rest
def test_a_pdf_is_printed_on_numbered_pages_of_A4_by_a_browser(tmp_path):
    """By the command and in Python; the tree of the PDF names the size of the pages, in points."""
    found, driver = launch()  # skipped where there is none
    found.close()
    driver.stop()
    run("report", BLOCK, "-o", tmp_path / "r.pdf")
    rk.report(rk.Block(width=0.7, height=2.8), out=tmp_path / "p.pdf")
    for name in ("r.pdf", "p.pdf"):
        content = (tmp_path / name).read_bytes()
        assert content.startswith(b"%PDF-") and content.rstrip().endswith(b"%%EOF")
        width, height = map(float, re.search(rb"/MediaBox \[0 0 ([\d.]+) ([\d.]+)\]", content).groups())
        assert (width, height) == (pytest.approx(595.28, abs=1), pytest.approx(841.89, abs=1))
    style = (PROJECT / "rocking_cli" / "documents" / "templates" / "document.css").read_text(encoding="utf-8")
    assert "counter(page)" in style


@pytest.mark.parametrize("call", ["command", "python"])
@pytest.mark.usefixtures("small_maps")
def test_without_a_browser_the_result_is_printed_first(call, tmp_path, monkeypatch):
    monkeypatch.setenv("ROCKING_BROWSER", "no-such-browser")
    monkeypatch.setattr("rocking_cli.questions.verify.sheets.find_spec", lambda name: None)  # nor typst
    said = "there is no browser no-such-browser"
    if call == "command":
        result = run("report", BLOCK, "-o", tmp_path / "r.pdf", code=5)
        assert said in result.stderr and result.stdout == run("report", BLOCK, "-o", tmp_path / "r.html").stdout
        (tmp_path / "r.html").unlink()
    else:
        with pytest.raises(rk.InputError, match=said):
            rk.report(rk.Block(width=0.7, height=2.8), out=tmp_path / "r.pdf")
    assert list(tmp_path.iterdir()) == []


def test_python_refuses_another_ending_and_language(tmp_path):
    with pytest.raises(rk.InputError, match="`language` must be en or it"):
        rk.report(rk.Block(width=0.7, height=2.8), language="xx")
    with pytest.raises(rk.InputError, match=r"end in \.html or \.pdf or \.docx"):
        rk.report(rk.Block(width=0.7, height=2.8), out=tmp_path / "r.txt")


@pytest.mark.rest
def test_a_structure_is_made_ready_once(monkeypatch, tmp_path):
    """Whatever a report asks of it: its equivalent block and its tables are derived once."""
    counts = {"equivalent_block": 0, "tabulate": 0}
    for module in [each for name, each in sys.modules.items() if name.startswith("rocking_cli.")]:
        for name in counts:
            if callable(found := getattr(module, name, None)):

                def counted(*given, found=found, name=name):
                    counts[name] += 1
                    return found(*given)

                monkeypatch.setattr(module, name, counted)
    out = tmp_path / "r.html"
    run("report", "--neighbours", 2, ARCH, "--record", ACCEL, "--pulse", "sine:0.5g:0.8s", "-o", out)
    assert counts == {"equivalent_block": 1, "tabulate": 1}


class TestSize:
    def test_one_record(self, frame_report):
        assert frame_report[0].stat().st_size < LARGEST / 4

    @pytest.mark.rest
    def test_many_long_records_too(self, tmp_path):
        rng = np.random.default_rng(1)
        records = []
        for k in range(3):
            path = tmp_path / f"long{k}.csv"
            values = (0.05 if k == 0 else 0.01) * rng.standard_normal(30_000)  # the others lift nothing: that is fast
            path.write_text("\n".join(f"{value:.6f}" for value in values) + "\n", encoding="utf-8")
            records += ["--record", path]
        out = tmp_path / "r.html"
        run("report", "--neighbours", "2", BLOCK, *records, "--units", "g", "--dt", "0.01", "-o", out)
        assert out.stat().st_size < LARGEST
        ground = read(out).data[0]["charts"][1]["series"][0]
        written = np.loadtxt(tmp_path / "long0.csv")
        assert max(ground["y"]) == pytest.approx(written.max(), rel=1e-4)  # peaks survive the thinning
        assert min(ground["y"]) == pytest.approx(written.min(), rel=1e-4)

    @pytest.mark.rest
    @NEEDS_RECORDS
    def test_two_real_records(self, tmp_path):
        out = tmp_path / "r.html"
        records = [RECORDS / name for name in ("RSN6_IMPVALL.I_I-ELC180.AT2", "Rinaldi228.AT2")]
        run("report", *FEW, EXAMPLES / "wall.yaml", *(a for each in records for a in ("--record", each)), "-o", out)
        assert out.stat().st_size < LARGEST
        page = read(out)
        assert len(page.data) == 2 and "Rinaldi228.AT2 governs: the structure overturns" in page.words
        assert max(map(abs, page.data[1]["charts"][1]["series"][0]["y"])) == pytest.approx(0.8741, rel=1e-3)


@pytest.mark.rest
def test_the_head_names_project_place_and_author(tmp_path):
    out = tmp_path / "r.html"
    head = ("--project", "Survey <2026>", "--place", "L'Aquila", "--author", "A. & B.")
    data = run_json("report", BLOCK, *head, "-o", out)
    assert (data["project"], data["place"], data["author"]) == ("Survey <2026>", "L'Aquila", "A. & B.")
    page = out.read_text(encoding="utf-8")
    assert all(f"<dd>{each}</dd>" in page for each in ("Survey &lt;2026&gt;", "L&#39;Aquila", "A. &amp; B."))
    run("report", BLOCK, "-o", out)
    assert "<dt>Project</dt>" not in out.read_text(encoding="utf-8")


@pytest.mark.parametrize(("language", "said", "unsaid"), [
    ("en", ["at their strength from rest on, with λ = {:.4g},", "counts them, it is {:.4g}.",
            "Only this mechanism is verified. A wall that a tie holds may bend", "Its rebound is not given"],
     ["Pulses", "Error of the equivalent block", "sequence of impacts", "call for no action"]),
    ("it", ["con la loro resistenza fin dall'inizio, con λ = {:.4g},", "come le considera la verifica, è {:.4g}.",
            "È verificato soltanto questo meccanismo. Una parete trattenuta", "Il rimbalzo non è assegnato"],
     ["Impulsi", "Errore del blocco equivalente", "sequenza di urti", "richiedono interventi", "si assegn"]),
])  # fmt: skip
def test_a_report_explains_the_two_multipliers_of_a_tied_facade(language, said, unsaid, tmp_path):
    """Hand: the tie yields, N = A f_y, and turns the facade about its foot with its arm; at rest it does nothing."""
    (tmp_path / "f.yaml").write_text(
        "mechanism: block\nname: f\nwidth: 0.6\nheight: 9\ndepth: 5\ndensity: 1800\none_sided: positive\n"
        "loads: [{name: roof, mass: 100, at: [0, 9], seat: 0.3, floor: borne}]\n"
        "ties: [{name: bar, from: {ground: [-5, 7.5]}, to: {at: [-0.3, 7.5]}, bars: 1, diameter: 0.02, steel: S235}]\n"
    )
    (tmp_path / "s.yaml").write_text("FC: 1.35\nag: 0.05\nF0: 2.5\nTC: 0.4\nS: 1.2\n")
    run("report", tmp_path / "f.yaml", "--verify", tmp_path / "s.yaml", "-o", out := tmp_path / "r.html",
        "--language", language)  # fmt: skip
    words, W, G = read(out).words, 0.6 * 9 * 5 * 1800 * STANDARD_GRAVITY, 100 * STANDARD_GRAVITY
    strong = (0.3 * (W + G) + 7.5 * np.pi * 0.01**2 * 235e6) / (4.5 * W + 9 * G)
    number = f"{strong:.4g}".replace(".", "," if language == "it" else ".")
    assert not [each for each in said if each.replace("{:.4g}", number) not in words]
    assert not [each for each in unsaid if each in words]
