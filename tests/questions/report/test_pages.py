"""The report and the page of `rocking animate`, opened and used in a real Chromium."""

import json

import numpy as np
import pytest

from rocking_cli.ask.read import read_record
from rocking_cli.core.structure_file import load_structure
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.studies.film import Film
from rocking_cli.studies.picture import picture
from tests.browser import launch, opened
from tests.cli.test_cli import run
from tests.conftest import EXAMPLES
from tests.following import respond
from tests.questions.draw.test_hung import TIED_FILE

pytestmark = [pytest.mark.rest, pytest.mark.drawn]

FRAME, ACCEL = EXAMPLES / "frame.yaml", EXAMPLES / "accel.csv"
EVIL = '<script>alert(1)</script> & "quotes" </script> {{ 7*7 }}'
# Corners of the bodies [m] as they are on the screen, and pixels to a metre.
CORNERS = """root => {
  const plane = root.querySelector(".plane").getScreenCTM(), back = plane.inverse();
  const bodies = [...root.querySelectorAll(".body")].map(path => {
    const matrix = back.multiply(path.getScreenCTM());
    return path.getAttribute("d").slice(1, -1).split("L").map(pair => {
      const [x, y] = pair.split(",").map(Number), at = new DOMPoint(x, y).matrixTransform(matrix);
      return [at.x, at.y];
    });
  });
  return {bodies, scale: plane.a};
}"""
SET = "(slider, time) => { slider.value = time; slider.dispatchEvent(new Event('input', {bubbles: true})); }"
CONTRASTS = """() => {
  const parts = text => { const v = text.match(/[\\d.]+/g).map(Number); return v.length < 4 ? [...v, 1] : v; };
  const light = c => { const v = c / 255; return v <= .03928 ? v / 12.92 : ((v + .055) / 1.055) ** 2.4; };
  const luminance = c => .2126 * light(c[0]) + .7152 * light(c[1]) + .0722 * light(c[2]);
  const behind = node => {
    for (let at = node; at; at = at.parentElement) {
      const c = parts(getComputedStyle(at).backgroundColor);
      if (c[3] > 0) return c;
    }
    return [255, 255, 255, 1];
  };
  const found = [];
  for (const node of document.querySelectorAll("body *")) {
    const own = [...node.childNodes].some(each => each.nodeType === 3 && each.textContent.trim());
    if (!own || ["SCRIPT", "STYLE", "NOSCRIPT"].includes(node.tagName) || !node.getClientRects().length) continue;
    const style = getComputedStyle(node), svg = node instanceof SVGElement;
    const [a, b] = [luminance(parts(svg ? style.fill : style.color)), luminance(behind(node))];
    const matrix = svg && node.getScreenCTM();
    const size = parseFloat(style.fontSize) * (matrix ? Math.hypot(matrix.a, matrix.b) : 1);
    const ratio = (Math.max(a, b) + .05) / (Math.min(a, b) + .05);
    found.push({text: node.textContent.trim().slice(0, 40), ratio, size});
  }
  return found;
}"""


@pytest.fixture(scope="module")
def browser():
    found, driver = launch()
    yield found
    found.close()
    driver.stop()


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("pages")


@pytest.fixture(scope="module")
def report(browser, frame_report):
    return frame_report[0]


@pytest.fixture(scope="module")
def animation(folder, browser):
    path = folder / "animation.html"
    run("animate", FRAME, "--record", ACCEL, "--out", path)
    return path


@pytest.fixture(scope="module")
def beside(folder, browser):
    """Two structures that rock and one whose outcome becomes unknown, under one motion."""
    path = folder / "beside.html"
    files = (EXAMPLES / "arch.yaml", FRAME, EXAMPLES / "block.yaml")
    run("animate", *files, "--pulse", "sine:0.6g:0.5s", "--opening", "0.3%", "--neighbours", 0, "--out", path)
    return path


@pytest.fixture(scope="module")
def film():
    """What the pages must show: the motion as given governs here."""
    mechanism, motion = load_structure(FRAME), read_record(ACCEL)
    return Film(picture(mechanism), respond(mechanism, motion, models=("nonlinear",))["nonlinear"], motion)


