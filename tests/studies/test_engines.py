"""Who simulates: free blocks, or one degree of freedom where it knows the outcome; and what is kept of them."""

import pytest

import rocking_cli as rk
from rocking_cli.studies.engines import free as memory

pytest.importorskip("mujoco", reason="free blocks need mujoco")

BLOCK = rk.Block(width=0.7, height=2.8)
PULSE = rk.Pulse.parse("sine:0.4g:0.8s").sampled(100) if hasattr(rk.Pulse, "parse") else None


@pytest.fixture(autouse=True)
def _own_memory(monkeypatch, tmp_path):
    monkeypatch.setattr(memory, "place", lambda: tmp_path / "blocks.sqlite")
