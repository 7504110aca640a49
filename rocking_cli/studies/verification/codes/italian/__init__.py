"""Verification of rocking mechanisms of masonry by the Italian code: NTC 2018 and Circolare 7/2019."""

from __future__ import annotations

from importlib.resources import files

from rocking_cli.studies.verification.code import Code
from rocking_cli.studies.verification.codes.italian.method import EDITION, KEY, NAME, verify
from rocking_cli.studies.verification.codes.italian.site import ItalianSite, floor_at, of_each

STARTER = (files(__name__) / "site.yaml").read_text(encoding="utf-8")
CODE = Code(KEY, NAME, EDITION, ItalianSite, STARTER, 7, verify, floor_at, of_each)
