"""Pictures, as matplotlib figures; never pyplot, which holds state."""
