"""The page to explore: in a browser it answers as the commands do, to the last bit, and it shows its state."""

import html
import json
import re
import shlex
import subprocess
from math import isnan
from pathlib import Path

import numpy as np
import pytest

import rocking_cli as rk
from rocking_cli.core import Direction
from rocking_cli.names import peaks_over
from rocking_cli.questions.explore.page import SHAPES
from rocking_cli.structure import Structure
from rocking_cli.studies.neighbours import Conditions, neighbours
from rocking_cli.studies.response import concluded
from rocking_cli.views.conclusion import headline
from rocking_cli.views.neighbours import neighbours_in_words
from rocking_cli.views.verdict import SENSE, unknown_after
from tests.browser import launch, opened
from tests.cli.test_cli import run, run_json
from tests.conftest import EXAMPLES

ACCEL = EXAMPLES / "accel.csv"
USUAL = {
    "structure": 0, "motion": "record", "scale": 1, "polarity": 1, "time": 1, "amplitude": 0.4, "period": 1,
    "restitution": None, "size": 1, "slender": 1, "value": None,
}  # fmt: skip
ENGINE = 'startEngine(JSON.parse(document.getElementById("data").textContent))'
HISTORIES = """async settings => {
  const engine = await START;
  await engine.all;
  const text = (_, value) => typeof value === "number" && !Number.isFinite(value) ? String(value) : value;
  return JSON.stringify(settings.map(each => {
    const {phi, outcome, headline, sentences} = engine.history(each);
    const files = {command: engine.command(each), yaml: engine.yaml(each)};
    return {...outcome, phi: Array.from(phi), headline, sentences, ...files};
  }), text);
}""".replace("START", ENGINE)
ASKED = "async ([kind, settings]) => { const engine = await START; return engine[kind](settings); }".replace(
    "START", ENGINE
)
FIELDS = ("peak_ratio", "overturning_time", "uplift_time", "impact_count", "known_to", "lower_bound")


@pytest.fixture(scope="module")
def browser():
    found, driver = launch()  # skipped where there is none
    yield found
    found.close()
    driver.stop()


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """The page of a structure under the record, made once."""
    folder, pages = tmp_path_factory.mktemp("pages"), {}

    def page(name, **more):
        key = (name, *map(str, more.items()))
        if key not in pages:
            pages[key] = folder / f"{len(pages)}.html"
            rk.explore(EXAMPLES / f"{name}.yaml", ACCEL, out=pages[key], **more)
        return pages[key]

    return page


def asked(browser, path, script, argument):
    """What the engine of a page answers."""
    found = browser.new_page()
    try:
        found.goto(path.as_uri())
        return found.evaluate(script, argument)
    finally:
        found.close()


def histories(browser, path, settings):
    """The histories of settings, with numbers that JSON has none of."""
    words = {"NaN": float("nan"), "Infinity": float("inf"), "-Infinity": float("-inf")}
    return [
        {key: words.get(value, value) if isinstance(value, str) else value for key, value in each.items()}
        for each in json.loads(asked(browser, path, HISTORIES, settings))
    ]


def random_settings(rng, count):
    """Motions about those that uplift and far beyond, records and pulses."""
    for _ in range(count):
        scale, amplitude, period = (float(f"{each:.4g}") for each in np.exp(rng.uniform([-1, -1.5, -1], [1.5, 0.7, 1])))
        yield USUAL | {
            "motion": str(rng.choice(["record", "record", *SHAPES])), "scale": scale, "amplitude": amplitude,
            "period": period, "polarity": int(rng.choice([-1, 1])),
            "restitution": None if rng.random() < 0.5 else float(np.round(rng.uniform(0.3, 0.77), 3)),
        }  # fmt: skip


def followed(structure, settings):
    """The history by `respond`."""
    record = settings["motion"] == "record"
    motion = ACCEL if record else f"{settings['motion']}:{settings['amplitude']!r}g:{settings['period']!r}s"
    how = {"scale": settings["scale"]} if record else {}
    how |= {} if settings["restitution"] is None else {"restitution": settings["restitution"]}
    answer = rk.respond(structure, motion, polarity=settings["polarity"], engine="exact", model="nonlinear", **how)
    return answer["nonlinear"]


def same(one, other, tolerance=0.0):
    return abs(one - other) <= tolerance * abs(one) or (isnan(one) and isnan(other))


