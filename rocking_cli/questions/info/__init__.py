"""`info`: what is installed."""

PLACE = 250
