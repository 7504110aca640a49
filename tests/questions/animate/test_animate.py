"""The moving picture: it shows the rotations of histories, as a GIF, a video and a page that needs nothing else."""

import html
import json
import re
import shutil
import stat
import subprocess
import sys
from dataclasses import replace
from math import degrees, pi
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from mechanisms.block import Block
from rocking_cli.core.structure_file import load_structure
from rocking_cli.errors import Refused
from rocking_cli.excitation.base import STANDARD_GRAVITY, GroundMotion
from rocking_cli.excitation.pulses import parse_pulse
from rocking_cli.plotting import style
from rocking_cli.plotting.moving import asset
from rocking_cli.plotting.panels import Page
from rocking_cli.questions.animate.picture import _Stage, animation_page, frame_time, write_mp4
from rocking_cli.studies.film import Film, Scene
from rocking_cli.studies.picture import picture
from rocking_cli.views.animation import fate, scale_in_words
from tests.cli.test_cli import run, run_json
from tests.conftest import EXAMPLES
from tests.following import respond
from tests.questions.respond.test_cli_several import lines

BLOCK = Block(width=0.7, height=2.8)
ACCEL = EXAMPLES / "accel.csv"


FFMPEG = shutil.which("ffmpeg")


def film(amplitude, model="nonlinear", name="sine", structure=BLOCK):
    motion = parse_pulse(f"sine:{amplitude}g:0.9s").sampled()
    motion = replace(motion, name=name)
    return Film(picture(structure), respond(structure, motion, models=(model,))[model], motion)


def peak(shown):
    return degrees(np.nanmax(np.abs(shown.history.phi)))


def data_of(page):
    return json.loads(re.search(r'<script id="data" type="application/json">(.*?)</script>', page, re.S)[1])


class TestFilm:
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
        motion = GroundMotion("late", pulse.dt, later, unit="m/s2")
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
        low, high = shown.box()
        for rotation in (shown.history.phi.min(), shown.history.phi.max()):
            for part in shown.picture.placed(float(rotation))[0]:
                for z in part:
                    assert low.real <= z.real.min() and z.real.max() <= high.real and z.imag.max() <= high.imag + 1e-9

    def test_a_structure_at_rest_can_be_shown(self):
        shown = film(0.1)
        assert (shown.start, shown.end) == (0.0, shown.history.time[-1])


class TestScale:
    @pytest.mark.parametrize("amplitude", [0.3, 0.304, 0.27, 0.2505])
    def test_rotations_below_two_degrees_are_enlarged_by_a_round_number(self, amplitude):
        shown = film(amplitude)
        scene = Scene((shown,))
        times = scene.enlargement
        if peak(shown) >= 2:
            assert times == 1
        else:
            assert times in (2, 5, 10, 20, 50, 100)
            assert 2 <= times * peak(shown) <= 5 or (times == 100 and amplitude == 0.2505)
        time = shown.history.time
        drawn, _ = scene.seen(shown, time)
        np.testing.assert_allclose(drawn, times * shown.history.phi)
        # The top corner moves on the ground by so many times what it does, as the words have it.
        k = int(np.abs(shown.history.phi).argmax())
        rest, true, larger = (
            shown.picture.placed(turn)[0][0][0] for turn in (0.0, float(shown.history.phi[k]), float(drawn[k]))
        )
        assert np.abs(larger - rest).max() == pytest.approx(times * np.abs(true - rest).max(), rel=0.05)
        said = f"Displacements are enlarged {times:g} times" if times > 1 else "Displacements are to scale"
        assert scale_in_words(scene).startswith(said)
        # Numbers are those of the history.
        np.testing.assert_allclose(shown.ratio(shown.rotation(time)), shown.history.ratio)

    def test_a_slender_structure_is_not_made_to_overturn(self):
        column = film(0.04, structure=Block(width=0.1, height=3.0))
        largest = column.enlargement * np.abs(column.history.phi).max()
        assert peak(column) < 2 and column.enlargement > 1
        assert largest <= 0.5 * column.picture.reference[1] < np.radians(2)

    def test_structures_side_by_side_have_one_factor_that_of_the_largest_rotation(self):
        small, large, still = film(0.3), film(0.9), film(0.3, structure=Block(width=1.6, height=2.8))
        assert Scene((small,)).enlargement == Scene((small, still)).enlargement > 1 == Scene((small, large)).enlargement
        assert Scene((still,)).enlargement == 1


