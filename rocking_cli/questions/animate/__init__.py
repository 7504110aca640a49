"""Animate structures under a ground motion."""

PLACE = 320
