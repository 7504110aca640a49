"""Compute the rocking spectrum, peak against size."""

PLACE = 350
