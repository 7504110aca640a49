"""List, describe or check the installed mechanisms."""

PLACE = 160
