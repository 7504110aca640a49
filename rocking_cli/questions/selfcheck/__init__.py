"""`selfcheck`: whether this installation computes correctly."""
