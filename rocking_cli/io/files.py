"""Read files of a bounded size, and write files whole or not at all."""

from __future__ import annotations

import errno
import io
import os
import shutil
import stat
import tempfile
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import IO, Any, BinaryIO

from rocking_cli.errors import InputError, Problem, Refused, RockingError

CREATE_ONLY = os.O_RDWR | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0) | getattr(os, "O_NOFOLLOW", 0)


def read_bytes(
    path: str | Path, what: str, max_bytes: int, *, if_pipe: str = "write what it gives to a file first"
) -> bytes:
    """Return the content of a file, after checking its kind and size.

    Parameters
    ----------
    path : str or Path
        The file.
    what : str
        Kind of file, for messages: "structure file".
    max_bytes : int
        Largest size allowed [bytes].
    if_pipe : str, optional
        Hint for the message if the path is a device or a pipe.

    Raises
    ------
    InputError
        If the file does not exist, is a folder, a device or a pipe, is larger than `max_bytes`, or cannot be read.
    """
    shown_path = str(path)
    try:
        # Without O_NONBLOCK opening a pipe that nobody writes to would wait for ever; Windows has no such pipes here.
        handle = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
        with os.fdopen(handle, "rb") as file:
            kind = os.fstat(handle).st_mode
            if stat.S_ISDIR(kind):
                raise IsADirectoryError
            if not stat.S_ISREG(kind):
                raise InputError(Problem(f"this is a device or a pipe, not a {what}", shown_path, hint=if_pipe))
            content = read_at_most(file, max_bytes)
    except FileNotFoundError:
        raise InputError(Problem("no such file", shown_path, hint="check the path")) from None
    except IsADirectoryError:
        raise InputError(Problem(f"this is a folder, not a {what}", shown_path)) from None
    except (OSError, ValueError) as error:  # ValueError: a path with a null character
        reason = getattr(error, "strerror", None) or error
        if Path(shown_path.replace("\0", "")).is_dir():  # Windows does not open folders at all
            reason = "it is a folder"
        raise InputError(Problem(f"cannot be read: {reason}", shown_path)) from None
    if content is None:
        raise InputError(Problem(f"this cannot be a {what}: it is larger than {max_bytes / 1e6:.4g} MB", shown_path))
    return content


def read_at_most(stream: IO[bytes] | io.BufferedIOBase, max_bytes: int) -> bytes | None:
    """Return the content of a stream, or None if it is more than `max_bytes` bytes.

    It is read in pieces, as reading `max_bytes` bytes at once would reserve memory for all of them.
    """
    pieces, size = [], 0
    while piece := stream.read(1 << 20):
        pieces.append(piece)
        size += len(piece)
        if size > max_bytes:
            return None
    return b"".join(pieces)


def folder(name: str) -> Path:
    """Return a folder to write into, made if it does not exist. Raises `InputError` if this is not possible."""
    path = Path(name)
    try:
        path.mkdir(parents=True, exist_ok=True)
    except (OSError, ValueError) as error:  # ValueError: a path with a null character
        reason = getattr(error, "strerror", None) or error
        raise InputError(Problem(f"cannot be a folder to write into: {reason}", name)) from None
    return path


def write_folder(path: Path, files: Mapping[str, bytes]) -> None:
    """Write a new folder; an existing one must be empty.

    Parameters
    ----------
    path : Path
        Path of the folder.
    files : mapping of str to bytes
        Content of each file by its path in the folder, with `/` between names.

    Raises
    ------
    InputError
        If the folder cannot be made; nothing is then left behind.
    Refused
        If the system refuses, as with a full disk; nothing is then left behind.
    """
    shown_path, there = str(path), path.is_dir()
    hint = "move it away, or name another folder"
    if there and any(path.iterdir()):
        raise InputError(Problem("this folder already exists and is not empty", shown_path, hint=hint))
    if not there and os.path.lexists(path):
        raise InputError(Problem("there is a file of this name already", shown_path, hint=hint))
    if not path.parent.is_dir():
        raise InputError(Problem(f"the folder {path.parent} does not exist", shown_path, hint="create it first"))
    try:
        for name, content in files.items():
            (path / name).parent.mkdir(parents=True, exist_ok=True)
            (path / name).write_bytes(content)
    except BaseException as error:
        for each in path.iterdir() if path.is_dir() else ():
            shutil.rmtree(each) if each.is_dir() else each.unlink()
        if path.is_dir() and not there:
            path.rmdir()
        if isinstance(error, OSError):
            raise _cannot(path, error) from error
        raise


def check_writable(path: Path) -> None:
    """Raise `InputError`, before any work, if no file can be written at a path."""
    shown_path, path = str(path), Path(os.path.realpath(path))  # links are followed to their file
    if path.is_symlink():
        raise InputError(Problem("this link leads back to itself", shown_path))
    if path.is_dir():
        raise InputError(Problem("this is a folder: give a file name", shown_path))
    if not path.parent.is_dir():
        raise InputError(Problem(f"the folder {path.parent} does not exist", shown_path, hint="create it first"))
    if path.exists() and not os.access(path, os.W_OK):
        raise InputError(Problem("the file already exists and is protected from writing", shown_path))
    if not _is_special(path) and not os.access(path.parent, os.W_OK):
        raise InputError(Problem(f"the folder {path.parent} cannot be written to", shown_path))


