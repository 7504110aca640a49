"""The moving picture: it shows the rotations of the history, as a GIF and as a page that needs nothing else."""

import html
import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from mechanisms.block import Block
from rocking_cli.core.structure_file import load_structure
from rocking_cli.excitation.base import STANDARD_GRAVITY, GroundMotion
from rocking_cli.excitation.pulses import parse_pulse
from rocking_cli.plotting import style
from rocking_cli.questions.animate.picture import animation_page, frame_time
from rocking_cli.studies.film import Film
from rocking_cli.studies.picture import picture
from tests.cli.test_cli import run, run_json
from tests.conftest import EXAMPLES
from tests.following import respond

BLOCK = Block(width=0.7, height=2.8)
ACCEL = EXAMPLES / "accel.csv"


def film(amplitude, model="nonlinear", name="sine"):
    motion = parse_pulse(f"sine:{amplitude}g:0.9s").sampled()
    motion = replace(motion, name=name)
    return Film(picture(BLOCK), respond(BLOCK, motion, models=(model,))[model], motion)


def data_of(page):
    return json.loads(re.search(r'<script id="data" type="application/json">(.*?)</script>', page, re.S)[1])


class TestFilm:
    def test_it_shows_the_history(self):
        shown = film(0.3)
        np.testing.assert_array_equal(shown.rotation(shown.history.time), shown.history.phi)
        np.testing.assert_allclose(shown.ratio(shown.history.phi), shown.history.ratio)

    def test_each_direction_has_its_own_critical_rotation(self):
        stone = load_structure(EXAMPLES / "rigid_body.yaml")
        motion = parse_pulse("sine:0.35g:0.6s").sampled()
        history = respond(stone, motion, models=("nonlinear",))["nonlinear"]
        assert history.phi.min() < 0 < history.phi.max()
        np.testing.assert_allclose(Film(picture(stone), history, motion).ratio(history.phi), history.ratio)

    def test_it_lasts_from_before_uplift_to_after_rest(self):
        pulse = film(0.3).motion
        still = np.zeros(round(5.0 / pulse.dt))
        later = np.concatenate([still, pulse.acceleration, *[still] * 10])
        motion = GroundMotion("late", pulse.dt, later)
        shown = Film(picture(BLOCK), respond(BLOCK, motion, models=("nonlinear",))["nonlinear"], motion)
        assert shown.start == pytest.approx(shown.history.uplift_time - 1.0)
        assert shown.end == pytest.approx(shown.history.end_time + 1.5)
        assert shown.end < 30 < motion.duration

    @pytest.mark.parametrize("model", ["nonlinear", "linear2"])
    def test_a_fall_is_shown_as_far_as_it_was_followed(self, model):
        shown = film(0.9, model)
        assert shown.history.overturned
        last = shown.history.phi[np.isfinite(shown.history.phi)][-1]
        assert shown.rotation(np.array([shown.end, shown.end + 100])).tolist() == [last, last]
        assert shown.history.fell

    def test_the_box_holds_all_of_the_motion(self):
        shown = film(0.3)
        low, high = shown.box
        for rotation in (shown.history.phi.min(), shown.history.phi.max()):
            for part in shown.picture.placed(float(rotation))[0]:
                for z in part:
                    assert low.real <= z.real.min() and z.real.max() <= high.real and z.imag.max() <= high.imag + 1e-9

    def test_a_structure_at_rest_can_be_shown(self):
        shown = film(0.1)
        assert (shown.start, shown.end) == (0.0, shown.history.time[-1])


class TestPage:
    def test_it_has_the_rotations_and_traces_of_the_history(self):
        shown = film(0.3)
        data = data_of(animation_page(shown, "a block"))
        rotation = np.array(data["film"]["rotation"])
        time = np.arange(rotation.size) * data["film"]["step"]
        np.testing.assert_allclose(rotation, shown.rotation(time), rtol=1e-4)
        assert time[-1] >= shown.end
        ratio, ground = (each["series"][0] for each in data["charts"])
        assert max(np.abs(ground["y"])) == pytest.approx(0.3, rel=1e-4)
        np.testing.assert_allclose(np.interp(1.0, ground["x"], ground["y"]), 0.0, atol=1e-6)
        assert max(np.abs(ratio["y"])) == pytest.approx(shown.history.peak_ratio, rel=1e-3)
        assert data["picture"] == shown.picture.as_dict()

    def test_it_needs_no_network(self):
        page = animation_page(film(0.3), "a block")
        addresses = set(re.findall(r"(?:https?:)?//[\w.]+", page)) - {"http://www.w3.org"}
        assert not {each for each in addresses if "." in each}
        assert not re.search(r"\b(src|href)\s*=|@import|url\((?!#)|fetch\(|XMLHttpRequest", page)

    def test_it_respects_what_a_reader_has_set(self):
        page = animation_page(film(0.3), "a block")
        for words in ("prefers-color-scheme: dark", "prefers-reduced-motion: reduce", 'name="viewport"', '"ArrowLeft"'):
            assert words in page or words.strip('"') in page

    def test_names_cannot_leave_their_place(self):
        evil = "</script><script>alert(1)</script>&<b>"
        page = animation_page(film(0.3, name=evil), evil)
        assert page.count("</script>") == 2 and "<b>" not in page and "alert(1)</" not in page
        data = data_of(page)
        assert f"<title>{html.escape(evil)}</title>" in page and data["about"].startswith(evil)


