"""Verify all mechanisms of a building in one file."""

PLACE = 425