def _is_special(path: Path) -> bool:
    """Return whether a path is a device or a pipe, which must be written into and not replaced by a file."""
    return path.exists() and not path.is_file()


def keep_apart(outputs: Sequence[tuple[str, Path | None]], inputs: Sequence[str | None]) -> None:
    """Raise `InputError` if an output would overwrite an input, or two outputs are the same file.

    Parameters
    ----------
    outputs : sequence of (str, Path or None)
        The option of each output, and its path; None if it is not requested.
    inputs : sequence of str or None
        Files that are read.

    Raises
    ------
    InputError
        With the name of the option.
    """
    read = [Path(name) for name in inputs if name is not None and Path(name).exists()]
    taken: dict[Path, str] = {}
    for option, path in outputs:
        if path is None:
            continue
        if path.exists() and any(path.samefile(each) for each in read):
            raise InputError(
                Problem(f"{option} would overwrite an input file", str(path), hint="take another name or folder")
            )
        place = path.resolve()
        if place in taken:
            raise InputError(Problem(f"{taken[place]} and {option} cannot be the same file", str(path)))
        taken[place] = option


WRITE_REFUSALS = (errno.ENOSPC, errno.EFBIG, errno.EIO, errno.EPIPE, getattr(errno, "EDQUOT", errno.ENOSPC))
"""Errors of the system for which nobody is to blame: no room, too large a file, a broken disk, a closed pipe."""


class _Output(io.FileIO):
    """A file that keeps the error of the system, as libraries that write to it may raise another one."""

    refused: OSError | None = None

    def write(self, data: Any) -> int:
        try:
            return super().write(data)
        except OSError as error:
            self.refused = error
            raise


def write_whole(path: Path, write: Callable[[BinaryIO], object]) -> None:
    """Write a file through a temporary one in the same folder, so that an incomplete one is never visible.

    A device, or a pipe with a reader, receives the content when it is complete.

    Parameters
    ----------
    path : Path
        Path of the file.
    write : callable
        Function that writes to the open binary file.

    Raises
    ------
    InputError
        If the file cannot be made; an older one of that name is then unchanged.
    Refused
        If the system refuses, as with a full disk; an older file is then unchanged.
    """
    check_writable(path)
    shown_path, path = path, Path(os.path.realpath(path))
    if _is_special(path):
        _write_into(path, shown_path, write)
        return
    # The name is short enough for any system. It is chosen before the file is made, so that the file is removed even if
    # a signal comes in between.
    name = path.with_name(f".{path.name[:40]}.{os.urandom(8).hex()}")
    try:
        try:
            handle = os.open(name, CREATE_ONLY, 0o600)
        except OSError as error:
            raise _cannot(shown_path, error) from error
        _fill(handle, shown_path, write)
        try:
            if path.exists():
                shutil.copymode(path, name)
            else:  # the temporary file is private; a new file gets the usual rights
                umask = os.umask(0)
                os.umask(umask)
                os.chmod(name, 0o666 & ~umask)  # noqa: PTH101
            os.replace(name, path)  # noqa: PTH105
        except OSError as error:
            raise _cannot(shown_path, error) from error
    except BaseException:
        name.unlink(missing_ok=True)
        raise


def _fill(handle: int, shown_path: Path, write: Callable[[BinaryIO], object]) -> None:
    """Write to an open file and close it; an error of the system takes precedence over others."""
    output = _Output(handle, "wb")
    try:
        with io.BufferedWriter(output) as file:
            write(file)
    except Exception as error:
        refused = error if isinstance(error, OSError) else output.refused
        if refused is None:
            raise
        raise _cannot(shown_path, refused) from error
    finally:
        output.close()


def _write_into(path: Path, shown_path: Path, write: Callable[[BinaryIO], object]) -> None:
    """Write the complete content to a device or a pipe."""
    try:
        # Opening a pipe that nobody reads would wait for ever.
        handle = os.open(path, os.O_WRONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
    except OSError as error:
        if error.errno == errno.ENXIO:
            problem = Problem("no program is reading from this pipe", str(shown_path), hint="start its reader first")
            raise InputError(problem) from None
        raise _cannot(shown_path, error) from error
    with tempfile.TemporaryFile() as whole:
        try:
            _fill(os.dup(whole.fileno()), Path(tempfile.gettempdir()), write)
        except BaseException:
            os.close(handle)
            raise
        whole.seek(0)
        if hasattr(os, "set_blocking"):
            os.set_blocking(handle, True)
        _fill(handle, shown_path, lambda file: shutil.copyfileobj(whole, file))


def _cannot(shown_path: Path, error: OSError) -> RockingError:
    """Return the error of a file that cannot be written."""
    problem = Problem(f"cannot be written: {error.strerror or error}", str(shown_path))
    return Refused(str(problem)) if error.errno in WRITE_REFUSALS else InputError(problem)
