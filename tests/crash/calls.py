"""A command in a child whose calls strace lists, lets fail, or ends the child at; and what a power loss leaves of them.

Linux only. The child is a fork of this process, which has run the command before: it imports nothing.
"""

from __future__ import annotations

import os
import re
import select
import shutil
import signal
import subprocess
import sys
import time
import warnings
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from rocking_cli.cli.main import main

PATIENCE = 120.0  # s
CHANGES = {
    "open", "openat", "write", "pwrite64", "writev", "rename", "renameat", "renameat2", "mkdir", "mkdirat", "unlink",
    "unlinkat", "rmdir", "link", "linkat", "symlink", "symlinkat", "chmod", "fchmod", "fchmodat", "truncate",
    "ftruncate", "fallocate", "fsync", "fdatasync", "sendfile", "copy_file_range",
}  # fmt: skip
"""Calls that change a disk, or make sure that it keeps a change; those that open a file only to read it apart."""
LOOKS = {
    "stat", "lstat", "fstat", "newfstatat", "statx", "access", "faccessat", "faccessat2", "readlink", "readlinkat",
    "read", "pread64", "lseek", "getdents64", "close",
}  # fmt: skip
NEED_ROOM = CHANGES - {"unlink", "unlinkat", "rmdir", "chmod", "fchmod", "fchmodat", "truncate"}
OF_DATA = {"read", "pread64", "write", "pwrite64", "writev", "getdents64"}
"""Calls whose strings are no paths."""
PART = re.compile(r'(?:(\d+|AT_FDCWD)<((?:\\x..)*)>(?:\(deleted\))?|"((?:\\x..)*)")')


@dataclass(frozen=True)
class Call:
    """A call: the how-manieth of its name in its thread, its files, its bytes, and what it returned."""

    name: str
    nth: int
    paths: tuple[Path, ...]
    data: bytes
    number: int | None
    words: str
    result: str

    @property
    def changes(self) -> bool:
        """Whether it changes a disk."""
        return self.name in CHANGES and ("open" not in self.name or "O_CREAT" in self.words or "O_TRUNC" in self.words)

    @property
    def injected(self) -> bool:
        """Whether it was made to fail."""
        return "(INJECTED)" in self.result


@dataclass(frozen=True)
class Ended:
    """How a child ended: its exit code, negative if by a signal, what it said, and its calls on its folder."""

    code: int
    said: str
    calls: Sequence[Call]


def why_not() -> str | None:
    """Return why this machine cannot try commands so, if it cannot."""
    if sys.platform != "linux" or shutil.which("strace") is None:
        return "needs strace, on Linux"
    tried = subprocess.run(["strace", "-o", os.devnull, "true"], capture_output=True, text=True)
    return f"strace may not trace here: {tried.stderr.strip()}" if tried.returncode else None


def run(words: Sequence[str], folder: Path, *injected: str, traced: bool = False, memory: int | None = None) -> Ended:
    """Run a command in a child in a folder; with `memory`, so many bytes more than it has already are all there are."""
    log, said = folder.with_name("calls.txt"), folder.with_name("said.txt")
    for file in (log, said):
        file.write_bytes(b"")
    traced = traced or bool(injected)
    with warnings.catch_warnings(action="ignore"):  # other threads of this process hold nothing that the child needs
        pid = os.fork()
    if pid == 0:
        _child(words, folder, said, traced, memory)
    tracer = None
    if traced:
        names = ",".join(f"?{name}" for name in sorted(CHANGES | LOOKS))
        given = ["-f", "-qq", "-y", "-xx", "-s", "8000000", "-o", str(log), "-e", f"trace={names}", *injected]
        tracer = subprocess.Popen(["strace", *given, "-p", str(pid)], stderr=subprocess.DEVNULL)
    handle = os.pidfd_open(pid)
    if not select.select([handle], [], [], PATIENCE)[0]:
        os.kill(pid, signal.SIGKILL)
    os.close(handle)
    code = os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1])
    if tracer is not None:
        tracer.wait()
    return Ended(code, said.read_text("utf-8", "replace"), [*_calls(log.read_text("ascii", "replace"), folder)])


def _child(words: Sequence[str], folder: Path, said: Path, traced: bool, memory: int | None) -> None:
    """Run a command as the program does, and end this process."""
    code: object = 70
    try:
        os.chdir(folder)
        os.environ.update(XDG_CACHE_HOME=str(folder / "home"), XDG_CONFIG_HOME=str(folder / "home"))
        os.environ.update(SOURCE_DATE_EPOCH="0", COLUMNS="100")
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        os.dup2(os.open(said, os.O_WRONLY | os.O_APPEND), 2)
        sys.stdout, sys.stderr = (open(number, "w", encoding="utf-8") for number in (1, 2))  # noqa: SIM115, PTH123
        while traced and "TracerPid:\t0\n" in Path("/proc/self/status").read_text("ascii"):
            time.sleep(0.0005)
        if memory is not None:
            import resource  # Windows has none

            pages = int(Path("/proc/self/statm").read_text("ascii").split()[0])
            resource.setrlimit(resource.RLIMIT_AS, (pages * resource.getpagesize() + memory,) * 2)
        try:
            main(list(words), prog_name="rocking")
        except SystemExit as ended:
            code = ended.code or 0
        sys.stdout.flush()
    except BaseException:
        import traceback

        os.write(2, traceback.format_exc().encode())
        code = 1
    finally:
        os._exit(code if isinstance(code, int) else 1)