class TestGround:
    def test_that_of_a_pulse_is_exact(self):
        scene = Scene((film(0.3),))
        t = np.linspace(0.0, 0.9, 50)
        w, a = 2 * pi / 0.9, 0.3 * STANDARD_GRAVITY
        exact = a / w * (t - np.sin(w * t) / w)
        np.testing.assert_allclose(scene.shift(t), scene.ground_enlargement * exact, atol=1e-4 * exact[-1])
        np.testing.assert_allclose(scene.shift(np.array([2.0, 4.0])), scene.shift(t)[-1], rtol=1e-3)

    def test_a_pulse_with_an_impulse_leaves_the_ground_its_velocity(self):
        motion = parse_pulse("half_sine:0.3g:0.6s").sampled()
        shown = Film(picture(BLOCK), respond(BLOCK, motion, models=("nonlinear",))["nonlinear"], motion)
        scene = Scene((shown,))
        one, two, three = scene.shift(motion.duration + np.array([0.0, 0.5, 1.0])) / scene.ground_enlargement
        velocity = 0.3 * STANDARD_GRAVITY * 0.6 / pi  # the integral of half a sine
        assert (two - one, three - two) == pytest.approx((velocity / 2, velocity / 2), rel=1e-3)

    def test_that_of_a_record_has_no_drift(self):
        """Cycles of 1 s about a place, recorded with an offset that would take the ground away by metres."""
        dt, w = 0.01, 2 * pi
        t = np.arange(0.0, 30.0, dt)
        place = 0.05 * np.exp(-(((t - 12) / 3) ** 2)) * np.sin(w * t)
        record = GroundMotion("r", dt, np.gradient(np.gradient(place, dt), dt) + 0.02, unit="m/s2")
        assert record.displacement[-1] > 8
        shown = Film(picture(BLOCK), respond(BLOCK, record, models=("nonlinear",))["nonlinear"], record)
        scene = Scene((shown,))
        moving = (t > 6) & (t < 18)
        drawn = scene.shift(t) / scene.ground_enlargement
        assert np.abs(drawn - place)[moving].max() < 0.004

    def test_it_has_the_factor_of_the_structure_or_one_that_keeps_it_in_view(self):
        for structure, pulse in (
            (BLOCK, "sine:0.3g:0.9s"), (BLOCK, "sine:0.3g:3s"), (Block(width=3, height=12), "ricker:0.3g:0.3s")
        ):  # fmt: skip
            motion = parse_pulse(pulse).sampled()
            scene = Scene(
                (Film(picture(structure), respond(structure, motion, models=("nonlinear",))["nonlinear"], motion),)
            )
            way = np.ptp(scene.shift(np.linspace(scene.start, scene.end, 500)))
            assert scene.ground_enlargement <= scene.enlargement and way <= 0.2 * structure.height
            assert way > 0.2 * structure.height / 3 or scene.ground_enlargement == scene.enlargement
            said, ground = scale_in_words(scene), scene.ground_enlargement
            if ground == scene.enlargement:
                assert said.endswith("the ground too.")
            else:
                size = f"enlarged {ground:g}" if ground > 1 else f"reduced {1 / ground:g}"
                assert f"ground are {size} times." in said or (ground == 1 and "ground are to scale." in said)


@pytest.fixture(scope="module")
def pair():
    """A block that overturns before another has come to rest, under one motion."""
    falls = film(0.9)
    return falls, replace(film(0.9, structure=Block(width=1.6, height=2.8)), motion=falls.motion)


