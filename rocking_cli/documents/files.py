"""Files of documents: pages of HTML, or printed as PDF by a browser."""

from __future__ import annotations

from pathlib import Path

from rocking_cli.io.browser import as_pdf
from rocking_cli.io.files import write_whole


def laid_out(page: str, suffix: str) -> bytes:
    """Return a page of HTML as the content of a file with a suffix, .html or .pdf."""
    return as_pdf(page.encode()) if suffix == ".pdf" else page.encode()


def write(file: Path, content: bytes) -> str:
    """Write a document completely or not at all, and return a note that it was written."""
    write_whole(file, lambda stream: stream.write(content))
    return f"wrote {file} ({len(content) / 1e6:.2g} MB)"