def check_histories(browser, path, structure, settings, tolerance=0.0):
    """Compare histories; under pulses, sines of other periods differ by the last bits."""
    for each, found in zip(settings, histories(browser, path, settings), strict=True):
        run_ = followed(structure, each)
        within = tolerance or (0.0 if each["motion"] == "record" else 1e-12)
        for name in FIELDS:
            assert same(float(getattr(run_, name)), found[name], within), (name, each)
        end = concluded({1: {"nonlinear": run_}}, {})
        assert found["headline"] == headline(end, peaks_over(run_.ends_at_limit))
        if run_.unknown:
            assert found["sentences"][0] == f"{unknown_after(run_)} The structure may overturn."
        if run_.fell:
            assert f" {SENSE[Direction(run_.fell_to)]}, at {run_.overturning_time:.4g} s" in found["sentences"][0]
            assert f"after {len(run_.felt)} impact" in found["sentences"][0]
        phi = np.array([np.nan if value == "NaN" else value for value in found["phi"]], float)
        np.testing.assert_allclose(phi, run_.phi, rtol=within, atol=within)


class TestNumbers:
    @pytest.mark.parametrize(
        "name, count", [("block", 12), ("frame", 6), ("masonry/portal", 6), ("verify/tied_facade", 6)]
    )
    def test_histories_are_those_of_respond(self, browser, made, name, count):
        settings = [*random_settings(np.random.default_rng(1), count)]
        check_histories(browser, made(name), EXAMPLES / f"{name}.yaml", settings)

    @pytest.mark.rest
    @pytest.mark.parametrize("name, count", [
        ("block", 60), ("frame", 40), ("wall", 30), ("arch", 20), ("rigid_body", 20), ("linkage", 15), ("cone", 15),
    ])  # fmt: skip
    def test_two_hundred_histories_are_those_of_respond(self, browser, made, name, count):
        settings = [*random_settings(np.random.default_rng(2), count)]
        check_histories(browser, made(name), EXAMPLES / f"{name}.yaml", settings)

    def test_another_size_is_that_of_the_file_that_it_gives(self, browser, made, tmp_path):
        settings = [USUAL | {"size": 1.7, "scale": 1.3, "value": None}]
        (found,) = histories(browser, made("block"), settings)
        (tmp_path / "larger.yaml").write_text(found["yaml"], encoding="utf-8")
        check_histories(browser, made("block"), tmp_path / "larger.yaml", settings, tolerance=1e-9)
        assert "pedestal_size_1.7.yaml --record" in found["command"]["command"]

    def test_another_time_scale_is_another_interval(self, browser, made):
        (found,) = histories(browser, made("block"), [USUAL | {"time": 1.4, "scale": 1.2}])
        motion = rk.read_record(ACCEL)
        slower = rk.GroundMotion("slower", 1.4 * motion.dt, motion.acceleration, unit="m/s2")
        run_ = rk.respond(EXAMPLES / "block.yaml", slower, scale=1.2, engine="exact", model="nonlinear")["nonlinear"]
        assert all(same(float(getattr(run_, name)), found[name]) for name in FIELDS)
        assert found["command"] == {"command": None, "why": "No command has this time scale: reset it."}

    @pytest.mark.parametrize("name", ["block", "masonry/portal"])
    @pytest.mark.parametrize("more", [{}, {"restitution": 0.813}, {"scale": 1.5, "polarity": -1}])
    def test_neighbours_are_those_of_respond(self, browser, made, name, more):
        settings = USUAL | more
        found = asked(browser, made(name), ASKED, ["neighbours", settings])
        structure = Structure(rk.load_structure(EXAMPLES / f"{name}.yaml")).under(restitution=settings["restitution"])
        motion = rk.read_record(ACCEL).scaled(settings["polarity"] * settings["scale"])
        near = neighbours(Conditions(structure, ["nonlinear"]), motion)
        assert (found["overturned"], found["unknown"]) == (near.overturned, near.unknown)
        assert found["as_itself"] == near.as_itself and found["sentence"] == neighbours_in_words(near)

    def test_slenderness_is_by_the_rule_of_neighbours(self, browser, made):
        (found,) = histories(browser, made("block"), [USUAL | {"slender": 1.1}])
        model = Structure(rk.load_structure(EXAMPLES / "block.yaml")).model("nonlinear")
        from rocking_cli.dynamics.batch import Runs, respond_many

        other = respond_many([model], [rk.read_record(ACCEL)], Runs.of(0, 0, slender=1.1))
        assert found["peak_ratio"] == other.peak_ratio[0] and found["uplift_time"] == other.uplift_time[0]
        assert "width over height" in found["command"]["why"]

    def test_neighbours_that_only_slide(self, browser, tmp_path):
        foot, page = rk.RigidBody(polygon=[[0, 0], [0.7, 0], [0.75, 1.3], [0, 1.3]], friction=0.6), tmp_path / "a.html"
        rk.explore(foot, ACCEL, out=page)
        near = neighbours(Conditions(Structure(foot), ["nonlinear"]), rk.read_record(ACCEL).scaled(1.1))
        found = asked(browser, page, ASKED, ["neighbours", USUAL | {"scale": 1.1}])
        assert 0 < near.slides < 1 and found["sentence"].count(f"{round(200 * near.slides)} (") == 1
        assert (found["overturned"], found["unknown"]) == (near.overturned, near.unknown or 0)

    def test_no_file_is_another_size_of_what_carries_a_tie(self, browser, made):
        """Weights grow as the cube of the size, ties do not."""
        (found,) = histories(browser, made("verify/tied_facade"), [USUAL | {"size": 0.5}])
        assert found["yaml"] is None and "No file" in found["command"]["why"]
        (found,) = histories(browser, made("linkages/statue_on_pedestal"), [USUAL | {"size": 0.5}])
        assert found["yaml"] is None  # the mass of the statue is given

    def test_the_margin_is_that_of_the_command(self, browser, made):
        found = asked(browser, made("block", neighbours=20), ASKED, ["margin", USUAL])
        (margin,) = rk.margin(EXAMPLES / "block.yaml", ACCEL, neighbours=20).values()
        np.testing.assert_allclose(found["factors"], margin.factors, rtol=1e-15)
        assert found["overturned"] == margin.overturned.tolist() and found["unknown"] == margin.unknown.tolist()
        words = run("margin", EXAMPLES / "block.yaml", "--record", ACCEL, "--neighbours", "20").stdout
        last = re.search(r"at which 10 % or more may overturn is ([\d.]+)\.", " ".join(words.split()))[1]
        assert found["sentence"] == f"Of 61 factors tried, the smallest at which 10 % or more may overturn is {last}."

    def test_the_map_is_that_of_the_command(self, browser, made):
        found = asked(browser, made("block"), ASKED, ["map", USUAL])
        n = len(found["periods"])
        classes = np.array(found["classes"]).reshape(n, n)
        ends = {"period": found["periods"], "ag": found["amplitudes"]}
        axes = {key: (min(each), max(each)) for key, each in ends.items()}
        whole = rk.overturning_map(EXAMPLES / "block.yaml", model="nonlinear", points=n, **axes)
        regions = whole.regions if whole.periods[0] < whole.periods[-1] else whole.regions[:, ::-1]
        assert (classes == regions).mean() > 0.99 and len({*classes.ravel().tolist()}) > 2

    @pytest.mark.rest
    def test_a_field_that_varies(self, browser, tmp_path):
        page, span = tmp_path / "vary.html", ("width", "0.65m", "0.75m")
        rk.explore(EXAMPLES / "block.yaml", ACCEL, vary=span, out=page, neighbours=1)
        settings = [USUAL | {"value": 3, "scale": 1.4}, USUAL | {"value": None, "scale": 1.4}]
        vary = asked(browser, page, f"async () => (await {ENGINE}).structures[0].vary", None)
        assert len(vary["values"]) == 21 and vary["values"][vary["usual"]] == 0.7
        wide = rk.load_structure(EXAMPLES / "block.yaml").replace(width=vary["values"][3])
        for each, structure in zip(settings, (wide, EXAMPLES / "block.yaml"), strict=True):
            check_histories(browser, page, structure, [each])


