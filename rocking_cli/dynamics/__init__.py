"""Rocking histories: tables and numbers in, motion and outcome out. Nothing here knows a mechanism."""
