"""`new`: a file or a plugin to start from."""

PLACE = 240
