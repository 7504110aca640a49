"""Find the weakest mechanism of an assembly of blocks."""

PLACE = 150
