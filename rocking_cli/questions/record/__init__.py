"""Inspect records: contents, strength and possible defects."""

PLACE = 50
MORE = {"verb": ["response_spectrum"]}
