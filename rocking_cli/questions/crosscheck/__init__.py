"""`crosscheck`: the exact engine and free blocks side by side."""

PLACE = 75
