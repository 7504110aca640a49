"""Compute the rocking spectrum: peak rotation against size."""

PLACE = 170
