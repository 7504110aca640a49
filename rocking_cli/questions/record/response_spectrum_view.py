"""View of response spectra of ground motions, as text and as data."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking_cli.views.column import Column, data_of, of
from rocking_cli.views.view import View

if TYPE_CHECKING:
    from rocking_cli.io.tables import Columns
    from rocking_cli.processing.oscillator import ResponseSpectrum


ORDINATES: tuple[Column[ResponseSpectrum], ...] = (
    Column("period", of("periods"), "s"),
    Column("sa", of("sa"), "g", name="pseudo Sa"),
    Column("sv", of("sv"), "m/s", name="pseudo Sv"),
    Column("sd", of("sd"), "m", name="Sd"),
)
"""Columns whose values are arrays, over all periods."""


def data(spectrum: ResponseSpectrum) -> dict[str, Any]:
    """Return a spectrum as plain data, in s, standard gravity, m/s and m."""
    return {"damping": spectrum.damping} | {
        key: values.tolist() for key, values in data_of(ORDINATES, spectrum).items()
    }


def table(spectra: Mapping[str, ResponseSpectrum]) -> Columns:
    """Return spectra as columns, one motion below the other."""
    all_spectra = list(spectra.values())
    return {
        "motion": [name for name, each in spectra.items() for _ in each.periods],
        "damping": [each.damping for each in all_spectra for _ in each.periods],
        **{column.heading: np.concatenate([column.of(each) for each in all_spectra]).tolist() for column in ORDINATES},
    }


def peaks(name: str, spectrum: ResponseSpectrum) -> str:
    """Return a sentence on the largest ordinates of a spectrum and their periods."""
    k, j = int(spectrum.sa.argmax()), int(spectrum.sv.argmax())
    return (
        f"{name}: with {100 * spectrum.damping:g} % damping Sa is largest at {spectrum.periods[k]:.3g} s, "
        f"{spectrum.sa[k]:.3g} g, and Sv at {spectrum.periods[j]:.3g} s, {spectrum.sv[j]:.3g} m/s."
    )


def view(name: str, spectrum: ResponseSpectrum) -> View:
    """Show the spectrum of one motion."""
    return View(lambda: {"name": name, **data(spectrum)}, [peaks(name, spectrum)])
