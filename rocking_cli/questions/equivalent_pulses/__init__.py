"""Find the equivalent pulses of several structures."""

PLACE = 360
