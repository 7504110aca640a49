"""What `rocking error` and `rk.error` are asked."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from rocking_cli.ask.asked import option
from rocking_cli.ask.groups import OfStructure, plot_file
from rocking_cli.ask.kinds import NUMBER, several

if TYPE_CHECKING:  # the stub of verbs finds the type here
    from numpy.typing import ArrayLike as ArrayLike

NUMBERS = "Sequence[float] | ArrayLike"


class ErrorAsked(OfStructure):
    """Compute the errors of the equivalent block of a structure, in each direction.

    The errors are those of its free rocking period, of its uplift acceleration, and of its overturning time under a
    constant acceleration, with kappa1 and kappa2. They are relative to the mechanism itself and come from exact energy
    integrals, without time stepping. A positive error means that the block's value is too large.

    Without FILE, the command uses rocking.yaml of this folder, or else a block of 0.7 m x 2.8 m.

    \b
    Example:
      rocking error arch.yaml --at 0.3 --at 0.7 --a 1.5 --plot error.png

    Source: DeJong and Dimitrakopoulos (2014), Eqs. 24-25.
    """

    at: Sequence[float] = option(
        "Amplitude phi/phi_cr of the free motion at which to evaluate the error of its period. Repeatable.",
        several(NUMBER, "RATIO"), default=(0.5,), repeat=True, min_length=1, type=NUMBERS,
    )  # fmt: skip
    a: Sequence[float] = option(
        "Constant acceleration, as a multiple of the uplift acceleration. Repeatable.",
        several(NUMBER, "RATIO"), default=(2.0,), repeat=True, min_length=1, type=NUMBERS,
    )  # fmt: skip
    plot: Path | None = plot_file("Plot the errors against amplitude and acceleration")
