"""Compute the equivalent rocking block of each structure."""

PLACE = 140
