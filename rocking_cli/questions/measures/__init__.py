"""List the installed intensity measures."""

PLACE = 240
