"""Print a page of HTML to PDF by the browser of the system, which lays it out as users see it."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from rocking_cli.errors import InputError, Problem, Refused

BROWSER_VARIABLE = "ROCKING_BROWSER"
BROWSER_NAMES = (
    "chromium",
    "chromium-browser",
    "google-chrome",
    "google-chrome-stable",
    "chrome",
    "msedge",
    "microsoft-edge",
)
USUAL_PATHS = (  # usual places in macOS and Windows, where browsers are not on the path
    "/Applications/Google Chrome.app/Contents/MacOS/Google Chrome",
    "/Applications/Microsoft Edge.app/Contents/MacOS/Microsoft Edge",
    "/Applications/Chromium.app/Contents/MacOS/Chromium",
    r"C:\Program Files\Google\Chrome\Application\chrome.exe",
    r"C:\Program Files (x86)\Microsoft\Edge\Application\msedge.exe",
)
BROWSER_OPTIONS = ("headless", "disable-gpu", "no-first-run", "no-pdf-header-footer")
PRINT_TIMEOUT = 120  # s until a print is given up


def browser() -> str:
    """Return the browser that prints: the one in ROCKING_BROWSER, or else the first one found.

    Raises
    ------
    InputError
        If there is no browser.
    """
    if chosen := os.environ.get(BROWSER_VARIABLE):
        if (path := shutil.which(chosen)) is None:
            raise InputError(
                Problem(f"there is no browser {chosen}", BROWSER_VARIABLE, hint="name one that is there, or unset it")
            )
        return path
    installed = [
        *filter(None, map(shutil.which, BROWSER_NAMES)),
        *(path for path in USUAL_PATHS if os.path.isfile(path)),  # noqa: PTH113 - not an error
    ]
    if not installed:
        hint = (
            f"install Chromium, Chrome or Edge, or name one in {BROWSER_VARIABLE}; or pip install 'rocking-cli[pdf]', "
            "which needs no browser; or write .html and print it yourself"
        )
        raise InputError(Problem("a PDF is printed by a browser, and none is found here", hint=hint))
    return installed[0]


def has_browser() -> bool:
    """Return whether there is a browser that prints."""
    try:
        return bool(browser())
    except InputError:
        return False


def as_pdf(page: bytes) -> bytes:
    """Return a page of HTML, which must not need a network, as PDF.

    Parameters
    ----------
    page : bytes
        The page.

    Returns
    -------
    bytes
        The PDF.

    Raises
    ------
    InputError
        If there is no browser.
    Refused
        If the browser fails to print.
    """
    program = browser()
    with tempfile.TemporaryDirectory(prefix="rocking-", ignore_cleanup_errors=True) as folder:
        source, printed = Path(folder) / "page.html", Path(folder) / "page.pdf"
        source.write_bytes(page)
        options = [*BROWSER_OPTIONS, f"user-data-dir={Path(folder) / 'profile'}", f"print-to-pdf={printed}"]
        if sys.platform != "win32" and os.geteuid() == 0:
            options.append("no-sandbox")  # root cannot use the sandbox; our own page loads nothing from elsewhere
        command = [program, *(f"--{each}" for each in options), source.as_uri()]
        try:
            subprocess.run(command, capture_output=True, timeout=PRINT_TIMEOUT, check=True)
            # Without dates, whose room stays, the same page is the same file.
            return re.sub(rb"/(?:Creation|Mod)Date \([^)]*\)", lambda match: b" " * len(match[0]), printed.read_bytes())
        except (OSError, subprocess.SubprocessError) as error:
            raise Refused(f"{program} did not print the page: {type(error).__name__}") from None