class TestSideBySide:
    def test_they_have_one_clock_and_stand_still_where_they_stop(self, pair):
        scene, (falls, stays) = Scene(pair), pair
        assert falls.history.fell and not stays.history.fell
        assert scene.start == min(falls.start, stays.start) and scene.end == stays.end > falls.stops + 0.5
        late = np.linspace(falls.stops, scene.end, 40)
        turns, ways = scene.seen(falls, late)
        assert np.ptp(turns) == 0 == np.ptp(ways)
        assert np.ptp(scene.seen(stays, late)[0]) > 0

    def test_a_page_has_a_curve_and_an_outcome_for_each(self, pair):
        page = animation_page(pair, "two")
        data = data_of(page)
        ratio, _ = data["charts"]
        assert len(data["stages"]) == len(ratio["series"]) == 2
        for each, stage, curve in zip(pair, data["stages"], ratio["series"], strict=True):
            assert stage["fate"] == fate(each) and curve["x"][-1] <= each.stops
            time = data["start"] + np.arange(len(stage["rotation"])) * data["step"]
            np.testing.assert_allclose(stage["rotation"], each.rotation(time), rtol=1e-4, atol=1e-9)
        assert [fate(each) for each in pair] == ["overturns", f"rocks to {pair[1].history.peak_ratio:.3g} φcr"]

    @pytest.mark.rest
    def test_frames_have_one_scale_and_a_curve_and_a_name_each(self, pair, monkeypatch):
        texts = []
        write = Page.text
        monkeypatch.setattr(
            Page, "text", lambda page, at, text, **look: (texts.append(text), write(page, at, text, **look))
        )
        scene = Scene((*pair, replace(pair[1], picture=picture(Block(width=1.6, height=2.8, name="third")))))
        stage = _Stage(scene, "three", scene.start, scene.end)
        assert len({actor.panel.scale for actor in stage._actors}) == 1
        assert "third" in texts and scale_in_words(scene) in texts
        frames = [np.asarray(stage.frame(t)).astype(int) for t in (pair[0].stops + 0.1, scene.end - 0.01)]
        tall = frames[0].shape[0]
        for actor, stands in zip(stage._actors, (True, False, False), strict=True):
            corner, size = (100 * z for z in (actor.panel.corner, actor.panel.inches))
            box = (
                slice(tall - int(corner.imag + size.imag), tall - int(corner.imag)),
                slice(int(corner.real), int(corner.real + size.real)),
            )
            assert bool((frames[0][box] == frames[1][box]).all()) is stands


