"""`selfcheck`: whether this installation computes correctly."""

PLACE = 260
