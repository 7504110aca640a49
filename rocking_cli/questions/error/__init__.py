"""`error`: the errors of the equivalent block."""
