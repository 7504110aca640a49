"""Contracts of mechanisms and of codes of practice, as test classes for authors of plugins."""

from rocking_cli.testing.code import CodeContract as CodeContract
from rocking_cli.testing.mechanism import CHECKS as CHECKS
from rocking_cli.testing.mechanism import MechanismContract as MechanismContract
from rocking_cli.testing.mechanism import contract as contract
from rocking_cli.testing.mechanism import verdict as verdict