class TestPage:
    @pytest.mark.parametrize("width", [1280, 390])
    def test_it_answers_and_fits(self, browser, made, width):
        with opened(browser, made("block"), viewport={"width": width, "height": 900}) as page:
            page.wait_for_selector("#explore:not([hidden])")
            assert "rocks to 0.481" in page.inner_text("#headline")
            page.wait_for_function("document.body.innerText.includes('13 (6.5 %) overturn')")
            assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")

    def test_hostile_names_do_nothing(self, browser, tmp_path):
        name = "</script><img src=x onerror=alert(1)>'\""
        page = tmp_path / "hostile.html"
        rk.explore(rk.Block(width=0.7, height=2.8, name=name), "sine:0.3g:0.9s", out=page, neighbours=5)
        with opened(browser, page) as shown:
            shown.wait_for_selector("#explore:not([hidden])")
            assert shown.evaluate("document.images.length") == 0
            assert "onerror" in shown.inner_text("h1")

    def test_without_scripts_it_shows_the_still(self, browser, made):
        with opened(browser, made("block"), java_script_enabled=False) as page:
            assert "rocks to 0.481 phi_cr" in page.inner_text("body") and page.locator("#still svg").count() > 0
            assert not page.locator("#explore").is_visible()

    def test_the_command_that_it_shows_gives_the_history(self, browser, tmp_path, monkeypatch):
        monkeypatch.chdir(EXAMPLES)
        page = tmp_path / "page.html"
        run("explore", "frame.yaml", "--record", "accel.csv", "--scale", "1.5", "-o", page)
        settings = USUAL | {"scale": 1.2, "polarity": -1, "restitution": 0.9}
        (found,) = histories(browser, page, [settings])
        words = found["command"]["command"].split()
        assert words[:2] == ["rocking", "respond"]
        answer = run_json(*words[1:], "--neighbours", "0")
        assert answer["responses"]["nonlinear"]["peak_ratio"] == found["peak_ratio"]

    def test_the_command_has_what_the_run_was_told(self, browser, tmp_path, monkeypatch):
        monkeypatch.chdir(tmp_path)
        name, told = "it's $HOME.yaml", ["--record", "a b.csv", "--units", "g", "--scale", "1.3", "--opening", "0.05"]
        (tmp_path / name).write_text((EXAMPLES / "block.yaml").read_text("utf-8"), encoding="utf-8")
        (tmp_path / "a b.csv").write_text(ACCEL.read_text("utf-8"), encoding="utf-8")
        run("explore", name, *told, "-o", "page.html")
        (found,) = histories(browser, tmp_path / "page.html", [USUAL])
        assert shlex.split(found["command"]["command"]) == ["rocking", "respond", name, *told, "--engine", "exact"]
        run("report", name, *told[:2], "--restitution", "0.8", "--explore", "-o", "r.html", "--neighbours", "5")
        within = re.search(r'srcdoc="(.*?)"></iframe>', Path("r.html").read_text("utf-8"), re.S)[1]
        Path("within.html").write_text(html.unescape(within), encoding="utf-8")
        (found,) = histories(browser, tmp_path / "within.html", [USUAL])
        words = shlex.split(found["command"]["command"])
        assert words[-4:-2] == ["--restitution", "0.8"] and words[:3] == ["rocking", "respond", name]
        answer = run_json(*words[1:], "--neighbours", "0")
        assert answer["responses"]["nonlinear"]["peak_ratio"] == found["peak_ratio"]

    @pytest.mark.parametrize("name", ["linkage", "walls/gable"])
    def test_restitutions_of_narrow_bounds(self, made, name):
        assert made(name, neighbours=3).stat().st_size > 1e5

    def test_a_report_has_it_in_the_place_of_the_animation(self, browser, tmp_path):
        page = tmp_path / "report.html"
        run("report", EXAMPLES / "block.yaml", "--record", ACCEL, "--explore", "-o", page, "--neighbours", "10")
        with opened(browser, page) as shown:
            within = shown.frame_locator("iframe.within")
            within.locator("#explore:not([hidden])").wait_for()
            assert "rocks to 0.481" in within.locator("#headline").inner_text()
        told = run("report", EXAMPLES / "block.yaml", "--record", ACCEL, "--explore", "-o", "a.pdf", code=2).stderr
        assert "--explore has no effect" in told


