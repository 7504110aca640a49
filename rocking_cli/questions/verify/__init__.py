"""Verify a masonry mechanism by a code, such as NTC 2018."""

PLACE = 420
