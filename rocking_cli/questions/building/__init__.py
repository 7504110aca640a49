"""`rocking building`: all out-of-plane mechanisms of a building described in one file, and the one that governs."""

PLACE = 425
