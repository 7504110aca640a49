"""Plot of the response spectra of a site: acceleration and displacement, of the ground and of a floor."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from matplotlib.figure import Figure

from rocking_cli.arrays import Reals
from rocking_cli.plotting import style
from rocking_cli.verification.demand import LONGEST_FINE_PERIOD, StateSpectra

QUANTITIES = (("acceleration", "spectral acceleration [g]"), ("displacement", "spectral displacement [m]"))
BOLDEST = 2.4  # pt, of the limit state that decides
SUPPORTS = {"": "on the ground", "floor_": "on the floor"}


def draw_spectra_of_site(
    periods: Reals, states: Mapping[str, StateSpectra], first: str, title: str, say: Callable[[str], str] = str
) -> Figure:
    """Draw the spectra of a site at each limit state; that which decides is the boldest.

    Parameters
    ----------
    periods : ndarray, shape (n,)
        Periods of the spectra [s].
    states : mapping of str to StateSpectra
        The spectra at each limit state.
    first : str
        The limit state that decides.
    title : str
        Heading.
    say : callable
        `say(text)` returns a label in another language.
    """
    has_floor = next(iter(states.values())).floor_acceleration is not None
    supports = list(SUPPORTS) if has_floor else [""]
    others = [state for state in states if state != first]
    looks = {state: style.family(k) for k, state in enumerate([first, *others])}
    looks[first]["linewidth"] = BOLDEST
    figure, panels = style.panels(5.6, 2, len(supports), sharey="row")
    for (quantity, label), row in zip(QUANTITIES, panels, strict=True):
        for support, axes in zip(supports, row, strict=True):
            for state, spectra in states.items():
                curve = getattr(spectra, support + quantity)
                axes.plot(periods, curve, label=state, **looks[state])
            longest = LONGEST_FINE_PERIOD if quantity == "acceleration" else float(periods[-1])
            axes.set_xlim(0.0, min(longest, float(periods[-1])))
            name = say(label) if axes is row[0] else ""
            style.tidy(axes, say("period T [s]"), name)
            if has_floor:
                axes.set_title(say(SUPPORTS[support]), fontsize=style.LABEL, loc="left")
        row[0].set_ylim(bottom=0.0)
    style.heading_of_all(figure, title)
    figure.align_ylabels()
    style.legend_below(figure, panels[0, 0].get_lines(), len(states), handlelength=3.0)
    return figure
