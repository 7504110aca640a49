"""Ground motion: what shakes a structure."""