class TestPage:
    def test_it_has_the_rotations_and_traces_of_the_history(self):
        shown = film(0.3)
        data = data_of(animation_page(shown, "a block"))
        (stage,) = data["stages"]
        rotation = np.array(stage["rotation"])
        time = data["start"] + np.arange(rotation.size) * data["step"]
        np.testing.assert_allclose(rotation, shown.rotation(time), rtol=1e-4)
        assert (data["start"], data["end"]) == (shown.start, shown.end) and time[-1] >= shown.end
        scene = Scene((shown,))
        assert data["enlargement"] == scene.enlargement > 1 and data["scale"] == scale_in_words(scene)
        np.testing.assert_allclose(data["ground"], scene.shift(time), atol=1e-5)
        ratio, ground = (each["series"][0] for each in data["charts"])
        assert max(np.abs(ground["y"])) == pytest.approx(0.3, rel=1e-4)
        np.testing.assert_allclose(np.interp(1.0, ground["x"], ground["y"]), 0.0, atol=1e-6)
        assert max(np.abs(ratio["y"])) == pytest.approx(shown.history.peak_ratio, rel=1e-3)
        assert stage["picture"] == shown.picture.as_dict()

    def test_its_colours_are_those_of_pictures_light_and_dark(self):
        light, dark = (
            dict(re.findall(r"--([\w-]+): (#\w+);", part))
            for part in asset("motion.css").split("@media screen and (prefers-color-scheme: dark)")
        )
        drawn = {"paper": style.PAPER, "shade-rest": style.RESTING_COLOUR}
        drawn |= {f"shade-{k}": each for k, each in enumerate(style.BODIES)}
        drawn |= {f"curve-{k}": each for k, each in enumerate(style.HUES)}
        for name, colour in drawn.items():
            assert (light[name], dark[name]) == (colour, style.DARK[colour])

    def test_it_needs_no_network_and_respects_what_a_reader_has_set(self):
        page = animation_page(film(0.3), "a block")
        for words in ("prefers-color-scheme: dark", "prefers-reduced-motion: reduce", 'name="viewport"', "ArrowLeft"):
            assert words in page
        addresses = set(re.findall(r"(?:https?:)?//[\w.]+", page)) - {"http://www.w3.org"}
        assert not {each for each in addresses if "." in each}
        assert not re.search(r"\b(src|href)\s*=|@import|url\((?!#)|fetch\(|XMLHttpRequest", page)

    def test_names_cannot_leave_their_place(self):
        evil = "</script><script>alert(1)</script>&<b>"
        page = animation_page(film(0.3, name=evil), evil)
        assert page.count("</script>") == 2 and "<b>" not in page and "alert(1)</" not in page
        data = data_of(page)
        assert f"<title>{html.escape(evil)}</title>" in page and f"<p>{html.escape(evil)}, PGA" in page
        assert data["stages"][0]["label"].startswith(evil)


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
        # The upper half of the block is to the right while it turns clockwise or the ground has moved there.
        turns, ways = Scene((shown,)).seen(shown, times)
        right = 0.75 * BLOCK.height * np.sin(turns) + ways
        assert np.corrcoef(leaning, right)[0, 1] > 0.99 > np.corrcoef(leaning, turns)[0, 1]

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
        rows = np.arange(160, 340)
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
        pulse = ("--pulse", "sine:0.6g:0.5s", "--polarity", "-1", "--neighbours", 2)
        ends, stone = [], tmp_path / "stone.yaml"
        corners = "polygon: [[0, 0], [0.7, 0], [0.6, 2.8], [0, 2.8]]"
        stone.write_text(f"mechanism: rigid_body\n{corners}\nfriction: 0.3\nname: a stone\n", encoding="utf-8")
        for limit, said in (("1", "The structure rocks to"), ("0.5%", "The outcome is unknown after")):
            asked = ("animate", stone, *pulse, "--opening", limit)
            assert said in run(*asked, "--out", "a.html").stdout
            page = Path("a.html").read_text(encoding="utf-8")
            assert "<h1>a stone" in page and len(data_of(page)["stages"][0]["picture"]["parts"]) == 1
            ends.append(data_of(page)["end"])
        assert ends[1] < ends[0]

    def test_polarity_and_scale_reach_the_motion(self, tmp_path):
        for out, more in (("a.html", []), ("b.html", ["--polarity", "-1"])):
            run("animate", "--pulse", "sine:0.15g:0.9s", "--scale", "2", "--out", out, *more)
        one, other = (data_of(Path(name).read_text(encoding="utf-8")) for name in ("a.html", "b.html"))
        one, other, same = (
            each["stages"][0]["rotation"] for each in (one, other, data_of(animation_page(film(0.3), "")))
        )
        np.testing.assert_allclose(one, np.negative(other))
        np.testing.assert_allclose(one, same)

    def test_structures_are_shown_in_one_file_and_have_a_line_each(self, tmp_path):
        frame, pulse = EXAMPLES / "frame.yaml", ("--pulse", "sine:0.3g:0.9s", "--neighbours", 0, "--out", "m.html")
        found = lines("animate", frame, "none.yaml", EXAMPLES / "block.yaml", *pulse, code=5)
        assert [each["name"] for each in found] == ["valley bridge", "pedestal"]
        assert [stage["name"] for stage in data_of(Path("m.html").read_text(encoding="utf-8"))["stages"]] == [
            "valley bridge", "pedestal"
        ]  # fmt: skip
        alone = run_json("animate", frame, *pulse)
        own = {"start", "end", "enlargement", "ground_enlargement"}
        assert {key: found[0][key] for key in alone if key not in own} == {
            key: value for key, value in alone.items() if key not in own
        }
        said = run("animate", frame, EXAMPLES / "block.yaml", *pulse).stdout
        assert "valley bridge" in said and "pedestal" in said and "Displacements are" in said
        more = run("animate", frame, frame, *pulse, "--pulse", "sine:0.4g:1s", code=2)
        assert "animated under one motion, and 2 are given" in more.stderr
        assert "takes 1 to 6 structures, got 7" in run("animate", *[frame] * 7, *pulse, code=2).stderr

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
            (["--out", "a.gif"], "--record or --pulse is missing"),
            (["--out", "a.avi", "--pulse", "sine:0.4g:1s"], "does not end in .html or .gif or .mp4"),
            (["--out", "a.gif", "--pulse", "sine:0.4g:1s", "--fps", "60"], "--fps must be at most 50"),
            (["--out", "a.gif", "--pulse", "sine:0.4g:1s", "--speed", "0.001"], "frames is too long (at most 3,000)"),
            (["--pulse", "sine:0.4g:1s"], "--out"),
        ],
    )
    def test_what_cannot_be_is_refused(self, tmp_path, arguments, said):
        assert said in run("animate", *arguments, code=2).stderr
        assert list(tmp_path.iterdir()) == []


