"""Verification of rocking mechanisms of masonry by the Italian code: NTC 2018 and Circolare 7/2019."""

from __future__ import annotations

from collections.abc import Mapping
from importlib.resources import files
from pathlib import Path
from typing import Any, ClassVar

from rocking_cli.codes.italian import method
from rocking_cli.codes.italian.chain import Chain
from rocking_cli.codes.italian.ground import site_demand
from rocking_cli.codes.italian.method import EDITION, KEY, NAME
from rocking_cli.codes.italian.results import ItalianVerification
from rocking_cli.codes.italian.rules import DAMAGE, LINEAR, NONLINEAR, STATES
from rocking_cli.codes.italian.site import ItalianSite, of_each
from rocking_cli.core import Mechanism
from rocking_cli.structure import Structure
from rocking_cli.verification.code import Code, Number
from rocking_cli.verification.demand import SiteDemand
from rocking_cli.verification.results import Control, Histories


def _zeta(key: str) -> Number:
    return Number(f"capacity over demand, by the {key} method of `verify`", of=lambda found: found.methods[key].zeta)


def _zeta_at(state: str) -> Number:
    """Return zeta_E at a limit state, by the method that governs there; at SLD the onset of rocking."""
    return Number(
        f"capacity over demand at {state}, by the method that governs there", of=lambda found: found.zeta_at(state)
    )


class Italian(Code):
    """The Italian code."""

    key, name, edition = KEY, NAME, EDITION
    site = ItalianSite
    starter = (files(__name__) / "site.yaml").read_text(encoding="utf-8")
    numbers: ClassVar[Mapping[str, Number]] = {
        "alpha0": Number(
            "multiplier that starts the mechanism, by the code of `verify`, the smaller one",
            of_structure=lambda mechanism, direction: Chain(mechanism, direction).alpha0,
        ),
        **{f"zeta_{method}": _zeta(method) for method in (DAMAGE, LINEAR, NONLINEAR)},
        **{f"zeta_{state}": _zeta_at(state) for state in STATES},
    }
    row_numbers: ClassVar[Mapping[str, Number]] = {
        "zeta_E": Number("capacity over demand by the method that governs", of=lambda found: found.zeta_E),
        "T0": Number("period of the element before it rocks", of=lambda found: found.T0, unit="s"),
    }
    takes_control = masonry = True

    def verify(self, mechanism: Mechanism, site: ItalianSite, control: Control | None = None) -> ItalianVerification:
        """Verify a structure by the damage, linear and nonlinear methods."""
        return method.verify(mechanism, site, control)

    def with_histories(
        self, found: ItalianVerification, structure: Structure, site: ItalianSite, asked: Histories
    ) -> ItalianVerification:
        """Return a verification with time histories on the capacity curve."""
        from rocking_cli.codes.italian import dynamic

        return dynamic.with_histories(found, structure, site, asked)

    def strengthened(
        self, found: ItalianVerification, other: ItalianVerification, site: ItalianSite
    ) -> ItalianVerification:
        """Return a verification beside that of the strengthened structure, judged by the intervention of the site."""
        return method.strengthened(found, other, site)

    def located(self, site: ItalianSite, folder: Path) -> ItalianSite:
        """Return the site with the hazard at its coordinates."""
        return site.located(folder)

    def demand(self, site: ItalianSite) -> SiteDemand:
        """Return the elastic spectra of the ground and of the floor at each limit state of a site."""
        return site_demand(site)

    def of_each(self, site: ItalianSite) -> ItalianSite:
        """Return the site of many structures, each of which has an element of its own size."""
        return of_each(site)

    def showing(self) -> Any:
        """Return how results by the Italian code are shown."""
        from rocking_cli.codes.italian.view import ItalianShowing

        return ItalianShowing()

    def sheet(self) -> Any:
        """Return the calculation sheet of the Italian code."""
        from rocking_cli.codes.italian.sheet.build import SHEET

        return SHEET
