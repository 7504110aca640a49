"""Verification of rocking structures by codes of practice: the framework, and all that the author of a code needs."""

from rocking_cli.studies.file_part import Part as Part
from rocking_cli.verification.code import Code as Code
from rocking_cli.verification.code import Number as Number
from rocking_cli.verification.code import Site as Site
from rocking_cli.verification.demand import DemandParameter as DemandParameter
from rocking_cli.verification.demand import DemandTable as DemandTable
from rocking_cli.verification.demand import SiteDemand as SiteDemand
from rocking_cli.verification.demand import StateDemand as StateDemand
from rocking_cli.verification.results import Clause as Clause
from rocking_cli.verification.results import Control as Control
from rocking_cli.verification.results import Formula as Formula
from rocking_cli.verification.results import Histories as Histories
from rocking_cli.verification.results import Method as Method
from rocking_cli.verification.results import Verification as Verification
from rocking_cli.verification.results import Verified as Verified
from rocking_cli.verification.results import Working as Working
from rocking_cli.verification.results import governing as governing
