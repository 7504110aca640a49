"""Plot of response spectra: pseudo-acceleration, pseudo-velocity and displacement against the period."""

from __future__ import annotations

from collections.abc import Mapping

from matplotlib.figure import Figure

from rocking_cli.plotting import style
from rocking_cli.processing.oscillator import ResponseSpectrum

MAX_NAMED_CURVES = 6  # more curves are all drawn in one style
QUANTITIES = (("sa", "Sa, pseudo [g]"), ("sv", "Sv, pseudo [m/s]"), ("sd", "Sd [m]"))


def draw_response_spectra(spectra: Mapping[str, ResponseSpectrum]) -> Figure:
    """Plot the spectra of motions, all of one damping ratio.

    Parameters
    ----------
    spectra : mapping of str to ResponseSpectrum
        The spectra, by the name of the motion.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, every = style.panels(6.6, 3, sharex=True)
    panels = every[:, 0]
    first = next(iter(spectra.values()))
    names = list(spectra)
    title = names[0] if len(names) == 1 else f"{len(names)} motions"
    style.heading(panels[0], f"{title}: response spectra, {100 * first.damping:g} % damping")
    for axes, (quantity, label) in zip(panels, QUANTITIES, strict=True):
        for k, (name, each) in enumerate(spectra.items()):
            look = (
                style.distinct(k) | {"marker": ""}
                if len(names) <= MAX_NAMED_CURVES
                else {"color": style.INK, "alpha": 0.5}
            )
            width = {"linewidth": style.CURVE if len(names) == 1 else style.MEDIUM}
            axes.plot(each.periods, getattr(each, quantity), **look | width, label=style.plain(style.fitted(name, 3.2)))
        axes.set_ylim(bottom=0.0)
        axes.margins(x=0.01)
        style.logarithmic(axes.xaxis)
        style.tidy(axes, y=label)
    panels[-1].set_xlabel("period [s]", fontsize=style.LABEL)
    figure.align_ylabels()
    if 1 < len(names) <= MAX_NAMED_CURVES:
        style.legend_below(figure, panels[0].get_lines())
    return figure
