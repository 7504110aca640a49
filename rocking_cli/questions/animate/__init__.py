"""Animate structures under a ground motion (GIF, MP4 or HTML)."""

PLACE = 140