def corners(page):
    found = page.locator(".motion").first.evaluate(CORNERS)
    return [np.array(each) @ (1, 1j) for each in found["bodies"]], found["scale"]


def point(page, time, plot=0):
    """Pixels of a time on a chart, from the numbers of its axis."""
    middle = "all => all.map(t => [parseFloat(t.textContent), (b => b.x + b.width / 2)(t.getBoundingClientRect())])"
    ticks = page.locator(".plot").nth(plot).locator(".tick").evaluate_all(middle)
    if ticks[0][0] == 0:
        ticks = ticks[1:]  # the first has its unit beside it
    t, x = np.array(ticks).T
    box = page.locator(".plot").nth(plot).bounding_box()
    return float(np.polyval(np.polyfit(t, x, 1), time)), box["y"] + box["height"] / 2


def values(page):
    return [float(text) if text != "–" else None for text in page.locator(".value").all_text_contents()]


HUNG = """\
mechanism: block
name: tied block
width: 0.6
height: 4
density: 2000
depth: 1
loads:
  - {name: floor, mass: 1 t, at: [0.2, 3]}
  - {name: thrust, force: [100 N, 0 N], at: [-0.3, 2]}
ties:
  - {name: bar, from: {ground: [-2, 3]}, to: {at: [-0.3, 3]}, stiffness: 9 kN/m, only: tension}
"""
# Ends of the tie and places of the loads [m], as they are on the screen, and how the tie looks.
OF_HUNG = """root => {
  const plane = root.querySelector(".plane").getCTM(), tie = root.querySelector(".tie");
  const back = (x, y) => { const at = new DOMPoint(x, y).matrixTransform(plane.inverse()); return [at.x, at.y]; };
  const shift = tie.getCTM();
  const place = (x, y) => { const at = new DOMPoint(x, y).matrixTransform(shift); return back(at.x, at.y); };
  const points = tie.getAttribute("d").slice(1).split("L").map(pair => pair.split(",").map(Number));
  const loads = [...root.querySelectorAll(".weight, .force")].map(each => each.getCTM());
  const marks = loads.map(matrix => back(matrix.e, matrix.f));
  return {ends: [place(...points[0]), place(...points.at(-1))], marks, slack: tie.classList.contains("slack"),
          names: [...root.querySelectorAll(".hung")].map(each => each.textContent)};
}"""


def test_loads_and_ties_are_where_they_are_in_the_history(browser, folder):
    structure, path = folder / "hung.yaml", folder / "hung.html"
    structure.write_text(HUNG)
    run("animate", structure, "--pulse", "sine:0.5g:0.7s", "--out", path, "--neighbours", 0)
    mechanism = load_structure(structure)
    shown = picture(mechanism)
    seen = set()
    with opened(browser, path) as page:
        data = json.loads(page.locator("#data").text_content())
        rotation = np.array(data["stages"][0]["rotation"])
        for k in range(0, len(rotation), 20):
            page.locator("input[type=range]").evaluate(SET, data["start"] + k * data["step"])
            found = page.locator(".motion").evaluate(OF_HUNG)
            loads, ((ends,),), (slack,) = shown.hung(data["enlargement"] * rotation[k], 0.0)
            np.testing.assert_allclose(np.array(found["ends"]) @ (1, 1j), ends, atol=1e-3)
            np.testing.assert_allclose(np.array(found["marks"]) @ (1, 1j), loads, atol=1e-3)
            if rotation[k]:
                assert found["slack"] == slack
                seen.add(slack)
        assert found["names"] == ["bar", "floor, 1 t", "thrust, 0.1 kN"]
    assert seen == {True, False}


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_the_report_of_a_tied_structure_reads_on_a_telephone(browser, folder, scheme):
    structure, path = folder / "hung.yaml", folder / "hung-report.html"
    structure.write_text(HUNG)
    run("report", structure, "--pulse", "sine:0.5g:0.7s", "--neighbours", 5, "-o", path)
    with opened(browser, path, viewport={"width": 360, "height": 700}, color_scheme=scheme) as page:
        assert page.evaluate("document.documentElement.scrollWidth") <= 360
        page.locator("nav summary").click()  # folded on a phone
        page.locator("nav a", has_text="Loads and ties").click()
        assert page.locator("#hung table").count() == 5
        assert page.locator(".tie").first.is_visible()
        for each in page.evaluate(CONTRASTS):
            assert each["ratio"] >= 4.5, each


