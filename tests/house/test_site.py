"""The site, as a browser shows it on a phone and on a wide screen, in light and dark colours."""

import pytest

pytestmark = pytest.mark.docs
SCREENS = [(width, scheme) for width in (390, 1280) for scheme in ("light", "dark")]

FOUND = r"""() => {
  document.querySelectorAll("details").forEach((each) => (each.open = true));
  const said = new Set(), wide = document.documentElement.clientWidth;
  const name = (each) => `${each.tagName.toLowerCase()}.${each.className} "${each.textContent.trim().slice(0, 30)}"`;
  if (document.documentElement.scrollWidth > wide) said.add("the page scrolls sideways");
  const main = document.querySelector("[role=main]");
  for (const each of main.querySelectorAll("*")) {
    if (each.closest("svg, math, .visually-hidden")) continue;
    const style = getComputedStyle(each);
    const box = each.getBoundingClientRect();
    let scrolls = false;
    for (let around = each; around !== main; around = around.parentElement)
      scrolls ||= /auto|scroll/.test(getComputedStyle(around).overflowX);
    if (box.width > 1 && box.right > wide + 1 && !scrolls) said.add(`cut: ${name(each)}`);
    if (style.overflowX === "hidden" && each.scrollWidth > each.clientWidth + 1) said.add(`hidden: ${name(each)}`);
  }
  let level = 0;
  for (const each of main.querySelectorAll("h1, h2, h3, h4, h5, h6")) {
    if (+each.tagName[1] > level + 1) said.add(`skips a level: ${name(each)}`);
    level = +each.tagName[1];
  }
  const canvas = document.createElement("canvas").getContext("2d", { willReadFrequently: true });
  const rgba = (colour) => {
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
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (walker.nextNode()) {
    const each = walker.currentNode.parentElement;
    if (!walker.currentNode.textContent.trim() || !each.checkVisibility() || each.closest("svg, script, style"))
      continue;
    const style = getComputedStyle(each), behind = [];
    for (let around = each; around; around = around.parentElement)
      behind.unshift(getComputedStyle(around).backgroundColor);
    const paper = behind.reduce((below, colour) => over(rgba(colour), below), [255, 255, 255]);
    const [low, high] = [light(over(rgba(style.color), paper)), light(paper)].sort((a, b) => a - b);
    const size = parseFloat(style.fontSize), bold = style.fontWeight >= 700;
    const ratio = (high + 0.05) / (low + 0.05);
    if (ratio < (size >= 24 || (bold && size >= 18.66) ? 3 : 4.5))
      said.add(`contrast ${ratio.toFixed(1)}: ${style.color} on ${paper.map(Math.round)}: ${name(each)}`);
  }
  return [...said];
}"""
