"""How a command ends when the system asks it to: in order, as after Ctrl-C, so that nothing half-made stays behind."""

from __future__ import annotations

import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType
from typing import NoReturn

ASKED = ("SIGTERM", "SIGHUP")  # `kill`, and a terminal that is closed; Windows has not the second
AGAIN = 0.05  # s after which a signal that was lost is given again


class Stopped(KeyboardInterrupt):
    """A signal that asks the program to end."""

    def __init__(self, number: int) -> None:
        super().__init__(signal.Signals(number).name)
        self.number = number


def exit_code(stopped: KeyboardInterrupt) -> int:
    """The exit code that shells give a program that a signal ended: 130 for Ctrl-C."""
    return 128 + _number(stopped)


def _number(stopped: BaseException | None) -> int:
    return stopped.number if isinstance(stopped, Stopped) else signal.SIGINT


@contextmanager
def in_order() -> Iterator[None]:
    """Make of the signals that ask for an end a `Stopped`; not of those that somebody ignores, as `nohup` does."""
    kept, unraisable = {}, sys.unraisablehook

    def not_lost(what: sys.UnraisableHookArgs) -> None:
        """Give a signal again that came where Python drops exceptions, such as while an object is deleted."""
        if isinstance(what.exc_value, KeyboardInterrupt):
            threading.Timer(AGAIN, _give, [_number(what.exc_value)]).start()
        else:
            unraisable(what)

    sys.unraisablehook = not_lost
    if threading.current_thread() is threading.main_thread():  # nobody else may
        for number in (getattr(signal, name) for name in ASKED if hasattr(signal, name)):
            if signal.getsignal(number) == signal.SIG_DFL:
                kept[number] = signal.signal(number, _stop)
    try:
        yield
    finally:
        sys.unraisablehook = unraisable
        for number, handler in kept.items():
            signal.signal(number, handler)


def _give(number: int) -> None:
    """Give the main thread a signal: one that is raised in another thread would not wake it."""
    main = threading.main_thread().ident
    if hasattr(signal, "pthread_kill") and main is not None:
        signal.pthread_kill(main, number)
    else:  # Windows
        signal.raise_signal(number)


def _stop(number: int, frame: FrameType | None) -> NoReturn:
    raise Stopped(number)
