"""What shake-table tests say of the tool, and of a structure."""
