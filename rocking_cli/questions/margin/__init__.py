"""Compute how close ground motions are to overturning."""

PLACE = 410
MORE = {"verb": ["shares"]}
