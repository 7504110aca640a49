"""The kernels compiled by numba: for the libraries that are shipped, the test that compares them, and a benchmark."""

from __future__ import annotations

from types import FunctionType, ModuleType
from typing import Any

from numba import njit

from rocking_cli.dynamics.ways import names_of

# IEEE arithmetic to the letter: a history that meets a NaN must show it, and a record scaled before or inside the
# kernel must give the same bits.
OPTIONS: dict[str, Any] = {"nogil": True, "fastmath": False, "error_model": "numpy"}


def compiled(module: ModuleType, **options: Any) -> dict[str, Any]:
    """The names of a kernel module, with its functions compiled; those of the module itself stay Python's."""
    namespace = names_of(module.SOURCE)
    for function in module.SOURCE:
        # As if the file were in no folder: a library keeps where an error would be raised.
        code = function.__code__.replace(co_filename=f"{function.__module__.rpartition('.')[2]}.py")
        twin = FunctionType(code, namespace, function.__name__)
        twin.__module__, twin.__qualname__ = function.__module__, function.__qualname__
        inline = {"forceinline": True} if function in namespace.get("INLINE", ()) else {}
        namespace[function.__name__] = njit(**{**OPTIONS, **options}, **inline)(twin)
    return namespace
