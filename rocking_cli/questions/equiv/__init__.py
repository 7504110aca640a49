"""`equiv`: the equivalent rocking block of a structure."""
