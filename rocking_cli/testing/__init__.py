"""Contracts of mechanisms, codes of practice and laws of ties, for the tests of their authors."""

from rocking_cli.testing.code import CodeContract as CodeContract
from rocking_cli.testing.mechanism import CHECKS as CHECKS
from rocking_cli.testing.mechanism import MechanismContract as MechanismContract
from rocking_cli.testing.mechanism import check_law as check_law
from rocking_cli.testing.mechanism import contract as contract
from rocking_cli.testing.mechanism import verdict as verdict
