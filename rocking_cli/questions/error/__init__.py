"""Compute the errors of the equivalent block."""

PLACE = 370
