"""Working code of practice for rocking-cli, with two limit states. Change it into your own.

A code defines the fields of a site file, and returns capacity and demand of each of its methods for each direction in
which a structure can rock. Messages with file and line, tables, JSON, `rocking survey` and `rocking design` follow
from them. The formulas here are an example, not those of any code.
"""

from __future__ import annotations

from rocking_cli.core import Direction, Mechanism, quantity
from rocking_cli.verification import Code, Formula, Method, Site, Verification, Verified, governing

# Uplift starts rocking, but a structure overturns only under more: the factor by which the ultimate limit state counts
# on it.
ROCKING_FACTOR = 2.0

# Every formula once: symbol, text, the same with slots for numbers, unit, clause and meaning. `a_[0]` has a subscript.
# The standing "ours" marks a choice that the code leaves to you.
ONSET = Formula("a_[0]", "λ", "", "g", "4.1", meaning="acceleration at uplift")
ULTIMATE = Formula(
    "a_[u]", "q_[R] a_[0]", "{q} · {a}", "g", "4.2", meaning="acceleration at the ultimate limit state", standing="ours"
)


class SiteFields(Site):
    """The fields of a site file, in addition to `code` and `name`.

    `quantity` gives a field its meaning, unit, bounds and example. A field without a default must be in the file, and
    needs an example, which `rocking new site` prints.
    """

    a_service: float = quantity(
        "peak ground acceleration at the serviceability limit state", unit="g", example=0.08, gt=0, le=5
    )
    a_ultimate: float = quantity(
        "peak ground acceleration at the ultimate limit state", unit="g", example=0.25, gt=0, le=5
    )
    importance: float = quantity("importance factor, by which demands are multiplied", default=1.0, ge=0.8, le=1.6)


class MyCode(Code):
    """Serviceability by the onset of rocking, the ultimate limit state by a multiple of it."""

    # The first is the name in site files and in pyproject.toml; output shows the others as "the NAME (EDITION)".
    key = "my_code"
    name = "code of my own"
    edition = "2024"
    site = SiteFields

    def verify(self, mechanism: Mechanism, site: SiteFields, control: object = None) -> Verification:
        """Verify a structure at a site. `control` is given only to a code with `takes_control = True`."""
        return self.found(mechanism, {each: self._direction(mechanism, site, each) for each in mechanism.directions})

    def _direction(self, mechanism: Mechanism, site: SiteFields, direction: Direction) -> Verified:
        """Return what is found in one direction: methods, which one governs, workings and remarks."""
        onset = mechanism.uplift(direction)  # the ground acceleration that starts rocking, over g
        ultimate = ROCKING_FACTOR * onset
        methods = {
            "service": Method("onset of rocking", onset, site.importance * site.a_service, "4.1", unit="g"),
            "ultimate": Method("overturning", ultimate, site.importance * site.a_ultimate, "4.2", unit="g"),
        }
        workings = [ONSET.working(onset), ULTIMATE.working(ultimate, q=ROCKING_FACTOR, a=onset)]
        # Both limit states must pass, so the smaller ratio of capacity to demand governs. For another acceptance,
        # derive a class from Verified, and override `ratio` and `passed` together.
        remarks = ["The structure rocks at the serviceability limit state."] if not methods["service"].passed else []
        return Verified(direction, methods, governing(methods), workings=workings, remarks=remarks)
