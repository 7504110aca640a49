"""Map the pulses that overturn a structure."""

PLACE = 160
MORE = {"verb": ["overturning_curves", "overturning_map"]}
