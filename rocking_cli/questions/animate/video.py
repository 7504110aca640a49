"""Frames as an MP4 video, by ffmpeg, which must be installed: H.264 in the form that slides and browsers play."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Iterator
from contextlib import suppress
from itertools import chain
from pathlib import Path
from tempfile import TemporaryDirectory, TemporaryFile
from typing import BinaryIO

from PIL import Image

from rocking_cli.errors import InputError, Problem, Refused
from rocking_cli.text import one_line

HOLD = 1.5  # s that the last frame stays
# The sides must be even. Whatever plays the file can start before all of it is there.
OUTPUT = ("-c:v", "h264", "-pix_fmt", "yuv420p", "-movflags", "+faststart")
MAX_MESSAGE = 300  # characters


def ffmpeg(file: Path) -> str:
    """Return the path of ffmpeg. Raises `InputError`, which names the file to write, if it is not installed."""
    program = shutil.which("ffmpeg")
    if program is None:
        hint = "install it from ffmpeg.org or by your package manager, or give a name that ends in .gif or .html"
        raise InputError(Problem("an MP4 video requires the program ffmpeg, which is not found", str(file), hint=hint))
    return program


def write_mp4(stream: BinaryIO, program: str, drawn: Iterator[Image.Image], fps: float) -> None:
    """Write a video.

    Parameters
    ----------
    stream : binary file
        Stream to write to.
    program : str
        Path of ffmpeg.
    drawn : iterator of Image
        The frames, all of one size.
    fps : float
        Frames per second.

    Raises
    ------
    Refused
        If ffmpeg fails or is ended.
    """
    first = next(drawn)
    pad = f"pad=ceil(iw/2)*2:ceil(ih/2)*2:color=white,tpad=stop_mode=clone:stop_duration={HOLD}"
    # An MP4 is not written in one pass, so it cannot come through a pipe.
    with TemporaryDirectory() as folder, TemporaryFile() as messages:
        made = Path(folder) / "video.mp4"
        size = f"{first.width}x{first.height}"
        given = ["-f", "rawvideo", "-pix_fmt", "rgb24", "-video_size", size, "-framerate", f"{fps:g}", "-i", "pipe:0"]
        command = [program, "-nostdin", "-loglevel", "error", *given, "-vf", pad, *OUTPUT, str(made)]
        process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=messages)
        assert process.stdin is not None
        try:
            for each in chain([first], drawn):
                try:
                    process.stdin.write(each.tobytes())
                except OSError:  # ffmpeg no longer reads: its exit code and its messages tell why
                    break
            with suppress(OSError):
                process.stdin.close()
            code = process.wait()
        finally:
            process.kill()
            process.wait()
        if code != 0 or not made.exists():
            messages.seek(0)
            why = one_line(messages.read().decode(errors="replace").strip())[-MAX_MESSAGE:]
            raise Refused(f"ffmpeg did not write the video (exit code {code}){f': {why}' if why else ''}")
        with made.open("rb") as video:
            shutil.copyfileobj(video, stream)
