"""Check that this installation computes correctly."""

PLACE = 530
