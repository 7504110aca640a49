"""Rank the structures of a table by vulnerability."""

PLACE = 430
