"""`measures`: the measures of intensity that are installed."""
