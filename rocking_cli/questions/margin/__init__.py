"""Compute how close ground motions are to overturning."""

PLACE = 80
MORE = {"verb": ["shares"]}
