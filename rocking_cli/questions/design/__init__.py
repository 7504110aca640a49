"""Find the values of a field that meet a requirement."""

PLACE = 440
