"""`mechanisms`: the mechanisms that are installed, and their fields."""

PLACE = 220