def test_a_structure_without_a_critical_rotation_moves_against_its_limit(browser, folder):
    structure, path = folder / "tied.yaml", folder / "tied.html"
    structure.write_text(TIED_FILE)
    run("animate", structure, "--pulse", "sine:0.5g:0.7s", "--out", path, "--neighbours", 0)
    with opened(browser, path) as page:
        data = json.loads(page.locator("#data").text_content())
        rotation = data["stages"][0]["rotation"]
        k = int(np.argmax(rotation))
        page.locator("input[type=range]").evaluate(SET, data["start"] + k * data["step"])
        share = rotation[k] / (np.pi / 2)
        assert f"φ/limit = {share:.5f}" in page.locator(".now").text_content()
        assert "φ/limit" in page.locator(".legend").first.text_content()


@pytest.mark.parametrize("what", ["report", "animation"])
def test_the_slider_moves_the_drawing_to_where_the_structure_is(what, browser, film, request):
    at_rest = [each for part in film.picture.placed(0.0)[0] for each in part]
    with opened(browser, request.getfixturevalue(what)) as page:
        for time in (3.6, 3.97, 5.0):
            page.locator(".motion input").first.evaluate(SET, time)
            drawn, scale = corners(page)
            rotation = float(film.rotation(np.array([time]))[0])
            expected = [each for part in film.picture.placed(rotation)[0] for each in part]
            assert len(drawn) == len(expected) == 3
            for one, other, rest in zip(drawn, expected, at_rest, strict=True):
                assert scale * np.abs(one - other).max() < 0.5  # pixels
                assert scale * np.abs(one - rest).max() > 3
            assert f"t = {time:.2f} s" in page.locator(".now").first.text_content()


@pytest.mark.rest
def test_hovering_reads_the_histories_and_moves_the_drawing(browser, report, film):
    with opened(browser, report) as page:
        page.locator(".plot").first.scroll_into_view_if_needed()
        before, _ = corners(page)
        page.mouse.move(*point(page, 4.8))
        time = float(page.locator(".now").text_content().split()[2])
        assert time == pytest.approx(4.8, abs=0.03)  # a pixel or two
        runs = respond(load_structure(FRAME), read_record(ACCEL))
        k = round(time / 0.01)
        shown = values(page)
        for one, history in zip(shown[:3], runs.values(), strict=True):
            assert one == pytest.approx(history.ratio[k], abs=6e-4)
        assert shown[3] == pytest.approx(read_record(ACCEL).acceleration[k] / STANDARD_GRAVITY, abs=6e-4)
        after, _ = corners(page)
        assert np.abs(after[0] - before[0]).max() > 0.1


def ends(page, plot=0):
    texts = page.locator(".plot").nth(plot).locator(".tick").all_text_contents()
    return float(texts[0].split()[0]), float(texts[-1])


@pytest.mark.rest
def test_zoom_by_wheel_drag_button_and_key_changes_both_charts_and_reset_restores(browser, report):
    with opened(browser, report) as page:
        page.locator(".plot").first.scroll_into_view_if_needed()
        whole, path = ends(page), page.locator(".plot .trace").first.get_attribute("d")
        x, y = point(page, 4.0)

        def zoomed():
            low, high = ends(page)
            assert (low, high) == ends(page, 1)
            smaller = high - low < 0.8 * (whole[1] - whole[0])
            page.get_by_role("button", name="Show all").click()
            assert ends(page) == whole
            assert page.locator(".plot .trace").first.get_attribute("d") == path
            return smaller

        page.mouse.move(x, y)
        page.mouse.wheel(0, -400)
        assert ends(page) == whole  # not clicked: the wheel is the page's
        page.evaluate("scrollTo(0, 0)")
        page.locator(".plot").first.scroll_into_view_if_needed()
        x, y = point(page, 4.0)
        page.mouse.click(x, y)
        page.mouse.wheel(0, -400)
        page.wait_for_timeout(100)
        assert zoomed()
        page.mouse.move(*point(page, 4.0))
        page.mouse.down()
        page.mouse.move(*point(page, 6.0), steps=4)
        assert page.locator(".selection").count() == 1
        page.mouse.up()
        low, high = ends(page)
        assert low >= 3.95 and high <= 6.05
        assert zoomed()
        page.get_by_role("button", name="Zoom in").click()
        assert zoomed()
        page.locator(".plot").first.focus()
        page.keyboard.press("+")
        low, high = ends(page)
        page.keyboard.press("0")
        assert high - low < 0.8 * (whole[1] - whole[0]) and ends(page) == whole


