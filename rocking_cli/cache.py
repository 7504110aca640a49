"""Files in the user's cache folder, which can be made again and are kept to save time."""

from __future__ import annotations

import os
import tempfile
from contextlib import suppress
from pathlib import Path


def folder() -> Path:
    """Return the cache folder, which need not exist."""
    from platformdirs import user_cache_path

    return user_cache_path("rocking-cli")


def keep(file: Path, content: bytes) -> None:
    """Write a file to the cache whole or not at all; an error of the file system is ignored."""
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