@pytest.mark.rest
class TestGif:
    def test_frames_show_the_block_where_it_is(self, tmp_path):
        run("animate", "--pulse", "sine:0.3g:0.9s", "--out", "a.gif", "--fps", "10")
        with Image.open("a.gif") as gif:
            assert 15 < gif.n_frames < 200
            assert gif.info["duration"] == 100
            leaning = []
            filled = tuple(int(style.BODIES[0][k : k + 2], 16) for k in (1, 3, 5))
            for k in range(gif.n_frames):
                gif.seek(k)
                upper = np.asarray(gif.convert("RGB"))[60 : gif.height // 2]
                leaning.append(np.flatnonzero((upper == filled).all(axis=2).any(axis=0)).mean())
        data = run_json("animate", "--pulse", "sine:0.3g:0.9s", "--out", "b.gif", "--fps", "10")
        assert data["frames"] == len(leaning)
        shown = film(0.3)
        times = np.append(data["start"] + 0.1 * np.arange(len(leaning) - 1), data["end"])
        # The upper half of the block is to the right while it turns clockwise, by as much as it has turned.
        assert np.corrcoef(leaning, shown.rotation(times))[0, 1] > 0.99

    def test_it_is_no_larger_than_a_mail_takes(self, tmp_path):
        run("animate", EXAMPLES / "frame.yaml", "--record", ACCEL, "--out", "a.gif", "--fps", "5")
        assert (tmp_path / "a.gif").stat().st_size < 1_500_000

    def test_edges_are_smooth_and_white_is_white(self):
        """Row by row the left edge of a tilted block, where its ink is, lies on a straight line."""
        run("animate", "--pulse", "sine:0.3g:0.9s", "--out", "a.gif", "--fps", "10")
        with Image.open("a.gif") as gif:
            gif.seek(gif.n_frames // 4)
            frame = np.asarray(gif.convert("RGB"))
        assert (frame[2, 2] == 255).all()
        rows = np.arange(140, 320)
        ink = 255.0 - frame[rows, : frame.shape[1] // 2].max(axis=2)
        first = (ink > 60).argmax(axis=1)
        near = first[:, None] + np.arange(-3, 4)
        weight = np.maximum(np.take_along_axis(ink, near, axis=1) - 30, 0)  # without the face of the block
        edge = (near * weight).sum(axis=1) / weight.sum(axis=1)
        line = np.polyfit(rows, edge, 1)
        assert abs(line[0]) > 0.01  # it is tilted
        assert np.abs(edge - np.polyval(line, rows)).max() < 0.2  # pixels

    @pytest.mark.parametrize(("fps", "time"), [(20, 0.05), (25, 0.04), (30, 0.03), (50, 0.02), (1, 1.0)])
    def test_a_frame_lasts_whole_hundredths(self, fps, time):
        assert frame_time(fps) == time


class TestCommand:
    def test_a_page_is_written_and_what_happened_is_said(self, tmp_path):
        pulse = ("--pulse", "sine:0.6g:0.5s", "--polarity", "-1", "--neighbours", 20)
        ends = []
        for limit, said in (("1", "The structure rocks to"), ("0.5%", "The outcome is unknown after")):
            asked = ("animate", EXAMPLES / "arch.yaml", *pulse, "--opening", limit)
            assert said in run(*asked, "--out", "a.html").stdout
            page = Path("a.html").read_text(encoding="utf-8")
            assert "<h1>Oppenheim" in page and len(data_of(page)["picture"]["parts"]) == 5
            ends.append(data_of(page)["film"]["end"])
        assert ends[1] < ends[0]

    def test_polarity_and_scale_reach_the_motion(self, tmp_path):
        for out, more in (("a.html", []), ("b.html", ["--polarity", "-1"])):
            run("animate", "--pulse", "sine:0.15g:0.9s", "--scale", "2", "--out", out, *more)
        one, other = (data_of(Path(name).read_text(encoding="utf-8")) for name in ("a.html", "b.html"))
        np.testing.assert_allclose(one["film"]["rotation"], np.negative(other["film"]["rotation"]))
        np.testing.assert_allclose(one["film"]["rotation"], data_of(animation_page(film(0.3), ""))["film"]["rotation"])

    @pytest.mark.rest
    def test_a_long_motion_is_shown_faster_in_a_gif_only(self, tmp_path):
        long = np.tile(film(0.3).motion.acceleration[:91], 60)  # 55 s of rocking
        np.savetxt("long.txt", long / STANDARD_GRAVITY)
        options = ("animate", "--record", "long.txt", "--dt", "0.01", "--units", "g")
        page = run_json(*options, "--out", "a.html")
        gif = run_json(*options, "--out", "a.gif", "--fps", "2")
        if page["outcome"] != "overturned":
            assert (page["speed"], page["frames"]) == (1.0, None)
            assert gif["speed"] == pytest.approx((gif["end"] - gif["start"]) / 20) and gif["speed"] > 1
            assert gif["frames"] <= 42

    @pytest.mark.parametrize(
        ("arguments", "said"),
        [
            (["--out", "a.gif"], "--record FILE or --pulse"),
            (
                ["--out", "a.gif", "--pulse", "sine:0.4g:1s", "--record", "x"],
                "Give either --record FILE or --pulse PULSE.",
            ),
            (["--out", "a.mp4", "--pulse", "sine:0.4g:1s"], "does not end in .gif or .html"),
            (["--out", "a.gif", "--pulse", "sine:0.4g:1s", "--fps", "60"], "between 1 and 50"),
            (["--out", "a.gif", "--pulse", "sine:0.4g:1s", "--speed", "0.001"], "frames is too long (at most 3,000)"),
            (["--pulse", "sine:0.4g:1s"], "--out"),
        ],
    )
    def test_what_cannot_be_is_refused(self, tmp_path, arguments, said):
        assert said in run("animate", *arguments, code=2).stderr
        assert list(tmp_path.iterdir()) == []