def _calls(log: str, folder: Path) -> Iterator[Call]:
    """Read what strace wrote of calls on a folder, in the order in which they ended."""
    begun: dict[str, str] = {}
    counted: Counter[tuple[str, str]] = Counter()
    for line in log.splitlines():
        thread, _, text = line.partition(" ")
        text = text.strip()
        if text.endswith(" <unfinished ...>"):
            begun[thread] = text.removesuffix(" <unfinished ...>")
            continue
        if text.startswith("<... "):
            text = begun.pop(thread) + text.partition(" resumed>")[2]
        name, opened, rest = text.partition("(")
        if not opened or not name.isidentifier():
            continue
        counted[thread, name] += 1
        words, _, result = rest.rpartition(" = ")
        paths, data, number, base = [], b"", None, folder
        for one, path, string in PART.findall(words):
            if one:
                base = Path(os.fsdecode(_bytes(path)))
                number = int(one) if one.isdigit() and number is None else number
                if one.isdigit():
                    paths.append(base)
            elif name in OF_DATA:
                data += _bytes(string)
            else:
                paths.append(base / os.fsdecode(_bytes(string)))
                base = folder
        if any(path == folder or folder in path.parents for path in paths):
            yield Call(name, counted[thread, name], tuple(paths), data, number, PART.sub("", words), result)


def _bytes(shown: str) -> bytes:
    return bytes.fromhex(shown.replace("\\x", ""))


# --- power loss


@dataclass(eq=False)
class _File:
    """A file or, without content, a folder: as it is read now, and what of it is on the disk."""

    now: bytearray | None = field(default_factory=bytearray)
    kept: bytes | None = b""

    def sync(self) -> None:
        self.kept = None if self.now is None else bytes(self.now)


State = Mapping[Path, bytes | None]
"""What is in a folder: the content of each file by its path in it, None for a folder."""


def losses(calls: Sequence[Call], folder: Path, before: State) -> tuple[list[State], State]:
    """Return what a power loss after each call may leave: all names, and of each file what was synchronized.

    The second is what is surely there after the last: names, too, are lost in a folder that was not synchronized.
    """
    names = {folder: _File(None, None)} | {
        folder / path: _File(None if content is None else bytearray(content), content)
        for path, content in before.items()
    }
    sure = dict(names)
    opened: dict[int, tuple[_File, int]] = {}
    left: list[State] = []
    for call in calls:
        if call.result.startswith("-1") or not call.result[:1].isdigit():
            continue
        _apply(call, names, sure, opened)
        if call.changes:
            left.append({path.relative_to(folder): file.kept for path, file in names.items() if path != folder})
    return left, {
        path.relative_to(folder): file.kept
        for path, file in sure.items()
        if path != folder and all(each in sure for each in path.parents if folder in each.parents)
    }


def _apply(call: Call, names: dict[Path, _File], sure: dict[Path, _File], opened: dict[int, tuple[_File, int]]) -> None:
    """Carry out a call."""
    returned = int(re.match(r"\d+", call.result)[0])  # type: ignore[index]
    path, number = call.paths[0], call.number
    if len(call.paths) > 1 and number is not None:  # relative to an open folder
        path = call.paths[1]
    match call.name:
        case "open" | "openat":
            if "O_CREAT" in call.words:
                names.setdefault(path, _File())
            if path in names:
                opened[returned] = names[path], 0
                if "O_TRUNC" in call.words:
                    names[path].now = bytearray()
        case "read" | "write" | "pwrite64" if number in opened:
            file, at = opened[number]
            if call.name == "pwrite64":
                at = int(call.words.rpartition(",")[2].rstrip(" )"))
            if call.name != "read" and file.now is not None:
                file.now.extend(bytes(max(0, at - len(file.now))))
                file.now[at : at + returned] = call.data[:returned]
            if call.name != "pwrite64":
                opened[number] = file, at + returned
        case "lseek" if number in opened:
            opened[number] = opened[number][0], returned
        case "ftruncate" if number in opened and (file := opened[number][0]).now is not None:
            size = int(call.words.rpartition(",")[2].rstrip(" )"))
            file.now[size:] = bytes(max(0, size - len(file.now)))
        case "fsync" | "fdatasync" if number in opened:
            file = opened[number][0]
            file.sync()
            if file.now is None:
                for each in [each for each in sure if each.parent == path]:
                    del sure[each]
                sure |= {each: one for each, one in names.items() if each.parent == path}
        case "mkdir" | "mkdirat":
            names[path] = _File(None, None)
        case "rename" | "renameat" | "renameat2":
            target = call.paths[-1]
            moved = {each: file for each, file in names.items() if each == path or path in each.parents}
            for each in moved:
                del names[each]
            names |= {target / each.relative_to(path): file for each, file in moved.items()}
            # What a folder surely holds, it holds under any name.
            sure |= {target / each.relative_to(path): file for each, file in sure.items() if path in each.parents}
        case "unlink" | "unlinkat" | "rmdir":
            names.pop(path, None)
        case "link" | "linkat":
            names[call.paths[-1]] = names[path]
        case "writev" | "truncate" | "fallocate" | "sendfile" | "copy_file_range" | "symlink" | "symlinkat":
            raise NotImplementedError(f"what a power loss leaves of {call.name}")
