"""A part of the site: plots that a phone shows narrow, as docs/pictures has them."""

from __future__ import annotations

import re
import shutil
from pathlib import Path
from typing import Any

from sphinx.application import Sphinx

PICTURES = Path(__file__).resolve().parent / "pictures"
WIDEST = 600  # CSS pixels of the screen of a phone
IMAGE = re.compile(r'<img [^>]*src="(?P<folder>[^"]*)/(?P<stem>[^"/]+)\.svg"[^>]*>')


def _with_narrow(app: Sphinx, page: str, template: str, context: dict[str, Any], *_: Any) -> None:
    def both(image: re.Match[str]) -> str:
        name = f"{image['stem']}-phone.svg"
        if not (PICTURES / name).exists():
            return image[0]
        images = Path(app.outdir) / "_images"
        images.mkdir(exist_ok=True)  # of a new site
        shutil.copy(PICTURES / name, images / name)
        source = f'<source media="(max-width: {WIDEST}px)" srcset="{image["folder"]}/{name}">'
        return f"<picture>{source}{image[0]}</picture>"

    if "body" in context:
        context["body"] = IMAGE.sub(both, context["body"])


def setup(app: Sphinx) -> None:
    """Called by Sphinx."""
    app.connect("html-page-context", _with_narrow)
