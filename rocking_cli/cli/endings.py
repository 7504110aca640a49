"""End a command in order on a signal of the system, as after Ctrl-C, so that no partial files remain."""

from __future__ import annotations

import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType
from typing import NoReturn

END_SIGNALS = ("SIGTERM", "SIGHUP")  # sent by `kill`, and when a terminal closes; Windows lacks SIGHUP
RESEND_INTERVAL = 0.05  # s after which a lost signal is sent again


class Stopped(KeyboardInterrupt):
    """Signal that ends the program."""

    def __init__(self, number: int) -> None:
        super().__init__(signal.Signals(number).name)
        self.number = number


def exit_code(stopped: KeyboardInterrupt) -> int:
    """Return the exit code that shells give a program ended by a signal: 130 for Ctrl-C."""
    return 128 + _number(stopped)


def _number(stopped: BaseException | None) -> int:
    return stopped.number if isinstance(stopped, Stopped) else signal.SIGINT


@contextmanager
def in_order() -> Iterator[None]:
    """Raise `Stopped` on the signals that end a program, except those that are ignored, as `nohup` does."""
    former_handlers, former_hook = {}, sys.unraisablehook

    def send_again(dropped: sys.UnraisableHookArgs) -> None:
        """Send a signal again if it came where Python drops exceptions, such as while an object is deleted."""
        if isinstance(dropped.exc_value, KeyboardInterrupt):
            threading.Timer(RESEND_INTERVAL, _give, [_number(dropped.exc_value)]).start()
        else:
            former_hook(dropped)

    sys.unraisablehook = send_again
    if threading.current_thread() is threading.main_thread():  # other threads may not set signal handlers
        for number in (getattr(signal, name) for name in END_SIGNALS if hasattr(signal, name)):
            if signal.getsignal(number) == signal.SIG_DFL:
                former_handlers[number] = signal.signal(number, _stop)
    try:
        yield
    finally:
        sys.unraisablehook = former_hook
        for number, handler in former_handlers.items():
            signal.signal(number, handler)


def _give(number: int) -> None:
    """Send a signal to the main thread; a signal raised in another thread would not wake it."""
    main = threading.main_thread().ident
    if hasattr(signal, "pthread_kill") and main is not None:
        signal.pthread_kill(main, number)
    else:  # Windows can only raise the signal in this thread
        signal.raise_signal(number)


def _stop(number: int, frame: FrameType | None) -> NoReturn:
    raise Stopped(number)
