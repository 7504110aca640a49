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
from rocking_cli.codes.italian.hazard import Hazard
from rocking_cli.codes.italian.site import ItalianSite

LARGEST = 1e6  # g: no ground shakes so; a capacity beyond is none
AS_LARGE = 1e-13  # relative: a demand that scales with a_g


@dataclass(frozen=True)
class SiteGround:
    """What a site does to a structure.

    Parameters
    ----------
    site : ItalianSite
        The site.
    """

    site: ItalianSite

    @cached_property
    def hazard(self) -> Hazard | None:
        """Its hazard, where the file has one."""
        site = self.site
        return Hazard(site.hazard, site.soil or "A", site.topography) if site.hazard is not None else None

    def return_period(self, state: str) -> float | None:
        """That of a limit state [years], where the hazard is known."""
        if self.hazard is None:
            return None
        return self.hazard.counted((self.site.VN or 0.0) * (self.site.CU or 0.0), state)

    def on_ground(self, state: str) -> GroundSpectrum | TableSpectrum | None:
        """The spectrum of the ground of a limit state; None where the file does not give it."""
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
        """The spectrum where the structure stands; None where the file does not give the limit state."""
        ground = self.on_ground(state)
        return None if ground is None else self._where_it_stands(ground, state)

    @property
    def state_of_activation(self) -> str:
        """The limit state whose ground the linear method takes: SLD, or SLV if the file does not give SLD likewise.

        The ordinates of a table have S in them, which is not known: they are compared with those of a table only.
        """
        return "SLD" if type(self.on_ground("SLD")) is type(self.on_ground("SLV")) else "SLV"

    @property
    def of_activation(self) -> DemandSpectrum:
        """The spectrum that the linear method takes, on a floor with the mode of SLD."""
        ground = self.on_ground(self.state_of_activation)
        assert ground is not None  # SLV is always given
        return self._where_it_stands(ground, "SLD")

    def at_return_period(self, TR: float, state: str) -> DemandSpectrum:
        """The spectrum where the structure stands at a return period [years], with the mode of a limit state.

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
        """The a_g at which a demand reaches a capacity [g]; F0 and T_C those of a spectrum, T_D following."""
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
        """The return period at which a demand reaches a capacity [years], all of that period; whether it is beyond."""
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
