"""`overturning`: the pulses that overturn a structure."""
