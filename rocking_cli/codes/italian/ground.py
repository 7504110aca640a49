"""The spectra of a site, by limit state and by return period."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

from rocking_cli.codes.italian.capacity import root
from rocking_cli.codes.italian.demand import (
    DemandSpectrum,
    FloorSpectrum,
    GroundSpectrum,
    TableSpectrum,
)
from rocking_cli.codes.italian.site import ItalianSite
from rocking_cli.codes.italian.site_hazard import Hazard

LARGEST = 1e6  # g: no ground shakes so; a capacity beyond is none
AS_LARGE = 1e-13  # relative: a demand that scales with a_g


@dataclass(frozen=True)
class SiteGround:
    """Spectra and return periods of a site for a structure.

    Parameters
    ----------
    site : ItalianSite
        The site.
    """

    site: ItalianSite

    @cached_property
    def hazard(self) -> Hazard | None:
        """Seismic hazard of the site; None if the site file has none."""
        site = self.site
        return Hazard(site.hazard, site.soil or "A", site.topography) if site.hazard is not None else None

    def return_period(self, state: str) -> float | None:
        """Return the return period of a limit state [years]; None if the hazard is not known."""
        if self.hazard is None:
            return None
        return self.hazard.counted((self.site.VN or 0.0) * (self.site.CU or 0.0), state)

    def on_ground(self, state: str) -> GroundSpectrum | TableSpectrum | None:
        """Return the spectrum of the ground at a limit state; None if the site file does not give it."""
        TR = self.return_period(state)
        if TR is not None and self.hazard is not None:
            return self.hazard.spectrum(TR)
        given = self.site.shaking(state)
        if given is None:
            return None
        if given.spectrum is not None:
            field = "spectrum" if state == "SLV" else f"{state}.spectrum"
            return TableSpectrum(tuple((T, a) for T, a in given.spectrum), 1.0, self.site.own_period or 0.0, field)
        assert given.ag is not None and given.F0 is not None and given.TC is not None and given.S is not None
        return GroundSpectrum(given.ag, given.F0, given.TC, given.S, self.site.soil)

    def spectrum(self, state: str) -> DemandSpectrum | None:
        """Return the spectrum at the support of the structure, ground or floor; None if the state is not given."""
        ground = self.on_ground(state)
        return None if ground is None else self._where_it_stands(ground, state)

    @property
    def state_of_activation(self) -> str:
        """The limit state whose ground the linear method uses: SLD, or SLV if SLD is not given in the same form.

        The ordinates of a table include S, which is then not known, so that they are compared only with those of a
        table.
        """
        return "SLD" if type(self.on_ground("SLD")) is type(self.on_ground("SLV")) else "SLV"

    @property
    def of_activation(self) -> DemandSpectrum:
        """Spectrum of the linear method, at the support of the structure.

        On a floor, the mode of the building is that of SLD.
        """
        ground = self.on_ground(self.state_of_activation)
        assert ground is not None  # SLV is always given
        return self._where_it_stands(ground, "SLD")

    def at_return_period(self, TR: float, state: str) -> DemandSpectrum:
        """Return the spectrum at the support for a return period [years], with the floor's mode at a limit state.

        The hazard must be known.
        """
        assert self.hazard is not None
        return self._where_it_stands(self.hazard.spectrum(TR), state)

    def _where_it_stands(self, ground: GroundSpectrum | TableSpectrum, state: str) -> DemandSpectrum:
        floor = self.site.floor
        if floor is None:
            return ground
        mode = floor.mode(state)
        return FloorSpectrum(ground, floor.z, floor.H, mode.T1, mode.xi1, floor.n)

    def capacity(self, spectrum: DemandSpectrum, demand: Callable[[DemandSpectrum], float], capacity: float) -> float:
        """Return the a_g at which a demand reaches a capacity [g], with F0 and T_C fixed; T_D follows from a_g."""
        own = demand(spectrum)
        in_ratio = spectrum.ag * capacity / own
        if abs(demand(spectrum.with_ag(in_ratio)) / capacity - 1) < AS_LARGE:
            return in_ratio
        low, high = 0.0, spectrum.ag
        while demand(spectrum.with_ag(high)) < capacity and high < LARGEST:
            low, high = high, 2 * high
        return root(lambda ag: demand(spectrum.with_ag(ag)) - capacity, low, high)

    def lasts(
        self, state: str, demand: Callable[[DemandSpectrum], float], capacity: float
    ) -> tuple[float | None, bool]:
        """Return the return period at which a demand reaches a capacity [years], and whether it is beyond the table.

        Beyond the table of the hazard, the return period is the nearest one of the table; None if the hazard is not
        known.
        """
        hazard = self.hazard
        if hazard is None:
            return None, False

        def over(TR: float) -> float:
            return demand(self.at_return_period(TR, state)) - capacity

        if over(hazard.first) >= 0:
            return hazard.first, True
        if over(hazard.last) < 0:
            return hazard.last, True
        return root(over, hazard.first, hazard.last), False
