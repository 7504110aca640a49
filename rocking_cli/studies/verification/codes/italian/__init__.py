"""Verification of rocking mechanisms of masonry by the Italian code: NTC 2018 and Circolare 7/2019."""

from __future__ import annotations

from rocking_cli.studies.verification.code import Code
from rocking_cli.studies.verification.codes.italian.method import EDITION, NAME, verify
from rocking_cli.studies.verification.codes.italian.site import ItalianSite
from rocking_cli.studies.verification.codes.italian.starter import STARTER

CODE = Code("NTC2018", NAME, EDITION, ItalianSite, STARTER, 7, verify)
