"""The command `rocking`: a group that imports a command only when it is used.

A signal of the system ends it in order, as Ctrl-C does, so that no partial files remain.
"""

from __future__ import annotations

import errno
import os
import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from importlib import import_module
from time import monotonic
from types import FrameType
from typing import Any, NoReturn

import click

from rocking_cli import __version__
from rocking_cli.cli import terminal
from rocking_cli.cli.help import HelpFormatter
from rocking_cli.errors import InputError, Problem, RockingError
from rocking_cli.plugins.rooms import commands, headed, short_help
from rocking_cli.text import cut, keeps_formulas, one_line, printable

NO_MEMORY = "Could not allocate memory", "can't start new thread"  # of MuJoCo, and of Python
GONE = {
    "crosscheck": "`rocking respond --engine blocks` compares both engines",
    "score": "in a checkout of the sources, `python -m validation.score TESTS.csv` scores predictions",
}
"""Commands that are gone, and what does their work."""
MAX_EPOCH_DIGITS = 11  # number of digits of SOURCE_DATE_EPOCH, up to the year 5138

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

    def stop(number: int, frame: FrameType | None) -> NoReturn:
        raise Stopped(number)

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
                former_handlers[number] = signal.signal(number, stop)
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


class _Helped(click.Context):
    """Context whose help fits narrow terminals."""

    formatter_class = HelpFormatter


class _Context(_Helped):
    """Context of a command: only results go to standard output."""

    def invoke(self, callback: Any, /, *args: Any, **named: Any) -> Any:
        """Run the function of a command."""
        with terminal.plugins_apart():
            return super().invoke(callback, *args, **named)


def _check_environment() -> None:
    """Refuse a date of build that no library can read. Raises `InputError`."""
    epoch = os.environ.get("SOURCE_DATE_EPOCH", "0")
    if not (epoch.isascii() and epoch.isdecimal() and len(epoch) <= MAX_EPOCH_DIGITS):
        hint = "unset this environment variable, or give seconds since 1970"
        what = f"must be a whole number of at most {MAX_EPOCH_DIGITS} digits, got {cut(repr(epoch))}"
        raise InputError(Problem(what, field="SOURCE_DATE_EPOCH", hint=hint))


class LazyGroup(click.Group):
    """Group of commands, each in a module of its name; errors of the package become a message and an exit code."""

    context_class = _Helped

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Return the names of the commands in the order in which a newcomer needs them."""
        return list(commands())

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Import the module of a command."""
        if cmd_name not in commands():
            return None
        module = import_module(commands()[cmd_name])
        if hasattr(module, "command"):
            command: click.Command = module.command
        else:
            from rocking_cli.cli.made import Made

            name = "".join(map(str.capitalize, cmd_name.split("_")))
            command = Made(cmd_name, getattr(module, f"{name}Asked"), short_help(cmd_name))
        command.context_class = _Context
        return command

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the commands and what they do, without importing them."""
        formatter.write_paragraph()
        widest = max(map(len, commands()))
        for heading, listed in headed().items():
            formatter.write_heading(heading)
            with formatter.indentation():
                formatter.write_dl([(name.ljust(widest), text) for name, text in listed])

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Resolve a command; if it does not exist, suggest a similar name."""
        from difflib import get_close_matches

        if args[0] in GONE:
            raise click.UsageError(f"No such command '{args[0]}': {GONE[args[0]]}", ctx)
        close = get_close_matches(args[0], commands(), n=1)
        if args[0] not in commands() and close and not ctx.resilient_parsing and not args[0].startswith("-"):
            raise click.UsageError(f"No such command '{args[0]}': did you mean {close[0]}?", ctx)
        return super().resolve_command(ctx, args)

    def main(self, *args: Any, **extra: Any) -> Any:
        """Run the program; a system error ends it with a message, in help too."""
        with terminal.streams():
            try:
                return super().main(*args, **extra)  # handles a closed pipe quietly
            except OSError as error:
                if isinstance(error, PermissionError) or error.errno == errno.ENAMETOOLONG:  # typed by the user
                    terminal.error(f"{one_line(cut(str(error.filename)))}: {error.strerror}")
                    sys.exit(InputError.exit_code)
                terminal.error(f"the operating system reported an error: {error.strerror or error}")
                sys.exit(1)

    def invoke(self, ctx: click.Context) -> Any:
        """Run a command; a known error ends it with a message on standard error."""
        os.environ["MPLBACKEND"] = "agg"  # figures are written, never shown: no display is needed
        # No plugin of pydantic is used, and a search for plugins takes as long as reading many structure files.
        os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")
        import logging  # which takes longer than the help

        logging.getLogger("matplotlib").setLevel(logging.ERROR)  # it tells of its caches
        for stream in (sys.stdout, sys.stderr):
            if hasattr(stream, "reconfigure"):
                stream.reconfigure(errors="replace")  # old code pages lack some characters of names
        began = monotonic()
        try:
            _check_environment()
            with in_order():
                return super().invoke(ctx)
        except click.ClickException as error:
            # The message quotes what the user typed.
            message = terminal.beside(printable(error.format_message()), "Error: ")
            error.format_message = lambda: message  # type: ignore[method-assign]
            terminal.debug_traceback(error)
            raise
        except KeyboardInterrupt as stopped:
            terminal.error(": ".join(["interrupted", *getattr(stopped, "__notes__", ())]))
            ctx.exit(exit_code(stopped))
        except RockingError as error:
            terminal.error("\n  ".join([str(error), *getattr(error, "__notes__", ())]))
            terminal.debug_traceback(error)
            ctx.exit(error.exit_code)
        except OSError as error:  # reported by `main`
            terminal.debug_traceback(error)
            raise
        except Exception as error:
            if not (isinstance(error, MemoryError) or any(words in str(error) for words in NO_MEMORY)):
                raise
            terminal.error("not enough memory on this machine")
            terminal.debug_traceback(error)
            ctx.exit(1)
        finally:
            computing = sys.modules.get("rocking_cli.dynamics.ways")  # imported by what may compute histories
            way = computing and computing.last
            terminal.detail(f"took {monotonic() - began:.2f} s" + (f", kernels {way}" if way else ""))


@click.group(
    cls=LazyGroup,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100},
    epilog="Exit codes: 0 done, whatever the outcome; 1 system, 2 input, 3 mechanism or plugin, 4 solver or selfcheck; "
    "5 done, but not for the records or runs that are named; 128 + n signal n.",
)
@click.version_option(__version__, prog_name="rocking")
@click.option("-v", "--verbose", is_flag=True, help="Show all, where inputs come from and how long it takes.")
@click.option(
    "--debug",
    is_flag=True,
    default=lambda: os.environ.get("ROCKING_DEBUG") == "1",
    help="Show the Python traceback of errors (or ROCKING_DEBUG=1).",
)
@click.option("--formulas", is_flag=True, help="Leave texts in CSV tables that a spreadsheet would compute.")
def main(verbose: bool, debug: bool, formulas: bool) -> None:
    """Rocking response of structures in earthquakes.

    \b
    Start with:
      rocking new block > block.yaml
      rocking draw block.yaml
      rocking respond block.yaml --record accel.csv --plot response.png
      rocking margin block.yaml --record accel.csv
      rocking verify block.yaml --site site.yaml
    """
    click.get_current_context().call_on_close(partial(keeps_formulas.reset, keeps_formulas.set(formulas)))
