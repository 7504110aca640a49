"""The site, as a browser shows it on a phone and on a wide screen, in light and dark colours."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.browser import launch
from tests.conftest import PROJECT

pytestmark = pytest.mark.docs
SCREENS = ((390, "light"), (1280, "dark"))  # width [px] and colours
TALLEST = 15_000  # px of a page, as it opens on a phone


@pytest.fixture(scope="module")
def browser():
    shown, driver = launch()
    yield shown
    shown.close()
    driver.stop()


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    pytest.importorskip("sphinx", reason="the documentation is not installed here")
    if there := os.environ.get("ROCKING_SITE"):  # built just before
        return Path(there).resolve()
    folder = tmp_path_factory.mktemp("site")
    command = [sys.executable, "-m", "sphinx", "-q", "-b", "html", "-d", str(folder / "trees"), "docs"]
    subprocess.run([*command, str(folder / "html")], cwd=PROJECT, check=True, capture_output=True)
    return folder / "html"


FOUND = r"""() => {
  document.querySelectorAll("details").forEach((each) => (each.open = true));
  const said = new Set(), wide = document.documentElement.clientWidth;
  const name = (each) => `${each.tagName.toLowerCase()}.${each.className} "${each.textContent.trim().slice(0, 30)}"`;
  if (document.documentElement.scrollWidth > wide) said.add("the page scrolls sideways");
  const main = document.querySelector("[role=main]");
  const scrolling = new Map([[main, false]]), papers = new Map([[null, [255, 255, 255]]]), colours = new Map();
  for (const each of main.querySelectorAll("*")) {  // in the order of the page: what is around each comes before it
    const around = scrolling.get(each.parentElement);
    if (each.closest("svg, math")) continue;
    const { overflowX } = getComputedStyle(each);
    scrolling.set(each, around || overflowX === "auto" || overflowX === "scroll");
    const box = each.getBoundingClientRect();
    if (box.width > 1 && box.right > wide + 1 && !around) said.add(`cut: ${name(each)}`);
    if (overflowX === "hidden" && each.scrollWidth > each.clientWidth + 1) said.add(`hidden: ${name(each)}`);
  }
  let level = 0;
  for (const each of main.querySelectorAll("h1, h2, h3, h4, h5, h6")) {
    if (+each.tagName[1] > level + 1) said.add(`skips a level: ${name(each)}`);
    level = +each.tagName[1];
  }
  const canvas = document.createElement("canvas").getContext("2d", { willReadFrequently: true });
  const rgba = (colour) => colours.get(colour) ?? (colours.set(colour, pixel(colour)), colours.get(colour));
  const pixel = (colour) => {
    canvas.clearRect(0, 0, 1, 1);
    canvas.fillStyle = colour;
    canvas.fillRect(0, 0, 1, 1);
    return canvas.getImageData(0, 0, 1, 1).data;
  };
  const over = (one, other) => [0, 1, 2].map((k) => (one[k] * one[3] + other[k] * (255 - one[3])) / 255);
  const light = (colour) => {
    const [r, g, b] = colour.map((x) => (x / 255 <= 0.04045 ? x / 255 / 12.92 : ((x / 255 + 0.055) / 1.055) ** 2.4));
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const paper_of = (each) => {
    if (!papers.has(each)) {
      const own = rgba(getComputedStyle(each).backgroundColor);
      papers.set(each, over(own, paper_of(each.parentElement)));
    }
    return papers.get(each);
  };
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (walker.nextNode()) {
    const each = walker.currentNode.parentElement;
    if (!walker.currentNode.textContent.trim()) continue;
    if (!each.checkVisibility() || each.closest("svg, script, style")) continue;
    const style = getComputedStyle(each), paper = paper_of(each);
    const [low, high] = [light(over(rgba(style.color), paper)), light(paper)].sort((a, b) => a - b);
    const size = parseFloat(style.fontSize), bold = style.fontWeight >= 700;
    const ratio = (high + 0.05) / (low + 0.05);
    if (ratio < (size >= 24 || (bold && size >= 18.66) ? 3 : 4.5))
      said.add(`contrast ${ratio.toFixed(1)}: ${style.color} on ${paper.map(Math.round)}: ${name(each)}`);
  }
  return [...said];
}"""

"""What a page does wrong: parts that are cut, headings that skip a level, text too faint."""


def faults(browser, pages, width, scheme):
    """What each page does wrong on a screen, by its path."""
    shown = browser.new_context(viewport={"width": width, "height": 844}, color_scheme=scheme)
    try:
        page = shown.new_page()
        found = {}
        for path in pages:
            page.goto(path.as_uri())
            tall = page.evaluate("document.documentElement.scrollHeight")
            found[path] = [*([f"{tall} px tall"] if tall > TALLEST and width < 1000 else []), *page.evaluate(FOUND)]
        return {path.name: each for path, each in found.items() if each}
    finally:
        shown.close()


@pytest.mark.parametrize(("width", "scheme"), SCREENS)
def test_every_page_fits_the_screen_and_can_be_read(browser, site, width, scheme):
    pages = [each for each in sorted(site.rglob("*.html")) if "_downloads" not in each.parts]
    assert len(pages) > 50
    assert faults(browser, pages, width, scheme) == {}


def test_a_fault_of_a_page_is_found(browser, tmp_path):
    """So that a page without any is one that was looked at."""
    parts = {
        "sideways": "<p style='width: 600px'>wide</p>",
        "cut: p": "<p style='width: 600px'>wide</p>",
        "hidden: p": "<p style='width: 50px; overflow: hidden; white-space: nowrap'>more than fits</p>",
        "skips a level: h3": "<h1>one</h1><h3>three</h3>",
        "contrast 2.8: rgb(153, 153, 153)": "<p style='color: #999'>faint</p>",
        "px tall": f"<p style='height: {TALLEST}px'>tall</p>",
    }
    for said, part in parts.items():
        (tmp_path / "page.html").write_text(f"<meta charset=utf-8><div role=main>{part}</div>", encoding="utf-8")
        assert said in " ".join(faults(browser, [tmp_path / "page.html"], 390, "light")["page.html"])


def test_a_link_opens_the_folded_part_it_leads_to(browser, site):
    shown = browser.new_context(viewport={"width": 390, "height": 844})
    try:
        page = shown.new_page()
        for name, target in (
            ("reference/commands", "rocking-verify"),
            ("histories", "limits"),
            ("api/responses", "rocking_cli.respond"),
        ):
            page.goto(f"{site.as_uri()}/{name}.html#{target}")
            assert page.locator("details[open]").count() >= 1, target
            at = page.evaluate(f"document.getElementById('{target}').getBoundingClientRect().y")
            assert 0 <= at < 300, (target, at)
    finally:
        shown.close()


CUT = """() => {
  const box = document.documentElement.getBoundingClientRect(), within = (a, b) => a > -1 && b > -1;
  return [...document.querySelectorAll("text")].filter((each) => {
    const { left, right, top, bottom } = each.getBoundingClientRect();
    const upright = /rotate\\(-90/.test(each.outerHTML + each.parentElement.getAttribute("transform"));
    return !(upright ? within(top - box.top, box.bottom - bottom) : within(left - box.left, box.right - right));
  }).map((each) => each.textContent.replace(/\\s+/g, " "));
}"""
"""Texts that begin or end outside a picture; across the line, boxes of texts are larger than their letters."""


def test_no_text_of_a_picture_is_cut(browser, tmp_path):
    page = browser.new_page()
    pictures = [*(PROJECT / "docs" / "pictures").glob("*.svg"), *(PROJECT / "docs" / "static").rglob("*.svg")]
    assert len(pictures) > 60
    (tmp_path / "cut.svg").write_text(
        "<svg xmlns='http://www.w3.org/2000/svg' width='50' height='50'><text x='20' y='20'>too long</text></svg>"
    )
    cut = {}
    for each in (*pictures, tmp_path / "cut.svg"):
        page.goto(each.as_uri())
        cut |= {each.name: page.evaluate(CUT)}
    page.close()
    assert {name: texts for name, texts in cut.items() if texts} == {"cut.svg": ["too long"]}


@pytest.mark.parametrize("chosen", ["light", "dark"])
def test_a_drawing_has_the_colours_that_the_reader_chose_for_the_page(browser, site, chosen):
    """Whatever those of the system are."""
    import io

    from PIL import Image

    shown = browser.new_context(color_scheme="dark" if chosen == "light" else "light")
    try:
        page = shown.new_page()
        page.goto(f"{site.as_uri()}/mechanisms.html")
        page.evaluate(f"document.body.dataset.theme = '{chosen}'")
        pixels = Image.open(io.BytesIO(page.locator("#choose-a-mechanism img").first.screenshot())).convert("RGB")
        body = {"light": (0xCB, 0xD8, 0xE4), "dark": (0x43, 0x55, 0x67)}  # of a block, by plotting/style.py
        shades = dict(map(reversed, pixels.getcolors(pixels.width * pixels.height)))
        counts = {name: shades.get(colour, 0) for name, colour in body.items()}
        assert counts[chosen] > 100 and sum(counts.values()) == counts[chosen]
    finally:
        shown.close()
