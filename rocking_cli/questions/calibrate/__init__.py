"""Find the restitution from a trace of free rocking."""

PLACE = 170
