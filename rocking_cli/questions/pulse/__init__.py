"""Compute the response to a pulse."""

PLACE = 330