class TestRefusals:
    def test_what_the_page_cannot_follow(self, tmp_path):
        with pytest.raises(rk.InputError, match="three or more of its columns may fall out of step"):
            rk.explore(EXAMPLES / "symmetric_frame.yaml", ACCEL, out=tmp_path / "a.html")
        assert [*tmp_path.iterdir()] == []

    def test_a_body_that_only_slides(self, tmp_path):
        with pytest.raises(rk.InputError, match="it slides under horizontal motion and does not rock"):
            rk.explore(rk.Block(width=0.7, height=1.4, friction=0.4), ACCEL, out=tmp_path / "a.html")

    @pytest.mark.parametrize("more, words", [
        ({"vary": "width=2m:1m"}, "not increasing"),
        ({"vary": "width=1m:2m"}, "the value in it that the file gives, 0.7"),
        ({"vary": "colour=1:2"}, "colour"),
    ])  # fmt: skip
    def test_ranges(self, tmp_path, more, words):
        with pytest.raises(rk.InputError, match=re.escape(words)):
            rk.explore(EXAMPLES / "block.yaml", ACCEL, out=tmp_path / "a.html", **more)

    def test_too_many(self, tmp_path):
        with pytest.raises(rk.InputError, match="takes 1 to 6 structures, got 7"):
            rk.explore([EXAMPLES / "block.yaml"] * 7, ACCEL, out=tmp_path / "a.html")
        with pytest.raises(rk.InputError, match="a page is for one motion, and 2 are given"):
            rk.explore(EXAMPLES / "block.yaml", [ACCEL, "sine:0.3g:1s"], out=tmp_path / "a.html")


def test_the_size_of_a_page(made):
    assert made("frame").stat().st_size < 1e6 and made("arch").stat().st_size < 2e6


def test_the_scripts_are_parsed(tmp_path):
    """As text, by node where there is one: a page whose script ends early says nothing."""
    from rocking_cli.plotting.moving import asset

    for name in ("kernel.js", "explore.js"):
        (tmp_path / name).write_text(asset(name), encoding="utf-8")
        try:
            subprocess.run(["node", "--check", tmp_path / name], check=True)
        except FileNotFoundError:
            pytest.skip("no node here")
