"""Score stated shares of overturning against tests."""

PLACE = 120