def failing(folder, ends):
    """Write an ffmpeg that reads a little, complains and ends."""
    script = folder / "ffmpeg"
    script.write_text(f"#!/bin/sh\nhead -c 1000 >/dev/null\necho no such encoder >&2\n{ends}\n")
    script.chmod(script.stat().st_mode | stat.S_IXUSR)
    return script


class TestVideo:
    @pytest.mark.rest
    @pytest.mark.skipif(FFMPEG is None, reason="ffmpeg is not installed")
    def test_it_is_played_by_anything_and_has_every_frame(self, tmp_path):
        found = run_json("animate", "--pulse", "sine:0.3g:0.9s", "--neighbours", 0, "--out", "a.mp4", "--fps", 10)
        run("animate", "--pulse", "sine:0.3g:0.9s", "--neighbours", 0, "--out", "a.gif", "--fps", 10)
        read = [FFMPEG, "-loglevel", "error", "-i", "a.mp4", "-pix_fmt", "rgb24", "-f", "rawvideo", "pipe:1"]
        with Image.open("a.gif") as gif:
            wide, tall = gif.width + gif.width % 2, gif.height + gif.height % 2
            raw = np.frombuffer(subprocess.run(read, capture_output=True, check=True).stdout, np.uint8)
            video = raw.reshape(-1, tall, wide, 3)
            assert len(video) == gif.n_frames + 15 == found["frames"] + 15  # the last frame stays for 1.5 s
            for k in (0, 9, gif.n_frames - 1):
                gif.seek(k)
                still = np.asarray(gif.convert("RGB")).astype(float)
                assert np.abs(video[k][: gif.height, : gif.width] - still).mean() < 3

    def test_without_ffmpeg_nothing_is_done(self, tmp_path, monkeypatch):
        monkeypatch.setattr(shutil, "which", lambda name: None)
        refused = run("animate", EXAMPLES / "none.yaml", "--pulse", "sine:0.3g:0.9s", "--out", "a.mp4", code=2)
        assert "requires the program ffmpeg" in refused.stderr and "none.yaml" not in refused.stderr
        assert list(tmp_path.iterdir()) == []

    @pytest.mark.skipif(sys.platform == "win32", reason="Windows runs no scripts of the shell")
    @pytest.mark.parametrize("ends", ["exit 3", "kill -9 $$", "exit 0"])
    def test_one_that_fails_is_reported(self, tmp_path, ends):
        """It reads a little and ends: with a code, killed, or as if all were well, without a video."""
        script = failing(tmp_path, ends)
        frames = (Image.new("RGB", (400, 301)) for _ in range(20))
        with (
            (tmp_path / "a.mp4").open("wb") as stream,
            pytest.raises(Refused, match=r"ffmpeg did not write .*no such encoder"),
        ):
            write_mp4(stream, str(script), frames, 20.0)

    @pytest.mark.skipif(sys.platform == "win32", reason="Windows runs no scripts of the shell")
    def test_a_command_whose_ffmpeg_is_killed_writes_no_file(self, tmp_path, monkeypatch):
        script = failing(tmp_path, "kill -9 $$")
        monkeypatch.setattr(shutil, "which", lambda name: str(script))
        failed = run("animate", "--pulse", "sine:0.3g:0.9s", "--neighbours", 0, "--out", "a.mp4", code=1)
        assert "ffmpeg did not write the video" in failed.stderr
        assert [each.name for each in tmp_path.iterdir()] == ["ffmpeg"]
