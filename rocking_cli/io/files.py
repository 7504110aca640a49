"""Read files of a bounded size, and write files whole or not at all."""

from __future__ import annotations

import errno
import io
import os
import shutil
import stat
import sys
import tempfile
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager, suppress
from hashlib import sha256
from pathlib import Path
from typing import IO, Any, BinaryIO

from rocking_cli.errors import InputError, Problem, Refused

CREATE_ONLY = os.O_RDWR | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0) | getattr(os, "O_NOFOLLOW", 0)
PART, LISTING = ".rocking", ".rocking-files"
"""Endings of our hidden files: one that is being written, and the list of those that are being written to a folder."""


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
        _sync_folder(path.parent)
    except (OSError, ValueError) as error:  # ValueError: a path with a null character
        raise refusal(error, "cannot be a folder to write into", name) from None
    return path


def refusal(error: OSError | ValueError, what: str, place: str | Path) -> InputError | Refused:
    """Return the error for what the system did not do: `Refused` if nobody is to blame, as with a full disk."""
    problem = Problem(f"{what}: {getattr(error, 'strerror', None) or error}", str(place))
    return Refused(str(problem)) if getattr(error, "errno", None) in WRITE_REFUSALS else InputError(problem)


def write_folder(path: Path, files: Mapping[str, bytes]) -> None:
    """Write a new folder; an existing one must be empty, but for what a run that was killed has left.

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
    discard(path)
    shown_path, there = str(path), path.is_dir()
    hint = "move it away, or name another folder"
    if there and any(path.iterdir()):
        raise InputError(Problem("this folder already exists and is not empty", shown_path, hint=hint))
    if not there and os.path.lexists(path):
        raise InputError(Problem("there is a file of this name already", shown_path, hint=hint))
    if not path.parent.is_dir():
        raise InputError(Problem(f"the folder {path.parent} does not exist", shown_path, hint="create it first"))
    try:
        write_files(path, files.items())
    except BaseException:
        discard(path)
        with suppress(OSError):
            if not there:
                path.rmdir()
        raise


def write_files(place: Path, files: Iterable[tuple[str, bytes]]) -> None:
    """Write files into a folder, each listed before it is there: what a run that is killed leaves, `discard` removes.

    Parameters
    ----------
    place : Path
        The folder, made if it does not exist.
    files : iterable of (str, bytes)
        Path of each file in the folder, and its content.

    Raises
    ------
    InputError, Refused
        As `write_whole`; the files before are then there, until `discard` removes them.
    """
    listing = _hidden(place / "files", LISTING)
    with _naming(place), ExitStack() as after:
        place.mkdir(exist_ok=True)
        _sync_folder(place.parent)
        with os.fdopen(_made(listing, after), "wb") as stream:
            _sync_folder(place)
            for name, content in files:
                stream.write(f"{sha256(content).hexdigest()}  {name}\n".encode("utf-8", "surrogateescape"))
                stream.flush()
                _sync(stream.fileno())
                (place / name).parent.mkdir(parents=True, exist_ok=True)
                _sync_folder((place / name).parent.parent)
                _put(place / name, lambda file, content=content: file.write(content))  # type: ignore[misc]
        listing.unlink()  # while it is locked: another run would take the files for those of one that was killed


def discard(place: Path) -> None:
    """Remove what `write_files` of a run that was killed wrote to a folder, as far as nobody has changed it since."""
    for listing in _left(place, LISTING):
        for line in listing.read_text(encoding="utf-8", errors="surrogateescape").split("\n"):
            checksum, _, name = line.partition("  ")
            file = place / name
            with suppress(OSError, ValueError):  # ValueError: a null character
                if file.resolve().is_relative_to(place.resolve()):
                    for left in _left(file.parent, PART):
                        left.unlink()
                    if file.is_file() and sha256(file.read_bytes()).hexdigest() == checksum:
                        file.unlink()
                    for each in file.parents[: len(Path(name).parts) - 1]:
                        each.rmdir()
        listing.unlink(missing_ok=True)


def _hidden(path: Path, ending: str) -> Path:
    """Return a new name beside a path, short enough for any system."""
    return path.with_name(f".{path.name[:40]}.{os.urandom(8).hex()}{ending}")


def _left(folder: Path, ending: str) -> Iterator[Path]:
    """Yield hidden files that runs which were killed left in a folder; no other process has them meanwhile."""
    for path in filter(Path.is_file, sorted(folder.glob(f".*.{'[0-9a-f]' * 16}{ending}"))):
        with suppress(OSError), ExitStack() as after:
            if sys.platform == "win32":
                path.rename(path)  # refused as long as it is open
            else:
                import fcntl

                handle = os.open(path, os.O_RDONLY | os.O_NOFOLLOW)
                after.callback(os.close, handle)
                fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
            yield path


def _made(path: Path, after: ExitStack) -> int:
    """Return the handle of a new hidden file, which `_left` does not yield to anybody until `after` is closed."""
    while True:
        handle = os.open(path, CREATE_ONLY, 0o600)
        if sys.platform == "win32":
            return handle
        import fcntl

        after.callback(os.close, os.dup(handle))
        with suppress(OSError):  # a file system without locks
            fcntl.flock(handle, fcntl.LOCK_EX)
        if path.exists():
            return handle
        os.close(handle)  # before it was locked, another process took it for one that was left


def _sync(handle: int) -> None:
    """Have the system write a file to its disk, where it can."""
    try:
        os.fsync(handle)
    except OSError as error:
        if error.errno in WRITE_REFUSALS:
            raise


def _sync_folder(path: Path) -> None:
    """Have the system write the names in a folder to its disk; Windows does not open folders."""
    try:
        handle = os.open(path, os.O_RDONLY)
    except OSError:
        return
    try:
        _sync(handle)
    finally:
        os.close(handle)


def check_writable(path: Path, *suffixes: str) -> None:
    """Raise `InputError`, before any work, if no file, with one of the suffixes, can be written at a path."""
    if suffixes and path.suffix.lower() not in suffixes:
        known = " or ".join(", ".join(suffixes).rsplit(", ", 1))
        raise InputError(Problem(f"give a file name that ends in {known}", str(path)))
    shown_path, path = str(path), Path(os.path.realpath(path))  # links are followed to their file
    with _naming(Path(shown_path)), suppress(FileNotFoundError, NotADirectoryError):
        path.lstat()  # where a folder may not be entered, pathlib raises below, or says that nothing is there
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
    with _naming(shown_path):
        if _is_special(path):
            _write_into(path, write)
            return
        for left in _left(path.parent, PART):
            left.unlink(missing_ok=True)
        _put(path, write)


def _put(path: Path, write: Callable[[BinaryIO], object]) -> None:
    """Write a file through a hidden one, which is named before it is made: a signal in between leaves nothing."""
    name = _hidden(path, PART)
    with ExitStack() as after:
        after.callback(name.unlink, missing_ok=True)
        _fill(_made(name, after), write)
        if path.exists():
            shutil.copymode(path, name)
        else:  # the hidden file is private; a new file gets the usual rights
            umask = os.umask(0)
            os.umask(umask)
            os.chmod(name, 0o666 & ~umask)  # noqa: PTH101
        os.replace(name, path)  # noqa: PTH105
    _sync_folder(path.parent)


def _fill(handle: int, write: Callable[[BinaryIO], object]) -> None:
    """Write to an open file and close it; an error of the system takes precedence over others."""
    output = _Output(handle, "wb")
    try:
        with io.BufferedWriter(output) as file:
            write(file)
            file.flush()
            _sync(handle)
    except Exception as error:
        if isinstance(error, OSError) or output.refused is None:
            raise
        raise output.refused from error
    finally:
        output.close()


def _write_into(path: Path, write: Callable[[BinaryIO], object]) -> None:
    """Write the complete content to a device or a pipe."""
    try:
        # Opening a pipe that nobody reads would wait for ever.
        handle = os.open(path, os.O_WRONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
    except OSError as error:
        if error.errno == errno.ENXIO:
            problem = Problem("no program is reading from this pipe", str(path), hint="start its reader first")
            raise InputError(problem) from None
        raise
    with tempfile.TemporaryFile() as whole:
        try:
            with _naming(Path(tempfile.gettempdir())):
                _fill(os.dup(whole.fileno()), write)
        except BaseException:
            os.close(handle)
            raise
        whole.seek(0)
        if hasattr(os, "set_blocking"):
            os.set_blocking(handle, True)
        _fill(handle, lambda file: shutil.copyfileobj(whole, file))


@contextmanager
def _naming(shown_path: Path) -> Iterator[None]:
    """Turn errors of the system into that of a file that cannot be written."""
    try:
        yield
    except OSError as error:
        if error.errno == errno.ENAMETOOLONG:  # the terminal shortens it
            raise
        raise refusal(error, "cannot be written", shown_path) from error
