"""Compare the exact engine with free blocks."""

PLACE = 75
