"""Inspect records: contents, strength and possible defects."""

PLACE = 210
MORE = {"verb": ["response_spectrum"]}
