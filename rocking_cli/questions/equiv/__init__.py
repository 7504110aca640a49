"""`equiv`: the equivalent rocking block of a structure."""

PLACE = 20
