"""Reading files of a bounded size, and writing files whole or not at all."""

from __future__ import annotations

import os
import shutil
import stat
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import BinaryIO

from rocking_cli.errors import InputError, Problem


def read_bytes(
    path: str | Path, what: str, most: int, *, if_pipe: str = "write what it gives to a file first"
) -> bytes:
    """Content of a file, after a look at what it is and how large.

    Parameters
    ----------
    path : str or Path
        The file.
    what : str
        What it should be, for messages: "structure file".
    most : int
        How large it may be [bytes].
    if_pipe : str, optional
        What to do about a device or a pipe, for the message.

    Raises
    ------
    InputError
        If there is no such file, it is a folder, a device or a pipe, is larger, or cannot be read.
    """
    shown = str(path)
    try:
        # Without O_NONBLOCK opening a pipe that nobody writes to would wait for ever; Windows has no such pipes here.
        handle = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
        with os.fdopen(handle, "rb") as file:
            kind = os.fstat(handle).st_mode
            if stat.S_ISDIR(kind):
                raise IsADirectoryError
            if not stat.S_ISREG(kind):
                raise InputError(Problem(f"this is a device or a pipe, not a {what}", shown, hint=if_pipe))
            content = file.read(most + 1)
    except FileNotFoundError:
        raise InputError(Problem("no such file", shown, hint="check the path")) from None
    except IsADirectoryError:
        raise InputError(Problem(f"this is a folder, not a {what}", shown)) from None
    except (OSError, ValueError) as error:  # ValueError: a path with a null character
        reason = getattr(error, "strerror", None) or error
        if Path(shown.replace("\0", "")).is_dir():  # Windows does not open folders at all
            reason = "it is a folder"
        raise InputError(Problem(f"cannot be read: {reason}", shown)) from None
    if len(content) > most:
        raise InputError(Problem(f"this is no {what}: it is larger than {most / 1e6:.4g} MB", shown))
    return content


def check_writable(path: Path) -> None:
    """Refuse, before any work, a place where no file can be written: `InputError` says why."""
    if path.is_dir():
        raise InputError(Problem("this is a folder: give a file name", str(path)))
    if not path.parent.is_dir():
        raise InputError(Problem(f"the folder {path.parent} does not exist", str(path), hint="create it first"))
    if not os.access(path.parent, os.W_OK):
        raise InputError(Problem(f"the folder {path.parent} cannot be written to", str(path)))
    if path.exists() and not os.access(path, os.W_OK):
        raise InputError(Problem("the file is there already and is protected from writing", str(path)))


def keep_apart(outputs: Sequence[tuple[str, Path | None]], inputs: Sequence[str | None]) -> None:
    """Refuse to write over an input, or two outputs to one file.

    Parameters
    ----------
    outputs : sequence of (str, Path or None)
        The option that asks for it, and where it goes; None where it is not asked for.
    inputs : sequence of str or None
        Files that are read.

    Raises
    ------
    InputError
        Naming the option.
    """
    read = [Path(name) for name in inputs if name is not None and Path(name).exists()]
    taken: dict[Path, str] = {}
    for option, path in outputs:
        if path is None:
            continue
        if path.exists() and any(path.samefile(each) for each in read):
            raise InputError(
                Problem(f"{option} would overwrite what is read", str(path), hint="take another name or folder")
            )
        place = path.resolve()
        if place in taken:
            raise InputError(Problem(f"{taken[place]} and {option} cannot be the same file", str(path)))
        taken[place] = option


def write_whole(path: Path, write: Callable[[BinaryIO], object]) -> None:
    """Write a file through a temporary neighbour, so that no half-written one is ever seen.

    Parameters
    ----------
    path : Path
        Where to.
    write : callable
        Gets the open binary file.

    Raises
    ------
    InputError
        If the file cannot be written; an older file of that name is then untouched.
    """
    check_writable(path)
    path = path.resolve()  # through a link, to the file it stands for
    try:
        handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
        try:
            with os.fdopen(handle, "wb") as file:
                write(file)
            if path.exists():
                shutil.copymode(path, name)
            else:  # mkstemp makes files private; give this one the usual rights
                umask = os.umask(0)
                os.umask(umask)
                os.chmod(name, 0o666 & ~umask)  # noqa: PTH101
            os.replace(name, path)  # noqa: PTH105
        except BaseException:
            Path(name).unlink(missing_ok=True)
            raise
    except OSError as error:
        raise InputError(Problem(f"cannot be written: {error.strerror or error}", str(path))) from error
