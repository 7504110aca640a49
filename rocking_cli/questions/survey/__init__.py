"""Rank the structures of a table, the most vulnerable first."""

PLACE = 100
