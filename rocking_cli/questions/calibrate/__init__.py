"""`calibrate`: the restitution from a trace of free rocking."""
