"""Map the pulses that overturn a structure."""

PLACE = 340
MORE = {"verb": ["overturning_curves", "overturning_map"]}
