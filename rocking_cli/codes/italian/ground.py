"""The hazard and the spectra of a site, by limit state and by return period [NTC 2018, 3.2], and its demand."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import exp, log
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rocking_cli.codes.italian.capacity import root
from rocking_cli.codes.italian.demand import (
    GROUND_PERIOD,
    LEVEL_FROM,
    LEVEL_TO,
    LONG_PERIOD_START,
    DemandSpectrum,
    FloorSpectrum,
    GroundSpectrum,
    TableSpectrum,
)
from rocking_cli.codes.italian.grid import EARTH_RADIUS
from rocking_cli.codes.italian.rules import FIRST_STATE, RULES, STATES, STATES_OF_SITE
from rocking_cli.codes.italian.site import ItalianSite
from rocking_cli.errors import InputError, Problem
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.studies.remark import Remark
from rocking_cli.verification.demand import DemandParameter, DemandTable, SiteDemand, StateDemand

LARGEST_AG = 1e6  # g; no ground motion is as strong, and a larger capacity is not reported
SAME_RATIO = 1e-13  # relative difference up to which a demand is proportional to a_g
HALF_YEAR = 0.5
MAX_ROUNDING = 0.01  # relative difference between the return period of a limit state and that of its row


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
        """Return the return period of a limit state [years].

        None if the reference life is not known, or if the hazard does not reach a limit state that is not required.
        """
        life = self.site.life
        if life is None:
            return None
        if self.hazard is None:
            return bounded(return_period(life, state))
        try:
            return self.hazard.counted(life, state)
        except InputError:
            if state in self.site.asked:
                raise
            return None

    def on_rock(self, state: str) -> RockMotion | None:
        """Return the ground on rock at a limit state; None if the site file does not give it on rock."""
        if self.hazard is not None:
            TR = self.return_period(state)
            return None if TR is None else self.hazard.parameters(TR)
        shaking = self.site.shaking(state)
        if shaking is None or shaking.TC_star is None:
            return None
        assert shaking.ag is not None and shaking.F0 is not None
        return RockMotion(shaking.ag, shaking.F0, shaking.TC_star)

    def on_ground(self, state: str) -> GroundSpectrum | TableSpectrum | None:
        """Return the spectrum of the ground at a limit state; None if the site file does not give it."""
        rock = self.on_rock(state)
        if rock is not None:
            return rock.on_soil(self.site.soil or "A", self.site.topography)
        shaking = self.site.shaking(state)
        if shaking is None:
            return None
        if shaking.spectrum is not None:
            field = "spectrum" if shaking is self.site else f"{state}.spectrum"
            return TableSpectrum(tuple((T, a) for T, a in shaking.spectrum), 1.0, self.site.own_period or 0.0, field)
        assert shaking.ag is not None and shaking.F0 is not None and shaking.TC is not None and shaking.S is not None
        return GroundSpectrum(shaking.ag, shaking.F0, shaking.TC, shaking.S, self.site.soil)

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
        assert ground is not None  # every site file has SLV
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
        at_site = demand(spectrum)
        in_ratio = spectrum.ag * capacity / at_site
        if abs(demand(spectrum.with_ag(in_ratio)) / capacity - 1) < SAME_RATIO:
            return in_ratio
        low, high = 0.0, spectrum.ag
        while demand(spectrum.with_ag(high)) < capacity and high < LARGEST_AG:
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


PROBABILITY = {"SLO": 0.81, "SLD": 0.63, **{rule.state: rule.probability for rule in RULES}}
"""Probability of exceedance in the reference life, by limit state."""
SHORTEST_RETURN_PERIOD, LONGEST_RETURN_PERIOD = 30.0, 2475.0  # years; the code replaces others by these
SOILS = {
    "A": (1.0, 0.0, 1.0, 1.0, 1.0, 0.0),
    "B": (1.40, 0.40, 1.0, 1.2, 1.10, -0.20),
    "C": (1.70, 0.60, 1.0, 1.5, 1.05, -0.33),
    "D": (2.40, 1.50, 0.9, 1.8, 1.25, -0.50),
    "E": (2.00, 1.10, 1.0, 1.6, 1.15, -0.40),
}
"""Numbers by soil: S_S = first - second F0 ag/g, at least the third, at most the fourth; C_C = fifth TC*^sixth."""
TOPOGRAPHY = {"T1": 1.0, "T2": 1.2, "T3": 1.2, "T4": 1.4}
"""Factor S_T by topographic class."""


def soil_factor(soil: str, F0: float, ag: float) -> float:
    """Return the factor S_S of a soil class, for a_g in g."""
    first, second, least, most, _, _ = SOILS[soil]
    return min(max(first - second * F0 * ag, least), most)


def corner_factor(soil: str, TC_star: float) -> float:
    """Return the factor C_C of a soil class, for TC* in s."""
    *_, factor, power = SOILS[soil]
    return factor * float(TC_star**power)


def return_period(life: float, state: str) -> float:
    """Return TR = -VR/ln(1 - P) of a limit state [years], with VR the reference life."""
    return -life / log(1 - PROBABILITY[state])


def bounded(TR: float) -> float:
    """Return a return period, limited to the range that the code allows [years]."""
    return min(max(TR, SHORTEST_RETURN_PERIOD), LONGEST_RETURN_PERIOD)


class RockMotion(NamedTuple):
    """The ground on rock: acceleration a_g [g], amplification F0, and period T_C* [s]."""

    ag: float
    F0: float
    TC_star: float

    def on_soil(self, soil: str, topography: str) -> GroundSpectrum:
        """Return the spectrum of the ground on a soil class, with a topographic class."""
        S = soil_factor(soil, self.F0, self.ag) * TOPOGRAPHY[topography]
        return GroundSpectrum(self.ag, self.F0, corner_factor(soil, self.TC_star) * self.TC_star, S, soil)


@dataclass(frozen=True)
class Hazard:
    """Seismic hazard of a site.

    Parameters
    ----------
    table : sequence of (TR, ag, F0, TC*)
        Return period [years], ground acceleration on rock [g], amplification, period [s].
    soil, topography : str
        Soil class A to E, and topographic class T1 to T4.
    """

    table: Sequence[Sequence[float]]
    soil: str
    topography: str

    @property
    def first(self) -> float:
        """Shortest return period that is used [years]."""
        return max(self.table[0][0], SHORTEST_RETURN_PERIOD)

    @property
    def last(self) -> float:
        """Longest return period that is used [years]."""
        return min(self.table[-1][0], LONGEST_RETURN_PERIOD)

    @cached_property
    def _logarithms(self) -> Sequence[NDArray[np.float64]]:
        return [*np.log(np.array(self.table, dtype=np.float64)).T]

    def parameters(self, TR: float) -> RockMotion:
        """Return the ground on rock at a return period [years], interpolated in logarithms."""
        periods, *others = self._logarithms
        return RockMotion(*(exp(np.interp(log(TR), periods, each)) for each in others))

    def spectrum(self, TR: float) -> GroundSpectrum:
        """Return the spectrum of the ground at a return period [years]."""
        return self.parameters(TR).on_soil(self.soil, self.topography)

    def covers(self, TR: float) -> bool:
        """Return whether a return period [years] is within the table, up to rounding."""
        return self.table[0][0] <= TR * (1 + 1e-9) and self.table[-1][0] * (1 + 1e-9) >= TR

    def rounded(self, life: float) -> dict[str, float]:
        """Return the period in the row of each limit state [years], if the rows are limit states with rounded periods.

        So programs print them: 45, 75, 712 and 1462 years. Each row must be within 1 % of the return period of a limit
        state, and rounded to whole years, unless the table does not reach the periods of the limit states. Any other
        table is one between whose rows the code interpolates.
        """
        exact = {state: bounded(return_period(life, state)) for state in PROBABILITY}
        rows = {
            state: row[0] for state, TR in exact.items() for row in self.table if abs(row[0] / TR - 1) <= MAX_ROUNDING
        }
        whole = all(abs(row - exact[state]) <= HALF_YEAR for state, row in rows.items())
        is_of_states = {row[0] for row in self.table} == {*rows.values()}
        return rows if is_of_states and (whole or not all(self.covers(exact[state]) for state in STATES)) else {}

    def counted(self, life: float, state: str) -> float:
        """Return the return period of a limit state that is used [years]: that of its row, or bounded by the code.

        Raises `InputError` if it is beyond the table of the hazard.
        """
        rows = self.rounded(life)
        if state in rows:
            return rows[state]
        TR = bounded(return_period(life, state))
        if not self.covers(TR):
            raise InputError(
                Problem(
                    f"has return periods from {self.table[0][0]:g} to {self.table[-1][0]:g} years: that of {state}, "
                    f"{TR:.4g} years, is not between",
                    field="hazard",
                    hint="add a row beyond it; rows of the limit states themselves must be within 1 % of their periods",
                )
            )
        return min(max(TR, self.table[0][0]), self.table[-1][0])


PARAMETERS = (
    DemandParameter("T_R", "T_R", "years", "return period"),
    DemandParameter("ag", "a_g", "g", "ground acceleration on rock"),
    DemandParameter("F0", "F0", "", "amplification of the spectrum"),
    DemandParameter("TC_star", "T_C*", "s", "end of the level part on rock"),
    DemandParameter("S_S", "S_S", "", "soil factor"),
    DemandParameter("C_C", "C_C", "", "period factor of the soil"),
    DemandParameter("S_T", "S_T", "", "topography factor"),
    DemandParameter("S", "S", "", "S_S S_T"),
    DemandParameter("pga", "a_g S", "g", "peak ground acceleration"),
    DemandParameter("T_B", "T_B", "s", "start of the level part"),
    DemandParameter("T_C", "T_C", "s", "end of the level part"),
    DemandParameter("T_D", "T_D", "s", "start of the part of constant displacement"),
    DemandParameter("T_1", "T1", "s", "first period of the building"),
    DemandParameter("xi_1", "xi1", "", "damping ratio of the building"),
    DemandParameter("pfa", "S_Z", "g", "peak floor acceleration"),
)


def of_ground(ground: SiteGround) -> list[Remark]:
    """Return remarks on how the ground follows from what the site file gives."""
    site, remarks = ground.site, list[Remark]()
    if site.TC_star is not None:
        remarks.append(Remark.of("without_state", state=FIRST_STATE))
    if (cell := site.cell) is not None:
        way = Remark.of("on_node") if len(cell.corners) == 1 else Remark.of("between_nodes", radius=EARTH_RADIUS)
        remarks.append(Remark.of("by_grid", way=way, unit=Remark.of(cell.unit)))
    if site.VN is not None and site.use is not None and site.life != site.VN * site.use:
        remarks.append(Remark.of("short_life", VR=site.VN * site.use, least=site.life))
    if ground.hazard is not None and site.life is not None and (rows := ground.hazard.rounded(site.life)):
        exact = {state: bounded(return_period(site.life, state)) for state in rows}
        each = [Remark.of("row", state=state, row=row, TR=exact[state]) for state, row in rows.items()]
        remarks.append(Remark.of("rows", rows=each))
    return remarks


def site_demand(site: ItalianSite) -> SiteDemand:
    """Return the spectra of a site at the limit states that it gives, with their parameters.

    Raises `InputError` if the hazard does not reach a limit state that is verified.
    """
    ground, states, remarks = SiteGround(site), dict[str, StateDemand](), of_ground(SiteGround(site))
    for state in STATES_OF_SITE:
        if (spectrum := ground.spectrum(state)) is not None:
            states[state] = _at(ground, state, spectrum)
        elif ground.hazard is not None:
            remarks.append(Remark.of("beyond_hazard", state=state))
    used = {key for each in states.values() for key, value in each.values.items() if value is not None}
    parameters = [each for each in PARAMETERS if each.key in used]
    first = site.asked[0]
    return SiteDemand(parameters, states, first, _headline(first, states[first].values), remarks, _tables(site))


def _headline(state: str, values: Mapping[str, float | None]) -> Remark:
    """Return the remark on the peak accelerations of the limit state that decides."""
    parts: dict[str, str | Remark] = {"rock": "", "years": "", "floor": ""}
    if values["S"] is not None:
        parts["rock"] = Remark.of("pga_of_rock", ag=values["ag"], S=values["S"])
    if values["T_R"] is not None:
        parts["years"] = Remark.of("pga_of_years", TR=values["T_R"])
    if values["pfa"] is not None:
        parts["floor"] = Remark.of("pga_of_floor", peak=values["pfa"])
    return Remark.of("pga", state=state, pga=values["pga"], **parts)


def _at(ground: SiteGround, state: str, spectrum: GroundSpectrum | TableSpectrum | FloorSpectrum) -> StateDemand:
    """Return the demand at a limit state, with the spectrum at the support of the structure."""
    site, rock = ground.site, ground.on_rock(state)
    below = spectrum.ground if isinstance(spectrum, FloorSpectrum) else spectrum
    values: dict[str, float | None] = dict.fromkeys(each.key for each in PARAMETERS)
    values |= {"T_R": ground.return_period(state), "pga": below.peak / STANDARD_GRAVITY}
    corners, last = [0.0], GROUND_PERIOD
    if isinstance(below, GroundSpectrum):
        values |= {"ag": below.ag, "F0": below.F0, "S": below.S, "T_B": below.TB, "T_C": below.TC, "T_D": below.TD}
        corners += [below.TB, below.TC, below.TD, *([LONG_PERIOD_START[below.soil]] if below.soil else [])]
    else:
        corners, last = [T for T, _ in below.points], below.points[-1][0]
    if rock is not None:
        soil, C_C = site.soil or "A", corner_factor(site.soil or "A", rock.TC_star)
        S_S = soil_factor(soil, rock.F0, rock.ag)
        values |= {"TC_star": rock.TC_star, "S_S": S_S, "C_C": C_C, "S_T": TOPOGRAPHY[site.topography]}
    if not isinstance(spectrum, FloorSpectrum):
        return StateDemand(values, below, None, sorted(corners), last)
    values |= {"T_1": spectrum.T1, "xi_1": spectrum.xi1, "pfa": spectrum.peak / STANDARD_GRAVITY}
    corners += [T for T in (LEVEL_FROM * spectrum.T1, spectrum.T1, LEVEL_TO * spectrum.T1) if last > T]
    return StateDemand(values, below, spectrum, sorted(corners), last)


def _tables(site: ItalianSite) -> list[DemandTable]:
    """Return the nodes of the grid about a site, and the hazard between them; empty without a grid."""
    if site.cell is None:
        return []
    nodes = {"longitude": "deg", "latitude": "deg", "distance": "km", "weight": ""}
    hazard = {"T_R": "years", "ag": "g", "F0": "", "TC_star": "s"}
    return [
        DemandTable("nodes", "Nodes of the reference grid about the site", nodes, site.cell.corners),
        DemandTable("hazard", "Hazard at the site", hazard, site.cell.rows),
    ]
