"""Files in the user's cache folder: what could be made again, and is kept to save time."""

from __future__ import annotations

import os
import tempfile
from contextlib import suppress
from pathlib import Path


def folder() -> Path:
    """Return the folder, which need not exist."""
    from platformdirs import user_cache_path

    return user_cache_path("rocking-cli")


def keep(file: Path, content: bytes) -> None:
    """Write a file whole or not at all; where it cannot be written it is left out."""
    temporary = None
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        handle, temporary = tempfile.mkstemp(dir=file.parent, prefix=f"{file.name}.")
        with os.fdopen(handle, "wb") as stream:
            stream.write(content)
        Path(temporary).replace(file)
    except OSError:
        if temporary is not None:
            with suppress(OSError):
                Path(temporary).unlink()
