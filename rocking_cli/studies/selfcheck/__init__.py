"""Checks that this installation computes correctly, each against something that shares no code with what it checks."""
