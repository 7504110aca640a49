"""What the tests of mechanisms share."""

import pytest


@pytest.fixture(autouse=True, scope="module")
def _fewer_steps():
    """Displaced equilibrium of assemblies is searched in a quarter of the steps, which take most of their time."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("mechanisms._assembly.SEARCH_STEPS", 8)
        yield
