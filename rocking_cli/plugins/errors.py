"""Errors of plugin code, with the plugin and the place; no error of a plugin ends the program unhandled."""

from __future__ import annotations

import traceback
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from functools import wraps
from inspect import isfunction, isgeneratorfunction
from typing import Any

from rocking_cli.errors import PluginError, RockingError


@contextmanager
def blame(what: str | Callable[[], str], module: str, *, but: type[Exception] = RockingError) -> Iterator[None]:
    """Turn any error of plugin code into a `PluginError`.

    Parameters
    ----------
    what : str or callable
        Beginning of the message, with the plugin and the task: "the mechanism odd failed in motion"; or what returns
        it, as the package of a plugin takes long to name.
    module : str
        Module of the plugin: the message ends with the last place in its package.
    but : type, optional
        Errors that pass unchanged, in addition to those of this package.

    Raises
    ------
    PluginError
        From the error. A `MemoryError` passes unchanged too.
    """
    try:
        yield
    except (RockingError, MemoryError, but):
        raise
    except (Exception, SystemExit) as error:  # a plugin may raise anything, but must not end the program
        raise plugin_error(what if isinstance(what, str) else what(), module, error) from error


def plugin_error(what: str, module: str, error: BaseException) -> PluginError:
    """Return the error to raise from an error of a plugin. Parameters are those of `blame`, `what` being a text."""
    message = str(error)
    return PluginError(f"{what}: {type(error).__name__}{f': {message}' if message else ''}{_place(module, error)}")


Beginning = Callable[[Any, str], str]  # of a message, from a class and the name of a method


def guard(cls: type, methods: Iterable[str], what: Beginning, *, but: type[Exception] = RockingError) -> None:
    """Wrap methods that a class itself defines, so that their errors are reported as errors of its plugin, see `blame`.

    Parameters
    ----------
    cls : type
        Class, changed in place.
    methods : iterable of str
        Names of the methods to wrap; those that the class inherits are left unchanged.
    what : callable
        Returns the beginning of the message from the class of an object and the name of a method.
    but : type, optional
        See `blame`.
    """
    for name in methods:
        method = vars(cls).get(name)
        if isfunction(method):
            setattr(cls, name, _guarded(method, cls.__module__, what, but))


def failed(kind: str, attribute: str) -> Beginning:
    """Return a function for `guard` that begins messages on failed plugins of a kind, named by an attribute."""
    return lambda own, method: f"the {kind} {getattr(own, attribute, own.__name__)} failed in {method}"


def own_traceback(error: BaseException | None) -> str | None:
    """Return the traceback of a plugin's error that caused this one; None if there is none."""
    while error is not None:
        if isinstance(error, PluginError) and error.__cause__ is not None:
            summary = traceback.TracebackException.from_exception(error.__cause__)
            # Frames that only call or import the plugin are of no use to its author.
            kept = [each for each in summary.stack if each.filename != __file__ and "importlib" not in each.filename]
            summary.stack = traceback.StackSummary.from_list(kept or list(summary.stack))
            return "".join(summary.format()).rstrip("\n")
        error = error.__cause__
    return None


def _guarded(method: Callable[..., Any], module: str, what: Beginning, but: type[Exception]) -> Callable[..., Any]:
    if isgeneratorfunction(method):

        @wraps(method)
        def guarded_parts(self: Any, *args: Any, **named: Any) -> Iterator[Any]:
            with blame(what(type(self), method.__name__), module, but=but):
                yield from method(self, *args, **named)

        return guarded_parts

    @wraps(method)
    def guarded(self: Any, *args: Any, **named: Any) -> Any:
        try:  # as `blame`, which takes longer than most of the methods
            return method(self, *args, **named)
        except (RockingError, MemoryError, but):
            raise
        except (Exception, SystemExit) as error:
            raise plugin_error(what(type(self), method.__name__), module, error) from error

    return guarded


def _place(module: str, error: BaseException) -> str:
    """Return the place of an error in the package of the plugin; empty if it is elsewhere."""
    package = module.partition(".")[0]
    places = [
        f" ({frame.f_code.co_filename}:{line})"
        for frame, line in traceback.walk_tb(error.__traceback__)
        if str(frame.f_globals.get("__name__")).partition(".")[0] == package
    ]
    return places[-1] if places else ""
