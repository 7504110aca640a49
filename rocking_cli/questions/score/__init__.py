"""`score`: compare stated shares of overturning with shake-table tests."""

PLACE = 120