def test_two_fingers_zoom(browser, report):
    with opened(browser, report, has_touch=True) as page:
        page.locator(".plot").first.scroll_into_view_if_needed()
        whole = ends(page)
        x, y = point(page, 5.0)
        touch = page.context.new_cdp_session(page)
        for kind, apart in (("touchStart", 30), ("touchMove", 40), ("touchMove", 80), ("touchMove", 120)):
            points = [{"x": x - apart, "y": y, "id": 0}, {"x": x + apart, "y": y, "id": 1}]
            touch.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})
        touch.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})
        low, high = ends(page)
        assert high - low < 0.6 * (whole[1] - whole[0])


@pytest.mark.parametrize("what", ["report", "animation"])
def test_play_advances_and_pauses_and_keys_move_the_time(what, browser, film, request):
    with opened(browser, request.getfixturevalue(what)) as page:
        slider = page.locator(".motion input").first
        start = float(slider.input_value())
        page.get_by_role("button", name="Play").click()
        page.wait_for_function(f"Number(document.querySelector('.motion input').value) > {start + 0.1}")
        page.get_by_role("button", name="Pause").click()
        stopped = float(slider.input_value())
        slider.focus()
        page.keyboard.press("ArrowRight")
        assert float(slider.input_value()) == pytest.approx(stopped + 0.1, abs=1e-6)
        page.keyboard.press("Home")
        assert float(slider.input_value()) == pytest.approx(film.start)


def test_the_animation_plays_at_once_unless_asked_for_calm(browser, animation):
    with opened(browser, animation, reduced_motion="no-preference") as page:
        assert page.get_by_role("button", name="Pause").count() == 1
    with opened(browser, animation) as page:
        assert page.get_by_role("button", name="Play").count() == 1


def test_what_is_unknown_stands_still_beside_what_is_not(browser, beside):
    moved = "all => all.map(each => [...each.querySelectorAll('.world, .part')].map(g => g.getAttribute('transform')))"
    with opened(browser, beside) as page:
        data = json.loads(page.locator("#data").text_content())
        stops = [stage["stops"] for stage in data["stages"]]
        assert 0 < stops[0] < 1 and stops[1:] == [None, None]
        places, slider = [], page.locator(".motion input")
        for time in (stops[0], stops[0] + 0.2, 2.0):
            slider.evaluate(SET, time)
            places.append(page.locator(".actor").evaluate_all(moved))
        one, *later = ([each[k] for each in places] for k in range(3))
        assert one[0] == one[1] == one[2] and all(each[1] != each[2] for each in later)
        assert page.locator(".stopped").count() == 1 == page.locator(".fate", has_text="unknown after").count()
        scales = page.locator(".plane").evaluate_all("all => all.map(each => each.getScreenCTM().a)")
        assert scales == pytest.approx([scales[0]] * 3, rel=1e-4)


@pytest.mark.parametrize("what", ["report", "animation", "beside"])
@pytest.mark.parametrize(("scheme", "width"), [("light", 1000), ("dark", 360)])
def test_text_is_legible_and_nothing_sticks_out(what, scheme, width, browser, request):
    look = {"color_scheme": scheme, "viewport": {"width": width, "height": 800}}
    with opened(browser, request.getfixturevalue(what), **look) as page:
        found = page.evaluate(CONTRASTS)
        assert len(found) > 20
        assert [each for each in found if each["ratio"] < 4.5] == []
        assert [each for each in found if each["size"] < 8] == []  # pixels: a subscript in a picture
        assert page.evaluate("document.documentElement.scrollWidth") <= width
        assert page.evaluate("getComputedStyle(document.body).backgroundColor") == (
            "rgb(255, 255, 255)" if scheme == "light" else "rgb(22, 24, 27)"
        )


