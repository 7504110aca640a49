"""`measures`: the measures of intensity that are installed."""

PLACE = 230
