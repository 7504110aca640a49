"""The demand of a site by the Italian code: its elastic spectra with their parameters."""

from __future__ import annotations

from collections.abc import Mapping

from rocking_cli.codes.italian.demand import (
    GROUND_PERIOD,
    LEVEL_FROM,
    LEVEL_TO,
    LONG_PERIOD_START,
    FloorSpectrum,
    GroundSpectrum,
    TableSpectrum,
)
from rocking_cli.codes.italian.ground import TOPOGRAPHY, SiteGround, corner_factor, soil_factor
from rocking_cli.codes.italian.remarks import of_ground
from rocking_cli.codes.italian.rules import STATES_OF_SITE
from rocking_cli.codes.italian.site import ItalianSite
from rocking_cli.excitation.base import STANDARD_GRAVITY
from rocking_cli.verification.demand import DemandParameter, DemandTable, SiteDemand, StateDemand
from rocking_cli.verification.results import Remark

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
