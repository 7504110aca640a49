"""`animate`: a structure that moves under a ground motion."""
