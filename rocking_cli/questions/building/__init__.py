"""Verify all mechanisms of a building that one file describes."""

PLACE = 425
