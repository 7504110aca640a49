"""`animate`: a structure that moves under a ground motion."""

PLACE = 140
