"""The Chromium of the system, driven by playwright: pages are opened in it as a reader opens them."""

import os
import shutil
from contextlib import contextmanager

import pytest

NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
NEEDED = os.environ.get("ROCKING_NEEDS_BROWSER") == "1"  # a machine that must run these tests


def launch():
    """A running browser and what stops it; skips where there is none, unless one is needed."""
    found = os.environ.get("ROCKING_BROWSER") or next(filter(None, map(shutil.which, NAMES)), None)
    if found is None:
        message = "no Chromium on this machine: install it, or name it in ROCKING_BROWSER"
        pytest.fail(message) if NEEDED else pytest.skip(message)
    try:
        from playwright.sync_api import sync_playwright
    except ImportError:
        if NEEDED:
            raise
        pytest.skip("playwright is not installed")
    driver = sync_playwright().start()
    # The sandbox needs rights that root in a container has not; only pages of our own are opened.
    return driver.chromium.launch(executable_path=found, args=["--no-sandbox"]), driver


@contextmanager
def opened(browser, path, **context):
    """A page of a file; at the end it must have requested nothing but itself, and reported no error."""
    asked, said = [], []
    shown = browser.new_context(**{"viewport": {"width": 1000, "height": 900}, "reduced_motion": "reduce", **context})
    try:
        page = shown.new_page()
        # A worker is made of a text of the page itself.
        page.on("request", lambda request: request.url.startswith("blob:") or asked.append(request.url))
        page.on("console", lambda message: said.append(message.text))
        page.on("pageerror", lambda error: said.append(str(error)))
        page.goto(path.as_uri())
        yield page
        assert said == []
        assert asked == [path.as_uri()]
    finally:
        shown.close()