@pytest.mark.parametrize(("what", "scheme"), [("report", "dark"), ("animation", "light"), ("beside", "dark")])
def test_axe_finds_nothing(what, scheme, browser, request):
    axe = pytest.importorskip("axe_playwright_python.sync_playwright")
    with opened(browser, request.getfixturevalue(what), color_scheme=scheme) as page:
        found = axe.Axe().run(page).response
        assert len(found["passes"]) > 20
        assert [(each["id"], [node["html"] for node in each["nodes"]]) for each in found["violations"]] == []


def test_on_paper_everything_is_there_and_nothing_to_press(browser, report):
    with opened(browser, report, color_scheme="dark") as page:
        page.emulate_media(media="print", color_scheme="dark")
        assert not any(page.locator("button, input, select").nth(k).is_visible() for k in range(5))
        shown = ("#summary svg", "#structure table", ".stage", ".plot svg", "#pulses svg", "#error svg", "nav li")
        for part in shown:
            assert page.locator(part).first.is_visible(), part
        assert "yaml" in page.locator("#inputs").inner_text()
        assert page.locator("#summary").evaluate("e => e.getBoundingClientRect().bottom") < 1050  # pixels: a page of A4
        found = page.evaluate(CONTRASTS)
        assert [each for each in found if each["ratio"] < 4.5] == []
        assert page.evaluate("getComputedStyle(document.body).backgroundColor") == "rgb(255, 255, 255)"


def test_names_stay_text(browser, folder):
    where = folder / "odd"
    where.mkdir()
    structure = where / "block.yaml"
    text = f"mechanism: block\nname: {json.dumps(EVIL)}\nwidth: 0.7\nheight: 2.8\n# </script><b id=evil>\n"
    structure.write_text(text, encoding="utf-8")
    record = where / '<img src=x onerror=alert(1)> & "q"\'.csv'
    record.write_bytes(ACCEL.read_bytes())
    path = where / "report.html"
    run("report", "--neighbours", 20, structure, "--record", record, "-o", path)
    with opened(browser, path) as page:
        alerts = []
        page.on("dialog", lambda dialog: (alerts.append(dialog.message), dialog.dismiss()))
        page.wait_for_timeout(50)
        assert EVIL in page.locator("h1").text_content() and EVIL in page.title()
        assert page.locator("#summary svg").first.text_content().count(EVIL[:20]) == 1
        assert record.name in page.locator("#response h3").first.text_content()
        assert page.locator("img, b, #evil").count() == 0
        assert page.locator("script").count() == 2
        assert alerts == []
        assert page.locator(".motion .stage").get_attribute("aria-label").startswith(EVIL)
    page_of_one = where / "animation.html"
    run("animate", structure, "--record", record, "--out", page_of_one)
    with opened(browser, page_of_one) as page:
        assert EVIL in page.locator("h1").text_content() and EVIL in page.title()
        assert page.locator("img, b").count() == 0


def test_without_a_motion_there_is_a_page_too(browser, folder):
    path = folder / "still.html"
    run("report", EXAMPLES / "arch.yaml", "-o", path)
    with opened(browser, path) as page:
        assert page.locator(".motion, #response").count() == 0
        assert page.locator("#pulses .wide svg").count() == 1
        assert "No ground motion was given" in page.locator(".answer").text_content()


def test_contents_stay_in_view_on_a_wide_screen(browser, report):
    with opened(browser, report, viewport={"width": 1280, "height": 800}) as page:
        page.locator("#inputs").scroll_into_view_if_needed()
        box = page.locator("nav.contents").bounding_box()
        assert (box["x"], box["y"]) == (0, 0) and page.locator("nav li").first.is_visible()
        assert page.locator("main").bounding_box()["x"] >= box["width"]
        assert page.evaluate("document.documentElement.scrollWidth") <= 1280
