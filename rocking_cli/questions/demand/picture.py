"""Plot of the response spectra of a site: acceleration and displacement, of the ground and of a floor."""

from __future__ import annotations

from matplotlib.figure import Figure

from rocking_cli.plotting import style
from rocking_cli.questions.demand.study import LONGEST_FINE_PERIOD, SpectraOfSite

QUANTITIES = (("acceleration", "spectral acceleration [g]"), ("displacement", "spectral displacement [m]"))
BOLDEST = 2.4  # weight [pt] of the curves at the limit state that decides
SUPPORTS = {"": "ground", "floor_": "floor"}


def draw_spectra_of_site(found: SpectraOfSite, title: str) -> Figure:
    """Draw the spectra of a site at each limit state; that which decides is the boldest.

    Parameters
    ----------
    found : SpectraOfSite
        The spectra.
    title : str
        Heading.
    """
    has_floor = next(iter(found.states.values())).floor_acceleration is not None
    supports = list(SUPPORTS) if has_floor else [""]
    others = [state for state in found.states if state != found.first]
    looks = {state: style.family(k) for k, state in enumerate([found.first, *others])}
    looks[found.first]["linewidth"] = BOLDEST
    figure = style.new_figure(5.6)
    panels = figure.subplots(2, len(supports), squeeze=False, sharey="row")
    for (quantity, label), row in zip(QUANTITIES, panels, strict=True):
        for support, axes in zip(supports, row, strict=True):
            for state, spectra in found.states.items():
                curve = getattr(spectra, support + quantity)
                axes.plot(found.periods, curve, label=state, **looks[state])
            longest = LONGEST_FINE_PERIOD if quantity == "acceleration" else float(found.periods[-1])
            axes.set_xlim(0.0, min(longest, float(found.periods[-1])))
            name = label if axes is row[0] else ""
            style.tidy(axes, "period T [s]", name)
            if has_floor:
                axes.set_title(SUPPORTS[support], fontsize=style.LABEL, loc="left")
        row[0].set_ylim(bottom=0.0)
    figure.suptitle(style.plain(style.fitted(title)), fontsize=style.TITLE, x=0.01, ha="left", color=style.INK)
    figure.align_ylabels()
    style.legend_below(figure, panels[0, 0].get_lines(), len(found.states), handlelength=3.0)
    return figure
