"""Print a template file, or create a plugin package."""

PLACE = 110
