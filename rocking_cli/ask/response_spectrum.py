"""`rk.response_spectrum`: compute the response spectrum of a ground motion."""

from __future__ import annotations

from typing import TYPE_CHECKING

from numpy.typing import ArrayLike

from rocking_cli.ask.answer import Answer
from rocking_cli.ask.ground_motions import Motion, motion_of
from rocking_cli.ask.numbers import takes_numbers

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rocking_cli.processing.oscillator import ResponseSpectrum


@takes_numbers
def response_spectrum(
    motion: Motion, periods: ArrayLike | None = None, *, damping: float = 0.05, scale: float = 1.0
) -> Answer[ResponseSpectrum]:
    """Compute the response spectrum of a ground motion: the peak responses of linear oscillators.

    Parameters
    ----------
    motion : GroundMotion, Pulse, str or Path
        The motion, its file, or a pulse as text.
    periods : array_like, shape (n,), optional
        Undamped periods of the oscillators [s]; by default 200 from 0.02 to 10 s at equal ratios.
    damping : float
        Damping ratio of the oscillators, from 0 to below 1.
    scale : float
        Scale factor on the motion.

    Returns
    -------
    Answer of ResponseSpectrum
        `periods`, and at each of them the displacement `sd` [m], the pseudo-velocity `sv` [m/s] and the
        pseudo-acceleration `sa` [standard gravity].

    Raises
    ------
    InputError
        If a value is out of range, or a file cannot be used.

    Notes
    -----
    The spectrum is exact for straight lines between the samples, during the motion and after it.

    Examples
    --------
    >>> import rocking_cli as rk
    >>> rk.response_spectrum("sine:0.2g:0.8s", [0.8]).sa.round(2).tolist()
    [0.54]
    """
    from rocking_cli.processing.oscillator import response_spectrum as respond_linearly
    from rocking_cli.views import response_spectrum as views

    scaled = motion_of(motion).scaled(scale)
    found = respond_linearly(scaled, periods, damping)

    def figure() -> Figure:
        from rocking_cli.plotting.response_spectrum import draw_response_spectra

        return draw_response_spectra({scaled.name: found})

    said = views.view(scaled.name, found)
    return Answer("response spectrum", found, said, lambda: views.table({scaled.name: found}), figure)
