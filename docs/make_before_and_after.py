"""Show every kind of picture as it was and as it is: light, dark, on a phone and printed without colour.

    python docs/make_before_and_after.py FOLDER

FOLDER has the pictures of an earlier version (docs/pictures of its checkout). Writes docs/before_and_after/NAME.png, to
be looked at. Requires the files that `python docs/make_pages.py` leaves in docs/_generated, Chromium and pdftoppm.
"""

from __future__ import annotations

import shutil
import subprocess
from html import escape
from pathlib import Path
from tempfile import TemporaryDirectory

import click
from make_runs import DOCS, KEPT, PHONE
from PIL import Image

INTO = DOCS / "before_and_after"
PAGES = DOCS / "_generated" / "run"
PHONE_WIDTH, PAGE_WIDTH = 390, 1000  # CSS pixels
# What is shown: the name of a plot or page now, and of the earlier picture.
PLOTS = {
    "response": "response.png", "frame": "frame.png", "margin": "margin.png", "map": "map.png",
    "spectrum": "spectrum.png", "pedestal-PGA": "pedestal-PGA.png",
    "pedestal-PGA-quantiles": "pedestal-PGA-quantiles.png", "draw_tied_facade": "draw_tied_facade.png",
    "draw_arch": "draw_arch.png", "masonry_buttressed_arch": "masonry_buttressed_arch.png", "compared": "compared.png",
    "equivalent": "equivalent.png", "survey_map": "survey_map.png", "verify_tied_facade": "verify_tied_facade.png",
    "error": "error.png", "record": "record.png", "azimuths": "azimuths.png",
}  # fmt: skip
WEB_PAGES = {"report": "report.png"}
STYLE = """
body { margin: 12px; font: 15px sans-serif; width: 1560px; background: #e8e8e8 }
body { display: flex; flex-wrap: wrap; gap: 14px }
figure { margin: 0; background: #fff; color-scheme: light } figcaption { padding: 4px 8px; font-weight: bold }
.dark { background: #16181b; color: #eee; color-scheme: dark } .print img { filter: grayscale(1) }
img { display: block; width: 760px } .phone img { width: 366px; margin: 0 12px }
"""


def browser(*options: str, page: str) -> None:
    """Run Chromium on a page."""
    program = shutil.which("chromium") or shutil.which("google-chrome") or "chromium"
    with TemporaryDirectory() as profile:
        quiet = ["--headless", "--no-sandbox", "--hide-scrollbars", "--disable-gpu", f"--user-data-dir={profile}"]
        subprocess.run([program, *quiet, "--virtual-time-budget=4000", *options, page], check=True, capture_output=True)


def of_page(page: Path, folder: Path) -> dict[str, Path]:
    """Return pictures of the beginning of a page of HTML, by how it is shown."""
    looks = {"now": (PAGE_WIDTH, "1"), "dark": (PAGE_WIDTH, "0"), "phone": (PHONE_WIDTH, "1")}
    for look, (width, scheme) in looks.items():
        size = f"--window-size={width},1400"
        shot = f"--screenshot={folder / look}.png"
        browser(f"--blink-settings=preferredColorScheme={scheme}", size, shot, page=page.as_uri())
    browser("--no-pdf-header-footer", f"--print-to-pdf={folder / 'print.pdf'}", page=page.as_uri())
    first = ["pdftoppm", "-png", "-r", "80", "-l", "1", "-singlefile", folder / "print.pdf", folder / "print"]
    subprocess.run(first, check=True)
    return {look: folder / f"{look}.png" for look in (*looks, "print")}


def of_plot(name: str) -> dict[str, Path]:
    """Return the files of a plot, by how they are shown."""
    wide = KEPT / f"{name}.svg"
    return {"now": wide, "dark": wide, "phone": KEPT / f"{name}{PHONE}", "print": wide}


def montage(name: str, before: Path, now: dict[str, Path], folder: Path) -> None:
    """Write one picture of all appearances."""
    captions = {"before": "before", "now": "now", "dark": "on a dark page", "phone": "390 px", "print": "printed"}
    figures = [
        f'<figure class="{look}"><figcaption>{captions[look]}</figcaption><img src="{escape(file.as_uri())}"></figure>'
        for look, file in {"before": before, **now}.items()
    ]
    page = folder / "page.html"
    page.write_text(f"<!DOCTYPE html><style>{STYLE}</style>{''.join(figures)}", encoding="utf-8")
    shot = folder / "all.png"
    browser("--window-size=1590,3600", f"--screenshot={shot}", page=page.as_uri())
    with Image.open(shot) as image:
        grey = image.convert("RGB")
    ground = Image.new("RGB", grey.size, grey.getpixel((2, grey.height - 2)))
    used = [y for y in range(grey.height) if grey.crop((20, y, 1580, y + 1)) != ground.crop((20, y, 1580, y + 1))]
    cut = grey.crop((0, 0, grey.width, used[-1] + 14))
    small = cut.resize((1060, round(cut.height * 1060 / cut.width)), Image.Resampling.LANCZOS)
    INTO.mkdir(exist_ok=True)
    small.quantize(64, method=Image.Quantize.FASTOCTREE).save(INTO / f"{name}.png", optimize=True)


@click.command()
@click.argument("before", metavar="FOLDER", type=click.Path(exists=True, file_okay=False, path_type=Path))
@click.argument("only", nargs=-1)
def main(before: Path, only: tuple[str, ...]) -> None:
    """Write the pictures, all or some."""
    for name, file in {**PLOTS, **WEB_PAGES}.items():
        if only and name not in only:
            continue
        with TemporaryDirectory() as folder:
            now = of_plot(name) if name in PLOTS else of_page(PAGES / f"{name}.html", Path(folder))
            montage(name, (before / file).resolve(), now, Path(folder))
        click.echo(f"wrote {INTO / name}.png")


if __name__ == "__main__":
    main()
