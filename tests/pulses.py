"""The exact answer to a pulse, as the data of `rocking pulse` have it: values that do not exist are None."""

from math import isnan
from types import SimpleNamespace

from rocking_cli.dynamics import exact
from rocking_cli.questions.pulse.view import EXACT
from rocking_cli.views.column import data_of


def exact_pulse(a, omega, eta, shape="sine"):
    data = data_of(EXACT, exact.exact_pulse(a, omega, eta, shape))
    return SimpleNamespace(**{name: None if isnan(value or 0) else value for name, value in data.items()})
