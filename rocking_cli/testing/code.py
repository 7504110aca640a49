"""Contract of all codes of practice, as a test class for authors.

Examples
--------
In the tests of a plugin::

    from rocking_cli.testing import CodeContract

    class TestContract(CodeContract):
        key = "my_code"
"""

from __future__ import annotations

from math import isclose, isfinite
from typing import ClassVar

from rocking_cli.core import Mechanism
from rocking_cli.core.registry import Registry
from rocking_cli.errors import InputError
from rocking_cli.io.json_text import json_text
from rocking_cli.io.yaml_file import parse
from rocking_cli.structure import Structure
from rocking_cli.testing.mechanism import _demand
from rocking_cli.verification.check import site_in, verify
from rocking_cli.verification.code import Code, SiteFile, codes
from rocking_cli.verification.results import CAPACITY_TOLERANCE, Verification, Verified
from rocking_cli.views.mechanisms import starter
from rocking_cli.views.verification import showing, table, view

UNKNOWN_FIELD = "no_field_of_any_code"


class CodeContract:
    """Test class for an installed code; a subclass names it, and may give a structure or a site of its own."""

    key: ClassVar[str]
    """Name of the code, that of its entry point."""

    @property
    def structure(self) -> Mechanism:
        """The structure to verify: a block of 0.7 m x 2.8 m."""
        return Registry()["block"].from_fields({"name": "block", "width": 0.7, "height": 2.8})

    @property
    def site_text(self) -> str:
        """The site file: that which `rocking new site` prints."""
        return starter(self.code)

    @property
    def code(self) -> Code:
        """The code. Raises `MechanismError` if it is not complete."""
        return codes()[self.key]

    @property
    def found(self) -> Verification:
        """The verification of the structure at the site."""
        return verify(Structure(self.structure), _read(self.site_text))

    def test_its_starter_is_a_site_of_this_code(self) -> None:
        """The site file that `rocking new site` prints works as it is."""
        code = _read(starter(self.code)).site.code
        _demand(code == self.key, f"the starter is a site of the code {code}, not of {self.key}")

    def test_every_field_of_a_site_says_what_it_is(self) -> None:
        """Every field of a site has a description, which the starter and messages show."""
        silent = [name for name, field in self.code.site.model_fields.items() if not field.description]
        _demand(not silent, f"no description: {', '.join(silent)}")

    def test_a_wrong_field_is_reported_with_its_line(self) -> None:
        """A site refuses a field that it does not have, with the line of that field."""
        text = f"{self.site_text.rstrip()}\n{UNKNOWN_FIELD}: 1\n"
        try:
            _read(text)
        except InputError as error:
            places = [(each.field, each.line) for each in error.problems]
            _demand(
                (UNKNOWN_FIELD, text.count("\n")) in places, f"a field in line {text.count(chr(10))} gives: {error}"
            )
        else:
            _demand(False, "a field that does not exist is accepted: keep the model_config of Site")

    def test_it_verifies_every_direction(self) -> None:
        """There is a result, with methods, for each direction in which the structure can rock."""
        verification, wanted = self.found, list(self.structure.directions)
        _demand(
            list(verification.directions) == wanted, f"the directions are {list(verification.directions)}, not {wanted}"
        )
        for direction, each in verification.directions.items():
            _demand(each.direction is direction, f"the result of {direction!r} is of {each.direction!r}")

    def test_its_numbers_are_finite(self) -> None:
        """Capacity and demand of each method exist, and are finite."""
        for each in self.found.directions.values():
            for key, method in each.methods.items():
                known = all(value is not None and isfinite(value) for value in (method.capacity, method.demand))
                _demand(known, f"{key}: capacity {method.capacity}, demand {method.demand}")

    def test_its_ratio_is_that_of_the_method_that_governs(self) -> None:
        """The ratio is capacity over demand of the method that governs, unless the code has a ratio of its own."""
        for each in self.found.directions.values():
            capacity, demand = each.counts.capacity, each.counts.demand
            if type(each).ratio is Verified.ratio and capacity is not None and demand:
                same = each.ratio is not None and isclose(each.ratio, capacity / demand)
                _demand(same, f"the ratio is {each.ratio}, but {each.governs} gives {capacity}/{demand}")

    def test_it_passes_if_its_ratio_is_at_least_1(self) -> None:
        """Verdict and ratio agree: surveys and designs compare the ratio with 1."""
        for each in self.found.directions.values():
            expected = None if each.ratio is None else each.ratio >= 1 - CAPACITY_TOLERANCE
            _demand(each.passed == expected, f"passed is {each.passed}, but the ratio is {each.ratio}")

    def test_its_result_can_be_shown(self) -> None:
        """Remarks are sentences, and the result can be printed, and written as JSON and as a table."""
        verification = self.found
        remarks = [*verification.remarks, *(each for one in verification.directions.values() for each in one.remarks)]
        texts = [each if isinstance(each, str) else showing(verification).say(each) for each in remarks]
        _demand(
            all(isinstance(text, str) and text.strip() for text in texts), f"remarks that are no sentences: {texts}"
        )
        result_view = view(verification)
        json_text(result_view.plain())
        _demand(result_view.parts and table(verification), "nothing is shown")


def _read(text: str) -> SiteFile:
    return site_in(parse(text, "site.yaml", "site", "it comes from the code"))
