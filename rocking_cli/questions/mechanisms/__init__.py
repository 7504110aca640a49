"""`mechanisms`: the mechanisms that are installed, and their fields."""
